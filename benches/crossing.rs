//! One crossing, and its two halves: stepping through time, and recovering responses.

#[path = "../tests/problems/mod.rs"]
mod problems;

use criterion::{Criterion, criterion_group, criterion_main};
use problems::{kishan_bridge, kishan_vehicle, undamped};
use spanwise::analysis::Analysis;
use spanwise::course::Drive;
use spanwise::crossing::{Settings, cross};
use spanwise::flexibility::Flexibility;
use spanwise::modes::Modes;
use spanwise::recovery::Recovery;
use spanwise::survey::survey;

fn kishan_1973(c: &mut Criterion) {
    let bridge = kishan_bridge();
    let vehicle = kishan_vehicle();
    let modes = Modes::new(&bridge, &Flexibility::new(&bridge, &[]).unwrap(), 3).unwrap();
    let prepare =
        || Analysis::new(&bridge, modes.clone(), &undamped(), None, Recovery::ForceSummation, &mut || true).unwrap();
    let analysis = prepare();
    let rolling = Settings { drive: Drive::ConstantTraction, step: Some(1e-3), ..Settings::at_speed(22.86) };
    let steady = Settings { drive: Drive::ConstantSpeed, ..rolling.clone() };
    let go_on = &mut || true;

    let mut group = c.benchmark_group("crossing/kishan_1973");
    group.bench_function("modes=3", |b| b.iter(|| analysis.cross(&vehicle, &rolling, &mut || true).unwrap()));
    group.bench_function("prepare", |b| b.iter(prepare));
    group.bench_function("steps/constant-traction", |b| {
        b.iter(|| cross(&analysis.model, &vehicle, &rolling, &mut || true).unwrap());
    });
    group.bench_function("steps/constant-speed", |b| {
        b.iter(|| cross(&analysis.model, &vehicle, &steady, &mut || true).unwrap());
    });
    let history = cross(&analysis.model, &vehicle, &rolling, go_on).unwrap();
    let packed = analysis.rows.pack_history(&history);
    group.bench_function("recovery/pack", |b| b.iter(|| analysis.rows.pack_history(&history)));
    group.bench_function("recovery/extremes", |b| {
        b.iter(|| survey(&history, &analysis.rows, &packed, &analysis.responses, &mut || true).unwrap());
    });
    group.bench_function("recovery/histories", |b| {
        b.iter(|| analysis.rows.histories(&packed, 0..analysis.rows.len(), &mut || true).unwrap());
    });
    group.finish();
}

criterion_group!(benches, kishan_1973);
criterion_main!(benches);
