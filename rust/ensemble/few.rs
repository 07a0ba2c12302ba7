//! Extremes at the steps of a sample that has few like it: as in a single crossing, response beside response.
//!
//! To bound responses chunk by chunk pays where many samples share the influence of their loads. For a few it is less
//! work to evaluate every response at every step, from the same numbers in the same order: the extremes are the same bits.

use super::selection::Selection;
use super::tape::Tape;
use crate::crossing::watched::Watched;
use crate::lane::Lane;
use crate::recovery::{Place, Placed, Responding, Rows, WIDTH};

/// Looks for the extremes of every row at the steps of a stretch of one sample; `places` are those of its axles, by step
/// and axle, none where there is no axle on the bridge.
pub fn survey<L: Lane>(watched: &mut [Watched<L>], rows: &Rows, look: &Selection, stretch: &Tape<L>, places: &[Place]) {
    let (c, axles) = (stretch.widths.coordinates, if places.is_empty() { 0 } else { stretch.widths.axles });
    let mut steps = Steps {
        rows,
        from: stretch.from,
        axles,
        coordinates: Vec::with_capacity(c * stretch.steps),
        placed: Vec::with_capacity(axles * stretch.steps),
        blocks: Vec::new(),
    };
    for (i, kept) in stretch.taken().enumerate() {
        steps.coordinates.extend(kept[..c].iter().map(|a| a.get(0)));
        let here = places[i * axles..][..axles].iter().zip(&kept[c..]);
        steps.placed.extend(here.map(|(&place, load)| Placed::new(place, load.get(0), 0.0)));
    }
    // Rows are in the order of their responses, so that those of one block follow each other.
    let of_blocks = || look.rows.chunk_by(|a, b| a.response / WIDTH == b.response / WIDTH);
    let mut all = watched.iter();
    for rows in of_blocks() {
        let mut seen = [Watched::<f64>::nothing(); WIDTH];
        for (row, own) in rows.iter().zip(&mut all) {
            seen[row.response % WIDTH] = own.one(0);
        }
        steps.blocks.push((rows[0].response / WIDTH, Watched::beside(&seen)));
    }
    // The widest instruction set that the processor has; none of them changes a bit, because nothing is fused.
    pulp::Arch::new().dispatch(&mut steps);
    let mut all = watched.iter_mut();
    for (rows, (_, seen)) in of_blocks().zip(&steps.blocks) {
        for (row, own) in rows.iter().zip(&mut all) {
            *own = Watched::beside(&[seen.one(row.response % WIDTH)]);
        }
    }
}

/// Steps of one sample made ready, and the extremes of each block in them and before.
struct Steps<'s> {
    rows: &'s Rows,
    from: usize,
    /// Those that may be on the bridge.
    axles: usize,
    coordinates: Vec<f64>,
    placed: Vec<Placed>,
    blocks: Vec<(usize, Watched<Responding>)>,
}

impl pulp::WithSimd for &mut Steps<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        let (width, axles) = (self.rows.width(), self.axles);
        for (b, seen) in &mut self.blocks {
            // From memory to registers and back as a whole: the compiler takes numbers side by side only so.
            let mut own = *seen;
            let mut number = self.from as f64;
            for (i, coordinates) in self.coordinates.chunks_exact(width).enumerate() {
                let values = self.rows.block_of(*b, coordinates, &self.placed[i * axles..][..axles]);
                own.take(Responding::from(values), Responding::splat(number));
                number += 1.0;
            }
            *seen = own;
        }
    }
}
