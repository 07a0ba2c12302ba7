//! One time step of bridge and vehicles together, written once for every kind of lane.
//!
//! Newmark's method with γ = ½ for the modal coordinates, Ä + DȦ + Ω²A = ΦᵀP (KTN73 Eq. 3), and for the vehicles;
//! everything at the same instant t_{n+1}. The modes are coupled to the vehicles only through the contact forces, and
//! bodies that rub on each other through friction, so these are the unknowns: each follows δ_k = u_k − Σ S_kj p_j.

use super::bridge_step::ModalSolve;
use super::compliance::{Interaction, above};
use super::contact::{Contact, Prepared};
use super::coupled_forces::{Elements, Rubbing};
use super::friction::Stroke;
use super::gait::Gait;
use super::newmark::Newmark;
use super::sizes::{Desk, FIVE_AXLES, FOUR_AXLES, Form, HALF_CAR, Room, THREE_AXLES, TWO_AXLES, USUAL};
use super::stand::Stand;
use super::unit::{Moving, Propulsion, Unit};
use super::vehicle_step::VehicleSolve;
use crate::coordinate::Coordinate;
use crate::damping::ModalDamping;
use crate::geometry::Geometry;
use crate::lane::Lane;
use crate::lane::gather::Gather;
use crate::step::vibration::Vibration;

/// Change of the surge [m/s²] from pass to pass at which it counts as found: it comes back to itself through the pitch of
/// the vehicles and the slope of the bridge, times β h², so what remains is some millionths of it.
const SURGE_SETTLED: f64 = 1e-5;

/// The same where forces follow rates too, which are off by the square of the step.
const SURGE_SETTLED_BY_RATES: f64 = 1e-8;

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
}

