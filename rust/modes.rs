//! Natural modes from the flexibility, which is never inverted: M^½ F M^½ ψ = ω⁻² ψ, φ = M^-½ ψ.

use faer::{Mat, Side};

use crate::bridge::Bridge;
use crate::bridge::cubics::Line;
use crate::error::Error;
use crate::float_mode::Standard;
use crate::memory;
use crate::statics::flexibility::{Action, Actions, Flexibility, Structure};

/// Residual and orthogonality demanded of every solve, relative to the largest eigenvalue and to one.
const TOLERANCE: f64 = 1e-10;

/// Eigenvalues closer than this, relative to their own size, belong to one repeated frequency: their vectors are then
/// fixed by a rule instead of by rounding. It is well inside [`TOLERANCE`], so the turned vectors still pass.
const REPEATED: f64 = 1e-12;

/// Undamped natural modes, lowest frequency first, φᵀMφ = 1.
///
/// Sign: the component of the largest magnitude is positive (the leftmost, of those within one part in 10⁶).
#[derive(Debug, Clone)]
pub struct Modes {
    /// Natural circular frequencies [rad/s].
    pub omega: Vec<f64>,
    /// Mode shapes at the mass stations, one column per mode [kg^-½].
    pub shapes: Mat<f64>,
}

impl Modes {
    /// The lowest `count` modes.
    pub fn new(bridge: &Bridge, flexibility: &Flexibility, count: usize) -> Result<Self, Error> {
        let _mode = Standard::set();
        let stations = bridge.stations();
        let n = stations.len();
        if count == 0 || count > n {
            return Err(Error::input("modes", count, format!("must be 1 to {n}, the number of masses that can move")));
        }
        check_matrices(n)?;
        let nodes: Vec<usize> = stations.iter().map(|s| flexibility.mesh().node_at(s.at)).collect();
        let masses: Vec<f64> = stations.iter().map(|s| s.mass).collect();
        Modes::of_matrices(&flexibility.matrix(&nodes, &nodes, Structure::Actual), &masses, count)
    }

    /// The lowest `count` modes of masses [kg] on a beam of flexibility F at them [m/N].
    pub fn of_matrices(f: &Mat<f64>, masses: &[f64], count: usize) -> Result<Self, Error> {
        let n = masses.len();
        if count == 0 || count > n {
            return Err(Error::input("modes", count, format!("must be 1 to {n}, the number of masses that can move")));
        }
        check_matrices(n)?;
        let root: Vec<f64> = masses.iter().map(|m| m.sqrt()).collect();
        // F is symmetric by Maxwell; rounding is taken out so that either triangle says the same.
        let a = Mat::from_fn(n, n, |i, j| root[i] * 0.5 * (f[(i, j)] + f[(j, i)]) * root[j]);

        let eigen = a.self_adjoint_eigen(Side::Lower).map_err(|e| Error::Modes(format!("no convergence: {e:?}")))?;
        // Ascending eigenvalues ω⁻²: the lowest modes come last.
        let values: Vec<f64> = (0..n).rev().map(|i| eigen.S().column_vector()[i]).collect();
        let mut psi = Mat::from_fn(n, n, |i, j| eigen.U()[(i, n - 1 - j)]);
        let rounding = n as f64 * f64::EPSILON * values[0];
        if values[count - 1].is_nan() || values[count - 1] <= rounding {
            let resolved = values.iter().take_while(|&&v| v > rounding).count();
            return Err(Error::Modes(format!(
                "mode {count} is lost in rounding (eigenvalue {:.2e} of {:.2e}); ask for {resolved} modes or fewer",
                values[count - 1],
                values[0]
            )));
        }
        fix_repeated(&values, &mut psi);
        let psi = psi.subcols(0, count).to_owned();
        check(&a, &values[..count], &psi)?;

        let omega = values[..count].iter().map(|v| 1.0 / v.sqrt()).collect();
        let mut shapes = Mat::from_fn(n, count, |i, j| psi[(i, j)] / root[i]);
        for j in 0..count {
            let largest = (0..n).fold(0.0_f64, |m, i| m.max(shapes[(i, j)].abs()));
            let first = (0..n).find(|&i| shapes[(i, j)].abs() >= largest * (1.0 - 1e-6));
            if first.is_some_and(|i| shapes[(i, j)] < 0.0) {
                for i in 0..n {
                    shapes[(i, j)] = -shapes[(i, j)];
                }
            }
        }
        Ok(Modes { omega, shapes })
    }

