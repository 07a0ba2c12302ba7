//! Sine and cosine of angles in turns, from exact reduction and polynomials: the same bits on every machine.
//!
//! The standard library leaves them to the platform, whose last bits differ; a road must not.

use std::f64::consts::TAU;

/// Taylor coefficients of (sin y − y)/y³ in y²; for |y| ≤ π/4 the first one left out, y¹⁷/17!, is below 5e-17.
const SINE: [f64; 7] = [
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
];

/// Taylor coefficients of (cos y − 1)/y² in y²; the first one left out, y¹⁸/18!, is below 3e-18.
const COSINE: [f64; 8] = [
    -1.0 / 2.0,
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 20_922_789_888_000.0,
];

/// (sin 2πu, cos 2πu), within 1e-15.
pub fn sin_cos(u: f64) -> (f64, f64) {
    // u − q/4 is exact: where q is not 0, both are within a factor of two of each other.
    let quarters = (4.0 * u).round();
    let y = (u - 0.25 * quarters) * TAU;
    let z = y * y;
    let sine = y + y * (z * horner(&SINE, z));
    let cosine = 1.0 + z * horner(&COSINE, z);
    match quarters as i64 & 3 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// sin(πu)/(πu): the frequency response of a moving average, at wave number times length.
pub fn sinc(u: f64) -> f64 {
    if u == 0.0 { 1.0 } else { sin_cos(0.5 * u).0 / (0.5 * TAU * u) }
}

fn horner(coefficients: &[f64], z: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * z + c)
}
