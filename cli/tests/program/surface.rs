//! The subcommand `leafless mesh`, from outside.

use crate::place;
use crate::place::{Place, solids};
use leafless::TriangleMesh;
use leafless::exchange::{LengthUnit, MeshFormat, MeshOptions, open_mesh};
use serde_json::Value;

fn ball() -> Place {
    let place = solids();
    place.write("ball.csg", "sphere(r = 2, $fn = 0);");
    place
}

fn mesh(place: &Place, name: &str) -> TriangleMesh {
    open_mesh(place.path(name), &MeshOptions::default()).unwrap().mesh
}

fn json(place: &Place, line: &str) -> Value {
    let run = place.run(line);
    // (The program warns that surfaces with samples as vertices are too large.)
    if run.errors.contains("has a volume") { run.noted(&["--method"]) } else { run.good() }.json()
}

const BOUNDS: &str = "--bounds -3,-3,-3,6";

#[test]
fn every_format_has_the_same_mesh() {
    let place = ball();
    let counts =
        |report: &Value| [report["vertices"].as_u64().unwrap(), report["triangles"].as_u64().unwrap()];
    let mut seen = None;
    for extension in ["ply", "stl", "obj", "off", "3mf"] {
        for text in ["", "--text"] {
            let report = json(
                &place,
                &format!("mesh ball.csg -o ball.{extension} --method mc --depth 4 {BOUNDS} {text} --json"),
            );
            assert_eq!(report["format"], extension);
            assert_eq!((&report["closed"], &report["manifold"]), (&Value::Bool(true), &Value::Bool(true)));
            assert_eq!((&report["euler"], &report["components"]), (&Value::from(2), &Value::from(1)));
            let back = mesh(&place, &format!("ball.{extension}"));
            assert!(back.report().unwrap().is_closed());
            assert_eq!([back.vertices().len() as u64, back.triangles().len() as u64], counts(&report));
            assert_eq!(*seen.get_or_insert(counts(&report)), counts(&report));
        }
    }
    let piped = place.run(&format!("mesh ball.csg -o - --method mc --depth 4 {BOUNDS}"));
    assert!(piped.code == Some(0) && piped.errors.contains("2-manifold"));
    place.write("piped.ply", &piped.bytes);
    place.run(&format!("mesh ball.csg -o named --write ply --method mc --depth 4 {BOUNDS}")).good();
    assert_eq!(place.bytes("piped.ply"), place.bytes("named"));
    assert_eq!(mesh(&place, "piped.ply").triangles(), mesh(&place, "ball.off").triangles());
}

/// Vertices lie on the ball, and area and volume approach the ball's from below.
#[test]
fn vertices_lie_on_the_surface() {
    let place = ball();
    let mut gaps = vec![];
    for depth in [4, 5, 6] {
        let report =
            json(&place, &format!("mesh ball.csg -o ball.ply --method mc --depth {depth} {BOUNDS} --json"));
        for vertex in mesh(&place, "ball.ply").vertices() {
            let radius = vertex.iter().map(|x| x * x).sum::<f64>().sqrt();
            assert!((radius - 2.0).abs() < 1e-9, "{radius}");
        }
        let of = |name: &str, true_one: f64| 1.0 - report[name].as_f64().unwrap() / true_one;
        gaps.push([of("volume", 32.0 / 3.0 * std::f64::consts::PI), of("area", 16.0 * std::f64::consts::PI)]);
    }
    for pair in gaps.windows(2) {
        for k in 0..2 {
            assert!(pair[1][k] > 0.0 && pair[1][k] < 0.3 * pair[0][k], "{gaps:?}");
        }
    }
}

#[test]
fn undecided_cells_are_resolved_as_one_asks() {
    let place = ball();
    place.run(&format!("csg ball.csg -o ball.lfl --depth 6 {BOUNDS}")).good();
    place.run("mesh ball.lfl -o open.ply").noted(&["ball.lfl", "undecided", "--resolve"]);
    place.run("mesh ball.lfl -o ball.ply --resolve source").bad(1, &["ball.lfl", "source", "inner"]);
    place.run("mesh ball.lfl -o coarse.ply --depth 3").noted(&["ball.lfl", "undecided", "--resolve"]);
    place.run("mesh ball.lfl -o ball.ply --depth 7").bad(2, &["--depth"]);
    place.run("mesh ball.lfl -o ball.ply --bounds 0,0,0,1").bad(2, &["--bounds"]);
    assert!(!place.files().contains(&"ball.ply".to_owned()));
    let volume = |line: &str| json(&place, line)["volume"].as_f64().unwrap();
    let whole = 32.0 / 3.0 * std::f64::consts::PI;
    for method in ["mc", "nets", "smc"] {
        let of = |file: &str, resolve: &str| {
            volume(&format!("mesh {file} -o ball.ply --method {method} {resolve} --json"))
        };
        let scene = format!("ball.csg --depth 6 {BOUNDS}");
        let [inner, outer] = ["--resolve inner", "--resolve outer"].map(|how| {
            let found = of("ball.lfl", how);
            assert_eq!(found, of(&scene, how));
            found
        });
        assert!(0.8 * whole < inner && inner < whole && whole < outer && outer < 1.2 * whole);
        let source = of(&scene, "--resolve source");
        assert!(inner < source && source < outer);
    }
    let [fat, thin] = ["fat", "thin"].map(|snap| {
        volume(&format!("mesh ball.lfl -o b.off --method smc --snap {snap} --resolve inner --json"))
    });
    assert!(thin < fat);
}

