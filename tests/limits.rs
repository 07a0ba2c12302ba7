//! Limits in which one model turns into another, symmetry and repetition.

use crate::problems::continuous;
use crate::problems::mechanics::meet;
use std::sync::Arc;

use crate::problems::mechanics::{motion, profile, run_all};
use crate::problems::vehicles::{articulated, elastic, half_car, leaf};
use crate::problems::*;
use spanwise::bridge::{Bridge, Stations};
use spanwise::damping::Damping;
use spanwise::passage::{Braking, Direction, Drive, Passage, Settings, Tail};
use spanwise::recovery::Recovery::{ForceSummation, Superposition};
use spanwise::road::Road;
use spanwise::statics::Quantity;
use spanwise::step::{Law, Stroke};
use spanwise::vehicle::{Axle, BuildUp, Friction, Vehicle};

/// Two descriptions of the same thing, relative to its largest value.
const ROUNDING: f64 = 1e-9;

/// An observed order in a parameter may differ from the expected one by this much.
const ORDER_MARGIN: f64 = 0.15;

const SPAN: f64 = 25.0;

fn simple() -> Bridge {
    let stations = Stations::PerSpan(vec![9]);
    continuous(&[SPAN], [PINNED; 2], &[8e9], &[5e3], &stations, &[]).unwrap()
}

/// Average acceleration, so that stiff parts do not ask for shorter steps, and wheels that pull.
fn settings(speed: f64, step: f64) -> Settings {
    Settings { beta: 0.25, step: Some(step), lift_off: false, ..Settings::at_speed(speed) }
}

fn damping() -> Damping {
    Damping::Ratios(vec![0.02])
}

fn crossed(vehicle: &Vehicle, settings: &Settings) -> Run {
    run(&simple(), vehicle, settings, 3, &damping(), Superposition, &[0.4 * SPAN, 0.5 * SPAN]).unwrap()
}

/// Largest difference of deflections, relative to the largest.
fn apart(a: &Run, b: &Run) -> f64 {
    let [a, b] = [a, b].map(|run| run.history_of(Quantity::Deflection));
    largest_difference(&a, &b) / largest_magnitude(&b)
}

#[test]
fn sprung_masses_between_moving_mass_and_moving_force() {
    let (mass, speed, step) = (2e4, 30.0, 1e-4);
    let settings = settings(speed, step);
    let rigid = crossed(&Vehicle::moving_masses(&[mass], &[0.0]).unwrap(), &settings);
    let weight = mass * settings.gravity;
    let force = crossed(&Vehicle::force_train(&[weight], &[0.0]).unwrap(), &settings);
    assert!(apart(&rigid, &force) > 0.02, "the two limits are the same");
    // A spring on which the mass goes up and down 30 to 120 times while it crosses: its give goes with 1/k, and with
    // it the difference, but for the short time in which it settles.
    let stiff = [1.6e9, 3.2e9, 6.4e9, 12.8e9];
    let differences = stiff.map(|k| apart(&crossed(&sprung_mass(mass, k), &settings), &rigid));
    let order = observed_order(&stiff, &differences);
    println!("stiff: {differences:?}, order {order:.2}");
    assert!(differences[3] <= 1e-3 && (order + 1.0).abs() <= ORDER_MARGIN, "{differences:?}, order {order}");
    let soft = [1e4, 1e3, 1e2];
    let differences = soft.map(|k| apart(&crossed(&sprung_mass(mass, k), &settings), &force));
    let order = observed_order(&soft, &differences);
    println!("soft: {differences:?}, order {order:.2}");
    assert!(differences[2] <= 1e-4 && (order - 1.0).abs() <= ORDER_MARGIN, "{differences:?}, order {order}");
}

