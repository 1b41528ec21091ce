//! Mesh files of all formats, written.
//!
//! Whatever is written here comes back through this library's readers: text has the shortest decimal numbers
//! that are read as the same doubles, binary PLY has the doubles themselves. STL alone has 32-bit
//! coordinates; [`written_form`] tells what becomes of a mesh.

mod attributes;
mod form;
mod lines;
mod obj;
mod off;
mod ply;
#[cfg(feature = "png")]
mod png;
#[cfg(feature = "std")]
mod polygons;
mod stl;
#[cfg(feature = "threemf")]
mod threemf;

pub use form::{WrittenForm, written_form};
#[cfg(feature = "png")]
pub use png::write_png;
#[cfg(feature = "std")]
pub use polygons::{write_grouped_polygons, write_polygons};
pub use stl::write_stl;
#[cfg(feature = "threemf")]
pub use threemf::write_placed_meshes;

use super::{LengthUnit, MeshFormat, stated};
use crate::error::Error;
#[cfg(not(feature = "threemf"))]
use crate::error::MeshFileError;
use crate::mesh::TriangleMesh;
use alloc::vec::Vec;

/// How a mesh file is written.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WriteOptions {
    /// STL and PLY as text, which is several times as long. OBJ and OFF always are text.
    pub text: bool,
    /// The unit of the coordinates, which only a 3MF tells; `None` stands for its default, the millimetre.
    /// Nothing is converted.
    pub unit: Option<LengthUnit>,
    /// PLY and OBJ with the normals at vertices ([`TriangleMesh::vertex_normals`]). Other formats have none.
    pub normals: bool,
    /// How far the true boundary may lie from the mesh ([`TriangleMesh::deviation`]), in model units: told by
    /// a comment of a PLY, an OBJ or an OFF, and by metadata of a 3MF. An STL has no place for it.
    /// [`MeshFile::deviation`](super::MeshFile::deviation) reads it.
    pub deviation: Option<f64>,
}

/// The file of a mesh in a format.
///
/// | format | what is written |
/// |---|---|
/// | STL | binary, 32-bit coordinates; ASCII with all digits that these have |
/// | PLY | little-endian or ASCII, coordinates of type `double`, normals of type `float`, colours, attributes of triangles |
/// | OBJ | vertices and triangles, normals, materials |
/// | OFF | vertices and triangles |
/// | 3MF | (feature `threemf`) a package of the core specification: one object, which is the build's one item, in the given unit; base materials and colours |
///
/// Coordinates are kept exactly by all but STL, which may lose vertices and triangles and flatten what is
/// small and far away: [`written_form`] tells.
///
/// **Attributes.** What a format has a place for is written, and read back by the readers of this library:
///
/// - Of `colour` and `face_colour` (three or four numbers from 0 to 255, which are rounded) a PLY has colours
///   of faces, and of vertices if `colour` is one of corners: at a vertex that of the first corner there.
///   What has no colour is black with an alpha of 0. A 3MF has colours of triangles or corners, of
///   `face_colour` only if there is no `colour`.
/// - Of `material` with its names an OBJ has `usemtl`, and no file of materials; a 3MF has base materials, of
///   which each needs a colour: that of the first triangle of it, or grey. Materials are written, and not
///   colours, where a 3MF would have both.
/// - All other attributes of triangles whose names are one word of ASCII are properties of the faces of a
///   PLY, with comments in the header that announce them to the reader.
///
/// Vertices and triangles keep their order. A 3MF leaves out triangles that have a vertex twice, which it
/// must not have.
///
/// O(n) time and memory.
///
/// # Errors
/// [`Error::Argument`] for an STL of coordinates beyond the range of `f32`, for an OBJ without vertices, and
/// for a deviation that [`TriangleMesh::with_deviation`] refuses;
/// [`MeshFileError::Unsupported`](crate::error::MeshFileError::Unsupported) for a 3MF without the feature;
/// [`Error::OutOfMemory`]. (Compressing a 3MF takes some 300 KiB that cannot be refused.)
///
/// ```
/// use leafless::exchange::{MeshFormat, WriteOptions, read_mesh, write_mesh};
/// use leafless::TriangleMesh;
/// let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.1]];
/// let mesh = TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// for format in [MeshFormat::Ply, MeshFormat::Obj, MeshFormat::Off] {
///     let bytes = write_mesh(&mesh, format, &WriteOptions::default())?;
///     let back = read_mesh(&bytes, &Default::default())?;
///     assert_eq!((back.format, back.mesh.vertices()), (format, mesh.vertices()));
/// }
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn write_mesh(mesh: &TriangleMesh, format: MeshFormat, options: &WriteOptions) -> Result<Vec<u8>, Error> {
    refuse(mesh, format, options)?;
    match format {
        MeshFormat::Stl if options.text => stl::text(mesh),
        MeshFormat::Stl => write_stl(mesh),
        MeshFormat::Ply => ply::write(mesh, options),
        MeshFormat::Obj => obj::write(mesh, options),
        MeshFormat::Off => off::write(mesh, options),
        #[cfg(feature = "threemf")]
        MeshFormat::ThreeMf => threemf::write(mesh, options),
        #[cfg(not(feature = "threemf"))]
        MeshFormat::ThreeMf => Err(WITHOUT_3MF.into()),
    }
}

#[cfg(not(feature = "threemf"))]
const WITHOUT_3MF: MeshFileError =
    MeshFileError::Unsupported { what: "3MF, which was left out of this build," };

/// Refuses meshes that a format does not have, apart from their coordinates, and options that are none.
fn refuse(mesh: &TriangleMesh, format: MeshFormat, options: &WriteOptions) -> Result<(), Error> {
    stated::check(options.deviation)?;
    match format {
        // A file of neither cannot be told from other text.
        MeshFormat::Obj if mesh.vertices().is_empty() => {
            Err(Error::Argument { name: "mesh", problem: "has no vertices, of which an OBJ must have some" })
        }
        #[cfg(not(feature = "threemf"))]
        MeshFormat::ThreeMf => Err(WITHOUT_3MF.into()),
        _ => Ok(()),
    }
}
