//! Data on meshes: carried through all mesh operations, on polyhedra, and as attributes of space, against a
//! search of all triangles.

use leafless::attribute::{
    Attribute, FillOptions, FunctionAttribute, ScalarType, SurfaceAttribute, ValueRange, ValueType,
    fill_channel, sample_triangles,
};
use leafless::mesh::{AttributeDomain, MeshAttribute, Polyhedron, PolyhedronArrays, PolyhedronPart};
use leafless::surface::{VertexPlacement, marching_cubes_solid};
use leafless::{Affine, Bounds, Control, Csg, Error, FillRule, Frame, TriangleMesh};
use leafless_testkit::{Random, alone};
use std::array::from_fn as array;

type Point = [f64; 3];

/// Returns two attributes: each triangle's number as its label, and each corner's place.
fn told(vertices: &[Point], triangles: &[[u32; 3]]) -> Vec<MeshAttribute> {
    let places: Vec<f64> = triangles.iter().flatten().flat_map(|&v| vertices[v as usize]).collect();
    vec![
        MeshAttribute::labels("source", (0..triangles.len() as u32).collect()).unwrap(),
        MeshAttribute::per_corner("place", 3, &places).unwrap(),
    ]
}

fn one(value: Option<[f64; 4]>) -> f64 {
    value.unwrap()[0]
}

/// Checks that each triangle has the label of a triangle that was handed in, in their order. Each corner must
/// lie at `expected` of its stored place, up to `tolerance`.
#[track_caller]
fn check(mesh: &TriangleMesh, given: usize, tolerance: f64, expected: impl Fn(Point) -> Point) {
    let (source, place) = (mesh.attribute("source").unwrap(), mesh.attribute("place").unwrap());
    assert_eq!((source.len(), place.len()), (mesh.triangles().len(), mesh.triangles().len()));
    let sources: Vec<f64> = (0..source.len()).map(|t| one(source.value(t, 0))).collect();
    assert!(sources.is_sorted_by(|a, b| a < b) && sources.iter().all(|&source| source < given as f64));
    for (t, triangle) in mesh.triangles().iter().enumerate() {
        for (corner, &vertex) in triangle.iter().enumerate() {
            let [x, y, z, _] = place.value(t, corner).unwrap();
            let (at, expected) = (mesh.vertices()[vertex as usize], expected([x, y, z]));
            assert!((0..3).all(|k| (at[k] - expected[k]).abs() <= tolerance), "{at:?} {expected:?}");
        }
    }
}

