//! A trip over the bridge: all vehicles on their courses, the steps they take, and, where their motion is prescribed,
//! when they come and go.

use std::ops::Range;

use crate::coordinate::Coordinate;
use crate::error::Error;
use crate::geometry::pavement::Ground;
use crate::modal_bridge::ModalBridge;
use crate::passage::planned::Course;
use crate::passage::settings::Settings;
use crate::passage::step_length::{MAX_STEPS, Steps};
use crate::passage::{Direction, Passage};
use crate::step::unit::{Moving, Propulsion};
use crate::stops::Positions;
use crate::vehicle::MAX_AXLES;

/// Vehicles on their way over a bridge.
pub struct Trip<'a> {
    /// What each vehicle does.
    pub courses: Vec<Course<'a>>,
    /// How time is divided.
    pub steps: Steps,
    /// The vehicle of each axle.
    pub owner: Vec<usize>,
    /// Of the bridge [m].
    pub length: f64,
    /// Way before the bridge [m].
    pub approach: f64,
}

/// When all vehicles have left a bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exit {
    /// The step by whose end they have.
    pub step: usize,
    /// When the last of them left [s].
    pub time: f64,
}

impl<'a> Trip<'a> {
    /// As passages and settings have it, if it can be.
    pub fn plan(model: &ModalBridge, passages: &'a [Passage], settings: &'a Settings) -> Result<Self, Error> {
        Trip::in_steps(model, passages, settings, |courses| Steps::plan(model, courses, settings))
    }

    /// The same in these steps.
    pub fn in_steps(
        model: &ModalBridge,
        passages: &'a [Passage],
        settings: &'a Settings,
        steps: impl FnOnce(&[Course<'_>]) -> Result<Steps, Error>,
    ) -> Result<Self, Error> {
        if passages.is_empty() {
            return Err(Error::input("vehicles", "[]", "at least one vehicle must cross"));
        }
        let length = model.shapes.mesh().length();
        let mut courses: Vec<Course<'_>> = Vec::with_capacity(passages.len());
        for (i, passage) in passages.iter().enumerate() {
            let key = if passages.len() == 1 { String::new() } else { format!("vehicles[{i}].") };
            let course = Course::new(passage, settings, &key, courses.last().map_or(0, |c| c.axles.end))?;
            course.check_road(settings, length)?;
            course.check_contact(&model.shapes)?;
            courses.push(course);
        }
        let axles = courses.last().map_or(0, |course| course.axles.end);
        if axles > MAX_AXLES {
            return Err(Error::input("vehicles", format!("{axles} axles"), format!("at most {MAX_AXLES} in all")));
        }
        let steps = steps(&courses)?;
        let owner = courses.iter().enumerate().flat_map(|(v, c)| vec![v; c.behind.len()]).collect();
        Ok(Trip { courses, steps, owner, length, approach: settings.approach })
    }

    /// The vehicle of an axle, and which of its axles that is.
    pub fn own(&self, axle: usize) -> (&Course<'a>, usize) {
        let course = &self.courses[self.owner[axle]];
        (course, axle - course.axles.start)
    }

    /// Where prescribed motion has an axle at the end of a step, along the bridge.
    pub fn motion(&self, step: usize, axle: usize) -> Coordinate<f64> {
        let (course, own) = self.own(axle);
        match self.steps.advance {
            Some(advance) => course.steady_axle(own, advance * step as f64 - self.approach, self.length),
            None => course.axle(own, step as f64 * self.steps.h, self.length),
        }
    }

    /// Whether a vehicle goes where the step takes it.
    pub fn rolls(&self) -> bool {
        self.courses.iter().any(|course| course.rolls)
    }

    /// Whether forces follow rates, and with them the slopes of the modes.
    pub fn follows_rates(&self) -> bool {
        self.courses.iter().flat_map(|c| &c.vehicle.assembly().contacts).any(|contact| !contact.law.is_plain())
    }

    /// What is under the contacts.
    pub fn ground<'m>(&self, model: &'m ModalBridge, settings: &Settings) -> Ground<'m> {
        Ground {
            shapes: &model.shapes,
            pavements: self.courses.iter().map(|course| course.pavement(settings, self.length)).collect(),
            vehicle: self.owner.clone(),
        }
    }

