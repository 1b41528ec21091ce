//! Contours of any solid.

use crate::common::model;
use crate::common::surfaces::euler_of_manifold;
use crate::common::{Random, alone};
use leafless::exchange::{MeshOptions, read_mesh};
use leafless::solid::{Band, VoxelGrid};
use leafless::surface::{boundary, contour};
use leafless::{
    Affine, AnySolid, Control, Csg, Error, FillRule, Frame, MeshSolid, Rule, Solid, TriangleMesh, Volume,
    build, deviation,
};

fn turn() -> Affine {
    Affine::new([[0.36, 0.48, -0.8, 1.0], [-0.8, 0.6, 0.0, 2.0], [0.48, 0.64, 0.6, 3.0]]).unwrap()
}

/// The exact faces of a solid, as a mesh of which nothing else is known.
fn meshed(solid: &Csg, tolerance: f64) -> MeshSolid {
    let bounds = solid.bounds().unwrap();
    let frame = Frame::around(bounds.min, bounds.max, 14).unwrap();
    let mesh = boundary(solid, &frame, tolerance, &alone()).unwrap().into_mesh();
    MeshSolid::new(mesh, FillRule::NonZero).unwrap()
}

fn frame_of(mesh: &TriangleMesh, depth: u8) -> Frame {
    let (low, high) = mesh.bounds();
    Frame::around(low, high, depth).unwrap()
}

/// A block with a pocket, turned: few triangles, vertices in its corners, and what is proven of the deviation.
#[test]
fn sharp_edges_of_meshes_stay() {
    let pocket = Csg::cuboid([2.0, 2.0, 3.0], [6.0, 4.0, 9.0]).unwrap();
    let block = Csg::cuboid([0.0; 3], [9.0, 7.0, 5.0]).unwrap().difference(&pocket).unwrap();
    let solid = meshed(&block.placed(&turn()).unwrap(), 0.01);
    let (frame, tolerance) = (frame_of(solid.mesh(), 10), 0.02);
    let found = contour(&solid, &frame, tolerance, &alone()).unwrap();
    assert_eq!((euler_of_manifold(found.mesh()), found.report().intersecting_pairs), (2, 0));
    assert_eq!(found.report().undecided, 0);
    let count = found.mesh().triangles().len();
    assert!(count < 12_000, "{count}");
    for corner in solid.mesh().vertices() {
        let away = |v: &[f64; 3]| (0..3).map(|k| (v[k] - corner[k]).abs()).fold(0.0, f64::max);
        let least = found.mesh().vertices().iter().map(away).fold(f64::INFINITY, f64::min);
        assert!(least < 2.0 * tolerance, "{corner:?} {least:e}");
    }
    let other = MeshSolid::new(found.into_mesh(), FillRule::NonZero).unwrap();
    let found = deviation(&solid, &other, &frame, 0.2 * tolerance, &alone()).unwrap();
    assert!(found.distance().upper <= 4.0 * tolerance, "{found:?}");
}

/// Expressions, expressions with meshes in them, volumes and stored octrees: closed manifolds of about the right volume.
#[test]
fn solids_of_all_kinds() {
    let ball = Csg::ball([0.5, 0.25, 0.0], 4.0).unwrap();
    let volume = 4.0 / 3.0 * std::f64::consts::PI * 64.0;
    let frame = Frame::new([-8.0; 3], 16.0, 8).unwrap();
    let tree = build(&ball, &frame.with_depth(6).unwrap(), Rule::Sampled, &alone()).unwrap();
    let side = 32u32;
    let samples: Vec<f32> = (0..side.pow(3))
        .map(|i| {
            let p = [i % side, i / side % side, i / side / side].map(|c| c as f32 * 0.5 - 7.75);
            4.0 - ((p[0] - 0.5).powi(2) + (p[1] - 0.25).powi(2) + p[2].powi(2)).sqrt()
        })
        .collect();
    let grid = VoxelGrid::new([side; 3], [-8.0; 3], [0.5; 3]).unwrap();
    let field = Volume::new(samples.into(), &grid, Band::at_least(0.0).unwrap(), &alone()).unwrap();
    let solids: [(&str, AnySolid); 4] = [
        ("expression", AnySolid::new(ball.clone())),
        ("mesh", AnySolid::new(meshed(&ball, 0.01))),
        ("volume", AnySolid::new(field)),
        ("octree", AnySolid::new(tree)),
    ];
    for (name, solid) in solids {
        let found = contour(&solid, &frame, 0.1, &alone()).unwrap();
        assert_eq!(euler_of_manifold(found.mesh()), 2, "{name}");
        let off = (found.mesh().volume() - volume).abs() / volume;
        assert!(off < 0.06, "{name}: {off}");
    }
}

