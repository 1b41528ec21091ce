//! Speed of the foundation, on one thread: meshes to octrees, Booleans, point queries, files.
//!
//! ```text
//! LEAFLESS_MODELS=/path/to/models cargo bench --bench foundation
//! ```
//!
//! The models are `featuretype.STL` (a machined part, 3 476 triangles), `bunny-closed.stl` (a scan, 69 674
//! triangles) and `stanford-bunny.obj` (the same with holes); without them a part that the library makes
//! itself takes their place. Figures measured with this file, and what limits them, stand in
//! `benches/README.md`.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use leafless::octree::{CellFilter, Cursor, Direction, TaggedCell};
use leafless::query::{PointCursor, PointTable};
use leafless::{
    Control, FillRule, Frame, Membership, MeshSolid, Octree, Rule, Tag, TriangleMesh, build, compact,
    difference, exchange, file, intersection, union, xor,
};
use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;

const DEPTH: u8 = 10;
const POINTS: usize = 1_000_000;

/// The bytes of a model, or of a generated mesh of about as many triangles.
fn model(name: &str) -> Vec<u8> {
    match std::env::var_os("LEAFLESS_MODELS") {
        Some(folder) => std::fs::read(Path::new(&folder).join(name)).expect(name),
        None => {
            eprintln!("SKIPPED {name}: LEAFLESS_MODELS is not set; a generated mesh takes its place");
            let mut torus = torus(if name.contains("bunny") { 187 } else { 42 });
            if name.starts_with("stanford") {
                torus = TriangleMesh::new(torus.vertices().into(), torus.triangles()[400..].into())
                    .expect("a torus");
            }
            exchange::write_stl(&torus).expect("a torus")
        }
    }
}

