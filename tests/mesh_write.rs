//! Written mesh files come back as they were, through the readers of this library and through foreign ones.

mod common;

use common::{Random, cases};
use leafless::exchange::{LengthUnit, MeshFormat, MeshOptions, WriteOptions, read_mesh, write_mesh};
use leafless::{Error, TriangleMesh};
use ply_rs_bw::{parser::Parser, ply::DefaultElement, ply::Property};
use proptest::prelude::*;

/// Coordinates with few and with all digits, tiny, huge, and zeros of both signs.
fn coordinate(random: &mut Random) -> f64 {
    let sign = if random.below(2) == 0 { -1.0 } else { 1.0 };
    sign * match random.below(6) {
        0 => 0.0,
        1 => random.below(100) as f64,
        2 => random.below(1000) as f64 / 64.0,
        3 => random.between(0.0, 1.0),
        4 => random.between(1.0, 2.0) * 2f64.powi(random.below(240) as i32 - 120),
        _ => random.between(1.0, 9.0) * 1e-7,
    }
}

/// Triangles of three different vertices, all of which some triangle has.
fn mesh(seed: u64) -> TriangleMesh {
    let mut random = Random(seed);
    let vertices: Vec<[f64; 3]> =
        (0..3 + random.below(40)).map(|_| [0; 3].map(|_| coordinate(&mut random))).collect();
    let count = vertices.len() as u32;
    let triangles = (0..count).map(|i| {
        let step = 1 + random.below(u64::from(count) - 2) as u32;
        [i, (i + step) % count, (i + step + 1 + (step + 1 == count) as u32) % count]
    });
    TriangleMesh::new(vertices, triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect()).unwrap()
}

const FORMATS: [MeshFormat; 4] = [MeshFormat::Stl, MeshFormat::Obj, MeshFormat::Ply, MeshFormat::Off];

