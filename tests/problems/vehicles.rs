//! Published vehicles, as plain numbers.

use spanwise::vehicle::{Axle, Body, Coupling, Vehicle};

/// An axle with unsprung mass [kg] at a place [m]: stiffness of the tyre and of the suspension [N/m], their damping
/// [N s/m].
pub fn sprung_axle(position: f64, mass: f64, stiffness: [f64; 2], damping: [f64; 2]) -> Axle {
    let [tyre_damping, suspension_damping] = damping;
    Axle { mass, tyre_damping, suspension_damping, ..Axle::new(position, stiffness[0], stiffness[1]) }
}

/// A two-axle lorry of 18 t (OBrien and Keenahan 2015).
pub fn half_car() -> Vehicle {
    let front = sprung_axle(2.375, 700.0, [1.75e6, 4e5], [0.0, 1e4]);
    let rear = sprung_axle(-2.375, 1100.0, [3.5e6, 1e6], [0.0, 2e4]);
    Vehicle::new(16_200.0, 93_457.0, 0.0, vec![front, rear]).unwrap()
}

/// A tractor with two axles and a semi-trailer with three (Cantero, Gonzalez and OBrien 2009).
pub fn articulated_5_axle() -> Vehicle {
    let axle = |x: f64, mass: f64, stiffness: [f64; 2]| sprung_axle(x, mass, stiffness, [1e4, 1e3]);
    let tractor = Body {
        mass: 4500.0,
        pitch_inertia: 4604.0,
        cg_height: 0.0,
        axles: vec![axle(0.5, 700.0, [1.75e6, 0.4e6]), axle(-2.5, 1100.0, [3.5e6, 1e6])],
        couplings: vec![],
    };
    let trailer = Body {
        mass: 31_450.0,
        pitch_inertia: 16_302.0,
        cg_height: 0.0,
        axles: [-1.8, -2.9, -4.0].map(|x| axle(x, 750.0, [3.5e6, 0.75e6])).to_vec(),
        couplings: vec![Coupling::Hinge { to: 0, at: -2.15, own: 6.15, height: 0.0 }],
    };
    Vehicle::of_bodies(vec![tractor, trailer]).unwrap()
}
