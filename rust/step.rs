//! One time step of bridge and vehicle together, written once for every kind of lane.
//!
//! Newmark's method with γ = ½ for the modal coordinates and the body; everything at the same instant t_{n+1}. The
//! modes are coupled to the body only through the contact forces, so these are the unknowns: d_k = u_k − Σ S_kj p_j.

use faer::Mat;

use crate::contact::{self, Contact};
use crate::lane::Lane;
use crate::vehicle::Vehicle;

/// Most passes in which axle positions and surge follow the corrected state; two or three are usual.
const PASSES: usize = 50;

/// Change of the surge [m/s²] from pass to pass at which it counts as found: what remains is a small fraction of it.
const SURGE_SETTLED: f64 = 1e-8;

/// Where the axles stand: mode shapes under them, from a table shared by all lanes or evaluated as the body moves.
pub trait Geometry<L: Lane> {
    /// Moves on by one step, to where the predicted travel and pitch of the body put the axles.
    fn predict(&mut self, travel: L, pitch: L);

    /// Lets the axles follow the corrected travel and pitch: lanes in which one had still to move. In all other lanes
    /// nothing changes, to the bit.
    fn follow(&mut self, travel: L, pitch: L) -> L::Mask;

    /// Φ⁰: the mode's deflection under the axle [kg^-½], zero off the bridge.
    fn shape(&self, axle: usize, mode: usize) -> L;

    /// Slope of the mode under the axle [kg^-½/m].
    fn slope(&self, axle: usize, mode: usize) -> L;

    /// Position of the axle from the left end of the bridge [m].
    fn position(&self, axle: usize) -> L;
}

/// A coordinate with its first and second time derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinate<L> {
    /// Value.
    pub x: L,
    /// Velocity.
    pub v: L,
    /// Acceleration.
    pub a: L,
}

impl<L: Lane> Coordinate<L> {
    /// At rest at zero.
    pub fn rest() -> Self {
        let zero = L::splat(0.0);
        Coordinate { x: zero, v: zero, a: zero }
    }
}

/// The state of bridge and vehicle at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct State<L> {
    /// Modal coordinates A [m kg^½].
    pub modes: Vec<Coordinate<L>>,
    /// Body, down from its static position [m].
    pub heave: Coordinate<L>,
    /// Body, nose down [rad].
    pub pitch: Coordinate<L>,
    /// Centre of mass along the road, from the left end of the bridge [m].
    pub travel: Coordinate<L>,
    /// Axle loads less their static values [N].
    pub increments: Vec<L>,
    /// Suspension shortenings since the static state [m].
    pub shortenings: Vec<L>,
    /// Friction forces [N].
    pub friction: Vec<L>,
}

/// Newmark's coefficients with γ = ½.
#[derive(Debug, Clone, Copy)]
struct Newmark<L> {
    h: L,
    half_h: L,
    /// h² (½ − β).
    old: L,
    /// h² β.
    new: L,
}

impl<L: Lane> Newmark<L> {
    fn predict(&self, c: Coordinate<L>) -> Coordinate<L> {
        Coordinate { x: c.x + self.h * c.v + self.old * c.a, v: c.v + self.half_h * c.a, a: c.a }
    }

    fn correct(&self, predicted: Coordinate<L>, a: L) -> Coordinate<L> {
        Coordinate { x: predicted.x + self.new * a, v: predicted.v + self.half_h * a, a }
    }
}

/// Damping of the included modes, D = ΦᵀCΦ.
#[derive(Debug, Clone)]
pub enum ModalDamping {
    /// Ratios to critical, one per mode: D = diag(2ζω).
    Classical(Vec<f64>),
    /// Full D [1/s].
    Coupled(Mat<f64>),
}

/// How modal accelerations follow from modal forces: (I + ½hD + βh²Ω²)⁻¹.
#[derive(Debug, Clone)]
enum ModalSolve<L> {
    Diagonal { damping: Vec<L>, inverse: Vec<L> },
    Full { damping: Mat<f64>, inverse: Mat<f64> },
}

