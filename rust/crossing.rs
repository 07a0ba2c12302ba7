//! One crossing: from the front axle at the start of the approach until the last axle has left and the tail is over.

use std::sync::Arc;

use faer::{Mat, Side};

use crate::bridge::Bridge;
use crate::course::{Braking, Course, Direction, Drive, Passage};
use crate::error::{Error, finite, not_negative, positive};
use crate::flexibility::Flexibility;
use crate::history::{Columns, History};
use crate::line::Line;
use crate::modal::ModalDamping;
use crate::modes::Modes;
use crate::newmark::Coordinate;
use crate::path::{Free, Ground, ModeShapes, Prescribed};
use crate::rig::Rig;
use crate::road::Road;
use crate::step::{Brakes, Geometry, Moving, Propulsion, Scheme, State, Stepper, Unsettled};
use crate::vehicle::{Suspension, Vehicle};

/// Most steps of one crossing: a mistyped step or speed is told before it takes all memory.
pub const MAX_STEPS: usize = 2_000_000;

/// Most memory that the states of one crossing may take [bytes].
const MAX_HISTORY_BYTES: f64 = 4e9;

/// Steps to the shortest coupled period unless the user gives a step.
const STEPS_PER_PERIOD: f64 = 20.0;

/// Steps to the narrowest panel unless the user gives a step.
const STEPS_PER_PANEL: f64 = 100.0;

/// Steps between two questions whether to go on.
const POLL_EVERY: usize = 1024;

/// Way in front of an axle that the road's unevenness needs at most in one step unless the user gives a step [m]: a fifth
/// of the shortest wave that is usual.
const WAY_PER_STEP: f64 = 0.05;

/// Viscous damping of the bridge.
#[derive(Debug, Clone, PartialEq)]
pub enum Damping {
    /// Ratio to critical, one for all modes or one for each.
    Ratios(Vec<f64>),
    /// C = αM + βK, for α [1/s] and β [s]: the ratio of a mode is α/2ω + βω/2.
    Rayleigh {
        /// α [1/s].
        mass: f64,
        /// β [s].
        stiffness: f64,
    },
    /// C at the mass stations [N s/m]: D = ΦᵀCΦ is full in general.
    Viscous(Mat<f64>),
}

impl Damping {
    /// Checked against the bridge, and projected on the included modes.
    pub fn modal(&self, modes: &Modes) -> Result<ModalDamping, Error> {
        match self {
            Damping::Ratios(ratios) => {
                if ratios.len() != 1 && ratios.len() != modes.len() {
                    let allowed = format!("give one ratio, or one for each of the {} modes", modes.len());
                    return Err(Error::input("damping", format!("{} values", ratios.len()), allowed));
                }
                for &ratio in ratios {
                    if !(ratio.is_finite() && (0.0..1.0).contains(&ratio)) {
                        return Err(Error::input("damping", ratio, "must be a ratio to critical, from 0 to below 1"));
                    }
                }
                let all = (0..modes.len()).map(|m| if ratios.len() == 1 { ratios[0] } else { ratios[m] });
                Ok(ModalDamping::Classical(all.collect()))
            }
            Damping::Rayleigh { mass, stiffness } => {
                not_negative("damping alpha", *mass)?;
                not_negative("damping beta", *stiffness)?;
                let ratios: Vec<f64> = modes.omega.iter().map(|w| 0.5 * (mass / w + stiffness * w)).collect();
                if let Some(m) = ratios.iter().position(|ratio| *ratio >= 1.0) {
                    let allowed = "Rayleigh damping must stay below critical in every included mode";
                    return Err(Error::input(
                        "damping",
                        format!("{} of critical in mode {}", ratios[m], m + 1),
                        allowed,
                    ));
                }
                Ok(ModalDamping::Classical(ratios))
            }
            Damping::Viscous(c) => {
                let n = modes.shapes.nrows();
                if c.nrows() != n || c.ncols() != n {
                    let allowed = format!("C must be square with a row for each of the {n} moving masses");
                    return Err(Error::input("damping", format!("{} x {} matrix", c.nrows(), c.ncols()), allowed));
                }
                let mut largest = 0.0_f64;
                for value in (0..n).flat_map(|j| c.col(j).iter()) {
                    largest = largest.max(finite("damping", *value)?.abs());
                }
                let near = 1e-9 * largest;
                if (0..n).any(|i| (0..i).any(|j| (c[(i, j)] - c[(j, i)]).abs() > near)) {
                    return Err(Error::input("damping", "unsymmetric C", "C must be symmetric"));
                }
                let lowest = c.self_adjoint_eigenvalues(Side::Lower).map_err(|e| Error::Modes(format!("{e:?}")))?[0];
                if lowest < -near {
                    let value = format!("C with the negative eigenvalue {lowest:.3e} N s/m");
                    return Err(Error::input("damping", value, "C must not feed energy in: no negative eigenvalue"));
                }
                Ok(ModalDamping::Coupled(modes.shapes.transpose() * c * &modes.shapes))
            }
        }
    }
}

