//! One group of samples each of which goes its own way, through a whole crossing, one in each lane.
//!
//! They take the same number of steps at a time, each as long as its own. On the approach there is no bridge to be moved;
//! a lane that has left the bridge waits for the last, repeating its row, and from there all swing together, each from
//! where it had come. What is found of each is what a crossing alone would find, to the bit.

use std::ops::Range;

use super::apart::Apart;
use super::group::{Steppers, Trouble};
use crate::coordinate::{Coordinate, shortened};
use crate::crossing::tail::FreeRows;
use crate::crossing::trip::{Exit, Trip};
use crate::extremes::{Peaks, Seen, at_stop, interpolate};
use crate::lane::{Lane, Lanes, Work};
use crate::recovery::{Placed, Rows};
use crate::selection::Selection;
use crate::statistics::{Counted, Ride};
use crate::step::stepper::State;
use crate::step::vibration::{LOOK_EVERY, Reach, Vibration};
use crate::stop_token::StopToken;
use crate::stops::{PassingInfluence, Positions, Stop};
use crate::survey::windows::Windows;
use crate::survey::{FAR, Moment, Stretch, Survey};
use crate::tape::{BridgeFactors, CHUNK, PART, Tape, Widths, write_at_rest};

/// Chunks of steps that are kept until their responses are looked at, at most.
const TOGETHER: usize = 16;

/// One sample on its own way.
pub struct Lone<'a> {
    /// What it does.
    pub trip: Trip<'a>,
    /// When all have left.
    pub exit: Exit,
    /// The first step with an axle on the bridge.
    pub first: usize,
    /// With a tail that is given, the last step, and how far through it.
    pub end: Option<(usize, f64)>,
    /// Steps of each vehicle on the bridge.
    pub there: Vec<Range<usize>>,
    /// Stops, in order.
    pub stops: Vec<Stop>,
    /// Static loads [N].
    pub static_loads: Vec<f64>,
    /// The bridge, if it is varied.
    pub factors: Option<BridgeFactors<f64>>,
}

/// What is looked at of all.
#[derive(Clone, Copy)]
pub struct View<'a, L> {
    /// The rows of the bridge.
    pub rows: &'a Rows,
    /// The responses looked at.
    pub look: &'a Selection,
    /// The same without vehicles on the bridge.
    pub free: &'a FreeRows,
    /// Of their influence lines, and of those of loads at rest.
    pub windows: [&'a Windows; 2],
    /// Vertical displacements of the bodies of each vehicle, as rows over its coordinates.
    pub bodies: &'a [Vec<Vec<L>>],
}

/// What has been found of one.
pub struct Landed {
    /// Extremes of the responses, and those at rest.
    pub seen: [Seen<f64>; 2],
    /// The last step, and how far through it.
    pub end: (usize, f64),
    /// What free vibration can reach after it.
    pub reach: Reach<f64>,
}

impl Lone<'_> {
    /// The time at the end of a step [s], the last of which may be cut short.
    pub fn time(&self, step: usize, (last, fraction): (usize, f64)) -> f64 {
        let time = |step: usize| step as f64 * self.trip.steps.h;
        if step < last || fraction == 1.0 {
            return time(step);
        }
        time(step - 1) + fraction * (time(step) - time(step - 1))
    }

    /// How far through a step it ends with it.
    fn fraction(&self, step: usize) -> f64 {
        self.end.map_or(1.0, |(last, fraction)| if last == step { fraction } else { 1.0 })
    }
}

impl Positions for Lone<'_> {
    fn axles(&self) -> usize {
        self.trip.axles()
    }

    fn x(&self, step: usize, axle: usize) -> f64 {
        let fraction = self.fraction(step);
        if fraction < 1.0 { self.trip.between(step, fraction, axle) } else { self.trip.x(step, axle) }
    }
}

/// The search in one lane.
struct Search {
    dynamic: Survey,
    at_rest: Survey,
    stops: [Vec<Peaks<f64>>; 2],
    /// What the axles do to the bridge at each stop.
    influences: Vec<PassingInfluence>,
    /// The next stop.
    next: usize,
}

