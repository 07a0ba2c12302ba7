//! Measured roads: a cubic spline through points at any spacing.
//!
//! The spline is twice continuously differentiable, the smoothest curve through the points, and reproduces waves down to
//! a few points long better than cubics with slopes from neighbouring points, which flatten them: a measured profile
//! has most of its slope and curvature there. The third derivative is continuous at the second point and the last but
//! one ("not a knot"), so that nothing is assumed about the ends and cubics are reproduced.

use super::patch::{Curve, Patch};
use super::point::Point;
use super::texture::Texture;
use crate::error::{Error, finite, positive};
use crate::float_mode::Standard;
use crate::memory;
use crate::spline::{self, Cubic, End, between, spline_slopes};

/// Fewest points that determine a cubic.
const FEWEST: usize = 4;

/// Largest spacing without a `max_gap`, in median spacings.
const GAP: f64 = 5.0;

/// Numbers for each point while the spline is made, twelve at most, and what is kept of them [bytes].
const POINT: usize = 12 * size_of::<f64>();

/// Places at which the slopes of a profile are looked at.
const SLOPES: usize = 1024;

/// Stretches of a way, the roughest of which counts.
const STRETCHES: usize = 8;

/// Part of a section that must be measured as finely as its spacing says.
const MOST_OF_IT: f64 = 0.9;

/// A measured profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    x: Vec<f64>,
    /// Elevation of the first point [m], which all others are counted from: digits that a height above the sea would take.
    base: f64,
    /// The cubic from each point to the next in powers of the distance from the point [m].
    cubics: Vec<[f64; 4]>,
    /// Integral of the elevation from the first point to each [m²].
    integrals: Vec<f64>,
    patch: Patch,
}

impl Profile {
    /// Through elevations [m] at x [m], which must increase by no more than `max_gap` [m] (five median spacings
    /// without); `detrend` takes off their least-squares line.
    pub fn new(
        x: Vec<f64>,
        mut elevation: Vec<f64>,
        detrend: bool,
        patch: Patch,
        max_gap: Option<f64>,
    ) -> Result<Self, Error> {
        let _mode = Standard::set();
        let bytes = (POINT * x.len()) as f64;
        memory::check("x", format!("{} points", x.len()), bytes, f64::INFINITY, "their spline", "use fewer")?;
        check(&x, &elevation, max_gap)?;
        if detrend {
            take_off_line(&x, &mut elevation);
        }
        let base = elevation[0];
        elevation.iter_mut().for_each(|r| *r -= base);
        let cubics = cubics(&x, &elevation);
        Ok(Self::of(x, base, cubics, patch))
    }

    /// Of cubics from point to point above a base [m].
    fn of(x: Vec<f64>, base: f64, cubics: Vec<[f64; 4]>, patch: Patch) -> Self {
        let mut integrals = vec![0.0];
        for (piece, [a, b, c, d]) in x.windows(2).zip(&cubics) {
            let h = piece[1] - piece[0];
            let area = h * (a + h * (b / 2.0 + h * (c / 3.0 + h * d / 4.0)));
            integrals.push(integrals[integrals.len() - 1] + area);
        }
        Profile { x, base, cubics, integrals, patch }
    }

    /// How rough it is from `from` to `to` [m], where it is rougher than elsewhere on that way: its slopes off their mean,
    /// and its finest points.
    pub fn texture(&self, from: f64, to: f64) -> Texture {
        let [first, last] = self.ends();
        let (from, to) = (from.clamp(first, last), to.clamp(first, last));
        let slope = |i: usize| self.at(from + (to - from) * (i as f64 + 0.5) / SLOPES as f64).slope;
        let slopes: Vec<f64> = (0..SLOPES).map(slope).collect();
        let mean = slopes.iter().sum::<f64>() / SLOPES as f64;
        let power = |some: &[f64]| some.iter().map(|slope| (slope - mean).powi(2)).sum::<f64>() / some.len() as f64;
        let slope_power = slopes.chunks(SLOPES / STRETCHES).map(power).fold(0.0, f64::max);
        Texture { slope_power, highest: 0.5 / self.spacing(from, to), ..Texture::SMOOTH }
    }

    /// The same under another contact patch.
    pub fn under(&self, patch: Patch) -> Self {
        Profile { patch, ..self.clone() }
    }

    /// The straight lines from point to point under a contact patch, from elevation 0 on.
    pub fn chords(&self, patch: Patch) -> Self {
        let mut elevation: Vec<f64> = self.cubics.iter().map(|cubic| cubic[0]).collect();
        elevation.push(self.curve(self.ends()[1]).elevation);
        let rise = |(x, r): (&[f64], &[f64])| [r[0], (r[1] - r[0]) / (x[1] - x[0]), 0.0, 0.0];
        Self::of(self.x.clone(), 0.0, self.x.windows(2).zip(elevation.windows(2)).map(rise).collect(), patch)
    }

