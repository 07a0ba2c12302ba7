//! Roads: elevation, slope and curvature of the surface under the wheels, as functions of x.
//!
//! x runs from the left end of the bridge, negative on the left approach; elevation is positive up. A road is a sum of
//! [`random`] roads after ISO 8608 ([`spectrum`]), measured [`profile`]s and single [`feature`]s, each averaged over
//! the contact [`patch`] of a tyre; the [`golden_car`] measures its roughness, its [`texture`] tells
//! what time steps have to resolve. A vehicle feels it from the [`datum`] of
//! its way. Random roads are made by [`philox`], [`turn`], [`fft`] and [`b_spline`], with the same bits on every
//! machine.

pub(crate) mod b_spline;
pub(crate) mod datum;
pub(crate) mod feature;
pub(crate) mod fft;
pub mod golden_car;
pub(crate) mod patch;
pub(crate) mod philox;
pub(crate) mod point;
pub(crate) mod profile;
pub(crate) mod random;
pub(crate) mod spectrum;
pub(crate) mod texture;

pub use feature::Feature;
pub use fft::InverseFft;
pub use patch::Patch;
pub use philox::{philox4x32, philox4x32_lanes};
pub use point::Point;
pub use profile::Profile;
pub use random::Synthesis;
pub use spectrum::{Class, Spectrum};
pub use texture::Texture;
pub mod turn;

use std::sync::Arc;

use crate::error::{Error, finite};
use crate::stop_token::StopToken;
use datum::Datum;
use random::Random;

/// Part of the highest wave number of samples, half a wave each, up to which they are taken at their word.
const OF_NYQUIST: f64 = 0.8;

/// A place, or a millimetre before it at most, in digits that one can write, never −0 [m].
pub fn down_to_mm(x: f64) -> f64 {
    (1e3 * x).floor() / 1e3 + 0.0
}

/// Way from its start whose line a vehicle feels a measured road from [m].
const FITTED: f64 = 10.0;

/// A road surface; copies share their data.
#[derive(Debug, Clone, PartialEq)]
pub struct Road {
    parts: Vec<Part>,
}

#[derive(Debug, Clone, PartialEq)]
enum Part {
    Random(Arc<Random>),
    Profile(Arc<Profile>),
    Feature(Arc<Feature>),
    /// Off which the others are.
    Datum(Datum),
}

impl Part {
    fn at(&self, x: f64) -> Point {
        match self {
            Part::Random(random) => random.at(x),
            Part::Profile(profile) => profile.at(x),
            Part::Feature(feature) => feature.at(x),
            Part::Datum(datum) => datum.taken_off(x),
        }
    }
}

impl From<Random> for Road {
    fn from(random: Random) -> Self {
        Road { parts: vec![Part::Random(Arc::new(random))] }
    }
}

impl From<Profile> for Road {
    fn from(profile: Profile) -> Self {
        Road { parts: vec![Part::Profile(Arc::new(profile))] }
    }
}

impl From<Feature> for Road {
    fn from(feature: Feature) -> Self {
        Road { parts: vec![Part::Feature(Arc::new(feature))] }
    }
}

impl Road {
    /// The road without any roughness.
    pub fn smooth() -> Self {
        Road { parts: Vec::new() }
    }

    /// All of them on top of each other.
    pub fn sum(roads: impl IntoIterator<Item = Road>) -> Self {
        let mut parts: Vec<Part> = roads.into_iter().flat_map(|road| road.parts).collect();
        // What is random comes last in the sum, as in an ensemble, where the rest is the same for all.
        parts.sort_by_key(|part| matches!(part, Part::Random(_)));
        Road { parts }
    }

    /// Whether there is no roughness.
    pub fn is_smooth(&self) -> bool {
        self.parts.is_empty()
    }

    /// Points that its parts are given by.
    pub fn points(&self) -> usize {
        let of = |part: &Part| match part {
            Part::Random(random) => random.points(),
            Part::Profile(profile) => profile.points(),
            Part::Feature(_) | Part::Datum(_) => 0,
        };
        self.parts.iter().map(of).sum()
    }

