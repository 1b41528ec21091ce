//! Tri-dexel models with the program `leafless`: construction, combination, conversion and surfaces.

use crate::place::{Place, block, stl};
use leafless::dexel::{DexelEnds, DexelNormals};
use leafless::exchange::{MeshOptions, open_mesh};
use leafless::{TriDexel, TriangleMesh, file};
use serde_json::Value;

fn model(place: &Place, name: &str) -> TriDexel {
    file::dexels::open(place.path(name)).unwrap()
}

fn mesh(place: &Place, name: &str) -> TriangleMesh {
    open_mesh(place.path(name), &MeshOptions::default()).unwrap().mesh
}

fn json(place: &Place, line: &str) -> Value {
    place.run(&format!("{line} --json")).good().json()
}

const BOUNDS: &str = "--bounds 0,0,0,8";

/// `cube.stl`, the cube [1.1, 3.3]³, `bar.stl`, the box [2.2, 6.2] × [1.7, 2.7] × [0.6, 2.6], and models of
/// both with 64 cells along an axis.
fn models() -> Place {
    let place = Place::new();
    place.write("cube.stl", stl(&block([1.1f32; 3].map(f64::from), [3.3f32; 3].map(f64::from))));
    place.write("bar.stl", stl(&block([2.2f32, 1.7, 0.6].map(f64::from), [6.2f32, 2.7, 2.6].map(f64::from))));
    for name in ["cube", "bar"] {
        place.run(&format!("dexelize {name}.stl -o {name}.lfl --resolution 64 {BOUNDS} --normals 32")).good();
    }
    place
}

#[test]
fn a_mesh_is_dexelised() {
    let place = models();
    let report = json(&place, &format!("dexelize cube.stl -o out.lfl --resolution 64 {BOUNDS}"));
    for (key, expected) in [
        ("kind", Value::from("tri-dexel")),
        ("resolution", 64.into()),
        ("depth", 6.into()),
        ("edge", 8.0.into()),
        ("origin", vec![0.0; 3].into()),
        ("ends", "fixed".into()),
        ("normals", 0.into()),
        ("surfaces", false.into()),
        ("materials", false.into()),
        ("rule", "sampled".into()),
        ("odd_rays", 0.into()),
    ] {
        assert_eq!(report[key], expected, "{key}");
    }
    assert!(report["seconds"].as_f64().unwrap() >= 0.0);
    // Centres (k + 1/2) / 8 from 1.1 to 3.3: k from 9 to 25.
    let side = 17u64;
    assert_eq!(report["intervals"], 3 * side * side);
    assert_eq!(report["rays"], 3 * side * side);
    let directions = report["directions"].as_array().unwrap();
    assert_eq!(directions.len(), 3);
    for (direction, axis) in directions.iter().zip(["x", "y", "z"]) {
        assert_eq!(direction["axis"], axis);
        assert_eq!(direction["rays"], side * side);
        assert_eq!(direction["intervals"], side * side);
        assert_eq!(direction["odd_rays"], 0);
        assert!(direction["bytes"].as_u64().unwrap() >= 8 * side * side);
        // Rays are exact in their own direction.
        let volume = direction["volume"].as_f64().unwrap();
        let exact = (17.0f64 / 8.0).powi(2) * 2.2;
        assert!((volume - exact).abs() < 1e-5, "{volume}, not {exact}");
    }
    assert_eq!(report["bytes"], place.bytes("out.lfl").len() as u64);
    let metadata = &report["metadata"];
    assert_eq!((&metadata["name"], &metadata["rule"]), (&"cube".into(), &"sampled".into()));
    assert!(metadata["source"].as_str().unwrap().starts_with("crc32:"));
    let text =
        place.run(&format!("dexelize cube.stl -o again.lfl --resolution 64 {BOUNDS} --threads 1")).good();
    assert_eq!(text.text().lines().count(), 1);
    assert!(
        text.text().starts_with("again.lfl: tri-dexel model of 64 x 64 x 64 cells along xyz, volume about")
    );
    assert_eq!(place.bytes("again.lfl"), place.bytes("out.lfl"));
    // Through pipes.
    let piped =
        place.run_with(&format!("dexelize - -o - --resolution 64 {BOUNDS}"), &place.bytes("cube.stl"));
    assert_eq!(piped.code, Some(0), "{piped:?}");
    assert_eq!(file::dexels::from_bytes(&piped.bytes).unwrap(), model(&place, "out.lfl"));
    assert!(place.run("verify out.lfl").good().text().contains("tri-dexel model"));
}

