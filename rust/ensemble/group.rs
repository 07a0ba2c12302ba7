//! One group of samples side by side, one in each lane, through a whole crossing: chunks of steps, and then the extremes in
//! them.

use std::ops::Range;

use super::bounds::Searching;
use super::table::{Chunk, Table};
use super::tabulated::Tabulated;
use crate::coordinate::{Coordinate, shortened};
use crate::crossing::tail::FreeRows;
use crate::extremes::{Peaks, PlacedSteps, Seen, at_stop, interpolate};
use crate::lane::{Lane, Lanes, Work};
use crate::recovery::{Placed, Rows};
use crate::road::random::Synthesis;
use crate::selection::Selection;
use crate::statistics::Ride;
use crate::step::driving::ModalForces;
use crate::step::forced::Forced;
use crate::step::gait::{COULOMB, DAMPERS, Gait, SPRINGS, Standing};
use crate::step::stepper::{State, Stepper, Unsettled};
use crate::step::swift::{ANY, Coupling, Swift};
use crate::step::vibration::{Reach, Vibration};
use crate::stop_token::StopToken;
use crate::stops::{PassingInfluence, Positions};
use crate::tape::{BridgeFactors, CHUNK, Tape, Widths, write_at_rest};

/// When the lanes of a group have done.
#[derive(Debug, Clone)]
pub struct Ends<L> {
    /// Last step of each lane.
    pub last: L,
    /// How far through its last step a lane ends.
    pub fraction: L,
    /// Last step of the slowest lane.
    pub latest: usize,
    /// Whether lanes end before that as soon as nothing can come any more.
    pub free: bool,
}

impl<L: Lane> Ends<L> {
    /// Ends lanes of a mask with this step, if they have not ended before; says which.
    #[inline(always)]
    fn end(&mut self, mask: L::Mask, step: usize) -> L::Mask {
        let now = L::splat(step as f64);
        let ending = !(!mask | self.last.less(now));
        self.last = L::select(ending, now, self.last);
        self.latest = (0..L::SAMPLES).map(|lane| self.last.get(lane) as usize).max().unwrap_or(step);
        ending
    }
}

/// How a group comes from step to step.
pub enum Engine<'e, 'a, L> {
    /// Bridge and vehicles together, and where these are.
    Coupled(&'e mut Steppers<L>, Tabulated<'a, L>),
    /// The bridge alone, as constant loads [N] drive it.
    Driven(&'e Forced<L>, &'e [L]),
}

impl<L: Lane> Engine<'_, '_, L> {
    /// Static loads of all axles [N].
    fn static_loads(&self) -> Vec<L> {
        match self {
            Engine::Coupled(steppers, _) => steppers.bridge.static_loads(),
            Engine::Driven(_, loads) => loads.to_vec(),
        }
    }

    /// The bridge by itself.
    fn vibration(&self) -> Vibration<L> {
        match self {
            Engine::Coupled(steppers, _) => steppers.bridge.vibration(),
            Engine::Driven(forced, _) => forced.vibration(),
        }
    }

    /// The state at the start.
    fn start(&mut self, table: &Table) -> Result<State<L>, Unsettled> {
        match self {
            Engine::Coupled(steppers, geometry) => steppers.starter.start(&[geometry.speed], geometry),
            Engine::Driven(forced, loads) => Ok(State::of_loads(table.loads(), start_driven(table, forced, loads))),
        }
    }
}

/// The steppers of a group.
#[derive(Debug, Clone)]
pub struct Steppers<L> {
    /// Finds the state at the start, for the modes that this has.
    pub starter: Stepper<L>,
    /// Steps without a bridge, as long as no axle has come on to it.
    pub approach: Stepper<L>,
    /// Steps on the bridge.
    pub bridge: Stepper<L>,
}

/// Samples side by side.
#[derive(Debug, Clone)]
pub struct Group<'a, L> {
    /// Their bridges, if these differ.
    pub bridge: Option<BridgeFactors<L>>,
    /// When they end.
    pub ends: Ends<L>,
    /// Vertical displacements of the bodies, as rows over the coordinates of the vehicle.
    pub bodies: &'a [Vec<f64>],
}

