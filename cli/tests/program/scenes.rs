//! The program on scenes: the drawing of curves, and the reports about meshes in scenes.

use crate::place::Place;

const NUT: &[u8] = b"difference() {\n\tcylinder($fn = 6, h = 4, r = 10);\n\tcylinder($fn = 60, h = 9, r = 5, center = true);\n}\n";

#[test]
fn curves_are_drawn_as_asked_for() {
    let place = Place::new();
    place.write("nut.csg", NUT);
    let told = place.run("csg nut.csg -o nut.lfl --depth 5").good();
    assert!(told.text().contains("curves  1 drawn as polygons, 1 exact\n"), "{told:?}");
    for (option, polygons, exact) in [("", 1, 1), ("--fn exact", 0, 2), ("--fn polygon", 2, 0)] {
        for command in ["csg nut.csg -o nut.lfl --depth 5", "measure nut.csg --tolerance 0.1", "info nut.csg"]
        {
            let report = place.run(&format!("{command} --json {option}")).good().json();
            assert_eq!(
                (&report["curves"]["polygons"], &report["curves"]["exact"]),
                (&polygons.into(), &exact.into())
            );
        }
        place.run(&format!("interfere nut.csg nut.csg --depth 4 {option}")).good();
    }
    // 6 × 10² sin 60° / 2 × 4 − π × 5² × 4, and with exact curves.
    let volume = |option: &str| {
        let volume = place.run(&format!("measure nut.csg --json {option}")).good().json()["volume"].clone();
        (volume["lower"].as_f64().unwrap(), volume["upper"].as_f64().unwrap())
    };
    let (lower, upper) = volume("");
    assert!(lower < 725.071 && 725.071 < upper && upper < 735.0, "{lower} {upper}");
    assert!(volume("--fn exact").0 > 900.0);
    place.run("measure nut.lfl --fn exact").bad(2, &["--fn is for scenes", "nut.lfl"]);
    place.run("csg nut.csg -o nut.lfl --depth 5 --fn round").bad(2, &["--fn", "exact", "polygon"]);
}

#[test]
fn meshes_that_bound_no_solid_are_told_of() {
    let place = Place::new();
    place.write("open.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    place.write(
        "part.csg",
        b"cube(2);\n import(file = \"open.off\");\npolyhedron([[0,0,0],[4,0,0],[0,4,0],[0,0,4]], \
          [[0,2,1],[0,1,3],[0,3,2],[1,3,2]]);\n",
    );
    for command in ["csg part.csg -o part.lfl --depth 4", "measure part.csg --tolerance 0.3", "info part.csg"]
    {
        let said = place.run(command);
        let errors = format!("{said:?}");
        assert!(
            errors.contains("part.csg: line 2, column 2: warning: the mesh open.off does not bound a solid"),
            "{errors}"
        );
        assert!(
            errors.contains("line 3, column 1: warning: the polyhedron does not bound a solid"),
            "{errors}"
        );
        assert!(errors.contains("1 triangle is turned over"), "{errors}");
    }
    let info = place.run("info part.csg --json").json();
    assert_eq!((&info["meshes"][0]["file"], &info["meshes"][1]["turned"]), (&"open.off".into(), &1.into()));
}
