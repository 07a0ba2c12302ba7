//! The bridge at rest: shapes under unit actions, influence lines, settlement of supports.
//!
//! Shapes are integrated and made compatible in [`flexibility`]; by reciprocity they are the lines of [`influence`]
//! of each kind of response ([`quantity`]), and under a [`settlement`] of the supports the state of the bridge.

pub(crate) mod flexibility;
pub mod influence;
pub(crate) mod quantity;
pub(crate) mod settlement;

pub use flexibility::{Action, Flexibility, Restraint, Structure};
pub use influence::Responses;
pub use quantity::{At, Quantity, Unit};
pub use settlement::Settled;
