//! The march in time: orders of convergence, stability, limits, tail and approach.

use crate::problems::*;
use crate::problems::{beam, continuous};
use faer::Mat;
use spanwise::bridge::Stations;
use spanwise::crossing::History;
use spanwise::damping::Damping;
use spanwise::error::Error;
use spanwise::passage::{Drive, Settings, Tail};
use spanwise::recovery::Recovery::ForceSummation;
use spanwise::statics::Quantity;
use spanwise::stop_token::StopToken;
use spanwise::vehicle::Vehicle;

/// Newmark's method with γ = ½ is of second order; an observed order may differ from it by this much.
const ORDER: f64 = 2.0;
const ORDER_MARGIN: f64 = 0.1;

/// Two computations of the same thing, relative to its largest value.
const ROUNDING: f64 = 1e-9;

/// Modal coordinates, heave and pitch at one instant.
fn state(history: &History, row: usize) -> Vec<f64> {
    let mut state = history.a[row * history.modes..][..history.modes].to_vec();
    state.extend([history.motion[row * 9], history.motion[row * 9 + 3]]);
    state
}

/// Orders between neighbouring halvings of the step, by Richardson's differences of the state at `feet` along the path.
fn orders_of_state(vehicle: &Vehicle, drive: Drive, beta: f64, feet: usize) -> Vec<f64> {
    let runs: Vec<Run> = (4..=7)
        .map(|halvings| kishan_in_steps(vehicle, drive.clone(), beta, KISHAN_PATH << halvings, &[0.0]))
        .collect();
    let states = runs.iter().map(|run| {
        let history = &run.outcome.history;
        let row = (history.len() - 1) / KISHAN_PATH * feet;
        assert!((history.time[row] * 75.0 - feet as f64).abs() < ROUNDING, "not the fixed time");
        state(history, row)
    });
    let states: Vec<Vec<f64>> = states.collect();
    // Each coordinate in units of what it reaches in the finest run.
    let finest = &runs[runs.len() - 1].outcome.history;
    let scale: Vec<f64> = (0..finest.len())
        .map(|row| state(finest, row))
        .fold(vec![0.0; finest.modes + 2], |m, s| m.iter().zip(&s).map(|(m, s)| m.max(s.abs())).collect());
    let differences: Vec<f64> = states
        .windows(2)
        .map(|w| (0..scale.len()).map(|i| ((w[0][i] - w[1][i]) / scale[i]).powi(2)).sum::<f64>().sqrt())
        .collect();
    differences.windows(2).map(|w| (w[0] / w[1]).log2()).collect()
}

#[test]
fn second_order_at_constant_speed() {
    for vehicle in linear_vehicles() {
        for beta in [1.0 / 6.0, 0.25] {
            // Past one, two and three crossings of a support, and with the front axle off the bridge.
            for feet in [12, 50, 70, 100, 130] {
                let orders = orders_of_state(&vehicle, Drive::ConstantSpeed, beta, feet);
                println!("beta {beta:.3}, front axle at {feet} ft: orders {orders:.3?}");
                assert!(orders.iter().all(|o| (o - ORDER).abs() <= ORDER_MARGIN), "beta {beta}, {feet} ft: {orders:?}");
            }
        }
    }
}

/// Under constant traction the body feels the slope under its axles, which jumps where one enters the deflected
/// bridge: until the second axle does, the order is two.
#[test]
fn second_order_under_constant_traction() {
    for vehicle in linear_vehicles() {
        for beta in [1.0 / 6.0, 0.25] {
            for feet in [8, 12] {
                let orders = orders_of_state(&vehicle, Drive::ConstantTraction, beta, feet);
                println!("beta {beta:.3}, front axle at {feet} ft: orders {orders:.3?}");
                assert!(orders.iter().all(|o| (o - ORDER).abs() <= ORDER_MARGIN), "beta {beta}, {feet} ft: {orders:?}");
            }
        }
    }
}

