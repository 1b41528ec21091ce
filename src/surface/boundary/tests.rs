//! What is proven of meshes that are not the boundary.

use super::*;
use crate::solid::Csg;
use alloc::vec;

/// What is proven of a mesh whose triangles are said to lie on these surfaces, with cells as they are made for the solid (model units).
fn proven(solid: &Csg, mesh: &TriangleMesh, of_triangles: &[u32], tolerance: f64) -> f64 {
    let control = Control::threads(1);
    let job = Job::new(&control);
    let frame = Frame::new([-20.3, -20.2, -20.1], 128.0, 12).unwrap();
    let classifier = solid.on(&frame, &control).unwrap();
    let surfaces = classifier.surfaces(&control).unwrap().unwrap();
    let figures = Figures::new(&surfaces, &frame).unwrap();
    let whole = tolerance / frame.edge();
    let refused = Refused::default();
    let wanted = Wanted { figures: &figures, tolerance: CELLS * whole, refused: &refused, parts: 0 };
    let leaves = Leaves::grow(&classifier, &wanted, &job).unwrap();
    let mut known = Known::default();
    let proof = prove(&leaves, &figures, (mesh, of_triangles), (&frame, whole), &mut known, &job).unwrap();
    rounded_up(proof.most, &frame)
}

fn plate(radius: f64) -> Csg {
    let bore = Csg::cylinder_between([40.0, 30.0, -1.0], [40.0, 30.0, 11.0], radius).unwrap();
    Csg::cuboid([0.0; 3], [80.0, 60.0, 10.0]).unwrap().difference(&bore).unwrap()
}

fn found(solid: &Csg) -> Boundary {
    let frame = Frame::new([-20.0; 3], 128.0, 14).unwrap();
    boundary(solid, &frame, 0.08, &Control::threads(1)).unwrap()
}

#[test]
fn wrong_meshes_are_found_out() {
    let solid = plate(5.0);
    let right = found(&solid);
    let of = |mesh: &TriangleMesh, surfaces: &[u32]| proven(&solid, mesh, surfaces, 0.08);
    assert!(of(right.mesh(), &right.of_triangles) <= 0.08);
    // Each vertex in turn, moved to the outside and to the inside, or along an edge.
    for (vertex, way) in (0..right.mesh().vertices().len()).step_by(5).zip(0..) {
        let mut vertices = right.mesh().vertices().to_vec();
        let away = [0.3, 1.0, 4.0][way % 3];
        let moved = &mut vertices[vertex];
        *moved = axes(|k| moved[k] + away * (moved[k] - [40.0, 30.0, 5.0][k]).signum());
        let off = away_from_plate(vertices[vertex]);
        assert!(off > 0.25 * away, "{off}");
        let mesh = TriangleMesh::new(vertices, right.mesh().triangles().to_vec()).unwrap();
        let most = of(&mesh, &right.of_triangles);
        assert!(most >= off * (1.0 - 1e-9), "vertex {vertex}: {most}, and it is {off} away");
    }
    // A triangle is missing.
    let mut triangles = right.mesh().triangles().to_vec();
    triangles.pop();
    let mesh = TriangleMesh::new(right.mesh().vertices().to_vec(), triangles).unwrap();
    assert_eq!(of(&mesh, &right.of_triangles), f64::INFINITY);
    // A bore that is larger or smaller, no bore, another bore, a void that the solid does not have.
    for (other, least) in [
        (plate(5.5), 0.5),
        (plate(4.0), 1.0),
        (Csg::cuboid([0.0; 3], [80.0, 60.0, 10.0]).unwrap(), 4.9),
        (
            plate(5.0)
                .difference(&Csg::cylinder_between([60.0, 30.0, -1.0], [60.0, 30.0, 11.0], 3.0).unwrap())
                .unwrap(),
            3.0,
        ),
        (plate(5.0).difference(&Csg::ball([20.0, 20.0, 5.0], 2.0).unwrap()).unwrap(), 3.0),
    ] {
        let wrong = found(&other);
        // Whatever is said of the surfaces of its triangles.
        let count = wrong.mesh().triangles().len();
        for labels in [wrong.of_triangles.clone(), vec![0; count], vec![6; count], vec![NONE; count]] {
            let labels: Vec<u32> = labels.into_iter().map(|own| if own > 6 { NONE } else { own }).collect();
            let most = of(wrong.mesh(), &labels);
            assert!(most >= least - 0.08, "{most}, not {least}");
        }
    }
}

/// How far a point is from the surface of the plate.
fn away_from_plate([x, y, z]: [f64; 3]) -> f64 {
    let beside = |c: f64, most: f64| (-c).max(c - most).max(0.0);
    let outside = [beside(x, 80.0), beside(y, 60.0), beside(z, 10.0)];
    let outside = outside.iter().map(|c| c * c).sum::<f64>().sqrt();
    if outside > 0.0 {
        return outside;
    }
    let wall = ((x - 40.0).hypot(y - 30.0) - 5.0).abs();
    [x, 80.0 - x, y, 60.0 - y, z, 10.0 - z].into_iter().fold(wall, f64::min)
}
