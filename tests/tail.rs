//! The free vibration after a crossing: what it can reach, and that it is kept until nothing more can come.

use crate::problems::continuous;
use crate::problems::ensemble::study_of;
use spanwise::stop_token::StopToken;
use std::sync::Arc;

use proptest::prelude::*;
use spanwise::bridge::{Bridge, Stations};
use spanwise::coordinate::Coordinate;
use spanwise::crossing::{Analysis, History, Observer, Preparation, Watch, cross};
use spanwise::damping::{Damping, ModalDamping};
use spanwise::ensemble::{Column, Factors, Parameter, Samples, Study};
use spanwise::error::Error;
use spanwise::lane::Isa;
use spanwise::modes::Modes;
use spanwise::passage::{Braking, Drive, Passage, Settings, Tail};
use spanwise::recovery::Recovery;
use spanwise::statics::{Flexibility, Quantity};
use spanwise::step::{LOOK_EVERY, ModalSolve, Newmark, PERIODS, Reach, Vibration};
use spanwise::vehicle::Vehicle;

use crate::problems::ensemble::{ALL, SEED, check_alone, mixed, mixed_samples, roads, some};
use crate::problems::vehicles::half_car;
use crate::problems::{
    PINNED, Run, all_arrangements, kishan_bridge, kishan_vehicle, mechanics, run, spread, two_spans, undamped,
    uneven_damping,
};

const RECOVERIES: [Recovery; 3] = [Recovery::ForceSummation, Recovery::ForceSummationByRates, Recovery::Superposition];

/// What a tail that ended by itself may have missed of an extreme.
const MISSED: f64 = 1e-3;

/// Sums in another order.
const ROUNDING: f64 = 1e-9;

/// A random damping matrix that takes energy out, rank by rank.
fn dissipating(modes: usize, salt: usize, size: f64) -> faer::Mat<f64> {
    let draw = |i: usize, j: usize| spread(salt + 31 * i + j) - 0.5;
    let root = faer::Mat::from_fn(modes, 2, draw);
    faer::Scale(size) * (&root * root.transpose())
}

proptest! {
    /// Whatever the state, the step, β and the damping: no coordinate ever goes beyond what was said, and without damping
    /// one mode comes close to it.
    #[test]
    fn no_state_exceeds_what_it_can_reach(
        modes in 1..5_usize, salt in 0..1000_usize, part in 0.05..0.95_f64, beta in 1.0/12.0..0.5_f64,
        ratio in prop_oneof![Just(0.0), 0.0..0.6_f64], full in any::<bool>(),
    ) {
        let omega: Vec<f64> = (0..modes).map(|m| 10.0 * (1.0 + m as f64 * (1.0 + spread(salt + m)))).collect();
        let limit = if beta < 0.25 { 1.0 / (0.25_f64 - beta).sqrt() } else { 6.0 };
        let h = part * limit / omega[modes - 1];
        let damping = match full {
            true => ModalDamping::Coupled(dissipating(modes, salt, 40.0 * ratio)),
            false => ModalDamping::Classical(vec![ratio; modes]),
        };
        let mut alone = Vibration::<f64>::new(Newmark::new(h, beta), ModalSolve::new(&omega, &damping, h, beta));
        // A force that acts now and is gone in the next step.
        let draw = |i: usize| 2.0 * spread(7 * salt + i) - 1.0;
        let mut state: Vec<Coordinate<f64>> = omega.iter().enumerate()
            .map(|(m, w)| Coordinate { x: draw(m), v: w * draw(m + 9), a: w * w * draw(m + 18) }).collect();
        let said = alone.reach(&state).coordinates().to_vec();
        let mut most = vec![0.0_f64; modes];
        for step in 0..4000 {
            alone.swing(&mut state);
            let later = alone.reach(&state);
            for (m, c) in state.iter().enumerate() {
                prop_assert!(c.x.abs() <= said[m] * (1.0 + ROUNDING), "step {step}: {} of {}", c.x, said[m]);
                prop_assert!(later.coordinates()[m] <= said[m] * (1.0 + ROUNDING), "step {step}: it grows");
                most[m] = most[m].max(c.x.abs());
            }
        }
        if ratio == 0.0 && modes == 1 && part < 0.3 {
            // The energy is that of the solution: what it can reach it does reach but for sampling, unless the force
            // that ends with the first step took some of it away.
            let free = alone.reach(&state).coordinates()[0];
            prop_assert!(most[0] >= 0.95 * free, "{} of {free}", most[0]);
        }
    }
}

