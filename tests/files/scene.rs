//! Scenes: every call of the language, every error with its place, and hostile texts.

#![cfg(feature = "scene")]

use leafless::exchange::write_stl;
use leafless::scene::read_scene;
use leafless::{Affine, Control, Error, Frame, Interval, Membership, Octree, Rule, TriangleMesh, build};
use leafless_testkit::Random;
use leafless_testkit::fuzz::scenes;
use std::f64::consts::PI;
use std::fmt::Write;
use std::path::Path;

fn tree(text: &str, frame: &Frame) -> Octree {
    let scene = read_scene(text, None).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let solid = scene.solid(frame).unwrap();
    build(&solid, frame, Rule::Certified, &Control::default()).unwrap()
}

/// Builds the scene's solid in [-8, 8]³ at depth 6.
fn in_cube(text: &str) -> Octree {
    tree(text, &Frame::new([-8.0; 3], 16.0, 6).unwrap())
}

fn volume(text: &str) -> Interval {
    in_cube(text).statistics().volume()
}

/// Checks that the volume's interval contains the truth. Its width is at most a layer of several cells around
/// the solid's `area`.
fn check(text: &str, truth: f64, area: f64) {
    let tree = in_cube(text);
    let volume = tree.statistics().volume();
    assert!(
        volume.lower <= truth * (1.0 + 1e-12) && truth * (1.0 - 1e-12) <= volume.upper,
        "{text}: {truth} {volume:?}"
    );
    let width = volume.upper - volume.lower;
    assert!(width <= 3.0 * area * 0.25, "{text}: {truth} {volume:?}");
    assert!(!tree.view().is_clipped(), "{text}");
}

/// Checks that two texts describe the same set of points, as far as the finest cells show.
fn same(a: &str, b: &str) {
    let (a_tree, b_tree) = (in_cube(a), in_cube(b));
    let (p, q) = (a_tree.statistics().volume(), b_tree.statistics().volume());
    assert_eq!((p.lower, p.upper), (q.lower, q.upper), "{a}\n{b}");
    assert!(p.upper > 0.0, "{a}");
}

fn is_nothing(text: &str) {
    let volume = volume(text);
    assert_eq!(volume.upper, 0.0, "{text}");
}

/// Returns an error's line, column and words.
fn refusal(text: &str) -> (u64, u64, String) {
    match read_scene(text, None) {
        Err(Error::Scene(error)) => (error.line(), error.column(), error.problem().to_owned()),
        Err(error) => panic!("{text}: {error}"),
        Ok(_) => panic!("taken: {text}"),
    }
}

// ---- the meaning of the calls
// ------------------------------------------------------------------------------------

#[test]
fn solids() {
    check("cube(size = [2, 3, 4], center = false);", 24.0, 52.0);
    check("cube(size = [2, 3, 4], center = true);", 24.0, 52.0);
    check("cube(2);", 8.0, 24.0);
    check("cube();", 1.0, 6.0);
    assert_eq!(
        in_cube("cube(size = [2, 3, 4], center = false);").contains([1.9, 2.9, 3.9]),
        Membership::Inside
    );
    assert_eq!(in_cube("cube([2, 3, 4], true);").contains([-0.9, -1.4, -1.9]), Membership::Inside);
    check("sphere($fn = 0, $fa = 12, $fs = 2, r = 5);", PI * 500.0 / 3.0, PI * 100.0);
    check("sphere(5);", PI * 500.0 / 3.0, PI * 100.0);
    let cylinder = "cylinder($fn = 60, $fa = 12, $fs = 2, h = 4, r1 = 3, r2 = 3, center = ";
    check(&format!("{cylinder}false);"), PI * 36.0, PI * 42.0);
    check(&format!("{cylinder}true);"), PI * 36.0, PI * 42.0);
    assert_eq!(in_cube(&format!("{cylinder}true);")).contains([1.5, 1.5, -1.8]), Membership::Inside);
    check("cylinder(h = 6, r1 = 4, r2 = 2, center = true);", PI * 56.0, PI * 60.0);
    check("cylinder(h = 6, r1 = 4, r2 = 0);", PI * 32.0, PI * 50.0);
    check("cylinder(h = 6, r1 = 0, r2 = 4);", PI * 32.0, PI * 50.0);
    check("cylinder(h = 6, r = 2);", PI * 24.0, PI * 32.0);
    let points = "points = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]]";
    for faces in
        ["[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]", "[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]"]
    {
        check(&format!("polyhedron({points}, faces = {faces}, convexity = 1);"), 32.0 / 3.0, 40.0);
    }
    let box_points = "[[0,0,0],[2,0,0],[2,2,0],[0,2,0],[0,0,2],[2,0,2],[2,2,2],[0,2,2]]";
    let box_faces = "[[0,1,2,3],[4,7,6,5],[0,4,5,1],[1,5,6,2],[2,6,7,3],[3,7,4,0]]";
    same(&format!("polyhedron(points = {box_points}, faces = {box_faces});"), "cube(2);");
}

#[test]
fn half_spaces() {
    let corner = "cube(8, true);";
    let half = volume(&format!("intersection() {{ {corner} halfspace([2, 0, 0, -1]); }}"));
    assert_eq!((half.lower, half.upper), (224.0, 224.0));
    let ball = "quadric([-1, -1, -1, 0, 0, 0, 0, 0, 0, 9]);";
    check(&format!("intersection() {{ {corner} {ball} }}"), PI * 36.0, PI * 36.0);
    let ball = "power([-1, 0, 2], [-1, 0, 2], [-1, 0, 2], 9);";
    check(&format!("intersection() {{ {corner} {ball} }}"), PI * 36.0, PI * 36.0);
    // x⁴ + y⁴ + z⁴ ≤ 81: 8 · 27 · Γ(5/4)³ / Γ(7/4).
    let rounded = "power([-1, 0, 4], [-1, 0, 4], [-1, 0, 4], 81);";
    let truth = 216.0 * 0.906_402_477_055_477f64.powi(3) / 0.919_062_526_848_883;
    check(&format!("intersection() {{ {corner} {rounded} }}"), truth, 150.0);
    check("torus(5, 2);", 2.0 * PI * PI * 5.0 * 4.0, 4.0 * PI * PI * 10.0);
    check("torus(major = 4, minor = 1);", 2.0 * PI * PI * 4.0, 4.0 * PI * PI * 4.0);
}

#[test]
fn operations() {
    let pair =
        "{ cube(2); multmatrix([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { cube(2); } }";
    for union in ["group()", "union()", "color([1, 0, 0, 1])", "color(\"red\", 0.5)", "render(convexity = 2)"]
    {
        check(&format!("{union} {pair}"), 12.0, 0.0);
    }
    check(&format!("intersection() {pair}"), 4.0, 0.0);
    check(&format!("difference() {pair}"), 4.0, 0.0);
    check("cube(2); multmatrix([[1,0,0,2],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) cube(2);", 16.0, 0.0);
    check("difference() { cube(4); cube(2); cube([4, 1, 1]); }", 64.0 - 8.0 - 2.0, 0.0);
    // Without braces, and calls that have no effect.
    check("color(\"red\") render() cube(2);", 8.0, 0.0);
    check("group() { cube(2); %cube(4); *cube(4); #cube(1); group(); group() {} ; ; }", 8.0, 0.0);
    check("difference() { %sphere(7); cube(4); cube(2); }", 56.0, 0.0);
    check("%text(\"ignored\"); *hull() { whatever(); } cube(1);", 1.0, 0.0);
    // A quarter turn around z, with a scale.
    check("multmatrix([[0, -2, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) cube([2, 1, 1]);", 4.0, 0.0);
    let turned = "multmatrix([[0.8, -0.6, 0, 1], [0.6, 0.8, 0, 0], [0, 0, 1, -2], [0, 0, 0, 1]])";
    check(&format!("{turned} cube([4, 2, 4]);"), 32.0, 64.0);
    check(&format!("{turned} {turned} cube([4, 2, 4]);"), 32.0, 64.0);
}

