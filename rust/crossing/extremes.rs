//! Extremes of all responses over a crossing, found at every instant of its history and as axles pass sections.

use std::ops::Range;

use crate::crossing::envelope::{Envelope, Extreme, Extremes};
use crate::crossing::history::History;
use crate::crossing::watched::Watched;
use crate::error::Error;
use crate::lane::Lane;
use crate::recovery::{Instant, Packed, Place, Responding, Rows, WIDTH};
use crate::statics::influence::{Quantity, Responses};
use crate::stop_token::StopToken;

/// Instants between two questions whether to go on.
const POLL_EVERY: usize = 1024;

/// Extremes of all responses over a history, while it grows.
///
/// A moment peaks, and a shear jumps, as an axle passes the section, and where the bridge has a free end every response
/// jumps as an axle enters or leaves. These instants are part of the extremes, from the interpolated state and on both
/// sides, so that the extremes converge with the square of the step. At a free end the axle load itself jumps, as the
/// wheel drops on or off the deflected tip; there they converge with the step.
pub struct Survey<'a> {
    rows: &'a Rows,
    /// Instants that have been looked at.
    seen: usize,
    passing: Passing,
    /// From the passing of stops, in the end from all.
    dynamic: Extremes,
    at_rest: Extremes,
    /// At the instants of the history, dynamic and static.
    watched: Vec<[Watched<Responding>; 2]>,
    /// The instant of a stop.
    between: Packed,
}

/// Some instants of a survey, compiled once for each instruction set.
struct GoThrough<'s, 'a> {
    survey: &'s mut Survey<'a>,
    history: &'s History,
    packed: &'s Packed,
    instants: Range<usize>,
}

impl pulp::WithSimd for GoThrough<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        self.survey.go_through(self.history, self.packed, self.instants);
    }
}

impl<'a> Survey<'a> {
    /// Of a history that has begun.
    pub fn new(history: &History, rows: &'a Rows, responses: &Responses) -> Self {
        Survey {
            rows,
            seen: 0,
            passing: Passing::new(history, rows, responses),
            dynamic: Extremes::none(rows.len()),
            at_rest: Extremes::none(rows.len()),
            watched: vec![[Watched::nothing(); 2]; rows.blocks()],
            between: Packed::default(),
        }
    }

    /// Goes on to the last instant that there is, `packed` being those of the history.
    pub fn go_on(&mut self, history: &History, packed: &Packed, stop: StopToken<'_>) -> Result<(), Error> {
        // The widest instruction set that the processor has; none of them changes a bit, because nothing is fused.
        let arch = pulp::Arch::new();
        while self.seen < history.len() {
            let instants = self.seen..(self.seen + POLL_EVERY).min(history.len());
            self.seen = instants.end;
            arch.dispatch(GoThrough { survey: self, history, packed, instants });
            stop.check()?;
        }
        Ok(())
    }

    /// Largest and smallest of a response so far.
    pub fn reached(&self, r: usize) -> [f64; 2] {
        let [dynamic, _] = &self.watched[r / WIDTH];
        let (max, min) = (dynamic.max.get(r % WIDTH), dynamic.min.get(r % WIDTH));
        [max.larger(self.dynamic.max[r].value), min.smaller(self.dynamic.min[r].value)]
    }

    /// Whether every axle had passed every stop, so that nothing but instants of the history follows.
    pub fn is_past(&self) -> bool {
        self.passing.passed.iter().all(|&count| count == self.passing.stops.len())
    }

    #[inline(always)]
    fn go_through(&mut self, history: &History, packed: &Packed, instants: Range<usize>) {
        for (b, watched) in self.watched.iter_mut().enumerate() {
            let [mut dynamic, mut at_rest] = *watched;
            let mut number = instants.start as f64;
            for now in packed.instants(instants.clone()) {
                let (d, s) = self.rows.block(b, now);
                dynamic.take(Responding::from(d), Responding::splat(number));
                at_rest.take(Responding::from(s), Responding::splat(number));
                number += 1.0;
            }
            *watched = [dynamic, at_rest];
        }
        for instant in instants.start.max(1)..instants.end {
            self.pass(history, instant);
        }
    }

