//! The observer of one crossing: the extremes of every response, step after step, and whether anything can still follow.

use crate::crossing::envelope::{Envelope, Extreme, Extremes};
use crate::crossing::history::{History, TOGETHER};
use crate::crossing::tail::{FreeRows, Watch};
use crate::error::Error;
use crate::extremes::{Instant, PlacedSteps, Seen, at_stop, value};
use crate::recovery::{Place, Rows};
use crate::selection::Selection;
use crate::step::vibration::Reach;
use crate::stop_token::StopToken;
use crate::stops::{PassingAxles, PassingInfluence, Positions, Stop};
use crate::tape::{BridgeFactors, Widths, write_at_rest};

/// Extremes of the responses looked at, while a history grows.
pub struct Observer<'a> {
    rows: &'a Rows,
    look: &'a Selection,
    free: &'a FreeRows,
    /// The bridge, if it is varied.
    factors: Option<BridgeFactors<f64>>,
    axles: Option<PassingAxles>,
    stops: Vec<Stop>,
    /// Steps that have been looked at, the start among them.
    steps: usize,
    dynamic: Seen<f64>,
    /// Under the static axle loads at the same positions.
    at_rest: Seen<f64>,
    /// A row that could still grow when last asked, with what it had reached at so many steps.
    growing: Option<(usize, [f64; 2], usize)>,
    desk: Desk,
}

/// Room to work in.
#[derive(Default)]
struct Desk {
    /// Steps, dynamic and at rest.
    steps: PlacedSteps<2>,
    /// Where axles are at an instant.
    places: Vec<Place>,
    moment: PassingInfluence,
    /// What the rows multiply before and after a stop, and at an instant, dynamic and at rest.
    sides: [Vec<f64>; 2],
    then: Vec<f64>,
    then_at_rest: Vec<f64>,
    influence: Vec<f64>,
}

impl<'a> Observer<'a> {
    /// Of the responses that `look` names, by the rows of a bridge that may be varied by `factors`; `free` is the same
    /// without vehicles on the bridge.
    pub fn new(rows: &'a Rows, look: &'a Selection, free: &'a FreeRows, factors: Option<BridgeFactors<f64>>) -> Self {
        let nothing = Seen::beginning(look.rows.len(), false);
        Observer {
            rows,
            look,
            free,
            factors,
            axles: None,
            stops: Vec::new(),
            steps: 0,
            dynamic: nothing.clone(),
            at_rest: nothing,
            growing: None,
            desk: Desk::default(),
        }
    }

    /// Goes on to the last step that there is.
    fn go_on(&mut self, history: &History, stop: StopToken<'_>) -> Result<(), Error> {
        while self.steps < history.len() {
            let from = self.steps;
            self.steps = (from + TOGETHER).min(history.len());
            self.write(history, from);
            let seen = [&mut self.dynamic.steps[..], &mut self.at_rest.steps[..]];
            self.desk.steps.look(self.rows, self.look, seen);
            self.pass(history, from);
            stop.check()?;
        }
        Ok(())
    }

    /// What a step leaves for recovery.
    fn widths(&self, history: &History) -> Widths {
        Widths::of(self.rows, history.axles, 0)
    }

    /// Makes the steps from one on ready.
    fn write(&mut self, history: &History, from: usize) {
        let (widths, rows, factors, to) = (self.widths(history), self.rows, self.factors.as_ref(), self.steps);
        let Desk { steps, places, then, then_at_rest, .. } = &mut self.desk;
        steps.begin(from, history.axles);
        then.resize(widths.used(), 0.0);
        then_at_rest.resize(widths.used(), 0.0);
        for step in from..to {
            let PlacedSteps { coordinates, placed, .. } = &mut *steps;
            history.make_ready(step, rows, &widths, factors, (then, places), (coordinates, placed));
        }
    }

    /// Takes in every stop from a step on.
    fn pass(&mut self, history: &History, from: usize) {
        let widths = self.widths(history);
        let Observer { rows, look, factors, axles, stops, desk, .. } = self;
        let Desk { moment, sides, then, then_at_rest, .. } = desk;
        let axles = axles.get_or_insert_with(|| {
            let to_the_right = (0..history.axles).map(|axle| history.direction(axle) > 0.0).collect();
            PassingAxles::new(history, to_the_right, &look.marks)
        });
        let first = stops.len();
        for step in from.max(1)..self.steps {
            axles.stops(history, step, look, stops);
        }
        for (number, stop) in stops.iter().enumerate().skip(first) {
            moment.fill(stop, history, rows, look);
            history.write_at(stop, &widths, factors.as_ref(), sides, then);
            at_stop(&mut self.dynamic.stops, look, (stop, number, moment), then);
            write_at_rest(&moment.statics, &history.static_loads, then_at_rest);
            at_stop(&mut self.at_rest.stops, look, (stop, number, moment), then_at_rest);
        }
    }

