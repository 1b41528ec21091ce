//! Speed of extended octrees, compared with plain octrees and with the expression, on one thread.
//!
//! ```text
//! cargo bench --bench extended
//! ```
//!
//! A plate of 80 × 60 × 10 with twenty bores of radius 2.5, aligned with the lattice and rotated by a
//! rational rotation. It is built, mapped and queried: one point, points anywhere in its box, rays from
//! outside to its middle, and the volume to 10^-6.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use leafless::query::Obstacle;
use leafless::{
    Affine, Control, Csg, Frame, Membership, Octree, Ray, Rule, Solid, SurfaceOptions, build, build_extended,
    cast_rays, contains, file, measure,
};
use leafless_testkit::Random;
use std::hint::black_box;

fn plate(is_turned: bool) -> Csg {
    let mut bores = Vec::new();
    for k in 0..20 {
        let to = [8.0 + 16.0 * f64::from(k % 5), 7.5 + 15.0 * f64::from(k / 5), 0.0];
        let bore = Csg::cylinder(2.5, -1.0, 11.0).unwrap();
        bores.push(bore.placed(&Affine::translation(to).unwrap()).unwrap());
    }
    let block = Csg::cuboid([0.0; 3], [80.0, 60.0, 10.0]).unwrap();
    let plate = block.difference(&Csg::union_of(bores).unwrap()).unwrap();
    // Twice 3-4-5, around z and around x.
    let turn = [[0.6, -0.64, 0.48, 0.0], [0.8, 0.48, -0.36, 0.0], [0.0, 0.6, 0.8, 0.0]];
    if is_turned { plate.placed(&Affine::new(turn).unwrap()).unwrap() } else { plate }
}

fn speed(c: &mut Criterion) {
    let control = Control::threads(1);
    for (name, is_turned) in [("plate", false), ("plate, turned", true)] {
        let csg = plate(is_turned);
        let bounds = csg.bounds().unwrap();
        let frame = Frame::around(bounds.min, bounds.max, 20).unwrap();
        let plain_frame = frame.with_depth(10).unwrap();
        let options = SurfaceOptions::default();
        let tree = build_extended(&csg, &frame, &options, &control).unwrap();
        let plain = build(&csg, &plain_frame, Rule::Certified, &control).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("part.lfl");
        file::save(&tree, &path).unwrap();
        println!(
            "{name}: {} bytes, plain {}",
            file::to_bytes(&tree).unwrap().len(),
            file::to_bytes(&plain).unwrap().len()
        );
        let mut group = c.benchmark_group(name);
        group.sample_size(20);
        group.bench_function("build", |b| {
            b.iter(|| build_extended(&csg, &frame, &options, &control).unwrap())
        });
        let mut random = Random(1);
        let mut point = || [0, 1, 2].map(|axis| random.between(bounds.min[axis], bounds.max[axis]));
        let points: Vec<_> = (0..10_000).map(|_| point()).collect();
        let rays: Vec<_> = (0..1000)
            .map(|_| {
                let to = point();
                let from = [0, 1, 2].map(|axis| to[axis] + 200.0 * (point()[axis] - to[axis]).signum());
                Ray::between(from, to).unwrap()
            })
            .collect();
        group.bench_function("map and ask a point", |b| {
            // SAFETY: nobody changes the file.
            b.iter(|| unsafe { file::map(&path) }.unwrap().contains(black_box(points[0])));
        });
        // SAFETY: nobody changes the file.
        let mapped: Octree = unsafe { file::map(&path) }.unwrap();
        group.throughput(Throughput::Elements(points.len() as u64));
        let mut answers = vec![Membership::Undecided; points.len()];
        for (of, tree) in [("mapped", &mapped), ("plain, depth 10", &plain)] {
            group.bench_function(format!("points, {of}"), |b| {
                b.iter(|| tree.contains_many(&points, &mut answers).unwrap());
            });
            let open = answers.iter().filter(|&&answer| answer == Membership::Undecided).count();
            println!("undecided: {open} of {}", points.len());
        }
        group.bench_function("points, expression", |b| {
            b.iter(|| contains(&csg, &frame, &points, &mut answers, &control).unwrap());
        });
        group.bench_function("points, tree as a solid", |b| {
            b.iter(|| contains(&mapped, &frame, &points, &mut answers, &control).unwrap());
        });
        group.throughput(Throughput::Elements(rays.len() as u64));
        let mut hits = vec![None; rays.len()];
        for (of, tree) in [("mapped", &mapped), ("plain, depth 10", &plain)] {
            group.bench_function(format!("rays, {of}"), |b| {
                b.iter(|| tree.cast_rays(&rays, Obstacle::Upper, &mut hits).unwrap());
            });
        }
        group.bench_function("rays, expression", |b| {
            b.iter(|| cast_rays(&csg, &frame, &rays, Obstacle::Upper, &control).unwrap());
        });
        group.sample_size(10);
        group.bench_function("volume to 1e-6, mapped", |b| {
            b.iter(|| measure(&mapped, &frame, 1e-6, &control).unwrap());
        });
        group.bench_function("volume to 1e-6, expression", |b| {
            b.iter(|| measure(&csg, &frame, 1e-6, &control).unwrap());
        });
        let [own, source] = [measure(&mapped, &frame, 1e-6, &control), measure(&csg, &frame, 1e-6, &control)];
        println!("splits: {} and {}", own.unwrap().splits, source.unwrap().splits);
        group.finish();
    }
}

criterion_group!(benches, speed);
criterion_main!(benches);