    /// Elevation, slope and curvature at x [m].
    ///
    /// A random road repeats beyond its period, and a profile goes on along the tangents at its ends: see
    /// [`Road::check_covers`].
    pub fn at(&self, x: f64) -> Point {
        let mut sum = Point { elevation: 0.0, slope: 0.0, curvature: 0.0 };
        for part in &self.parts {
            let point = part.at(x);
            sum.elevation += point.elevation;
            sum.slope += point.slope;
            sum.curvature += point.curvature;
        }
        sum
    }

    /// The line from which a vehicle feels the road that starts at `start` and goes over the bridge as far as `far` [m].
    ///
    /// Of a measured profile it is the least-squares line of the first 10 m, so that heights above the sea and grades do not
    /// count, and that a vehicle starts along the road where that curves; of a feature the level at the start. Random roads
    /// are deviations from the line already.
    pub fn datum(&self, start: f64, far: f64) -> Datum {
        let features = self.parts.iter().map(|part| match part {
            Part::Feature(feature) => feature.at(start).elevation,
            _ => 0.0,
        });
        let measured = |x: f64| {
            let profiles = self.parts.iter().map(|part| match part {
                Part::Profile(profile) => profile.at(x).elevation,
                _ => 0.0,
            });
            profiles.sum()
        };
        let end = start + (far - start).clamp(-FITTED, FITTED);
        Datum::fitted(start, end, measured).raised(features.sum())
    }

    /// How much higher than the least-squares line of the whole way the line is from which a vehicle feels the road: at
    /// `start` and at `far` [m]. Motion is told from the former, for the first 10 m say little of where a road leads.
    pub fn drift(&self, start: f64, far: f64) -> [f64; 2] {
        let felt = self.datum(start, far);
        let off = self.off(felt);
        // What is random is told as it is.
        let measured = off.parts.iter().filter(|part| !matches!(part, Part::Random(_) | Part::Feature(_)));
        if !measured.clone().any(|part| matches!(part, Part::Profile(_))) {
            return [0.0; 2];
        }
        let elevation = |x: f64| measured.clone().map(|part| part.at(x).elevation).sum();
        let whole = Datum::fitted(start, far, elevation);
        [start, far].map(|x| whole.taken_off(x).elevation)
    }

    /// The road off a line.
    pub fn off(&self, datum: Datum) -> Self {
        let mut parts = self.parts.clone();
        if !datum.is_zero() {
            // What is random stays last in the sum.
            let place = parts.iter().position(|part| matches!(part, Part::Random(_))).unwrap_or(parts.len());
            parts.insert(place, Part::Datum(datum));
        }
        Road { parts }
    }

    /// The same surface averaged over another length [m] than its contact patches, exactly; `stop` is asked before each
    /// part whether to.
    pub fn averaged(&self, length: f64, stop: StopToken<'_>) -> Result<Self, Error> {
        let patch = Patch::new(length)?;
        self.remade(|profile| profile.under(patch), patch, stop)
    }

    /// The surface with its profiles as `profile` makes them and all else under a contact patch.
    fn remade(&self, profile: impl Fn(&Profile) -> Profile, patch: Patch, stop: StopToken<'_>) -> Result<Self, Error> {
        let parts = self.parts.iter().map(|part| {
            stop.check()?;
            Ok(match part {
                Part::Random(random) => Part::Random(Arc::new(random.under(patch)?)),
                Part::Profile(measured) => Part::Profile(Arc::new(profile(measured))),
                Part::Feature(feature) => Part::Feature(Arc::new(feature.under(patch))),
                Part::Datum(datum) => Part::Datum(*datum),
            })
        });
        Ok(Road { parts: parts.collect::<Result<_, Error>>()? })
    }

