//! A coordinate that moves: its value, velocity and acceleration.

use crate::lane::Lane;
use crate::lane::gather::gather;

/// A coordinate with its first and second time derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinate<L> {
    /// Value.
    pub x: L,
    /// Velocity.
    pub v: L,
    /// Acceleration.
    pub a: L,
}

gather!(Coordinate { x, v, a });

impl<L: Lane> Coordinate<L> {
    /// At rest at zero.
    #[inline(always)]
    pub fn rest() -> Self {
        let zero = L::splat(0.0);
        Coordinate { x: zero, v: zero, a: zero }
    }
}

/// Coordinates at the end of a step, or in lanes of a mask this fraction of the way through it.
#[inline(always)]
pub fn shortened<L: Lane>(
    short: L::Mask,
    fraction: L,
    before: &[Coordinate<L>],
    after: &[Coordinate<L>],
) -> Vec<Coordinate<L>> {
    let mut own = after.to_vec();
    for (own, before) in own.iter_mut().zip(before) {
        own.x = L::select(short, before.x + fraction * (own.x - before.x), own.x);
        own.v = L::select(short, before.v + fraction * (own.v - before.v), own.v);
        own.a = L::select(short, before.a + fraction * (own.a - before.a), own.a);
    }
    own
}
