//! Samples in lanes against crossings one by one, and the contract: the same bits however the work is done.

mod problems;

use std::sync::Arc;

use problems::ensemble::*;
use spanwise::ensemble::record::Column;
use spanwise::ensemble::sample::Samples;
use spanwise::ensemble::simd::Isa;
use spanwise::ensemble::{Progress, Run, Study, Workers};
use spanwise::road::Road;
use spanwise::settings::Settings;

fn spread(study: &Study, samples: &Samples, isa: Isa, threads: usize, chunk: usize) -> Run {
    study.run(samples, &Workers { isa, threads, chunk }, &Progress::default()).unwrap()
}

/// Every sample against its own single crossing, to the bit.
fn check_alone(study: &Study, samples: &Samples, run: &Run) {
    let layout = run.results.layout;
    for sample in 0..samples.count {
        let number = samples.first + sample as u64;
        let table = &run.tables[run.results.marches[sample] as usize];
        let speed = samples.speed(sample, 0);
        let road = match &study.own {
            Some((own, seed)) => Arc::new(Road::sum([(*study.settings.road).clone(), own.road(*seed, number).into()])),
            None => Arc::clone(&study.settings.road),
        };
        let step = Some(table.path.advance / speed);
        let settings = Settings { road, step, speed, ..study.settings.clone() };
        let passage = &study.kinds[samples.kind(sample)].passages[0];
        let alone = study.analysis.cross(&passage.vehicle, &settings, &mut || true).unwrap();
        let numbers = &run.results.numbers[sample * layout.width()..][..layout.width()];
        let instants = &run.results.instants[sample * layout.instants()..][..layout.instants()];
        let start = layout.range(Column::Responses).start;
        for (place, &r) in study.look.chosen.iter().enumerate() {
            let sides = [alone.envelope.dynamic.max[r], alone.envelope.dynamic.min[r]];
            for (side, extreme) in sides.into_iter().enumerate() {
                let at = side * layout.responses + place;
                let value = numbers[start + at];
                assert_eq!(
                    value.to_bits(),
                    extreme.value.to_bits(),
                    "sample {sample}, response {r}: {value}, {extreme:?}"
                );
                let (time, position) = run.when(study, samples, sample, instants[at]);
                assert_eq!([time, position], [extreme.time, extreme.position], "sample {sample}, response {r}");
            }
        }
        let loads = layout.range(Column::Loads).start;
        for k in 0..alone.history.axles {
            let sides = [alone.axle_loads.dynamic.max[k], alone.axle_loads.dynamic.min[k]];
            for (side, extreme) in sides.into_iter().enumerate() {
                let at = side * layout.axles + k;
                assert_eq!(numbers[loads + at].to_bits(), extreme.value.to_bits(), "sample {sample}, axle {k}");
                let (time, _) = run.when(study, samples, sample, instants[2 * layout.responses + at]);
                assert_eq!(time, extreme.time, "sample {sample}, axle {k}");
            }
        }
    }
}

#[test]
fn a_sample_is_a_crossing() {
    let study = headline();
    let speeds: Vec<f64> = (0..9).map(|i| 15.0 + 3.0 * f64::from(i)).collect();
    let samples = Samples { speeds, ..Samples::at_speed(100, 9, 1.0) };
    let together = spread(&study, &samples, Isa::Scalar, 1, 32);
    assert!(together.results.failures.is_empty());
    check_alone(&study, &samples, &together);
}

#[test]
fn nothing_about_the_work_changes_a_bit() {
    let study = headline();
    let samples = Samples::at_speed(0, 70, 22.86);
    let reference = spread(&study, &samples, Isa::Scalar, 1, 32).results;
    for isa in Isa::present() {
        for threads in [1, 2, 7] {
            for chunk in [1, 31, 32, 1000] {
                let again = spread(&study, &samples, isa, threads, chunk).results;
                assert_eq!(again.hash(), reference.hash(), "{isa:?}, {threads} threads, chunks of {chunk}");
            }
        }
    }
    for sample in [0, 17, 69] {
        let alone = spread(&study, &Samples::at_speed(sample, 1, 22.86), Isa::Scalar, 1, 32).results;
        assert_eq!(alone.digests[0], reference.digests[sample as usize]);
    }
}

#[test]
fn speed() {
    let study = headline();
    let samples = Samples::at_speed(0, 4000, 22.86);
    for (isa, threads) in [(Isa::chosen().unwrap(), 1), (Isa::chosen().unwrap(), 2), (Isa::Scalar, 1)] {
        let start = std::time::Instant::now();
        spread(&study, &samples, isa, threads, 32);
        println!("{isa:?} {threads}: {:.0}/s", samples.count as f64 / start.elapsed().as_secs_f64());
    }
}
