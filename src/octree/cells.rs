//! Iteration over the cells of an octree, in Morton order.

use super::links::Step;
use super::path::{NOWHERE, Path, Place};
use super::tag::Tag;
use super::view::{MAX_ELEMENT_LEVELS, OctreeRef, starts_half_way};
use super::word::Planes;
use crate::dispatch::{Hot, with_popcount};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, MAX_DEPTH, morton};
use core::ops::RangeInclusive;
use yoke::Yokeable;

/// A cell with its tag.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct TaggedCell {
    /// The octant of the universe.
    pub cell: Cell,
    /// The tag of the cell.
    pub tag: Tag,
}

/// A selection of the cells of an octree: cells with certain tags, on certain levels, in a box.
///
/// ```
/// use leafless::{Tag, octree::CellFilter};
/// // The surface of what may be solid, in the lower half of a tree of depth 10.
/// let filter = CellFilter::tags(&[Tag::Full, Tag::Partial]).within([0; 3], [1024, 1024, 512]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CellFilter {
    /// Bit t: select cells whose tag has the number t.
    tags: u8,
    levels: [u8; 2],
    min: [u32; 3],
    max: [u32; 3],
}

impl CellFilter {
    /// Selects the cells with one of these tags, on all levels and in the whole universe. BRANCH stands for
    /// cells that are cut and split.
    pub fn tags(tags: &[Tag]) -> CellFilter {
        let tags = tags.iter().fold(0, |bits, &tag| bits | 1 << tag as u8);
        CellFilter { tags, levels: [0, MAX_DEPTH], min: [0; 3], max: [u32::MAX; 3] }
    }

    /// Selects the cells that are not split: EMPTY, FULL and PARTIAL.
    pub fn leaves() -> CellFilter {
        CellFilter::tags(&[Tag::Empty, Tag::Full, Tag::Partial])
    }

    /// Restricts the selection to cells on `levels`; level 0 is the universe.
    #[must_use]
    pub fn levels(self, levels: RangeInclusive<u8>) -> CellFilter {
        CellFilter { levels: [*levels.start(), *levels.end()], ..self }
    }

    /// Restricts the selection to cells that reach into the box from `min` to `max`, in finest cells: `max`
    /// is the first cell beyond the box on each axis. No cell reaches into an empty box.
    #[must_use]
    pub fn within(self, min: [u32; 3], max: [u32; 3]) -> CellFilter {
        CellFilter { min, max, ..self }
    }

    /// True if `tag` is one of the selected tags.
    #[inline(always)]
    pub(super) fn has(&self, tag: Tag) -> bool {
        self.tags >> tag as u8 & 1 != 0
    }

    /// Returns the same filter without BRANCH.
    pub(super) fn without_branches(self) -> CellFilter {
        CellFilter { tags: self.tags & CellFilter::leaves().tags, ..self }
    }

    /// Returns the filter for the leaves with other tags, on all levels and in the whole universe.
    pub(super) fn others(&self) -> CellFilter {
        CellFilter { tags: CellFilter::leaves().tags & !self.tags, ..CellFilter::leaves() }
    }

    #[inline(always)]
    fn has_level(&self, level: u8) -> bool {
        self.levels[0] <= level && level <= self.levels[1]
    }

    #[inline(always)]
    fn is_everywhere(&self, cells: u32) -> bool {
        self.min == [0; 3] && self.max.iter().all(|&max| max >= cells)
    }

    fn is_nowhere(&self, cells: u32) -> bool {
        (0..3).any(|axis| self.min[axis] >= self.max[axis].min(cells))
    }
}

/// The cells of an element that are still to be returned.
#[derive(Clone, Copy, Default)]
struct Todo {
    /// Octants, as the low bits of their bytes.
    octants: u64,
    /// Cells to return, and cells to enter.
    cells: u64,
}

/// Low bit of every byte.
const LOW: u64 = 0x0101_0101_0101_0101;

