//! The geometry that samples share: where the axles are at every step and stop, modes and road under them, and their
//! influence on the responses.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::extremes::Instant;
use crate::geometry::Surface;
use crate::geometry::pavement::{Pavement, Share};
use crate::modal_bridge::ModeShapes;
use crate::recovery::{Place, Rows};
use crate::road::b_spline::Taps;
use crate::road::random::Synthesis;
use crate::selection::Selection;
use crate::stops::{Passing, PassingInfluence, Positions, Stop, short_of};
use crate::tape::{CHUNK, PART, PARTS};

/// The step of a chunk of so many that is looked at first.
pub fn middle(count: usize) -> usize {
    count / 2
}

/// Most influence numbers kept ready; beyond that they are worked out again for each group of lanes.
pub const READY: usize = 1 << 23;

/// Influence of the axle loads over a chunk of steps.
#[derive(Debug, Clone, Default)]
pub struct Chunk {
    /// On each row, by row, step and axle.
    pub influence: Vec<f64>,
    /// The same at the step in the middle, by row and axle.
    pub middles: Vec<f64>,
    /// Least and largest, by row and axle.
    pub bounds: Vec<[f64; 2]>,
    /// Least and largest by row, part and axle.
    pub parts: Vec<[f64; 2]>,
}

/// The road below an axle.
#[derive(Debug, Clone, Copy)]
pub enum Below {
    /// The same for every sample.
    Given(Surface<f64>),
    /// With a part of the sample's own.
    Own {
        /// Elevation, slope and curvature of what all share.
        given: [f64; 3],
        /// Which coefficients of the sample's part count.
        taps: Taps,
        /// What of the sum counts.
        share: Share,
    },
}

/// How axles move in equal steps of space.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Advance {
    /// Front axle at the start [m].
    pub start: f64,
    /// Way per step [m].
    pub advance: f64,
    /// Distance of each axle behind the first [m].
    pub behind: Vec<f64>,
    /// Number of steps until the last axle has left.
    pub steps: usize,
    /// Steps beyond these in which the vehicle is followed, if there is a tail.
    pub beyond: usize,
}

impl Positions for Advance {
    fn axles(&self) -> usize {
        self.behind.len()
    }

    #[inline(always)]
    fn x(&self, step: usize, axle: usize) -> f64 {
        self.advance * step as f64 + self.start - self.behind[axle]
    }
}

/// The shared geometry.
#[derive(Debug, Clone)]
pub struct Table {
    /// How the axles move.
    pub path: Advance,
    /// Number of modes.
    pub modes: usize,
    /// Where axles stand on the bridge, by step and axle.
    places: Vec<Place>,
    /// What lies below them.
    pub below: Vec<Below>,
    /// Φ⁰ and, if the step asks for them, its first two derivatives, by step, axle and mode.
    pub shapes: Vec<f64>,
    /// Derivatives held, the value included.
    pub kinds: usize,
    /// First step with an axle on the bridge, which is at rest till then.
    pub first: usize,
    /// Stops between steps, in order.
    pub stops: Vec<Stop>,
    /// Whether what the axles do to the bridge is laid out for many samples.
    pub laid_out: bool,
    /// If so, what static loads of one at the axles make of the coordinates, by step, axle and coordinate.
    statics: Vec<f64>,
    /// And the same with the influence on the rows, at every stop.
    passing_influences: Vec<PassingInfluence>,
    /// And the influence of each axle load on each row, by chunk from `first` on, if that is not too much: see
    /// [`Table::chunks`].
    ready: Option<Vec<Chunk>>,
}

/// The roads of a study: a part that is the same for all samples, and a random one of each sample's own.
#[derive(Debug, Clone, Copy)]
pub struct StudyRoad<'a> {
    /// What all share, on its way.
    pub pavement: &'a Pavement,
    /// What the samples' own roads have in common.
    pub own: Option<&'a Synthesis>,
}

impl StudyRoad<'_> {
    fn below(&self, x: f64) -> Below {
        let Some(own) = self.own else { return Below::Given(self.pavement.at(x)) };
        let (share, x) = self.pavement.share(x);
        if share == Share::Level {
            return Below::Given(Surface::LEVEL);
        }
        let given = self.pavement.road.at(x);
        let taps = Taps::new(x, own.points(), own.period());
        Below::Own { given: [given.elevation, given.slope, given.curvature], taps, share }
    }
}

impl Table {
    /// For axles on their `path` over a bridge of which `look` is looked at; with `slopes` of the modes if the step asks
    /// for them, and with what axles do to the bridge `laid_out` if many samples share it.
    pub fn new(
        path: Advance,
        shapes: &ModeShapes,
        (rows, look): (&Rows, &Selection),
        slopes: bool,
        ground: StudyRoad<'_>,
        laid_out: bool,
    ) -> Self {
        let (kinds, axles, steps) = (if slopes { 3 } else { 1 }, path.behind.len(), path.steps);
        let mut table = Table {
            modes: shapes.modes(),
            places: Vec::with_capacity((steps + 1) * axles),
            below: Vec::with_capacity((steps + path.beyond + 1) * axles),
            shapes: Vec::with_capacity((steps + path.beyond + 1) * axles * shapes.modes() * kinds),
            kinds,
            first: steps,
            stops: Vec::new(),
            laid_out,
            statics: Vec::new(),
            passing_influences: Vec::new(),
            ready: None,
            path,
        };
        for step in 0..=steps + table.path.beyond {
            for axle in 0..axles {
                let x = table.path.x(step, axle);
                let place = rows.place(x);
                table.below.push(ground.below(x));
                shapes.extend_at(x, kinds, &mut table.shapes);
                table.places.push(place);
                if laid_out && step <= steps {
                    rows.extend_static(place, &mut table.statics);
                }
                if place.is_some() {
                    table.first = table.first.min(step);
                }
            }
        }
        let marks: Vec<f64> = look.marks.iter().map(|mark| mark.x).collect();
        table.stops = passings(&table.path, &marks).iter().flat_map(|passing| passing.stops(look, true)).collect();
        if !laid_out {
            return table;
        }
        let influence = |stop: &Stop| {
            let mut influence = PassingInfluence::default();
            influence.fill(stop, &table.path, rows, look);
            influence
        };
        table.passing_influences = table.stops.iter().map(influence).collect();
        let all = look.rows.len() * axles * (steps + 1 - table.first);
        if all <= READY {
            let chunks = (table.first..=steps).step_by(CHUNK);
            let filled = chunks.map(|from| {
                let mut chunk = Chunk::default();
                table.fill(from, rows, look, &mut chunk);
                chunk
            });
            table.ready = Some(filled.collect());
        }
        table
    }

