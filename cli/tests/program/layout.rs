//! The subcommand `leafless layout`, from outside.

use crate::place::{Place, Run, block, stl};
use serde_json::{Value, json};
use std::io::Cursor;

/// A cube of edge 10 as a scene, as a mesh and as a solid, a ring, and a slab.
fn parts() -> Place {
    let place = Place::new();
    place.write("cube.csg", "cube([10, 10, 10]);");
    place.write("cube.stl", stl(&block([-5.0; 3], [5.0; 3])));
    place.write(
        "ring.csg",
        "difference() { cylinder(h = 4, r = 8, $fn = 0); cylinder(h = 4, r = 6, $fn = 0); } // a ring",
    );
    place.write("slab.csg", "cube([20, 20, 2]);");
    place
}

fn ends(interval: &Value) -> [f64; 2] {
    ["lower", "upper"].map(|end| interval[end].as_f64().unwrap_or_else(|| panic!("{interval}")))
}

#[track_caller]
fn holds(interval: &Value, value: f64, width: f64) {
    let [lower, upper] = ends(interval);
    assert!(lower <= value && value <= upper && upper - lower <= width, "{interval} {value}");
}

fn layout(place: &Place, name: &str) -> Value {
    serde_json::from_slice(&place.bytes(name)).unwrap()
}

/// Asserts that standard error is one line with these words, and that the report is printed all the same.
#[track_caller]
fn left(run: &Run, words: &[&str]) {
    assert!(run.code == Some(1) && run.errors.lines().count() == 1 && !run.bytes.is_empty(), "{run:?}");
    assert!(words.iter().all(|word| run.errors.contains(word)), "{words:?} {run:?}");
}