/// A group on its way.
struct Band<'s, 'a, L> {
    view: View<'s, L>,
    lanes: &'s [&'s Lone<'a>],
    geometry: &'s mut Apart<'s, L>,
    steppers: &'s mut Steppers<L>,
    factors: Option<BridgeFactors<L>>,
    static_loads: Vec<L>,
    state: State<L>,
    /// Where each lane has left the bridge.
    exits: L,
    /// How far through that step, where it ends with it.
    fractions: L,
    /// The modes there.
    saved: Vec<Coordinate<L>>,
    tape: Tape<L>,
    /// Where axles are, by step of the tape and axle, the step before the first included.
    places: Vec<L>,
}

/// What is kept for the next group.
#[derive(Default)]
pub struct Desk {
    stretches: Vec<(Stretch, Vec<Stretch>)>,
    far: Vec<Stretch>,
}

/// Some steps of a group.
struct Going<'g, 's, 'a, L> {
    band: &'g mut Band<'s, 'a, L>,
    approach: bool,
    steps: Range<usize>,
}

impl<L: Lane> Work for Going<'_, '_, '_, L> {
    type Output = Result<(), Trouble>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Going { band, approach, steps } = self;
        let Band {
            view, geometry, steppers, factors, static_loads, state, exits, fractions, saved, tape, places, ..
        } = band;
        let widths = tape.widths;
        let stepper = if approach { &mut steppers.approach } else { &mut steppers.bridge };
        let (axles, earliest, mut last) = (widths.axles, least(*exits), state.clone());
        for step in steps.clone() {
            if step >= earliest {
                last.clone_from(state);
            }
            if step > 0
                && let Err(e) = stepper.advance_any(state, &mut **geometry)
            {
                return Err(Trouble::Failed(step, Some(e)));
            }
            let at = (step + 1 - tape.from) * axles;
            for k in 0..axles {
                places[at + k] = geometry.x(k);
            }
            let [before, row] = tape.row_mut(step);
            if step < earliest {
                keep(row, &widths, &state.modes, &state.increments, factors.as_ref(), static_loads);
                keep_accelerations(&mut row[widths.accelerations()..], view.bodies, &state.coordinates);
            } else {
                let now = L::splat(step as f64);
                let ended = exits.less(now);
                let ending = !(ended | now.less(*exits));
                let short = !(!ending | !fractions.less(L::splat(1.0)));
                let (modes, coordinates) = (
                    shortened(short, *fractions, &last.modes, &state.modes),
                    shortened(short, *fractions, &last.coordinates, &state.coordinates),
                );
                keep(row, &widths, &modes, &state.increments, factors.as_ref(), static_loads);
                let loads = widths.loads()..widths.accelerations();
                for (b, a) in before[loads.clone()].iter().zip(&mut row[loads]) {
                    *a = L::select(short, *b + *fractions * (*a - *b), *a);
                }
                keep_accelerations(&mut row[widths.accelerations()..], view.bodies, &coordinates);
                for (b, a) in before.iter().zip(row) {
                    *a = L::select(ended, *b, *a);
                }
                for k in 0..axles {
                    let [b, a] = [places[at - axles + k], places[at + k]];
                    places[at + k] = L::select(ended, b, L::select(short, b + *fractions * (a - b), a));
                }
                for (saved, mode) in saved.iter_mut().zip(&state.modes) {
                    saved.x = L::select(ending, mode.x, saved.x);
                    saved.v = L::select(ending, mode.v, saved.v);
                    saved.a = L::select(ending, mode.a, saved.a);
                }
            }
        }
        if sound(state) { Ok(()) } else { Err(Trouble::Failed(steps.end - 1, None)) }
    }
}

/// Keeps the modes and the loads of a step in its row.
#[inline(always)]
fn keep<L: Lane>(
    row: &mut [L],
    widths: &Widths,
    modes: &[Coordinate<L>],
    increments: &[L],
    factors: Option<&BridgeFactors<L>>,
    static_loads: &[L],
) {
    let derivative = |order: usize, m: usize| match order {
        0 => modes[m].x,
        1 => modes[m].v,
        _ => modes[m].a,
    };
    widths.write_modes(row, modes.len(), derivative, factors);
    let loads = row[widths.loads()..][..widths.axles].iter_mut();
    for ((load, at_rest), increment) in loads.zip(static_loads).zip(increments) {
        *load = *at_rest + *increment;
    }
}

