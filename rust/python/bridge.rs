//! The bridge for Python, with what was last worked out for it.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use faer::Mat;
use numpy::{IntoPyArray, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use super::given::one_of;
use super::{Matrix, Vector, matrix, preparing, rows};
use crate::bridge::cubics::{COINCIDENT, Line, Mesh, check_lines};
use crate::bridge::distribution::Along;
use crate::bridge::lumping::Stations;
use crate::bridge::support::{Fixity, Support};
use crate::bridge::{Bridge, Layout};
use crate::crossing::analysis::{Analysis, Preparation};
use crate::damping::Damping;
use crate::error::Error;
use crate::imported::Given;
use crate::imported::by_flexibility::ByFlexibility;
use crate::imported::by_modes::{ByModes, GivenLines, TwoSided};
use crate::memory;
use crate::modes::Modes;
use crate::recovery::Recovery;
use crate::statics::flexibility::{Action, Actions, Flexibility, Restraint, Structure};
use crate::statics::influence;
use crate::statics::quantity::Quantity;
use crate::statics::settlement::Settled;
use crate::stop_token::StopToken;

fn fixity(name: &str, key: &str) -> Result<Option<Fixity>, Error> {
    one_of(key, name, [("pinned", Some(Fixity::Pinned)), ("clamped", Some(Fixity::Clamped)), ("free", None)])
}

fn structure(name: &str) -> Result<Structure, Error> {
    match name {
        "basic" => Ok(Structure::Basic),
        "actual" => Ok(Structure::Actual),
        _ => Err(Error::input("structure", format!("\"{name}\""), "must be basic or actual")),
    }
}

/// Where a bridge comes from.
enum Source {
    Described(Box<Bridge>),
    Given(Box<Given>),
}

/// A bridge with what was last worked out for it: one crossing after another need not prepare it anew.
pub struct Solved {
    source: Source,
    modes: Mutex<Option<Modes>>,
    analysis: Mutex<Option<(Asked, Arc<Analysis>)>>,
}

/// What an analysis was asked for.
#[derive(Clone, PartialEq)]
pub struct Asked {
    pub modes: usize,
    pub preparation: Preparation,
}

impl Asked {
    pub fn new(modes: usize, damping: Damping, sections: Option<Vec<f64>>, recovery: Recovery) -> Self {
        Asked { modes, preparation: Preparation { damping, sections, recovery } }
    }
}

impl Solved {
    fn new(source: Source) -> Arc<Self> {
        Arc::new(Solved { source, modes: Mutex::new(None), analysis: Mutex::new(None) })
    }

    /// Order of the largest matrix that its own masses, supports and hinges lead to.
    pub fn order(&self) -> usize {
        match &self.source {
            Source::Described(bridge) => order(bridge),
            Source::Given(given) => given.mode_count().max(given.sections().len()),
        }
    }

    /// The bridge, if it was described; `what` is asked of it.
    fn described(&self, what: &str) -> Result<&Bridge, Error> {
        match &self.source {
            Source::Described(bridge) => Ok(bridge),
            Source::Given(_) => {
                let allowed = "only of a bridge described by its spans, supports and EI; this one was given by its \
                               flexibility or its modes";
                Err(Error::input(what, "unknown", allowed))
            }
        }
    }

    pub fn analysis(&self, asked: Asked, stop: StopToken<'_>) -> Result<Arc<Analysis>, Error> {
        if let Some((for_what, analysis)) = held(&self.analysis).as_ref()
            && *for_what == asked
        {
            return Ok(Arc::clone(analysis));
        }
        // Nothing is held meanwhile: work that was left to itself must not keep others waiting.
        let analysis = Arc::new(match &self.source {
            Source::Described(bridge) => {
                let modes = self.modes(bridge, asked.modes)?;
                asked.preparation.of(bridge, modes, stop)?
            }
            Source::Given(given) => asked.preparation.of_given(given, asked.modes)?,
        });
        *held(&self.analysis) = Some((asked, Arc::clone(&analysis)));
        Ok(analysis)
    }

    fn modes(&self, bridge: &Bridge, count: usize) -> Result<Modes, Error> {
        match held(&self.modes).as_ref() {
            Some(modes) if count > 0 && modes.len() >= count => return Ok(modes.truncated(count)),
            _ => {}
        }
        let modes = Modes::new(bridge, &Flexibility::new(bridge, &[])?, count)?;
        *held(&self.modes) = Some(modes.clone());
        Ok(modes)
    }
}

/// What is kept, for a moment.
fn held<T>(kept: &Mutex<T>) -> MutexGuard<'_, T> {
    kept.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Order of the largest matrix that a bridge leads to.
fn order(bridge: &Bridge) -> usize {
    bridge.stations().len().max(bridge.supports().len() + bridge.hinges().len())
}

/// Position and springs of a support; the names pinned, clamped and free are Python's.
#[derive(FromPyObject)]
struct PySupport {
    at: f64,
    vertical: f64,
    rotation: f64,
}

fn supports_of(given: Vec<PySupport>) -> Vec<Support> {
    let support = |PySupport { at, vertical, rotation }| Support { at, fixity: Fixity::Elastic { vertical, rotation } };
    given.into_iter().map(support).collect()
}

/// Something along the beam: one value or one for each span, or values at breakpoints or between them.
#[derive(FromPyObject)]
enum PyAlong {
    PerSpan(Vec<f64>),
    Between { at: Vec<f64>, values: Vec<f64>, pieces: usize },
}

impl From<PyAlong> for Along {
    fn from(given: PyAlong) -> Self {
        match given {
            PyAlong::PerSpan(values) => Along::PerSpan(values),
            PyAlong::Between { at, values, pieces } => Along::Between { at, values, pieces },
        }
    }
}

pub fn mat(a: PyReadonlyArray2<'_, f64>) -> Mat<f64> {
    let a = a.as_array();
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[[i, j]])
}

