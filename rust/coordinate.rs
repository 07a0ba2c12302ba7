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
