//! Rays, points and distances that a mesh answers without cells, compared with an examination of every
//! triangle and with answers by cells.

use crate::descended::Descended;
use crate::oracle::PointOracle;
use crate::shapes::{self, Soup};
use leafless::query::{DistanceTo, Obstacle, Region, classify_box, distances, line_of_sight, ray_spans};
use leafless::query::{RaySpans, Sight};
use leafless::{
    Affine, FillRule, Frame, Interval, Membership, MeshSolid, Ray, TriangleMesh, cast_rays, contains,
};
use leafless_testkit::{Random, alone};

type Point = [f64; 3];
type Ints = [i64; 3];

fn has(spans: &[Interval], t: f64) -> bool {
    spans.iter().any(|span| span.contains(t))
}

/// A block between two corners, with its contribution to the winding number.
type Block = (Ints, Ints, i32);

fn blocks(random: &mut Random, count: usize) -> Vec<Block> {
    let mut blocks = Vec::new();
    while blocks.len() < count {
        let [a, b] = [0; 2].map(|_| [0; 3].map(|_: i64| random.below(9) as i64));
        let (min, max) = ([0, 1, 2].map(|k| a[k].min(b[k])), [0, 1, 2].map(|k| a[k].max(b[k])));
        if (0..3).all(|k| min[k] < max[k]) {
            blocks.push((min, max, if random.below(4) == 0 { -1 } else { 1 }));
        }
    }
    blocks
}

fn soup_of(blocks: &[Block]) -> Soup {
    let soup = |&(min, max, sense): &Block| {
        let soup = shapes::block(min.map(|c| c as f64), max.map(|c| c as f64));
        if sense < 0 { shapes::inside_out(soup) } else { soup }
    };
    blocks.iter().flat_map(soup).collect()
}

fn encloses(fill: FillRule, winding: i32) -> bool {
    match fill {
        FillRule::NonZero => winding != 0,
        FillRule::EvenOdd => winding % 2 != 0,
        FillRule::Positive => winding > 0,
    }
}

/// Examines the eight octants around a point, a fraction with the denominator `q`. Returns whether some
/// octant is inside, and whether all are.
fn around(blocks: &[Block], fill: FillRule, p: Ints, q: i64) -> (bool, bool) {
    let inside = |octant: usize| {
        let within = |k: usize, min: Ints, max: Ints| {
            let (low, high) = (min[k] * q, max[k] * q);
            if octant >> k & 1 != 0 { low <= p[k] && p[k] < high } else { low < p[k] && p[k] <= high }
        };
        let windings = blocks.iter().filter(|block| (0..3).all(|k| within(k, block.0, block.1)));
        encloses(fill, windings.map(|block| block.2).sum())
    };
    let found: Vec<bool> = (0..8).map(inside).collect();
    (found.contains(&true), !found.contains(&false))
}

/// True if a point lies on a facet of a block.
fn is_on_facet(blocks: &[Block], p: Ints, q: i64) -> bool {
    blocks.iter().any(|(min, max, _)| {
        let is_within = (0..3).all(|k| min[k] * q <= p[k] && p[k] <= max[k] * q);
        is_within && (0..3).any(|k| p[k] == min[k] * q || p[k] == max[k] * q)
    })
}

const RULES: [FillRule; 3] = [FillRule::NonZero, FillRule::EvenOdd, FillRule::Positive];

