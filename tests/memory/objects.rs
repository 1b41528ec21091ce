//! The bytes that objects report as kept, against the bytes that the allocator handed out.

use crate::allocator::left;
use leafless::attribute::{
    Attribute, FillOptions, FunctionAttribute, ScalarType, SurfaceAttribute, ValueType, VolumeAttribute,
    fill_channel,
};
use leafless::mesh::MeshAttribute;
use leafless::op::{DexelOptions, Zone};
use leafless::solid::{Band, Prepared, Samples, VoxelGrid};
use leafless::{
    AnySolid, Control, Csg, FillRule, Frame, LazyOctree, MeshSolid, Rule, Solid, TriangleMesh, Volume, build,
    dexelize,
};
use std::sync::Arc;

/// Checks that an object reports all bytes that it keeps but for a few small structs, and no more.
fn is_told(told: u64, kept: usize) {
    let kept = kept as u64;
    assert!(told <= kept && kept - told <= 1024 + kept / 20, "{told} of {kept}");
}

/// 20 000 triangles that share their edges.
fn sheet() -> TriangleMesh {
    let height = |x: u32, y: u32| f64::from((x * 7 + y * 13) % 5) / 500.0;
    let vertex =
        |i: u32| [f64::from(i % 101) / 60.0 - 0.8, f64::from(i / 101) / 60.0 - 0.8, height(i % 101, i / 101)];
    let square = |i: u32| {
        let at = i / 100 * 101 + i % 100;
        [[at, at + 1, at + 102], [at, at + 102, at + 101]]
    };
    TriangleMesh::new((0..101 * 101).map(vertex).collect(), (0..10_000).flat_map(square).collect()).unwrap()
}

#[test]
fn meshes_tell_their_bytes() {
    let facets = |t: u32| {
        let at = |corner: u32| [f64::from(t), f64::from(corner * (t % 7 + 1)), f64::from(corner / 2)];
        [at(0), at(1), at(2)]
    };
    let (mut mesh, kept) = left(|| TriangleMesh::from_facets((0..20_000).map(facets)).unwrap());
    is_told(mesh.bytes(), kept);
    // The edges found for the report are kept, too.
    let ((), found) = left(|| drop(mesh.report()));
    is_told(mesh.bytes(), kept + found);
    assert!(found > 100_000, "{found}");
    let values = (0..20_000).map(f64::from).collect::<Vec<_>>();
    let ((), more) =
        left(|| mesh.add_attribute(MeshAttribute::per_triangle("number", 1, &values).unwrap()).unwrap());
    is_told(mesh.bytes(), kept + found + more);
}

#[test]
fn octrees_and_tri_dexel_models_tell_their_bytes() {
    let frame = Frame::new([-1.0; 3], 2.0, 7).unwrap();
    let ball = Csg::ball([0.0; 3], 0.75).unwrap();
    let control = Control::threads(1);
    let (octree, kept) = left(|| build(&ball, &frame, Rule::Certified, &control).unwrap());
    is_told(octree.bytes(), kept);
    let (model, kept) = left(|| dexelize(&ball, &frame, &DexelOptions::default(), &control).unwrap());
    is_told(model.view().bytes(), kept);
}

#[test]
fn volumes_tell_their_bytes() {
    let grid = VoxelGrid::new([64; 3], [0.0; 3], [1.0; 3]).unwrap();
    let (samples, kept) =
        left(|| Samples::from((0..64_u32.pow(3)).map(|i| (i % 251) as u8).collect::<Vec<_>>()));
    is_told(samples.bytes() as u64, kept);
    let control = Control::threads(1);
    let (volume, kept) =
        left(|| Volume::new(samples.clone(), &grid, Band::at_least(100.0).unwrap(), &control).unwrap());
    is_told(volume.bytes() as u64, kept);
}

fn ball(i: u32) -> Csg {
    let at = |k: u32| f64::from(i / 12_u32.pow(k) % 12) / 6.0 - 0.9;
    Csg::ball([at(0), at(1), at(2)], 0.05 + f64::from(i) * 1e-5).unwrap()
}