/// Keeps the accelerations of all bodies, vehicle after vehicle.
#[inline(always)]
fn keep_accelerations<L: Lane>(row: &mut [L], bodies: &[Vec<Vec<L>>], coordinates: &[Coordinate<L>]) {
    let (mut number, mut first) = (0, 0);
    for of_vehicle in bodies {
        for body in of_vehicle {
            let mut sum = L::splat(0.0);
            for (factor, q) in body.iter().zip(&coordinates[first..]) {
                sum = sum + *factor * q.a;
            }
            row[number] = sum;
            number += 1;
        }
        first += of_vehicle.first().map_or(0, Vec::len);
    }
}

/// Whether everything is a finite number in all lanes.
#[inline(always)]
fn sound<L: Lane>(state: &State<L>) -> bool {
    let mut sum = L::splat(0.0);
    for c in state.modes.iter().chain(&state.coordinates) {
        sum = sum + c.a;
    }
    for p in &state.increments {
        sum = sum + *p;
    }
    // Nought, unless something is infinite or not a number.
    #[allow(clippy::eq_op)]
    let nought = sum - sum;
    L::all(!(nought.less(L::splat(0.0)) | !nought.less(L::splat(1.0))))
}

fn least<L: Lane>(numbers: L) -> usize {
    (0..L::SAMPLES).map(|lane| numbers.get(lane) as usize).min().unwrap_or(0)
}

/// The rides of all vehicles in a chunk.
struct Riding<'g, L> {
    rides: &'g mut [Ride<L>],
    tape: &'g mut Tape<L>,
    static_loads: &'g [L],
    counted: &'g [Counted<L>],
    count: usize,
}

impl<L: Lane> Work for Riding<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Riding { rides, tape, static_loads, counted, count } = self;
        tape.take(count);
        let (mut axles, mut bodies) = (0, 0);
        for (ride, counted) in rides.iter_mut().zip(counted) {
            let own = ride.loads.len();
            ride.take_apart(tape, [axles, bodies], &static_loads[axles..][..own], counted);
            (axles, bodies) = (axles + own, bodies + ride.accelerations.len());
        }
    }
}

/// The responses of all lanes in the steps of a tape, and at the stops among them.
struct Looking<'g, 's, 'a, L> {
    band: &'g Band<'s, 'a, L>,
    searches: &'g mut [Search],
    desk: &'g mut Desk,
}

impl<L: Lane> Work for Looking<'_, '_, '_, L> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Looking { band, searches, desk } = self;
        for (lane, search) in searches.iter_mut().enumerate() {
            band.pass(lane, search);
            band.look(lane, search, desk);
        }
    }
}

impl<L: Lane> Band<'_, '_, L> {
    fn x(&self, step: usize, axle: usize, lane: usize) -> f64 {
        self.places[(step + 1 - self.tape.from) * self.tape.widths.axles + axle].get(lane)
    }

