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
            // (EMPTY cells are faint in a slice.)
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
    // Cut open above the bar's middle, the picture shows its inside from above, and no background.
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
    // Messages go to standard error.
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
    // The hybrid view cuts only the skin away.
    let whole = covered("part.lfl --view hybrid --no-legend");
    assert!(covered("part.lfl --view hybrid --no-legend --clip-box 3,3,3,5,5,5") > whole / 2);
    // An eye beside the slice is used.
    assert_ne!(
        covered("part.lfl --view slice --eye 4,-9,30"),
        covered("part.lfl --view slice --eye 4,-30,9")
    );
    // Values that are all equal, and large.
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

/// Returns the empty quarter of the FULL cells' bounding box, in a slice through a corner with three arms.
fn empty_quarter(place: &Place, line: &str) -> String {
    place
        .run(&format!("render {line} -o out.png --view slice --no-legend --size 200x200 --samples 1"))
        .good();
    let (width, _, pixels) = png(place, "out.png");
    let full = [0, 114, 178];
    let found = pixels.iter().enumerate().filter(|(_, pixel)| **pixel == full);
    let places: Vec<[u32; 2]> = found.map(|(i, _)| [i as u32 % width, i as u32 / width]).collect();
    let span = |axis: usize| {
        let all = || places.iter().map(|place| place[axis]);
        (all().min().unwrap(), all().max().unwrap())
    };
    let middle = [0, 1].map(|axis| (span(axis).0 + span(axis).1) / 2);
    let mut empty = Vec::new();
    for (is_right, is_lower, name) in [
        (false, false, "upper left"),
        (true, false, "upper right"),
        (false, true, "lower left"),
        (true, true, "lower right"),
    ] {
        if !places
            .iter()
            .any(|place| (place[0] > middle[0]) == is_right && (place[1] > middle[1]) == is_lower)
        {
            empty.push(name);
        }
    }
    empty.join(", ")
}

#[test]
fn slices_stand_as_their_planes_say() {
    let place = Place::new();
    // Arms along x, y and z from the origin, of different lengths.
    place.write("arms.csg", "union() { cube([30, 4, 4]); cube([4, 20, 4]); cube([4, 4, 25]); }");
    for (plane, expected) in [
        // From above: x to the right, y upward.
        ("0,0,1,-2", "upper right"),
        // From below: x to the right, y downward.
        ("0,0,-1,2", "lower right"),
        // From the front: x to the right, z upward.
        ("0,-1,0,2", "upper right"),
        // From behind: x to the left.
        ("0,1,0,-2", "upper left"),
        // From the right: y to the right; from the left: y to the left.
        ("1,0,0,-2", "upper right"),
        ("-1,0,0,2", "upper left"),
        // As from above, whatever the sign of a zero.
        ("-0,-0,2,-4", "upper right"),
        ("1e-12,-1e-12,1,-2", "upper right"),
    ] {
        for more in ["--depth 6", "--no-cells"] {
            let line = format!("arms.csg --plane {plane} {more}");
            assert_eq!(empty_quarter(&place, &line), expected, "{line}");
        }
    }
}

#[test]
fn slices_have_a_scale_and_may_do_without_cells() {
    let place = parts();
    let pixels = |line: &str| {
        place.run(&format!("render {line} -o out.png --view slice --size 400x300 --samples 1")).good();
        png(&place, "out.png").2
    };
    let count = |pixels: &[[u8; 3]], colour: [u8; 3]| pixels.iter().filter(|pixel| **pixel == colour).count();
    let outline = [40, 40, 40];
    for file in ["part.lfl", "cube.stl --depth 5", "dexels.lfl", "scene.csg --depth 5"] {
        let cells = pixels(&format!("{file} --no-legend"));
        let plain = pixels(&format!("{file} --no-legend --no-cells"));
        assert!(count(&cells, outline) > 100, "{file}: {}", count(&cells, outline));
        assert_eq!(count(&plain, outline), 0, "{file}");
        assert!(count(&plain, [0, 114, 178]) > 5000, "{file}");
        // The scale is drawn in the lower left corner.
        let corner = |pixels: &[[u8; 3]]| {
            let ink = |i: usize| pixels[i] == [20, 20, 20] && i % 400 < 200 && i / 400 > 250;
            (0..pixels.len()).filter(|&i| ink(i)).count()
        };
        assert_eq!(corner(&plain), 0, "{file}");
        assert!(corner(&pixels(file)) > 100, "{file}");
    }
    // A surface is a line, and covers almost nothing of the picture.
    let line = count(&pixels("scene.csg --no-cells --no-legend"), [35, 40, 45]);
    assert!((200..3000).contains(&line), "{line}");
    place.run("render part.lfl -o never.png --no-cells").bad(2, &["--no-cells", "slice"]);
}

#[test]
fn pictures_are_png_whatever_their_names_say() {
    let place = parts();
    place.run("render cube.stl -o out.jpg").bad(2, &["out.jpg", "PNG", ".png"]);
    assert!(!place.path("out.jpg").exists());
    place.run("render cube.stl -o out.PNG --size 64x64").good();
    place.run("render cube.stl -o out --size 64x64").good();
}