/// What has been found of a group.
#[derive(Debug, Clone)]
pub struct Found<L> {
    /// Extremes of the responses.
    pub seen: Seen<L>,
    /// Contact forces and accelerations.
    pub ride: Ride<L>,
    /// What free vibration can reach after the last step of each lane.
    pub reach: Option<Reach<L>>,
}

/// Why a group did not come through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Trouble {
    /// One of its samples failed, in this step or in the chunk that ends with it.
    Failed(usize, Option<Unsettled>),
    /// The caller wants it to end.
    Interrupted,
}

/// Where a group marches, and what is looked at.
#[derive(Debug, Clone, Copy)]
pub struct Scene<'a> {
    /// The shared geometry.
    pub table: &'a Table,
    /// The rows of the bridge.
    pub rows: &'a Rows,
    /// The responses looked at.
    pub look: &'a Selection,
    /// The same without vehicles on the bridge.
    pub free: &'a FreeRows,
    /// Whether to look for trouble after every step and not only after every chunk.
    pub closely: bool,
}

/// Most modes whose number is known where steps are compiled.
const MOST_MODES: usize = 6;

/// Most numbers on a group's tape.
pub const KEPT: usize = 1 << 15;

/// Chunks on a tape, at most.
fn longest(widths: &Widths) -> usize {
    (KEPT / (widths.all() * CHUNK)).max(1)
}

/// What a worker needs again for each group, so that memory is asked for once.
#[derive(Debug, Clone)]
pub struct Scratch<L> {
    tape: Tape<L>,
    glanced: Vec<[L; 2]>,
    between: Vec<L>,
    influence: PassingInfluence,
    chunks: Vec<Chunk>,
}

impl<L: Lane> Scratch<L> {
    /// Nothing yet.
    pub fn new() -> Self {
        let (tape, glanced) = (Tape::new(), Vec::new());
        Scratch { tape, glanced, between: Vec::new(), influence: PassingInfluence::default(), chunks: Vec::new() }
    }
}

impl<L: Lane> Default for Scratch<L> {
    fn default() -> Self {
        Scratch::new()
    }
}

/// One group on its scene.
struct Traveller<'g, 'a, L> {
    group: &'g mut Group<'a, L>,
    state: State<L>,
    /// The modes a step before, in the tail.
    before: Vec<Coordinate<L>>,
    /// Loads at rest, of the axles or of all together.
    static_loads: Vec<L>,
    /// What all axles weigh.
    weight: L,
    /// The bridge by itself.
    vibration: Vibration<L>,
}

impl<L: Lane> Traveller<'_, '_, L> {
    /// Keeps what recovery needs of a step in its row.
    #[inline(always)]
    fn keep(&self, kept: &mut [L], widths: &Widths) {
        let State { modes, increments, coordinates, .. } = &self.state;
        keep(kept, widths, modes, self.group.bridge.as_ref(), (&self.static_loads, increments));
        keep_accelerations(&mut kept[widths.accelerations()..], self.group.bodies, coordinates);
    }

    /// Ends lanes on time: what ends within the step is cut short, and what has ended repeats the row before.
    #[inline(always)]
    fn end(&self, step: usize, [before, row]: [&mut [L]; 2], widths: &Widths) {
        let (one, now) = (L::splat(1.0), L::splat(step as f64));
        let ends = &self.group.ends;
        let ended = ends.last.less(now);
        let ending = !(ended | now.less(ends.last));
        // A whole last step is not rounded.
        let short = !(!ending | !ends.fraction.less(one));
        if L::any(short) {
            // What is cut are the modes, not what the rows take of a bridge that is varied.
            let modes = shortened(short, ends.fraction, &self.before, &self.state.modes);
            write_modes(row, widths, &modes, self.group.bridge.as_ref());
            for (b, a) in before.iter().zip(&mut *row).skip(widths.coordinates) {
                *a = L::select(short, *b + ends.fraction * (*a - *b), *a);
            }
        }
        for (b, a) in before.iter().zip(row) {
            *a = L::select(ended, *b, *a);
        }
    }

    /// What free vibration can reach from here on, for the rows.
    #[inline(always)]
    fn reach(&mut self) -> Reach<L> {
        BridgeFactors::reach(self.group.bridge.as_ref(), self.vibration.reach(&self.state.modes))
    }

