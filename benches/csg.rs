//! Speed of constructive solid geometry, on one thread.
//!
//! ```text
//! cargo bench --bench csg
//! ```
//!
//! `splits` splits each PARTIAL cell of level 8 of a solid of one half-space, one by one. The scene is a ball
//! minus three square bars and twelve cylinders; `peers` (see `benches/README.md`) builds it with another
//! program. `benches/README.md` has figures measured with this file, and explains what limits them.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use leafless::solid::HalfSpace;
use leafless::{Cell, Classifier, Control, Csg, Error, Frame, Rule, Solid, Verdict, Worker, build};
use std::hint::black_box;

#[path = "peers/src/scene.rs"]
mod scene;

type CsgWorker = <<Csg as Solid>::Classifier as Classifier>::Worker;
type CsgPart = <CsgWorker as leafless::solid::Parts>::Part;

fn universe(depth: u8) -> Frame {
    Frame::new([-1.0; 3], 2.0, depth).expect("a good frame")
}

/// Returns the PARTIAL cells of a level.
fn partial(solid: &Csg, frame: &Frame, level: u8) -> (CsgWorker, Vec<(Cell, CsgPart)>) {
    let classifier = solid.on(frame, &Control::threads(1)).expect("an expression on the frame");
    let mut worker = classifier.worker().expect("a worker");
    let mut cells = match worker.root().expect("a root") {
        Verdict::Partial(part) => vec![(Cell::ROOT, part)],
        _ => Vec::new(),
    };
    for _ in 0..level {
        let mut next = Vec::new();
        for (cell, part) in cells {
            let children = worker.split(cell, &part).expect("a split");
            next.extend((0..8).zip(children).filter_map(|(k, child)| match child {
                Verdict::Partial(part) => Some((cell.child(k), part)),
                _ => None,
            }));
        }
        cells = next;
    }
    (worker, cells)
}

fn splits(c: &mut Criterion) {
    let half_space = |coefficients| HalfSpace::quadric(coefficients).map(Csg::from);
    let kinds: [(&str, Result<Csg, Error>); 6] = [
        ("plane", Csg::half_space([0.3, 0.5, 0.7], 0.01)),
        ("ball", Csg::ball([0.1, 0.05, 0.02], 0.8)),
        ("ball that touches lattice planes", Csg::ball([0.0; 3], 1.0)),
        ("cylinder", half_space([-1.0, -1.1, 0.0, 0.0, 0.0, 0.0, 0.01, 0.02, 0.0, 0.3])),
        ("quadric with mixed terms", half_space([-1.0, -1.1, -0.9, 0.2, 0.1, -0.15, 0.01, 0.02, 0.03, 0.6])),
        ("torus", HalfSpace::torus(0.6, 0.3).map(Csg::from)),
    ];
    let mut group = c.benchmark_group("splits");
    let frame = universe(9);
    for (name, solid) in kinds {
        let solid = solid.expect("a good half-space");
        let (mut worker, cells) = partial(&solid, &frame, 8);
        group.throughput(Throughput::Elements(cells.len() as u64));
        group.bench_function(name, |b| {
            b.iter(|| {
                let split = |&(cell, part): &(Cell, CsgPart)| {
                    let children = worker.split(cell, &part);
                    matches!(children.expect("a split")[3], Verdict::Partial(_)) as usize
                };
                cells.iter().map(split).sum::<usize>()
            })
        });
    }
}

fn scenes(c: &mut Criterion) {
    let control = Control::threads(1);
    let mut group = c.benchmark_group("scene");
    group.sample_size(10);
    let solid = scene::solid().expect("a good scene");
    for depth in [7, 8, 9, 10] {
        for rule in [Rule::Sampled, Rule::Certified] {
            group.bench_function(format!("depth {depth}, {rule:?}"), |b| {
                b.iter_with_large_drop(|| build(black_box(&solid), &universe(depth), rule, &control))
            });
        }
    }
    // Ten thousand balls at pseudo-random places: apart, overlapping, and filling most of space.
    for radius in [0.01, 0.02, 0.04] {
        let mut state = 1u64;
        let mut number = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 53) as f64 * 1.9 - 0.95
        };
        let balls: Vec<Csg> = (0..10_000)
            .map(|_| Csg::ball([number(), number(), number()], radius).expect("a good ball"))
            .collect();
        let union = Csg::union_of(balls).expect("memory");
        for rule in [Rule::Sampled, Rule::Certified] {
            group.bench_function(format!("10 000 balls of radius {radius}, depth 9, {rule:?}"), |b| {
                b.iter_with_large_drop(|| build(black_box(&union), &universe(9), rule, &control))
            });
        }
    }
}

criterion_group!(benches, splits, scenes);
criterion_main!(benches);
