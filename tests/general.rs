//! Springs, hinges and EI that varies against closed forms and limits; mechanisms; settlements.

use crate::problems::*;
use spanwise::bridge::{Along, Bridge, Layout, Stations, Support, TAPER_PIECES};
use spanwise::error::Error;
use spanwise::modes::Modes;
use spanwise::statics::{Action, Flexibility, Settled, Structure, influence};

/// A few roundings of a closed form.
const ROUNDING: f64 = 1e-11;

/// Elements are the worse conditioned route.
const ELEMENT_ROUNDING: f64 = 1e-8;

const EI: f64 = 3e9;

fn layout(length: f64, supports: Vec<Support>, hinges: &[f64]) -> Layout {
    Layout {
        length,
        supports,
        hinges: hinges.to_vec(),
        flexural_rigidity: Along::PerSpan(vec![EI]),
        mass: Along::PerSpan(vec![5e3]),
        stations: Stations::PerSpan(vec![4]),
        point_masses: Vec::new(),
    }
}

fn bridge(length: f64, supports: Vec<Support>, hinges: &[f64]) -> Bridge {
    Bridge::from_layout(layout(length, supports, hinges)).unwrap()
}

/// Deflection at x under a unit force at `at`.
fn deflection(bridge: &Bridge, x: f64, at: f64) -> f64 {
    let flexibility = Flexibility::new(bridge, &[at]).unwrap();
    let line = flexibility.deflected(Action::Force(flexibility.mesh().node_at(at)), Structure::Actual);
    line.at(flexibility.mesh(), x)
}

fn assert_near(ours: f64, exact: f64, scale: f64, what: &str) {
    assert!((ours - exact).abs() <= ROUNDING * scale, "{what}: {ours:e}, exactly {exact:e}");
}

#[test]
fn springs_by_closed_forms() {
    let (l, a) = (20.0, 7.0);
    let [ka, kb] = [4e7, 9e7];
    let sprung = bridge(l, vec![elastic(0.0, ka, 0.0), elastic(l, kb, 0.0)], &[]);
    let simple = bridge(l, vec![pinned(0.0), pinned(l)], &[]);
    // The springs sink under their reactions, and the beam follows.
    let exact = deflection(&simple, a, a) + ((l - a) / l).powi(2) / ka + (a / l).powi(2) / kb;
    assert_near(deflection(&sprung, a, a), exact, exact, "simple beam on springs");

    // A cantilever whose root gives way.
    let (k, c) = (6e7, 8e8);
    let exact = l.powi(3) / (3.0 * EI) + 1.0 / k + l * l / c;
    assert_near(deflection(&bridge(l, vec![elastic(0.0, k, c)], &[]), l, l), exact, exact, "cantilever");

    // A prop under the middle of a simple beam takes P / (1 + 48 EI / k L³).
    let propped = bridge(l, vec![pinned(0.0), elastic(0.5 * l, k, 0.0), pinned(l)], &[]);
    let exact = 1.0 / (48.0 * EI / l.powi(3) + k);
    assert_near(deflection(&propped, 0.5 * l, 0.5 * l), exact, exact, "propped");
    let flexibility = Flexibility::new(&propped, &[]).unwrap();
    let restraint = flexibility.redundants()[0];
    let reaction = influence::reaction(&flexibility, restraint, Structure::Actual);
    assert_near(reaction.at(flexibility.mesh(), 0.5 * l), k * exact, 1.0, "its reaction is k w");
}