    /// Wave numbers from `from` to `to` [m] [cycle/m]: up to which all its parts are known, and those of the finest part.
    ///
    /// Of points, up to 0.8 of half a wave per point, beyond which what is between them is anyone's guess; of a random
    /// road, those of its band; features are known exactly, and do not count.
    pub fn waves(&self, from: f64, to: f64) -> [f64; 2] {
        let (mut measured, mut random, mut finest) = (f64::INFINITY, None, 0.0_f64);
        for part in &self.parts {
            let highest = match part {
                Part::Random(part) => {
                    random = Some(part.highest().max(random.unwrap_or(0.0)));
                    part.highest()
                }
                Part::Profile(part) => {
                    let highest = OF_NYQUIST * 0.5 / part.spacing(from, to);
                    measured = measured.min(highest);
                    highest
                }
                Part::Feature(_) | Part::Datum(_) => 0.0,
            };
            finest = finest.max(highest);
        }
        [random.unwrap_or(f64::INFINITY).min(measured), finest]
    }

    /// How smooth the surface is, averaged over contact patches: −1 if its elevation jumps anywhere, 0 if its slope
    /// does, 1 or more if neither.
    pub fn smoothness(&self) -> i32 {
        self.parts.iter().fold(2, |least, part| match part {
            Part::Feature(feature) => least.min(feature.smoothness()),
            Part::Random(_) | Part::Profile(_) | Part::Datum(_) => least,
        })
    }

    /// How rough it is from `from` to `to` [m].
    pub fn texture(&self, from: f64, to: f64) -> Texture {
        let of = |part: &Part| match part {
            Part::Random(random) => random.texture(),
            Part::Profile(profile) => profile.texture(from, to),
            Part::Feature(feature) => Texture { finest: feature.finest(from, to), ..Texture::SMOOTH },
            Part::Datum(_) => Texture::SMOOTH,
        };
        self.parts.iter().map(of).fold(Texture::SMOOTH, Texture::with)
    }

    /// The x that the road is known for [m]; infinite where nothing was measured.
    pub fn ends(&self) -> [f64; 2] {
        self.parts.iter().fold([f64::NEG_INFINITY, f64::INFINITY], |[from, to], part| match part {
            Part::Profile(profile) => [from.max(profile.ends()[0]), to.min(profile.ends()[1])],
            _ => [from, to],
        })
    }

    /// Length after which the road, or a part of it, repeats [m]; infinite if none does.
    pub fn period(&self) -> f64 {
        self.parts.iter().fold(f64::INFINITY, |shortest, part| match part {
            Part::Random(random) => shortest.min(random.period()),
            _ => shortest,
        })
    }

    /// Refuses a path from `from` to `to` [m] on which the road is not known everywhere, or repeats.
    pub fn check_covers(&self, from: f64, to: f64) -> Result<(), Error> {
        self.check_holds(from, to).map_err(|error| {
            let ([first, last], start) = (self.ends(), down_to_mm(from));
            let long_enough = start + (last - first) >= to;
            let moved = format!(
                ", or say where this one begins as it is read from a file: start = its first station minus the station \
                 of the bridge's left end, {start} at most"
            );
            error.advising("; give a longer road").advising(if long_enough { &moved } else { "" })
        })?;
        let period = self.period();
        if to - from > period {
            let allowed =
                format!("it repeats after its period of {period} m, and the path is longer; give a longer one");
            return Err(Error::input("road", format!("path from {from} m to {to} m"), allowed));
        }
        Ok(())
    }

    /// Refuses a stretch from `from` to `to` [m] on which the road is not known everywhere.
    pub fn check_holds(&self, from: f64, to: f64) -> Result<(), Error> {
        let (from, to) = (finite("path from", from)?, finite("path to", to)?);
        let [first, last] = self.ends();
        if from < first || to > last {
            let allowed = format!("the road covers only {first} m to {last} m");
            return Err(Error::input("road", format!("path from {from} m to {to} m"), allowed));
        }
        Ok(())
    }
}
