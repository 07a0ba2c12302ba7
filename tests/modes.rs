//! Modes: continuous beams as the limit of lumped ones, independent checks, repeated frequencies, signs, lines.

use crate::problems::answers::uniform_bridges;
use crate::problems::beam;
use crate::problems::*;
use spanwise::bridge::{Along, Bridge, Layout, Stations};
use spanwise::error::Error;
use spanwise::modes::Modes;
use spanwise::statics::{Flexibility, Structure};

/// Demanded of every mode: residual, orthogonality, relative to one.
const ROUNDING: f64 = 1e-10;

/// Lumped frequencies converge with the square of the station spacing or better; less what the coarsest mesh is short
/// of the asymptote.
const LEAST_ORDER: f64 = 1.95;

/// Half a unit of the last digit of the published βL.
const LAST_DIGIT: f64 = 5e-7;

/// Shapes of modes whose frequencies differ by a part in 10⁹ are as certain as rounding divided by that.
const NEARLY_REPEATED: f64 = 1e-5;

fn modes(bridge: &Bridge, count: usize) -> Modes {
    Modes::new(bridge, &Flexibility::new(bridge, &[]).unwrap(), count).unwrap()
}

fn shape(modes: &Modes, mode: usize) -> Vec<f64> {
    modes.shapes.col(mode).iter().copied().collect()
}

#[test]
fn lumped_frequencies_converge_to_those_of_continuous_beams() {
    for uniform in uniform_bridges() {
        let counts = [4, 8, 16, 32, 64];
        let found: Vec<Vec<f64>> = counts
            .iter()
            .map(|&n| modes(&uniform.bridge(n), uniform.beta_l.len()).omega)
            .map(|omega| omega.into_iter().map(|w| uniform.beta_l_of(w)).collect())
            .collect();
        for (mode, &exact) in uniform.beta_l.iter().enumerate() {
            let errors: Vec<f64> = found.iter().map(|beta_l| (beta_l[mode] - exact).abs()).collect();
            // Refinements whose error the published digits can still resolve.
            let seen = errors.iter().take_while(|&&e| e > 5.0 * LAST_DIGIT).count();
            assert!(seen >= 2, "{}, mode {}: {errors:?} too small to see an order", uniform.name, mode + 1);
            let spacing: Vec<f64> = counts[..seen].iter().map(|&n| 1.0 / n as f64).collect();
            let order = observed_order(&spacing, &errors[..seen]);
            let finest = errors[errors.len() - 1];
            println!("{}, mode {}: order {order:.2}, at last {finest:.1e} off", uniform.name, mode + 1);
            assert!(order >= LEAST_ORDER, "{}, mode {}: order {order:.3}", uniform.name, mode + 1);
            // The error constant is largest for free ends: (βL)² / (24 n²) or so.
            assert!(finest <= 1e-3, "{}, mode {}: βL {finest:.1e} off", uniform.name, mode + 1);
        }
    }
}

/// Largest residual of F M φ = φ/ω², relative to the lowest mode's, and largest error of ΦᵀMΦ = I.
fn residual_and_skew(bridge: &Bridge, modes: &Modes) -> [f64; 2] {
    let stations = bridge.stations();
    let flexibility = Flexibility::new(bridge, &[]).unwrap();
    let nodes: Vec<usize> = stations.iter().map(|s| flexibility.mesh().node_at(s.at)).collect();
    let f = flexibility.matrix(&nodes, &nodes, Structure::Actual);
    let n = stations.len();
    let mut worst = [0.0_f64; 2];
    for i in 0..modes.len() {
        let phi = shape(modes, i);
        let residual = |row: usize| {
            let deflected: f64 = (0..n).map(|j| f[(row, j)] * stations[j].mass * phi[j]).sum();
            stations[row].mass.sqrt() * (deflected - phi[row] / modes.omega[i].powi(2))
        };
        let size = (0..n).map(|row| residual(row).powi(2)).sum::<f64>().sqrt();
        worst[0] = worst[0].max(size * modes.omega[0].powi(2));
        for j in 0..modes.len() {
            let psi = shape(modes, j);
            let product: f64 = (0..n).map(|m| phi[m] * stations[m].mass * psi[m]).sum();
            worst[1] = worst[1].max((product - f64::from(i == j)).abs());
        }
    }
    worst
}

