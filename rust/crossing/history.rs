//! The states of a crossing, one row per instant, column by column.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::bridge::cubics::Mesh;
use crate::coordinate::Coordinate;
use crate::error::Error;
use crate::extremes::interpolate;
use crate::geometry::Geometry;
use crate::recovery::{Place, Placed, Rows, WIDTH};
use crate::statistics::Ride;
use crate::step::stepper::State;
use crate::step::vibration::Reach;
use crate::stop_token::StopToken;
use crate::stops::{Positions, Stop};
use crate::tape::{BridgeFactors, CHUNK, Tape, Widths};
use crate::vehicle::equations::{Assembly, Sprung};

/// Steps looked at together; afterwards the stop token is asked.
pub const TOGETHER: usize = 1024;

/// A vehicle's columns in a [`History`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VehicleColumns {
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
    pub vehicles: Vec<VehicleColumns>,
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

    /// The steps from the first with one of these axles on the bridge to that at which the last of them leaves it.
    pub fn on_bridge(&self, axles: &Range<usize>, mesh: &Mesh) -> Range<usize> {
        let on = |step: &usize| axles.clone().any(|axle| mesh.is_on(self.x(*step, axle)));
        let first = (0..=self.last_on).find(on).unwrap_or(0);
        first..(first..=self.last_on).rev().find(on).unwrap_or(first) + 1
    }

    /// Writes down what the rows multiply at a step, on a bridge that may be varied by `factors`.
    pub fn write(&self, step: usize, widths: &Widths, factors: Option<&BridgeFactors<f64>>, row: &mut [f64]) {
        let derivative = |order: usize, m: usize| [&self.a, &self.a_dot, &self.a_ddot][order][step * self.modes + m];
        widths.write_modes(row, self.modes, derivative, factors);
        if widths.felt {
            let loads = &self.loads[step * self.axles..][..self.axles];
            row[widths.coordinates..].iter_mut().zip(loads).for_each(|(own, load)| *own = *load);
        }
    }

    /// The same at a stop; `sides` is room for the steps before and after it.
    pub fn write_at(
        &self,
        stop: &Stop,
        widths: &Widths,
        factors: Option<&BridgeFactors<f64>>,
        sides: &mut [Vec<f64>; 2],
        row: &mut Vec<f64>,
    ) {
        for (side, step) in sides.iter_mut().zip([stop.step - 1, stop.step]) {
            side.resize(widths.used(), 0.0);
            self.write(step, widths, factors, side);
        }
        let [before, after] = sides;
        interpolate(stop, [before, after], widths, row);
    }

    /// The responses of a range of `rows` at every instant, dynamic and static, row by row.
    pub fn responses(&self, rows: &Rows, range: Range<usize>, stop: StopToken<'_>) -> Result<[Vec<f64>; 2], Error> {
        let count = range.len() * self.len();
        let out = [Vec::with_capacity(count), Vec::with_capacity(count)];
        let mut filling = Filling { history: self, rows, range, steps: 0..0, out };
        let arch = pulp::Arch::new();
        for from in (0..self.len()).step_by(TOGETHER) {
            filling.steps = from..(from + TOGETHER).min(self.len());
            arch.dispatch(&mut filling);
            stop.check()?;
        }
        Ok(filling.out)
    }

    /// The part of the deck's acceleration that the modes left out have as the loads, held as they are, move on, at every
    /// step and section: Σ P (v² g″ + a g′) of the deflections in `rows` [m/s²], docs/theory.md (M2).
    pub fn quasi_static_acceleration(
        &self,
        rows: &Rows,
        deflections: Range<usize>,
        stop: StopToken<'_>,
    ) -> Result<Vec<f64>, Error> {
        let (mut all, mut places) = (Vec::with_capacity(self.len() * deflections.len()), Vec::new());
        for step in 0..self.len() {
            self.places(step, rows, &mut places);
            let first = all.len();
            all.resize(first + deflections.len(), 0.0);
            for VehicleColumns { axles, motion, direction, .. } in &self.vehicles {
                let [v, a] = [2, 1].map(|back| self.motion[step * self.motion_width() + motion.end - back]);
                for axle in axles.clone() {
                    let Some(place) = places[axle] else { continue };
                    let load = self.loads[step * self.axles + axle];
                    for (sum, response) in all[first..].iter_mut().zip(deflections.clone()) {
                        let [slope, curvature] = rows.derivatives_of(response, place);
                        *sum += load * (v * v * curvature + direction * a * slope);
                    }
                }
            }
            stop.check()?;
        }
        Ok(all)
    }

    /// Where the axles stand at the end of a step; `places` are those of another, from which it may not be far.
    pub fn places(&self, step: usize, rows: &Rows, places: &mut Vec<Place>) {
        places.resize(self.axles, None);
        for (axle, place) in places.iter_mut().enumerate() {
            *place = rows.place_near(self.x(step, axle), *place);
        }
    }

    /// Adds what the rows multiply at a step, dynamic and at rest; a `row` and the `places` of the step before are room to
    /// work in.
    pub fn make_ready(
        &self,
        step: usize,
        rows: &Rows,
        widths: &Widths,
        factors: Option<&BridgeFactors<f64>>,
        (row, places): (&mut [f64], &mut Vec<Place>),
        (coordinates, placed): (&mut Vec<[f64; 2]>, &mut Vec<Placed<2>>),
    ) {
        self.write(step, widths, factors, row);
        self.places(step, rows, places);
        let (dynamic, loads) = row.split_at(widths.coordinates);
        let at_rest = rows.static_coordinates(places, &self.static_loads);
        coordinates.extend(dynamic.iter().zip(at_rest).map(|(a, a_static)| [*a, a_static]));
        let loads = loads.iter().zip(&self.static_loads);
        placed.extend(places.iter().zip(loads).map(|(place, (load, at_rest))| Placed::new(*place, [*load, *at_rest])));
    }

    /// The ride of each vehicle: extremes until the last vehicle has left the bridge, means while its own axles are on it.
    /// `bodies` are the vertical displacements of its bodies, as rows over its coordinates.
    pub fn rides(&self, bodies: &[Vec<Vec<f64>>], mesh: &Mesh, stop: StopToken<'_>) -> Result<Vec<Ride<f64>>, Error> {
        let (mut rides, mut tape) = (Vec::with_capacity(self.vehicles.len()), Tape::new());
        for (VehicleColumns { axles, motion, .. }, bodies) in self.vehicles.iter().zip(bodies) {
            let (axles, static_loads) = (axles.clone(), &self.static_loads[axles.clone()]);
            let orders = [false; 3];
            let widths = Widths { coordinates: 0, axles: axles.len(), bodies: bodies.len(), felt: true, orders };
            let mut ride = Ride::nothing(axles.len(), bodies.len());
            let there = self.on_bridge(&axles, mesh);
            let (before, after) = (0..there.start, there.end..self.last_on + 1);
            for (steps, counted) in [(before, false), (there, true), (after, false)] {
                for from in steps.clone().step_by(CHUNK) {
                    let to = steps.end.min(from + CHUNK);
                    tape.begin(widths, from, 1);
                    for step in from..to {
                        let [_, row] = tape.row_mut(step);
                        let (loads, accelerations) = row.split_at_mut(axles.len());
                        let own = &self.loads[step * self.axles..][axles.clone()];
                        loads.iter_mut().zip(own).for_each(|(load, own)| *load = *own);
                        let motion = &self.motion[step * self.motion_width()..][motion.clone()];
                        for (acceleration, body) in accelerations.iter_mut().zip(bodies) {
                            let terms = body.iter().zip(motion.iter().skip(2).step_by(3));
                            *acceleration = terms.fold(0.0, |sum, (factor, a)| sum + factor * a);
                        }
                    }
                    tape.take(to - from);
                    ride.take(&tape, static_loads, |step| self.left(step), counted);
                    stop.check()?;
                }
            }
            rides.push(ride);
        }
        Ok(rides)
    }

    /// Length of the step after this one, in whole steps; zero once the last vehicle has left.
    fn left(&self, step: usize) -> f64 {
        match step + 1 {
            next if next > self.last_on => 0.0,
            next if next + 1 == self.len() => part(self.time[next] - self.time[step], self.step),
            _ => 1.0,
        }
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

/// A length of time by that of a step, which it is part of, or the whole.
pub fn part(time: f64, step: f64) -> f64 {
    let part = time / step;
    if part > 1.0 - 1e-9 { 1.0 } else { part }
}

impl Positions for History {
    fn axles(&self) -> usize {
        self.axles
    }

    fn x(&self, step: usize, axle: usize) -> f64 {
        self.positions[step * self.axles + axle]
    }
}

/// Histories of responses being filled in, compiled once for each instruction set.
struct Filling<'a> {
    history: &'a History,
    rows: &'a Rows,
    range: Range<usize>,
    steps: Range<usize>,
    out: [Vec<f64>; 2],
}

impl pulp::WithSimd for &mut Filling<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        let Filling { history, rows, range, steps, out } = self;
        let widths = Widths::of(rows, history.axles, 0);
        let mut row = vec![0.0; widths.used()];
        let (mut places, mut coordinates, mut placed) = (Vec::new(), Vec::new(), Vec::new());
        for step in steps.clone() {
            coordinates.clear();
            placed.clear();
            history.make_ready(step, rows, &widths, None, (&mut row, &mut places), (&mut coordinates, &mut placed));
            for b in range.start / WIDTH..range.end.div_ceil(WIDTH) {
                let first = b * WIDTH;
                let wanted = range.start.max(first) - first..range.end.min(first + WIDTH) - first;
                let values = rows.of_block(b).at(&coordinates, &placed);
                for (out, values) in out.iter_mut().zip(values) {
                    out.extend_from_slice(&values[wanted.clone()]);
                }
            }
        }
    }
}
