//! What somebody means who tries the program for the first time: defaults that do it, messages that say what
//! to do, and answers that agree with each other.

use crate::place::{Place, block, meshes, solids, stl};
use leafless::TriangleMesh;
use leafless_testkit::model;
use serde_json::Value;
use std::f64::consts::PI;

fn ends(value: &Value) -> (f64, f64) {
    (value["lower"].as_f64().unwrap(), value["upper"].as_f64().unwrap())
}

fn volume(place: &Place, file: &str) -> (f64, f64) {
    ends(&place.run(&format!("info {file} --json")).good().json()["volume"])
}

/// A ball of radius 1, and its octrees: one with undecided cells, and one whose cells keep the surface.
fn balls() -> Place {
    let place = Place::new();
    place.write("ball.csg", "sphere(1);");
    place.run("csg ball.csg -o ball.lfl --depth 5 --bounds -2,-2,-2,4").good();
    place.run("csg ball.csg -o sharp.lfl --surfaces").good();
    place
}

const BALL: f64 = 4.0 / 3.0 * PI;

#[test]
fn undecided_cells_are_no_reason_to_stop() {
    let place = balls();
    let (_, upper) = volume(&place, "ball.lfl");
    for line in
        ["mesh ball.lfl -o ball.ply", "bitmap ball.lfl -o ball.nrrd", "dexelize ball.lfl -o dexels.lfl"]
    {
        let run = place.run(line);
        assert_eq!((run.code, run.errors.lines().count()), (Some(0), 1), "{run:?}");
        assert!(run.errors.contains("ball.lfl: note: its undecided cells count as inside"), "{run:?}");
    }
    let counted = place.run("bitmap ball.lfl -o ball.nrrd --json").json()["inside"].as_f64().unwrap();
    assert_eq!(counted * 0.125f64.powi(3), upper);
    let meshed = place.run("mesh ball.lfl -o ball.ply --json").json();
    assert!(meshed["closed"] == true && meshed["volume"].as_f64().unwrap() > BALL, "{meshed}");
    // Where surfaces are kept they decide.
    let sharp = place.run("bitmap sharp.lfl -o sharp.nrrd --level 6 --json");
    assert!(!sharp.errors.contains("undecided"), "{sharp:?}");
    let sharp = sharp.json();
    let volume = sharp["inside"].as_f64().unwrap() * sharp["spacing"].as_f64().unwrap().powi(3);
    assert!((volume / BALL - 1.0).abs() < 0.01, "{volume}");
}

#[test]
fn a_solid_is_made_like_another() {
    let place = solids();
    place.write("pin.csg", "translate([1.5, 1.5, 0]) cylinder(h = 4, r = 0.5);");
    place.run("voxelize slab.stl -o other.lfl --like cube.lfl").good();
    assert_eq!(place.bytes("other.lfl"), place.bytes("slab.lfl"));
    place.run("csg pin.csg -o pin.lfl --like cube.lfl").good();
    place.run("difference cube.lfl pin.lfl -o bored.lfl").good();
    let (lower, upper) = volume(&place, "bored.lfl");
    let truth = 8.0 - PI * 0.25 * 2.0;
    assert!(lower < truth && truth < upper && upper - lower < 2.0, "{lower} {upper}");
    place.run("voxelize slab.stl -o no.lfl --like cube.lfl --bounds 0,0,0,8").bad(2, &["--like", "--bounds"]);
    place.run("voxelize slab.stl -o no.lfl --like cube.stl").bad(1, &["cube.stl"]);
    place.run("csg pin.csg -o sharp.lfl --surfaces").good();
    place.run("voxelize slab.stl -o no.lfl --like sharp.lfl").bad(2, &["sharp.lfl", "--surfaces", "--depth"]);
    place.run("voxelize slab.stl -o coarse.lfl --depth 4").good();
    place.run("union cube.lfl coarse.lfl -o no.lfl").bad(1, &["another frame", "voxelize --like cube.lfl"]);
}

