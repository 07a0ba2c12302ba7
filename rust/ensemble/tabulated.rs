//! The shared table as the step sees it: contacts of a group of lanes, with their own roads and speeds.

use std::sync::OnceLock;

use super::table::{Below, Table};
use crate::coordinate::Coordinate;
use crate::geometry::pavement::Share;
use crate::geometry::{Geometry, Surface};
use crate::lane::Lane;
use crate::road::b_spline::weighted;
use crate::step::gait::{DAMPERS, SPRINGS, Standing, of_mode};
use crate::step::stepper::Stepper;
use crate::step::swift::Under;
use crate::stops::Positions;

/// Most numbers that [`Interactions`] keep; beyond that they are worked out in every step.
pub const MOST_INTERACTIONS: usize = 1 << 21;

/// What the steps of samples that are alike need to know about the places of the axles on the bridge: by rows of a table,
/// from the first with an axle on it.
#[derive(Debug, Clone, Default)]
pub struct Interactions {
    width: usize,
    numbers: Vec<f64>,
}

impl Interactions {
    /// Of samples with this speed [m/s], as their step works it out; none if that is too much.
    pub fn new(table: &Table, stepper: &mut Stepper<f64>, speed: f64) -> Self {
        let road = [0.0];
        let mut geometry = Tabulated::new(table, &road, speed, None);
        let mut interactions = Interactions::default();
        let (modes, contacts, law) = (table.modes, table.axles(), stepper.gait().map(|gait| gait.law));
        let each = of_mode(contacts, if law == Some(Standing::Dampers) { DAMPERS } else { SPRINGS });
        for row in table.first..=table.last() {
            geometry.row = row;
            geometry.step = row;
            let interaction = stepper.interaction(&geometry);
            let (of_modes, of_elements) = interaction.split_at(3 * modes * contacts);
            interactions.width = modes * each + of_elements.len();
            if interactions.width * (table.last() + 1 - table.first) > MOST_INTERACTIONS {
                return Interactions::default();
            }
            for m in 0..modes {
                interactions.numbers.extend((0..3 * contacts).map(|part| of_modes[part * modes + m]));
                if law == Some(Standing::Dampers) {
                    interactions.numbers.extend((0..contacts).map(|contact| speed * geometry.slope(contact, m)));
                }
            }
            interactions.numbers.extend_from_slice(of_elements);
        }
        interactions
    }
}

/// What the samples of a march share.
#[derive(Debug)]
pub struct Shared {
    /// The geometry.
    pub table: Table,
    /// What their steps have in common if they are alike, for whichever worker comes first to work out.
    pub interactions: OnceLock<Interactions>,
}

impl Shared {
    /// With nothing worked out yet.
    pub fn new(table: Table) -> Self {
        Shared { table, interactions: OnceLock::new() }
    }
}

/// The shared table, with the roads and speeds of a group of samples.
#[derive(Debug, Clone)]
pub struct Tabulated<'a, L> {
    table: &'a Table,
    /// Coefficients of the samples' own roads.
    road: &'a [L],
    /// Their speeds [m/s].
    pub speed: L,
    /// Where all lanes are alike, how the axles feel the bridge, by row from the first with one on it.
    interactions: Option<&'a Interactions>,
    /// The step, and where the table has it.
    step: usize,
    row: usize,
    surfaces: Vec<Surface<L>>,
}

impl<'a, L: Lane> Tabulated<'a, L> {
    /// At the start.
    #[inline(always)]
    pub fn new(table: &'a Table, road: &'a [L], speed: L, interactions: Option<&'a Interactions>) -> Self {
        let zero = L::splat(0.0);
        let level = Surface { elevation: zero, slope: zero, curvature: zero };
        let surfaces = vec![level; table.axles()];
        let mut tabulated = Tabulated { table, road, speed, interactions, step: 0, row: 0, surfaces };
        tabulated.look_down();
        tabulated
    }

    #[inline(always)]
    fn look_down(&mut self) {
        let axles = self.table.axles();
        let below = &self.table.below[self.row * axles..(self.row + 1) * axles];
        for (surface, below) in self.surfaces.iter_mut().zip(below) {
            match below {
                Below::Given(s) => {
                    let (elevation, slope) = (L::splat(s.elevation), L::splat(s.slope));
                    *surface = Surface { elevation, slope, curvature: L::splat(s.curvature) };
                }
                Below::Own { given, taps, share } => {
                    let near = near(self.road, taps.first);
                    // Slope and curvature count only where the step asks for them.
                    let mut parts = [L::splat(0.0); 3];
                    for ((part, given), weights) in parts.iter_mut().zip(given).zip(taps.weights).take(self.table.kinds)
                    {
                        *part = L::splat(*given) + weighted(weights, near);
                    }
                    *surface = share.of(parts);
                }
            }
        }
    }

