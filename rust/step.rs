//! One time step of bridge and vehicles together.
//!
//! [`newmark`]'s method for the modes of the bridge ([`bridge_step`], KTN73 Eq. 3) and for every vehicle
//! ([`vehicle_step`], one [`unit`] of the step each). They meet in the [`contact`] forces and in [`friction`], the
//! unknowns of δ = u − S p: S is the [`compliance`], u the gap without their increments, and the [`coupled_forces`] are
//! solved for together by the [`stepper`]. It begins with vehicles that [`stand`] where the crossing [`start`]s; those
//! in [`rolling`] go where the step takes them. Where a step's [`sizes`] are known, the compiler is told. Once all have
//! left there is free [`vibration`].

pub mod bridge_step;
pub mod compliance;
pub mod contact;
pub mod coupled_forces;
pub mod friction;
pub mod newmark;
pub mod rolling;
pub mod sizes;
pub mod stand;
pub mod start;
pub mod stepper;
pub mod unit;
pub mod vehicle_step;
pub mod vibration;
