//! Conversion between errors of the library and Python exceptions, and exceptions that pass through the
//! library.

use crate::from_package;
use leafless::Error;
use pyo3::exceptions::{PyMemoryError, PyOSError};
use pyo3::prelude::*;
use std::sync::atomic::{AtomicI32, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};

/// Exceptions raised by shapes written in Python, with the codes under which the library passes them on.
static RAISED: Mutex<Vec<(i32, PyErr)>> = Mutex::new(Vec::new());

/// The maximum number of kept exceptions. If several threads fail at a time, only the first exception is
/// retrieved.
const MOST_RAISED: usize = 64;

/// Returns the library's error that stands for an exception, until [`raised`] converts it back.
pub fn carried(error: PyErr) -> Error {
    static NEXT: AtomicI32 = AtomicI32::new(1);
    let code = NEXT.fetch_add(1, Relaxed);
    let mut kept = RAISED.lock().unwrap_or_else(PoisonError::into_inner);
    if kept.len() == MOST_RAISED {
        kept.remove(0);
    }
    kept.push((code, error));
    Error::Callback { code }
}

/// Returns the exception of an error: the one that a Python function raised, or one with the library's
/// message.
pub fn raised(py: Python<'_>, error: Error) -> PyErr {
    if let Error::Callback { code } = error {
        let mut kept = RAISED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(place) = kept.iter().position(|(own, _)| *own == code) {
            return kept.remove(place).1;
        }
    }
    let message = error.to_string();
    let class = match error.cause() {
        Error::OutOfMemory => return PyMemoryError::new_err(message),
        Error::Io(cause) => {
            return match cause.raw_os_error() {
                // Python derives the class from the number, such as FileNotFoundError.
                Some(code) => PyOSError::new_err((code, message)),
                None => PyOSError::new_err(message),
            };
        }
        Error::Argument { .. } => from_package!(py, "leafless._errors", "ArgumentError"),
        Error::FrameMismatch { .. } => from_package!(py, "leafless._errors", "FrameMismatchError"),
        Error::Limit { .. } | Error::TooLarge { .. } => from_package!(py, "leafless._errors", "LimitError"),
        Error::Cancelled => from_package!(py, "leafless._errors", "CancelledError"),
        Error::Format(_)
        | Error::Damaged(_)
        | Error::DamagedRays { .. }
        | Error::MeshFile(_)
        | Error::Package(_)
        | Error::VolumeFile(_)
        | Error::Scene(_) => from_package!(py, "leafless._errors", "FormatError"),
        Error::Mesh(_) | Error::Polyhedron(_) => from_package!(py, "leafless._errors", "MeshError"),
        _ => from_package!(py, "leafless._errors", "Error"),
    };
    match class.and_then(|class| class.call1((message,))) {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}

/// Conversion of the library's results to Python's.
pub trait OrRaise<T> {
    /// Returns the value, or the exception of the error.
    fn or_raise(self, py: Python<'_>) -> PyResult<T>;
}

impl<T> OrRaise<T> for Result<T, Error> {
    fn or_raise(self, py: Python<'_>) -> PyResult<T> {
        self.map_err(|error| raised(py, error))
    }
}

/// Renames parameters of the library to their names in Python.
pub fn called<const N: usize>(names: [(&'static str, &'static str); N]) -> impl Fn(Error) -> Error {
    move |error| match error {
        Error::Argument { name, problem } => {
            let known = names.iter().find(|(own, _)| *own == name);
            Error::Argument { name: known.map_or(name, |&(_, called)| called), problem }
        }
        other => other,
    }
}

/// Returns an exception about an argument, in the form of the library's messages.
pub fn refused(py: Python<'_>, name: &str, problem: impl std::fmt::Display) -> PyErr {
    let class = from_package!(py, "leafless._errors", "ArgumentError");
    match class.and_then(|class| class.call1((format!("{name}: {problem}"),))) {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}
