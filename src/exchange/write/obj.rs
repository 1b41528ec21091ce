//! Wavefront OBJ.

use super::WriteOptions;
use super::lines::{Lines, Point};
use crate::error::Error;
use crate::mesh::TriangleMesh;
use alloc::vec::Vec;

pub(super) fn write(mesh: &TriangleMesh, options: &WriteOptions) -> Result<Vec<u8>, Error> {
    let mut lines = Lines::default();
    for &vertex in mesh.vertices() {
        lines.add(format_args!("v {}\n", Point(vertex)))?;
    }
    if options.normals {
        for normal in mesh.vertex_normals()? {
            lines.add(format_args!("vn {}\n", Point(normal.map(|x| x as f32))))?;
        }
    }
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|v| u64::from(v) + 1);
        if options.normals {
            lines.add(format_args!("f {a}//{a} {b}//{b} {c}//{c}\n"))?;
        } else {
            lines.add(format_args!("f {a} {b} {c}\n"))?;
        }
    }
    Ok(lines.bytes())
}
