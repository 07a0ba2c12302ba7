//! Cubic lines from values at points: by their slopes where these are known, else by the natural spline.

use faer::Mat;
use faer::linalg::solvers::Solve;

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
    let mut matrix = Mat::<f64>::zeros(n, n);
    let mut right = Mat::<f64>::zeros(n, 1);
    for (i, end) in [(0, ends[0]), (n - 1, ends[1])] {
        matrix[(i, i)] = 1.0;
        match end {
            End::Slope(slope) => right[(i, 0)] = slope,
            End::Natural => {
                let (other, panel) = if i == 0 { (1, 0) } else { (n - 2, n - 2) };
                matrix[(i, other)] = 0.5;
                right[(i, 0)] = 1.5 * chord(panel);
            }
        }
    }
    for i in 1..n - 1 {
        matrix[(i, i - 1)] = 1.0 / h(i - 1);
        matrix[(i, i)] = 2.0 / h(i - 1) + 2.0 / h(i);
        matrix[(i, i + 1)] = 1.0 / h(i);
        right[(i, 0)] = 3.0 * (chord(i - 1) / h(i - 1) + chord(i) / h(i));
    }
    let slopes = matrix.partial_piv_lu().solve(&right);
    slopes.col(0).iter().copied().collect()
}
