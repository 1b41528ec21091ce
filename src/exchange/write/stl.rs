//! Writer of STL, binary and ASCII.

use super::lines::{Lines, Point};
use crate::error::{Error, MeshError};
use crate::exchange::stl::{HEADER, binary_length};
use crate::lattice::Each;
use crate::memory;
use crate::mesh::TriangleMesh;
use alloc::vec::Vec;
use glam::DVec3;

/// The beginning of a binary file; must not be `solid`.
const TITLE: &[u8] = b"binary STL written by leafless";

/// Writes a binary STL file.
///
/// Coordinates are rounded to `f32`. Triangles still share their vertices, so a closed mesh stays closed,
/// even if rounding makes a triangle degenerate, which readers drop. Details smaller than the rounding are
/// lost, up to the whole solid. [`written_form`](super::written_form) returns the result, and
/// [`TriangleMesh::in_single_precision`] repairs the mesh beforehand. A triangle without area has the normal
/// (0, 0, 0).
///
/// O(t), 84 + 50 t bytes.
///
/// # Errors
/// [`Error::Argument`] beyond the range of `f32`, or [`Error::OutOfMemory`].
pub fn write_stl(mesh: &TriangleMesh) -> Result<Vec<u8>, Error> {
    let count = u32::try_from(mesh.triangles().len()).map_err(|_| MeshError::TooMany)?;
    let length = usize::try_from(binary_length(count)).map_err(|_| Error::OutOfMemory)?;
    let mut bytes = memory::with_capacity(length)?;
    bytes.extend_from_slice(TITLE);
    bytes.resize(HEADER - 4, b' ');
    bytes.extend_from_slice(&count.to_le_bytes());
    for triangle in mesh.triangles() {
        let corners = triangle.each(|v| mesh.vertices()[v as usize]);
        for vector in [normal(corners)].into_iter().chain(corners) {
            for x in rounded(vector)? {
                bytes.extend_from_slice(&x.to_le_bytes());
            }
        }
        bytes.extend_from_slice(&[0, 0]);
    }
    Ok(bytes)
}

/// Writes an ASCII STL file with the same numbers as the binary file.
pub(super) fn text(mesh: &TriangleMesh) -> Result<Vec<u8>, Error> {
    let mut lines = Lines::default();
    lines.add(format_args!("solid leafless\n"))?;
    for triangle in mesh.triangles() {
        let corners = triangle.each(|v| mesh.vertices()[v as usize]);
        lines.add(format_args!("facet normal {}\nouter loop\n", Point(rounded(normal(corners))?)))?;
        for corner in corners {
            lines.add(format_args!("vertex {}\n", Point(rounded(corner)?)))?;
        }
        lines.add(format_args!("endloop\nendfacet\n"))?;
    }
    lines.add(format_args!("endsolid leafless\n"))?;
    Ok(lines.bytes())
}

/// Rounds a vector to 32-bit numbers.
pub(super) fn rounded(vector: [f64; 3]) -> Result<[f32; 3], Error> {
    let vector = vector.each(|x| x as f32);
    if !vector.iter().all(|x| x.is_finite()) {
        let problem = "has a coordinate beyond the range of 32-bit floating point numbers";
        return Err(Error::Argument { name: "mesh", problem });
    }
    Ok(vector)
}

/// Returns the unit normal, or zero for a triangle without area.
fn normal(corners: [[f64; 3]; 3]) -> [f64; 3] {
    let [a, b, c] = corners.each(DVec3::from);
    // Scaled to about 1, so that the squares neither overflow nor vanish.
    let unit = |v: DVec3| (v / v.abs().max_element()).normalize_or_zero();
    unit(unit(b - a).cross(unit(c - a))).to_array()
}