/// The calls of OpenSCAD's own language that stand for matrices.
#[test]
fn moves() {
    let turned = |rows: &str, what: &str| format!("multmatrix([{rows}, [0, 0, 0, 1]]) {what}");
    let (part, figure) = ("cube([3, 2, 1]);", "linear_extrude(height = 2) ");
    let plate = "{ square([3, 1]); }";
    for (call, rows) in [
        ("translate([1, -2, 0.5])", "[1, 0, 0, 1], [0, 1, 0, -2], [0, 0, 1, 0.5]"),
        ("translate(v = [1, 2])", "[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 0]"),
        ("scale(2)", "[2, 0, 0, 0], [0, 2, 0, 0], [0, 0, 2, 0]"),
        ("scale([0.5, 2])", "[0.5, 0, 0, 0], [0, 2, 0, 0], [0, 0, 1, 0]"),
        ("rotate(90)", "[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0]"),
        ("rotate(a = -90, v = [0, 2, 0])", "[0, 0, -1, 0], [0, 1, 0, 0], [1, 0, 0, 0]"),
        // About x first, about z last.
        ("rotate([90, 0, 90])", "[0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 0]"),
        ("rotate([0, 180])", "[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0]"),
        ("rotate(30, [0, 0, 0])", "[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]"),
        ("mirror([3, 0, 0])", "[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]"),
        ("mirror([1, -1])", "[0, 1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0]"),
        ("mirror([0, 0, 0])", "[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]"),
    ] {
        same(&format!("{call} {part}"), &turned(rows, part));
        if !call.contains("90, 0, 90") && !call.contains("v = [0, 2") {
            same(&format!("{figure} {call} {plate}"), &format!("{figure} {}", turned(rows, plate)));
        }
    }
    check("rotate([10, 20, 30]) translate([1, 2, 0]) cube([2, 3, 4]);", 24.0, 52.0);
    let turn = in_cube("rotate(30) cube([6, 1, 1]);");
    assert_eq!(turn.contains([4.0, 2.9, 0.5]), Membership::Inside);
    assert_eq!(turn.contains([4.0, 1.9, 0.5]), Membership::Outside);
    is_nothing("scale([1, 1, 0]) cube(2);");
    let (line, column, problem) = refusal("union() {\n  translate([1]) cube(1); }");
    assert_eq!((line, column, &*problem), (2, 13, "expected 3 items, found 1"));
    assert_eq!(refusal("rotate() cube(1);").2, "`a` is missing");
}

#[test]
fn nothing() {
    for text in [
        "",
        " // only this\n/* and * this */",
        "group();",
        "group() { union() { } }",
        "cube(size = [0, 1, 1]);",
        "cube(size = [1, -1, 1]);",
        "sphere(r = 0);",
        "sphere(r = -3);",
        "cylinder(h = 0, r1 = 1, r2 = 1);",
        "cylinder(h = 1, r1 = 0, r2 = 0);",
        "cylinder(h = 1, r1 = -1, r2 = 2);",
        "linear_extrude(height = 0) square(1);",
        "linear_extrude(height = -4) square(1);",
        "linear_extrude(height = 4) square(0);",
        "linear_extrude(height = 4) circle(0);",
        "linear_extrude(height = 4);",
        "linear_extrude(height = 4) polygon(points = [], paths = undef);",
        "linear_extrude(height = 4) polygon(points = [[0, 0], [1, 1]], paths = undef);",
        "linear_extrude(height = 4) multmatrix([[1,1,0,0],[1,1,0,0],[0,0,1,0],[0,0,0,1]]) square(2);",
        "rotate_extrude(angle = 0) square(1);",
        "rotate_extrude();",
        "polyhedron(points = [], faces = []);",
        "linear_extrude(height = 1) polygon(points = undef, paths = undef, convexity = 1);",
        "polyhedron(points = [[0,0,0],[1,0,0],[0,0,0]], faces = [[0,1,2]]);",
        "multmatrix([[1,0,0,0],[0,1,0,0],[0,0,0,0],[0,0,0,1]]) cube(2);",
        "intersection();",
        "intersection() { cube(2); group(); }",
        "intersection() { cube(2); sphere(0); }",
        "difference() { group(); cube(2); }",
        "difference() { cube(2); sphere(7); }",
        "difference();",
    ] {
        is_nothing(text);
    }
}

#[test]
fn prisms() {
    check("linear_extrude(height = 3) square([2, 1], center = true);", 6.0, 0.0);
    check(
        "linear_extrude(height = 4, center = true, $fn = 0) { circle(r = 3); square(1); }",
        PI * 36.0,
        PI * 42.0,
    );
    check(
        "linear_extrude(height = 4, center = false, convexity = 1, twist = 0, slices = 20, scale = [1, 1]) circle(3);",
        PI * 36.0,
        PI * 42.0,
    );
    // A ring: a hole by the even-odd rule, and by a difference.
    let ring = "polygon(points = [[-3,-3],[3,-3],[3,3],[-3,3],[-1,-1],[1,-1],[1,1],[-1,1]], paths = [[0,1,2,3],[4,5,6,7]], convexity = 1);";
    check(&format!("linear_extrude(height = 2) {ring}"), 64.0, 0.0);
    check("linear_extrude(height = 2) difference() { square(6, true); square(2, true); }", 64.0, 0.0);
    check("linear_extrude(height = 2) intersection() { square(6); circle(4); }", PI * 8.0, PI * 16.0);
    let star = "polygon(points = [[0, 6], [-1, 1], [-6, 0], [-1, -1], [0, -6], [1, -1], [6, 0], [1, 1]], paths = undef);";
    check(&format!("linear_extrude(height = 2, center = true) {star}"), 48.0, 160.0);
    // A rotated ellipse.
    let ellipse = "multmatrix([[1.6, -0.6, 0, 0], [1.2, 0.8, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) circle(2);";
    check(&format!("linear_extrude(height = 2) {ellipse}"), PI * 16.0, PI * 30.0);
    // A skew prism: the direction has any length.
    check("linear_extrude(height = 2, v = [0.5, 0, 1]) square(2);", 8.0, 30.0);
    assert_eq!(
        in_cube("linear_extrude(height = 4, v = [1, 0, 1]) square(2);").contains([4.0, 1.0, 3.0]),
        Membership::Inside
    );
    check("linear_extrude(v = [0, 0, 3]) square(2);", 12.0, 0.0);
}

