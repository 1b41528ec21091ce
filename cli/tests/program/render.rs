//! Pictures with the program `leafless`.

use crate::place::{Place, block, stl};
use serde_json::Value;

/// A cube with a bar cut out of it, as a mesh, as octrees, and as a tri-dexel model.
fn parts() -> Place {
    let place = Place::new();
    place.write("cube.stl", stl(&block([1.0; 3], [7.0; 3])));
    place.write("bar.stl", stl(&block([3.0, 0.0, 3.0], [5.0, 8.0, 5.0])));
    for name in ["cube", "bar"] {
        place.run(&format!("voxelize {name}.stl -o {name}.lfl --depth 6 --bounds 0,0,0,8")).good();
    }
    place.run("difference cube.lfl bar.lfl -o part.lfl").good();
    place.run("dexelize cube.stl -o dexels.lfl --resolution 64 --bounds 0,0,0,8").good();
    place.write("scene.csg", b"difference() { sphere(r=10); cube(size=[4,40,4], center=true); }");
    place
}

fn png(place: &Place, name: &str) -> (u32, u32, Vec<[u8; 3]>) {
    let mut reader =
        png::Decoder::new(std::fs::File::open(place.path(name)).map(std::io::BufReader::new).unwrap())
            .read_info()
            .unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    let channels = info.color_type.samples();
    let pixels = bytes.chunks_exact(channels).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    (info.width, info.height, pixels)
}

#[test]
fn every_kind_of_file_is_shown_in_every_view() {
    let place = parts();
    for file in ["part.lfl", "cube.stl", "dexels.lfl", "scene.csg"] {
        for view in ["surface", "volume", "hybrid", "slice"] {
            let line =
                format!("render {file} -o out.png --view {view} --size 160x120 --samples 1 --depth 5 --json");
            let report: Value = place.run(&line).good().json();
            let (width, height, pixels) = png(&place, "out.png");
            assert_eq!((width, height), (160, 120));
            assert_eq!((&report["width"], &report["height"]), (&160.into(), &120.into()));
            assert_eq!(report["view"], view);
            let marked = pixels.iter().filter(|pixel| **pixel != [255; 3]).count();
            // A fitted cube or ball covers a good part of the picture.
            assert!(marked > 3000, "{file} {view}: {marked}");
            // (What is EMPTY is faint in a slice.)
            assert!(view == "slice" || pixels[0] == [255; 3], "{file} {view}");
        }
    }
}

#[test]
fn the_hole_is_seen_from_in_front() {
    let place = parts();
    let middle = |line: &str| {
        place
            .run(&format!("render part.lfl -o out.png --size 200x200 --ortho --background none {line}"))
            .good();
        let file = std::fs::File::open(place.path("out.png")).map(std::io::BufReader::new).unwrap();
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        bytes[4 * (100 * 200 + 100) + 3]
    };
    assert_eq!(middle("--from 0,0"), 0);
    assert_eq!(middle("--from 90,0"), 255);
    // Cut open above the bar's middle, one looks into it from above, and through nothing.
    assert_eq!(middle("--from 0,90 --clip 0,0,-1,4"), 255);
    assert_eq!(middle("--from 0,90 --clip-box 0,0,3,8,8,5"), 0);
}

#[test]
fn the_same_picture_by_any_number_of_threads() {
    let place = parts();
    for view in ["surface", "volume", "hybrid", "slice"] {
        let mut files = Vec::new();
        for threads in [1, 3] {
            let line =
                format!("render part.lfl -o {threads}.png --view {view} --size 200x150 --threads {threads}");
            place.run(&line).good();
            files.push(std::fs::read(place.path(&format!("{threads}.png"))).unwrap());
        }
        assert_eq!(files[0], files[1], "{view}");
    }
}

