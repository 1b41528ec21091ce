//! The pictures of the documentation, which the program and the library make: they must still match.
//!
//! `LEAFLESS_BLESS=1 cargo test --test program pictures::` makes them anew.

#[path = "../../../examples/gear_pictures.rs"]
#[allow(dead_code)]
mod gear_pictures;

use crate::place::Place;
use leafless::octree::CellFilter;
use leafless::op::Zone;
use leafless::render::{Camera, Finish, Layer, LinesLayer, Picture, Shot, SolidLayer, render};
use leafless::{Affine, Control, Csg, Frame, LazyOctree, Rule, Tag, build, exchange, intersection};
use std::io::Cursor;
use std::path::PathBuf;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../docs/pictures")
}

/// Width, height and colours of a picture on white.
fn pixels(bytes: &[u8]) -> (u32, u32, Vec<[f64; 3]>) {
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut data).unwrap();
    let colours = data.chunks_exact(info.color_type.samples()).map(|pixel| {
        let a = pixel.get(3).map_or(1.0, |&a| f64::from(a) / 255.0);
        [0, 1, 2].map(|k| f64::from(pixel[k]) * a + 255.0 * (1.0 - a))
    });
    (info.width, info.height, colours.collect())
}

/// Compares a picture with the one of the documentation: sizes are equal, and the root mean square of the
/// differences is at most one part in 255.
pub fn check(name: &str, bytes: &[u8]) {
    let path = folder().join(name);
    if std::env::var_os("LEAFLESS_BLESS").is_some() {
        std::fs::create_dir_all(folder()).unwrap();
        std::fs::write(&path, bytes).unwrap();
        return;
    }
    let expected =
        pixels(&std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display())));
    let found = pixels(bytes);
    assert_eq!((found.0, found.1), (expected.0, expected.1), "{name}");
    let square =
        |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>() / 3.0;
    let sum: f64 = found.2.iter().zip(&expected.2).map(square).sum();
    let off = (sum / found.2.len() as f64).sqrt();
    assert!(off <= 1.0, "{name} differs by {off:.2} of 255: see that it is right, and bless it");
}

fn check_picture(name: &str, picture: &Picture) {
    check(name, &exchange::write_png(picture).unwrap());
}

/// A plate with twenty bores by its cells, and by the cells of which some keep surfaces; and what the
/// documentation says of both.
#[test]
fn a_plate_with_twenty_bores() {
    let place = Place::new();
    let extended = |name: &str, text: &str| {
        place.write(&format!("{name}.csg"), text);
        let bounds = "--bounds -2.5,-12.5,-37.5,85";
        place.run(&format!("csg {name}.csg -o {name}.lfl --surfaces {bounds}")).good();
    };
    extended("plate", "cube([80, 60, 10]);");
    let mut bores = String::new();
    for k in 0..20 {
        let to = format!(
            "[1, 0, 0, {}], [0, 1, 0, {}], [0, 0, 1, -1]",
            8 + 16 * (k % 5),
            7.5 + 15.0 * f64::from(k / 5)
        );
        let bore = format!("multmatrix([{to}, [0, 0, 0, 1]]) cylinder(h = 12, r = 2.5, $fn = 0);");
        extended(&format!("bore{k}"), &bore);
        bores += &format!("bore{k}.lfl ");
    }
    let told = place.run(&format!("difference plate.lfl {bores} -o part.lfl")).good();
    let page = std::fs::read_to_string(folder().join("../extended.md")).unwrap();
    for words in ["44072.93 ± 0.43", "49 nodes", "4,072 bytes"] {
        assert!(told.text().contains(words), "{words}: {told:?}");
    }
    let told = place.run("convert part.lfl -o plain.lfl --to octree --resolution 1024").good();
    for words in ["44240 ± 650", "757,937", "456,648"] {
        assert!(told.text().contains(words) && page.contains(words), "{words}: {told:?}");
    }
    assert!(page.contains("44072.93 ± 0.43") && page.contains("| 49 |") && page.contains("| 4,072 |"));
    place.run(&format!("difference plate.lfl {bores} -o extended.lfl --plain")).good();
    place.run("render part.lfl -o plate.png --size 420x320 --from 35,35").good();
    check("plate.png", &place.bytes("plate.png"));
    for name in ["plain", "extended"] {
        let view = "--view slice --plane 0,0,1,-5 --no-legend --size 420x320";
        place.run(&format!("render {name}.lfl -o {name}.png {view}")).good();
        check(&format!("plate-{name}.png"), &place.bytes(&format!("{name}.png")));
    }
}

