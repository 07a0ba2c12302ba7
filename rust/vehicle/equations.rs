//! A vehicle in independent coordinates: the matrices, contacts and friction elements that the time step works with.
//!
//! Coordinates q are counted from the static state, displacements down and rotations nose down. Without contact forces
//! and friction M q̈ + C q̇ + K q = 0; every contact and friction force enters through its row.

use nalgebra::{DMatrix, DVector};

use crate::error::Error;
use crate::vehicle::body::{Axle, Body, Coupling, Friction, Suspension};
use crate::vehicle::dense;

/// Ratio of the lowest to the highest squared frequency below which a motion counts as free.
const FREE: f64 = 1e-12;

/// A vehicle as the time step sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct Assembly {
    /// What each coordinate is, such as "body 1 heave", "axle 3 hop".
    pub coordinates: Vec<String>,
    /// Mass matrix [kg, kg m, kg m²], positive definite.
    pub mass: DMatrix<f64>,
    /// Damping matrix of the linear dampers between bodies and axles, tyres left out.
    pub damping: DMatrix<f64>,
    /// Stiffness matrix of the linear springs between bodies and axles, tyres left out.
    pub stiffness: DMatrix<f64>,
    /// Points that press on the road, front first.
    pub contacts: Vec<ContactPoint>,
    /// Friction between bodies and axles, apart from that of massless axles.
    pub frictions: Vec<FrictionElement>,
    /// Total mass [kg]; none of a train of forces.
    pub total_mass: f64,
    /// To be added to `mass` when the vehicle rolls freely: its parts move along the road relative to the centre of
    /// mass as bodies pitch. Zero for one rigid body on massless axles.
    pub surge_mass: DMatrix<f64>,
    /// Heave and pitch of every body, as rows that give them from q.
    pub bodies: Vec<[DVector<f64>; 2]>,
    /// Distance of each body's centre of mass ahead of that of the whole vehicle in the static state [m].
    pub body_positions: Vec<f64>,
    /// Displacement of the unsprung mass above each contact, where there is one, as a row.
    pub hops: Vec<Option<DVector<f64>>>,
    /// The suspension above that mass.
    pub suspensions: Vec<Option<Sprung>>,
}

/// The suspension of an axle with mass.
#[derive(Debug, Clone, PartialEq)]
pub struct Sprung {
    /// Its shortening, as a row over q.
    pub row: DVector<f64>,
    /// Its friction element, if it rubs.
    pub friction: Option<usize>,
}

/// A wheel line on the road.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactPoint {
    /// Shortening of what presses on the road, d = row·q − w + r [m].
    pub row: DVector<f64>,
    /// Distance ahead of the vehicle's centre of mass in the static state [m].
    pub position: f64,
    /// Distance behind the first contact, to the bit the same whatever the masses are [m].
    pub behind: f64,
    /// How the contact moves along the road as the vehicle pitches: x = X + position + surge_row·q, X the centre of mass
    /// of the whole vehicle. Of one rigid body −h in pitch.
    pub surge_row: DVector<f64>,
    /// Static load for a gravity of one [kg]; of a constant force, which gravity leaves as it is, the force [N]. See
    /// [`Assembly::static_loads`].
    pub share: f64,
    /// How the force follows from the shortening.
    pub law: ContactLaw,
}

/// How a contact force follows from the shortening d and its rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactLaw {
    /// A tyre below a mass that is part of M.
    Tyre {
        /// Stiffness [N/m].
        stiffness: f64,
        /// Damping [N s/m].
        damping: f64,
    },
    /// A massless axle: a tyre in series with a suspension.
    Series {
        /// Tyre stiffness [N/m].
        tyre_stiffness: f64,
        /// Tyre damping [N s/m].
        tyre_damping: f64,
        /// Suspension stiffness [N/m].
        suspension_stiffness: f64,
        /// Suspension damping [N s/m].
        suspension_damping: f64,
        /// Friction in the suspension.
        friction: Friction,
    },
    /// A mass [kg] in rigid contact with the road.
    Mass(f64),
    /// A constant force.
    Force,
}

impl ContactPoint {
    /// Static load [N] under gravity [m/s²].
    pub fn static_load(&self, gravity: f64) -> f64 {
        if self.law == ContactLaw::Force { self.share } else { self.share * gravity }
    }
}

