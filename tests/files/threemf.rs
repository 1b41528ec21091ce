//! 3MF packages: what is read from packages, and every way in which packages are refused.

use leafless::error::PackageError;
use leafless::exchange::{LengthUnit, MeshFile, MeshFormat, MeshOptions, MeshWarning, read_mesh};
use leafless::{Error, FillRule};
use leafless_testkit::fuzz::packages;
use leafless_testkit::zip::{CONTENT_TYPES, Entry, RELATIONSHIPS, model, package, tetrahedron, zip};
use proptest::prelude::*;

#[track_caller]
fn read(bytes: &[u8]) -> MeshFile {
    read_mesh(bytes, &MeshOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn read_model(text: impl AsRef<[u8]>) -> MeshFile {
    read(&zip(&package(text)))
}

#[track_caller]
fn refused(bytes: &[u8]) -> PackageError {
    match read_mesh(bytes, &MeshOptions::default()) {
        Err(Error::Package(error)) => error,
        other => panic!("{other:?}"),
    }
}

/// Asserts that the model part is refused in this line, with these words.
#[track_caller]
fn assert_refused(text: &str, line: u64, words: &str) {
    let error = refused(&zip(&package(text)));
    assert_eq!((error.part(), error.line()), ("3D/3dmodel.model", line), "{error}");
    assert!(error.problem().contains(words), "{error}");
    // The offset lies in that line.
    let before = &text.as_bytes()[..error.offset() as usize];
    assert_eq!(before.iter().filter(|&&b| b == b'\n').count() as u64 + 1, line, "{error}");
}

#[track_caller]
fn assert_broken(bytes: &[u8], part: &str, words: &str) {
    let error = refused(bytes);
    assert!(error.part() == part && error.to_string().contains(words), "{error}");
}

const ITEM: &str = r#"<item objectid="1"/>"#;

#[test]
fn one_object() {
    let file = read_model(model("", &tetrahedron(1, ""), ITEM));
    assert_eq!(
        (file.format, file.unit, file.skipped),
        (MeshFormat::ThreeMf, Some(LengthUnit::Millimetre), 0)
    );
    let expected = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    assert_eq!(file.mesh.vertices(), expected);
    assert_eq!(file.mesh.triangles(), [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
    file.mesh.check_closed(FillRule::NonZero).unwrap();
    // Numbers are the doubles nearest to the text.
    let text = model("", &tetrahedron(1, "").replace("x=\"1\"", "x=\" 0.1\n\""), ITEM);
    assert_eq!(read_model(text).mesh.vertices()[1][0], 0.1);
    // An object that is not placed is not built. An empty build is no error here.
    assert_eq!(read_model(model("", &tetrahedron(1, ""), "")).mesh.triangles().len(), 0);
}

#[test]
fn units() {
    for (name, unit, inches) in [
        ("micron", LengthUnit::Micrometre, 1.0 / 25_400.0),
        ("millimeter", LengthUnit::Millimetre, 1.0 / 25.4),
        ("centimeter", LengthUnit::Centimetre, 10.0 / 25.4),
        ("inch", LengthUnit::Inch, 1.0),
        ("foot", LengthUnit::Foot, 12.0),
        ("meter", LengthUnit::Metre, 1000.0 / 25.4),
    ] {
        let bytes = zip(&package(model(&format!("unit=\"{name}\""), &tetrahedron(1, ""), ITEM)));
        let plain = read(&bytes);
        assert_eq!((plain.unit, plain.mesh.bounds().1), (Some(unit), [1.0; 3]));
        let options = MeshOptions { target: Some(LengthUnit::Inch), ..MeshOptions::default() };
        let converted = read_mesh(&bytes, &options).unwrap();
        assert_eq!(converted.unit, Some(LengthUnit::Inch));
        assert!((converted.mesh.bounds().1[0] / inches - 1.0).abs() < 1e-15);
        // The caller's unit takes precedence.
        let options = MeshOptions { unit: Some(LengthUnit::Inch), ..options };
        assert_eq!(read_mesh(&bytes, &options).unwrap().mesh.bounds().1, [1.0; 3]);
    }
    assert_refused(&model("unit=\"parsec\"", "", ""), 2, "no unit");
}

#[test]
fn items_and_components_are_placed() {
    let move_x = |x: f64| format!("transform=\"1 0 0 0 1 0 0 0 1 {x} 0 0\"");
    // Object 2 is two tetrahedra. Object 3 is two of object 2, the second scaled by 2.
    let resources = format!(
        "{}
        <object id=\"2\"><components>
          <component objectid=\"1\"/><component objectid=\"1\" {}/>
        </components></object>
        <object id=\"3\" type=\"support\"><components>
          <component objectid=\"2\"/><component objectid=\"2\" transform=\"2 0 0 0 2 0 0 0 2 100 0 0\"/>
        </components></object>",
        tetrahedron(1, ""),
        move_x(10.0)
    );
    let items = format!("<item objectid=\"3\" {}/><item objectid=\"1\"/>", move_x(1000.0));
    let file = read_model(model("", &resources, &items));
    // The type of an object of components has no meaning.
    assert_eq!(file.skipped, 0);
    let report = file.mesh.report().unwrap();
    assert_eq!((report.triangles, report.bodies), (20, 5));
    let starts: Vec<f64> = file.mesh.vertices().iter().step_by(4).map(|v| v[0]).collect();
    assert_eq!(starts, [1000.0, 1010.0, 1100.0, 1120.0, 0.0]);
    assert!((file.mesh.volume() - (2.0 + 16.0 + 1.0) / 6.0).abs() < 1e-9);
    file.mesh.check_closed(FillRule::NonZero).unwrap();
}

#[test]
fn mirrors_keep_the_sign_of_volumes() {
    let mirror = "transform=\"1 0 0 0 1 0 0 0 -1 0 0 0\"";
    let swap = "transform=\"0 1 0 1 0 0 0 0 1 5 0 0\"";
    let resources = format!(
        "{}<object id=\"2\"><components><component objectid=\"1\" {mirror}/></components></object>",
        tetrahedron(1, "")
    );
    for (item, low) in [
        (format!("<item objectid=\"1\" {mirror}/>"), [0.0, 0.0, -1.0]),
        (format!("<item objectid=\"1\" {swap}/>"), [5.0, 0.0, 0.0]),
        ("<item objectid=\"2\"/>".to_owned(), [0.0, 0.0, -1.0]),
        (format!("<item objectid=\"2\" {mirror}/>"), [0.0, 0.0, 0.0]),
        (format!("<item objectid=\"2\" {swap}/>"), [5.0, 0.0, -1.0]),
    ] {
        let mesh = read_model(model("", &resources, &item)).mesh;
        assert_eq!(mesh.bounds().0, low, "{item}");
        assert!((mesh.volume() - 1.0 / 6.0).abs() < 1e-12, "{item}");
        mesh.check_closed(FillRule::NonZero).unwrap();
    }
}

#[test]
fn types_of_objects() {
    let mut resources = String::new();
    let kinds = ["model", "solidsupport", "support", "surface", "other"];
    for (id, kind) in (1..).zip(kinds) {
        resources += &tetrahedron(id, &format!("type=\"{kind}\""));
    }
    resources += "<object id=\"6\"><components><component objectid=\"1\"/><component objectid=\"2\"/><component objectid=\"3\"/></components></object>
        <object id=\"7\"><components><component objectid=\"5\"/></components></object>";
    let all = (1..=4).map(|id| format!("<item objectid=\"{id}\"/>")).collect::<String>();
    let file = read_model(model("", &resources, &(all + "<item objectid=\"6\"/>")));
    assert_eq!((file.mesh.report().unwrap().facets_read, file.skipped), (8, 5));
    for id in [5, 7] {
        let file = read_model(model("", &resources, &format!("<item objectid=\"{id}\"/>")));
        assert_eq!((file.mesh.triangles().len(), file.skipped), (0, 1));
    }
}

#[test]
fn what_has_no_meaning_is_skipped() {
    let foreign = r#"<basematerials id="9"><base name="PLA" displaycolor="white"/></basematerials>
        <x:object xmlns:x="urn:x" id="1"><mesh><vertices><vertex x="a"/></vertices></mesh></x:object>
        <object xmlns="urn:y" id="1"/>
        <z xmlns="urn:z"><object xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" id="1"/></z>"#;
    let extra = r#"<object id="2" name="a &amp; b"><metadatagroup><metadata name="p:x">1</metadata></metadatagroup><mesh>
        <vertices/><triangles/></mesh></object><?pi x?><![CDATA[<object]]>"#;
    let resources = format!("{foreign}{}{extra}", tetrahedron(1, "partnumber=\"7\" p:UUID=\"x\""));
    let build = r#"<item objectid="1" printable="0" partnumber="&lt;"/><item objectid="2"/>"#;
    let text = model(
        "requiredextensions=\"p m\" xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\"",
        &resources,
        build,
    );
    assert_eq!(read_model(&text).mesh.triangles().len(), 4);
    // A prefix for the core, and the byte order mark.
    let prefixed = text.replace("xmlns=\"http://schemas.microsoft", "xmlns:c=\"http://schemas.microsoft");
    let mut qualified =
        prefixed.replace("<object xmlns=\"urn:y\"", "<none").replace("<z xmlns", "<z xmlns:q");
    for name in [
        "model",
        "metadata",
        "metadatagroup",
        "resources",
        "basematerials",
        "base",
        "object",
        "mesh",
        "vertices",
        "vertex",
        "triangles",
        "triangle",
        "build",
        "item",
    ] {
        for end in [" ", ">", "/>"] {
            qualified = qualified.replace(&format!("<{name}{end}"), &format!("<c:{name}{end}"));
            qualified = qualified.replace(&format!("</{name}{end}"), &format!("</c:{name}{end}"));
        }
    }
    assert_eq!(read_model(&qualified).mesh.triangles().len(), 4);
    assert_refused(&prefixed, 2, "no 3MF model");
    assert_eq!(read_model(format!("\u{FEFF}{text}")).mesh.triangles().len(), 4);
    assert_eq!(read_model(text.replace('\n', "\r\n")).mesh.triangles().len(), 4);
}

#[test]
fn parts_of_the_production_extension() {
    let root = |items: &str| {
        model(
            "requiredextensions=\"p\"",
            "<object id=\"1\"><components><component objectid=\"4\" p:path=\"/3D/Objects/a%20b.model\"/>
            <component objectid=\"4\" p:path=\"/3d/objects/C.MODEL\" transform=\"1 0 0 0 1 0 0 0 1 9 0 0\"/></components></object>",
            items,
        )
    };
    let mut entries =
        package(root("<item objectid=\"1\"/><item objectid=\"5\" p:path=\"/3D/Objects/c.model\"/>"));
    let chain = "<object id=\"5\"><components><component objectid=\"4\" transform=\"1 0 0 0 1 0 0 0 1 0 50 0\"/></components></object>";
    entries.push(Entry::stored(
        "3D/Objects/a b.model",
        model("unit=\"centimeter\"", &tetrahedron(4, ""), "<item objectid=\"77\"/>"),
    ));
    entries.push(Entry::deflated("3D/Objects/c.model", model("", &(tetrahedron(4, "") + chain), "")));
    let file = read(&zip(&entries));
    assert_eq!(file.unit, Some(LengthUnit::Millimetre));
    // Items of other parts are not built, their units are converted.
    let (low, high) = file.mesh.bounds();
    assert_eq!((low, high), ([0.0; 3], [10.0, 51.0, 10.0]));
    assert!((file.mesh.volume() - 1002.0 / 6.0).abs() < 1e-9);

    let with = |index: usize, entry: Entry| {
        let mut entries = entries.clone();
        entries[index] = entry;
        zip(&entries)
    };
    let bad = Entry::stored("3D/Objects/c.model", model("", &tetrahedron(6, ""), ""));
    assert_broken(&with(4, bad), "3D/3dmodel.model", "no object 4 in 3D/Objects/c.model");
    let bad = Entry::stored("3D/Objects/d.model", "");
    assert_broken(&with(4, bad), "3D/3dmodel.model", "missing");
    let nested = "<object id=\"5\"><components><component objectid=\"1\" p:path=\"/3D/3dmodel.model\"/></components></object>";
    let bad = Entry::stored("3D/Objects/c.model", model("", &(tetrahedron(4, "") + nested), ""));
    assert_broken(&with(4, bad), "3D/Objects/c.model", "root");
    let bad = Entry::stored("3D/Objects/c.model", "no XML");
    assert_broken(&with(4, bad), "3D/Objects/c.model", "text outside");
    // A path to the root itself cannot make a circle.
    let own = "<object id=\"1\"><components><component objectid=\"1\" p:path=\"/3D/3dmodel.model\"/></components></object>";
    assert_refused(&model("", own, ITEM), 6, "not defined before");
}

#[test]
fn models_that_are_refused() {
    let good = model("", &tetrahedron(1, ""), ITEM);
    let line = |text: &str, what: &str| {
        1 + text.lines().position(|line| line.contains(what)).unwrap_or_else(|| panic!("{what}")) as u64
    };
    for (from, to, words) in [
        ("x=\"1\"", "x=\"one\"", "no finite number"),
        ("x=\"1\"", "x=\"inf\"", "no finite number"),
        ("x=\"1\"", "x=\"nan\"", "no finite number"),
        ("x=\"1\"", "x=\"1e999\"", "no finite number"),
        ("x=\"1\"", "x=\"&#49;\"", "no finite number"),
        ("x=\"1\"", "x=\"1\" x=\"2\"", "second time"),
        ("x=\"1\"", "x=1", "enclosed"),
        ("x=\"1\" y=\"0\"", "x=\"1\"", "lacks"),
        ("v1=\"1\"", "v1=\"4\"", "no vertex, of which there are 4"),
        ("v1=\"1\"", "v1=\"-1\"", "no whole number"),
        ("v1=\"1\"", "v1=\"99999999999999999999\"", "no whole number"),
        ("v1=\"1\"", "v1=\"1.0\"", "no whole number"),
        ("v1=\"1\"", "", "lacks"),
        ("object id=\"1\"", "object", "no id"),
        ("object id=\"1\"", "object id=\"1\" type=\"solid\"", "no type"),
        ("object id=\"1\"", "object id=\"1\" s:meshresolution=\"lowres\"", "not the true shape"),
        ("item objectid=\"1\"", "item objectid=\"2\"", "not defined before"),
        ("item objectid=\"1\"", "item", "no objectid"),
        ("item objectid=\"1\"", "item objectid=\"1\" transform=\"1 0 0\"", "twelve"),
        ("item objectid=\"1\"", "item objectid=\"1\" p:path=\"/nowhere\"", "missing"),
        ("<triangles>", "<triangles><!-- -- </triangles>", "not closed"),
        ("</triangles>", "</trian>", "expected"),
        ("<build>", "<build a=\"<\">", ""),
        ("</model>", "", "ends within"),
        ("</model>", "</model><model/>", "second element"),
        ("</model>", "</model>more", "text outside"),
        ("<resources>", "<!DOCTYPE x [<!ENTITY y \"zzz\">]><resources>", "document type"),
    ] {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good, "{from}");
        if words.is_empty() {
            let _ = read_mesh(&zip(&package(&text)), &MeshOptions::default());
            continue;
        }
        let error = refused(&zip(&package(&text)));
        assert!(error.problem().contains(words), "{to}: {error}");
        assert!(error.line() > 0 && error.part() == "3D/3dmodel.model", "{to}: {error}");
        if !to.is_empty() && !to.contains("model>") && !to.contains("triang") && !words.contains("lacks") {
            assert_eq!(error.line(), line(&text, to), "{to}: {error}");
        }
    }
    assert_refused(&good.replace("UTF-8", "UTF-16"), 1, "encoding");
    assert_refused("", 1, "no element");
    let no_build = good.replace("<build>", "<other>").replace("</build>", "</other>");
    assert_refused(&no_build, no_build.lines().count() as u64 + 1, "no build");
    assert_refused("<html/>", 1, "no 3MF model");
    assert_refused("<model xmlns=\"urn:other\"/>", 1, "no 3MF model");
    let twice = tetrahedron(1, "") + &tetrahedron(1, "");
    assert_refused(&model("", &twice, ITEM), line(&model("", &twice, ITEM), "</object>") + 1, "second time");
    let two_shapes = tetrahedron(1, "").replace("</mesh>", "</mesh><components/>");
    assert_refused(
        &model("", &two_shapes, ITEM),
        line(&model("", &two_shapes, ITEM), "<components/>"),
        "second shape",
    );
    // An object of an unknown kind.
    let text = model("", "<object id=\"1\"><b:booleanshape xmlns:b=\"urn:b\"/></object>", ITEM);
    assert_refused(&text, line(&text, "<item"), "neither a mesh");
    assert_eq!(read_model(text.replace("<object id", "<object type=\"support\" id")).skipped, 1);
    let mut latin = good.clone().into_bytes();
    latin[120] = 0xE9;
    assert_broken(&zip(&package(latin)), "3D/3dmodel.model", "no UTF-8");
}

#[test]
fn circles_are_impossible() {
    let object = |id: u32, to: u32| {
        format!("<object id=\"{id}\"><components><component objectid=\"{to}\"/></components></object>\n")
    };
    assert_refused(&model("", &object(1, 1), ITEM), 6, "object 1 is not defined before");
    assert_refused(&model("", &(object(1, 2) + &object(2, 1)), ITEM), 6, "object 2 is not defined before");
}

#[test]
fn extensions_that_are_required() {
    let microsoft = "http://schemas.microsoft.com/3dmanufacturing";
    let consortium = "http://schemas.3mf.io/3dmanufacturing";
    for (uri, name) in [
        (format!("{microsoft}/securecontent/2019/04"), "3MF extension \"Secure Content\""),
        (format!("{microsoft}/beamlattice/2017/02"), "3MF extension \"Beam Lattice\""),
        (format!("{microsoft}/beamlattice/balls/2020/07"), "3MF extension \"Beam Lattice: Balls\""),
        (format!("{microsoft}/slice/2015/07"), "3MF extension \"Slice\""),
        (
            format!("{microsoft}/production/alternatives/2021/04"),
            "3MF extension \"Production: Alternatives\"",
        ),
        (format!("{microsoft}/material/2099/01"), "3MF extension \"Materials and Properties\""),
        (format!("{consortium}/volumetric/2022/01"), "3MF extension \"Volumetric\""),
        (format!("{consortium}/implicit/2023/12"), "3MF extension \"Volumetric: Implicit Functions\""),
        (format!("{consortium}/displacement/2023/10"), "3MF extension \"Displacement\""),
        (format!("{consortium}/booleanoperations/2023/07"), "3MF extension \"Boolean Operations\""),
        ("urn:example:lattices".into(), "unknown extension urn:example:lattices"),
    ] {
        let attributes = format!("requiredextensions=\"p x\" xmlns:x=\"{uri}\"");
        assert_refused(&model(&attributes, &tetrahedron(1, ""), ITEM), 2, name);
        // Otherwise the reader may ignore them.
        let attributes = attributes.replace("required", "recommended");
        assert_eq!(read_model(model(&attributes, &tetrahedron(1, ""), ITEM)).mesh.triangles().len(), 4);
    }
    assert_refused(&model("requiredextensions=\"unbound\"", "", ""), 2, "stands for nothing");
}

/// An attribute that stands twice in one element is not well-formed XML, wherever the element is.
#[test]
fn attributes_that_stand_twice() {
    let turn = "transform=\"1 0 0 0 1 0 0 0 1 0 0 0\"";
    let resources = format!(
        "{}<object id=\"2\"><components><component objectid=\"1\" {turn}/></components></object>
        <basematerials id=\"9\"><base name=\"PLA\"/></basematerials>",
        tetrahedron(1, "type=\"model\"")
    );
    let items = format!("<item objectid=\"2\" {turn} p:path=\"/3D/3dmodel.model\"/>");
    let good = model("unit=\"inch\"", &resources, &items);
    read_model(&good);
    for attribute in [
        "unit=\"inch\"",
        "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"",
        "type=\"model\"",
        "objectid=\"1\"",
        "objectid=\"2\"",
        turn,
        "p:path=\"/3D/3dmodel.model\"",
        "v1=\"0\"",
        "z=\"0\"",
        "name=\"PLA\"",
        "id=\"9\"",
    ] {
        let text = good.replacen(attribute, &format!("{attribute} {attribute}"), 1);
        assert_ne!(text, good, "{attribute}");
        let error = refused(&zip(&package(&text)));
        assert!(error.problem().contains("second time") && error.line() > 0, "{attribute}: {error}");
    }
    // Another prefix for the same namespace gives the same attribute; another namespace gives another one.
    let both = |uri: &str| good.replace("p:path", &format!("xmlns:q=\"{uri}\" q:path=\"/nowhere\" p:path"));
    let error =
        refused(&zip(&package(both("http://schemas.microsoft.com/3dmanufacturing/production/2015/06"))));
    assert!(error.problem().contains("second time"), "{error}");
    read_model(both("urn:other"));
    // One among many.
    let many: String = (0..40).map(|i| format!(" a{i}=\"\"")).collect();
    let with = |more: &str| good.replace("<build", &format!("<build{many}{more}"));
    read_model(with(" b=\"\""));
    let error = refused(&zip(&package(with(" a7=\"\""))));
    assert!(error.problem().contains("a7") && error.problem().contains("second time"), "{error}");
    // In the other parts too.
    for (index, attribute) in [(0, "Extension=\"model\""), (1, "Target=\"/3D/3dmodel.model\"")] {
        let mut entries = package(&good);
        let text = [CONTENT_TYPES, RELATIONSHIPS][index];
        let twice = text.replacen(attribute, &format!("{attribute} {attribute}"), 1);
        assert_ne!(twice, text);
        let name = ["[Content_Types].xml", "_rels/.rels"][index];
        entries[index] = Entry::stored(name, twice);
        assert_broken(&zip(&entries), name, "second time");
    }
}

/// Many attributes or many prefixes take linear time.
#[test]
fn many_attributes_and_prefixes() {
    let good = model("", &tetrahedron(1, ""), ITEM);
    let many: String = (0..100_000).map(|i| format!(" a{i}=\"\"")).collect();
    read_model(good.replace("<build", &format!("<build{many}")));
    let many: String = (0..100_000).map(|i| format!(" xmlns:a{i}=\"urn:{i}\"")).collect();
    let error = refused(&zip(&package(good.replace("<build", &format!("<build{many}")))));
    assert!(error.problem().contains("too many prefixes"), "{error}");
}

/// XML may be in UTF-16, with a byte order mark.
#[test]
fn utf_16() {
    let encoded = |text: &str, big: bool, mark: bool| -> Vec<u8> {
        let text = text.replace("UTF-8", "UTF-16");
        let units = mark.then_some(0xFEFF).into_iter().chain(text.encode_utf16());
        units.flat_map(|unit| if big { unit.to_be_bytes() } else { unit.to_le_bytes() }).collect()
    };
    let good = model("", &tetrahedron(1, "name=\"Fl\u{e4}che \u{1F600}\""), ITEM);
    let expected = read_model(&good).mesh;
    for big in [false, true] {
        let mut entries = package(encoded(&good, big, true));
        entries[0] = Entry::stored("[Content_Types].xml", encoded(CONTENT_TYPES, big, true));
        entries[1] = Entry::stored("_rels/.rels", encoded(RELATIONSHIPS, big, true));
        let mesh = read(&zip(&entries)).mesh;
        assert_eq!((mesh.vertices(), mesh.triangles()), (expected.vertices(), expected.triangles()));
        let part = "3D/3dmodel.model";
        assert_broken(&zip(&package(encoded(&good, big, false))), part, "UTF-16 without its byte order mark");
        let mut odd = encoded(&good, big, true);
        odd.push(b' ');
        assert_broken(&zip(&package(odd)), part, "odd");
        let mut lone = encoded(&good, big, true);
        lone.extend(if big { [0xD8, 0] } else { [0, 0xD8] });
        assert_broken(&zip(&package(lone)), part, "no UTF-16 text from character");
        // The declared encoding must be the real one.
        let wrong = encoded(&good.replace("UTF-8", "ISO-8859-1"), big, true);
        assert_broken(&zip(&package(wrong)), part, "encoding is not UTF-16");
    }
    assert_refused(&good.replace("UTF-8", "UTF-16"), 1, "encoding is not UTF-8");
}

/// Files from before the first standard, as programs of 2013 and 2014 write them.
#[test]
fn the_draft() {
    let colours = "<color id=\"0\" value=\"#FFFFFF\"/><material id=\"3\" colorid=\"0\"/>";
    let text = model("", &(colours.to_owned() + &tetrahedron(1, "materialid=\"3\"")), ITEM);
    let core = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
    let draft = text.replace(core, "http://schemas.microsoft.com/3dmanufacturing/2013/01");
    assert_ne!(draft, text);
    let [new, old] = [text, draft].map(read_model);
    assert_eq!((old.mesh.vertices(), old.mesh.triangles()), (new.mesh.vertices(), new.mesh.triangles()));
    // One triangle refers to missing properties. In the draft, the reference has no meaning.
    assert_eq!(new.warnings, [MeshWarning::Properties { triangles: 1 }]);
    assert_eq!(old.warnings, [MeshWarning::Draft]);
    assert_eq!(old.warnings[0].to_string(), "this is 3MF of the draft 0.93; it was read as 1.0");
}

#[test]
fn plain_xml_is_no_package() {
    let text = model("", &tetrahedron(1, ""), ITEM);
    for bytes in [
        text.clone().into_bytes(),
        format!("\u{FEFF}\n{text}").into_bytes(),
        format!("\u{FEFF}{text}").encode_utf16().flat_map(u16::to_le_bytes).collect(),
    ] {
        let options = MeshOptions { format: Some(MeshFormat::ThreeMf), ..MeshOptions::default() };
        match read_mesh(&bytes, &options) {
            Err(Error::Package(error)) => assert!(error.to_string().contains("plain XML"), "{error}"),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn packages_that_are_refused() {
    let good = package(model("", &tetrahedron(1, ""), ITEM));
    let with = |index: usize, change: &dyn Fn(&mut Entry)| {
        let mut entries = good.clone();
        change(&mut entries[index]);
        zip(&entries)
    };
    assert_broken(&zip(&[]), "[Content_Types].xml", "missing");
    assert_broken(&zip(&good[1..]), "[Content_Types].xml", "missing");
    assert_broken(&zip(&[good[0].clone(), good[2].clone()]), "_rels/.rels", "missing");
    assert_broken(&zip(&good[..2]), "/3D/3dmodel.model", "missing");
    for index in 0..3 {
        let name = ["[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"][index];
        assert_broken(&with(index, &|entry| entry.flags = 1), name, "encrypted");
        assert_broken(&with(index, &|entry| entry.crc ^= 1), name, "checksum");
        assert_broken(&with(index, &|entry| entry.length += 1), name, "length");
        assert_broken(&with(index, &|entry| entry.length -= 1), name, "length");
        assert_broken(&with(index, &|entry| entry.length = u32::MAX - 1), name, "longer than its data");
        assert_broken(&with(index, &|entry| entry.method = 14), name, "DEFLATE");
        assert_broken(&with(index, &|entry| entry.data[20] ^= 0x55), name, "damaged");
        let mut twice = good.clone();
        twice.push(Entry { name: twice[index].name.to_ascii_uppercase(), ..twice[index].clone() });
        let error = refused(&zip(&twice));
        assert!(error.to_string().contains("more than once"), "{error}");
    }
    let link = |from: &str, to: &str| {
        let mut entries = good.clone();
        let text = RELATIONSHIPS.replace(from, to);
        assert_ne!(text, RELATIONSHIPS);
        entries[1] = Entry::deflated("_rels/.rels", text);
        zip(&entries)
    };
    let kind = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
    assert_broken(&link(kind, "urn:x"), "_rels/.rels", "no 3D model");
    assert_broken(&link("/3D/3dmodel.model", "/3D/other.model"), "/3D/other.model", "missing");
    assert_broken(&link("Target=\"/3D/3dmodel.model\"", ""), "_rels/.rels", "no target");
    assert_broken(&link("Target=\"/3D/", "TargetMode=\"External\" Target=\"/3D/"), "_rels/.rels", "outside");
    let second = format!("<Relationship Target=\"/3D/b.model\" Id=\"q\" Type=\"{kind}\"/></Relationships>");
    assert_broken(&link("</Relationships>", &second), "_rels/.rels", "second");
    let keys = "<Relationship Target=\"/Secure/keystore.xml\" Id=\"q\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2019/04/keystore\"/></Relationships>";
    assert_broken(&link("</Relationships>", keys), "_rels/.rels", "protected content");
    assert_eq!(read(&link("\"/3D/3dmodel.model", "\"3D/3dmodel%2emodel")).mesh.triangles().len(), 4);
    let mut entries = good.clone();
    entries[0] = Entry::stored(
        "[Content_Types].xml",
        CONTENT_TYPES.replace("vnd.ms-package.3dmanufacturing-3dmodel", "octets"),
    );
    assert_broken(&zip(&entries), "/3D/3dmodel.model", "something else");
    let declared = "<Override PartName=\"/3D/3dmodel.model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>";
    entries[0] = Entry::stored(
        "[Content_Types].xml",
        CONTENT_TYPES
            .replace("vnd.ms-package.3dmanufacturing-3dmodel", "octets")
            .replace("</Types>", declared),
    );
    assert_eq!(read(&zip(&entries)).mesh.triangles().len(), 4);
}

#[test]
fn bombs() {
    // Gigabytes of blanks.
    let blanks = vec![b' '; 64 << 20];
    let bytes = zip(&package(blanks));
    assert!(bytes.len() < 100_000);
    assert_broken(&bytes, "3D/3dmodel.model", "64 times");
    // A thousand parts of one megabyte, each reached by a path.
    let filler = " ".repeat(1 << 20);
    let items: String = (0..40).map(|i| format!("<item objectid=\"1\" p:path=\"/{i}.model\"/>")).collect();
    let mut entries = package(model("", "", &items));
    let part = model("", &(tetrahedron(1, "") + &filler), "");
    let part = Entry::deflated("", part);
    entries.extend((0..40).map(|i| Entry { name: format!("{i}.model").into(), ..part.clone() }));
    assert!(refused(&zip(&entries)).to_string().contains("64 times"));
    // 2^60 tetrahedra.
    let mut resources = tetrahedron(1, "");
    for id in 2..62 {
        resources += &format!(
            "<object id=\"{id}\"><components><component objectid=\"{0}\"/><component objectid=\"{0}\"/></components></object>",
            id - 1
        );
    }
    let text = model("", &resources, "<item objectid=\"61\"/>");
    assert_broken(&zip(&package(&text)), "3D/3dmodel.model", "2^25");
    // An empty object, 2^60 times, is empty.
    assert_eq!(read_model(text.replace("<triangle ", "<nothing ")).mesh.triangles().len(), 0);
    let supports = text.replace("<object id=\"1\"", "<object type=\"support\" id=\"1\"");
    assert_eq!(read_model(supports).skipped, 1 << 60);
    // One tetrahedron at the end of a long chain, many times.
    let mut resources = tetrahedron(1, "");
    for id in 2..50_000 {
        resources += &format!(
            "<object id=\"{id}\"><components><component objectid=\"{}\"/></components></object>",
            id - 1
        );
    }
    let text = model("", &resources, "<item objectid=\"49999\"/>");
    assert_eq!(read_model(&text).mesh.triangles().len(), 4);
    let many = model("", &resources, &"<item objectid=\"49999\"/>".repeat(1000));
    assert_broken(&zip(&package(&many)), "3D/3dmodel.model", "several times");
    // Deep nesting, and long names.
    let deep = "<a>".repeat(100_000);
    assert_refused(&model("", &deep, ""), 6, "too deeply");
    let long = format!("<{}>", "a".repeat(100_000));
    assert_refused(&model("", &long, ""), 6, "too long names");
    let path = format!("<item objectid=\"1\" p:path=\"{}\"/>", "/a".repeat(100_000));
    assert_refused(&model("", "", &path), 9, "too long");
}

#[test]
fn truncated_and_changed() {
    let entries = package(model("", &tetrahedron(1, ""), ITEM));
    let stored: Vec<Entry> = vec![
        Entry::stored("[Content_Types].xml", CONTENT_TYPES),
        Entry::stored("_rels/.rels", RELATIONSHIPS),
        Entry::stored("3D/3dmodel.model", model("", &tetrahedron(1, ""), ITEM)),
    ];
    for bytes in [zip(&entries), zip(&stored)] {
        assert_eq!(read(&bytes).mesh.triangles().len(), 4);
        for length in 0..bytes.len() {
            let options = MeshOptions { format: Some(MeshFormat::ThreeMf), ..MeshOptions::default() };
            assert!(read_mesh(&bytes[..length], &options).is_err(), "{length}");
        }
        for at in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[at] ^= 1 << (at % 8);
            // Names, contents, sizes and checksums all matter; dates and versions do not.
            if let Ok(file) = read_mesh(&changed, &MeshOptions::default()) {
                assert_eq!(file.mesh.triangles().len(), 4, "{at}");
            }
        }
    }
}

/// The fuzzer's initial inputs are read, and contain every part that the fuzzer can change.
#[test]
fn what_the_fuzzer_found_interesting() {
    let corpus = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus/packages");
    let mut count = 0;
    for entry in std::fs::read_dir(&corpus).unwrap() {
        packages::packages(&std::fs::read(entry.unwrap().path()).unwrap());
        count += 1;
    }
    assert!(count > 100, "{count} inputs");
}

#[test]
fn seeds_of_the_fuzzer() {
    let seeds = packages::seeds();
    seeds.iter().for_each(|seed| packages::packages(seed));
    let options = MeshOptions::default();
    let whole = seeds.iter().filter(|seed| read_mesh(seed, &options).is_ok()).count();
    assert_eq!(whole, 2, "packages");
    let pieces: Vec<_> = seeds[0].split(|&b| b == 0).collect();
    let mut entries = package(pieces[0]);
    entries.push(Entry::stored("b.model", pieces[1]));
    let file = read(&zip(&entries));
    assert_eq!((file.unit, file.mesh.triangles().len()), (Some(LengthUnit::Inch), 12));
}

/// Writes the seeds for fuzzing into the folder that `LEAFLESS_SEEDS` names.
#[test]
#[ignore = "a tool: see fuzz/README.md"]
fn write_seeds() {
    let folder = std::env::var_os("LEAFLESS_SEEDS").expect("LEAFLESS_SEEDS names a folder");
    let folder = std::path::Path::new(&folder).join("packages");
    std::fs::create_dir_all(&folder).unwrap();
    for (k, seed) in packages::seeds().iter().enumerate() {
        std::fs::write(folder.join(format!("{k}")), seed).unwrap();
    }
}

/// Text with pieces of the format in any order.
fn markup() -> impl Strategy<Value = String> {
    let pieces = prop::sample::select(vec![
        "<resources>",
        "</resources>",
        "<object id=\"1\">",
        "<object id=\"2\">",
        "</object>",
        "<mesh>",
        "</mesh>",
        "<vertices>",
        "</vertices>",
        "<vertex x=\"0\" y=\"1\" z=\"2\"/>",
        "<vertex x=\"0\" y=\"5\" z=\"2\"/>",
        "<triangles>",
        "</triangles>",
        "<triangle v1=\"0\" v2=\"1\" v3=\"0\"/>",
        "<components>",
        "</components>",
        "<component objectid=\"1\"/>",
        "<component objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 0 0 0\"/>",
        "<build>",
        "</build>",
        "<item objectid=\"1\"/>",
        "<item objectid=\"2\"/>",
        "<!-- -->",
        "&amp;",
        "<?x?>",
        "]]>",
        "<",
        ">",
        "\"",
        "x",
    ]);
    prop::collection::vec(pieces, 0..60).prop_map(|pieces| pieces.concat())
}

proptest! {
    #![proptest_config(leafless_testkit::cases(5000))]

    #[test]
    fn any_markup(text in markup(), in_resources: bool) {
        let text = if in_resources { model("", &text, ITEM) } else { format!("<model xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">{text}</model>") };
        let _ = read_mesh(&zip(&package(text)), &MeshOptions::default());
    }

    /// A sound model and its relationships, with their own pieces moved to other places, give an answer or an
    /// error.
    #[test]
    fn shuffled_pieces(
        cuts in prop::collection::vec((0..1800usize, 0..1800usize, 0..40usize), 1..6),
        part in 0..3usize,
    ) {
        let resources = tetrahedron(1, "")
            + "<object id=\"2\"><components><component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 -1 0 0 0\"/></components></object>";
        let mut texts = [CONTENT_TYPES.to_owned(), RELATIONSHIPS.to_owned(), model("", &resources, "<item objectid=\"2\"/>")];
        let mut bytes = std::mem::take(&mut texts[part]).into_bytes();
        for (from, to, length) in cuts {
            let (from, to) = (from % bytes.len(), to % bytes.len());
            let piece = bytes[from..(from + length).min(bytes.len())].to_vec();
            let end = (to + piece.len()).min(bytes.len());
            bytes[to..end].copy_from_slice(&piece[..end - to]);
        }
        texts[part] = String::from_utf8(bytes).unwrap();
        let names = ["[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"];
        let entries: Vec<Entry> = names.iter().zip(&texts).map(|(name, text)| Entry::stored(name, text)).collect();
        if let Ok(file) = read_mesh(&zip(&entries), &MeshOptions::default()) {
            prop_assert!(file.mesh.report().unwrap().facets_read <= 8);
        }
    }

    /// Written meshes come back unchanged.
    #[test]
    fn written_meshes(
        vertices in prop::collection::vec(prop::array::uniform3(-1e9..1e9f64), 3..40),
        corners in prop::collection::vec(prop::array::uniform3(0..1000u32), 1..60),
    ) {
        let count = vertices.len() as u32;
        let triangles: Vec<[u32; 3]> = corners.into_iter().map(|t| t.map(|v| v % count)).collect();
        let mut resources = String::from("<object id=\"1\"><mesh><vertices>");
        for [x, y, z] in &vertices {
            resources += &format!("<vertex x=\"{x}\" y=\"{y:e}\" z=\"{z}\"/>");
        }
        resources += "</vertices><triangles>";
        for [a, b, c] in &triangles {
            resources += &format!("<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>");
        }
        resources += "</triangles></mesh></object>";
        let file = read_mesh(&zip(&package(model("", &resources, ITEM))), &MeshOptions::default()).unwrap();
        let expected = leafless::TriangleMesh::new(vertices, triangles).unwrap();
        prop_assert_eq!(file.mesh.vertices(), expected.vertices());
        prop_assert_eq!(file.mesh.triangles(), expected.triangles());
        prop_assert_eq!(file.mesh.report().unwrap(), expected.report().unwrap());
    }
}
