//! A tape: the numbers that steps leave for recovery (coordinates, axle loads, accelerations), kept chunk by chunk with the
//! largest and smallest of each.

use std::ops::Range;

use crate::lane::Lane;
use crate::recovery::Rows;
use crate::statics::quantity::{Quantity, Unit};
use crate::step::vibration::Reach;

/// Steps whose responses are bounded together.
pub const CHUNK: usize = 32;

/// Steps of a part of a chunk.
pub const PART: usize = 8;

/// Parts of a chunk.
pub const PARTS: usize = CHUNK / PART;

/// What a step leaves for recovery, in a row of numbers: coordinates, loads [N], vertical accelerations of the bodies
/// [m/s²]. Where responses do not feel the loads, zeros stand in their place and the loads follow.
#[derive(Debug, Clone, Copy)]
pub struct Widths {
    /// What the rows multiply.
    pub coordinates: usize,
    /// Axles.
    pub axles: usize,
    /// Bodies.
    pub bodies: usize,
    /// Whether responses feel the loads; by superposition they do not.
    pub felt: bool,
    /// Whether the coordinates are A, Ȧ and Ä.
    pub orders: [bool; 3],
}

impl Widths {
    /// Of what these rows multiply.
    pub fn of(rows: &Rows, axles: usize, bodies: usize) -> Self {
        Widths { coordinates: rows.width(), axles, bodies, felt: rows.weight() == 1.0, orders: rows.orders() }
    }

    /// Numbers that responses follow from.
    #[inline(always)]
    pub fn used(&self) -> usize {
        self.coordinates + self.axles
    }

    /// The first coordinate that jumps as a wheel drops on or off a free end: Ä follows a load at once, A and Ȧ do not. The
    /// axle's own load jumps too.
    #[inline(always)]
    pub fn jumps(&self) -> usize {
        let orders = self.orders.iter().filter(|&&used| used).count();
        if self.orders[2] { self.coordinates / orders * (orders - 1) } else { self.coordinates }
    }

    /// Numbers of a step.
    #[inline(always)]
    pub fn all(&self) -> usize {
        self.accelerations() + self.bodies
    }

    /// Where the loads begin.
    #[inline(always)]
    pub fn loads(&self) -> usize {
        if self.felt { self.coordinates } else { self.coordinates + self.axles }
    }

    /// Where the accelerations begin.
    #[inline(always)]
    pub fn accelerations(&self) -> usize {
        self.loads() + self.axles
    }

    /// Writes the coordinates of a step down, by the derivatives of each mode in time; on a bridge at rest there are none
    /// yet.
    #[inline(always)]
    pub fn write_modes<L: Lane>(
        &self,
        row: &mut [L],
        modes: usize,
        derivative: impl Fn(usize, usize) -> L,
        factors: Option<&BridgeFactors<L>>,
    ) {
        let Widths { coordinates, axles, felt, orders: [values, velocities, accelerations], .. } = *self;
        let mut left = &mut row[..coordinates];
        if modes == 0 {
            left.fill(L::splat(0.0));
            left = &mut [];
        }
        if values {
            for (m, own) in left.iter_mut().take(modes).enumerate() {
                *own = derivative(0, m);
            }
            if let Some(factors) = factors {
                for own in left.iter_mut().take(modes) {
                    *own = factors.coordinates * *own;
                }
            }
            left = left.get_mut(modes..).unwrap_or_default();
        }
        if velocities {
            for (m, own) in left.iter_mut().take(modes).enumerate() {
                *own = factors.map_or(derivative(1, m), |factors| factors.rates * derivative(1, m));
            }
            left = left.get_mut(modes..).unwrap_or_default();
        }
        if accelerations {
            left.iter_mut().enumerate().for_each(|(m, own)| *own = derivative(2, m));
        }
        if !felt {
            row[coordinates..][..axles].fill(L::splat(0.0));
        }
    }
}

/// What a bridge that is varied makes of what the rows multiply.
#[derive(Debug, Clone, Copy)]
pub struct BridgeFactors<L> {
    /// On A: the factor of the stiffness.
    pub coordinates: L,
    /// On Ȧ: how the damping matrix grows.
    pub rates: L,
}

impl BridgeFactors<f64> {
    /// How many times too large a response comes out.
    pub fn of(&self, quantity: Quantity) -> f64 {
        match (quantity.unit(), quantity.order()) {
            (Unit::Metre | Unit::Radian, 0) => self.coordinates,
            (_, 1) => self.rates,
            _ => 1.0,
        }
    }
}

impl<L: Lane> BridgeFactors<L> {
    /// What free vibration can reach of what the rows multiply, on a bridge that may be varied.
    #[inline(always)]
    pub fn reach(factors: Option<&Self>, reach: Reach<L>) -> Reach<L> {
        match factors {
            None => reach,
            Some(factors) => reach.scaled(factors.coordinates, factors.rates),
        }
    }
}

/// Steps that are kept until their responses are looked at.
#[derive(Debug, Clone)]
pub struct Tape<L> {
    /// What a step consists of.
    pub widths: Widths,
    /// Number of the first step.
    pub from: usize,
    /// How many there are.
    pub steps: usize,
    /// The step before, and then these.
    rows: Vec<L>,
    /// Largest and smallest of each number of a step, by chunk.
    limits: Vec<[L; 2]>,
    /// The same by part of a chunk.
    parts: Vec<[L; 2]>,
}

/// A chunk of a tape.
pub struct Kept<'s, L> {
    /// Number of its first step.
    pub from: usize,
    /// Its steps.
    pub rows: &'s [L],
    /// Largest and smallest of each number of a step.
    pub limits: &'s [[L; 2]],
    /// The same, part by part.
    pub parts: &'s [[L; 2]],
}

