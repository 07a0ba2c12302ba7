//! What all samples share that move alike: where the axles are at every step, what lies under them, what it does.

use crate::influence::{Quantity, Responses};
use crate::path::ModeShapes;
use crate::recovery::{Place, Rows};
use crate::road::spline::Taps;
use crate::step::Surface;

/// Steps that are recovered together, so that what they need stays near the processor.
pub const CHUNK: usize = 64;

/// One step of one axle.
#[derive(Debug, Clone, Copy)]
pub struct Stand {
    /// Position along the bridge [m].
    pub x: f64,
    /// What lies below it.
    pub below: Below,
}

/// The road below an axle.
#[derive(Debug, Clone, Copy)]
pub enum Below {
    /// The same for every sample.
    Given(Surface<f64>),
    /// The sample's own: which coefficients count, and how far it has faded in, with the first derivative of that.
    Own(Taps, [f64; 2]),
}

/// A moment between two steps at which extremes must be looked for: an axle on a section or on an end of the bridge.
#[derive(Debug, Clone)]
pub struct Stop {
    /// The step at whose end it has been passed.
    pub step: usize,
    /// How far through that step.
    pub fraction: f64,
    /// The axle that passes.
    pub axle: usize,
    /// If the load of that axle and the modal accelerations jump, the step whose they are.
    pub jump: Option<usize>,
    /// Responses to look at, with their influence of each axle.
    pub responses: Vec<(usize, Vec<f64>)>,
    /// The shear just inside an end on which the axle stands, and the sign with which the axle adds to it.
    pub tip: Option<(usize, f64)>,
    /// Position of the front axle [m].
    pub position: f64,
}

/// The shared geometry.
#[derive(Debug, Clone)]
pub struct Table {
    /// Number of axles.
    pub axles: usize,
    /// Number of modes.
    pub modes: usize,
    /// Number of steps.
    pub steps: usize,
    /// By step and axle.
    pub stands: Vec<Stand>,
    /// Φ⁰ and, if the step asks for them, its first two derivatives, by step, axle and mode.
    pub shapes: Vec<f64>,
    /// Derivatives held, the value included.
    pub kinds: usize,
    /// First step with an axle on the bridge, which is at rest till then.
    pub first: usize,
    /// Influence of each axle load on each response: by chunk of steps from `first` on, response, step and axle.
    pub influence: Vec<Vec<f64>>,
    /// Moments between steps, in order.
    pub stops: Vec<Stop>,
}

impl Table {
    /// For the axles at `x(step, axle)` [m] in `steps` steps, on a bridge of which `rows` are looked at.
    #[allow(clippy::too_many_arguments)] // each is one thing
    pub fn new(
        shapes: &ModeShapes,
        rows: &Rows,
        responses: &Responses,
        axles: usize,
        steps: usize,
        x: impl Fn(usize, usize) -> f64,
        slopes: bool,
        below: impl Fn(f64) -> Below,
    ) -> Self {
        let kinds = if slopes { 3 } else { 1 };
        let modes = shapes.modes();
        let mut table = Table {
            axles,
            modes,
            steps,
            stands: Vec::with_capacity((steps + 1) * axles),
            shapes: Vec::with_capacity((steps + 1) * axles * modes * kinds),
            kinds,
            first: steps,
            influence: Vec::new(),
            stops: Vec::new(),
        };
        for step in 0..=steps {
            for axle in 0..axles {
                let x = x(step, axle);
                table.stands.push(Stand { x, below: below(x) });
                shapes.extend_at(x, kinds, &mut table.shapes);
                if rows.place(x).is_some() {
                    table.first = table.first.min(step);
                }
            }
        }
        let all = rows.len();
        for from in (table.first..=steps).step_by(CHUNK) {
            let count = CHUNK.min(steps + 1 - from);
            let mut chunk = vec![0.0; all * count * axles];
            for step in 0..count {
                for axle in 0..axles {
                    if let Some(place) = rows.place(table.stands[(from + step) * axles + axle].x) {
                        for r in 0..all {
                            chunk[(r * count + step) * axles + axle] = rows.influence_of(r, place);
                        }
                    }
                }
            }
            table.influence.push(chunk);
        }
        table.find_stops(rows, responses);
        table
    }

    /// Position of an axle at a step [m].
    pub fn x(&self, step: usize, axle: usize) -> f64 {
        self.stands[step * self.axles + axle].x
    }

    /// Every passing of a section or an end, as [`crate::survey`] looks for them.
    fn find_stops(&mut self, rows: &Rows, responses: &Responses) {
        let (nodes, last) = (rows.mesh().nodes(), rows.mesh().panels());
        let inner = responses.sections().iter().enumerate().filter(|&(_, &node)| node != 0 && node != last);
        let mut places: Vec<(usize, f64, Option<usize>)> =
            inner.map(|(section, &node)| (node, nodes[node], Some(section))).collect();
        places.extend([(0, nodes[0], None), (last, nodes[last], None)]);
        places.sort_unstable_by_key(|place| place.0);
        let shear = |quantity: Quantity, node: usize, sign: f64| {
            let section = responses.sections().iter().position(|&s| s == node);
            section.map(|s| (responses.range(quantity).start + s, sign))
        };
        let tips = [shear(Quantity::ShearRight, 0, -1.0), shear(Quantity::ShearLeft, last, 1.0)];
        let sections = responses.sections().len();
        let mut stops = Vec::new();
        let mut ahead: Vec<usize> =
            (0..self.axles).map(|axle| places.partition_point(|place| place.1 <= self.x(0, axle))).collect();
        for step in 1..=self.steps {
            for axle in 0..self.axles {
                while let Some(&(node, at, section)) =
                    places.get(ahead[axle]).filter(|place| place.1 <= self.x(step, axle))
                {
                    ahead[axle] += 1;
                    let (from, to) = (self.x(step - 1, axle), self.x(step, axle));
                    let fraction = (at - from) / (to - from);
                    let between = |k: usize| {
                        let (b, a) = (self.x(step - 1, k), self.x(step, k));
                        b + fraction * (a - b)
                    };
                    let mut standing: Vec<Place> = (0..self.axles).map(|k| rows.place(between(k))).collect();
                    let left = node.checked_sub(1).map(|panel| (panel, 1.0));
                    let right = (node < last).then_some((node, 0.0));
                    let held = node != 0 && node != last || responses.supported(node);
                    for (side, row) in [(left, step - 1), (right, step)] {
                        standing[axle] = side;
                        let asked: Vec<usize> = match section {
                            Some(s) => (0..4).map(|quantity| quantity * sections + s).collect(),
                            None => (0..rows.len()).collect(),
                        };
                        let mut found: Vec<(usize, Vec<f64>)> =
                            asked.into_iter().map(|r| (r, vec![0.0; self.axles])).collect();
                        for (k, place) in standing.iter().enumerate() {
                            if let Some(place) = *place {
                                for (r, influence) in &mut found {
                                    influence[k] = rows.influence_of(*r, place);
                                }
                            }
                        }
                        let tip = match (node, section, side) {
                            (_, None, Some(_)) => tips[usize::from(node != 0)],
                            _ => None,
                        };
                        stops.push(Stop {
                            step,
                            fraction,
                            axle,
                            jump: (!held).then_some(row),
                            responses: found,
                            tip,
                            position: between(0),
                        });
                    }
                }
            }
        }
        self.stops = stops;
    }
}