/// Blames the value that is farthest from what vehicles have, if it is so far that nothing can be told of their motion: a
/// body of 1e-300 kg is to be named, not the axles that seem to let it pitch.
fn out_of_proportion(bodies: &[Body]) -> Option<Error> {
    /// What vehicles have, in SI units, by the name of the value.
    const USUAL: [(&str, f64); 5] = [
        ("mass", 1e4),
        ("pitch_inertia", 1e5),
        ("stiffness", 1e6),
        ("tyre_stiffness", 1e6),
        ("suspension_stiffness", 1e6),
    ];
    /// By how many powers of ten a value may differ from them.
    const FAR: f64 = 9.0;
    /// Longest distance between the parts of a vehicle [m].
    const FARTHEST: f64 = 1e4;
    let decades = |name: &str, value: f64| {
        // However short a distance is, it is one.
        if matches!(name, "position" | "at" | "own") {
            return if value.abs() < FARTHEST { 0.0 } else { FAR + (value.abs() / FARTHEST).log10() + 1.0 };
        }
        let usual = USUAL.iter().find(|(each, _)| *each == name).map_or(1.0, |each| each.1);
        if value == 0.0 { 0.0 } else { (value.abs() / usual).log10().abs() }
    };
    let mut found: Option<(f64, String, f64)> = None;
    let mut look = |place: String, name: &str, value: f64| {
        let far = decades(name, value);
        if far > found.as_ref().map_or(FAR, |each| each.0) {
            found = Some((far, format!("{place}{name}"), value));
        }
    };
    for (b, body) in bodies.iter().enumerate() {
        let here = prefix(bodies, b);
        look(if bodies.len() == 1 { "vehicle ".to_string() } else { here.clone() }, "mass", body.mass);
        look(here.clone(), "pitch_inertia", body.pitch_inertia);
        for (i, axle) in body.axles.iter().enumerate() {
            let place = format!("{here}axles[{i}].");
            look(place.clone(), "position", axle.position);
            look(place.clone(), "mass", axle.mass);
            look(place.clone(), "tyre_stiffness", axle.tyre_stiffness);
            look(place, "suspension_stiffness", axle.suspension_stiffness);
        }
        let mut springs = 0;
        for coupling in &body.couplings {
            let place = match coupling {
                Coupling::Spring { stiffness, .. } => {
                    let place = format!("{here}springs[{springs}].");
                    look(place.clone(), "stiffness", *stiffness);
                    springs += 1;
                    place
                }
                Coupling::Hinge { .. } => format!("{here}hinge."),
            };
            let (_, at, own) = coupling.ends();
            look(place.clone(), "at", at);
            look(place, "own", own);
        }
    }
    let (_, key, value) = found?;
    Some(Error::input(key, format!("{value:e}"), "is out of all proportion to the rest of the vehicle"))
}

impl ContactLaw {
    /// Stiffness of the tyre, if there is one [N/m].
    pub fn tyre_stiffness(&self) -> f64 {
        match *self {
            ContactLaw::Tyre { stiffness, .. } => stiffness,
            ContactLaw::Series { tyre_stiffness, .. } => tyre_stiffness,
            ContactLaw::Mass(_) | ContactLaw::Force => 0.0,
        }
    }

    /// Whether the force follows from the shortening alone, not from its rates.
    pub fn is_plain(&self) -> bool {
        match *self {
            ContactLaw::Tyre { damping, .. } | ContactLaw::Series { tyre_damping: damping, .. } => damping == 0.0,
            ContactLaw::Mass(_) => false,
            ContactLaw::Force => true,
        }
    }
}

/// A friction element between two parts of the vehicle.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionElement {
    /// Shortening s = row·q [m].
    pub row: DVector<f64>,
    /// Its friction. Never rigid: without the elasticity of a tyre in series, time steps would make it ring.
    pub friction: Friction,
    /// Stiffness of the spring beside it [N/m], which is part of K too; a leaf spring's envelope has this slope.
    pub stiffness: f64,
}

