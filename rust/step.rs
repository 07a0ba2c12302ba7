//! One time step of bridge and vehicles together, written once for every kind of lane.
//!
//! Newmark's method with γ = ½ for the modal coordinates and the vehicles; everything at the same instant t_{n+1}. The
//! modes are coupled to the vehicles only through the contact forces, and bodies that rub on each other through friction,
//! so these are the unknowns: each follows δ_k = u_k − Σ S_kj p_j.

use std::ops::Range;

use crate::assembly::Assembly;
use crate::contact::{Contact, Elements, HELD, Known, Prepared, Rubbing};
use crate::friction::Stroke;
use crate::lane::Lane;
use crate::modal::{ModalDamping, ModalSolve};
use crate::newmark::{Coordinate, Newmark};
use crate::rig::Rig;
use crate::stand::{Stand, Stood};
use crate::tail::Vibration;

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
    /// Elevation, up, from the line that all vertical motion of the vehicle is counted from [m].
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

    /// Whether no contact gains or loses speed at the end of the next step, so that nothing pushes the vehicles along
    /// the road.
    fn steady(&self) -> bool {
        false
    }

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

    /// The [`Stepper::coupling`] of this place, where it is known: the same in all lanes.
    fn coupling(&self) -> Option<&[f64]> {
        None
    }
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
    /// How much the line that elevations are counted from rises on its way [-]: it slows what rolls freely.
    pub grade: f64,
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
    /// Acceleration by its weight down the grade, in its direction [m/s²]; zero where its motion is prescribed from the
    /// start.
    pull: L,
    /// How it stands still, where a step takes no time.
    stand: Option<Stand<L>>,
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

/// What decides which way a step goes. It is passed by value: where a caller gives it in literals, every loop below runs
/// a known number of times, and what is not asked for is not there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Form {
    modes: usize,
    elements: Known,
    vehicles: usize,
    /// Coordinates of all vehicles.
    coordinates: usize,
    /// Whether all contact forces follow from the shortening alone.
    plain: bool,
    /// Whether each mode is damped by itself.
    classical: bool,
    /// Whether there are no springs and dampers between the vehicles' coordinates.
    bare: bool,
    /// Whether nothing but element forces acts on the vehicles' coordinates.
    passive: bool,
}

/// One rigid body on so many axles without mass, with Coulomb friction, on its way to the bridge.
const fn on_axles(contacts: usize) -> Form {
    Form {
        modes: 0,
        elements: Known { contacts, rubbing: 0, coulomb: true },
        vehicles: 1,
        coordinates: 2,
        plain: true,
        classical: true,
        bare: true,
        passive: true,
    }
}

const TWO_AXLES: Form = on_axles(2);
const THREE_AXLES: Form = on_axles(3);
const FOUR_AXLES: Form = on_axles(4);
const FIVE_AXLES: Form = on_axles(5);

/// On two axles on a bridge of three modes.
const USUAL: Form = Form { modes: 3, ..TWO_AXLES };

/// One rigid body on two axles with mass, on springs and dampers.
const HALF_CAR: Form = Form {
    elements: Known { coulomb: false, ..TWO_AXLES.elements },
    coordinates: 4,
    bare: false,
    passive: false,
    ..TWO_AXLES
};

