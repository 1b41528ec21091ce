//! Surfaces of octrees: closed, with two triangles on every edge, and with the topology of the samples.

use leafless::surface::{Resolve, Snap, marching_cubes_reusing, simple_marching_cubes};
use leafless::{
    Control, Csg, Error, FillRule, Frame, MeshSolid, Octree, Rule, Solid, Tag, TriangleMesh, build, exchange,
    file, marching_cubes,
};
use leafless_testkit::surfaces::{components, euler_of_manifold};
use leafless_testkit::{Aligned, Dense, Random, alone, cases, lattice_frame, model, repeated, shapes};
use proptest::prelude::*;

/// Samples with a margin of two outside samples.
struct Samples {
    n: i64,
    bits: Vec<bool>,
}

impl Samples {
    fn of(dense: &Dense) -> Samples {
        let (inner, n) = (1i64 << dense.depth, (1i64 << dense.depth) + 4);
        let bits = (0..n * n * n).map(|i| {
            let at = [i % n - 2, i / n % n - 2, i / n / n - 2];
            at.iter().all(|a| (0..inner).contains(a)) && dense.at(at.map(|a| a as u32)) == Tag::Full
        });
        Samples { n, bits: bits.collect() }
    }

    fn at(&self, [x, y, z]: [i64; 3]) -> bool {
        self.bits[(x + self.n * (y + self.n * z)) as usize]
    }

    fn positions(&self, end: i64) -> impl Iterator<Item = [i64; 3]> + use<> {
        (0..end * end * end).map(move |i| [i % end, i / end % end, i / end / end])
    }

    /// Returns the number of connected components of the samples of a kind. Neighbours differ in at most
    /// `axes` coordinates.
    fn components(&self, kind: bool, axes: usize) -> usize {
        let mut seen = vec![false; self.bits.len()];
        let mut count = 0;
        for start in self.positions(self.n) {
            let mut open = vec![start];
            let mut is_new = false;
            while let Some(at) = open.pop() {
                let place = (at[0] + self.n * (at[1] + self.n * at[2])) as usize;
                if self.bits[place] != kind || std::mem::replace(&mut seen[place], true) {
                    continue;
                }
                is_new = true;
                for step in 0..27 {
                    let step = [step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1];
                    let beside = [0, 1, 2].map(|axis| at[axis] + step[axis]);
                    let differ = step.iter().filter(|&&s| s != 0).count();
                    if differ <= axes && beside.iter().all(|b| (0..self.n).contains(b)) {
                        open.push(beside);
                    }
                }
            }
            count += usize::from(is_new);
        }
        count
    }

    /// Returns the Euler characteristic of the inside for the connectivity pair (6, 18). The complex has the
    /// inside samples as vertices, and the edges, squares and cubes with all corners inside. If all corners
    /// of a cube are inside except two at the ends of a body diagonal, their ring of edges is filled.
    fn euler(&self) -> i64 {
        let mut sum = 0;
        for at in self.positions(self.n - 1) {
            let corner = |k: i64| self.at([at[0] + (k & 1), at[1] + (k >> 1 & 1), at[2] + (k >> 2)]);
            let all = |corners: &[i64]| i64::from(corners.iter().all(|&k| corner(k)));
            sum += all(&[0]) - all(&[0, 1]) - all(&[0, 2]) - all(&[0, 4]);
            sum += all(&[0, 1, 2, 3]) + all(&[0, 1, 4, 5]) + all(&[0, 2, 4, 6]);
            sum -= all(&[0, 1, 2, 3, 4, 5, 6, 7]);
            sum += (0..4).filter(|&k| (0..8).all(|c| corner(c) != (c == k || c == 7 - k))).count() as i64;
        }
        sum
    }

