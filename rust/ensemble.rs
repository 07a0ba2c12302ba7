//! Many crossings of one bridge: samples side by side in the lanes of one step, block after block on all cores.
//!
//! With prescribed motion in equal steps of space, where the axles are and what their loads do to the bridge is the
//! same for every sample, whatever its speed, its road or its springs: one [`table`] serves all. Samples whose motion is
//! their own take the same step [`alone`]. A sample's result is a function of the study, the seed and its own number, to
//! the bit: not of the number of threads, of the width of the vectors, or of its neighbours.

pub mod alone;
pub mod block;
pub mod look;
pub mod record;
pub mod sample;
pub mod simd;
pub mod stretch;
pub mod survey;
pub mod table;
pub mod together;
pub mod watch;

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

use rayon::prelude::*;

use crate::analysis::Analysis;
use crate::assembly::{BuildUp, ContactLaw};
use crate::course::{Course, Drive, Passage};
use crate::error::{Error, positive};
use crate::float_mode::Standard;
use crate::influence::Quantity;
use crate::path::Pavement;
use crate::road::random::Synthesis;
use crate::settings::Settings;
use crate::steps::{MAX_STEPS, Steps};
use crate::vehicle::Vehicle;
use look::Look;
use record::{Failure, Layout, Record, Results};
use sample::{Parameter, Samples};
use simd::{Isa, SAMPLES};
use table::{Advance, Ground, Table};
use together::{Part, Task};

/// Most samples that a worker takes at a time unless told otherwise.
pub const BLOCK: usize = 256;

/// Halvings of the step that a sample may ask for.
const MOST_HALVINGS: u32 = 16;

/// One kind of event: a vehicle, or several, on their way.
#[derive(Debug, Clone)]
pub struct Kind {
    /// Who crosses.
    pub passages: Vec<Passage>,
    /// Vertical displacement of every body of the first vehicle, as rows over its coordinates.
    bodies: Vec<Vec<f64>>,
}

/// Everything that the samples of a study share.
#[derive(Debug)]
pub struct Study {
    /// The bridge.
    pub analysis: Arc<Analysis>,
    /// The kinds of event, of which each sample is one.
    pub kinds: Vec<Kind>,
    /// How they cross; the speed is that of each sample.
    pub settings: Settings,
    /// What samples' own random roads have in common, and the seed; they come on top of the road of the settings.
    pub own: Option<(Arc<Synthesis>, u64)>,
    /// Longest way per step [m].
    advance: Option<f64>,
    /// The responses looked at.
    pub look: Look,
    /// Whether samples share the geometry.
    pub shares: bool,
}

/// Who does the work, and in which portions; none of it changes a result.
#[derive(Debug, Clone, Copy)]
pub struct Workers {
    /// The instruction set.
    pub isa: Isa,
    /// Threads.
    pub threads: usize,
    /// Samples that a worker takes at a time; fewer, down to what fills its lanes, where there is not much to share out.
    pub chunk: usize,
}

impl Workers {
    /// As many as the machine has, or as the caller wants.
    pub fn new(threads: Option<usize>, chunk: Option<usize>) -> Result<Self, Error> {
        let threads = match threads {
            Some(0) => return Err(Error::input("threads", 0, "must be 1 or more")),
            Some(threads) if threads > 4096 => return Err(Error::input("threads", threads, "must be at most 4096")),
            Some(threads) => threads,
            None => std::thread::available_parallelism().map_or(1, usize::from),
        };
        match chunk {
            Some(0) => Err(Error::input("chunk", 0, "must be 1 or more")),
            chunk => Ok(Workers { isa: Isa::chosen()?, threads, chunk: chunk.unwrap_or(BLOCK) }),
        }
    }
}

/// What others may see of a run, and whether it shall go on.
#[derive(Debug, Default)]
pub struct Progress {
    /// Samples done.
    pub done: AtomicUsize,
    /// Set to end the run.
    pub stop: AtomicBool,
}

/// How a sample marches: which kind of event, and how often the step is halved.
type March = (usize, u32);

