//! Arrays of samples as solids.

use crate::arguments::{Argument, named, other_type};
use crate::arrays::{self, layout, shown, triple};
use crate::error::{OrRaise, called, refused};
use crate::frame::Frame;
use crate::from_package;
use crate::solid::{Given, Solid};
use crate::work::Limits;
use leafless::solid::{Band, SampleArray, Samples, VoxelGrid};
use leafless::{AnySolid, Volume as Inner};
use numpy::{Element, PyArray3, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::Arc;

/// A solid of a 3-D `array` of samples: the voxels whose values lie in a band.
///
/// The array is indexed [x, y, z]. With `order="zyx"` it is indexed [z, y, x], as in SimpleITK and tifffile.
/// It holds booleans, uint8, uint16, int16 or float32.
///
/// An array in which x varies fastest is not copied: "zyx" in NumPy's default order, "xyz" in Fortran's. Do
/// not change such an array while the volume exists.
///
/// A voxel is inside if its sample is at least `threshold`. Two thresholds are the least and the greatest
/// sample inside. The default is 0.5 for booleans and float32, 127.5 for uint8, 32767.5 for uint16 and 0 for
/// int16. `origin` is the lower corner of the first voxel. `spacing` is the edge of a voxel, or the edges
/// along x, y and z.
///
/// >>> import numpy as np
/// >>> x, y, z = np.mgrid[-10:11, -10:11, -10:11]
/// >>> ball = Volume(100 - (x**2 + y**2 + z**2).astype(np.float32), 0)
/// >>> build(ball, rule="sampled").volume
/// 4169
#[pyclass(extends = Solid, frozen, module = "leafless")]
pub struct Volume {
    pub volume: Inner<'static>,
    /// True if the samples are booleans, which are stored as bytes.
    is_boolean: bool,
    axes_reversed: bool,
    pub threshold: Threshold,
}

/// A NumPy array that a volume reads.
struct Held<T> {
    /// Released when the interpreter is attached, now or later.
    _array: Py<PyAny>,
    start: *const T,
    length: usize,
}

// SAFETY: unchanging numbers can be read from any thread. Python manages the reference counts.
#[allow(unsafe_code)]
unsafe impl<T: Sync> Send for Held<T> {}
// SAFETY: as above.
#[allow(unsafe_code)]
unsafe impl<T: Sync> Sync for Held<T> {}

impl<T> AsRef<[T]> for Held<T> {
    fn as_ref(&self) -> &[T] {
        // SAFETY: the memory belongs to the array, which is kept alive. It is one contiguous piece. It is not
        // changed: the documentation of the class requires this.
        #[allow(unsafe_code)]
        unsafe {
            std::slice::from_raw_parts(self.start, self.length)
        }
    }
}

/// Returns the samples of an array in which x varies fastest.
fn held<'py, T: Element + Sync + Copy>(array: &Bound<'py, PyAny>) -> PyResult<SampleArray<'static, T>> {
    let array = array.cast::<PyArray3<T>>()?;
    let held = Held {
        _array: array.clone().into_any().unbind(),
        start: array.data().cast_const(),
        length: array.len(),
    };
    Ok(SampleArray::Shared(Arc::new(held)))
}

/// The least sample inside, and the greatest, if there is one.
pub type Threshold = (f64, Option<f64>);

/// Reads a threshold: one number, or a least and a greatest one.
pub fn threshold(given: &Bound<'_, PyAny>) -> PyResult<Threshold> {
    if let Ok(low) = given.extract::<f64>() {
        return Ok((low, None));
    }
    // The form that the property `threshold` returns.
    if let Ok(told) = given.extract::<(f64, Option<f64>)>() {
        return Ok(told);
    }
    match <[f64; 2]>::take(given, "threshold") {
        Ok([low, high]) => Ok((low, Some(high))),
        Err(error) if error.is_instance_of::<PyTypeError>(given.py()) => {
            Err(other_type(given, "threshold", "one number, or a least and a greatest one"))
        }
        Err(error) => Err(error),
    }
}

