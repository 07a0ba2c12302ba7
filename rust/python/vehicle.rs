//! The vehicle for Python.

use numpy::IntoPyArray;
use pyo3::prelude::*;

use super::given::Given;
use super::{Vector, preparing};
use crate::error::Error;
use crate::vehicle::body::{Axle, Body, BuildUp, Coupling, Friction, Suspension, pitches};
use crate::vehicle::{self, catalogue};

/// A vehicle, or a train of forces or masses.
#[pyclass(name = "Vehicle", frozen, module = "spanwise._core")]
pub struct PyVehicle(pub vehicle::Vehicle);

#[pymethods]
impl PyVehicle {
    /// Of the bodies in an attribute, or of the one body that the object is itself.
    #[new]
    fn new(py: Python<'_>, bodies: &Bound<'_, PyAny>, alone: bool) -> PyResult<Self> {
        let mut all = Vec::new();
        for (b, object) in bodies.try_iter()?.enumerate() {
            let place = if alone { String::new() } else { format!("bodies[{b}].") };
            all.push(body(&Given::at(&object?, place))?);
        }
        let (mut bodies, inertias): (Vec<Body>, Vec<Option<f64>>) = all.into_iter().unzip();
        for (b, inertia) in inertias.into_iter().enumerate() {
            if inertia.is_none() && pitches(&bodies, b) {
                let key = if alone { "pitch_inertia".to_string() } else { format!("bodies[{b}].pitch_inertia") };
                return Err(Error::input(key, "None", "must be a number, for the body pitches").into());
            }
            // Of a body that does not pitch any inertia will do.
            bodies[b].pitch_inertia = inertia.unwrap_or(1.0);
        }
        let order = bodies.iter().map(|body| 2 + body.axles.len() + body.couplings.len()).sum();
        Ok(PyVehicle(preparing(py, order, move |_| vehicle::Vehicle::of_bodies(bodies))?))
    }

    #[staticmethod]
    fn force_train(loads: Vec<f64>, positions: Vec<f64>) -> PyResult<Self> {
        Ok(PyVehicle(vehicle::Vehicle::force_train(&loads, &positions)?))
    }

    #[staticmethod]
    fn moving_masses(masses: Vec<f64>, positions: Vec<f64>) -> PyResult<Self> {
        Ok(PyVehicle(vehicle::Vehicle::moving_masses(&masses, &positions)?))
    }

    #[getter]
    fn mass(&self) -> f64 {
        self.0.mass()
    }

    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> Vector<'py> {
        self.0.positions().into_pyarray(py)
    }

    #[getter]
    fn places<'py>(&self, py: Python<'py>) -> Vector<'py> {
        self.0.places().to_vec().into_pyarray(py)
    }

    #[getter]
    fn bodies(&self) -> Vec<PyBody> {
        self.0.bodies().iter().map(PyBody::of).collect()
    }

    #[getter]
    fn body_positions<'py>(&self, py: Python<'py>) -> Vector<'py> {
        self.0.assembly().body_positions.clone().into_pyarray(py)
    }

    #[getter]
    fn axle_order(&self) -> Vec<(usize, usize)> {
        self.0.axle_order()
    }

    #[getter]
    fn coordinates(&self) -> Vec<String> {
        self.0.assembly().coordinates.clone()
    }

    fn static_loads<'py>(&self, py: Python<'py>, gravity: f64) -> PyResult<Vector<'py>> {
        crate::error::positive("gravity", gravity)?;
        Ok(self.0.static_loads(gravity).into_pyarray(py))
    }

    fn frequencies<'py>(&self, py: Python<'py>, locked: bool) -> PyResult<Vector<'py>> {
        let suspension = if locked { Suspension::Locked } else { Suspension::Sliding };
        let (vehicle, order) = (self.0.clone(), self.0.assembly().coordinates.len());
        Ok(preparing(py, order, move |_| Ok(vehicle.frequencies(suspension)))?.into_pyarray(py))
    }
}

/// Functions of the catalogue.
macro_rules! published {
    ($($name:ident($($option:ident: $kind:ty),*);)*) => {$(
        #[pyfunction]
        pub fn $name($($option: $kind),*) -> PyResult<PyVehicle> {
            Ok(PyVehicle(catalogue::$name($($option),*)?))
        }
    )*};
}

published! {
    kishan_1973();
    quarter_car(cg_height: f64);
    half_car(cg_height: f64);
    articulated_5_axle(cg_heights: [f64; 2], hinge_height: f64);
    hs20_44(cg_heights: [f64; 2], hinge_height: f64);
    hs20(rear_spacing: f64);
    t44(rear_spacing: f64);
    cl_625();
    flm3();
    flm4(lorry: usize);
}

/// Name, title and source of each entry of the catalogue, and whether it was recalled.
#[pyfunction]
pub fn presets() -> Vec<(&'static str, &'static str, &'static str, bool)> {
    catalogue::PRESETS.map(|preset| (preset.name, preset.title, preset.source, preset.recalled)).to_vec()
}

/// The fields of Python's `Axle`.
#[derive(IntoPyObject)]
struct PyAxle {
    position: f64,
    mass: f64,
    tyre_stiffness: f64,
    tyre_damping: f64,
    suspension_stiffness: f64,
    suspension_damping: f64,
    friction_limit: f64,
    initial_friction: f64,
    stick_stiffness: Option<f64>,
    leaf_decay: Option<f64>,
}

