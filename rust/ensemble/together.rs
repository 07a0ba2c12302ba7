//! Samples that share the geometry: made ready lane by lane, marched side by side, written down one by one.

use super::alone::{Scaled, passages};
use super::block::{Bridge, Ends, Group, Seen, Shared, Trouble, Way, march, rest};
use super::record::{Column, Failure, Layout, Record, instant_of_stop};
use super::sample::Samples;
use super::simd::{Isa, Work, dispatch};
use super::table::Table;
use super::watch::Watched;
use super::{Kind, Study};
use crate::error::Error;
use crate::lane::Lane;
use crate::modal::ModalDamping;
use crate::step::{Moving, Propulsion, Scheme, Stepper, Unsettled};
use crate::vehicle::Vehicle;

/// The last step of a crossing of so many steps of h [s] with a tail [s], and how far through that step it ends.
pub fn end(steps: usize, h: f64, tail: f64) -> (usize, f64) {
    if tail == 0.0 {
        return (steps, 1.0);
    }
    let end = steps as f64 * h + tail;
    let mut last = steps.max((end / h) as usize);
    // The first step that comes so far, as a single crossing counts them one by one.
    while last > steps && (last - 1) as f64 * h >= end - 1e-9 * h {
        last -= 1;
    }
    while (last as f64) * h < end - 1e-9 * h {
        last += 1;
    }
    let time = last as f64 * h;
    (last, if time > end + 1e-9 * h { 1.0 - (time - end) / h } else { 1.0 })
}

/// The static extremes of a kind as it is: the largest of the responses looked at, then the smallest.
pub fn at_rest(study: &Study, kind: usize) -> Result<Vec<f64>, Error> {
    let table = study.table((kind, 0));
    let way = Way { table: &table, rows: &study.analysis.rows, look: &study.look, closely: false };
    let loads = study.vehicle(kind).static_loads(study.settings.gravity);
    let seen = rest::<f64>(&way, &loads);
    let row_of = &study.look.row_of;
    let largest = row_of.iter().map(|&row| extremes(&table, 1.0, &seen, row, 0)[0].0);
    let smallest = row_of.iter().map(|&row| extremes(&table, 1.0, &seen, row, 0)[1].0);
    Ok(largest.chain(smallest).collect())
}

/// Largest and smallest of a row in one lane in steps of h [s], each with its instant.
fn extremes<L: Lane>(table: &Table, h: f64, seen: &Seen<L>, row: usize, lane: usize) -> [(f64, u32); 2] {
    let pick = |of: fn(&Watched<L>) -> (L, L), sense: f64| {
        let number = |watched: &Watched<L>| {
            let (value, at) = of(watched);
            (value.get(lane), at.get(lane))
        };
        let ((at_step, step), (at_stop, stop)) = (number(&seen.steps[row]), number(&seen.stops[row]));
        // At a stop and at a step alike, the earlier counts, and if they are one instant the stop.
        let better = sense * at_stop > sense * at_step;
        let earlier = at_stop == at_step && table.stops[stop as usize].when(h) <= step * h;
        if better || earlier { (at_stop + 0.0, instant_of_stop(stop as usize)) } else { (at_step + 0.0, step as u32) }
    };
    [pick(|w| (w.max, w.max_at), 1.0), pick(|w| (w.min, w.min_at), -1.0)]
}

/// What samples that march together share.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// The study.
    pub study: &'a Study,
    /// Where things go.
    pub layout: Layout,
    /// All samples of the run.
    pub samples: &'a Samples,
    /// The kind of event.
    pub kind: usize,
    /// Its geometry.
    pub table: &'a Table,
}

/// One sample made ready.
struct Ready {
    starter: Stepper<f64>,
    approach: Stepper<f64>,
    stepper: Stepper<f64>,
    bridge: Option<Bridge<f64>>,
    /// Factor of the bridge's stiffness.
    stiffness: f64,
    static_loads: Vec<f64>,
}

/// Samples to be marched, compiled once for each instruction set.
struct March<'t, 'a, 'r> {
    task: &'t Task<'a>,
    members: &'t [u32],
    records: &'t mut [&'r mut Record<'a>],
    closely: bool,
    go_on: &'t dyn Fn() -> bool,
}

impl Work for March<'_, '_, '_> {
    type Output = Result<Vec<Failure>, Trouble>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Self::Output {
        self.task.block::<L>(self.members, self.records, self.closely, self.go_on)
    }
}

