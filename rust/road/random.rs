//! Random roads: a sum of waves with the spectrum of ISO 8608 and random phases, one function of x for seed and sample.
//!
//! r(x) = Σ A_m cos(2πmx/P + φ_m) with the phases φ_m uniform and independent. A_m²/2 is the integral of the spectrum
//! over the bin around m/P, so that every realisation has the mean square and, bin by bin, the spectrum of its class:
//! amplitudes are not drawn, because a class is defined by its spectrum, and chance should not make one road of an
//! ensemble rougher than the class it stands for. What a bridge meets, a stretch much shorter than the period P, mixes
//! many waves and is as good as Gaussian (M. Shinozuka and C.-M. Jan, "Digital simulation of random processes and its
//! applications", Journal of Sound and Vibration 25 (1972) 111-128).
//!
//! The waves are summed by one inverse transform into B-spline coefficients. A B-spline multiplies the spectrum by
//! sinc⁴(m/N), which is divided out first, so that every wave of the band has its exact amplitude at all x, not only at
//! grid points. What the spline adds are images at the wave numbers (jN ± m)/P, smaller by (m/(N − m))⁴: at most 1/81
//! of the amplitude for the shortest wave, four grid points long, and next to nothing for all others.
//!
//! The N coefficients are real: half as many complex numbers z_j = c_2j + i c_2j+1, whose transform is, for the component
//! X_m of the coefficients, X_m (1 + i e^iθ) at m and the conjugate of X_m (1 − i e^iθ) at N/2 − m, θ = 2πm/N. Since
//! 1 + i e^iθ = 2 cos α e^iα and 1 − i e^iθ = −2i sin α e^iα with α = θ/2 + π/4, both are a fixed amplitude with the sine
//! and cosine of one angle, φ_m + α. In words of the generator that angle is a sum of whole numbers.

use super::b_spline::Spline;
use super::fft::{Complex, InverseFft};
use super::patch::Patch;
use super::philox::{philox4x32_lanes, words};
use super::point::Point;
use super::spectrum::Spectrum;
use super::texture::Texture;
use super::turn::{sin_cos, sin_cos_of_words, sinc};
use crate::error::{Error, positive};
use crate::float_mode::Standard;
use crate::lane::Lane;
use crate::lane::bits::Bits;

/// Shortest default period [m].
const PERIOD: f64 = 1000.0;

/// Grid points per shortest wave.
const POINTS_PER_WAVE: f64 = 4.0;

/// Fewest grid points, for the sake of the transform.
const FEWEST_POINTS: usize = 8;

/// Most grid points; a road of them takes 32 MiB.
const MOST_POINTS: usize = 1 << 22;

/// What the words of the generator are drawn for, so that other draws under the same seed are others.
const PHASES: u64 = 0;

/// A turn has 2³² of the generator's words, a half 2³¹.
const HALF_TURN: u64 = 1 << 31;

/// All that roads of one spectrum share: amplitudes and tables.
#[derive(Debug, Clone, PartialEq)]
pub struct Synthesis {
    spectrum: Spectrum,
    patch: Patch,
    period: f64,
    /// Number m of the first wave.
    first: usize,
    /// Amplitudes at m and at N/2 − m, from the first wave on [m].
    amplitudes: Vec<[f64; 2]>,
    fft: InverseFft,
}

impl Synthesis {
    /// For a spectrum as a contact patch feels it; without a `period` [m] the shortest that is at least 1000 m and holds
    /// the longest wave, with a whole number of grid points per shortest wave.
    pub fn new(spectrum: Spectrum, patch: Patch, period: Option<f64>) -> Result<Self, Error> {
        let _mode = Standard::set();
        let [lowest, highest] = spectrum.band();
        let per_metre = POINTS_PER_WAVE * highest;
        // Not more points for a product that rounding lifts above a power of two.
        let wanted = |period: f64| (period * per_metre * (1.0 - 1e-12)).ceil();
        let given = period.map(|period| positive("period", period)).transpose()?;
        if let Some(period) = given
            && period < 1.0 / lowest
        {
            let allowed = format!("must hold the longest wave: {} m or more", 1.0 / lowest);
            return Err(Error::input("period", format!("{period} m"), allowed));
        }
        let wanted = wanted(given.unwrap_or(PERIOD.max(1.0 / lowest)));
        if wanted > MOST_POINTS as f64 {
            let allowed = format!("a road has at most {MOST_POINTS} grid points, four per shortest wave");
            let (key, length) = given.map_or(("band", 1.0 / lowest), |period| ("period", period));
            let value = format!("{length} m with waves of {} m", 1.0 / highest);
            return Err(Error::input(key, value, allowed));
        }
        let points = (wanted as usize).next_power_of_two().max(FEWEST_POINTS);
        let period = given.unwrap_or(points as f64 / per_metre);
        let (first, last) = ((lowest * period).round() as usize, (highest * period).round() as usize);
        let amplitudes = |m: usize| {
            let power = spectrum.power((m as f64 - 0.5) / period, (m as f64 + 0.5) / period);
            let spline = sinc(m as f64 / points as f64);
            let spline = spline * spline;
            // Two conjugate components share the wave: each has half of its amplitude √(2 power).
            let amplitude = (0.5 * power).sqrt() * sinc(m as f64 / period * patch.length()) / (spline * spline);
            let (sine, cosine) = sin_cos(0.5 * m as f64 / points as f64 + 0.125);
            [2.0 * amplitude * cosine, 2.0 * amplitude * sine]
        };
        let amplitudes = (first..=last).map(amplitudes).collect();
        Ok(Synthesis { spectrum, patch, period, first, amplitudes, fft: InverseFft::new(points / 2) })
    }

