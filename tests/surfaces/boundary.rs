//! Boundaries of solids that provide their surfaces.

use leafless::query::{DistanceTo, Obstacle, distances};
use leafless::surface::{Boundary, boundary};
use leafless::{
    Affine, AnySolid, Control, Csg, Error, FillRule, Frame, Membership, MeshSolid, Octree, Ray, Rule, Solid,
    SurfaceOptions, TriangleMesh, build, build_extended, cast_rays, contains, deviation, measure,
};
use leafless_testkit::surfaces::euler_of_manifold;
use leafless_testkit::{Random, alone, repeated};
use std::collections::BTreeMap;
use std::f64::consts::PI;

pub fn of<S: Solid>(solid: &S, depth: u8, tolerance: f64) -> Boundary {
    let bounds = solid.bounds().unwrap();
    let frame = Frame::around(bounds.min, bounds.max, depth).unwrap();
    boundary(solid, &frame, tolerance, &alone()).unwrap()
}

/// Asserts that each edge has two triangles, which use it in opposite directions.
pub fn assert_manifold(mesh: &TriangleMesh, text: &str) {
    let mut edges: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    for triangle in mesh.triangles() {
        for k in 0..3 {
            *edges.entry((triangle[k], triangle[(k + 1) % 3])).or_default() += 1;
        }
    }
    for (&(from, to), &count) in &edges {
        assert!(count == 1 && edges.get(&(to, from)) == Some(&1), "{text}: {from} {to}");
    }
}

pub fn turn() -> Affine {
    Affine::new([[0.36, 0.48, -0.8, 1.0], [-0.8, 0.6, 0.0, 2.0], [0.48, 0.64, 0.6, 3.0]]).unwrap()
}

pub fn plate() -> Csg {
    let bore = Csg::cylinder_between([40.0, 30.0, -1.0], [40.0, 30.0, 11.0], 5.0).unwrap();
    Csg::cuboid([0.0; 3], [80.0, 60.0, 10.0]).unwrap().difference(&bore).unwrap()
}

/// Returns the distance of a point from the boundary of the plate with its bore: the least distance from its
/// seven faces.
fn away_from_plate([x, y, z]: [f64; 3]) -> f64 {
    let beside = |c: f64, most: f64| (-c).max(c - most).max(0.0);
    let away = |a: f64, b: f64, c: f64| a.hypot(b).hypot(c);
    let (bx, by, bz) = (beside(x, 80.0), beside(y, 60.0), beside(z, 10.0));
    let radius = (x - 40.0).hypot(y - 30.0);
    // (For the two faces with a hole, the nearest point of a place in the hole is on the rim.)
    let plane = if radius < 5.0 { 5.0 - radius } else { bx.hypot(by) };
    let sides = [away(x.abs().min((x - 80.0).abs()), by, bz), away(y.abs().min((y - 60.0).abs()), bx, bz)];
    let ends = plane.hypot(z.abs().min((z - 10.0).abs()));
    sides.into_iter().fold((radius - 5.0).hypot(bz).min(ends), f64::min)
}

/// A random point of the plate's boundary. The seven faces are equally likely.
fn point_of_plate(random: &mut Random) -> [f64; 3] {
    let mut point = [80.0, 60.0, 10.0].map(|most| random.between(0.0, most));
    match random.below(7) {
        6 => {
            let turn = random.between(0.0, std::f64::consts::TAU);
            (point[0], point[1]) = (40.0 + 5.0 * turn.cos(), 30.0 + 5.0 * turn.sin());
        }
        side => {
            let axis = side as usize / 2;
            point[axis] = if side % 2 == 0 { 0.0 } else { [80.0, 60.0, 10.0][axis] };
            let (x, y) = (point[0] - 40.0, point[1] - 30.0);
            let radius = x.hypot(y);
            if axis == 2 && radius < 5.0 {
                // Points in the hole are moved out around it.
                (point[0], point[1]) = (40.0 + x * 10.0 / radius - x, 30.0 + y * 10.0 / radius - y);
            }
        }
    }
    point
}