/// Rays through corners, along edges and in faces of blocks that overlap, nest, touch and are inside out. The
/// answer for each stretch between planes agrees with integer arithmetic.
#[test]
fn rays_of_blocks_are_those_of_integers() {
    let mut random = Random(1);
    let frame = Frame::new([-4.0; 3], 16.0, 6).unwrap();
    let (mut inside, mut outside, mut on) = (0, 0, 0);
    for round in 0..120 {
        let blocks = blocks(&mut random, 1 + round % 7);
        let mesh = TriangleMesh::from_facets(soup_of(&blocks)).unwrap();
        let fill = RULES[round % 3];
        let solid = MeshSolid::new(mesh, fill).unwrap();
        for _ in 0..60 {
            // In halves, so that rays begin on corners, edges, faces and between them.
            let from = [0; 3].map(|_: i64| random.below(23) as i64 - 3);
            let way = loop {
                let way = [0; 3].map(|_: i64| random.below(5) as i64 - 2);
                if way != [0; 3] {
                    break way;
                }
            };
            let ray = Ray::new(from.map(|c| c as f64 / 2.0), way.map(|c| c as f64)).unwrap();
            let spans = ray_spans(&solid, &frame, &ray, &alone()).unwrap();
            // Times at which the ray passes planes, in 4ths: 2 (plane − from / 2) · 2 / way.
            let mut times: Vec<i64> = (0..3)
                .filter(|&k| way[k] != 0)
                .flat_map(|k| {
                    (0..9).map(move |plane| (2 * plane - from[k]) * 2 / way[k].abs() * way[k].signum())
                })
                .chain([0])
                .filter(|&t| t >= 0)
                .collect();
            times.sort_unstable();
            times.dedup();
            times.push(times[times.len() - 1] + 4);
            for pair in times.windows(2) {
                // The middle, in 8ths.
                let t = pair[0] + pair[1];
                let at = [0, 1, 2].map(|k| from[k] * 4 + way[k] * t);
                let (some, all) = around(&blocks, fill, at, 8);
                let t = t as f64 / 8.0;
                let (inner, outer) = (has(&spans.inner, t), has(&spans.outer, t));
                let place = format!("{round} {blocks:?} {fill:?} {ray:?} {t} {spans:?}");
                assert!(!inner || some, "not inside: {place}");
                assert!(outer || !some, "not outside: {place}");
                assert!(inner || !all, "known to be inside: {place}");
                // (A facet that does not bound the solid, such as one between two negative winding numbers,
                // may count as one that does.)
                assert!(!outer || some || is_on_facet(&blocks, at, 8), "known to be outside: {place}");
                (inside, outside, on) =
                    (inside + i32::from(all), outside + i32::from(!some), on + i32::from(some && !all));
            }
        }
    }
    assert!(inside > 1000 && outside > 10_000 && on > 500, "{inside} {outside} {on}");
}

/// Overlapping, nested and inside-out bodies, slivers, and bodies that share vertices.
fn bodies(random: &mut Random, kind: usize) -> Soup {
    match kind {
        0 => shapes::torus([0.1, 0.2, 0.3], 3.0, 1.0, 24, 12),
        1 => shapes::tetrahedra(random, 12, |random| [0; 3].map(|_| random.between(-4.0, 4.0))),
        // On a lattice: many share corners, edges and planes.
        2 => shapes::tetrahedra(random, 12, |random| [0; 3].map(|_| random.below(5) as f64 * 2.0 - 4.0)),
        3 => {
            let mut soup = shapes::octahedron([0.0; 3], 4.0);
            soup.extend(shapes::octahedron([0.5; 3], 1.0));
            soup.extend(shapes::inside_out(shapes::octahedron([-0.5, 0.0, 0.25], 2.0)));
            soup.extend(shapes::octahedron([4.0, 0.0, 0.0], 3.0));
            soup
        }
        _ => {
            let near = |random: &mut Random| random.between(-1e-9, 1e-9);
            let mut soup = shapes::block([-3.0; 3], [3.0; 3]);
            let moved = [near(random), near(random), near(random)];
            soup.extend(shapes::moved(&shapes::block([-3.0; 3], [1.0; 3]), |p| {
                [p[0] + moved[0], p[1] + moved[1], p[2] + moved[2]]
            }));
            soup
        }
    }
}

/// A point: usually from the box around the mesh, sometimes a vertex, sometimes between vertices.
fn point(random: &mut Random, mesh: &TriangleMesh) -> Point {
    let vertex = |random: &mut Random| mesh.vertices()[random.below(mesh.vertices().len() as u64) as usize];
    match random.below(8) {
        0 => vertex(random),
        1 => {
            let (a, b) = (vertex(random), vertex(random));
            [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]))
        }
        2 => [0; 3].map(|_| random.below(9) as f64 - 4.0),
        _ => [0; 3].map(|_| random.between(-5.0, 5.0)),
    }
}

