//! Trains of constant forces, whose modes follow exactly: against closed forms, against the coupled engine, against
//! themselves in other steps.

use std::f64::consts::PI;

use crate::problems::*;
use faer::Mat;
use spanwise::bridge::{Line, Mesh};
use spanwise::coordinate::Coordinate;
use spanwise::crossing::{History, Watch, cross};
use spanwise::damping::ModalDamping;
use spanwise::error::Error;
use spanwise::modal_bridge::{ModalBridge, ModeShapes};
use spanwise::passage::{Direction, Passage, Settings, Tail};
use spanwise::spline::between;
use spanwise::step::{Oscillator, Reach};
use spanwise::stop_token::StopToken;
use spanwise::vehicle::Vehicle;

/// Rounding, of the largest of each kind.
const ROUNDING: f64 = 1e-10;

/// What is asked for against closed forms.
const CLOSED: f64 = 1e-9;

/// The same against the coupled engine in fine steps.
const COUPLED: f64 = 1e-6;

/// A watch that never ends a tail.
struct Nobody;

impl Watch for Nobody {
    fn enough(&mut self, _: &History, _: &Reach<f64>, _: StopToken<'_>) -> Result<bool, Error> {
        Ok(false)
    }
}

const SPAN: f64 = 20.0;
const MASS: f64 = 8e3;
const EI: f64 = 6e9;

/// A uniform simple beam in its first modes, each a sine of so many cubics.
fn simple_beam(modes: usize, panels: usize, ratios: &[f64]) -> ModalBridge {
    let x: Vec<f64> = (0..=panels).map(|i| SPAN * i as f64 / panels as f64).collect();
    let mesh = Mesh::new(SPAN, x);
    let lines: Vec<Line> = (1..=modes)
        .map(|j| {
            let (k, size) = (j as f64 * PI / SPAN, (2.0 / (MASS * SPAN)).sqrt());
            let cubic = |panel: usize| {
                let ends = [mesh.nodes()[panel], mesh.nodes()[panel + 1]];
                let slopes = ends.map(|x| size * k * (k * x).cos() * mesh.width(panel));
                between(ends.map(|x| size * (k * x).sin()), slopes)
            };
            Line::from_cubics((0..mesh.panels()).map(cubic).collect())
        })
        .collect();
    let omega = (1..=modes).map(|j| (j as f64 * PI / SPAN).powi(2) * (EI / MASS).sqrt()).collect();
    let damping = ModalDamping::Classical(ratios.to_vec());
    ModalBridge { omega, shapes: ModeShapes::new(&mesh, &lines), damping, shortest_span: SPAN }
}

fn crossed(model: &ModalBridge, vehicle: &Vehicle, direction: Direction, settings: &Settings) -> History {
    let passage = Passage { direction, ..Passage::of(vehicle.clone()) };
    cross(model, &[passage], settings, &mut Nobody, StopToken::NEVER).unwrap()
}

/// The answer of a mode to one force that came on to the beam at the time zero, and left it at the time `exit`.
fn sine(omega: f64, ratio: f64, forcing: f64, size: f64, exit: f64, t: f64) -> f64 {
    if t <= 0.0 {
        return 0.0;
    }
    let (decay, damped) = (ratio * omega, omega * (1.0 - ratio * ratio).sqrt());
    let (stiff, lag) = (omega * omega - forcing * forcing, 2.0 * decay * forcing);
    let scale = size / (stiff * stiff + lag * lag);
    let (s, c) = (scale * stiff, -scale * lag);
    let free = |x: f64, v: f64, t: f64| {
        let (sine, cosine) = (damped * t).sin_cos();
        let b = (v + decay * x) / damped;
        let fading = (-decay * t).exp();
        let value = fading * (x * cosine + b * sine);
        (value, -decay * value + fading * damped * (b * cosine - x * sine))
    };
    let on = |t: f64| {
        let (sine, cosine) = (forcing * t).sin_cos();
        let (x, v) = free(-c, -forcing * s, t);
        (s * sine + c * cosine + x, forcing * (s * cosine - c * sine) + v)
    };
    if t <= exit {
        return on(t).0;
    }
    let (x, v) = on(exit);
    free(x, v, t - exit).0
}

