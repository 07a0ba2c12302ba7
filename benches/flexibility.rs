//! Preparing a bridge: mesh, restraints and the flexibility matrices.

#[path = "../tests/problems/mod.rs"]
mod problems;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use problems::two_spans;
use spanwise::statics::{Flexibility, Structure};

fn flexibility(c: &mut Criterion) {
    let mut group = c.benchmark_group("flexibility");
    group.sample_size(20);
    for stations in [6, 100, 1000] {
        let bridge = two_spans(stations / 2);
        group.bench_function(BenchmarkId::new("basic", format!("stations={stations}")), |b| {
            b.iter(|| {
                let flexibility = Flexibility::new(&bridge, &[]).unwrap();
                let nodes = flexibility.reference_nodes(&bridge);
                flexibility.matrix(&nodes, &nodes, Structure::Basic)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, flexibility);
criterion_main!(benches);
