//! Meshes in single precision: repairs of what rounding breaks, and the resulting displacement of the
//! surface.

use crate::boundary::{away_from_mesh, plate};
use leafless::exchange::{MeshFormat, WriteOptions, written_form};
use leafless::mesh::SinglePrecision;
use leafless::surface::{VertexPlacement, marching_cubes_solid};
use leafless::{Affine, Csg, Error, Frame, Solid, TriangleMesh};
use leafless_testkit::surfaces::euler_of_manifold;
use leafless_testkit::{Random, alone, repeated};

/// Marching cubes with vertices on the surface, on a lattice slightly off the faces.
fn cubes(solid: &Csg, depth: u8) -> TriangleMesh {
    let bounds = solid.bounds().unwrap();
    let longest = (0..3).map(|k| bounds.max[k] - bounds.min[k]).fold(0.0, f64::max);
    let low = [0, 1, 2].map(|k| bounds.min[k] - longest / [89.0, 97.0, 101.0][k]);
    let frame = Frame::around(low, bounds.max, depth).unwrap();
    marching_cubes_solid(solid, &frame, VertexPlacement::Crossing, &alone()).unwrap()
}

/// Returns the losses of a mesh in an STL: degenerate triangles, triangles without area, and intersecting
/// pairs.
fn lost(mesh: &TriangleMesh) -> (u64, u64, u64) {
    let kept = written_form(mesh, MeshFormat::Stl, &WriteOptions::default()).unwrap();
    let flat = kept.mesh.report().unwrap().flat;
    (kept.degenerate, flat, kept.mesh.intersecting_pairs(0, &alone()).unwrap().count)
}

/// Asserts that all coordinates are 32-bit numbers, an STL loses nothing, and the reported deviation is
/// small.
fn assert_single(mesh: &TriangleMesh, single: &SinglePrecision) {
    let coordinates = single.mesh.vertices().as_flattened();
    assert!(coordinates.iter().all(|&c| f64::from(c as f32) == c));
    assert_eq!((single.degenerate, single.intersecting_pairs), (0, 0));
    assert_eq!(lost(&single.mesh), (0, 0, 0));
    let flat = mesh.report().unwrap().is_closed();
    assert_eq!(single.mesh.report().unwrap().is_closed(), flat);
    let (low, high) = mesh.bounds();
    let far = low.iter().chain(&high).fold(0.0, |far: f64, c| far.max(c.abs()));
    assert!(single.deviation <= far * 2f64.powi(-20), "{} of {far}", single.deviation);
    assert!(single.rounding <= far * 2f64.powi(-24) && single.rounding <= single.deviation);
}

/// The plate by marching cubes, on lattices whose planes nearly contain the plate's faces. Rounding loses
/// triangles and makes some intersect. The repaired mesh has neither defect.
#[test]
fn a_plate_by_marching_cubes() {
    let mut all = (0, 0);
    let lattices = [([0.0; 3], 80.0), ([-5e-7; 3], 80.0 + 1e-6), ([-2e-6, -1e-6, -3e-6], 80.0 + 4e-6)];
    for (origin, edge) in lattices.into_iter().take(repeated(2, 3)) {
        let frame = Frame::new(origin, edge, 8).unwrap();
        let mesh = marching_cubes_solid(&plate(), &frame, VertexPlacement::Crossing, &alone()).unwrap();
        let (degenerate, flat, pairs) = lost(&mesh);
        all = (all.0 + degenerate + flat, all.1 + pairs);
        let single = mesh.in_single_precision(0.05, &alone()).unwrap();
        assert_single(&mesh, &single);
        assert_eq!(euler_of_manifold(&single.mesh), 0);
        assert!((single.mesh.volume() - mesh.volume()).abs() <= single.deviation * mesh.area());
    }
    assert!(all.0 >= 10 && all.1 >= 6, "{all:?}");
}

