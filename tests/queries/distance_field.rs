//! Distance fields, against dense arrays in integers and against the distances of points.

use leafless::query::DistanceTo;
use leafless::{Control, Csg, Error, Frame, Octree, Rule, Tag, build, compact};
use leafless_testkit::{Dense, Random, alone, cases, positions, shapes};
use proptest::prelude::*;
use std::sync::atomic::AtomicBool;

/// Returns the squared distance, in half cells, from a cell's centre to the nearest closed cell with one of
/// these tags.
fn square(dense: &Dense, exterior: Tag, at: [u32; 3], tags: &[Tag]) -> Option<u64> {
    let apart = |a: u32, b: u32| (2 * u64::from(a.abs_diff(b))).saturating_sub(1).pow(2);
    let cells = positions(dense.depth).filter(|&other| tags.contains(&dense.at(other)));
    let inside = cells.map(|other| (0..3).map(|axis| apart(at[axis], other[axis])).sum()).min();
    let last = (1 << dense.depth) - 1;
    let outside = at.iter().map(|&a| (2 * u64::from(a.min(last - a)) + 1).pow(2)).min();
    inside.into_iter().chain(outside.filter(|_| tags.contains(&exterior))).min()
}

/// True if a single is the greatest not above the root of a square (in half cells of edge 1), or the least
/// not below.
fn is_next_to(single: f32, square: Option<u64>, below: bool) -> bool {
    let Some(square) = square else { return single == f32::INFINITY };
    // The square of a single has 48 bits.
    let order = |x: f32| (f64::from(x) * f64::from(x)).total_cmp(&(square as f64 / 4.0));
    if below {
        order(single).is_le() && order(single.next_up()).is_gt()
    } else {
        order(single).is_ge() && (single == 0.0 || order(single.next_down()).is_lt())
    }
}

fn assert_entry(entry: [f32; 2], dense: &Dense, exterior: Tag, at: [u32; 3]) {
    use Tag::{Empty, Full, Partial};
    let of = |tags: &[Tag]| square(dense, exterior, at, tags);
    let [lower, upper] = entry;
    let tag = dense.at(at);
    let told = format!("{at:?} {tag:?} {entry:?}");
    if tag == Empty {
        assert!(is_next_to(lower, of(&[Full, Partial]), true), "{told}");
    } else {
        assert!(is_next_to(-lower, of(&[Empty]), false), "{told}");
    }
    if tag == Full {
        assert!(is_next_to(-upper, of(&[Empty, Partial]), true), "{told}");
    } else {
        assert!(is_next_to(upper, of(&[Full]), false), "{told}");
    }
}

fn field(tree: &Octree, min: [u32; 3], max: [u32; 3], control: &Control<'_>) -> Vec<[f32; 2]> {
    let size = [0, 1, 2].map(|axis: usize| (max[axis] - min[axis]) as usize);
    let mut field = vec![[f32::NAN; 2]; size[0] * size[1] * size[2]];
    tree.distance_field(min, max, &mut field, control).unwrap();
    field
}

fn cells(min: [u32; 3], max: [u32; 3]) -> impl Iterator<Item = [u32; 3]> {
    (min[2]..max[2])
        .flat_map(move |z| (min[1]..max[1]).flat_map(move |y| (min[0]..max[0]).map(move |x| [x, y, z])))
}

fn a_box(random: &mut Random, n: u64) -> ([u32; 3], [u32; 3]) {
    let (mut min, mut max) = ([0; 3], [0; 3]);
    for axis in 0..3 {
        let ends = [random.below(n + 1) as u32, random.below(n + 1) as u32];
        (min[axis], max[axis]) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    }
    (min, max)
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn boxes_of_random_trees(shape in shapes(1..=4), seed in any::<u64>()) {
        let dense = shape.dense();
        let exterior = [Tag::Empty, Tag::Partial, Tag::Full][seed as usize % 3];
        let tree = dense.octree_with(exterior, &alone()).unwrap();
        let coded = compact(tree.view()).unwrap();
        let n = 1 << dense.depth;
        let mut random = Random(seed);
        let all = field(&tree, [0; 3], [n; 3], &alone());
        for (at, &entry) in cells([0; 3], [n; 3]).zip(&all) {
            assert_entry(entry, &dense, exterior, at);
        }
        prop_assert_eq!(&field(&coded, [0; 3], [n; 3], &alone()), &all);
        for _ in 0..6 {
            let (min, max) = a_box(&mut random, n.into());
            let index = |at: [u32; 3]| ((at[2] * n + at[1]) * n + at[0]) as usize;
            let wanted: Vec<[f32; 2]> = cells(min, max).map(|at| all[index(at)]).collect();
            prop_assert_eq!(field(&tree, min, max, &alone()), wanted);
        }
    }
}

