//! One voxel.

use crate::error::Error;
use crate::lattice::axes;
use crate::lattice::{Cell, Frame};

/// What a voxel is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum VoxelKind {
    /// It lies outside of the solid.
    Outside = 0,
    /// It lies inside.
    Inside = 1,
    /// The boundary of the solid goes through it, or along it: see
    /// [`VoxelBoundary`](crate::voxel::VoxelBoundary).
    Boundary = 2,
    /// It is refined: it consists of the smaller voxels that follow it.
    Refined = 3,
}

impl VoxelKind {
    /// All of them, by their numbers.
    pub const ALL: [VoxelKind; 4] =
        [VoxelKind::Outside, VoxelKind::Inside, VoxelKind::Boundary, VoxelKind::Refined];

    /// The kind with this number.
    ///
    /// # Errors
    /// [`Error::Argument`] beyond 3.
    pub fn from_number(number: u8) -> Result<VoxelKind, Error> {
        let kind = VoxelKind::ALL.get(number as usize).copied();
        kind.ok_or(Error::Argument { name: "kind", problem: "must be 0 to 3" })
    }

    /// Its name: `outside`, `inside`, `boundary` or `refined`.
    pub fn name(self) -> &'static str {
        match self {
            VoxelKind::Outside => "outside",
            VoxelKind::Inside => "inside",
            VoxelKind::Boundary => "boundary",
            VoxelKind::Refined => "refined",
        }
    }
}

/// A voxel: a cell, what it is, and the attribute's value at its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VoxelRecord {
    /// What it is.
    pub kind: VoxelKind,
    /// Which octant of the universe; its level is the voxel's.
    pub cell: Cell,
    /// The attribute's value at the centre; `None` if there is no attribute, or no value there.
    pub value: Option<[f64; 4]>,
}

/// The minimum corner of a cell in model units, rounded down where it is no double.
pub(super) fn corner(frame: &Frame, cell: Cell) -> [f64; 3] {
    let at = cell.first_at(frame.depth()).at;
    axes(|axis| frame.plane(axis, at[axis]).lower)
}

/// The edge of a cell in model units, exactly.
pub(super) fn edge(frame: &Frame, level: u8) -> f64 {
    frame.edge() / (1u64 << level) as f64
}

/// The centre of a cell in model units, rounded.
#[inline]
pub(super) fn centre(frame: &Frame, cell: Cell) -> [f64; 3] {
    let half = 0.5 * edge(frame, cell.level);
    axes(|axis| frame.origin()[axis] + (2 * cell.at[axis] + 1) as f64 * half)
}
