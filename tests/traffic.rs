//! Several vehicles at once: who is where, when each has left, and who is refused.

use crate::problems::continuous;
use crate::problems::mechanics::{profile, run_all};
use crate::problems::vehicles::{elastic, half_car};
use crate::problems::*;
use spanwise::bridge::{Bridge, Stations};
use spanwise::damping::Damping;
use spanwise::error::Error;
use spanwise::passage::{Braking, Direction, Drive, Passage, Settings};
use spanwise::recovery::Recovery::ForceSummation;
use spanwise::road::Road;
use spanwise::vehicle::{Friction, Vehicle};

/// Two computations of the same thing, relative to its largest value.
const ROUNDING: f64 = 1e-9;

const SPAN: f64 = 30.0;

fn bridge() -> Bridge {
    let stations = Stations::PerSpan(vec![9]);
    continuous(&[SPAN], [PINNED; 2], &[9e9], &[8e3], &stations, &[]).unwrap()
}

fn truck() -> Vehicle {
    half_car([700.0, 1100.0], 1.0, 1.0, elastic(2e3, 2e7))
}

fn settings() -> Settings {
    Settings { approach: 15.0, step: Some(1e-3), ..Settings::at_speed(20.0) }
}

fn crossed(passages: &[Passage], settings: &Settings) -> Result<Run, Error> {
    run_all(&bridge(), passages, settings, 3, &Damping::Ratios(vec![0.02]), ForceSummation, &[0.5 * SPAN])
}

#[test]
fn everyone_has_a_place_in_the_history() {
    let train = Vehicle::force_train(&[5e4, 6e4, 7e4], &[0.0, -2.0, -5.0]).unwrap();
    let passages = [
        Passage::of(truck()),
        Passage { direction: Direction::Left, lane: 1, entry: 0.4, speed: Some(25.0), ..Passage::of(train) },
        Passage { entry: 1.5, drive: Some(Drive::ConstantTraction), ..Passage::of(kishan_vehicle()) },
    ];
    let run = crossed(&passages, &settings()).unwrap();
    let history = &run.outcome.history;
    assert_eq!(history.axles, 7);
    let columns: Vec<_> =
        history.vehicles.iter().map(|v| (v.axles.clone(), v.motion.clone(), v.frictions.clone())).collect();
    // Four coordinates, none, and two, each with the travel; friction elements only beside masses.
    assert_eq!(columns, [(0..2, 0..15, 0..2), (2..5, 15..18, 2..2), (5..7, 18..27, 2..2)]);
    let directions: Vec<f64> = (0..7).map(|axle| history.direction(axle)).collect();
    assert_eq!(directions, [1.0, 1.0, -1.0, -1.0, -1.0, 1.0, 1.0]);
    let alone: Vec<f64> = passages.iter().flat_map(|p| p.vehicle.static_loads(9.806_65)).collect();
    assert_eq!(history.static_loads, alone);
    for row in run.rows() {
        let x = row.positions;
        assert!((x[0] - (20.0 * row.time - 15.0)).abs() < ROUNDING && (x[0] - x[1] - 4.75).abs() < ROUNDING);
        assert!((x[2] - (SPAN + 15.0 - 25.0 * (row.time - 0.4))).abs() < ROUNDING);
        assert!((x[4] - x[2] - 5.0).abs() < ROUNDING, "the last axle to the left follows on the right");
        assert_eq!(row.loads[2..5], [5e4, 6e4, 7e4]);
        // The third rolls freely: at the speed at which it entered, but for a little.
        assert!((x[5] - (20.0 * (row.time - 1.5) - 15.0)).abs() < 0.01);
    }
    // It ends as the last of all leaves.
    let last = run.rows().last().unwrap();
    assert!((last.positions[6] - SPAN).abs() < 1e-6, "{:?}", last.positions);
    assert!((last.time - (1.5 + (15.0 + SPAN + kishan_vehicle().wheelbase()) / 20.0)).abs() < 1e-3);
    assert!((history.final_speed(1) - 25.0).abs() < ROUNDING && (history.final_speed(2) - 20.0).abs() < 0.1);
    // Travel is counted in the own direction.
    let travel = |row: usize, vehicle: usize| {
        let end = history.vehicles[vehicle].motion.end;
        history.motion[row * history.motion_width() + end - 3]
    };
    assert!((travel(1000, 1) - travel(0, 1) - 25.0 * history.time[1000]).abs() < ROUNDING);
}

