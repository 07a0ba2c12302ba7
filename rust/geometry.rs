//! What the step asks about the contacts: where they stand, how they move, and what lies under them.
//!
//! In a single crossing motion is [`prescribed`], or [`free`] where a vehicle rolls, on the [`pavement`] of each
//! vehicle; samples that move alike share a table ([`crate::ensemble::tabulated`]).

pub(crate) mod free;
pub(crate) mod pavement;
pub(crate) mod prescribed;

use crate::coordinate::Coordinate;
use crate::lane::Lane;

/// The road under a wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface<L> {
    /// Elevation, up, from the line that all vertical motion of the vehicle is counted from [m].
    pub elevation: L,
    /// Its first derivative along the bridge [-].
    pub slope: L,
    /// Its second derivative [1/m].
    pub curvature: L,
}

impl Surface<f64> {
    /// Level road.
    pub const LEVEL: Self = Surface { elevation: 0.0, slope: 0.0, curvature: 0.0 };
}

/// Where the contacts stand and how they move.
pub trait Geometry<L: Lane> {
    /// Moves on by one step: contacts whose motion is prescribed go to where they are then.
    fn advance(&mut self);

    /// Whether no contact gains or loses speed at the end of the next step, so that nothing pushes the vehicles along
    /// the road.
    fn steady(&self) -> bool {
        false
    }

    /// Position from the left end of the bridge, speed and acceleration along it.
    fn motion(&self, contact: usize) -> Coordinate<L>;

    /// Φ⁰: the modes' deflections under the contact [kg^-½], zero off the bridge.
    fn shapes(&self, contact: usize, shapes: &mut [L]);

    /// Slope of the mode under the contact [kg^-½/m].
    fn slope(&self, contact: usize, mode: usize) -> L;

    /// Second derivative of the mode under the contact [kg^-½/m²].
    fn curvature(&self, contact: usize, mode: usize) -> L;

    /// The road under the contact.
    fn surface(&self, contact: usize) -> Surface<L>;

    /// The [`Stepper::interaction`](crate::step::stepper::Stepper::interaction) of this place, where it is known, the same in
    /// all lanes: first what is of modes, mode by mode as [`of_mode`](crate::step::gait::of_mode) has it.
    fn interaction(&self) -> Option<&[f64]> {
        None
    }
}

/// Contacts that can follow their vehicles.
pub trait Follow: Geometry<f64> {
    /// Puts a contact where its vehicle has it, in a new step or in another pass of the same; `motion` counts from the end
    /// of the bridge at which the vehicle enters, in its own direction. Says whether it had still to move; if not, nothing
    /// changes, to the bit.
    fn follow(&mut self, contact: usize, motion: Coordinate<f64>, new_step: bool) -> bool;

    /// Holds a contact where it is, its vehicle having come to rest.
    fn hold(&mut self, contact: usize);
}
