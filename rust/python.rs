//! The extension module `spanwise._core`: conversion between Python and the core, and nothing else.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use crate::analysis::Analysis;
use crate::bridge::{Bridge, Fixity};
use crate::crossing::Damping;
use crate::error::Error;
use crate::flexibility::Flexibility;
use crate::modes::Modes;
use crate::recovery::Recovery;

/// Keeps freed memory for the next crossing: histories are megabytes, and fresh pages cost more than filling them.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Time between two looks at whether Python wants to interrupt.
const SIGNAL_INTERVAL: Duration = Duration::from_millis(100);

impl From<Error> for PyErr {
    fn from(error: Error) -> Self {
        let text = error.to_string();
        if error.is_input() { PyValueError::new_err(text) } else { PyRuntimeError::new_err(text) }
    }
}

/// Runs `work` with the interpreter released. Every 100 ms its question whether to go on attaches again and lets Python
/// handle signals; what a handler raises, such as `KeyboardInterrupt`, ends the work and is raised.
fn interruptible<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&mut dyn FnMut() -> bool) -> Result<T, Error> + Send,
) -> PyResult<T> {
    let mut raised = None;
    let result = py.detach(|| {
        let mut last = Instant::now();
        let mut go_on = || {
            if last.elapsed() < SIGNAL_INTERVAL {
                return true;
            }
            let answer = Python::attach(|py| py.check_signals());
            last = Instant::now();
            let ok = answer.is_ok();
            raised = answer.err();
            ok
        };
        work(&mut go_on)
    });
    match raised {
        Some(error) => Err(error),
        None => Ok(result?),
    }
}

fn fixity(name: &str, key: &str, free: bool) -> Result<Option<Fixity>, Error> {
    match name {
        "pinned" => Ok(Some(Fixity::Pinned)),
        "clamped" => Ok(Some(Fixity::Clamped)),
        "free" if free => Ok(None),
        _ => {
            let allowed = if free { "must be pinned, clamped or free" } else { "must be pinned or clamped" };
            Err(Error::input(key, format!("\"{name}\""), allowed))
        }
    }
}

/// A bridge with what was last worked out for it: one crossing after another need not prepare it anew.
struct Solved {
    bridge: Bridge,
    modes: Mutex<Option<Modes>>,
    analysis: Mutex<Option<(Asked, Arc<Analysis>)>>,
}

/// What an analysis was asked for.
#[derive(Clone, PartialEq)]
struct Asked {
    modes: usize,
    damping: Damping,
    sections: Option<Vec<f64>>,
    recovery: Recovery,
}

impl Solved {
    fn new(bridge: Bridge) -> Self {
        Solved { bridge, modes: Mutex::new(None), analysis: Mutex::new(None) }
    }

    fn analysis(&self, asked: Asked, go_on: &mut dyn FnMut() -> bool) -> Result<Arc<Analysis>, Error> {
        let mut kept = self.analysis.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((for_what, analysis)) = kept.as_ref()
            && *for_what == asked
        {
            return Ok(Arc::clone(analysis));
        }
        let modes = self.modes(asked.modes)?;
        let sections = asked.sections.as_deref();
        let analysis = Arc::new(Analysis::new(&self.bridge, modes, &asked.damping, sections, asked.recovery, go_on)?);
        *kept = Some((asked, Arc::clone(&analysis)));
        Ok(analysis)
    }

    fn modes(&self, count: usize) -> Result<Modes, Error> {
        let mut kept = self.modes.lock().unwrap_or_else(PoisonError::into_inner);
        match kept.as_ref() {
            Some(modes) if count > 0 && modes.len() >= count => Ok(modes.truncated(count)),
            _ => {
                let modes = Modes::new(&self.bridge, &Flexibility::new(&self.bridge, &[])?, count)?;
                *kept = Some(modes.clone());
                Ok(modes)
            }
        }
    }
}

#[pymodule]
mod _core {
    use std::sync::Arc;

    use faer::Mat;
    use numpy::ndarray::{Array1, Array2};
    use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
    use pyo3::prelude::*;