/// The slab is [2, 6] × [2, 6] × [0, 2], and its faces lie between cells.
#[test]
fn what_is_decided_needs_no_choice() {
    let place = solids();
    let report = json(&place, "mesh slab.lfl -o slab.obj --json");
    assert_eq!(report["closed"], true);
    // Corners and edges are cut off by less than a cell.
    let volume = report["volume"].as_f64().unwrap();
    assert!(31.0 < volume && volume < 32.0, "{volume}");
    let text = place.run("mesh slab.lfl -o slab.obj").good();
    assert!(text.text().contains("2-manifold") && text.text().contains("Euler characteristic 2"));
}

#[test]
fn a_package_keeps_the_unit() {
    let place = ball();
    let options = MeshOptions::default();
    place.run(&format!("mesh ball.csg -o ball.stl --method mc --depth 4 {BOUNDS}")).good();
    place.run("mesh ball.stl --unit in -o ball.3mf --method mc --depth 4").good();
    let file = open_mesh(place.path("ball.3mf"), &options).unwrap();
    assert_eq!((file.format, file.unit), (MeshFormat::ThreeMf, Some(LengthUnit::Inch)));
    place.run("voxelize ball.3mf -o ball.lfl --depth 5 --rule sampled").good();
    place.run("mesh ball.lfl -o again.3mf").good();
    assert_eq!(open_mesh(place.path("again.3mf"), &options).unwrap().unit, Some(LengthUnit::Inch));
}

#[test]
fn what_is_refused() {
    let place = solids();
    place.run("mesh slab.lfl -o slab").bad(2, &["slab", ".ply", "--write"]);
    place.run("mesh slab.lfl -o none/slab.ply").bad(1, &["none"]);
    place.run("mesh none.lfl -o slab.ply").bad(1, &["none.lfl"]);
    place.run("mesh slab.lfl").bad(2, &["--output"]);
}

/// Shrink leaves few triangles and no cracks. Its published form has cracks.
#[test]
fn plane_parts_are_shrunk() {
    let place = solids();
    place.write(
        "part.csg",
        "difference() { cube(size = [6, 5, 4]); \
         multmatrix([[1, 0, 0, 2], [0, 1, 0, 2], [0, 0, 1, -1], [0, 0, 0, 1]]) cube(size = [2, 1, 6]); }",
    );
    let of = |method: &str| {
        let report = json(
            &place,
            &format!(
                "mesh part.csg -o {method}.ply --method {method} --depth 5 --bounds -1,-1,-1,8 --intersections --json"
            ),
        );
        assert_eq!(report["method"], method);
        report
    };
    let (all, few, published) = (of("smc"), of("shrink"), of("shrink-published"));
    let count = |report: &Value| report["triangles"].as_u64().unwrap();
    assert!(20 * count(&few) < count(&all) && 2 * count(&published) < count(&all));
    for report in [&all, &few] {
        assert_eq!((&report["closed"], &report["manifold"]), (&Value::Bool(true), &Value::Bool(true)));
        assert_eq!((&report["euler"], &report["intersecting"]), (&Value::from(0), &Value::from(0)));
    }
    assert_eq!(published["closed"], false);
    for name in ["volume", "area"] {
        let [all, few] = [&all, &few].map(|report| report[name].as_f64().unwrap());
        assert!((all - few).abs() < 1e-9 * all);
    }
    let thin = json(
        &place,
        "mesh part.csg -o thin.ply --method shrink --snap thin --depth 5 --bounds -1,-1,-1,8 --json",
    );
    assert!(thin.get("intersecting").is_none());
    assert!(thin["volume"].as_f64().unwrap() < few["volume"].as_f64().unwrap());
    let report = place.run("mesh part.csg -o part.ply --method mc --depth 4 --intersections").good();
    assert!(report.text().contains("0 pairs of triangles"), "{}", report.text());
}

