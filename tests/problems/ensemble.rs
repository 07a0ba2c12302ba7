//! The headline case of the ensemble engine, studies with all that it allows, and the few calls by which tests and
//! benches reach that engine.

use spanwise::stop_token::StopToken;
use spanwise::tape::BridgeFactors;
use std::sync::Arc;

use spanwise::bridge::Bridge;
use spanwise::crossing::{Analysis, Envelope, Extreme, History, Observer, Preparation, axle_loads, cross};
use spanwise::damping::{Damping, ModalDamping};
use spanwise::ensemble::{
    Column, Factors, Layout, Parameter, Plan, Progress, Record, Results, Run, Samples, Shared, Study, Task, Workers,
};
use spanwise::error::Error;
use spanwise::lane::{Isa, Lanes};
use spanwise::modal_bridge::ModalBridge;
use spanwise::modes::Modes;
use spanwise::passage::{Drive, Passage, Settings, Tail};
use spanwise::recovery::Recovery;
use spanwise::road::{Feature, Patch, Road, Spectrum, Synthesis};
use spanwise::statics::{Flexibility, Quantity};
use spanwise::statistics::Ride;
use spanwise::vehicle::Vehicle;

use super::vehicles::{articulated, half_car, leaf};
use super::{general_arrangements, kishan_bridge, kishan_vehicle, largest_magnitude, spread};

/// Seed of the study.
pub const SEED: u64 = 7;

/// Speed [m/s], with which a step takes one millisecond.
pub const SPEED: f64 = 22.86;

/// Everything that is looked at unless others are asked for.
pub const ALL: [Quantity; 6] = Quantity::USUAL;

/// Roads of class B as a contact patch of 0.24 m feels them, with a period of 128 m.
pub fn synthesis() -> Arc<Synthesis> {
    roads(64e-6)
}

/// G_d(n₀) of a poor road, class D, on which wheels lift off [m³].
pub const POOR: f64 = 1024e-6;

/// Roads of some roughness [m³] as a contact patch of 0.24 m feels them, with a period of 128 m.
pub fn roads(roughness: f64) -> Arc<Synthesis> {
    let spectrum = Spectrum::new(roughness, 2.0, [0.01, 4.0]).unwrap();
    Arc::new(Synthesis::new(spectrum, Patch::new(0.24).unwrap(), Some(128.0)).unwrap())
}

/// The bridge of 1973 in three modes, seen at so many sections at equal distances.
pub fn kishan_analysis(sections: usize, recovery: Recovery) -> Arc<Analysis> {
    let bridge = kishan_bridge();
    let modes = Modes::new(&bridge, &Flexibility::new(&bridge, &[]).unwrap(), 3).unwrap();
    let at = |i: usize| bridge.length() * i as f64 / (sections - 1) as f64;
    let sections: Vec<f64> = (0..sections).map(at).collect();
    Arc::new(
        Preparation::default().sections(&sections).recovery(recovery).of(&bridge, modes, StopToken::NEVER).unwrap(),
    )
}

/// Any bridge in some modes, seen at some sections, the default ones if none are given.
pub fn analysis_of(
    bridge: &Bridge,
    modes: usize,
    damping: &Damping,
    sections: &[f64],
    recovery: Recovery,
) -> Arc<Analysis> {
    let modes = Modes::new(bridge, &Flexibility::new(bridge, &[]).unwrap(), modes).unwrap();
    let sections = (!sections.is_empty()).then(|| sections.to_vec());
    let preparation = Preparation { damping: damping.clone(), sections, recovery };
    Arc::new(preparation.of(bridge, modes, StopToken::NEVER).unwrap())
}

/// A rough approach of 30 m.
pub fn approach() -> Settings {
    Settings { approach: 30.0, ramp: 10.0, beta: 1.0 / 6.0, ..Settings::at_speed(SPEED) }
}

