//! Samples in lanes against crossings one by one.

mod problems;

use std::sync::{Arc, Mutex};

use problems::*;
use spanwise::analysis::Analysis;
use spanwise::ensemble::simd::Isa;
use spanwise::ensemble::{Outcome, Plan, Roads, Sample};
use spanwise::flexibility::Flexibility;
use spanwise::modes::Modes;
use spanwise::recovery::Recovery;
use spanwise::road::Road;
use spanwise::road::patch::Patch;
use spanwise::road::random::Synthesis;
use spanwise::road::spectrum::Spectrum;
use spanwise::settings::Settings;

fn headline() -> (Arc<Analysis>, Arc<Synthesis>, Plan) {
    let bridge = kishan_bridge();
    let modes = Modes::new(&bridge, &Flexibility::new(&bridge, &[]).unwrap(), 3).unwrap();
    let analysis = Analysis::new(&bridge, modes, &undamped(), None, Recovery::ForceSummation, &mut || true).unwrap();
    let spectrum = Spectrum::new(64e-6, 2.0, [0.01, 4.0]).unwrap();
    let synthesis = Arc::new(Synthesis::new(spectrum, Patch::new(0.24).unwrap(), Some(128.0)).unwrap());
    let analysis = Arc::new(analysis);
    let settings = Settings { approach: 30.0, ramp: 10.0, ..Settings::at_speed(22.86) };
    let roads = Roads::Random { synthesis: Arc::clone(&synthesis), seed: 7 };
    let plan = Plan::new(Arc::clone(&analysis), &kishan_vehicle(), &settings, 0.02286, roads).unwrap();
    (analysis, synthesis, plan)
}

fn outcomes(plan: &Plan, samples: &[Sample], isa: Isa, threads: usize) -> Vec<Outcome> {
    let all = Mutex::new(Vec::new());
    plan.run(samples, isa, threads, |first, some| all.lock().unwrap().push((first, some)), || true).unwrap();
    let mut all = all.into_inner().unwrap();
    all.sort_by_key(|(first, _)| *first);
    all.into_iter().flat_map(|(_, some)| some).collect()
}

#[test]
fn a_sample_is_a_crossing() {
    let (analysis, synthesis, plan) = headline();
    let samples: Vec<Sample> = (0..9).map(|number| Sample { number, speed: 20.0 + number as f64 }).collect();
    let wide = outcomes(&plan, &samples, Isa::best(), 1);
    assert_eq!(format!("{wide:?}"), format!("{:?}", outcomes(&plan, &samples, Isa::Scalar, 2)));
    for (sample, outcome) in samples.iter().zip(&wide) {
        let road = Arc::new(Road::from(synthesis.road(7, sample.number)));
        let path = 30.0 + KISHAN_PATH as f64 * FOOT;
        let step = Some(path / plan.steps() as f64 / sample.speed * (1.0 + 1e-12));
        let settings = Settings { approach: 30.0, ramp: 10.0, road, step, ..Settings::at_speed(sample.speed) };
        let alone = analysis.cross(&kishan_vehicle(), &settings, &mut || true).unwrap();
        assert_eq!(alone.history.len(), plan.steps() + 1);
        let mut apart = 0.0_f64;
        for (r, found) in outcome.responses.iter().enumerate() {
            let (max, min) = (alone.envelope.dynamic.max[r], alone.envelope.dynamic.min[r]);
            let scale = max.value.abs().max(min.value.abs()).max(1e-12);
            apart =
                apart.max((found.max.value - max.value).abs() / scale).max((found.min.value - min.value).abs() / scale);
        }
        println!("{}: {apart:e}", sample.number);
        assert!(apart < 1e-8, "{}: {apart:e}", sample.number);
    }
}

#[test]
fn speed() {
    let (_, _, plan) = headline();
    let samples: Vec<Sample> = (0..4000).map(|number| Sample { number, speed: 22.86 }).collect();
    for (isa, threads) in [(Isa::best(), 1), (Isa::best(), 2), (Isa::Scalar, 1)] {
        let start = std::time::Instant::now();
        outcomes(&plan, &samples, isa, threads);
        println!("{isa:?} {threads}: {:.0}/s", samples.len() as f64 / start.elapsed().as_secs_f64());
    }
}