    /// Returns the number of dual cells with different samples.
    fn mixed(&self) -> usize {
        let mixed = |at: &[i64; 3]| {
            let corner = |k: i64| self.at([at[0] + (k & 1), at[1] + (k >> 1 & 1), at[2] + (k >> 2)]);
            (1..8).any(|k| corner(k) != corner(0))
        };
        self.positions(self.n - 1).filter(mixed).count()
    }
}

/// Checks all promises of a marching-cubes mesh.
#[track_caller]
fn check(mesh: &TriangleMesh, dense: &Dense) {
    let samples = Samples::of(dense);
    assert_eq!(euler_of_manifold(mesh), 2 * samples.euler(), "{dense:?}");
    // Each component of the surface separates a component of the inside from one of the outside. Together
    // they form a tree.
    let (inside, outside) = (samples.components(true, 1), samples.components(false, 2));
    assert_eq!(components(mesh), inside + outside - 1, "{dense:?}");
    let difference = mesh.volume() - dense.count(Tag::Full) as f64;
    assert!(difference.abs() <= samples.mixed() as f64 + 1e-9, "{difference} {dense:?}");
}

fn random_bits(depth: u8, edge: u32, chance: u64, random: &mut Random) -> Dense {
    let from = [0; 3].map(|_: u32| random.below((1 << depth) - u64::from(edge) + 1) as u32);
    let mut dense = Dense::uniform(depth, Tag::Empty);
    for z in 0..edge {
        for y in 0..edge {
            for x in 0..edge {
                if random.below(256) < chance {
                    dense.set([from[0] + x, from[1] + y, from[2] + z], Tag::Full);
                }
            }
        }
    }
    dense
}

fn torture(depth: u8, edge: u32, rounds: usize, seed: u64) {
    let mut random = Random(seed);
    for round in 0..rounds {
        let chance = [128, 30, 226, 80, 176, 8, 248][round % 7];
        let dense = random_bits(depth, edge, chance, &mut random);
        let mesh = marching_cubes(dense.octree().view(), None, &alone()).unwrap();
        check(&mesh, &dense);
    }
}

#[test]
fn random_bitmaps_of_5() {
    torture(3, 5, repeated(3_000, 10_000), 1);
}

#[test]
fn random_bitmaps_of_8() {
    torture(3, 8, repeated(600, 2_000), 2);
}

#[test]
#[ignore = "takes minutes"]
fn a_hundred_thousand_bitmaps() {
    torture(3, 5, 100_000, 3);
    torture(3, 8, 100_000, 4);
}

proptest! {
    #![proptest_config(cases(200))]

    /// Undecided cells count as the call says, and threads change nothing.
    #[test]
    fn undecided_cells(shape in shapes(1..=5)) {
        let dense = shape.dense();
        let tree = dense.octree();
        for (resolve, tag) in [(Resolve::Inner, Tag::Empty), (Resolve::Outer, Tag::Full)] {
            let resolved = dense.resolved(tag);
            let mesh = marching_cubes(tree.view(), Some(resolve), &alone()).unwrap();
            let expected = marching_cubes(resolved.octree().view(), None, &alone()).unwrap();
            prop_assert_eq!(mesh.vertices(), expected.vertices());
            prop_assert_eq!(mesh.triangles(), expected.triangles());
            let threads = marching_cubes(tree.view(), Some(resolve), &Control::threads(3)).unwrap();
            prop_assert_eq!(mesh.vertices(), threads.vertices());
            prop_assert_eq!(mesh.triangles(), threads.triangles());
            check(&mesh, &resolved);
        }
        let unresolved = marching_cubes(tree.view(), None, &alone());
        match unresolved {
            Ok(_) => prop_assert!(dense.is_binary()),
            Err(Error::Argument { name, problem }) => {
                prop_assert!(!dense.is_binary() && name == "resolve");
                prop_assert!(["inner", "outer", "source"].iter().all(|choice| problem.contains(choice)));
            }
            Err(error) => panic!("{error}"),
        }
    }
}

