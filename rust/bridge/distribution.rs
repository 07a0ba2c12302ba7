//! A quantity that varies along the beam, EI or mass: constant or linear between breakpoints.

use crate::bridge::cubics::{COINCIDENT, MAX_STATIONS};
use crate::error::{Error, finite, not_negative, positive};

/// Pieces into which a stretch of linear EI is cut unless the user gives a number.
pub const TAPER_PIECES: usize = 32;

/// A quantity along the beam, as given.
#[derive(Debug, Clone, PartialEq)]
pub enum Along {
    /// One value, or one for each span.
    PerSpan(Vec<f64>),
    /// Between n + 1 breakpoints [m] from end to end: n values hold between them, n + 1 values stand at them.
    Between {
        /// The breakpoints [m].
        at: Vec<f64>,
        /// The values.
        values: Vec<f64>,
        /// Equal pieces of constant EI into which each stretch of linear EI is cut.
        pieces: usize,
    },
}

impl From<f64> for Along {
    fn from(value: f64) -> Self {
        Along::PerSpan(vec![value])
    }
}

impl From<&[f64]> for Along {
    fn from(per_span: &[f64]) -> Self {
        Along::PerSpan(per_span.to_vec())
    }
}

/// What values are allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sign {
    /// Greater than zero.
    Positive,
    /// Zero or more.
    NotNegative,
}

/// A quantity along the beam: linear in each piece, with jumps between pieces.
#[derive(Debug, Clone, PartialEq)]
pub struct Distribution {
    /// Ends of the pieces, left to right [m].
    bounds: Vec<f64>,
    /// Value at the left and at the right end of each piece.
    ends: Vec<[f64; 2]>,
}

impl Distribution {
    /// Of a beam with these `spans` (their bounds, left to right [m]); `key` names the quantity in errors.
    pub fn new(key: &str, along: &Along, spans: &[f64], sign: Sign) -> Result<Self, Error> {
        let check = |key: String, value: f64| match sign {
            Sign::Positive => positive(key, value),
            Sign::NotNegative => not_negative(key, value),
        };
        match along {
            Along::PerSpan(values) => {
                let count = spans.len() - 1;
                let all = match values.len() {
                    1 => vec![values[0]; count],
                    n if n == count => values.clone(),
                    n => {
                        let allowed =
                            format!("give one number, or one for each of the {count} spans (overhangs count as spans)");
                        return Err(Error::input(key, format!("{n} values"), allowed));
                    }
                };
                for (i, &value) in values.iter().enumerate() {
                    check(if values.len() == 1 { key.to_string() } else { format!("{key}[{i}]") }, value)?;
                }
                Ok(Distribution { bounds: spans.to_vec(), ends: all.into_iter().map(|v| [v, v]).collect() })
            }
            Along::Between { at, values, .. } => {
                let bounds = checked_breakpoints(key, at, spans[spans.len() - 1])?;
                for (i, &value) in values.iter().enumerate() {
                    check(format!("{key} values[{i}]"), value)?;
                }
                let pieces = bounds.len() - 1;
                let ends = match values.len() {
                    n if n == pieces => values.iter().map(|&v| [v, v]).collect(),
                    n if n == pieces + 1 => values.windows(2).map(|v| [v[0], v[1]]).collect(),
                    n => {
                        let allowed = format!(
                            "{} breakpoints take {pieces} values, constant between them, or {}, linear between them",
                            pieces + 1,
                            pieces + 1
                        );
                        return Err(Error::input(format!("{key} values"), format!("{n} values"), allowed));
                    }
                };
                Ok(Distribution { bounds, ends })
            }
        }
    }

    /// Ends of the pieces, left to right [m].
    pub fn bounds(&self) -> &[f64] {
        &self.bounds
    }

    /// Middle value of each piece.
    pub fn values(&self) -> Vec<f64> {
        self.ends.iter().map(|[a, b]| 0.5 * (a + b)).collect()
    }

    /// Middle value of the piece that holds x, the one to the right of a bound.
    pub fn piece_at(&self, x: f64) -> f64 {
        let [a, b] = self.ends[self.bounds[1..self.bounds.len() - 1].partition_point(|&bound| bound <= x)];
        0.5 * (a + b)
    }

