//! Set operations and placements of all kinds of solids.

use crate::affine::affine;
use crate::csg::{Csg, expression};
use crate::error::OrRaise;
use crate::mesh::Mesh;
use crate::octree::Octree;
use crate::solid::{Solid, is_solid};
use crate::work::Limits;
use leafless::{Csg as Expression, complement as complement_of, difference, intersection, union, xor};
use pyo3::prelude::*;

/// A set operation on two solids.
#[derive(Clone, Copy)]
pub enum Operator {
    Union,
    Intersection,
    Difference,
    Xor,
}

/// Combines two solids. Two octrees give an octree; any other pair gives an expression.
pub fn combined<'py>(
    operator: Operator,
    a: &Bound<'py, Solid>,
    b: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = a.py();
    if !is_solid(b) {
        return Ok(py.NotImplemented().into_bound(py));
    }
    if let (Ok(a), Ok(b)) = (a.cast::<Octree>(), b.cast::<Octree>()) {
        let (a, b) = (a.get().octree.view(), b.get().octree.view());
        let combine = match operator {
            Operator::Union => union,
            Operator::Intersection => intersection,
            Operator::Difference => difference,
            Operator::Xor => xor,
        };
        let found = Limits::default().run(py, |control| combine(a, b, control))?;
        return Ok(Octree::bound(py, found)?.into_any());
    }
    let parts = [expression(a, "self")?, expression(b, "other")?];
    let (name, whole) = match operator {
        Operator::Union => ("union_of", Expression::union_of(parts)),
        Operator::Intersection => ("intersection_of", Expression::intersection_of(parts)),
        Operator::Difference => ("difference_of", parts[0].difference(&parts[1])),
        Operator::Xor => ("xor_of", Expression::xor_of(parts)),
    };
    Ok(Csg::made(py, whole.or_raise(py)?, name, (a, b))?.into_any())
}

/// Returns the complement of a solid. The complement of an octree is an octree.
pub fn complement<'py>(solid: &Bound<'py, Solid>) -> PyResult<Bound<'py, PyAny>> {
    let py = solid.py();
    if let Ok(own) = solid.cast::<Octree>() {
        let view = own.get().octree.view();
        let found = Limits::default().run(py, |control| complement_of(view, control))?;
        return Ok(Octree::bound(py, found)?.into_any());
    }
    let whole = expression(solid, "self")?.complement();
    Ok(Csg::made(py, whole, "complement_of", (solid,))?.into_any())
}

/// Moves a solid. A mesh stays a mesh; any other solid becomes an expression.
pub fn placed<'py>(solid: &Bound<'py, Solid>, placement: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let py = solid.py();
    let map = affine(placement, "placement")?;
    if let Ok(mesh) = solid.cast::<Mesh>() {
        return Ok(mesh.get().placed(py, &map)?.into_any());
    }
    let own = expression(solid, "self")?;
    let whole = py.detach(|| own.placed(&map)).or_raise(py)?;
    Ok(Csg::made(py, whole, "placed_of", (solid, crate::affine::Affine(map)))?.into_any())
}
