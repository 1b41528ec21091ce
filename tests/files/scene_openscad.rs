//! Scenes against OpenSCAD: the volumes of STL files that OpenSCAD 2021.01 exports, with coordinates of six
//! digits, and its dumps of the same models.

#![cfg(feature = "scene")]

use leafless::scene::{Facets, Scene, SceneOptions, read_scene};
use leafless::{Control, Error, Frame, Interval, measure};
use std::f64::consts::PI;

/// Measures the volume to two hundredths.
fn volume(scene: &Scene) -> Interval {
    let (min, max) = scene.bounds().unwrap().unwrap();
    let frame = Frame::around(min, max, 20).unwrap();
    let measures = measure(&scene.solid(&frame).unwrap(), &frame, 0.02, &Control::default()).unwrap();
    assert!(!measures.clipped && measures.volume.width() <= 0.02 * measures.volume.upper);
    measures.volume
}

/// Checks that the volume is OpenSCAD's, up to the digits of its files.
fn check(scene: &Scene, truth: f64) {
    let found = volume(scene);
    let slack = truth * 1e-5;
    assert!(found.lower - slack <= truth && truth <= found.upper + slack, "{truth} {found:?}");
}

fn drawn(text: &str, facets: Facets) -> Scene {
    SceneOptions::with_facets(facets).read(text, None).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

const SHIFT: &str = "multmatrix([[1, 0, 0, 5], [0, 1, 0, 1], [0, 0, 1, 0], [0, 0, 0, 1]])";

/// Dumps with small `$fn`, their volumes by OpenSCAD 2021.01, and the numbers of calls that are polygons.
fn models() -> Vec<(String, f64, u64)> {
    let fine = "$fa = 12, $fs = 2";
    vec![
        // A hex nut with a bore of twelve sides.
        (
            format!(
                "difference() {{ cylinder($fn = 6, {fine}, h = 4, r1 = 10, r2 = 10, center = false); \
                 multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -1], [0, 0, 0, 1]]) {{ \
                 cylinder($fn = 12, {fine}, h = 6, r1 = 5.5, r2 = 5.5, center = false); }} }}"
            ),
            676.229_978_7,
            2,
        ),
        (format!("cylinder($fn = 6, {fine}, h = 5, r1 = 5, r2 = 5, center = false);"), 324.759_75, 1),
        // A four-sided pyramid.
        (format!("cylinder($fn = 4, {fine}, h = 6, r1 = 5, r2 = 0, center = false);"), 100.0, 1),
        (format!("sphere($fn = 8, {fine}, r = 5);"), 403.631_536_9, 1),
        (format!("sphere($fn = 5, {fine}, r = 5);"), 300.284_953_4, 1),
        // A tapered extrusion.
        (
            format!(
                "linear_extrude(height = 6, center = true, convexity = 1, scale = [0.5, 0.5], $fn = 0, {fine}) {{ \
                 multmatrix([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {{ \
                 circle($fn = 5, {fine}, r = 4); }} }}"
            ),
            133.147_923_9,
            1,
        ),
        // Solids of revolution: a whole turn, and parts of one in both directions.
        (
            format!(
                "rotate_extrude(angle = 360, convexity = 2, $fn = 7, {fine}) {{ {SHIFT} {{ \
                 circle($fn = 6, {fine}, r = 2); }} }}"
            ),
            284.376_156_0,
            2,
        ),
        (
            format!(
                "rotate_extrude(angle = 250, convexity = 2, $fn = 12, {fine}) {{ \
                 multmatrix([[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {{ \
                 square(size = [3, 2], center = false); }} }}"
            ),
            112.055_001_8,
            1,
        ),
        (
            format!(
                "rotate_extrude(angle = -100, convexity = 2, $fn = 9, {fine}) {{ \
                 polygon(points = [[-2, 0], [-6, 1], [-3, 4]], paths = undef, convexity = 1); }}"
            ),
            42.132_463_5,
            1,
        ),
    ]
}

#[test]
fn small_numbers_of_fragments_are_prisms_and_pyramids() {
    for (text, truth, polygons) in models() {
        let scene = read_scene(&text, None).unwrap();
        check(&scene, truth);
        assert_eq!((scene.report().polygons, scene.report().exact), (polygons, 0), "{text}");
        check(&drawn(&text, Facets::Polygon), truth);
        // With exact curves, they are larger.
        let round = drawn(&text, Facets::Exact);
        assert_eq!((round.report().polygons, round.report().exact), (0, polygons), "{text}");
        if !text.contains("difference") {
            assert!(volume(&round).lower > truth * 1.02, "{text}");
        }
    }
}

/// The extents of polygons show their corners' places. The corners are OpenSCAD's, to six digits.
#[test]
fn corners_are_where_openscad_has_them() {
    let boxes = [
        ([-10.0, -8.66025, 0.0], [10.0, 8.66025, 4.0]),
        ([-5.0, -4.33013, 0.0], [5.0, 4.33013, 5.0]),
        ([-5.0, -5.0, 0.0], [5.0, 5.0, 6.0]),
        ([-4.6194, -4.6194, -4.6194], [4.6194, 4.6194, 4.6194]),
        ([-4.04508, -4.75528, -4.33013], [5.0, 4.75528, 4.33013]),
        ([-2.23607, -3.80423, -3.0], [5.0, 3.80423, 3.0]),
        ([-7.0, -6.8245, -0.732051], [6.30678, 6.8245, 2.73205]),
        ([-5.94867, -5.63816, 0.0], [6.0, 5.98715, 2.0]),
        ([-6.0, 0.0, 0.0], [1.04189, 5.90885, 4.0]),
    ];
    for ((text, ..), (low, high)) in models().into_iter().zip(boxes) {
        let (min, max) = read_scene(&text, None).unwrap().bounds().unwrap().unwrap();
        for axis in 0..3 {
            let off = (min[axis] - low[axis]).abs().max((max[axis] - high[axis]).abs());
            assert!(off < 2e-5, "{text}\n{min:?} {max:?}");
        }
    }
}

/// With `$fn = 0`, curves are exact, unless all curves are to become polygons. Then `$fa` and `$fs` give the
/// number of sides.
#[test]
fn all_curves_as_polygons_have_the_volumes_of_openscad() {
    let fine = "$fn = 0, $fa = 12, $fs = 2";
    let text = format!(
        "union() {{ multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 4], [0, 0, 0, 1]]) {{ sphere({fine}, r = 3); }}
         cylinder({fine}, h = 2, r1 = 4, r2 = 3, center = false);
         linear_extrude(height = 1, center = false, convexity = 1, scale = [1, 1], {fine}) {{ circle({fine}, r = 5); }}
         multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -3], [0, 0, 0, 1]]) {{
         rotate_extrude(angle = 360, convexity = 2, {fine}) {{
         multmatrix([[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {{ circle({fine}, r = 1); }} }} }} }}"
    );
    let polygons = drawn(&text, Facets::Polygon);
    assert_eq!((polygons.report().polygons, polygons.report().exact), (5, 0));
    check(&polygons, 241.380_313_0);
    let auto = read_scene(&text, None).unwrap();
    assert_eq!((auto.report().polygons, auto.report().exact), (0, 5));
    assert!(volume(&auto).lower > 250.0);
    // A figure with a circle in it is revolved exactly, and no side of a polygon is counted.
    let mixed =
        "rotate_extrude($fn = 6) multmatrix([[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) circle(r = 2);";
    let mixed = read_scene(mixed, None).unwrap();
    assert_eq!((mixed.report().polygons, mixed.report().exact), (0, 2));
    check(&mixed, 2.0 * PI * PI * 20.0);
}