/// An axle whose mass vanishes against one without; the mass itself adds to the weight.
#[test]
fn unsprung_masses_vanish() {
    let settings = settings(25.0, 1e-4);
    let plain = half_car([0.0; 2], 1.0, 0.0, Friction::NONE);
    for (name, damper, friction, alike) in [
        ("no friction", 1.0, Friction::NONE, plain.clone()),
        // Every to and fro, however short, lets a leaf spring's force fade: a light damper keeps the axle from ringing.
        ("leaf spring", 0.02, leaf(1e3, 2e-4), half_car([0.0; 2], 0.02, 0.0, leaf(1e3, 2e-4))),
        // The stick of a massless axle is rigid, so that here it must be stiff.
        ("sliding", 0.0, elastic(1e3, 1e10), half_car([0.0; 2], 0.0, 0.0, Friction::coulomb(1e3))),
        ("locked", 0.0, elastic(f64::INFINITY, 1e8), with_springs(&half_car([0.0; 2], 0.0, 0.0, Friction::NONE), 1e8)),
    ] {
        let massless = crossed(&alike, &settings);
        if friction.limit > 0.0 && friction.limit.is_finite() {
            let limit = friction.limit * (1.0 - 1e-6);
            let slides = massless.outcome.history.friction.iter().any(|f| f.abs() >= 0.9 * limit);
            assert!(slides, "{name} does not slide");
        }
        let masses = [64.0, 16.0, 4.0, 1.0];
        let differences =
            masses.map(|mass| apart(&crossed(&half_car([mass; 2], damper, 0.0, friction), &settings), &massless));
        let order = observed_order(&masses, &differences);
        println!("{name}: {differences:?}, order {order:.2}");
        assert!(
            differences[3] <= 2e-4 && (order - 1.0).abs() <= ORDER_MARGIN,
            "{name}: {differences:?}, order {order}"
        );
    }
}

/// The same vehicle with stiffer suspensions.
fn with_springs(vehicle: &Vehicle, more: f64) -> Vehicle {
    let stiffer =
        |a: &Axle| Axle { suspension_stiffness: a.suspension_stiffness + more, friction: Friction::NONE, ..*a };
    let axles = vehicle.axles().iter().map(stiffer).collect();
    Vehicle::new(vehicle.bodies()[0].mass, vehicle.pitch_inertia(), vehicle.cg_height(), axles).unwrap()
}

#[test]
fn friction_between_none_and_locked() {
    let settings = settings(25.0, 1e-3);
    let with = |friction: Friction| half_car([700.0, 1100.0], 0.5, 0.5, friction);
    let stick = 2e7;
    let none = crossed(&with(Friction::NONE), &settings);
    let locked = crossed(&with_springs(&with(Friction::NONE), stick), &settings);
    // A stick that never gives way is a spring beside the spring.
    for limit in [f64::INFINITY, 1e7] {
        let apart = apart(&crossed(&with(elastic(limit, stick)), &settings), &locked);
        println!("limit {limit}: {apart:.1e}");
        assert!(apart <= ROUNDING, "{apart:e}");
    }
    let limits = [100.0, 10.0, 1.0, 0.1];
    for build_up in [BuildUp::Rigid, BuildUp::Elastic(stick), BuildUp::Leaf(1e-8)] {
        let of = |limit: f64| apart(&crossed(&with(Friction { limit, initial: 0.0, build_up }), &settings), &none);
        let differences = limits.map(of);
        let order = observed_order(&limits, &differences);
        println!("{build_up:?}: {differences:?}, order {order:.2}");
        assert!(differences[3] <= 1e-5 && (order - 1.0).abs() <= ORDER_MARGIN, "{build_up:?}: {differences:?}");
    }
}

/// A leaf spring whose force builds up at once slides like Coulomb's.
#[test]
fn leaf_springs_become_coulomb() {
    let settings = settings(25.0, 1e-4);
    for masses in [[0.0; 2], [700.0, 1100.0]] {
        let coulomb = match masses[0] > 0.0 {
            true => elastic(2e3, 1e10),
            false => Friction::coulomb(2e3),
        };
        let coulomb = crossed(&half_car(masses, 0.0, 0.0, coulomb), &settings);
        let decays = [1e-4, 5e-5, 2.5e-5, 1.25e-5];
        let differences =
            decays.map(|decay| apart(&crossed(&half_car(masses, 0.0, 0.0, leaf(2e3, decay)), &settings), &coulomb));
        let order = observed_order(&decays, &differences);
        println!("masses {masses:?}: {differences:?}, order {order:.2}");
        assert!(differences[3] <= 3e-3 && (order - 1.0).abs() <= 2.0 * ORDER_MARGIN, "{differences:?}, order {order}");
    }
}