    /// Integral from `a` to `b` [m].
    pub fn integral(&self, a: f64, b: f64) -> f64 {
        let pieces = self.bounds.windows(2).zip(&self.ends);
        pieces
            .map(|(bound, [left, right])| {
                let (from, to) = (a.max(bound[0]), b.min(bound[1]));
                if to <= from {
                    return 0.0;
                }
                let middle = (0.5 * (from + to) - bound[0]) / (bound[1] - bound[0]);
                (to - from) * (left + middle * (right - left))
            })
            .sum()
    }

    /// The same in pieces of constant value: every linear piece is cut into `pieces` of equal length, each with the
    /// harmonic mean of its values, so that 1/EI keeps its integral and shapes err with the square of the length.
    pub fn stepped(&self, key: &str, pieces: usize) -> Result<Self, Error> {
        if pieces == 0 || pieces > MAX_STATIONS {
            return Err(Error::input(format!("{key} pieces"), pieces, format!("must be 1 to {MAX_STATIONS}")));
        }
        let cuts = |[a, b]: [f64; 2]| if a == b { 1 } else { pieces };
        let total: usize = self.ends.iter().map(|&ends| cuts(ends)).sum();
        if total > MAX_STATIONS {
            let allowed = format!("at most {MAX_STATIONS} in all: use fewer pieces or breakpoints");
            return Err(Error::input(key, format!("{total} pieces of constant value"), allowed));
        }
        let mut stepped = Distribution { bounds: vec![self.bounds[0]], ends: Vec::with_capacity(total) };
        for (bound, &[a, b]) in self.bounds.windows(2).zip(&self.ends) {
            let n = cuts([a, b]);
            let at = |i: usize, from: f64, to: f64| match i {
                i if i == n => to,
                i => from + (to - from) * i as f64 / n as f64,
            };
            for i in 0..n {
                let (left, right) = (at(i, a, b), at(i + 1, a, b));
                let rise = right - left;
                // Mean of 1/v over a stretch in which v is linear: ln(right/left) / (right − left).
                let value = if rise == 0.0 { left } else { rise / (rise / left).ln_1p() };
                stepped.bounds.push(at(i + 1, bound[0], bound[1]));
                stepped.ends.push([value, value]);
            }
        }
        Ok(stepped)
    }
}

impl Along {
    /// Pieces into which a linear stretch is cut.
    pub fn pieces(&self) -> usize {
        match self {
            Along::PerSpan(_) => 1,
            Along::Between { pieces, .. } => *pieces,
        }
    }

    /// The breakpoints given [m].
    pub fn breakpoints(&self) -> &[f64] {
        match self {
            Along::PerSpan(_) => &[],
            Along::Between { at, .. } => at,
        }
    }
}

/// Breakpoints in order from end to end, the first and the last exactly there.
fn checked_breakpoints(key: &str, at: &[f64], length: f64) -> Result<Vec<f64>, Error> {
    let near = COINCIDENT * length;
    if at.len() < 2 || at.len() > MAX_STATIONS {
        let allowed = format!("give 2 to {MAX_STATIONS} breakpoints, from 0 to {length} m");
        return Err(Error::input(format!("{key} at"), format!("{} breakpoints", at.len()), allowed));
    }
    for (i, &x) in at.iter().enumerate() {
        finite(format!("{key} at[{i}]"), x)?;
        if i > 0 && x - at[i - 1] <= near {
            let allowed = format!("must be greater than the breakpoint before it, {} m", at[i - 1]);
            return Err(Error::input(format!("{key} at[{i}]"), format!("{x} m"), allowed));
        }
    }
    let last = at.len() - 1;
    for (i, end) in [(0, 0.0), (last, length)] {
        if (at[i] - end).abs() > near {
            let allowed = format!("breakpoints must cover the beam, from 0 to {length} m");
            return Err(Error::input(format!("{key} at[{i}]"), format!("{} m", at[i]), allowed));
        }
    }
    let mut bounds = at.to_vec();
    (bounds[0], bounds[last]) = (0.0, length);
    Ok(bounds)
}
