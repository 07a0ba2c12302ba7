//! How a vehicle stands still on uneven ground: its loads and coordinates, each suspension with the friction it has.

use nalgebra::{DMatrix, DVector};

use crate::lane::Lane;
use crate::lane::gather::gather;
use crate::vehicle::body::Suspension;
use crate::vehicle::equations::{Assembly, ContactLaw};

/// Most sweeps to find which wheels hang in the air; with all on the ground it takes one.
const SWEEPS: usize = 10_000;

/// Change of a load, relative to the weight, at which it counts as found.
const SETTLED: f64 = 1e-13;

/// What standing on unit elevations does to a vehicle, all wheels on the ground.
#[derive(Debug, Clone)]
pub struct Stand<L> {
    /// Coordinates, wheel by wheel.
    sinks: Vec<L>,
    /// Increments of the loads over their values on the level, by rows [N/m].
    lifts: Vec<L>,
    /// Shortening of the suspension of a massless axle under its load [m/N].
    gives: Vec<L>,
    /// Static loads [N], as increments that no wheel can lose.
    floors: Vec<L>,
}

/// A vehicle at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Stood<L> {
    /// Increments of the loads over those on the level [N].
    pub loads: Vec<L>,
    /// Shortening of the suspensions of massless axles [m].
    pub shortenings: Vec<L>,
    /// Coordinates [m, rad].
    pub coordinates: Vec<L>,
}

gather!(Stand { sinks, lifts, gives, floors });

impl<L: Lane> Stand<L> {
    /// Of a vehicle under gravity [m/s²]; one that is `held` to the ground pulls at it rather than lift a wheel.
    pub fn new(assembly: &Assembly, gravity: f64, held: bool) -> Self {
        let size = assembly.mass.nrows();
        let springs: Vec<f64> = assembly.contacts.iter().map(|c| c.law.stiffness(Suspension::Sliding)).collect();
        // A vehicle that stands on its own resists every motion.
        let inverse = assembly.grounded_stiffness(Suspension::Sliding).try_inverse();
        let inverse = inverse.unwrap_or_else(|| DMatrix::from_element(size, size, f64::NAN));
        let rows = || assembly.contacts.iter().map(|c| &c.row).zip(&springs);
        let sinks: Vec<DVector<f64>> = rows().map(|(row, k)| &inverse * row * -*k).collect();
        let lifts = rows().enumerate().flat_map(|(i, (row, k))| {
            sinks.iter().enumerate().map(move |(j, sink)| k * (f64::from(u8::from(i == j)) + row.dot(sink)))
        });
        let give = |law: &ContactLaw| match *law {
            ContactLaw::Series { suspension_stiffness, .. } => 1.0 / suspension_stiffness,
            _ => 0.0,
        };
        let floor = |load: f64| if held { f64::NEG_INFINITY } else { -load };
        Stand {
            lifts: lifts.map(L::splat).collect(),
            gives: assembly.contacts.iter().map(|c| L::splat(give(&c.law))).collect(),
            floors: assembly.static_loads(gravity).into_iter().map(|load| L::splat(floor(load))).collect(),
            sinks: sinks.iter().flat_map(|sink| sink.iter().copied().map(L::splat)).collect(),
        }
    }

    /// At rest on these elevations [m]; nothing if it is not found which wheels hang in the air.
    ///
    /// A wheel in the air is one on ground raised to it by the gap u ≥ 0, with no load. The loads rise with the gaps by a
    /// symmetric and positive semidefinite matrix, so that one gap after the other comes to the end.
    pub fn on(&self, elevations: &[L]) -> Option<Stood<L>> {
        let (zero, n) = (L::splat(0.0), elevations.len());
        let mut ground = elevations.to_vec();
        let load = |ground: &[L], k: usize| {
            self.lifts[k * n..][..n].iter().zip(ground).fold(zero, |sum, (lift, r)| sum + *lift * *r)
        };
        let weight = self.floors.iter().fold(zero, |sum, floor| sum - *floor);
        let mut done = L::never();
        for _ in 0..SWEEPS {
            let mut left = zero;
            for k in 0..n {
                let lift = self.lifts[k * n + k];
                let (p, floor) = (load(&ground, k), self.floors[k]);
                let raised = (ground[k] + (floor - p) / lift).larger(elevations[k]);
                // Of a wheel that stands, however it loads the others, nothing changes.
                let hangs = !(!(p.less(floor) | elevations[k].less(ground[k])) | done);
                let raised = L::select(hangs, raised, ground[k]);
                left = left + lift * (raised - ground[k]).magnitude();
                ground[k] = raised;
            }
            done = done | !(weight * L::splat(SETTLED)).less(left);
            if L::all(done) {
                let size = self.sinks.len() / n;
                let loads: Vec<L> = (0..n).map(|k| self.floors[k].larger(load(&ground, k))).collect();
                let coordinate = |i: usize| (0..n).fold(zero, |sum, k| sum + self.sinks[k * size + i] * ground[k]);
                return Some(Stood {
                    shortenings: loads.iter().zip(&self.gives).map(|(load, give)| *load * *give).collect(),
                    coordinates: (0..size).map(coordinate).collect(),
                    loads,
                });
            }
        }
        None
    }
}
