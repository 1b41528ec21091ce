//! Arrays of NumPy: taken as they are where their layout allows, and given without copies.

use crate::error::refused;
use crate::from_package;
use numpy::ndarray::{ArrayView, Dimension, ShapeBuilder, StrideShape};
use numpy::{
    Element, PyArray, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods,
};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

/// Rows of three doubles from an array, or one row.
pub struct Rows<'py> {
    array: PyReadonlyArray2<'py, f64>,
    /// Whether a single row was given.
    pub is_one: bool,
}

impl<'py> Rows<'py> {
    /// Takes rows of shape (n, 3), or one of shape (3,). An array of doubles that lies in memory row after
    /// row is not copied, and must not be changed by another thread as long as the call takes.
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
        // (Only arrays that lie row after row come here.)
        self.array.as_slice().map_or(&[], bytemuck::cast_slice)
    }
}

/// An array of doubles that lies in memory row after row, copied if need be.
pub fn doubles<'py>(given: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    required(given, "float64", name)
}

/// An array of one type that lies in memory row after row, copied if need be; refused if it holds other
/// things than such numbers.
pub fn required<'py, T: Element>(
    given: &Bound<'py, PyAny>,
    kind: &str,
    name: &str,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let array = from_package!(given.py(), "leafless._exchange", "numbers")?.call1((given, kind, name))?;
    Ok(array.cast_into::<PyArrayDyn<T>>()?)
}

/// A shape as NumPy prints it.
pub fn shape_text(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        all => format!("({})", all.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// Rows of one length.
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

/// Three numbers.
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

/// An array of a shape, which has the list for its memory.
pub fn array<'py, T: Element>(
    py: Python<'py>,
    list: Vec<T>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    PyArray1::from_vec(py, list).reshape(shape)
}

/// The same of rows.
pub fn rows<'py, T: Element, const N: usize>(
    py: Python<'py>,
    list: Vec<[T; N]>,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let count = list.len();
    array(py, list.into_flattened(), &[count, N])
}

/// An array that can be read and not written, of memory that an object of Python keeps alive and never
/// changes.
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

/// Whether the first axis varies fastest, or the last one.
pub fn layout<D: Dimension>(shape: impl ShapeBuilder<Dim = D>, first_is_fastest: bool) -> StrideShape<D> {
    shape.set_f(first_is_fastest).into()
}

/// An array, or of a single question the one answer in it.
pub fn one_or_all<'py>(answers: Bound<'py, PyAny>, is_one: bool) -> PyResult<Bound<'py, PyAny>> {
    if is_one { answers.get_item(0)?.into_bound_py_any(answers.py()) } else { Ok(answers) }
}
