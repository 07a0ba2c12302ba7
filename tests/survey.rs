//! Windows of the influence lines: no load has a larger or smaller influence than they say, and not much.

use crate::problems::ensemble::analysis_of;
use crate::problems::{general_arrangements, spread};
use spanwise::damping::Damping;
use spanwise::lane::Lane;
use spanwise::recovery::{Recovery, WIDTH};
use spanwise::stop_token::StopToken;
use spanwise::survey::Windows;

/// A bridge has so many cells; a window may reach one beyond on either side.
const CELL: f64 = 1.0 / 256.0;

#[test]
fn windows_hold_every_influence_between_two_places() {
    let mut touched = 0;
    for (name, bridge) in general_arrangements() {
        for recovery in [Recovery::ForceSummation, Recovery::Superposition] {
            let analysis = analysis_of(&bridge, 4, &Damping::Ratios(vec![0.01]), &[], recovery);
            let (rows, length) = (&analysis.rows, bridge.length());
            let windows = Windows::new(rows, false, StopToken::NEVER).unwrap();
            for case in 0..60 {
                // Short stretches and long ones, some over an end of the bridge.
                let from = length * (1.2 * spread(case) - 0.1);
                let to = from + length * [0.002, 0.02, 0.3][case % 3] * (spread(case + 500) - 0.5);
                let Some(reached) = windows.reached(from, to) else {
                    assert!(rows.place(from).is_none() && rows.place(to).is_none(), "{name}: {from} to {to} m");
                    continue;
                };
                let influence =
                    |response: usize, x: f64| rows.place(x).map_or(0.0, |place| rows.influence_of(response, place));
                for response in 0..rows.len() {
                    let [least, most] = windows.of(response / WIDTH, &reached).map(|side| side.get(response % WIDTH));
                    let at = |i: usize| from + (to - from) * i as f64 / 40.0;
                    for i in 0..=40 {
                        let own = influence(response, at(i));
                        assert!(least <= own && own <= most, "{name}, {response}: {own} at {} m", at(i));
                    }
                    let beyond = |i: usize| {
                        let (low, high) = (from.min(to) - 1.01 * CELL * length, from.max(to) + 1.01 * CELL * length);
                        influence(response, low + (high - low) * f64::from(i as u32) / 400.0)
                    };
                    let nearby = (0..=400).map(beyond).fold([f64::MAX, f64::MIN], |[l, m], g| [l.min(g), m.max(g)]);
                    let size = (0..=200).map(|i| influence(response, length * f64::from(i) / 200.0).abs());
                    let slack = 0.03 * size.fold(0.0, f64::max) + 1e-9;
                    assert!(least >= nearby[0] - slack && most <= nearby[1] + slack, "{name}, {response}: loose");
                    touched += 1;
                }
            }
        }
    }
    assert!(touched > 10_000, "{touched}");
}