#[test]
fn normals_are_written_if_asked_for() {
    let place = ball();
    let line = format!("mesh ball.csg --method mc --depth 4 {BOUNDS}");
    place.run(&format!("{line} --text --normals -o ball.ply")).good();
    place.run(&format!("{line} -o plain.ply --text")).good();
    let text = String::from_utf8(place.bytes("ball.ply")).unwrap();
    assert!(text.contains("property float nz"));
    let body = text.split_once("end_header\n").unwrap().1;
    for (line, vertex) in body.lines().zip(mesh(&place, "plain.ply").vertices()) {
        let numbers: Vec<f64> = line.split(' ').map(|x| x.parse().unwrap()).collect();
        // On a ball around the origin, the normal is approximately the vertex's direction.
        for axis in 0..3 {
            assert_eq!(numbers[axis], vertex[axis]);
            assert!((numbers[3 + axis] - vertex[axis] / 2.0).abs() < 0.05, "{line}");
        }
    }
    assert_eq!(mesh(&place, "ball.ply").triangles(), mesh(&place, "plain.ply").triangles());
}

/// Checks that the report describes the mesh that is read back.
#[track_caller]
fn same_as_read(place: &Place, report: &Value) {
    let name = report["output"].as_str().unwrap();
    let back = mesh(place, name);
    let found = back.report().unwrap();
    for (key, value) in [
        ("vertices", found.vertices),
        ("triangles", found.triangles),
        ("components", found.bodies),
        ("degenerate", found.degenerate),
        ("flat", found.flat),
        ("open_edges", found.boundary_edges),
        ("non_manifold_edges", found.non_manifold_edges),
    ] {
        assert_eq!(report[key], value, "{key}");
    }
    assert_eq!(report["euler"], found.euler_characteristic);
    assert_eq!(report["closed"], found.is_closed() && found.triangles > 0);
    assert_eq!(report["manifold"], found.is_manifold() && found.triangles > 0);
    // (Numbers read from JSON may be wrong by one unit in the last place.)
    for (key, value) in [("area", back.area()), ("volume", back.volume())] {
        let told = report[key].as_f64().unwrap();
        assert!((told - value).abs() <= 2.0 * f64::EPSILON * value.abs(), "{key}: {told} {value}");
    }
}

fn moved(by: f64, what: &str) -> String {
    format!("multmatrix([[1,0,0,{by}],[0,1,0,{by}],[0,0,1,{by}],[0,0,0,1]]) {what}")
}

