//! Contours of any solid.

use leafless::exchange::{MeshOptions, read_mesh};
use leafless::solid::{Band, VoxelGrid};
use leafless::surface::{boundary, contour};
use leafless::{
    Affine, AnySolid, Callback, Control, Csg, Error, FillRule, Frame, MeshSolid, Rule, Solid, Tag,
    TriangleMesh, Verdict, Volume, build, deviation,
};
use leafless_testkit::surfaces::euler_of_manifold;
use leafless_testkit::{Random, alone, model, repeated};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};

fn turn() -> Affine {
    Affine::new([[0.36, 0.48, -0.8, 1.0], [-0.8, 0.6, 0.0, 2.0], [0.48, 0.64, 0.6, 3.0]]).unwrap()
}

/// The exact faces of a solid, as a plain mesh.
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

/// A rotated block with a pocket: few triangles, vertices in its corners, and the proven deviation.
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
    // The proven deviation is the result of a separate search, up to a sixteenth of the tolerance, and within
    // the tolerance.
    let proven = found.report().deviation;
    let other = MeshSolid::new(found.into_mesh(), FillRule::NonZero).unwrap();
    let found = deviation(&solid, &other, &frame, 1e-3 * tolerance, &alone()).unwrap().distance();
    assert!(found.lower <= proven && proven <= found.upper + 0.07 * tolerance, "{found:?} {proven}");
    assert!(proven <= tolerance, "{proven}");
}

/// For balls as solids of all kinds, the true deviation is known at each vertex and each triangle's middle.
/// It never exceeds the proven deviation.
#[test]
fn what_is_proven_is_not_contradicted() {
    let (centre, radius, tolerance) = ([0.5, 0.25, 0.0], 4.0, 0.1);
    let ball = Csg::ball(centre, radius).unwrap();
    let frame = Frame::new([-8.0; 3], 16.0, 8).unwrap();
    let away = move |p: [f64; 3]| (0..3).map(|k| (p[k] - centre[k]).powi(2)).sum::<f64>().sqrt() - radius;
    let host = Callback::new(move |min: [f64; 3], max: [f64; 3]| {
        let middle = [0, 1, 2].map(|k| 0.5 * (min[k] + max[k]));
        let reach = (0..3).map(|k| (max[k] - middle[k]).powi(2)).sum::<f64>().sqrt() * (1.0 + 1e-9) + 1e-9;
        let height = away(middle);
        Ok(match height.abs() > reach {
            true if height > 0.0 => Verdict::Empty,
            true => Verdict::Full,
            false => Verdict::Partial(()),
        })
    });
    let host = host.with_contains(move |point| Ok(away(point) < 0.0)).with_exterior(Tag::Empty);
    let tree = build(&ball, &frame.with_depth(4).unwrap(), Rule::Certified, &alone()).unwrap();
    // Expected deviations: slabs describe an expression well; for other solids, cells are about as good as
    // they are large.
    let solids: [(&str, AnySolid, f64); 4] = [
        ("expression", AnySolid::new(ball.clone()), 1.5 * tolerance),
        (
            "expression with a mesh",
            AnySolid::new(Csg::solid(AnySolid::new(meshed(&ball, 1e-3)))),
            1.5 * tolerance,
        ),
        ("host", AnySolid::new(host), 3.0),
        // (An undecided cell of a stored octree need not hold any of the boundary.)
        ("octree", AnySolid::new(tree), f64::INFINITY),
    ];
    for (name, solid, most) in solids {
        let found = contour(&solid, &frame, tolerance, &alone()).unwrap();
        let (mesh, proven) = (found.mesh(), found.report().deviation);
        assert!(proven <= most, "{name}: {proven}");
        let points = mesh.triangles().iter().flat_map(|triangle| {
            let [a, b, c] = triangle.map(|v| mesh.vertices()[v as usize]);
            [a, [0, 1, 2].map(|k| (a[k] + b[k] + c[k]) / 3.0)]
        });
        let true_one = points.map(|point| away(point).abs()).fold(0.0, f64::max);
        // (The mesh in the expression is a thousandth away from the ball.)
        assert!(true_one <= proven + 2e-3, "{name}: {true_one} {proven}");
    }
    // An octree of samples proves nothing.
    let tree = build(&ball, &frame.with_depth(4).unwrap(), Rule::Sampled, &alone()).unwrap();
    let found = contour(&tree, &frame, tolerance, &alone()).unwrap();
    assert_eq!(found.report().deviation, f64::INFINITY);
}