/// Triangles on a small lattice. Many are degenerate.
fn lattice_soup(random: &mut Random, count: u32) -> (Vec<Point>, Vec<[u32; 3]>) {
    let vertices = (0..3 * count).map(|_| array(|_| random.between(0.0, 3.0).floor())).collect();
    (vertices, (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect())
}

#[test]
fn attributes_follow_their_triangles() {
    let mut random = Random(1);
    for count in [0, 1, 2, 10, 300] {
        let (vertices, triangles) = lattice_soup(&mut random, count);
        let attributes = told(&vertices, &triangles);
        let mesh = TriangleMesh::with_attributes(vertices.clone(), triangles.clone(), attributes).unwrap();
        let plain = TriangleMesh::new(vertices, triangles).unwrap();
        assert_eq!((mesh.vertices(), mesh.triangles()), (plain.vertices(), plain.triangles()));
        assert_eq!(mesh.report().unwrap().facets_read, u64::from(count));
        check(&mesh, count as usize, 0.0, |p| p);
        // Flattening loses triangles, and corners at several places become one vertex.
        let flat = mesh.transformed(|[x, y, _]| [x, y, 0.0]).unwrap();
        assert!(count < 300 || flat.triangles().len() < mesh.triangles().len());
        check(&flat, count as usize, 0.0, |[x, y, _]| [x, y, 0.0]);
        check(&mesh.translated([1.0, -2.0, 0.5]).unwrap(), count as usize, 0.0, |[x, y, z]| {
            [x + 1.0, y - 2.0, z + 0.5]
        });
        // A reflection reverses triangles. Corners keep their values.
        let mirror =
            Affine::new([[0.0, 2.0, 0.0, 0.5], [1.0, 0.0, 0.0, -3.0], [0.0, 0.0, 1.0, 0.0]]).unwrap();
        check(&mesh.placed(&mirror).unwrap(), count as usize, 0.0, |[x, y, z]| [2.0 * y + 0.5, x - 3.0, z]);
        check(&mesh.clone(), count as usize, 0.0, |p| p);
    }
}

#[test]
fn attributes_follow_sewing() {
    // A tetrahedron whose faces do not share vertices, with one vertex slightly off, a sliver that becomes
    // degenerate by sewing, and a triangle that is degenerate from the start.
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut vertices: Vec<Point> = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let mut push = |facet: [Point; 3]| {
        let first = vertices.len() as u32;
        vertices.extend(facet);
        triangles.push([first, first + 1, first + 2]);
    };
    push([[5.0; 3], [5.0; 3], corners[0]]);
    push([corners[0], [0.0, 0.0, 1e-9], corners[1]]);
    for face in [[0usize, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
        let noise = if face == [0, 2, 1] { 1e-8 } else { 0.0 };
        push(face.map(|corner| {
            let [x, y, z] = corners[corner];
            [x, y, z + noise]
        }));
    }
    let attributes = told(&vertices, &triangles);
    let mesh = TriangleMesh::with_attributes(vertices, triangles, attributes).unwrap();
    assert_eq!(mesh.triangles().len(), 5);
    let sewn = mesh.sewn().unwrap();
    assert!(sewn.report().unwrap().sewn > 0);
    sewn.check_closed(FillRule::NonZero).unwrap();
    let sources: Vec<f64> = (0..4).map(|t| one(sewn.attribute("source").unwrap().value(t, 0))).collect();
    assert_eq!(sources, [2.0, 3.0, 4.0, 5.0]);
    check(&sewn, 6, 2e-8, |p| p);
}

#[test]
fn attributes_that_do_not_fit_are_refused() {
    let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let label = |name, count| MeshAttribute::labels(name, vec![0; count]).unwrap();
    let with = |attributes| TriangleMesh::with_attributes(vertices.clone(), vec![[0, 1, 2]; 2], attributes);
    let refused = |error| assert!(matches!(error, Error::Argument { name: "attributes", .. }), "{error}");
    refused(with(vec![label("a", 1)]).unwrap_err());
    refused(with(vec![label("a", 2), label("b", 3)]).unwrap_err());
    refused(with(vec![label("a", 2), label("a", 2)]).unwrap_err());
    let mut mesh = with(vec![label("a", 2), label("b", 2)]).unwrap();
    refused(mesh.add_attribute(label("b", 2)).unwrap_err());
    refused(mesh.add_attribute(label("c", 1)).unwrap_err());
    assert_eq!(mesh.attributes().len(), 2);
    mesh.add_attribute(label("c", 2)).unwrap();
    let names: Vec<&str> = mesh.attributes().iter().map(MeshAttribute::name).collect();
    assert_eq!((names, mesh.attribute("d")), (vec!["a", "b", "c"], None));
    assert_eq!(mesh.take_attributes().len(), 3);
    assert_eq!(mesh.attributes(), []);
}

/// A tetrahedron of this size at a place. Seen from outside, its triangles are counter-clockwise.
fn tetrahedron(at: Point, size: f64) -> [[Point; 3]; 4] {
    let corners: [Point; 4] = [
        at,
        array(|k| at[k] + [size, 0.0, 0.0][k]),
        array(|k| at[k] + [0.0, size, 0.0][k]),
        array(|k| at[k] + [0.0, 0.0, size][k]),
    ];
    [[0usize, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|face| face.map(|corner| corners[corner]))
}

#[test]
fn bodies_are_numbered_by_their_first_triangles() {
    let bodies =
        [tetrahedron([0.0; 3], 1.0), tetrahedron([5.0, 0.0, 0.0], 2.0), tetrahedron([0.0, 9.0, 0.0], 1.0)];
    // Their triangles alternate.
    let facets: Vec<[Point; 3]> = (0..4).flat_map(|k| [1, 2, 0].map(|body| bodies[body][k])).collect();
    let mut mesh = TriangleMesh::from_facets(facets).unwrap();
    let labels = mesh.bodies().unwrap();
    assert_eq!(labels, [0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2]);
    assert_eq!(mesh.report().unwrap().bodies, 3);
    // A value for each body.
    let heat = MeshAttribute::by_triangle("heat", 1, vec![10.0, 20.0, 30.0], labels).unwrap();
    mesh.add_attribute(heat).unwrap();
    let heat = SurfaceAttribute::of_mesh(mesh, "heat").unwrap();
    for (point, expected) in
        [([5.1, 0.1, 0.1], 10.0), ([0.1, 9.1, 0.1], 20.0), ([0.2, 0.2, 0.2], 30.0), ([-9.0, 0.0, 0.0], 30.0)]
    {
        assert_eq!(heat.value(point).unwrap(), Some([expected, 0.0, 0.0, 0.0]));
    }
    assert!(TriangleMesh::new(vec![], vec![]).unwrap().bodies().unwrap().is_empty());
}

/// Two cubes, the first with a void. The second cube's vertices are those of the first, translated.
fn polyhedron() -> Polyhedron {
    let cube = |low: f64, high: f64, x: f64| {
        (0..8usize).map(move |k| {
            let at: Point = array(|axis| if k >> axis & 1 == 0 { low } else { high });
            [at[0] + x, at[1], at[2]]
        })
    };
    let vertices: Vec<Point> =
        cube(0.0, 3.0, 0.0).chain(cube(1.0, 2.0, 0.0)).chain(cube(0.0, 1.0, 5.0)).collect();
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let mut corners: Vec<u32> = Vec::new();
    for (first, is_void) in [(0, false), (8, true), (16, false)] {
        for mut face in faces {
            if is_void {
                face.reverse();
            }
            corners.extend(face.map(|v| v + first));
        }
    }
    Polyhedron::new(&PolyhedronArrays {
        vertices: &vertices,
        corners: &corners,
        loops: &(0..=18).map(|k| 4 * k).collect::<Vec<u32>>(),
        faces: &(0..=18).collect::<Vec<u32>>(),
        shells: &[0, 6, 12, 18],
        solids: &[0, 2, 3],
    })
    .unwrap()
}

#[test]
fn parts_of_polyhedra() {
    use PolyhedronPart::*;
    let mut polyhedron = polyhedron();
    assert_eq!([Face, Shell, Solid].map(|part| polyhedron.part_count(part)), [18, 3, 2]);
    let faces = polyhedron.parts(Face).unwrap();
    assert_eq!(faces, (0..36).map(|t| t / 2).collect::<Vec<u32>>());
    assert_eq!(polyhedron.parts(Shell).unwrap(), (0..36).map(|t| t / 12).collect::<Vec<u32>>());
    assert_eq!(polyhedron.parts(Solid).unwrap(), (0..36).map(|t| t / 24).collect::<Vec<u32>>());
    // Bodies of the mesh are shells.
    assert_eq!(polyhedron.mesh().bodies().unwrap(), polyhedron.parts(Shell).unwrap());

    let colours: Vec<f64> = (0..18).flat_map(|k| [f64::from(k), 0.0, 255.0, 255.0]).collect();
    let colour = polyhedron.attribute(Face, "colour", 4, &colours).unwrap();
    assert_eq!((colour.domain(), colour.len()), (AttributeDomain::Triangle, 36));
    assert_eq!(colour.value(35, 2), Some([17.0, 0.0, 255.0, 255.0]));
    polyhedron.add_attribute(colour).unwrap();
    let material = polyhedron.attribute(Solid, "material", 1, &[7.0, 9.0]).unwrap();
    polyhedron.add_attribute(material.named(vec!["steel".into()])).unwrap();
    for (components, count) in [(1, 17), (1, 19), (0, 0), (5, 90), (usize::MAX, 18)] {
        let result = polyhedron.attribute(Face, "a", components, &vec![0.0; count]);
        assert!(matches!(result, Err(Error::Argument { .. })), "{result:?}");
    }
    // The mesh takes them along.
    let mesh = polyhedron.into_mesh().translated([0.0, 0.0, 1.0]).unwrap();
    let colour = SurfaceAttribute::of_mesh(mesh, "colour").unwrap();
    let material = colour.with_name("material").unwrap();
    assert_eq!(material.attribute().names(), ["steel"]);
    assert!(colour.with_name("shade").is_err());
    // Faces are left, right, front, back, bottom, top.
    assert_eq!(colour.value([-1.0, 1.5, 2.5]).unwrap(), Some([0.0, 0.0, 255.0, 255.0]));
    assert_eq!(colour.value([5.5, 0.5, 2.25]).unwrap(), Some([17.0, 0.0, 255.0, 255.0]));
    assert_eq!(material.value([3.5, 1.5, 1.5]).unwrap(), Some([7.0, 0.0, 0.0, 0.0]));
    assert_eq!(material.value([4.5, 0.5, 1.5]).unwrap(), Some([9.0, 0.0, 0.0, 0.0]));
}

#[test]
fn faces_of_triangles_that_are_dropped() {
    // A prism over a hexagon that touches itself: two vertices at one place, between which a triangle may
    // lie.
    let ring = [[0.0, 0.0], [2.0, -1.0], [2.0, 1.0], [0.0, 0.0], [-2.0, 1.0], [-2.0, -1.0]];
    let vertices: Vec<Point> = [0.0, 1.0].into_iter().flat_map(|z| ring.map(|[x, y]| [x, y, z])).collect();
    let mut loops: Vec<Vec<u32>> = vec![(0..6).rev().collect(), (6..12).collect()];
    loops.extend((0..6).map(|k| vec![k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k]));
    let ends = |lengths: &[usize]| {
        std::iter::once(0)
            .chain(lengths.iter().scan(0, |sum, &length| {
                *sum += length as u32;
                Some(*sum)
            }))
            .collect::<Vec<u32>>()
    };
    let polyhedron = Polyhedron::new(&PolyhedronArrays {
        vertices: &vertices,
        corners: &loops.concat(),
        loops: &ends(&loops.iter().map(Vec::len).collect::<Vec<_>>()),
        faces: &(0..=8).collect::<Vec<u32>>(),
        shells: &[0, 8],
        solids: &[0, 1],
    });
    // The loop may touch itself, so that the polyhedron is refused. Otherwise each triangle lies in its face.
    let Ok(polyhedron) = polyhedron else { return };
    let parts = polyhedron.parts(PolyhedronPart::Face).unwrap();
    assert_eq!(parts.len(), polyhedron.mesh().triangles().len());
    for (triangle, &face) in polyhedron.mesh().triangles().iter().zip(&parts) {
        let places =
            |corners: &[u32]| -> Vec<Point> { corners.iter().map(|&v| vertices[v as usize]).collect() };
        let face = places(&loops[face as usize]);
        assert!(triangle.iter().all(|&v| face.contains(&polyhedron.mesh().vertices()[v as usize])));
    }
}

fn sub(a: Point, b: Point) -> Point {
    array(|k| a[k] - b[k])
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the distance of a point from a triangle, and the barycentric weights of the nearest point. It uses
/// Ericson's regions, unlike the library.
pub fn distance(p: Point, [a, b, c]: [Point; 3]) -> (f64, Point) {
    let (ab, ac) = (sub(b, a), sub(c, a));
    let at = |weights: Point| {
        let q: Point = array(|k| weights[0] * a[k] + weights[1] * b[k] + weights[2] * c[k]);
        (dot(sub(p, q), sub(p, q)).sqrt(), weights)
    };
    let [ap, bp, cp] = [a, b, c].map(|q| sub(p, q));
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return at([1.0, 0.0, 0.0]);
    }
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return at([0.0, 1.0, 0.0]);
    }
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return at([0.0, 0.0, 1.0]);
    }
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return at([1.0 - v, v, 0.0]);
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return at([1.0 - w, 0.0, w]);
    }
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return at([0.0, 1.0 - w, w]);
    }
    let sum = va + vb + vc;
    at([va / sum, vb / sum, vc / sum])
}