    /// The responses of a lane at the steps of the tape, dynamic and at rest.
    #[inline(always)]
    fn look(&self, lane: usize, search: &mut Search, desk: &mut Desk) {
        let (rows, tape) = (self.view.rows, &self.tape);
        let widths = tape.widths;
        let (c, axles) = (widths.coordinates, widths.axles);
        let exit = self.lanes[lane].exit.step;
        let loads = &self.lanes[lane].static_loads;
        let steps = (exit + 1).saturating_sub(tape.from).min(tape.steps);
        let [windows, windows_at_rest] = self.view.windows;
        let Desk { stretches, far } = desk;
        lay_out(stretches, tape, steps, |stretch, from, count, limits| {
            stretch.coordinates.extend(limits[..c].iter().map(|[most, least]| [most.get(lane), least.get(lane)]));
            for k in 0..axles {
                let reached = windows.reached(self.x(from, k, lane), self.x(from + count - 1, k, lane));
                let [most, least] = limits[c + k];
                stretch.loads.extend(reached.map(|reached| (reached, [most.get(lane), least.get(lane)])));
            }
        });
        let mut places = vec![None; axles];
        let dynamic = |step: usize, moment: &mut Moment| {
            let row = tape.row(step);
            moment.coordinates.clear();
            moment.coordinates.extend(row[..c].iter().map(|a| [a.get(lane)]));
            moment.placed.clear();
            for (k, place) in places.iter_mut().enumerate() {
                *place = rows.place_near(self.x(step, k, lane), *place);
                if place.is_some() {
                    moment.placed.push(Placed::new(*place, [row[c + k].get(lane)]));
                }
            }
        };
        search.dynamic.look(rows, windows, (&[], stretches), dynamic, (0, true));
        let fill = |stretch: &mut Stretch, from: usize, count: usize| {
            for (k, load) in loads.iter().enumerate() {
                let reached = windows_at_rest.reached(self.x(from, k, lane), self.x(from + count - 1, k, lane));
                stretch.loads.extend(reached.map(|reached| (reached, [*load, *load])));
            }
        };
        lay_out(stretches, tape, steps, |stretch, from, count, _| fill(stretch, from, count));
        // Loads at rest are bounded over any stretch.
        far.resize_with(steps.div_ceil(FAR * CHUNK), Stretch::default);
        for (i, stretch) in far.iter_mut().enumerate() {
            let first = i * FAR * CHUNK;
            stretch.loads.clear();
            fill(stretch, tape.from + first, (steps - first).min(FAR * CHUNK));
        }
        let mut places = vec![None; axles];
        let at_rest = |step: usize, moment: &mut Moment| {
            for (k, place) in places.iter_mut().enumerate() {
                *place = rows.place_near(self.x(step, k, lane), *place);
            }
            moment.coordinates.clear();
            moment.coordinates.extend(rows.static_coordinates(&places, loads).map(|a| [a]));
            moment.placed.clear();
            let there = places.iter().zip(loads).filter(|(place, _)| place.is_some());
            moment.placed.extend(there.map(|(place, load)| Placed::new(*place, [*load])));
        };
        search.at_rest.look(rows, windows_at_rest, (far, stretches), at_rest, (0, false));
    }

    /// The stops of a lane among the steps of the tape.
    #[inline(always)]
    fn pass(&self, lane: usize, search: &mut Search) {
        let (View { look, .. }, tape, lone) = (self.view, &self.tape, self.lanes[lane]);
        let widths = tape.widths;
        let end = tape.from + tape.steps;
        let mut then = Vec::new();
        while let Some(stop) = lone.stops.get(search.next).filter(|stop| stop.step < end) {
            let side = |step: usize| {
                let own: Vec<f64> = tape.row(step)[..widths.used()].iter().map(|a| a.get(lane)).collect();
                own
            };
            let [before, after] = [side(stop.step - 1), side(stop.step)];
            interpolate(stop, [&before, &after], &widths, &mut then);
            let influence = &search.influences[search.next];
            at_stop(&mut search.stops[0], look, (stop, search.next, influence), &then);
            search.next += 1;
        }
        search.dynamic.reach(look, &search.stops[0]);
    }
}

impl Search {
    /// Nothing seen yet but what stops show at rest.
    fn new(lone: &Lone<'_>, rows: &Rows, look: &Selection) -> Self {
        let nothing = vec![Peaks::nothing(); look.rows.len()];
        let survey = Survey::new(look, lone.first > 0);
        let (dynamic, at_rest) = (survey.clone(), survey);
        let mut search =
            Search { dynamic, at_rest, stops: [nothing.clone(), nothing], influences: Vec::new(), next: 0 };
        let mut then = vec![0.0; rows.width() + lone.axles()];
        for (number, stop) in lone.stops.iter().enumerate() {
            let mut influence = PassingInfluence::default();
            influence.fill(stop, lone, rows, look);
            write_at_rest(&influence.statics, &lone.static_loads, &mut then);
            at_stop(&mut search.stops[1], look, (stop, number, &influence), &then);
            search.influences.push(influence);
        }
        search.at_rest.reach(look, &search.stops[1]);
        search
    }
}

