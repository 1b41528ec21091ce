//! Speed of voxel records on one thread: a million records of a ball with a colour, in 512 cells along an
//! axis.
//!
//! ```text
//! cargo bench --bench records
//! ```

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use leafless::attribute::FunctionAttribute;
use leafless::voxel::{Symmetry, Viewpoint, VoxelKind, VoxelOptions, VoxelRecords, VoxelRecordsRef, Voxels};
use leafless::{Affine, Cell, Control, Csg, Frame, Rule, Tag, build, marching_cubes};
use std::hint::black_box;

fn mixed(mut x: u64) -> u64 {
    x = (x ^ x >> 31).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    (x ^ x >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 16
}

fn records(c: &mut Criterion) {
    let control = Control::threads(1);
    let frame = Frame::new([-1.0; 3], 2.0, 9).expect("a frame");
    let ball = Csg::ball([0.0; 3], 0.74).expect("a ball");
    let tree = build(&ball, &frame, Rule::Certified, &control).expect("an octree");
    let options = VoxelOptions::new().outside(true);
    let colour = FunctionAttribute::new(4, |p: [f64; 3]| Some([p[0], p[1], p[2], 1.0])).expect("a colour");
    let records = VoxelRecords::of(tree.view(), &options, Some(&colour), &control).expect("records");
    let view = records.view();
    let count = view.len();
    println!(
        "{count} records, {} of them boundary, {} bytes each",
        view.count(VoxelKind::Boundary),
        records.bytes_each()
    );
    let mut group = c.benchmark_group("voxel records");
    group.sample_size(10).throughput(Throughput::Elements(count as u64));

    let count_only = || Voxels::new(tree.view(), &options, None).expect("voxels").count_records();
    group.bench_function("counted", |b| b.iter(|| count_only().expect("a count")));
    let list = |values: bool| {
        let attribute: Option<&dyn leafless::attribute::Attribute> =
            if values { Some(&colour) } else { None };
        VoxelRecords::of(tree.view(), &options, attribute, &control).expect("records")
    };
    group.bench_function("listed", |b| b.iter(|| list(false)));
    group.bench_function("listed with colours", |b| b.iter(|| list(true)));
    let checked = || {
        VoxelRecordsRef::new(view.frame(), view.codes(), view.levels(), view.kinds(), 4, view.values())
            .expect("records")
            .len()
    };
    group.bench_function("checked", |b| b.iter(checked));

    let cells: Vec<Cell> = view.iter().map(|record| record.cell).collect();
    let places: Vec<usize> = (0..count).map(|i| (mixed(i as u64 + 1) % count as u64) as usize).collect();
    group.bench_function("found, at random", |b| {
        b.iter(|| places.iter().filter(|&&i| view.find(black_box(cells[i])) == Some(i)).count())
    });
    let unit = |x: u64| (mixed(x) % (1 << 20)) as f64 / (1 << 19) as f64 - 1.0;
    let points: Vec<[f64; 3]> = (0..count as u64).map(|i| [3 * i, 3 * i + 1, 3 * i + 2].map(unit)).collect();
    group.bench_function("at random points", |b| {
        b.iter(|| points.iter().filter(|&&point| view.at(black_box(point)).is_some()).count())
    });

    let turn = Symmetry::new([1, 2, 0], [true, false, true]).expect("a symmetry");
    group.bench_function("turned", |b| b.iter(|| view.turned(turn, &control).expect("records")));
    for (name, from) in [
        ("depth order, parallel", Viewpoint::Parallel([-0.3, 0.5, -0.8])),
        ("depth order, perspective", Viewpoint::Perspective([0.2, -0.3, 3.0])),
        ("depth order, eye inside", Viewpoint::Perspective([0.2, -0.3, 0.1])),
    ] {
        group.bench_function(name, |b| b.iter(|| view.depth_order(&from, &control).expect("an order")));
    }
    group.bench_function("back to an octree", |b| {
        b.iter(|| view.to_octree(Tag::Partial, &control).expect("an octree"))
    });
    let rows = [[0.96, -0.28, 0.0, 0.1], [0.28, 0.96, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    let turned = Affine::new(rows).expect("a map");
    let coarse = frame.with_depth(7).expect("a frame");
    group.bench_function("by centres, 128 cells an axis", |b| {
        b.iter(|| view.placed_by_centres(&turned, &coarse, &control).expect("records"))
    });
    let sampled = build(&ball, &frame, Rule::Sampled, &control).expect("an octree");
    let mesh = marching_cubes(sampled.view(), None, &control).expect("a mesh");
    println!("{} triangles", mesh.triangles().len());
    let of_mesh = || view.triangles(&mesh, &control).expect("triangles").triangles().len();
    println!("{} triangles in boundary voxels", of_mesh());
    group.bench_function("triangles of boundary voxels", |b| b.iter(of_mesh));
    group.finish();
}

criterion_group!(benches, records);
criterion_main!(benches);
