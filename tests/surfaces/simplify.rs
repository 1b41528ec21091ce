//! Meshes with fewer triangles.

use leafless::exchange::{MeshOptions, open_mesh};
use leafless::mesh::MeshAttribute;
use leafless::surface::{VertexPlacement, marching_cubes_solid, simplify};
use leafless::{Control, Csg, Error, Frame, TriangleMesh};
use leafless_testkit::surfaces::{components, euler_of_manifold};
use leafless_testkit::{Random, alone, model};

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the distance of a point from a triangle (Ericson, *Real-time collision detection*, 2005, section
/// 5.1.5).
fn from_triangle(p: [f64; 3], [a, b, c]: [[f64; 3]; 3]) -> f64 {
    let (ab, ac) = (minus(b, a), minus(c, a));
    let at = |s: f64, t: f64| {
        let q = [0, 1, 2].map(|k| a[k] + s * ab[k] + t * ac[k]);
        dot(minus(p, q), minus(p, q)).sqrt()
    };
    let segment = |from: [f64; 3], to: [f64; 3]| {
        let way = minus(to, from);
        let t = (dot(minus(p, from), way) / dot(way, way)).clamp(0.0, 1.0);
        let q = [0, 1, 2].map(|k| from[k] + t * way[k]);
        dot(minus(p, q), minus(p, q)).sqrt()
    };
    let (d1, d2, d3) = (dot(ab, ab), dot(ab, ac), dot(ac, ac));
    let (e1, e2) = (dot(minus(p, a), ab), dot(minus(p, a), ac));
    let size = d1 * d3 - d2 * d2;
    let (s, t) = ((d3 * e1 - d2 * e2) / size, (d1 * e2 - d2 * e1) / size);
    let edges = segment(a, b).min(segment(b, c)).min(segment(c, a));
    if s >= 0.0 && t >= 0.0 && s + t <= 1.0 { edges.min(at(s, t)) } else { edges }
}

/// Returns the greatest distance of points all over one mesh from another mesh, triangle by triangle.
fn sampled(from: &TriangleMesh, to: &TriangleMesh, random: &mut Random, count: usize) -> f64 {
    let corners =
        |mesh: &TriangleMesh, k: usize| mesh.triangles()[k].map(|vertex| mesh.vertices()[vertex as usize]);
    let mut most: f64 = 0.0;
    for _ in 0..count {
        let [a, b, c] = corners(from, random.below(from.triangles().len() as u64) as usize);
        let (s, t) = (random.unit(), random.unit());
        let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
        let p = [0, 1, 2].map(|k| a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]));
        let own = (0..to.triangles().len()).map(|k| from_triangle(p, corners(to, k)));
        most = most.max(own.fold(f64::INFINITY, f64::min));
    }
    most
}

/// Simplifies a mesh, checks the promises for closed manifolds, and returns the result.
#[track_caller]
fn check(mesh: &TriangleMesh, tolerance: f64, random: &mut Random) -> TriangleMesh {
    let found = simplify(mesh, tolerance, &alone()).unwrap();
    let report = *found.report();
    assert!(report.deviation <= tolerance, "{report:?}");
    let before = mesh.intersecting_pairs(1, &alone()).unwrap().count;
    assert!(report.intersecting_pairs <= before, "{report:?}, {before} before");
    assert_eq!(report.removed as usize, mesh.triangles().len() - found.mesh().triangles().len());
    assert_eq!(euler_of_manifold(found.mesh()), euler_of_manifold(mesh));
    assert_eq!(components(found.mesh()), components(mesh));
    assert_eq!(found.mesh().deviation(), report.deviation);
    let all: Vec<_> = mesh.vertices().iter().map(|v| v.map(f64::to_bits)).collect();
    assert!(found.mesh().vertices().iter().all(|v| all.contains(&v.map(f64::to_bits))), "a vertex moved");
    for far in [sampled(mesh, found.mesh(), random, 300), sampled(found.mesh(), mesh, random, 300)] {
        assert!(far <= report.deviation * (1.0 + 1e-9) + 1e-12, "{far} is more than {report:?}");
    }
    let again = simplify(mesh, tolerance, &Control::threads(3)).unwrap();
    assert_eq!(again.mesh().triangles(), found.mesh().triangles());
    found.into_mesh()
}

