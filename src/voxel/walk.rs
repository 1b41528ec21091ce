//! Enumerates the voxels of a stored octree one after another.

use super::options::VoxelOptions;
use super::record::{VoxelKind, centre, edge};
use super::{VoxelRecord, code};
use crate::attribute::{Attribute, ValueRange};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Bounds, Cell, Cube, Frame};
use crate::octree::{CellFilter, Cells, Direction, OctreeRef, Tag};

/// The attribute that stands for none.
struct Nothing;

impl Attribute for Nothing {
    fn components(&self) -> usize {
        1
    }

    fn values(&self, _: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        values.fill(None);
        Ok(())
    }

    fn range(&self, _: &Bounds) -> Result<ValueRange, Error> {
        Ok(ValueRange::Nowhere)
    }
}

/// An inside cell of the octree, and the position in the traversal of the voxels that it is split into.
#[derive(Clone)]
struct Inside {
    root: Cell,
    at: Cell,
    /// The level of the ancestor, or of the cell itself, that is known to touch no outside cell; `u8::MAX` if
    /// none is known.
    quiet: u8,
}

impl Inside {
    /// Moves to the next cell after the current one; `None` after the last.
    fn advance(&mut self) -> Option<()> {
        while self.at.level > self.root.level && self.at.octant() == 7 {
            self.at = self.at.parent();
        }
        if self.at.level == self.root.level {
            return None;
        }
        let next = self.at.octant() + 1;
        self.at = self.at.parent().child(next);
        if self.at.level <= self.quiet {
            self.quiet = u8::MAX;
        }
        Some(())
    }
}

/// Cells and their kinds, in the order of their codes, without values.
#[derive(Clone)]
pub(super) struct Walk<'a> {
    tree: OctreeRef<'a>,
    options: VoxelOptions,
    attribute: &'a dyn Attribute,
    frame: Frame,
    boundary_level: u8,
    cells: Cells<'a>,
    inside: Option<Inside>,
    /// Whether all boundary voxels so far are inside cells.
    boundary_is_inside: bool,
}