fn written(mesh: &TriangleMesh, format: MeshFormat, text: bool) -> Vec<u8> {
    write_mesh(mesh, format, &WriteOptions { text, ..WriteOptions::default() }).unwrap()
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn what_is_written_comes_back(seed: u64) {
        let mesh = mesh(seed);
        for format in FORMATS {
            for text in [false, true] {
                let back = read_mesh(&written(&mesh, format, text), &MeshOptions::default()).unwrap();
                prop_assert_eq!(back.format, format);
                prop_assert!(back.warnings.is_empty());
                if format == MeshFormat::Stl {
                    let corners = |mesh: &TriangleMesh| -> Vec<[[f32; 3]; 3]> {
                        let corner = |v: &u32| mesh.vertices()[*v as usize].map(|x| x as f32 + 0.0);
                        mesh.triangles().iter().map(|t| [0, 1, 2].map(|k| corner(&t[k]))).collect()
                    };
                    let distinct = |[a, b, c]: &[[f32; 3]; 3]| a != b && b != c && c != a;
                    let expected: Vec<_> = corners(&mesh).into_iter().filter(distinct).collect();
                    prop_assert!(back.mesh.triangles().len() <= expected.len());
                    prop_assert_eq!(corners(&back.mesh), expected);
                } else {
                    prop_assert_eq!(back.mesh.vertices(), mesh.vertices());
                    prop_assert_eq!(back.mesh.triangles(), mesh.triangles());
                }
            }
        }
    }

    /// Normals stand beside vertices, for this library's readers and for foreign ones.
    #[test]
    fn normals_are_written(seed: u64) {
        let mesh = mesh(seed);
        let normals: Vec<[f32; 3]> =
            mesh.vertex_normals().unwrap().iter().map(|normal| normal.map(|x| x as f32)).collect();
        for format in FORMATS {
            for text in [false, true] {
                let options = WriteOptions { text, normals: true, unit: None };
                let bytes = write_mesh(&mesh, format, &options).unwrap();
                if matches!(format, MeshFormat::Stl | MeshFormat::Off) {
                    prop_assert_eq!(&bytes, &written(&mesh, format, text));
                    continue;
                }
                let back = read_mesh(&bytes, &MeshOptions::default()).unwrap();
                prop_assert_eq!(back.mesh.vertices(), mesh.vertices());
                prop_assert_eq!(back.mesh.triangles(), mesh.triangles());
                let found: Vec<[f32; 3]> = if format == MeshFormat::Ply {
                    let ply = Parser::<DefaultElement>::new().read_ply(&mut &bytes[..]).unwrap();
                    let float = |vertex: &DefaultElement, name: &str| match vertex[name] {
                        Property::Float(x) => x,
                        _ => panic!("{name} is no float"),
                    };
                    ply.payload["vertex"].iter().map(|v| ["nx", "ny", "nz"].map(|n| float(v, n))).collect()
                } else {
                    let text = std::str::from_utf8(&bytes).unwrap();
                    let normals = text.lines().filter_map(|line| line.strip_prefix("vn "));
                    let parsed = normals.map(|line| {
                        let numbers: Vec<f32> = line.split(' ').map(|x| x.parse().unwrap()).collect();
                        [numbers[0], numbers[1], numbers[2]]
                    });
                    parsed.collect()
                };
                prop_assert_eq!(&found, &normals);
            }
        }
    }

    #[cfg(feature = "threemf")]
    #[test]
    fn a_package_comes_back_with_its_unit(seed: u64, unit in 0..6usize) {
        let (mesh, unit) = (mesh(seed), LengthUnit::ALL[unit]);
        let bytes = write_mesh(&mesh, MeshFormat::ThreeMf, &WriteOptions { unit: Some(unit), ..WriteOptions::default() }).unwrap();
        let back = read_mesh(&bytes, &MeshOptions::default()).unwrap();
        prop_assert_eq!((back.format, back.unit), (MeshFormat::ThreeMf, Some(unit)));
        prop_assert!(back.warnings.is_empty() && back.skipped == 0);
        prop_assert_eq!(back.mesh.vertices(), mesh.vertices());
        prop_assert_eq!(back.mesh.triangles(), mesh.triangles());
    }

    #[test]
    fn foreign_readers_read_what_is_written(seed: u64) {
        let mesh = mesh(seed);
        let obj = written(&mesh, MeshFormat::Obj, true);
        let (models, _) = tobj::load_obj_buf(&mut obj.as_slice(), &tobj::LoadOptions::default(), |_| {
            Err(tobj::LoadError::OpenFileFailed)
        })
        .unwrap();
        let indices: Vec<u32> = models.iter().flat_map(|model| model.mesh.indices.clone()).collect();
        prop_assert_eq!(indices.len(), 3 * mesh.triangles().len());
        for (index, v) in indices.into_iter().zip(mesh.triangles().iter().flatten()) {
            let corner = [0, 1, 2].map(|axis| models[0].mesh.positions[3 * index as usize + axis]);
            prop_assert_eq!(corner, mesh.vertices()[*v as usize].map(|x| x as f32));
        }
        for text in [false, true] {
            let stl = written(&mesh, MeshFormat::Stl, text);
            let read = stl_io::read_stl(&mut std::io::Cursor::new(stl)).unwrap();
            prop_assert_eq!(read.faces.len(), mesh.triangles().len());
            for (face, triangle) in read.faces.iter().zip(mesh.triangles()) {
                for k in 0..3 {
                    let corner: [f32; 3] = read.vertices[face.vertices[k]].into();
                    prop_assert_eq!(corner, mesh.vertices()[triangle[k] as usize].map(|x| x as f32));
                }
            }
            let ply = written(&mesh, MeshFormat::Ply, text);
            let read = Parser::<DefaultElement>::new().read_ply(&mut ply.as_slice()).unwrap();
            let vertices: Vec<[f64; 3]> = read.payload["vertex"].iter().map(|vertex| {
                ["x", "y", "z"].map(|name| match vertex[name] {
                    Property::Double(x) => x,
                    _ => panic!("no double"),
                })
            }).collect();
            prop_assert_eq!(&vertices[..], mesh.vertices());
            let faces: Vec<[u32; 3]> = read.payload["face"].iter().map(|face| match &face["vertex_indices"] {
                Property::ListInt(list) => [list[0] as u32, list[1] as u32, list[2] as u32],
                _ => panic!("no list"),
            }).collect();
            prop_assert_eq!(&faces[..], mesh.triangles());
        }
    }
}

#[test]
fn a_mesh_of_nothing_is_written_where_a_format_has_it() {
    let empty = TriangleMesh::new(vec![], vec![]).unwrap();
    let obj = write_mesh(&empty, MeshFormat::Obj, &WriteOptions::default());
    assert!(matches!(obj, Err(Error::Argument { name: "mesh", .. })));
    for format in FORMATS.into_iter().filter(|&format| format != MeshFormat::Obj) {
        for text in [false, true] {
            let back = read_mesh(&written(&empty, format, text), &MeshOptions::default()).unwrap();
            assert!(back.format == format && back.mesh.triangles().is_empty());
        }
    }
    if cfg!(feature = "threemf") {
        let back = read_mesh(&written(&empty, MeshFormat::ThreeMf, false), &MeshOptions::default()).unwrap();
        assert!(back.mesh.triangles().is_empty() && back.unit == Some(LengthUnit::Millimetre));
    }
}

#[test]
fn coordinates_that_a_format_has_not_are_refused() {
    let mesh =
        TriangleMesh::new(vec![[1e39, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2]]).unwrap();
    for text in [false, true] {
        let result = write_mesh(&mesh, MeshFormat::Stl, &WriteOptions { text, ..WriteOptions::default() });
        assert!(matches!(result, Err(Error::Argument { name: "mesh", .. })));
    }
}
