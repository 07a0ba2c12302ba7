//! Masses in rigid contact with the bridge against their equation of motion with all convective terms,
//! (I + Mφφᵀ) Ä + 2vMφφ'ᵀ Ȧ + (Ω² + M(v²φφ''ᵀ + v̇φφ'ᵀ)) A = Mgφ,
//! integrated by Runge and Kutta in the same modes.

use crate::problems::continuous;
use crate::problems::mechanics::{Shapes, run_all, runge_kutta};
use crate::problems::*;
use nalgebra::{DMatrix, DVector};
use spanwise::bridge::{Bridge, Stations};
use spanwise::passage::{Direction, Drive, Passage, Settings};
use spanwise::recovery::Recovery::Superposition;
use spanwise::vehicle::Vehicle;

/// Deflections and forces in steps of a two-hundredth of the shortest period, relative to the largest: what steps of
/// second order leave, a few millionths of the deflection, and of the force, which is its second derivative, some tenths
/// of a thousandth.
const DEFLECTION: f64 = 2e-5;
const FORCE: f64 = 1e-3;

/// Steps of the reference to a step of the crossing: its own error is less by orders.
const FINER: usize = 2;

const SPAN: f64 = 30.0;
const EI: f64 = 2.0e10;
const MASS_PER_LENGTH: f64 = 1.0e4;
const MODES: usize = 5;
const GRAVITY: f64 = 9.806_65;

fn bridge() -> Bridge {
    let stations = Stations::PerSpan(vec![40]);
    continuous(&[SPAN], [PINNED; 2], &[EI], &[MASS_PER_LENGTH], &stations, &[]).unwrap()
}

/// Speed over twice the span per first period.
fn speed(alpha: f64) -> f64 {
    2.0 * SPAN * alpha * std::f64::consts::PI / (2.0 * SPAN.powi(2)) * (EI / MASS_PER_LENGTH).sqrt()
}

/// Masses on the bridge and how they move.
struct Masses {
    masses: Vec<f64>,
    /// Distance behind the first.
    behind: Vec<f64>,
    speed: f64,
    acceleration: f64,
}

impl Masses {
    fn motion(&self, k: usize, t: f64) -> [f64; 3] {
        let x = self.speed * t + 0.5 * self.acceleration * t * t - self.behind[k];
        [x, self.speed + self.acceleration * t, self.acceleration]
    }

    /// Ä from A and Ȧ at time t.
    fn accelerations(&self, shapes: &Shapes, t: f64, a: &[f64], a_dot: &[f64]) -> DVector<f64> {
        let n = shapes.omega.len();
        let mut left = DMatrix::identity(n, n);
        let mut right = DVector::from_fn(n, |i, _| -shapes.omega[i].powi(2) * a[i]);
        for (k, mass) in self.masses.iter().enumerate() {
            let [x, v, v_dot] = self.motion(k, t);
            if !(0.0..=SPAN).contains(&x) {
                continue;
            }
            let shape = shapes.at(x);
            let convected: f64 = (0..n)
                .map(|i| 2.0 * v * shape[i][1] * a_dot[i] + (v * v * shape[i][2] + v_dot * shape[i][1]) * a[i])
                .sum();
            for i in 0..n {
                right[i] += mass * shape[i][0] * (GRAVITY - convected);
                for j in 0..n {
                    left[(i, j)] += mass * shape[i][0] * shape[j][0];
                }
            }
        }
        left.lu().solve(&right).unwrap()
    }

    /// Forces that the masses press with.
    fn forces(&self, shapes: &Shapes, t: f64, a: &[f64], a_dot: &[f64]) -> Vec<f64> {
        let a_ddot = self.accelerations(shapes, t, a, a_dot);
        let of = |k: usize| {
            let [x, v, v_dot] = self.motion(k, t);
            let total = shapes.at(x).iter().enumerate().fold(0.0, |sum, (i, [value, slope, curvature])| {
                sum + value * a_ddot[i] + 2.0 * v * slope * a_dot[i] + (v * v * curvature + v_dot * slope) * a[i]
            });
            self.masses[k] * (GRAVITY - total)
        };
        (0..self.masses.len()).map(of).collect()
    }

    fn drive(&self) -> Drive {
        if self.acceleration == 0.0 { Drive::ConstantSpeed } else { Drive::Acceleration(self.acceleration) }
    }

