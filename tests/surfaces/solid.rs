//! Surfaces of solids other than octrees: samples at corners, vertices on the surface.

use leafless::solid::{Ask, Segment};
use leafless::surface::{VertexPlacement, marching_cubes_solid};
use leafless::{
    Affine, AnySolid, Callback, Cell, Classifier, Control, Csg, Error, FillRule, Frame, MeshSolid, Rule,
    Solid, TriangleMesh, Verdict, Worker, build, exchange,
};
use leafless_testkit::surfaces::{assert_balanced, components, euler_of_manifold};
use leafless_testkit::{Random, alone, lattice_frame, model};

fn crossings<S: Solid>(solid: &S, frame: &Frame) -> TriangleMesh {
    marching_cubes_solid(solid, frame, VertexPlacement::Crossing, &alone()).unwrap()
}

/// Vertices of a ball lie on the ball, and area and volume converge to second order.
#[test]
fn balls_of_second_order() {
    let (centre, radius) = ([0.03, -0.02, 0.01], 0.8);
    let ball = Csg::ball(centre, radius).unwrap();
    let (volume, whole) =
        (4.0 / 3.0 * std::f64::consts::PI * radius.powi(3), 4.0 * std::f64::consts::PI * radius * radius);
    let mut before: Option<[f64; 2]> = None;
    for depth in 4..=7 {
        let mesh = crossings(&ball, &Frame::new([-1.0; 3], 2.0, depth).unwrap());
        assert_eq!(euler_of_manifold(&mesh), 2);
        for vertex in mesh.vertices() {
            let square: f64 = (0..3).map(|k| (vertex[k] - centre[k]).powi(2)).sum();
            assert!((square.sqrt() - radius).abs() < 1e-11, "{vertex:?}: {:e}", square.sqrt() - radius);
        }
        let errors = [(mesh.volume() - volume).abs() / volume, (mesh.area() - whole).abs() / whole];
        if let Some(before) = before {
            for (now, before) in errors.into_iter().zip(before) {
                assert!(now < before / 3.2, "depth {depth}: {now:e} after {before:e}");
            }
        }
        before = Some(errors);
    }
}

/// Boxes whose faces lie on the lattice, and boxes turned by an angle.
#[test]
fn boxes() {
    let frame = Frame::new([0.0; 3], 16.0, 4).unwrap();
    let block = Csg::cuboid([2.0, 3.0, 4.0], [9.0, 8.0, 12.0]).unwrap();
    let mesh = crossings(&block, &frame);
    assert_eq!(mesh.bounds(), ([2.0, 3.0, 4.0], [9.0, 8.0, 12.0]));
    assert_eq!(euler_of_manifold(&mesh), 2);
    assert!((mesh.volume() - 7.0 * 5.0 * 8.0).abs() < 7.0 * 3.0 * 8.0, "{}", mesh.volume());
    // Rotated about z, and moved.
    let (sin, cos) = 0.7f64.sin_cos();
    let turn = [[cos, -sin, 0.0, 5.0], [sin, cos, 0.0, -1.0], [0.0, 0.0, 1.0, 0.1]];
    let turned = block.placed(&Affine::new(turn).unwrap()).unwrap();
    let mesh = crossings(&turned, &frame);
    assert_eq!(euler_of_manifold(&mesh), 2);
    for [x, y, z] in mesh.vertices() {
        let (x, y, z) = (x - 5.0, y + 1.0, z - 0.1);
        let at = [cos * x + sin * y, cos * y - sin * x, z];
        let beyond: [f64; 3] = [0, 1, 2].map(|k| {
            let (low, high) = ([2.0, 3.0, 4.0][k], [9.0, 8.0, 12.0][k]);
            f64::max(low - at[k], at[k] - high)
        });
        assert!(beyond.into_iter().fold(f64::NEG_INFINITY, f64::max).abs() < 1e-12, "{beyond:?}");
    }
}

/// Returns the distance of a point from a mesh. Every vertex of a solid's surface lies on the solid's mesh.
fn distance_to(mesh: &TriangleMesh, p: [f64; 3]) -> f64 {
    let minus = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let mut least = f64::INFINITY;
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|v| mesh.vertices()[v as usize]);
        // Ericson, Real-Time Collision Detection, 5.1.5.
        let (ab, ac, ap) = (minus(b, a), minus(c, a), minus(p, a));
        let (d1, d2) = (dot(ab, ap), dot(ac, ap));
        let bp = minus(p, b);
        let (d3, d4) = (dot(ab, bp), dot(ac, bp));
        let cp = minus(p, c);
        let (d5, d6) = (dot(ab, cp), dot(ac, cp));
        let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
        let (v, w) = if d1 <= 0.0 && d2 <= 0.0 {
            (0.0, 0.0)
        } else if d3 >= 0.0 && d4 <= d3 {
            (1.0, 0.0)
        } else if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            (d1 / (d1 - d3), 0.0)
        } else if d6 >= 0.0 && d5 <= d6 {
            (0.0, 1.0)
        } else if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            (0.0, d2 / (d2 - d6))
        } else if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
            let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
            (1.0 - w, w)
        } else {
            let all = va + vb + vc;
            (vb / all, vc / all)
        };
        let near = [0, 1, 2].map(|k| a[k] + v * ab[k] + w * ac[k]);
        let apart = minus(p, near);
        least = least.min(dot(apart, apart));
    }
    least.sqrt()
}

