//! Volumes on the command line: NRRD and MetaImage, wherever solids are queried or made.

use crate::place::Place;
use serde_json::Value;

/// Samples of a ball of radius 6 around (8, 7, 6) in a grid of 16 × 14 × 12 voxels with edge 1: 200 inside,
/// 10 outside.
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
    // All samples are at least 10, and no sample is 201.
    let all = json(&place, "voxelize ball.nrrd -o all.lfl --threshold 10 --json");
    assert_eq!(volume(&all), (16.0 * 14.0 * 12.0, 16.0 * 14.0 * 12.0));
    let none = json(&place, "voxelize ball.nrrd -o none.lfl --threshold 201 --json");
    assert_eq!(volume(&none), (0.0, 0.0));
    // Coarser cells, and a chosen cube.
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
    // Voxels that are no cubes are sampled on the cells of the solid. They reach out of the solid's cube.
    place
        .run("union ball.lfl flat.nrrd -o both.lfl")
        .noted(&["flat.nrrd", "extend beyond the frame of ball.lfl"]);
}

#[test]
fn volumes_answer_like_solids() {
    let place = place();
    let measured = json(&place, "measure ball.nrrd --json");
    let (lower, upper) = volume(&measured);
    assert!(lower <= inside() as f64 && inside() as f64 <= upper && upper - lower < 1e-6, "{measured}");
    let hit = place.run_with("ray ball.nrrd", b"-4 7.1 6.1 1 0 0\n").good();
    assert!(hit.text().starts_with("6 6 -1 "), "{}", hit.text());
    let crossing = json(&place, "mesh ball.nrrd -o ball.ply --json");
    let report = json(&place, "mesh ball.nrrd -o ball.ply --method mc --vertices midpoint --json");
    assert_eq!(report["triangles"], crossing["triangles"]);
    // The threshold is nearer to the samples inside.
    assert!(crossing["volume"].as_f64().unwrap() < 0.97 * report["volume"].as_f64().unwrap(), "{crossing}");
    // Voxels need not be cubes.
    let flat = json(&place, "mesh flat.nrrd -o flat.off --json");
    let ratio = flat["volume"].as_f64().unwrap() / crossing["volume"].as_f64().unwrap();
    assert!((ratio - 2.0).abs() < 1e-9 && flat["euler"] == 2, "{flat}");
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

/// The same samples without a header: as bytes, and as big-endian numbers of 16 bits behind a header of five
/// bytes.
#[test]
fn raw_volumes() {
    let place = place();
    let wanted = inside() as f64;
    let wide: Vec<u8> = samples().iter().flat_map(|&sample| (u16::from(sample) << 8).to_be_bytes()).collect();
    place.write("wide.bin", [&b"abcde"[..], &wide].concat());
    let bytes = "--extents 16,14,12";
    let words = "--extents 16,14,12 --type u16 --big-endian --skip 5 --spacing 1,1,1";
    for (file, options) in [("ball.raw", bytes), ("wide.bin", words)] {
        let report = json(&place, &format!("voxelize {file} -o raw.lfl {options} --json"));
        assert_eq!((report["depth"].as_u64(), volume(&report)), (Some(4), (wanted, wanted)), "{report}");
        let told = json(&place, &format!("info {file} {options} --json"));
        assert_eq!((&told["format"], &told["extents"]), (&"raw".into(), &serde_json::json!([16, 14, 12])));
        let (lower, upper) = volume(&json(&place, &format!("measure {file} {options} --json")));
        assert!(lower <= wanted && wanted <= upper && upper - lower < 1e-6);
        place.run(&format!("difference {file} ball.nrrd -o none.lfl {options}")).bad(1, &["ball.nrrd"]);
        place.run("voxelize ball.nrrd -o ball.lfl").good();
        place.run(&format!("difference {file} ball.lfl -o none.lfl {options}")).good();
        assert_eq!(volume(&json(&place, "info none.lfl --json")), (0.0, 0.0));
    }
    let moved = "--extents 16,14,12 --spacing 0.5 --corner -4,1,2.5 --threshold 10";
    let told = json(&place, &format!("info ball.raw {moved} --json"));
    assert_eq!(told["corner"], serde_json::json!([-4.0, 1.0, 2.5]));
    let (lower, upper) = volume(&json(&place, &format!("measure ball.raw {moved} --json")));
    let all = samples().len() as f64 / 8.0;
    assert!(lower <= all && all <= upper);
    place.run("info ball.raw --extents 16,14,13").bad(1, &["ball.raw"]);
    place.run("info ball.raw --extents 16,14").bad(2, &["--extents", "nx,ny,nz"]);
    place.run("info ball.raw --extents 16,14,0").bad(2, &["extents"]);
    place.run("info ball.raw --spacing 2").bad(2, &["--extents"]);
    place.run("info ball.raw --extents 16,14,12 --spacing 1,2").bad(2, &["--spacing"]);
    place.run("info ball.raw --extents 16,14,12 --type text").bad(2, &["--type"]);
    place.run("info ball.lfl --extents 16,14,12").bad(2, &["--extents", "ball.lfl"]);
}

/// Cells become voxels, and the voxels become the same cells.
#[test]
fn bitmaps() {
    let place = place();
    place.run("voxelize ball.nrrd -o ball.lfl").good();
    let told = json(&place, "bitmap ball.lfl -o cells.nrrd --json");
    assert_eq!(
        (&told["extents"], &told["inside"]),
        (&serde_json::json!([16, 16, 16]), &inside().into()),
        "{told}"
    );
    place.run("bitmap ball.lfl -o packed.nrrd --gzip").good();
    place.run("bitmap ball.lfl -o cells.raw").good();
    let read = |name: &str| place.bytes(name);
    assert!(read("packed.nrrd").len() < read("cells.nrrd").len() / 4);
    assert_eq!(read("cells.raw").len(), 4096);
    for (file, options) in [("cells.nrrd", ""), ("packed.nrrd", ""), ("cells.raw", "--extents 16,16,16")] {
        place.run(&format!("voxelize {file} -o again.lfl {options}")).good();
        place.run("xor ball.lfl again.lfl -o rest.lfl").good();
        assert_eq!(volume(&json(&place, "info rest.lfl --json")), (0.0, 0.0), "{file}");
        let [ball, again] =
            ["ball.lfl", "again.lfl"].map(|name| json(&place, &format!("info {name} --json")));
        assert_eq!((&ball["cells"], &ball["origin"]), (&again["cells"], &again["origin"]), "{file}");
    }
    // Coarser, and with undecided cells.
    place.run("bitmap ball.lfl -o coarse.raw --level 3").noted(&["ball.lfl", "--resolve"]);
    let inside = |resolve: &str| {
        let line = format!("bitmap ball.lfl -o coarse.raw --level 3 --resolve {resolve} --json");
        json(&place, &line)["inside"].as_u64().unwrap() * 8
    };
    assert!(inside("inner") < self::inside() && self::inside() < inside("outer"));
    let piped = place.run("bitmap ball.lfl -o -");
    assert_eq!((piped.code, &piped.bytes), (Some(0), &read("cells.nrrd")));
    place.run("bitmap ball.lfl -o cells").bad(2, &["cells", ".nrrd", "--write"]);
    place.run("bitmap ball.lfl -o cells.raw --gzip").bad(2, &["--gzip"]);
    place.run("bitmap ball.lfl -o cells.raw --level 5").bad(2, &["--level 5"]);
    place.run("bitmap ball.nrrd -o cells.raw").bad(1, &["ball.nrrd"]);
    place.run("complement ball.lfl -o outside.lfl").good();
    let outside = place.run("bitmap outside.lfl -o outside.raw");
    assert!(outside.code == Some(0) && outside.errors.contains("may extend"), "{outside:?}");
    assert_eq!(
        read("outside.raw").iter().filter(|&&sample| sample == 255).count() as u64,
        4096 - self::inside()
    );
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

/// A missing data file is named in the error. A link cannot lead outside the header's folder.
#[cfg(unix)]
#[test]
fn data_files() {
    let place = place();
    let header = String::from_utf8(place.bytes("ball.mhd")).unwrap();
    std::fs::create_dir(place.path("in")).unwrap();
    std::os::unix::fs::symlink("../ball.raw", place.path("in/link.raw")).unwrap();
    place.write("in/link.mhd", header.replace("ball.raw", "link.raw"));
    place.write("in/none.mhd", header.replace("ball.raw", "none.raw"));
    for line in ["info in/link.mhd", "voxelize in/link.mhd -o b.lfl", "mesh in/link.mhd -o b.ply"] {
        place.run(line).bad(1, &["in/link.mhd", "outside of the header's folder", "link"]);
    }
    place.run("info in/none.mhd").bad(1, &["in/none.raw: No such file"]);
    std::os::unix::fs::symlink("../ball.mhd", place.path("in/way.mhd")).unwrap();
    place.run("info in/way.mhd").good();
}

/// Meaningless values in a header are refused with a clear message.
#[test]
fn nonsense_in_headers() {
    let place = place();
    for (from, to, words) in [
        ("spacings: 1 1 1", "spacings: -1 1 1", "line 5: expected spacings above zero"),
        ("encoding", "endian: middle\nencoding", "line 8: expected little or big"),
    ] {
        let text: Vec<u8> = nrrd("1 1 1");
        let at = text.windows(2).position(|two| two == b"\n\n").unwrap();
        let header = String::from_utf8(text[..at].to_vec()).unwrap().replace(from, to);
        place.write("wrong.nrrd", [header.as_bytes(), &text[at..]].concat());
        place.run("info wrong.nrrd").bad(1, &["wrong.nrrd", words]);
    }
}

/// The program warns if a corner cannot be restored from any origin in a NRRD.
#[test]
fn a_rounded_corner_is_said() {
    let place = Place::new();
    place.write("cube.csg", "multmatrix([[1,0,0,2],[0,1,0,2],[0,0,1,2],[0,0,0,1]]) cube(size = [4, 4, 4]);");
    for (corner, warns) in [("0.9999999999999999", true), ("1", false), ("-1.1", false)] {
        place.run(&format!("csg cube.csg -o cube.lfl --depth 4 --bounds {corner},0,0,8")).good();
        let run = place.run("bitmap cube.lfl -o cube.nrrd --resolve inner");
        assert_eq!(run.code, Some(0), "{run:?}");
        let words = "cube.nrrd: warning: the centre of the first voxel is rounded";
        assert_eq!(run.errors.contains(words), warns, "{run:?}");
        place.run("voxelize cube.nrrd -o again.lfl").good();
        let same = place.run("union cube.lfl again.lfl -o both.lfl");
        assert_eq!(same.code == Some(0), !warns, "{same:?}");
    }
}