    /// When an instant is, in steps of h [s].
    pub fn when(&self, instant: Instant, h: f64) -> f64 {
        match instant {
            Instant::Step(step) => step as f64 * h,
            Instant::Stop(stop) => self.stops[stop].when(h),
        }
    }

    /// Number of axles.
    pub fn axles(&self) -> usize {
        self.path.behind.len()
    }

    /// The last step that the table knows; beyond it there is the bridge alone.
    pub fn last(&self) -> usize {
        self.path.steps + self.path.beyond
    }

    /// The chunks of a run of steps that begins with a chunk, and ends with one or with the path.
    pub fn chunks<'a>(
        &'a self,
        from: usize,
        to: usize,
        rows: &Rows,
        look: &Selection,
        scratch: &'a mut Vec<Chunk>,
    ) -> &'a [Chunk] {
        let count = (to - from).div_ceil(CHUNK);
        let first = (from - self.first) / CHUNK;
        if let Some(ready) = &self.ready {
            return &ready[first..first + count];
        }
        scratch.resize_with(count.max(scratch.len()), Chunk::default);
        for (i, chunk) in scratch[..count].iter_mut().enumerate() {
            self.fill(from + i * CHUNK, rows, look, chunk);
        }
        &scratch[..count]
    }

    fn fill(&self, from: usize, rows: &Rows, look: &Selection, chunk: &mut Chunk) {
        let axles = self.axles();
        let to = (from + CHUNK).min(self.path.steps + 1);
        let places = &self.places[from * axles..to * axles];
        let count = to - from;
        chunk.influence.clear();
        chunk.middles.clear();
        chunk.bounds.clear();
        chunk.parts.clear();
        for row in &look.rows {
            let start = chunk.influence.len();
            let influence = |place: &Place| place.map_or(0.0, |place| rows.influence_of(row.response, place));
            chunk.influence.extend(places.iter().map(influence));
            let own = &chunk.influence[start..];
            let bounds = |axle: usize, steps: Range<usize>| {
                let numbers = steps.map(|step| own[step * axles + axle]);
                numbers.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], g| [low.min(g), high.max(g)])
            };
            chunk.middles.extend_from_slice(&own[middle(count) * axles..][..axles]);
            chunk.bounds.extend((0..axles).map(|axle| bounds(axle, 0..count)));
            for part in 0..PARTS {
                let steps = (part * PART).min(count)..((part + 1) * PART).min(count);
                chunk.parts.extend((0..axles).map(|axle| bounds(axle, steps.clone())));
            }
        }
    }

    /// Where axles stand on the bridge at some of its steps, by step and axle.
    pub fn places(&self, steps: Range<usize>) -> &[Place] {
        let axles = self.axles();
        &self.places[steps.start * axles..steps.end * axles]
    }

    /// What static loads of one at the axles make of the coordinates at a step, by axle and coordinate.
    pub fn statics<'a>(&'a self, step: usize, rows: &Rows, scratch: &'a mut Vec<f64>) -> &'a [f64] {
        let width = self.axles() * rows.width();
        if self.laid_out {
            return &self.statics[step * width..(step + 1) * width];
        }
        scratch.clear();
        self.places(step..step + 1).iter().for_each(|place| rows.extend_static(*place, scratch));
        scratch
    }

    /// What the axles do to the bridge at a stop.
    pub fn passing_influence<'a>(
        &'a self,
        stop: usize,
        rows: &Rows,
        look: &Selection,
        scratch: &'a mut PassingInfluence,
    ) -> &'a PassingInfluence {
        if self.laid_out {
            return &self.passing_influences[stop];
        }
        scratch.fill(&self.stops[stop], &self.path, rows, look);
        scratch
    }
}

/// Every passing of some marks [m], in order.
pub fn passings(path: &Advance, marks: &[f64]) -> Vec<Passing> {
    // Where rounding leaves the last axle just short of the end, it passes that in the first step of the tail.
    let last = path.steps + usize::from(path.beyond > 0);
    let mut passings = Vec::with_capacity(path.behind.len() * marks.len());
    for axle in 0..path.behind.len() {
        for (mark, &at) in marks.iter().enumerate() {
            // The first step at whose end the axle is not before the mark; where it starts it does not pass.
            let (mut step, mut end, near) = (0, last + 1, at - short_of(path, axle, at));
            while step < end {
                let middle = step + (end - step) / 2;
                if path.x(middle, axle) < near { step = middle + 1 } else { end = middle }
            }
            if step == 0 || step > last {
                continue;
            }
            passings.push(Passing::new(path, step, axle, (mark, at)));
        }
    }
    passings.sort_unstable_by_key(|passing| (passing.step, passing.axle, passing.mark));
    passings
}
