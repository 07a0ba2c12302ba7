//! What a sample leaves besides extremes of responses, and what factors do, against single crossings; how steps are halved.

use crate::problems::continuous;
use crate::problems::ensemble::study_of;
use spanwise::stop_token::StopToken;
use std::sync::Arc;

use crate::problems::ensemble::*;
use crate::problems::vehicles::{articulated, half_car, leaf};
use crate::problems::{PINNED, kishan_vehicle, largest_magnitude, spread};
use spanwise::bridge::Stations;
use spanwise::damping::Damping;
use spanwise::ensemble::{Column, Factors, Parameter, Results, Run, Samples, Study};
use spanwise::lane::Isa;
use spanwise::passage::{Passage, Settings, Tail};
use spanwise::recovery::Recovery;
use spanwise::statics::Quantity;
use spanwise::vehicle::{Axle, Friction, Vehicle};

/// Sums of some thousand numbers in another order, relative.
const SUMMED: f64 = 1e-9;

/// Crossings of a bridge and its vehicle worked out twice, relative to the largest response of a kind.
const TWICE: f64 = 1e-8;

/// From all numbers of a history: spread of the loads, their zeros, accelerations of the bodies.
fn check_statistics(study: &Study, samples: &Samples, name: &str) -> [usize; 2] {
    let found = run(study, samples, Isa::chosen().unwrap(), 2);
    let (results, format) = (&found.results, found.results.format);
    let length = study.analysis.rows.mesh().length();
    let (mut lifts, mut at_the_end) = (0, 0);
    for sample in 0..samples.count {
        let path = study.path(found.marches[results.marches[sample] as usize]);
        let single = alone(study, samples, sample, path.advance).unwrap();
        let (history, axles) = (&single.history, single.history.axles);
        let on_bridge = |i: &usize| history.positions[i * axles..][..axles].iter().any(|x| (0.0..=length).contains(x));
        let first = (0..history.len()).find(on_bridge).unwrap();
        let there = first..path.steps + 1;
        let count = there.len() as f64;
        let near = |what: &str, value: f64, expected: f64, scale: f64| {
            let off = (value - expected).abs();
            assert!(off <= SUMMED * scale, "{name}, sample {sample}, {what}: {value}, {expected}");
        };
        for k in 0..axles {
            let load = |i: usize| history.loads[i * axles + k];
            let at_rest = history.static_loads[k];
            let square = there.clone().map(|i| (load(i) - at_rest).powi(2)).sum::<f64>() / count;
            let coefficient = square.sqrt() / at_rest;
            near("load coefficient", column(results, sample, Column::LoadCoefficients)[k], coefficient, coefficient);
            // In the air from an instant to the next if the load is zero at the first of them.
            let off = |i: usize| load(i) == 0.0;
            let aloft = (1..=history.last_on).filter(|&i| off(i - 1)).map(|i| history.time[i] - history.time[i - 1]);
            near("time aloft", column(results, sample, Column::Aloft)[k], aloft.sum(), 1.0);
            let lift_offs = (0..=history.last_on).filter(|&i| off(i) && (i == 0 || !off(i - 1))).count();
            let (_, instants) = row(results, sample);
            assert_eq!(instants[2 * (format.responses + format.axles) + k] as usize, lift_offs, "{name}, {sample}");
            lifts += lift_offs;
            at_the_end += usize::from(off(history.last_on));
        }
        for (b, [heave, _]) in single.vehicle.assembly().bodies.iter().enumerate() {
            let width = history.motion_width();
            let acceleration =
                |i: usize| (0..heave.len()).map(|q| heave[q] * history.motion[i * width + 3 * q + 2]).sum::<f64>();
            let largest = (0..=history.last_on).map(|i| acceleration(i).abs()).fold(0.0, f64::max);
            let mean = there.clone().map(|i| acceleration(i).powi(2)).sum::<f64>() / count;
            near("acceleration", column(results, sample, Column::Accelerations)[b], largest, largest);
            near("vibration", column(results, sample, Column::Vibrations)[b], mean.sqrt(), mean.sqrt());
        }
        check_padding(results, sample, axles, single.vehicle.bodies().len());
    }
    [lifts, at_the_end]
}

