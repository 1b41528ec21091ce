//! Channels: values inside solids.

use crate::arguments::{Depth, named, other_type};
use crate::arrays;
use crate::ask::{FrameLike, Wish};
use crate::error::{OrRaise, called, carried, refused};
use crate::frame::{CORNERS, Frame, corners};
use crate::interval::{Interval, intervals};
use crate::octree::Octree;
use crate::solid::given;
use crate::volume::Volume;
use crate::work::Limits;
use leafless::attribute::{
    Attribute, Channel as Inner, ConstantAttribute, Detail, FillOptions, Interpolation, ScalarType,
    ValueType, VolumeAttribute, fill_channel,
};
use leafless::{Bounds, Error};
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Values inside a solid (a temperature, a colour, a material). A channel is a tree of its own, in which
/// equal neighbours share one value.
///
/// >>> part = build(Csg.cuboid([0, 0, 0], [8, 8, 8]), Frame([0, 0, 0], 8, 3))
/// >>> heat = Channel.fill(lambda points: 20 + 3 * points[:, 2], part)
/// >>> part = part.with_channel("heat", heat)
/// >>> part.channel("heat").values_at([[1.5, 1.5, 1.5]])
/// array([24.5])
#[pyclass(frozen, weakref, module = "leafless")]
pub struct Channel(pub Inner);

/// The library's names of the parameter `values`.
const NAMES: [(&str, &str); 3] = [("value", "values"), ("components", "values"), ("attribute", "values")];

/// The default depth of cells with values.
const DEPTH: u8 = 8;

/// A Python function that returns values at points.
struct Function {
    function: Py<PyAny>,
    components: usize,
}

impl Attribute for Function {
    fn components(&self) -> usize {
        self.components
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        let found = Python::attach(|py| {
            let points = arrays::rows(py, points.to_vec())?;
            read(&self.function.bind(py).call1((points,))?, values.len())
        });
        let (found, components) = found.map_err(carried)?;
        if components != self.components {
            let problem = format!("values: {components} numbers a point, and {} before", self.components);
            return Err(carried(PyValueError::new_err(problem)));
        }
        for (value, found) in values.iter_mut().zip(found.chunks_exact(components)) {
            let mut numbers = [0.0; 4];
            numbers[..components].copy_from_slice(found);
            *value = (!found.iter().any(|number| number.is_nan())).then_some(numbers);
        }
        Ok(())
    }
}

/// Reads values at points, and the number of components of each.
fn read(found: &Bound<'_, PyAny>, count: usize) -> PyResult<(Vec<f64>, usize)> {
    let array: Bound<'_, PyArrayDyn<f64>> = arrays::doubles(found, "values")?;
    let components = match *array.shape() {
        [n] if n == count => 1,
        [n, components @ 1..=4] if n == count => components,
        ref shape => {
            return Err(PyValueError::new_err(format!(
                "values: must return an array of the shape ({count},) or ({count}, m) with 1 to 4 numbers, not {shape:?}"
            )));
        }
    };
    Ok((array.readonly().as_slice()?.to_vec(), components))
}

