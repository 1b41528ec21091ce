//! Conversion of arguments: numbers, texts and objects. A refusal names the parameter as callers know it.

use crate::error::refused;
use crate::from_package;
use leafless::lattice::MAX_DEPTH;
use pyo3::PyClass;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyInt};
use std::path::PathBuf;

/// A type that an argument converts to.
pub trait Argument<'a, 'py>: Sized {
    /// Converts an object, or refuses it with the name of the parameter.
    fn take(given: &'a Bound<'py, PyAny>, name: &str) -> PyResult<Self>;
}

/// Returns the refusal of an object of the wrong type.
pub fn other_type(given: &Bound<'_, PyAny>, name: &str, kind: &str) -> PyErr {
    match given.get_type().name() {
        Ok(own) => PyTypeError::new_err(format!("{name}: must be {kind}, not {own}")),
        Err(error) => error,
    }
}

/// Refuses an object for its type. An error about something other than types, such as Ctrl-C, is passed on.
fn refusal(given: &Bound<'_, PyAny>, name: &str, kind: &str, error: PyErr) -> PyErr {
    if error.is_instance_of::<PyTypeError>(given.py()) { other_type(given, name, kind) } else { error }
}

impl<'py> Argument<'_, 'py> for f64 {
    fn take(given: &Bound<'py, PyAny>, name: &str) -> PyResult<f64> {
        let is_plain = given.is_exact_instance_of::<PyFloat>() || given.is_exact_instance_of::<PyInt>();
        // Python would drop an imaginary part, and make NaN of a masked number.
        if !is_plain
            && from_package!(given.py(), "leafless._exchange", "is_lossy")?.call1((given,))?.is_truthy()?
        {
            return Err(other_type(given, name, "a number"));
        }
        given.extract().map_err(|error| refusal(given, name, "a number", error))
    }
}

impl<'py> Argument<'_, 'py> for bool {
    fn take(given: &Bound<'py, PyAny>, name: &str) -> PyResult<bool> {
        given.extract().map_err(|error| refusal(given, name, "True or False", error))
    }
}

impl<'a> Argument<'a, '_> for &'a str {
    fn take(given: &'a Bound<'_, PyAny>, name: &str) -> PyResult<&'a str> {
        given.extract().map_err(|_| other_type(given, name, "a str"))
    }
}

/// Reads a whole number of a type; `range` is the text for its range.
fn whole<'py, T>(given: &Bound<'py, PyAny>, name: &str, range: &str) -> PyResult<T>
where
    T: for<'a> FromPyObject<'a, 'py, Error = PyErr>,
{
    let py = given.py();
    given.extract::<T>().map_err(|error| {
        if error.is_instance_of::<pyo3::exceptions::PyOverflowError>(py) {
            return refused(py, name, format!("must be a whole number from {range}, not {given}"));
        }
        refusal(given, name, "a whole number", error)
    })
}

macro_rules! wholes {
    ($($kind:ty: $range:literal),* $(,)?) => {$(
        impl<'py> Argument<'_, 'py> for $kind {
            fn take(given: &Bound<'py, PyAny>, name: &str) -> PyResult<$kind> {
                whole(given, name, $range)
            }
        }
    )*};
}

wholes! {
    u8: "0 to 255",
    u32: "0 to 2^32 - 1",
    u64: "0 to 2^64 - 1",
    usize: "0 to 2^64 - 1",
}

/// A level of a frame, from `LOWEST` to [`MAX_DEPTH`].
#[derive(Clone, Copy)]
pub struct Deep<const LOWEST: u8>(pub u8);

/// The depth of a frame.
pub type Depth = Deep<1>;

/// A level of a frame; 0 is the universe.
pub type Level = Deep<0>;

impl<'py, const LOWEST: u8> Argument<'_, 'py> for Deep<LOWEST> {
    fn take(given: &Bound<'py, PyAny>, name: &str) -> PyResult<Deep<LOWEST>> {
        let range = format!("{LOWEST} to {MAX_DEPTH}");
        let level = whole(given, name, &range)?;
        if (LOWEST..=MAX_DEPTH).contains(&level) {
            return Ok(Deep(level));
        }
        Err(refused(given.py(), name, format!("must be a whole number from {range}, not {level}")))
    }
}

impl<'a, 'py, T: Argument<'a, 'py>> Argument<'a, 'py> for Option<T> {
    fn take(given: &'a Bound<'py, PyAny>, name: &str) -> PyResult<Option<T>> {
        if given.is_none() { Ok(None) } else { T::take(given, name).map(Some) }
    }
}

impl<'py, T: for<'b> Argument<'b, 'py>, const N: usize> Argument<'_, 'py> for [T; N] {
    fn take(given: &Bound<'py, PyAny>, name: &str) -> PyResult<[T; N]> {
        let kind = format!("a sequence of {N} numbers");
        let items = given.try_iter().map_err(|error| refusal(given, name, &kind, error))?;
        let items: Vec<T> = items.map(|item| T::take(&item?, name)).collect::<PyResult<_>>()?;
        let count = items.len();
        items.try_into().map_err(|_| refused(given.py(), name, format!("must be {N} numbers, not {count}")))
    }
}

impl<'a> Argument<'a, '_> for &'a [u8] {
    fn take(given: &'a Bound<'_, PyAny>, name: &str) -> PyResult<&'a [u8]> {
        given.extract().map_err(|_| other_type(given, name, "bytes"))
    }
}

impl Argument<'_, '_> for PathBuf {
    fn take(given: &Bound<'_, PyAny>, name: &str) -> PyResult<PathBuf> {
        given.extract().map_err(|error| refusal(given, name, "a str or a path", error))
    }
}

impl<'py, T: PyClass> Argument<'_, 'py> for Bound<'py, T> {
    fn take(given: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, T>> {
        let article = if T::NAME.starts_with(['A', 'E', 'I', 'O', 'U']) { "an" } else { "a" };
        let other = |_| other_type(given, name, &format!("{article} {}", T::NAME));
        given.cast::<T>().cloned().map_err(other)
    }
}

/// Functions for `from_py_with`, each named after its parameter.
pub mod named {
    use super::Argument;
    use pyo3::prelude::*;

    macro_rules! named {
        ($($name:ident)*) => {$(
            pub fn $name<'a, 'py, T: Argument<'a, 'py>>(given: &'a Bound<'py, PyAny>) -> PyResult<T> {
                T::take(given, stringify!($name))
            }
        )*};
    }

    named! {
        absolute at axis background bottom boundary_depth by_ends cell cells channel code coefficients data
        degrees depth deviation directions displacement doubles dtype edge edges empty end fill first folder
        frame from_mesh full high intersecting_pairs last least level low lower major mesh method minor
        model name nearest normals octree offset on order outer outside radii radius resolve resume rule
        samples shard size slice solid surfaces text to tolerance top upper verify view
    }
}
