//! Extremes against histories, and the impact factors made of them.

use crate::problems::*;
use spanwise::bridge::Bridge;
use spanwise::crossing::{Envelope, Extreme, Extremes, Ratio, Sense};
use spanwise::passage::{Settings, Tail};
use spanwise::recovery::Recovery::{self, ForceSummation, ForceSummationByRates, Superposition};
use spanwise::statics::Quantity;
use spanwise::stop_token::StopToken;

/// Two evaluations of one response, relative to its largest value.
const ROUNDING: f64 = 1e-12;

/// By how much a peak may stand above both instants around it, a millisecond apart, relative to the largest value.
const BETWEEN_STEPS: f64 = 2e-2;

fn crossed(bridge: &Bridge, recovery: Recovery) -> Run {
    // Every millisecond; stable in four modes of every bridge here.
    let settings = Settings { step: Some(1e-3), approach: 0.5, tail: Tail::Fixed(0.1), ..Settings::at_speed(23.1) };
    run(bridge, &kishan_vehicle(), &settings, 4, &undamped(), recovery, &[]).unwrap()
}

/// Every extreme is a value of the history, with its time, place and partner, or one found between two instants as an
/// axle passed; and no instant of the history exceeds it.
#[test]
fn extremes_bound_the_histories() {
    for (name, bridge) in arrangements() {
        for recovery in [ForceSummation, ForceSummationByRates, Superposition] {
            let run = crossed(&bridge, recovery);
            let [dynamic, at_rest] = &run.responded;
            let scales = run.scales();
            for (values, partners, extremes) in
                [(dynamic, at_rest, &run.outcome.envelope.dynamic), (at_rest, dynamic, &run.outcome.envelope.at_rest)]
            {
                for (r, &scale) in scales.iter().enumerate() {
                    let column: Vec<f64> = values.iter().skip(r).step_by(run.analysis.rows.len()).copied().collect();
                    let partner: Vec<f64> = partners.iter().skip(r).step_by(run.analysis.rows.len()).copied().collect();
                    for (extreme, sign) in [(&extremes.max[r], 1.0), (&extremes.min[r], -1.0)] {
                        let beyond = column.iter().map(|v| sign * v - sign * extreme.value).fold(f64::MIN, f64::max);
                        assert!(beyond <= ROUNDING * scale, "{name}, response {r}: exceeded by {beyond:e}");
                        check_place(&run, r, extreme, &column, &partner, scale, name);
                    }
                }
            }
        }
    }
}

fn check_place(run: &Run, r: usize, extreme: &Extreme, column: &[f64], partner: &[f64], scale: f64, name: &str) {
    let history = &run.outcome.history;
    let after = history.time.partition_point(|&t| t < extreme.time - 1e-9 * history.step);
    assert!(after < history.len(), "{name}, response {r}: at {} s", extreme.time);
    // Just as an axle leaves a free end, the partner may be that before or after its drop.
    let certain = ends_are_held(&run.bridge) || extreme.partner == partner[after];
    if (history.time[after] - extreme.time).abs() <= 1e-9 * history.step && column[after] == extreme.value && certain {
        // An axle may come to a stop as the step ends, and then the interpolated instant counts.
        let apart = (extreme.position - history.positions[after * history.axles]).abs();
        assert!(apart <= 1e-12 * run.bridge.length(), "{name}, response {r}: {apart:e} m apart");
        let apart = (extreme.partner - partner[after]).abs();
        assert!(apart <= ROUNDING * scale, "{name}, response {r}: partner {apart:e} off");
        return;
    }
    // Between instants: some axle is on a section or an end, and the value between, but for what it jumps.
    let behind = [0.0, kishan_vehicle().wheelbase()].map(|behind| extreme.position - behind);
    let near = 1e-9 * run.bridge.length();
    let mut stops = run.analysis.sections.iter().copied().chain([0.0, run.bridge.length()]);
    assert!(stops.any(|x| behind.iter().any(|b| (b - x).abs() <= near)), "{name}, {r}: {extreme:?}");
    // Shears jump there, and the reaction of an end as an axle enters or leaves; over a free end everything does.
    let continuous = [Quantity::Deflection, Quantity::Moment].map(|quantity| run.analysis.responses.range(quantity));
    if continuous.iter().any(|range| range.contains(&r)) && ends_are_held(&run.bridge) {
        let (a, b) = (column[after.saturating_sub(1)], column[after]);
        let outside = (extreme.value - a.max(b)).max(a.min(b) - extreme.value);
        assert!(outside <= BETWEEN_STEPS * scale, "{name}, response {r}: {extreme:?} between {a:e} and {b:e}");
    }
}

fn ends_are_held(bridge: &Bridge) -> bool {
    let supports = bridge.supports();
    supports[0].at == 0.0 && supports[supports.len() - 1].at == bridge.length()
}

/// The histories of one quantity are its columns of the histories of all, to the bit.
#[test]
fn histories_of_one_quantity() {
    let run = crossed(&arrangements().swap_remove(4).1, ForceSummation);
    for quantity in Quantity::USUAL {
        let range = run.analysis.responses.range(quantity);
        let found = run.analysis.histories(&run.outcome, quantity, StopToken::NEVER).unwrap();
        for (found, all) in found.iter().zip(&run.responded) {
            let expected: Vec<f64> =
                all.chunks_exact(run.analysis.rows.len()).flat_map(|row| row[range.clone()].to_vec()).collect();
            assert_eq!(found, &expected, "{quantity:?}");
        }
    }
}

