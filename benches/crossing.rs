//! One crossing, and its two halves: stepping through time, and recovering responses.

#[path = "../tests/problems/mod.rs"]
mod problems;

use criterion::{Criterion, criterion_group, criterion_main};
use problems::vehicles::{articulated, half_car};
use problems::{kishan_bridge, kishan_vehicle};
use spanwise::crossing::{History, Observer, Preparation, Watch, cross};
use spanwise::error::Error;
use spanwise::modes::Modes;
use spanwise::passage::{Direction, Drive, Passage, Settings};
use spanwise::statics::Flexibility;
use spanwise::step::Reach;
use spanwise::stop_token::StopToken;
use spanwise::vehicle::Friction;

/// Looks at nothing: steps alone.
struct Blind;

impl Watch for Blind {
    fn enough(&mut self, _: &History, _: &Reach<f64>, _: StopToken<'_>) -> Result<bool, Error> {
        Ok(false)
    }
}

fn kishan_1973(c: &mut Criterion) {
    let bridge = kishan_bridge();
    let vehicle = kishan_vehicle();
    let modes = Modes::new(&bridge, &Flexibility::new(&bridge, &[]).unwrap(), 3).unwrap();
    let prepare = || Preparation::default().of(&bridge, modes.clone(), StopToken::NEVER).unwrap();
    let analysis = prepare();
    let rolling = Settings { drive: Drive::ConstantTraction, step: Some(1e-3), ..Settings::at_speed(22.86) };
    let steady = Settings { drive: Drive::ConstantSpeed, ..rolling.clone() };
    let passages = [Passage::of(vehicle.clone())];
    let steps =
        |settings: &Settings| cross(&analysis.model, &passages, settings, &mut Blind, StopToken::NEVER).unwrap();

    let mut group = c.benchmark_group("crossing/kishan_1973");
    group.bench_function("modes=3", |b| b.iter(|| analysis.cross(&vehicle, &rolling, StopToken::NEVER).unwrap()));
    group.bench_function("prepare", |b| b.iter(prepare));
    group.bench_function("steps/constant-traction", |b| {
        b.iter(|| steps(&rolling));
    });
    group.bench_function("steps/constant-speed", |b| {
        b.iter(|| steps(&steady));
    });
    let history = steps(&rolling);
    group.bench_function("recovery/extremes", |b| {
        b.iter(|| {
            let observer = Observer::new(&analysis.rows, &analysis.look, &analysis.free, None);
            observer.conclude(&history, StopToken::NEVER).unwrap()
        });
    });
    group.bench_function("recovery/histories", |b| {
        b.iter(|| history.responses(&analysis.rows, 0..analysis.rows.len(), StopToken::NEVER).unwrap());
    });
    group.finish();
}

/// Every vehicle on the bridge of the example at 22.86 m/s in steps of 1 ms, three modes, smooth road, no approach.
fn vehicles(c: &mut Criterion) {
    let bridge = kishan_bridge();
    let modes = Modes::new(&bridge, &Flexibility::new(&bridge, &[]).unwrap(), 3).unwrap();
    let analysis = Preparation::default().of(&bridge, modes, StopToken::NEVER).unwrap();
    let settings = Settings { step: Some(1e-3), ..Settings::at_speed(22.86) };
    let half_car = half_car([700.0, 1100.0], 1.0, 0.0, Friction::NONE);
    let opposing = Passage { direction: Direction::Left, lane: 1, ..Passage::of(half_car.clone()) };
    let cases = [
        ("half_car", vec![Passage::of(half_car.clone())]),
        ("articulated_5_axle", vec![Passage::of(articulated(0.1, 1.0))]),
        ("two_vehicles_opposing", vec![Passage::of(half_car), opposing]),
    ];
    let mut group = c.benchmark_group("crossing");
    for (name, passages) in cases {
        let history = cross(&analysis.model, &passages, &settings, &mut Blind, StopToken::NEVER).unwrap();
        println!("{name}: {} steps, {} axles", history.len() - 1, history.axles);
        group.bench_function(name, |b| b.iter(|| analysis.cross_all(&passages, &settings, StopToken::NEVER).unwrap()));
        group.bench_function(format!("{name}/steps"), |b| {
            b.iter(|| cross(&analysis.model, &passages, &settings, &mut Blind, StopToken::NEVER).unwrap());
        });
    }
    group.finish();
}

criterion_group!(benches, kishan_1973, vehicles);
criterion_main!(benches);
