//! Dynamic response of beam bridges to vehicles: a few modes in time, then quasi-static recovery by force summation.
//!
//! The files follow the data. A [`bridge`] with what varies [`along`] it becomes cubic [`mod@line`]s by its
//! [`flexibility`] and [`influence`] lines, whose [`modes`] carry the motion; or all that is [`given`] from outside. A
//! [`vehicle`] is put into the coordinates of an [`assembly`]; on a [`road`] it presses on the bridge through its
//! [`contact`]s, with [`friction`] in its suspensions. One [`step`] moves the bridge ([`modal`]) and every vehicle
//! ([`rig`]) together. Each vehicle has its [`course`], prescribed as a [`motion`] or not, and its [`path`] over the
//! modes; a [`crossing`] is [`march`]ed through in [`steps`], its [`tail`] included, and its [`history`] kept. [`recovery`] turns modal states
//! into responses, and the [`survey`] of a history into the [`envelope`] of their extremes; [`analysis`] joins it all up.

pub mod error;
pub mod memory;

pub mod along;
pub mod bridge;
pub mod line;

pub mod flexibility;
pub mod influence;
pub mod modes;
pub mod settlement;

pub mod given;
pub mod interpolation;

pub mod assembly;
pub mod dense;
pub mod vehicle;

pub mod road;

pub mod float_mode;
pub mod lane;
pub mod threads;

pub mod contact;
pub mod friction;

pub mod modal;
pub mod newmark;
pub mod rig;
pub mod stand;
pub mod step;

pub mod motion;
pub mod path;

pub mod course;
pub mod damping;
pub mod settings;

pub mod crossing;
pub mod history;
pub mod march;
pub mod steps;
pub mod tail;

pub mod recovery;
pub mod sequence;

pub mod envelope;
pub mod survey;

pub mod analysis;

pub mod ensemble;

#[cfg(feature = "python")]
mod python;