#[test]
fn points_are_those_of_all_triangles() {
    let mut random = Random(2);
    let frame = Frame::new([-8.0; 3], 16.0, 20).unwrap();
    let mut counts = [0; 3];
    for round in 0..60 {
        let mesh = TriangleMesh::from_facets(bodies(&mut random, round % 5)).unwrap();
        let oracle = PointOracle::new(&mesh);
        for fill in RULES {
            let solid = MeshSolid::new(mesh.try_clone().unwrap(), fill).unwrap();
            let points: Vec<Point> = (0..300).map(|_| point(&mut random, &mesh)).collect();
            let mut answers = vec![Membership::Undecided; points.len()];
            contains(&solid, &frame, &points, &mut answers, &alone()).unwrap();
            for (p, answer) in points.iter().zip(&answers) {
                let truth = oracle.winding(*p).map(|winding| encloses(fill, winding));
                match (answer, truth) {
                    (Membership::Undecided, _) => {
                        assert!(truth.is_none() || is_near(&mesh, *p, 1e-12), "{p:?}")
                    }
                    (Membership::Inside, Some(inside)) => assert!(inside, "{round} {fill:?} {p:?}"),
                    (Membership::Outside, Some(inside)) => assert!(!inside, "{round} {fill:?} {p:?}"),
                    // On the boundary either answer is right.
                    (_, None) => {}
                }
                counts[*answer as usize] += 1;
            }
        }
    }
    assert!(counts.iter().all(|&count| count > 1000), "{counts:?}");
}

/// Returns the distance of a point from a triangle, and the nearest point.
fn from_triangle([a, b, c]: [Point; 3], p: Point) -> (f64, Point) {
    let minus = |p: Point, q: Point| [0, 1, 2].map(|k| p[k] - q[k]);
    let dot = |p: Point, q: Point| (0..3).map(|k| p[k] * q[k]).sum::<f64>();
    let cross = |p: Point, q: Point| {
        [0, 1, 2].map(|k| p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3])
    };
    let along = |a: Point, b: Point| {
        let (way, from) = (minus(b, a), minus(p, a));
        let t = (dot(way, from) / dot(way, way)).clamp(0.0, 1.0);
        [0, 1, 2].map(|k| a[k] + t * way[k])
    };
    let mut candidates = vec![along(a, b), along(b, c), along(c, a)];
    let normal = cross(minus(b, a), minus(c, a));
    let square = dot(normal, normal);
    if square > 0.0 {
        let height = dot(normal, minus(p, a)) / square;
        let foot = [0, 1, 2].map(|k| p[k] - height * normal[k]);
        let over = |a, b| dot(cross(minus(b, a), minus(foot, a)), normal) >= 0.0;
        if over(a, b) && over(b, c) && over(c, a) {
            candidates.push(foot);
        }
    }
    let distance = |q: &Point| dot(minus(*q, p), minus(*q, p)).sqrt();
    let nearest = candidates.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
    (distance(&nearest), nearest)
}

fn corners(mesh: &TriangleMesh, triangle: usize) -> [Point; 3] {
    mesh.triangles()[triangle].map(|v| mesh.vertices()[v as usize])
}

fn is_near(mesh: &TriangleMesh, p: Point, distance: f64) -> bool {
    (0..mesh.triangles().len()).any(|triangle| from_triangle(corners(mesh, triangle), p).0 <= distance)
}

