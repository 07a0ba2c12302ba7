//! Slope, velocity and acceleration of the deck: against the motion of its deflections, the equation of motion, closed forms
//! and what others print of a train.

use crate::problems::ensemble::{check_alone, kishan_analysis, run as run_study, study_of, synthesis, varied};
use crate::problems::*;
use spanwise::bridge::{Bridge, Stations};
use spanwise::damping::Damping;
use spanwise::ensemble::{Parameter, Samples};
use spanwise::lane::Isa;
use spanwise::passage::{Passage, Settings, Tail};
use spanwise::recovery::Recovery::{self, ForceSummation, ForceSummationByRates, Superposition};
use spanwise::statics::Quantity;
use spanwise::stop_token::StopToken;
use spanwise::vehicle::Vehicle;

/// Central differences over steps of a 3000th of the shortest included period: of first order where an axle enters and
/// friction turns, of second elsewhere.
const DIFFERENCE: f64 = 5e-4;

/// Two ways to the same number.
const ROUNDING: f64 = 1e-10;

/// Deflection and acceleration of BeamDyn to its own error, and the steps of ours.
const PRINTED: f64 = 1e-3;

fn histories(run: &Run, quantity: Quantity) -> Vec<f64> {
    let [dynamic, at_rest] = run.analysis.histories(&run.outcome, quantity, StopToken::NEVER).unwrap();
    assert!(quantity.order() == 0 || at_rest.iter().all(|value| *value == 0.0));
    dynamic
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// Two spans of 20 m, seen at supports, stations and elsewhere.
fn crossed(recovery: Recovery, step: f64, modes: usize) -> Run {
    let settings = Settings { step: Some(step), beta: 0.25, tail: Tail::Fixed(0.05), ..Settings::at_speed(21.7) };
    let damping = Damping::Ratios(vec![0.02]);
    run(&two_spans(8), &kishan_vehicle(), &settings, modes, &damping, recovery, &[]).unwrap()
}

/// What the modes do is the derivative in time of the deflection by superposition.
#[test]
fn velocity_and_acceleration_are_derivatives_of_the_deflection() {
    let step = 5e-5;
    let run = crossed(Superposition, step, 3);
    let width = run.analysis.sections.len();
    let [deflection, velocity, acceleration] =
        [Quantity::Deflection, Quantity::Velocity, Quantity::Acceleration].map(|quantity| histories(&run, quantity));
    for (motion, of, what) in [(&velocity, &deflection, "velocity"), (&acceleration, &velocity, "acceleration")] {
        let scale = largest(motion);
        let rows = run.outcome.history.len() - 2;
        for row in 1..rows {
            for section in 0..width {
                let difference = of[(row + 1) * width + section] - of[(row - 1) * width + section];
                let off = (motion[row * width + section] - difference / (2.0 * step)).abs() / scale;
                assert!(off <= DIFFERENCE, "{what}, step {row}, section {section}: off by {off:e}");
            }
        }
    }
}

/// Ä = ΦᵀP − Ω²A − DȦ at every step, and the deck follows it; supports that do not give way stay where they are.
#[test]
fn acceleration_obeys_the_equation_of_motion() {
    for recovery in [ForceSummation, ForceSummationByRates, Superposition] {
        let run = crossed(recovery, 1e-3, 3);
        let (history, model) = (&run.outcome.history, &run.analysis.model);
        let acceleration = histories(&run, Quantity::Acceleration);
        let (width, modes, scale) = (run.analysis.sections.len(), history.modes, largest(&acceleration));
        let shapes_at = |x: f64| {
            let mut shapes = Vec::new();
            model.shapes.extend_at(x, 1, &mut shapes);
            shapes
        };
        for step in 0..history.len() - 1 {
            let mut modal: Vec<f64> = (0..modes)
                .map(|m| {
                    let [a, v] = [&history.a, &history.a_dot].map(|all| all[step * modes + m]);
                    -model.omega[m].powi(2) * a - 2.0 * 0.02 * model.omega[m] * v
                })
                .collect();
            for axle in 0..history.axles {
                let (x, load) =
                    (history.positions[step * history.axles + axle], history.loads[step * history.axles + axle]);
                modal.iter_mut().zip(&shapes_at(x)).for_each(|(sum, shape)| *sum += shape * load);
            }
            for (section, &x) in run.analysis.sections.iter().enumerate() {
                let expected: f64 = modal.iter().zip(&shapes_at(x)).map(|(a, shape)| a * shape).sum();
                let off = (acceleration[step * width + section] - expected).abs() / scale;
                assert!(off <= ROUNDING, "{recovery:?}, step {step}, {x} m: off by {off:e}");
                let held = run.bridge.supports().iter().any(|support| (support.at - x).abs() < 1e-9);
                assert!(!held || acceleration[step * width + section].abs() <= 1e-12 * scale, "{x} m");
            }
        }
    }
}

/// The slope is that of the deflection along the bridge, and under a load at rest that of the textbook.
#[test]
fn slope_is_the_derivative_of_the_deflection_along_the_bridge() {
    let (span, ei, force) = (20.0, 6e9, 1e5);
    let stations = Stations::PerSpan(vec![8]);
    let bridge = continuous_span(span, ei, &stations);
    let (apart, at) = (0.05, 6.3);
    for recovery in [ForceSummation, Superposition] {
        let settings = Settings { step: Some(1e-3), ..Settings::at_speed(10.0) };
        let vehicle = Vehicle::force_train(&[force], &[0.0]).unwrap();
        let sections = [0.0, at - apart, at, at + apart, span];
        let run = run(&bridge, &vehicle, &settings, 3, &undamped(), recovery, &sections).unwrap();
        let [slope, deflection] = [Quantity::Slope, Quantity::Deflection].map(|quantity| histories(&run, quantity));
        let scale = largest(&slope);
        for row in 0..run.outcome.history.len() {
            let y = &deflection[5 * row..][..5];
            let off = (slope[5 * row + 2] - (y[3] - y[1]) / (2.0 * apart)).abs() / scale;
            assert!(off <= 5e-3, "{recovery:?}, {row}: off by {off:e}");
        }
        // P a (L² − a²) / (6 EI L) at the end farther from the load, largest where a = L/√3.
        let envelope = run.analysis.envelope_of(&run.outcome, Quantity::Slope, StopToken::NEVER).unwrap();
        if recovery == ForceSummation {
            let a = span / 3.0_f64.sqrt();
            let expected = force * a * (span * span - a * a) / (6.0 * ei * span);
            let [left, right] = [envelope.at_rest.max[0].value, envelope.at_rest.min[4].value];
            assert!((left / expected - 1.0).abs() < 1e-5 && (right / -expected - 1.0).abs() < 1e-5, "{left}, {right}");
        }
    }
}

fn continuous_span(span: f64, ei: f64, stations: &Stations) -> Bridge {
    continuous(&[span], [PINNED; 2], &[ei], &[8e3], stations, &[]).unwrap()
}

/// Train D2 of BeamDyn (A. Andersson, KTH, 2026) on a simple beam of 25 m: deck acceleration of three modes over the inner
/// sections, as printed at some speeds [m/s²].
#[test]
fn accelerations_under_a_train() {
    let bridge = continuous(&[25.0], [PINNED; 2], &[30e9], &[15e3], &Stations::PerSpan(vec![40]), &[]).unwrap();
    let mut positions = vec![0.0];
    for gap in [1.8, 7.45, 1.8, 3.0].iter().cycle().take(23) {
        positions.push(positions[positions.len() - 1] - gap);
    }
    let train = Vehicle::force_train(&[22.5e3 * 9.81; 24], &positions).unwrap();
    let sections: Vec<f64> = (1..20).map(|i| 1.25 * f64::from(i)).collect();
    for (speed, printed) in [(120.0, 1.5395), (180.0, 5.5769), (240.0, 2.4057)] {
        let settings = Settings { tail: Tail::Fixed(1.0), step: Some(1e-4), ..Settings::at_speed(speed / 3.6) };
        let run = run(&bridge, &train, &settings, 3, &Damping::Ratios(vec![0.01]), ForceSummation, &sections).unwrap();
        let envelope = run.analysis.envelope_of(&run.outcome, Quantity::Acceleration, StopToken::NEVER).unwrap();
        let sides = envelope.dynamic.max.iter().chain(&envelope.dynamic.min);
        let most = sides.fold(0.0_f64, |most, extreme| most.max(extreme.value.abs()));
        assert!((most / printed - 1.0).abs() <= PRINTED, "{speed} km/h: {most}, {printed}");
    }
}

/// In ensembles to the bit what single crossings have, on bridges of their own too.
#[test]
fn ensembles_have_the_same() {
    let quantities = [Quantity::Deflection, Quantity::Slope, Quantity::Velocity, Quantity::Acceleration];
    for recovery in [ForceSummation, ForceSummationByRates, Superposition] {
        let settings = Settings { approach: 20.0, ramp: 10.0, ..Settings::at_speed(1.0) };
        let kinds = vec![vec![Passage::of(kishan_vehicle())]];
        let roads = Some((synthesis(), 3));
        let study = study_of(kishan_analysis(9, recovery), kinds, settings, roads, Some(0.05), &quantities).unwrap();
        let mut samples = Samples { speeds: vec![22.0, 31.0, 26.5, 18.0, 40.0], ..Samples::at_speed(0, 5, 1.0) };
        for parameter in [None, Some(Parameter::BridgeStiffness), Some(Parameter::BridgeDamping)] {
            samples.factors.extend(parameter.map(|parameter| varied(parameter, 2, 0..5)));
            for isa in Isa::present() {
                check_alone(&study, &samples, &run_study(&study, &samples, isa, 1), &format!("{recovery:?} {isa:?}"));
            }
        }
    }
}

/// Of constant forces, what the modes left out add to the deflection has this second derivative, exactly.
#[test]
fn the_quasi_static_part_is_that_of_the_modes_left_out() {
    let bridge = two_spans(8);
    let train = Vehicle::force_train(&[1e5, 2e5], &[0.0, -3.7]).unwrap();
    let (step, speed) = (1e-4, 40.0);
    let settings = Settings { step: Some(step), ..Settings::at_speed(speed) };
    let [summed, superposed] = [ForceSummation, Superposition].map(|recovery| {
        let sections = [4.0, 10.0, 27.0];
        run(&bridge, &train, &settings, 3, &Damping::Ratios(vec![0.02]), recovery, &sections).unwrap()
    });
    let part = summed.analysis.quasi_static_acceleration(&summed.outcome, StopToken::NEVER).unwrap();
    let [whole, modes] = [&summed, &superposed].map(|run| histories(run, Quantity::Deflection));
    let rest: Vec<f64> = whole.iter().zip(&modes).map(|(whole, modes)| whole - modes).collect();
    let nodes = summed.flexibility.mesh().nodes();
    let (scale, mut compared) = (largest(&part), 0);
    for row in 1..summed.outcome.history.len() - 2 {
        // Cubics end at nodes.
        let positions = &summed.outcome.history.positions[2 * row..][..2];
        if nodes.iter().any(|node| positions.iter().any(|x| (x - node).abs() < 2.0 * step * speed)) {
            continue;
        }
        compared += 1;
        for section in 0..3 {
            let [before, now, after] = [row - 1, row, row + 1].map(|row| rest[3 * row + section]);
            let off = (part[3 * row + section] - (after - 2.0 * now + before) / (step * step)).abs() / scale;
            assert!(off <= 1e-5, "step {row}, section {section}: off by {off:e}");
        }
    }
    assert!(compared > 1000, "{compared}");
    assert!(superposed.analysis.quasi_static_acceleration(&superposed.outcome, StopToken::NEVER).is_err());
}
