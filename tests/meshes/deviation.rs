//! Meshes that deviate from the true boundary, compared with true solids of known formulas.

use crate::shapes::{Soup, block, mesh, prism};
use leafless::error::MeshError;
use leafless::mesh::{MeshHistory, MeshMoments, MeshReport};
use leafless::query::{
    DistanceTo, Obstacle, Overlap, Region, SectionPlane, bounding_box, cast_rays, classify_box, clearance,
    deviation, distances, interference, ray_spans, section_area, surface_area, volume_in,
};
use leafless::{
    Affine, Bounds, Control, Csg, Error, FillRule, Frame, Interval, Membership, MeshSolid, Octree, Ray, Rule,
    Solid, SurfaceOptions, TriangleMesh, build, build_extended, contains, intersection, measure, union,
};
use leafless_testkit::{Random, alone, repeated};
use std::f64::consts::PI;

type Point = [f64; 3];

fn length(p: Point) -> f64 {
    p.iter().map(|c| c * c).sum::<f64>().sqrt()
}

fn minus(p: Point, q: Point) -> Point {
    [0, 1, 2].map(|k| p[k] - q[k])
}

/// A ball of radius 1 around the origin. The corners lie on the ball, the chords inside it.
fn ball_soup(around: usize, down: usize) -> Soup {
    let at = |i: usize, j: usize| {
        let (u, v) = (2.0 * PI * (i % around) as f64 / around as f64, PI * j as f64 / down as f64);
        if j == 0 || j == down {
            return [0.0, 0.0, v.cos().signum()];
        }
        [v.sin() * u.cos(), v.sin() * u.sin(), v.cos()]
    };
    let mut soup = Soup::new();
    for i in 0..around {
        for j in 0..down {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            if j + 1 < down {
                soup.push([a, b, c]);
            }
            if j > 0 {
                soup.push([a, c, d]);
            }
        }
    }
    soup
}

/// Returns the distance that a ball of radius 1 reaches beyond the triangles, with a small margin.
fn deflection(soup: &Soup) -> f64 {
    let depth = soup.iter().map(|&[a, b, c]| {
        let (u, v) = (minus(b, a), minus(c, a));
        let n = [0, 1, 2].map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
        (0..3).map(|k| n[k] * a[k]).sum::<f64>().abs() / length(n)
    });
    (1.0 - depth.fold(1.0, f64::min)) * (1.0 + 1e-9)
}

/// A cylinder of radius 20 and height 30, in the fewest segments that a deflection of one half allows.
fn cylinder() -> TriangleMesh {
    let segments = (PI / (1.0 - 0.5 / 20.0f64).acos()).ceil() as usize;
    let polygon: Vec<[f64; 2]> = (0..segments)
        .map(|i| 2.0 * PI * i as f64 / segments as f64)
        .map(|angle| [20.0 * angle.cos(), 20.0 * angle.sin()])
        .collect();
    mesh(&prism(&polygon, [0.0; 2], 0.0, 30.0))
}

fn solid(mesh: TriangleMesh) -> MeshSolid {
    MeshSolid::new(mesh, FillRule::NonZero).unwrap()
}

fn is_inside<S: Solid>(solid: &S, frame: &Frame, points: &[Point]) -> Vec<Membership> {
    let mut answers = vec![Membership::Undecided; points.len()];
    contains(solid, frame, points, &mut answers, &alone()).unwrap();
    answers
}