impl Study {
    /// Of crossings of a bridge by `kinds` of event, with the samples' `own` roads on top of that of the settings, in
    /// steps of `advance` [m] at most, looking at some quantities.
    pub fn new(
        analysis: Arc<Analysis>,
        kinds: Vec<Vec<Passage>>,
        settings: Settings,
        own: Option<(Arc<Synthesis>, u64)>,
        advance: Option<f64>,
        quantities: &[Quantity],
    ) -> Result<Self, Error> {
        let _mode = Standard::set();
        settings.check()?;
        if kinds.is_empty() || kinds.iter().any(Vec::is_empty) {
            return Err(Error::input("vehicles", "[]", "at least one vehicle must cross"));
        }
        let advance = advance.map(|advance| positive("advance", advance)).transpose()?;
        let constant = |passage: &Passage| *passage.drive.as_ref().unwrap_or(&settings.drive) == Drive::ConstantSpeed;
        let shares = kinds.iter().all(|passages| match &passages[..] {
            [one] => {
                let plain = one.direction == crate::course::Direction::Right && one.entry == 0.0 && one.road.is_none();
                plain && constant(one) && one.speed.is_none()
            }
            _ => false,
        });
        let look = Look::new(&analysis.rows, &analysis.responses, quantities);
        if look.chosen.is_empty() {
            return Err(Error::input("quantities", "[]", "at least one response must be looked at"));
        }
        let mut study = Study { analysis, kinds: Vec::new(), settings, own, advance, look, shares };
        for passages in kinds {
            let bodies = passages[0].vehicle.assembly().bodies.iter();
            let bodies = bodies.map(|[heave, _]| heave.iter().copied().collect()).collect();
            study.kinds.push(Kind { passages, bodies });
        }
        for kind in 0..study.kinds.len() {
            study.check_road(kind)?;
        }
        if !shares && advance.is_some() {
            let allowed = "only for vehicles that cross alone from the left at constant speed: use step";
            return Err(Error::input("advance", format!("{} m", advance.unwrap_or_default()), allowed));
        }
        Ok(study)
    }

    /// Whether a passage has its speed from its drive.
    pub fn brings_speeds(&self, passage: &Passage) -> bool {
        matches!(passage.drive.as_ref().unwrap_or(&self.settings.drive), Drive::Speeds { .. })
    }

    /// Refuses a road that repeats on the way, and contacts that cannot follow it.
    fn check_road(&self, kind: usize) -> Result<(), Error> {
        let length = self.analysis.model.shapes.mesh().length();
        for passage in &self.kinds[kind].passages {
            // The speed, where none is given yet, plays no part.
            let speed = passage.speed.or((!self.brings_speeds(passage)).then_some(1.0));
            let passage = Passage { speed, ..passage.clone() };
            let course = Course::new(&passage, &self.settings, "", 0)?;
            course.check_road(&self.settings, length)?;
            course.check_contact(&self.analysis.model.shapes)?;
            // Without a ramp the axles behind the first begin on the road too.
            let behind = if self.settings.ramp > 0.0 { 0.0 } else { course.wheelbase() };
            let path = course.path(&self.settings, length) + behind;
            if let Some((synthesis, _)) = self.own.as_ref().filter(|(own, _)| path > own.period()) {
                let allowed = format!(
                    "it repeats after its period of {} m, and the path is longer; give a longer one",
                    synthesis.period()
                );
                return Err(Error::input("road", format!("path of {path} m"), allowed));
            }
        }
        Ok(())
    }

    /// Whether the road is level throughout.
    fn is_even(&self) -> bool {
        self.own.is_none() && self.settings.road.is_smooth()
    }

    /// The vehicles of every kind.
    fn vehicles(&self) -> Vec<Vec<&Vehicle>> {
        self.kinds.iter().map(|kind| kind.passages.iter().map(|p| &p.vehicle).collect()).collect()
    }

