//! When the instants of samples that share the geometry are, and where the front axle is then: all that is kept of it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::record;
use super::table::{Advance, Stop};
use super::together;

/// The steps of one kind of march, and its stops.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pace {
    /// Front axle at the start [m].
    start: f64,
    /// Way per step [m].
    pub advance: f64,
    /// Number of steps until the last axle has left.
    pub steps: usize,
    /// How often the step was halved.
    pub halvings: u32,
    /// The step at whose end each stop has been passed, how far through that step, and where the front axle is then [m].
    pub stops: Vec<(u32, f64, f64)>,
}

impl Pace {
    /// That of a march that moves like this, with these stops, its step halved so often.
    pub fn new(path: &Advance, stops: &[Stop], halvings: u32) -> Self {
        let stop = |stop: &Stop| (stop.step as u32, stop.fraction, stop.position);
        Pace {
            start: path.x(0, 0),
            advance: path.advance,
            steps: path.steps,
            halvings,
            stops: stops.iter().map(stop).collect(),
        }
    }

    /// The time step at a speed [s].
    fn step(&self, speed: f64) -> f64 {
        self.advance / speed
    }
}

/// The paces of all marches of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Free vibration kept after the last axle has left, if that is given [s].
    tail: Option<f64>,
    /// By march; none where samples have times of their own.
    pub paces: Vec<Pace>,
}

impl Clock {
    /// Of these marches, with a tail [s] if that is given.
    pub fn new(tail: Option<f64>, paces: Vec<Pace>) -> Self {
        Clock { tail, paces }
    }

    /// Whether it can be one: what has travelled may have been changed on its way.
    pub fn is_sound(&self) -> bool {
        let sound = |pace: &Pace| {
            let Pace { start, advance, ref stops, .. } = *pace;
            start.is_finite() && advance.is_finite() && advance > 0.0 && stops.iter().all(|stop| stop.0 > 0)
        };
        self.tail.is_none_or(|tail| tail.is_finite() && tail >= 0.0) && self.paces.iter().all(sound)
    }

    /// The time step at a speed [s], and how often it was halved; none where samples have times of their own.
    pub fn step(&self, march: u32, speed: f64) -> Option<(f64, u32)> {
        self.paces.get(march as usize).map(|pace| (pace.step(speed), pace.halvings))
    }

    /// Time [s] and position of the front axle [m] at an instant; NaN where samples have times of their own.
    pub fn when(&self, march: u32, speed: f64, instant: u32) -> (f64, f64) {
        let Some(pace) = self.paces.get(march as usize) else { return (f64::NAN, f64::NAN) };
        let h = pace.step(speed);
        let position = |step: usize| pace.advance * step as f64 + pace.start;
        match record::stop_or_step(instant) {
            Ok(stop) => pace.stops.get(stop).map_or((f64::NAN, f64::NAN), |&(step, fraction, position)| {
                (Stop::between(step as usize, fraction, h), position)
            }),
            Err(step) => {
                let (time, there) = (step as f64 * h, position(step));
                // One that is not given ends with a step.
                let Some(tail) = self.tail else { return (time, there) };
                let (last, fraction) = together::end(pace.steps, h, tail);
                if step < last || fraction == 1.0 {
                    return (time, there);
                }
                let (before, behind) = ((step - 1) as f64 * h, position(step - 1));
                (before + fraction * (time - before), behind + fraction * (there - behind))
            }
        }
    }

    /// Several as one, and which march of it each of theirs is.
    pub fn joined(clocks: &[Clock]) -> (Clock, Vec<Vec<u32>>) {
        let mut joined = Clock { tail: clocks.first().and_then(|clock| clock.tail), paces: Vec::new() };
        let mut known: BTreeMap<(u32, usize, usize), Vec<u32>> = BTreeMap::new();
        let renumbered = clocks.iter().map(|clock| {
            let number = |pace: &Pace| {
                let alike = known.entry((pace.halvings, pace.steps, pace.stops.len())).or_default();
                let found = alike.iter().copied().find(|&i| joined.paces[i as usize] == *pace);
                found.unwrap_or_else(|| {
                    let new = joined.paces.len() as u32;
                    joined.paces.push(pace.clone());
                    alike.push(new);
                    new
                })
            };
            clock.paces.iter().map(number).collect()
        });
        let renumbered = renumbered.collect();
        (joined, renumbered)
    }
}
