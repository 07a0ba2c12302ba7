//! Samples that share the geometry: made ready lane by lane, marched side by side, written down one by one.

use super::group::{
    Drawing, Ends, Engine, Found, Group, Growing, Scene, Scratch, Steppers, Trouble, cross_group, draw_roads, rest,
};
use super::results::{Column, Failure, Format, Record, encoded};
use super::sample::Samples;
use super::study::{Kind, Study};
use super::table::Table;
use super::tabulated::{Interactions, Shared, Tabulated};
use super::varied::{VariedBridge, passages};
use crate::crossing::tail;
use crate::damping::ModalDamping;
use crate::error::Error;
use crate::extremes::Seen;
use crate::lane::dispatch::InLanes;
use crate::lane::{Lane, Lanes};
use crate::passage::settings::{Settings, Tail};
use crate::passage::step_length::{bytes, room};
use crate::step::forced::Forced;
use crate::step::stepper::{Scheme, Stepper, Unsettled};
use crate::step::unit::{Moving, Propulsion};
use crate::step::vibration::most_steps;
use crate::stop_token::StopToken;
use crate::stops::Positions;
use crate::tape::BridgeFactors;
use crate::vehicle::Vehicle;

/// The static extremes of a kind as it is, in the steps of a table: the largest of the responses looked at, then the
/// smallest.
pub fn at_rest(study: &Study, kind: usize, table: &Table) -> Vec<f64> {
    let scene = Scene { table, rows: &study.analysis.rows, look: &study.look, free: &study.free, closely: false };
    let of_axles = study.vehicle(kind).static_loads(study.settings.gravity);
    let loads = if table.resultant.is_some() { vec![1.0] } else { of_axles };
    let seen = &rest::<f64>(&scene, &loads);
    let row_of = &study.look.row_of;
    let side =
        |side: usize| row_of.iter().map(move |&row| seen.sides(row, 0, |instant| table.when(instant, 1.0))[side].0);
    side(0).chain(side(1)).collect()
}

/// What samples that march together share.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// The study.
    pub study: &'a Study,
    /// Where things go.
    pub format: Format,
    /// All samples of the run.
    pub samples: &'a Samples,
    /// The kind of event.
    pub kind: usize,
    /// Its geometry, and what its steps have in common.
    pub shared: &'a Shared,
}

/// Some of these samples, with room for what comes of them.
pub struct Part<'s, 'a> {
    /// What they share.
    pub task: Task<'s>,
    /// Their numbers.
    pub members: &'s [u32],
    /// Where each is written down.
    pub records: &'s mut [Record<'a>],
    /// Where those that fail are.
    pub failed: &'s mut Vec<Failure>,
    /// Whether to go on.
    pub stop: StopToken<'s>,
}

impl InLanes for Part<'_, '_> {
    type Output = Result<(), Error>;

    fn run<L: Lanes>(self) -> Self::Output {
        let Part { task, members, records, failed, stop } = self;
        task.run::<L>(members, records, failed, stop)
    }
}

/// What has been seen of a group.
struct Crossed<L> {
    found: Found<L>,
    /// Of the static responses, if they differ from sample to sample.
    at_rest: Option<Seen<L>>,
    /// How far free vibration can exceed it, and where: see [`crate::crossing::tail::FreeRows::growth`].
    growth: [L; 2],
    /// The last step of each.
    last: L,
}

/// How one sample comes from step to step.
enum Moves {
    /// Bridge and vehicle together: how it starts, on the approach, on the bridge.
    Coupled(Box<[Stepper<f64>; 3]>),
    /// The bridge alone, by circular frequency [rad/s] and rate of damping [1/s] of each mode, in steps of a time [s].
    Driven { modes: Vec<[f64; 2]>, h: f64 },
}

impl Moves {
    /// Those of the samples in the lanes, which have the same ways.
    fn gather<'a, L: Lane>(each: impl Fn(usize) -> &'a Ready) -> Gathered<L> {
        match &each(0).moves {
            Moves::Coupled(_) => {
                let stepper = |which: usize| {
                    let of = |lane: usize| match &each(lane).moves {
                        Moves::Coupled(steppers) => Some(&steppers[which]),
                        Moves::Driven { .. } => None,
                    };
                    Stepper::<L>::gather(&(0..L::SAMPLES).filter_map(of).collect::<Vec<_>>())
                };
                Gathered::Coupled(Box::new(Steppers { starter: stepper(0), approach: stepper(1), bridge: stepper(2) }))
            }
            Moves::Driven { modes, .. } => {
                let of_mode = |m: usize, which: usize| {
                    L::from_fn(|lane| match &each(lane).moves {
                        Moves::Driven { modes, .. } => modes[m][which],
                        Moves::Coupled(_) => f64::NAN,
                    })
                };
                let h = L::from_fn(|lane| match &each(lane).moves {
                    Moves::Driven { h, .. } => *h,
                    Moves::Coupled(_) => f64::NAN,
                });
                let [omega, rates]: [Vec<L>; 2] =
                    [0, 1].map(|which| (0..modes.len()).map(|m| of_mode(m, which)).collect());
                let forced = Forced::new(&omega, &rates, h);
                let load = |k: usize| L::from_fn(|lane| each(lane).static_loads[k]);
                Gathered::Driven(forced, (0..each(0).static_loads.len()).map(load).collect())
            }
        }
    }
}

