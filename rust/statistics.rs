//! Statistics of the ride: extremes and scatter of axle loads, wheels off the road, accelerations of the bodies.

use serde::{Deserialize, Serialize};

use crate::extremes::Peaks;
use crate::lane::Lane;
use crate::tape::{PART, Tape};

/// Contact forces of a vehicle and accelerations of its bodies over a crossing.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Ride<L> {
    /// Extremes of the axle loads.
    pub loads: Vec<Peaks<L>>,
    /// Sums of the squares by which the loads differ from their static values, on the bridge.
    pub deviations: Vec<L>,
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
    /// Number of steps on the bridge.
    pub counted: L,
}

/// Steps that count, where lanes go their own ways.
#[derive(Debug, Clone)]
pub struct Counted<L> {
    /// The first on the bridge.
    pub from: L,
    /// The first behind it.
    pub to: L,
    /// The last of all.
    pub last: L,
    /// How much of a whole step that is.
    pub left: L,
}

impl<L: Lane> Ride<L> {
    /// Nothing seen yet.
    pub fn nothing(axles: usize, bodies: usize) -> Self {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        Ride {
            loads: vec![Peaks::nothing(); axles],
            deviations: vec![zero; axles],
            aloft: vec![zero; axles],
            lift_offs: vec![zero; axles],
            grounded: vec![one; axles],
            accelerations: vec![zero; bodies],
            squares: vec![zero; bodies],
            counted: zero,
        }
    }

    /// That of constant loads, with so many steps on the bridge.
    pub fn steady(loads: &[L], counted: L) -> Self {
        let zero = L::splat(0.0);
        let always = |&load: &L| Peaks { max: load, max_at: zero, min: load, min_at: zero };
        Ride { loads: loads.iter().map(always).collect(), counted, ..Ride::nothing(loads.len(), 0) }
    }

    /// Root mean square of an axle load about its static value, by that value, on the bridge, in one lane [-].
    pub fn load_coefficient(&self, axle: usize, lane: usize, static_load: f64) -> f64 {
        (self.deviations[axle].get(lane) / self.counted.get(lane)).sqrt() / static_load
    }

    /// Root mean square of the acceleration of a body on the bridge, in one lane [m/s²].
    pub fn vibration(&self, body: usize, lane: usize) -> f64 {
        (self.squares[body].get(lane) / self.counted.get(lane)).sqrt()
    }

    /// Takes in the last chunk of a tape. `left` is how much of a whole step follows each step; means grow only where
    /// `counted`, on the bridge.
    #[inline(always)]
    pub fn take(&mut self, tape: &Tape<L>, static_loads: &[L], left: impl Fn(usize) -> f64, counted: bool) {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let Some(last) = tape.chunks().checked_sub(1) else { return };
        let chunk = tape.chunk(last);
        if counted {
            self.counted = self.counted + L::splat((chunk.rows.len() / tape.widths.all()) as f64);
        }
        let (widths, width, from) = (&tape.widths, tape.widths.all(), chunk.from);
        for (k, static_load) in static_loads.iter().enumerate() {
            let number = widths.loads() + k;
            let loads = || chunk.rows.chunks_exact(width).map(|row| row[number]).enumerate();
            let [_, least] = chunk.limits[number];
            let parts = chunk.parts.chunks_exact(width).map(|part| part[number]);
            for ((part, [most, least]), rows) in parts.enumerate().zip(chunk.rows.chunks(PART * width)) {
                if L::any(self.loads[k].max.less(most) | least.less(self.loads[k].min)) {
                    let mut peaks = self.loads[k];
                    for (i, row) in rows.chunks_exact(width).enumerate() {
                        peaks.take(row[number], L::splat((from + part * PART + i) as f64));
                    }
                    self.loads[k] = peaks;
                }
            }
            if counted {
                let mut squares = self.deviations[k];
                for (_, load) in loads() {
                    let deviation = load - *static_load;
                    squares = squares + deviation * deviation;
                }
                self.deviations[k] = squares;
            }
            // Most of the time no wheel is off the road.
            if !L::any(!zero.less(least) | self.grounded[k].less(one)) {
                continue;
            }
            let (mut aloft, mut lift_offs, mut grounded) = (self.aloft[k], self.lift_offs[k], self.grounded[k]);
            for (i, load) in loads() {
                // Exactly zero is what a wheel off the road carries.
                let now = L::select(!(load.less(zero) | zero.less(load)), zero, one);
                aloft = aloft + L::splat(left(from + i)) * (one - now);
                lift_offs = lift_offs + grounded * (one - now);
                grounded = now;
            }
            (self.aloft[k], self.lift_offs[k], self.grounded[k]) = (aloft, lift_offs, grounded);
        }
        for (b, (largest, squares)) in self.accelerations.iter_mut().zip(&mut self.squares).enumerate() {
            let number = widths.accelerations() + b;
            let [most, least] = chunk.limits[number];
            *largest = largest.larger(most.magnitude()).larger(least.magnitude());
            if counted {
                let mut sum = *squares;
                for row in chunk.rows.chunks_exact(width) {
                    sum = sum + row[number] * row[number];
                }
                *squares = sum;
            }
        }
    }

