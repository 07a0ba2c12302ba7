//! Orders of the time step for general vehicles, and motion along the road by hand.

use crate::problems::continuous;
use crate::problems::mechanics::{Budget, motion, orders, profile, run_all, state};
use crate::problems::vehicles::{articulated, elastic, half_car, hs20};
use crate::problems::*;
use spanwise::bridge::{Bridge, Stations};
use spanwise::damping::Damping;
use spanwise::passage::{Braking, Direction, Drive, Passage, Settings, Tail};
use spanwise::recovery::Recovery::ForceSummation;
use spanwise::road::Road;
use spanwise::statics::Quantity;
use spanwise::vehicle::{Friction, Vehicle};

/// Newmark's method with γ = ½ is of second order; an observed order may differ from it by this much.
const ORDER: f64 = 2.0;
const ORDER_MARGIN: f64 = 0.1;

/// Two computations of the same thing, relative to its largest value.
const ROUNDING: f64 = 1e-9;

/// What is left of the vehicle's rocking some seconds after its brakes are on, relative to the load that they shift.
const LEFT: f64 = 1e-3;

const GRAVITY: f64 = 9.806_65;

/// Simple span of 24 m. Axles of the vehicles here are quarters of a metre apart or less, and the approach is 12 m.
const SPAN: f64 = 24.0;
const APPROACH: f64 = 12.0;

fn bridge(stiffer: f64) -> Bridge {
    let stations = Stations::PerSpan(vec![11]);
    continuous(&[SPAN], [PINNED; 2], &[4e9 * stiffer], &[8e3], &stations, &[]).unwrap()
}

fn damping() -> Damping {
    Damping::Ratios(vec![0.01])
}

fn crossed(bridge: &Bridge, vehicle: &Vehicle, settings: &Settings) -> Run {
    run(bridge, vehicle, settings, 3, &damping(), ForceSummation, &[0.5 * SPAN]).unwrap()
}

/// State when the front axle has come a certain way at its first speed, in steps of some 50 mm, halved so many times.
fn states(vehicle: &Vehicle, settings: &Settings, way: f64, halvings: std::ops::Range<u32>) -> Vec<Vec<f64>> {
    let path = APPROACH + SPAN + vehicle.wheelbase();
    let acceleration = if let Drive::Acceleration(a) = settings.drive { a } else { 0.0 };
    let speed = settings.speed;
    let duration = 2.0 * path / (speed + (speed * speed + 2.0 * acceleration * path).sqrt());
    let steps = (duration * speed / 0.05).round();
    let row = (way / speed / (duration / steps)).round() as usize;
    let of = |halvings: u32| {
        let step = duration / steps / f64::from(1 << halvings);
        let run = crossed(&bridge(1.0), vehicle, &Settings { step: Some(step), ..settings.clone() });
        let history = &run.outcome.history;
        let row = row << halvings;
        assert!((history.time[row] - row as f64 * step).abs() < ROUNDING, "not the fixed time");
        state(&run, row, true)
    };
    halvings.map(of).collect()
}

fn observed(vehicle: &Vehicle, settings: &Settings, way: f64, halvings: std::ops::Range<u32>) -> Vec<f64> {
    let states = states(vehicle, settings, way, halvings);
    let scale: Vec<f64> = states[0].iter().map(|v| v.abs().max(1e-12)).collect();
    orders(&states, &scale)
}

/// Settings of an approach on which nothing happens, to a path that is a multiple of 50 mm.
fn settings(drive: Drive) -> Settings {
    Settings { drive, approach: APPROACH, ..Settings::at_speed(20.0) }
}

/// Two humps of 4 mm, one on the approach, under the front axle from the start, and one on the bridge.
fn humps() -> Road {
    profile([-60.0, 60.0], |x| {
        let hump = |middle: f64| {
            let t = (x - middle) / 6.0;
            if t.abs() < 1.0 { 0.004 * (1.0 - t * t).powi(4) } else { 0.0 }
        };
        hump(-9.0) + hump(11.0)
    })
}

