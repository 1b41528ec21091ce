//! The subcommands `attribute`, `sample` and `summary`, and channels in others, from outside.

use leafless::solid::{Band, Samples, VoxelGrid};
use leafless::{Control, Csg, Frame, Rule, Volume, build, exchange, file};
use serde_json::Value;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_leafless")).args(arguments).current_dir(folder).output().unwrap()
}

#[track_caller]
fn told(folder: &Path, arguments: &[&str]) -> Value {
    let output = run(folder, &[arguments, &["--json"]].concat());
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && errors.is_empty(), "{arguments:?}: {errors}");
    serde_json::from_slice(&output.stdout).unwrap()
}

#[track_caller]
fn refused(folder: &Path, arguments: &[&str], code: i32, words: &str) {
    let output = run(folder, arguments);
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {errors}");
    assert!(errors.contains(words), "{arguments:?}: {errors}");
}

#[track_caller]
fn sample(folder: &Path, arguments: &[&str], points: &str) -> Vec<String> {
    let mut child = Command::new(env!("CARGO_BIN_EXE_leafless"))
        .arg("sample")
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(points.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
}

fn contains(interval: &Value, value: f64) -> bool {
    interval["lower"].as_f64().unwrap() <= value && value <= interval["upper"].as_f64().unwrap()
}

/// Boxes in the universe [0, 8]³ of 16³ cells: the whole box, its left half and its right half, with some
/// overlap.
fn files(path: &Path) {
    let frame = Frame::new([0.0; 3], 8.0, 4).unwrap();
    for (name, min, max) in [
        ("block.lfl", [1.0; 3], [7.0; 3]),
        ("left.lfl", [1.0; 3], [4.0, 7.0, 7.0]),
        ("right.lfl", [3.0, 1.0, 1.0], [7.0; 3]),
    ] {
        let tree =
            build(&Csg::cuboid(min, max).unwrap(), &frame, Rule::Certified, &Control::default()).unwrap();
        file::save(&tree, path.join(name)).unwrap();
    }
}

#[test]
fn a_channel_of_a_function_is_sampled_and_summed_up() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    files(path);
    let made = told(
        path,
        &[
            "attribute",
            "block.lfl",
            "--name",
            "heat",
            "--expr",
            "20 + 8*floor(z)",
            "--store",
            "u16",
            "--unit",
            "K",
        ],
    );
    assert_eq!(made["channel"]["type"], "u16");
    assert_eq!(made["channel"]["metadata"]["unit"], "K");
    // A layer has one value wherever the solid is.
    assert!(made["channel"]["values"].as_u64().unwrap() < 100, "{made}");
    let points = "2 2 2.25\n2,2,6.75\n0.1 0.1 0.1\nnan 0 0\n";
    assert_eq!(sample(path, &["block.lfl", "--name", "heat"], points), ["36", "68", "none", "none"]);
    assert_eq!(sample(path, &["block.lfl", "--everywhere"], "2 2 3.5\n-1 0 0\n"), ["44", "none"]);
    let found = told(path, &["summary", "block.lfl"]);
    // Layers of area 36 from z = 1 to 7: 28, 36, …, 68.
    assert_eq!(found["values"][0]["least"], 28.0);
    assert_eq!(found["values"][0]["greatest"], 68.0);
    assert!(
        contains(&found["values"][0]["integral"], 36.0 * 6.0 * 48.0)
            && contains(&found["values"][0]["mean"], 48.0)
    );
    assert!(contains(&found["volume"], 216.0) && found["unit"] == "K");
    let part = told(path, &["summary", "block.lfl", "--name", "heat", "--box", "0,0,0,8,8,2.5"]);
    assert!(contains(&part["values"][0]["integral"], 36.0 * (28.0 + 0.5 * 36.0)));
    assert!(told(path, &["info", "block.lfl"])["channels"][0]["name"] == "heat");
    let text = String::from_utf8(run(path, &["info", "block.lfl"]).stdout).unwrap();
    assert!(text.contains("channel         heat in K: 1 x u16, depth 4"), "{text}");
    assert!(run(path, &["verify", "block.lfl"]).status.success());
    // Without the channel, the file is the old one.
    told(path, &["attribute", "block.lfl", "--name", "heat", "--remove", "-o", "plain.lfl"]);
    files(path);
    assert_eq!(
        std::fs::read(path.join("plain.lfl")).unwrap(),
        std::fs::read(path.join("block.lfl")).unwrap()
    );
}

#[test]
fn materials_and_their_masses() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    files(path);
    told(path, &["attribute", "block.lfl", "--name", "material", "--value", "1", "--store", "u8"]);
    told(path, &["attribute", "block.lfl", "--name", "material", "--value", "2", "--in", "left.lfl"]);
    let found =
        told(path, &["summary", "block.lfl", "--materials", "--density", "1=2..3", "--density", "2=10"]);
    let materials = found["materials"].as_array().unwrap();
    assert_eq!(materials.len(), 2);
    assert!(materials.iter().all(|material| contains(&material["volume"], 108.0)));
    assert!(contains(&materials[0]["centroid"][0], 5.5) && contains(&materials[1]["centroid"][0], 2.5));
    assert!(contains(&found["mass"], 216.0 + 1080.0) && contains(&found["mass"], 324.0 + 1080.0));
    assert!(!contains(&found["mass"], 1200.0 + 216.0));
}