impl<'a> Walk<'a> {
    pub(super) fn new(
        tree: &OctreeRef<'a>,
        options: &VoxelOptions,
        attribute: Option<&'a dyn Attribute>,
    ) -> Result<Walk<'a>, Error> {
        if options.touching() {
            // The walk looks beside every cell, and a descent remembers nothing: elements with shared
            // children would be visited again and again.
            tree.ensure_links()?;
        }
        let boundary_level = options.boundary_level(tree);
        let all = CellFilter::tags(&[Tag::Empty, Tag::Full, Tag::Partial, Tag::Branch]);
        Ok(Walk {
            tree: *tree,
            options: *options,
            attribute: attribute.unwrap_or(&Nothing),
            frame: options.frame(tree)?,
            boundary_level,
            cells: tree.cells(all.levels(0..=boundary_level)),
            inside: None,
            boundary_is_inside: true,
        })
    }

    pub(super) fn frame(&self) -> &Frame {
        &self.frame
    }

    /// A lower bound of the number of voxels: undecided cells, the parts into which inside cells are split
    /// for their size, and voxels at faces to outside cells. O(elements).
    fn least(&self) -> u64 {
        let (level, touching) = (self.boundary_level, self.options.touching());
        // The level to which inside cells are split for their size.
        let coarse = self.options.how_fine().map_or(0, |detail| {
            let is_small = |&level: &u8| edge(&self.frame, level) <= detail.coarse();
            (0..=self.frame.depth()).find(is_small).unwrap_or(self.frame.depth())
        });
        // (The level counts of a mapped file may be wrong.)
        let counts = self.tree.count_levels();
        // The number of inside cells if they are split to a level, each counted at least once.
        let split = |to: u8| {
            counts.iter().zip(0..=level).fold(0u64, |sum, (count, own)| {
                sum.saturating_add(count.full.saturating_mul(1 << (3 * u32::from(to.saturating_sub(own)))))
            })
        };
        let cut = counts.get(usize::from(level)).map_or(0, |count| count.nodes);
        let undecided = counts
            .iter()
            .take(usize::from(level) + 1)
            .fold(cut, |sum, count| sum.saturating_add(count.partial));
        if !touching {
            return undecided.saturating_add(split(coarse));
        }
        let mut faces = [0u64; 6];
        for face in self.tree.boundary_faces(CellFilter::tags(&[Tag::Full]).levels(0..=level)) {
            let smaller = face.smaller().level;
            let is_outside = face.outer.map_or(self.tree.exterior(), |outer| outer.tag) == Tag::Empty;
            if is_outside && smaller <= level {
                let way = Direction::FACES.iter().position(|&way| way == face.direction).unwrap_or(0);
                faces[way] = faces[way].saturating_add(1 << (2 * (level - smaller)));
            }
        }
        // A voxel has one face in each direction. Voxels without such faces are only as small as their size
        // requires.
        let at_faces = faces.into_iter().fold(0, u64::max);
        let inner = split(level).saturating_sub(faces.into_iter().fold(0, u64::saturating_add));
        let inner = inner.saturating_mul(1 << (3 * u32::from(coarse.saturating_sub(level))));
        let inner = if coarse > level { at_faces.saturating_add(inner) } else { split(coarse).max(at_faces) };
        undecided.saturating_add(inner)
    }

    /// The share of the universe before a cell.
    pub(super) fn progress(&self, cell: Cell) -> f64 {
        let depth = self.frame.depth();
        code::number_of(cell, depth) as f64 / code::size(0, depth) as f64
    }

    /// Returns the next voxel.
    pub(super) fn next(&mut self) -> Result<Option<(VoxelKind, Cell)>, Error> {
        loop {
            if let Some(mut inside) = self.inside.take() {
                let cell = inside.at;
                let kind = self.kind(&mut inside)?;
                if kind == VoxelKind::Refined {
                    inside.at = cell.child(0);
                    self.inside = Some(inside);
                    if !self.options.lists_refined() {
                        continue;
                    }
                } else {
                    self.inside = inside.advance().map(|()| inside);
                }
                return Ok(Some((kind, cell)));
            }
            let Some(found) = self.cells.next() else { return Ok(None) };
            let cell = found.cell;
            let kind = match found.tag {
                Tag::Empty if self.options.lists_outside() => VoxelKind::Outside,
                Tag::Empty => continue,
                Tag::Full => {
                    self.inside = Some(Inside { root: cell, at: cell, quiet: u8::MAX });
                    continue;
                }
                Tag::Partial => VoxelKind::Boundary,
                Tag::Branch if cell.level == self.boundary_level => VoxelKind::Boundary,
                Tag::Branch if self.options.lists_refined() => VoxelKind::Refined,
                Tag::Branch => continue,
            };
            self.boundary_is_inside &= kind != VoxelKind::Boundary;
            return Ok(Some((kind, cell)));
        }
    }

    /// The kind of the current cell of an inside cell.
    fn kind(&self, inside: &mut Inside) -> Result<VoxelKind, Error> {
        let cell = inside.at;
        if self.options.touching() && inside.quiet == u8::MAX {
            if self.touches(cell) {
                let finest = cell.level == self.boundary_level;
                return Ok(if finest { VoxelKind::Boundary } else { VoxelKind::Refined });
            }
            inside.quiet = cell.level;
        }
        let fine = match self.options.how_fine() {
            Some(detail) if cell.level < self.frame.depth() => {
                let (min, max) = Cube { frame: &self.frame, cell }.bounds();
                let bounds = Bounds { min, max };
                detail.is_fine(self.attribute, &bounds, edge(&self.frame, cell.level))?
            }
            _ => true,
        };
        Ok(if fine { VoxelKind::Inside } else { VoxelKind::Refined })
    }

    /// Returns whether a face of an inside cell, not below the boundary level, touches an outside cell.
    fn touches(&self, cell: Cell) -> bool {
        let cells = self.tree.frame().cells();
        let shift = self.tree.frame().depth() - cell.level;
        let (min, max) = (cell.at.each(|a| a << shift), cell.at.each(|a| (a + 1) << shift));
        let outside = CellFilter::tags(&[Tag::Empty]).levels(0..=self.boundary_level);
        let any = |min, max| self.tree.cells(outside.within(min, max)).next().is_some();
        let at_end = (0..3).any(|axis| min[axis] == 0 || max[axis] == cells);
        if at_end && self.tree.exterior() == Tag::Empty {
            return true;
        }
        // Most cells have no outside cells around them.
        if !any(min.each(|a| a.saturating_sub(1)), max.each(|a| a + 1)) {
            return false;
        }
        (0..3).any(|axis| {
            let (mut low, mut high) = ((min, max), (min, max));
            (low.0[axis], low.1[axis]) = (min[axis].saturating_sub(1), min[axis]);
            (high.0[axis], high.1[axis]) = (max[axis], max[axis] + 1);
            (min[axis] > 0 && any(low.0, low.1)) || (max[axis] < cells && any(high.0, high.1))
        })
    }
}

