//! The line from which a vehicle feels a road, so that neither its height above the sea nor its grade counts.

use super::point::Point;

/// Places to which a line is fitted.
const PLACES: usize = 50;

/// A straight line, r(x) = elevation + slope (x − start).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Datum {
    start: f64,
    elevation: f64,
    /// Its slope along the bridge [-].
    pub slope: f64,
}

impl Datum {
    /// The least-squares line of elevations [m] at even spacing from `start` to `end` [m].
    pub fn fitted(start: f64, end: f64, elevation: impl Fn(f64) -> f64) -> Self {
        let spacing = (end - start) / (PLACES - 1) as f64;
        // Counted from the first, so that a height takes no digits.
        let (first, middle) = (elevation(start), 0.5 * (PLACES - 1) as f64);
        let (mut sum, mut moment, mut square) = (0.0, 0.0, 0.0);
        for k in 0..PLACES {
            let (off, from_middle) = (elevation(start + k as f64 * spacing) - first, k as f64 - middle);
            sum += off;
            moment += from_middle * off;
            square += from_middle * from_middle;
        }
        let per_place = moment / square;
        Datum { start, elevation: first + sum / PLACES as f64 - per_place * middle, slope: per_place / spacing }
    }

    /// Higher by so much [m].
    pub fn raised(self, height: f64) -> Self {
        Datum { elevation: self.elevation + height, ..self }
    }

    /// Whether it is the level at zero.
    pub fn is_zero(&self) -> bool {
        self.elevation == 0.0 && self.slope == 0.0
    }

    /// What taking it off a road adds at x.
    pub fn taken_off(&self, x: f64) -> Point {
        Point { elevation: -self.elevation - self.slope * (x - self.start), slope: -self.slope, curvature: 0.0 }
    }
}
