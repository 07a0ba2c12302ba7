//! The memory that a run takes: its results, and for every worker a table of geometry and a group of samples on it.

use super::clock::Pace;
use super::group::KEPT;
use super::sample::Samples;
use super::study::{March, Study};
use super::table::{Below, Ground, READY};
use super::tabulated::MOST_INTERACTIONS;
use super::workers::Workers;
use crate::error::Error;
use crate::memory;
use crate::recovery::Place;
use crate::step::driving::Drive;
use crate::stops::Stop;
use crate::survey::Windows;
use crate::tape::{CHUNK, PARTS};

/// What there is room for.
pub struct Room<'a> {
    study: &'a Study,
    /// Threads, no more than asked for.
    pub threads: usize,
    /// Samples that a worker marches side by side.
    side_by_side: usize,
    /// For each of them [bytes].
    each: f64,
    alike: bool,
    /// Whether samples have static loads of their own.
    own_loads: bool,
}

impl<'a> Room<'a> {
    /// Beside results of so many bytes; refuses what there is none for.
    pub fn of(
        study: &'a Study,
        samples: &Samples,
        marches: &[March],
        workers: &Workers,
        results: f64,
    ) -> Result<Self, Error> {
        let mut room = Room {
            study,
            threads: workers.threads,
            side_by_side: workers.isa.samples(),
            each: f64::INFINITY,
            alike: samples.alike(),
            own_loads: samples.varies_loads(),
        };
        // Of every march its pace stays, and its static extremes, while they are being joined twice.
        let stays = |&(kind, _): &March| {
            let axles = study.vehicle(kind).assembly().contacts.len();
            (size_of::<Pace>() + size_of::<f64>() * (axles + 4 * study.look.chosen.len())) as f64
        };
        let results = results + if study.shares { marches.iter().map(stays).sum::<f64>() } else { 0.0 };
        // Those on their own ways share the windows of all influence lines.
        let own_ways = !study.shares || !samples.kinds.is_empty();
        let results = results + if own_ways { 2.0 * Windows::bytes(&study.analysis.rows) } else { 0.0 };
        let least = |march: &March| room.of_march(*march, false);
        let (worst, need) = match study.shares {
            false => (None, room.of_worker()),
            true => marches
                .iter()
                .map(|march| (Some(march), least(march)))
                .fold((None, 0.0), |a, b| if b.1 > a.1 { b } else { a }),
        };
        let (modes, sections) = (study.analysis.model.omega.len(), study.analysis.sections.len());
        let (key, value, mend) = match worst {
            Some(&march) if room.of_stops(march.0) > 0.5 * need => {
                ("sections", sections, "use fewer sections or axles")
            }
            _ => ("modes", modes, "use fewer modes or longer steps"),
        };
        let steps = worst.map_or(0, |&(kind, halvings)| study.plan(kind).0 << halvings);
        let what = format!("the geometry of {steps} steps beside the results");
        memory::check(key, value, results + need, f64::INFINITY, &what, mend)?;
        // As many threads as there is room for; beyond the least they may spend what is left.
        let left = memory::available() - results;
        room.threads = workers.threads.min((left / need.max(1.0)).max(1.0) as usize);
        room.each = left / room.threads as f64;
        Ok(room)
    }

    /// Whether there is room to lay out the geometry of a march.
    pub fn lays_out(&self, march: March) -> bool {
        self.of_march(march, true) <= self.each
    }

    /// Bytes that a worker takes for a march.
    fn of_march(&self, (kind, halvings): March, laid_out: bool) -> f64 {
        let study = self.study;
        let contacts = &study.vehicle(kind).assembly().contacts;
        let axles = contacts.len() as f64;
        let path = study.path((kind, halvings));
        let steps = (path.steps + path.beyond + 1) as f64;
        let kinds = if contacts.iter().all(|contact| contact.law.is_plain()) { 1 } else { 3 };
        let (driven, together) = (study.is_driven(kind), laid_out && self.is_together(kind));
        let shapes = size_of::<f64>() * study.analysis.model.omega.len() * kinds;
        let felt = if driven { 0 } else { size_of::<Below>() + size_of::<Ground>() + shapes };
        let place = if together { 0 } else { size_of::<Place>() };
        let [of_step, of_load] = Drive::bytes(&study.analysis.model.shapes);
        let driving = if together { steps * of_step + axles * of_load } else { 0.0 };
        let geometry = steps * axles * (felt + place) as f64 + driving;
        let (width, rows) = (study.analysis.rows.width() as f64, study.look.rows.len() as f64);
        let (sides, marks) = (2.0 * axles, study.look.marks.len() as f64);
        // On the bridge, all together are one.
        let axles = if together { 1.0 } else { axles };
        let mut numbers = rows * axles + width * axles;
        if laid_out {
            let asked: usize = study.look.marks.iter().map(|mark| study.look.asked[mark.asked].len()).sum();
            numbers += axles * (steps * width + sides * (marks * width + asked as f64));
            // Of the influence on each row, its middle, and its bounds over all steps of a chunk and over each part.
            let influence = rows * axles * (CHUNK + 1 + 2 + 2 * PARTS) as f64;
            let ready = rows * axles * steps <= READY as f64;
            let chunks = if ready { steps / CHUNK as f64 + 1.0 } else { 1.0 + (KEPT / CHUNK) as f64 / (width + axles) };
            numbers += influence * chunks;
            numbers += if self.alike && !driven { MOST_INTERACTIONS as f64 } else { 0.0 };
        }
        self.of_worker() + geometry + self.of_stops(kind) + size_of::<f64>() as f64 * numbers
    }

    /// Whether the loads of a kind are laid out as one.
    fn is_together(&self, kind: usize) -> bool {
        self.study.is_driven(kind) && !self.own_loads
    }

    /// Bytes of the stops of a kind.
    fn of_stops(&self, kind: usize) -> f64 {
        let axles = self.study.vehicle(kind).assembly().contacts.len();
        (2 * axles * self.study.look.marks.len() * size_of::<Stop>()) as f64
    }

    /// Bytes that a worker takes in any case: its stack, the steps that a group keeps, and their roads.
    fn of_worker(&self) -> f64 {
        let road = self.study.own.as_ref().map_or(0, |(own, _)| 2 * own.points());
        memory::THREAD + (size_of::<f64>() * self.side_by_side * (2 * KEPT + road)) as f64
    }
}