/// The number of records whose values are queried at once.
const BATCH: usize = 64;

/// The records of an octree's voxels one after another, in the order of their codes. [`VoxelOptions`] chooses
/// the voxels; [`VoxelRecords::of`](crate::voxel::VoxelRecords::of) lists all at once.
///
/// The iterator ends after an error.
pub struct Voxels<'a> {
    walk: Walk<'a>,
    attribute: Option<&'a dyn Attribute>,
    batch: [VoxelRecord; BATCH],
    next: usize,
    filled: usize,
    ended: bool,
}

impl<'a> Voxels<'a> {
    /// Starts at the first voxel of a stored octree, with an attribute's values at the centres. Needs no
    /// allocation.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Rule, build, voxel::{VoxelKind, VoxelOptions, Voxels}};
    /// let frame = Frame::new([0.0; 3], 4.0, 2)?;
    /// let bar = build(&Csg::cuboid([0.0; 3], [3.0, 1.0, 1.0])?, &frame, Rule::Certified, &Control::default())?;
    /// let mut inside = 0;
    /// for record in Voxels::new(bar.view(), &VoxelOptions::new(), None)? {
    ///     inside += (record?.kind == VoxelKind::Inside) as u32;
    /// }
    /// assert_eq!(inside, 3);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] if the detail's fine limit is below the edge of a cell of level 20
    /// ([`VoxelOptions::frame`]); [`Error::Damaged`] if the options need neighbours of cells and links of the
    /// tree are damaged. (Otherwise damage reads as boundary voxels.) Items are errors if the attribute
    /// returns one.
    pub fn new(
        tree: &OctreeRef<'a>,
        options: &VoxelOptions,
        attribute: Option<&'a dyn Attribute>,
    ) -> Result<Voxels<'a>, Error> {
        let blank = VoxelRecord { kind: VoxelKind::Outside, cell: Cell::ROOT, value: None };
        let walk = Walk::new(tree, options, attribute)?;
        Ok(Voxels { walk, attribute, batch: [blank; BATCH], next: 0, filled: 0, ended: false })
    }

    /// The lattice of the records.
    pub fn frame(&self) -> &Frame {
        self.walk.frame()
    }

    /// Counts the records that are still to come, in a pass that reads no values. O(records).
    ///
    /// # Errors
    /// Those of the attribute.
    pub fn count_records(&self) -> Result<u64, Error> {
        let mut walk = self.walk.clone();
        let mut count = (self.filled - self.next) as u64;
        while !self.ended && walk.next()?.is_some() {
            count += 1;
        }
        Ok(count)
    }

    /// A lower bound of the number of records, without visiting each. O(elements).
    pub(super) fn least_records(&self) -> u64 {
        self.walk.least()
    }

    /// Returns whether all boundary voxels so far are inside cells, which touch outside ones.
    pub(super) fn boundary_is_inside(&self) -> bool {
        self.walk.boundary_is_inside
    }

    /// The share of the universe that was enumerated.
    pub(super) fn progress(&self) -> f64 {
        self.batch[..self.filled].last().map_or(0.0, |record| self.walk.progress(record.cell))
    }

    /// Returns the next records; an empty slice at the end.
    pub(super) fn next_batch(&mut self) -> Result<&[VoxelRecord], Error> {
        if self.next == self.filled {
            self.refill()?;
        }
        let next = core::mem::replace(&mut self.next, self.filled);
        Ok(&self.batch[next..self.filled])
    }

    fn refill(&mut self) -> Result<(), Error> {
        (self.next, self.filled) = (0, 0);
        let mut filled = 0;
        while filled < BATCH && !self.ended {
            // If this fails, the iteration has ended.
            self.ended = true;
            if let Some((kind, cell)) = self.walk.next()? {
                self.batch[filled] = VoxelRecord { kind, cell, value: None };
                (filled, self.ended) = (filled + 1, false);
            }
        }
        if let Some(attribute) = self.attribute.filter(|_| filled > 0) {
            let (mut points, mut values) = ([[0.0; 3]; BATCH], [None; BATCH]);
            for (point, record) in points.iter_mut().zip(&self.batch[..filled]) {
                *point = centre(self.walk.frame(), record.cell);
            }
            if let Err(error) = attribute.values(&points[..filled], &mut values[..filled]) {
                self.ended = true;
                return Err(error);
            }
            for (record, value) in self.batch[..filled].iter_mut().zip(values) {
                record.value = value;
            }
        }
        self.filled = filled;
        Ok(())
    }
}