impl<'a> Task<'a> {
    /// Runs some samples side by side; those that fail are marked.
    pub fn run(
        &self,
        isa: Isa,
        members: &[u32],
        records: &mut [Record<'a>],
        failed: &mut Vec<Failure>,
        go_on: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        let mut all: Vec<&mut Record<'a>> = records.iter_mut().collect();
        let march = March { task: self, members, records: &mut all, closely: false, go_on };
        match dispatch(isa, march) {
            Ok(failures) => {
                failed.extend(failures);
                return Ok(());
            }
            Err(Trouble::Interrupted) => return Err(Error::Interrupted),
            Err(Trouble::Failed(..)) => {}
        }
        // Somebody failed: one by one they show who, and the others come to the same as side by side.
        for (&member, record) in members.iter().zip(records) {
            let sample = member as usize;
            let mut own = [&mut *record];
            let march = March { task: self, members: &[member], records: &mut own, closely: true, go_on };
            match dispatch(isa, march) {
                Ok(failures) => failed.extend(failures),
                Err(Trouble::Interrupted) => return Err(Error::Interrupted),
                Err(Trouble::Failed(step, unsettled)) => {
                    record.forget();
                    failed.push(Failure { sample, step: Some(step), cause: self.cause(sample, step, unsettled) });
                }
            }
        }
        Ok(())
    }

    fn cause(&self, sample: usize, step: usize, unsettled: Option<Unsettled>) -> Error {
        let time = step as f64 * self.table.path.advance / self.samples.speed(sample, 0);
        let position = self.table.path.x(step.saturating_sub(1), 0);
        match unsettled {
            Some(unsettled) => Error::NoConvergence { what: unsettled.name(), time, position },
            None => Error::NotFinite { time, position },
        }
    }

    fn step(&self, sample: usize) -> f64 {
        self.table.path.advance / self.samples.speed(sample, 0)
    }

    /// Steppers of a sample: for its first instant, for the approach and for the bridge.
    fn steppers<L: Lane>(&self, vehicle: &Vehicle, omega: &[f64], damping: &ModalDamping, h: f64) -> [Stepper<L>; 3] {
        let moving = [Moving { assembly: vehicle.assembly(), propulsion: Propulsion::Prescribed, direction: 1.0 }];
        let crate::settings::Settings { beta, gravity, lift_off, .. } = self.study.settings;
        let none = (&[][..], &ModalDamping::Classical(Vec::new()));
        let there = (omega, damping);
        let started = if self.table.first > 0 { none } else { there };
        [(started, 0.0), (none, h), (there, h)]
            .map(|((omega, damping), h)| Stepper::new(omega, damping, &moving, &Scheme { h, beta, gravity, lift_off }))
    }

    fn ready(&self, sample: usize) -> Result<Ready, Error> {
        let passages = passages(self.study, self.samples, sample)?;
        let vehicle = &passages[0].vehicle;
        let model = &self.study.analysis.model;
        let scaled = Scaled::of(model, self.samples, sample);
        let (omega, damping) = scaled.as_ref().map_or((&model.omega, &model.damping), |s| (&s.omega, &s.damping));
        let [starter, approach, stepper] = self.steppers(vehicle, omega, damping, self.step(sample));
        Ok(Ready {
            starter,
            approach,
            stepper,
            static_loads: vehicle.static_loads(self.study.settings.gravity),
            bridge: scaled.as_ref().map(|s| Bridge { coordinates: s.stiffness, rates: s.rates }),
            stiffness: scaled.map_or(1.0, |s| s.stiffness),
        })
    }

    /// One block of samples in groups of lanes; the last group is filled up with its last sample.
    #[inline(always)]
    pub fn block<L: Lane>(
        &self,
        members: &[u32],
        records: &mut [&mut Record<'a>],
        closely: bool,
        go_on: &dyn Fn() -> bool,
    ) -> Result<Vec<Failure>, Trouble> {
        let Task { study, table, samples, .. } = *self;
        let mut failures = Vec::new();
        let kind: &Kind = &study.kinds[self.kind];
        let way = Way { table, rows: &study.analysis.rows, look: &study.look, closely };
        let axles = table.axles();
        let varied = !samples.factors.is_empty();
        let mut ready: Vec<Ready> = Vec::new();
        // Places among the members of those that are marched.
        let mut sound: Vec<usize> = Vec::with_capacity(members.len());
        for (place, &member) in members.iter().enumerate() {
            if samples.alike() && !ready.is_empty() {
                sound.push(place);
                continue;
            }
            match self.ready(member as usize) {
                Ok(one) => {
                    ready.push(one);
                    sound.push(place);
                }
                Err(cause) => {
                    records[place].forget();
                    failures.push(Failure { sample: member as usize, step: None, cause });
                }
            }
        }
        if sound.is_empty() {
            return Ok(failures);
        }
        let one_for_all = samples.alike();
        let mut groups: Vec<Group<'_, L>> = Vec::with_capacity(sound.len().div_ceil(L::SAMPLES));
        for (number, places) in sound.chunks(L::SAMPLES).enumerate() {
            let lane_of = |lane: usize| lane.min(places.len() - 1);
            let sample_of = |lane: usize| members[places[lane_of(lane)]] as usize;
            let ready_of = |lane: usize| match one_for_all {
                true => &ready[0],
                false => &ready[number * L::SAMPLES + lane_of(lane)],
            };
            let gather = |of: fn(&Ready) -> &Stepper<f64>| {
                let each: Vec<&Stepper<f64>> = (0..L::SAMPLES).map(|lane| of(ready_of(lane))).collect();
                Stepper::<L>::gather(&each)
            };
            let road: Vec<L> = match &study.own {
                None => Vec::new(),
                Some((synthesis, seed)) => synthesis.coefficients(*seed, |lane| samples.first + sample_of(lane) as u64),
            };
            let speed = L::from_fn(|lane| samples.speed(sample_of(lane), 0));
            let ended = |lane: usize| end(table.path.steps, self.step(sample_of(lane)), study.settings.tail);
            let ends = Ends {
                last: L::from_fn(|lane| ended(lane).0 as f64),
                fraction: L::from_fn(|lane| ended(lane).1),
                latest: (0..places.len()).map(|lane| ended(lane).0).max().unwrap_or(0),
            };
            let bridge = ready_of(0).bridge.is_some().then(|| {
                let of = |f: fn(Bridge<f64>) -> f64| L::from_fn(|lane| ready_of(lane).bridge.map_or(1.0, f));
                Bridge { coordinates: of(|b| b.coordinates), rates: of(|b| b.rates) }
            });
            groups.push(Group {
                geometry: Shared::new(table, road, speed),
                starter: gather(|r| &r.starter),
                approach: gather(|r| &r.approach),
                stepper: gather(|r| &r.stepper),
                bridge,
                ends,
                bodies: &kind.bodies,
                seen: Seen::nothing(study.look.rows.len(), axles, kind.bodies.len(), table),
            });
        }
        march(&way, &mut groups, go_on)?;
        for (number, (places, group)) in sound.chunks(L::SAMPLES).zip(&groups).enumerate() {
            let at =
                |lane: usize| &ready[if one_for_all { 0 } else { number * L::SAMPLES + lane.min(places.len() - 1) }];
            let at_rest = (self.layout.own_statics && varied).then(|| {
                let loads: Vec<L> = (0..axles).map(|k| L::from_fn(|lane| at(lane).static_loads[k])).collect();
                rest(&way, &loads)
            });
            for (lane, &place) in places.iter().enumerate() {
                let (sample, record) = (members[place] as usize, &mut *records[place]);
                let Ready { stiffness, static_loads, .. } = at(lane);
                self.write(&group.seen, at_rest.as_ref(), lane, sample, (*stiffness, static_loads), record);
                if !self.layout.is_finite(record.numbers, self.table.axles(), self.study.kinds[self.kind].bodies.len())
                {
                    let step = group.ends.last.get(lane) as usize;
                    if !closely {
                        return Err(Trouble::Failed(step, None));
                    }
                    record.forget();
                    failures.push(Failure { sample, step: Some(step), cause: self.cause(sample, step, None) });
                }
            }
        }
        Ok(failures)
    }

    /// Writes down what was seen of a sample.
    fn write<L: Lane>(
        &self,
        seen: &Seen<L>,
        at_rest: Option<&Seen<L>>,
        lane: usize,
        sample: usize,
        (stiffness, static_loads): (f64, &[f64]),
        record: &mut Record<'_>,
    ) {
        let (layout, look) = (&self.layout, &self.study.look);
        let (responses, axles) = (layout.responses, static_loads.len());
        record.forget();
        let h = self.step(sample);
        let start = layout.range(Column::Responses).start;
        for (place, (&row, &deflection)) in look.row_of.iter().zip(&look.deflections).enumerate() {
            let k = if deflection { stiffness } else { 1.0 };
            for (side, (value, instant)) in extremes(self.table, h, seen, row, lane).into_iter().enumerate() {
                record.numbers[start + side * responses + place] = value / k;
                record.instants[side * responses + place] = instant;
            }
            if let Some(at_rest) = at_rest {
                let start = layout.range(Column::Statics).start;
                for (side, (value, _)) in extremes(self.table, h, at_rest, row, lane).into_iter().enumerate() {
                    record.numbers[start + side * responses + place] = value / k;
                }
            }
        }
        let ride = &seen.ride;
        let count = (self.table.path.steps + 1 - self.table.first) as f64;
        let column = |column: Column| layout.range(column).start;
        for k in 0..axles {
            let watched = &ride.loads[k];
            for (side, (value, at)) in
                [(watched.max, watched.max_at), (watched.min, watched.min_at)].into_iter().enumerate()
            {
                record.numbers[column(Column::Loads) + side * layout.axles + k] = value.get(lane) + 0.0;
                record.instants[2 * responses + side * layout.axles + k] = at.get(lane) as u32;
            }
            let [sum, squares] = ride.sums[k].map(|s| s.get(lane) / count);
            let deviation = (squares - sum * sum).max(0.0).sqrt();
            record.numbers[column(Column::LoadCoefficients) + k] = deviation / static_loads[k];
            record.numbers[column(Column::Aloft) + k] = ride.aloft[k].get(lane) * h;
            record.instants[2 * (responses + layout.axles) + k] = ride.lift_offs[k].get(lane) as u32;
        }
        for b in 0..ride.accelerations.len() {
            record.numbers[column(Column::Accelerations) + b] = ride.accelerations[b].get(lane);
            record.numbers[column(Column::Vibrations) + b] = (ride.squares[b].get(lane) / count).sqrt();
        }
    }
}
