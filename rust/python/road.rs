//! Roads for Python.

use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::prelude::*;

use super::{Vector, aside, interruptible};
use crate::error::Error;
use crate::memory;
use crate::road::feature::Feature;
use crate::road::patch::Patch;
use crate::road::profile::Profile;
use crate::road::random::Synthesis;
use crate::road::spectrum::{Class, Spectrum};
use crate::road::{self, golden_car};
use crate::stop_token::StopToken;

/// A road surface.
#[pyclass(name = "Road", frozen, module = "spanwise._core")]
pub struct PyRoad(pub road::Road);

/// Points of a road up to which it is made in a moment.
const FEW: usize = 100_000;

fn single(feature: impl FnOnce(Patch) -> Result<Feature, Error>, contact_patch: f64) -> PyResult<PyRoad> {
    Ok(PyRoad(feature(Patch::new(contact_patch)?)?.into()))
}

#[pymethods]
impl PyRoad {
    #[staticmethod]
    fn sum(parts: Vec<Bound<'_, PyRoad>>) -> Self {
        PyRoad(road::Road::sum(parts.iter().map(|part| part.get().0.clone())))
    }

    #[staticmethod]
    #[allow(clippy::too_many_arguments)] // one per argument that Python names
    #[pyo3(signature = (*, roughness, waviness, band, contact_patch, period, seed, sample))]
    fn random(
        py: Python<'_>,
        roughness: f64,
        waviness: f64,
        band: [f64; 2],
        contact_patch: f64,
        period: Option<f64>,
        seed: u64,
        sample: u64,
    ) -> PyResult<Self> {
        let spectrum = Spectrum::new(roughness, waviness, band)?;
        let patch = Patch::new(contact_patch)?;
        let random = interruptible(py, |stop| {
            let synthesis = Synthesis::new(spectrum, patch, period)?;
            stop.check()?;
            Ok(synthesis.road(seed, sample))
        })?;
        Ok(PyRoad(random.into()))
    }

    #[staticmethod]
    #[pyo3(signature = (*, x, elevation, detrend, contact_patch, max_gap))]
    fn profile(
        py: Python<'_>,
        x: PyReadonlyArray1<'_, f64>,
        elevation: PyReadonlyArray1<'_, f64>,
        detrend: bool,
        contact_patch: f64,
        max_gap: Option<f64>,
    ) -> PyResult<Self> {
        let (x, elevation) = (x.as_array().to_vec(), elevation.as_array().to_vec());
        let (patch, points) = (Patch::new(contact_patch)?, x.len());
        let profile = aside(py, points > FEW, move |_| Profile::new(x, elevation, detrend, patch, max_gap))?;
        Ok(PyRoad(profile.into()))
    }

    #[staticmethod]
    fn step(at: f64, height: f64, contact_patch: f64) -> PyResult<Self> {
        single(|patch| Feature::step(at, height, patch), contact_patch)
    }

    #[staticmethod]
    fn ramp(start: f64, end: f64, height: f64, contact_patch: f64) -> PyResult<Self> {
        single(|patch| Feature::ramp(start, end, height, patch), contact_patch)
    }

    #[staticmethod]
    fn plateau(at: f64, length: f64, height: f64, edge: f64, contact_patch: f64) -> PyResult<Self> {
        single(|patch| Feature::plateau(at, length, height, edge, patch), contact_patch)
    }

    #[staticmethod]
    fn camber(start: f64, end: f64, rise: f64, contact_patch: f64) -> PyResult<Self> {
        single(|patch| Feature::camber(start, end, rise, patch), contact_patch)
    }

    #[getter]
    fn is_smooth(&self) -> bool {
        self.0.is_smooth()
    }

    #[getter]
    fn ends(&self) -> (f64, f64) {
        self.0.ends().into()
    }

    #[getter]
    fn period(&self) -> f64 {
        self.0.period()
    }

    /// See [`Road::drift`].
    fn drift(&self, start: f64, far: f64) -> [f64; 2] {
        self.0.drift(start, far)
    }

    fn check_holds(&self, start: f64, end: f64) -> PyResult<()> {
        Ok(self.0.check_holds(start, end)?)
    }

    /// Elevation, slope and curvature.
    fn at<'py>(
        &self,
        py: Python<'py>,
        x: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<(Vector<'py>, Vector<'py>, Vector<'py>)> {
        let x = x.as_array().to_vec();
        let (count, bytes) = (x.len(), ((size_of::<road::point::Point>() + 3 * size_of::<f64>()) * x.len()) as f64);
        memory::check("x", format!("{count} points"), bytes, f64::INFINITY, "the surface there", "use fewer")?;
        let points = interruptible(py, |stop| {
            let point = |&x: &f64| stop.check().map(|()| self.0.at(x));
            x.iter().map(point).collect::<Result<Vec<road::point::Point>, Error>>()
        })?;
        let column = |of: fn(&road::point::Point) -> f64| points.iter().map(of).collect::<Vec<_>>().into_pyarray(py);
        Ok((column(|p| p.elevation), column(|p| p.slope), column(|p| p.curvature)))
    }

    /// The same averaged over another length than its contact patches.
    fn averaged(&self, py: Python<'_>, length: f64) -> PyResult<Self> {
        let road = self.0.clone();
        Ok(PyRoad(aside(py, road.points() > FEW, move |stop| road.averaged(length, stop))?))
    }

    /// Wave numbers up to which all parts are known, and those of the finest.
    fn waves(&self, start: f64, end: f64) -> (f64, f64) {
        self.0.waves(start, end).into()
    }

    fn iri(&self, py: Python<'_>, start: f64, end: f64) -> PyResult<f64> {
        let road = self.0.clone();
        aside(py, road.points() > FEW, move |stop| golden_car::iri(&road, start, end, stop))
    }

    /// The index by segments: their ends, the values, and the road before the first.
    fn iri_segments<'py>(
        &self,
        py: Python<'py>,
        start: f64,
        end: f64,
        every: f64,
    ) -> PyResult<(Vector<'py>, Vector<'py>, f64)> {
        let road = self.0.clone();
        let drive = move |stop: StopToken<'_>| golden_car::segments(&road, start, end, every, stop);
        let found = aside(py, self.0.points() > FEW, drive)?;
        Ok((found.edges.into_pyarray(py), found.values.into_pyarray(py), found.lead_in))
    }
}

/// Classes of ISO 8608: letter, geometric mean and upper limit.
#[pyfunction]
pub fn road_classes() -> Vec<(String, f64, Option<f64>)> {
    Class::ALL.into_iter().map(|class| (format!("{class:?}"), class.mean(), class.upper())).collect()
}