    /// Where things stand in the rows of a run's results.
    pub fn layout(&self, samples: &Samples) -> Layout {
        let most = |count: &dyn Fn(&Vehicle) -> usize| {
            let of = self.kinds.iter().map(|k| k.passages.iter().map(|p| count(&p.vehicle)).sum());
            of.max().unwrap_or(0)
        };
        Layout {
            responses: self.look.chosen.len(),
            axles: most(&|v| v.assembly().contacts.len()),
            bodies: most(&|v| v.bodies().len()),
            own_statics: !self.shares || samples.varies_loads() || samples.varies(Parameter::BridgeStiffness),
            own_times: !self.shares,
        }
    }

    /// The vehicle of a kind whose samples share the geometry.
    pub fn vehicle(&self, kind: usize) -> &Vehicle {
        &self.kinds[kind].passages[0].vehicle
    }

    /// Steps of a kind that is not refined, and the way of each [m].
    pub fn plan(&self, kind: usize) -> (usize, f64) {
        let model = &self.analysis.model;
        let vehicle = self.vehicle(kind);
        let path = self.settings.approach + model.shapes.mesh().length() + vehicle.wheelbase();
        let longest = self
            .advance
            .unwrap_or_else(|| Steps::longest_way(model.narrowest_panel, !self.is_even(), self.settings.road.finest()));
        let steps = (path / longest - 1e-9).ceil().max(1.0);
        (steps as usize, path / steps)
    }

    /// The geometry of a kind whose step is halved so many times.
    pub fn table(&self, (kind, halvings): March) -> Table {
        let Analysis { model, rows, responses, .. } = &*self.analysis;
        let contacts = &self.vehicle(kind).assembly().contacts;
        let length = model.shapes.mesh().length();
        let wheelbase = self.vehicle(kind).wheelbase();
        let front = contacts[0].position;
        let (steps, _) = self.plan(kind);
        let steps = steps << halvings;
        let advance = (self.settings.approach + length + wheelbase) / steps as f64;
        let beyond = if self.settings.tail > 0.0 { (wheelbase / advance).ceil() as usize + 2 } else { 0 };
        let pavement = Pavement {
            road: &self.settings.road,
            start: -self.settings.approach,
            end: length + wheelbase,
            ramp: self.settings.ramp,
            direction: 1.0,
        };
        let path = Advance {
            start: -self.settings.approach,
            advance,
            behind: contacts.iter().map(|c| front - c.position).collect(),
            steps,
            beyond,
        };
        let slopes = !contacts.iter().all(|contact| contact.law.is_plain());
        let ground = Ground { pavement: &pavement, own: self.own.as_ref().map(|(own, _)| &**own) };
        Table::new(path, &model.shapes, (rows, responses, &self.look), slopes, ground)
    }

