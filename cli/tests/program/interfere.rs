//! The subcommand `leafless interfere`, from outside.

use leafless::{Control, Csg, Frame, Rule, TriangleMesh, build, exchange, file};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_leafless")).args(arguments).current_dir(folder).output().unwrap()
}

#[track_caller]
fn json(folder: &Path, arguments: &[&str]) -> Value {
    let output = run(folder, &[&["interfere", "--json"], arguments].concat());
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && errors.is_empty(), "{arguments:?}: {errors}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// A box as a closed mesh.
fn block(min: [f64; 3], max: [f64; 3]) -> Vec<u8> {
    let corners =
        (0..8).map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { min[axis] } else { max[axis] }));
    let sides: [[u32; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    exchange::write_stl(&TriangleMesh::new(corners.collect(), triangles).unwrap()).unwrap()
}

fn contains(interval: &Value, value: f64) -> bool {
    interval["lower"].as_f64().unwrap() <= value && value <= interval["upper"].as_f64().unwrap()
}

#[test]
fn solids_and_meshes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    std::fs::write(path.join("a.stl"), block([0.0; 3], [4.0, 2.0, 2.0])).unwrap();
    let frame = Frame::new([-1.0; 3], 8.0, 7).unwrap();
    let solid = Csg::cuboid([0.0; 3], [4.0, 2.0, 2.0]).unwrap();
    let tree = build(&solid, &frame, Rule::Certified, &Control::default()).unwrap();
    file::save(&tree, path.join("a.lfl")).unwrap();
    for a in ["a.lfl", "a.stl"] {
        for b in ["a.lfl", "a.stl"] {
            // In place: the whole mesh. The frame around the meshes has no planes at their faces.
            let found = json(path, &[a, b]);
            assert_eq!(found["verdict"], "overlapping", "{a} {b}");
            assert!(contains(&found["overlap"], 16.0), "{found}");
            assert_eq!(
                (&found["clearance"]["lower"], &found["clearance"]["upper"]),
                (&0.0.into(), &0.0.into())
            );
            assert!(found["splits"].as_u64().unwrap() <= 80, "{found}");
            assert!(found["witness"]["min"][0].as_f64().unwrap() >= 0.0);
            assert!(found["witness"]["max"][0].as_f64().unwrap() <= 4.0);
            // Beside it, and rotated by a quarter turn that takes y to −x.
            let found = json(path, &[a, b, "--place-b", "1 0 0 6.5 0 1 0 0 0 0 1 0"]);
            assert_eq!((&found["verdict"], &found["witness"]), (&"disjoint".into(), &Value::Null), "{a} {b}");
            assert!(contains(&found["clearance"], 2.5) && contains(&found["overlap"], 0.0), "{found}");
            assert_eq!(found["clipped"], false);
            let found = json(path, &[a, b, "--place-b", "0,-1,0,0, 1,0,0,1, 0,0,1,0, 0,0,0,1"]);
            assert!(contains(&found["clearance"], 0.0) && contains(&found["overlap"], 0.0), "{found}");
            // Rotated about the z axis by the angle with cosine 0.8. The truth comes from clipping the
            // polygon.
            let found =
                json(path, &[a, b, "--place-b", "[[0.8,-0.6,0,1],[0.6,0.8,0,0],[0,0,1,1]]", "--depth", "6"]);
            assert_eq!(found["verdict"], "overlapping");
            let area = clipped_area([[1.0, 0.0], [4.2, 2.4], [3.0, 4.0], [-0.2, 1.6]], [4.0, 2.0]);
            assert!(contains(&found["overlap"], area), "{found} {area}");
        }
    }
    // Face to face on the lattice: proven.
    let found = json(path, &["a.lfl", "a.lfl", "--place-b", "1 0 0 4 0 1 0 0.5 0 0 1 0"]);
    assert_eq!(found["verdict"], "disjoint");
    assert_eq!((&found["clearance"]["lower"], &found["clearance"]["upper"]), (&0.0.into(), &0.0.into()));
    // The text output.
    let text = String::from_utf8(run(path, &["interfere", "a.lfl", "a.lfl"]).stdout).unwrap();
    for (line, name) in text.lines().zip(["verdict", "overlap", "clearance", "witness", "splits"]) {
        assert!(line.starts_with(name), "{text}");
    }
    // A budget of zero.
    let found = json(path, &["a.stl", "a.stl", "--splits", "0"]);
    assert_eq!((&found["verdict"], &found["clearance"]["upper"]), (&"undecided".into(), &Value::Null));
}

/// The exit code says whether two solids are far enough apart. The nearest points are printed.
#[test]
fn gaps_and_points() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    std::fs::write(path.join("a.csg"), "cube([4, 2, 2]);").unwrap();
    std::fs::write(path.join("b.csg"), "translate([6.5, 0, 0]) cube([4, 2, 2]);").unwrap();
    let found = json(path, &["a.csg", "b.csg"]);
    assert!(contains(&found["clearance"], 2.5), "{found}");
    let points = &found["points"];
    assert!((points[0][0].as_f64().unwrap() - 4.0).abs() < 1e-6, "{found}");
    assert!((points[1][0].as_f64().unwrap() - 6.5).abs() < 1e-6, "{found}");
    for (least, code, word) in [("2.4", 0, "yes"), ("2.6", 1, "no")] {
        let output = run(path, &["interfere", "a.csg", "b.csg", "--gap-at-least", least, "--json"]);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{errors}");
        assert_eq!(errors.is_empty(), code == 0, "{errors}");
        let told: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(told["gap_at_least"], word, "{told}");
    }
    let output = run(path, &["interfere", "a.csg", "b.csg", "--gap-at-least", "-1"]);
    assert_ne!(output.status.code(), Some(0));
    let text = String::from_utf8(run(path, &["interfere", "a.csg", "b.csg"]).stdout).unwrap();
    assert!(text.lines().any(|line| line.starts_with("nearest")), "{text}");
}