#[test]
fn what_is_stated() {
    let block = || mesh(&block([0.0; 3], [1.0; 3]));
    for wrong in [-0.1, f64::NAN, f64::INFINITY, 2f64.powi(256).next_up()] {
        let error = block().with_deviation(wrong).unwrap_err();
        assert!(matches!(error, Error::Argument { name: "deviation", .. }), "{error}");
    }
    assert_eq!(block().deviation(), 0.0);
    let stated = block().with_deviation(0.25).unwrap();
    assert_eq!((stated.deviation(), stated.displacement()), (0.25, 0.25));
    assert_eq!(stated.report().unwrap(), MeshReport { displacement: 0.0, ..block().report().unwrap() });
    assert_eq!(stated.try_clone().unwrap().deviation(), 0.25);
    assert_eq!(stated.translated([0.5, 0.0, 0.0]).unwrap().deviation(), 0.25);
    assert_eq!(stated.try_clone().unwrap().sewn().unwrap().deviation(), 0.25);
    assert_eq!(stated.transformed(|p| p).unwrap().deviation(), 0.0);
    assert_eq!(stated.try_clone().unwrap().with_deviation(0.0).unwrap().displacement(), 0.0);
    // A rotation keeps lengths. A map along the axes stretches by its greatest factor.
    let turn = Affine::new([[0.6, -0.8, 0.0, 0.1], [0.8, 0.6, 0.0, 0.2], [0.0, 0.0, 1.0, 0.3]]).unwrap();
    let turned = stated.placed(&turn).unwrap();
    assert!((0.25..0.2500001).contains(&turned.deviation()) && turned.displacement() > turned.deviation());
    let stretch = Affine::new([[3.0, 0.0, 0.0, 0.0], [0.0, -0.5, 0.0, 0.0], [0.0, 0.0, 2.0, 0.0]]).unwrap();
    assert!((0.75..0.7500001).contains(&stated.placed(&stretch).unwrap().deviation()));
    // The tiniest and the largest maps do not lose it.
    for factor in [1e-19, 1e19] {
        let scale = [0, 1, 2].map(|k| [0, 1, 2, 3].map(|j| if j == k { factor } else { 0.0 }));
        let scaled = stated.placed(&Affine::new(scale).unwrap()).unwrap().deviation();
        assert!(scaled >= 0.25 * factor && scaled < 0.2500001 * factor, "{scaled}");
    }
    // Solids with different deviations are distinguished.
    let print = |mesh: TriangleMesh| solid(mesh).fingerprint().unwrap();
    assert_ne!(print(block()), print(block().with_deviation(0.25).unwrap()));
    assert_eq!(print(block()), print(block().with_deviation(0.0).unwrap()));
}

#[test]
fn a_mesh_that_is_made_again_proves_no_more() {
    let turn = Affine::new([[0.6, -0.8, 0.0, 0.1], [0.8, 0.6, 0.0, 0.2], [0.0, 0.0, 1.0, 0.3]]).unwrap();
    let block = mesh(&block([0.0; 3], [1.0; 3])).with_deviation(0.25).unwrap().placed(&turn).unwrap();
    let again = TriangleMesh::new(block.vertices().to_vec(), block.triangles().to_vec()).unwrap();
    assert!(again.report().unwrap().welded == 0 && again.displacement() == 0.0);
    let again = again.with_history(block.history()).unwrap();
    assert_eq!(again.report().unwrap(), block.report().unwrap());
    assert_eq!((again.deviation(), again.displacement()), (block.deviation(), block.displacement()));
    let moments = |mesh: &TriangleMesh| mesh.moments(FillRule::NonZero, &alone()).unwrap();
    assert_eq!(moments(&again), moments(&block));
    for wrong in [-0.1, f64::NAN, f64::INFINITY] {
        let moved = MeshHistory { displacement: wrong, ..block.history() };
        let stated = MeshHistory { deviation: wrong, ..block.history() };
        for (history, argument) in [(moved, "displacement"), (stated, "deviation")] {
            let error = block.clone().with_history(history).unwrap_err();
            assert!(matches!(error, Error::Argument { name, .. } if name == argument), "{error}");
        }
    }
}

#[test]
fn open_meshes_are_refused() {
    let mut soup = block([0.0; 3], [1.0; 3]);
    soup.pop();
    let open = || mesh(&soup);
    MeshSolid::new(open(), FillRule::NonZero).unwrap();
    let refused = MeshSolid::new(open().with_deviation(0.1).unwrap(), FillRule::NonZero).err();
    assert!(matches!(refused, Some(Error::Mesh(MeshError::Open { edges: 3 }))), "{refused:?}");
}

