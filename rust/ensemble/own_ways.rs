//! Samples that do not share the geometry with enough others: because their motion is their own (several vehicles, to the
//! left, entries and speeds of their own), or because they are few of their kind. They are made ready one by one, marched
//! in lanes with others of the same make, whatever their kinds, and written down one by one. What rolls freely or stands
//! on its way crosses by itself, and so do constant loads, long trains, and those with nobody of their make beside them.

use std::collections::BTreeMap;
use std::sync::{OnceLock, PoisonError, RwLock};

use super::abreast::{Desk, Landed, Lone, View, cross_apart};
use super::apart::{Apart, Roads};
use super::group::{Drawing, Steppers, Trouble};
use super::results::{Column, Failure, Format, Record, encoded};
use super::sample::Samples;
use super::shelf::Shelf;
use super::side_by_side::{self, Task};
use super::single;
use super::study::{March, Study};
use super::table::Layout;
use super::tabulated;
use super::varied::{VariedBridge, passages};
use crate::crossing::tail;
use crate::crossing::trip::{Exit, Trip, first, overlap};
use crate::damping::ModalDamping;
use crate::error::Error;
use crate::extremes::{Instant, Seen};
use crate::geometry::pavement::Pavement;
use crate::lane::dispatch::InLanes;
use crate::lane::{Lane, Lanes};
use crate::modal_bridge::ModalBridge;
use crate::passage::Passage;
use crate::passage::settings::{Settings, Tail};
use crate::passage::step_length::{Steps, are_driven, bytes, room};
use crate::recovery::Rows;
use crate::road::Road;
use crate::statistics::Ride;
use crate::step::stepper::{Scheme, Stepper};
use crate::step::vibration::most_steps;
use crate::stop_token::StopToken;
use crate::stops::{Passing, Positions, Stop, short_of};
use crate::survey::windows::Windows;
use crate::tape::BridgeFactors;

/// Lanes that a sample by itself takes the time of.
const WORTH: usize = 4;

/// Rows that are looked at where an axle stands on a section.
const AT_STOP: f64 = 8.0;

/// Most numbers that the stops of a sample may take: one with more crosses by itself.
const MOST_AT_STOPS: f64 = (1 << 18) as f64;

/// Whether there is room for what so many axles do at their stops.
pub fn have_room(study: &Study, axles: usize) -> bool {
    let (axles, marks) = (axles as f64, study.look.marks.len() as f64);
    2.0 * axles * marks * axles * (study.analysis.rows.width() as f64 + AT_STOP) <= MOST_AT_STOPS
}

/// What all samples of a run share.
pub struct Shared {
    /// The settings, with a road on which a sample can be planned: as rough as that of any.
    settings: Settings,
    /// Windows of the influence lines, and of those at rest, for whichever worker comes first to work out.
    windows: OnceLock<[Windows; 2]>,
}

impl Shared {
    /// Of the samples of a study.
    pub fn new(study: &Study, samples: &Samples) -> Self {
        let road = match &study.own {
            None => study.settings.road.clone(),
            Some((synthesis, seed)) => {
                let own = Road::from(synthesis.road(*seed, samples.first));
                std::sync::Arc::new(Road::sum([(*study.settings.road).clone(), own]))
            }
        };
        Shared { settings: Settings { road, ..study.settings.clone() }, windows: OnceLock::new() }
    }

    /// The windows of these rows.
    fn windows(&self, rows: &Rows, stop: StopToken<'_>) -> Result<&[Windows; 2], Error> {
        if let Some(windows) = self.windows.get() {
            return Ok(windows);
        }
        let made = [Windows::new(rows, false, stop)?, Windows::new(rows, true, stop)?];
        Ok(self.windows.get_or_init(|| made))
    }
}

/// Some samples, with room for what comes of them.
pub struct Part<'s, 'a> {
    /// The study.
    pub study: &'s Study,
    /// What they share.
    pub shared: &'s Shared,
    /// Their marches, where those have places on the shelves.
    pub marches: &'s [(March, &'s Shelf)],
    /// Read by every crossing alone under way, written by one that needs the memory to itself.
    pub company: &'s RwLock<()>,
    /// Where things go.
    pub format: Format,
    /// All samples of the run.
    pub samples: &'s Samples,
    /// Their numbers.
    pub members: &'s [u32],
    /// Where each is written down.
    pub records: &'s mut [Record<'a>],
    /// Where those that fail are.
    pub failed: &'s mut Vec<Failure>,
    /// Whether to go on.
    pub stop: StopToken<'s>,
}