/// A torus of 2·n² triangles, or an open piece of it, with slightly moved vertices.
fn torus(random: &mut Random, n: u32, is_open: bool) -> TriangleMesh {
    let angle = |i: u32| f64::from(i % n) / f64::from(n) * std::f64::consts::TAU;
    let vertices: Vec<Point> = (0..n * n)
        .map(|i| {
            let ((sin_u, cos_u), (sin_v, cos_v)) = (angle(i / n).sin_cos(), angle(i % n).sin_cos());
            let radius = 1.0 + 0.4 * cos_v + random.between(-0.01, 0.01);
            [radius * cos_u, radius * sin_u, 0.4 * sin_v]
        })
        .collect();
    let at = |i: u32, j: u32| (i % n) * n + j % n;
    let quads = (0..n * n).filter(|k| !is_open || k % 7 != 3);
    let triangles = quads.flat_map(|k| {
        let (i, j) = (k / n, k % n);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    TriangleMesh::new(vertices, triangles.collect()).unwrap()
}

fn corners(mesh: &TriangleMesh, triangle: usize) -> [Point; 3] {
    mesh.triangles()[triangle].map(|v| mesh.vertices()[v as usize])
}

#[test]
fn the_nearest_triangle_decides() {
    let mut random = Random(5);
    for is_open in [false, true] {
        let mesh = torus(&mut random, 12, is_open);
        let count = mesh.triangles().len();
        let number = MeshAttribute::labels("number", (0..count as u32).collect()).unwrap();
        let places: Vec<f64> = (0..count).flat_map(|t| corners(&mesh, t)).flatten().collect();
        let place = MeshAttribute::per_corner("place", 3, &places).unwrap();
        let number = SurfaceAttribute::new(mesh.clone(), number).unwrap();
        let place = number.with(place).unwrap();
        let points: Vec<Point> = (0..2000)
            .map(|k| array(|_| random.between(-1.5, 1.5) * if k % 10 == 0 { 100.0 } else { 1.0 }))
            .collect();
        let (mut numbers, mut places) = (vec![None; points.len()], vec![None; points.len()]);
        number.values(&points, &mut numbers).unwrap();
        place.values(&points, &mut places).unwrap();
        for ((&p, number), place) in points.iter().zip(&numbers).zip(&places) {
            let of = |t: usize| distance(p, corners(&mesh, t)).0;
            let least = (0..count).map(of).fold(f64::INFINITY, f64::min);
            let size = 1.0 + least;
            let found = one(*number) as usize;
            assert!(of(found) <= least + 1e-13 * size);
            // If no other triangle is equally near, the answer is unique. Where triangles touch, the first
            // one is the answer.
            let first = (0..count).find(|&t| of(t) <= least + 1e-12 * size).unwrap();
            let alone = (0..count).filter(|&t| of(t) <= least + 1e-12 * size).count() == 1;
            assert!(!alone || found == first);
            // The interpolated place is the nearest point.
            let [x, y, z, _] = place.unwrap();
            let to = sub(p, [x, y, z]);
            assert!((dot(to, to).sqrt() - least).abs() <= 1e-12 * size, "{p:?}");
        }
    }
}

#[test]
fn points_and_triangles_without_values() {
    let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 0.0]];
    let triangles = vec![[0, 1, 2], [0, 2, 3], [1, 4, 2]];
    let mesh = TriangleMesh::new(vertices, triangles).unwrap();
    let heat = MeshAttribute::per_triangle("heat", 1, &[1.0, f64::NAN, 3.0]).unwrap();
    let heat = SurfaceAttribute::new(mesh.clone(), heat).unwrap();
    let value = |x: f64, y: f64| heat.value([x, y, 0.25]).unwrap().map(|value| value[0]);
    assert_eq!((value(0.8, 0.2), value(0.2, 0.8), value(1.5, 0.1)), (Some(1.0), None, Some(3.0)));
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!((value(x, 0.0), value(0.0, x)), (None, None));
    }
    // On the edge of two triangles the first one counts.
    assert_eq!(value(1.0, 0.5), Some(1.0));
    let range = |min: Point, max: Point| heat.range(&Bounds { min, max }).unwrap();
    let exactly = |x: f64| ValueRange::exactly(Some([x, 0.0, 0.0, 0.0]));
    assert_eq!(range([0.8, 0.1, 0.0], [0.85, 0.15, 0.01]), exactly(1.0));
    assert_eq!(range([1.6, 0.0, 0.0], [1.65, 0.05, 0.01]), exactly(3.0));
    assert_eq!(range([0.1, 0.8, 0.0], [0.15, 0.85, 0.01]), ValueRange::Nowhere);
    assert_eq!(range([0.4, 0.4, 0.0], [0.6, 0.6, 0.1]), ValueRange::Unknown);
    assert_eq!(range([-9.0; 3], [9.0; 3]), ValueRange::Unknown);
    assert_eq!(range([0.0; 3], [1e300, 1.0, 1.0]), ValueRange::Unknown);
    // If a corner has no value, the whole triangle has none.
    let shade = MeshAttribute::per_corner("shade", 1, &[1.0, 2.0, f64::NAN, 1., 2., 3., 1., 1., 1.]).unwrap();
    let shade = heat.with(shade).unwrap();
    assert_eq!(shade.value([0.8, 0.2, 1.0]).unwrap(), None);
    assert_eq!(shade.value([0.0, 1.0, 1.0]).unwrap(), Some([3.0, 0.0, 0.0, 0.0]));
    let none = TriangleMesh::new(vec![], vec![]).unwrap();
    let none = SurfaceAttribute::new(none, MeshAttribute::labels("a", vec![]).unwrap()).unwrap();
    assert_eq!(none.value([0.0; 3]).unwrap(), None);
    assert_eq!(none.range(&Bounds { min: [0.0; 3], max: [1.0; 3] }).unwrap(), ValueRange::Nowhere);
    assert!(heat.with(MeshAttribute::labels("a", vec![0; 2]).unwrap()).is_err());
}

