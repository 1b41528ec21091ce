//! The program `leafless`, from outside: every subcommand, its output, and the files it leaves.

use crate::place::{Place, Run, block, meshes, solids, stl};
use leafless::{Membership, TriangleMesh, file};
use leafless_testkit::{Random, model, zip};
use serde_json::Value;
use std::ffi::OsStr;
use std::io::{Read, Write};
use std::process::{Child, Command, Stdio};

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

fn volume(value: &Value) -> (f64, f64) {
    (value["volume"]["lower"].as_f64().unwrap(), value["volume"]["upper"].as_f64().unwrap())
}

#[test]
fn help_and_version() {
    let place = Place::new();
    let version = format!("leafless {}\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(place.run("--version").good().text(), version);
    let help = place.run("--help").good();
    let commands = [
        "voxelize",
        "csg",
        "dexelize",
        "convert",
        "info",
        "verify",
        "union",
        "intersection",
        "difference",
        "xor",
        "complement",
        "contains",
        "ray",
        "heights",
        "measure",
        "within",
        "bitmap",
        "demo",
    ];
    for command in commands {
        assert!(help.text().contains(&format!("\n  {command} ")), "{help:?}");
        let own = place.run(&format!("{command} --help")).good();
        assert!(own.text().contains("Usage: leafless"), "{own:?}");
    }
}

#[test]
fn wrong_usage_is_one_line_and_code_2() {
    let place = solids();
    let before = place.files();
    for (line, words) in [
        ("voxelise a", &["voxelise", "voxelize"][..]),
        ("voxelize", &["MESH", "--output"]),
        ("voxelize cube.stl -o out.lfl", &["--depth"]),
        ("voxelize cube.stl --depth 5", &["--output"]),
        ("voxelize cube.stl -o out.lfl --depth 0", &["--depth", "0"]),
        ("voxelize cube.stl -o out.lfl --depth 21", &["--depth", "21", "20"]),
        ("voxelize cube.stl -o out.lfl --depth five", &["--depth", "five"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --rule exact", &["--rule", "certified", "sampled"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --fill odd", &["--fill", "evenodd"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --format step", &["--format", "step", "3mf"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --unit yard", &["--unit", "yard", "mm"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --to-unit parsec", &["--to-unit", "parsec", "mm"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --scale 0", &["--scale", "none of them is 0"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --scale 1,2", &["--scale", "or three"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --scale inf", &["--scale", "a factor"]),
        ("info cube.stl --scale nan", &["--scale", "a factor"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --threads -1", &["-1"]),
        ("csg part.csg -o out.lfl", &["--depth"]),
        ("csg part.csg --depth 5", &["--output"]),
        ("csg part.csg -o out.lfl --depth 5 --touch hard", &["--touch", "exact", "paper"]),
        ("csg part.csg -o out.lfl --depth 5 --adaptive -1", &["--adaptive", "not below 0"]),
        ("csg part.csg -o out.lfl --depth 5 --adaptive inf", &["--adaptive", "not below 0"]),
        ("csg part.csg -o out.lfl --depth 5 --adaptive 0.1 --rule sampled", &["--adaptive", "--rule"]),
        ("csg part.csg -o out.lfl --depth 5 --adaptive 0.1 --touch paper", &["--adaptive", "--touch paper"]),
        ("csg part.csg -o out.lfl --surfaces=0", &["--surfaces", "above 0"]),
        ("csg part.csg -o out.lfl --surfaces=nan", &["--surfaces", "above 0"]),
        ("csg part.csg -o out.lfl --surfaces --rule sampled", &["--surfaces", "--rule"]),
        ("csg part.csg -o out.lfl --surfaces --touch paper", &["--surfaces", "--touch paper"]),
        ("csg part.csg -o out.lfl --surfaces --depth 5 --adaptive 1", &["--surfaces", "--adaptive"]),
        ("csg part.csg -o out.lfl --depth 5 --bounds 1,2,3", &["--bounds", "four numbers"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --threads 9999", &["--threads", "1024"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --bounds 1,2,3", &["--bounds", "four numbers"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --bounds 1,2,3,x", &["--bounds", "four numbers"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --bounds 0,0,0,0", &["--bounds", "edge"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --bounds 0,0,0,-1", &["--bounds", "edge"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --bounds 0,0,0,nan", &["--bounds", "edge"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --bounds nan,0,0,1", &["--bounds", "origin"]),
        ("voxelize cube.stl -o out.lfl --depth 5 --bounds 0,0,inf,1", &["--bounds", "origin"]),
        ("info", &["FILE"]),
        ("info cube.lfl slab.lfl", &["slab.lfl"]),
        ("union cube.lfl -o out.lfl", &["FILE", "2"]),
        ("union cube.lfl slab.lfl", &["--output"]),
        ("xor - - -o out.lfl", &["standard input"]),
        ("complement cube.lfl slab.lfl -o out.lfl", &["slab.lfl"]),
        ("contains -", &["standard input"]),
        ("ray -", &["standard input"]),
        ("heights cube.lfl", &["--axis"]),
        ("heights cube.lfl --axis w", &["--axis", "x", "y", "z"]),
        ("heights cube.lfl --axis z --from left", &["--from", "above", "below"]),
        ("heights cube.lfl --axis z --bounds 0,0,0,1", &["--bounds", "meshes"]),
        ("ray cube.lfl --on empty", &["--on", "full", "upper"]),
        ("ray cube.lfl --bounds 0,0,0,1", &["--bounds", "meshes"]),
        ("ray cube.lfl --depth 21", &["--depth", "21"]),
        ("measure", &["FILE"]),
        ("measure cube.lfl --tolerance -1", &["--tolerance", "not below 0"]),
        ("measure cube.lfl --tolerance nan", &["--tolerance", "not below 0"]),
        ("measure cube.lfl --splits -1", &["-1"]),
        ("measure cube.lfl --depth 21", &["--depth", "21"]),
        ("demo a b", &["b"]),
    ] {
        place.run(line).bad(2, words);
    }
    // Without a command, the help goes to standard error.
    let nothing = place.run("");
    assert!(nothing.code == Some(2) && nothing.bytes.is_empty() && nothing.errors.contains("voxelize"));
    assert_eq!(place.files(), before);
}

#[test]
fn voxelize_reports_and_records() {
    let place = meshes();
    let run = place.run("voxelize cube.stl -o cube.lfl --depth 6").good();
    for words in ["12 triangles", "1 body", "cube.lfl", "depth 6", "volume", "nodes", "bytes"] {
        assert!(run.text().contains(words), "{words}: {run:?}");
    }
    let json = place.run("voxelize cube.stl -o cube.lfl --depth 6 --json").good().json();
    for key in ["read", "build", "save", "total"] {
        let time = json["timings"][key].as_f64().unwrap();
        assert!((0.0..60.0).contains(&time), "{key} {time}");
    }
    assert_eq!(
        keys(&json["mesh"]),
        [
            "bent_polygons",
            "bodies",
            "boundary_edges",
            "boundary_loops",
            "defects",
            "degenerate",
            "displacement",
            "duplicate",
            "facets_read",
            "flat",
            "inside_out_bodies",
            "misoriented_edges",
            "non_manifold_edges",
            "open_bodies",
            "opposite",
            "overlapping_bodies",
            "polygon_deviation",
            "polygons",
            "sewn",
            "triangles",
            "undecided_bodies",
            "vertices",
            "welded",
        ]
    );
    assert_eq!((&json["mesh"]["triangles"], &json["mesh"]["welded"]), (&12.into(), &28.into()));
    assert_eq!(json["mesh"]["defects"], serde_json::json!([]));
    assert_eq!((&json["input"], &json["output"]), (&"cube.stl".into(), &"cube.lfl".into()));
    assert_eq!((&json["rule"], &json["fill"]), (&"certified".into(), &"nonzero".into()));
    assert_eq!(json["clipped"], false);
    assert_eq!(json["bytes"], place.bytes("cube.lfl").len());
    // The cube's faces are round numbers, and so are the lattice planes: the volume is exact.
    assert_eq!((json["edge"].as_f64(), json["origin"][0].as_f64()), (Some(2.0), Some(1.0)));
    assert_eq!(volume(&json), (8.0, 8.0));

    // The report contains everything that `info` prints.
    let info = place.run("info cube.lfl --json").good().json();
    for (key, value) in info.as_object().unwrap() {
        assert_eq!(json[key], *value, "{key}");
    }
    let length = place.bytes("cube.stl").len();
    let source = format!("crc32:{:08x} bytes:{length}", crc32fast::hash(&place.bytes("cube.stl")));
    assert_eq!(
        info["metadata"],
        serde_json::json!({ "name": "cube", "rule": "certified", "source": source })
    );
    assert_eq!(place.files(), ["cube.lfl", "cube.stl", "slab.stl"]);
}

#[test]
fn the_four_rules_and_both_fills() {
    let place = Place::new();
    // Two boxes that overlap in [2, 3] × [1, 3]², each 2³.
    let mut facets = Vec::new();
    for mesh in [block([1.0; 3], [3.0; 3]), block([2.0, 1.0, 1.0], [4.0, 3.0, 3.0])] {
        facets.extend(mesh.triangles().iter().map(|t| t.map(|v| mesh.vertices()[v as usize])));
    }
    place.write("two.stl", stl(&TriangleMesh::from_facets(&facets).unwrap()));
    // The lattice planes do not meet the faces: 0.3 + i / 4.
    let run = |options: &str| {
        let json = place
            .run(&format!("voxelize two.stl -o two.lfl --depth 4 --bounds 0.3,0.3,0.3,4 --json {options}"));
        let json = json.good().json();
        (json["binary"].as_bool().unwrap(), volume(&json))
    };
    let (binary, (lower, upper)) = run("");
    assert!(!binary && lower < 12.0 && 12.0 < upper);
    assert_eq!(run("--rule certified"), (false, (lower, upper)));
    assert_eq!(run("--rule inner"), (true, (lower, lower)));
    assert_eq!(run("--rule outer"), (true, (upper, upper)));
    let (binary, (sampled, same)) = run("--rule sampled");
    assert!(binary && sampled == same && lower < sampled && sampled < upper);
    let (_, (lower, upper)) = run("--fill evenodd");
    assert!(lower < 8.0 && 8.0 < upper && upper < 12.0 + 4.0, "{lower} {upper}");
    let (_, (sampled, _)) = run("--fill evenodd --rule sampled");
    assert!((7.0..9.0).contains(&sampled), "{sampled}");
    // The other queries follow the same rules.
    for (fill, volume) in
        [("", 12.0), ("--fill nonzero", 12.0), ("--fill positive", 12.0), ("--fill evenodd", 8.0)]
    {
        let json = place.run(&format!("measure two.stl --json {fill}")).good().json();
        let [lower, upper] = ["lower", "upper"].map(|side| json["volume"][side].as_f64().unwrap());
        assert!(lower <= volume && volume <= upper && upper - lower < 0.2, "{fill}: {lower} {upper}");
        let run = place.run(&format!("info two.stl {fill}")).good();
        let text = run.text();
        let rule = if fill.is_empty() { "nonzero" } else { &fill[7..] };
        assert!(text.contains(&format!("by the rule ({rule})")), "{text}");
    }
    place.run("measure two.lfl --fill evenodd").bad(2, &["--fill", "is for meshes", "two.lfl"]);
}

#[test]
fn a_mesh_that_sticks_out_is_reported() {
    let place = meshes();
    let run = place.run("voxelize slab.stl -o out.lfl --depth 4 --bounds -4,-4,-4,8 --json");
    assert_eq!(run.code, Some(0), "{run:?}");
    assert_eq!(run.errors.lines().count(), 1, "{run:?}");
    for words in ["slab.stl", "warning", "x from 2 to 6, bounds -4 to 4", "y from 2 to 6"] {
        assert!(run.errors.contains(words), "{run:?}");
    }
    assert!(!run.errors.contains("z from"), "{run:?}");
    let json = run.json();
    assert_eq!(json["clipped"], true);
    // The remaining part of the slab is [2, 4] × [2, 4] × [0, 2].
    let (lower, upper) = volume(&json);
    assert!(lower <= 8.0 && 8.0 <= upper);
    assert_eq!(place.run("info out.lfl --json").good().json()["clipped"], true);
    assert!(place.run("info out.lfl").good().text().contains("may go on outside"));
    // An empty result is no error, either.
    let run = place.run("voxelize slab.stl -o out.lfl --depth 4 --bounds=-9,-9,-9,1 --json");
    assert_eq!((run.code, volume(&run.json())), (Some(0), (0.0, 0.0)));
    assert!(run.errors.contains("warning"), "{run:?}");
}

#[test]
fn meshes_that_are_refused() {
    let place = meshes();
    let open = block([0.0; 3], [1.0; 3]);
    let facets: Vec<_> =
        open.triangles()[1..].iter().map(|t| t.map(|v| open.vertices()[v as usize])).collect();
    place.write("open.stl", stl(&TriangleMesh::from_facets(&facets).unwrap()));
    let mut turned = facets.clone();
    let [a, b, c] = open.triangles()[0].map(|v| open.vertices()[v as usize]);
    turned.push([a, c, b]);
    place.write("turned.stl", stl(&TriangleMesh::from_facets(&turned).unwrap()));
    place.write("empty.stl", "");
    place.write("none.stl", "solid nothing\nendsolid nothing\n");
    place.write("dot.stl", "solid dot\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nvertex 1 2 3\nvertex 1 2 3\nendloop\nendfacet\nendsolid\n");
    place.write("text.stl", "This is not a mesh, but a text that is longer than the header of a binary STL file would be, and on.");
    place.write("short.stl", &place.bytes("cube.stl")[..300]);
    place.run("voxelize cube.stl -o solid.lfl --depth 3").good();
    let before = place.files();
    for (name, words) in [
        ("empty.stl", &["empty"][..]),
        ("none.stl", &["no triangle"]),
        ("dot.stl", &["no triangle"]),
        ("text.stl", &[]),
        ("short.stl", &["12 facets", "300"]),
        ("solid.lfl", &["solid already"]),
        ("missing.stl", &["No such file"]),
        (".", &["directory"]),
    ] {
        let words: Vec<_> =
            words.iter().copied().chain([format!("leafless: {name}: ").leak() as &str]).collect();
        place.run(&format!("voxelize {name} -o out.lfl --depth 4")).bad(1, &words);
    }
    place.run_with("voxelize - -o out.lfl --depth 4", b"").bad(1, &["standard input", "empty"]);
    let words = ["open.stl", "not closed", "3 edges", "--fill nonzero"];
    place.run("voxelize open.stl -o out.lfl --depth 4 --fill evenodd").bad(1, &words);
    let words = ["open.stl", "unit"];
    place.run("voxelize open.stl -o out.lfl --depth 4 --to-unit mm").bad(1, &words);
    place.run("voxelize cube.stl -o out.lfl --depth 4 --format 3mf").bad(1, &["cube.stl", "ZIP"]);
    place.run("voxelize cube.stl -o out.lfl --depth 4 --scale 1e77").bad(2, &["--scale", "2^64"]);
    assert_eq!(place.files(), before);
    // By the even-odd rule orientation does not matter.
    place.run("voxelize turned.stl -o out.lfl --depth 4 --fill evenodd").good();
}

/// The published figures of the sphere, from a scene.
#[test]
fn a_scene_becomes_a_solid() {
    let place = Place::new();
    let moved = "multmatrix([[1, 0, 0, 64], [0, 1, 0, 64], [0, 0, 1, 64], [0, 0, 0, 1]])";
    place.write(
        "sphere.csg",
        format!("// a ball\n{moved} {{\n\tsphere($fn = 0, $fa = 12, $fs = 2, r = 64);\n}}\n"),
    );
    let line = "csg sphere.csg -o sphere.lfl --depth 6 --bounds 0,0,0,128 --touch paper --json";
    let report = place.run(line).good().json();
    let figures = [
        (3, 65, 557_056.0, 1_671_168.0),
        (4, 337, 802_816.0, 1_396_736.0),
        (5, 1497, 946_176.0, 1_250_816.0),
        (6, 6257, 1_021_056.0, 1_174_912.0),
    ];
    for (level, splits, lower, upper) in figures {
        let found = &report["levels"][level];
        assert_eq!(found["level"], level);
        assert_eq!((found["splits"].as_u64(), found["lower"].as_f64()), (Some(splits), Some(lower)));
        assert_eq!(found["upper"].as_f64(), Some(upper));
    }
    assert_eq!(report["splits"], 6257);
    assert!(report["evaluations"].as_u64().unwrap() > 6257);
    assert_eq!((&report["touch"], &report["rule"]), (&"paper".into(), &"certified".into()));
    let info = place.run("info sphere.lfl --json").good().json();
    assert_eq!(volume(&info), (1_021_056.0, 1_174_912.0));
    assert_eq!(info["clipped"], false);
    assert_eq!((&info["metadata"]["name"], &info["metadata"]["touch"]), (&"sphere".into(), &"paper".into()));

    // Without bounds, with text output, from standard input, and with files beside the scene.
    place.write("cube.stl", stl(&block([1.0; 3], [3.0; 3])));
    let scene = b"difference() { cube(4); mesh(\"cube.stl\"); octree(\"small.lfl\"); }";
    place.run_with("csg - -o small.lfl --depth 4 --bounds 0,0,0,8", b"cube([2, 1, 1]);").good();
    place.write("part.csg", scene);
    let told = place.run("csg part.csg -o part.lfl --depth 5").good();
    for word in ["certified octree of depth 5", "volume", "splits", "evaluations", "nodes", "bytes", "time"] {
        assert!(told.text().contains(word), "{told:?}");
    }
    let report = place.run("csg part.csg -o part.lfl --depth 5 --bounds 0,0,0,8 --json").good().json();
    // Bulk work of a mesh and an octree is not counted.
    assert!(report["splits"].is_null() && report["evaluations"].as_u64().unwrap() > 0);
    assert!(report["levels"].as_array().unwrap().iter().all(|level| level.get("splits").is_none()));
    let (lower, upper) = volume(&report);
    assert!(lower <= 64.0 - 8.0 - 2.0 && 64.0 - 8.0 - 2.0 <= upper && upper - lower < 4.0, "{lower} {upper}");
    let bytes = place.bytes("part.lfl");
    for threads in [1, 3] {
        place.run(&format!("csg part.csg -o part.lfl --depth 5 --bounds 0,0,0,8 --threads {threads}")).good();
        assert_eq!(place.bytes("part.lfl"), bytes);
    }
    let inner =
        place.run("csg sphere.csg -o inner.lfl --depth 4 --bounds 0,0,0,128 --rule inner --json").good();
    assert_eq!(volume(&inner.json()), (802_816.0, 802_816.0));

    // Errors in scenes.
    let before = place.files();
    place.write("bad.csg", "group() {\n  cube(size = [1, 2]);\n}\n");
    place.run("csg bad.csg -o out.lfl --depth 4").bad(1, &["bad.csg: line 2, column 15: expected 3 items"]);
    place.write("bad.csg", "halfspace([1, 0, 0, 0]);");
    place.run("csg bad.csg -o out.lfl --depth 4").bad(1, &["bad.csg", "--bounds"]);
    place.write("bad.csg", "\n mesh(\"none.stl\");");
    place.run("csg bad.csg -o out.lfl --depth 4").bad(1, &["bad.csg: line 2, column 7: none.stl: "]);
    place.run("csg part.lfl -o out.lfl --depth 4").bad(1, &["part.lfl", "a solid already"]);
    place.run("csg part.csg -o part.csg --depth 4").bad(1, &["part.csg", "not overwritten"]);
    place.run("csg none.csg -o out.lfl --depth 4").bad(1, &["none.csg"]);
    std::fs::remove_file(place.path("bad.csg")).unwrap();
    assert_eq!(place.files(), before);
    // The program reports a scene that sticks out.
    let out = place.run("csg sphere.csg -o out.lfl --depth 4 --bounds 0,0,0,100");
    assert!(out.code == Some(0) && out.errors.contains("beyond the bounds"), "{out:?}");
}

/// Cells with a well-known surface are left whole, with any number of threads, and also in scenes with other
/// solids than half-spaces.
#[test]
fn adaptive_octrees_of_scenes_are_coarse() {
    let place = Place::new();
    let turn = "multmatrix([[0.36, 0.48, -0.8, 20], [-0.8, 0.6, 0, 40], [0.48, 0.64, 0.6, 3], [0, 0, 0, 1]])";
    let to = "multmatrix([[1, 0, 0, 10], [0, 1, 0, 10], [0, 0, 1, -1], [0, 0, 0, 1]])";
    let part = format!("difference() {{ cube([30, 20, 10]); {to} cylinder(h = 12, r = 4, $fn = 0); }}");
    place.write("part.csg", format!("{turn} {{ {part} }}"));
    let truth = 30.0 * 20.0 * 10.0 - std::f64::consts::PI * 16.0 * 10.0;
    let whole = place.run("csg part.csg -o whole.lfl --depth 8 --json").good().json();
    assert!(whole["adaptive"].is_null());
    let coarse = place.run("csg part.csg -o coarse.lfl --depth 8 --adaptive 0.05 --json").good().json();
    assert_eq!(coarse["adaptive"], 0.05);
    let count = |report: &Value, of: &str| report[of].as_u64().unwrap();
    assert!(count(&coarse, "nodes") * 20 < count(&whole, "nodes"), "{coarse} {whole}");
    assert!(count(&coarse, "splits") * 20 < count(&whole, "splits"));
    for report in [&whole, &coarse] {
        let (lower, upper) = volume(report);
        assert!(lower < truth && truth < upper, "{report}");
    }
    let info = place.run("info coarse.lfl --json").good().json();
    assert_eq!(info["metadata"]["adaptive"], "0.05");
    let bytes = place.bytes("coarse.lfl");
    place.run("csg part.csg -o coarse.lfl --depth 8 --adaptive 0.05 --threads 3").good();
    assert_eq!(place.bytes("coarse.lfl"), bytes);
    // Beside an octree, which has no layers.
    place.run_with("csg - -o small.lfl --depth 4 --bounds 0,0,0,64", b"cube([2, 1, 1]);").good();
    place.write("both.csg", format!("union() {{ {turn} {{ {part} }} octree(\"small.lfl\"); }}"));
    let line = "csg both.csg -o both.lfl --depth 4 --bounds 0,0,0,64 --adaptive 1 --json";
    assert!(place.run(line).good().json()["splits"].is_null());
}

/// A solid whose cells keep surfaces is queried, shown and meshed like its scene, and gives cells of any
/// level.
#[test]
fn octrees_that_keep_surfaces_are_taken_as_solids() {
    let place = Place::new();
    let to = "multmatrix([[1, 0, 0, 10], [0, 1, 0, 10], [0, 0, 1, -1], [0, 0, 0, 1]])";
    let part = format!("difference() {{ cube([30, 20, 10]); {to} cylinder(h = 12, r = 4, $fn = 0); }}");
    place.write("part.csg", &part);
    place.run("csg part.csg -o part.lfl --surfaces").good();
    let pi = std::f64::consts::PI;
    let (truth, area) = (6000.0 - pi * 160.0, 2.0 * (600.0 + 300.0 + 200.0) + 80.0 * pi - 32.0 * pi);
    let close = |found: f64, truth: f64, share: f64| (found - truth).abs() < share * truth;
    let number = |report: &Value, name: &str| report[name].as_f64().unwrap();
    // The surfaces by marching cubes and by dual contouring are closed, and near. Those of cells have steps.
    for (line, share) in [
        ("", 0.002),
        ("--method mc", 0.01),
        ("--method dual", 0.002),
        ("--method dual --depth 6", 0.01),
        ("--method mc --vertices midpoint", 0.02),
        ("--method shrink --depth 7", 0.1),
        ("--method mc --resolve outer --depth 8", 0.1),
        ("--method nets --resolve outer --depth 8", 0.1),
    ] {
        let run = place.run(&format!("mesh part.lfl -o part.stl --lossy {line} --json"));
        let report = if line.contains("shrink") { run.noted(&["has a volume"]) } else { run.good() }.json();
        assert!(close(number(&report, "volume"), truth, share), "{line}: {report}");
        assert_eq!(report["closed"], true, "{line}");
    }
    let measured = place.run("measure part.lfl --tolerance 1e-4 --json").good().json();
    let (least, most) = (&measured["area"]["lower"], &measured["area"]["upper"]);
    let (least, most) = (least.as_f64().unwrap(), most.as_f64().unwrap());
    assert!(least < area && area < most && most - least < 1e-2 * area, "{measured}");
    // Pictures cover as much as the scene's pictures.
    for view in ["", "--view slice", "--view volume", "--view hybrid", "--faces"] {
        let [own, source] = ["lfl", "csg"].map(|kind| {
            let line = format!("render part.{kind} -o part.png --size 160x120 --samples 1 {view} --json");
            number(&place.run(&line).good().json(), "covered")
        });
        assert!(source > 1000.0 && close(own, source, 0.02), "{view}: {own} {source}");
    }
    let dexels = place.run("dexelize part.lfl -o dexels.lfl --json").good().json();
    assert!(close(number(&dexels, "volume"), truth, 1e-3) && dexels["resolution"] == 256, "{dexels}");
    // Cells of the requested level.
    let plain = place.run("convert part.lfl -o plain.lfl --to octree --resolution 64 --json").good().json();
    assert_eq!((&plain["depth"], &plain["cuts"]), (&Value::from(6), &Value::Null));
    place.run("convert plain.lfl -o other.lfl --to octree").bad(1, &["is an octree already"]);
    let told = place.run("bitmap part.lfl -o part.nrrd --resolve inner");
    assert!(told.code == Some(0) && told.errors.contains("--level"), "{told:?}");
    place.run("bitmap part.lfl -o part.nrrd --resolve inner --level 5").good();
    place.run("voxels part.lfl -o part.csv").good();
    let answers = place.run_with("distance part.lfl", b"35 10 5\n10 10 5\n").good();
    let first: Vec<f64> = answers.text().split_whitespace().map(|word| word.parse().unwrap()).collect();
    assert!(first[0] <= 5.0 && first[1] >= 5.0 && first[1] - first[0] < 1e-3, "{first:?}");
    assert!(first[2] <= 4.0 && first[3] >= 4.0 && first[3] - first[2] < 1e-3, "{first:?}");
}

/// Undecided cells keep the surfaces that cross them. The file is small, and gives volume and points like the
/// scene.
#[test]
fn octrees_of_scenes_keep_their_surfaces() {
    let place = Place::new();
    let to = "multmatrix([[1, 0, 0, 10], [0, 1, 0, 10], [0, 0, 1, -1], [0, 0, 0, 1]])";
    let part = format!("difference() {{ cube([30, 20, 10]); {to} cylinder(h = 12, r = 4, $fn = 0); }}");
    place.write("part.csg", &part);
    let truth = 30.0 * 20.0 * 10.0 - std::f64::consts::PI * 16.0 * 10.0;
    let made = place.run("csg part.csg -o part.lfl --surfaces --json").good().json();
    assert_eq!((&made["surfaces"], &made["depth"]), (&Value::from(0.0), &Value::from(20)));
    let told = place.run("info part.lfl --json").good().json();
    for report in [&made, &told] {
        let (lower, upper) = volume(report);
        assert!(lower < truth && truth < upper && upper - lower < 1e-3 * truth, "{report}");
        let of_cells = |end: &str| report["volume_of_cells"][end].as_f64().unwrap();
        assert!(of_cells("lower") <= lower && upper <= of_cells("upper"));
        assert_eq!(report["cuts"]["given_up"], 0);
        assert_eq!(report["cuts"]["surfaces"]["quadrics"], 1);
    }
    assert!(place.bytes("part.lfl").len() < 6000);
    let run = place.run("info part.lfl").good();
    let text = run.text();
    assert!(
        text.contains("volume of cells") && text.contains("1 quadric") && text.contains("none given up"),
        "{text}"
    );
    place.run("verify part.lfl").good();
    // Points next to the bore and to a face.
    let points = b"14.000001 10 5\n13.999999 10 5\n29.999999 1 1\n30.000001 1 1\n";
    let answers = place.run_with("contains part.lfl", points).good();
    assert_eq!(answers.text(), "inside\noutside\ninside\noutside\n");
    // The same bytes with any number of threads, and with a chosen depth.
    let bytes = place.bytes("part.lfl");
    place.run("csg part.csg -o part.lfl --surfaces --threads 3").good();
    assert_eq!(place.bytes("part.lfl"), bytes);
    let coarse = place.run("csg part.csg -o coarse.lfl --surfaces --depth 6 --json").good().json();
    assert_eq!(coarse["depth"], 6);
    // A mesh. Axis-aligned planes are kept exactly: six, besides those of the scene's own block.
    place.write("cube.stl", stl(&block([-3.1; 3], [-1.2; 3])));
    place.write("both.csg", format!("union() {{ {part} import(file = \"cube.stl\"); }}"));
    let both = place.run("csg both.csg -o both.lfl --surfaces=1e-3 --json").good().json();
    assert_eq!(
        (&both["cuts"]["surfaces"]["planes"], &both["cuts"]["surfaces"]["slabs"]),
        (&12.into(), &0.into())
    );
    assert!(
        (both["surfaces"].as_f64().unwrap() - 0.0331).abs() < 1e-7 && both["depth"].as_u64().unwrap() < 14
    );
}

#[test]
fn open_meshes_are_taken_with_a_warning() {
    let place = Place::new();
    let cube = block([1.0; 3], [3.0; 3]);
    let mut facets: Vec<_> =
        cube.triangles().iter().map(|t| t.map(|v| cube.vertices()[v as usize])).collect();
    let [a, b, c] = facets.pop().unwrap();
    place.write("open.stl", stl(&TriangleMesh::from_facets(&facets).unwrap()));
    facets.push([a, c, b]);
    place.write("turned.stl", stl(&TriangleMesh::from_facets(&facets).unwrap()));
    for (name, words, boundary, misoriented) in [
        ("open.stl", &["warning", "open along 3 edges in 1 loop", "winding number"][..], 3, 0),
        ("turned.stl", &["warning", "orientation changes across 3 inner edges"], 0, 3),
    ] {
        for fill in ["", "--fill positive", "--fill non-zero"] {
            let run = place.run(&format!("voxelize {name} -o out.lfl --depth 4 {fill} --json"));
            assert_eq!(run.code, Some(0), "{run:?}");
            let start = format!("leafless: {name}: warning: ");
            assert!(run.errors.lines().all(|line| line.starts_with(&start)), "{run:?}");
            // The part enclosed in front of the hole may reach beyond the bounds.
            let clipped = run.json()["clipped"].as_bool().unwrap();
            assert_eq!(run.errors.contains("extend beyond the bounds"), clipped, "{run:?}");
            assert_eq!(run.errors.lines().count(), 1 + usize::from(clipped), "{run:?}");
            for word in words {
                assert!(run.errors.contains(word), "{word}: {run:?}");
            }
            let json = run.json();
            let (lower, upper) = volume(&json);
            let undecided = json["undecided_volume"].as_f64().unwrap();
            assert!((undecided - (upper - lower)).abs() < 1e-12, "{undecided} {lower} {upper}");
            assert_eq!(json["mesh"]["boundary_edges"], boundary);
            assert_eq!(json["mesh"]["misoriented_edges"], misoriented);
            // A twelfth of the surface is missing, and yet most of the cube is decided.
            assert!(lower > 2.0 && lower < 8.0 && (8.0..14.0).contains(&upper), "{lower} {upper}");
        }
        let info = place.run(&format!("info {name} --json")).good().json();
        assert_eq!((&info["closed"], &info["volume"]), (&false.into(), &Value::Null));
        let text = place.run(&format!("info {name}")).good();
        assert!(text.text().contains(words[1]) && text.text().contains("defect"), "{text:?}");
        // The missing or inverted triangle, on the upper side.
        let defects = info["mesh"]["defects"].as_array().unwrap();
        let kind = if boundary > 0 { "hole" } else { "misoriented" };
        assert_eq!(defects.len(), 1);
        assert_eq!((&defects[0]["kind"], &defects[0]["count"]), (&kind.into(), &3.into()));
        let (min, max) = (serde_json::json!([1.0, 1.0, 3.0]), serde_json::json!([3.0, 3.0, 3.0]));
        assert_eq!((&defects[0]["min"], &defects[0]["max"]), (&min, &max));
        let length = defects[0]["length"].as_f64().unwrap();
        assert!((length - (4.0 + 8.0_f64.sqrt())).abs() < 1e-12, "{length}");
    }
}

/// `part.3mf`: in inches, a tetrahedron of edge 1 and its mirror image, and a support.
fn package() -> Vec<u8> {
    let resources = zip::tetrahedron(1, "") + &zip::tetrahedron(2, "type=\"support\"");
    // Missing properties would cause a warning.
    let resources = resources.replace(" pid=\"1\" p1=\"0\"", "");
    let items = "<item objectid=\"1\"/><item objectid=\"2\"/>
        <item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 -1 0 0\"/>";
    zip::zip(&zip::package(zip::model("unit=\"inch\"", &resources, items)))
}

#[test]
fn packages_end_to_end() {
    let place = Place::new();
    place.write("part.3mf", package());
    let run = place.run("voxelize part.3mf -o part.lfl --depth 6 --to-unit mm").good();
    for words in ["8 triangles", "2 bodies", "1 object that is no solid left out"] {
        assert!(run.text().contains(words), "{run:?}");
    }
    let json = place.run("voxelize part.3mf -o part.lfl --depth 6 --to-unit mm --json").good().json();
    assert_eq!((&json["format"], &json["unit"], &json["skipped"]), (&"3mf".into(), &"mm".into(), &1.into()));
    assert_eq!(json["fill"], "positive");
    let (lower, upper) = volume(&json);
    let truth = 25.4_f64.powi(3) / 3.0;
    assert!(lower < truth && truth < upper && upper - lower < truth, "{lower} {truth} {upper}");
    let solid = place.run("info part.lfl --json").good().json();
    assert_eq!(solid["metadata"]["units"], "mm");
    assert!(place.run("info part.lfl").good().text().contains("unit"));
    // Without a name, by the content.
    place.run_with("voxelize - -o other.lfl --depth 6 --to-unit mm", &package()).good();
    assert_eq!(file::open(place.path("other.lfl")).unwrap(), file::open(place.path("part.lfl")).unwrap());
    place.run("voxelize part.3mf -o inch.lfl --depth 6").good();
    assert_eq!(place.run("info inch.lfl --json").good().json()["metadata"]["units"], "in");

    place.write("damaged.3mf", &package()[..400]);
    place.run("voxelize damaged.3mf -o out.lfl --depth 4").bad(1, &["damaged.3mf", "ZIP"]);
    let model = zip::model("", &zip::tetrahedron(1, "").replace("v1=\"1\"", "v1=\"9\""), "");
    place.write("wrong.3mf", zip::zip(&zip::package(model)));
    let words = ["wrong.3mf: 3D/3dmodel.model, line 17, byte ", "v1=\"9\" is no vertex"];
    place.run("voxelize wrong.3mf -o out.lfl --depth 4").bad(1, &words);
    assert!(!place.files().contains(&"out.lfl".to_owned()));
}

/// A mesh as OBJ, OFF and ASCII PLY.
fn texts(mesh: &TriangleMesh) -> [(&'static str, String); 3] {
    let lines = |start: &str| -> String {
        mesh.vertices().iter().map(|[x, y, z]| format!("{start}{x} {y} {z}\n")).collect()
    };
    let faces = |start: &str, first: u32| -> String {
        (mesh.triangles().iter().map(|t| t.map(|v| v + first)))
            .map(|[a, b, c]| format!("{start} {a} {b} {c}\n"))
            .collect()
    };
    let (v, t) = (mesh.vertices().len(), mesh.triangles().len());
    let properties = "property double x\nproperty double y\nproperty double z\n";
    [
        ("obj", format!("# a mesh\n{}{}", lines("v "), faces("f", 1))),
        ("off", format!("OFF\n{v} {t} 0\n{}{}", lines(""), faces("3", 0))),
        (
            "ply",
            format!(
                "ply\nformat ascii 1.0\nelement vertex {v}\n{properties}element face {t}\n\
                 property list uchar int vertex_indices\nend_header\n{}{}",
                lines(""),
                faces("3", 0)
            ),
        ),
    ]
}

#[test]
fn all_formats_give_the_same_solid() {
    let place = meshes();
    place.run("voxelize cube.stl -o stl.lfl --depth 5").good();
    let expected = file::open(place.path("stl.lfl")).unwrap();
    for (format, text) in texts(&block([1.0; 3], [3.0; 3])) {
        place.write(&format!("cube.{format}"), &text);
        // By name, by content, and by the user's option.
        place.write("nameless", &text);
        for line in [format!("cube.{format}"), "nameless".into(), format!("nameless --format {format}")] {
            let json = place.run(&format!("voxelize {line} -o out.lfl --depth 5 --json")).good().json();
            assert_eq!(json["format"], format);
            assert_eq!(file::open(place.path("out.lfl")).unwrap(), expected);
        }
        place.run_with("voxelize - -o out.lfl --depth 5", text.as_bytes()).good();
        assert_eq!(file::open(place.path("out.lfl")).unwrap(), expected);
        let info = place.run(&format!("info cube.{format} --json")).good().json();
        assert_eq!((&info["format"], info["volume"].as_f64()), (&format.into(), Some(8.0)));
        place.write("cut", &text[..text.len() / 2]);
        place.run(&format!("voxelize cut -o out.lfl --depth 5 --format {format}")).bad(1, &["cut: "]);
    }
}

#[test]
fn units_and_scale() {
    let place = meshes();
    let run = |options: &str| {
        let line = format!("voxelize cube.stl -o out.lfl --depth 3 --json {options}");
        let json = place.run(&line).good().json();
        let metadata = json["metadata"].get("units").cloned();
        (json["edge"].as_f64().unwrap(), json["unit"].clone(), metadata)
    };
    // The edge of the frame is the power of two that contains the cube's edge, 2.
    assert_eq!(run(""), (2.0, Value::Null, None));
    assert_eq!(run("--unit cm"), (2.0, "cm".into(), Some("cm".into())));
    assert_eq!(run("--unit cm --to-unit Millimetres"), (32.0, "mm".into(), Some("mm".into())));
    assert_eq!(run("--scale 4"), (8.0, Value::Null, None));
    assert_eq!(run("--unit mm --to-unit cm --scale 10"), (2.0, "cm".into(), Some("cm".into())));
    let info = place.run("info cube.stl --unit in --to-unit mm --json").good().json();
    assert_eq!(info["max"], serde_json::json!([76.2, 76.2, 76.2]));
}

#[test]
fn info_of_meshes() {
    let place = meshes();
    let info = place.run("info cube.stl --json").good().json();
    let expected = [
        "all_intersecting_pairs",
        "bytes",
        "closed",
        "deviation",
        "format",
        "intersecting_pairs",
        "max",
        "mesh",
        "min",
        "rule",
        "skipped",
        "told_deviation",
        "unit",
        "volume",
        "volume_by_rule",
        "warnings",
    ];
    assert_eq!(keys(&info), expected);
    assert_eq!((&info["volume_by_rule"], &info["warnings"]), (&Value::Null, &Value::Array(vec![])));
    assert_eq!((&info["intersecting_pairs"], &info["all_intersecting_pairs"]), (&0.into(), &true.into()));
    assert_eq!(
        (&info["format"], &info["unit"], &info["closed"]),
        (&"stl".into(), &Value::Null, &true.into())
    );
    assert_eq!((info["volume"].as_f64(), &info["bytes"]), (Some(8.0), &place.bytes("cube.stl").len().into()));
    assert_eq!((&info["mesh"]["triangles"], &info["mesh"]["bodies"]), (&12.into(), &1.into()));
    let voxelized = place.run("voxelize cube.stl -o out.lfl --depth 3 --json").good().json();
    assert_eq!(info["mesh"], voxelized["mesh"]);
    let text = place.run("info cube.stl").good();
    for words in ["STL", "unknown", "1 to 3", "yes", "8", "12"] {
        assert!(text.text().contains(words), "{words}: {text:?}");
    }
    let piped = place.run_with("info -", &place.bytes("cube.stl")).good();
    assert_eq!(piped.text(), text.text());
    place.write("package", package());
    assert!(place.run("info package").good().text().contains("3MF"));
    place.write("text.obj", "v 1 2\n");
    place.run("info text.obj").bad(1, &["text.obj: "]);
    place.write("notes.txt", "a text that is neither of both\n");
    place.run("info notes.txt").bad(1, &["notes.txt: ", "solid (.lfl)", "mesh (STL", "scene (.csg)"]);
}

/// A cube, and a sixth of another cube in its corner, which counts twice.
#[test]
fn info_of_bodies_that_overlap() {
    let place = Place::new();
    let cube = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n\
        f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    let sixth = "v 0 0 0\nv .9 0 0\nv 0 .9 0\nv 0 0 .9\nf 9 11 10\nf 9 10 12\nf 10 11 12\nf 11 9 12\n";
    place.write("cube.obj", cube);
    place.write("both.obj", format!("{cube}{sixth}"));
    let info = place.run("info both.obj --json").good().json();
    let sum = 1.0 + 0.9f64.powi(3) / 6.0;
    assert!((info["volume"].as_f64().unwrap() - sum).abs() < 1e-12, "{info}");
    let by_rule = &info["volume_by_rule"];
    let [lower, upper] = ["lower", "upper"].map(|end| by_rule[end].as_f64().unwrap());
    assert!((0.99..=1.0).contains(&lower) && (1.0..1.01).contains(&upper), "{info}");
    let mesh = &info["mesh"];
    assert_eq!((&mesh["overlapping_bodies"], &mesh["undecided_bodies"]), (&2.into(), &0.into()));
    assert_eq!(
        (&mesh["polygons"], &mesh["bent_polygons"], &info["rule"]),
        (&6.into(), &0.into(), &"nonzero".into())
    );
    let text = place.run("info both.obj").good().text().to_owned();
    for words in [
        "1.1215",
        "the sum of signed volumes",
        "by the rule (nonzero)",
        "overlapping     2",
        "polygons        6",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let text = place.run("info cube.obj").good().text().to_owned();
    assert!(!text.contains("by the rule") && !text.contains("not flat"), "{text}");
    // A face that is not flat. One of two triangulations is chosen.
    place.write("bent.obj", cube.replacen("v 1 1 1", "v 1 1 1.25", 1));
    let info = place.run("info bent.obj --json").good().json();
    assert_eq!((&info["mesh"]["polygons"], &info["mesh"]["bent_polygons"]), (&6.into(), &1.into()));
    assert!((info["mesh"]["polygon_deviation"].as_f64().unwrap() - 0.0625).abs() < 0.002, "{info}");
    let text = place.run("info bent.obj").good().text().to_owned();
    for words in ["not flat        1 of them, with corners up to 0.06", "one of their triangulations"] {
        assert!(text.contains(words), "{words}: {text}");
    }
}

/// Files that depart from their format are read, with a warning on standard error and in JSON.
#[test]
fn warnings_about_files() {
    let place = Place::new();
    let head = "ply\nformat ascii 1.0\nwritten by hand\nelement vertex 4\nproperty float x\nproperty float y\n\
        property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
    let data = "0 0 0 9\n1 0 0 9\n0 1 0 9\n0 0 1 9\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    place.write("strange.ply", format!("{head}{data}"));
    let run = place.run("info strange.ply --json");
    assert_eq!(run.code, Some(0));
    let warnings = run.json()["warnings"].clone();
    assert_eq!(warnings.as_array().map(Vec::len), Some(2), "{warnings}");
    for (warning, words) in
        warnings.as_array().unwrap().iter().zip(["line 3 of the header", "line 11 (like 3 more)"])
    {
        let warning = warning.as_str().unwrap();
        assert!(warning.starts_with(words), "{warning}");
        let line = format!("strange.ply: warning: {warning}");
        assert!(run.errors.contains(&line), "{line}: {run:?}");
        for command in ["measure strange.ply", "voxelize strange.ply -o out.lfl --depth 3"] {
            let run = place.run(command);
            assert!(run.code == Some(0) && run.errors.contains(&line), "{run:?}");
        }
    }
    let voxelized = place.run("voxelize strange.ply -o out.lfl --depth 3 --json").json();
    assert_eq!(voxelized["warnings"], warnings);
    let utf16: Vec<u8> = format!("\u{FEFF}{head}{data}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    place.write("wide.ply", utf16);
    place.run("info wide.ply").bad(1, &["wide.ply: ", "UTF-16"]);
}

#[test]
fn hair_cracks_are_sewn_and_reported() {
    let place = Place::new();
    let cube = block([1.0; 3], [3.0; 3]);
    let mut text = String::from("solid cracked\n");
    for (index, triangle) in cube.triangles().iter().enumerate() {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for &v in triangle {
            let [x, y, z] = cube.vertices()[v as usize];
            let x = if index == 0 { x + 1e-9 } else { x };
            text.push_str(&format!("vertex {x} {y} {z}\n"));
        }
        text.push_str("endloop\nendfacet\n");
    }
    text.push_str("endsolid\n");
    place.write("cracked.stl", text);
    let json = place.run("voxelize cracked.stl -o out.lfl --depth 5 --json").good().json();
    let displacement = json["mesh"]["displacement"].as_f64().unwrap();
    assert_eq!(json["mesh"]["sewn"], 3);
    assert!((0.9e-9..1.1e-9).contains(&displacement), "{displacement}");
    assert!(
        place.run("voxelize cracked.stl -o out.lfl --depth 5").good().text().contains("3 vertices moved")
    );
}

#[test]
fn outputs_that_are_refused() {
    let place = solids();
    let before = place.files();
    let cube = place.bytes("cube.stl");
    for (output, words) in [
        ("nowhere/out.lfl", &["nowhere/out.lfl", "no folder nowhere"][..]),
        ("cube.stl/out.lfl", &["cube.stl/out.lfl", "no folder cube.stl"]),
        (".", &["leafless: .: ", "folder"]),
    ] {
        place.run(&format!("voxelize cube.stl -o {output} --depth 4")).bad(1, words);
        place.run(&format!("union cube.lfl slab.lfl -o {output}")).bad(1, words);
        place.run(&format!("complement cube.lfl -o {output}")).bad(1, words);
    }
    place.run("voxelize cube.stl -o cube.stl --depth 4").bad(1, &["cube.stl", "not overwritten"]);
    place.run("voxelize cube.stl -o ./cube.stl --depth 4").bad(1, &["cube.stl", "not overwritten"]);
    assert_eq!((place.files(), place.bytes("cube.stl")), (before, cube));
}

#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_written_leaves_the_old_file() {
    use std::os::unix::fs::PermissionsExt;
    let place = solids();
    place.run("voxelize cube.stl -o /dev/full --depth 5").bad(1, &["/dev/full", "No space left"]);
    place.run("voxelize cube.stl -o /proc/version --depth 5").bad(1, &["/proc/version"]);

    // The shell's limit on the size of files makes writing fail half-way.
    let old = place.bytes("slab.lfl");
    let script = format!(
        "ulimit -f 1; exec '{}' voxelize cube.stl -o slab.lfl --depth 9",
        env!("CARGO_BIN_EXE_leafless")
    );
    let output = Command::new("sh").args(["-c", &script]).current_dir(place.0.path()).output().unwrap();
    Run::new(&script, output).bad(1, &["slab.lfl", "File too large"]);
    assert_eq!(place.bytes("slab.lfl"), old);

    let folder = place.path("locked");
    std::fs::create_dir(&folder).unwrap();
    std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(0o555)).unwrap();
    // The superuser may write everywhere.
    if std::fs::write(folder.join("probe"), "").is_err() {
        place.run("voxelize cube.stl -o locked/out.lfl --depth 4").bad(1, &["locked/out.lfl", "denied"]);
    }
    std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(0o755)).unwrap();
    assert_eq!(place.files(), ["cube.lfl", "cube.stl", "locked", "slab.lfl", "slab.stl"]);
}

#[test]
fn standard_input_and_output() {
    let place = meshes();
    place.run("voxelize cube.stl -o cube.lfl --depth 5 --bounds 0,0,0,8").good();
    place.run("voxelize slab.stl -o slab.lfl --depth 5 --bounds 0,0,0,8").good();
    let (cube, slab) = (place.bytes("cube.lfl"), place.bytes("slab.lfl"));

    let run = place.run("voxelize cube.stl -o - --depth 5 --bounds 0,0,0,8");
    assert_eq!((run.code, &run.bytes), (Some(0), &cube));
    assert!(run.errors.contains("12 triangles"), "{run:?}");
    let run = place.run("voxelize cube.stl -o - --depth 5 --bounds 0,0,0,8 --json");
    assert_eq!((run.code, &run.bytes), (Some(0), &cube));
    let json: Value = serde_json::from_str(&run.errors).unwrap();
    assert_eq!((&json["output"], &json["bytes"]), (&"standard output".into(), &cube.len().into()));

    // Standard input has no name to record.
    place.run_with("voxelize - -o from-pipe.lfl --depth 5 --bounds 0,0,0,8", &place.bytes("cube.stl")).good();
    let info = place.run("info from-pipe.lfl --json").good().json();
    assert_eq!(keys(&info["metadata"]), ["rule", "source"]);
    assert_eq!(file::open(place.path("from-pipe.lfl")).unwrap(), file::open(place.path("cube.lfl")).unwrap());

    let from_file = place.run("info cube.lfl --json").good();
    assert_eq!(place.run_with("info - --json", &cube).good().text(), from_file.text());
    let verified = place.run_with("verify -", &cube).good();
    assert!(verified.text().starts_with("standard input: good"), "{verified:?}");
    place.run("difference cube.lfl slab.lfl -o expected.lfl").good();
    let run = place.run_with("difference cube.lfl - -o -", &slab);
    assert_eq!((run.code, run.bytes), (Some(0), place.bytes("expected.lfl")));
    assert!(run.errors.starts_with("standard output: difference of 2 solids"), "{}", run.errors);
    let run = place.run_with("complement - -o -", &cube);
    assert_eq!(
        (run.code, file::from_bytes(&run.bytes).unwrap().contains([0.5; 3])),
        (Some(0), Membership::Inside)
    );
}

#[cfg(unix)]
#[test]
fn names_that_need_care() {
    use std::os::unix::ffi::OsStrExt;
    let place = meshes();
    for name in [&b"with blank.stl"[..], b"\xff\xfe.stl", b"-dash.stl", "Flansch Ø 120.stl".as_bytes()] {
        let name = OsStr::from_bytes(name);
        std::fs::copy(place.path("cube.stl"), place.0.path().join(name)).unwrap();
        let arguments = ["voxelize", "--depth", "4", "-o", "out.lfl", "--"].map(OsStr::new);
        let run = place.command(arguments.into_iter().chain([name])).output().unwrap();
        assert!(run.status.success(), "{run:?}");
        place.run("verify out.lfl").good();
    }
    assert_eq!(file::open(place.path("out.lfl")).unwrap().metadata().get("name"), Some("Flansch Ø 120"));
    let output = place.command(["verify", "line\nend \x1b[31m.lfl"]).output().unwrap();
    Run::new("verify", output).bad(1, &["line\\nend \\u{1b}[31m.lfl: "]);
    // A path from another folder.
    let run = Command::new(env!("CARGO_BIN_EXE_leafless")).arg("info").arg(place.path("out.lfl")).output();
    assert!(run.unwrap().status.success());
}

#[test]
fn info_has_the_promised_keys() {
    let place = solids();
    let info = place.run("info slab.lfl --json").good().json();
    assert_eq!(
        keys(&info),
        [
            "binary",
            "bytes",
            "bytes_per_node",
            "cells",
            "classical_nodes",
            "clipped",
            "depth",
            "edge",
            "levels",
            "metadata",
            "nodes",
            "origin",
            "proof",
            "volume",
        ]
    );
    assert_eq!(keys(&info["cells"]), ["branch", "empty", "full", "partial"]);
    assert_eq!(keys(&info["volume"]), ["lower", "upper"]);
    let nodes = info["nodes"].as_u64().unwrap();
    assert_eq!(info["classical_nodes"], 8 * nodes + 1);
    let cells: u64 = info["cells"].as_object().unwrap().values().map(|n| n.as_u64().unwrap()).sum();
    assert_eq!(cells, 8 * nodes + 1);
    let bytes = place.bytes("slab.lfl").len();
    assert_eq!((&info["depth"], &info["bytes"], &info["edge"]), (&5.into(), &bytes.into(), &8.0.into()));
    assert_eq!(info["origin"], serde_json::json!([0.0, 0.0, 0.0]));
    assert_eq!(info["bytes_per_node"].as_f64(), Some(bytes as f64 / nodes as f64));
    let levels = info["levels"].as_array().unwrap();
    assert_eq!(levels.len(), 6);
    let mut last = (0.0, 512.0);
    for (level, value) in levels.iter().enumerate() {
        assert_eq!(keys(value), ["level", "lower", "nodes", "upper"]);
        assert_eq!(value["level"], level);
        let now = (value["lower"].as_f64().unwrap(), value["upper"].as_f64().unwrap());
        assert!(last.0 <= now.0 && now.0 <= 32.0 && 32.0 <= now.1 && now.1 <= last.1, "{now:?}");
        last = now;
    }
    assert_eq!(last, volume(&info));
    assert_eq!(levels.iter().map(|level| level["nodes"].as_u64().unwrap()).sum::<u64>(), nodes);

    let text = place.run("info slab.lfl").good();
    for words in ["depth", "volume", "classical nodes", "a node", "level"] {
        assert!(text.text().contains(words), "{text:?}");
    }
    // A universe of one tag has no node.
    assert_eq!(place.run("voxelize cube.stl -o whole.lfl --depth 3 --bounds 1.5,1.5,1.5,1").code, Some(0));
    let whole = place.run("info whole.lfl --json").good().json();
    assert_eq!((&whole["nodes"], &whole["bytes_per_node"]), (&0.into(), &Value::Null));
    assert_eq!((&whole["classical_nodes"], volume(&whole)), (&1.into(), (1.0, 1.0)));
    assert!(place.run("info whole.lfl").good().text().contains("- a node"));
}

#[test]
fn what_cells_do_not_prove_is_not_said() {
    let place = solids();
    assert_eq!(place.run("voxelize cube.stl -o sampled.lfl --depth 4 --rule sampled").code, Some(0));
    std::fs::write(place.path("scene.csg"), "octree(\"sampled.lfl\");").unwrap();
    assert_eq!(place.run("csg scene.csg -o copy.lfl --depth 5").code, Some(0));
    for name in ["sampled.lfl", "copy.lfl"] {
        let info = place.run(&format!("info {name} --json")).good().json();
        assert_eq!(info["proof"], serde_json::json!({ "full": false, "empty": false, "displacement": 0.0 }));
        // A sampled solid lies in the universe; nothing more is known.
        let told = place.run(&format!("measure {name} --json")).good().json();
        let edge = told["edge"].as_f64().unwrap();
        assert_eq!(volume(&told), (0.0, edge * edge * edge));
        assert!(place.run(&format!("measure {name}")).good().text().contains("nothing: cells are called"));
        // The cells themselves are known exactly.
        let told = place.run(&format!("measure {name} --cells --json")).good().json();
        assert!(volume(&told).0 > 0.0 && told["proof"]["full"] == true);
        let found = place.run(&format!("interfere {name} {name} --json")).good().json();
        assert_eq!((&found["verdict"], &found["proof_a"]["full"]), (&"undecided".into(), &false.into()));
        let found = place.run(&format!("interfere {name} {name} --cells --json")).good().json();
        assert_eq!(found["verdict"], "overlapping");
    }
}

#[test]
fn measure_tells_what_is_proven() {
    let place = solids();
    let told = place.run("measure cube.lfl --json").good().json();
    let expected = [
        "area",
        "area_displacement",
        "area_measured",
        "area_splits",
        "centroid",
        "clipped",
        "curves",
        "depth",
        "edge",
        "evaluations",
        "exact",
        "inertia",
        "inertia_about_origin",
        "inexact_reason",
        "input",
        "level",
        "mass",
        "mass_unit",
        "max",
        "measured",
        "min",
        "origin",
        "proof",
        "splits",
        "volume",
    ];
    assert_eq!(keys(&told), expected);
    let ends = |value: &Value| {
        assert_eq!(keys(value), ["lower", "upper"]);
        [value["lower"].clone(), value["upper"].clone()]
    };
    assert_eq!(volume(&told), (8.0, 8.0));
    // All cells are decided, so that the faces between them are the surface.
    for end in ends(&told["area"]) {
        assert!((end.as_f64().unwrap() - 24.0).abs() < 1e-11, "{told}");
    }
    assert_eq!(
        ends(&told["centroid"]),
        [serde_json::json!([2.0, 2.0, 2.0]), serde_json::json!([2.0, 2.0, 2.0])]
    );
    assert_eq!(ends(&told["min"])[1], serde_json::json!([1.0, 1.0, 1.0]));
    assert_eq!(ends(&told["max"])[0], serde_json::json!([3.0, 3.0, 3.0]));
    for end in ends(&told["inertia"]) {
        for (i, row) in end.as_array().unwrap().iter().enumerate() {
            for (j, value) in row.as_array().unwrap().iter().enumerate() {
                let exact = if i == j { 16.0 / 3.0 } else { 0.0 };
                assert!((value.as_f64().unwrap() - exact).abs() < 1e-14, "{told}");
            }
        }
    }
    // 8 · (2² + 2²) more than about the centroid, and −8 · 2 · 2.
    let [lower, upper] = ends(&told["inertia_about_origin"]);
    assert!(lower[0][0].as_f64() <= Some(208.0 / 3.0) && upper[0][0].as_f64() >= Some(208.0 / 3.0));
    assert_eq!((&lower[0][1], &upper[1][0]), (&(-32.0).into(), &(-32.0).into()));
    assert_eq!((&told["measured"], &told["clipped"]), (&"tolerance".into(), &false.into()));
    let text = place.run("measure cube.lfl").good();
    for line in ["volume          8\n", "centroid z      2\n", "about origin xy -32\n"] {
        assert!(text.text().contains(line), "{text:?}");
    }

    // A closed mesh is measured exactly.
    assert_eq!((&told["exact"], &told["inexact_reason"]), (&Value::Null, &Value::Null));
    let known = place.run("measure cube.stl --json").good().json();
    let (lower, upper) = volume(&known);
    assert!(lower <= 8.0 && 8.0 <= upper && upper - lower < 1e-12, "{known}");
    assert_eq!(
        (&known["exact"], &known["splits"], &known["inexact_reason"]),
        (&true.into(), &0.into(), &Value::Null)
    );
    assert!(place.run("measure cube.stl").good().text().contains("exact           yes"));
    let clipped = place.run("measure cube.stl --bounds 2,2,2,2 --json").good().json();
    assert_eq!((&clipped["exact"], &clipped["clipped"]), (&false.into(), &true.into()));

    // A mesh whose triangles intersect (here each occurs twice) is measured to the tolerance, and no better.
    let cube = place.bytes("cube.stl");
    let (head, facets) = cube.split_at(84);
    let count = 2 * u32::from_le_bytes(head[80..].try_into().unwrap());
    place.write("double.stl", [&head[..80], &count.to_le_bytes(), facets, facets].concat());
    let told = place.run("info double.stl --json").good().json();
    assert!(told["intersecting_pairs"].as_u64() >= Some(12), "{told}");
    assert!(place.run("info double.stl").good().text().contains("\nintersecting "));
    let rough = place.run("measure double.stl --bounds 0.9,0.9,0.9,2.2 --tolerance 0.2 --json").good().json();
    let (lower, upper) = volume(&rough);
    assert!(lower < 8.0 && 8.0 < upper && upper - lower < 0.2 * upper && upper - lower > 0.02);
    assert_eq!(rough["exact"], Value::Bool(false));
    assert!(rough["inexact_reason"].as_str().unwrap().contains("intersect"), "{rough}");
    assert_eq!((&rough["depth"], &rough["measured"]), (&20.into(), &"tolerance".into()));
    let few = place.run("measure double.stl --bounds 0.9,0.9,0.9,2.2 --splits 100 --json").good().json();
    assert!((1..=100).contains(&few["splits"].as_u64().unwrap()), "{few}");
    assert_eq!(few["measured"], "budget");
    assert!(
        place
            .run("measure double.stl --bounds 0.9,0.9,0.9,2.2 --splits 100")
            .good()
            .text()
            .contains("which were all that may be split")
    );
    let shallow =
        place.run("measure double.stl --bounds 0.9,0.9,0.9,2.2 --depth 3 --tolerance 0 --json").good().json();
    assert_eq!((&shallow["level"], &shallow["measured"]), (&3.into(), &"exhausted".into()));
    let one =
        place.run("measure double.stl --bounds 0.9,0.9,0.9,2.2 --tolerance 0.1 --threads 1 --json").good();
    let two =
        place.run("measure double.stl --bounds 0.9,0.9,0.9,2.2 --tolerance 0.1 --threads 2 --json").good();
    assert_eq!(one.text(), two.text());

    // A scene is measured to the tolerance.
    place.write("ball.csg", "sphere(2);");
    let truth = 32.0 / 3.0 * std::f64::consts::PI;
    let mut last = f64::INFINITY;
    for tolerance in [0.2, 1e-2, 1e-4] {
        let found = place.run(&format!("measure ball.csg --tolerance {tolerance} --json")).good().json();
        let (lower, upper) = volume(&found);
        assert!(lower < truth && truth < upper && upper - lower < tolerance * upper, "{found}");
        assert!(upper - lower < last && upper - lower > 1e-3 * tolerance, "{found}");
        last = upper - lower;
        assert_eq!((&found["depth"], &found["measured"]), (&20.into(), &"tolerance".into()));
    }
    let rough = place.run("measure ball.csg --tolerance 0 --absolute 2 --json").good().json();
    let (lower, upper) = volume(&rough);
    assert!(upper - lower <= 2.0 && rough["measured"] == "tolerance", "{rough}");
    let few = place.run("measure ball.csg --splits 100 --json").good().json();
    assert!(few["splits"].as_u64().unwrap() <= 100 && few["measured"] == "budget", "{few}");
    let shallow = place.run("measure ball.csg --depth 3 --tolerance 0 --json").good().json();
    assert_eq!((&shallow["level"], &shallow["measured"]), (&3.into(), &"exhausted".into()));
    let one = place.run("measure ball.csg --tolerance 1e-3 --threads 1 --json").good();
    let two = place.run("measure ball.csg --tolerance 1e-3 --threads 2 --json").good();
    assert_eq!(one.text(), two.text());

    // A file is only as good as its construction, and reports this.
    place.run("voxelize cube.stl -o rough.lfl --depth 4 --bounds 0.9,0.9,0.9,2.2").good();
    let text = place.run("measure rough.lfl --tolerance 0.001").good();
    assert!(text.text().contains("and the file knows no more"), "{text:?}");
    let told = place.run("measure rough.lfl --tolerance 0 --json").good().json();
    let info = place.run("info rough.lfl --json").good().json();
    assert_eq!((volume(&told), &told["measured"]), (volume(&info), &"exhausted".into()));
    let clipped = place.run("voxelize cube.stl -o clipped.lfl --depth 4 --bounds 2,2,2,2");
    assert_eq!(clipped.code, Some(0));
    assert!(place.run("measure clipped.lfl").good().text().contains("clipped"));
    place.run("complement cube.lfl -o outside.lfl").good();
    assert!(place.run("measure outside.lfl").good().text().contains("clipped"));
    place.run("measure missing.stl").bad(1, &["missing.stl"]);
    place.write("damaged.lfl", &place.bytes("cube.lfl")[..500]);
    place.run("measure damaged.lfl").bad(1, &["damaged.lfl"]);
}

#[test]
fn verify_tells_good_from_bad() {
    let place = solids();
    let good = place.run("verify cube.lfl").good();
    assert!(good.text().starts_with("cube.lfl: good"), "{good:?}");
    assert_eq!(good.text().lines().count(), 1);
    let bytes = place.bytes("cube.lfl");
    // One bit of every 7th byte, and of the last bytes.
    for at in (0..bytes.len()).step_by(7).chain(bytes.len() - 3..bytes.len()) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 1 << (at % 8);
        place.write("damaged.lfl", &damaged);
        place.run("verify damaged.lfl").bad(1, &["damaged.lfl: "]);
        place.run_with("verify -", &damaged).bad(1, &["standard input: "]);
    }
    for (name, bytes) in
        [("empty.lfl", &b""[..]), ("short.lfl", &bytes[..100]), ("mesh.lfl", &place.bytes("cube.stl"))]
    {
        place.write(name, bytes);
        for line in ["verify", "info", "contains", "complement -o out.lfl"] {
            place.run(&format!("{line} {name}")).bad(1, &[&format!("leafless: {name}: ")]);
        }
    }
    for line in ["verify", "info", "contains", "complement -o out.lfl"] {
        place.run(&format!("{line} missing.lfl")).bad(1, &["missing.lfl", "No such file"]);
        place.run(&format!("{line} .")).bad(1, &["leafless: .: "]);
    }
    assert!(!place.files().contains(&"out.lfl".to_owned()));
}

#[test]
fn booleans_are_those_of_the_library() {
    let place = solids();
    // Volumes: cube 8, slab 32, in common 1. The faces lie on the lattice, but certified cells touch them.
    for (line, truth) in [
        ("union cube.lfl slab.lfl", 39.0),
        ("intersection cube.lfl slab.lfl", 1.0),
        ("difference cube.lfl slab.lfl", 7.0),
        ("difference slab.lfl cube.lfl", 31.0),
        ("xor cube.lfl slab.lfl", 38.0),
        ("union cube.lfl slab.lfl cube.lfl", 39.0),
        ("intersection cube.lfl slab.lfl slab.lfl", 1.0),
        ("difference slab.lfl cube.lfl cube.lfl", 31.0),
        ("xor cube.lfl slab.lfl slab.lfl", 8.0),
        ("complement cube.lfl", 504.0),
    ] {
        let run = place.run(&format!("{line} -o out.lfl")).good();
        assert!(run.text().starts_with("out.lfl: ") && run.text().lines().count() == 1, "{run:?}");
        place.run("verify out.lfl").good();
        let info = place.run("info out.lfl --json").good().json();
        let (lower, upper) = volume(&info);
        assert!(lower <= truth && truth <= upper, "{line}: {lower} {upper}");
        let name = line.starts_with("complement").then_some("cube");
        assert_eq!(
            (info["metadata"]["name"].as_str(), &info["metadata"]["rule"]),
            (name, &"certified".into())
        );
    }
    let [cube, slab] = ["cube.lfl", "slab.lfl"].map(|name| file::open(place.path(name)).unwrap());
    let control = leafless::Control::default();
    place.run("difference cube.lfl slab.lfl -o out.lfl").good();
    let mut rule = leafless::Metadata::new();
    rule.insert("rule", "certified");
    let expected = leafless::difference(cube.view(), slab.view(), &control).unwrap().with_metadata(rule);
    assert_eq!(place.bytes("out.lfl"), file::to_bytes(&expected).unwrap());
    // If the operands have different rules, the result says so.
    place.run("voxelize slab.stl -o sampled.lfl --depth 5 --bounds 0,0,0,8 --rule sampled").good();
    place.run("union cube.lfl sampled.lfl -o sampled.lfl").good();
    let info = place.run("info sampled.lfl --json").good().json();
    assert_eq!(info["metadata"], serde_json::json!({ "rule": "mixed" }));
    // Twice the complement is the solid, also in bytes but for the metadata; the result may replace the
    // operand.
    place.run("complement cube.lfl -o back.lfl").good();
    place.run("complement back.lfl -o back.lfl").good();
    assert_eq!(file::open(place.path("back.lfl")).unwrap(), cube);
    place.run("difference cube.lfl slab.lfl -o cube.lfl").good();
    assert_eq!(place.bytes("cube.lfl"), place.bytes("out.lfl"));
    assert_eq!(
        place.files(),
        ["back.lfl", "cube.lfl", "cube.stl", "out.lfl", "sampled.lfl", "slab.lfl", "slab.stl"]
    );
}

/// A plate, a bore and a pin of the bore's radius, whose cells keep surfaces. Results are equally sharp.
#[test]
fn set_operations_keep_surfaces() {
    let place = Place::new();
    let moved = |x: f64, z: f64, body: &str| {
        format!("multmatrix([[1,0,0,{x}],[0,1,0,10],[0,0,1,{z}],[0,0,0,1]]) {body}\n")
    };
    place.write("plate.csg", "cube([30, 20, 10]);");
    place.write("bore.csg", moved(10.0, -1.0, "cylinder(h = 12, r = 4, $fn = 0);"));
    place.write("slot.csg", moved(20.0, 5.0, "cube([4, 4, 6]);"));
    place.write("pin.csg", moved(10.0, -5.0, "cylinder(h = 20, r = 4, $fn = 0);"));
    for name in ["plate", "bore", "slot", "pin"] {
        place.run(&format!("csg {name}.csg -o {name}.lfl --surfaces --bounds -1,-6,-11,32")).good();
    }
    let made = place.run("difference plate.lfl bore.lfl slot.lfl -o part.lfl").good();
    assert!(made.text().contains("surfaces in") && made.text().lines().count() == 1, "{made:?}");
    place.run("verify part.lfl").good();
    let truth = 6000.0 - 160.0 * std::f64::consts::PI - 80.0;
    let measured = place.run("measure part.lfl --tolerance 1e-6 --json").good().json();
    let (lower, upper) = volume(&measured);
    assert!(lower <= truth && truth <= upper && upper - lower < 1.01e-6 * truth, "{lower} {upper}");
    // One operation after the other gives the same solid, and the refilled bore gives the plate.
    place.run("difference plate.lfl bore.lfl -o one.lfl").good();
    place.run("difference one.lfl slot.lfl -o one.lfl").good();
    let told = place.run("xor one.lfl part.lfl -o none.lfl").good();
    assert!(told.text().contains("volume 0, 0 nodes"), "{told:?}");
    place.run("union part.lfl bore.lfl slot.lfl -o filled.lfl").good();
    place.run("intersection filled.lfl plate.lfl -o filled.lfl").good();
    let [own, other] = ["filled.lfl", "plate.lfl"].map(|name| file::open(place.path(name)).unwrap());
    assert_eq!(own, other);
    place.run("complement part.lfl -o other.lfl").good();
    place.run("complement other.lfl -o other.lfl").good();
    let [own, other] = ["part.lfl", "other.lfl"].map(|name| file::open(place.path(name)).unwrap());
    assert!(own == other && own.view().cuts().unwrap().given_up == 0);
    // The pin touches the bore all around, and shares no volume with the part. For the scenes this is proven
    // likewise.
    let told = place.run("intersection part.lfl pin.lfl -o common.lfl").good();
    assert!(told.text().contains("volume 0, 0 nodes"), "{told:?}");
    let bored = moved(10.0, -1.0, "cylinder(h = 12, r = 4, $fn = 0);");
    place.write("bored.csg", format!("difference() {{ cube([30, 20, 10]); {bored} }}"));
    for line in ["part.lfl pin.lfl", "pin.lfl part.lfl", "bored.csg pin.csg"] {
        let found = place.run(&format!("interfere {line} --json")).good().json();
        let overlap = (&found["overlap"]["lower"], &found["overlap"]["upper"]);
        assert_eq!((&found["verdict"], overlap), (&"disjoint".into(), (&0.0.into(), &0.0.into())), "{line}");
    }
    // Together the two have no gap.
    place.run("union one.lfl pin.lfl -o both.lfl").good();
    let points = b"5.9999999 10 5\n6.0000001 10 5\n6 10 5\n10 10 12\n22 12 9\n-0.5 1 1\n";
    for (name, expected) in [
        ("one", ["inside", "outside", "undecided", "outside", "outside", "outside"]),
        ("both", ["inside", "inside", "inside", "inside", "outside", "outside"]),
    ] {
        let answers = place.run_with(&format!("contains {name}.lfl"), points).good();
        let answers: Vec<String> = answers.text().lines().map(str::to_owned).collect();
        for (answer, expected) in answers.iter().zip(expected) {
            assert!(expected == "undecided" || answer.contains(expected), "{name}: {answers:?}");
        }
    }
    let hits = place.run_with("ray one.lfl", b"10 10 5  1 0 0\n").good();
    let hit: f64 = hits.text().split_whitespace().find_map(|word| word.parse().ok()).unwrap();
    assert!((hit - 4.0).abs() < 1e-6, "{hits:?}");
    // Meshes and pictures.
    let mesh = place.run("mesh part.lfl -o part.stl --method mc --lossy --json").good().json();
    assert!(
        (mesh["volume"].as_f64().unwrap() / truth - 1.0).abs() < 0.01 && mesh["closed"] == true,
        "{mesh}"
    );
    let [own, source] = ["part", "both"].map(|name| {
        let line = format!("render {name}.lfl -o part.png --size 160x120 --samples 1 --json");
        place.run(&line).good().json()["covered"].as_f64().unwrap()
    });
    assert!(own > 1000.0 && source > own, "{own} {source}");
    // Without surfaces: the existing cells, or those of a level.
    place.run("difference plate.lfl bore.lfl slot.lfl -o cells.lfl --plain").good();
    let cells = file::open(place.path("cells.lfl")).unwrap();
    assert!(cells.view().cuts().is_none() && cells.frame().depth() == 20);
    place.run("difference plate.lfl bore.lfl slot.lfl -o cells.lfl --plain=7").good();
    let cells = file::open(place.path("cells.lfl")).unwrap();
    let volume = cells.statistics().volume();
    assert!(cells.view().cuts().is_none() && cells.frame().depth() == 7);
    assert!(volume.contains(truth) && volume.width() < 0.2 * truth, "{volume:?}");
    place.run("union plate.lfl bore.lfl -o cells.lfl --plain=21").bad(2, &["--plain"]);
    place.run("dexelize part.lfl -o dexels.lfl --resolution 16").good();
    place.run("complement dexels.lfl -o cells.lfl --plain").bad(2, &["--plain is for octrees"]);
}

#[test]
fn booleans_need_one_frame_and_sound_operands() {
    let place = solids();
    for (options, words) in [
        (
            "--depth 6 --bounds 0,0,0,8",
            &["(origin 0 0 0, edge 8, depth 6)", "(origin 0 0 0, edge 8, depth 5)"][..],
        ),
        ("--depth 5 --bounds 0,0,0,9", &["edge 9", "edge 8"]),
        ("--depth 5 --bounds -1,0,0,8", &["origin -1 0 0", "origin 0 0 0"]),
        ("--depth 5", &["frame", "--bounds"]),
    ] {
        place.run(&format!("voxelize slab.stl -o other.lfl {options}")).good();
        for operation in ["union", "intersection", "difference", "xor"] {
            let words: Vec<_> = ["leafless: other.lfl: ", "cube.lfl"].iter().chain(words).copied().collect();
            place.run(&format!("{operation} cube.lfl other.lfl -o out.lfl")).bad(1, &words);
            place.run(&format!("{operation} cube.lfl slab.lfl other.lfl -o out.lfl")).bad(1, &words);
        }
    }
    // Damage that only the checksums show.
    let mut bytes = place.bytes("slab.lfl");
    let probe = file::probe_bytes(&bytes).unwrap();
    let section = probe.sections.iter().find(|section| section.name == Some("planes")).unwrap();
    bytes[section.offset as usize] ^= 1;
    place.write("damaged.lfl", bytes);
    place.run("union cube.lfl damaged.lfl -o out.lfl").bad(1, &["leafless: damaged.lfl: "]);
    place.run("union cube.lfl missing.lfl -o out.lfl").bad(1, &["leafless: missing.lfl: "]);
    assert!(!place.files().contains(&"out.lfl".to_owned()));
}

#[test]
fn contains_answers_line_by_line() {
    let place = solids();
    let points = b"# corner, middle, far\n1.5 1.5 1.5\n\n2.5,2.5,2.5\r\n7\t7\t7\n 4.5 , 2 2 \n9 9 9\nnan 0 0";
    let run = place.run_with("contains cube.lfl", points).good();
    assert_eq!(run.text(), "inside\ninside\noutside\noutside\nundecided\nundecided\n");
    assert_eq!(place.run("contains cube.lfl").good().text(), "");
    assert_eq!(place.run_with("contains cube.lfl", b"\n# nothing\n").good().text(), "");
    // A point on the surface may have any answer, but points beside it never have a wrong one.
    for (input, number, found) in [
        ("2 2 2\n1 2\n2 2 2\n", 2, "\"1 2\""),
        ("2 2 2\n\n# x\nx y z\n", 4, "\"x y z\""),
        ("2 2 2\n1 2 3 4", 2, "\"1 2 3 4\""),
        ("2 2 2\n1,2,\x1b[31m", 2, "\\u{1b}"),
        ("# first\n\n2 2 2\n1 2", 4, "\"1 2\""),
    ] {
        let run = place.run_with("contains cube.lfl", input.as_bytes());
        assert_eq!((run.code, run.text()), (Some(1), "inside\n"), "{run:?}");
        let start = format!("leafless: standard input: line {number}: ");
        assert!(run.errors.starts_with(&start) && run.errors.contains(found), "{run:?}");
        assert_eq!(run.errors.lines().count(), 1, "{run:?}");
    }
    // Many reads later.
    let input = "2 2 2\n# nothing\n".repeat(100_000) + "2 2\n";
    let run = place.run_with("contains cube.lfl", input.as_bytes());
    assert_eq!((run.code, run.text()), (Some(1), &*"inside\n".repeat(100_000)), "{}", run.errors);
    assert!(run.errors.contains("line 200001:"), "{}", run.errors);
    let run = place.run_with("contains cube.lfl", b"2 2 2\n\xff\xfe\n");
    assert_eq!((run.code, run.text()), (Some(1), "inside\n"), "{run:?}");
    // An endless line is refused before it fills the memory.
    let run = place.run_with("contains cube.lfl", &vec![b'1'; 2_000_000]);
    assert!(run.code == Some(1) && run.errors.contains("line 1") && run.errors.len() < 200, "{run:?}");
}

#[test]
fn contains_agrees_with_the_library_on_many_points() {
    let place = solids();
    let cube = file::open(place.path("cube.lfl")).unwrap();
    let mut random = Random(7);
    let points: Vec<[f64; 3]> = (0..100_000).map(|_| [0; 3].map(|_| random.between(-0.2, 8.2))).collect();
    let text: String = points.iter().map(|[x, y, z]| format!("{x:?} {y:?} {z:?}\n")).collect();
    let run = place.run_with("contains cube.lfl", text.as_bytes()).good();
    let answers: Vec<&str> = run.text().lines().collect();
    assert_eq!(answers.len(), points.len());
    let mut met = [0; 3];
    for (&point, answer) in points.iter().zip(answers) {
        let (expected, kind) = match cube.contains(point) {
            Membership::Inside => ("inside", 0),
            Membership::Outside => ("outside", 1),
            Membership::Undecided => ("undecided", 2),
        };
        assert_eq!(answer, expected, "{point:?}");
        met[kind] += 1;
    }
    assert!(met.iter().all(|&n| n > 100), "{met:?}");
}

/// Starts the program with pipes to communicate through.
fn start(place: &Place, line: &str) -> Child {
    let mut command = place.command(line.split_whitespace());
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

#[test]
fn contains_answers_while_the_asker_waits() {
    let place = solids();
    let mut child = start(&place, "contains cube.lfl");
    let (mut stdin, mut stdout) = (child.stdin.take().unwrap(), child.stdout.take().unwrap());
    for _ in 0..3 {
        // The first half of a line has no answer yet.
        stdin.write_all(b"2 2 2\n5 5").unwrap();
        let mut answer = [0; 7];
        stdout.read_exact(&mut answer).unwrap();
        assert_eq!(&answer, b"inside\n");
        stdin.write_all(b" 5\n").unwrap();
        let mut answer = [0; 8];
        stdout.read_exact(&mut answer).unwrap();
        assert_eq!(&answer, b"outside\n");
    }
    drop(stdin);
    assert!(child.wait().unwrap().success());
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let place = solids();
    let mut child = start(&place, "contains cube.lfl");
    drop(child.stdout.take());
    let mut stdin = child.stdin.take().unwrap();
    let lines = b"2 2 2\n".repeat(10_000);
    // Until the program notices.
    while stdin.write_all(&lines).is_ok() {}
    drop(stdin);
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    for line in ["info cube.lfl", "info cube.lfl --json", "verify cube.lfl", "--help", "demo ."] {
        let mut child = start(&place, line);
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{line}: {output:?}");
    }
    // A solid that did not arrive is a failure, if a quiet one.
    place.run("voxelize cube.stl -o large.lfl --depth 9 --bounds 0.9,0.9,0.9,2.2").good();
    assert!(place.bytes("large.lfl").len() > 1 << 17);
    let mut child = start(&place, "complement large.lfl -o -");
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(output.stderr.is_empty(), "{output:?}");
}

#[test]
fn equal_input_gives_equal_bytes_for_any_number_of_threads() {
    let place = Place::new();
    place.run("demo made").good();
    for name in ["flange.stl", "cutter.stl"] {
        std::fs::rename(place.path("made").join(name), place.path(name)).unwrap();
    }
    for rule in ["certified", "sampled"] {
        let mut first = None;
        for threads in [1, 2, 16, 0] {
            let options = format!("--depth 8 --rule {rule} --threads {threads} --bounds -62,-62,-32,124");
            for name in ["flange", "cutter"] {
                place.run(&format!("voxelize {name}.stl -o {name}.lfl {options}")).good();
            }
            place.run(&format!("difference flange.lfl cutter.lfl -o out.lfl --threads {threads}")).good();
            let bytes = ["flange.lfl", "cutter.lfl", "out.lfl"].map(|name| place.bytes(name));
            assert_eq!(*first.get_or_insert(bytes.clone()), bytes, "{rule}, {threads} threads");
        }
    }
}

#[test]
fn demo_does_what_it_says() {
    let place = Place::new();
    let run = place.run("demo new/folder").good();
    let steps = [
        "new/folder",
        "flange.stl",
        "cutter.stl",
        "9,792 triangles",
        "voxelize flange, 1024³ cells",
        "subtract",
        "save drilled.lfl",
        "map",
        "verify",
        "one by one",
        "in a batch",
        "ns a point",
        "inside",
        "mm³",
    ];
    for step in steps {
        assert!(run.text().contains(step), "{step}: {run:?}");
    }
    let drilled = place.path("new/folder").join("drilled.lfl");
    let octree = file::open(&drilled).unwrap();
    assert_eq!(octree.frame().depth(), 10);
    // On the axis, in the flange, in the keyway and in the cross drill.
    for (point, expected) in [
        ([0.0, 0.0, 30.0], Membership::Outside),
        ([56.0, 3.0, 6.0], Membership::Inside),
        ([0.0, 16.0, 30.0], Membership::Outside),
        ([20.0, 0.0, 51.0], Membership::Outside),
        ([0.0, -20.0, 30.0], Membership::Inside),
    ] {
        assert_eq!(octree.contains(point), expected, "{point:?}");
    }
    let mut names: Vec<_> = std::fs::read_dir(drilled.parent().unwrap())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["cutter.stl", "drilled.lfl", "flange.stl"]);
    // The folder's content can be made again. A file cannot be a folder.
    place.run("demo new/folder").good();
    place.run("demo new/folder/flange.stl").bad(1, &["flange.stl"]);
    // Without a folder, the folder for temporary files is used.
    let output = place.command(["demo"]).env("TMPDIR", place.0.path()).output().unwrap();
    if cfg!(unix) {
        assert!(output.status.success() && place.path("leafless-demo/drilled.lfl").is_file(), "{output:?}");
    }
}

#[cfg(unix)]
#[test]
fn demo_does_not_follow_what_others_put_in_its_place() {
    let place = Place::new();
    std::fs::create_dir(place.path("elsewhere")).unwrap();
    std::os::unix::fs::symlink("elsewhere", place.path("leafless-demo")).unwrap();
    let output = place.command(["demo"]).env("TMPDIR", place.0.path()).output().unwrap();
    Run::new("demo", output).bad(1, &["leafless-demo", "demo DIR"]);
    assert_eq!(std::fs::read_dir(place.path("elsewhere")).unwrap().count(), 0);
}

#[test]
fn the_volume_of_a_machined_part() {
    const TRUE_VOLUME: f64 = 11.627733;
    let Some(path) = model("featuretype.STL") else { return };
    // The program runs in another folder.
    let path = std::path::absolute(path).unwrap();
    let place = Place::new();
    let mut last: Option<f64> = None;
    for depth in 6..=8 {
        let depth = depth.to_string();
        let arguments = ["-o", "part.lfl", "--json", "--depth", &depth].map(OsStr::new);
        let words = [OsStr::new("voxelize"), path.as_os_str()].into_iter().chain(arguments);
        let json = Run::new("voxelize", place.command(words).output().unwrap()).good().json();
        assert_eq!((&json["mesh"]["triangles"], &json["mesh"]["facets_read"]), (&3476.into(), &3476.into()));
        let (lower, upper) = volume(&json);
        assert!(lower < TRUE_VOLUME && TRUE_VOLUME < upper, "{lower} {upper}");
        let width = upper - lower;
        if let Some(last) = last {
            assert!((0.4..0.6).contains(&(width / last)), "{last} becomes {width}");
        }
        last = Some(width);
    }
}

/// The result has the name and unit that all operands share. Different units are reported.
#[test]
fn set_operations_keep_what_the_operands_agree_on() {
    let place = Place::new();
    place.write("cube.stl", stl(&block([1.0; 3], [3.0; 3])));
    place.write("slab.stl", stl(&block([1.0; 3], [3.0, 3.0, 2.0])));
    for (mesh, unit, solid) in
        [("cube", "mm", "a"), ("slab", "mm", "b"), ("cube", "in", "c"), ("cube", "mm", "d")]
    {
        place
            .run(&format!("voxelize {mesh}.stl -o {solid}.lfl --depth 4 --bounds 0,0,0,4 --unit {unit}"))
            .good();
    }
    let facts = |line: &str| {
        let run = place.run(line);
        assert_eq!(run.code, Some(0), "{run:?}");
        let info = place.run("info out.lfl --json").good().json();
        (info["metadata"].clone(), run.errors.contains("warning"))
    };
    let kept = |facts: serde_json::Value| (facts, false);
    let all = serde_json::json!({ "name": "cube", "units": "mm", "rule": "certified" });
    let unit = serde_json::json!({ "units": "mm", "rule": "certified" });
    assert_eq!(facts("union a.lfl d.lfl -o out.lfl"), kept(all.clone()));
    assert_eq!(facts("complement a.lfl -o out.lfl"), kept(all));
    assert_eq!(facts("difference a.lfl b.lfl -o out.lfl"), kept(unit.clone()));
    assert_eq!(facts("xor a.lfl b.lfl d.lfl -o out.lfl"), kept(unit));
    let (found, warned) = facts("union a.lfl c.lfl -o out.lfl");
    assert_eq!((found, warned), (serde_json::json!({ "name": "cube", "rule": "certified" }), true));
    let run = place.run("union a.lfl c.lfl -o out.lfl");
    for words in ["c.lfl: warning", "unit is in", "a.lfl is mm"] {
        assert!(run.errors.contains(words), "{run:?}");
    }
}
