//! Vehicles of the catalogue with other axles, and friction.

use spanwise::error::Error;
use spanwise::vehicle::{Axle, BuildUp, Friction, Vehicle, catalogue};

/// The vehicle with its axles changed, counted body by body.
pub fn with_axles(vehicle: Result<Vehicle, Error>, change: impl Fn(usize, &mut Axle)) -> Vehicle {
    let mut bodies = vehicle.unwrap().bodies().to_vec();
    for (k, axle) in bodies.iter_mut().flat_map(|body| &mut body.axles).enumerate() {
        change(k, axle);
    }
    Vehicle::of_bodies(bodies).unwrap()
}

/// Half-car of a truck: tyres and suspensions, dampers as multiples of the usual ones, friction as a share of the load.
pub fn half_car(unsprung: [f64; 2], suspension_damping: f64, tyre_damping: f64, friction: Friction) -> Vehicle {
    with_axles(catalogue::half_car(1.4), |k, axle| {
        axle.mass = unsprung[k];
        axle.suspension_damping *= suspension_damping;
        axle.tyre_damping = tyre_damping * 1e4;
        axle.friction = friction;
    })
}

/// Friction behind an elastic stick [N/m].
pub fn elastic(limit: f64, stick: f64) -> Friction {
    Friction { limit, initial: 0.0, build_up: BuildUp::Elastic(stick) }
}

/// Friction of a leaf spring that builds up within this stroke [m].
pub fn leaf(limit: f64, stroke: f64) -> Friction {
    Friction { limit, initial: 0.0, build_up: BuildUp::Leaf(stroke) }
}

/// Tractor and semitrailer of five axles, after D. Cantero; dampers as multiples of 10 kN s/m.
pub fn articulated(suspension_damping: f64, tyre_damping: f64) -> Vehicle {
    with_axles(catalogue::articulated_5_axle([1.0, 1.9], 1.2), |_, axle| {
        axle.suspension_damping = suspension_damping * 1e4;
        axle.tyre_damping = tyre_damping * 1e4;
    })
}

/// The HS20-44 truck as tractor and semitrailer, with suspension dampers as multiples of the usual ones.
pub fn hs20(suspension_damping: f64) -> Vehicle {
    with_axles(catalogue::hs20_44([0.9, 1.7], 1.2), |_, axle| axle.suspension_damping *= suspension_damping)
}