impl<L: Lane> ModalSolve<L> {
    fn new(omega: &[f64], damping: &ModalDamping, h: f64, beta: f64) -> Self {
        match damping {
            ModalDamping::Classical(ratios) => {
                let d: Vec<f64> = omega.iter().zip(ratios).map(|(w, z)| 2.0 * z * w).collect();
                let inverse = omega.iter().zip(&d).map(|(w, d)| 1.0 / (1.0 + 0.5 * h * d + beta * h * h * w * w));
                ModalSolve::Diagonal {
                    inverse: inverse.map(L::splat).collect(),
                    damping: d.into_iter().map(L::splat).collect(),
                }
            }
            ModalDamping::Coupled(d) => {
                let n = omega.len();
                let matrix = Mat::from_fn(n, n, |i, j| {
                    0.5 * h * d[(i, j)] + if i == j { 1.0 + beta * h * h * omega[i].powi(2) } else { 0.0 }
                });
                use faer::linalg::solvers::DenseSolveCore;
                ModalSolve::Full { damping: d.clone(), inverse: matrix.partial_piv_lu().inverse() }
            }
        }
    }

    fn damping_force(&self, mode: usize, predicted: &[Coordinate<L>]) -> L {
        match self {
            ModalSolve::Diagonal { damping, .. } => damping[mode] * predicted[mode].v,
            ModalSolve::Full { damping, .. } => {
                predicted.iter().enumerate().fold(L::splat(0.0), |sum, (j, c)| sum + L::splat(damping[(mode, j)]) * c.v)
            }
        }
    }

    fn apply(&self, forces: &[L], accelerations: &mut [L]) {
        match self {
            ModalSolve::Diagonal { inverse, .. } => {
                for ((a, f), e) in accelerations.iter_mut().zip(forces).zip(inverse) {
                    *a = *e * *f;
                }
            }
            ModalSolve::Full { inverse, .. } => {
                for (i, a) in accelerations.iter_mut().enumerate() {
                    *a = forces
                        .iter()
                        .enumerate()
                        .fold(L::splat(0.0), |sum, (j, f)| sum + L::splat(inverse[(i, j)]) * *f);
                }
            }
        }
    }
}

fn dot<L: Lane>(a: &[L], b: &[L]) -> L {
    a.iter().zip(b).fold(L::splat(0.0), |sum, (a, b)| sum + *a * *b)
}

/// The vehicle of one sample, as the step sees it.
#[derive(Debug, Clone)]
pub struct Body<L> {
    /// Mass [kg].
    pub mass: L,
    /// Pitch inertia [kg m²].
    pub pitch_inertia: L,
    /// Height of the centre of mass above the road [m].
    pub cg_height: L,
    /// Laws of the contact forces, axle by axle.
    pub contacts: Vec<Contact<L>>,
    /// Distances of the axles ahead of the centre of mass [m].
    pub arms: Vec<L>,
}

impl<L: Lane> Body<L> {
    /// The same vehicle in every lane, under gravity [m/s²].
    pub fn new(vehicle: &Vehicle, gravity: f64) -> Self {
        let loads = vehicle.static_loads(gravity);
        Body {
            mass: L::splat(vehicle.mass()),
            pitch_inertia: L::splat(vehicle.pitch_inertia()),
            cg_height: L::splat(vehicle.cg_height()),
            contacts: vehicle.axles().iter().zip(loads).map(|(axle, load)| Contact::new(axle, load)).collect(),
            arms: vehicle.axles().iter().map(|axle| L::splat(axle.position)).collect(),
        }
    }
}

/// Why a step failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unsettled {
    /// The coupled contact forces.
    ContactForces,
    /// The positions of the axles.
    AxlePositions,
}

/// The time step: constant coefficients of a run, and scratch so that stepping allocates nothing.
#[derive(Debug, Clone)]
pub struct Stepper<L> {
    newmark: Newmark<L>,
    omega2: Vec<L>,
    modal: ModalSolve<L>,
    body: Body<L>,
    /// Whether the vehicle rolls freely along the bridge (constant traction) instead of at a prescribed motion.
    rolling: bool,
    /// Accelerations of the body at the axles under unit axle loads, 1/m + a_i a_j/J, by rows [1/kg].
    body_receptance: Vec<L>,
    predicted: Vec<Coordinate<L>>,
    /// Modal accelerations without axle loads.
    free: Vec<L>,
    /// Φ⁰, axle by axle.
    shapes: Vec<L>,
    /// Modal accelerations under unit axle loads, axle by axle.
    receptance: Vec<L>,
    compliance: Vec<L>,
    offset: Vec<L>,
    forces: Vec<L>,
}

