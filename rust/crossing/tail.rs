//! How long the tail after a crossing is: until no response can exceed what it has reached.

use crate::crossing::history::History;
use crate::damping::ModalDamping;
use crate::error::Error;
use crate::lane::Lane;
use crate::modal_bridge::ModalBridge;
use crate::recovery::Rows;
use crate::statics::influence::Responses;
use crate::statics::quantity::{Quantity, Unit};
use crate::step::vibration::Reach;
use crate::stop_token::StopToken;

/// Part of an extreme by which the tail may still have exceeded it.
const TOLERANCE: f64 = 1e-3;

/// Response that is nothing but rounding, relative to what the static loads can come to.
const ROUNDING: f64 = 1e-9;

/// Parts of an extreme, and of the largest of its kind along the bridge, which to exceed is worth a word.
const WORTH: [f64; 2] = [1e-2, 1e-3];

/// Responses of the bridge in free vibration, as sums over the modal coordinates.
#[derive(Debug, Clone)]
pub struct FreeRows {
    modes: usize,
    /// What multiplies the modal coordinates, row by row.
    factors: Vec<f64>,
    /// Length of what multiplies the modal velocities besides, by row.
    rest: Vec<f64>,
    /// The kind of each, shears on both sides of a section being one.
    kinds: Vec<usize>,
    /// What of each kind is rounding, by the static loads of all axles [unit/N].
    rounding: [f64; KINDS],
}

/// Kinds of response.
const KINDS: usize = Quantity::ALL.len();

impl FreeRows {
    /// Of all responses.
    pub fn new(rows: &Rows, responses: &Responses, model: &ModalBridge) -> Self {
        let modes = model.omega.len();
        let (mut factors, mut rest) = (Vec::with_capacity(rows.len() * modes), Vec::with_capacity(rows.len()));
        let mut kinds = Vec::with_capacity(rows.len());
        for r in 0..rows.len() {
            // With Ä = −(Ω²A + DȦ).
            let [values, velocities, accelerations] =
                [0, 1, 2].map(|order| move |m: usize| rows.factor_of(r, order, m));
            factors.extend((0..modes).map(|m| values(m) - accelerations(m) * model.omega[m].powi(2)));
            let quantity = responses.quantity_of(r).0;
            let rate = |m: usize| match &model.damping {
                // Of the forces on the masses damping cancels.
                ModalDamping::Classical(_) if quantity.order() == 0 => 0.0,
                ModalDamping::Classical(ratios) => velocities(m) - accelerations(m) * 2.0 * ratios[m] * model.omega[m],
                ModalDamping::Coupled(d) => {
                    velocities(m) - (0..modes).map(|i| accelerations(i) * d[(i, m)]).sum::<f64>()
                }
            };
            rest.push((0..modes).map(|m| rate(m).powi(2)).sum::<f64>().sqrt());
            kinds.push(quantity.together() as usize);
        }
        let [slowest, fastest] =
            [f64::min, f64::max].map(|pick| model.omega.iter().copied().reduce(pick).unwrap_or(f64::INFINITY));
        let length = model.shapes.mesh().length();
        let deflection = model.shapes.largest_sum_of_squares() / slowest.powi(2);
        let rounding = Quantity::ALL.map(|quantity| {
            let of_unit = match quantity.unit() {
                Unit::Metre => deflection,
                Unit::Newton => 1.0,
                Unit::NewtonMetre => length,
                Unit::Radian => deflection / length,
            };
            ROUNDING * of_unit * fastest.powi(quantity.order() as i32)
        });
        FreeRows { modes, factors, rest, kinds, rounding }
    }

    /// Some of them.
    pub fn of(&self, some: impl Iterator<Item = usize> + Clone) -> Self {
        FreeRows {
            modes: self.modes,
            factors: some.clone().flat_map(|r| self.row(r).0).copied().collect(),
            rest: some.clone().map(|r| self.rest[r]).collect(),
            kinds: some.map(|r| self.kinds[r]).collect(),
            rounding: self.rounding,
        }
    }