    /// The same where lanes go their own ways and what they have done repeats: of a vehicle whose axles and bodies come
    /// after so many others. How many steps there are on the bridge is known.
    #[inline(always)]
    pub fn take_apart(
        &mut self,
        tape: &Tape<L>,
        [axles, bodies]: [usize; 2],
        static_loads: &[L],
        Counted { from, to, last, left }: &Counted<L>,
    ) {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let Some(number) = tape.chunks().checked_sub(1) else { return };
        let chunk = tape.chunk(number);
        let (widths, width) = (&tape.widths, tape.widths.all());
        let (begin, end) = (L::splat(chunk.from as f64), L::splat((chunk.from + chunk.rows.len() / width) as f64));
        let counted = L::any(from.less(end)) && L::any(begin.less(*to));
        for (k, static_load) in static_loads.iter().enumerate() {
            let number = widths.loads() + axles + k;
            let [_, least] = chunk.limits[number];
            for (p, rows) in chunk.rows.chunks(PART * width).enumerate() {
                let [most, least] = chunk.parts[p * width + number];
                if L::any(self.loads[k].max.less(most) | least.less(self.loads[k].min)) {
                    let mut peaks = self.loads[k];
                    for (i, row) in rows.chunks_exact(width).enumerate() {
                        peaks.take(row[number], L::splat((chunk.from + p * PART + i) as f64));
                    }
                    self.loads[k] = peaks;
                }
            }
            if counted {
                let (mut squares, mut step) = (self.deviations[k], begin);
                for row in chunk.rows.chunks_exact(width) {
                    let deviation = row[number] - *static_load;
                    let off = step.less(*from) | !step.less(*to);
                    squares = squares + L::select(off, zero, deviation * deviation);
                    step = step + one;
                }
                self.deviations[k] = squares;
            }
            // Most of the time no wheel is off the road.
            if !L::any(!zero.less(least) | self.grounded[k].less(one)) {
                continue;
            }
            let (mut aloft, mut lift_offs, mut grounded) = (self.aloft[k], self.lift_offs[k], self.grounded[k]);
            let mut next = begin + one;
            for row in chunk.rows.chunks_exact(width) {
                let load = row[number];
                // Exactly zero is what a wheel off the road carries.
                let now = L::select(!(load.less(zero) | zero.less(load)), zero, one);
                let step = L::select(last.less(next), zero, L::select(next.less(*last), one, *left));
                aloft = aloft + step * (one - now);
                lift_offs = lift_offs + grounded * (one - now);
                grounded = now;
                next = next + one;
            }
            (self.aloft[k], self.lift_offs[k], self.grounded[k]) = (aloft, lift_offs, grounded);
        }
        for b in 0..self.accelerations.len() {
            let number = widths.accelerations() + bodies + b;
            let [most, least] = chunk.limits[number];
            self.accelerations[b] = self.accelerations[b].larger(most.magnitude()).larger(least.magnitude());
            if counted {
                let (mut sum, mut step) = (self.squares[b], begin);
                for row in chunk.rows.chunks_exact(width) {
                    let off = step.less(*from) | !step.less(*to);
                    sum = sum + L::select(off, zero, row[number] * row[number]);
                    step = step + one;
                }
                self.squares[b] = sum;
            }
        }
    }
}
