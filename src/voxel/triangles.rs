//! The triangles of a mesh that meet each boundary voxel.

use super::descent::Part;
use super::record::{VoxelKind, edge};
use super::records::VoxelRecordsRef;
use super::touch;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Bounds, Cube};
use crate::memory;
use crate::mesh::TriangleMesh;
use alloc::vec::Vec;

/// For each record, the triangles that meet it, in compressed rows.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct VoxelTriangles {
    offsets: Vec<u64>,
    triangles: Vec<u32>,
}

impl VoxelTriangles {
    /// For each record, the index of its first triangle in [`triangles`](Self::triangles); then the number of
    /// all. There is one offset more than there are records.
    pub fn offsets(&self) -> &[u64] {
        &self.offsets
    }

    /// The indices of the triangles, record by record, ascending within each record.
    pub fn triangles(&self) -> &[u32] {
        &self.triangles
    }

    /// The triangles of a record; empty for an index beyond the records.
    pub fn of(&self, index: usize) -> &[u32] {
        match self.offsets.get(index..).and_then(|rest| rest.first_chunk()) {
            Some(&[start, end]) => &self.triangles[start as usize..end as usize],
            None => &[],
        }
    }
}

impl VoxelRecordsRef<'_> {
    /// Finds, for each boundary voxel, the triangles of `mesh` (in model units) that meet it. Other records
    /// have no triangles.
    ///
    /// Voxels and triangles are closed sets here: a triangle that only touches a voxel, for example with a
    /// corner in its face, meets the voxel. So a triangle in a plane of the lattice meets the voxels on both
    /// sides. The decision is exact.
    ///
    /// Each cell receives the triangles that meet its parent. O((n + triangles that are met) · levels).
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and the errors that `control` causes: its limit of bytes applies to the two
    /// arrays.
    pub fn triangles(&self, mesh: &TriangleMesh, control: &Control<'_>) -> Result<VoxelTriangles, Error> {
        let mut offsets = memory::with_capacity(self.len() + 1)?;
        offsets.push(0);
        let candidates = memory::collected(0..mesh.triangles().len() as u32)?;
        let mut boxes = memory::with_capacity(mesh.triangles().len())?;
        for &triangle in mesh.triangles() {
            boxes.push(touch::bounds(&touch::corners(mesh, triangle)));
        }
        let found = VoxelTriangles { offsets, triangles: Vec::new() };
        let mut sorter = Sorter { records: *self, mesh, boxes, control, candidates, found };
        let count = sorter.candidates.len();
        sorter.sort(&self.whole(), 0..count)?;
        sorter.skip_to(self.len());
        Ok(sorter.found)
    }
}

struct Sorter<'r, 'a, 'c> {
    records: VoxelRecordsRef<'a>,
    mesh: &'r TriangleMesh,
    boxes: Vec<Bounds>,
    control: &'r Control<'c>,
    /// A stack: the candidates of the cells on the path.
    candidates: Vec<u32>,
    found: VoxelTriangles,
}

impl Sorter<'_, '_, '_> {
    /// Gives no triangles to the records before `index` that were skipped.
    fn skip_to(&mut self, index: usize) {
        // There is room for all of them.
        self.found.offsets.resize(index + 1, self.found.triangles.len() as u64);
    }

    fn sort(&mut self, part: &Part, from: core::ops::Range<usize>) -> Result<(), Error> {
        let kinds = &self.records.kinds()[part.range.clone()];
        if from.is_empty() || !kinds.contains(&(VoxelKind::Boundary as u8)) {
            return Ok(());
        }
        let frame = self.records.frame();
        let own = self.records.has_own(part).then(|| self.records.kind_at(part.range.start));
        let cube = Cube { frame, cell: part.cell };
        let (min, max) = cube.bounds();
        let length = edge(frame, part.cell.level);
        let start = self.candidates.len();
        self.candidates.try_reserve(from.len())?;
        for k in from {
            let index = self.candidates[k];
            let bounds = &self.boxes[index as usize];
            if (0..3).any(|axis| bounds.min[axis] > max[axis] || bounds.max[axis] < min[axis]) {
                continue;
            }
            let corners = || touch::corners(self.mesh, self.mesh.triangles()[index as usize]);
            let keep = match own {
                Some(VoxelKind::Boundary) => touch::meets(&corners(), &cube),
                // For a triangle smaller than the cell, the box alone suffices.
                _ => {
                    let small = (0..3).all(|axis| bounds.max[axis] - bounds.min[axis] < length);
                    small || touch::may_meet(&corners(), &cube)
                }
            };
            if keep {
                self.candidates.push(index);
            }
        }
        let end = self.candidates.len();
        if own == Some(VoxelKind::Boundary) {
            self.control.check()?;
            self.skip_to(part.range.start);
            self.found.triangles.try_reserve(end - start)?;
            self.found.triangles.extend_from_slice(&self.candidates[start..end]);
            let bytes = 4 * self.found.triangles.len() as u64 + 8 * self.records.len() as u64;
            if let Some(limit) = self.control.max_bytes.filter(|&limit| bytes > limit) {
                return Err(Error::Limit { what: "bytes", limit });
            }
            self.skip_to(part.range.start + 1);
        } else {
            for child in self.records.split(part) {
                self.sort(&child, start..end)?;
            }
        }
        self.candidates.truncate(start);
        Ok(())
    }
}
