//! The class of octrees, and what its cells prove.

use crate::arguments::named;
use crate::error::OrRaise;
use crate::interval::Interval;
use crate::solid::{Given, Solid};
use leafless::octree::{LevelStatistics, Statistics};
use leafless::{AnySolid, Octree as Inner};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// The default depth of an octree.
pub const DEPTH: u8 = 9;

/// The proof that the cells of an octree give: FULL cells are proven to lie inside (`full`), and EMPTY cells
/// outside (`empty`). The proof is about a solid whose surfaces were moved before by at most `displacement`
/// (model units).
#[pyclass(frozen, eq, get_all, weakref, from_py_object, module = "leafless")]
#[derive(Clone, Copy, PartialEq)]
pub struct Proof {
    /// True if FULL cells are proven to lie inside.
    full: bool,
    /// True if EMPTY cells are proven to lie outside.
    empty: bool,
    /// The maximum distance that surfaces were moved before (model units).
    displacement: f64,
}

#[pymethods]
impl Proof {
    /// Makes a proof, as `octree.proof` returns it.
    #[new]
    #[pyo3(signature = (full, empty, displacement=0.0))]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = named::full)] full: bool,
        #[pyo3(from_py_with = named::empty)] empty: bool,
        #[pyo3(from_py_with = named::displacement)] displacement: f64,
    ) -> PyResult<Proof> {
        leafless::Proof::new(full, empty).with_displacement(displacement).or_raise(py).map(Proof::from)
    }

    fn __bool__(&self) -> bool {
        self.full && self.empty
    }

    fn __repr__(&self) -> String {
        let word = |yes: bool| if yes { "True" } else { "False" };
        let (full, empty) = (word(self.full), word(self.empty));
        format!("Proof(full={full}, empty={empty}, displacement={:?})", self.displacement)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let Proof { full, empty, displacement } = *slf.get();
        Ok((slf.get_type().into_any(), (full, empty, displacement).into_bound_py_any(slf.py())?))
    }
}

impl From<leafless::Proof> for Proof {
    fn from(proof: leafless::Proof) -> Proof {
        Proof { full: proof.full, empty: proof.empty, displacement: proof.displacement() }
    }
}

impl Proof {
    /// Converts to the library's type.
    pub fn inner(self) -> Result<leafless::Proof, leafless::Error> {
        leafless::Proof::new(self.full, self.empty).with_displacement(self.displacement)
    }
}

/// A stored solid. Each cell of a cube is EMPTY (outside), FULL (inside) or PARTIAL (undecided). Only split
/// cells take memory.
///
/// >>> octree = build(Csg.ball([0, 0, 0], 1), depth=6)
/// >>> octree.contains([[0, 0, 0], [2, 0, 0]])
/// array([1, 0], dtype=uint8)
/// >>> 4.18879 in octree.volume
/// True
///
/// The methods `contains`, `distances` and `rays` answer from the cells, without regard to proofs. Functions
/// (`measure`, `interference` and the others) use only proofs about the source solid. A rule other than
/// "certified" proves little. `as_truth` makes the cells themselves the truth.
///
/// On one frame, `|`, `&`, `-`, `^` and `~` are exact set algebra of cells: `a - b == a & ~b` holds bit by
/// bit.
#[pyclass(extends = Solid, frozen, module = "leafless")]
pub struct Octree {
    pub octree: Inner,
    /// The mapped file, with the checksum of its header.
    pub mapped: Option<(PathBuf, u64)>,
}

impl Octree {
    pub fn bound(py: Python<'_>, octree: Inner) -> PyResult<Bound<'_, Octree>> {
        Octree::of_file(py, octree, None)
    }

    pub fn of_file(
        py: Python<'_>,
        octree: Inner,
        mapped: Option<(PathBuf, u64)>,
    ) -> PyResult<Bound<'_, Octree>> {
        let keeps_surfaces = octree.view().cuts().is_some();
        let given = Given { keeps_surfaces, ..Given::new(AnySolid::new(octree.clone())) };
        Bound::new(py, PyClassInitializer::from(Solid::new(given)).add_subclass(Octree { octree, mapped }))
    }
}

/// Converts statistics to a list of dictionaries, level by level.
pub fn told<'py>(py: Python<'py>, statistics: &Statistics) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let level = |level: &LevelStatistics| {
        let told = PyDict::new(py);
        told.set_item("level", level.level)?;
        let counts = [
            ("nodes", level.nodes),
            ("empty", level.empty),
            ("full", level.full),
            ("partial", level.partial),
        ];
        for (name, count) in counts {
            told.set_item(name, count)?;
        }
        told.set_item("volume", Interval(level.volume))?;
        Ok(told)
    };
    statistics.levels().iter().map(level).collect()
}
