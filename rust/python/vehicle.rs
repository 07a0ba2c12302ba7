//! The vehicle for Python.

use numpy::IntoPyArray;
use pyo3::prelude::*;

use super::{Vector, preparing};
use crate::vehicle::body::{Axle, Body, BuildUp, Coupling, Friction, Suspension};
use crate::vehicle::{self, catalogue};

/// Limit, initial force, stiffness of the stick, decay of a leaf spring.
type PyFriction = (f64, f64, Option<f64>, Option<f64>);

/// Position, mass, stiffness and damping of the tyre, of the suspension, and friction.
type PyAxle = ([f64; 6], PyFriction);

/// Which body, the place on it, the place on the own body, height.
type PyHinge = (usize, f64, f64, f64);

/// Which body, the place on it, the place on the own body, stiffness, damping, friction.
type PySpring = (usize, f64, f64, f64, f64, PyFriction);

/// Mass, pitch inertia and height, axles, hinge, springs.
type PyBody = ([f64; 3], Vec<PyAxle>, Option<PyHinge>, Vec<PySpring>);

/// A vehicle, or a train of forces or masses.
#[pyclass(name = "Vehicle", frozen, module = "spanwise._core")]
pub struct PyVehicle(pub vehicle::Vehicle);

#[pymethods]
impl PyVehicle {
    #[new]
    fn new(py: Python<'_>, bodies: Vec<PyBody>) -> PyResult<Self> {
        let bodies: Vec<Body> = bodies.into_iter().map(body).collect();
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
        self.0.bodies().iter().map(parts_of).collect()
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

/// What [`body`] makes this body of.
fn parts_of(body: &Body) -> PyBody {
    let rubs = |Friction { limit, initial, build_up }: Friction| match build_up {
        BuildUp::Leaf(decay) => (limit, initial, None, Some(decay)),
        BuildUp::Elastic(stick) => (limit, initial, Some(stick), None),
        BuildUp::Rigid => (limit, initial, None, None),
    };
    let axle = |a: &Axle| {
        let numbers =
            [a.position, a.mass, a.tyre_stiffness, a.tyre_damping, a.suspension_stiffness, a.suspension_damping];
        (numbers, rubs(a.friction))
    };
    let (mut hinge, mut springs) = (None, Vec::new());
    for coupling in &body.couplings {
        match *coupling {
            Coupling::Hinge { to, at, own, height } => hinge = Some((to, at, own, height)),
            Coupling::Spring { to, at, own, stiffness, damping, friction } => {
                springs.push((to, at, own, stiffness, damping, rubs(friction)));
            }
        }
    }
    let numbers = [body.mass, body.pitch_inertia, body.cg_height];
    (numbers, body.axles.iter().map(axle).collect(), hinge, springs)
}

fn body(([mass, pitch_inertia, cg_height], axles, hinge, springs): PyBody) -> Body {
    let hinge = hinge.map(|(to, at, own, height)| Coupling::Hinge { to, at, own, height });
    let springs = springs.into_iter().map(|(to, at, own, stiffness, damping, rubs)| Coupling::Spring {
        to,
        at,
        own,
        stiffness,
        damping,
        friction: friction(rubs),
    });
    Body {
        mass,
        pitch_inertia,
        cg_height,
        axles: axles.into_iter().map(axle).collect(),
        couplings: hinge.into_iter().chain(springs).collect(),
    }
}

fn axle(([position, mass, tyre, tyre_damping, suspension, suspension_damping], rubs): PyAxle) -> Axle {
    let plain = Axle::new(position, tyre, suspension);
    Axle { mass, tyre_damping, suspension_damping, friction: friction(rubs), ..plain }
}

fn friction((limit, initial, stick, decay): PyFriction) -> Friction {
    let build_up = match (stick, decay) {
        (_, Some(decay)) => BuildUp::Leaf(decay),
        (Some(stick), None) => BuildUp::Elastic(stick),
        (None, None) => BuildUp::Rigid,
    };
    Friction { limit, initial, build_up }
}
