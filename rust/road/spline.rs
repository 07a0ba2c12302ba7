//! A periodic function as cubic B-splines on a uniform grid: smooth to the second derivative, four taps a point.

use super::Point;

/// r(x) = Σ c_j B(x/Δ − j), with as many coefficients in a period as a power of two.
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    coefficients: Vec<f64>,
    period: f64,
}

impl Spline {
    /// From the coefficients over a period [m].
    pub fn new(coefficients: Vec<f64>, period: f64) -> Self {
        assert!(coefficients.len().is_power_of_two(), "the number of coefficients must be a power of two");
        Spline { coefficients, period }
    }

    /// Coefficients over a period, the first at x = 0 [m].
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Period [m].
    pub fn period(&self) -> f64 {
        self.period
    }

    /// The function and its derivatives at any x.
    pub fn at(&self, x: f64) -> Point {
        let per_metre = self.coefficients.len() as f64 / self.period;
        let position = x * per_metre;
        let cell = position.floor();
        let t = position - cell;
        let first = (cell as i64).wrapping_sub(1) as usize;
        let mask = self.coefficients.len() - 1;
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| self.coefficients[first.wrapping_add(k) & mask]);
        // The cubic of the cell in powers of t: B-splines have the values (1, 4, 1)/6 at the grid points.
        let c0 = (a + 4.0 * b + c) * (1.0 / 6.0);
        let c1 = (c - a) * 0.5;
        let c2 = (a - 2.0 * b + c) * 0.5;
        let c3 = (d - a + 3.0 * (b - c)) * (1.0 / 6.0);
        Point {
            elevation: c0 + t * (c1 + t * (c2 + t * c3)),
            slope: (c1 + t * (2.0 * c2 + t * 3.0 * c3)) * per_metre,
            curvature: (2.0 * c2 + t * 6.0 * c3) * per_metre * per_metre,
        }
    }
}
