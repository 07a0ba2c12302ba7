//! Many crossings of one bridge: samples side by side in the lanes of one step, block after block on all cores.
//!
//! With prescribed motion in equal steps of space, where the axles are and what their loads do to the bridge is the
//! same for every sample, whatever its speed, its road or its springs: one [`table`] serves all. A sample's result is a
//! function of the plan, the seed and its own number, to the bit: not of the number of threads, of the width of the
//! vectors, or of its neighbours.

pub mod block;
pub mod simd;
pub mod table;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::analysis::Analysis;
use crate::course::Drive;
use crate::crossing::cross;
use crate::envelope::{Envelope, Extreme};
use crate::error::{Error, positive};
use crate::lane::Lane;
use crate::path::{Pavement, fade};
use crate::road::random::Synthesis;
use crate::road::spline::Taps;
use crate::settings::Settings;
use crate::step::{Moving, Propulsion, Scheme, Stepper, Surface};
use crate::survey::survey;
use crate::vehicle::Vehicle;
use block::{Seen, Watched};
use simd::Isa;
use table::{Below, Table};

/// The road of the samples.
#[derive(Debug, Clone)]
pub enum Roads {
    /// That of the settings, the same for all.
    Given,
    /// An own random road for each sample.
    Random {
        /// What they share.
        synthesis: Arc<Synthesis>,
        /// Seed of the study.
        seed: u64,
    },
}

/// Everything that the samples of a study share.
#[derive(Debug)]
pub struct Plan {
    analysis: Arc<Analysis>,
    vehicle: Vehicle,
    settings: Settings,
    roads: Roads,
    /// Way per step [m].
    advance: f64,
    table: Table,
    /// Static extremes, the same for all samples.
    at_rest: Envelope,
}

/// One sample of a study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Its number, which names its road.
    pub number: u64,
    /// Speed [m/s].
    pub speed: f64,
}

/// Extremes of a response in a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// Largest.
    pub max: Extreme,
    /// Smallest.
    pub min: Extreme,
}

/// What a sample gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// By response.
    pub responses: Vec<Found>,
    /// By axle.
    pub loads: Vec<Found>,
    /// By axle: standard deviation of the load by its static value.
    pub load_coefficients: Vec<f64>,
    /// By axle: time off the road [s].
    pub aloft: Vec<f64>,
}

impl Plan {
    /// For crossings by `vehicle` at constant speed from left to right, in steps of `advance` [m] at most.
    pub fn new(
        analysis: Arc<Analysis>,
        vehicle: &Vehicle,
        settings: &Settings,
        advance: f64,
        roads: Roads,
    ) -> Result<Self, Error> {
        if settings.drive != Drive::ConstantSpeed {
            let allowed = "samples move at constant speed: others do not share the geometry";
            return Err(Error::input("drive", format!("{:?}", settings.drive), allowed));
        }
        positive("advance", advance)?;
        let assembly = vehicle.assembly();
        let length = analysis.model.shapes.mesh().length();
        let front = assembly.contacts[0].position;
        let behind: Vec<f64> = assembly.contacts.iter().map(|c| front - c.position).collect();
        let wheelbase = behind[behind.len() - 1];
        let path = settings.approach + length + wheelbase;
        let steps = (path / advance - 1e-9).ceil().max(1.0) as usize;
        let advance = path / steps as f64;
        let (start, end) = (-settings.approach, length + wheelbase);
        if let Roads::Random { synthesis, .. } = &roads
            && path > synthesis.period()
        {
            let allowed = format!("it repeats after its period of {} m, and the path is longer", synthesis.period());
            return Err(Error::input("road", format!("path from {start} m to {end} m"), allowed));
        }
        let pavement = Pavement { road: &settings.road, start, end, ramp: settings.ramp, direction: 1.0 };
        let below = |x: f64| match &roads {
            Roads::Given => Below::Given(pavement.at(x)),
            Roads::Random { synthesis, .. } => {
                let way = x - start;
                if way <= 0.0 && settings.ramp > 0.0 {
                    return Below::Given(Surface::LEVEL);
                }
                let faded = match way >= settings.ramp || settings.ramp == 0.0 {
                    true => [1.0, 0.0],
                    false => {
                        let [value, slope, _] = fade(way / settings.ramp, settings.ramp);
                        [value, slope]
                    }
                };
                Below::Own(Taps::new(x, synthesis.points(), synthesis.period()), faded)
            }
        };
        let slopes = !assembly.contacts.iter().all(|contact| contact.law.is_plain());
        let table = Table::new(
            &analysis.model.shapes,
            &analysis.rows,
            &analysis.responses,
            behind.len(),
            steps,
            |step, axle| start + advance * step as f64 - behind[axle],
            slopes,
            below,
        );
        let smooth = Settings {
            step: Some(advance / settings.speed),
            road: Arc::new(crate::road::Road::smooth()),
            ..settings.clone()
        };
        let history = cross(&analysis.model, vehicle, &smooth, &mut || true)?;
        let packed = analysis.rows.pack_history(&history);
        let at_rest = survey(&history, &analysis.rows, &packed, &analysis.responses, &mut || true)?;
        Ok(Plan { analysis, vehicle: vehicle.clone(), settings: settings.clone(), roads, advance, table, at_rest })
    }

    /// The static extremes.
    pub fn at_rest(&self) -> &Envelope {
        &self.at_rest
    }

