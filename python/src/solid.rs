//! The class of all solids, and the solid of an object.

use crate::callback;
use leafless::solid::Prepared;
use leafless::{AnySolid, Bounds, Frame as Inner, Solid as _};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::sync::{Arc, OnceLock};

/// A solid of the library, with facts about it.
#[derive(Clone)]
pub struct Given {
    /// The solid, prepared for the last frame of a query.
    pub shape: Prepared,
    /// A box that contains the solid, if one is known; computed once.
    pub known_bounds: Arc<OnceLock<Option<Bounds>>>,
    /// The frame of an octree, or of a volume's voxels.
    pub own: Option<Inner>,
    /// True if the cells of an octree keep surfaces.
    pub keeps_surfaces: bool,
    /// True if queries call Python functions.
    pub calls_python: bool,
}

impl Given {
    pub fn new(solid: AnySolid) -> Given {
        let own = solid.home();
        let (shape, known_bounds) = (Prepared::new(solid), Arc::default());
        Given { shape, known_bounds, own, keeps_surfaces: false, calls_python: false }
    }

    /// Returns a box that contains the solid, if one is known.
    pub fn bounds(&self, py: Python<'_>) -> Option<Bounds> {
        match self.known_bounds.get() {
            Some(&known) => known,
            None => py.detach(|| *self.known_bounds.get_or_init(|| self.shape.bounds())),
        }
    }

    /// Returns the solid itself.
    pub fn any(&self) -> &AnySolid {
        self.shape.solid()
    }
}

/// Anything that has a shape: `Csg`, `Mesh`, `Octree`, `Volume`, and subclasses of `Shape` of your own.
///
/// Operators combine any two solids: `a | b` (union), `a & b` (intersection), `a - b` (difference), `a ^ b`
/// (symmetric difference) and `~a` (complement). Two octrees give an octree, at once and exactly. Any other
/// pair gives an expression (`Csg`), which splits nothing before a query. `map @ a` is `a` moved by an
/// `Affine` or a matrix.
#[pyclass(subclass, frozen, weakref, module = "leafless")]
pub struct Solid {
    /// `None` for shapes written in Python: the object itself has the methods.
    given: Option<Given>,
}

impl Solid {
    pub fn new(given: Given) -> Solid {
        Solid { given: Some(given) }
    }

    /// Returns the base of a shape whose methods are written in Python.
    pub fn of_python() -> Solid {
        Solid { given: None }
    }
}

/// Returns whether an object is a solid.
pub fn is_solid(object: &Bound<'_, PyAny>) -> bool {
    object.cast::<Solid>().is_ok()
}

/// Returns the solid of an object.
pub fn given(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Given> {
    let Ok(solid) = object.cast::<Solid>() else {
        let kind = object.get_type().name()?;
        return Err(PyTypeError::new_err(format!(
            "{name}: must be a solid (Csg, Mesh, Octree, Volume, Shape), not {kind}"
        )));
    };
    match &solid.get().given {
        Some(given) => Ok(given.clone()),
        None => Ok(Given { calls_python: true, ..Given::new(callback::solid_of(object)?) }),
    }
}
