//! Attributes of meshes, written into files and read back.

use leafless::TriangleMesh;
use leafless::exchange::{MeshFormat, MeshOptions, WriteOptions, read_mesh, write_mesh};
use leafless::mesh::{AttributeDomain, MeshAttribute};
use leafless_testkit::Random;

/// A strip of `count` triangles.
fn strip(count: usize) -> TriangleMesh {
    let vertices = (0..count + 2).map(|i| [i as f64, (i % 2) as f64, 0.25 * i as f64]).collect();
    TriangleMesh::new(vertices, (0..count as u32).map(|i| [i, i + 1, i + 2]).collect()).unwrap()
}

fn back(mesh: &TriangleMesh, format: MeshFormat, text: bool) -> TriangleMesh {
    let bytes = write_mesh(mesh, format, &WriteOptions { text, ..WriteOptions::default() }).unwrap();
    let file = read_mesh(&bytes, &MeshOptions::default()).unwrap_or_else(|error| panic!("{format}: {error}"));
    assert_eq!(file.warnings, []);
    assert_eq!((file.mesh.vertices(), file.mesh.triangles()), (mesh.vertices(), mesh.triangles()));
    file.mesh
}

fn values(mesh: &TriangleMesh, name: &str) -> Vec<[Option<[f64; 4]>; 3]> {
    let attribute = mesh.attribute(name).unwrap_or_else(|| panic!("no {name}"));
    (0..attribute.len()).map(|t| [0, 1, 2].map(|corner| attribute.value(t, corner))).collect()
}

/// Returns the name of each triangle's material.
fn materials(mesh: &TriangleMesh) -> Vec<Option<String>> {
    let attribute = mesh.attribute("material").unwrap();
    let name = |t| attribute.value(t, 0).map(|value: [f64; 4]| attribute.names()[value[0] as usize].clone());
    (0..attribute.len()).map(name).collect()
}

const NAMES: [&str; 5] = ["steel", "an alloy of \"A\" & <B>", "Gußeisen", "C:\\", "a#b"];

#[test]
fn materials_come_back_by_name() {
    let mut random = Random(5);
    for count in [1, 2, 7, 40] {
        let labels: Vec<u32> = (0..count)
            .map(|_| if random.below(5) == 0 { u32::MAX } else { random.below(5) as u32 })
            .collect();
        let names = NAMES.map(str::to_owned).to_vec();
        let mut mesh = strip(count);
        mesh.add_attribute(MeshAttribute::labels("material", labels.clone()).unwrap().named(names)).unwrap();
        let expected: Vec<_> =
            labels.iter().map(|&l| NAMES.get(l as usize).map(|name| name.to_string())).collect();
        if expected.iter().all(Option::is_none) {
            continue;
        }
        for text in [false, true] {
            assert_eq!(materials(&back(&mesh, MeshFormat::Obj, text)), expected);
            let ply = back(&mesh, MeshFormat::Ply, text);
            assert_eq!(ply.attribute("material"), mesh.attribute("material"));
        }
        #[cfg(feature = "threemf")]
        {
            assert_eq!(materials(&back(&mesh, MeshFormat::ThreeMf, false)), expected);
            // Each material has the colour of its first triangle.
            let colours: Vec<f64> =
                labels.iter().flat_map(|&l| [f64::from(l % 7), 2.0, 255.0, 7.0]).collect();
            mesh.add_attribute(MeshAttribute::per_triangle("colour", 4, &colours).unwrap()).unwrap();
            let found = back(&mesh, MeshFormat::ThreeMf, false);
            assert_eq!(materials(&found), expected);
            for (t, name) in expected.iter().enumerate().filter(|(_, name)| name.is_some()) {
                assert_eq!(values(&found, "colour")[t], values(&mesh, "colour")[t], "{name:?}");
            }
        }
    }
    // A material without a name, or without a name on one line, gets a name.
    let mut mesh = strip(3);
    let names = vec!["two\nlines".to_owned(), String::new()];
    mesh.add_attribute(MeshAttribute::labels("material", vec![0, 1, 2]).unwrap().named(names)).unwrap();
    let names = ["two lines", "material_1", "material_2"].map(|name| Some(name.to_owned()));
    assert_eq!(materials(&back(&mesh, MeshFormat::Obj, true)), names);
    // Groups have the greatest possible length.
    let mesh = &mut strip(4);
    mesh.add_attribute(MeshAttribute::labels("material", vec![1, 1, 0, u32::MAX]).unwrap()).unwrap();
    let bytes = write_mesh(mesh, MeshFormat::Obj, &WriteOptions::default()).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with('v')).collect();
    let expected =
        ["usemtl material_1", "f 1 2 3", "f 2 3 4", "usemtl material_0", "f 3 4 5", "usemtl", "f 4 5 6"];
    assert_eq!(lines, expected);
}