/// The layout of the documentation: scenes and commands are those of the page, and what the page says is what
/// is told.
#[test]
fn parts_in_a_box() {
    let place = Place::new();
    let page = std::fs::read_to_string(folder().join("../layout.md")).unwrap();
    let blocks: Vec<&str> = page.split("```").collect();
    let scenes = blocks.iter().find_map(|block| block.strip_prefix("openscad\n// ")).unwrap();
    for scene in scenes.split("// ") {
        let (name, text) = scene.split_once('\n').unwrap();
        place.write(name, text);
        place.run(&format!("mesh {name} -o {}.stl", name.strip_suffix(".csg").unwrap())).good();
    }
    let told = blocks.iter().find_map(|block| block.strip_prefix("console\n")).unwrap();
    let (_, command) = told.split_once("$ leafless ").unwrap();
    let (command, lines) = command.split_once("tray.png\n").unwrap();
    let run = place.run(&format!("{}tray.png", command.replace("\\\n", ""))).good();
    assert!(run.text().contains("placed          27 of 27\n"), "{run:?}");
    for line in lines.lines() {
        assert!(run.text().lines().any(|told| told == line), "{line}: {run:?}");
    }
    check("layout.png", &place.bytes("tray.png"));
    place.run("layout --check tray.json").good();
}

#[test]
fn the_inside_of_the_gear() {
    let control = Control::default();
    let part = &gear_pictures::gear_records::parts(&control).unwrap()[1];
    let lists = part.lists(&control).unwrap();
    let found = gear_pictures::pictures(part, &lists, [300, 260], &control).unwrap();
    for (picture, which) in found.iter().zip(["coarse", "adaptive", "fine"]) {
        check_picture(&format!("gear-{which}.png"), picture);
    }
}

/// Two rings that touch: where both may be, cells were split, and nowhere else.
#[test]
fn cells_that_were_split() {
    let control = Control::default();
    let frame = Frame::new([-2.0; 3], 4.0, 7).unwrap();
    let ring =
        |x: f64| Csg::torus(0.9, 0.25).unwrap().placed(&Affine::translation([x, 0.0, 0.0]).unwrap()).unwrap();
    let (a, b) = (ring(-0.6), ring(0.6));
    // Coarse cells tell where both may be; only there finer ones are asked for.
    let coarse = frame.with_depth(4).unwrap();
    let [low_a, low_b] = [&a, &b].map(|solid| build(solid, &coarse, Rule::Certified, &control).unwrap());
    let both = intersection(low_a.view(), low_b.view(), &control).unwrap();
    let mut lazy = LazyOctree::new(&a, &frame).unwrap();
    for found in both.view().cells(CellFilter::tags(&[Tag::Full, Tag::Partial])) {
        let size = frame.edge() / f64::from(1u32 << found.cell.level);
        let min = [0, 1, 2].map(|axis| frame.origin()[axis] + f64::from(found.cell.at[axis]) * size);
        let max = min.map(|low| low + size);
        lazy.refine(&Zone::Box { min, max }, 7, &control).unwrap();
    }
    let octree = lazy.freeze(&control).unwrap();
    let cells = octree
        .view()
        .cells(CellFilter::tags(&[Tag::Partial, Tag::Full]).levels(5..=7))
        .map(|found| found.cell);
    let lines = LinesLayer::of_cells(&frame, cells).unwrap().colour([213, 94, 0, 255]);
    let finish = |colour| Finish { colour, ..Finish::default() };
    let (first, second) = (
        SolidLayer::new(&a, &frame, finish([178, 187, 196, 255])),
        SolidLayer::new(&b, &frame, finish([86, 180, 233, 90])),
    );
    let bounds = leafless::Bounds { min: [-1.8, -1.2, -0.3], max: [1.8, 1.2, 0.3] };
    let camera = Camera::fitted(&bounds.corners(), [20.0, 55.0], Some(30.0), 1.4).unwrap();
    let layers: [&dyn Layer; 3] = [&first, &second, &lines];
    check_picture("split.png", &render(&Shot::new(camera, [420, 300]), &layers, &control).unwrap());
}