/// Where a body is: its heave and pitch, and how its centre of mass moves along the road, as rows over q.
struct Place {
    heave: DVector<f64>,
    pitch: DVector<f64>,
    /// Relative to the centre of mass of the first body.
    surge: DVector<f64>,
    /// Ahead of the centre of mass of the first body [m].
    position: f64,
    /// Of the centre of mass above the road [m].
    height: f64,
}

impl Place {
    /// Downward displacement of a point at this distance ahead of the centre of mass.
    fn at(&self, ahead: f64) -> DVector<f64> {
        &self.heave + &self.pitch * ahead
    }

    /// Displacement along the road of what is at this height: nose down, points below the centre of mass go back.
    fn along(&self, height: f64) -> DVector<f64> {
        &self.surge - &self.pitch * (self.height - height)
    }
}

/// A mass, its displacement along the road relative to the first body, and how far ahead of that it is.
type Part = (f64, DVector<f64>, f64);

/// A sum of squares, k rowᵀ row, as it goes into a matrix.
fn add(matrix: &mut DMatrix<f64>, factor: f64, row: &DVector<f64>) {
    // Of a long vehicle nearly all of it is zero.
    let some: Vec<(usize, f64)> = row.iter().copied().enumerate().filter(|(_, value)| *value != 0.0).collect();
    for &(j, b) in &some {
        for &(i, a) in &some {
            matrix[(i, j)] += factor * b * a;
        }
    }
}

impl Assembly {
    /// Of bodies whose values have been checked one by one; refuses what cannot stand.
    ///
    /// Each hinge takes one coordinate: the heave of the body that has it, z = z' + a'θ' − aθ.
    pub(crate) fn of_bodies(bodies: &[Body]) -> Result<Self, Error> {
        let order = front_first(bodies);
        let Coordinates { names: coordinates, heaves, pitches, hops } = Coordinates::of(bodies, &order);
        let n = coordinates.len();
        let unit = |i: Option<usize>| DVector::from_fn(n, |j, _| f64::from(u8::from(i == Some(j))));
        let mut assembly = Assembly {
            mass: DMatrix::zeros(n, n),
            damping: DMatrix::zeros(n, n),
            stiffness: DMatrix::zeros(n, n),
            surge_mass: DMatrix::zeros(n, n),
            coordinates,
            contacts: Vec::new(),
            frictions: Vec::new(),
            total_mass: 0.0,
            bodies: Vec::new(),
            body_positions: positions(bodies),
            hops: Vec::new(),
            suspensions: Vec::new(),
        };
        let mut weight = DVector::zeros(n);
        let mut parts: Vec<Part> = Vec::new();
        let mut places: Vec<Place> = Vec::new();
        for (b, body) in bodies.iter().enumerate() {
            let place = place(body, unit(heaves[b]), unit(pitches[b]), &places);
            add(&mut assembly.mass, body.mass, &place.heave);
            add(&mut assembly.mass, body.pitch_inertia, &place.pitch);
            weight.axpy(body.mass, &place.heave, 1.0);
            parts.push((body.mass, place.surge.clone(), place.position));
            for coupling in &body.couplings {
                if let Coupling::Spring { to, at, own, stiffness, damping, friction } = *coupling {
                    let row = places[to].at(at) - place.at(own);
                    let row = if places[to].height < place.height { -row } else { row };
                    assembly.connect(row, stiffness, damping, friction.softened(stiffness));
                }
            }
            assembly.bodies.push([place.heave.clone(), place.pitch.clone()]);
            places.push(place);
        }
        for (k, &(b, i)) in order.iter().enumerate() {
            let (place, axle) = (&places[b], &bodies[b].axles[i]);
            let (above, ground, position) = (place.at(axle.position), place.along(0.0), place.position + axle.position);
            let hop = hops[k].map(|at| unit(Some(at)));
            if let Some(hop) = &hop {
                add(&mut assembly.mass, axle.mass, hop);
                weight.axpy(axle.mass, hop, 1.0);
                parts.push((axle.mass, ground.clone(), position));
                let friction = axle.friction.softened(axle.tyre_stiffness);
                let (row, before) = (&above - hop, assembly.frictions.len());
                assembly.connect(row.clone(), axle.suspension_stiffness, axle.suspension_damping, friction);
                let friction = (assembly.frictions.len() > before).then_some(before);
                assembly.suspensions.push(Some(Sprung { row, friction }));
            } else {
                assembly.suspensions.push(None);
            }
            let row = hop.clone().unwrap_or(above);
            // Counted from the first, and from the centre of mass, when all are there.
            let behind = 0.0;
            assembly.contacts.push(ContactPoint {
                row,
                position,
                behind,
                surge_row: ground,
                share: 0.0,
                law: law(axle),
            });
            assembly.hops.push(hop);
        }
        assembly.centre(&parts);
        assembly.stand(bodies, &order, &weight)?;
        Ok(assembly)
    }

