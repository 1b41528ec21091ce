//! Tri-dexel models: dexelisation, Booleans, cuts in place.
//!
//! `LEAFLESS_MODELS=/path/to/models cargo bench --bench dexels`. One thread. Medians of several runs.

use leafless::dexel::{DexelEditor, DexelEnds, DexelFormat};
use leafless::op::DexelOptions;
use leafless::{Affine, Control, Csg, FillRule, Frame, MeshSolid, TriDexel, dexelize, exchange};
use std::time::{Duration, Instant};

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort();
    times[times.len() / 2].as_secs_f64()
}

fn timed<T>(runs: usize, mut work: impl FnMut() -> T) -> (f64, T) {
    let mut times = Vec::new();
    let mut last = None;
    for _ in 0..runs {
        drop(last.take());
        let start = Instant::now();
        last = Some(work());
        times.push(start.elapsed());
    }
    (median(times), last.unwrap())
}

fn mesh(name: &str) -> Option<MeshSolid> {
    let folder = std::env::var("LEAFLESS_MODELS").ok()?;
    let path = std::path::Path::new(&folder).join(name);
    let bytes = std::fs::read(path).expect("the model can be read");
    let mesh =
        exchange::read_stl(&bytes).expect("the model is an STL file").sewn().expect("the mesh is sewn");
    Some(MeshSolid::new(mesh, FillRule::NonZero).expect("the model is a solid"))
}

fn megabytes(model: &TriDexel) -> f64 {
    model.view().bytes() as f64 / 1e6
}

/// The bunny as scanned. No triangle bounds it at its five holes.
fn open_bunny(control: &Control<'_>) {
    let Some(folder) = std::env::var_os("LEAFLESS_MODELS") else { return };
    let bytes = std::fs::read(std::path::Path::new(&folder).join("stanford-bunny.obj")).expect("the model");
    let mesh = exchange::read_obj(&bytes).expect("an OBJ file");
    let (min, max) = mesh.bounds();
    let solid = MeshSolid::new(mesh, FillRule::NonZero).expect("a solid");
    for depth in [8, 9, 10] {
        let frame = Frame::around(min, max, depth).expect("a frame");
        let options = DexelOptions::default();
        let (time, model) = timed(3, || dexelize(&solid, &frame, &options, control).expect("dexels"));
        println!(
            "stanford-bunny.obj at {}: {:.0} ms, {} intervals",
            frame.cells(),
            time * 1e3,
            model.view().interval_count()
        );
    }
}

fn main() {
    let control = Control::threads(1);
    let double = DexelFormat { ends: DexelEnds::Double, ..DexelFormat::default() };
    for name in ["bunny-closed.stl", "featuretype.STL"] {
        let Some(solid) = mesh(name) else {
            println!("LEAFLESS_MODELS is not set: no meshes");
            break;
        };
        let (min, max) = solid.mesh().bounds();
        let frame = Frame::around(min, max, 10).expect("a frame");
        for (form, format) in [("fixed", DexelFormat::default()), ("double", double)] {
            let options = DexelOptions { format, ..DexelOptions::default() };
            let (time, model) = timed(5, || dexelize(&solid, &frame, &options, &control).expect("dexels"));
            println!(
                "{name} at 1024, {form}: {:.0} ms, {:.1} MB, {} intervals",
                time * 1e3,
                megabytes(&model),
                model.view().interval_count()
            );
            let step = frame.cell_size() * 8.0;
            let moved = solid
                .placed(&Affine::translation([step, 0.5 * step, 0.25 * step]).expect("a step"))
                .expect("moved");
            let other = dexelize(&moved, &frame, &options, &control).expect("dexels");
            let (a, b) = (model.view(), other.view());
            let times = [
                timed(7, || a.union(b, &control).expect("union")).0,
                timed(7, || a.intersection(b, &control).expect("intersection")).0,
                timed(7, || a.difference(b, &control).expect("difference")).0,
            ];
            let [union, intersection, difference] = times.map(|time| time * 1e3);
            println!(
                "  with itself moved: union {union:.1} ms, intersection {intersection:.1} ms, difference {difference:.1} ms"
            );
        }
    }
    open_bunny(&control);
    let frame = Frame::new([0.0; 3], 512.0, 9).expect("a frame");
    let options = DexelOptions::default();
    let block = dexelize(&Csg::cuboid([1.0; 3], [511.0; 3]).expect("a block"), &frame, &options, &control)
        .expect("dexels");
    let balls: Vec<Csg> = (0..1000)
        .map(|i| {
            let t = f64::from(i) / 1000.0;
            let at = [60.0 + 390.0 * t, 256.0 + 180.0 * (40.0 * t).sin(), 505.0 - 60.0 * t];
            Csg::ball(at, 0.06 * 510.0).expect("a ball")
        })
        .collect();
    let (time, _) = timed(5, || {
        let mut editor = DexelEditor::new(block.view()).expect("an editor");
        for ball in &balls {
            let tool = dexelize(ball, &frame, &options, &control).expect("dexels");
            editor.subtract(tool.view(), &control).expect("a cut");
        }
        editor.bytes()
    });
    println!("1000 ball cuts into a block at 512, dexelised and in place: {:.0} ms", time * 1e3);
    let tools: Vec<TriDexel> =
        balls.iter().map(|ball| dexelize(ball, &frame, &options, &control).expect("dexels")).collect();
    let (time, _) = timed(5, || {
        let mut editor = DexelEditor::new(block.view()).expect("an editor");
        for tool in &tools {
            editor.subtract(tool.view(), &control).expect("a cut");
        }
        editor.bytes()
    });
    println!("  of tools that are dexelised already: {:.0} ms", time * 1e3);
}
