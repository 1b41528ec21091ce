//! Point membership in octrees.

mod cursor;
mod cuts;
mod descent;
mod table;

pub use cursor::PointCursor;
pub use table::PointTable;

use crate::dispatch::{Hot, with_popcount};
use crate::error::Error;
use crate::lattice::Cell;
use crate::octree::links::{Links, levels_below};
use crate::octree::view::OctreeRef;
use crate::octree::{Octree, Tag};
use crate::op::LazyOctree;
use descent::{Descend, Packed};

/// The answer to a point query.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Membership {
    /// Proven outside.
    Outside = 0,
    /// Proven inside.
    Inside = 1,
    /// Not proven: the point lies in a PARTIAL cell whose surfaces do not decide it, or outside of the
    /// universe, or is not a number.
    Undecided = 2,
}

impl Membership {
    /// The answer for a point whose side is proven.
    pub(super) fn of(inside: bool) -> Membership {
        if inside { Membership::Inside } else { Membership::Outside }
    }
}

impl From<Tag> for Membership {
    /// Converts a tag to an answer. A branch without an element is undecided.
    #[inline(always)]
    fn from(tag: Tag) -> Membership {
        const ANSWERS: [Membership; 4] =
            [Membership::Outside, Membership::Undecided, Membership::Undecided, Membership::Inside];
        ANSWERS[tag as usize]
    }
}

/// The number of points that a batch query processes together: enough to hide one point's cache misses and
/// mispredicted branches behind the work of the others.
const LANES: usize = 32;

impl OctreeRef<'_> {
    /// Returns whether the solid contains `point` (model units). A point on the boundary may get either
    /// answer. The query reads at most ⌈depth/2⌉ elements. It never fails, whatever the bytes.
    ///
    /// Cuts decide in place, by arithmetic in doubles. The answer may be [`Undecided`](Membership::Undecided)
    /// for points next to a surface, within about 10^-15 of the coordinates. To decide these points too,
    /// query the tree as a [solid](crate::contains).
    #[inline]
    pub fn contains(&self, point: [f64; 3]) -> Membership {
        if let Some(cuts) = &self.cuts {
            return self.contains_by_cuts(cuts, point);
        }
        match self.frame.cell_of(point) {
            Some(at) => Descend::from_root(self, Packed::new(at)).into(),
            None => Membership::Undecided,
        }
    }

    /// Returns the tag of the finest cell `at`, regardless of any cut (each coordinate must be below 2^depth,
    /// else the result is PARTIAL).
    pub fn tag_at(&self, at: [u32; 3]) -> Tag {
        if at.iter().any(|&a| a >= self.frame.cells()) {
            return Tag::Partial;
        }
        Descend::from_root(self, Packed::new(at))
    }

    /// Answers many points at once, `answers[i]` for `points[i]`. The answers equal those of
    /// [`contains`](Self::contains). Points are processed in groups, level by level, which avoids
    /// mispredicted branches and waits for memory.
    ///
    /// # Errors
    /// [`Error::Argument`] if the slices differ in length.
    pub fn contains_many(&self, points: &[[f64; 3]], answers: &mut [Membership]) -> Result<(), Error> {
        if points.len() != answers.len() {
            return Err(Error::Argument { name: "answers", problem: "must be as long as points" });
        }
        if self.root != Tag::Branch || self.cuts.is_some() {
            points.iter().zip(answers).for_each(|(&point, answer)| *answer = self.contains(point));
            return Ok(());
        }
        with_popcount(Lockstep { tree: self, points, answers });
        Ok(())
    }
}

/// The descent of many points, in groups.
struct Lockstep<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    points: &'t [[f64; 3]],
    answers: &'t mut [Membership],
}

/// A point in descent: its index in the group, its cell, and the element that it has reached.
#[derive(Clone, Copy, Default)]
struct Lane {
    point: usize,
    at: Packed,
    index: usize,
}

impl Hot for Lockstep<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Lockstep { tree, points, answers } = self;
        let links = Links::new(tree);
        for (points, answers) in points.chunks(LANES).zip(answers.chunks_mut(LANES)) {
            let mut lanes = [Lane::default(); LANES];
            let mut under_way = 0;
            for (i, &point) in points.iter().enumerate() {
                answers[i] = Membership::Undecided;
                if let Some(at) = tree.frame.cell_of(point) {
                    lanes[under_way % LANES] = Lane { point: i, at: Packed::new(at), index: 0 };
                    under_way += 1;
                }
            }
            for (shift, level) in levels_below(tree) {
                let mut kept = 0;
                for i in 0..under_way {
                    let lane = lanes[i % LANES];
                    // Every result of this step is written, so that no branch depends on whether the descent
                    // ends here.
                    let (tag, index, goes_on) = links.step(lane.index, lane.at.cell(shift), level);
                    answers[lane.point] = tag.into();
                    lanes[kept % LANES] = Lane { index, ..lane };
                    kept += goes_on as usize;
                }
                under_way = kept;
            }
            for lane in &lanes[..under_way] {
                answers[lane.point] = descent::brick(tree, lane.index).tag(lane.at.cell(0)).into();
            }
        }
    }
}

impl LazyOctree<'_> {
    /// Returns whether the solid contains `point` (model units), as far as cells have been split. A point on
    /// the boundary may get either answer. Complexity: O(depth).
    pub fn contains(&self, point: [f64; 3]) -> Membership {
        let level = self.frame().depth();
        self.frame().cell_of(point).map_or(Membership::Undecided, |at| self.tag(Cell { level, at }).into())
    }
}

impl Octree {
    /// Returns whether the solid contains a point. See [`OctreeRef::contains`] for the full contract.
    #[inline]
    pub fn contains(&self, point: [f64; 3]) -> Membership {
        self.view().contains(point)
    }

    /// Answers many points at once. See [`OctreeRef::contains_many`] for the full contract.
    ///
    /// # Errors
    /// [`Error::Argument`] if the slices differ in length.
    pub fn contains_many(&self, points: &[[f64; 3]], answers: &mut [Membership]) -> Result<(), Error> {
        self.view().contains_many(points, answers)
    }
}