fn vehicles() -> Vec<(&'static str, Vehicle)> {
    vec![
        ("forces", Vehicle::force_train(&[9e4, 1.2e5], &[0.0, -3.5]).unwrap()),
        ("friction", kishan_vehicle()),
        ("half-car", half_car([700.0, 1100.0], 1.0, 1.0, spanwise::vehicle::Friction::NONE)),
    ]
}

fn crossed(bridge: &Bridge, vehicle: &Vehicle, damping: &Damping, recovery: Recovery, speed: f64, tail: Tail) -> Run {
    let settings = Settings { tail, ..Settings::at_speed(speed) };
    let modes = bridge.stations().len().min(3);
    run(bridge, vehicle, &settings, modes, damping, recovery, &[]).unwrap()
}

/// What of an extreme was missed, relative to it; nothing where it is rounding.
fn missed(short: &Run, long: &Run) -> f64 {
    let [short, long] = [short, long].map(|run| &run.outcome.envelope.dynamic);
    let mut most = 0.0_f64;
    for (short, long) in [(&short.max, &long.max), (&short.min, &long.min)] {
        let largest = long.iter().fold(0.0_f64, |m, e| m.max(e.value.abs()));
        for (short, long) in short.iter().zip(long) {
            most = most.max((short.value - long.value).abs() / long.value.abs().max(1e-6 * largest));
        }
    }
    most
}

/// On every bridge, with and without a matrix, by every recovery, as far as beyond the critical speed: what the default
/// tail found is what forty periods find, and what was said of a record without a tail holds.
#[test]
fn nothing_comes_after_a_tail_that_ended_by_itself() {
    let vehicles = vehicles();
    let (mut settled, mut worst, mut cases, mut short_of) = (0, 0.0_f64, 0, 0);
    for (b, (name, bridge)) in all_arrangements().into_iter().enumerate() {
        for (v, ratio) in [0.005, 0.02, 0.05, f64::NAN].into_iter().enumerate() {
            let (vehicle_name, vehicle) = &vehicles[(b + v) % vehicles.len()];
            let recovery = RECOVERIES[(b + 2 * v) % RECOVERIES.len()];
            let speed = [8.0, 27.0, 60.0, 220.0][(b + v / 2) % 4];
            let damping =
                if ratio.is_nan() { Damping::Viscous(uneven_damping(&bridge)) } else { Damping::Ratios(vec![ratio]) };
            let of = |tail: Tail| crossed(&bridge, vehicle, &damping, recovery, speed, tail);
            let free = of(Tail::Free);
            let slowest = free.analysis.model.omega[0];
            let period = std::f64::consts::TAU / slowest;
            let [none, long] = [0.0, 4.0 * PERIODS * period].map(|tail| of(Tail::Fixed(tail)));
            let what = format!("{name}, {vehicle_name}, damped {ratio}, {recovery:?}, {speed} m/s");
            let history = &free.outcome.history;
            let tail = (history.time.last().unwrap() - history.ended) / period;
            assert!(tail <= PERIODS + LOOK_EVERY as f64 * history.step / period, "{what}: {tail} periods");
            cases += 1;
            if history.settled {
                settled += 1;
                worst = worst.max(missed(&free, &long));
                assert!(missed(&free, &long) <= 1.01 * MISSED, "{what}: missed {:e}", missed(&free, &long));
            } else {
                // Then there is as much as there may be.
                assert!(tail >= PERIODS, "{what}: {tail} periods");
            }
            for each in [&none, &free] {
                let bounds = bounds(each);
                let (own, later) = (&each.outcome.envelope.dynamic, &long.outcome.envelope.dynamic);
                for (r, bound) in bounds.iter().enumerate() {
                    let largest = own.max[r].value.abs().max(own.min[r].value.abs()).max(*bound);
                    let rounding = ROUNDING * largest + 1e-12 * later.max[r].value.abs();
                    assert!(later.max[r].value <= own.max[r].value.max(*bound) + rounding, "{what}, response {r}");
                    assert!(later.min[r].value >= own.min[r].value.min(-bound) - rounding, "{what}, response {r}");
                    short_of += usize::from(later.max[r].value > own.max[r].value);
                }
            }
        }
    }
    println!("{settled} of {cases} tails ended by themselves, missed {worst:e} at most; {short_of} maxima came late");
    assert!(settled >= cases / 2 && short_of > 100, "{settled} of {cases}, {short_of}");
}

/// What free vibration can reach after the end, response by response.
fn bounds(run: &Run) -> Vec<f64> {
    let of = |quantity| run.analysis.bounds_of(&run.outcome, quantity, StopToken::NEVER).unwrap().unwrap();
    Quantity::USUAL.into_iter().flat_map(of).collect()
}