/// Largest and smallest deflection, moment and shear at all sections.
///
/// How much a single extreme misses depends on where the steps fall around its peak: between nothing and a bound that
/// goes with the square of the step. The root mean square over all sections evens that out.
#[test]
fn extremes_converge_at_second_order() {
    let counts = [430, 610, 870, 1240, 1760, 2500, 3500];
    let sizes: Vec<f64> = counts.iter().map(|&n| 1.0 / n as f64).collect();
    for drive in [Drive::ConstantSpeed, Drive::ConstantTraction] {
        for vehicle in linear_vehicles() {
            for quantity in [Quantity::Deflection, Quantity::Moment, Quantity::ShearLeft] {
                let extremes = |count: usize| -> Vec<f64> {
                    let run = kishan_in_steps(&vehicle, drive.clone(), 1.0 / 6.0, count, &[]);
                    let dynamic = run.analysis.envelope_of(&run.outcome, quantity, StopToken::NEVER).unwrap().dynamic;
                    dynamic.max.iter().chain(&dynamic.min).map(|e| e.value).collect()
                };
                let exact = extremes(40_000);
                let errors: Vec<f64> = counts
                    .iter()
                    .map(|&count| {
                        let squares = extremes(count).iter().zip(&exact).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
                        (squares / exact.len() as f64).sqrt() / largest_magnitude(&exact)
                    })
                    .collect();
                let order = observed_order(&sizes, &errors);
                println!("{drive:?}, {quantity:?}: order {order:.3}, errors {:.1e} to {:.1e}", errors[0], errors[6]);
                assert!((order - ORDER).abs() <= ORDER_MARGIN, "{drive:?}, {quantity:?}: {order}, {errors:?}");
            }
        }
    }
}

#[test]
fn steps_beyond_the_stability_limit_are_refused() {
    let bridge = kishan_bridge();
    let vehicle = kishan_vehicle_with_friction(f64::INFINITY);
    let with = |beta: f64, step: Option<f64>, tail: f64| {
        let settings = Settings { beta, step, tail: Tail::Fixed(tail), ..Settings::at_speed(20.0) };
        run(&bridge, &vehicle, &settings, 6, &undamped(), ForceSummation, &[0.0])
    };
    let refused = with(1.0 / 6.0, Some(1.0), 0.0).map(|_| ()).unwrap_err();
    let Error::StepTooLong { limit, .. } = refused else { panic!("{refused}") };
    assert!(refused.to_string().contains(&format!("{limit:.6e}")) && refused.is_input(), "{refused}");
    assert!(with(1.0 / 6.0, Some(1.001 * limit), 0.0).is_err());
    // √12/ω for the bridge alone; the vehicle makes it less.
    let alone = 12.0_f64.sqrt() / with(1.0 / 6.0, None, 0.0).unwrap().analysis.modes.omega[5];
    println!("limit {limit:.4e} s, of the bridge alone {alone:.4e} s");
    assert!(limit < alone && limit > 0.5 * alone, "limit {limit:e}, of the bridge alone {alone:e}");

    let reached = |run: Run| largest_magnitude(&run.outcome.history.a);
    let fine = reached(with(1.0 / 6.0, None, 20.0).unwrap());
    for (beta, step) in [(1.0 / 6.0, 0.99 * limit), (0.25, 0.99 * limit), (0.25, 10.0 * limit)] {
        let coarse = reached(with(beta, Some(step), 20.0).unwrap());
        println!("beta {beta:.3}, step {:.2} of the limit: {:.3} of the fine run", step / limit, coarse / fine);
        assert!(coarse <= 1.2 * fine, "beta {beta}, step {step}: {coarse:e}, in fine steps {fine:e}");
    }
}

/// The slower, the more static: at walking pace nothing is left of the dynamics.
#[test]
fn slow_crossings_are_static() {
    let bridge = kishan_bridge();
    let stations: Vec<f64> = bridge.stations().iter().map(|s| s.at).collect();
    let excess = |speed: f64| {
        let settings = Settings { step: Some(4e-3), ..Settings::at_speed(speed) };
        let damping = Damping::Ratios(vec![0.02]);
        let run = run(&bridge, &kishan_vehicle(), &settings, 3, &damping, ForceSummation, &stations).unwrap();
        let factors = [Quantity::Deflection, Quantity::Moment].map(|quantity| run.impact(quantity));
        factors.concat().iter().fold(0.0_f64, |m, f| m.max((f - 1.0).abs()))
    };
    let [fast, slow, slower] = [20.0, 2.0, 0.5].map(excess);
    println!("impact factors off one by {fast:.1e} at 20 m/s, {slow:.1e} at 2 m/s, {slower:.1e} at 0.5 m/s");
    assert!(slow < 0.3 * fast && slower < 0.5 * slow && slower < 5e-3, "{fast:e}, {slow:e}, {slower:e}");
}

