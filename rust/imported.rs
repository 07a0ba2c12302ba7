//! A bridge that is not described but given: by the flexibility of its basic bridge ([`by_flexibility`]), or by its
//! modes ([`by_modes`]).
//!
//! What a crossing needs is lines along the path of the wheels, of the modes and of the responses. A described bridge
//! integrates them; here they come from another program or from a table, and the rest is the same.

pub(crate) mod by_flexibility;
pub(crate) mod by_modes;
pub(crate) mod sides;

pub use by_flexibility::ByFlexibility;
pub use by_modes::{ByModes, GivenLines, TwoSided};

use faer::Mat;

use crate::bridge::cubics::{COINCIDENT, Line, MAX_STATIONS, Mesh};
use crate::bridge::support::Support;
use crate::damping::{Damping, ModalDamping};
use crate::error::{Error, finite, positive};
use crate::modal_bridge::shortest_span;
use crate::modes::Modes;
use crate::recovery::ModalFactors;
use crate::statics::influence::Responses;
use crate::statics::quantity::{At, Quantity};

/// A bridge given by lines along the path of the wheels.
#[derive(Debug, Clone)]
pub struct Given {
    mesh: Mesh,
    supports: Vec<Support>,
    /// Moving masses (node, mass [kg]); none if unknown.
    masses: Vec<(usize, f64)>,
    motion: Motion,
    /// Of all sections that can be looked at.
    responses: Responses,
    missing: Vec<Quantity>,
}

#[derive(Debug, Clone)]
enum Motion {
    /// F of the actual bridge at the masses, and its columns along the path.
    Flexibility { matrix: Mat<f64>, columns: Vec<Line> },
    /// The modes, along the path as well, and the responses of each: a row for each response.
    Modes { modes: Modes, lines: Vec<Line>, rho: Mat<f64> },
}

impl Given {
    /// The mesh of all its lines.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The supports whose reactions are known, left to right.
    pub fn supports(&self) -> &[Support] {
        &self.supports
    }

    /// The moving masses: position [m] and mass [kg]; none if unknown.
    pub fn masses(&self) -> impl Iterator<Item = (f64, f64)> {
        self.masses.iter().map(|&(node, mass)| (self.mesh.nodes()[node], mass))
    }

    /// Responses at all sections that can be looked at.
    pub fn responses(&self) -> &Responses {
        &self.responses
    }

    /// Kinds of response of which nothing is known.
    pub fn missing(&self) -> &[Quantity] {
        &self.missing
    }

    /// The sections that can be looked at [m].
    pub fn sections(&self) -> Vec<f64> {
        self.responses.sections().iter().map(|&node| self.mesh.nodes()[node]).collect()
    }

    /// Number of modes that there are.
    pub fn mode_count(&self) -> usize {
        match &self.motion {
            Motion::Flexibility { .. } => self.masses.len(),
            Motion::Modes { modes, .. } => modes.len(),
        }
    }

    /// The lowest `count` modes, and along the path.
    pub fn modes(&self, count: usize) -> Result<(Modes, Vec<Line>), Error> {
        match &self.motion {
            Motion::Flexibility { matrix, columns } => {
                let masses: Vec<f64> = self.masses.iter().map(|m| m.1).collect();
                let modes = Modes::of_matrices(matrix, &masses, count)?;
                let mut lines = vec![Line::straight(&self.mesh, 0.0, 0.0); count];
                for (i, column) in columns.iter().enumerate() {
                    for (m, line) in lines.iter_mut().enumerate() {
                        line.add_scaled(modes.omega[m].powi(2) * masses[i] * modes.shapes[(i, m)], column);
                    }
                }
                Ok((modes, lines))
            }
            Motion::Modes { modes, lines, .. } => {
                if count == 0 || count > modes.len() {
                    let allowed = format!("must be 1 to {}, the number of modes given", modes.len());
                    return Err(Error::input("modes", count, allowed));
                }
                Ok((modes.truncated(count), lines[..count].to_vec()))
            }
        }
    }

    /// Damping in these modes.
    pub fn damping(&self, modes: &Modes, damping: &Damping) -> Result<ModalDamping, Error> {
        if self.masses.is_empty() && matches!(damping, Damping::Viscous(_)) {
            let allowed = "a bridge given by its modes without masses takes ratios only";
            return Err(Error::input("damping", "a matrix C", allowed));
        }
        damping.modal(modes)
    }

    /// Factors of the responses at the chosen sections.
    pub fn factors(
        &self,
        responses: &Responses,
        chosen: &[usize],
        modes: &Modes,
        damping: (&Damping, &ModalDamping),
    ) -> ModalFactors {
        match &self.motion {
            Motion::Flexibility { .. } => ModalFactors::of_masses(responses, &self.masses, modes, damping),
            Motion::Modes { rho, .. } => {
                let by_masses =
                    (!self.masses.is_empty()).then(|| ModalFactors::of_masses(responses, &self.masses, modes, damping));
                let number = |r: usize| {
                    let (quantity, own) = responses.quantity_of(r);
                    let own = if quantity.at() == At::Sections { chosen[own] } else { own };
                    self.responses.range(quantity).nth(own)
                };
                let rho =
                    Mat::from_fn(responses.len(), modes.len(), |r, i| number(r).map_or(0.0, |known| rho[(known, i)]));
                let mut factors = ModalFactors::of_responses(&rho, &modes.omega, damping.1);
                // C as a matrix acts on the masses.
                if let (Some(by_masses), Damping::Viscous(_)) = (by_masses, damping.0) {
                    factors.damping = by_masses.damping;
                }
                factors
            }
        }
    }