    /// Whether everything is a finite number in lanes that have not ended.
    #[inline(always)]
    fn sound(&self, step: usize) -> bool {
        let zero = L::splat(0.0);
        let mut sum = zero;
        for c in &self.state.modes {
            sum = sum + c.a;
        }
        for c in &self.state.coordinates {
            sum = sum + c.a;
        }
        for p in &self.state.increments {
            sum = sum + *p;
        }
        // Nought, unless something is infinite or not a number.
        #[allow(clippy::eq_op)]
        let nought = sum - sum;
        let ended = self.group.ends.last.less(L::splat(step as f64));
        L::all(!(nought.less(zero) | !nought.less(L::splat(1.0))) | ended)
    }
}

/// Keeps the modes and the loads, static and increments, of a step in its row.
#[inline(always)]
fn keep<L: Lane>(
    kept: &mut [L],
    widths: &Widths,
    modes: &[Coordinate<L>],
    factors: Option<&BridgeFactors<L>>,
    (at_rest, increments): (&[L], &[L]),
) {
    write_modes(kept, widths, modes, factors);
    let loads = kept[widths.loads()..][..widths.axles].iter_mut();
    for ((load, at_rest), increment) in loads.zip(at_rest).zip(increments) {
        *load = *at_rest + *increment;
    }
}

/// Keeps the modes of a step in its row.
#[inline(always)]
fn write_modes<L: Lane>(kept: &mut [L], widths: &Widths, modes: &[Coordinate<L>], factors: Option<&BridgeFactors<L>>) {
    let derivative = |order: usize, m: usize| match order {
        0 => modes[m].x,
        1 => modes[m].v,
        _ => modes[m].a,
    };
    widths.write_modes(kept, modes.len(), derivative, factors);
}

/// Keeps the accelerations of the bodies, which are rows over the coordinates of the vehicle.
#[inline(always)]
fn keep_accelerations<L: Lane>(kept: &mut [L], bodies: &[Vec<f64>], coordinates: &[Coordinate<L>]) {
    for (acceleration, row) in kept.iter_mut().zip(bodies) {
        let terms = row.iter().zip(coordinates);
        *acceleration = terms.fold(L::splat(0.0), |sum, (factor, q)| sum + L::splat(*factor) * q.a);
    }
}

/// Where a chunk of steps lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Where {
    /// Before the bridge, which is at rest.
    Approach,
    /// With axles on the bridge.
    Bridge,
    /// Behind it.
    Tail,
}

/// A chunk of steps being taken.
struct Stepping<'s, 'g, 'a, L> {
    traveller: &'s mut Traveller<'g, 'a, L>,
    steppers: &'s mut Steppers<L>,
    geometry: &'s mut Tabulated<'a, L>,
    scene: &'s Scene<'s>,
    tape: &'s mut Tape<L>,
    place: Where,
    steps: Range<usize>,
    stop: StopToken<'s>,
}

impl<L: Lane> Work for Stepping<'_, '_, '_, L> {
    type Output = Result<(), Trouble>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Stepping { traveller, steppers, geometry, scene, tape, place, steps, stop } = self;
        let widths = tape.widths;
        let stepper = if place == Where::Approach { &mut steppers.approach } else { &mut steppers.bridge };
        for step in steps.clone() {
            if step > 0
                && let Err(e) = stepper.advance(&mut traveller.state, geometry)
            {
                return Err(Trouble::Failed(step, Some(e)));
            }
            let [before, row] = tape.row_mut(step);
            traveller.keep(row, &widths);
            if place == Where::Tail {
                traveller.end(step, [before, row], &widths);
            }
            if scene.closely && !traveller.sound(step) {
                return Err(Trouble::Failed(step, None));
            }
        }
        // Not in the loop: the compiler would write its last round down once more.
        if !traveller.sound(steps.end - 1) {
            return Err(Trouble::Failed(steps.end - 1, None));
        }
        stop.check().map_err(|_| Trouble::Interrupted)
    }
}

/// The same with the own steps of a gait: on K contacts, with N coordinates; on a bridge with M modes, or any number.
struct Striding<'s, 'g, 'a, L, const K: usize, const N: usize, const LAW: u8, const M: usize>(Stepping<'s, 'g, 'a, L>);

