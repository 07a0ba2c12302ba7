//! The headline case of the ensemble engine, and the few calls by which tests and benches reach that engine.

use std::sync::{Arc, Mutex};

use spanwise::analysis::Analysis;
use spanwise::ensemble::simd::{self, Isa};
use spanwise::ensemble::{Outcome, Plan, Roads, Sample};
use spanwise::flexibility::Flexibility;
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

/// The vehicle of 1973 on its bridge in three modes, each sample on its own road of class B.
pub fn headline() -> (Arc<Analysis>, Arc<Synthesis>, Plan) {
    let bridge = kishan_bridge();
    let modes = Modes::new(&bridge, &Flexibility::new(&bridge, &[]).unwrap(), 3).unwrap();
    let analysis = Analysis::new(&bridge, modes, &undamped(), None, Recovery::ForceSummation, &mut || true).unwrap();
    let spectrum = Spectrum::new(64e-6, 2.0, [0.01, 4.0]).unwrap();
    let synthesis = Arc::new(Synthesis::new(spectrum, Patch::new(0.24).unwrap(), Some(128.0)).unwrap());
    let analysis = Arc::new(analysis);
    let settings = Settings { approach: 30.0, ramp: 10.0, ..Settings::at_speed(22.86) };
    let roads = Roads::Random { synthesis: Arc::clone(&synthesis), seed: SEED };
    let plan = Plan::new(Arc::clone(&analysis), &kishan_vehicle(), &settings, 0.02286, roads).unwrap();
    (analysis, synthesis, plan)
}

/// Samples of the headline case, all at its speed.
pub fn samples(count: u64) -> Vec<Sample> {
    (0..count).map(|number| Sample { number, speed: 22.86 }).collect()
}

/// The instruction sets of this processor, by name.
pub fn isas() -> Vec<(&'static str, Isa)> {
    let mut isas = vec![("scalar", Isa::Scalar)];
    if Isa::best() == Isa::Avx2 {
        isas.push(("avx2", Isa::Avx2));
    }
    isas
}

/// Crosses with all samples and returns what they give, in their order.
pub fn outcomes(plan: &Plan, samples: &[Sample], isa: Isa, threads: usize) -> Vec<Outcome> {
    let all = Mutex::new(Vec::new());
    plan.run(samples, isa, threads, |first, some| all.lock().unwrap().push((first, some)), || true).unwrap();
    let mut all = all.into_inner().unwrap();
    all.sort_by_key(|(first, _)| *first);
    all.into_iter().flat_map(|(_, some)| some).collect()
}

/// The same block after block on the calling thread.
pub fn blocks(plan: &Plan, samples: &[Sample], isa: Isa) -> Vec<Outcome> {
    samples.chunks(block_size(isa)).flat_map(|block| simd::run(isa, plan, block).unwrap()).collect()
}

/// Samples in one block.
pub fn block_size(isa: Isa) -> usize {
    simd::samples(isa)
}

/// One sample in a lane of any kind.
pub fn one<L: Lane>(plan: &Plan, sample: Sample) -> Outcome {
    plan.block::<L>(&[sample]).unwrap().remove(0)
}
