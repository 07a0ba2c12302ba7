//! The states of a crossing, one row per instant, column by column.

use std::ops::{Range, RangeInclusive};

use serde::{Deserialize, Serialize};

use crate::geometry::Geometry;
use crate::step::newmark::Coordinate;
use crate::step::stepper::State;
use crate::step::vibration::Reach;
use crate::vehicle::equations::{Assembly, Sprung};

/// A vehicle's columns in a [`History`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Columns {
    /// Its axles among all, front first.
    pub axles: Range<usize>,
    /// Its numbers in a row of `motion`: value, velocity and acceleration of each of its coordinates, then of its travel.
    pub motion: Range<usize>,
    /// Its friction elements among all.
    pub frictions: Range<usize>,
    /// +1 for travel to the right, −1 to the left.
    pub direction: f64,
    /// When it came to rest, if it did [s].
    pub stopped: Option<f64>,
}

/// States of a crossing, step after step. Arrays hold one row per instant.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// Number of axles, of all vehicles.
    pub axles: usize,
    /// Number of included modes.
    pub modes: usize,
    /// Number of friction elements beside those of massless axles.
    pub frictions: usize,
    /// The vehicles.
    pub vehicles: Vec<Columns>,
    /// Time step [s]; the last row may end a shorter one.
    pub step: f64,
    /// When the last vehicle had left the bridge, or stood for good [s].
    pub ended: f64,
    /// The last row that counts for what concerns vehicles only: by its end all had left the bridge. Where some stand on
    /// it for good, the last of all.
    pub last_on: usize,
    /// Whether the tail ended because nothing that is looked at can follow.
    pub settled: bool,
    /// What free vibration can reach after the end; none where a vehicle stands on the bridge.
    pub reach: Option<Reach<f64>>,
    /// Static axle loads [N].
    pub static_loads: Vec<f64>,
    /// Time since the start [s].
    pub time: Vec<f64>,
    /// Axle positions from the left end of the bridge [m], row by row.
    pub positions: Vec<f64>,
    /// Axle loads [N], row by row.
    pub loads: Vec<f64>,
    /// Modal coordinates [m kg^½], row by row.
    pub a: Vec<f64>,
    /// Modal velocities [m kg^½/s], row by row.
    pub a_dot: Vec<f64>,
    /// Modal accelerations [m kg^½/s²], row by row.
    pub a_ddot: Vec<f64>,
    /// Coordinates and travel of each vehicle with their first and second derivatives, row by row.
    pub motion: Vec<f64>,
    /// Suspension shortenings since the static state [m], row by row.
    pub shortenings: Vec<f64>,
    /// Friction forces in the suspensions [N], row by row.
    pub friction: Vec<f64>,
    /// Friction forces between bodies, and again of the suspensions of axles with mass [N], row by row.
    pub rubbing: Vec<f64>,
    /// Road elevations under the axles [m], row by row.
    pub elevations: Vec<f64>,
}

/// A time during which a wheel was off the road.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LiftOff {
    /// The axle, among all.
    pub axle: usize,
    /// First instant without contact [s].
    pub from: f64,
    /// First instant with contact again, or the end [s].
    pub to: f64,
}

impl History {
    /// Number of instants.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no instant (never so after a crossing).
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Numbers in a row of `motion`.
    pub fn motion_width(&self) -> usize {
        self.vehicles.last().map_or(0, |v| v.motion.end)
    }

    /// Speed of a vehicle's centre of mass at the end [m/s].
    pub fn final_speed(&self, vehicle: usize) -> f64 {
        let row = self.motion.len() - self.motion_width();
        self.motion[row + self.vehicles[vehicle].motion.end - 2]
    }

    /// The direction in which an axle travels.
    pub fn direction(&self, axle: usize) -> f64 {
        self.vehicles.iter().find(|v| v.axles.contains(&axle)).map_or(1.0, |v| v.direction)
    }

    /// Every time a wheel was off the road until the last vehicle had left the bridge, axle by axle. At the instants the
    /// load of such a wheel is exactly zero.
    pub fn lift_offs(&self) -> Vec<LiftOff> {
        let mut all = Vec::new();
        for axle in (0..self.axles).filter(|&axle| self.static_loads[axle] > 0.0) {
            let mut from = None;
            for (i, &time) in self.time[..=self.last_on].iter().enumerate() {
                let off = self.loads[i * self.axles + axle] == 0.0;
                match from {
                    None if off => from = Some(time),
                    Some(since) if !off => {
                        all.push(LiftOff { axle, from: since, to: time });
                        from = None;
                    }
                    _ => {}
                }
            }
            if let Some(from) = from {
                all.push(LiftOff { axle, from, to: self.time[self.last_on] });
            }
        }
        all
    }

