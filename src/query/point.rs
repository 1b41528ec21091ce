//! Does the solid contain a point?

use crate::dispatch::with_popcount;
use crate::error::Error;
use crate::lattice::morton;
use crate::octree::brick::{Brick, BrickArray, Bricks};
use crate::octree::view::{MAX_ELEMENT_LEVELS, OctreeRef};
use crate::octree::{Octree, Planes, Tag};

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
    #[inline(always)]
    fn from(tag: Tag) -> Membership {
        match tag {
            Tag::Empty => Membership::Outside,
            Tag::Full => Membership::Inside,
            Tag::Partial | Tag::Branch => Membership::Undecided,
        }
    }
}

/// Points that a batch query keeps under way at once: enough to hide one level's cache misses behind
/// another's.
const LANES: usize = 16;

/// Cell of its element of level `e` (of `levels`) that the finest cell `at` lies in.
#[inline(always)]
fn cell_of(at: [u32; 3], e: usize, levels: usize) -> u32 {
    let shift = 2 * (levels - 1 - e);
    morton::index(at[0] >> shift, at[1] >> shift, at[2] >> shift)
}

impl OctreeRef<'_> {
    /// Whether the solid contains `point` (model units). A point on the boundary may be answered either
    /// way. At most ⌈depth/2⌉ elements are read; never fails, whatever the bytes.
    #[inline]
    pub fn contains(&self, point: [f64; 3]) -> Membership {
        match self.frame.cell_of(point) {
            Some(at) => self.tag_at(at).into(),
            None => Membership::Undecided,
        }
    }

    /// The tag of the finest cell `at` (each coordinate below 2^depth, else PARTIAL).
    pub fn tag_at(&self, at: [u32; 3]) -> Tag {
        if at.iter().any(|&a| a >= self.frame.cells()) {
            return Tag::Partial;
        }
        with_popcount(|| self.descend(at))
    }

    #[inline(always)]
    fn descend(&self, at: [u32; 3]) -> Tag {
        if self.root != Tag::Branch {
            return self.root;
        }
        match &self.bricks {
            Bricks::One(bricks) => self.descend_to(bricks, at),
            Bricks::Two(bricks) => self.descend_to(bricks, at),
        }
    }

    #[inline(always)]
    fn descend_to<T: Brick>(&self, bricks: &BrickArray<'_, T>, at: [u32; 3]) -> Tag {
        let levels = self.levels();
        let mut index = 0;
        for e in 0..levels - 1 {
            let c = cell_of(at, e, levels);
            match self.step(index, e, c) {
                Ok(child) => index = child,
                Err(tag) => return tag,
            }
        }
        let planes = bricks.get(index - self.planes.len()).map(Brick::planes);
        finest(planes, cell_of(at, levels - 1, levels))
    }

    /// The child of element `index` of level `e` in cell `c`, or the tag that ends the descent there.
    #[inline(always)]
    fn step(&self, index: usize, e: usize, c: u32) -> Result<usize, Tag> {
        let Some(planes) = self.planes.get(index) else { return Err(Tag::Partial) };
        let tag = planes.tag(c);
        if tag != Tag::Branch {
            return Err(tag);
        }
        match self.child(index, planes.branch(), c) {
            // A damaged link must not lead to another level.
            Some(child) if self.on_level(child, e + 1) => Ok(child),
            _ => Err(Tag::Partial),
        }
    }

    /// Answers many points at once, `answers[i]` for `points[i]`; the same answers as
    /// [`contains`](Self::contains). Points are kept under way in groups, which hides cache misses on trees
    /// that are larger than the caches.
    ///
    /// # Errors
    /// [`Error::Argument`] if the slices differ in length.
    pub fn contains_many(&self, points: &[[f64; 3]], answers: &mut [Membership]) -> Result<(), Error> {
        if points.len() != answers.len() {
            return Err(Error::Argument { name: "answers", problem: "must be as long as points" });
        }
        with_popcount(|| match &self.bricks {
            Bricks::One(bricks) => self.lockstep(bricks, points, answers),
            Bricks::Two(bricks) => self.lockstep(bricks, points, answers),
        });
        Ok(())
    }

    #[inline(always)]
    fn lockstep<T: Brick>(
        &self,
        bricks: &BrickArray<'_, T>,
        points: &[[f64; 3]],
        answers: &mut [Membership],
    ) {
        let levels = self.levels();
        for (points, answers) in points.chunks(LANES).zip(answers.chunks_mut(LANES)) {
            let mut at = [[0u32; 3]; LANES];
            let mut index = [0usize; LANES];
            let mut under_way = 0u32;
            for (i, &point) in points.iter().enumerate() {
                answers[i] = match self.frame.cell_of(point) {
                    Some(cell) => {
                        at[i] = cell;
                        under_way |= ((self.root == Tag::Branch) as u32) << i;
                        self.root.into()
                    }
                    None => Membership::Undecided,
                };
            }
            for e in 0..levels - 1 {
                let mut left = under_way;
                while left != 0 {
                    let i = left.trailing_zeros() as usize % LANES;
                    left &= left - 1;
                    match self.step(index[i], e, cell_of(at[i], e, levels)) {
                        Ok(child) => index[i] = child,
                        Err(tag) => {
                            answers[i] = tag.into();
                            under_way &= !(1 << i);
                        }
                    }
                }
            }
            while under_way != 0 {
                let i = under_way.trailing_zeros() as usize % LANES;
                under_way &= under_way - 1;
                let planes = bricks.get(index[i] - self.planes.len()).map(Brick::planes);
                answers[i] = finest(planes, cell_of(at[i], levels - 1, levels)).into();
            }
        }
    }
}

/// The tag of cell `c` of a brick; damage reads as undecided.
#[inline(always)]
fn finest(planes: Option<Planes>, c: u32) -> Tag {
    match planes.map(|planes| planes.tag(c)) {
        None | Some(Tag::Branch) => Tag::Partial,
        Some(tag) => tag,
    }
}

/// Point queries that remember the way to the last answer: for points that lie near each other, such as
/// along a line or in scan order.
#[derive(Clone)]
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
        while e + 1 < levels {
            match tree.step(self.path[e], e, cell_of(at, e, levels)) {
                Ok(child) => self.path[e + 1] = child,
                Err(tag) => {
                    self.reached = e;
                    return tag;
                }
            }
            e += 1;
        }
        self.reached = e;
        finest(tree.bricks.get(self.path[e] - tree.planes.len()), cell_of(at, e, levels))
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