/// Rates count where a tyre has a damper; the slope under an axle that meets the deflected bridge jumps then.
#[test]
fn tyre_damping_is_of_second_order_until_the_second_axle_enters() {
    let vehicle = half_car([700.0, 1100.0], 1.0, 5.0, Friction::NONE);
    let drive = Drive::ConstantSpeed;
    for way in [13.0, 16.0] {
        let orders = observed(&vehicle, &settings(drive.clone()), way, 1..5);
        println!("front axle at {way} m: orders {orders:.3?}");
        assert!(orders.iter().all(|o| (o - ORDER).abs() <= ORDER_MARGIN), "{way} m: {orders:?}");
    }
    // The second axle enters at 16.75 m. What that leaves of first order is small later on.
    let orders = observed(&vehicle, &settings(drive.clone()), 17.0, 3..8);
    println!("front axle at 17 m: orders {orders:.3?}");
    assert!(orders.iter().all(|o| (o - 1.0).abs() <= ORDER_MARGIN), "{orders:?}");
    let orders = observed(&vehicle, &settings(drive), 30.0, 3..8);
    println!("front axle at 30 m: orders {orders:.3?}");
    assert!(orders.iter().all(|&o| o >= 1.0 - ORDER_MARGIN), "{orders:?}");
}

/// Without dampers in the tyres the forces follow displacements alone, and axles may come and go.
#[test]
fn general_vehicles_are_of_second_order() {
    let bump = std::sync::Arc::new(humps());
    for (name, vehicle) in [
        ("unsprung masses", half_car([700.0, 1100.0], 1.0, 0.0, Friction::NONE)),
        ("articulated", articulated(0.5, 0.0)),
    ] {
        for beta in [1.0 / 6.0, 0.25] {
            for way in [16.0, 24.0, 33.0] {
                let settings = Settings { beta, road: bump.clone(), ..settings(Drive::ConstantSpeed) };
                let orders = observed(&vehicle, &settings, way, 2..6);
                println!("{name}, beta {beta:.3}, front axle at {way} m: orders {orders:.3?}");
                assert!(orders.iter().all(|o| (o - ORDER).abs() <= ORDER_MARGIN), "{name}, {way} m: {orders:?}");
            }
        }
    }
}

/// On the approach tyre damping costs no order on a road with a continuous slope, on which the front axle begins.
#[test]
fn tyre_damping_on_a_bump_is_of_second_order() {
    let road = std::sync::Arc::new(humps());
    for vehicle in [half_car([700.0, 1100.0], 1.0, 5.0, Friction::NONE), articulated(0.5, 2.0)] {
        for drive in [Drive::ConstantSpeed, Drive::ConstantTraction, Drive::Acceleration(-3.0)] {
            let settings = Settings { road: road.clone(), ..settings(drive.clone()) };
            let orders = observed(&vehicle, &settings, 8.0, 0..4);
            println!("{drive:?}: orders {orders:.3?}");
            assert!(orders.iter().all(|o| (o - ORDER).abs() <= ORDER_MARGIN), "{drive:?}: {orders:?}");
        }
    }
}

/// Wheels in the air and friction that gives way: kinks within steps, but nothing worse.
#[test]
fn lift_off_and_sliding_are_of_first_order_at_least() {
    let high = std::sync::Arc::new(profile([-60.0, 60.0], |x| 30.0 * humps().at(x).elevation));
    let low = std::sync::Arc::new(humps());
    for (name, vehicle, road, flies) in [
        ("lift-off", half_car([700.0, 1100.0], 0.5, 0.0, Friction::NONE), &high, true),
        ("sliding", half_car([700.0, 1100.0], 0.5, 0.0, elastic(2e3, 2e7)), &low, false),
        ("sliding, massless", half_car([0.0; 2], 0.0, 0.0, Friction::coulomb(2e3)), &low, false),
        ("both", half_car([700.0, 1100.0], 0.1, 0.5, elastic(4e3, 2e7)), &high, true),
    ] {
        let settings = Settings { road: road.clone(), ..settings(Drive::ConstantSpeed) };
        let run = crossed(&bridge(1.0), &vehicle, &settings);
        assert_eq!(!run.outcome.history.lift_offs().is_empty(), flies, "{name}");
        let at = states(&vehicle, &settings, 15.0, 1..8);
        let scale: Vec<f64> = at[0].iter().map(|v| v.abs().max(1e-12)).collect();
        let orders = orders(&at, &scale);
        let mean = orders.iter().sum::<f64>() / orders.len() as f64;
        println!("{name}: {mean:.2}, {orders:.2?}");
        assert!(mean >= 0.9, "{name}: {orders:?}");
    }
}

