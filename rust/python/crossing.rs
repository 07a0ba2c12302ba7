//! A crossing for Python; its arrays are made when asked for.

use std::sync::Arc;

use faer::Mat;
use nalgebra::DVector;
use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use super::bridge::{Asked, PyBridge};
use super::road::PyRoad;
use super::vehicle::PyVehicle;
use super::{Matrix, Vector, interruptible, packed, preparing, rows};
use crate::crossing::analysis::{self, Analysis};
use crate::crossing::envelope::{Envelope, Extreme, Ratio, Sense};
use crate::damping::Damping;
use crate::error::Error;
use crate::memory;
use crate::passage::settings::{Settings, Tail};
use crate::passage::{Braking, Direction, Drive, Passage};
use crate::recovery::Recovery;
use crate::statics::quantity::Quantity;
use crate::vehicle::Vehicle;

/// A crossing that has been computed; its arrays are made when asked for.
#[pyclass(frozen, module = "spanwise._core")]
pub struct Crossing {
    analysis: Arc<Analysis>,
    outcome: analysis::Outcome,
    vehicles: Vec<Vehicle>,
}

/// The kind of response of this name.
pub fn quantity(name: &str) -> Result<Quantity, Error> {
    Quantity::ALL.into_iter().find(|quantity| quantity.of_results() == name).ok_or_else(|| {
        let names = Quantity::ALL.map(Quantity::of_results).join(", ");
        Error::input("quantity", format!("\"{name}\""), format!("must be one of {names}"))
    })
}

impl Crossing {
    fn envelope_of(&self, py: Python<'_>, name: &str) -> PyResult<Envelope> {
        let quantity = match name {
            "axle_loads" => return Ok(self.outcome.axle_loads.clone()),
            // On both sides of a section.
            "shear" => Quantity::ShearLeft,
            name => quantity(name)?,
        };
        interruptible(py, |stop| self.analysis.envelope_of(&self.outcome, quantity, stop))
    }
}

#[pymethods]
impl Crossing {
    /// One that has travelled: its bridge, what was asked of it, its vehicles, and its `state`.
    #[staticmethod]
    #[pyo3(signature = (bridge, vehicles, state, *, modes, damping, damping_matrix, sections, recovery))]
    #[allow(clippy::too_many_arguments)] // one per argument that Python names
    fn received(
        py: Python<'_>,
        bridge: &PyBridge,
        vehicles: Vec<PyRef<'_, PyVehicle>>,
        state: &[u8],
        modes: usize,
        damping: Vec<f64>,
        damping_matrix: Option<PyReadonlyArray2<'_, f64>>,
        sections: Option<Vec<f64>>,
        recovery: &str,
    ) -> PyResult<Self> {
        let asked = Asked::new(modes, damped(damping, damping_matrix), sections, recovery_named(recovery)?);
        let vehicles = vehicles.iter().map(|vehicle| vehicle.0.clone()).collect();
        let read = postcard::from_bytes::<analysis::Outcome>(state);
        let outcome = read.map_err(|e| Error::input("state", format!("{} bytes", state.len()), e.to_string()))?;
        let analysis = interruptible(py, |stop| bridge.0.analysis(asked, stop))?;
        let outcome = analysis.received(outcome)?;
        Ok(Crossing { analysis, outcome, vehicles })
    }

