//! One block of samples through one crossing, group beside group of lanes: the step of a single crossing, chunk by chunk,
//! and after each chunk the extremes of every response in it.

use super::look::Look;
use super::table::{Below, CHUNK, Table};
use super::watch::{Between, Kept, Ride, Watched, watch, watch_free, watch_stop};
use crate::lane::Lane;
use crate::newmark::Coordinate;
use crate::recovery::Rows;
use crate::road::spline::weighted;
use crate::step::{Geometry, State, Stepper, Surface, Unsettled};

/// The shared table, with the roads and speeds of a group of samples.
#[derive(Debug, Clone)]
pub struct Shared<'a, L> {
    table: &'a Table,
    /// Coefficients of the samples' own roads.
    road: Vec<L>,
    speed: L,
    /// The step, and where the table has it.
    step: usize,
    row: usize,
    surfaces: Vec<Surface<L>>,
}

impl<'a, L: Lane> Shared<'a, L> {
    /// At the start.
    #[inline(always)]
    pub fn new(table: &'a Table, road: Vec<L>, speed: L) -> Self {
        let zero = L::splat(0.0);
        let level = Surface { elevation: zero, slope: zero, curvature: zero };
        let mut shared = Shared { table, road, speed, step: 0, row: 0, surfaces: vec![level; table.axles()] };
        shared.look_down();
        shared
    }

    #[inline(always)]
    fn look_down(&mut self) {
        let axles = self.table.axles();
        let below = &self.table.below[self.row * axles..(self.row + 1) * axles];
        for (surface, below) in self.surfaces.iter_mut().zip(below) {
            *surface = match below {
                Below::Given(s) => Surface {
                    elevation: L::splat(s.elevation),
                    slope: L::splat(s.slope),
                    curvature: L::splat(s.curvature),
                },
                Below::Own { given, taps, share } => {
                    let mask = self.road.len() - 1;
                    let near = [0, 1, 2, 3].map(|k| self.road[taps.first.wrapping_add(k) & mask]);
                    let [elevation, slope, curvature] = given.map(L::splat);
                    let elevation = elevation + weighted(taps.weights[0], near);
                    // Slope and curvature count only where the step asks for them.
                    if self.table.kinds == 1 {
                        share.of([elevation, slope, curvature])
                    } else {
                        let slope = slope + weighted(taps.weights[1], near);
                        share.of([elevation, slope, curvature + weighted(taps.weights[2], near)])
                    }
                }
            };
        }
    }

    #[inline(always)]
    fn entry(&self, contact: usize) -> usize {
        (self.row * self.table.axles() + contact) * self.table.modes * self.table.kinds
    }
}

impl<L: Lane> Geometry<L> for Shared<'_, L> {
    #[inline(always)]
    fn advance(&mut self) {
        self.step += 1;
        self.row = self.step.min(self.table.last());
        self.look_down();
    }

    #[inline(always)]
    fn follow(&mut self, _contact: usize, _motion: Coordinate<L>, _new_step: bool) -> L::Mask {
        L::never()
    }

    #[inline(always)]
    fn motion(&self, contact: usize) -> Coordinate<L> {
        Coordinate { x: L::splat(self.table.path.x(self.step, contact)), v: self.speed, a: L::splat(0.0) }
    }

    #[inline(always)]
    fn shapes(&self, contact: usize, shapes: &mut [L]) {
        let table = self.table.shapes[self.entry(contact)..].iter().step_by(self.table.kinds);
        for (shape, &value) in shapes.iter_mut().zip(table) {
            *shape = L::splat(value);
        }
    }

    #[inline(always)]
    fn slope(&self, contact: usize, mode: usize) -> L {
        L::splat(self.table.shapes[self.entry(contact) + mode * self.table.kinds + 1])
    }

    #[inline(always)]
    fn curvature(&self, contact: usize, mode: usize) -> L {
        L::splat(self.table.shapes[self.entry(contact) + mode * self.table.kinds + 2])
    }

    #[inline(always)]
    fn surface(&self, contact: usize) -> Surface<L> {
        self.surfaces[contact]
    }
}

/// Factors of one sample's bridge on what the rows multiply.
#[derive(Debug, Clone, Copy)]
pub struct Bridge<L> {
    /// On A: the factor of the stiffness.
    pub coordinates: L,
    /// On Ȧ: how the damping matrix grows.
    pub rates: L,
}

