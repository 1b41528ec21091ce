//! Proofs for meshes that are not the boundary.

use super::scaled::Scaled;
use super::*;
use crate::solid::Csg;
use alloc::vec;

/// The proven deviation of a mesh (model units), with claimed surfaces of its triangles, and cells as they
/// are made for the solid.
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
    // Move each vertex in turn to the outside and to the inside, or along an edge.
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
    // Remove a triangle.
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
        // The claimed surfaces of the triangles do not matter.
        let count = wrong.mesh().triangles().len();
        for labels in [wrong.of_triangles.clone(), vec![0; count], vec![6; count], vec![NONE; count]] {
            let labels: Vec<u32> = labels.into_iter().map(|own| if own > 6 { NONE } else { own }).collect();
            let most = of(wrong.mesh(), &labels);
            assert!(most >= least - 0.08, "{most}, not {least}");
        }
    }
}

/// The distance of a point from the surface of the plate.
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

/// Claims about touching surfaces hold in the whole cell, and other surfaces yield no claim.
#[test]
fn surfaces_that_touch() {
    let cylinder = || Csg::cylinder(3.0, -40.0, 40.0).unwrap();
    let ball = |at: [f64; 3], radius: f64| Csg::ball(at, radius).unwrap();
    let plane = |at: f64| Csg::cuboid([at, -90.0, -80.0], [at + 7.0, 95.0, 85.0]).unwrap();
    let cone = Csg::frustum(4.0, 1.0, 3.0, 7.0).unwrap();
    let turn = Affine::new([[0.36, 0.48, -0.8, 1.0], [-0.8, 0.6, 0.0, 2.0], [0.48, 0.64, 0.6, 3.0]]).unwrap();
    // Two solids, a point near which their surfaces are compared, and whether they touch.
    let cases = [
        (cylinder(), ball([0.0, 0.0, 1.0], 3.0), [3.0, 0.0, 1.0], true),
        (cylinder(), ball([0.0, 0.0, 1.0], 3.001), [3.0, 0.0, 1.0], false),
        (cylinder(), ball([0.001, 0.0, 1.0], 3.0), [0.0, 3.0, 1.0], false),
        (cylinder(), ball([1.0, 0.0, 1.0], 2.0), [3.0, 0.0, 1.0], true),
        (cylinder(), plane(3.0), [3.0, 0.0, 1.0], true),
        (cylinder(), plane(2.9999), [3.0, 0.0, 1.0], false),
        (ball([0.0; 3], 5.0), cone.clone(), [4.0, 0.0, 3.0], true),
        (
            ball([0.0; 3], 5.0),
            cone.placed(&Affine::translation([0.0, 0.0, -0.001]).unwrap()).unwrap(),
            [4.0, 0.0, 3.0],
            false,
        ),
        (ball([0.0; 3], 5.0), plane(5.0), [5.0, 0.0, 0.0], true),
    ];
    for (case, (one, other, at, touch)) in cases.into_iter().enumerate() {
        for placement in [Affine::IDENTITY, turn] {
            let both = Csg::union_of([one.clone(), other.clone()]).unwrap().placed(&placement).unwrap();
            let at = placement.apply(at);
            for level in [8, 10, 12] {
                let frame = Frame::new(axes(|k| at[k] - 60.1), 128.0, 14).unwrap();
                let control = Control::threads(1);
                let surfaces = both.on(&frame, &control).unwrap().surfaces(&control).unwrap().unwrap();
                let figures = Figures::new(&surfaces, &frame).unwrap();
                let size = f64::from(1u32 << level);
                let cell = Cell { level, at: axes(|k| ((at[k] - frame.origin()[k]) / 128.0 * size) as u32) };
                // The two surfaces that come nearest to the point: they bound the two solids there.
                let unit = axes(|k| (at[k] - frame.origin()[k]) / 128.0);
                let mut near: Vec<u32> = (0..surfaces.len() as u32).collect();
                let is_curved = |k: u32| {
                    u8::from(figures.shape(k) == figures::Shape::Plane && case != 4 && case != 5 && case != 8)
                };
                near.sort_by_key(|&k| (is_curved(k), (figures.distance(k, unit) * 1e9) as u64));
                let [a, b] = [near[0], near[1]].map(|k| Scaled::of(&figures, k, cell).unwrap());
                let found = b.touches(&a);
                assert_eq!(found.is_some(), touch, "case {case}, level {level}");
                let Some(touch) = found else { continue };
                let half = 0.5 / size;
                for step in 0..4096 {
                    let point: [f64; 3] = axes(|k| {
                        let place = f64::from(step >> (4 * k) & 15) / 7.5 - 1.0;
                        (f64::from(cell.at[k]) * 2.0 + 1.0 + place) * half
                    });
                    let [x, y] = [near[0], near[1]].map(|k| figures.about(k, point));
                    let is_wrong =
                        ((x.0 > 0.0) != touch.is_turned) == touch.is_above && (y.0 > 0.0) != touch.is_above;
                    let away = |(value, gradient): (f64, [f64; 3])| value.abs() / figures::length(gradient);
                    assert!(
                        !is_wrong || away(x).max(away(y)) <= touch.away() * half,
                        "case {case}: {point:?}"
                    );
                }
            }
        }
    }
}
