//! Plane vehicles: rigid bodies on axles, hinged or sprung to each other; trains of forces or masses.
//!
//! The simplest is that of KTN73 Fig. 2: one body on massless axles, each a tyre in series with a suspension that rubs.
//! The parts are in [`body`], the matrices made of them in [`equations`], published vehicles in [`catalogue`].

pub(crate) mod body;
pub mod catalogue;
pub(crate) mod dense;
pub(crate) mod equations;

pub use body::{Axle, Body, BuildUp, Coupling, Friction, STICK, Suspension};
pub use equations::{Assembly, ContactLaw, ContactPoint};

use crate::error::{Error, finite, not_negative, positive};
use crate::float_mode::Standard;
use crate::vehicle::equations::{front_first, positions, prefix};

/// Standard gravity [m/s²].
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// Distance that tells two places apart [m]: far above rounding, far below a wheel.
const SAME: f64 = 1e-6;

/// Most axles of all vehicles that cross together: each presses on each other through the bridge.
pub const MAX_AXLES: usize = 500;

/// Most bodies of a vehicle, and most springs and hinges between them.
const MAX_BODIES: usize = 500;
const MAX_COUPLINGS: usize = 4 * MAX_BODIES;

/// A vehicle that stands on its own: every value allowed, every motion held, every axle loaded.
#[derive(Debug, Clone, PartialEq)]
pub struct Vehicle {
    bodies: Vec<Body>,
    axles: Vec<Axle>,
    /// Positions of a train, as given [m].
    places: Vec<f64>,
    assembly: Assembly,
}

impl Vehicle {
    /// One body of `mass` [kg], pitch inertia about the centre of mass [kg m²], its height above the road [m], and the
    /// axles, front first. A vehicle of one axle stands with its centre of mass above it.
    pub fn new(mass: f64, pitch_inertia: f64, cg_height: f64, axles: Vec<Axle>) -> Result<Self, Error> {
        Vehicle::of_bodies(vec![Body { mass, pitch_inertia, cg_height, axles, couplings: Vec::new() }])
    }

    /// Several bodies, each but the first coupled to earlier ones.
    pub fn of_bodies(bodies: Vec<Body>) -> Result<Self, Error> {
        let _mode = Standard::set();
        if bodies.is_empty() {
            return Err(Error::input("bodies", "[]", "a vehicle needs at least one body"));
        }
        let all = |count: fn(&Body) -> usize| bodies.iter().map(count).sum::<usize>();
        let axles = all(|body| body.axles.len());
        let couplings = all(|body| body.couplings.len());
        let parts = [("bodies", bodies.len(), MAX_BODIES), ("couplings", couplings, MAX_COUPLINGS)];
        for (what, count, most) in [("axles", axles, MAX_AXLES)].into_iter().chain(parts) {
            if count > most {
                let allowed = format!("at most {most} of one vehicle; let several follow each other");
                return Err(Error::input(what, format!("{count} {what}"), allowed));
            }
        }
        for b in 0..bodies.len() {
            check_body(&bodies, b)?;
        }
        let order = front_first(&bodies);
        if order.is_empty() {
            let key = if bodies.len() == 1 { "axles" } else { "bodies" };
            return Err(Error::input(key, "[]", "a vehicle needs at least one axle"));
        }
        check_upright(&bodies)?;
        check_apart(&bodies, &order)?;
        if let [Body { axles, .. }] = &bodies[..]
            && let [axle] = axles[..]
            && axle.position != 0.0
        {
            let allowed = "must be 0: a vehicle of one axle has its centre of mass above it";
            return Err(Error::input("axles[0].position", format!("{} m", axle.position), allowed));
        }
        let assembly = Assembly::of_bodies(&bodies)?;
        let axles = order.iter().map(|&(b, i)| bodies[b].axles[i]).collect();
        Ok(Vehicle { axles, bodies, places: Vec::new(), assembly })
    }