/// Numbers where there are an axle and a body, nothing elsewhere.
fn check_padding(results: &Results, sample: usize, axles: usize, bodies: usize) {
    let format = results.format;
    let parts = [
        (Column::Loads, format.axles, axles),
        (Column::LoadCoefficients, format.axles, axles),
        (Column::Aloft, format.axles, axles),
        (Column::Accelerations, format.bodies, bodies),
        (Column::Vibrations, format.bodies, bodies),
    ];
    for (which, width, count) in parts {
        for side in column(results, sample, which).chunks(width.max(1)) {
            assert!(side[..count].iter().all(|v| v.is_finite()), "sample {sample}, {which:?}");
            assert!(side[count..].iter().all(|v| v.is_nan()), "sample {sample}, {which:?}");
        }
    }
}

#[test]
fn statistics_are_those_of_the_history() {
    let [lifts, _] = check_statistics(&mixed(), &mixed_samples(0, 40), "mixed");
    assert!(lifts > 100, "{lifts}");
    check_statistics(&headline(), &samples(10), "headline");
    // Forces have no bodies.
    let forces = Vehicle::force_train(&[9e4, 1.2e5], &[0.0, -3.5]).unwrap();
    let analysis = kishan_analysis(9, Recovery::ForceSummation);
    let settings = Settings { tail: Tail::Fixed(0.3), ..approach() };
    let study = study_of(analysis, vec![vec![Passage::of(forces)]], settings, None, None, &ALL).unwrap();
    let found = run(&study, &samples(3), Isa::Baseline, 1).results;
    assert_eq!(found.format.bodies, 0);
    assert!(column(&found, 1, Column::LoadCoefficients).iter().all(|&v| v == 0.0));
}

/// A wheel that is in the air when the last axle has left the bridge counts until then and no longer, whatever the tail.
#[test]
fn time_aloft_ends_with_the_crossing() {
    let mut late = 0;
    for (seconds, approach) in [(0.0, 2.0), (0.0317, 3.0), (1e-4, 2.0), (0.05, 2.0)] {
        let light = half_car([700.0, 1100.0], 0.3, 0.0, Friction::NONE);
        let settings = Settings { approach, tail: Tail::Fixed(seconds), ..Settings::at_speed(1.0) };
        let analysis = kishan_analysis(5, Recovery::ForceSummation);
        let kinds = vec![vec![Passage::of(light)]];
        let study = study_of(analysis, kinds, settings, Some((roads(16384e-6), SEED)), Some(0.05), &ALL).unwrap();
        let speeds = (0..80).map(|i| 24.0 + 10.0 * spread(i)).collect();
        let samples = Samples { speeds, ..Samples::at_speed(0, 80, 1.0) };
        let [_, at_the_end] = check_statistics(&study, &samples, &format!("tail {seconds} s"));
        println!("tail of {seconds} s: {at_the_end} in the air at the end");
        late += at_the_end;
    }
    assert!(late >= 10, "{late}");
}

/// A half-car whose body has `mass` times its mass.
fn heavier(mass: f64) -> Vehicle {
    let axle = |position: f64, mass: f64, tyre: f64, spring: f64| Axle {
        mass,
        suspension_damping: 1e4,
        ..Axle::new(position, tyre, spring)
    };
    let axles = vec![axle(2.375, 700.0, 1.75e6, 4e5), axle(-2.375, 1100.0, 3.5e6, 1e6)];
    Vehicle::new(16_200.0 * mass, 93_457.0, 1.4, axles).unwrap()
}

/// Two spans whose EI is `stiffer` times as large, damped by ratio to critical.
fn stiffer(stiffer: f64, ratio: f64, recovery: Recovery) -> Arc<spanwise::crossing::Analysis> {
    let stations = Stations::PerSpan(vec![4, 5]);
    let bridge = continuous(&[14.0, 20.0], [PINNED; 2], &[2.4e9 * stiffer], &[7e3], &stations, &[]).unwrap();
    analysis_of(&bridge, 4, &Damping::Ratios(vec![ratio]), &[], recovery)
}

