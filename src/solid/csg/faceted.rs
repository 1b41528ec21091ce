//! Named primitives with plane faces.

use super::figure::polygon::{Term, monotone_formula};
use super::primitive::{heights, slab};
use super::{Csg, HalfSpace, support};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::Dyadic;
use crate::lattice::valid::length;
use crate::memory;
use alloc::vec::Vec;

/// Returns the half-space over the half-plane a x + b y + c ≥ 0.
fn upright_plane(a: Dyadic, b: Dyadic, c: Dyadic) -> HalfSpace {
    HalfSpace::linear([a, b, Dyadic::zero(), c])
}

impl Csg {
    /// Returns the right angular wedge: the box between the origin and `size` (model units) whose face at y =
    /// `size[1]` is narrowed, or widened, to 0 ≤ x ≤ `top`. With `top` = 0, that face is an edge. (STEP, ISO
    /// 10303-42, defines the wedge in this way, and calls `top` `ltx`.)
    ///
    /// # Errors
    /// [`Error::Argument`] if a size is not between 2^-256 and 2^256, or `top` is neither 0 nor in that
    /// range.
    pub fn wedge(size: [f64; 3], top: f64) -> Result<Csg, Error> {
        for extent in size {
            length("size", extent)?;
        }
        if top != 0.0 {
            length("top", top)?;
        }
        // x ≤ dx + (top − dx) y / dy.
        let [dx, dy, end] = [size[0], size[1], top].each(Dyadic::new);
        let slanted = upright_plane(-&dy, &end - &dx, &dx * &dy);
        let [front, _] = slab(0, 0.0, size[0]);
        let sides = [1, 2].into_iter().flat_map(|axis| slab(axis, 0.0, size[axis]));
        let parts = Csg::intersection_of([front, slanted.into()].into_iter().chain(sides))?;
        Ok(parts.within([0.0; 3], [size[0].max(top), size[1], size[2]]))
    }

    /// Returns the prism over a simple polygon in the xy plane, between z = `low` and z = `high` (model
    /// units). The polygon's corners are given in order, in either direction of rotation; the last corner is
    /// joined to the first. The planes through its edges are exact.
    ///
    /// O(n log² n) time for n corners.
    ///
    /// # Errors
    /// [`Error::Argument`] if the outline touches or crosses itself or encloses nothing, if a coordinate is
    /// neither zero nor of a magnitude between 2^-256 and 2^256, or if `low` is not less than `high`;
    /// [`Error::OutOfMemory`].
    pub fn prism(polygon: &[[f64; 2]], low: f64, high: f64) -> Result<Csg, Error> {
        heights(low, high)?;
        let (mut min, mut max) =
            ([f64::INFINITY, f64::INFINITY, low], [f64::NEG_INFINITY, f64::NEG_INFINITY, high]);
        for corner in polygon {
            for axis in 0..2 {
                (min[axis], max[axis]) = (min[axis].min(corner[axis]), max[axis].max(corner[axis]));
            }
        }
        let [bottom, top] = slab(2, low, high);
        Ok(Csg::intersection_of([Csg::column(polygon)?, bottom, top])?.within(min, max))
    }

    /// Returns the prism without ends.
    pub(super) fn column(polygon: &[[f64; 2]]) -> Result<Csg, Error> {
        let mut operands: Vec<Csg> = Vec::new();
        for term in monotone_formula(polygon)? {
            let operand = match term {
                Term::Edge([from, to]) => {
                    let [[ax, ay], [bx, by]] = [from, to].each(|i| polygon[i].each(Dyadic::new));
                    let (along_x, along_y) = (&bx - &ax, &by - &ay);
                    let offset = &(&along_y * &ax) - &(&along_x * &ay);
                    upright_plane(-&along_y, along_x, offset).into()
                }
                Term::All(count) => Csg::intersection_of(operands.drain(operands.len() - count..))?,
                Term::Any(count) => Csg::union_of(operands.drain(operands.len() - count..))?,
            };
            memory::push(&mut operands, operand)?;
        }
        Ok(operands.pop().unwrap_or_else(Csg::empty))
    }

    /// Returns the convex polyhedron of the points p with `normal` · p + `offset` ≥ 0 for all `planes`
    /// (normal, offset). The normals, of any length, point inward. The polyhedron may be unbounded, or empty;
    /// then it has no [`bounds`](crate::Solid::bounds). O(planes).
    ///
    /// # Errors
    /// [`Error::Argument`] if there is no plane; errors as [`HalfSpace::plane`]; [`Error::OutOfMemory`].
    pub fn convex(planes: &[([f64; 3], f64)]) -> Result<Csg, Error> {
        if planes.is_empty() {
            return Err(Error::Argument { name: "planes", problem: "must not be empty" });
        }
        let mut parts = memory::with_capacity(planes.len())?;
        for &(normal, offset) in planes {
            parts.push(Csg::half_space(normal, offset)?);
        }
        let polyhedron = Csg::intersection_of(parts)?;
        Ok(match support::box_around(planes)? {
            Some((min, max)) => polyhedron.within(min, max),
            None => polyhedron,
        })
    }
}
