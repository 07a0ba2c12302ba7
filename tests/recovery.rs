//! Recovery: rows against the sequence of [KTN73], equilibrium, Eq. 6 against Eq. 11, and what few modes are worth.

use crate::problems::continuous;
use crate::problems::*;
use faer::Mat;
use spanwise::bridge::{Bridge, Stations};
use spanwise::damping::Damping;
use spanwise::force_summation::{Recovered, Sequence};
use spanwise::modes::Modes;
use spanwise::passage::{Settings, Tail};
use spanwise::recovery::Recovery::{self, ForceSummation, ForceSummationByRates, Superposition};
use spanwise::statics::{Quantity, Restraint};
use spanwise::stop_token::StopToken;

/// Two ways to the same number differ by rounding, relative to its largest value in the run.
const ROUNDING: f64 = 1e-10;

/// An axle within this fraction of the length of a section stands on it: its shear is two-valued there.
const ON_SECTION: f64 = 1e-9;

/// By this factor, at least, one mode with force summation is nearer to all modes than three superposed.
const ADVANTAGE: f64 = 3.0;

/// Included modes of all runs here but those that say otherwise.
const MODES: usize = 4;

/// Tenth points, stations, supports, and a few points that are nothing of all that.
fn sections(bridge: &Bridge) -> Vec<f64> {
    let mut all = bridge.default_sections();
    all.extend((1..4).map(|i| bridge.length() * spread(i)));
    all.sort_by(f64::total_cmp);
    all
}

fn crossed(bridge: &Bridge, modes: usize, damping: &Damping, recovery: Recovery) -> Run {
    // Average acceleration: any step is stable, and these identities do not ask for a fine one.
    let settings =
        Settings { step: Some(4e-3), beta: 0.25, approach: 1.0, tail: Tail::Fixed(0.1), ..Settings::at_speed(21.7) };
    run(bridge, &kishan_vehicle(), &settings, modes, damping, recovery, &sections(bridge)).unwrap()
}

/// Φ of all modes, and Φᵀ M.
fn all_modes(run: &Run) -> (Modes, Mat<f64>) {
    let stations = run.bridge.stations();
    let modes = Modes::new(&run.bridge, &run.flexibility, stations.len()).unwrap();
    let momentum = Mat::from_fn(stations.len(), stations.len(), |i, j| modes.shapes[(j, i)] * stations[j].mass);
    (modes, momentum)
}

/// C = Σ value(ω) (Mφ)(Mφ)ᵀ over all modes: classical damping as a matrix.
fn classical(run: &Run, value: impl Fn(f64) -> f64) -> Mat<f64> {
    let (modes, momentum) = all_modes(run);
    let scaled = Mat::from_fn(momentum.nrows(), momentum.ncols(), |i, j| value(modes.omega[i]) * momentum[(i, j)]);
    momentum.transpose() * &scaled
}

fn sequence(run: &Run, c: &Mat<f64>) -> Sequence {
    Sequence::new(&run.bridge, &run.flexibility, &run.analysis.modes, c.clone())
}

fn axles(row: &Row<'_>) -> Vec<(f64, f64)> {
    row.positions.iter().copied().zip(row.loads.iter().copied()).collect()
}

/// The recovered values in the order of the rows.
fn in_order(run: &Run, recovered: &Recovered) -> Vec<f64> {
    let flexibility = &run.flexibility;
    let nodes = run.analysis.responses.sections();
    let mut values: Vec<f64> = nodes.iter().map(|&n| recovered.deflections[n]).collect();
    values.extend(nodes.iter().map(|&n| recovered.moments[n]));
    values.extend(nodes.iter().map(|&n| recovered.shears[n][0]));
    values.extend(nodes.iter().map(|&n| recovered.shears[n][1]));
    let outer = flexibility.outer_restraints().into_iter().zip(recovered.outer_reactions.iter().copied());
    // Redundant reactions are loads, down; as couples they are already what the support does to the bridge.
    let redundant = flexibility.redundants().iter().zip(&recovered.redundant_reactions).map(|(r, p)| match r {
        Restraint::Deflection(_) => (*r, -p),
        Restraint::Slope(_) => (*r, *p),
    });
    let all = outer.chain(redundant);
    let (mut forces, mut moments): (Vec<_>, Vec<_>) = all.partition(|(r, _)| matches!(r, Restraint::Deflection(_)));
    forces.sort_by_key(|(r, _)| r.node());
    moments.sort_by_key(|(r, _)| r.node());
    values.extend(forces.into_iter().chain(moments).map(|(_, value)| value));
    values
}

