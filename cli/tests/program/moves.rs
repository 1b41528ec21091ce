//! Inputs are moved: by each option, in the order of the command line, at each command that reads them.

use crate::place::{Place, block, meshes, solids, stl};
use serde_json::Value;

/// Returns the bounds of the volume in a report.
fn volume(report: &Value) -> (f64, f64) {
    let end = |name: &str| report["volume"][name].as_f64().unwrap();
    (end("lower"), end("upper"))
}

#[track_caller]
fn holds(report: &Value, truth: f64, width: f64) {
    let (lower, upper) = volume(report);
    assert!(lower <= truth && truth <= upper && upper - lower <= width, "{lower} to {upper}, not {truth}");
}

/// Returns the lowest and highest corner of a file's mesh.
fn corners(place: &Place, file: &str) -> [Vec<f64>; 2] {
    let info = place.run(&format!("info {file} --json")).good().json();
    ["min", "max"].map(|end| {
        let corner = info[end].as_array().unwrap();
        corner.iter().map(|x| x.as_f64().unwrap()).collect()
    })
}

#[test]
fn moves_act_in_the_order_of_the_command_line() {
    let place = meshes();
    // The slab is [2, 6] x [2, 6] x [0, 2].
    for (moves, min, max) in [
        ("--translate 10,0,0 --rotate z,90", [-6.0, 12.0, 0.0], [-2.0, 16.0, 2.0]),
        ("--rotate z,90 --translate 10,0,0", [4.0, 2.0, 0.0], [8.0, 6.0, 2.0]),
        ("--scale 2 --translate 1,0,0 --scale 1,1,-1", [5.0, 4.0, -4.0], [13.0, 12.0, 0.0]),
        ("--translate 1,0,0 --scale 2 --translate -1,0,0", [5.0, 4.0, 0.0], [13.0, 12.0, 4.0]),
        ("--rotate x,-90 --place 1,0,0,1,0,1,0,2,0,0,1,3", [3.0, 2.0, -3.0], [7.0, 4.0, 1.0]),
        (
            "--rotate=-1,0,0,90 --place=[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]",
            [3.0, 2.0, -3.0],
            [7.0, 4.0, 1.0],
        ),
    ] {
        // A mesh becomes a mesh with its own triangles.
        let report = place.run(&format!("convert slab.stl -o out.obj {moves} --json")).good().json();
        assert_eq!((&report["triangles"], &report["method"]), (&12.into(), &"copy".into()), "{moves}");
        assert!(report["closed"] == true && report["volume"].as_f64().unwrap() > 0.0, "{moves}: {report}");
        assert_eq!(corners(&place, "out.obj"), [min.to_vec(), max.to_vec()], "{moves}");
    }
    // Rotated by thirty degrees and back.
    place.run("convert slab.stl -o out.obj --rotate 1,1,0,30 --rotate 1,1,0,-30").good();
    let [min, max] = corners(&place, "out.obj");
    let off = min.iter().zip([2.0, 2.0, 0.0]).chain(max.iter().zip([6.0, 6.0, 2.0]));
    assert!(off.into_iter().all(|(x, truth)| (x - truth).abs() < 1e-14), "{min:?} {max:?}");
}

#[test]
fn quarter_turns_are_exact() {
    let place = Place::new();
    place.write("slab.stl", stl(&block([2.0, 3.0, 0.0], [6.0, 6.0, 2.0])));
    place.write("cube.stl", stl(&block([-2.0; 3], [2.0; 3])));
    place.write("cube.csg", "cube(4, center = true);");
    // The cube maps onto itself, and the bytes stay the same.
    for line in ["voxelize cube.stl -o out.lfl --depth 6", "csg cube.csg -o out.lfl --depth 6"] {
        place.run(line).good();
        let direct = place.bytes("out.lfl");
        for moves in ["--rotate z,90", "--rotate x,-180 --rotate y,270", "--rotate 0,0,3,450"] {
            place.run(&format!("{line} {moves}")).good();
            assert!(place.bytes("out.lfl") == direct, "{line} {moves}");
        }
    }
    // Rotated octree cells equal the cells of the rotated mesh.
    place.run("voxelize slab.stl -o slab.lfl --depth 5 --bounds -8,-8,-8,16").good();
    place.run("convert slab.lfl -o moved.lfl --rotate z,90 --translate 1,0,0").good();
    place.run("convert slab.stl -o turned.stl --rotate z,90 --translate 1,0,0").good();
    place.run("voxelize turned.stl -o turned.lfl --depth 5 --bounds -7,-8,-8,16").good();
    place
        .run("voxelize slab.stl -o again.lfl --rotate z,90 --translate 1,0,0 --depth 5 --bounds -7,-8,-8,16")
        .good();
    for other in ["turned", "again"] {
        place.run(&format!("xor moved.lfl {other}.lfl -o none.lfl")).good();
        assert_eq!(volume(&place.run("info none.lfl --json").good().json()), (0.0, 0.0));
    }
}

