//! Newmark's method with γ = ½ for one coordinate at a time.

use crate::coordinate::Coordinate;
use crate::lane::Lane;
use crate::lane::gather::gather;

/// The coefficients for steps of one length.
#[derive(Debug, Clone, Copy)]
pub struct Newmark<L> {
    /// h [s].
    pub h: L,
    /// h/2.
    pub half_h: L,
    /// h² (½ − β).
    pub old: L,
    /// h² β.
    pub new: L,
}

gather!(Newmark { h, half_h, old, new });

impl<L: Lane> Newmark<L> {
    /// For steps of `h` [s] with Newmark's `beta`.
    pub fn new(h: f64, beta: f64) -> Self {
        Newmark {
            h: L::splat(h),
            half_h: L::splat(0.5 * h),
            old: L::splat(h * h * (0.5 - beta)),
            new: L::splat(h * h * beta),
        }
    }

    /// The coordinate at the end of the step if its acceleration there were zero; `a` is left as it was.
    #[inline(always)]
    pub fn predict(&self, c: Coordinate<L>) -> Coordinate<L> {
        Coordinate { x: c.x + self.h * c.v + self.old * c.a, v: c.v + self.half_h * c.a, a: c.a }
    }

    /// The coordinate at the end of the step, with acceleration `a` there.
    #[inline(always)]
    pub fn correct(&self, predicted: Coordinate<L>, a: L) -> Coordinate<L> {
        Coordinate { x: predicted.x + self.new * a, v: predicted.v + self.half_h * a, a }
    }
}
