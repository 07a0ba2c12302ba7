//! Problems with known answers, shared by tests and benches.
#![allow(dead_code)] // every test and bench takes what it needs

use spanwise::analysis::{Analysis, Outcome};
use spanwise::bridge::{Bridge, Fixity, Stations, Support};
use spanwise::crossing::{Damping, Settings};
use spanwise::error::Error;
use spanwise::flexibility::Flexibility;
use spanwise::influence::Quantity;
use spanwise::modes::Modes;
use spanwise::recovery::Recovery;
use spanwise::vehicle::{Axle, Vehicle};

/// One foot [m].
pub const FOOT: f64 = 0.3048;
/// One pound-force [N].
pub const POUND: f64 = 4.448_221_615_260_5;
/// One slug [kg]: the mass that a pound-force accelerates by a foot per second squared.
pub const SLUG: f64 = POUND / FOOT;

pub const PINNED: Option<Fixity> = Some(Fixity::Pinned);
pub const CLAMPED: Option<Fixity> = Some(Fixity::Clamped);

pub fn pinned(at: f64) -> Support {
    Support { at, fixity: Fixity::Pinned }
}

pub fn clamped(at: f64) -> Support {
    Support { at, fixity: Fixity::Clamped }
}

/// Two spans of 60 ft with three masses each ([KTN73] §4).
pub fn kishan_bridge() -> Bridge {
    Bridge::continuous(
        &[60.0 * FOOT; 2],
        [PINNED; 2],
        &[4.698e9 * POUND * FOOT * FOOT],
        &[126.1 * SLUG / FOOT],
        &Stations::PerSpan(vec![3]),
        &[],
    )
    .unwrap()
}

/// Two axles 14 ft apart that carry 32,040 lb each ([KTN73] §4).
pub fn kishan_vehicle() -> Vehicle {
    kishan_vehicle_with_friction(4800.0 * POUND)
}

pub fn kishan_vehicle_with_friction(friction_limit: f64) -> Vehicle {
    let axle = |position: f64| Axle {
        position,
        tyre_stiffness: 480_000.0 * POUND / FOOT,
        suspension_stiffness: 270_000.0 * POUND / FOOT,
        friction_limit,
        initial_friction: 0.0,
    };
    Vehicle::new(
        2.0 * 32_040.0 * POUND / 9.806_65,
        38_500.0 * SLUG * FOOT * FOOT,
        6.0 * FOOT,
        vec![axle(7.0 * FOOT), axle(-7.0 * FOOT)],
    )
    .unwrap()
}

/// A single sprung mass on a spring, without friction to slide [kg, N/m].
pub fn sprung_mass(mass: f64, stiffness: f64) -> Vehicle {
    let axle = Axle {
        position: 0.0,
        tyre_stiffness: stiffness,
        suspension_stiffness: stiffness,
        friction_limit: f64::INFINITY,
        initial_friction: 0.0,
    };
    Vehicle::new(mass, 1.0, 0.0, vec![axle]).unwrap()
}

/// A crossing of a bridge with everything that the tests look at.
pub struct Run {
    pub bridge: Bridge,
    pub analysis: Analysis,
    pub outcome: Outcome,
}

/// Crosses with `modes` modes, looking at `sections` (the default ones if empty).
pub fn run(
    bridge: &Bridge,
    vehicle: &Vehicle,
    settings: &Settings,
    modes: usize,
    damping: &Damping,
    recovery: Recovery,
    sections: &[f64],
) -> Result<Run, Error> {
    let modes = Modes::new(bridge, &Flexibility::new(bridge, &[])?, modes)?;
    let sections = (!sections.is_empty()).then_some(sections);
    let analysis = Analysis::new(bridge, modes, damping, sections, recovery)?;
    let outcome = analysis.cross(vehicle, settings, true, &mut || true)?;
    Ok(Run { bridge: bridge.clone(), analysis, outcome })
}

pub fn undamped() -> Damping {
    Damping::Ratios(vec![0.0])
}

impl Run {
    /// Index of the section at x.
    pub fn section(&self, x: f64) -> usize {
        let length = self.bridge.length();
        self.analysis.sections.iter().position(|s| (s - x).abs() < 1e-9 * length).unwrap()
    }

    /// Ratio of the largest dynamic to the largest static response of a kind, section by section.
    pub fn impact(&self, quantity: Quantity) -> Vec<f64> {
        let envelope = self.analysis.envelope_of(&self.outcome, quantity);
        let (d, s) = (&envelope.dynamic.max, &envelope.at_rest.max);
        d.iter().zip(s).map(|(d, s)| d.value / s.value).collect()
    }
}