/// The volume of the true cylinder is 12000 π. The mesh has a smaller volume.
#[test]
fn a_cylinder_in_chords() {
    let truth = PI * 400.0 * 30.0;
    let moments = |mesh: &TriangleMesh| match mesh.moments(FillRule::NonZero, &alone()).unwrap() {
        MeshMoments::Known(moments) => moments,
        other => panic!("{other:?}"),
    };
    let (plain, stated) = (cylinder(), cylinder().with_deviation(0.5).unwrap());
    assert!(!moments(&plain).volume.contains(truth), "the truth is not that of the mesh");
    let volume = moments(&stated).volume;
    assert!(volume.contains(truth) && volume.width() < 0.22 * truth, "{volume:?}");

    let frame = Frame::around([-20.5, -20.5, -0.5], [20.5, 20.5, 30.5], 7).unwrap();
    let measured = |mesh| measure(&solid(mesh), &frame, 1e-3, &alone()).unwrap();
    assert!(!measured(cylinder()).volume.contains(truth));
    let found = measured(stated);
    assert!(found.volume.contains(truth));
    let centroid = found.centroid.unwrap();
    assert!(centroid[0].contains(0.0) && centroid[1].contains(0.0) && centroid[2].contains(15.0));

    // Between chord and arc, and well to either side.
    let angle = PI / (PI / (1.0 - 0.5 / 20.0f64).acos()).ceil();
    let at = |radius: f64| [radius * angle.cos(), radius * angle.sin(), 11.0];
    let between = [at(19.9), at(19.99), at(19.6)];
    assert_eq!(is_inside(&solid(cylinder()), &frame, &between), [Membership::Outside; 3]);
    let answers = is_inside(&solid(cylinder().with_deviation(0.5).unwrap()), &frame, &between);
    assert_eq!(answers, [Membership::Undecided; 3]);
    let answers = is_inside(&solid(cylinder().with_deviation(0.5).unwrap()), &frame, &[at(18.5), at(20.6)]);
    assert_eq!(answers, [Membership::Inside, Membership::Outside]);

    for deviation in [0.0, 0.5] {
        let solid = solid(cylinder().with_deviation(deviation).unwrap());
        let certified = build(&solid, &frame, Rule::Certified, &alone()).unwrap();
        let options = SurfaceOptions { tolerance: Some(0.75) };
        let extended = build_extended(&solid, &frame, &options, &alone()).unwrap();
        let exact = build_extended(&solid, &frame, &SurfaceOptions::default(), &alone()).unwrap();
        for tree in [&certified, &extended, &exact] {
            assert_eq!(tree.proof().displacement(), deviation);
            let volume = measure(tree, &frame, 1e-4, &alone()).unwrap().volume;
            // (Where cells are large, the bounds of the mesh itself may contain the truth by chance.)
            assert!(deviation == 0.0 || volume.contains(truth), "{volume:?}");
            check_points(tree, &frame, deviation > 0.0);
        }
        let inner = build(&solid, &frame, Rule::Inner, &alone()).unwrap().statistics().volume().upper;
        assert!(deviation == 0.0 || inner < truth);
    }
}

/// Faces of two solids lie in one plane as far as their meshes show. Either solid may reach beyond the other.
#[test]
fn contacts_are_not_decided() {
    let stated = |low: f64, deviation: f64| {
        solid(mesh(&block([0.0, 0.0, low], [1.0, 1.0, low + 1.0])).with_deviation(deviation).unwrap())
    };
    let frame = Frame::new([-1.0; 3], 4.0, 6).unwrap();
    let options = SurfaceOptions { tolerance: Some(0.5) };
    let kept = |solid: &MeshSolid| build_extended(solid, &frame, &options, &alone()).unwrap();
    for (deviation, least) in [(0.0, Overlap::Disjoint), (0.05, Overlap::Undecided)] {
        let (a, b) = (stated(0.0, deviation), stated(1.0, deviation));
        let (kept_a, kept_b) = (kept(&a), kept(&b));
        let found = [
            interference(&a, &b, &frame, 1e-3, &alone()).unwrap(),
            interference(&kept_a, &kept_b, &frame, 1e-3, &alone()).unwrap(),
            interference(&a, &kept_b, &frame, 1e-3, &alone()).unwrap(),
        ];
        // Each may be larger by the deviation all around.
        let (common, side) = (2.0 * deviation, 1.0 + 2.0 * deviation);
        for found in found {
            assert_eq!(found.verdict, least);
            assert!(found.volume.contains(0.0) && found.volume.contains(common * side * side));
        }
        let gap = clearance(&a, &b, &frame, 1e-3, &alone()).unwrap().distance;
        assert!(gap.contains(0.0) && gap.contains(common), "{gap:?}");
        let both = intersection(kept_a.view(), kept_b.view(), &alone()).unwrap();
        let volume = measure(&both, &frame, 1e-3, &alone()).unwrap().volume;
        assert!(volume.contains(0.0) && volume.contains(common * side * side), "{volume:?}");
        let whole = union(kept_a.view(), kept_b.view(), &alone()).unwrap();
        let volume = measure(&whole, &frame, 1e-3, &alone()).unwrap().volume;
        // The solids may have a gap, too.
        let small = 1.0 - common;
        assert!(
            volume.contains(2.0 * small.powi(3))
                && volume.contains(2.0 * side.powi(3) - common * side * side)
        );
        let point = [0.5, 0.5, 1.0];
        let inside = is_inside(&whole, &frame, &[point])[0];
        assert!(deviation == 0.0 || inside == Membership::Undecided, "{inside:?}");
        // The boundary of another solid of the same mesh may also lie elsewhere.
        let apart = deviation_between(&a, &stated(0.0, deviation), &frame);
        assert!(apart.lower == 0.0 && apart.upper >= common, "{apart:?}");
    }
}

