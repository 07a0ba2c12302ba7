//! A crossing for Python; its arrays are made when asked for.

use std::sync::Arc;

use nalgebra::DVector;
use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use super::bridge::{Asked, PyBridge, mat};
use super::given::{Given, one_of};
use super::road::PyRoad;
use super::vehicle::PyVehicle;
use super::{Matrix, Vector, interruptible, packed, preparing, rows};
use crate::crossing::analysis::{self, Analysis};
use crate::crossing::envelope::{Envelope, Extreme, Ratio, Sense};
use crate::damping::Damping;
use crate::error::Error;
use crate::memory;
use crate::passage::planned::Course;
use crate::passage::settings::{Settings, Tail};
use crate::passage::{Braking, Direction, Drive, Passage};
use crate::recovery::Recovery;
use crate::statics::quantity::Quantity;

/// A crossing that has been computed; its arrays are made when asked for.
#[pyclass(frozen, module = "spanwise._core")]
pub struct Crossing {
    analysis: Arc<Analysis>,
    outcome: analysis::Outcome,
    passages: Vec<Passage>,
    settings: Settings,
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

    /// Elevations under the axles at every instant, off the lines from which motion is told.
    fn told(&self, elevations: &mut [f64]) -> Result<(), Error> {
        let history = &self.outcome.history;
        let mut first = 0;
        for (vehicle, passage) in self.passages.iter().enumerate() {
            let ([higher, steeper], length, direction) = self.drift(vehicle)?;
            let own = first..first + passage.vehicle.assembly().contacts.len();
            first = own.end;
            let rows = elevations.chunks_exact_mut(history.axles).zip(history.positions.chunks_exact(history.axles));
            for (z, x) in rows.flat_map(|(z, x)| z[own.clone()].iter_mut().zip(&x[own.clone()])) {
                let way = if direction == Direction::Right { *x } else { length - *x };
                *z += higher + steeper * way;
            }
        }
        Ok(())
    }

    /// The line from which the motion of a vehicle is told, of that from which it feels its road: see [`Course::drift`].
    fn drift(&self, vehicle: usize) -> Result<([f64; 2], f64, Direction), Error> {
        let Some(passage) = self.passages.get(vehicle) else {
            let allowed = format!("must be below {}, the number of vehicles", self.passages.len());
            return Err(Error::input("vehicle", vehicle, allowed));
        };
        let length = self.analysis.model.shapes.mesh().length();
        let course = Course::new(passage, &self.settings, "", 0)?;
        Ok((course.drift(&self.settings, length), length, passage.direction))
    }
}

#[pymethods]
impl Crossing {
    /// One that has travelled: its bridge, what was asked of it, its vehicles, and its `state`.
    #[staticmethod]
    #[pyo3(signature = (bridge, passages, conditions, state, *, speed, road))]
    fn received(
        py: Python<'_>,
        bridge: &PyBridge,
        passages: &Bound<'_, PyAny>,
        conditions: &Bound<'_, PyAny>,
        state: &[u8],
        speed: Option<f64>,
        road: &PyRoad,
    ) -> PyResult<Self> {
        let (asked, settings) = conditions_of(conditions, speed, road)?;
        let passages = passages_of(passages)?;
        let read = postcard::from_bytes::<analysis::Outcome>(state);
        let outcome = read.map_err(|e| Error::input("state", format!("{} bytes", state.len()), e.to_string()))?;
        let analysis = interruptible(py, |stop| bridge.0.analysis(asked, stop))?;
        let outcome = analysis.received(outcome)?;
        Ok(Crossing { analysis, outcome, passages, settings })
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
        if name == "elevations" {
            self.told(&mut copy)?;
        }
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
        (0..self.passages.len()).map(|v| self.outcome.history.final_speed(v)).collect()
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
    /// its first and second derivative, at every instant: told from the line of the whole way.
    fn motion<'py>(&self, py: Python<'py>, vehicle: usize) -> PyResult<Matrix<'py>> {
        let history = &self.outcome.history;
        let ([higher, steeper], ..) = self.drift(vehicle)?;
        let (mover, columns) = (&self.passages[vehicle].vehicle, &history.vehicles[vehicle]);
        let assembly = mover.assembly();
        // Of each what gives it from the coordinates, where it is ahead of the centre of mass, and whether it is a pitch.
        let mut lines: Vec<(Option<&DVector<f64>>, f64, bool)> = Vec::new();
        for ([heave, pitch], &at) in assembly.bodies.iter().zip(&assembly.body_positions) {
            lines.extend([(Some(heave), at, false), (Some(pitch), at, true)]);
        }
        lines.extend(assembly.hops.iter().zip(&assembly.contacts).map(|(hop, c)| (hop.as_ref(), c.position, false)));
        let width = 3 * (lines.len() + 1);
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

    /// Impact factors of a quantity in one sense, NaN where masked, by a part that Python has checked.
    fn impact_factors<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
        sense: &str,
        ratio: &str,
        mask: f64,
    ) -> PyResult<Vector<'py>> {
        let senses = [("positive", Sense::Positive), ("negative", Sense::Negative), ("either", Sense::Either)];
        let sense = one_of("sense", sense, senses)?;
        let ratios = [
            ("extremes", Ratio::Extremes),
            ("at-dynamic-extreme", Ratio::AtDynamicExtreme),
            ("at-static-extreme", Ratio::AtStaticExtreme),
        ];
        let ratio = one_of("ratio", ratio, ratios)?;
        Ok(self.envelope_of(py, quantity)?.impact_factors(sense, ratio, mask).into_pyarray(py))
    }
}