#[test]
fn tapered_prisms() {
    // (A + √(A B) + B) h / 3 for uniform scales.
    check("linear_extrude(height = 3, scale = 0.5) square(4, true);", 3.0 / 3.0 * (16.0 + 8.0 + 4.0), 70.0);
    check("linear_extrude(height = 3, scale = 0) square(4, true);", 16.0, 60.0);
    check(
        "linear_extrude(height = 3, scale = 2, center = true) circle(2);",
        PI * (4.0 + 8.0 + 16.0),
        PI * 50.0,
    );
    same("linear_extrude(height = 4, scale = 0.5) circle(4);", "cylinder(h = 4, r1 = 4, r2 = 2);");
    // An oblique extrusion, because the circle is not in the middle: Cavalieri.
    let beside = "multmatrix([[1,0,0,1.5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) circle(2);";
    check(&format!("linear_extrude(height = 3, scale = 2) {beside}"), PI * (4.0 + 8.0 + 16.0), PI * 50.0);
    // ∫ (1 + (a − 1) t) (1 + (b − 1) t) dt · A · h, here for a = 2, b = 0: 2/3, for any figure of lines.
    check("linear_extrude(height = 3, scale = [2, 0]) square(4, true);", 16.0 * 3.0 * 2.0 / 3.0, 100.0);
    let triangle = "polygon(points = [[1, 0], [3, 1], [0, 3]]);";
    check(&format!("linear_extrude(height = 3, scale = [2, 0]) {triangle}"), 2.5 * 3.0 * 2.0 / 3.0, 40.0);
    check(
        &format!("linear_extrude(height = 4, center = true, scale = [0.5, 2]) {triangle}"),
        2.5 * 4.0 * (1.0 + 0.25 - 1.0 / 6.0),
        40.0,
    );
}

#[test]
fn bodies_of_revolution() {
    let at = |x: f64, y: f64, figure: &str| {
        format!("multmatrix([[1,0,0,{x}],[0,1,0,{y}],[0,0,1,0],[0,0,0,1]]) {figure}")
    };
    let whole = "rotate_extrude(angle = 360, start = 0, convexity = 2, $fn = 0, $fa = 12, $fs = 2)";
    check(&format!("{whole} {}", at(2.0, -1.0, "square([3, 2]);")), PI * (25.0 - 4.0) * 2.0, PI * 80.0);
    same(&format!("{whole} square([3, 2]);"), "cylinder(h = 2, r = 3);");
    same(&format!("{whole} polygon([[0, 0], [4, 0], [2, 6], [0, 6]]);"), "cylinder(h = 6, r1 = 4, r2 = 2);");
    same(
        &format!("{whole} polygon([[0, 0], [-4, 0], [-2, 6], [0, 6]]);"),
        "cylinder(h = 6, r1 = 4, r2 = 2);",
    );
    // By Pappus: area times the way of the centre of gravity.
    check(&format!("{whole} polygon([[2, 0], [5, 3], [2, 3]]);"), 4.5 * 2.0 * PI * 3.0, 200.0);
    check(&format!("{whole} polygon([[5, 0], [2, 3], [5, 3]]);"), 4.5 * 2.0 * PI * 4.0, 200.0);
    // Half a disc, cut by a rectangle.
    let half = format!("difference() {{ circle(4); {} }}", at(-5.0, -5.0, "square([5, 10]);"));
    check(&format!("{whole} {half}"), PI * 256.0 / 3.0, PI * 64.0);
    let half = format!("intersection() {{ circle(4); {} }}", at(0.0, -5.0, "square([5, 10]);"));
    check(&format!("{whole} {half}"), PI * 256.0 / 3.0, PI * 64.0);
    // Rings: circles that are moved, rotated or scaled.
    same(&format!("{whole} {}", at(5.0, 0.0, "circle(2);")), "torus(5, 2);");
    same(&format!("{whole} {}", at(-5.0, 0.0, "circle(2);")), "torus(5, 2);");
    let raised = "multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,1.5],[0,0,0,1]])";
    same(&format!("{whole} {}", at(5.0, 1.5, "circle(2);")), &format!("{raised} torus(5, 2);"));
    let turned =
        "multmatrix([[0.6, -0.8, 0, 4.1], [0.8, 0.6, 0, -1.3], [0, 0, 1, 0], [0, 0, 0, 1]]) circle(2);";
    let turned = format!("{whole} multmatrix([[0.7,0,0,0.3],[0,0.7,0,0],[0,0,1,0],[0,0,0,1]]) {turned}");
    check(&turned, 2.0 * PI * PI * (4.1 * 0.7 + 0.3) * 1.96, 4.0 * PI * PI * 4.0);
    let ring = format!("difference() {{ {} {} }}", at(2.0, -2.0, "square(4);"), at(4.0, 0.0, "circle(1.5);"));
    check(&format!("{whole} {ring}"), 2.0 * PI * 4.0 * (16.0 - PI * 2.25), 300.0);
    // Partial revolutions.
    let block = at(2.0, -1.0, "square([3, 2]);");
    for (angle, start) in [(90, 0), (180, 30), (270, 45), (37, 11), (-37, 11), (-200, 5), (359, 1), (1, -720)]
    {
        let share = f64::from(i32::abs(angle)) / 360.0;
        let text = format!("rotate_extrude(angle = {angle}, start = {start}) {block}");
        check(&text, PI * 42.0 * share, PI * 80.0);
    }
    let quarter = in_cube(&format!("rotate_extrude(angle = 90) {block}"));
    assert_eq!(quarter.contains([2.5, 2.5, 0.0]), Membership::Inside);
    assert_eq!(quarter.contains([-2.5, 2.5, 0.0]), Membership::Outside);
    let mirrored = in_cube(&format!("rotate_extrude(angle = 90) {}", at(-5.0, -1.0, "square([3, 2]);")));
    assert_eq!(mirrored.contains([-2.5, -2.5, 0.0]), Membership::Inside);
    assert_eq!(mirrored.contains([2.5, 2.5, 0.0]), Membership::Outside);
}

#[test]
fn bounds() {
    let of = |text: &str| read_scene(text, None).unwrap().bounds().unwrap();
    assert_eq!(of("cube([1, 2, 3]);"), Some(([0.0; 3], [1.0, 2.0, 3.0])));
    assert_eq!(of("linear_extrude(height = 2) square([4, 5]);"), Some(([0.0; 3], [4.0, 5.0, 2.0])));
    assert_eq!(
        of("linear_extrude(height = 2, scale = 3) square([4, 5]);"),
        Some(([0.0; 3], [12.0, 15.0, 2.0]))
    );
    assert_eq!(of("rotate_extrude() square([4, 5]);"), Some(([-4.0, -4.0, 0.0], [4.0, 4.0, 5.0])));
    assert_eq!(of("difference() { cube(4); halfspace([1, 0, 0, 0]); }"), Some(([0.0; 3], [4.0; 3])));
    assert_eq!(of("intersection() { halfspace([1, 0, 0, 0]); cube(4); }"), Some(([0.0; 3], [4.0; 3])));
    let tetrahedron = "polyhedron([[0, 0, 0], [4, 0, 0], [0, 5, 0], [0, 0, 6]], [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);";
    assert_eq!(of(&format!("difference() {{ cube(4); {tetrahedron} }}")), Some(([0.0; 3], [4.0; 3])));
    assert_eq!(of("halfspace([1, 0, 0, 0]);"), None);
    assert_eq!(of(""), None);
    let tetrahedron = "polyhedron([[0, 0, 0], [4, 0, 0], [0, 5, 0], [0, 0, 6]], [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);";
    assert_eq!(of(tetrahedron), Some(([0.0; 3], [4.0, 5.0, 6.0])));
    let (min, max) =
        of(&format!("multmatrix([[0,-1,0,0],[1,0,0,0],[0,0,1,1],[0,0,0,1]]) {tetrahedron}")).unwrap();
    for axis in 0..3 {
        assert!((min[axis] - [-5.0, 0.0, 1.0][axis]).abs() < 1e-12, "{min:?}");
        assert!((max[axis] - [0.0, 4.0, 7.0][axis]).abs() < 1e-12, "{max:?}");
    }
}