/// Checks the proven deviation of the plate at `samples` points of the mesh, and at as many of the boundary.
fn check_plate(shares: &[f64], samples: usize) {
    for share in shares {
        let tolerance = 80.0 * share;
        let found = of(&plate(), 14, tolerance);
        let (mesh, proven) = (found.mesh(), found.report().deviation);
        assert!(proven <= tolerance, "{share}: {proven}");
        let mut random = Random(7);
        let (mut outward, mut inward) = (0.0f64, 0.0f64);
        for k in 0..samples {
            let triangle = &mesh.triangles()[k % mesh.triangles().len()];
            let [a, b, c] = triangle.map(|v| mesh.vertices()[v as usize]);
            let (u, v) = (random.between(0.0, 1.0), random.between(0.0, 1.0));
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let point = [0, 1, 2].map(|k| a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]));
            outward = outward.max(away_from_plate(point));
            inward = inward.max(away_from_mesh(point_of_plate(&mut random), mesh));
        }
        let most = outward.max(inward);
        // (The proven deviation is close to the real one: samples come near the worst point.)
        assert!(most <= proven && proven <= 1.5 * most, "{share}: {outward} {inward} {proven}");
    }
}

/// `cargo test --release --test surfaces boundary -- --ignored`
#[test]
#[ignore = "minutes"]
fn a_million_samples_of_the_plate() {
    check_plate(&[1e-3, 1e-4, 1e-5], 1_000_000);
}

#[test]
fn samples_of_the_plate() {
    check_plate(&[1e-3, 1e-4], 4000);
}

/// A box has eight vertices. They are its corners to the last digits, in any orientation.
#[test]
fn boxes_have_twelve_triangles() {
    let (low, high) = ([0.0, -1.0, 2.5], [10.0, 20.0, 32.0]);
    let block = Csg::cuboid(low, high).unwrap();
    for (placement, depth) in [(Affine::IDENTITY, 1), (Affine::IDENTITY, 14), (turn(), 14), (turn(), 19)] {
        let found = of(&block.placed(&placement).unwrap(), depth.max(5), 1.0);
        let mesh = found.mesh();
        assert_eq!((mesh.triangles().len(), euler_of_manifold(mesh)), (12, 2));
        for corner in 0..8 {
            let corner =
                placement.apply([0, 1, 2].map(|k| if corner >> k & 1 == 0 { low[k] } else { high[k] }));
            let least =
                mesh.vertices().iter().map(|v| (0..3).map(|k| (v[k] - corner[k]).abs()).fold(0.0, f64::max));
            let least = least.fold(f64::INFINITY, f64::min);
            assert!(least < 1e-13, "{least:e}");
        }
        // Each surface has two triangles.
        let mut counts = BTreeMap::new();
        (0..12).for_each(|k| *counts.entry(found.surface_of(k).unwrap()).or_insert(0) += 1);
        assert!(counts.len() == 6 && counts.values().all(|&count| count == 2), "{counts:?}");
        assert_eq!(found.surfaces().len(), 6);
    }
}

/// Returns the distance of a point from a triangle.
fn away_from_triangle(p: [f64; 3], [a, b, c]: [[f64; 3]; 3]) -> f64 {
    let minus = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|k| p[k] - q[k]);
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let side = |a: [f64; 3], b: [f64; 3]| {
        let (way, from) = (minus(b, a), minus(p, a));
        let share = (dot(way, from) / dot(way, way)).clamp(0.0, 1.0);
        let away = minus(from, way.map(|c| share * c));
        dot(away, away).sqrt()
    };
    let least = side(a, b).min(side(b, c)).min(side(c, a));
    let (u, v, w) = (minus(b, a), minus(c, a), minus(p, a));
    let (uu, uv, vv, uw, vw) = (dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w));
    let determinant = uu * vv - uv * uv;
    let (x, y) = ((vv * uw - uv * vw) / determinant, (uu * vw - uv * uw) / determinant);
    if x >= 0.0 && y >= 0.0 && x + y <= 1.0 {
        let away = [0, 1, 2].map(|k| w[k] - x * u[k] - y * v[k]);
        return least.min(dot(away, away).sqrt());
    }
    least
}

