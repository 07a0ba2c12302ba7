//! Random studies: nothing panics, no number is lost unmarked, and no way of doing the work changes a bit.

use crate::problems::continuous;
use crate::problems::ensemble::study_of;
use std::sync::Arc;

use crate::problems::ensemble::*;
use crate::problems::vehicles::{elastic, leaf};
use crate::problems::{CLAMPED, PINNED, spread};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestCaseError, TestRunner};
use spanwise::bridge::{Bridge, Stations};
use spanwise::damping::Damping;
use spanwise::ensemble::{Column, Factors, Parameter, Samples, decoded};
use spanwise::extremes::Instant;
use spanwise::lane::Isa;
use spanwise::passage::{Direction, Drive, Passage, Settings, Tail};
use spanwise::recovery::Recovery;
use spanwise::road::{Patch, Road, Spectrum, Synthesis};
use spanwise::statics::Quantity;
use spanwise::vehicle::{Axle, Friction, Vehicle};

prop_compose! {
    fn any_bridge()(
        spans in prop::collection::vec(6.0..22.0_f64, 1..5),
        ends in (0..3_usize, 0..3_usize),
        rigidity in prop::collection::vec(5e8..8e9_f64, 4),
        stations in 2..5_usize,
        mass in 3e3..1.2e4_f64,
    ) -> Bridge {
        let end = |choice: usize| [PINNED, CLAMPED, None][choice];
        let mut ends = [end(ends.0), end(ends.1)];
        // A free end needs a clamp beyond, or two supports.
        if spans.len() == 1 && ends.contains(&None) {
            ends = [CLAMPED, None];
        } else if spans.len() == 2 && ends == [None, None] {
            ends = [PINNED, None];
        }
        let rigidity = &rigidity[..spans.len()];
        continuous(&spans, ends, rigidity, &[mass], &Stations::PerSpan(vec![stations]), &[]).unwrap()
    }
}

prop_compose! {
    fn any_axle()(
        unsprung in prop_oneof![Just(0.0), 200.0..1500.0_f64],
        tyre in 8e5..4e6_f64, spring in 3e5..1.2e6_f64,
        tyre_damping in prop_oneof![Just(0.0), 0.0..2e4_f64],
        damping in prop_oneof![Just(0.0), 0.0..3e4_f64],
        limit in 1e3..2e4_f64,
        build_up in 0..4,
    ) -> Axle {
        let friction = match build_up {
            0 => Friction::coulomb(limit),
            1 if unsprung > 0.0 => elastic(limit, 2e7),
            // Well within the limit over the stiffness, which factors change.
            2 => leaf(limit, 0.2 * limit / spring),
            _ => Friction::NONE,
        };
        let axle = Axle::new(0.0, tyre, spring);
        Axle { mass: unsprung, tyre_damping, suspension_damping: damping, friction, ..axle }
    }
}

prop_compose! {
    fn any_vehicle()(
        axles in prop::collection::vec((any_axle(), 1.1..4.0_f64), 1..6),
        kind in 0..6,
        mass in 5e3..4e4_f64,
    ) -> Vehicle {
        let mut behind = 0.0;
        let positions: Vec<f64> = axles.iter().map(|(_, gap)| { behind -= gap; behind }).collect();
        let middle = positions.iter().sum::<f64>() / positions.len() as f64;
        let loads: Vec<f64> = axles.iter().map(|(axle, _)| axle.tyre_stiffness / 20.0).collect();
        match kind {
            0 => Vehicle::force_train(&loads, &positions).unwrap(),
            1 => Vehicle::moving_masses(&loads.iter().map(|load| load / 100.0).collect::<Vec<_>>(), &positions).unwrap(),
            _ => {
                let place = |(&(axle, _), x): (&(Axle, f64), &f64)| Axle { position: x - middle, ..axle };
                let axles: Vec<Axle> = axles.iter().zip(&positions).map(place).collect();
                let inertia = mass * 6.0;
                // Springs are all that holds a body up: where they cannot, there is no such vehicle.
                Vehicle::new(mass, inertia, 1.2, axles).unwrap_or_else(|_| crate::problems::kishan_vehicle())
            }
        }
    }
}

