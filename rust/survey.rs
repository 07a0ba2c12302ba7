//! The search for the extremes of every response of one sample, row beside row, that looks only where they can be.
//!
//! What [`crate::ensemble::bounds`] does for samples whose axles stand at the same places is done here for one whose axles
//! are anywhere: how far the influence of a load can come between two places is known from [`windows`] of the influence
//! lines. A bound is the same sum as a value, with every product at its largest, so that nothing is lost to rounding.

pub(crate) mod windows;

pub use windows::{Reached, Windows};

use crate::extremes::{Peaks, Seen};
use crate::lane::Lane;
use crate::recovery::{Block, Placed, Responding, Rows, WIDTH};
use crate::selection::Selection;
use crate::tape::PART;

/// Stretches in a far one.
pub const FAR: usize = 4;

/// Numbers of some steps that follow each other, between bounds.
#[derive(Debug, Clone, Default)]
pub struct Stretch {
    /// Number of the first step.
    pub from: usize,
    /// How many.
    pub count: usize,
    /// Largest and smallest of what the rows multiply.
    pub coordinates: Vec<[f64; 2]>,
    /// Of axles that come on to the bridge: where they are, and largest and smallest of their loads.
    pub loads: Vec<(Reached, [f64; 2])>,
}

/// What responses follow from at a step.
#[derive(Debug, Clone, Default)]
pub struct Moment {
    /// What the rows multiply.
    pub coordinates: Vec<[f64; 1]>,
    /// Axles on the bridge.
    pub placed: Vec<Placed<1>>,
}

/// Extremes so far of all responses looked at, in blocks.
#[derive(Debug, Clone)]
pub struct Survey {
    /// Numbers of the blocks.
    blocks: Vec<usize>,
    peaks: Vec<Peaks<Responding>>,
    /// What the extremes reach anyway, at stops.
    reached: Vec<[Responding; 2]>,
    glanced: Vec<[Responding; 2]>,
    /// Blocks in which extremes can be of a far stretch, and of one.
    near: Vec<usize>,
    left: Vec<usize>,
    /// What the steps of a part are made of.
    moments: Vec<Moment>,
}

impl Survey {
    /// Nothing seen yet, or all at rest at step zero.
    pub fn new(look: &Selection, at_rest: bool) -> Self {
        // Rows are in the order of their responses, so that those of one block follow each other.
        let mut blocks: Vec<usize> = look.rows.iter().map(|row| row.response / WIDTH).collect();
        blocks.dedup();
        let before = if at_rest { Peaks::<f64>::rest() } else { Peaks::nothing() };
        // Nothing is larger or smaller than what is not looked at.
        let beyond = Peaks { max: f64::INFINITY, min: f64::NEG_INFINITY, ..before };
        let mut each = vec![[beyond; WIDTH]; blocks.len()];
        for row in &look.rows {
            if let Ok(block) = blocks.binary_search(&(row.response / WIDTH)) {
                each[block][row.response % WIDTH] = before;
            }
        }
        let nothing = Peaks::<Responding>::nothing();
        Survey {
            peaks: each.iter().map(|each| Peaks::beside(each)).collect(),
            reached: vec![[nothing.max, nothing.min]; blocks.len()],
            glanced: Vec::new(),
            near: Vec::new(),
            left: Vec::new(),
            moments: vec![Moment::default(); PART],
            blocks,
        }
    }

    /// Takes in what extremes have reached at stops, row by row: smaller ones at steps are of no more concern.
    pub fn reach(&mut self, look: &Selection, stops: &[Peaks<f64>]) {
        let nothing = Peaks::<f64>::nothing();
        let mut each = vec![[[nothing.max; WIDTH], [nothing.min; WIDTH]]; self.blocks.len()];
        for (row, peaks) in look.rows.iter().zip(stops) {
            if let Ok(block) = self.blocks.binary_search(&(row.response / WIDTH)) {
                let [most, least] = &mut each[block];
                (most[row.response % WIDTH], least[row.response % WIDTH]) = (peaks.max, peaks.min);
            }
        }
        self.reached = each.into_iter().map(|sides| sides.map(Responding::from)).collect();
    }

    /// Largest and smallest of a response so far.
    pub fn of(&self, response: usize) -> Option<Peaks<f64>> {
        let block = self.blocks.binary_search(&(response / WIDTH)).ok()?;
        Some(self.peaks[block].one(response % WIDTH))
    }

    /// Those of all rows.
    pub fn seen(&self, look: &Selection, stops: Vec<Peaks<f64>>) -> Seen<f64> {
        let steps = look.rows.iter().map(|row| self.of(row.response).unwrap_or_else(Peaks::nothing));
        Seen { steps: steps.collect(), stops }
    }

