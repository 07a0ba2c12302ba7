//! The headline case of the ensemble engine, and the few calls by which tests and benches reach that engine.

use std::sync::{Arc, OnceLock};

use spanwise::analysis::Analysis;
use spanwise::course::Passage;
use spanwise::ensemble::record::Record;
use spanwise::ensemble::sample::Samples;
use spanwise::ensemble::simd::Isa;
use spanwise::ensemble::together::Task;
use spanwise::ensemble::{BLOCK, Progress, Run, Study, Workers};
use spanwise::flexibility::Flexibility;
use spanwise::influence::Quantity;
use spanwise::lane::Lane;
use spanwise::modes::Modes;
use spanwise::recovery::Recovery;
use spanwise::road::patch::Patch;
use spanwise::road::random::Synthesis;
use spanwise::road::spectrum::Spectrum;
use spanwise::settings::Settings;

use super::{kishan_bridge, kishan_vehicle, undamped};

/// Seed of the study.
pub const SEED: u64 = 7;

/// Speed [m/s], with which a step takes one millisecond.
pub const SPEED: f64 = 22.86;

/// Everything that can be looked at.
pub const ALL: [Quantity; 6] = [
    Quantity::Deflection,
    Quantity::Moment,
    Quantity::ShearLeft,
    Quantity::ShearRight,
    Quantity::Reaction,
    Quantity::ClampMoment,
];

/// Roads of class B as a contact patch of 0.24 m feels them, with a period of 128 m.
pub fn synthesis() -> Arc<Synthesis> {
    let spectrum = Spectrum::new(64e-6, 2.0, [0.01, 4.0]).unwrap();
    Arc::new(Synthesis::new(spectrum, Patch::new(0.24).unwrap(), Some(128.0)).unwrap())
}

/// The bridge of 1973 in three modes, seen at so many sections at equal distances.
pub fn kishan_analysis(sections: usize, recovery: Recovery) -> Arc<Analysis> {
    let bridge = kishan_bridge();
    let modes = Modes::new(&bridge, &Flexibility::new(&bridge, &[]).unwrap(), 3).unwrap();
    let at = |i: usize| bridge.length() * i as f64 / (sections - 1) as f64;
    let sections: Vec<f64> = (0..sections).map(at).collect();
    Arc::new(Analysis::new(&bridge, modes, &undamped(), Some(&sections), recovery, &mut || true).unwrap())
}

/// A rough approach of 30 m.
pub fn approach() -> Settings {
    Settings { approach: 30.0, ramp: 10.0, ..Settings::at_speed(SPEED) }
}

/// The vehicle of 1973 on its bridge in three modes, each sample on its own road of class B.
pub fn headline() -> Study {
    let kinds = vec![vec![Passage::of(kishan_vehicle())]];
    let analysis = kishan_analysis(25, Recovery::ForceSummation);
    Study::new(analysis, kinds, approach(), Some((synthesis(), SEED)), Some(0.022_86), &ALL).unwrap()
}

/// Samples of the headline case, all at its speed.
pub fn samples(count: usize) -> Samples {
    Samples::at_speed(0, count, SPEED)
}

/// The instruction sets of this processor, by name.
pub fn isas() -> Vec<(&'static str, Isa)> {
    Isa::present().map(|isa| (isa.name(), isa)).collect()
}

/// Crosses with all samples.
pub fn run(study: &Study, samples: &Samples, isa: Isa, threads: usize) -> Run {
    study.run(samples, &Workers { isa, threads, chunk: BLOCK }, &Progress::default()).unwrap()
}

/// One sample in a lane of any kind, on the calling thread: its numbers and instants.
pub fn one<L: Lane>(study: &Study, number: u64) -> (Vec<f64>, Vec<u32>) {
    let samples = Samples::at_speed(number, 1, SPEED);
    let (layout, table) = (study.layout(&samples), study.table((0, 0)));
    let (mut numbers, mut instants) = (vec![0.0; layout.width()], vec![0; layout.instants()]);
    let record = Record { numbers: &mut numbers, instants: &mut instants };
    let (samples, table, couplings) = (&samples, &table, &OnceLock::new());
    let task = Task { study, layout, samples, kind: 0, table, couplings, isa: Isa::Scalar };
    task.run::<L>(&[0], &mut [record], &mut Vec::new(), &|| true).unwrap();
    (numbers, instants)
}