/// Whether response `r` is a shear at a section on which an axle stands.
fn two_valued(run: &Run, row: &Row<'_>, r: usize) -> bool {
    [Quantity::ShearLeft, Quantity::ShearRight].into_iter().any(|quantity| {
        let range = run.analysis.responses.range(quantity);
        let near = ON_SECTION * run.bridge.length();
        range.contains(&r) && row.positions.iter().any(|x| (x - run.analysis.sections[r - range.start]).abs() <= near)
    })
}

/// Largest difference of rows and sequence over a run, each response relative to its scale.
fn rows_against_sequence(run: &Run, c: &Mat<f64>, by_rates: bool) -> f64 {
    let sequence = sequence(run, c);
    let scales = run.scales();
    let mut worst = 0.0_f64;
    for row in run.rows() {
        let axles = axles(&row);
        let forces = match by_rates {
            true => sequence.inertia_forces_by_rates(row.a_dot, row.a_ddot),
            false => sequence.inertia_forces(row.a, &axles),
        };
        let recovered = sequence.recover(&axles, &forces);
        let expected = in_order(run, &recovered);
        assert_eq!(expected.len(), row.dynamic.len());
        for (r, (ours, expected)) in row.dynamic.iter().zip(&expected).enumerate() {
            if !two_valued(run, &row, r) {
                worst = worst.max((ours - expected).abs() / scales[r]);
            }
        }
        // Eq. 14 and Eq. 15 at every node.
        let again = sequence.deflections_by_actual_bridge(&axles, &forces);
        let largest = largest_magnitude(&scales[run.analysis.responses.range(Quantity::Deflection)]);
        worst = worst.max(largest_difference(&recovered.deflections, &again) / largest);
    }
    worst
}

#[test]
fn rows_are_the_sequence() {
    for (name, bridge) in all_arrangements() {
        let c = uneven_damping(&bridge);
        for damping in [Damping::Ratios(vec![0.03]), Damping::Viscous(c.clone())] {
            let run = crossed(&bridge, MODES, &damping, ForceSummation);
            let worst = rows_against_sequence(&run, &c, false);
            println!("{name}: {worst:.1e}");
            assert!(worst <= ROUNDING, "{name}: {worst:.2e}");
        }
    }
}

#[test]
fn rows_by_rates_are_the_sequence_with_eq_6() {
    for (name, bridge) in all_arrangements() {
        let c = uneven_damping(&bridge);
        let full = crossed(&bridge, MODES, &Damping::Viscous(c.clone()), ForceSummationByRates);
        let ratios = crossed(&bridge, MODES, &Damping::Ratios(vec![0.03]), ForceSummationByRates);
        let c_of_ratios = classical(&ratios, |omega| 2.0 * 0.03 * omega);
        for (run, c) in [(full, c), (ratios, c_of_ratios)] {
            let worst = rows_against_sequence(&run, &c, true);
            println!("{name}: {worst:.1e}");
            assert!(worst <= ROUNDING, "{name}: {worst:.2e}");
        }
    }
}

