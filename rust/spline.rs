//! Cubics from point to point, and the splines made of them.

/// A cubic c₀ + c₁t + c₂t² + c₃t³ by its coefficients.
pub type Cubic = [f64; 4];

/// Value of a cubic at t.
#[inline(always)]
pub fn value([c0, c1, c2, c3]: Cubic, t: f64) -> f64 {
    c0 + t * (c1 + t * (c2 + t * c3))
}

/// First derivative of a cubic at t.
#[inline(always)]
pub fn slope([_, c1, c2, c3]: Cubic, t: f64) -> f64 {
    c1 + t * (2.0 * c2 + t * 3.0 * c3)
}

/// Second derivative of a cubic at t.
#[inline(always)]
pub fn curvature([_, _, c2, c3]: Cubic, t: f64) -> f64 {
    2.0 * c2 + t * 6.0 * c3
}

/// The cubic from 0 to 1 with these values and slopes at its ends.
#[inline(always)]
pub fn between([a, b]: [f64; 2], [s, t]: [f64; 2]) -> Cubic {
    [a, s, 3.0 * (b - a) - 2.0 * s - t, 2.0 * (a - b) + s + t]
}

/// What is known of a spline at one of its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// No curvature: the natural spline.
    Natural,
    /// A known slope.
    Slope(f64),
    /// The same cubic on both sides of the point next to the end.
    NotAKnot,
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
    let not_a_knot = |end: usize, next: usize| {
        let (near, far) = (h(end), h(next));
        let right = ((3.0 * near + 2.0 * far) * far * chord(end) + near * near * chord(next)) / (near + far);
        (far, near + far, right)
    };
    let row = |i: usize| match (i, ends) {
        (0, [End::NotAKnot, _]) => {
            let (diagonal, above, right) = not_a_knot(0, 1);
            [0.0, diagonal, above, right]
        }
        (i, [_, End::NotAKnot]) if i == n - 1 => {
            let (diagonal, below, right) = not_a_knot(n - 2, n - 3);
            [below, diagonal, 0.0, right]
        }
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