#[test]
fn colours_come_back() {
    let mut random = Random(6);
    let mut colours =
        |count: usize| -> Vec<f64> { (0..4 * count).map(|_| random.below(256) as f64).collect() };
    for count in [1, 3, 30] {
        // Colours of triangles.
        for name in ["colour", "face_colour"] {
            let mut mesh = strip(count);
            mesh.add_attribute(MeshAttribute::per_triangle(name, 4, &colours(count)).unwrap()).unwrap();
            for text in [false, true] {
                assert_eq!(values(&back(&mesh, MeshFormat::Ply, text), "colour"), values(&mesh, name));
            }
            if cfg!(feature = "threemf") {
                let found = back(&mesh, MeshFormat::ThreeMf, false);
                assert_eq!(values(&found, "colour"), values(&mesh, name));
                assert_eq!(found.attribute("colour").unwrap().domain(), AttributeDomain::Triangle);
            }
        }
        // Colours of vertices, and of triangles in addition.
        let mut mesh = strip(count);
        let of_vertices = colours(count + 2);
        let rows = mesh.triangles().to_vec();
        mesh.add_attribute(MeshAttribute::by_corner("colour", 4, of_vertices, rows).unwrap()).unwrap();
        mesh.add_attribute(MeshAttribute::per_triangle("face_colour", 4, &colours(count)).unwrap()).unwrap();
        for text in [false, true] {
            let found = back(&mesh, MeshFormat::Ply, text);
            for name in ["colour", "face_colour"] {
                assert_eq!(values(&found, name), values(&mesh, name));
            }
        }
        // Colours of corners.
        let mut mesh = strip(count);
        mesh.add_attribute(MeshAttribute::per_corner("colour", 4, &colours(3 * count)).unwrap()).unwrap();
        if cfg!(feature = "threemf") {
            assert_eq!(values(&back(&mesh, MeshFormat::ThreeMf, false), "colour"), values(&mesh, "colour"));
        }
        let found = back(&mesh, MeshFormat::Ply, false);
        assert_eq!(values(&found, "colour")[0], values(&mesh, "colour")[0], "the first corner's counts");
    }
    // Three numbers are an opaque colour, other values are rounded, and triangles without a value are
    // transparent.
    let mut mesh = strip(3);
    let numbers = [0.4, 254.6, 300.0, f64::NAN, 0.0, 0.0, -7.0, 1.0, 2.0];
    mesh.add_attribute(MeshAttribute::per_triangle("colour", 3, &numbers).unwrap()).unwrap();
    let found = back(&mesh, MeshFormat::Ply, true);
    let expected = [[0.0, 255.0, 255.0, 255.0], [0.0; 4], [0.0, 1.0, 2.0, 255.0]];
    assert_eq!(values(&found, "colour"), expected.map(|value| [Some(value); 3]));
}

#[test]
fn numbers_are_properties_of_faces() {
    let mut random = Random(7);
    let mut mesh = strip(20);
    for (name, components) in [("heat", 1), ("stress", 3), ("pair", 2), ("four", 4)] {
        let numbers: Vec<f64> = (0..20 * components)
            .map(|_| if random.below(9) == 0 { f64::NAN } else { random.between(-1e9, 1e9) })
            .collect();
        mesh.add_attribute(MeshAttribute::per_triangle(name, components, &numbers).unwrap()).unwrap();
    }
    let labels = (0..20).map(|i| if i == 3 { u32::MAX } else { i % 3 }).collect();
    mesh.add_attribute(MeshAttribute::labels("part", labels).unwrap()).unwrap();
    // PLY cannot store these attributes.
    mesh.add_attribute(MeshAttribute::per_triangle("two words", 1, &[0.0; 20]).unwrap()).unwrap();
    mesh.add_attribute(MeshAttribute::per_triangle("red", 1, &[0.0; 20]).unwrap()).unwrap();
    mesh.add_attribute(MeshAttribute::per_corner("corner", 1, &[0.0; 60]).unwrap()).unwrap();
    for text in [false, true] {
        let found = back(&mesh, MeshFormat::Ply, text);
        let names: Vec<&str> = found.attributes().iter().map(MeshAttribute::name).collect();
        assert_eq!(names, ["heat", "stress", "pair", "four", "part"]);
        for name in names {
            assert_eq!(values(&found, name), values(&mesh, name), "{name}");
        }
        assert_eq!(found.attribute("part"), mesh.attribute("part"));
    }
}

/// Comments that announce malformed attributes announce nothing.
#[test]
fn what_is_announced_badly_is_no_attribute() {
    let head = |comments: &str, properties: &str| {
        format!(
            "ply\nformat ascii 1.0\n{comments}element vertex 3\nproperty double x\nproperty double y\nproperty double z\n\
             element face 1\nproperty list uchar int vertex_indices\n{properties}end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 5 6\n"
        )
    };
    let property = "property double heat\nproperty uchar red\n";
    for (comments, count) in [
        ("comment leafless attribute 1 heat\n", 1),
        ("comment leafless attribute 1 heat\ncomment leafless attribute 1 heat\n", 1),
        (
            "comment leafless attribute 1 heat\ncomment leafless name other a\ncomment leafless name heat b\n",
            1,
        ),
        ("", 0),
        ("comment leafless attribute 0 heat\n", 0),
        ("comment leafless attribute 5 heat\n", 0),
        ("comment leafless attribute heat\n", 0),
        ("comment leafless attribute 1 cold\n", 0),
        ("comment leafless attribute 2 heat\n", 0),
        ("comment leafless attribute 1 red\n", 0),
    ] {
        let file = read_mesh(head(comments, property).as_bytes(), &MeshOptions::default()).unwrap();
        assert_eq!(file.mesh.attributes().len(), count, "{comments}");
    }
    let many: String = (0..2000).map(|i| format!("comment leafless attribute 1 a{i}\n")).collect();
    let file = read_mesh(head(&many, property).as_bytes(), &MeshOptions::default()).unwrap();
    assert_eq!(file.mesh.attributes(), []);
}
