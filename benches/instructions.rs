//! One case for as many crossings as asked for, and nothing else: what the instruction gate counts.
//!
//! `instructions CASE BLOCKS` runs blocks of the headline case on the instruction set CASE, or BLOCKS times with `crossing`
//! the 1973 example alone, with `kinds` a kind of event of one sample, with `loop` the same trucks one by one. It prints
//! the number of crossings; without arguments it says so and does nothing.

#[path = "../tests/problems/mod.rs"]
mod problems;

use spanwise::stop_token::StopToken;
use std::hint::black_box;
use std::process::ExitCode;

use problems::ensemble::{ALL, SEED, headline, isas, kishan_analysis, run, samples, study_of, synthesis};
use problems::vehicles::half_car;
use problems::{kishan_settings, kishan_vehicle};
use spanwise::ensemble::{Samples, Study};
use spanwise::lane::Isa;
use spanwise::passage::{Passage, Settings};
use spanwise::recovery::Recovery;
use spanwise::road::Road;
use spanwise::vehicle::Friction;

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
            black_box(study.analysis.cross(&vehicle, &kishan_settings(), StopToken::NEVER).unwrap());
        }
        println!("{count}");
        return ExitCode::SUCCESS;
    }
    if case == "kinds" || case == "loop" {
        let study = kinds(count);
        if case == "kinds" {
            let samples = Samples { kinds: (0..count as u32).collect(), ..Samples::at_speed(0, count, 20.0) };
            black_box(run(&study, &samples, Isa::chosen().unwrap(), 1));
        } else {
            let settings = Settings { step: Some(WAY / 20.0), ..study.settings.clone() };
            for kind in &study.kinds {
                black_box(study.analysis.cross_all(&kind.passages, &settings, StopToken::NEVER).unwrap());
            }
        }
        println!("{count}");
        return ExitCode::SUCCESS;
    }
    let Some((_, isa)) = isas().into_iter().find(|(name, _)| name == case) else {
        return ExitCode::from(ABSENT);
    };
    let samples = samples(count * isa.samples());
    black_box(run(&study, &samples, isa, 1));
    println!("{}", samples.count);
    ExitCode::SUCCESS
}

/// Way per step of the trucks [m].
const WAY: f64 = 0.05;

/// So many kinds of event: a truck on the bridge of 1973, after an approach of 5 m on a road of class B.
fn kinds(count: usize) -> Study {
    let truck = half_car([500.0, 900.0], 1.0, 0.0, Friction::coulomb(0.0));
    let road = Road::from(synthesis().road(SEED, 0)).into();
    let settings = Settings { approach: 5.0, road, ..Settings::at_speed(20.0) };
    let kinds = vec![vec![Passage::of(truck)]; count];
    study_of(kishan_analysis(25, Recovery::ForceSummation), kinds, settings, None, Some(WAY), &ALL).unwrap()
}
