//! Rays, boxes and distances that an open mesh answers without cells, compared with winding numbers by solid
//! angles and with answers by cells.

use crate::descended::Descended;
use crate::shapes::{self, Soup};
use leafless::exchange::{MeshOptions, read_mesh};
use leafless::query::{DistanceTo, Obstacle, RayHit, RaySpans, Region, Sight};
use leafless::query::{classify_box, distances, line_of_sight, ray_spans};
use leafless::{Affine, FillRule, Frame, Interval, MeshSolid, Ray, TriangleMesh, cast_rays};
use leafless_testkit::{Random, alone, repeated};

type Point = [f64; 3];

const RULES: [FillRule; 2] = [FillRule::NonZero, FillRule::Positive];

fn at(k: impl Fn(usize) -> f64) -> Point {
    [0, 1, 2].map(k)
}

fn minus(p: Point, q: Point) -> Point {
    at(|k| p[k] - q[k])
}

fn dot(p: Point, q: Point) -> f64 {
    (0..3).map(|k| p[k] * q[k]).sum()
}

fn length(p: Point) -> f64 {
    dot(p, p).sqrt()
}

fn along(from: Point, way: Point, t: f64) -> Point {
    at(|k| from[k] + t * way[k])
}

fn corners(mesh: &TriangleMesh, triangle: usize) -> [Point; 3] {
    mesh.triangles()[triangle].map(|v| mesh.vertices()[v as usize])
}

/// The winding number by its definition as a sum of solid angles (van Oosterom and Strackee 1983).
fn winding(mesh: &TriangleMesh, p: Point) -> f64 {
    let angle = |triangle: usize| {
        let [a, b, c] = corners(mesh, triangle).map(|corner| minus(corner, p));
        let volume = a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]);
        let [x, y, z] = [a, b, c].map(length);
        2.0 * volume.atan2(x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y)
    };
    (0..mesh.triangles().len()).map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

fn excess(fill: FillRule, winding: f64) -> f64 {
    if fill == FillRule::Positive { winding - 0.5 } else { winding.abs() - 0.5 }
}

