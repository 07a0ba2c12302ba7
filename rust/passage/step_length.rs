//! How long the steps of a crossing are, and how many.
//!
//! A step is as long as the accuracy asked for allows. Three errors grow with its square, and each asks for its own limit:
//!
//! - **Extremes are looked for at the ends of steps**, and at the instants at which an axle is on a section. A vibration of
//!   circular frequency ω that peaks between two of them is missed by (ωh)²/8 of itself at most. What vibrates fastest and
//!   matters is, on the bridge, the highest included mode, coupled with the tyres; hence the limit [`PHASE`]/ω.
//! - **Vehicles hop on a rough road**, the more the rougher it is: their part in the responses grows with the slopes of
//!   the road as the contact patch leaves them, so that the way of a step may be the longer, the less they are
//!   ([`ROUGH`]). Where the way is a matter of time, as at low speed, the first limit is the shorter one. Edges of
//!   single features have a limit of their own.
//! - **Newmark's method makes periods longer**: by (β − 1/12)(ωh)²/2 in parts, which for β = 1/12 is nothing but a term of
//!   fourth order ([`FOX_GOODWIN`](crate::passage::settings::FOX_GOODWIN)). Over the few periods that a vehicle's or a
//!   bridge's dampers leave ([`PERIODS`]) that is an error of phase, added to the first.
//!
//! Panels of the bridge have no say: influence lines are exact at any position. The constants come from comparing with steps
//! an eighth as long, over the catalogue, bridges and road classes: see the table of accuracy in the documentation. What
//! converges more slowly is told there: tyres with dampers, whose force jumps as an axle meets the slope of the deflected
//! bridge ([`JUMPS`]), and wheels that drop on or off a free end.

use crate::error::Error;
use crate::memory::{self, Promise};
use crate::modal_bridge::ModalBridge;
use crate::passage::planned::Course;
use crate::passage::settings::{FOX_GOODWIN, Settings, Tail};
use crate::road::Texture;
use crate::step::vibration::most_steps;
use crate::vehicle::equations::{Assembly, ContactLaw};

/// Most steps of one crossing: a mistyped step or speed is told before it takes all memory.
pub const MAX_STEPS: usize = 2_000_000;

/// Halvings of the step that a sample may ask for.
pub const MOST_HALVINGS: u32 = 16;

/// Most memory that the states of one crossing may take [bytes].
const MAX_HISTORY_BYTES: f64 = 4e9;

/// Accuracy for which the limits below are stated.
const STATED: f64 = 1e-3;

/// Circular frequency of the fastest coupled vibration times step [-].
const PHASE: f64 = 0.3;

/// Steps to the shortest span.
const STEPS_PER_SPAN: f64 = 100.0;

/// Way per step on a road whose slopes have the root mean square [`SLOPE`] [m].
const ROUGH: f64 = 0.05;

/// Slopes between those of class A, 0.0034, and of class B, 0.0069, under the usual contact patch [-].
const SLOPE: f64 = 5e-3;

/// Way per step on the roughest roads that vehicles cross [m].
const ROUGHEST: f64 = 0.005;

/// Steps to the shortest edge or contact patch of single features.
const STEPS_PER_EDGE: f64 = 30.0;

/// Way per step of tyres with dampers and of masses without tyres, on whatever road [m]; what they are off by goes with
/// the step, not with its square.
const JUMPS: f64 = 0.025;

/// Wave number times way per step of masses without tyres, of which nothing takes the edge off a wave [-].
const RIGID: f64 = 0.03;

/// Periods over which an error of the period adds up.
const PERIODS: f64 = 2.4;

/// Speed below which it is the speed that makes a crossing long [m/s].
const SLOW: f64 = 0.1;

/// Steps of a crossing.
pub struct Steps {
    /// Length [s].
    pub h: f64,
    /// Number without the tail, if all vehicles move as prescribed; else about this many.
    pub count: usize,
    /// Most steps of the tail.
    pub tail: usize,
    /// Way per step [m] of a vehicle alone at constant speed, which is marched in space: its axles are at the same
    /// places after as many steps whatever its speed.
    pub advance: Option<f64>,
    /// What a history of them takes.
    kept: Kept,
}

/// Memory for the states of all steps, and who is to blame for it.
struct Kept {
    key: &'static str,
    value: String,
    steps: f64,
    bytes: f64,
}