fn deviation_between(a: &MeshSolid, b: &MeshSolid, frame: &Frame) -> Interval {
    let found = deviation(a, b, frame, 1e-3, &alone()).unwrap();
    found.a_to_b.distance.joined(found.b_to_a.distance)
}

/// Checks that no point of the cylinder is reported outside, and no point beside it inside.
fn check_points(tree: &Octree, frame: &Frame, is_stated: bool) {
    let mut random = Random(8);
    let points: Vec<Point> = (0..2000)
        .map(|_| {
            let (angle, radius) = (random.between(0.0, 2.0 * PI), random.between(18.0, 21.0));
            [radius * f64::cos(angle), radius * f64::sin(angle), random.between(-0.4, 30.4)]
        })
        .collect();
    for (point, answer) in points.iter().zip(is_inside(tree, frame, &points)) {
        let truth = point[0].hypot(point[1]) < 20.0 && (0.0..30.0).contains(&point[2]);
        let wrong = if truth { Membership::Outside } else { Membership::Inside };
        assert!(!is_stated || answer != wrong, "{point:?} {answer:?}");
    }
}

/// A faceted ball under a placement that keeps it a ball.
struct Placed {
    solid: MeshSolid,
    centre: Point,
    radius: f64,
}

fn placed_ball(random: &mut Random, size: [usize; 2]) -> Placed {
    let soup = ball_soup(size[0], size[1]);
    let stated = mesh(&soup).with_deviation(deflection(&soup)).unwrap();
    let (radius, centre) = (random.between(0.5, 2.0), [0; 3].map(|_| random.between(-1.0, 1.0)));
    // Two turns about axes, and perhaps a mirror.
    let (s, c) = random.between(0.0, 7.0).sin_cos();
    let (t, d) = random.between(0.0, 7.0).sin_cos();
    let sign = if random.between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
    let turn = [[c, -s * d, s * t], [s, c * d, -c * t], [0.0, t, d]];
    let rows = [0, 1, 2].map(|k| {
        let [x, y, z] = turn[k].map(|entry| radius * entry);
        [sign * x, sign * y, sign * z, centre[k]]
    });
    let placed = stated.placed(&Affine::new(rows).unwrap()).unwrap();
    assert!(placed.deviation() < radius * stated.deviation() * 1.000001);
    Placed { solid: solid(placed), centre, radius }
}

/// Returns the span of a ray in the ball.
fn span_of(ball: &Placed, from: Point, way: Point) -> Option<[f64; 2]> {
    let to = minus(ball.centre, from);
    let dot = |p: Point, q: Point| (0..3).map(|k| p[k] * q[k]).sum::<f64>();
    let (along, size) = (dot(to, way), dot(way, way));
    let root = along * along - size * (dot(to, to) - ball.radius * ball.radius);
    (root > 0.0).then(|| [(along - root.sqrt()) / size, (along + root.sqrt()) / size])
}

