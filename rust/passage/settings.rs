//! How vehicles cross: what the user chooses, for all of them together.

use std::sync::Arc;

use crate::error::{Error, not_negative, positive};
use crate::passage::Drive;
use crate::passage::motion::reasonable;
use crate::road::Road;
use crate::vehicle::STANDARD_GRAVITY;

/// Newmark's β of the least error, 1/12: of an undamped vibration its period then is off by the fourth power of the step
/// and not by the second (L. Fox and E. T. Goodwin, Proc. Cambridge Phil. Soc. 45, 1949).
pub const FOX_GOODWIN: f64 = 1.0 / 12.0;

/// Accuracy of the extremes unless the user asks for another [-].
pub const ACCURACY: f64 = 1e-3;

/// The finest that can be asked for, and the coarsest [-].
const FINEST: f64 = 1e-8;
const COARSEST: f64 = 0.1;

/// How much free vibration is kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tail {
    /// So long [s].
    Fixed(f64),
    /// Until no response that is looked at can exceed what it has reached, or for ten periods of the slowest included
    /// mode, as also where vehicles stand on the bridge: see [`crate::crossing::tail`].
    Free,
}

impl Tail {
    /// How long, if that is given [s].
    pub fn seconds(self) -> Option<f64> {
        match self {
            Tail::Fixed(tail) => Some(tail),
            Tail::Free => None,
        }
    }
}

/// How vehicles cross.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Speed at the start [m/s].
    pub speed: f64,
    /// How the vehicle moves.
    pub drive: Drive,
    /// Newmark's β, from 1/12 to 1/2 [-].
    pub beta: f64,
    /// What the extremes may be off because time goes in steps, in parts of the largest of each response along the bridge
    /// [-]: the length of a step follows from it, see [`crate::passage::step_length`].
    pub accuracy: f64,
    /// Longest time step [s], in place of the one that follows; shortened so that a whole number of steps spans the
    /// crossing.
    pub step: Option<f64>,
    /// Approach in front of the bridge [m].
    pub approach: f64,
    /// Way from the start of the approach on which the road's unevenness fades in [m]; without, vehicles start at rest on
    /// the road under their wheels.
    pub ramp: f64,
    /// Free vibration kept after the last axle has left, or the last vehicle has stopped.
    pub tail: Tail,
    /// Gravity [m/s²].
    pub gravity: f64,
    /// Whether wheels leave the road; if not, their loads may become negative.
    pub lift_off: bool,
    /// The road.
    pub road: Arc<Road>,
}

impl Settings {
    /// Defaults for a given speed [m/s].
    pub fn at_speed(speed: f64) -> Self {
        Settings {
            speed,
            drive: Drive::ConstantSpeed,
            beta: FOX_GOODWIN,
            accuracy: ACCURACY,
            step: None,
            approach: 0.0,
            ramp: 0.0,
            tail: Tail::Fixed(0.0),
            gravity: STANDARD_GRAVITY,
            lift_off: true,
            road: Arc::new(Road::smooth()),
        }
    }

    /// Refuses values that are not allowed.
    pub fn check(&self) -> Result<(), Error> {
        not_negative("approach", self.approach)?;
        not_negative("ramp", self.ramp)?;
        if self.ramp > self.approach {
            let allowed = format!("must not be longer than the approach, {} m", self.approach);
            return Err(Error::input("ramp", format!("{} m", self.ramp), allowed));
        }
        if let Tail::Fixed(tail) = self.tail {
            not_negative("tail", tail)?;
        }
        reasonable("gravity", positive("gravity", self.gravity)?, "m/s2")?;
        if !(self.accuracy >= FINEST && self.accuracy <= COARSEST) {
            let allowed = format!("must be from {FINEST:e} to {COARSEST}, in parts of the largest of each response");
            return Err(Error::input("accuracy", self.accuracy, allowed));
        }
        if let Some(step) = self.step {
            positive("step", step)?;
        }
        if !(self.beta >= 1.0 / 12.0 && self.beta <= 0.5) {
            return Err(Error::input(
                "beta",
                self.beta,
                "must be from 1/12 to 1/2 (1/12 the least error, 1/6 linear, 1/4 average acceleration)",
            ));
        }
        Ok(())
    }
}
