//! Samples that fail: marked with place, step and cause, and nothing to their neighbours.

use crate::problems::ensemble::study_of;
use crate::problems::ensemble::*;
use crate::problems::kishan_vehicle;
use crate::problems::vehicles::{half_car, leaf};
use spanwise::ensemble::{Factors, Failure, Parameter, Progress, Results, Run, Samples, Study, Workers};
use spanwise::error::Error;
use spanwise::lane::Isa;
use spanwise::passage::{Passage, Settings, Tail};
use spanwise::recovery::Recovery;
use spanwise::vehicle::Vehicle;

const COUNT: usize = 41;

/// Places that are to fail: at the ends, in the same lanes and neighbouring ones, and not in every block of samples.
const BAD: [usize; 5] = [0, 9, 10, 17, 40];

fn study(vehicle: Vehicle, tail: f64) -> Study {
    let settings = Settings { approach: 6.0, tail: Tail::Fixed(tail), ..Settings::at_speed(1.0) };
    let kinds = vec![vec![Passage::of(vehicle)]];
    let analysis = kishan_analysis(9, Recovery::ForceSummation);
    study_of(analysis, kinds, settings, Some((synthesis(), SEED)), Some(0.1), &ALL).unwrap()
}

/// Speeds all their own, and a factor that is `bad` where samples are to fail and `good` elsewhere.
fn samples(parameter: Parameter, width: usize, good: f64, bad: f64) -> Samples {
    let values = (0..COUNT * width).map(|i| if BAD.contains(&(i / width)) { bad } else { good });
    let factors = vec![Factors { parameter, width, values: values.collect() }];
    let speeds = (0..COUNT).map(|i| 18.0 + 17.0 * crate::problems::spread(i)).collect();
    Samples { factors, speeds, ..Samples::at_speed(11, COUNT, 1.0) }
}

/// Runs samples of which some fail, in every way; the others must not feel it.
fn check(study: &Study, bad: &Samples, good: &Samples) -> Vec<Failure> {
    let untouched = run(study, good, Isa::Baseline, 1).results;
    assert!(untouched.failures.is_empty(), "{:?}", untouched.failures);
    let reference = run(study, bad, Isa::Baseline, 1).results;
    let failed: Vec<usize> = reference.failures.iter().map(|failure| failure.sample).collect();
    assert_eq!(failed, BAD);
    for isa in Isa::present() {
        for (threads, chunk) in [(1, 32), (2, 7), (2, 1)] {
            let Run { results, .. } = run_in_chunks(study, bad, isa, threads, chunk);
            assert_eq!(results.hash(), reference.hash());
            assert_eq!(results.failures, reference.failures, "{isa:?}, chunks of {chunk}");
            for sample in 0..COUNT {
                let (numbers, instants) = row(&results, sample);
                if BAD.contains(&sample) {
                    assert!(numbers.iter().all(|v| v.is_nan()) && instants.iter().all(|&i| i == 0), "sample {sample}");
                } else {
                    assert_eq!(results.digests[sample], untouched.digests[sample], "sample {sample}");
                    assert!(is_finite(&results, sample), "sample {sample}");
                }
            }
        }
        // Alone it fails in the same step for the same cause.
        for (place, &sample) in BAD.iter().enumerate() {
            let own = run(study, &some(bad, sample..sample + 1), isa, 1).results;
            let [failure] = &own.failures[..] else { panic!("sample {sample} does not fail alone") };
            let expected = &reference.failures[place];
            assert_eq!((failure.step, &failure.cause), (expected.step, &expected.cause), "sample {sample}");
        }
    }
    reference.failures
}

fn is_finite(results: &Results, sample: usize) -> bool {
    row(results, sample).0.iter().all(|v| v.is_finite())
}

/// A leaf spring that is stiffened without rubbing more would give out energy: there is no such vehicle.
#[test]
fn a_vehicle_that_cannot_be() {
    // 8 kN within 1.9 mm beside 1e6 N/m and less.
    let study = study(half_car([700.0, 1100.0], 1.0, 0.0, leaf(8e3, 1.9e-3)), 0.1);
    let of = |bad: f64| samples(Parameter::SuspensionStiffness, 2, 1.0, bad);
    for failure in check(&study, &of(6.0), &of(1.0)) {
        assert_eq!(failure.step, None);
        let message = failure.cause.to_string();
        assert!(failure.cause.is_input() && message.contains("leaf_decay"), "{message}");
    }
}

