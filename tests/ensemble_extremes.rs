//! Extremes of an ensemble: of second order in the step, found in the tail too, and nobody's but the sample's own.

use crate::problems::continuous;
use crate::problems::ensemble::study_of;
use std::sync::Arc;

use crate::problems::ensemble::*;
use crate::problems::vehicles::half_car;
use crate::problems::{PINNED, kishan_vehicle, observed_order, sprung_mass};
use spanwise::bridge::Stations;
use spanwise::damping::Damping;
use spanwise::ensemble::{Column, Samples, Study, decoded};
use spanwise::extremes::Instant;
use spanwise::lane::Isa;
use spanwise::passage::{Passage, Settings, Tail};
use spanwise::recovery::Recovery;
use spanwise::road::Road;
use spanwise::statics::Quantity;
use spanwise::vehicle::Friction;

/// Newmark's method with γ = ½ is of second order; an observed order may differ from it by this much.
const ORDER: f64 = 2.0;
const ORDER_MARGIN: f64 = 0.1;

const SPAN: f64 = 24.0;

/// Simple span of 24 m, seen where no step of a whole fraction of the span ends.
fn analysis(sections: usize, damping: f64) -> Arc<spanwise::crossing::Analysis> {
    let stations = Stations::PerSpan(vec![11]);
    let bridge = continuous(&[SPAN], [PINNED; 2], &[4e9], &[8e3], &stations, &[]).unwrap();
    let sections: Vec<f64> = (1..=sections).map(|i| SPAN * i as f64 / (sections + 1) as f64 + 0.0137).collect();
    analysis_of(&bridge, 3, &Damping::Ratios(vec![damping]), &sections, Recovery::ForceSummation)
}

/// Waves of 6 m and 5 mm that grow from nothing.
fn waves() -> Road {
    crate::problems::mechanics::profile([-40.0, 80.0], |x| {
        let t = ((x + 10.0) / 10.0).clamp(0.0, 1.0);
        let grown = t * t * t * (10.0 + t * (6.0 * t - 15.0));
        0.005 * grown * (std::f64::consts::TAU * x / 6.0).sin()
    })
}

/// Extremes of a quantity in steps of so many millimetres, largest then smallest, speed after speed.
fn extremes(quantity: Quantity, advance: f64) -> Vec<f64> {
    let vehicle = half_car([700.0, 1100.0], 1.0, 0.0, Friction::NONE);
    let settings = Settings { approach: 12.0, road: Arc::new(waves()), beta: 1.0 / 6.0, ..Settings::at_speed(1.0) };
    let kinds = vec![vec![Passage::of(vehicle)]];
    let study = study_of(analysis(41, 0.01), kinds, settings, None, Some(advance), &[quantity]).unwrap();
    let speeds: Vec<f64> = vec![13.0, 17.0, 21.0, 26.0, 29.0, 33.0];
    let samples = Samples { count: speeds.len(), speeds, ..Samples::at_speed(0, 1, 1.0) };
    let found = run(&study, &samples, Isa::chosen().unwrap(), 2);
    assert!(found.marches == [(0, 0)], "halved on its own");
    (0..samples.count).flat_map(|sample| column(&found.results, sample, Column::Responses).to_vec()).collect()
}

/// The instants at which an axle stands on a section are among them: between steps, a moment there has a peak with a
/// kink, and a shear jumps.
#[test]
fn extremes_are_of_second_order() {
    let path = 12.0 + SPAN + 4.75;
    for quantity in [Quantity::Moment, Quantity::ShearLeft, Quantity::ShearRight, Quantity::Deflection] {
        // Steps of 51 mm and less.
        let advances: Vec<f64> = (0..4).map(|halvings| path / f64::from(800 << halvings)).collect();
        let fine = extremes(quantity, path / f64::from(800 << 8));
        let largest = fine.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let error = |advance: f64| {
            let squares = extremes(quantity, advance).iter().zip(&fine).map(|(a, b)| ((a - b) / largest).powi(2)).sum();
            f64::sqrt(squares) / f64::sqrt(fine.len() as f64)
        };
        let errors: Vec<f64> = advances.iter().map(|&advance| error(advance)).collect();
        let order = observed_order(&advances, &errors);
        println!("{quantity:?}: order {order:.3}, errors {errors:?}");
        assert!((order - ORDER).abs() <= ORDER_MARGIN, "{quantity:?}: order {order}, {errors:?}");
    }
}