/// When the lanes of a group have done.
#[derive(Debug, Clone)]
pub struct Ends<L> {
    /// Last step of each lane.
    pub last: L,
    /// How far through its last step a lane ends.
    pub fraction: L,
    /// Last step of the slowest lane.
    pub latest: usize,
}

/// Samples side by side.
#[derive(Debug, Clone)]
pub struct Group<'a, L> {
    /// Where they are.
    pub geometry: Shared<'a, L>,
    /// Finds the state at the start, for the modes that this has.
    pub starter: Stepper<L>,
    /// Steps without a bridge, as long as no axle has come on to it.
    pub approach: Stepper<L>,
    /// Steps on the bridge.
    pub stepper: Stepper<L>,
    /// Their bridges, if these differ.
    pub bridge: Option<Bridge<L>>,
    /// When they end.
    pub ends: Ends<L>,
    /// Vertical displacements of the bodies, as rows over the coordinates of the vehicle.
    pub bodies: &'a [Vec<f64>],
    /// What is seen of them.
    pub seen: Seen<L>,
}

/// What has been seen of a group.
#[derive(Debug, Clone)]
pub struct Seen<L> {
    /// By row, at steps.
    pub steps: Vec<Watched<L>>,
    /// By row, at stops.
    pub stops: Vec<Watched<L>>,
    /// Contact forces and accelerations.
    pub ride: Ride<L>,
}

impl<L: Lane> Seen<L> {
    /// Nothing yet; but for a bridge that was at rest.
    pub fn nothing(rows: usize, axles: usize, bodies: usize, table: &Table) -> Self {
        let before = if table.first > 0 { Watched::rest() } else { Watched::nothing() };
        Seen {
            steps: vec![before; rows],
            stops: vec![Watched::nothing(); rows],
            ride: Ride::nothing(axles, bodies),
        }
    }
}

/// Why a block did not come through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Trouble {
    /// One of its samples failed, in this step or in the chunk that ends with it.
    Failed(usize, Option<Unsettled>),
    /// The caller wants it to end.
    Interrupted,
}

/// Where a block marches, and what is looked at.
#[derive(Debug, Clone, Copy)]
pub struct Way<'a> {
    /// The shared geometry.
    pub table: &'a Table,
    /// The rows of the bridge.
    pub rows: &'a Rows,
    /// The responses looked at.
    pub look: &'a Look,
    /// Whether to look for trouble after every step and not only after every chunk.
    pub closely: bool,
}

/// One group on its way.
struct Traveller<'g, 'a, L> {
    group: &'g mut Group<'a, L>,
    state: State<L>,
    static_loads: Vec<L>,
    kept: Kept<L>,
    /// One in the lanes that have not ended yet, by step of the chunk.
    active: Vec<L>,
}

impl<L: Lane> Traveller<'_, '_, L> {
    /// Keeps what recovery needs of a step; lanes that have ended repeat the last of theirs.
    #[inline(always)]
    fn keep(&mut self, step: usize, way: &Way<'_>, bridge: bool, tail: bool) {
        let zero = L::splat(0.0);
        let before = [self.kept.coordinates.len(), self.kept.loads.len(), self.kept.accelerations.len()];
        if bridge {
            let rates = way.rows.by_rates();
            match (&self.group.bridge, rates) {
                (None, false) => self.kept.coordinates.extend(self.state.modes.iter().map(|c| c.x)),
                (Some(b), false) => self.kept.coordinates.extend(self.state.modes.iter().map(|c| b.coordinates * c.x)),
                (b, true) => {
                    let factor = b.map_or(L::splat(1.0), |b| b.rates);
                    self.kept.coordinates.extend(self.state.modes.iter().map(|c| factor * c.v));
                    self.kept.coordinates.extend(self.state.modes.iter().map(|c| c.a));
                }
            }
        } else {
            self.kept.coordinates.extend(std::iter::repeat_n(zero, way.rows.width()));
        }
        let loads = self.static_loads.iter().zip(&self.state.increments);
        self.kept.loads.extend(loads.map(|(p, increment)| *p + *increment));
        for row in self.group.bodies {
            let coordinates = row.iter().zip(&self.state.coordinates);
            self.kept.accelerations.push(coordinates.fold(zero, |sum, (b, q)| sum + L::splat(*b) * q.a));
        }
        let one = L::splat(1.0);
        if tail {
            let (now, ends) = (L::splat(step as f64), &self.group.ends);
            let ended = ends.last.less(now);
            let ending = !(ends.last.less(now) | now.less(ends.last));
            let finish = |values: &mut Vec<L>, from: usize, width: usize| {
                for i in from..values.len() {
                    let (b, a) = (values[i - width], values[i]);
                    let short = b + ends.fraction * (a - b);
                    // A whole last step is not rounded.
                    let whole = !ends.fraction.less(one);
                    let last = L::select(ending, L::select(whole, a, short), a);
                    values[i] = L::select(ended, b, last);
                }
            };
            finish(&mut self.kept.coordinates, before[0], way.rows.width());
            finish(&mut self.kept.loads, before[1], self.static_loads.len());
            finish(&mut self.kept.accelerations, before[2], self.group.bodies.len());
            self.active.push(L::select(ended, zero, one));
        } else {
            self.active.push(one);
        }
    }

