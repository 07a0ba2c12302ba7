//! Extremes without looking at every step.
//!
//! A response is a sum of products, Σ factor·coordinate + Σ influence·load. Rounding being monotone, the same sum with
//! every product at its largest over some steps is no less than any value the response takes there, to the last bit. So
//! a glance at one step of every chunk finds values that the extremes must reach, and only those chunks are looked at
//! whose bounds reach them, and of these only the parts whose bounds do, one step after the other.

use super::table::{Chunk, middle};
use crate::extremes::{Peaks, value};
use crate::lane::Lane;
use crate::selection::Row;
use crate::tape::{PART, PARTS, Tape};

/// Looks for the extremes of every response at the steps of a tape: `chunks` of the influence of the loads, none where
/// there is no axle on the bridge. `glanced` is scratch.
#[inline(always)]
pub fn search<L: Lane>(
    peaks: &mut [Peaks<L>],
    rows: &[Row],
    tape: &Tape<L>,
    chunks: Option<&[Chunk]>,
    glanced: &mut Vec<[L; 2]>,
) {
    // What is known when this is compiled runs much faster: the usual numbers of modes and axles. Not in debug builds,
    // which it would make long.
    macro_rules! sizes {
        ($($c:literal $a:literal),*) => {
            match (tape.widths.coordinates, if chunks.is_some() { tape.widths.axles } else { 0 }) {
                $(($c, $a) if !cfg!(debug_assertions) => search_sizes($c, $a, peaks, rows, tape, chunks, glanced),)*
                (c, a) => search_sizes(c, a, peaks, rows, tape, chunks, glanced),
            }
        };
    }
    sizes!(1 2, 2 2, 3 2, 4 2, 5 2, 3 3, 3 4, 3 5)
}

/// [`search`] with so many coordinates and axles.
#[inline(always)]
fn search_sizes<L: Lane>(
    c: usize,
    a: usize,
    peaks: &mut [Peaks<L>],
    rows: &[Row],
    tape: &Tape<L>,
    chunks: Option<&[Chunk]>,
    glanced: &mut Vec<[L; 2]>,
) {
    let unloaded = Chunk::default();
    let chunk_of = |chunk: usize| chunks.map_or(&unloaded, |chunks| &chunks[chunk]);
    let (felt, width) = (c + a, tape.widths.all());
    // What the extremes must reach.
    glanced.clear();
    for (r, (Row { factors, .. }, seen)) in rows.iter().zip(peaks.iter()).enumerate() {
        let (mut most, mut least) = (seen.max, seen.min);
        for (chunk, kept) in tape.chunks().enumerate() {
            let at = middle(kept.rows.len() / width);
            let value = value(&factors[..c], &chunk_of(chunk).middles[r * a..][..a], &kept.rows[at * width..][..felt]);
            most = value.larger(most);
            least = value.smaller(least);
        }
        glanced.push([most, least]);
    }
    for (chunk, kept) in tape.chunks().enumerate() {
        let Chunk { influence, bounds, parts, .. } = chunk_of(chunk);
        let count = kept.rows.len() / width;
        let ends = &kept.limits[..felt];
        let mut positive = true;
        for [_, least] in &ends[c..] {
            positive &= !L::any(least.less(L::splat(0.0)));
        }
        for (r, Row { factors, turned, .. }) in rows.iter().enumerate() {
            let (factors, turned) = (&factors[..c], &turned[..c]);
            if !peaks[r].may_grow(bound(factors, turned, &bounds[r * a..][..a], ends, positive), glanced[r]) {
                continue;
            }
            let mut seen = peaks[r];
            for part in 0..count.div_ceil(PART) {
                let ends = &kept.parts[part * width..][..felt];
                let reached = bound(factors, turned, &parts[(r * PARTS + part) * a..][..a], ends, positive);
                if !seen.may_grow(reached, glanced[r]) {
                    continue;
                }
                let first = part * PART;
                let influence = &influence[(r * count + first) * a..(r + 1) * count * a];
                let mut at = (kept.from + first) as f64;
                for (step, row) in kept.rows[first * width..].chunks_exact(width).take(PART).enumerate() {
                    seen.take(value(factors, &influence[step * a..][..a], &row[..felt]), L::splat(at));
                    at += 1.0;
                }
            }
            peaks[r] = seen;
        }
    }
}

/// Bounds of a response where coordinates and loads are between their `ends`, largest and smallest; whether the loads
/// are all `positive`.
#[inline(always)]
fn bound<L: Lane>(factors: &[f64], turned: &[usize], bounds: &[[f64; 2]], ends: &[[L; 2]], positive: bool) -> [L; 2] {
    // A negative factor takes the other end.
    let first = L::splat(factors[0]);
    let mut high = first * ends[0][turned[0]];
    let mut low = first * ends[0][1 - turned[0]];
    for i in 1..factors.len() {
        let factor = L::splat(factors[i]);
        high = high + factor * ends[i][turned[i]];
        low = low + factor * ends[i][1 - turned[i]];
    }
    for (k, &[from, to]) in bounds.iter().enumerate() {
        let ends = &ends[factors.len() + k];
        let (least, most) = (L::splat(from), L::splat(to));
        if positive {
            high = high + most * ends[usize::from(to < 0.0)];
            low = low + least * ends[usize::from(from >= 0.0)];
        } else {
            let (a, b) = (most * ends[0], most * ends[1]);
            let (c, d) = (least * ends[0], least * ends[1]);
            high = high + a.larger(b).larger(c.larger(d));
            low = low + a.smaller(b).smaller(c.smaller(d));
        }
    }
    [high, low]
}