/// Hosts whose functions return NaN, give different answers for one place, or end in the middle. The result
/// is a closed manifold, or the host's error.
#[test]
fn hosts_that_contradict_themselves() {
    let frame = Frame::new([-8.0; 3], 16.0, 5).unwrap();
    let control = Control { max_nodes: Some(300), ..alone() };
    let hash = |seed: u64, point: [f64; 3]| {
        Random(point.iter().fold(seed, |sum, c| (sum ^ c.to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15)))
            .bits()
    };
    for seed in (0..4u64).step_by(repeated(2, 1)) {
        let host = Callback::new(move |min: [f64; 3], max: [f64; 3]| {
            Ok(match hash(seed, min) ^ hash(seed + 1, max) {
                // Cells within a full one may be empty.
                die if die % 256 < 8 * (seed % 4) => [Verdict::Full, Verdict::Empty][die as usize >> 9 & 1],
                _ => Verdict::Partial(()),
            })
        });
        let share = [1, 64, 128, 255][seed as usize % 4];
        let host = host.with_contains(move |point| Ok(hash(seed + 2, point) % 256 < share));
        let host = host.with_distance(move |points, found| {
            for (point, found) in points.iter().zip(found) {
                *found = match hash(seed + 3, *point) % 8 {
                    0 => f64::NAN,
                    1 => f64::INFINITY,
                    2 => f64::NEG_INFINITY,
                    3 => -0.5,
                    4 => 0.5,
                    _ => 0.0,
                };
            }
            Ok(())
        });
        match contour(&host.with_exterior(Tag::Empty), &frame, 0.2, &control) {
            Ok(found) => _ = euler_of_manifold(found.mesh()),
            Err(error) => assert!(matches!(error, Error::Limit { .. }), "{seed}: {error}"),
        }
    }
    // All is full up to the universe's faces, which have no other side; and all is empty.
    for verdict in [Verdict::Full, Verdict::Empty] {
        let host = Callback::new(move |_, _| Ok(verdict)).with_exterior(Tag::Empty);
        let found = contour(&host, &frame, 0.2, &control).unwrap();
        assert!(found.mesh().triangles().is_empty());
        let is_empty = matches!(verdict, Verdict::Empty);
        assert_eq!(found.report().deviation, if is_empty { 0.0 } else { f64::INFINITY });
    }
    // Points without a decision count as outside.
    let host = Callback::new(|_, _| Ok(Verdict::Partial(()))).with_exterior(Tag::Empty);
    let found = contour(&host, &frame, 0.2, &control);
    assert!(
        matches!(found, Err(Error::Limit { .. })) || found.is_ok_and(|found| found.report().undecided > 0)
    );
    // An error in the middle is returned.
    let count = AtomicU64::new(0);
    let host = Callback::new(|_, _| match count.fetch_add(1, Relaxed) {
        500.. => Err(Error::Callback { code: 7 }),
        _ => Ok(Verdict::Partial(())),
    });
    let refused = contour(&host.with_exterior(Tag::Empty), &frame, 0.2, &control);
    assert!(matches!(refused, Err(Error::Callback { code: 7 })));
    // A cancel.
    let cancel = AtomicBool::new(true);
    let control = Control { cancel: Some(&cancel), ..alone() };
    let cube = Csg::cuboid([0.0; 3], [1.0; 3]).unwrap();
    assert!(matches!(contour(&cube, &frame, 0.1, &control), Err(Error::Cancelled)));
}

/// Expressions, expressions that contain meshes, volumes and stored octrees: closed manifolds of about the
/// right volume.
#[test]
fn solids_of_all_kinds() {
    let ball = Csg::ball([0.5, 0.25, 0.0], 4.0).unwrap();
    let volume = 4.0 / 3.0 * std::f64::consts::PI * 64.0;
    let frame = Frame::new([-8.0; 3], 16.0, 8).unwrap();
    let tree = build(&ball, &frame.with_depth(5).unwrap(), Rule::Sampled, &alone()).unwrap();
    let side = 16u32;
    let samples: Vec<f32> = (0..side.pow(3))
        .map(|i| {
            let p = [i % side, i / side % side, i / side / side].map(|c| c as f32 - 7.5);
            4.0 - ((p[0] - 0.5).powi(2) + (p[1] - 0.25).powi(2) + p[2].powi(2)).sqrt()
        })
        .collect();
    let grid = VoxelGrid::new([side; 3], [-8.0; 3], [1.0; 3]).unwrap();
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

/// Random expressions of meshes always give manifolds.
#[test]
fn random_scenes_give_manifolds() {
    let mut random = Random(11);
    for _ in 0..repeated(2, 6) {
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
    // Without remaining splits, the mesh is coarse, and still a manifold.
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
