//! Shapes whose methods are written in Python.

use crate::arrays;
use crate::error::carried;
use crate::solid::{Given, Solid};
use leafless::solid::GradientRange;
use leafless::{AnySolid, Bounds, Callback, Error, Interval, Tag, Verdict};
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyReferenceError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType, PyWeakrefMethods, PyWeakrefReference};
use std::sync::Arc;

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

/// The Python methods of a shape, as the library calls them. The reference is weak, because Python's
/// collector does not see references that the library holds. An owner that keeps a solid beyond a call also
/// keeps the object.
struct Methods(Py<PyWeakrefReference>);

/// Reads the numbers of an array that must have a given shape.
fn numbers(array: &Bound<'_, PyAny>, kind: &str, name: &str, shape: &[usize]) -> PyResult<Vec<f64>> {
    let array: Bound<'_, PyArrayDyn<f64>> = arrays::required(array, kind, name)?;
    if array.shape() != shape {
        return Err(PyValueError::new_err(format!(
            "{name}: must return an array of the shape {shape:?}, not {:?}",
            array.shape()
        )));
    }
    Ok(array.readonly().as_slice()?.to_vec())
}

impl Methods {
    fn call<R>(
        &self,
        name: &str,
        argument: impl for<'py> FnOnce(Python<'py>) -> PyResult<Bound<'py, PyAny>>,
        take: impl for<'py> FnOnce(Bound<'py, PyAny>) -> PyResult<R>,
    ) -> Result<R, Error> {
        Python::attach(|py| {
            let gone = || PyReferenceError::new_err("the shape is no longer there");
            let shape = self.0.bind(py).upgrade().ok_or_else(gone)?;
            let called = shape.call_method1(name, (argument(py)?,))?;
            take(called)
        })
        .map_err(carried)
    }

    fn classify(&self, boxes: &[[[f64; 3]; 2]], verdicts: &mut [Verdict<()>]) -> Result<(), Error> {
        let tags = self.call(
            "classify",
            |py| boxes_of(py, boxes),
            |tags| numbers(&tags, "float64", "classify", &[boxes.len()]),
        )?;
        for (verdict, tag) in verdicts.iter_mut().zip(tags) {
            *verdict = if tag == f64::from(Tag::Empty as u8) {
                Verdict::Empty
            } else if tag == f64::from(Tag::Full as u8) {
                Verdict::Full
            } else if tag == f64::from(Tag::Partial as u8) {
                Verdict::Partial(())
            } else {
                let problem = format!("classify: {tag} is none of the tags EMPTY, PARTIAL and FULL");
                return Err(carried(PyValueError::new_err(problem)));
            };
        }
        Ok(())
    }

    fn distance(&self, points: &[[f64; 3]], distances: &mut [f64]) -> Result<(), Error> {
        let found = self.call(
            "distance",
            |py| points_of(py, points),
            |found| numbers(&found, "float64", "distance", &[points.len()]),
        )?;
        distances.copy_from_slice(&found);
        Ok(())
    }

    fn inside(&self, points: &[[f64; 3]], inside: &mut [bool]) -> Result<(), Error> {
        let found = self.call(
            "inside",
            |py| points_of(py, points),
            |found| numbers(&found, "float64", "inside", &[points.len()]),
        )?;
        if found.iter().any(|found| found.is_nan()) {
            return Err(carried(PyValueError::new_err("inside: NaN is neither true nor false")));
        }
        for (inside, found) in inside.iter_mut().zip(found) {
            *inside = found != 0.0;
        }
        Ok(())
    }

    fn gradient(&self, min: [f64; 3], max: [f64; 3]) -> Result<Option<GradientRange>, Error> {
        self.call(
            "gradient",
            |py| boxes_of(py, &[[min, max]]),
            |found| {
                let (value, gradient): (Bound<'_, PyAny>, Bound<'_, PyAny>) = found.extract()?;
                let value = numbers(&value, "float64", "gradient", &[1, 2])?;
                let gradient = numbers(&gradient, "float64", "gradient", &[1, 3, 2])?;
                let range = |ends: &[f64]| Interval::new(ends[0], ends[1]);
                let ranges =
                    (range(&value), range(&gradient[..2]), range(&gradient[2..4]), range(&gradient[4..]));
                Ok(match ranges {
                    (Some(value), Some(x), Some(y), Some(z)) => {
                        Some(GradientRange { value, gradient: [x, y, z] })
                    }
                    _ => None,
                })
            },
        )
    }
}

fn boxes_of<'py>(py: Python<'py>, boxes: &[[[f64; 3]; 2]]) -> PyResult<Bound<'py, PyAny>> {
    let numbers = boxes.as_flattened().as_flattened().to_vec();
    Ok(arrays::array(py, numbers, &[boxes.len(), 2, 3])?.into_any())
}

fn points_of<'py>(py: Python<'py>, points: &[[f64; 3]]) -> PyResult<Bound<'py, PyAny>> {
    Ok(arrays::rows(py, points.to_vec())?.into_any())
}

/// Returns the solid of an object whose methods are written in Python.
pub fn given(object: &Bound<'_, PyAny>) -> PyResult<Given> {
    let has = |name: &str| object.get_type().hasattr(name);
    let (classifies, measures) = (has("classify")?, has("distance")?);
    if !classifies && !measures {
        return Err(PyTypeError::new_err(format!(
            "{} must have a method classify(boxes) or distance(points)",
            object.get_type().name()?
        )));
    }
    let methods = Arc::new(Methods(PyWeakrefReference::new(object)?.unbind()));
    let own = || methods.clone();
    let (one, many) = (own(), own());
    let mut callback = Callback::new(move |min, max| {
        let mut verdict = [Verdict::Partial(())];
        if classifies {
            one.classify(&[[min, max]], &mut verdict)?;
        }
        let [verdict] = verdict;
        Ok(verdict)
    });
    if classifies {
        callback = callback.with_classify_many(move |boxes, verdicts| {
            let boxes: &[[[f64; 3]; 2]] = boxes;
            many.classify(boxes, verdicts)
        });
    }
    if measures {
        let methods = own();
        callback = callback.with_distance(move |points, distances| methods.distance(points, distances));
    }
    if has("inside")? {
        let methods = own();
        callback = callback.with_contains_many(move |points, inside| methods.inside(points, inside));
    }
    if has("gradient")? {
        let methods = own();
        callback = callback.with_gradient(move |min, max, _| methods.gradient(min, max));
    }
    let told = object.getattr("bounds")?;
    if !told.is_none() {
        let [min, max] = crate::frame::corners(&told, "bounds")?;
        let bounds = Bounds::new(min, max);
        let first = || PyValueError::new_err("bounds: the lower corner must come first");
        callback = callback.with_bounds(bounds.ok_or_else(first)?);
    }
    Ok(Given { calls_python: true, ..Given::new(AnySolid::new(callback)) })
}
