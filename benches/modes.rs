//! Natural modes from the flexibility, its own check of residual and orthogonality included.

#[path = "../tests/problems/mod.rs"]
mod problems;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use problems::two_spans;
use spanwise::modes::Modes;
use spanwise::statics::Flexibility;

fn modes(c: &mut Criterion) {
    let mut group = c.benchmark_group("modes");
    group.sample_size(10);
    for (stations, count) in [(6, 3), (100, 20), (1000, 20)] {
        let bridge = two_spans(stations / 2);
        group.bench_function(BenchmarkId::new("lowest", format!("stations={stations},modes={count}")), |b| {
            b.iter(|| Modes::new(&bridge, &Flexibility::new(&bridge, &[]).unwrap(), count).unwrap());
        });
    }
    group.finish();
}

criterion_group!(benches, modes);
criterion_main!(benches);
