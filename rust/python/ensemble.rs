//! Many crossings for Python; the big arrays go to NumPy as they are.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use super::bridge::PyBridge;
use super::crossing::{conditions_of, passages_of, quantity};
use super::given::Given;
use super::road::PyRoad;
use super::vehicle::PyVehicle;
use super::{Matrix, Vector, attended, interruptible, packed, preparing, rows};
use crate::crossing::analysis::Analysis;
use crate::ensemble::checks::Numbers;
use crate::ensemble::results::{Column, Failure, Format, fingerprint as fingerprint_of};
use crate::ensemble::sample::{Factors, Parameter, Samples};
use crate::ensemble::varied::vehicles as varied_vehicles;
use crate::ensemble::{Plan, Run, Workers, clock};
use crate::error::Error;
use crate::memory;
use crate::passage::Passage;
use crate::road::patch::Patch;
use crate::road::random::Synthesis;
use crate::road::spectrum::Spectrum;
use crate::statics::quantity::Quantity;
use crate::stop_token::StopToken;
use crate::vehicle::Vehicle;

/// What a run of samples leaves.
#[pyclass(frozen, module = "spanwise._core")]
pub struct Ensemble {
    analysis: Arc<Analysis>,
    shares: bool,
    quantities: Vec<Quantity>,
    workers: Workers,
    format: Format,
    hash: u64,
    elapsed: f64,
    failures: Vec<Failure>,
    numbers: Py<PyArray2<f64>>,
    instants: Py<PyArray2<u32>>,
    digests: Py<PyArray1<u64>>,
    marches: Py<PyArray1<u32>>,
    at_rest: Py<PyArray2<f64>>,
    clock: Py<Clock>,
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
        self.shares
    }

    #[getter]
    fn sections<'py>(&self, py: Python<'py>) -> Vector<'py> {
        self.analysis.sections.clone().into_pyarray(py)
    }

    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> Vector<'py> {
        self.analysis.modes.omega.clone().into_pyarray(py)
    }

    /// How many responses each kind has that is looked at, in their order.
    #[getter]
    fn widths(&self) -> Vec<(String, usize)> {
        let looked_at = Quantity::ALL.into_iter().filter(|quantity| self.quantities.contains(quantity));
        let width = |quantity: Quantity| self.analysis.responses.range(quantity).len();
        looked_at.map(|quantity| (quantity.of_results().to_string(), width(quantity))).collect()
    }

    /// Where each kind of number is in the rows.
    #[getter]
    fn columns(&self) -> BTreeMap<&'static str, (usize, usize)> {
        let all = [
            ("responses", Column::Responses),
            ("axle_loads", Column::Loads),
            ("load_coefficients", Column::LoadCoefficients),
            ("time_off_road", Column::Aloft),
            ("accelerations", Column::Accelerations),
            ("vibrations", Column::Vibrations),
            ("statics", Column::Statics),
            ("times", Column::Times),
            ("positions", Column::Positions),
        ];
        let place = |(name, column): (&'static str, Column)| {
            let range = self.format.range(column);
            (name, (range.start, range.end))
        };
        let tail = self.format.range(Column::Tail).start;
        let single = ["tail", "growth", "growing"].into_iter().zip(tail..).map(|(name, at)| (name, (at, at + 1)));
        all.into_iter().map(place).chain(single).collect()
    }

    /// Static extremes, largest and then smallest of all responses, in a row for each kind of march; none if samples have
    /// their own.
    #[getter]
    fn at_rest(&self, py: Python<'_>) -> Py<PyArray2<f64>> {
        self.at_rest.clone_ref(py)
    }

    /// The kind of march of each sample.
    #[getter]
    fn marches(&self, py: Python<'_>) -> Py<PyArray1<u32>> {
        self.marches.clone_ref(py)
    }

    /// Sample, step and cause of every failure.
    #[getter]
    fn failures(&self) -> Vec<(usize, Option<usize>, String)> {
        let all = self.failures.iter();
        all.map(|failure| (failure.sample, failure.step, failure.cause.to_string())).collect()
    }

    /// What the instants mean.
    #[getter]
    fn clock(&self, py: Python<'_>) -> Py<Clock> {
        self.clock.clone_ref(py)
    }
}

