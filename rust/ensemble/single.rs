//! Samples whose motion is their own: each a single crossing, through the same step. And what any sample crosses with:
//! its vehicles, and its bridge where that is varied.

use std::sync::Arc;

use super::results::{Column, Layout, Record};
use super::sample::{Parameter, Samples};
use super::study::Study;
use crate::crossing;
use crate::crossing::analysis::Watching;
use crate::crossing::envelope::{Extremes, axle_loads};
use crate::crossing::history::History;
use crate::damping::ModalDamping;
use crate::error::Error;
use crate::modal_bridge::ModalBridge;
use crate::passage::Passage;
use crate::passage::settings::Settings;
use crate::road::Road;
use crate::stop_token::StopToken;
use crate::vehicle::Vehicle;

/// The bridge of a sample, and what its rows are to multiply A and Ȧ by.
pub struct Scaled {
    /// Circular frequencies [rad/s].
    pub omega: Vec<f64>,
    /// Damping in modes.
    pub damping: ModalDamping,
    /// Factor of the stiffness, on A in the rows; its inverse is that of deflections.
    pub stiffness: f64,
    /// How the damping matrix grows, on Ȧ in the rows.
    pub rates: f64,
}

impl Scaled {
    /// That of a sample, if it is varied.
    pub fn of(model: &ModalBridge, samples: &Samples, sample: usize) -> Option<Self> {
        let stiffness = samples.factor(Parameter::BridgeStiffness, sample, 0);
        let damping = samples.factor(Parameter::BridgeDamping, sample, 0);
        if stiffness.is_none() && damping.is_none() {
            return None;
        }
        let (stiffness, factor) = (stiffness.unwrap_or(1.0), damping.unwrap_or(1.0));
        let root = stiffness.sqrt();
        let (damping, rates) = match &model.damping {
            // Ratios to critical damping, which goes with the frequencies.
            ModalDamping::Classical(ratios) => {
                (ModalDamping::Classical(ratios.iter().map(|z| z * factor).collect()), root * factor)
            }
            ModalDamping::Coupled(d) => (ModalDamping::Coupled(faer::Scale(factor) * d), factor),
        };
        Some(Scaled { omega: model.omega.iter().map(|w| w * root).collect(), damping, stiffness, rates })
    }
}

/// The vehicles of an event as a sample has them.
pub fn vehicles(event: &[Passage], samples: &Samples, sample: usize) -> Result<Vec<Vehicle>, Error> {
    let mut before = [0, 0];
    let varied = event.iter().map(|Passage { vehicle, .. }| {
        let own = before;
        before = [before[0] + vehicle.bodies().len(), before[1] + vehicle.assembly().contacts.len()];
        if samples.factors.is_empty() { Ok(vehicle.clone()) } else { samples.vehicle(vehicle, sample, own) }
    });
    varied.collect()
}

/// The vehicles of a sample on their ways.
pub fn passages(study: &Study, samples: &Samples, sample: usize) -> Result<Vec<Passage>, Error> {
    let event = &study.kinds[samples.kind(sample)].passages;
    let vehicles = vehicles(event, samples, sample)?;
    let on_way = event.iter().zip(vehicles).enumerate().map(|(v, (passage, vehicle))| {
        let speed = match study.brings_speeds(passage) {
            true => passage.speed,
            false => passage.speed.or(Some(samples.speed(sample, v))),
        };
        Passage { vehicle, speed, ..passage.clone() }
    });
    Ok(on_way.collect())
}

