//! Results do not depend on how the caller's thread rounds, or whether it flushes denormal numbers.
#![cfg(target_arch = "x86_64")]
// The control register is out of the reach of safe code.
#![allow(unsafe_code)]

use crate::problems::continuous;
use crate::problems::ensemble::study_of;
use spanwise::stop_token::StopToken;
use std::arch::asm;
use std::hint::black_box;
use std::sync::Arc;

use crate::problems::ensemble::*;
use crate::problems::{FOOT, PINNED, kishan_vehicle};
use spanwise::bridge::Stations;
use spanwise::crossing::Analysis;
use spanwise::damping::Damping;
use spanwise::ensemble::Study;
use spanwise::float_mode::Standard;
use spanwise::lane::Isa;
use spanwise::passage::{Passage, Settings, Tail};
use spanwise::recovery::Recovery;
use spanwise::road::Road;
use spanwise::statics::Quantity;
use spanwise::vehicle::{Body, Vehicle};

/// As a thread starts.
const STANDARD: u32 = 0x1F80;
/// Denormal results become zero, and denormal operands count as zero.
const FLUSHING: u32 = STANDARD | 0x8040;
/// Rounding down, up and towards zero, with flushing.
const MODES: [u32; 4] = [FLUSHING, FLUSHING | 0x2000, FLUSHING | 0x4000, STANDARD | 0x6000];

/// Flags that say what has happened since they were cleared; nothing depends on them.
const HAPPENED: u32 = 0x3F;

fn mode() -> u32 {
    let mut mode = 0u32;
    // SAFETY: stores the 32 bits of MXCSR where the pointer points.
    unsafe { asm!("stmxcsr [{}]", in(reg) &mut mode, options(nostack, preserves_flags)) };
    mode
}

fn set_mode(mode: u32) {
    // SAFETY: every exception stays masked; what is computed in another mode is kept from the compiler by the caller.
    unsafe { asm!("ldmxcsr [{}]", in(reg) &mode, options(nostack, preserves_flags, readonly)) };
}

/// Does something in another mode, and says in which mode it left the thread.
fn in_mode<T>(other: u32, work: impl FnOnce() -> T) -> (T, u32) {
    set_mode(other);
    let result = black_box(work());
    let left = mode();
    set_mode(STANDARD);
    (result, left & !HAPPENED)
}

/// What the modes make of a denormal result, a denormal operand and a quotient that must be rounded.
fn arithmetic() -> [f64; 4] {
    let [small, one] = [black_box(f64::MIN_POSITIVE), black_box(1.0)];
    let denormal = black_box(5e-324);
    // The nearest number is below a third, and above a tenth.
    let [third, tenth] = [black_box(3.0), black_box(10.0)];
    [black_box(small * 0.25), black_box(denormal * 1e300), black_box(one / third), black_box(one / tenth)]
}

#[test]
fn the_standard_mode_is_set_and_taken_back() {
    let expected = [f64::MIN_POSITIVE * 0.25, 5e-324 * 1e300, 1.0 / 3.0, 0.1];
    assert_eq!(arithmetic(), expected);
    for other in MODES {
        // The modes are such that it matters.
        let (found, _) = in_mode(other, arithmetic);
        assert_ne!(found.map(f64::to_bits), expected.map(f64::to_bits), "{other:#x}");
        let ((inside, after), left) = in_mode(other, || {
            let guard = Standard::set();
            let inside = arithmetic();
            drop(guard);
            (inside, arithmetic())
        });
        assert_eq!(inside, expected, "{other:#x}");
        assert_eq!(after.map(f64::to_bits), found.map(f64::to_bits), "{other:#x}");
        assert_eq!(left, other);
    }
}

/// What a study is made of, in numbers.
struct Given {
    spans: Vec<f64>,
    sections: Vec<f64>,
    body: Body,
}

/// The headline case, its numbers worked out in the standard mode.
fn given() -> Given {
    let vehicle = kishan_vehicle();
    let length = 120.0 * FOOT;
    let sections = (0..9).map(|i| length * f64::from(i) / 8.0).collect();
    Given { spans: vec![60.0 * FOOT; 2], sections, body: vehicle.bodies()[0].clone() }
}

impl Given {
    fn analysis(&self) -> Arc<Analysis> {
        let [rigidity, mass] = [8.6e9, 6037.0];
        let stations = Stations::PerSpan(vec![3]);
        let bridge = continuous(&self.spans, [PINNED; 2], &[rigidity], &[mass], &stations, &[]).unwrap();
        analysis_of(&bridge, 3, &Damping::Ratios(vec![0.01]), &self.sections, Recovery::ForceSummation)
    }

    fn vehicle(&self) -> Vehicle {
        Vehicle::of_bodies(vec![self.body.clone()]).unwrap()
    }

    fn study(&self) -> Study {
        let kinds = vec![vec![Passage::of(self.vehicle())]];
        let settings = Settings { tail: Tail::Fixed(0.2), ..approach() };
        study_of(self.analysis(), kinds, settings, Some((synthesis(), SEED)), Some(0.05), &ALL).unwrap()
    }
}

/// Bridge, vehicle, roads and study made, and the samples run, by a thread in another mode.
#[test]
fn ensembles_do_not_depend_on_the_mode_of_the_caller() {
    let (given, samples) = (given(), samples(20));
    let made = |isa: Isa, threads: usize| {
        let study = given.study();
        let found = run(&study, &samples, isa, threads);
        (found.results.hash(), found.at_rest)
    };
    let expected = made(Isa::Baseline, 1);
    for other in MODES {
        for isa in Isa::present() {
            for threads in [1, 2] {
                let (found, left) = in_mode(other, || made(isa, threads));
                assert!(found == expected, "{isa:?}, {threads} threads, {other:#x}");
                assert_eq!(left, other);
            }
        }
    }
}

/// Nothing but the run in the other mode, in which geometry, factors and speeds are worked out.
#[test]
fn runs_do_not_depend_on_the_mode_of_the_caller() {
    let (study, samples) = (mixed(), mixed_samples(0, 12));
    let expected = run(&study, &samples, Isa::Baseline, 1);
    for other in MODES {
        let (found, left) = in_mode(other, || run(&study, &samples, Isa::Baseline, 2));
        assert_eq!(found.results.hash(), expected.results.hash(), "{other:#x}");
        assert_eq!(found.clock, expected.clock);
        assert_eq!(found.marches, expected.marches);
        assert_eq!(left, other);
    }
}

/// Neither does the crossing of an ensemble of vehicles that go their own ways.
#[test]
fn single_crossings_do_not_depend_on_the_mode_of_the_caller() {
    let given = given();
    let road = Arc::new(Road::from(synthesis().road(SEED, 1)));
    let settings = Settings { road, tail: Tail::Fixed(0.2), ..approach() };
    let cross = || {
        let analysis = given.analysis();
        let outcome = analysis.cross(&given.vehicle(), &settings, StopToken::NEVER).unwrap();
        let histories = analysis.histories(&outcome, Quantity::Moment, StopToken::NEVER).unwrap();
        (outcome.history, outcome.envelope, histories)
    };
    let expected = cross();
    for other in MODES {
        let (found, left) = in_mode(other, cross);
        // Not printed: they are long.
        assert!(found == expected, "{other:#x}");
        assert_eq!(left, other);
    }
}
