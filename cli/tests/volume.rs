//! Volumes on the command line: NRRD and MetaImage, wherever solids are asked or made.

mod place;

use place::Place;
use serde_json::Value;

/// Samples of a ball of radius 6 around (8, 7, 6) in a grid of 16 × 14 × 12 voxels with edge 1: 200 inside, 10 outside.
fn samples() -> Vec<u8> {
    let mut samples = vec![];
    for z in 0..12 {
        for y in 0..14 {
            for x in 0..16 {
                let [x, y, z] = [x, y, z].map(|i: i32| f64::from(i) + 0.5);
                let square = (x - 8.0).powi(2) + (y - 7.0).powi(2) + (z - 6.0).powi(2);
                samples.push(if square <= 36.0 { 200 } else { 10 });
            }
        }
    }
    samples
}

fn inside() -> u64 {
    samples().iter().filter(|&&sample| sample > 100).count() as u64
}

fn nrrd(spacing: &str) -> Vec<u8> {
    let header = format!(
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 16 14 12\nspacings: {spacing}\naxis mins: 0.5 0.5 0.5\n\
         units: \"mm\" \"mm\" \"mm\"\nencoding: raw\n\n"
    );
    [header.as_bytes(), &samples()].concat()
}

fn place() -> Place {
    let place = Place::new();
    place.write("ball.nrrd", nrrd("1 1 1"));
    place.write("flat.nrrd", nrrd("1 1 2"));
    let header = "ObjectType = Image\nNDims = 3\nDimSize = 16 14 12\nOffset = 0.5 0.5 0.5\nElementType = MET_UCHAR\n\
                  ElementDataFile = ball.raw\n";
    place.write("ball.mhd", header);
    place.write("ball.raw", samples());
    place
}

fn json(place: &Place, line: &str) -> Value {
    serde_json::from_slice(&place.run(line).good().bytes).unwrap()
}

fn volume(value: &Value) -> (f64, f64) {
    let of = |name: &str| value["volume"][name].as_f64().unwrap();
    (of("lower"), of("upper"))
}

#[test]
fn voxels_become_cells() {
    let place = place();
    let wanted = (inside() as f64, inside() as f64);
    for file in ["ball.nrrd", "ball.mhd"] {
        let report = json(&place, &format!("voxelize {file} -o ball.lfl --json"));
        assert_eq!((report["depth"].as_u64(), volume(&report)), (Some(4), wanted), "{report}");
        assert_eq!(volume(&json(&place, "info ball.lfl --json")), wanted);
    }
    // All samples are at least 10, and none is 201.
    let all = json(&place, "voxelize ball.nrrd -o all.lfl --threshold 10 --json");
    assert_eq!(volume(&all), (16.0 * 14.0 * 12.0, 16.0 * 14.0 * 12.0));
    let none = json(&place, "voxelize ball.nrrd -o none.lfl --threshold 201 --json");
    assert_eq!(volume(&none), (0.0, 0.0));
    // Coarser cells, and a cube of one's own.
    let (lower, upper) = volume(&json(&place, "voxelize ball.nrrd -o c.lfl --depth 3 --json"));
    assert!(lower < wanted.0 && wanted.0 < upper);
    let half = json(&place, "voxelize ball.nrrd -o h.lfl --bounds 0,0,0,16 --depth 5 --json");
    assert_eq!(volume(&half), wanted);
    place.run("voxelize flat.nrrd -o flat.lfl").bad(1, &["flat.nrrd", "--bounds", "--depth"]);
    let (lower, upper) = volume(&json(&place, "voxelize flat.nrrd -o flat.lfl --depth 6 --json"));
    assert!(lower <= 2.0 * wanted.0 && 2.0 * wanted.0 <= upper && upper - lower < 0.5 * wanted.0);
}

#[test]
fn booleans_take_volumes() {
    let place = place();
    place.run("voxelize ball.nrrd -o ball.lfl").good();
    place.run("voxelize ball.nrrd -o all.lfl --threshold 10").good();
    for operand in ["ball.nrrd", "ball.mhd", "ball.lfl"] {
        place.run(&format!("difference all.lfl {operand} -o rest.lfl")).good();
        let rest = json(&place, "info rest.lfl --json");
        let count = (samples().len() as u64 - inside()) as f64;
        assert_eq!(volume(&rest), (count, count), "{operand}");
    }
    place.run("complement ball.nrrd -o outside.lfl").good();
    place.run("union ball.lfl flat.nrrd -o none.lfl").bad(1, &["flat.nrrd"]);
    assert!(!place.files().contains(&"none.lfl".to_owned()));
}

#[test]
fn volumes_answer_like_solids() {
    let place = place();
    let measured = json(&place, "measure ball.nrrd --json");
    let (lower, upper) = volume(&measured);
    assert!(lower <= inside() as f64 && inside() as f64 <= upper && upper - lower < 1e-6, "{measured}");
    let hit = place.run_with("ray ball.nrrd", b"-4 7.1 6.1 1 0 0\n").good();
    assert!(hit.text().starts_with("6 6 -1 "), "{}", hit.text());
    let report = json(&place, "mesh ball.nrrd -o ball.ply --json");
    assert_eq!((&report["closed"], &report["euler"]), (&Value::Bool(true), &Value::from(2)));
    // A voxel's corners and edges are cut off.
    let volume = report["volume"].as_f64().unwrap();
    assert!((0.9..1.0).contains(&(volume / inside() as f64)), "{volume}");
    let flat = json(&place, "mesh flat.nrrd -o flat.off --depth 6 --json");
    assert_eq!(flat["closed"], true);
    place.run("mesh ball.nrrd -o ball.3mf").good();
    let told = place.run("info ball.nrrd").good();
    assert!(told.text().contains("NRRD volume, 16 x 14 x 12 samples of type u8"), "{}", told.text());
    assert_eq!(json(&place, "info ball.mhd --json")["extents"], serde_json::json!([16, 14, 12]));
}

#[test]
fn what_is_refused() {
    let place = place();
    place.run("voxelize ball.nrrd -o b.lfl --fill positive").bad(2, &["--fill", "ball.nrrd"]);
    place.run("measure ball.nrrd --threshold nan").bad(2, &["--threshold"]);
    place.run("csg ball.nrrd -o b.lfl --depth 4").bad(1, &["ball.nrrd", "volume"]);
    place.write("short.nrrd", &nrrd("1 1 1")[..300]);
    place.run("voxelize short.nrrd -o b.lfl").bad(1, &["short.nrrd"]);
    place.write("cube.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    place.run("info cube.off --threshold 3").bad(2, &["--threshold", "cube.off"]);
    assert!(!place.files().contains(&"b.lfl".to_owned()));
}
