//! Affine maps: the placements of solids.

use crate::arguments::named;
use crate::arrays::{self, doubles, triple};
use crate::error::{OrRaise, called, refused};
use crate::solid::is_solid;
use leafless::Affine as Inner;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

/// An affine map of space, which moves, turns or scales. It is made of a `matrix` of 3×4 or 4×4 numbers,
/// which are used unchanged.
///
/// `map @ solid` is the solid moved by the map. `first @ second` is the map that applies `second`, and then
/// `first`. Wherever a placement is expected, any matrix of NumPy is accepted. `numpy.asarray` returns the
/// 4×4 matrix of a map.
///
/// >>> turned = Affine.translation([10, 0, 0]) @ Affine.rotation([0, 0, 1], 90)
/// >>> turned([1, 0, 0])
/// array([10.,  1.,  0.])
///
/// Quarter turns are exact:
///
/// >>> Affine.rotation([0, 0, 1], 90).matrix[0]
/// array([ 0., -1.,  0.,  0.])
#[pyclass(frozen, eq, weakref, from_py_object, module = "leafless")]
#[derive(Clone, Copy, PartialEq)]
pub struct Affine(pub Inner);

#[pymethods]
impl Affine {
    /// Makes NumPy's operators defer to this class.
    #[classattr]
    #[allow(non_upper_case_globals)]
    const __array_ufunc__: Option<u8> = None;

    /// Makes the map of a `matrix` of 3×4 numbers, [M | t], or of 4×4 numbers.
    #[new]
    fn new(matrix: &Bound<'_, PyAny>) -> PyResult<Affine> {
        affine(matrix, "matrix").map(Affine)
    }

    /// Returns the identity map.
    #[staticmethod]
    fn identity() -> Affine {
        Affine(Inner::IDENTITY)
    }

    /// Returns the translation by `offset`, three numbers (model units).
    #[staticmethod]
    fn translation(offset: &Bound<'_, PyAny>) -> PyResult<Affine> {
        let found = Inner::translation(triple(offset, "offset")?).map_err(called([("placement", "offset")]));
        found.or_raise(offset.py()).map(Affine)
    }

    /// Returns the rotation by `degrees` around an `axis` through the origin, or through the point `about`.
    /// It turns counter-clockwise as seen from the tip of the axis. The axis may have any length except 0.
    #[staticmethod]
    #[pyo3(signature = (axis, degrees, about=None))]
    fn rotation(
        axis: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = named::degrees)] degrees: f64,
        about: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Affine> {
        let py = axis.py();
        let direction = triple(axis, "axis")?;
        let length = direction.iter().map(|c| c * c).sum::<f64>().sqrt();
        if !(length > 0.0 && length.is_finite()) {
            let problem = format!("must be finite numbers that are not all zero, not {direction:?}");
            return Err(refused(py, "axis", problem));
        }
        if !degrees.is_finite() {
            return Err(refused(py, "degrees", format!("must be a finite number, not {degrees}")));
        }
        let [x, y, z] = direction.map(|c| c / length);
        let (sin, cos) = quarter(degrees);
        let rest = 1.0 - cos;
        let turn = [
            [x * x * rest + cos, x * y * rest - z * sin, x * z * rest + y * sin],
            [y * x * rest + z * sin, y * y * rest + cos, y * z * rest - x * sin],
            [z * x * rest - y * sin, z * y * rest + x * sin, z * z * rest + cos],
        ];
        let at = match about {
            Some(about) => triple(about, "about")?,
            None => [0.0; 3],
        };
        let rows = turn.map(|row| {
            let moved: f64 = (0..3).map(|k| row[k] * at[k]).sum();
            [row[0], row[1], row[2], moved]
        });
        let rows = [0, 1, 2].map(|i| {
            let [a, b, c, moved] = rows[i];
            // Entries that consist of rounding alone become zero.
            [a, b, c, at[i] - moved].map(|entry: f64| if entry.abs() < 1e-18 { 0.0 } else { entry })
        });
        Inner::new(rows).map_err(called([("placement", "about")])).or_raise(py).map(Affine)
    }

    /// Returns the scaling by a `factor`, or by three factors, one for each axis. A negative factor mirrors.
    #[staticmethod]
    fn scale(factor: &Bound<'_, PyAny>) -> PyResult<Affine> {
        let factors = match factor.extract::<f64>() {
            Ok(factor) => [factor; 3],
            Err(_) => triple(factor, "factor")?,
        };
        if factors.contains(&0.0) {
            return Err(refused(factor.py(), "factor", "must not be 0, which leaves nothing of a solid"));
        }
        let [x, y, z] = factors;
        let rows = [[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0]];
        Inner::new(rows).map_err(called([("placement", "factor")])).or_raise(factor.py()).map(Affine)
    }

    /// The 4×4 matrix.
    #[getter]
    fn matrix<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let [a, b, c] = *self.0.rows();
        Ok(arrays::rows(py, vec![a, b, c, [0.0, 0.0, 0.0, 1.0]])?.into_any())
    }

    /// Returns the inverse map, rounded.
    fn inverse(&self, py: Python<'_>) -> PyResult<Affine> {
        self.0.inverse().or_raise(py).map(Affine)
    }

    /// Returns the images of `points` of shape (n, 3), or of a single point of shape (3,).
    fn __call__<'py>(&self, points: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let rows = arrays::Rows::of(points, "points")?;
        let list = rows.list();
        let moved = points.py().detach(|| list.iter().map(|&point| self.0.apply(point)).collect());
        arrays::one_or_all(arrays::rows(points.py(), moved)?.into_any(), rows.is_one)
    }

    fn __matmul__<'py>(&self, other: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        if is_solid(other) {
            return other.call_method1("placed", (*self,));
        }
        composed(other, |other| after(&self.0, other))
    }

    fn __rmatmul__<'py>(&self, other: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        composed(other, |other| after(other, &self.0))
    }

    /// Returns the 4×4 matrix, for `numpy.asarray`.
    #[pyo3(signature = (dtype=None, copy=None))]
    fn __array__<'py>(
        &self,
        py: Python<'py>,
        dtype: Option<&Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if copy == Some(false) {
            return Err(PyValueError::new_err("the matrix of an Affine is always a copy"));
        }
        let matrix = self.matrix(py)?;
        dtype.map_or(Ok(matrix.clone()), |dtype| matrix.call_method1("astype", (dtype,)))
    }

    fn __repr__(&self) -> String {
        format!("Affine({:?})", self.0.rows())
    }

    fn __hash__(&self) -> u64 {
        self.0.rows().iter().flatten().fold(0, |hash: u64, x| hash.rotate_left(13) ^ x.to_bits())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyAny>,))> {
        Ok((slf.get_type().into_any(), (slf.get().matrix(slf.py())?,)))
    }
}

