//! Beams and crossings whose answers are published or in closed form.

use super::continuous;
use std::f64::consts::PI;

use super::{CLAMPED, PINNED, sprung_mass};
use spanwise::bridge::{Bridge, Fixity, Stations};
use spanwise::vehicle::Vehicle;

/// A uniform bridge whose natural frequencies are known: ω = (βL)² √(EI/m) / L², with L the first span.
pub struct Uniform {
    pub name: &'static str,
    pub spans: Vec<f64>,
    pub ends: [Option<Fixity>; 2],
    /// βL of the lowest modes (see R. D. Blevins, "Formulas for natural frequency and mode shape", tables 8-1 and 8-7).
    pub beta_l: Vec<f64>,
}

pub fn uniform_bridges() -> Vec<Uniform> {
    let uniform = |name, spans: usize, ends, beta_l: &[f64]| Uniform {
        name,
        spans: vec![UNIFORM_SPAN; spans],
        ends,
        beta_l: beta_l.to_vec(),
    };
    vec![
        uniform("one span", 1, [PINNED; 2], &[PI, 2.0 * PI, 3.0 * PI]),
        uniform("two spans", 2, [PINNED; 2], &[PI, 3.926_602, 2.0 * PI, 7.068_583]),
        uniform("three spans", 3, [PINNED; 2], &[PI, 3.556_408, 4.297_530, 2.0 * PI]),
        uniform("clamped-free", 1, [CLAMPED, None], &[1.875_104, 4.694_091]),
        uniform("free-clamped", 1, [None, CLAMPED], &[1.875_104, 4.694_091]),
        uniform("clamped-clamped", 1, [CLAMPED; 2], &[4.730_041, 7.853_205]),
    ]
}

const UNIFORM_SPAN: f64 = 20.0;
const UNIFORM_EI: f64 = 4e9;
const UNIFORM_MASS: f64 = 8e3;

impl Uniform {
    pub fn bridge(&self, stations_per_span: usize) -> Bridge {
        let stations = Stations::PerSpan(vec![stations_per_span]);
        continuous(&self.spans, self.ends, &[UNIFORM_EI], &[UNIFORM_MASS], &stations, &[]).unwrap()
    }

    /// βL of a circular frequency.
    pub fn beta_l_of(&self, omega: f64) -> f64 {
        UNIFORM_SPAN * omega.sqrt() * (UNIFORM_MASS / UNIFORM_EI).powf(0.25)
    }
}

/// A constant force crossing a simply supported span: L. Frýba, "Vibration of solids and structures under moving loads",
/// 3rd ed. (1999), ch. 1.
pub struct MovingForce {
    /// Speed over twice the span per first period, α = v / (2 f₁ L).
    pub alpha: f64,
    /// Ratio of every mode to critical.
    pub damping: f64,
    /// Largest dynamic deflection of midspan with the force on the span, over the static one.
    pub amplification: f64,
}

/// Amplifications without and with 2 % of damping.
pub fn moving_forces() -> Vec<MovingForce> {
    let table = [
        (0.10, [1.0965, 1.0680]),
        (0.20, [1.0653, 1.0481]),
        (0.30, [1.4105, 1.3811]),
        (0.50, [1.7054, 1.6592]),
        (0.617, [1.7317, 1.6820]),
        (1.00, [1.5481, 1.5007]),
    ];
    let row = |(alpha, values): (f64, [f64; 2])| {
        let damped = [0.0, 0.02].into_iter().zip(values);
        damped.map(move |(damping, amplification)| MovingForce { alpha, damping, amplification })
    };
    table.into_iter().flat_map(row).collect()
}

impl MovingForce {
    /// Deflection at `xi` = x/L once the force has gone the fraction `s` of the span, in the first `terms` modes,
    /// relative to the static deflection of midspan under the force there.
    pub fn deflection(&self, xi: f64, s: f64, terms: usize) -> f64 {
        // Mode j answers ẅ + 2ζω ẇ + ω² w = ω² W sin Ωt, at rest at t = 0; time in units of 1/ω₁.
        let t = PI * s / self.alpha;
        let zeta = self.damping;
        (1..=terms)
            .map(|j| {
                let j = j as f64;
                let (omega, forcing) = (j * j, j * self.alpha);
                let ratio = forcing / omega;
                let response = if (zeta, ratio) == (0.0, 1.0) {
                    0.5 * ((omega * t).sin() - omega * t * (omega * t).cos())
                } else {
                    let size = 1.0 / ((1.0 - ratio * ratio).powi(2) + (2.0 * zeta * ratio).powi(2));
                    let (sine, cosine) = (size * (1.0 - ratio * ratio), -size * 2.0 * zeta * ratio);
                    let damped = omega * (1.0 - zeta * zeta).sqrt();
                    let (a, b) = (-cosine, (-forcing * sine - zeta * omega * cosine) / damped);
                    let free = (-zeta * omega * t).exp() * (a * (damped * t).cos() + b * (damped * t).sin());
                    sine * (forcing * t).sin() + cosine * (forcing * t).cos() + free
                };
                96.0 / PI.powi(4) / j.powi(4) * (j * PI * xi).sin() * response
            })
            .sum()
    }
}

/// A sprung mass crossing a simply supported span: Y. B. Yang and J. D. Yau, "Vehicle-bridge interaction element for
/// dynamic analysis", J. Struct. Eng. 123 (1997), with numbers as recomputed by many since.
pub struct YangYau;

impl YangYau {
    pub const SPAN: f64 = 25.0;
    pub const SPEED: f64 = 27.78;
    pub const GRAVITY: f64 = 9.81;
    /// Circular frequencies of the bridge's first mode and of the mass on its spring [rad/s].
    pub const FREQUENCIES: [f64; 2] = [30.02, 16.66];
    /// Included modes and largest midspan deflection [m].
    pub const DEFLECTIONS: [(usize, f64); 2] = [(1, 2.3839e-3), (20, 2.4073e-3)];
    /// Position of the mass at the largest deflection, as a fraction of the span.
    pub const POSITION: f64 = 0.412;

    pub fn bridge(stations: usize) -> Bridge {
        let stations = Stations::PerSpan(vec![stations]);
        continuous(&[Self::SPAN], [PINNED; 2], &[2.87e9 * 2.90], &[2303.0], &stations, &[]).unwrap()
    }

    pub fn vehicle() -> Vehicle {
        sprung_mass(5750.0, 1595e3)
    }
}