    /// The spacing [m] that is not exceeded over nine tenths of the way from `from` to `to` [m]: single gaps do not
    /// count, a coarse part of a survey does.
    pub fn spacing(&self, from: f64, to: f64) -> f64 {
        let points = self.x.len();
        let first = self.x.partition_point(|&x| x <= from).saturating_sub(1).min(points - 2);
        let end = (self.x.partition_point(|&x| x < to) + 1).clamp(first + 2, points);
        let mut spacings: Vec<f64> = self.x[first..end].windows(2).map(|pair| pair[1] - pair[0]).collect();
        spacings.sort_unstable_by(f64::total_cmp);
        let mut left = MOST_OF_IT * (self.x[end - 1] - self.x[first]);
        let exceeded = |spacing: &&f64| {
            left -= **spacing;
            left > 0.0
        };
        let within = spacings.iter().take_while(exceeded).count();
        spacings[within.min(spacings.len() - 1)]
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.x.len()
    }

    /// First and last x [m].
    pub fn ends(&self) -> [f64; 2] {
        [self.x[0], self.x[self.x.len() - 1]]
    }

    /// Elevation, slope and curvature at x, averaged over the contact patch.
    pub fn at(&self, x: f64) -> Point {
        let point = self.patch.average(|x| self.curve(x), x);
        Point { elevation: point.elevation + self.base, ..point }
    }

    /// The spline above the first point; beyond its ends, where half a contact patch may reach, its tangents.
    fn curve(&self, x: f64) -> Curve {
        let [first, last] = self.ends();
        let inside = x.clamp(first, last);
        let piece = self.x[1..self.cubics.len()].partition_point(|&each| each <= inside);
        let cubic @ [a, b, c, d] = self.cubics[piece];
        let t = inside - self.x[piece];
        let (elevation, slope) = (spline::value(cubic, t), spline::slope(cubic, t));
        let integral = self.integrals[piece] + t * (a + t * (b / 2.0 + t * (c / 3.0 + t * d / 4.0)));
        let beyond = x - inside;
        Curve {
            integral: integral + beyond * (elevation + 0.5 * beyond * slope),
            elevation: elevation + beyond * slope,
            slope,
            curvature: if beyond == 0.0 { spline::curvature(cubic, t) } else { 0.0 },
        }
    }
}

fn check(x: &[f64], elevation: &[f64], max_gap: Option<f64>) -> Result<(), Error> {
    if x.len() != elevation.len() {
        let allowed = format!("must be one for each x, {}", x.len());
        return Err(Error::input("elevations", format!("{} values", elevation.len()), allowed));
    }
    if x.len() < FEWEST {
        return Err(Error::input("x", format!("{} points", x.len()), format!("must be {FEWEST} or more")));
    }
    // A name for each of millions of points would take longer than the spline.
    if let Some(k) = x.iter().zip(elevation).position(|(x, elevation)| !(x.is_finite() && elevation.is_finite())) {
        finite(format!("x[{k}]"), x[k])?;
        finite(format!("elevations[{k}]"), elevation[k])?;
    }
    for (k, pair) in x.windows(2).enumerate() {
        if pair[1] <= pair[0] {
            let allowed = format!("x must increase from point to point: must be greater than x[{k}] = {} m", pair[0]);
            return Err(Error::input(format!("x[{}]", k + 1), format!("{} m", pair[1]), allowed));
        }
    }
    let limit = match max_gap {
        Some(gap) => positive("max_gap", gap)?,
        None => {
            let mut spacings: Vec<f64> = x.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let middle = spacings.len() / 2;
            GAP * *spacings.select_nth_unstable_by(middle, f64::total_cmp).1
        }
    };
    for (k, pair) in x.windows(2).enumerate() {
        let gap = pair[1] - pair[0];
        if gap > limit {
            let allowed =
                format!("{gap} m from the point before, x[{k}] = {} m: must be at most max_gap = {limit} m", pair[0]);
            return Err(Error::input(format!("x[{}]", k + 1), format!("{} m", pair[1]), allowed));
        }
    }
    Ok(())
}

/// Takes the least-squares line off the elevations.
fn take_off_line(x: &[f64], elevation: &mut [f64]) {
    let n = x.len() as f64;
    let middle = x.iter().sum::<f64>() / n;
    let mean = elevation.iter().sum::<f64>() / n;
    let moment: f64 = x.iter().zip(&*elevation).map(|(x, r)| (x - middle) * (r - mean)).sum();
    let square: f64 = x.iter().map(|x| (x - middle) * (x - middle)).sum();
    for (x, r) in x.iter().zip(elevation) {
        *r -= mean + moment / square * (x - middle);
    }
}

/// The cubics of the spline, each by the way from its first point [m].
fn cubics(x: &[f64], elevation: &[f64]) -> Vec<Cubic> {
    let slopes = spline_slopes(x, elevation, [End::NotAKnot; 2]);
    let cubic = |k: usize| {
        let h = x[k + 1] - x[k];
        let [a, b, c, d] = between([elevation[k], elevation[k + 1]], [h * slopes[k], h * slopes[k + 1]]);
        [a, b / h, c / (h * h), d / (h * h * h)]
    };
    (0..slopes.len() - 1).map(cubic).collect()
}
