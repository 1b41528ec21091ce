//! The deviation of two boundaries: formulas, an independent sampler, and solids of all kinds.

use leafless::op::DexelOptions;
use leafless::query::{Deviation, DistanceTo, StopReason, Within, distances, ray_spans};
use leafless::surface::DexelSolid;
use leafless::{
    Affine, AnySolid, Control, Csg, Error, FillRule, Frame, Interval, MeshSolid, Ray, Rule, Solid,
    SurfaceOptions, TriangleMesh, build, build_extended, deviation, dexelize,
};
use leafless_testkit::{Random, repeated};
use std::f64::consts::{PI, TAU};
use std::sync::atomic::AtomicBool;

type Point = [f64; 3];

fn alone() -> Control<'static> {
    Control::threads(1)
}

fn around(half: f64, depth: u8) -> Frame {
    Frame::new([-half; 3], 2.0 * half, depth).unwrap()
}

/// Computes the deviation, and checks the laws of every answer.
fn ask<A: Solid, B: Solid>(a: &A, b: &B, frame: &Frame, tolerance: f64) -> Deviation {
    let found = deviation(a, b, frame, tolerance, &alone()).unwrap();
    for way in [found.a_to_b, found.b_to_a] {
        assert!(way.distance.lower >= 0.0);
        if found.stop_reason == StopReason::Tolerance {
            assert!(way.distance.width() <= tolerance || way.distance.lower == f64::INFINITY, "{found:?}");
        }
        if let Some(at) = way.at {
            // The witness supports the lower bound.
            assert!(at.apart < f64::INFINITY && at.point.iter().chain(&at.nearest).all(|c| c.is_finite()));
            assert!(
                length(minus(at.point, at.nearest)) + at.apart >= way.distance.lower * (1.0 - 1e-12),
                "{at:?}"
            );
        } else {
            assert!(way.distance.lower == 0.0 || way.distance.upper == f64::INFINITY, "{found:?}");
        }
    }
    let back = deviation(b, a, frame, tolerance, &alone()).unwrap();
    assert_eq!((back.a_to_b, back.b_to_a), (found.b_to_a, found.a_to_b));
    found
}