    /// The extremes at the instants of the history and those at the stops together.
    pub fn conclude(mut self, history: &History, packed: &Packed) -> Envelope {
        for r in 0..self.rows.len() {
            let (b, i) = (r / WIDTH, r % WIDTH);
            let [dynamic, at_rest] = self.watched[b];
            for at in [dynamic.max_at, dynamic.min_at, at_rest.max_at, at_rest.min_at] {
                let instant = at.get(i) as usize;
                let (time, position) = (history.time[instant], history.positions[instant * history.axles]);
                for now in packed.instants(instant..instant + 1) {
                    let (d, s) = self.rows.block(b, now);
                    self.dynamic.take(r, Extreme { value: d[i], time, position, partner: s[i] });
                    self.at_rest.take(r, Extreme { value: s[i], time, position, partner: d[i] });
                }
            }
        }
        Envelope { dynamic: self.dynamic, at_rest: self.at_rest }
    }

    /// Takes in every stop that an axle passes between instants i − 1 and i, on both sides of it.
    fn pass(&mut self, history: &History, i: usize) {
        for axle in 0..history.axles {
            while let Some((node, section, fraction)) = self.passing.next(history, i, axle) {
                self.passing.state.set(history, i, fraction, self.rows);
                let left = node.checked_sub(1).map(|panel| (panel, 1.0));
                let right = (node < self.rows.mesh().panels()).then_some((node, 0.0));
                let [before, after] = if self.passing.to_the_right[axle] { [left, right] } else { [right, left] };
                for (side, row) in [(before, i - 1), (after, i)] {
                    self.passing.state.places[axle] = side;
                    if !self.passing.continuous(node) {
                        self.passing.state.jump(history, row, axle);
                    }
                    self.stop(history, node, section, axle);
                }
            }
        }
    }

    /// Takes in the responses of a section, or all at an end of the bridge, from the interpolated state.
    fn stop(&mut self, history: &History, node: usize, section: Option<usize>, axle: usize) {
        let state = &self.passing.state;
        self.between.clear();
        self.rows.pack(&state.instant(&history.static_loads), &mut self.between);
        let (time, position) = (state.time, state.positions[0]);
        let sections = self.passing.sections;
        let mut take = |now, r: usize| {
            let (dynamic, at_rest) = self.rows.block(r / WIDTH, now);
            let (dynamic, at_rest) = (dynamic[r % WIDTH], at_rest[r % WIDTH]);
            self.dynamic.take(r, Extreme { value: dynamic, time, position, partner: at_rest });
            self.at_rest.take(r, Extreme { value: at_rest, time, position, partner: dynamic });
        };
        for now in self.between.instants(0..1) {
            match section {
                // Deflection, moment and both shears of the section itself: what else is looked at must not matter.
                Some(s) => (0..4).for_each(|quantity| take(now, quantity * sections + s)),
                None => (0..self.rows.len()).for_each(|r| take(now, r)),
            }
        }
        // On an end itself the axle stands beyond the section that looks at it from inside.
        if let Some((r, sign)) = self.passing.tip_shear(node)
            && state.places[axle].is_some()
        {
            for now in self.between.instants(0..1) {
                let (dynamic, at_rest) = self.rows.block(r / WIDTH, now);
                let dynamic = dynamic[r % WIDTH] + sign * self.rows.weight() * state.loads[axle];
                let at_rest = at_rest[r % WIDTH] + sign * history.static_loads[axle];
                self.dynamic.take(r, Extreme { value: dynamic, time, position, partner: at_rest });
                self.at_rest.take(r, Extreme { value: at_rest, time, position, partner: dynamic });
            }
        }
    }
}

/// An end of the bridge.
struct End {
    node: usize,
    supported: bool,
    /// The shear just inside it, if looked at, and the sign with which an axle on the end adds to it.
    shear: Option<(usize, f64)>,
}

/// The instants at which an axle stands on a section or on an end of the bridge.
struct Passing {
    /// Stops, left to right: node, position [m], and the section there if it is not an end of the bridge.
    stops: Vec<(usize, f64, Option<usize>)>,
    sections: usize,
    ends: [End; 2],
    /// Whether each axle travels to the right.
    to_the_right: Vec<bool>,
    /// For every axle the number of stops it has passed.
    passed: Vec<usize>,
    state: Interpolated,
}

/// A state between two rows of a history.
#[derive(Default)]
struct Interpolated {
    time: f64,
    a: Vec<f64>,
    a_dot: Vec<f64>,
    a_ddot: Vec<f64>,
    loads: Vec<f64>,
    positions: Vec<f64>,
    places: Vec<Place>,
}