/// Different scales need sides without curves. OpenSCAD splits each side into two triangles: 225.1666 for
/// this solid, 228.4142 with 64 slices. This library gives the limit of more and more slices, A h (1 − 1/12)
/// by its formula.
#[test]
fn tapers_of_polygons_may_have_two_scales() {
    let taper = |slices: &str| {
        format!(
            "linear_extrude(height = 6, center = false, convexity = 1, {slices}scale = [0.5, 1.5]) {{ \
             circle($fn = 6, $fa = 12, $fs = 2, r = 4); }}"
        )
    };
    let scene = read_scene(taper(""), None).unwrap();
    check(&scene, 24.0 * 3f64.sqrt() * 6.0 * (1.0 - 1.0 / 12.0));
    assert_eq!(scene.report().ignored_slices, 0);
    assert_eq!(read_scene(taper("slices = 64, "), None).unwrap().report().ignored_slices, 1);
    assert_eq!(read_scene(taper("slices = 1, "), None).unwrap().report().ignored_slices, 0);
    let round = taper("").replace("$fn = 6", "$fn = 0");
    let Err(Error::Scene(error)) = read_scene(&round, None) else { panic!("taken") };
    assert!(error.problem().contains("drawn as polygons"), "{error}");
    assert!(SceneOptions::with_facets(Facets::Polygon).read(&round, None).is_ok());
}

