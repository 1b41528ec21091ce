//! Surface nets beside marching cubes. Both have the same samples, and so the same topology.

use leafless::surface::{Resolve, surface_nets};
use leafless::{
    AnySolid, Control, Csg, Error, FillRule, Frame, Rule, Tag, TriangleMesh, build, marching_cubes,
};
use leafless_testkit::surfaces::{components, euler_of_manifold};
use leafless_testkit::{Dense, Random, alone, cases, repeated, shapes};
use proptest::prelude::*;

/// Returns, by definition, the vertices of cubes between eight samples that one sheet passes through: means
/// of the crossed edges' middles.
fn means(dense: &Dense) -> Vec<[f64; 3]> {
    let n = 1i64 << dense.depth;
    let inside =
        |at: [i64; 3]| at.iter().all(|a| (0..n).contains(a)) && dense.at(at.map(|a| a as u32)) == Tag::Full;
    let mut found = Vec::new();
    for i in 0..(n + 1).pow(3) {
        let lower = [i % (n + 1) - 1, i / (n + 1) % (n + 1) - 1, i / (n + 1).pow(2) - 1];
        let at = |corner: i64| [0, 1, 2].map(|axis| lower[axis] + (corner >> axis & 1));
        let (mut sum, mut count) = ([0.0; 3], 0);
        for corner in 0..8 {
            for axis in (0..3).filter(|axis| corner >> axis & 1 == 0) {
                if inside(at(corner)) != inside(at(corner | 1 << axis)) {
                    count += 1;
                    for k in 0..3 {
                        sum[k] += at(corner)[k] as f64 + 0.5 + if k == axis { 0.5 } else { 0.0 };
                    }
                }
            }
        }
        // Three crossings around a corner, or four on a sheet across: one sheet.
        if (3..=4).contains(&count) {
            found.push(sum.map(|c| c / f64::from(count)));
        }
    }
    found
}

#[track_caller]
fn check(mesh: &TriangleMesh, dense: &Dense) {
    let tree = dense.octree();
    let cubes = marching_cubes(tree.view(), None, &alone()).unwrap();
    assert_eq!(euler_of_manifold(mesh), euler_of_manifold(&cubes), "{dense:?}");
    assert_eq!(components(mesh), components(&cubes), "{dense:?}");
    let most = cubes.triangles().len() as f64;
    assert!((mesh.volume() - dense.count(Tag::Full) as f64).abs() <= most, "{dense:?}");
    for expected in means(dense) {
        let is_near = |v: &[f64; 3]| (0..3).all(|k| (v[k] - expected[k]).abs() < 1e-12);
        assert!(mesh.vertices().iter().any(is_near), "{expected:?} {dense:?}");
    }
}

fn random_bits(depth: u8, chance: u64, random: &mut Random) -> Dense {
    let mut dense = Dense::uniform(depth, Tag::Empty);
    let n = 1 << depth;
    for i in 0..n * n * n {
        if random.below(256) < chance {
            dense.set([i % n, i / n % n, i / n / n], Tag::Full);
        }
    }
    dense
}

#[test]
fn random_bitmaps() {
    let mut random = Random(21);
    for round in 0..repeated(490, 1500) {
        let chance = [128, 30, 226, 80, 176, 8, 248][round % 7];
        let dense = random_bits(2, chance, &mut random);
        check(&surface_nets(dense.octree().view(), None, &alone()).unwrap(), &dense);
    }
}

#[test]
#[ignore = "takes minutes"]
fn two_hundred_thousand_bitmaps() {
    let mut random = Random(22);
    for round in 0..200_000 {
        let chance = [128, 30, 226, 80, 176, 8, 248][round % 7];
        let dense = random_bits(if round % 64 == 0 { 3 } else { 2 }, chance, &mut random);
        check(&surface_nets(dense.octree().view(), None, &alone()).unwrap(), &dense);
    }
}

proptest! {
    #![proptest_config(cases(100))]

    /// Octrees with cells of several sizes. Undecided cells count as the call says, and threads change
    /// nothing.
    #[test]
    fn undecided_cells(shape in shapes(1..=4)) {
        let dense = shape.dense();
        let tree = dense.octree();
        for (resolve, tag) in [(Resolve::Inner, Tag::Empty), (Resolve::Outer, Tag::Full)] {
            let mesh = surface_nets(tree.view(), Some(resolve), &alone()).unwrap();
            let threads = surface_nets(tree.view(), Some(resolve), &Control::threads(3)).unwrap();
            prop_assert_eq!(mesh.vertices(), threads.vertices());
            prop_assert_eq!(mesh.triangles(), threads.triangles());
            check(&mesh, &dense.resolved(tag));
        }
        match surface_nets(tree.view(), None, &alone()) {
            Ok(_) => prop_assert!(dense.is_binary()),
            Err(Error::Argument { name: "resolve", .. }) => prop_assert!(!dense.is_binary()),
            Err(error) => panic!("{error}"),
        }
    }
}

/// A ball: smoother than marching cubes between the same samples, and equally near.
#[test]
fn a_ball() {
    let (centre, radius) = ([0.1, 0.0, -0.05], 0.8);
    let ball = AnySolid::new(Csg::ball(centre, radius).unwrap());
    let frame = Frame::new([-1.0; 3], 2.0, 6).unwrap();
    let certified = build(&ball, &frame, Rule::Certified, &alone()).unwrap();
    let mesh = surface_nets(certified.view(), Some(Resolve::Source(&ball)), &alone()).unwrap();
    mesh.check_closed(FillRule::NonZero).unwrap();
    assert_eq!(euler_of_manifold(&mesh), 2);
    let cubes = marching_cubes(certified.view(), Some(Resolve::Source(&ball)), &alone()).unwrap();
    let off = |mesh: &TriangleMesh| {
        let away = mesh.vertices().iter().map(|v| {
            let square: f64 = (0..3).map(|k| (v[k] - centre[k]).powi(2)).sum();
            (square.sqrt() - radius).powi(2)
        });
        (away.sum::<f64>() / mesh.vertices().len() as f64).sqrt()
    };
    assert!(off(&mesh) < 0.75 * off(&cubes), "{} {}", off(&mesh), off(&cubes));
    assert!(mesh.area() < cubes.area() && mesh.triangles().len() < cubes.triangles().len() + 100);
}