/// A sample before it is planned.
struct Event {
    passages: Vec<Passage>,
    /// The bridge, if it is varied.
    model: Option<ModalBridge>,
    factors: Option<BridgeFactors<f64>>,
}

/// A sample ready to cross in a lane.
struct Ready<'e> {
    lone: Lone<'e>,
    starter: Stepper<f64>,
    approach: Stepper<f64>,
    bridge: Stepper<f64>,
    /// Of each vehicle the road that is given, and whether the sample's own is on top of it.
    roads: Vec<(Option<Pavement>, bool)>,
}

impl InLanes for Part<'_, '_> {
    type Output = Result<(), Error>;

    fn run<L: Lanes>(self) -> Self::Output {
        let Part { study, shared, marches, company, format, samples, members, records, failed, stop } = self;
        let events: Vec<Option<Event>> =
            members.iter().map(|&member| Event::of(study, samples, member as usize).ok()).collect();
        let mut made: Vec<Option<Ready<'_>>> = Vec::with_capacity(members.len());
        for (place, event) in events.iter().enumerate() {
            stop.check()?;
            let march = marches.get(place).map(|&(march, _)| (march, samples.speed(members[place] as usize, 0)));
            made.push(event.as_ref().and_then(|event| Ready::new(study, shared, event, march)));
        }
        // Those of the same make, the quicker ones together.
        let mut makes: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
        let mut alone = Vec::new();
        for (place, ready) in made.iter().enumerate() {
            match ready {
                Some(ready) => makes.entry(ready.make()).or_default().push(place),
                None => alone.push(place),
            }
        }
        let (mut desk, mut roads) = (Desk::default(), Vec::new());
        for mut places in makes.into_values() {
            places.sort_by_key(|&place| made[place].as_ref().map(|ready| (ready.lone.first, ready.lone.exit.step)));
            for places in places.chunks(L::SAMPLES) {
                // Empty lanes are work too.
                if WORTH * places.len() < L::SAMPLES {
                    alone.extend(places);
                    continue;
                }
                let group: Vec<&Ready<'_>> = places.iter().filter_map(|&place| made[place].as_ref()).collect();
                let numbers: Vec<u64> = places.iter().map(|&place| samples.first + u64::from(members[place])).collect();
                match march::<L>(study, shared, &group, &numbers, (&mut desk, &mut roads), stop) {
                    Ok((landed, rides)) => {
                        for (lane, landed) in landed.iter().enumerate() {
                            let record = &mut records[places[lane]];
                            if !write(study, &format, &group[lane].lone, landed, (&rides, lane), record) {
                                alone.push(places[lane]);
                            }
                            if let Some((_, shelf)) = marches.get(places[lane]).filter(|_| !format.own_statics) {
                                shelf.leave(|| statics(study, &landed.seen[1]));
                            }
                        }
                    }
                    Err(Trouble::Interrupted) => return Err(Error::Interrupted),
                    // Which of them it is, and when, is seen of each by itself.
                    Err(Trouble::Failed(..)) => alone.extend(places),
                }
            }
        }
        for place in alone {
            if let Some(&(march, shelf)) = marches.get(place) {
                let shared = tabulated::Shared::new(study.table(march, Layout::Bare, stop)?);
                if !format.own_statics {
                    shelf.leave(|| side_by_side::at_rest(study, march.0, &shared.table));
                }
                let task = Task { study, format, samples, kind: march.0, shared: &shared };
                task.run::<f64>(&members[place..=place], &mut records[place..=place], failed, stop)?;
                continue;
            }
            let (sample, record) = (members[place] as usize, &mut records[place]);
            let mut cross = || single::cross(study, &format, samples, sample, record, stop);
            let beside = {
                let _beside = company.read().unwrap_or_else(PoisonError::into_inner);
                cross()
            };
            let crossed = match beside {
                // Where there is no room beside others there may be when they have ended.
                Err(Error::Memory { .. }) => {
                    let _by_itself = company.write().unwrap_or_else(PoisonError::into_inner);
                    cross()
                }
                beside => beside,
            };
            match crossed {
                Ok(()) => {}
                // That there is no memory says nothing of the sample.
                Err(cause @ (Error::Interrupted | Error::Memory { .. })) => return Err(cause),
                Err(cause) => {
                    record.forget();
                    failed.push(Failure { sample, step: cause.step(), cause });
                }
            }
        }
        Ok(())
    }
}

impl Event {
    fn of(study: &Study, samples: &Samples, sample: usize) -> Result<Self, Error> {
        let model = &study.analysis.model;
        let varied = VariedBridge::of(model, samples, sample);
        let factors = varied.as_ref().map(|varied| varied.factors);
        let model = varied.map(|VariedBridge { omega, damping, .. }| ModalBridge { omega, damping, ..model.clone() });
        Ok(Event { passages: passages(study, samples, sample)?, model, factors })
    }
}