/// A stroke to and fro in a leaf spring: where its force ends does not depend on the number of steps, and the recursion
/// of Fancher and others tends to it in small ones.
#[test]
fn leaf_springs_in_any_number_of_steps() {
    let (limit, decay, spring) = (4e3, 2e-3, 8e5);
    let law = Law::<f64>::new(&leaf(limit, decay), spring);
    // Ends of the strokes [m].
    let turns = [0.0, 7e-3, 1e-3, 2.5e-3, -4e-3, 5e-3];
    // Almost rigid, so that the stroke is as prescribed.
    let hard = 1e14;
    let walk = |steps: usize| {
        let mut stroke = Stroke { shortening: 0.0, rate: 0.0, friction: 0.0 };
        let mut recursion = 0.0;
        let mut ends = Vec::new();
        for pair in turns.windows(2) {
            for i in 1..=steps {
                let to = pair[0] + (pair[1] - pair[0]) * i as f64 / steps as f64;
                let (shortening, friction) = meet(&law, hard * to, hard, &stroke);
                let moved = shortening - stroke.shortening;
                let envelope = spring * shortening + limit.copysign(moved);
                recursion = envelope + (recursion - envelope) * (-moved.abs() / decay).exp();
                stroke = Stroke { shortening, rate: 0.0, friction };
            }
            ends.push([stroke.friction + spring * stroke.shortening, recursion]);
        }
        ends
    };
    let one = walk(1);
    for steps in [2, 17, 400] {
        for (a, b) in one.iter().zip(walk(steps)) {
            assert!((a[0] - b[0]).abs() <= 1e-6 * limit, "{steps} steps: {} N, in one {} N", b[0], a[0]);
        }
    }
    let counts = [200.0, 400.0, 800.0];
    let errors =
        counts.map(|n| walk(n as usize).iter().map(|[own, published]| (own - published).abs()).fold(0.0, f64::max));
    let order = observed_order(&counts, &errors);
    println!("published recursion: {errors:?} N, order {order:.3}");
    assert!(errors[2] <= 5e-3 * limit && (order + 1.0).abs() <= 0.05, "{errors:?}, order {order}");
    // In one stroke by hand: T lags kβ behind the envelope, up to what the beginning adds.
    let by_hand = spring * 7e-3 + (limit - spring * decay) * (1.0 - (-3.5_f64).exp());
    assert!((one[0][0] - by_hand).abs() <= 1e-6 * limit, "{} N, by hand {by_hand} N", one[0][0]);
}

/// Two linear vehicles act on each other through the bridge; constant forces do not.
#[test]
fn opposing_vehicles_superpose_as_they_become_light() {
    let settings = Settings { tail: Tail::Fixed(0.3), ..settings(25.0, 1e-3) };
    // Both, or one while a force next to nothing takes the place of the other, so that all take the same steps.
    let meeting = |vehicles: &[Vehicle; 2], which: [bool; 2]| -> Vec<f64> {
        let nothing = Vehicle::force_train(&[1e-12], &[0.0]).unwrap();
        let of = |k: usize| Passage::of(if which[k] { vehicles[k].clone() } else { nothing.clone() });
        let right = of(0);
        let left = Passage { lane: 1, direction: Direction::Left, entry: 0.1, speed: Some(21.0), ..of(1) };
        // A last one, far behind, ends all at the same time.
        let end = Passage { entry: 0.5, lane: 2, ..Passage::of(nothing.clone()) };
        let run =
            run_all(&simple(), &[right, left, end], &settings, 3, &damping(), ForceSummation, &[0.4 * SPAN]).unwrap();
        run.history_of(Quantity::Deflection)
    };
    let excess = |vehicles: &[Vehicle; 2]| {
        let [both, one, other] = [[true, true], [true, false], [false, true]].map(|which| meeting(vehicles, which));
        let sum: Vec<f64> = one.iter().zip(&other).map(|(a, b)| a + b).collect();
        largest_difference(&both, &sum) / largest_magnitude(&both)
    };
    let train = |loads: &[f64]| Vehicle::force_train(loads, &[4.0, 0.0][..loads.len()]).unwrap();
    let forces = excess(&[train(&[1e5, 7e4]), train(&[8e4])]);
    println!("forces: {forces:.1e}");
    let scales = [1.0, 0.25, 0.0625];
    let light = |scale: f64| excess(&[sprung_mass(3e4 * scale, 4e6 * scale), sprung_mass(2e4 * scale, 3e6 * scale)]);
    let differences = scales.map(light);
    let order = observed_order(&scales, &differences);
    println!("sprung masses: {differences:?}, order {order:.2}");
    assert!(forces <= ROUNDING, "{forces:e}");
    assert!(differences[0] > 1e-3 && (order - 1.0).abs() <= ORDER_MARGIN, "{differences:?}, order {order}");
}