    /// Of contacts without a vehicle above, at positions ahead of any point: forces [N], or masses [kg].
    pub(crate) fn of_contacts(laws: Vec<(f64, ContactLaw)>, positions: &[f64]) -> Self {
        let (none, empty) = (DVector::zeros(0), DMatrix::zeros(0, 0));
        let total: f64 = laws.iter().map(|(share, _)| share).sum();
        let centre = laws.iter().zip(positions).map(|((share, _), x)| share * x).sum::<f64>() / total;
        let masses = laws.iter().map(|(_, law)| if let ContactLaw::Mass(mass) = law { *mass } else { 0.0 });
        Assembly {
            coordinates: Vec::new(),
            mass: empty.clone(),
            damping: empty.clone(),
            stiffness: empty.clone(),
            surge_mass: empty,
            frictions: Vec::new(),
            total_mass: masses.sum(),
            bodies: Vec::new(),
            body_positions: Vec::new(),
            hops: vec![None; laws.len()],
            suspensions: vec![None; laws.len()],
            contacts: laws
                .into_iter()
                .zip(positions)
                .map(|((share, law), x)| ContactPoint {
                    row: none.clone(),
                    position: x - centre,
                    behind: positions[0] - x,
                    surge_row: none.clone(),
                    share,
                    law,
                })
                .collect(),
        }
    }

    /// What braked wheels that stand still add to the mass: the whole vehicle moves along the road as it rocks about them.
    pub fn standing_mass(&self) -> DMatrix<f64> {
        let mean = self.contacts.iter().fold(DVector::zeros(self.mass.nrows()), |sum, contact| {
            sum + &contact.surge_row * (contact.share / self.total_mass)
        });
        &mean * mean.transpose() * self.total_mass
    }

    /// Static loads of the contacts [N] under gravity [m/s²], front first.
    pub fn static_loads(&self, gravity: f64) -> Vec<f64> {
        self.contacts.iter().map(|contact| contact.static_load(gravity)).collect()
    }

    /// Stiffness on rigid ground, tyres and all, with every suspension in the given state.
    pub fn grounded_stiffness(&self, suspension: Suspension) -> DMatrix<f64> {
        let mut stiffness = self.stiffness.clone();
        for contact in &self.contacts {
            add(&mut stiffness, contact.law.stiffness(suspension), &contact.row);
        }
        if suspension == Suspension::Locked {
            for element in &self.frictions {
                add(&mut stiffness, element.friction.stick_stiffness(), &element.row);
            }
        }
        stiffness
    }

    /// Natural frequencies on rigid ground [Hz], ascending, with their shapes in the columns.
    pub fn vibrations(&self, suspension: Suspension) -> (Vec<f64>, DMatrix<f64>) {
        let n = self.coordinates.len();
        let none = (vec![f64::NAN; n], DMatrix::zeros(n, n));
        if n == 0 {
            return none; // a train has nothing that vibrates
        }
        let Some((squares, shapes)) = dense::vibrations(&self.mass, self.grounded_stiffness(suspension)) else {
            return none;
        };
        let frequencies = squares.iter().map(|square| square.max(0.0).sqrt() / std::f64::consts::TAU);
        (frequencies.collect(), shapes)
    }

    fn connect(&mut self, row: DVector<f64>, stiffness: f64, damping: f64, friction: Friction) {
        add(&mut self.stiffness, stiffness, &row);
        add(&mut self.damping, damping, &row);
        if friction.limit > 0.0 {
            self.frictions.push(FrictionElement { row, friction, stiffness });
        }
    }

