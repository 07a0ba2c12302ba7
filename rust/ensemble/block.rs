//! One block of samples through one crossing, side by side: the step of a single crossing, chunk by chunk, and after
//! each chunk the extremes of every response in it.

use super::table::{Below, CHUNK, Stop, Table};
use crate::lane::Lane;
use crate::newmark::Coordinate;
use crate::recovery::Rows;
use crate::road::spline::weighted;
use crate::step::{Geometry, State, Stepper, Surface, Unsettled};

/// The shared table, with the roads and speeds of the samples of a block.
pub struct Shared<'a, L> {
    table: &'a Table,
    /// Coefficients of the roads, one lane for each sample.
    road: &'a [L],
    speed: L,
    step: usize,
    surfaces: Vec<Surface<L>>,
}

impl<'a, L: Lane> Shared<'a, L> {
    /// At the start.
    #[inline(always)]
    pub fn new(table: &'a Table, road: &'a [L], speed: L) -> Self {
        let zero = L::splat(0.0);
        let level = Surface { elevation: zero, slope: zero, curvature: zero };
        let mut shared = Shared { table, road, speed, step: 0, surfaces: vec![level; table.axles] };
        shared.look_down();
        shared
    }

    #[inline(always)]
    fn look_down(&mut self) {
        let stands = &self.table.stands[self.step * self.table.axles..];
        for (surface, stand) in self.surfaces.iter_mut().zip(stands) {
            *surface = match &stand.below {
                Below::Given(s) => Surface {
                    elevation: L::splat(s.elevation),
                    slope: L::splat(s.slope),
                    curvature: L::splat(s.curvature),
                },
                Below::Own(taps, fade) => {
                    let mask = self.road.len() - 1;
                    let near = [0, 1, 2, 3].map(|k| self.road[taps.first.wrapping_add(k) & mask]);
                    let elevation = weighted(taps.weights[0], near);
                    let zero = L::splat(0.0);
                    // The slope counts only where the step asks for slopes; curvature only under rigid contact.
                    let slope = if self.table.kinds == 3 { weighted(taps.weights[1], near) } else { zero };
                    let [fade, fade_1] = fade.map(L::splat);
                    Surface { elevation: fade * elevation, slope: fade * slope + fade_1 * elevation, curvature: zero }
                }
            };
        }
    }

    #[inline(always)]
    fn entry(&self, contact: usize) -> usize {
        (self.step * self.table.axles + contact) * self.table.modes * self.table.kinds
    }
}

