//! Cubic lines from values at points: by their slopes where these are known, else by the natural spline.

use crate::line::{Line, Mesh};

/// Values and slopes of a line just left and just right of every node.
#[derive(Debug, Clone, PartialEq)]
pub struct Sides {
    /// Left, then right.
    pub values: [Vec<f64>; 2],
    /// Left, then right.
    pub slopes: [Vec<f64>; 2],
}

impl Sides {
    /// Of a line without jump or kink.
    pub fn smooth(values: Vec<f64>, slopes: Vec<f64>) -> Self {
        Sides { values: [values.clone(), values], slopes: [slopes.clone(), slopes] }
    }

    /// The cubics that have them.
    pub fn line(&self, mesh: &Mesh) -> Line {
        let cubic = |panel: usize| {
            let h = mesh.width(panel);
            let (a, b) = (self.values[1][panel], self.values[0][panel + 1]);
            let (s, t) = (h * self.slopes[1][panel], h * self.slopes[0][panel + 1]);
            [a, s, 3.0 * (b - a) - 2.0 * s - t, 2.0 * (a - b) + s + t]
        };
        Line::from_cubics((0..mesh.panels()).map(cubic).collect())
    }
}

/// What is known of a spline at one of its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// No curvature: the natural spline.
    Natural,
    /// A known slope.
    Slope(f64),
}

/// Slopes at the knots `x` of the cubic spline through `values`.
///
/// Of a deflected shape with EI constant and no load between the knots it is exact; else its error falls with the fourth
/// power of their distance, and with the square next to where EI or the curvature jumps.
pub fn spline_slopes(x: &[f64], values: &[f64], ends: [End; 2]) -> Vec<f64> {
    let n = x.len();
    if n == 1 {
        return vec![0.0];
    }
    let h = |i: usize| x[i + 1] - x[i];
    let chord = |i: usize| (values[i + 1] - values[i]) / h(i);
    // Rows (below, diagonal, above, right side) of a tridiagonal system in which the diagonal prevails.
    let row = |i: usize| match (i, ends) {
        (0, [End::Slope(slope), _]) => [0.0, 1.0, 0.0, slope],
        (0, [End::Natural, _]) => [0.0, 1.0, 0.5, 1.5 * chord(0)],
        (i, [_, End::Slope(slope)]) if i == n - 1 => [0.0, 1.0, 0.0, slope],
        (i, [_, End::Natural]) if i == n - 1 => [0.5, 1.0, 0.0, 1.5 * chord(n - 2)],
        _ => {
            let (left, right) = (1.0 / h(i - 1), 1.0 / h(i));
            [left, 2.0 * (left + right), right, 3.0 * (chord(i - 1) * left + chord(i) * right)]
        }
    };
    let (mut above, mut slopes) = (vec![0.0; n], vec![0.0; n]);
    for i in 0..n {
        let [below, diagonal, next, right] = row(i);
        let (before, solved) = if i == 0 { (0.0, 0.0) } else { (above[i - 1], slopes[i - 1]) };
        let pivot = diagonal - below * before;
        above[i] = next / pivot;
        slopes[i] = (right - below * solved) / pivot;
    }
    for i in (0..n - 1).rev() {
        slopes[i] -= above[i] * slopes[i + 1];
    }
    slopes
}
