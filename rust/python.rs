//! The extension module `spanwise._core`: conversion between Python and the core, and nothing else.

mod bridge;
mod crossing;
mod ensemble;
mod given;
mod road;
mod vehicle;

use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use faer::Mat;
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBytes, PyType};

use crate::ensemble::Progress;
use crate::error::Error;
use crate::float_mode::Standard;
use crate::stop_token::StopToken;
use crate::threads;

type Vector<'py> = Bound<'py, PyArray1<f64>>;
type Matrix<'py> = Bound<'py, PyArray2<f64>>;

/// Keeps freed memory for the next crossing: histories are megabytes, and fresh pages cost more than filling them.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Time between two looks at whether Python wants to interrupt.
const SIGNAL_INTERVAL: Duration = Duration::from_millis(100);

impl From<Error> for PyErr {
    fn from(error: Error) -> Self {
        match error.refused() {
            Some(parts) => Python::attach(|py| refused(py, parts)).unwrap_or_else(|failed| failed),
            None => PyRuntimeError::new_err(error.to_string()),
        }
    }
}

/// The error of Python that knows the parts of its message.
fn refused(py: Python<'_>, [key, value, allowed]: [String; 3]) -> PyResult<PyErr> {
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let class = CLASS.import(py, "spanwise.errors", "InputError")?;
    Ok(PyErr::from_type(class.clone(), (key, value, allowed)))
}

/// Runs `work` with the interpreter released. Every 100 ms its question whether to go on attaches again and lets Python
/// handle signals; what a handler raises, such as `KeyboardInterrupt`, ends the work and is raised.
fn interruptible<T: Send>(py: Python<'_>, work: impl FnOnce(StopToken<'_>) -> Result<T, Error> + Send) -> PyResult<T> {
    let (result, raised) = py.detach(|| {
        let (last, raised) = (Cell::new(Instant::now()), Cell::new(None));
        let stopped = || {
            if last.get().elapsed() < SIGNAL_INTERVAL {
                return false;
            }
            let answer = Python::attach(|py| py.check_signals());
            last.set(Instant::now());
            let stopped = answer.is_err();
            raised.set(answer.err());
            stopped
        };
        (work(StopToken::when(&stopped)), raised.take())
    });
    match raised {
        Some(error) => Err(error),
        None => Ok(result?),
    }
}

/// Order of matrices up to which dense algebra, which cannot ask, is over in milliseconds.
const SMALL: usize = 150;

/// Runs `work` on matrices of this order, [`interruptible`] as it is or, where it could not ask often enough, [`attended`].
fn preparing<T: Send + 'static>(
    py: Python<'_>,
    order: usize,
    work: impl FnOnce(StopToken<'_>) -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    aside(py, order > SMALL, work)
}

/// Runs `work` [`attended`] if it is `long` between its questions, or [`interruptible`] as it is.
fn aside<T: Send + 'static>(
    py: Python<'_>,
    long: bool,
    work: impl FnOnce(StopToken<'_>) -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    match long {
        true => attended(py, 0, None, move |progress| work(StopToken::when(&|| progress.stop.load(Ordering::Relaxed)))),
        false => interruptible(py, work),
    }
}

/// Runs `work` on a thread of its own with the interpreter released. Every 100 ms Python handles signals, and hears how
/// far it is if it wants to; what either raises stops the work and is raised. Work that does not stop at once is left to
/// itself until it asks again: a library may be in the midst of a matrix.
fn attended<T: Send + 'static>(
    py: Python<'_>,
    total: usize,
    listener: Option<&Py<PyAny>>,
    work: impl FnOnce(&Progress) -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    let shared = Arc::new(Progress::default());
    let own = Arc::clone(&shared);
    let progress = &*shared;
    let tell = |py: Python<'_>| match listener {
        Some(listener) => listener.call1(py, (progress.done.load(Ordering::Relaxed), total)).map(drop),
        None => Ok(()),
    };
    let (ended, end) = channel();
    let worker = threads::start(move || {
        // What is prepared here must not depend on the mode of the calling thread either.
        let _mode = Standard::set();
        // Nobody listens any more to work that was left to itself.
        let _ = ended.send(work(&own));
    })?;
    let (result, raised) = py.detach(move || {
        let mut last = Instant::now();
        let mut raised = None;
        loop {
            match end.recv_timeout(SIGNAL_INTERVAL / 2) {
                Ok(result) => return (Some(result), raised),
                Err(RecvTimeoutError::Disconnected) => return (None, raised),
                Err(RecvTimeoutError::Timeout) if last.elapsed() < SIGNAL_INTERVAL => {}
                Err(RecvTimeoutError::Timeout) if raised.is_some() => return (None, raised),
                Err(RecvTimeoutError::Timeout) => {
                    // That all is done is told once, at the end.
                    let going = progress.done.load(Ordering::Relaxed) < total;
                    let look = |py: Python<'_>| py.check_signals().and_then(|()| if going { tell(py) } else { Ok(()) });
                    raised = Python::attach(look).err();
                    progress.stop.store(raised.is_some(), Ordering::Relaxed);
                    last = Instant::now();
                }
            }
        }
    });
    if let Some(error) = raised {
        return Err(error);
    }
    let Some(result) = result else {
        // It ended without a result.
        let panic = py.detach(|| worker.join()).err();
        let text = panic.as_ref().and_then(|panic| {
            let own = panic.downcast_ref::<String>().map(String::as_str);
            own.or(panic.downcast_ref::<&str>().copied())
        });
        let text = text.unwrap_or("no message");
        return Err(PyRuntimeError::new_err(format!("internal error, please report it: {text}")));
    };
    let result = result?;
    tell(py)?;
    Ok(result)
}

/// Row-major values as a two-dimensional array, without a copy.
fn rows<'py>(py: Python<'py>, values: Vec<f64>, width: usize) -> PyResult<Matrix<'py>> {
    let height = values.len().checked_div(width).unwrap_or(0);
    values.into_pyarray(py).reshape([height, width])
}

/// A value as bytes, which make the same again.
fn packed<'py, T: serde::Serialize>(py: Python<'py>, value: &T) -> PyResult<Bound<'py, PyBytes>> {
    let bytes = postcard::to_stdvec(value).map_err(|e| PyRuntimeError::new_err(e.to_string()))?;
    Ok(PyBytes::new(py, &bytes))
}

fn matrix<'py>(py: Python<'py>, m: &Mat<f64>) -> Matrix<'py> {
    Array2::from_shape_fn((m.nrows(), m.ncols()), |(i, j)| m[(i, j)]).into_pyarray(py)
}

#[pymodule]
mod _core {
    use numpy::PyArray1;
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::bridge::PyBridge;
    #[pymodule_export]
    use super::crossing::{Crossing, cross};
    #[pymodule_export]
    use super::ensemble::{Clock, Ensemble, check_samples, ensemble, fingerprint, static_loads, varied};
    #[pymodule_export]
    use super::road::{PyRoad, road_classes};
    #[pymodule_export]
    use super::vehicle::{
        PyVehicle, articulated_5_axle, cl_625, flm3, flm4, half_car, hs20, hs20_44, kishan_1973, presets, quarter_car,
        t44,
    };
    use crate::vehicle::catalogue;

    #[pymodule_export]
    const FLM4_MIX: [(&str, [f64; 5]); 3] = catalogue::FLM4_MIX;
    #[pymodule_export]
    const HS20_REAR_SPACING: [f64; 2] = catalogue::HS20_REAR_SPACING;
    #[pymodule_export]
    const T44_REAR_SPACING: [f64; 2] = catalogue::T44_REAR_SPACING;

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
}