/// A torus of 2 n² triangles.
fn torus(n: u32) -> TriangleMesh {
    let turn = |i: u32| std::f64::consts::TAU * i as f64 / n as f64;
    let vertices = (0..n * n).map(|i| {
        let ((s, c), (t, d)) = (turn(i / n).sin_cos(), turn(i % n).sin_cos());
        [(2.0 + 0.7 * d) * c, (2.0 + 0.7 * d) * s, 0.7 * t]
    });
    let at = |i: u32, j: u32| i % n * n + j % n;
    let triangles = (0..n * n).flat_map(|i| {
        let (i, j) = (i / n, i % n);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    TriangleMesh::new(vertices.collect(), triangles.collect()).expect("a closed mesh")
}

fn mesh(bytes: &[u8]) -> Arc<TriangleMesh> {
    let file = exchange::read_mesh(bytes, &exchange::MeshOptions::default()).expect("a mesh");
    Arc::new(file.mesh.sewn().expect("a mesh"))
}

fn frame(mesh: &TriangleMesh) -> Frame {
    let (min, max) = mesh.bounds();
    Frame::around(min, max, DEPTH).expect("a frame")
}

fn octree(mesh: &Arc<TriangleMesh>, frame: &Frame, rule: Rule) -> Octree {
    let solid = MeshSolid::new(mesh.clone(), FillRule::NonZero).expect("a mesh");
    build(&solid, frame, rule, &Control::threads(1)).expect("an octree")
}

fn voxelise(c: &mut Criterion) {
    let mut group = c.benchmark_group("voxelise 1024³");
    group.sample_size(20);
    for name in ["featuretype.STL", "bunny-closed.stl", "stanford-bunny.obj"] {
        let bytes = model(name);
        group.bench_function(format!("{name} read"), |b| b.iter(|| mesh(black_box(&bytes))));
        let mesh = mesh(&bytes);
        let frame = frame(&mesh);
        for rule in [Rule::Sampled, Rule::Certified] {
            group.bench_function(format!("{name} {rule:?}"), |b| b.iter(|| octree(&mesh, &frame, rule)));
        }
    }
    group.finish();
}

/// A mesh of five million triangles, as large as cells of the finest level or smaller: from the mesh in
/// memory to the octree, on one and on two threads.
fn large(c: &mut Criterion) {
    let mut group = c.benchmark_group("five million triangles, 1024³");
    group.sample_size(10);
    let mesh = Arc::new(torus(1582));
    let frame = frame(&mesh);
    let threads: &[usize] = &[1, 2];
    for rule in [Rule::Sampled, Rule::Certified] {
        for &threads in threads {
            group.bench_function(format!("{rule:?}, {threads}"), |b| {
                // Of a mesh that was never looked at.
                let fresh =
                    || TriangleMesh::new(mesh.vertices().into(), mesh.triangles().into()).expect("a mesh");
                b.iter_batched(
                    fresh,
                    |mesh| {
                        let solid = MeshSolid::new(mesh, FillRule::NonZero).expect("a mesh");
                        build(&solid, &frame, rule, &Control::threads(threads)).expect("an octree")
                    },
                    BatchSize::PerIteration,
                );
            });
        }
    }
    group.finish();
}

/// The bunny and the same moved by 10 % of its extent along x, on one lattice.
fn operands(rule: Rule) -> (Octree, Octree, Frame) {
    let still = mesh(&model("bunny-closed.stl"));
    let (min, max) = still.bounds();
    let cell = frame(&still).cell_size();
    let step = ((max[0] - min[0]) * 0.1 / cell).round() * cell;
    let moved = Arc::new(still.translated([step, 0.0, 0.0]).expect("a mesh"));
    let frame = Frame::around(min, [max[0] + step, max[1], max[2]], DEPTH).expect("a frame");
    (octree(&still, &frame, rule), octree(&moved, &frame, rule), frame)
}

fn booleans(c: &mut Criterion) {
    let mut group = c.benchmark_group("boolean 1024³");
    let control = Control::threads(1);
    for rule in [Rule::Sampled, Rule::Certified] {
        let (a, b, _) = operands(rule);
        let (a, b) = (a.view(), b.view());
        group.bench_function(format!("union {rule:?}"), |t| t.iter(|| union(a, b, &control)));
        group.bench_function(format!("intersection {rule:?}"), |t| t.iter(|| intersection(a, b, &control)));
        group.bench_function(format!("difference {rule:?}"), |t| t.iter(|| difference(a, b, &control)));
        group.bench_function(format!("xor {rule:?}"), |t| t.iter(|| xor(a, b, &control)));
    }
    group.finish();
}

/// Uniform pseudo-random points in a box (xorshift64).
fn points(min: [f64; 3], max: [f64; 3]) -> Vec<[f64; 3]> {
    let mut state = 88_172_645_463_325_252u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..POINTS).map(|_| [0, 1, 2].map(|axis| min[axis] + random() * (max[axis] - min[axis]))).collect()
}

fn queries(c: &mut Criterion) {
    let mut group = c.benchmark_group("a million points, 1024³");
    group.throughput(Throughput::Elements(POINTS as u64)).sample_size(20);
    let mesh = mesh(&model("bunny-closed.stl"));
    let (min, max) = mesh.bounds();
    let uniform = points(min, max);
    // Lines of 256 steps of one cell each in random directions.
    let frame = frame(&mesh);
    let lines: Vec<[f64; 3]> = (uniform.chunks_exact(2).take(POINTS / 256))
        .flat_map(|ends| {
            let length = (0..3).map(|i| (ends[1][i] - ends[0][i]).powi(2)).sum::<f64>().sqrt();
            let step = [0, 1, 2].map(|i| (ends[1][i] - ends[0][i]) / length * frame.cell_size());
            (0..256).map(move |k| [0, 1, 2].map(|i| ends[0][i] + k as f64 * step[i]))
        })
        .collect();
    let inside = |answers: &[Membership]| answers.iter().filter(|&&a| a == Membership::Inside).count();
    for rule in [Rule::Sampled, Rule::Certified] {
        let raw = octree(&mesh, &frame, rule);
        let coded = compact(raw.view()).expect("an octree");
        for (coding, tree) in [("raw", &raw), ("dictionary", &coded)] {
            let view = tree.view();
            let one = |points: &[[f64; 3]]| {
                points.iter().filter(|&&p| view.contains(p) == Membership::Inside).count()
            };
            let name = |what: &str| format!("{what}, {rule:?}, {coding}");
            group.bench_function(name("uniform, one by one"), |b| b.iter(|| one(black_box(&uniform))));
            let mut answers = vec![Membership::Outside; POINTS];
            group.bench_function(name("uniform, batch"), |b| {
                b.iter(|| {
                    view.contains_many(black_box(&uniform), &mut answers).expect("equal lengths");
                    inside(&answers[..1])
                })
            });
            let table = PointTable::new(view, 6).expect("a megabyte");
            group.bench_function(name("uniform, one by one, table of level 6"), |b| {
                b.iter(|| uniform.iter().filter(|&&p| table.contains(p) == Membership::Inside).count())
            });
            group.bench_function(name("along lines, cursor"), |b| {
                b.iter(|| {
                    let mut cursor = PointCursor::new(view);
                    lines.iter().filter(|&&p| cursor.contains(p) == Membership::Inside).count()
                })
            });
        }
    }
    group.finish();
}

/// Cells one after another, and their neighbours, of the bunny.
fn cells(c: &mut Criterion) {
    let mesh = mesh(&model("bunny-closed.stl"));
    let tree = octree(&mesh, &frame(&mesh), Rule::Certified);
    let view = tree.view();
    let surface: Vec<TaggedCell> = view.cells(CellFilter::tags(&[Tag::Partial])).collect();
    let leaves = CellFilter::leaves();
    let solid = CellFilter::tags(&[Tag::Full]);
    let mut group = c.benchmark_group("cells, bunny 1024³");
    group.sample_size(20);

    group.throughput(Throughput::Elements(view.cells(leaves).count() as u64));
    let mut buffer = vec![surface[0]; 4096];
    group.bench_function("leaves, 4096 at once", |b| {
        b.iter(|| {
            let mut cells = view.cells(leaves);
            while cells.fill(black_box(&mut buffer)) == buffer.len() {}
        })
    });
    group.bench_function("leaves, one by one", |b| b.iter(|| view.cells(leaves).map(black_box).count()));
    group.throughput(Throughput::Elements(view.boundary_faces(solid).count() as u64));
    group.bench_function("boundary faces", |b| b.iter(|| view.boundary_faces(solid).map(black_box).count()));

    // Cells of the surface in Morton order, all neighbours of each.
    for (name, directions) in [("6", &Direction::ALL[..6]), ("26", &Direction::ALL[..])] {
        group.throughput(Throughput::Elements((surface.len() * directions.len()) as u64));
        group.bench_function(format!("{name} neighbours of surface cells"), |b| {
            b.iter(|| {
                let mut cursor = Cursor::new(view);
                for found in &surface {
                    let _ = black_box(cursor.seek(found.cell));
                    directions.iter().for_each(|&way| {
                        black_box(cursor.neighbour(way));
                    });
                }
            })
        });
        group.bench_function(format!("{name} neighbours of surface cells, smaller ones"), |b| {
            b.iter(|| {
                let mut cursor = Cursor::new(view);
                for found in &surface {
                    let _ = black_box(cursor.seek(found.cell));
                    directions.iter().for_each(|&way| {
                        black_box(cursor.neighbours(way).count());
                    });
                }
            })
        });
    }
    // From neighbour to neighbour, in random directions.
    const STEPS: usize = 1_000_000;
    let mut state = 88_172_645_463_325_252u64;
    let ways: Vec<Direction> = (0..STEPS)
        .map(|_| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            Direction::ALL[(state >> 11) as usize % 26]
        })
        .collect();
    group.throughput(Throughput::Elements(STEPS as u64));
    group.bench_function("a walk from neighbour to neighbour", |b| {
        b.iter(|| {
            let mut cursor = Cursor::new(view);
            let _ = cursor.seek(surface[surface.len() / 2].cell);
            for &way in &ways {
                if let Some(found) = cursor.neighbour(way) {
                    let _ = black_box(cursor.seek(found.cell));
                }
            }
        })
    });
    group.finish();
}

