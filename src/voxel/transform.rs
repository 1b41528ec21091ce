//! Moves records: exactly where cells are the images of cells, by their centres otherwise.

use super::code::size;
use super::record::{VoxelKind, centre};
use super::records::{VoxelRecords, VoxelRecordsRef};
use super::symmetry::Symmetry;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sign_of_sum;
use crate::lattice::{Affine, Cell, Frame};
use crate::octree::{Proof, Tag};

impl VoxelRecordsRef<'_> {
    /// The records under a symmetry about the centre of their universe. Exact, and sorted without comparing
    /// records: the octants of each cell are taken in the order of their images. O(n · levels).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], [`Error::Cancelled`].
    pub fn turned(&self, symmetry: Symmetry, control: &Control<'_>) -> Result<VoxelRecords, Error> {
        self.turned_into(symmetry, *self.frame(), control)
    }

    fn turned_into(
        &self,
        symmetry: Symmetry,
        frame: Frame,
        control: &Control<'_>,
    ) -> Result<VoxelRecords, Error> {
        let depth = self.frame().depth();
        let images: [u8; 8] = core::array::from_fn(|old| symmetry.octant(old as u8));
        let mut order = [0; 8];
        (0u8..).zip(images).for_each(|(old, new)| order[new as usize] = old);
        let mut turned = VoxelRecords::empty(frame, self.exterior(), self.proof(), self.components());
        turned.boundary = self.boundary();
        turned.reserve(self.len())?;
        let mut put = |index: usize| {
            if turned.codes.len().is_multiple_of(4096) {
                control.check()?;
            }
            let level = self.levels()[index];
            // One digit after the other.
            let digits = (depth - level..depth).map(|place| 3 * place);
            let code = self.codes()[index];
            let image = digits
                .fold(0, |image, place| image | u64::from(images[(code >> place & 7) as usize]) << place);
            turned.codes.push(image);
            turned.levels.push(level);
            turned.kinds.push(self.kinds()[index]);
            turned.values.extend_from_slice(self.numbers_at(index));
            Ok(())
        };
        self.visit(&self.whole(), &|_| order, &mut put)?;
        Ok(turned)
    }

    /// The records under a map that takes cells to cells: one of the 48 symmetries, a scale by a power of
    /// two, and any translation. The universe moves along, and nothing is rounded. O(n · levels).
    ///
    /// # Errors
    /// [`Error::Argument`] if the map has another form, or if the image of the universe is not a valid frame:
    /// its corner is no double, or its edge is out of range. [`Error::OutOfMemory`], [`Error::Cancelled`].
    pub fn placed_exactly(&self, placement: &Affine, control: &Control<'_>) -> Result<VoxelRecords, Error> {
        let refused = |problem| Error::Argument { name: "placement", problem };
        let (symmetry, scale) = Symmetry::of(placement)
            .ok_or(refused("must permute and mirror axes, and scale by a power of two"))?;
        let frame = self.frame();
        let mut origin = [0.0; 3];
        for axis in 0..3 {
            let from = frame.origin()[symmetry.axes()[axis] as usize];
            // The corner that becomes the lower one, as a sum of exact terms.
            let moved = placement.rows()[axis][3];
            let terms = match symmetry.flipped()[axis] {
                false => [scale * from, 0.0, moved],
                true => [-scale * from, -scale * frame.edge(), moved],
            };
            let near = (terms[0] + terms[1]) + terms[2];
            // The sum may have been rounded twice.
            let exact = |x: &f64| sign_of_sum(&[terms[0], terms[1], terms[2], -x]) == 0;
            let found = [near, near.next_down(), near.next_up()].into_iter().find(exact);
            origin[axis] = found
                .ok_or(refused("moves the corner of the universe to coordinates that are no doubles"))?;
        }
        let image = Frame::new(origin, scale * frame.edge(), frame.depth())?;
        self.turned_into(symmetry, image, control)
    }

    /// The records under any affine map, on the lattice of any frame, by the centres of its finest cells. The
    /// preimage of such a centre, computed in doubles, lies in a record or in none. The cell has the kind and
    /// the value of that record; without a record it has none. Equal cells merge, except boundary voxels.
    /// Refined voxels are left out.
    ///
    /// This is sampling: nothing is proven about the result, and voxels that are thinner than a cell may
    /// vanish. Parts beyond the frame are cut off. O(cells next to faces between records · log n).
    ///
    /// # Errors
    /// [`Error::Argument`] if the inverse of the map cannot be computed in doubles; [`Error::OutOfMemory`],
    /// and the errors that `control` causes: its limit of bytes applies to the arrays.
    pub fn placed_by_centres(
        &self,
        placement: &Affine,
        frame: &Frame,
        control: &Control<'_>,
    ) -> Result<VoxelRecords, Error> {
        let exterior = if self.exterior() == Tag::Full { Tag::Full } else { Tag::Partial };
        let records = VoxelRecords::empty(*frame, exterior, Proof::new(false, false), self.components());
        let inverse = inverse(placement)?;
        let mut sampler = Sampler { from: *self, placement, inverse, frame, records, control, asked: 0 };
        sampler.fill(Cell::ROOT)?;
        Ok(sampler.records)
    }
}

