//! Writers of mesh files in all formats.
//!
//! This library's readers read every written file back: text has the shortest decimal numbers that are read
//! as the same doubles, binary PLY has the doubles themselves. Only STL has 32-bit coordinates;
//! [`written_form`] returns the mesh that remains.

mod attributes;
mod form;
mod lines;
mod obj;
mod off;
mod ply;
#[cfg(feature = "std")]
mod polygons;
mod stl;
#[cfg(feature = "threemf")]
mod threemf;

pub use form::{WrittenForm, written_form};
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

/// Options for writing a mesh file.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WriteOptions {
    /// Writes STL and PLY as text, which is several times as long. OBJ and OFF always are text.
    pub text: bool,
    /// The unit of the coordinates, which only a 3MF stores; `None` stands for its default, the millimetre.
    /// Nothing is converted.
    pub unit: Option<LengthUnit>,
    /// Writes PLY and OBJ with normals at vertices ([`TriangleMesh::vertex_normals`]). Other formats have
    /// none.
    pub normals: bool,
    /// The maximum distance of the true boundary from the mesh ([`TriangleMesh::deviation`]), in model units.
    /// It is stored in a comment of a PLY, an OBJ or an OFF, and in metadata of a 3MF. An STL has no place
    /// for it. [`MeshFile::deviation`](super::MeshFile::deviation) reads it.
    pub deviation: Option<f64>,
}

/// Returns the bytes of a mesh file in a format.
///
/// | format | what is written |
/// |---|---|
/// | STL | binary, 32-bit coordinates; ASCII with all digits that these have |
/// | PLY | little-endian or ASCII, coordinates of type `double`, normals of type `float`, colours, attributes of triangles |
/// | OBJ | vertices and triangles, normals, materials |
/// | OFF | vertices and triangles |
/// | 3MF | (feature `threemf`) a package of the core specification: one object, which is the build's one item, in the given unit; base materials and colours |
///
/// All formats but STL keep coordinates exactly. STL may lose vertices and triangles, and may flatten details
/// that are small and far from the origin: [`written_form`] returns the result.
///
/// **Attributes.** Attributes for which a format has a place are written, and the readers of this library
/// read them back:
///
/// - `colour` and `face_colour` (three or four numbers from 0 to 255, which are rounded): A PLY has colours
///   of faces, and colours of vertices if `colour` is an attribute of corners; a vertex gets the colour of
///   the first corner there. Elements without a colour are black with an alpha of 0. A 3MF has colours of
///   triangles or corners, from `face_colour` only if there is no `colour`.
/// - `material` with its names: An OBJ has `usemtl`, without a file of materials. A 3MF has base materials.
///   Each of them needs a colour: that of the first triangle with the material, or grey. If a 3MF would have
///   both, materials are written, and colours are not.
/// - All other attributes of triangles whose names are one word of ASCII: They become properties of the faces
///   of a PLY, with comments in the header that announce them to the reader.
///
/// Vertices and triangles keep their order. A 3MF leaves out triangles with a repeated vertex, which the
/// format forbids.
///
/// O(n) time and memory.
///
/// # Errors
/// [`Error::Argument`] for an STL of coordinates beyond the range of `f32`, for an OBJ without vertices, and
/// for a deviation that [`TriangleMesh::with_deviation`] refuses;
/// [`MeshFileError::Unsupported`](crate::error::MeshFileError::Unsupported) for a 3MF without the feature;
/// [`Error::OutOfMemory`]. (Compressing a 3MF takes some 300 KiB; if they cannot be allocated, the process
/// ends.)
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

/// Refuses meshes that a format cannot store, apart from their coordinates, and invalid options.
fn refuse(mesh: &TriangleMesh, format: MeshFormat, options: &WriteOptions) -> Result<(), Error> {
    stated::check(options.deviation)?;
    match format {
        // A file with neither vertices nor faces cannot be told from other text.
        MeshFormat::Obj if mesh.vertices().is_empty() => {
            Err(Error::Argument { name: "mesh", problem: "has no vertices, but an OBJ must have some" })
        }
        #[cfg(not(feature = "threemf"))]
        MeshFormat::ThreeMf => Err(WITHOUT_3MF.into()),
        _ => Ok(()),
    }
}