#[test]
fn a_picture_goes_to_standard_output() {
    let place = parts();
    // What was done is told on standard error.
    let out = place.run("render cube.stl -o - --size 64x64");
    assert_eq!(out.code, Some(0));
    assert!(out.bytes.starts_with(b"\x89PNG\r\n\x1a\n"));
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let place = parts();
    for (line, code, problem) in [
        ("render part.lfl -o out.png --samples 3", 1, "samples"),
        ("render part.lfl -o out.png --fov 180", 1, "field of view"),
        ("render part.lfl -o out.png --eye 1,2,3 --at 1,2,3", 1, "at"),
        ("render part.lfl -o out.png --clip 0,0,0,1", 1, "plane"),
        ("render part.lfl -o out.png --view volume --channel heat", 1, "has no channel"),
        ("render part.lfl -o nowhere/out.png", 1, "no folder"),
        ("render nothing.lfl -o out.png", 1, "nothing.lfl"),
    ] {
        place.run(line).bad(code, &[problem]);
    }
    for (line, problem) in [
        ("render part.lfl -o out.png --size 0x10", "width and height"),
        ("render part.lfl -o out.png --size 20000x10", "width and height"),
        ("render part.lfl -o out.png --map rainbow", "map"),
        ("render part.lfl -o out.png --colour red", "hexadecimal"),
        ("render part.lfl -o out.png --from 10", "2 numbers"),
        ("render part.lfl -o out.png --view volume --opacity 2", "0 to 1"),
        ("render part.lfl -o out.png --ortho --fov 20", "--fov"),
    ] {
        let run = place.run(line);
        assert!(run.code == Some(2) && run.errors.contains(problem), "{run:?}");
    }
    assert!(!place.path("out.png").exists());
}

#[test]
fn edges_are_drawn_of_every_kind() {
    let place = parts();
    let dark = |arguments: &str| {
        place.run(&format!("render {arguments} -o out.png --size 160x120 --samples 1")).good();
        png(&place, "out.png").2.iter().filter(|pixel| **pixel == [35, 40, 45]).count()
    };
    for file in
        ["part.lfl", "part.lfl --faces", "cube.stl", "cube.stl --faces --depth 5", "dexels.lfl", "scene.csg"]
    {
        assert_eq!(dark(file), 0, "{file}");
        let edges = dark(&format!("{file} --edges"));
        assert!((150..4000).contains(&edges), "{file}: {edges}");
    }
    assert!(dark("cube.stl --edges all") > 150);
    place.run("render part.lfl -o never.png --edges all").bad(1, &["edges", "meshes"]);
    assert!(!place.path("never.png").exists());
}

#[test]
fn cameras_and_legends_fit_what_is_shown() {
    let place = parts();
    let covered = |arguments: &str| {
        let report: Value = place
            .run(&format!("render {arguments} -o out.png --size 160x120 --samples 1 --json"))
            .good()
            .json();
        report["covered"].as_u64().unwrap()
    };
    // A vertex that no triangle uses.
    place.write(
        "stray.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1000 1000 1000\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n",
    );
    assert!(covered("stray.obj") > 3000);
    // What is cut away in a hybrid view is the skin alone.
    let whole = covered("part.lfl --view hybrid --no-legend");
    assert!(covered("part.lfl --view hybrid --no-legend --clip-box 3,3,3,5,5,5") > whole / 2);
    // An eye beside the slice is heeded.
    assert_ne!(
        covered("part.lfl --view slice --eye 4,-9,30"),
        covered("part.lfl --view slice --eye 4,-30,9")
    );
    // Values that are all the same, and large.
    place.run("attribute part.lfl --name big --value 1e17 -o big.lfl").good();
    assert!(covered("big.lfl") > 3000);
    for (line, option) in [
        ("part.lfl --plane 0,0,1,-4", "--plane"),
        ("part.lfl --view slice --edges", "--edges"),
        ("part.lfl --view volume --faces", "--faces"),
        ("part.lfl --eye 1,2,3 --from 1,2", "--from"),
    ] {
        place.run(&format!("render {line} -o never.png")).bad(2, &[option]);
    }
}
