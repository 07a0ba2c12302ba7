//! Single features of a road in closed form: steps, ramps, bumps, potholes, joints and camber.

use std::f64::consts::PI;

use super::patch::{Curve, Patch};
use super::point::Point;
use super::turn::sin_cos;
use crate::error::{Error, finite, not_negative, positive};

/// A feature, made of rises and arches.
#[derive(Debug, Clone, PartialEq)]
pub struct Feature {
    pieces: Vec<Piece>,
    patch: Patch,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Piece {
    /// From 0 up to the height along half a cosine wave; at once if its length is 0.
    Smooth { start: f64, length: f64, height: f64 },
    /// From 0 up to the height along a straight line.
    Straight { start: f64, length: f64, height: f64 },
    /// A parabola from 0 through the height back to 0.
    Arch { start: f64, length: f64, height: f64 },
}

impl Feature {
    /// The road is higher by `height` [m] from `at` [m] on.
    pub fn step(at: f64, height: f64, patch: Patch) -> Result<Self, Error> {
        let piece = Piece::Smooth { start: finite("at", at)?, length: 0.0, height: finite("height", height)? };
        Ok(Feature { pieces: vec![piece], patch })
    }

    /// A straight rise by `height` [m] from `start` to `end` [m], after which the road stays there.
    pub fn ramp(start: f64, end: f64, height: f64, patch: Patch) -> Result<Self, Error> {
        let length = between(start, end)?;
        let piece = Piece::Straight { start, length, height: finite("height", height)? };
        Ok(Feature { pieces: vec![piece], patch })
    }

    /// A raised (or lowered) stretch of a `length` centred at `at`, its sides half cosine waves of length `edge` [m].
    ///
    /// With sides of half its length it is one cosine wave, ½h (1 − cos 2πs); with none it is a rectangle.
    pub fn plateau(at: f64, length: f64, height: f64, edge: f64, patch: Patch) -> Result<Self, Error> {
        finite("at", at)?;
        positive("length", length)?;
        finite("height", height)?;
        not_negative("edge", edge)?;
        if edge > 0.5 * length {
            let allowed = format!("must be at most half the length, {} m", 0.5 * length);
            return Err(Error::input("edge", format!("{edge} m"), allowed));
        }
        let side = |start: f64, height: f64| Piece::Smooth { start, length: edge, height };
        let pieces = vec![side(at - 0.5 * length, height), side(at + 0.5 * length - edge, -height)];
        Ok(Feature { pieces, patch })
    }

    /// A parabola that rises by `rise` [m] halfway between `start` and `end` [m].
    pub fn camber(start: f64, end: f64, rise: f64, patch: Patch) -> Result<Self, Error> {
        let length = between(start, end)?;
        let piece = Piece::Arch { start, length, height: finite("rise", rise)? };
        Ok(Feature { pieces: vec![piece], patch })
    }

    /// The same under another contact patch.
    pub fn under(&self, patch: Patch) -> Self {
        Feature { pieces: self.pieces.clone(), patch }
    }

    /// How smooth it is: −1 with a jump, 0 with a kink, 1 with a continuous slope; a contact patch adds one.
    pub fn smoothness(&self) -> i32 {
        let piece = |piece: &Piece| match *piece {
            Piece::Smooth { length: 0.0, .. } => -1,
            Piece::Straight { .. } | Piece::Arch { .. } => 0,
            Piece::Smooth { .. } => 1,
        };
        let least = self.pieces.iter().map(piece).min().unwrap_or(1);
        least + i32::from(self.patch.length() > 0.0)
    }

    /// The shortest way over which it changes between `from` and `to` [m]: an edge and the contact patch together;
    /// infinite if it jumps.
    pub fn finest(&self, from: f64, to: f64) -> f64 {
        let patch = self.patch.length();
        let ends = self.pieces.iter().map(|piece| match *piece {
            Piece::Smooth { start, length, .. }
            | Piece::Straight { start, length, .. }
            | Piece::Arch { start, length, .. } => (start, length),
        });
        let there = ends.filter(|(start, length)| start - patch <= to && start + length + patch >= from);
        let ways = there.map(|(_, length)| length + patch).filter(|way| *way > 0.0);
        ways.fold(f64::INFINITY, f64::min)
    }

    /// Elevation, slope and curvature at x, averaged over the contact patch.
    pub fn at(&self, x: f64) -> Point {
        self.patch.average(|x| self.curve(x), x)
    }

    fn curve(&self, x: f64) -> Curve {
        let mut sum = Curve { integral: 0.0, elevation: 0.0, slope: 0.0, curvature: 0.0 };
        for piece in &self.pieces {
            let curve = piece.curve(x);
            sum.integral += curve.integral;
            sum.elevation += curve.elevation;
            sum.slope += curve.slope;
            sum.curvature += curve.curvature;
        }
        sum
    }
}

impl Piece {
    fn curve(&self, x: f64) -> Curve {
        match *self {
            Piece::Smooth { start, length, height } => rise(x - start, length, height, |s| {
                let (sine, cosine) = sin_cos(0.5 * s);
                [0.5 * (s - sine / PI), 0.5 * (1.0 - cosine), 0.5 * PI * sine, 0.5 * PI * PI * cosine]
            }),
            Piece::Straight { start, length, height } => {
                rise(x - start, length, height, |s| [0.5 * s * s, s, 1.0, 0.0])
            }
            Piece::Arch { start, length, height } => {
                let s = (x - start) / length;
                let area = |s: f64| s * s * (2.0 - 4.0 / 3.0 * s) * length * height;
                if s < 0.0 {
                    Curve { integral: 0.0, elevation: 0.0, slope: 0.0, curvature: 0.0 }
                } else if s >= 1.0 {
                    Curve { integral: area(1.0), elevation: 0.0, slope: 0.0, curvature: 0.0 }
                } else {
                    Curve {
                        integral: area(s),
                        elevation: 4.0 * height * s * (1.0 - s),
                        slope: 4.0 * height * (1.0 - 2.0 * s) / length,
                        curvature: -8.0 * height / (length * length),
                    }
                }
            }
        }
    }
}

/// A rise from 0 to `height` whose shape is given for s from 0 to 1, with its integral over s and two derivatives; the
/// integral to the end of the rise is half of it for every shape here, which all are symmetric.
fn rise(x: f64, length: f64, height: f64, shape: impl Fn(f64) -> [f64; 4]) -> Curve {
    if x < 0.0 {
        Curve { integral: 0.0, elevation: 0.0, slope: 0.0, curvature: 0.0 }
    } else if x >= length {
        Curve { integral: height * (x - 0.5 * length), elevation: height, slope: 0.0, curvature: 0.0 }
    } else {
        let [integral, value, first, second] = shape(x / length);
        Curve {
            integral: height * length * integral,
            elevation: height * value,
            slope: height * first / length,
            curvature: height * second / (length * length),
        }
    }
}

/// Length from `start` to `end`, which must follow [m].
fn between(start: f64, end: f64) -> Result<f64, Error> {
    finite("start", start)?;
    finite("end", end)?;
    if end <= start {
        return Err(Error::input("end", format!("{end} m"), format!("must be greater than start, {start} m")));
    }
    Ok(end - start)
}