pub fn away_from_mesh(p: [f64; 3], mesh: &TriangleMesh) -> f64 {
    let corners = |triangle: &[u32; 3]| triangle.map(|v| mesh.vertices()[v as usize]);
    mesh.triangles()
        .iter()
        .map(|triangle| away_from_triangle(p, corners(triangle)))
        .fold(f64::INFINITY, f64::min)
}

/// Checks the proven deviation of a mesh at points of the mesh, and at points of the boundary that rays find.
pub fn assert_deviation(solid: &Csg, found: &Boundary, random: &mut Random, text: &str) {
    let (mesh, most) = (found.mesh(), found.report().deviation);
    if mesh.triangles().is_empty() {
        return;
    }
    // Middles of sides and triangles are furthest from curved surfaces.
    let mut points = Vec::new();
    let step = 1 + mesh.triangles().len() / 60;
    for triangle in mesh.triangles().iter().step_by(step) {
        let corners = triangle.map(|v| mesh.vertices()[v as usize]);
        for shares in [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [1.0 / 3.0; 3]] {
            points.push([0, 1, 2].map(|k| (0..3).map(|i| shares[i] * corners[i][k]).sum()));
        }
    }
    let frame = Frame::new([-20.0; 3], 40.0, 14).unwrap();
    let control = Control { max_splits: Some(3000), ..alone() };
    let near = distances(solid, &frame, &points, DistanceTo::Boundary, 0.05 * most, &control).unwrap();
    for (point, near) in points.iter().zip(near) {
        let least = near.distance.lower.max(-near.distance.upper);
        assert!(least <= most, "{text}: {point:?} is {least} away, not {most}");
    }
    let (mut rays, mut lines) = (Vec::new(), Vec::new());
    for _ in 0..60 {
        let [from, to] = [0, 1].map(|_| [0; 3].map(|_| random.between(-12.0, 12.0)));
        let direction = [0, 1, 2].map(|k| to[k] - from[k]);
        let origin = [0, 1, 2].map(|k| from[k] - 3.0 * direction[k]);
        lines.push((origin, direction));
        rays.push(Ray::new(origin, direction).unwrap());
    }
    let hits = cast_rays(solid, &frame, &rays, Obstacle::Full, &control).unwrap();
    for ((origin, way), hit) in lines.iter().zip(hits).filter_map(|(line, hit)| Some((line, hit?))) {
        let at = 0.5 * (hit.t.lower + hit.t.upper);
        // (A ray may begin inside.)
        if !at.is_finite() || hit.t.lower == 0.0 {
            continue;
        }
        let long = way.iter().map(|c| c * c).sum::<f64>().sqrt();
        let point = [0, 1, 2].map(|k| origin[k] + at * way[k]);
        let least = away_from_mesh(point, mesh) - 0.5 * hit.t.width() * long;
        assert!(least <= most, "{text}: the boundary at {point:?} is {least} away, not {most}");
    }
}

/// The plate with one bore: few triangles, sharp edges, and the proven deviation.
#[test]
fn a_plate_with_a_bore() {
    for (share, most) in [(1e-3, 500), (1e-4, 1500), (1e-5, 5000)] {
        let tolerance = 80.0 * share;
        let found = of(&plate(), 14, tolerance);
        let mesh = found.mesh();
        assert!(mesh.triangles().len() <= most, "{share}: {}", mesh.triangles().len());
        assert_eq!(euler_of_manifold(mesh), 0);
        assert_eq!(found.report().intersecting_pairs, 0);
        assert_eq!(mesh.intersecting_pairs(1, &alone()).unwrap().count, 0);
        let proven = found.report().deviation;
        assert!(proven <= tolerance, "{share}: {proven}");
        for &vertex in mesh.vertices() {
            assert!(away_from_plate(vertex) < 1e-12, "{vertex:?}");
        }
    }
    // As a proof, both ways.
    let (mesh, tolerance) = (of(&plate(), 14, 0.08).into_mesh(), 0.08);
    let frame = Frame::around([0.0; 3], [80.0, 60.0, 10.0], 14).unwrap();
    let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
    let found = deviation(&plate(), &solid, &frame, 0.1 * tolerance, &alone()).unwrap();
    assert!(found.distance().upper <= 1.1 * tolerance, "{found:?}");
}