impl<L: Lane, const K: usize, const N: usize, const LAW: u8, const M: usize> Work
    for Striding<'_, '_, '_, L, K, N, LAW, M>
{
    type Output = Result<(), Trouble>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Stepping { traveller, steppers, geometry, tape, place, steps, stop, .. } = self.0;
        let widths = tape.widths;
        let Traveller { group, state, static_loads, .. } = &mut *traveller;
        let Group { bridge, bodies, .. } = &mut **group;
        let (approach, static_loads) = (place == Where::Approach, &static_loads[..K]);
        let stepper = if approach { &steppers.approach } else { &steppers.bridge };
        let mut swift = Swift::<L, K, N, LAW>::new(stepper, state, geometry.speed);
        let alone = Coupling::alone(&steppers.approach);
        // Where their number is known they stay where the compiler can see them.
        let mut own = [Coordinate::rest(); MOST_MODES];
        let modes = if M == ANY {
            &mut state.modes[..]
        } else {
            own[..M].copy_from_slice(&state.modes[..M]);
            &mut own[..M]
        };
        let rows = tape.rows_mut(steps.clone()).chunks_exact_mut(widths.all());
        for (step, row) in steps.clone().zip(rows) {
            if step > 0 {
                let interaction = if approach { None } else { geometry.interaction_at(step) };
                let under = geometry.under(step, LAW == DAMPERS);
                if !swift.step::<M>(modes, interaction.unwrap_or_default(), &alone, under) {
                    return Err(Trouble::Failed(step, Some(Unsettled::ContactForces)));
                }
            }
            keep(row, &widths, modes, bridge.as_ref(), (static_loads, &swift.increments));
            keep_accelerations(&mut row[widths.accelerations()..], bodies, &swift.coordinates);
        }
        if M != ANY {
            state.modes[..M].copy_from_slice(&own[..M]);
        }
        swift.end(state);
        geometry.go_to(steps.end - 1);
        if place == Where::Tail {
            for step in steps.clone() {
                traveller.end(step, tape.row_mut(step), &widths);
            }
        }
        if !traveller.sound(steps.end - 1) {
            return Err(Trouble::Failed(steps.end - 1, None));
        }
        stop.check().map_err(|_| Trouble::Interrupted)
    }
}

impl<L: Lanes> Stepping<'_, '_, '_, L> {
    /// Takes the steps, as the gait of the vehicle has them if it is a usual one.
    fn go(self) -> Result<(), Trouble> {
        let approach = self.place == Where::Approach;
        let stepper = if approach { &self.steppers.approach } else { &self.steppers.bridge };
        let known = approach || self.geometry.interaction_at(self.steps.start).is_some();
        let gait = stepper.gait().filter(|_| known && !self.scene.closely);
        // Debug builds know none: they change no bit and take most of the time to compile.
        macro_rules! gaits {
            ($(($law:ident $number:ident $contacts:literal $coordinates:literal $modes:pat => $known:expr)),*) => {
                match (gait, self.traveller.state.modes.len()) {
                    $((Some(Gait { contacts: $contacts, coordinates: $coordinates, law: Standing::$law }), $modes)
                        if !cfg!(debug_assertions) =>
                    {
                        L::dispatch(Striding::<L, $contacts, $coordinates, $number, $known>(self))
                    })*
                    _ => L::dispatch(self),
                }
            };
        }
        gaits!(
            (Coulomb COULOMB 2 2 0 => 0),
            (Coulomb COULOMB 2 2 3 => 3),
            (Coulomb COULOMB 2 2 6 => 6),
            (Coulomb COULOMB 2 2 _ => ANY),
            (Coulomb COULOMB 3 2 _ => ANY),
            (Coulomb COULOMB 4 2 _ => ANY),
            (Coulomb COULOMB 5 2 _ => ANY),
            (Springs SPRINGS 1 2 _ => ANY),
            (Springs SPRINGS 2 4 _ => ANY),
            (Springs SPRINGS 3 6 _ => ANY),
            (Springs SPRINGS 5 8 _ => ANY),
            (Dampers DAMPERS 2 4 _ => ANY),
            (Dampers DAMPERS 3 6 _ => ANY),
            (Dampers DAMPERS 5 8 _ => ANY)
        )
    }
}

