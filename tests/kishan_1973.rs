//! H. Kishan and R. W. Traill-Nash, IABSE Publications 33 (1973), §4: the illustrative example.

use crate::problems::*;
use spanwise::recovery::Recovery::{self, ForceSummation, Superposition};
use spanwise::statics::influence;
use spanwise::statics::{Flexibility, Quantity, Restraint, Structure};
use spanwise::vehicle::Suspension;

/// F* as printed [1e-6 ft/lb]: stations 1 to 3, support B, stations 4 to 6; the upper triangle.
const PRINTED_FLEXIBILITY: [&[f64]; 7] = [
    &[0.716, 1.65, 1.94, 1.90, 1.74, 1.19, 0.420],
    &[4.31, 5.34, 5.26, 4.88, 3.35, 1.19],
    &[7.24, 7.36, 6.95, 4.88, 1.74],
    &[7.66, 7.36, 5.26, 1.90],
    &[7.24, 5.34, 1.94],
    &[4.31, 1.65],
    &[0.716],
];

/// R* as printed: the reaction at A for unit loads at the same stations.
const PRINTED_REACTION: [f64; 7] = [0.917, 0.750, 0.583, 0.500, 0.417, 0.250, 0.0833];

/// Half a unit of the third digit of 1.19, the most coarsely printed entry of F*, is 4.2e-3 of it.
const FLEXIBILITY_DIGITS: f64 = 4e-3;

/// One unit of the third decimal of R*.
const REACTION_DIGITS: f64 = 1e-3;

/// Half a unit of the fourth digit of K^R = 1.305e5 lb/ft.
const STIFFNESS_DIGITS: f64 = 5e-4;

/// Half a unit of the last digit of the mass, 2522.0 slug, and of the frequencies, three decimals in Hz.
const LAST_DIGIT_OF_MASS: f64 = 0.05;
const LAST_DIGIT_OF_FREQUENCY: f64 = 5e-4;

/// Largest difference between the impact factors of two and three modes: "generally good agreement" (Fig. 6).
const AGREEMENT: f64 = 0.03;

/// Force summation and superposition with all modes differ by rounding, relative to the largest deflection.
const ROUNDING: f64 = 1e-9;

fn reference_nodes() -> (Flexibility, Vec<usize>) {
    let bridge = kishan_bridge();
    let flexibility = Flexibility::new(&bridge, &[]).unwrap();
    let nodes = flexibility.reference_nodes(&bridge);
    (flexibility, nodes)
}

fn stations() -> Vec<f64> {
    kishan_bridge().stations().iter().map(|s| s.at).collect()
}

/// The run of the paper, seen at the mass stations.
fn example(modes: usize, recovery: Recovery) -> Run {
    run(&kishan_bridge(), &kishan_vehicle(), &kishan_settings(), modes, &undamped(), recovery, &stations()).unwrap()
}

#[test]
fn basic_flexibility_matrix() {
    let (flexibility, nodes) = reference_nodes();
    let f = flexibility.matrix(&nodes, &nodes, Structure::Basic);
    for (i, row) in PRINTED_FLEXIBILITY.iter().enumerate() {
        for (j, &printed) in (i..7).zip(*row) {
            let ours = f[(i, j)] / (FOOT / POUND) * 1e6;
            println!("F*({i}, {j}) {:.1e} off", ours / printed - 1.0);
            assert!((ours / printed - 1.0).abs() <= FLEXIBILITY_DIGITS, "F*({i}, {j}) = {ours}, printed {printed}");
        }
    }
}

#[test]
fn stiffness_at_the_redundant_support() {
    let (flexibility, _) = reference_nodes();
    let k = flexibility.redundant_stiffness();
    assert_eq!((k.nrows(), k.ncols()), (1, 1));
    let ours = k[(0, 0)] / (POUND / FOOT);
    assert!((ours / 1.305e5 - 1.0).abs() <= STIFFNESS_DIGITS, "K^R = {ours} lb/ft");
    // 48 EI / L³ of the basic bridge, exactly.
    let exact = 48.0 * 4.698e9 / 120.0_f64.powi(3);
    assert!((ours / exact - 1.0).abs() <= ROUNDING, "K^R = {ours} lb/ft, 48 EI/L³ = {exact}");
}