/// Trains on a uniform simple beam against the sum over their forces of the answer of each mode, on the beam and after it,
/// whatever the step.
#[test]
fn trains_on_a_simple_beam() {
    let behind = [0.0, 1.8, 9.7, 13.3, 31.0];
    let loads = [9e4, 4e4, 1.3e5, 7e4, 1e5];
    let train = Vehicle::force_train(&loads, &behind.map(|b| -b)).unwrap();
    let ratios = [0.02, 0.0, 0.3, 0.005];
    let model = simple_beam(4, 2000, &ratios);
    for speed in [12.0, 41.7, 95.0] {
        for step in [2e-4, 3e-3, 0.02, 0.11] {
            // Without the limit of Newmark's method.
            let settings = Settings {
                step: Some(step),
                beta: 0.25,
                tail: Tail::Fixed(1.0),
                approach: 3.0,
                ..Settings::at_speed(speed)
            };
            let history = crossed(&model, &train, Direction::Right, &settings);
            let (mut worst, mut largest) = ([0.0_f64; 4], [0.0_f64; 4]);
            for (row, &t) in history.time.iter().enumerate().take(history.len() - 1) {
                for m in 0..4 {
                    let forcing = (m + 1) as f64 * PI * speed / SPAN;
                    let exact: f64 = loads
                        .iter()
                        .zip(behind)
                        .map(|(load, behind)| {
                            let size = load * (2.0 / (MASS * SPAN)).sqrt();
                            sine(model.omega[m], ratios[m], forcing, size, SPAN / speed, t - (3.0 + behind) / speed)
                        })
                        .sum();
                    worst[m] = worst[m].max((history.a[row * 4 + m] - exact).abs());
                    largest[m] = largest[m].max(exact.abs());
                }
            }
            println!("{speed} m/s, {step} s: {worst:?} of {largest:?}");
            assert!(worst.iter().zip(largest).all(|(worst, largest)| *worst <= CLOSED * largest), "{speed}, {step}");
        }
    }
}

/// One mode under a constant force, and let go: undamped, damped, critically damped and beyond, in steps short and long.
#[test]
fn one_mode() {
    for ratio in [0.0, 1e-8, 0.02, 0.7, 1.0, 3.0] {
        for (omega, h) in [(1e-3, 0.1), (1.0, 0.3), (20.0, 0.01), (20.0, 0.1), (90.0, 0.3)] {
            let rate = 2.0 * ratio * omega;
            let own = Oscillator::<f64>::new(omega, rate, h);
            let root = (omega * omega * (1.0 - ratio * ratio).abs()).sqrt();
            // e^{-ct}·cosh or cos, and sinh or sine over its rate.
            let free = |t: f64| {
                let fading = (-ratio * omega * t).exp();
                match ratio {
                    1.0 => [fading, fading * t],
                    r if r < 1.0 => [fading * (root * t).cos(), fading * (root * t).sin() / root],
                    _ => {
                        let (slow, fast) = ((root - ratio * omega) * t, (-root - ratio * omega) * t);
                        [0.5 * (slow.exp() + fast.exp()), 0.5 * (slow.exp() - fast.exp()) / root]
                    }
                }
            };
            let rest = Coordinate { x: 0.0, v: 0.0, a: 0.0 };
            let (mut kicked, mut pushed, mut late) = (Coordinate { v: 1.0, ..rest }, rest, rest);
            // For some ten periods, or as long as anything is left.
            let mut worst = 0.0_f64;
            for n in 1..=((60.0 / omega / h) as usize).clamp(20, 2000) {
                kicked = own.swing(kicked);
                pushed = own.advance(pushed, [1.0, 0.0, 0.0, 0.0]);
                late = own.swing(late);
                if n == 1 {
                    own.add(&mut late, (0.375, 0), [1.0, 0.0, 0.0, 0.0]);
                } else {
                    own.add(&mut late, (1.0, 0), [1.0, 0.0, 0.0, 0.0]);
                }
                let under_load = |t: f64| {
                    let [c, s] = free(t);
                    // 1 − e^{−ζωt}(…), without loss where it is small.
                    if omega * t < 1e-2 { f64::NAN } else { (1.0 - c - ratio * omega * s) / omega.powi(2) }
                };
                let t = n as f64 * h;
                for (ours, exact, scale) in [
                    (kicked.x, free(t)[1], 1.0 / omega),
                    (pushed.x, under_load(t), omega.powi(-2)),
                    (late.x, under_load(t - 0.625 * h), omega.powi(-2)),
                ] {
                    if !exact.is_nan() {
                        worst = worst.max((ours - exact).abs() / scale);
                    }
                }
            }
            println!("ratio {ratio}, {omega} rad/s, {h} s: {worst:.1e}");
            assert!(worst < 1e-12, "ratio {ratio}, {omega} rad/s, {h} s: {worst:e}");
        }
    }
}