#[test]
fn boxes_fill_a_box() {
    let place = parts();
    let told = place.run("layout box:20,20,20 cube.csg*8 -o full.json --json").good().json();
    assert_eq!((&told["placed"], &told["left"], &told["end"]), (&json!(8), &json!(0), &json!("complete")));
    assert_eq!(told["items"], json!([{ "name": "cube.csg", "count": 8, "placed": 8, "left": 0 }]));
    holds(&told["filled_part"], 1.0, 1e-3);
    holds(&told["volume"], 8000.0, 1.0);
    holds(&told["mass"], 8000.0, 1.0);
    holds(&told["height"], 20.0, 1e-3);
    (0..3).for_each(|axis| holds(&told["centroid"][axis], 10.0, 0.1));
    holds(&told["smallest_gap"], 0.0, 1e-3);
    let told = layout(&place, "full.json");
    assert_eq!((&told["format"], &told["version"]), (&json!("leafless layout"), &json!(1)));
    assert_eq!(told["container"], json!({ "box": [20.0, 20.0, 20.0] }));
    assert_eq!(told["items"], json!([{ "file": "cube.csg", "count": 8, "density": 1.0 }]));
    assert_eq!(told["placed"].as_array().unwrap().len(), 8);
    for copy in told["placed"].as_array().unwrap() {
        assert_eq!((&copy["item"], &copy["name"]), (&json!(0), &json!("cube.csg")));
        holds(&copy["nearest"]["gap"], 0.0, 1e-3);
    }
    let told = place.run("layout --check full.json --json").good().json();
    assert_eq!((&told["copies"], &told["proven"], &told["conflicts"]), (&json!(8), &json!(8), &json!([])));

    // Densities and masses.
    let told = place.run("layout box:10,10,20 cube.csg*2 -o d.json --density 2.5 --json").good().json();
    holds(&told["mass"], 5000.0, 1.0);
    let heavy = "layout box:20,20,12 slab.csg cube.csg*2 -o d.json --density 2.5,1e-3 --json";
    holds(&place.run(heavy).good().json()["mass"], 2002.0, 1.0);
    let told = layout(&place, "d.json");
    assert_eq!((&told["items"][0]["density"], &told["items"][1]["density"]), (&json!(2.5), &json!(1e-3)));
    place.run("layout --check d.json").good();
    let steel = "layout box:10,10,20 cube.csg*2 -o d.json -o d.3mf --unit cm --density 7.8g/cm3";
    let run = place.run(&format!("{steel} --json")).good();
    holds(&run.json()["mass"], 15_600.0, 1.0);
    assert_eq!(run.json()["mass_unit"], json!("g"));
    assert_eq!(place.run("info d.3mf --json").good().json()["unit"], json!("cm"));
    let run = place.run(steel).good();
    assert!(run.text().lines().any(|line| line.starts_with("mass") && line.ends_with(" g")), "{run:?}");

    // With a distance between the cubes there is less room. The placed cubes are written.
    let run = place.run("layout box:20,20,20 cube.csg*8 -o some.json --clearance 0.5 --rounds 1");
    left(&run, &["7 copies are left", "7 of cube.csg"]);
    assert!(run.text().contains("placed          1 of 8\n"), "{run:?}");
    assert!(run.text().contains("smallest gap    none\n"), "{run:?}");
    place.run("layout --check some.json").good();
    let run = place.run("layout box:21.01,10,10 cube.csg*2 -o two.json --clearance 1 --json").good();
    let [least, most] = ends(&run.json()["smallest_gap"]);
    assert!(least >= 1.0 && most < 1.001, "{run:?}");
    let run =
        place.run("layout box:21.01,10,10 cube.csg*2 -o two.json -o two.png --wall-clearance 0.1 --rounds 1");
    left(&run, &["2 copies are left"]);
    assert_eq!(layout(&place, "two.json")["measures"]["centroid"], Value::Null);
    place.run("layout --check two.json").good();

    // An obstacle takes half of the room.
    let run = place.run("layout box:20,20,10 cube.csg*4 --obstacle slab.csg -o o.json -o o.csg --rounds 1");
    left(&run, &["4 copies are left"]);
    place.run("layout box:20,20,12 cube.csg*4 --obstacle slab.csg -o o.json -o o.csg -o o.png").good();
    // (Blue cubes on a grey slab.)
    let image = png::Decoder::new(Cursor::new(place.bytes("o.png"))).read_info();
    let mut image = image.unwrap();
    let mut pixels = vec![0; image.output_buffer_size().unwrap()];
    let frame = image.next_frame(&mut pixels).unwrap();
    assert_eq!((frame.width, frame.height), (1024, 768));
    let shown = |is_shown: &dyn Fn(&[u8]) -> bool| {
        pixels.chunks_exact(frame.color_type.samples()).filter(|pixel| is_shown(pixel)).count()
    };
    let blue = shown(&|pixel| pixel[2] > 100 && u32::from(pixel[2]) > u32::from(pixel[0]) + 60);
    let grey = shown(&|pixel| (60..230).contains(&pixel[0]) && pixel[2].abs_diff(pixel[0]) < 30);
    assert!(blue > 100_000 && grey > 10_000, "{blue} {grey}");
    let told = layout(&place, "o.json");
    assert_eq!(told["obstacles"], json!(["slab.csg"]));
    place.run("layout --check o.json").good();
    // (The scene has the obstacle, too.)
    holds(&place.run("measure o.csg --json").good().json()["volume"], 4800.0, 100.0);
}