#[test]
fn a_welded_vertex_has_two_colours() {
    // Two faces of a roof; on the ridge each has its own colour.
    let vertices: Vec<Point> = vec![
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [0.0, -1.0, 0.0],
    ];
    let shade = MeshAttribute::per_corner("shade", 1, &[1.0, 2.0, 3.0, 10.0, 20.0, 30.0]).unwrap();
    let mesh = TriangleMesh::with_attributes(vertices, vec![[0, 1, 2], [4, 3, 5]], vec![shade]).unwrap();
    assert_eq!(mesh.vertices().len(), 4);
    let shade = SurfaceAttribute::of_mesh(mesh, "shade").unwrap();
    let near = |y: f64| one(shade.value([1e-12, y, 1.0]).unwrap());
    assert!((near(1e-9) - 1.0).abs() < 1e-6 && (near(-1e-9) - 20.0).abs() < 1e-6);
}

#[test]
fn ranges_hold_all_values() {
    let mut random = Random(9);
    for round in 0..6 {
        let mesh = if round < 4 {
            torus(&mut random, [6, 14][round % 2], round > 1)
        } else {
            let (vertices, triangles) = lattice_soup(&mut random, 40);
            TriangleMesh::new(vertices, triangles).unwrap()
        };
        let count = mesh.triangles().len();
        // Patches of one value each, and a gradient.
        let patches = (0..count as u32).map(|t| t / 9 % 4).collect();
        let patches =
            SurfaceAttribute::new(mesh.clone(), MeshAttribute::labels("patch", patches).unwrap()).unwrap();
        let shades: Vec<f64> =
            (0..count).flat_map(|t| corners(&mesh, t)).map(|[x, y, z]| x - y + z * z).collect();
        let shades = patches.with(MeshAttribute::per_corner("shade", 1, &shades).unwrap()).unwrap();
        let (mut known, mut exact) = (0, 0);
        for k in 0..600 {
            let size = [1.0, 0.2, 0.03, 1e-3, 1e-8][k % 5];
            let at: Point = array(|_| random.between(-2.0, 2.0));
            let min = at;
            let max = array(|axis| at[axis] + size * random.between(0.0, 1.0));
            let bounds = Bounds::new(min, max).unwrap();
            for attribute in [&patches, &shades] {
                let range = attribute.range(&bounds).unwrap();
                let ValueRange::Within(ranges) = range else { panic!("{range:?}") };
                known += 1;
                exact += usize::from(range.width(1) == 0.0);
                let points: Vec<Point> = (0..40)
                    .map(|_| {
                        array(|axis| {
                            let inside = min[axis] + random.between(0.0, 1.0) * (max[axis] - min[axis]);
                            [inside, min[axis], max[axis]][random.below(3) as usize]
                                .clamp(min[axis], max[axis])
                        })
                    })
                    .collect();
                let mut values = vec![None; points.len()];
                attribute.values(&points, &mut values).unwrap();
                assert!(values.into_iter().all(|value| ranges[0].contains(one(value))), "{bounds:?}");
            }
        }
        assert!(exact > known / 8, "{exact} of {known}");
    }
}

