//! Many crossings for Python; the big arrays go to NumPy as they are.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use super::bridge::{Asked, PyBridge};
use super::crossing::{PyDrive, PyPassage, damped, drive as driven, passage, quantity, recovery_named};
use super::road::PyRoad;
use super::vehicle::{PyBody, PyVehicle, parts_of};
use super::{Matrix, Vector, attended, rows};
use crate::course::Passage;
use crate::ensemble::record::{Column, Layout};
use crate::ensemble::sample::{Factors, Parameter, Samples};
use crate::ensemble::{Progress, Run, Study, Workers, alone};
use crate::error::Error;
use crate::road::patch::Patch;
use crate::road::random::Synthesis;
use crate::road::spectrum::Spectrum;
use crate::settings::Settings;

/// Random roads of the samples' own: roughness, waviness, band, contact patch, period, seed.
type PyOwn = (f64, f64, [f64; 2], f64, f64, u64);

/// Name of the parameter, factors of each sample, and all of them, sample after sample.
type PyFactors<'py> = (String, usize, PyReadonlyArray1<'py, f64>);

/// What a run of samples leaves.
#[pyclass(frozen, module = "spanwise._core")]
pub struct Ensemble {
    study: Study,
    samples: Samples,
    workers: Workers,
    /// Without the numbers, instants and digests, which are Python's.
    run: Run,
    layout: Layout,
    hash: u64,
    elapsed: f64,
    numbers: Py<PyArray2<f64>>,
    instants: Py<PyArray2<u32>>,
    digests: Py<PyArray1<u64>>,
}

#[pymethods]
impl Ensemble {
    /// One row for each sample.
    #[getter]
    fn numbers(&self, py: Python<'_>) -> Py<PyArray2<f64>> {
        self.numbers.clone_ref(py)
    }

    /// One row for each sample: instants of the extremes of responses and axle loads, and how often axles left the road.
    #[getter]
    fn instants(&self, py: Python<'_>) -> Py<PyArray2<u32>> {
        self.instants.clone_ref(py)
    }

    /// Fingerprint of each sample.
    #[getter]
    fn digests(&self, py: Python<'_>) -> Py<PyArray1<u64>> {
        self.digests.clone_ref(py)
    }

    #[getter]
    fn hash(&self) -> u64 {
        self.hash
    }

    #[getter]
    fn isa(&self) -> &'static str {
        self.workers.isa.name()
    }

    #[getter]
    fn threads(&self) -> usize {
        self.workers.threads
    }

    /// Time that it took [s].
    #[getter]
    fn elapsed(&self) -> f64 {
        self.elapsed
    }

    /// Whether the samples share the geometry.
    #[getter]
    fn shares(&self) -> bool {
        self.study.shares
    }

    /// Whether times and positions of extremes are among the numbers.
    #[getter]
    fn own_times(&self) -> bool {
        self.layout.own_times
    }

    #[getter]
    fn sections<'py>(&self, py: Python<'py>) -> Vector<'py> {
        self.study.analysis.sections.clone().into_pyarray(py)
    }

    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> Vector<'py> {
        self.study.analysis.modes.omega.clone().into_pyarray(py)
    }

    /// How many responses a quantity has.
    fn width(&self, name: &str) -> PyResult<usize> {
        Ok(self.study.analysis.responses.range(quantity(name)?).len())
    }

    /// Where a kind of number is in the rows.
    fn columns(&self, name: &str) -> PyResult<(usize, usize)> {
        let column = match name {
            "responses" => Column::Responses,
            "axle_loads" => Column::Loads,
            "load_coefficients" => Column::LoadCoefficients,
            "time_off_road" => Column::Aloft,
            "accelerations" => Column::Accelerations,
            "vibrations" => Column::Vibrations,
            "statics" => Column::Statics,
            "times" => Column::Times,
            "positions" => Column::Positions,
            _ => return Err(Error::input("columns", format!("\"{name}\""), "no such columns").into()),
        };
        let range = self.layout.range(column);
        Ok((range.start, range.end))
    }

    /// Static extremes, largest and then smallest of all responses, in a row for each kind of march; none if samples have
    /// their own.
    #[getter]
    fn at_rest<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        let width = 2 * self.layout.responses;
        rows(py, self.run.at_rest.concat(), width)
    }

    /// The kind of march of each sample.
    #[getter]
    fn marches<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        self.run.results.marches.clone().into_pyarray(py)
    }

    /// Sample, step and cause of every failure.
    #[getter]
    fn failures(&self) -> Vec<(usize, Option<usize>, String)> {
        let all = self.run.results.failures.iter();
        all.map(|failure| (failure.sample, failure.step, failure.cause.to_string())).collect()
    }

    /// Times and positions of the front axle at instants of the samples, one row for each.
    fn when<'py>(&self, py: Python<'py>, instants: PyReadonlyArray2<'py, u32>) -> PyResult<[Matrix<'py>; 2]> {
        let instants = instants.as_array();
        if instants.nrows() != self.samples.count || !self.study.shares {
            return Err(Error::input("instants", instants.nrows(), "must be those of all samples").into());
        }
        let [times, positions] = py.detach(|| {
            let mut times = Array2::zeros(instants.dim());
            let mut positions = Array2::zeros(instants.dim());
            for ((at, &instant), (time, position)) in
                instants.indexed_iter().zip(times.iter_mut().zip(positions.iter_mut()))
            {
                (*time, *position) = self.run.when(&self.study, &self.samples, at.0, instant);
            }
            [times, positions]
        });
        Ok([times.into_pyarray(py), positions.into_pyarray(py)])
    }

    /// The time step of a sample of shared geometry [s], and how often it was halved.
    fn step(&self, sample: usize) -> Option<(f64, u32)> {
        let march = *self.run.results.marches.get(sample)? as usize;
        let table = self.run.tables.get(march)?;
        Some((table.path.advance / self.samples.speed(sample, 0), self.run.refinements[march]))
    }

    /// A vehicle as a sample has it, and its bodies.
    fn vehicle(&self, sample: usize, number: usize) -> PyResult<(PyVehicle, Vec<PyBody>)> {
        let mut all = alone::passages(&self.study, &self.samples, sample)?;
        let vehicle = all.swap_remove(number).vehicle;
        let bodies = vehicle.bodies().iter().map(parts_of).collect();
        Ok((PyVehicle(vehicle), bodies))
    }

    /// Static axle loads [N]: one row if all samples have the same, else one for each.
    fn static_loads<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        let varies = self.samples.varies_loads();
        let gravity = self.study.settings.gravity;
        let loads = |passages: &[Passage]| -> Vec<f64> {
            let mut all: Vec<f64> = passages.iter().flat_map(|p| p.vehicle.static_loads(gravity)).collect();
            all.resize(self.layout.axles, f64::NAN);
            all
        };
        let kinds: Vec<Vec<f64>> = self.study.kinds.iter().map(|kind| loads(&kind.passages)).collect();
        if !varies && kinds.len() == 1 {
            return rows(py, kinds.concat(), self.layout.axles);
        }
        let all: Vec<f64> = py.detach(|| {
            let of = |sample: usize| match varies {
                // A sample whose vehicle cannot be has no results either.
                true => alone::passages(&self.study, &self.samples, sample)
                    .map_or_else(|_| vec![f64::NAN; self.layout.axles], |passages| loads(&passages)),
                false => kinds[self.samples.kind(sample)].clone(),
            };
            (0..self.samples.count).flat_map(of).collect()
        });
        rows(py, all, self.layout.axles)
    }
}