/// Looks at all responses each time.
struct Thorough<'a>(&'a Analysis);

impl Watch for Thorough<'_> {
    fn enough(&mut self, history: &History, reach: &Reach<f64>, stop: StopToken<'_>) -> Result<bool, Error> {
        Observer::new(&self.0.rows, &self.0.look, &self.0.free, None).enough(history, reach, stop)
    }
}

/// To ask one response that can still grow, and all only when it cannot, ends a tail where asking all each time ends it.
#[test]
fn a_tail_ends_where_all_responses_say_so() {
    let (mut looks, mut settled) = (0, 0);
    for (b, (name, bridge)) in all_arrangements().into_iter().enumerate() {
        for (v, (vehicle_name, vehicle)) in vehicles().into_iter().enumerate() {
            let damping = [undamped(), Damping::Ratios(vec![0.01]), Damping::Ratios(vec![0.03])][(b + v) % 3].clone();
            let (recovery, speed) = (RECOVERIES[v], [12.0, 33.0, 80.0][b % 3]);
            let found = crossed(&bridge, &vehicle, &damping, recovery, speed, Tail::Free);
            let settings = Settings { tail: Tail::Free, ..Settings::at_speed(speed) };
            let (passages, mut watch) = ([Passage::of(vehicle)], Thorough(&found.analysis));
            let expected = cross(&found.analysis.model, &passages, &settings, &mut watch, StopToken::NEVER).unwrap();
            let history = &found.outcome.history;
            let what = format!("{name}, {vehicle_name}, {damping:?}, {recovery:?}, {speed} m/s");
            assert_eq!((history.len(), history.settled), (expected.len(), expected.settled), "{what}");
            looks += (history.len() - history.last_on) / LOOK_EVERY;
            settled += usize::from(history.settled);
        }
    }
    assert!(settled > 10 && looks > 100, "{settled} tails ended by themselves, {looks} looks in all");
}

/// The more a bridge is damped, the shorter is its tail; how long it is does not hang on the step.
#[test]
fn tails_follow_the_damping_and_not_the_step() {
    let length = |ratio: f64, step: f64| {
        let settings = Settings { tail: Tail::Free, step: Some(step), ..Settings::at_speed(22.86) };
        let damping = Damping::Ratios(vec![ratio]);
        let run = run(&kishan_bridge(), &kishan_vehicle(), &settings, 3, &damping, Recovery::ForceSummation, &[]);
        let history = run.unwrap().outcome.history;
        assert!(history.settled, "{ratio}");
        history.time.last().unwrap() - history.ended
    };
    let lengths: Vec<f64> = [0.005, 0.02, 0.1].map(|ratio| length(ratio, 1e-3)).to_vec();
    println!("{lengths:?} s");
    assert!(lengths.windows(2).all(|pair| pair[1] < pair[0]), "{lengths:?}");
    for step in [5e-4, 2.5e-4] {
        let other = length(0.02, step);
        assert!(
            (other - lengths[1]).abs() <= 2.0 * LOOK_EVERY as f64 * 1e-3 + 0.1 * lengths[1],
            "{other} s, {} s",
            lengths[1]
        );
    }
}

/// Alone and undamped, a mode has shown all within a period.
#[test]
fn one_undamped_mode_takes_a_period() {
    for speed in [5.0, 22.86, 80.0] {
        let settings = Settings { tail: Tail::Free, ..Settings::at_speed(speed) };
        let run = run(&two_spans(3), &kishan_vehicle(), &settings, 1, &undamped(), Recovery::ForceSummation, &[9.144]);
        let run = run.unwrap();
        let history = &run.outcome.history;
        let period = std::f64::consts::TAU / run.analysis.model.omega[0];
        let tail = history.time.last().unwrap() - history.ended;
        assert!(history.settled && tail <= 1.1 * period + LOOK_EVERY as f64 * history.step, "{tail} s of {period} s");
    }
}