    /// Whether everything is a finite number in lanes that have not ended.
    #[inline(always)]
    fn sound(&self, step: usize) -> bool {
        let zero = L::splat(0.0);
        let coordinates = self.state.modes.iter().chain(&self.state.coordinates);
        let sum = coordinates.fold(zero, |sum, c| sum + c.a);
        let sum = self.state.increments.iter().fold(sum, |sum, p| sum + *p);
        let nought = sum - sum;
        let ended = self.group.ends.last.less(L::splat(step as f64));
        L::all(!(nought.less(zero) | !nought.less(L::splat(1.0))) | ended)
    }
}

/// Marches groups of samples through the table.
#[inline(always)]
pub fn march<L: Lane>(way: &Way<'_>, groups: &mut [Group<'_, L>], go_on: &dyn Fn() -> bool) -> Result<(), Trouble> {
    let Way { table, rows, look, closely } = *way;
    let (width, axles, steps) = (rows.width(), table.axles(), table.path.steps);
    let latest = groups.iter().map(|group| group.ends.latest).max().unwrap_or(steps);
    let mut travellers: Vec<Traveller<'_, '_, L>> = Vec::with_capacity(groups.len());
    for group in groups {
        let speed = group.geometry.speed;
        let mut state = group.starter.start(&[speed], &group.geometry).map_err(|e| Trouble::Failed(0, Some(e)))?;
        if state.modes.is_empty() && table.first == 0 {
            state.modes = vec![Coordinate::rest(); table.modes];
        }
        let static_loads = group.stepper.static_loads();
        let mut traveller =
            Traveller { group, state, static_loads, kept: Kept::new(), active: Vec::with_capacity(CHUNK) };
        // Before the first step there is nothing: it stands for the one before.
        traveller.keep(0, way, table.first == 0, false);
        travellers.push(traveller);
    }
    let mut scratch = Vec::new();
    let mut stops = table.stops.iter().enumerate().peekable();
    let mut from = 0;
    while from <= latest {
        let (bridge, tail) = (from >= table.first, from > steps);
        let end = if !bridge {
            table.first
        } else if !tail {
            steps + 1
        } else {
            latest + 1
        };
        let to = end.min(from + CHUNK);
        for traveller in &mut travellers {
            traveller.active.clear();
            if bridge && traveller.state.modes.is_empty() {
                traveller.state.modes = vec![Coordinate::rest(); table.modes];
            }
        }
        for step in from..to {
            for traveller in &mut travellers {
                if step > 0 {
                    let Group { geometry, approach, stepper, .. } = &mut *traveller.group;
                    let advanced = match bridge {
                        true => stepper.advance(&mut traveller.state, geometry),
                        false => approach.advance(&mut traveller.state, geometry),
                    };
                    advanced.map_err(|e| Trouble::Failed(step, Some(e)))?;
                }
                traveller.keep(step, way, bridge, tail);
                if closely && !traveller.sound(step) {
                    return Err(Trouble::Failed(step, None));
                }
            }
        }
        let influence = if bridge && !tail { table.influence(from, rows, look, &mut scratch) } else { &[] };
        let first_stop = stops.peek().map_or(table.stops.len(), |(number, _)| *number);
        while stops.next_if(|(_, stop)| stop.step < to).is_some() {}
        let end_stop = stops.peek().map_or(table.stops.len(), |(number, _)| *number);
        let counted = L::splat(if bridge && !tail { 1.0 } else { 0.0 });
        for traveller in &mut travellers {
            if !traveller.sound(to - 1) {
                return Err(Trouble::Failed(to - 1, None));
            }
            let seen = &mut traveller.group.seen;
            let kept = &traveller.kept;
            seen.ride.take(kept, &traveller.static_loads, from, &traveller.active, counted);
            if bridge {
                let coordinates = &kept.coordinates[width..];
                let zeros;
                let felt = if rows.weight() == 1.0 {
                    &kept.loads
                } else {
                    zeros = vec![L::splat(0.0); kept.loads.len()];
                    &zeros
                };
                let count = to - from;
                for (r, (watched, row)) in seen.steps.iter_mut().zip(&look.rows).enumerate() {
                    if tail {
                        watch_free(watched, &row.factors, coordinates, from);
                    } else {
                        let influence = &influence[r * count * axles..(r + 1) * count * axles];
                        watch(watched, &row.factors, influence, coordinates, &felt[axles..], axles, from);
                    }
                }
                for (number, stop) in table.stops[first_stop..end_stop].iter().enumerate() {
                    let row = stop.step - from;
                    let states = Between {
                        coordinates: [row, row + 1].map(|row| &kept.coordinates[row * width..][..width]),
                        loads: [row, row + 1].map(|row| &kept.loads[row * axles..][..axles]),
                        jumps: if rows.by_rates() { width / 2 } else { width },
                        weight: rows.weight(),
                    };
                    watch_stop(&mut seen.stops, stop, first_stop + number, &look.rows, &states);
                }
            }
            let bodies = traveller.group.bodies.len();
            traveller.kept.forget(width, axles, bodies);
        }
        if !go_on() {
            return Err(Trouble::Interrupted);
        }
        from = to;
    }
    Ok(())
}