/// The fields of Python's `Hinge`.
#[derive(IntoPyObject)]
struct PyHinge {
    to: usize,
    at: f64,
    own: f64,
    height: f64,
}

/// The fields of Python's `Spring`.
#[derive(IntoPyObject)]
struct PySpring {
    to: usize,
    at: f64,
    own: f64,
    stiffness: f64,
    damping: f64,
    friction_limit: f64,
    initial_friction: f64,
    stick_stiffness: Option<f64>,
    leaf_decay: Option<f64>,
}

/// The fields of Python's `Body`.
#[derive(IntoPyObject)]
struct PyBody {
    mass: f64,
    pitch_inertia: f64,
    cg_height: f64,
    axles: Vec<PyAxle>,
    hinge: Option<PyHinge>,
    springs: Vec<PySpring>,
}

impl PyBody {
    /// What [`body`] makes this body of.
    fn of(body: &Body) -> Self {
        let axle = |a: &Axle| {
            let [stick_stiffness, leaf_decay] = build_up(a.friction);
            PyAxle {
                position: a.position,
                mass: a.mass,
                tyre_stiffness: a.tyre_stiffness,
                tyre_damping: a.tyre_damping,
                suspension_stiffness: a.suspension_stiffness,
                suspension_damping: a.suspension_damping,
                friction_limit: a.friction.limit,
                initial_friction: a.friction.initial,
                stick_stiffness,
                leaf_decay,
            }
        };
        let (mut hinge, mut springs) = (None, Vec::new());
        for coupling in &body.couplings {
            match *coupling {
                Coupling::Hinge { to, at, own, height } => hinge = Some(PyHinge { to, at, own, height }),
                Coupling::Spring { to, at, own, stiffness, damping, friction } => {
                    let [stick_stiffness, leaf_decay] = build_up(friction);
                    let Friction { limit: friction_limit, initial: initial_friction, .. } = friction;
                    springs.push(PySpring {
                        to,
                        at,
                        own,
                        stiffness,
                        damping,
                        friction_limit,
                        initial_friction,
                        stick_stiffness,
                        leaf_decay,
                    });
                }
            }
        }
        let Body { mass, pitch_inertia, cg_height, .. } = *body;
        PyBody { mass, pitch_inertia, cg_height, axles: body.axles.iter().map(axle).collect(), hinge, springs }
    }
}

/// Stiffness of the stick and decay of the leaf spring.
fn build_up(friction: Friction) -> [Option<f64>; 2] {
    match friction.build_up {
        BuildUp::Rigid => [None, None],
        BuildUp::Elastic(stick) => [Some(stick), None],
        BuildUp::Leaf(decay) => [None, Some(decay)],
    }
}

/// A body, and its inertia if that was given.
fn body(given: &Given<'_, '_>) -> PyResult<(Body, Option<f64>)> {
    let mass = match given.place.is_empty() {
        true => given.number_called("mass", "vehicle mass")?,
        false => given.number("mass")?,
    };
    let (inertia, cg_height) = (given.optional("pitch_inertia")?, given.number("cg_height")?);
    let axles = given.each("axles", |axle| self::axle(&axle))?;
    let mut couplings: Vec<Coupling> = given.one("hinge", |hinge| self::hinge(&hinge))?.into_iter().collect();
    couplings.extend(given.each("springs", |spring| self::spring(&spring))?);
    Ok((Body { mass, pitch_inertia: 0.0, cg_height, axles, couplings }, inertia))
}

fn axle(given: &Given<'_, '_>) -> PyResult<Axle> {
    Ok(Axle {
        position: given.number("position")?,
        mass: given.number("mass")?,
        tyre_stiffness: given.number("tyre_stiffness")?,
        tyre_damping: given.number("tyre_damping")?,
        suspension_stiffness: given.number("suspension_stiffness")?,
        suspension_damping: given.number("suspension_damping")?,
        friction: friction(given)?,
    })
}

fn hinge(given: &Given<'_, '_>) -> PyResult<Coupling> {
    let (to, at, own) = ends(given)?;
    Ok(Coupling::Hinge { to, at, own, height: given.number("height")? })
}

fn spring(given: &Given<'_, '_>) -> PyResult<Coupling> {
    let (to, at, own) = ends(given)?;
    let (stiffness, damping) = (given.number("stiffness")?, given.number("damping")?);
    Ok(Coupling::Spring { to, at, own, stiffness, damping, friction: friction(given)? })
}

fn ends(given: &Given<'_, '_>) -> PyResult<(usize, f64, f64)> {
    Ok((given.count("to")?, given.number("at")?, given.number("own")?))
}

fn friction(given: &Given<'_, '_>) -> PyResult<Friction> {
    let (limit, initial) = (given.number("friction_limit")?, given.number("initial_friction")?);
    let build_up = match (given.optional("stick_stiffness")?, given.optional("leaf_decay")?) {
        (Some(stick), Some(decay)) => {
            let allowed = format!("not beside leaf_decay = {decay}; give one of the two");
            return Err(Error::input(given.key("stick_stiffness"), stick, allowed).into());
        }
        (None, Some(decay)) => BuildUp::Leaf(decay),
        (Some(stick), None) => BuildUp::Elastic(stick),
        (None, None) => BuildUp::Rigid,
    };
    Ok(Friction { limit, initial, build_up })
}
