//! International roughness index: the mean rectified slope that a standard quarter car feels at 80 km/h.
//!
//! M. W. Sayers, "On the calculation of International Roughness Index from longitudinal road profile", Transportation
//! Research Record 1501 (1995) 1-12, and ASTM E1926: the profile is a chain of chords between its points, the tyre
//! averages 250 mm of it, and the states are slopes, derivatives with respect to x. The average is that of the chain, an
//! exact integral, and each step takes the mean slope of the average over it, so that no point is passed over wherever
//! the steps lie; every step is exact for an input slope that is constant over it.

use nalgebra::{SMatrix, SVector};

use super::patch::Patch;
use super::profile::Profile;
use super::{Part, Road};
use crate::error::{Error, finite, positive};
use crate::stop_token::StopToken;

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
/// Spacing of points from which on a chord is average enough [m]: less than one and a half of them in the base.
const COARSE: f64 = BASE / 1.5;
/// Length over which the initial slope is taken: half a second [m].
const START: f64 = 11.0;
/// Step [m]: the mean over it, and that it is held, take (πnΔ)²/6 of a wave each, of 1 m 3 in 10 000 in all.
const STEP: f64 = 0.01;
/// Longest section [m].
const MOST: f64 = 1e5;
/// Road before a section of several segments on which the car settles, if there is so much [m]: 3 in 1000 of how it
/// started is left.
const LEAD: f64 = 50.0;
/// Most segments.
const MOST_SEGMENTS: f64 = 1e5;

/// The index of a section, segment by segment.
#[derive(Debug, Clone, PartialEq)]
pub struct Segments {
    /// Ends of the segments [m], one more than segments.
    pub edges: Vec<f64>,
    /// The index of each [m/m].
    pub values: Vec<f64>,
    /// Road before the first on which the car has settled [m].
    pub lead_in: f64,
}

/// The index from `start` to `end` [m/m]; 1e-3 of it is 1 m/km.
pub fn iri(road: &Road, start: f64, end: f64, stop: StopToken<'_>) -> Result<f64, Error> {
    let (mut sum, mut count) = (0.0, 0.0);
    drive(road, start, end, stop, |_, slope| {
        sum += slope.abs();
        count += 1.0;
    })?;
    Ok(sum / count)
}

/// The index of segments of `every` [m] from `start` to `end` [m], through which one car drives.
///
/// It starts up to 50 m before, as far as the road is known, or at the start where less than 11 m are. A rest is a
/// segment of its own, unless the average leaves nothing of it.
pub fn segments(road: &Road, start: f64, end: f64, every: f64, stop: StopToken<'_>) -> Result<Segments, Error> {
    positive("every", every)?;
    check(road, start, end)?;
    if every < BASE {
        return Err(Error::input("every", format!("{every} m"), format!("must be at least {BASE} m, the average")));
    }
    let count = ((end - start - BASE) / every - 1e-9).ceil().max(1.0);
    if count > MOST_SEGMENTS {
        let allowed = format!("must be at least {} m, for {MOST_SEGMENTS} segments", (end - start) / MOST_SEGMENTS);
        return Err(Error::input("every", format!("{every} m"), allowed));
    }
    let known = (start - road.ends()[0]).min(LEAD).min(MOST - (end - start));
    let lead_in = if known >= START { known } else { 0.0 };
    let count = count as usize;
    let (mut sums, mut counts) = (vec![0.0; count], vec![0.0; count]);
    drive(road, start - lead_in, end, stop, |x, slope| {
        let segment = ((x - start) / every) as usize;
        if x >= start && segment < count {
            sums[segment] += slope.abs();
            counts[segment] += 1.0;
        }
    })?;
    let edges = (0..count).map(|k| start + k as f64 * every).chain([end.min(start + count as f64 * every)]).collect();
    Ok(Segments { edges, values: sums.iter().zip(&counts).map(|(sum, count)| sum / count).collect(), lead_in })
}

/// Slope between body and axle [-] after each step of 10 mm, with the middle of the step [m], given to `take`.
///
/// Nothing before the start or beyond the end is used, so that half of an average, if there is one, is missing at either.
pub fn drive(
    road: &Road,
    start: f64,
    end: f64,
    stop: StopToken<'_>,
    mut take: impl FnMut(f64, f64),
) -> Result<(), Error> {
    check(road, start, end)?;
    let (felt, base) = felt(road, start, end, stop)?;
    let elevation = |x: f64| felt.at(x).elevation;
    let (transition, input) = step_matrices();
    let first = start + 0.5 * base;
    let mut before = elevation(first);
    let initial = (elevation(first + START - base) - before) / (START - base);
    let mut state = SVector::<f64, 4>::new(initial, 0.0, initial, 0.0);
    let steps = ((end - start - base) / STEP * (1.0 + 1e-12)).floor() as usize;
    for k in 1..=steps {
        if k % LOOK == 0 {
            stop.check()?;
        }
        let x = first + k as f64 * STEP;
        let here = elevation(x);
        state = transition * state + input * ((here - before) / STEP);
        before = here;
        take(x - 0.5 * STEP, state[0] - state[2]);
    }
    Ok(())
}

/// Steps between two looks at whether to go on.
const LOOK: usize = 4096;

/// Refuses a section that is too short or too long, or that the road does not cover.
fn check(road: &Road, start: f64, end: f64) -> Result<(), Error> {
    let (start, end) = (finite("start", start)?, finite("end", end)?);
    // Also false where end − start overflows.
    if !(end - start >= START && end - start <= MOST) {
        let allowed = format!("must lie {START} to {MOST} m beyond start, {start} m");
        return Err(Error::input("end", format!("{end} m"), allowed));
    }
    road.check_holds(start, end)
}

/// The road as the tyre of the golden car feels it, and the length over which anything of it is averaged [m].
fn felt(road: &Road, start: f64, end: f64, stop: StopToken<'_>) -> Result<(Road, f64), Error> {
    let (base, none) = (Patch::new(BASE)?, Patch::new(0.0)?);
    let is_coarse = |profile: &Profile| profile.spacing(start, end) > COARSE;
    let is_all_coarse = road.parts.iter().all(|part| matches!(part, Part::Profile(profile) if is_coarse(profile)));
    let chords = |profile: &Profile| profile.chords(if is_coarse(profile) { none } else { base });
    Ok((road.remade(chords, base, stop)?, if is_all_coarse { 0.0 } else { BASE }))
}

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
