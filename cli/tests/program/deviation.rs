//! The subcommand `leafless deviation`, from outside.

use crate::place::solids;
use serde_json::Value;

/// A plate with a bore of this radius.
fn plate(radius: f64) -> String {
    format!(
        "difference() {{ cube([20, 20, 5]); multmatrix([[1, 0, 0, 10], [0, 1, 0, 10], [0, 0, 1, 0], [0, 0, 0, 1]]) \
         cylinder(h = 5, r = {radius}); }}"
    )
}

fn holds(found: &Value, truth: f64, width: f64) {
    let [lower, upper] = ["lower", "upper"].map(|end| found[end].as_f64().unwrap());
    assert!(lower <= truth + 1e-9 && truth - 1e-9 <= upper && upper - lower <= width, "{truth}: {found}");
}

#[test]
fn scenes_and_meshes() {
    let place = solids();
    place.write("a.csg", plate(5.0));
    place.write("b.csg", plate(4.5));
    let found = place.run("deviation a.csg b.csg --tolerance 0.02 --json").good().json();
    holds(&found, 0.5, 0.02);
    holds(&found["a_to_b"], 0.5, 0.02);
    assert_eq!((&found["verdict"], &found["measured"]), (&Value::Null, &"tolerance".into()), "{found}");
    assert_eq!(found["a_to_b"]["point"].as_array().map(Vec::len), Some(3), "{found}");
    // A mesh against itself, moved, and rotated by a quarter turn.
    let found = place.run("deviation cube.stl cube.stl --within 0 --json").good().json();
    assert_eq!((found["verdict"].as_str(), found["upper"].as_f64()), (Some("within"), Some(0.0)));
    let moved = "deviation cube.stl cube.stl --translate 0.25,0,0 --tolerance 1e-9 --json";
    holds(&place.run(moved).good().json(), 0.25, 1e-9);
    // The text output.
    let text =
        place.run("deviation cube.stl cube.stl --translate 0.25,0,0 --within 0.5").good().text().to_owned();
    for (line, name) in text.lines().zip(["verdict", "distance", "a to b", "b to a", "splits"]) {
        assert!(line.starts_with(name), "{text}");
    }
}

#[test]
fn the_exit_code_is_the_verdict() {
    let place = solids();
    let moved = "deviation cube.stl cube.stl --translate 0.25,0,0 --json";
    assert_eq!(place.run(&format!("{moved} --within 0.3")).good().json()["verdict"], "within");
    let run = place.run(&format!("{moved} --within 0.2"));
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(run.errors.contains("cube.stl") && run.errors.contains("not within 0.2"), "{run:?}");
    assert_eq!(run.json()["verdict"], "beyond");
    place.write("a.csg", plate(5.0));
    place.write("b.csg", plate(4.5));
    let run = place.run("deviation a.csg b.csg --within 0.5 --splits 1 --json");
    assert_eq!((run.code, run.json()["verdict"].as_str()), (Some(1), Some("undecided")), "{run:?}");
    place.run("deviation cube.stl").bad(2, &["B"]);
    place.run("deviation - -").bad(2, &["standard input"]);
    place.run("deviation cube.stl cube.stl --tolerance -1").bad(2, &["tolerance"]);
}