/// All three output files agree, and other commands read them.
#[test]
fn outputs_are_read_back() {
    let place = parts();
    std::fs::create_dir_all(place.path("in side")).unwrap();
    std::fs::create_dir_all(place.path("out")).unwrap();
    place.write("in side/a \"b\".stl", stl(&block([0.0; 3], [3.0, 4.0, 5.0])));
    place.write("in side/far.csg", "// far\nunion() { import(file = \"a \\\"b\\\".stl\"); }\n// end");
    place.run("csg cube.csg -o cube.lfl --depth 4").good();
    let words = [
        "layout",
        "box:40,40,30",
        "cube.stl*3",
        "in side/a \"b\".stl*2",
        "in side/far.csg*2",
        "cube.lfl",
        "ring.csg*2",
        "--clearance",
        "0.25",
        "--rounds",
        "1",
        "-o",
        "out/a.json",
        "-o",
        "out/a.3mf",
        "-o",
        "out/a.csg",
        "--json",
    ];
    let run = Run::new("layout", place.command(words).output().unwrap()).good();
    assert_eq!(run.json()["outputs"], json!(["out/a.json", "out/a.3mf", "out/a.csg"]));
    let told = layout(&place, "out/a.json");
    let files: Vec<&str> =
        told["items"].as_array().unwrap().iter().map(|item| item["file"].as_str().unwrap()).collect();
    let expected =
        ["../cube.stl", "../in side/a \"b\".stl", "../in side/far.csg", "../cube.lfl", "../ring.csg"];
    assert_eq!(files, expected);
    place.run("layout --check out/a.json").good();
    // From another folder, and as a whole tree after a move.
    let run = place.command(["layout", "--check", "a.json"]).current_dir(place.path("out")).output().unwrap();
    Run::new("check", run).good();

    let ring = std::f64::consts::PI * 28.0 * 4.0;
    let volume = 4.0 * 1000.0 + 4.0 * 60.0 + 2.0 * ring;
    holds(&told["measures"]["volume"], volume, 2.0);
    let scene = place.run("measure out/a.csg --json --tolerance 1e-3").good().json();
    holds(&scene["volume"], volume, 1e-2 * volume);
    assert!(place.run("info out/a.csg").good().text().contains("scene"));
    place.run("render out/a.csg -o out/a.png --size 32x32").good();
    let mesh = place.run("info out/a.3mf --json").good().json();
    let own = mesh["volume"].as_f64().unwrap();
    // (Surface nets cut off the corners of the solid that consists only of cells.)
    assert!((own - volume).abs() < 1e-2 * volume, "{own} {volume}");
    assert_eq!(mesh["closed"], true, "{mesh}");
    // The copies of the mesh stand at the JSON's places, to the last digit.
    let bytes = leafless::exchange::read_mesh(&place.bytes("out/a.3mf"), &Default::default()).unwrap().mesh;
    for copy in told["placed"].as_array().unwrap().iter().filter(|copy| copy["item"] == 0) {
        let row = |i: usize| -> Vec<f64> {
            copy["matrix"][i].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
        };
        let corner = [0, 1, 2].map(|i| {
            let [x, y, z, t] = row(i)[..] else { panic!("{copy}") };
            5.0 * x + 5.0 * y + 5.0 * z + t
        });
        let near = |v: &&[f64; 3]| (0..3).all(|k| (v[k] - corner[k]).abs() < 1e-12);
        assert!(bytes.vertices().iter().any(|v| near(&v)), "{corner:?}");
    }

    // The layout on standard output, and the report beside it.
    let run = place.run("layout box:10,10,10 cube.csg -o -");
    assert!(run.code == Some(0) && run.errors.contains("placed          1 of 1\n"), "{run:?}");
    place.write("piped.json", &run.bytes);
    place.run("layout --check piped.json").good();
}

/// A name that ends like a number of copies, a mesh as a container, rotations, and objectives.
#[test]
fn options() {
    let place = parts();
    place.write("part*2", stl(&block([0.0; 3], [2.0, 2.0, 6.0])));
    place.write("tub.stl", stl(&block([-12.0; 3], [12.0, 12.0, 2.0])));
    place.write(
        "turns.txt",
        "# upright, and on its side\n1 0 0 9 0 1 0 0 0 0 1 0\n0 0 1 0 0 1 0 0 -1 0 0 0\n",
    );
    let line = "layout box:6,2,2 part*2 -o a.json --rounds 1";
    place.run(line).good();
    assert_eq!(layout(&place, "a.json")["items"], json!([{ "file": "part*2", "count": 1, "density": 1.0 }]));
    place.run("layout box:6,2,4 part*2*2 -o a.json").good();
    place.run(&format!("{line} --orientations 24")).good();
    place.run(&format!("{line} --orientations turns.txt")).good();
    left(&place.run(&format!("{line} --orientations as-given")), &["1 copy is left"]);
    place.run("layout box:9,9,9 part*2 -o a.json --rounds 1 --orientations free:5 --seed 3").good();
    for more in ["--objective height", "--objective density", "--free-along +z", "--free-along -x"] {
        place.run(&format!("layout box:24,24,14 cube.stl*2 -o a.json -o a.csg --rounds 1 {more}")).good();
        place.run("layout --check a.json").good();
        holds(&place.run("measure a.csg --json").good().json()["volume"], 2000.0, 100.0);
    }
    let into = "layout tub.stl cube.stl*2 -o a.json --rounds 1 --cells 24";
    place.run(&format!("{into} --wall-clearance 0.2 --free-along +z")).good();
    place.run("layout --check a.json").good();
    assert_eq!(layout(&place, "a.json")["container"], json!({ "file": "tub.stl" }));
    place.run("layout tub.stl cube.stl -o a.json --rounds 1 --cells 16 --objective balance=3,-2,-6").good();
    for (axis, aim) in [3.0, -2.0, -6.0].into_iter().enumerate() {
        let [lower, upper] = ends(&layout(&place, "a.json")["measures"]["centroid"][axis]);
        assert!(lower > aim - 1.5 && upper < aim + 1.5, "{axis} {lower} {upper}");
    }
    // Budgets end a search, and the placements so far are written.
    let run = place.run("layout tub.stl cube.stl*4 -o a.json --tests 1 --json");
    left(&run, &["--tests or --splits"]);
    assert_eq!((&run.json()["end"], &run.json()["tests"]), (&json!("budget"), &json!(1)));
    let run = place.run("layout tub.stl ring.csg*200 -o a.json --rounds 100000 --seconds 1 --json");
    left(&run, &["copies are left", "more --seconds"]);
    assert_eq!(run.json()["end"], "time");
    place.run("layout --check a.json").good();
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let place = parts();
    let line = "layout box:22,22,12 ring.csg*2 cube.stl*3 --rounds 2 --cells 16 --orientations free:2";
    let mut seen: Vec<Vec<Vec<u8>>> = vec![];
    for (seed, threads) in [(1, 1), (1, 2), (1, 0)] {
        let outputs = "-o a.json -o a.3mf -o a.csg";
        let run = place.run(&format!("{line} --seed {seed} --threads {threads} {outputs}"));
        left(&run, &["left"]);
        seen.push(["a.json", "a.3mf", "a.csg"].map(|name| place.bytes(name)).into());
    }
    assert!(seen[0] == seen[1] && seen[0] == seen[2]);
}