/// Solids with a known number of triangles, genus and volume.
#[test]
fn known_solids() {
    let cube = |x: f64, y: f64, z: f64| Csg::cuboid([x, y, z], [x + 1.0, y + 1.0, z + 1.0]).unwrap();
    let union = |parts: [Csg; 2]| Csg::union_of(parts).unwrap();
    let pocket = Csg::cuboid([0.25, 0.25, 0.5], [0.75, 0.75, 1.0]).unwrap();
    let hollow = Csg::cuboid([0.25; 3], [0.75; 3]).unwrap();
    let cases = [
        ("side by side", union([cube(0.0, 0.0, 0.0), cube(1.0, 0.0, 0.0)]), 12, 2, 2.0),
        ("overlapping", union([cube(0.0, 0.0, 0.0), cube(0.5, 0.0, 0.0)]), 12, 2, 1.5),
        ("a step", union([cube(0.0, 0.0, 0.0), cube(0.5, 0.5, 0.0)]), 28, 2, 1.75),
        ("a pocket", cube(0.0, 0.0, 0.0).difference(&pocket).unwrap(), 28, 2, 0.875),
        ("a hollow", cube(0.0, 0.0, 0.0).difference(&hollow).unwrap(), 24, 4, 0.875),
        ("apart", union([cube(0.0, 0.0, 0.0), cube(2.0, 0.0, 0.0)]), 24, 4, 2.0),
        ("an edge in common", union([cube(0.0, 0.0, 0.0), cube(1.0, 1.0, 0.0)]), 24, 4, 2.0),
        ("a corner in common", union([cube(0.0, 0.0, 0.0), cube(1.0, 1.0, 1.0)]), 24, 4, 2.0),
        ("nothing", cube(0.0, 0.0, 0.0).difference(&cube(0.0, 0.0, 0.0)).unwrap(), 0, 0, 0.0),
    ];
    for (name, solid, triangles, euler, volume) in cases {
        let frame = Frame::new([-1.0; 3], 6.0, 12).unwrap();
        let found = boundary(&solid, &frame, 0.01, &alone()).unwrap();
        let mesh = found.mesh();
        assert_eq!(mesh.triangles().len(), triangles, "{name}");
        assert_manifold(mesh, name);
        assert_eq!(euler_of_manifold(mesh), euler, "{name}");
        assert!((mesh.volume() - volume).abs() < 1e-12, "{name}: {}", mesh.volume());
    }
}

/// Curved solids: closed, without intersections, and within the tolerance.
#[test]
fn curved_solids() {
    let crossed = Csg::cylinder(4.0, -9.0, 9.0).unwrap().placed(&turn()).unwrap();
    let cases = [
        ("ball", Csg::ball([0.1, 0.2, 0.3], 9.0).unwrap(), 2),
        ("cylinder", Csg::cylinder(5.0, -10.0, 10.0).unwrap(), 2),
        ("frustum", Csg::frustum(5.0, 2.0, -10.0, 10.0).unwrap(), 2),
        ("cone", Csg::frustum(5.0, 0.0, -10.0, 10.0).unwrap(), 2),
        ("torus", Csg::torus(8.0, 2.0).unwrap(), 0),
        ("crossed", Csg::union_of([Csg::cylinder(5.0, -10.0, 10.0).unwrap(), crossed.clone()]).unwrap(), 2),
        (
            "lens",
            Csg::intersection_of([
                Csg::ball([0.0; 3], 9.0).unwrap(),
                Csg::ball([9.0, 1.0, 0.0], 8.0).unwrap(),
            ])
            .unwrap(),
            2,
        ),
        ("turned plate", plate().placed(&turn()).unwrap(), 0),
    ];
    for (name, solid, euler) in cases {
        let known = solid.bounds().unwrap();
        let frame = Frame::around(known.min, known.max, 13).unwrap();
        let volume = measure(&solid, &frame, 1e-3, &alone()).unwrap().volume;
        let mut before = f64::INFINITY;
        for tolerance in [0.4, 0.1, repeated(0.05, 0.025)] {
            let found = boundary(&solid, &frame, tolerance, &alone()).unwrap();
            let mesh = found.mesh();
            assert_manifold(mesh, name);
            assert_eq!(euler_of_manifold(mesh), euler, "{name} {tolerance}");
            assert_eq!(found.report().intersecting_pairs, 0, "{name} {tolerance}");
            let away = (mesh.volume() - volume.lower).abs().max((mesh.volume() - volume.upper).abs());
            assert!(away <= tolerance * mesh.area(), "{name} {tolerance}: {away}");
            assert!(away < before, "{name} {tolerance}: {away} after {before}");
            before = away;
        }
    }
}

