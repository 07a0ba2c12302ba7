//! Massless axles with dampers against an integration of their own, and leaf springs that feed no energy in.

use crate::problems::continuous;
use crate::problems::mechanics::meet;
use std::sync::Arc;

use crate::problems::mechanics::{motion, orders, profile, runge_kutta};
use crate::problems::vehicles::leaf;
use crate::problems::*;
use spanwise::bridge::Stations;
use spanwise::passage::Settings;
use spanwise::recovery::Recovery::ForceSummation;
use spanwise::road::Road;
use spanwise::vehicle::{Axle, Friction, Vehicle};

/// An observed order may differ from that of the rule by this much.
const ORDER_MARGIN: f64 = 0.1;

/// Bounce at the finest step against Runge and Kutta, relative to the largest.
const SECOND: f64 = 1e-5;
const FIRST: f64 = 2e-2;

/// Two computations of the same thing, relative to its largest value.
const ROUNDING: f64 = 1e-9;

const MASS: f64 = 17_300.0;
const TYRE: f64 = 1.75e6;
const SPRING: f64 = 4e5;
const SPEED: f64 = 20.0;
const APPROACH: f64 = 20.0;
const SPAN: f64 = 10.0;

fn quarter_car(tyre_damping: f64, suspension_damping: f64, friction: Friction) -> Vehicle {
    let axle = Axle { tyre_damping, suspension_damping, friction, ..Axle::new(0.0, TYRE, SPRING) };
    Vehicle::new(MASS, 1.0, 0.0, vec![axle]).unwrap()
}

/// A rise by 20 mm along two metres, twice differentiable.
fn rise(x: f64) -> f64 {
    let t = ((x + 18.0) / 2.0).clamp(0.0, 1.0);
    0.02 * t * t * t * (10.0 + t * (6.0 * t - 15.0))
}

/// Bounce, its rate and the shortening after 18 m, all on the approach, in so many steps to a metre.
fn crossed(vehicle: &Vehicle, road: &Road, per_metre: usize) -> Vec<f64> {
    let stations = Stations::PerSpan(vec![3]);
    let bridge = continuous(&[SPAN], [PINNED; 2], &[2e9], &[5e3], &stations, &[]).unwrap();
    let settings = Settings {
        approach: APPROACH,
        road: Arc::new(road.clone()),
        step: Some(1.0 / per_metre as f64 / SPEED),
        ..Settings::at_speed(SPEED)
    };
    let run = run(&bridge, vehicle, &settings, 1, &undamped(), ForceSummation, &[5.0]).unwrap();
    let row = 18 * per_metre;
    assert!((run.outcome.history.positions[row] + 2.0).abs() < ROUNDING);
    assert!(run.outcome.history.lift_offs().is_empty());
    let [z, v, _] = motion(&run, 0, row)[0];
    vec![z, v, run.outcome.history.shortenings[row]]
}

/// The same without friction, from m z̈ = −p, p = k_t(d − s) + c_t(ḋ − ṡ) = k_s s + c_s ṡ.
fn by_runge_kutta(tyre_damping: f64, suspension_damping: f64, road: &Road) -> Vec<f64> {
    let road = road.off(road.datum(-APPROACH, SPAN));
    let slopes = |t: f64, y: &[f64]| {
        let point = road.at(SPEED * t - APPROACH);
        let (d, rate) = (y[0] + point.elevation, y[1] + SPEED * point.slope);
        let s_dot = (TYRE * (d - y[2]) + tyre_damping * rate - SPRING * y[2]) / (tyre_damping + suspension_damping);
        vec![y[1], -(SPRING * y[2] + suspension_damping * s_dot) / MASS, s_dot]
    };
    // It starts at rest on the road there.
    let mut y = vec![-road.at(-APPROACH).elevation, 0.0, 0.0];
    let n = 36_000;
    let h = 18.0 / SPEED / f64::from(n);
    for i in 0..n {
        runge_kutta(&mut y, f64::from(i) * h, h, &slopes);
    }
    y
}

