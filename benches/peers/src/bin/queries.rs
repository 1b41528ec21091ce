//! Rays and points on a mesh's octree, compared with a mask of NanoVDB.
//!
//! ```text
//! cargo run --release --manifest-path benches/peers/Cargo.toml --bin queries -- mesh.stl nanovdb
//! ```
//!
//! `nanovdb` is built from `nanovdb.cpp`, see benches/README.md. Both programs have the same 1024 cells along
//! an axis, decided at their centres. The queries are a million rays of a camera to their first full cell, in
//! scan order and in random order, and a million points of the bounding box, uniform at random and along
//! lines. One thread each, in turn, processor time. The camera: eye at the centre of the box + 2 D w, D its
//! diagonal, w along (1, 0.7, 0.5), half width D/2.

use leafless::octree::Cursor;
use leafless::query::{Obstacle, PointCursor, PointTable};
use leafless::{Control, Frame, Membership, Ray, Rule, build, compact};
use peers::{Peer, median, read, solid, spent, write_full};
use std::error::Error;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::Command;

const DEPTH: u8 = 10;
const SIDE: usize = 1024;
const ROUNDS: usize = 9;

type Vector = [f64; 3];

fn sum(a: Vector, b: Vector, factor: f64) -> Vector {
    [0, 1, 2].map(|axis| a[axis] + factor * b[axis])
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Vector) -> Vector {
    let length = a.iter().map(|c| c * c).sum::<f64>().sqrt();
    a.map(|c| c / length)
}

/// Returns the origins and directions of a camera's rays.
fn camera(min: Vector, max: Vector, perspective: bool) -> Vec<[Vector; 2]> {
    let diagonal = sum(max, min, -1.0);
    let size = diagonal.iter().map(|c| c * c).sum::<f64>().sqrt();
    let w = unit([1.0, 0.7, 0.5]);
    let right = unit(cross([0.0, 0.0, 1.0], w));
    let up = cross(w, right);
    let eye = sum(sum(min, diagonal, 0.5), w, 2.0 * size);
    let ahead = w.map(|c| -c);
    let at = |i: usize| (2.0 * i as f64 + 1.0) / SIDE as f64 - 1.0;
    let pixels = (0..SIDE * SIDE).map(|i| (at(i % SIDE), at(i / SIDE)));
    let ray = |(x, y): (f64, f64)| {
        if perspective {
            [eye, unit(sum(sum(ahead, right, 0.25 * x), up, 0.25 * y))]
        } else {
            [sum(sum(eye, right, 0.5 * size * x), up, 0.5 * size * y), ahead]
        }
    };
    pixels.map(ray).collect()
}

/// Pseudo-random numbers (splitmix64).
fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let z = (*state ^ *state >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ z >> 31
}

fn shuffled(mut rays: Vec<[Vector; 2]>) -> Vec<[Vector; 2]> {
    let mut state = 1;
    for i in (1..rays.len()).rev() {
        rays.swap(i, (random(&mut state) % (i as u64 + 1)) as usize);
    }
    rays
}

/// A million points, 128 on each of the lines if they are `coherent`.
fn points(min: Vector, max: Vector, coherent: bool) -> Vec<Vector> {
    let mut state = 2;
    let mut share = || random(&mut state) as f64 / u64::MAX as f64;
    let mut point = || [0, 1, 2].map(|axis| min[axis] + share() * (max[axis] - min[axis]));
    let mut all: Vec<Vector> = Vec::with_capacity(SIDE * SIDE);
    while all.len() < SIDE * SIDE {
        let (from, to) = (point(), point());
        match coherent {
            true => all.extend((0..128).map(|i| sum(from, sum(to, from, -1.0), i as f64 / 128.0))),
            false => all.extend([from, to]),
        }
    }
    all
}