fn files(c: &mut Criterion) {
    let mut group = c.benchmark_group("file, bunny 1024³");
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = mesh(&model("bunny-closed.stl"));
    let frame = frame(&mesh);
    for rule in [Rule::Sampled, Rule::Certified] {
        let tree = octree(&mesh, &frame, rule);
        let path = folder.path().join(format!("{rule:?}.lfl"));
        group.sample_size(20);
        group.bench_function(format!("save {rule:?}"), |b| {
            b.iter_batched(|| (), |()| file::save(&tree, &path), BatchSize::PerIteration)
        });
        let bytes = std::fs::metadata(&path).expect("the file").len();
        let nodes = tree.statistics().nodes();
        println!("{rule:?}: {bytes} bytes, {nodes} nodes, {:.3} bytes a node", bytes as f64 / nodes as f64);
        let centre = frame.origin().map(|o| o + frame.edge() / 2.0);
        // SAFETY: nobody else knows the file.
        group.bench_function(format!("map and first query {rule:?}"), |b| {
            b.iter(|| unsafe { file::map(&path) }.map(|tree| tree.contains(centre)))
        });
        group.bench_function(format!("open {rule:?}"), |b| b.iter(|| file::open(&path)));
    }
    group.finish();
}

criterion_group!(benches, voxelise, large, booleans, queries, cells, files);
criterion_main!(benches);