/// Two revisions of a part in one command; and whatever has a shape is an operand.
#[test]
fn set_operations_take_files_of_any_kind() {
    let place = solids();
    place.write("new.stl", stl(&block([1.0; 3], [3.0, 3.0, 4.0])));
    place.run("xor cube.stl new.stl -o changes.lfl").good();
    assert_eq!(volume(&place, "changes.lfl"), (4.0, 4.0));
    place.run("complement cube.stl -o around.lfl --depth 5").good();
    // On the frame of a solid.
    place.run("union cube.lfl slab.stl -o both.lfl").good();
    place.run("union cube.lfl slab.lfl -o same.lfl").good();
    assert_eq!(place.bytes("both.lfl"), place.bytes("same.lfl"));
    place.run("union cube.stl slab.lfl -o other.lfl").good();
    assert_eq!(volume(&place, "other.lfl"), volume(&place, "same.lfl"));
    // Moved, and in another unit.
    place.run("difference cube.stl cube.stl --translate 1,0,0 -o half.lfl").good();
    assert_eq!(volume(&place, "half.lfl"), (4.0, 4.0));
    place.run("union cube.stl slab.stl -o mm.lfl --unit cm --to-unit mm").good();
    assert_eq!(place.run("info mm.lfl --json").good().json()["metadata"]["units"], "mm");
    // A scene, and voxels.
    place.write("pin.csg", "translate([2, 2, 0]) cylinder(h = 4, r = 0.5);");
    place.run("difference cube.stl pin.csg -o bored.lfl --depth 6").good();
    let (lower, upper) = volume(&place, "bored.lfl");
    assert!(lower < 8.0 - PI * 0.5 && 8.0 - PI * 0.5 < upper && upper - lower < 0.5, "{lower} {upper}");
    place.run("bitmap cube.lfl -o cube.nrrd").good();
    place.run("xor cube.nrrd new.stl -o voxels.lfl").good();
    assert_eq!(volume(&place, "voxels.lfl"), (4.0, 4.0));
    place.run("difference new.stl cube.nrrd -o rest.lfl --bounds 0,0,0,8 --depth 4").good();
    assert_eq!(volume(&place, "rest.lfl"), (4.0, 4.0));
    // Surfaces stay.
    place.run("csg pin.csg -o pin.lfl --surfaces --bounds 0,0,0,8").good();
    let run = place.run("difference pin.lfl slab.stl -o kept.lfl");
    assert!(
        run.code == Some(0) && run.errors.contains("slab.stl: note: its surface is kept in layers"),
        "{run:?}"
    );
    let (lower, upper) = volume(&place, "kept.lfl");
    let truth = PI * 0.25 * 4.0 - PI * 0.25 / 4.0 * 2.0;
    assert!(lower <= truth && truth <= upper && upper - lower < 0.01, "{lower} {truth} {upper}");

    place.run("union cube.lfl slab.stl -o no.lfl --depth 6").bad(2, &["--depth", "cube.lfl"]);
    place.run("dexelize cube.stl -o dexels.lfl --resolution 16").good();
    place.run("union dexels.lfl cube.stl -o no.lfl").bad(1, &["cube.stl", "`leafless convert`"]);
    place.run("union cube.lfl slab.stl -o out.lfl --unit mm --fill positive").good();
}