/// Checks that both directions contain the truth, up to a width.
fn holds(found: &Deviation, truth: [f64; 2], width: f64) {
    for (way, truth) in [(found.a_to_b, truth[0]), (found.b_to_a, truth[1])] {
        let Interval { .. } = way.distance;
        let (lower, upper) = (way.distance.lower, way.distance.upper);
        let rounding = 1e-12 * (1.0 + truth);
        assert!(lower <= truth + rounding && truth - rounding <= upper, "{truth} {found:?}");
        assert!(upper - lower <= width, "{truth} to {width}: {found:?}");
    }
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

#[test]
fn balls_that_have_one_centre() {
    let frame = around(2.0, 20);
    for (r, s) in [(1.0, 1.25), (1.5, 0.3)] {
        let (a, b) = (Csg::ball([0.0; 3], r).unwrap(), Csg::ball([0.0; 3], s).unwrap());
        let truth = f64::abs(r - s);
        holds(&ask(&a, &b, &frame, 0.01), [truth; 2], 0.01);
    }
    // Moved aside, the farthest points are on the line of centres.
    let (a, b) = (Csg::ball([0.1, 0.2, 0.3], 1.0).unwrap(), Csg::ball([0.3, 0.2, 0.3], 0.75).unwrap());
    holds(&ask(&a, &b, &frame, 0.02), [0.45, 0.45], 0.02);
}

#[test]
fn boxes_moved_and_turned() {
    let frame = around(2.0, 20);
    let a = Csg::cuboid([-1.0; 3], [1.0; 3]).unwrap();
    let moved = Csg::cuboid([-0.9, -0.8, -1.0], [1.1, 1.2, 1.0]).unwrap();
    let truth = f64::hypot(1.1 - 1.0, 1.2 - 1.0);
    // A corner of one box is as far outside the other box as the edges are moved. Inside, it is as far as the
    // nearer face.
    holds(&ask(&a, &moved, &frame, 1e-6), [truth, truth], 1e-6);
    // Faces in planes of the lattice.
    let half = Csg::cuboid([-1.0; 3], [1.0, 1.0, 0.5]).unwrap();
    holds(&ask(&a, &half, &frame, 1e-9), [0.5, 0.5], 1e-9);
    for angle in [0.1f64, 0.5, 0.785] {
        let (s, c) = angle.sin_cos();
        let turn = Affine::new([[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]).unwrap();
        // The edge at 45 degrees is rotated beyond a face.
        let truth = 2f64.sqrt() * (PI / 4.0 - angle).cos() - 1.0;
        let found = ask(&a, &a.placed(&turn).unwrap(), &frame, 1e-5);
        // Inside, the middle part of the faces is nowhere equally far.
        holds(&found, [truth, truth], 1e-5);
    }
}

/// A prism inscribed in a cylinder of radius r around z.
fn prism(n: usize, r: f64, low: f64, high: f64, turn: f64) -> TriangleMesh {
    let ring = |z: f64| {
        (0..n).map(move |k| {
            let (s, c) = (turn + TAU * k as f64 / n as f64).sin_cos();
            [r * c, r * s, z]
        })
    };
    let mut vertices: Vec<Point> = ring(low).chain(ring(high)).collect();
    vertices.extend([[0.0, 0.0, low], [0.0, 0.0, high]]);
    let n = n as u32;
    let mut triangles = vec![];
    for k in 0..n {
        let l = (k + 1) % n;
        triangles.extend([[k, l, n + l], [k, n + l, n + k], [2 * n, l, k], [2 * n + 1, n + k, n + l]]);
    }
    TriangleMesh::new(vertices, triangles).unwrap()
}

fn solid(mesh: TriangleMesh) -> MeshSolid {
    MeshSolid::new(mesh, FillRule::NonZero).unwrap()
}

#[test]
fn a_tessellated_cylinder_beside_its_source() {
    let frame = around(2.0, 20);
    let cylinder = Csg::cylinder(1.0, -0.5, 0.75).unwrap();
    for n in [5, 24] {
        let mesh = solid(prism(n, 1.0, -0.5, 0.75, 0.1));
        let truth = 1.0 - (PI / n as f64).cos();
        let found = ask(&mesh, &cylinder, &frame, 2e-3);
        holds(&found, [truth, truth], 2e-3);
        assert_eq!(found.splits[0], 0);
    }
}

/// A ball-like mesh of rings. Its radius is a function of the direction.
fn globe(rings: usize, around: usize, radius: impl Fn(Point) -> f64, turn: f64) -> TriangleMesh {
    let at = |theta: f64, phi: f64| {
        let ((st, ct), (sp, cp)) = (theta.sin_cos(), (phi + turn).sin_cos());
        let way = [st * cp, st * sp, ct];
        way.map(|c| radius(way) * c)
    };
    let mut vertices = vec![at(0.0, 0.0), at(PI, 0.0)];
    for i in 1..rings {
        for k in 0..around {
            vertices.push(at(PI * i as f64 / rings as f64, TAU * k as f64 / around as f64));
        }
    }
    let place = |i: usize, k: usize| (2 + (i - 1) * around + k % around) as u32;
    let mut triangles = vec![];
    for k in 0..around {
        triangles.push([0, place(1, k), place(1, k + 1)]);
        triangles.push([1, place(rings - 1, k + 1), place(rings - 1, k)]);
        for i in 1..rings - 1 {
            triangles.push([place(i, k), place(i + 1, k), place(i + 1, k + 1)]);
            triangles.push([place(i, k), place(i + 1, k + 1), place(i, k + 1)]);
        }
    }
    TriangleMesh::new(vertices, triangles).unwrap()
}

fn bumpy(size: f64) -> impl Fn(Point) -> f64 {
    move |[x, y, z]| 1.0 + size * ((5.0 * x).sin() + (4.0 * y + 1.0).cos() * (3.0 * z).sin())
}

/// Returns the squared distance of a point from a triangle, by the regions of the plane that the nearest
/// point may belong to.
fn square(p: Point, [a, b, c]: [Point; 3]) -> f64 {
    let (u, v, w) = (minus(b, a), minus(c, a), minus(p, a));
    let (uu, uv, vv, uw, vw) = (dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w));
    let d = uu * vv - uv * uv;
    let (s, t) = ((vv * uw - uv * vw) / d, (uu * vw - uv * uw) / d);
    if s >= 0.0 && t >= 0.0 && s + t <= 1.0 {
        let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        return dot(n, w).powi(2) / dot(n, n);
    }
    let of_edge = |from: Point, to: Point| {
        let (way, off) = (minus(to, from), minus(p, from));
        let t = (dot(way, off) / dot(way, way)).clamp(0.0, 1.0);
        let rest = minus(off, way.map(|c| t * c));
        dot(rest, rest)
    };
    of_edge(a, b).min(of_edge(b, c)).min(of_edge(c, a))
}

/// Returns the greatest distance of random points of one mesh from another mesh, by an examination of all
/// triangles.
fn sampled(from: &TriangleMesh, to: &TriangleMesh, count: usize) -> f64 {
    let corners = |mesh: &TriangleMesh| -> Vec<[Point; 3]> {
        mesh.triangles().iter().map(|t| t.map(|v| mesh.vertices()[v as usize])).collect()
    };
    let (from, to) = (corners(from), corners(to));
    let balls: Vec<(Point, f64)> = to
        .iter()
        .map(|t| {
            let middle = [0, 1, 2].map(|axis| (t[0][axis] + t[1][axis] + t[2][axis]) / 3.0);
            (middle, t.iter().map(|&p| length(minus(p, middle))).fold(0.0, f64::max))
        })
        .collect();
    let mut random = Random(1);
    let (mut most, mut hint) = (0.0f64, 0);
    for k in 0..count {
        let [a, b, c] = from[(k * 7919) % from.len()];
        let (mut s, mut t) = (random.unit(), random.unit());
        if s + t > 1.0 {
            (s, t) = (1.0 - s, 1.0 - t);
        }
        let p = [0, 1, 2].map(|axis| a[axis] + s * (b[axis] - a[axis]) + t * (c[axis] - a[axis]));
        let (mut least, mut root) = (square(p, to[hint]), 0.0);
        root = f64::max(root, least.sqrt());
        for (i, (middle, radius)) in balls.iter().enumerate() {
            let way = minus(p, *middle);
            let reach = root + radius;
            if dot(way, way) < reach * reach {
                let own = square(p, to[i]);
                if own < least {
                    (least, root, hint) = (own, own.sqrt(), i);
                }
            }
        }
        most = most.max(least);
    }
    most.sqrt()
}

fn beside_samples(a: TriangleMesh, b: TriangleMesh, tolerance: f64, count: usize) {
    let found = ask(&solid(a.clone()), &solid(b.clone()), &around(2.0, 10), tolerance);
    assert_eq!((found.stop_reason, found.splits), (StopReason::Tolerance, [0; 2]));
    for (way, from, to) in [(found.a_to_b, &a, &b), (found.b_to_a, &b, &a)] {
        let most = sampled(from, to, count);
        assert!(most <= way.distance.upper * (1.0 + 1e-12), "{most} {way:?}");
        // With so many points, the farthest one is missed only slightly.
        assert!(way.distance.lower - most <= 0.1 * way.distance.lower, "{most} {way:?}");
        // The witness is a point of the surface, and that far away.
        let at = way.at.unwrap();
        let from_it = |mesh: &TriangleMesh| {
            let each =
                mesh.triangles().iter().map(|t| square(at.point, t.map(|v| mesh.vertices()[v as usize])));
            each.fold(f64::INFINITY, f64::min).sqrt()
        };
        assert!(from_it(from) <= at.apart + 1e-12 && from_it(to) >= way.distance.lower);
    }
}

#[test]
fn two_meshes_beside_a_sampler() {
    beside_samples(globe(9, 14, bumpy(0.1), 0.0), globe(12, 17, bumpy(0.1), 0.3), 1e-6, 100_000);
    beside_samples(globe(8, 12, bumpy(0.2), 0.0), globe(10, 10, |_| 0.6, 0.2), 1e-6, 100_000);
}

#[test]
#[ignore = "some minutes"]
fn two_meshes_beside_a_sampler_with_a_million_points() {
    beside_samples(globe(30, 40, bumpy(0.1), 0.0), globe(24, 37, bumpy(0.1), 0.3), 1e-7, 1_000_000);
    beside_samples(globe(20, 30, bumpy(0.2), 0.0), globe(25, 25, |_| 0.6, 0.2), 1e-7, 1_000_000);
}

#[test]
fn bodies_that_overlap_count_by_their_union() {
    // The inner walls of both solids are no boundary.
    let block = |low: f64, high: f64| {
        let corner = |k: usize| {
            [
                if k & 1 == 0 { low } else { high },
                if k & 2 == 0 { -0.5 } else { 0.5 },
                if k & 4 == 0 { -0.5 } else { 0.5 },
            ]
        };
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let vertices: Vec<Point> = (0..8).map(corner).collect();
        let triangles: Vec<[u32; 3]> =
            faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        (vertices, triangles)
    };
    let (mut vertices, mut triangles) = block(-1.0, 0.25);
    let (more, others) = block(-0.125, 1.0);
    triangles.extend(others.iter().map(|t| t.map(|v| v + 8)));
    vertices.extend(more);
    let both = solid(TriangleMesh::new(vertices, triangles).unwrap());
    let one = Csg::cuboid([-1.0, -0.5, -0.5], [1.0, 0.5, 0.5]).unwrap();
    let found = ask(&both, &one, &around(1.5, 7), 0.01);
    // The solids cannot tell that inner walls do not belong to the boundary. These walls widen the interval.
    assert!(found.a_to_b.distance.contains(0.0) && found.b_to_a.distance.contains(0.0), "{found:?}");
    assert!(found.a_to_b.distance.upper < 0.6 && found.b_to_a.distance.upper < 0.05, "{found:?}");
    // Walls that cross at lines. All of the union is known except near these lines.
    let bar = |turn: usize| {
        let corner = |k: usize| {
            [0, 1, 2].map(|axis| {
                let half = if axis == turn { 1.0 } else { 0.4 + 0.01 * (turn + axis) as f64 };
                0.013 * turn as f64 + if k >> axis & 1 == 0 { -half } else { half }
            })
        };
        (corner(0), corner(7))
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let (mut vertices, mut triangles, mut parts) = (Vec::new(), Vec::new(), Vec::new());
    for (low, high) in [0, 1, 2].map(bar) {
        let first = vertices.len() as u32;
        vertices.extend((0..8).map(|k: usize| [0, 1, 2].map(|axis| [low, high][k >> axis & 1][axis])));
        triangles.extend(
            faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]].map(|t| t.map(|v| v + first))),
        );
        parts.push(Csg::cuboid(low, high).unwrap());
    }
    let crossing = solid(TriangleMesh::new(vertices, triangles).unwrap());
    let found = ask(&crossing, &Csg::union_of(parts).unwrap(), &around(1.5, 7), 0.1);
    holds(&found, [0.0; 2], 0.1);
    assert_eq!(found.splits[0], 0);
    // Nested shells: the inner one lies in the solid.
    let nested = |inner: f64| {
        let (a, b) = (prism(12, 1.0, -1.0, 1.0, 0.0), prism(9, inner, -0.5, 0.5, 0.0));
        let shift = a.vertices().len() as u32;
        let vertices = [a.vertices(), b.vertices()].concat();
        let triangles =
            a.triangles().iter().copied().chain(b.triangles().iter().map(|t| t.map(|v| v + shift)));
        solid(TriangleMesh::new(vertices, triangles.collect()).unwrap())
    };
    let found = ask(&nested(0.5), &solid(prism(12, 1.0, -1.0, 1.0, 0.0)), &around(1.5, 7), 1e-9);
    holds(&found, [0.0; 2], 1e-9);
}

