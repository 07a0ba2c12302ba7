//! Vehicles with unsprung masses, and trailers.

use spanwise::vehicle::Vehicle;
use spanwise::vehicle::{Axle, Body, Coupling};
use spanwise::vehicle::{BuildUp, Friction};

/// Half-car of a truck: tyres and suspensions, dampers as multiples of the usual ones, friction as a share of the load.
pub fn half_car(unsprung: [f64; 2], suspension_damping: f64, tyre_damping: f64, friction: Friction) -> Vehicle {
    let axle = |k: usize, position: f64, tyre: f64, spring: f64, damper: f64| Axle {
        mass: unsprung[k],
        tyre_damping: tyre_damping * 1e4,
        suspension_damping: suspension_damping * damper,
        friction,
        ..Axle::new(position, tyre, spring)
    };
    let axles = vec![axle(0, 2.375, 1.75e6, 4e5, 1e4), axle(1, -2.375, 3.5e6, 1e6, 2e4)];
    Vehicle::new(16_200.0, 93_457.0, 1.4, axles).unwrap()
}

/// Friction behind an elastic stick [N/m].
pub fn elastic(limit: f64, stick: f64) -> Friction {
    Friction { limit, initial: 0.0, build_up: BuildUp::Elastic(stick) }
}

/// Friction of a leaf spring that builds up within this stroke [m].
pub fn leaf(limit: f64, stroke: f64) -> Friction {
    Friction { limit, initial: 0.0, build_up: BuildUp::Leaf(stroke) }
}

/// Tractor and semitrailer of five axles, after D. Cantero; dampers as multiples of the usual ones.
pub fn articulated(suspension_damping: f64, tyre_damping: f64) -> Vehicle {
    let axle = |position: f64, mass: f64, tyre: f64, spring: f64| Axle {
        mass,
        tyre_damping: tyre_damping * 1e4,
        suspension_damping: suspension_damping * 1e4,
        ..Axle::new(position, tyre, spring)
    };
    let front = vec![axle(0.5, 700.0, 1.75e6, 4e5), axle(-2.5, 1100.0, 3.5e6, 1e6)];
    let rear = [-1.8, -2.9, -4.0].map(|x| axle(x, 750.0, 3.5e6, 7.5e5)).to_vec();
    let hinge = Coupling::Hinge { to: 0, at: -2.15, own: 6.15, height: 1.2 };
    let body = |mass: f64, pitch_inertia: f64, cg_height: f64, axles: Vec<Axle>, couplings: Vec<Coupling>| Body {
        mass,
        pitch_inertia,
        cg_height,
        axles,
        couplings,
    };
    Vehicle::of_bodies(vec![body(4500.0, 4604.0, 1.0, front, vec![]), body(31_450.0, 16_302.0, 1.9, rear, vec![hinge])])
        .unwrap()
}

/// Tractor and semitrailer of three axles like the HS20-44 truck of X. Shi and C. S. Cai, for the whole width, with
/// suspension dampers as multiples of the usual ones.
pub fn hs20(suspension_damping: f64) -> Vehicle {
    let axle = |position: f64, wheels: f64, spring: f64, damper: f64, tyre: f64| Axle {
        mass: 2.0 * wheels,
        tyre_damping: 2.0 * 2000.0,
        suspension_damping: 2.0 * damper * suspension_damping,
        ..Axle::new(position, 2.0 * tyre, 2.0 * spring)
    };
    let front =
        vec![axle(1.698, 490.0, 242_604.0, 2190.0, 875_082.0), axle(-2.569, 808.0, 1_903_172.0, 7882.0, 3_503_307.0)];
    let rear = vec![axle(-2.283, 653.0, 1_969_034.0, 7182.0, 3_507_429.0)];
    let hinge = Coupling::Hinge { to: 0, at: -2.215, own: 2.338, height: 1.2 };
    let body = |mass: f64, pitch_inertia: f64, cg_height: f64, axles: Vec<Axle>, couplings: Vec<Coupling>| Body {
        mass,
        pitch_inertia,
        cg_height,
        axles,
        couplings,
    };
    Vehicle::of_bodies(vec![body(2612.0, 2022.0, 0.9, front, vec![]), body(26_113.0, 33_153.0, 1.7, rear, vec![hinge])])
        .unwrap()
}
