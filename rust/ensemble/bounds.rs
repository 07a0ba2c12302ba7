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
        let (felt, width) = (c + a, tape.widths.all());
        // What the extremes must reach.
        glanced.clear();
        glanced.extend(peaks.iter().map(|seen| [seen.max, seen.min]));
        for chunk in 0..tape.chunks() {
            let kept = tape.chunk(chunk);
            let at = middle(kept.rows.len() / width);
            let row = &kept.rows[at * width..][..felt];
            let middles = &chunks.map_or(&unloaded, |chunks| &chunks[chunk]).middles;
            for (r, (glanced, factors)) in glanced.iter_mut().zip(factors.chunks_exact(c)).enumerate() {
                let [most, least] = glanced;
                for p in 0..L::FEWS {
                    let value = value(factors, &middles[r * a..][..a], row, p);
                    most.put_few(p, value.larger(most.few(p)));
                    least.put_few(p, value.smaller(least.few(p)));
                }
            }
        }
        // What bounds must exceed: just less than that, or else what there is already.
        let (part, least_part) = (L::splat(4.0 * f64::EPSILON), L::splat(f64::MIN_POSITIVE));
        for ([most, least], seen) in glanced.iter_mut().zip(peaks.iter()) {
            *most = (*most - (most.magnitude() * part + least_part)).larger(seen.max);
            *least = (*least + (least.magnitude() * part + least_part)).smaller(seen.min);
        }
        for chunk in 0..tape.chunks() {
            let kept = tape.chunk(chunk);
            let Chunk { influence, bounds, parts, .. } = chunks.map_or(&unloaded, |chunks| &chunks[chunk]);
            let count = kept.rows.len() / width;
            let ends = &kept.limits[..felt];
            let mut positive = true;
            for [_, least] in &ends[c..] {
                positive &= !L::any(least.less(L::splat(0.0)));
            }
            let rows = peaks.iter_mut().zip(glanced.iter_mut()).zip(factors.chunks_exact(c));
            for (r, ((seen, glanced), factors)) in rows.enumerate() {
                let bounds = &bounds[r * a..][..a];
                for p in 0..L::FEWS {
                    let [mut most, mut least] = [glanced[0].few(p), glanced[1].few(p)];
                    if !exceeds(bound(factors, bounds, ends, p, positive), [most, least]) {
                        continue;
                    }
                    let influence = &influence[r * count * a..][..count * a];
                    let parts = &parts[r * PARTS * a..][..PARTS * a];
                    let mut own = seen.few(p);
                    for part in 0..count.div_ceil(PART) {
                        let ends = &kept.parts[part * width..][..felt];
                        if !exceeds(bound(factors, &parts[part * a..][..a], ends, p, positive), [most, least]) {
                            continue;
                        }
                        let first = part * PART;
                        let mut at = L::Few::splat((kept.from + first) as f64);
                        let rows = kept.rows[first * width..].chunks_exact(width).take(PART);
                        for (step, row) in rows.enumerate() {
                            let influence = &influence[(first + step) * a..][..a];
                            own.take(value(factors, influence, &row[..felt], p), at);
                            at = at + L::Few::splat(1.0);
                        }
                        (most, least) = (most.larger(own.max), least.smaller(own.min));
                    }
                    seen.put_few(p, own);
                    glanced[0].put_few(p, most);
                    glanced[1].put_few(p, least);
                }
            }
        }
    }
}

/// Whether values within these bounds, the upper and the lower, can exceed the extremes so far in any sample.
#[inline(always)]
fn exceeds<P: Lane>([high, low]: [P; 2], [most, least]: [P; 2]) -> bool {
    P::any(most.less(high) | low.less(least))
}

/// Bounds of a response, in a few samples, where coordinates and loads are between their `ends`, largest and
/// smallest; whether the loads are all `positive`.
#[inline(always)]
fn bound<L: Lane>(factors: &[f64], bounds: &[[f64; 2]], ends: &[[L; 2]], number: usize, positive: bool) -> [L::Few; 2] {
    if positive {
        bound_of::<L, true>(factors, bounds, ends, number)
    } else {
        bound_of::<L, false>(factors, bounds, ends, number)
    }
}

#[inline(always)]
fn bound_of<L: Lane, const POSITIVE: bool>(
    factors: &[f64],
    bounds: &[[f64; 2]],
    ends: &[[L; 2]],
    number: usize,
) -> [L::Few; 2] {
    let (of_coordinates, of_loads) = ends.split_at(factors.len());
    let [mut high, mut low] = between(factors[0], &of_coordinates[0], number);
    for (factor, ends) in factors[1..].iter().zip(&of_coordinates[1..]) {
        let [most, least] = between(*factor, ends, number);
        (high, low) = (high + most, low + least);
    }
    // The loads by themselves first, as the values are summed up.
    let mut sum = [L::Few::splat(0.0); 2];
    for (k, (&[from, to], ends)) in bounds.iter().zip(of_loads).enumerate() {
        let ([most, below], [above, least]) = (between(to, ends, number), between(from, ends, number));
        let [most, least] = if POSITIVE { [most, least] } else { [most.larger(above), below.smaller(least)] };
        sum = if k == 0 { [most, least] } else { [sum[0] + most, sum[1] + least] };
    }
    if bounds.is_empty() { [high, low] } else { [high + sum[0], low + sum[1]] }
}

/// Largest and smallest of a factor times what lies between these ends, largest and smallest: which of them it is follows
/// from the sign, so that nothing is compared.
#[inline(always)]
fn between<L: Lane>(factor: f64, ends: &[L; 2], number: usize) -> [L::Few; 2] {
    let negative = (factor.to_bits() >> 63) as usize;
    let factor = L::Few::splat(factor);
    [factor * ends[negative].few(number), factor * ends[1 - negative].few(number)]
}