#[test]
fn polygons_have_a_limit() {
    for (text, is_good) in [("$fn = 1024", true), ("$fn = 1025", false), ("$fn = 1e300", false)] {
        let text = format!("cylinder({text}, h = 1, r = 1);");
        assert!(read_scene(&text, None).is_ok());
        match SceneOptions::with_facets(Facets::Polygon).read(&text, None) {
            Ok(_) => assert!(is_good, "{text}"),
            Err(Error::Scene(error)) => {
                assert!(!is_good && error.problem().contains("1024 sides"), "{error}")
            }
            Err(error) => panic!("{error}"),
        }
    }
}

/// OpenSCAD exports an inside-out solid of volume 10.6667. This library reads it as an ordinary solid and
/// reports it.
#[test]
fn a_polyhedron_that_is_inside_out_is_a_solid_and_is_told_of() {
    let points = "points = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]]";
    let text = format!(
        "cube(1);\n  polyhedron({points}, faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], convexity = 1);"
    );
    let scene = read_scene(&text, None).unwrap();
    check(&scene, 10.666_666_7);
    let [mesh] = &scene.report().meshes[..] else { panic!() };
    assert_eq!((mesh.line, mesh.column, &*mesh.file, mesh.turned), (2, 3, "", 0));
    assert_eq!((mesh.report.inside_out_bodies, mesh.report.boundary_edges), (0, 0));
    // (For the rule of OpenSCAD the corners of a facet turn clockwise, seen from outside.)
    let other = text
        .replace("[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]", "[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]");
    assert_eq!(read_scene(&other, None).unwrap().report().meshes[0].report.inside_out_bodies, 1);
    check(&read_scene(&other, None).unwrap(), 10.666_666_7);
    // One facet is inverted, and one is missing.
    let turned = text.replace("[1, 2, 3]", "[1, 3, 2]");
    let report = &read_scene(&turned, None).unwrap().report().meshes[0].clone();
    assert_eq!((report.turned, report.report.misoriented_edges, report.report.boundary_edges), (1, 3, 0));
    let open = text.replace(", [1, 2, 3]", "");
    let report = &read_scene(&open, None).unwrap().report().meshes[0].clone();
    assert_eq!((report.turned, report.report.boundary_edges, report.report.boundary_loops), (0, 3, 1));
}

#[test]
fn an_open_import_is_told_of() {
    let folder = std::env::temp_dir().join(format!("leafless-open-import-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    // A box of 2 × 2 × 2 without its lid.
    let off = "OFF\n8 5 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n0 0 2\n2 0 2\n2 2 2\n0 2 2\n\
               4 0 3 2 1\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
    std::fs::write(folder.join("open.off"), off).unwrap();
    let text = "difference() {\n\timport(file = \"open.off\", convexity = 1);\n\tcube(1);\n}\n";
    let scene = read_scene(text, Some(&folder)).unwrap();
    let [mesh] = &scene.report().meshes[..] else { panic!() };
    assert_eq!((mesh.line, mesh.column, &*mesh.file), (2, 2, "open.off"));
    assert_eq!((mesh.report.boundary_edges, mesh.report.boundary_loops, mesh.turned), (4, 1, 0));
    assert_eq!(scene.bounds().unwrap(), Some(([0.0; 3], [2.0; 3])));
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_scene_without_anything_is_empty() {
    for (text, is_empty) in [("", true), ("group() { }", true), ("cube(0);", true), ("cube(1);", false)] {
        let scene = read_scene(text, None).unwrap();
        assert_eq!(scene.is_empty().unwrap(), is_empty, "{text}");
        if is_empty {
            let frame = Frame::new([0.0; 3], 1.0, 4).unwrap();
            let measures = measure(&scene.solid(&frame).unwrap(), &frame, 0.0, &Control::default()).unwrap();
            assert_eq!((measures.volume.lower, measures.volume.upper), (0.0, 0.0));
        }
    }
}