/// A load on the tip of a cantilever stands in a hollow; a slow vehicle does not climb out of it by itself.
#[test]
fn constant_traction_may_not_carry_the_vehicle_out_of_a_hollow() {
    let bridge = beam(9.0, vec![clamped(9.0)], &[1.9e9], &[6e3], &Stations::PerSpan(vec![5]), &[]).unwrap();
    let at = |speed: f64, drive: Drive| {
        let settings = Settings { drive: drive.clone(), step: Some(2e-3), ..Settings::at_speed(speed) };
        run(&bridge, &kishan_vehicle(), &settings, 2, &undamped(), ForceSummation, &[0.0]).map(|_| ())
    };
    match at(0.2, Drive::ConstantTraction) {
        Err(Error::Stopped { time, position }) => {
            println!("stops after {time:.2} s at {position:.2} m");
            assert!(time > 0.0 && position > 0.0 && position < bridge.length(), "{time} s, {position} m");
        }
        other => panic!("{other:?}"),
    }
    at(2.0, Drive::ConstantTraction).unwrap();
    at(0.2, Drive::ConstantSpeed).unwrap();
}

#[test]
fn the_tail_adds_to_the_extremes() {
    let bridge = kishan_bridge();
    for drive in [Drive::ConstantSpeed, Drive::ConstantTraction] {
        let with = |tail: f64| {
            let settings = Settings {
                drive: drive.clone(),
                tail: Tail::Fixed(tail),
                step: Some(1e-3),
                ..Settings::at_speed(40.0)
            };
            run(&bridge, &kishan_vehicle(), &settings, 3, &undamped(), ForceSummation, &[]).unwrap()
        };
        let [none, long] = [0.0, 1.2345].map(with);
        let end = |run: &Run| run.outcome.history.time[run.outcome.history.len() - 1];
        assert!((end(&long) - end(&none) - 1.2345).abs() < 1e-9, "{} s and {} s", end(&none), end(&long));
        let rear = none.rows().last().unwrap().positions[1];
        assert!((rear - bridge.length()).abs() < 1e-9, "{drive:?} ends with the last axle at {rear} m");
        let [a, b] = [&none, &long].map(|run| &run.outcome.envelope.dynamic);
        let pairs = |list: fn(&spanwise::crossing::Extremes) -> &Vec<spanwise::crossing::Extreme>| {
            list(a).iter().zip(list(b)).map(|(a, b)| b.value - a.value).collect::<Vec<_>>()
        };
        let (max, min) = (pairs(|e| &e.max), pairs(|e| &e.min));
        let rounding = 1e-9 * a.max.iter().fold(0.0_f64, |m, e| m.max(e.value));
        assert!(max.iter().all(|&d| d >= -rounding) && min.iter().all(|&d| d <= rounding), "{max:?} {min:?}");
        // The bridge swings up more in the tail than under the vehicle.
        assert!(min[long.analysis.responses.range(Quantity::Deflection)].iter().any(|&d| d < 0.0), "{min:?}");
    }
}

/// On the approach nothing moves; then the crossing goes as without it.
#[test]
fn the_approach_is_at_rest() {
    let bridge = kishan_bridge();
    let step = KISHAN_PATH as f64 / 75.0 / 2010.0;
    for drive in [Drive::ConstantSpeed, Drive::ConstantTraction] {
        let after = |steps: usize| {
            let approach = steps as f64 * step * 75.0 * FOOT;
            let settings =
                Settings { drive: drive.clone(), approach, step: Some(step), ..Settings::at_speed(75.0 * FOOT) };
            run(&bridge, &kishan_vehicle(), &settings, 3, &undamped(), ForceSummation, &[0.0]).unwrap()
        };
        let [none, some] = [0, 500].map(after);
        let (a, b) = (&none.outcome.history, &some.outcome.history);
        assert_eq!(a.len() + 500, b.len());
        for row in some.rows().take(500) {
            assert!(row.positions[0] < 0.0 && row.a.iter().all(|&a| a == 0.0), "at {} s", row.time);
            assert_eq!(row.loads, b.static_loads, "at {} s", row.time);
        }
        let (m, k) = (a.modes, a.axles);
        let apart = largest_difference(&a.a, &b.a[500 * m..]) / largest_magnitude(&a.a);
        let loads = largest_difference(&a.loads, &b.loads[500 * k..]) / largest_magnitude(&a.loads);
        println!("{drive:?}: {apart:.1e}, {loads:.1e}");
        assert!(apart <= ROUNDING && loads <= ROUNDING, "{drive:?}: {apart:e}, {loads:e}");
    }
}