#[test]
fn everything_can_be_stored() {
    let place = models();
    let line = "dexelize cube.stl -o all.lfl --resolution 16 --directions zx --ends double --normals 16 --surfaces \
                --material 7";
    let report = json(&place, line);
    assert_eq!((&report["ends"], &report["normals"]), (&"double".into(), &16.into()));
    assert_eq!((&report["surfaces"], &report["materials"]), (&true.into(), &true.into()));
    let axes: Vec<_> = report["directions"].as_array().unwrap().iter().map(|way| &way["axis"]).collect();
    assert_eq!(axes, ["x", "z"]);
    let model = model(&place, "all.lfl");
    let format = model.view().format();
    assert_eq!((format.ends, format.normals), (DexelEnds::Double, DexelNormals::Bits16));
    assert_eq!(model.view().directions(), [true, false, true]);
    let dexel = model.view().rays(2).unwrap().dexels([8, 8]).next().unwrap();
    assert_eq!(dexel.material, 7);
    assert!(dexel.start.surface.is_some() && dexel.end.surface != dexel.start.surface);
    assert_eq!(dexel.start.normal, Some([0.0, 0.0, -1.0]));
    for (found, exact) in [(dexel.start.at, 1.1f32), (dexel.end.at, 3.3)] {
        assert!((found - f64::from(exact)).abs() < 1e-10, "{found}");
    }
    let info = place.run("info all.lfl").good();
    assert!(info.text().contains("double ends, normals of 16 bits, surfaces, materials"), "{info:?}");
}

#[test]
fn scenes_and_volumes_are_dexelised() {
    let place = Place::new();
    place.write("ball.csg", "sphere(r = 2, $fn = 0);");
    let report = json(&place, "dexelize ball.csg -o ball.lfl --bounds -4,-4,-4,8");
    assert_eq!(report["resolution"], 256);
    let exact = 4.0 / 3.0 * std::f64::consts::PI * 8.0;
    assert!((report["volume"].as_f64().unwrap() / exact - 1.0).abs() < 1e-3);
    // The bits of a volume: a box of 2 × 1 × 1 voxels of edge 0.5.
    let mut samples = [0u8; 64];
    (samples[21], samples[22]) = (255, 255);
    place.write("box.raw", samples);
    let report = json(&place, "dexelize box.raw -o box.lfl --extents 4,4,4 --spacing 0.5");
    assert_eq!((&report["resolution"], &report["edge"]), (&4.into(), &2.0.into()));
    assert_eq!(report["metadata"]["threshold"], "127.5");
    let finer = json(&place, "dexelize box.raw -o box.lfl --extents 4,4,4 --spacing 0.5 --resolution 32");
    assert_eq!((&finer["resolution"], &finer["edge"]), (&32.into(), &2.0.into()));
}

#[test]
fn octrees_are_dexelised_exactly() {
    let place = models();
    place.run(&format!("voxelize cube.stl -o sampled.lfl --depth 6 {BOUNDS} --rule sampled")).good();
    place.run(&format!("voxelize cube.stl -o bounds.lfl --depth 6 {BOUNDS}")).good();
    let report = json(&place, "dexelize sampled.lfl -o cells.lfl");
    assert_eq!((&report["resolution"], &report["edge"]), (&64.into(), &8.0.into()));
    let cells = (17.0f64 / 8.0).powi(3);
    assert_eq!(report["volume"], cells);
    assert_eq!(report["metadata"]["rule"], "sampled");
    assert_eq!(json(&place, "dexelize sampled.lfl -o cells.lfl --resolution 64")["volume"], cells);
    place
        .run("dexelize sampled.lfl -o no.lfl --resolution 128")
        .bad(2, &["--resolution contradicts sampled.lfl", "64 cells"]);
    // On a coarser lattice, the cells 9 to 25 become the cells 5 to 12; with the cut cells, 4 to 12.
    let noted = place
        .run("dexelize sampled.lfl -o cells.lfl --resolution 32 --json")
        .noted(&["undecided", "--rule inner"]);
    assert_eq!(noted.json()["volume"], 2.25f64.powi(3));
    assert_eq!(json(&place, "dexelize sampled.lfl -o cells.lfl --resolution 32 --rule inner")["volume"], 8.0);
    assert_eq!(
        json(&place, "dexelize sampled.lfl -o cells.lfl --resolution 32 --rule outer")["volume"],
        2.25f64.powi(3)
    );
    place.run(&format!("dexelize sampled.lfl -o no.lfl {BOUNDS}")).bad(2, &["--bounds", "sampled.lfl"]);
    let noted = place.run("dexelize bounds.lfl -o open.lfl --json").noted(&[
        "bounds.lfl",
        "undecided",
        "--rule inner",
    ]);
    assert_eq!(noted.json()["metadata"]["rule"], "outer");
    // The faces at 1.1 and 3.3 cut the cells 8 and 26.
    for (rule, side) in [("inner", 17.0), ("outer", 19.0f64)] {
        let report = json(&place, &format!("dexelize bounds.lfl -o cells.lfl --rule {rule}"));
        assert_eq!(report["volume"], (side / 8.0).powi(3), "{rule}");
        assert_eq!(report["metadata"]["rule"], rule);
    }
    assert!(!place.files().contains(&"no.lfl".into()));
}