/// A closed mesh: a cube with lattice faces, moved by a function.
fn lattice_cube(side: u32, f: impl Fn([f64; 3]) -> [f64; 3]) -> TriangleMesh {
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for is_upper in [false, true] {
            let first = vertices.len() as u32;
            for j in 0..=side {
                for i in 0..=side {
                    let mut p = [0.0; 3];
                    p[axis] = if is_upper { 1.0 } else { -1.0 };
                    p[(axis + 1) % 3] = f64::from(i) / f64::from(side) * 2.0 - 1.0;
                    p[(axis + 2) % 3] = f64::from(j) / f64::from(side) * 2.0 - 1.0;
                    vertices.push(f(p));
                }
            }
            for j in 0..side {
                for i in 0..side {
                    let at = |i: u32, j: u32| first + j * (side + 1) + i;
                    let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                    let both = if is_upper { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
                    triangles.extend(both);
                }
            }
        }
    }
    TriangleMesh::new(vertices, triangles).unwrap()
}

fn ball(p: [f64; 3]) -> [f64; 3] {
    let length = dot(p, p).sqrt();
    p.map(|c| c / length)
}

#[test]
fn plane_faces_become_triangles_between_corners() {
    let mut random = Random(1);
    let cube = lattice_cube(12, |p| p);
    assert_eq!(cube.triangles().len(), 12 * 12 * 12);
    let simple = check(&cube, 1e-9, &mut random);
    assert_eq!((simple.triangles().len(), simple.volume()), (12, 8.0));
    // After a rotation, its coordinates are rounded.
    let turned = lattice_cube(9, |[x, y, z]| [0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, z + 0.3 * x]);
    assert_eq!(check(&turned, 1e-9, &mut random).triangles().len(), 12);
}

#[test]
fn round_bodies_within_the_tolerance() {
    let mut random = Random(2);
    let mesh = lattice_cube(16, ball);
    let mut counts = Vec::new();
    for tolerance in [1e-6, 1e-3, 3e-3, 1e-2, 3e-2, 0.1] {
        counts.push(check(&mesh, tolerance, &mut random).triangles().len());
    }
    assert!(counts.windows(2).all(|two| two[1] <= two[0]), "{counts:?}");
    assert!(counts[0] > 3000 && counts[3] < 900 && counts[5] < 100, "{counts:?}");
}

/// With any tolerance, a body stays a body, and a hole stays a hole.
#[test]
fn tolerances_larger_than_the_mesh() {
    let mut random = Random(3);
    for tolerance in [1.0, 10.0, 1e30] {
        let small = check(&lattice_cube(8, ball), tolerance, &mut random);
        assert!(small.triangles().len() < 200, "{}", small.triangles().len());
    }
    let torus = Csg::torus(2.0, 0.6).unwrap();
    let frame = Frame::new([-4.0; 3], 8.0, 5).unwrap();
    let mesh = marching_cubes_solid(&torus, &frame, VertexPlacement::Crossing, &alone()).unwrap();
    assert_eq!(euler_of_manifold(&check(&mesh, 1e3, &mut random)), 0);
}

/// Random bodies from marching cubes. Some have several parts and holes.
#[test]
fn random_bodies() {
    let mut random = Random(4);
    for _ in 0..12 {
        let parts = (0..1 + random.below(4)).map(|_| {
            let at: [f64; 3] = std::array::from_fn(|_| 3.0 * random.unit() - 1.5);
            let far = at.map(|c| c + 0.3 + random.unit());
            match random.below(3) {
                0 => Csg::ball(at, 0.3 + random.unit()),
                1 => Csg::cuboid(at, far),
                _ => Csg::cylinder_between(at, far, 0.2 + 0.5 * random.unit()),
            }
            .unwrap()
        });
        let joined = Csg::xor_of(parts.collect::<Vec<_>>()).unwrap();
        let frame = Frame::new([-4.0; 3], 8.0, 5).unwrap();
        let mesh = marching_cubes_solid(&joined, &frame, VertexPlacement::Crossing, &alone()).unwrap();
        let tolerance = 0.1f64.powf(1.0 + 2.0 * random.unit());
        check(&mesh, tolerance, &mut random);
    }
}