/// Copies moved into each other, into an obstacle, and out of the container.
#[test]
fn what_is_changed_is_seen() {
    let place = parts();
    place.run("layout box:60,20,20 cube.stl*2 ring.csg --obstacle slab.csg -o a.json --clearance 1").good();
    place.run("layout --check a.json").good();
    let good = layout(&place, "a.json");
    let cubes: Vec<usize> = (0..3).filter(|k| good["placed"][k]["item"] == 0).collect();
    let [first, second] = cubes[..] else { panic!("{good}") };
    let changed = |change: &dyn Fn(&mut Value)| {
        let mut value = good.clone();
        change(&mut value);
        place.write("b.json", value.to_string());
        let run = place.run("layout --check b.json --json");
        let words = ["b.json: of 3 copies"];
        left(&run, &words);
        let text = place.run("layout --check b.json");
        left(&text, &words);
        (run.json(), text.text().to_owned())
    };
    let (told, text) = changed(&|value| {
        let to = value["placed"][first]["matrix"].clone();
        value["placed"][second]["matrix"] = to;
    });
    assert_eq!((&told["proven"], &told["wrong"]), (&json!(1), &json!(2)));
    let conflict = &told["conflicts"][0];
    assert_eq!(told["conflicts"].as_array().unwrap().len(), 1, "{told}");
    assert_eq!((&conflict["placed"], &conflict["other"]), (&json!(first), &json!({ "placed": second })));
    assert_eq!((&conflict["verdict"], &conflict["other_name"]), (&json!("no"), &json!("cube.stl")));
    assert!(
        text.contains(&format!("copy {first}, cube.stl, touches or overlaps copy {second}, cube.stl,")),
        "{text}"
    );
    // Into the obstacle, which lies at the origin.
    let (told, text) = changed(&|value| {
        value["placed"][first]["matrix"] = json!([[1, 0, 0, 5], [0, 1, 0, 5], [0, 0, 1, 5]]);
    });
    assert!(
        told["conflicts"].as_array().unwrap().iter().any(|c| c["other"] == json!({ "obstacle": 0 })),
        "{told}"
    );
    assert!(text.contains("obstacle 0, slab.csg,"), "{text}");
    // Out of the container.
    let (told, text) = changed(&|value| {
        value["placed"][first]["matrix"] = json!([[1, 0, 0, 30], [0, 1, 0, 100], [0, 0, 1, 10]]);
    });
    assert!(told["conflicts"].as_array().unwrap().iter().any(|c| c["other"] == "wall"), "{told}");
    assert!(text.contains("the wall"), "{text}");
    // The requested distance is greater than the real one.
    let (told, _) = changed(&|value| value["clearance"] = json!(50));
    assert!(told["conflicts"].as_array().unwrap().len() >= 2, "{told}");
    // Also another part.
    place.write("cube.stl", stl(&block([-5.0; 3], [50.0; 3])));
    left(&place.run("layout --check a.json"), &["a.json: of 3 copies", "in conflict"]);
    std::fs::remove_file(place.path("cube.stl")).unwrap();
    place.run("layout --check a.json").bad(1, &["cube.stl", "No such file"]);
}

