//! Stops: instants between two steps at which an axle stands on a section or on an end of the bridge.
//!
//! A moment peaks, and a shear jumps, as an axle passes the section, and where the bridge has a free end every response
//! jumps as an axle enters or leaves. These instants are part of the extremes, from the interpolated state and on both
//! sides, so that the extremes converge with the square of the step. At a free end the axle load itself jumps, as the
//! wheel drops on or off the deflected tip; there they converge with the step.

use crate::recovery::{Place, Rows};
use crate::selection::{Mark, Selection};
use crate::tape::write_at_rest;

/// Where axles are at the ends of steps.
pub trait Positions {
    /// How many there are.
    fn axles(&self) -> usize;

    /// Position of an axle after so many steps [m].
    fn x(&self, step: usize, axle: usize) -> f64;

    /// Position of an axle a fraction of the way through a step [m].
    fn between(&self, step: usize, fraction: f64, axle: usize) -> f64 {
        let (before, after) = (self.x(step - 1, axle), self.x(step, axle));
        before + fraction * (after - before)
    }
}

/// An axle passing one of the marks of a bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passing {
    /// The step at whose end it has been passed.
    pub step: usize,
    /// The axle.
    pub axle: usize,
    /// Which of the marks.
    pub mark: usize,
    /// How far through that step.
    pub fraction: f64,
    /// Position of the front axle [m].
    pub position: f64,
}

impl Passing {
    /// In a step, past a mark `at` [m].
    #[inline]
    pub fn new(positions: &impl Positions, step: usize, axle: usize, (mark, at): (usize, f64)) -> Self {
        let (from, to) = (positions.x(step - 1, axle), positions.x(step, axle));
        let fraction = ((at - from) / (to - from)).min(1.0);
        Passing { step, axle, mark, fraction, position: positions.between(step, fraction, 0) }
    }

    /// Its stops: as the axle comes, and as it goes, to the right or to the left.
    pub fn stops(&self, look: &Selection, to_the_right: bool) -> [Stop; SIDES] {
        let Passing { step, axle, fraction, position, .. } = *self;
        let Mark { sides: [left, right], held, asked, tip, .. } = look.marks[self.mark];
        let [before, after] = if to_the_right { [left, right] } else { [right, left] };
        [(before, step - 1), (after, step)].map(|(side, row)| Stop {
            step,
            fraction,
            axle,
            side,
            jump: (!held).then_some(row),
            asked,
            tip: tip.filter(|_| side.is_some()),
            position,
        })
    }
}

/// By how much rounding may leave an axle short of a mark that it has come to [m].
pub fn short_of(positions: &impl Positions, axle: usize, at: f64) -> f64 {
    1e-12 * (at - positions.x(0, axle)).abs()
}

/// Stops of a passing.
pub const SIDES: usize = 2;

/// An instant between two steps at which extremes are looked for.
#[derive(Debug, Clone)]
pub struct Stop {
    /// The step at whose end it has been passed.
    pub step: usize,
    /// How far through that step.
    pub fraction: f64,
    /// The axle that passes.
    pub axle: usize,
    /// Where it stands.
    pub side: Place,
    /// At a free end, the step from which the axle's load and Ä are taken, not interpolated.
    pub jump: Option<usize>,
    /// Which of [`Selection::asked`] to look at.
    pub asked: usize,
    /// The row of the shear just inside an end on which the axle stands, and the sign with which the axle adds to it.
    pub tip: Option<(usize, f64)>,
    /// Position of the front axle [m].
    pub position: f64,
}

impl Stop {
    /// Where all axles stand then.
    pub fn places(&self, positions: &impl Positions, rows: &Rows, places: &mut Vec<Place>) {
        places.clear();
        places.extend((0..positions.axles()).map(|axle| match axle == self.axle {
            true => self.side,
            false => rows.place(positions.between(self.step, self.fraction, axle)),
        }));
    }

    /// When, in steps of h [s].
    pub fn when(&self, h: f64) -> f64 {
        Stop::between(self.fraction, [(self.step - 1) as f64 * h, self.step as f64 * h])
    }

    /// When that is so far through a step that begins and ends at these times [s].
    pub fn between(fraction: f64, [before, after]: [f64; 2]) -> f64 {
        before + fraction * (after - before)
    }
}

/// What the axles do to the bridge at a stop.
#[derive(Debug, Clone, Default)]
pub struct PassingInfluence {
    /// Influence of each axle on the rows asked for, row by row.
    pub influence: Vec<f64>,
    /// What static loads of one at the axles make of the coordinates, axle by axle.
    pub statics: Vec<f64>,
    places: Vec<Place>,
}

impl PassingInfluence {
    /// Works it out for a stop.
    pub fn fill(&mut self, stop: &Stop, positions: &impl Positions, rows: &Rows, look: &Selection) {
        let PassingInfluence { influence, statics, places } = self;
        stop.places(positions, rows, places);
        influence.clear();
        statics.clear();
        for &row in &look.asked[stop.asked] {
            rows.add_influences(look.rows[row].response, places, influence);
        }
        places.iter().for_each(|place| rows.extend_static(*place, statics));
    }

    /// The same of all axles as one, under these loads [N]; there are so many coordinates.
    pub fn under(&self, loads: &[f64], coordinates: usize) -> Self {
        let of_row = |row: &[f64]| row.iter().zip(loads).map(|(g, load)| g * load).reduce(|a, b| a + b);
        let influence = self.influence.chunks_exact(loads.len()).map(|row| of_row(row).unwrap_or(0.0)).collect();
        let mut statics = vec![0.0; coordinates + loads.len()];
        write_at_rest(&self.statics, loads, &mut statics);
        statics.truncate(coordinates);
        PassingInfluence { influence, statics, places: Vec::new() }
    }
}

/// Follows axles past the marks, step by step, however they move.
#[derive(Debug, Clone)]
pub struct PassingAxles {
    to_the_right: Vec<bool>,
    /// For every axle the number of marks it has passed.
    passed: Vec<usize>,
}

impl PassingAxles {
    /// From where axles start, each in its direction.
    pub fn new(positions: &impl Positions, to_the_right: Vec<bool>, marks: &[Mark]) -> Self {
        let passed = to_the_right.iter().enumerate().map(|(axle, &right)| match positions.x(0, axle) {
            x if right => marks.partition_point(|mark| mark.x <= x),
            x => marks.len() - marks.partition_point(|mark| mark.x < x),
        });
        PassingAxles { passed: passed.collect(), to_the_right }
    }

    /// Whether every axle has passed every mark.
    pub fn is_past(&self, marks: &[Mark]) -> bool {
        self.passed.iter().all(|&count| count == marks.len())
    }

    /// The stops of a step, by axle and then in the order in which it passes. Of a path known in advance the same are found
    /// by search ([`crate::ensemble::table::passings`]), which a clock can afford for any number of marches.
    #[inline]
    pub fn stops(&mut self, positions: &impl Positions, step: usize, look: &Selection, stops: &mut Vec<Stop>) {
        let marks = &look.marks;
        for (axle, (passed, &right)) in self.passed.iter_mut().zip(&self.to_the_right).enumerate() {
            let to = positions.x(step, axle);
            while *passed < marks.len() {
                let mark = if right { *passed } else { marks.len() - 1 - *passed };
                let at = marks[mark].x;
                let short = short_of(positions, axle, at);
                if if right { at - short > to } else { at + short < to } {
                    break;
                }
                *passed += 1;
                stops.extend(Passing::new(positions, step, axle, (mark, at)).stops(look, right));
            }
        }
    }
}
