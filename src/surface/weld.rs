//! Merging vertices at one place.

use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use crate::mesh::TriangleMesh;
use alloc::vec::Vec;

/// Builds the mesh with equal vertices merged, without triangles that lose their area in this way, and
/// without vertices that no triangle uses afterwards. The remaining vertices and triangles keep their order.
///
/// # Errors
/// As [`TriangleMesh::new`].
pub(super) fn weld(vertices: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Result<TriangleMesh, Error> {
    let mesh = TriangleMesh::new(vertices, triangles)?;
    const UNUSED: u32 = u32::MAX;
    let mut places = memory::filled(mesh.vertices().len(), UNUSED)?;
    for &vertex in mesh.triangles().as_flattened() {
        places[vertex as usize] = 0;
    }
    if !places.contains(&UNUSED) {
        return Ok(mesh);
    }
    let mut vertices = memory::with_capacity(places.len())?;
    for (place, &vertex) in places.iter_mut().zip(mesh.vertices()) {
        if *place != UNUSED {
            *place = vertices.len() as u32;
            vertices.push(vertex);
        }
    }
    let triangles = mesh.triangles().iter().map(|triangle| triangle.each(|v| places[v as usize]));
    Ok(TriangleMesh::from_welded(vertices, memory::collected(triangles)?, 0, 0))
}