/// This cut with that, as a mesh in one command.
#[test]
fn set_operations_make_meshes() {
    let place = solids();
    place.write("pin.csg", "translate([2, 2, 0]) cylinder(h = 4, r = 0.5);");
    let bored = 8.0 - PI * 0.5;
    for (line, volume) in [
        ("difference cube.stl pin.csg -o out.stl --bounds 0,0,0,4 --depth 6", bored),
        ("difference cube.stl pin.csg -o out.ply", bored),
        ("difference cube.stl pin.csg -o out.stl", bored),
        ("union cube.stl slab.stl -o out.obj", 39.0),
        ("intersection cube.stl slab.stl -o out.off", 1.0),
        ("xor cube.stl slab.stl -o out.3mf --unit mm --bounds -1.1,-1.2,-1.3,8", 38.0),
    ] {
        let told = place.run(line);
        // (An STL has less room for digits.)
        let told = if line.contains("-o out.stl") { told } else { told.good() };
        assert!(told.code == Some(0) && told.text().contains("closed"), "{told:?}");
        let output = line.split("-o ").nth(1).unwrap().split(' ').next().unwrap();
        let info = place.run(&format!("info {output} --json")).good().json();
        let found = info["volume"].as_f64().unwrap();
        assert!((found / volume - 1.0).abs() < 0.03, "{line}: {found} {volume}");
    }
    place.run("difference cube.lfl slab.stl -o no.stl").bad(2, &["no.stl", "cube.lfl", "`leafless mesh`"]);
    place.run("complement cube.stl -o no.stl").bad(2, &["no.stl", "complement"]);
    place.run("difference cube.stl slab.stl -o no.stl --plain").bad(2, &["no.stl", "--plain"]);
    for line in ["voxelize cube.stl --depth 4", "csg pin.csg --depth 4", "dexelize cube.stl"] {
        place.run(&format!("{line} -o no.stl")).bad(2, &["no.stl", "a mesh", "`leafless mesh`"]);
    }
    assert!(!place.files().contains(&"no.stl".to_owned()));
}

/// A volume whose samples the middle of their type does not part.
#[test]
fn thresholds_come_from_the_histogram() {
    let place = Place::new();
    let samples = |x: usize| if (4..12).contains(&x) { 1200u16 } else { 90 + x as u16 };
    let bytes: Vec<u8> = (0..16 * 16 * 16).flat_map(|k| samples(k % 16).to_le_bytes()).collect();
    place.write("ct.raw", &bytes);
    let raw = "ct.raw --extents 16,16,16 --type u16";
    let run = place.run(&format!("voxelize {raw} -o ct.lfl"));
    assert_eq!((run.code, run.errors.lines().count()), (Some(0), 1), "{run:?}");
    let words = ["ct.raw: note: its samples range from 90 to 1200", "32767.5", "--threshold"];
    assert!(words.iter().all(|word| run.errors.contains(word)), "{run:?}");
    assert_eq!(volume(&place, "ct.lfl"), (2048.0, 2048.0));
    place.run(&format!("voxelize {raw} -o ct.lfl --threshold 1000")).good();
    assert_eq!(volume(&place, "ct.lfl"), (2048.0, 2048.0));
    let info = place.run(&format!("info {raw} --threshold 500")).good();
    assert!(info.text().contains("samples of type u16: from 90 to 1200, inside from 500 on"), "{info:?}");
    let info = place.run(&format!("info {raw} --threshold 500 --json")).good().json();
    assert_eq!((&info["range"], &info["threshold"]), (&serde_json::json!([90.0, 1200.0]), &500.0.into()));
    // Without a word what it is, it is no mesh.
    place.run("info ct.raw").bad(1, &["ct.raw", "no mesh", "8192 bytes", "--extents"]);
    place.write("ct.dat", &bytes);
    place.run("info ct.dat").bad(1, &["ct.dat", "no mesh", "--extents"]);
}

#[test]
fn cad_models_are_refused_with_what_to_do() {
    let place = Place::new();
    place.write("part.STEP", "ISO-10303-21;\nHEADER;\n");
    place.write("part.txt", "ISO-10303-21;\nHEADER;\n");
    place.write("part.stp", "nobody knows");
    for file in ["part.STEP", "part.txt", "part.stp"] {
        place
            .run(&format!("info {file}"))
            .bad(1, &[file, "STEP", "export a mesh", "STL", "open_cascade.cpp"]);
    }
    place.write("part.scad", "size = 3;\ncube(size);\n");
    place.run("measure part.scad").bad(1, &["part.scad", "`openscad -o part.csg part.scad`"]);
    place.write("plain.scad", "rotate([0, 0, 90]) translate([1, 2, 3]) cube([1, 2, 3]);\n");
    let told = place.run("measure plain.scad --json").good().json();
    let (lower, upper) = ends(&told["volume"]);
    assert!(lower <= 6.0 && 6.0 <= upper && upper - lower < 1e-9, "{told}");
    for (axis, end) in [-2.0, 2.0, 6.0].into_iter().enumerate() {
        assert!((told["max"]["upper"][axis].as_f64().unwrap() - end).abs() < 1e-6, "{told}");
    }
}