/// A ball, a cylinder, a cone, a box or a torus somewhere within 14 of the origin.
fn primitive(random: &mut Random) -> Csg {
    let shape = match random.below(5) {
        0 => Csg::cuboid([-4.0, -5.0, -3.0], [random.between(1.0, 6.0), 4.0, 5.0]),
        1 => Csg::cylinder(random.between(1.0, 5.0), -6.0, random.between(0.0, 7.0)),
        2 => Csg::ball([0.0; 3], random.between(2.0, 7.0)),
        3 => Csg::frustum(random.between(2.0, 6.0), random.between(0.5, 2.0), -4.0, 4.0),
        _ => Csg::torus(random.between(3.0, 6.0), random.between(0.5, 2.0)),
    };
    let whole = [0; 3].map(|_| random.below(9) as f64 - 4.0);
    let free = [0; 3].map(|_| random.between(-8.0, 8.0));
    let (sin, cos) = random.between(0.0, 6.3).sin_cos();
    let rows = if random.below(3) == 0 {
        [[1.0, 0.0, 0.0, whole[0]], [0.0, 1.0, 0.0, whole[1]], [0.0, 0.0, 1.0, whole[2]]]
    } else {
        [
            [0.6 * cos, -sin, 0.8 * cos, free[0]],
            [0.6 * sin, cos, 0.8 * sin, free[1]],
            [-0.8, 0.0, 0.6, free[2]],
        ]
    };
    shape.unwrap().placed(&Affine::new(rows).unwrap()).unwrap()
}

/// A random scene of two to five primitives.
pub fn random_scene(random: &mut Random) -> Csg {
    let mut solid = primitive(random);
    for _ in 0..1 + random.below(4) {
        let other = primitive(random);
        solid = match random.below(3) {
            0 => Csg::intersection_of([solid, other]).unwrap(),
            1 => solid.difference(&other).unwrap(),
            _ => Csg::union_of([solid, other]).unwrap(),
        };
    }
    solid
}

/// Scenes of two to five primitives: closed, manifold, without intersecting pairs, and with the right volume.
#[test]
fn random_scenes() {
    check_scenes(0..repeated(3, 8));
}

/// `cargo test --release --test surfaces boundary -- --ignored`
#[test]
#[ignore = "minutes"]
fn more_random_scenes() {
    check_scenes(0..200);
}

fn check_scenes(scenes: std::ops::Range<usize>) {
    let mut random = Random(39);
    let mut beyond = 0;
    for scene in scenes.clone() {
        let solid = random_scene(&mut random);
        let frame = Frame::new([-20.0; 3], 40.0, 13).unwrap();
        let tolerance = [0.3, 0.1, 0.03][scene % 3];
        let found = boundary(&solid, &frame, tolerance, &alone()).unwrap();
        let mesh = found.mesh();
        assert_manifold(mesh, &format!("scene {scene}"));
        assert_eq!(found.report().intersecting_pairs, 0, "scene {scene}");
        let proven = found.report().deviation;
        // (Where surfaces nearly touch, the proof would need more cells than the search splits.)
        beyond += usize::from(proven > tolerance);
        let is_empty = mesh.triangles().is_empty();
        assert!(proven <= 10.0 * tolerance || is_empty, "scene {scene}: {proven} of {tolerance}");
        assert_deviation(&solid, &found, &mut random, &format!("scene {scene}"));
        let control = Control { max_splits: Some(2000), ..alone() };
        let volume = measure(&solid, &frame, 0.0, &control).unwrap().volume;
        let slack = tolerance * mesh.area() + 1e-9;
        let within = volume.lower - slack <= mesh.volume() && mesh.volume() <= volume.upper + slack;
        assert!(within, "scene {scene}: {} {volume:?}", mesh.volume());
        // Points on both sides of each triangle have the right membership.
        for triangle in mesh.triangles().iter().step_by(7) {
            let [a, b, c] = triangle.map(|v| mesh.vertices()[v as usize]);
            let (p, q) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
            let normal = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
            let size = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
            if size < 0.5 {
                continue;
            }
            let at = |side: f64| {
                [0, 1, 2].map(|k| (a[k] + b[k] + c[k]) / 3.0 + side * 1.5 * tolerance * normal[k] / size)
            };
            // (Walls may be thinner than that. Then one of the sides is enough.)
            let points = [at(1.0), at(-1.0)];
            let mut sides = [Membership::Undecided; 2];
            contains(&solid, &frame, &points, &mut sides, &alone()).unwrap();
            use Membership::{Inside, Outside};
            assert!(sides[0] != Inside || sides[1] != Outside, "scene {scene}: {points:?}");
        }
    }
    assert!(beyond <= 1 + scenes.len() / 20, "{beyond}");
}