impl<'e> Ready<'e> {
    /// If it can go side by side with others; in the steps of a march at a speed [m/s], if it takes that.
    fn new(study: &Study, shared: &'e Shared, event: &'e Event, march: Option<(March, f64)>) -> Option<Self> {
        let Shared { settings, .. } = shared;
        let model = event.model.as_ref().unwrap_or(&study.analysis.model);
        let trip = match march {
            None => Trip::plan(model, &event.passages, settings),
            Some((march, speed)) => {
                let path = study.path(march);
                let h = path.advance / speed;
                let tail = match settings.tail {
                    Tail::Fixed(_) => 0,
                    Tail::Free => longest_tail(model, &event.passages[0], path.steps, h),
                };
                let steps = Steps::of(path.steps, h, path.advance, tail);
                Trip::in_steps(model, &event.passages, settings, |_| Ok(steps))
            }
        };
        let trip = trip.ok()?;
        let exit = trip.exit()?;
        if !have_room(study, trip.axles())
            || !trip.steps.may_be_kept()
            || are_driven(model, &trip.courses)
            || !keep_apart(&trip, exit)
        {
            return None;
        }
        let mesh = model.shapes.mesh();
        if (0..trip.axles()).any(|axle| mesh.is_on(trip.x(exit.step + 1, axle))) {
            return None;
        }
        let h = trip.steps.h;
        let end = match settings.tail {
            Tail::Fixed(tail) => Some(tail::end(exit.time, exit.step, h, tail)),
            Tail::Free => None,
        };
        let fraction = end.map_or(1.0, |(last, fraction)| if last == exit.step { fraction } else { 1.0 });
        let there: Vec<_> =
            trip.courses.iter().map(|c| trip.on_bridge(c.axles.clone(), (exit.step, fraction))).collect();
        // One more, for what rounding leaves short of the bridge.
        let first = trip.on_bridge(0..trip.axles(), (exit.step, 1.0)).start.saturating_sub(1);
        let moving = trip.moving(settings);
        let Settings { beta, gravity, lift_off, .. } = *settings;
        let stepper = |(omega, damping): (&[f64], &ModalDamping), h: f64| {
            Stepper::new(omega, damping, &moving, &Scheme { h, beta, gravity, lift_off })
        };
        let (there_at, none) = ((&model.omega[..], &model.damping), (&[][..], &ModalDamping::Classical(Vec::new())));
        let (starter, approach) = (stepper(if first > 0 { none } else { there_at }, 0.0), stepper(none, h));
        let bridge = stepper(there_at, h);
        let given = &study.settings.road;
        let roads = trip.courses.iter().zip(&event.passages).map(|(course, passage)| {
            let own = passage.road.is_none() && study.own.is_some();
            let pavement = course.pavement(settings, trip.length);
            let pavement = pavement.map(|pavement| match own {
                // Only what is given: the sample's own comes on top of it.
                true => Pavement { road: given.off(course.datum(settings, trip.length)), ..pavement },
                false => pavement,
            });
            (pavement, own)
        });
        let roads = roads.collect();
        let static_loads = trip.static_loads(gravity);
        let mut lone = Lone { trip, exit, first, end, there, stops: Vec::new(), static_loads, factors: event.factors };
        lone.stops = stops(study, &lone)?;
        Some(Ready { lone, starter, approach, bridge, roads })
    }

    /// What samples must have in common to go side by side.
    fn make(&self) -> Vec<usize> {
        let steppers = [&self.starter, &self.approach, &self.bridge].into_iter();
        let ways = steppers.flat_map(|stepper| stepper.ways().into_iter().map(usize::from).collect::<Vec<_>>());
        let sizes = self.lone.trip.courses.iter().flat_map(|course| {
            let assembly = course.vehicle.assembly();
            let sizes = [assembly.contacts.len(), assembly.mass.nrows(), assembly.frictions.len()];
            let bodies = [course.vehicle.bodies().len(), (course.direction.sign() > 0.0).into()];
            sizes.into_iter().chain(bodies)
        });
        let of_road = |(pavement, own): &(Option<Pavement>, bool)| match pavement {
            None => 0,
            Some(pavement) => 1 + usize::from(*own) + 2 * usize::from(pavement.road.is_smooth()),
        };
        let roads = self.roads.iter().map(of_road);
        // Where it starts on the bridge, the modes have their say at once.
        let rest = [
            self.lone.trip.steps.advance.is_some().into(),
            self.lone.factors.is_some().into(),
            (self.lone.first > 0).into(),
        ];
        sizes.chain(roads).chain(rest).chain(ways).collect()
    }
}

