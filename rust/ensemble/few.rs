//! Responses at the steps of a sample that has few like it: as in a single crossing, response beside response.
//!
//! To bound responses chunk by chunk pays where many samples share the influence of their loads. For a few it is less
//! work to evaluate every response at every step, from the same numbers in the same order: the extremes are the same bits.

use super::look::Look;
use super::stretch::Stretch;
use super::watch::Watched;
use crate::lane::Lane;
use crate::recovery::{Place, Rows, WIDTH};
use crate::survey::Watched as Block;

/// Looks for the extremes of every row at the steps of a stretch of one sample; `places` are those of its axles, by step
/// and axle, none where there is no axle on the bridge.
pub fn survey<L: Lane>(watched: &mut [Watched<L>], rows: &Rows, look: &Look, stretch: &Stretch<L>, places: &[Place]) {
    // The widest instruction set that the processor has; none of them changes a bit, because nothing is fused.
    pulp::Arch::new().dispatch(Walk { watched, rows, look, stretch, places });
}

struct Walk<'s, L> {
    watched: &'s mut [Watched<L>],
    rows: &'s Rows,
    look: &'s Look,
    stretch: &'s Stretch<L>,
    places: &'s [Place],
}

impl<L: Lane> pulp::WithSimd for Walk<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        let Walk { watched, rows, look, stretch, places } = self;
        let (c, axles) = (stretch.widths.coordinates, stretch.widths.axles);
        // Rows are in the order of their responses, so that those of one block follow each other.
        let block_of = |row: usize| look.rows[row].response / WIDTH;
        let mut first = 0;
        while first < look.rows.len() {
            let b = block_of(first);
            let last = (first..look.rows.len()).find(|&row| block_of(row) != b).unwrap_or(look.rows.len());
            let mut seen = Block::NOTHING;
            for (row, own) in look.rows[first..last].iter().zip(&watched[first..last]) {
                let i = row.response % WIDTH;
                (seen.max[i], seen.max_at[i]) = (own.max.get(0), own.max_at.get(0));
                (seen.min[i], seen.min_at[i]) = (own.min.get(0), own.min_at.get(0));
            }
            let mut number = stretch.from as f64;
            let mut places = places;
            for kept in stretch.taken() {
                let (here, behind) = places.split_at(axles.min(places.len()));
                places = behind;
                let coordinates = kept[..c].iter().map(|a| a.get(0));
                let loads = here.iter().zip(&kept[c..]).map(|(place, load)| (*place, load.get(0)));
                seen.take(&rows.block_of(b, coordinates, loads), number);
                number += 1.0;
            }
            for (row, own) in look.rows[first..last].iter().zip(&mut watched[first..last]) {
                let i = row.response % WIDTH;
                *own = Watched {
                    max: L::splat(seen.max[i]),
                    max_at: L::splat(seen.max_at[i]),
                    min: L::splat(seen.min[i]),
                    min_at: L::splat(seen.min_at[i]),
                };
            }
            first = last;
        }
    }
}