/// A tail in seconds is so for every speed: slow lanes and fast ones side by side end at different steps, some amid one.
fn tail(tail: f64, recovery: Recovery) -> Study {
    let settings = Settings { approach: 5.0, tail: Tail::Fixed(tail), ..Settings::at_speed(1.0) };
    let kinds = vec![vec![Passage::of(kishan_vehicle())]];
    study_of(kishan_analysis(9, recovery), kinds, settings, Some((synthesis(), SEED)), Some(0.05), &ALL).unwrap()
}

#[test]
fn no_extreme_in_the_tail_is_that_of_a_neighbour() {
    for recovery in [Recovery::ForceSummation, Recovery::ForceSummationByRates, Recovery::Superposition] {
        for seconds in [1e-13, 1e-6, 1e-3, 0.11, 0.9] {
            let study = tail(seconds, recovery);
            let speeds = vec![12.0, 70.0, 31.0, 12.5, 45.0, 69.0, 22.86, 15.0, 50.0, 13.0, 33.3];
            let samples = Samples { count: speeds.len(), speeds, ..Samples::at_speed(0, 1, 1.0) };
            for isa in Isa::present() {
                let together = run(&study, &samples, isa, 1).results;
                for sample in 0..samples.count {
                    let own = some(&samples, sample..sample + 1);
                    let alone = run(&study, &own, Isa::Baseline, 1).results;
                    assert_eq!(
                        alone.digests[0], together.digests[sample],
                        "{recovery:?}, {seconds} s, sample {sample}"
                    );
                }
            }
            if seconds >= 1e-3 {
                check_alone(
                    &study,
                    &samples,
                    &run(&study, &samples, Isa::Baseline, 1),
                    &format!("{recovery:?} {seconds} s"),
                );
            }
        }
    }
}

/// A light bridge just in step with a fast mass swings on farther than under it.
#[test]
fn peaks_of_the_tail_are_found() {
    let vehicle = sprung_mass(2e3, 1e6);
    let settings = Settings { tail: Tail::Fixed(1.0), ..Settings::at_speed(1.0) };
    let study = study_of(analysis(5, 0.0), vec![vec![Passage::of(vehicle)]], settings, None, Some(0.05), &ALL).unwrap();
    let speeds = vec![60.0, 80.0, 100.0, 120.0];
    let samples = Samples { count: speeds.len(), speeds, ..Samples::at_speed(0, 1, 1.0) };
    let found = run(&study, &samples, Isa::chosen().unwrap(), 1);
    let format = found.results.format;
    let mut late = 0;
    for sample in 0..samples.count {
        let (_, instants) = row(&found.results, sample);
        let steps = study.path(found.marches[found.results.marches[sample] as usize]).steps;
        late += instants[..2 * format.responses]
            .iter()
            .filter(|&&i| matches!(decoded(i), Instant::Step(s) if s > steps))
            .count();
    }
    println!("{late} extremes in the tails");
    assert!(late >= 20, "{late}");
    check_alone(&study, &samples, &found, "tail");
    // Without a tail they are not seen, and what is seen with it is never less.
    let without = Settings { tail: Tail::Fixed(0.0), ..study.settings.clone() };
    let kinds = vec![study.kinds[0].passages.clone()];
    let short = study_of(Arc::clone(&study.analysis), kinds, without, None, Some(0.05), &ALL).unwrap();
    let shorter = run(&short, &samples, Isa::chosen().unwrap(), 1);
    let mut exceeded = 0;
    for sample in 0..samples.count {
        let [long, short] = [&found, &shorter].map(|run| column(&run.results, sample, Column::Responses));
        for (i, (long, short)) in long.iter().zip(short).enumerate() {
            let further = if i < format.responses { long - short } else { short - long };
            assert!(further >= 0.0, "sample {sample}, {i}: {long}, {short}");
            exceeded += usize::from(further > 0.0);
        }
    }
    assert!(exceeded >= 20, "{exceeded}");
}

/// A result never is minus zero, which would show in its bits.
#[test]
fn zeros_have_no_sign() {
    let mut zeros = 0;
    for (study, samples) in [(mixed(), mixed_samples(0, 20)), (headline(), Samples::at_speed(0, 20, SPEED))] {
        let found = run(&study, &samples, Isa::chosen().unwrap(), 1);
        for (i, value) in found.results.numbers.iter().enumerate() {
            assert!(*value != 0.0 || value.is_sign_positive(), "number {i}");
            zeros += usize::from(*value == 0.0);
        }
    }
    assert!(zeros > 0, "none to look at");
}