impl Iterator for Voxels<'_> {
    type Item = Result<VoxelRecord, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.next == self.filled
            && let Err(error) = self.refill()
        {
            return Some(Err(error));
        }
        let record = *self.batch[..self.filled].get(self.next)?;
        self.next += 1;
        Some(Ok(record))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attribute::Detail;
    use crate::control::Control;
    use crate::op::{Rule, build};
    use crate::solid::Csg;

    #[test]
    fn no_fewer_voxels_are_told_than_beforehand() {
        let (frame, control) = (Frame::new([-1.0; 3], 2.0, 5).unwrap(), Control::default());
        let ball = Csg::ball([0.1, 0.0, 0.2], 0.8).unwrap();
        let block = Csg::cuboid([-1.0; 3], [0.25, 0.5, 0.75]).unwrap();
        for (solid, rule) in [
            (&ball, Rule::Certified),
            (&ball, Rule::Sampled),
            (&block, Rule::Certified),
            (&ball.complement(), Rule::Sampled),
        ] {
            let tree = build(solid, &frame, rule, &control).unwrap();
            for depth in 0..=5 {
                for touching in [false, true] {
                    for detail in [None, Some(0.3), Some(0.01)] {
                        let mut options = VoxelOptions::new().boundary_depth(depth);
                        if touching {
                            options = options.boundary(super::super::VoxelBoundary::Touching);
                        }
                        if let Some(edge) = detail {
                            options = options.detail(Detail::uniform(edge).unwrap());
                        }
                        let voxels = Voxels::new(tree.view(), &options, None).unwrap();
                        let (least, all) = (voxels.least_records(), voxels.count_records().unwrap());
                        assert!(least <= all, "{rule:?} {options:?}: {least} of {all}");
                        // The bound includes most cells at the surface, and cells that are split for their
                        // size.
                        if touching && depth == 5 || !touching && detail == Some(0.01) {
                            assert!(12 * least >= all, "{rule:?} {options:?}: {least} of {all}");
                        }
                    }
                }
            }
        }
    }
}
