//! The bridge for Python, with what was last worked out for it.

use std::sync::{Arc, Mutex, PoisonError};

use numpy::ndarray::Array1;
use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::prelude::*;

use super::{Matrix, Vector, matrix, rows};
use crate::analysis::Analysis;
use crate::bridge::{Bridge, Fixity, Stations, Support};
use crate::crossing::Damping;
use crate::error::Error;
use crate::flexibility::{Flexibility, Restraint, Structure};
use crate::influence;
use crate::modes::Modes;
use crate::recovery::Recovery;

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

fn structure(name: &str) -> Result<Structure, Error> {
    match name {
        "basic" => Ok(Structure::Basic),
        "actual" => Ok(Structure::Actual),
        _ => Err(Error::input("structure", format!("\"{name}\""), "must be basic or actual")),
    }
}

/// A bridge with what was last worked out for it: one crossing after another need not prepare it anew.
pub struct Solved {
    bridge: Bridge,
    modes: Mutex<Option<Modes>>,
    analysis: Mutex<Option<(Asked, Arc<Analysis>)>>,
}

/// What an analysis was asked for.
#[derive(Clone, PartialEq)]
pub struct Asked {
    pub modes: usize,
    pub damping: Damping,
    pub sections: Option<Vec<f64>>,
    pub recovery: Recovery,
}

impl Solved {
    fn new(bridge: Bridge) -> Self {
        Solved { bridge, modes: Mutex::new(None), analysis: Mutex::new(None) }
    }

    pub fn analysis(&self, asked: Asked, go_on: &mut dyn FnMut() -> bool) -> Result<Arc<Analysis>, Error> {
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

/// A beam bridge, its mass lumped at stations.
#[pyclass(name = "Bridge", frozen, module = "spanwise._core")]
pub struct PyBridge(pub Solved);

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