    /// Largest errors of deflections and forces, relative to the largest, and the least force over the weight.
    fn compare(&self, steps: usize, direction: Direction) -> [f64; 3] {
        let positions: Vec<f64> = self.behind.iter().map(|b| -b).collect();
        let vehicle = Vehicle::moving_masses(&self.masses, &positions).unwrap();
        let way = SPAN + self.behind[self.behind.len() - 1];
        let root = (self.speed.powi(2) + 2.0 * self.acceleration * way).sqrt();
        let duration = 2.0 * way / (self.speed + root);
        let settings = Settings {
            drive: self.drive(),
            beta: 0.25,
            gravity: GRAVITY,
            step: Some(duration / steps as f64),
            ..Settings::at_speed(self.speed)
        };
        let passage = Passage { direction, ..Passage::of(vehicle) };
        let sections = [SPAN / 3.0, SPAN / 2.0, SPAN * 0.9];
        let run = run_all(&bridge(), &[passage], &settings, MODES, &undamped(), Superposition, &sections).unwrap();
        assert_eq!(run.outcome.history.len(), steps + 1);
        let shapes = Shapes::new(&run.bridge, MODES);
        let h = duration / steps as f64 / FINER as f64;
        let weight = GRAVITY * self.masses.iter().sum::<f64>();
        let slopes = |t: f64, y: &[f64]| {
            let (a, a_dot) = y.split_at(MODES);
            let mut all = a_dot.to_vec();
            all.extend(self.accelerations(&shapes, t, a, a_dot).iter());
            all
        };
        let mut y = vec![0.0; 2 * MODES];
        let (mut worst, mut largest, mut least) = (0.0_f64, 0.0_f64, f64::INFINITY);
        let (mut force, mut greatest) = (0.0_f64, weight);
        for (n, row) in run.rows().enumerate() {
            let t = n as f64 * h * FINER as f64;
            // Of the bridge seen from the other side if the masses go to the left.
            for (section, &x) in sections.iter().enumerate() {
                let x = if direction == Direction::Right { x } else { SPAN - x };
                let exact: f64 = shapes.at(x).iter().zip(&y).map(|(shape, a)| shape[0] * a).sum();
                worst = worst.max((row.dynamic[section] - exact).abs());
                largest = largest.max(exact.abs());
            }
            for (k, exact) in self.forces(&shapes, t, &y[..MODES], &y[MODES..]).into_iter().enumerate() {
                let [x, ..] = self.motion(k, t);
                if x > 0.0 && x < SPAN * (1.0 - 1e-9) {
                    force = force.max((row.loads[k] - exact).abs());
                    greatest = greatest.max(exact.abs());
                    least = least.min(row.loads[k] / weight);
                }
            }
            for i in 0..FINER {
                runge_kutta(&mut y, t + i as f64 * h, h, &slopes);
            }
        }
        [worst / largest, force / greatest, least]
    }
}

/// Steps of a crossing, each a two-hundredth of the period of the fifth mode.
fn steps(alpha: f64) -> usize {
    (2500.0 / alpha) as usize
}

fn one(ratio: f64, alpha: f64, acceleration: f64) -> Masses {
    let masses = vec![ratio * MASS_PER_LENGTH * SPAN];
    Masses { masses, behind: vec![0.0], speed: speed(alpha), acceleration }
}

#[test]
fn all_convective_terms() {
    let mut pulls = 0;
    for alpha in [0.25, 0.5, 1.0] {
        for ratio in [0.1, 0.3, 1.0] {
            let [deflection, force, least] = one(ratio, alpha, 0.0).compare(steps(alpha), Direction::Right);
            println!("alpha {alpha}, mass ratio {ratio}: {deflection:.1e}, force {force:.1e}, least {least:.2}");
            assert!(
                deflection <= DEFLECTION && force <= FORCE,
                "alpha {alpha}, ratio {ratio}: {deflection:e} {force:e}"
            );
            pulls += usize::from(least < -0.01);
        }
    }
    // A mass that follows the bridge rigidly is held by it too.
    assert!(pulls > 0);
}

#[test]
fn speeding_up_and_slowing_down() {
    for (alpha, acceleration) in [(0.25, 20.0), (0.5, -60.0)] {
        for direction in [Direction::Right, Direction::Left] {
            let masses = one(0.5, alpha, acceleration);
            let [deflection, force, _] = masses.compare(steps(alpha), direction);
            println!("alpha {alpha}, {acceleration} m/s², {direction:?}: {deflection:.1e}, force {force:.1e}");
            assert!(deflection <= DEFLECTION && force <= FORCE, "{acceleration} m/s²: {deflection:e}, {force:e}");
        }
    }
}

/// Two masses follow each other: the second meets a bridge in motion, which jolts it between two steps.
#[test]
fn two_masses() {
    let total = MASS_PER_LENGTH * SPAN;
    let masses = Masses {
        masses: vec![0.2 * total, 0.3 * total],
        behind: vec![0.0, 0.4 * SPAN],
        speed: speed(0.3),
        acceleration: 0.0,
    };
    let errors = [2000, 4000].map(|steps| masses.compare(steps, Direction::Right)[0]);
    println!("{errors:?}");
    assert!(errors[0] <= 10.0 * DEFLECTION && errors[1] <= 0.3 * errors[0], "{errors:?}");
}

#[test]
fn second_order() {
    let masses = one(0.3, 0.5, 0.0);
    let errors = [1000, 2000, 4000].map(|steps| masses.compare(steps, Direction::Right)[0]);
    let orders: Vec<f64> = errors.windows(2).map(|w| (w[0] / w[1]).log2()).collect();
    println!("{errors:?}, orders {orders:.3?}");
    assert!(orders.iter().all(|o| (o - 2.0).abs() <= 0.1), "{orders:?}");
}
