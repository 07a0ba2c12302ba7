//! The road under the wheels of one vehicle: off its datum, fading in from where the vehicle starts.

use super::Surface;
use crate::lane::Lane;
use crate::modal_bridge::ModeShapes;
use crate::road::Road;

/// How far a road has faded in after a way t, from 0 to 1, of its ramp [m], with two derivatives along the way.
pub fn fade(t: f64, ramp: f64) -> [f64; 3] {
    // 6t⁵ − 15t⁴ + 10t³: no jump in value, slope or curvature at either end.
    [
        t * t * t * (10.0 + t * (6.0 * t - 15.0)),
        30.0 * t * t * (1.0 - t).powi(2) / ramp,
        60.0 * t * (1.0 - t) * (1.0 - 2.0 * t) / ramp.powi(2),
    ]
}

/// A road on the way of one vehicle, its unevenness fading in from where the vehicle starts.
#[derive(Debug, Clone)]
pub struct Pavement {
    /// The road off its datum: see [`Road::datum`].
    pub road: Road,
    /// Where the vehicle's front starts, from the left end of the bridge [m].
    pub start: f64,
    /// From where on it is level, not being known [m].
    pub end: f64,
    /// Way on which the unevenness fades in [m].
    pub ramp: f64,
    /// +1 for travel to the right, −1 to the left.
    pub direction: f64,
}

/// What of a road counts at a place on the way of a vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Share {
    /// Nothing: the road is level there.
    Level,
    /// A part of it, with the first two derivatives along the bridge of that part.
    Faded([f64; 3]),
    /// All of it.
    Whole,
    /// Its elevation where it ends, from where on it is level.
    Beyond,
}

impl Share {
    /// The surface, from elevation, slope and curvature of the road.
    #[inline(always)]
    pub fn of<L: Lane>(&self, [elevation, slope, curvature]: [L; 3]) -> Surface<L> {
        let zero = L::splat(0.0);
        match *self {
            Share::Level => Surface { elevation: zero, slope: zero, curvature: zero },
            Share::Whole => Surface { elevation, slope, curvature },
            Share::Beyond => Surface { elevation, slope: zero, curvature: zero },
            Share::Faded([fade, fade_1, fade_2]) => {
                let (fade, fade_1, fade_2) = (L::splat(fade), L::splat(fade_1), L::splat(fade_2));
                Surface {
                    elevation: fade * elevation,
                    slope: fade * slope + fade_1 * elevation,
                    curvature: fade * curvature + L::splat(2.0) * fade_1 * slope + fade_2 * elevation,
                }
            }
        }
    }
}

impl Pavement {
    /// What of the road counts at x [m], and where to look for it.
    pub fn share(&self, x: f64) -> (Share, f64) {
        let way = self.direction * (x - self.start);
        // Without a ramp the road is there behind the start too, under the axles that follow the first.
        if way <= 0.0 && self.ramp > 0.0 {
            (Share::Level, x)
        } else if self.direction * (x - self.end) > 0.0 {
            (Share::Beyond, self.end)
        } else if self.ramp == 0.0 || way >= self.ramp {
            (Share::Whole, x)
        } else {
            let [fade, fade_1, fade_2] = fade(way / self.ramp, self.ramp);
            (Share::Faded([fade, self.direction * fade_1, fade_2]), x)
        }
    }

    /// The surface at x [m].
    pub fn at(&self, x: f64) -> Surface<f64> {
        if self.road.is_smooth() {
            return Surface::LEVEL;
        }
        let (share, x) = self.share(x);
        if share == Share::Level {
            return Surface::LEVEL;
        }
        let point = self.road.at(x);
        share.of([point.elevation, point.slope, point.curvature])
    }
}

/// What prescribed and free motion have in common: the bridge, and under each contact the road of its vehicle.
#[derive(Debug, Clone)]
pub struct Ground<'a> {
    /// The modes along the bridge.
    pub shapes: &'a ModeShapes,
    /// Roads, vehicle by vehicle.
    pub pavements: Vec<Option<Pavement>>,
    /// The vehicle of each contact.
    pub vehicle: Vec<usize>,
}

impl Ground<'_> {
    /// What lies under a contact.
    pub fn pavement(&self, contact: usize) -> Option<&Pavement> {
        self.pavements[self.vehicle[contact]].as_ref()
    }
}
