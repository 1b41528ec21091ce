//! Solids: everything that can split a cell.
//!
//! The library asks one thing of a shape: *split this PARTIAL cell into its eight children, classified*.
//! Whatever has a shape is a [`Solid`]: primitives, triangle meshes, stored octrees, a host program's
//! callback. Whatever wants a shape calls [`Solid::split`] and nothing else. Each producer is one file, and
//! none knows the others.

mod callback;
mod counted;
mod csg;
mod erased;
mod exact;
mod fingerprint;
mod mesh;
mod primitive;
mod stored;
mod transform;

pub use callback::Callback;
pub use counted::Counted;
pub use csg::{Csg, CsgPart, CsgScratch, HalfSpace, Touch};
#[cfg(feature = "scene")]
pub(crate) use csg::{Figure, wedge};
#[cfg(feature = "capi")]
pub(crate) use erased::MOST_NESTED;
pub use erased::{AnySolid, ErasedPart, ErasedScratch};
pub use fingerprint::{Fingerprint, Fingerprinter};
pub(crate) use mesh::FacetWelder;
#[cfg(feature = "std")]
pub(crate) use mesh::triangulate_facet;
pub use mesh::{
    DefectKind, FillRule, MeshDefect, MeshPart, MeshReport, MeshScratch, MeshSolid, TriangleMesh,
};
#[cfg(feature = "std")]
pub use mesh::{Polyhedron, PolyhedronArrays};
pub use primitive::{AxisBox, Ball};
pub use stored::{Stored, StoredPart};
pub use transform::{Transform, TransformPart, TransformScratch};

use crate::error::Error;
use crate::lattice::{Cube, Frame, LARGEST, SMALLEST};
use crate::octree::{Block, Planes, Tag};
use alloc::vec::Vec;

/// What a solid says of one cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict<P> {
    /// The cell's interior and the solid's are proven disjoint.
    Empty,
    /// The cell is proven to lie in the solid.
    Full,
    /// Not decided, and splitting does not help.
    Undecided,
    /// Not decided; the part is what the solid remembers about the cell, so that it can split it.
    Partial(P),
}

impl<P> Verdict<P> {
    /// The verdict as a tag.
    #[inline(always)]
    pub fn tag(&self) -> Tag {
        match self {
            Verdict::Empty => Tag::Empty,
            Verdict::Full => Tag::Full,
            Verdict::Undecided | Verdict::Partial(_) => Tag::Partial,
        }
    }
}

/// Memory that parts of cells refer to: a stack, so that no split allocates. Parts made after a mark are
/// gone once the mark is released.
pub trait Scratch: Default + Send + Sync {
    /// The present height.
    fn mark(&self) -> usize;

    /// Back to an earlier height.
    fn release(&mut self, mark: usize);

    /// Half-spaces that were evaluated with this memory so far, each at a point or over a box; never falls.
    fn evaluations(&self) -> u64 {
        0
    }
}

/// For solids whose parts stand alone.
impl Scratch for () {
    fn mark(&self) -> usize {
        0
    }
    fn release(&mut self, _: usize) {}
}

/// Anything that can split a cell.
///
/// # Laws
/// 1. A FULL or EMPTY verdict is proven. Contact is not overlap: FULL means that the whole (closed) cell lies
///    in the solid, EMPTY that the interiors are disjoint.
/// 2. A verdict depends on the cell and the solid alone: not on the path to the cell, the thread, or what
///    was asked before.
/// 3. The part of any cell can be had again by replaying the splits from the root.
///
/// All of it concerns the solid inside of the universe.
pub trait Solid: Sync {
    /// What the solid remembers about one PARTIAL cell; it may refer to the scratch memory.
    type Part: Clone + Send + Sync;

    /// Where parts keep what does not fit into them.
    type Scratch: Scratch;

    /// The universe's verdict.
    ///
    /// # Errors
    /// If the solid cannot be had in this frame, or memory runs out.
    fn root(&self, scratch: &mut Self::Scratch, frame: &Frame) -> Result<Verdict<Self::Part>, Error>;

    /// Splits a PARTIAL cell, which is above the frame's depth: the verdicts of its children in octant order.
    ///
    /// # Errors
    /// If memory runs out.
    fn split(
        &self,
        scratch: &mut Self::Scratch,
        cube: &Cube<'_>,
        part: &Self::Part,
    ) -> Result<[Verdict<Self::Part>; 8], Error>;

    /// Splits two levels at once, the grain of storage: the tags of the 64 grandchildren in Morton order.
    /// The parts of those that can be split are appended to `parts` with their index, in ascending order.
    ///
    /// # Errors
    /// As [`split`](Self::split).
    fn split64(
        &self,
        scratch: &mut Self::Scratch,
        cube: &Cube<'_>,
        part: &Self::Part,
        parts: &mut Vec<(u8, Self::Part)>,
    ) -> Result<Planes, Error> {
        split_twice(self, scratch, cube, part, parts)
    }

    /// Classifies a PARTIAL cell of 64³ finest cells at once, where that is faster than descent: fills
    /// `block` with just what descending by [`split`](Self::split) would find, as the block's rule resolves
    /// it, and returns `true`. The default returns `false`: descend.
    ///
    /// # Errors
    /// As [`split`](Self::split).
    fn fill(
        &self,
        scratch: &mut Self::Scratch,
        cube: &Cube<'_>,
        part: &Self::Part,
        block: &mut Block,
    ) -> Result<bool, Error> {
        let _ = (scratch, cube, part, block);
        Ok(false)
    }