    /// All that was computed, as bytes.
    #[getter]
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        packed(py, &self.outcome)
    }

    /// The quasi-static part of the deck's acceleration at every instant.
    fn quasi_static_acceleration<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        let all = interruptible(py, |stop| self.analysis.quasi_static_acceleration(&self.outcome, stop))?;
        rows(py, all, self.analysis.sections.len())
    }

    /// The dynamic and the static responses of a quantity at every instant.
    fn histories<'py>(&self, py: Python<'py>, name: &str) -> PyResult<[Matrix<'py>; 2]> {
        let quantity = quantity(name)?;
        let width = self.analysis.count(quantity);
        let [dynamic, at_rest] = interruptible(py, |stop| self.analysis.histories(&self.outcome, quantity, stop))?;
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
            "elevations" => (&history.elevations, history.axles),
            "suspension_shortenings" => (&history.shortenings, history.axles),
            "friction" => (&history.friction, history.axles),
            _ => return Err(Error::input("states", format!("\"{name}\""), "no such state").into()),
        };
        let mut copy = Vec::new();
        memory::reserve(&mut copy, "states", name, values.len())?;
        copy.extend_from_slice(values);
        rows(py, copy, width)
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

    /// Root mean square of each axle load about its static value, by that value.
    #[getter]
    fn load_coefficients<'py>(&self, py: Python<'py>) -> Vector<'py> {
        self.outcome.load_coefficients().into_pyarray(py)
    }

    #[getter]
    fn step(&self) -> f64 {
        self.outcome.history.step
    }

    #[getter]
    fn steps(&self) -> usize {
        self.outcome.history.len() - 1
    }

    /// Length of the tail [s].
    #[getter]
    fn tail(&self) -> f64 {
        let history = &self.outcome.history;
        history.time.last().map_or(0.0, |last| last - history.ended)
    }

    /// Whether the tail ended because nothing that is looked at can follow.
    #[getter]
    fn settled(&self) -> bool {
        self.outcome.history.settled
    }

    /// How far free vibration after the end can exceed an extreme, in parts of the largest of its kind along the bridge;
    /// not a number where a vehicle stands on the bridge.
    #[getter]
    fn growth(&self) -> f64 {
        let analysis::Outcome { history, envelope: Envelope { dynamic, .. }, .. } = &self.outcome;
        let Analysis { free, look, .. } = &*self.analysis;
        let seen = |row: usize| {
            let response = look.first_of_row[row];
            [dynamic.max[response].value, dynamic.min[response].value]
        };
        let of = |reach| free.growth(reach, seen)[0];
        history.reach.as_ref().map_or(f64::NAN, of)
    }

    /// Largest magnitude of a quantity that free vibration after the end can reach; none where a vehicle stands on the
    /// bridge.
    fn reach<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Option<Vector<'py>>> {
        let of = |quantity| interruptible(py, |stop| self.analysis.bounds_of(&self.outcome, quantity, stop));
        let all = match name {
            // On both sides of a section.
            "shear" => of(Quantity::ShearLeft)?
                .zip(of(Quantity::ShearRight)?)
                .map(|(left, right)| left.iter().zip(right).map(|(left, right)| left.max(right)).collect()),
            _ => of(quantity(name)?)?,
        };
        Ok(all.map(|all: Vec<f64>| all.into_pyarray(py)))
    }

    /// Speed of each vehicle at the end.
    #[getter]
    fn final_speeds(&self) -> Vec<f64> {
        (0..self.vehicles.len()).map(|v| self.outcome.history.final_speed(v)).collect()
    }

    /// When each vehicle came to rest, if it did.
    #[getter]
    fn stopped(&self) -> Vec<Option<f64>> {
        self.outcome.history.vehicles.iter().map(|vehicle| vehicle.stopped).collect()
    }

    /// Axle, beginning and end of every time a wheel was off the road.
    #[getter]
    fn lift_offs(&self) -> Vec<(usize, f64, f64)> {
        self.outcome.history.lift_offs().into_iter().map(|l| (l.axle, l.from, l.to)).collect()
    }

    /// Heave and pitch of every body of a vehicle, the displacement of the mass of every axle, and the travel, each with
    /// its first and second derivative, at every instant: told from a line that is lower by `drift` where its way over the
    /// bridge begins, and by so much more per way than the line from which it feels its road.
    fn motion<'py>(&self, py: Python<'py>, vehicle: usize, drift: [f64; 2]) -> PyResult<Matrix<'py>> {
        let history = &self.outcome.history;
        let (Some(mover), Some(columns)) = (self.vehicles.get(vehicle), history.vehicles.get(vehicle)) else {
            let allowed = format!("must be below {}, the number of vehicles", self.vehicles.len());
            return Err(Error::input("vehicle", vehicle, allowed).into());
        };
        let assembly = mover.assembly();
        // Of each what gives it from the coordinates, where it is ahead of the centre of mass, and whether it is a pitch.
        let mut lines: Vec<(Option<&DVector<f64>>, f64, bool)> = Vec::new();
        for ([heave, pitch], &at) in assembly.bodies.iter().zip(&assembly.body_positions) {
            lines.extend([(Some(heave), at, false), (Some(pitch), at, true)]);
        }
        lines.extend(assembly.hops.iter().zip(&assembly.contacts).map(|(hop, c)| (hop.as_ref(), c.position, false)));
        let width = 3 * (lines.len() + 1);
        let [higher, steeper] = drift;
        let values = interruptible(py, |stop| {
            let mut values = Vec::new();
            memory::reserve(&mut values, "states", "motion", history.len() * width)?;
            for row in history.motion.chunks_exact(history.motion_width()) {
                let own = &row[columns.motion.clone()];
                let travel = &own[own.len() - 3..];
                for &(line, at, pitches) in &lines {
                    let rise = match pitches {
                        true => [steeper, 0.0, 0.0],
                        false => [higher + steeper * (travel[0] + at), steeper * travel[1], steeper * travel[2]],
                    };
                    for (derivative, rise) in rise.into_iter().enumerate() {
                        let coordinates = own.iter().skip(derivative).step_by(3);
                        let sum = |line: &DVector<f64>| line.iter().zip(coordinates).map(|(b, q)| b * q).sum::<f64>();
                        values.push(line.map_or(0.0, |line| sum(line) - rise));
                    }
                }
                values.extend(travel);
                stop.check()?;
            }
            Ok(values)
        })?;
        rows(py, values, width)
    }

    /// Extremes of a quantity: columns value, time, front-axle position and partner for each of the dynamic largest,
    /// dynamic smallest, static largest and static smallest.
    fn envelope<'py>(&self, py: Python<'py>, quantity: &str) -> PyResult<[Matrix<'py>; 4]> {
        let envelope = self.envelope_of(py, quantity)?;
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
        Ok(self.envelope_of(py, quantity)?.impact_factors(sense, ratio, mask).into_pyarray(py))
    }
}