/// All that can be said of a study.
pub fn study_of(
    analysis: Arc<Analysis>,
    kinds: Vec<Vec<Passage>>,
    settings: Settings,
    own: Option<(Arc<Synthesis>, u64)>,
    advance: Option<f64>,
    quantities: &[Quantity],
) -> Result<Study, Error> {
    Plan { analysis, kinds, settings, own, advance, quantities: quantities.to_vec() }.study()
}

/// The vehicle of 1973 on its bridge in three modes, each sample on its own road of class B.
pub fn headline() -> Study {
    let kinds = vec![vec![Passage::of(kishan_vehicle())]];
    let analysis = kishan_analysis(25, Recovery::ForceSummation);
    study_of(analysis, kinds, approach(), Some((synthesis(), SEED)), Some(0.022_86), &ALL).unwrap()
}

/// A bump of 20 mm with smooth sides of a metre, felt through a contact patch.
pub fn bump(at: f64) -> Road {
    Feature::plateau(at, 4.0, 0.02, 1.0, Patch::new(0.24).unwrap()).unwrap().into()
}

/// All at once: a bridge with hinges, springs and an EI that varies; two kinds of vehicle, one of two axles whose unsprung
/// masses rub through leaf springs and one of two bodies on five axles; damped tyres; a bump on top of roads of class D;
/// a tail.
pub fn mixed() -> Study {
    let (_, bridge) = general_arrangements().into_iter().find(|(name, _)| *name == "all at once").unwrap();
    let analysis = analysis_of(&bridge, 5, &Damping::Ratios(vec![0.02]), &[], Recovery::ForceSummation);
    let two = half_car([700.0, 1100.0], 1.0, 1.0, leaf(8e3, 1e-3));
    let kinds = vec![vec![Passage::of(two)], vec![Passage::of(articulated(1.0, 1.0))]];
    let road = Arc::new(bump(12.0));
    let settings = Settings { approach: 20.0, ramp: 5.0, tail: Tail::Fixed(0.3), road, ..Settings::at_speed(SPEED) };
    study_of(analysis, kinds, settings, Some((roads(POOR), SEED)), Some(0.1), &ALL).unwrap()
}

/// Samples of [`mixed`]: kinds in turn, speeds of which the lowest halve the step, factors on every parameter.
pub fn mixed_samples(first: u64, count: usize) -> Samples {
    let numbers = first as usize..first as usize + count;
    Samples {
        first,
        count,
        kinds: numbers.clone().map(|i| u32::from(i % 3 == 1)).collect(),
        speeds: numbers.clone().map(|i| 2.0 + 38.0 * spread(i)).collect(),
        factors: Parameter::ALL
            .into_iter()
            .enumerate()
            .map(|(p, parameter)| varied(parameter, p, numbers.clone()))
            .collect(),
    }
}

/// One factor for each sample, up to a fifth off one; of friction in the static state what part of the limit it is.
pub fn varied(parameter: Parameter, salt: usize, numbers: std::ops::Range<usize>) -> Factors {
    let value = |i: usize| match parameter {
        Parameter::InitialFriction => 2.0 * spread(17 * i + salt) - 1.0,
        _ => 0.8 + 0.4 * spread(17 * i + salt),
    };
    Factors { parameter, width: 1, values: numbers.map(value).collect() }
}

/// Samples of the headline case, all at its speed.
pub fn samples(count: usize) -> Samples {
    Samples::at_speed(0, count, SPEED)
}

/// The instruction sets of this processor, by name.
pub fn isas() -> Vec<(&'static str, Isa)> {
    Isa::present().map(|isa| (isa.name(), isa)).collect()
}

/// Crosses with all samples.
pub fn run(study: &Study, samples: &Samples, isa: Isa, threads: usize) -> Run {
    study.run(samples, &Workers { isa, threads, chunk: None }, &Progress::default()).unwrap()
}