/// The same of the samples in the lanes.
enum Gathered<L> {
    Coupled(Box<Steppers<L>>),
    Driven(Forced<L>, Vec<L>),
}

/// One sample made ready.
struct Ready {
    /// See [`Stepper::ways`].
    ways: Vec<bool>,
    moves: Moves,
    bridge: Option<BridgeFactors<f64>>,
    /// ω² of its slowest mode.
    slowest: f64,
    static_loads: Vec<f64>,
}

impl Task<'_> {
    fn cause(&self, sample: usize, step: usize, unsettled: Option<Unsettled>) -> Error {
        let time = step as f64 * self.step(sample);
        let position = self.shared.table.path.x(step.saturating_sub(1), 0);
        match unsettled {
            Some(unsettled) => Error::NoConvergence { what: unsettled.name(), step, time, position },
            None => Error::NotFinite { step, time, position },
        }
    }

    /// Time of a step of a sample [s].
    fn step(&self, sample: usize) -> f64 {
        self.shared.table.path.advance / self.samples.speed(sample, 0)
    }

    /// Most steps of a tail that is not given.
    fn most(&self, sample: usize, ready: &Ready) -> usize {
        let (axles, modes) = (self.shared.table.axles(), self.shared.table.modes);
        let assembly = self.study.vehicle(self.kind).assembly();
        let bytes = bytes(modes, axles, assembly.mass.nrows() + 1, assembly.frictions.len());
        let room = room(self.shared.table.path.steps as f64, bytes);
        most_steps(ready.slowest, self.step(sample), room)
    }

    fn ready(&self, sample: usize) -> Result<Ready, Error> {
        let passages = passages(self.study, self.samples, sample)?;
        let vehicle = &passages[0].vehicle;
        let model = &self.study.analysis.model;
        let varied = VariedBridge::of(model, self.samples, sample);
        let there = varied.as_ref().map_or((&model.omega[..], &model.damping), |v| (&v.omega[..], &v.damping));
        let h = self.step(sample);
        let slowest = there.0.iter().fold(f64::INFINITY, |least, w| w.powi(2).min(least));
        let moves = match there.1.rates(there.0).filter(|_| self.shared.table.drive.is_some()) {
            Some(rates) => {
                let modes = there.0.iter().zip(rates).map(|(&omega, rate)| [omega, rate]).collect();
                Moves::Driven { modes, h }
            }
            None => self.coupled(vehicle, there, h),
        };
        let ways = match &moves {
            Moves::Coupled(steppers) => steppers.iter().flat_map(Stepper::ways).collect(),
            Moves::Driven { .. } => Vec::new(),
        };
        let static_loads = vehicle.static_loads(self.study.settings.gravity);
        Ok(Ready { slowest, ways, moves, static_loads, bridge: varied.as_ref().map(|varied| varied.factors) })
    }

    /// Bridge and vehicle together, in steps of h [s].
    fn coupled(&self, vehicle: &Vehicle, there: (&[f64], &ModalDamping), h: f64) -> Moves {
        let (assembly, propulsion) = (vehicle.assembly(), Propulsion::Prescribed);
        let moving = [Moving { assembly, propulsion, direction: 1.0, grade: 0.0 }];
        let Settings { beta, gravity, lift_off, .. } = self.study.settings;
        let stepper = |(omega, damping): (&[f64], &ModalDamping), h: f64| {
            Stepper::new(omega, damping, &moving, &Scheme { h, beta, gravity, lift_off })
        };
        let none = (&[][..], &ModalDamping::Classical(Vec::new()));
        let starter = stepper(if self.shared.table.first > 0 { none } else { there }, 0.0);
        Moves::Coupled(Box::new([starter, stepper(none, h), stepper(there, h)]))
    }

    /// Runs some samples, one group of lanes after the other; those that fail are marked.
    pub fn run<L: Lanes>(
        &self,
        members: &[u32],
        records: &mut [Record<'_>],
        failed: &mut Vec<Failure>,
        stop: StopToken<'_>,
    ) -> Result<(), Error> {
        let (mut scratch, mut roads) = (Scratch::new(), Vec::new());
        let alike = self.samples.alike();
        // One for all samples, or else for those of a group.
        let mut ready: Vec<Ready> = Vec::new();
        let mut engine: Option<Gathered<L>> = None;
        let groups = members.chunks(L::SAMPLES).zip(records.chunks_mut(L::SAMPLES));
        for (members, records) in groups {
            // Places in the group of those that are marched.
            let mut places: Vec<usize> = (0..members.len()).collect();
            if !alike || ready.is_empty() {
                let (made, sound) = self.ready_all(members, records, failed);
                (ready, places, engine) = (made, sound, None);
            }
            // Side by side go those whose steps take the same ways, as nearly always all do.
            let mut first = 0;
            while first < places.len() {
                let last = match alike {
                    true => places.len(),
                    false => first + ready[first..].partition_point(|other| other.ways == ready[first].ways),
                };
                let (places, ready) = (&places[first..last], if alike { &ready[..] } else { &ready[first..last] });
                first = last;
                if !alike {
                    engine = None;
                }
                // First all side by side; then each that has failed, or all where it is not known which, in all lanes
                // alone, to see when. Others come to the same as side by side.
                let own_scratch = (&mut scratch, &mut roads);
                let mut again: Vec<usize> = (0..places.len()).collect();
                match self.group(members, places, ready, false, &mut engine, own_scratch, stop) {
                    Ok(group) => again.retain(|&lane| {
                        let place = places[lane];
                        !self.write(&group, lane, ready, members[place], &mut records[place])
                    }),
                    Err(Trouble::Interrupted) => return Err(Error::Interrupted),
                    Err(Trouble::Failed(..)) => {}
                }
                for lane in again {
                    let place = places[lane];
                    let sample = members[place] as usize;
                    let own = if alike { ready } else { &ready[lane..=lane] };
                    let own_scratch = (&mut scratch, &mut roads);
                    let (step, unsettled) = match self.group(members, &[place], own, true, &mut None, own_scratch, stop)
                    {
                        Ok(group) if self.write(&group, 0, own, members[place], &mut records[place]) => continue,
                        // No step shows it, but sums of squares do.
                        Ok(group) => (group.last.get(0) as usize, None),
                        Err(Trouble::Interrupted) => return Err(Error::Interrupted),
                        Err(Trouble::Failed(step, unsettled)) => (step, unsettled),
                    };
                    records[place].forget();
                    failed.push(Failure { sample, step: Some(step), cause: self.cause(sample, step, unsettled) });
                }
            }
        }
        Ok(())
    }

    /// Samples made ready, those that take the same ways next to each other, with their places; of samples that are
    /// alike only one. A vehicle that cannot be is a failure.
    fn ready_all(
        &self,
        members: &[u32],
        records: &mut [Record<'_>],
        failed: &mut Vec<Failure>,
    ) -> (Vec<Ready>, Vec<usize>) {
        let mut ready: Vec<(Ready, usize)> = Vec::with_capacity(members.len());
        for (place, &member) in members.iter().enumerate() {
            match self.ready(member as usize) {
                Ok(one) if self.samples.alike() => return (vec![one], (0..members.len()).collect()),
                Ok(one) => ready.push((one, place)),
                Err(cause) => {
                    records[place].forget();
                    failed.push(Failure { sample: member as usize, step: None, cause });
                }
            }
        }
        ready.sort_by(|a, b| a.0.ways.cmp(&b.0.ways));
        ready.into_iter().unzip()
    }

    /// One group of lanes, filled up with its last sample, marched to the end.
    #[allow(clippy::too_many_arguments)] // each is one thing
    fn group<L: Lanes>(
        &self,
        members: &[u32],
        places: &[usize],
        ready: &[Ready],
        closely: bool,
        engine: &mut Option<Gathered<L>>,
        (scratch, roads): (&mut Scratch<L>, &mut Vec<L>),
        stop: StopToken<'_>,
    ) -> Result<Crossed<L>, Trouble> {
        let Task { study, samples, .. } = *self;
        let Shared { table, interactions } = self.shared;
        let kind: &Kind = &study.kinds[self.kind];
        let scene = Scene { table, rows: &study.analysis.rows, look: &study.look, free: &study.free, closely };
        let sample_of = |lane: usize| members[places[lane.min(places.len() - 1)]] as usize;
        let ready_of = |lane: usize| &ready[lane.min(ready.len() - 1)];
        let engine = engine.get_or_insert_with(|| Moves::gather(ready_of));
        if let Some((synthesis, seed)) = study.own.as_ref().filter(|_| table.drive.is_none()) {
            let sample = |lane: usize| samples.first + sample_of(lane) as u64;
            draw_roads(Drawing { synthesis, seed: *seed, sample, road: roads });
        }
        let ended = |lane: usize| match study.settings.tail {
            Tail::Fixed(tail) => {
                let (steps, h) = (table.path.steps, self.step(sample_of(lane)));
                tail::end(steps as f64 * h, steps, h, tail)
            }
            Tail::Free => (table.path.steps + self.most(sample_of(lane), ready_of(lane)), 1.0),
        };
        let ends = Ends {
            last: L::from_fn(|lane| ended(lane).0 as f64),
            fraction: L::from_fn(|lane| ended(lane).1),
            latest: (0..places.len()).map(|lane| ended(lane).0).max().unwrap_or(0),
            free: study.settings.tail == Tail::Free,
        };
        let bridge = ready_of(0).bridge.is_some().then(|| {
            let of = |f: fn(BridgeFactors<f64>) -> f64| L::from_fn(|lane| ready_of(lane).bridge.map_or(1.0, f));
            BridgeFactors { coordinates: of(|b| b.coordinates), rates: of(|b| b.rates) }
        });
        let speed = L::from_fn(|lane| samples.speed(sample_of(lane), 0));
        // Constant loads feel neither road nor bridge.
        let mut engine = match engine {
            Gathered::Driven(forced, loads) => Engine::Driven(forced, loads),
            Gathered::Coupled(steppers) => {
                let interactions = (samples.alike() && table.laid_out).then(|| {
                    interactions.get_or_init(|| match &ready_of(0).moves {
                        Moves::Coupled(own) => Interactions::new(table, &mut own[2].clone(), speed.get(0)),
                        Moves::Driven { .. } => Interactions::default(),
                    })
                });
                Engine::Coupled(steppers, Tabulated::new(table, roads, speed, interactions))
            }
        };
        let mut group = Group { bridge, ends, bodies: &kind.bodies };
        let found = cross_group(&scene, &mut group, &mut engine, scratch, stop)?;
        let at_rest = self.format.own_statics.then(|| {
            let of = |k: usize| L::from_fn(|lane| ready_of(lane).static_loads[k]);
            let loads = (0..table.axles()).map(of).collect();
            rest(&scene, &if table.resultant.is_some() { vec![L::splat(1.0)] } else { loads })
        });
        let growth = L::dispatch(Growing { free: &study.free, found: &found });
        Ok(Crossed { found, at_rest, growth, last: group.ends.last })
    }

    /// Writes down what was seen of a sample, and says whether all of it is finite.
    fn write<L: Lane>(
        &self,
        group: &Crossed<L>,
        lane: usize,
        ready: &[Ready],
        member: u32,
        record: &mut Record<'_>,
    ) -> bool {
        let Ready { bridge, static_loads, .. } = &ready[lane.min(ready.len() - 1)];
        self.write_numbers(group, lane, member as usize, (bridge.as_ref(), static_loads), record);
        let bodies = self.study.kinds[self.kind].bodies.len();
        self.format.is_finite(record.numbers, self.shared.table.axles(), bodies)
    }

    fn write_numbers<L: Lane>(
        &self,
        Crossed { found, at_rest, growth, last }: &Crossed<L>,
        lane: usize,
        sample: usize,
        (bridge, static_loads): (Option<&BridgeFactors<f64>>, &[f64]),
        record: &mut Record<'_>,
    ) {
        let (format, look) = (&self.format, &self.study.look);
        let responses = format.responses;
        record.forget();
        let h = self.step(sample);
        let when = |instant| self.shared.table.when(instant, h);
        let start = format.range(Column::Responses).start;
        for (place, (&row, &quantity)) in look.row_of.iter().zip(&look.quantities).enumerate() {
            let k = bridge.map_or(1.0, |factors| factors.of(quantity));
            for (side, (value, instant)) in found.seen.sides(row, lane, when).into_iter().enumerate() {
                record.numbers[start + side * responses + place] = value / k;
                record.instants[side * responses + place] = encoded(instant);
            }
            if let Some(at_rest) = at_rest {
                let start = format.range(Column::Statics).start;
                for (side, (value, _)) in at_rest.sides(row, lane, when).into_iter().enumerate() {
                    record.numbers[start + side * responses + place] = value / k;
                }
            }
        }
        let start = format.range(Column::Tail).start;
        let tail = match self.study.settings.tail {
            Tail::Fixed(tail) => tail,
            Tail::Free => (last.get(lane) - self.shared.table.path.steps as f64) * h,
        };
        let [growth, side] = growth.map(|each| each.get(lane));
        record.numbers[start..start + 3].copy_from_slice(&[tail, growth, look.side(side)]);
        record.write_ride(format, &found.ride, lane, [0, 0], static_loads, h);
        for (k, peaks) in found.ride.loads.iter().enumerate() {
            for (side, at) in [peaks.max_at, peaks.min_at].into_iter().enumerate() {
                record.instants[2 * responses + side * format.axles + k] = at.get(lane) as u32;
            }
        }
    }
}
