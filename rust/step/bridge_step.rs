//! The bridge in a step: KTN73 Eq. 3 solved for the modal accelerations at its end.
//!
//! By Newmark's method Ȧ = Ȧ₀ + ½hÄ and A = A₀ + βh²Ä, where Ȧ₀ and A₀ are predicted. Then Ä + DȦ + Ω²A = ΦᵀP is
//! (I + ½hD + βh²Ω²) Ä = ΦᵀP − (DȦ₀ + Ω²A₀): [`ModalSolve::resist`] gives what is subtracted, [`ModalSolve::apply`] Ä.

use faer::Mat;
use faer::linalg::solvers::DenseSolveCore;

use crate::coordinate::Coordinate;
use crate::damping::ModalDamping;
use crate::lane::Lane;
use crate::lane::gather::gather;

/// What a D may have beside its diagonal, relative to that, for the modes to be damped each by itself: rounding.
const BESIDE: f64 = 1e-9;

/// (I + ½hD + βh²Ω²)⁻¹, D and Ω².
#[derive(Debug, Clone)]
pub struct ModalSolve<L> {
    /// Classical damping, of each mode by itself: D and the inverse are diagonal, and only that is kept; else by rows.
    pub classical: bool,
    /// Whether no energy goes from mode to mode: so it is by a full D too that has next to nothing beside its diagonal.
    pub apart: bool,
    omega2: Vec<L>,
    damping: Vec<L>,
    inverse: Vec<L>,
}

gather!(ModalSolve { classical, apart, omega2, damping, inverse });

impl<L: Lane> ModalSolve<L> {
    /// For modes of circular frequencies `omega` [rad/s] and steps of `h` [s] with Newmark's `beta`.
    pub fn new(omega: &[f64], damping: &ModalDamping, h: f64, beta: f64) -> Self {
        let omega2 = omega.iter().map(|w| L::splat(w * w)).collect();
        match damping {
            ModalDamping::Classical(ratios) => {
                let d: Vec<f64> = omega.iter().zip(ratios).map(|(w, z)| 2.0 * z * w).collect();
                let inverse = omega.iter().zip(&d).map(|(w, d)| 1.0 / (1.0 + 0.5 * h * d + beta * h * h * w * w));
                ModalSolve {
                    classical: true,
                    apart: true,
                    omega2,
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
                let beside = |i: usize, j: usize| d[(i, j)].powi(2) <= BESIDE * BESIDE * d[(i, i)] * d[(j, j)];
                let apart = (0..n).all(|i| (0..n).all(|j| i == j || beside(i, j)));
                let by_rows = |m: &Mat<f64>| (0..n * n).map(|ij| L::splat(m[(ij / n, ij % n)])).collect();
                ModalSolve { classical: false, apart, omega2, damping: by_rows(d), inverse: by_rows(&inverse) }
            }
        }
    }

    /// Ω² of each mode.
    pub fn omega2(&self) -> &[L] {
        &self.omega2
    }

    /// D: of each mode if it is classical, else by rows.
    pub fn rates(&self) -> &[L] {
        &self.damping
    }

    /// (I + ½hD + βh²Ω²)⁻¹, in the same way.
    pub fn inverse(&self) -> &[L] {
        &self.inverse
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.omega2.len()
    }

    /// Forces with which the modes resist: of dampers and springs, DȦ₀ + Ω²A₀.
    #[inline(always)]
    pub fn resist(&self, classical: bool, predicted: &[Coordinate<L>], forces: &mut [L]) {
        let modes = forces.len();
        let (omega2, predicted) = (&self.omega2[..modes], &predicted[..modes]);
        for m in 0..modes {
            let mut force = omega2[m] * predicted[m].x;
            if classical {
                force = force + self.damping[..modes][m] * predicted[m].v;
            } else {
                for (d, q) in self.damping[m * modes..][..modes].iter().zip(predicted) {
                    force = force + *d * q.v;
                }
            }
            forces[m] = force;
        }
    }

    /// Accelerations under modal forces: the inverse times these.
    #[inline(always)]
    pub fn apply(&self, classical: bool, forces: &[L], accelerations: &mut [L]) {
        let modes = accelerations.len();
        let forces = &forces[..modes];
        for m in 0..modes {
            accelerations[m] = if classical {
                self.inverse[..modes][m] * forces[m]
            } else {
                let row = &self.inverse[m * modes..][..modes];
                forces.iter().zip(row).fold(L::splat(0.0), |sum, (f, e)| sum + *e * *f)
            };
        }
    }
}