/// Most steps of h [s] of a tail that is not given, after so many.
fn longest_tail(model: &ModalBridge, passage: &Passage, steps: usize, h: f64) -> usize {
    let assembly = passage.vehicle.assembly();
    let (axles, coordinates) = (assembly.contacts.len(), assembly.mass.nrows() + 1);
    let bytes = bytes(model.omega.len(), axles, coordinates, assembly.frictions.len());
    let slowest = model.omega.iter().fold(f64::INFINITY, |least, w| w.powi(2).min(least));
    most_steps(slowest, h, room(steps as f64, bytes))
}

/// The static extremes of all responses looked at: the largest, then the smallest.
fn statics(study: &Study, seen: &Seen<f64>) -> Vec<f64> {
    let row_of = &study.look.row_of;
    // Of equal ones it does not matter which.
    let side = |side: usize| row_of.iter().map(move |&row| seen.sides(row, 0, |_| 0.0)[side].0);
    side(0).chain(side(1)).collect()
}

/// Whether vehicles of the same lane are certain to keep apart; if not, the crossing alone says when they do not.
fn keep_apart(trip: &Trip<'_>, exit: Exit) -> bool {
    let lanes: Vec<i64> = trip.courses.iter().map(|course| course.lane).collect();
    let alone = (0..lanes.len()).all(|v| !lanes[..v].contains(&lanes[v]));
    let (h, length) = (trip.steps.h, trip.length);
    let are_apart =
        |step: usize| overlap(&trip.courses, (step as f64 * h, h, length), |axle| trip.motion(step, axle)).is_none();
    alone || (0..=exit.step).all(are_apart)
}

/// Every stop of a sample, in the order of [`PassingAxles`](crate::stops::PassingAxles); none if the tail has some too.
fn stops(study: &Study, lone: &Lone<'_>) -> Option<Vec<Stop>> {
    let marks = &study.look.marks;
    let mut passings = Vec::new();
    for axle in 0..lone.axles() {
        let right = lone.trip.own(axle).0.direction.sign() > 0.0;
        let start = lone.x(0, axle);
        let mut step = 1;
        for i in 0..marks.len() {
            let mark = if right { i } else { marks.len() - 1 - i };
            let at = marks[mark].x;
            if if right { at <= start } else { at >= start } {
                continue;
            }
            let short = short_of(lone, axle, at);
            step = first(step, |step| match right {
                true => lone.x(step, axle) >= at - short,
                false => lone.x(step, axle) <= at + short,
            });
            if step > lone.exit.step {
                return None;
            }
            passings.push(((step, axle, i), right, Passing::new(lone, step, axle, (mark, at))));
        }
    }
    passings.sort_unstable_by_key(|passing| passing.0);
    Some(passings.iter().flat_map(|(_, right, passing)| passing.stops(&study.look, *right)).collect())
}