#[test]
fn set_operations_carry_channels() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    files(path);
    told(path, &["attribute", "left.lfl", "--name", "n", "--value", "1,10", "--store", "u8"]);
    told(path, &["attribute", "right.lfl", "--name", "n", "--value", "3,4", "--store", "u8"]);
    let points = "2 2 2\n3.5 2 2\n6 2 2\n";
    for (rule, middle) in [("left", "1 10"), ("right", "3 4"), ("max", "3 10"), ("mean", "2 7")] {
        let carry = format!("n={rule}");
        assert!(
            run(path, &["union", "left.lfl", "right.lfl", "-o", "both.lfl", "--carry", &carry])
                .status
                .success()
        );
        assert_eq!(sample(path, &["both.lfl"], points), ["1 10", middle, "3 4"]);
    }
    assert!(run(path, &["difference", "left.lfl", "right.lfl", "-o", "both.lfl"]).status.success());
    assert_eq!(sample(path, &["both.lfl"], points), ["1 10", "none", "none"]);
    assert_eq!(sample(path, &["both.lfl", "--json"], points), ["[1,10]", "null", "null"]);
    refused(
        path,
        &["union", "left.lfl", "right.lfl", "-o", "x.lfl", "--carry", "n=first"],
        2,
        "the rules are",
    );
    // Channels of different types have no rule.
    told(path, &["attribute", "right.lfl", "--name", "n", "--value", "3", "--store", "u8"]);
    refused(path, &["union", "left.lfl", "right.lfl", "-o", "x.lfl"], 1, "of one type");
}

#[test]
fn channels_of_volumes_and_of_other_solids() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    files(path);
    let grid = VoxelGrid::new([8; 3], [0.0; 3], [1.0; 3]).unwrap();
    let samples: Vec<u8> = (0..512).map(|i| (i % 8 * 10) as u8).collect();
    let bytes =
        exchange::write_nrrd(&Samples::from(&samples[..]), &grid, exchange::NrrdEncoding::Gzip).unwrap();
    std::fs::write(path.join("v.nrrd"), bytes).unwrap();
    std::fs::write(path.join("v.raw"), &samples).unwrap();
    told(path, &["attribute", "block.lfl", "--name", "a", "--from", "v.nrrd", "--nearest", "--store", "u8"]);
    told(
        path,
        &["attribute", "block.lfl", "--name", "b", "--from", "v.raw", "--extents", "8,8,8", "--depth", "6"],
    );
    assert_eq!(sample(path, &["block.lfl", "--name", "a"], "2.7 2 2\n3.2 2 2\n"), ["20", "30"]);
    // At the centre of the cell from 3.25 to 3.375.
    let volume =
        Volume::new(samples.into(), &grid, Band::at_least(1.0).unwrap(), &Control::default()).unwrap();
    let value = volume.value_at([3.3125, 2.0625, 2.0625]).unwrap();
    assert_eq!(sample(path, &["block.lfl", "--name", "b"], "3.3 2.1 2.1\n"), [value.to_string()]);
    told(path, &["attribute", "left.lfl", "--name", "a", "--from", "block.lfl"]);
    assert_eq!(sample(path, &["left.lfl"], "2.7 2 2\n"), ["20"]);
    assert_eq!(told(path, &["info", "left.lfl"])["channels"][0]["type"], "u8");
}

#[test]
fn details_follow_the_values() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    files(path);
    let cells = |more: &[&str]| {
        let arguments =
            ["attribute", "block.lfl", "--name", "x", "--depth", "7", "--expr", "exp(x - 7)", "-o", "x.lfl"];
        told(path, &[&arguments, more].concat())["channel"]["values"].as_u64().unwrap()
    };
    let fine = cells(&[]);
    let adaptive = cells(&["--coarse", "1", "--fine", "0.0625", "--tolerance", "0.05"]);
    let corners = cells(&["--coarse", "1", "--tolerance", "0.05", "--corners"]);
    assert!(4 * adaptive < fine && corners <= adaptive && corners > 10, "{fine} {adaptive} {corners}");
}