/// The bridge in modal coordinates, ready to be crossed.
#[derive(Debug, Clone)]
pub struct ModalBridge {
    /// Natural circular frequencies of the included modes [rad/s].
    pub omega: Vec<f64>,
    /// The included modes along the bridge.
    pub shapes: ModeShapes,
    /// Their damping.
    pub damping: ModalDamping,
    /// Narrowest distance between neighbouring stations, supports and ends [m].
    pub narrowest_panel: f64,
}

impl ModalBridge {
    /// From the modes of `bridge` and their `lines` on the mesh of `flexibility`.
    pub fn new(
        bridge: &Bridge,
        flexibility: &Flexibility,
        modes: &Modes,
        lines: &[Line],
        damping: &Damping,
    ) -> Result<Self, Error> {
        let mut points: Vec<f64> = bridge.span_bounds().to_vec();
        points.extend(bridge.stations().iter().map(|s| s.at));
        points.sort_by(f64::total_cmp);
        let near = crate::bridge::COINCIDENT * bridge.length();
        let widths = points.windows(2).map(|p| p[1] - p[0]).filter(|&w| w > near);
        Ok(ModalBridge {
            omega: modes.omega.clone(),
            shapes: ModeShapes::new(flexibility.mesh(), lines),
            damping: damping.modal(modes)?,
            narrowest_panel: widths.fold(bridge.length(), f64::min),
        })
    }

    /// Upper bound of the fastest circular frequency of bridge and vehicles together, suspensions locked [rad/s].
    pub fn fastest_frequency<'a>(&self, vehicles: impl Iterator<Item = &'a Vehicle>) -> f64 {
        // The stiffness is that of the bridge plus that of the contact springs, whose largest eigenvalue is at most the
        // largest of the vehicles' own plus the sum of k φ² (Weyl's inequality, and the trace).
        let bridge = self.omega.iter().copied().fold(0.0, f64::max);
        let (mut own, mut tyres) = (0.0_f64, 0.0);
        for vehicle in vehicles {
            own = vehicle.frequencies(Suspension::Locked).into_iter().fold(own, f64::max);
            tyres += vehicle.assembly().contacts.iter().map(|c| c.law.tyre_stiffness()).sum::<f64>();
        }
        let own = own * std::f64::consts::TAU;
        (bridge.powi(2) + own.powi(2) + tyres * self.shapes.largest_sum_of_squares()).sqrt()
    }
}

/// How vehicles cross.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Speed at the start [m/s].
    pub speed: f64,
    /// How the vehicle moves.
    pub drive: Drive,
    /// Newmark's β, from 1/12 to 1/2 [-].
    pub beta: f64,
    /// Longest time step [s]; shortened so that a whole number of steps spans the crossing. By default a twentieth of the
    /// shortest coupled period, a hundredth of the narrowest panel or, on an uneven road, 50 mm of way, whichever takes
    /// less time.
    pub step: Option<f64>,
    /// Approach in front of the bridge [m].
    pub approach: f64,
    /// Way from the start of the approach on which the road's unevenness fades in [m].
    pub ramp: f64,
    /// Free vibration kept after the last axle has left, or the last vehicle has stopped [s].
    pub tail: f64,
    /// Gravity [m/s²].
    pub gravity: f64,
    /// Whether wheels leave the road; if not, their loads may become negative.
    pub lift_off: bool,
    /// The road.
    pub road: Arc<Road>,
}

