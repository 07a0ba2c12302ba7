//! Constant loads that all samples share, as one: what they do together to the bridge at every step and stop.
//!
//! Their sums are those that the step, the rows and the stops would make of each load, in the same order, to the bit.

use std::ops::Range;

use super::path::Advance;
use crate::error::Error;
use crate::recovery::{Block, Place, Placed, Rows, WIDTH};
use crate::selection::Selection;
use crate::step::driving::{Drive, ModalForces};
use crate::stop_token::StopToken;
use crate::stops::{PassingInfluence, Positions, Stop};

/// The sum of the loads.
#[derive(Debug, Clone)]
pub struct Resultant {
    /// Each of them [N].
    loads: Vec<f64>,
    /// What they do to the modes, by step.
    pub driving: Vec<ModalForces<f64>>,
}

impl Resultant {
    /// Of these loads [N] on their path.
    pub fn new(loads: Vec<f64>, path: &Advance, drive: &Drive, stop: StopToken<'_>) -> Result<Self, Error> {
        let of_step = |step: usize| {
            let mut driving = ModalForces::nothing();
            drive.at(step, |step, axle| path.x(step, axle), &loads, &mut driving);
            stop.check().map(|()| driving)
        };
        let driving = (0..=path.steps + path.beyond).map(of_step).collect::<Result<_, _>>()?;
        Ok(Resultant { driving, loads })
    }

    /// A stop of one of the loads as one of all.
    pub fn stop(&self, stop: Stop) -> Stop {
        let tip = stop.tip.map(|(row, sign)| (row, sign * self.loads[stop.axle]));
        Stop { axle: 0, tip, ..stop }
    }

    /// What all do to the bridge at a stop, from what a load of one at each does, which makes so many coordinates.
    pub fn passing(&self, each: &PassingInfluence, width: usize) -> PassingInfluence {
        each.under(&self.loads, width)
    }

    /// Adds what all make of the static coordinates where they are.
    pub fn extend_static(&self, places: &[Place], rows: &Rows, statics: &mut Vec<f64>) {
        statics.extend(rows.static_coordinates(places, &self.loads));
    }

    /// What all do to each row at some steps of their path, by row and step.
    pub fn influence(&self, path: &Advance, steps: Range<usize>, rows: &Rows, look: &Selection, out: &mut Vec<f64>) {
        out.clear();
        out.resize(look.rows.len() * steps.len(), 0.0);
        pulp::Arch::new().dispatch(Summing { loads: &self.loads, path, steps, rows, look, out });
    }
}

/// The influence on each row being summed up, in blocks of responses.
struct Summing<'s> {
    loads: &'s [f64],
    path: &'s Advance,
    steps: Range<usize>,
    rows: &'s Rows,
    look: &'s Selection,
    out: &'s mut [f64],
}

impl pulp::WithSimd for Summing<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) {
        let Summing { loads, path, steps, rows, look, out } = self;
        let count = steps.len();
        let (mut placed, mut blocks): (Vec<Placed<1>>, Vec<Block>) = (Vec::new(), Vec::new());
        for (i, step) in steps.enumerate() {
            placed.clear();
            // Those off the bridge add nothing.
            placed.extend(loads.iter().enumerate().filter_map(|(axle, &load)| {
                let place = rows.place(path.x(step, axle));
                place.map(|_| Placed::new(place, [load]))
            }));
            blocks.clear();
            blocks.extend((0..rows.blocks()).map(|b| rows.of_block(b).at(&[], &placed)[0]));
            for (r, row) in look.rows.iter().enumerate() {
                out[r * count + i] = blocks[row.response / WIDTH][row.response % WIDTH];
            }
        }
    }
}
