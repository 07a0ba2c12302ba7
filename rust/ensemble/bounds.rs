//! Extremes without looking at every step.
//!
//! A response is a sum of products, (Σ factor·coordinate) + (Σ influence·load). Rounding being monotone, the same sum with
//! every product at its largest over some steps is no less than any value the response takes there, to the last bit. So
//! a glance at one step of every chunk finds values that the extremes must reach, and only those chunks are looked at
//! whose bounds reach them, and of these only the parts whose bounds do, one step after the other.

use super::table::{Chunk, middle};
use crate::extremes::{Peaks, value};
use crate::lane::{Lane, Work};
use crate::tape::{PART, PARTS, Tape};

/// Most numbers of a step that are held beside each other where how many there are is known.
const MOST: usize = 12;

/// The search for the extremes of every response at the steps of a tape: `chunks` of the influence of the loads, none
/// where there is no axle on the bridge. With C coordinates and A axles loops run a known number of times, and a chunk's
/// numbers stay in registers; with no C given there can be any number of either.
pub struct Searching<'s, L, const C: usize, const A: usize> {
    /// Extremes so far, by row.
    pub peaks: &'s mut [Peaks<L>],
    /// What multiplies the coordinates, by row.
    pub factors: &'s [f64],
    /// The steps.
    pub tape: &'s Tape<L>,
    /// What the axles do.
    pub chunks: Option<&'s [Chunk]>,
    /// Room to work in.
    pub glanced: &'s mut Vec<[L; 2]>,
}

impl<L: Lane, const C: usize, const A: usize> Work for Searching<'_, L, C, A> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Searching { peaks, factors, tape, chunks, glanced } = self;
        let (c, a) = match C {
            0 => (tape.widths.coordinates, if chunks.is_some() { tape.widths.axles } else { 0 }),
            _ => (C, A),
        };
        let unloaded = Chunk::default();
        let chunk_of = |chunk: usize| chunks.map_or(&unloaded, |chunks| &chunks[chunk]);
        let (felt, width) = (c + a, tape.widths.all());
        // What the extremes must reach.
        glanced.clear();
        glanced.extend(peaks.iter().map(|seen| [seen.max, seen.min]));
        let mut held = [L::splat(0.0); MOST];
        for (chunk, kept) in tape.chunks().enumerate() {
            let at = middle(kept.rows.len() / width);
            let row = hold::<C, _>(&kept.rows[at * width..][..felt], &mut held);
            let middles = &chunk_of(chunk).middles;
            for (r, ([most, least], factors)) in glanced.iter_mut().zip(factors.chunks_exact(c)).enumerate() {
                let value = value(factors, &middles[r * a..][..a], row);
                *most = value.larger(*most);
                *least = value.smaller(*least);
            }
        }
        let mut held = [[L::splat(0.0); 2]; MOST];
        for (chunk, kept) in tape.chunks().enumerate() {
            let Chunk { influence, bounds, parts, .. } = chunk_of(chunk);
            let count = kept.rows.len() / width;
            let ends = hold::<C, _>(&kept.limits[..felt], &mut held);
            let mut positive = true;
            for [_, least] in &ends[c..] {
                positive &= !L::any(least.less(L::splat(0.0)));
            }
            let rows = peaks.iter_mut().zip(glanced.iter()).zip(factors.chunks_exact(c));
            for (r, ((seen, reached), factors)) in rows.enumerate() {
                if !seen.may_grow(bound(factors, &bounds[r * a..][..a], ends, positive), *reached) {
                    continue;
                }
                let influence = &influence[r * count * a..][..count * a];
                let parts = &parts[r * PARTS * a..][..PARTS * a];
                for part in 0..count.div_ceil(PART) {
                    let ends = &kept.parts[part * width..][..felt];
                    if !seen.may_grow(bound(factors, &parts[part * a..][..a], ends, positive), *reached) {
                        continue;
                    }
                    let first = part * PART;
                    let (own, at) = (&influence[first * a..], kept.from + first);
                    look(seen, (factors, a), own, (&kept.rows[first * width..], width), at);
                }
            }
        }
    }
}

/// Some numbers, beside each other in registers if it is known how many: the compiler does not keep there what may be
/// written to.
#[inline(always)]
fn hold<'h, const C: usize, T: Copy>(numbers: &'h [T], held: &'h mut [T; MOST]) -> &'h [T] {
    if C == 0 {
        return numbers;
    }
    let held = &mut held[..numbers.len()];
    held.copy_from_slice(numbers);
    held
}

/// Takes in the values of a response in the steps of a part that begins with these numbers, the first of them `from`.
#[inline(always)]
fn look<L: Lane>(
    seen: &mut Peaks<L>,
    (factors, a): (&[f64], usize),
    influence: &[f64],
    (rows, width): (&[L], usize),
    from: usize,
) {
    let felt = factors.len() + a;
    let mut own = *seen;
    let mut at = from as f64;
    for (step, row) in rows.chunks_exact(width).take(PART).enumerate() {
        own.take(value(factors, &influence[step * a..][..a], &row[..felt]), L::splat(at));
        at += 1.0;
    }
    *seen = own;
}

/// Bounds of a response where coordinates and loads are between their `ends`, largest and smallest; whether the loads
/// are all `positive`.
#[inline(always)]
fn bound<L: Lane>(factors: &[f64], bounds: &[[f64; 2]], ends: &[[L; 2]], positive: bool) -> [L; 2] {
    let (of_coordinates, of_loads) = ends.split_at(factors.len());
    let between = |factor: f64, [most, least]: [L; 2]| {
        let (a, b) = (L::splat(factor) * most, L::splat(factor) * least);
        [a.larger(b), a.smaller(b)]
    };
    let [mut high, mut low] = between(factors[0], of_coordinates[0]);
    for (factor, ends) in factors[1..].iter().zip(&of_coordinates[1..]) {
        let [most, least] = between(*factor, *ends);
        (high, low) = (high + most, low + least);
    }
    // The loads by themselves first, as the values are summed up.
    let mut sum = [L::splat(0.0); 2];
    for (k, (&[from, to], ends)) in bounds.iter().zip(of_loads).enumerate() {
        let ([most, below], [above, least]) = (between(to, *ends), between(from, *ends));
        let [most, least] = if positive { [most, least] } else { [most.larger(above), below.smaller(least)] };
        sum = if k == 0 { [most, least] } else { [sum[0] + most, sum[1] + least] };
    }
    if bounds.is_empty() { [high, low] } else { [high + sum[0], low + sum[1]] }
}