/// The links of an arm with nested matrices, as OpenSCAD dumps them: each link is moved up by 5 along the
/// previous one and rotated.
fn arm(links: usize) -> String {
    let link = "cylinder(h = 5, r1 = 1.66, r2 = 1.66, center = false); \
                multmatrix([[1, 0, 0, -1], [0, 1, 0, -2], [0, 0, 1, 2], [0, 0, 0, 1]]) cube([2, 4, 1]);";
    let joint = "multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 5], [0, 0, 0, 1]]) \
                 multmatrix([[0.8, -0.6, 0, 0], [0.48, 0.64, -0.6, 0], [0.36, 0.48, 0.8, 0], [0, 0, 0, 1]])";
    (1..links).fold(format!("group() {{ {link} }}"), |inner, _| {
        format!("group() {{ {link} {joint} {{ {inner} }} }}")
    })
}

#[test]
fn bounds_of_an_arm_of_turned_links_are_hardly_larger_than_the_arm() {
    let scene = read_scene(arm(8), None).unwrap();
    let (min, max) = scene.bounds().unwrap().unwrap();
    // By OpenSCAD 2021.01, with $fn = 200: its extents, and 346.29 for the volume.
    let (low, high) = ([-2.0, -12.4508, 0.0], [18.1793, 2.0, 21.7006]);
    for axis in 0..3 {
        assert!(min[axis] <= low[axis] + 0.01 && high[axis] - 0.01 <= max[axis], "{min:?} {max:?}");
    }
    let frame = Frame::around(min, max, 8).unwrap();
    assert!(frame.edge() <= 1.5 * (high[2] - low[2]), "{}", frame.edge());
    let tree = tree(&arm(8), &frame);
    assert!(!tree.view().is_clipped());
    let volume = tree.statistics().volume();
    assert!(250.0 <= volume.lower && volume.contains(346.3) && volume.upper <= 480.0, "{volume:?}");
    // As long as exact numbers may be nested. 60 links reach at most 300.
    let (min, max) = read_scene(arm(60), None).unwrap().bounds().unwrap().unwrap();
    assert!((0..3).all(|axis| max[axis] - min[axis] < 700.0), "{min:?} {max:?}");
}

#[test]
fn bounds_of_deep_and_shared_nestings_cost_little() {
    let start = std::time::Instant::now();
    let scene = read_scene(arm(3000), None).unwrap();
    let _ = scene.bounds().unwrap();
    let turn = Affine::new([[0.8, -0.6, 0.0, 1.0], [0.6, 0.8, 0.0, 0.0], [0.0, 0.0, 1.0, 0.5]]).unwrap();
    let mut shared = leafless::Csg::cuboid([0.0; 3], [1.0; 3]).unwrap();
    for _ in 0..200 {
        shared = leafless::Csg::union_of([shared.clone(), shared.placed(&turn).unwrap()]).unwrap();
    }
    assert!(leafless::Solid::bounds(&shared).is_some());
    assert!(start.elapsed().as_secs_f64() < 5.0, "{:?}", start.elapsed());
}

/// Every limit's message names its subject, and no limit is reported as a shortage of memory.
#[test]
fn limits_say_what_they_are_of() {
    let turn = "multmatrix([[0.8,-0.6,0,0],[0.48,0.64,-0.6,0],[0.36,0.48,0.8,0],[0,0,0,1]]) ";
    let step = "multmatrix([[1,0,0,1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) ";
    let mesh = "polyhedron([[0,0,0],[4,0,0],[0,4,0],[0,0,4]], [[0,1,2],[0,3,1],[0,2,3],[1,3,2]]);";
    let cases = [
        (format!("{}cube(1);", turn.repeat(200)), "16384 bits for the exact numbers of nested placements"),
        (format!("{}{mesh}", step.repeat(300)), "256 matrices around a mesh or octree"),
        (
            format!("linear_extrude(height = 1) {}square(1);", turn.repeat(200)),
            "16384 bits for the exact numbers of nested placements",
        ),
    ];
    let frame = Frame::new([-8.0; 3], 16.0, 4).unwrap();
    for (text, words) in cases {
        let built = read_scene(&text, None)
            .and_then(|scene| scene.solid(&frame))
            .and_then(|solid| build(&solid, &frame, Rule::Certified, &Control::default()));
        let error = built.map(|_| ()).unwrap_err();
        assert!(matches!(error, Error::Limit { .. } | Error::Scene(_)), "{error:?}");
        assert!(error.to_string().contains(words), "{error}");
    }
}

/// A tetrahedron with one inverted facet and one missing facet encloses points below its lowest corner under
/// the fill rule.
#[test]
fn bounds_hold_what_a_polyhedron_with_a_turned_facet_encloses() {
    let text = "polyhedron([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]], [[0, 1, 2], [0, 3, 1], [0, 2, 3]]);";
    let turned = text.replace("[0, 1, 2]", "[0, 2, 1]").replace("[0, 3, 1], ", "[0, 3, 1], [1, 3, 2], ");
    for text in [text, turned.as_str()] {
        let (min, max) = read_scene(text, None).unwrap().bounds().unwrap().unwrap();
        let tree = in_cube(text);
        let mut count = 0;
        for at in 0..1 << 18 {
            let centre = [0, 6, 12].map(|shift| f64::from(at >> shift & 63) / 4.0 - 7.875);
            if tree.contains(centre) == Membership::Inside {
                count += 1;
                assert!((0..3).all(|k| min[k] <= centre[k] && centre[k] <= max[k]), "{text} {centre:?}");
            }
        }
        assert!(count > 100, "{text} {count}");
    }
}

#[test]
fn what_the_fuzzer_found_interesting() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus/scenes");
    let (mut count, mut scenes) = (0, 0);
    for entry in std::fs::read_dir(&corpus).unwrap() {
        count += 1;
        scenes += u32::from(scenes::scenes(&std::fs::read(entry.unwrap().path()).unwrap()));
    }
    assert!(count > 100 && scenes > 50, "{scenes} scenes of {count} inputs");
}

// ---- random scenes against an evaluation of their points --------------------------------------------------

