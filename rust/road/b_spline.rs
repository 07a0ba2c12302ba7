//! A periodic function as cubic B-splines on a uniform grid: smooth to the second derivative, four taps a point.

use super::point::Point;
use crate::lane::Lane;

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
        let taps = self.taps(x);
        let mask = self.coefficients.len() - 1;
        let near = [0, 1, 2, 3].map(|k| self.coefficients[taps.first.wrapping_add(k) & mask]);
        let [elevation, slope, curvature] = taps.weights.map(|weights| weighted(weights, near));
        Point { elevation, slope, curvature }
    }

    /// Which coefficients count at x, and how much: the same for every function on this grid.
    pub fn taps(&self, x: f64) -> Taps {
        Taps::new(x, self.coefficients.len(), self.period)
    }
}

/// Four neighbouring coefficients and their weights in value, slope and curvature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Taps {
    /// Number of the first, to be taken modulo the number of coefficients.
    pub first: usize,
    /// Weights of the four in value, slope and curvature.
    pub weights: [[f64; 4]; 3],
}

impl Taps {
    /// At x, on a grid of so many points in a period [m].
    pub fn new(x: f64, points: usize, period: f64) -> Self {
        let per_metre = points as f64 / period;
        let position = x * per_metre;
        let cell = position.floor();
        Taps { first: first(cell), weights: weights(position - cell, per_metre) }
    }
}

/// Number of the first of the four coefficients that count in a cell of the grid.
#[inline(always)]
pub fn first(cell: f64) -> usize {
    (cell as i64).wrapping_sub(1) as usize
}

/// Weights of these four in value, slope and curvature where a cell has been gone through as far as t, of so many per metre.
#[inline(always)]
pub fn weights<L: Lane>(t: L, per_metre: f64) -> [[L; 4]; 3] {
    let [half, one_and_half, two, three, four, six] = [0.5, 1.5, 2.0, 3.0, 4.0, 6.0].map(L::splat);
    // B-splines have the values (1, 4, 1)/6 at the grid points.
    let (s, sixth, per_metre) = (L::splat(1.0) - t, L::splat(1.0 / 6.0), L::splat(per_metre));
    let value = [
        s * s * s * sixth,
        (four + t * t * (three * t - six)) * sixth,
        (four + s * s * (three * s - six)) * sixth,
        t * t * t * sixth,
    ];
    let [a, b, c, d] = [-half * s * s, t * (one_and_half * t - two), s * (two - one_and_half * s), half * t * t];
    let slope = [a * per_metre, b * per_metre, c * per_metre, d * per_metre];
    let [a, b, c, d] = [s, three * t - two, three * s - two, t];
    let curvature =
        [a * per_metre * per_metre, b * per_metre * per_metre, c * per_metre * per_metre, d * per_metre * per_metre];
    [value, slope, curvature]
}

/// Four numbers with their weights.
#[inline(always)]
pub fn weighted<L: Lane>(weights: [f64; 4], near: [L; 4]) -> L {
    let [of_a, of_b, of_c, of_d] = weights;
    sum([L::splat(of_a), L::splat(of_b), L::splat(of_c), L::splat(of_d)], near)
}

/// The same with weights of each lane.
#[inline(always)]
pub fn sum<L: Lane>(weights: [L; 4], near: [L; 4]) -> L {
    let [a, b, c, d] = near;
    let [of_a, of_b, of_c, of_d] = weights;
    (of_a * a + of_b * b) + (of_c * c + of_d * d)
}
