//! Surfaces that touch and merge smoothly: a ball at the end of a round bar, the round ends of a slot.

use super::boundary::{assert_deviation, assert_manifold, of, turn};
use leafless::{Affine, Csg};
use leafless_testkit::surfaces::euler_of_manifold;
use leafless_testkit::{Random, repeated};
use std::collections::BTreeMap;
use std::f64::consts::PI;

fn rod(from: f64, to: f64, radius: f64) -> Csg {
    Csg::cylinder(radius, from, to).unwrap()
}

fn ball(at: [f64; 3], radius: f64) -> Csg {
    Csg::ball(at, radius).unwrap()
}

/// A slot of radius 2 and length 6 + 4 along x, across a plate.
fn slot() -> Csg {
    let middle = Csg::cuboid([-3.0, -2.0, -3.0], [3.0, 2.0, 3.0]).unwrap();
    let end = |x: f64| Csg::cylinder_between([x, 0.0, -3.0], [x, 0.0, 3.0], 2.0).unwrap();
    Csg::union_of([middle, end(-3.0), end(3.0)]).unwrap()
}

/// Solids with a name, the distance of a point from all curves in which their surfaces touch, the Euler
/// number for the genus, and the volume.
type Case = (&'static str, Csg, fn([f64; 3]) -> f64, i64, f64);

fn cases() -> Vec<Case> {
    let block = Csg::cuboid([-5.0, -5.0, -8.0], [5.0, 5.0, 7.0]).unwrap();
    let plate = Csg::cuboid([-8.0, -6.0, -1.0], [8.0, 6.0, 1.0]).unwrap();
    // A ball of radius 5, and the cone that touches it at the height 3, where the radius is 4.
    let cone = Csg::frustum(4.0, 1.75, 3.0, 6.0).unwrap();
    vec![
        (
            "a round end",
            Csg::union_of([rod(-6.0, 4.0, 3.0), ball([0.0, 0.0, 4.0], 3.0)]).unwrap(),
            |[x, y, z]| (x.hypot(y) - 3.0).abs() + (z - 4.0).abs(),
            2,
            90.0 * PI + 18.0 * PI,
        ),
        (
            "two round ends",
            Csg::union_of([rod(-4.0, 4.0, 3.0), ball([0.0, 0.0, 4.0], 3.0), ball([0.0, 0.0, -4.0], 3.0)])
                .unwrap(),
            |[x, y, z]| (x.hypot(y) - 3.0).abs() + (z.abs() - 4.0).abs(),
            2,
            72.0 * PI + 36.0 * PI,
        ),
        (
            "a bore with a round end",
            block.difference(&Csg::union_of([rod(0.0, 9.0, 3.0), ball([0.0; 3], 3.0)]).unwrap()).unwrap(),
            |[x, y, z]| (x.hypot(y) - 3.0).abs() + z.abs(),
            2,
            1500.0 - 63.0 * PI - 18.0 * PI,
        ),
        (
            "a slot",
            plate.difference(&slot()).unwrap(),
            |[x, y, _]| (x.abs() - 3.0).abs() + (y.abs() - 2.0).abs(),
            0,
            16.0 * 12.0 * 2.0 - 2.0 * (24.0 + 4.0 * PI),
        ),
        (
            "a cone on a ball",
            Csg::union_of([ball([0.0; 3], 5.0), cone]).unwrap(),
            |[x, y, z]| (x.hypot(y) - 4.0).abs() + (z - 3.0).abs(),
            2,
            // The ball without its cap of height 2, and the frustum.
            PI * (500.0 / 3.0 - 52.0 / 3.0 + 26.0625),
        ),
    ]
}

/// The mesh is closed and near, has an edge where the surfaces touch, and has few triangles.
#[test]
fn one_surface_goes_over_into_another() {
    let mut random = Random(39);
    for (name, solid, away_from_curve, euler, volume) in cases() {
        for (placement, tolerance) in
            [(Affine::IDENTITY, 0.02), (turn(), 0.02), (turn(), repeated(0.008, 0.002))]
        {
            let placed = solid.placed(&placement).unwrap();
            let found = of(&placed, 16, tolerance);
            let (mesh, report) = (found.mesh(), found.report());
            println!("{name} {tolerance}: {} triangles, {report:?}", mesh.triangles().len());
            assert_manifold(mesh, name);
            assert_eq!(euler_of_manifold(mesh), euler, "{name}");
            assert!(report.intersecting_pairs == 0 && report.deviation <= tolerance, "{name}: {report:?}");
            assert!((mesh.volume() - volume).abs() <= 1.1 * mesh.area() * report.deviation, "{name}");
            assert!(
                mesh.triangles().len() as f64 <= 0.35 * mesh.area() / tolerance,
                "{name}: {}",
                mesh.triangles().len()
            );
            assert_deviation(&placed, &found, &mut random, name);

            // Where triangles on different surfaces meet at no angle, their edge lies on the curve.
            let back = placement.inverse().unwrap();
            let mut sides = BTreeMap::new();
            for (number, &[a, b, c]) in mesh.triangles().iter().enumerate() {
                let surface = found.surface_of(number);
                sides.extend([(a, b), (b, c), (c, a)].map(|edge| (edge, (surface, number))));
            }
            let normal = |number: usize| {
                let [a, b, c] = mesh.triangles()[number].map(|v| mesh.vertices()[v as usize]);
                let (u, v) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
                let n = [0, 1, 2].map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
                let size = n.iter().map(|c| c * c).sum::<f64>().sqrt();
                n.map(|c| c / size)
            };
            let mut exact = 0;
            for (&(a, b), &(surface, number)) in &sides {
                let (other, beside) = sides[&(b, a)];
                let (n, m) = (normal(number), normal(beside));
                let cos: f64 = (0..3).map(|k| n[k] * m[k]).sum();
                if surface != other && cos > 0.9 {
                    // (Where a face cuts the curve off, four surfaces meet in a finest cell.)
                    let away = away_from_curve(back.apply(mesh.vertices()[a as usize]));
                    assert!(away <= 1e-3, "{name}: {away}");
                    exact += usize::from(away <= 1e-9);
                }
            }
            assert!(exact >= 6, "{name}: {exact} edges");
        }
    }
}
