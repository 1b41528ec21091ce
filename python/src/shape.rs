//! The class of shapes whose methods are written in Python.

use crate::solid::Solid;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

/// A solid of your own. A subclass defines at least one of these methods, which get arrays of many cells or
/// points at once:
///
/// - `classify(boxes)` gets boxes of shape (n, 2, 3), lower and upper corners. It returns n tags: EMPTY or
///   FULL where that is proven for the whole box, else PARTIAL.
/// - `distance(points)` gets points of shape (n, 3). It returns n numbers, negative inside. The magnitude of
///   each is at most the distance from the surface; 0 carries no information.
///
/// These members are optional:
///
/// - `inside(points)` returns n booleans. The "sampled" rule needs this method.
/// - `gradient(boxes)` bounds a function f over the boxes; the solid is f ≤ 0. It returns two arrays of
///   bounds: the value at the centre of each box, of shape (n, 2), and the derivatives in the whole box, of
///   shape (n, 3, 2). Measures need far fewer cells with it. NaN carries no information.
/// - `bounds` is a lower and an upper corner of a box that contains the whole shape: an attribute of the
///   class or of the object, or a property.
///
/// The positional `arguments` and the `named` ones are those of your `__init__`.
///
/// The methods are called from several threads, one at a time. An exception in a method ends the operation,
/// which raises it.
///
/// >>> import numpy as np
/// >>> class Ball(Shape):
/// ...     bounds = [[-1, -1, -1], [1, 1, 1]]
/// ...     def distance(self, points):
/// ...         return np.linalg.norm(points, axis=1) * (1 - 1e-15) - 1
/// >>> 4.18879 in build(Ball(), depth=5).volume
/// True
#[pyclass(extends = Solid, subclass, frozen, module = "leafless")]
pub struct Shape;

#[pymethods]
impl Shape {
    /// `None`: no bounds are known. It is a plain attribute, unlike `bounds` of other solids, so that a
    /// subclass or an object may replace it.
    #[classattr]
    #[allow(non_upper_case_globals)]
    const bounds: Option<u8> = None;

    /// Leaves arguments to `__init__`. If no class takes them, they are refused, as `object` does.
    #[new]
    #[classmethod]
    #[pyo3(signature = (*arguments, **named))]
    fn new(
        class: &Bound<'_, PyType>,
        arguments: &Bound<'_, PyTuple>,
        named: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Shape>> {
        let py = class.py();
        if !arguments.is_empty() || named.is_some_and(|named| !named.is_empty()) {
            let inherits = |name: &str, from: Bound<'_, PyType>| -> PyResult<bool> {
                Ok(class.getattr(name)?.is(&from.getattr(name)?))
            };
            if !inherits("__new__", py.get_type::<Shape>())? {
                return Err(PyTypeError::new_err("Shape.__new__() takes the class and nothing else"));
            }
            if inherits("__init__", py.get_type::<PyAny>())? {
                return Err(PyTypeError::new_err(format!("{}() takes no arguments", class.name()?)));
            }
        }
        Ok(PyClassInitializer::from(Solid::of_python()).add_subclass(Shape))
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        Ok(format!("<{}>", slf.get_type().name()?))
    }

    /// Lets `object.__reduce_ex__` pickle the attributes alone.
    fn __getnewargs__<'py>(&self, py: Python<'py>) -> Bound<'py, PyTuple> {
        PyTuple::empty(py)
    }
}
