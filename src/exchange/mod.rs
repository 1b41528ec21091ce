//! Readers and writers for file formats of other programs.
//!
//! [`read_mesh`] and `open_mesh` (with the feature `std`) read mesh files of all formats, detect the format,
//! and convert units. [`read_stl`], `read_obj`, `read_ply` and `read_off` read one format each.
//!
//! | format | what is read |
//! |---|---|
//! | STL | binary and ASCII, several solids in one file |
//! | OBJ | polygons, relative indices, continued lines, names of materials; groups and normals are skipped |
//! | PLY | ASCII and both binary orders; colours of vertices and faces; any other elements and properties are skipped; triangle strips |
//! | OFF | text and binary, with and without a keyword, with colours, normals and textures, which are skipped |
//! | 3MF | (feature `threemf`) the core specification, its draft 0.93 and parts of the production extension: units, components, the build's transforms, base materials, colour groups |
//!
//! **Deviation.** A mesh may be known to lie only within a distance of the true boundary
//! ([`TriangleMesh::with_deviation`]). [`WriteOptions::deviation`] writes that distance into a file, and
//! [`MeshFile::deviation`] returns the distance that a file states. The statement is not applied: the mesh
//! that is read has no deviation until the caller sets one.
//!
//! **Colours and materials** are [attributes](TriangleMesh::attributes) of the mesh. A file without them
//! gives a mesh without attributes.
//!
//! - `colour` has four numbers from 0 to 255: red, green and blue, usually in sRGB, and alpha, which is 255
//!   if the file has none. In a PLY, vertices or faces have colours, and the corners of triangles take over
//!   those of the vertices. In a 3MF, corners or triangles have colours, either from a colour group or the
//!   display colours of base materials.
//! - `face_colour` has the colours of a PLY's faces if its vertices have colours as well.
//! - `material` is the number of a triangle's material, with the materials' names. In a 3MF it is the base
//!   material, in an OBJ the name after `usemtl`, numbered in order of appearance.
//! - `object` is the number of the object of a 3MF, if several are built, in the order in which they are
//!   first placed, with the objects' names.
//! - Other attributes come from a PLY that this library wrote.
//!
//! Some files depart from their format in a way that leaves no doubt about the mesh. They are read, and
//! [`MeshFile::warnings`] lists the departures.
//!
//! [`write_mesh`] writes a file of any of these formats, `write_polygons` an OBJ or OFF of polygons, and
//! `write_placed_meshes` (feature `threemf`) a 3MF of several objects, each in any number of places. STL
//! rounds coordinates to 32 bits: [`written_form`] returns the mesh that a reader gets back, and counts the
//! losses.
//!
//! An error names the line, or the byte or element, and for a 3MF the part. Bytes may be anything: no reader
//! panics. Memory is linear in the length of the file, with two exceptions for 3MF: its parts may be up to 64
//! times as long as the file plus 16 MiB, and instances of one object, up to 2^25 vertices and triangles
//! altogether, are stored one by one. The build items of a 3MF become one mesh: objects of type `model`, each
//! as often as it is placed. Supports and other objects that are no solids are left out and counted. A model
//! that requires an extension other than production, materials and triangle sets is refused, as are
//! encryption and document type declarations.
//!
//! With the feature `volumes`, [`open_volume`] reads volumes (NRRD and MetaImage), [`read_raw_volume`] reads
//! arrays without a header, and [`write_nrrd`] writes volumes.
//!
//! Formats of polygons are read only with the feature `std`, because the triangulation of polygons needs it.

use crate::error::{Error, MeshFileError};
#[cfg(doc)]
use crate::mesh::TriangleMesh;

mod any;
#[cfg(feature = "std")]
mod bytes;
#[cfg(feature = "std")]
mod colours;
#[cfg(feature = "std")]
mod decimal;
#[cfg(feature = "std")]
mod declared;
mod detect;
#[cfg(feature = "std")]
mod materials;
#[cfg(feature = "std")]
mod obj;
#[cfg(feature = "std")]
mod off;
#[cfg(feature = "std")]
mod ply;
#[cfg(feature = "std")]
mod polygons;
mod stated;
mod stl;
#[cfg(all(test, feature = "std"))]
mod tests;
#[cfg(feature = "std")]
mod text;
#[cfg(feature = "threemf")]
mod threemf;
mod unit;
#[cfg(feature = "volumes")]
mod volume;
mod warning;
#[cfg(feature = "std")]
mod whole;
mod write;

#[cfg(feature = "std")]
pub use whole::read_whole;

#[cfg(feature = "std")]
pub use any::open_mesh;
pub use any::{MeshFile, MeshOptions, read_mesh};
pub use detect::MeshFormat;
#[cfg(feature = "std")]
pub use obj::read_obj;
#[cfg(feature = "std")]
pub use off::read_off;
#[cfg(feature = "std")]
pub use ply::read_ply;
#[cfg(feature = "scene")]
pub(crate) use polygons::Polygons;
pub use stl::read_stl;
pub use unit::LengthUnit;
#[cfg(feature = "volumes")]
pub use volume::{
    NrrdEncoding, RawVolume, SampleKind, VolumeFile, VolumeFormat, open_volume, read_raw_volume, read_volume,
    volume_data_file, write_nrrd, write_raw_volume,
};
pub use warning::MeshWarning;
#[cfg(feature = "threemf")]
pub use write::write_placed_meshes;
pub use write::{WriteOptions, WrittenForm, write_mesh, write_stl, written_form};
#[cfg(feature = "std")]
pub use write::{write_grouped_polygons, write_polygons};

/// Refuses text in UTF-16, which no single-text format can use.
fn refuse_utf16(bytes: &[u8]) -> Result<(), Error> {
    if !matches!(bytes, [0xFE, 0xFF, ..] | [0xFF, 0xFE, ..]) || stl::is_binary_of_exact_length(bytes) {
        return Ok(());
    }
    Err(MeshFileError::Unsupported { what: "text in UTF-16, which must be saved as UTF-8 first," }.into())
}

#[inline]
fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t'..=b'\r')
}

#[inline]
fn is_line_end(byte: u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}