impl Steps {
    /// As long as the settings, stability and what has to be resolved allow.
    pub fn plan(model: &ModalBridge, courses: &[Course<'_>], settings: &Settings) -> Result<Self, Error> {
        let length = model.shapes.mesh().length();
        let fastest = model.fastest_frequency(courses.iter().map(|course| course.vehicle));
        let fineness = Fineness::of(settings);
        let [resolved, limit] = fineness.step(fastest, settings.beta, are_driven(model, courses));
        let speed = courses.iter().map(|course| course.motion.fastest()).fold(0.0, f64::max);
        let speed = if speed.is_finite() { speed } else { fastest_on_the_way(courses, length) };
        let way = |course: &Course<'_>| {
            let [from, to] = course.paved(settings, length).map(|way| course.place(way, length));
            fineness.way(
                model.shortest_span,
                course.road.texture(from.min(to), from.max(to)),
                course.vehicle.assembly(),
            )
        };
        let way = courses.iter().map(way).fold(f64::INFINITY, f64::min);
        let usual = resolved.min(way / speed).min(limit);
        let longest = settings.step.unwrap_or(usual);
        if longest > limit {
            let frequency = fastest / std::f64::consts::TAU;
            return Err(Error::StepTooLong { step: longest, beta: settings.beta, limit, frequency });
        }
        let span = courses.iter().map(|course| course.end(length)).fold(0.0, f64::max);
        if !(span / longest > 0.0 && longest > 0.0) {
            return Err(Error::input("speed", format!("{speed:e} m/s"), "too high: the crossing takes no time"));
        }
        if !span.is_finite() {
            let allowed = "the vehicle must leave the bridge or come to a stop";
            return Err(Error::input("speed", "0 m/s for good, before the end", allowed));
        }
        // A path of a whole number of steps is not given one more because of rounding.
        let mut count = (span / longest - 1e-9).ceil().max(1.0);
        if let [course] = courses
            && course.is_steady()
            && settings.step.is_none()
        {
            // As samples side by side, so that by default a sample is a crossing.
            let (steps, way) = Steps::in_space(course.path(settings, length), way);
            count = count.max(steps as f64 * Steps::halved(way, usual * speed).0);
        }
        let tail = settings.tail.seconds().unwrap_or(0.0);
        let steps = count + tail / longest;
        let (modes, axles) = (model.omega.len(), courses.iter().map(|course| course.behind.len()).sum::<usize>());
        let coordinates: usize = courses.iter().map(|course| course.vehicle.assembly().mass.nrows() + 1).sum();
        let frictions: usize = courses.iter().map(|course| course.vehicle.assembly().frictions.len()).sum();
        let bytes = bytes(modes, axles, coordinates, frictions);
        let blamed = |most: f64| {
            let first = settings.approach / courses[0].speed.max(1e-300);
            let late = courses.iter().map(|course| course.entry).fold(0.0, f64::max);
            let few = |span: f64, tail: f64, step: f64| span / step + tail / step <= most;
            match settings.step {
                Some(step) if few(span, tail, usual) => Some(("step", format!("{step:e} s"))),
                _ if few(span, 0.0, longest) => Some(("tail", format!("{tail:e} s"))),
                _ if few(span - first, tail, longest) => Some(("approach", format!("{:e} m", settings.approach))),
                _ if few(span - late, tail, longest) => Some(("entry", format!("{late:e} s"))),
                _ => None,
            }
        };
        if steps > MAX_STEPS as f64 {
            let (key, value) = blamed(MAX_STEPS as f64).unwrap_or_else(|| match settings.step {
                Some(step) => ("step", format!("{step:e} s")),
                None if speed >= SLOW && resolved < way / speed => {
                    let [bridge, own, tyres] = model.fastest_parts(courses.iter().map(|course| course.vehicle));
                    let key = if own + tyres > bridge { "vehicle" } else { "bridge" };
                    (key, format!("shortest period of {:e} s", std::f64::consts::TAU / fastest))
                }
                None => ("speed", format!("{speed:e} m/s")),
            });
            let mut allowed = format!("the crossing would take {steps:.3e} steps, at most {MAX_STEPS} are allowed");
            if settings.step.is_none() {
                allowed += &format!(
                    " (a step of {longest:.3e} s, for a way of {way:.3e} m and a shortest period of {:.3e} s, follows from \
                     accuracy = {}; give another, or a step)",
                    std::f64::consts::TAU / fastest,
                    settings.accuracy
                );
            }
            return Err(Error::input(key, value, allowed));
        }
        let (h, advance) = match courses {
            [course] if course.is_steady() => {
                let advance = course.path(settings, length) / count;
                (advance / course.speed, Some(advance))
            }
            _ => (span / count, None),
        };
        let tail = match settings.tail {
            Tail::Fixed(tail) => (tail / h).ceil() as usize,
            Tail::Free => {
                let slowest = model.omega.iter().fold(f64::INFINITY, |least, w| w.powi(2).min(least));
                most_steps(slowest, h, room(count, bytes))
            }
        };
        let (key, value) = blamed(MAX_HISTORY_BYTES / bytes).unwrap_or(("modes", modes.to_string()));
        // As many steps of a tail that is not given as room is made for at the start.
        let kept = steps + if settings.tail == Tail::Free { count.min(tail as f64) } else { 0.0 };
        let kept = Kept { key, value, steps: kept, bytes };
        Ok(Steps { h, count: count as usize, tail, advance, kept })
    }

    /// So many steps in space, in a time of h [s] and of this way [m] each, and a tail of so many more at most.
    pub fn of(count: usize, h: f64, advance: f64, tail: usize) -> Self {
        let kept = Kept { key: "step", value: format!("{h:e} s"), steps: 0.0, bytes: 0.0 };
        Steps { h, count, tail, advance: Some(advance), kept }
    }

