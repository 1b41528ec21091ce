//! Sorted arrays of voxel records, and queries by code.

use super::code::{LinearCode, cell_of, number_of, size};
use super::record::{self, VoxelKind, VoxelRecord};
use super::{VoxelOptions, Voxels};
use crate::attribute::Attribute;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Cell, Frame, MAX_DEPTH};
use crate::memory;
use crate::octree::{OctreeRef, Proof, Tag};
use alloc::vec::Vec;
use core::ops::Range;

/// The records of voxels in four arrays, sorted by code; of two records with one code the larger voxel comes
/// first. A record takes 10 bytes, and 8 for each component of its value.
///
/// [`VoxelRecordsRef`] has all methods that read.
#[derive(Debug, Clone, PartialEq)]
pub struct VoxelRecords {
    pub(super) frame: Frame,
    pub(super) exterior: Tag,
    pub(super) proof: Proof,
    /// FULL or PARTIAL; see [`VoxelRecordsRef::boundary`].
    pub(super) boundary: Tag,
    pub(super) components: usize,
    pub(super) codes: Vec<u64>,
    pub(super) levels: Vec<u8>,
    pub(super) kinds: Vec<u8>,
    pub(super) values: Vec<f64>,
}

/// Borrowed records, with all methods that read.
///
/// The records lie in four arrays: the numbers of the [linear codes](LinearCode), levels, the numbers of the
/// [kinds](VoxelKind), and values. A record has as many numbers in the last array as the values have
/// components; a record without value has NaN in each. Records are sorted by code, and of two with one code
/// the coarser comes first. Voxels are disjoint, except that a [refined](VoxelKind::Refined) voxel is
/// followed by the voxels in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VoxelRecordsRef<'a> {
    frame: Frame,
    exterior: Tag,
    proof: Proof,
    boundary: Tag,
    components: usize,
    codes: &'a [u64],
    levels: &'a [u8],
    kinds: &'a [u8],
    values: &'a [f64],
}

impl VoxelRecords {
    /// The number of bytes of the arrays, with their spare capacity.
    pub fn bytes(&self) -> u64 {
        let VoxelRecords { codes, levels, kinds, values, .. } = self;
        let lists = memory::bytes_of(codes) + memory::bytes_of(levels) + memory::bytes_of(kinds);
        (lists + memory::bytes_of(values)) as u64
    }

    /// Makes an empty list on a lattice.
    pub(super) fn empty(frame: Frame, exterior: Tag, proof: Proof, components: usize) -> VoxelRecords {
        let (codes, levels, kinds, values) = Default::default();
        let boundary = Tag::Partial;
        VoxelRecords { frame, exterior, proof, boundary, components, codes, levels, kinds, values }
    }

    /// Lists the records of an octree's voxels. For any other solid, [build](crate::build) an octree first.
    /// O(records).
    ///
    /// # Errors
    /// [`Error::Argument`] and [`Error::Damaged`] as [`Voxels::new`]; the errors of the attribute;
    /// [`Error::OutOfMemory`]; and the errors that `control` causes: its limit of bytes applies to the
    /// arrays.
    pub fn of(
        tree: &OctreeRef<'_>,
        options: &VoxelOptions,
        attribute: Option<&dyn Attribute>,
        control: &Control<'_>,
    ) -> Result<VoxelRecords, Error> {
        let components = attribute.map_or(0, |attribute| attribute.components());
        let mut voxels = Voxels::new(tree, options, attribute)?;
        let mut records = VoxelRecords::empty(*voxels.frame(), tree.exterior(), tree.proof(), components);
        let each = records.bytes_each() as u64;
        if control.max_bytes.is_some() {
            control.afford("the records", voxels.least_records().saturating_mul(each))?;
        }
        loop {
            control.check()?;
            let batch = voxels.next_batch()?;
            if batch.is_empty() {
                break;
            }
            records.append(batch)?;
            let limit = control.max_bytes.filter(|&limit| records.codes.len() as u64 * each > limit);
            if let Some(limit) = limit {
                return Err(Error::Limit { what: "bytes", limit });
            }
            if let Some(progress) = control.progress {
                progress(voxels.progress());
            }
        }
        if let Some(progress) = control.progress {
            progress(1.0);
        }
        if voxels.boundary_is_inside() {
            records.boundary = Tag::Full;
        }
        Ok(records)
    }