/// The state of sampling records by centres.
struct Sampler<'r, 'a, 'c> {
    from: VoxelRecordsRef<'a>,
    placement: &'r Affine,
    inverse: [[f64; 3]; 3],
    frame: &'r Frame,
    records: VoxelRecords,
    control: &'r Control<'c>,
    asked: u32,
}

/// The records that contain the centres in a cell.
enum Known {
    /// All centres lie in one record, or in none.
    One(Option<usize>),
    Unknown,
}

impl Sampler<'_, '_, '_> {
    /// A box around the preimages of all finest centres in a cell, as they are computed. Each summand of a
    /// sum is taken at its least, or greatest, value, and rounding is monotonic.
    fn preimages(&self, cell: Cell) -> ([f64; 3], [f64; 3]) {
        let depth = self.frame.depth();
        let finest = |at: [u32; 3]| centre(self.frame, Cell { level: depth, at });
        let shift = depth - cell.level;
        let first = finest(cell.at.each(|c| c << shift));
        let last = finest(cell.at.each(|c| (c << shift) + ((1 << shift) - 1)));
        let rows = self.placement.rows();
        let sum = |row: &[f64; 3], low: [f64; 3], high: [f64; 3]| {
            let summand = |k: usize| row[k] * (if row[k] >= 0.0 { low } else { high }[k] - rows[k][3]);
            summand(0) + summand(1) + summand(2)
        };
        (self.inverse.each(|row| sum(&row, first, last)), self.inverse.each(|row| sum(&row, last, first)))
    }

    fn look(&self, cell: Cell) -> Known {
        let own = self.from.frame();
        let (low, high) = self.preimages(cell);
        let (mut first, mut last, mut beyond) = ([0; 3], [own.cells() - 1; 3], false);
        for axis in 0..3 {
            let half = own.origin()[axis] + 0.5 * own.edge();
            match (own.cell_at(axis, low[axis]), own.cell_at(axis, high[axis])) {
                (None, None) if (low[axis] < half) == (high[axis] < half) => return Known::One(None),
                (from, to) => {
                    beyond |= from.is_none() || to.is_none();
                    first[axis] = from.unwrap_or(first[axis]);
                    last[axis] = to.unwrap_or(last[axis]);
                }
            }
        }
        let differ = (0..3).fold(0, |bits, axis| bits | (first[axis] ^ last[axis]));
        let level = own.depth() - (32 - differ.leading_zeros()) as u8;
        let around = Cell { level, at: first.each(|a| a >> (own.depth() - level)) };
        match self.from.containing(around) {
            Some(index) if !beyond => Known::One(Some(index)),
            _ => self.from.uniform(first, last, beyond).map_or(Known::Unknown, Known::One),
        }
    }

    fn fill(&mut self, cell: Cell) -> Result<(), Error> {
        self.asked = self.asked.wrapping_add(1);
        if self.asked.is_multiple_of(1024) {
            self.control.check()?;
            let bytes = (self.records.codes.len() * self.records.bytes_each()) as u64;
            if let Some(limit) = self.control.max_bytes.filter(|&limit| bytes > limit) {
                return Err(Error::Limit { what: "bytes", limit });
            }
        }
        match self.look(cell) {
            Known::One(None) => Ok(()),
            Known::One(Some(index)) => {
                let numbers = self.from.numbers_at(index);
                self.records.push(cell, self.from.kind_at(index), |component| numbers[component])
            }
            Known::Unknown => {
                let start = self.records.codes.len();
                for octant in 0..8 {
                    self.fill(cell.child(octant))?;
                }
                self.records.merge(start, cell);
                Ok(())
            }
        }
    }
}

impl VoxelRecords {
    /// Merges the records from `start` on, if they are the eight octants of `cell` and equal.
    fn merge(&mut self, start: usize, cell: Cell) {
        let kind = self.kinds.get(start).copied();
        let whole = self.codes.len() == start + 8
            && self.levels[start..].iter().all(|&level| level == cell.level + 1)
            && self.kinds[start..].iter().all(|&other| Some(other) == kind)
            && kind != Some(VoxelKind::Boundary as u8);
        let components = self.components;
        let values = &self.values[start * components..];
        let bits = |k: usize| values[k].to_bits();
        if !whole || (components..values.len()).any(|k| bits(k) != bits(k % components)) {
            return;
        }
        self.codes.truncate(start + 1);
        self.levels.truncate(start + 1);
        self.kinds.truncate(start + 1);
        self.values.truncate((start + 1) * components);
        self.levels[start] = cell.level;
        debug_assert_eq!(self.codes[start] & (size(cell.level, self.frame.depth()) - 1), 0);
    }
}

/// The inverse of a map's matrix, rounded. An error if the matrix is so nearly singular that rounding leaves
/// no inverse.
fn inverse(map: &Affine) -> Result<[[f64; 3]; 3], Error> {
    let m = map.rows();
    let minor = |i: usize, j: usize| {
        let ([a, b], [c, d]) = ([(i + 1) % 3, (i + 2) % 3], [(j + 1) % 3, (j + 2) % 3]);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * minor(0, j)).sum();
    let rows: [[f64; 3]; 3] = core::array::from_fn(|j| core::array::from_fn(|i| minor(i, j) / determinant));
    if rows.iter().flatten().all(|entry| entry.is_finite()) {
        return Ok(rows);
    }
    Err(Error::Argument {
        name: "placement",
        problem: "so nearly singular that doubles cannot hold its inverse",
    })
}
