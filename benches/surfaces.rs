//! Speed of surface extraction.
//!
//! ```text
//! LEAFLESS_MODELS=/path/to/models cargo bench --bench surfaces
//! ```
//!
//! A ball and, with models, the closed bunny, in octrees of 256, 512 and 1024 cells per axis. One thread and
//! two.

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use leafless::{
    Control, Csg, FillRule, Frame, MeshSolid, Octree, Rule, Snap, Solid, VertexPlacement, build, exchange,
    marching_cubes, marching_cubes_of, smc,
};
use std::hint::black_box;

/// The closed bunny, if there are models.
fn bunny() -> Option<MeshSolid> {
    let path = std::path::PathBuf::from(std::env::var_os("LEAFLESS_MODELS")?).join("bunny-closed.stl");
    let mesh = exchange::open_mesh(path, &exchange::MeshOptions::default()).expect("the bunny").mesh;
    Some(MeshSolid::new(mesh, FillRule::NonZero).expect("a solid"))
}

/// The solids, sampled, with names.
fn trees() -> Vec<(String, Octree)> {
    fn sampled<S: Solid>(solid: &S, depth: u8) -> Octree {
        let bounds = solid.bounds().expect("a bounded solid");
        let frame = Frame::around(bounds.min, bounds.max, depth).expect("a frame");
        build(solid, &frame, Rule::Sampled, &Control::default()).expect("an octree")
    }
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
            b.iter_with_large_drop(|| smc(black_box(tree.view()), Snap::Fat, None, &control).expect("a mesh"))
        });
    }
    group.finish();
}

/// A ball, and the bunny, with vertices on the surface, of 256 cells per axis.
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
                marching_cubes_of(black_box(solid), &frame, placement, &control).expect("a mesh")
            })
        });
    }
}

criterion_group!(benches, extract, crossings);
criterion_main!(benches);