/// An octree that keeps its surfaces has its source's boundary, also where faces lie in planes of the
/// octree's lattice.
#[test]
fn stored_octrees() {
    let frame = Frame::new([-10.0, -10.0, -20.0], 120.0, 9).unwrap();
    let stored = build_extended(&plate(), &frame, &SurfaceOptions::default(), &alone()).unwrap();
    let found = boundary(&stored, &frame, 0.08, &alone()).unwrap();
    let own = boundary(&plate(), &frame, 0.08, &alone()).unwrap();
    assert_eq!(found.mesh().triangles().len(), own.mesh().triangles().len());
    assert_eq!(euler_of_manifold(found.mesh()), 0);
    assert!((found.mesh().volume() - own.mesh().volume()).abs() < 1e-9 * own.mesh().volume());
    let on_lattice = Csg::cuboid([20.0, 5.0, 10.0], [35.0, 20.0, 40.0]).unwrap();
    let frame = Frame::new([-40.0; 3], 160.0, 5).unwrap();
    let stored = build_extended(&on_lattice, &frame, &SurfaceOptions::default(), &alone()).unwrap();
    let found = boundary(&stored, &frame, 0.1, &alone()).unwrap();
    assert_eq!(found.mesh().triangles().len(), 12);
    assert!((found.mesh().volume() - 15.0 * 15.0 * 30.0).abs() < 1e-9);
}

/// The result is the same for any number of threads.
#[test]
fn threads() {
    let solid = Csg::torus(8.0, 2.0).unwrap().difference(&Csg::ball([8.0, 0.0, 0.0], 3.0).unwrap()).unwrap();
    let frame = Frame::new([-12.3; 3], 25.0, 12).unwrap();
    let [one, other] = [1, 3]
        .map(|threads| boundary(&solid, &frame, repeated(0.08, 0.02), &Control::threads(threads)).unwrap());
    assert_eq!(one.report(), other.report());
    assert_eq!(one.mesh().triangles(), other.mesh().triangles());
    assert_eq!(one.mesh().vertices(), other.mesh().vertices());
}

/// A stored octree with a cut that no surface explains does not take minutes.
#[test]
fn an_octree_with_a_shared_cut() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/format_spec/vectors/valid/cut-shared.lfl");
    let tree = leafless::file::from_bytes(&std::fs::read(path).unwrap()).unwrap();
    let frame = Frame::new([-0.1; 3], 2.2, 6).unwrap();
    let found = boundary(&tree, &frame, 0.01, &alone()).unwrap();
    assert_manifold(found.mesh(), "shared cut");
    assert!(found.report().deviation < 0.2, "{:?}", found.report());
}

