//! Motion of a single crossing in which vehicles roll freely: contacts go where these, or prescribed motion, have them.

use super::pavement::Ground;
use super::{Follow, Geometry, Surface};
use crate::coordinate::Coordinate;

/// Change of an axle's position, relative to the length of the bridge, at which it counts as placed. The guess from the last
/// accelerations is off by the cube of the step, so that this takes nothing from the order.
const PLACED: f64 = 1e-9;

/// The same where forces follow the speed of the axle too, which is off by the square of the step.
const PLACED_BY_RATES: f64 = 1e-11;

/// Free motion: each contact goes where its vehicle or prescribed motion has it, and everything is evaluated there.
#[derive(Debug, Clone)]
pub struct Free<'a, M> {
    ground: Ground<'a>,
    /// Prescribed motion of a contact along the bridge at a step, or none where it follows its vehicle.
    motion: M,
    step: usize,
    /// Whether a vehicle travels to the left.
    mirrored: Vec<bool>,
    /// Change of position [m] from the guess, or from pass to pass, at which an axle counts as placed.
    tolerance: f64,
    motions: Vec<Coordinate<f64>>,
    /// The panel of each contact, from its predicted position and held through the step, so that passes converge.
    panels: Vec<Option<usize>>,
    /// φ, φ' and φ'' by contact and mode.
    values: Vec<[f64; 3]>,
    surfaces: Vec<Surface<f64>>,
}

impl<'a, M: Fn(usize, usize) -> Option<Coordinate<f64>>> Free<'a, M> {
    /// With the contacts at `start`, in the direction of the bridge; `rates` tells whether forces follow rates too.
    pub fn new(ground: Ground<'a>, motion: M, mirrored: Vec<bool>, start: Vec<Coordinate<f64>>, rates: bool) -> Self {
        let (contacts, modes) = (start.len(), ground.shapes.modes());
        let mut path = Free {
            tolerance: if rates { PLACED_BY_RATES } else { PLACED } * ground.shapes.mesh().length(),
            ground,
            motion,
            step: 0,
            mirrored,
            motions: start.clone(),
            panels: vec![None; contacts],
            values: vec![[0.0; 3]; contacts * modes],
            surfaces: vec![Surface::LEVEL; contacts],
        };
        for (contact, motion) in start.into_iter().enumerate() {
            path.put(contact, motion, true);
        }
        path
    }

    fn put(&mut self, contact: usize, motion: Coordinate<f64>, new_step: bool) {
        let (shapes, x) = (self.ground.shapes, motion.x);
        if new_step {
            self.panels[contact] = shapes.mesh().panel_at(x);
        }
        self.motions[contact] = motion;
        if let Some(pavement) = self.ground.pavement(contact) {
            self.surfaces[contact] = pavement.at(x);
        }
        let values = &mut self.values[contact * shapes.modes()..(contact + 1) * shapes.modes()];
        match self.panels[contact] {
            Some(panel) => {
                let fraction = shapes.mesh().fraction(panel, x);
                for (m, value) in values.iter_mut().enumerate() {
                    *value = shapes.rates(panel, fraction, m);
                }
            }
            None => values.fill([0.0; 3]),
        }
    }
}

impl<M: Fn(usize, usize) -> Option<Coordinate<f64>>> Geometry<f64> for Free<'_, M> {
    fn advance(&mut self) {
        self.step += 1;
        for contact in 0..self.motions.len() {
            if let Some(motion) = (self.motion)(self.step, contact) {
                self.put(contact, motion, true);
            }
        }
    }

    fn motion(&self, contact: usize) -> Coordinate<f64> {
        self.motions[contact]
    }

    fn shapes(&self, contact: usize, shapes: &mut [f64]) {
        for (shape, value) in shapes.iter_mut().zip(&self.values[contact * self.ground.shapes.modes()..]) {
            *shape = value[0];
        }
    }

    fn slope(&self, contact: usize, mode: usize) -> f64 {
        self.values[contact * self.ground.shapes.modes() + mode][1]
    }

    fn curvature(&self, contact: usize, mode: usize) -> f64 {
        self.values[contact * self.ground.shapes.modes() + mode][2]
    }

    fn surface(&self, contact: usize) -> Surface<f64> {
        self.surfaces[contact]
    }
}

impl<M: Fn(usize, usize) -> Option<Coordinate<f64>>> Follow for Free<'_, M> {
    fn follow(&mut self, contact: usize, motion: Coordinate<f64>, new_step: bool) -> bool {
        let motion = match self.mirrored[self.ground.vehicle[contact]] {
            false => motion,
            true => Coordinate { x: self.ground.shapes.mesh().length() - motion.x, v: -motion.v, a: -motion.a },
        };
        let moving = new_step || (motion.x - self.motions[contact].x).abs() > self.tolerance;
        if moving {
            self.put(contact, motion, new_step);
        }
        moving
    }

    fn hold(&mut self, contact: usize) {
        let Coordinate { x, .. } = self.motions[contact];
        self.motions[contact] = Coordinate { x, v: 0.0, a: 0.0 };
    }
}