/// Stiff springs are rigid, slack ones are none, with a difference that falls in proportion.
#[test]
fn limits_of_springs() {
    let rigid = |spring: Support| bridge(30.0, vec![pinned(0.0), spring, pinned(30.0)], &[]);
    let end = |spring: Support| bridge(30.0, vec![spring, pinned(12.0), pinned(30.0)], &[]);
    let read = |bridge: Bridge| {
        let modes = Modes::new(&bridge, &Flexibility::new(&bridge, &[]).unwrap(), 2).unwrap();
        [deflection(&bridge, 5.0, 8.0), modes.omega[0], modes.omega[1]]
    };
    type Case = (&'static str, Box<dyn Fn(f64) -> [f64; 3]>, [f64; 3]);
    let inf = f64::INFINITY;
    let cases: Vec<Case> = vec![
        ("stiff", Box::new(move |e| read(rigid(elastic(12.0, 1e7 / e, 0.0)))), read(rigid(pinned(12.0)))),
        ("free to turn", Box::new(move |e| read(end(elastic(0.0, inf, 1e8 * e)))), read(end(pinned(0.0)))),
        ("built in", Box::new(move |e| read(end(elastic(0.0, inf, 1e9 / e)))), read(end(clamped(0.0)))),
        ("built-in pier", Box::new(move |e| read(rigid(elastic(12.0, inf, 1e9 / e)))), read(rigid(clamped(12.0)))),
    ];
    for (name, with, limit) in cases {
        let sizes = [1e-2, 1e-3, 1e-4];
        let errors: Vec<[f64; 3]> = sizes.iter().map(|&e| with(e)).collect();
        for i in 0..3 {
            let errors: Vec<f64> = errors.iter().map(|e| (e[i] / limit[i] - 1.0).abs()).collect();
            let order = observed_order(&sizes, &errors);
            println!("{name}: {errors:?}, order {order:.3}");
            assert!((order - 1.0).abs() < 0.1 && errors[2] < 1e-2, "{name}: {errors:?}");
        }
        let exact: [f64; 3] = with(0.0);
        for i in 0..3 {
            assert_near(exact[i], limit[i], limit[i].abs(), name);
        }
    }
}

/// A Gerber beam of 20, 25 and 20 m with hinges at 26 and 40 m, by hand: the middle stretch hangs on two overhangs.
#[test]
fn gerber_beam_by_hand() {
    let gerber = bridge(65.0, vec![pinned(0.0), pinned(20.0), pinned(45.0), pinned(65.0)], &[26.0, 40.0]);
    let sections = [10.0, 20.0, 26.0, 30.0, 33.0, 40.0, 45.0];
    let flexibility = Flexibility::new(&gerber, &sections).unwrap();
    let mesh = flexibility.mesh();
    let hang = |x: f64| (40.0 - x) / 14.0; // share of the left hinge of a load between the hinges
    for x in [3.0, 10.0, 15.0, 20.0, 23.0, 26.0, 28.0, 33.0, 37.5, 40.0, 42.0, 50.0, 65.0] {
        // Load on the left hinge, or moment at 20 m from what stands on the overhang itself.
        let at_20 = match x {
            x if x <= 20.0 => 0.0,
            x if x <= 26.0 => -(x - 20.0),
            x if x <= 40.0 => -6.0 * hang(x),
            _ => 0.0,
        };
        let at_45 = match x {
            x if x <= 26.0 => 0.0,
            x if x <= 40.0 => -5.0 * (1.0 - hang(x)),
            x if x <= 45.0 => -(45.0 - x),
            _ => 0.0,
        };
        let simple = |x: f64, s: f64, from: f64, to: f64| match () {
            () if x <= from || x >= to => 0.0,
            () if x <= s => (x - from) * (to - s) / (to - from),
            () => (to - x) * (s - from) / (to - from),
        };
        let exact = [
            0.5 * at_20 + simple(x, 10.0, 0.0, 20.0),
            at_20,
            0.0,
            simple(x, 30.0, 26.0, 40.0),
            simple(x, 33.0, 26.0, 40.0),
            0.0,
            at_45,
        ];
        for (s, exact) in sections.iter().zip(exact) {
            let line = influence::moment(&flexibility, mesh.node_at(*s), Structure::Actual);
            assert_near(line.at(mesh, x), exact, 65.0, &format!("moment at {s} m for a load at {x} m"));
        }
        // The reaction at 0 lifts as the overhang is loaded.
        let first = influence::reaction(&flexibility, flexibility.restraints(Structure::Actual)[0], Structure::Actual);
        let exact = at_20 / 20.0 + if x <= 20.0 { 1.0 - x / 20.0 } else { 0.0 };
        assert_near(first.at(mesh, x), exact, 1.0, "reaction");
    }
    // A load at the left hinge deflects it as it does the tip of an overhang of 6 m.
    assert_near(deflection(&gerber, 26.0, 26.0), 36.0 * 26.0 / (3.0 * EI), 1e-6, "tip of the overhang");
}

#[test]
fn no_moment_at_hinges_whatever_the_action() {
    for (name, bridge) in general_arrangements().into_iter().filter(|(_, b)| !b.hinges().is_empty()) {
        let flexibility = Flexibility::new(&bridge, &[]).unwrap();
        let nodes = 0..flexibility.mesh().nodes().len();
        let mut worst = 0.0_f64;
        for node in nodes.clone() {
            let line = flexibility.deflected(Action::Force(node), Structure::Actual);
            for &hinge in flexibility.hinges() {
                worst = worst.max(flexibility.bending_moment(&line, hinge).abs() / bridge.length());
            }
        }
        println!("{name}: {worst:.1e}");
        assert!(worst <= ROUNDING, "{name}: {worst:.2e}");
        assert_eq!(flexibility.hinges().len(), bridge.hinges().len());
    }
}

#[test]
fn mechanisms_are_refused_by_name() {
    let refused = |supports: Vec<Support>, hinges: &[f64]| {
        let bridge = bridge(40.0, supports, hinges);
        match Flexibility::new(&bridge, &[]).map(|_| ()) {
            Err(error @ Error::Mechanism { hinge, at }) => {
                assert!(error.is_input() && error.to_string().contains("mechanism"), "{error}");
                Some((hinge, at))
            }
            Ok(()) => None,
            other => panic!("{other:?}"),
        }
    };
    let two = || vec![pinned(0.0), pinned(20.0), pinned(40.0)];
    assert_eq!(refused(vec![pinned(0.0), pinned(40.0)], &[15.0]), Some((0, 15.0)));
    assert_eq!(refused(two(), &[15.0]), None);
    assert_eq!(refused(two(), &[20.0]), None);
    assert_eq!(refused(two(), &[5.0, 15.0]), Some((1, 15.0)));
    assert_eq!(refused(two(), &[15.0, 25.0]), Some((1, 25.0)));
    assert_eq!(refused(vec![clamped(0.0), pinned(20.0)], &[30.0]), Some((0, 30.0)));
    assert_eq!(refused(vec![clamped(0.0), pinned(20.0), clamped(40.0)], &[10.0, 30.0]), None);
    assert_eq!(refused(vec![clamped(0.0), pinned(20.0), clamped(40.0)], &[10.0, 20.0, 30.0]), None);
    assert_eq!(refused(vec![clamped(0.0), pinned(20.0), clamped(40.0)], &[5.0, 10.0, 15.0]), Some((2, 15.0)));
    // Three hinges between two supports, however many others there are.
    let many: Vec<Support> = (0..9).map(|i| pinned(5.0 * f64::from(i))).collect();
    assert_eq!(refused(many.clone(), &[21.0, 22.5, 24.0]), Some((2, 24.0)));
    assert_eq!(refused(many, &[20.001, 20.01]), None, "near each other, but no mechanism");
    // A weak spring is a spring.
    assert_eq!(refused(vec![elastic(0.0, f64::INFINITY, 1.0), pinned(40.0)], &[15.0]), None);
}

/// Deflection of the tip of a cantilever whose EI falls in proportion from the root, under a unit force there:
/// ∫ (L − x)² / EI(x) dx.
fn tapered_exactly(length: f64, root: f64, tip: f64) -> f64 {
    // With s = EI(x), L − x = L (s − tip) / (root − tip): L³/d³ ∫ (s − tip)²/s ds from tip to root.
    let d = root - tip;
    let integral = 0.5 * (root * root - tip * tip) - 2.0 * tip * d + tip * tip * (root / tip).ln();
    length.powi(3) / d.powi(3) * integral
}

#[test]
fn a_taper_errs_with_the_square_of_its_pieces() {
    let (length, root, tip) = (12.0, 4e9, 1e9);
    let tapered = |pieces: usize| {
        let flexural_rigidity = Along::Between { at: vec![0.0, length], values: vec![root, tip], pieces };
        Bridge::from_layout(Layout { flexural_rigidity, ..layout(length, vec![clamped(0.0)], &[]) }).unwrap()
    };
    let exact = tapered_exactly(length, root, tip);
    let counts = [2, 4, 8, 16, 32];
    let errors: Vec<f64> =
        counts.iter().map(|&n| (deflection(&tapered(n), length, length) / exact - 1.0).abs()).collect();
    let sizes: Vec<f64> = counts.iter().map(|&n| 1.0 / n as f64).collect();
    let order = observed_order(&sizes, &errors);
    println!("tapered cantilever: {errors:?}, order {order:.3}");
    assert!((order - 2.0).abs() < 0.1, "order {order}");
    let default = deflection(&tapered(TAPER_PIECES), length, length) / exact - 1.0;
    println!("{TAPER_PIECES} pieces: {default:.2e}");
    // What the documentation says of the default: 0.03 %, too soft.
    assert!((2.5e-4..3.5e-4).contains(&default), "{default:e}");
}

/// Linear mass is integrated, and EI given between breakpoints is that of the elements.
#[test]
fn mass_between_breakpoints_is_conserved() {
    let mass = Along::Between { at: vec![0.0, 8.0, 30.0], values: vec![4e3, 9e3, 1e3], pieces: 1 };
    for stations in [Stations::PerSpan(vec![3, 5]), Stations::At(vec![2.0, 11.0, 17.0, 29.0])] {
        let supports = vec![pinned(0.0), pinned(12.0), pinned(30.0)];
        let bridge = Bridge::from_layout(Layout { mass: mass.clone(), stations, ..layout(30.0, supports, &[]) });
        let total: f64 = bridge.unwrap().stations().iter().map(|s| s.mass).sum();
        assert_near(total, 8.0 * 6.5e3 + 22.0 * 5e3, 1e5, "total mass");
    }
}

/// The middle support of two equal spans settles by Δ: M_B = 3EIΔ/L², sagging; on a spring, of the ground less the
/// spring's own yielding.
#[test]
fn settlement_of_a_middle_support() {
    let (l, delta) = (15.0, 0.02);
    let two = |middle: Support| bridge(2.0 * l, vec![pinned(0.0), middle, pinned(2.0 * l)], &[]);
    let settled = Settled::new(&two(pinned(l)), &[0.0, delta, 0.0], &[0.0, 0.5 * l, l]).unwrap();
    let moment = 3.0 * EI * delta / (l * l);
    assert_near(settled.moment[2], moment, moment, "M_B");
    assert_near(settled.moment[1], 0.5 * moment, moment, "half-way");
    assert_near(settled.moment[0], 0.0, moment, "end");
    assert_near(settled.deflection[2], delta, delta, "deflection");
    for (ours, share) in settled.reactions.iter().zip([1.0, -2.0, 1.0]) {
        assert_near(*ours, share * moment / l, moment / l, "reaction");
    }
    let k = 6.0 * EI / l.powi(3); // as stiff as the beam is there
    let settled = Settled::new(&two(elastic(l, k, 0.0)), &[0.0, delta, 0.0], &[l]).unwrap();
    assert_near(settled.deflection[0], 0.5 * delta, delta, "on a spring");
    assert_near(settled.reactions[1], -0.5 * k * delta, k * delta, "on a spring");
}

#[test]
fn settlements_against_elements() {
    for (name, bridge) in all_arrangements() {
        let n = bridge.supports().len();
        let settlements: Vec<f64> = (0..n).map(|i| 0.01 * (spread(i + 1) - 0.3)).collect();
        let sections = points(&bridge);
        let ours = Settled::new(&bridge, &settlements, &sections).unwrap();
        let exact = elements::settle(&bridge, &settlements, &sections);
        let compare = |ours: &[f64], exact: &[f64], floor: f64, what: &str| {
            let scale = largest_magnitude(exact).max(floor);
            let apart = largest_difference(ours, exact) / scale;
            assert!(apart <= ELEMENT_ROUNDING, "{name}, {what}: {apart:.1e}");
            apart
        };
        let deflections: Vec<f64> = sections.iter().map(|&x| exact.deflection(x)).collect();
        let moments: Vec<f64> = sections.iter().map(|&x| exact.moment(x)).collect();
        let shears: Vec<f64> = sections.iter().flat_map(|&x| exact.shears(x)).collect();
        // Where nothing resists, moments and forces are rounding of these.
        let (force, couple) = (12.0 * EI * 0.01 / 10_f64.powi(3), 6.0 * EI * 0.01 / 100.0);
        let found = [
            compare(&ours.deflection, &deflections, 0.01, "deflection"),
            compare(&ours.moment, &moments, couple, "moment"),
            compare(ours.shear.as_flattened(), &shears, force, "shear"),
            compare(&ours.reactions, &exact.reactions, force, "reactions"),
            compare(&ours.clamp_moments, &exact.clamp_moments, couple, "clamp moments"),
        ];
        println!("{name}: {found:?}");
        let sum: f64 = ours.reactions.iter().sum();
        assert!(sum.abs() <= ELEMENT_ROUNDING * force.max(largest_magnitude(&ours.reactions)), "{name}: {sum:e}");
    }
}
