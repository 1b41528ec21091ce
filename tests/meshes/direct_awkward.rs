//! Extreme cases of answers without cells: empty lists, infinite numbers, all sizes and places of meshes,
//! triangles without area, and bodies at the same place.

use crate::oracle::PointOracle;
use crate::shapes::{self, Soup};
use leafless::query::{DistanceTo, Obstacle, RayHit, RaySpans, Sight};
use leafless::query::{distances, line_of_sight, ray_spans};
use leafless::{
    Control, Error, FillRule, Frame, Membership, MeshSolid, Ray, TriangleMesh, cast_rays, contains,
};
use leafless_testkit::{Random, alone};
use std::sync::atomic::AtomicBool;

type Point = [f64; 3];

fn solid(soup: &Soup, fill: FillRule) -> MeshSolid {
    MeshSolid::new(shapes::mesh(soup), fill).unwrap()
}

fn frame() -> Frame {
    Frame::new([-8.0; 3], 16.0, 6).unwrap()
}

fn ray(from: Point, way: Point) -> Ray {
    Ray::new(from, way).unwrap()
}

fn first(solid: &MeshSolid, frame: &Frame, ray: Ray) -> Option<RayHit> {
    let full = cast_rays(solid, frame, &[ray], Obstacle::Full, &alone()).unwrap()[0];
    let upper = cast_rays(solid, frame, &[ray], Obstacle::Upper, &alone()).unwrap()[0];
    assert_eq!(full.is_some(), upper.is_some(), "{full:?} {upper:?}");
    assert_eq!(full.map(|hit| hit.t), upper.map(|hit| hit.t));
    full
}

fn member(solid: &MeshSolid, frame: &Frame, point: Point) -> Membership {
    let mut answers = [Membership::Undecided];
    contains(solid, frame, &[point], &mut answers, &alone()).unwrap();
    answers[0]
}

#[test]
fn nothing_is_asked() {
    let solid = solid(&shapes::block([0.0; 3], [1.0; 3]), FillRule::NonZero);
    assert!(cast_rays(&solid, &frame(), &[], Obstacle::Full, &alone()).unwrap().is_empty());
    contains(&solid, &frame(), &[], &mut [], &alone()).unwrap();
    assert!(distances(&solid, &frame(), &[], DistanceTo::Solid, 0.0, &alone()).unwrap().is_empty());
}

#[test]
fn points_that_are_no_places() {
    let solid = solid(&shapes::block([-1.0; 3], [1.0; 3]), FillRule::NonZero);
    let wide = Frame::new([-1e60; 3], 2e60, 6).unwrap();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let mut p = [0.5; 3];
            p[axis] = bad;
            assert_eq!(member(&solid, &frame(), p), Membership::Undecided);
            for to in [DistanceTo::Solid, DistanceTo::Complement, DistanceTo::Boundary] {
                let found = &distances(&solid, &frame(), &[p], to, 0.0, &alone()).unwrap()[0];
                assert!(found.nearest.is_none() && found.distance.upper == f64::INFINITY);
            }
        }
    }
    for far in [1e20, 1e60, 1e300, f64::MAX] {
        for axis in 0..3 {
            let mut p = [0.5; 3];
            p[axis] = -far;
            let found = &distances(&solid, &frame(), &[p], DistanceTo::Boundary, 0.0, &alone()).unwrap()[0];
            // (The upper bound next to the greatest double is infinite.)
            assert!(found.distance.lower <= far && found.distance.upper >= far, "{far} {found:?}");
            // (Beyond 2^99 times the mesh's size, single triangles are not examined.)
            assert!(far > 1e29 || found.distance.lower >= far * (1.0 - 1e-11), "{far} {found:?}");
            let answer = member(&solid, &wide, p);
            assert!(answer != Membership::Inside);
            assert!(far > 1e59 || answer == Membership::Outside);
        }
    }
}