#[test]
fn rays_through_a_hole_are_odd() {
    let place = Place::new();
    // A side that faces along x lacks one of its two triangles; all else is complete.
    let whole = block([1.0; 3], [7.0; 3]);
    let open = TriangleMesh::new(whole.vertices().to_vec(), whole.triangles()[1..].to_vec()).unwrap();
    place.write("open.stl", stl(&open));
    let run = place.run(&format!("dexelize open.stl -o open.lfl --resolution 8 {BOUNDS} --json"));
    assert_eq!(run.code, Some(0));
    assert!(run.errors.contains("does not bound a solid"), "{run:?}");
    let report = run.json();
    // Half of a square of 6 × 6 rays. The rays on its diagonal lie on one side.
    let odd = report["directions"][0]["odd_rays"].as_u64().unwrap();
    assert!(odd == 15 || odd == 21, "{odd}");
    assert_eq!(report["odd_rays"], odd);
    let text = place.run(&format!("dexelize open.stl -o open.lfl --resolution 8 {BOUNDS}"));
    assert!(
        text.text().contains(&format!("{odd} rays pierce the open mesh an odd number of times")),
        "{text:?}"
    );
}

#[test]
fn what_is_cut_off_is_told() {
    let place = models();
    place.write("half.csg", "halfspace([0, 0, 1, -4]);");
    place.run("dexelize half.csg -o no.lfl --resolution 8").bad(1, &["half.csg", "--bounds"]);
    for (line, words) in [
        ("half.csg --bounds 0,0,0,8", "may extend beyond the bounds"),
        ("cube.stl --bounds 0,0,0,2", "sticks out of the bounds"),
    ] {
        let run = place.run(&format!("dexelize {line} -o out.lfl --resolution 8 --json"));
        assert_eq!(run.code, Some(0), "{run:?}");
        assert!(run.errors.contains(words) && run.errors.lines().count() == 1, "{run:?}");
        // The cube has 4 × 4 rays in each direction, 1/4 apart, from 1.1 to the upper face at 2.
        let exact = if line.starts_with("half") { 256.0 } else { 0.9 };
        let volume = run.json()["volume"].as_f64().unwrap();
        assert!((volume - exact).abs() < 1e-5, "{run:?}");
    }
    // An octree may be solid all around.
    place.run(&format!("voxelize cube.stl -o cells.lfl --depth 5 {BOUNDS} --rule sampled")).good();
    place.run("complement cells.lfl -o rest.lfl").good();
    let run = place.run("dexelize rest.lfl -o out.lfl");
    assert!(run.code == Some(0) && run.errors.contains("may extend beyond its bounds"), "{run:?}");
}

#[test]
fn models_are_combined() {
    let place = models();
    let joint = [1.1, 1.0, 1.5];
    let product = |[x, y, z]: [f64; 3]| x * y * z;
    let (cube, bar) = ([2.2; 3], [4.0, 1.0, 2.0]);
    for (operation, exact) in [
        ("union", product(cube) + product(bar) - product(joint)),
        ("intersection", product(joint)),
        ("difference", product(cube) - product(joint)),
        ("xor", product(cube) + product(bar) - 2.0 * product(joint)),
    ] {
        let run = place.run(&format!("{operation} cube.lfl bar.lfl -o out.lfl")).good();
        assert!(run.text().contains("of 2 tri-dexel models, volume about"), "{run:?}");
        let info = json(&place, "info out.lfl");
        for direction in info["directions"].as_array().unwrap() {
            let volume = direction["volume"].as_f64().unwrap();
            assert!((volume - exact).abs() < 0.12 * exact, "{operation}: {volume}, not {exact}");
        }
        let control = leafless::Control::default();
        let [a, b] = ["cube.lfl", "bar.lfl"].map(|name| model(&place, name));
        let (a, b) = (a.view(), b.view());
        let expected = match operation {
            "union" => a.union(b, &control),
            "intersection" => a.intersection(b, &control),
            "difference" => a.difference(b, &control),
            _ => a.xor(b, &control),
        };
        assert_eq!(model(&place, "out.lfl"), expected.unwrap(), "{operation}");
    }
    // With three operands: the points in an odd number of them, and the first without both others.
    place.run("xor cube.lfl bar.lfl bar.lfl -o out.lfl").good();
    assert_eq!(model(&place, "out.lfl"), model(&place, "cube.lfl"));
    place.run("difference cube.lfl bar.lfl cube.lfl -o out.lfl").good();
    assert_eq!(model(&place, "out.lfl").view().interval_count(), 0);
    place.run("complement cube.lfl -o rest.lfl").good();
    place.run("complement rest.lfl -o out.lfl").good();
    let again = model(&place, "out.lfl");
    assert_eq!(again.view().interval_count(), model(&place, "cube.lfl").view().interval_count());
    // Metadata of both; and a model through a pipe.
    let info = json(&place, "info rest.lfl");
    assert_eq!((&info["metadata"]["name"], &info["metadata"]["rule"]), (&"cube".into(), &"sampled".into()));
    assert!(info["metadata"].get("source").is_none());
    let piped = place.run_with("union - cube.lfl -o piped.lfl", &place.bytes("cube.lfl")).good();
    assert!(piped.text().starts_with("piped.lfl: union of 2"));
    assert_eq!(model(&place, "piped.lfl"), model(&place, "cube.lfl"));
}