/// A mesh that single precision breaks is not written as STL, unless `--lossy` allows it.
#[test]
fn losses_are_said() {
    let place = Place::new();
    place.write("cube.csg", moved(1e9, "cube(size = [3, 3, 3]);"));
    place.write("ball.csg", moved(1e5, "sphere(r = 1.855, $fn = 0);"));
    for text in ["", "--text"] {
        let line = format!("mesh cube.csg -o cube.stl --method mc --depth 5 {text}");
        let why = "nothing is left";
        place.run(&line).bad(1, &["32-bit", "STL", why, "PLY, OBJ, OFF and 3MF keep doubles", "--lossy"]);
        assert!(!place.files().contains(&"cube.stl".to_owned()));
        let run = place.run(&format!("{line} --lossy --json"));
        assert_eq!((run.code, run.errors.lines().count()), (Some(0), 1), "{run:?}");
        assert!(run.errors.contains("warning") && run.errors.contains(why), "{run:?}");
        let report = run.json();
        same_as_read(&place, &report);
        assert_eq!(report["broken"], true);
        assert!(report["collapsed"].as_u64().unwrap() > 1000, "{report}");
        std::fs::remove_file(place.path("cube.stl")).unwrap();
    }
    for (name, depth) in [("cube", 5), ("ball", 6)] {
        for extension in ["ply", "obj", "off", "3mf"] {
            let line = format!("mesh {name}.csg -o {name}.{extension} --method mc --depth {depth} --json");
            let report = json(&place, &line);
            same_as_read(&place, &report);
            assert_eq!((&report["closed"], &report["manifold"]), (&Value::Bool(true), &Value::Bool(true)));
            assert_eq!((&report["rounding"], &report["broken"]), (&Value::from(0.0), &Value::Bool(false)));
        }
    }
    // A ball with triangles hardly larger than the rounding is repaired.
    for text in ["", "--text"] {
        let report = json(
            &place,
            &format!("mesh ball.csg -o ball.stl --method mc --depth 6 {text} --intersections --json"),
        );
        same_as_read(&place, &report);
        for lost in ["degenerate", "merged", "flat", "intersecting"] {
            assert_eq!(report[lost], 0, "{report}");
        }
        assert_eq!((&report["closed"], &report["manifold"]), (&Value::Bool(true), &Value::Bool(true)));
    }
    let text = place.run("mesh ball.csg -o ball.stl --method mc --depth 6").good();
    let lines: Vec<&str> = text.text().lines().collect();
    assert!(lines[0].contains("closed, 2-manifold"), "{text:?}");
    assert!(lines[3].starts_with("rounded to 32 bits, by up to 0.00390"), "{text:?}");
    assert!(lines[3].contains("1,696 triangles collapsed, 46 triangles turned"), "{text:?}");
    let text = place.run("mesh cube.csg -o cube.stl --method mc --depth 5 --lossy");
    assert!(text.text().contains("empty: rounding leaves no triangle"), "{text:?}");
    // Nothing is written on standard output, and no older file is replaced.
    place.write("old.stl", "old");
    for line in ["mesh cube.csg -o - --write stl --depth 5", "mesh cube.csg -o old.stl --method mc"] {
        place.run(line).bad(1, &["32-bit"]);
    }
    assert_eq!(place.bytes("old.stl"), b"old");
    // Other subcommands that write meshes.
    place.run("convert cube.csg -o cube.stl --resolution 32").bad(1, &["cube.stl", "nothing is left"]);
    assert_eq!(place.run("convert cube.csg -o cube.stl --resolution 32 --lossy").code, Some(0));
    place.run("dexelize cube.csg -o cube.lfl --resolution 32 --normals 32").good();
    place.write("cube.raw", [255; 27]);
    let volume = "mesh cube.raw --extents 3,3,3 --corner 1e9,1e9,1e9";
    for line in ["mesh cube.lfl", "mesh cube.lfl --method dual", volume] {
        place.run(&format!("{line} -o new.stl")).bad(1, &["new.stl", "32-bit"]);
        same_as_read(&place, &json(&place, &format!("{line} -o new.ply --json")));
    }
    assert!(!place.files().contains(&"new.stl".to_owned()));
}

/// A cube far away along one axis becomes flat; its front and back remain.
#[test]
fn flat_figures_are_refused() {
    let place = Place::new();
    place
        .write("cube.csg", "multmatrix([[1,0,0,1e9],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) cube(size = [3, 3, 3]);");
    place.run("mesh cube.csg -o cube.stl --depth 5").bad(1, &["flat", "encloses no volume"]);
    let report = place.run("mesh cube.csg -o cube.stl --depth 5 --lossy --json").json();
    same_as_read(&place, &report);
    assert_eq!((&report["volume"], &report["broken"]), (&Value::from(0.0), &Value::Bool(true)));
}

/// Triangles that become degenerate by rounding are repaired, and the repairs are reported.
#[test]
fn degenerate_triangles_are_mended() {
    let place = Place::new();
    place.write("ball.csg", moved(300.0, "sphere(r = 2, $fn = 0);"));
    let run = place.run("mesh ball.csg -o ball.stl --method mc --depth 7 --intersections --json").good();
    let report = run.json();
    same_as_read(&place, &report);
    assert_eq!((&report["manifold"], &report["broken"]), (&Value::Bool(true), &Value::Bool(false)));
    for lost in ["degenerate", "flat", "merged", "intersecting"] {
        assert_eq!(report[lost], 0, "{report}");
    }
    let collapsed = report["collapsed"].as_u64().unwrap();
    assert!(collapsed > 0, "{report}");
    let text = place.run("mesh ball.csg -o ball.stl --method mc --depth 7").good();
    assert!(text.text().contains("triangles collapsed"), "{text:?}");
    // A plate whose upper faces lie in planes of the lattice.
    place.write("plate.csg", PLATE);
    let report =
        json(&place, "mesh plate.csg -o plate.stl --method mc --bounds 0,0,0,80 --intersections --json");
    for lost in ["degenerate", "flat", "merged", "intersecting"] {
        assert_eq!(report[lost], 0, "{report}");
    }
    assert!(report["collapsed"].as_u64().unwrap() > 0, "{report}");
}

const PLATE: &str = "difference() { cube(size = [80, 60, 10]); multmatrix([[1,0,0,40],[0,1,0,30],[0,0,1,-1],[0,0,0,1]]) \
                     cylinder(h = 12, r1 = 5, r2 = 5, $fn = 0); }";

