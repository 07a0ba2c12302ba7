//! Motion that is prescribed: how far a vehicle has come at any time, exactly.

use crate::coordinate::Coordinate;
use crate::error::{Error, finite, not_negative};

/// Highest speed [m/s] and acceleration [m/s²] that are not taken for a slip of the pen.
const MOST: f64 = 1e4;

/// A speed or acceleration within reason; whether it is finite is left to others.
pub fn reasonable(key: impl Into<String>, value: f64, unit: &str) -> Result<f64, Error> {
    let key = key.into();
    if value.is_finite() && value.abs() > MOST {
        return Err(Error::input(key, format!("{value:e} {unit}"), format!("must be at most {MOST} {unit}")));
    }
    Ok(value)
}

/// The way of a vehicle's front, of constant acceleration piece by piece.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Time, way, speed and acceleration at the beginning of each piece; before the first the speed is as there.
    pieces: Vec<(f64, Coordinate<f64>)>,
}

impl Motion {
    /// At constant speed [m/s], at `x` [m] at time zero.
    pub fn steady(x: f64, speed: f64) -> Self {
        Motion { pieces: vec![(0.0, Coordinate { x, v: speed, a: 0.0 })] }
    }

    /// Whether the speed never changes, and is not zero.
    pub fn is_steady(&self) -> bool {
        matches!(self.pieces[..], [(_, c)] if c.a == 0.0 && c.v > 0.0)
    }

    /// With constant acceleration [m/s²] from time zero on; one that slows down stands in the end.
    pub fn accelerated(x: f64, speed: f64, acceleration: f64) -> Result<Self, Error> {
        reasonable("acceleration", finite("acceleration", acceleration)?, "m/s2")?;
        let mut pieces = vec![(0.0, Coordinate { x, v: speed, a: acceleration })];
        if acceleration < 0.0 {
            let stop = -speed / acceleration;
            pieces.push((stop, Coordinate { x: x + 0.5 * speed * stop, v: 0.0, a: 0.0 }));
        }
        Ok(Motion { pieces })
    }

    /// Through speeds [m/s] at times [s], linear between them and constant outside.
    pub fn through(x: f64, times: &[f64], speeds: &[f64]) -> Result<Self, Error> {
        if times.is_empty() || times.len() != speeds.len() {
            let value = format!("{} times and {} speeds", times.len(), speeds.len());
            return Err(Error::input("speeds", value, "give as many speeds as times, one or more"));
        }
        for (i, (&t, &v)) in times.iter().zip(speeds).enumerate() {
            finite(format!("times[{i}]"), t)?;
            not_negative(format!("speeds[{i}]"), v)?;
            reasonable(format!("speeds[{i}]"), v, "m/s")?;
            if i > 0 && t <= times[i - 1] {
                let allowed = format!("must be greater than the time before it, {} s", times[i - 1]);
                return Err(Error::input(format!("times[{i}]"), format!("{t} s"), allowed));
            }
        }
        let mut pieces = vec![(0.0, Coordinate { x, v: speeds[0], a: 0.0 })];
        if times[0] < 0.0 {
            return Err(Error::input("times[0]", format!("{} s", times[0]), "must be 0 or more"));
        }
        let mut way = x + speeds[0] * times[0];
        for (i, (&t, &v)) in times.iter().zip(speeds).enumerate() {
            let a = match times.get(i + 1) {
                Some(next) => (speeds[i + 1] - v) / (next - t),
                None => 0.0,
            };
            pieces.push((t, Coordinate { x: way, v, a }));
            if let Some(next) = times.get(i + 1) {
                way += 0.5 * (v + speeds[i + 1]) * (next - t);
            }
        }
        Ok(Motion { pieces })
    }

    /// Way, speed and acceleration at time t [s].
    pub fn at(&self, t: f64) -> Coordinate<f64> {
        if let [(from, c)] = self.pieces[..]
            && c.a == 0.0
        {
            return Coordinate { x: c.x + c.v * (t - from), ..c };
        }
        let after = self.pieces.partition_point(|piece| piece.0 <= t);
        let Some(i) = after.checked_sub(1) else {
            let (from, first) = self.pieces[0];
            return Coordinate { x: first.x + first.v * (t - from), v: first.v, a: 0.0 };
        };
        let (from, Coordinate { x, v, a }) = self.pieces[i];
        let dt = t - from;
        Coordinate { x: x + dt * (v + 0.5 * a * dt), v: v + a * dt, a }
    }

    /// The piece that holds at time t [s]: way, speed and acceleration at its beginning, when that is, and when the next
    /// begins. Before the first the speed is as there.
    pub fn piece(&self, t: f64) -> (Coordinate<f64>, [f64; 2]) {
        let after = self.pieces.partition_point(|piece| piece.0 <= t);
        let until = self.pieces.get(after).map_or(f64::INFINITY, |piece| piece.0);
        let (from, mut begun) = self.pieces[after.saturating_sub(1)];
        if after == 0 {
            begun.a = 0.0;
        }
        (begun, [from, until])
    }

    /// When the front comes to x, if it does.
    pub fn time_at(&self, x: f64) -> Option<f64> {
        let last = self.pieces.len() - 1;
        for (i, &(from, c)) in self.pieces.iter().enumerate() {
            if i < last && self.pieces[i + 1].1.x < x {
                continue;
            }
            let way = x - c.x;
            if i == 0 && way <= 0.0 {
                return (c.v > 0.0).then(|| from + way / c.v);
            }
            if c.a == 0.0 {
                return (c.v > 0.0).then(|| from + way / c.v);
            }
            // v dt + a dt²/2 = way, in the form that does not cancel.
            let root = c.v * c.v + 2.0 * c.a * way;
            let sum = c.v + root.max(0.0).sqrt();
            return (root >= 0.0 && sum > 0.0).then(|| from + 2.0 * way / sum);
        }
        None
    }

    /// Since when it stands for good, if it does.
    pub fn stands_from(&self) -> Option<f64> {
        let (from, last) = self.pieces[self.pieces.len() - 1];
        (last.v == 0.0 && last.a == 0.0).then_some(from)
    }

    /// Highest speed up to time t.
    pub fn fastest(&self) -> f64 {
        let (_, last) = self.pieces[self.pieces.len() - 1];
        let unbounded = if last.a > 0.0 { f64::INFINITY } else { 0.0 };
        self.pieces.iter().fold(unbounded, |fastest, piece| fastest.max(piece.1.v))
    }
}