/// Coordinates that exact arithmetic does not take, beside a vertex with a fan of triangles.
#[test]
fn points_next_to_nothing_are_where_they_are() {
    let mut random = Random(5);
    let tiny = 5e-324;
    for round in 0..200 {
        // A double pyramid along x whose edges run in all directions from its tips.
        let mut angles: Vec<f64> = (0..9).map(|_| random.between(0.0, std::f64::consts::TAU)).collect();
        angles.extend([0.5, 1.5, 2.5, 3.5].map(|quarter| quarter * std::f64::consts::FRAC_PI_2));
        angles.sort_by(f64::total_cmp);
        let rim: Vec<Point> = (angles.iter())
            .map(|angle| {
                let radius = 2f64.powf(random.between(-3.0, 3.0));
                [0.0, radius * angle.cos(), radius * angle.sin()]
            })
            .collect();
        let mut soup = Soup::new();
        for (i, &a) in rim.iter().enumerate() {
            let b = rim[(i + 1) % rim.len()];
            soup.extend([[[1.0, 0.0, 0.0], a, b], [[-1.0, 0.0, 0.0], b, a]]);
        }
        let solid = solid(&soup, FillRule::EvenOdd);
        for _ in 0..50 {
            let small = |random: &mut Random| tiny * (random.below(41) as f64 - 20.0);
            let p = [random.between(0.55, 0.95), small(&mut random), small(&mut random)];
            let frame = Frame::new([-16.0; 3], 32.0, 12).unwrap();
            assert_eq!(member(&solid, &frame, p), Membership::Inside, "{round} {p:?}");
            let found = &distances(&solid, &frame, &[p], DistanceTo::Boundary, 1e-9, &alone()).unwrap()[0];
            assert!(found.distance.upper < 0.0 && found.nearest.is_some(), "{round} {p:?} {found:?}");
            let out = [p[0] + 0.5, p[1], p[2]];
            assert_eq!(member(&solid, &frame, out), Membership::Outside, "{round} {out:?}");
        }
    }
}

#[test]
fn a_mesh_that_begins_before_the_universe() {
    let solid = solid(&shapes::block([-3.0; 3], [3.0; 3]), FillRule::NonZero);
    // The universe cuts it. The ray is in the solid before it is in the universe.
    let frame = Frame::new([-1.0; 3], 8.0, 5).unwrap();
    let hit = first(&solid, &frame, ray([-8.0, 0.5, 0.5], [1.0, 0.0, 0.0])).unwrap();
    assert!(hit.t.contains(7.0) && hit.surface.is_none() && hit.normal == [-1.0, 0.0, 0.0], "{hit:?}");
    let sight = |from, to| line_of_sight(&solid, &frame, from, to, &alone()).unwrap();
    assert_eq!(sight([-8.0, 0.5, 0.5], [0.0, 0.5, 0.5]), Sight::Blocked);
    assert_eq!(sight([6.0, 0.5, 0.5], [4.0, 0.5, 0.5]), Sight::Clear);
    // Two bodies. The first one lies before the universe.
    let mut soup = shapes::block([-6.0, 0.0, 0.0], [-5.0, 1.0, 1.0]);
    soup.extend(shapes::block([2.0, 0.0, 0.0], [3.0, 1.0, 1.0]));
    for fill in [FillRule::NonZero, FillRule::EvenOdd, FillRule::Positive] {
        let solid = MeshSolid::new(shapes::mesh(&soup), fill).unwrap();
        let hit = first(&solid, &frame, ray([-8.0, 0.5, 0.25], [1.0, 0.0, 0.0])).unwrap();
        assert!(hit.t.contains(10.0) && hit.surface.is_some(), "{hit:?}");
    }
}

/// Triangles back to back bound nothing. The ray is already inside, and enters through the universe's face.
#[test]
fn triangles_back_to_back_in_the_face_of_the_universe() {
    let [a, b, c] = [[1.0, 1.0, 1.0], [-3.0, 1.0, -3.0], [1.0, 0.0, 1.0]];
    let mut soup = shapes::block([-3.0; 3], [3.0, 3.0, 4.0]);
    soup.extend([[a, b, c], [c, b, a]]);
    let frame = Frame::new([-2.0, -1.5, -3.0], 4.0, 5).unwrap();
    for fill in [FillRule::NonZero, FillRule::Positive] {
        let hit = first(&solid(&soup, fill), &frame, ray([9.0, 3.0, 3.0], [-2.0, -0.5, -0.5])).unwrap();
        assert!(hit.t.contains(4.0) && hit.surface.is_none() && hit.normal == [0.0, 0.0, 1.0], "{hit:?}");
    }
}

