//! Stanford PLY.

use super::lines::{Lines, Point};
use crate::error::Error;
use crate::mesh::TriangleMesh;
use alloc::vec::Vec;

pub(super) fn write(mesh: &TriangleMesh, text: bool) -> Result<Vec<u8>, Error> {
    let (vertices, triangles) = (mesh.vertices(), mesh.triangles());
    let mut lines = Lines::default();
    let format = if text { "ascii" } else { "binary_little_endian" };
    lines.add(format_args!(
        "ply\nformat {format} 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         element face {}\nproperty list uchar {} vertex_indices\nend_header\n",
        vertices.len(),
        triangles.len(),
        // Some programs read no other type than `int`; only the largest meshes need another.
        if vertices.len() <= i32::MAX as usize { "int" } else { "uint" },
    ))?;
    if text {
        for &vertex in vertices {
            lines.add(format_args!("{}\n", Point(vertex)))?;
        }
        for [a, b, c] in triangles {
            lines.add(format_args!("3 {a} {b} {c}\n"))?;
        }
        return Ok(lines.bytes());
    }
    let mut bytes = lines.bytes();
    let length = (vertices.len().checked_mul(24)).zip(triangles.len().checked_mul(13));
    let length = length.and_then(|(a, b)| a.checked_add(b)).ok_or(Error::OutOfMemory)?;
    bytes.try_reserve_exact(length)?;
    for vertex in vertices {
        for x in vertex {
            bytes.extend_from_slice(&x.to_le_bytes());
        }
    }
    for triangle in triangles {
        bytes.push(3);
        for v in triangle {
            bytes.extend_from_slice(&v.to_le_bytes());
        }
    }
    Ok(bytes)
}