/// An iterator over the cells of an octree that a [`CellFilter`] selects, in Morton order: a cell that is
/// split comes before the cells in it. See [`OctreeRef::cells`].
///
/// [`fill`](Cells::fill) returns many cells at once, which is faster, and [`seek`](Cells::seek) continues
/// from any cell. The iterator needs no allocation.
///
/// Over unchecked bytes, it visits no element twice: the elements of a level must ascend. A link that
/// violates this order makes its cell PARTIAL, as for a [`Cursor`](crate::octree::Cursor).
#[derive(Clone, Yokeable)]
pub struct Cells<'a> {
    tree: OctreeRef<'a>,
    filter: CellFilter,
    everywhere: bool,
    /// True until the universe has been returned, which is not a cell of an element.
    universe: bool,
    /// Number of open elements, that is, of those on the path.
    open: usize,
    /// Position of the own cell of the last open element.
    at: [u32; 3],
    path: Path,
    todo: [Todo; MAX_ELEMENT_LEVELS],
    /// For each element level, the first element that has not been passed.
    next: [usize; MAX_ELEMENT_LEVELS],
    /// Number of elements that may still be entered.
    visits: usize,
}

impl<'a> OctreeRef<'a> {
    /// Returns the cells that `filter` selects, in Morton order. O(cells and visited elements): elements
    /// outside the filter's box or below its levels are not visited. Damage reads as PARTIAL.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Rule, Tag, build, octree::CellFilter};
    /// let frame = Frame::new([0.0; 3], 4.0, 2)?;
    /// let bar = build(&Csg::cuboid([0.0; 3], [3.0, 1.0, 1.0])?, &frame, Rule::Certified, &Control::default())?;
    /// let solid = bar.view().cells(CellFilter::tags(&[Tag::Full]));
    /// let corners: Vec<[u32; 3]> = solid.map(|found| found.cell.at).collect();
    /// assert_eq!(corners, [[0, 0, 0], [1, 0, 0], [2, 0, 0]]);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn cells(&self, filter: CellFilter) -> Cells<'a> {
        let mut cells = Cells::blank(self, filter, self.planes.len() + self.bricks.len());
        cells.begin();
        cells
    }
}

