//! The bridge: lumping, supports, and what is refused.

use crate::problems::*;
use crate::problems::{beam, continuous};
use spanwise::bridge::{Bridge, Fixity, MAX_STATIONS, Stations, Support};
use spanwise::error::Error;

/// Sums and positions to rounding, relative to the whole.
const ROUNDING: f64 = 1e-12;

fn total(bridge: &Bridge) -> f64 {
    bridge.stations().iter().map(|s| s.mass).sum()
}

fn assert_near(ours: f64, expected: f64, what: &str) {
    assert!((ours - expected).abs() <= ROUNDING * expected.abs().max(1.0), "{what}: {ours}, expected {expected}");
}

/// A bridge of 10 m and 20 m, with the given stations.
fn two_spans(mass: &[f64], stations: &Stations, point_masses: &[(f64, f64)]) -> Result<Bridge, Error> {
    continuous(&[10.0, 20.0], [PINNED; 2], &[1e9], mass, stations, point_masses)
}

fn key(result: Result<Bridge, Error>) -> String {
    match result {
        Err(error @ Error::Input { .. }) => {
            assert!(error.is_input());
            let Error::Input { key, .. } = error else { unreachable!() };
            key
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn equal_shares_carry_the_mass_in_their_middles() {
    let bridge = two_spans(&[300.0, 500.0], &Stations::PerSpan(vec![2, 4]), &[]).unwrap();
    let expected = [(2.5, 1500.0), (7.5, 1500.0), (12.5, 2500.0), (17.5, 2500.0), (22.5, 2500.0), (27.5, 2500.0)];
    assert_eq!(bridge.stations().len(), expected.len());
    for (station, (at, mass)) in bridge.stations().iter().zip(expected) {
        assert_near(station.at, at, "position");
        assert_near(station.mass, mass, "mass");
    }
    assert_near(total(&bridge), 300.0 * 10.0 + 500.0 * 20.0, "total mass");
}

#[test]
fn stations_of_the_user_carry_the_mass_up_to_half_way_within_their_span() {
    let at = vec![4.0, 8.0, 13.0, 20.0];
    let bridge = two_spans(&[300.0, 500.0], &Stations::At(at), &[]).unwrap();
    let expected = [(4.0, 6.0 * 300.0), (8.0, 4.0 * 300.0), (13.0, 6.5 * 500.0), (20.0, 13.5 * 500.0)];
    assert_eq!(bridge.stations().len(), expected.len());
    for (station, (at, mass)) in bridge.stations().iter().zip(expected) {
        assert_near(station.at, at, "position");
        assert_near(station.mass, mass, "mass");
    }
    assert_near(total(&bridge), 300.0 * 10.0 + 500.0 * 20.0, "total mass");
}

/// What stands over a support does not move: its share is the supports' affair.
#[test]
fn masses_over_supports_take_no_part() {
    let at = vec![0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0];
    let bridge = two_spans(&[300.0], &Stations::At(at), &[(10.0, 700.0)]).unwrap();
    let kept: Vec<f64> = bridge.stations().iter().map(|s| s.at).collect();
    assert_eq!(kept, [5.0, 15.0, 20.0, 25.0]);
    assert_near(total(&bridge), 300.0 * 20.0, "moving mass");
    // On a free end it does move.
    let stations = Stations::At(vec![4.0, 8.0]);
    let cantilever = beam(8.0, vec![clamped(0.0)], &[1e9], &[300.0], &stations, &[]).unwrap();
    assert_near(cantilever.stations()[1].mass, 300.0 * 2.0, "tip");
    assert_near(total(&cantilever), 300.0 * 8.0, "total mass");
}

#[test]
fn point_masses_join_a_station_or_become_one() {
    let bridge = two_spans(&[300.0], &Stations::PerSpan(vec![1, 2]), &[(5.0, 70.0), (12.0, 80.0)]).unwrap();
    let expected = [(5.0, 3070.0), (12.0, 80.0), (15.0, 3000.0), (25.0, 3000.0)];
    assert_eq!(bridge.stations().len(), expected.len());
    for (station, (at, mass)) in bridge.stations().iter().zip(expected) {
        assert_near(station.at, at, "position");
        assert_near(station.mass, mass, "mass");
    }
}

#[test]
fn mass_is_conserved() {
    for (name, bridge) in arrangements() {
        let again = mirrored(&mirrored(&bridge));
        for (a, b) in bridge.stations().iter().zip(again.stations()) {
            assert_near(a.at, b.at, name);
            assert_near(a.mass, b.mass, name);
        }
    }
    for counts in [vec![1], vec![3], vec![7, 2]] {
        let bridge = two_spans(&[300.0, 500.0], &Stations::PerSpan(counts), &[(11.0, 90.0)]).unwrap();
        assert_near(total(&bridge), 13_090.0, "total mass");
    }
}

#[test]
fn spans_supports_and_rigidity() {
    let supports = vec![pinned(20.0), pinned(5.0)];
    let bridge = beam(26.0, supports, &[1e9, 2e9, 3e9], &[1e3], &Stations::PerSpan(vec![2]), &[]).unwrap();
    assert_eq!(bridge.supports().iter().map(|s| s.at).collect::<Vec<_>>(), [5.0, 20.0]);
    assert_eq!(bridge.span_bounds(), [0.0, 5.0, 20.0, 26.0]);
    for (x, ei) in [(0.0, 1e9), (4.9, 1e9), (5.0, 2e9), (19.9, 2e9), (20.0, 3e9), (26.0, 3e9)] {
        assert_eq!(bridge.flexural_rigidity_at(x), ei, "at {x} m");
    }
    let sections = bridge.default_sections();
    assert!(sections.windows(2).all(|w| w[1] > w[0]) && sections[0] == 0.0 && sections[sections.len() - 1] == 26.0);
    for x in bridge.span_bounds().iter().copied().chain(bridge.stations().iter().map(|s| s.at)).chain([3.5, 12.5]) {
        assert!(sections.iter().any(|s| (s - x).abs() <= ROUNDING * 26.0), "no section at {x} m");
    }
    // Supports within rounding of an end stand at the end.
    let nearly = vec![pinned(1e-10), pinned(26.0 + 1e-9)];
    let bridge = beam(26.0, nearly, &[1e9], &[1e3], &Stations::PerSpan(vec![2]), &[]).unwrap();
    assert_eq!(bridge.span_bounds(), [0.0, 26.0]);
}

#[test]
fn a_bridge_that_can_move_as_a_whole_is_refused() {
    for (supports, motion) in [(vec![], "fall"), (vec![pinned(3.0)], "rotate")] {
        match beam(10.0, supports, &[1e9], &[1e3], &Stations::PerSpan(vec![2]), &[]) {
            Err(error @ Error::Unstable { .. }) => {
                assert!(error.is_input() && error.to_string().contains(motion), "{error}");
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn refusals_name_the_argument() {
    let three = || Stations::PerSpan(vec![3]);
    let on = |supports: Vec<Support>| beam(10.0, supports, &[1e9], &[1e3], &three(), &[]);
    let ends = || vec![pinned(0.0), pinned(10.0)];
    let simple = |length: f64, ei: &[f64], mass: &[f64], stations: Stations, points: &[(f64, f64)]| {
        beam(length, ends(), ei, mass, &stations, points)
    };
    for (expected, result) in [
        ("length", simple(-1.0, &[1e9], &[1e3], three(), &[])),
        ("length", simple(f64::NAN, &[1e9], &[1e3], three(), &[])),
        ("EI", simple(10.0, &[0.0], &[1e3], three(), &[])),
        ("EI", simple(10.0, &[1e9, 1e9], &[1e3], three(), &[])),
        ("EI", simple(10.0, &[], &[1e3], three(), &[])),
        ("EI", two_spans_of(&[-1.0])),
        ("EI[1]", two_spans_of(&[1e9, f64::INFINITY])),
        ("mass", simple(10.0, &[1e9], &[-1.0], three(), &[])),
        ("mass", simple(10.0, &[1e9], &[0.0], three(), &[])),
        ("mass[0]", two_spans(&[f64::NAN, 1.0], &three(), &[])),
        ("stations_per_span", simple(10.0, &[1e9], &[1e3], Stations::PerSpan(vec![0]), &[])),
        ("stations_per_span", simple(10.0, &[1e9], &[1e3], Stations::PerSpan(vec![1, 1]), &[])),
        ("stations_per_span", simple(10.0, &[1e9], &[1e3], Stations::PerSpan(vec![MAX_STATIONS + 1]), &[])),
        ("stations", simple(10.0, &[1e9], &[1e3], Stations::At(vec![5.0; MAX_STATIONS + 1]), &[])),
        ("stations", simple(10.0, &[1e9], &[1e3], Stations::At(vec![0.0, 10.0]), &[])),
        ("stations[1]", simple(10.0, &[1e9], &[1e3], Stations::At(vec![5.0, 5.0]), &[])),
        ("stations[0]", simple(10.0, &[1e9], &[1e3], Stations::At(vec![10.1]), &[])),
        ("stations", two_spans(&[1e3], &Stations::At(vec![5.0]), &[])),
        ("point_masses[0]", simple(10.0, &[1e9], &[1e3], three(), &[(11.0, 1.0)])),
        ("point_masses[1] mass", simple(10.0, &[1e9], &[1e3], three(), &[(5.0, 1.0), (6.0, 0.0)])),
        ("supports[0]", on(vec![pinned(-0.1), pinned(10.0)])),
        ("supports[1]", on(vec![pinned(0.0), pinned(f64::NAN)])),
        ("supports[1] vertical", on(vec![pinned(0.0), elastic(5.0, 0.0, 1e6)])),
        ("supports[0] vertical", on(vec![elastic(5.0, -1e6, 1e6), pinned(10.0)])),
        ("supports[0] vertical", on(vec![elastic(5.0, f64::NAN, 0.0), pinned(10.0)])),
        ("supports[0] rotation", on(vec![elastic(5.0, 1e6, -1.0), pinned(10.0)])),
        ("supports[0] rotation", on(vec![elastic(5.0, 1e6, f64::NAN), pinned(10.0)])),
        ("supports", on(vec![pinned(0.0), pinned(10.0), pinned(0.0)])),
        ("spans", continuous(&[], [PINNED; 2], &[1e9], &[1e3], &three(), &[])),
        ("spans[1]", continuous(&[10.0, 0.0], [PINNED; 2], &[1e9], &[1e3], &three(), &[])),
    ] {
        assert_eq!(key(result), expected);
    }
}

fn two_spans_of(ei: &[f64]) -> Result<Bridge, Error> {
    continuous(&[10.0, 20.0], [PINNED; 2], ei, &[1e3], &Stations::PerSpan(vec![3]), &[])
}

#[test]
fn ends_of_a_continuous_bridge() {
    let stations = Stations::PerSpan(vec![2]);
    let of = |ends: [Option<Fixity>; 2]| {
        let bridge = continuous(&[4.0, 10.0, 5.0], ends, &[1e9], &[1e3], &stations, &[]).unwrap();
        bridge.supports().iter().map(|s| (s.at, s.fixity)).collect::<Vec<_>>()
    };
    let (p, c) = (Fixity::Pinned, Fixity::Clamped);
    assert_eq!(of([PINNED, PINNED]), [(0.0, p), (4.0, p), (14.0, p), (19.0, p)]);
    assert_eq!(of([None, None]), [(4.0, p), (14.0, p)]);
    assert_eq!(of([CLAMPED, None]), [(0.0, c), (4.0, p), (14.0, p)]);
    assert_eq!(of([None, CLAMPED]), [(4.0, p), (14.0, p), (19.0, c)]);
}