/// Plane faces as polygons, and the kinds of the surfaces.
#[test]
fn faces_are_told() {
    let place = Place::new();
    place.write("plate.csg", PLATE);
    let report = json(&place, "mesh plate.csg -o plate.obj --method faces --polygons --json");
    same_as_read(&place, &report);
    let regions = report["regions"].as_array().unwrap();
    let of = |kind: &'static str| regions.iter().filter(move |region| region["kind"] == kind);
    assert_eq!((regions.len(), of("plane").count(), of("cylinder").count()), (7, 6, 1));
    let bore = of("cylinder").next().unwrap();
    let radius = bore["radius"].as_f64().unwrap();
    assert!((radius - 5.0).abs() < 1e-12 && bore["turned"] == true, "{bore}");
    assert!((bore["point"][0].as_f64().unwrap() - 40.0).abs() < 1e-12, "{bore}");
    assert_eq!(bore["loops"], bore["triangles"]);
    let loops: u64 = of("plane").map(|region| region["loops"].as_u64().unwrap()).sum();
    let area: f64 = of("plane").map(|region| region["area"].as_f64().unwrap()).sum();
    assert!(loops == 8 && of("plane").all(|region| region["faces"] == 1 && region["turned"] == false));
    let pi = std::f64::consts::PI;
    assert!((area - (2.0 * (4800.0 + 800.0 + 600.0) - 50.0 * pi)).abs() < 2.0, "{area}");
    let file = String::from_utf8(place.bytes("plate.obj")).unwrap();
    let groups: Vec<&str> = file.lines().filter(|line| line.starts_with("g ")).collect();
    assert_eq!(groups.len(), 7, "{groups:?}");
    assert_eq!(groups.iter().filter(|name| name.contains(" plane_")).count(), 6, "{groups:?}");
    assert_eq!(groups.iter().filter(|name| name.contains(" cylinder_")).count(), 1, "{groups:?}");
    // (Four sides are quadrilaterals.)
    let sizes = file.lines().filter_map(|line| Some(line.strip_prefix("f ")?.split(' ').count()));
    assert!(sizes.filter(|&size| size == 4).count() >= 4);
    json(&place, "mesh plate.csg -o plate.off --method faces --polygons --json");
    let [off, obj] = ["off", "obj"].map(|kind| mesh(&place, &format!("plate.{kind}")).volume());
    assert!((off - obj).abs() < 1e-9, "{off} {obj}");
    // Triangles give the same regions.
    let plain = json(&place, "mesh plate.csg -o plate.ply --method faces --json");
    assert_eq!(plain["regions"], report["regions"]);
    place.run("csg plate.csg -o plate.lfl --surfaces").good();
    let stored = json(&place, "mesh plate.lfl -o stored.obj --method faces --polygons --json");
    assert_eq!(stored["regions"].as_array().unwrap().len(), 7);
    let moved = json(&place, "mesh plate.lfl -o stored.obj --method faces --translate 1,2,3 --json");
    assert_eq!(moved["regions"], Value::Null);
    for (line, words) in [
        ("mesh plate.csg -o x.obj --method mc --polygons", &["--polygons", "--method faces"][..]),
        ("mesh plate.csg -o x.ply --method faces --polygons", &["--polygons", "OBJ and OFF"]),
        ("mesh plate.csg -o x.obj --method faces --polygons --normals", &["--polygons", "--normals"]),
        (
            "mesh plate.lfl -o x.obj --method faces --polygons --translate 1,2,3",
            &["--translate", "--polygons"],
        ),
    ] {
        place.run(line).bad(2, words);
    }
    assert!(!place.files().iter().any(|name| name.starts_with("x.")));
}