/// A box with a crack of 1e-9 along one of its faces.
fn cracked() -> TriangleMesh {
    let whole = block([0.0; 3], [3.0, 2.0, 1.0]);
    let facets = whole.triangles().iter().enumerate().map(|(at, triangle)| {
        triangle.map(|vertex| whole.vertices()[vertex as usize].map(|c| if at < 2 { c + 1e-9 } else { c }))
    });
    TriangleMesh::from_facets(facets).unwrap()
}

#[test]
fn measure_and_info_agree() {
    let place = meshes();
    let report = |line: &str| place.run(line).good().json();
    for axis in 0..3 {
        let [info, told] = ["info", "measure"].map(|command| report(&format!("{command} slab.stl --json")));
        for side in ["min", "max"] {
            assert_eq!(told[side]["lower"][axis], info[side][axis]);
            assert_eq!(told[side]["upper"][axis], info[side][axis]);
        }
    }
    // Hair cracks are closed, and everything is known but for the distance.
    let mut obj = String::new();
    let mesh = cracked();
    for vertex in mesh.vertices() {
        obj += &format!("v {} {} {}\n", vertex[0], vertex[1], vertex[2]);
    }
    for triangle in mesh.triangles() {
        obj += &format!("f {} {} {}\n", triangle[0] + 1, triangle[1] + 1, triangle[2] + 1);
    }
    place.write("cracked.obj", &obj);
    let told = report("measure cracked.obj --json");
    let moved = told["area_displacement"].as_f64().unwrap();
    assert!(moved > 0.0 && moved < 1e-8, "{told}");
    let (lower, upper) = ends(&told["area"]);
    assert!((lower - 22.0).abs() < 1e-7 && (upper - 22.0).abs() < 1e-7, "{told}");
    for (axis, end) in [3.0, 2.0, 1.0].into_iter().enumerate() {
        let [low, high] = ["lower", "upper"].map(|side| told["max"][side][axis].as_f64().unwrap());
        assert!(low <= end && end <= high && high - low < 1e-8, "{told}");
    }
    let told = place.run("measure cracked.obj").good();
    assert!(told.text().contains("of the mesh with hair cracks closed: vertices were moved by"), "{told:?}");
    // The same in a scene.
    place.write("scene.csg", "import(\"cracked.obj\");");
    let info = report("info scene.csg --json");
    assert_eq!(info["meshes"][0]["closed"], true, "{info}");
    let told = report("measure scene.csg --json");
    assert!(
        told["area_displacement"].as_f64().unwrap() > 0.0 && (ends(&told["area"]).1 - 22.0).abs() < 1e-7,
        "{told}"
    );
    assert!((told["max"]["upper"][0].as_f64().unwrap() - 3.0).abs() < 1e-8, "{told}");
}

/// The figures of the part of the trial: 12.81 ± 0.12 for 12.7, and an area that was not known.
#[test]
fn real_parts_have_bounds_and_areas() {
    let place = Place::new();
    for (name, area) in [("plate_holes.STL", 133_343.411), ("featuretype.STL", 0.0)] {
        let Some(path) = model(name) else { continue };
        place.write("part.stl", std::fs::read(path).unwrap());
        let [info, told] =
            ["info", "measure"].map(|command| place.run(&format!("{command} part.stl --json")).good().json());
        for (axis, side) in (0..3).flat_map(|axis| [(axis, "min"), (axis, "max")]) {
            let [low, high] = ["lower", "upper"].map(|end| told[side][end][axis].as_f64().unwrap());
            let vertex = info[side][axis].as_f64().unwrap();
            assert!(
                low <= vertex && vertex <= high && high - low < 1e-12,
                "{name} {axis} {side}: {low} {vertex} {high}"
            );
        }
        let (lower, upper) = ends(&told["area"]);
        assert!(upper - lower < 1e-6 * upper && upper > 0.0, "{name}: {told}");
        assert!(area == 0.0 || (lower - area).abs() < 0.01, "{name}: {told}");
    }
}