/// A figure, or a solid, as a tree.
enum Shape {
    Square([f64; 2]),
    Disc(f64),
    Polygon(Vec<[f64; 2]>),
    Cube([f64; 3]),
    Ball(f64),
    Frustum(f64, [f64; 2]),
    Torus([f64; 2]),
    HalfSpace([f64; 4]),
    Prism { of: Box<Shape>, height: f64, scale: [f64; 2], lean: f64 },
    Turned { of: Box<Shape>, angle: f64, start: f64 },
    Placed([[f64; 4]; 3], Box<Shape>),
    Joined(&'static str, Vec<Shape>),
}

impl Shape {
    fn text(&self) -> String {
        match self {
            Shape::Square([x, y]) => format!("square([{x}, {y}], center = true);"),
            Shape::Disc(r) => format!("circle(r = {r});"),
            Shape::Polygon(points) => format!("polygon(points = {points:?}, paths = undef);"),
            Shape::Cube(size) => format!("cube({size:?}, center = true);"),
            Shape::Ball(r) => format!("sphere(r = {r});"),
            Shape::Frustum(h, [a, b]) => format!("cylinder(h = {h}, r1 = {a}, r2 = {b});"),
            Shape::Torus([major, minor]) => format!("torus({major}, {minor});"),
            Shape::HalfSpace(plane) => format!("halfspace({plane:?});"),
            Shape::Prism { of, height, scale, lean } => {
                let v = [*lean, 0.0, 1.0];
                format!("linear_extrude(height = {height}, scale = {scale:?}, v = {v:?}) {}", of.text())
            }
            Shape::Turned { of, angle, start } => {
                format!("rotate_extrude(angle = {angle}, start = {start}) {}", of.text())
            }
            Shape::Placed([x, y, z], of) => {
                format!("multmatrix([{x:?}, {y:?}, {z:?}, [0, 0, 0, 1]]) {}", of.text())
            }
            Shape::Joined(name, parts) => {
                format!("{name}() {{ {} }}", parts.iter().map(Shape::text).collect::<String>())
            }
        }
    }

    /// True if a point is inside, in rounded arithmetic.
    fn holds(&self, p: [f64; 3]) -> bool {
        let [x, y, z] = p;
        match self {
            Shape::Square([a, b]) => x.abs() <= a / 2.0 && y.abs() <= b / 2.0,
            Shape::Disc(r) => x.hypot(y) <= *r,
            Shape::Polygon(points) => {
                let mut inside = false;
                for (i, a) in points.iter().enumerate() {
                    let b = points[(i + 1) % points.len()];
                    let crosses = (a[1] > y) != (b[1] > y);
                    inside ^= crosses && x < (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]) + a[0];
                }
                inside
            }
            Shape::Cube(size) => (0..3).all(|axis| p[axis].abs() <= size[axis] / 2.0),
            Shape::Ball(r) => x.hypot(y).hypot(z) <= *r,
            Shape::Frustum(h, [a, b]) => (0.0..=*h).contains(&z) && x.hypot(y) <= a + (b - a) * z / h,
            Shape::Torus([major, minor]) => (x.hypot(y) - major).hypot(z) <= *minor,
            Shape::HalfSpace([a, b, c, d]) => a * x + b * y + c * z + d >= 0.0,
            Shape::Prism { of, height, scale, lean } => {
                let [a, b] = scale.map(|scale| 1.0 + (scale - 1.0) * z / height);
                (0.0..=*height).contains(&z) && of.holds([(x - lean * z) / a, y / b, 0.0])
            }
            Shape::Turned { of, angle, start } => {
                let from = if *angle < 0.0 { start + angle } else { *start };
                let turn = (y.atan2(x).to_degrees() - from).rem_euclid(360.0);
                turn <= angle.abs() && of.holds([x.hypot(y), z, 0.0])
            }
            Shape::Placed(rows, of) => {
                let [a, b, c] = rows.map(|row| [row[0], row[1], row[2]]);
                let cross = |u: [f64; 3], v: [f64; 3]| {
                    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
                };
                let columns = [cross(b, c), cross(c, a), cross(a, b)];
                let determinant: f64 = (0..3).map(|k| a[k] * columns[0][k]).sum();
                let q = [x - rows[0][3], y - rows[1][3], z - rows[2][3]];
                of.holds([0, 1, 2].map(|k| (0..3).map(|i| columns[i][k] * q[i]).sum::<f64>() / determinant))
            }
            Shape::Joined("intersection", parts) => parts.iter().all(|part| part.holds(p)),
            Shape::Joined("difference", parts) => {
                parts[0].holds(p) && !parts[1..].iter().any(|part| part.holds(p))
            }
            Shape::Joined(_, parts) => parts.iter().any(|part| part.holds(p)),
        }
    }

    /// Numbers with one decimal. Hardly any of them is a double.
    fn number(random: &mut Random, low: f64, high: f64) -> f64 {
        let tenths = ((high - low) * 10.0) as usize + 1;
        ((low * 10.0).round() + random.index(tenths) as f64) / 10.0
    }

    fn joined(random: &mut Random, depth: u32, part: fn(&mut Random, u32) -> Shape) -> Shape {
        let name = ["union", "intersection", "difference"][random.index(3)];
        Shape::Joined(name, (0..1 + random.index(3)).map(|_| part(random, depth - 1)).collect())
    }

    /// A placement with six digits, as in OpenSCAD's dumps.
    fn placed(random: &mut Random, is_flat: bool, of: Shape) -> Shape {
        let number = |random: &mut Random, low, high| Self::number(random, low, high);
        let (sin, cos) = number(random, -3.1, 3.1).sin_cos();
        let [sin, cos] = [sin, cos].map(|c| (c * 1e6).round() / 1e6);
        let scale = if random.index(3) == 0 { number(random, 0.5, 1.5) } else { 1.0 };
        let t = [0; 3].map(|_| number(random, -2.0, 2.0));
        let rows = match random.index(if is_flat { 1 } else { 3 }) {
            0 => [[scale * cos, -sin, 0.0, t[0]], [scale * sin, cos, 0.0, t[1]], [0.0, 0.0, 1.0, t[2]]],
            1 => [[scale, 0.0, 0.0, t[0]], [0.0, cos, -sin, t[1]], [0.0, sin, cos, t[2]]],
            _ => [[cos, 0.3, sin, t[0]], [0.0, scale, 0.2, t[1]], [-sin, 0.0, cos, t[2]]],
        };
        Shape::Placed(rows, Box::new(of))
    }

    fn figure(random: &mut Random, depth: u32) -> Shape {
        let number = |random: &mut Random, low, high| Self::number(random, low, high);
        match random.index(if depth == 0 { 4 } else { 8 }) {
            0 => Shape::Square([number(random, 1.0, 6.0), number(random, 1.0, 6.0)]),
            1 => Shape::Disc(number(random, 0.5, 4.0)),
            // Around the origin, in the simplest form.
            2 | 3 => {
                let n = 3 + random.index(8);
                let corner = |i: usize| {
                    let (sin, cos) = (i as f64 * std::f64::consts::TAU / n as f64).sin_cos();
                    let radius = number(random, 1.0, 5.0);
                    [radius * cos, radius * sin].map(|c| (c * 100.0).round() / 100.0)
                };
                Shape::Polygon((0..n).map(corner).collect())
            }
            4 | 5 => {
                let of = Self::figure(random, depth - 1);
                Self::placed(random, true, of)
            }
            _ => Self::joined(random, depth, Self::figure),
        }
    }