/// Values on triangles: from channels of octrees, materials of tri-dexel models, and colours of meshes.
#[test]
fn triangles_bear_values() {
    let place = Place::new();
    place.write("plate.csg", PLATE);
    place.run("csg plate.csg -o plate.lfl --depth 6").good();
    place.run("attribute plate.lfl -o plate.lfl --name kind --value 3").good();
    for extension in ["obj", "3mf", "ply"] {
        let line = format!("mesh plate.lfl -o plate.{extension} --channel kind --json");
        let report = place.run(&line);
        assert_eq!(report.code, Some(0), "{report:?}");
        let found = mesh(&place, &format!("plate.{extension}"));
        let name = if extension == "ply" { "kind" } else { "material" };
        let values = found.attribute(name).unwrap_or_else(|| panic!("{extension}"));
        assert_eq!(values.len(), found.triangles().len());
        if extension == "ply" {
            assert!((0..values.len()).all(|k| values.value(k, 0).unwrap()[0] == 3.0));
        }
    }
    place.run("mesh plate.lfl -o plate.stl --channel kind").bad(2, &["STL has no place", "kind"]);
    place.run("mesh plate.lfl -o plate.ply --channel other").bad(1, &["no channel \"other\"", "kind"]);
    place.run("mesh plate.csg -o plate.ply --channel kind").bad(1, &["plate.csg", "no channels"]);
    // Materials of a tri-dexel model.
    place.write("cube.csg", "cube(size = [2, 2, 2]);");
    place.run("dexelize cube.csg -o rays.lfl --resolution 32 --material 7").good();
    place.run("mesh rays.lfl -o rays.obj --channel material").good();
    assert!(String::from_utf8(place.bytes("rays.obj")).unwrap().contains("\nusemtl material_7\n"));
    place.run("mesh rays.lfl -o rays.ply --channel other").bad(1, &["rays.lfl", "no channel but"]);
    place.run("dexelize cube.csg -o plain.lfl --resolution 32").good();
    place.run("mesh plain.lfl -o rays.ply --channel material").bad(1, &["plain.lfl", "stores no materials"]);
    // Materials of a mesh, by its own surface.
    place.run("mesh plate.obj -o own.3mf --channel material --method mc --depth 5").good();
    assert!(mesh(&place, "own.3mf").attribute("material").is_some());
    place.run("mesh plate.obj -o own.3mf --channel colour").bad(1, &["colour", "It has material"]);
}

#[test]
fn an_empty_mesh_is_called_empty() {
    let place = Place::new();
    place.write("none.csg", "difference() { cube(size = [1, 1, 1]); cube(size = [2, 2, 2]); }");
    for extension in ["ply", "stl", "off", "3mf"] {
        let line = format!("mesh none.csg -o none.{extension} --bounds 0,0,0,4 --depth 4");
        let text = place.run(&line).good();
        assert!(text.text().contains("empty: there are no triangles"), "{text:?}");
        assert!(text.text().contains("area 0, volume 0;"), "{text:?}");
        assert!(!text.text().contains("closed") && !text.text().contains("manifold"), "{text:?}");
        let report = json(&place, &format!("{line} --json"));
        assert_eq!((&report["empty"], &report["closed"]), (&Value::Bool(true), &Value::Bool(false)));
        assert_eq!(report["manifold"], false);
        assert!(!place.run(&format!("{line} --json")).text().contains("-0"));
        let info = json(&place, &format!("info none.{extension} --json"));
        assert_eq!(info["closed"], report["closed"]);
    }
}

#[test]
fn normals_are_refused_where_a_format_has_none() {
    let place = solids();
    for extension in ["stl", "off", "3mf"] {
        place
            .run(&format!("mesh slab.lfl -o slab.{extension} --normals"))
            .bad(2, &["--normals", "PLY and OBJ"]);
    }
}

#[test]
fn solids_from_files_are_meshed_at_coarser_levels() {
    let place = place::solids();
    place.run("voxelize cube.stl -o coarse.lfl --depth 2 --bounds 0,0,0,8").good();
    for resolve in ["inner", "outer"] {
        place.run(&format!("mesh cube.lfl -o fine.ply --depth 2 --resolve {resolve}"));
        place.run(&format!("mesh coarse.lfl -o coarse.ply --resolve {resolve}"));
        assert_eq!(place.bytes("fine.ply"), place.bytes("coarse.ply"), "{resolve}");
    }
    place.run("mesh cube.lfl -o open.ply --depth 2").noted(&["undecided", "--resolve"]);
    assert_eq!(place.bytes("open.ply"), place.bytes("fine.ply"));
    place.run("mesh cube.lfl -o no.ply --depth 6").bad(2, &["--depth 6", "cube.lfl", "5"]);
}