#[test]
fn what_does_not_go_together_is_refused() {
    let place = models();
    place.run(&format!("voxelize cube.stl -o octree.lfl --depth 6 {BOUNDS}")).good();
    place.run(&format!("dexelize cube.stl -o fine.lfl --resolution 128 {BOUNDS}")).good();
    place.run(&format!("dexelize cube.stl -o flat.lfl --resolution 64 {BOUNDS} --directions z")).good();
    let before = place.files();
    for operation in ["union", "intersection", "difference", "xor"] {
        let to = "-o no.lfl";
        place
            .run(&format!("{operation} cube.lfl octree.lfl {to}"))
            .bad(1, &["octree.lfl: is an octree, and cube.lfl is a tri-dexel model", "leafless convert"]);
        place
            .run(&format!("{operation} octree.lfl octree.lfl cube.lfl {to}"))
            .bad(1, &["cube.lfl: is a tri-dexel model, and octree.lfl is an octree", "leafless convert"]);
        place
            .run(&format!("{operation} cube.lfl fine.lfl {to}"))
            .bad(1, &["fine.lfl", "cube.lfl", "depth 7", "depth 6", "--resolution"]);
        place
            .run(&format!("{operation} cube.lfl flat.lfl {to}"))
            .bad(1, &["flat.lfl", "cube.lfl", "rays along z", "xyz", "--directions"]);
        place.run(&format!("{operation} cube.lfl bar.lfl {to} --carry t=max")).bad(2, &["--carry"]);
    }
    // The errors of octree commands say how to make an octree.
    for line in [
        "contains cube.lfl",
        "measure cube.lfl",
        "distance cube.lfl",
        "ray cube.lfl",
        "neighbours cube.lfl",
        "bitmap cube.lfl -o no.nrrd",
        "heights cube.lfl --axis z",
        "within cube.lfl --ball 1,1,1,1",
        "interfere cube.lfl octree.lfl",
        "interfere octree.lfl cube.lfl",
        "voxels cube.lfl -o no.csv",
        "sample cube.lfl",
        "summary cube.lfl",
    ] {
        let run = place.run(line);
        run.bad(1, &["cube.lfl", "a tri-dexel model", "`leafless convert --to octree`"]);
    }
    place.run_with("measure -", &place.bytes("cube.lfl")).bad(1, &["a tri-dexel model", "leafless convert"]);
    place.run("voxelize cube.lfl -o no.lfl --depth 4").bad(1, &["cube.lfl", "is a solid already"]);
    place.run("dexelize cube.lfl -o no.lfl").bad(1, &["cube.lfl", "tri-dexel model already"]);
    for (option, words) in [
        ("--resolution 300", &["--resolution", "256 and 512"][..]),
        ("--resolution 1", &["2 is the nearest"]),
        ("--resolution 1048576", &["524288 is the nearest"]),
        ("--directions xw", &["--directions", "x, y and z"]),
        ("--ends single", &["--ends", "fixed", "double"]),
        ("--normals 8", &["--normals", "16", "32"]),
        ("--rule certified", &["--rule", "sampled", "inner", "outer"]),
        ("--material -1", &["-1"]),
        ("--bounds 1,2", &["--bounds", "four numbers"]),
    ] {
        place.run(&format!("dexelize cube.stl -o no.lfl {option}")).bad(2, words);
    }
    place.run("dexelize cube.stl -o cube.stl").bad(1, &["cube.stl", "not overwritten"]);
    place.run("dexelize none.stl -o no.lfl").bad(1, &["none.stl"]);
    place.run("dexelize cube.lfl -o no.lfl --unit in").bad(2, &["--unit", "cube.lfl is a solid"]);
    assert_eq!(place.files(), before);
}

