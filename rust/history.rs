//! The states of a crossing, one row per instant, column by column.

use crate::step::{Geometry, State};

/// States of a crossing, step after step. Arrays hold one row per instant.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct History {
    /// Number of axles.
    pub axles: usize,
    /// Number of included modes.
    pub modes: usize,
    /// Time step [s]; the last row may end a shorter one.
    pub step: f64,
    /// Static axle loads [N].
    pub static_loads: Vec<f64>,
    /// Time since the front axle was at the start of the approach [s].
    pub time: Vec<f64>,
    /// Axle positions from the left end of the bridge [m], row by row.
    pub positions: Vec<f64>,
    /// Axle loads [N], row by row.
    pub loads: Vec<f64>,
    /// Modal coordinates [m kg^½], row by row.
    pub a: Vec<f64>,
    /// Modal velocities [m kg^½/s], row by row.
    pub a_dot: Vec<f64>,
    /// Modal accelerations [m kg^½/s²], row by row.
    pub a_ddot: Vec<f64>,
    /// Heave, pitch and travel of the body with their first and second derivatives, row by row (nine numbers).
    pub body: Vec<f64>,
    /// Suspension shortenings since the static state [m], row by row.
    pub shortenings: Vec<f64>,
    /// Friction forces [N], row by row.
    pub friction: Vec<f64>,
}

impl History {
    /// Number of instants.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no instant (never so after a crossing).
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Speed of the centre of mass at the end [m/s].
    pub fn final_speed(&self) -> f64 {
        self.body.last_chunk::<9>().map_or(0.0, |row| row[7])
    }

    pub(crate) fn record(&mut self, time: f64, state: &State<f64>, geometry: &impl Geometry<f64>) {
        self.time.push(time);
        for (k, increment) in state.increments.iter().enumerate() {
            self.positions.push(geometry.position(k));
            self.loads.push(self.static_loads[k] + increment);
            self.shortenings.push(state.shortenings[k]);
            self.friction.push(state.friction[k]);
        }
        for mode in &state.modes {
            self.a.push(mode.x);
            self.a_dot.push(mode.v);
            self.a_ddot.push(mode.a);
        }
        for c in [state.heave, state.pitch, state.travel] {
            self.body.push(c.x);
            self.body.push(c.v);
            self.body.push(c.a);
        }
    }

    /// Makes room for this many instants.
    pub(crate) fn reserve(&mut self, instants: usize) {
        self.time.reserve_exact(instants);
        self.body.reserve_exact(9 * instants);
        for column in [&mut self.positions, &mut self.loads, &mut self.shortenings, &mut self.friction] {
            column.reserve_exact(self.axles * instants);
        }
        for column in [&mut self.a, &mut self.a_dot, &mut self.a_ddot] {
            column.reserve_exact(self.modes * instants);
        }
    }

    /// Cuts the last step short: its end becomes the state this fraction of the way through it.
    pub(crate) fn shorten_last(&mut self, fraction: f64) {
        let [m, k] = [self.modes, self.axles];
        let columns: [(&mut Vec<f64>, usize); 9] = [
            (&mut self.time, 1),
            (&mut self.positions, k),
            (&mut self.loads, k),
            (&mut self.a, m),
            (&mut self.a_dot, m),
            (&mut self.a_ddot, m),
            (&mut self.body, 9),
            (&mut self.shortenings, k),
            (&mut self.friction, k),
        ];
        for (column, width) in columns {
            let last = column.len() - width;
            let (before, after) = column.split_at_mut(last);
            for (b, a) in before[last - width..].iter().zip(after) {
                *a = b + fraction * (*a - b);
            }
        }
    }
}
