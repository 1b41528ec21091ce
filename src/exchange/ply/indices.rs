//! Lists of indices in a PLY: faces, and strips of triangles.

use super::number_kind::NumberKind;
use crate::error::Error;
use crate::exchange::polygons::Polygons;

/// A list of indices.
#[derive(Clone, Copy)]
pub(super) struct Indices {
    pub count: NumberKind,
    pub kind: NumberKind,
    pub strips: bool,
}

/// The marker that ends a strip. No mesh has that many vertices.
const END_OF_STRIP: u32 = u32::MAX;

/// Returns the vertex index to store, if the number is valid.
#[inline]
pub(super) fn vertex(index: i64, of: &Indices, vertices: u64) -> Option<u32> {
    match u32::try_from(index) {
        Ok(index) if u64::from(index) < vertices => Some(index),
        _ if of.strips && index == -1 => Some(END_OF_STRIP),
        _ => None,
    }
}

/// Adds the triangles of strips. Fails with `None` if a strip is too short.
pub(super) fn push_strips(mesh: &mut Polygons, indices: &[u32]) -> Result<(), Option<Error>> {
    for strip in indices.split(|&index| index == END_OF_STRIP) {
        if matches!(strip.len(), 1 | 2) {
            return Err(None);
        }
        for (k, corners) in strip.windows(3).enumerate() {
            let [a, b, c] = [corners[0], corners[1], corners[2]];
            mesh.push_face(&if k % 2 == 0 { [a, b, c] } else { [b, a, c] }).map_err(Some)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::read_ply;
    use super::super::samples::{
        CORNERS, FLOATS, FORMATS, assert_binary, assert_syntax, file, header_length, singles,
    };
    use super::*;
    use crate::error::MeshFileError;
    use alloc::{format, vec};

    #[test]
    fn strips() {
        // A tetrahedron of two strips, and the same tetrahedron of one strip with a turn.
        for (strips, expected) in [
            (vec![vec![vec![0., 2., 1., 3., -1., 2., 0., 3.]]], vec![[0, 2, 1], [1, 2, 3], [2, 0, 3]]),
            (
                vec![vec![vec![0., 2., 1., 3., -1.]], vec![vec![2., 0., 3., -1., -1.]], vec![vec![]]],
                vec![[0, 2, 1], [1, 2, 3], [2, 0, 3]],
            ),
            (vec![vec![vec![2., 0., 1., 3.]]], vec![[2, 0, 1], [1, 0, 3]]),
        ] {
            for format in FORMATS {
                for kind in ["int", "short", "char"] {
                    let list = [&format!("list int {kind} vertex_indices")[..]];
                    let bytes = file(
                        format,
                        &[("vertex", &FLOATS, singles(&CORNERS)), ("tristrips", &list, strips.clone())],
                    );
                    assert_eq!(read_ply(&bytes).unwrap().triangles(), expected, "{format}");
                }
            }
        }
        for strip in [vec![0., 1.], vec![0., 1., 2., -1., 3.]] {
            let elements = [
                ("vertex", &FLOATS[..], singles(&CORNERS)),
                ("tristrips", &["list uchar int vertex_index"][..], vec![vec![strip]]),
            ];
            assert_syntax(file("ascii", &elements), 14, "strips of at least three");
            let bytes = file(FORMATS[1], &elements);
            assert_binary(&bytes, header_length(&bytes) + 48, "strips of at least three");
        }
        let elements = [
            ("vertex", &FLOATS[..], singles(&CORNERS)),
            ("tristrips", &["list uchar int vertex_index"][..], vec![vec![vec![0., 1., -2.]]]),
        ];
        let result = read_ply(&file("ascii", &elements));
        assert!(matches!(
            result,
            Err(Error::MeshFile(MeshFileError::Index { line: 14, index: -2, vertices: 4 }))
        ));
    }
}
