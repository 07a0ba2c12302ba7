//! Many crossings of one bridge: samples side by side in the lanes of one step, block after block on all cores.
//!
//! A [`study`] is of crossings by kinds of event, and its [`sample`]s vary them. With prescribed motion in equal steps of
//! space, where the axles are and what their loads do to the bridge is the same for every sample, whatever its speed, its
//! road or its springs: one [`table`] serves all, and they march [`side_by_side`], [`tabulated`] their axles by it, in
//! [`block`]s of lanes. Samples whose motion is their own take the same step one by one ([`single`]). Either way they cross with their own
//! vehicles and bridge where these are [`varied`]. Their steps are
//! searched for the extremes of the responses by their [`bounds`], and what is found becomes the [`results`] of a [`run`]
//! by its [`workers`]. Of the tables, which go on a [`shelf`]
//! as far as there is [`room`], the [`clock`] stays.
//!
//! A sample's result is a function of the study, the seed and its own number, to the bit: not of the number of threads, of
//! the width of the vectors, or of its neighbours.

pub mod block;
pub mod bounds;
pub mod clock;
pub mod results;
pub mod room;
pub mod run;
pub mod sample;
pub mod shelf;
pub mod side_by_side;
pub mod single;
pub mod study;
pub mod table;
pub mod tabulated;
pub mod varied;
pub mod workers;

pub use run::Run;
pub use study::{Kind, March, Plan, Study};
pub use workers::{BLOCK, Progress, Workers};