#[test]
fn hostile_layouts_are_refused() {
    let place = parts();
    place.run("layout box:20,20,20 cube.csg*2 -o a.json").good();
    let good = String::from_utf8(place.bytes("a.json")).unwrap();
    let value = layout(&place, "a.json");
    let refused = |text: &str, words: &[&str]| {
        place.write("b.json", text);
        place.run("layout --check b.json").bad(1, &[&["b.json"], words].concat());
    };
    for (text, words) in [
        ("", &["is no layout", "EOF"][..]),
        ("{", &["is no layout"]),
        ("[]", &["is no layout"]),
        ("{}", &["is no layout", "format"]),
        ("\u{0}\u{1}", &["is no layout"]),
        ("{\"format\": \"leafless layout\", \"version\": 2}", &["version 2", "version 1 is read"]),
        ("{\"format\": \"another\", \"version\": 1}", &["its format is not"]),
        ("{\"format\": \"leafless layout\", \"version\": 1}", &["missing field"]),
        (&good[..good.len() / 2], &["is no layout"]),
        (&format!("{good} x"), &["trailing"]),
        (&good.replacen("\"version\"", "\"other\": 1, \"version\"", 1), &["unknown field `other`"]),
        (
            &good.replacen("\"clearance\": 0.0", "\"clearance\": 0.0, \"clearance\": 0.0", 1),
            &["duplicate field"],
        ),
        (&"[".repeat(100_000), &["is no layout"]),
    ] {
        refused(text, words);
    }
    let changed = |path: &[&str], new: Value| {
        let mut value = value.clone();
        let mut at = &mut value;
        for key in path {
            at = match key.parse::<usize>() {
                Ok(index) => &mut at[index],
                Err(_) => &mut at[*key],
            };
        }
        *at = new;
        value.to_string()
    };
    for (path, new, words) in [
        (&["version"][..], json!(2), "version 2"),
        (&["version"], json!(-1), "is no layout"),
        (&["version"], json!("1"), "is no layout"),
        (&["placed", "0", "item"], json!(1), "placed 0: there is no item 1"),
        (&["placed", "0", "item"], json!(-1), "is no layout"),
        (&["placed", "0", "item"], json!(18_446_744_073_709_551_615u64), "there is no item"),
        (&["placed", "1", "name"], json!("other.csg"), "placed 1: its name"),
        (&["placed", "0", "matrix", "0", "0"], json!(null), "is no layout"),
        (&["placed", "0", "matrix", "0", "0"], json!(2), "placed 0: placement: must turn and move"),
        (&["placed", "0", "matrix", "0", "0"], json!(-1), "placed 0: placement: must turn and move"),
        (&["placed", "0", "matrix", "0", "0"], json!(0), "placed 0"),
        (&["placed", "0", "matrix", "0", "3"], json!(1e300), "placed 0"),
        (&["placed", "0", "matrix", "0"], json!([1, 0, 0]), "is no layout"),
        (&["items", "0", "count"], json!(1), "placed 1: of item 0 there are more copies than 1"),
        (&["items", "0", "count"], json!(0), "item 0: the number of copies"),
        (&["items", "0", "density"], json!(0.0), "item 0: the density"),
        (&["items", "0", "density"], json!(null), "is no layout"),
        (&["items", "0", "count"], json!(4_294_967_295u32), "item 0: the number of copies"),
        (&["items", "0", "count"], json!(4_294_967_296u64), "is no layout"),
        (&["items", "0", "file"], json!("none/cube.csg"), "No such file"),
        (&["items", "0", "file"], json!("./"), "name"),
        (&["items", "0", "file"], json!("\u{0}/cube.csg"), "cube.csg"),
        (&["items"], json!([]), "there is no item 0"),
        (&["container"], json!({ "box": [1, 2] }), "is no layout"),
        (&["container"], json!({ "box": [1, 2, 0] }), "three sides must be above 0"),
        (&["container"], json!({ "box": [1, 2, 1e300] }), ""),
        (&["container"], json!({ "file": "." }), "is no regular file"),
        (&["container"], json!("cube.csg"), "is no layout"),
        (&["obstacles"], json!(["."]), "is no regular file"),
        (&["obstacles"], json!(["a.json"]), "a.json"),
        (&["clearance"], json!(-1), "clearance must be a number not below 0"),
        (&["wall_clearance"], json!(-1e-9), "wall_clearance must be a number not below 0"),
        (&["clearance"], json!(1e300), "clearance"),
        (&["measures"], json!(null), "is no layout"),
    ] {
        place.write("b.json", changed(path, new));
        let run = place.run("layout --check b.json");
        assert!(!run.errors.contains("os error") && !run.errors.contains("panicked"), "{run:?}");
        run.bad(1, &[words]);
    }
    for number in ["1e999", "-1e999", "NaN", "Infinity", "1e"] {
        refused(
            &good.replacen("\"clearance\": 0.0", &format!("\"clearance\": {number}"), 1),
            &["is no layout"],
        );
    }
    if cfg!(unix) {
        place.write("b.json", changed(&["obstacles"], json!(["/dev/zero"])));
        place.run("layout --check b.json").bad(1, &["/dev/zero", "is no regular file"]);
    }
    place.run("layout --check none.json").bad(1, &["none.json", "No such file"]);
    // No placement is proven.
    let mut empty = value.clone();
    (empty["placed"], empty["items"]) = (json!([]), json!([]));
    place.write("b.json", empty.to_string());
    place.run("layout --check b.json").good();
}

