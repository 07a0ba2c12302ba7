//! A crossing marched through time: steps, brakes, vehicles that come to rest, when it ends, what is recorded.

use crate::bridge::cubics::Mesh;
use crate::coordinate::Coordinate;
use crate::crossing::history::{History, VehicleColumns};
use crate::crossing::tail::{self, Watch};
use crate::crossing::trip::{Trip, overlap, passed};
use crate::error::Error;
use crate::geometry::free::Free;
use crate::geometry::prescribed::Prescribed;
use crate::geometry::{Follow, Geometry};
use crate::modal_bridge::ModalBridge;
use crate::passage::Braking;
use crate::passage::planned::Course;
use crate::passage::settings::{Settings, Tail};
use crate::passage::step_length::MAX_STEPS;
use crate::step::rolling::{Brakes, Rolling};
use crate::step::stepper::{Scheme, State, Stepper, Unsettled};
use crate::step::vehicle_step::VehicleSolve;
use crate::step::vibration::{LOOK_EVERY, Vibration};
use crate::stop_token::StopToken;

/// Most steps between two questions whether to go on.
const POLL_EVERY: usize = 1024;

/// Pairs of axles, which press on each other in every step, between two questions.
const PAIRS: usize = 1 << 20;

/// How the contacts come from one step to the next.
pub trait Contacts: Geometry<f64> {
    /// The first state.
    fn start(
        &mut self,
        rolling: &mut Rolling,
        starter: &mut Stepper<f64>,
        speeds: &[f64],
    ) -> Result<State<f64>, Unsettled>;

    /// One step.
    fn step(
        &mut self,
        rolling: &mut Rolling,
        stepper: &mut Stepper<f64>,
        state: &mut State<f64>,
    ) -> Result<(), Unsettled>;

    /// The bridge by itself, as it goes on in such steps.
    fn vibration(&self, stepper: &Stepper<f64>) -> Vibration<f64> {
        stepper.vibration()
    }

    /// Holds a contact where it is, its vehicle having come to rest.
    fn hold(&mut self, contact: usize);
}

impl<M: Fn(usize, usize) -> Coordinate<f64>> Contacts for Prescribed<'_, M> {
    fn start(&mut self, _: &mut Rolling, starter: &mut Stepper<f64>, speeds: &[f64]) -> Result<State<f64>, Unsettled> {
        starter.start(speeds, self)
    }

    fn step(&mut self, _: &mut Rolling, stepper: &mut Stepper<f64>, state: &mut State<f64>) -> Result<(), Unsettled> {
        stepper.advance(state, self)
    }

    // Prescribed motion goes on as prescribed.
    fn hold(&mut self, _: usize) {}
}

impl<M: Fn(usize, usize) -> Option<Coordinate<f64>>> Contacts for Free<'_, M> {
    fn start(
        &mut self,
        rolling: &mut Rolling,
        starter: &mut Stepper<f64>,
        speeds: &[f64],
    ) -> Result<State<f64>, Unsettled> {
        rolling.start(starter, speeds, self)
    }

    fn step(
        &mut self,
        rolling: &mut Rolling,
        stepper: &mut Stepper<f64>,
        state: &mut State<f64>,
    ) -> Result<(), Unsettled> {
        rolling.advance(stepper, state, self)
    }

    fn hold(&mut self, contact: usize) {
        Follow::hold(self, contact);
    }
}

/// A crossing being marched through time.
pub struct TimeLoop<'a> {
    courses: &'a [Course<'a>],
    settings: &'a Settings,
    mesh: &'a Mesh,
    length: f64,
    h: f64,
    /// Step at whose end a vehicle alone at constant speed has left.
    leaves: Option<usize>,
    stepper: Stepper<f64>,
    starter: Stepper<f64>,
    rolling: Rolling,
    /// The bridge by itself.
    vibration: Vibration<f64>,
    /// After so many steps a vehicle that rolls freely counts as stopped.
    most_steps: usize,
    /// Most steps of the tail.
    tail: usize,
    history: History,
    /// When each vehicle had left the bridge or stood for good.
    ended: Vec<Option<f64>>,
    /// Whether one stands on the bridge.
    loaded: bool,
    /// The way at which the last axle of each vehicle has left the bridge, but for rounding [m].
    beyond: Vec<f64>,
    /// When each vehicle began to brake.
    braking_since: Vec<Option<f64>>,
}

