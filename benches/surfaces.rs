//! Speed of surface extraction.
//!
//! ```text
//! LEAFLESS_MODELS=/path/to/models cargo bench --bench surfaces
//! ```
//!
//! A ball and, with models, the closed bunny, in octrees of 256, 512 and 1024 cells per axis, on one thread
//! and two. Coplanar shrink runs on these and on machined parts, and prints the remaining counts.

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use leafless::surface::{
    Snap, VertexPlacement, coplanar_shrink, marching_cubes_solid, published_shrink, simple_marching_cubes,
};
use leafless::{
    Control, Csg, FillRule, Frame, MeshSolid, Octree, Rule, Solid, TriangleMesh, build, exchange,
    marching_cubes,
};
use std::hint::black_box;

/// A mesh from a file, if there are models.
fn model(file: &str) -> Option<MeshSolid> {
    let path = std::path::PathBuf::from(std::env::var_os("LEAFLESS_MODELS")?).join(file);
    let mesh = exchange::open_mesh(path, &exchange::MeshOptions::default()).expect("a mesh").mesh;
    Some(MeshSolid::new(mesh, FillRule::NonZero).expect("a solid"))
}

/// The closed bunny.
fn bunny() -> Option<MeshSolid> {
    model("bunny-closed.stl")
}

fn sampled<S: Solid>(solid: &S, depth: u8) -> Octree {
    let bounds = solid.bounds().expect("a bounded solid");
    let frame = Frame::around(bounds.min, bounds.max, depth).expect("a frame");
    build(solid, &frame, Rule::Sampled, &Control::default()).expect("an octree")
}

/// The solids, sampled, with names.
fn trees() -> Vec<(String, Octree)> {
    let ball = Csg::ball([0.1, 0.2, 0.3], 1.0).expect("a ball");
    let bunny = bunny();
    let mut trees = Vec::new();
    for depth in [8, 9, 10] {
        trees.push((format!("ball {}", 1 << depth), sampled(&ball, depth)));
        if let Some(bunny) = &bunny {
            trees.push((format!("bunny {}", 1 << depth), sampled(bunny, depth)));
        }
    }
    trees
}

fn extract(c: &mut Criterion) {
    let trees = trees();
    let mut group = c.benchmark_group("marching cubes");
    group.sample_size(10);
    for (name, tree) in &trees {
        let mesh = marching_cubes(tree.view(), None, &Control::threads(1)).expect("a mesh");
        println!("{name}: {} vertices, {} triangles", mesh.vertices().len(), mesh.triangles().len());
        group.throughput(Throughput::Elements(mesh.triangles().len() as u64));
        drop(mesh);
        for threads in [1, 2] {
            let control = Control::threads(threads);
            group.bench_function(format!("{name}, {threads} threads"), |b| {
                b.iter_with_large_drop(|| {
                    marching_cubes(black_box(tree.view()), None, &control).expect("a mesh")
                })
            });
        }
    }
    group.finish();
    let mut group = c.benchmark_group("simple marching cubes");
    group.sample_size(10);
    for (name, tree) in trees.iter().filter(|(name, _)| name.ends_with("512")) {
        let control = Control::threads(1);
        group.bench_function(name, |b| {
            b.iter_with_large_drop(|| {
                simple_marching_cubes(black_box(tree.view()), Snap::Fat, None, &control).expect("a mesh")
            })
        });
    }
    group.finish();
}

/// For each solid, prints the counts by simple marching cubes, by the published form of shrink and by
/// Leafless's form, and the time of the last.
fn shrink(c: &mut Criterion) {
    let tetrahedron = vec![[3.0; 3], [94.0, 3.0, 3.0], [3.0, 94.0, 3.0], [3.0, 3.0, 94.0]];
    let mesh = TriangleMesh::new(tetrahedron, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
    let solid = MeshSolid::new(mesh.expect("a mesh"), FillRule::NonZero).expect("a solid");
    let frame = Frame::new([0.0; 3], 128.0, 7).expect("a frame");
    let control = Control::threads(1);
    let mut trees =
        vec![("tetrahedron".into(), build(&solid, &frame, Rule::Sampled, &control).expect("an octree"))];
    trees.push(("ball".into(), sampled(&Csg::ball([0.1, 0.2, 0.3], 1.0).expect("a ball"), 9)));
    for file in ["plate_holes.STL", "featuretype.STL", "angle_block.STL", "fandisk.obj", "bunny-closed.stl"] {
        trees.extend(model(file).map(|solid| (file.to_owned(), sampled(&solid, 9))));
    }
    let mut group = c.benchmark_group("coplanar shrink");
    group.sample_size(10);
    for (name, tree) in &trees {
        let count = |mesh: Result<TriangleMesh, leafless::Error>| {
            let mesh = mesh.expect("a mesh");
            (mesh.vertices().len(), mesh.triangles().len(), mesh.report().expect("a report").is_closed())
        };
        let all = count(simple_marching_cubes(tree.view(), Snap::Fat, None, &control));
        let published = count(published_shrink(tree.view(), Snap::Fat, None, &control));
        let ours = count(coplanar_shrink(tree.view(), Snap::Fat, None, &control));
        println!("{name}: smc {all:?}, published {published:?}, ours {ours:?}");
        group.bench_function(name, |b| {
            b.iter_with_large_drop(|| {
                coplanar_shrink(black_box(tree.view()), Snap::Fat, None, &control).expect("a mesh")
            })
        });
    }
    group.finish();
}

/// A ball, and the bunny, with vertices on the surface, in 256 cells per axis.
fn crossings(c: &mut Criterion) {
    let mut group = c.benchmark_group("marching cubes of solids, 256");
    group.sample_size(10);
    let ball = Csg::ball([0.1, 0.2, 0.3], 1.0).expect("a ball");
    crossings_of(&mut group, "ball", &ball);
    if let Some(bunny) = bunny() {
        crossings_of(&mut group, "bunny", &bunny);
    }
    group.finish();
}

fn crossings_of<S: Solid>(group: &mut BenchmarkGroup<'_, WallTime>, name: &str, solid: &S) {
    let bounds = solid.bounds().expect("a bounded solid");
    let frame = Frame::around(bounds.min, bounds.max, 8).expect("a frame");
    for placement in [VertexPlacement::Midpoint, VertexPlacement::Crossing] {
        let control = Control::threads(1);
        group.bench_function(format!("{name}, {placement:?}"), |b| {
            b.iter_with_large_drop(|| {
                marching_cubes_solid(black_box(solid), &frame, placement, &control).expect("a mesh")
            })
        });
    }
}

criterion_group!(benches, extract, shrink, crossings);
criterion_main!(benches);
