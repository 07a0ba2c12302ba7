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
    pub counted: usize,
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
            counted: 0,
        }
    }

    /// That of constant loads, with so many steps on the bridge.
    pub fn steady(loads: &[L], counted: usize) -> Self {
        let zero = L::splat(0.0);
        let always = |&load: &L| Peaks { max: load, max_at: zero, min: load, min_at: zero };
        Ride { loads: loads.iter().map(always).collect(), counted, ..Ride::nothing(loads.len(), 0) }
    }

    /// Root mean square of an axle load about its static value, by that value, on the bridge, in one lane [-].
    pub fn load_coefficient(&self, axle: usize, lane: usize, static_load: f64) -> f64 {
        (self.deviations[axle].get(lane) / self.counted as f64).sqrt() / static_load
    }

    /// Root mean square of the acceleration of a body on the bridge, in one lane [m/s²].
    pub fn vibration(&self, body: usize, lane: usize) -> f64 {
        (self.squares[body].get(lane) / self.counted as f64).sqrt()
    }

    /// Takes in the last chunk of a tape. `left` is how much of a whole step follows each step; means grow only where
    /// `counted`, on the bridge.
    #[inline(always)]
    pub fn take(&mut self, tape: &Tape<L>, static_loads: &[L], left: impl Fn(usize) -> f64, counted: bool) {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let Some(last) = tape.chunks().checked_sub(1) else { return };
        let chunk = tape.chunk(last);
        self.counted += if counted { chunk.rows.len() / tape.widths.all() } else { 0 };
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
}
