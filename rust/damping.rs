//! Viscous damping of the bridge, checked and projected on the included modes.

use faer::{Mat, Side};

use crate::error::{Error, finite, not_negative};
use crate::modes::Modes;

/// Viscous damping of the bridge.
#[derive(Debug, Clone)]
pub enum Damping {
    /// Ratio to critical, one for all modes or one for each.
    Ratios(Vec<f64>),
    /// C = αM + βK, for α [1/s] and β [s]: the ratio of a mode is α/2ω + βω/2.
    Rayleigh {
        /// α [1/s].
        mass: f64,
        /// β [s].
        stiffness: f64,
    },
    /// C at the mass stations [N s/m]: D = ΦᵀCΦ is full in general.
    Viscous(Mat<f64>),
}

/// Damping of the included modes, D = ΦᵀCΦ.
#[derive(Debug, Clone)]
pub enum ModalDamping {
    /// Ratios to critical, one per mode: D = diag(2ζω).
    Classical(Vec<f64>),
    /// Full D [1/s].
    Coupled(Mat<f64>),
}

impl ModalDamping {
    /// 2ζω of modes with these circular frequencies [1/s], if each is damped by itself.
    pub fn rates(&self, omega: &[f64]) -> Option<Vec<f64>> {
        match self {
            ModalDamping::Classical(ratios) => Some(omega.iter().zip(ratios).map(|(w, z)| 2.0 * z * w).collect()),
            ModalDamping::Coupled(_) => None,
        }
    }
}

impl PartialEq for Damping {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Damping::Ratios(a), Damping::Ratios(b)) => a == b,
            (Damping::Rayleigh { mass, stiffness }, Damping::Rayleigh { mass: m, stiffness: s }) => {
                mass == m && stiffness == s
            }
            // Matrices of different shapes have no comparison of their own.
            (Damping::Viscous(a), Damping::Viscous(b)) => a.shape() == b.shape() && a == b,
            _ => false,
        }
    }
}

impl Damping {
    /// Checked against the bridge, and projected on the included modes.
    pub fn modal(&self, modes: &Modes) -> Result<ModalDamping, Error> {
        match self {
            Damping::Ratios(ratios) => {
                if ratios.len() != 1 && ratios.len() != modes.len() {
                    let allowed = format!("give one ratio, or one for each of the {} modes", modes.len());
                    return Err(Error::input("damping", format!("{} values", ratios.len()), allowed));
                }
                for &ratio in ratios {
                    if !(ratio.is_finite() && (0.0..1.0).contains(&ratio)) {
                        return Err(Error::input("damping", ratio, "must be a ratio to critical, from 0 to below 1"));
                    }
                }
                let all = (0..modes.len()).map(|m| if ratios.len() == 1 { ratios[0] } else { ratios[m] });
                Ok(ModalDamping::Classical(all.collect()))
            }
            Damping::Rayleigh { mass, stiffness } => {
                not_negative("damping alpha", *mass)?;
                not_negative("damping beta", *stiffness)?;
                let ratios: Vec<f64> = modes.omega.iter().map(|w| 0.5 * (mass / w + stiffness * w)).collect();
                if let Some(m) = ratios.iter().position(|ratio| *ratio >= 1.0) {
                    let allowed = "Rayleigh damping must stay below critical in every included mode";
                    return Err(Error::input(
                        "damping",
                        format!("{} of critical in mode {}", ratios[m], m + 1),
                        allowed,
                    ));
                }
                Ok(ModalDamping::Classical(ratios))
            }
            Damping::Viscous(c) => {
                let n = modes.shapes.nrows();
                if c.nrows() != n || c.ncols() != n {
                    let allowed = format!("C must be square with a row for each of the {n} moving masses");
                    return Err(Error::input("damping", format!("{} x {} matrix", c.nrows(), c.ncols()), allowed));
                }
                let mut largest = 0.0_f64;
                for value in (0..n).flat_map(|j| c.col(j).iter()) {
                    largest = largest.max(finite("damping", *value)?.abs());
                }
                let near = 1e-9 * largest;
                if (0..n).any(|i| (0..i).any(|j| (c[(i, j)] - c[(j, i)]).abs() > near)) {
                    return Err(Error::input("damping", "unsymmetric C", "C must be symmetric"));
                }
                let lowest = c.self_adjoint_eigenvalues(Side::Lower).map_err(|e| Error::Modes(format!("{e:?}")))?[0];
                if lowest < -near {
                    let value = format!("C with the negative eigenvalue {lowest:.3e} N s/m");
                    return Err(Error::input("damping", value, "C must not feed energy in: no negative eigenvalue"));
                }
                Ok(ModalDamping::Coupled(modes.shapes.transpose() * c * &modes.shapes))
            }
        }
    }
}