impl<'a> Cells<'a> {
    /// Returns an iterator without any cells.
    fn blank(tree: &OctreeRef<'a>, filter: CellFilter, visits: usize) -> Cells<'a> {
        let mut next = [0; MAX_ELEMENT_LEVELS];
        next.copy_from_slice(&tree.starts[..MAX_ELEMENT_LEVELS]);
        Cells {
            tree: *tree,
            filter,
            everywhere: filter.is_everywhere(tree.frame.cells()),
            universe: false,
            open: 0,
            at: [0; 3],
            path: NOWHERE,
            todo: [Todo::default(); MAX_ELEMENT_LEVELS],
            next,
            visits,
        }
    }

    /// Returns the cells in the element at `place`, below which at most `visits` elements are entered.
    pub(super) fn below(tree: &OctreeRef<'a>, place: Place, filter: CellFilter, visits: usize) -> Cells<'a> {
        let mut cells = Cells::blank(tree, filter, visits.saturating_add(1));
        cells.enter(place);
        cells
    }

    /// Returns the number of elements that may still be entered.
    pub(super) fn visits(&self) -> usize {
        self.visits
    }

    /// Returns the elements from the root to the one that contains the last cell, if that cell is a leaf.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    pub(super) fn tree(&self) -> &OctreeRef<'a> {
        &self.tree
    }

    pub(super) fn wanted(&self) -> &CellFilter {
        &self.filter
    }

    /// Starts at the universe.
    fn begin(&mut self) {
        if self.filter.is_nowhere(self.tree.frame.cells()) {
            return;
        }
        let root = Place { level: 0, index: 0, at: [0; 3] };
        let entered = self.tree.root == Tag::Branch && self.enter(root);
        // In a tree of odd depth, the universe is an octant of the root.
        self.universe = !(entered && starts_half_way(self.tree.frame.depth()));
    }

    /// Returns the cell with this number in the element at `place`, with its level.
    fn child(&self, e: usize, c: u32) -> Cell {
        let [x, y, z] = morton::position(c);
        let at = self.at;
        Cell { level: self.tree.cell_level(e), at: [4 * at[0] + x, 4 * at[1] + y, 4 * at[2] + z] }
    }

    /// Opens an element, unless it is damaged or has been passed.
    #[inline(always)]
    fn enter(&mut self, place: Place) -> bool {
        let Place { level: e, index, at } = place;
        if index < self.next[e] || self.visits == 0 {
            return false;
        }
        let Some(planes) = self.tree.entry(index) else { return false };
        self.next[e] = index + 1;
        self.visits -= 1;
        self.path[e] = (index, planes);
        self.at = at;
        self.todo[e] = self.plan(e, planes);
        self.open = e + 1;
        true
    }

    /// Returns the cells to return from the element that has just been entered.
    #[inline(always)]
    fn plan(&self, e: usize, planes: Planes) -> Todo {
        let (tree, filter, level) = (&self.tree, &self.filter, self.tree.cell_level(e));
        let mut within = if self.everywhere { !0 } else { self.cells_in_box(level) };
        let [mut empty, mut full, mut partial] = planes.octants();
        if e == 0 {
            within &= tree.root_cells();
            if starts_half_way(tree.frame.depth()) {
                // The universe is cut, whatever damaged bytes say about its children.
                [empty, full, partial] = [0; 3];
            }
        }
        let split = LOW & !(empty | full | partial);
        let pick = |tag: Tag, word: u64| if filter.has(tag) { word } else { 0 };
        let mut todo = Todo::default();
        if filter.has_level(level - 1) {
            let wanted = pick(Tag::Empty, empty)
                | pick(Tag::Full, full)
                | pick(Tag::Partial, partial)
                | pick(Tag::Branch, split);
            let any = within | within >> 4;
            let any = any | any >> 2;
            todo.octants = wanted & (any | any >> 1);
        }
        if level <= filter.levels[1] {
            let mut wanted = planes.branch();
            if level >= filter.levels[0] {
                wanted |= pick(Tag::Empty, planes.empty())
                    | pick(Tag::Full, planes.full())
                    | pick(Tag::Partial, planes.partial());
            }
            todo.cells = wanted & within & (split * 0xFF);
        }
        todo
    }

    /// Returns the cells of the current element, on `level`, that reach into the box.
    fn cells_in_box(&self, level: u8) -> u64 {
        let (depth, shift) = (self.tree.frame.depth(), self.tree.frame.depth() - level);
        let mut within = !0;
        for axis in 0..3 {
            let first = 4 * self.at[axis];
            let (min, max) = (self.filter.min[axis], self.filter.max[axis].min(1 << depth));
            // The box is not empty, or nothing would have been entered.
            let (low, high) = (min >> shift, (max - 1) >> shift);
            if high < first {
                return 0;
            }
            within &= morton::slabs(axis, low.saturating_sub(first), (high - first).min(3));
        }
        within
    }

    /// Returns the next cell.
    #[inline(always)]
    fn advance(&mut self) -> Option<TaggedCell> {
        if self.universe {
            self.universe = false;
            let tag = match self.tree.root {
                // The root element is damaged.
                Tag::Branch if self.open == 0 => Tag::Partial,
                tag => tag,
            };
            if self.filter.has(tag) && self.filter.has_level(0) {
                return Some(TaggedCell { cell: Cell::ROOT, tag });
            }
        }
        loop {
            let e = self.open.checked_sub(1)?;
            let todo = &mut self.todo[e];
            let any = todo.octants | todo.cells;
            if any == 0 {
                self.open = e;
                self.at = self.at.each(|a| a >> 2);
                continue;
            }
            let (c, first) = (any.trailing_zeros(), any & any.wrapping_neg());
            let (index, planes) = self.path[e];
            if todo.octants & first != 0 {
                todo.octants ^= first;
                return Some(self.octant(e, c, planes));
            }
            todo.cells ^= first;
            let cell = self.child(e, c);
            let mut tag = planes.tag(c);
            if tag == Tag::Branch {
                tag = self.descend(e, index, planes, c, cell);
                if !self.filter.has(tag) || !self.filter.has_level(cell.level) {
                    continue;
                }
            }
            return Some(TaggedCell { cell, tag });
        }
    }

    /// Returns the octant whose first cell is `c`.
    #[inline(always)]
    fn octant(&self, e: usize, c: u32, planes: Planes) -> TaggedCell {
        let cell = self.child(e, c).parent();
        // The universe is cut, whatever damaged bytes say about its children.
        let tag = if cell.level == 0 { Tag::Branch } else { planes.octant(c / 8) };
        TaggedCell { cell, tag }
    }

    /// Opens the element or brick in the BRANCH `c` of an element, and returns the tag of the cell: PARTIAL
    /// if it cannot be opened.
    #[inline(always)]
    fn descend(&mut self, e: usize, index: usize, planes: Planes, c: u32, cell: Cell) -> Tag {
        let entered = match self.tree.step(e, index, planes, c) {
            Step::Into(index) => self.enter(Place { level: e + 1, index, at: cell.at }),
            Step::Settled(_) => false,
        };
        if entered { Tag::Branch } else { Tag::Partial }
    }

    /// Continues from `cell`: the next cell is `cell`, the leaf that contains it, or the first selected cell
    /// after it in Morton order. O(depth).
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] if `cell` does not lie in the universe, or is finer than the finest cells.
    pub fn seek(&mut self, cell: Cell) -> Result<(), Error> {
        let cell = self.tree.checked(cell)?;
        *self = Cells::blank(&self.tree, self.filter, self.tree.planes.len() + self.tree.bricks.len());
        self.begin();
        if cell.level == 0 || self.open == 0 {
            return Ok(());
        }
        self.universe = false;
        loop {
            let e = self.open - 1;
            let (index, planes) = self.path[e];
            let level = self.tree.cell_level(e);
            let todo = &mut self.todo[e];
            if cell.level < level {
                // One of the element's octants.
                let [x, y, z] = cell.at;
                let before = (1 << morton::index(2 * x, 2 * y, 2 * z)) - 1;
                (todo.octants, todo.cells) = (todo.octants & !before, todo.cells & !before);
                return Ok(());
            }
            let [x, y, z] = cell.ancestor(level).at;
            let c = morton::index(x, y, z);
            let octant = 1u64 << (c & !7);
            let is_split = planes.octant(c / 8) == Tag::Branch || level == 1;
            todo.cells &= !((1 << c) - 1);
            todo.octants &= !(octant - 1);
            if is_split {
                todo.octants &= !octant;
            }
            let goes_on = is_split && cell.level > level && planes.tag(c) == Tag::Branch;
            if !goes_on || todo.cells >> c & 1 == 0 {
                return Ok(());
            }
            if self.descend(e, index, planes, c, cell.ancestor(level)) == Tag::Partial {
                return Ok(());
            }
            self.todo[e].cells &= !(1 << c);
        }
    }