/// A block of all sizes at all places, queried with directions of all lengths from all distances.
#[test]
fn meshes_rays_and_points_of_all_sizes() {
    let sizes = [1e-70, 1e-30, 1.0, 1e30, 1e60];
    let lengths = [2f64.powi(-256), 1e-30, 1.0, 1e30, 2f64.powi(256)];
    for size in sizes {
        let soup = shapes::moved(&shapes::block([-1.0; 3], [1.0; 3]), |p| p.map(|c| c * size));
        let solid = solid(&soup, FillRule::NonZero);
        let frame = Frame::new([-4.0 * size; 3], 8.0 * size, 6).unwrap();
        for way in lengths {
            for far in [0.0, 0.5, 2.0, 1e6, 1e30, 1e60] {
                let begins = far * size;
                if begins > 1e76 {
                    continue;
                }
                let from = [-begins, 0.25 * size, 0.5 * size];
                let line = ray(from, [way, 0.0, 0.0]);
                let cast = |on| cast_rays(&solid, &frame, &[line], on, &alone()).unwrap()[0];
                let (full, upper) = (cast(Obstacle::Full), cast(Obstacle::Upper));
                let hit = upper.unwrap_or_else(|| panic!("missed: {size} {way} {far}"));
                // From far away the block is smaller than the rounding of times.
                assert!(full.is_some() || far > 1e10, "{size} {way} {far}");
                let true_t = ((begins - size) / way).max(0.0);
                let margin = 1e-12 * true_t;
                assert!(
                    hit.t.lower <= true_t + margin && hit.t.upper >= true_t - margin,
                    "{size} {way} {far} {hit:?}"
                );
                let aside = [-begins, 1.5 * size, 0.5 * size];
                assert!(first(&solid, &frame, ray(aside, [way, 0.0, 0.0])).is_none(), "{size} {way} {far}");
                let spans = ray_spans(&solid, &frame, &line, &alone()).unwrap();
                assert!(spans.outer.len() == 1 && spans.inner.len() <= 1, "{size} {way} {far}");
                assert!(spans.inner.len() == 1 || far > 1e10, "{size} {way} {far}");
            }
        }
        let inside = [0.5, -0.9, 0.25].map(|c| c * size);
        let outside = [0.5, -1.1, 0.25].map(|c| c * size);
        assert_eq!(member(&solid, &frame, inside), Membership::Inside);
        assert_eq!(member(&solid, &frame, outside), Membership::Outside);
        let found =
            distances(&solid, &frame, &[inside, outside], DistanceTo::Boundary, 0.0, &alone()).unwrap();
        for (found, truth) in found.iter().zip([-0.1 * size, 0.1 * size]) {
            let margin = 1e-11 * size;
            assert!(found.distance.width() < margin && (found.distance.lower - truth).abs() < margin);
        }
    }
}

/// A tetrahedron of all sizes, with slanted faces. Rays from its middle leave it, and rays past it miss it.
#[test]
fn slanted_triangles_of_all_sizes() {
    let mut random = Random(8);
    for size in [1e-70, 1e-40, 1.0, 1e40, 1e60] {
        for _ in 0..40 {
            let corners = [0; 4].map(|_| [0; 3].map(|_| random.between(-1.0, 1.0) * size));
            let solid = solid(&shapes::tetrahedron(corners), FillRule::NonZero);
            let frame = Frame::new([-2.0 * size; 3], 4.0 * size, 6).unwrap();
            let middle = [0, 1, 2].map(|k| corners.iter().map(|corner| 0.25 * corner[k]).sum::<f64>());
            for (i, corner) in corners.iter().enumerate() {
                let away = [0, 1, 2].map(|k| corner[k] - middle[k]);
                let RaySpans { inner, outer } =
                    ray_spans(&solid, &frame, &ray(middle, away), &alone()).unwrap();
                // It passes the corner only by rounding. In the other direction it meets the middle of the
                // opposite facet.
                assert!(inner.len() == 1 && outer.len() == 1, "{size} {corners:?} {i}");
                assert!((outer[0].upper - 1.0).abs() < 1e-9, "{size} {corners:?} {i} {outer:?}");
                let back = ray_spans(&solid, &frame, &ray(middle, away.map(|c| -c)), &alone()).unwrap();
                assert!((back.inner[0].upper - 1.0 / 3.0).abs() < 1e-9, "{size} {corners:?} {i} {back:?}");
            }
        }
    }
}