/// Compares rays with intervals by cells, which contain the answers, and compares points of the ray away from
/// the surface with all triangles.
#[test]
fn rays_are_those_of_all_triangles_and_of_cells() {
    let mut random = Random(3);
    let frame = Frame::new([-8.0; 3], 16.0, 7).unwrap();
    let (mut hits, mut checked) = (0, 0);
    for round in 0..40 {
        let mesh = TriangleMesh::from_facets(bodies(&mut random, round % 5)).unwrap();
        let oracle = PointOracle::new(&mesh);
        let fill = RULES[round / 5 % 3];
        let solid = MeshSolid::new(mesh.try_clone().unwrap(), fill).unwrap();
        let cells = MeshSolid::new(mesh.try_clone().unwrap(), fill).unwrap();
        let cells = Descended(&cells);
        let mut rays = Vec::new();
        while rays.len() < 60 {
            let (from, to) = (point(&mut random, &mesh), point(&mut random, &mesh));
            let out = if random.below(2) == 0 { 6.0 } else { 0.0 };
            let way = [0, 1, 2].map(|k| to[k] - from[k]);
            if way != [0.0; 3] {
                rays.push(Ray::new([0, 1, 2].map(|k| from[k] - out * way[k]), way).unwrap());
            }
        }
        for on in [Obstacle::Full, Obstacle::Upper] {
            let own = cast_rays(&solid, &frame, &rays, on, &alone()).unwrap();
            let by_cells = cast_rays(&cells, &frame, &rays, on, &alone()).unwrap();
            for ((ray, own), by_cells) in rays.iter().zip(&own).zip(&by_cells) {
                let place = format!("{round} {fill:?} {on:?} {ray:?} {own:?} {by_cells:?}");
                match (own, by_cells) {
                    (Some(own), Some(by_cells)) => {
                        // (Where the ray only touches the surface, a point counts for the cells that contain
                        // it, and not for others.)
                        let touches = own.t.upper <= by_cells.t.lower && {
                            let (from, to) = ends(ray);
                            let at = [0, 1, 2].map(|k| from[k] + own.t.upper * (to[k] - from[k]));
                            is_near(&mesh, at, 1e-9)
                        };
                        assert!(touches || own.t.common(by_cells.t).is_some(), "{place}");
                        assert_eq!(own.cell.level, 7);
                        hits += 1;
                    }
                    // Cells report nothing about a surface that the ray only touches.
                    (Some(own), None) if on == Obstacle::Upper => {
                        let (from, to) = ends(ray);
                        let at = [0, 1, 2].map(|k| from[k] + own.t.lower * (to[k] - from[k]));
                        assert!(is_near(&mesh, at, 1e-9), "{place}");
                    }
                    // Cells may be unable to prove thin parts.
                    (Some(own), None) => assert!(own.t.upper.is_finite(), "{place}"),
                    (None, Some(by_cells)) if on == Obstacle::Upper => {
                        assert!(by_cells.t.upper == f64::INFINITY, "{place}");
                    }
                    _ => {}
                }
            }
        }
        for ray in &rays {
            let spans = ray_spans(&solid, &frame, ray, &alone()).unwrap();
            let RaySpans { inner, outer } = ray_spans(&cells, &frame, ray, &alone()).unwrap();
            for t in (0..60).map(|k| (k as f64 + 0.5) / 4.0) {
                let (from, to) = ends(ray);
                let at = [0, 1, 2].map(|k| from[k] + t * (to[k] - from[k]));
                if frame.cell_of(at).is_none() || is_near(&mesh, at, 1e-8) {
                    continue;
                }
                let inside = encloses(fill, oracle.winding(at).unwrap());
                assert_eq!(
                    (has(&spans.inner, t), has(&spans.outer, t)),
                    (inside, inside),
                    "{ray:?} {t} {spans:?}"
                );
                assert!(!has(&inner, t) || inside);
                assert!(has(&outer, t) || !inside);
                checked += 1;
            }
        }
    }
    assert!(hits > 1500 && checked > 10_000, "{hits} {checked}");
}

/// Returns the points of a ray at time 0 and at time 1.
fn ends(ray: &Ray) -> (Point, Point) {
    let text = format!("{ray:?}");
    let numbers: Vec<f64> = text
        .split(|c: char| !(c.is_ascii_digit() || ".-e".contains(c)))
        .filter_map(|word| word.parse().ok())
        .collect();
    let from = [numbers[0], numbers[1], numbers[2]];
    (from, [from[0] + numbers[3], from[1] + numbers[5], from[2] + numbers[7]])
}

