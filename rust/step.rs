//! One time step of bridge and vehicles together.
//!
//! [`newmark`]'s method for the modes of the bridge ([`bridge_step`], KTN73 Eq. 3) and for every vehicle
//! ([`vehicle_step`], one [`unit`] of the step each). They meet in the [`contact`] forces and in [`friction`], the
//! unknowns of δ = u − S p: S is the [`compliance`], u the gap without their increments, and the [`coupled_forces`] are
//! solved for together by the [`stepper`]. It begins with vehicles that [`stand`] where the crossing [`start`]s; those
//! in [`rolling`] go where the step takes them. Where a step's [`sizes`] are known, the compiler is told; the usual
//! vehicles, told by their [`gait`], have steps of their own ([`swift`]). Once all have left there is free [`vibration`].
//!
//! Constant loads at constant speed need none of this: what is [`driving`] the modes is known beforehand, and each mode, an
//! [`oscillator`], follows exactly where it is [`forced`].

pub(crate) mod bridge_step;
pub(crate) mod compliance;
pub(crate) mod contact;
pub(crate) mod coupled_forces;
pub(crate) mod driving;
pub(crate) mod forced;
pub(crate) mod friction;
pub(crate) mod gait;
pub(crate) mod newmark;
pub(crate) mod oscillator;
pub(crate) mod rolling;
pub(crate) mod sizes;
pub(crate) mod stand;
pub(crate) mod start;
pub(crate) mod stepper;
pub(crate) mod swift;
pub(crate) mod unit;
pub(crate) mod vehicle_step;
pub(crate) mod vibration;

pub use bridge_step::ModalSolve;
pub use contact::{Contact, HELD, Prepared};
pub use coupled_forces::Elements;
pub use driving::{Drive, ModalForces};
pub use forced::Forced;
pub use friction::{Law, Stroke};
pub use gait::{Gait, Standing};
pub use newmark::Newmark;
pub use oscillator::Oscillator;
pub use stepper::{Scheme, State, Stepper};
pub use unit::{Moving, Propulsion};
pub use vibration::{LOOK_EVERY, PERIODS, Reach, Vibration};
