//! Booleans of a mesh and its copy, compared with OpenVDB's masks, and the gain of a second thread.
//!
//! ```text
//! cargo run --release --manifest-path benches/peers/Cargo.toml --bin booleans -- mesh.stl [openvdb]
//! ```
//!
//! `openvdb` is built from `openvdb.cpp`, see benches/README.md. The longest side of the mesh has 1024 cells.
//! The copy is moved by 10 % of its extent along x, on the same lattice. One thread each, in turn, processor
//! time. Without the second argument, the program measures the mesh and its copy rotated by 0.002 rad, on one
//! thread and on two, elapsed time.

use leafless::octree::Cursor;
use leafless::{Control, Frame, Octree, OctreeRef, Rule, TriangleMesh, build, difference, intersection, union};
use peers::{Peer, median, read, solid, spent, write_full};
use std::error::Error;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::process::Command;
use std::time::Instant;

const CELLS: f64 = 1024.0;
/// A memory allocator with which copying a mask takes a fraction of the time.
const PRELOADED: &str = "libtbbmalloc_proxy.so.2";
const ROUNDS: usize = 9;
/// Operations of Leafless in a round.
const TIMES: usize = 10;

type Made = Result<Octree, leafless::Error>;
type Operation = fn(&OctreeRef<'_>, &OctreeRef<'_>, &Control<'_>) -> Made;
const OPERATIONS: [(&str, Operation); 3] =
    [("union", union), ("intersection", intersection), ("difference", difference)];

fn octree(mesh: &TriangleMesh, frame: &Frame, rule: Rule, threads: usize) -> Made {
    build(&solid(mesh)?, frame, rule, &Control::threads(threads))
}

fn beside(mesh: &TriangleMesh, peer: &Path) -> Result<(), Box<dyn Error>> {
    let (min, max) = mesh.bounds();
    let extent = [0, 1, 2].map(|i| max[i] - min[i]);
    let cell = extent.iter().copied().fold(0.0, f64::max) / CELLS;
    let step = (extent[0] * 0.1 / cell).round();
    let mut depth = 1;
    while f64::from(1 << depth) < CELLS + step {
        depth += 1;
    }
    let frame = Frame::new(min, cell * f64::from(1 << depth), depth)?;
    let moved = mesh.translated([step * cell, 0.0, 0.0])?;
    let pair =
        |rule| Ok::<_, leafless::Error>([octree(mesh, &frame, rule, 1)?, octree(&moved, &frame, rule, 1)?]);
    let (sampled, certified) = (pair(Rule::Sampled)?, pair(Rule::Certified)?);
    let paths = [0, 1].map(|k| std::env::temp_dir().join(format!("booleans-{}-{k}", std::process::id())));
    for (tree, path) in sampled.iter().zip(&paths) {
        let mut out = BufWriter::new(std::fs::File::create(path)?);
        write_full(&mut Cursor::new(tree.view()), depth, &mut out)?;
        out.flush()?;
    }
    let mut peer = Peer::start(Command::new(peer).args(&paths).env("LD_PRELOAD", PRELOADED))?;
    let control = Control::threads(1);
    println!("depth {depth}, milliseconds of processor time, medians of {ROUNDS}");
    println!("              MaskGrid copy     op  sampled ratio faults  certified ratio faults");
    for (name, operation) in OPERATIONS {
        let mut figures: [Vec<f64>; 6] = Default::default();
        for _ in 0..ROUNDS {
            let theirs = peer.ask(name)?;
            figures[0].push(theirs[0]);
            figures[1].push(theirs[1]);
            for (k, [a, b]) in [&sampled, &certified].into_iter().enumerate() {
                let start = spent();
                for _ in 0..TIMES {
                    drop(std::hint::black_box(operation(a.view(), b.view(), &control)?));
                }
                let end = spent();
                figures[2 + 2 * k].push((end.0 - start.0) / TIMES as f64);
                figures[3 + 2 * k].push((end.1 - start.1) / TIMES as f64);
            }
            let cells =
                operation(sampled[0].view(), sampled[1].view(), &control)?.statistics().volume_cells().0;
            assert_eq!(theirs[2], cells as f64, "the same cells");
        }
        let [copy, op, a, af, b, bf] = figures.map(median);
        let (ra, rb) = ((copy + op) / a, (copy + op) / b);
        println!("{name:12}  {copy:13.2} {op:6.2}  {a:7.3} {ra:5.1} {af:6.0}  {b:9.3} {rb:5.1} {bf:6.0}");
    }
    peer.end()?;
    paths.iter().try_for_each(std::fs::remove_file)?;
    Ok(())
}

fn scaling(mesh: &TriangleMesh) -> Result<(), Box<dyn Error>> {
    let (min, max) = mesh.bounds();
    let (sin, cos) = 0.002f64.sin_cos();
    let centre = [0, 1, 2].map(|i| (min[i] + max[i]) / 2.0);
    let turn = |[x, y, z]: [f64; 3]| {
        let (x, y) = (x - centre[0], y - centre[1]);
        [centre[0] + cos * x - sin * y, centre[1] + sin * x + cos * y, z]
    };
    let turned = mesh.transformed(turn)?;
    println!("                          one ms  two ms  ratio of medians, of minima; {ROUNDS} rounds");
    for rule in [Rule::Sampled, Rule::Certified] {
        for depth in [10, 11] {
            let frame = Frame::around(min, max, depth)?;
            let (a, b) = (octree(mesh, &frame, rule, 0)?, octree(&turned, &frame, rule, 0)?);
            let mut all: Vec<(&str, Box<dyn Fn(usize) -> Made>)> = Vec::new();
            for (name, operation) in OPERATIONS {
                let (a, b) = (a.clone(), b.clone());
                all.push((name, Box::new(move |n| operation(a.view(), b.view(), &Control::threads(n)))));
            }
            let solid = solid(mesh)?;
            all.push(("build", Box::new(move |n| build(&solid, &frame, rule, &Control::threads(n)))));
            for (name, operation) in all {
                let mut times = [Vec::new(), Vec::new()];
                for _ in 0..ROUNDS {
                    for (k, times) in times.iter_mut().enumerate() {
                        let start = Instant::now();
                        drop(std::hint::black_box(operation(k + 1)?));
                        times.push(1e3 * start.elapsed().as_secs_f64());
                    }
                }
                let least = times.each_ref().map(|t| t.iter().copied().fold(f64::MAX, f64::min));
                let [one, two] = times.map(median);
                println!(
                    "{:9} {depth} {name:12} {one:7.1} {two:7.1}  {:.2} {:.2}",
                    format!("{rule:?}"),
                    one / two,
                    least[0] / least[1]
                );
            }
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("which mesh?")?;
    let mesh = read(&path)?;
    match arguments.next() {
        Some(peer) => beside(&mesh, peer.as_ref()),
        None => scaling(&mesh),
    }
}