    /// Period [m].
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Number of grid points in a period.
    pub fn points(&self) -> usize {
        2 * self.fft.points()
    }

    /// How rough its roads are.
    pub fn texture(&self) -> Texture {
        self.spectrum.texture(self.patch.length())
    }

    /// The road of a seed and a sample number: a function of these alone.
    pub fn road(&self, seed: u64, sample: u64) -> Random {
        let _mode = Standard::set();
        let spline = Spline::new(self.coefficients(seed, |_| sample), self.period);
        Random { spectrum: self.spectrum, patch: self.patch, seed, sample, spline }
    }

    /// Spline coefficients of the roads of several samples, one in each lane [m].
    #[inline(always)]
    pub fn coefficients<L: Lane>(&self, seed: u64, sample: impl Fn(usize) -> u64) -> Vec<L> {
        let mut coefficients = Vec::new();
        self.coefficients_into(seed, sample, &mut coefficients);
        coefficients
    }

    /// The same into a vector that has been used before, or not; whatever it holds is lost.
    #[inline(always)]
    pub fn coefficients_into<L: Lane>(&self, seed: u64, sample: impl Fn(usize) -> u64, coefficients: &mut Vec<L>) {
        coefficients.resize(self.points(), L::splat(0.0));
        let (pairs, _) = coefficients.as_chunks_mut();
        self.components(seed, sample, pairs);
        self.fft.transform(pairs);
    }

    /// Transform of pairs of coefficients, each component at its place.
    #[inline(always)]
    fn components<L: Lane>(&self, seed: u64, sample: impl Fn(usize) -> u64, z: &mut [Complex<L>]) {
        let n = self.fft.points();
        let end = self.first + self.amplitudes.len();
        let [key1, key0] = words(seed);
        let sample0 = L::Bits::from_fn(sample);
        let sample1 = sample0.down(32);
        for m in (0..self.first).chain(end..n - end + 1).chain(n - self.first + 1..n) {
            z[self.fft.place(m)] = [L::splat(0.0); 2];
        }
        let half_step = HALF_TURN / self.points() as u64;
        for block in self.first / 4..end.div_ceil(4) {
            let counter = [L::Bits::splat(block as u64), L::Bits::splat(PHASES), sample0, sample1];
            let random = philox4x32_lanes(counter, [key0, key1]);
            for (m, word) in (4 * block..).zip(random) {
                if (self.first..end).contains(&m) {
                    let alpha = HALF_TURN / 4 + m as u64 * half_step;
                    let (sine, cosine) = sin_cos_of_words::<L>(word.plus(L::Bits::splat(alpha)));
                    let [near, far] = self.amplitudes[m - self.first].map(L::splat);
                    z[self.fft.place(m)] = [near * cosine, near * sine];
                    // At m = N/4 both are one component: near is 0, far all of it.
                    z[self.fft.place(n - m)] = [far * sine, far * cosine];
                }
            }
        }
    }
}

/// One realisation, periodic in x.
#[derive(Debug, Clone, PartialEq)]
pub struct Random {
    spectrum: Spectrum,
    patch: Patch,
    seed: u64,
    sample: u64,
    spline: Spline,
}

impl Random {
    /// Period [m].
    pub fn period(&self) -> f64 {
        self.spline.period()
    }

    /// Number of grid points in a period.
    pub fn points(&self) -> usize {
        self.spline.coefficients().len()
    }

    /// The same road under another contact patch.
    pub fn under(&self, patch: Patch) -> Result<Self, Error> {
        Ok(Synthesis::new(self.spectrum, patch, Some(self.period()))?.road(self.seed, self.sample))
    }

    /// How rough such roads are.
    pub fn texture(&self) -> Texture {
        self.spectrum.texture(self.patch.length())
    }

    /// Its highest wave number [cycle/m].
    pub fn highest(&self) -> f64 {
        self.spectrum.band()[1]
    }

    /// Elevation, slope and curvature at x.
    pub fn at(&self, x: f64) -> Point {
        self.spline.at(x)
    }
}
