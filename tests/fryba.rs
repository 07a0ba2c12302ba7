//! A moving constant force on a simply supported span, after L. Frýba, "Vibration of solids and structures under moving
//! loads", 3rd ed. (1999), ch. 1: a mass on a vanishing spring presses with its weight alone.

use crate::problems::answers::{MovingForce, moving_forces};
use crate::problems::continuous;
use crate::problems::*;
use spanwise::bridge::{Bridge, Stations};
use spanwise::damping::Damping;
use spanwise::passage::Settings;
use spanwise::recovery::Recovery::{self, ForceSummation, Superposition};
use spanwise::statics::Quantity;

/// Half a unit of the last digit of the table is 5e-5; the rest is for the steps, the stations and the modes left out.
const AMPLIFICATION: f64 = 5e-4;

/// Series and run in the same modes differ by the time steps alone: the lumped frequencies and shapes are better.
const HISTORY: f64 = 5e-5;

/// Static deflections of the same beam by series and by flexibility, the series cut off after some hundreds of terms.
const STATIC: f64 = 1e-6;

const SPAN: f64 = 30.0;
const EI: f64 = 2.0e10;
const MASS_PER_LENGTH: f64 = 1.0e4;
const FORCE: f64 = 1.0e5;
const MODES: usize = 8;
const STATIONS: usize = 48;

fn bridge() -> Bridge {
    let stations = Stations::PerSpan(vec![STATIONS]);
    continuous(&[SPAN], [PINNED; 2], &[EI], &[MASS_PER_LENGTH], &stations, &[]).unwrap()
}

/// A crossing seen at midspan and at a third of the span.
fn crossed(case: &MovingForce, modes: usize, recovery: Recovery) -> Run {
    let first = std::f64::consts::PI / (2.0 * SPAN.powi(2)) * (EI / MASS_PER_LENGTH).sqrt();
    let speed = 2.0 * first * SPAN * case.alpha;
    // A fortieth of the shortest period, and enough steps at the highest speeds.
    let step = (1.0 / (first * (modes * modes) as f64) / 40.0).min(SPAN / speed / 1000.0);
    let settings = Settings { gravity: 10.0, step: Some(step), ..Settings::at_speed(speed) };
    let damping = Damping::Ratios(vec![case.damping]);
    let vehicle = sprung_mass(FORCE / 10.0, 1.0);
    run(&bridge(), &vehicle, &settings, modes, &damping, recovery, &[SPAN / 3.0, SPAN / 2.0]).unwrap()
}

fn static_deflection() -> f64 {
    FORCE * SPAN.powi(3) / (48.0 * EI)
}

#[test]
fn amplifications() {
    for case in moving_forces() {
        for recovery in [ForceSummation, Superposition] {
            let run = crossed(&case, MODES, recovery);
            let ours = run.outcome.envelope.dynamic.max[1].value / static_deflection();
            let off = ours - case.amplification;
            println!("alpha {}, damping {}, {recovery:?}: {ours:.5}, {off:+.1e}", case.alpha, case.damping);
            assert!(off.abs() <= AMPLIFICATION, "alpha {}, {recovery:?}: {ours}", case.alpha);
        }
    }
}

/// Deflections all along the crossing against the series in as many modes, damped and not.
#[test]
fn time_histories() {
    for case in moving_forces() {
        let run = crossed(&case, MODES, Superposition);
        assert_eq!(run.analysis.responses.range(Quantity::Deflection), 0..2);
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for row in run.rows() {
            for (section, xi) in [1.0 / 3.0, 0.5].into_iter().enumerate() {
                let exact = case.deflection(xi, row.positions[0] / SPAN, MODES);
                worst = worst.max((row.dynamic[section] / static_deflection() - exact).abs());
                largest = largest.max(exact);
            }
        }
        println!("alpha {}, damping {}: {:.1e}", case.alpha, case.damping, worst / largest);
        assert!(worst <= HISTORY * largest, "alpha {}, damping {}: {worst:e}", case.alpha, case.damping);
    }
}

/// Force summation in one mode adds what the series leaves out: the static deflection of all others.
#[test]
fn force_summation_adds_the_static_rest_of_the_series() {
    let case = MovingForce { alpha: 0.2, damping: 0.02, amplification: f64::NAN };
    let run = crossed(&case, 1, ForceSummation);
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for row in run.rows() {
        let s = row.positions[0] / SPAN;
        let statically = |j: f64| (j * std::f64::consts::PI * s).sin() * (0.5 * j * std::f64::consts::PI).sin();
        let rest: f64 =
            (2..600).map(f64::from).map(|j| 96.0 / std::f64::consts::PI.powi(4) / j.powi(4) * statically(j)).sum();
        let exact = case.deflection(0.5, s, 1) + rest;
        worst = worst.max((row.dynamic[1] / static_deflection() - exact).abs());
        largest = largest.max(exact);
        let at_rest = 96.0 / std::f64::consts::PI.powi(4) * statically(1.0) + rest;
        assert!((row.at_rest[1] / static_deflection() - at_rest).abs() <= STATIC, "static at {s}");
    }
    println!("{:.1e}", worst / largest);
    assert!(worst <= HISTORY * largest, "{worst:e} of {largest:e}");
}
