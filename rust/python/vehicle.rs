//! The vehicle for Python.

use numpy::IntoPyArray;
use pyo3::prelude::*;

use super::Vector;
use crate::assembly::{BuildUp, Friction};
use crate::vehicle::{self, Axle, Suspension};

/// A rigid body on massless axles with friction.
#[pyclass(name = "Vehicle", frozen, module = "spanwise._core")]
pub struct PyVehicle(pub vehicle::Vehicle);

#[pymethods]
impl PyVehicle {
    #[new]
    #[pyo3(signature = (*, mass, pitch_inertia, cg_height, axles))]
    fn new(mass: f64, pitch_inertia: f64, cg_height: f64, axles: Vec<[f64; 5]>) -> PyResult<Self> {
        let axles = axles.into_iter().map(|[position, tyre, suspension, limit, initial]| Axle {
            friction: Friction { limit, initial, build_up: BuildUp::Rigid },
            ..Axle::new(position, tyre, suspension)
        });
        Ok(PyVehicle(vehicle::Vehicle::new(mass, pitch_inertia, cg_height, axles.collect())?))
    }

    fn static_loads<'py>(&self, py: Python<'py>, gravity: f64) -> PyResult<Vector<'py>> {
        crate::error::positive("gravity", gravity)?;
        Ok(self.0.static_loads(gravity).into_pyarray(py))
    }

    fn frequencies<'py>(&self, py: Python<'py>, locked: bool) -> Vector<'py> {
        let suspension = if locked { Suspension::Locked } else { Suspension::Sliding };
        self.0.frequencies(suspension).into_pyarray(py)
    }
}