/// A plate with a bore, from a scene and from a solid that keeps its surfaces: few triangles, sharp edges,
/// and provably within the tolerance.
#[test]
fn faces_of_a_plate_with_a_bore() {
    let place = solids();
    let scene = "difference() { cube([80,60,10]); translate([40,30,-1]) cylinder(h=12, r=5, $fn=0); }";
    place.write("plate.csg", scene);
    let report = json(&place, "mesh plate.csg -o plate.stl --method faces --intersections --json");
    let count = report["triangles"].as_u64().unwrap();
    assert!(count <= 400, "{count}");
    assert_eq!((&report["closed"], &report["manifold"]), (&Value::Bool(true), &Value::Bool(true)));
    assert_eq!((&report["euler"], &report["intersecting"]), (&Value::from(0), &Value::from(0)));
    assert_eq!((&report["degenerate"], &report["method"]), (&Value::from(0), &Value::from("faces")));
    let proven = report["deviation"].as_f64().unwrap();
    assert!(0.02 < proven && proven <= 0.08, "{report}");
    let proof = json(&place, "deviation plate.csg plate.stl --within 0.08 --json");
    assert_eq!(proof["verdict"], "within", "{proof}");
    for (tolerance, most) in [("0.008", 1500), ("0.0008", 5000)] {
        let line = format!(
            "mesh plate.csg -o fine.stl --method faces --tolerance {tolerance} --intersections --json"
        );
        let report = json(&place, &line);
        assert!(report["triangles"].as_u64().unwrap() <= most, "{report}");
        assert_eq!(report["intersecting"], 0);
        assert!(report["deviation"].as_f64().unwrap() <= tolerance.parse().unwrap(), "{report}");
    }
    // The file states the deviation, and the text output does, too.
    let said = place.run("mesh plate.csg -o told.3mf --method faces").good();
    assert!(said.text().contains("of the solid: proven"), "{}", said.text());
    let told = json(&place, "info told.3mf --json");
    assert!((told["told_deviation"].as_f64().unwrap() - proven).abs() < 1e-5, "{told}");
    // Measured from the file with the stated deviation, the interval contains the true plate's volume.
    let line = format!("measure plate.stl --deviation {proven} --tolerance 1e-3 --json");
    let volume = &json(&place, &line)["volume"];
    let truth = 48000.0 - 250.0 * std::f64::consts::PI;
    let [least, most] = ["lower", "upper"].map(|end| volume[end].as_f64().unwrap());
    assert!(least <= truth && truth <= most, "{volume}");
    // All inputs that have a shape, in cells of several sizes.
    let adaptive = json(&place, "mesh plate.stl -o adaptive.ply --method adaptive --json");
    assert!(adaptive["closed"] == true && adaptive["manifold"] == true, "{adaptive}");
    let proven = adaptive["deviation"].as_f64().unwrap();
    assert!(adaptive["triangles"].as_u64().unwrap() < 10_000 && proven <= 0.08, "{adaptive}");
    let proof = json(&place, "deviation plate.stl adaptive.ply --within 0.1 --json");
    assert_eq!(proof["verdict"], "within", "{proof}");
    place.run("csg plate.csg -o plate.lfl --surfaces").good();
    let stored = json(&place, "mesh plate.lfl -o stored.ply --method faces --json");
    assert!(stored["triangles"].as_u64().unwrap() <= 400 && stored["euler"] == 0, "{stored}");
    // Inputs without surfaces, and options that do not fit.
    place.run("csg plate.csg -o cells.lfl --depth 5 --rule sampled").good();
    place.run("mesh cells.lfl -o out.ply --method faces").bad(1, &["cells.lfl", "--method faces"]);
    // A mesh has its own triangles, merged.
    let fewer = json(&place, "mesh plate.stl -o fewer.ply --tolerance 0.5 --json");
    assert_eq!((&fewer["method"], &fewer["euler"]), (&"faces".into(), &0.into()));
    assert!(fewer["triangles"].as_u64() < report["triangles"].as_u64(), "{fewer}");
    assert!(fewer["deviation"].as_f64().unwrap() <= 0.5, "{fewer}");
    place
        .run("mesh plate.csg -o out.ply --method mc --tolerance 0.1")
        .bad(2, &["--tolerance", "--method faces"]);
    place.run("mesh plate.csg -o out.ply --method faces --resolve outer").bad(2, &["--resolve"]);
    place.run("mesh plate.csg -o out.ply --method faces --tolerance 0").bad(1, &["tolerance"]);
}