/// How a vehicle is driven: its name, and the numbers that go with it.
pub type PyDrive = (String, Vec<f64>, Vec<f64>);

/// Vehicle, speed, drive, direction, entry, lane, road.
pub type PyPassage<'py> =
    (PyRef<'py, PyVehicle>, Option<f64>, Option<PyDrive>, String, f64, i64, Option<PyRef<'py, PyRoad>>);

/// A drive as Python names it.
pub fn drive((name, first, second): PyDrive) -> Result<Drive, Error> {
    match (name.as_str(), &first[..]) {
        ("constant-speed", []) => Ok(Drive::ConstantSpeed),
        ("constant-traction", []) => Ok(Drive::ConstantTraction),
        ("acceleration", &[acceleration]) => Ok(Drive::Acceleration(acceleration)),
        ("speeds", _) => Ok(Drive::Speeds { times: first, speeds: second }),
        ("braking", &[deceleration, from, ramp, adhesion]) => {
            Ok(Drive::Braking(Braking { deceleration, from, ramp, adhesion }))
        }
        _ => Err(Error::input(
            "drive",
            format!("\"{name}\""),
            "must be constant-speed or constant-traction; acceleration, speeds and braking have numbers of their own",
        )),
    }
}

/// A vehicle on its way.
pub fn passage((vehicle, speed, driven, direction, entry, lane, road): PyPassage<'_>) -> Result<Passage, Error> {
    let direction = match direction.as_str() {
        "right" => Direction::Right,
        "left" => Direction::Left,
        _ => return Err(Error::input("direction", format!("\"{direction}\""), "must be right or left")),
    };
    Ok(Passage {
        vehicle: vehicle.0.clone(),
        speed,
        drive: driven.map(drive).transpose()?,
        direction,
        entry,
        lane,
        road: road.map(|road| Arc::new(road.0.clone())),
    })
}

/// The recovery of this name.
pub fn recovery_named(name: &str) -> Result<Recovery, Error> {
    match name {
        "force-summation" => Ok(Recovery::ForceSummation),
        "force-summation-by-rates" => Ok(Recovery::ForceSummationByRates),
        "superposition" => Ok(Recovery::Superposition),
        _ => {
            let allowed = "must be force-summation, force-summation-by-rates or superposition";
            Err(Error::input("recovery", format!("\"{name}\""), allowed))
        }
    }
}

/// Damping by the matrix, if there is one, or else by ratios.
pub fn damped(ratios: Vec<f64>, matrix: Option<PyReadonlyArray2<'_, f64>>) -> Damping {
    match matrix {
        None => Damping::Ratios(ratios),
        Some(c) => {
            let c = c.as_array();
            Damping::Viscous(Mat::from_fn(c.nrows(), c.ncols(), |i, j| c[[i, j]]))
        }
    }
}

/// Computes one crossing.
#[pyfunction]
#[pyo3(signature = (bridge, passages, *, modes, damping, damping_matrix, beta, step, approach, ramp, tail, gravity,
                    lift_off, sections, recovery))]
#[allow(clippy::too_many_arguments)] // one per argument that Python names
pub fn cross<'py>(
    py: Python<'py>,
    bridge: &PyBridge,
    passages: Vec<PyPassage<'py>>,
    modes: usize,
    damping: Vec<f64>,
    damping_matrix: Option<PyReadonlyArray2<'py, f64>>,
    beta: f64,
    step: Option<f64>,
    approach: f64,
    ramp: f64,
    tail: Option<f64>,
    gravity: f64,
    lift_off: bool,
    sections: Option<Vec<f64>>,
    recovery: &str,
) -> PyResult<Crossing> {
    let asked = Asked::new(modes, damped(damping, damping_matrix), sections, recovery_named(recovery)?);
    let passages = passages.into_iter().map(passage).collect::<Result<Vec<_>, Error>>()?;
    // Every passage says its own speed or brings it with its drive.
    let tail = tail.map_or(Tail::Free, Tail::Fixed);
    let settings = Settings { beta, step, approach, ramp, tail, gravity, lift_off, ..Settings::at_speed(f64::NAN) };
    let solved = Arc::clone(&bridge.0);
    let assemblies = passages.iter().map(|passage| passage.vehicle.assembly());
    let of_vehicles: usize = assemblies.map(|assembly| assembly.coordinates.len() + assembly.contacts.len()).sum();
    let order = solved.order().max(asked.preparation.sections.as_ref().map_or(0, Vec::len)).max(of_vehicles);
    let (analysis, outcome, passages) = preparing(py, order, move |stop| {
        let analysis = solved.analysis(asked, stop)?;
        let outcome = analysis.cross_all(&passages, &settings, stop)?;
        Ok((analysis, outcome, passages))
    })?;
    let vehicles = passages.into_iter().map(|passage| passage.vehicle).collect();
    Ok(Crossing { analysis, outcome, vehicles })
}