#[test]
fn distances_are_those_of_all_triangles_and_of_cells() {
    let mut random = Random(4);
    let frame = Frame::new([-8.0; 3], 16.0, 9).unwrap();
    let (mut told, mut signs) = (0, [0; 2]);
    for round in 0..20 {
        let mesh = TriangleMesh::from_facets(bodies(&mut random, [0, 3, 0, 1][round % 4])).unwrap();
        let solid = MeshSolid::new(mesh.try_clone().unwrap(), FillRule::NonZero).unwrap();
        let cells = MeshSolid::new(mesh.try_clone().unwrap(), FillRule::NonZero).unwrap();
        let points: Vec<Point> = (0..40).map(|_| point(&mut random, &mesh)).collect();
        for to in [DistanceTo::Boundary, DistanceTo::Solid, DistanceTo::Complement] {
            let own = distances(&solid, &frame, &points, to, 1e-9, &alone()).unwrap();
            let by_cells = distances(&Descended(&cells), &frame, &points, to, 1e-3, &alone()).unwrap();
            for ((&p, own), by_cells) in points.iter().zip(&own).zip(&by_cells) {
                let place = format!("{round} {to:?} {p:?} {own:?} {by_cells:?}");
                assert!(own.distance.common(by_cells.distance).is_some(), "{place}");
                // (Where cells were queried, no triangle is known.)
                let Some((near, surface)) = own.nearest.and_then(|near| Some((near, near.surface?))) else {
                    continue;
                };
                told += 1;
                assert!(own.distance.width() <= 1e-9 && own.splits == 0, "{place}");
                assert!(from_triangle(corners(&mesh, surface as usize), near.point).0 < 1e-12, "{place}");
                let way = (0..3).map(|k| (near.point[k] - p[k]).powi(2)).sum::<f64>().sqrt();
                if to == DistanceTo::Boundary {
                    let size = own.distance.lower.abs().max(own.distance.upper.abs());
                    assert!((way - size).abs() < 1e-9, "{place}");
                    if own.distance.lower > 0.0 || own.distance.upper < 0.0 {
                        signs[usize::from(own.distance.upper < 0.0)] += 1;
                    }
                }
                if round % 4 != 1 {
                    // All triangles bound the solid (or there was no answer).
                    let all = (0..mesh.triangles().len()).map(|t| from_triangle(corners(&mesh, t), p).0);
                    assert!(all.fold(f64::INFINITY, f64::min) <= way + 1e-12, "{place}");
                }
            }
        }
    }
    assert!(told > 1000 && signs.iter().all(|&count| count > 40), "{told} {signs:?}");
}

#[test]
fn facets_within_other_bodies_are_no_hits() {
    let mut soup = shapes::block([0.0; 3], [4.0; 3]);
    soup.extend(shapes::block([1.0; 3], [6.0, 3.0, 3.0]));
    let solid = MeshSolid::new(shapes::mesh(&soup), FillRule::NonZero).unwrap();
    let frame = Frame::new([-8.0; 3], 16.0, 12).unwrap();
    let ray = Ray::new([-2.0, 1.7, 2.2], [1.0, 0.0, 0.0]).unwrap();
    let RaySpans { inner, outer } = ray_spans(&solid, &frame, &ray, &alone()).unwrap();
    assert_eq!((inner.len(), outer.len()), (1, 1));
    assert!(inner[0].lower - 2.0 < 1e-12 && 8.0 - inner[0].upper < 1e-12);
    let back = Ray::new([7.0, 1.7, 2.2], [-1.0, 0.0, 0.0]).unwrap();
    let hit = cast_rays(&solid, &frame, &[back], Obstacle::Full, &alone()).unwrap()[0].unwrap();
    assert!(hit.t.contains(1.0) && hit.normal == [1.0, 0.0, 0.0]);
    let facet = solid.mesh().triangles()[hit.surface.unwrap() as usize];
    assert!(facet.iter().all(|&v| solid.mesh().vertices()[v as usize][0] == 6.0));
    // From inside both bodies, the nearest point is on no facet inside the other body.
    let near = distances(&solid, &frame, &[[1.5, 2.0, 2.0]], DistanceTo::Boundary, 1e-6, &alone()).unwrap();
    assert!(near[0].distance.contains(-1.5), "{near:?}");
}

