//! Dynamic response of beam bridges to vehicles: a few modes in time, then quasi-static recovery by force summation,
//! which makes those few modes enough (H. Kishan and R. W. Traill-Nash, IABSE Publications 33, 1973, cited as KTN73).
//!
//! The modules follow the data. A [`bridge`] on its supports has deflected shapes under unit actions and, by
//! reciprocity, influence lines ([`statics`]); its flexibility gives its [`modes`] and their [`damping`]. What is
//! worked out for a described bridge can be [`imported`] instead. Either way it becomes a [`modal_bridge`], in whose
//! few coordinates A it moves:
//!
//! Ä + DȦ + Ω²A = ΦᵀP (KTN73 Eq. 3, solved in `step/bridge_step.rs`, together with the vehicles in `step/stepper.rs`).
//!
//! A [`vehicle`], one of the [catalogue](vehicle::catalogue) or another, presses in its own coordinates on it through its
//! contacts with the axle loads P, by the contact law of tyre, suspension, friction and lift-off ([`step::Contact`], in `step/contact.rs`), on a [`road`]. One [`step`] moves them all together, in
//! [`lane`]s: of one crossing or of several samples side by side. Where the contacts are is a matter of [`geometry`],
//! and so of how the vehicle makes its [`passage`]. From A and P follow all responses by [`force_summation`], with
//! inertia and damping forces from Ã = A − Ā ([Eq. 11](force_summation::Sequence::inertia_forces)), or the same in one
//! row each ([`recovery`]), R = ρ·A + Σ g(x) P.
//!
//! Responses that are looked at ([`selection`]) are searched for their [`extremes`] at every step and at the [`stops`]
//! between steps, when an axle stands on a section or an end. Many samples keep their steps on a [`tape`] for that, which a
//! [`survey`] looks through, a single crossing in its history. [`statistics`] tell of axle loads, wheels off the road and accelerations of the bodies.
//! A [`crossing`] goes through time step by step, its tail included, and an [`ensemble`] is many of them, each the same to
//! the bit as alone.
//!
//! # A crossing, and many
//!
//! ```
//! use std::sync::Arc;
//!
//! use spanwise::bridge::{Layout, Stations};
//! use spanwise::crossing::Preparation;
//! use spanwise::damping::Damping;
//! use spanwise::ensemble::{Column, Plan, Progress, Samples, Workers};
//! use spanwise::modes::Modes;
//! use spanwise::passage::{Passage, Settings};
//! use spanwise::road::{Patch, Spectrum, Synthesis};
//! use spanwise::statics::{Flexibility, Quantity};
//! use spanwise::stop_token::StopToken;
//! use spanwise::vehicle::{Axle, Vehicle};
//!
//! // 20 m, EI = 6 GN m², 8 t/m, its mass in eight places; and a lorry of 20 t.
//! let bridge = Layout::of_spans(&[20.0], 6e9, 8e3)?.stations(Stations::PerSpan(vec![8])).build()?;
//! let axle = |position: f64| Axle::new(position, 3.5e6, 1.5e6);
//! let lorry = Vehicle::new(20e3, 80e3, 1.2, vec![axle(2.0), axle(-2.0)])?;
//!
//! // What does not depend on the vehicle, in three modes, seen at midspan.
//! let stop = StopToken::NEVER;
//! let modes = Modes::new(&bridge, &Flexibility::new(&bridge, &[])?, 3)?;
//! let damped = Preparation::default().damping(Damping::Ratios(vec![0.02]));
//! let analysis = damped.sections(&[10.0]).of(&bridge, modes, stop)?;
//!
//! // On a smooth road. At rest the moment is largest with one axle at midspan and the other 4 m away: 5 P + 3 P.
//! let crossed = analysis.cross(&lorry, &Settings::at_speed(20.0), stop)?;
//! let moments = analysis.envelope_of(&crossed, Quantity::Moment, stop)?;
//! let [dynamic, at_rest] = [&moments.dynamic, &moments.at_rest].map(|extremes| extremes.max[0].value);
//! assert!((at_rest / (8.0 * 10e3 * 9.80665) - 1.0).abs() < 1e-9);
//! assert!((1.0..1.1).contains(&(dynamic / at_rest)));
//!
//! // On a hundred roads of class B.
//! let roads = Synthesis::new(Spectrum::new(64e-6, 2.0, [0.01, 4.0])?, Patch::new(0.24)?, Some(128.0))?;
//! let settings = Settings { approach: 50.0, ramp: 20.0, ..Settings::at_speed(20.0) };
//! let plan = Plan::new(Arc::new(analysis), vec![vec![Passage::of(lorry)]], settings).roads(Arc::new(roads), 1);
//! let study = plan.quantities(&[Quantity::Moment]).study()?;
//! let run = study.run(&Samples::at_speed(0, 100, 20.0), &Workers::new(None)?, &Progress::default())?;
//! let largest = run.results.format.range(Column::Responses).start;
//! let each = run.results.numbers.chunks(run.results.format.width()).map(|sample| sample[largest] / at_rest);
//! assert!(each.clone().all(|factor| (0.8..2.0).contains(&factor)));
//! assert!(each.fold(0.0, f64::max) > dynamic / at_rest);
//! # Ok::<(), spanwise::error::Error>(())
//! ```
//!
//! # Who does the algebra
//!
//! faer where matrices grow with the bridge (flexibility, redundant reactions, modes) or with a large vehicle; nalgebra for
//! the small matrices of a vehicle (`vehicle::dense`). The step does its own: it runs in lanes whose bits must depend
//! neither on their neighbours nor on the processor, on sizes of two to five that a library would only hide from the
//! compiler. Where types of theirs appear in these pages they are [`faer`] and [`nalgebra`] as re-exported here.

pub use faer;
pub use nalgebra;

pub mod error;
pub mod float_mode;
pub mod memory;
pub mod spline;
pub mod stop_token;
pub mod threads;

pub mod bridge;
pub mod statics;

pub mod damping;
pub mod modes;

pub mod imported;

pub mod vehicle;

pub mod road;

pub mod modal_bridge;

pub mod coordinate;
pub mod lane;

pub mod geometry;
pub mod step;

pub mod passage;

pub mod force_summation;
pub mod recovery;

pub mod tape;

pub mod selection;

pub mod stops;

pub mod extremes;

pub mod survey;

pub mod statistics;

pub mod crossing;

pub mod ensemble;

#[cfg(feature = "python")]
mod python;