#[test]
fn volumes_hold_the_truth_where_things_are_moved() {
    let place = solids();
    place.write("ball.csg", "sphere(1, $fn = 0);");
    let ball = 4.0 / 3.0 * std::f64::consts::PI;
    for (line, truth, width) in [
        ("measure cube.stl --rotate 1,2,3,40 --translate 0.1,0.2,0.3", 8.0, 1e-9),
        ("measure cube.stl --scale 1,2,0.5", 8.0, 1e-9),
        ("measure ball.csg --scale 1,2,3 --rotate z,30", 6.0 * ball, 0.3),
        // A solid from a file is known only by its cells, which is enough here.
        ("measure cube.lfl --rotate z,30", 8.0, 0.1),
        ("measure cube.lfl --rotate z,90 --translate 3,0,0", 8.0, 0.0),
        ("measure cube.lfl --scale 2,2,2", 64.0, 0.0),
        ("measure cube.lfl --place 1,0.5,0,0,0,1,0,0,0,0,1,0", 8.0, 0.1),
        ("voxelize cube.stl -o out.lfl --depth 6 --rotate z,30", 8.0, 2.0),
        ("csg ball.csg -o out.lfl --depth 6 --scale 1,2,3", 6.0 * ball, 9.0),
        ("convert cube.lfl -o out.lfl --rotate z,30", 8.0, 7.0),
        ("convert cube.lfl -o out.lfl --to octree --translate 0.1,0,0", 8.0, 3.0),
        ("convert cube.lfl -o out.lfl --rotate z,30 --bounds -4,-4,-4,8 --resolution 64", 8.0, 6.0),
    ] {
        holds(&place.run(&format!("{line} --json")).good().json(), truth, width);
    }
    // A mesh of the moved surface. Its volume is the solid's.
    for line in
        ["mesh cube.lfl -o out.ply --rotate z,30", "mesh ball.csg -o out.ply --depth 5 --translate 9,0,0"]
    {
        let report = place.run(&format!("{line} --json")).good().json();
        assert!(report["closed"] == true, "{report}");
    }
    // (No vertex need lie at the very pole.)
    assert!((8.0..8.001).contains(&corners(&place, "out.ply")[0][0]));
    // Sampled cells stay decided.
    place.run("voxelize cube.stl -o sampled.lfl --depth 5 --bounds 0,0,0,8 --rule sampled").good();
    place.run("convert sampled.lfl -o out.lfl --rotate z,30").good();
    let info = place.run("info out.lfl").good();
    assert!(info.text().contains("every cell is decided"), "{info:?}");
}

/// The cubes [1, 3]³ and the box [2, 6] x [2, 6] x [0, 2].
#[test]
fn set_operations_move_the_file_before_the_option() {
    let place = solids();
    let made = |line: &str| {
        place.run(&format!("{line} -o out.lfl")).good();
        volume(&place.run("info out.lfl --json").good().json())
    };
    assert_eq!(made("difference cube.lfl slab.lfl"), (7.0, 7.0));
    assert_eq!(made("difference cube.lfl slab.lfl --translate -1,-1,0"), (4.0, 4.0));
    assert_eq!(made("difference cube.lfl slab.lfl --rotate z,90 --translate 5,-1,0"), (4.0, 4.0));
    assert_eq!(made("difference cube.lfl --translate 3,3,0 slab.lfl"), (8.0 - 4.0, 8.0 - 4.0));
    assert_eq!(made("union cube.lfl cube.lfl --translate 1,0,0 cube.lfl --translate 3,0,0"), (20.0, 20.0));
    let (lower, upper) =
        made("intersection cube.lfl cube.lfl --translate -2,-2,0 --rotate z,45 --translate 2,2,0");
    let octagon = 8.0 * (2f64.sqrt() - 1.0) * 2.0;
    assert!(lower < octagon && octagon < upper, "{lower} to {upper}");
    // Onto the frame of the first file, whatever its own frame is.
    place.run("voxelize cube.stl -o other.lfl --depth 4 --bounds -4,-4,-4,16").good();
    place.run("union cube.lfl other.lfl -o out.lfl").bad(1, &["other.lfl", "another frame"]);
    assert_eq!(made("union cube.lfl other.lfl --translate 2,0,0"), (16.0, 16.0));
    place
        .run("union --translate 1,0,0 cube.lfl slab.lfl -o no.lfl")
        .bad(2, &["--translate", "before the files"]);
    // Parts moved out of the frame are missing, and the program reports it.
    let run = place.run("union cube.lfl slab.lfl --translate 4,0,0 -o out.lfl");
    assert!(run.code == Some(0) && run.errors.contains("slab.lfl: warning"), "{run:?}");
}