#[test]
fn influence_coefficients_of_the_left_reaction() {
    let (flexibility, nodes) = reference_nodes();
    let line = influence::reaction(&flexibility, Restraint::Deflection(0), Structure::Basic);
    for (&node, printed) in nodes.iter().zip(PRINTED_REACTION) {
        let ours = line.at_node(node);
        assert!((ours - printed).abs() <= REACTION_DIGITS, "R* at node {node} is {ours}, printed {printed}");
    }
}

#[test]
fn masses_and_vehicle() {
    for station in kishan_bridge().stations() {
        let slugs = station.mass / SLUG;
        assert!((slugs - 2522.0).abs() <= LAST_DIGIT_OF_MASS, "{slugs} slug at {} m", station.at);
    }
    let vehicle = kishan_vehicle();
    for (suspension, expected) in [(Suspension::Locked, [3.494, 5.563]), (Suspension::Sliding, [2.097, 3.338])] {
        let ours = vehicle.frequencies(suspension);
        assert_eq!(ours.len(), 2);
        for (f, expected) in ours.iter().zip(expected) {
            assert!((f - expected).abs() <= LAST_DIGIT_OF_FREQUENCY, "{suspension:?}: {f} Hz, expected {expected}");
        }
    }
    for load in vehicle.static_loads(kishan_settings().gravity) {
        assert!((load / 142.5e3 - 1.0).abs() <= STIFFNESS_DIGITS, "axle load {load} N");
    }
}

/// "The one-mode representation even shows an impact factor of less than unity everywhere" (§4, Fig. 8).
#[test]
fn one_mode_superposed_stays_below_the_static_deflection() {
    let factors = example(1, Superposition).impact(Quantity::Deflection);
    println!("one mode superposed {factors:.4?}");
    assert!(factors.iter().all(|&f| f < 1.0), "{factors:.3?}");
    // The deflections do exceed the static ones: it is the recovery that loses them.
    let better = example(1, ForceSummation).impact(Quantity::Deflection);
    assert!(better.iter().all(|&f| f > 1.0), "{better:.3?}");
}

/// "The two- and three-mode analyses by the proposed method show generally good agreement" (§4, Fig. 6).
#[test]
fn two_and_three_modes_agree_by_force_summation() {
    let [two, three] = [2, 3].map(|modes| example(modes, ForceSummation).impact(Quantity::Deflection));
    println!("two modes {two:.4?}\nthree modes {three:.4?}");
    for ((x, two), three) in stations().iter().zip(&two).zip(&three) {
        assert!((two - three).abs() <= AGREEMENT, "at {x:.2} m: {two:.4} with two modes, {three:.4} with three");
    }
    // Superposition of one and of three modes does not agree so.
    let [one, three] = [1, 3].map(|modes| example(modes, Superposition).impact(Quantity::Deflection));
    assert!(largest_difference(&one, &three) > 3.0 * AGREEMENT, "superposition: {one:.3?} and {three:.3?}");
}

/// With all modes included Eq. 2 misses nothing at the mass stations.
#[test]
fn all_modes_leave_nothing_to_force_summation() {
    let count = kishan_bridge().stations().len();
    let [direct, summed] = [Superposition, ForceSummation].map(|recovery| {
        let run = example(count, recovery);
        run.history_of(Quantity::Deflection)
    });
    let largest = largest_magnitude(&summed);
    let apart = largest_difference(&summed, &direct);
    println!("apart by {:.1e} of the largest deflection", apart / largest);
    assert!(apart <= ROUNDING * largest, "apart by {apart:.3e} m of {largest:.3e} m");
    // One mode fewer is a difference that this would see.
    let fewer = example(count - 1, Superposition).history_of(Quantity::Deflection);
    assert!(largest_difference(&summed, &fewer) > 1e3 * ROUNDING * largest);
}

/// "The actual speed fluctuates slightly about the nominal speed" (§4).
#[test]
fn speed_fluctuates_slightly() {
    let run = example(3, ForceSummation);
    let speeds: Vec<f64> = run.outcome.history.motion.chunks_exact(9).map(|row| row[7]).collect();
    let apart = speeds.iter().map(|v| (v / speeds[0] - 1.0).abs()).fold(0.0, f64::max);
    println!("speed changes by {apart:.2e} of itself");
    assert!(apart > 1e-5 && apart < 1e-2, "speed changes by {apart:.2e} of itself");
}