    /// Counts all that is along the road from the centre of mass of the whole vehicle.
    fn centre(&mut self, parts: &[Part]) {
        self.total_mass = parts.iter().map(|(mass, ..)| mass).sum();
        let mut surge = DVector::zeros(self.coordinates.len());
        let mut position = 0.0;
        for (mass, row, at) in parts {
            surge.axpy(mass / self.total_mass, row, 1.0);
            position += mass / self.total_mass * at;
        }
        for (mass, row, _) in parts {
            add(&mut self.surge_mass, *mass, &(row - &surge));
        }
        let front = self.contacts[0].position;
        for contact in &mut self.contacts {
            contact.surge_row -= &surge;
            contact.behind = front - contact.position;
            contact.position -= position;
        }
        for body in &mut self.body_positions {
            *body -= position;
        }
    }

    /// The share of the weight that each contact carries: with suspensions as springs, without friction.
    fn stand(&mut self, bodies: &[Body], order: &[(usize, usize)], weight: &DVector<f64>) -> Result<(), Error> {
        self.check_held(bodies)?;
        let sunk = self.grounded_stiffness(Suspension::Sliding).lu().solve(weight);
        for (contact, &(b, i)) in self.contacts.iter_mut().zip(order) {
            let sunk = sunk.as_ref().map_or(f64::NAN, |q| contact.row.dot(q));
            contact.share = contact.law.stiffness(Suspension::Sliding) * sunk;
            if !(contact.share.is_finite() && contact.share > 0.0) {
                if let Some(error) = out_of_proportion(bodies) {
                    return Err(error);
                }
                return Err(Error::input(
                    format!("{}axles[{i}].position", prefix(bodies, b)),
                    format!("{} m", bodies[b].axles[i].position),
                    match bodies.len() {
                        1 => "this axle would carry no load: the centre of mass must lie between the axles",
                        _ => "this axle would carry no load: move axles, hinges or centres of mass",
                    },
                ));
            }
        }
        Ok(())
    }

    /// Refuses a vehicle with a motion that nothing resists.
    fn check_held(&self, bodies: &[Body]) -> Result<(), Error> {
        let (frequencies, shapes) = self.vibrations(Suspension::Sliding);
        let held = frequencies[0].powi(2) > FREE * frequencies[frequencies.len() - 1].powi(2);
        if held || frequencies[0].is_nan() {
            return Ok(()); // what is not a number is refused with the loads
        }
        if let Some(error) = out_of_proportion(bodies) {
            return Err(error);
        }
        let motion = shapes.column(0);
        let energy = |b: usize| {
            let [heave, pitch] = &self.bodies[b];
            let (heave, pitch) = (heave.dot(&motion), pitch.dot(&motion));
            [bodies[b].mass * heave * heave, bodies[b].pitch_inertia * pitch * pitch]
        };
        let total = |b: usize| energy(b).iter().sum::<f64>();
        let loosest = (0..bodies.len()).max_by(|&a, &b| total(a).total_cmp(&total(b))).unwrap_or(0);
        let [heave, pitch] = energy(loosest);
        let motion = if pitch > 1e-3 * heave { "pitch" } else { "heave" };
        let allowed = match bodies.len() {
            1 => "its axles leave the body free to pitch: their positions must differ".to_string(),
            _ => format!("this leaves the body free to {motion}: give it another axle, spring or hinge"),
        };
        Err(Error::input(format!("{}axles", prefix(bodies, loosest)), bodies[loosest].axles.len(), allowed))
    }
}

impl ContactLaw {
    /// Stiffness between the road and what is above [N/m], none for what is no spring.
    pub fn stiffness(&self, suspension: Suspension) -> f64 {
        match (*self, suspension) {
            (ContactLaw::Tyre { stiffness, .. }, _) => stiffness,
            (ContactLaw::Series { tyre_stiffness, .. }, Suspension::Locked) => tyre_stiffness,
            (ContactLaw::Series { tyre_stiffness: t, suspension_stiffness: s, .. }, Suspension::Sliding) => {
                t * s / (t + s)
            }
            (ContactLaw::Mass(_) | ContactLaw::Force, _) => 0.0,
        }
    }
}

/// How messages begin that are about a body: with nothing where it is the only one.
pub(crate) fn prefix(bodies: &[Body], body: usize) -> String {
    if bodies.len() == 1 { String::new() } else { format!("bodies[{body}].") }
}

