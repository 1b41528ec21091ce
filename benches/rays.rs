//! Speed of rays on stored octrees, on one thread.
//!
//! ```text
//! LEAFLESS_MODELS=/path/to/models cargo bench --bench rays
//! ```
//!
//! A million rays of a camera, in scan order, to their first hit: parallel rays and rays of a perspective
//! view, on the bunny and on the machined part at 1024³, decided at cell centres like the peers' grids. The
//! camera is that of the peers: eye at the centre of the bounding box + 2 D w, D its diagonal, w along (1,
//! 0.7, 0.5), half width D/2.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use leafless::query::{Obstacle, RayHit};
use leafless::{Control, FillRule, Frame, MeshSolid, Octree, Ray, Rule, build, compact, exchange};
use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;

const DEPTH: u8 = 10;
/// Rays on a side of the picture.
const SIDE: usize = 1024;

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

/// Returns the rays of a camera that looks at a box.
fn rays(min: Vector, max: Vector, perspective: bool) -> Vec<Ray> {
    let diagonal = [0, 1, 2].map(|axis| max[axis] - min[axis]);
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
            Ray::new(eye, unit(sum(sum(ahead, right, 0.25 * x), up, 0.25 * y)))
        } else {
            Ray::new(sum(sum(eye, right, 0.5 * size * x), up, 0.5 * size * y), ahead)
        }
    };
    pixels.map(|pixel| ray(pixel).expect("a good ray")).collect()
}

/// Returns a model decided at cell centres, and its bounding box.
fn octree(name: &str, rule: Rule) -> Option<(Octree, Vector, Vector)> {
    let Some(folder) = std::env::var_os("LEAFLESS_MODELS") else {
        eprintln!("SKIPPED {name}: LEAFLESS_MODELS is not set");
        return None;
    };
    let bytes = std::fs::read(Path::new(&folder).join(name)).expect(name);
    let file = exchange::read_mesh(&bytes, &exchange::MeshOptions::default()).expect("a mesh");
    let mesh = Arc::new(file.mesh.sewn().expect("a mesh"));
    let (min, max) = mesh.bounds();
    let frame = Frame::around(min, max, DEPTH).expect("a mesh");
    let solid = MeshSolid::new(mesh, FillRule::NonZero).expect("a mesh");
    let tree = build(&solid, &frame, rule, &Control::default()).expect("an octree");
    Some((compact(tree.view()).expect("an octree"), min, max))
}

fn first_hit(c: &mut Criterion) {
    let mut group = c.benchmark_group("rays to their first hit");
    group.sample_size(20).throughput(Throughput::Elements((SIDE * SIDE) as u64));
    for (model, rule) in [
        ("bunny-closed.stl", Rule::Sampled),
        ("featuretype.STL", Rule::Sampled),
        ("bunny-closed.stl", Rule::Certified),
    ] {
        let Some((tree, min, max)) = octree(model, rule) else { continue };
        let mut hits: Vec<Option<RayHit>> = vec![None; SIDE * SIDE];
        for (view, perspective) in [("parallel", false), ("perspective", true)] {
            let rays = rays(min, max, perspective);
            let mut cast =
                |rays: &[Ray]| tree.cast_rays(rays, Obstacle::Upper, &mut hits).expect("as many hits");
            group.bench_function(format!("{model}, {rule:?}, {view}"), |b| b.iter(|| cast(black_box(&rays))));
            eprintln!("{} of {} rays hit", hits.iter().flatten().count(), hits.len());
        }
    }
    group.finish();
}

criterion_group!(benches, first_hit);
criterion_main!(benches);