impl<L: Lane> Tape<L> {
    /// Nothing yet.
    pub fn new() -> Self {
        let widths = Widths { coordinates: 0, axles: 0, bodies: 0, felt: true, orders: [true, false, false] };
        Tape { widths, from: 0, steps: 0, rows: Vec::new(), limits: Vec::new(), parts: Vec::new() }
    }

    /// Begins anew with a step of this number, with room for so many chunks.
    pub fn begin(&mut self, widths: Widths, from: usize, chunks: usize) {
        let width = widths.all();
        (self.widths, self.from, self.steps) = (widths, from, 0);
        // Never less, so that memory is asked for once.
        let zero = L::splat(0.0);
        self.rows.resize(self.rows.len().max((chunks * CHUNK + 1) * width), zero);
        self.limits.resize(self.limits.len().max(chunks * width), [zero; 2]);
        self.parts.resize(self.parts.len().max(chunks * PARTS * width), [zero; 2]);
    }

    /// Begins anew after its last step, which becomes the one before.
    pub fn go_on(&mut self) {
        let width = self.widths.all();
        self.rows.copy_within(self.steps * width..(self.steps + 1) * width, 0);
        self.begin(self.widths, self.from + self.steps, 0);
    }

    /// The row of a step, or of the one before the first.
    #[inline(always)]
    pub fn row(&self, step: usize) -> &[L] {
        let width = self.widths.all();
        &self.rows[(step + 1 - self.from) * width..][..width]
    }

    /// The same, to be written, and the row before it.
    #[inline(always)]
    pub fn row_mut(&mut self, step: usize) -> [&mut [L]; 2] {
        let width = self.widths.all();
        let (before, row) = self.rows[(step - self.from) * width..][..2 * width].split_at_mut(width);
        [before, row]
    }

    /// The rows of some steps, to be written.
    #[inline(always)]
    pub fn rows_mut(&mut self, steps: Range<usize>) -> &mut [L] {
        let width = self.widths.all();
        &mut self.rows[(steps.start + 1 - self.from) * width..][..steps.len() * width]
    }

    /// Takes in a chunk of so many steps, whose rows have been written.
    #[inline(always)]
    pub fn take(&mut self, count: usize) {
        let width = self.widths.all();
        let chunk = self.steps / CHUNK;
        let rows = &self.rows[(self.steps + 1) * width..][..count * width];
        let all = &mut self.limits[chunk * width..][..width];
        let parts = self.parts[chunk * PARTS * width..][..PARTS * width].chunks_exact_mut(width);
        for (p, (rows, parts)) in rows.chunks(PART * width).zip(parts).enumerate() {
            let (first, last) = (&rows[..width], rows.len() / width - 1);
            // One row beside the other, the last as often as it takes, so that the loop over the numbers has no other in it.
            let mut others = [first; PART - 1];
            for (i, other) in others.iter_mut().enumerate() {
                *other = &rows[(i + 1).min(last) * width..][..width];
            }
            for (i, (part, all)) in parts.iter_mut().zip(all.iter_mut()).enumerate() {
                let (mut most, mut least) = (first[i], first[i]);
                for row in others {
                    most = row[i].larger(most);
                    least = row[i].smaller(least);
                }
                *part = [most, least];
                let [high, low] = *all;
                *all = if p == 0 { [most, least] } else { [most.larger(high), least.smaller(low)] };
            }
        }
        self.steps += count;
    }

    /// Takes in all of so many steps, chunk by chunk.
    #[inline(always)]
    pub fn take_all(&mut self, count: usize) {
        for from in (0..count).step_by(CHUNK) {
            self.take(CHUNK.min(count - from));
        }
    }

    /// Its steps, in order.
    #[inline(always)]
    pub fn taken(&self) -> impl Iterator<Item = &[L]> {
        let width = self.widths.all();
        self.rows[width..][..self.steps * width].chunks_exact(width)
    }

    /// Number of its chunks.
    #[inline(always)]
    pub fn chunks(&self) -> usize {
        self.steps.div_ceil(CHUNK)
    }

    /// One of its chunks.
    // By number, not one by one from an iterator: its closure would be a function of its own, without the instruction set.
    #[inline(always)]
    pub fn chunk(&self, chunk: usize) -> Kept<'_, L> {
        let width = self.widths.all();
        let from = chunk * CHUNK;
        let count = CHUNK.min(self.steps - from);
        Kept {
            from: self.from + from,
            rows: &self.rows[(from + 1) * width..][..count * width],
            limits: &self.limits[chunk * width..][..width],
            parts: &self.parts[chunk * PARTS * width..][..PARTS * width],
        }
    }
}

impl<L: Lane> Default for Tape<L> {
    fn default() -> Self {
        Tape::new()
    }
}

/// Writes the row of a step at rest: Ā_st (KTN73 Eq. 9) from the coordinates under a unit load at each axle, then the static
/// loads.
#[inline(always)]
pub fn write_at_rest<L: Lane>(of_one: &[f64], loads: &[L], row: &mut [L]) {
    let (coordinates, behind) = row.split_at_mut(row.len() - loads.len());
    behind.copy_from_slice(loads);
    let width = coordinates.len();
    for (i, coordinate) in coordinates.iter_mut().enumerate() {
        let terms = of_one.chunks_exact(width).zip(loads);
        *coordinate = terms.fold(L::splat(0.0), |sum, (shapes, load)| sum + *load * L::splat(shapes[i]));
    }
}