/// Numbers on the right and, where they differ, on the left.
type PySides<'py> = (PyReadonlyArray2<'py, f64>, Option<PyReadonlyArray2<'py, f64>>);

fn two_sided((right, left): PySides<'_>) -> TwoSided {
    TwoSided { right: mat(right), left: left.map(mat) }
}

/// Values and slopes of the influence lines of a kind of response, and the responses of the modes.
type PyLines<'py> = (String, PySides<'py>, Option<PySides<'py>>, Option<PyReadonlyArray2<'py, f64>>);

fn given_lines((name, values, slopes, modal): PyLines<'_>) -> Result<GivenLines, Error> {
    let quantity = Quantity::USUAL.into_iter().find(|q| q.name() == name).ok_or_else(|| {
        let names = Quantity::USUAL.map(Quantity::name).join(", ");
        Error::input("influence", format!("\"{name}\""), format!("must be one of {names}"))
    })?;
    let (values, slopes) = (two_sided(values), slopes.map(two_sided));
    Ok(GivenLines { quantity, values, slopes, modal: modal.map(mat) })
}

/// Value or derivative of lines at x, from the right or from the left; row by row for x.
fn read(mesh: &Mesh, lines: &[Line], x: &[f64], derivative: bool, left: bool) -> Result<Vec<f64>, Error> {
    let count = x.len() * lines.len();
    let (points, bytes) = (format!("{} points", x.len()), (size_of::<f64>() * count) as f64);
    memory::check("x", points, bytes, f64::INFINITY, &format!("{} lines there", lines.len()), "use fewer")?;
    let near = COINCIDENT * mesh.length();
    let place = |x: f64| {
        let node = mesh.node_at(x);
        match (mesh.nodes()[node] - x).abs() <= near && left && node > 0 {
            true => Some((node - 1, 1.0)),
            false => mesh.panel_at(x).map(|panel| (panel, mesh.fraction(panel, x))),
        }
    };
    let value = |line: &Line, panel: usize, fraction: f64| match derivative {
        true => line.slope(mesh, panel, fraction),
        false => line.value(panel, fraction),
    };
    let at = |x: f64| {
        let place = place(x);
        lines.iter().map(move |line| place.map_or(0.0, |(panel, fraction)| value(line, panel, fraction)))
    };
    let mut values = Vec::with_capacity(count);
    values.extend(x.iter().flat_map(|&x| at(x)));
    Ok(values)
}