#[test]
fn a_density_makes_a_mass() {
    let place = meshes();
    let plain = place.run("measure cube.stl --json").good().json();
    assert_eq!((&plain["mass"], &plain["mass_unit"]), (&Value::Null, &"".into()));
    let told = place.run("measure cube.stl --json --density 2.5").good().json();
    let (lower, upper) = ends(&told["mass"]);
    assert!(lower <= 20.0 && 20.0 <= upper && upper - lower < 1e-12, "{told}");
    let inertia = |told: &Value| told["inertia"]["lower"][0][0].as_f64().unwrap();
    assert!((inertia(&told) / inertia(&plain) - 2.5).abs() < 1e-12);
    // Eight cubic centimetres of steel.
    let told = place.run("measure cube.stl --unit cm --density 7.85g/cm3").good();
    assert!(told.text().contains("mass            62.79") && told.text().contains(" g\n"), "{told:?}");
    let told = place.run("measure cube.stl --unit in --density 7850kg/m3 --json").good().json();
    let (lower, upper) = ends(&told["mass"]);
    assert!((lower / (8.0 * 2.54f64.powi(3) * 7.85) - 1.0).abs() < 1e-12 && lower <= upper, "{told}");
    place.run("measure cube.stl --density 7.85g/cm3").bad(2, &["--density", "--unit mm"]);
    place.run("measure cube.stl --density 7.85oz").bad(2, &["--density", "g/cm3"]);
}

/// A file says of its making what is true: what was certified of a sampled solid is as sampled as that.
#[test]
fn the_rule_of_a_file_is_true() {
    let place = meshes();
    place.run("voxelize cube.stl -o sampled.lfl --depth 4 --rule sampled").good();
    place.write("again.csg", "octree(\"sampled.lfl\");");
    for (line, rule) in [
        ("csg again.csg -o again.lfl --depth 4", "sampled"),
        ("csg again.csg -o again.lfl --depth 4 --rule inner", "inner"),
    ] {
        let told = place.run(line).good();
        assert!(told.text().contains(&format!("{rule} octree of depth 4")), "{told:?}");
        assert_eq!(place.run("info again.lfl --json").good().json()["metadata"]["rule"], rule);
    }
    place.write("cube.csg", "mesh(\"cube.stl\");");
    place.run("csg cube.csg -o cube.lfl --depth 4").good();
    assert_eq!(place.run("info cube.lfl --json").good().json()["metadata"]["rule"], "certified");
}

/// Long work reports its progress, and ends after the time that the user gives.
#[test]
fn nothing_is_silent_for_long() {
    let place = Place::new();
    // Twelve turned boxes, of which no face is a plane of the lattice.
    let mut text = String::from("intersection() { sphere(9);\nunion() {\n");
    for k in 0..12 {
        let angle = 7 * k + 3;
        text += &format!(
            "rotate([{angle}, {}, {k}]) translate([{k}, 1, 0]) cylinder(h = 5, r1 = 2, r2 = 1);\n",
            2 * angle
        );
    }
    place.write("part.csg", text + "}}");
    let line = "measure part.csg --tolerance 0 --seconds 7 --json";
    let start = std::time::Instant::now();
    let output = place.command(line.split(' ')).output().unwrap();
    let (time, errors) = (start.elapsed().as_secs_f64(), String::from_utf8(output.stderr).unwrap());
    assert!(output.status.success(), "{errors}");
    assert!((6.0..60.0).contains(&time), "{time}");
    let line = errors.lines().next().unwrap_or_default();
    assert!(line.starts_with("leafless: measure: at work for 5 s"), "{errors}");
    let told: Value = serde_json::from_slice(&output.stdout).unwrap();
    let (lower, upper) = ends(&told["volume"]);
    assert!(told["measured"] == "budget" && lower > 0.0 && upper - lower < 0.1 * upper, "{told}");
    // What needs no time takes none.
    place.write("cube.csg", "cube(2);");
    let told = place.run("measure cube.csg --seconds 30 --json").good().json();
    assert_eq!(ends(&told["volume"]), (8.0, 8.0));
    let told = place.run("interfere cube.csg part.csg --seconds 1 --json").good().json();
    assert_eq!(told["verdict"], "overlapping");
    place.run("measure cube.csg --seconds 0").bad(2, &["--seconds", "above 0"]);
}

