//! Dynamic response of beam bridges to vehicles: a few modes in time, then quasi-static recovery by force summation.
//!
//! The files follow the data: a [`bridge`] becomes cubic [`mod@line`]s by its [`flexibility`] and [`influence`] lines,
//! whose [`modes`] carry the motion; a [`vehicle`] on a [`road`] presses on it through [`contact`] forces in every
//! [`step`], along its [`path`], for a whole [`crossing`], whose [`history`] is kept; [`recovery`] turns modal states into
//! responses, and the [`survey`] of a history into the [`envelope`] of their extremes.

pub mod error;

pub mod along;
pub mod bridge;
pub mod line;

pub mod flexibility;
pub mod influence;
pub mod modes;
pub mod settlement;

pub mod assembly;
pub mod vehicle;

pub mod road;

pub mod lane;

pub mod friction;

pub mod contact;

pub mod modal;
pub mod newmark;
pub mod rig;
pub mod step;

pub mod motion;
pub mod path;

pub mod course;
pub mod crossing;
pub mod history;

pub mod recovery;
pub mod sequence;

pub mod envelope;
pub mod survey;

pub mod given;
pub mod interpolation;

pub mod analysis;

#[cfg(feature = "python")]
mod python;
