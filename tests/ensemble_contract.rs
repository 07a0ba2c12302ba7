//! The contract of an ensemble: a sample is a crossing, to the bit, however the work is done.

use crate::problems::ensemble::study_of;
use spanwise::stop_token::StopToken;
use std::sync::Arc;

use crate::problems::ensemble::*;
use crate::problems::vehicles::{articulated, elastic, half_car, hs20, leaf, with_axles};
use crate::problems::{all_arrangements, kishan_bridge, kishan_vehicle, spread};
use spanwise::bridge::Bridge;
use spanwise::damping::{Damping, ModalDamping};
use spanwise::ensemble::{BLOCK, Column, Factors, Parameter, Samples, Study};
use spanwise::lane::Isa;
use spanwise::passage::{Direction, Drive, Passage, Settings, Tail};
use spanwise::recovery::Recovery;
use spanwise::step::{Moving, Propulsion, Scheme, Stepper};
use spanwise::vehicle::{Axle, Friction, Vehicle, catalogue};

/// Every way of doing the work, against the samples in one go on one thread without any instruction set in particular;
/// and some samples alone.
fn check_ways(study: &Study, samples: &Samples, alone: &[usize]) {
    let reference = run(study, samples, Isa::Baseline, 1).results;
    assert!(reference.failures.is_empty(), "{:?}", reference.failures);
    for isa in Isa::present() {
        for threads in [1, 2, 7] {
            for chunk in [1, 31, 32, 1000] {
                let again = run_in_chunks(study, samples, isa, threads, chunk).results;
                assert_eq!(again.hash(), reference.hash(), "{isa:?}, {threads} threads, chunks of {chunk}");
            }
        }
        for &sample in alone {
            let own = some(samples, sample..sample + 1);
            assert_eq!(run(study, &own, isa, 1).results.digests[0], reference.digests[sample], "sample {sample} alone");
        }
    }
}

#[test]
fn nothing_about_the_work_changes_a_bit() {
    check_ways(&headline(), &Samples::at_speed(0, 70, 22.86), &[0, 17, 69]);
}

/// As many groups of lanes one after the other as a worker takes at most, and then some of the next portion.
#[test]
fn a_long_portion_is_as_good_as_short_ones() {
    let (study, samples) = (headline(), Samples::at_speed(0, BLOCK + 3, 22.86));
    let widest = Isa::chosen().unwrap();
    let long = run_in_chunks(&study, &samples, widest, 1, BLOCK).results;
    assert_eq!(long.hash(), run_in_chunks(&study, &samples, widest, 2, 8).results.hash());
}

/// Of every kind as many samples as come one by one, and more, which come side by side: the same bits, and those of
/// single crossings; kinds of several vehicles too.
#[test]
fn kinds_of_few_samples_are_as_good_as_kinds_of_many() {
    let vehicles = [
        kishan_vehicle(),
        half_car([700.0, 1100.0], 1.0, 0.3, Friction::coulomb(8e3)),
        articulated(1.0, 0.0),
        hs20(1.0),
        Vehicle::moving_masses(&[500.0, 800.0], &[0.0, -3.1]).unwrap(),
        Vehicle::force_train(&[3e4, 8e4, 7e4], &[0.0, -2.9, -4.3]).unwrap(),
    ];
    let number = vehicles.len();
    for tail in [Tail::Fixed(0.0), Tail::Fixed(0.7), Tail::Free] {
        let settings = Settings { approach: 6.0, tail, ..Settings::at_speed(1.0) };
        let kinds: Vec<Vec<Passage>> = vehicles.iter().map(|vehicle| vec![Passage::of(vehicle.clone())]).collect();
        let analysis = kishan_analysis(9, Recovery::ForceSummation);
        let study = study_of(analysis, kinds, settings, Some((synthesis(), SEED)), Some(0.1), &ALL).unwrap();
        assert!(study.shares);
        // Ten of each kind, of which any that follow each other are few.
        let count = 10 * number;
        let kinds = (0..count).map(|i| (i % number) as u32).collect();
        let samples = Samples { kinds, ..Samples::at_speed(3, count, 21.0) };
        let many = run(&study, &samples, Isa::chosen().unwrap(), 2);
        check_alone(&study, &samples, &many, "many");
        for few in [1, 2, 3 * number] {
            for start in (0..count - few + 1).step_by(few) {
                let own = some(&samples, start..start + few);
                let found = run(&study, &own, Isa::chosen().unwrap(), 2);
                assert_eq!(found.results.digests, many.results.digests[start..start + few], "{few} from {start}");
                if few == 1 && start < number {
                    check_alone(&study, &own, &found, "few");
                }
            }
        }
        assert!(many.at_rest.iter().flatten().all(|value| value.is_finite()));
    }
}