/// Two small balls far from each other, on a lattice too large for a test of every cell.
fn far_apart(depth: u8) -> Octree {
    let frame = Frame::new([0.0; 3], f64::from(1u32 << depth), depth).unwrap();
    let n = f64::from(1u32 << depth);
    let balls = [Csg::ball([0.25 * n; 3], 5.3).unwrap(), Csg::ball([0.75 * n; 3], 7.7).unwrap()];
    let pair = Csg::union_of(balls).unwrap();
    build(&pair, &frame, Rule::Certified, &alone()).unwrap()
}

/// Cells one by one and all at once. The entries equal the distances of points.
#[test]
fn boxes_of_large_trees() {
    let mut random = Random(8);
    for depth in [6, 7, 10, 15, 20] {
        let tree = far_apart(depth);
        let n = 1u32 << depth;
        for size in [1, 3, 9, 20] {
            for near in [n / 4, n / 2, 3 * n / 4 - 8] {
                let min = [0; 3].map(|_| (near + random.below(9) as u32).saturating_sub(4));
                let max = min.map(|a| (a + size).min(n));
                let found = field(&tree, min, max, &alone());
                assert_eq!(found, field(&tree, min, max, &Control::threads(3)));
                for (at, entry) in cells(min, max).zip(found).step_by(7) {
                    let centre = at.map(|a| f64::from(a) + 0.5);
                    let wanted = tree.distance(centre, DistanceTo::Boundary).unwrap();
                    let near =
                        |single: f32, bound: f64| (f64::from(single) - bound).abs() <= bound.abs() * 2e-7;
                    assert!(f64::from(entry[0]) <= wanted.lower && wanted.upper <= f64::from(entry[1]));
                    assert!(
                        near(entry[0], wanted.lower) && near(entry[1], wanted.upper),
                        "{entry:?} {wanted:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    let frame = Frame::new([-1.3; 3], 2.6, 6).unwrap();
    let ring =
        Csg::ball([0.1, 0.0, 0.0], 1.1).unwrap().difference(&Csg::ball([0.3; 3], 0.7).unwrap()).unwrap();
    for rule in [Rule::Certified, Rule::Sampled] {
        let tree = build(&ring, &frame, rule, &alone()).unwrap();
        let (min, max) = ([3, 0, 5], [61, 64, 50]);
        assert_eq!(field(&tree, min, max, &alone()), field(&tree, min, max, &Control::threads(3)));
    }
}

#[test]
fn boxes_that_are_refused() {
    let tree = far_apart(6);
    let mut entry = [[7.0; 2]; 1];
    for (min, max) in [([0; 3], [65, 1, 1]), ([1, 0, 0], [0, 1, 1]), ([64; 3], [65; 3])] {
        let refused = tree.distance_field(min, max, &mut entry, &alone());
        assert!(matches!(refused, Err(Error::Argument { name: "max", .. })), "{min:?} {max:?}");
    }
    for (max, count) in [([2, 1, 1], 1), ([0; 3], 1), ([1; 3], 0)] {
        let refused = tree.distance_field([0; 3], max, &mut entry[..count], &alone());
        assert!(matches!(refused, Err(Error::Argument { name: "field", .. })));
    }
    tree.distance_field([64; 3], [64; 3], &mut [], &alone()).unwrap();
    let flag = AtomicBool::new(true);
    let control = Control { cancel: Some(&flag), ..alone() };
    assert!(matches!(tree.distance_field([0; 3], [1; 3], &mut entry, &control), Err(Error::Cancelled)));
    assert_eq!(entry, [[7.0; 2]; 1]);
}

/// Measures the time of 256³ cells: `--ignored --nocapture`.
#[test]
#[ignore = "a measurement"]
fn speed() {
    for rule in [Rule::Certified, Rule::Sampled] {
        for (depth, from) in [(8, 0), (9, 128)] {
            let frame = Frame::new([-1.0; 3], 2.0, depth).unwrap();
            let solid = Csg::ball([0.1, 0.0, 0.0], 0.8)
                .unwrap()
                .difference(&Csg::ball([0.3; 3], 0.5).unwrap())
                .unwrap();
            let tree = build(&solid, &frame, rule, &Control::default()).unwrap();
            let (min, max) = ([from; 3], [from + 256; 3]);
            let mut field = vec![[0.0f32; 2]; 1 << 24];
            for threads in [1, 1, 2] {
                let start = std::time::Instant::now();
                tree.distance_field(min, max, &mut field, &Control::threads(threads)).unwrap();
                println!("{rule:?}, depth {depth}, {threads} threads: {:?}", start.elapsed());
            }
            let points: Vec<[f64; 3]> = (0..100_000)
                .map(|k| [0, 1, 2].map(|axis| f64::from((k * [1, 17, 71][axis]) % 1009) / 504.0 - 1.0))
                .collect();
            let mut answers = vec![leafless::Interval::exactly(0.0); points.len()];
            let start = std::time::Instant::now();
            tree.distances(&points, DistanceTo::Boundary, &mut answers, &alone()).unwrap();
            println!("{:?} a point", start.elapsed() / 100_000);
        }
    }
}