    /// A figure on the right side of the y axis.
    fn profile(random: &mut Random, depth: u32) -> Shape {
        let number = |random: &mut Random, low, high| Self::number(random, low, high);
        let (x, y) = (number(random, 3.0, 5.0), number(random, -2.0, 2.0));
        let moved = |scale: f64| [[scale, 0.0, 0.0, x], [0.0, scale, 0.0, y], [0.0, 0.0, 1.0, 0.0]];
        let of = match random.index(if depth == 0 { 3 } else { 5 }) {
            0 => Shape::Disc(number(random, 0.5, 2.0)),
            1 => Shape::Square([number(random, 0.5, 4.0), number(random, 0.5, 4.0)]),
            2 => Shape::Polygon(vec![[-2.1, 0.3], [0.2, -1.7], [1.9, 0.1], [0.4, 0.2], [-0.3, 2.2]]),
            _ => return Self::joined(random, depth, Self::profile),
        };
        Shape::Placed(moved(number(random, 0.7, 1.3)), Box::new(of))
    }

    fn solid(random: &mut Random, depth: u32) -> Shape {
        let number = |random: &mut Random, low, high| Self::number(random, low, high);
        match random.index(if depth == 0 { 8 } else { 13 }) {
            0 => Shape::Cube([0; 3].map(|_| number(random, 1.0, 7.0))),
            1 => Shape::Ball(number(random, 1.0, 5.0)),
            2 => {
                Shape::Frustum(number(random, 1.0, 6.0), [number(random, 0.1, 4.0), number(random, 0.0, 4.0)])
            }
            3 => Shape::Torus([number(random, 1.5, 4.0), number(random, 0.5, 2.0)]),
            4 => Shape::HalfSpace([0; 4].map(|_| number(random, 0.1, 2.0))),
            5 | 6 => {
                let of = Box::new(Self::figure(random, depth));
                let uniform = number(random, 0.0, 1.5);
                let scale = if random.index(2) == 0 { [1.0; 2] } else { [uniform; 2] };
                Shape::Prism { of, height: number(random, 1.0, 5.0), scale, lean: number(random, -1.0, 1.0) }
            }
            7 => {
                let of = Box::new(Self::profile(random, depth));
                let angle = if random.index(3) == 0 { 360.0 } else { number(random, -350.0, 350.0) + 0.01 };
                Shape::Turned { of, angle, start: number(random, -90.0, 90.0) }
            }
            8 | 9 => {
                let of = Self::solid(random, depth - 1);
                Self::placed(random, false, of)
            }
            _ => Self::joined(random, depth, Self::solid),
        }
    }
}

#[test]
fn points_never_contradict_cells() {
    let frame = Frame::new([-8.0; 3], 16.0, 5).unwrap();
    let mut random = Random(11);
    let (mut decided, mut inside, mut asked) = (0, 0, 0);
    for _ in 0..400 {
        let shape = Shape::solid(&mut random, 3);
        let text = shape.text();
        let tree = tree(&text, &frame);
        for _ in 0..2000 {
            let point = [0; 3].map(|_| random.between(-8.0, 8.0));
            asked += 1;
            let answer = tree.contains(point);
            if answer != Membership::Undecided {
                decided += 1;
                inside += usize::from(answer == Membership::Inside);
                assert_eq!(answer == Membership::Inside, shape.holds(point), "{point:?}: {text}");
            }
        }
    }
    // The test decides enough points, inside and outside.
    assert!(decided > asked * 3 / 4 && inside > asked / 50, "{decided} and {inside} of {asked}");
}

// ---- files and meshes
// ---------------------------------------------------------------------------------------

/// The block [0, 2] × [0, 1] × [0, 1].
fn block() -> TriangleMesh {
    let corner = |k: usize| [(k & 1) as f64 * 2.0, (k >> 1 & 1) as f64, (k >> 2) as f64];
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh::new((0..8).map(corner).collect(), triangles).unwrap()
}

#[test]
fn files_beside_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("block.stl"), write_stl(&block()).unwrap()).unwrap();
    let frame = Frame::new([-8.0; 3], 16.0, 6).unwrap();
    let octree = in_cube("difference() { cube(4); cube(2); }");
    leafless::file::save(&octree, folder.path().join("part.lfl")).unwrap();
    let read = |text: &str| {
        let path = folder.path().join("scene.csg");
        std::fs::write(&path, text).unwrap();
        let scene = leafless::scene::open_scene(&path)?;
        build(&scene.solid(&frame)?, &frame, Rule::Certified, &Control::default())
    };
    let check = |text: &str, truth: f64, width: f64| {
        let tree = read(text).unwrap();
        let volume = tree.statistics().volume();
        assert!(volume.lower <= truth && truth <= volume.upper, "{text}: {volume:?}");
        assert!(volume.upper - volume.lower <= width, "{text}: {volume:?}");
    };
    check("mesh(\"block.stl\");", 2.0, 0.0);
    // Hair cracks are closed, as for every file that is read.
    let mut cracked = String::new();
    for (at, triangle) in block().triangles().iter().enumerate() {
        for vertex in triangle.map(|vertex| block().vertices()[vertex as usize]) {
            let [x, y, z] = vertex.map(|c| c + if at == 0 { 1e-8 } else { 0.0 });
            writeln!(cracked, "v {x} {y} {z}").unwrap();
        }
        writeln!(cracked, "f -3 -2 -1").unwrap();
    }
    std::fs::write(folder.path().join("cracked.obj"), cracked).unwrap();
    std::fs::write(folder.path().join("scene.csg"), "import(\"cracked.obj\");").unwrap();
    let scene = leafless::scene::open_scene(folder.path().join("scene.csg")).unwrap();
    let report = scene.report().meshes[0].report;
    assert!(report.sewn > 0 && report.boundary_edges == 0, "{report:?}");
    check(
        "import(file = \"block.stl\", origin = [0, 0], scale = 1, center = false, convexity = 1, timestamp = 17);",
        2.0,
        0.0,
    );
    check("octree(\"part.lfl\");", 56.0, 0.0);
    check("difference() { octree(file = \"part.lfl\"); mesh(file = \"block.stl\"); }", 56.0, 0.0);
    // Placements: exact ones, one that is rounded, and several around operations.
    let moved = "multmatrix([[0, -1, 0, 2.5], [1, 0, 0, 0.25], [0, 0, 2, 0], [0, 0, 0, 1]])";
    check(&format!("{moved} mesh(\"block.stl\");"), 4.0, 0.0);
    check(&format!("{moved} {moved} mesh(\"block.stl\");"), 8.0, 16.0);
    let turned = "multmatrix([[0.8, -0.6, 0, 0.1], [0.6, 0.8, 0, 0.2], [0, 0, 1, 0.3], [0, 0, 0, 1]])";
    check(&format!("{turned} mesh(\"block.stl\");"), 2.0, 10.0);
    check(&format!("{turned} {turned} mesh(\"block.stl\");"), 2.0, 14.0);
    check(&format!("{turned} difference() {{ cube(3); {turned} mesh(\"block.stl\"); }}"), 26.1, 60.0);
    check(&format!("{turned} octree(\"part.lfl\");"), 56.0, 90.0);
    check(&format!("{turned} {moved} octree(\"part.lfl\");"), 112.0, 320.0);
    check("multmatrix([[1,0,0,-4],[0,1,0,0],[0,0,1,1],[0,0,0,1]]) octree(\"part.lfl\");", 56.0, 0.0);

    for (text, place, words) in [
        ("group() {\n  mesh(\"none.stl\"); }", (2, 8), "none.stl: "),
        ("mesh(\"part.lfl\");", (1, 6), "part.lfl: "),
        ("octree(\"block.stl\");", (1, 8), "not a Leafless file"),
        ("import(\"plan.dxf\");", (1, 1), "`import` of files `dxf` is not supported"),
        ("import(\"block.stl\", center = true);", (1, 1), "without `center`"),
    ] {
        let error = read(text).err().unwrap_or_else(|| panic!("{text}"));
        match error.cause() {
            Error::Scene(error) => {
                assert_eq!((error.line(), error.column()), place, "{text}: {error}");
                assert!(error.problem().contains(words), "{text}: {error}");
            }
            other => panic!("{text}: {other:?}"),
        }
    }
    let missing = leafless::scene::open_scene(folder.path().join("none.csg")).err().unwrap();
    assert!(
        matches!(missing.cause(), Error::Io(_)) && missing.to_string().contains("none.csg: "),
        "{missing}"
    );
    std::fs::write(folder.path().join("latin.csg"), b"cube(1);\n// gr\xFC\xDFe").unwrap();
    let error = leafless::scene::open_scene(folder.path().join("latin.csg")).err().unwrap();
    assert_eq!(error.cause().to_string(), "line 2, column 6: the text is not UTF-8");
    // Without a folder, no files can be read.
    let (line, column, problem) = refusal("mesh(\"block.stl\");");
    assert!((line, column) == (1, 6) && problem.contains("folder"), "{problem}");
    assert!(read_scene("mesh(\"block.stl\");", Some(Path::new(folder.path()))).is_ok());
}