/// A drive: a word, or an object of a kind with the numbers of it.
fn drive(driven: &Bound<'_, PyAny>) -> PyResult<Drive> {
    if let Ok(name) = driven.extract::<String>() {
        let steady = [("constant-speed", Drive::ConstantSpeed), ("constant-traction", Drive::ConstantTraction)];
        return steady.into_iter().find(|(word, _)| *word == name).map(|(_, drive)| drive).ok_or_else(|| {
            let allowed = "must be constant-speed or constant-traction; others have numbers of their own";
            Error::input("drive", format!("\"{name}\""), allowed).into()
        });
    }
    let given = Given::new(driven);
    match given.of::<String>("kind")?.as_str() {
        "acceleration" => Ok(Drive::Acceleration(given.number("acceleration")?)),
        "speeds" => Ok(Drive::Speeds { times: given.of("times")?, speeds: given.of("speeds")? }),
        _ => Ok(Drive::Braking(Braking {
            deceleration: given.number("deceleration")?,
            from: given.number("start")?,
            ramp: given.number("ramp")?,
            adhesion: given.number("friction")?,
        })),
    }
}

/// Vehicles on their way.
pub fn passages_of(passages: &Bound<'_, PyAny>) -> PyResult<Vec<Passage>> {
    passages.try_iter()?.map(|each| passage(&Given::new(&each?))).collect()
}

/// A vehicle on its way.
fn passage(given: &Given<'_, '_>) -> PyResult<Passage> {
    let core = |name: &str| given.get(name)?.getattr("_core");
    let (driven, road) = (given.get("drive")?, given.get("road")?);
    let directions = [("right", Direction::Right), ("left", Direction::Left)];
    Ok(Passage {
        vehicle: core("vehicle")?.cast::<PyVehicle>()?.get().0.clone(),
        speed: given.optional("speed")?,
        drive: (!driven.is_none()).then(|| drive(&driven)).transpose()?,
        direction: one_of("direction", &given.of::<String>("direction")?, directions)?,
        entry: given.number("entry")?,
        lane: given.of("lane_number")?,
        road: match road.is_none() {
            true => None,
            false => Some(Arc::new(core("road")?.cast::<PyRoad>()?.get().0.clone())),
        },
    })
}

/// What is asked of a bridge, and how vehicles cross it: at this speed, if they have none of their own.
pub fn conditions_of(conditions: &Bound<'_, PyAny>, speed: Option<f64>, road: &PyRoad) -> PyResult<(Asked, Settings)> {
    let given = Given::new(conditions);
    let matrix: Option<PyReadonlyArray2<'_, f64>> = given.of("matrix")?;
    let damping = match matrix {
        None => Damping::Ratios(given.of("ratios")?),
        Some(c) => Damping::Viscous(mat(c)),
    };
    let recoveries = [
        ("force-summation", Recovery::ForceSummation),
        ("force-summation-by-rates", Recovery::ForceSummationByRates),
        ("superposition", Recovery::Superposition),
    ];
    let recovery = one_of("recovery", &given.of::<String>("recovery")?, recoveries)?;
    let settings = Settings {
        speed: speed.unwrap_or(f64::NAN),
        drive: drive(&given.get("drive")?)?,
        beta: given.number("beta")?,
        accuracy: given.number("accuracy")?,
        step: given.optional("step")?,
        approach: given.number("approach")?,
        ramp: given.number("ramp")?,
        tail: given.optional("tail")?.map_or(Tail::Free, Tail::Fixed),
        gravity: given.number("gravity")?,
        lift_off: given.of("lift_off")?,
        road: Arc::new(road.0.clone()),
    };
    Ok((Asked::new(given.of("modes")?, damping, given.of("sections")?, recovery), settings))
}

/// Computes one crossing.
#[pyfunction]
#[pyo3(signature = (bridge, passages, conditions, *, speed, road))]
pub fn cross(
    py: Python<'_>,
    bridge: &PyBridge,
    passages: &Bound<'_, PyAny>,
    conditions: &Bound<'_, PyAny>,
    speed: Option<f64>,
    road: &PyRoad,
) -> PyResult<Crossing> {
    let (asked, settings) = conditions_of(conditions, speed, road)?;
    let passages = passages_of(passages)?;
    let solved = Arc::clone(&bridge.0);
    let assemblies = passages.iter().map(|passage| passage.vehicle.assembly());
    let of_vehicles: usize = assemblies.map(|assembly| assembly.coordinates.len() + assembly.contacts.len()).sum();
    let order = solved.order().max(asked.preparation.sections.as_ref().map_or(0, Vec::len)).max(of_vehicles);
    preparing(py, order, move |stop| {
        let analysis = solved.analysis(asked, stop)?;
        let outcome = analysis.cross_all(&passages, &settings, stop)?;
        Ok(Crossing { analysis, outcome, passages, settings })
    })
}
