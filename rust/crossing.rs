//! One crossing: from the front axle at the start of the approach until the last axle has left and the tail is over.

use crate::bridge::Bridge;
use crate::course::{Course, Direction, Passage};
use crate::damping::Damping;
use crate::error::Error;
use crate::flexibility::Flexibility;
use crate::history::History;
use crate::line::Line;
use crate::march::March;
use crate::modal::ModalDamping;
use crate::modes::Modes;
use crate::path::{Free, Ground, ModeShapes, Prescribed};
use crate::settings::Settings;
use crate::steps::{Steps, narrowest_panel};
use crate::tail::{Blind, Watch};
use crate::vehicle::{MAX_AXLES, Suspension, Vehicle};

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
        let narrowest = narrowest_panel(&points, bridge.span_bounds(), near);
        Ok(ModalBridge {
            omega: modes.omega.clone(),
            shapes: ModeShapes::new(flexibility.mesh(), lines),
            damping: damping.modal(modes)?,
            narrowest_panel: narrowest.min(bridge.length()),
        })
    }

    /// Upper bound of the fastest circular frequency of bridge and vehicles together, suspensions locked [rad/s].
    pub fn fastest_frequency<'a>(&self, vehicles: impl Iterator<Item = &'a Vehicle>) -> f64 {
        let [bridge, own, tyres] = self.fastest_parts(vehicles);
        (bridge + own + tyres).sqrt()
    }

    /// What the square of that is the sum of [rad²/s²]: of the bridge, of the vehicles, of tyres on the bridge.
    pub fn fastest_parts<'a>(&self, vehicles: impl Iterator<Item = &'a Vehicle>) -> [f64; 3] {
        // The stiffness is that of the bridge plus that of the contact springs, whose largest eigenvalue is at most the
        // largest of the vehicles' own plus the sum of k φ² (Weyl's inequality, and the trace).
        let bridge = self.omega.iter().copied().fold(0.0, f64::max);
        let (mut own, mut tyres) = (0.0_f64, 0.0);
        for vehicle in vehicles {
            own = vehicle.frequencies(Suspension::Locked).into_iter().fold(own, f64::max);
            tyres += vehicle.assembly().contacts.iter().map(|c| c.law.tyre_stiffness()).sum::<f64>();
        }
        let own = own * std::f64::consts::TAU;
        [bridge.powi(2), own.powi(2), tyres * self.shapes.largest_sum_of_squares()]
    }
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

/// Crosses the bridge with several vehicles at once. A tail that is not given is as long as it may be, for there are no
/// responses to look at.
pub fn cross_all(
    model: &ModalBridge,
    passages: &[Passage],
    settings: &Settings,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<History, Error> {
    cross_watched(model, passages, settings, &mut Blind, go_on)
}

/// The same, while `watch` looks at it.
pub fn cross_watched(
    model: &ModalBridge,
    passages: &[Passage],
    settings: &Settings,
    watch: &mut dyn Watch,
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
    // Whether forces follow rates, and with them the slopes of the modes.
    let rates = courses.iter().flat_map(|c| &c.vehicle.assembly().contacts).any(|contact| !contact.law.is_plain());
    if courses.iter().any(|course| course.rolls) {
        let free = |step: usize, axle: usize| (!own(axle).0.rolls).then(|| motion(step, axle));
        let mirrored = courses.iter().map(|course| course.direction == Direction::Left).collect();
        let start = (0..owner.len()).map(|axle| motion(0, axle)).collect();
        let mut geometry = Free::new(ground, free, mirrored, start, rates);
        March::new(model, &courses, settings, &steps).run(&mut geometry, &Free::stop, watch, go_on)
    } else {
        let mut geometry = Prescribed::new(ground, motion, steps.count, rates);
        March::new(model, &courses, settings, &steps).run(&mut geometry, &|_, _| (), watch, go_on)
    }
}