/// Above the critical speed the bridge swings on farthest when the force has gone; and a single span goes up only then,
/// by a thousand times what it does under a slow vehicle.
#[test]
fn the_largest_of_all_may_come_late() {
    let span = continuous(&[25.0], [PINNED; 2], &[8.3e9], &[2303.0], &Stations::PerSpan(vec![9]), &[]).unwrap();
    let force = Vehicle::force_train(&[1e5], &[0.0]).unwrap();
    let of = |tail: Tail, speed: f64| {
        let settings = Settings { tail, ..Settings::at_speed(speed) };
        let damping = Damping::Ratios(vec![0.02]);
        run(&span, &force, &settings, 3, &damping, Recovery::ForceSummation, &[12.5]).unwrap()
    };
    let deflection = |run: &Run| {
        let envelope = run.analysis.envelope_of(&run.outcome, Quantity::Deflection, StopToken::NEVER).unwrap().dynamic;
        (envelope.max[0], envelope.min[0])
    };
    // L/v below half a period.
    let fast = of(Tail::Free, 420.0);
    let (down, _) = deflection(&fast);
    assert!(down.time > fast.outcome.history.ended, "{down:?}");
    let (before, _) = deflection(&of(Tail::Fixed(0.0), 420.0));
    assert!(down.value > 1.2 * before.value, "{down:?}, {before:?}");
    // Upward.
    let (_, up) = deflection(&of(Tail::Free, 30.0));
    let none = of(Tail::Fixed(0.0), 30.0);
    let (_, up_before) = deflection(&none);
    println!("up {:e} m, without a tail {:e} m", up.value, up_before.value);
    assert!(up.value < 100.0 * up_before.value.min(-1e-12), "{up:?}, {up_before:?}");
    let bounds = bounds(&none);
    assert!(bounds[0] >= -up.value && bounds[0] <= -1.2 * up.value, "{} of {}", bounds[0], up.value);
}

/// A vehicle that stands on the bridge rocks with it: the tail is as long as may be, and nothing is said of what follows.
#[test]
fn a_standing_vehicle_has_the_longest_tail() {
    let braking = Braking { deceleration: 5.0, from: 0.0, ramp: 0.3, adhesion: 0.7 };
    for (drive, stands) in [
        (Drive::Braking(braking), true),
        (Drive::Speeds { times: vec![0.0, 1.5], speeds: vec![15.0, 0.0] }, true),
        // Before the bridge there is nothing to be heard of it.
        (Drive::Speeds { times: vec![0.0, 1.0], speeds: vec![15.0, 0.0] }, false),
    ] {
        let approach = if stands { 0.0 } else { 20.0 };
        let settings =
            Settings { tail: Tail::Free, approach, drive: drive.clone(), step: Some(2e-3), ..Settings::at_speed(15.0) };
        let damping = Damping::Ratios(vec![0.05]);
        let run = run(&kishan_bridge(), &kishan_vehicle(), &settings, 3, &damping, Recovery::ForceSummation, &[9.144]);
        let run = run.unwrap();
        let history = &run.outcome.history;
        let tail = history.time.last().unwrap() - history.ended;
        let longest = PERIODS * std::f64::consts::TAU / run.analysis.model.omega[0];
        if stands {
            assert!(!history.settled && run.outcome.history.reach.is_none(), "{drive:?}");
            assert!((tail - longest).abs() <= (LOOK_EVERY + 1) as f64 * history.step, "{tail} s of {longest} s");
            assert_eq!(history.last_on, history.len() - 1);
        } else {
            assert!(history.settled && tail <= 2.0 * history.step, "{tail} s");
        }
    }
}

/// Axle loads and wheels off the road are those of the crossing, however long the tail.
#[test]
fn the_tail_is_none_of_the_vehicles_business() {
    let road = Arc::new(roads(1024e-6).road(SEED, 3).into());
    let of = |tail: Tail| {
        let vehicle = half_car([700.0, 1100.0], 0.3, 0.0, spanwise::vehicle::Friction::NONE);
        let settings = Settings { tail, approach: 20.0, road: Arc::clone(&road), ..Settings::at_speed(30.0) };
        let damping = Damping::Ratios(vec![0.02]);
        let passages = [Passage::of(vehicle)];
        let run =
            mechanics::run_all(&kishan_bridge(), &passages, &settings, 3, &damping, Recovery::ForceSummation, &[9.144]);
        run.unwrap()
    };
    let [none, some, free] = [Tail::Fixed(0.0), Tail::Fixed(1.3), Tail::Free].map(of);
    for other in [&some, &free] {
        assert_eq!(other.outcome.axle_loads, none.outcome.axle_loads);
        assert_eq!(other.outcome.history.lift_offs(), none.outcome.history.lift_offs());
        // The road goes on under them.
        let history = &other.outcome.history;
        let behind = &history.elevations[(none.outcome.history.len() + 9) * history.axles..];
        assert!(behind.windows(2).any(|pair| pair[0] != pair[1]), "level");
    }
    assert!(!none.outcome.history.lift_offs().is_empty());
}