/// The bridge turned round, with everything on it.
#[test]
fn mirrored_bridges_and_directions() {
    let stations = Stations::PerSpan(vec![4, 6]);
    let bridge = continuous(&[13.0, 19.0], [CLAMPED, PINNED], &[2.4e9, 1.9e9], &[7e3], &stations, &[]).unwrap();
    let length = bridge.length();
    let turned = mirrored(&bridge);
    let uneven = |x: f64| 0.012 * (1.3 * x).sin() + 0.008 * (2.9 * x + 1.0).cos() + 0.004 * (5.3 * x).sin();
    let ends = [-40.0, length + 50.0];
    let road = profile(ends, uneven);
    let turned_road = profile([length - ends[1], length - ends[0]], |x| uneven(length - x));
    let sections = [0.0, 3.0, 8.2, 13.0, 20.5, 32.0];
    let turned_sections: Vec<f64> = sections.iter().rev().map(|x| length - x).collect();
    let brakes = Braking { deceleration: 4.0, from: 3.0, ramp: 0.3, adhesion: 0.7 };
    let masses = Vehicle::moving_masses(&[8e3, 5e3], &[0.0, -4.0]).unwrap();
    let truck = half_car([700.0, 1100.0], 0.5, 1.0, elastic(3e3, 2e7));
    let paper = kishan_vehicle();
    for (name, vehicle, drive) in [
        ("half-car", &truck, Drive::ConstantSpeed),
        ("half-car", &truck, Drive::ConstantTraction),
        ("half-car", &truck, Drive::Braking(brakes)),
        ("articulated", &articulated(0.5, 1.0), Drive::Braking(brakes)),
        ("articulated", &articulated(0.5, 1.0), Drive::Acceleration(2.0)),
        ("massless", &paper, Drive::ConstantTraction),
        ("masses", &masses, Drive::Acceleration(-1.0)),
    ] {
        let go = |bridge: &Bridge, direction: Direction, road: &Road, sections: &[f64]| {
            let settings = Settings {
                drive: drive.clone(),
                approach: 12.0,
                ramp: 6.0,
                tail: Tail::Fixed(0.2),
                step: Some(1e-3),
                road: Arc::new(road.clone()),
                beta: 0.25,
                ..Settings::at_speed(22.0)
            };
            let passage = Passage { direction, ..Passage::of(vehicle.clone()) };
            run_all(bridge, &[passage], &settings, 4, &damping(), ForceSummation, sections).unwrap()
        };
        let there = go(&bridge, Direction::Right, &road, &sections);
        let back = go(&turned, Direction::Left, &turned_road, &turned_sections);
        let lifts = there.outcome.history.lift_offs();
        assert_eq!(lifts.len(), back.outcome.history.lift_offs().len(), "{name}, {drive:?}");
        let n = there.outcome.history.len();
        assert_eq!(n, back.outcome.history.len(), "{name}, {drive:?}");
        let loads = largest_difference(&there.outcome.history.loads, &back.outcome.history.loads)
            / largest_magnitude(&there.outcome.history.loads);
        let x: Vec<f64> = back.outcome.history.positions.iter().map(|x| length - x).collect();
        let positions = largest_difference(&there.outcome.history.positions, &x);
        let moved = largest_difference(&there.outcome.history.motion, &back.outcome.history.motion);
        println!(
            "{name}, {drive:?}: loads {loads:.1e}, positions {positions:.1e}, motion {moved:.1e}, {} flights",
            lifts.len()
        );
        // The passes that find a freely rolling vehicle's place stop at some 1e-8 m/s².
        let near =
            if matches!(drive, Drive::Acceleration(_) | Drive::ConstantSpeed) { ROUNDING } else { 1e3 * ROUNDING };
        assert!(loads <= near && positions <= near, "{name}, {drive:?}: {loads:e}, {positions:e}");
        for (quantity, other, sign) in [
            (Quantity::Deflection, Quantity::Deflection, 1.0),
            (Quantity::Moment, Quantity::Moment, 1.0),
            (Quantity::ShearLeft, Quantity::ShearRight, -1.0),
            (Quantity::Reaction, Quantity::Reaction, 1.0),
        ] {
            let [here, far] =
                [(&there, quantity), (&back, other)].map(|(run, quantity)| run.analysis.responses.range(quantity));
            let width = there.analysis.rows.len();
            let scale = largest_magnitude(&there.history_of(quantity));
            let mut worst = 0.0_f64;
            for i in 0..n {
                for k in 0..here.len() {
                    let a = there.responded[0][i * width + here.start + k];
                    let b = sign * back.responded[0][i * width + far.end - 1 - k];
                    worst = worst.max((a - b).abs() / scale);
                }
            }
            let (a, b) = (&there.outcome.envelope.dynamic, &back.outcome.envelope.dynamic);
            for k in 0..here.len() {
                let (max, min) = (a.max[here.start + k].value, a.min[here.start + k].value);
                let (k_max, k_min) = (b.max[far.end - 1 - k].value, b.min[far.end - 1 - k].value);
                let [k_max, k_min] = if sign > 0.0 { [k_max, k_min] } else { [-k_min, -k_max] };
                worst = worst.max((max - k_max).abs() / scale).max((min - k_min).abs() / scale);
            }
            assert!(worst <= near, "{name}, {drive:?}, {quantity:?}: {worst:e}");
        }
    }
}

