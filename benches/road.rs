//! Random roads of eight samples side by side, by instruction set; times are per sample.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use spanwise::ensemble::Drawing;
use spanwise::lane::{InLanes, Isa, Lanes, with};
use spanwise::road::{Patch, Spectrum, Synthesis};

/// Draws the roads of so many blocks, one after the other.
struct Draw<'a> {
    synthesis: &'a Synthesis,
    blocks: u64,
}

impl InLanes for Draw<'_> {
    type Output = Duration;

    fn run<L: Lanes>(self) -> Duration {
        let Draw { synthesis, blocks } = self;
        let mut road: Vec<L> = Vec::new();
        let start = Instant::now();
        for block in 0..blocks {
            let sample = |lane: usize| (L::SAMPLES as u64) * block + lane as u64;
            L::dispatch(Drawing { synthesis, seed: 7, sample, road: &mut road });
            black_box(&mut road);
        }
        start.elapsed()
    }
}

fn roads(c: &mut Criterion) {
    let mut group = c.benchmark_group("road/coefficients");
    for period in [128.0, 1024.0] {
        let spectrum = Spectrum::new(64e-6, 2.0, [0.01, 4.0]).unwrap();
        let synthesis = Synthesis::new(spectrum, Patch::new(0.24).unwrap(), Some(period)).unwrap();
        for isa in Isa::present() {
            let side_by_side = isa.samples() as u64;
            let id = BenchmarkId::new(format!("points={}", synthesis.points()), isa.name());
            group.bench_function(id, |b| {
                b.iter_custom(|samples| {
                    let blocks = samples.div_ceil(side_by_side);
                    let taken = with(isa, Draw { synthesis: &synthesis, blocks });
                    taken.mul_f64(samples as f64 / (blocks * side_by_side) as f64)
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, roads);
criterion_main!(benches);