/// Returns the distance from a triangle: from its edges, and from its plane if the perpendicular foot lies in
/// the triangle.
fn from_triangle([a, b, c]: [Point; 3], p: Point) -> f64 {
    let edge = |a: Point, b: Point| {
        let (way, from) = (minus(b, a), minus(p, a));
        let t = (dot(way, from) / dot(way, way)).clamp(0.0, 1.0);
        length(minus(along(a, way, t), p))
    };
    let edges = edge(a, b).min(edge(b, c)).min(edge(c, a));
    let (u, v) = (minus(b, a), minus(c, a));
    let normal = at(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
    let height = dot(normal, minus(p, a)) / dot(normal, normal);
    let foot = along(p, normal, -height);
    let is_over = |p: Point, q: Point| {
        let (u, v) = (minus(q, p), minus(foot, p));
        let cross = at(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
        dot(cross, normal) >= 0.0
    };
    if is_over(a, b) && is_over(b, c) && is_over(c, a) { edges.min(length(minus(foot, p))) } else { edges }
}

fn from_mesh(mesh: &TriangleMesh, p: Point) -> f64 {
    (0..mesh.triangles().len()).map(|t| from_triangle(corners(mesh, t), p)).fold(f64::INFINITY, f64::min)
}

/// Shapes with holes: some missing facets, a box without a lid, part of a ball, a band, and loose triangles.
fn open(random: &mut Random, kind: usize) -> Soup {
    let soup = open_facets(random, kind);
    if soup.is_empty() { open(random, kind) } else { soup }
}

fn open_facets(random: &mut Random, kind: usize) -> Soup {
    let mut soup = match kind % 6 {
        0 => shapes::torus([0.1, 0.2, 0.3], 3.0, 1.0, 12, 6),
        1 => shapes::block([-3.0, -2.0, -1.0], [2.0, 3.0, 2.5]),
        2 => {
            let mut soup = shapes::octahedron([0.0; 3], 4.0);
            soup.extend(shapes::inside_out(shapes::octahedron([-0.5, 0.0, 0.25], 2.0)));
            soup.extend(shapes::octahedron([3.0, 0.0, 0.0], 3.0));
            soup
        }
        3 => {
            // All of a ball but for a hole of any size.
            let level = random.between(-3.5, 3.5);
            let ball = ball(12, 8, 4.0);
            return ball.into_iter().filter(|facet| facet.iter().all(|p| p[2] <= level)).collect();
        }
        4 => shapes::block([-3.0; 3], [3.0; 3])
            .into_iter()
            .filter(|facet| facet.iter().any(|p| p[0] != facet[0][0]))
            .collect(),
        _ => {
            let corner = |random: &mut Random| [0; 3].map(|_| random.between(-4.0, 4.0));
            return (0..7).map(|_| [0; 3].map(|_| corner(random))).collect();
        }
    };
    for _ in 0..1 + random.below(3) {
        let first = random.below(soup.len() as u64) as usize;
        let count = 1 + random.below(3) as usize;
        soup.drain(first..(first + count).min(soup.len()));
    }
    soup
}

fn ball(around: usize, across: usize, radius: f64) -> Soup {
    let place = |i: usize, j: usize| {
        let (u, v) = (
            std::f64::consts::TAU * (i % around) as f64 / around as f64,
            std::f64::consts::PI * j as f64 / across as f64,
        );
        if j == 0 || j == across {
            return [0.0, 0.0, if j == 0 { radius } else { -radius }];
        }
        [radius * v.sin() * u.cos(), radius * v.sin() * u.sin(), radius * v.cos()]
    };
    let mut soup = Soup::new();
    for (i, j) in (0..around).flat_map(|i| (0..across).map(move |j| (i, j))) {
        let [a, b, c, d] = [place(i, j), place(i, j + 1), place(i + 1, j + 1), place(i + 1, j)];
        soup.extend([[a, b, c], [a, c, d]].into_iter().filter(|[p, q, r]| p != q && q != r && r != p));
    }
    soup
}

fn point(random: &mut Random, mesh: &TriangleMesh) -> Point {
    let vertex = |random: &mut Random| mesh.vertices()[random.below(mesh.vertices().len() as u64) as usize];
    match random.below(8) {
        0 => vertex(random),
        1 => {
            let (a, b) = (vertex(random), vertex(random));
            at(|k| 0.5 * (a[k] + b[k]))
        }
        2 => [0; 3].map(|_| random.below(9) as f64 - 4.0),
        _ => [0; 3].map(|_| random.between(-5.0, 5.0)),
    }
}

/// A ray from inside or outside. Some rays pass through corners or along axes.
fn ray(random: &mut Random, mesh: &TriangleMesh) -> (Point, Point) {
    loop {
        let (from, to) = (point(random, mesh), point(random, mesh));
        let mut way = minus(to, from);
        if random.below(6) == 0 {
            way = [[1.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, 0.5]][random.below(3) as usize];
        }
        let out = if random.below(2) == 0 { 6.0 } else { 0.0 };
        if way != [0.0; 3] {
            return (along(from, way, -out), way);
        }
    }
}

fn has(spans: &[Interval], t: f64) -> bool {
    spans.iter().any(|span| span.contains(t))
}

/// Numbers of compared answers.
#[derive(Debug, Default)]
struct Counts {
    inside: u32,
    outside: u32,
    /// Number of ends at which the winding number is one half.
    halves: u32,
    hits: u32,
    /// Number of points of rays that only cells decide.
    coarser: u32,
}

/// Compares the spans and the first hits of a ray.
fn check_ray(
    mesh: &TriangleMesh,
    fill: FillRule,
    (own, cells): (&MeshSolid, &Descended<'_>),
    frame: &Frame,
    (from, way): (Point, Point),
    counts: &mut Counts,
) {
    let ray = Ray::new(from, way).unwrap();
    let RaySpans { inner, outer } = ray_spans(own, frame, &ray, &alone()).unwrap();
    let by_cells = ray_spans(cells, frame, &ray, &alone()).unwrap();
    let place = format!("{fill:?} {from:?} {way:?}\n{inner:?} {outer:?}\n{by_cells:?}");
    let size = 16.0;
    for k in 0..48 {
        let t = (k as f64 + 0.37) / 4.0;
        let p = along(from, way, t);
        if frame.cell_of(p).is_none() || from_mesh(mesh, p) < 1e-7 {
            continue;
        }
        let excess = excess(fill, winding(mesh, p));
        if excess.abs() < 1e-6 {
            continue;
        }
        let is_inside = excess > 0.0;
        assert!(!has(&inner, t) || is_inside, "not inside at {t}: {place}");
        assert!(has(&outer, t) || !is_inside, "not outside at {t}: {place}");
        let by_cells = (has(&by_cells.inner, t), has(&by_cells.outer, t));
        if (has(&inner, t), has(&outer, t)) != (is_inside, is_inside) {
            // No worse than cells.
            assert!(by_cells != (is_inside, is_inside), "cells decide {t}: {place}");
            counts.coarser += 1;
        }
        *(if is_inside { &mut counts.inside } else { &mut counts.outside }) += 1;
    }
    // Each narrow end is an end: a triangle, or one half.
    for span in &outer {
        for t in [span.lower, span.upper] {
            let p = along(from, way, t);
            if t == 0.0 || !t.is_finite() || length(p) > size || frame.cell_of(p).is_none() {
                continue;
            }
            let is_narrow =
                inner.iter().any(|inner| (inner.lower - t).abs().min((inner.upper - t).abs()) < 1e-9);
            let is_at_face = (0..3).any(|k| (p[k].abs() - 8.0).abs() < 1e-9);
            if is_narrow && !is_at_face && from_mesh(mesh, p) > 1e-6 {
                let excess = excess(fill, winding(mesh, p));
                assert!(excess.abs() < 1e-7, "no end at {t}: {excess} {place}");
                counts.halves += 1;
            }
        }
    }
    for on in [Obstacle::Full, Obstacle::Upper] {
        let hit = cast_rays(own, frame, &[ray], on, &alone()).unwrap()[0];
        let by_cells = cast_rays(cells, frame, &[ray], on, &alone()).unwrap()[0];
        let place = format!("{on:?} {hit:?} {by_cells:?} {place}");
        if let (Some(hit), Some(by_cells)) = (hit, by_cells) {
            let touches = from_mesh(mesh, along(from, way, hit.t.lower)) < 1e-7;
            assert!(touches || hit.t.common(by_cells.t).is_some(), "{place}");
            counts.hits += 1;
        }
        let first = if on == Obstacle::Full { inner.first() } else { outer.first() };
        assert!(hit.is_some() || first.is_none_or(|first| first.width() < 1e-9), "no hit: {place}");
        if let Some(RayHit { t, normal, .. }) = hit
            && on == Obstacle::Full
            && t.width() < 1e-9
            && inner.iter().any(|span| span.lower == t.upper && span.width() > 1e-6)
            && t.lower > 0.0
        {
            assert!(dot(normal, way) < 1e-6 * length(way), "not outward: {place}");
        }
    }
    let end = along(from, way, 1.0);
    let (sight, by_cells) = (
        line_of_sight(own, frame, from, end, &alone()).unwrap(),
        line_of_sight(cells, frame, from, end, &alone()).unwrap(),
    );
    let is_same = sight == by_cells || sight == Sight::Undecided || by_cells == Sight::Undecided;
    // (Contact with the surface is blocked for the tree, and may be clear for cells.)
    let touches = || (0..=1000).any(|k| from_mesh(mesh, along(from, way, f64::from(k) / 1000.0)) < 0.05);
    assert!(is_same || touches(), "{sight:?} {by_cells:?} {place}");
}

#[test]
fn rays_of_open_meshes_are_those_of_solid_angles_and_of_cells() {
    let mut random = Random(1);
    let frame = Frame::new([-8.0; 3], 16.0, 7).unwrap();
    let mut counts = Counts::default();
    for round in 0..36 {
        let mesh = shapes::mesh(&open(&mut random, round));
        for fill in RULES {
            let own = MeshSolid::new(mesh.try_clone().unwrap(), fill).unwrap();
            let cells = MeshSolid::new(mesh.try_clone().unwrap(), fill).unwrap();
            for _ in 0..16 {
                let ray = ray(&mut random, &mesh);
                check_ray(&mesh, fill, (&own, &Descended(&cells)), &frame, ray, &mut counts);
            }
        }
    }
    let Counts { inside, outside, halves, hits, coarser } = counts;
    assert!(inside > 1000 && outside > 10_000 && halves > 200 && hits > 500, "{counts:?}");
    assert!(coarser < 100, "{counts:?}");
}

/// A point of a box, sometimes a corner.
fn within(random: &mut Random, a: Point, b: Point) -> Point {
    [0, 1, 2].map(|k| match random.below(4) {
        0 => a[k],
        1 => b[k],
        _ => random.between(a[k], b[k]),
    })
}

#[test]
fn boxes_of_open_meshes_are_those_of_solid_angles_and_of_cells() {
    let mut random = Random(3);
    let frame = Frame::new([-8.0; 3], 16.0, 6).unwrap();
    let (mut counts, mut told) = ([0; 4], [0; 4]);
    for round in 0..36 {
        let mesh = shapes::mesh(&open(&mut random, round));
        let fill = RULES[round / 6 % 2];
        let own = MeshSolid::new(mesh.try_clone().unwrap(), fill).unwrap();
        let cells = MeshSolid::new(mesh.try_clone().unwrap(), fill).unwrap();
        for _ in 0..60 {
            let (a, size) = (point(&mut random, &mesh), [0.01, 0.3, 1.0, 3.0][random.below(4) as usize]);
            let b = [0, 1, 2].map(|k: usize| (a[k] + size * random.unit()).min(8.0));
            let region = classify_box(&own, &frame, a, b, &alone()).unwrap();
            let by_cells = classify_box(&Descended(&cells), &frame, a, b, &alone()).unwrap();
            let place = format!("{round} {fill:?} {a:?} {b:?} {region:?} {by_cells:?}");
            assert!(region == by_cells || [region, by_cells].contains(&Region::Undecided), "{place}");
            assert!(region != Region::Undecided || by_cells == Region::Undecided, "{place}");
            counts[region as usize] += 1;
            // Without cells.
            let control = leafless::Control { max_splits: Some(0), ..alone() };
            told[classify_box(&own, &frame, a, b, &control).unwrap() as usize] += 1;
            for _ in 0..20 {
                let p = within(&mut random, a, b);
                let excess = excess(fill, winding(&mesh, p));
                if excess.abs() < 1e-9 || from_mesh(&mesh, p) < 1e-9 {
                    continue;
                }
                match region {
                    Region::Outside => assert!(excess < 0.0, "{place} {p:?}"),
                    Region::Inside => assert!(excess > 0.0, "{place} {p:?}"),
                    Region::Crossing | Region::Undecided => {}
                }
            }
        }
    }
    assert!(counts[..3].iter().all(|&count| count > 100), "{counts:?}");
    assert!(told[3] * 3 < told[..3].iter().sum(), "{told:?}");
}

#[test]
fn distances_of_open_meshes_are_those_of_cells() {
    let mut random = Random(4);
    let frame = Frame::new([-8.0; 3], 16.0, 8).unwrap();
    let (mut told, mut not_told) = (0, 0);
    for round in 0..18 {
        let mesh = shapes::mesh(&open(&mut random, round));
        let fill = RULES[round / 6 % 2];
        let own = MeshSolid::new(mesh.try_clone().unwrap(), fill).unwrap();
        let cells = MeshSolid::new(mesh.try_clone().unwrap(), fill).unwrap();
        let points: Vec<Point> = (0..20).map(|_| point(&mut random, &mesh)).collect();
        for to in [DistanceTo::Boundary, DistanceTo::Solid, DistanceTo::Complement] {
            let own = distances(&own, &frame, &points, to, 1e-2, &alone()).unwrap();
            let by_cells = distances(&Descended(&cells), &frame, &points, to, 1e-2, &alone()).unwrap();
            for ((&p, own), by_cells) in points.iter().zip(&own).zip(&by_cells) {
                let place = format!("{round} {to:?} {p:?} {own:?} {by_cells:?}");
                assert!(own.distance.common(by_cells.distance).is_some(), "{place}");
                let Some(near) = own.nearest.filter(|_| own.splits == 0) else {
                    not_told += 1;
                    continue;
                };
                told += 1;
                assert!(own.distance.width() <= 1e-9, "{place}");
                if to == DistanceTo::Boundary {
                    let size = own.distance.lower.abs().max(own.distance.upper.abs());
                    assert!((size - from_mesh(&mesh, p)).abs() < 1e-9, "{place}");
                    assert!((length(minus(near.point, p)) - size).abs() < 1e-9, "{place}");
                    let excess = excess(fill, winding(&mesh, p));
                    let is_outside = own.distance.lower > 0.0;
                    assert!(size < 1e-9 || is_outside == (excess < 0.0), "{excess} {place}");
                    // On no point of a smaller sphere is the other side.
                    for _ in 0..20 {
                        let way = [0; 3].map(|_| random.between(-1.0, 1.0));
                        let q = along(p, way, 0.999 * size / length(way));
                        let other = self::excess(fill, winding(&mesh, q));
                        assert!((other < 0.0) == (excess < 0.0) || size < 1e-6, "{q:?} {other} {place}");
                    }
                }
            }
        }
    }
    assert!(told > 100, "{told} {not_told}");
}

/// Most rays are decided without cells, so that no cell may be split.
#[test]
fn rays_are_told_without_cells() {
    let mut random = Random(2);
    let frame = Frame::new([-8.0; 3], 16.0, 20).unwrap();
    let mut told = [0; 2];
    for round in 0..60 {
        let mesh = shapes::mesh(&open(&mut random, round));
        let solid = MeshSolid::new(mesh.try_clone().unwrap(), RULES[round % 2]).unwrap();
        let control = leafless::Control { max_splits: Some(0), ..alone() };
        for _ in 0..60 {
            let from = [0; 3].map(|_| random.between(-6.0, 6.0));
            let way = [0; 3].map(|_| random.between(-1.0, 1.0));
            let RaySpans { inner, outer } =
                ray_spans(&solid, &frame, &Ray::new(from, way).unwrap(), &control).unwrap();
            let is_told = inner.len() == outer.len()
                && inner.iter().zip(&outer).all(|(inner, outer)| {
                    inner.lower - outer.lower < 1e-9 && outer.upper - inner.upper < 1e-9
                });
            told[usize::from(is_told)] += 1;
        }
    }
    assert!(told[0] * 50 < told[1], "{told:?}");
}

/// A moved mesh is known up to the rounding of its vertices. Its rays are the mesh's rays, moved back.
#[test]
fn turned_open_meshes_are_asked_without_cells_too() {
    let turn = Affine::new([[0.6, -0.8, 0.0, 0.1], [0.8, 0.6, 0.0, 0.2], [0.0, 0.0, 1.0, 0.3]]).unwrap();
    let mut random = Random(5);
    let frame = Frame::new([-16.0; 3], 32.0, 20).unwrap();
    let mut count = 0;
    for round in 0..24 {
        let mesh = shapes::mesh(&open(&mut random, round));
        let solid = MeshSolid::new(mesh, RULES[round % 2]).unwrap();
        let turned = solid.placed(&turn).unwrap();
        assert!(turned.mesh().displacement() > 0.0);
        for _ in 0..40 {
            let [from, to] = [0; 2].map(|_| [0; 3].map(|_| random.between(-5.0, 5.0)));
            let spans = |solid: &MeshSolid, from, to| {
                ray_spans(solid, &frame, &Ray::between(from, to).unwrap(), &alone()).unwrap()
            };
            let there = spans(&turned, turn.apply(from), turn.apply(to));
            let here = spans(&solid, from, to);
            for k in 0..32 {
                let t = (f64::from(k) + 0.43) / 32.0;
                let ends = here.outer.iter().flat_map(|span| [span.lower, span.upper]);
                if ends.chain([0.0, 1.0]).any(|end| (end - t).abs() < 1e-6) {
                    continue;
                }
                let told = [&here, &there].map(|spans| (has(&spans.inner, t), has(&spans.outer, t)));
                assert_eq!(told[0], told[1], "{round} {from:?} {to:?} {t} {here:?} {there:?}");
                count += u32::from(told[0].0);
            }
        }
    }
    assert!(count > 500, "{count}");
}

/// A model with five holes, compared with cells.
#[test]
fn the_bunny_with_its_holes() {
    let Some(folder) = std::env::var_os("LEAFLESS_MODELS") else {
        eprintln!("SKIPPED: LEAFLESS_MODELS is not set");
        return;
    };
    let bytes = std::fs::read(std::path::Path::new(&folder).join("stanford-bunny.obj")).unwrap();
    let mesh = read_mesh(&bytes, &MeshOptions::default()).unwrap().mesh;
    let (min, max) = mesh.bounds();
    let frame = Frame::around(min, max, 12).unwrap();
    let own = MeshSolid::new(mesh.try_clone().unwrap(), FillRule::NonZero).unwrap();
    let cells = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
    let (own, cells) = (&own, &Descended(&cells));
    let mut random = Random(6);
    let span = length(minus(max, min));
    let (mut rays, mut ends) = (Vec::new(), Vec::new());
    for k in 0..repeated(90, 300) {
        let to = [0, 1, 2].map(|k: usize| random.between(min[k], max[k]));
        let way = [0; 3].map(|_| random.between(-1.0, 1.0));
        // From afar, from within, and up through the base, where the holes are.
        let from = match k % 3 {
            0 => along(to, way, -2.0 * span),
            1 => to,
            _ => at(|k| if k == 1 { min[1] - 0.1 * span } else { to[k] }),
        };
        let way = if k % 3 == 2 { [0.1 * way[0], 1.0, 0.1 * way[2]] } else { way };
        rays.push(Ray::new(from, way).unwrap());
        ends.push(to);
    }
    for on in [Obstacle::Full, Obstacle::Upper] {
        let hits = cast_rays(own, &frame, &rays, on, &alone()).unwrap();
        let by_cells = cast_rays(cells, &frame, &rays, on, &alone()).unwrap();
        for ((hit, by_cells), ray) in hits.iter().zip(by_cells).zip(&rays) {
            let place = format!("{on:?} {ray:?} {hit:?} {by_cells:?}");
            if let (Some(hit), Some(by_cells)) = (hit, by_cells) {
                assert!(hit.t.common(by_cells.t).is_some(), "{place}");
                assert!(hit.t.upper.is_infinite() || hit.t.width() < 1e-9 * span, "{place}");
            }
            let is_sure = |hit: &RayHit| hit.t.upper.is_finite();
            assert!(by_cells.as_ref().is_none_or(|hit| !is_sure(hit)) || hit.is_some(), "{place}");
        }
    }
    let ends = &ends[..repeated(30, 100)];
    for to in [DistanceTo::Boundary, DistanceTo::Solid] {
        let told = distances(own, &frame, ends, to, 1e-4 * span, &alone()).unwrap();
        let by_cells = distances(cells, &frame, ends, to, 1e-4 * span, &alone()).unwrap();
        for (told, by_cells) in told.iter().zip(&by_cells) {
            assert!(told.distance.common(by_cells.distance).is_some(), "{told:?} {by_cells:?}");
        }
        let direct = told.iter().filter(|told| told.splits == 0 && told.nearest.is_some()).count();
        assert!(direct > repeated(18, 60), "{direct}");
    }
}
