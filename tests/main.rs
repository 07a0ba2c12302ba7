//! Every Rust test in one program, so that what they share is compiled and linked once.

mod problems;

mod approach;
mod bridge;
mod contact;
mod crossing;
mod energy;
mod ensemble_contract;
mod ensemble_extremes;
mod ensemble_failures;
mod ensemble_fuzz;
mod ensemble_machine_code;
mod ensemble_statistics;
mod envelope;
mod flexibility;
mod float_mode;
mod free_ends;
mod friction;
mod fryba;
mod general;
mod influence;
mod kishan_1973;
mod lane;
mod lift_off;
mod limits;
mod modes;
mod moving_mass;
mod orders;
mod recovery;
mod road;
mod suspension;
mod tail;
mod traffic;
mod vehicle;
mod yang_yau;