/// When the instants of samples are: it travels as bytes.
#[pyclass(frozen, module = "spanwise._core")]
pub struct Clock(clock::Clock);

#[pymethods]
impl Clock {
    #[new]
    fn new(state: &[u8]) -> PyResult<Self> {
        let refused = |cause: String| Error::input("clock", format!("{} bytes", state.len()), cause);
        let read: clock::Clock = postcard::from_bytes(state).map_err(|e| refused(e.to_string()))?;
        if read.is_sound() { Ok(Clock(read)) } else { Err(refused("has steps that cannot be".into()).into()) }
    }

    /// What makes the same again.
    #[getter]
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        packed(py, &self.0)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        Ok((slf.get_type().into_any(), (slf.get().state(slf.py())?,)))
    }

    /// Times and positions of the front axle at instants of the samples, one row for each, of its march and its speed.
    fn when<'py>(
        &self,
        py: Python<'py>,
        instants: PyReadonlyArray2<'py, u32>,
        marches: PyReadonlyArray1<'py, u32>,
        speeds: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<[Matrix<'py>; 2]> {
        let (instants, marches, speeds) = (instants.as_array(), marches.as_array(), speeds.as_array());
        let count = instants.nrows();
        if marches.len() != count || ![1, count].contains(&speeds.len()) {
            return Err(Error::input("instants", count, "must be those of all samples").into());
        }
        let bytes = 2.0 * (size_of::<f64>() * instants.len()) as f64;
        memory::check("samples", count, bytes, f64::INFINITY, "times and positions", "use fewer")?;
        let [times, positions] = interruptible(py, |stop| {
            let mut times = Array2::zeros(instants.dim());
            let mut positions = Array2::zeros(instants.dim());
            let mut hands = self.0.of(0);
            for (row, instants) in instants.rows().into_iter().enumerate() {
                stop.check()?;
                let speed = speeds[if speeds.len() == 1 { 0 } else { row }];
                if hands.march != marches[row] {
                    hands = self.0.of(marches[row]);
                }
                for (column, &instant) in instants.iter().enumerate() {
                    (times[[row, column]], positions[[row, column]]) = hands.when(speed, instant);
                }
            }
            Ok([times, positions])
        })?;
        Ok([times.into_pyarray(py), positions.into_pyarray(py)])
    }

    /// The time step of a march at a speed [s], and how often it was halved; none where samples have their own.
    fn step(&self, march: u32, speed: f64) -> Option<(f64, u32)> {
        self.0.step(march, speed)
    }

    /// Several as one, and which march of it each of theirs is.
    #[staticmethod]
    fn joined(clocks: Vec<PyRef<'_, Clock>>) -> (Clock, Vec<Vec<u32>>) {
        let clocks: Vec<clock::Clock> = clocks.iter().map(|clock| clock.0.clone()).collect();
        let (joined, marches) = clock::Clock::joined(&clocks);
        (Clock(joined), marches)
    }
}

/// Coordinates of the vehicles of an event.
fn coordinates(event: &[Passage]) -> usize {
    event.iter().map(|passage| passage.vehicle.assembly().coordinates.len()).sum()
}

/// Refuses samples that cannot be: speeds [m/s], factors, and values in place of factors, by these kinds of event.
#[pyfunction]
#[pyo3(signature = (events, *, samples, speeds, factors, values))]
pub fn check_samples(
    events: &Bound<'_, PyAny>,
    samples: usize,
    speeds: PyReadonlyArray1<'_, f64>,
    factors: &Bound<'_, PyAny>,
    values: &Bound<'_, PyAny>,
) -> PyResult<()> {
    let kinds = events_of(events)?;
    let vehicles: Vec<Vec<&Vehicle>> =
        kinds.iter().map(|event| event.iter().map(|passage| &passage.vehicle).collect()).collect();
    let (speeds, factors) = (speeds.as_array().to_vec(), factors_of(factors)?);
    Samples { first: 0, count: samples, kinds: Vec::new(), speeds, factors }.check(&vehicles)?;
    let refused = |values: &Factors| values.check(Numbers::Values, samples, &vehicles);
    Ok(factors_of(values)?.iter().try_for_each(refused)?)
}

