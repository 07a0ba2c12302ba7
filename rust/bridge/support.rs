//! How a beam is held: pinned, clamped or by springs.

use super::cubics::{COINCIDENT, MAX_STATIONS};
use crate::error::Error;

/// How a support holds the beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fixity {
    /// Deflection held, rotation free.
    Pinned,
    /// Deflection and rotation held.
    Clamped,
    /// Held by springs.
    Elastic {
        /// Force for a unit of deflection [N/m], infinite where deflection is held.
        vertical: f64,
        /// Couple for a unit of rotation [N m/rad]: 0 where rotation is free, infinite where it is held.
        rotation: f64,
    },
}

impl Fixity {
    /// Force for a unit of deflection [N/m], infinite where deflection is held.
    pub fn vertical(self) -> f64 {
        match self {
            Fixity::Pinned | Fixity::Clamped => f64::INFINITY,
            Fixity::Elastic { vertical, .. } => vertical,
        }
    }

    /// Couple for a unit of rotation [N m/rad]: 0 where rotation is free, infinite where it is held.
    pub fn rotation(self) -> f64 {
        match self {
            Fixity::Pinned => 0.0,
            Fixity::Clamped => f64::INFINITY,
            Fixity::Elastic { rotation, .. } => rotation,
        }
    }

    /// The same by its simplest name.
    pub(crate) fn simplest(self) -> Self {
        match (self.vertical(), self.rotation()) {
            (f64::INFINITY, 0.0) => Fixity::Pinned,
            (f64::INFINITY, f64::INFINITY) => Fixity::Clamped,
            (vertical, rotation) => Fixity::Elastic { vertical, rotation },
        }
    }
}

/// A support of the beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Position from the left end [m].
    pub at: f64,
    /// What it holds.
    pub fixity: Fixity,
}

/// Supports in order, each on the beam, none twice, their springs sound, no rigid-body motion left.
pub(crate) fn checked_supports(length: f64, supports: Vec<Support>) -> Result<Vec<Support>, Error> {
    let supports = checked_supports_of_given(length, supports)?;
    let turned_back = supports.iter().any(|s| s.fixity.rotation() > 0.0);
    if !turned_back && supports.len() < 2 {
        let listed: Vec<String> = supports
            .iter()
            .map(|s| match s.fixity.vertical() {
                f64::INFINITY => format!("pinned at {} m", s.at),
                k => format!("spring of {k:e} N/m at {} m", s.at),
            })
            .collect();
        let motion = if supports.is_empty() { "fall" } else { "rotate about its only support" };
        return Err(Error::Unstable { supports: listed.join(", "), motion });
    }
    Ok(supports)
}

/// The same, but that they hold the beam is left to who gave the bridge.
pub(crate) fn checked_supports_of_given(length: f64, mut supports: Vec<Support>) -> Result<Vec<Support>, Error> {
    let near = COINCIDENT * length;
    if supports.len() > MAX_STATIONS {
        return Err(Error::input(
            "supports",
            format!("{} supports", supports.len()),
            format!("at most {MAX_STATIONS}"),
        ));
    }
    for (i, support) in supports.iter_mut().enumerate() {
        on_the_bridge(&format!("supports[{i}]"), support.at, length)?;
        for end in [0.0, length] {
            if (support.at - end).abs() <= near {
                support.at = end;
            }
        }
        if let Fixity::Elastic { vertical, rotation } = support.fixity {
            if vertical.is_nan() || vertical <= 0.0 {
                let allowed = "must be greater than 0 [N/m], or inf where the deflection is held";
                return Err(Error::input(format!("supports[{i}] vertical"), vertical, allowed));
            }
            if rotation.is_nan() || rotation < 0.0 {
                let allowed = "must be 0 or more [N m/rad]: 0 where rotation is free, inf where it is held";
                return Err(Error::input(format!("supports[{i}] rotation"), rotation, allowed));
            }
        }
        support.fixity = support.fixity.simplest();
    }
    supports.sort_by(|a, b| a.at.total_cmp(&b.at));
    for pair in supports.windows(2) {
        if pair[1].at - pair[0].at <= near {
            return Err(Error::input(
                "supports",
                format!("{} m and {} m", pair[0].at, pair[1].at),
                "two supports must not stand at the same position",
            ));
        }
    }
    Ok(supports)
}

/// Refuses a place that is not on the bridge.
pub(crate) fn on_the_bridge(key: &str, at: f64, length: f64) -> Result<(), Error> {
    if at.is_finite() && at >= -COINCIDENT * length && at <= length * (1.0 + COINCIDENT) {
        Ok(())
    } else {
        Err(Error::input(key, format!("{at} m"), format!("must lie on the beam, 0 to {length} m")))
    }
}