    /// How often the step of each sample must be halved: a function of the sample alone.
    fn marches(&self, samples: &Samples) -> Result<Vec<March>, Error> {
        let beta = self.settings.beta;
        // Squared frequencies of bridge, vehicle and tyres on the bridge, of each kind as it is.
        let model = &self.analysis.model;
        let fastest: Vec<[f64; 3]> =
            (0..self.kinds.len()).map(|kind| model.fastest_parts(std::iter::once(self.vehicle(kind)))).collect();
        let plans: Vec<(usize, f64)> = (0..self.kinds.len()).map(|kind| self.plan(kind)).collect();
        // Leaf springs are the stiffer, the more they rub.
        let builds_up: Vec<bool> = (0..self.kinds.len())
            .map(|kind| {
                let frictions = &self.vehicle(kind).assembly().frictions;
                frictions.iter().any(|element| matches!(element.friction.build_up, BuildUp::Leaf(_)))
            })
            .collect();
        let march = |sample: usize| {
            let kind = samples.kind(sample);
            let [bodies, axles] = [self.vehicle(kind).bodies().len(), self.vehicle(kind).assembly().contacts.len()];
            let extreme = |parameter: Parameter, count: usize, pick: fn(f64, f64) -> f64| {
                let all = (0..count).filter_map(|part| samples.factor(parameter, sample, part));
                all.fold(1.0, pick)
            };
            let tyres = extreme(Parameter::TyreStiffness, axles, f64::max);
            let mut springs = tyres.max(extreme(Parameter::SuspensionStiffness, axles, f64::max));
            if builds_up[kind] {
                springs = springs.max(extreme(Parameter::FrictionLimit, axles, f64::max));
            }
            let inertia =
                extreme(Parameter::BodyMass, bodies, f64::min).min(extreme(Parameter::PitchInertia, bodies, f64::min));
            let [bridge, own, on_bridge] = fastest[kind];
            let stiffness = extreme(Parameter::BridgeStiffness, 1, f64::max);
            let fastest = (bridge * stiffness + own * springs / inertia + on_bridge * tyres).sqrt();
            let limit = if beta < 0.25 { 1.0 / (fastest * (0.25 - beta).sqrt()) } else { f64::INFINITY };
            let longest = match (self.settings.step, self.advance) {
                (Some(step), _) => step.min(limit),
                (None, Some(_)) => limit,
                (None, None) => Steps::resolving(fastest).min(limit),
            };
            let speed = samples.speed(sample, 0);
            let (steps, mut way) = plans[kind];
            let mut halvings = 0;
            // Where one step just fits, rounding does not halve it.
            while way > longest * speed * (1.0 + 1e-9) && halvings <= MOST_HALVINGS {
                way *= 0.5;
                halvings += 1;
            }
            let count = (steps as f64) * f64::from(1u32 << halvings.min(30)) + self.settings.tail * speed / way;
            if halvings > MOST_HALVINGS || count > MAX_STEPS as f64 {
                let allowed =
                    format!("a crossing at this speed would take more than {MAX_STEPS} steps, or too short ones");
                return Err(Error::input(format!("speed[{sample}]"), format!("{speed} m/s"), allowed));
            }
            Ok((kind, halvings))
        };
        if samples.alike() && samples.kinds.is_empty() && samples.count > 0 {
            let all = march(0)?;
            return Ok(vec![all; samples.count]);
        }
        (0..samples.count).map(march).collect()
    }

    /// Runs all samples.
    pub fn run(&self, samples: &Samples, workers: &Workers, progress: &Progress) -> Result<Run, Error> {
        // Here too, not only in the workers' threads: the geometry is laid out on this one.
        let _mode = Standard::set();
        samples.check(&self.vehicles())?;
        self.check_factors(samples)?;
        let layout = self.layout(samples);
        let count = samples.count;
        check_room(count, &layout)?;
        let own = if self.shares { self.marches(samples)? } else { vec![(0, 0); count] };
        let mut distinct: BTreeMap<March, Vec<u32>> = BTreeMap::new();
        for (sample, march) in own.iter().enumerate() {
            distinct.entry(*march).or_default().push(sample as u32);
        }
        let marches: Vec<March> = distinct.keys().copied().collect();
        let number: BTreeMap<March, u32> = marches.iter().zip(0..).map(|(&march, i)| (march, i)).collect();
        let of_samples: Vec<u32> = own.iter().map(|march| number[march]).collect();
        drop(own);
        let go_on = || !progress.stop.load(Ordering::Relaxed);
        let mut tables: Vec<Arc<Table>> = Vec::new();
        for &march in marches.iter().filter(|_| self.shares) {
            if !go_on() {
                return Err(Error::Interrupted);
            }
            tables.push(Arc::new(self.table(march)));
        }
        let couplings = vec![OnceLock::new(); marches.len()];
        let order: Vec<u32> = distinct.values().flatten().copied().collect();
        let mut results = Results {
            layout,
            numbers: vec![0.0; count * layout.width()],
            instants: vec![0; count * layout.instants()],
            marches: of_samples,
            digests: vec![0; count],
            failures: Vec::new(),
        };
        let failures = Mutex::new(Vec::new());
        // A few portions for every thread, in whole groups of lanes.
        let share = count.div_ceil(4 * workers.threads).next_multiple_of(SAMPLES).max(SAMPLES);
        let portions = portions(&distinct, &mut results, workers.chunk.min(share));
        let work = || {
            portions.into_par_iter().try_for_each(|portion| {
                let Portion { march, members, mut records, digests } = portion;
                let mut failed = Vec::new();
                let (kind, _) = marches[march];
                if self.shares {
                    let (table, couplings) = (&tables[march], &couplings[march]);
                    let task = Task { study: self, layout, samples, kind, table, couplings };
                    let (records, failed, go_on) = (&mut records[..], &mut failed, &go_on);
                    simd::with(workers.isa, Part { task, members, records, failed, go_on })?;
                } else {
                    for (&member, record) in members.iter().zip(&mut records) {
                        let sample = member as usize;
                        match alone::cross(self, &layout, samples, sample, record, &mut || go_on()) {
                            Ok(()) => {}
                            Err(Error::Interrupted) => return Err(Error::Interrupted),
                            Err(cause) => {
                                record.forget();
                                failed.push(Failure { sample, step: None, cause });
                            }
                        }
                    }
                }
                for (record, digest) in records.iter().zip(digests) {
                    *digest = record.digest();
                }
                if !failed.is_empty() {
                    failures.lock().unwrap_or_else(|e| e.into_inner()).extend(failed);
                }
                progress.done.fetch_add(members.len(), Ordering::Relaxed);
                if go_on() { Ok(()) } else { Err(Error::Interrupted) }
            })
        };
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(workers.threads.min(count.max(1)))
            .thread_name(|i| format!("spanwise-{i}"))
            // For as long as the thread lives.
            .start_handler(|_| std::mem::forget(Standard::set()))
            .build()
            .map_err(|e| Error::input("threads", workers.threads, e.to_string()))?;
        pool.install(work)?;
        results.failures = failures.into_inner().unwrap_or_else(|e| e.into_inner());
        results.failures.sort_by_key(|failure| failure.sample);
        if marches.len() > 1 {
            put_back(&order, &mut results);
        }
        let refinements = marches.iter().map(|(_, halvings)| *halvings).collect();
        let statics = marches.iter().zip(&tables).filter(|_| !layout.own_statics);
        let at_rest = statics.map(|((kind, _), table)| together::at_rest(self, *kind, table)).collect();
        Ok(Run { results, tables, refinements, at_rest })
    }