/// The vehicles of an event with the factors of one sample, which have been checked.
#[pyfunction]
pub fn varied<'py>(
    py: Python<'py>,
    event: &Bound<'py, PyAny>,
    factors: &Bound<'py, PyAny>,
) -> PyResult<Vec<PyVehicle>> {
    let samples = Samples { factors: factors_of(factors)?, ..Samples::at_speed(0, 1, 1.0) };
    let event = passages_of(event)?;
    let vehicles = preparing(py, coordinates(&event), move |_| varied_vehicles(&event, &samples, 0))?;
    Ok(vehicles.into_iter().map(PyVehicle).collect())
}

/// Static axle loads of all samples of a plan [N], a row for each, or one where they are all alike; NaN where the vehicle
/// of a sample cannot be.
#[pyfunction]
pub fn static_loads<'py>(py: Python<'py>, plan: &Bound<'py, PyAny>, gravity: f64) -> PyResult<Matrix<'py>> {
    let given = Given::new(plan);
    let (kinds, all) = (events_of(&given.get("events")?)?, samples_of(&given)?);
    let samples = match kinds.len() > 1 || all.varies_loads() {
        true => Samples { speeds: vec![1.0], ..all },
        false => Samples::at_speed(all.first, 1, 1.0),
    };
    let count = samples.count;
    let vehicles = |event: &Vec<Passage>| event.iter().map(|passage| passage.vehicle.clone()).collect::<Vec<_>>();
    let as_given: Vec<Vec<Vehicle>> = kinds.iter().map(vehicles).collect();
    let contacts = |vehicle: &Vehicle| vehicle.assembly().contacts.len();
    let axles = as_given.iter().map(|event| event.iter().map(contacts).sum::<usize>()).max().unwrap_or(0);
    let bytes = (size_of::<f64>() * count) as f64 * axles as f64;
    memory::check("samples", count, bytes, f64::INFINITY, "static axle loads", "use fewer")?;
    let order = kinds.iter().map(|event| coordinates(event)).max().unwrap_or(0);
    let all = preparing(py, order, move |stop| {
        let loads = |vehicles: &[Vehicle]| {
            let mut all: Vec<f64> = vehicles.iter().flat_map(|vehicle| vehicle.static_loads(gravity)).collect();
            all.resize(axles, f64::NAN);
            all
        };
        let ask = || stop.check();
        let nominal = as_given.iter().map(|event| ask().map(|()| loads(event))).collect::<Result<Vec<_>, Error>>()?;
        let mut all = Vec::new();
        memory::reserve(&mut all, "samples", count, count * axles)?;
        for sample in 0..count {
            ask()?;
            let kind = samples.kind(sample);
            match samples.varies_loads() {
                // A sample whose vehicle cannot be has no results either.
                true => match varied_vehicles(&kinds[kind], &samples, sample) {
                    Ok(vehicles) => all.extend(loads(&vehicles)),
                    Err(_) => all.resize(all.len() + axles, f64::NAN),
                },
                false => all.extend_from_slice(&nominal[kind]),
            }
        }
        Ok(all)
    })?;
    rows(py, all, axles)
}

/// Fingerprint of samples together, from that of each.
#[pyfunction]
pub fn fingerprint(digests: PyReadonlyArray1<'_, u64>) -> u64 {
    fingerprint_of(digests.as_array().iter().copied())
}

/// The kinds of event, each of passages.
fn events_of(events: &Bound<'_, PyAny>) -> PyResult<Vec<Vec<Passage>>> {
    events.try_iter()?.map(|event| passages_of(&event?)).collect()
}

/// Factors by parameter, each with rows of numbers.
fn factors_of(factors: &Bound<'_, PyAny>) -> PyResult<Vec<Factors>> {
    let of = |each: PyResult<Bound<'_, PyAny>>| {
        let each = each?;
        let given = Given::new(&each);
        let values: PyReadonlyArray2<'_, f64> = given.of("values")?;
        let values = values.as_array();
        let parameter = Parameter::named(&given.of::<String>("name")?)?;
        Ok(Factors { parameter, width: values.ncols(), values: values.iter().copied().collect() })
    };
    factors.try_iter()?.map(of).collect()
}