impl<L: Lane> State<L> {
    /// Of so many constant loads, which have nothing to move but the bridge, and of its modes.
    pub fn of_loads(count: usize, modes: Vec<Coordinate<L>>) -> Self {
        let zero = L::splat(0.0);
        State {
            modes,
            coordinates: Vec::new(),
            travel: Vec::new(),
            increments: vec![zero; count],
            strokes: vec![Stroke::at_rest(zero); count],
            along: vec![zero; count],
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
    pub(super) form: Form,
    gait: Option<Gait>,
    pub(super) newmark: Newmark<L>,
    pub(super) modal: ModalSolve<L>,
    pub(super) units: Vec<Unit<L>>,
    pub(super) elements: Elements<L>,
    /// What the vehicles add to the compliance, by rows.
    pub(super) above: Vec<L>,
    pub(super) surge_settled: L,
    /// The interaction without a bridge, which is the same everywhere.
    pub(super) alone: Vec<L>,
    pub(super) room: Room<Vec<Coordinate<L>>, Vec<L>, Vec<Prepared<L>>>,
}

/// The form of a step of these.
fn form<L: Lane>(modal: &ModalSolve<L>, units: &[Unit<L>], elements: &Elements<L>) -> Form {
    Form {
        modes: modal.modes(),
        elements: elements.known(),
        vehicles: units.len(),
        coordinates: units.last().map_or(0, |unit| unit.coordinates.end),
        plain: elements.contacts.iter().all(|contact| contact.weights.plain),
        classical: modal.classical,
        bare: units.iter().all(|unit| unit.rig.bare()),
        passive: units.iter().all(|unit| unit.rig.bare() && !unit.rig.surges()),
    }
}

impl Stepper<f64> {
    /// What samples must have in common to be gathered: in these their steps take other ways, not only other numbers.
    pub fn ways(&self) -> Vec<bool> {
        let mut ways = Vec::new();
        Gather::<f64>::ways(&self.modal, &mut ways);
        Gather::<f64>::ways(&self.units, &mut ways);
        Gather::<f64>::ways(&self.elements, &mut ways);
        ways
    }
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
                rig: VehicleSolve::new(assembly, vehicle.propulsion == Propulsion::Rolling, None, h, beta),
                propulsion: vehicle.propulsion,
                direction: L::splat(vehicle.direction),
                contacts: contact..contact + c,
                rubbing: rubbing..rubbing + r,
                coordinates: coordinate..coordinate + q,
                positions: assembly.contacts.iter().map(|c| L::splat(c.position)).collect(),
                shares: assembly.contacts.iter().map(|c| L::splat(c.share)).collect(),
                pull: L::splat(match vehicle.propulsion {
                    Propulsion::Prescribed => 0.0,
                    Propulsion::Rolling => -gravity * vehicle.grade,
                }),
                stand: (h == 0.0 && q > 0).then(|| Stand::new(assembly, gravity, !lift_off)),
            });
            (contact, rubbing, coordinate) = (contact + c, rubbing + r, coordinate + q);
        }
        let points = vehicles.iter().flat_map(|v| &v.assembly.contacts);
        let frictions = vehicles.iter().flat_map(|v| &v.assembly.frictions);
        let elements = Elements::new(
            points.map(|point| Contact::new(point, gravity, h, !lift_off)).collect(),
            frictions.map(|element| Rubbing::new(element, h)).collect(),
        );
        let modal = ModalSolve::new(omega, damping, h, beta);
        let plain = elements.contacts.iter().all(|contact| contact.weights.plain);
        let surge_settled = L::splat(if plain { SURGE_SETTLED } else { SURGE_SETTLED_BY_RATES });
        Stepper::of(Newmark::new(h, beta), modal, units, elements, surge_settled)
    }

    /// Of these parts, and with room to work in.
    fn of(
        newmark: Newmark<L>,
        modal: ModalSolve<L>,
        units: Vec<Unit<L>>,
        elements: Elements<L>,
        surge_settled: L,
    ) -> Self {
        let form = form(&modal, &units, &elements);
        let (modes, n) = (form.modes, form.all());
        let zeros = |count: usize| vec![L::splat(0.0); count];
        let rest = |count: usize| vec![Coordinate::rest(); count];
        let mut stepper = Stepper {
            above: above(&newmark, &units, &elements),
            alone: Vec::new(),
            room: Room {
                predicted: rest(modes),
                bodies: rest(form.coordinates),
                resisting: zeros(modes),
                forces: zeros(modes),
                accelerations: zeros(modes),
                loaded: rest(modes),
                senses: zeros(modes),
                interaction: zeros(form.width()),
                offset: zeros(n),
                increments: zeros(n),
                fresh: zeros(n),
                prepared: vec![Prepared::nothing(); n],
            },
            form,
            gait: None,
            newmark,
            modal,
            units,
            elements,
            surge_settled,
        };
        stepper.stand_alone();
        stepper.gait = stepper.find_gait();
        stepper
    }

    /// Works out how the elements are coupled without a bridge, if there is none.
    fn stand_alone(&mut self) {
        if self.form.modes == 0 {
            let mut alone = vec![L::splat(0.0); self.form.width()];
            self.hold_compliance(self.form, &mut alone);
            self.alone = alone;
        }
    }

    /// From one stepper for each sample, of the same vehicles, modes and scheme but for their numbers.
    pub fn gather(each: &[&Stepper<f64>]) -> Self {
        Stepper::of(
            Gather::gather(|sample| &each[sample].newmark),
            Gather::gather(|sample| &each[sample].modal),
            Gather::gather(|sample| &each[sample].units),
            Gather::gather(|sample| &each[sample].elements),
            Gather::gather(|sample| &each[sample].surge_settled),
        )
    }

    /// Static loads of all contacts [N].
    pub fn static_loads(&self) -> Vec<L> {
        self.elements.contacts.iter().map(|c| c.static_load).collect()
    }

    /// Takes a vehicle that has come to rest as standing: its wheels stay where they are, held against the grade, and it
    /// rocks about them.
    pub fn hold(&mut self, vehicle: usize, standing: VehicleSolve<L>) {
        self.units[vehicle].rig = standing;
        self.units[vehicle].propulsion = Propulsion::Prescribed;
        self.above = above(&self.newmark, &self.units, &self.elements);
        self.form = form(&self.modal, &self.units, &self.elements);
        self.stand_alone();
        self.gait = self.find_gait();
    }

    /// What its vehicle is like, if it is one of those that have their own steps.
    pub fn gait(&self) -> Option<Gait> {
        self.gait
    }

    /// How many modes it moves.
    pub fn modes(&self) -> usize {
        self.form.modes
    }

    /// The bridge by itself.
    pub fn vibration(&self) -> Vibration<L> {
        Vibration::new(self.newmark, self.modal.clone())
    }

    /// How the contacts feel the bridge where `geometry` has them, as numbers for [`Geometry::interaction`].
    pub fn interaction(&mut self, geometry: &impl Geometry<L>) -> &[L] {
        let mut room = std::mem::take(&mut self.room);
        self.compliance(self.form, geometry, &mut room.desk());
        self.room = room;
        &self.room.interaction
    }

    /// Advances the state by one step of vehicles all of whose motion is prescribed, to where `geometry` has them.
    #[inline(always)]
    pub fn advance(&mut self, state: &mut State<L>, geometry: &mut impl Geometry<L>) -> Result<(), Unsettled> {
        let form = Form { passive: self.form.passive || self.form.bare && geometry.steady(), ..self.form };
        geometry.advance();
        let geometry = &*geometry;
        let known = geometry.interaction();
        // Debug builds know none: forms change no bit and take most of the time to compile.
        let mut usual = Room::usual();
        match (form, known) {
            (TWO_AXLES, _) if !cfg!(debug_assertions) => {
                return self.drive(TWO_AXLES, state, geometry, None, &mut usual.desk());
            }
            (USUAL, None) if !cfg!(debug_assertions) => {
                return self.drive(USUAL, state, geometry, None, &mut usual.desk());
            }
            _ => {}
        }
        let mut room = std::mem::take(&mut self.room);
        let (modes, desk) = (form.modes, &mut room.desk());
        // With any number of modes, and thus also on the way to the bridge.
        let driven = match (Form { modes: 0, ..form }) {
            TWO_AXLES if !cfg!(debug_assertions) => {
                self.drive(Form { modes, ..TWO_AXLES }, state, geometry, known, desk)
            }
            THREE_AXLES if !cfg!(debug_assertions) => {
                self.drive(Form { modes, ..THREE_AXLES }, state, geometry, known, desk)
            }
            FOUR_AXLES if !cfg!(debug_assertions) => {
                self.drive(Form { modes, ..FOUR_AXLES }, state, geometry, known, desk)
            }
            FIVE_AXLES if !cfg!(debug_assertions) => {
                self.drive(Form { modes, ..FIVE_AXLES }, state, geometry, known, desk)
            }
            HALF_CAR if !cfg!(debug_assertions) => self.drive(Form { modes, ..HALF_CAR }, state, geometry, known, desk),
            _ => self.drive(form, state, geometry, known, desk),
        };
        self.room = room;
        driven
    }

    /// The same where only numbers tell what kind of step it is, which is slower, and quicker to compile.
    #[inline(always)]
    pub fn advance_any(&mut self, state: &mut State<L>, geometry: &mut impl Geometry<L>) -> Result<(), Unsettled> {
        let form = Form { passive: self.form.passive || self.form.bare && geometry.steady(), ..self.form };
        geometry.advance();
        let mut room = std::mem::take(&mut self.room);
        let driven = self.drive(form, state, &*geometry, None, &mut room.desk());
        self.room = room;
        driven
    }

    /// The same in a step of this form; with the interaction there, if that is `known`.
    #[inline(always)]
    fn drive(
        &mut self,
        form: Form,
        state: &mut State<L>,
        geometry: &impl Geometry<L>,
        known: Option<&[f64]>,
        desk: &mut Desk<'_, L>,
    ) -> Result<(), Unsettled> {
        self.predict(form, state, desk);
        if !form.passive {
            self.push_along(form, state, geometry, desk);
        }
        self.react(form, state, geometry, known, desk)?;
        self.commit(form, state, desk);
        Ok(())
    }

    /// Everything at the end of the step if accelerations there were zero, and how the modes resist that.
    #[inline(always)]
    pub(super) fn predict(&mut self, form: Form, state: &State<L>, desk: &mut Desk<'_, L>) {
        for unit in &mut self.units[..form.vehicles] {
            let [_, _, coordinates] = unit.parts(form);
            let bodies = &mut desk.bodies[coordinates.clone()];
            unit.rig.predict(&self.newmark, &state.coordinates[coordinates], bodies, form.passive);
        }
        let predicted = &mut desk.predicted[..form.modes];
        for (predicted, mode) in predicted.iter_mut().zip(&state.modes[..form.modes]) {
            *predicted = self.newmark.predict(*mode);
        }
        self.modal.resist(form.classical, predicted, &mut desk.resisting[..form.modes]);
    }

    /// Forces along the road to begin with: those that prescribed motion takes, or those of the last step.
    #[inline(always)]
    pub(super) fn push_along(
        &mut self,
        form: Form,
        state: &mut State<L>,
        geometry: &impl Geometry<L>,
        desk: &Desk<'_, L>,
    ) {
        for unit in &mut self.units[..form.vehicles] {
            if unit.propulsion == Propulsion::Prescribed {
                for (contact, share) in unit.contacts.clone().zip(&unit.shares) {
                    let gain = unit.direction * geometry.motion(contact).a;
                    state.along[contact] = (gain - unit.pull) * *share;
                }
            }
            unit.surge(&self.newmark, desk.bodies, &state.along);
        }
    }

    /// Solves for the unknown forces and moves bridge and vehicles accordingly, with the interaction where
    /// `geometry` has the contacts, if that is `known`.
    #[inline(always)]
    pub(super) fn react(
        &mut self,
        form: Form,
        state: &mut State<L>,
        geometry: &impl Geometry<L>,
        known: Option<&[f64]>,
        desk: &mut Desk<'_, L>,
    ) -> Result<(), Unsettled> {
        self.set_up(form, geometry, known, desk);
        self.solve_forces(form, state, desk)
    }

    /// What the elements follow without the increments of the forces, and how those are coupled.
    #[inline(always)]
    pub(super) fn set_up(
        &self,
        form: Form,
        geometry: &impl Geometry<L>,
        known: Option<&[f64]>,
        desk: &mut Desk<'_, L>,
    ) {
        match known {
            _ if form.modes == 0 => desk.interaction[..form.width()].copy_from_slice(&self.alone[..form.width()]),
            Some(numbers) => {
                let (modes, contacts, [_, _, of_all, _, end]) = (form.modes, form.contacts(), form.parts());
                let (of_modes, of_elements) = numbers.split_at(numbers.len() - (end - of_all));
                for (m, own) in of_modes.chunks_exact(of_modes.len() / modes).enumerate() {
                    for (part, own) in own.chunks_exact(contacts).take(3).enumerate() {
                        for (k, number) in own.iter().enumerate() {
                            desk.interaction[(part * contacts + k) * modes + m] = L::splat(*number);
                        }
                    }
                }
                for (own, number) in desk.interaction[of_all..end].iter_mut().zip(of_elements) {
                    *own = L::splat(*number);
                }
            }
            None => self.compliance(form, geometry, desk),
        }
        self.bridge_gap(form, geometry, desk);
        self.vehicle_gap(form, desk);
    }

    /// Solves for the increments and moves bridge (by Eq. 3, now under all of P) and vehicles under them.
    #[inline(always)]
    pub(super) fn solve_forces(
        &self,
        form: Form,
        state: &mut State<L>,
        desk: &mut Desk<'_, L>,
    ) -> Result<(), Unsettled> {
        let Interaction { compliance, held, receptance, .. } = Interaction::of(form, desk.interaction);
        let (prepared, strokes) = (&mut *desk.prepared, &state.strokes);
        self.elements.prepare(form.elements, held, strokes, prepared);
        let increments = &mut desk.increments[..form.all()];
        increments.copy_from_slice(&state.increments[..form.all()]);
        let room = [&mut *increments, &mut *desk.fresh];
        if !self.elements.solve(form.elements, desk.offset, compliance, strokes, prepared, room) {
            return Err(Unsettled::ContactForces);
        }
        state.increments[..form.all()].copy_from_slice(increments);
        for (m, mode) in state.modes[..form.modes].iter_mut().enumerate() {
            let mut a = desk.loaded[..form.modes][m].a;
            for (k, increment) in increments[..form.contacts()].iter().enumerate() {
                a = a + receptance[k * form.modes + m] * *increment;
            }
            *mode = self.newmark.correct(desk.predicted[..form.modes][m], a);
        }
        for unit in &self.units[..form.vehicles] {
            let [contacts, rubbing, coordinates] = unit.parts(form);
            let forces = [&increments[contacts], &increments[rubbing]];
            let (bodies, state) = (&desk.bodies[coordinates.clone()], &mut state.coordinates[coordinates]);
            unit.rig.correct(&self.newmark, bodies, forces, state, form.passive);
        }
        Ok(())
    }

    /// Commits the suspensions to the end of the step; what moves as prescribed goes on.
    #[inline(always)]
    pub(super) fn commit(&self, form: Form, state: &mut State<L>, desk: &Desk<'_, L>) {
        let compliance = Interaction::of(form, desk.interaction).compliance;
        let (increments, strokes) = (&state.increments, &mut state.strokes);
        self.elements.commit(form.elements, desk.offset, compliance, desk.prepared, increments, strokes);
    }

    /// Works out how the contacts feel the bridge where they stand.
    #[inline(always)]
    fn compliance(&self, form: Form, geometry: &impl Geometry<L>, desk: &mut Desk<'_, L>) {
        let (modes, contacts, n) = (form.modes, form.contacts(), form.all());
        let Newmark { h, half_h, new: beta_h2, .. } = self.newmark;
        let [pressing, receptance, compliance, ..] = form.parts();
        let elements = &self.elements.contacts[..contacts];
        let numbers = &mut desk.interaction[..form.width()];
        for (k, contact) in elements.iter().enumerate() {
            let (shapes, rest) = numbers.split_at_mut(pressing);
            let (own, first) = (&mut shapes[k * modes..][..modes], k * modes);
            geometry.shapes(k, own);
            for (force, shape) in rest[first..][..modes].iter_mut().zip(own.iter()) {
                *force = *shape * contact.static_load;
            }
            self.modal.apply(form.classical, own, &mut rest[receptance - pressing + first..][..modes]);
        }
        for (k, contact) in elements.iter().enumerate() {
            let (weights, own) = (contact.weights, &numbers[k * modes..][..modes]);
            let senses = &mut desk.senses[..modes];
            if !form.elements.coulomb && contact.constant {
                senses.fill(L::splat(0.0));
            } else if form.plain || weights.plain {
                for (sense, shape) in senses.iter_mut().zip(own) {
                    *sense = beta_h2 * *shape;
                }
            } else {
                let Coordinate { v, a, .. } = geometry.motion(k);
                let v2 = v * v;
                for (m, (sense, &shape)) in senses.iter_mut().zip(own).enumerate() {
                    let (slope, curvature) = (geometry.slope(k, m), geometry.curvature(k, m));
                    let convected = v2 * curvature + a * slope;
                    *sense = weights.value * (beta_h2 * shape)
                        + weights.rate * (half_h * shape + beta_h2 * v * slope)
                        + weights.acceleration * (shape + h * v * slope + beta_h2 * convected);
                }
            }
            for j in 0..contacts {
                let mut sum = self.above[..n * n][k * n + j];
                for (sense, r) in senses.iter().zip(&numbers[receptance + j * modes..][..modes]) {
                    sum = sum + *sense * *r;
                }
                numbers[compliance + k * n + j] = sum;
            }
        }
        self.hold_compliance(form, numbers);
    }

    /// Works out what follows from the compliance, of which the bridge's part is there already.
    #[inline(always)]
    fn hold_compliance(&self, form: Form, numbers: &mut [L]) {
        let n = form.all();
        let [_, _, compliance, held, end] = form.parts();
        let (compliance, held) = numbers[compliance..end].split_at_mut(held - compliance);
        for k in 0..n {
            for j in 0..n {
                // Between contacts only a bridge adds to it.
                if form.modes == 0 || k >= form.contacts() || j >= form.contacts() {
                    compliance[k * n + j] = self.above[..n * n][k * n + j];
                }
            }
        }
        self.elements.hold(form.elements, compliance, held);
    }

    /// The road and the bridge below the contacts: what they make of δ with the bridge moving, by Eq. 3, under the static
    /// loads alone.
    #[inline(always)]
    fn bridge_gap(&self, form: Form, geometry: &impl Geometry<L>, desk: &mut Desk<'_, L>) {
        let (modes, contacts) = (form.modes, form.contacts());
        let Interaction { shapes, pressing, .. } = Interaction::of(form, desk.interaction);
        let (forces, accelerations) = (&mut desk.forces[..modes], &mut desk.accelerations[..modes]);
        let (loaded, offset) = (&mut desk.loaded[..modes], &mut desk.offset[..contacts]);
        for (force, resisting) in forces.iter_mut().zip(&desk.resisting[..modes]) {
            *force = -*resisting;
        }
        for k in 0..contacts {
            for (force, pressing) in forces.iter_mut().zip(&pressing[k * modes..][..modes]) {
                *force = *force + *pressing;
            }
        }
        self.modal.apply(form.classical, forces, accelerations);
        for ((loaded, predicted), a) in loaded.iter_mut().zip(&desk.predicted[..modes]).zip(accelerations.iter()) {
            *loaded = self.newmark.correct(*predicted, *a);
        }
        for (k, contact) in self.elements.contacts[..contacts].iter().enumerate() {
            if !form.elements.coulomb && contact.constant {
                offset[k] = L::splat(0.0);
                continue;
            }
            let weights = contact.weights;
            let own = &shapes[k * modes..][..modes];
            let road = geometry.surface(k);
            if form.plain || weights.plain {
                let mut sum = road.elevation;
                for (shape, q) in own.iter().zip(loaded.iter()) {
                    sum = sum - *shape * q.x;
                }
                offset[k] = sum;
                continue;
            }
            let Coordinate { v, a, .. } = geometry.motion(k);
            let v2 = v * v;
            let mut sum = weights.value * road.elevation
                + weights.rate * v * road.slope
                + weights.acceleration * (v2 * road.curvature + a * road.slope);
            for (m, (&shape, q)) in own.iter().zip(loaded.iter()).enumerate() {
                let (slope, curvature) = (geometry.slope(k, m), geometry.curvature(k, m));
                let convected = v2 * curvature + a * slope;
                let value = shape * q.x;
                let rate = shape * q.v + v * slope * q.x;
                let acceleration = shape * q.a + L::splat(2.0) * v * slope * q.v + convected * q.x;
                sum = sum - (weights.value * value + weights.rate * rate + weights.acceleration * acceleration);
            }
            offset[k] = sum;
        }
    }

    /// The vehicles above the contacts, and what rubs between their parts: what the elements follow without the
    /// increments of the forces.
    #[inline(always)]
    fn vehicle_gap(&self, form: Form, desk: &mut Desk<'_, L>) {
        let offset = &mut desk.offset[..form.all()];
        offset[form.contacts()..].fill(L::splat(0.0));
        for unit in &self.units[..form.vehicles] {
            let [contacts, rubbing, coordinates] = unit.parts(form);
            let bodies = &desk.bodies[coordinates];
            for (own, k) in contacts.chain(rubbing).enumerate() {
                let unloaded = unit.rig.unloaded(own, bodies, form.passive);
                let mut sum = offset[k];
                if form.plain || k >= form.contacts() {
                    for (row, q) in unloaded {
                        sum = sum + *row * q.x;
                    }
                } else {
                    let weights = self.elements.contacts[k].weights;
                    for (row, q) in unloaded {
                        sum = sum + *row * (weights.value * q.x + weights.rate * q.v);
                    }
                }
                offset[k] = sum;
            }
        }
    }
}