/// Lays out the first steps of a tape, chunk by chunk and part by part.
#[inline(always)]
fn lay_out<L: Lane>(
    stretches: &mut Vec<(Stretch, Vec<Stretch>)>,
    tape: &Tape<L>,
    steps: usize,
    mut fill: impl FnMut(&mut Stretch, usize, usize, &[[L; 2]]),
) {
    stretches.resize_with(steps.div_ceil(CHUNK), Default::default);
    let width = tape.widths.all();
    let mut begin = |stretch: &mut Stretch, from: usize, count: usize, limits: &[[L; 2]]| {
        (stretch.from, stretch.count) = (from, count);
        stretch.coordinates.clear();
        stretch.loads.clear();
        fill(stretch, from, count, limits);
    };
    for (number, (whole, parts)) in stretches.iter_mut().enumerate() {
        let kept = tape.chunk(number);
        let count = (tape.from + steps - kept.from).min(CHUNK);
        begin(whole, kept.from, count, kept.limits);
        parts.resize_with(count.div_ceil(PART), Default::default);
        for (p, part) in parts.iter_mut().enumerate() {
            let first = p * PART;
            begin(part, kept.from + first, (count - first).min(PART), &kept.parts[p * width..][..width]);
        }
    }
}

/// Marches a group of samples over the bridge, each on its own way, and tells what was found of each, and of all lanes the
/// rides of their vehicles.
pub fn cross_apart<'s, 'a, L: Lanes>(
    view: View<'s, L>,
    lanes: &'s [&'s Lone<'a>],
    geometry: &'s mut Apart<'s, L>,
    steppers: &'s mut Steppers<L>,
    desk: &mut Desk,
    stop: StopToken<'_>,
) -> Result<(Vec<Landed>, Vec<Ride<L>>), Trouble> {
    let lone = |lane: usize| lanes[lane.min(lanes.len() - 1)];
    let of = |what: &dyn Fn(&Lone<'a>) -> f64| L::from_fn(|lane| what(lone(lane)));
    let (axles, modes) = (lanes[0].trip.axles(), steppers.bridge.modes());
    let bodies = view.bodies.iter().map(Vec::len).sum();
    let widths = Widths::of(view.rows, axles, bodies);
    let first = lanes.iter().map(|lone| lone.first).min().unwrap_or(0);
    let speeds: Vec<L> = (0..lanes[0].trip.courses.len()).map(|v| of(&|lone| lone.trip.courses[v].speed)).collect();
    let state = steppers.starter.start(&speeds, &*geometry).map_err(|e| Trouble::Failed(0, Some(e)))?;
    let counted = |v: usize| Counted {
        from: of(&|lone| lone.there[v].start as f64),
        to: of(&|lone| lone.there[v].end as f64),
        last: of(&|lone| lone.exit.step as f64),
        left: of(&|lone| {
            let (step, fraction) = (lone.exit.step, lone.fraction(lone.exit.step));
            let time = |step: usize| lone.time(step, (lone.exit.step, fraction));
            crate::crossing::history::part(time(step) - time(step - 1), lone.trip.steps.h)
        }),
    };
    let counted: Vec<Counted<L>> = (0..view.bodies.len()).map(counted).collect();
    let ride = |v: usize| {
        let mut ride = Ride::nothing(lanes[0].trip.courses[v].behind.len(), view.bodies[v].len());
        ride.counted = counted[v].to - counted[v].from;
        ride
    };
    let mut rides: Vec<Ride<L>> = (0..view.bodies.len()).map(ride).collect();
    let mut searches: Vec<Search> = lanes.iter().map(|lone| Search::new(lone, view.rows, view.look)).collect();
    let mut band = Band {
        factors: lanes[0].factors.is_some().then(|| BridgeFactors {
            coordinates: of(&|lone| lone.factors.map_or(1.0, |factors| factors.coordinates)),
            rates: of(&|lone| lone.factors.map_or(1.0, |factors| factors.rates)),
        }),
        static_loads: (0..axles).map(|k| of(&|lone| lone.static_loads[k])).collect(),
        exits: of(&|lone| lone.exit.step as f64),
        fractions: of(&|lone| lone.fraction(lone.exit.step)),
        saved: vec![Coordinate::rest(); modes],
        tape: Tape::new(),
        places: vec![L::splat(0.0); (TOGETHER * CHUNK + 1) * axles],
        view,
        lanes,
        geometry,
        steppers,
        state,
    };
    let last = lanes.iter().map(|lone| lone.exit.step).max().unwrap_or(0);
    band.tape.begin(widths, 0, 1);
    let State { modes: at_start, increments, .. } = &band.state;
    keep(band.tape.row_mut(0)[0], &widths, at_start, increments, band.factors.as_ref(), &band.static_loads);
    let mut from = 0;
    while from <= last {
        let approach = from < first;
        let end = if approach { first } else { last + 1 };
        let (to, most) = (end.min(from + CHUNK), if approach { 1 } else { TOGETHER });
        if !approach && band.state.modes.is_empty() {
            band.state.modes = vec![Coordinate::rest(); modes];
        }
        if band.tape.steps == 0 {
            band.tape.begin(widths, from, most.min((end - from).div_ceil(CHUNK)));
        }
        L::dispatch(Going { band: &mut band, approach, steps: from..to })?;
        let Band { tape, static_loads, .. } = &mut band;
        L::dispatch(Riding { rides: &mut rides, tape, static_loads, counted: &counted, count: to - from });
        if to == end || band.tape.steps == most * CHUNK {
            if !approach {
                L::dispatch(Looking { band: &band, searches: &mut searches, desk });
            }
            let steps = band.tape.steps;
            band.places.copy_within(steps * axles..(steps + 1) * axles, 0);
            band.tape.go_on();
        }
        stop.check().map_err(|_| Trouble::Interrupted)?;
        from = to;
    }
    let mut tail = Tail {
        ends: lanes.iter().map(|lone| lone.end.map(|(last, fraction)| (last - lone.exit.step, fraction))).collect(),
        ending: band.saved.clone(),
        modes: std::mem::take(&mut band.saved),
        vibration: band.steppers.bridge.vibration(),
        tape: std::mem::take(&mut band.tape),
        view,
        lanes,
        factors: band.factors,
    };
    tail.go(&mut searches, desk, stop)?;
    let Tail { ends, ending, mut vibration, .. } = tail;
    let reach = vibration.reach(&ending);
    let landed = searches.into_iter().zip(ends).enumerate().map(|(lane, (search, end))| {
        let (steps, fraction) = end.unwrap_or((0, 1.0));
        let [dynamic, at_rest] = search.stops;
        let mut at_rest = search.at_rest.seen(view.look, at_rest);
        if steps > 0 {
            // Nobody is on the bridge in the tail.
            at_rest.steps.iter_mut().for_each(|peaks| peaks.take(0.0, (lanes[lane].exit.step + 1) as f64));
        }
        Landed {
            seen: [search.dynamic.seen(view.look, dynamic), at_rest],
            end: (lanes[lane].exit.step + steps, fraction),
            reach: BridgeFactors::reach(lanes[lane].factors.as_ref(), reach.one(lane)),
        }
    });
    Ok((landed.collect(), rides))
}

/// The bridge by itself, after all have left: lanes side by side again, each from where it had come.
struct Tail<'s, 'a, L> {
    view: View<'s, L>,
    lanes: &'s [&'s Lone<'a>],
    factors: Option<BridgeFactors<L>>,
    vibration: Vibration<L>,
    modes: Vec<Coordinate<L>>,
    /// The modes where each lane ends.
    ending: Vec<Coordinate<L>>,
    /// After how many steps, and how far through the last, each lane ends, if that is known.
    ends: Vec<Option<(usize, f64)>>,
    tape: Tape<L>,
}

impl<L: Lanes> Tail<'_, '_, L> {
    fn go(&mut self, searches: &mut [Search], desk: &mut Desk, stop: StopToken<'_>) -> Result<(), Trouble> {
        let widths = self.tape.widths;
        self.decide(0, searches);
        let mut from = 1;
        // The tape goes on from the last step on the bridge, in other numbers.
        self.tape.begin(widths, from, 1);
        let latest = |ends: &[Option<(usize, f64)>]| {
            ends.iter().map(|end| end.map_or(usize::MAX, |(last, _)| last)).max().unwrap_or(0)
        };
        while from <= latest(&self.ends) {
            let to = latest(&self.ends).saturating_add(1).min(from + LOOK_EVERY);
            let last = L::from_fn(|lane| self.end(lane).map_or(f64::INFINITY, |(last, _)| last as f64));
            let fraction = L::from_fn(|lane| self.end(lane).map_or(1.0, |(_, fraction)| fraction));
            L::dispatch(Swinging { tail: self, steps: from..to, last, fraction });
            L::dispatch(LookingBack { tail: self, searches, desk });
            self.tape.go_on();
            self.decide(to - 1, searches);
            stop.check().map_err(|_| Trouble::Interrupted)?;
            from = to;
        }
        Ok(())
    }

    fn end(&self, lane: usize) -> Option<(usize, f64)> {
        self.ends[lane.min(self.ends.len() - 1)]
    }

    /// Ends lanes of which it is not known when they end and of which nothing can come any more.
    fn decide(&mut self, step: usize, searches: &[Search]) {
        if self.ends.iter().all(Option::is_some) || !step.is_multiple_of(LOOK_EVERY) {
            return;
        }
        let reach = self.vibration.reach(&self.modes);
        let View { free, look, .. } = self.view;
        for (lane, search) in searches.iter().enumerate() {
            if self.ends[lane].is_some() {
                continue;
            }
            let lone = self.lanes[lane];
            let own = BridgeFactors::reach(lone.factors.as_ref(), reach.one(lane));
            let reached = |row: usize| {
                let at_step = search.dynamic.of(look.rows[row].response).unwrap_or_else(Peaks::nothing);
                let at_stop = &search.stops[0][row];
                [at_step.max.larger(at_stop.max), at_step.min.smaller(at_stop.min)]
            };
            let load = lone.static_loads.iter().sum();
            if step >= lone.trip.steps.tail || free.settled(&own, load, reached) {
                self.ends[lane] = Some((step, 1.0));
                let ending = L::from_fn(|other| if other == lane { 1.0 } else { 0.0 });
                let ending = L::splat(0.5).less(ending);
                self.keep_ending(ending);
            }
        }
    }

    #[inline(always)]
    fn keep_ending(&mut self, ending: L::Mask) {
        for (own, mode) in self.ending.iter_mut().zip(&self.modes) {
            own.x = L::select(ending, mode.x, own.x);
            own.v = L::select(ending, mode.v, own.v);
            own.a = L::select(ending, mode.a, own.a);
        }
    }
}

/// Steps of the tail.
struct Swinging<'g, 's, 'a, L> {
    tail: &'g mut Tail<'s, 'a, L>,
    steps: Range<usize>,
    last: L,
    fraction: L,
}

