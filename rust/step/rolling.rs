//! Vehicles that roll freely: where their axles are follows from the step itself, pass after pass.
//!
//! Only single crossings do so, hence numbers of one sample and not lanes.

use super::sizes::Desk;
use super::stepper::{State, Stepper, Unsettled};
use super::unit::{Propulsion, Unit};
use super::vehicle_step::VehicleSolve;
use crate::coordinate::Coordinate;
use crate::geometry::{Follow, Geometry};
use crate::lane::Lane;

/// Most passes in which axle positions and surge follow the corrected state; one or two are usual.
const PASSES: usize = 50;

/// How hard a vehicle brakes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brakes {
    /// Deceleration asked for, shared out among the wheels like their static loads [m/s²].
    pub demand: f64,
    /// Coefficient of friction between tyre and road: no wheel brakes with more than this times its load.
    pub adhesion: f64,
    /// How far the brakes are on, from 0 to 1.
    pub level: f64,
}

/// What freely rolling vehicles have besides the state of a crossing.
#[derive(Debug, Clone, Default)]
pub struct Rolling {
    /// Vehicle by vehicle.
    brakes: Vec<Option<Brakes>>,
    /// Forces along the road a step before, from which the next are guessed.
    before: Vec<f64>,
    /// Those of the next pass.
    along: Vec<f64>,
    /// Centres of mass at the end of the step if accelerations there were zero.
    travel: Vec<Coordinate<f64>>,
    /// A vehicle's coordinates at the end of the step, as it may be.
    guess: Vec<Coordinate<f64>>,
}

impl Rolling {
    /// Of so many vehicles.
    pub fn new(vehicles: usize) -> Self {
        Rolling { brakes: vec![None; vehicles], ..Rolling::default() }
    }

    /// Puts a vehicle's brakes on, or says how far they are.
    pub fn brake(&mut self, vehicle: usize, brakes: Brakes) {
        self.brakes[vehicle] = Some(brakes);
    }

    /// As [`Stepper::start`]: vehicles that roll are pushed along by the slope under them from the first instant.
    pub fn start(
        &mut self,
        starter: &mut Stepper<f64>,
        speeds: &[f64],
        geometry: &impl Geometry<f64>,
    ) -> Result<State<f64>, Unsettled> {
        let state = starter.start_surging(speeds, geometry, |starter, state, desk| {
            for u in 0..starter.units.len() {
                let unit = &starter.units[u];
                if unit.propulsion != Propulsion::Rolling {
                    continue;
                }
                let mut force = 0.0;
                for (own, contact) in unit.contacts.clone().enumerate() {
                    state.along[contact] = self.along(starter, u, own, state, geometry);
                    force += state.along[contact];
                }
                state.travel[u].a = force / unit.rig.total_mass + unit.pull;
                starter.units[u].surge(&starter.newmark, desk.bodies, &state.along);
            }
        })?;
        self.before.clone_from(&state.along);
        Ok(state)
    }

    /// Advances the state by one step, as [`Stepper::advance`] does where nothing rolls.
    #[inline(never)]
    pub fn advance(
        &mut self,
        stepper: &mut Stepper<f64>,
        state: &mut State<f64>,
        geometry: &mut impl Follow,
    ) -> Result<(), Unsettled> {
        if stepper.units.iter().all(|unit| unit.propulsion == Propulsion::Prescribed) {
            return stepper.advance(state, geometry);
        }
        let mut room = std::mem::take(&mut stepper.room);
        let rolled = self.roll(stepper, state, geometry, &mut room.desk());
        stepper.room = room;
        rolled
    }

