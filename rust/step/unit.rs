//! A vehicle's part in the step: its matrices, its contacts among all, and what moves it.

use std::ops::Range;

use super::newmark::Newmark;
use super::sizes::Form;
use super::stand::Stand;
use super::vehicle_step::VehicleSolve;
use crate::coordinate::Coordinate;
use crate::lane::Lane;
use crate::lane::gather::{Gather, gather};
use crate::vehicle::equations::Assembly;

/// What moves a vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Propulsion {
    /// Its motion is prescribed.
    Prescribed,
    /// It rolls freely, traction and resistance in balance on the level, but for its brakes.
    Rolling,
}

/// A vehicle to be stepped.
#[derive(Debug, Clone, Copy)]
pub struct Moving<'a> {
    /// Its matrices and contacts.
    pub assembly: &'a Assembly,
    /// What moves it.
    pub propulsion: Propulsion,
    /// +1 if it travels to the right, −1 to the left.
    pub direction: f64,
    /// How much the line that elevations are counted from rises on its way [-]: it slows what rolls freely.
    pub grade: f64,
}

/// A vehicle's part in the step.
#[derive(Debug, Clone)]
pub struct Unit<L> {
    pub rig: VehicleSolve<L>,
    pub propulsion: Propulsion,
    pub direction: L,
    pub contacts: Range<usize>,
    /// Indices among the unknown forces.
    pub rubbing: Range<usize>,
    pub coordinates: Range<usize>,
    /// Contacts ahead of the centre of mass [m].
    pub positions: Vec<L>,
    /// Mass that rests on each contact [kg].
    pub shares: Vec<L>,
    /// Acceleration by its weight down the grade, in its direction [m/s²]; zero where its motion is prescribed from the
    /// start.
    pub pull: L,
    /// How it stands still, where a step takes no time.
    pub stand: Option<Stand<L>>,
}

gather!(Unit { rig, propulsion, direction, contacts, rubbing, coordinates, positions, shares, pull, stand });

impl<L: Lane> Gather<L> for Propulsion {
    type Lanes = Propulsion;

    fn gather<'a>(each: impl Fn(usize) -> &'a Propulsion) -> Propulsion {
        *each(0)
    }

    fn ways(&self, ways: &mut Vec<bool>) {
        ways.push(*self == Propulsion::Rolling);
    }
}

impl<L: Lane> Unit<L> {
    /// Contacts, friction elements and coordinates among those of all vehicles, in a step of this form.
    #[inline(always)]
    pub fn parts(&self, form: Form) -> [Range<usize>; 3] {
        match form.vehicles {
            1 => [0..form.contacts(), form.contacts()..form.all(), 0..form.coordinates],
            _ => [self.contacts.clone(), self.rubbing.clone(), self.coordinates.clone()],
        }
    }

    /// Works out the step without element forces, under the forces along the road at the contacts of all vehicles [N].
    #[inline(always)]
    pub fn surge(&mut self, newmark: &Newmark<L>, bodies: &[Coordinate<L>], along: &[L]) {
        self.rig.surge(newmark, &bodies[self.coordinates.clone()], &along[self.contacts.clone()]);
    }

    /// Global number of an element of this vehicle.
    #[inline(always)]
    pub fn element(&self, own: usize) -> usize {
        if own < self.contacts.len() {
            self.contacts.start + own
        } else {
            self.rubbing.start + own - self.contacts.len()
        }
    }
}
