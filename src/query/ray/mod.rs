//! Where does a ray meet a solid?
//!
//! A solid is a closed set, and so are the unions of its FULL cells and of its FULL and PARTIAL cells. Where
//! a ray enters the first, it is proven inside; before it enters the second, it is proven outside. So a ray
//! that runs in a face of a cell, or touches an edge or a corner of it, meets that cell.

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

/// Which cells stop a ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Obstacle {
    /// What is proven to be solid: FULL cells.
    Full = 0,
    /// What may be solid: FULL and PARTIAL cells.
    Upper = 1,
}

/// Where a ray meets a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayHit {
    /// The least t at which the ray is in the solid lies in this interval: before `lower` the ray is proven
    /// outside, at `upper` inside. `upper` is ∞ if the ray is nowhere proven inside; then it may miss the
    /// solid.
    pub t: Interval,
    /// The first cell that stopped the ray; the finest one at the place where it was stopped if the solid
    /// answers rays itself.
    pub cell: Cell,
    /// The outward normal of the face by which the ray enters that cell, or of the surface where the solid
    /// knows slabs. Its length is 1 but for rounding. Zero if the ray starts in the cell.
    pub normal: [f64; 3],
    /// The number of the surface that stopped the ray, if the solid answers rays itself: of a mesh, the
    /// triangle's.
    pub surface: Option<u32>,
}

/// The intervals of t in which a ray is in a solid. Intervals ascend, and no two of a list meet. An interval
/// may be a single point, where a ray touches an edge or a corner of a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct RaySpans {
    /// Where the ray is proven inside, rounded inward.
    pub inner: Vec<Interval>,
    /// Where the ray is not proven outside, rounded outward. These intervals contain those of `inner`.
    pub outer: Vec<Interval>,
}