/// The same under constant loads, which nothing couples to the bridge.
struct Driving<'s, 'g, 'a, L> {
    traveller: &'s mut Traveller<'g, 'a, L>,
    forced: &'s Forced<L>,
    loads: &'s [L],
    table: &'s Table,
    tape: &'s mut Tape<L>,
    place: Where,
    steps: Range<usize>,
}

impl<L: Lane> Work for Driving<'_, '_, '_, L> {
    type Output = Result<(), Trouble>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Driving { traveller, forced, loads, table, tape, place, steps } = self;
        let widths = tape.widths;
        let mut forces = ModalForces::nothing();
        for step in steps.clone() {
            let modes = &mut traveller.state.modes;
            match (&table.resultant, &table.drive) {
                _ if step == 0 || place == Where::Approach => {}
                (Some(resultant), _) => forced.advance(modes, &resultant.driving[step], L::splat),
                (None, Some(drive)) => {
                    drive.at(step, |step, axle| table.path.x(step, axle), loads, &mut forces);
                    forced.advance(modes, &forces, |force| force);
                }
                (None, None) => {}
            }
            let [before, row] = tape.row_mut(step);
            traveller.keep(row, &widths);
            if place == Where::Tail {
                traveller.end(step, [before, row], &widths);
            }
        }
        if traveller.sound(steps.end - 1) { Ok(()) } else { Err(Trouble::Failed(steps.end - 1, None)) }
    }
}

/// Steps of the tail: the bridge by itself, once the vehicle is of no more concern, and what it can reach where lanes end.
struct Swinging<'s, 'g, 'a, L> {
    traveller: &'s mut Traveller<'g, 'a, L>,
    reach: &'s mut Option<Reach<L>>,
    tape: &'s mut Tape<L>,
    steps: Range<usize>,
    /// The first of them in which the vehicle is not followed.
    alone: usize,
}

impl<L: Lane> Work for Swinging<'_, '_, '_, L> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Swinging { traveller, reach, tape, steps, alone } = self;
        let widths = tape.widths;
        for step in steps {
            if step >= alone {
                let Traveller { before, state, .. } = &mut *traveller;
                before.clone_from(&state.modes);
                traveller.vibration.swing(&mut traveller.state.modes);
                let [before, row] = tape.row_mut(step);
                traveller.keep(row, &widths);
                traveller.end(step, [before, row], &widths);
            }
            let (now, last) = (L::splat(step as f64), traveller.group.ends.last);
            let ending = !(last.less(now) | now.less(last));
            if L::any(ending) {
                let own = traveller.reach();
                if let Some(reach) = reach {
                    reach.select(ending, &own);
                }
            }
        }
    }
}

/// The lanes being looked at whether something can still come, after a step with nobody on the bridge.
struct Deciding<'s, 'g, 'a, L> {
    traveller: &'s mut Traveller<'g, 'a, L>,
    found: &'s mut Found<L>,
    scene: &'s Scene<'s>,
    step: usize,
}

impl<L: Lane> Work for Deciding<'_, '_, '_, L> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Deciding { traveller, found, scene, step } = self;
        let reach = traveller.reach();
        if traveller.group.ends.free {
            let settled = scene.free.settled(&reach, traveller.weight, |row| found.seen.reached(row));
            let ending = traveller.group.ends.end(settled, step);
            if let Some(own) = &mut found.reach {
                own.select(ending, &reach);
            }
        }
        found.reach.get_or_insert(reach);
    }
}

/// A chunk taken in: ride and stops, not yet the responses at steps.
struct TakingIn<'s, L> {
    found: &'s mut Found<L>,
    scene: &'s Scene<'s>,
    static_loads: &'s [L],
    ends: &'s Ends<L>,
    place: Where,
    steps: Range<usize>,
    /// The next stop.
    stop: &'s mut usize,
    tape: &'s mut Tape<L>,
    between: &'s mut Vec<L>,
    influence: &'s mut PassingInfluence,
}