#[test]
fn what_is_refused() {
    let place = parts();
    place.write("half.csg", "halfspace([0, 0, 1, 0]);");
    place.write("nothing.csg", "group();");
    place.write("broken.csg", "cube(");
    place.write("flip.txt", "1 0 0 0 0 1 0 0 0 0 -1 0\n");
    place.write("empty.txt", "# none\n");
    place.run("mesh cube.csg -o inch.3mf").good();
    place.run("convert inch.3mf -o inches.3mf --to-unit in").good();
    let before = place.files();
    for (line, code, words) in [
        ("", 2, &["--output", "CONTAINER", "ITEM"][..]),
        ("box:9,9,9 -o a.json", 2, &["ITEM"]),
        ("box:9,9,9 cube.csg", 2, &["--output"]),
        ("box:9,9 cube.csg -o a.json", 2, &["box:9,9:", "three sides"]),
        ("box:9,9,0 cube.csg -o a.json", 2, &["three sides"]),
        ("box:9,9,inf cube.csg -o a.json", 2, &["three sides"]),
        ("box:9,9,9 cube.csg*0 -o a.json", 2, &["cube.csg*0", "1 to 10,000"]),
        ("box:9,9,9 cube.csg*99999999999 -o a.json", 2, &["1 to 10,000"]),
        ("box:9,9,9 cube.csg*6000 ring.csg*6000 -o a.json", 1, &["10,000 copies at the most", "12,000"]),
        ("box:9,9,9 - -o a.json", 2, &["standard input"]),
        ("- cube.csg -o a.json", 2, &["standard input"]),
        ("box:9,9,9 cube.csg --obstacle - -o a.json", 2, &["standard input"]),
        ("box:9,9,9 none.stl -o a.json", 1, &["none.stl", "No such file"]),
        ("none.stl cube.csg -o a.json", 1, &["none.stl", "No such file"]),
        ("box:9,9,9 broken.csg -o a.json", 1, &["broken.csg"]),
        ("box:9,9,9 half.csg -o a.json", 1, &["half.csg"]),
        ("half.csg cube.csg -o a.json", 1, &["half.csg"]),
        ("box:9,9,9 nothing.csg -o a.json", 1, &["nothing.csg"]),
        (
            "box:9,9,9 inch.3mf inches.3mf -o a.json",
            1,
            &["inches.3mf: its unit is in, and that of inch.3mf is mm"],
        ),
        ("box:9,9,9 cube.csg -o a.txt", 2, &["a.txt", ".json, .3mf, .csg and .png"]),
        ("box:9,9,9 cube.csg -o cube.csg", 1, &["cube.csg", "not overwritten"]),
        ("box:9,9,9 cube.csg -o none/a.json", 1, &["none"]),
        ("box:9,9,9 cube.csg -o a.json --clearance -1", 2, &["--clearance", "not below 0"]),
        ("box:9,9,9 cube.csg -o a.json --clearance nan", 2, &["--clearance", "not below 0"]),
        ("box:9,9,9 cube.csg -o a.json --clearance 1e300", 1, &["clearance"]),
        ("box:9,9,9 cube.csg -o a.json --wall-clearance inf", 2, &["--wall-clearance", "not below 0"]),
        ("box:9,9,9 cube.csg -o a.json --orientations free:0", 2, &["free:N", "1 to 4096"]),
        ("box:9,9,9 cube.csg -o a.json --orientations free:x", 2, &["free:N"]),
        ("box:9,9,9 cube.csg -o a.json --orientations 25", 2, &["25 is neither"]),
        ("box:9,9,9 cube.csg -o a.json --orientations cube.csg", 1, &["cube.csg: line 1"]),
        ("box:9,9,9 cube.csg -o a.json --orientations flip.txt", 1, &["mirror"]),
        ("box:9,9,9 cube.csg -o a.json --orientations empty.txt", 1, &["empty.txt", "no matrix"]),
        ("box:9,9,9 cube.csg -o a.json --objective most", 2, &["--objective", "balance=x,y,z"]),
        ("box:9,9,9 cube.csg -o a.json --density 0", 2, &["--density", "above 0"]),
        ("box:9,9,9 cube.csg -o a.json --density 1g/cm3", 2, &["--density", "--unit mm"]),
        ("box:9,9,9 cube.csg slab.csg -o a.json --unit mm --density 1g/cm3,2", 2, &["--density", "for none"]),
        ("box:9,9,9 cube.csg -o a.json --unit parsec", 2, &["--unit"]),
        ("box:9,9,9 cube.csg -o a.json --density 1,2", 2, &["--density", "one for each of 1 item, not 2"]),
        ("box:9,9,9 cube.csg slab.csg -o a.json --density 1,nan", 2, &["--density", "above 0"]),
        ("box:9,9,9 cube.csg -o a.json --objective balance=1,2", 2, &["balance=x,y,z"]),
        ("box:9,9,9 cube.csg -o a.json --objective balance=1,2,nan", 2, &["balance=x,y,z"]),
        ("box:9,9,9 cube.csg -o a.json --free-along w", 2, &["--free-along", "+x, -x"]),
        ("box:9,9,9 cube.csg -o a.json --rounds 0", 2, &["--rounds"]),
        ("box:9,9,9 cube.csg -o a.json --cells 3", 2, &["--cells", "4"]),
        ("box:9,9,9 cube.csg -o a.json --cells 513", 2, &["--cells", "512"]),
        ("box:9,9,9 cube.csg -o a.json --seed -1", 2, &["-1"]),
        ("box:9,9,9 cube.csg -o a.json --seconds 0", 2, &["--seconds", "above 0"]),
        ("box:9,9,9 cube.csg -o a.json --threads 9999", 2, &["--threads", "1024"]),
        ("--check a.json cube.csg", 2, &["--check"]),
        ("--check a.json -o b.json", 2, &["--check", "--output"]),
        ("--check a.json --seed 1", 2, &["--check", "--seed"]),
    ] {
        place.run(&format!("layout {line}")).bad(code, words);
    }
    assert_eq!(place.files(), before);
    // A volume cannot stand in a scene. This is reported before the search.
    place.write(
        "grid.nrrd",
        b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF",
    );
    place.run("layout box:9,9,9 grid.nrrd -o a.csg").bad(1, &["grid.nrrd", "volume"]);
    let run = place.run("layout box:9,9,9 grid.nrrd -o a.json -o a.3mf --rounds 1");
    assert_eq!(run.code, Some(0), "{run:?}");
    place.run("layout --check a.json").good();
}

#[test]
fn the_help_says_what_there_is() {
    let place = Place::new();
    let help = place.run("layout --help").good();
    for word in
        ["box:X,Y,Z", "ITEM[*COUNT]", "--clearance", "--free-along", "--check", "free:N", "balance=X,Y,Z"]
    {
        assert!(help.text().contains(word), "{word} {help:?}");
    }
}
