//! The geometry that samples share: where the axles are at every step and stop, modes and road under them, and their
//! influence on the responses.

use std::ops::Range;

use super::path::{Advance, passings};
use super::resultant::Resultant;
use crate::error::Error;
use crate::extremes::Instant;
use crate::geometry::Surface;
use crate::geometry::pavement::{Pavement, Share};
use crate::modal_bridge::ModeShapes;
use crate::recovery::{Place, Rows};
use crate::road::b_spline::Taps;
use crate::road::random::Synthesis;
use crate::selection::Selection;
use crate::step::driving::Drive;
use crate::stop_token::StopToken;
use crate::stops::{PassingInfluence, Positions, Stop};
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

/// The same for steps that ask for nothing but the elevation, in a third of the memory: a step is short, and reads it anew
/// for every group.
#[derive(Debug, Clone, Copy)]
pub struct Ground {
    /// Number of the first coefficient that counts.
    pub first: usize,
    /// How much of the whole there is.
    pub share: f64,
    /// Elevation of what all share [m].
    pub given: f64,
    /// Weights of the coefficients.
    pub weights: [f64; 4],
}

impl Ground {
    fn of(below: &Below) -> Self {
        let level = |given: f64| Ground { first: 0, share: 1.0, given, weights: [0.0; 4] };
        match *below {
            Below::Given(surface) => level(surface.elevation),
            Below::Own { share: Share::Level, .. } => level(0.0),
            Below::Own { given, taps, share } => {
                let share = if let Share::Faded([fade, ..]) = share { fade } else { 1.0 };
                Ground { first: taps.first, share, given: given[0], weights: taps.weights[0] }
            }
        }
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
    /// The same in short, if steps ask for no more.
    pub grounds: Vec<Ground>,
    /// Φ⁰ and, if the step asks for them, its first two derivatives, by step, axle and mode.
    pub shapes: Vec<f64>,
    /// Derivatives held, the value included.
    pub kinds: usize,
    /// First step with an axle on the bridge, which is at rest till then.
    pub first: usize,
    /// Stops between steps, in order.
    pub stops: Vec<Stop>,
    /// How constant loads drive the modes, where the axles are that.
    pub drive: Option<Drive>,
    /// All of them as one, if the same for all samples.
    pub resultant: Option<Resultant>,
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

/// What is laid out beforehand of what the axles do to the bridge.
#[derive(Debug, Clone, PartialEq)]
pub enum Layout {
    /// Nothing: it is worked out as it is asked for.
    Bare,
    /// That of each axle, for many samples.
    Each,
    /// That of constant loads [N] together, the same for many samples.
    Together(Vec<f64>),
}

/// What moves over the bridge.
#[derive(Debug, Clone, Copy)]
pub enum Feeling<'a> {
    /// Constant loads, which feel nothing.
    Nothing,
    /// Axles that feel the road and the bridge, with its slopes or without.
    Below(StudyRoad<'a>, bool),
}

impl Table {
    /// For axles on their `path` over a bridge of which `look` is looked at.
    pub fn new(
        path: Advance,
        shapes: &ModeShapes,
        (rows, look): (&Rows, &Selection),
        feeling: Feeling<'_>,
        layout: Layout,
        stop: StopToken<'_>,
    ) -> Result<Self, Error> {
        let (axles, steps) = (path.behind.len(), path.steps);
        let constant = matches!(feeling, Feeling::Nothing);
        let drive = constant.then(|| Drive::new(shapes, path.advance));
        let laid_out = layout != Layout::Bare;
        let resultant = match (&drive, layout) {
            (Some(drive), Layout::Together(loads)) => Some(Resultant::new(loads, &path, drive, stop)?),
            _ => None,
        };
        let together = resultant.is_some();
        let (kept, felt) = (if together { 0 } else { axles }, if constant { 0 } else { axles });
        let kinds = if matches!(feeling, Feeling::Below(_, true)) { 3 } else { 1 };
        let mut table = Table {
            modes: shapes.modes(),
            places: Vec::with_capacity((steps + path.beyond + 1) * kept),
            below: Vec::with_capacity((steps + path.beyond + 1) * felt),
            grounds: Vec::new(),
            shapes: Vec::with_capacity((steps + path.beyond + 1) * felt * shapes.modes() * kinds),
            kinds,
            first: steps,
            stops: Vec::new(),
            drive,
            resultant,
            laid_out,
            statics: Vec::new(),
            passing_influences: Vec::new(),
            ready: None,
            path,
        };
        let mut places = vec![None; axles];
        for step in 0..=steps + table.path.beyond {
            for (axle, place) in places.iter_mut().enumerate() {
                let x = table.path.x(step, axle);
                *place = rows.place(x);
                if let Feeling::Below(ground, _) = feeling {
                    table.below.push(ground.below(x));
                    shapes.extend_at(x, kinds, &mut table.shapes);
                }
                if place.is_some() {
                    table.first = table.first.min(step);
                }
            }
            match &table.resultant {
                Some(resultant) if step <= steps => resultant.extend_static(&places, rows, &mut table.statics),
                Some(_) => {}
                None => {
                    table.places.extend_from_slice(&places);
                    if laid_out && step <= steps {
                        places.iter().for_each(|place| rows.extend_static(*place, &mut table.statics));
                    }
                }
            }
            stop.check()?;
        }
        if matches!(feeling, Feeling::Below(ground, false) if ground.own.is_some()) {
            table.grounds = table.below.iter().map(Ground::of).collect();
        }
        let marks: Vec<f64> = look.marks.iter().map(|mark| mark.x).collect();
        table.stops = passings(&table.path, &marks).iter().flat_map(|passing| passing.stops(look, true)).collect();
        if !laid_out {
            return Ok(table);
        }
        let mut each = PassingInfluence::default();
        for place in &mut table.stops {
            each.fill(place, &table.path, rows, look);
            table.passing_influences.push(match &table.resultant {
                None => each.clone(),
                Some(resultant) => {
                    *place = resultant.stop(place.clone());
                    resultant.passing(&each, rows.width())
                }
            });
            stop.check()?;
        }
        let all = look.rows.len() * table.loads() * (steps + 1 - table.first);
        if all <= READY {
            let mut ready = Vec::with_capacity((steps + 1 - table.first).div_ceil(CHUNK));
            for from in (table.first..=steps).step_by(CHUNK) {
                let mut chunk = Chunk::default();
                table.fill(from, rows, look, &mut chunk);
                ready.push(chunk);
                stop.check()?;
            }
            table.ready = Some(ready);
        }
        Ok(table)
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

    /// Number of loads on the bridge: of axles, or one of all together.
    pub fn loads(&self) -> usize {
        if self.resultant.is_some() { 1 } else { self.axles() }
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
        let loads = self.loads();
        let to = (from + CHUNK).min(self.path.steps + 1);
        let count = to - from;
        chunk.middles.clear();
        chunk.bounds.clear();
        chunk.parts.clear();
        match &self.resultant {
            Some(resultant) => resultant.influence(&self.path, from..to, rows, look, &mut chunk.influence),
            None => {
                chunk.influence.clear();
                for row in &look.rows {
                    let influence = |place: &Place| place.map_or(0.0, |place| rows.influence_of(row.response, place));
                    chunk.influence.extend(self.places(from..to).iter().map(influence));
                }
            }
        }
        for own in chunk.influence.chunks_exact(count * loads) {
            let bounds = |load: usize, steps: Range<usize>| {
                let numbers = steps.map(|step| own[step * loads + load]);
                numbers.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], g| [low.min(g), high.max(g)])
            };
            chunk.middles.extend_from_slice(&own[middle(count) * loads..][..loads]);
            chunk.bounds.extend((0..loads).map(|load| bounds(load, 0..count)));
            for part in 0..PARTS {
                let steps = (part * PART).min(count)..((part + 1) * PART).min(count);
                chunk.parts.extend((0..loads).map(|load| bounds(load, steps.clone())));
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
        let width = self.loads() * rows.width();
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