impl<L: Lane> Work for TakingIn<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let TakingIn { found, scene, ends, place, steps, stop, tape, between, .. } = self;
        let Found { seen, ride, .. } = found;
        let widths = tape.widths;
        let last = scene.table.path.steps;
        tape.take(steps.len());
        // What becomes of vehicles behind the bridge is none of its business.
        if place != Where::Tail {
            let left = |step: usize| if step < last { 1.0 } else { 0.0 };
            ride.take(tape, self.static_loads, left, place == Where::Bridge);
        }
        if place == Where::Approach {
            return;
        }
        while let Some(next) = scene.table.stops.get(*stop).filter(|stop| stop.step < steps.end) {
            let sides = [tape.row(next.step - 1), tape.row(next.step)];
            let before = (next.step > last).then(|| seen.stops.clone());
            let influence = scene.table.passing_influence(*stop, scene.rows, scene.look, self.influence);
            interpolate(next, sides, &widths, between);
            at_stop(&mut seen.stops, scene.look, (next, *stop, influence), between);
            // Lanes that end with the last step on the bridge see nothing of the next.
            let ended = ends.last.less(L::splat(next.step as f64));
            for (peaks, before) in seen.stops.iter_mut().zip(before.into_iter().flatten()) {
                *peaks = peaks.unless(ended, before);
            }
            *stop += 1;
        }
    }
}

// The stages of a crossing, in functions of their own: by their names `benches/instructions.py` counts them one by one.

/// Draws the roads of a group.
#[inline(never)]
pub fn draw_roads<L: Lanes, F: Fn(usize) -> u64>(drawing: Drawing<'_, L, F>) {
    L::dispatch(drawing);
}

/// Takes the steps before the bridge.
#[inline(never)]
fn step_ahead<L: Lanes>(mut stepping: Stepping<'_, '_, '_, L>) -> Result<(), Trouble> {
    // It is so anyway; said here, the function is not the next one, which the compiler would put in its place.
    stepping.place = Where::Approach;
    stepping.go()
}

/// Takes the steps on the bridge, or behind it.
#[inline(never)]
fn step_on_bridge<L: Lanes>(stepping: Stepping<'_, '_, '_, L>) -> Result<(), Trouble> {
    stepping.go()
}

/// Takes in a chunk.
#[inline(never)]
fn take_in<L: Lanes>(taking_in: TakingIn<'_, L>) {
    L::dispatch(taking_in);
}

/// Looks at the responses at the steps of a tape, with axles on the bridge or not.
#[inline(never)]
fn survey<L: Lanes>(
    scene: &Scene<'_>,
    peaks: &mut [Peaks<L>],
    tape: &Tape<L>,
    loaded: bool,
    (glanced, own_chunks): (&mut Vec<[L; 2]>, &mut Vec<Chunk>),
) {
    let Scene { table, rows, look, .. } = *scene;
    let steps = tape.from..tape.from + tape.steps;
    if L::SAMPLES == 1 && !table.laid_out {
        let (mut all, places) = (PlacedSteps::<1>::default(), if loaded { table.places(steps) } else { &[] });
        let (c, axles) = (rows.width(), if loaded { table.axles() } else { 0 });
        all.begin(tape.from, axles);
        for (i, kept) in tape.taken().enumerate() {
            all.coordinates.extend(kept[..c].iter().map(|a| [a.get(0)]));
            let here = places[i * axles..][..axles].iter().zip(&kept[c..]);
            all.placed.extend(here.map(|(&place, load)| Placed::new(place, [load.get(0)])));
        }
        return all.look(rows, look, [peaks]);
    }
    let chunks = loaded.then(|| table.chunks(steps.start, steps.end, rows, look, own_chunks));
    // What is known when this is compiled runs much faster: the usual numbers of modes and axles. Not in debug builds,
    // which it would make long.
    macro_rules! sizes {
        ($($c:literal $a:literal),*) => {
            match (rows.width(), if loaded { table.loads() } else { 0 }) {
                $(($c, $a) if !cfg!(debug_assertions) => {
                    L::dispatch(Searching::<L, $c, $a> { peaks, factors: &look.factors, tape, chunks, glanced })
                })*
                _ => L::dispatch(Searching::<L, 0, 0> { peaks, factors: &look.factors, tape, chunks, glanced }),
            }
        };
    }
    sizes!(1 2, 2 2, 3 2, 4 2, 5 2, 6 2, 3 3, 6 3, 3 5, 6 5)
}

