//! Written mesh files are unchanged when read back, by this library's readers and by foreign readers.

use leafless::exchange::{
    LengthUnit, MeshFormat, MeshOptions, WriteOptions, read_mesh, write_mesh, written_form,
};
use leafless::{Error, TriangleMesh};
use leafless_testkit::{Random, cases};
use ply_rs_bw::{parser::Parser, ply::DefaultElement, ply::Property};
use proptest::prelude::*;

/// Coordinates with few or all digits, tiny and huge ones, and zeros of both signs.
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

/// A mesh whose triangles have three different vertices each. Some triangle uses each vertex.
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

/// A box, a smaller box beside it, and a vertex that no triangle uses. Single precision keeps all, some or
/// nothing of the mesh at this distance from the origin.
fn far_away(seed: u64, far: i32) -> TriangleMesh {
    let mut random = Random(seed);
    let at = [0; 3].map(|_| random.between(1.0, 2.0) * 2f64.powi(far));
    let mut vertices = vec![];
    let mut triangles = vec![];
    for edge in [random.between(0.5, 3.0), random.between(0.01, 0.1)] {
        let first = vertices.len() as u32;
        vertices.extend((0..8).map(|k| [0, 1, 2].map(|axis| at[axis] + f64::from(k >> axis & 1) * edge)));
        let sides: [[u32; 4]; 6] =
            [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let both = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        triangles.extend(both.map(|triangle| triangle.map(|v| v + first)));
    }
    vertices.push([0.5, 0.25, random.between(0.0, 1.0)]);
    TriangleMesh::new(vertices, triangles).unwrap()
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

    /// The writer's forecast is the mesh that is read back, whether single precision keeps much or little of
    /// it.
    #[test]
    fn what_comes_back_is_told_before(seed: u64, far in 0..30i32, seen: bool) {
        let mesh = if seen { mesh(seed) } else { far_away(seed, far) };
        let formats = FORMATS.into_iter().chain(cfg!(feature = "threemf").then_some(MeshFormat::ThreeMf));
        for (format, text) in formats.flat_map(|format| [(format, false), (format, true)]) {
            let options = WriteOptions { text, ..WriteOptions::default() };
            let told = written_form(&mesh, format, &options).unwrap();
            let back = read_mesh(&write_mesh(&mesh, format, &options).unwrap(), &MeshOptions::default()).unwrap();
            prop_assert_eq!(told.mesh.vertices(), back.mesh.vertices());
            prop_assert_eq!(told.mesh.triangles(), back.mesh.triangles());
            let report = back.mesh.report().unwrap();
            prop_assert_eq!(told.degenerate, report.degenerate);
            let used: std::collections::BTreeSet<u32> = mesh.triangles().iter().flatten().copied().collect();
            if format != MeshFormat::Stl {
                prop_assert_eq!((told.rounding, told.merged, told.degenerate), (0.0, 0, 0));
            } else {
                prop_assert_eq!(told.merged, used.len() as u64 - report.vertices);
                let coordinates = || used.iter().flat_map(|&v| mesh.vertices()[v as usize]);
                let moved = coordinates().map(|x| (x - f64::from(x as f32)).abs()).fold(0.0, f64::max);
                // Decimal digits identify a 32-bit number, and no more.
                let half = coordinates().map(|x| x.abs() as f32).map(|x| x.next_up() - x).fold(0.0, f32::max) / 2.0;
                let slack = if text { f64::from(half) } else { 0.0 };
                prop_assert!((told.rounding - moved).abs() <= slack, "{} {moved}", told.rounding);
                // Vertices are merged, and never separated.
                prop_assert!(!mesh.report().unwrap().is_closed() || report.is_closed());
            }
        }
    }

    /// Normals are written beside vertices, for this library's readers and for foreign readers.
    #[test]
    fn normals_are_written(seed: u64) {
        let mesh = mesh(seed);
        let normals: Vec<[f32; 3]> =
            mesh.vertex_normals().unwrap().iter().map(|normal| normal.map(|x| x as f32)).collect();
        for format in FORMATS {
            for text in [false, true] {
                let options = WriteOptions { text, normals: true, ..WriteOptions::default() };
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

/// Named objects, each at several places, come back as one mesh with the total volume.
#[cfg(feature = "threemf")]
#[test]
fn placed_meshes_come_back() {
    use leafless::Affine;
    use leafless::exchange::write_placed_meshes;
    let tetrahedron = |size: f64| {
        let vertices = vec![[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]];
        TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap()
    };
    let flat = TriangleMesh::new(vec![[0.0; 3], [1.0; 3]], vec![[0, 1, 1]]).unwrap();
    let (small, large) = (tetrahedron(1.0), tetrahedron(3.0));
    let objects = [("flat", &flat), ("a \"small\" <one> & \u{1}more", &small), ("large", &large)];
    let turned = [[0.6, -0.8, 0.0, 10.1], [0.8, 0.6, 0.0, -1e-7], [0.0, 0.0, 1.0, 1.0 / 3.0]];
    let mirrored = [[-1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 50.0]];
    let [turned, mirrored] = [turned, mirrored].map(|rows| Affine::new(rows).unwrap());
    let far = Affine::translation([-7.0, 0.1, 1e20 / 3e20]).unwrap();
    let items = [(1, Affine::IDENTITY), (2, turned), (1, far), (0, turned), (2, mirrored)];
    let options = WriteOptions { unit: Some(LengthUnit::Inch), ..WriteOptions::default() };
    let bytes = write_placed_meshes(&objects, &items, &options).unwrap();
    let back = read_mesh(&bytes, &MeshOptions::default()).unwrap();
    assert_eq!((back.format, back.unit, back.skipped), (MeshFormat::ThreeMf, Some(LengthUnit::Inch), 0));
    assert!(back.warnings.is_empty());
    // The vertices of all places, one after another.
    let placed = [(&small, Affine::IDENTITY), (&large, turned), (&small, far), (&large, mirrored)];
    let expected: Vec<[f64; 3]> =
        placed.iter().flat_map(|(mesh, map)| mesh.vertices().iter().map(|v| map.apply(*v))).collect();
    assert_eq!(back.mesh.vertices().len(), expected.len());
    for (own, expected) in back.mesh.vertices().iter().zip(&expected) {
        assert!((0..3).all(|k| (own[k] - expected[k]).abs() < 1e-14), "{own:?} {expected:?}");
    }
    // A mirrored mesh is not inside out.
    let volume = 2.0 * small.volume() + 2.0 * large.volume();
    assert!((back.mesh.volume() - volume).abs() < 1e-12, "{} {volume}", back.mesh.volume());
    let objects_of = back.mesh.attributes().iter().find(|attribute| attribute.name() == "object").unwrap();
    assert_eq!(objects_of.names(), ["a \"small\" <one> &  more", "large"]);

    let nothing = write_placed_meshes(&objects[..1], &items[3..4], &options).unwrap();
    assert!(read_mesh(&nothing, &MeshOptions::default()).unwrap().mesh.triangles().is_empty());
    let unknown = write_placed_meshes(&objects[..2], &items, &options);
    assert!(matches!(unknown, Err(Error::Argument { name: "items", .. })));
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

/// A cube of edge 3 around x = 10⁹, where single precision has multiples of 64.
#[test]
fn a_far_cube_is_told_to_be_flat() {
    let sides: [[u32; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let corner = |k: u32| [0, 1, 2].map(|axis| f64::from(k >> axis & 1) * 3.0 + [1e9, 0.0, 0.0][axis]);
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let cube = TriangleMesh::new((0..8).map(corner).collect(), triangles).unwrap();
    for text in [false, true] {
        let options = WriteOptions { text, ..WriteOptions::default() };
        let kept = written_form(&cube, MeshFormat::Stl, &options).unwrap();
        assert_eq!((kept.rounding, kept.merged, kept.degenerate), (3.0, 4, 8));
        let report = kept.mesh.report().unwrap();
        assert_eq!((report.triangles, report.vertices, kept.mesh.volume()), (4, 4, 0.0));
        assert_eq!(kept.mesh.area(), 18.0);
        // All of it collapses to one point, or is below any number.
        let huge = cube.transformed(|[_, y, z]| [1e30, 1e30 + y, 1e30 + z]).unwrap();
        assert!(huge.triangles().is_empty());
        let tiny = cube.transformed(|[x, y, z]| [x - 1e9, y, z].map(|c| c * 1e-60)).unwrap();
        let kept = written_form(&tiny, MeshFormat::Stl, &options).unwrap();
        assert_eq!((kept.merged, kept.degenerate, kept.mesh.vertices().len()), (7, 12, 1));
        let far = TriangleMesh::new(vec![[1e39; 3], [0.0; 3], [0.0, 1.0, 0.0]], vec![[0, 1, 2]]).unwrap();
        let result = written_form(&far, MeshFormat::Stl, &options);
        assert!(matches!(result, Err(Error::Argument { name: "mesh", .. })));
    }
}

#[test]
fn a_mesh_of_nothing_has_no_area() {
    let empty = TriangleMesh::new(vec![], vec![]).unwrap();
    assert!(empty.area().is_sign_positive() && empty.volume().is_sign_positive());
    assert!(written_form(&empty, MeshFormat::Obj, &WriteOptions::default()).is_err());
    let points = TriangleMesh::new(vec![[1.0; 3]], vec![]).unwrap();
    for format in FORMATS.into_iter().chain(cfg!(feature = "threemf").then_some(MeshFormat::ThreeMf)) {
        let kept = written_form(&points, format, &WriteOptions::default()).unwrap();
        let back = read_mesh(&written(&points, format, false), &MeshOptions::default()).unwrap();
        assert_eq!(kept.mesh.vertices(), back.mesh.vertices(), "{format}");
    }
}

/// A mesh's known distance from the true boundary is written to the file. Readers report it and do not rely
/// on it.
#[test]
fn deviations_are_written_and_told() {
    let mesh = mesh(7);
    let formats = FORMATS.into_iter().chain(cfg!(feature = "threemf").then_some(MeshFormat::ThreeMf));
    for (format, text) in formats.flat_map(|format| [(format, false), (format, true)]) {
        for deviation in [0.0, 0.5, 1.0 / 3.0, 1e-30, 2f64.powi(256)] {
            let options = WriteOptions { text, deviation: Some(deviation), ..WriteOptions::default() };
            let bytes = write_mesh(&mesh, format, &options).unwrap();
            let back = read_mesh(&bytes, &MeshOptions::default()).unwrap();
            if format == MeshFormat::Stl {
                assert_eq!((back.deviation, &bytes), (None, &written(&mesh, format, text)));
                continue;
            }
            assert_eq!((back.format, back.deviation), (format, Some(deviation)));
            assert_eq!((back.mesh.deviation(), back.mesh.vertices()), (0.0, mesh.vertices()));
            // The file is as long as before.
            let unit = Some(LengthUnit::Inch);
            let inches = MeshOptions { unit, target: Some(LengthUnit::Millimetre), ..MeshOptions::default() };
            let back = read_mesh(&bytes, &inches).unwrap().deviation.unwrap();
            assert!(back >= 25.4 * deviation && back <= 25.4 * deviation * (1.0 + 1e-15), "{deviation}");
            assert_eq!(read_mesh(&written(&mesh, format, text), &inches).unwrap().deviation, None);
        }
        for wrong in [-1.0, f64::NAN, f64::INFINITY] {
            let options = WriteOptions { text, deviation: Some(wrong), ..WriteOptions::default() };
            let error = write_mesh(&mesh, format, &options).unwrap_err();
            assert!(matches!(error, Error::Argument { name: "deviation", .. }), "{error}");
        }
    }
    // A word that is not a number is no deviation.
    for word in ["-1", "nan", "inf", "", "0.5 mm", "1e999"] {
        let text = format!("# leafless deviation {word}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        assert_eq!(read_mesh(text.as_bytes(), &MeshOptions::default()).unwrap().deviation, None, "{word}");
    }
}