    /// Number of steps of every sample.
    pub fn steps(&self) -> usize {
        self.table.steps
    }

    fn stepper(&self, sample: &Sample, still: bool) -> Stepper<f64> {
        let h = if still { 0.0 } else { self.advance / sample.speed };
        let Settings { beta, gravity, lift_off, .. } = self.settings;
        let moving = [Moving { assembly: self.vehicle.assembly(), propulsion: Propulsion::Prescribed, direction: 1.0 }];
        let model = &self.analysis.model;
        Stepper::new(&model.omega, &model.damping, &moving, &Scheme { h, beta, gravity, lift_off })
    }

    /// One block of samples in the lanes of L; missing ones are filled up with the last. Public so that a lane of another
    /// kind, such as one that counts, goes through what the samples of a study go through.
    #[inline(always)]
    pub fn block<L: Lane>(&self, samples: &[Sample]) -> Result<Vec<Outcome>, Error> {
        let of = |lane: usize| &samples[lane.min(samples.len() - 1)];
        let steppers: Vec<Stepper<f64>> = (0..L::SAMPLES).map(|lane| self.stepper(of(lane), false)).collect();
        let starters: Vec<Stepper<f64>> = (0..L::SAMPLES).map(|lane| self.stepper(of(lane), true)).collect();
        let road: Vec<L> = match &self.roads {
            Roads::Given => Vec::new(),
            Roads::Random { synthesis, seed } => synthesis.coefficients(*seed, |lane| of(lane).number),
        };
        let speed = L::from_fn(|lane| of(lane).speed);
        let mut stepper = Stepper::<L>::gather(&steppers);
        let mut starter = Stepper::<L>::gather(&starters);
        match block::march(&self.table, &self.analysis.rows, &mut stepper, &mut starter, &road, speed) {
            Ok(seen) => {
                Ok(samples.iter().enumerate().map(|(lane, sample)| self.outcome(&seen, lane, sample)).collect())
            }
            Err(_) => Err(Error::NoConvergence { what: "contact forces", time: f64::NAN, position: f64::NAN }),
        }
    }

    fn outcome<L: Lane>(&self, seen: &Seen<L>, lane: usize, sample: &Sample) -> Outcome {
        let h = self.advance / sample.speed;
        let at_step = |value: L, at: L| {
            let step = at.get(lane);
            let position = self.table.x(step as usize, 0);
            Extreme { value: value.get(lane), time: step * h, position, partner: f64::NAN }
        };
        let at_stop = |value: L, at: L| {
            let stop = &self.table.stops[at.get(lane) as usize];
            let (before, after) = ((stop.step - 1) as f64 * h, stop.step as f64 * h);
            let time = before + stop.fraction * (after - before);
            Extreme { value: value.get(lane), time, position: stop.position, partner: f64::NAN }
        };
        let found = |steps: &Watched<L>, stops: Option<&Watched<L>>| {
            let mut found = Found { max: at_step(steps.max, steps.max_at), min: at_step(steps.min, steps.min_at) };
            if let Some(stops) = stops.filter(|stops| stops.max.get(lane) > f64::NEG_INFINITY) {
                let (max, min) = (at_stop(stops.max, stops.max_at), at_stop(stops.min, stops.min_at));
                if max.value > found.max.value || (max.value == found.max.value && max.time < found.max.time) {
                    found.max = max;
                }
                if min.value < found.min.value || (min.value == found.min.value && min.time < found.min.time) {
                    found.min = min;
                }
            }
            found
        };
        let count = (self.table.steps + 1) as f64;
        let static_loads = self.vehicle.static_loads(self.settings.gravity);
        let coefficient = |k: usize| {
            let [sum, squares] = seen.sums[k].map(|s| s.get(lane));
            let mean = sum / count;
            (squares / count - mean * mean).max(0.0).sqrt() / static_loads[k]
        };
        Outcome {
            responses: seen.steps.iter().zip(&seen.stops).map(|(steps, stops)| found(steps, Some(stops))).collect(),
            loads: seen.loads.iter().map(|watched| found(watched, None)).collect(),
            load_coefficients: (0..self.table.axles).map(coefficient).collect(),
            aloft: seen.aloft.iter().map(|steps| steps.get(lane) * h).collect(),
        }
    }

    /// Runs samples one block after the other on `isa` with `threads` workers, and hands every block's outcomes to `take`
    /// in no order, with the number of its first sample.
    pub fn run(
        &self,
        samples: &[Sample],
        isa: Isa,
        threads: usize,
        take: impl Fn(usize, Vec<Outcome>) + Sync,
        go_on: impl Fn() -> bool + Sync,
    ) -> Result<(), Error> {
        let width = simd::samples(isa);
        let stopped = AtomicBool::new(false);
        let failed = AtomicUsize::new(0);
        let work = || {
            samples.par_chunks(width).enumerate().try_for_each(|(block, chunk)| {
                if stopped.load(Ordering::Relaxed) || !go_on() {
                    stopped.store(true, Ordering::Relaxed);
                    return Err(Error::Interrupted);
                }
                let outcomes = simd::run(isa, self, chunk).inspect_err(|_| {
                    failed.fetch_add(1, Ordering::Relaxed);
                })?;
                take(block * width, outcomes);
                Ok(())
            })
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.map_err(|e| Error::input("threads", threads, e.to_string()))?.install(work)
    }
}