/// Without `--method`, the program chooses the method that uses the most knowledge of the shape, and reports
/// it.
#[test]
fn what_is_known_of_the_shape_decides() {
    let place = solids();
    place
        .write("plate.csg", "difference() { cube([8,6,1]); translate([4,3,-1]) cylinder(h=3, r=1, $fn=0); }");
    place.write("part.csg", "difference() { mesh(\"cube.stl\"); translate([2,2,2]) sphere(r=1.5, $fn=0); }");
    place.run("csg plate.csg -o surfaces.lfl --surfaces").good();
    place.run("csg plate.csg -o cells.lfl --depth 6 --rule sampled").good();
    place.run("dexelize plate.csg -o normals.lfl --resolution 32 --normals 32").good();
    place.run("dexelize plate.csg -o rays.lfl --resolution 32").good();
    place.write("voxels.raw", [255; 27]);
    for (file, method, is_proven) in [
        ("plate.csg", "faces", true),
        ("part.csg", "dual", false),
        ("cube.stl", "faces", true),
        ("surfaces.lfl", "faces", true),
        ("cells.lfl", "nets", false),
        ("normals.lfl", "dual", false),
        ("rays.lfl", "mc", false),
        ("voxels.raw --extents 3,3,3", "mc", false),
    ] {
        let report = json(&place, &format!("mesh {file} -o out.ply --json"));
        assert_eq!(report["method"], method, "{file}");
        assert_eq!(report["closed"], true, "{file}");
        assert_eq!(report.get("deviation").is_some(), is_proven, "{file}: {report}");
    }
    // The layers of a mesh are not a few surfaces.
    place.run("voxelize cube.stl -o layers.lfl --surfaces=1e-2 --rotate 1,1,0,30").good();
    let layers = json(&place, "mesh layers.lfl -o out.ply --json");
    assert!(layers["method"] == "mc" && layers["closed"] == true, "{layers}");
    // Options that belong to a single method choose it, and the report names it.
    for (line, method) in [
        ("mesh plate.csg --depth 4 --vertices midpoint", "mc"),
        ("mesh plate.csg --depth 4 --resolve outer", "nets"),
        ("mesh plate.csg --depth 4 --snap thin", "smc"),
        ("mesh voxels.raw --extents 3,3,3 --depth 5 --tolerance 0.1", "adaptive"),
        ("mesh part.csg --depth 6 --tolerance 0.1", "adaptive"),
    ] {
        let run = place.run(&format!("{line} -o out.ply --json"));
        let note = format!(
            "note: --{} makes it --method {method}",
            line.rsplit("--").next().unwrap().split(' ').next().unwrap()
        );
        assert!(run.code == Some(0) && run.errors.contains(&note), "{line}: {run:?}");
        assert_eq!(run.json()["method"], method, "{line}");
    }
    place.run("mesh cells.lfl -o out.ply --tolerance 0.1").bad(2, &["--tolerance", "--method nets"]);
    // Parts outside the cube are cut off.
    let cut = place.run("mesh plate.csg -o out.ply --bounds -1,-1,-1,6 --depth 4 --json");
    assert!(cut.code == Some(0) && cut.errors.contains("cut off"), "{cut:?}");
    assert_eq!(cut.json()["method"], "mc");
    place
        .run("mesh plate.csg -o out.ply --bounds -1,-1,-1,6 --method faces")
        .bad(1, &["hold all of the solid"]);
}

/// Triangles of any surface are removed. The reported distance from the solid stays true.
#[test]
fn triangles_are_taken_out() {
    let place = ball();
    let cubes = format!("mesh ball.csg --method mc --depth 5 {BOUNDS} --json");
    let full = json(&place, &format!("{cubes} -o full.ply"));
    let few = json(&place, &format!("{cubes} -o few.ply --simplify 0.05"));
    let count = |report: &Value| report["triangles"].as_u64().unwrap();
    assert!(4 * count(&few) < count(&full) && few["manifold"] == true, "{few} {full}");
    // The distance of marching cubes from the ball is unknown.
    assert!(few.get("deviation").is_none(), "{few}");

    // A mesh copied to the output is the solid.
    let copy = json(&place, "convert full.ply -o simple.ply --simplify 0.05 --json");
    assert_eq!((count(&copy), &copy["method"]), (count(&few), &"copy".into()));
    let proven = copy["deviation"].as_f64().unwrap();
    assert!(proven > 0.0 && proven <= 0.05, "{copy}");
    let within = format!("deviation full.ply simple.ply --within {proven} --json");
    assert_ne!(place.run(&within).json()["verdict"], "beyond");

    // The earlier proven deviation is added.
    let faces = "mesh ball.csg --method faces --tolerance 0.02 --json";
    let near = json(&place, &format!("{faces} -o near.ply"))["deviation"].as_f64().unwrap();
    let both = json(&place, &format!("{faces} -o both.ply --simplify 0.05"));
    let sum = both["deviation"].as_f64().unwrap();
    assert!(sum > near && sum <= near + 0.05 && both.get("regions").is_none(), "{both}");

    place
        .run("convert full.ply -o same.lfl --to octree --simplify 0.05")
        .bad(2, &["--simplify is for --to mesh"]);
    place.run("convert full.ply -o same.ply --simplify 0").bad(1, &["tolerance"]);
    let polygons = "mesh ball.csg -o p.off --method faces --polygons --simplify 0.05";
    place.run(polygons).bad(2, &["does not go with --simplify"]);
}