    /// The instants from the first with one of these axles on a bridge of this length [m] to that at which the last of
    /// them leaves it.
    pub fn on_bridge(&self, axles: &Range<usize>, length: f64) -> RangeInclusive<usize> {
        // With the last axle on the end of the bridge, rounding does not decide.
        let bridge = 0.0..=length * (1.0 + 1e-12);
        let on = |i: &usize| self.positions[i * self.axles..][axles.clone()].iter().any(|x| bridge.contains(x));
        let first = (0..self.len()).find(on).unwrap_or(0);
        first..=(first..self.len()).rev().find(on).unwrap_or(first)
    }

    /// Root mean square of each axle load about its static value, by that value, while its vehicle is on a bridge of this
    /// length [m] [-].
    pub fn load_coefficients(&self, length: f64) -> Vec<f64> {
        let mut found = Vec::with_capacity(self.axles);
        for Columns { axles, .. } in &self.vehicles {
            let there = self.on_bridge(axles, length);
            let count = there.clone().count() as f64;
            found.extend(axles.clone().map(|k| {
                let at_rest = self.static_loads[k];
                let squares: f64 = there.clone().map(|i| (self.loads[i * self.axles + k] - at_rest).powi(2)).sum();
                (squares / count).sqrt() / at_rest
            }));
        }
        found
    }

    pub(crate) fn record<'a>(
        &mut self,
        time: f64,
        state: &State<f64>,
        geometry: &impl Geometry<f64>,
        assemblies: impl Iterator<Item = &'a Assembly>,
    ) {
        self.time.push(time);
        for k in 0..self.axles {
            self.positions.push(geometry.motion(k).x);
            self.loads.push(self.static_loads[k] + state.increments[k]);
            self.elevations.push(geometry.surface(k).elevation);
        }
        for stroke in &state.strokes[self.axles..] {
            self.rubbing.push(stroke.friction);
        }
        for mode in &state.modes {
            self.a.push(mode.x);
            self.a_dot.push(mode.v);
            self.a_ddot.push(mode.a);
        }
        let mut first = 0;
        for ((vehicle, assembly), travel) in self.vehicles.iter().zip(assemblies).zip(&state.travel) {
            let coordinates = &state.coordinates[first..first + assembly.mass.nrows()];
            for Coordinate { x, v, a } in coordinates.iter().chain([travel]) {
                self.motion.extend([x, v, a]);
            }
            first += coordinates.len();
            for (axle, sprung) in vehicle.axles.clone().zip(&assembly.suspensions) {
                let (shortening, friction) = match sprung {
                    None => (state.strokes[axle].shortening, state.strokes[axle].friction),
                    Some(Sprung { row, friction }) => {
                        let shortening = row.iter().zip(coordinates).map(|(b, q)| b * q.x).sum();
                        let element = friction.map(|f| self.axles + vehicle.frictions.start + f);
                        (shortening, element.map_or(0.0, |k| state.strokes[k].friction))
                    }
                };
                self.shortenings.push(shortening);
                self.friction.push(friction);
            }
        }
    }

    fn columns(&mut self) -> [(&mut Vec<f64>, usize); 11] {
        let [m, k, f, w] = [self.modes, self.axles, self.frictions, self.motion_width()];
        [
            (&mut self.time, 1),
            (&mut self.positions, k),
            (&mut self.loads, k),
            (&mut self.a, m),
            (&mut self.a_dot, m),
            (&mut self.a_ddot, m),
            (&mut self.motion, w),
            (&mut self.shortenings, k),
            (&mut self.friction, k),
            (&mut self.rubbing, f),
            (&mut self.elevations, k),
        ]
    }

    /// Multiplies A and Ȧ from a row on.
    pub(crate) fn scale(&mut self, from: usize, coordinates: f64, rates: f64) {
        for (values, factor) in [(&mut self.a, coordinates), (&mut self.a_dot, rates)] {
            if factor != 1.0 {
                values[from * self.modes..].iter_mut().for_each(|value| *value *= factor);
            }
        }
    }

    /// Makes room for this many instants.
    pub(crate) fn reserve(&mut self, instants: usize) {
        for (column, width) in self.columns() {
            column.reserve_exact(width * instants);
        }
    }

    /// Cuts the last step short: its end becomes the state this fraction of the way through it.
    pub(crate) fn shorten_last(&mut self, fraction: f64) {
        for (column, width) in self.columns() {
            let last = column.len() - width;
            let (before, after) = column.split_at_mut(last);
            for (b, a) in before[last - width..].iter().zip(after) {
                *a = b + fraction * (*a - b);
            }
        }
    }
}