/// Forces and moments balance at every instant: reactions and clamp moments with axle loads and inertia forces.
#[test]
fn the_bridge_is_in_equilibrium() {
    for (name, bridge) in all_arrangements() {
        let run = crossed(&bridge, MODES, &Damping::Viscous(uneven_damping(&bridge)), ForceSummation);
        let sequence = sequence(&run, &uneven_damping(&bridge));
        let [reactions, clamps, moments] =
            [Quantity::Reaction, Quantity::ClampMoment, Quantity::Moment].map(|q| run.analysis.responses.range(q));
        let length = bridge.length();
        let largest = largest_magnitude(&run.history_of(Quantity::Reaction));
        let largest_moment = largest_magnitude(&run.history_of(Quantity::Moment));
        let (mut worst, mut at_the_end) = (0.0_f64, 0.0_f64);
        for row in run.rows() {
            let axles = axles(&row);
            let forces = sequence.inertia_forces(row.a, &axles);
            let stations = bridge.stations().iter().map(|s| s.at).zip(forces.iter().copied());
            let on_bridge = |&(x, _): &(f64, f64)| run.flexibility.mesh().panel_at(x).is_some();
            let loads: Vec<(f64, f64)> = axles.iter().copied().filter(on_bridge).chain(stations).collect();
            let up = bridge.supports().iter().map(|s| s.at).zip(row.dynamic[reactions.clone()].iter().copied());
            let down = loads.into_iter().chain(up.map(|(x, r)| (x, -r)));
            let clamped = bridge.supports().iter().filter(|s| s.fixity.rotation() > 0.0);
            // Clockwise, but on the right end sagging, which is anticlockwise.
            let couples: f64 =
                clamped.zip(&row.dynamic[clamps.clone()]).map(|(s, m)| if s.at == length { -m } else { *m }).sum();
            let (force, about_left) = down.fold((0.0, couples), |(f, m), (x, p)| (f + p, m + p * x));
            let about_right = about_left - force * length;
            worst = worst.max(force.abs() / largest);
            worst = worst.max(about_left.abs().max(about_right.abs()) / (largest * length));

            let summed = sequence.recover(&axles, &forces).moments;
            at_the_end = at_the_end.max(summed[summed.len() - 1].abs()).max(row.dynamic[moments.end - 1].abs());
        }
        println!("{name}: out of balance {worst:.1e}, end moment {:.1e}", at_the_end / largest_moment);
        assert!(worst <= ROUNDING, "{name}: out of balance by {worst:.2e}");
        let clamped_there = bridge.supports().iter().any(|s| s.at == length && s.fixity.rotation() > 0.0);
        assert_eq!(at_the_end <= ROUNDING * largest_moment, !clamped_there, "{name}: moment at the right end");
    }
}

/// Largest values over a run of P̃ by Eq. 11, of its difference from Eq. 6, and of what that difference leaves
/// unexplained.
fn eq_6_and_eq_11(run: &Run, c: &Mat<f64>) -> [f64; 3] {
    let sequence = sequence(run, c);
    let shapes = &run.analysis.modes.shapes;
    let n = shapes.nrows();
    // Eq. 3 gives Ω²A − Φ⁰ᵀP̄ = −(Ä + ΦᵀCΦȦ), hence P̃ by Eq. 11 is −MΦ(Ä + ΦᵀCΦȦ) and by Eq. 6 less by
    // (I − MΦΦᵀ) CΦȦ: the damping forces that the included modes' own inertia cannot take.
    let mass = |i: usize| run.bridge.stations()[i].mass;
    let projection = shapes * shapes.transpose();
    let lost = Mat::from_fn(n, n, |i, j| f64::from(i == j) - mass(i) * projection[(i, j)]) * c * shapes;
    let mut largest = [0.0_f64; 3];
    for row in run.rows() {
        let by_coordinates = sequence.inertia_forces(row.a, &axles(&row));
        let by_rates = sequence.inertia_forces_by_rates(row.a_dot, row.a_ddot);
        for i in 0..n {
            let difference = by_rates[i] - by_coordinates[i];
            let explained: f64 = row.a_dot.iter().enumerate().map(|(m, v)| -lost[(i, m)] * v).sum();
            let values = [by_coordinates[i], difference, difference - explained];
            largest.iter_mut().zip(values).for_each(|(m, v)| *m = m.max(v.abs()));
        }
    }
    largest
}