    /// Constant forces [N] at positions ahead of any point [m], front first.
    pub fn force_train(loads: &[f64], positions: &[f64]) -> Result<Self, Error> {
        Vehicle::train("loads", loads, positions, |_| ContactLaw::Force)
    }

    /// Masses [kg] that follow the road, at positions ahead of any point [m], front first.
    pub fn moving_masses(masses: &[f64], positions: &[f64]) -> Result<Self, Error> {
        Vehicle::train("masses", masses, positions, ContactLaw::Mass)
    }

    fn train(key: &str, values: &[f64], positions: &[f64], law: fn(f64) -> ContactLaw) -> Result<Self, Error> {
        let _mode = Standard::set();
        if values.is_empty() {
            return Err(Error::input(key, "[]", "must have at least one value"));
        }
        if positions.len() != values.len() {
            let allowed = format!("must be one for each of the {} {key}", values.len());
            return Err(Error::input("positions", format!("{} values", positions.len()), allowed));
        }
        for (k, (value, position)) in values.iter().zip(positions).enumerate() {
            positive(format!("{key}[{k}]"), *value)?;
            finite(format!("positions[{k}]"), *position)?;
            check_behind(format!("positions[{k}]"), *position, k.checked_sub(1).map(|before| positions[before]))?;
        }
        let laws = values.iter().map(|value| (*value, law(*value))).collect();
        let assembly = Assembly::of_contacts(laws, positions);
        Ok(Vehicle { bodies: Vec::new(), axles: Vec::new(), places: positions.to_vec(), assembly })
    }

    /// A train with other loads [N] or masses [kg] at the same places, to the bit.
    pub fn with_shares(&self, shares: &[f64]) -> Result<Self, Error> {
        match self.assembly.contacts[0].law {
            ContactLaw::Force => Vehicle::force_train(shares, &self.places),
            _ => Vehicle::moving_masses(shares, &self.places),
        }
    }

    /// Whether it is a train of constant forces, which feel nothing of the bridge.
    pub fn is_of_forces(&self) -> bool {
        self.assembly.contacts.iter().all(|contact| contact.law == ContactLaw::Force)
    }

    /// Total mass [kg], unsprung masses included; none of a train of forces.
    pub fn mass(&self) -> f64 {
        self.assembly.total_mass
    }

    /// Pitch inertia of the first body about its centre of mass [kg m²].
    pub fn pitch_inertia(&self) -> f64 {
        self.bodies.first().map_or(0.0, |body| body.pitch_inertia)
    }

    /// Height of the centre of mass of the first body above the road [m].
    pub fn cg_height(&self) -> f64 {
        self.bodies.first().map_or(0.0, |body| body.cg_height)
    }

    /// Bodies, in the order given; none of a train.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Axles of all bodies, front first, each with its position in its own body; none of a train.
    pub fn axles(&self) -> &[Axle] {
        &self.axles
    }

    /// Positions of a train, as given [m]; none of a vehicle of bodies.
    pub fn places(&self) -> &[f64] {
        &self.places
    }

    /// The vehicle as the time step sees it.
    pub fn assembly(&self) -> &Assembly {
        &self.assembly
    }

    /// Distances of the wheel lines ahead of the centre of mass of the whole vehicle [m], front first. A train of forces
    /// has the centre of its loads in its place.
    pub fn positions(&self) -> Vec<f64> {
        self.assembly.contacts.iter().map(|contact| contact.position).collect()
    }

    /// Body and number in it of every axle, front first.
    pub fn axle_order(&self) -> Vec<(usize, usize)> {
        front_first(&self.bodies)
    }

    /// Distance from the first to the last axle [m].
    pub fn wheelbase(&self) -> f64 {
        self.assembly.contacts.last().map_or(0.0, |last| last.behind)
    }