impl Form {
    fn of<L: Lane>(modal: &ModalSolve<L>, units: &[Unit<L>], elements: &Elements<L>) -> Self {
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

    /// Number of contacts.
    #[inline(always)]
    const fn contacts(self) -> usize {
        self.elements.contacts
    }

    /// Number of elements.
    #[inline(always)]
    const fn all(self) -> usize {
        self.elements.contacts + self.elements.rubbing
    }

    /// Where each part of a [`Coupling`] begins, and where the last ends.
    #[inline(always)]
    const fn parts(self) -> [usize; 5] {
        let (each, n) = (self.contacts() * self.modes, self.all());
        [each, 2 * each, 3 * each, 3 * each + n * n, 3 * each + n * n + n * HELD]
    }

    /// How many numbers a [`Coupling`] has.
    #[inline(always)]
    const fn width(self) -> usize {
        self.parts()[4]
    }

    /// Contacts, friction elements and coordinates of a vehicle.
    #[inline(always)]
    fn part<L>(self, unit: &Unit<L>) -> [Range<usize>; 3] {
        match self.vehicles {
            1 => [0..self.contacts(), self.contacts()..self.all(), 0..self.coordinates],
            _ => [unit.contacts.clone(), unit.rubbing.clone(), unit.coordinates.clone()],
        }
    }
}

/// The time step: constant coefficients of a run, and scratch so that stepping allocates nothing.
#[derive(Debug, Clone)]
pub struct Stepper<L> {
    form: Form,
    newmark: Newmark<L>,
    modal: ModalSolve<L>,
    units: Vec<Unit<L>>,
    elements: Elements<L>,
    /// What the vehicles add to the compliance, by rows.
    above: Vec<L>,
    surge_settled: L,
    travel: Vec<Coordinate<L>>,
    guess: Vec<Coordinate<L>>,
    along: Vec<L>,
    /// The coupling without a bridge, which is the same everywhere.
    alone: Vec<L>,
    room: Room<Vec<Coordinate<L>>, Vec<L>, Vec<Prepared<L>>>,
}

/// Room to work in for a step, of any kind that can be taken as slices: arrays where their size is known, so that what is
/// in them need not be written to memory.
#[derive(Debug, Clone, Default)]
struct Room<C, N, P> {
    /// Modes and vehicles at the end of the step if accelerations there were zero.
    predicted: C,
    bodies: C,
    /// Forces with which the modes resist as predicted.
    resisting: N,
    /// Modal forces under the static axle loads, and accelerations.
    forces: N,
    accelerations: N,
    /// The end of the step under the static axle loads.
    loaded: C,
    /// What unit modal accelerations do to δ of a contact.
    senses: N,
    coupling: N,
    /// What the elements follow, but for the increments of the forces.
    offset: N,
    /// The increments, and those of the next sweep.
    increments: N,
    fresh: N,
    prepared: P,
}

/// The room that is borrowed for a step.
type Desk<'r, L> = Room<&'r mut [Coordinate<L>], &'r mut [L], &'r mut [Prepared<L>]>;

impl<C, N, P> Room<C, N, P> {
    #[inline(always)]
    fn desk<L>(&mut self) -> Desk<'_, L>
    where
        C: AsMut<[Coordinate<L>]>,
        N: AsMut<[L]>,
        P: AsMut<[Prepared<L>]>,
    {
        Room {
            predicted: self.predicted.as_mut(),
            bodies: self.bodies.as_mut(),
            resisting: self.resisting.as_mut(),
            forces: self.forces.as_mut(),
            accelerations: self.accelerations.as_mut(),
            loaded: self.loaded.as_mut(),
            senses: self.senses.as_mut(),
            coupling: self.coupling.as_mut(),
            offset: self.offset.as_mut(),
            increments: self.increments.as_mut(),
            fresh: self.fresh.as_mut(),
            prepared: self.prepared.as_mut(),
        }
    }
}

/// Room for the usual forms.
type UsualRoom<L> = Room<[Coordinate<L>; USUAL.modes], [L; USUAL.width()], [Prepared<L>; USUAL.all()]>;

// Vehicles find room there too.
const _: () = assert!(USUAL.coordinates <= USUAL.modes);

impl<L: Lane> UsualRoom<L> {
    #[inline(always)]
    fn usual() -> Self {
        let (rest, zeros) = ([Coordinate::rest(); USUAL.modes], [L::splat(0.0); USUAL.width()]);
        Room {
            predicted: rest,
            bodies: rest,
            resisting: zeros,
            forces: zeros,
            accelerations: zeros,
            loaded: rest,
            senses: zeros,
            coupling: zeros,
            offset: zeros,
            increments: zeros,
            fresh: zeros,
            prepared: [Prepared::nothing(); USUAL.all()],
        }
    }
}

/// How the contacts feel the bridge and each other where they stand: what a step needs that depends on the geometry and
/// the parameters alone, not on the state.
struct Coupling<'r, L> {
    /// Φ⁰, contact by contact.
    shapes: &'r [L],
    /// Modal forces under the static axle loads, contact by contact.
    pressing: &'r [L],
    /// Modal accelerations under unit axle loads, contact by contact.
    receptance: &'r [L],
    /// What the increments of the forces take off what the elements follow, by rows.
    compliance: &'r [L],
    /// What holds of each element.
    held: &'r [L],
}

