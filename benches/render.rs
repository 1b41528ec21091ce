//! Speed of pictures, on two threads.
//!
//! ```text
//! cargo bench --bench render
//! ```

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use leafless::attribute::{Detail, FunctionAttribute, ValueRange};
use leafless::render::{
    Camera, Clip, ColourMap, Finish, Layer, MeshLayer, OctreeLayer, Shot, SolidLayer, Transfer, VolumeLayer,
    render,
};
use leafless::surface::Resolve;
use leafless::voxel::{VoxelOptions, VoxelRecords};
use leafless::{
    AnySolid, Bounds, Control, Csg, FillRule, Frame, Interval, MeshSolid, Rule, TriangleMesh, build,
    marching_cubes,
};
use std::hint::black_box;

/// Pixels on a side of the picture.
const SIDE: u32 = 1024;

/// The voxels of a block with a spherical hollow in a lattice of 256³ cells. Their values change with the
/// distance from a corner, and the voxels are as fine as the values require.
fn voxels(control: &Control<'_>) -> VoxelRecords {
    let frame = Frame::new([-1.0; 3], 2.0, 8).expect("a frame");
    let block = Csg::cuboid([-0.95; 3], [0.95; 3]).expect("a block");
    let ball = Csg::ball([0.1, 0.0, 0.2], 0.6).expect("a ball");
    let solid = block.difference(&ball).expect("a solid");
    let tree = build(&solid, &frame, Rule::Certified, control).expect("an octree");
    let value = |[x, y, z]: [f64; 3]| (x + 1.0) * (x + 1.0) + (y + 1.0) * (y + 1.0) + (z + 1.0) * (z + 1.0);
    let attribute =
        FunctionAttribute::new(1, move |p| Some([value(p), 0.0, 0.0, 0.0])).expect("an attribute");
    let attribute = attribute.with_range(move |bounds| {
        ValueRange::Within([Interval::new(value(bounds.min), value(bounds.max)).unwrap(); 4])
    });
    let cell = frame.cell_size();
    let detail =
        Detail::new(16.0 * cell, cell, 0.25, leafless::attribute::Criterion::Range).expect("a detail");
    let options = VoxelOptions::new().detail(detail);
    VoxelRecords::of(tree.view(), &options, Some(&attribute), control).expect("records")
}

fn volumes(c: &mut Criterion) {
    let control = Control::threads(2);
    let records = voxels(&control);
    let mut group = c.benchmark_group("pictures of volumes");
    group.sample_size(10).throughput(Throughput::Elements(u64::from(SIDE * SIDE)));
    let transfer = Transfer::new(ColourMap::Viridis, [0.0, 12.0], 0.1, 0.1).expect("a transfer function");
    let layer = VolumeLayer::new(records.view(), transfer);
    for (view, field_of_view) in [("parallel", None), ("perspective", Some(30.0))] {
        let bounds = Bounds::new([-1.0; 3], [1.0; 3]).expect("a box");
        let camera = Camera::fitted(&bounds.corners(), [30.0, 25.0], field_of_view, 1.0).expect("a camera");
        let shot = Shot { samples: 1, ..Shot::new(camera, [SIDE; 2]) };
        let name = format!("{} voxels of 256³ cells, {view}", records.view().len());
        group.bench_function(name, |b| {
            b.iter(|| render(black_box(&shot), &[&layer], &control).expect("a picture"))
        });
    }
    group.finish();
}

/// A part with curved and plane faces.
fn part() -> Csg {
    let block = Csg::cuboid([-0.9, -0.9, -0.4], [0.9, 0.9, 0.4]).expect("a block");
    let ball = Csg::ball([0.0, 0.0, 0.3], 0.8).expect("a ball");
    let bore = Csg::cylinder(0.3, -2.0, 2.0).expect("a bore");
    Csg::union_of([block, ball]).expect("a part").difference(&bore).expect("a part")
}

fn surfaces(c: &mut Criterion) {
    let control = Control::threads(2);
    let frame = Frame::new([-1.125; 3], 2.25, 10).expect("a frame");
    let solid = part();
    let tree = build(&solid, &frame, Rule::Certified, &control).expect("an octree");
    let mesh = marching_cubes(tree.view(), Some(Resolve::Outer), &control).expect("a mesh");
    let points = mesh.vertices();
    let camera = Camera::fitted(points, [30.0, 25.0], Some(30.0), 1.0).expect("a camera");
    let mut group = c.benchmark_group("pictures of surfaces");
    group.sample_size(10).throughput(Throughput::Elements(u64::from(SIDE * SIDE)));
    let octree = OctreeLayer::new(tree.view(), Finish::default());
    let of_solid = SolidLayer::new(&solid, &frame, Finish::default());
    let of_mesh = MeshLayer::new(&mesh);
    let triangles = format!("mesh of {} triangles", mesh.triangles().len());
    let layers: [(&str, &dyn Layer); 3] =
        [("octree of 1024³ cells", &octree), ("solid", &of_solid), (&triangles, &of_mesh)];
    for (name, layer) in layers {
        for samples in [1, 4] {
            let shot = Shot { samples, ..Shot::new(camera, [SIDE; 2]) };
            group.bench_function(format!("{name}, {samples} samples"), |b| {
                b.iter(|| render(black_box(&shot), &[layer], &control).expect("a picture"))
            });
        }
    }
    group.finish();
}

/// A mesh, and scenes made from it: the mesh alone, cut open, and with a hole.
fn scenes(c: &mut Criterion) {
    let control = Control::threads(2);
    let frame = Frame::new([-1.125; 3], 2.25, 6).expect("a frame");
    let tree = build(&part(), &frame, Rule::Certified, &control).expect("an octree");
    let mesh = marching_cubes(tree.view(), Some(Resolve::Outer), &control).expect("a mesh");
    let camera = Camera::fitted(mesh.vertices(), [30.0, 25.0], Some(30.0), 1.0).expect("a camera");
    let shot = Shot::new(camera, [SIDE; 2]);
    let clip = Clip::new().plane([0.0, 1.0, 0.0, 0.2]).expect("a clip plane");
    let cut = Shot { clip, ..shot.clone() };
    let own: TriangleMesh = mesh.try_clone().expect("a mesh");
    let alone = Csg::solid(AnySolid::new(MeshSolid::new(own, FillRule::NonZero).expect("a solid")));
    let hole = Csg::cylinder_between([0.6, -0.5, -2.0], [0.6, -0.5, 2.0], 0.2).expect("a hole");
    let bored = alone.difference(&hole).expect("a scene");
    let of_mesh = MeshLayer::new(&mesh);
    let of_scene = SolidLayer::new(&alone, &frame, Finish::default());
    let of_bored = SolidLayer::new(&bored, &frame, Finish::default());
    let mut group =
        c.benchmark_group(format!("pictures of scenes with {} triangles", mesh.triangles().len()));
    group.sample_size(10).throughput(Throughput::Elements(u64::from(SIDE * SIDE)));
    let pictures: [(&str, &Shot, &dyn Layer); 4] = [
        ("the mesh", &shot, &of_mesh),
        ("alone", &shot, &of_scene),
        ("alone, cut open", &cut, &of_scene),
        ("with a hole", &shot, &of_bored),
    ];
    for (name, shot, layer) in pictures {
        group.bench_function(name, |b| {
            b.iter(|| render(black_box(shot), &[layer], &control).expect("a picture"))
        });
    }
    group.finish();
}

criterion_group!(benches, surfaces, scenes, volumes);
criterion_main!(benches);
