//! The steps for reading an element: the needed properties and their meaning.

use crate::lattice::Each;
use alloc::vec::Vec;

use super::header::{Element, Property};
use super::indices::Indices;
use super::number_kind::NumberKind;
use crate::error::Error;
use crate::exchange::MeshWarning;
use crate::exchange::declared::{Declared, place_of};
use crate::memory;

/// A step of reading an element.
pub(super) enum Step {
    /// Values that are skipped.
    Skip {
        values: u64,
        bytes: u64,
    },
    SkipList {
        count: NumberKind,
        kind: NumberKind,
    },
    Coordinate {
        axis: usize,
        kind: NumberKind,
    },
    /// Red, green, blue or alpha.
    Channel {
        channel: usize,
        kind: NumberKind,
    },
    /// A number of an attribute of faces.
    Value {
        attribute: usize,
        component: usize,
        kind: NumberKind,
    },
    Indices(Indices),
}

/// Returns the steps for an element; none if it has no properties.
pub(super) fn steps(
    element: &Element,
    declared: &mut [Declared<'_>],
    warnings: &mut Vec<MeshWarning>,
) -> Result<Vec<Step>, Error> {
    let mut steps = Vec::new();
    let (mut axes, mut lists) = ([0; 3], 0);
    let channels = channels(element);
    for (place, property) in element.properties.iter().enumerate() {
        let channel = channels.iter().position(|&channel| channel == Some(place));
        let axis = [b"x", b"y", b"z"].iter().position(|axis| *axis == property.name);
        let value = place_of(declared, property.name);
        let is_list =
            matches!(property.name, b"vertex_indices" | b"vertex_index") && property.kind.is_integer();
        let step = match (element.name, axis, property.count) {
            (b"vertex", Some(axis), None) => {
                axes[axis] += 1;
                Step::Coordinate { axis, kind: property.kind }
            }
            (b"face" | b"tristrips", _, Some(count)) if is_list => {
                lists += 1;
                Step::Indices(Indices { count, kind: property.kind, strips: element.name == b"tristrips" })
            }
            (_, _, Some(count)) => Step::SkipList { count, kind: property.kind },
            (_, _, None) if channel.is_some() => {
                Step::Channel { channel: channel.unwrap_or_default(), kind: property.kind }
            }
            (b"face", _, None) if value.is_some() => {
                let (attribute, component) = value.unwrap_or_default();
                declared[attribute].found(property.kind.is_integer());
                Step::Value { attribute, component, kind: property.kind }
            }
            (_, _, None) => {
                let size = property.kind.size() as u64;
                if let Some(Step::Skip { values, bytes }) = steps.last_mut() {
                    (*values, *bytes) = (*values + 1, *bytes + size);
                    continue;
                }
                Step::Skip { values: 1, bytes: size }
            }
        };
        memory::push(&mut steps, step)?;
    }
    let missing = match element.name {
        b"face" | b"tristrips" if lists == 0 && element.count == 0 => {
            let is_known = warnings.iter().any(|known| matches!(known, MeshWarning::NoIndices { .. }));
            if !is_known {
                memory::push(warnings, MeshWarning::NoIndices { line: element.at.line() })?;
            }
            return Ok(steps);
        }
        b"vertex" if axes != [1; 3] => "a vertex with the properties `x`, `y` and `z`, each of them once",
        b"face" if lists != 1 => "a face with one list of integers called `vertex_indices` or `vertex_index`",
        b"tristrips" if lists != 1 => {
            "strips with one list of integers called `vertex_indices` or `vertex_index`"
        }
        _ => return Ok(steps),
    };
    Err(element.at.error(missing).into())
}

/// Returns the properties of a vertex or face that are red, green, blue and alpha of its colour. If one of
/// the first three is missing there is no colour.
fn channels(element: &Element) -> [Option<usize>; 4] {
    let find = |name: &[u8]| {
        let is_it = |property: &Property| property.name == name && property.count.is_none();
        element.properties.iter().position(is_it)
    };
    if !matches!(element.name, b"vertex" | b"face") {
        return [None; 4];
    }
    let names: [[&[u8]; 4]; 2] = [
        [b"red", b"green", b"blue", b"alpha"],
        [b"diffuse_red", b"diffuse_green", b"diffuse_blue", b"diffuse_alpha"],
    ];
    let all = names.each(|names| names.each(find));
    match all.into_iter().find(|channels| channels[..3].iter().all(Option::is_some)) {
        Some([red, green, blue, alpha]) => [red, green, blue, alpha.or(all[0][3])],
        None => [None; 4],
    }
}

/// Returns the least number of values of a readable element, and of their bytes.
pub(super) fn least(element: &Element) -> (usize, usize) {
    let of = |property: &Property| match property.count {
        None => (1, property.kind.size()),
        // A face has at least three corners.
        Some(count)
            if element.name == b"face" && matches!(property.name, b"vertex_indices" | b"vertex_index") =>
        {
            (4, count.size() + 3 * property.kind.size())
        }
        Some(count) => (1, count.size()),
    };
    element.properties.iter().map(of).fold((0, 0), |sum, more| (sum.0 + more.0, sum.1 + more.1))
}

#[cfg(test)]
mod tests {
    use super::super::samples::{
        CORNERS, FLOATS, FORMATS, INTS, XYZ, assert_syntax, assert_tetrahedron, faces, file, singles,
    };
    use super::super::{read, read_ply};
    use super::*;
    use alloc::{format, vec};

    #[test]
    fn coordinates_and_indices_of_all_types() {
        let types = [
            "char", "int8", "uchar", "uint8", "short", "int16", "ushort", "uint16", "int", "int32", "uint",
            "uint32", "float", "float32", "double", "float64",
        ];
        for format in FORMATS {
            for kind in types {
                let properties = [&format!("{kind} x")[..], "double y", "float64 z"];
                let corners: [&[f64]; 4] = [&[0., 0., 0.], &[100., 0., 0.], &[0., 0.1, 0.], &[0., 0., 0.125]];
                let bytes =
                    file(format, &[("vertex", &properties, singles(&corners)), ("face", &INTS, faces())]);
                let mesh = read_ply(&bytes).unwrap();
                assert_eq!(
                    mesh.vertices(),
                    [[0.0; 3], [100., 0., 0.], [0., 0.1, 0.], [0., 0., 0.125]],
                    "{kind}"
                );
            }
            for kind in &types[..12] {
                for count in &types[..12] {
                    for name in ["vertex_indices", "vertex_index"] {
                        let list = format!("list {count} {kind} {name}");
                        let faces = ("face", &[&list[..]][..], faces());
                        let bytes = file(format, &[("vertex", &FLOATS, singles(&CORNERS)), faces]);
                        assert_tetrahedron(bytes, 0.125);
                    }
                }
            }
            for kind in &types[12..] {
                for list in
                    [format!("list uchar {kind} vertex_indices"), format!("list {kind} int vertex_indices")]
                {
                    let faces = ("face", &[&list[..]][..], faces());
                    let bytes = file(format, &[("vertex", &FLOATS, singles(&CORNERS)), faces]);
                    let line = 7 + list.starts_with(&format!("list {kind}")) as u64;
                    assert_syntax(bytes, line, "integer");
                }
            }
        }
    }

    #[test]
    fn other_elements_and_properties_are_skipped() {
        let vertex =
            ["uchar red", "list uint8 float64 more", "float y", "int8 a", "double b", "float x", "float z"];
        let vertices = CORNERS.map(|c| {
            vec![
                vec![7.],
                vec![0.5; 1 + c[0] as usize],
                vec![c[1]],
                vec![3.],
                vec![0.1],
                vec![c[0]],
                vec![c[2]],
            ]
        });
        let face = [
            "list uchar float texcoord",
            "float quality",
            "list char short vertex_index",
            "uchar a",
            "uchar b",
        ];
        let faces =
            faces().into_iter().map(|face| vec![vec![0.5; 6], vec![1.], face[0].clone(), vec![1.], vec![2.]]);
        let other = vec![vec![vec![1., 2., 3.], vec![4.]], vec![vec![], vec![5.]]];
        let other = ("vertex_indices", &["list int uint x", "double y"][..], other);
        let nothing = ("nothing", &[][..], vec![vec![]; 5]);
        let vertices = ("vertex", &vertex[..], vertices.to_vec());
        let faces = ("face", &face[..], faces.collect());
        for format in FORMATS {
            let orders = [[&other, &vertices, &faces, &nothing], [&faces, &nothing, &other, &vertices]];
            for order in orders {
                assert_tetrahedron(file(format, &order.map(Clone::clone)), 0.125);
            }
        }
    }

    #[test]
    fn no_faces_need_no_list() {
        for format in FORMATS {
            let head =
                format!("ply\nformat {format} 1.0\nelement vertex 0\n{XYZ}element face 0\nend_header\n");
            let mut warnings = vec![];
            let mesh = read(head.as_bytes(), &mut warnings).unwrap();
            assert_eq!(
                (mesh.triangles().len(), &warnings[..]),
                (0, &[MeshWarning::NoIndices { line: 7 }][..])
            );
            assert_syntax(head.replace("face 0", "face 1"), 7, "one list of integers");
        }
    }
}