#[test]
fn every_way_in() {
    let frame = around(2.0, 6);
    let ball = Csg::ball([0.0; 3], 1.0).unwrap();
    let other = Csg::ball([0.0; 3], 1.25).unwrap();
    let diagonal = 3f64.sqrt() * frame.cell_size();
    let tree = build(&ball, &frame, Rule::Certified, &alone()).unwrap();
    let kept = build_extended(&ball, &frame, &SurfaceOptions::default(), &alone()).unwrap();
    let options = DexelOptions { rule: Rule::Sampled, ..DexelOptions::default() };
    let dexels = dexelize(&ball, &frame, &options, &alone()).unwrap();
    let surface = DexelSolid::new(dexels.view(), &alone()).unwrap();
    let mesh = solid(globe(40, 60, |_| 1.0, 0.0));
    // (Chords of the mesh lie within the ball.)
    let sagitta = 1.0 - (PI / 40.0).cos() * (PI / 60.0).cos();
    let whole: [(&str, AnySolid, f64); 5] = [
        ("expression", AnySolid::new(ball.clone()), 0.05),
        ("extended octree", AnySolid::new(kept), 0.05),
        ("mesh", AnySolid::new(mesh), 0.05),
        ("octree", AnySolid::new(tree), 5.0 * diagonal),
        ("dexels", AnySolid::new(surface.as_truth()), 0.05),
    ];
    for (name, solid, width) in &whole {
        let found = ask(solid, &other, &frame, 0.05);
        let rest = match *name {
            "mesh" => sagitta,
            "dexels" => 2.0 * frame.cell_size(),
            _ => 1e-12,
        };
        for way in [found.a_to_b, found.b_to_a] {
            let (lower, upper) = (way.distance.lower, way.distance.upper);
            assert!(lower <= 0.25 + rest && upper >= 0.25 - 1e-12, "{name} {found:?}");
            assert!(upper - lower <= *width, "{name}: {} {found:?}", upper - lower);
        }
        // Two forms of the same solid.
        let found = ask(solid, &ball, &frame, 0.05);
        assert!(found.distance().lower <= rest && found.distance().upper <= width + rest, "{name} {found:?}");
    }
    // Unproven points may lie anywhere.
    let found = ask(&surface, &ball, &frame, 0.05);
    assert!(found.distance().lower == 0.0 && found.distance().upper == f64::INFINITY, "{found:?}");
}