/// Triangles no larger than the rounding, on balls and bores far from the origin.
#[test]
fn small_triangles_far_away() {
    let mut random = Random(41);
    let mut all = (0, 0);
    for case in 0..repeated(3, 12) {
        let bore = Csg::cylinder_between([0.0, 0.0, -2.0], [0.3, 0.1, 2.0], 0.4).unwrap();
        let ball = Csg::ball([0.0; 3], 1.0).unwrap().difference(&bore).unwrap();
        let far = [0; 3].map(|_| random.between(-1.0, 1.0) * [1000.0, 20000.0, 50000.0][case % 3]);
        let solid = ball.placed(&Affine::translation(far).unwrap()).unwrap();
        let mesh = cubes(&solid, 6);
        assert_eq!(euler_of_manifold(&mesh), 0);
        let (degenerate, flat, pairs) = lost(&mesh);
        all = (all.0 + degenerate + flat, all.1 + pairs);
        let single = mesh.in_single_precision(0.05, &alone()).unwrap();
        assert_single(&mesh, &single);
        assert_eq!(euler_of_manifold(&single.mesh), 0, "case {case}");
        let (from, to) = ([&mesh, &single.mesh], [&single.mesh, &mesh]);
        for (from, to) in from.into_iter().zip(to) {
            for triangle in from.triangles().iter().step_by(1009) {
                let [a, b, c] = triangle.map(|v| from.vertices()[v as usize]);
                for point in [a, [0, 1, 2].map(|k| (a[k] + b[k] + c[k]) / 3.0)] {
                    let away = away_from_mesh(point, to);
                    assert!(away <= single.deviation * (1.0 + 1e-9) + 1e-11, "case {case}: {away}");
                }
            }
        }
    }
    assert!(all.0 > 300 && all.1 > 20, "{all:?}");
}

#[test]
fn what_is_single_stays_as_it_is() {
    let mesh = cubes(&Csg::ball([0.0; 3], 1.0).unwrap(), 4).in_single_precision(0.05, &alone()).unwrap().mesh;
    let again = mesh.in_single_precision(0.05, &alone()).unwrap();
    assert_eq!((again.mesh.vertices(), again.mesh.triangles()), (mesh.vertices(), mesh.triangles()));
    assert_eq!((again.deviation, again.rounding, again.collapsed, again.moved), (0.0, 0.0, 0, 0));
}

/// The stated deviation of a mesh grows by the rounding, and a mesh that vanishes is reported.
#[test]
fn deviations_and_losses() {
    let vertices = vec![[0.1, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let mesh = TriangleMesh::new(vertices, triangles.clone()).unwrap().with_deviation(0.25).unwrap();
    let single = mesh.in_single_precision(0.05, &alone()).unwrap();
    assert!(single.deviation > 1e-9 && single.deviation < 2e-9);
    assert!(single.mesh.deviation() >= 0.25 + single.deviation);
    // A tetrahedron that collapses to a point in single precision cannot be repaired.
    let tiny = [[0.0; 3], [1e-6, 0.0, 0.0], [0.0, 1e-6, 0.0], [0.0, 0.0, 1e-6]];
    let tiny = tiny.map(|p| p.map(|c| 1e6 + c)).to_vec();
    let tiny = TriangleMesh::new(tiny, triangles.clone()).unwrap();
    let single = tiny.in_single_precision(0.05, &alone()).unwrap();
    assert!(single.degenerate > 0 && single.moved == 0, "{single:?}");
    let mesh = cubes(&plate(), 4);
    for tolerance in [-1.0, f64::NAN] {
        let refused = mesh.in_single_precision(tolerance, &alone());
        assert!(matches!(refused, Err(Error::Argument { name: "tolerance", .. })));
    }
    let huge = vec![[1e300; 3], [1e300, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let refused = TriangleMesh::new(huge, triangles);
    let refused = refused.and_then(|mesh| mesh.in_single_precision(0.05, &alone()));
    assert!(matches!(refused, Err(Error::Argument { name: "mesh", .. } | Error::Mesh(_))), "{refused:?}");
}

/// Bodies that overlap before they are rounded: rounding made none of these pairs, and moves nothing.
#[test]
fn pairs_of_the_given_mesh_stay() {
    let (sin, cos) = 0.5f64.sin_cos();
    let turn = Affine::new([[cos, -sin, 0.0, 0.0], [sin, cos, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]).unwrap();
    let ball = |x: f64| {
        let placed = Csg::ball([x, 0.1, 0.2], 1.0).unwrap().placed(&turn).unwrap();
        cubes(&placed, 5)
    };
    let (a, b) = (ball(0.0), ball(0.7));
    let corners =
        [&a, &b].map(|mesh| mesh.triangles().iter().map(|t| t.map(|v| mesh.vertices()[v as usize])));
    let mesh = TriangleMesh::from_facets(corners.into_iter().flatten()).unwrap();
    let given = mesh.intersecting_pairs(0, &alone()).unwrap().count;
    let single = mesh.in_single_precision(0.05, &alone()).unwrap();
    assert!(given > 50 && single.deviation > 0.0, "{given}");
    assert_eq!((single.moved, single.intersecting_pairs), (0, given));
    assert_eq!(lost(&single.mesh).2, given);
}
