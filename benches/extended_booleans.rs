//! Set operations of extended octrees, on one thread: bores in a plate and balls out of a block, one by one
//! and at once.
//!
//! ```text
//! cargo bench --bench extended_booleans
//! ```
//!
//! Medians of several runs, wall clock. Sizes are file sizes; widths are those of the volume after 2^20
//! splits.

use leafless::op::difference_of;
use leafless::{
    Affine, Control, Csg, Frame, Octree, OctreeRef, SurfaceOptions, build_extended, difference, file, measure,
};
use std::time::{Duration, Instant};

fn control() -> Control<'static> {
    Control::threads(1)
}

fn extended(csg: &Csg, frame: &Frame) -> Octree {
    build_extended(csg, frame, &SurfaceOptions::default(), &control()).unwrap()
}

/// Returns the median time of `runs` runs, and the result of the last one.
fn timed<R>(runs: usize, mut run: impl FnMut() -> R) -> (Duration, R) {
    let mut times = Vec::new();
    let mut made = None;
    for _ in 0..runs {
        let start = Instant::now();
        made = Some(run());
        times.push(start.elapsed());
    }
    times.sort();
    (times[runs / 2], made.unwrap())
}

fn one_by_one(stock: &Octree, tools: &[Octree]) -> Octree {
    let mut part = stock.clone();
    for tool in tools {
        part = difference(part.view(), tool.view(), &control()).unwrap();
    }
    part
}

fn at_once(stock: &Octree, tools: &[Octree]) -> Octree {
    let all: Vec<OctreeRef<'_>> = [stock].into_iter().chain(tools).map(|tree| *tree.view()).collect();
    difference_of(&all, &control()).unwrap()
}

fn told(name: &str, time: Duration, tree: &Octree) {
    let cuts = tree.view().cuts().unwrap_or_default();
    println!(
        "{name}: {:.3} ms, {} nodes, {} cells, {} surfaces, {} given up, {} bytes",
        time.as_secs_f64() * 1e3,
        tree.statistics().nodes(),
        cuts.cells,
        cuts.surfaces,
        cuts.given_up,
        file::to_bytes(tree).unwrap().len()
    );
}

fn width(name: &str, tree: &Octree) {
    let control = Control { max_splits: Some(1 << 20), ..control() };
    let start = Instant::now();
    let volume = measure(tree, tree.frame(), 0.0, &control).unwrap().volume;
    let relative = volume.width() / volume.upper;
    println!(
        "{name}: volume {volume:?}, relative width {relative:.2e}, {:.2} s",
        start.elapsed().as_secs_f64()
    );
    let start = Instant::now();
    let measured = measure(tree, tree.frame(), 1e-5, &Control::threads(1)).unwrap();
    println!("    to 1e-5: {} splits, {:.3} s", measured.splits, start.elapsed().as_secs_f64());
}

fn bore(x: f64, y: f64, frame: &Frame) -> Octree {
    let to = Affine::translation([x, y, 0.0]).unwrap();
    extended(&Csg::cylinder(2.5, -1.0, 11.0).unwrap().placed(&to).unwrap(), frame)
}

/// A plate of 80 × 60 × 10 with twenty bores, and one more bore.
fn plate() {
    let frame = Frame::around([0.0; 3], [80.0, 60.0, 10.0], 20).unwrap();
    let stock = extended(&Csg::cuboid([0.0; 3], [80.0, 60.0, 10.0]).unwrap(), &frame);
    let tools: Vec<Octree> =
        (0..20).map(|k| bore(8.0 + 16.0 * f64::from(k % 5), 7.5 + 15.0 * f64::from(k / 5), &frame)).collect();
    let (time, part) = timed(21, || one_by_one(&stock, &tools));
    told("plate, twenty bores one by one", time, &part);
    let (time, part) = timed(21, || at_once(&stock, &tools));
    told("plate, twenty bores at once", time, &part);
    let more = bore(16.0, 15.0, &frame);
    let (time, more) = timed(101, || difference(part.view(), more.view(), &control()).unwrap());
    told("plate, a bore more", time, &more);
    width("plate", &part);
}

/// A block and 100 balls of 6 % of its edge.
fn balls() {
    let frame = Frame::around([0.0; 3], [1.0; 3], 20).unwrap();
    let block = Csg::cuboid([0.0; 3], [1.0; 3]).unwrap();
    let mut state = 1u64;
    let mut unit = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let balls: Vec<Csg> = (0..100).map(|_| Csg::ball([unit(), unit(), unit()], 0.06).unwrap()).collect();
    let stock = extended(&block, &frame);
    let tools: Vec<Octree> = balls.iter().map(|ball| extended(ball, &frame)).collect();
    let (time, part) = timed(5, || one_by_one(&stock, &tools));
    told("block, 100 balls one by one", time, &part);
    width("block, one by one", &part);
    let (time, part) = timed(5, || at_once(&stock, &tools));
    told("block, 100 balls at once", time, &part);
    width("block, at once", &part);
    let expression = block.difference(&Csg::union_of(balls).unwrap()).unwrap();
    let (time, part) = timed(5, || extended(&expression, &frame));
    told("block, the expression", time, &part);
    width("block, the expression", &part);
}

/// A plate of 1000 × 1000 × 10 and a thousand bores.
fn thousand() {
    let frame = Frame::around([0.0; 3], [1000.0, 1000.0, 10.0], 20).unwrap();
    let stock = extended(&Csg::cuboid([0.0; 3], [1000.0, 1000.0, 10.0]).unwrap(), &frame);
    let tools: Vec<Octree> = (0..1000)
        .map(|k| bore(16.0 + 31.0 * f64::from(k % 32), 16.0 + 31.0 * f64::from(k / 32), &frame))
        .collect();
    let (time, part) = timed(1, || one_by_one(&stock, &tools));
    told("plate, 1000 bores one by one", time, &part);
    let (time, part) = timed(3, || at_once(&stock, &tools));
    told("plate, 1000 bores at once", time, &part);
}

fn main() {
    plate();
    balls();
    thousand();
}
