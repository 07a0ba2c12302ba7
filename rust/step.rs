//! One time step of bridge and vehicles together, written once for every kind of lane.
//!
//! Newmark's method with γ = ½ for the modal coordinates and the vehicles; everything at the same instant t_{n+1}. The
//! modes are coupled to the vehicles only through the contact forces, and bodies that rub on each other through friction,
//! so these are the unknowns: each follows δ_k = u_k − Σ S_kj p_j.

use std::ops::Range;

use crate::assembly::Assembly;
use crate::contact::{Contact, Elements, Prepared, Rubbing};
use crate::friction::Stroke;
use crate::lane::Lane;
use crate::modal::{ModalDamping, ModalSolve};
use crate::newmark::{Coordinate, Newmark};
use crate::rig::Rig;

/// Most passes in which axle positions and surge follow the corrected state; one or two are usual.
const PASSES: usize = 50;

/// Change of the surge [m/s²] from pass to pass at which it counts as found: it comes back to itself through the pitch of
/// the vehicles and the slope of the bridge, times β h², so what remains is some millionths of it.
const SURGE_SETTLED: f64 = 1e-5;

/// The same where forces follow rates too, which are off by the square of the step.
const SURGE_SETTLED_BY_RATES: f64 = 1e-8;

/// The road under a wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface<L> {
    /// Elevation, up [m].
    pub elevation: L,
    /// Its first derivative along the bridge [-].
    pub slope: L,
    /// Its second derivative [1/m].
    pub curvature: L,
}

impl Surface<f64> {
    /// Level road.
    pub const LEVEL: Self = Surface { elevation: 0.0, slope: 0.0, curvature: 0.0 };
}

/// Where the contacts stand and how they move: prescribed for all lanes alike, or following the vehicles.
pub trait Geometry<L: Lane> {
    /// Moves on by one step; contacts whose motion is prescribed go to where they are then.
    fn advance(&mut self);

    /// Puts a contact that follows its vehicle where that has it, in a new step or in another pass of the same; `motion`
    /// counts from the end of the bridge at which the vehicle enters, in its own direction. Says in which lanes it had
    /// still to move; in all others nothing changes, to the bit.
    fn follow(&mut self, contact: usize, motion: Coordinate<L>, new_step: bool) -> L::Mask;

    /// Position from the left end of the bridge, speed and acceleration along it.
    fn motion(&self, contact: usize) -> Coordinate<L>;

    /// Φ⁰: the modes' deflections under the contact [kg^-½], zero off the bridge.
    fn shapes(&self, contact: usize, shapes: &mut [L]);

    /// Slope of the mode under the contact [kg^-½/m].
    fn slope(&self, contact: usize, mode: usize) -> L;

    /// Second derivative of the mode under the contact [kg^-½/m²].
    fn curvature(&self, contact: usize, mode: usize) -> L;

    /// The road under the contact.
    fn surface(&self, contact: usize) -> Surface<L>;
}

/// The state of bridge and vehicles at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct State<L> {
    /// Modal coordinates A [m kg^½].
    pub modes: Vec<Coordinate<L>>,
    /// Coordinates of the vehicles from their static state, one vehicle after another [m, rad].
    pub coordinates: Vec<Coordinate<L>>,
    /// Centre of mass of each vehicle, from the end of the bridge at which it enters and in its own direction [m]. That
    /// of one whose motion is prescribed is left to the geometry.
    pub travel: Vec<Coordinate<L>>,
    /// Increments over their static values: contact forces, then forces of friction elements [N].
    pub increments: Vec<L>,
    /// Suspensions of the contacts, then friction elements.
    pub strokes: Vec<Stroke<L>>,
    /// Forces along the road at the contacts, in the direction of travel [N].
    pub along: Vec<L>,
    /// The same a step before, from which the next are guessed.
    pub along_before: Vec<L>,
}