/// The weight is the only excitation: without friction or lift-off, all is proportional to gravity.
#[test]
fn linear_in_gravity() {
    let bridge = kishan_bridge();
    let responses = |gravity: f64, friction: f64, drive: Drive| {
        let settings = Settings { drive: drive.clone(), gravity, step: Some(2e-3), ..Settings::at_speed(20.0) };
        let vehicle = kishan_vehicle_with_friction(friction);
        run(&bridge, &vehicle, &settings, 3, &undamped(), ForceSummation, &[]).unwrap().responded[0].clone()
    };
    let apart = |friction: [f64; 2], drive: Drive| {
        let once: Vec<f64> = responses(4.0, friction[0], drive.clone()).iter().map(|v| 2.5 * v).collect();
        largest_difference(&once, &responses(10.0, friction[1], drive)) / largest_magnitude(&once)
    };
    let speed = Drive::ConstantSpeed;
    let limit = 300.0 * POUND;
    for friction in [[0.0; 2], [f64::INFINITY; 2], [limit, 2.5 * limit]] {
        let apart = apart(friction, speed.clone());
        assert!(apart <= ROUNDING, "friction {friction:?}: {apart:e}");
    }
    // What is not linear: friction that does not grow with the weight, and a speed that follows the slope.
    for apart in [apart([limit; 2], speed), apart([0.0; 2], Drive::ConstantTraction)] {
        assert!(apart > 1e3 * ROUNDING, "{apart:e}");
    }
}

#[test]
fn refusals() {
    let bridge = kishan_bridge();
    let key_of = |settings: Settings, damping: Damping| match run(
        &bridge,
        &kishan_vehicle(),
        &settings,
        3,
        &damping,
        ForceSummation,
        &[0.0],
    ) {
        Err(Error::Input { key, .. }) => key,
        other => panic!("{:?}", other.map(|_| ())),
    };
    let good = kishan_settings();
    for (key, settings) in [
        ("speed", Settings { speed: 0.0, ..good.clone() }),
        ("speed", Settings { speed: f64::NAN, ..good.clone() }),
        ("approach", Settings { approach: -1.0, ..good.clone() }),
        ("tail", Settings { tail: Tail::Fixed(f64::INFINITY), ..good.clone() }),
        ("gravity", Settings { gravity: 0.0, ..good.clone() }),
        ("step", Settings { step: Some(0.0), ..good.clone() }),
        ("step", Settings { step: Some(1e-9), ..good.clone() }),
        ("speed", Settings { speed: 1e-5, step: None, ..good.clone() }),
        ("beta", Settings { beta: 0.05, ..good.clone() }),
        ("beta", Settings { beta: 0.51, ..good.clone() }),
    ] {
        assert_eq!(key_of(settings.clone(), undamped()), key, "{settings:?}");
    }
    let viscous = |c: &dyn Fn(usize, usize) -> f64, n: usize| Damping::Viscous(Mat::from_fn(n, n, c));
    for damping in [
        Damping::Ratios(vec![1.0]),
        Damping::Ratios(vec![-0.01]),
        Damping::Ratios(vec![0.01, 0.01]),
        viscous(&|i, j| f64::from(i == j), 5),
        viscous(&|i, j| if i > j { 1.0 } else { 0.0 }, 6),
        viscous(&|i, j| if i == j { -1.0 } else { 0.0 }, 6),
        viscous(&|_, _| f64::NAN, 6),
    ] {
        assert_eq!(key_of(good.clone(), damping.clone()), "damping", "{damping:?}");
    }
    let long = continuous(&[100.0], [PINNED; 2], &[1e11], &[1e4], &Stations::PerSpan(vec![9]), &[]).unwrap();
    let run = run(&long, &kishan_vehicle(), &Settings::at_speed(5.0), 3, &undamped(), ForceSummation, &[0.0]).unwrap();
    let settings = Settings { step: Some(1e-3), ..Settings::at_speed(5.0) };
    let stopped = run.analysis.cross(&kishan_vehicle(), &settings, StopToken::when(&|| true)).map(|_| ());
    assert_eq!(stopped, Err(Error::Interrupted));
}
