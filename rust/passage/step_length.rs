//! How long the steps of a crossing are, and how many.

use crate::error::Error;
use crate::memory::{self, Promise};
use crate::modal_bridge::ModalBridge;
use crate::passage::planned::Course;
use crate::passage::settings::{Settings, Tail};
use crate::step::vibration::most_steps;

/// Most steps of one crossing: a mistyped step or speed is told before it takes all memory.
pub const MAX_STEPS: usize = 2_000_000;

/// Most memory that the states of one crossing may take [bytes].
const MAX_HISTORY_BYTES: f64 = 4e9;

/// Steps to the shortest coupled period unless the user gives a step.
const STEPS_PER_PERIOD: f64 = 20.0;

/// Steps to the narrowest panel unless the user gives a step.
const STEPS_PER_PANEL: f64 = 100.0;

/// Speed below which it is the speed that makes a crossing long [m/s].
const SLOW: f64 = 0.1;

/// Way in front of an axle that the road's unevenness needs at most in one step unless the user gives a step [m]: a fifth
/// of the shortest wave that is usual.
const WAY_PER_STEP: f64 = 0.05;

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
    /// Of the memory that they take, until the crossing is over.
    _promise: Promise,
}

impl Steps {
    /// As long as the settings, stability and what has to be resolved allow.
    pub fn plan(model: &ModalBridge, courses: &[Course<'_>], settings: &Settings) -> Result<Self, Error> {
        let length = model.shapes.mesh().length();
        let fastest = model.fastest_frequency(courses.iter().map(|course| course.vehicle));
        let limit = if settings.beta < 0.25 { 1.0 / (fastest * (0.25 - settings.beta).sqrt()) } else { f64::INFINITY };
        let resolved = Steps::resolving(fastest);
        let uneven = courses.iter().any(|course| !course.road.is_smooth());
        let speed = courses.iter().map(|course| course.motion.fastest()).fold(0.0, f64::max);
        let speed = if speed.is_finite() { speed } else { fastest_on_the_way(courses, length) };
        let finest = courses.iter().map(|course| course.road.finest()).fold(f64::INFINITY, f64::min);
        let way = Steps::longest_way(model.narrowest_panel, uneven, finest);
        let usual = resolved.min(way / speed);
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
        let count = (span / longest - 1e-9).ceil().max(1.0);
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
                    " (the default step is {longest:.3e} s, for a narrowest panel of {:.3e} m and a shortest period of \
                     {:.3e} s; give step to choose another)",
                    model.narrowest_panel,
                    std::f64::consts::TAU / fastest
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
        let mend = "use fewer modes or a longer step";
        let promise = memory::promise(key, value, kept * bytes, MAX_HISTORY_BYTES, &format!("{kept:.3e} steps"), mend)?;
        Ok(Steps { h, count: count as usize, tail, advance, _promise: promise })
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

impl Steps {
    /// Longest step that resolves vibrations up to this circular frequency [rad/s], unless the user gives one [s].
    pub fn resolving(fastest: f64) -> f64 {
        std::f64::consts::TAU / fastest / STEPS_PER_PERIOD
    }

    /// Longest way per step unless the user gives a step [m]: for panels this narrow and, if the road is uneven, features
    /// this fine.
    pub fn longest_way(narrowest_panel: f64, uneven: bool, finest: f64) -> f64 {
        let way = narrowest_panel / STEPS_PER_PANEL;
        if uneven { way.min(WAY_PER_STEP).min(0.5 * finest) } else { way }
    }
}

/// Highest speed before the last axle has left, where speeds grow for ever [m/s].
fn fastest_on_the_way(courses: &[Course<'_>], length: f64) -> f64 {
    let at_end = courses.iter().map(|course| course.motion.at(course.end(length) - course.entry).v);
    courses.iter().map(|course| course.speed).chain(at_end).filter(|v| v.is_finite()).fold(0.0, f64::max)
}