fn law(axle: &Axle) -> ContactLaw {
    if axle.mass > 0.0 {
        return ContactLaw::Tyre { stiffness: axle.tyre_stiffness, damping: axle.tyre_damping };
    }
    ContactLaw::Series {
        tyre_stiffness: axle.tyre_stiffness,
        tyre_damping: axle.tyre_damping,
        suspension_stiffness: axle.suspension_stiffness,
        suspension_damping: axle.suspension_damping,
        friction: axle.friction,
    }
}

/// Position of each body's centre of mass ahead of that of the first [m], by its first coupling.
pub(crate) fn positions(bodies: &[Body]) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::new();
    for body in bodies {
        let (to, at, own) = body.couplings.first().map_or((None, 0.0, 0.0), |c| {
            let (to, at, own) = c.ends();
            (Some(to), at, own)
        });
        found.push(to.map_or(0.0, |to| found[to]) + at - own);
    }
    found
}

/// All axles of all bodies, as (body, axle), front first.
pub(crate) fn front_first(bodies: &[Body]) -> Vec<(usize, usize)> {
    let positions = positions(bodies);
    let mut order: Vec<(usize, usize)> =
        bodies.iter().enumerate().flat_map(|(b, body)| (0..body.axles.len()).map(move |i| (b, i))).collect();
    let at = |&(b, i): &(usize, usize)| positions[b] + bodies[b].axles[i].position;
    order.sort_by(|a, b| at(b).total_cmp(&at(a)));
    order
}

/// Names of the coordinates, and which of them are heave and pitch of each body and hop of each contact.
struct Coordinates {
    names: Vec<String>,
    heaves: Vec<Option<usize>>,
    pitches: Vec<Option<usize>>,
    hops: Vec<Option<usize>>,
}

impl Coordinates {
    /// A hinged body has no heave of its own, and one on which everything acts at its centre of mass does not pitch.
    fn of(bodies: &[Body], order: &[(usize, usize)]) -> Self {
        let mut found = Coordinates { names: Vec::new(), heaves: Vec::new(), pitches: Vec::new(), hops: Vec::new() };
        for (b, body) in bodies.iter().enumerate() {
            let hinged = body.couplings.iter().any(Coupling::is_hinge);
            let heave = found.name(!hinged, || format!("body {} heave", b + 1));
            found.heaves.push(heave);
            let own = body.couplings.iter().map(|coupling| coupling.ends().2);
            let mut points = body.axles.iter().map(|axle| axle.position).chain(own);
            let mut others = bodies.iter().flat_map(|other| &other.couplings).map(Coupling::ends);
            let pitches = points.any(|x| x != 0.0) || others.any(|(to, at, _)| to == b && at != 0.0);
            let pitch = found.name(pitches, || format!("body {} pitch", b + 1));
            found.pitches.push(pitch);
        }
        for (k, &(b, i)) in order.iter().enumerate() {
            let hop = found.name(bodies[b].axles[i].mass > 0.0, || format!("axle {} hop", k + 1));
            found.hops.push(hop);
        }
        found
    }

    fn name(&mut self, wanted: bool, text: impl Fn() -> String) -> Option<usize> {
        wanted.then(|| {
            self.names.push(text());
            self.names.len() - 1
        })
    }
}

/// A body's place from its own coordinates and the places of those it is coupled to.
///
/// Along the road it follows its hinge, or without one its first spring, taken to guide it at the height of its centre
/// of mass.
fn place(body: &Body, heave: DVector<f64>, pitch: DVector<f64>, others: &[Place]) -> Place {
    let zero = DVector::zeros(heave.len());
    let mut place = Place { heave, pitch, surge: zero, position: 0.0, height: body.cg_height };
    if let Some(first) = body.couplings.first() {
        let (to, at, own) = first.ends();
        place.position = others[to].position + at - own;
        place.surge = others[to].along(body.cg_height);
    }
    for coupling in &body.couplings {
        if let Coupling::Hinge { to, at, own, height } = *coupling {
            place.heave = others[to].at(at) - &place.pitch * own;
            place.surge = others[to].along(height) + &place.pitch * (body.cg_height - height);
        }
    }
    place
}
