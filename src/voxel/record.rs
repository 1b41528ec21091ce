//! A single voxel.

use crate::error::Error;
use crate::lattice::axes;
use crate::lattice::{Cell, Frame};

/// The kind of a voxel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum VoxelKind {
    /// The voxel lies outside the solid.
    Outside = 0,
    /// The voxel lies inside the solid.
    Inside = 1,
    /// The boundary of the solid passes through the voxel, or along it: see
    /// [`VoxelBoundary`](crate::voxel::VoxelBoundary).
    Boundary = 2,
    /// The voxel is refined: it consists of the smaller voxels that follow it.
    Refined = 3,
}

impl VoxelKind {
    /// All kinds, in the order of their numbers.
    pub const ALL: [VoxelKind; 4] =
        [VoxelKind::Outside, VoxelKind::Inside, VoxelKind::Boundary, VoxelKind::Refined];

    /// Returns the kind with this number.
    ///
    /// # Errors
    /// [`Error::Argument`] beyond 3.
    pub fn from_number(number: u8) -> Result<VoxelKind, Error> {
        let kind = VoxelKind::ALL.get(number as usize).copied();
        kind.ok_or(Error::Argument { name: "kind", problem: "must be 0 to 3" })
    }

    /// The name of the kind: `outside`, `inside`, `boundary` or `refined`.
    pub fn name(self) -> &'static str {
        match self {
            VoxelKind::Outside => "outside",
            VoxelKind::Inside => "inside",
            VoxelKind::Boundary => "boundary",
            VoxelKind::Refined => "refined",
        }
    }
}

/// A voxel: its cell, its kind, and the attribute's value at its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VoxelRecord {
    /// The kind of the voxel.
    pub kind: VoxelKind,
    /// The octant of the universe; its level is that of the voxel.
    pub cell: Cell,
    /// The attribute's value at the centre; `None` if there is no attribute, or no value there.
    pub value: Option<[f64; 4]>,
}

/// The minimum corner of a cell in model units; rounded down if it is no double.
pub(super) fn corner(frame: &Frame, cell: Cell) -> [f64; 3] {
    let at = cell.first_at(frame.depth()).at;
    axes(|axis| frame.plane(axis, at[axis]).lower)
}

/// The edge of a cell in model units, exact.
pub(super) fn edge(frame: &Frame, level: u8) -> f64 {
    frame.edge() / (1u64 << level) as f64
}

/// The centre of a cell in model units, rounded.
#[inline]
pub(super) fn centre(frame: &Frame, cell: Cell) -> [f64; 3] {
    let half = 0.5 * edge(frame, cell.level);
    axes(|axis| frame.origin()[axis] + (2 * cell.at[axis] + 1) as f64 * half)
}