impl<L: Lane> Stepper<L> {
    /// For modes of circular frequencies `omega` [rad/s], steps of `h` [s] and Newmark's `beta`.
    pub fn new(omega: &[f64], damping: &ModalDamping, body: Body<L>, rolling: bool, h: f64, beta: f64) -> Self {
        let (modes, axles) = (omega.len(), body.contacts.len());
        let zero = L::splat(0.0);
        let at_axles = |a: &L, b: &L| L::splat(1.0) / body.mass + *a * *b / body.pitch_inertia;
        let body_receptance = body.arms.iter().flat_map(|a| body.arms.iter().map(move |b| at_axles(a, b))).collect();
        Stepper {
            body_receptance,
            newmark: Newmark {
                h: L::splat(h),
                half_h: L::splat(0.5 * h),
                old: L::splat(h * h * (0.5 - beta)),
                new: L::splat(h * h * beta),
            },
            omega2: omega.iter().map(|w| L::splat(w * w)).collect(),
            modal: ModalSolve::new(omega, damping, h, beta),
            body,
            rolling,
            predicted: vec![Coordinate::rest(); modes],
            free: vec![zero; modes],
            shapes: vec![zero; modes * axles],
            receptance: vec![zero; modes * axles],
            compliance: vec![zero; axles * axles],
            offset: vec![zero; axles],
            forces: vec![zero; modes],
        }
    }

    /// Static equilibrium on a smooth road with the axles where `geometry` has them, the bridge at rest.
    ///
    /// An axle that stands on the bridge at the start loads it suddenly; the first accelerations say so.
    pub fn start(&self, travel: L, speed: L, geometry: &impl Geometry<L>) -> State<L> {
        let zero = L::splat(0.0);
        let modes = (0..self.omega2.len()).map(|m| {
            let force = self.body.contacts.iter().enumerate();
            let a = force.fold(zero, |sum, (k, c)| sum + geometry.shape(k, m) * c.static_load);
            Coordinate { a, ..Coordinate::rest() }
        });
        State {
            modes: modes.collect(),
            heave: Coordinate::rest(),
            pitch: Coordinate::rest(),
            travel: Coordinate { x: travel, v: speed, a: zero },
            increments: vec![zero; self.body.contacts.len()],
            shortenings: vec![zero; self.body.contacts.len()],
            friction: self.body.contacts.iter().map(|c| c.initial).collect(),
        }
    }

    /// Advances the state by one step.
    pub fn advance(&mut self, state: &mut State<L>, geometry: &mut impl Geometry<L>) -> Result<(), Unsettled> {
        let heave = self.newmark.predict(state.heave);
        let pitch = self.newmark.predict(state.pitch);
        let travel = self.newmark.predict(state.travel);
        for (predicted, mode) in self.predicted.iter_mut().zip(&state.modes) {
            *predicted = self.newmark.predict(*mode);
        }
        for m in 0..self.predicted.len() {
            let resisting = self.modal.damping_force(m, &self.predicted) + self.omega2[m] * self.predicted[m].x;
            self.forces[m] = -resisting;
        }
        self.modal.apply(&self.forces, &mut self.free);
        geometry.predict(travel.x, pitch.x);

        let mut surge = state.travel.a;
        let mut settled = L::never();
        for _ in 0..PASSES {
            // The ground drags at road level: the body pitches by −h m ẍ about its centre of mass.
            let drag = self.body.cg_height * self.body.mass * surge / self.body.pitch_inertia;
            let drag = if self.rolling { drag } else { L::splat(0.0) };
            self.couple(geometry, heave.x, pitch.x - self.newmark.new * drag);
            let solved = contact::solve(
                &self.body.contacts,
                &self.offset,
                &self.compliance,
                &state.shortenings,
                &mut state.increments,
                settled,
            );
            if !solved {
                return Err(Unsettled::ContactForces);
            }
            self.move_bridge(state);
            let (mut force, mut couple) = (L::splat(0.0), L::splat(0.0));
            for (p, arm) in state.increments.iter().zip(&self.body.arms) {
                force = force - *p;
                couple = couple - *p * *arm;
            }
            state.heave = self.newmark.correct(heave, force / self.body.mass);
            state.pitch = self.newmark.correct(pitch, couple / self.body.pitch_inertia - drag);
            if !self.rolling {
                state.travel = travel;
                self.settle(state);
                return Ok(());
            }
            let next = self.surge(state, geometry);
            state.travel = self.newmark.correct(travel, next);
            let moving = geometry.follow(state.travel.x, state.pitch.x);
            let unsteady = L::splat(SURGE_SETTLED).less((next - surge).magnitude());
            if !L::any(moving | unsteady) {
                self.settle(state);
                return Ok(());
            }
            // A settled lane is left as it is, so that further passes repeat it bit for bit.
            settled = !(moving | unsteady);
            surge = L::select(unsteady, next, surge);
        }
        Err(Unsettled::AxlePositions)
    }