    /// Makes records from arrays, which [`VoxelRecordsRef`] describes. The exterior and the tag of boundary
    /// voxels are unknown, and nothing is proven, until [`with_exterior`](Self::with_exterior) and
    /// [`with_boundary`](Self::with_boundary) set them.
    ///
    /// # Errors
    /// As [`VoxelRecordsRef::new`].
    pub fn from_arrays(
        frame: &Frame,
        codes: Vec<u64>,
        levels: Vec<u8>,
        kinds: Vec<u8>,
        components: usize,
        values: Vec<f64>,
    ) -> Result<VoxelRecords, Error> {
        let checked = VoxelRecordsRef::new(frame, &codes, &levels, &kinds, components, &values)?;
        let VoxelRecordsRef { exterior, proof, boundary, .. } = checked;
        Ok(VoxelRecords {
            frame: *frame,
            exterior,
            proof,
            boundary,
            components,
            codes,
            levels,
            kinds,
            values,
        })
    }

    /// Sets the tag of the space outside the universe (BRANCH counts as PARTIAL), and what the voxels prove
    /// ([`VoxelRecordsRef::proof`]). Only a complete list may claim that EMPTY is proven. A program that
    /// drops or changes records of a solid must withdraw that claim.
    #[must_use]
    pub fn with_exterior(self, exterior: Tag, proof: Proof) -> VoxelRecords {
        let exterior = if exterior == Tag::Branch { Tag::Partial } else { exterior };
        VoxelRecords { exterior, proof, ..self }
    }

    /// Sets the tag of boundary voxels: FULL if each of them lies inside. Any other tag means unknown.
    #[must_use]
    pub fn with_boundary(self, boundary: Tag) -> VoxelRecords {
        let boundary = if boundary == Tag::Full { Tag::Full } else { Tag::Partial };
        VoxelRecords { boundary, ..self }
    }

    /// Borrows the records.
    pub fn view(&self) -> VoxelRecordsRef<'_> {
        VoxelRecordsRef {
            frame: self.frame,
            exterior: self.exterior,
            proof: self.proof,
            boundary: self.boundary,
            components: self.components,
            codes: &self.codes,
            levels: &self.levels,
            kinds: &self.kinds,
            values: &self.values,
        }
    }

    /// The number of bytes of a record.
    pub fn bytes_each(&self) -> usize {
        size_of::<u64>() + 2 + self.components * size_of::<f64>()
    }

    /// Reserves room for `count` more records.
    pub(super) fn reserve(&mut self, count: usize) -> Result<(), Error> {
        self.codes.try_reserve(count)?;
        self.levels.try_reserve(count)?;
        self.kinds.try_reserve(count)?;
        Ok(self.values.try_reserve(count.saturating_mul(self.components))?)
    }

    fn append(&mut self, batch: &[VoxelRecord]) -> Result<(), Error> {
        self.reserve(batch.len())?;
        for record in batch {
            self.push(record.cell, record.kind, |component| {
                record.value.map_or(f64::NAN, |value| value[component])
            })?;
        }
        Ok(())
    }

    /// Appends a record, whose cell must come after all others.
    pub(super) fn push(
        &mut self,
        cell: Cell,
        kind: VoxelKind,
        value: impl Fn(usize) -> f64,
    ) -> Result<(), Error> {
        self.reserve(1)?;
        self.codes.push(number_of(cell, self.frame.depth()));
        self.levels.push(cell.level);
        self.kinds.push(kind as u8);
        self.values.extend((0..self.components).map(value));
        Ok(())
    }
}