#[test]
fn refusals() {
    let frame = Frame::new([-1.0; 3], 2.0, 8).unwrap();
    let ball = Csg::ball([0.0; 3], 0.5).unwrap();
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = boundary(&ball, &frame, tolerance, &alone());
        assert!(matches!(refused, Err(Error::Argument { name: "tolerance", .. })));
    }
    let large = Csg::ball([0.0; 3], 1.5).unwrap();
    assert!(matches!(boundary(&large, &frame, 0.1, &alone()), Err(Error::Argument { name: "frame", .. })));
    let control = Control { max_nodes: Some(3), ..alone() };
    assert!(matches!(boundary(&ball, &frame, 1e-3, &control), Err(Error::Limit { what: "nodes", .. })));
    let cancelled = std::sync::atomic::AtomicBool::new(true);
    let control = Control { cancel: Some(&cancelled), ..alone() };
    assert!(matches!(boundary(&ball, &frame, 1e-3, &control), Err(Error::Cancelled)));
    // A mesh with a bore. Most of its boundary belongs to no surface.
    let block = of(&Csg::cuboid([-0.4; 3], [0.4; 3]).unwrap(), 8, 0.01).into_mesh();
    let mesh = AnySolid::new(MeshSolid::new(block, FillRule::NonZero).unwrap());
    let mixed = Csg::solid(mesh).difference(&Csg::cylinder(0.1, -1.0, 1.0).unwrap()).unwrap();
    let deep = frame.with_depth(12).unwrap();
    let refused = boundary(&mixed, &deep, 0.01, &alone());
    assert!(
        matches!(refused, Err(Error::Argument { name: "solid", problem }) if problem.contains("contour")),
        "{:?}",
        refused.map(|found| *found.report())
    );
    // Solids without known surfaces.
    let tree: Octree = build(&ball, &frame, Rule::Certified, &alone()).unwrap();
    assert!(matches!(boundary(&tree, &frame, 0.1, &alone()), Err(Error::Argument { name: "solid", .. })));
}

/// The boundary of a closed mesh is the mesh itself, with fewer triangles. Parts inside another body do not
/// belong to it.
#[test]
fn meshes() {
    let frame = Frame::new([-1.0; 3], 2.0, 8).unwrap();
    let fine = of(&Csg::ball([0.0; 3], 0.5).unwrap(), 10, repeated(2e-4, 1e-4)).into_mesh();
    let (count, volume) = (fine.triangles().len(), fine.volume());
    let solid = MeshSolid::new(fine, FillRule::NonZero).unwrap();
    let found = boundary(&solid, &frame, 0.01, &alone()).unwrap();
    assert_eq!(euler_of_manifold(found.mesh()), 2);
    assert!(found.report().deviation <= 0.01 && found.mesh().triangles().len() < count / 20);
    assert!((found.mesh().volume() - volume).abs() < 0.01 * found.mesh().area());
    let [outer, inner] = [0.8, 0.3].map(|half| {
        let block = Csg::cuboid([-half; 3], [half; 3]).unwrap();
        of(&block, 8, 0.01).into_mesh()
    });
    let shift = outer.vertices().len() as u32;
    let vertices = [outer.vertices(), inner.vertices()].concat();
    let moved = inner.triangles().iter().map(|triangle| triangle.map(|vertex| vertex + shift));
    let triangles = outer.triangles().iter().copied().chain(moved).collect();
    let both = TriangleMesh::new(vertices, triangles).unwrap();
    let both = MeshSolid::new(both.with_deviation(0.001).unwrap(), FillRule::NonZero).unwrap();
    let found = boundary(&both, &frame, 0.01, &alone()).unwrap();
    assert_eq!((found.mesh().triangles().len(), euler_of_manifold(found.mesh())), (12, 2));
    assert!((0.001..0.0011).contains(&found.report().deviation), "{:?}", found.report());
}

/// A lathe-turned part whose surfaces meet three at a time in circles: a chamfer on a round, a countersink in
/// a bore, a counterbore, on a flange with four holes.
fn turned_part() -> Csg {
    let about = |x: f64, y: f64, radii: [f64; 2], low: f64, high: f64| {
        Csg::frustum_between([x, y, low], [x, y, high], radii).unwrap()
    };
    let cylinder = |x: f64, y: f64, radius: f64, low: f64, high: f64| {
        Csg::cylinder_between([x, y, low], [x, y, high], radius).unwrap()
    };
    let flange = Csg::cuboid([-30.0, -30.0, 0.0], [30.0, 30.0, 10.0]).unwrap();
    let body = [flange, cylinder(0.0, 0.0, 20.0, 0.0, 38.0), about(0.0, 0.0, [20.0, 18.0], 38.0, 40.0)];
    let mut tools = vec![
        cylinder(0.0, 0.0, 8.0, -1.0, 59.0),
        cylinder(0.0, 0.0, 12.0, 34.0, 44.0),
        about(0.0, 0.0, [13.0, 8.0], -1.0, 4.0),
    ];
    tools.extend(
        [[24.0, 24.0], [-24.0, 24.0], [24.0, -24.0], [-24.0, -24.0]]
            .map(|[x, y]| cylinder(x, y, 3.0, -1.0, 19.0)),
    );
    Csg::union_of(body).unwrap().difference(&Csg::union_of(tools).unwrap()).unwrap()
}

