//! Dense algebra of one vehicle: by nalgebra where matrices are small, the same everywhere; by faer where they are large.

use faer::linalg::solvers::DenseSolveCore;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Mat, Par, Side};
use nalgebra::{Cholesky, DMatrix, SymmetricEigen};

/// Order from which on faer is the faster by far.
const LARGE: usize = 100;

/// The inverse, if there is one.
pub fn inverse(matrix: DMatrix<f64>) -> Option<DMatrix<f64>> {
    if matrix.nrows() < LARGE {
        return matrix.try_inverse();
    }
    if !is_finite(&matrix) {
        return None;
    }
    let inverse = to_nalgebra(&to_faer(&matrix).partial_piv_lu().inverse());
    is_finite(&inverse).then_some(inverse)
}

/// Eigenvalues of K x = λ M x in ascending order, and the vectors in columns, xᵀMx = 1; none where M is not positive
/// definite or a number is not finite.
pub fn vibrations(mass: &DMatrix<f64>, stiffness: DMatrix<f64>) -> Option<(Vec<f64>, DMatrix<f64>)> {
    if mass.nrows() >= LARGE {
        return large_vibrations(mass, stiffness);
    }
    let n = mass.nrows();
    let root = Cholesky::new(mass.clone())?;
    let inverse = root.l().solve_lower_triangular(&DMatrix::identity(n, n)).unwrap_or_else(|| DMatrix::zeros(n, n));
    let scaled = &inverse * stiffness * inverse.transpose();
    // A bound on the iterations, because stiffnesses that overflow would keep it going.
    let eigen = SymmetricEigen::try_new(scaled, f64::EPSILON, 1000)?;
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let values = order.iter().map(|&i| eigen.eigenvalues[i]).collect();
    Some((values, inverse.transpose() * eigen.eigenvectors.select_columns(&order)))
}

fn large_vibrations(mass: &DMatrix<f64>, stiffness: DMatrix<f64>) -> Option<(Vec<f64>, DMatrix<f64>)> {
    if !is_finite(mass) || !is_finite(&stiffness) {
        return None;
    }
    let root = to_faer(mass).llt(Side::Lower).ok()?;
    // L⁻¹K, and L⁻¹(L⁻¹K)ᵀ.
    let mut half = to_faer(&stiffness);
    solve_lower_triangular_in_place(root.L(), half.as_mut(), Par::Seq);
    let mut scaled = half.transpose().to_owned();
    solve_lower_triangular_in_place(root.L(), scaled.as_mut(), Par::Seq);
    let eigen = scaled.self_adjoint_eigen(Side::Lower).ok()?;
    let mut vectors = eigen.U().to_owned();
    solve_upper_triangular_in_place(root.L().transpose(), vectors.as_mut(), Par::Seq);
    Some((eigen.S().column_vector().iter().copied().collect(), to_nalgebra(&vectors)))
}

fn is_finite(matrix: &DMatrix<f64>) -> bool {
    matrix.iter().all(|value| value.is_finite())
}

fn to_faer(matrix: &DMatrix<f64>) -> Mat<f64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)])
}

fn to_nalgebra(matrix: &Mat<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)])
}