/// With all axles on the bridge a freely rolling vehicle loses nothing and gains nothing, its parts moving along the
/// road as bodies pitch.
#[test]
fn constant_traction_conserves_the_energy_of_an_articulated_vehicle() {
    for (name, vehicle, road) in [
        ("articulated", articulated(0.0, 0.0), Road::smooth()),
        ("articulated, rough", articulated(0.0, 0.0), humps()),
        ("unsprung masses", half_car([700.0, 1100.0], 0.0, 0.0, Friction::NONE), Road::smooth()),
    ] {
        let drifts: Vec<f64> = (1..5)
            .map(|halvings| {
                let per_metre = 20 << halvings;
                let step = 1.0 / f64::from(per_metre) / 20.0;
                let settings = Settings {
                    step: Some(step),
                    road: std::sync::Arc::new(road.clone()),
                    ..settings(Drive::ConstantTraction)
                };
                let run =
                    run(&bridge(1.0), &vehicle, &settings, 3, &undamped(), ForceSummation, &[0.5 * SPAN]).unwrap();
                let budget = Budget::of(&run, &vehicle, &road, 0.0, true);
                let interval = &budget.stored[26 * per_metre as usize..34 * per_metre as usize];
                let swing = motion(&run, 0, run.outcome.history.len() - 1).last().unwrap()[1] - 20.0;
                assert!(swing.abs() > 1e-6, "the speed does not change");
                let potential: f64 = (largest_magnitude(&run.outcome.history.a) * run.analysis.modes.omega[0]).powi(2);
                interval.iter().map(|e| (e - interval[0]).abs()).fold(0.0, f64::max) / potential
            })
            .collect();
        let orders: Vec<f64> = drifts.windows(2).map(|w| (w[0] / w[1]).log2()).collect();
        println!("{name}: {:.1e}, orders {orders:.3?}", drifts[0]);
        assert!(orders.iter().all(|o| (o - ORDER).abs() <= ORDER_MARGIN), "{name}: {orders:?}");
    }
}

fn braking(deceleration: f64, from: f64, ramp: f64, adhesion: f64) -> Drive {
    Drive::Braking(Braking { deceleration, from, ramp, adhesion })
}

/// m v̇ = Σ H − Σ B at every instant, H and B from the loads.
#[test]
fn braking_changes_the_momentum() {
    for (adhesion, locks) in [(0.8, false), (0.2, true)] {
        let (deceleration, from, ramp) = (4.0, -6.0, 0.4);
        let vehicle = articulated(1.0, 1.0);
        let settings = settings(braking(deceleration, from, ramp, adhesion));
        let run = crossed(&bridge(1.0), &vehicle, &Settings { step: Some(5e-4), ..settings });
        let shapes = crate::problems::mechanics::Shapes::new(&run.bridge, 3);
        let history = &run.outcome.history;
        let (weight, begins) = (vehicle.mass() * GRAVITY, (APPROACH + from) / 20.0);
        let (mut worst, mut slipping, mut pushed) = (0.0_f64, 0, 0.0_f64);
        for (i, row) in run.rows().enumerate() {
            // Where it stands nothing moves it, and the end of the last step is cut.
            if history.vehicles[0].stopped.is_some_and(|stopped| row.time >= stopped) || i + 1 == history.len() {
                break;
            }
            let level = ((row.time - begins) / ramp).clamp(0.0, 1.0);
            let mut force = 0.0;
            for k in 0..history.axles {
                let slope: f64 = shapes.at(row.positions[k]).iter().zip(row.a).map(|(shape, a)| shape[1] * a).sum();
                let asked = level * deceleration * history.static_loads[k] / GRAVITY;
                let bound = adhesion * row.loads[k];
                slipping += usize::from(bound < asked);
                force += row.loads[k] * slope - asked.min(bound);
                pushed = pushed.max((row.loads[k] * slope).abs());
            }
            let acceleration = motion(&run, 0, i).last().unwrap()[2];
            worst = worst.max((vehicle.mass() * acceleration - force).abs());
        }
        println!("adhesion {adhesion}: {:.1e}, slope up to {:.1e}", worst / weight, pushed / weight);
        // The brakes start within a step: their level is told to no better than the rounding of the path.
        assert!(worst <= 1e-6 * weight, "{worst} N");
        assert_eq!(slipping > 0, locks);
    }
}