// ---- errors
// -------------------------------------------------------------------------------------------------

#[test]
fn errors_say_where() {
    for (text, place, words) in [
        // Syntax.
        ("cube", (1, 5), "the text ends here; expected `(`"),
        ("cube(", (1, 6), "the text ends here; expected a number"),
        ("cube(1", (1, 7), "expected `,` or `)`"),
        ("cube(1)", (1, 8), "the text ends here; expected a call, `;` or `{`"),
        ("cube(1);\n  }", (2, 3), "expected a call"),
        ("group() {\n\n", (3, 1), "expected a call or `}`"),
        ("group() { cube(1) }", (1, 19), "expected a call, `;` or `{`"),
        ("cube(1 2);", (1, 8), "expected `,` or `)`"),
        ("cube([1, 2, 3);", (1, 14), "expected `,` or `]`"),
        ("cube([, 2]);", (1, 7), "expected a number, a list"),
        ("cube(size = );", (1, 13), "expected a number, a list"),
        ("cube(size = 1..2);", (1, 13), "expected a number, a list"),
        ("cube(size = 1x);", (1, 13), "expected a number, a list"),
        ("cube(\"a);", (1, 6), "this text does not end"),
        ("cube(1); /* never", (1, 10), "this comment does not end"),
        ("/* ü€𝄞 */ 7", (1, 11), "expected a call"),
        ("\u{FEFF}cube(1); 7", (1, 10), "expected a call"),
        ("x = 5;", (1, 3), "expected `(`"),
        ("!cube(1);", (1, 1), "the modifier `!` is not supported"),
        ("group() { # 7; }", (1, 13), "expected a call or `}`"),
        // Calls.
        ("group() {\n  cubus(1);\n}", (2, 3), "unknown call `cubus`"),
        ("part(1) cube(1);", (1, 1), "openscad -o model.csg model.scad"),
        ("group() { hull() { cube(1); } }", (1, 11), "`hull` is not supported"),
        ("minkowski(convexity = 0) { cube(1); cube(2); }", (1, 1), "`minkowski` is not supported"),
        ("linear_extrude(height = 1) text(text = \"A\");", (1, 28), "`text` is not supported"),
        ("projection(cut = true) cube(1);", (1, 1), "`projection` is not supported"),
        ("linear_extrude(height = 1) offset(r = 1) square(1);", (1, 28), "`offset` is not supported"),
        ("resize(newsize = [1,2,3]) cube(1);", (1, 1), "`resize` is not supported"),
        ("surface(file = \"a.png\");", (1, 1), "`surface` is not supported"),
        ("roof() square(1);", (1, 1), "`roof` is not supported"),
        ("fill() square(1);", (1, 1), "`fill` is not supported"),
        ("cube(1) sphere(1);", (1, 9), "`cube` has no block"),
        // Arguments.
        ("cube(edge = 1);", (1, 6), "`cube` has no parameter `edge`"),
        ("cube(1, true, 3);", (1, 15), "`cube` has 2 parameters only"),
        ("cube(1, size = 2);", (1, 9), "`cube` is given `size` twice"),
        ("difference(1) cube(1);", (1, 12), "`difference` has 0 parameters only"),
        ("multmatrix() cube(1);", (1, 1), "`m` is missing"),
        ("cube(size = \"big\");", (1, 13), "expected a number"),
        ("cube(size = [1, 2]);", (1, 13), "expected 3 items, found 2"),
        ("cube(size = [1, [2], 3]);", (1, 17), "expected a number"),
        ("cube(size = 1, center = 1);", (1, 25), "expected true or false"),
        ("sphere(r = inf);", (1, 12), "must be zero or of a magnitude"),
        ("sphere(r = -inf);", (1, 12), "must be zero or of a magnitude"),
        ("sphere(r = nan);", (1, 12), "must be zero or of a magnitude"),
        ("sphere(r = 1e999);", (1, 12), "must be zero or of a magnitude"),
        ("sphere(r = 1e80);", (1, 12), "must be zero or of a magnitude"),
        ("sphere(r = 1e-80);", (1, 12), "must be zero or of a magnitude"),
        ("multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,0]]) cube(1);", (1, 12), "expected 4 items, found 3"),
        (
            "multmatrix([[1,0,0,0],[0,1,0],[0,0,1,0],[0,0,0,1]]) cube(1);",
            (1, 23),
            "expected 4 items, found 3",
        ),
        ("multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0.5,1]]) cube(1);", (1, 43), "the last row"),
        ("multmatrix([[1e30,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) cube(1);", (1, 12), "2^64"),
        ("halfspace([0, 0, 0, 1]);", (1, 1), "`halfspace` cannot be had"),
        ("halfspace([1, 0, 0]);", (1, 11), "expected 4 items, found 3"),
        ("quadric([1, 0, 0, 0]);", (1, 9), "expected 10 items, found 4"),
        ("quadric([0, 0, 0, 0, 0, 0, 0, 0, 0, 1]);", (1, 1), "`quadric` cannot be had"),
        ("polyhedron(points = [[0, 0, 0]], faces = [[0, 1, 2]]);", (1, 47), "there is no point 1"),
        ("polyhedron(points = [[0, 0]], faces = []);", (1, 22), "expected 3 items, found 2"),
        ("polyhedron(points = [[0, 0, 0]], faces = [[0, -1, 2]]);", (1, 47), "expected a whole number"),
        ("polyhedron(points = [[0, 0, 0]], faces = [[0, 0.5, 2]]);", (1, 47), "expected a whole number"),
        ("mesh(\"a\\qb\");", (1, 6), "escape sequences"),
        // Figures and solids.
        ("square(1);", (1, 1), "the scene is flat"),
        ("group() { cube(1); square(1); }", (1, 20), "mixed"),
        ("union() { square(1); group() { cube(1); } }", (1, 22), "mixed"),
        ("linear_extrude(height = 1) cube(1);", (1, 1), "takes figures of the plane"),
        ("rotate_extrude() sphere(1);", (1, 1), "takes figures of the plane"),
        ("linear_extrude(height = 1, twist = 90) square(1);", (1, 1), "without `twist`"),
        ("linear_extrude(height = 1, scale = [1, 2]) circle(1);", (1, 1), "the same along x and y"),
        (
            "rotate_extrude() difference() { square(4); multmatrix([[1,0,0,-1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) \
             circle(2); }",
            (1, 1),
            "beyond the axis",
        ),
        ("power([1, 0, 0.5], [0, 0, 1], [0, 0, 1], 1);", (1, 14), "expected a whole number"),
        ("power([1, 0, 65], [0, 0, 1], [0, 0, 1], 1);", (1, 1), "exponent"),
        ("power([1, 0, 2], [0, 0, 1], [0, 0, 1]);", (1, 1), "`constant` is missing"),
        ("torus(2, 0);", (1, 1), "`torus` cannot be had"),
        ("torus(2);", (1, 1), "`minor` is missing"),
        ("rotate_extrude() circle(1);", (1, 1), "on one side of the axis"),
        (
            "rotate_extrude() multmatrix([[1,0,0,9],[0,2,0,0],[0,0,1,0],[0,0,0,1]]) circle(1);",
            (1, 1),
            "no circle",
        ),
        ("linear_extrude(height = 1) polygon([[0,0],[2,2],[2,0],[0,2]]);", (1, 36), "crosses itself"),
        (
            "linear_extrude(height = 1) polygon([[0,0],[2,0],[2,2]],\n paths = [[0, 1, 2], [0, 1]]);",
            (2, 22),
            "at least three corners",
        ),
        (
            "linear_extrude(height = 1) polygon([[0,0],[2,0],[2,2]], [[0, 1, 3]]);",
            (1, 65),
            "there is no point 3",
        ),
    ] {
        let (line, column, problem) = refusal(text);
        assert_eq!((line, column), place, "{text}: {problem}");
        assert!(problem.contains(words), "{text}: {problem}");
    }
}

