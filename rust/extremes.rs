//! Extremes: the largest and smallest of every response so far, at steps and at stops between them.

use serde::{Deserialize, Serialize};

use crate::lane::Lane;
use crate::recovery::{Placed, Responding, Rows, WIDTH};
use crate::selection::Selection;
use crate::stops::{PassingInfluence, Stop};
use crate::tape::Widths;

/// Largest and smallest so far, and when: the number of a step or of a stop; of one value in samples side by side, or of
/// responses side by side.
///
/// Looked at in every step, so without a branch: the number is an `f64` and chosen along with the value.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Peaks<L> {
    /// Largest.
    pub max: L,
    /// When.
    pub max_at: L,
    /// Smallest.
    pub min: L,
    /// When.
    pub min_at: L,
}

impl<L: Lane> Peaks<L> {
    /// Nothing seen yet.
    #[inline(always)]
    pub fn nothing() -> Self {
        let (low, high, zero) = (L::splat(f64::NEG_INFINITY), L::splat(f64::INFINITY), L::splat(0.0));
        Peaks { max: low, max_at: zero, min: high, min_at: zero }
    }

    /// At rest at step zero.
    #[inline(always)]
    pub fn rest() -> Self {
        let zero = L::splat(0.0);
        Peaks { max: zero, max_at: zero, min: zero, min_at: zero }
    }

    /// That of one lane.
    pub fn one(&self, lane: usize) -> Peaks<f64> {
        let [max, max_at, min, min_at] = [self.max, self.max_at, self.min, self.min_at].map(|of| of.get(lane));
        Peaks { max, max_at, min, min_at }
    }

    /// From one for each lane; the last is that of all that follow too.
    pub fn beside(each: &[Peaks<f64>]) -> Self {
        let of = |part: fn(&Peaks<f64>) -> f64| L::from_fn(|lane| part(&each[lane.min(each.len() - 1)]));
        Peaks { max: of(|w| w.max), max_at: of(|w| w.max_at), min: of(|w| w.min), min_at: of(|w| w.min_at) }
    }

    /// This, but for the lanes of a mask, which are as they were.
    #[inline(always)]
    pub fn unless(self, mask: L::Mask, before: Self) -> Self {
        Peaks {
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
        self.max_at = L::select(above, at, self.max_at);
        self.min_at = L::select(below, at, self.min_at);
        self.max = value.larger(self.max);
        self.min = value.smaller(self.min);
    }

    /// That of a few samples.
    #[inline(always)]
    pub fn few(&self, number: usize) -> Peaks<L::Few> {
        Peaks {
            max: self.max.few(number),
            max_at: self.max_at.few(number),
            min: self.min.few(number),
            min_at: self.min_at.few(number),
        }
    }

    /// Puts that of a few samples in its place.
    #[inline(always)]
    pub fn put_few(&mut self, number: usize, own: Peaks<L::Few>) {
        self.max.put_few(number, own.max);
        self.max_at.put_few(number, own.max_at);
        self.min.put_few(number, own.min);
        self.min_at.put_few(number, own.min_at);
    }
}

/// An instant at which an extreme can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instant {
    /// The end of a step, by its number.
    Step(usize),
    /// A stop between two steps, by its number.
    Stop(usize),
}

/// Extremes of all rows.
#[derive(Debug, Clone)]
pub struct Seen<L> {
    /// By row, at steps.
    pub steps: Vec<Peaks<L>>,
    /// By row, at stops.
    pub stops: Vec<Peaks<L>>,
}

impl<L: Lane> Seen<L> {
    /// Of so many rows nothing, or at rest at step zero.
    pub fn beginning(rows: usize, at_rest: bool) -> Self {
        let before = if at_rest { Peaks::rest() } else { Peaks::nothing() };
        Seen { steps: vec![before; rows], stops: vec![Peaks::nothing(); rows] }
    }

    /// Largest and smallest of a row.
    #[inline(always)]
    pub fn reached(&self, row: usize) -> [L; 2] {
        let (at_step, at_stop) = (&self.steps[row], &self.stops[row]);
        [at_step.max.larger(at_stop.max), at_step.min.smaller(at_stop.min)]
    }

    /// Largest and smallest of a row in one lane, each with its instant; `when` that is. Of equal values the first counts,
    /// and if they are one instant the stop.
    pub fn sides(&self, row: usize, lane: usize, when: impl Fn(Instant) -> f64) -> [(f64, Instant); 2] {
        let pick = |of: fn(&Peaks<L>) -> [&L; 2], sense: f64| {
            let number = |peaks: &Peaks<L>| {
                let [value, at] = of(peaks);
                (value.get(lane), at.get(lane) as usize)
            };
            let ((at_step, step), (at_stop, stop)) = (number(&self.steps[row]), number(&self.stops[row]));
            let (step, stop) = (Instant::Step(step), Instant::Stop(stop));
            let better = sense * at_stop > sense * at_step;
            // Zeros lose their sign, which says nothing and would depend on the order of sums.
            if better || at_stop == at_step && when(stop) <= when(step) {
                (at_stop + 0.0, stop)
            } else {
                (at_step + 0.0, step)
            }
        };
        [pick(|w| [&w.max, &w.max_at], 1.0), pick(|w| [&w.min, &w.min_at], -1.0)]
    }
}

/// One response at a step, in a few samples: what the loads do is summed up by itself, so that it may be known beforehand.
#[inline(always)]
pub fn value<L: Lane>(factors: &[f64], influence: &[f64], row: &[L], number: usize) -> L::Few {
    let mut value = L::Few::splat(factors[0]) * row[0].few(number);
    for (factor, a) in factors[1..].iter().zip(&row[1..]) {
        value = value + L::Few::splat(*factor) * a.few(number);
    }
    let mut of_loads = L::Few::splat(0.0);
    for (k, (g, load)) in influence.iter().zip(&row[factors.len()..]).enumerate() {
        let own = L::Few::splat(*g) * load.few(number);
        of_loads = if k == 0 { own } else { of_loads + own };
    }
    if influence.is_empty() { value } else { value + of_loads }
}