/// By hand: the body's mass at its height, over the wheelbase; unsprung masses slow down at road level.
#[test]
fn load_transfer() {
    let vehicle = half_car([700.0, 1100.0], 2.0, 1.0, Friction::NONE);
    let transfer = 16_200.0 * 1.4 / 4.75;
    let along = |drive: Drive| {
        let settings = Settings { approach: 160.0, beta: 0.25, step: Some(1e-3), ..settings(drive) };
        crossed(&bridge(1e6), &vehicle, &settings)
    };
    for (name, drive) in [
        ("brakes", braking(1.0, -150.0, 0.3, 0.8)),
        ("prescribed", Drive::Acceleration(-1.0)),
        ("faster", Drive::Acceleration(1.0)),
    ] {
        let run = along(drive.clone());
        let sign = if name == "faster" { -1.0 } else { 1.0 };
        // Before it comes to the bridge, and on it.
        for at in [-2.0, 10.0] {
            let Some(row) = run.rows().find(|row| row.positions[0] >= at) else { panic!("{name} stops before {at}") };
            for (k, side) in [1.0, -1.0].into_iter().enumerate() {
                let change = row.loads[k] - run.outcome.history.static_loads[k];
                println!("{name}, {at} m: axle {k} {change:.3} N, by hand {:.3} N", sign * side * transfer);
                assert!((change - sign * side * transfer).abs() <= LEFT * transfer, "{name}: {change} N");
            }
        }
    }
}

#[test]
fn stopping_distance() {
    let vehicle = half_car([700.0, 1100.0], 1.0, 1.0, Friction::NONE);
    let (deceleration, from, ramp, speed) = (4.0, -45.0, 0.5, 20.0);
    let settings =
        Settings { approach: 50.0, beta: 0.25, step: Some(1e-3), ..settings(braking(deceleration, from, ramp, 0.9)) };
    let run = crossed(&bridge(1e6), &vehicle, &settings);
    let slower: f64 = speed - 0.5 * deceleration * ramp;
    let distance = speed * ramp - deceleration * ramp * ramp / 6.0 + slower * slower / (2.0 * deceleration);
    let time = (50.0 + from) / speed + ramp + slower / deceleration;
    let history = &run.outcome.history;
    let last = history.len() - 1;
    let [x, v, _] = *motion(&run, 0, last).last().unwrap();
    let stopped = history.vehicles[0].stopped.unwrap();
    let came = x + vehicle.positions()[0] - from;
    println!("{came:.5} m, by hand {distance:.5} m; after {stopped:.4} s, by hand {time:.4} s");
    assert!(v == 0.0 && (came - distance).abs() <= 1e-4 * distance, "{came} m");
    assert!((stopped - time).abs() <= 2.0 * history.step, "{stopped} s");
}

/// What has come to rest stands in the static state.
#[test]
fn a_vehicle_that_stops_on_the_bridge() {
    let vehicle = half_car([700.0, 1100.0], 2.0, 1.0, Friction::NONE);
    for direction in [Direction::Right, Direction::Left] {
        for (name, drive) in [
            ("brakes", braking(4.0, -45.0, 0.5, 0.9)),
            ("prescribed", Drive::Acceleration(-200.0 / 60.0)),
            ("history", Drive::Speeds { times: vec![1.0, 3.0, 4.0], speeds: vec![20.0, 18.0, 0.0] }),
        ] {
            let approach = if name == "history" { 58.0 } else { 50.0 };
            let settings = Settings { approach, tail: Tail::Fixed(40.0), step: Some(2e-3), ..settings(drive) };
            let passage = Passage { direction, ..Passage::of(vehicle.clone()) };
            let damping = Damping::Ratios(vec![0.05]);
            let sections = [0.3 * SPAN, 0.5 * SPAN];
            let run = run_all(&bridge(1.0), &[passage], &settings, 3, &damping, ForceSummation, &sections).unwrap();
            let history = &run.outcome.history;
            assert!(history.vehicles[0].stopped.is_some(), "{name}");
            let last = run.rows().last().unwrap();
            assert!(last.positions.iter().all(|&x| x > 0.0 && x < SPAN), "{name}: {:?}", last.positions);
            let apart = largest_difference(last.dynamic, last.at_rest) / largest_magnitude(last.at_rest);
            let loads = largest_difference(last.loads, &history.static_loads) / history.static_loads[0];
            let deflection = run.analysis.responses.range(Quantity::Deflection).start;
            println!("{name}, {direction:?}: {apart:.1e}, loads {loads:.1e}, {:.2e} m", last.dynamic[deflection]);
            assert!(apart <= 1e-6 && loads <= 1e-6, "{name}: {apart:e}, {loads:e}");
        }
    }
}