#[test]
fn a_mesh_that_sticks_out_is_cut_by_the_universe() {
    let solid = MeshSolid::new(shapes::mesh(&shapes::block([-3.0; 3], [3.0; 3])), FillRule::NonZero).unwrap();
    let frame = Frame::new([-1.0; 3], 4.0, 5).unwrap();
    let ray = |from: Point, way: Point| Ray::new(from, way).unwrap();
    // It enters the solid before it enters the universe.
    let rays = [
        ray([-8.0, 0.5, 0.5], [1.0, 0.0, 0.0]),
        ray([0.5, 0.5, 8.0], [0.0, 0.0, -1.0]),
        ray([0.5; 3], [0.0, 1.0, 0.0]),
    ];
    let hits = cast_rays(&solid, &frame, &rays, Obstacle::Full, &alone()).unwrap();
    let by_cells = cast_rays(&Descended(&solid.clone()), &frame, &rays, Obstacle::Full, &alone()).unwrap();
    let told = |hits: &[Option<leafless::query::RayHit>]| -> Vec<_> {
        hits.iter().map(|hit| hit.map(|hit| (hit.t.contains([7.0, 5.0, 0.0][0]), hit.normal))).collect()
    };
    assert_eq!(told(&hits), told(&by_cells));
    assert_eq!(hits[0].unwrap().cell.at[0], 0);
    assert!(hits[1].unwrap().t.contains(5.0));
    assert_eq!(hits[2].unwrap().t, Interval::exactly(0.0));
    // Parts outside the universe do not count.
    let spans = ray_spans(&solid, &frame, &rays[0], &alone()).unwrap();
    assert_eq!(
        (spans.inner, spans.outer),
        (vec![Interval::new(7.0, 11.0).unwrap()], vec![Interval::new(7.0, 11.0).unwrap()])
    );
    let sight = |from, to| line_of_sight(&solid, &frame, from, to, &alone()).unwrap();
    assert_eq!(sight([0.0; 3], [0.0, 2.9, 0.0]), Sight::Blocked);
    let out = Frame::new([3.0, -1.0, -1.0], 4.0, 5).unwrap();
    assert_eq!(
        line_of_sight(&solid, &out, [3.5, 1.0, 1.0], [6.0, 0.0, 0.0], &alone()).unwrap(),
        Sight::Clear
    );
}

/// A rotated mesh is known up to the rounding of its vertices. It is queried like any other mesh, and its
/// answers at edges are never wrong.
#[test]
fn turned_meshes_are_asked_without_cells_too() {
    let turn = Affine::new([[0.6, -0.8, 0.0, 0.1], [0.8, 0.6, 0.0, 0.2], [0.0, 0.0, 1.0, 0.3]]).unwrap();
    let back = Affine::new([[0.6, 0.8, 0.0, -0.22], [-0.8, 0.6, 0.0, -0.04], [0.0, 0.0, 1.0, -0.3]]).unwrap();
    let solid = MeshSolid::new(shapes::mesh(&shapes::block([-3.0; 3], [3.0; 3])), FillRule::NonZero).unwrap();
    let frame = Frame::new([-8.0; 3], 16.0, 20).unwrap();
    // The source's tree already exists, and its order is reused.
    cast_rays(&solid, &frame, &[Ray::new([0.0; 3], [1.0; 3]).unwrap()], Obstacle::Full, &alone()).unwrap();
    let turned = solid.placed(&turn).unwrap();
    assert!(turned.mesh().displacement() > 0.0);
    let mut random = Random(6);
    for _ in 0..500 {
        let p = [0; 3].map(|_| random.between(-5.0, 5.0));
        let own = back.apply(p);
        let deep = (0..3).map(|k| 3.0 - own[k].abs()).fold(f64::INFINITY, f64::min);
        let found = &distances(&turned, &frame, &[p], DistanceTo::Boundary, 1e-9, &alone()).unwrap()[0];
        assert!(found.nearest.is_some() && found.distance.width() < 1e-9);
        if deep > 0.0 {
            assert!((found.distance.lower + deep).abs() < 1e-9);
        }
        let hit =
            cast_rays(&turned, &frame, &[Ray::new(p, [0.0, 0.0, 1.0]).unwrap()], Obstacle::Full, &alone())
                .unwrap()[0];
        let over = own[0].abs() < 3.0 && own[1].abs() < 3.0;
        let begins = (-3.0 - own[2]).max(0.0);
        assert_eq!(hit.is_some(), over && own[2] < 3.0);
        assert!(
            hit.is_none_or(
                |hit| hit.surface.is_some() == (begins > 0.0) && (hit.t.lower - begins).abs() < 1e-9
            )
        );
    }
}

