//! PLY files, ASCII and binary of both byte orders: reader.
//!
//! **Header.** `ply`, one `format` (`ascii`, `binary_little_endian` or `binary_big_endian`, version 1.0),
//! elements with their properties, and `end_header`. `comment` and `obj_info` may stand on any line between.
//! Lines end with LF, CR or both. Other lines before the first element count as comments, with a warning:
//! Blender 2.47 and Assimp 3.0 forgot the keyword. The types are `char`, `uchar`, `short`, `ushort`, `int`,
//! `uint`, `float`, `double` and their synonyms `int8` to `float64`. Any other keyword or type is refused.
//!
//! **Colours.** Vertices and faces may have the properties `red`, `green` and `blue`, and `alpha`; or
//! `diffuse_red` and so on. Integers are from 0 to 255, but `ushort` from 0 to 65 535, and floating point
//! numbers from 0 to 1. If an element has a number out of range, or no number, its colour is left out, with a
//! warning.
//!
//! **Attributes** of faces that this library wrote are announced by comments in the header (`declared`).
//!
//! **Elements** come in any order. Elements of other names, and all properties that are not needed, single
//! ones and lists, are skipped. `vertex` needs `x`, `y` and `z` of any type. `face` needs a list of integers
//! named `vertex_indices` or `vertex_index`, of three or more vertices each. Without such a list, the header
//! must announce no faces, and there is a warning. `tristrips`, as in the Stanford scans, needs a list of
//! that name, in which -1 ends a strip; every second triangle is reversed.
//!
//! **ASCII.** The values of an element are separated by white space, also by line ends; each element begins
//! on a new line. If the first element of a kind has more values on its line than the header announces, these
//! are skipped, with a warning; every element of the kind must then have as many. A decimal coordinate
//! becomes the nearest `f64`, also if its type is `float`.
//!
//! **Binary.** Coordinates are read exactly.
//!
//! **The end.** Only white space, zero bytes and Ctrl-Z may follow the last element: if there is more, the
//! header's counts are wrong. Nothing is allocated for data that a header claims and the file does not
//! contain.

mod ascii;
mod binary;
mod elements;
mod header;
mod indices;
mod number_kind;
mod palette;
#[cfg(test)]
mod samples;
mod source;
mod steps;

use alloc::vec::Vec;

use super::bytes::Bytes;
use super::text::Text;
use super::{MeshWarning, refuse_utf16};
use crate::error::{Error, MeshFileError};
use crate::mesh::TriangleMesh;
use elements::read_elements;
use header::{Encoding, Header};

/// Reads a PLY file, ASCII or binary.
///
/// Triangles keep the order of the faces. A face of more than three corners is triangulated within the face.
/// If that is impossible, because its edges cross or it has no area, it becomes the fan around its first
/// corner. Equal vertices are welded, and triangles that become degenerate by that are dropped and counted,
/// as in [`TriangleMesh::new`]. The mesh need not be closed, and may be empty. Colours of vertices become the
/// attribute `colour` of corners. Colours of faces become the attribute `colour` of triangles, or
/// `face_colour` if vertices have colours as well.
///
/// O(n), or O(n log n) for faces that are not convex. Memory is at most 128 times the length of the file,
/// whatever the header claims. The warnings of [`read_mesh`](super::read_mesh) are not reported.
///
/// # Errors
/// [`MeshFileError::Empty`], [`MeshFileError::Unsupported`] (UTF-16), [`MeshFileError::Syntax`] and
/// [`MeshFileError::Index`] (in the header, and in an ASCII file), [`MeshFileError::Binary`] and
/// [`MeshFileError::BinaryIndex`], [`MeshError::TooLarge`](crate::error::MeshError::TooLarge),
/// [`MeshError::TooMany`](crate::error::MeshError::TooMany) or [`Error::OutOfMemory`].
pub fn read_ply(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    read(bytes, &mut Vec::new())
}

/// Reads a PLY file and adds warnings.
pub(super) fn read(bytes: &[u8], warnings: &mut Vec<MeshWarning>) -> Result<TriangleMesh, Error> {
    if bytes.is_empty() {
        return Err(MeshFileError::Empty.into());
    }
    refuse_utf16(bytes)?;
    let Header { encoding, elements, declared, length } = Header::read(bytes, warnings)?;
    match encoding {
        Encoding::Ascii => {
            let mut text = Text::new(bytes);
            text.continue_with(text.rest().get(length..).unwrap_or(&[]));
            read_elements((&elements, declared), text, warnings)
        }
        Encoding::Little => {
            read_elements((&elements, declared), Bytes::<false>::new(bytes, length), warnings)
        }
        Encoding::Big => read_elements((&elements, declared), Bytes::<true>::new(bytes, length), warnings),
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{model, random_polygons, same, truncations_and_damages};
    use super::samples::{FORMATS, ascii, assert_tetrahedron, file, header, plain};
    use super::*;
    use alloc::vec;
    use proptest::prelude::*;

    #[test]
    fn all_three_formats() {
        assert_tetrahedron(ascii(), 1e-3);
        for format in FORMATS {
            assert_tetrahedron(plain(format), 0.125);
        }
    }

    #[test]
    fn truncated_and_damaged() {
        for format in FORMATS {
            truncations_and_damages(read_ply, &plain(format));
        }
    }

    proptest! {
        #![proptest_config(leafless_testkit::cases(1000))]

        /// Any mesh, in any format, with vertices before or after the faces.
        #[test]
        fn written_meshes_come_back(
            (vertices, faces) in random_polygons(),
            format in proptest::sample::select(&FORMATS[..]),
            before in any::<bool>(),
            more in any::<bool>(),
        ) {
            let xyz = ["double x", "double y", "double z", "list uchar uchar more"];
            let rows = vertices.iter().map(|v| {
                let row = v.iter().map(|&x| vec![x]).chain([vec![1.; v[0] as usize]]);
                row.take(3 + more as usize).collect()
            });
            let list = ["list uchar int vertex_indices", "float more"];
            let lists = faces.iter().map(|face| {
                let row = [face.iter().map(|&v| v.into()).collect(), vec![0.5]];
                row.into_iter().take(1 + more as usize).collect()
            });
            let mut elements = [
                ("vertex", &xyz[..3 + more as usize], rows.collect::<Vec<_>>()),
                ("face", &list[..1 + more as usize], lists.collect()),
            ];
            if before {
                elements.reverse();
            }
            same(read_ply(&file(format, &elements)).unwrap(), vertices, &faces);
        }

        #[test]
        fn any_data(text in "[0-9.e \n-]{0,100}", bytes in proptest::collection::vec(any::<u8>(), 0..100)) {
            let _ = read_ply((header("ascii") + &text).as_bytes());
            for format in &FORMATS[1..] {
                let _ = read_ply(&[header(format).as_bytes(), &bytes].concat());
            }
        }
    }

    #[test]
    fn a_real_file() {
        let Some(bytes) = model("cycloidal.ply") else { return };
        let mesh = read_ply(&bytes).unwrap();
        let report = mesh.report().unwrap();
        assert_eq!((report.facets_read, report.vertices + report.welded), (43_368, 21_384));
    }
}