/// A box near a patch of one value, far from others, has exactly that value. A box near a border has both
/// values.
#[test]
fn ranges_are_no_wider_than_needed() {
    // A square of 100 × 100 cells, its left half of value 1, its right half of value 2.
    let n = 100u32;
    let vertices = (0..=n).flat_map(|j| (0..=n).map(move |i| [f64::from(i), f64::from(j), 0.0])).collect();
    let at = |i: u32, j: u32| j * (n + 1) + i;
    let triangles: Vec<[u32; 3]> = (0..n * n)
        .flat_map(|k| {
            let (i, j) = (k % n, k / n);
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    let labels = (0..2 * n * n).map(|t| 1 + u32::from(t / 2 % n >= n / 2)).collect();
    let mesh = TriangleMesh::new(vertices, triangles).unwrap();
    let half = SurfaceAttribute::new(mesh, MeshAttribute::labels("half", labels).unwrap()).unwrap();
    let range = |x: f64, z: f64, size: f64| {
        let bounds = Bounds { min: [x, 30.0, z], max: [x + size, 30.0 + size, z + size] };
        match half.range(&bounds).unwrap() {
            ValueRange::Within([range, ..]) => (range.lower, range.upper),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(range(20.0, 0.0, 1.0), (1.0, 1.0));
    assert_eq!(range(70.0, 0.0, 1.0), (2.0, 2.0));
    assert_eq!(range(49.5, 0.0, 1.0), (1.0, 2.0));
    // At height z, a box of size s is nearest to points up to (2 z s)^½ away.
    assert_eq!(range(40.0, 16.0, 1.0), (1.0, 1.0));
    assert_eq!(range(47.0, 16.0, 1.0), (1.0, 2.0));
    assert_eq!(range(0.0, -200.0, 400.0), (1.0, 2.0));
}

/// Measures the time of a million queries on a mesh of a hundred thousand triangles.
#[test]
#[ignore = "a measurement"]
fn a_million_questions() {
    let mut random = Random(3);
    let mesh = torus(&mut random, 224, false);
    let count = mesh.triangles().len();
    let timed = |what: &str, questions: usize, ask: &mut dyn FnMut()| {
        let start = std::time::Instant::now();
        ask();
        let seconds = start.elapsed().as_secs_f64();
        println!("{what}: {seconds:.3} s, {:.0} ns each", seconds / questions as f64 * 1e9);
    };
    let places: Vec<f64> = (0..count).flat_map(|t| corners(&mesh, t)).flatten().collect();
    let place = MeshAttribute::per_corner("place", 3, &places).unwrap();
    let mut attribute = None;
    println!("{count} triangles");
    timed("tree", count, &mut || {
        attribute = Some(SurfaceAttribute::new(mesh.clone(), place.clone()).unwrap())
    });
    let place = attribute.unwrap();
    let patches = (0..count as u32).map(|t| t / 5000).collect();
    let patch = place.with(MeshAttribute::labels("patch", patches).unwrap()).unwrap();
    for (what, size) in [("anywhere", 1.5), ("near", 0.0)] {
        let points: Vec<Point> = (0..1_000_000)
            .map(|_| {
                let [a, ..] = corners(&mesh, random.below(count as u64) as usize);
                array(|k| {
                    if size > 0.0 { random.between(-size, size) } else { a[k] + random.between(-0.01, 0.01) }
                })
            })
            .collect();
        let mut values = vec![None; points.len()];
        timed(&format!("values {what}"), points.len(), &mut || place.values(&points, &mut values).unwrap());
        for edge in [0.1, 0.01, 0.001] {
            for (name, attribute) in [("corners", &place), ("patches", &patch)] {
                let boxes = &points[..20_000];
                let mut exact = 0;
                timed(&format!("ranges {what}, {name}, edge {edge}"), boxes.len(), &mut || {
                    for &min in boxes {
                        let range = attribute.range(&Bounds { min, max: min.map(|x| x + edge) }).unwrap();
                        exact += usize::from(range.width(1) == 0.0);
                    }
                });
                println!("  {exact} of one value");
            }
        }
    }
    // Points in order, like a row of voxels.
    let row: Vec<Point> = (0..1_000_000)
        .map(|k| [f64::from(k % 1000) / 333.0 - 1.5, f64::from(k / 1000) / 333.0 - 1.5, 0.1])
        .collect();
    let mut values = vec![None; row.len()];
    timed("values in order", row.len(), &mut || place.values(&row, &mut values).unwrap());
}

/// A surface has the values just inside of it.
#[test]
fn values_just_inside_of_a_surface() {
    // Two materials side by side, which end at the ball.
    let inside = |p: Point| p.iter().map(|c| c * c).sum::<f64>() < 0.49;
    let sides = FunctionAttribute::new(1, move |p: Point| {
        inside(p).then_some([if p[0] < 0.1 { 3.0 } else { 5.0 }, 0.0, 0.0, 0.0])
    })
    .unwrap();
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let ball = Csg::ball([0.0; 3], 0.7).unwrap();
    let mesh = marching_cubes_solid(&ball, &frame, VertexPlacement::Crossing, &alone()).unwrap();
    let depth = 0.5 * frame.cell_size();
    let found = sample_triangles(&mesh, &sides, "material", depth, &alone()).unwrap();
    for (t, triangle) in mesh.triangles().iter().enumerate() {
        let x = triangle.iter().map(|&v| mesh.vertices()[v as usize][0]).sum::<f64>() / 3.0;
        // The point behind the centroid is displaced by at most the depth.
        let expected = if x < 0.1 { 3.0 } else { 5.0 };
        let value = found.value(t, 0).unwrap_or_else(|| panic!("{t} at {x} has none"));
        assert!((x - 0.1).abs() <= depth || value == [expected, 0.0, 0.0, 0.0], "{value:?} at {x}");
    }
    // Values that many have are stored once, and threads do not matter.
    assert!(found.bytes() < 4 * mesh.triangles().len() as u64 + 512);
    assert_eq!(sample_triangles(&mesh, &sides, "material", depth, &Control::threads(4)).unwrap(), found);
    // The same for an octree's channel.
    let value_type = ValueType::new(ScalarType::U8, 1).unwrap();
    let options = FillOptions { value_type, frame, solid: None, detail: None };
    let channel = fill_channel(&sides, &options, &alone()).unwrap();
    let of_cells = sample_triangles(&mesh, &channel.view().unwrap(), "material", depth, &alone()).unwrap();
    let others = (0..mesh.triangles().len()).filter(|&t| of_cells.value(t, 0) != found.value(t, 0)).count();
    assert!(others * 10 < mesh.triangles().len(), "{others}");
    assert!((0..mesh.triangles().len()).all(|t| of_cells.value(t, 0).is_some()));

    // An attribute in a thin layer, and an attribute without values.
    let sheet = block([0.0; 3], [1.0, 1.0, 0.01]);
    let thin =
        FunctionAttribute::new(2, |p: Point| (0.0..0.01).contains(&p[2]).then_some([p[2], 1.0, 0.0, 0.0]));
    let found = sample_triangles(&sheet, &thin.unwrap(), "thin", 0.02, &alone()).unwrap();
    assert!((0..12).filter(|&t| found.value(t, 0).is_some()).count() >= 4);
    let nothing = FunctionAttribute::new(1, |_: Point| None).unwrap();
    let found = sample_triangles(&sheet, &nothing, "nothing", 0.0, &alone()).unwrap();
    assert!((0..12).all(|t| found.value(t, 0).is_none()));
    for wrong in [-1.0, f64::NAN, f64::INFINITY] {
        let error = sample_triangles(&sheet, &nothing, "nothing", wrong, &alone()).unwrap_err();
        assert!(matches!(error, Error::Argument { name: "depth", .. }), "{error}");
    }
}

fn block(min: Point, max: Point) -> TriangleMesh {
    crate::shapes::mesh(&crate::shapes::block(min, max))
}
