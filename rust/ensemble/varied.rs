//! What a sample crosses with: its vehicles on their ways, and its bridge where that is varied.

use super::sample::{Parameter, Samples};
use super::study::Study;
use crate::damping::ModalDamping;
use crate::error::Error;
use crate::modal_bridge::ModalBridge;
use crate::passage::Passage;
use crate::tape::BridgeFactors;
use crate::vehicle::Vehicle;

/// The bridge of a sample, and what its rows are to multiply A and Ȧ by.
pub struct VariedBridge {
    /// Circular frequencies [rad/s].
    pub omega: Vec<f64>,
    /// Damping in modes.
    pub damping: ModalDamping,
    /// What its rows take A and Ȧ times; the inverse of the former is the factor of deflections.
    pub factors: BridgeFactors<f64>,
}

impl VariedBridge {
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
        let factors = BridgeFactors { coordinates: stiffness, rates };
        Some(VariedBridge { omega: model.omega.iter().map(|w| w * root).collect(), damping, factors })
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