#[test]
fn surfaces_are_closed() {
    let place = models();
    for (method, tolerance) in [("mc", 0.03), ("dual", 1e-4)] {
        for extension in ["stl", "ply", "obj"] {
            let line = format!("mesh cube.lfl -o out.{extension} --method {method}");
            let report = json(&place, &line);
            assert_eq!((&report["closed"], &report["manifold"]), (&true.into(), &true.into()), "{line}");
            assert_eq!((&report["euler"], &report["method"]), (&2.into(), &method.into()));
            // Each of 17 × 17 rays in three directions crosses twice.
            assert_eq!(report["crossings"], 6 * 17 * 17);
            for key in ["several", "without_rays", "disagreeing"] {
                assert_eq!(report[key], 0, "{line}: {key}");
            }
            assert!(report["clamped"].is_u64());
            let back = mesh(&place, &format!("out.{extension}"));
            assert!(back.report().unwrap().is_closed(), "{line}");
            let exact = 2.2f64.powi(3);
            assert!((back.volume() / exact - 1.0).abs() < tolerance, "{line}: {}", back.volume());
            assert!(back.vertices().iter().flatten().all(|&x| (1.0999..=3.3001).contains(&x)), "{line}");
        }
    }
    let text = place.run("mesh cube.lfl -o out.stl --method dual").good();
    assert!(text.text().contains("\n1,734 crossings"), "{text:?}");
    // With only one direction, half of the crossings are arbitrary.
    place.run(&format!("dexelize cube.stl -o flat.lfl --resolution 64 {BOUNDS} --directions z")).good();
    let flat = json(&place, "mesh flat.lfl -o out.stl");
    assert_eq!((&flat["crossings"], &flat["without_rays"]), (&(6 * 17 * 17).into(), &(4 * 17 * 17).into()));
    place.run("mesh flat.lfl -o no.stl --method dual").bad(1, &["flat.lfl", "no normals", "--normals 32"]);
    for option in
        ["--depth 4", BOUNDS, "--resolve inner", "--vertices midpoint", "--method smc", "--method shrink"]
    {
        let name = option.split(' ').next().unwrap();
        place
            .run(&format!("mesh cube.lfl -o no.stl {option}"))
            .bad(2, &[name, "cube.lfl", "tri-dexel model"]);
    }
    assert!(!place.files().contains(&"no.stl".into()));
}

/// Dual contouring of meshes and scenes, by way of a tri-dexel model, keeps the edges of a cube and lies on a
/// ball.
#[test]
fn dual_contouring_of_meshes_and_scenes() {
    let place = models();
    let report = json(&place, &format!("mesh cube.stl -o out.ply --method dual --depth 5 {BOUNDS}"));
    assert_eq!(report["closed"], true);
    assert!((report["volume"].as_f64().unwrap() / 2.2f64.powi(3) - 1.0).abs() < 1e-4, "{report}");
    place.write("ball.csg", "sphere(r = 2, $fn = 0);");
    let report = json(&place, "mesh ball.csg -o out.ply --method dual --depth 6 --bounds -4,-4,-4,8");
    assert_eq!((&report["closed"], &report["euler"]), (&true.into(), &2.into()));
    for [x, y, z] in mesh(&place, "out.ply").vertices() {
        // The ball falls below its tangent planes by r²/4 within r of the point of contact. A cube of edge
        // 1/8 is no wider.
        assert!(((x * x + y * y + z * z).sqrt() - 2.0).abs() < 3.0 / 64.0 / 4.0);
    }
    place.run(&format!("voxelize cube.stl -o octree.lfl --depth 5 {BOUNDS}")).good();
    place
        .run("mesh octree.lfl -o no.ply --method dual --resolve inner")
        .bad(1, &["octree.lfl", "octree", "normals", "leafless dexelize"]);
    place.run("mesh cube.stl -o no.ply --method dual --resolve inner").bad(2, &["--resolve", "dual"]);
    // Other methods report no rays.
    let plain = json(&place, &format!("mesh cube.stl -o out.ply --depth 5 {BOUNDS}"));
    assert!(plain.get("crossings").is_none());
}

