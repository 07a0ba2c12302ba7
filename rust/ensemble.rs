//! Many crossings of one bridge: samples side by side in the lanes of one step, block after block on all cores.
//!
//! A [`study`] is of crossings by kinds of event, and its [`sample`]s vary them, as far as [`checks`] let them. With
//! prescribed motion in equal steps of space, where the axles are and what their loads do to the bridge is the same for
//! every sample, whatever its speed, its road or its springs: one [`table`] of a [`path`] serves all, and they march
//! [`side_by_side`], [`tabulated`] their axles by it, in [`group`]s of lanes; constant loads are there as one, their
//! [`resultant`]. Samples whose motion is their own, and those of kinds with few of them, go their [`own_ways`]: their axles
//! [`apart`], they march [`abreast`] all the same. What rolls freely crosses by itself ([`single`]). All cross with
//! their own vehicles and bridge where these are [`varied`]. Steps are searched for the extremes of the responses by their
//! [`bounds`], and what is found becomes the [`results`] of a [`run`] by its [`workers`]. Of the tables, which go on
//! a [`shelf`] as far as there is [`room`], the [`clock`] stays.
//!
//! A sample's result is a function of the study, the seed and its own number, to the bit: not of the number of threads, of
//! the width of the vectors, or of its neighbours.

pub(crate) mod abreast;
pub(crate) mod apart;
pub(crate) mod bounds;
pub(crate) mod checks;
pub(crate) mod clock;
pub(crate) mod group;
pub(crate) mod own_ways;
pub(crate) mod path;
pub(crate) mod resultant;
pub(crate) mod results;
pub(crate) mod room;
pub(crate) mod run;
pub(crate) mod sample;
pub(crate) mod shelf;
pub(crate) mod side_by_side;
pub(crate) mod single;
pub(crate) mod study;
pub(crate) mod table;
pub(crate) mod tabulated;
pub(crate) mod varied;
pub(crate) mod workers;

pub use group::Drawing;
pub use results::{Column, Failure, Record, Results, decoded};
pub use sample::{Factors, Parameter, Samples};
pub use side_by_side::Task;
pub use table::Layout;
pub use tabulated::Shared;

pub use run::Run;
pub use study::{Kind, March, Plan, Study};
pub use workers::{BLOCK, Progress, Workers};