/// With everything that a study allows, and all of it at work.
#[test]
fn nothing_about_the_work_changes_a_bit_of_a_mixed_study() {
    let (study, samples) = (mixed(), mixed_samples(5, 70));
    let found = run(&study, &samples, Isa::chosen().unwrap(), 2);
    let (results, format) = (&found.results, found.results.format);
    let lifted = |sample: usize| row(results, sample).1[2 * (format.responses + format.axles)..].iter().any(|&n| n > 0);
    let lifting = (0..samples.count).filter(|&sample| lifted(sample)).count();
    println!("{lifting} of {} lift off; marches {:?}", samples.count, found.marches);
    assert!(lifting > 5, "{lifting}");
    // Both kinds with and without halved steps.
    assert!(found.marches.len() >= 4, "{:?}", found.marches);
    check_ways(&study, &samples, &[0, 1, 2, 33, 69]);
    check_alone(&study, &samples, &found, "mixed");
}

#[test]
fn a_sample_is_a_crossing() {
    let study = headline();
    let speeds: Vec<f64> = (0..9).map(|i| 15.0 + 3.0 * f64::from(i)).collect();
    let samples = Samples { speeds, ..Samples::at_speed(100, 9, 1.0) };
    check_alone(&study, &samples, &run(&study, &samples, Isa::Baseline, 1), "headline");
}

/// One of each sort: massless axles that rub and slide, unsprung masses with all kinds of friction, damped tyres, two
/// bodies, forces, masses in rigid contact.
fn vehicles() -> Vec<(&'static str, Vehicle)> {
    vec![
        ("massless axles that rub", kishan_vehicle()),
        ("leaf springs", half_car([700.0, 1100.0], 1.0, 0.0, leaf(8e3, 1e-3))),
        ("massless axles on leaf springs, damped tyres", half_car([0.0; 2], 1.0, 1.0, leaf(8e3, 1e-3))),
        ("elastic sticks", half_car([700.0, 1100.0], 0.5, 1.0, elastic(5e3, 2e7))),
        ("rigid friction", half_car([700.0, 1100.0], 1.0, 0.0, Friction::coulomb(6e3))),
        ("one axle with mass, one without", half_car([700.0, 0.0], 1.0, 1.0, Friction::NONE)),
        ("two bodies", articulated(1.0, 1.0)),
        ("two bodies, undamped tyres", hs20(1.0)),
        ("forces", Vehicle::force_train(&[9e4, 1.2e5, 1.1e5], &[0.0, -3.5, -5.0]).unwrap()),
        ("masses", Vehicle::moving_masses(&[3e3, 4e3, 2e3], &[0.0, -2.5, -6.0]).unwrap()),
    ]
}

fn is_rigid(vehicle: &Vehicle) -> bool {
    vehicle.bodies().is_empty() && vehicle.mass() > 0.0
}

const RECOVERIES: [Recovery; 3] = [Recovery::ForceSummation, Recovery::ForceSummationByRates, Recovery::Superposition];