#[test]
fn each_kind_becomes_each_other() {
    let place = models();
    place.write("ball.csg", "sphere(r = 2, $fn = 0);");
    // From a tri-dexel model.
    let octree = json(&place, "convert cube.lfl -o octree.lfl --to octree");
    let cells = (17.0f64 / 8.0).powi(3);
    assert_eq!((&octree["volume"]["lower"], &octree["volume"]["upper"]), (&cells.into(), &cells.into()));
    assert_eq!((&octree["binary"], &octree["depth"]), (&true.into(), &6.into()));
    assert_eq!(octree["metadata"]["rule"], "sampled");
    place.run("contains octree.lfl").good();
    let text = place.run("convert cube.lfl -o octree.lfl --to octree").good();
    assert!(text.text().starts_with("octree.lfl: octree of depth 6, volume "), "{text:?}");
    place.run("convert cube.lfl -o out.stl").good();
    assert!(mesh(&place, "out.stl").report().unwrap().is_closed());
    place.run("mesh cube.lfl -o direct.stl").good();
    assert_eq!(place.bytes("out.stl"), place.bytes("direct.stl"));
    // From an octree: exactly its cells, there and back.
    let dexels = json(&place, "convert octree.lfl -o dexels.lfl --to dexels");
    assert_eq!((&dexels["volume"], &dexels["resolution"]), (&cells.into(), &64.into()));
    place.run("convert dexels.lfl -o again.lfl --to octree").good();
    assert_eq!(file::open(place.path("again.lfl")).unwrap(), file::open(place.path("octree.lfl")).unwrap());
    place.run(&format!("voxelize cube.stl -o bounds.lfl --depth 6 {BOUNDS}")).good();
    place.run("convert bounds.lfl -o open.lfl --to dexels").noted(&["bounds.lfl", "undecided", "--resolve"]);
    let outer = json(&place, "convert bounds.lfl -o dexels.lfl --to dexels --resolve outer");
    assert_eq!(outer["volume"], (19.0f64 / 8.0).powi(3));
    assert_eq!(place.bytes("open.lfl"), place.bytes("dexels.lfl"));
    place.run("convert bounds.lfl -o out.ply --resolve inner").good();
    place.run("convert bounds.lfl -o open.ply").noted(&["bounds.lfl", "--resolve"]);
    // From meshes and scenes, like the subcommands for them.
    place.run(&format!("convert cube.stl -o out.lfl --to dexels --resolution 64 {BOUNDS}")).good();
    place.run(&format!("dexelize cube.stl -o direct.lfl --resolution 64 {BOUNDS}")).good();
    assert_eq!(place.bytes("out.lfl"), place.bytes("direct.lfl"));
    place.run(&format!("convert cube.stl -o out.lfl --to octree --resolution 64 {BOUNDS}")).good();
    assert_eq!(place.bytes("out.lfl"), place.bytes("bounds.lfl"));
    place.run("convert ball.csg -o out.lfl --to octree --resolution 16").good();
    place.run("csg ball.csg -o direct.lfl --depth 4").good();
    assert_eq!(place.bytes("out.lfl"), place.bytes("direct.lfl"));
    place.run("convert ball.csg -o out.ply --resolution 16").good();
    place.run("mesh ball.csg -o direct.ply --method mc --depth 4").good();
    assert_eq!(place.bytes("out.ply"), place.bytes("direct.ply"));
    // The unit has another name in this format.
    place.run("convert cube.stl -o out.lfl --to dexels --unit in --to-unit mm --resolution 16").good();
    assert_eq!(model(&place, "out.lfl").metadata().get("units"), Some("mm"));
    let (inches, extent) = (model(&place, "out.lfl"), 2.2 * 25.4);
    let [low, high] = inches.view().statistics(0).unwrap().extent[0];
    assert!((high - low - extent).abs() < 1e-4, "{low} {high}");
}

#[test]
fn conversions_that_mean_nothing_are_refused() {
    let place = models();
    place.run(&format!("voxelize cube.stl -o octree.lfl --depth 4 {BOUNDS}")).good();
    let before = place.files();
    for output in ["no.lfl", "-", "no", "no.txt"] {
        place
            .run(&format!("convert cube.stl -o {output}"))
            .bad(2, &["--to octree", "--to dexels", "--to mesh"]);
    }
    place.run("convert cube.stl -o no.stl --to octree").bad(2, &["no.stl", "a mesh"]);
    place.run("convert cube.stl -o no.stl --to dexels").bad(2, &["no.stl", "a mesh"]);
    place.run("convert cube.stl -o no.lfl --to mesh").bad(2, &["no.lfl", ".stl"]);
    place.run("convert cube.stl -o no.lfl --to mm").bad(2, &["--to", "octree", "dexels", "mesh"]);
    place.run("convert octree.lfl -o no.lfl --to octree").bad(1, &["octree.lfl", "an octree already"]);
    place.run("convert cube.lfl -o no.lfl --to dexels").bad(1, &["cube.lfl", "tri-dexel model already"]);
    place.run("convert - -o no.lfl --to octree").bad(1, &["standard input", "leafless voxelize"]);
    for option in ["--resolve inner", "--resolution 32", BOUNDS] {
        let name = option.split(' ').next().unwrap();
        place
            .run(&format!("convert cube.lfl -o no.lfl --to octree {option}"))
            .bad(2, &[name, "cube.lfl", "tri-dexel model"]);
    }
    place.run("convert cube.lfl -o no.lfl --to octree --unit in").bad(2, &["--unit", "cube.lfl"]);
    place
        .run("convert octree.lfl -o no.lfl --to octree --unit in --scale 2")
        .bad(2, &["--unit", "octree.lfl"]);
    let mut damaged = place.bytes("cube.lfl");
    let end = damaged.len() - 1;
    damaged[end] ^= 1;
    place.write("damaged.lfl", damaged);
    place.run("convert damaged.lfl -o no.lfl --to octree").bad(1, &["damaged.lfl"]);
    place.run("mesh damaged.lfl -o no.stl").bad(1, &["damaged.lfl"]);
    place.run("union damaged.lfl cube.lfl -o no.lfl").bad(1, &["damaged.lfl"]);
    let after: Vec<_> = place.files().into_iter().filter(|name| name != "damaged.lfl").collect();
    assert_eq!(after, before);
}