    /// Number of modes.
    pub fn len(&self) -> usize {
        self.omega.len()
    }

    /// Whether there are none (never so).
    pub fn is_empty(&self) -> bool {
        self.omega.is_empty()
    }

    /// The first `count` of these modes.
    pub fn truncated(&self, count: usize) -> Self {
        Modes { omega: self.omega[..count].to_vec(), shapes: self.shapes.subcols(0, count).to_owned() }
    }

    /// The mode shapes along the whole bridge: φ(x) = ω² Σ F(x, x_m) M_m φ_m, deflected by their own inertia forces.
    pub fn lines(&self, bridge: &Bridge, flexibility: &Flexibility) -> Vec<Line> {
        let mesh = flexibility.mesh();
        let of_mode = |m: usize| {
            let stations = bridge.stations().iter().enumerate();
            let force = |i: usize, mass: f64| self.omega[m].powi(2) * mass * self.shapes[(i, m)];
            stations.map(|(i, s)| (force(i, s.mass), Action::Force(mesh.node_at(s.at)))).collect::<Actions>()
        };
        let inertia: Vec<Actions> = (0..self.len()).map(of_mode).collect();
        flexibility.each_deflected(&inertia, Structure::Actual)
    }
}

/// Refuses more masses than there is memory for: the flexibility, its product with the masses, its vectors, and what it
/// takes to find these.
fn check_matrices(masses: usize) -> Result<(), Error> {
    let bytes = 8.0 * size_of::<f64>() as f64 * (masses as f64).powi(2);
    memory::check("stations", masses, bytes, f64::INFINITY, "the matrices of so many masses", "use fewer")
}

/// Turns the vectors of each repeated eigenvalue within their space: at the station where the space is largest, all
/// but its first vector vanish, and so on with the rest. Any basis of the space would do; this one is reproducible.
fn fix_repeated(values: &[f64], psi: &mut Mat<f64>) {
    let n = values.len();
    let mut start = 0;
    while start < n {
        let mut end = start + 1;
        while end < n && values[start] - values[end] <= REPEATED * values[start] {
            end += 1;
        }
        for first in start..end.max(1) - 1 {
            let size = |i: usize| (first..end).map(|j| psi[(i, j)].powi(2)).sum::<f64>();
            let largest = (0..n).map(size).fold(0.0, f64::max);
            let Some(pivot) = (0..n).find(|&i| size(i) >= largest * (1.0 - 1e-6)) else { continue };
            for other in first + 1..end {
                let (a, b) = (psi[(pivot, first)], psi[(pivot, other)]);
                let r = a.hypot(b);
                if r > 0.0 {
                    for i in 0..n {
                        let (p, q) = (psi[(i, first)], psi[(i, other)]);
                        psi[(i, first)] = (a * p + b * q) / r;
                        psi[(i, other)] = (a * q - b * p) / r;
                    }
                }
            }
        }
        start = end;
    }
}

/// Residual of every pair and orthonormality of the vectors.
fn check(a: &Mat<f64>, values: &[f64], psi: &Mat<f64>) -> Result<(), Error> {
    let product = a * psi;
    let gram = psi.transpose() * psi;
    for (j, &value) in values.iter().enumerate() {
        let residual =
            (0..psi.nrows()).map(|i| (product[(i, j)] - value * psi[(i, j)]).powi(2)).sum::<f64>().sqrt() / values[0];
        let skew = (0..values.len())
            .map(|i| (gram[(i, j)] - f64::from(i == j)).abs())
            .fold(0.0, |m: f64, d| if d > m || d.is_nan() { d } else { m });
        // Written so that a NaN fails.
        if !(residual <= TOLERANCE && skew <= TOLERANCE) {
            return Err(Error::Modes(format!(
                "mode {} fails its check: residual {residual:.2e}, orthogonality {skew:.2e}, allowed {TOLERANCE:.0e}",
                j + 1
            )));
        }
    }
    Ok(())
}
