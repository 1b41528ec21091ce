//! Geomview OFF.

use super::lines::{Lines, Point};
use crate::error::Error;
use crate::mesh::TriangleMesh;
use alloc::vec::Vec;

pub(super) fn write(mesh: &TriangleMesh) -> Result<Vec<u8>, Error> {
    let mut lines = Lines::default();
    lines.add(format_args!("OFF\n{} {} 0\n", mesh.vertices().len(), mesh.triangles().len()))?;
    for &vertex in mesh.vertices() {
        lines.add(format_args!("{}\n", Point(vertex)))?;
    }
    for [a, b, c] in mesh.triangles() {
        lines.add(format_args!("3 {a} {b} {c}\n"))?;
    }
    Ok(lines.bytes())
}