/// Marches a group of samples through the table.
pub fn cross_group<'a, L: Lanes>(
    scene: &Scene<'_>,
    group: &mut Group<'a, L>,
    engine: &mut Engine<'_, 'a, L>,
    scratch: &mut Scratch<L>,
    stop: StopToken<'_>,
) -> Result<Found<L>, Trouble> {
    let Scene { table, rows, look, .. } = *scene;
    let steps = table.path.steps;
    let bodies = group.bodies.len();
    let widths = Widths::of(rows, table.loads(), bodies);
    let longest = longest(&widths);
    let Scratch { tape, glanced, between, influence, chunks: own_chunks } = scratch;
    let mut found = Found {
        // The bridge is at rest until an axle comes on to it.
        seen: Seen::beginning(look.rows.len(), table.first > 0),
        ride: Ride::nothing(table.axles(), bodies),
        reach: None,
    };
    let of_axles = engine.static_loads();
    let state = engine.start(table).map_err(|e| Trouble::Failed(0, Some(e)))?;
    let weight = of_axles.iter().fold(L::splat(0.0), |sum, load| sum + *load);
    let static_loads = if table.resultant.is_some() { vec![L::splat(1.0)] } else { of_axles.clone() };
    // Constant loads have no ride to speak of.
    let riding = if table.drive.is_some() { &[][..] } else { &of_axles };
    let vibration = engine.vibration();
    let before = Vec::new();
    let mut traveller = Traveller { group, state, before, static_loads, weight, vibration };
    tape.begin(widths, 0, 1);
    // Before the first step there is nothing: it stands for the one before.
    traveller.keep(tape.row_mut(0)[0], &widths);
    let (mut next, mut from) = (0, 0);
    while from <= traveller.group.ends.latest {
        let (place, end, most) = if from < table.first {
            (Where::Approach, table.first, 1)
        } else if from <= steps {
            (Where::Bridge, steps + 1, longest)
        } else if traveller.group.ends.free {
            (Where::Tail, traveller.group.ends.latest + 1, 1)
        } else {
            (Where::Tail, traveller.group.ends.latest + 1, longest)
        };
        let to = end.min(from + CHUNK);
        if place != Where::Approach && traveller.state.modes.is_empty() {
            traveller.state.modes = vec![Coordinate::rest(); table.modes];
        }
        if tape.steps == 0 {
            tape.begin(widths, from, most.min((end - from).div_ceil(CHUNK)));
        }
        let with_vehicle = from..to.min(table.last() + 1);
        let alone = with_vehicle.end.max(from);
        if !with_vehicle.is_empty() {
            if place == Where::Tail {
                // It is followed for one step more.
                traveller.before.clone_from(&traveller.state.modes);
            }
            let (traveller, steps) = (&mut traveller, with_vehicle);
            match engine {
                Engine::Coupled(steppers, geometry) => {
                    let stepping = Stepping { traveller, steppers, geometry, scene, tape, place, steps, stop };
                    if place == Where::Approach { step_ahead(stepping)? } else { step_on_bridge(stepping)? }
                }
                Engine::Driven(forced, loads) => {
                    L::dispatch(Driving { traveller, forced, loads, table, tape, place, steps })?;
                    stop.check().map_err(|_| Trouble::Interrupted)?;
                }
            }
        }
        if place == Where::Tail {
            let reach = &mut found.reach;
            L::dispatch(Swinging { traveller: &mut traveller, reach, tape, steps: from..to, alone });
            stop.check().map_err(|_| Trouble::Interrupted)?;
        }
        let taking_in = TakingIn {
            found: &mut found,
            scene,
            static_loads: riding,
            ends: &traveller.group.ends,
            place,
            steps: from..to,
            stop: &mut next,
            tape,
            between,
            influence,
        };
        take_in(taking_in);
        if to == end || tape.steps == most * CHUNK {
            // On the approach the bridge is at rest.
            if place != Where::Approach {
                let loaded = place == Where::Bridge;
                survey(scene, &mut found.seen.steps, tape, loaded, (glanced, own_chunks));
            }
            tape.go_on();
            if to == steps + 1 || place == Where::Tail && traveller.group.ends.free {
                L::dispatch(Deciding { traveller: &mut traveller, found: &mut found, scene, step: to - 1 });
            }
        }
        from = to;
    }
    if table.drive.is_some() {
        found.ride = Ride::steady(&of_axles, found.ride.counted);
    }
    Ok(found)
}

