//! The changes that writing a mesh file makes to a mesh.

use super::stl::{rounded, text};
use super::{WriteOptions, refuse};
use crate::error::Error;
use crate::exchange::{MeshFormat, read_stl};
use crate::lattice::Each;
use crate::memory;
use crate::mesh::{FacetWelder, TriangleMesh};
use alloc::borrow::Cow;
use alloc::vec::Vec;

/// The mesh that a file keeps of the mesh written to it, and the losses: see [`written_form`].
#[non_exhaustive]
#[derive(Debug, Clone)]
pub struct WrittenForm<'a> {
    /// The mesh that a reader gets back. Borrowed if the format keeps vertices and triangles as they are.
    pub mesh: Cow<'a, TriangleMesh>,
    /// Maximum distance along an axis by which rounding moves a vertex, in model units.
    pub rounding: f64,
    /// Number of used vertices that are lost because rounding makes them coincide with others.
    pub merged: u64,
    /// Number of triangles that are lost because rounding makes two of their corners coincide.
    pub degenerate: u64,
}

/// Returns the mesh that a reader gets back from a file of [`write_mesh`](super::write_mesh), and the losses.
///
/// PLY, OBJ, OFF and 3MF keep every bit of the coordinates, and nothing is lost. STL has 32-bit coordinates:
/// vertices move, coinciding vertices are one vertex for a reader, and triangles with two coinciding corners
/// are dropped. A closed mesh stays closed, but it may be flat, pinched, or have no triangle at all: a cube
/// of edge 3 around x = 10⁹ becomes a square. Its [`report`](TriangleMesh::report) shows this, and
/// [`TriangleMesh::in_single_precision`] repairs beforehand what can be repaired. An STL has no unused
/// vertices, and has the others in the order in which triangles first use them.
/// [`write_mesh`](super::write_mesh) documents which [attributes](TriangleMesh::attributes) are kept; the
/// mesh returned here has either none or all of them.
///
/// O(n) time; O(1) memory if nothing is lost, else the memory of a second mesh, and for an STL as text also
/// that of the file.
///
/// # Errors
/// As [`write_mesh`](super::write_mesh).
///
/// ```
/// use leafless::TriangleMesh;
/// use leafless::exchange::{MeshFormat, WriteOptions, written_form};
/// let vertices = vec![[1e9, 0.0, 0.0], [1e9 + 1.0, 0.0, 0.0], [1e9, 1.0, 0.0], [1e9, 0.0, 1.0]];
/// let mesh = TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let kept = written_form(&mesh, MeshFormat::Stl, &WriteOptions::default())?;
/// assert_eq!((kept.mesh.triangles().len(), kept.mesh.volume()), (2, 0.0));
/// assert_eq!((kept.rounding, kept.merged, kept.degenerate), (1.0, 1, 2));
/// let kept = written_form(&mesh, MeshFormat::Ply, &WriteOptions::default())?;
/// assert_eq!((kept.mesh.triangles().len(), kept.rounding, kept.degenerate), (4, 0.0, 0));
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn written_form<'a>(
    mesh: &'a TriangleMesh,
    format: MeshFormat,
    options: &WriteOptions,
) -> Result<WrittenForm<'a>, Error> {
    refuse(mesh, format, options)?;
    if format != MeshFormat::Stl {
        // Without triangles a 3MF has no object.
        let is_nothing = format == MeshFormat::ThreeMf && mesh.triangles().is_empty();
        let mesh = match is_nothing {
            true => Cow::Owned(TriangleMesh::new(Vec::new(), Vec::new())?),
            false => Cow::Borrowed(mesh),
        };
        return Ok(WrittenForm { mesh, rounding: 0.0, merged: 0, degenerate: 0 });
    }
    let corners = |triangle: &[u32; 3]| triangle.each(|v| mesh.vertices()[v as usize]);
    let single = |corners: [[f64; 3]; 3]| -> Result<[[f64; 3]; 3], Error> {
        let [a, b, c] = corners.each(rounded);
        Ok([a?, b?, c?].each(|corner| corner.each(f64::from)))
    };
    let kept = if options.text {
        // Readers take decimal numbers for the nearest doubles, not for 32-bit numbers.
        read_stl(&text(mesh)?)?
    } else {
        let mut welder = FacetWelder::with_capacity(mesh.triangles().len())?;
        for triangle in mesh.triangles() {
            welder.push(&single(corners(triangle))?)?;
        }
        welder.finish()
    };
    let mut is_used = memory::filled(mesh.vertices().len(), false)?;
    let mut rounding = 0f64;
    let mut triangles = kept.triangles().iter();
    for triangle in mesh.triangles() {
        triangle.iter().for_each(|&v| is_used[v as usize] = true);
        let given = corners(triangle);
        let [a, b, c] = single(given)?;
        let is_kept = a != b && b != c && c != a;
        let found = if is_kept { triangles.next() } else { None };
        let found = found.map_or([a, b, c], |found| found.each(|v| kept.vertices()[v as usize]));
        for (x, y) in given.as_flattened().iter().zip(found.as_flattened()) {
            rounding = rounding.max((x - y).abs());
        }
    }
    let used = is_used.iter().filter(|&&used| used).count() as u64;
    let merged = used.saturating_sub(kept.vertices().len() as u64);
    let degenerate = mesh.triangles().len().saturating_sub(kept.triangles().len()) as u64;
    Ok(WrittenForm { mesh: Cow::Owned(kept), rounding, merged, degenerate })
}