/// Checks that each answer for the mesh is true of the ball, and that there are answers.
fn check_ball(random: &mut Random, size: [usize; 2]) {
    const SLOP: f64 = 1e-9;
    let ball = placed_ball(random, size);
    let Placed { solid, centre, radius } = &ball;
    let (centre, radius) = (*centre, *radius);
    let frame = Frame::new([-8.0; 3], 16.0, 12).unwrap();
    let depth_of = |p: Point| radius - length(minus(p, centre));
    let off = solid.mesh().deviation();
    let point = |random: &mut Random| [0; 3].map(|_| random.between(-3.5, 3.5));
    // Many of them near the boundary.
    let near = |random: &mut Random| {
        let way = [0; 3].map(|_| random.between(-1.0, 1.0));
        let far = radius + random.between(-3.0, 3.0) * off;
        [0, 1, 2].map(|k| centre[k] + way[k] / length(way) * far)
    };

    let points: Vec<Point> = (0..60).map(|i| if i % 2 == 0 { point(random) } else { near(random) }).collect();
    for (&p, answer) in points.iter().zip(is_inside(solid, &frame, &points)) {
        match answer {
            Membership::Inside => assert!(depth_of(p) > -SLOP),
            Membership::Outside => assert!(depth_of(p) < SLOP),
            // (For a ray along an axis or a diagonal, the exit is undecided only near edges.)
            Membership::Undecided => assert!(depth_of(p).abs() < 8.0 * off + 0.01, "{} {off}", depth_of(p)),
        }
    }

    for to in [DistanceTo::Boundary, DistanceTo::Solid, DistanceTo::Complement] {
        let found = distances(solid, &frame, &points, to, 1e-6, &alone()).unwrap();
        for (&p, found) in points.iter().zip(found) {
            let truth = match to {
                DistanceTo::Complement => depth_of(p).max(0.0),
                DistanceTo::Boundary => -depth_of(p),
                DistanceTo::Solid => (-depth_of(p)).max(0.0),
            };
            let (lower, upper) = (found.distance.lower, found.distance.upper);
            let is_within = |truth: f64| lower <= truth + SLOP && truth - SLOP <= upper;
            assert!(is_within(truth) || to == DistanceTo::Boundary && is_within(-truth), "{found:?} {truth}");
        }
    }

    for k in 0..40 {
        let (from, aim) = (point(random), if k % 2 == 0 { point(random) } else { near(random) });
        let way = minus(aim, from);
        let ray = Ray::new(from, way).unwrap();
        let truth = span_of(&ball, from, way).filter(|span| span[1] > 0.0);
        let spans = ray_spans(solid, &frame, &ray, &alone()).unwrap();
        for inner in &spans.inner {
            let [begin, end] = truth.expect("proven inside where nothing is");
            assert!(begin <= inner.lower + SLOP && inner.upper <= end + SLOP, "{spans:?} {truth:?}");
        }
        if let Some([begin, end]) = truth {
            let begin = begin.max(0.0);
            let is_covered =
                spans.outer.iter().any(|outer| outer.lower <= begin + SLOP && end - SLOP <= outer.upper);
            assert!(is_covered, "{spans:?} {truth:?}");
        }
        for obstacle in [Obstacle::Full, Obstacle::Upper] {
            let hit = cast_rays(solid, &frame, &[ray], obstacle, &alone()).unwrap()[0];
            match (hit, truth) {
                (Some(hit), Some([begin, _])) => {
                    let begin = begin.max(0.0);
                    assert!(hit.t.lower <= begin + SLOP && begin - SLOP <= hit.t.upper, "{hit:?} {begin}");
                }
                (Some(hit), None) => assert_eq!(hit.t.upper, f64::INFINITY),
                (None, Some([begin, end])) => {
                    assert!(obstacle == Obstacle::Full, "missed {begin} {end}");
                }
                (None, None) => {}
            }
        }
    }

    for _ in 0..40 {
        let (middle, half) = (near(random), [0; 3].map(|_| random.between(0.0, 0.4)));
        let (min, max) = ([0, 1, 2].map(|k| middle[k] - half[k]), [0, 1, 2].map(|k| middle[k] + half[k]));
        let nearest = [0, 1, 2].map(|k| centre[k].clamp(min[k], max[k]));
        let corners = (0..8).map(|i| [0, 1, 2].map(|k| if i >> k & 1 != 0 { max[k] } else { min[k] }));
        let deepest = depth_of(nearest);
        let least = corners.map(depth_of).fold(f64::INFINITY, f64::min);
        match classify_box(solid, &frame, min, max, &alone()).unwrap() {
            Region::Inside => assert!(least > -SLOP),
            Region::Outside => assert!(deepest < SLOP),
            Region::Crossing => assert!(deepest > -SLOP && least < SLOP),
            Region::Undecided => {}
        }
    }

    let whole = measure(solid, &frame, 1e-3, &Control { max_splits: Some(2000), ..alone() }).unwrap();
    let volume = 4.0 / 3.0 * PI * radius.powi(3);
    assert!(whole.volume.contains(volume), "{whole:?}");
    // (For the coarsest mesh, possibly no point is proven inside.)
    if let Some(centroid) = whole.centroid {
        assert!((0..3).all(|k| centroid[k].contains(centre[k])), "{centroid:?} {centre:?}");
    }
    let few = Control { max_splits: Some(2000), ..alone() };
    let area = surface_area(solid, &frame, 1e-2, &few).unwrap().area;
    assert!(area.contains(4.0 * PI * radius * radius), "{area:?}");
    assert_eq!(area.upper, f64::INFINITY, "a boundary may wave");
    let bounds = bounding_box(solid, &frame, 1e-3, &few).unwrap();
    if let Some([low, high]) = bounds.corners {
        for k in 0..3 {
            assert!(
                low[k].contains(centre[k] - radius) && high[k].contains(centre[k] + radius),
                "{bounds:?}"
            );
        }
    }
    let plane = SectionPlane::new(centre, [1.0, 2.0, 3.0]).unwrap();
    let section = section_area(solid, &frame, &plane, 1e-2, &few).unwrap().area;
    assert!(section.contains(PI * radius * radius), "{section:?}");
    let half = Csg::cuboid([-8.0; 3], [centre[0], 8.0, 8.0]).unwrap();
    let coarse = Frame::new([-8.0; 3], 16.0, 6).unwrap();
    let content = volume_in(solid, &half, &coarse, &alone()).unwrap();
    assert!(content.contains(0.5 * volume), "{content:?}");

    let truth = Csg::ball(centre, radius).unwrap();
    let few = Control { max_splits: Some(500), ..alone() };
    let found = deviation(solid, &truth, &coarse, 1e-2, &few).unwrap();
    assert!(found.a_to_b.distance.lower <= SLOP && found.b_to_a.distance.lower <= SLOP, "{found:?}");
    let other = placed_ball(random, [size[1] + 3, size[0] + 3]);
    let gap = (length(minus(other.centre, centre)) - radius - other.radius).max(0.0);
    let told = clearance(solid, &other.solid, &frame, 1e-3, &few).unwrap().distance;
    assert!(told.lower <= gap + SLOP && gap - SLOP <= told.upper, "{told:?} {gap}");
    // Another one that is further away.
    let beside = Csg::ball([centre[0] + 3.0 * radius, centre[1], centre[2]], 0.5 * radius).unwrap();
    let told = clearance(solid, &beside, &frame, 1e-3, &few).unwrap().distance;
    assert!(told.lower <= 1.5 * radius + SLOP && 1.5 * radius - SLOP <= told.upper, "{told:?}");
    match interference(solid, &other.solid, &coarse, 1e-2, &few).unwrap().verdict {
        Overlap::Disjoint => {
            assert!(gap > -SLOP && length(minus(other.centre, centre)) >= radius + other.radius - SLOP)
        }
        Overlap::Overlapping => assert_eq!(gap, 0.0),
        Overlap::Undecided => {}
    }

    let certified = build(solid, &coarse, Rule::Certified, &alone()).unwrap();
    assert!(certified.statistics().volume().contains(volume));
    let options = SurfaceOptions { tolerance: Some(2.0 * off + 1e-3) };
    let extended = build_extended(solid, &coarse, &options, &alone()).unwrap();
    assert!(measure(&extended, &coarse, 1e-2, &few).unwrap().volume.contains(volume));
    for (&p, answer) in points.iter().zip(is_inside(&extended, &coarse, &points)) {
        let wrong = if depth_of(p) > 0.0 { Membership::Outside } else { Membership::Inside };
        assert!(answer != wrong || depth_of(p).abs() < SLOP, "{p:?}");
    }
    let bounds = solid.bounds().unwrap();
    let truth = Bounds::new(centre.map(|c| c - radius), centre.map(|c| c + radius)).unwrap();
    assert!((0..3).all(|k| bounds.min[k] <= truth.min[k] + SLOP && truth.max[k] - SLOP <= bounds.max[k]));
}

#[test]
fn balls_in_chords_under_any_placement() {
    let mut random = Random(31);
    // (Coarser meshes take longer.)
    for size in [[4, 2], [5, 3], [8, 4], [12, 7], [24, 12]].into_iter().skip(repeated(3, 0)) {
        check_ball(&mut random, size);
    }
}