/// Random expressions of meshes: manifolds, whatever they look like.
#[test]
fn random_scenes_give_manifolds() {
    let mut random = Random(11);
    for _ in 0..6 {
        let mut place = || {
            let shift = [0, 1, 2].map(|_| random.between(-3.0, 3.0));
            let [a, b, c] = [[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]];
            let row = |r: [f64; 3], s: f64| [r[0], r[1], r[2], s];
            Affine::new([row(a, shift[0]), row(b, shift[1]), row(c, shift[2])]).unwrap()
        };
        let part = |csg: Csg, at: &Affine| meshed(&csg.placed(at).unwrap(), 0.05);
        let one = part(Csg::cuboid([-2.0; 3], [2.0; 3]).unwrap(), &place());
        let other = part(Csg::cylinder(1.5, -3.0, 3.0).unwrap(), &place());
        let third = part(Csg::ball([0.0; 3], 2.0).unwrap(), &place());
        let solid =
            Csg::union_of([Csg::solid(AnySolid::new(one)), Csg::solid(AnySolid::new(other))]).unwrap();
        let solid = solid.difference(&Csg::solid(AnySolid::new(third))).unwrap();
        let frame = Frame::new([-10.0; 3], 20.0, 8).unwrap();
        let found = contour(&solid, &frame, 0.2, &alone()).unwrap();
        euler_of_manifold(found.mesh());
        assert!(found.mesh().volume() > 1.0);
    }
}

#[test]
fn nothing_and_what_is_refused() {
    let cube = Csg::cuboid([0.0; 3], [1.0; 3]).unwrap();
    let nothing = cube.difference(&cube).unwrap();
    let frame = Frame::new([-1.0; 3], 4.0, 6).unwrap();
    assert!(contour(&nothing, &frame, 0.1, &alone()).unwrap().mesh().triangles().is_empty());
    // A box in planes of the lattice.
    let found = contour(&cube, &frame, 0.01, &alone()).unwrap();
    assert_eq!(euler_of_manifold(found.mesh()), 2);
    let cut = Frame::new([0.5; 3], 4.0, 6).unwrap();
    assert!(matches!(contour(&cube, &cut, 0.1, &alone()), Err(Error::Argument { name: "frame", .. })));
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = contour(&cube, &frame, tolerance, &alone());
        assert!(matches!(refused, Err(Error::Argument { name: "tolerance", .. })));
    }
    let control = Control { max_nodes: Some(3), ..alone() };
    assert!(matches!(contour(&cube, &frame, 0.1, &control), Err(Error::Limit { .. })));
    // With its splits spent the mesh is coarse, and still a manifold.
    for splits in [0, 1, 10, 100] {
        let control = Control { max_splits: Some(splits), ..alone() };
        let found = contour(&cube, &frame, 0.01, &control).unwrap();
        assert!(found.report().splits <= splits);
        euler_of_manifold(found.mesh());
    }
}

/// Real parts.
#[test]
fn models() {
    for (name, share, most) in [("fandisk.obj", 1e-3, 6_000), ("featuretype.STL", 1e-3, 20_000)] {
        let Some(path) = model(name) else { return };
        let bytes = std::fs::read(path).unwrap();
        let mesh = read_mesh(&bytes, &MeshOptions::default()).unwrap().mesh.sewn().unwrap();
        let frame = frame_of(&mesh, 12);
        let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
        let found = contour(&solid, &frame, share * frame.edge(), &alone()).unwrap();
        euler_of_manifold(found.mesh());
        let count = found.mesh().triangles().len();
        assert!(count <= most && found.report().intersecting_pairs == 0, "{name}: {count}");
    }
}