#[test]
fn the_source_decides() {
    let ball = leafless::AnySolid::new(Csg::ball([0.1, 0.0, 0.0], 0.8).unwrap());
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let certified = build(&ball, &frame, Rule::Certified, &alone()).unwrap();
    let sampled = build(&ball, &frame, Rule::Sampled, &alone()).unwrap();
    let mesh = marching_cubes(certified.view(), Some(Resolve::Source(&ball)), &alone()).unwrap();
    let expected = marching_cubes(sampled.view(), None, &alone()).unwrap();
    assert_eq!((mesh.vertices(), mesh.triangles()), (expected.vertices(), expected.triangles()));
    assert_eq!(euler_of_manifold(&mesh), 2);
}

#[test]
fn whole_universes() {
    for depth in 1..=6 {
        let n = f64::from(1u32 << depth);
        let frame = lattice_frame(depth);
        let empty = Octree::uniform(frame, Tag::Empty, Tag::Empty).unwrap();
        assert_eq!(marching_cubes(empty.view(), None, &alone()).unwrap().triangles().len(), 0);
        let full = Octree::uniform(frame, Tag::Full, Tag::Full).unwrap();
        let mesh = marching_cubes(full.view(), None, &alone()).unwrap();
        assert_eq!(euler_of_manifold(&mesh), 2);
        assert_eq!(mesh.bounds(), ([0.0; 3], [n; 3]));
        // Without the volume cut off at the edges and corners.
        let expected = n.powi(3) - 12.0 * (n - 1.0) / 8.0 - 8.0 * (1.0 / 8.0 - 1.0 / 48.0);
        assert!((mesh.volume() - expected).abs() < 1e-6, "{} {expected}", mesh.volume());
        let partial = Octree::uniform(frame, Tag::Partial, Tag::Partial).unwrap();
        assert!(marching_cubes(partial.view(), None, &alone()).is_err());
        let outer = marching_cubes(partial.view(), Some(Resolve::Outer), &alone()).unwrap();
        assert_eq!((outer.vertices(), outer.triangles()), (mesh.vertices(), mesh.triangles()));
    }
}

#[test]
fn frames_that_doubles_cannot_resolve() {
    let tree = |origin: f64, edge: f64| {
        Octree::uniform(Frame::new([origin; 3], edge, 4).unwrap(), Tag::Full, Tag::Full).unwrap()
    };
    for (origin, edge) in [(1e13, 1e-3), (0.0, 2f64.powi(-256)), (2f64.powi(256), 2f64.powi(250))] {
        assert!(marching_cubes(tree(origin, edge).view(), None, &alone()).is_err());
    }
    let far = marching_cubes(tree(1e9, 1.0).view(), None, &alone()).unwrap();
    assert_eq!(euler_of_manifold(&far), 2);
}

#[test]
fn what_a_control_asks_for() {
    let tree = build(
        &Csg::ball([0.5; 3], 0.4).unwrap(),
        &Frame::new([0.0; 3], 1.0, 7).unwrap(),
        Rule::Sampled,
        &alone(),
    );
    let tree = tree.unwrap();
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let control = Control { cancel: Some(&cancel), ..alone() };
    assert!(matches!(marching_cubes(tree.view(), None, &control), Err(Error::Cancelled)));
    let most = std::sync::Mutex::new(0.0f64);
    let progress = |part: f64| {
        let mut most = most.lock().unwrap();
        *most = most.max(part);
    };
    marching_cubes(tree.view(), None, &Control { progress: Some(&progress), ..alone() }).unwrap();
    let most = *most.lock().unwrap();
    assert!(most > 0.9 && most <= 1.0, "{most}");
}

