//! Does the solid contain a point?

use crate::dispatch::{Hot, with_popcount};
use crate::error::Error;
use crate::lattice::Cell;
use crate::octree::links::{Links, levels_below};
use crate::octree::view::{MAX_ELEMENT_LEVELS, OctreeRef};
use crate::octree::{Octree, Tag};
use crate::op::LazyOctree;
use crate::solid::Solid;
use yoke::Yokeable;

/// The answer to a point query.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Membership {
    /// Proven outside.
    Outside = 0,
    /// Proven inside.
    Inside = 1,
    /// In a PARTIAL cell, outside of the universe, or not a number.
    Undecided = 2,
}

impl From<Tag> for Membership {
    /// A branch that leads nowhere is undecided.
    #[inline(always)]
    fn from(tag: Tag) -> Membership {
        const ANSWERS: [Membership; 4] =
            [Membership::Outside, Membership::Undecided, Membership::Undecided, Membership::Inside];
        ANSWERS[tag as usize]
    }
}

/// Points that a batch query keeps under way at once: enough to hide one point's cache misses and
/// mispredicted branches behind the others' work.
const LANES: usize = 32;

/// The coordinates of a finest cell side by side in one word, from which the cell's place in each element on
/// the way is a few shifts away.
#[derive(Clone, Copy, Default)]
struct Packed(u64);

/// Bits that a coordinate takes in a [`Packed`].
const FIELD: u32 = 21;

impl Packed {
    #[inline(always)]
    fn new(at: [u32; 3]) -> Packed {
        Packed(at[0] as u64 | (at[1] as u64) << FIELD | (at[2] as u64) << (2 * FIELD))
    }

    /// The Morton index in the element whose cells have an edge of 2^shift.
    #[inline(always)]
    fn cell(self, shift: u32) -> u32 {
        const FIELDS: u64 = 1 | 1 << FIELD | 1 << (2 * FIELD);
        let pairs = self.0 >> shift & (3 * FIELDS);
        // Bits 0 and 1 of a field to 0 and 3, then the fields into one another.
        let spread = (pairs * 5) & (9 * FIELDS);
        (spread | spread >> (FIELD - 1) | spread >> (2 * FIELD - 2)) as u32 & 63
    }
}

impl OctreeRef<'_> {
    /// Whether the solid contains `point` (model units). A point on the boundary may be answered either
    /// way. At most ⌈depth/2⌉ elements are read; never fails, whatever the bytes.
    #[inline]
    pub fn contains(&self, point: [f64; 3]) -> Membership {
        match self.frame.cell_of(point) {
            Some(at) => with_popcount(Descend { tree: self, at: Packed::new(at) }).into(),
            None => Membership::Undecided,
        }
    }

    /// The tag of the finest cell `at` (each coordinate below 2^depth, else PARTIAL).
    pub fn tag_at(&self, at: [u32; 3]) -> Tag {
        if at.iter().any(|&a| a >= self.frame.cells()) {
            return Tag::Partial;
        }
        with_popcount(Descend { tree: self, at: Packed::new(at) })
    }

    /// Answers many points at once, `answers[i]` for `points[i]`; the same answers as
    /// [`contains`](Self::contains). Points are kept under way in groups, level by level, which costs neither
    /// mispredicted branches nor waiting for memory.
    ///
    /// # Errors
    /// [`Error::Argument`] if the slices differ in length.
    pub fn contains_many(&self, points: &[[f64; 3]], answers: &mut [Membership]) -> Result<(), Error> {
        if points.len() != answers.len() {
            return Err(Error::Argument { name: "answers", problem: "must be as long as points" });
        }
        if self.root != Tag::Branch {
            points.iter().zip(answers).for_each(|(&point, answer)| *answer = self.contains(point));
            return Ok(());
        }
        with_popcount(Lockstep { tree: self, points, answers });
        Ok(())
    }

    /// The tag of a finest cell in the brick with this index; damage reads as undecided.
    #[inline(always)]
    fn finest(&self, index: usize, at: Packed) -> Tag {
        let brick = self.bricks.get(index.wrapping_sub(self.planes.len()));
        brick.map_or(Tag::Partial, |planes| planes.tag(at.cell(0)))
    }
}

/// One point on its way down.
struct Descend<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    at: Packed,
}

impl Hot for Descend<'_, '_> {
    type Output = Tag;

