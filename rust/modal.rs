//! The bridge in a step: how modal accelerations follow from modal forces.

use faer::Mat;
use faer::linalg::solvers::DenseSolveCore;

use crate::lane::Lane;
use crate::newmark::Coordinate;

/// Damping of the included modes, D = ΦᵀCΦ.
#[derive(Debug, Clone)]
pub enum ModalDamping {
    /// Ratios to critical, one per mode: D = diag(2ζω).
    Classical(Vec<f64>),
    /// Full D [1/s].
    Coupled(Mat<f64>),
}

/// (I + ½hD + βh²Ω²)⁻¹, and D.
#[derive(Debug, Clone)]
pub enum ModalSolve<L> {
    /// Classical damping: mode by mode.
    Diagonal {
        /// Diagonal of D.
        damping: Vec<L>,
        /// Diagonal of the inverse.
        inverse: Vec<L>,
    },
    /// All modes together.
    Full {
        /// D by rows.
        damping: Vec<L>,
        /// The inverse by rows.
        inverse: Vec<L>,
    },
}

impl<L: Lane> ModalSolve<L> {
    /// For modes of circular frequencies `omega` [rad/s] and steps of `h` [s] with Newmark's `beta`.
    pub fn new(omega: &[f64], damping: &ModalDamping, h: f64, beta: f64) -> Self {
        match damping {
            ModalDamping::Classical(ratios) => {
                let d: Vec<f64> = omega.iter().zip(ratios).map(|(w, z)| 2.0 * z * w).collect();
                let inverse = omega.iter().zip(&d).map(|(w, d)| 1.0 / (1.0 + 0.5 * h * d + beta * h * h * w * w));
                ModalSolve::Diagonal {
                    inverse: inverse.map(L::splat).collect(),
                    damping: d.into_iter().map(L::splat).collect(),
                }
            }
            ModalDamping::Coupled(d) => {
                let n = omega.len();
                let matrix = Mat::from_fn(n, n, |i, j| {
                    0.5 * h * d[(i, j)] + if i == j { 1.0 + beta * h * h * omega[i].powi(2) } else { 0.0 }
                });
                let inverse = matrix.partial_piv_lu().inverse();
                let by_rows = |m: &Mat<f64>| (0..n * n).map(|ij| L::splat(m[(ij / n, ij % n)])).collect();
                ModalSolve::Full { damping: by_rows(d), inverse: by_rows(&inverse) }
            }
        }
    }

    /// From those of each sample.
    pub fn gather(each: &[&ModalSolve<f64>]) -> Self {
        let parts: Vec<[&Vec<f64>; 2]> = each
            .iter()
            .map(|solve| match solve {
                ModalSolve::Diagonal { damping, inverse } | ModalSolve::Full { damping, inverse } => [damping, inverse],
            })
            .collect();
        let of = |part: usize| (0..parts[0][part].len()).map(|i| L::from_fn(|s| parts[s][part][i])).collect();
        match each[0] {
            ModalSolve::Diagonal { .. } => ModalSolve::Diagonal { damping: of(0), inverse: of(1) },
            ModalSolve::Full { .. } => ModalSolve::Full { damping: of(0), inverse: of(1) },
        }
    }

    /// Damping force on a mode.
    #[inline(always)]
    pub fn damping_force(&self, mode: usize, predicted: &[Coordinate<L>]) -> L {
        match self {
            ModalSolve::Diagonal { damping, .. } => damping[mode] * predicted[mode].v,
            ModalSolve::Full { damping, .. } => {
                let row = &damping[mode * predicted.len()..];
                predicted.iter().zip(row).fold(L::splat(0.0), |sum, (c, d)| sum + *d * c.v)
            }
        }
    }

    /// Accelerations under modal forces.
    #[inline(always)]
    pub fn apply(&self, forces: &[L], accelerations: &mut [L]) {
        match self {
            ModalSolve::Diagonal { inverse, .. } => {
                for ((a, f), e) in accelerations.iter_mut().zip(forces).zip(inverse) {
                    *a = *e * *f;
                }
            }
            ModalSolve::Full { inverse, .. } => {
                for (a, row) in accelerations.iter_mut().zip(inverse.chunks_exact(forces.len())) {
                    *a = forces.iter().zip(row).fold(L::splat(0.0), |sum, (f, e)| sum + *e * *f);
                }
            }
        }
    }
}
