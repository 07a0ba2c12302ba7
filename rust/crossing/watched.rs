//! Largest and smallest so far: of one value in samples side by side, or of responses side by side.

use crate::lane::Lane;

/// Largest and smallest so far, and when: the number of an instant, of a step or of a stop.
///
/// Looked at in every step, so without a branch: the number is an `f64` and chosen along with the value.
#[derive(Debug, Clone, Copy)]
pub struct Watched<L> {
    /// Largest.
    pub max: L,
    /// When.
    pub max_at: L,
    /// Smallest.
    pub min: L,
    /// When.
    pub min_at: L,
}

impl<L: Lane> Watched<L> {
    /// Nothing seen yet.
    #[inline(always)]
    pub fn nothing() -> Self {
        let (low, high, zero) = (L::splat(f64::NEG_INFINITY), L::splat(f64::INFINITY), L::splat(0.0));
        Watched { max: low, max_at: zero, min: high, min_at: zero }
    }

    /// At rest at step zero.
    #[inline(always)]
    pub fn rest() -> Self {
        let zero = L::splat(0.0);
        Watched { max: zero, max_at: zero, min: zero, min_at: zero }
    }

    /// That of one lane.
    pub fn one(&self, lane: usize) -> Watched<f64> {
        let [max, max_at, min, min_at] = [self.max, self.max_at, self.min, self.min_at].map(|of| of.get(lane));
        Watched { max, max_at, min, min_at }
    }

    /// From one for each lane; the last is that of all that follow too.
    pub fn beside(each: &[Watched<f64>]) -> Self {
        let of = |part: fn(&Watched<f64>) -> f64| L::from_fn(|lane| part(&each[lane.min(each.len() - 1)]));
        Watched { max: of(|w| w.max), max_at: of(|w| w.max_at), min: of(|w| w.min), min_at: of(|w| w.min_at) }
    }

    /// This, but for the lanes of a mask, which are as they were.
    #[inline(always)]
    pub fn unless(self, mask: L::Mask, before: Self) -> Self {
        Watched {
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

    /// Whether values within these bounds, the upper and the lower, can be new extremes in any lane, where it is known
    /// what the extremes will reach in the end.
    #[inline(always)]
    pub fn may_grow(&self, [high, low]: [L; 2], [most, least]: [L; 2]) -> bool {
        let above = !(!self.max.less(high) | high.less(most));
        let below = !(!low.less(self.min) | least.less(low));
        L::any(above | below)
    }
}