    /// Whether the centre of a PARTIAL cell of the frame's depth lies in the solid, or `None` if the solid
    /// cannot tell. A centre on the boundary is decided as if all centres were shifted by (ε, ε², ε³), to first
    /// order: on a curved surface too, the first axis that leads across it decides.
    ///
    /// # Errors
    /// If a host program's function stops the work.
    fn sample(
        &self,
        scratch: &mut Self::Scratch,
        cube: &Cube<'_>,
        part: &Self::Part,
    ) -> Result<Option<bool>, Error> {
        let _ = (scratch, cube, part);
        Ok(None)
    }

    /// Samples many at once, the grain of storage: of those 64 grandchildren of a cell whose parts are given, with
    /// their index, bit c says whether the centre of cell c lies in the solid. The grandchildren have the frame's depth.
    ///
    /// # Errors
    /// As [`sample`](Self::sample).
    fn sample64(
        &self,
        scratch: &mut Self::Scratch,
        cube: &Cube<'_>,
        parts: &[(u8, Self::Part)],
    ) -> Result<Option<u64>, Error> {
        let mut inside = 0;
        for (c, part) in parts {
            let cube = cube.child(c >> 3).child(c & 7);
            match self.sample(scratch, &cube, part)? {
                Some(true) => inside |= 1 << (c & 63),
                Some(false) => {}
                None => return Ok(None),
            }
        }
        Ok(Some(inside))
    }

    /// What is known of the space around the universe: EMPTY if the solid is proven to end inside, FULL if
    /// the space is proven solid, else PARTIAL.
    fn exterior(&self, frame: &Frame) -> Tag {
        let _ = frame;
        Tag::Partial
    }

    /// How many [`AnySolid`]s lie within each other here: 0 for a solid that consists of no others. Questions go from
    /// one to the next, so that there is an end to what the stack holds: an [`AnySolid`] with more than 64 within each
    /// other has no [root](Self::root).
    fn nesting(&self) -> u32 {
        0
    }

    /// What tells this solid from others: two with the same fingerprint give the same verdicts. `None`, the default,
    /// if nothing does; then an octree that was refined on demand cannot be taken up again with it.
    fn fingerprint(&self) -> Option<Fingerprint> {
        None
    }

    /// Copies a part with what it refers to into the scratch memory of another thread.
    ///
    /// # Errors
    /// If memory runs out.
    fn hand_over(
        &self,
        from: &Self::Scratch,
        part: &Self::Part,
        to: &mut Self::Scratch,
    ) -> Result<Self::Part, Error> {
        let _ = (from, to);
        Ok(part.clone())
    }
}

/// A solid that is borrowed.
impl<S: Solid> Solid for &S {
    type Part = S::Part;
    type Scratch = S::Scratch;

    fn root(&self, scratch: &mut S::Scratch, frame: &Frame) -> Result<Verdict<S::Part>, Error> {
        (**self).root(scratch, frame)
    }

    fn split(
        &self,
        scratch: &mut S::Scratch,
        cube: &Cube<'_>,
        part: &S::Part,
    ) -> Result<[Verdict<S::Part>; 8], Error> {
        (**self).split(scratch, cube, part)
    }

    fn split64(
        &self,
        scratch: &mut S::Scratch,
        cube: &Cube<'_>,
        part: &S::Part,
        parts: &mut Vec<(u8, S::Part)>,
    ) -> Result<Planes, Error> {
        (**self).split64(scratch, cube, part, parts)
    }

    fn fill(
        &self,
        scratch: &mut S::Scratch,
        cube: &Cube<'_>,
        part: &S::Part,
        block: &mut Block,
    ) -> Result<bool, Error> {
        (**self).fill(scratch, cube, part, block)
    }

    fn sample(
        &self,
        scratch: &mut S::Scratch,
        cube: &Cube<'_>,
        part: &S::Part,
    ) -> Result<Option<bool>, Error> {
        (**self).sample(scratch, cube, part)
    }

    fn sample64(
        &self,
        scratch: &mut S::Scratch,
        cube: &Cube<'_>,
        parts: &[(u8, S::Part)],
    ) -> Result<Option<u64>, Error> {
        (**self).sample64(scratch, cube, parts)
    }

    fn exterior(&self, frame: &Frame) -> Tag {
        (**self).exterior(frame)
    }

    fn hand_over(&self, from: &S::Scratch, part: &S::Part, to: &mut S::Scratch) -> Result<S::Part, Error> {
        (**self).hand_over(from, part, to)
    }

    fn nesting(&self) -> u32 {
        (**self).nesting()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        (**self).fingerprint()
    }
}

/// Two levels by splitting twice.
pub(crate) fn split_twice<S: Solid + ?Sized>(
    solid: &S,
    scratch: &mut S::Scratch,
    cube: &Cube<'_>,
    part: &S::Part,
    parts: &mut Vec<(u8, S::Part)>,
) -> Result<Planes, Error> {
    let mut planes = Planes::uniform(Tag::Empty);
    for (k, child) in (0u8..).zip(solid.split(scratch, cube, part)?) {
        let mut octant = Planes::uniform(child.tag()).masked(0xFF << (8 * k));
        if let Verdict::Partial(part) = child {
            for (c, cell) in (8 * k..).zip(solid.split(scratch, &cube.child(k), &part)?) {
                octant.set(c as u32, cell.tag());
                if let Verdict::Partial(part) = cell {
                    parts.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
                    parts.push((c, part));
                }
            }
        }
        planes = planes.union(octant);
    }
    Ok(planes)
}

/// Whether a coefficient is of a magnitude that exact arithmetic can take: 2^-256 to 2^256.
pub(crate) fn is_moderate(value: f64) -> bool {
    (SMALLEST..=LARGEST).contains(&value.abs())
}