/// The same, with so many samples to a worker at a time.
pub fn run_in_chunks(study: &Study, samples: &Samples, isa: Isa, threads: usize, chunk: usize) -> Run {
    study.run(samples, &Workers { isa, threads, chunk: Some(chunk) }, &Progress::default()).unwrap()
}

/// Some samples as a run of their own; they must follow each other in number if roads are drawn for them.
pub fn some(samples: &Samples, places: std::ops::Range<usize>) -> Samples {
    let pick = |values: &[f64], width: usize| match values.len() == width {
        true => values.to_vec(),
        false => values[places.start * width..places.end * width].to_vec(),
    };
    Samples {
        first: samples.first + places.start as u64,
        count: places.len(),
        kinds: samples.kinds.get(places.clone()).map_or(Vec::new(), <[u32]>::to_vec),
        speeds: pick(&samples.speeds, 1),
        factors: (samples.factors.iter()).map(|f| Factors { values: pick(&f.values, f.width), ..f.clone() }).collect(),
    }
}

/// The numbers and instants of a sample.
pub fn row(results: &Results, sample: usize) -> (&[f64], &[u32]) {
    let (width, instants) = (results.format.width(), results.format.instants());
    (&results.numbers[sample * width..][..width], &results.instants[sample * instants..][..instants])
}

/// A column of a sample.
pub fn column(results: &Results, sample: usize, column: Column) -> &[f64] {
    &row(results, sample).0[results.format.range(column)]
}

/// Static loads worked out twice, relative to the largest response.
const ROUNDING: f64 = 1e-11;

/// Crossings of one sample by the engine for single ones.
pub struct Alone {
    pub vehicle: Vehicle,
    pub history: History,
    pub envelope: Envelope,
    pub axle_loads: Envelope,
    /// By what deflections are still to be divided.
    pub stiffness: f64,
    /// What the rows take Ȧ times.
    pub rates: f64,
}

/// A sample as a single crossing, in steps of this way [m].
pub fn alone(study: &Study, samples: &Samples, sample: usize, advance: f64) -> Result<Alone, Error> {
    let speed = samples.speed(sample, 0);
    let road = match &study.own {
        Some((own, seed)) => {
            let own = own.road(*seed, samples.first + sample as u64).into();
            Arc::new(Road::sum([(*study.settings.road).clone(), own]))
        }
        None => Arc::clone(&study.settings.road),
    };
    let settings = Settings { road, step: Some(advance / speed), speed, ..study.settings.clone() };
    let mut passage = study.kinds[samples.kind(sample)].passages[0].clone();
    if !samples.factors.is_empty() {
        passage.vehicle = samples.vehicle(&passage.vehicle, sample, [0, 0])?;
    }
    let vehicle = passage.vehicle.clone();
    let model = &study.analysis.model;
    let factor = |parameter: Parameter| samples.factor(parameter, sample, 0);
    let [stiffness, damping] = [Parameter::BridgeStiffness, Parameter::BridgeDamping].map(factor);
    // Frequencies go with the root of the stiffness, ratios to critical damping are what they are; forces k Φᵀ K A and
    // C Ȧ go with both.
    let (stiffness, factor) = (stiffness.unwrap_or(1.0), damping.unwrap_or(1.0));
    let damping = match &model.damping {
        ModalDamping::Classical(ratios) => ModalDamping::Classical(ratios.iter().map(|r| r * factor).collect()),
        full if factor == 1.0 => full.clone(),
        ModalDamping::Coupled(_) => panic!("damping in modes"),
    };
    let root = stiffness.sqrt();
    let omega = model.omega.iter().map(|omega| omega * root).collect();
    let own = ModalBridge { omega, damping, ..model.clone() };
    let varied = BridgeFactors { coordinates: stiffness, rates: root * factor };
    let mut observer = Observer::new(&study.analysis.rows, &study.look, &study.free, Some(varied));
    let history = cross(&own, &[passage], &settings, &mut observer, StopToken::NEVER)?;
    let envelope = observer.conclude(&history, StopToken::NEVER)?;
    let rides = history.rides(&[vehicle.heaves()], study.analysis.rows.mesh(), StopToken::NEVER)?;
    let axle_loads = axle_loads(&history, &rides);
    Ok(Alone { vehicle, axle_loads, history, envelope, stiffness, rates: root * factor })
}