#[test]
fn prescribed_motion_is_exact() {
    let vehicle = half_car([700.0, 1100.0], 1.0, 1.0, Friction::NONE);
    let accelerated = |t: f64| -APPROACH + 20.0 * t - 1.25 * t * t;
    // 20 m/s to 1 s, down to 10 m/s at 1.5 s, up to 16 m/s at 2.5 s, and so on.
    let through = |t: f64| {
        let (first, second, third) = (t.min(1.0), (t - 1.0).clamp(0.0, 0.5), (t - 1.5).clamp(0.0, 1.0));
        let area = 20.0 * first + 20.0 * second - 10.0 * second * second + 10.0 * third + 3.0 * third * third;
        -APPROACH + area + 16.0 * (t - 2.5).max(0.0)
    };
    let speeds = Drive::Speeds { times: vec![1.0, 1.5, 2.5], speeds: vec![20.0, 10.0, 16.0] };
    let ways: [(Drive, &dyn Fn(f64) -> f64); 2] = [(Drive::Acceleration(-2.5), &accelerated), (speeds, &through)];
    for (drive, way) in ways {
        let run = crossed(&bridge(1.0), &vehicle, &settings(drive));
        for row in run.rows() {
            assert!((row.positions[0] - way(row.time)).abs() <= ROUNDING, "{} s: {:?}", row.time, row.positions);
            assert!((row.positions[0] - row.positions[1] - 4.75).abs() <= ROUNDING);
        }
        let last = run.rows().last().unwrap().positions[1];
        assert!((last - SPAN).abs() <= ROUNDING, "ends at {last} m");
    }
}

/// Through the hinge: the semitrailer leans on the tractor at the height of the fifth wheel.
#[test]
fn load_transfer_through_a_hinge() {
    let vehicle = hs20(5.0);
    let [tractor, trailer] = [&vehicle.bodies()[0], &vehicle.bodies()[1]];
    let (deceleration, hinge) = (1.0, 1.2);
    let shares = vehicle.static_loads(1.0);
    // Moments about the hinge of what is behind it, and of everything about the road below it; masses at road level and
    // brake forces there have no lever about the latter.
    let axle = vehicle.axles()[2];
    let lever = 2.338 + 2.283;
    let last = -((trailer.cg_height - hinge) * trailer.mass + hinge * (shares[2] - axle.mass)) * deceleration / lever;
    let rocking = (tractor.cg_height * tractor.mass + trailer.cg_height * trailer.mass) * deceleration;
    let (front, middle) = (1.698 + 2.215, -2.569 + 2.215);
    // P₁ + P₂ = −P₃ and P₁ x₁ + P₂ x₂ = rocking + P₃ · lever.
    let first = (rocking + last * lever + last * middle) / (front - middle);
    let by_hand = [first, -last - first, last];
    for drive in [Drive::Acceleration(-deceleration), braking(deceleration, -160.0, 0.3, 0.8)] {
        let settings = Settings { approach: 170.0, beta: 0.25, step: Some(1e-3), ..settings(drive.clone()) };
        let run = crossed(&bridge(1e6), &vehicle, &settings);
        let row = run.rows().find(|row| row.positions[0] >= 10.0).unwrap();
        for k in 0..3 {
            let change = row.loads[k] - run.outcome.history.static_loads[k];
            println!("axle {k}: {change:.3} N, by hand {:.3} N", by_hand[k]);
            assert!((change - by_hand[k]).abs() <= LEFT * by_hand[0], "{drive:?}, axle {k}: {change} N");
        }
    }
}

