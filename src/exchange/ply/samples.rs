//! PLY files for tests.

use alloc::string::String;
use alloc::vec::Vec;
use alloc::{format, vec};

use super::{read, read_ply};
use crate::error::{Error, MeshFileError};
use crate::exchange::MeshWarning;
use crate::exchange::tests::is_syntax_error;
use crate::mesh::FillRule;

pub(super) const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";
pub(super) const LIST: &str = "property list uchar int vertex_indices\n";
pub(super) const DATA: &str = "0 0 0\n1.5 0 0\n0 2.25 0\n0 0 1e-3\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

pub(super) fn header(format: &str) -> String {
    format!("ply\nformat {format} 1.0\nelement vertex 4\n{XYZ}element face 4\n{LIST}end_header\n")
}

pub(super) fn ascii() -> String {
    header("ascii") + DATA
}

/// Returns a number as bytes of the type with this name.
pub(super) fn bytes_of(value: f64, kind: &str, big: bool) -> Vec<u8> {
    let mut bytes = match kind {
        "char" | "int8" => (value as i8).to_le_bytes().to_vec(),
        "uchar" | "uint8" => (value as u8).to_le_bytes().to_vec(),
        "short" | "int16" => (value as i16).to_le_bytes().to_vec(),
        "ushort" | "uint16" => (value as u16).to_le_bytes().to_vec(),
        "int" | "int32" => (value as i32).to_le_bytes().to_vec(),
        "uint" | "uint32" => (value as u32).to_le_bytes().to_vec(),
        "float" | "float32" => (value as f32).to_le_bytes().to_vec(),
        "double" | "float64" => value.to_le_bytes().to_vec(),
        _ => panic!("{kind}"),
    };
    if big {
        bytes.reverse();
    }
    bytes
}

pub(super) const FORMATS: [&str; 3] = ["ascii", "binary_little_endian", "binary_big_endian"];

/// Elements of one kind: the name, the properties as in the header, and the values of each element.
pub(super) type Elements<'a> = (&'a str, &'a [&'a str], Vec<Vec<Vec<f64>>>);

pub(super) fn file(format: &str, elements: &[Elements]) -> Vec<u8> {
    let mut bytes = format!("ply\nformat {format} 1.0\n").into_bytes();
    for (name, properties, values) in elements {
        bytes.extend(format!("element {name} {}\n", values.len()).bytes());
        properties.iter().for_each(|property| bytes.extend(format!("property {property}\n").bytes()));
    }
    bytes.extend(b"end_header\n");
    for (_, properties, values) in elements {
        for element in values {
            for (property, values) in properties.iter().zip(element) {
                let words: Vec<&str> = property.split(' ').collect();
                let list = words[0] == "list";
                let all = list.then_some((values.len() as f64, words[1])).into_iter();
                for (value, kind) in all.chain(values.iter().map(|&v| (v, words[2 * list as usize]))) {
                    if format == "ascii" {
                        bytes.extend(format!("{value} ").bytes());
                    } else {
                        bytes.extend(bytes_of(value, kind, format == "binary_big_endian"));
                    }
                }
            }
            if format == "ascii" {
                bytes.push(b'\n');
            }
        }
    }
    bytes
}

/// Values of elements without lists.
pub(super) fn singles(rows: &[&[f64]]) -> Vec<Vec<Vec<f64>>> {
    rows.iter().map(|row| row.iter().map(|&value| vec![value]).collect()).collect()
}

pub(super) fn faces() -> Vec<Vec<Vec<f64>>> {
    [[0., 2., 1.], [0., 1., 3.], [1., 2., 3.], [2., 0., 3.]].map(|face| vec![face.to_vec()]).to_vec()
}

pub(super) const CORNERS: [&[f64]; 4] = [&[0., 0., 0.], &[1.5, 0., 0.], &[0., 2.25, 0.], &[0., 0., 0.125]];

/// A tetrahedron with the given height.
#[track_caller]
pub(super) fn assert_tetrahedron(bytes: impl AsRef<[u8]>, height: f64) {
    let mesh = read_ply(bytes.as_ref()).unwrap();
    assert_eq!(mesh.vertices(), [[0., 0., 0.], [1.5, 0., 0.], [0., 2.25, 0.], [0., 0., height]]);
    assert_eq!(mesh.triangles(), [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
    mesh.check_closed(FillRule::NonZero).unwrap();
}

#[track_caller]
pub(super) fn assert_syntax(text: impl AsRef<[u8]>, at: u64, what: &str) {
    is_syntax_error(read_ply(text.as_ref()), at, what);
}

#[track_caller]
pub(super) fn assert_binary(bytes: &[u8], at: usize, what: &str) {
    match read_ply(bytes) {
        Err(Error::MeshFile(MeshFileError::Binary { offset, expected })) => {
            assert_eq!(offset, at as u64, "{expected}");
            assert!(expected.contains(what), "{expected}");
        }
        other => panic!("{other:?}"),
    }
}

pub(super) const FLOATS: [&str; 3] = ["float x", "float y", "float z"];
pub(super) const INTS: [&str; 1] = ["list uchar int vertex_indices"];

pub(super) fn plain(format: &str) -> Vec<u8> {
    file(format, &[("vertex", &FLOATS, singles(&CORNERS)), ("face", &INTS, faces())])
}

/// Returns the length of the header of [`plain`] in bytes.
pub(super) fn header_length(bytes: &[u8]) -> usize {
    bytes.windows(11).position(|window| window == b"end_header\n").unwrap() + 11
}

/// Returns the warnings for a file whose mesh is the tetrahedron.
#[track_caller]
pub(super) fn warnings_of(bytes: impl AsRef<[u8]>, height: f64) -> Vec<MeshWarning> {
    let mut warnings = vec![];
    read(bytes.as_ref(), &mut warnings).unwrap();
    assert_tetrahedron(bytes, height);
    warnings
}