impl<L: Lanes> Work for Swinging<'_, '_, '_, L> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Swinging { tail, steps, last, fraction } = self;
        let widths = tail.tape.widths;
        for step in steps.clone() {
            let before = tail.modes.clone();
            tail.vibration.swing(&mut tail.modes);
            let now = L::splat(step as f64);
            let ended = last.less(now);
            let ending = !(ended | now.less(last));
            let short = !(!ending | !fraction.less(L::splat(1.0)));
            let modes = shortened(short, fraction, &before, &tail.modes);
            let derivative = |order: usize, m: usize| match order {
                0 => modes[m].x,
                1 => modes[m].v,
                _ => modes[m].a,
            };
            let [before, row] = tail.tape.row_mut(step);
            row.fill(L::splat(0.0));
            widths.write_modes(row, modes.len(), derivative, tail.factors.as_ref());
            for (b, a) in before.iter().zip(row).take(widths.coordinates) {
                *a = L::select(ended, *b, *a);
            }
            if L::any(ending) {
                tail.keep_ending(ending);
            }
        }
        tail.tape.take(steps.len());
    }
}

/// The responses of all lanes in these.
struct LookingBack<'g, 's, 'a, L> {
    tail: &'g Tail<'s, 'a, L>,
    searches: &'g mut [Search],
    desk: &'g mut Desk,
}

impl<L: Lanes> Work for LookingBack<'_, '_, '_, L> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let LookingBack { tail: Tail { view, lanes, ends, tape, .. }, searches, desk } = self;
        let c = tape.widths.coordinates;
        for (lane, search) in searches.iter_mut().enumerate() {
            let last = ends[lane].map_or(usize::MAX, |(last, _)| last);
            let steps = last.saturating_add(1).saturating_sub(tape.from).min(tape.steps);
            lay_out(&mut desk.stretches, tape, steps, |stretch, _, _, limits| {
                stretch.coordinates.extend(limits[..c].iter().map(|[most, least]| [most.get(lane), least.get(lane)]));
            });
            let at = |step: usize, moment: &mut Moment| {
                moment.coordinates.clear();
                moment.coordinates.extend(tape.row(step)[..c].iter().map(|a| [a.get(lane)]));
                moment.placed.clear();
            };
            search.dynamic.look(view.rows, view.windows[0], (&[], &desk.stretches), at, (lanes[lane].exit.step, true));
        }
    }
}