/// Every sample of a study whose vehicles go their own ways against the crossing by itself, to the bit.
pub fn check_own_ways(study: &Study, samples: &Samples, run: &Run, name: &str) {
    let (results, format) = (&run.results, run.results.format);
    for sample in 0..samples.count {
        let failure = results.failures.iter().find(|failure| failure.sample == sample);
        let (history, envelope, rides, factors) = match own_way(study, samples, sample) {
            Ok(whole) => whole,
            Err(error) => {
                assert_eq!(failure.map(|failure| &failure.cause), Some(&error), "{name}, sample {sample}");
                continue;
            }
        };
        assert_eq!(failure, None, "{name}, sample {sample}");
        let loads = axle_loads(&history, &rides);
        let shrink = |place: usize| factors.map_or(1.0, |factors| factors.of(study.look.quantities[place]));
        let same = |what: &str, column: Column, expected: &mut dyn Iterator<Item = f64>| {
            let values = &results.numbers[sample * format.width()..][format.range(column)];
            for (i, (value, expected)) in values.iter().zip(expected).enumerate() {
                // All that is not a number is one and the same.
                let are = value.to_bits() == expected.to_bits() || value.is_nan() && expected.is_nan();
                assert!(are, "{name}, sample {sample}, {what} {i}: {value}, {expected}");
            }
        };
        let sides = |of: &Envelope| [of.dynamic.max.clone(), of.dynamic.min.clone()];
        let padded = |side: Vec<f64>| {
            let beyond = format.axles - side.len();
            side.into_iter().chain(std::iter::repeat_n(f64::NAN, beyond)).collect::<Vec<f64>>()
        };
        let values = || sides(&envelope).into_iter().flat_map(|side| side.into_iter().enumerate());
        same("response", Column::Responses, &mut values().map(|(i, e)| e.value / shrink(i)));
        let statics =
            [&envelope.at_rest.max, &envelope.at_rest.min].into_iter().flat_map(|side| side.iter().enumerate());
        same("static response", Column::Statics, &mut statics.map(|(i, e)| e.value / shrink(i)));
        let of_loads = |what: fn(&Extreme) -> f64| {
            sides(&loads).into_iter().flat_map(move |side| padded(side.iter().map(what).collect()))
        };
        same("load", Column::Loads, &mut of_loads(|e| e.value));
        let of_responses = |what: fn(&Extreme) -> f64| values().map(move |(_, e)| what(&e));
        same("time", Column::Times, &mut of_responses(|e| e.time).chain(of_loads(|e| e.time)));
        same("place", Column::Positions, &mut of_responses(|e| e.position).chain(of_loads(|e| e.position)));
        let each = || rides.iter().flat_map(|ride| (0..ride.loads.len()).map(move |k| (ride, k)));
        let statics = &history.static_loads;
        let coefficients = each().zip(statics).map(|((ride, k), load)| ride.load_coefficient(k, 0, *load)).collect();
        same("load coefficient", Column::LoadCoefficients, &mut padded(coefficients).into_iter());
        let aloft = padded(each().map(|(ride, k)| ride.aloft[k] * history.step).collect());
        same("time off the road", Column::Aloft, &mut aloft.into_iter());
        same("acceleration", Column::Accelerations, &mut rides.iter().flat_map(|ride| ride.accelerations.clone()));
        let bodies = rides.iter().flat_map(|ride| (0..ride.squares.len()).map(move |b| ride.vibration(b, 0)));
        same("vibration", Column::Vibrations, &mut { bodies });
        let tail = history.time[history.len() - 1] - history.ended;
        same("tail", Column::Tail, &mut std::iter::once(tail));
    }
}

