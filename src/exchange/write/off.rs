//! Writer of Geomview OFF.

use super::WriteOptions;
use super::lines::{Lines, Point};
use crate::error::Error;
use crate::exchange::stated::Line;
use crate::mesh::TriangleMesh;
use alloc::vec::Vec;

pub(super) fn write(mesh: &TriangleMesh, options: &WriteOptions) -> Result<Vec<u8>, Error> {
    let mut lines = Lines::default();
    lines.add(format_args!("OFF\n"))?;
    if let Some(deviation) = options.deviation {
        lines.add(format_args!("{}", Line("# ", deviation)))?;
    }
    lines.add(format_args!("{} {} 0\n", mesh.vertices().len(), mesh.triangles().len()))?;
    for &vertex in mesh.vertices() {
        lines.add(format_args!("{}\n", Point(vertex)))?;
    }
    for [a, b, c] in mesh.triangles() {
        lines.add(format_args!("3 {a} {b} {c}\n"))?;
    }
    Ok(lines.bytes())
}