/// Samples of which each has its factor, against studies of vehicle and bridge built with it.
#[test]
fn factors_are_those_of_vehicles_and_bridges_built_with_them() {
    let settings = Settings { approach: 10.0, tail: Tail::Fixed(0.2), ..Settings::at_speed(20.0) };
    let made = |analysis: Arc<spanwise::crossing::Analysis>, vehicle: Vehicle| {
        let own = Some((synthesis(), SEED));
        study_of(analysis, vec![vec![Passage::of(vehicle)]], settings.clone(), own, Some(0.02), &ALL).unwrap()
    };
    let values = [0.7, 0.85, 1.0, 1.2, 1.5];
    for recovery in [Recovery::ForceSummation, Recovery::ForceSummationByRates, Recovery::Superposition] {
        let study = made(stiffer(1.0, 0.02, recovery), heavier(1.0));
        for parameter in [Parameter::BodyMass, Parameter::BridgeStiffness, Parameter::BridgeDamping] {
            let factors = vec![Factors { parameter, width: 1, values: values.to_vec() }];
            let samples = Samples { factors, ..Samples::at_speed(3, values.len(), 20.0) };
            let Run { results: found, at_rest: alike, .. } = run(&study, &samples, Isa::chosen().unwrap(), 1);
            assert_eq!(found.format.own_statics, parameter != Parameter::BridgeDamping);
            for (sample, &value) in values.iter().enumerate() {
                let built = match parameter {
                    Parameter::BodyMass => made(stiffer(1.0, 0.02, recovery), heavier(value)),
                    Parameter::BridgeStiffness => made(stiffer(value, 0.02, recovery), heavier(1.0)),
                    _ => made(stiffer(1.0, 0.02 * value, recovery), heavier(1.0)),
                };
                let one = Samples::at_speed(3 + sample as u64, 1, 20.0);
                let Run { results: own, at_rest: own_at_rest, .. } = run(&built, &one, Isa::Baseline, 1);
                let near = |what: &str, found: &[f64], expected: &[f64]| {
                    let off = crate::problems::largest_difference(found, expected) / largest_magnitude(expected);
                    assert!(off <= TWICE, "{recovery:?}, {parameter:?} {value}, {what}: {off:e}");
                };
                let at_rest = match found.format.own_statics {
                    true => column(&found, sample, Column::Statics),
                    false => &alike[0],
                };
                let responses = found.format.responses;
                for side in 0..2 {
                    for quantity in ALL {
                        let all = study.analysis.responses.range(quantity);
                        let range = side * responses + all.start..side * responses + all.end;
                        // Where nothing is clamped there is no such response.
                        if all.is_empty() {
                            continue;
                        }
                        let name = format!("{quantity:?}");
                        let [dynamic, expected] =
                            [column(&found, sample, Column::Responses), column(&own, 0, Column::Responses)];
                        near(&name, &dynamic[range.clone()], &expected[range.clone()]);
                        near(&name, &at_rest[range.clone()], &own_at_rest[0][range]);
                    }
                }
                near("loads", column(&found, sample, Column::Loads), column(&own, 0, Column::Loads));
                let [accelerations, expected] = [&found, &own].map(|r| r.format.range(Column::Accelerations));
                near("accelerations", &row(&found, sample).0[accelerations], &row(&own, 0).0[expected]);
            }
        }
    }
}

/// Longest step [s] that a single crossing of the sample takes.
fn stability_limit(study: &Study, samples: &Samples, sample: usize) -> f64 {
    let vehicle = samples.vehicle(study.vehicle(samples.kind(sample)), sample, [0, 0]).unwrap();
    let mut model = study.analysis.model.clone();
    let stiffness = samples.factor(Parameter::BridgeStiffness, sample, 0).unwrap_or(1.0);
    model.omega.iter_mut().for_each(|omega| *omega *= stiffness.sqrt());
    1.0 / (model.fastest_frequency([&vehicle].into_iter()) * (0.25 - study.settings.beta).sqrt())
}

