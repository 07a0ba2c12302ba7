//! Prescribed motion of a single crossing: where the contacts are is known beforehand, and laid out some steps at a
//! time.

use super::pavement::Ground;
use super::{Geometry, Surface};
use crate::coordinate::Coordinate;

/// Steps of prescribed motion that are laid out at a time, so that a crossing can be ended between them.
const LAID: usize = 64;

/// Prescribed motion: known beforehand, and laid out some steps at a time.
#[derive(Debug, Clone)]
pub struct Prescribed<'a, M> {
    ground: Ground<'a>,
    /// Motion along the bridge of a contact at a step.
    motion: M,
    contacts: usize,
    step: usize,
    /// Motion along the bridge by step and contact.
    motions: Vec<Coordinate<f64>>,
    /// How many derivatives the table holds, the value included: one or three.
    kinds: usize,
    /// Φ⁰ and its derivatives by step, contact and mode.
    table: Vec<f64>,
    surfaces: Vec<Surface<f64>>,
}

impl<'a, M: Fn(usize, usize) -> Coordinate<f64>> Prescribed<'a, M> {
    /// With the contacts moving along the bridge as `motion` says at each step, of which there will be so many and perhaps a
    /// tail; with `slopes` and curvatures of the modes if the step asks for them.
    pub fn new(ground: Ground<'a>, motion: M, steps: usize, slopes: bool) -> Self {
        let kinds = if slopes { 3 } else { 1 };
        let (shapes, contacts) = (ground.shapes, ground.vehicle.len());
        let mut motions = Vec::new();
        motions.reserve_exact((steps + 2) * contacts);
        let mut table = Vec::new();
        table.reserve_exact((steps + 2) * contacts * shapes.modes() * kinds);
        let surfaces = vec![Surface::LEVEL; contacts];
        let mut path = Prescribed { ground, motion, contacts, step: 0, motions, kinds, table, surfaces };
        path.lay(2);
        path.look_down();
        path
    }

    /// Lays the table out for so many more steps.
    fn lay(&mut self, steps: usize) {
        let from = self.motions.len() / self.contacts;
        for step in from..from + steps {
            for contact in 0..self.contacts {
                let motion = (self.motion)(step, contact);
                self.motions.push(motion);
                self.ground.shapes.extend_at(motion.x, self.kinds, &mut self.table);
            }
        }
    }

    fn here(&self) -> &[Coordinate<f64>] {
        &self.motions[self.step * self.contacts..(self.step + 1) * self.contacts]
    }

    fn look_down(&mut self) {
        let here = &self.motions[self.step * self.contacts..];
        for (contact, (surface, motion)) in self.surfaces.iter_mut().zip(here).enumerate() {
            if let Some(pavement) = self.ground.pavement(contact) {
                *surface = pavement.at(motion.x);
            }
        }
    }

    fn entry(&self, contact: usize, mode: usize) -> usize {
        ((self.step * self.contacts + contact) * self.ground.shapes.modes() + mode) * self.kinds
    }
}

impl<M: Fn(usize, usize) -> Coordinate<f64>> Geometry<f64> for Prescribed<'_, M> {
    fn advance(&mut self) {
        self.step += 1;
        // One more than where they are, for the look ahead.
        if self.motions.len() < (self.step + 2) * self.contacts {
            self.lay(LAID);
        }
        self.look_down();
    }

    fn steady(&self) -> bool {
        let next = &self.motions[(self.step + 1) * self.contacts..];
        next.iter().take(self.contacts).all(|motion| motion.a == 0.0)
    }

    fn motion(&self, contact: usize) -> Coordinate<f64> {
        self.here()[contact]
    }

    fn shapes(&self, contact: usize, shapes: &mut [f64]) {
        let table = self.table[self.entry(contact, 0)..].iter().step_by(self.kinds);
        for (shape, &value) in shapes.iter_mut().zip(table) {
            *shape = value;
        }
    }

    fn slope(&self, contact: usize, mode: usize) -> f64 {
        self.table[self.entry(contact, mode) + 1]
    }

    fn curvature(&self, contact: usize, mode: usize) -> f64 {
        self.table[self.entry(contact, mode) + 2]
    }

    fn surface(&self, contact: usize) -> Surface<f64> {
        self.surfaces[contact]
    }
}