/// As [`is_told`] for expressions. The spare capacity of their exact numbers is unknown.
fn is_about(told: u64, kept: usize) {
    let kept = kept as u64;
    assert!(told <= kept && kept - told <= kept / 4, "{told} of {kept}");
}

#[test]
fn solids_tell_their_bytes() {
    let frame = Frame::new([-1.0; 3], 2.0, 7).unwrap();
    let control = Control::threads(1);
    let mesh = Arc::new(sheet());
    let bytes = mesh.bytes();
    let (solid, kept) = left(|| MeshSolid::new(mesh.clone(), FillRule::NonZero).unwrap());
    // The mesh is shared. The edges found for it are kept there.
    is_told(solid.kept_bytes() - bytes, kept);
    let solid = Prepared::new(AnySolid::new(solid));
    let before = solid.kept_bytes();
    let (_, kept) = left(|| drop(solid.on(&frame, &control).unwrap()));
    is_told(solid.kept_bytes() - before, kept);
    assert!(kept > 100_000, "{kept}");

    let (balls, kept) = left(|| Csg::union_of((0..1500).map(ball)).unwrap());
    is_about(balls.kept_bytes(), kept);
    // A part that occurs twice counts once.
    let twice = Csg::union_of([balls.clone(), balls.complement()]).unwrap();
    assert!(twice.kept_bytes() - balls.kept_bytes() < 2000);
    let prepared = Prepared::new(AnySolid::new(balls));
    let before = prepared.kept_bytes();
    let (_, kept) = left(|| drop(prepared.on(&frame, &control).unwrap()));
    is_about(prepared.kept_bytes() - before, kept);

    let octree = build(&Csg::ball([0.0; 3], 0.75).unwrap(), &frame, Rule::Certified, &control).unwrap();
    let bytes = octree.bytes();
    assert_eq!(Solid::kept_bytes(&AnySolid::new(octree)), bytes);
}

#[test]
fn lazy_octrees_and_channels_tell_their_bytes() {
    let frame = Frame::new([-1.0; 3], 2.0, 7).unwrap();
    let control = Control::threads(1);
    let mut lazy = LazyOctree::new(Csg::ball([0.0; 3], 0.75).unwrap(), &frame).unwrap();
    let before = lazy.bytes();
    let everywhere = Zone::Box { min: [-1.0; 3], max: [1.0; 3] };
    let (_, kept) = left(|| lazy.refine(&everywhere, 7, &control).unwrap());
    // The array of split cells may have spare capacity for as many cells again.
    let told = lazy.bytes() - before;
    assert!(told > 100_000 && (told..=2 * told + 4096).contains(&(kept as u64)), "{told} of {kept}");

    let step = |[x, y, _]: [f64; 3]| Some([(x * 40.0 + y * 7.0).floor(), 0.0, 0.0, 0.0]);
    let steps = FunctionAttribute::new(1, step).unwrap();
    let value_type = ValueType::new(ScalarType::F32, 1).unwrap();
    let options = FillOptions { value_type, frame, solid: None, detail: None };
    let (channel, kept) = left(|| fill_channel(&steps, &options, &control).unwrap());
    is_told(channel.bytes(), kept);
    assert_eq!(Attribute::kept_bytes(&channel), channel.bytes());
}

#[test]
fn attributes_tell_their_bytes() {
    let mesh = Arc::new(sheet());
    let values = (0..20_000).map(f64::from).collect::<Vec<_>>();
    let number = || MeshAttribute::per_triangle("number", 1, &values).unwrap();
    // (The mesh keeps the tree of its triangles.)
    let before = mesh.bytes();
    let (attribute, kept) = left(|| SurfaceAttribute::new(mesh.clone(), number()).unwrap());
    is_told(attribute.kept_bytes() - before, kept);

    let grid = VoxelGrid::new([64; 3], [0.0; 3], [1.0; 3]).unwrap();
    let control = Control::threads(1);
    let (attribute, kept) = left(|| {
        let samples = Samples::from((0..64_u32.pow(3)).map(|i| (i % 251) as u8).collect::<Vec<_>>());
        let volume = Volume::new(samples, &grid, Band::at_least(100.0).unwrap(), &control).unwrap();
        VolumeAttribute::new(volume, Default::default())
    });
    is_told(attribute.kept_bytes(), kept);
}