/// Coordinates around 1e9 with small fractions.
#[test]
fn meshes_far_from_the_origin() {
    let mut random = Random(9);
    let at = [1e9, -3e9, 2e9];
    let frame = Frame::new(at.map(|c| c - 4.0), 8.0, 12).unwrap();
    for _ in 0..30 {
        let soup =
            shapes::tetrahedra(&mut random, 5, |random| [0, 1, 2].map(|k| at[k] + random.between(-2.0, 2.0)));
        let mesh = TriangleMesh::from_facets(&soup).unwrap();
        let oracle = PointOracle::new(&mesh);
        let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
        for _ in 0..100 {
            let p = [0, 1, 2].map(|k| at[k] + random.between(-3.0, 3.0));
            let truth = oracle.winding(p).map(|winding| winding != 0);
            match member(&solid, &frame, p) {
                Membership::Inside => assert_ne!(truth, Some(false)),
                Membership::Outside => assert_ne!(truth, Some(true)),
                Membership::Undecided => assert_eq!(truth, None),
            }
            let away = [0, 1, 2].map(|k| p[k] - at[k]);
            let spans = ray_spans(&solid, &frame, &ray(p, away), &alone()).unwrap();
            if let Some(truth) = truth {
                let begins =
                    |spans: &[leafless::Interval]| spans.first().is_some_and(|span| span.lower == 0.0);
                assert!(!begins(&spans.inner) || truth);
                assert!(begins(&spans.outer) || !truth);
            }
        }
    }
}