impl<L: Lane> Geometry<L> for Shared<'_, L> {
    #[inline(always)]
    fn advance(&mut self) {
        self.step += 1;
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
        Coordinate { x: L::splat(self.table.x(self.step, contact)), v: self.speed, a: L::splat(0.0) }
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

/// Largest and smallest so far, and when: the number of a step, or of a stop.
#[derive(Debug, Clone, Copy)]
pub struct Watched<L> {
    /// Largest.
    pub max: L,
    /// When.
    pub max_at: L,
    /// Smallest.
    pub min: L,
    /// When.
    pub min_at: L,
}

impl<L: Lane> Watched<L> {
    /// Nothing seen yet.
    #[inline(always)]
    pub fn nothing() -> Self {
        let (low, high, zero) = (L::splat(f64::NEG_INFINITY), L::splat(f64::INFINITY), L::splat(0.0));
        Watched { max: low, max_at: zero, min: high, min_at: zero }
    }

    /// Takes in a value; of equal values the first counts.
    #[inline(always)]
    pub fn take(&mut self, value: L, at: L) {
        let (above, below) = (self.max.less(value), value.less(self.min));
        self.max = L::select(above, value, self.max);
        self.max_at = L::select(above, at, self.max_at);
        self.min = L::select(below, value, self.min);
        self.min_at = L::select(below, at, self.min_at);
    }
}

/// What a block has seen: extremes at the steps, and at the moments between them.
#[derive(Debug, Clone)]
pub struct Seen<L> {
    /// By response, at steps.
    pub steps: Vec<Watched<L>>,
    /// By response, at stops.
    pub stops: Vec<Watched<L>>,
    /// By axle: extremes of the loads, at steps.
    pub loads: Vec<Watched<L>>,
    /// By axle: sums of the load increments and of their squares over the steps on the bridge.
    pub sums: Vec<[L; 2]>,
    /// By axle: number of steps without contact.
    pub aloft: Vec<L>,
}

/// States of one chunk, and of the step before it: what recovery needs.
struct Kept<L> {
    /// Coordinates, by step.
    coordinates: Vec<L>,
    /// Axle loads, by step.
    loads: Vec<L>,
}

impl<L: Lane> Kept<L> {
    #[inline(always)]
    fn push(&mut self, state: &State<L>, loads: &[L], by_rates: bool) {
        if by_rates {
            self.coordinates.extend(state.modes.iter().map(|c| c.v));
            self.coordinates.extend(state.modes.iter().map(|c| c.a));
        } else {
            self.coordinates.extend(state.modes.iter().map(|c| c.x));
        }
        self.loads.extend(loads.iter().zip(&state.increments).map(|(p, increment)| *p + *increment));
    }

    /// Keeps only the last step.
    #[inline(always)]
    fn forget(&mut self, width: usize, axles: usize) {
        self.coordinates.drain(..self.coordinates.len() - width);
        self.loads.drain(..self.loads.len() - axles);
    }
}

/// Marches a block of samples through the table.
#[inline(always)]
pub fn march<L: Lane>(
    table: &Table,
    rows: &Rows,
    stepper: &mut Stepper<L>,
    starter: &mut Stepper<L>,
    road: &[L],
    speed: L,
) -> Result<Seen<L>, Unsettled> {
    let mut geometry = Shared::new(table, road, speed);
    let mut state = starter.start(&[speed], &geometry)?;
    let (width, axles) = (rows.width(), table.axles);
    let loads = stepper.static_loads();
    let weight = L::splat(rows.weight());
    let zero = L::splat(0.0);
    let mut seen = Seen {
        steps: vec![Watched::nothing(); rows.len()],
        stops: vec![Watched::nothing(); rows.len()],
        loads: vec![Watched::nothing(); axles],
        sums: vec![[zero; 2]; axles],
        aloft: vec![zero; axles],
    };
    let factors: Vec<Vec<f64>> = (0..rows.len()).map(|r| (0..width).map(|i| rows.factor(r, i)).collect()).collect();
    let mut kept =
        Kept { coordinates: Vec::with_capacity((CHUNK + 1) * width), loads: Vec::with_capacity((CHUNK + 1) * axles) };
    watch_loads(&mut seen, &state, &loads, 0);
    kept.push(&state, &loads, rows.by_rates());
    for step in 1..table.first {
        stepper.advance(&mut state, &mut geometry)?;
        watch_loads(&mut seen, &state, &loads, step);
    }
    if table.first > 1 {
        kept.coordinates.clear();
        kept.loads.clear();
        kept.push(&state, &loads, rows.by_rates());
    }
    let mut stops = table.stops.iter().enumerate().peekable();
    let mut from = table.first;
    for influence in &table.influence {
        let count = CHUNK.min(table.steps + 1 - from);
        for step in from..from + count {
            if step > 0 {
                stepper.advance(&mut state, &mut geometry)?;
                watch_loads(&mut seen, &state, &loads, step);
                kept.push(&state, &loads, rows.by_rates());
            } else {
                // The first chunk begins at the start, before which there is nothing.
                kept.push(&state, &loads, rows.by_rates());
            }
        }
        let (coordinates, on_axles) = (&kept.coordinates[width..], &kept.loads[axles..]);
        for (r, watched) in seen.steps.iter_mut().enumerate() {
            let influence = &influence[r * count * axles..(r + 1) * count * axles];
            watch(watched, &factors[r], influence, coordinates, on_axles, weight, from as f64);
        }
        while let Some((number, stop)) = stops.next_if(|(_, stop)| stop.step < from + count) {
            let row = stop.step - from;
            let before = [&kept.coordinates[row * width..][..width], &kept.coordinates[(row + 1) * width..][..width]];
            let loaded = [&kept.loads[row * axles..][..axles], &kept.loads[(row + 1) * axles..][..axles]];
            at_stop(&mut seen.stops, stop, number, &factors, before, loaded, rows);
        }
        kept.forget(width, axles);
        from += count;
    }
    Ok(seen)
}

/// The extremes of one response over one chunk.
#[inline(always)]
fn watch<L: Lane>(
    watched: &mut Watched<L>,
    factors: &[f64],
    influence: &[f64],
    coordinates: &[L],
    loads: &[L],
    weight: L,
    from: f64,
) {
    let axles = loads.len() * factors.len() / coordinates.len();
    let mut own = *watched;
    let mut at = from;
    let steps =
        coordinates.chunks_exact(factors.len()).zip(loads.chunks_exact(axles)).zip(influence.chunks_exact(axles));
    for ((coordinates, loads), influence) in steps {
        let mut value = L::splat(0.0);
        for (a, factor) in coordinates.iter().zip(factors) {
            value = value + L::splat(*factor) * *a;
        }
        for (load, g) in loads.iter().zip(influence) {
            value = value + L::splat(*g) * (weight * *load);
        }
        own.take(value, L::splat(at));
        at += 1.0;
    }
    *watched = own;
}

#[inline(always)]
fn watch_loads<L: Lane>(seen: &mut Seen<L>, state: &State<L>, loads: &[L], step: usize) {
    let (at, zero, one) = (L::splat(step as f64), L::splat(0.0), L::splat(1.0));
    for (k, (load, increment)) in loads.iter().zip(&state.increments).enumerate() {
        let now = *load + *increment;
        seen.loads[k].take(now, at);
        let [sum, squares] = &mut seen.sums[k];
        *sum = *sum + *increment;
        *squares = *squares + *increment * *increment;
        seen.aloft[k] = seen.aloft[k] + L::select(zero.less(now), zero, one);
    }
}

/// The responses at a moment between two steps.
#[inline(always)]
fn at_stop<L: Lane>(
    seen: &mut [Watched<L>],
    stop: &Stop,
    number: usize,
    factors: &[Vec<f64>],
    coordinates: [&[L]; 2],
    loads: [&[L]; 2],
    rows: &Rows,
) {
    let fraction = L::splat(stop.fraction);
    let mix = |b: L, a: L| b + fraction * (a - b);
    let weight = L::splat(rows.weight());
    let at = L::splat(number as f64);
    let jumped = stop.jump.map(|step| usize::from(step == stop.step));
    // Of Ȧ and Ä the latter jump with the load.
    let jumps = if rows.by_rates() { coordinates[0].len() / 2 } else { coordinates[0].len() };
    let coordinate = |i: usize| match jumped {
        Some(row) if i >= jumps => coordinates[row][i],
        _ => mix(coordinates[0][i], coordinates[1][i]),
    };
    let load = |k: usize| match jumped {
        Some(row) if k == stop.axle => loads[row][k],
        _ => mix(loads[0][k], loads[1][k]),
    };
    for (r, influence) in &stop.responses {
        let mut value = L::splat(0.0);
        for (i, factor) in factors[*r].iter().enumerate() {
            value = value + L::splat(*factor) * coordinate(i);
        }
        for (k, g) in influence.iter().enumerate() {
            value = value + L::splat(*g) * (weight * load(k));
        }
        seen[*r].take(value, at);
        if let Some((tip, sign)) = stop.tip
            && tip == *r
        {
            seen[*r].take(value + L::splat(sign) * weight * load(stop.axle), at);
        }
    }
}
