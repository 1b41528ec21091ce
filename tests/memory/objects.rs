//! What objects say of the bytes that they keep, against what the allocator gave out.

use crate::allocator::left;
use leafless::mesh::MeshAttribute;
use leafless::op::DexelOptions;
use leafless::solid::Band;
use leafless::solid::{Samples, VoxelGrid};
use leafless::{Control, Csg, Frame, Rule, TriangleMesh, Volume, build, dexelize};

/// All that an object keeps but a few small structs, and no more than it keeps.
fn is_told(told: u64, kept: usize) {
    let kept = kept as u64;
    assert!(told <= kept && kept - told <= 1024 + kept / 20, "{told} of {kept}");
}

#[test]
fn meshes_tell_their_bytes() {
    let facets = |t: u32| {
        let at = |corner: u32| [f64::from(t), f64::from(corner * (t % 7 + 1)), f64::from(corner / 2)];
        [at(0), at(1), at(2)]
    };
    let (mut mesh, kept) = left(|| TriangleMesh::from_facets((0..20_000).map(facets)).unwrap());
    is_told(mesh.bytes(), kept);
    // What is found out about edges is kept, too.
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