fn on_the_beam(key: &str, at: f64, length: f64) -> Result<(), Error> {
    match at >= 0.0 && at <= length {
        true => Ok(()),
        false => Err(Error::input(key, format!("{at} m"), format!("must lie on the beam, 0 to {length} m"))),
    }
}

/// A beam bridge, its mass lumped at stations.
#[pyclass(name = "Bridge", frozen, module = "spanwise._core")]
pub struct PyBridge(pub Arc<Solved>);

#[pymethods]
impl PyBridge {
    #[new]
    #[allow(clippy::too_many_arguments)] // one per argument that Python names
    #[pyo3(signature = (*, spans, length, supports, hinges, flexural_rigidity, mass, stations_per_span, stations,
                        point_masses))]
    fn new(
        py: Python<'_>,
        spans: Option<(Vec<f64>, String, String)>,
        length: f64,
        supports: Vec<PySupport>,
        hinges: Vec<f64>,
        flexural_rigidity: PyAlong,
        mass: PyAlong,
        stations_per_span: Vec<usize>,
        stations: Option<Vec<f64>>,
        point_masses: Vec<(f64, f64)>,
    ) -> PyResult<Self> {
        let (length, supports) = match spans {
            None => (length, supports_of(supports)),
            Some((spans, left, right)) => {
                let ends = [fixity(&left, "ends[0]")?, fixity(&right, "ends[1]")?];
                Bridge::consecutive(&spans, ends)?
            }
        };
        let layout = Layout {
            length,
            supports,
            hinges,
            flexural_rigidity: flexural_rigidity.into(),
            mass: mass.into(),
            stations: stations.map_or(Stations::PerSpan(stations_per_span), Stations::At),
            point_masses,
        };
        let order = layout.supports.len() + layout.hinges.len();
        let bridge = preparing(py, order, move |_| {
            let bridge = Bridge::from_layout(layout)?;
            if !bridge.hinges().is_empty() {
                // A mechanism shows in the flexibility.
                Flexibility::new(&bridge, &[])?;
            }
            Ok(bridge)
        })?;
        Ok(PyBridge(Solved::new(Source::Described(Box::new(bridge)))))
    }

    /// A bridge given by the flexibility of its basic bridge.
    #[staticmethod]
    #[allow(clippy::too_many_arguments)] // one per argument that Python names
    #[pyo3(signature = (*, length, supports, stations, masses, redundants, path, flexibility, slopes))]
    fn from_flexibility(
        py: Python<'_>,
        length: f64,
        supports: Vec<PySupport>,
        stations: Vec<f64>,
        masses: Vec<f64>,
        redundants: Vec<(f64, f64)>,
        path: Vec<f64>,
        flexibility: PyReadonlyArray2<'_, f64>,
        slopes: Option<PyReadonlyArray2<'_, f64>>,
    ) -> PyResult<Self> {
        let (flexibility, slopes) = (mat(flexibility), slopes.map(mat));
        let supports = supports_of(supports);
        let data = ByFlexibility { length, supports, stations, masses, redundants, path, flexibility, slopes };
        let order = data.flexibility.nrows().max(data.flexibility.ncols());
        let given = preparing(py, order, move |_| Given::by_flexibility(&data))?;
        Ok(PyBridge(Solved::new(Source::Given(Box::new(given)))))
    }

    /// A bridge given by its modes.
    #[staticmethod]
    #[allow(clippy::too_many_arguments)] // one per argument that Python names
    #[pyo3(signature = (*, path, frequencies, shapes, slopes, sections, supports, influence, masses))]
    fn from_modes(
        py: Python<'_>,
        path: Vec<f64>,
        frequencies: Vec<f64>,
        shapes: PySides<'_>,
        slopes: Option<PySides<'_>>,
        sections: Vec<f64>,
        supports: Vec<PySupport>,
        influence: Vec<PyLines<'_>>,
        masses: Option<Vec<f64>>,
    ) -> PyResult<Self> {
        let influence = influence.into_iter().map(given_lines).collect::<Result<_, Error>>()?;
        let (shapes, slopes) = (two_sided(shapes), slopes.map(two_sided));
        let supports = supports_of(supports);
        let data = ByModes { path, frequencies, shapes, slopes, sections, supports, influence, masses };
        let order = data.path.len().max(data.sections.len());
        let given = preparing(py, order, move |_| Given::by_modes(&data))?;
        Ok(PyBridge(Solved::new(Source::Given(Box::new(given)))))
    }

    /// Whether it was described, not given.
    #[getter]
    fn described(&self) -> bool {
        matches!(self.0.source, Source::Described(_))
    }

    #[getter]
    fn length(&self) -> f64 {
        match &self.0.source {
            Source::Described(bridge) => bridge.length(),
            Source::Given(given) => given.mesh().length(),
        }
    }

    #[getter]
    fn supports(&self) -> Vec<(f64, f64, f64)> {
        let supports = match &self.0.source {
            Source::Described(bridge) => bridge.supports(),
            Source::Given(given) => given.supports(),
        };
        supports.iter().map(|s| (s.at, s.fixity.vertical(), s.fixity.rotation())).collect()
    }

    #[getter]
    fn hinges<'py>(&self, py: Python<'py>) -> Vector<'py> {
        let hinges = match &self.0.source {
            Source::Described(bridge) => bridge.hinges().to_vec(),
            Source::Given(_) => Vec::new(),
        };
        hinges.into_pyarray(py)
    }

    /// Kinds of response of which nothing is known.
    #[getter]
    fn missing(&self) -> Vec<&'static str> {
        match &self.0.source {
            Source::Described(_) => Vec::new(),
            Source::Given(given) => given.missing().iter().map(|q| q.name()).collect(),
        }
    }

    #[getter]
    fn span_bounds<'py>(&self, py: Python<'py>) -> Vector<'py> {
        let bounds = match &self.0.source {
            Source::Described(bridge) => bridge.span_bounds().to_vec(),
            Source::Given(given) => {
                let length = given.mesh().length();
                let inner = given.supports().iter().map(|s| s.at).filter(|&x| x > 0.0 && x < length);
                std::iter::once(0.0).chain(inner).chain([length]).collect()
            }
        };
        bounds.into_pyarray(py)
    }

    #[getter]
    fn flexural_rigidity<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        Ok(self.0.described("EI")?.flexural_rigidity().into_pyarray(py))
    }

    #[getter]
    fn rigidity_bounds<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        Ok(self.0.described("EI_bounds")?.rigidity_bounds().to_vec().into_pyarray(py))
    }

    /// Positions and values of the moving masses.
    #[getter]
    fn masses<'py>(&self, py: Python<'py>) -> (Vector<'py>, Vector<'py>) {
        let (x, m): (Vec<f64>, Vec<f64>) = match &self.0.source {
            Source::Described(bridge) => bridge.stations().iter().map(|s| (s.at, s.mass)).unzip(),
            Source::Given(given) => given.masses().unzip(),
        };
        (x.into_pyarray(py), m.into_pyarray(py))
    }

    /// Number of modes that can be asked for.
    #[getter]
    fn mode_count(&self) -> usize {
        match &self.0.source {
            Source::Described(bridge) => bridge.stations().len(),
            Source::Given(given) => given.mode_count(),
        }
    }

    /// Every position at which a line along the bridge changes its cubic.
    #[getter]
    fn nodes<'py>(&self, py: Python<'py>) -> Vector<'py> {
        let nodes = match &self.0.source {
            Source::Described(bridge) => Mesh::new(bridge.length(), bridge.points()).nodes().to_vec(),
            Source::Given(given) => given.mesh().nodes().to_vec(),
        };
        nodes.into_pyarray(py)
    }

    fn default_sections<'py>(&self, py: Python<'py>) -> Vector<'py> {
        let sections = match &self.0.source {
            Source::Described(bridge) => bridge.default_sections(),
            Source::Given(given) => given.sections(),
        };
        sections.into_pyarray(py)
    }

    /// Circular frequencies, shapes at the stations, and shapes or their slopes at x.
    #[pyo3(signature = (count, x, derivative, left))]
    fn modes<'py>(
        &self,
        py: Python<'py>,
        count: usize,
        x: Option<PyReadonlyArray1<'py, f64>>,
        derivative: bool,
        left: bool,
    ) -> PyResult<(Vector<'py>, Matrix<'py>, Option<Matrix<'py>>)> {
        let x = x.map(|x| x.as_array().to_vec());
        let solved = Arc::clone(&self.0);
        let (modes, along) = preparing(py, self.0.order(), move |_| match &solved.source {
            Source::Described(bridge) => {
                let modes = solved.modes(bridge, count)?;
                let along = x.map(|x| {
                    let flexibility = Flexibility::new(bridge, &[])?;
                    let lines = modes.lines(bridge, &flexibility);
                    read(flexibility.mesh(), &lines, &x, derivative, left)
                });
                Ok((modes, along.transpose()?))
            }
            Source::Given(given) => {
                let (modes, lines) = given.modes(count)?;
                let along = x.map(|x| read(given.mesh(), &lines, &x, derivative, left));
                Ok((modes, along.transpose()?))
            }
        })?;
        let along = along.map(|values| rows(py, values, modes.len())).transpose()?;
        let shapes = matrix(py, &modes.shapes);
        Ok((modes.omega.into_pyarray(py), shapes, along))
    }

    /// Positions of the reference stations and the flexibility matrix there: F* or F.
    fn flexibility<'py>(&self, py: Python<'py>, name: &str) -> PyResult<(Vector<'py>, Matrix<'py>)> {
        let structure = structure(name)?;
        let solved = Arc::clone(&self.0);
        let (x, f) = preparing(py, self.0.order(), move |_| {
            let bridge = solved.described("flexibility")?;
            let flexibility = Flexibility::new(bridge, &[])?;
            let mut nodes = flexibility.reference_nodes(bridge);
            if structure == Structure::Actual {
                let stations = bridge.stations().iter();
                nodes = stations.map(|s| flexibility.mesh().node_at(s.at)).collect();
            }
            let x: Vec<f64> = nodes.iter().map(|&node| flexibility.mesh().nodes()[node]).collect();
            Ok((x, flexibility.matrix(&nodes, &nodes, structure)))
        })?;
        Ok((x.into_pyarray(py), matrix(py, &f)))
    }

    /// Deflections or slopes at x for unit loads: a row for each x, a column for each load.
    #[pyo3(signature = (x, loads, name, derivative, left))]
    fn deflections<'py>(
        &self,
        py: Python<'py>,
        x: PyReadonlyArray1<'py, f64>,
        loads: Vec<f64>,
        name: &str,
        derivative: bool,
        left: bool,
    ) -> PyResult<Matrix<'py>> {
        let structure = structure(name)?;
        let x = x.as_array().to_vec();
        let (solved, count) = (Arc::clone(&self.0), loads.len());
        let values = preparing(py, self.0.order().max(count), move |_| {
            let bridge = solved.described("deflections")?;
            for (i, &at) in loads.iter().enumerate() {
                on_the_beam(&format!("loads[{i}]"), at, bridge.length())?;
            }
            let panels = bridge.points().count() + loads.len();
            check_lines("loads", loads.len(), loads.len() as f64, panels, "deflected shapes of so many")?;
            let flexibility = Flexibility::new(bridge, &loads)?;
            let mesh = flexibility.mesh();
            let forces: Vec<Actions> = loads.iter().map(|&at| vec![(1.0, Action::Force(mesh.node_at(at)))]).collect();
            read(mesh, &flexibility.each_deflected(&forces, structure), &x, derivative, left)
        })?;
        rows(py, values, count)
    }

    /// K^R, the stiffness of the redundant supports.
    fn redundant_stiffness<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        let solved = Arc::clone(&self.0);
        let stiffness = preparing(py, self.0.order(), move |_| {
            Ok(Flexibility::new(solved.described("redundant_stiffness")?, &[])?.redundant_stiffness())
        })?;
        Ok(matrix(py, &stiffness))
    }

    /// Restraints of the basic bridge: position, kind, and its reaction per unit load at each reference station.
    fn outer_reactions<'py>(&self, py: Python<'py>) -> PyResult<Vec<(f64, &'static str, Vector<'py>)>> {
        let solved = Arc::clone(&self.0);
        let all = preparing(py, self.0.order(), move |_| {
            let bridge = solved.described("outer_reactions")?;
            let flexibility = Flexibility::new(bridge, &[])?;
            let nodes = flexibility.reference_nodes(bridge);
            let each = flexibility.outer_restraints().into_iter().map(|restraint| {
                let line = influence::reaction(&flexibility, restraint, Structure::Basic);
                let values: Vec<f64> = nodes.iter().map(|&node| line.at_node(node)).collect();
                let kind = match restraint {
                    Restraint::Deflection(_) => "force",
                    Restraint::Slope(_) => "moment",
                };
                (flexibility.mesh().nodes()[restraint.node()], kind, values)
            });
            Ok(each.collect::<Vec<_>>())
        })?;
        Ok(all.into_iter().map(|(at, kind, values)| (at, kind, values.into_pyarray(py))).collect())
    }

    /// State after the supports have settled: deflection, moment, shear left and right, reactions, clamp moments.
    fn settlement<'py>(
        &self,
        py: Python<'py>,
        settlements: Vec<f64>,
        sections: Vec<f64>,
    ) -> PyResult<[Vector<'py>; 6]> {
        let solved = Arc::clone(&self.0);
        let order = self.0.order().max(sections.len());
        let settled = preparing(py, order, move |_| {
            let bridge = solved.described("settlement")?;
            for (i, &at) in sections.iter().enumerate() {
                on_the_beam(&format!("sections[{i}]"), at, bridge.length())?;
            }
            Settled::new(bridge, &settlements, &sections)
        })?;
        let side = |side: usize| settled.shear.iter().map(|shear| shear[side]).collect::<Vec<f64>>();
        let (left, right) = (side(0), side(1));
        Ok([settled.deflection, settled.moment, left, right, settled.reactions, settled.clamp_moments]
            .map(|values| values.into_pyarray(py)))
    }

    /// Influence line of a response at `at`, or its derivative, for unit loads at x.
    #[allow(clippy::too_many_arguments)] // one per argument that Python names
    #[pyo3(signature = (quantity, at, x, name, derivative, left))]
    fn influence_line<'py>(
        &self,
        py: Python<'py>,
        quantity: &str,
        at: f64,
        x: PyReadonlyArray1<'py, f64>,
        name: &str,
        derivative: bool,
        left: bool,
    ) -> PyResult<Vector<'py>> {
        let structure = structure(name)?;
        let x = x.as_array().to_vec();
        on_the_beam("at", at, self.length())?;
        let (solved, quantity) = (Arc::clone(&self.0), quantity.to_string());
        let values = preparing(py, self.0.order(), move |_| match &solved.source {
            Source::Described(bridge) => {
                let flexibility = Flexibility::new(bridge, &[at])?;
                let line = described_line(&flexibility, &quantity, at, structure)?;
                read(flexibility.mesh(), &[line], &x, derivative, left)
            }
            Source::Given(given) => {
                if structure == Structure::Basic {
                    solved.described("influence_line of the basic bridge")?;
                }
                let line = given.line(&quantity, at)?;
                read(given.mesh(), std::slice::from_ref(line), &x, derivative, left)
            }
        })?;
        Ok(values.into_pyarray(py))
    }
}