/// Balls, tori and models: closed, with their known genus.
#[test]
fn solids_and_models() {
    let frame = Frame::new([-1.0; 3], 2.0, 7).unwrap();
    let mesh_of = |solid: &Csg| {
        let tree = build(solid, &frame, Rule::Sampled, &alone()).unwrap();
        let mesh = marching_cubes(tree.view(), None, &alone()).unwrap();
        mesh.check_closed(FillRule::NonZero).unwrap();
        mesh
    };
    let ball = Csg::ball([0.0; 3], 0.8).unwrap();
    let drill = Csg::cylinder(0.3, -1.0, 1.0).unwrap();
    for (solid, euler) in [(ball.clone(), 2), (ball.difference(&drill).unwrap(), 0)] {
        let mesh = mesh_of(&solid);
        assert_eq!((euler_of_manifold(&mesh), components(&mesh)), (euler, 1));
    }
    for name in ["bunny-closed.stl", "featuretype.STL", "fandisk.obj"] {
        let Some(path) = model(name) else { continue };
        let solid = MeshSolid::new(
            exchange::open_mesh(&path, &exchange::MeshOptions::default()).unwrap().mesh,
            FillRule::NonZero,
        )
        .unwrap();
        let bounds = solid.bounds().unwrap();
        let frame = Frame::around(bounds.min, bounds.max, 8).unwrap();
        let tree = build(&solid, &frame, Rule::Sampled, &Control::default()).unwrap();
        let mesh = marching_cubes(tree.view(), None, &Control::default()).unwrap();
        euler_of_manifold(&mesh);
        let volume = tree.statistics().volume().lower;
        assert!((mesh.volume() / volume - 1.0).abs() < 2e-3, "{name}: {} {volume}", mesh.volume());
    }
}

/// Undetected damage ends the work, or gives another mesh, which is closed too.
#[test]
fn damaged_trees() {
    let frame = Frame::new([-1.0; 3], 2.0, 7).unwrap();
    let ball = Csg::ball([0.1, -0.05, 0.03], 0.77).unwrap();
    for rule in [Rule::Certified, Rule::Sampled] {
        let good = file::to_bytes(&build(&ball, &frame, rule, &alone()).unwrap()).unwrap();
        let mut random = Random(9);
        let mut seen = [0; 2];
        for round in 0..80 {
            let mut bytes = good.clone();
            for _ in 0..if round % 2 == 0 { 3 } else { good.len() / 20 } {
                let at = 1024 + random.below(good.len() as u64 - 1024) as usize;
                bytes[at] = random.bits() as u8;
            }
            let bytes = Aligned::new(&bytes);
            let Ok(tree) = file::view(bytes.bytes()) else { continue };
            for resolve in [Resolve::Inner, Resolve::Outer] {
                match marching_cubes(&tree, Some(resolve), &alone()) {
                    Ok(mesh) => {
                        seen[0] += 1;
                        assert!(mesh.triangles().is_empty() || mesh.check_closed(FillRule::NonZero).is_ok());
                        simple_marching_cubes(&tree, Snap::Fat, Some(resolve), &alone()).unwrap();
                    }
                    Err(error) => {
                        seen[1] += 1;
                        assert!(matches!(error, Error::Damaged(_)), "{error}");
                    }
                }
            }
        }
        assert!(seen[0] > 5 && seen[1] > 5, "{seen:?}");
    }
}

/// The memory of another mesh, larger or smaller, changes nothing. Larger memory is kept.
#[test]
fn memory_is_reused() {
    let frame = lattice_frame(5);
    let mut before = None;
    for radius in [3.0, 14.0, 9.0, 0.1, 12.0] {
        let ball = build(&Csg::ball([16.0; 3], radius).unwrap(), &frame, Rule::Sampled, &alone()).unwrap();
        let expected = marching_cubes(ball.view(), None, &alone()).unwrap();
        let mesh = match before.take() {
            None => marching_cubes(ball.view(), None, &alone()).unwrap(),
            Some(mesh) => marching_cubes_reusing(mesh, ball.view(), None, &alone()).unwrap(),
        };
        assert_eq!((mesh.vertices(), mesh.triangles()), (expected.vertices(), expected.triangles()));
        assert_eq!(mesh.report().unwrap(), expected.report().unwrap());
        before = Some(mesh);
    }
}