/// Clearances and gaps at the places of a file.
#[test]
fn many_places() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    std::fs::write(path.join("a.csg"), "sphere(2);").unwrap();
    std::fs::write(path.join("b.csg"), "sphere(3);").unwrap();
    let places = "# beside each other, in contact, into each other\n\n1 0 0 7 0 1 0 0 0 0 1 0\n\
        1 0 0 3 0 1 0 0 0 0 1 4\n1 0 0 4.5 0 1 0 0 0 0 1 0\n";
    std::fs::write(path.join("places.txt"), places).unwrap();
    let command = ["a.csg", "b.csg", "--poses", "places.txt"];
    let found = json(path, &command);
    assert!(found["poses"][0].get("clearance").is_none() && found.get("least").is_none(), "{found}");
    let found = json(path, &[&command[..], &["--clearance"]].concat());
    let verdicts = ["disjoint", "disjoint", "overlapping"];
    for ((pose, verdict), apart) in
        found["poses"].as_array().unwrap().iter().zip(verdicts).zip([2.0, 0.0, 0.0])
    {
        assert!(pose["verdict"] == verdict && contains(&pose["clearance"], apart), "{found}");
    }
    let ends = &found["poses"][0]["points"];
    assert!(
        (ends[0][0].as_f64().unwrap() - 2.0).abs() < 1e-3
            && (ends[1][0].as_f64().unwrap() - 4.0).abs() < 1e-3
    );
    let output = run(path, &[&["interfere"], &command[..], &["--clearance"]].concat());
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.lines().count() == 4 && text.contains("clearance") && text.contains(" and "), "{text}");

    // Far enough apart only at the first place.
    let gap = [&["interfere"], &command[..], &["--gap-at-least", "1.5"]].concat();
    let output = run(path, &[&gap[..], &["--json"]].concat());
    let told: Value = serde_json::from_slice(&output.stdout).unwrap();
    let words = told["poses"].as_array().unwrap().iter().map(|pose| pose["gap_at_least"].as_str().unwrap());
    assert_eq!((words.collect::<Vec<_>>(), told["least"].as_f64()), (vec!["yes", "no", "no"], Some(1.5)));
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(
        output.status.code() == Some(1) && errors.contains("nearer than 1.5 in 2 of 3 places"),
        "{errors}"
    );
    let text = String::from_utf8(run(path, &gap).stdout).unwrap();
    assert!(text.contains("at least 1.5") && text.lines().count() == 4, "{text}");
    std::fs::write(path.join("places.txt"), "1 0 0 7 0 1 0 0 0 0 1 0\n").unwrap();
    assert!(run(path, &gap).status.success());
    // The clearance of a single place is reported anyway.
    assert_eq!(run(path, &["interfere", "a.csg", "b.csg", "--clearance"]).status.code(), Some(2));
}

/// Returns the area of a counter-clockwise polygon in [0, w] × [0, h].
fn clipped_area(polygon: [[f64; 2]; 4], size: [f64; 2]) -> f64 {
    let mut points = polygon.to_vec();
    for (axis, limit, sign) in [(0, 0.0, 1.0), (1, 0.0, 1.0), (0, size[0], -1.0), (1, size[1], -1.0)] {
        let depth = |p: &[f64; 2]| sign * (p[axis] - limit);
        let mut kept = Vec::new();
        for (i, a) in points.iter().enumerate() {
            let b = &points[(i + 1) % points.len()];
            let (s, t) = (depth(a), depth(b));
            if s >= 0.0 {
                kept.push(*a);
            }
            if (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0) {
                let f = s / (s - t);
                kept.push([a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1])]);
            }
        }
        points = kept;
    }
    let twice: f64 = (0..points.len())
        .map(|i| {
            let (a, b) = (points[i], points[(i + 1) % points.len()]);
            a[0] * b[1] - a[1] * b[0]
        })
        .sum();
    // The boxes have one unit of height in common.
    0.5 * twice
}

#[test]
fn what_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    std::fs::write(path.join("a.stl"), block([0.0; 3], [1.0; 3])).unwrap();
    std::fs::write(path.join("bad.lfl"), b"nonsense").unwrap();
    for (arguments, code, word) in [
        (vec!["a.stl"], 2, "B"),
        (vec!["-", "-"], 2, "standard input"),
        (vec!["a.stl", "none.stl"], 1, "none.stl"),
        (vec!["a.stl", "bad.lfl"], 1, "bad.lfl"),
        (vec!["a.stl", "a.stl", "--place-b", "1 2 3"], 2, "12 numbers"),
        (vec!["a.stl", "a.stl", "--place-b", "1 0 0 0 0 1 0 0 0 0 0 0"], 2, "singular"),
        (vec!["a.stl", "a.stl", "--depth", "21"], 2, "depth"),
    ] {
        let output = run(path, &[vec!["interfere"], arguments.clone()].concat());
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {errors}");
        assert!(output.stdout.is_empty() && errors.lines().count() == 1 && errors.contains(word), "{errors}");
    }
}