// ---- hostile texts
// -----------------------------------------------------------------------------------

#[test]
fn nesting() {
    let n = 100_000;
    let text = "group() {".repeat(n) + "cube(2);" + &"}".repeat(n);
    assert_eq!(volume(&text).lower, 8.0);
    let text = "group() ".repeat(n) + "cube(2);";
    assert_eq!(volume(&text).lower, 8.0);
    let unit = "multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) ";
    assert_eq!(volume(&(unit.repeat(n) + "cube(2);")).lower, 8.0);
    let text = "difference() { cube(2); ".repeat(n) + "cube(1);" + &"}".repeat(n);
    let frame = Frame::new([-8.0; 3], 16.0, 3).unwrap();
    assert!(tree(&text, &frame).statistics().volume().upper <= 8.0);
    let (_, column, _) = refusal(&"group() {".repeat(n));
    assert_eq!(column, 9 * n as u64 + 1);
    let (_, _, problem) = refusal(&format!("cube({}1{});", "[".repeat(n), "]".repeat(n)));
    assert!(problem.contains("expected 3 items"), "{problem}");
    refusal(&format!("cube({}", "[".repeat(n)));
    // Nested revolutions end at a limit.
    let turned = "multmatrix([[0.8,-0.6,0,0.1],[0.6,0.8,0,0],[0,0,1,0],[0,0,0,1]]) ";
    let scene = read_scene(&(turned.repeat(2000) + "cube(2);"), None).unwrap();
    let solid = scene.solid(&frame).unwrap();
    assert!(matches!(build(&solid, &frame, Rule::Certified, &Control::default()), Err(Error::Limit { .. })));
    let (_, _, problem) =
        refusal(&format!("linear_extrude(height = 1) {} square(2);", turned.repeat(100_000)));
    assert!(problem.contains("limit"), "{problem}");
    let tetrahedron = "polyhedron([[0, 0, 0], [4, 0, 0], [0, 5, 0], [0, 0, 6]], [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);";
    let scene = read_scene(&(turned.repeat(2000) + tetrahedron), None).unwrap();
    assert!(matches!(scene.solid(&frame), Err(Error::Limit { .. })));
}

#[test]
fn many() {
    let mut text = String::new();
    for i in 0..3000 {
        let (x, y, z) = (i % 15, i / 15 % 15, i / 225);
        writeln!(text, "multmatrix([[1,0,0,{x}],[0,1,0,{y}],[0,0,1,{z}],[0,0,0,1]]) sphere(0.25);").unwrap();
    }
    let frame = Frame::new([-1.0; 3], 16.0, 6).unwrap();
    let volume = tree(&text, &frame).statistics().volume();
    let truth = 3000.0 * PI * 4.0 / 3.0 * 0.25f64.powi(3);
    assert!(volume.lower <= truth && truth <= volume.upper);
}

#[test]
fn truncated_and_changed_texts_are_answered() {
    for text in &scenes::SEEDS[..8] {
        assert!(scenes::scenes(text.as_bytes()), "{text}");
    }
    assert!(!scenes::scenes(scenes::SEEDS[8].as_bytes()));
    for text in scenes::SEEDS {
        (0..text.len()).for_each(|end| drop(read_scene(&text.as_bytes()[..end], None)));
    }
    let mut random = Random(7);
    const PIECES: [&str; 20] = [
        "(", ")", "[", "]", "{", "}", ";", ",", "=", "\"", "1e300", "-", "nan", "undef", "cube", "\\", "/*",
        "//", "%", "é",
    ];
    let mut read = 0;
    for _ in 0..20_000 {
        let mut changed = scenes::SEEDS[random.index(scenes::SEEDS.len())].as_bytes().to_vec();
        for _ in 0..1 + random.index(3) {
            let (at, piece) = (random.index(changed.len()), PIECES[random.index(PIECES.len())]);
            match random.index(4) {
                0 => changed[at] = piece.as_bytes()[0],
                1 => drop(changed.remove(at)),
                2 => drop(changed.splice(at..at, piece.bytes())),
                // Other numbers.
                _ => {
                    let digits = changed.iter().filter(|byte| byte.is_ascii_digit()).count();
                    let which = random.index(digits);
                    let digit = changed.iter_mut().filter(|byte| byte.is_ascii_digit()).nth(which);
                    digit.into_iter().for_each(|digit| *digit = b"0123456789.-"[random.index(12)]);
                }
            }
        }
        read += usize::from(scenes::scenes(&changed));
    }
    assert!(read > 1500, "{read}");
}

#[test]
#[ignore = "writes the seeds for the fuzzer"]
fn write_seeds() {
    let folder = std::env::var_os("LEAFLESS_SEEDS").expect("LEAFLESS_SEEDS must name a directory");
    let folder = Path::new(&folder).join("scenes");
    std::fs::create_dir_all(&folder).unwrap();
    for (i, seed) in scenes::SEEDS.iter().enumerate() {
        std::fs::write(folder.join(format!("seed-{i:03}")), seed).unwrap();
    }
}