    /// Whether their states may be kept.
    pub fn may_be_kept(&self) -> bool {
        self.kept.steps * self.kept.bytes <= MAX_HISTORY_BYTES
    }

    /// Memory for the states of all of them, until that is given back.
    pub fn promise(&self) -> Result<Promise, Error> {
        let Kept { key, value, steps, bytes } = &self.kept;
        let mend = "use fewer modes or a longer step";
        memory::promise(key, value, steps * bytes, MAX_HISTORY_BYTES, &format!("{steps:.3e} steps"), mend)
    }

    /// How many steps of a way at most [m] a path takes, and the way of each.
    pub fn in_space(path: f64, longest: f64) -> (usize, f64) {
        let steps = (path / longest - 1e-9).ceil().max(1.0);
        (steps as usize, path / steps)
    }

    /// How many steps there are for one of this way [m], halved until none is longer than `most` [m], and how often it is.
    pub fn halved(mut way: f64, most: f64) -> (f64, u32) {
        let mut halvings = 0;
        // Where one step just fits, rounding does not halve it.
        while way > most * (1.0 + 1e-9) && halvings <= MOST_HALVINGS {
            way *= 0.5;
            halvings += 1;
        }
        (f64::from(1_u32 << halvings), halvings)
    }
}

/// Bytes of a step: a row of the history, and one of the table of mode shapes and road under the axles.
pub fn bytes(modes: usize, axles: usize, coordinates: usize, frictions: usize) -> f64 {
    (size_of::<f64>() * (1 + 3 * coordinates + frictions + 3 * modes + 8 * axles + 3 * modes * axles)) as f64
}

/// Steps that a crossing of so many, of so many bytes each, may have besides.
pub fn room(count: f64, bytes: f64) -> f64 {
    (MAX_STEPS as f64 - count).min(MAX_HISTORY_BYTES / bytes - count).max(0.0)
}

/// What the length of a step follows from, but for the speed.
#[derive(Debug, Clone, Copy)]
pub struct Fineness {
    /// The accuracy, by that for which the limits are stated.
    accuracy: f64,
    /// How much longer than stated steps may be.
    scale: f64,
}

impl Fineness {
    /// Of the settings.
    pub fn of(settings: &Settings) -> Self {
        // Beside what lies between two steps, (ωh)²/8, the phase 2π·periods·(β − 1/12)(ωh)²/2.
        let beside = 8.0 * std::f64::consts::PI * PERIODS * (settings.beta - FOX_GOODWIN).max(0.0);
        let accuracy = settings.accuracy / STATED;
        Fineness { accuracy, scale: (accuracy / (1.0 + beside)).sqrt() }
    }

    /// Longest step that resolves vibrations up to this circular frequency [rad/s] [s], and the longest that is stable; if
    /// the modes are `driven`, Newmark's method has no part in it.
    pub fn step(&self, fastest: f64, beta: f64, driven: bool) -> [f64; 2] {
        match driven {
            true => [self.accuracy.sqrt() * PHASE / fastest, f64::INFINITY],
            false if beta < 0.25 => [self.scale * PHASE / fastest, 1.0 / (fastest * (0.25 - beta).sqrt())],
            false => [self.scale * PHASE / fastest, f64::INFINITY],
        }
    }

    /// Longest way per step [m] of a vehicle over these spans on a road. Forces do not feel it, and masses that roll on it
    /// without tyres feel every wave.
    pub fn way(&self, shortest_span: f64, road: Texture, vehicle: &Assembly) -> f64 {
        let laws = || vehicle.contacts.iter().map(|contact| contact.law);
        let mut way = shortest_span / STEPS_PER_SPAN;
        if laws().all(|law| law == ContactLaw::Force) {
            return self.accuracy.sqrt() * way;
        }
        if road.slope_power > 0.0 {
            way = way.min((ROUGH * (SLOPE / road.slope_power.sqrt()).sqrt()).max(ROUGHEST));
        }
        if laws().any(|law| !law.is_plain()) {
            way = way.min(JUMPS * self.accuracy.sqrt());
        }
        if laws().any(|law| matches!(law, ContactLaw::Mass(_))) {
            way = way.min(RIGID / (std::f64::consts::TAU * road.highest));
        }
        self.scale * way.min(road.finest / STEPS_PER_EDGE)
    }
}

/// Whether all are constant loads at constant speed on a bridge whose modes they drive each by itself: no step couples them.
pub fn are_driven(model: &ModalBridge, courses: &[Course<'_>]) -> bool {
    let constant = |course: &Course<'_>| course.vehicle.is_of_forces() && course.motion.is_steady() && !course.rolls;
    courses.iter().all(constant) && model.damping.rates(&model.omega).is_some()
}

/// Highest speed before the last axle has left, where speeds grow for ever [m/s].
fn fastest_on_the_way(courses: &[Course<'_>], length: f64) -> f64 {
    let at_end = courses.iter().map(|course| course.motion.at(course.end(length) - course.entry).v);
    courses.iter().map(|course| course.speed).chain(at_end).filter(|v| v.is_finite()).fold(0.0, f64::max)
}
