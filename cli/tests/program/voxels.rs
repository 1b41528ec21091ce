//! The subcommand `leafless voxels`, from outside.

use crate::place::solids;

/// The slab is [2, 6] × [2, 6] × [0, 2] in [0, 8]³, with 32 cells along an axis: four to a unit.
#[test]
fn records_as_lines() {
    let place = solids();
    // No cell of the slab is cut, and at level 2 its cells are 2 long.
    place.run("voxels slab.lfl -o slab.csv --boundary undecided --coarse 2").good();
    let text = String::from_utf8(place.bytes("slab.csv")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines,
        [
            "kind,level,code,x,y,z,edge",
            "inside,2,03000,2,2,0,2",
            "inside,2,12000,4,2,0,2",
            "inside,2,21000,2,4,0,2",
            "inside,2,30000,4,4,0,2",
        ]
    );
    let json = place
        .run("voxels slab.lfl -o slab.csv --coarse 1 --boundary-depth 3 --outside --refined --json")
        .good();
    let told: serde_json::Value = serde_json::from_str(json.text()).unwrap();
    // All of the 4 × 4 × 2 cells of edge 1 touch the outside: above, beside, and below, where the universe
    // ends.
    assert_eq!((told["boundary"].as_u64(), told["inside"].as_u64()), (Some(32), Some(0)));
    assert!(told["refined"].as_u64() > Some(4) && told["outside"].as_u64() > Some(4), "{told}");
    place.run("voxels slab.lfl -o slab.txt").bad(2, &[".npz", ".csv"]);
    place.run("voxels slab.lfl -o slab.csv --fine 0.5 --tolerance 1").bad(2, &["--tolerance"]);
    place.run("voxels slab.lfl -o slab.csv --coarse 1e-9").bad(1, &["20 levels"]);
    place.run("voxels slab.lfl -o slab.csv --coarse 0").bad(2, &["--coarse"]);
    place.run("voxels none.lfl -o slab.csv").bad(1, &["none.lfl"]);
}

#[test]
fn there_and_back() {
    let place = solids();
    place.write("ball.csg", "sphere(r = 2, $fn = 0);");
    place.run("csg ball.csg -o ball.lfl --depth 6").good();
    for (more, back) in [("", ""), ("--outside --refined --coarse 0.5", ""), ("--boundary touching", "")] {
        place.run(&format!("voxels ball.lfl -o ball.npz {more}")).good();
        if more.contains("touching") {
            continue;
        }
        place.run(&format!("voxels --import ball.npz -o back.lfl {back}")).good();
        let [info, again] = ["ball.lfl", "back.lfl"].map(|name| {
            let text = place.run(&format!("info {name} --json")).good().text().to_owned();
            let told: serde_json::Value = serde_json::from_str(&text).unwrap();
            (told["nodes"].clone(), told["volume"].clone())
        });
        assert_eq!(info, again);
    }
    // The same bytes every time.
    place.run("voxels ball.lfl -o a.npz --threads 1").good();
    place.run("voxels ball.lfl -o b.npz --threads 4").good();
    assert_eq!(place.bytes("a.npz"), place.bytes("b.npz"));
    // With a chosen surface.
    place.run("mesh ball.csg -o ball.stl --depth 5").good();
    let text = place.run("voxels ball.lfl -o ball.csv --triangles ball.stl --json").good();
    let told: serde_json::Value = serde_json::from_str(text.text()).unwrap();
    assert!(told["triangles"].as_u64() > told["boundary"].as_u64(), "{told}");
    // Damage.
    let bytes = place.bytes("a.npz");
    place.write("cut.npz", &bytes[..bytes.len() / 2]);
    for option in ["--bounds 0,0,0,1", "--scale 2", "--fn exact", "--outside"] {
        place.run(&format!("voxels --import cut.npz -o cut.lfl {option}")).bad(2, &["--import"]);
    }
    place.run("voxels --import cut.npz -o cut.lfl").bad(1, &["cut.npz"]);
    place.write("text.npz", "no archive");
    place.run("voxels --import text.npz -o cut.lfl").bad(1, &["text.npz"]);
    for place_of in (0..bytes.len()).step_by(bytes.len() / 60) {
        let mut changed = bytes.clone();
        changed[place_of] ^= 0x55;
        place.write("changed.npz", &changed);
        // Good or bad, but without a crash.
        let run = place.run("voxels --import changed.npz -o changed.lfl");
        assert!(matches!(run.code, Some(0 | 1)), "{place_of}");
    }
}