/// Composes a map with another operand, which must be a map or an array.
fn composed<'py>(
    other: &Bound<'py, PyAny>,
    compose: impl FnOnce(&Inner) -> Result<Inner, leafless::Error>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = other.py();
    let is_array =
        other.hasattr("__array__")? || other.is_instance_of::<PyList>() || other.is_instance_of::<PyTuple>();
    if !is_array {
        return Ok(py.NotImplemented().into_bound(py));
    }
    let whole = compose(&affine(other, "placement")?).or_raise(py)?;
    Ok(Affine(whole).into_pyobject(py)?.into_any())
}

/// Returns the sine and the cosine of an angle in degrees, exact for quarter turns.
fn quarter(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => degrees.to_radians().sin_cos(),
    }
}

/// Returns the map that applies `first`, and then `second`; rounded.
pub fn after(second: &Inner, first: &Inner) -> Result<Inner, leafless::Error> {
    let (a, b) = (second.rows(), first.rows());
    Inner::new([0, 1, 2].map(|i| {
        [0, 1, 2, 3].map(|j| {
            let sum: f64 = (0..3).map(|k| a[i][k] * b[k][j]).sum();
            if j == 3 { sum + a[i][3] } else { sum }
        })
    }))
}

/// Reads a map from an object of this class or from a matrix.
pub fn affine(given: &Bound<'_, PyAny>, name: &'static str) -> PyResult<Inner> {
    if let Ok(known) = given.cast::<Affine>() {
        return Ok(known.get().0);
    }
    let array = doubles(given, name)?;
    match many(&array, name)?.as_slice() {
        &[one] if numpy::PyUntypedArrayMethods::ndim(&array) == 2 => Ok(one),
        _ => Err(refused(given.py(), name, "must be one matrix")),
    }
}

/// Reads maps from one matrix, from an array of shape (n, 4, 4) or (n, 3, 4), or from a list of maps and
/// matrices.
pub fn affines(given: &Bound<'_, PyAny>, name: &'static str) -> PyResult<Vec<Inner>> {
    if given.cast::<Affine>().is_ok() {
        return Ok(vec![affine(given, name)?]);
    }
    if given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>() {
        let list = given.try_iter()?.collect::<PyResult<Vec<_>>>()?;
        if list.iter().any(|one| one.is_instance_of::<Affine>()) {
            return list.iter().map(|one| affine(one, name)).collect();
        }
    }
    let array = doubles(given, name)?;
    if numpy::PyUntypedArrayMethods::len(&array) == 0 {
        return Ok(Vec::new());
    }
    many(&array, name)
}

fn many(array: &Bound<'_, numpy::PyArrayDyn<f64>>, name: &'static str) -> PyResult<Vec<Inner>> {
    use numpy::{PyArrayMethods, PyUntypedArrayMethods};
    let py = array.py();
    let high = match *array.shape() {
        [high @ (3 | 4), 4] | [_, high @ (3 | 4), 4] => high,
        ref shape => {
            return Err(refused(
                py,
                name,
                format!(
                    "must be a matrix of 3×4 or 4×4 numbers, not of the shape {}",
                    arrays::shape_text(shape)
                ),
            ));
        }
    };
    let numbers = array.readonly();
    let numbers = numbers.as_slice()?;
    let one = |matrix: &[f64]| {
        if high == 4 && matrix[12..] != [0.0, 0.0, 0.0, 1.0] {
            return Err(refused(py, name, "the last row of a 4×4 matrix must be 0, 0, 0, 1"));
        }
        let row = |i: usize| [0, 1, 2, 3].map(|j| matrix[4 * i + j]);
        Inner::new([row(0), row(1), row(2)]).map_err(called([("placement", name)])).or_raise(py)
    };
    numbers.chunks_exact(4 * high).map(one).collect()
}
