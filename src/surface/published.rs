//! Coplanar shrink as published: triangles of merged cells, which do not fit together.

use super::bon::Cell;
use super::chunks;
use super::outline::super_triangles;
use super::plane;
use super::points;
use super::simple::Snap;
use crate::control::Job;
use crate::error::{Error, MeshError};
use crate::lattice::Each;
use crate::lattice::axes;
use crate::memory;
use crate::parallel;
use alloc::vec::Vec;

/// The samples that are vertices, and the triangles.
pub(super) fn triangles(
    cells: &[Cell],
    bias: i32,
    snap: Snap,
    weight: usize,
    job: &Job<'_>,
    parallel: bool,
) -> Result<(Vec<u64>, Vec<[u32; 3]>), Error> {
    let table = snap.table();
    let found = chunks::map(cells.len(), weight, job, parallel, |range| {
        let mut found: Vec<[u64; 3]> = Vec::new();
        for cell in &cells[range] {
            let corner = cell.corner(bias);
            if cell.level == 0 {
                for triangle in table.triangles[cell.configuration as usize].list() {
                    let points = triangle.each(|c| {
                        let place = plane::corner(c.into());
                        points::code(axes(|axis| corner[axis] + place[axis]))
                    });
                    memory::push(&mut found, points)?;
                }
            } else {
                for triangle in super_triangles(cell, corner) {
                    memory::push(&mut found, triangle.each(points::code))?;
                }
            }
        }
        Ok(found)
    })?;
    let count: usize = found.iter().map(Vec::len).sum();
    let mut vertices = memory::with_capacity(3 * count)?;
    found.iter().for_each(|part| vertices.extend_from_slice(part.as_flattened()));
    parallel::sort(&mut vertices, parallel);
    vertices.dedup();
    if vertices.len().max(count) > u32::MAX as usize {
        return Err(MeshError::TooMany.into());
    }
    let number = |point: u64| vertices.partition_point(|&vertex| vertex < point) as u32;
    let mut triangles = memory::with_capacity(count)?;
    triangles.extend(found.iter().flatten().map(|triangle| triangle.each(number)));
    Ok((vertices, triangles))
}
