//! Before a vehicle comes on to the bridge it can be marched without one.

use crate::problems::vehicles::half_car;
use crate::problems::{kishan_vehicle, kishan_vehicle_with_friction};
use spanwise::coordinate::Coordinate;
use spanwise::damping::ModalDamping;
use spanwise::geometry::{Geometry, Surface};
use spanwise::step::{Moving, Propulsion, Scheme, State, Stepper};
use spanwise::vehicle::{Friction, Vehicle};

const SPEED: f64 = 20.0;
const STEP: f64 = 1e-3;

/// A rough road before the bridge.
struct Approach {
    step: usize,
    steady: bool,
}

impl Geometry<f64> for Approach {
    fn advance(&mut self) {
        self.step += 1;
    }

    fn steady(&self) -> bool {
        self.steady
    }

    fn motion(&self, contact: usize) -> Coordinate<f64> {
        Coordinate { x: SPEED * STEP * self.step as f64 - 4.0 * contact as f64 - 50.0, v: SPEED, a: 0.0 }
    }

    fn shapes(&self, _contact: usize, shapes: &mut [f64]) {
        shapes.fill(0.0);
    }

    fn slope(&self, _contact: usize, _mode: usize) -> f64 {
        0.0
    }

    fn curvature(&self, _contact: usize, _mode: usize) -> f64 {
        0.0
    }

    fn surface(&self, contact: usize) -> Surface<f64> {
        let (wave, x) = (1.3, Geometry::<f64>::motion(self, contact).x + 50.0);
        let elevation = 0.02 * (wave * x).sin();
        Surface { elevation, slope: 0.02 * wave * (wave * x).cos(), curvature: -wave * wave * elevation }
    }
}

fn march(vehicle: &Vehicle, omega: &[f64], steady: bool) -> Vec<State<f64>> {
    let stepper = |h: f64| {
        let assembly = vehicle.assembly();
        let moving = [Moving { assembly, propulsion: Propulsion::Prescribed, direction: 1.0, grade: 0.0 }];
        let damping = ModalDamping::Classical(vec![0.02; omega.len()]);
        Stepper::<f64>::new(omega, &damping, &moving, &Scheme { h, beta: 0.25, gravity: 9.81, lift_off: true })
    };
    let mut approach = Approach { step: 0, steady };
    let mut state = stepper(0.0).start(&[SPEED], &approach).unwrap();
    let mut stepper = stepper(STEP);
    let step = |_| {
        stepper.advance(&mut state, &mut approach).unwrap();
        state.clone()
    };
    (0..1000).map(step).collect()
}

/// A bridge at rest makes no difference, to the bit; nor does saying that the speed is constant.
#[test]
fn a_bridge_not_yet_reached_makes_no_difference() {
    let half_car = half_car([700.0, 1100.0], 1.0, 0.0, Friction::coulomb(2e3));
    for vehicle in [kishan_vehicle(), kishan_vehicle_with_friction(0.0), half_car] {
        let with = march(&vehicle, &[20.0, 80.0, 180.0], false);
        for (omega, steady) in [(&[20.0, 80.0, 180.0][..], true), (&[], true), (&[], false)] {
            for (with, without) in with.iter().zip(march(&vehicle, omega, steady)) {
                assert!(with.modes.iter().all(|mode| *mode == Coordinate::rest()));
                assert_eq!(with.coordinates, without.coordinates);
                assert_eq!(with.increments, without.increments);
                assert_eq!(with.strokes, without.strokes);
            }
        }
        assert!(with.iter().any(|state| state.increments.iter().any(|p| p.abs() > 1e3)));
    }
}