impl<'r, L> Coupling<'r, L> {
    #[inline(always)]
    fn of(form: Form, numbers: &'r [L]) -> Self {
        let [a, b, c, d, e] = form.parts();
        Coupling {
            shapes: &numbers[..a],
            pressing: &numbers[a..b],
            receptance: &numbers[b..c],
            compliance: &numbers[c..d],
            held: &numbers[d..e],
        }
    }
}

/// What the vehicles add to the compliance of the elements, by rows.
fn above<L: Lane>(newmark: &Newmark<L>, units: &[Unit<L>], elements: &Elements<L>) -> Vec<L> {
    let n = elements.known().all();
    let mut above = vec![L::splat(0.0); n * n];
    // A vehicle without coordinates adds nothing.
    for unit in units.iter().filter(|unit| unit.rig.size > 0) {
        for own in 0..unit.rig.elements {
            let k = unit.element(own);
            let factor = match elements.contacts.get(k).map(|contact| contact.weights) {
                Some(weights) => weights.value * newmark.new + weights.rate * newmark.half_h,
                None => newmark.new,
            };
            for (other, coupling) in unit.rig.coupling(own).iter().enumerate() {
                above[k * n + unit.element(other)] = factor * *coupling;
            }
        }
    }
    above
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
                pull: L::splat(match vehicle.propulsion {
                    Propulsion::Prescribed => 0.0,
                    Propulsion::Rolling => -gravity * vehicle.grade,
                }),
                stand: (h == 0.0 && q > 0).then(|| Stand::new(assembly, gravity, !lift_off)),
                brakes: None,
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
        let form = Form::of(&modal, &units, &elements);
        let (modes, contacts, n) = (form.modes, form.contacts(), form.all());
        let zeros = |count: usize| vec![L::splat(0.0); count];
        let rest = |count: usize| vec![Coordinate::rest(); count];
        let mut stepper = Stepper {
            above: above(&newmark, &units, &elements),
            travel: rest(units.len()),
            guess: rest(form.coordinates),
            along: zeros(contacts),
            alone: Vec::new(),
            room: Room {
                predicted: rest(modes),
                bodies: rest(form.coordinates),
                resisting: zeros(modes),
                forces: zeros(modes),
                accelerations: zeros(modes),
                loaded: rest(modes),
                senses: zeros(modes),
                coupling: zeros(form.width()),
                offset: zeros(n),
                increments: zeros(n),
                fresh: zeros(n),
                prepared: vec![Prepared::nothing(); n],
            },
            form,
            newmark,
            modal,
            units,
            elements,
            surge_settled,
        };
        stepper.stand_alone();
        stepper
    }

    /// Works out how the elements are coupled without a bridge, if there is none.
    fn stand_alone(&mut self) {
        if self.form.modes == 0 {
            let mut alone = vec![L::splat(0.0); self.form.width()];
            self.press(self.form, &mut alone);
            self.alone = alone;
        }
    }

    /// Static equilibrium with the contacts where `geometry` has them, on the road there and with the friction of the
    /// static state, the bridge at rest and straight, each vehicle at its speed.
    ///
    /// An axle that stands on the bridge at the start loads it suddenly, as a slope of the road does a damped tyre; the first
    /// accelerations say so. To find them this stepper must have been made for steps of zero length.
    #[inline(never)]
    pub fn start(&mut self, speeds: &[L], geometry: &impl Geometry<L>) -> Result<State<L>, Unsettled> {
        let zero = L::splat(0.0);
        let contacts = self.elements.contacts.iter().map(|c| c.at_rest());
        let form = self.form;
        let mut state = State {
            modes: vec![Coordinate::rest(); form.modes],
            coordinates: vec![Coordinate::rest(); form.coordinates],
            travel: speeds.iter().map(|&v| Coordinate { x: zero, v, a: zero }).collect(),
            increments: vec![zero; form.all()],
            strokes: contacts.chain(self.elements.rubbing.iter().map(|r| r.at_rest())).collect(),
            along: vec![zero; form.contacts()],
            along_before: vec![zero; form.contacts()],
        };
        let mut room = self.room.clone();
        let mut desk = room.desk();
        let stood = self.stand(geometry)?;
        self.predict(form, &state, &mut desk);
        self.push_along(form, &mut state, geometry, &desk);
        self.begin(form, &mut state, geometry, &stood, &mut desk)?;
        // The loads of the first instant do not depend on how the vehicles surge under them.
        for (u, unit) in self.units.iter_mut().enumerate().filter(|(_, unit)| unit.propulsion == Propulsion::Rolling) {
            let mut force = zero;
            for (own, contact) in unit.contacts.clone().enumerate() {
                state.along[contact] = along(unit, own, contact, &self.elements, &state, geometry);
                force = force + state.along[contact];
            }
            state.travel[u].a = force / unit.rig.total_mass + unit.pull;
            let bodies = &desk.bodies[unit.coordinates.clone()];
            unit.rig.surge(&self.newmark, bodies, &state.along[unit.contacts.clone()]);
        }
        self.begin(form, &mut state, geometry, &stood, &mut desk)?;
        for ((stroke, contact), delta) in state.strokes.iter_mut().zip(&self.elements.contacts).zip(&*desk.offset) {
            *stroke = contact.at_onset(*delta);
        }
        for (unit, stood) in self.units.iter().zip(stood) {
            let Some(stood) = stood else { continue };
            for (contact, shortening) in unit.contacts.clone().zip(stood.shortenings) {
                state.strokes[contact].shortening = shortening;
            }
            for (own, rubbing) in (unit.contacts.len()..).zip(unit.rubbing.clone()) {
                state.strokes[rubbing].shortening = unit.rig.shortening(own, &stood.coordinates);
            }
            for (coordinate, stood) in state.coordinates[unit.coordinates.clone()].iter_mut().zip(stood.coordinates) {
                coordinate.x = stood;
            }
        }
        state.along_before.copy_from_slice(&state.along);
        Ok(state)
    }

    /// How each vehicle stands where `geometry` has its contacts; nothing of one on level ground, or that has nothing to
    /// settle.
    fn stand(&self, geometry: &impl Geometry<L>) -> Result<Vec<Option<Stood<L>>>, Unsettled> {
        let zero = L::splat(0.0);
        let of = |unit: &Unit<L>| {
            let Some(stand) = &unit.stand else { return Ok(None) };
            let elevations: Vec<L> = unit.contacts.clone().map(|k| geometry.surface(k).elevation).collect();
            if !elevations.iter().any(|r| L::any(r.less(zero) | zero.less(*r))) {
                return Ok(None);
            }
            stand.on(&elevations).map(Some).ok_or(Unsettled::ContactForces)
        };
        self.units.iter().map(of).collect()
    }

    /// Forces and accelerations of the first instant: what moves the vehicles out of the equilibrium in which they stand.
    fn begin(
        &mut self,
        form: Form,
        state: &mut State<L>,
        geometry: &impl Geometry<L>,
        stood: &[Option<Stood<L>>],
        desk: &mut Desk<'_, L>,
    ) -> Result<(), Unsettled> {
        self.feel(form, geometry, None, desk);
        let wheels = self.elements.contacts.iter().enumerate().filter(|(_, contact)| !contact.constant);
        for (k, contact) in wheels {
            desk.offset[k] = desk.offset[k] - contact.weights.value * geometry.surface(k).elevation;
        }
        self.answer(form, state, L::never(), desk)?;
        let receptance = Coupling::of(form, desk.coupling).receptance;
        for (unit, stood) in self.units.iter().zip(stood) {
            for (k, load) in unit.contacts.clone().zip(stood.iter().flat_map(|stood| &stood.loads)) {
                state.increments[k] = self.elements.contacts[k].floor().larger(state.increments[k] + *load);
                for (m, mode) in state.modes.iter_mut().enumerate() {
                    mode.a = mode.a + receptance[k * form.modes + m] * *load;
                }
            }
        }
        Ok(())
    }

    /// From one stepper for each sample, of the same vehicles, modes and scheme but for their numbers.
    pub fn gather(each: &[&Stepper<f64>]) -> Self {
        let first = each[0];
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
                pull: L::from_fn(|s| each[s].units[u].pull),
                stand: unit
                    .stand
                    .is_some()
                    .then(|| Stand::gather(&each.iter().filter_map(|s| s.units[u].stand.as_ref()).collect::<Vec<_>>())),
                brakes: None,
            }
        });
        let contacts = (0..first.elements.contacts.len())
            .map(|k| Contact::gather(&each.iter().map(|s| &s.elements.contacts[k]).collect::<Vec<_>>()));
        let rubbing = (0..first.elements.rubbing.len())
            .map(|k| Rubbing::gather(&each.iter().map(|s| &s.elements.rubbing[k]).collect::<Vec<_>>()));
        Stepper::of(
            Newmark::gather(&each.iter().map(|s| &s.newmark).collect::<Vec<_>>()),
            ModalSolve::gather(&each.iter().map(|s| &s.modal).collect::<Vec<_>>()),
            units.collect(),
            Elements::new(contacts.collect(), rubbing.collect()),
            L::from_fn(|s| each[s].surge_settled),
        )
    }

    /// What samples must have in common to be gathered: in these their steps take other ways, not only other numbers.
    pub fn ways(&self) -> Vec<bool> {
        let contacts = self.elements.contacts.iter().flat_map(Contact::ways);
        let vehicles = self.units.iter().flat_map(|unit| [unit.rig.bare(), unit.rig.surges()]);
        let rubbing = self.elements.rubbing.iter().flat_map(Rubbing::ways);
        contacts.chain(vehicles).chain([self.modal.classical, self.modal.apart]).chain(rubbing).collect()
    }

    /// Static loads of all contacts [N].
    pub fn static_loads(&self) -> Vec<L> {
        self.elements.contacts.iter().map(|c| c.static_load).collect()
    }

    /// Takes a vehicle that has come to rest as standing: its wheels stay where they are, held against the grade, and it
    /// rocks about them.
    pub fn hold(&mut self, vehicle: usize, standing: Rig<L>) {
        self.units[vehicle].rig = standing;
        self.units[vehicle].propulsion = Propulsion::Prescribed;
        self.above = above(&self.newmark, &self.units, &self.elements);
        self.form = Form::of(&self.modal, &self.units, &self.elements);
        self.stand_alone();
    }

    /// The bridge by itself.
    pub fn vibration(&self) -> Vibration<L> {
        Vibration::new(self.newmark, self.modal.clone())
    }

    /// How the contacts feel the bridge where `geometry` has them, as numbers for [`Geometry::coupling`].
    pub fn coupling(&mut self, geometry: &impl Geometry<L>) -> &[L] {
        let mut room = std::mem::take(&mut self.room);
        self.couple(self.form, geometry, &mut room.desk());
        self.room = room;
        &self.room.coupling
    }

    /// Puts a vehicle's brakes on, or says how far they are.
    pub fn brake(&mut self, vehicle: usize, brakes: Brakes<L>) {
        self.units[vehicle].brakes = Some(brakes);
    }

    /// Advances the state by one step.
    #[inline(always)]
    pub fn advance(&mut self, state: &mut State<L>, geometry: &mut impl Geometry<L>) -> Result<(), Unsettled> {
        if self.units.iter().any(|unit| unit.propulsion == Propulsion::Rolling) {
            return self.roll(state, geometry);
        }
        let form = Form { passive: self.form.passive || self.form.bare && geometry.steady(), ..self.form };
        geometry.advance();
        let geometry = &*geometry;
        let known = geometry.coupling();
        // Debug builds know none: forms change no bit and take most of the time to compile.
        let mut usual = Room::usual();
        match (form, known) {
            (TWO_AXLES, _) if !cfg!(debug_assertions) => {
                return self.drive(TWO_AXLES, state, geometry, None, &mut usual.desk());
            }
            (USUAL, Some(_)) if !cfg!(debug_assertions) => {
                return self.drive(USUAL, state, geometry, known, &mut usual.desk());
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

    /// One step of vehicles all of whose motion is prescribed, to where `geometry` has them; with the coupling there, if
    /// that is `known`.
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
        self.react(form, state, geometry, L::never(), known, desk)?;
        self.settle(form, state, desk);
        Ok(())
    }

    /// One step with vehicles that roll freely, whose axle positions follow from it. Only single samples do, so it need
    /// not be there once more for every kind of vectors.
    #[inline(never)]
    fn roll(&mut self, state: &mut State<L>, geometry: &mut impl Geometry<L>) -> Result<(), Unsettled> {
        let form = self.form;
        let mut room = std::mem::take(&mut self.room);
        let rolled = self.roll_at(form, state, geometry, &mut room.desk());
        self.room = room;
        rolled
    }

    fn roll_at(
        &mut self,
        form: Form,
        state: &mut State<L>,
        geometry: &mut impl Geometry<L>,
        desk: &mut Desk<'_, L>,
    ) -> Result<(), Unsettled> {
        self.predict(form, state, desk);
        geometry.advance();
        self.guess_along(state);
        for (u, unit) in self.units.iter().enumerate() {
            self.travel[u] = self.newmark.predict(state.travel[u]);
            if unit.propulsion == Propulsion::Rolling {
                let guess = &mut self.guess[..unit.rig.size];
                let coordinates = unit.coordinates.clone();
                Rig::guess(&self.newmark, &desk.bodies[coordinates.clone()], &state.coordinates[coordinates], guess);
                let force = unit.contacts.clone().fold(L::splat(0.0), |sum, contact| sum + state.along[contact]);
                let travel = self.newmark.correct(self.travel[u], force / unit.rig.total_mass + unit.pull);
                place(unit, travel, guess, geometry, true);
            }
        }
        self.push_along(form, state, geometry, desk);
        let mut settled = L::never();
        for _ in 0..PASSES {
            self.react(form, state, geometry, settled, None, desk)?;
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
                state.travel[u] = self.newmark.correct(self.travel[u], force / unit.rig.total_mass + unit.pull);
                let coordinates = &state.coordinates[unit.coordinates.clone()];
                moving = moving | place(unit, state.travel[u], coordinates, geometry, false);
                moving = moving | !change.less(self.surge_settled * unit.rig.total_mass);
            }
            // A settled lane is left as it is, so that further passes repeat it bit for bit.
            settled = !moving;
            if L::all(settled) {
                self.settle(form, state, desk);
                return Ok(());
            }
            for unit in self.units.iter_mut().filter(|unit| unit.propulsion == Propulsion::Rolling) {
                for contact in unit.contacts.clone() {
                    state.along[contact] = L::select(moving, self.along[contact], state.along[contact]);
                }
                let bodies = &desk.bodies[unit.coordinates.clone()];
                unit.rig.surge(&self.newmark, bodies, &state.along[unit.contacts.clone()]);
            }
        }
        Err(Unsettled::AxlePositions)
    }

    /// Everything at the end of the step if accelerations there were zero, and how the modes resist that.
    #[inline(always)]
    fn predict(&mut self, form: Form, state: &State<L>, desk: &mut Desk<'_, L>) {
        for unit in &mut self.units[..form.vehicles] {
            let [_, _, coordinates] = form.part(unit);
            let bodies = &mut desk.bodies[coordinates.clone()];
            unit.rig.predict(&self.newmark, &state.coordinates[coordinates], bodies, form.passive);
        }
        let predicted = &mut desk.predicted[..form.modes];
        for (predicted, mode) in predicted.iter_mut().zip(&state.modes[..form.modes]) {
            *predicted = self.newmark.predict(*mode);
        }
        self.modal.resist(form.classical, predicted, &mut desk.resisting[..form.modes]);
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
    fn push_along(&mut self, form: Form, state: &mut State<L>, geometry: &impl Geometry<L>, desk: &Desk<'_, L>) {
        for unit in &mut self.units[..form.vehicles] {
            if unit.propulsion == Propulsion::Prescribed {
                for (contact, share) in unit.contacts.clone().zip(&unit.shares) {
                    let gain = L::splat(unit.direction) * geometry.motion(contact).a;
                    state.along[contact] = (gain - unit.pull) * *share;
                }
            }
            let bodies = &desk.bodies[unit.coordinates.clone()];
            unit.rig.surge(&self.newmark, bodies, &state.along[unit.contacts.clone()]);
        }
    }

    /// Solves for the unknown forces and moves bridge and vehicles accordingly, in lanes that are not `frozen`; with
    /// the coupling where `geometry` has the contacts, if that is `known`.
    #[inline(always)]
    fn react(
        &mut self,
        form: Form,
        state: &mut State<L>,
        geometry: &impl Geometry<L>,
        frozen: L::Mask,
        known: Option<&[f64]>,
        desk: &mut Desk<'_, L>,
    ) -> Result<(), Unsettled> {
        self.feel(form, geometry, known, desk);
        self.answer(form, state, frozen, desk)
    }

    /// What the elements follow without the increments of the forces, and how those are coupled.
    #[inline(always)]
    fn feel(&self, form: Form, geometry: &impl Geometry<L>, known: Option<&[f64]>, desk: &mut Desk<'_, L>) {
        match known {
            _ if form.modes == 0 => desk.coupling[..form.width()].copy_from_slice(&self.alone[..form.width()]),
            Some(numbers) => {
                for (own, number) in desk.coupling[..form.width()].iter_mut().zip(&numbers[..form.width()]) {
                    *own = L::splat(*number);
                }
            }
            None => self.couple(form, geometry, desk),
        }
        self.sense(form, geometry, desk);
        self.sit(form, desk);
    }

    /// Solves for the increments and moves bridge and vehicles under them, in lanes that are not `frozen`.
    #[inline(always)]
    fn answer(
        &self,
        form: Form,
        state: &mut State<L>,
        frozen: L::Mask,
        desk: &mut Desk<'_, L>,
    ) -> Result<(), Unsettled> {
        let Coupling { compliance, held, receptance, .. } = Coupling::of(form, desk.coupling);
        let (prepared, strokes) = (&mut *desk.prepared, &state.strokes);
        self.elements.prepare(form.elements, held, strokes, prepared);
        let increments = &mut desk.increments[..form.all()];
        increments.copy_from_slice(&state.increments[..form.all()]);
        let room = [&mut *increments, &mut *desk.fresh];
        if !self.elements.solve(form.elements, desk.offset, compliance, strokes, prepared, room, frozen) {
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
            let [contacts, rubbing, coordinates] = form.part(unit);
            let forces = [&increments[contacts], &increments[rubbing]];
            let (bodies, state) = (&desk.bodies[coordinates.clone()], &mut state.coordinates[coordinates]);
            unit.rig.correct(&self.newmark, bodies, forces, state, form.passive);
        }
        Ok(())
    }

    /// Commits the suspensions to the end of the step; what moves as prescribed goes on.
    #[inline(always)]
    fn settle(&self, form: Form, state: &mut State<L>, desk: &Desk<'_, L>) {
        let compliance = Coupling::of(form, desk.coupling).compliance;
        let (increments, strokes) = (&state.increments, &mut state.strokes);
        self.elements.settle(form.elements, desk.offset, compliance, desk.prepared, increments, strokes);
    }

    /// Works out how the contacts feel the bridge where they stand.
    #[inline(always)]
    fn couple(&self, form: Form, geometry: &impl Geometry<L>, desk: &mut Desk<'_, L>) {
        let (modes, contacts, n) = (form.modes, form.contacts(), form.all());
        let Newmark { h, half_h, new: beta_h2, .. } = self.newmark;
        let [pressing, receptance, compliance, ..] = form.parts();
        let elements = &self.elements.contacts[..contacts];
        let numbers = &mut desk.coupling[..form.width()];
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
        self.press(form, numbers);
    }

    /// Works out what follows from the compliance, of which the bridge's part is there already.
    #[inline(always)]
    fn press(&self, form: Form, numbers: &mut [L]) {
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

    /// The bridge below the contacts: where it would be under the static loads, what it does under others.
    #[inline(always)]
    fn sense(&self, form: Form, geometry: &impl Geometry<L>, desk: &mut Desk<'_, L>) {
        let (modes, contacts) = (form.modes, form.contacts());
        let Coupling { shapes, pressing, .. } = Coupling::of(form, desk.coupling);
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
    fn sit(&self, form: Form, desk: &mut Desk<'_, L>) {
        let offset = &mut desk.offset[..form.all()];
        offset[form.contacts()..].fill(L::splat(0.0));
        for unit in &self.units[..form.vehicles] {
            let [contacts, rubbing, coordinates] = form.part(unit);
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