    /// Looks at some steps: `stretches` of them, each in parts, and perhaps `far` ones, each of [`FAR`] of these, where `at` says what a step is made of. Steps count from
    /// `offset`. A glance at each beforehand pays where little is known of what extremes will reach.
    #[inline(always)]
    pub fn look(
        &mut self,
        rows: &Rows,
        windows: &Windows,
        (far, stretches): (&[Stretch], &[(Stretch, Vec<Stretch>)]),
        mut at: impl FnMut(usize, &mut Moment),
        (offset, glance): (usize, bool),
    ) {
        let Survey { blocks, peaks, reached, glanced, near, left, moments } = self;
        // What the extremes must reach.
        glanced.clear();
        let larger = |(seen, [most, least]): (&Peaks<Responding>, &[Responding; 2])| {
            [seen.max.larger(*most), seen.min.smaller(*least)]
        };
        glanced.extend(peaks.iter().zip(reached.iter()).map(larger));
        for (whole, _) in stretches.iter().filter(|_| glance) {
            let moment = &mut moments[0];
            at(whole.from + whole.count / 2, moment);
            for (&block, [most, least]) in blocks.iter().zip(glanced.iter_mut()) {
                let [values] = rows.of_block(block).at(&moment.coordinates, &moment.placed);
                let values = Responding::from(values);
                (*most, *least) = (values.larger(*most), values.smaller(*least));
            }
        }
        near.clear();
        near.extend(0..blocks.len());
        for (i, (whole, parts)) in stretches.iter().enumerate() {
            if let Some(far) = far.get(i / FAR).filter(|_| i % FAR == 0) {
                near.clear();
                for (b, &block) in blocks.iter().enumerate() {
                    let bound = bound(rows.factors_of_block(block), windows, block, far);
                    if may_grow(&peaks[b], bound, glanced[b]) {
                        near.push(b);
                    }
                }
            }
            left.clear();
            for &b in near.iter() {
                let bound = bound(rows.factors_of_block(blocks[b]), windows, blocks[b], whole);
                if may_grow(&peaks[b], bound, glanced[b]) {
                    left.push(b);
                }
            }
            for part in parts {
                // What steps are made of is worked out once, for the first block that needs it.
                let mut known = false;
                for &b in left.iter() {
                    let block = blocks[b];
                    let bound = bound(rows.factors_of_block(block), windows, block, part);
                    if !may_grow(&peaks[b], bound, glanced[b]) {
                        continue;
                    }
                    if !known {
                        for (i, moment) in moments[..part.count].iter_mut().enumerate() {
                            at(part.from + i, moment);
                        }
                        known = true;
                    }
                    let mut own = peaks[b];
                    let mut number = (offset + part.from) as f64;
                    for moment in &moments[..part.count] {
                        let [values] = rows.of_block(block).at(&moment.coordinates, &moment.placed);
                        own.take(Responding::from(values), Responding::splat(number));
                        number += 1.0;
                    }
                    peaks[b] = own;
                }
            }
        }
    }
}

/// Whether values within these bounds, the upper and the lower, can be new extremes of any response, where it is known what
/// the extremes will reach in the end.
#[inline(always)]
fn may_grow(peaks: &Peaks<Responding>, [high, low]: [Responding; 2], [most, least]: [Responding; 2]) -> bool {
    let above = !(!peaks.max.less(high) | high.less(most));
    let below = !(!low.less(peaks.min) | least.less(low));
    Responding::any(above | below)
}

/// Bounds of the responses of a block in a stretch.
#[inline(always)]
fn bound(factors: &[Block], windows: &Windows, block: usize, stretch: &Stretch) -> [Responding; 2] {
    let zero = Responding::splat(0.0);
    let (mut high, mut low) = (zero, zero);
    for (factor, [most, least]) in factors.iter().zip(&stretch.coordinates) {
        let factor = Responding::from(*factor);
        let (a, b) = (factor * Responding::splat(*most), factor * Responding::splat(*least));
        (high, low) = (high + a.larger(b), low + a.smaller(b));
    }
    let (mut of_loads, mut of_loads_least) = (zero, zero);
    for (reached, [most, least]) in &stretch.loads {
        let ([from, to], positive) = (windows.of(block, reached), *least >= 0.0);
        let (most, least) = (Responding::splat(*most), Responding::splat(*least));
        let (a, b) = (to * most, to * least);
        let (c, d) = (from * most, from * least);
        if positive {
            of_loads = of_loads + a.larger(b);
            of_loads_least = of_loads_least + c.smaller(d);
        } else {
            of_loads = of_loads + a.larger(b).larger(c.larger(d));
            of_loads_least = of_loads_least + a.smaller(b).smaller(c.smaller(d));
        }
    }
    [high + of_loads, low + of_loads_least]
}
