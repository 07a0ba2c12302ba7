//! Samples that go beside nobody (rolling freely, standing on their way): each a single crossing, through the same step.

use std::sync::Arc;

use super::results::{Column, Format, Record};
use super::sample::Samples;
use super::study::Study;
use super::varied::{VariedBridge, passages};
use crate::crossing;
use crate::crossing::envelope::{Extremes, axle_loads};
use crate::crossing::observer::Observer;
use crate::error::Error;
use crate::modal_bridge::ModalBridge;
use crate::passage::settings::Settings;
use crate::road::Road;
use crate::stop_token::StopToken;
use crate::tape::BridgeFactors;

/// Crosses with one sample and fills in its record, times and positions of extremes included.
pub fn cross(
    study: &Study,
    format: &Format,
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
    let varied = VariedBridge::of(model, samples, sample);
    let own_model;
    let model = match &varied {
        None => model,
        Some(VariedBridge { omega, damping, .. }) => {
            own_model = ModalBridge { omega: omega.clone(), damping: damping.clone(), ..model.clone() };
            &own_model
        }
    };
    let factors = varied.as_ref().map(|varied| varied.factors);
    let mut observer = Observer::new(&study.analysis.rows, &study.look, &study.free, factors);
    let history = crossing::cross(model, &passages, &settings, &mut observer, stop)?;
    let envelope = observer.conclude(&history, stop)?;
    let bodies: Vec<_> = passages.iter().map(|passage| passage.vehicle.heaves()).collect();
    let rides = history.rides(&bodies, study.analysis.rows.mesh(), stop)?;
    let loads = axle_loads(&history, &rides);
    let shrink = |place: usize| factors.map_or(1.0, |factors| factors.of(study.look.quantities[place]));
    record.forget();
    let last = history.len() - 1;
    let [growth, side] = match &history.reach {
        None => [f64::NAN; 2],
        Some(reach) => {
            let seen = |row: usize| {
                let place = study.look.first_of_row[row];
                [envelope.dynamic.max[place].value, envelope.dynamic.min[place].value]
            };
            study.free.growth(&BridgeFactors::reach(factors.as_ref(), reach.clone()), seen)
        }
    };
    let (mut axles, mut bodies) = (0, 0);
    for ride in &rides {
        record.write_ride(
            format,
            ride,
            0,
            [axles, bodies],
            &history.static_loads[axles..][..ride.loads.len()],
            history.step,
        );
        (axles, bodies) = (axles + ride.loads.len(), bodies + ride.accelerations.len());
    }
    let mut put = |column: Column, offset: usize, values: &mut dyn Iterator<Item = f64>| {
        let range = format.range(column);
        record.numbers[range.start + offset..range.end].iter_mut().zip(values).for_each(|(slot, value)| *slot = value);
    };
    put(Column::Tail, 0, &mut [history.time[last] - history.ended, growth, study.look.side(side)].into_iter());
    let (r, a) = (format.responses, format.axles);
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
    if !format.is_finite(record.numbers, history.axles, bodies) {
        // No step shows it, but sums of squares do.
        let (time, position) = (history.time[last], history.positions[last * history.axles]);
        return Err(Error::NotFinite { step: last, time, position });
    }
    Ok(())
}