impl<'a> TimeLoop<'a> {
    /// Ready to start.
    pub fn new(model: &'a ModalBridge, trip: &'a Trip<'a>, settings: &'a Settings) -> Self {
        let Trip { courses, steps, length, .. } = trip;
        let (length, moving) = (*length, trip.moving(settings));
        let Settings { beta, gravity, lift_off, .. } = *settings;
        let scheme = Scheme { h: steps.h, beta, gravity, lift_off };
        let mut history = History {
            axles: courses.last().map_or(0, |course| course.axles.end),
            modes: model.omega.len(),
            step: steps.h,
            static_loads: trip.static_loads(gravity),
            ..History::default()
        };
        for course in courses {
            let assembly = course.vehicle.assembly();
            let (motion, first) = (history.motion_width(), history.frictions);
            history.frictions += assembly.frictions.len();
            history.vehicles.push(VehicleColumns {
                axles: course.axles.clone(),
                motion: motion..motion + 3 * (assembly.mass.nrows() + 1),
                frictions: first..history.frictions,
                direction: course.direction.sign(),
                stopped: None,
            });
        }
        // No more than twice as much as is needed for certain.
        history.reserve(steps.count + steps.tail.min(steps.count) + 16);
        let stepper = Stepper::new(&model.omega, &model.damping, &moving, &scheme);
        TimeLoop {
            courses,
            settings,
            mesh: model.shapes.mesh(),
            length,
            h: steps.h,
            leaves: steps.advance.map(|_| steps.count),
            vibration: stepper.vibration(),
            rolling: Rolling::new(courses.len()),
            stepper,
            most_steps: (20 * (steps.count + 1000)).min(2 * MAX_STEPS) + steps.tail,
            tail: steps.tail,
            starter: Stepper::new(&model.omega, &model.damping, &moving, &Scheme { h: 0.0, ..scheme }),
            history,
            ended: vec![None; courses.len()],
            loaded: false,
            beyond: (0..courses.len()).map(|v| trip.beyond(v)).collect(),
            braking_since: vec![None; courses.len()],
        }
    }

    /// Marches until every vehicle has left or stands, and the tail is over, of which `watch` has its say.
    pub fn run<G: Contacts>(
        mut self,
        geometry: &mut G,
        watch: &mut dyn Watch,
        stop: StopToken<'_>,
    ) -> Result<History, Error> {
        let front = |geometry: &G| geometry.motion(0).x;
        let unsettled = |what: Unsettled, step: usize, time: f64, position: f64| {
            let what = what.name();
            Error::NoConvergence { what, step, time, position }
        };
        let speeds: Vec<f64> = self.courses.iter().map(|course| course.speed).collect();
        self.vibration = geometry.vibration(&self.stepper);
        let started = geometry.start(&mut self.rolling, &mut self.starter, &speeds);
        let mut state = started.map_err(|e| unsettled(e, 0, 0.0, front(geometry)))?;
        for (travel, course) in state.travel.iter_mut().zip(self.courses) {
            let centre = course.centre(0.0);
            *travel = if course.rolls { Coordinate { a: travel.a, ..centre } } else { centre };
        }
        self.check_apart(0.0, geometry)?;
        self.record(0.0, &state, geometry);
        let every = (PAIRS / self.history.axles.pow(2)).clamp(1, POLL_EVERY);
        let mut exit = None;
        for n in 1.. {
            let time = n as f64 * self.h;
            let before = front(geometry);
            self.put_brakes_on(time);
            let stepped = geometry.step(&mut self.rolling, &mut self.stepper, &mut state);
            stepped.map_err(|e| unsettled(e, n, time, before))?;
            for (travel, course) in state.travel.iter_mut().zip(self.courses).filter(|(_, course)| !course.rolls) {
                *travel = course.centre(time);
            }
            let coordinates = state.modes.iter().chain(&state.coordinates);
            let accelerations = coordinates.fold(state.travel.iter().map(|c| c.a).sum(), |sum: f64, c| sum + c.a);
            if !accelerations.is_finite() || !front(geometry).is_finite() {
                return Err(Error::NotFinite { step: n, time, position: before });
            }
            self.stand(time, &mut state.travel, geometry)?;
            self.check_apart(time, geometry)?;
            self.record(time, &state, geometry);
            match self.leaves {
                Some(leaves) if n == leaves => self.ended[0] = Some(time),
                Some(_) => {}
                None => self.note_ends(time),
            }
            if let Some(end) = self.ended.iter().try_fold(0.0, |end: f64, ended| ended.map(|t| end.max(t))) {
                let exit = *exit.get_or_insert(n);
                self.history.ended = end;
                if self.is_over((n, exit), end, &state.modes, watch, stop)? {
                    self.history.last_on = if self.loaded { n } else { exit };
                    return Ok(self.history);
                }
            }
            if n > self.most_steps {
                return Err(Error::Stopped { time, position: front(geometry) });
            }
            if n % every == 0 {
                stop.check()?;
            }
        }
        unreachable!("the loop over steps has no end")
    }

    /// Whether the tail is over in step n, the last vehicle having ended at the time `end` and by the end of step `exit`;
    /// then it is cut where it is over.
    fn is_over(
        &mut self,
        (n, exit): (usize, usize),
        end: f64,
        modes: &[Coordinate<f64>],
        watch: &mut dyn Watch,
        stop: StopToken<'_>,
    ) -> Result<bool, Error> {
        let over = match self.settings.tail {
            Tail::Fixed(tail) => {
                let (last, fraction) = tail::end(end, exit, self.h, tail);
                if n >= last && fraction < 1.0 {
                    self.history.shorten_last(fraction);
                }
                n >= last
            }
            Tail::Free if (n - exit).is_multiple_of(LOOK_EVERY) => n - exit >= self.tail,
            Tail::Free => return Ok(false),
        };
        // A vehicle that stands on the bridge rocks with it, so that the bound does not hold.
        if self.loaded || self.settings.tail.seconds().is_some() && !over {
            return Ok(over);
        }
        let reach = self.vibration.reach(modes);
        let free = self.settings.tail == Tail::Free;
        self.history.settled = free && watch.enough(&self.history, &reach, stop)?;
        let over = over || self.history.settled;
        self.history.reach = over.then_some(reach);
        Ok(over)
    }