fn save<const N: usize>(path: &Path, all: impl Iterator<Item = [f64; N]>) -> std::io::Result<()> {
    let mut out = BufWriter::new(std::fs::File::create(path)?);
    for one in all {
        one.iter().try_for_each(|x| out.write_all(&x.to_ne_bytes()))?;
    }
    out.flush()
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mesh = read(&arguments.next().ok_or("which mesh?")?)?;
    let program = arguments.next().ok_or("which program?")?;
    let (min, max) = mesh.bounds();
    let frame = Frame::around(min, max, DEPTH)?;
    let tree = compact(build(&solid(&mesh)?, &frame, Rule::Sampled, &Control::threads(1))?.view())?;

    let folder = std::env::temp_dir().join(format!("queries-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let path = |name: &str| -> PathBuf { folder.join(name) };
    let mut out = BufWriter::new(std::fs::File::create(path("cells"))?);
    write_full(&mut Cursor::new(tree.view()), DEPTH, &mut out)?;
    out.flush()?;
    let place = frame.origin().map(|x| format!("{x:?}"));
    let mut peer = Peer::start(
        Command::new(program).arg(path("cells")).args(place).arg(format!("{:?}", frame.cell_size())),
    )?;

    println!("nanoseconds of processor time, medians of {ROUNDS}; queries that hit");
    let million = (SIDE * SIDE) as f64;
    let mut compare = |name: &str, kind: &str, file: &Path, ours: &mut dyn FnMut() -> usize| {
        let (mut times, mut theirs, mut hits) = (Vec::new(), Vec::new(), [0.0; 2]);
        for _ in 0..ROUNDS {
            let answer = peer.ask(&format!("{kind} {}", file.display()))?;
            theirs.push(answer[0] * 1e6 / million);
            let start = spent().0;
            let count = ours();
            times.push((spent().0 - start) * 1e6 / million);
            hits = [count as f64, answer[1]];
        }
        let (ours, theirs) = (median(times), median(theirs));
        let [a, b] = hits;
        println!(
            "{name:32} Leafless {ours:6.1} {a:7}  NanoVDB {theirs:6.1} {b:7}  ratio {:.2}",
            theirs / ours
        );
        Ok::<(), Box<dyn Error>>(())
    };

    for (view, perspective) in [("parallel", false), ("perspective", true)] {
        let pixels = camera(min, max, perspective);
        for (order, rays) in [("in scan order", pixels.clone()), ("in random order", shuffled(pixels))] {
            save(&path("rays"), rays.iter().map(|[a, b]| [a[0], a[1], a[2], b[0], b[1], b[2]]))?;
            let rays = rays.iter().map(|&[from, to]| Ray::new(from, to)).collect::<Result<Vec<_>, _>>()?;
            let mut hits = vec![None; rays.len()];
            let mut cast = || {
                tree.cast_rays(&rays, Obstacle::Full, &mut hits).expect("as many hits");
                hits.iter().flatten().count()
            };
            compare(&format!("{view} rays, {order}"), "rays", &path("rays"), &mut cast)?;
        }
    }

    let inside = |answers: &mut dyn Iterator<Item = Membership>| {
        answers.filter(|&answer| answer == Membership::Inside).count()
    };
    let (uniform, lines) = (points(min, max, false), points(min, max, true));
    let (at_random, along) = (path("uniform"), path("lines"));
    save(&at_random, uniform.iter().copied())?;
    save(&along, lines.iter().copied())?;
    let mut one_by_one = || inside(&mut uniform.iter().map(|&p| tree.contains(p)));
    compare("points, one by one", "tree", &at_random, &mut one_by_one)?;
    let table = PointTable::new(tree.view(), 6)?;
    let mut with_table = || inside(&mut uniform.iter().map(|&p| table.contains(p)));
    compare("points, table of level 6", "tree", &at_random, &mut with_table)?;
    let mut answers = vec![Membership::Outside; uniform.len()];
    let mut batch = || {
        tree.contains_many(&uniform, &mut answers).expect("as many answers");
        inside(&mut answers.iter().copied())
    };
    compare("points, a batch", "tree", &at_random, &mut batch)?;
    let mut with_cursor = || {
        let mut cursor = PointCursor::new(tree.view());
        inside(&mut lines.iter().map(|&p| cursor.contains(p)))
    };
    compare("points along lines, cursor", "accessor", &along, &mut with_cursor)?;
    peer.end()?;
    Ok(std::fs::remove_dir_all(folder)?)
}