/// Masses in a row are one train, whether they come together or one after the other.
#[test]
fn a_convoy_is_a_train() {
    let speed = 24.0;
    let settings = Settings { tail: Tail::Fixed(0.1), ..settings(speed, 1e-3) };
    let gap = 12.0;
    for kind in ["forces", "masses"] {
        let of = |values: &[f64], positions: &[f64]| match kind {
            "forces" => Vehicle::force_train(values, positions).unwrap(),
            _ => Vehicle::moving_masses(values, positions).unwrap(),
        };
        let step = (SPAN + 2.0 * gap + 3.0) / speed / 2000.0;
        let settings = Settings { step: Some(step), ..settings.clone() };
        let whole = of(&[9e3, 6e3, 9e3, 6e3, 9e3, 6e3], &[0.0, -3.0, -gap, -gap - 3.0, -2.0 * gap, -2.0 * gap - 3.0]);
        let train = crossed(&whole, &settings);
        let convoy: Vec<Passage> = (0..3)
            .map(|i| Passage { entry: f64::from(i) * gap / speed, ..Passage::of(of(&[9e3, 6e3], &[0.0, -3.0])) })
            .collect();
        let convoy =
            run_all(&simple(), &convoy, &settings, 3, &damping(), Superposition, &[0.4 * SPAN, 0.5 * SPAN]).unwrap();
        let difference = apart(&convoy, &train);
        let loads = largest_difference(&convoy.outcome.history.loads, &train.outcome.history.loads) / 9e4;
        println!("{kind}: {difference:.1e}, loads {loads:.1e}");
        assert!(difference <= ROUNDING && loads <= ROUNDING, "{kind}: {difference:e}, {loads:e}");
    }
}

/// On a bridge that has come to rest the next vehicle does what the first did.
#[test]
fn the_same_again_later() {
    let vehicle = half_car([700.0, 1100.0], 1.0, 1.0, elastic(2e3, 2e7));
    let step = (SPAN + 4.75) / 25.0 / 1190.0;
    let later = 6000.0 * step;
    // No axle on the section at a step: on which side of it rounding puts the axle makes a difference to the shear.
    let settings = settings(25.0, step);
    let passages = [0.0, later].map(|entry| Passage { entry, ..Passage::of(vehicle.clone()) });
    let damping = Damping::Ratios(vec![0.3]);
    let run = run_all(&simple(), &passages, &settings, 3, &damping, ForceSummation, &[9.26]).unwrap();
    let history = &run.outcome.history;
    let rows: Vec<_> = run.rows().collect();
    assert_eq!(rows.len(), 6000 + 1190 + 1);
    let (mut worst, mut loads) = (0.0_f64, 0.0_f64);
    for i in 0..=1190 {
        worst = worst.max(largest_difference(rows[i].dynamic, rows[i + 6000].dynamic));
        loads = loads.max(largest_difference(&rows[i].loads[..2], &rows[i + 6000].loads[2..]));
        let [first, second] = [motion(&run, 0, i), motion(&run, 1, i + 6000)];
        for (a, b) in first.iter().zip(&second) {
            assert!((a[0] - b[0]).abs() <= 1e-9 && (a[1] - b[1]).abs() <= 1e-8, "{a:?} {b:?}");
        }
    }
    let scale = largest_magnitude(&run.responded[0]);
    println!("{:.1e}, loads {:.1e}", worst / scale, loads / history.static_loads[0]);
    assert!(worst <= ROUNDING * scale && loads <= ROUNDING * history.static_loads[0]);
}