/// Fills in the record of one sample; its axles' times and positions with it.
pub fn cross(
    study: &Study,
    layout: &Layout,
    samples: &Samples,
    sample: usize,
    record: &mut Record<'_>,
    stop: StopToken<'_>,
) -> Result<(), Error> {
    let passages = passages(study, samples, sample)?;
    let road = match &study.own {
        None => Arc::clone(&study.settings.road),
        Some((synthesis, seed)) => {
            let own = Road::from(synthesis.road(*seed, samples.first + sample as u64));
            Arc::new(Road::sum([(*study.settings.road).clone(), own]))
        }
    };
    let settings = Settings { road, ..study.settings.clone() };
    let model = &study.analysis.model;
    let scaled = Scaled::of(model, samples, sample);
    let own_model;
    let model = match &scaled {
        None => model,
        Some(Scaled { omega, damping, .. }) => {
            own_model = ModalBridge { omega: omega.clone(), damping: damping.clone(), ..model.clone() };
            &own_model
        }
    };
    let factors = scaled.as_ref().map_or([1.0; 2], |scaled| [scaled.stiffness, scaled.rates]);
    let mut watching = Watching::new(&study.analysis, &study.free, factors);
    let mut history = crossing::cross(model, &passages, &settings, &mut watching, stop)?;
    let (_, envelope) = watching.conclude(&mut history, stop)?;
    let loads = axle_loads(&history).dynamic;
    let stiffness = scaled.map_or(1.0, |scaled| scaled.stiffness);
    let chosen: Vec<(usize, f64)> = (study.look.chosen.iter().zip(&study.look.deflections))
        .map(|(&r, &d)| (r, if d { stiffness } else { 1.0 }))
        .collect();
    record.numbers.fill(f64::NAN);
    record.instants.fill(0);
    let mut put = |column: Column, offset: usize, values: &mut dyn Iterator<Item = f64>| {
        let range = layout.range(column);
        record.numbers[range.start + offset..range.end].iter_mut().zip(values).for_each(|(slot, value)| *slot = value);
    };
    let last = history.len() - 1;
    let [growth, side] = match &history.reach {
        None => [f64::NAN; 2],
        Some(reach) => {
            let seen = |row: usize| {
                let r = study.free.responses[row];
                [envelope.dynamic.max[r].value, envelope.dynamic.min[r].value]
            };
            study.free.growth(&reach.clone().scaled(factors[0], factors[1]), seen)
        }
    };
    put(Column::Tail, 0, &mut [history.time[last] - history.ended, growth, study.look.side(side)].into_iter());
    let (r, a) = (layout.responses, layout.axles);
    let sides = |extremes: &Extremes| [extremes.max.clone(), extremes.min.clone()];
    for (side, extremes) in sides(&envelope.dynamic).iter().enumerate() {
        put(Column::Responses, side * r, &mut chosen.iter().map(|&(r, k)| extremes[r].value / k));
        put(Column::Times, side * r, &mut chosen.iter().map(|&(r, _)| extremes[r].time));
        put(Column::Positions, side * r, &mut chosen.iter().map(|&(r, _)| extremes[r].position));
    }
    for (side, extremes) in sides(&envelope.at_rest).iter().enumerate() {
        put(Column::Statics, side * r, &mut chosen.iter().map(|&(r, k)| extremes[r].value / k));
    }
    for (side, extremes) in sides(&loads).iter().enumerate() {
        put(Column::Loads, side * a, &mut extremes.iter().map(|e| e.value));
        put(Column::Times, 2 * r + side * a, &mut extremes.iter().map(|e| e.time));
        put(Column::Positions, 2 * r + side * a, &mut extremes.iter().map(|e| e.position));
    }
    ride(&history, study.analysis.rows.mesh().length(), &passages, layout, &mut put, &mut record.instants[..]);
    let bodies = passages.iter().map(|passage| passage.vehicle.bodies().len()).sum();
    if !layout.is_finite(record.numbers, history.axles, bodies) {
        // No step shows it, but sums of squares do.
        let (time, position) = (history.time[last], history.positions[last * history.axles]);
        return Err(Error::NotFinite { step: last, time, position });
    }
    Ok(())
}

/// Contact forces and accelerations until the last vehicle has left the bridge; means while their own is on it.
fn ride(
    history: &History,
    length: f64,
    passages: &[Passage],
    layout: &Layout,
    put: &mut dyn FnMut(Column, usize, &mut dyn Iterator<Item = f64>),
    instants: &mut [u32],
) {
    let axles = history.axles;
    put(Column::LoadCoefficients, 0, &mut history.load_coefficients(length).into_iter());
    let lifts = history.lift_offs();
    let of = |k: usize| lifts.iter().filter(move |lift| lift.axle == k);
    put(Column::Aloft, 0, &mut (0..axles).map(|k| of(k).map(|lift| lift.to - lift.from).sum()));
    let counts = instants.len() - layout.axles;
    for (k, slot) in instants[counts..counts + axles].iter_mut().enumerate() {
        *slot = of(k).count() as u32;
    }
    let mut body = 0;
    for (columns, passage) in history.vehicles.iter().zip(passages) {
        let there = history.on_bridge(&columns.axles, length);
        let count = there.clone().count() as f64;
        for [heave, _] in &passage.vehicle.assembly().bodies {
            let acceleration = |i: usize| -> f64 {
                let row = &history.motion[i * history.motion_width()..][columns.motion.clone()];
                heave.iter().zip(row.iter().skip(2).step_by(3)).map(|(b, a)| b * a).sum()
            };
            let largest = (0..=history.last_on).fold(0.0_f64, |m, i| m.max(acceleration(i).abs()));
            let squares: f64 = there.clone().map(|i| acceleration(i).powi(2)).sum();
            put(Column::Accelerations, body, &mut std::iter::once(largest));
            put(Column::Vibrations, body, &mut std::iter::once((squares / count).sqrt()));
            body += 1;
        }
    }
}