impl<'a> VoxelRecordsRef<'a> {
    /// Makes records from borrowed arrays. O(records).
    ///
    /// # Errors
    /// [`Error::Argument`] if the lengths of the arrays differ (for the values, times `components`, 0 to 4),
    /// if a level exceeds the frame's depth, if a code is not one of its level, if a kind is invalid, or if
    /// records are out of order or overlap.
    pub fn new(
        frame: &Frame,
        codes: &'a [u64],
        levels: &'a [u8],
        kinds: &'a [u8],
        components: usize,
        values: &'a [f64],
    ) -> Result<VoxelRecordsRef<'a>, Error> {
        let refused = |name, problem| Err(Error::Argument { name, problem });
        let count = codes.len();
        if components > 4 {
            return refused("components", "must be 0 to 4");
        }
        if levels.len() != count
            || kinds.len() != count
            || count.checked_mul(components) != Some(values.len())
        {
            return refused("records", "the arrays must be of one length");
        }
        // The end of the last voxel that is not refined, and the last record.
        let (mut end, mut last) = (0, None);
        for ((&code, &level), &kind) in codes.iter().zip(levels).zip(kinds) {
            LinearCode::from_number(code, level, frame.depth())?;
            let kind = VoxelKind::from_number(kind)?;
            if code < end || last.is_some_and(|last| (code, level) <= last) {
                return refused("codes", "must ascend, and voxels must not overlap");
            }
            last = Some((code, level));
            end = if kind == VoxelKind::Refined { code } else { code + size(level, frame.depth()) };
        }
        Ok(VoxelRecordsRef {
            frame: *frame,
            exterior: Tag::Partial,
            proof: Proof::new(false, false),
            boundary: Tag::Partial,
            components,
            codes,
            levels,
            kinds,
            values,
        })
    }

    /// Makes records without values and without checks. If the arrays are not valid records, the results of
    /// queries are meaningless. The arrays must have one length.
    #[doc(hidden)]
    pub fn unchecked(
        frame: &Frame,
        codes: &'a [u64],
        levels: &'a [u8],
        kinds: &'a [u8],
    ) -> VoxelRecordsRef<'a> {
        VoxelRecordsRef {
            frame: *frame,
            exterior: Tag::Partial,
            proof: Proof::new(false, false),
            boundary: Tag::Partial,
            components: 0,
            codes,
            levels,
            kinds,
            values: &[],
        }
    }

    /// The lattice.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The state of the space outside the universe.
    pub fn exterior(&self) -> Tag {
        self.exterior
    }

    /// What the voxels prove about the solid that they were made from. FULL is proven if inside voxels are
    /// proven to lie in the solid. EMPTY is proven if outside voxels **and all space without records** are
    /// proven to lie outside; so the list is complete. For boundary voxels, nothing is proven beyond
    /// [`boundary`](Self::boundary).
    ///
    /// The records of an octree prove what its cells do. So do their images under symmetries and [exact
    /// placements](Self::placed_exactly). Records that were [sampled](Self::placed_by_centres), and records
    /// from arrays, prove nothing.
    pub fn proof(&self) -> Proof {
        self.proof
    }

    /// The tag of boundary voxels: FULL if each of them lies inside as inside voxels do, otherwise PARTIAL.
    /// It is FULL for the records of a binary octree, whose boundary voxels are inside cells that
    /// [touch](crate::voxel::VoxelBoundary::Touching) an outside one. The exception is a boundary level above
    /// the octree's depth, because cells that are cut become boundary voxels, too.
    pub fn boundary(&self) -> Tag {
        self.boundary
    }

    /// The number of records.
    pub fn len(&self) -> usize {
        self.codes.len()
    }

    /// Returns whether there are no records.
    pub fn is_empty(&self) -> bool {
        self.codes.is_empty()
    }

    /// The number of components of a value; 0 if the records have no values.
    pub fn components(&self) -> usize {
        self.components
    }

    /// The numbers of the linear codes.
    pub fn codes(&self) -> &'a [u64] {
        self.codes
    }

    /// The levels.
    pub fn levels(&self) -> &'a [u8] {
        self.levels
    }

    /// The numbers of the kinds.
    pub fn kinds(&self) -> &'a [u8] {
        self.kinds
    }

    /// The values, [`components`](Self::components) numbers a record; NaN where there is no value.
    pub fn values(&self) -> &'a [f64] {
        self.values
    }

    /// The number of records of a kind. O(n).
    pub fn count(&self, kind: VoxelKind) -> u64 {
        self.kinds.iter().filter(|&&number| number == kind as u8).count() as u64
    }

    /// The kind of the record at a valid index.
    pub(crate) fn kind_at(&self, index: usize) -> VoxelKind {
        VoxelKind::ALL[self.kinds[index] as usize & 3]
    }

    /// The cell of the record at a valid index.
    pub(crate) fn cell_at(&self, index: usize) -> Cell {
        cell_of(self.codes[index], self.levels[index], self.frame.depth())
    }

    /// The numbers of a record's value.
    pub(crate) fn numbers_at(&self, index: usize) -> &'a [f64] {
        &self.values[index * self.components..][..self.components]
    }

    /// The record with this index.
    pub fn get(&self, index: usize) -> Option<VoxelRecord> {
        if index >= self.len() {
            return None;
        }
        let numbers = self.numbers_at(index);
        let known = !numbers.is_empty() && !numbers.iter().all(|number| number.is_nan());
        let mut value = [0.0; 4];
        value[..numbers.len()].copy_from_slice(numbers);
        let (kind, cell) = (self.kind_at(index), self.cell_at(index));
        Some(VoxelRecord { kind, cell, value: known.then_some(value) })
    }

    /// All records, in their order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = VoxelRecord> + use<'a> {
        let records = *self;
        (0..self.len()).map(move |index| {
            records.get(index).unwrap_or_else(|| unreachable!("the index is below the length"))
        })
    }

    /// The linear code of a record.
    pub fn code(&self, index: usize) -> Option<LinearCode> {
        let cell = (index < self.len()).then(|| self.cell_at(index))?;
        LinearCode::new(cell, self.frame.depth()).ok()
    }

    /// The minimum corner of a voxel in model units; rounded down if it is no double.
    pub fn corner(&self, index: usize) -> Option<[f64; 3]> {
        (index < self.len()).then(|| record::corner(&self.frame, self.cell_at(index)))
    }

    /// The edge of a voxel in model units, exact.
    pub fn edge(&self, index: usize) -> Option<f64> {
        self.levels.get(index).map(|&level| record::edge(&self.frame, level))
    }

    /// The index of the record of exactly this cell. O(log n).
    pub fn find(&self, cell: Cell) -> Option<usize> {
        let code = LinearCode::new(cell, self.frame.depth()).ok()?;
        let key = (code.number(), cell.level);
        let first = self.lower_bound(key.0);
        // There are no more records with one code than levels.
        let found = (first..self.len()).take_while(|&index| self.codes[index] == key.0);
        found.into_iter().find(|&index| self.levels[index] == cell.level)
    }

    /// The range of the records of the cells in `cell`, its own included. O(log n).
    pub fn within(&self, cell: Cell) -> Range<usize> {
        let Ok(code) = LinearCode::new(cell, self.frame.depth()) else { return 0..0 };
        let start = self.lower_bound(code.number());
        let larger = (start..self.len())
            .take_while(|&index| self.codes[index] == code.number() && self.levels[index] < cell.level);
        start + larger.count()..self.lower_bound(code.number() + size(cell.level, self.frame.depth()))
    }

    /// For each octant of `cell`, the range of the records in it: the children of a refined voxel, or, if a
    /// child is refined further, the voxels that it consists of. Empty for a cell that does not belong to the
    /// lattice. O(log n).
    pub fn children(&self, cell: Cell) -> [Range<usize>; 8] {
        let is_split = cell.level < self.frame.depth() && LinearCode::new(cell, self.frame.depth()).is_ok();
        core::array::from_fn(|octant| if is_split { self.within(cell.child(octant as u8)) } else { 0..0 })
    }

    /// The index of the record that contains a cell, which may be finer than the lattice. Refined voxels do
    /// not count. O(log n).
    pub fn containing(&self, cell: Cell) -> Option<usize> {
        let depth = self.frame.depth();
        let finer = (depth + 1..=MAX_DEPTH).contains(&cell.level);
        let inside = finer && cell.at.iter().all(|&a| a >> cell.level == 0);
        let cell = if inside { cell.ancestor(depth) } else { cell };
        let code = LinearCode::new(cell, self.frame.depth()).ok()?;
        let (number, level) = (code.number(), cell.level);
        let after = self.codes.partition_point(|&code| code <= number);
        // The records of smaller cells at the same corner come last.
        let index =
            (0..after).rev().find(|&index| (self.codes[index], self.levels[index]) <= (number, level))?;
        let end = self.codes[index].saturating_add(size(self.levels[index].min(depth), depth));
        (number < end && self.kind_at(index) != VoxelKind::Refined).then_some(index)
    }

    /// The index of the record that contains a point (model units). Refined voxels do not count. A point on a
    /// face between voxels belongs to the upper one. O(log n).
    pub fn at(&self, point: [f64; 3]) -> Option<usize> {
        let at = self.frame.cell_of(point)?;
        self.containing(Cell { level: self.frame.depth(), at })
    }

    /// The index of the first record whose code is at least `number`.
    fn lower_bound(&self, number: u64) -> usize {
        self.codes.partition_point(|&code| code < number)
    }
}