#[test]
fn eq_6_is_eq_11_with_classical_damping() {
    for (name, bridge) in all_arrangements() {
        let ratios = crossed(&bridge, MODES, &Damping::Ratios(vec![0.02, 0.03, 0.01, 0.05]), ForceSummation);
        let omega = ratios.analysis.modes.omega.clone();
        // Ratios of the included modes; of the others C does not matter.
        let ratio = |w: f64| match omega.iter().position(|o| (w / o - 1.0).abs() < 1e-6) {
            Some(m) => [0.02, 0.03, 0.01, 0.05][m],
            None => 0.02,
        };
        let c = classical(&ratios, |w| 2.0 * ratio(w) * w);
        let [forces, difference, _] = eq_6_and_eq_11(&ratios, &c);
        println!("{name}: ratios {:.1e}", difference / forces);
        assert!(difference <= ROUNDING * forces, "{name}: ratios, {:.2e} of P̃", difference / forces);

        let c = classical(&ratios, |w| 0.9 + 0.002 * w * w);
        let rayleigh = crossed(&bridge, MODES, &Damping::Viscous(c.clone()), ForceSummation);
        let [forces, difference, _] = eq_6_and_eq_11(&rayleigh, &c);
        println!("{name}: Rayleigh {:.1e}", difference / forces);
        assert!(difference <= ROUNDING * forces, "{name}: Rayleigh, {:.2e} of P̃", difference / forces);
        // As ratios it is the same damping.
        let by_ratios = Damping::Rayleigh { mass: 0.9, stiffness: 0.002 };
        let by_ratios = crossed(&bridge, MODES, &by_ratios, ForceSummation).history_of(Quantity::Moment);
        let by_matrix = rayleigh.history_of(Quantity::Moment);
        let apart = largest_difference(&by_ratios, &by_matrix) / largest_magnitude(&by_matrix);
        assert!(apart <= 1e-9, "{name}: Rayleigh by ratios and by a matrix, {apart:.1e} apart");
    }
}

#[test]
fn eq_6_differs_from_eq_11_by_the_damping_forces_that_the_modes_miss() {
    // Where there are no more masses than modes, none is missed.
    for (name, bridge) in all_arrangements().into_iter().filter(|(_, bridge)| bridge.stations().len() > MODES) {
        let c = uneven_damping(&bridge);
        let run = crossed(&bridge, MODES, &Damping::Viscous(c.clone()), ForceSummation);
        let [forces, difference, unexplained] = eq_6_and_eq_11(&run, &c);
        println!("{name}: apart {:.1e}, unexplained {:.1e}", difference / forces, unexplained / forces);
        assert!(difference > 1e-4 * forces, "{name}: no difference to explain, {:.2e}", difference / forces);
        assert!(unexplained <= ROUNDING * forces, "{name}: unexplained {:.2e} of P̃", unexplained / forces);

        // Nothing is missed by all modes.
        let all = crossed(&bridge, bridge.stations().len(), &Damping::Viscous(c.clone()), ForceSummation);
        let [forces, difference, _] = eq_6_and_eq_11(&all, &c);
        assert!(difference <= ROUNDING * forces, "{name}: all modes, {:.2e} of P̃", difference / forces);
    }
}

/// One mode with force summation beats three superposed, for the moment at midspan and the shear at the support.
///
/// The error of superposition oscillates through zero as the speed changes, so the worst of several speeds is compared.
#[test]
fn fewer_modes_suffice() {
    let span = 25.0;
    let stations = Stations::PerSpan(vec![20]);
    let bridge = continuous(&[span], [PINNED, PINNED], &[1.2e10], &[9.0e3], &stations, &[]).unwrap();
    let extremes = |modes: usize, recovery: Recovery, speed: f64| {
        let (settings, damping) = (Settings::at_speed(speed), Damping::Ratios(vec![0.02]));
        let sections = [0.0, 0.5 * span, span];
        let run = run(&bridge, &kishan_vehicle(), &settings, modes, &damping, recovery, &sections).unwrap();
        let moment =
            run.analysis.envelope_of(&run.outcome, Quantity::Moment, StopToken::NEVER).unwrap().dynamic.max[1].value;
        let shear = run.analysis.envelope_of(&run.outcome, Quantity::ShearRight, StopToken::NEVER).unwrap().dynamic.max
            [0]
        .value;
        [moment, shear]
    };
    let [mut summed, mut superposed] = [[0.0_f64; 2]; 2];
    for speed in [12.0, 15.0, 18.0, 22.0, 26.0, 30.0] {
        let exact = extremes(20, ForceSummation, speed);
        for (worst, found) in
            [(&mut summed, extremes(1, ForceSummation, speed)), (&mut superposed, extremes(3, Superposition, speed))]
        {
            worst.iter_mut().zip(found).zip(exact).for_each(|((w, f), e)| *w = w.max((f / e - 1.0).abs()));
        }
    }
    for (i, name) in ["moment at midspan", "shear at the support"].into_iter().enumerate() {
        println!("{name}: one mode summed {:.2e} off, three superposed {:.2e}", summed[i], superposed[i]);
        assert!(ADVANTAGE * summed[i] <= superposed[i], "{name}: {:.2e} and {:.2e}", summed[i], superposed[i]);
    }
}