#[pymethods]
impl Channel {
    /// Makes a channel of `values`: the values of a function, the samples of a `Volume`, or one value
    /// everywhere (1 to 4 numbers).
    ///
    /// A function gets points (shape (n, 3)) and returns values of shape (n,) or (n, components), NaN where
    /// there is none. It is called once at the lower corner of the frame, to find the number of components.
    /// Then it is called at the centres of cells that belong to the solid.
    ///
    /// A `Volume` is interpolated between its samples. With `nearest=True` the value is the nearest sample,
    /// as labels require.
    ///
    /// `solid` is the octree inside which the channel has values. `frame` is a `Frame`, or an octree on that
    /// frame. The default is the frame of the solid; without a solid, `frame` is required. `depth` replaces
    /// the depth of the frame. `cell` (model units) is the edge at which cells end, for any values. `dtype`
    /// is the type in which numbers are stored: "uint8", "uint16", "uint32" or "float32".
    #[staticmethod]
    #[pyo3(signature = (values, solid=None, *, frame=None, depth=None, cell=None, dtype="float32", nearest=false, **limits))]
    #[allow(clippy::too_many_arguments)]
    fn fill(
        values: &Bound<'_, PyAny>,
        solid: Option<&Bound<'_, PyAny>>,
        frame: Option<FrameLike>,
        #[pyo3(from_py_with = named::depth)] depth: Option<Depth>,
        #[pyo3(from_py_with = named::cell)] cell: Option<f64>,
        #[pyo3(from_py_with = named::dtype)] dtype: &str,
        #[pyo3(from_py_with = named::nearest)] nearest: bool,
        limits: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Channel> {
        let py = values.py();
        let limits = Limits::of(limits)?;
        let octree = match solid {
            None => None,
            Some(solid) => match solid.cast::<Octree>() {
                Ok(octree) => Some(octree.get().octree.clone()),
                Err(_) => return Err(other_type(solid, "solid", "an Octree, which build makes of a solid")),
            },
        };
        let wish = Wish { frame, depth };
        let frame = match solid {
            Some(solid) => wish.of(py, &given(solid, "solid")?, DEPTH)?,
            None => wish.alone(py)?,
        };
        let scalars = [ScalarType::U8, ScalarType::U16, ScalarType::U32, ScalarType::F32];
        let names = ["uint8", "uint16", "uint32", "float32"];
        let Some(scalar) = names.iter().position(|name| *name == dtype).map(|i| scalars[i]) else {
            return Err(refused(
                py,
                "dtype",
                format!("must be one of '{}', not '{dtype}'", names.join("', '")),
            ));
        };
        let attribute: Box<dyn Attribute + Send> = if let Ok(volume) = values.cast::<Volume>() {
            let way = if nearest { Interpolation::Nearest } else { Interpolation::Trilinear };
            Box::new(VolumeAttribute::new(volume.get().volume.clone(), way))
        } else if values.is_callable() {
            // The number of components follows from the value at a first point.
            let probe = arrays::rows(py, vec![Bounds::of(&frame).min])?;
            let (_, components) = read(&values.call1((probe,))?, 1)?;
            Box::new(Function { function: values.clone().unbind(), components })
        } else {
            let value = arrays::doubles(values, "values")?;
            if !matches!(value.shape(), [] | [1..=4]) {
                let shape = arrays::shape_text(value.shape());
                let problem =
                    format!("must be 1 to 4 numbers, a function or a Volume, not of the shape {shape}");
                return Err(refused(py, "values", problem));
            }
            let value = value.readonly();
            Box::new(ConstantAttribute::new(value.as_slice()?).map_err(called(NAMES)).or_raise(py)?)
        };
        let value_type = ValueType::new(scalar, attribute.components() as u8).or_raise(py)?;
        let detail = cell.map(Detail::uniform).transpose();
        let detail = detail.map_err(|_| refused(py, "cell", "must be a positive number"))?;
        let channel = limits.run(py, |control| {
            let solid = octree.as_ref().map(|octree| octree.view());
            let options = FillOptions { value_type, frame, solid, detail };
            fill_channel(&*attribute, &options, control).map_err(called(NAMES))
        })?;
        Ok(Channel(channel))
    }

    /// The name in the octree; empty if no octree has the channel.
    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    /// The frame of the channel.
    #[getter]
    fn frame(&self) -> Frame {
        Frame(*self.0.frame())
    }

    /// The number of components of a value.
    #[getter]
    fn components(&self) -> usize {
        self.0.value_type().components()
    }

    /// The size in memory (bytes).
    #[getter]
    fn nbytes(&self) -> u64 {
        self.0.bytes()
    }

    /// Returns the values at `points` (shape (n, 3)): shape (n,) for one component, else (n, components). The
    /// value is NaN where there is none.
    fn values_at<'py>(&self, points: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let py = points.py();
        let rows = arrays::Rows::of(points, "points")?;
        let list = rows.list();
        let view = self.0.view().or_raise(py)?;
        let components = self.components();
        let numbers = py.detach(|| {
            let mut found = vec![None; list.len()];
            view.values_at(list, &mut found);
            found
                .iter()
                .flat_map(|value| value.unwrap_or([f64::NAN; 4]).into_iter().take(components))
                .collect()
        });
        let shape = if components == 1 { vec![list.len()] } else { vec![list.len(), components] };
        arrays::one_or_all(arrays::array(py, numbers, &shape)?.into_any(), rows.is_one)
    }

    /// Summarises the values inside `solid` (an octree), inside `bounds` (a lower and an upper corner), or
    /// all values. Returns a dictionary of arrays and intervals with the least and the greatest value, the
    /// mean and the integral; `None` if nothing has a value.
    #[pyo3(signature = (solid=None, *, bounds=None, **limits))]
    fn summary<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = named::solid)] solid: Option<Bound<'py, Octree>>,
        bounds: Option<&Bound<'py, PyAny>>,
        limits: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        let limits = Limits::of(limits)?;
        let bounds = match bounds {
            None => None,
            Some(bounds) => {
                let [min, max] = corners(bounds, "bounds")?;
                Some(Bounds { min, max })
            }
        };
        let (view, solid) =
            (self.0.view().or_raise(py)?, solid.as_ref().map(|solid| solid.get().octree.view()));
        let found = limits
            .run(py, |control| view.summary(solid, bounds.as_ref(), control).map_err(called(CORNERS)))?;
        let Some(found) = found else { return Ok(None) };
        let count = self.components();
        let numbers = |all: [f64; 4]| arrays::array(py, all[..count].to_vec(), &[count]);
        let told = PyDict::new(py);
        told.set_item("least", numbers(found.least)?)?;
        told.set_item("greatest", numbers(found.greatest)?)?;
        told.set_item("mean", intervals(py, found.mean[..count].iter().copied(), &[count])?)?;
        told.set_item("integral", intervals(py, found.integral[..count].iter().copied(), &[count])?)?;
        told.set_item("volume", Interval(found.volume))?;
        told.set_item("volume_without", Interval(found.volume_without))?;
        Ok(Some(told))
    }

    fn __repr__(&self) -> String {
        let kind = self.0.value_type();
        format!(
            "<Channel: {} × {}, {} values>",
            kind.components(),
            kind.scalar().name(),
            self.0.value_count()
        )
    }

    fn __reduce__(&self) -> PyResult<()> {
        Err(pyo3::exceptions::PyTypeError::new_err("a Channel is pickled with the octree that has it"))
    }
}