impl Settings {
    /// Defaults for a given speed [m/s].
    pub fn at_speed(speed: f64) -> Self {
        Settings {
            speed,
            drive: Drive::ConstantSpeed,
            beta: 1.0 / 6.0,
            step: None,
            approach: 0.0,
            ramp: 0.0,
            tail: 0.0,
            gravity: 9.806_65,
            lift_off: true,
            road: Arc::new(Road::smooth()),
        }
    }

    fn check(&self) -> Result<(), Error> {
        not_negative("approach", self.approach)?;
        not_negative("ramp", self.ramp)?;
        if self.ramp > self.approach {
            let allowed = format!("must not be longer than the approach, {} m", self.approach);
            return Err(Error::input("ramp", format!("{} m", self.ramp), allowed));
        }
        not_negative("tail", self.tail)?;
        positive("gravity", self.gravity)?;
        if let Some(step) = self.step {
            positive("step", step)?;
        }
        if !(self.beta >= 1.0 / 12.0 && self.beta <= 0.5) {
            return Err(Error::input(
                "beta",
                self.beta,
                "must be from 1/12 to 1/2 (1/6 linear, 1/4 average acceleration)",
            ));
        }
        Ok(())
    }
}

/// Steps of a crossing.
struct Steps {
    /// Length [s].
    h: f64,
    /// Number without the tail, if all vehicles move as prescribed; else about this many.
    count: usize,
}

