//! One crossing: from the front axle at the start of the approach until the last axle has left and the tail is over.
//!
//! An [`analysis`] is a bridge prepared for crossings. The [`time_loop`] takes the steps and keeps their states in a
//! [`history`], and the [`tail`] goes on until nothing larger can come. The [`observer`] looks for the extremes of every
//! response, and the [`envelope`] has them and the impact factors.

pub(crate) mod analysis;
pub(crate) mod envelope;
pub(crate) mod forces;
pub(crate) mod history;
pub(crate) mod observer;
pub(crate) mod tail;
pub(crate) mod time_loop;

pub use analysis::{Analysis, Outcome, Preparation};
pub use envelope::{Envelope, Extreme, Extremes, Ratio, Sense, axle_loads};
pub use history::{History, LiftOff};
pub use observer::Observer;
pub use tail::Watch;

use crate::crossing::forces::Forces;
use crate::crossing::time_loop::TimeLoop;
use crate::error::Error;
use crate::geometry::free::Free;
use crate::geometry::pavement::Ground;
use crate::geometry::prescribed::Prescribed;
use crate::modal_bridge::ModalBridge;
use crate::passage::planned::Course;
use crate::passage::settings::Settings;
use crate::passage::step_length::{Steps, are_driven};
use crate::passage::{Direction, Passage};
use crate::step::driving::{Drive, ModalForces};
use crate::step::forced::Forced;
use crate::stop_token::StopToken;
use crate::vehicle::MAX_AXLES;

/// Crosses the bridge with one vehicle or several at once, while `watch` looks at it. `stop` is asked now and then; when it
/// says no, the crossing ends as interrupted.
pub fn cross(
    model: &ModalBridge,
    passages: &[Passage],
    settings: &Settings,
    watch: &mut dyn Watch,
    stop: StopToken<'_>,
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
        course.check_contact(&model.shapes)?;
        courses.push(course);
    }
    let axles = courses.last().map_or(0, |course| course.axles.end);
    if axles > MAX_AXLES {
        return Err(Error::input("vehicles", format!("{axles} axles"), format!("at most {MAX_AXLES} in all")));
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
        match steps.advance {
            Some(advance) => course.steady_axle(own, advance * step as f64 - settings.approach, length),
            None => course.axle(own, step as f64 * steps.h, length),
        }
    };
    if let Some(rates) = model.damping.rates(&model.omega).filter(|_| are_driven(model, &courses)) {
        let loads = courses.iter().flat_map(|course| course.vehicle.static_loads(settings.gravity)).collect();
        let drive = |course: &Course<'_>| {
            let way = steps.advance.unwrap_or(course.speed * steps.h);
            (course.axles.clone(), Drive::new(&model.shapes, course.direction.sign() * way))
        };
        let drives = courses.iter().map(drive).collect();
        let forced = Forced::new(&model.omega, &rates, steps.h);
        let mut forces = Forces { ground, motion, loads, drives, forced, step: 0, driving: ModalForces::nothing() };
        return TimeLoop::new(model, &courses, settings, &steps).run(&mut forces, watch, stop);
    }
    // Whether forces follow rates, and with them the slopes of the modes.
    let rates = courses.iter().flat_map(|c| &c.vehicle.assembly().contacts).any(|contact| !contact.law.is_plain());
    if courses.iter().any(|course| course.rolls) {
        let free = |step: usize, axle: usize| (!own(axle).0.rolls).then(|| motion(step, axle));
        let mirrored = courses.iter().map(|course| course.direction == Direction::Left).collect();
        let start = (0..owner.len()).map(|axle| motion(0, axle)).collect();
        let mut geometry = Free::new(ground, free, mirrored, start, rates);
        TimeLoop::new(model, &courses, settings, &steps).run(&mut geometry, watch, stop)
    } else {
        let mut geometry = Prescribed::new(ground, motion, steps.count, rates);
        TimeLoop::new(model, &courses, settings, &steps).run(&mut geometry, watch, stop)
    }
}
