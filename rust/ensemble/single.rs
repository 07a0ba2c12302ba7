//! Samples whose motion is their own: each a single crossing, through the same step. And what any sample crosses with:
//! its vehicles, and its bridge where that is varied.

use std::sync::Arc;

use super::results::{Column, Layout, Record};
use super::sample::{Parameter, Samples};
use super::study::Study;
use crate::crossing;
use crate::crossing::envelope::{Extremes, axle_loads};
use crate::crossing::observer::Observer;
use crate::damping::ModalDamping;
use crate::error::Error;
use crate::modal_bridge::ModalBridge;
use crate::passage::Passage;
use crate::passage::settings::Settings;
use crate::road::Road;
use crate::stop_token::StopToken;
use crate::tape::BridgeFactors;
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
    let factors = scaled.as_ref().map(|s| BridgeFactors { coordinates: s.stiffness, rates: s.rates });
    let mut observer = Observer::new(&study.analysis.rows, &study.look, &study.free, factors);
    let history = crossing::cross(model, &passages, &settings, &mut observer, stop)?;
    let envelope = observer.conclude(&history, stop)?;
    let bodies: Vec<_> = passages.iter().map(|passage| passage.vehicle.heaves()).collect();
    let rides = history.rides(&bodies, study.analysis.rows.mesh().length());
    let loads = axle_loads(&history, &rides);
    let stiffness = scaled.map_or(1.0, |scaled| scaled.stiffness);
    let shrink = |place: usize| if study.look.deflections[place] { stiffness } else { 1.0 };
    record.forget();
    let last = history.len() - 1;
    let [growth, side] = match &history.reach {
        None => [f64::NAN; 2],
        Some(reach) => {
            let seen = |row: usize| {
                let place = study.look.row_of.iter().position(|&own| own == row).unwrap_or_default();
                [envelope.dynamic.max[place].value, envelope.dynamic.min[place].value]
            };
            let reach = reach.clone();
            study.free.growth(&factors.map_or(reach.clone(), |f| reach.scaled(f.coordinates, f.rates)), seen)
        }
    };
    let (mut axles, mut bodies) = (0, 0);
    for ride in &rides {
        record.write_ride(
            layout,
            ride,
            0,
            [axles, bodies],
            &history.static_loads[axles..][..ride.loads.len()],
            history.step,
        );
        (axles, bodies) = (axles + ride.loads.len(), bodies + ride.accelerations.len());
    }
    let mut put = |column: Column, offset: usize, values: &mut dyn Iterator<Item = f64>| {
        let range = layout.range(column);
        record.numbers[range.start + offset..range.end].iter_mut().zip(values).for_each(|(slot, value)| *slot = value);
    };
    put(Column::Tail, 0, &mut [history.time[last] - history.ended, growth, study.look.side(side)].into_iter());
    let (r, a) = (layout.responses, layout.axles);
    let sides = |envelope: Extremes| [envelope.max, envelope.min].into_iter().enumerate();
    for (side, extremes) in sides(envelope.dynamic) {
        put(Column::Responses, side * r, &mut extremes.iter().enumerate().map(|(i, e)| e.value / shrink(i)));
        put(Column::Times, side * r, &mut extremes.iter().map(|e| e.time));
        put(Column::Positions, side * r, &mut extremes.iter().map(|e| e.position));
    }
    for (side, extremes) in sides(envelope.at_rest) {
        put(Column::Statics, side * r, &mut extremes.iter().enumerate().map(|(i, e)| e.value / shrink(i)));
    }
    for (side, extremes) in sides(loads.dynamic) {
        put(Column::Times, 2 * r + side * a, &mut extremes.iter().map(|e| e.time));
        put(Column::Positions, 2 * r + side * a, &mut extremes.iter().map(|e| e.position));
    }
    if !layout.is_finite(record.numbers, history.axles, bodies) {
        // No step shows it, but sums of squares do.
        let (time, position) = (history.time[last], history.positions[last * history.axles]);
        return Err(Error::NotFinite { step: last, time, position });
    }
    Ok(())
}
