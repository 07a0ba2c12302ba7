//! A crossing of constant forces at constant speeds: where they are is prescribed, and what they do needs no solving.

use std::ops::Range;

use crate::coordinate::Coordinate;
use crate::crossing::time_loop::Contacts;
use crate::geometry::pavement::Ground;
use crate::geometry::{Geometry, Surface};
use crate::step::driving::{Drive, ModalForces};
use crate::step::forced::Forced;
use crate::step::rolling::Rolling;
use crate::step::stepper::{State, Stepper, Unsettled};
use crate::step::vibration::Vibration;

/// Constant forces on their way.
pub struct Forces<'a, M> {
    /// What lies under them, and how each moves along the bridge at a step.
    pub ground: Ground<'a>,
    /// See there.
    pub motion: M,
    /// Their sizes [N].
    pub loads: Vec<f64>,
    /// How the modes meet those of each vehicle, and follow.
    pub drives: Vec<(Range<usize>, Drive)>,
    /// See there.
    pub forced: Forced<f64>,
    /// The step.
    pub step: usize,
    /// What they do in it.
    pub driving: ModalForces<f64>,
}

impl<M: Fn(usize, usize) -> Coordinate<f64>> Forces<'_, M> {
    fn drive(&mut self) {
        let Forces { ground, drives, motion, loads, driving, step, .. } = self;
        driving.clear(ground.shapes.modes());
        for (axles, drive) in drives {
            drive.add(*step, |step, own| motion(step, axles.start + own).x, &loads[axles.clone()], driving);
        }
    }
}

impl<M: Fn(usize, usize) -> Coordinate<f64>> Geometry<f64> for Forces<'_, M> {
    fn advance(&mut self) {
        self.step += 1;
    }

    fn motion(&self, contact: usize) -> Coordinate<f64> {
        (self.motion)(self.step, contact)
    }

    fn shapes(&self, contact: usize, shapes: &mut [f64]) {
        let mut values = Vec::with_capacity(shapes.len());
        self.ground.shapes.extend_at(self.motion(contact).x, 1, &mut values);
        shapes.copy_from_slice(&values);
    }

    fn slope(&self, contact: usize, mode: usize) -> f64 {
        self.ground.shapes.rates_at(self.motion(contact).x, mode)[1]
    }

    fn curvature(&self, contact: usize, mode: usize) -> f64 {
        self.ground.shapes.rates_at(self.motion(contact).x, mode)[2]
    }

    fn surface(&self, contact: usize) -> Surface<f64> {
        self.ground.pavement(contact).map_or(Surface::LEVEL, |pavement| pavement.at(self.motion(contact).x))
    }
}

impl<M: Fn(usize, usize) -> Coordinate<f64>> Contacts for Forces<'_, M> {
    fn start(&mut self, _: &mut Rolling, _: &mut Stepper<f64>, speeds: &[f64]) -> Result<State<f64>, Unsettled> {
        self.drive();
        let modes = self.forced.start(&self.driving, |force| force);
        let travel = speeds.iter().map(|&v| Coordinate { x: 0.0, v, a: 0.0 }).collect();
        Ok(State { travel, ..State::of_loads(self.loads.len(), modes) })
    }

    fn step(&mut self, _: &mut Rolling, _: &mut Stepper<f64>, state: &mut State<f64>) -> Result<(), Unsettled> {
        self.advance();
        self.drive();
        self.forced.advance(&mut state.modes, &self.driving, |force| force);
        Ok(())
    }

    fn vibration(&self, _: &Stepper<f64>) -> Vibration<f64> {
        self.forced.vibration()
    }

    // They go on for ever.
    fn hold(&mut self, _: usize) {}
}
