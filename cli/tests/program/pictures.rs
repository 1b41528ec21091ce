//! The pictures of the documentation, which the program and the library make: they must still match.
//!
//! `LEAFLESS_BLESS=1 cargo test --test program pictures::` makes them anew.

#[path = "../../../examples/gear_pictures.rs"]
#[allow(dead_code)]
mod gear_pictures;

use leafless::octree::CellFilter;
use leafless::op::Zone;
use leafless::render::{Camera, Finish, Layer, LinesLayer, Picture, Shot, SolidLayer, render, write_png};
use leafless::{Affine, Control, Csg, Frame, LazyOctree, Rule, Tag, build, intersection};
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
    check(name, &write_png(picture).unwrap());
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
