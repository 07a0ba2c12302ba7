//! Wheels leave the road: forces never negative, energy accounted for, and what is reported about it.

use crate::problems::continuous;
use std::sync::Arc;

use crate::problems::mechanics::{Budget, faded};
use crate::problems::vehicles::{articulated, elastic, half_car, hs20, leaf};
use crate::problems::*;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use spanwise::bridge::{Bridge, Stations};
use spanwise::crossing::LiftOff;
use spanwise::damping::Damping;
use spanwise::error::Error;
use spanwise::passage::{Drive, Settings, Tail};
use spanwise::recovery::Recovery::ForceSummation;
use spanwise::road::{Class, Patch, Road, Spectrum, Synthesis};
use spanwise::vehicle::{Friction, Vehicle};

/// Balances of forces at an instant, to rounding of what the steps leave, relative to the weight.
const BALANCE: f64 = 1e-9;

/// What the energy balance may miss in steps of a tenth of a millisecond, relative to all that is taken out.
const MISSING: f64 = 1e-3;

/// Two spans, the second longer.
fn bridge() -> Bridge {
    let stations = Stations::PerSpan(vec![5, 7]);
    continuous(&[14.0, 20.0], [PINNED; 2], &[2.4e9], &[7e3], &stations, &[]).unwrap()
}

fn road(class: Class, band: [f64; 2], seed: u64) -> Road {
    let spectrum = Spectrum::new(class.mean(), 2.0, band).unwrap();
    Synthesis::new(spectrum, Patch::new(0.24).unwrap(), None).unwrap().road(seed, 0).into()
}

/// Waves down to a quarter of a metre.
const BAND: [f64; 2] = [0.01, 4.0];

fn settings(speed: f64, road: &Road, step: Option<f64>) -> Settings {
    Settings {
        approach: 20.0,
        ramp: 5.0,
        tail: Tail::Fixed(0.1),
        step,
        road: Arc::new(road.clone()),
        ..Settings::at_speed(speed)
    }
}

const RATIO: f64 = 0.01;

fn crossed(vehicle: &Vehicle, settings: &Settings) -> Result<Run, Error> {
    run(&bridge(), vehicle, settings, 4, &Damping::Ratios(vec![RATIO]), ForceSummation, &[7.0])
}

prop_compose! {
    fn any_vehicle()(
        masses in prop_oneof![Just([0.0; 2]), Just([700.0, 1100.0]), Just([700.0, 0.0]), Just([30.0, 2000.0])],
        suspension in 0.0..1.5_f64, tyre in prop_oneof![Just(0.0), 0.0..3.0_f64],
        limit in prop_oneof![Just(0.0), 500.0..30e3_f64],
        build_up in 0..3,
    ) -> Vehicle {
        let friction = match build_up {
            _ if limit == 0.0 => Friction::NONE,
            1 if masses[1] > 0.0 && masses[0] > 0.0 => elastic(limit, 2e7),
            // The force builds up within a stroke in which the spring adds no more than the limit.
            2 => leaf(limit, (limit / 1e6).min(2e-3)),
            _ => Friction::coulomb(limit),
        };
        half_car(masses, suspension, tyre, friction)
    }
}