/// The response of massless axles with dampers is of second order on a road.
fn second_order(road: &Road) {
    for (tyre, suspension) in [(0.0, 4e4), (2e4, 0.0), (1e4, 4e4)] {
        let exact = by_runge_kutta(tyre, suspension, road);
        let vehicle = quarter_car(tyre, suspension, Friction::NONE);
        let sizes = [50, 100, 200, 400];
        let errors = sizes.map(|n| {
            let own = crossed(&vehicle, road, n);
            own.iter().zip(&exact).map(|(a, b)| ((a - b) / b).powi(2)).sum::<f64>().sqrt()
        });
        let order = -observed_order(&sizes.map(|n| n as f64), &errors);
        println!("dampers {tyre} and {suspension} N s/m: {errors:?}, order {order:.3}");
        assert!(errors[3] <= SECOND && (order - 2.0).abs() <= ORDER_MARGIN, "{errors:?}, order {order}");
    }
}

#[test]
fn dampers_of_massless_axles() {
    second_order(&profile([-30.0, 20.0], rise));
}

/// The same where the vehicle begins on a rise: its dampers move from the first instant.
#[test]
fn dampers_that_begin_on_a_slope() {
    second_order(&profile([-30.0, 20.0], |x| rise(x + 2.7)));
}

/// Damped or not, a suspension begins with the friction it has in the static state.
#[test]
fn dampers_keep_the_initial_friction() {
    // Level over the 10 m whose line the vehicle starts on.
    let road = profile([-40.0, 20.0], rise);
    let stations = Stations::PerSpan(vec![3]);
    let bridge = continuous(&[SPAN], [PINNED; 2], &[2e9], &[5e3], &stations, &[]).unwrap();
    let settings = Settings { approach: 30.0, road: Arc::new(road), ..Settings::at_speed(SPEED) };
    for damper in [0.0, 4e4] {
        for friction in [Friction::coulomb(3e3), leaf(3e3, 1e-3)] {
            let vehicle = quarter_car(0.0, damper, Friction { initial: 2e3, ..friction });
            let run = run(&bridge, &vehicle, &settings, 1, &undamped(), ForceSummation, &[5.0]).unwrap();
            // Nothing moves before the rise.
            for (i, row) in run.rows().enumerate().take_while(|(_, row)| row.positions[0] < -18.5) {
                let load = row.loads[0] - run.outcome.history.static_loads[0];
                let found = run.outcome.history.friction[i];
                // The spline through the road's points rings by less than a micrometre ahead of the rise.
                assert!(load.abs() <= 1.0 && (found - 2e3).abs() <= 1.0, "{load} N, {found} N at {} s", row.time);
            }
        }
    }
}

/// With friction the rates are those of the step, so that what sticks stands still: first order. Friction that is next
/// to nothing leaves the answer where it was.
#[test]
fn dampers_beside_friction() {
    let road = profile([-30.0, 20.0], rise);
    let exact = by_runge_kutta(1e4, 4e4, &road);
    let slight = quarter_car(1e4, 4e4, Friction::coulomb(1e-6));
    let sizes = [100, 200, 400, 800];
    let errors = sizes.map(|n| {
        let own = crossed(&slight, &road, n);
        own.iter().zip(&exact).map(|(a, b)| ((a - b) / b).powi(2)).sum::<f64>().sqrt()
    });
    let order = -observed_order(&sizes.map(|n| n as f64), &errors);
    println!("{errors:?}, order {order:.3}");
    assert!(errors[3] <= FIRST && (order - 1.0).abs() <= ORDER_MARGIN, "{errors:?}, order {order}");
    // And friction that counts: it slides and sticks by turns.
    let vehicle = quarter_car(1e4, 4e4, Friction::coulomb(3e3));
    let answers: Vec<Vec<f64>> = [100, 200, 400, 800, 1600].map(|n| crossed(&vehicle, &road, n)).to_vec();
    let found = orders(&answers, &exact.iter().map(|v| v.abs()).collect::<Vec<_>>());
    println!("sliding: orders {found:.3?}");
    assert!(found.iter().all(|o| *o > 1.0 - 2.0 * ORDER_MARGIN), "{found:?}");
}

