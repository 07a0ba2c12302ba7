//! Extremes of every response, where and when they occur, and the impact factors a bridge engineer reads off them.

use crate::crossing::History;
use crate::error::Error;
use crate::influence::Responses;
use crate::recovery::{Instant, Place, Rows};

/// An extreme of a response over a crossing.
#[derive(Debug, Clone, Copy, PartialEq)]
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

impl Extreme {
    /// Of nothing seen yet: loses against every number.
    fn none(value: f64) -> Self {
        Extreme { value, time: f64::NAN, position: f64::NAN, partner: f64::NAN }
    }
}

/// Largest and smallest of every response.
#[derive(Debug, Clone, PartialEq)]
pub struct Extremes {
    /// Largest values.
    pub max: Vec<Extreme>,
    /// Smallest values.
    pub min: Vec<Extreme>,
}

impl Extremes {
    fn new(responses: usize) -> Self {
        Extremes {
            max: vec![Extreme::none(f64::NEG_INFINITY); responses],
            min: vec![Extreme::none(f64::INFINITY); responses],
        }
    }

    /// Takes in the responses from `first` on at one instant; of equal values the earliest stays.
    fn take(&mut self, first: usize, values: &[f64], partners: &[f64], time: f64, position: f64) {
        for (i, (&value, &partner)) in values.iter().zip(partners).enumerate() {
            let r = first + i;
            if value > self.max[r].value {
                self.max[r] = Extreme { value, time, position, partner };
            }
            if value < self.min[r].value {
                self.min[r] = Extreme { value, time, position, partner };
            }
        }
    }
}

/// Dynamic and static extremes of a crossing.
#[derive(Debug, Clone, PartialEq)]
pub struct Envelope {
    /// Of the dynamic responses.
    pub dynamic: Extremes,
    /// Of the responses to the static axle loads at the same positions.
    pub at_rest: Extremes,
}

/// Responses at every instant of a history, row by row.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Responded {
    /// Dynamic.
    pub dynamic: Vec<f64>,
    /// Static.
    pub at_rest: Vec<f64>,
}

/// Goes through a history once: extremes of all responses and, if `keep`, the responses at every instant.
///
/// A moment peaks, and a shear jumps, as an axle passes the section, and where the bridge has a free end every response
/// jumps as an axle enters or leaves. These instants are part of the extremes, from the interpolated state and on both
/// sides, so that the extremes converge with the square of the step.
pub fn survey(
    history: &History,
    rows: &Rows,
    responses: &Responses,
    keep: bool,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<(Envelope, Responded), Error> {
    let n = rows.len();
    let axles = history.axles;
    let mut envelope = Envelope { dynamic: Extremes::new(n), at_rest: Extremes::new(n) };
    let kept = if keep { n * history.len() } else { n };
    let mut responded = Responded { dynamic: vec![0.0; kept], at_rest: vec![0.0; kept] };
    let mut passing = Passing::new(history, rows, responses);
    let mut places: Vec<Place> = vec![None; axles];
    for i in 0..history.len() {
        if i > 0 {
            passing.between(i, &mut envelope);
        }
        let positions = &history.positions[i * axles..(i + 1) * axles];
        for (place, &x) in places.iter_mut().zip(positions) {
            *place = rows.place(x);
        }
        let row = if keep { i * n } else { 0 };
        let (dynamic, at_rest) = (&mut responded.dynamic[row..row + n], &mut responded.at_rest[row..row + n]);
        rows.evaluate(&instant(history, i, &places), dynamic, at_rest);
        envelope.dynamic.take(0, dynamic, at_rest, history.time[i], positions[0]);
        envelope.at_rest.take(0, at_rest, dynamic, history.time[i], positions[0]);
        if i % 1024 == 0 && !go_on() {
            return Err(Error::Interrupted);
        }
    }
    if !keep {
        responded = Responded::default();
    }
    Ok((envelope, responded))
}

fn instant<'a>(history: &'a History, i: usize, places: &'a [Place]) -> Instant<'a> {
    let (m, k) = (history.modes, history.axles);
    Instant {
        a: &history.a[i * m..(i + 1) * m],
        a_dot: &history.a_dot[i * m..(i + 1) * m],
        a_ddot: &history.a_ddot[i * m..(i + 1) * m],
        loads: &history.loads[i * k..(i + 1) * k],
        static_loads: &history.static_loads,
        places,
    }
}

/// The instants at which an axle stands on a section or on an end of the bridge.
struct Passing<'a> {
    history: &'a History,
    rows: &'a Rows,
    /// Nodes to stop at, with the section there if any, left to right.
    stops: Vec<(usize, Option<usize>)>,
    sections: usize,
    /// For every axle the next stop ahead.
    ahead: Vec<usize>,
    state: Interpolated,
    dynamic: Vec<f64>,
    at_rest: Vec<f64>,
}