/// What comes of a sample by itself: states, extremes, rides, and what the rows take of a bridge that is varied.
type Whole = (History, Envelope, Vec<Ride<f64>>, Option<BridgeFactors<f64>>);

/// A sample whose vehicles go their own ways as a crossing by itself, in the steps that this takes.
fn own_way(study: &Study, samples: &Samples, sample: usize) -> Result<Whole, Error> {
    let mut before = [0, 0];
    let mut passages = study.kinds[samples.kind(sample)].passages.clone();
    for (v, passage) in passages.iter_mut().enumerate() {
        let own = before;
        before = [own[0] + passage.vehicle.bodies().len(), own[1] + passage.vehicle.assembly().contacts.len()];
        if !samples.factors.is_empty() {
            passage.vehicle = samples.vehicle(&passage.vehicle, sample, own)?;
        }
        if !matches!(passage.drive, Some(Drive::Speeds { .. })) {
            passage.speed = passage.speed.or(Some(samples.speed(sample, v)));
        }
    }
    let road = match &study.own {
        Some((own, seed)) => {
            let own = own.road(*seed, samples.first + sample as u64).into();
            Arc::new(Road::sum([(*study.settings.road).clone(), own]))
        }
        None => Arc::clone(&study.settings.road),
    };
    let settings = Settings { road, ..study.settings.clone() };
    let model = &study.analysis.model;
    let varied = |parameter: Parameter| samples.factor(parameter, sample, 0);
    let factors = match [Parameter::BridgeStiffness, Parameter::BridgeDamping].map(varied) {
        [None, None] => None,
        [stiffness, damping] => Some((stiffness.unwrap_or(1.0), damping.unwrap_or(1.0))),
    };
    let (stiffness, damping) = factors.unwrap_or((1.0, 1.0));
    let ModalDamping::Classical(ratios) = &model.damping else { panic!("damping in modes") };
    let own = ModalBridge {
        omega: model.omega.iter().map(|w| w * stiffness.sqrt()).collect(),
        damping: ModalDamping::Classical(ratios.iter().map(|r| r * damping).collect()),
        ..model.clone()
    };
    let factors = factors.map(|_| BridgeFactors { coordinates: stiffness, rates: stiffness.sqrt() * damping });
    let mut observer = Observer::new(&study.analysis.rows, &study.look, &study.free, factors);
    let history = cross(&own, &passages, &settings, &mut observer, StopToken::NEVER)?;
    let envelope = observer.conclude(&history, StopToken::NEVER)?;
    let bodies: Vec<_> = passages.iter().map(|passage| passage.vehicle.heaves()).collect();
    let rides = history.rides(&bodies, study.analysis.rows.mesh(), StopToken::NEVER)?;
    Ok((history, envelope, rides, factors))
}

