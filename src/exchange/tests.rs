//! Helpers for the tests of all readers.

extern crate std;

use alloc::vec::Vec;
use proptest::prelude::*;
use std::io::Write;
use std::path::PathBuf;

use crate::error::{Error, MeshFileError};
use crate::mesh::TriangleMesh;

/// Returns the folder of models, or `None` and prints a line if it is not set.
pub(super) fn models() -> Option<PathBuf> {
    let folder = std::env::var_os("LEAFLESS_MODELS");
    if folder.is_none() {
        // Written to the standard error itself, because captured output of passing tests is hidden.
        let test = std::thread::current();
        let test = test.name().unwrap_or_default();
        let _ = writeln!(std::io::stderr(), "SKIPPED {test}: LEAFLESS_MODELS is not set");
    }
    folder.map(PathBuf::from)
}

/// Returns a model file, or `None` if the tests run without models.
pub(super) fn model(name: &str) -> Option<Vec<u8>> {
    let path = models()?.join(name);
    Some(std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display())))
}

#[track_caller]
pub(super) fn is_syntax_error(result: Result<TriangleMesh, Error>, at: u64, what: &str) {
    match result {
        Err(Error::MeshFile(MeshFileError::Syntax { line, expected })) => {
            assert_eq!(line, at, "{expected}");
            assert!(expected.contains(what), "{expected}");
        }
        other => panic!("{other:?}"),
    }
}

/// Different vertices with coordinates of all kinds, and faces that are fans: each has three to six corners
/// on a parabola, and is therefore convex and plane.
pub(super) fn random_polygons() -> impl Strategy<Value = (Vec<[f64; 3]>, Vec<Vec<u32>>)> {
    let shift = prop_oneof![
        Just(0.0),
        Just(1e-3),
        Just(-123.456),
        -1e9..1e9,
        any::<f32>().prop_map(|x| x as f64 % 1e20)
    ];
    let faces = proptest::collection::vec(proptest::collection::btree_set(0u32..12, 3..=6), 0..20);
    (shift.clone(), shift, faces).prop_map(|(y, z, faces)| {
        let vertices = (0..12).map(|i| [f64::from(i), y, z + f64::from(i * i) * z.abs().max(1.0)]).collect();
        (vertices, faces.into_iter().map(|face| face.into_iter().collect()).collect())
    })
}

/// Checks that `mesh` has these vertices and faces.
#[track_caller]
pub(super) fn same(mesh: TriangleMesh, vertices: Vec<[f64; 3]>, faces: &[Vec<u32>]) {
    let fan = |face: &Vec<u32>| {
        let (first, others) = face.split_first().unwrap();
        others.windows(2).map(|pair| [*first, pair[0], pair[1]]).collect::<Vec<_>>()
    };
    let expected = TriangleMesh::new(vertices, faces.iter().flat_map(fan).collect()).unwrap();
    assert_eq!(mesh.vertices(), expected.vertices());
    assert_eq!(mesh.triangles(), expected.triangles());
}

/// Reads `bytes` cut at every length and with every byte changed in several ways: each gives an answer or an
/// error, but no panic. That most results are errors shows that checks take place at all.
pub(super) fn truncations_and_damages(read: fn(&[u8]) -> Result<TriangleMesh, Error>, bytes: &[u8]) {
    read(bytes).unwrap();
    for length in 0..bytes.len() {
        let _ = read(&bytes[..length]);
    }
    let mut refused = 0;
    for i in 0..bytes.len() {
        for value in
            [0, 1, 3, b'\n', b'\r', b' ', b'#', b'\\', b'-', b'/', b'9', b'e', 0x7F, 0x80, 0xFF, bytes[i] ^ 1]
        {
            let mut damaged = bytes.to_vec();
            damaged[i] = value;
            refused += read(&damaged).is_err() as usize;
            damaged.remove(i);
            refused += read(&damaged).is_err() as usize;
        }
    }
    assert!(refused > 2 * bytes.len(), "{refused} of {}", 32 * bytes.len());
}