/// The influence line of a response of a bridge that was described.
fn described_line(flexibility: &Flexibility, quantity: &str, at: f64, structure: Structure) -> Result<Line, Error> {
    let node = flexibility.mesh().node_at(at);
    let reaction = |restraint: Restraint, what: &str| match flexibility.holds(restraint, structure) {
        true => Ok(influence::reaction(flexibility, restraint, structure)),
        false => Err(Error::input("at", format!("{at} m"), format!("must be the position of {what}"))),
    };
    match quantity {
        "deflection" => Ok(influence::deflection(flexibility, node, structure)),
        "slope" => Ok(influence::slope(flexibility, node, structure)),
        "moment" => Ok(influence::moment(flexibility, node, structure)),
        "shear-left" => Ok(influence::shear(flexibility, node, structure)[0].clone()),
        "shear-right" => Ok(influence::shear(flexibility, node, structure)[1].clone()),
        "reaction" => reaction(Restraint::Deflection(node), "a support of this structure"),
        "clamp-moment" => reaction(Restraint::Slope(node), "a support of this structure that holds the rotation"),
        _ => {
            let allowed = "must be deflection, slope, moment, shear-left, shear-right, reaction or clamp-moment";
            Err(Error::input("quantity", format!("\"{quantity}\""), allowed))
        }
    }
}
