//! The bridge at rest: shapes under unit actions, influence lines, settlement of supports.

pub mod flexibility;
pub mod influence;
pub mod settlement;
