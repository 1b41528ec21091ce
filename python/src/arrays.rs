//! NumPy arrays: read in place where their layout allows, and returned without copies.

use crate::error::refused;
use crate::from_package;
use numpy::ndarray::{ArrayView, Dimension, ShapeBuilder, StrideShape};
use numpy::{
    Element, PyArray, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods,
};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

/// Rows of three doubles, from an array of rows or from a single row.
pub struct Rows<'py> {
    array: PyReadonlyArray2<'py, f64>,
    /// True if a single row was given.
    pub is_one: bool,
}

impl<'py> Rows<'py> {
    /// Reads rows of shape (n, 3), or one row of shape (3,). A C-contiguous array of doubles is not copied,
    /// and no other thread may change it during the call.
    pub fn of(given: &Bound<'py, PyAny>, name: &str) -> PyResult<Rows<'py>> {
        if given.get_type().is(&from_package!(given.py(), "numpy", "ndarray")?)
            && let Ok(array) = given.cast::<PyArray2<f64>>()
            && array.shape()[1] == 3
            && array.is_c_contiguous()
            && array.data().is_aligned()
        {
            return Ok(Rows { array: array.readonly(), is_one: false });
        }
        let array = doubles(given, name)?;
        let is_one = array.ndim() == 1;
        let rows = match array.shape() {
            [3] => array.reshape([1, 3])?,
            &[n, 3] => array.reshape([n, 3])?,
            // An empty list has one axis.
            [0] => array.reshape([0, 3])?,
            shape => {
                return Err(refused(
                    given.py(),
                    name,
                    format!("must have the shape (n, 3) or (3,), not {}", shape_text(shape)),
                ));
            }
        };
        Ok(Rows { array: rows.readonly(), is_one: is_one && rows.shape()[0] == 1 })
    }

    /// The rows.
    pub fn list(&self) -> &[[f64; 3]] {
        // The array is always C-contiguous here.
        self.array.as_slice().map_or(&[], bytemuck::cast_slice)
    }
}

/// Reads a C-contiguous array of doubles, copied if necessary.
pub fn doubles<'py>(given: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    required(given, "float64", name)
}

/// Reads a C-contiguous array of one type, copied if necessary. Elements that are no such numbers are
/// refused.
pub fn required<'py, T: Element>(
    given: &Bound<'py, PyAny>,
    kind: &str,
    name: &str,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let array = from_package!(given.py(), "leafless._exchange", "numbers")?.call1((given, kind, name))?;
    Ok(array.cast_into::<PyArrayDyn<T>>()?)
}

/// Formats a shape as NumPy prints it.
pub fn shape_text(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        all => format!("({})", all.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// Reads rows of `N` numbers.
pub fn table<const N: usize>(given: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<[f64; N]>> {
    let array = doubles(given, name)?;
    // An empty list has one axis.
    if !matches!(*array.shape(), [0]) && !matches!(*array.shape(), [_, n] if n == N) {
        let problem = format!("must have the shape (n, {N}), not {}", shape_text(array.shape()));
        return Err(refused(given.py(), name, problem));
    }
    let numbers = array.readonly();
    Ok(numbers.as_slice()?.as_chunks().0.to_vec())
}

/// Reads three numbers.
pub fn triple(given: &Bound<'_, PyAny>, name: &str) -> PyResult<[f64; 3]> {
    // A tuple or a list needs no array.
    if (given.is_instance_of::<PyTuple>() || given.is_instance_of::<PyList>())
        && let Ok(numbers) = given.extract::<[f64; 3]>()
    {
        return Ok(numbers);
    }
    let array = doubles(given, name)?;
    match (array.shape(), array.readonly().as_slice()?) {
        ([_], &[x, y, z]) => Ok([x, y, z]),
        (shape, _) => Err(refused(
            given.py(),
            name,
            format!("must be three numbers, not of the shape {}", shape_text(shape)),
        )),
    }
}

/// Returns an array of a shape that owns the list's memory.
pub fn array<'py, T: Element>(
    py: Python<'py>,
    list: Vec<T>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    PyArray1::from_vec(py, list).reshape(shape)
}

/// Returns an array of rows that owns the list's memory.
pub fn rows<'py, T: Element, const N: usize>(
    py: Python<'py>,
    list: Vec<[T; N]>,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let count = list.len();
    array(py, list.into_flattened(), &[count, N])
}

/// Returns a read-only array over memory that a Python object keeps alive and never changes.
pub fn shown<'py, T: Element, D: Dimension>(
    owner: &Bound<'py, PyAny>,
    memory: &[T],
    shape: impl Into<StrideShape<D>>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = owner.py();
    let Ok(view) = ArrayView::from_shape(shape, memory) else {
        return Err(refused(py, "shape", "does not fit the memory"));
    };
    // SAFETY: the array holds a reference to the owner, which keeps the memory where it is for as long as it
    // lives.
    let array = unsafe { PyArray::borrow_from_array(&view, owner.clone()) };
    let readonly = PyDict::new(py);
    readonly.set_item("write", false)?;
    array.call_method("setflags", (), Some(&readonly))?;
    Ok(array.into_any())
}

/// Returns the layout of a shape: the first or the last axis varies fastest.
pub fn layout<D: Dimension>(shape: impl ShapeBuilder<Dim = D>, first_is_fastest: bool) -> StrideShape<D> {
    shape.set_f(first_is_fastest).into()
}

/// Returns the array of answers, or for a single query its one answer.
pub fn one_or_all<'py>(answers: Bound<'py, PyAny>, is_one: bool) -> PyResult<Bound<'py, PyAny>> {
    if is_one { answers.get_item(0)?.into_bound_py_any(answers.py()) } else { Ok(answers) }
}
