//! One crossing: from the front axle at the start of the approach until the last axle has left and the tail is over.
//!
//! An [`analysis`] is a bridge prepared for crossings, and a [`trip`] what is planned. The [`time_loop`] takes the steps and keeps their states in a
//! [`history`], and the [`tail`] goes on until nothing larger can come. The [`observer`] looks for the extremes of every
//! response, and the [`envelope`] has them and the impact factors.

pub(crate) mod analysis;
pub(crate) mod envelope;
pub(crate) mod forces;
pub(crate) mod history;
pub(crate) mod observer;
pub(crate) mod tail;
pub(crate) mod time_loop;
pub(crate) mod trip;

pub use analysis::{Analysis, Outcome, Preparation};
pub use envelope::{Envelope, Extreme, Extremes, Ratio, Sense, axle_loads};
pub use history::{History, LiftOff};
pub use observer::Observer;
pub use tail::Watch;

use crate::crossing::forces::Forces;
use crate::crossing::time_loop::TimeLoop;
use crate::crossing::trip::Trip;
use crate::error::Error;
use crate::geometry::free::Free;
use crate::geometry::prescribed::Prescribed;
use crate::modal_bridge::ModalBridge;
use crate::passage::planned::Course;
use crate::passage::settings::Settings;
use crate::passage::step_length::are_driven;
use crate::passage::{Direction, Passage};
use crate::step::driving::{Drive, ModalForces};
use crate::step::forced::Forced;
use crate::stop_token::StopToken;

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
    let trip = Trip::plan(model, passages, settings)?;
    let _promise = trip.steps.promise()?;
    let ground = trip.ground(model, settings);
    let Trip { courses, steps, owner, .. } = &trip;
    let motion = |step: usize, axle: usize| trip.motion(step, axle);
    if let Some(rates) = model.damping.rates(&model.omega).filter(|_| are_driven(model, courses)) {
        let loads = trip.static_loads(settings.gravity);
        let drive = |course: &Course<'_>| {
            let way = steps.advance.unwrap_or(course.speed * steps.h);
            (course.axles.clone(), Drive::new(&model.shapes, course.direction.sign() * way))
        };
        let drives = courses.iter().map(drive).collect();
        let forced = Forced::new(&model.omega, &rates, steps.h);
        let mut forces = Forces { ground, motion, loads, drives, forced, step: 0, driving: ModalForces::nothing() };
        return TimeLoop::new(model, &trip, settings).run(&mut forces, watch, stop);
    }
    let rates = trip.follows_rates();
    if trip.rolls() {
        let free = |step: usize, axle: usize| (!trip.own(axle).0.rolls).then(|| motion(step, axle));
        let mirrored = courses.iter().map(|course| course.direction == Direction::Left).collect();
        let start = (0..owner.len()).map(|axle| motion(0, axle)).collect();
        let mut geometry = Free::new(ground, free, mirrored, start, rates);
        TimeLoop::new(model, &trip, settings).run(&mut geometry, watch, stop)
    } else {
        let mut geometry = Prescribed::new(ground, motion, steps.count, rates);
        TimeLoop::new(model, &trip, settings).run(&mut geometry, watch, stop)
    }
}