/// Ā_st under loads, from what loads of one at each axle make of it.
#[inline(always)]
fn combine<L: Lane>(of_one: &[f64], loads: &[L], width: usize, out: &mut Vec<L>) {
    for i in 0..width {
        let terms = of_one.chunks_exact(width).zip(loads);
        out.push(terms.fold(L::splat(0.0), |sum, (shapes, load)| sum + *load * L::splat(shapes[i])));
    }
}

/// The static extremes under loads that differ from sample to sample.
#[inline(always)]
pub fn rest<L: Lane>(way: &Way<'_>, loads: &[L]) -> Seen<L> {
    let Way { table, rows, look, .. } = *way;
    let (width, axles, steps) = (rows.width(), table.axles(), table.path.steps);
    let mut seen = Seen::nothing(look.rows.len(), 0, 0, table);
    let coordinates_at = |step: usize, out: &mut Vec<L>| {
        combine(&table.statics[step * axles * width..(step + 1) * axles * width], loads, width, out);
    };
    let (mut coordinates, mut scratch) = (Vec::new(), Vec::new());
    coordinates_at(table.first.saturating_sub(1), &mut coordinates);
    let on_axles: Vec<L> = (0..CHUNK * axles).map(|i| loads[i % axles]).collect();
    let mut stops = table.stops.iter().enumerate().peekable();
    for from in (table.first..=steps).step_by(CHUNK) {
        let count = CHUNK.min(steps + 1 - from);
        (from..from + count).for_each(|step| coordinates_at(step, &mut coordinates));
        let influence = table.influence(from, rows, look, &mut scratch);
        for (r, (watched, row)) in seen.steps.iter_mut().zip(&look.rows).enumerate() {
            let influence = &influence[r * count * axles..(r + 1) * count * axles];
            watch(watched, &row.factors, influence, &coordinates[width..], &on_axles[..count * axles], axles, from);
        }
        while let Some((number, stop)) = stops.next_if(|(_, stop)| stop.step < from + count) {
            let mut there = Vec::with_capacity(width);
            combine(&stop.statics, loads, width, &mut there);
            let states = Between { coordinates: [&there; 2], loads: [loads; 2], jumps: width, weight: 1.0 };
            watch_stop(&mut seen.stops, stop, number, &look.rows, &states);
        }
        let keep = coordinates.len() - width;
        coordinates.drain(..keep);
    }
    seen
}
