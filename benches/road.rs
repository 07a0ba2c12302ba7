//! Random roads of eight samples side by side, by instruction set; times are per sample.

use std::hint::black_box;
use std::time::Instant;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use spanwise::lane::wide::Wide;
use spanwise::road::patch::Patch;
use spanwise::road::random::Synthesis;
use spanwise::road::spectrum::Spectrum;

const SAMPLES: usize = 8;

/// Draws the roads of one block.
struct Draw<'a> {
    synthesis: &'a Synthesis,
    block: u64,
    coefficients: &'a mut Vec<Wide<SAMPLES>>,
}

impl pulp::NullaryFnOnce for Draw<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) -> Self::Output {
        let first = SAMPLES as u64 * self.block;
        self.synthesis.coefficients_into(7, |lane| first + lane as u64, self.coefficients);
    }
}

fn scalar(draw: Draw) {
    pulp::NullaryFnOnce::call(draw);
}

#[cfg(target_arch = "x86_64")]
fn avx2(draw: Draw) {
    pulp::x86::V3::try_new().unwrap().vectorize(draw);
}

fn roads(c: &mut Criterion) {
    let mut group = c.benchmark_group("road/coefficients");
    for period in [128.0, 1024.0] {
        let spectrum = Spectrum::new(64e-6, 2.0, [0.01, 4.0]).unwrap();
        let synthesis = Synthesis::new(spectrum, Patch::new(0.24).unwrap(), Some(period)).unwrap();
        let mut coefficients = Vec::new();
        let mut bench = |isa: &str, draw: fn(Draw)| {
            let id = BenchmarkId::new(format!("points={}", synthesis.points()), isa);
            group.bench_function(id, |b| {
                b.iter_custom(|samples| {
                    let blocks = samples.div_ceil(SAMPLES as u64);
                    let start = Instant::now();
                    for block in 0..blocks {
                        draw(Draw { synthesis: &synthesis, block, coefficients: &mut coefficients });
                        black_box(&mut coefficients);
                    }
                    start.elapsed().mul_f64(samples as f64 / (blocks * SAMPLES as u64) as f64)
                });
            });
        };
        bench("scalar", scalar);
        #[cfg(target_arch = "x86_64")]
        if pulp::x86::V3::try_new().is_some() {
            bench("avx2", avx2);
        }
    }
    group.finish();
}

criterion_group!(benches, roads);
criterion_main!(benches);