/// A vehicle that begins on a slope rolls down it from the first instant, at rest on its springs.
#[test]
fn the_first_instant_on_a_slope() {
    let vehicle = half_car([700.0, 1100.0], 1.0, 0.0, Friction::NONE);
    let road = humps();
    for direction in [Direction::Right, Direction::Left] {
        let road = match direction {
            Direction::Right => road.clone(),
            Direction::Left => profile([-40.0, 80.0], |x| humps().at(SPAN - x).elevation),
        };
        let settings = Settings { road: std::sync::Arc::new(road.clone()), ..settings(Drive::ConstantTraction) };
        let passage = Passage { direction, ..Passage::of(vehicle.clone()) };
        let run = run_all(&bridge(1.0), &[passage], &settings, 3, &damping(), ForceSummation, &[0.5 * SPAN]).unwrap();
        let row = run.rows().next().unwrap();
        let start = row.positions[0];
        let datum = road.datum(start, if direction == Direction::Right { SPAN } else { 0.0 });
        let road = road.off(datum);
        let weight: f64 = run.outcome.history.static_loads.iter().sum();
        let pulled = -direction.sign() * weight * datum.slope;
        let pushed: f64 =
            (0..2).map(|k| -direction.sign() * row.loads[k] * road.at(row.positions[k]).slope).sum::<f64>();
        let all = motion(&run, 0, 0);
        println!("{direction:?}: {:.3e} m/s², by hand {:.3e}", all[4][2], (pushed + pulled) / vehicle.mass());
        assert!((vehicle.mass() * all[4][2] - pushed - pulled).abs() <= ROUNDING * pushed.abs() && pushed < -1.0);
        for (load, at_rest) in row.loads.iter().zip(&run.outcome.history.static_loads) {
            assert!((load - at_rest).abs() <= ROUNDING * at_rest, "{load} N for {at_rest} N");
        }
        // And it pitches: J θ̈ = −h Σ H of the body, the springs at rest; weight pulls at the centres of mass.
        let body = 1.4 * 16_200.0 / vehicle.mass();
        let inertia = 93_457.0 + 1.4 * 1.4 * 16_200.0 * 1800.0 / vehicle.mass();
        assert!((inertia * all[1][2] + body * pushed).abs() <= ROUNDING * pushed.abs(), "{}", all[1][2]);
    }
}

/// Once it stands, a vehicle rocks about its wheels, and nothing is lost.
#[test]
fn rocking_about_standing_wheels() {
    let vehicle = half_car([700.0, 1100.0], 0.0, 0.0, Friction::NONE);
    let drifts: Vec<f64> = [2e-3, 1e-3, 5e-4]
        .into_iter()
        .map(|step| {
            let drive = braking(4.0, -45.0, 0.5, 0.9);
            let settings = Settings { approach: 50.0, tail: Tail::Fixed(3.0), step: Some(step), ..settings(drive) };
            let run = run(&bridge(1.0), &vehicle, &settings, 3, &undamped(), ForceSummation, &[0.5 * SPAN]).unwrap();
            let history = &run.outcome.history;
            let mut stored = Budget::of(&run, &vehicle, &Road::smooth(), 0.0, true).stored;
            let standing = vehicle.assembly().standing_mass();
            let first = history.time.iter().position(|&t| t >= history.vehicles[0].stopped.unwrap()).unwrap() + 1;
            let mut rocking = 0.0_f64;
            for (i, stored) in stored.iter_mut().enumerate() {
                let q = nalgebra::DVector::from_iterator(4, motion(&run, 0, i)[..4].iter().map(|c| c[1]));
                *stored += 0.5 * (&standing * &q).dot(&q);
                if i >= first {
                    rocking = rocking.max(0.5 * (&vehicle.assembly().mass * &q).dot(&q));
                }
            }
            let last = history.len() - 1;
            stored[first..last].iter().map(|e| (e - stored[first]).abs()).fold(0.0, f64::max) / rocking
        })
        .collect();
    println!("{drifts:?}");
    assert!(drifts[2] <= 2e-3 && drifts.windows(2).all(|w| w[1] < 0.35 * w[0]), "{drifts:?}");
}
