//! The contact patch of a tyre: a moving average of the road, exact through its antiderivative.

use super::point::Point;
use crate::error::{Error, not_negative};

/// A curve at one place, with its antiderivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    /// Integral of the elevation from anywhere to here [m²].
    pub integral: f64,
    /// Elevation [m].
    pub elevation: f64,
    /// Slope [-].
    pub slope: f64,
    /// Curvature [1/m].
    pub curvature: f64,
}

/// Length over which a tyre averages the road [m]; 0 where it follows the road as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch(f64);

impl Patch {
    /// Of a length [m].
    pub fn new(length: f64) -> Result<Self, Error> {
        Ok(Patch(not_negative("contact_patch", length)?))
    }

    /// Length [m].
    pub fn length(self) -> f64 {
        self.0
    }

    /// The average of a curve over the patch centred at x, and its derivatives.
    pub fn average(self, curve: impl Fn(f64) -> Curve, x: f64) -> Point {
        if self.0 == 0.0 {
            let Curve { elevation, slope, curvature, .. } = curve(x);
            return Point { elevation, slope, curvature };
        }
        let (rear, front) = (curve(x - 0.5 * self.0), curve(x + 0.5 * self.0));
        Point {
            elevation: (front.integral - rear.integral) / self.0,
            slope: (front.elevation - rear.elevation) / self.0,
            curvature: (front.slope - rear.slope) / self.0,
        }
    }
}
