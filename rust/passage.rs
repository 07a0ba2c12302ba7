//! How a vehicle crosses, as the user says it: its drive, direction, entry, lane and road.
//!
//! What all vehicles of a crossing have in common are its [`settings`]; with them a passage is [`planned`] as a
//! [`motion`], and the crossing divided into steps ([`step_length`]).

pub(crate) mod motion;
pub(crate) mod planned;
pub(crate) mod settings;
pub(crate) mod step_length;

pub use motion::Motion;
pub use settings::{Settings, Tail};

use std::sync::Arc;

use crate::road::Road;
use crate::vehicle::Vehicle;

/// How a vehicle moves along the bridge.
#[derive(Debug, Clone, PartialEq)]
pub enum Drive {
    /// At the given speed throughout.
    ConstantSpeed,
    /// Traction and resistance in balance on the level: the speed follows the slope under the axles (KTN73 §4).
    ConstantTraction,
    /// With constant acceleration [m/s²] from the start of the approach; one that slows down stands in the end.
    Acceleration(f64),
    /// Through given speeds [m/s] at given times [s] after the vehicle's entry, linear between them.
    Speeds {
        /// Times [s], ascending.
        times: Vec<f64>,
        /// Speeds [m/s].
        speeds: Vec<f64>,
    },
    /// As at constant traction, and from a point on with the brakes on.
    Braking(Braking),
}

/// How a vehicle brakes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Braking {
    /// Deceleration asked for, shared out among the wheels like their static loads [m/s²].
    pub deceleration: f64,
    /// Where the front axle is when braking begins, from the end of the bridge at which it enters [m].
    pub from: f64,
    /// Time in which the brake forces grow [s].
    pub ramp: f64,
    /// Coefficient of friction between tyre and road: bound of each brake force relative to the axle load.
    pub adhesion: f64,
}

/// The direction of travel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// From the left end to the right.
    Right,
    /// From the right end to the left.
    Left,
}

impl Direction {
    /// +1 to the right, −1 to the left.
    pub fn sign(self) -> f64 {
        match self {
            Direction::Right => 1.0,
            Direction::Left => -1.0,
        }
    }
}

/// A vehicle and how it crosses.
#[derive(Debug, Clone, PartialEq)]
pub struct Passage {
    /// The vehicle.
    pub vehicle: Vehicle,
    /// Speed at the start [m/s], if not that of the [`Settings`].
    pub speed: Option<f64>,
    /// How it moves, if not as the [`Settings`] say.
    pub drive: Option<Drive>,
    /// Where it goes.
    pub direction: Direction,
    /// When its front axle is at the start of the approach [s].
    pub entry: f64,
    /// Vehicles of the same lane must not overlap.
    pub lane: i64,
    /// The road under it, if not that of the [`Settings`].
    pub road: Option<Arc<Road>>,
}

impl Passage {
    /// Of a vehicle that enters at the left end at once.
    pub fn of(vehicle: Vehicle) -> Self {
        Passage { vehicle, speed: None, drive: None, direction: Direction::Right, entry: 0.0, lane: 0, road: None }
    }
}