/// One study of nine samples on roads of class D, some with a tail and some without an approach.
fn check_study(name: &str, bridge: &Bridge, vehicle: &Vehicle, recovery: Recovery, variant: usize) {
    let damping = Damping::Ratios(vec![0.015]);
    let modes = bridge.stations().len().min(4);
    let analysis = analysis_of(bridge, modes, &damping, &[], recovery);
    let approach = if variant.is_multiple_of(2) { 0.0 } else { 11.0 };
    let ramp = if variant % 4 == 3 { 4.0 } else { 0.0 };
    let tail = [Tail::Fixed(0.0), Tail::Free, Tail::Fixed(0.13), Tail::Free, Tail::Fixed(0.4)][variant % 5];
    let road = if variant % 5 == 4 { Arc::new(bump(0.3 * bridge.length())) } else { Settings::at_speed(1.0).road };
    let own = (variant % 7 != 6).then(|| (roads(POOR), 3));
    let settings = Settings { approach, ramp, tail, road, ..Settings::at_speed(SPEED) };
    let kinds = vec![vec![Passage::of(vehicle.clone())]];
    let study = study_of(analysis, kinds, settings, own, (variant % 2 == 1).then_some(0.07), &ALL).unwrap();
    let speeds = (0..9).map(|i| 8.0 + 30.0 * spread(variant + i)).collect();
    let samples = Samples { speeds, ..Samples::at_speed(variant as u64, 9, 1.0) };
    let isa = Isa::present().last().unwrap();
    check_alone(&study, &samples, &run(&study, &samples, isa, 2), name);
}

/// Ends free, clamped, sprung; hinges; sections at ends, supports and stations; every recovery.
#[test]
fn a_sample_is_a_crossing_on_every_bridge() {
    let vehicles = vehicles();
    let mut variant = 0;
    for (bridge_name, bridge) in all_arrangements() {
        for recovery in RECOVERIES {
            let (name, vehicle) = &vehicles[(variant * 3 + variant / 10) % vehicles.len()];
            variant += 1;
            if is_rigid(vehicle) && !bridge.hinges().is_empty() {
                continue;
            }
            check_study(&format!("{bridge_name}, {name}, {recovery:?}"), &bridge, vehicle, recovery, variant);
        }
    }
}

#[test]
fn a_sample_is_a_crossing_by_every_vehicle() {
    for (variant, (name, vehicle)) in vehicles().iter().enumerate() {
        for (more, recovery) in RECOVERIES.into_iter().enumerate() {
            check_study(&format!("{name}, {recovery:?}"), &kishan_bridge(), vehicle, recovery, variant + more);
        }
    }
}