#[test]
fn what_cannot_be_done_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    files(path);
    let before = std::fs::read(path.join("block.lfl")).unwrap();
    let attribute = |more: &[&'static str]| [&["attribute", "block.lfl", "--name", "n"], more].concat();
    refused(path, &attribute(&[]), 2, "required");
    refused(path, &attribute(&["--expr", "x", "--value", "1"]), 2, "cannot be used with");
    refused(path, &attribute(&["--expr", "w"]), 2, "w is unknown");
    refused(path, &attribute(&["--expr", "x +"]), 2, "x +");
    refused(path, &attribute(&["--value", "1,2,3,4,5"]), 2, "one to four numbers");
    refused(path, &attribute(&["--value", "300", "--store", "u8"]), 1, "beyond the range of u8");
    refused(path, &attribute(&["--expr", "x", "--fine", "1"]), 2, "--tolerance");
    refused(path, &attribute(&["--expr", "x", "--tolerance", "-1"]), 2, "tolerance");
    refused(path, &attribute(&["--remove"]), 1, "has no channel");
    refused(path, &attribute(&["--value", "1", "--in", "left.lfl"]), 1, "has no channel");
    refused(path, &attribute(&["--from", "none.nrrd"]), 1, "none.nrrd: No such file");
    refused(path, &["sample", "block.lfl"], 1, "has no channel");
    refused(path, &["summary", "block.lfl"], 1, "has no channel");
    assert_eq!(std::fs::read(path.join("block.lfl")).unwrap(), before);
    told(path, &attribute(&["--value", "1"]));
    told(path, &["attribute", "block.lfl", "--name", "m", "--value", "1"]);
    refused(path, &["sample", "block.lfl"], 2, "m, n");
    refused(path, &["summary", "block.lfl", "--name", "k"], 1, "It has m, n");
    refused(path, &["summary", "block.lfl", "--name", "m", "--box", "0,0,0,0.5,0.5,0.5"], 1, "no value");
    refused(path, &["summary", "block.lfl", "--name", "m", "--box", "1,0,0,0.5,0.5,0.5"], 2, "lower corner");
}

#[test]
fn channels_of_meshes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    files(path);
    let obj = "v 0 0 0\nv 0 9 0\nv 0 0 9\nv 8 0 0\nv 8 9 0\nv 8 0 9\nf 1 2 3\nf 4 5 6\n";
    std::fs::write(path.join("two.obj"), obj).unwrap();
    told(path, &["attribute", "block.lfl", "--name", "body", "--bodies", "two.obj", "--store", "u8"]);
    let points = "2 2 2\n3.9 2 2\n4.1 2 2\n6 2 2\n";
    assert_eq!(sample(path, &["block.lfl"], points), ["0", "0", "1", "1"]);
    // Colours run from black at y = 0 to red at y = 8.
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
               property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n\
               property list uchar int vertex_indices\nend_header\n\
               0 0 0 0 7 7\n8 0 0 0 7 7\n8 8 0 240 7 7\n0 8 0 240 7 7\n3 0 1 2\n3 0 2 3\n";
    std::fs::write(path.join("c.ply"), ply).unwrap();
    let made =
        told(path, &["attribute", "block.lfl", "--name", "paint", "--from", "c.ply", "-o", "paint.lfl"]);
    assert_eq!(
        (&made["channel"]["type"], &made["channel"]["metadata"]["meaning"]),
        (&"u8".into(), &"colour".into())
    );
    let red = |y: f64| {
        let line = sample(path, &["paint.lfl", "--name", "paint"], &format!("4 {y} 2\n")).remove(0);
        line.split(' ').map(|n| n.parse::<f64>().unwrap()).collect::<Vec<_>>()
    };
    // At the centre of the cell from 2 to 2.5.
    assert_eq!((red(2.1)[0], red(2.1)[1], red(6.9)[0]), (68.0, 7.0, 202.0));
    refused(
        path,
        &["attribute", "block.lfl", "--name", "paint", "--from", "two.obj"],
        1,
        "neither colours nor materials",
    );
    refused(
        path,
        &["attribute", "block.lfl", "--name", "paint", "--from", "c.ply", "--pick", "heat"],
        2,
        "colour",
    );
}

#[test]
fn voxels_follow_channels() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    files(path);
    told(path, &["attribute", "block.lfl", "--name", "a", "--expr", "floor(x)", "--store", "u8"]);
    let listed = |more: &[&str]| {
        let inside = told(path, &[&["voxels", "block.lfl", "-o", "out.csv"], more].concat())["inside"]
            .as_u64()
            .unwrap();
        (inside, std::fs::read_to_string(path.join("out.csv")).unwrap())
    };
    let coarse = listed(&["--coarse", "2"]).0;
    let (adaptive, text) = listed(&["--coarse", "2", "--fine", "0.5", "--tolerance", "0"]);
    let fine = listed(&["--coarse", "0.5"]).0;
    assert!(coarse < adaptive && adaptive < fine, "{coarse} {adaptive} {fine}");
    // The list contains only values that the function has there.
    assert!(text.lines().next().unwrap().contains("value"), "{}", text.lines().next().unwrap());
    told(path, &["attribute", "block.lfl", "--name", "b", "--value", "1"]);
    refused(path, &["voxels", "block.lfl", "-o", "x.csv", "--channel", "c"], 1, "It has a, b");
    refused(
        path,
        &["voxels", "left.lfl", "-o", "x.csv", "--coarse", "1", "--fine", "1", "--tolerance", "1"],
        2,
        "--channel",
    );
}
