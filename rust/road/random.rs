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

use super::Point;
use super::fft::InverseFft;
use super::patch::Patch;
use super::philox::{philox4x32, words};
use super::spectrum::Spectrum;
use super::spline::Spline;
use super::turn::{sin_cos, sinc};
use crate::error::{Error, positive};
use crate::lane::Lane;

/// Shortest default period [m].
const PERIOD: f64 = 1000.0;

/// Grid points per shortest wave.
const POINTS_PER_WAVE: f64 = 4.0;

/// Most grid points; a road of them takes 32 MiB.
const MOST_POINTS: usize = 1 << 22;

/// What the words of the generator are drawn for, so that other draws under the same seed are others.
const PHASES: u32 = 0;

/// A whole turn in units of the generator's words.
const WORDS_PER_TURN: f64 = 4_294_967_296.0;

/// All that roads of one spectrum share: amplitudes and tables.
#[derive(Debug, Clone, PartialEq)]
pub struct Synthesis {
    spectrum: Spectrum,
    patch: Patch,
    period: f64,
    /// Number m of the first wave.
    first: usize,
    /// Half amplitudes of the B-spline coefficients, from the first wave on [m].
    amplitudes: Vec<f64>,
    fft: InverseFft,
}

impl Synthesis {
    /// For a spectrum as a contact patch feels it; without a `period` [m] the shortest that is at least 1000 m and holds
    /// the longest wave, with a whole number of grid points per shortest wave.
    pub fn new(spectrum: Spectrum, patch: Patch, period: Option<f64>) -> Result<Self, Error> {
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
        let points = (wanted as usize).next_power_of_two();
        let period = given.unwrap_or(points as f64 / per_metre);
        let (first, last) = ((lowest * period).round() as usize, (highest * period).round() as usize);
        let amplitude = |m: usize| {
            let power = spectrum.power((m as f64 - 0.5) / period, (m as f64 + 0.5) / period);
            let spline = sinc(m as f64 / points as f64);
            let spline = spline * spline;
            // Two conjugate components share the wave: each has half of its amplitude √(2 power).
            (0.5 * power).sqrt() * sinc(m as f64 / period * patch.length()) / (spline * spline)
        };
        let amplitudes = (first..=last).map(amplitude).collect();
        Ok(Synthesis { spectrum, patch, period, first, amplitudes, fft: InverseFft::new(points) })
    }

    /// Period [m].
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Number of grid points in a period.
    pub fn points(&self) -> usize {
        self.fft.points()
    }

    /// Spline coefficients of the roads of several samples, one in each lane.
    pub fn coefficients<L: Lane>(&self, seed: u64, sample: impl Fn(usize) -> u64) -> Vec<L> {
        let half = self.fft.points() / 2;
        let components: Vec<[Vec<f64>; 2]> = (0..L::SAMPLES)
            .map(|lane| {
                let mut parts = [vec![0.0; half + 1], vec![0.0; half + 1]];
                let [re, im] = &mut parts;
                self.components(seed, sample(lane), re, im);
                parts
            })
            .collect();
        let gathered = |part: usize| (0..=half).map(|m| L::from_fn(|lane| components[lane][part][m])).collect();
        let (mut re, mut im): (Vec<L>, Vec<L>) = (gathered(0), gathered(1));
        self.fft.real(&mut re, &mut im);
        re[..half].iter().zip(&im[..half]).flat_map(|(even, odd)| [*even, *odd]).collect()
    }

    /// The road of a seed and a sample number: a function of these alone.
    pub fn road(&self, seed: u64, sample: u64) -> Random {
        let half = self.fft.points() / 2;
        let (mut re, mut im) = (vec![0.0; half + 1], vec![0.0; half + 1]);
        self.components(seed, sample, &mut re, &mut im);
        self.fft.real(&mut re, &mut im);
        let coefficients = re[..half].iter().zip(&im[..half]).flat_map(|(even, odd)| [*even, *odd]).collect();
        Random {
            spectrum: self.spectrum,
            patch: self.patch,
            seed,
            sample,
            spline: Spline::new(coefficients, self.period),
        }
    }

    /// Spectrum of the B-spline coefficients, into zeros.
    fn components(&self, seed: u64, sample: u64, re: &mut [f64], im: &mut [f64]) {
        let ([key1, key0], [sample1, sample0]) = (words(seed), words(sample));
        let end = self.first + self.amplitudes.len();
        for block in self.first / 4..end.div_ceil(4) {
            let random = philox4x32([block as u32, PHASES, sample0, sample1], [key0, key1]);
            for (m, word) in (4 * block..).zip(random) {
                if (self.first..end).contains(&m) {
                    let (sine, cosine) = sin_cos(f64::from(word) / WORDS_PER_TURN);
                    let amplitude = self.amplitudes[m - self.first];
                    (re[m], im[m]) = (amplitude * cosine, amplitude * sine);
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

    /// Elevation, slope and curvature at x.
    pub fn at(&self, x: f64) -> Point {
        self.spline.at(x)
    }
}