    /// Commits the suspensions to the end of the step.
    fn settle(&self, state: &mut State<L>) {
        for (k, contact) in self.body.contacts.iter().enumerate() {
            let (s, f) = contact.settle(state.increments[k], state.shortenings[k]);
            state.shortenings[k] = s;
            state.friction[k] = f;
        }
    }

    /// Shortenings without load increments `offset`, and what the increments take off them, `compliance`.
    fn couple(&mut self, geometry: &impl Geometry<L>, heave: L, pitch: L) {
        let (modes, axles) = (self.omega2.len(), self.body.contacts.len());
        let beta_h2 = self.newmark.new;
        for (k, shapes) in self.shapes.chunks_exact_mut(modes).enumerate() {
            for (m, shape) in shapes.iter_mut().enumerate() {
                *shape = geometry.shape(k, m);
            }
        }
        let receptances = self.receptance.chunks_exact_mut(modes);
        for (shapes, receptance) in self.shapes.chunks_exact(modes).zip(receptances) {
            self.modal.apply(shapes, receptance);
        }
        let rows = self.compliance.chunks_exact_mut(axles).zip(self.body_receptance.chunks_exact(axles));
        let axles = self.shapes.chunks_exact(modes).zip(&self.body.arms).zip(&mut self.offset).zip(rows);
        for (((shapes, arm), offset), (compliance, body)) in axles {
            let mut d = heave + *arm * pitch;
            for ((shape, predicted), free) in shapes.iter().zip(&self.predicted).zip(&self.free) {
                d = d - *shape * (predicted.x + beta_h2 * *free);
            }
            let others = self.receptance.chunks_exact(modes).zip(&self.body.contacts);
            for (((receptance, contact), body), compliance) in others.zip(body).zip(compliance) {
                let bridge = dot(shapes, receptance);
                d = d - beta_h2 * bridge * contact.static_load;
                *compliance = beta_h2 * (bridge + *body);
            }
            *offset = d;
        }
    }

    fn move_bridge(&mut self, state: &mut State<L>) {
        let modes = self.omega2.len();
        self.forces.copy_from_slice(&self.free);
        let loads = self.body.contacts.iter().zip(&state.increments);
        for (receptance, (contact, increment)) in self.receptance.chunks_exact(modes).zip(loads) {
            let load = contact.static_load + *increment;
            for (a, r) in self.forces.iter_mut().zip(receptance) {
                *a = *a + *r * load;
            }
        }
        for ((mode, predicted), a) in state.modes.iter_mut().zip(&self.predicted).zip(&self.forces) {
            *mode = self.newmark.correct(*predicted, *a);
        }
    }

    /// Acceleration along the road under constant traction: m ẍ = Σ P w' at the axles.
    fn surge(&self, state: &State<L>, geometry: &impl Geometry<L>) -> L {
        let mut force = L::splat(0.0);
        for (k, contact) in self.body.contacts.iter().enumerate() {
            let modes = state.modes.iter().enumerate();
            let slope = modes.fold(L::splat(0.0), |sum, (m, mode)| sum + geometry.slope(k, m) * mode.x);
            force = force + (contact.static_load + state.increments[k]) * slope;
        }
        force / self.body.mass
    }
}