#[test]
fn a_verdict_in_a_line() {
    let place = meshes();
    let fit = place.run("info --check cube.stl").good();
    assert!(fit.text().starts_with("cube.stl: fit: closed") && fit.text().lines().count() == 1, "{fit:?}");
    let json = place.run("info --check cube.stl --json").good().json();
    assert_eq!((&json["fit"], &json["reasons"]), (&true.into(), &serde_json::json!([])));
    let parts = |parts: &[TriangleMesh]| {
        let facets = parts.iter().flat_map(|part| {
            part.triangles().iter().map(|triangle| triangle.map(|vertex| part.vertices()[vertex as usize]))
        });
        stl(&TriangleMesh::from_facets(facets).unwrap())
    };
    let cube = block([1.0; 3], [3.0; 3]);
    let inside_out = TriangleMesh::new(
        cube.vertices().to_vec(),
        cube.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect(),
    );
    let open = TriangleMesh::new(cube.vertices().to_vec(), cube.triangles()[1..].to_vec()).unwrap();
    let sheet = |flip: bool| {
        let triangle = if flip { [0, 2, 1] } else { [0, 1, 2] };
        TriangleMesh::new(vec![[9.0, 0.0, 0.0], [9.0, 1.0, 0.0], [9.0, 0.0, 1.0]], vec![triangle]).unwrap()
    };
    for (name, bytes, words) in [
        ("open.stl", stl(&open), "open along 3 edges in 1 loop"),
        (
            "crossing.stl",
            parts(&[cube.clone(), block([2.0; 3], [4.0, 4.0, 4.5])]),
            "pairs of triangles intersect",
        ),
        ("within.stl", parts(&[cube.clone(), block([1.5; 3], [2.0; 3])]), "overlap another"),
        ("turned.stl", stl(&inside_out.unwrap()), "inside out"),
        ("thin.stl", parts(&[cube.clone(), sheet(false), sheet(true)]), "1 wall has no thickness"),
    ] {
        place.write(name, bytes);
        place.run(&format!("info --check {name}")).bad(1, &[name, "not fit: ", words]);
        let run = place.run(&format!("info {name} --check --json"));
        assert!(run.code == Some(1) && run.json()["fit"] == false && run.errors.contains(words), "{run:?}");
    }
    place.write("part.csg", "cube(1);");
    place.run("info --check part.csg").bad(2, &["--check", "meshes", "part.csg"]);
}

/// Sampled vertices make a mesh too large, which is told.
#[test]
fn a_shrunken_mesh_says_how_far_it_is_off() {
    let place = balls();
    let run = place.run("mesh ball.lfl -o ball.ply --method shrink --resolve outer");
    assert_eq!(run.code, Some(0), "{run:?}");
    assert!(run.errors.contains("warning: the surface by --method shrink has a volume of"), "{run:?}");
    place.write("ball.stl", place.bytes("ball.ply"));
    let run = place.run("mesh ball.stl -o again.ply --method shrink --depth 4");
    assert!(run.errors.contains("and the solid one from"), "{run:?}");
    place.run("mesh ball.stl -o again.ply --method mc --depth 4").good();
}

/// Options have one meaning, and the help has headings.
#[test]
fn options_have_one_meaning_and_the_help_has_headings() {
    let place = meshes();
    place.run("voxelize cube.stl -o cube.lfl --depth 4 --unit in --to-unit mm").good();
    place.run("voxelize cube.stl -o cube.lfl --depth 4 --to mm").bad(2, &["--to"]);
    for command in ["voxelize", "info", "convert", "union", "render"] {
        let help = place.run(&format!("{command} --help")).good();
        for heading in ["Meshes (STL, OBJ, PLY, OFF, 3MF):", "Volumes (NRRD, MetaImage, raw):", "Options:"] {
            assert!(help.text().contains(heading), "{heading} {help:?}");
        }
        assert!(help.text().contains("--to-unit") && help.text().contains("--extents"), "{help:?}");
    }
}