impl Steps {
    fn plan(model: &ModalBridge, courses: &[Course<'_>], settings: &Settings) -> Result<Self, Error> {
        let length = model.shapes.mesh().length();
        let fastest = model.fastest_frequency(courses.iter().map(|course| course.vehicle));
        let limit = if settings.beta < 0.25 { 1.0 / (fastest * (0.25 - settings.beta).sqrt()) } else { f64::INFINITY };
        let resolved = std::f64::consts::TAU / fastest / STEPS_PER_PERIOD;
        let uneven = courses.iter().any(|course| !course.road.is_smooth());
        let speed = courses.iter().map(|course| course.motion.fastest()).fold(0.0, f64::max);
        let speed = if speed.is_finite() { speed } else { fastest_on_the_way(courses, length) };
        let way = model.narrowest_panel / STEPS_PER_PANEL;
        let way = if uneven { way.min(WAY_PER_STEP) } else { way };
        let longest = settings.step.unwrap_or(resolved.min(way / speed));
        if longest > limit {
            let frequency = fastest / std::f64::consts::TAU;
            return Err(Error::StepTooLong { step: longest, beta: settings.beta, limit, frequency });
        }
        let span = courses.iter().map(|course| course.end(length)).fold(0.0, f64::max);
        if !span.is_finite() {
            let allowed = "the vehicle must leave the bridge or come to a stop";
            return Err(Error::input("speed", "0 m/s for good, before the end", allowed));
        }
        // A path of a whole number of steps is not given one more because of rounding.
        let count = (span / longest - 1e-9).ceil().max(1.0);
        let steps = count + settings.tail / longest;
        if steps > MAX_STEPS as f64 {
            let first = settings.approach / courses[0].speed.max(1e-300);
            let late = courses.iter().map(|course| course.entry).fold(0.0, f64::max);
            let (key, value) = match settings.step {
                _ if settings.tail / longest > 0.5 * steps => ("tail", format!("{:e} s", settings.tail)),
                _ if first > 0.5 * span => ("approach", format!("{:e} m", settings.approach)),
                _ if late > 0.5 * span => ("entry", format!("{late:e} s")),
                Some(step) => ("step", format!("{step:e} s")),
                None => ("speed", format!("{speed:e} m/s")),
            };
            let mut allowed = format!("the crossing would take {steps:.3e} steps, at most {MAX_STEPS} are allowed");
            if settings.step.is_none() {
                allowed += &format!(
                    " (the default step is {longest:.3e} s, for a narrowest panel of {:.3e} m and a shortest period of \
                     {:.3e} s; give step to choose another)",
                    model.narrowest_panel,
                    std::f64::consts::TAU / fastest
                );
            }
            return Err(Error::input(key, value, allowed));
        }
        // Rows of the history, of the same made ready for recovery, and of the table of mode shapes under the axles.
        let (modes, axles) = (model.omega.len(), courses.iter().map(|course| course.behind.len()).sum::<usize>());
        let coordinates: usize = courses.iter().map(|course| course.vehicle.assembly().mass.nrows() + 1).sum();
        let numbers = 1 + 3 * coordinates + 5 * modes + 10 * axles + 3 * modes * axles;
        let bytes = steps * (size_of::<f64>() * numbers) as f64;
        if bytes > MAX_HISTORY_BYTES {
            let allowed = format!(
                "{steps:.3e} steps would take {:.1} GB of memory, more than {:.1}: use fewer modes or a longer step",
                bytes / 1e9,
                MAX_HISTORY_BYTES / 1e9
            );
            return Err(Error::input("modes", modes, allowed));
        }
        Ok(Steps { h: span / count, count: count as usize })
    }
}

/// Highest speed before the last axle has left, where speeds grow for ever [m/s].
fn fastest_on_the_way(courses: &[Course<'_>], length: f64) -> f64 {
    let at_end = courses.iter().map(|course| course.motion.at(course.end(length) - course.entry).v);
    courses.iter().map(|course| course.speed).chain(at_end).filter(|v| v.is_finite()).fold(0.0, f64::max)
}

/// Crosses the bridge once. `go_on` is asked now and then; when it says no, the crossing ends as interrupted.
pub fn cross(
    model: &ModalBridge,
    vehicle: &Vehicle,
    settings: &Settings,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<History, Error> {
    cross_all(model, &[Passage::of(vehicle.clone())], settings, go_on)
}

/// Crosses the bridge with several vehicles at once.
pub fn cross_all(
    model: &ModalBridge,
    passages: &[Passage],
    settings: &Settings,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<History, Error> {
    settings.check()?;
    if passages.is_empty() {
        return Err(Error::input("vehicles", "[]", "at least one vehicle must cross"));
    }
    let length = model.shapes.mesh().length();
    let mut courses: Vec<Course<'_>> = Vec::with_capacity(passages.len());
    for (i, passage) in passages.iter().enumerate() {
        let key = if passages.len() == 1 { String::new() } else { format!("vehicles[{i}].") };
        let course = Course::new(passage, settings, &key, courses.last().map_or(0, |c| c.axles.end))?;
        course.check_road(settings, length)?;
        courses.push(course);
    }
    let steps = Steps::plan(model, &courses, settings)?;
    let ground = Ground {
        shapes: &model.shapes,
        pavements: courses.iter().map(|course| course.pavement(settings, length)).collect(),
        vehicle: courses.iter().enumerate().flat_map(|(v, c)| vec![v; c.behind.len()]).collect(),
    };
    let owner = ground.vehicle.clone();
    let own = |axle: usize| (&courses[owner[axle]], axle - courses[owner[axle]].axles.start);
    let motion = |step: usize, axle: usize| {
        let (course, own) = own(axle);
        course.axle(own, step as f64 * steps.h, length)
    };
    if courses.iter().any(|course| course.rolls) {
        let free = |step: usize, axle: usize| (!own(axle).0.rolls).then(|| motion(step, axle));
        let mirrored = courses.iter().map(|course| course.direction == Direction::Left).collect();
        let start = (0..owner.len()).map(|axle| motion(0, axle)).collect();
        let mut geometry = Free::new(ground, free, mirrored, start);
        March::new(model, &courses, settings, &steps).run(&mut geometry, &Free::stop, go_on)
    } else {
        // One more than needed, so that rounding of the tail does not matter.
        let with_tail = steps.count + (settings.tail / steps.h).ceil() as usize + 1;
        let plain = |law: &crate::assembly::ContactLaw| law.is_plain();
        let slopes = !courses.iter().flat_map(|c| &c.vehicle.assembly().contacts).all(|contact| plain(&contact.law));
        let mut geometry = Prescribed::new(ground, motion, with_tail, slopes);
        March::new(model, &courses, settings, &steps).run(&mut geometry, &|_, _| (), go_on)
    }
}

/// A crossing being marched through time.
struct March<'a> {
    courses: &'a [Course<'a>],
    settings: &'a Settings,
    length: f64,
    h: f64,
    stepper: Stepper<f64>,
    starter: Stepper<f64>,
    history: History,
    /// When each vehicle had left the bridge or stood for good.
    ended: Vec<Option<f64>>,
    /// When each vehicle began to brake.
    braking_since: Vec<Option<f64>>,
}

impl<'a> March<'a> {
    fn new(model: &'a ModalBridge, courses: &'a [Course<'a>], settings: &'a Settings, steps: &Steps) -> Self {
        let moving: Vec<Moving<'_>> = courses
            .iter()
            .map(|course| Moving {
                assembly: course.vehicle.assembly(),
                propulsion: if course.rolls { Propulsion::Rolling } else { Propulsion::Prescribed },
                direction: course.direction.sign(),
            })
            .collect();
        let Settings { beta, gravity, lift_off, .. } = *settings;
        let scheme = Scheme { h: steps.h, beta, gravity, lift_off };
        let mut history = History {
            axles: courses.last().map_or(0, |course| course.axles.end),
            modes: model.omega.len(),
            step: steps.h,
            static_loads: courses.iter().flat_map(|course| course.vehicle.static_loads(gravity)).collect(),
            ..History::default()
        };
        for course in courses {
            let assembly = course.vehicle.assembly();
            let (motion, first) = (history.motion_width(), history.frictions);
            history.frictions += assembly.frictions.len();
            history.vehicles.push(Columns {
                axles: course.axles.clone(),
                motion: motion..motion + 3 * (assembly.mass.nrows() + 1),
                frictions: first..history.frictions,
                direction: course.direction.sign(),
                stopped: None,
            });
        }
        history.reserve(steps.count + (settings.tail / steps.h) as usize + 16);
        March {
            courses,
            settings,
            length: model.shapes.mesh().length(),
            h: steps.h,
            stepper: Stepper::new(&model.omega, &model.damping, &moving, &scheme),
            starter: Stepper::new(&model.omega, &model.damping, &moving, &Scheme { h: 0.0, ..scheme }),
            history,
            ended: vec![None; courses.len()],
            braking_since: vec![None; courses.len()],
        }
    }

    fn run<G: Geometry<f64>>(
        mut self,
        geometry: &mut G,
        stop: &dyn Fn(&mut G, usize),
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<History, Error> {
        let front = |geometry: &G| geometry.motion(0).x;
        let unsettled = |what: Unsettled, time: f64, position: f64| {
            let what = match what {
                Unsettled::ContactForces => "contact forces",
                Unsettled::AxlePositions => "axle positions",
            };
            Error::NoConvergence { what, time, position }
        };
        let speeds: Vec<f64> = self.courses.iter().map(|course| course.speed).collect();
        let mut state = self.starter.start(&speeds, geometry).map_err(|e| unsettled(e, 0.0, front(geometry)))?;
        for (travel, course) in state.travel.iter_mut().zip(self.courses) {
            let centre = course.centre(0.0);
            *travel = if course.rolls { Coordinate { a: travel.a, ..centre } } else { centre };
        }
        self.check_apart(0.0, geometry)?;
        self.record(0.0, &state, geometry);
        for n in 1.. {
            let time = n as f64 * self.h;
            let before = front(geometry);
            self.put_brakes_on(time);
            self.stepper.advance(&mut state, geometry).map_err(|e| unsettled(e, time, before))?;
            for (travel, course) in state.travel.iter_mut().zip(self.courses).filter(|(_, course)| !course.rolls) {
                *travel = course.centre(time);
            }
            let coordinates = state.modes.iter().chain(&state.coordinates);
            let accelerations = coordinates.fold(state.travel.iter().map(|c| c.a).sum(), |sum: f64, c| sum + c.a);
            if !accelerations.is_finite() || !front(geometry).is_finite() {
                return Err(Error::NotFinite { time, position: before });
            }
            self.stand(time, &mut state.travel, geometry, stop)?;
            self.check_apart(time, geometry)?;
            self.record(time, &state, geometry);
            self.note_ends(time);
            if let Some(end) = self.ended.iter().try_fold(0.0, |end: f64, ended| ended.map(|t| end.max(t))) {
                let end = end + self.settings.tail;
                if time >= end - 1e-9 * self.h {
                    if time > end + 1e-9 * self.h {
                        self.history.shorten_last(1.0 - (time - end) / self.h);
                    }
                    return Ok(self.history);
                }
            }
            if n > 2 * MAX_STEPS {
                return Err(Error::Stopped { time, position: front(geometry) });
            }
            if n % POLL_EVERY == 0 && !go_on() {
                return Err(Error::Interrupted);
            }
        }
        unreachable!("the loop over steps has no end")
    }

    fn record(&mut self, time: f64, state: &State<f64>, geometry: &impl Geometry<f64>) {
        let assemblies = self.courses.iter().map(|course| course.vehicle.assembly());
        self.history.record(time, state, geometry, assemblies);
    }

    /// How far an own axle has come at a recorded instant, from the end at which the vehicle enters [m].
    fn way(&self, vehicle: usize, own: usize, row: usize) -> f64 {
        let course = &self.courses[vehicle];
        let x = self.history.positions[row * self.history.axles + course.axles.start + own];
        if course.direction == Direction::Right { x } else { self.length - x }
    }

    /// When, before the end of the last recorded step, an own axle came to a way; the end of the step if only now.
    fn passed(&self, vehicle: usize, own: usize, way: f64, time: f64) -> f64 {
        let last = self.history.len() - 1;
        let (before, now) = (self.way(vehicle, own, last.saturating_sub(1)), self.way(vehicle, own, last));
        if now > before { time - self.h * ((now - way) / (now - before)).max(0.0) } else { time }
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
                self.stepper.brake(v, Brakes { demand: deceleration, adhesion, level });
            }
        }
    }

    /// Sees to freely rolling vehicles that have come to rest.
    fn stand<G: Geometry<f64>>(
        &mut self,
        time: f64,
        travel: &mut [Coordinate<f64>],
        geometry: &mut G,
        stop: &dyn Fn(&mut G, usize),
    ) -> Result<(), Error> {
        for (v, course) in self.courses.iter().enumerate() {
            if !course.rolls || self.history.vehicles[v].stopped.is_some() || travel[v].v > 0.0 {
                continue;
            }
            if self.braking_since[v].is_none() {
                return Err(Error::Stopped { time, position: geometry.motion(course.axles.start).x });
            }
            travel[v] = Coordinate { x: travel[v].x, v: 0.0, a: 0.0 };
            course.axles.clone().for_each(|axle| stop(geometry, axle));
            let assembly = course.vehicle.assembly();
            self.stepper.hold(v, Rig::new(assembly, true, Some(&assembly.standing_mass()), self.h, self.settings.beta));
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
            let path = self.settings.approach + self.length + course.wheelbase();
            if self.way(v, own, self.history.len() - 1) >= self.length - 1e-12 * path {
                self.ended[v] = Some(self.passed(v, own, self.length, time));
            } else if let Some(stands) = course.motion.stands_from()
                && time >= course.entry + stands - 1e-9 * self.h
            {
                self.history.vehicles[v].stopped = Some(course.entry + stands);
                self.ended[v] = Some(course.entry + stands);
            } else if let Some(stopped) = self.history.vehicles[v].stopped {
                self.ended[v] = Some(stopped);
            }
        }
    }

    /// Refuses vehicles that overlap in one lane.
    fn check_apart<G: Geometry<f64>>(&self, time: f64, geometry: &G) -> Result<(), Error> {
        let stretch = |course: &Course<'_>| {
            let ends = [geometry.motion(course.axles.start).x, geometry.motion(course.axles.end - 1).x];
            [ends[0].min(ends[1]), ends[0].max(ends[1])]
        };
        // From its entry until it has left the bridge: before, a vehicle is only where its speed would have had it.
        let there = |course: &Course<'_>| {
            let last = geometry.motion(course.axles.end - 1).x;
            let left = if course.direction == Direction::Right { last > self.length } else { last < 0.0 };
            time >= course.entry && !left
        };
        for (j, second) in self.courses.iter().enumerate().skip(1).filter(|(_, second)| there(second)) {
            let b = stretch(second);
            let others = self.courses[..j].iter().enumerate();
            for (i, first) in others.filter(|(_, first)| first.lane == second.lane && there(first)) {
                let a = stretch(first);
                if a[0] <= b[1] && b[0] <= a[1] {
                    let value = format!("vehicles {i} and {j} in lane {}", second.lane);
                    let allowed = format!(
                        "they overlap at t = {time:.3} s, from {:.2} to {:.2} m and from {:.2} to {:.2} m; enter later, \
                         change the speed or use another lane",
                        a[0], a[1], b[0], b[1]
                    );
                    return Err(Error::input("vehicles", value, allowed));
                }
            }
        }
        Ok(())
    }
}
