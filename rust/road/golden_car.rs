//! International roughness index: the mean rectified slope that a standard quarter car feels at 80 km/h.
//!
//! M. W. Sayers, "On the calculation of International Roughness Index from longitudinal road profile", Transportation
//! Research Record 1501 (1995) 1-12. The states are slopes, derivatives with respect to x; every step is exact for an
//! input slope that is constant over it.

use nalgebra::{SMatrix, SVector};

use super::Road;
use crate::error::Error;

/// Speed [m/s].
const SPEED: f64 = 80.0 / 3.6;
/// Tyre stiffness over body mass [1/s²].
const TYRE: f64 = 653.0;
/// Suspension stiffness over body mass [1/s²].
const SUSPENSION: f64 = 63.3;
/// Axle mass over body mass [-].
const AXLE: f64 = 0.15;
/// Suspension damping over body mass [1/s].
const DAMPING: f64 = 6.0;
/// Length of the moving average by which the tyre is represented [m].
const BASE: f64 = 0.25;
/// Length over which the initial slope is taken: half a second [m].
const START: f64 = 11.0;
/// Step [m]: a fifth of the moving average.
const STEP: f64 = 0.05;

/// The index from `start` to `end` [m/m]; 1e-3 of it is 1 m/km.
pub fn iri(road: &Road, start: f64, end: f64) -> Result<f64, Error> {
    let response = response(road, start, end)?;
    Ok(response.iter().map(|slope| slope.abs()).sum::<f64>() / response.len() as f64)
}

/// Slope between body and axle after each step of 0.05 m [-].
///
/// The input is the slope of the moving average; it needs 0.25 m of road, so that the response ends that much earlier.
pub fn response(road: &Road, start: f64, end: f64) -> Result<Vec<f64>, Error> {
    let (start, end) = (crate::error::finite("start", start)?, crate::error::finite("end", end)?);
    // Also false where end − start overflows.
    if !(end - start >= START && end - start <= MOST) {
        let allowed = format!("must lie {START} to {MOST} m beyond start, {start} m");
        return Err(Error::input("end", format!("{end} m"), allowed));
    }
    road.check_holds(start, end)?;
    let (transition, input) = step_matrices();
    let elevation = |x: f64| road.at(x).elevation;
    let initial = (elevation(start + START) - elevation(start)) / START;
    let mut state = SVector::<f64, 4>::new(initial, 0.0, initial, 0.0);
    let steps = ((end - start - BASE) / STEP * (1.0 + 1e-12)).floor() as usize;
    let slopes = (0..steps).map(|k| {
        // The moving average at the middle of the step; nothing before the start or beyond the end is used.
        let rear = start + (k as f64 + 0.5) * STEP;
        (elevation(rear + BASE) - elevation(rear)) / BASE
    });
    let mut response = Vec::with_capacity(steps);
    for slope in slopes {
        state = transition * state + input * slope;
        response.push(state[0] - state[2]);
    }
    Ok(response)
}

/// Longest section [m].
const MOST: f64 = 1e5;

/// Transition over a step, and the effect of a unit slope during it: blocks of the exponential of both together.
fn step_matrices() -> (SMatrix<f64, 4, 4>, SVector<f64, 4>) {
    #[rustfmt::skip]
    let rate = SMatrix::<f64, 5, 5>::from_row_slice(&[
        0.0, 1.0, 0.0, 0.0, 0.0,
        -SUSPENSION, -DAMPING, SUSPENSION, DAMPING, 0.0,
        0.0, 0.0, 0.0, 1.0, 0.0,
        SUSPENSION / AXLE, DAMPING / AXLE, -(TYRE + SUSPENSION) / AXLE, -DAMPING / AXLE, TYRE / AXLE,
        0.0, 0.0, 0.0, 0.0, 0.0,
    ]);
    let step = (rate * (STEP / SPEED)).exp();
    (step.fixed_view::<4, 4>(0, 0).into_owned(), step.fixed_view::<4, 1>(0, 4).into_owned())
}