/// A tetrahedron with a fourth corner pulled out of one face.
fn bumped() -> MeshSolid {
    let corners =
        vec![[0.1, 0.2, 0.3], [0.9, 0.25, 0.2], [0.3, 0.8, 0.1], [0.4, 0.35, 0.85], [0.75, 0.7, 0.6]];
    let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 4], [2, 3, 4], [3, 1, 4]];
    MeshSolid::new(TriangleMesh::new(corners, triangles).unwrap(), FillRule::NonZero).unwrap()
}

/// Segments cross a mesh where they first meet a triangle. The normal there points outward.
#[test]
fn segments_cross_meshes() {
    let solid = bumped();
    let frame = Frame::new([0.0; 3], 1.0, 4).unwrap();
    let mut worker = solid.on(&frame, &alone()).unwrap().worker().unwrap();
    let Verdict::Partial(part) = worker.root().unwrap() else { panic!("the mesh cuts the universe") };
    let (mut random, mut seen) = (Random(4), [0; 3]);
    for _ in 0..4000 {
        let [from, to] = [0, 1].map(|_| [0; 3].map(|_: i32| random.unit()));
        let way = [0, 1, 2].map(|k| to[k] - from[k]);
        let cross = |u: [f64; 3], v: [f64; 3]| {
            [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        };
        let dot = |u: [f64; 3], v: [f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
        // Möller and Trumbore 1997: parameters of the meeting point, and whether the segment leaves there.
        let hits = solid.mesh().triangles().iter().filter_map(|triangle| {
            let [a, b, c] = triangle.map(|v| solid.mesh().vertices()[v as usize]);
            let minus = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|k| p[k] - q[k]);
            let (e, f, s) = (minus(b, a), minus(c, a), minus(from, a));
            let scale = dot(e, cross(way, f));
            let (u, v) = (dot(s, cross(way, f)) / scale, dot(way, cross(s, e)) / scale);
            let t = dot(f, cross(s, e)) / scale;
            (u > 0.0 && v > 0.0 && u + v < 1.0 && (0.0..1.0).contains(&t)).then_some((t, scale < 0.0))
        });
        let first = hits.min_by(|a, b| a.0.total_cmp(&b.0));
        let found = worker.crossing(Cell::ROOT, &part, &Segment { from, to }).unwrap();
        match (first, found) {
            (None, None) => seen[0] += 1,
            (Some(_), None) => seen[1] += 1,
            (Some((t, leads_out)), Some(crossing)) => {
                seen[2] += 1;
                assert!((crossing.t - t).abs() < 1e-9, "{crossing:?} {t}");
                assert_eq!(dot(crossing.normal, way) > 0.0, leads_out);
            }
            (None, Some(crossing)) => panic!("{crossing:?} from {from:?} to {to:?}"),
        }
    }
    assert!(seen[0] > 500 && seen[1] < 10 && seen[2] > 500, "{seen:?}");
}

#[test]
fn vertices_of_meshes_lie_on_them() {
    let solid = bumped();
    assert!(solid.mesh().volume() > 0.0);
    for depth in [4, 6] {
        let surface = crossings(&solid, &Frame::new([0.0; 3], 1.0, depth).unwrap());
        // Tips may contain isolated samples.
        assert_eq!(euler_of_manifold(&surface), 2 * components(&surface) as i64);
        let worst = surface.vertices().iter().map(|&v| distance_to(solid.mesh(), v)).fold(0.0, f64::max);
        assert!(worst < 1e-9, "{worst:e}");
    }
    let Some(path) = model("featuretype.STL") else { return };
    let mesh = exchange::open_mesh(&path, &exchange::MeshOptions::default()).unwrap().mesh;
    let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
    let bounds = solid.bounds().unwrap();
    let frame = Frame::around(bounds.min, bounds.max, 6).unwrap();
    let surface = crossings(&solid, &frame);
    assert_balanced(&surface);
    let few = surface.vertices().iter().step_by(surface.vertices().len() / 500 + 1);
    let worst = few.map(|&v| distance_to(solid.mesh(), v)).fold(0.0, f64::max);
    assert!(worst < 1e-7 * frame.edge(), "{worst:e}");
}

/// A half-space and a ball that leave the universe are cut off at its boundary.
#[test]
fn clipped_solids() {
    let frame = Frame::new([-1.0; 3], 2.0, 4).unwrap();
    let ball = Csg::ball([1.0, 1.0, 1.0], 1.5).unwrap();
    let mesh = crossings(&ball, &frame);
    assert_balanced(&mesh);
    assert_eq!(euler_of_manifold(&mesh), 2);
    let (low, high) = mesh.bounds();
    assert!(high == [1.0; 3] && low.iter().all(|x| (x + 0.5).abs() < 0.1));
    // An eighth of the ball.
    let eighth = std::f64::consts::PI / 6.0 * 1.5f64.powi(3);
    assert!((mesh.volume() / eighth - 1.0).abs() < 0.05, "{} {eighth}", mesh.volume());
    let all = Csg::ball([0.0; 3], 10.0).unwrap();
    let mesh = crossings(&all, &frame);
    assert_balanced(&mesh);
    assert_eq!((mesh.bounds(), euler_of_manifold(&mesh)), (([-1.0; 3], [1.0; 3]), 2));
    let midpoints = marching_cubes_solid(&all, &frame, VertexPlacement::Midpoint, &alone()).unwrap();
    assert_eq!(midpoints.bounds(), ([-1.0625; 3], [1.0625; 3]));
}

/// Midpoints are those of the dense array of corners.
#[test]
fn midpoints_and_threads() {
    let frame = lattice_frame(5);
    let mut random = Random(9);
    for _ in 0..20 {
        let centre = [0, 1, 2].map(|_| random.between(8.0, 24.0));
        let radius = random.between(2.0, 7.0);
        let ball = AnySolid::new(Csg::ball(centre, radius).unwrap());
        for placement in [VertexPlacement::Midpoint, VertexPlacement::Crossing] {
            let mesh = marching_cubes_solid(&ball, &frame, placement, &alone()).unwrap();
            let threads = marching_cubes_solid(&ball, &frame, placement, &Control::threads(4)).unwrap();
            assert_eq!((mesh.vertices(), mesh.triangles()), (threads.vertices(), threads.triangles()));
            assert_eq!(euler_of_manifold(&mesh), 2);
            // Each vertex lies on an edge of the lattice, one end of which lies inside.
            for vertex in mesh.vertices() {
                let axis = (0..3).find(|&axis| vertex[axis].fract() != 0.0).unwrap();
                assert!((0..3).all(|other| other == axis || vertex[other].fract() == 0.0));
                let square = |x: f64| {
                    let mut at = *vertex;
                    at[axis] = x;
                    (0..3).map(|k| (at[k] - centre[k]).powi(2)).sum::<f64>()
                };
                let ends = [vertex[axis].floor(), vertex[axis].ceil()].map(|x| square(x) < radius * radius);
                assert_ne!(ends[0], ends[1]);
            }
        }
    }
}

/// Without slabs, verdicts narrow a crossing down.
#[test]
fn verdicts_alone() {
    let size = |p: [f64; 3]| p.iter().map(|x| x.abs()).sum::<f64>();
    let octahedron = Callback::new(|min: [f64; 3], max: [f64; 3]| {
        let far = size([0, 1, 2].map(|k| min[k].abs().max(max[k].abs())));
        let near = [0, 1, 2]
            .map(|k| if min[k] <= 0.0 && max[k] >= 0.0 { 0.0 } else { min[k].abs().min(max[k].abs()) });
        Ok(match (far <= 0.7, size(near) >= 0.7) {
            (true, _) => Verdict::Full,
            (_, true) => Verdict::Empty,
            _ => Verdict::Partial(()),
        })
    })
    .with_contains(move |p| Ok(size(p) < 0.7));
    let mesh = crossings(&octahedron, &Frame::new([-1.01, -1.02, -1.03], 2.06, 4).unwrap());
    assert_eq!(euler_of_manifold(&mesh), 2);
    let worst = mesh.vertices().iter().map(|&v| (size(v) - 0.7).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-5, "{worst:e}");
}

#[test]
fn what_is_refused() {
    let frame = lattice_frame(4);
    let tree = build(&Csg::ball([8.0; 3], 4.0).unwrap(), &frame, Rule::Sampled, &alone()).unwrap();
    let refused = marching_cubes_solid(&tree, &frame, VertexPlacement::Midpoint, &alone());
    assert!(matches!(refused, Err(Error::FrameMismatch { .. })));
    let deepest = frame.with_depth(20).unwrap();
    let refused = marching_cubes_solid(
        &Csg::ball([8.0; 3], 4.0).unwrap(),
        &deepest,
        VertexPlacement::Midpoint,
        &alone(),
    );
    assert!(matches!(refused, Err(Error::Argument { name: "frame", .. })));
}