    /// Goes to a step.
    #[inline(always)]
    pub fn go_to(&mut self, step: usize) {
        self.step = step;
        self.row = step.min(self.table.last());
        self.look_down();
    }

    /// What lies under the contacts at a step; slopes only if they are asked for.
    #[inline(always)]
    pub fn under<const K: usize>(&self, step: usize, slopes: bool) -> [Under<L>; K] {
        let row = step.min(self.table.last());
        let mut under = [Under { elevation: L::splat(0.0), slope: L::splat(0.0) }; K];
        if !slopes && let Some(grounds) = self.table.grounds.get(row * K..(row + 1) * K) {
            for (under, ground) in under.iter_mut().zip(grounds) {
                let own = weighted(ground.weights, near(self.road, ground.first));
                under.elevation = L::splat(ground.share) * (L::splat(ground.given) + own);
            }
            return under;
        }
        for (under, below) in under.iter_mut().zip(&self.table.below[row * K..][..K]) {
            *under = below.under(self.road, slopes);
        }
        under
    }

    /// How the contacts feel the bridge at a step, if that is known: see [`Geometry::interaction`].
    #[inline(always)]
    pub fn interaction_at(&self, step: usize) -> Option<&'a [f64]> {
        let Interactions { width, numbers } = self.interactions.filter(|interactions| interactions.width > 0)?;
        let row = step.min(self.table.last()).checked_sub(self.table.first)?;
        numbers.get(row * width..(row + 1) * width)
    }

    #[inline(always)]
    fn entry(&self, contact: usize) -> usize {
        (self.row * self.table.axles() + contact) * self.table.modes * self.table.kinds
    }
}

impl<L: Lane> Geometry<L> for Tabulated<'_, L> {
    #[inline(always)]
    fn advance(&mut self) {
        self.step += 1;
        self.row = self.step.min(self.table.last());
        self.look_down();
    }

    #[inline(always)]
    fn steady(&self) -> bool {
        true
    }

    #[inline(always)]
    fn motion(&self, contact: usize) -> Coordinate<L> {
        Coordinate { x: L::splat(self.table.path.x(self.step, contact)), v: self.speed, a: L::splat(0.0) }
    }

    #[inline(always)]
    fn shapes(&self, contact: usize, shapes: &mut [L]) {
        let table = self.table.shapes[self.entry(contact)..].iter().step_by(self.table.kinds);
        for (shape, &value) in shapes.iter_mut().zip(table) {
            *shape = L::splat(value);
        }
    }

    #[inline(always)]
    fn slope(&self, contact: usize, mode: usize) -> L {
        L::splat(self.table.shapes[self.entry(contact) + mode * self.table.kinds + 1])
    }

    #[inline(always)]
    fn curvature(&self, contact: usize, mode: usize) -> L {
        L::splat(self.table.shapes[self.entry(contact) + mode * self.table.kinds + 2])
    }

    #[inline(always)]
    fn surface(&self, contact: usize) -> Surface<L> {
        self.surfaces[contact]
    }

    #[inline(always)]
    fn interaction(&self) -> Option<&[f64]> {
        self.interaction_at(self.row)
    }
}

impl Below {
    /// The surface of a sample whose own road has these coefficients, but for curvature; slopes only if they are asked for.
    #[inline(always)]
    fn under<L: Lane>(&self, road: &[L], slopes: bool) -> Under<L> {
        let zero = L::splat(0.0);
        match self {
            Below::Given(s) => Under { elevation: L::splat(s.elevation), slope: L::splat(s.slope) },
            Below::Own { given, taps, share } => {
                let near = near(road, taps.first);
                let elevation = L::splat(given[0]) + weighted(taps.weights[0], near);
                let slope = if slopes { L::splat(given[1]) + weighted(taps.weights[1], near) } else { zero };
                match *share {
                    Share::Level => Under { elevation: zero, slope: zero },
                    Share::Whole => Under { elevation, slope },
                    Share::Beyond => Under { elevation, slope: zero },
                    Share::Faded([fade, fade_1, _]) => {
                        let (fade, fade_1) = (L::splat(fade), L::splat(fade_1));
                        let slope = if slopes { fade * slope + fade_1 * elevation } else { zero };
                        Under { elevation: fade * elevation, slope }
                    }
                }
            }
        }
    }
}

/// Four neighbouring coefficients of a road, from this number on.
#[inline(always)]
fn near<L: Lane>(road: &[L], first: usize) -> [L; 4] {
    let mask = road.len() - 1;
    let first = first & mask;
    match road.get(first..).unwrap_or_default() {
        [a, b, c, d, ..] => [*a, *b, *c, *d],
        _ => [0, 1, 2, 3].map(|k| road[(first + k) & mask]),
    }
}