/// One group of lanes, marched to the end.
fn march<L: Lanes>(
    study: &Study,
    shared: &Shared,
    group: &[&Ready<'_>],
    numbers: &[u64],
    (desk, own): (&mut Desk, &mut Vec<L>),
    stop: StopToken<'_>,
) -> Result<(Vec<Landed>, Vec<Ride<L>>), Trouble> {
    let of = |lane: usize| group[lane.min(group.len() - 1)];
    let gather = |of_ready: for<'r> fn(&'r Ready<'_>) -> &'r Stepper<f64>| {
        let each: Vec<&Stepper<f64>> = (0..L::SAMPLES).map(|lane| of_ready(of(lane))).collect();
        Stepper::<L>::gather(&each)
    };
    let mut steppers =
        Steppers { starter: gather(|r| &r.starter), approach: gather(|r| &r.approach), bridge: gather(|r| &r.bridge) };
    let mut period = 1.0;
    if let Some((synthesis, seed)) = &study.own {
        period = synthesis.period();
        let sample = |lane: usize| numbers[lane.min(numbers.len() - 1)];
        L::dispatch(Drawing { synthesis, seed: *seed, sample, road: own });
    }
    let given: Vec<Vec<(Option<Pavement>, bool)>> = group.iter().map(|ready| ready.roads.clone()).collect();
    let trips: Vec<&Trip<'_>> = group.iter().map(|ready| &ready.lone.trip).collect();
    let lanes: Vec<&Lone<'_>> = group.iter().map(|ready| &ready.lone).collect();
    let courses = &trips[0].courses;
    let heaves: Vec<Vec<Vec<Vec<f64>>>> =
        trips.iter().map(|trip| trip.courses.iter().map(|course| course.vehicle.heaves()).collect()).collect();
    let row = |v: usize, b: usize| {
        let width = heaves[0][v][b].len();
        (0..width).map(|i| L::from_fn(|lane| heaves[lane.min(heaves.len() - 1)][v][b][i])).collect()
    };
    let of_vehicle = |v: usize| (0..heaves[0][v].len()).map(|b| row(v, b)).collect();
    let bodies: Vec<Vec<Vec<L>>> = (0..courses.len()).map(of_vehicle).collect();
    let roads = Roads { own, period, ramp: shared.settings.ramp, given: &given };
    let mut geometry = Apart::new(&trips, &study.analysis.model.shapes, roads);
    let [windows, windows_at_rest] = shared.windows(&study.analysis.rows, stop).map_err(|_| Trouble::Interrupted)?;
    let view = View {
        rows: &study.analysis.rows,
        look: &study.look,
        free: &study.free,
        windows: [windows, windows_at_rest],
        bodies: &bodies,
    };
    cross_apart(view, &lanes, &mut geometry, &mut steppers, desk, stop)
}

/// Writes down what was found of a sample, and says whether all of it is finite.
fn write<L: Lane>(
    study: &Study,
    format: &Format,
    lone: &Lone<'_>,
    landed: &Landed,
    (rides, lane): (&[Ride<L>], usize),
    record: &mut Record<'_>,
) -> bool {
    let look = &study.look;
    let (h, (last, _)) = (lone.trip.steps.h, landed.end);
    let time = |step: usize| lone.time(step, landed.end);
    let when = |instant: Instant| match instant {
        Instant::Step(step) => time(step),
        Instant::Stop(number) => {
            let Stop { step, fraction, .. } = lone.stops[number];
            Stop::between(fraction, [time(step - 1), time(step)])
        }
    };
    let front = |step: usize| match step == last && landed.end.1 < 1.0 {
        true => lone.trip.between(step, landed.end.1, 0),
        false => lone.trip.x(step, 0),
    };
    let place = |instant: Instant| match instant {
        Instant::Step(step) => front(step),
        Instant::Stop(number) => lone.stops[number].position,
    };
    record.forget();
    let [dynamic, at_rest] = &landed.seen;
    let growth = study.free.growth(&landed.reach, |row| dynamic.reached(row));
    let start = |column: Column| format.range(column).start;
    let tail = match study.settings.tail {
        Tail::Fixed(tail) if !format.own_times => tail,
        Tail::Free if !format.own_times => (last - lone.exit.step) as f64 * h,
        _ => time(last) - lone.exit.time,
    };
    record.numbers[start(Column::Tail)..][..3].copy_from_slice(&[tail, growth[0], look.side(growth[1])]);
    let (r, a) = (format.responses, format.axles);
    for (i, (&row, &quantity)) in look.row_of.iter().zip(&look.quantities).enumerate() {
        let k = lone.factors.map_or(1.0, |factors| factors.of(quantity));
        for (side, (value, instant)) in dynamic.sides(row, 0, when).into_iter().enumerate() {
            record.numbers[start(Column::Responses) + side * r + i] = value / k;
            if format.own_times {
                record.numbers[start(Column::Times) + side * r + i] = when(instant);
                record.numbers[start(Column::Positions) + side * r + i] = place(instant);
            } else {
                record.instants[side * r + i] = encoded(instant);
            }
        }
        if !format.own_statics {
            continue;
        }
        for (side, (value, _)) in at_rest.sides(row, 0, when).into_iter().enumerate() {
            record.numbers[start(Column::Statics) + side * r + i] = value / k;
        }
    }
    let (mut axles, mut bodies) = (0, 0);
    for ride in rides {
        let own = ride.loads.len();
        record.write_ride(format, ride, lane, [axles, bodies], &lone.static_loads[axles..][..own], h);
        for (k, peaks) in ride.loads.iter().enumerate() {
            for (side, at) in [peaks.max_at, peaks.min_at].into_iter().enumerate() {
                let (step, i) = (at.get(lane) as usize, 2 * r + side * a + axles + k);
                if format.own_times {
                    record.numbers[start(Column::Times) + i] = time(step);
                    record.numbers[start(Column::Positions) + i] = front(step);
                } else {
                    record.instants[i] = step as u32;
                }
            }
        }
        (axles, bodies) = (axles + own, bodies + ride.accelerations.len());
    }
    format.is_finite(record.numbers, axles, bodies)
}