    /// Refuses factors on what a vehicle does not have.
    fn check_factors(&self, samples: &Samples) -> Result<(), Error> {
        for factors in &samples.factors {
            let parameter = factors.parameter;
            let of_bridge = matches!(parameter, Parameter::BridgeStiffness | Parameter::BridgeDamping);
            for passage in self.kinds.iter().flat_map(|kind| &kind.passages) {
                let vehicle = &passage.vehicle;
                let train = vehicle.bodies().is_empty();
                let name = parameter.name();
                if train && !of_bridge && parameter != Parameter::BodyMass {
                    let what = match vehicle.assembly().contacts[0].law {
                        ContactLaw::Force => "forces",
                        _ => "masses",
                    };
                    let allowed = format!("a train of {what} has no such thing, only body_mass");
                    return Err(Error::input("factors", format!("\"{name}\""), allowed));
                }
                let locked = vehicle.axles().iter().any(|axle| axle.friction.limit.is_infinite());
                if locked && matches!(parameter, Parameter::FrictionLimit | Parameter::InitialFriction) {
                    let allowed = "not with locked suspensions, whose friction has no limit";
                    return Err(Error::input("factors", format!("\"{name}\""), allowed));
                }
            }
        }
        Ok(())
    }
}

/// Refuses more samples than can be numbered, or than there is memory for: a mistyped number is told at once.
fn check_room(count: usize, layout: &Layout) -> Result<(), Error> {
    let bytes = count as f64 * (8 * layout.width() + 4 * layout.instants() + 40) as f64;
    if u32::try_from(count).is_ok() && bytes <= memory() {
        return Ok(());
    }
    let allowed = format!("results would take {:.1} GB of memory, more than there is; use fewer", bytes / 1e9);
    Err(Error::input("samples", count, allowed))
}

/// Memory of this machine [bytes]; where it does not say, what an address can reach. To ask the allocator would not help:
/// many systems promise more than they have.
fn memory() -> f64 {
    let told = std::fs::read_to_string("/proc/meminfo").ok().and_then(|text| {
        let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
        line.trim().trim_end_matches(" kB").parse::<f64>().ok()
    });
    told.map_or(isize::MAX as f64, |kilobytes| 1024.0 * kilobytes)
}