    /// The vehicles as the step has them.
    pub fn moving(&self, settings: &Settings) -> Vec<Moving<'a>> {
        let moving = |course: &Course<'a>| Moving {
            assembly: course.vehicle.assembly(),
            propulsion: if course.rolls { Propulsion::Rolling } else { Propulsion::Prescribed },
            direction: course.direction.sign(),
            grade: course.grade(settings, self.length),
        };
        self.courses.iter().map(moving).collect()
    }

    /// Static loads of all axles [N].
    pub fn static_loads(&self, gravity: f64) -> Vec<f64> {
        self.courses.iter().flat_map(|course| course.vehicle.static_loads(gravity)).collect()
    }

    /// The way at which the last axle of a vehicle has left the bridge, but for rounding [m].
    pub fn beyond(&self, vehicle: usize) -> f64 {
        self.length - 1e-12 * (self.approach + self.length + self.courses[vehicle].wheelbase())
    }

    /// When all have left, none of them standing for good before, as the steps of prescribed motion have it.
    pub fn exit(&self) -> Option<Exit> {
        let h = self.steps.h;
        if self.rolls() {
            return None;
        }
        if self.steps.advance.is_some() {
            return Some(Exit { step: self.steps.count, time: self.steps.count as f64 * h });
        }
        let mut exit = Exit { step: 1, time: 0.0 };
        for (v, course) in self.courses.iter().enumerate() {
            let way = |step: usize| course.way(self.motion(step, course.axles.end - 1).x, self.length);
            // Nobody comes any farther once it stands for good.
            let stands = course.motion.stands_from().map_or(f64::INFINITY, |stands| course.entry + stands);
            let standing = (stands / h).ceil() + 1.0;
            if standing < MAX_STEPS as f64 && way(standing as usize) < self.beyond(v) {
                return None;
            }
            let step = first(1, |step| way(step) >= self.beyond(v));
            if step as f64 * h >= stands - h {
                return None;
            }
            let (before, now, time) = (way(step - 1), way(step), step as f64 * h);
            let left = passed([before, now], self.length, time, h);
            exit = Exit { step: exit.step.max(step), time: exit.time.max(left) };
        }
        Some(exit)
    }

    /// The steps up to `last`, which is cut short after this fraction, from the first with one of these axles on the bridge
    /// to that at which the last of them leaves it: see [`History::on_bridge`](super::history::History::on_bridge).
    pub fn on_bridge(&self, axles: Range<usize>, (last, fraction): (usize, f64)) -> Range<usize> {
        let (mut from, mut to) = (usize::MAX, 0);
        let rounding = 1e-12 * self.length;
        for axle in axles {
            let right = self.own(axle).0.direction == Direction::Right;
            let x = |step: usize| match step == last && fraction < 1.0 {
                true => self.between(step, fraction, axle),
                false => self.x(step, axle),
            };
            let come = first(0, |step| if right { x(step) >= -rounding } else { x(step) <= self.length + rounding });
            let gone = first(come, |step| if right { x(step) > self.length + rounding } else { x(step) < -rounding });
            if come < gone && come <= last {
                (from, to) = (from.min(come), to.max(gone.min(last + 1)));
            }
        }
        if from < to { from..to } else { 0..1 }
    }
}

/// Two vehicles of one lane that overlap at a time [s], from where to where each [m]; `motion` is that of an axle, in steps
/// of h [s] on a bridge of this length [m].
pub fn overlap(
    courses: &[Course<'_>],
    (time, h, length): (f64, f64, f64),
    motion: impl Fn(usize) -> Coordinate<f64>,
) -> Option<[(usize, [f64; 2]); 2]> {
    let stretch = |course: &Course<'_>| {
        let ends = [motion(course.axles.start).x, motion(course.axles.end - 1).x];
        [ends[0].min(ends[1]), ends[0].max(ends[1])]
    };
    // As far as two come past each other in half a step, so that none passes unseen between two looks.
    let margin = |a: &Course<'_>, b: &Course<'_>| 0.5 * h * (motion(a.axles.start).v - motion(b.axles.start).v).abs();
    // From its entry until it has left the bridge: before, a vehicle is only where its speed would have had it.
    let there =
        |course: &Course<'_>| time >= course.entry && course.way(motion(course.axles.end - 1).x, length) <= length;
    for (j, second) in courses.iter().enumerate().skip(1).filter(|(_, second)| there(second)) {
        let b = stretch(second);
        let others = courses[..j].iter().enumerate();
        for (i, first) in others.filter(|(_, first)| first.lane == second.lane && there(first)) {
            let a = stretch(first);
            let near = margin(first, second);
            if a[0] <= b[1] + near && b[0] <= a[1] + near {
                return Some([(i, a), (j, b)]);
            }
        }
    }
    None
}

impl Positions for Trip<'_> {
    fn axles(&self) -> usize {
        self.owner.len()
    }

    fn x(&self, step: usize, axle: usize) -> f64 {
        self.motion(step, axle).x
    }
}

/// When, before the end of a step of h [s] at this time [s], something was at a way, which it was before and is now [m].
pub fn passed([before, now]: [f64; 2], way: f64, time: f64, h: f64) -> f64 {
    if now > before { time - h * ((now - way) / (now - before)).max(0.0) } else { time }
}

/// The first number from `from` on of which something holds that holds of all beyond it too.
pub fn first(from: usize, holds: impl Fn(usize) -> bool) -> usize {
    if holds(from) {
        return from;
    }
    let (mut low, mut width) = (from, 1);
    while !holds(low + width) && width < usize::MAX / 4 {
        (low, width) = (low + width, 2 * width);
    }
    let mut high = low + width;
    while low + 1 < high {
        let middle = low + (high - low) / 2;
        if holds(middle) { high = middle } else { low = middle }
    }
    high
}