/// Vehicles that have their own steps, those of [`spanwise::step::Gait`], where samples are alike, against the steps of any
/// vehicle, which a single crossing takes: they stick, slide, lift off, and come on to the bridge and leave it.
#[test]
fn own_steps_are_those_of_any_vehicle() {
    let coulomb = |axles: usize| {
        let friction = Friction { initial: 2e3, ..Friction::coulomb(9e3) };
        let at = |k: usize| 0.85 * (axles as f64 - 1.0 - 2.0 * k as f64);
        let axle = |k| Axle { friction, ..Axle::new(at(k), 3.5e6, 1.1e6 + 1e5 * k as f64) };
        Vehicle::new(7e3 * axles as f64, 9e4, 1.2, (0..axles).map(axle).collect()).unwrap()
    };
    let undamped = |vehicle: Vehicle| with_axles(Ok(vehicle), |_, axle| axle.tyre_damping = 0.0);
    let vehicles = [
        ("two axles that rub", coulomb(2)),
        ("three axles that rub", coulomb(3)),
        ("four axles that rub", coulomb(4)),
        ("five axles that rub", coulomb(5)),
        ("a quarter of a lorry", catalogue::quarter_car(1.0).unwrap()),
        ("half a lorry", half_car([700.0, 1100.0], 1.0, 0.0, Friction::NONE)),
        ("half a lorry, damped tyres", half_car([700.0, 1100.0], 1.0, 1.0, Friction::NONE)),
        ("three axles", undamped(hs20(1.0))),
        ("three axles, damped tyres", hs20(1.0)),
        ("five axles", articulated(1.0, 0.0)),
        (
            "five axles, one tyre undamped",
            with_axles(Ok(articulated(1.0, 1.0)), |k, axle| {
                axle.tyre_damping *= f64::from(u8::from(k != 2));
            }),
        ),
    ];
    let mut lifting = 0;
    for (variant, (name, vehicle)) in vehicles.into_iter().enumerate() {
        let (assembly, propulsion) = (vehicle.assembly(), Propulsion::Prescribed);
        let moving = [Moving { assembly, propulsion, direction: 1.0, grade: 0.0 }];
        let scheme = Scheme { h: 1e-3, beta: 0.25, gravity: 9.81, lift_off: true };
        let stepper = Stepper::<f64>::new(&[], &ModalDamping::Classical(Vec::new()), &moving, &scheme);
        assert!(stepper.gait().is_some(), "{name}");
        let modes = 1 + variant % 4;
        let analysis =
            analysis_of(&kishan_bridge(), modes, &Damping::Ratios(vec![0.02]), &[], Recovery::ForceSummation);
        let tail = [Tail::Fixed(0.13), Tail::Free, Tail::Fixed(0.0)][variant % 3];
        let approach = if variant % 4 == 3 { 0.0 } else { 9.0 };
        let settings = Settings { approach, ramp: 0.3 * approach, tail, ..Settings::at_speed(SPEED) };
        let kinds = vec![vec![Passage::of(vehicle)]];
        let study = study_of(analysis, kinds, settings, Some((roads(4.0 * POOR), 3)), Some(0.05), &ALL).unwrap();
        let samples = Samples::at_speed(11, 19, 24.0);
        let found = run(&study, &samples, Isa::chosen().unwrap(), 1);
        check_alone(&study, &samples, &found, name);
        let (results, format) = (&found.results, found.results.format);
        let lifted = |i: usize| row(results, i).1[2 * (format.responses + format.axles)..].iter().any(|&n| n > 0);
        lifting += usize::from((0..samples.count).any(lifted));
        for isa in Isa::present() {
            assert_eq!(run(&study, &samples, isa, 2).results.hash(), results.hash(), "{name}, {isa:?}");
        }
    }
    // The others are too heavy on their tyres for this road.
    assert!(lifting >= 4, "{lifting} vehicles lift off");
}

/// Factors of each axle and body its own, and on the bridge, by every recovery.
#[test]
fn a_sample_with_its_own_factors_is_a_crossing() {
    for recovery in RECOVERIES {
        let damping = Damping::Rayleigh { mass: 0.4, stiffness: 5e-4 };
        let analysis = analysis_of(&crate::problems::two_spans(4), 4, &damping, &[], recovery);
        let kinds = vec![vec![Passage::of(articulated(1.0, 1.0))]];
        let settings = Settings { approach: 8.0, tail: Tail::Fixed(0.2), ..Settings::at_speed(SPEED) };
        let study = study_of(analysis, kinds, settings, Some((roads(POOR), SEED)), None, &ALL).unwrap();
        let count = 11;
        let factors = Parameter::ALL.into_iter().enumerate().filter_map(|(p, parameter)| {
            let width = match parameter {
                Parameter::BodyMass | Parameter::PitchInertia => 2,
                Parameter::BridgeStiffness | Parameter::BridgeDamping => 1,
                // Without friction there is none to vary.
                Parameter::FrictionLimit | Parameter::InitialFriction => return None,
                _ => 5,
            };
            let values = (0..count * width).map(|i| 0.8 + 0.4 * spread(13 * i + p)).collect();
            Some(Factors { parameter, width, values })
        });
        let speeds = (0..count).map(|i| 10.0 + 2.0 * i as f64).collect();
        let samples = Samples { factors: factors.collect(), speeds, ..Samples::at_speed(40, count, 1.0) };
        check_alone(&study, &samples, &run(&study, &samples, Isa::chosen().unwrap(), 2), &format!("{recovery:?}"));
    }
}