fn study(recovery: Recovery, drive: Drive, quantities: &[Quantity]) -> Study {
    let bridge = two_spans(4);
    let modes = Modes::new(&bridge, &Flexibility::new(&bridge, &[]).unwrap(), 4).unwrap();
    let damping = Damping::Ratios(vec![0.03]);
    let analysis =
        Preparation::default().damping(damping).recovery(recovery).of(&bridge, modes, StopToken::NEVER).unwrap();
    let settings = Settings { approach: 7.0, tail: Tail::Free, drive, ..Settings::at_speed(1.0) };
    let kinds = vec![vec![Passage::of(kishan_vehicle())], vec![Passage::of(vehicles().remove(2).1)]];
    study_of(Arc::new(analysis), kinds, settings, Some((roads(256e-6), SEED)), None, quantities).unwrap()
}

fn samples(count: usize) -> Samples {
    let factor = |parameter, salt: usize| Factors {
        parameter,
        width: 1,
        values: (0..count).map(|i| 0.7 + 0.6 * spread(13 * i + salt)).collect(),
    };
    Samples {
        count,
        kinds: (0..count).map(|i| (i % 2) as u32).collect(),
        speeds: (0..count).map(|i| 10.0 + 60.0 * spread(i)).collect(),
        factors: vec![factor(Parameter::BridgeDamping, 1), factor(Parameter::BodyMass, 2)],
        ..Samples::at_speed(0, count, 1.0)
    }
}

/// Each sample has the tail that it needs, side by side as alone, on every processor and whatever its neighbours.
#[test]
fn each_sample_has_its_own_tail() {
    for recovery in RECOVERIES {
        let (study, samples) = (study(recovery, Drive::ConstantSpeed, &ALL), samples(21));
        let reference = crate::problems::ensemble::run(&study, &samples, Isa::Baseline, 1);
        check_alone(&study, &samples, &reference, &format!("{recovery:?}"));
        for isa in Isa::present() {
            for (threads, chunk) in [(1, 32), (2, 5), (2, 1)] {
                let found = crate::problems::ensemble::run_in_chunks(&study, &samples, isa, threads, chunk);
                assert_eq!(found.results.digests, reference.results.digests, "{recovery:?}, {isa:?}, {chunk}");
            }
        }
        let of = |i: usize| crate::problems::ensemble::column(&reference.results, i, Column::Tail)[0];
        let lengths: Vec<f64> = (0..samples.count).map(of).collect();
        let mut distinct = lengths.clone();
        distinct.sort_by(f64::total_cmp);
        distinct.dedup();
        assert!(distinct.len() > samples.count / 2, "{lengths:?}");
        for i in [0, 7, 20] {
            let own = crate::problems::ensemble::run(&study, &some(&samples, i..i + 1), Isa::Baseline, 1).results;
            assert_eq!(own.digests[0], reference.results.digests[i], "{recovery:?}, sample {i}");
        }
    }
}

/// On bridges that differ, with halved steps and two kinds of vehicle.
#[test]
fn tails_of_mixed_samples() {
    let Study { analysis, kinds, settings, own, .. } = mixed();
    let kinds = kinds.into_iter().map(|kind| kind.passages).collect();
    let settings = Settings { tail: Tail::Free, ..settings };
    let study = study_of(analysis, kinds, settings, own, Some(0.1), &ALL).unwrap();
    let samples = mixed_samples(0, 19);
    let found = crate::problems::ensemble::run(&study, &samples, Isa::chosen().unwrap(), 2);
    check_alone(&study, &samples, &found, "mixed");
}

/// Where each sample is a crossing of its own, the same rule.
#[test]
fn tails_of_samples_one_by_one() {
    for quantities in [&ALL[..], &[Quantity::Moment][..]] {
        let together = study(Recovery::ForceSummation, Drive::ConstantSpeed, quantities);
        let samples = Samples { kinds: vec![0; 6], speeds: vec![20.0; 6], count: 6, ..Samples::at_speed(0, 6, 20.0) };
        let there = crate::problems::ensemble::run(&together, &samples, Isa::chosen().unwrap(), 1).results;
        // The same motion, said otherwise.
        let drive = Drive::Speeds { times: vec![0.0], speeds: vec![20.0] };
        let apart = study(Recovery::ForceSummation, drive, quantities);
        let alone = crate::problems::ensemble::run(&apart, &samples, Isa::chosen().unwrap(), 1).results;
        let mut kept = 0;
        for i in 0..6 {
            let [a, b] = [&there, &alone].map(|results| crate::problems::ensemble::column(results, i, Column::Tail)[0]);
            assert!((a - b).abs() <= 1e-9, "{quantities:?}, sample {i}: {a} s, {b} s");
            kept += usize::from(a > 0.0);
        }
        assert!(kept > 1, "{quantities:?}: {kept}");
    }
}