/// How hard a vehicle brakes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brakes<L> {
    /// Deceleration asked for, shared out among the wheels like their static loads [m/s²].
    pub demand: L,
    /// Coefficient of friction between tyre and road: no wheel brakes with more than this times its load.
    pub adhesion: L,
    /// How far the brakes are on, from 0 to 1.
    pub level: L,
}

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
}

/// A vehicle's part in the step.
#[derive(Debug, Clone)]
struct Unit<L> {
    rig: Rig<L>,
    propulsion: Propulsion,
    direction: f64,
    contacts: Range<usize>,
    /// Indices among the unknown forces.
    rubbing: Range<usize>,
    coordinates: Range<usize>,
    /// Contacts ahead of the centre of mass [m].
    positions: Vec<L>,
    /// Mass that rests on each contact [kg].
    shares: Vec<L>,
    brakes: Option<Brakes<L>>,
}

impl<L: Lane> Unit<L> {
    /// Global number of an element of this vehicle.
    #[inline(always)]
    fn element(&self, own: usize) -> usize {
        if own < self.contacts.len() {
            self.contacts.start + own
        } else {
            self.rubbing.start + own - self.contacts.len()
        }
    }
}

/// Settings that all vehicles share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scheme {
    /// Step [s].
    pub h: f64,
    /// Newmark's β [-].
    pub beta: f64,
    /// Gravity [m/s²].
    pub gravity: f64,
    /// Whether wheels leave the road rather than pull.
    pub lift_off: bool,
}

/// Why a step failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unsettled {
    /// The coupled contact forces.
    ContactForces,
    /// The positions of the axles.
    AxlePositions,
}

impl Unsettled {
    /// What did not settle, in words.
    pub fn name(self) -> &'static str {
        match self {
            Unsettled::ContactForces => "contact forces",
            Unsettled::AxlePositions => "axle positions",
        }
    }
}

/// The time step: constant coefficients of a run, and scratch so that stepping allocates nothing.
#[derive(Debug, Clone)]
pub struct Stepper<L> {
    newmark: Newmark<L>,
    omega2: Vec<L>,
    modal: ModalSolve<L>,
    units: Vec<Unit<L>>,
    elements: Elements<L>,
    predicted: Vec<Coordinate<L>>,
    travel: Vec<Coordinate<L>>,
    guess: Vec<Coordinate<L>>,
    surge_settled: L,
    along: Vec<L>,
    /// Modal accelerations without axle loads, and under the static ones.
    free: Vec<L>,
    loaded: Vec<L>,
    /// Φ⁰, contact by contact.
    shapes: Vec<L>,
    /// What unit modal accelerations do to δ, contact by contact.
    senses: Vec<L>,
    /// Modal accelerations under unit axle loads, contact by contact.
    receptance: Vec<L>,
    compliance: Vec<L>,
    offset: Vec<L>,
    prepared: Vec<Prepared<L>>,
    forces: Vec<L>,
}

#[inline(always)]
fn dot<L: Lane>(a: &[L], b: &[L]) -> L {
    a.iter().zip(b).fold(L::splat(0.0), |sum, (a, b)| sum + *a * *b)
}

