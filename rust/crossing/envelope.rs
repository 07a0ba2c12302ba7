//! Extremes of every response, where and when they occur, and the impact factors a bridge engineer reads off them.

use serde::{Deserialize, Serialize};

use crate::crossing::history::History;
use crate::statistics::Ride;
use crate::stops::Positions;

/// An extreme of a response over a crossing.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Extreme {
    /// The extreme [unit of the response].
    pub value: f64,
    /// When [s].
    pub time: f64,
    /// Position of the front axle then [m].
    pub position: f64,
    /// The partner then: the static response at an extreme of the dynamic one, and the other way round.
    pub partner: f64,
}

/// Largest and smallest of every response.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Extremes {
    /// Largest values.
    pub max: Vec<Extreme>,
    /// Smallest values.
    pub min: Vec<Extreme>,
}

/// Dynamic and static extremes of a crossing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Envelope {
    /// Of the dynamic responses.
    pub dynamic: Extremes,
    /// Of the responses to the static axle loads at the same positions.
    pub at_rest: Extremes,
}

/// Extremes of the axle loads until the last vehicle has left the bridge: what they are in the tail is none of its
/// business, and would depend on how long that is.
pub fn axle_loads(history: &History, rides: &[Ride<f64>]) -> Envelope {
    let at = |step: f64, value: f64, partner: f64| {
        let step = step as usize;
        // Zeros lose their sign.
        Extreme { value: value + 0.0, time: history.time[step], position: history.x(step, 0), partner }
    };
    let loads = || rides.iter().flat_map(|ride| &ride.loads).zip(&history.static_loads);
    let start = || history.static_loads.iter().zip(&history.loads).map(|(&value, &load)| at(0.0, value, load));
    Envelope {
        dynamic: Extremes {
            max: loads().map(|(peaks, &at_rest)| at(peaks.max_at, peaks.max, at_rest)).collect(),
            min: loads().map(|(peaks, &at_rest)| at(peaks.min_at, peaks.min, at_rest)).collect(),
        },
        at_rest: Extremes { max: start().collect(), min: start().collect() },
    }
}

impl Extremes {
    /// Of some of the responses.
    pub fn of(&self, range: std::ops::Range<usize>) -> Self {
        Extremes { max: self.max[range.clone()].to_vec(), min: self.min[range].to_vec() }
    }

    /// Pairwise the larger of the largest and the smaller of the smallest: of a shear on both sides of a section.
    pub fn merged(&self, other: &Self) -> Self {
        let pick = |a: &[Extreme], b: &[Extreme], better: fn(f64, f64) -> bool| {
            a.iter().zip(b).map(|(&a, &b)| if better(b.value, a.value) { b } else { a }).collect()
        };
        Extremes { max: pick(&self.max, &other.max, |b, a| b > a), min: pick(&self.min, &other.min, |b, a| b < a) }
    }

    /// The one of larger magnitude of each pair.
    pub fn by_magnitude(&self) -> Vec<Extreme> {
        self.max.iter().zip(&self.min).map(|(&a, &b)| if b.value.abs() > a.value.abs() { b } else { a }).collect()
    }

    fn largest_magnitude(&self) -> f64 {
        self.by_magnitude().iter().fold(0.0, |m, e| m.max(e.value.abs()))
    }
}

impl Envelope {
    /// Puts NaN in place of everything.
    pub fn forget(&mut self) {
        let nothing = Extreme { value: f64::NAN, time: f64::NAN, position: f64::NAN, partner: f64::NAN };
        for extremes in [&mut self.dynamic, &mut self.at_rest] {
            extremes.max.fill(nothing);
            extremes.min.fill(nothing);
        }
    }

    /// Of some of the responses.
    pub fn of(&self, range: std::ops::Range<usize>) -> Self {
        Envelope { dynamic: self.dynamic.of(range.clone()), at_rest: self.at_rest.of(range) }
    }

    /// With another envelope of the same sections taken in.
    pub fn merged(&self, other: &Self) -> Self {
        Envelope { dynamic: self.dynamic.merged(&other.dynamic), at_rest: self.at_rest.merged(&other.at_rest) }
    }

    /// Impact factors of one sense, NaN where the static value is too small to divide by: at most `mask` times the
    /// largest of that sense along the bridge, or lost in rounding.
    pub fn impact_factors(&self, sense: Sense, ratio: Ratio, mask: f64) -> Vec<f64> {
        let pick = |extremes: &Extremes| match sense {
            Sense::Positive => extremes.max.clone(),
            Sense::Negative => extremes.min.clone(),
            Sense::Either => extremes.by_magnitude(),
        };
        let (dynamic, at_rest) = (pick(&self.dynamic), pick(&self.at_rest));
        let sign = if sense == Sense::Negative { -1.0 } else { 1.0 };
        let largest = match sense {
            Sense::Either => self.at_rest.largest_magnitude(),
            _ => at_rest.iter().fold(0.0_f64, |m, e| m.max(sign * e.value)),
        };
        let least = (mask * largest).max(1e-9 * self.at_rest.largest_magnitude());
        let pairs = dynamic.iter().zip(&at_rest).map(|(d, s)| match ratio {
            Ratio::Extremes => (d.value, s.value, s.value),
            Ratio::AtDynamicExtreme => (d.value, d.partner, s.value),
            Ratio::AtStaticExtreme => (s.partner, s.value, s.value),
        });
        pairs
            .map(|(numerator, denominator, extreme)| {
                let size = |value: f64| if sense == Sense::Either { value.abs() } else { sign * value };
                let divisible = size(denominator) > least && size(extreme) > least;
                if !divisible {
                    f64::NAN
                } else if ratio == Ratio::Extremes {
                    // The largest shears may differ in sign: the magnitudes are compared.
                    size(numerator) / size(denominator)
                } else {
                    numerator / denominator
                }
            })
            .collect()
    }
}

/// Which extremes an impact factor compares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sense {
    /// The largest: deflection down, sagging, reaction up.
    Positive,
    /// The smallest: hogging.
    Negative,
    /// Those of the largest magnitude: shear.
    Either,
}

/// Which dynamic value is divided by which static one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ratio {
    /// Dynamic extreme by static extreme, at different times in general: the impact factor of KTN73.
    Extremes,
    /// Dynamic extreme by the static value at that time.
    AtDynamicExtreme,
    /// Dynamic value at the time of the static extreme by that extreme.
    AtStaticExtreme,
}
