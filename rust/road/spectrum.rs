//! Roughness after ISO 8608: a power law of the wave number, and its classes.

use super::texture::Texture;
use super::turn::sinc;
use crate::error::{Error, finite, not_negative, positive};

/// Wave number n₀ at which the roughness is stated [cycle/m].
pub const REFERENCE: f64 = 0.1;

/// Bands that the slope is summed up by.
const BANDS: usize = 64;

/// A class of road roughness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    A,
    B,
    C,
    D,
    E,
    F,
    G,
    H,
}

impl Class {
    /// All of them, the smoothest first.
    pub const ALL: [Class; 8] = [Class::A, Class::B, Class::C, Class::D, Class::E, Class::F, Class::G, Class::H];

    /// Geometric mean of G_d(n₀) [m³]: 16e-6 for A, and four times that from class to class.
    pub fn mean(self) -> f64 {
        16e-6 * f64::from(1u32 << (2 * self as u32))
    }

    /// Upper limit of G_d(n₀) [m³], twice the mean; none for the roughest.
    pub fn upper(self) -> Option<f64> {
        (self != Class::H).then(|| 2.0 * self.mean())
    }
}

/// One-sided power spectral density G_d(n) = G_d(n₀) (n/n₀)^−w of the elevation within a band of wave numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spectrum {
    roughness: f64,
    waviness: f64,
    band: [f64; 2],
}

impl Spectrum {
    /// From G_d(n₀) [m³], the exponent w and the `band` [cycle/m].
    pub fn new(roughness: f64, waviness: f64, band: [f64; 2]) -> Result<Self, Error> {
        positive("G", roughness)?;
        not_negative("waviness", waviness)?;
        positive("band[0]", band[0])?;
        finite("band[1]", band[1])?;
        if band[1] <= band[0] {
            let allowed = format!("must be greater than the lower end of the band, {} cycle/m", band[0]);
            return Err(Error::input("band[1]", format!("{} cycle/m", band[1]), allowed));
        }
        let spectrum = Spectrum { roughness, waviness, band };
        if !(spectrum.variance().is_finite() && spectrum.variance() > 0.0) {
            let allowed = "the variance of the elevation over the band must be a positive finite number";
            let (key, value) = match roughness {
                1e-20..1e20 => ("waviness", waviness),
                _ => ("G", roughness),
            };
            return Err(Error::input(key, value, allowed));
        }
        Ok(spectrum)
    }

    /// Lowest and highest wave number [cycle/m].
    pub fn band(&self) -> [f64; 2] {
        self.band
    }

    /// Mean square of the elevation [m²].
    pub fn variance(&self) -> f64 {
        self.power(self.band[0], self.band[1])
    }

    /// How rough such roads are for a wheel whose contact patch averages over a length [m]; the slope by bands.
    pub fn texture(&self, patch: f64) -> Texture {
        let [from, to] = self.band;
        let ratio = libm::pow(to / from, 1.0 / BANDS as f64);
        let edges: Vec<f64> = (0..=BANDS).map(|i| from * libm::pow(ratio, i as f64)).collect();
        let slope = |edges: &[f64]| {
            let waves = std::f64::consts::TAU * (edges[0] * edges[1]).sqrt();
            self.power(edges[0], edges[1]) * (waves * sinc(waves / std::f64::consts::TAU * patch)).powi(2)
        };
        Texture { slope_power: edges.windows(2).map(slope).sum(), highest: to, ..Texture::SMOOTH }
    }

    /// Exact integral of G_d over the wave numbers from `from` to `to` that are in the band [m²].
    pub fn power(&self, from: f64, to: f64) -> f64 {
        let (a, b) = (from.max(self.band[0]), to.min(self.band[1]));
        if a >= b {
            return 0.0;
        }
        let exponent = 1.0 - self.waviness;
        let width = if self.waviness == 2.0 {
            REFERENCE * (b - a) / (a * b)
        } else if exponent == 0.0 {
            libm::log(b / a)
        } else {
            // No difference of two powers, which would cancel for narrow bins and near w = 1.
            libm::pow(a / REFERENCE, exponent) * libm::expm1(exponent * libm::log(b / a)) / exponent
        };
        self.roughness * REFERENCE * width
    }
}
