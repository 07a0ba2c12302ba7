//! The line from which a vehicle feels a road, so that neither its height above the sea nor its grade counts.

use super::point::Point;

/// A straight line, r(x) = elevation + slope (x − start).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Datum {
    start: f64,
    elevation: f64,
    /// Its slope along the bridge [-].
    pub slope: f64,
}

impl Datum {
    /// Through two points (x, r) [m], the first at the start of a way.
    pub fn through([start, elevation]: [f64; 2], [far, beyond]: [f64; 2]) -> Self {
        Datum { start, elevation, slope: (beyond - elevation) / (far - start) }
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
