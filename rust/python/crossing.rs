//! A crossing for Python; its arrays are made when asked for.

use std::sync::Arc;

use faer::Mat;
use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::prelude::*;

use super::bridge::{Asked, PyBridge};
use super::vehicle::PyVehicle;
use super::{Matrix, Vector, interruptible, rows};
use crate::analysis::{self, Analysis};
use crate::course::Drive;
use crate::crossing::{Damping, Settings};
use crate::envelope::{Envelope, Extreme, Ratio, Sense};
use crate::error::Error;
use crate::influence::Quantity;
use crate::recovery::Recovery;

/// A crossing that has been computed; its arrays are made when asked for.
#[pyclass(frozen, module = "spanwise._core")]
pub struct Crossing {
    analysis: Arc<Analysis>,
    outcome: analysis::Outcome,
}

const QUANTITIES: [(&str, Quantity); 6] = [
    ("deflection", Quantity::Deflection),
    ("moment", Quantity::Moment),
    ("shear_left", Quantity::ShearLeft),
    ("shear_right", Quantity::ShearRight),
    ("reactions", Quantity::Reaction),
    ("clamp_moments", Quantity::ClampMoment),
];

fn quantity(name: &str) -> Result<Quantity, Error> {
    QUANTITIES.iter().find(|q| q.0 == name).map(|q| q.1).ok_or_else(|| {
        let names: Vec<&str> = QUANTITIES.iter().map(|q| q.0).collect();
        Error::input("quantity", format!("\"{name}\""), format!("must be one of {}", names.join(", ")))
    })
}

impl Crossing {
    fn envelope_of(&self, name: &str) -> Result<Envelope, Error> {
        match name {
            "axle_loads" => Ok(self.outcome.axle_loads.clone()),
            "shear" => Ok(self.analysis.envelope_of(&self.outcome, Quantity::ShearLeft)),
            "deflection" | "moment" | "reactions" | "clamp_moments" => {
                Ok(self.analysis.envelope_of(&self.outcome, quantity(name)?))
            }
            _ => {
                let allowed = "must be deflection, moment, shear, reactions, clamp_moments or axle_loads";
                Err(Error::input("quantity", format!("\"{name}\""), allowed))
            }
        }
    }
}

