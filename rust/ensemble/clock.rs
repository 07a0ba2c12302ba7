//! Times of steps and passings, and the front axle then, for samples that share the geometry: all that is kept of it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::path::{Advance, passings};
use super::results;
use crate::crossing::tail::end;
use crate::extremes::Instant;
use crate::passage::step_length::MAX_STEPS;
use crate::stops::{Passing, SIDES, Stop};

/// The steps of one kind of march.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pace {
    /// How its axles move.
    pub path: Advance,
    /// How often the step was halved.
    pub halvings: u32,
}

/// The paces of all marches of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Free vibration kept after the last axle has left, if that is given [s].
    tail: Option<f64>,
    /// Where extremes are looked for as an axle passes [m].
    places: Vec<f64>,
    /// By march; none where samples have times of their own.
    pub paces: Vec<Pace>,
}

impl Clock {
    /// Of these marches past places [m], with a tail [s] if that is given.
    pub fn new(tail: Option<f64>, places: Vec<f64>, paces: Vec<Pace>) -> Self {
        Clock { tail, places, paces }
    }

    /// Whether it can be one: what has travelled may have been changed on its way.
    pub fn is_sound(&self) -> bool {
        let finite = |numbers: &[f64]| numbers.iter().all(|number| number.is_finite());
        let sound = |Pace { path, .. }: &Pace| {
            let moves = path.start.is_finite() && path.advance.is_finite() && path.advance > 0.0;
            moves && !path.behind.is_empty() && finite(&path.behind) && path.steps <= MAX_STEPS && path.beyond <= 1
        };
        let tail = self.tail.is_none_or(|tail| tail.is_finite() && tail >= 0.0);
        tail && finite(&self.places) && self.paces.iter().all(sound)
    }

    /// The time step at a speed [s], and how often it was halved; none where samples have times of their own.
    pub fn step(&self, march: u32, speed: f64) -> Option<(f64, u32)> {
        self.paces.get(march as usize).map(|pace| (pace.path.advance / speed, pace.halvings))
    }

    /// That of one march.
    pub fn of(&self, march: u32) -> Hands<'_> {
        let pace = self.paces.get(march as usize);
        let passings = pace.map_or(Vec::new(), |pace| passings(&pace.path, &self.places));
        Hands { march, tail: self.tail, path: pace.map(|pace| &pace.path), passings }
    }

    /// Several as one, and which march of it each of theirs is.
    pub fn joined(clocks: &[Clock]) -> (Clock, Vec<Vec<u32>>) {
        let (tail, places) = clocks.first().map_or((None, Vec::new()), |clock| (clock.tail, clock.places.clone()));
        let mut joined = Clock::new(tail, places, Vec::new());
        let mut known: BTreeMap<(u32, usize, u64), Vec<u32>> = BTreeMap::new();
        let renumbered = clocks.iter().map(|clock| {
            let number = |pace: &Pace| {
                let alike = known.entry((pace.halvings, pace.path.steps, pace.path.advance.to_bits())).or_default();
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

/// The instants of one march, its stops worked out.
pub struct Hands<'c> {
    /// Which.
    pub march: u32,
    tail: Option<f64>,
    path: Option<&'c Advance>,
    passings: Vec<Passing>,
}

impl Hands<'_> {
    /// Time [s] and position of the front axle [m] at an instant; NaN where samples have times of their own.
    pub fn when(&self, speed: f64, instant: u32) -> (f64, f64) {
        let Some(path) = self.path else { return (f64::NAN, f64::NAN) };
        let h = path.advance / speed;
        let position = |step: usize| path.advance * step as f64 + path.start;
        match results::decoded(instant) {
            Instant::Stop(stop) => self.passings.get(stop / SIDES).map_or((f64::NAN, f64::NAN), |passing| {
                (
                    Stop::between(passing.fraction, [(passing.step - 1) as f64 * h, passing.step as f64 * h]),
                    passing.position,
                )
            }),
            Instant::Step(step) => {
                let (time, there) = (step as f64 * h, position(step));
                // One that is not given ends with a step.
                let Some(tail) = self.tail else { return (time, there) };
                let (last, fraction) = end(path.steps as f64 * h, path.steps, h, tail);
                if step < last || fraction == 1.0 {
                    return (time, there);
                }
                let (before, behind) = ((step - 1) as f64 * h, position(step - 1));
                (before + fraction * (time - before), behind + fraction * (there - behind))
            }
        }
    }
}