#[test]
fn damage_is_told_as_what_it_is() {
    let place = models();
    let whole = place.bytes("cube.lfl");
    let mut flipped = whole.clone();
    flipped[whole.len() - 5] ^= 4;
    place.write("cut.lfl", &whole[..whole.len() / 2]);
    place.write("flipped.lfl", &flipped);
    for line in ["verify cut.lfl", "union cube.lfl cut.lfl -o no.lfl", "mesh cut.lfl -o no.stl"] {
        place.run(line).bad(1, &["cut.lfl: ", "bytes"]);
    }
    for line in ["verify flipped.lfl", "union cube.lfl flipped.lfl -o no.lfl"] {
        place.run(line).bad(1, &["flipped.lfl: ", "checksum"]);
    }
}

/// A file with three short intervals at depth 20 takes almost no time. The output says what the commands
/// cannot see of it.
#[test]
fn depth_20_takes_no_time() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../format_spec/vectors/valid/dexel-depth-20.lfl");
    let folder = tempfile::tempdir().unwrap();
    let start = std::time::Instant::now();
    for (command, output) in
        [("convert", "o.lfl"), ("convert", "o.ply"), ("mesh", "o.stl"), ("render", "o.png")]
    {
        let output = folder.path().join(output);
        let mut arguments = vec![command, file, "-o", output.to_str().unwrap()];
        if command == "convert" && output.extension().is_some_and(|name| name == "lfl") {
            arguments.extend(["--to", "octree"]);
        }
        let done =
            std::process::Command::new(env!("CARGO_BIN_EXE_leafless")).args(&arguments).output().unwrap();
        assert!(done.status.success(), "{command}: {}", String::from_utf8_lossy(&done.stderr));
        if command != "render" {
            let told = String::from_utf8(done.stdout).unwrap();
            assert!(told.contains("1 interval between the centres of cells not seen"), "{told}");
        }
    }
    let output = folder.path().join("j.ply");
    let arguments = ["mesh", file, "--json", "-o", output.to_str().unwrap()];
    let done = std::process::Command::new(env!("CARGO_BIN_EXE_leafless")).args(arguments).output().unwrap();
    let told: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!((&told["vanished"], &told["without_centres"]), (&0.into(), &1.into()));
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

#[test]
fn materials_travel_to_octrees_records_samples_and_pictures() {
    let place = models();
    place.write("low.stl", stl(&block([1.0; 3], [7.0, 7.0, 4.0])));
    place.write("high.stl", stl(&block([1.0, 1.0, 4.0], [7.0; 3])));
    for (name, material) in [("low", 3), ("high", 8)] {
        let line =
            format!("dexelize {name}.stl -o {name}.dex --resolution 32 {BOUNDS} --material {material}");
        place.run(&line).good();
    }
    place.run("union low.dex high.dex -o both.dex").good();
    let told = place.run("convert both.dex --to octree -o both.lfl").good();
    assert!(told.text().contains("channel material"), "{told:?}");
    let sampled = place.run_with("sample both.lfl", b"2 2 2\n2 2 6\n0.1 0.1 0.1\n").good();
    assert_eq!(sampled.text(), "3\n8\nnone\n");
    place.run("voxels both.lfl -o both.csv --channel material").good();
    let records = place.bytes("both.csv");
    let records = String::from_utf8(records).unwrap();
    assert!(records.lines().next().unwrap().contains("material") || records.lines().count() > 2, "{records}");
    // In a picture each material has its colour.
    place.run("render both.dex -o both.png --size 160x120 --samples 1 --no-legend").good();
    place.run("render low.dex -o low.png --size 160x120 --samples 1 --no-legend").good();
    assert_ne!(place.bytes("both.png"), place.bytes("low.png"));
    for view in ["surface", "slice", "volume"] {
        place
            .run(&format!("render both.dex -o out.png --channel material --size 160x120 --view {view}"))
            .good();
    }
}