#[test]
fn channels_and_tri_dexel_models_come_along() {
    let place = solids();
    place.run("attribute cube.lfl -o warm.lfl --name heat --expr x").good();
    place.run("convert warm.lfl -o moved.lfl --translate 2,0,0").good();
    let told = place.run_with("sample moved.lfl --name heat", b"3.6 2 2\n4.4 2 2\n").good();
    let stays = place.run_with("sample warm.lfl --name heat", b"1.6 2 2\n2.4 2 2\n").good();
    assert_eq!(told.text(), stays.text());
    place.run("union cube.lfl warm.lfl --rotate z,90 --translate 6,0,0 -o both.lfl").good();
    assert!(place.run("info both.lfl").good().text().contains("heat"));
    place.run("dexelize cube.stl -o model.lfl --resolution 32 --normals 32 --bounds 0,0,0,8").good();
    let moved =
        place.run("convert model.lfl -o moved.lfl --rotate z,90 --translate 4,0,0 --json").good().json();
    assert!((moved["volume"].as_f64().unwrap_or(8.0) - 8.0).abs() < 0.1, "{moved}");
    place.run("verify moved.lfl").good();
    place.run("difference model.lfl model.lfl --translate 1,0,0 -o rest.lfl").good();
    let rest = place.run("mesh rest.lfl -o rest.stl --json").good().json();
    assert!((rest["volume"].as_f64().unwrap() - 4.0).abs() < 0.2, "{rest}");
}

/// A volume is moved with its samples.
#[test]
fn volumes_are_moved() {
    let place = Place::new();
    place.write("full.raw", [255u8; 8]);
    let volume_of = |line: &str| {
        place.run(line).good();
        volume(&place.run("info out.lfl --json").good().json())
    };
    let raw = "full.raw -o out.lfl --extents 2,2,2";
    assert_eq!(volume_of(&format!("voxelize {raw} --rotate x,90 --translate 0,0,1")), (8.0, 8.0));
    let (lower, upper) = volume_of(&format!("voxelize {raw} --rotate z,45 --depth 6"));
    assert!((lower - 8.0).abs() < 0.5 || lower <= 8.0 && 8.0 <= upper, "{lower} to {upper}");
    let mesh = place.run("mesh full.raw -o out.ply --extents 2,2,2 --translate 0,0,5").good();
    assert!(!mesh.text().is_empty() && corners(&place, "out.ply")[0][2] >= 4.0);
}