/// Eight times as long steps come to the same at the same times; from the left and from the right, on all kinds of
/// bridges, free ends and hinges among them.
#[test]
fn the_step_makes_no_difference() {
    let train = Vehicle::force_train(&[9e4, 4e4, 1.3e5, 7e4], &[0.0, -1.8, -7.7, -13.3]).unwrap();
    for (name, bridge) in all_arrangements() {
        let analysis = crate::problems::ensemble::analysis_of(
            &bridge,
            bridge.stations().len().min(5),
            &spanwise::damping::Damping::Ratios(vec![0.02]),
            &[],
            spanwise::recovery::Recovery::ForceSummation,
        );
        let model = &analysis.model;
        for direction in [Direction::Right, Direction::Left] {
            let settings = Settings { beta: 0.25, approach: 1.0, ..Settings::at_speed(31.0) };
            let way = settings.approach + bridge.length() + train.wheelbase();
            let step = |count: f64| Some(way / count / settings.speed);
            let [coarse, fine] = [64.0, 512.0]
                .map(|count| crossed(model, &train, direction, &Settings { step: step(count), ..settings.clone() }));
            assert_eq!(fine.len(), 8 * (coarse.len() - 1) + 1);
            let modes = model.omega.len();
            for (ours, theirs) in [(&coarse.a, &fine.a), (&coarse.a_dot, &fine.a_dot), (&coarse.a_ddot, &fine.a_ddot)] {
                let picked: Vec<f64> =
                    (0..coarse.len()).flat_map(|row| theirs[8 * row * modes..][..modes].to_vec()).collect();
                // A force on a free end is there or not by rounding.
                let skip = if ours == &coarse.a_ddot { 1 } else { 0 };
                let count = ours.len() - skip * modes;
                let off = largest_difference(&ours[..count], &picked[..count]) / largest_magnitude(&picked);
                println!("{name}: {off:.1e}");
                assert!(off < ROUNDING, "{name}, {direction:?}: {off:e}");
            }
        }
    }
}

/// The coupled engine in fine steps: the same bridge with its damping as a full matrix.
#[test]
fn as_the_coupled_engine() {
    let train = Vehicle::force_train(&[9e4, 4e4, 1.3e5], &[0.0, -1.8, -7.7]).unwrap();
    let model = simple_beam(3, 60, &[0.02, 0.05, 0.01]);
    let rates = model.damping.rates(&model.omega).unwrap();
    let full = Mat::from_fn(3, 3, |i, j| if i == j { rates[i] } else { 0.0 });
    let coupled = ModalBridge { damping: ModalDamping::Coupled(full), ..model.clone() };
    let settings = Settings { step: Some(2e-6), tail: Tail::Fixed(0.02), ..Settings::at_speed(80.0) };
    let [ours, theirs] = [&model, &coupled].map(|model| crossed(model, &train, Direction::Right, &settings));
    for (ours, theirs) in [(&ours.a, &theirs.a), (&ours.a_dot, &theirs.a_dot), (&ours.a_ddot, &theirs.a_ddot)] {
        assert_eq!(ours.len(), theirs.len());
        let off = largest_difference(ours, theirs) / largest_magnitude(theirs);
        println!("{off:.1e}");
        assert!(off < COUPLED, "{off:e}");
    }
}