/// Computes many crossings.
#[pyfunction]
#[pyo3(signature = (bridge, kinds, *, drive, road, own_road, modes, damping, damping_matrix, beta, step, advance, approach,
                    ramp, tail, gravity, lift_off, sections, recovery, quantities, first, count, kind_of, speeds, factors,
                    threads, progress))]
#[allow(clippy::too_many_arguments)] // one per argument that Python names
pub fn ensemble<'py>(
    py: Python<'py>,
    bridge: &PyBridge,
    kinds: Vec<Vec<PyPassage<'py>>>,
    drive: PyDrive,
    road: &PyRoad,
    own_road: Option<PyOwn>,
    modes: usize,
    damping: Vec<f64>,
    damping_matrix: Option<PyReadonlyArray2<'py, f64>>,
    beta: f64,
    step: Option<f64>,
    advance: Option<f64>,
    approach: f64,
    ramp: f64,
    tail: f64,
    gravity: f64,
    lift_off: bool,
    sections: Option<Vec<f64>>,
    recovery: &str,
    quantities: Vec<String>,
    first: u64,
    count: usize,
    kind_of: PyReadonlyArray1<'py, u32>,
    speeds: PyReadonlyArray1<'py, f64>,
    factors: Vec<PyFactors<'py>>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Ensemble> {
    let workers = Workers::new(threads)?;
    let asked =
        Asked { modes, damping: damped(damping, damping_matrix), sections, recovery: recovery_named(recovery)? };
    let all = kinds.into_iter().map(|passages| passages.into_iter().map(passage).collect());
    let kinds = all.collect::<Result<Vec<Vec<Passage>>, Error>>()?;
    let quantities = quantities.iter().map(|name| quantity(name)).collect::<Result<Vec<_>, Error>>()?;
    let factors = factors.into_iter().map(|(name, width, values)| {
        Ok(Factors { parameter: Parameter::named(&name)?, width, values: values.as_array().to_vec() })
    });
    let samples = Samples {
        first,
        count,
        kinds: kind_of.as_array().to_vec(),
        speeds: speeds.as_array().to_vec(),
        factors: factors.collect::<Result<Vec<_>, Error>>()?,
    };
    let settings = Settings {
        drive: driven(drive)?,
        beta,
        step,
        approach,
        ramp,
        tail,
        gravity,
        lift_off,
        road: Arc::new(road.0.clone()),
        // Every sample says its own.
        ..Settings::at_speed(f64::NAN)
    };
    let started = Instant::now();
    let told = Progress::default();
    let (study, mut run) = attended(py, &told, count, progress.as_ref(), || {
        let go_on = || !told.stop.load(Ordering::Relaxed);
        let own = own_road.map(|(roughness, waviness, band, patch, period, seed)| {
            let spectrum = Spectrum::new(roughness, waviness, band)?;
            Ok::<_, Error>((Arc::new(Synthesis::new(spectrum, Patch::new(patch)?, Some(period))?), seed))
        });
        let analysis = bridge.0.analysis(asked, &mut || go_on())?;
        let study = Study::new(analysis, kinds, settings, own.transpose()?, advance, &quantities)?;
        let run = study.run(&samples, &workers, &told)?;
        Ok((study, run))
    })?;
    let elapsed = started.elapsed().as_secs_f64();
    let (hash, layout) = (run.results.hash(), run.results.layout);
    let numbers = std::mem::take(&mut run.results.numbers).into_pyarray(py).reshape([count, layout.width()])?;
    let instants = std::mem::take(&mut run.results.instants).into_pyarray(py).reshape([count, layout.instants()])?;
    let digests = std::mem::take(&mut run.results.digests).into_pyarray(py);
    Ok(Ensemble {
        study,
        samples,
        workers,
        run,
        layout,
        hash,
        elapsed,
        numbers: numbers.unbind(),
        instants: instants.unbind(),
        digests: digests.unbind(),
    })
}