    /// The envelope of the responses looked at, in their order, once the crossing is over.
    pub fn conclude(mut self, history: &History, stop: StopToken<'_>) -> Result<Envelope, Error> {
        self.go_on(history, stop)?;
        let mut envelope = [Vec::new(), Vec::new(), Vec::new(), Vec::new()];
        for row in 0..self.look.rows.len() {
            stop.check()?;
            let when = |instant| self.when(history, instant);
            let dynamic = self.dynamic.sides(row, 0, when).map(|found| (0, found));
            let at_rest = self.at_rest.sides(row, 0, when).map(|found| (1, found));
            for (all, (of, (value, instant))) in envelope.iter_mut().zip([dynamic, at_rest].concat()) {
                let position = match instant {
                    Instant::Step(step) => history.x(step, 0),
                    Instant::Stop(number) => self.stops[number].position,
                };
                let (time, partner) = (self.when(history, instant), self.partner(history, row, of, (value, instant)));
                all.push(Extreme { value, time, position, partner });
            }
        }
        let [max, min, max_at_rest, min_at_rest] =
            envelope.map(|of_rows| self.look.row_of.iter().map(|&row| of_rows[row]).collect());
        let (dynamic, at_rest) = (Extremes { max, min }, Extremes { max: max_at_rest, min: min_at_rest });
        Ok(Envelope { dynamic, at_rest })
    }

    fn when(&self, history: &History, instant: Instant) -> f64 {
        match instant {
            Instant::Step(step) => history.time[step],
            Instant::Stop(number) => {
                let Stop { step, fraction, .. } = self.stops[number];
                Stop::between(fraction, [history.time[step - 1], history.time[step]])
            }
        }
    }

    /// What the response is in the other state, at rest or dynamic, at an extreme in one of them.
    fn partner(&mut self, history: &History, row: usize, of: usize, (extreme, instant): (f64, Instant)) -> f64 {
        let widths = self.widths(history);
        let Observer { rows, look, stops, desk, factors, .. } = self;
        let Desk { places, sides, then, then_at_rest, influence, .. } = desk;
        let stop = match instant {
            Instant::Step(step) => {
                history.write(step, &widths, factors.as_ref(), then);
                history.places(step, rows, places);
                None
            }
            Instant::Stop(number) => {
                let stop = &stops[number];
                history.write_at(stop, &widths, factors.as_ref(), sides, then);
                stop.places(history, rows, places);
                Some(stop)
            }
        };
        then_at_rest.clear();
        then_at_rest
            .extend(rows.static_coordinates(places, &history.static_loads).chain(history.static_loads.iter().copied()));
        rows.influences(look.rows[row].response, places, influence);
        let states = [&then[..], &then_at_rest[..]];
        let [own, other] = [states[of], states[1 - of]];
        let of_state = |state: &[f64]| value(&look.rows[row].factors, influence, state, 0);
        match stop.and_then(|stop| stop.tip.map(|tip| (stop.axle, tip))) {
            // On the end itself, the axle adds to the shear just inside.
            Some((axle, (tip, sign))) if tip == row && of_state(own) + 0.0 != extreme => {
                of_state(other) + sign * other[widths.coordinates + axle]
            }
            _ => of_state(other),
        }
    }
}

impl Watch for Observer<'_> {
    fn enough(&mut self, history: &History, reach: &Reach<f64>, stop: StopToken<'_>) -> Result<bool, Error> {
        let free = self.free;
        let reach = BridgeFactors::reach(self.factors.as_ref(), reach.clone());
        let load: f64 = history.static_loads.iter().sum();
        // One row that can still grow is enough to go on, and little work to ask: all others can wait.
        if let (Some((row, [most, least], steps)), Some(axles)) = (self.growing, &self.axles)
            && axles.is_past(&self.look.marks)
        {
            let widths = self.widths(history);
            let Desk { then, places, influence, .. } = &mut self.desk;
            let (rows, look) = (self.rows, &self.look.rows[row]);
            let mut seen = [most, least];
            for step in steps..history.len() {
                history.write(step, &widths, self.factors.as_ref(), then);
                history.places(step, rows, places);
                rows.influences(look.response, places, influence);
                let value = value(&look.factors, influence, then, 0);
                seen = [seen[0].max(value), seen[1].min(value)];
            }
            self.growing = Some((row, seen, history.len()));
            if free.unsettled(row, &reach, load, seen) {
                return Ok(false);
            }
        }
        self.go_on(history, stop)?;
        let mut rows = 0..self.look.rows.len();
        let growing = rows.find(|&row| free.unsettled(row, &reach, load, self.dynamic.reached(row)));
        self.growing = growing.map(|row| (row, self.dynamic.reached(row), self.steps));
        Ok(growing.is_none())
    }
}