/// The road rises at once: without dampers in the tyre the load jumps by k_t times the rise, and nothing else does.
#[test]
fn a_step_in_the_road() {
    use spanwise::road::Feature;
    use spanwise::road::Patch;
    let step: Road = Feature::step(-10.0, 0.005, Patch::new(0.0).unwrap()).unwrap().into();
    let stations = Stations::PerSpan(vec![3]);
    let bridge = continuous(&[SPAN], [PINNED; 2], &[2e9], &[5e3], &stations, &[]).unwrap();
    for damper in [0.0, 4e4] {
        let jumps = [2e-4, 1e-4, 5e-5].map(|h| {
            let settings = Settings {
                approach: APPROACH,
                road: Arc::new(step.clone()),
                step: Some(h),
                ..Settings::at_speed(SPEED)
            };
            let vehicle = quarter_car(0.0, damper, Friction::NONE);
            let run = run(&bridge, &vehicle, &settings, 1, &undamped(), ForceSummation, &[5.0]).unwrap();
            let loads: Vec<f64> = run.outcome.history.loads.clone();
            loads.iter().find(|load| **load != loads[0]).unwrap() - loads[0]
        });
        // Both springs give way at once without a damper; one holds the suspension for a moment.
        let stiffness = if damper == 0.0 { TYRE * SPRING / (TYRE + SPRING) } else { TYRE };
        let errors = jumps.map(|jump| (jump / (0.005 * stiffness) - 1.0).abs());
        println!("damper {damper}: {errors:?}");
        assert!(errors[2] <= 5e-3, "damper {damper}: {errors:?}");
    }
}

/// Whatever the stroke, a leaf spring gives back no more than it has taken in; one that would is refused.
#[test]
fn leaf_springs_take_energy() {
    use spanwise::step::{Law, Stroke};
    let (limit, spring) = (4e3, 8e5);
    let longest = limit / spring;
    for decay in [0.1 * longest, 0.5 * longest, longest] {
        let law = Law::<f64>::new(&leaf(limit, decay), spring);
        let mut stroke = Stroke { shortening: 0.0, rate: 0.0, friction: 0.0 };
        // Loops of any amplitude, each gone through until it closes.
        for amplitude in [0.1, 0.5, 2.0, 8.0].map(|decays| decays * decay) {
            let mut work = 0.0;
            for i in 1..=4000 {
                let to = amplitude * (std::f64::consts::TAU * f64::from(i) / 400.0).sin();
                let (shortening, friction) = meet(&law, 1e14 * to, 1e14, &stroke);
                if i > 3600 {
                    work += 0.5 * (friction + stroke.friction) * (shortening - stroke.shortening);
                }
                assert!(friction.abs() <= limit * (1.0 + ROUNDING));
                stroke = Stroke { shortening, rate: 0.0, friction };
            }
            println!("decay {decay:.1e} m, amplitude {amplitude:.1e} m: {:.3} of F a", work / (limit * amplitude));
            assert!(work >= -1e-3 * limit * amplitude, "{work} J");
        }
    }
    let with = |decay: f64, limit: f64| {
        let axle = Axle { friction: leaf(limit, decay), ..Axle::new(0.0, TYRE, SPRING) };
        Vehicle::new(MASS, 1.0, 0.0, vec![axle])
    };
    with(3e3 / SPRING, 3e3).unwrap();
    for limit in [3e3, 0.0] {
        let refused = with(1.01 * 3e3 / SPRING, limit).unwrap_err();
        assert!(refused.is_input() && refused.to_string().contains("leaf_decay"), "{refused}");
    }
}