/// Without its dampers or its friction a sample's step is made of other parts than its neighbours'.
#[test]
fn a_factor_of_zero_is_the_sample_s_own() {
    let none = Friction::NONE;
    for (vehicle, parameter) in [
        (half_car([700.0, 1100.0], 1.0, 1.0, elastic(5e3, 2e7)), Parameter::FrictionLimit),
        (kishan_vehicle(), Parameter::FrictionLimit),
        (half_car([0.0; 2], 1.0, 1.0, none), Parameter::SuspensionDamping),
        (half_car([0.0; 2], 1.0, 0.0, none), Parameter::SuspensionDamping),
        (half_car([0.0; 2], 0.0, 1.0, none), Parameter::TyreDamping),
    ] {
        let kinds = vec![vec![Passage::of(vehicle)]];
        let analysis = kishan_analysis(5, Recovery::ForceSummation);
        let own = Some((synthesis(), SEED));
        let study = study_of(analysis, kinds, Settings::at_speed(SPEED), own, None, &ALL).unwrap();
        for zeros in [vec![0], vec![3], vec![1, 2, 5, 7]] {
            let values = (0..19).map(|i| if zeros.contains(&i) { 0.0 } else { 1.0 }).collect();
            let factors = vec![Factors { parameter, width: 1, values }];
            let samples = Samples { factors, ..samples(19) };
            let found = run(&study, &samples, Isa::chosen().unwrap(), 2);
            check_alone(&study, &samples, &found, &format!("{parameter:?}, {zeros:?}"));
        }
    }
}

/// Speeds so different that the dampers of a massless axle are strong for some steps and weak for others.
#[test]
fn dampers_are_weak_in_long_steps_only() {
    let axle = Axle { tyre_damping: 1.2e4, ..Axle::new(0.0, 8e5, 1.2e6) };
    let kinds = vec![vec![Passage::of(Vehicle::new(5e3, 3e4, 1.2, vec![axle]).unwrap())]];
    let analysis = kishan_analysis(5, Recovery::ForceSummation);
    let study = study_of(analysis, kinds, Settings::at_speed(1.0), None, Some(0.2), &ALL).unwrap();
    let samples = Samples { speeds: (0..33).map(|i| 6.0 + 40.0 * spread(i)).collect(), ..samples(33) };
    check_ways(&study, &samples, &[0, 1, 2, 3]);
    check_alone(&study, &samples, &run(&study, &samples, Isa::Baseline, 1), "weak dampers");
}

/// Nothing of a study of vehicles that go their own ways depends on the work either.
#[test]
fn several_vehicles_are_a_crossing_each() {
    let analysis = kishan_analysis(9, Recovery::ForceSummation);
    let second = Passage { entry: 0.8, ..Passage::of(hs20(1.0)) };
    let kinds = vec![vec![Passage::of(kishan_vehicle()), second], vec![Passage::of(kishan_vehicle())]];
    let settings = Settings { tail: Tail::Fixed(0.2), ..approach() };
    let study = study_of(analysis, kinds, settings, Some((synthesis(), SEED)), None, &ALL).unwrap();
    assert!(!study.shares);
    let kinds = (0..10).map(|i| i % 2).collect();
    let samples = Samples { kinds, ..Samples::at_speed(3, 10, SPEED) };
    check_ways(&study, &samples, &[0, 1, 9]);
    // The second kind alone shares its geometry: the extremes are the same.
    let found = run(&study, &samples, Isa::Baseline, 2);
    let one = alone(&study, &samples, 1, found_advance(&study)).unwrap();
    let values = column(&found.results, 1, Column::Responses);
    for (place, &r) in study.look.chosen.iter().enumerate() {
        assert_eq!(values[place], one.envelope.dynamic.max[r].value);
    }
}