#[test]
fn edges_of_open_meshes_stay() {
    // A lattice in a plane. Its inner vertices are removed, and those on its rim stay.
    let side = 10u32;
    let at = |i: u32, j: u32| j * (side + 1) + i;
    let vertices = (0..(side + 1) * (side + 1))
        .map(|k| [f64::from(k % (side + 1)), f64::from(k / (side + 1)), 0.0])
        .collect();
    let mut triangles = Vec::new();
    for (i, j) in (0..side * side).map(|k| (k % side, k / side)) {
        triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
        triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    let mesh = TriangleMesh::new(vertices, triangles).unwrap();
    let found = simplify(&mesh, 1e-6, &alone()).unwrap();
    assert_eq!((found.mesh().triangles().len(), found.mesh().area()), (4 * side as usize - 2, 100.0));
    assert!(found.report().deviation < 1e-9);
}

/// Per-triangle values are kept, and triangles with different values are not merged.
#[test]
fn values_stay_where_they_are() {
    let mut mesh = lattice_cube(10, |p| p);
    let middle = |mesh: &TriangleMesh, k: usize, axis: usize| -> f64 {
        mesh.triangles()[k].iter().map(|&v| mesh.vertices()[v as usize][axis]).sum::<f64>() / 3.0
    };
    let halves = (0..mesh.triangles().len()).map(|k| u32::from(middle(&mesh, k, 0) > 0.0)).collect();
    mesh.add_attribute(MeshAttribute::labels("half", halves).unwrap()).unwrap();
    let corners = vec![1.0; 3 * mesh.triangles().len()];
    mesh.add_attribute(MeshAttribute::per_corner("corner", 1, &corners).unwrap()).unwrap();
    let found = simplify(&mesh, 1e-6, &alone()).unwrap();
    // Two plane ends of two triangles, and four sides of two halves.
    assert_eq!(found.mesh().triangles().len(), 2 * 2 + 4 * 2 * 2);
    assert!(found.mesh().attribute("corner").is_none());
    let half = found.mesh().attribute("half").unwrap();
    for k in 0..found.mesh().triangles().len() {
        let expected = f64::from(u32::from(middle(found.mesh(), k, 0) > 0.0));
        assert_eq!(half.value(k, 0).map(|value| value[0]), Some(expected));
    }
}

/// Flat triangles, vertices where bodies touch, edges with many triangles, and empty meshes do no harm.
#[test]
fn meshes_that_are_no_manifolds() {
    let empty = TriangleMesh::new(Vec::new(), Vec::new()).unwrap();
    let found = simplify(&empty, 1.0, &alone()).unwrap();
    assert!(found.mesh().triangles().is_empty() && found.report().deviation == 0.0);
    // Two cubes with a common edge of four triangles; flat triangles; three triangles at one edge.
    let one = lattice_cube(3, |p| p);
    let other = one.translated([2.0, 2.0, 0.0]).unwrap();
    let mut vertices = [one.vertices(), other.vertices()].concat();
    let shift = one.vertices().len() as u32;
    let mut triangles = one.triangles().to_vec();
    triangles.extend(other.triangles().iter().map(|t| t.map(|v| v + shift)));
    let first = vertices.len() as u32;
    vertices.extend([[9.0, 0.0, 0.0], [10.0, 0.0, 0.0], [11.0, 0.0, 0.0], [9.0, 1.0, 0.0], [9.0, 0.0, 1.0]]);
    triangles.extend([[0, 1, 2], [0, 1, 3], [1, 0, 4], [0, 1, 4]].map(|t| t.map(|v| v + first)));
    let mesh = TriangleMesh::new(vertices, triangles).unwrap();
    let found = simplify(&mesh, 1e-3, &alone()).unwrap();
    assert!(found.report().deviation <= 1e-3, "{:?}", found.report());
    let count = found.mesh().triangles().len();
    assert!((24 + 4..mesh.triangles().len() / 2).contains(&count), "{count}");
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            simplify(&mesh, tolerance, &alone()),
            Err(Error::Argument { name: "tolerance", .. })
        ));
    }
}

/// Real meshes: the number of triangles left, and the promises.
#[test]
fn real_meshes() {
    for (name, part, most) in
        [("fandisk.obj", 1e-3, 900), ("spot.obj", 1e-3, 4300), ("rocker-arm.obj", 1e-2, 2500)]
    {
        let Some(path) = model(name) else { continue };
        let mesh = open_mesh(path, &MeshOptions::default()).unwrap().mesh;
        let (low, high) = mesh.bounds();
        let size = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        let found = simplify(&mesh, part * size, &alone()).unwrap();
        let report = found.report();
        assert!(report.deviation <= part * size && report.intersecting_pairs == 0, "{name}: {report:?}");
        let count = found.mesh().triangles().len();
        assert!(count <= most, "{name}: {count}");
        assert_eq!(euler_of_manifold(found.mesh()), euler_of_manifold(&mesh), "{name}");
    }
}