/// Undecided cells of a mesh keep layers of its surface, moved or not.
#[test]
fn meshes_keep_surfaces() {
    let place = Place::new();
    place.write("cube.stl", stl(&block([-1.1; 3], [2.2; 3])));
    // (In single precision, as in the file.)
    let truth = (f64::from(2.2f32) + f64::from(1.1f32)).powi(3);
    for moves in ["", "--rotate 1,1,0,30 --scale 1,1,2"] {
        let made =
            place.run(&format!("voxelize cube.stl -o out.lfl --surfaces=1e-2 {moves} --json")).good().json();
        let truth = if moves.is_empty() { truth } else { 2.0 * truth };
        holds(&made, truth, 0.02 * truth);
        // Planes of a coordinate are exact, others have a width.
        let kind = if moves.is_empty() { "planes" } else { "slabs" };
        assert_eq!(made["cuts"]["surfaces"][kind], 6, "{made}");
        assert!(made["depth"].as_u64().unwrap() < 12 && made["surfaces"].as_f64().unwrap() > 0.03, "{made}");
        let told = place.run("info out.lfl").good();
        assert!(told.text().contains(kind), "{told:?}");
        place.run("verify out.lfl").good();
    }
    let made = place.run("voxelize cube.stl -o out.lfl --surfaces=1e-3 --depth 5").good();
    assert!(made.text().contains("keeps   "), "{made:?}");
    place
        .run("voxelize cube.stl -o no.lfl --surfaces")
        .bad(2, &["--surfaces", "cube.stl is a mesh", "--surfaces=1e-4"]);
    place.run("voxelize cube.stl -o no.lfl --surfaces=1e-4 --rule inner").bad(2, &["--surfaces", "--rule"]);
    place.run("voxelize cube.stl -o no.lfl --surfaces=2").bad(2, &["--surfaces", "above 0"]);
    place.write("full.raw", [255u8; 8]);
    place
        .run("voxelize full.raw -o no.lfl --extents 2,2,2 --surfaces=1e-4")
        .bad(2, &["--surfaces", "full.raw"]);
}

/// The cells of a scene keep surfaces. The scene is moved when the octree is made.
#[test]
fn scenes_keep_surfaces_where_they_are_moved() {
    let place = Place::new();
    place.write("part.csg", "difference() { cube([4, 4, 4]); sphere(1, $fn = 0); }");
    let made =
        place.run("csg part.csg -o out.lfl --surfaces --rotate 1,1,1,40 --scale 2 --json").good().json();
    let truth = 8.0 * (64.0 - std::f64::consts::PI / 6.0);
    holds(&made, truth, 0.01);
    assert!(made["cuts"]["surfaces"]["quadrics"] == 1, "{made}");
}

#[test]
fn what_moves_nothing_is_refused() {
    let place = solids();
    let before = place.files();
    for (moves, words) in [
        ("--translate 1,2", &["--translate", "x,y,z"][..]),
        ("--translate nan,0,0", &["--translate", "x,y,z"]),
        ("--rotate z", &["--rotate", "z,30"]),
        ("--rotate 0,0,0,30", &["--rotate", "not 0,0,0"]),
        ("--rotate z,inf", &["--rotate", "z,30"]),
        ("--scale 1,0,1", &["--scale", "none of them is 0"]),
        ("--scale 1e19 --scale 1e19", &["--scale", "2^64"]),
        ("--place 1,0,0,0,0,1,0,0,0,0,0,0", &["--place", "singular"]),
        ("--place 1,0,0,0,0,1,0,0,0,0,1", &["--place", "12 numbers"]),
        ("--place 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2", &["--place", "last row 0 0 0 1"]),
        ("--place 1,0,0,0,0,1,0,0,0,0,1,nan", &["--place", "12 numbers"]),
    ] {
        for line in [
            "voxelize cube.stl -o no.lfl --depth 4",
            "convert cube.lfl -o no.lfl",
            "mesh cube.stl -o no.stl",
            "measure cube.lfl",
            "union cube.lfl slab.lfl -o no.lfl",
        ] {
            place.run(&format!("{line} {moves}")).bad(2, words);
        }
    }
    place.run("info cube.lfl --scale 2").bad(2, &["--scale", "cube.lfl", "leafless convert"]);
    place.run("convert cube.lfl -o no.lfl --scale 2 --resolution 32").bad(2, &["--resolution", "--bounds"]);
    place.run("convert cube.lfl -o no.lfl --scale 2 --resolve inner").bad(2, &["--resolve", "cube.lfl"]);
    assert_eq!(place.files(), before);
}

#[test]
fn help_tells_of_the_moves() {
    let place = Place::new();
    for command in
        ["voxelize", "csg", "convert", "mesh", "measure", "union", "intersection", "difference", "xor"]
    {
        let help = place.run(&format!("{command} --help")).good();
        for words in [
            "--translate <X,Y,Z>",
            "--rotate <AXIS,DEGREES>",
            "--scale <S|SX,SY,SZ>",
            "--place <MATRIX>",
            "order",
        ] {
            assert!(help.text().contains(words), "{command}: {words}");
        }
    }
    let text = place.run("difference --help").good();
    assert!(text.text().contains("the file that they stand behind"), "{text:?}");
    assert!(place.run("voxelize --help").good().text().contains("--surfaces[=<TOLERANCE>]"));
}