    fn record(&mut self, time: f64, state: &State<f64>, geometry: &impl Geometry<f64>) {
        let assemblies = self.courses.iter().map(|course| course.vehicle.assembly());
        self.history.record(time, state, geometry, assemblies);
    }

    /// How far an own axle has come at a recorded instant, from the end at which the vehicle enters [m].
    fn way(&self, vehicle: usize, own: usize, row: usize) -> f64 {
        let course = &self.courses[vehicle];
        course.way(self.history.positions[row * self.history.axles + course.axles.start + own], self.length)
    }

    /// When, before the end of the last recorded step, an own axle came to a way; the end of the step if only now.
    fn passed(&self, vehicle: usize, own: usize, way: f64, time: f64) -> f64 {
        let last = self.history.len() - 1;
        let (before, now) = (self.way(vehicle, own, last.saturating_sub(1)), self.way(vehicle, own, last));
        passed([before, now], way, time, self.h)
    }

    /// Sets the brakes for a step that ends at `time`.
    fn put_brakes_on(&mut self, time: f64) {
        for (v, course) in self.courses.iter().enumerate() {
            let Some(braking) = course.braking else { continue };
            let last = self.history.len() - 1;
            if self.braking_since[v].is_none() && self.way(v, 0, last) >= braking.from {
                self.braking_since[v] = Some(self.passed(v, 0, braking.from, time - self.h));
            }
            if let Some(since) = self.braking_since[v] {
                let level = if braking.ramp > 0.0 { ((time - since) / braking.ramp).clamp(0.0, 1.0) } else { 1.0 };
                let Braking { deceleration, adhesion, .. } = braking;
                self.rolling.brake(v, Brakes { demand: deceleration, adhesion, level });
            }
        }
    }

    /// Sees to freely rolling vehicles that have come to rest.
    fn stand(&mut self, time: f64, travel: &mut [Coordinate<f64>], geometry: &mut impl Contacts) -> Result<(), Error> {
        for (v, course) in self.courses.iter().enumerate() {
            if !course.rolls || self.history.vehicles[v].stopped.is_some() || travel[v].v > 0.0 {
                continue;
            }
            if self.braking_since[v].is_none() {
                return Err(Error::Stopped { time, position: geometry.motion(course.axles.start).x });
            }
            travel[v] = Coordinate { x: travel[v].x, v: 0.0, a: 0.0 };
            course.axles.clone().for_each(|axle| geometry.hold(axle));
            let assembly = course.vehicle.assembly();
            self.stepper.hold(
                v,
                VehicleSolve::new(assembly, true, Some(&assembly.standing_mass()), self.h, self.settings.beta),
            );
            self.history.vehicles[v].stopped = Some(time);
        }
        Ok(())
    }

    /// Notes which vehicles have left the bridge, or stand for good, by the end of the last recorded step.
    fn note_ends(&mut self, time: f64) {
        for (v, course) in self.courses.iter().enumerate() {
            if self.ended[v].is_some() {
                continue;
            }
            let own = course.behind.len() - 1;
            let left = self.way(v, own, self.history.len() - 1) >= self.beyond[v];
            let to_stand = course.motion.stands_from().map(|stands| course.entry + stands);
            let stands = self.history.vehicles[v].stopped.or(to_stand.filter(|at| time >= at - 1e-9 * self.h));
            if stands.is_none() && !left {
                continue;
            }
            let row = &self.history.positions[(self.history.len() - 1) * self.history.axles..];
            let there = row[course.axles.clone()].iter().any(|&x| self.mesh.is_on(x));
            match stands {
                // For good, though it be on the very end of the bridge.
                Some(stands) if there || !left => {
                    self.history.vehicles[v].stopped = Some(stands);
                    self.ended[v] = Some(stands);
                    self.loaded |= there;
                }
                _ => self.ended[v] = Some(self.passed(v, own, self.length, time)),
            }
        }
    }

    /// Refuses vehicles that overlap in one lane.
    fn check_apart<G: Geometry<f64>>(&self, time: f64, geometry: &G) -> Result<(), Error> {
        let motion = |axle: usize| geometry.motion(axle);
        let Some([(i, a), (j, b)]) = overlap(self.courses, (time, self.h, self.length), motion) else { return Ok(()) };
        let allowed = format!(
            "they overlap at t = {time:.3} s, from {:.2} to {:.2} m and from {:.2} to {:.2} m; enter later, change the speed \
             or use another lane",
            a[0], a[1], b[0], b[1]
        );
        Err(Error::input(format!("vehicles[{i}] and vehicles[{j}], lane"), self.courses[j].lane, allowed))
    }
}
