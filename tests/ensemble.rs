//! Samples in lanes against crossings one by one.

mod problems;

use std::sync::Arc;

use problems::ensemble::{headline, outcomes, samples};
use problems::*;
use spanwise::ensemble::Sample;
use spanwise::ensemble::simd::Isa;
use spanwise::road::Road;
use spanwise::settings::Settings;

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
    let samples = samples(4000);
    for (isa, threads) in [(Isa::best(), 1), (Isa::best(), 2), (Isa::Scalar, 1)] {
        let start = std::time::Instant::now();
        outcomes(&plan, &samples, isa, threads);
        println!("{isa:?} {threads}: {:.0}/s", samples.len() as f64 / start.elapsed().as_secs_f64());
    }
}