    /// Writes the next cells to the front of `cells`, and returns their number. The number is less than the
    /// length of `cells` only at the end.
    pub fn fill(&mut self, cells: &mut [TaggedCell]) -> usize {
        let mut free = cells.iter_mut();
        self.put(free.len(), move |found| {
            if let Some(cell) = free.next() {
                *cell = found;
            }
        })
    }

    /// Passes at most `most` cells to `put`, and returns their number.
    pub fn put(&mut self, most: usize, put: impl FnMut(TaggedCell)) -> usize {
        with_popcount(Put { cells: self, most, put })
    }
}

impl Iterator for Cells<'_> {
    type Item = TaggedCell;

    fn next(&mut self) -> Option<TaggedCell> {
        self.advance()
    }
}

/// A consumer of many cells at once.
struct Put<'c, 'a, P> {
    cells: &'c mut Cells<'a>,
    most: usize,
    put: P,
}

impl<P: FnMut(TaggedCell)> Hot for Put<'_, '_, P> {
    type Output = usize;

    #[inline(always)]
    fn run(self) -> usize {
        let Put { cells, most, mut put } = self;
        for count in 0..most {
            match cells.advance() {
                Some(found) => put(found),
                None => return count,
            }
        }
        most
    }
}

impl OctreeRef<'_> {
    /// Returns `cell`, if it lies in the universe of this tree and is not finer than the finest cells.
    pub(super) fn checked(&self, cell: Cell) -> Result<Cell, Error> {
        let inside = cell.level <= self.frame.depth() && cell.at.iter().all(|&a| a >> cell.level == 0);
        let problem = "lies outside of the universe, or is finer than the finest cells";
        if inside { Ok(cell) } else { Err(Error::Argument { name: "cell", problem }) }
    }
}