/// The modes at the start, under constant loads where some stand on the bridge then.
fn start_driven<L: Lane>(table: &Table, forced: &Forced<L>, loads: &[L]) -> Vec<Coordinate<L>> {
    match (&table.resultant, &table.drive) {
        (Some(resultant), _) if table.first == 0 => forced.start(&resultant.driving[0], L::splat),
        (None, Some(drive)) if table.first == 0 => {
            let mut forces = ModalForces::nothing();
            drive.at(0, |step, axle| table.path.x(step, axle), loads, &mut forces);
            forced.start(&forces, |force| force)
        }
        _ => Vec::new(),
    }
}

/// How far free vibration can exceed what has been seen, being looked at; not a number where it is not known.
pub struct Growing<'s, L> {
    /// The rows.
    pub free: &'s FreeRows,
    /// What has been found.
    pub found: &'s Found<L>,
}

impl<L: Lane> Work for Growing<'_, L> {
    type Output = [L; 2];

    #[inline(always)]
    fn run(self) -> Self::Output {
        match &self.found.reach {
            Some(reach) => self.free.growth(reach, |row| self.found.seen.reached(row)),
            None => [L::splat(f64::NAN); 2],
        }
    }
}

/// The roads of a group being drawn.
pub struct Drawing<'s, L, F> {
    /// What they have in common.
    pub synthesis: &'s Synthesis,
    /// Seed of the study.
    pub seed: u64,
    /// Number of the sample in each lane.
    pub sample: F,
    /// Where their coefficients go.
    pub road: &'s mut Vec<L>,
}

impl<L: Lane, F: Fn(usize) -> u64> Work for Drawing<'_, L, F> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.synthesis.coefficients_into(self.seed, self.sample, self.road);
    }
}

/// The static extremes under loads that differ from sample to sample.
pub fn rest<L: Lanes>(scene: &Scene<'_>, loads: &[L]) -> Seen<L> {
    let Scene { table, rows, look, .. } = *scene;
    let widths = Widths { felt: true, ..Widths::of(rows, table.loads(), 0) };
    let mut seen = Seen::beginning(look.rows.len(), table.first > 0);
    let (mut own_chunks, mut glanced, mut tape) = (Vec::new(), Vec::new(), Tape::new());
    let longest = longest(&widths);
    for start in (table.first..=table.path.steps).step_by(longest * CHUNK) {
        let end = (start + longest * CHUNK).min(table.path.steps + 1);
        tape.begin(widths, start, (end - start).div_ceil(CHUNK));
        L::dispatch(Resting { scene, loads, steps: start..end, tape: &mut tape });
        survey(scene, &mut seen.steps, &tape, true, (&mut glanced, &mut own_chunks));
    }
    let mut own_moment = PassingInfluence::default();
    let mut then = vec![L::splat(0.0); widths.used()];
    for (number, stop) in table.stops.iter().enumerate() {
        let influence = table.passing_influence(number, rows, look, &mut own_moment);
        write_at_rest(&influence.statics, loads, &mut then);
        at_stop(&mut seen.stops, look, (stop, number, influence), &then);
    }
    seen
}

/// Static loads going over the bridge, onto a tape.
struct Resting<'s, L> {
    scene: &'s Scene<'s>,
    loads: &'s [L],
    steps: Range<usize>,
    tape: &'s mut Tape<L>,
}

impl<L: Lane> Work for Resting<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Resting { scene, loads, steps, tape } = self;
        let mut scratch = Vec::new();
        for step in steps.clone() {
            let [_, row] = tape.row_mut(step);
            write_at_rest(scene.table.statics(step, scene.rows, &mut scratch), loads, row);
        }
        tape.take_all(steps.len());
    }
}