/// Returns the band of the values inside. A refusal shows the given argument, if the threshold was not read
/// from a file.
pub fn band(py: Python<'_>, threshold: Threshold, given: Option<&Bound<'_, PyAny>>) -> PyResult<Band> {
    let band = match threshold {
        (low, None) => Band::at_least(low),
        (f64::NEG_INFINITY, Some(high)) => Band::at_most(high),
        (low, Some(high)) => Band::between(low, high),
    };
    band.map_err(|_| {
        let found = given.map_or_else(|| format!("{threshold:?}"), |given| given.to_string());
        let problem = format!("must be a number, or a least and a greatest one, not {found}");
        refused(py, "threshold", problem)
    })
}

impl Volume {
    pub fn initial(
        volume: Inner<'static>,
        is_boolean: bool,
        axes_reversed: bool,
        threshold: Threshold,
    ) -> PyResult<PyClassInitializer<Volume>> {
        let own = volume.grid().frame().ok();
        let given = Given { own, ..Given::new(AnySolid::new(volume.clone())) };
        let volume = Volume { volume, is_boolean, axes_reversed, threshold };
        Ok(PyClassInitializer::from(Solid::new(given)).add_subclass(volume))
    }
}

#[pymethods]
impl Volume {
    #[new]
    #[pyo3(signature = (array, threshold=None, *, origin=None, spacing=None, order="xyz", **limits))]
    fn new(
        array: &Bound<'_, PyAny>,
        threshold: Option<&Bound<'_, PyAny>>,
        origin: Option<&Bound<'_, PyAny>>,
        spacing: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = named::order)] order: &str,
        limits: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<PyClassInitializer<Volume>> {
        let py = array.py();
        let limits = Limits::of(limits)?;
        let axes_reversed = match order {
            "xyz" => false,
            "zyx" => true,
            _ => return Err(refused(py, "order", format!("must be 'xyz' or 'zyx', not '{order}'"))),
        };
        let origin = origin.map_or(Ok([0.0; 3]), |origin| triple(origin, "origin"))?;
        let spacing = match spacing {
            None => [1.0; 3],
            Some(all) => all.extract::<f64>().map_or_else(|_| triple(all, "spacing"), |one| Ok([one; 3]))?,
        };
        let reading = from_package!(py, "leafless._exchange", "samples")?.call1((array, axes_reversed))?;
        let reading = reading.cast_into::<PyTuple>()?;
        let (array, kind): (Bound<'_, PyAny>, String) =
            (reading.get_item(0)?, reading.get_item(1)?.extract()?);
        let extents: [u32; 3] = reading.get_item(2)?.extract()?;
        let (samples, middle) = match &*kind {
            "bool" => (Samples::U8(held(&array)?), 0.5),
            "uint8" => (Samples::U8(held(&array)?), 127.5),
            "uint16" => (Samples::U16(held(&array)?), 32767.5),
            "int16" => (Samples::I16(held(&array)?), 0.0),
            "float32" => (Samples::F32(held(&array)?), 0.5),
            _ => {
                return Err(PyTypeError::new_err(format!(
                    "array: must hold bool, uint8, uint16, int16 or float32, not {kind}; astype(numpy.float32) rounds it"
                )));
            }
        };
        let told = threshold.map_or(Ok((middle, None)), self::threshold)?;
        let band = band(py, told, threshold)?;
        let names = [("corner", "origin"), ("extents", "array")];
        let grid = VoxelGrid::new(extents, origin, spacing).map_err(called(names)).or_raise(py)?;
        let volume = limits.run(py, |control| Inner::new(samples, &grid, band, control))?;
        Volume::initial(volume, kind == "bool", axes_reversed, told)
    }

    /// The samples, indexed as in the given array: a view of the memory that the volume reads.
    #[getter]
    fn array<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let own = slf.get();
        let mut extents = own.volume.grid().extents().map(|extent| extent as usize);
        if own.axes_reversed {
            extents.reverse();
        }
        let shape = || layout(extents, !own.axes_reversed);
        let owner = slf.as_any();
        match own.volume.samples() {
            Samples::U8(values) if own.is_boolean => {
                shown(owner, values.values(), shape())?.call_method1("view", ("bool",))
            }
            Samples::U8(values) => shown(owner, values.values(), shape()),
            Samples::U16(values) => shown(owner, values.values(), shape()),
            Samples::I16(values) => shown(owner, values.values(), shape()),
            Samples::F32(values) => shown(owner, values.values(), shape()),
            Samples::Bits(words) => {
                let (row, [x, y, z]) =
                    (own.volume.grid().words(), own.volume.grid().extents().map(|n| n as usize));
                let bits: Vec<bool> = slf.py().detach(|| {
                    let lines = words.values().chunks_exact(row).take(y * z);
                    lines.flat_map(|line| (0..x).map(move |i| line[i / 64] >> (i % 64) & 1 != 0)).collect()
                });
                let order = PyDict::new(slf.py());
                order.set_item("order", if own.axes_reversed { "C" } else { "F" })?;
                let flat = arrays::array(slf.py(), bits, &[x * y * z])?;
                flat.call_method("reshape", (extents.to_vec(),), Some(&order))
            }
        }
    }

    /// The lower corner of the first voxel.
    #[getter]
    fn origin(&self) -> (f64, f64, f64) {
        self.volume.grid().corner().into()
    }

    /// The edges of a voxel along x, y and z.
    #[getter]
    fn spacing(&self) -> (f64, f64, f64) {
        self.volume.grid().spacing().into()
    }

    /// The least sample inside, and the greatest one or `None`.
    #[getter]
    fn threshold(&self) -> (f64, Option<f64>) {
        self.threshold
    }

    /// The order of the indices of `array`: "xyz" or "zyx".
    #[getter]
    fn order(&self) -> &'static str {
        if self.axes_reversed { "zyx" } else { "xyz" }
    }

    /// A frame whose finest cells are the voxels, if the voxels are cubes.
    #[getter]
    fn frame(&self, py: Python<'_>) -> PyResult<Frame> {
        self.volume.grid().frame().or_raise(py).map(Frame)
    }

    /// Returns the same samples with another `threshold`, without reading them again.
    #[pyo3(signature = (threshold, **limits))]
    fn with_threshold(
        &self,
        threshold: &Bound<'_, PyAny>,
        limits: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Py<Volume>> {
        let py = threshold.py();
        let told = self::threshold(threshold)?;
        let band = band(py, told, Some(threshold))?;
        let volume = Limits::of(limits)?.run(py, |control| self.volume.with_band(band, control))?;
        Py::new(py, Volume::initial(volume, self.is_boolean, self.axes_reversed, told)?)
    }

    /// Returns the interpolated values at `points` (shape (n, 3)); NaN beyond the grid.
    fn values_at<'py>(&self, points: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let rows = arrays::Rows::of(points, "points")?;
        let list = rows.list();
        let value = |&point: &[f64; 3]| self.volume.value_at(point).unwrap_or(f64::NAN);
        let values: Vec<f64> = points.py().detach(|| list.iter().map(value).collect());
        let count = values.len();
        arrays::one_or_all(arrays::array(points.py(), values, &[count])?.into_any(), rows.is_one)
    }

    fn __repr__(&self) -> String {
        let [x, y, z] = self.volume.grid().extents();
        let told = match self.threshold {
            (low, None) => format!("at least {low}"),
            (low, Some(high)) => format!("{low} to {high}"),
        };
        format!("<Volume: {x} × {y} × {z} voxels, {told}>")
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let py = slf.py();
        let own = slf.get();
        let again = from_package!(py, "leafless._pickle", "volume")?;
        let arguments = (Volume::array(slf)?, own.threshold, own.origin(), own.spacing(), own.order());
        Ok((again, arguments.into_bound_py_any(py)?))
    }
}