    /// Static axle loads [N] under gravity g [m/s²], front first; those of a train of forces do not depend on it.
    ///
    /// Two axles under one body share its weight by the lever rule, more as springs in series, friction carrying nothing.
    pub fn static_loads(&self, gravity: f64) -> Vec<f64> {
        self.assembly.static_loads(gravity)
    }

    /// Vertical displacement of every body, as rows over the coordinates.
    pub fn heaves(&self) -> Vec<Vec<f64>> {
        self.assembly.bodies.iter().map(|[heave, _]| heave.iter().copied().collect()).collect()
    }

    /// Natural frequencies on rigid ground with every suspension in the given state [Hz], ascending: one for each
    /// coordinate of the assembly.
    pub fn frequencies(&self, suspension: Suspension) -> Vec<f64> {
        self.assembly.vibrations(suspension).0
    }
}

fn check_body(bodies: &[Body], b: usize) -> Result<(), Error> {
    let (body, prefix) = (&bodies[b], prefix(bodies, b));
    let key = |name: &str| format!("{prefix}{name}");
    positive(if bodies.len() == 1 { "vehicle mass".to_string() } else { key("mass") }, body.mass)?;
    positive(key("pitch_inertia"), body.pitch_inertia)?;
    not_negative(key("cg_height"), body.cg_height)?;
    for (k, axle) in body.axles.iter().enumerate() {
        let key = |name: &str| format!("{prefix}axles[{k}].{name}");
        finite(key("position"), axle.position)?;
        not_negative(key("mass"), axle.mass)?;
        positive(key("tyre_stiffness"), axle.tyre_stiffness)?;
        not_negative(key("tyre_damping"), axle.tyre_damping)?;
        positive(key("suspension_stiffness"), axle.suspension_stiffness)?;
        not_negative(key("suspension_damping"), axle.suspension_damping)?;
        check_friction(&axle.friction, axle.suspension_stiffness, &key)?;
        if let (BuildUp::Elastic(stiffness), 0.0) = (axle.friction.build_up, axle.mass) {
            let allowed = "not for a massless axle, whose friction holds it rigidly; give it a mass, or leaf_decay";
            return Err(Error::input(key("stick_stiffness"), format!("{stiffness} N/m"), allowed));
        }
        check_behind(key("position"), axle.position, k.checked_sub(1).map(|before| body.axles[before].position))?;
    }
    check_couplings(bodies, b)
}

fn check_friction(friction: &Friction, spring: f64, key: &dyn Fn(&str) -> String) -> Result<(), Error> {
    let limit = friction.limit;
    if limit.is_nan() || limit < 0.0 {
        let allowed = "must be 0 or more (inf for a locked suspension)";
        return Err(Error::input(key("friction_limit"), limit, allowed));
    }
    finite(key("initial_friction"), friction.initial)?;
    if friction.initial.abs() > limit {
        let allowed = match limit {
            0.0 => "must be 0 where friction_limit is 0".to_string(),
            limit => format!("must lie within the friction limit, -{limit} to {limit} N"),
        };
        return Err(Error::input(key("initial_friction"), format!("{} N", friction.initial), allowed));
    }
    match friction.build_up {
        BuildUp::Rigid => {}
        BuildUp::Elastic(stiffness) => {
            positive(key("stick_stiffness"), stiffness)?;
        }
        BuildUp::Leaf(stroke) => {
            positive(key("leaf_decay"), stroke)?;
            if limit.is_infinite() {
                let allowed = "must be finite with leaf_decay, by which friction goes towards it";
                return Err(Error::input(key("friction_limit"), limit, allowed));
            }
            // On a long stroke the force lags kβ behind the envelope, which is F off the spring: more would drive it.
            let longest = limit / spring;
            if stroke > longest * (1.0 + 1e-12) {
                let allowed = format!(
                    "must be at most friction_limit over the stiffness of the spring, {longest} m: a longer one would \
                     make the spring give out energy"
                );
                return Err(Error::input(key("leaf_decay"), format!("{stroke} m"), allowed));
            }
        }
    }
    Ok(())
}