/// Where it stops being finite amid the crossing, the step is told.
#[test]
fn a_step_that_is_not_finite() {
    let study = study(Vehicle::moving_masses(&[500.0], &[0.0]).unwrap(), 0.3);
    let of = |bad: f64| samples(Parameter::BodyMass, 1, 1.0, bad);
    let advance = study.path((0, 0)).advance;
    for failure in check(&study, &of(1e304), &of(1.0)) {
        let Error::NotFinite { time, position, .. } = failure.cause else { panic!("{:?}", failure.cause) };
        let step = failure.step.unwrap();
        let speed = 18.0 + 17.0 * crate::problems::spread(failure.sample);
        println!("sample {}: step {step}, {time} s, {position} m", failure.sample);
        assert!((time - step as f64 * advance / speed).abs() <= 1e-12, "{time} s");
        assert!((position - (step.saturating_sub(1) as f64 * advance - 6.0)).abs() <= 1e-12, "{position} m");
    }
}

/// Heavy masses that ride side by side on a light bridge accelerate each other.
#[test]
fn forces_that_do_not_settle() {
    let masses = Vehicle::moving_masses(&[500.0; 4], &[0.0, -0.01, -0.02, -0.03]).unwrap();
    let study = study(masses, 0.0);
    let of = |bad: f64| samples(Parameter::BodyMass, 4, 1.0, bad);
    for failure in check(&study, &of(1e6), &of(1.0)) {
        assert!(matches!(failure.cause, Error::NoConvergence { what: "contact forces", .. }), "{:?}", failure.cause);
        assert!(failure.step.is_some());
    }
}

/// On a road that nothing stands.
#[test]
fn what_overflows_is_marked() {
    let settings = Settings { approach: 6.0, ..Settings::at_speed(SPEED) };
    for shares in [true, false] {
        let passage = Passage { lane: 0, entry: if shares { 0.0 } else { 0.25 }, ..Passage::of(kishan_vehicle()) };
        let analysis = kishan_analysis(9, Recovery::ForceSummation);
        let own = Some((roads(1e306), SEED));
        let advance = shares.then_some(0.1);
        let study = study_of(analysis, vec![vec![passage]], settings.clone(), own, advance, &ALL).unwrap();
        assert_eq!(study.shares, shares);
        let samples = Samples::at_speed(0, 19, SPEED);
        for isa in Isa::present() {
            let results = run(&study, &samples, isa, 2).results;
            // Marked, or whole.
            let failed = |sample: usize| results.failures.iter().any(|failure| failure.sample == sample);
            for sample in 0..19 {
                let (numbers, _) = row(&results, sample);
                let whole = is_finite(&results, sample);
                assert!(if failed(sample) { numbers.iter().all(|v| v.is_nan()) } else { whole }, "sample {sample}");
            }
            // Where the road falls away at first, a wheel may stay off it for good, and all stays finite.
            assert!(results.failures.len() > if shares { 4 } else { 0 }, "{}", results.failures.len());
        }
    }
}

/// A sum of squares that overflows is no coefficient of zero.
#[test]
fn loads_whose_squares_overflow() {
    let study = study(Vehicle::moving_masses(&[500.0], &[0.0]).unwrap(), 0.0);
    let of = |bad: f64| samples(Parameter::BodyMass, 1, 1.0, bad);
    check(&study, &of(1e155), &of(1.0));
}

/// Those that are crossings of their own tell the step too.
#[test]
fn crossings_one_by_one_tell_the_step() {
    let masses = Vehicle::moving_masses(&[500.0; 4], &[0.0, -0.01, -0.02, -0.03]).unwrap();
    let passage = Passage { entry: 0.25, ..Passage::of(masses) };
    let settings = Settings { approach: 6.0, ..Settings::at_speed(1.0) };
    let analysis = kishan_analysis(9, Recovery::ForceSummation);
    let study = study_of(analysis, vec![vec![passage]], settings, None, None, &ALL).unwrap();
    assert!(!study.shares);
    let samples = samples(Parameter::BodyMass, 4, 1.0, 1e6);
    let results = run(&study, &samples, Isa::Baseline, 2).results;
    assert_eq!(results.failures.iter().map(|failure| failure.sample).collect::<Vec<_>>(), BAD);
    for failure in results.failures {
        let Error::NoConvergence { step, time, .. } = failure.cause else { panic!("{:?}", failure.cause) };
        assert_eq!(failure.step, Some(step));
        // After the entry, in steps of milliseconds.
        assert!(time > 0.25 && (1e-5..1e-2).contains(&(time / step as f64)), "{time} s, step {step}");
    }
}