/// What is left of a case: a study and its samples.
#[derive(Debug)]
struct Case {
    bridge: Bridge,
    vehicles: Vec<Vehicle>,
    settings: Settings,
    own: Option<f64>,
    advance: Option<f64>,
    quantities: Vec<Quantity>,
    recovery: Recovery,
    modes: usize,
    ratio: f64,
    samples: Samples,
}

prop_compose! {
    fn any_case()(
        bridge in any_bridge(),
        vehicles in prop::collection::vec(any_vehicle(), 1..3),
        road in 0..4,
        own in prop_oneof![Just(None), Just(Some(64e-6)), Just(Some(4096e-6))],
        approach in prop_oneof![Just(0.0), 0.5..15.0_f64],
        ramped in any::<bool>(),
        tail in prop_oneof![
            Just(Tail::Free), Just(Tail::Fixed(0.0)), (1e-4..0.5_f64).prop_map(Tail::Fixed)
        ],
        beta in prop_oneof![Just(1.0 / 6.0), Just(0.25), Just(1.0 / 12.0)],
        advance in prop_oneof![Just(None), (0.03..0.4_f64).prop_map(Some)],
        quantities in prop::sample::subsequence(ALL.to_vec(), 1..=6),
        recovery in prop_oneof![
            Just(Recovery::ForceSummation), Just(Recovery::ForceSummationByRates), Just(Recovery::Superposition)
        ],
        count in prop_oneof![Just(0_usize), Just(1), Just(2), Just(9), Just(33)],
        (modes, ratio, salt, varied, first) in (1..7_usize, 0.0..0.05_f64, 0..1000_usize, 0..1024_u32, 0..1_u64 << 40),
    ) -> Case {
        let finest = |x: f64| bump(x * bridge.length());
        let roads = [Road::smooth(), finest(0.3), Road::sum([finest(0.1), finest(0.8)]), waves(bridge.length())];
        let settings = Settings {
            approach, tail, beta, lift_off: salt % 5 != 0,
            ramp: if ramped { 0.7 * approach } else { 0.0 },
            road: Arc::new(roads[road as usize].clone()),
            ..Settings::at_speed(1.0)
        };
        let parameters = Parameter::ALL.into_iter().enumerate().filter(|(p, _)| varied >> p & 1 == 1);
        let factors = parameters.map(|(p, parameter)| {
            let value = |i: usize| match parameter {
                Parameter::InitialFriction => 2.0 * spread(11 * i + p + salt) - 1.0,
                _ => 0.6 + 0.8 * spread(11 * i + p + salt),
            };
            let constant = (salt + p) % 3 == 0;
            let values = (0..if constant { 1 } else { count }).map(value).collect();
            Factors { parameter, width: 1, values }
        });
        let factors: Vec<Factors> = factors.filter(|factors| count > 0 || factors.values.len() == 1).collect();
        let speeds = match salt % 4 {
            0 => vec![8.0 + 30.0 * spread(salt)],
            _ => (0..count).map(|i| 5.0 + 40.0 * spread(i + salt)).collect(),
        };
        let speeds = if speeds.is_empty() { vec![20.0] } else { speeds };
        let kinds = match vehicles.len() {
            1 => Vec::new(),
            n => (0..count).map(|i| ((i + salt) % n) as u32).collect(),
        };
        let modes = modes.min(bridge.stations().len());
        let samples = Samples { first, count, kinds, speeds, factors };
        Case { bridge, vehicles, settings, own, advance, quantities, recovery, modes, ratio, samples }
    }
}

/// Long waves of 10 mm, known wherever a vehicle comes.
fn waves(length: f64) -> Road {
    crate::problems::mechanics::profile([-60.0, length + 60.0], |x| 0.01 * (0.7 * x).sin())
}

/// The part of a row that a kind of event fills, and the rest.
fn split(values: &[f64], width: usize, count: usize) -> impl Iterator<Item = (&[f64], &[f64])> {
    values.chunks(width.max(1)).map(move |side| side.split_at(count.min(side.len())))
}

