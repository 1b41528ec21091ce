//! Finds the voxels between planes of a frame, exactly.

use super::VoxelGrid;
use super::grid::last_at_most;
use crate::lattice::Frame;
use crate::lattice::exact::{floor, sign_of_sum, two_diff, two_product};

/// The point where a plane of a frame cuts an axis of the grid, in voxels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// The voxel that begins at the plane, or contains it: −1 below the grid, the extent above it.
    pub(super) floor: i64,
    /// Whether the voxel begins exactly at the plane.
    pub(super) exact: bool,
}

/// The voxels between two planes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    pub(super) low: u32,
    /// The first voxel beyond; not above `low` if there are no voxels.
    pub(super) high: u32,
    /// Whether a part of the range between the planes lies beyond the grid.
    pub(super) beyond: bool,
}

/// An axis of a frame relative to the same axis of a grid.
#[derive(Debug, Clone, Copy)]
pub(super) enum Axis {
    /// Half cell k of the frame begins at the voxel offset + k·2^shift: a voxel is a whole number of half
    /// cells, or a half cell is a whole number of voxels.
    Lattice { offset: i64, shift: i32, extent: u32 },
    /// Any other ratio: half cell k begins near the voxel offset + k·step.
    Free { axis: usize, offset: f64, step: f64, error: f64, extent: u32 },
}

/// The greatest shift for which the axes are treated as one lattice.
const MOST_SHIFT: i32 = 40;

impl Axis {
    pub(super) fn new(grid: &VoxelGrid, frame: &Frame, axis: usize) -> Axis {
        let (extent, spacing) = (grid.extents()[axis], grid.spacing()[axis]);
        let half = 0.5 * frame.cell_size();
        let (apart, rest) = two_diff(frame.origin()[axis], grid.corner()[axis]);
        // Lengths are normal numbers, and so is their ratio.
        let step = half / spacing;
        let power = ((step.to_bits() >> 52) as i32) - 1023;
        let is_power = half.to_bits() << 12 == spacing.to_bits() << 12 && power.abs() <= MOST_SHIFT;
        let offset = apart / spacing;
        if is_power && offset.abs() < (1u64 << MOST_SHIFT) as f64 {
            let whole = floor(offset + 0.5);
            let (product, error) = two_product(whole as f64, spacing);
            if sign_of_sum(&[rest, -error, apart, -product]) == 0 {
                return Axis::Lattice { offset: whole, shift: power, extent };
            }
        }
        // In voxels: each of the quotients, products and sums has an error below a part in 2^52.
        let cells = f64::from(2 * frame.cells());
        let error = 8.0 * f64::EPSILON * (offset.abs() + cells * step + 1.0);
        Axis::Free { axis, offset, step, error, extent }
    }

    /// The place of the plane at which half cell `k` begins.
    pub(super) fn place(&self, grid: &VoxelGrid, frame: &Frame, k: u32) -> Place {
        match *self {
            Axis::Lattice { offset, shift, extent } => {
                let (steps, exact) = if shift >= 0 {
                    (i64::from(k) << shift, true)
                } else {
                    (i64::from(k) >> -shift.max(-63), i64::from(k) & ((1 << -shift) - 1) == 0)
                };
                let floor = offset + steps;
                // A plane beyond the grid is the beginning of no voxel.
                let within = (0..i64::from(extent)).contains(&floor) || floor == i64::from(extent) && exact;
                Place { floor: floor.clamp(-1, extent.into()), exact: exact && within }
            }
            Axis::Free { axis, offset, step, error, extent } => {
                let near = offset + f64::from(k) * step;
                if near < -0.5 - error {
                    return Place { floor: -1, exact: false };
                }
                if near > f64::from(extent) + 0.5 + error {
                    return Place { floor: extent.into(), exact: false };
                }
                let nearest = floor(near + 0.5).clamp(0, extent.into()) as u32;
                if error < 0.25 {
                    if (near - f64::from(nearest)).abs() > error {
                        return Place { floor: floor(near), exact: false };
                    }
                    let side = grid.plane_side(frame, axis, k, nearest);
                    return Place { floor: i64::from(nearest) - i64::from(side < 0), exact: side == 0 };
                }
                // So far away from the grid's corner, doubles cannot decide.
                let begun = |j: u32| grid.plane_side(frame, axis, k, j);
                if begun(0) < 0 {
                    return Place { floor: -1, exact: false };
                }
                let last = last_at_most(extent, |j| begun(j) >= 0);
                Place { floor: last.into(), exact: begun(last) == 0 }
            }
        }
    }

    /// The voxels that overlap the range between two places.
    pub(super) fn run(&self, from: Place, to: Place) -> Run {
        let (Axis::Lattice { extent, .. } | Axis::Free { extent, .. }) = *self;
        let end = to.floor + i64::from(!to.exact);
        let within = |voxel: i64| voxel.clamp(0, extent.into()) as u32;
        Run {
            low: within(from.floor),
            high: within(end),
            beyond: from.floor < 0 || to.floor >= i64::from(extent) && !to.exact,
        }
    }
}