fn any_point(random: &mut Random, size: f64) -> Point {
    [0; 3].map(|_| random.between(-size, size))
}

/// A random body in a ball of radius 1.2.
fn any_body(random: &mut Random) -> Csg {
    let size = 0.2 + 0.3 * random.unit();
    let body = match (random.unit() * 5.0) as usize {
        0 => Csg::ball([0.0; 3], size),
        1 => Csg::cuboid([-size, -0.3, -0.4], [size, 0.3, 0.25]),
        2 => Csg::cylinder(size, -0.4, 0.5),
        3 => Csg::frustum(size, 0.5 * size, -0.3, 0.4),
        _ => Csg::torus(0.5, 0.15 + 0.2 * size),
    };
    let (mut turn, at) = (any_point(random, PI), any_point(random, 0.5));
    if random.unit() < 0.3 {
        turn = [0.0; 3];
    }
    let (s, c) = turn[0].sin_cos();
    let about_z = Affine::new([[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]).unwrap();
    let (s, c) = turn[1].sin_cos();
    let about_x = Affine::new([[1.0, 0.0, 0.0, at[0]], [0.0, c, -s, at[1]], [0.0, s, c, at[2]]]).unwrap();
    body.unwrap().placed(&about_z).unwrap().placed(&about_x).unwrap()
}

fn any_part(random: &mut Random) -> Csg {
    let (one, other) = (any_body(random), any_body(random));
    match (random.unit() * 3.0) as usize {
        0 => one,
        1 => Csg::union_of([one, other]).unwrap(),
        _ => one.difference(&other).unwrap(),
    }
}

/// Compares random solids with points that rays find on their boundaries. Another query returns the distances
/// of these points.
#[test]
fn random_solids_beside_rays() {
    let mut random = Random(7);
    let frame = around(2.0, 14);
    let coarse = around(2.0, 6);
    let (to, mut seen) = (DistanceTo::Boundary, 0);
    for round in 0..repeated(6, 12) {
        let (a, b) = (any_part(&mut random), any_part(&mut random));
        let stored = |solid: &Csg| match round % 3 {
            0 => AnySolid::new(solid.clone()),
            1 => AnySolid::new(build(solid, &coarse, Rule::Certified, &alone()).unwrap()),
            _ => AnySolid::new(build_extended(solid, &coarse, &SurfaceOptions::default(), &alone()).unwrap()),
        };
        let frame = if round % 3 == 0 { frame } else { coarse };
        let (told_a, told_b) = (stored(&a), stored(&b));
        let found = ask(&told_a, &told_b, &frame, 0.03);
        let ways: Vec<(Point, Point)> =
            (0..400).map(|_| (any_point(&mut random, 1.9), any_point(&mut random, 1.0))).collect();
        let fine = around(2.0, 20);
        for (way, from, other) in [(found.a_to_b, &a, &b), (found.b_to_a, &b, &a)] {
            // The boundary lies between the ends of the proven inside and of the proven outside.
            let mut points = vec![];
            for &(origin, way) in &ways {
                let spans = ray_spans(from, &fine, &Ray::new(origin, way).unwrap(), &alone()).unwrap();
                for outer in &spans.outer {
                    let mut within = spans
                        .inner
                        .iter()
                        .filter(|inner| outer.lower <= inner.lower && inner.upper <= outer.upper);
                    let (Some(inner), None) = (within.next(), within.next()) else { continue };
                    for (t, until) in [(outer.lower, inner.lower), (inner.upper, outer.upper)] {
                        if t > 0.0 && until - t < 1e-6 {
                            points.push([0, 1, 2].map(|axis| origin[axis] + t * way[axis]));
                        }
                    }
                }
            }
            seen += points.len();
            for near in distances(other, &fine, &points, to, 1e-4, &alone()).unwrap() {
                let least = near.distance.lower.max(-near.distance.upper);
                assert!(least - 1e-5 <= way.distance.upper, "{round}: {least} {way:?}");
            }
            if let Some(at) = way.at {
                let of = |solid: &Csg| {
                    distances(solid, &fine, &[at.point], to, 1e-5, &alone()).unwrap()[0].distance
                };
                let (own, there) = (of(from), of(other));
                assert!(own.lower.max(-own.upper) <= at.apart, "{round}: {own:?} {at:?}");
                assert!(
                    there.upper.max(-there.lower) + at.apart >= way.distance.lower,
                    "{round}: {there:?} {at:?}"
                );
            }
        }
    }
    assert!(seen > 300, "{seen}");
}

#[test]
fn nothing_everything_and_the_same() {
    let frame = around(2.0, 8);
    let (none, all) = (Csg::empty(), Csg::everything());
    let ball = Csg::ball([0.0; 3], 1.0).unwrap();
    let infinite = Interval::exactly(f64::INFINITY);
    let zero = Interval::exactly(0.0);
    let found = ask(&none, &ball, &frame, 0.01);
    assert_eq!((found.a_to_b.distance, found.b_to_a.distance), (zero, infinite));
    assert_eq!((found.within(1e300), found.clipped), (Within::No, [false; 2]));
    assert_eq!(ask(&none, &none, &frame, 0.0).distance(), zero);
    let found = ask(&ball, &ball, &frame, 0.0);
    assert_eq!((found.distance(), found.within(0.0), found.splits), (zero, Within::Yes, [0; 2]));
    let mesh = solid(prism(20, 1.0, -1.0, 1.0, 0.0));
    assert_eq!(ask(&mesh, &mesh.clone(), &frame, 0.0).distance(), zero);
    // The complement has the same boundary, up to the cells.
    let found = ask(&ball, &ball.complement(), &frame, 0.02);
    assert!(found.distance().lower == 0.0 && found.distance().upper <= 0.02, "{found:?}");
    // Everything has no boundary in the universe, and perhaps one right outside of it.
    let found = ask(&ball, &all, &frame, 0.01);
    assert!(found.a_to_b.distance.upper == f64::INFINITY && found.clipped[1], "{found:?}");
    assert_eq!(found.b_to_a.distance, zero);
}

#[test]
fn what_goes_on_outside_of_the_universe() {
    // Two slabs. One ends inside the universe.
    let frame = around(1.0, 10);
    let a = Csg::cuboid([-5.0, -5.0, -5.0], [5.0, 5.0, 0.25]).unwrap();
    let b = Csg::cuboid([-5.0, -5.0, -5.0], [5.0, 5.0, 0.75]).unwrap();
    let found = ask(&a, &b, &frame, 0.01);
    assert_eq!(found.clipped, [true; 2]);
    assert!(found.a_to_b.distance.contains(0.5) && found.b_to_a.distance.contains(0.5));
    assert!(found.a_to_b.distance.upper < 0.52, "{found:?}");
}

#[test]
fn budgets_refusals_and_threads() {
    let frame = around(2.0, 12);
    let (a, b) = (Csg::ball([0.0; 3], 1.0).unwrap(), Csg::ball([0.25, 0.0, 0.0], 1.0).unwrap());
    let mut last = f64::INFINITY;
    for most in [0, 1, 100, 10_000] {
        let control = Control { max_splits: Some(most), ..alone() };
        let found = deviation(&a, &b, &frame, 0.0, &control).unwrap();
        assert!(
            found.splits.iter().all(|&splits| splits <= most) && found.distance().contains(0.25),
            "{found:?}"
        );
        assert_eq!(found.stop_reason, StopReason::Budget);
        assert!(most == 1 || found.distance().width() <= last);
        last = found.distance().width();
    }
    assert!(last < 0.01, "{last}");
    let control = Control { max_bytes: Some(1 << 20), ..alone() };
    let found = deviation(&a, &b, &frame, 1e-6, &control).unwrap();
    assert!(found.distance().contains(0.25) && found.stop_reason == StopReason::Budget);
    for wrong in [-1.0, f64::NAN] {
        let refused = deviation(&a, &b, &frame, wrong, &alone());
        assert!(matches!(refused, Err(Error::Argument { name: "tolerance", .. })));
    }
    let cancel = AtomicBool::new(true);
    let control = Control { cancel: Some(&cancel), ..Control::default() };
    assert!(matches!(deviation(&a, &b, &frame, 0.1, &control), Err(Error::Cancelled)));
    // A solid that does not exist on this frame.
    let tree = build(&a, &around(2.0, 5), Rule::Certified, &alone()).unwrap();
    assert!(matches!(deviation(&tree, &b, &around(3.0, 5), 0.1, &alone()), Err(Error::FrameMismatch { .. })));
    // The same for any number of threads.
    let meshes = [solid(globe(20, 30, bumpy(0.1), 0.0)), solid(globe(24, 37, bumpy(0.1), 0.3))];
    let one = deviation(&meshes[0], &meshes[1], &frame, 1e-9, &Control::threads(1)).unwrap();
    assert_eq!(deviation(&meshes[0], &meshes[1], &frame, 1e-9, &Control::threads(3)).unwrap(), one);
}
