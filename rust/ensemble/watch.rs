//! What is seen of samples side by side as they pass: extremes and when, sums of squares, wheels off the road.

use super::look::Row;
use super::table::Stop;
use crate::lane::Lane;

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

    /// At rest at step zero.
    #[inline(always)]
    pub fn rest() -> Self {
        let zero = L::splat(0.0);
        Watched { max: zero, max_at: zero, min: zero, min_at: zero }
    }

    /// This, but for the lanes of a mask, which are as they were.
    #[inline(always)]
    pub fn unless(self, mask: L::Mask, before: Self) -> Self {
        Watched {
            max: L::select(mask, before.max, self.max),
            max_at: L::select(mask, before.max_at, self.max_at),
            min: L::select(mask, before.min, self.min),
            min_at: L::select(mask, before.min_at, self.min_at),
        }
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

/// What recovery needs of each step: of one chunk, and of the step before it.
#[derive(Debug, Clone)]
pub struct Kept<L> {
    /// What the rows multiply, by step.
    pub coordinates: Vec<L>,
    /// Axle loads [N], by step.
    pub loads: Vec<L>,
    /// Vertical accelerations of the bodies [m/s²], by step.
    pub accelerations: Vec<L>,
}

impl<L: Lane> Kept<L> {
    /// Nothing yet.
    pub fn new() -> Self {
        Kept { coordinates: Vec::new(), loads: Vec::new(), accelerations: Vec::new() }
    }

    /// Keeps only the last step.
    #[inline(always)]
    pub fn forget(&mut self, width: usize, axles: usize, bodies: usize) {
        let last = |values: &mut Vec<L>, width: usize| {
            let from = values.len() - width;
            values.copy_within(from.., 0);
            values.truncate(width);
        };
        last(&mut self.coordinates, width);
        last(&mut self.loads, axles);
        last(&mut self.accelerations, bodies);
    }
}

/// Contact forces and accelerations over a crossing.
#[derive(Debug, Clone)]
pub struct Ride<L> {
    /// Extremes of the axle loads.
    pub loads: Vec<Watched<L>>,
    /// Sums of the deviations of the loads from their static values and of their squares, on the bridge.
    pub sums: Vec<[L; 2]>,
    /// Steps off the road.
    pub aloft: Vec<L>,
    /// Times the axle left it.
    pub lift_offs: Vec<L>,
    /// Zero while it is off.
    grounded: Vec<L>,
    /// Largest magnitude of the accelerations.
    pub accelerations: Vec<L>,
    /// Sums of their squares, on the bridge.
    pub squares: Vec<L>,
}

impl<L: Lane> Ride<L> {
    /// Nothing seen yet.
    pub fn nothing(axles: usize, bodies: usize) -> Self {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        Ride {
            loads: vec![Watched::nothing(); axles],
            sums: vec![[zero; 2]; axles],
            aloft: vec![zero; axles],
            lift_offs: vec![zero; axles],
            grounded: vec![one; axles],
            accelerations: vec![zero; bodies],
            squares: vec![zero; bodies],
        }
    }

    /// Takes in steps from number `from` on; `left` is how much of the step that follows lanes go, and `counted` one where
    /// sums are to grow. Lanes that have ended go on as they were.
    #[inline(always)]
    pub fn take(&mut self, kept: &Kept<L>, static_loads: &[L], from: usize, left: &[L], counted: L) {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let axles = self.loads.len();
        for (k, static_load) in static_loads.iter().enumerate() {
            let (mut watched, [mut sum, mut squares]) = (self.loads[k], self.sums[k]);
            let (mut aloft, mut lift_offs, mut grounded) = (self.aloft[k], self.lift_offs[k], self.grounded[k]);
            let mut at = L::splat(from as f64);
            for (loads, left) in kept.loads[axles..].chunks_exact(axles).zip(left) {
                let load = loads[k];
                watched.take(load, at);
                let deviation = counted * (load - *static_load);
                sum = sum + deviation;
                squares = squares + deviation * deviation;
                // Exactly zero is what a wheel off the road carries.
                let now = L::select(load.less(zero) | zero.less(load), one, zero);
                aloft = aloft + *left * (one - now);
                lift_offs = lift_offs + grounded * (one - now);
                grounded = now;
                at = at + one;
            }
            (self.loads[k], self.sums[k]) = (watched, [sum, squares]);
            (self.aloft[k], self.lift_offs[k], self.grounded[k]) = (aloft, lift_offs, grounded);
        }
        let bodies = self.accelerations.len();
        for (b, (largest, squares)) in self.accelerations.iter_mut().zip(&mut self.squares).enumerate() {
            for accelerations in kept.accelerations[bodies..].chunks_exact(bodies) {
                let a = accelerations[b];
                *largest = largest.larger(a.magnitude());
                *squares = *squares + counted * (a * a);
            }
        }
    }
}

/// The extremes of one row over the steps of a chunk from number `from` on.
#[inline(always)]
pub fn watch<L: Lane>(
    watched: &mut Watched<L>,
    factors: &[f64],
    influence: &[f64],
    coordinates: &[L],
    loads: &[L],
    axles: usize,
    from: usize,
) {
    let mut own = *watched;
    let mut at = from as f64;
    let steps =
        coordinates.chunks_exact(factors.len()).zip(loads.chunks_exact(axles)).zip(influence.chunks_exact(axles));
    for ((coordinates, loads), influence) in steps {
        let mut value = L::splat(0.0);
        for (a, factor) in coordinates.iter().zip(factors) {
            value = value + L::splat(*factor) * *a;
        }
        for (load, g) in loads.iter().zip(influence) {
            value = value + L::splat(*g) * *load;
        }
        own.take(value, L::splat(at));
        at += 1.0;
    }
    *watched = own;
}

/// The extremes of one row over steps at which no axle is on the bridge.
#[inline(always)]
pub fn watch_free<L: Lane>(watched: &mut Watched<L>, factors: &[f64], coordinates: &[L], from: usize) {
    let mut at = from as f64;
    for coordinates in coordinates.chunks_exact(factors.len()) {
        let mut value = L::splat(0.0);
        for (a, factor) in coordinates.iter().zip(factors) {
            value = value + L::splat(*factor) * *a;
        }
        watched.take(value, L::splat(at));
        at += 1.0;
    }
}

/// The states of two neighbouring steps: what the rows multiply, and the loads that they see.
pub struct Between<'a, L> {
    /// Coordinates before and after.
    pub coordinates: [&'a [L]; 2],
    /// Loads before and after.
    pub loads: [&'a [L]; 2],
    /// From which coordinate on they jump with a load: Ä follows it at once, A and Ȧ do not.
    pub jumps: usize,
    /// How much of a load the rows see: all, or nothing by superposition.
    pub weight: f64,
}

/// Takes in a moment between two steps.
#[inline(always)]
pub fn watch_stop<L: Lane>(seen: &mut [Watched<L>], stop: &Stop, number: usize, rows: &[Row], states: &Between<'_, L>) {
    let Between { coordinates, loads, jumps, weight } = *states;
    let fraction = L::splat(stop.fraction);
    let mix = |b: L, a: L| b + fraction * (a - b);
    let at = L::splat(number as f64);
    let jumped = stop.jump.map(|step| usize::from(step == stop.step));
    let coordinate = |i: usize| match jumped {
        Some(row) if i >= jumps => coordinates[row][i],
        _ => mix(coordinates[0][i], coordinates[1][i]),
    };
    let weight = L::splat(weight);
    let load = |k: usize| match jumped {
        Some(row) if k == stop.axle => weight * loads[row][k],
        _ => weight * mix(loads[0][k], loads[1][k]),
    };
    let axles = loads[0].len();
    for (&r, influence) in stop.rows.iter().zip(stop.influence.chunks_exact(axles)) {
        let mut value = L::splat(0.0);
        for (i, factor) in rows[r].factors.iter().enumerate() {
            value = value + L::splat(*factor) * coordinate(i);
        }
        for (k, g) in influence.iter().enumerate() {
            value = value + L::splat(*g) * load(k);
        }
        seen[r].take(value, at);
        if let Some((tip, sign)) = stop.tip
            && tip == r
        {
            seen[r].take(value + L::splat(sign) * load(stop.axle), at);
        }
    }
}