    fn roll(
        &mut self,
        stepper: &mut Stepper<f64>,
        state: &mut State<f64>,
        geometry: &mut impl Follow,
        desk: &mut Desk<'_, f64>,
    ) -> Result<(), Unsettled> {
        let (form, newmark) = (stepper.form, stepper.newmark);
        stepper.predict(form, state, desk);
        geometry.advance();
        self.travel.clear();
        self.travel.extend(state.travel.iter().map(|travel| newmark.predict(*travel)));
        self.along.resize(state.along.len(), 0.0);
        let rolling = |unit: &Unit<f64>| unit.propulsion == Propulsion::Rolling;
        for (unit, travel) in stepper.units.iter().zip(&self.travel).filter(|(unit, _)| rolling(unit)) {
            self.guess.resize(unit.rig.size, Coordinate::rest());
            let (bodies, before) =
                (&desk.bodies[unit.coordinates.clone()], &state.coordinates[unit.coordinates.clone()]);
            VehicleSolve::guess(&newmark, bodies, before, &mut self.guess);
            let mut force = 0.0;
            for contact in unit.contacts.clone() {
                // Forces along the road go on from the last two steps.
                let now = state.along[contact];
                state.along[contact] = now + (now - self.before[contact]);
                self.before[contact] = now;
                force += state.along[contact];
            }
            let travel = newmark.correct(*travel, force / unit.rig.total_mass + unit.pull);
            place(unit, travel, &self.guess, geometry, true);
        }
        stepper.push_along(form, state, geometry, desk);
        for _ in 0..PASSES {
            stepper.react(form, state, geometry, None, desk)?;
            let mut moving = false;
            for (u, unit) in stepper.units.iter().enumerate().filter(|(_, unit)| rolling(unit)) {
                let (mut force, mut change) = (0.0, 0.0);
                for (own, contact) in unit.contacts.clone().enumerate() {
                    let next = self.along(stepper, u, own, state, geometry);
                    change += (next - state.along[contact]).abs();
                    force += next;
                    self.along[contact] = next;
                }
                state.travel[u] = newmark.correct(self.travel[u], force / unit.rig.total_mass + unit.pull);
                let coordinates = &state.coordinates[unit.coordinates.clone()];
                moving |= place(unit, state.travel[u], coordinates, geometry, false);
                // What is no number is not settled.
                let settled = change < stepper.surge_settled * unit.rig.total_mass;
                moving |= !settled;
            }
            if !moving {
                stepper.commit(form, state, desk);
                return Ok(());
            }
            for unit in stepper.units.iter_mut().filter(|unit| rolling(unit)) {
                state.along[unit.contacts.clone()].copy_from_slice(&self.along[unit.contacts.clone()]);
                unit.surge(&newmark, desk.bodies, &state.along);
            }
        }
        Err(Unsettled::AxlePositions)
    }

    /// Force along the road at a contact of a freely rolling vehicle, in the direction of travel: what pushes it down the
    /// slope of bridge and road, less its brakes.
    #[inline(always)]
    fn along(
        &self,
        stepper: &Stepper<f64>,
        vehicle: usize,
        own: usize,
        state: &State<f64>,
        geometry: &impl Geometry<f64>,
    ) -> f64 {
        let unit = &stepper.units[vehicle];
        let contact = unit.contacts.start + own;
        let modes = state.modes.iter().enumerate();
        let slope = modes.fold(0.0, |sum, (m, mode)| sum + geometry.slope(contact, m) * mode.x);
        let slope = slope - geometry.surface(contact).slope;
        let load = stepper.elements.contacts[contact].static_load + state.increments[contact];
        let downhill = unit.direction * load * slope;
        match self.brakes[vehicle] {
            None => downhill,
            Some(brakes) => {
                let asked = brakes.level * brakes.demand * unit.shares[own];
                downhill - asked.smaller(brakes.adhesion * load)
            }
        }
    }
}

/// Puts the contacts of a freely rolling vehicle where it has them; whether one had still to move.
#[inline(always)]
fn place(
    unit: &Unit<f64>,
    travel: Coordinate<f64>,
    coordinates: &[Coordinate<f64>],
    geometry: &mut impl Follow,
    new_step: bool,
) -> bool {
    let mut moving = false;
    for (own, contact) in unit.contacts.clone().enumerate() {
        let along = unit.rig.along(own, coordinates);
        let x = travel.x + unit.positions[own] + along.x;
        let motion = Coordinate { x, v: travel.v + along.v, a: travel.a + along.a };
        moving |= geometry.follow(contact, motion, new_step);
    }
    moving
}
