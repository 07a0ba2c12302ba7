//! Flexibility: reciprocity, closed forms, elements, and the way from F* to F.

use crate::problems::{all_arrangements, arrangements, elements, pinned, points};
use crate::problems::{clamped, kishan_bridge, largest_magnitude};
use faer::Mat;
use spanwise::bridge::{Bridge, Stations, Support};
use spanwise::statics::{Action, Flexibility, Structure};

/// Closed forms and symmetry hold to rounding, relative to the largest number involved.
const ROUNDING: f64 = 1e-12;

/// The stiffness matrix of the elements is worse conditioned than the flexibility: 1e6 or so.
const ELEMENT_ROUNDING: f64 = 1e-9;

const BOTH: [Structure; 2] = [Structure::Basic, Structure::Actual];

fn largest(matrix: &Mat<f64>) -> f64 {
    (0..matrix.ncols())
        .map(|j| largest_magnitude(&matrix.col(j).iter().copied().collect::<Vec<_>>()))
        .fold(0.0, f64::max)
}

/// A beam without intermediate supports, its EI 3 MN m².
fn beam(length: f64, supports: &[Support]) -> Bridge {
    crate::problems::beam(length, supports.to_vec(), &[3e6], &[1e3], &Stations::PerSpan(vec![2]), &[]).unwrap()
}

/// Deflection at `x` under a unit force at `at`.
fn deflection(bridge: &Bridge, x: f64, at: f64) -> f64 {
    let flexibility = Flexibility::new(bridge, &[at]).unwrap();
    let mesh = flexibility.mesh();
    flexibility.deflected(Action::Force(mesh.node_at(at)), Structure::Actual).at(mesh, x)
}

#[test]
fn maxwell_reciprocity() {
    for (name, bridge) in all_arrangements() {
        let flexibility = Flexibility::new(&bridge, &points(&bridge)).unwrap();
        let nodes: Vec<usize> = (0..flexibility.mesh().nodes().len()).collect();
        for structure in BOTH {
            let f = flexibility.matrix(&nodes, &nodes, structure);
            let skew = largest(&(&f - f.transpose())) / largest(&f);
            println!("{name}, {structure:?}: {skew:.1e}");
            assert!(skew <= ROUNDING, "{name}, {structure:?}: unsymmetric by {skew:.2e}");
            assert!(nodes.iter().all(|&i| f[(i, i)] >= -ROUNDING * largest(&f)), "{name}: a negative diagonal");
        }
    }
}

#[test]
fn closed_forms() {
    let (l, ei, a) = (12.0, 3e6, 5.0);
    let b = l - a;
    let cases = [
        ("simple span", beam(l, &[pinned(0.0), pinned(l)]), a, a, a * a * b * b / (3.0 * ei * l)),
        ("cantilever from the left", beam(l, &[clamped(0.0)]), l, l, l.powi(3) / (3.0 * ei)),
        ("cantilever from the left, inside", beam(l, &[clamped(0.0)]), a, l, a * a * (3.0 * l - a) / (6.0 * ei)),
        ("cantilever from the right", beam(l, &[clamped(l)]), 0.0, a, b * b * (3.0 * l - b) / (6.0 * ei)),
        ("clamped-clamped", beam(l, &[clamped(0.0), clamped(l)]), a, a, (a * b / l).powi(3) / (3.0 * ei)),
        ("clamped-pinned", beam(l, &[clamped(0.0), pinned(l)]), 0.5 * l, 0.5 * l, 7.0 * l.powi(3) / (768.0 * ei)),
        ("overhang", beam(l, &[pinned(0.0), pinned(b)]), l, l, a * a * l / (3.0 * ei)),
    ];
    for (name, bridge, x, at, exact) in cases {
        for ours in [deflection(&bridge, x, at), deflection(&bridge, at, x)] {
            assert!((ours / exact - 1.0).abs() <= ROUNDING, "{name}: {ours:e}, exactly {exact:e}");
        }
    }
}

/// Columns of F* and F between stations: one cubic per panel is exact wherever it is read.
#[test]
fn deflected_shapes_against_elements() {
    for (name, bridge) in all_arrangements() {
        let flexibility = Flexibility::new(&bridge, &[]).unwrap();
        let mesh = flexibility.mesh();
        for structure in BOTH {
            let (mut worst, mut scale) = ([0.0_f64; 2], [0.0_f64; 2]);
            for station in bridge.stations() {
                let line = flexibility.deflected(Action::Force(mesh.node_at(station.at)), structure);
                let solved = elements::solve(&bridge, structure, &[(station.at, 1.0)], &points(&bridge));
                for x in points(&bridge) {
                    let panel = mesh.panel_at(x).unwrap();
                    let ours = [line.at(mesh, x), line.slope(mesh, panel, mesh.fraction(panel, x))];
                    for (i, exact) in [solved.deflection(x), solved.slope(x)].into_iter().enumerate() {
                        worst[i] = worst[i].max((ours[i] - exact).abs());
                        scale[i] = scale[i].max(exact.abs());
                    }
                }
            }
            println!("{name}, {structure:?}: {:.1e} {:.1e}", worst[0] / scale[0], worst[1] / scale[1]);
            for i in 0..2 {
                assert!(worst[i] <= ELEMENT_ROUNDING * scale[i], "{name}, {structure:?}: {worst:?} of {scale:?}");
            }
        }
    }
}

/// F = F* − F*_R K^R F*_Rᵀ: [KTN73] Eqs. 13 and 14 as one matrix, K^R the inverse of F*_RR.
#[test]
fn redundant_supports_take_the_basic_bridge_to_the_actual_one() {
    for (name, bridge) in arrangements() {
        let flexibility = Flexibility::new(&bridge, &[]).unwrap();
        let redundants: Vec<usize> = flexibility.redundants().iter().map(|r| r.node()).collect();
        assert_eq!(redundants.len(), bridge.supports().len().saturating_sub(2), "{name}");
        let all: Vec<usize> = (0..flexibility.mesh().nodes().len()).collect();
        let [basic, actual] = BOTH.map(|structure| flexibility.matrix(&all, &all, structure));
        let to_supports = flexibility.matrix(&all, &redundants, Structure::Basic);
        let at_supports = flexibility.matrix(&redundants, &redundants, Structure::Basic);
        let stiffness = flexibility.redundant_stiffness();
        let n = redundants.len();
        let identity = &stiffness * &at_supports;
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            assert!((identity[(i, j)] - f64::from(i == j)).abs() <= ELEMENT_ROUNDING, "{name}: K^R F*_RR");
        }
        let again = &basic - &to_supports * &stiffness * to_supports.transpose();
        let apart = largest(&(&again - &actual)) / largest(&basic);
        assert!(apart <= ROUNDING, "{name}: apart by {apart:.2e}");
        assert_eq!(n == 0, largest(&(&basic - &actual)) == 0.0, "{name}: no redundants, no difference");
    }
}

#[test]
fn reference_stations_are_masses_and_redundants() {
    let bridge = kishan_bridge();
    let flexibility = Flexibility::new(&bridge, &[]).unwrap();
    let spans: Vec<f64> = flexibility
        .reference_nodes(&bridge)
        .into_iter()
        .map(|node| flexibility.mesh().nodes()[node] / (0.5 * bridge.length()))
        .collect();
    let expected = [1.0 / 6.0, 0.5, 5.0 / 6.0, 1.0, 7.0 / 6.0, 1.5, 11.0 / 6.0];
    assert_eq!(spans.len(), expected.len());
    for (x, expected) in spans.iter().zip(expected) {
        assert!((x - expected).abs() <= ROUNDING, "{spans:?}");
    }
}