/// The same vehicles, some of which stand on the bridge as a crossing starts and some of which come later, slow down, or
/// are abreast of each other: those of one make go side by side.
#[test]
fn vehicles_of_one_make_are_a_crossing_each() {
    let analysis = kishan_analysis(9, Recovery::ForceSummation);
    let event = |entries: [f64; 2], direction: Direction, drive: Drive| {
        let first = Passage { entry: entries[0], ..Passage::of(half_car([700.0, 1100.0], 1.0, 0.0, Friction::NONE)) };
        let second = Passage { entry: entries[1], lane: 1, direction, drive: Some(drive), ..first.clone() };
        vec![first, second]
    };
    let steady = || Drive::ConstantSpeed;
    let kinds = vec![
        event([0.0, 1.0], Direction::Left, steady()),
        event([0.5, 1.5], Direction::Left, steady()),
        event([0.0, 0.0], Direction::Right, steady()),
        event([0.0, 0.3], Direction::Left, Drive::Acceleration(-0.5)),
        event([0.2, 0.0], Direction::Left, Drive::Acceleration(-15.0)),
    ];
    let number = kinds.len();
    for (before, tail) in [(0.0, Tail::Free), (0.0, Tail::Fixed(0.0)), (12.0, Tail::Fixed(0.3))] {
        let settings = Settings { approach: before, ramp: 0.5 * before, tail, step: Some(2e-3), ..approach() };
        let study =
            study_of(Arc::clone(&analysis), kinds.clone(), settings, Some((synthesis(), SEED)), None, &ALL).unwrap();
        let count = 9 * number;
        let samples = Samples {
            kinds: (0..count).map(|i| (i % number) as u32).collect(),
            speeds: (0..count).map(|i| 18.0 + 8.0 * spread(i)).collect(),
            ..Samples::at_speed(3, count, SPEED)
        };
        check_ways(&study, &samples, &[0, 1, 4]);
        check_own_ways(&study, &samples, &run(&study, &samples, Isa::chosen().unwrap(), 2), "one make");
    }
}

/// Trains of forces, alike or each with loads, stiffness and damping of its own; on ends that are held and on free ones.
#[test]
fn trains_of_forces_are_a_crossing_each() {
    let (axles, count) = (7, 37);
    let loads: Vec<f64> = (0..axles).map(|k| 8e4 + 5e4 * spread(k)).collect();
    let positions: Vec<f64> = (0..axles).map(|k| -2.7 * k as f64 - spread(k)).collect();
    let train = Vehicle::force_train(&loads, &positions).unwrap();
    let factors = |parameter: Parameter, width: usize| {
        let values = (0..count * width).map(|i| 0.8 + 0.4 * spread(7 * i)).collect();
        Factors { parameter, width, values }
    };
    let variants = [
        vec![],
        vec![factors(Parameter::BridgeStiffness, 1), factors(Parameter::BridgeDamping, 1)],
        vec![factors(Parameter::BodyMass, 1)],
        vec![factors(Parameter::BodyMass, axles), factors(Parameter::BridgeDamping, 1)],
    ];
    let bridges = all_arrangements().into_iter().step_by(5);
    for (i, (name, bridge)) in bridges.enumerate() {
        let tail = [Tail::Fixed(0.0), Tail::Free, Tail::Fixed(0.13)][i % 3];
        let modes = bridge.stations().len().min(4);
        let analysis = analysis_of(&bridge, modes, &Damping::Ratios(vec![0.02]), &[], RECOVERIES[i % RECOVERIES.len()]);
        let approach = if i.is_multiple_of(2) { 0.0 } else { 3.0 };
        let settings = Settings { approach, tail, ..Settings::at_speed(1.0) };
        let kinds = vec![vec![Passage::of(train.clone())]];
        let study = study_of(analysis, kinds, settings, None, Some(0.15), &ALL).unwrap();
        let speeds = (0..count).map(|i| 12.0 + 70.0 * spread(i)).collect();
        let samples = Samples { factors: variants[i % 4].clone(), speeds, ..Samples::at_speed(0, count, 1.0) };
        check_ways(&study, &samples, &[0, 5, 36]);
        check_alone(&study, &samples, &run(&study, &samples, Isa::chosen().unwrap(), 2), name);
    }
}

/// The way per step that a single crossing at the speed of the study chooses [m].
fn found_advance(study: &Study) -> f64 {
    let settings = Settings { road: Arc::new(synthesis().road(SEED, 4).into()), ..study.settings.clone() };
    let outcome = study.analysis.cross(&kishan_vehicle(), &settings, StopToken::NEVER).unwrap();
    outcome.history.step * settings.speed
}