impl Passing {
    fn new(history: &History, rows: &Rows, responses: &Responses) -> Self {
        let (x, last) = (rows.mesh().nodes(), rows.mesh().panels());
        let inner = responses.sections().iter().enumerate().filter(|&(_, &node)| node != 0 && node != last);
        let mut stops: Vec<_> = inner.map(|(section, &node)| (node, x[node], Some(section))).collect();
        stops.extend([(0, x[0], None), (last, x[last], None)]);
        stops.sort_unstable_by_key(|stop| stop.0);
        let to_the_right: Vec<bool> = (0..history.axles).map(|axle| history.direction(axle) > 0.0).collect();
        let passed = to_the_right.iter().zip(&history.positions).map(|(&right, &x)| match right {
            true => stops.partition_point(|stop| stop.1 <= x),
            false => stops.len() - stops.partition_point(|stop| stop.1 < x),
        });
        let passed = passed.collect();
        let shear = |quantity: Quantity, node: usize, sign: f64| {
            let section = responses.sections().iter().position(|&s| s == node);
            section.map(|s| (responses.range(quantity).start + s, sign))
        };
        let ends = [
            End { node: 0, supported: responses.supported(0), shear: shear(Quantity::ShearRight, 0, -1.0) },
            End { node: last, supported: responses.supported(last), shear: shear(Quantity::ShearLeft, last, 1.0) },
        ];
        let sections = responses.sections().len();
        Passing { stops, sections, ends, to_the_right, passed, state: Interpolated::default() }
    }

    /// Whether nothing jumps as an axle passes a node: all but the free ends, whose tip the wheel drops on or off.
    fn continuous(&self, node: usize) -> bool {
        self.ends.iter().all(|end| end.node != node || end.supported)
    }

    /// The shear just inside an end of the bridge, and the sign of an axle on that end.
    fn tip_shear(&self, node: usize) -> Option<(usize, f64)> {
        self.ends.iter().find(|end| end.node == node).and_then(|end| end.shear)
    }

    /// The next stop that an axle passes between instants i − 1 and i: its node, its section, and when, as a fraction.
    #[inline]
    fn next(&mut self, history: &History, i: usize, axle: usize) -> Option<(usize, Option<usize>, f64)> {
        let axles = history.axles;
        let to = history.positions[i * axles + axle];
        let (number, stops) = (self.passed[axle], &self.stops);
        let &(node, x, section) = match self.to_the_right[axle] {
            true => stops.get(number).filter(|stop| stop.1 <= to)?,
            false => stops.get(stops.len().checked_sub(number + 1)?).filter(|stop| stop.1 >= to)?,
        };
        self.passed[axle] += 1;
        let from = history.positions[(i - 1) * axles + axle];
        Some((node, section, (x - from) / (to - from)))
    }
}

impl Interpolated {
    fn set(&mut self, history: &History, i: usize, fraction: f64, rows: &Rows) {
        let mix = |out: &mut Vec<f64>, values: &[f64], width: usize| {
            out.clear();
            let (before, after) = (&values[(i - 1) * width..i * width], &values[i * width..(i + 1) * width]);
            out.extend(before.iter().zip(after).map(|(b, a)| b + fraction * (a - b)));
        };
        self.time = history.time[i - 1] + fraction * (history.time[i] - history.time[i - 1]);
        mix(&mut self.a, &history.a, history.modes);
        mix(&mut self.a_dot, &history.a_dot, history.modes);
        mix(&mut self.a_ddot, &history.a_ddot, history.modes);
        mix(&mut self.loads, &history.loads, history.axles);
        mix(&mut self.positions, &history.positions, history.axles);
        self.places.clear();
        self.places.extend(self.positions.iter().map(|&x| rows.place(x)));
    }

    /// Takes what jumps at a free end, the load of the axle and the modal accelerations, from one row alone.
    fn jump(&mut self, history: &History, row: usize, axle: usize) {
        self.loads[axle] = history.loads[row * history.axles + axle];
        self.a_ddot.copy_from_slice(&history.a_ddot[row * history.modes..(row + 1) * history.modes]);
    }

    fn instant<'a>(&'a self, static_loads: &'a [f64]) -> Instant<'a> {
        Instant {
            a: &self.a,
            a_dot: &self.a_dot,
            a_ddot: &self.a_ddot,
            loads: &self.loads,
            static_loads,
            places: &self.places,
        }
    }
}
