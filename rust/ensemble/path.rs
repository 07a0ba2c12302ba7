//! How the axles of samples that share the geometry move: in equal steps of space, and past which marks when.

use serde::{Deserialize, Serialize};

use crate::stops::{Passing, Positions, short_of};

/// How axles move in equal steps of space.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Advance {
    /// Front axle at the start [m].
    pub start: f64,
    /// Way per step [m].
    pub advance: f64,
    /// Distance of each axle behind the first [m].
    pub behind: Vec<f64>,
    /// Number of steps until the last axle has left.
    pub steps: usize,
    /// Steps beyond these in which the vehicle is followed, if there is a tail.
    pub beyond: usize,
}

impl Positions for Advance {
    fn axles(&self) -> usize {
        self.behind.len()
    }

    #[inline(always)]
    fn x(&self, step: usize, axle: usize) -> f64 {
        self.advance * step as f64 + self.start - self.behind[axle]
    }
}

/// Every passing of some marks [m], in order.
pub fn passings(path: &Advance, marks: &[f64]) -> Vec<Passing> {
    let last = path.steps;
    let mut passings = Vec::with_capacity(path.behind.len() * marks.len());
    for axle in 0..path.behind.len() {
        for (mark, &at) in marks.iter().enumerate() {
            // The first step at whose end the axle is not before the mark; where it starts it does not pass.
            let (mut step, mut end, near) = (0, last + 1, at - short_of(path, axle, at));
            while step < end {
                let middle = step + (end - step) / 2;
                if path.x(middle, axle) < near { step = middle + 1 } else { end = middle }
            }
            if step == 0 || step > last {
                continue;
            }
            passings.push(Passing::new(path, step, axle, (mark, at)));
        }
    }
    passings.sort_unstable_by_key(|passing| (passing.step, passing.axle, passing.mark));
    passings
}