/// Bodies without volume, and triangles without area, are no solid. They hide nothing.
#[test]
fn triangles_without_area() {
    let line: Soup =
        vec![[[-2.0, 0.0, 0.0], [0.0; 3], [3.0, 0.0, 0.0]], [[-2.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0; 3]]];
    let sheet: Soup =
        vec![[[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]], [[0.0; 3], [0.0, 2.0, 0.0], [2.0, 0.0, 0.0]]];
    let frame = frame();
    for flat in [&line, &sheet] {
        let alone_there = solid(flat, FillRule::NonZero);
        for way in [[0.0, 0.0, -1.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [-0.3, -0.2, -1.0]] {
            for to in [[0.0; 3], [0.5, 0.5, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]] {
                let from = [0, 1, 2].map(|k: usize| to[k] - way[k]);
                let cast = |on| cast_rays(&alone_there, &frame, &[ray(from, way)], on, &alone()).unwrap()[0];
                assert!(cast(Obstacle::Full).is_none());
                let upper = cast(Obstacle::Upper);
                let is_finite = |hit: RayHit| hit.normal.iter().all(|c| c.is_finite());
                assert!(upper.is_none_or(is_finite), "{upper:?}");
                let spans = ray_spans(&alone_there, &frame, &ray(from, way), &alone()).unwrap();
                assert!(spans.inner.is_empty());
            }
        }
        let found = distances(&alone_there, &frame, &[[5.0; 3]], DistanceTo::Solid, 0.0, &alone()).unwrap();
        assert!(found[0].nearest.is_none() && found[0].distance.upper == f64::INFINITY, "{found:?}");
        // Beside a body, it changes nothing.
        let mut soup = shapes::block([-1.0; 3], [1.0; 3]);
        soup.extend(flat.iter());
        let with_body = solid(&soup, FillRule::NonZero);
        let hit = first(&with_body, &frame, ray([5.0, 0.25, 0.125], [-1.0, 0.0, 0.0])).unwrap();
        assert!(hit.t.contains(4.0) && hit.normal == [1.0, 0.0, 0.0]);
        assert_eq!(member(&with_body, &frame, [0.25, 0.25, 0.125]), Membership::Inside);
        assert_eq!(member(&with_body, &frame, [1.5, 0.25, 0.125]), Membership::Outside);
        let found =
            &distances(&with_body, &frame, &[[0.25, 0.25, 0.5]], DistanceTo::Boundary, 1e-3, &alone());
        assert!(found.as_ref().unwrap()[0].distance.contains(-0.5), "{found:?}");
    }
}

/// Nodes of the tree have four parts. The counts are those that fill a tree, one less and one more.
#[test]
fn trees_of_all_sizes() {
    let mut random = Random(10);
    let frame = Frame::new([-4.0; 3], 128.0, 6).unwrap();
    // Bodies of four triangles, and a strip around a prism of any number of triangles.
    for count in (4..=24).chain([62, 64, 66, 254, 256, 258, 1022, 1024, 1026]).filter(|count| count % 2 == 0)
    {
        // A double pyramid has twice as many triangles as corners on its rim.
        let rim = (count / 2).max(3);
        let corner = |i: usize| {
            let angle = (i % rim) as f64 / rim as f64 * std::f64::consts::TAU;
            [4.0 + 3.0 * angle.cos(), 4.0 + 3.0 * angle.sin(), 4.0]
        };
        let soup: Soup = if count == 4 {
            shapes::tetrahedron([[1.0; 3], [7.0, 1.0, 1.5], [1.5, 7.0, 2.0], [2.0, 2.5, 7.0]])
        } else {
            let side = |i| {
                let (a, b) = (corner(i), corner(i + 1));
                [[a, b, [4.0, 4.0, 7.0]], [b, a, [4.0, 4.0, 1.0]]]
            };
            (0..rim).flat_map(side).collect()
        };
        let mesh = TriangleMesh::from_facets(&soup).unwrap();
        assert_eq!(mesh.triangles().len(), if count == 4 { 4 } else { 2 * rim });
        let oracle = PointOracle::new(&mesh);
        let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
        let mut inside = 0;
        for _ in 0..200 {
            let p = [0; 3].map(|_| random.between(0.5, 7.5));
            let truth = oracle.winding(p).unwrap() != 0;
            let expected = if truth { Membership::Inside } else { Membership::Outside };
            assert_eq!(member(&solid, &frame, p), expected);
            inside += i32::from(truth);
            let found = &distances(&solid, &frame, &[p], DistanceTo::Boundary, 0.0, &alone()).unwrap()[0];
            assert!(
                found.nearest.is_some() && (found.distance.upper < 0.0) == truth,
                "{count} {p:?} {found:?}"
            );
            let to = if count == 4 { [2.875, 2.9, 2.85] } else { [3.9, 3.8, 3.7] };
            let hit = first(&solid, &frame, ray(p, [0, 1, 2].map(|k| to[k] - p[k]))).unwrap();
            assert!((hit.t == leafless::Interval::exactly(0.0)) == truth && hit.t.upper < 1.0);
        }
        assert!(inside > 10, "{count}");
    }
}

/// The same body twice, with the same and with reversed orientation.
#[test]
fn bodies_in_the_same_place() {
    let block = shapes::block([-1.0; 3], [1.0; 3]);
    let tetrahedron =
        shapes::tetrahedron([[-1.1, -0.7, -0.9], [1.3, -0.2, -0.3], [0.1, 1.2, -0.4], [0.2, 0.1, 1.7]]);
    let both = |soup: &Soup, other: Soup| soup.iter().copied().chain(other).collect::<Soup>();
    let frame = frame();
    for soup in [block, tetrahedron] {
        let (twice, undone) = (both(&soup, soup.clone()), both(&soup, shapes::inside_out(soup.clone())));
        let middle = [0.05, 0.1, 0.0];
        let lines = [ray([5.0, 0.1, 0.05], [-1.0, 0.0, 0.0]), ray(middle, [0.3, 0.2, 1.0])];
        for (soup, fill, is_there) in [
            (&twice, FillRule::NonZero, true),
            (&twice, FillRule::Positive, true),
            (&twice, FillRule::EvenOdd, false),
            (&undone, FillRule::NonZero, false),
            (&undone, FillRule::Positive, false),
            (&undone, FillRule::EvenOdd, false),
        ] {
            let (solid, single) = (solid(soup, fill), solid(&soup[..soup.len() / 2].to_vec(), fill));
            let told = format!("{} {fill:?}", soup.len());
            let expected = if is_there { Membership::Inside } else { Membership::Outside };
            assert_eq!(member(&solid, &frame, middle), expected, "{told}");
            for line in lines {
                let RaySpans { inner, outer } = ray_spans(&solid, &frame, &line, &alone()).unwrap();
                let hit = cast_rays(&solid, &frame, &[line], Obstacle::Full, &alone()).unwrap()[0];
                if is_there {
                    let own = ray_spans(&single, &frame, &line, &alone()).unwrap();
                    assert_eq!((inner.len(), outer.len()), (1, 1), "{told}");
                    for (found, own) in [(inner[0], own.inner[0]), (outer[0], own.outer[0])] {
                        let off = (found.lower - own.lower).abs().max((found.upper - own.upper).abs());
                        assert!(off < 1e-12, "{told}");
                    }
                    let other = first(&single, &frame, line).unwrap();
                    assert_eq!(hit.unwrap().normal, other.normal, "{told}");
                } else {
                    assert!(inner.is_empty() && hit.is_none(), "{told}");
                    assert!(outer.iter().all(|span| span.width() < 1e-12), "{told} {outer:?}");
                }
            }
            let ask = |solid: &MeshSolid| {
                distances(solid, &frame, &[middle, [3.0; 3]], DistanceTo::Boundary, 1e-2, &alone()).unwrap()
            };
            let found = ask(&solid);
            if is_there {
                for (found, own) in found.iter().zip(ask(&single)) {
                    assert!(found.distance.common(own.distance).is_some(), "{told} {found:?} {own:?}");
                }
            } else {
                assert!(found.iter().all(|found| found.nearest.is_none()), "{told} {found:?}");
                assert!(found.iter().all(|found| found.distance.upper == f64::INFINITY), "{told} {found:?}");
            }
        }
    }
}

#[test]
fn threads_change_nothing() {
    let mut random = Random(11);
    // Enough triangles to build the tree on several threads, and enough queries to share them out.
    let mut soup = shapes::torus([0.1, 0.2, 0.3], 3.0, 1.0, 96, 64);
    soup.extend(shapes::octahedron([0.5; 3], 3.0));
    let frame = frame();
    let points: Vec<Point> = (0..9000).map(|_| [0; 3].map(|_| random.between(-5.0, 5.0))).collect();
    let rays: Vec<Ray> = points.windows(2).map(|p| Ray::between(p[0], p[1]).unwrap()).collect();
    let ask = |threads: usize| {
        let control = Control::threads(threads);
        let solid = solid(&soup, FillRule::NonZero);
        let hits = cast_rays(&solid, &frame, &rays, Obstacle::Full, &control).unwrap();
        let mut members = vec![Membership::Undecided; points.len()];
        contains(&solid, &frame, &points, &mut members, &control).unwrap();
        let away = distances(&solid, &frame, &points[..2000], DistanceTo::Boundary, 1e-3, &control).unwrap();
        (hits, members, away)
    };
    let (one, two) = (ask(1), ask(2));
    assert!(one.0.iter().flatten().count() > 1000);
    assert!(one == two);
}

#[test]
fn whoever_cancels_gets_no_tree() {
    let solid = solid(&shapes::torus([0.0; 3], 3.0, 1.0, 24, 12), FillRule::NonZero);
    let cancel = AtomicBool::new(true);
    let control = Control { cancel: Some(&cancel), ..alone() };
    let (frame, line) = (frame(), ray([0.0; 3], [1.0, 0.0, 0.0]));
    let is_cancelled = |result: Result<(), Error>| assert!(matches!(result, Err(Error::Cancelled)));
    is_cancelled(cast_rays(&solid, &frame, &[line], Obstacle::Full, &control).map(|_| ()));
    is_cancelled(ray_spans(&solid, &frame, &line, &control).map(|_| ()));
    is_cancelled(line_of_sight(&solid, &frame, [0.0; 3], [4.0; 3], &control).map(|_| ()));
    is_cancelled(contains(&solid, &frame, &[[0.5; 3]], &mut [Membership::Undecided], &control));
    is_cancelled(distances(&solid, &frame, &[[0.5; 3]], DistanceTo::Solid, 0.0, &control).map(|_| ()));
    // Without the cancel, the answer comes afterwards.
    assert!(first(&solid, &frame, line).unwrap().t.contains(2.0));
}