fn cases() -> ProptestConfig {
    let rng_seed = RngSeed::Fixed(1973);
    ProptestConfig { cases: 60, failure_persistence: None, rng_seed, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn wheels_push_only(
        vehicle in any_vehicle(), speed in 8.0..45.0_f64, class in 1..6_usize, seed in 0..1000_u64,
        drive in prop_oneof![Just(Drive::ConstantSpeed), Just(Drive::ConstantTraction), Just(Drive::Acceleration(-2.0))],
    ) {
        let settings = Settings { drive, ..settings(speed.max(15.0), &road(Class::ALL[class], BAND, seed), None) };
        let run = crossed(&vehicle, &settings).unwrap();
        let history = &run.outcome.history;
        let weight: f64 = history.static_loads.iter().sum();
        for row in run.rows() {
            prop_assert!(row.loads.iter().all(|&load| load >= 0.0), "{:?} at {} s", row.loads, row.time);
        }
        let axles = vehicle.axles();
        for (i, friction) in history.friction.iter().enumerate() {
            let Friction { limit, .. } = axles[i % 2].friction;
            // A leaf spring's friction lags behind its envelope.
            prop_assert!(friction.abs() <= limit * (1.0 + 1e-12), "friction {friction} of {limit}");
        }
        // The bounce of the whole vehicle: its acceleration is what the wheels press with beyond its weight.
        if vehicle.assembly().mass.nrows() == 2 {
            for (i, row) in run.rows().enumerate() {
                let excess = row.loads.iter().sum::<f64>() - weight;
                let acceleration = history.motion[i * history.motion_width() + 2];
                // The end of the tail cuts a step.
                prop_assert!(i + 1 == history.len() || (vehicle.mass() * acceleration + excess).abs() <= BALANCE * weight);
            }
        }
    }
}

/// Without lift-off the wheels pull where they would have left the road.
#[test]
fn wheels_that_may_not_leave_pull() {
    let road = road(Class::E, BAND, 3);
    let vehicle = half_car([700.0, 1100.0], 1.0, 0.0, Friction::NONE);
    let bound = crossed(&vehicle, &Settings { lift_off: false, ..settings(30.0, &road, None) }).unwrap();
    let least = bound.outcome.history.loads.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(least < 0.0 && bound.outcome.history.lift_offs().is_empty(), "{least}");
    let free = crossed(&vehicle, &settings(30.0, &road, None)).unwrap();
    assert!(!free.outcome.history.lift_offs().is_empty());
}

/// E(t) − E(0) = −∫ v ΣH dt − what dampers and friction take.
///
/// The loads are continuous but for the instants at which an axle meets a support: there the slope under it jumps,
/// and with it H and the force of a tyre's damper, so that in general the order is one.
#[test]
fn energy_is_accounted_for() {
    // Long waves, so that the steps resolve the road; it begins level where the vehicle begins at rest.
    let (smooth, rough) = (Road::smooth(), faded(&road(Class::F, [0.02, 0.5], 5), [-20.0, -8.0], [-40.0, 90.0]));
    let friction = elastic(6e3, 5e6);
    for (name, vehicle, road, speed, flies) in [
        ("smooth, undamped", half_car([700.0, 1100.0], 0.0, 0.0, Friction::NONE), &smooth, 25.0, false),
        ("smooth, damped", half_car([700.0, 1100.0], 1.0, 1.0, Friction::NONE), &smooth, 25.0, false),
        ("smooth, friction", half_car([700.0, 1100.0], 0.0, 1.0, elastic(1e3, 5e6)), &smooth, 25.0, false),
        ("rough, undamped", half_car([700.0, 1100.0], 0.0, 0.0, Friction::NONE), &rough, 40.0, true),
        ("rough, damped", half_car([700.0, 1100.0], 1.0, 0.5, Friction::NONE), &rough, 40.0, true),
        ("rough, friction", half_car([700.0, 1100.0], 0.3, 0.5, friction), &rough, 40.0, true),
        ("rough, articulated", articulated(0.5, 0.5), &rough, 40.0, true),
    ] {
        // All supports, axles and the start are quarters of a metre apart.
        let steps = [12.0, 24.0, 48.0, 96.0].map(|parts| 0.25 / parts / speed);
        let errors: Vec<f64> = steps
            .iter()
            .map(|&step| {
                let settings = Settings { ramp: 0.0, tail: Tail::Fixed(0.0), ..settings(speed, road, Some(step)) };
                let run = crossed(&vehicle, &settings).unwrap();
                assert_eq!(!run.outcome.history.lift_offs().is_empty(), flies, "{name}");
                let budget = Budget::of(&run, &vehicle, road, RATIO, false);
                let moved: Vec<f64> = budget.stored.iter().map(|e| e - budget.stored[0]).collect();
                largest_magnitude(&budget.error()) / largest_magnitude(&moved)
            })
            .collect();
        let order = observed_order(&steps, &errors);
        println!("{name}: missing {:.1e} to {:.1e}, order {order:.2}", errors[0], errors[3]);
        assert!(errors[3] <= MISSING && order > 0.9, "{name}: {errors:?}, order {order}");
    }
}

/// A truck like the HS20-44 on a poor road at 90 km/h.
#[test]
fn lift_offs_are_told() {
    let vehicle = hs20(1.0);
    let run = crossed(&vehicle, &settings(25.0, &road(Class::D, BAND, 1), Some(2e-4))).unwrap();
    let history = &run.outcome.history;
    let told = history.lift_offs();
    assert!(!told.is_empty());
    let (mut count, mut total, mut instants) = (0, 0.0, 0);
    for axle in 0..history.axles {
        let off: Vec<bool> = run.rows().take(history.last_on + 1).map(|row| row.loads[axle] == 0.0).collect();
        instants += off.iter().filter(|&&off| off).count();
        for (i, pair) in off.windows(2).enumerate() {
            count += usize::from(pair[1] && !pair[0]);
            total += if pair[0] { history.time[i + 1] - history.time[i] } else { 0.0 };
        }
    }
    assert_eq!(told.len(), count);
    let sum: f64 = told.iter().map(|l| l.to - l.from).sum();
    assert!((sum - total).abs() <= BALANCE, "{sum} s and {total} s");
    // Each instant in the air lasts for a step, but for the last one of a crossing.
    assert!((sum - instants as f64 * history.step).abs() <= 3.1 * history.step, "{sum} s of {instants} instants");
    for LiftOff { axle, from, to } in &told {
        assert!(from < to && *axle < 3);
        let flying: Vec<f64> =
            run.rows().filter(|row| row.time >= *from && row.time < *to).map(|row| row.loads[*axle]).collect();
        assert!(!flying.is_empty() && flying.iter().all(|&load| load == 0.0), "axle {axle}, {from} to {to} s");
    }
    println!("{count} times, {total:.3} s together");
}