/// Far from each other in time, each crosses as if alone, whatever else is prescribed or rolls.
#[test]
fn on_a_bridge_of_its_own_each_is_alone() {
    let step = 1e-3;
    let heavy = Damping::Ratios(vec![0.3]);
    let with = |passages: &[Passage]| {
        let settings = Settings { step: Some(step), ..settings() };
        run_all(&bridge(), passages, &settings, 3, &heavy, ForceSummation, &[0.5 * SPAN]).unwrap()
    };
    let brakes = Braking { deceleration: 2.0, from: 5.0, ramp: 0.3, adhesion: 0.8 };
    let first = Passage { drive: Some(Drive::Braking(brakes)), ..Passage::of(truck()) };
    let second = Passage { direction: Direction::Left, entry: 9.0, ..Passage::of(truck()) };
    let both = with(&[first.clone(), second.clone()]);
    let [one, other] = [first, Passage { entry: 0.0, ..second }].map(|passage| with(&[passage]));
    let ends = |run: &Run| run.outcome.history.time[run.outcome.history.len() - 1];
    // Largest load until it has left, and when: that does not ask for the same steps.
    let loads = |run: &Run, axle: usize, from: f64, until: f64| {
        let history = &run.outcome.history;
        (0..history.len())
            .filter(|&i| history.time[i] <= until)
            .map(|i| (history.loads[i * history.axles + axle], history.time[i] - from))
            .fold((0.0, 0.0), |m: (f64, f64), l| if l.0 > m.0 { l } else { m })
    };
    for (axle, run, own, from) in [(0, &one, 0, 0.0), (1, &one, 1, 0.0), (2, &other, 0, 9.0), (3, &other, 1, 9.0)] {
        let (a, b) = (loads(&both, axle, from, from + ends(run)), loads(run, own, 0.0, ends(run)));
        assert!((a.0 / b.0 - 1.0).abs() < 1e-4 && (a.1 - b.1).abs() < 0.02, "axle {axle}: {a:?}, alone {b:?}");
    }
}

#[test]
fn vehicles_may_not_overlap() {
    let refused = |passages: &[Passage]| match crossed(passages, &settings()) {
        Err(error) => {
            assert!(error.is_input(), "{error}");
            error.to_string()
        }
        Ok(_) => String::new(),
    };
    let slow = Passage { speed: Some(10.0), ..Passage::of(truck()) };
    // 4.75 m behind the front of the slow one is where the fast one meets it: 20 (t − 1) = 10 t − 4.75.
    let fast = Passage { entry: 1.0, ..Passage::of(truck()) };
    let told = refused(&[slow.clone(), fast.clone()]);
    println!("{told}");
    assert!(told.contains("vehicles[0] and vehicles[1], lane = 0") && told.contains("t = 1.525 s"), "{told}");
    // The same the other way round, and to the left.
    let left = |passage: &Passage| Passage { direction: Direction::Left, ..passage.clone() };
    assert!(refused(&[left(&fast), left(&slow)]).contains("t = 1.525 s"));
    // Another lane, or enough of a gap.
    assert_eq!(refused(&[slow.clone(), Passage { lane: 2, ..fast.clone() }]), "");
    assert_eq!(refused(&[slow.clone(), Passage { entry: 4.0, ..fast.clone() }]), "");
    // Head-on, and at the same time.
    assert!(refused(&[slow.clone(), left(&fast)]).contains("overlap"));
    assert!(refused(&[slow.clone(), slow.clone()]).contains("t = 0.000 s"));
    // Behind one that stands on the bridge.
    let stands = Passage { drive: Some(Drive::Acceleration(-20.0 / 3.0)), ..Passage::of(truck()) };
    assert!(refused(&[stands, Passage { entry: 3.0, ..fast.clone() }]).contains("overlap"));
}

/// Only on their way can vehicles overlap: not where they would have been before their entry, nor once one has left.
#[test]
fn vehicles_overlap_only_on_their_way() {
    let fast = Passage { entry: 5.0, speed: Some(40.0), ..Passage::of(truck()) };
    let slow = Passage { entry: 6.0, speed: Some(10.0), ..Passage::of(truck()) };
    crossed(&[fast.clone(), slow.clone()], &settings()).unwrap();
    // The slow one has left 4.975 s after its entry, and the fast one catches up with it behind the bridge.
    let ahead = Passage { entry: 0.0, ..slow };
    let behind = Passage { entry: 3.9, speed: Some(20.0), ..fast };
    let third = Passage { entry: 8.0, ..Passage::of(truck()) };
    crossed(&[ahead, behind, third], &settings()).unwrap();
}

/// The road counts where a late vehicle is before its entry, if there is no ramp.
#[test]
fn roads_under_late_vehicles() {
    let road: std::sync::Arc<Road> = std::sync::Arc::new(profile([-25.0, 50.0], |x| 0.002 * (0.8 * x).sin()));
    let late = Passage { entry: 2.0, ..Passage::of(truck()) };
    let refused =
        crossed(std::slice::from_ref(&late), &Settings { road: road.clone(), ..settings() }).map(|_| ()).unwrap_err();
    assert!(refused.to_string().contains("-59.75 m"), "{refused}");
    crossed(std::slice::from_ref(&late), &Settings { road: road.clone(), ramp: 5.0, ..settings() }).unwrap();
    crossed(&[Passage { entry: 0.0, ..late }], &Settings { road, ..settings() }).unwrap();
}

/// What leaves the road is told by axles counted through all vehicles.
#[test]
fn lift_offs_of_the_second_vehicle() {
    let rough = profile([-60.0, 60.0], |x| 0.03 * (2.0 * x).sin());
    let plain = half_car([700.0, 1100.0], 1.0, 0.0, Friction::NONE);
    let second =
        Passage { lane: 1, road: Some(std::sync::Arc::new(rough)), speed: Some(25.0), ..Passage::of(plain.clone()) };
    let run = crossed(&[Passage::of(plain), second], &settings()).unwrap();
    let lifts = run.outcome.history.lift_offs();
    assert!(!lifts.is_empty() && lifts.iter().all(|lift| lift.axle >= 2), "{lifts:?}");
}