    /// Positions and numbers of the sections asked for, all by default.
    pub fn chosen(&self, asked: Option<&[f64]>) -> Result<(Vec<f64>, Vec<usize>), Error> {
        let all = self.sections();
        let Some(asked) = asked else {
            let numbers = (0..all.len()).collect();
            return Ok((all, numbers));
        };
        let near = COINCIDENT * self.mesh.length();
        let mut chosen = Vec::with_capacity(asked.len());
        for (i, &x) in asked.iter().enumerate() {
            let Some(number) = all.iter().position(|s| (s - x).abs() <= near) else {
                let listed: Vec<String> = all.iter().take(12).map(|x| format!("{x}")).collect();
                let more = if all.len() > 12 { ", ..." } else { "" };
                let allowed = format!("this bridge is given at the sections {}{more} m only", listed.join(", "));
                return Err(Error::input(format!("sections[{i}]"), format!("{x} m"), allowed));
            };
            if chosen.last().is_some_and(|last| *last >= number) {
                let allowed = "must be greater than the section before it";
                return Err(Error::input(format!("sections[{i}]"), format!("{x} m"), allowed));
            }
            chosen.push(number);
        }
        if chosen.is_empty() {
            return Err(Error::input("sections", "[]", "give one position in metres or more"));
        }
        Ok((chosen.iter().map(|&s| all[s]).collect(), chosen))
    }

    /// The influence line of a response, by its name, at a section or support [m].
    pub fn line(&self, quantity: &str, at: f64) -> Result<&Line, Error> {
        let known: Vec<&str> = Quantity::USUAL
            .iter()
            .filter(|&&q| !self.missing.contains(&q) && !self.responses.range(q).is_empty())
            .map(|q| q.name())
            .collect();
        let Some(quantity) = Quantity::USUAL.into_iter().find(|q| q.name() == quantity && known.contains(&quantity))
        else {
            let allowed = format!("this bridge is given with {} only", known.join(", "));
            return Err(Error::input("quantity", format!("\"{quantity}\""), allowed));
        };
        let positions: Vec<f64> = match quantity {
            Quantity::Reaction => self.supports.iter().map(|s| s.at).collect(),
            Quantity::ClampMoment => self.supports.iter().filter(|s| s.fixity.rotation() > 0.0).map(|s| s.at).collect(),
            _ => self.sections(),
        };
        let near = COINCIDENT * self.mesh.length();
        let Some(i) = positions.iter().position(|x| (x - at).abs() <= near) else {
            let listed: Vec<String> = positions.iter().take(12).map(|x| format!("{x}")).collect();
            let more = if positions.len() > 12 { ", ..." } else { "" };
            let allowed = format!("this bridge is given at {}{more} m only", listed.join(", "));
            return Err(Error::input("at", format!("{at} m"), allowed));
        };
        Ok(&self.responses.lines()[self.responses.range(quantity).start + i])
    }

    /// Shortest distance between neighbouring supports and ends [m].
    pub fn shortest_span(&self) -> f64 {
        let mut bounds: Vec<f64> = self.supports.iter().map(|s| s.at).collect();
        bounds.extend([0.0, self.mesh.length()]);
        bounds.sort_by(f64::total_cmp);
        shortest_span(&bounds)
    }
}

/// Positions in ascending order on a beam of this length [m].
fn checked_positions(key: &str, at: &[f64], length: f64) -> Result<(), Error> {
    let near = COINCIDENT * length;
    if at.is_empty() || at.len() > MAX_STATIONS {
        let allowed = format!("give 1 to {MAX_STATIONS} positions in metres");
        return Err(Error::input(key, format!("{} positions", at.len()), allowed));
    }
    for (i, &x) in at.iter().enumerate() {
        if !(x.is_finite() && x >= -near && x <= length + near) {
            let allowed = format!("must lie on the beam, 0 to {length} m");
            return Err(Error::input(format!("{key}[{i}]"), format!("{x} m"), allowed));
        }
        if i > 0 && x - at[i - 1] <= near {
            let allowed = format!("must be greater than the one before it, {} m", at[i - 1]);
            return Err(Error::input(format!("{key}[{i}]"), format!("{x} m"), allowed));
        }
    }
    Ok(())
}

/// A matrix of the shape wanted, all its numbers finite.
fn checked_matrix(key: &str, m: &Mat<f64>, wanted: (usize, usize), what: &str) -> Result<(), Error> {
    if (m.nrows(), m.ncols()) != wanted {
        let allowed = format!("must be {} x {}, {what}", wanted.0, wanted.1);
        return Err(Error::input(key, format!("{} x {} numbers", m.nrows(), m.ncols()), allowed));
    }
    for (i, j) in (0..m.nrows()).flat_map(|i| (0..m.ncols()).map(move |j| (i, j))) {
        finite(format!("{key}[{i}, {j}]"), m[(i, j)])?;
    }
    Ok(())
}

fn checked_length(length: f64) -> Result<f64, Error> {
    positive("length", length)
}