/// The samples of a plan.
fn samples_of(plan: &Given<'_, '_>) -> PyResult<Samples> {
    let kinds: PyReadonlyArray1<'_, u32> = plan.of("kinds")?;
    let speeds = plan.get("speeds")?;
    let speeds: PyReadonlyArray1<'_, f64> = Given::new(&speeds).of("column")?;
    Ok(Samples {
        first: plan.of("first")?,
        count: plan.of("samples")?,
        kinds: kinds.as_array().to_vec(),
        speeds: speeds.as_array().to_vec(),
        factors: factors_of(&plan.get("factors")?)?,
    })
}

/// Random roads of the samples' own, which are made where there is time.
struct OwnRoad {
    spectrum: Spectrum,
    patch: Patch,
    period: f64,
    seed: u64,
}

impl OwnRoad {
    fn of(plan: &Given<'_, '_>) -> PyResult<Option<Self>> {
        let seed = plan.of("seed")?;
        plan.one("own", |road| {
            let spectrum = Spectrum::new(road.number("G")?, road.number("waviness")?, road.of("band")?)?;
            let patch = Patch::new(road.number("contact_patch")?)?;
            Ok(OwnRoad { spectrum, patch, period: road.number("period")?, seed })
        })
    }

    fn made(self) -> Result<(Arc<Synthesis>, u64), Error> {
        Ok((Arc::new(Synthesis::new(self.spectrum, self.patch, Some(self.period))?), self.seed))
    }
}

/// Computes the samples of a plan. Where they share the geometry the speeds that passages bring are among those of the
/// samples.
#[pyfunction]
#[pyo3(signature = (bridge, plan, *, events, speeds, road, quantities, threads, progress))]
#[allow(clippy::too_many_arguments)] // one per argument that Python names
pub fn ensemble<'py>(
    py: Python<'py>,
    bridge: &PyBridge,
    plan: &Bound<'py, PyAny>,
    events: &Bound<'py, PyAny>,
    speeds: PyReadonlyArray1<'py, f64>,
    road: &PyRoad,
    quantities: Vec<String>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Ensemble> {
    let workers = Workers::new(threads)?;
    let given = Given::new(plan);
    // Every sample says its own speed.
    let (asked, settings) = conditions_of(&given.get("conditions")?, None, road)?;
    let kinds = events_of(events)?;
    let quantities = quantities.iter().map(|name| quantity(name)).collect::<Result<Vec<_>, Error>>()?;
    let samples = Samples { speeds: speeds.as_array().to_vec(), ..samples_of(&given)? };
    let (count, advance, own_road) = (samples.count, given.optional("advance")?, OwnRoad::of(&given)?);
    let started = Instant::now();
    let solved = Arc::clone(&bridge.0);
    let (analysis, shares, quantities, run) = attended(py, count, progress.as_ref(), move |told| {
        let stopped = || told.stop.load(Ordering::Relaxed);
        let own = own_road.map(OwnRoad::made);
        let analysis = solved.analysis(asked, StopToken::when(&stopped))?;
        let own = own.transpose()?;
        let study = Plan { analysis, kinds, settings, own, advance, quantities: quantities.clone() }.study()?;
        let run = study.run(&samples, &workers, told)?;
        Ok((study.analysis, study.shares, quantities, run))
    })?;
    let elapsed = started.elapsed().as_secs_f64();
    let Run { results, clock, at_rest, .. } = run;
    let (hash, format) = (results.hash(), results.format);
    let numbers = results.numbers.into_pyarray(py).reshape([count, format.width()])?;
    let instants = results.instants.into_pyarray(py).reshape([count, format.instants()])?;
    Ok(Ensemble {
        analysis,
        shares,
        quantities,
        workers,
        format,
        hash,
        elapsed,
        failures: results.failures,
        numbers: numbers.unbind(),
        instants: instants.unbind(),
        digests: results.digests.into_pyarray(py).unbind(),
        marches: results.marches.into_pyarray(py).unbind(),
        at_rest: rows(py, at_rest.concat(), 2 * format.responses)?.unbind(),
        clock: Py::new(py, Clock(clock))?,
    })
}