fn check(case: Case) -> Result<(), TestCaseError> {
    let Case { bridge, vehicles, settings, own, advance, quantities, recovery, modes, ratio, samples } = case;
    let analysis = analysis_of(&bridge, modes, &Damping::Ratios(vec![ratio]), &[], recovery);
    let kinds: Vec<Vec<Passage>> = vehicles.iter().map(|v| vec![Passage::of(v.clone())]).collect();
    let own = own.map(|roughness| (roads(roughness), 99));
    let study = match study_of(analysis, kinds, settings, own, advance, &quantities) {
        Ok(study) => study,
        // Nothing to look at; else what is given is such that there is a study.
        Err(error) => {
            prop_assert!(error.to_string().contains("quantities"), "{error}");
            return Ok(());
        }
    };
    let workers = |isa, threads, chunk| spanwise::ensemble::Workers { isa, threads, chunk: Some(chunk) };
    let widest = Isa::present().last().unwrap();
    let run = |isa, threads, chunk| study.run(&samples, &workers(isa, threads, chunk), &Default::default());
    let found = match run(widest, 2, 5) {
        Ok(found) => found,
        // Factors on what a train does not have.
        Err(error) => {
            prop_assert!(error.is_input(), "{error}");
            prop_assert!(error.to_string().contains("factors"), "{error}");
            return Ok(());
        }
    };
    let again = run(Isa::Baseline, 1, 32).unwrap();
    prop_assert_eq!(found.results.hash(), again.results.hash());
    prop_assert_eq!(&found.results.failures, &again.results.failures);
    let (results, format) = (&found.results, found.results.format);
    prop_assert_eq!(results.digests.len(), samples.count);
    for sample in 0..samples.count {
        let (numbers, instants) = row(results, sample);
        if results.failures.iter().any(|failure| failure.sample == sample) {
            prop_assert!(numbers.iter().all(|v| v.is_nan()) && instants.iter().all(|&i| i == 0));
            continue;
        }
        let vehicle = &vehicles[samples.kind(sample)];
        let (axles, bodies) = (vehicle.assembly().contacts.len(), vehicle.bodies().len());
        for (which, width, count) in [
            (Column::Responses, format.responses, format.responses),
            (Column::Statics, format.responses, format.responses),
            (Column::Loads, format.axles, axles),
            (Column::LoadCoefficients, format.axles, axles),
            (Column::Aloft, format.axles, axles),
            (Column::Accelerations, format.bodies, bodies),
            (Column::Vibrations, format.bodies, bodies),
        ] {
            for (there, padding) in split(column(results, sample, which), width, count) {
                prop_assert!(there.iter().all(|v| v.is_finite()), "sample {}, {:?}", sample, which);
                prop_assert!(there.iter().all(|v| *v != 0.0 || v.is_sign_positive()), "-0: {}, {:?}", sample, which);
                prop_assert!(padding.iter().all(|v| v.is_nan()), "sample {}, {:?}", sample, which);
            }
        }
        // The largest is not less than the smallest, and every instant is one.
        let sides = column(results, sample, Column::Responses).split_at(format.responses);
        prop_assert!(sides.0.iter().zip(sides.1).all(|(max, min)| max >= min));
        let (march, speed) = (results.marches[sample], samples.speed(sample, 0));
        let path = study.path(found.marches[march as usize]);
        let last = path.steps as f64 + column(results, sample, Column::Tail)[0] * speed / path.advance + 1.0;
        let hands = found.clock.of(march);
        for &instant in &instants[..2 * format.responses] {
            let known = match decoded(instant) {
                Instant::Stop(_) => hands.when(speed, instant).0.is_finite(),
                Instant::Step(step) => step as f64 <= last,
            };
            prop_assert!(known, "instant {}", instant);
        }
        prop_assert!(column(results, sample, Column::Loads)[..axles].iter().all(|&v| v > 0.0));
    }
    // Two samples that came through against single crossings, unless a road without end is too much for a crossing.
    let sound = (0..samples.count).filter(|s| results.failures.iter().all(|failure| failure.sample != *s));
    for sample in sound.step_by(samples.count.div_ceil(2).max(1)) {
        let own = some(&samples, sample..sample + 1);
        let alone = study.run(&own, &workers(widest, 1, 32), &Default::default()).unwrap();
        prop_assert_eq!(alone.results.digests[0], results.digests[sample]);
        check_alone(&study, &own, &alone, "random");
    }
    Ok(())
}

fn check_cases(cases: u32, rng_seed: RngSeed) {
    let config = ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed,
        max_shrink_iters: 300,
        ..ProptestConfig::default()
    };
    TestRunner::new(config).run(&any_case(), check).unwrap_or_else(|failure| panic!("{failure}"));
}

#[test]
fn random_studies() {
    check_cases(120, RngSeed::Fixed(1973));
}

