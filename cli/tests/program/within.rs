//! The subcommand `leafless within`, from outside.

use leafless::{Control, Csg, Frame, Rule, build, exchange, file};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_leafless")).args(arguments).current_dir(folder).output().unwrap()
}

#[track_caller]
fn told(folder: &Path, arguments: &[&str]) -> Value {
    let output = run(folder, &[&["within", "--json"], arguments].concat());
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && errors.is_empty(), "{arguments:?}: {errors}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn contains(interval: &Value, value: f64) -> bool {
    interval["lower"].as_f64().unwrap() <= value && value <= interval["upper"].as_f64().unwrap()
}

fn range(told: &Value, which: &str) -> [u64; 2] {
    ["least", "most"].map(|end| told["cells"][which][end].as_u64().unwrap())
}

/// The box [0, 4] × [0, 2]² in 8³ cells of the universe [-1, 7]³, certified and sampled, and as a scene.
fn files(path: &Path) {
    let frame = Frame::new([-1.0; 3], 8.0, 3).unwrap();
    let solid = Csg::cuboid([0.0; 3], [4.0, 2.0, 2.0]).unwrap();
    for (name, rule) in [("a.lfl", Rule::Certified), ("sampled.lfl", Rule::Sampled)] {
        let tree = build(&solid, &frame, rule, &Control::default()).unwrap();
        file::save(&tree, path.join(name)).unwrap();
    }
    std::fs::write(path.join("a.csg"), "cube(size = [4, 2, 2]);").unwrap();
    let ball = build(
        &Csg::ball([4.0, 1.0, 1.0], 0.75).unwrap(),
        &frame.with_depth(7).unwrap(),
        Rule::Sampled,
        &Control::default(),
    );
    let mesh = leafless::marching_cubes(ball.unwrap().view(), None, &Control::default()).unwrap();
    std::fs::write(path.join("ball.stl"), exchange::write_stl(&mesh).unwrap()).unwrap();
}

#[test]
fn regions() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    files(path);
    let found = told(path, &["a.lfl", "--box", "1,0,-5,3,9,1"]);
    assert_eq!((range(&found, "full"), range(&found, "upper")), ([4, 4], [4, 4]));
    assert!(contains(&found["volume"], 4.0) && found["region"] == "box" && found["depth"] == 3);
    // Two thirds of a cell more along x.
    let found = told(path, &["sampled.lfl", "--box", "1, 0, -5, 3.6666666666666665, 9, 1"]);
    assert_eq!(range(&found, "full"), [4, 6]);
    assert!(contains(&found["volume"], 5.333_333_333_333_333));
    // Half a ball, in cells, in finer cells, of a scene, and by splits that do not suffice.
    let half = 2.0 / 3.0 * std::f64::consts::PI * 0.75f64.powi(3);
    let ball = ["--ball", "4,1,1,0.75"];
    let mut widths = vec![];
    for more in [
        &["a.lfl"][..],
        &["a.lfl", "--depth", "6"],
        &["a.csg", "--bounds", "-1,-1,-1,8", "--depth", "6"],
        &["a.csg"],
        &["a.csg", "--splits", "3"],
    ] {
        let found = told(path, &[more, &ball].concat());
        assert!(contains(&found["volume"], half), "{more:?} {found}");
        widths.push(found["volume"]["upper"].as_f64().unwrap() - found["volume"]["lower"].as_f64().unwrap());
        assert!(range(&found, "full")[0] <= range(&found, "full")[1]);
    }
    assert!(widths[1] < widths[0] / 20.0 && widths[2] < 0.02 && widths[3] < 1e-5, "{widths:?}");
    assert!(widths[4] > 0.1, "{widths:?}");
    // A solid in a solid, and a mesh.
    let found = told(path, &["a.lfl", "--in", "a.csg"]);
    assert_eq!((range(&found, "full"), found["region"].clone()), ([16, 16], "a.csg".into()));
    let found = told(path, &["a.lfl", "--in", "sampled.lfl"]);
    assert_eq!(range(&found, "full"), [0, 16]);
    let found = told(path, &["a.lfl", "--in", "sampled.lfl", "--cells"]);
    assert_eq!(range(&found, "full"), [16, 16]);
    let found = told(path, &["a.lfl", "--in", "ball.stl"]);
    let [lower, upper] = ["lower", "upper"].map(|end| found["volume"][end].as_f64().unwrap());
    assert!(lower < half && half < upper + 0.05 && range(&found, "full") == [0, 4], "{found}");
    let output = run(path, &["within", "a.lfl", "--box", "1,0,-5,3,9,1"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("FULL cells      4\n") && text.contains("volume          4\n"), "{text}");
}

#[test]
fn what_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    files(path);
    for (arguments, code, words) in [
        (&["a.lfl"][..], 2, "--ball"),
        (&["a.lfl", "--ball", "0,0,0,0"], 2, "radius"),
        (&["a.lfl", "--ball", "0,0,0,nan"], 2, "radius"),
        (&["a.lfl", "--ball", "0,0,0"], 2, "four numbers"),
        (&["a.lfl", "--box", "0,0,0,1,1"], 2, "six numbers"),
        (&["a.lfl", "--box", "0,0,0,1,1,0"], 2, "max"),
        (&["a.lfl", "--box", "0,0,0,1,1,1", "--ball", "0,0,0,1"], 2, "--b"),
        (&["a.lfl", "--ball", "0,0,0,1", "--bounds", "0,0,0,1"], 2, "--bounds"),
        (&["none.lfl", "--ball", "0,0,0,1"], 1, "none.lfl"),
        (&["a.lfl", "--in", "none.stl"], 1, "none.stl"),
    ] {
        let output = run(path, &[&["within"], arguments].concat());
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?} {errors}");
        assert!(errors.contains(words) && errors.lines().count() == 1, "{arguments:?} {errors}");
    }
}