/// A sample that would take too many steps is marked on both paths, and the others are as they are without it.
#[test]
fn samples_that_would_take_too_long() {
    for shares in [true, false] {
        let passage = Passage { entry: if shares { 0.0 } else { 0.25 }, ..Passage::of(kishan_vehicle()) };
        let settings = Settings { approach: 6.0, ..Settings::at_speed(1.0) };
        let analysis = kishan_analysis(9, Recovery::ForceSummation);
        let advance = shares.then_some(0.1);
        let study = study_of(analysis, vec![vec![passage]], settings, None, advance, &ALL).unwrap();
        assert_eq!(study.shares, shares);
        let with = |bad: f64| {
            let speeds = (0..COUNT).map(|i| if BAD.contains(&i) { bad } else { 20.0 }).collect();
            Samples { speeds, ..Samples::at_speed(11, COUNT, 1.0) }
        };
        let (marked, whole) = (run(&study, &with(1e-5), Isa::Baseline, 2), run(&study, &with(20.0), Isa::Baseline, 1));
        assert!(whole.results.failures.is_empty(), "{:?}", whole.results.failures);
        let failed: Vec<usize> = marked.results.failures.iter().map(|failure| failure.sample).collect();
        assert_eq!(failed, BAD);
        for failure in &marked.results.failures {
            let cause = failure.cause.to_string();
            assert!(failure.step.is_none() && cause.contains("speed") && cause.contains("steps"), "{cause}");
        }
        for isa in Isa::present() {
            let again = run_in_chunks(&study, &with(1e-5), isa, 2, 7).results;
            assert_eq!((again.hash(), &again.failures), (marked.results.hash(), &marked.results.failures));
        }
        for sample in 0..COUNT {
            let (numbers, instants) = row(&marked.results, sample);
            if BAD.contains(&sample) {
                assert!(numbers.iter().all(|v| v.is_nan()) && instants.iter().all(|&i| i == 0), "sample {sample}");
            } else {
                assert_eq!(marked.results.digests[sample], whole.results.digests[sample], "sample {sample}");
            }
        }
    }
    // What is asked too much of all is refused.
    let study = study(kishan_vehicle(), 0.0);
    let all = Samples::at_speed(0, 3, 1e-5);
    let message = study.run(&all, &Workers::new(None).unwrap(), &Progress::default()).unwrap_err().to_string();
    assert!(message.contains("speed") && message.contains("steps"), "{message}");
}

/// What a single crossing refuses, a study does.
#[test]
fn studies_that_cannot_be() {
    let refused = |vehicle: Vehicle, approach: f64, advance: f64, entry: f64| {
        let settings = Settings { approach, ramp: 0.0, ..Settings::at_speed(SPEED) };
        let passage = Passage { entry, ..Passage::of(vehicle) };
        let own = (entry > 0.0).then(|| (synthesis(), SEED));
        let advance = (advance > 0.0).then_some(advance);
        let analysis = kishan_analysis(9, Recovery::ForceSummation);
        study_of(analysis, vec![vec![passage]], settings, own, advance, &ALL)
            .and_then(|study| study.run(&Samples::at_speed(0, 1, SPEED), &Workers::new(None)?, &Progress::default()))
            .map(|_| ())
            .unwrap_err()
            .to_string()
    };
    let train = |axles: usize, apart: f64| {
        let positions: Vec<f64> = (0..axles).map(|k| -apart * k as f64).collect();
        Vehicle::force_train(&vec![1e3; axles], &positions).unwrap()
    };
    // An axle would pass the whole bridge in a step.
    let message = refused(train(2, 100.0), 1.0, 60.0, 0.0);
    assert!(message.contains("advance") && message.contains("length of the bridge"), "{message}");
    let message = refused(train(501, 0.1), 1.0, 0.5, 0.0);
    assert!(message.contains("501 axles"), "{message}");
    // Two million steps of five hundred axles; forces would be one.
    let positions: Vec<f64> = (0..500).map(|k| -0.1 * f64::from(k)).collect();
    let masses = Vehicle::moving_masses(&[1e3; 500], &positions).unwrap();
    let message = refused(masses, 1.0, 5e-5, 0.0);
    assert!(message.contains("GB of memory"), "{message}");
    // The way before the entry counts: of 128 m the road has only what is left.
    let message = refused(kishan_vehicle(), 30.0, 0.0, 3.0);
    assert!(message.contains("it repeats"), "{message}");
}
