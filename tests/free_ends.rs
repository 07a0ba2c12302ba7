//! Free ends of a bridge: an axle lands on the tip or drops off it with its whole load.

use crate::problems::continuous;
use crate::problems::*;
use spanwise::bridge::{Bridge, Stations};
use spanwise::passage::{Settings, Tail};
use spanwise::recovery::Recovery::{ForceSummation, ForceSummationByRates};
use spanwise::statics::Quantity;
use spanwise::stop_token::StopToken;

/// Two evaluations of one shear, relative to its largest value.
const ROUNDING: f64 = 1e-10;

/// Extremes over a free end converge with the step: at half a millisecond within this much, relative.
const HALF_A_MILLISECOND: f64 = 1e-2;

fn overhangs() -> Bridge {
    continuous(&[5.0, 20.0, 5.0], [None, None], &[1.94148e9], &[6037.7], &Stations::PerSpan(vec![3]), &[]).unwrap()
}

fn cantilever(mirrored: bool) -> Bridge {
    let ends = if mirrored { [None, CLAMPED] } else { [CLAMPED, None] };
    let stations = if mirrored { vec![0.0, 2.5, 5.0, 7.5] } else { vec![2.5, 5.0, 7.5, 10.0] };
    continuous(&[10.0], ends, &[1e9], &[4000.0], &Stations::At(stations), &[]).unwrap()
}

/// The moment beside the overhang as the axle leaves it: the load on the tip counts until it drops, not a mixture of it
/// and the load on the ground.
#[test]
fn extremes_settle_with_the_step() {
    for recovery in [ForceSummation, ForceSummationByRates] {
        let hogging = |step: f64| {
            let settings = Settings { step: Some(step), ..Settings::at_speed(22.86) };
            let sections = [0.0, 2.5, 15.0, 27.5, 30.0];
            let run = run(&overhangs(), &kishan_vehicle(), &settings, 3, &undamped(), recovery, &sections).unwrap();
            run.analysis.envelope_of(&run.outcome, Quantity::Moment, StopToken::NEVER).unwrap().dynamic.min[3].value
        };
        let fine = hogging(1e-5);
        for (halvings, step) in [5e-4, 2.5e-4, 1.25e-4, 6.25e-5].into_iter().enumerate() {
            let off = (hogging(step) / fine - 1.0).abs();
            println!("{recovery:?}: step {step:e} s, off by {off:.1e}");
            assert!(off <= HALF_A_MILLISECOND * 0.5_f64.powi(halvings as i32), "{recovery:?}, {step}: {off:e}");
        }
    }
}

/// No force stands between a section a millimetre inside the tip and the tip: their shears are the same, mass on the tip
/// and all.
#[test]
fn shear_at_the_tip_is_that_beside_it() {
    for mirrored in [false, true] {
        let bridge = cantilever(mirrored);
        let settings = Settings { step: Some(5e-4), tail: Tail::Fixed(0.2), ..Settings::at_speed(20.0) };
        let sections = if mirrored { [0.0, 0.001] } else { [9.999, 10.0] };
        let run = run(&bridge, &kishan_vehicle(), &settings, 4, &undamped(), ForceSummation, &sections).unwrap();
        let (history, [dynamic, _]) = (&run.outcome.history, &run.responded);
        let n = run.analysis.rows.len();
        let right = run.analysis.responses.range(Quantity::ShearRight).start;
        let left = run.analysis.responses.range(Quantity::ShearLeft).start;
        let scale = dynamic.iter().skip(right).step_by(n).fold(0.0_f64, |m, v| m.max(v.abs()));
        let mut largest = 0.0_f64;
        for (i, row) in dynamic.chunks_exact(n).enumerate() {
            let axles = &history.positions[i * history.axles..(i + 1) * history.axles];
            if axles.iter().all(|&x| x > 10.0) {
                assert!((row[right] - row[left + 1]).abs() <= ROUNDING * scale, "{} and {}", row[right], row[left + 1]);
                largest = largest.max(row[right].abs());
            }
        }
        assert!(largest > 0.01 * scale, "the mass on the tip must be felt: {largest:e} of {scale:e}");
    }
}

/// A wheel on the tip shears the section inside it by its whole load.
#[test]
fn an_axle_on_the_tip() {
    for mirrored in [false, true] {
        let settings = Settings { step: Some(1e-3), approach: 1.0, ..Settings::at_speed(20.0) };
        let bridge = cantilever(mirrored);
        let run =
            run(&bridge, &kishan_vehicle(), &settings, 4, &undamped(), ForceSummation, &[0.0, 5.0, 10.0]).unwrap();
        let load = run.outcome.history.static_loads[0];
        let shear = |quantity| run.analysis.envelope_of(&run.outcome, quantity, StopToken::NEVER).unwrap().at_rest;
        let found = if mirrored { shear(Quantity::ShearRight).min[0] } else { shear(Quantity::ShearLeft).max[2] };
        let expected = if mirrored { -load } else { load };
        assert!((found.value / expected - 1.0).abs() <= ROUNDING, "{found:?}, expected {expected:e}");
    }
}

/// However a tail relates to the step, the crossing ends; the table of a prescribed motion is long enough.
#[test]
fn tails_of_any_length() {
    let settings = Settings { step: Some(2e-3), ..Settings::at_speed(20.0) };
    let short = run(&kishan_bridge(), &kishan_vehicle(), &settings, 1, &undamped(), ForceSummation, &[9.0]).unwrap();
    let h = short.outcome.history.step;
    for steps in [1.0, 2.0, 7.0, 100.0] {
        for excess in [-1e-9, -0.999_999_9e-9, 0.0, 0.999_999_9e-9, 1e-9, 0.5] {
            let settings = Settings { tail: Tail::Fixed(h * (steps + excess)), ..settings.clone() };
            let run =
                run(&kishan_bridge(), &kishan_vehicle(), &settings, 1, &undamped(), ForceSummation, &[9.0]).unwrap();
            let history = &run.outcome.history;
            let end = short.outcome.history.time.last().unwrap() + settings.tail.seconds().unwrap();
            assert!((history.time.last().unwrap() - end).abs() <= 2e-9 * h, "{:?} for {end}", history.time.last());
        }
    }
}

/// Stations on the supports carry nothing that moves: a span may not lose its mass to them.
#[test]
fn a_span_keeps_its_mass() {
    let bridge =
        |stations: Vec<f64>| continuous(&[10.0, 30.0], [PINNED; 2], &[1e9], &[2000.0], &Stations::At(stations), &[]);
    let error = bridge(vec![5.0, 10.0, 40.0]).unwrap_err().to_string();
    assert!(error.contains("none from 10 m to 40 m") && error.contains("off its supports"), "{error}");
    assert!(bridge(vec![0.0, 5.0, 10.0, 25.0, 40.0]).is_ok());
}