#[test]
fn ends_decide_cells_where_that_is_asked_for() {
    let place = models();
    // No centre of a cell of an eighth lies in the sheet.
    place.write("sheet.stl", stl(&block([1.0, 1.0, 4.08], [7.0, 7.0, 4.11])));
    place.run(&format!("dexelize sheet.stl -o sheet.dex --resolution 64 {BOUNDS}")).good();
    let centres = json(&place, "convert sheet.dex --to octree -o centres.lfl");
    let ends = json(&place, "convert sheet.dex --to octree --by-ends -o ends.lfl");
    assert_eq!((&centres["by"], &ends["by"]), (&"centres".into(), &"ends".into()));
    assert_eq!(centres["volume"]["upper"], 0.0);
    assert_eq!((&ends["volume"]["lower"], &ends["volume"]["upper"]), (&0.0.into(), &(36.0 / 8.0).into()));
    let info = place.run("info ends.lfl").good();
    assert!(info.text().contains("ends of sampled rays") && info.text().contains("nothing"), "{info:?}");
    place.run("convert sheet.stl --to octree --by-ends -o never.lfl").bad(2, &["--by-ends", "tri-dexel"]);
    place.run("convert ends.lfl --to octree --by-ends -o never.lfl").bad(2, &["--by-ends", "tri-dexel"]);
    place.run("convert sheet.dex --to mesh --by-ends -o never.ply").bad(2, &["--by-ends"]);
}

#[test]
fn the_volume_is_that_of_the_direction_with_most_rays() {
    let place = Place::new();
    // A plate: rays along x and y see its thickness in steps of a cell.
    place.write("plate.stl", stl(&block([1.0, 1.0, 3.0], [61.0, 41.0, 5.6])));
    let report = json(&place, "dexelize plate.stl -o plate.lfl --resolution 64 --bounds 0,0,0,64");
    let exact = 60.0 * 40.0 * 2.6;
    let off = |volume: &Value| (volume.as_f64().unwrap() / exact - 1.0).abs();
    assert!(off(&report["volume"]) < 1e-6, "{report}");
    let range = report["volume_range"].as_array().unwrap();
    assert!(range.iter().any(|volume| off(volume) > 0.1), "{report}");
    let told = place.run("dexelize plate.stl -o plate.lfl --resolution 64 --bounds 0,0,0,64").good();
    assert!(told.text().contains("volume about 6240 (along z, which has most rays;"), "{told:?}");
}

#[test]
fn a_model_with_normals_becomes_an_octree_with_surfaces() {
    let place = models();
    let told = place.run("voxelize cube.lfl -o surfaces.lfl --surfaces=1e-2").good();
    for words in
        ["from ends and normals", "certified of this surface, and of nothing that the model was sampled from"]
    {
        assert!(told.text().contains(words), "{words}: {told:?}");
    }
    let report = json(&place, "voxelize cube.lfl -o surfaces.lfl --surfaces=1e-2");
    assert_eq!(report["certified_of"], "surface reconstructed from a tri-dexel model");
    assert_eq!(report["metadata"]["certified of"], "surface reconstructed from a tri-dexel model");
    let (lower, upper) =
        (report["volume"]["lower"].as_f64().unwrap(), report["volume"]["upper"].as_f64().unwrap());
    // Ends and normals of a cube are exact up to the rounding of places.
    let exact = f64::from(3.3f32 - 1.1).powi(3);
    assert!(
        upper - lower < 1e-2 * exact && lower < 1.001 * exact && upper > 0.999 * exact,
        "{lower} {upper}"
    );
    assert!(report["surfaces"].as_f64().unwrap() > 0.0, "{report}");
    let cut = place.run("voxelize cube.lfl -o moved.lfl --surfaces=1e-2 --translate 1,0,0").good();
    assert!(cut.text().contains("moved.lfl"));
    // Missing data are reported.
    place.run(&format!("dexelize cube.stl -o plain.lfl --resolution 16 {BOUNDS}")).good();
    place.run("voxelize plain.lfl -o never.lfl --surfaces=1e-2").bad(1, &["no normals", "--normals 32"]);
    place.run("voxelize cube.lfl -o never.lfl --surfaces").bad(2, &["--surfaces=1e-4"]);
    place.run("voxelize surfaces.lfl -o never.lfl --surfaces=1e-2").bad(1, &["octree already"]);
    assert!(!place.path("never.lfl").exists());
}

#[test]
fn octrees_of_samples_are_moved_onto_any_lattice() {
    let place = models();
    place.run("convert cube.lfl --to octree -o cells.lfl").good();
    let before = json(&place, "info cells.lfl")["volume"]["lower"].as_f64().unwrap();
    for cells in [64, 32, 16] {
        let line = format!(
            "convert cells.lfl -o moved.lfl --rotate z,30 --translate 2,1,0 {BOUNDS} --resolution {cells}"
        );
        let report = json(&place, &line);
        let volume = report["volume"]["lower"].as_f64().unwrap();
        assert!((volume / before - 1.0).abs() < 0.1, "{cells}: {volume} {before}");
        assert_eq!(report["volume"]["upper"].as_f64().unwrap(), volume);
    }
}