/// The winding number of an open surface by its definition as a sum of solid angles (van Oosterom and
/// Strackee 1983).
fn winding_of(mesh: &TriangleMesh, p: Point) -> f64 {
    let sum: f64 = (0..mesh.triangles().len())
        .map(|triangle| {
            let [a, b, c] = corners(mesh, triangle).map(|corner| [0, 1, 2].map(|k| corner[k] - p[k]));
            let dot = |u: Point, v: Point| (0..3).map(|k| u[k] * v[k]).sum::<f64>();
            let length = |u: Point| dot(u, u).sqrt();
            let volume = a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]);
            let (x, y, z) = (length(a), length(b), length(c));
            2.0 * volume.atan2(x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y)
        })
        .sum();
    sum / (4.0 * std::f64::consts::PI)
}

#[test]
fn points_of_open_meshes_are_those_of_solid_angles() {
    let mut random = Random(7);
    let frame = Frame::new([-8.0; 3], 16.0, 20).unwrap();
    let (mut inside, mut undecided) = (0, 0);
    for round in 0..30 {
        let mut soup = bodies(&mut random, round % 5);
        // Some holes, of one triangle or of several.
        for _ in 0..1 + round % 4 {
            let first = random.below(soup.len() as u64) as usize;
            soup.drain(first..(first + 1 + round % 3).min(soup.len()));
        }
        let mesh = TriangleMesh::from_facets(&soup).unwrap();
        for fill in [FillRule::NonZero, FillRule::Positive] {
            let solid = MeshSolid::new(mesh.try_clone().unwrap(), fill).unwrap();
            let points: Vec<Point> = (0..200).map(|_| point(&mut random, &mesh)).collect();
            let mut answers = vec![Membership::Undecided; points.len()];
            contains(&solid, &frame, &points, &mut answers, &alone()).unwrap();
            for (&p, answer) in points.iter().zip(&answers) {
                let winding = winding_of(&mesh, p);
                let excess = if fill == FillRule::Positive { winding - 0.5 } else { winding.abs() - 0.5 };
                if excess.abs() < 1e-9 || is_near(&mesh, p, 1e-9) {
                    continue;
                }
                match answer {
                    Membership::Undecided => undecided += 1,
                    _ => assert_eq!(
                        *answer == Membership::Inside,
                        excess > 0.0,
                        "{round} {fill:?} {p:?} {winding}"
                    ),
                }
                inside += i32::from(excess > 0.0);
            }
        }
    }
    assert!(inside > 1000 && undecided == 0, "{inside} {undecided}");
}

/// Compares the verdicts of boxes with all their points, and with cells. Either method may be undecided where
/// the other one decides.
#[test]
fn boxes_are_those_of_points_and_of_cells() {
    let mut random = Random(8);
    let frame = Frame::new([-8.0; 3], 16.0, 7).unwrap();
    let mut counts = [0; 4];
    for round in 0..40 {
        let mesh = TriangleMesh::from_facets(bodies(&mut random, round % 5)).unwrap();
        let oracle = PointOracle::new(&mesh);
        let fill = RULES[round / 5 % 3];
        let solid = MeshSolid::new(mesh.try_clone().unwrap(), fill).unwrap();
        let cells = MeshSolid::new(mesh.try_clone().unwrap(), fill).unwrap();
        for _ in 0..60 {
            let (a, size) = (point(&mut random, &mesh), [0.0, 0.01, 0.3, 2.0, 6.0][random.below(5) as usize]);
            let b = [0, 1, 2].map(|k| (a[k] + size * random.unit()).min(8.0));
            let own = classify_box(&solid, &frame, a, b, &alone()).unwrap();
            let by_cells = classify_box(&Descended(&cells), &frame, a, b, &alone()).unwrap();
            let place = format!("{round} {fill:?} {a:?} {b:?} {own:?} {by_cells:?}");
            assert!(own == by_cells || own == Region::Undecided || by_cells == Region::Undecided, "{place}");
            counts[own as usize] += 1;
            for _ in 0..20 {
                let p = [0, 1, 2].map(|k| random.between(a[k], b[k]));
                let Some(winding) = oracle.winding(p) else { continue };
                match own {
                    Region::Outside => assert!(!encloses(fill, winding), "{place} {p:?}"),
                    Region::Inside => assert!(encloses(fill, winding), "{place} {p:?}"),
                    Region::Crossing | Region::Undecided => {}
                }
            }
        }
    }
    assert!(counts[..3].iter().all(|&count| count > 150), "{counts:?}");
}
