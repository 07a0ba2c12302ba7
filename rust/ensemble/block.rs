//! One block of samples through one crossing, group beside group of lanes: the step of a single crossing, chunk by chunk,
//! and after each chunk the extremes of every response in it.

use super::look::Look;
use super::table::{Below, CHUNK, Chunk, Table};
use super::watch::{Ride, Survey, Watched, Widths, watch_free, watch_moment, watch_stop};
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
                    let tap = |k: usize| self.road[taps.first.wrapping_add(k) & mask];
                    let near = [tap(0), tap(1), tap(2), tap(3)];
                    let elevation = L::splat(given[0]) + weighted(taps.weights[0], near);
                    // Slope and curvature count only where the step asks for them.
                    if self.table.kinds == 1 {
                        share.of([elevation, L::splat(given[1]), L::splat(given[2])])
                    } else {
                        let slope = L::splat(given[1]) + weighted(taps.weights[1], near);
                        share.of([elevation, slope, L::splat(given[2]) + weighted(taps.weights[2], near)])
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
    fn steady(&self) -> bool {
        true
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

/// Most numbers that a group keeps of a stretch of steps: what is kept stays in the processor's caches.
const KEPT: usize = 1 << 15;

/// One group on its way.
struct Traveller<'g, 'a, L> {
    group: &'g mut Group<'a, L>,
    state: State<L>,
    static_loads: Vec<L>,
    /// What recovery needs, by step: of the steps of a stretch, and of the one before.
    kept: Vec<L>,
    /// One in the lanes that have not ended yet, by step of a stretch of the tail.
    active: Vec<L>,
}

impl<L: Lane> Traveller<'_, '_, L> {
    /// Keeps what recovery needs of a step in its row.
    #[inline(always)]
    fn keep(&mut self, row: usize, widths: &Widths, rates: bool, bridge: bool) {
        let zero = L::splat(0.0);
        let Widths { coordinates, axles, felt, .. } = *widths;
        let kept = &mut self.kept[row * widths.all()..(row + 1) * widths.all()];
        if !bridge {
            kept[..coordinates].fill(zero);
        } else if rates {
            let modes = coordinates / 2;
            for (m, c) in self.state.modes[..modes].iter().enumerate() {
                kept[m] = self.group.bridge.as_ref().map_or(c.v, |b| b.rates * c.v);
                kept[modes + m] = c.a;
            }
        } else {
            for (m, c) in self.state.modes[..coordinates].iter().enumerate() {
                kept[m] = self.group.bridge.as_ref().map_or(c.x, |b| b.coordinates * c.x);
            }
        }
        for k in 0..axles {
            let load = self.static_loads[k] + self.state.increments[k];
            kept[coordinates + k] = if felt { load } else { zero };
            kept[coordinates + axles + k] = load;
        }
        for (b, row) in self.group.bodies.iter().enumerate() {
            let mut sum = zero;
            for (factor, q) in row.iter().zip(&self.state.coordinates) {
                sum = sum + L::splat(*factor) * q.a;
            }
            kept[widths.accelerations() + b] = sum;
        }
    }

    /// Ends lanes on time: what ends within the step is cut short, and what has ended repeats its last row.
    #[inline(always)]
    fn end(&mut self, row: usize, step: usize, widths: &Widths) {
        let (zero, one, now) = (L::splat(0.0), L::splat(1.0), L::splat(step as f64));
        let ends = &self.group.ends;
        let ended = ends.last.less(now);
        let ending = !(ended | now.less(ends.last));
        // A whole last step is not rounded.
        let short = !(!ending | !ends.fraction.less(one));
        let width = widths.all();
        for i in row * width..(row + 1) * width {
            let (b, a) = (self.kept[i - width], self.kept[i]);
            let cut = b + ends.fraction * (a - b);
            self.kept[i] = L::select(ended, b, L::select(short, cut, a));
        }
        self.active.push(L::select(ended, zero, one));
    }

    /// Whether everything is a finite number in lanes that have not ended.
    #[inline(always)]
    fn sound(&self, step: usize) -> bool {
        let zero = L::splat(0.0);
        let mut sum = zero;
        for c in &self.state.modes {
            sum = sum + c.a;
        }
        for c in &self.state.coordinates {
            sum = sum + c.a;
        }
        for p in &self.state.increments {
            sum = sum + *p;
        }
        let nought = sum - sum;
        let ended = self.group.ends.last.less(L::splat(step as f64));
        L::all(!(nought.less(zero) | !nought.less(L::splat(1.0))) | ended)
    }
}

/// Where a stretch of steps lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Where {
    /// Before the bridge, which is at rest.
    Approach,
    /// With axles on the bridge.
    Bridge,
    /// Behind it.
    Tail,
}

/// Marches groups of samples through the table.
#[inline(always)]
pub fn march<L: Lane>(way: &Way<'_>, groups: &mut [Group<'_, L>], go_on: &dyn Fn() -> bool) -> Result<(), Trouble> {
    let Way { table, rows, look, closely } = *way;
    let steps = table.path.steps;
    let bodies = groups.first().map_or(0, |group| group.bodies.len());
    let widths =
        Widths { coordinates: rows.width(), axles: table.axles(), bodies, felt: rows.weight() == 1.0 };
    let rates = rows.by_rates();
    let width = widths.all();
    // Whole chunks, so that each begins a stretch.
    let longest = (KEPT / width / CHUNK).max(1) * CHUNK;
    let latest = groups.iter().map(|group| group.ends.latest).max().unwrap_or(steps);
    let mut travellers: Vec<Traveller<'_, '_, L>> = Vec::with_capacity(groups.len());
    for group in groups {
        let speed = group.geometry.speed;
        let state = group.starter.start(&[speed], &group.geometry).map_err(|e| Trouble::Failed(0, Some(e)))?;
        let static_loads = group.stepper.static_loads();
        let rows = longest.min(latest + 1) + 1;
        let kept = vec![L::splat(0.0); rows * width];
        let mut traveller = Traveller { group, state, static_loads, kept, active: Vec::new() };
        // Before the first step there is nothing: it stands for the one before.
        traveller.keep(0, &widths, rates, table.first == 0);
        travellers.push(traveller);
    }
    let (mut scratch, mut glanced, mut between) = (Vec::new(), Vec::new(), Vec::new());
    let mut stop = 0;
    let mut from = 0;
    while from <= latest {
        let (place, end, most) = if from < table.first {
            (Where::Approach, table.first, CHUNK)
        } else if from <= steps {
            (Where::Bridge, steps + 1, longest)
        } else {
            (Where::Tail, latest + 1, CHUNK)
        };
        let to = end.min(from + most);
        for traveller in &mut travellers {
            traveller.active.clear();
            if place != Where::Approach && traveller.state.modes.is_empty() {
                traveller.state.modes = vec![Coordinate::rest(); table.modes];
            }
        }
        for step in from..to {
            for traveller in &mut travellers {
                if step > 0 {
                    let Group { geometry, approach, stepper, .. } = &mut *traveller.group;
                    let advanced = match place {
                        Where::Approach => approach.advance(&mut traveller.state, geometry),
                        _ => stepper.advance(&mut traveller.state, geometry),
                    };
                    if let Err(e) = advanced {
                        return Err(Trouble::Failed(step, Some(e)));
                    }
                }
                let row = step - from + 1;
                traveller.keep(row, &widths, rates, place != Where::Approach);
                if place == Where::Tail {
                    traveller.end(row, step, &widths);
                }
                if closely && !traveller.sound(step) {
                    return Err(Trouble::Failed(step, None));
                }
            }
            if (step - from) % CHUNK == CHUNK - 1 && !go_on() {
                return Err(Trouble::Interrupted);
            }
        }
        let chunks = if place == Where::Bridge { table.chunks(from, to, rows, look, &mut scratch) } else { Vec::new() };
        let influence: Vec<&[f64]> = chunks.iter().map(|chunk| &chunk.influence[..]).collect();
        let bounds: Vec<&[[f64; 2]]> = chunks.iter().map(|chunk| &chunk.bounds[..]).collect();
        let stops_to = stop + table.stops[stop..].partition_point(|stop| stop.step < to);
        let count = to - from;
        for traveller in &mut travellers {
            if !traveller.sound(to - 1) {
                return Err(Trouble::Failed(to - 1, None));
            }
            let seen = &mut traveller.group.seen;
            let kept = &traveller.kept[width..(count + 1) * width];
            let active = (place == Where::Tail).then_some(&traveller.active[..]);
            seen.ride.take(kept, &widths, &traveller.static_loads, from, active, place == Where::Bridge);
            match place {
                Where::Approach => {}
                Where::Tail => watch_free(&mut seen.steps, &look.rows, kept, &widths, from),
                Where::Bridge => {
                    let survey = Survey {
                        rows: &look.rows,
                        influence: &influence,
                        bounds: &bounds,
                        steps: kept,
                        widths,
                        from,
                    };
                    survey.take(&mut seen.steps, &mut glanced);
                    let jumps = if rates { widths.coordinates / 2 } else { widths.coordinates };
                    for (number, stop) in table.stops[..stops_to].iter().enumerate().skip(stop) {
                        let row = stop.step - from;
                        let sides = [&traveller.kept[row * width..][..width], &traveller.kept[(row + 1) * width..][..width]];
                        watch_stop(&mut seen.stops, &look.rows, stop, number, sides, &widths, jumps, &mut between);
                    }
                }
            }
            traveller.kept.copy_within(count * width..(count + 1) * width, 0);
        }
        stop = stops_to;
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
    let (width, axles) = (rows.width(), table.axles());
    let mut seen = Seen::nothing(look.rows.len(), 0, 0, table);
    let widths = Widths { coordinates: width, axles, bodies: 0, felt: true };
    let (mut scratch, mut glanced): (Vec<Chunk>, Vec<[L; 2]>) = (Vec::new(), Vec::new());
    let mut steps = Vec::with_capacity(CHUNK * widths.all());
    for from in (table.first..=table.path.steps).step_by(CHUNK) {
        let to = (from + CHUNK).min(table.path.steps + 1);
        steps.clear();
        for step in from..to {
            combine(&table.statics[step * axles * width..(step + 1) * axles * width], loads, width, &mut steps);
            steps.extend_from_slice(loads);
            steps.extend_from_slice(loads);
        }
        let chunks = table.chunks(from, to, rows, look, &mut scratch);
        let survey = Survey {
            rows: &look.rows,
            influence: &[&chunks[0].influence],
            bounds: &[&chunks[0].bounds],
            steps: &steps,
            widths,
            from,
        };
        survey.take(&mut seen.steps, &mut glanced);
    }
    for (number, stop) in table.stops.iter().enumerate() {
        let mut then = Vec::with_capacity(width + axles);
        combine(&stop.statics, loads, width, &mut then);
        then.extend_from_slice(loads);
        watch_moment(&mut seen.stops, &look.rows, stop, number, &then);
    }
    seen
}