    #[inline(always)]
    fn run(self) -> Tag {
        let Descend { tree, at } = self;
        if tree.root != Tag::Branch {
            return tree.root;
        }
        let links = Links::new(tree);
        let mut index = 0;
        for (shift, level) in levels_below(tree) {
            let (tag, child, goes_on) = links.step(index, at.cell(shift), level);
            if !goes_on {
                return settled(tag);
            }
            index = child;
        }
        settled(tree.finest(index, at))
    }
}

/// Many points on their way down, in groups.
struct Lockstep<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    points: &'t [[f64; 3]],
    answers: &'t mut [Membership],
}

/// A point under way: its place in the group, its cell, and the element that it has come to.
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
                    // Whatever comes of this step is written; no branch depends on whether it ends here.
                    let (tag, index, goes_on) = links.step(lane.index, lane.at.cell(shift), level);
                    answers[lane.point] = tag.into();
                    lanes[kept % LANES] = Lane { index, ..lane };
                    kept += goes_on as usize;
                }
                under_way = kept;
            }
            for lane in &lanes[..under_way] {
                answers[lane.point] = tree.finest(lane.index, lane.at).into();
            }
        }
    }
}

/// A branch that leads nowhere is undecided.
#[inline(always)]
fn settled(tag: Tag) -> Tag {
    if tag == Tag::Branch { Tag::Partial } else { tag }
}

/// Point queries that remember the way to the last answer: for points that lie near each other, such as
/// along a line or in scan order.
#[derive(Clone, Yokeable)]
pub struct PointCursor<'a> {
    tree: OctreeRef<'a>,
    last: [u32; 3],
    /// Elements on the way to `last`, valid up to level `reached`.
    path: [usize; MAX_ELEMENT_LEVELS],
    reached: usize,
}

impl<'a> PointCursor<'a> {
    /// A cursor that has not been anywhere yet.
    pub fn new(tree: &OctreeRef<'a>) -> PointCursor<'a> {
        PointCursor { tree: *tree, last: [0; 3], path: [0; MAX_ELEMENT_LEVELS], reached: 0 }
    }

    /// As [`OctreeRef::contains`].
    #[inline]
    pub fn contains(&mut self, point: [f64; 3]) -> Membership {
        match self.tree.frame.cell_of(point) {
            Some(at) => self.tag_at(at).into(),
            None => Membership::Undecided,
        }
    }

    /// As [`OctreeRef::tag_at`].
    #[inline]
    pub fn tag_at(&mut self, at: [u32; 3]) -> Tag {
        let tree = &self.tree;
        if at.iter().any(|&a| a >= tree.frame.cells()) {
            return Tag::Partial;
        }
        if tree.root != Tag::Branch {
            return tree.root;
        }
        let levels = tree.levels();
        let changed = (at[0] ^ self.last[0]) | (at[1] ^ self.last[1]) | (at[2] ^ self.last[2]);
        // Two bits a level: elements above the highest changed bit are on both ways.
        let shared = levels - 1 - (31 - (changed | 1).leading_zeros()) as usize / 2;
        let mut e = shared.min(self.reached);
        self.last = at;
        let at = Packed::new(at);
        let links = Links::new(tree);
        for (shift, level) in levels_below(tree).skip(e) {
            let (tag, child, goes_on) = links.step(self.path[e], at.cell(shift), level);
            if !goes_on {
                self.reached = e;
                return settled(tag);
            }
            e += 1;
            self.path[e] = child;
        }
        self.reached = e;
        settled(tree.finest(self.path[e], at))
    }
}

impl<S: Solid> LazyOctree<S> {
    /// Whether the solid contains `point` (model units), as far as cells have been split. A point on the
    /// boundary may be answered either way. O(depth).
    pub fn contains(&self, point: [f64; 3]) -> Membership {
        let level = self.frame().depth();
        self.frame().cell_of(point).map_or(Membership::Undecided, |at| self.tag(Cell { level, at }).into())
    }
}

impl Octree {
    /// As [`OctreeRef::contains`].
    #[inline]
    pub fn contains(&self, point: [f64; 3]) -> Membership {
        self.view().contains(point)
    }

    /// As [`OctreeRef::contains_many`].
    ///
    /// # Errors
    /// [`Error::Argument`] if the slices differ in length.
    pub fn contains_many(&self, points: &[[f64; 3]], answers: &mut [Membership]) -> Result<(), Error> {
        self.view().contains_many(points, answers)
    }
}