#[test]
fn residual_and_orthogonality() {
    for (name, bridge) in all_arrangements() {
        let all = modes(&bridge, bridge.stations().len());
        assert!(all.omega.windows(2).all(|w| w[0] <= w[1]), "{name}: {:?}", all.omega);
        let [residual, skew] = residual_and_skew(&bridge, &all);
        println!("{name}: residual {residual:.1e}, orthogonality {skew:.1e}");
        assert!(residual <= ROUNDING && skew <= ROUNDING, "{name}: {residual:.2e}, {skew:.2e}");
        // The lowest few are the same whether or not the others are asked for.
        let few = modes(&bridge, 2);
        assert_eq!((&few.omega, few.shapes), (&all.omega[..2].to_vec(), all.truncated(2).shapes), "{name}");
    }
}

/// A mode is the shape that its own inertia forces deflect the bridge into: here by beam elements, at every point.
#[test]
fn mode_lines_against_elements() {
    for (name, bridge) in all_arrangements() {
        let flexibility = Flexibility::new(&bridge, &[]).unwrap();
        let mesh = flexibility.mesh();
        let modes = Modes::new(&bridge, &flexibility, bridge.stations().len().min(5)).unwrap();
        let lines = modes.lines(&bridge, &flexibility);
        assert_eq!(lines.len(), modes.len());
        for (i, line) in lines.iter().enumerate() {
            let phi = shape(&modes, i);
            let omega2 = modes.omega[i].powi(2);
            let forces: Vec<(f64, f64)> =
                bridge.stations().iter().zip(&phi).map(|(s, phi)| (s.at, omega2 * s.mass * phi)).collect();
            let solved = elements::solve(&bridge, Structure::Actual, &forces, &points(&bridge));
            let scale = largest_magnitude(&phi);
            for x in points(&bridge) {
                let (ours, exact) = (line.at(mesh, x), solved.deflection(x));
                // The elements round more than the flexibility does.
                assert!((ours - exact).abs() <= 10.0 * ROUNDING * scale, "{name}, mode {}: {ours}, {exact}", i + 1);
            }
            for (station, phi) in bridge.stations().iter().zip(&phi) {
                assert!((line.at(mesh, station.at) - phi).abs() <= ROUNDING * scale, "{name}, mode {}", i + 1);
            }
            for support in bridge.supports().iter().filter(|s| s.fixity.vertical().is_infinite()) {
                assert!(line.at(mesh, support.at).abs() <= ROUNDING * scale, "{name}, mode {} at a support", i + 1);
            }
        }
    }
}

#[test]
fn the_largest_component_is_positive() {
    for (name, bridge) in all_arrangements() {
        let all = modes(&bridge, bridge.stations().len());
        for i in 0..all.len() {
            let phi = shape(&all, i);
            let largest = largest_magnitude(&phi);
            let first = phi.iter().find(|p| p.abs() >= largest * (1.0 - 1e-6)).unwrap();
            assert!(*first > 0.0, "{name}, mode {}: {phi:?}", i + 1);
        }
    }
}

#[test]
fn as_many_modes_as_masses_that_move() {
    let bridge = kishan_bridge();
    let flexibility = Flexibility::new(&bridge, &[]).unwrap();
    assert_eq!(Modes::new(&bridge, &flexibility, 6).unwrap().len(), 6);
    for count in [0, 7] {
        match Modes::new(&bridge, &flexibility, count).map(|modes| modes.len()) {
            Err(Error::Input { key, value, allowed }) => {
                assert_eq!((key.as_str(), value), ("modes", count.to_string()));
                assert!(allowed.contains("1 to 6"), "{allowed}");
            }
            other => panic!("{other:?}"),
        }
    }
}

/// Two overhangs of 8 m on a middle span of `rigidity` so stiff that they hardly feel each other; EI of the right one
/// by `factor`.
fn two_cantilevers(rigidity: f64, factor: f64) -> Bridge {
    let supports = vec![pinned(8.0), pinned(18.0)];
    let stations = Stations::PerSpan(vec![3, 0, 3]);
    beam(26.0, supports, &[1e9, rigidity, factor * 1e9], &[6e3, 0.0, 6e3], &stations, &[]).unwrap()
}