/// What a run leaves, with the tables that its instants refer to.
#[derive(Debug)]
pub struct Run {
    /// The results.
    pub results: Results,
    /// By march.
    pub tables: Vec<Arc<Table>>,
    /// How often the step was halved, by march.
    pub refinements: Vec<u32>,
    /// Static extremes in these steps, largest of all responses looked at, then smallest, by march; none if samples have
    /// their own.
    pub at_rest: Vec<Vec<f64>>,
}

impl Run {
    /// Time [s] and position of the front axle [m] at an instant of a sample that shares the geometry.
    pub fn when(&self, study: &Study, samples: &Samples, sample: usize, instant: u32) -> (f64, f64) {
        let table = &self.tables[self.results.marches[sample] as usize];
        let h = table.path.advance / samples.speed(sample, 0);
        match record::stop_or_step(instant) {
            Ok(stop) => {
                let stop = &table.stops[stop];
                (stop.when(h), stop.position)
            }
            Err(step) => {
                let (time, position) = (step as f64 * h, table.path.x(step, 0));
                let (last, fraction) = together::end(table.path.steps, h, study.settings.tail);
                if step < last || fraction == 1.0 {
                    return (time, position);
                }
                let (before, behind) = ((step - 1) as f64 * h, table.path.x(step - 1, 0));
                (before + fraction * (time - before), behind + fraction * (position - behind))
            }
        }
    }
}

/// What a worker takes at a time.
struct Portion<'a> {
    march: usize,
    members: &'a [u32],
    records: Vec<Record<'a>>,
    digests: &'a mut [u64],
}

/// The samples of each march in portions, with the rows that they fill, which follow each other in this order.
fn portions<'a>(distinct: &'a BTreeMap<March, Vec<u32>>, results: &'a mut Results, chunk: usize) -> Vec<Portion<'a>> {
    let (width, instants) = (results.layout.width(), results.layout.instants());
    let mut numbers = &mut results.numbers[..];
    let mut moments = &mut results.instants[..];
    let mut digests = &mut results.digests[..];
    let mut portions = Vec::new();
    for (march, members) in distinct.values().enumerate() {
        for members in members.chunks(chunk) {
            let n = members.len();
            let (own_numbers, rest_numbers) = std::mem::take(&mut numbers).split_at_mut(n * width);
            let (own_moments, rest_moments) = std::mem::take(&mut moments).split_at_mut(n * instants);
            let (own_digests, rest_digests) = std::mem::take(&mut digests).split_at_mut(n);
            (numbers, moments, digests) = (rest_numbers, rest_moments, rest_digests);
            let rows = own_numbers.chunks_exact_mut(width).zip(own_moments.chunks_exact_mut(instants.max(1)));
            let records = rows.map(|(numbers, instants)| Record { numbers, instants }).collect();
            portions.push(Portion { march, members, records, digests: own_digests });
        }
    }
    portions
}

/// Puts rows that follow each other as in `order` in the order of the samples.
fn put_back(order: &[u32], results: &mut Results) {
    let (width, instants) = (results.layout.width(), results.layout.instants());
    let mut from: Vec<u32> = vec![0; order.len()];
    for (row, &sample) in order.iter().enumerate() {
        from[sample as usize] = row as u32;
    }
    for sample in 0..from.len() {
        // Round each cycle: the row that belongs here comes in exchange for the one that stands here.
        let mut here = sample;
        while from[here] as usize != sample {
            let there = from[here] as usize;
            swap_rows(&mut results.numbers, width, here, there);
            swap_rows(&mut results.instants, instants, here, there);
            results.digests.swap(here, there);
            from[here] = here as u32;
            here = there;
        }
        from[here] = here as u32;
    }
}

fn swap_rows<T>(values: &mut [T], width: usize, a: usize, b: usize) {
    let (a, b) = (a.min(b), a.max(b));
    let (low, high) = values.split_at_mut(b * width);
    low[a * width..(a + 1) * width].swap_with_slice(&mut high[..width]);
}