/// The step is halved until it is stable, as often as the sample itself asks for it.
#[test]
fn halvings_are_a_function_of_the_sample_alone() {
    let many = Stations::PerSpan(vec![24]);
    let bridge = continuous(&[12.0, 15.0], [PINNED; 2], &[2.4e9], &[7e3], &many, &[]).unwrap();
    let two = half_car([700.0, 1100.0], 1.0, 1.0, leaf(8e3, 1e-3));
    let sprung = half_car([300.0, 400.0], 1.0, 1.0, leaf(2e4, 1e-3));
    for (name, modes, kinds) in [
        ("many modes", 16, vec![vec![Passage::of(two.clone())], vec![Passage::of(articulated(1.0, 1.0))]]),
        (
            "few modes, leaf springs that rub more",
            2,
            vec![vec![Passage::of(sprung)], vec![Passage::of(kishan_vehicle())]],
        ),
    ] {
        let analysis = analysis_of(&bridge, modes, &Damping::Ratios(vec![0.02]), &[6.0], Recovery::ForceSummation);
        for (advance, step) in [(None, None), (Some(0.1), None), (Some(0.1), Some(2e-3))] {
            let settings = Settings { step, ..Settings::at_speed(1.0) };
            let own = Some((synthesis(), SEED));
            let study =
                study_of(Arc::clone(&analysis), kinds.clone(), settings, own, advance, &[Quantity::Moment]).unwrap();
            let count = 12;
            // Stiffer and lighter than they are, in all that can be.
            let factors = Parameter::ALL.into_iter().enumerate().map(|(p, parameter)| {
                let value = |i: usize| match parameter {
                    Parameter::BodyMass | Parameter::PitchInertia => 0.3 + spread(7 * i + p),
                    Parameter::FrictionLimit => 1.0 + 8.0 * spread(7 * i + p),
                    Parameter::InitialFriction => 0.0,
                    // Not so stiff that leaf springs drive.
                    Parameter::SuspensionStiffness => 1.0,
                    _ => 0.5 + 2.0 * spread(7 * i + p),
                };
                Factors { parameter, width: 1, values: (0..count).map(value).collect() }
            });
            let samples = Samples {
                kinds: (0..count).map(|i| (i % 2) as u32).collect(),
                speeds: (0..count).map(|i| 6.0 + 30.0 * spread(i)).collect(),
                factors: factors.collect(),
                ..Samples::at_speed(0, count, 1.0)
            };
            let found = run(&study, &samples, Isa::chosen().unwrap(), 2);
            assert!(found.results.failures.is_empty(), "{name}: {:?}", found.results.failures);
            let halved =
                |run: &spanwise::ensemble::Run, sample: usize| run.marches[run.results.marches[sample] as usize].1;
            assert!((0..count).any(|sample| halved(&found, sample) > 0), "{name}: nobody is slow");
            for sample in 0..count {
                let own = run(&study, &some(&samples, sample..sample + 1), Isa::Baseline, 1);
                assert_eq!(halved(&own, 0), halved(&found, sample), "{name}, sample {sample}");
                let way = study.path(found.marches[found.results.marches[sample] as usize]).advance;
                let (taken, limit) = (way / samples.speed(sample, 0), stability_limit(&study, &samples, sample));
                assert!(taken <= limit * (1.0 + 1e-8), "{name}, sample {sample}: {taken} s, stable up to {limit} s");
                assert!(step.is_none_or(|step| taken <= step * (1.0 + 1e-8)), "{name}, sample {sample}: {taken} s");
                assert_eq!(own.results.digests[0], found.results.digests[sample]);
                // No more often than it must: the bound on frequencies is not off by more than some factor.
                let longest = step.unwrap_or(f64::INFINITY).min(limit);
                let coarser = halved(&found, sample) == 0 || taken * 2.0 > 0.05 * longest;
                assert!(coarser, "{name}, sample {sample}: {taken} s, {longest} s");
            }
        }
    }
}

/// A road must not repeat under the vehicle, not even under the axles that stand behind the first at the start.
#[test]
fn a_road_that_repeats_is_refused_as_in_a_single_crossing() {
    let bridge = continuous(&[60.0], [PINNED; 2], &[8e10], &[7e3], &Stations::PerSpan(vec![5]), &[]).unwrap();
    let analysis = analysis_of(&bridge, 2, &Damping::Ratios(vec![0.02]), &[6.0], Recovery::ForceSummation);
    let vehicle = articulated(1.0, 1.0);
    let wheelbase = vehicle.wheelbase();
    for (ramp, behind) in [(0.0, 2.0), (5.0, 1.0)] {
        for (over, refused) in [(-0.01, false), (0.01, true)] {
            let approach = 128.0 - 60.0 - behind * wheelbase + over;
            let settings = Settings { approach, ramp, ..Settings::at_speed(20.0) };
            let own = || Some((synthesis(), SEED));
            let kinds = vec![vec![Passage::of(vehicle.clone())]];
            let study = study_of(Arc::clone(&analysis), kinds, settings.clone(), own(), None, &[Quantity::Moment]);
            let road = Arc::new(synthesis().road(SEED, 0).into());
            let single = analysis.cross(&vehicle, &Settings { road, ..settings }, StopToken::NEVER);
            assert_eq!((study.is_err(), single.is_err()), (refused, refused), "ramp {ramp}, {over}");
        }
    }
}