/// For `make soak`: other cases each time.
#[test]
#[ignore = "takes as long as one lets it"]
fn many_random_studies() {
    let cases = std::env::var("SPANWISE_SOAK_CASES").map_or(20_000, |cases| cases.parse().unwrap());
    check_cases(cases, RngSeed::Random);
}

/// An event of up to three vehicles, each with a direction, an entry, a drive and perhaps a lane with others.
fn event(vehicles: &[Vehicle], salt: usize, length: f64) -> Vec<Passage> {
    let passage = |(v, vehicle): (usize, &Vehicle)| {
        let chance = |what: usize| spread(salt + 31 * v + 7 * what);
        let speeds = |from: f64| Drive::Speeds { times: vec![0.0, 1.0, 2.5], speeds: vec![from, 14.0, 25.0] };
        let drive = match (8.0 * chance(0)) as usize {
            0 => Drive::Acceleration(1.5),
            1 => Drive::Acceleration(-0.2),
            2 => speeds(18.0),
            3 => speeds(0.0),
            4 if vehicle.assembly().mass.nrows() > 0 => Drive::ConstantTraction,
            _ => Drive::ConstantSpeed,
        };
        let direction = if chance(1) < 0.5 { Direction::Left } else { Direction::Right };
        let entry = if chance(2) < 0.4 { 0.0 } else { 3.0 * chance(3) };
        // Those of one lane, which all go the same way, follow each other.
        let shared = chance(4) < 0.3;
        Passage {
            drive: Some(drive),
            direction: if shared { Direction::Right } else { direction },
            entry: if shared { 0.3 * length * v as f64 } else { entry },
            lane: if shared { 0 } else { 1 + v as i64 },
            ..Passage::of(vehicle.clone())
        }
    };
    vehicles.iter().enumerate().map(passage).collect()
}

/// Vehicles that go their own ways, in lanes of every width, in portions of every size: each sample is the crossing.
fn check_event((case, more, salt): (Case, Vec<Vehicle>, usize)) -> Result<(), TestCaseError> {
    let Case { bridge, vehicles, settings, own, quantities, recovery, modes, ratio, samples, .. } = case;
    let (analysis, length) =
        (analysis_of(&bridge, modes, &Damping::Ratios(vec![ratio]), &[], recovery), bridge.length());
    // Speeds are those of samples, for all vehicles of an event.
    let kinds = vec![event(&vehicles, salt, length), event(&more, salt + 1, length)];
    let settings = Settings { step: Some(0.008), ..settings };
    let own = own.map(|roughness| {
        let spectrum = Spectrum::new(roughness, 2.0, [0.01, 4.0]).unwrap();
        (Arc::new(Synthesis::new(spectrum, Patch::new(0.24).unwrap(), Some(1024.0)).unwrap()), 99)
    });
    let study = match study_of(analysis, kinds, settings, own, None, &quantities) {
        Ok(study) => study,
        Err(error) => {
            prop_assert!(error.is_input(), "{error}");
            return Ok(());
        }
    };
    let kinds = (0..samples.count).map(|i| (i % 2) as u32).collect();
    let samples = Samples { kinds, factors: samples.factors.into_iter().filter(|f| f.width == 1).collect(), ..samples };
    let run = |isa, threads, chunk| {
        study.run(&samples, &spanwise::ensemble::Workers { isa, threads, chunk: Some(chunk) }, &Default::default())
    };
    let Ok(found) = run(Isa::present().last().unwrap(), 2, 5) else { return Ok(()) };
    for (isa, chunk) in Isa::present().zip([32, 3, 9, 1]) {
        let again = run(isa, 1, chunk).unwrap();
        prop_assert_eq!(found.results.hash(), again.results.hash());
        prop_assert_eq!(&found.results.failures, &again.results.failures);
    }
    if !study.shares {
        check_own_ways(&study, &samples, &found, "random event");
    }
    Ok(())
}

#[test]
fn random_events() {
    let config = ProptestConfig {
        cases: 40,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(11),
        max_shrink_iters: 100,
        ..ProptestConfig::default()
    };
    let events = (any_case(), prop::collection::vec(any_vehicle(), 1..4), 0..1000_usize);
    TestRunner::new(config).run(&events, check_event).unwrap_or_else(|failure| panic!("{failure}"));
}
