//! Sine and cosine of angles in turns, from exact reduction and polynomials: the same bits on every machine.
//!
//! The standard library leaves them to the platform, whose last bits differ; a road must not.

use std::f64::consts::TAU;

use crate::lane::Lane;
use crate::lane::bits::Bits;

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
    let (sine, cosine) = within_an_eighth((u - 0.25 * quarters) * TAU);
    match quarters as i64 & 3 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// The same for angles in words, of which a turn has 2³²; the upper halves of the numbers are ignored.
///
/// Nothing depends on the angle but numbers: there is no branch, and no operation that not every processor has.
#[inline(always)]
pub fn sin_cos_of_words<L: Lane>(words: L::Bits) -> (L, L) {
    let splat = L::Bits::splat;
    // With an eighth more, the two highest of the 32 bits are the nearest quarter; the others, an eighth and what the
    // angle has beyond that quarter.
    let words = words.plus(splat(EIGHTH));
    // As the last bits of 2⁵² they become a number, exactly.
    let beyond = L::from_bits(words.and(splat(2 * EIGHTH - 1)).or(splat(TWO_TO_52.to_bits())));
    let y = (beyond - L::splat(TWO_TO_52 + EIGHTH as f64)) * L::splat(0.125 * TAU / EIGHTH as f64);
    let (sine, cosine) = within_an_eighth(y);
    // In odd quarters they change places. The sine is negative in 2 and 3, the cosine in 1 and 2.
    let (sine, cosine) = (sine.to_bits(), cosine.to_bits());
    let (upper, lower) = (words.up(32), words.up(33));
    let change = sine.xor(cosine).and(lower.spread());
    let sine_sign = upper.and(splat(SIGN));
    let cosine_sign = upper.xor(lower).and(splat(SIGN));
    (L::from_bits(sine.xor(change).xor(sine_sign)), L::from_bits(cosine.xor(change).xor(cosine_sign)))
}

/// An eighth of a turn in words.
const EIGHTH: u64 = 1 << 29;

/// From here to twice as much, the last bit of a number is 1.
const TWO_TO_52: f64 = 4_503_599_627_370_496.0;

/// The bit of a number that is its sign.
const SIGN: u64 = 1 << 63;

/// (sin y, cos y) for |y| ≤ π/4.
#[inline(always)]
fn within_an_eighth<L: Lane>(y: L) -> (L, L) {
    let z = y * y;
    (y + y * (z * horner(&SINE, z)), L::splat(1.0) + z * horner(&COSINE, z))
}

/// sin(πu)/(πu): the frequency response of a moving average, at wave number times length.
pub fn sinc(u: f64) -> f64 {
    if u == 0.0 { 1.0 } else { sin_cos(0.5 * u).0 / (0.5 * TAU * u) }
}

#[inline(always)]
fn horner<L: Lane, const N: usize>(coefficients: &[f64; N], z: L) -> L {
    let mut sum = L::splat(coefficients[N - 1]);
    for k in (0..N - 1).rev() {
        sum = sum * z + L::splat(coefficients[k]);
    }
    sum
}