/// What the rows multiply at a stop, from the steps before and after it, of which it is a mixture, but for what jumps.
#[inline(always)]
pub fn interpolate<L: Lane>(stop: &Stop, [before, after]: [&[L]; 2], widths: &Widths, between: &mut Vec<L>) {
    let fraction = L::splat(stop.fraction);
    between.clear();
    for i in 0..widths.used() {
        between.push(before[i] + fraction * (after[i] - before[i]));
    }
    if let Some(step) = stop.jump {
        let side = if step == stop.step { after } else { before };
        let (jumps, c) = (widths.jumps(), widths.coordinates);
        between[jumps..c].copy_from_slice(&side[jumps..c]);
        between[c + stop.axle] = side[c + stop.axle];
    }
}

/// Takes in a stop, given coordinates and loads then, and what they do to the rows asked for.
#[inline(always)]
pub fn at_stop<L: Lane>(
    peaks: &mut [Peaks<L>],
    look: &Selection,
    (stop, number, moment): (&Stop, usize, &PassingInfluence),
    then: &[L],
) {
    let at = L::Few::splat(number as f64);
    let c = look.rows.first().map_or(0, |row| row.factors.len());
    for (&r, influence) in look.asked[stop.asked].iter().zip(moment.influence.chunks_exact(then.len() - c)) {
        for number in 0..L::FEWS {
            let value = value(&look.rows[r].factors, influence, then, number);
            let mut own = peaks[r].few(number);
            own.take(value, at);
            if let Some((tip, sign)) = stop.tip
                && tip == r
            {
                own.take(value + L::Few::splat(sign) * then[c + stop.axle].few(number), at);
            }
            peaks[r].put_few(number, own);
        }
    }
}

/// Steps of one sample, with every response evaluated in blocks of [`WIDTH`]; in one state, or dynamic and at rest together.
///
/// To bound responses chunk by chunk, as [`crate::ensemble::bounds`] does, pays where many samples share the influence of
/// their loads. For a few it is less work to evaluate all.
#[derive(Debug, Clone, Default)]
pub struct PlacedSteps<const STATES: usize> {
    /// Number of the first.
    pub from: usize,
    /// Axles that may be on the bridge.
    pub axles: usize,
    /// What the rows multiply, step after step.
    pub coordinates: Vec<[f64; STATES]>,
    /// The axles, step after step.
    pub placed: Vec<Placed<STATES>>,
}

impl<const STATES: usize> PlacedSteps<STATES> {
    /// Begins anew with a step of this number.
    pub fn begin(&mut self, from: usize, axles: usize) {
        (self.from, self.axles) = (from, axles);
        self.coordinates.clear();
        self.placed.clear();
    }

    /// Takes the extremes of every row in these steps in, state by state.
    pub fn look<L: Lane>(&self, rows: &Rows, look: &Selection, seen: [&mut [Peaks<L>]; STATES]) {
        // Rows are in the order of their responses, so that those of one block follow each other.
        let of_blocks = || look.rows.chunk_by(|a, b| a.response / WIDTH == b.response / WIDTH);
        let blocks = of_blocks().map(|of_block| (of_block[0].response / WIDTH, [Peaks::nothing(); STATES]));
        let mut looking = Looking { rows, steps: self, blocks: blocks.collect() };
        for (state, seen) in seen.iter().enumerate() {
            let mut all = seen.iter();
            for (of_block, (_, blocks)) in of_blocks().zip(&mut looking.blocks) {
                let mut before = [Peaks::<f64>::nothing(); WIDTH];
                for (row, own) in of_block.iter().zip(&mut all) {
                    before[row.response % WIDTH] = own.one(0);
                }
                blocks[state] = Peaks::beside(&before);
            }
        }
        // The widest instruction set that the processor has; none of them changes a bit, because nothing is fused.
        pulp::Arch::new().dispatch(&mut looking);
        for (state, seen) in seen.into_iter().enumerate() {
            let mut all = seen.iter_mut();
            for (of_block, (_, blocks)) in of_blocks().zip(&looking.blocks) {
                for (row, own) in of_block.iter().zip(&mut all) {
                    *own = Peaks::beside(&[blocks[state].one(row.response % WIDTH)]);
                }
            }
        }
    }
}

/// Such steps being looked at: each block of responses with its extremes so far.
struct Looking<'s, const STATES: usize> {
    rows: &'s Rows,
    steps: &'s PlacedSteps<STATES>,
    blocks: Vec<(usize, [Peaks<Responding>; STATES])>,
}

impl<const STATES: usize> pulp::WithSimd for &mut Looking<'_, STATES> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        let Looking { rows, steps: PlacedSteps { from, axles, coordinates, placed }, blocks } = self;
        let width = rows.width();
        for (b, seen) in blocks {
            // From memory to registers and back as a whole: the compiler takes numbers side by side only so.
            let (mut own, of_block) = (*seen, rows.of_block(*b));
            let mut number = *from as f64;
            for (i, coordinates) in coordinates.chunks_exact(width).enumerate() {
                let values = of_block.at(coordinates, &placed[i * axles..][..*axles]);
                for (own, values) in own.iter_mut().zip(values) {
                    own.take(Responding::from(values), Responding::splat(number));
                }
                number += 1.0;
            }
            *seen = own;
        }
    }
}