/// Static extremes where the answer is known: one load on a simple span.
#[test]
fn a_single_load_on_a_simple_span() {
    let bridge = arrangements().swap_remove(1).1;
    let length = bridge.length();
    let (mass, gravity) = (1e4, 10.0);
    let load = mass * gravity;
    let settings = Settings { gravity, step: Some(7e-4), ..Settings::at_speed(23.1) };
    let sections = [0.0, 0.37 * length, length];
    let run = run(&bridge, &sprung_mass(mass, 1.0), &settings, 2, &undamped(), ForceSummation, &sections).unwrap();
    let at_rest = |quantity| run.analysis.envelope_of(&run.outcome, quantity, StopToken::NEVER).unwrap().at_rest;
    let moment = at_rest(Quantity::Moment).max[1];
    assert!((moment.value / (load * 0.37 * 0.63 * length) - 1.0).abs() <= ROUNDING, "{moment:?}");
    assert!((moment.position - 0.37 * length).abs() <= ROUNDING * length, "{moment:?}");
    let shear = at_rest(Quantity::ShearRight);
    for (section, largest, smallest) in [(0, 1.0, 0.0), (1, 0.63, -0.37), (2, 0.0, -1.0)] {
        assert!((shear.max[section].value - largest * load).abs() <= ROUNDING * load, "{:?}", shear.max[section]);
        assert!((shear.min[section].value - smallest * load).abs() <= ROUNDING * load, "{:?}", shear.min[section]);
    }
    for reaction in at_rest(Quantity::Reaction).max {
        assert!((reaction.value / load - 1.0).abs() <= ROUNDING, "{reaction:?}");
    }
}

#[test]
fn axle_loads() {
    let run = crossed(&kishan_bridge(), ForceSummation);
    let history = &run.outcome.history;
    for k in 0..2 {
        // In the tail they do not count.
        let there = 2 * (history.last_on + 1);
        let loads: Vec<f64> = history.loads[..there].iter().skip(k).step_by(2).copied().collect();
        let (max, min) = (run.outcome.axle_loads.dynamic.max[k], run.outcome.axle_loads.dynamic.min[k]);
        assert_eq!(max.value, loads.iter().copied().fold(f64::MIN, f64::max));
        assert_eq!(min.value, loads.iter().copied().fold(f64::MAX, f64::min));
        let row = history.time.iter().position(|&t| t == max.time).unwrap();
        assert_eq!((loads[row], history.positions[2 * row]), (max.value, max.position));
        assert_eq!(max.partner, history.static_loads[k]);
        assert_eq!(run.outcome.axle_loads.at_rest.max[k].value, history.static_loads[k]);
    }
}

fn extreme(value: f64, partner: f64) -> Extreme {
    Extreme { value, time: 0.0, position: 0.0, partner }
}

/// An envelope of one response: dynamic largest and smallest, static largest and smallest, each with its partner.
fn envelope(values: &[[(f64, f64); 4]]) -> Envelope {
    let list = |i: usize| values.iter().map(|v| extreme(v[i].0, v[i].1)).collect();
    Envelope { dynamic: Extremes { max: list(0), min: list(1) }, at_rest: Extremes { max: list(2), min: list(3) } }
}

#[test]
fn impact_factors() {
    let envelope = envelope(&[
        [(12.0, 8.0), (-3.0, -1.5), (10.0, 11.0), (-2.0, -2.5)],
        // A static largest and smallest of hardly anything.
        [(0.5, 0.1), (-9.0, -6.0), (0.2, 0.3), (-8.0, -8.8)],
    ]);
    let factors = |sense, ratio| envelope.impact_factors(sense, ratio, 0.05);
    let same = |ours: Vec<f64>, expected: [f64; 2]| {
        assert_eq!(ours.len(), 2);
        for (ours, expected) in ours.into_iter().zip(expected) {
            assert!(ours == expected || (ours.is_nan() && expected.is_nan()), "{ours}, expected {expected}");
        }
    };
    let masked = f64::NAN;
    same(factors(Sense::Positive, Ratio::Extremes), [12.0 / 10.0, masked]);
    same(factors(Sense::Positive, Ratio::AtDynamicExtreme), [12.0 / 8.0, masked]);
    same(factors(Sense::Positive, Ratio::AtStaticExtreme), [11.0 / 10.0, masked]);
    same(factors(Sense::Negative, Ratio::Extremes), [3.0 / 2.0, 9.0 / 8.0]);
    same(factors(Sense::Negative, Ratio::AtDynamicExtreme), [3.0 / 1.5, 9.0 / 6.0]);
    same(factors(Sense::Negative, Ratio::AtStaticExtreme), [2.5 / 2.0, 8.8 / 8.0]);
    same(factors(Sense::Either, Ratio::Extremes), [12.0 / 10.0, 9.0 / 8.0]);
    // Without a mask the small value counts.
    same(envelope.impact_factors(Sense::Positive, Ratio::Extremes, 0.0), [12.0 / 10.0, 0.5 / 0.2]);
}

/// Shears on both sides of a section count together.
#[test]
fn merged_extremes() {
    let one = envelope(&[[(1.0, 0.5), (-4.0, -1.0), (2.0, 1.5), (-1.0, -2.0)]]);
    let two = envelope(&[[(3.0, 2.5), (-2.0, -3.0), (2.5, 3.5), (-0.5, -4.0)]]);
    let both = one.merged(&two);
    assert_eq!((both.dynamic.max[0], both.dynamic.min[0]), (extreme(3.0, 2.5), extreme(-4.0, -1.0)));
    assert_eq!((both.at_rest.max[0], both.at_rest.min[0]), (extreme(2.5, 3.5), extreme(-1.0, -2.0)));
    assert_eq!(both.dynamic.by_magnitude(), [extreme(-4.0, -1.0)]);
}
