//! Colours and materials of PLY and 3MF files as mesh attributes. The mesh is read even if the file states
//! its colours badly.

use leafless_testkit::zip;
use leafless_testkit::zip::{CONTENT_TYPES, Entry, RELATIONSHIPS, package};

use leafless::TriangleMesh;
use leafless::attribute::{Attribute, SurfaceAttribute};
use leafless::exchange::{MeshFile, MeshOptions, MeshWarning, read_mesh, read_ply};
use leafless::mesh::{AttributeDomain, MeshAttribute};
use proptest::prelude::*;

fn read(bytes: &[u8]) -> MeshFile {
    read_mesh(bytes, &MeshOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the values at the corners of each triangle.
fn values(attribute: &MeshAttribute) -> Vec<[Option<[f64; 4]>; 3]> {
    (0..attribute.len()).map(|t| [0, 1, 2].map(|corner| attribute.value(t, corner))).collect()
}

/// Returns the first number of each triangle's value. All corners of the triangle have the same value.
fn numbers(mesh: &TriangleMesh, name: &str) -> Vec<Option<f64>> {
    let attribute = mesh.attribute(name).unwrap_or_else(|| panic!("no {name}"));
    assert_eq!(attribute.domain(), AttributeDomain::Triangle);
    (0..attribute.len()).map(|t| attribute.value(t, 0).map(|value| value[0])).collect()
}

#[test]
fn scaled_files_keep_attributes() {
    let ply =
        b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 3\n\
        property list uchar int vertex_indices\nend_header\n\
        0 0 0 1 2 3\n1 0 0 4 5 6\n1e-77 1 0 7 8 9\n0 1 0 10 11 12\n3 0 1 2\n3 0 2 3\n3 0 1 3\n";
    let options = MeshOptions { scale: 0.5, ..MeshOptions::default() };
    let file = read_mesh(ply, &options).unwrap();
    // Scaled, the third vertex lies on the fourth.
    assert_eq!(file.mesh.triangles().len(), 2);
    let colour = file.mesh.attribute("colour").unwrap();
    assert_eq!(colour.value(0, 2), Some([7.0, 8.0, 9.0, 255.0]));
    assert_eq!(colour.value(1, 2), Some([10.0, 11.0, 12.0, 255.0]));
}

mod ply {
    use super::*;

    const FORMATS: [&str; 3] = ["ascii", "binary_little_endian", "binary_big_endian"];

    fn number(bytes: &mut Vec<u8>, format: &str, kind: &str, value: f64) {
        let mut number = match kind {
            _ if format == "ascii" => return bytes.extend(format!("{value} ").bytes()),
            "char" => (value as i8).to_le_bytes().to_vec(),
            "uchar" => vec![value as u8],
            "ushort" => (value as u16).to_le_bytes().to_vec(),
            "int" => (value as i32).to_le_bytes().to_vec(),
            "float" => (value as f32).to_le_bytes().to_vec(),
            "double" => value.to_le_bytes().to_vec(),
            _ => panic!("{kind}"),
        };
        if format.contains("big") {
            number.reverse();
        }
        bytes.extend(number);
    }

    /// Elements of one kind: name, properties as (type, name), rows. A property called `list` is a face's
    /// list; the list has the row's first three numbers.
    type Element<'a> = (&'a str, &'a [(&'a str, &'a str)], Vec<Vec<f64>>);

    fn file(format: &str, elements: &[Element]) -> Vec<u8> {
        let mut bytes = format!("ply\nformat {format} 1.0\n").into_bytes();
        for (name, properties, rows) in elements {
            bytes.extend(format!("element {name} {}\n", rows.len()).bytes());
            for (kind, name) in *properties {
                match *name {
                    "list" => bytes.extend(b"property list uchar int vertex_indices\n"),
                    _ => bytes.extend(format!("property {kind} {name}\n").bytes()),
                }
            }
        }
        bytes.extend(b"end_header\n");
        for (_, properties, rows) in elements {
            for row in rows {
                let mut values = row.iter();
                for (kind, name) in *properties {
                    if *name == "list" {
                        number(&mut bytes, format, "uchar", 3.0);
                        for value in values.by_ref().take(3) {
                            number(&mut bytes, format, "int", *value);
                        }
                    } else {
                        number(&mut bytes, format, kind, *values.next().unwrap());
                    }
                }
                if format == "ascii" {
                    bytes.push(b'\n');
                }
            }
        }
        bytes
    }

    const XYZ: [(&str, &str); 3] = [("float", "x"), ("float", "y"), ("float", "z")];
    const LIST: [(&str, &str); 1] = [("int", "list")];

    /// A square of two triangles. Each vertex has its colour after its coordinates.
    fn square(format: &str, channels: &[(&str, &str)], colours: [Vec<f64>; 4]) -> Vec<u8> {
        let places = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        let rows = places.iter().zip(colours).map(|(place, colour)| [place.to_vec(), colour].concat());
        let properties = [&XYZ[..], channels].concat();
        let faces = vec![vec![0., 1., 2.], vec![0., 2., 3.]];
        file(format, &[("vertex", &properties, rows.collect()), ("face", &LIST, faces)])
    }

    #[test]
    fn colours_of_vertices() {
        for format in FORMATS {
            for (kind, of) in [
                ("uchar", (|x| x) as fn(f64) -> f64),
                ("int", |x| x),
                ("ushort", |x| x * 257.0),
                ("float", |x| x / 255.0),
                ("double", |x| x / 255.0),
            ] {
                for (prefix, alpha) in [("", true), ("", false), ("diffuse_", false)] {
                    let names = ["red", "green", "blue"].map(|name| format!("{prefix}{name}"));
                    let mut channels: Vec<(&str, &str)> =
                        names.iter().map(|name| (kind, &name[..])).collect();
                    let colour = |k: f64| vec![of(10.0 * k), of(255.0 - k), of(0.0)];
                    let mut colours = [0.0, 1.0, 2.0, 3.0].map(colour);
                    if alpha {
                        channels.insert(0, (kind, "alpha"));
                        colours.iter_mut().for_each(|colour| colour.insert(0, of(7.0)));
                    }
                    let file = super::read(&square(format, &channels, colours));
                    assert_eq!(file.warnings, []);
                    let found = file.mesh.attribute("colour").unwrap();
                    assert_eq!((found.components(), found.domain()), (4, AttributeDomain::Corner));
                    for (t, corners) in [[0.0, 1.0, 2.0], [0.0, 2.0, 3.0]].into_iter().enumerate() {
                        for (corner, k) in corners.into_iter().enumerate() {
                            let expected = [10.0 * k, 255.0 - k, 0.0, if alpha { 7.0 } else { 255.0 }];
                            let found = found.value(t, corner).unwrap();
                            let apart = (0..4).map(|k| (found[k] - expected[k]).abs()).fold(0.0, f64::max);
                            assert!(apart < 1e-4, "{format} {kind}: {found:?} {expected:?}");
                            assert!(kind == "float" || kind == "double" || apart == 0.0);
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_no_colour() {
        for format in FORMATS {
            let three = |kind| [(kind, "red"), (kind, "green"), (kind, "blue")];
            // A channel is missing, or is a list.
            for channels in [&three("uchar")[..2], &[("uchar", "red"), ("uchar", "green"), ("uchar", "Blue")]]
            {
                let rows = [0; 4].map(|_| vec![1.0; channels.len()]);
                let file = super::read(&square(format, channels, rows));
                assert_eq!((file.mesh.attributes().len(), file.warnings.len()), (0, 0));
            }
            // One of four colours is out of range.
            for (kind, wrong) in
                [("int", 256.0), ("int", -1.0), ("char", -1.0), ("float", 1.01), ("double", f64::NAN)]
            {
                if format == "ascii" && f64::is_nan(wrong) {
                    continue;
                }
                let colour = |value: f64| vec![value, 0.0, 0.0];
                let rows = [colour(0.0), colour(wrong), colour(1.0), colour(0.5)];
                let file = super::read(&square(format, &three(kind), rows));
                assert_eq!(file.warnings, [MeshWarning::Colours { colours: 1 }], "{format} {kind} {wrong}");
                let found = values(file.mesh.attribute("colour").unwrap());
                let has = found.map_vec(|corners| corners.map(|value| value.is_some()));
                assert_eq!(has, [[true, false, true], [true; 3]]);
            }
        }
        // A word that is no number, where anything may stand.
        let text = String::from_utf8(square(
            "ascii",
            &[("uchar", "red"), ("uchar", "green"), ("uchar", "blue")],
            [0, 1, 2, 3].map(|_| vec![9.0; 3]),
        ))
        .unwrap();
        let file = super::read(text.replacen("9 9 9", "9 #9 9", 1).as_bytes());
        assert_eq!(file.warnings, [MeshWarning::Colours { colours: 1 }]);
        assert_eq!(values(file.mesh.attribute("colour").unwrap())[0][0], None);
        // A file that ends within a colour is still refused.
        let cut = text.find("9 9 9").unwrap();
        assert!(read_ply(&text.as_bytes()[..cut]).is_err());
        assert_eq!(MeshWarning::Colours { colours: 1 }.to_string(), "1 colour cannot be read");
    }

    trait MapVec<T> {
        fn map_vec<U>(self, f: impl FnMut(T) -> U) -> Vec<U>;
    }

    impl<T> MapVec<T> for Vec<T> {
        fn map_vec<U>(self, f: impl FnMut(T) -> U) -> Vec<U> {
            self.into_iter().map(f).collect()
        }
    }

    #[test]
    fn colours_of_faces() {
        // An L of six corners, cut into four triangles; a triangle; and a degenerate face.
        let text = |vertex_channels: &str, vertex_colour: &str, header: &str, strips: &str| {
            let places = ["2 0 0", "2 1 0", "1 1 0", "1 2 0", "0 2 0", "0 0 0"];
            let vertices: String = places.iter().map(|place| format!("{place} {vertex_colour}\n")).collect();
            format!(
                "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
                 {vertex_channels}{header}element face 3\nproperty uchar red\nproperty list uchar int vertex_index\n\
                 property uchar green\nproperty uchar blue\nend_header\n{vertices}{strips}1 6 0 1 2 3 4 5 0 0\n\
                 2 3 0 1 0 0 0\n3 3 0 1 3 0 0\n"
            )
        };
        let plain = super::read(text("", "", "", "").as_bytes());
        let expected = [1.0, 1.0, 1.0, 1.0, 3.0].map(Some);
        assert_eq!(numbers(&plain.mesh, "colour"), expected);
        assert_eq!(plain.mesh.report().unwrap().degenerate, 1);
        // With colours of vertices as well.
        let channels = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
        let both = super::read(text(channels, "9 8 7", "", "").as_bytes());
        assert_eq!(numbers(&both.mesh, "face_colour"), expected);
        let colour = both.mesh.attribute("colour").unwrap();
        assert_eq!(values(colour), [[Some([9.0, 8.0, 7.0, 255.0]); 3]; 5]);
        // Strips before the faces have no colour.
        let header = "element tristrips 1\nproperty list int int vertex_indices\n";
        let strips = super::read(text("", "", header, "4 0 1 2 3\n").as_bytes());
        let expected = [[None; 2].to_vec(), expected.to_vec()].concat();
        assert_eq!(numbers(&strips.mesh, "colour"), expected);
    }

    #[test]
    fn vertices_that_are_welded_keep_their_colours() {
        // Two triangles with vertices of their own, and a third triangle that is degenerate after welding.
        let row = |place: [f64; 3], red: f64| [place.to_vec(), vec![red, 0.0, 0.0]].concat();
        let [a, b, c, d] = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        let vertices = [(a, 1.), (b, 2.), (c, 3.), (a, 4.), (c, 5.), (d, 6.)];
        let properties = [&XYZ[..], &[("uchar", "red"), ("uchar", "green"), ("uchar", "blue")]].concat();
        for format in FORMATS {
            let faces = vec![vec![0., 1., 2.], vec![0., 3., 5.], vec![3., 4., 5.]];
            let rows = vertices.iter().map(|&(place, red)| row(place, red)).collect();
            let file = super::read(&file(format, &[("vertex", &properties, rows), ("face", &LIST, faces)]));
            assert_eq!((file.mesh.vertices().len(), file.mesh.triangles().len()), (4, 2));
            let reds = values(file.mesh.attribute("colour").unwrap())
                .map_vec(|corners| corners.map(|value| value.unwrap()[0]));
            assert_eq!(reds, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        }
    }

    #[test]
    fn colours_are_interpolated() {
        let channels = [("uchar", "red"), ("uchar", "green"), ("uchar", "blue")];
        let colours = [[0., 0., 0.], [200., 0., 0.], [200., 100., 0.], [0., 100., 0.]].map(|c| c.to_vec());
        let mesh = read_ply(&square("binary_little_endian", &channels, colours)).unwrap();
        let colour = SurfaceAttribute::of_mesh(mesh, "colour").unwrap();
        let [red, green, ..] = colour.value([0.25, 0.75, 3.0]).unwrap().unwrap();
        assert!((red - 50.0).abs() < 1e-9 && (green - 75.0).abs() < 1e-9);
    }

    proptest! {
        #![proptest_config(leafless_testkit::cases(1000))]

        /// A file that is readable without its colours is readable with them.
        #[test]
        fn colours_change_no_mesh(
            header in "(property (uchar|int|float|double|ushort) (red|green|blue|alpha|diffuse_red)\n){0,5}",
            words in proptest::collection::vec("[0-9.e+-]{1,4}", 15),
        ) {
            let count = header.lines().count();
            let places = ["0 0 0", "1 0 0", "0 1 0"];
            let text = |header: &str, count: usize| {
                let rows: String = places.iter().zip(words.chunks(5)).map(|(place, words)| {
                    format!("{place} {}\n", words[..count].join(" "))
                }).collect();
                format!("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                    property float z\n{header}element face 1\nproperty list uchar int vertex_indices\n\
                    end_header\n{rows}3 0 1 2\n")
            };
            let plain = read_ply(text("", 0).as_bytes()).unwrap();
            let with = read_ply(text(&header, count).as_bytes()).unwrap();
            prop_assert_eq!(plain.vertices(), with.vertices());
            prop_assert_eq!(plain.triangles(), with.triangles());
        }
    }
}

mod threemf {
    use super::*;

    const BASES: &str = r##"<basematerials id="5">
        <base name="Steel &amp; more" displaycolor="#102030"/><base name="Brass" displaycolor="#aAbBcC80"/>
      </basematerials>"##;
    const COLOURS: &str = r##"<m:colorgroup id="6">
        <m:color color="#FF0000"/><m:color color="#00ff00FF"/><m:color color="#0000FF7F"/>
      </m:colorgroup>"##;

    fn model(resources: &str, items: &str) -> String {
        format!(
            r#"<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" requiredextensions="m" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
    xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
    xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06">
  <resources>{resources}</resources>
  <build>{items}</build>
</model>"#
        )
    }

    /// A tetrahedron whose four triangles have these attributes.
    fn object(id: u32, attributes: &str, triangles: [&str; 4]) -> String {
        let [a, b, c, d] = triangles;
        format!(
            r#"<object id="{id}" {attributes}><mesh><vertices>
            <vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/>
            </vertices><triangles>
            <triangle v1="0" v2="2" v3="1" {a}/><triangle v1="0" v2="1" v3="3" {b}/>
            <triangle v1="1" v2="2" v3="3" {c}/><triangle v1="2" v2="0" v3="3" {d}/>
            </triangles></mesh></object>"#
        )
    }

    fn read_model(resources: &str, items: &str) -> MeshFile {
        super::read(&zip::zip(&package(model(resources, items))))
    }

    fn colours(mesh: &TriangleMesh) -> Vec<[Option<[f64; 4]>; 3]> {
        values(mesh.attribute("colour").expect("colours"))
    }

    const ITEM: &str = r#"<item objectid="1"/>"#;
    const STEEL: Option<[f64; 4]> = Some([16.0, 32.0, 48.0, 255.0]);
    const BRASS: Option<[f64; 4]> = Some([170.0, 187.0, 204.0, 128.0]);
    const RED: Option<[f64; 4]> = Some([255.0, 0.0, 0.0, 255.0]);
    const GREEN: Option<[f64; 4]> = Some([0.0, 255.0, 0.0, 255.0]);
    const BLUE: Option<[f64; 4]> = Some([0.0, 0.0, 255.0, 127.0]);

    #[test]
    fn base_materials() {
        let triangles = ["", r#"pid="5" p1="1""#, r#"p1="1" p2="0" p3="0""#, r#"pid="5" p1="0""#];
        let file = read_model(&(BASES.to_owned() + &object(1, r#"pid="5" pindex="0""#, triangles)), ITEM);
        assert_eq!(file.warnings, []);
        assert_eq!(file.mesh.attributes().len(), 2);
        let material = file.mesh.attribute("material").unwrap();
        assert_eq!(material.names(), ["Steel & more", "Brass"]);
        assert_eq!(numbers(&file.mesh, "material"), [0.0, 1.0, 1.0, 0.0].map(Some));
        assert_eq!(file.mesh.attribute("colour").unwrap().domain(), AttributeDomain::Triangle);
        assert_eq!(colours(&file.mesh), [STEEL, BRASS, BRASS, STEEL].map(|colour| [colour; 3]));
    }

    #[test]
    fn colour_groups() {
        let triangles = [r#"p1="0" p2="1" p3="2""#, r#"p1="2" p2="1""#, r#"pid="6" p1="1""#, ""];
        let file = read_model(&(COLOURS.to_owned() + &object(1, r#"pid="6" pindex="0""#, triangles)), ITEM);
        assert_eq!((file.warnings.len(), file.mesh.attributes().len()), (0, 1));
        assert_eq!(file.mesh.attribute("colour").unwrap().domain(), AttributeDomain::Corner);
        // If one of the other references is missing, the first counts for all corners.
        assert_eq!(colours(&file.mesh), [[RED, GREEN, BLUE], [BLUE; 3], [GREEN; 3], [RED; 3]]);
    }

    #[test]
    fn some_triangles_have_none() {
        let triangles = ["", r#"pid="6" p1="1""#, r#"pid="5" p1="1""#, ""];
        let resources = [BASES, COLOURS, &object(1, "", triangles)].concat();
        let file = read_model(&resources, ITEM);
        assert_eq!(file.warnings, []);
        assert_eq!(colours(&file.mesh), [None, GREEN, BRASS, None].map(|colour| [colour; 3]));
        assert_eq!(numbers(&file.mesh, "material"), [None, None, Some(1.0), None]);
        // Groups without references are no attributes.
        let file = read_model(&[BASES, COLOURS, &object(1, "", [""; 4])].concat(), ITEM);
        assert_eq!((file.mesh.attributes().len(), file.warnings.len()), (0, 0));
        // Groups may follow the objects that refer to them: such meshes were never refused.
        let behind = [&object(1, r#"pid="5" pindex="1""#, [""; 4]), BASES].concat();
        assert_eq!(colours(&read_model(&behind, ITEM).mesh), [[BRASS; 3]; 4]);
    }

    #[test]
    fn components_and_transforms() {
        // A red tetrahedron with a gradient on one triangle, and a green one; placed, and mirrored.
        let resources = [
            COLOURS,
            &object(1, r#"pid="6" pindex="0" name="first""#, ["", "", r#"p1="0" p2="1" p3="2""#, ""]),
            &object(2, r#"pid="6" pindex="1""#, [""; 4]),
            r#"<object id="3" pid="6" pindex="2"><components>
                <component objectid="1" transform="1 0 0 0 1 0 0 0 -1 9 0 0"/><component objectid="2"/>
            </components></object>"#,
        ]
        .concat();
        let items = r#"<item objectid="3" transform="2 0 0 0 2 0 0 0 2 50 0 0"/><item objectid="1"/>"#;
        let mesh = read_model(&resources, items).mesh;
        assert_eq!(mesh.triangles().len(), 12);
        let found = colours(&mesh);
        // Reversed, the triangle keeps the colours of its vertices.
        assert_eq!(found[2], [RED, BLUE, GREEN]);
        assert_eq!(found[10], [RED, GREEN, BLUE]);
        assert_eq!((found[0], found[4], found[7], found[11]), ([RED; 3], [GREEN; 3], [GREEN; 3], [RED; 3]));
        let [at, ..] = [mesh.triangles()[2][2]].map(|v| mesh.vertices()[v as usize]);
        // v2 of the triangle, green, is (0, 1, 0).
        assert_eq!(at, [68.0, 2.0, 0.0]);
        assert_eq!(
            numbers(&mesh, "object"),
            [[0.0; 4], [1.0; 4], [0.0; 4]].concat().into_iter().map(Some).collect::<Vec<_>>()
        );
        assert_eq!(mesh.attribute("object").unwrap().names(), ["first", ""]);
    }

    #[test]
    fn parts_have_groups_of_their_own() {
        let other = [
            r##"<m:colorgroup id="6"><m:color color="#123456"/></m:colorgroup>"##,
            &object(1, r#"pid="6" pindex="0""#, [""; 4]),
        ]
        .concat();
        let resources = [
            COLOURS,
            &object(1, r#"pid="6" pindex="1""#, [""; 4]),
            r#"<object id="2"><components><component objectid="1" p:path="/b.model"/><component objectid="1"/></components></object>"#,
        ]
        .concat();
        let bytes = zip::zip(&[
            Entry::stored("[Content_Types].xml", CONTENT_TYPES),
            Entry::stored("_rels/.rels", RELATIONSHIPS),
            Entry::stored("3D/3dmodel.model", model(&resources, r#"<item objectid="2"/>"#)),
            Entry::stored("b.model", model(&other, "")),
        ]);
        let file = super::read(&bytes);
        assert_eq!(file.warnings, []);
        let other = Some([18.0, 52.0, 86.0, 255.0]);
        assert_eq!(colours(&file.mesh), [[[other; 3]; 4], [[GREEN; 3]; 4]].concat());
        assert_eq!(numbers(&file.mesh, "object")[3..5], [Some(0.0), Some(1.0)]);
    }

    /// A triangle that refers to a missing object has no colour, and the reader reports it.
    #[test]
    fn what_is_missing() {
        for (object_has, wrong) in [
            ("", r#"pid="7" p1="0""#),
            ("", r#"pid="6" p1="3""#),
            ("", r#"pid="6" p1="0" p2="1" p3="3""#),
            ("", r#"pid="6" p1="-1""#),
            ("", r#"pid="6" p1="4294967295""#),
            ("", r#"pid="6" p1="4294967294""#),
            ("", r#"pid="x" p1="0""#),
            ("", r#"pid="1" p1="0""#),
            ("", r#"p1="0""#),
            ("", r#"pid="6""#),
            (r#"pid="6" pindex="0""#, r#"p1="99999999999999999999""#),
        ] {
            let own = object(1, object_has, [r#"pid="6" p1="1""#, wrong, r#"pid="6" p1="1""#, wrong]);
            let file = read_model(&[COLOURS, &own].concat(), ITEM);
            assert_eq!(file.warnings, [MeshWarning::Properties { triangles: 2 }], "{wrong}");
            assert_eq!(colours(&file.mesh), [GREEN, None, GREEN, None].map(|colour| [colour; 3]), "{wrong}");
        }
        for wrong in [r#"pid="7" pindex="0""#, r#"pid="6" pindex="3""#, r#"pid="6""#, r#"pindex="0""#] {
            let own = object(1, wrong, ["", r#"pid="6" p1="1""#, "", ""]);
            let file = read_model(&[COLOURS, &own].concat(), ITEM);
            assert_eq!(file.warnings, [MeshWarning::Properties { triangles: 3 }], "{wrong}");
            assert_eq!(colours(&file.mesh)[..2], [[None; 3], [GREEN; 3]]);
        }
        let text = MeshWarning::Properties { triangles: 3 }.to_string();
        assert_eq!(text, "3 triangles refer to properties that the file does not have");
    }

    #[test]
    fn wrong_colours() {
        for wrong in [
            "",
            "#",
            "FF0000",
            "#FF000",
            "#FF00000",
            "#GG0000",
            "#FF0000FF0",
            "# FF000",
            "#+10000",
            "red",
            "#ÄÄÄ",
        ] {
            let group = format!(
                r##"<m:colorgroup id="6"><m:color color="{wrong}"/><m:color color=" #00FF00 "/></m:colorgroup>"##
            );
            let own = object(1, r#"pid="6" pindex="0""#, ["", r#"p1="1""#, "", ""]);
            let file = read_model(&[&group, &own[..]].concat(), ITEM);
            assert_eq!(file.warnings, [MeshWarning::Colours { colours: 1 }], "{wrong}");
            assert_eq!(colours(&file.mesh)[..2], [[None; 3], [GREEN; 3]], "{wrong}");
        }
        // A base material without a colour is a material.
        let bases = r#"<basematerials id="6"><base name="a"/><base/></basematerials>"#;
        let file = read_model(&[bases, &object(1, r#"pid="6" pindex="1""#, [""; 4])].concat(), ITEM);
        assert_eq!(file.warnings, [MeshWarning::Colours { colours: 2 }]);
        assert_eq!(numbers(&file.mesh, "material"), [Some(1.0); 4]);
        assert_eq!(file.mesh.attribute("material").unwrap().names(), ["a", ""]);
        // A name that is too long to be examined.
        let bases = format!(
            r##"<basematerials id="6"><base name="{}" displaycolor="#102030"/></basematerials>"##,
            "x".repeat(5000)
        );
        let file = read_model(&[&bases, &object(1, r#"pid="6" pindex="0""#, [""; 4])[..]].concat(), ITEM);
        assert_eq!((file.warnings.len(), colours(&file.mesh)), (0, vec![[STEEL; 3]; 4]));
    }

    #[test]
    fn groups_of_other_kinds() {
        let others = r#"<m:texture2d id="7" path="/a.png" contenttype="image/png"/>
            <m:texture2dgroup id="8" texid="7"><m:tex2coord u="0" v="0"/></m:texture2dgroup>
            <m:compositematerials id="9" matid="5" matindices="0 1"><m:composite values="0.5 0.5"/></m:compositematerials>
            <m:multiproperties id="10" pids="5 6"><m:multi pindices="0 0"/></m:multiproperties>"#;
        let triangles = [r#"pid="8" p1="0" p2="0" p3="0""#, r#"pid="9" p1="0""#, r#"pid="10" p1="0""#, ""];
        let own = object(1, r#"pid="6" pindex="2""#, triangles);
        let file = read_model(&[BASES, COLOURS, others, &own].concat(), ITEM);
        assert_eq!(file.warnings, []);
        assert_eq!(colours(&file.mesh), [None, None, None, BLUE].map(|colour| [colour; 3]));
    }

    proptest! {
        #![proptest_config(leafless_testkit::cases(1000))]

        /// Arbitrary references leave the mesh the same, and every colour is one of the group.
        #[test]
        fn references_change_no_mesh(
            own in "(pid=\"[5-7x]\" )?(pindex=\"[0-4]\" )?",
            triangles in proptest::array::uniform4("(pid=\"[5-8]\" )?(p1=\"[0-3]\" )?(p2=\"[0-3]\" )?(p3=\"[0-3-]\" )?"),
        ) {
            let plain = read_model(&object(1, "", [""; 4]), ITEM).mesh;
            let triangles = [0, 1, 2, 3].map(|k| &triangles[k][..]);
            let file = read_model(&[BASES, COLOURS, &object(1, &own, triangles)].concat(), ITEM);
            prop_assert_eq!(plain.vertices(), file.mesh.vertices());
            prop_assert_eq!(plain.triangles(), file.mesh.triangles());
            let all = [STEEL, BRASS, RED, GREEN, BLUE, None];
            if let Some(colour) = file.mesh.attribute("colour") {
                prop_assert!(values(colour).as_flattened().iter().all(|value| all.contains(value)));
            }
        }
    }
}