fn check_behind(key: String, position: f64, before: Option<f64>) -> Result<(), Error> {
    match before {
        Some(before) if position >= before => {
            let allowed = format!("axles go from front to rear: must be less than {before} m");
            Err(Error::input(key, format!("{position} m"), allowed))
        }
        _ => Ok(()),
    }
}

fn check_couplings(bodies: &[Body], b: usize) -> Result<(), Error> {
    let couplings = &bodies[b].couplings;
    if b > 0 && couplings.is_empty() {
        let allowed = "every body but the first needs a hinge or springs to an earlier one";
        return Err(Error::input(format!("bodies[{b}]"), "uncoupled", allowed));
    }
    for (k, coupling) in couplings.iter().enumerate() {
        let here = coupling_key(bodies, b, k);
        let key = |name: &str| format!("{here}.{name}");
        let (to, at, own) = coupling.ends();
        if to >= b {
            let allowed = match b {
                0 => "the first body has no earlier one: let the others be coupled to it".to_string(),
                1 => "must be an earlier body: 0, counted from 0".to_string(),
                _ => format!("must be an earlier body: 0 to {}, counted from 0", b - 1),
            };
            return Err(Error::input(key("to"), to, allowed));
        }
        finite(key("at"), at)?;
        finite(key("own"), own)?;
        match coupling {
            Coupling::Hinge { height, .. } => {
                not_negative(key("height"), *height)?;
            }
            Coupling::Spring { stiffness, damping, friction, .. } => {
                positive(key("stiffness"), *stiffness)?;
                not_negative(key("damping"), *damping)?;
                check_friction(friction, *stiffness, &key)?;
            }
        }
    }
    let hinges = couplings.iter().filter(|coupling| coupling.is_hinge()).count();
    if hinges > 1 {
        let allowed = "at most one: let the other body be hinged to this one, or use springs";
        return Err(Error::input(format!("bodies[{b}].hinge"), format!("{hinges} hinges"), allowed));
    }
    Ok(())
}

/// How messages name a coupling: the hinge of its body, or one of the springs.
fn coupling_key(bodies: &[Body], b: usize, k: usize) -> String {
    let couplings = &bodies[b].couplings;
    let prefix = prefix(bodies, b);
    if couplings[k].is_hinge() {
        return format!("{prefix}hinge");
    }
    format!("{prefix}springs[{}]", couplings[..k].iter().filter(|coupling| !coupling.is_hinge()).count())
}

/// Refuses a body whose couplings put it at different places along the road.
fn check_upright(bodies: &[Body]) -> Result<(), Error> {
    let positions = positions(bodies);
    for (b, body) in bodies.iter().enumerate() {
        for (k, coupling) in body.couplings.iter().enumerate() {
            let (to, at, own) = coupling.ends();
            let (there, here) = (positions[to] + at, positions[b] + own);
            if (there - here).abs() > SAME {
                return Err(Error::input(
                    format!("{}.own", coupling_key(bodies, b, k)),
                    format!("{own} m"),
                    format!("what joins two bodies stands upright: must be {} m here", there - positions[b]),
                ));
            }
        }
    }
    Ok(())
}

/// Refuses axles of different bodies at the same place.
fn check_apart(bodies: &[Body], order: &[(usize, usize)]) -> Result<(), Error> {
    let positions = positions(bodies);
    let at = |(b, i): (usize, usize)| positions[b] + bodies[b].axles[i].position;
    for pair in order.windows(2) {
        let [(b, i), (other, j)] = [pair[0], pair[1]];
        if at((b, i)) - at((other, j)) < SAME {
            return Err(Error::input(
                format!("bodies[{other}].axles[{j}].position"),
                format!("{} m", bodies[other].axles[j].position),
                format!("must not be where bodies[{b}].axles[{i}] is"),
            ));
        }
    }
    Ok(())
}