/// Every sample against its own single crossing, to the bit: extremes of responses and axle loads, when and where, and
/// static extremes.
pub fn check_alone(study: &Study, samples: &Samples, run: &Run, name: &str) {
    let (results, format) = (&run.results, run.results.format);
    assert!(results.failures.is_empty(), "{name}: {:?}", results.failures);
    for sample in 0..samples.count {
        let march = results.marches[sample] as usize;
        let (number, speed) = (results.marches[sample], samples.speed(sample, 0));
        let alone = match alone(study, samples, sample, study.path(run.marches[march]).advance) {
            Ok(alone) => alone,
            Err(error) => panic!("{name}, sample {sample}: {error}"),
        };
        let (_, instants) = row(results, sample);
        let same = |what: &str, at: usize, value: f64, expected: f64| {
            assert_eq!(
                value.to_bits(),
                expected.to_bits(),
                "{name}, sample {sample}, {what} {at}: {value}, {expected}"
            );
        };
        let hands = run.clock.of(number);
        let factors = BridgeFactors { coordinates: alone.stiffness, rates: alone.rates };
        let shrink = |place: usize| factors.of(study.look.quantities[place]);
        let values = column(results, sample, Column::Responses);
        let shared = format.own_statics.then(|| column(results, sample, Column::Statics));
        let statics = match shared {
            None => Some(&run.at_rest[march][..]),
            own => own,
        };
        let largest = largest_magnitude(statics.unwrap_or_default());
        for (place, &r) in study.look.chosen.iter().enumerate() {
            let (dynamic, at_rest) = (&alone.envelope.dynamic, &alone.envelope.at_rest);
            for (side, (extreme, at_rest)) in
                [(dynamic.max[place], at_rest.max[place]), (dynamic.min[place], at_rest.min[place])]
                    .into_iter()
                    .enumerate()
            {
                let at = side * format.responses + place;
                let (time, position) = hands.when(speed, instants[at]);
                same("response", r, values[at], extreme.value / shrink(place));
                same("time of response", r, time, extreme.time);
                same("place of response", r, position, extreme.position);
                let Some(statics) = statics else { continue };
                if shared.is_none() && !samples.factors.is_empty() {
                    // Axle loads are those that other springs give, but for rounding.
                    let off = (statics[at] - at_rest.value).abs() / largest;
                    assert!(off <= ROUNDING, "{name}, sample {sample}, static response {r}: off by {off:e}");
                } else {
                    same("static response", r, statics[at], at_rest.value / shrink(place));
                }
            }
        }
        let &[tail, growth, growing] = column(results, sample, Column::Tail) else { panic!("three numbers") };
        let length = alone.history.time.last().unwrap() - alone.history.ended;
        assert!((tail - length).abs() <= 1e-9 * alone.history.step, "{name}, sample {sample}: {tail} s, {length} s");
        let reach = alone.history.reach.clone().unwrap().scaled(alone.stiffness, alone.rates);
        let seen = |row: usize| {
            let place = study.look.first_of_row[row];
            [alone.envelope.dynamic.max[place].value, alone.envelope.dynamic.min[place].value]
        };
        let [most, side] = study.free.growth(&reach, seen);
        let expected = [most, study.look.side(side)];
        if alone.stiffness == 1.0 {
            same("growth", 0, growth, expected[0]);
            same("place of growth", 0, growing, expected[1]);
        } else {
            assert!((growth - expected[0]).abs() <= 1e-12, "{name}, sample {sample}: {growth}, {expected:?}");
        }
        let loads = column(results, sample, Column::Loads);
        for k in 0..alone.history.axles {
            let sides = [alone.axle_loads.dynamic.max[k], alone.axle_loads.dynamic.min[k]];
            for (side, extreme) in sides.into_iter().enumerate() {
                let at = side * format.axles + k;
                same("load of axle", k, loads[at], extreme.value);
                let (time, position) = hands.when(speed, instants[2 * format.responses + at]);
                same("time of load", k, time, extreme.time);
                same("place of load", k, position, extreme.position);
            }
        }
    }
}

/// One sample in a lane of any kind, its geometry laid out or not, on the calling thread: its numbers and instants.
pub fn one<L: Lanes>(study: &Study, number: u64, laid_out: bool) -> (Vec<f64>, Vec<u32>) {
    let samples = Samples::at_speed(number, 1, SPEED);
    let layout = if laid_out { study.layout(0, &samples) } else { Layout::Bare };
    let (format, table) = (study.format(&samples), study.table((0, 0), layout, StopToken::NEVER).unwrap());
    let (mut numbers, mut instants) = (vec![0.0; format.width()], vec![0; format.instants()]);
    let record = Record { numbers: &mut numbers, instants: &mut instants };
    let (samples, shared) = (&samples, &Shared::new(table));
    let task = Task { study, format, samples, kind: 0, shared };
    task.run::<L>(&[0], &mut [record], &mut Vec::new(), StopToken::NEVER).unwrap();
    (numbers, instants)
}