impl<L: Lane> Stepper<L> {
    /// For modes of circular frequencies `omega` [rad/s] and these vehicles.
    pub fn new(omega: &[f64], damping: &ModalDamping, vehicles: &[Moving<'_>], scheme: &Scheme) -> Self {
        let Scheme { h, beta, gravity, lift_off } = *scheme;
        let contacts: usize = vehicles.iter().map(|v| v.assembly.contacts.len()).sum();
        let mut units: Vec<Unit<L>> = Vec::with_capacity(vehicles.len());
        let (mut contact, mut rubbing, mut coordinate) = (0, contacts, 0);
        for vehicle in vehicles {
            let assembly = vehicle.assembly;
            let (c, r, q) = (assembly.contacts.len(), assembly.frictions.len(), assembly.mass.nrows());
            units.push(Unit {
                rig: Rig::new(assembly, vehicle.propulsion == Propulsion::Rolling, None, h, beta),
                propulsion: vehicle.propulsion,
                direction: vehicle.direction,
                contacts: contact..contact + c,
                rubbing: rubbing..rubbing + r,
                coordinates: coordinate..coordinate + q,
                positions: assembly.contacts.iter().map(|c| L::splat(c.position)).collect(),
                shares: assembly.contacts.iter().map(|c| L::splat(c.share)).collect(),
                brakes: None,
            });
            (contact, rubbing, coordinate) = (contact + c, rubbing + r, coordinate + q);
        }
        let points = vehicles.iter().flat_map(|v| &v.assembly.contacts);
        let frictions = vehicles.iter().flat_map(|v| &v.assembly.frictions);
        let elements = Elements {
            contacts: points.map(|point| Contact::new(point, gravity, h, !lift_off)).collect(),
            rubbing: frictions.map(|element| Rubbing::new(element, h)).collect(),
        };
        let (modes, n, zero) = (omega.len(), elements.len(), L::splat(0.0));
        let plain = elements.contacts.iter().all(|contact| contact.weights.plain);
        Stepper {
            newmark: Newmark::new(h, beta),
            omega2: omega.iter().map(|w| L::splat(w * w)).collect(),
            modal: ModalSolve::new(omega, damping, h, beta),
            units,
            elements,
            predicted: vec![Coordinate::rest(); modes],
            travel: vec![Coordinate::rest(); vehicles.len()],
            guess: vec![Coordinate::rest(); vehicles.iter().map(|v| v.assembly.mass.nrows()).max().unwrap_or(0)],
            surge_settled: L::splat(if plain { SURGE_SETTLED } else { SURGE_SETTLED_BY_RATES }),
            along: vec![zero; contacts],
            free: vec![zero; modes],
            loaded: vec![zero; modes],
            shapes: vec![zero; modes * contacts],
            senses: vec![zero; modes * contacts],
            receptance: vec![zero; modes * contacts],
            compliance: vec![zero; n * n],
            offset: vec![zero; n],
            prepared: Vec::with_capacity(contacts),
            forces: vec![zero; modes],
        }
    }

    /// Static equilibrium with the contacts where `geometry` has them, the bridge at rest, each vehicle at its speed.
    ///
    /// An axle that stands on the bridge at the start loads it suddenly, as does one on a road that is not level there;
    /// the first accelerations say so. To find them this stepper must have been made for steps of zero length.
    #[inline(always)]
    pub fn start(&mut self, speeds: &[L], geometry: &impl Geometry<L>) -> Result<State<L>, Unsettled> {
        let zero = L::splat(0.0);
        let contacts = self.elements.contacts.iter().map(|c| c.at_rest());
        let last = self.units.last().map_or(0, |unit| unit.coordinates.end);
        let mut state = State {
            modes: vec![Coordinate::rest(); self.omega2.len()],
            coordinates: vec![Coordinate::rest(); last],
            travel: speeds.iter().map(|&v| Coordinate { x: zero, v, a: zero }).collect(),
            increments: vec![zero; self.elements.len()],
            strokes: contacts.chain(self.elements.rubbing.iter().map(|r| r.at_rest())).collect(),
            along: vec![zero; self.elements.contacts.len()],
            along_before: vec![zero; self.elements.contacts.len()],
        };
        self.predict(&state);
        self.push_along(&mut state, geometry);
        self.react(&mut state, geometry, L::never())?;
        // The loads of the first instant do not depend on how the vehicles surge under them.
        for (u, unit) in self.units.iter_mut().enumerate().filter(|(_, unit)| unit.propulsion == Propulsion::Rolling) {
            let mut force = zero;
            for (own, contact) in unit.contacts.clone().enumerate() {
                state.along[contact] = along(unit, own, contact, &self.elements, &state, geometry);
                force = force + state.along[contact];
            }
            state.travel[u].a = force / unit.rig.total_mass;
            unit.rig.surge(&state.along[unit.contacts.clone()]);
        }
        self.react(&mut state, geometry, L::never())?;
        for ((stroke, contact), delta) in state.strokes.iter_mut().zip(&self.elements.contacts).zip(&self.offset) {
            *stroke = contact.at_onset(*delta);
        }
        state.along_before.copy_from_slice(&state.along);
        Ok(state)
    }

    /// From one stepper for each sample, of the same vehicles, modes and scheme but for their numbers.
    pub fn gather(each: &[&Stepper<f64>]) -> Self {
        let first = each[0];
        let numbers = |f: &dyn Fn(&Stepper<f64>) -> f64| L::from_fn(|i| f(each[i]));
        let zeros = |count: usize| vec![L::splat(0.0); count];
        let units = first.units.iter().enumerate().map(|(u, unit)| {
            let rigs: Vec<&Rig<f64>> = each.iter().map(|s| &s.units[u].rig).collect();
            let vector = |of: &dyn Fn(&Unit<f64>) -> &Vec<f64>| -> Vec<L> {
                (0..of(unit).len()).map(|i| L::from_fn(|s| of(&each[s].units[u])[i])).collect()
            };
            Unit {
                rig: Rig::gather(&rigs),
                propulsion: unit.propulsion,
                direction: unit.direction,
                contacts: unit.contacts.clone(),
                rubbing: unit.rubbing.clone(),
                coordinates: unit.coordinates.clone(),
                positions: vector(&|unit| &unit.positions),
                shares: vector(&|unit| &unit.shares),
                brakes: None,
            }
        });
        let contacts = (0..first.elements.contacts.len())
            .map(|k| Contact::gather(&each.iter().map(|s| &s.elements.contacts[k]).collect::<Vec<_>>()));
        let rubbing = (0..first.elements.rubbing.len())
            .map(|k| Rubbing::gather(&each.iter().map(|s| &s.elements.rubbing[k]).collect::<Vec<_>>()));
        let modes = first.omega2.len();
        Stepper {
            newmark: Newmark::gather(&each.iter().map(|s| &s.newmark).collect::<Vec<_>>()),
            omega2: (0..modes).map(|m| numbers(&|s| s.omega2[m])).collect(),
            modal: ModalSolve::gather(&each.iter().map(|s| &s.modal).collect::<Vec<_>>()),
            units: units.collect(),
            elements: Elements { contacts: contacts.collect(), rubbing: rubbing.collect() },
            predicted: vec![Coordinate::rest(); modes],
            travel: vec![Coordinate::rest(); first.travel.len()],
            guess: vec![Coordinate::rest(); first.guess.len()],
            surge_settled: numbers(&|s| s.surge_settled),
            along: zeros(first.along.len()),
            free: zeros(modes),
            loaded: zeros(modes),
            shapes: zeros(first.shapes.len()),
            senses: zeros(first.senses.len()),
            receptance: zeros(first.receptance.len()),
            compliance: zeros(first.compliance.len()),
            offset: zeros(first.offset.len()),
            prepared: Vec::with_capacity(first.elements.contacts.len()),
            forces: zeros(modes),
        }
    }

    /// Static loads of all contacts [N].
    pub fn static_loads(&self) -> Vec<L> {
        self.elements.contacts.iter().map(|c| c.static_load).collect()
    }

    /// Takes a vehicle that has come to rest as standing: its wheels stay where they are, and it rocks about them.
    pub fn hold(&mut self, vehicle: usize, standing: Rig<L>) {
        self.units[vehicle].rig = standing;
        self.units[vehicle].propulsion = Propulsion::Prescribed;
    }

    /// Puts a vehicle's brakes on, or says how far they are.
    pub fn brake(&mut self, vehicle: usize, brakes: Brakes<L>) {
        self.units[vehicle].brakes = Some(brakes);
    }

    /// Advances the state by one step.
    #[inline(always)]
    pub fn advance(&mut self, state: &mut State<L>, geometry: &mut impl Geometry<L>) -> Result<(), Unsettled> {
        self.predict(state);
        geometry.advance();
        let rolling = self.units.iter().any(|unit| unit.propulsion == Propulsion::Rolling);
        if !rolling {
            self.push_along(state, geometry);
            self.react(state, geometry, L::never())?;
            self.settle(state);
            return Ok(());
        }
        self.guess_along(state);
        for (u, unit) in self.units.iter().enumerate() {
            self.travel[u] = self.newmark.predict(state.travel[u]);
            if unit.propulsion == Propulsion::Rolling {
                let guess = &mut self.guess[..unit.rig.size];
                unit.rig.guess(&self.newmark, &state.coordinates[unit.coordinates.clone()], guess);
                let force = unit.contacts.clone().fold(L::splat(0.0), |sum, contact| sum + state.along[contact]);
                let travel = self.newmark.correct(self.travel[u], force / unit.rig.total_mass);
                place(unit, travel, guess, geometry, true);
            }
        }
        self.push_along(state, geometry);
        let mut settled = L::never();
        for _ in 0..PASSES {
            self.react(state, geometry, settled)?;
            let mut moving = L::never();
            for (u, unit) in self.units.iter().enumerate() {
                if unit.propulsion != Propulsion::Rolling {
                    continue;
                }
                let (mut force, mut change) = (L::splat(0.0), L::splat(0.0));
                for (own, contact) in unit.contacts.clone().enumerate() {
                    let next = along(unit, own, contact, &self.elements, state, geometry);
                    change = change + (next - state.along[contact]).magnitude();
                    force = force + next;
                    self.along[contact] = next;
                }
                state.travel[u] = self.newmark.correct(self.travel[u], force / unit.rig.total_mass);
                let coordinates = &state.coordinates[unit.coordinates.clone()];
                moving = moving | place(unit, state.travel[u], coordinates, geometry, false);
                moving = moving | !change.less(self.surge_settled * unit.rig.total_mass);
            }
            // A settled lane is left as it is, so that further passes repeat it bit for bit.
            settled = !moving;
            if L::all(settled) {
                self.settle(state);
                return Ok(());
            }
            for unit in self.units.iter_mut().filter(|unit| unit.propulsion == Propulsion::Rolling) {
                for contact in unit.contacts.clone() {
                    state.along[contact] = L::select(moving, self.along[contact], state.along[contact]);
                }
                unit.rig.surge(&state.along[unit.contacts.clone()]);
            }
        }
        Err(Unsettled::AxlePositions)
    }

    /// Everything at the end of the step if accelerations there were zero, and modal accelerations without loads.
    #[inline(always)]
    fn predict(&mut self, state: &State<L>) {
        for unit in &mut self.units {
            unit.rig.predict(&self.newmark, &state.coordinates[unit.coordinates.clone()]);
        }
        for (predicted, mode) in self.predicted.iter_mut().zip(&state.modes) {
            *predicted = self.newmark.predict(*mode);
        }
        for m in 0..self.predicted.len() {
            let resisting = self.modal.damping_force(m, &self.predicted) + self.omega2[m] * self.predicted[m].x;
            self.forces[m] = -resisting;
        }
        self.modal.apply(&self.forces, &mut self.free);
    }

    /// Forces along the road as they go on from the last two steps, where vehicles roll.
    #[inline(always)]
    fn guess_along(&self, state: &mut State<L>) {
        for unit in self.units.iter().filter(|unit| unit.propulsion == Propulsion::Rolling) {
            for contact in unit.contacts.clone() {
                let now = state.along[contact];
                state.along[contact] = now + (now - state.along_before[contact]);
                state.along_before[contact] = now;
            }
        }
    }

    /// Forces along the road to begin with: those that prescribed motion takes, or those of the last step.
    #[inline(always)]
    fn push_along(&mut self, state: &mut State<L>, geometry: &impl Geometry<L>) {
        for unit in &mut self.units {
            if unit.propulsion == Propulsion::Prescribed {
                for (contact, share) in unit.contacts.clone().zip(&unit.shares) {
                    state.along[contact] = L::splat(unit.direction) * geometry.motion(contact).a * *share;
                }
            }
            unit.rig.surge(&state.along[unit.contacts.clone()]);
        }
    }

    /// Solves for the unknown forces and moves bridge and vehicles accordingly, in lanes that are not `frozen`.
    #[inline(always)]
    fn react(&mut self, state: &mut State<L>, geometry: &impl Geometry<L>, frozen: L::Mask) -> Result<(), Unsettled> {
        self.couple(geometry);
        if !self.elements.solve(
            &self.offset,
            &self.compliance,
            &state.strokes,
            &mut self.prepared,
            &mut state.increments,
            frozen,
        ) {
            return Err(Unsettled::ContactForces);
        }
        self.move_bridge(state);
        for unit in &self.units {
            let (contacts, rubbing) = (unit.contacts.clone(), unit.rubbing.clone());
            let forces = [&state.increments[contacts], &state.increments[rubbing]];
            unit.rig.correct(&self.newmark, forces[0], forces[1], &mut state.coordinates[unit.coordinates.clone()]);
        }
        Ok(())
    }

    /// Commits the suspensions to the end of the step; what moves as prescribed goes on.
    #[inline(always)]
    fn settle(&self, state: &mut State<L>) {
        self.elements.settle(&self.offset, &self.compliance, &state.increments, &mut state.strokes);
    }

    /// What the elements follow without force increments, `offset`, and what the increments take off it, `compliance`.
    #[inline(always)]
    fn couple(&mut self, geometry: &impl Geometry<L>) {
        let (modes, n) = (self.omega2.len(), self.elements.len());
        let Newmark { h, half_h, new: beta_h2, .. } = self.newmark;
        for (k, shapes) in self.shapes.chunks_exact_mut(modes.max(1)).enumerate() {
            geometry.shapes(k, shapes);
        }
        self.loaded.copy_from_slice(&self.free);
        let receptances = self.receptance.chunks_exact_mut(modes.max(1));
        for ((shapes, receptance), contact) in
            self.shapes.chunks_exact(modes.max(1)).zip(receptances).zip(&self.elements.contacts)
        {
            self.modal.apply(shapes, receptance);
            for (loaded, r) in self.loaded.iter_mut().zip(receptance.iter()) {
                *loaded = *loaded + *r * contact.static_load;
            }
        }
        // The bridge below the contacts.
        for (k, contact) in self.elements.contacts.iter().enumerate().filter(|(_, contact)| !contact.constant) {
            let weights = contact.weights;
            let shapes = &self.shapes[k * modes..(k + 1) * modes];
            let senses = &mut self.senses[k * modes..(k + 1) * modes];
            let road = geometry.surface(k);
            let mut offset = weights.value * road.elevation;
            if weights.plain {
                for ((sense, shape), predicted) in senses.iter_mut().zip(shapes).zip(&self.predicted) {
                    *sense = beta_h2 * *shape;
                    offset = offset - *shape * predicted.x;
                }
            } else {
                let Coordinate { v, a, .. } = geometry.motion(k);
                let v2 = v * v;
                offset = offset
                    + weights.rate * v * road.slope
                    + weights.acceleration * (v2 * road.curvature + a * road.slope);
                for (m, ((sense, &shape), q)) in senses.iter_mut().zip(shapes).zip(&self.predicted).enumerate() {
                    let (slope, curvature) = (geometry.slope(k, m), geometry.curvature(k, m));
                    let convected = v2 * curvature + a * slope;
                    *sense = weights.value * (beta_h2 * shape)
                        + weights.rate * (half_h * shape + beta_h2 * v * slope)
                        + weights.acceleration * (shape + h * v * slope + beta_h2 * convected);
                    let value = shape * q.x;
                    let rate = shape * q.v + v * slope * q.x;
                    let acceleration = L::splat(2.0) * v * slope * q.v + convected * q.x;
                    offset =
                        offset - (weights.value * value + weights.rate * rate + weights.acceleration * acceleration);
                }
            }
            self.offset[k] = offset - dot(senses, &self.loaded);
            let row = &mut self.compliance[k * n..(k + 1) * n];
            row.fill(L::splat(0.0));
            for (receptance, compliance) in self.receptance.chunks_exact(modes.max(1)).zip(row.iter_mut()) {
                *compliance = dot(senses, receptance);
            }
        }
        // The vehicles above them, and what rubs between their parts.
        for unit in &self.units {
            // A vehicle without coordinates adds nothing.
            let elements = if unit.rig.size == 0 { 0 } else { unit.rig.elements };
            for own in 0..elements {
                let k = unit.element(own);
                let [value, rate] = unit.rig.shortening(&self.newmark, own);
                let factor = match self.elements.contacts.get(k) {
                    Some(contact) => {
                        let weights = contact.weights;
                        self.offset[k] = self.offset[k] + weights.value * value + weights.rate * rate;
                        weights.value * beta_h2 + weights.rate * half_h
                    }
                    None => {
                        self.offset[k] = value;
                        beta_h2
                    }
                };
                for (other, coupling) in unit.rig.coupling(own).iter().enumerate() {
                    let at = k * n + unit.element(other);
                    let of_bridge = other < unit.contacts.len() && own < unit.contacts.len();
                    let before = if of_bridge { self.compliance[at] } else { L::splat(0.0) };
                    self.compliance[at] = before + factor * *coupling;
                }
            }
        }
    }

    #[inline(always)]
    fn move_bridge(&mut self, state: &mut State<L>) {
        let modes = self.omega2.len();
        self.forces.copy_from_slice(&self.loaded);
        for (receptance, increment) in self.receptance.chunks_exact(modes.max(1)).zip(&state.increments) {
            for (a, r) in self.forces.iter_mut().zip(receptance) {
                *a = *a + *r * *increment;
            }
        }
        for ((mode, predicted), a) in state.modes.iter_mut().zip(&self.predicted).zip(&self.forces) {
            *mode = self.newmark.correct(*predicted, *a);
        }
    }
}

/// Puts the contacts of a freely rolling vehicle where it has them: lanes in which one had still to move.
#[inline(always)]
fn place<L: Lane>(
    unit: &Unit<L>,
    travel: Coordinate<L>,
    coordinates: &[Coordinate<L>],
    geometry: &mut impl Geometry<L>,
    new_step: bool,
) -> L::Mask {
    let mut moving = L::never();
    for (own, contact) in unit.contacts.clone().enumerate() {
        let along = unit.rig.along(own, coordinates);
        let x = travel.x + unit.positions[own] + along.x;
        let motion = Coordinate { x, v: travel.v + along.v, a: travel.a + along.a };
        moving = moving | geometry.follow(contact, motion, new_step);
    }
    moving
}

/// Force along the road at a contact of a freely rolling vehicle, in the direction of travel: what pushes it down the
/// slope of bridge and road, less its brakes.
#[inline(always)]
fn along<L: Lane>(
    unit: &Unit<L>,
    own: usize,
    contact: usize,
    elements: &Elements<L>,
    state: &State<L>,
    geometry: &impl Geometry<L>,
) -> L {
    let modes = state.modes.iter().enumerate();
    let slope = modes.fold(L::splat(0.0), |sum, (m, mode)| sum + geometry.slope(contact, m) * mode.x);
    let slope = slope - geometry.surface(contact).slope;
    let load = elements.contacts[contact].static_load + state.increments[contact];
    let downhill = L::splat(unit.direction) * load * slope;
    match unit.brakes {
        None => downhill,
        Some(brakes) => {
            let asked = brakes.level * brakes.demand * unit.shares[own];
            downhill - asked.smaller(brakes.adhesion * load)
        }
    }
}
