//! One case for as many crossings as asked for, and nothing else: what the instruction gate counts.
//!
//! `instructions CASE BLOCKS` runs blocks of the headline case on the instruction set CASE, or with `crossing` the 1973
//! example alone BLOCKS times, and prints the number of crossings; without arguments it says so and does nothing.

#[path = "../tests/problems/mod.rs"]
mod problems;

use std::hint::black_box;
use std::process::ExitCode;

use problems::ensemble::{headline, isas, run, samples};
use problems::{kishan_settings, kishan_vehicle};
use spanwise::ensemble::BLOCK;

/// What the gate takes for: this processor cannot.
const ABSENT: u8 = 3;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let [case, count] = arguments.as_slice() else {
        println!("counted by `make instructions`: instructions CASE BLOCKS");
        return ExitCode::SUCCESS;
    };
    let count: usize = count.parse().expect("BLOCKS is a number");
    let study = headline();
    if case == "crossing" {
        let vehicle = kishan_vehicle();
        for _ in 0..count {
            black_box(study.analysis.cross(&vehicle, &kishan_settings(), &mut || true).unwrap());
        }
        println!("{count}");
        return ExitCode::SUCCESS;
    }
    let Some((_, isa)) = isas().into_iter().find(|(name, _)| name == case) else {
        return ExitCode::from(ABSENT);
    };
    let samples = samples(count * BLOCK);
    black_box(run(&study, &samples, isa, 1));
    println!("{}", samples.count);
    ExitCode::SUCCESS
}