#[pymethods]
impl Crossing {
    /// The dynamic and the static responses of a quantity at every instant.
    fn histories<'py>(&self, py: Python<'py>, name: &str) -> PyResult<[Matrix<'py>; 2]> {
        let quantity = quantity(name)?;
        let width = self.analysis.responses.range(quantity).len();
        let [dynamic, at_rest] = interruptible(py, |go_on| self.analysis.histories(&self.outcome, quantity, go_on))?;
        Ok([rows(py, dynamic, width)?, rows(py, at_rest, width)?])
    }

    /// States at every instant, by name.
    fn states<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Matrix<'py>> {
        let history = &self.outcome.history;
        let (values, width) = match name {
            "time" => (&history.time, 1),
            "positions" => (&history.positions, history.axles),
            "axle_loads" => (&history.loads, history.axles),
            "coordinates" => (&history.a, history.modes),
            "velocities" => (&history.a_dot, history.modes),
            "accelerations" => (&history.a_ddot, history.modes),
            "motion" => (&history.motion, history.motion_width()),
            "suspension_shortenings" => (&history.shortenings, history.axles),
            "friction" => (&history.friction, history.axles),
            _ => return Err(Error::input("states", format!("\"{name}\""), "no such state").into()),
        };
        rows(py, values.clone(), width)
    }

    #[getter]
    fn sections<'py>(&self, py: Python<'py>) -> Vector<'py> {
        self.analysis.sections.clone().into_pyarray(py)
    }

    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> Vector<'py> {
        self.analysis.modes.omega.clone().into_pyarray(py)
    }

    #[getter]
    fn static_loads<'py>(&self, py: Python<'py>) -> Vector<'py> {
        self.outcome.history.static_loads.clone().into_pyarray(py)
    }

    #[getter]
    fn step(&self) -> f64 {
        self.outcome.history.step
    }

    #[getter]
    fn steps(&self) -> usize {
        self.outcome.history.len() - 1
    }

    #[getter]
    fn final_speed(&self) -> f64 {
        self.outcome.history.final_speed(0)
    }

    /// Extremes of a quantity: columns value, time, front-axle position and partner for each of the dynamic largest,
    /// dynamic smallest, static largest and static smallest.
    fn envelope<'py>(&self, py: Python<'py>, quantity: &str) -> PyResult<[Matrix<'py>; 4]> {
        let envelope = self.envelope_of(quantity)?;
        let columns = |extremes: &[Extreme]| {
            let values = extremes.iter().flat_map(|e| [e.value, e.time, e.position, e.partner]);
            rows(py, values.collect(), 4)
        };
        Ok([
            columns(&envelope.dynamic.max)?,
            columns(&envelope.dynamic.min)?,
            columns(&envelope.at_rest.max)?,
            columns(&envelope.at_rest.min)?,
        ])
    }

    /// Impact factors of a quantity in one sense, NaN where masked.
    fn impact_factors<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
        sense: &str,
        ratio: &str,
        mask: f64,
    ) -> PyResult<Vector<'py>> {
        let sense = match sense {
            "positive" => Sense::Positive,
            "negative" => Sense::Negative,
            "either" => Sense::Either,
            _ => {
                let allowed = "must be positive, negative or either";
                return Err(Error::input("sense", format!("\"{sense}\""), allowed).into());
            }
        };
        let ratio = match ratio {
            "extremes" => Ratio::Extremes,
            "at-dynamic-extreme" => Ratio::AtDynamicExtreme,
            "at-static-extreme" => Ratio::AtStaticExtreme,
            _ => {
                let allowed = "must be extremes, at-dynamic-extreme or at-static-extreme";
                return Err(Error::input("ratio", format!("\"{ratio}\""), allowed).into());
            }
        };
        if !(0.0..1.0).contains(&mask) {
            let allowed = "must be a fraction of the largest static value, from 0 to below 1";
            return Err(Error::input("mask", mask, allowed).into());
        }
        Ok(self.envelope_of(quantity)?.impact_factors(sense, ratio, mask).into_pyarray(py))
    }
}

/// Computes one crossing.
#[pyfunction]
#[pyo3(signature = (bridge, vehicle, *, speed, drive, modes, damping, damping_matrix, beta, step, approach, tail, gravity,
                    sections, recovery))]
#[allow(clippy::too_many_arguments)] // one per argument that Python names
pub fn cross<'py>(
    py: Python<'py>,
    bridge: &PyBridge,
    vehicle: &PyVehicle,
    speed: f64,
    drive: &str,
    modes: usize,
    damping: Vec<f64>,
    damping_matrix: Option<PyReadonlyArray2<'py, f64>>,
    beta: f64,
    step: Option<f64>,
    approach: f64,
    tail: f64,
    gravity: f64,
    sections: Option<Vec<f64>>,
    recovery: &str,
) -> PyResult<Crossing> {
    let drive = match drive {
        "constant-speed" => Drive::ConstantSpeed,
        "constant-traction" => Drive::ConstantTraction,
        _ => {
            let allowed = "must be constant-speed or constant-traction";
            return Err(Error::input("drive", format!("\"{drive}\""), allowed).into());
        }
    };
    let recovery = match recovery {
        "force-summation" => Recovery::ForceSummation,
        "force-summation-by-rates" => Recovery::ForceSummationByRates,
        "superposition" => Recovery::Superposition,
        _ => {
            let allowed = "must be force-summation, force-summation-by-rates or superposition";
            return Err(Error::input("recovery", format!("\"{recovery}\""), allowed).into());
        }
    };
    let damping = match damping_matrix {
        None => Damping::Ratios(damping),
        Some(c) => {
            let c = c.as_array();
            Damping::Viscous(Mat::from_fn(c.nrows(), c.ncols(), |i, j| c[[i, j]]))
        }
    };
    let settings = Settings { drive, beta, step, approach, tail, gravity, ..Settings::at_speed(speed) };
    let (analysis, outcome) = interruptible(py, |go_on| {
        let analysis = bridge.0.analysis(Asked { modes, damping, sections, recovery }, go_on)?;
        let outcome = analysis.cross(&vehicle.0, &settings, go_on)?;
        Ok((analysis, outcome))
    })?;
    Ok(Crossing { analysis, outcome })
}