    fn row(&self, r: usize) -> (&[f64], f64) {
        (&self.factors[r * self.modes..(r + 1) * self.modes], self.rest[r])
    }

    /// Largest magnitude of every response.
    pub fn bounds<L: Lane>(&self, reach: &Reach<L>) -> Vec<L> {
        (0..self.rest.len()).map(|r| reach.of(self.row(r))).collect()
    }

    /// In which lanes no response can exceed by more than a thousandth what it has reached, its largest and its smallest
    /// being those that `seen` tells; the static `load` is that of all axles [N].
    #[inline(always)]
    pub fn settled<L: Lane>(&self, reach: &Reach<L>, load: L, seen: impl Fn(usize) -> [L; 2]) -> L::Mask {
        let mut unsettled = L::never();
        for r in 0..self.rest.len() {
            unsettled = unsettled | self.unsettled(r, reach, load, seen(r));
            if !L::any(!unsettled) {
                break;
            }
        }
        !unsettled
    }

    /// In which lanes one row can.
    #[inline(always)]
    pub fn unsettled<L: Lane>(&self, r: usize, reach: &Reach<L>, load: L, [max, min]: [L; 2]) -> L::Mask {
        let (bound, floor) = (reach.of(self.row(r)), L::splat(self.rounding[self.kinds[r]]) * load);
        let beyond = |extreme: L| extreme + L::splat(TOLERANCE) * extreme.magnitude() + floor;
        // What is no number is not settled.
        !bound.less(beyond(max)) | !bound.less(beyond(-min))
    }

    /// How far free vibration can exceed what has been seen, in parts of the largest of its kind along the bridge, and
    /// the row where it is most: twice its number, and one more of the smallest. Zero where that is not worth a word.
    #[inline(always)]
    pub fn growth<L: Lane>(&self, reach: &Reach<L>, seen: impl Fn(usize) -> [L; 2]) -> [L; 2] {
        let zero = L::splat(0.0);
        let mut largest = [zero; KINDS];
        for (r, &kind) in self.kinds.iter().enumerate() {
            let [max, min] = seen(r);
            largest[kind] = max.magnitude().larger(min.magnitude()).larger(largest[kind]);
        }
        let (mut growth, mut side_of_row) = (zero, zero);
        for (r, &kind) in self.kinds.iter().enumerate() {
            let (bound, [max, min]) = (reach.of(self.row(r)), seen(r));
            for (side, extreme) in [max, -min].into_iter().enumerate() {
                let excess = bound - extreme;
                let least = L::splat(WORTH[0]) * extreme.magnitude() + L::splat(WORTH[1]) * largest[kind];
                let part = excess / largest[kind];
                let more = !(!least.less(excess) | !growth.less(part));
                growth = L::select(more, part, growth);
                side_of_row = L::select(more, L::splat((2 * r + side) as f64), side_of_row);
            }
        }
        [growth, side_of_row]
    }
}

/// Looks at a crossing on its way.
pub trait Watch {
    /// Whether nothing that follows what has been recorded can matter, given what free vibration can reach.
    fn enough(&mut self, history: &History, reach: &Reach<f64>, stop: StopToken<'_>) -> Result<bool, Error>;
}

/// The last step of a crossing whose vehicles have all left, or stand, at the time `ended` [s], in step number `exit`, and
/// that has a tail [s] in steps of h [s]; and how far through that step it ends.
pub fn end(ended: f64, exit: usize, h: f64, tail: f64) -> (usize, f64) {
    let end = ended + tail;
    let mut last = exit.max((end / h) as usize);
    // The first step that comes so far.
    while last > exit && (last - 1) as f64 * h >= end - 1e-9 * h {
        last -= 1;
    }
    while (last as f64) * h < end - 1e-9 * h {
        last += 1;
    }
    let time = last as f64 * h;
    (last, if time > end + 1e-9 * h { 1.0 - (time - end) / h } else { 1.0 })
}
