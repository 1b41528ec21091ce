//! The intersection of rays with solids.
//!
//! A solid is a closed set, and so are the union of its FULL cells and the union of its FULL and PARTIAL
//! cells. Where a ray enters the first union, it is proven inside. Before it enters the second, it is proven
//! outside. A ray that runs in a face of a cell, or touches an edge or a corner, therefore meets that cell.

mod beam;
mod course;
mod cut;
mod direct;
mod line;
mod march;
mod octree;
mod search;
mod solid;
#[cfg(feature = "render")]
mod touch;
mod trace;
mod way;

pub use crate::lattice::Ray;
pub use solid::{Sight, cast_rays, line_of_sight, ray_spans};
#[cfg(feature = "render")]
pub(crate) use touch::TouchedCell;

use crate::lattice::{Cell, Interval};
use alloc::vec::Vec;

/// The cells that stop a ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Obstacle {
    /// The proven solid: FULL cells.
    Full = 0,
    /// The possible solid: FULL and PARTIAL cells.
    Upper = 1,
}

/// The first intersection of a ray with a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayHit {
    /// An interval that contains the least t at which the ray is in the solid: before `lower` the ray is
    /// proven outside, at `upper` inside. `upper` is ∞ if the ray is nowhere proven inside; the ray may then
    /// miss the solid.
    pub t: Interval,
    /// The first cell that stopped the ray. If the solid answers rays itself, it is the finest cell at the
    /// place where the ray was stopped.
    pub cell: Cell,
    /// The outward normal of the face by which the ray enters that cell, or of the surface where the solid
    /// provides slabs. Its length is 1 up to rounding. Zero if the ray starts in the cell.
    pub normal: [f64; 3],
    /// The number of the surface that stopped the ray, if the solid answers rays itself; for a mesh, the
    /// number of the triangle.
    pub surface: Option<u32>,
}

/// The intervals of t in which a ray is in a solid. Intervals ascend, and no two of a list meet. An interval
/// may be a single point, where a ray touches an edge or a corner of a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct RaySpans {
    /// The intervals where the ray is proven inside, rounded inward.
    pub inner: Vec<Interval>,
    /// The intervals where the ray is not proven outside, rounded outward. They contain those of `inner`.
    pub outer: Vec<Interval>,
}
