//! Intervals that contain the truth.

use crate::arguments::named;
use crate::arrays;
use crate::error::refused;
use crate::from_package;
use leafless::Interval as Bounds;
use pyo3::IntoPyObjectExt;
use pyo3::basic::CompareOp;
use pyo3::prelude::*;

/// An interval that is proven to contain the truth: two numbers, `lower` and `upper`.
///
/// An interval prints its significant digits. `in` tests whether a number is possible. A number format
/// applies to both ends, which are rounded outward, so the text contains the truth.
///
/// >>> volume = Interval(171000.0, 172000.0)
/// >>> volume
/// 171500 ± 510
/// >>> f"{Interval(0.123456, 0.123457):.3f}"
/// '0.123 to 0.124'
/// >>> 171234.5 in volume, volume.lower, volume.upper
/// (True, 171000.0, 172000.0)
///
/// `<`, `<=`, `>` and `>=` are true only if they hold for every number in the interval. So `volume < 2e5` is
/// a proof, and both `volume < 171500` and `volume > 171500` are false. `==` compares the ends of two
/// intervals; an interval equals no number.
///
/// >>> volume < 2e5, volume < 171500, volume > 171500
/// (True, False, False)
#[pyclass(frozen, weakref, from_py_object, module = "leafless")]
#[derive(Clone, Copy)]
pub struct Interval(pub Bounds);

#[pymethods]
impl Interval {
    /// Makes the interval from `lower` to `upper`. With one number the interval is that number.
    #[new]
    #[pyo3(signature = (lower, upper=None))]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = named::lower)] lower: f64,
        #[pyo3(from_py_with = named::upper)] upper: Option<f64>,
    ) -> PyResult<Interval> {
        if lower.is_nan() {
            return Err(refused(py, "lower", "must not be NaN"));
        }
        let upper = upper.unwrap_or(lower);
        let known = Bounds::new(lower, upper);
        known.map(Interval).ok_or_else(|| {
            refused(py, "upper", format!("must be a number that is not below lower, {lower}, not {upper}"))
        })
    }

    /// The lower end: no smaller number is possible.
    #[getter]
    fn lower(&self) -> f64 {
        self.0.lower
    }

    /// The upper end: no greater number is possible.
    #[getter]
    fn upper(&self) -> f64 {
        self.0.upper
    }

    /// The width: upper minus lower.
    #[getter]
    fn width(&self) -> f64 {
        self.0.width()
    }

    /// The midpoint.
    #[getter]
    fn middle(&self) -> f64 {
        0.5 * self.0.lower + 0.5 * self.0.upper
    }

    fn __contains__(&self, value: f64) -> bool {
        self.0.contains(value)
    }

    /// Iterates over lower and upper, so that `low, high = interval` works.
    fn __iter__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let ends = (slf.get().0.lower, slf.get().0.upper).into_pyobject(slf.py())?;
        ends.call_method0("__iter__")
    }

    fn __richcmp__(&self, other: &Bound<'_, PyAny>, order: CompareOp) -> PyResult<Py<PyAny>> {
        let py = other.py();
        let own = self.0;
        let answer = if let Ok(other) = other.cast::<Interval>() {
            let other = other.get().0;
            match order {
                CompareOp::Eq => own == other,
                CompareOp::Ne => own != other,
                CompareOp::Lt => own.upper < other.lower,
                CompareOp::Le => own.upper <= other.lower,
                CompareOp::Gt => own.lower > other.upper,
                CompareOp::Ge => own.lower >= other.upper,
            }
        } else if let Ok(value) = other.extract::<f64>() {
            match order {
                CompareOp::Eq | CompareOp::Ne => return Ok(py.NotImplemented()),
                CompareOp::Lt => own.upper < value,
                CompareOp::Le => own.upper <= value,
                CompareOp::Gt => own.lower > value,
                CompareOp::Ge => own.lower >= value,
            }
        } else {
            return Ok(py.NotImplemented());
        };
        Ok(answer.into_pyobject(py)?.to_owned().into_any().unbind())
    }

    fn __hash__(&self) -> u64 {
        (self.0.lower + 0.0).to_bits() ^ (self.0.upper + 0.0).to_bits().rotate_left(32)
    }

    fn __repr__(&self) -> String {
        self.0.to_string()
    }

    /// Formats both ends like numbers, as in `f"{volume:.3f}"`: the lower end is rounded down, the upper end
    /// up.
    fn __format__<'py>(&self, py: Python<'py>, spec: &str) -> PyResult<Bound<'py, PyAny>> {
        if spec.is_empty() {
            return self.0.to_string().into_bound_py_any(py);
        }
        from_package!(py, "leafless._format", "outward")?.call1((self.0.lower, self.0.upper, spec))
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> PyResult<(Py<PyAny>, (f64, f64))> {
        Ok((slf.get_type().into_any().unbind(), (slf.get().0.lower, slf.get().0.upper)))
    }
}

/// Returns an array of intervals as an object of the package's class `Intervals`.
pub fn intervals<'py>(
    py: Python<'py>,
    all: impl IntoIterator<Item = Bounds> + Send,
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    let (lower, upper) =
        py.detach(|| all.into_iter().map(|interval| (interval.lower, interval.upper)).unzip());
    let ends = (arrays::array::<f64>(py, lower, shape)?, arrays::array::<f64>(py, upper, shape)?);
    from_package!(py, "leafless._intervals", "Intervals")?.call1(ends)
}
