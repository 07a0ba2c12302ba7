//! Objects of Python read by attribute; what is no number is refused in the words of Python's own checks.

use pyo3::prelude::*;
use pyo3::types::PyFloat;

use crate::error::Error;

/// An object that is read.
pub struct Given<'a, 'py> {
    object: &'a Bound<'py, PyAny>,
    /// What stands before the names of what is refused, such as `bodies[0].`.
    pub place: String,
}

impl<'a, 'py> Given<'a, 'py> {
    /// One whose attributes are arguments themselves.
    pub fn new(object: &'a Bound<'py, PyAny>) -> Self {
        Given { object, place: String::new() }
    }

    /// One that stands somewhere.
    pub fn at(object: &'a Bound<'py, PyAny>, place: String) -> Self {
        Given { object, place }
    }

    /// An attribute as it is.
    pub fn get(&self, name: &str) -> PyResult<Bound<'py, PyAny>> {
        self.object.getattr(name)
    }

    /// An attribute of a known type, which has been checked.
    pub fn of<T: for<'b> FromPyObject<'b, 'py, Error = PyErr>>(&self, name: &str) -> PyResult<T> {
        self.get(name)?.extract()
    }

    /// An attribute that may be none.
    fn maybe(&self, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
        Ok(Some(self.get(name)?).filter(|value| !value.is_none()))
    }

    /// A number.
    pub fn number(&self, name: &str) -> PyResult<f64> {
        self.numeric(&self.get(name)?, name)
    }

    /// A number called otherwise.
    pub fn number_called(&self, name: &str, key: &str) -> PyResult<f64> {
        checked_number(&self.get(name)?, key)
    }

    /// A number, or none.
    pub fn optional(&self, name: &str) -> PyResult<Option<f64>> {
        self.maybe(name)?.map(|value| self.numeric(&value, name)).transpose()
    }

    /// A whole number, 0 or more.
    pub fn count(&self, name: &str) -> PyResult<usize> {
        let value = self.get(name)?;
        let checks = value.py().import("spanwise._checks")?;
        checks.call_method1("count", (self.key(name), value))?.extract()
    }

    /// What is made of each of a list.
    pub fn each<T>(&self, name: &str, make: impl Fn(Given<'_, 'py>) -> PyResult<T>) -> PyResult<Vec<T>> {
        let one = |(k, item): (usize, PyResult<Bound<'py, PyAny>>)| {
            make(Given::at(&item?, format!("{}[{k}].", self.key(name))))
        };
        self.get(name)?.try_iter()?.enumerate().map(one).collect()
    }

    /// What is made of an object, if there is one.
    pub fn one<T>(&self, name: &str, make: impl Fn(Given<'_, 'py>) -> PyResult<T>) -> PyResult<Option<T>> {
        self.maybe(name)?.map(|object| make(Given::at(&object, format!("{}.", self.key(name))))).transpose()
    }

    /// What an attribute is called.
    pub fn key(&self, name: &str) -> String {
        format!("{}{name}", self.place)
    }

    fn numeric(&self, value: &Bound<'py, PyAny>, name: &str) -> PyResult<f64> {
        match value.cast_exact::<PyFloat>() {
            Ok(float) => Ok(float.value()),
            Err(_) => checked_number(value, &self.key(name)),
        }
    }
}

/// The number that Python takes this for.
fn checked_number(value: &Bound<'_, PyAny>, key: &str) -> PyResult<f64> {
    value.py().import("spanwise._checks")?.call_method1("number", (key, value))?.extract()
}

/// What a value is called among several words.
pub fn one_of<T: Copy, const N: usize>(key: &str, name: &str, words: [(&str, T); N]) -> Result<T, Error> {
    words.iter().find(|(word, _)| *word == name).map(|(_, meant)| *meant).ok_or_else(|| {
        let all = words.map(|(word, _)| word);
        let (last, others) = all.split_last().map_or(("", &[][..]), |(last, others)| (*last, others));
        Error::input(key, format!("\"{name}\""), format!("must be {} or {last}", others.join(", ")))
    })
}