#[test]
fn closed_meshes_are_capped_and_cameras_fit_what_is_left() {
    let place = parts();
    place.write("block.csg", "multmatrix([[1,0,0,1],[0,1,0,1],[0,0,1,1],[0,0,0,1]]) cube([6, 6, 6]);");
    let view = "--size 200x200 --samples 1 --from 0,60";
    let picture = |line: &str| {
        // (An open mesh causes a warning.)
        let run = place.run(&format!("render {line} -o out.png {view}"));
        assert_eq!(run.code, Some(0), "{run:?}");
        png(&place, "out.png").2
    };
    // From above the cut is visible, in the colour of a cut solid.
    let cut = "--clip 0,0,-1,4";
    let solid = picture(&format!("block.csg {cut}"));
    let colour = solid[100 * 200 + 100];
    let cap = |pixels: &[[u8; 3]]| pixels.iter().filter(|pixel| **pixel == colour).count() as f64;
    let expected = cap(&solid);
    assert!((cap(&picture(&format!("cube.stl {cut}"))) / expected - 1.0).abs() < 0.02, "{expected}");
    // Its triangles have no inside, and neither has an open mesh: the walls are visible from within.
    assert!(cap(&picture(&format!("cube.stl {cut} --edges all"))) < 0.8 * expected, "{expected}");
    let closed = block([1.0; 3], [7.0; 3]);
    let open = leafless::TriangleMesh::new(closed.vertices().to_vec(), closed.triangles()[..11].to_vec());
    place.write("open.stl", stl(&open.unwrap()));
    assert!(cap(&picture(&format!("open.stl {cut}"))) < 0.8 * expected, "{expected}");
    // A slice of a sixth of the block fills the picture like the block.
    for file in ["cube.stl", "block.csg", "cube.lfl", "dexels.lfl", "open.stl"] {
        for cut in ["--clip 0,1,0,-6 --clip 1,0,0,-6", "--clip-box 3,3,3,4,4,4"] {
            // (An open mesh has no inside.)
            if file == "open.stl" && cut.starts_with("--clip-box") {
                continue;
            }
            let pixels = picture(&format!("{file} {cut}"));
            let marked = |(i, pixel): (usize, &[u8; 3])| (*pixel != [255; 3]).then_some([i % 200, i / 200]);
            let places: Vec<[usize; 2]> = pixels.iter().enumerate().filter_map(marked).collect();
            let span = |axis: usize| {
                let all = || places.iter().map(|place| place[axis]);
                all().max().unwrap_or(0) - all().min().unwrap_or(0)
            };
            assert!(span(0).max(span(1)) > 150, "{file} {cut}: {} {}", span(0), span(1));
        }
    }
}

#[test]
fn a_constant_channel_has_a_legend_of_one_value() {
    let place = parts();
    place.run("attribute part.lfl --name heat --value 7 -o constant.lfl").good();
    place.run("attribute part.lfl --name heat --expr z -o rising.lfl").good();
    // The rows of the picture that the legend changes.
    let rows = |file: &str| {
        let [with, without] = ["", "--no-legend"].map(|more| {
            let line = format!("render {file} -o out.png --size 400x300 --samples 1 --from 0,0 {more}");
            place.run(&line).good();
            png(&place, "out.png").2
        });
        let differs = |row: &usize| (300..400).any(|x| with[400 * row + x] != without[400 * row + x]);
        (0..300).filter(differs).count()
    };
    let (constant, rising) = (rows("constant.lfl"), rows("rising.lfl"));
    assert!((10..80).contains(&constant) && rising > 200, "{constant} {rising}");
}

#[test]
fn what_is_full_is_seen_among_what_is_undecided() {
    let place = Place::new();
    // Two revisions. One is shorter by a slab, and their surfaces lie within cells.
    place.write("old.stl", stl(&block([1.03; 3], [6.97; 3])));
    place.write("new.stl", stl(&block([1.03; 3], [6.97, 6.97, 5.03])));
    for name in ["old", "new"] {
        place.run(&format!("voxelize {name}.stl -o {name}.lfl --depth 6 --bounds 0,0,0,8")).good();
    }
    place.run("difference old.lfl new.lfl -o rest.lfl").good();
    place.run("intersection new.lfl rest.lfl -o skin.lfl").good();
    let render = |line: &str| {
        let run = place.run(&format!("render {line} -o out.png --size 200x200 --samples 1 --json"));
        assert_eq!(run.code, Some(0), "{run:?}");
        let report: Value = run.json();
        (report["covered"].as_u64().unwrap(), run.errors.clone(), png(&place, "out.png").2)
    };
    let (shown, note, _) = render("rest.lfl");
    // A slab of two by six by six is FULL. The skin of the other part is larger.
    assert!(note.is_empty() || note.contains("--undecided"), "{note}");
    let (hidden, _, slab) = render("rest.lfl --undecided hidden");
    let (faint, _, both) = render("rest.lfl --undecided faint");
    assert!(hidden > 2000 && hidden < shown && faint >= hidden, "{shown} {hidden} {faint}");
    assert_ne!(slab, both);
    let (_, note, _) = render("skin.lfl");
    assert!(note.contains("no cell is FULL"), "{note}");
    place.run("render old.stl -o never.png --undecided faint").bad(1, &["undecided", "octrees"]);
    place.run("render rest.lfl -o never.png --view slice --undecided faint").bad(2, &["--undecided"]);
}
