//! Stanford PLY.

use super::WriteOptions;
use super::lines::{Lines, Point};
use crate::error::Error;
use crate::mesh::TriangleMesh;
use alloc::vec::Vec;

pub(super) fn write(mesh: &TriangleMesh, options: &WriteOptions) -> Result<Vec<u8>, Error> {
    let (vertices, triangles) = (mesh.vertices(), mesh.triangles());
    let normals = if options.normals { mesh.vertex_normals()? } else { Vec::new() };
    let normals = normals.iter().map(|normal| normal.map(|x| x as f32));
    let mut lines = Lines::default();
    lines.add(format_args!(
        "ply\nformat {} 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
        if options.text { "ascii" } else { "binary_little_endian" },
        vertices.len()
    ))?;
    if options.normals {
        lines.add(format_args!("property float nx\nproperty float ny\nproperty float nz\n"))?;
    }
    lines.add(format_args!(
        "element face {}\nproperty list uchar {} vertex_indices\nend_header\n",
        triangles.len(),
        // Some programs read no other type than `int`; only the largest meshes need another.
        if vertices.len() <= i32::MAX as usize { "int" } else { "uint" },
    ))?;
    // Without normals there are none to take.
    let mut normals = normals.fuse();
    if options.text {
        for &vertex in vertices {
            match normals.next() {
                Some(normal) => lines.add(format_args!("{} {}\n", Point(vertex), Point(normal)))?,
                None => lines.add(format_args!("{}\n", Point(vertex)))?,
            }
        }
        for [a, b, c] in triangles {
            lines.add(format_args!("3 {a} {b} {c}\n"))?;
        }
        return Ok(lines.bytes());
    }
    let mut bytes = lines.bytes();
    let of_vertex = if options.normals { 24 + 12 } else { 24 };
    let length = (vertices.len().checked_mul(of_vertex)).zip(triangles.len().checked_mul(13));
    let length = length.and_then(|(a, b)| a.checked_add(b)).ok_or(Error::OutOfMemory)?;
    bytes.try_reserve_exact(length)?;
    for vertex in vertices {
        vertex.iter().for_each(|x| bytes.extend_from_slice(&x.to_le_bytes()));
        for x in normals.next().into_iter().flatten() {
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
