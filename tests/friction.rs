//! Friction in the suspensions: its two limits, its bound, and the state it starts in.

use crate::problems::*;
use spanwise::passage::{Settings, Tail};
use spanwise::recovery::Recovery::ForceSummation;
use spanwise::statics::Quantity;
use spanwise::vehicle::{Axle, Friction, Vehicle};

/// Two descriptions of the same vehicle, relative to the largest value.
const ROUNDING: f64 = 1e-9;

/// The paper's vehicle with other axles.
fn vehicle(change: impl Fn(&mut Axle)) -> Vehicle {
    let paper = kishan_vehicle();
    let mut axles = paper.axles().to_vec();
    axles.iter_mut().for_each(change);
    Vehicle::new(paper.mass(), paper.pitch_inertia(), paper.cg_height(), axles).unwrap()
}

fn crossed(vehicle: &Vehicle) -> Run {
    let settings = Settings { tail: Tail::Fixed(0.2), ..kishan_settings() };
    run(&kishan_bridge(), vehicle, &settings, 3, &undamped(), ForceSummation, &[]).unwrap()
}

fn apart(a: &Run, b: &Run) -> f64 {
    let responses = largest_difference(&a.responded[0], &b.responded[0]) / largest_magnitude(&a.responded[0]);
    let (a, b) = (&a.outcome.history.loads, &b.outcome.history.loads);
    responses.max(largest_difference(a, b) / largest_magnitude(a))
}

#[test]
fn no_friction_is_both_springs_in_series() {
    let sliding = crossed(&vehicle(|axle| axle.friction.limit = 0.0));
    let series = crossed(&vehicle(|axle| {
        axle.tyre_stiffness = in_series(axle);
        axle.friction.limit = f64::INFINITY;
    }));
    let apart = apart(&sliding, &series);
    println!("{apart:.1e}");
    assert!(apart <= ROUNDING, "{apart:e}");
}

#[test]
fn infinite_friction_is_the_tyre_alone() {
    let locked = crossed(&vehicle(|axle| axle.friction.limit = f64::INFINITY));
    assert!(locked.outcome.history.shortenings.iter().all(|&s| s == 0.0));
    // Of a suspension that never moves the stiffness does not matter.
    let other = crossed(&vehicle(|axle| {
        axle.suspension_stiffness *= 3.0;
        axle.friction.limit = f64::INFINITY;
    }));
    // A rigid suspension does not move either.
    let rigid = crossed(&vehicle(|axle| {
        axle.suspension_stiffness = 1e14 * axle.tyre_stiffness;
        axle.friction.limit = 0.0;
    }));
    for (name, other) in [("stiffer", &other), ("rigid", &rigid)] {
        let apart = apart(&locked, other);
        println!("{name}: {apart:.1e}");
        assert!(apart <= ROUNDING, "{name}: {apart:e}");
    }
}

#[test]
fn friction_stays_within_its_limit() {
    for limit in [200.0, 1500.0, 4800.0].map(|pounds| pounds * POUND) {
        let run = crossed(&kishan_vehicle_with_friction(limit));
        let history = &run.outcome.history;
        assert!(history.friction.iter().all(|f| f.abs() <= limit), "limit {limit}");
        let at_limit = history.friction.iter().filter(|f| f.abs() == limit).count();
        println!("limit {limit:.0} N: sliding in {at_limit} of {} instants", history.friction.len());
        assert!(at_limit > 0 && at_limit < history.friction.len(), "limit {limit}: {at_limit}");
        // The suspension balances the tyre at every instant: p = k_s s + f − f₀.
        let axles = kishan_vehicle().axles().to_vec();
        for i in 0..history.friction.len() {
            let axle = &axles[i % axles.len()];
            let increment = history.loads[i] - history.static_loads[i % axles.len()];
            let carried = axle.suspension_stiffness * history.shortenings[i] + history.friction[i];
            assert!((increment - carried).abs() <= ROUNDING * history.static_loads[0], "at row {i}");
        }
    }
}

/// The static state leaves the friction open between ±F, and the response depends on it.
#[test]
fn initial_friction_matters() {
    let limit = 4800.0 * POUND;
    let factors = [-1.0, 0.0, 1.0].map(|share| {
        let run = crossed(&vehicle(|axle| axle.friction.initial = share * limit));
        assert!(run.outcome.history.friction.iter().all(|f| f.abs() <= limit));
        assert_eq!(run.outcome.history.friction[0], share * limit);
        run.impact(Quantity::Deflection)[run.section(run.bridge.stations()[1].at)]
    });
    println!("impact factors at mid-span {factors:.3?}");
    for i in 0..3 {
        assert!((factors[i] - factors[(i + 1) % 3]).abs() > 5e-3, "{factors:?}");
    }
}

/// On a vehicle without friction the state it starts in is the one it has.
#[test]
fn initial_friction_within_the_limit() {
    let friction = Friction { initial: 100.1, ..Friction::coulomb(100.0) };
    let axle = Axle { friction, ..kishan_vehicle().axles()[0] };
    let refused = Vehicle::new(1e4, 1e4, 1.0, vec![Axle { position: 0.0, ..axle }]).unwrap_err();
    assert!(refused.is_input() && refused.to_string().contains("initial_friction"), "{refused}");
}