/// A state between two rows of a history.
#[derive(Default)]
struct Interpolated {
    a: Vec<f64>,
    a_dot: Vec<f64>,
    a_ddot: Vec<f64>,
    loads: Vec<f64>,
    positions: Vec<f64>,
    places: Vec<Place>,
}

impl<'a> Passing<'a> {
    fn new(history: &'a History, rows: &'a Rows, responses: &Responses) -> Self {
        let mut stops: Vec<(usize, Option<usize>)> =
            responses.sections().iter().enumerate().map(|(s, &node)| (node, Some(s))).collect();
        stops.extend([(0, None), (rows.mesh().panels(), None)]);
        stops.sort_unstable();
        let x = rows.mesh().nodes();
        let ahead =
            (0..history.axles).map(|k| stops.partition_point(|stop| x[stop.0] <= history.positions[k])).collect();
        Passing {
            history,
            rows,
            stops,
            sections: responses.sections().len(),
            ahead,
            state: Interpolated::default(),
            dynamic: vec![0.0; rows.len()],
            at_rest: vec![0.0; rows.len()],
        }
    }

    /// Takes in every stop that an axle passes between rows i − 1 and i.
    fn between(&mut self, i: usize, envelope: &mut Envelope) {
        let axles = self.history.axles;
        for k in 0..axles {
            let from = self.history.positions[(i - 1) * axles + k];
            let to = self.history.positions[i * axles + k];
            while let Some(&(node, section)) = self.stops.get(self.ahead[k]) {
                let x = self.rows.mesh().nodes()[node];
                if x > to {
                    break;
                }
                self.ahead[k] += 1;
                self.state.set(self.history, i, (x - from) / (to - from), self.rows);
                let panel = node.checked_sub(1).map(|left| (left, 1.0));
                let next = (node < self.rows.mesh().panels()).then_some((node, 0.0));
                for side in [panel, next] {
                    self.state.places[k] = side;
                    self.take(i, (x - from) / (to - from), section, envelope);
                }
            }
        }
    }

    fn take(&mut self, i: usize, fraction: f64, section: Option<usize>, envelope: &mut Envelope) {
        let time = self.history.time[i - 1] + fraction * (self.history.time[i] - self.history.time[i - 1]);
        let position = self.state.positions[0];
        let now = Instant {
            a: &self.state.a,
            a_dot: &self.state.a_dot,
            a_ddot: &self.state.a_ddot,
            loads: &self.state.loads,
            static_loads: &self.history.static_loads,
            places: &self.state.places,
        };
        let n = self.rows.len();
        let mut range = |first: usize, count: usize| {
            let (dynamic, at_rest) = (&mut self.dynamic[..count], &mut self.at_rest[..count]);
            self.rows.evaluate_range(&now, first, dynamic, at_rest);
            envelope.dynamic.take(first, dynamic, at_rest, time, position);
            envelope.at_rest.take(first, at_rest, dynamic, time, position);
        };
        match section {
            // Deflection, moment and both shears of the section itself.
            Some(s) => (0..4).for_each(|quantity| range(quantity * self.sections + s, 1)),
            None => range(0, n),
        }
    }
}

impl Interpolated {
    fn set(&mut self, history: &History, i: usize, fraction: f64, rows: &Rows) {
        let mix = |out: &mut Vec<f64>, values: &[f64], width: usize| {
            out.clear();
            let (before, after) = (&values[(i - 1) * width..i * width], &values[i * width..(i + 1) * width]);
            out.extend(before.iter().zip(after).map(|(b, a)| b + fraction * (a - b)));
        };
        mix(&mut self.a, &history.a, history.modes);
        mix(&mut self.a_dot, &history.a_dot, history.modes);
        mix(&mut self.a_ddot, &history.a_ddot, history.modes);
        mix(&mut self.loads, &history.loads, history.axles);
        mix(&mut self.positions, &history.positions, history.axles);
        self.places.clear();
        self.places.extend(self.positions.iter().map(|&x| rows.place(x)));
    }
}

/// Extremes of the axle loads.
pub fn axle_loads(history: &History) -> Envelope {
    let axles = history.axles;
    let mut envelope = Envelope { dynamic: Extremes::new(axles), at_rest: Extremes::new(axles) };
    for (i, loads) in history.loads.chunks_exact(axles).enumerate() {
        let position = history.positions[i * axles];
        envelope.dynamic.take(0, loads, &history.static_loads, history.time[i], position);
        envelope.at_rest.take(0, &history.static_loads, loads, history.time[i], position);
    }
    envelope
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
                // A shear may change sign between the two instants: then the magnitudes are compared.
                if !divisible {
                    f64::NAN
                } else if ratio == Ratio::Extremes {
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
    /// Dynamic extreme by static extreme, at different times in general: the impact factor of [KTN73].
    Extremes,
    /// Dynamic extreme by the static value at that time.
    AtDynamicExtreme,
    /// Dynamic value at the time of the static extreme by that extreme.
    AtStaticExtreme,
}