    use super::{Asked, Solved, fixity, interruptible};
    use crate::analysis::{self, Analysis};
    use crate::bridge::{Bridge, Fixity, Stations, Support};
    use crate::crossing::{Damping, Drive, Settings};
    use crate::envelope::{Envelope, Extreme, Ratio, Sense};
    use crate::error::Error;
    use crate::flexibility::{Flexibility, Restraint, Structure};
    use crate::influence::{self, Quantity};
    use crate::recovery::Recovery;
    use crate::vehicle::{self, Axle, Suspension};

    type Vector<'py> = Bound<'py, PyArray1<f64>>;
    type Matrix<'py> = Bound<'py, PyArray2<f64>>;

    /// Version of the compiled core.
    #[pymodule_export]
    #[allow(non_upper_case_globals)] // the name as Python sees it
    const __version__: &str = env!("CARGO_PKG_VERSION");

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        // NumPy's interface is looked up when first used; done now, no pending signal can get in the way.
        let _ = PyArray1::<f64>::zeros(module.py(), 0, false);
        Ok(())
    }

    /// Row-major values as a two-dimensional array, without a copy.
    fn rows<'py>(py: Python<'py>, values: Vec<f64>, width: usize) -> PyResult<Matrix<'py>> {
        let height = values.len().checked_div(width).unwrap_or(0);
        values.into_pyarray(py).reshape([height, width])
    }

    fn matrix<'py>(py: Python<'py>, m: &Mat<f64>) -> Matrix<'py> {
        Array2::from_shape_fn((m.nrows(), m.ncols()), |(i, j)| m[(i, j)]).into_pyarray(py)
    }

    fn structure(name: &str) -> Result<Structure, Error> {
        match name {
            "basic" => Ok(Structure::Basic),
            "actual" => Ok(Structure::Actual),
            _ => Err(Error::input("structure", format!("\"{name}\""), "must be basic or actual")),
        }
    }

    /// A beam bridge, its mass lumped at stations.
    #[pyclass(name = "Bridge", frozen, module = "spanwise._core")]
    struct PyBridge(Solved);

    #[pymethods]
    impl PyBridge {
        #[new]
        #[allow(clippy::too_many_arguments)] // one per argument that Python names
        #[pyo3(signature = (*, length, supports, flexural_rigidity, mass, stations_per_span, stations, point_masses))]
        fn new(
            py: Python<'_>,
            length: f64,
            supports: Vec<(f64, String)>,
            flexural_rigidity: Vec<f64>,
            mass: Vec<f64>,
            stations_per_span: Vec<usize>,
            stations: Option<Vec<f64>>,
            point_masses: Vec<(f64, f64)>,
        ) -> PyResult<Self> {
            let supports = supports
                .into_iter()
                .enumerate()
                .map(|(i, (at, name))| {
                    let fixity = fixity(&name, &format!("supports[{i}]"), false)?.unwrap_or(Fixity::Pinned);
                    Ok(Support { at, fixity })
                })
                .collect::<Result<_, Error>>()?;
            let stations = stations.map_or(Stations::PerSpan(stations_per_span), Stations::At);
            let bridge =
                py.detach(|| Bridge::new(length, supports, &flexural_rigidity, &mass, &stations, &point_masses))?;
            Ok(PyBridge(Solved::new(bridge)))
        }

        #[staticmethod]
        #[allow(clippy::too_many_arguments)] // one per argument that Python names
        #[pyo3(signature = (*, spans, ends, flexural_rigidity, mass, stations_per_span, stations, point_masses))]
        fn continuous(
            py: Python<'_>,
            spans: Vec<f64>,
            ends: (String, String),
            flexural_rigidity: Vec<f64>,
            mass: Vec<f64>,
            stations_per_span: Vec<usize>,
            stations: Option<Vec<f64>>,
            point_masses: Vec<(f64, f64)>,
        ) -> PyResult<Self> {
            let ends = [fixity(&ends.0, "ends[0]", true)?, fixity(&ends.1, "ends[1]", true)?];
            let stations = stations.map_or(Stations::PerSpan(stations_per_span), Stations::At);
            let bridge =
                py.detach(|| Bridge::continuous(&spans, ends, &flexural_rigidity, &mass, &stations, &point_masses))?;
            Ok(PyBridge(Solved::new(bridge)))
        }

        #[getter]
        fn length(&self) -> f64 {
            self.0.bridge.length()
        }

        #[getter]
        fn supports(&self) -> Vec<(f64, &'static str)> {
            let name = |fixity| match fixity {
                Fixity::Pinned => "pinned",
                Fixity::Clamped => "clamped",
            };
            self.0.bridge.supports().iter().map(|s| (s.at, name(s.fixity))).collect()
        }

        #[getter]
        fn span_bounds<'py>(&self, py: Python<'py>) -> Vector<'py> {
            self.0.bridge.span_bounds().to_vec().into_pyarray(py)
        }

        #[getter]
        fn flexural_rigidity<'py>(&self, py: Python<'py>) -> Vector<'py> {
            self.0.bridge.flexural_rigidity().to_vec().into_pyarray(py)
        }

        #[getter]
        fn stations<'py>(&self, py: Python<'py>) -> Vector<'py> {
            self.0.bridge.stations().iter().map(|s| s.at).collect::<Array1<f64>>().into_pyarray(py)
        }

        #[getter]
        fn masses<'py>(&self, py: Python<'py>) -> Vector<'py> {
            self.0.bridge.stations().iter().map(|s| s.mass).collect::<Array1<f64>>().into_pyarray(py)
        }

        fn default_sections<'py>(&self, py: Python<'py>) -> Vector<'py> {
            self.0.bridge.default_sections().into_pyarray(py)
        }

        /// Circular frequencies, shapes at the stations, and shapes and slopes at x.
        fn modes<'py>(
            &self,
            py: Python<'py>,
            count: usize,
            x: Option<PyReadonlyArray1<'py, f64>>,
        ) -> PyResult<(Vector<'py>, Matrix<'py>, Option<Matrix<'py>>)> {
            let bridge = &self.0.bridge;
            let modes = py.detach(|| self.0.modes(count))?;
            let along = match x {
                None => None,
                Some(x) => {
                    let x = x.as_array().to_vec();
                    let values = py.detach(|| {
                        let flexibility = Flexibility::new(bridge, &[])?;
                        let lines = modes.lines(bridge, &flexibility);
                        let mesh = flexibility.mesh();
                        let values = x.iter().flat_map(|&x| lines.iter().map(move |line| line.at(mesh, x)));
                        Ok::<Vec<f64>, Error>(values.collect())
                    })?;
                    Some(rows(py, values, modes.len())?)
                }
            };
            let shapes = matrix(py, &modes.shapes);
            Ok((modes.omega.into_pyarray(py), shapes, along))
        }

        /// Positions of the reference stations and the flexibility matrix there: F* or F.
        fn flexibility<'py>(&self, py: Python<'py>, name: &str) -> PyResult<(Vector<'py>, Matrix<'py>)> {
            let structure = structure(name)?;
            let bridge = &self.0.bridge;
            let (x, f) = py.detach(|| {
                let flexibility = Flexibility::new(bridge, &[])?;
                let mut nodes = flexibility.reference_nodes(bridge);
                if structure == Structure::Actual {
                    let stations = bridge.stations().iter();
                    nodes = stations.map(|s| flexibility.mesh().node_at(s.at)).collect();
                }
                let x: Vec<f64> = nodes.iter().map(|&node| flexibility.mesh().nodes()[node]).collect();
                Ok::<_, Error>((x, flexibility.matrix(&nodes, &nodes, structure)))
            })?;
            Ok((x.into_pyarray(py), matrix(py, &f)))
        }

        /// K^R, the stiffness of the redundant supports.
        fn redundant_stiffness<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
            let flexibility = Flexibility::new(&self.0.bridge, &[])?;
            Ok(matrix(py, &flexibility.redundant_stiffness()))
        }

        /// Restraints of the basic bridge: position, kind, and its reaction per unit load at each reference station.
        fn outer_reactions<'py>(&self, py: Python<'py>) -> PyResult<Vec<(f64, &'static str, Vector<'py>)>> {
            let flexibility = Flexibility::new(&self.0.bridge, &[])?;
            let nodes = flexibility.reference_nodes(&self.0.bridge);
            let each = flexibility.outer_restraints().into_iter().map(|restraint| {
                let line = influence::reaction(&flexibility, restraint, Structure::Basic);
                let values: Vec<f64> = nodes.iter().map(|&node| line.at_node(node)).collect();
                let kind = match restraint {
                    Restraint::Deflection(_) => "force",
                    Restraint::Slope(_) => "moment",
                };
                (flexibility.mesh().nodes()[restraint.node()], kind, values.into_pyarray(py))
            });
            Ok(each.collect())
        }

        /// Influence line of a response at `at`, for unit loads at x.
        fn influence_line<'py>(
            &self,
            py: Python<'py>,
            quantity: &str,
            at: f64,
            x: PyReadonlyArray1<'py, f64>,
            name: &str,
        ) -> PyResult<Vector<'py>> {
            let structure = structure(name)?;
            let bridge = &self.0.bridge;
            if !(at >= 0.0 && at <= bridge.length()) {
                let allowed = format!("must lie on the beam, 0 to {} m", bridge.length());
                return Err(Error::input("at", format!("{at} m"), allowed).into());
            }
            let flexibility = Flexibility::new(bridge, &[at])?;
            let node = flexibility.mesh().node_at(at);
            let support = Restraint::Deflection(node);
            let line = match quantity {
                "deflection" => influence::deflection(&flexibility, node, structure),
                "slope" => influence::slope(&flexibility, node, structure),
                "moment" => influence::moment(&flexibility, node, structure),
                "shear-left" => influence::shear(&flexibility, node, structure)[0].clone(),
                "shear-right" => influence::shear(&flexibility, node, structure)[1].clone(),
                "reaction" => {
                    let held = flexibility.outer_restraints().contains(&support)
                        || (structure == Structure::Actual && flexibility.redundants().contains(&support));
                    if !held {
                        let allowed = "must be the position of a support of this structure";
                        return Err(Error::input("at", format!("{at} m"), allowed).into());
                    }
                    influence::reaction(&flexibility, support, structure)
                }
                _ => {
                    let allowed = "must be deflection, slope, moment, shear-left, shear-right or reaction";
                    return Err(Error::input("quantity", format!("\"{quantity}\""), allowed).into());
                }
            };
            let values = x.as_array().iter().map(|&x| line.at(flexibility.mesh(), x)).collect::<Array1<f64>>();
            Ok(values.into_pyarray(py))
        }
    }

    /// A rigid body on massless axles with friction.
    #[pyclass(name = "Vehicle", frozen, module = "spanwise._core")]
    struct PyVehicle(vehicle::Vehicle);

    #[pymethods]
    impl PyVehicle {
        #[new]
        #[pyo3(signature = (*, mass, pitch_inertia, cg_height, axles))]
        fn new(mass: f64, pitch_inertia: f64, cg_height: f64, axles: Vec<[f64; 5]>) -> PyResult<Self> {
            let axles = axles.into_iter().map(|[position, tyre, suspension, limit, initial]| Axle {
                position,
                tyre_stiffness: tyre,
                suspension_stiffness: suspension,
                friction_limit: limit,
                initial_friction: initial,
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

    /// A crossing that has been computed; its arrays are made when asked for.
    #[pyclass(frozen, module = "spanwise._core")]
    struct Crossing {
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
            let [dynamic, at_rest] =
                interruptible(py, |go_on| self.analysis.histories(&self.outcome, quantity, go_on))?;
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
                "body" => (&history.body, 9),
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
            self.outcome.history.final_speed()
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
    fn cross<'py>(
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
        let settings = Settings { speed, drive, beta, step, approach, tail, gravity };
        let (analysis, outcome) = interruptible(py, |go_on| {
            let analysis = bridge.0.analysis(Asked { modes, damping, sections, recovery }, go_on)?;
            let outcome = analysis.cross(&vehicle.0, &settings, go_on)?;
            Ok((analysis, outcome))
        })?;
        Ok(Crossing { analysis, outcome })
    }
}
