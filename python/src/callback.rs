//! Calls of the methods that a shape has in Python.

use crate::arrays;
use crate::error::carried;
use crate::frame::corners;
use leafless::solid::GradientRange;
use leafless::{AnySolid, Bounds, Callback, Error, Interval, Tag, Verdict};
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyReferenceError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyWeakrefMethods, PyWeakrefReference};
use std::sync::Arc;

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
pub fn solid_of(object: &Bound<'_, PyAny>) -> PyResult<AnySolid> {
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
        let [min, max] = corners(&told, "bounds")?;
        let bounds = Bounds::new(min, max);
        let first = || PyValueError::new_err("bounds: the lower corner must come first");
        callback = callback.with_bounds(bounds.ok_or_else(first)?);
    }
    Ok(AnySolid::new(callback))
}