/// Returns the distances of a point from each of its surfaces.
fn away_from_turned_part([x, y, z]: [f64; 3]) -> Vec<f64> {
    let (r, slope) = (x.hypot(y), 0.5f64.sqrt());
    let hole = (x.abs() - 24.0).hypot(y.abs() - 24.0) - 3.0;
    let mut all = vec![z, z - 10.0, z - 34.0, z - 40.0, x.abs() - 30.0, y.abs() - 30.0];
    all.extend([r - 8.0, r - 12.0, r - 20.0, hole, slope * (r + z - 12.0), slope * (r + z - 58.0)]);
    all.into_iter().map(f64::abs).collect()
}

#[test]
fn sharp_edges_of_a_turned_part() {
    let (part, length) = (turned_part(), 60.0);
    for (placement, part_of_length) in [(Affine::IDENTITY, 1e-3), (turn(), 1e-3), (Affine::IDENTITY, 1e-4)] {
        let found = of(&part.placed(&placement).unwrap(), 14, part_of_length * length);
        let (mesh, report) = (found.mesh(), found.report());
        let back = placement.inverse().unwrap();
        let vertices: Vec<_> = mesh.vertices().iter().map(|&vertex| back.apply(vertex)).collect();
        assert_manifold(mesh, "turned part");
        // Five through holes, the middle one with steps.
        assert_eq!(euler_of_manifold(mesh), 2 - 2 * 5);
        assert!(report.intersecting_pairs == 0 && report.deviation <= part_of_length * length, "{report:?}");
        let round = 400.0 * 28.0 + 2.0 / 3.0 * (400.0 + 360.0 + 324.0);
        let holes = 64.0 * 30.0 + 144.0 * 6.0 + 4.0 / 3.0 * (144.0 + 96.0 + 64.0) + 4.0 * 9.0 * 10.0;
        let volume = 36_000.0 + PI * (round - holes);
        assert!((mesh.volume() - volume).abs() <= 1.1 * mesh.area() * report.deviation);

        // Edges between triangles on different surfaces.
        let mut sides: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        for (number, &[a, b, c]) in mesh.triangles().iter().enumerate() {
            let surface = found.surface_of(number).unwrap();
            sides.extend([(a, b), (b, c), (c, a)].map(|edge| (edge, surface)));
        }
        let sharp = sides.iter().filter(|((a, b), surface)| sides[&(*b, *a)] != **surface);
        let sharp: Vec<_> = sharp.map(|(&(a, _), _)| vertices[a as usize]).collect();
        for &vertex in &sharp {
            let mut away = away_from_turned_part(vertex);
            away.sort_by(f64::total_cmp);
            assert!(away[1] <= 1e-9 * length, "{vertex:?}: {away:?}");
        }
        // Each circle exists.
        for (radius, z) in [
            (8.0, 34.0),
            (12.0, 34.0),
            (12.0, 40.0),
            (18.0, 40.0),
            (20.0, 38.0),
            (20.0, 10.0),
            (8.0, 4.0),
            (12.0, 0.0),
        ] {
            let on = |v: &&[f64; 3]| (v[0].hypot(v[1]) - radius).abs() < 1e-9 && (v[2] - z).abs() < 1e-9;
            let count = sharp.iter().filter(on).count();
            assert!(count >= 12, "{count} vertices at radius {radius}, z = {z}");
        }
        println!("{} triangles, {} of {}", mesh.triangles().len(), report.deviation, part_of_length * length);
        assert!(mesh.triangles().len() < 20_000);
    }
}