/// A repeated frequency leaves its shapes open; the rule settles them: here each lives in one overhang.
#[test]
fn repeated_frequencies_give_reproducible_modes() {
    let supports = vec![clamped(0.0)];
    let cantilever = beam(8.0, supports, &[1e9], &[6e3], &Stations::PerSpan(vec![3]), &[]).unwrap();
    let alone = modes(&cantilever, 3);
    // Coupled by a part in 10¹³, the overhangs left to themselves would swing together or against each other.
    let bridge = two_cantilevers(1e22, 1.0);
    let pairs = modes(&bridge, 6);
    let [residual, skew] = residual_and_skew(&bridge, &pairs);
    assert!(residual <= ROUNDING && skew <= ROUNDING, "{residual:.2e}, {skew:.2e}");
    for i in 0..3 {
        let exact = shape(&alone, i);
        let scale = largest_magnitude(&exact);
        let mirror: Vec<f64> = exact.iter().rev().copied().collect();
        let nothing = [0.0; 3];
        for (mode, expected) in [(2 * i, [&mirror[..], &nothing]), (2 * i + 1, [&nothing, &exact[..]])] {
            assert!((pairs.omega[mode] / alone.omega[i] - 1.0).abs() <= ROUNDING, "mode {}", mode + 1);
            let apart = largest_difference(&shape(&pairs, mode), &expected.concat());
            println!("mode {}: {:.1e}", mode + 1, apart / scale);
            assert!(apart <= ROUNDING * scale, "mode {}: {:?}, {expected:?}", mode + 1, shape(&pairs, mode));
        }
    }
    // Rounding in the data does not turn them.
    let again = modes(&two_cantilevers(1e22, 1.0 + 4.0 * f64::EPSILON), 6);
    for mode in 0..6 {
        let apart = largest_difference(&shape(&pairs, mode), &shape(&again, mode));
        assert!(apart <= ROUNDING * largest_magnitude(&shape(&pairs, mode)), "mode {}", mode + 1);
    }
}

#[test]
fn nearly_repeated_frequencies() {
    for gap in [1e-6, 1e-9, 3e-12, 1e-12, 3e-13, 1e-14] {
        let bridge = two_cantilevers(1e30, 1.0 + gap);
        let pairs = modes(&bridge, 6);
        let [residual, skew] = residual_and_skew(&bridge, &pairs);
        println!("gap {gap:.0e}: residual {residual:.1e}, orthogonality {skew:.1e}");
        assert!(residual <= ROUNDING && skew <= ROUNDING, "gap {gap:e}: {residual:.2e}, {skew:.2e}");
        if gap >= 1e-9 {
            // Resolved: the softer overhang, on the left, has the lower frequency of every pair.
            for mode in 0..6 {
                let phi = shape(&pairs, mode);
                let other = if mode % 2 == 0 { &phi[3..] } else { &phi[..3] };
                let rest = largest_magnitude(other) / largest_magnitude(&phi);
                assert!(rest <= NEARLY_REPEATED, "gap {gap:e}, mode {}: {phi:?}", mode + 1);
            }
        }
    }
}

/// No share of the mass reaches across a hinge, wherever it stands: else the frequencies would jump with the number of
/// shares as the mass of one of them changed sides.
#[test]
fn shares_end_at_hinges() {
    let lowest = |count: usize| {
        let layout = Layout {
            length: 95.0,
            supports: [0.0, 30.0, 65.0, 95.0].map(pinned).to_vec(),
            hinges: vec![45.0],
            flexural_rigidity: Along::PerSpan(vec![2e10]),
            mass: Along::PerSpan(vec![9e3]),
            stations: Stations::PerSpan(vec![count]),
            point_masses: vec![],
        };
        let bridge = Bridge::from_layout(layout).unwrap();
        Modes::new(&bridge, &Flexibility::new(&bridge, &[]).unwrap(), 1).unwrap().omega[0]
    };
    let exact = lowest(160);
    // Second order, without jumps: the constant is that of six shares, with a fifth to spare.
    for count in 6..=13 {
        let error = lowest(count) / exact - 1.0;
        println!("{count} shares a span: {:+.3} %", 100.0 * error);
        assert!(error > 0.0 && error < 0.58 / (count * count) as f64, "{count} shares a span: {error:e}");
    }
}
