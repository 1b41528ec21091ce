//! Queries of stored trees against dense arrays.

mod common;

use common::{Dense, Random, Shape, alone, assert_is, cases, lattice_frame, positions, shapes};
use leafless::{
    Ball, Cell, Cursor, Error, Frame, Membership, Octree, PointCursor, Region, Rule, Tag, build, compact,
};
use proptest::prelude::*;

fn membership(tag: Tag) -> Membership {
    match tag {
        Tag::Empty => Membership::Outside,
        Tag::Full => Membership::Inside,
        _ => Membership::Undecided,
    }
}

/// The answer for a point in lattice coordinates: the cell above each plane, the last on the upper face.
fn expected(dense: &Dense, point: [f64; 3]) -> Membership {
    let n = (1u32 << dense.depth) as f64;
    if !point.iter().all(|&x| (0.0..=n).contains(&x)) {
        return Membership::Undecided;
    }
    membership(dense.at(point.map(|x| x.floor().min(n - 1.0) as u32)))
}

/// Points in cells, on planes, edges, corners and faces of the universe, beside it, and no points at all.
fn points(depth: u8, seed: u64, count: usize) -> Vec<[f64; 3]> {
    let mut random = Random(seed);
    let n = (1u64 << depth) as f64;
    let mut coordinate = || match random.below(12) {
        0..=4 => random.between(0.0, n),
        5..=7 => random.below(n as u64 + 1) as f64,
        8 => (random.below(n as u64 + 1) as f64).next_up(),
        9 => (random.below(n as u64 + 1) as f64).next_down(),
        10 => random.between(0.0, n),
        _ => match random.below(40) {
            0 => f64::NAN,
            1 => f64::INFINITY,
            2 => f64::NEG_INFINITY,
            3 => -0.0,
            4 => f64::MAX,
            5 => -f64::MIN_POSITIVE,
            6 => f64::MIN_POSITIVE,
            7 => n * 1.5,
            8 => -n,
            _ => random.between(0.0, n),
        },
    };
    (0..count).map(|_| [coordinate(), coordinate(), coordinate()]).collect()
}

fn every_way_to_ask(tree: &Octree, dense: &Dense, seed: u64) {
    let points = points(dense.depth, seed, 1000);
    let wanted: Vec<Membership> = points.iter().map(|&point| expected(dense, point)).collect();
    let mut cursor = PointCursor::new(tree.view());
    for (&point, &wanted) in points.iter().zip(&wanted) {
        assert_eq!(tree.contains(point), wanted, "{point:?}");
        assert_eq!(cursor.contains(point), wanted, "{point:?}");
    }
    for count in [0, 1, 2, 15, 16, 17, 31, 33, 1000] {
        let mut answers = vec![Membership::Inside; count];
        tree.contains_many(&points[..count], &mut answers).unwrap();
        assert_eq!(answers, wanted[..count]);
    }
    // In scan order, and in random order with places revisited.
    let mut cursor = PointCursor::new(tree.view());
    for at in positions(dense.depth) {
        assert_eq!(cursor.tag_at(at), dense.at(at));
    }
    let (mut random, n) = (Random(seed), 1u64 << dense.depth);
    let mut last = [0; 3];
    for _ in 0..2000 {
        let axis = random.below(3) as usize;
        match random.below(4) {
            0 => last = [0; 3].map(|_| random.below(n) as u32),
            1 => last[axis] ^= 1,
            2 => last[axis] = (last[axis] + 1) % n as u32,
            _ => {
                let outside = random.below(1 << 32).max(n) as u32;
                let mut beyond = last;
                beyond[axis] = outside;
                assert_eq!((cursor.tag_at(beyond), tree.view().tag_at(beyond)), (Tag::Partial, Tag::Partial));
            }
        }
        assert_eq!(cursor.tag_at(last), dense.at(last));
    }
}

proptest! {
    #![proptest_config(cases(150))]

    #[test]
    fn points_and_cells(shape in shapes(1..=5), seed in any::<u64>()) {
        let dense = shape.dense();
        let tree = dense.octree();
        every_way_to_ask(&tree, &dense, seed);
        every_way_to_ask(&compact(tree.view()).unwrap(), &dense, seed);
    }

    #[test]
    fn statistics_and_cursors_see_the_classical_octree(shape in shapes(1..=6)) {
        let dense = shape.dense();
        let tree = dense.octree();
        assert_is(&tree, &dense);
        let classical = dense.classical();
        let mut cursor = Cursor::new(tree.view());
        assert!(!cursor.ascend());
        classical.assert_same(&mut cursor);
        assert_eq!(cursor.cell(), Cell::ROOT);
        let coded = compact(tree.view()).unwrap();
        classical.assert_same(&mut Cursor::new(coded.view()));
    }

    #[test]
    fn boxes(shape in shapes(1..=4), seed in any::<u64>()) {
        let dense = shape.dense();
        let tree = dense.octree();
        let coded = compact(tree.view()).unwrap();
        let n = (1u64 << dense.depth) as f64;
        let mut random = Random(seed);
        for _ in 0..300 {
            let (mut min, mut max) = ([0.0; 3], [0.0; 3]);
            let kind = random.below(6);
            for axis in 0..3 {
                let mut end = || match random.below(8) {
                    0..=3 => random.below(n as u64 + 1) as f64,
                    4 | 5 => random.between(0.0, n),
                    6 if kind < 3 => [-1.0, 0.0, n, n + 1.0][random.below(4) as usize],
                    7 if kind < 3 => [f64::NEG_INFINITY, f64::INFINITY, -1e300, 1e300][random.below(4) as usize],
                    _ => random.between(-0.2 * n, 1.2 * n).clamp(0.0, n),
                };
                let (a, b) = (end(), end());
                (min[axis], max[axis]) = (a.min(b), a.max(b));
                if random.below(12) == 0 {
                    max[axis] = min[axis];
                }
            }
            let wanted = region(&dense, min, max);
            assert_eq!(tree.classify_box(min, max).unwrap(), wanted, "{min:?} {max:?}");
            assert_eq!(coded.classify_box(min, max).unwrap(), wanted);
        }
    }
}

/// The answer for a box, cell by cell. A box without thickness along an axis is one cell thick: in the cell
/// above it, or the last one.
fn region(dense: &Dense, min: [f64; 3], max: [f64; 3]) -> Region {
    let n = 1u32 << dense.depth;
    let (mut empty, mut full, mut partial) = (false, false, false);
    let meets = |axis: usize, i: u32| {
        let (low, high) = (i as f64, i as f64 + 1.0);
        if min[axis] < max[axis] {
            min[axis] < high && max[axis] > low
        } else {
            min[axis] >= low && (min[axis] < high || (min[axis] == high && i == n - 1))
        }
    };
    for at in positions(dense.depth) {
        if (0..3).all(|axis| meets(axis, at[axis])) {
            match dense.at(at) {
                Tag::Empty => empty = true,
                Tag::Full => full = true,
                _ => partial = true,
            }
        }
    }
    let beyond = (0..3).any(|axis| min[axis] < 0.0 || max[axis] > n as f64);
    match (empty, full, partial || beyond) {
        (true, true, _) => Region::Crossing,
        (true, false, false) => Region::Outside,
        (false, true, false) => Region::Inside,
        _ => Region::Undecided,
    }
}

#[test]
fn boxes_that_only_touch_the_universe_prove_nothing() {
    // The lower half is solid: each side face of the universe is half solid, half empty.
    let tree = Dense::from_fn(3, |[_, _, z]| if z < 4 { Tag::Full } else { Tag::Empty }).octree();
    for axis in 0..2 {
        for (low, high) in [(-2.0, 0.0), (8.0, 9.0), (-2.0, -1.0), (8.5, 9.0)] {
            let (mut min, mut max) = ([0.0; 3], [8.0; 3]);
            (min[axis], max[axis]) = (low, high);
            assert_eq!(tree.classify_box(min, max).unwrap(), Region::Undecided, "{min:?} {max:?}");
        }
    }
    assert_eq!(tree.classify_box([0.0; 3], [8.0; 3]).unwrap(), Region::Crossing);
    assert_eq!(tree.classify_box([0.0; 3], [8.0, 8.0, 4.0]).unwrap(), Region::Inside);
    assert_eq!(tree.classify_box([0.0, 0.0, 4.0], [8.0; 3]).unwrap(), Region::Outside);
    assert_eq!(tree.classify_box([-1.0, 0.0, 4.0], [8.0; 3]).unwrap(), Region::Undecided);
    assert_eq!(tree.classify_box([-1.0, 0.0, 3.0], [8.0; 3]).unwrap(), Region::Crossing);
}

#[test]
fn what_is_refused() {
    let tree = Dense::uniform(2, Tag::Full).octree();
    for (min, max) in [
        ([0.0, 1.0, 0.0], [1.0, 0.5, 1.0]),
        ([f64::NAN, 0.0, 0.0], [1.0; 3]),
        ([0.0; 3], [1.0, 1.0, f64::NAN]),
        ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]),
    ] {
        assert!(matches!(tree.classify_box(min, max), Err(Error::Argument { name: "max", .. })));
    }
    let points = [[0.5; 3]; 17];
    for count in [0, 16, 18] {
        let mut answers = vec![Membership::Outside; count];
        let refused = tree.contains_many(&points, &mut answers);
        assert!(matches!(refused, Err(Error::Argument { name: "answers", .. })));
        assert!(answers.iter().all(|&answer| answer == Membership::Outside), "nothing is half-done");
    }
}

#[test]
fn points_beside_planes_that_are_no_doubles() {
    use common::exact::Exact;
    // Cells of a frame whose planes cannot be written as doubles, and the doubles on either side of them.
    for (origin, edge, depth) in
        [([0.1, -7.3, 1e5 / 3.0], 10.0 / 3.0, 5), ([1e8 + 0.3, -1e-9, 3e-5], 1e-3, 4), ([-0.7; 3], 1.4, 3)]
    {
        let frame = Frame::new(origin, edge, depth).unwrap();
        let n = frame.cells();
        for axis in 0..3 {
            for i in 0..=n {
                let near = frame.plane(axis, i);
                for x in [near.lower.next_down(), near.lower, near.upper, near.upper.next_up()] {
                    let side = |k: u32| Exact::from(x).minus(&Exact::plane(&frame, axis, k)).sign();
                    let cell =
                        (0..n).find(|&k| side(k) >= 0 && (side(k + 1) < 0 || (k + 1 == n && side(n) == 0)));
                    assert_eq!(frame.cell_at(axis, x), cell, "{axis} {i} {x:e}");
                }
                assert!(Exact::from(near.lower).minus(&Exact::plane(&frame, axis, i)).sign() <= 0);
                assert!(Exact::from(near.upper).minus(&Exact::plane(&frame, axis, i)).sign() >= 0);
            }
        }
    }
}

#[test]
fn batches_on_a_tree_of_many_levels() {
    let frame = Frame::new([-1.0, 0.3, 20.0], 2.0 / 3.0, 9).unwrap();
    let ball = Ball::new([-0.7, 0.6, 20.3], 0.29).unwrap();
    for rule in [Rule::Certified, Rule::Sampled] {
        let tree = build(&ball, &frame, rule, &alone()).unwrap();
        let coded = compact(tree.view()).unwrap();
        let mut random = Random(11);
        let near = 0.01;
        let points: Vec<[f64; 3]> = (0..20_000)
            .map(|_| [0, 1, 2].map(|axis| frame.origin()[axis] + random.between(-near, frame.edge() + near)))
            .collect();
        let mut answers = vec![Membership::Undecided; points.len()];
        tree.contains_many(&points, &mut answers).unwrap();
        let mut coded_answers = answers.clone();
        coded.contains_many(&points, &mut coded_answers).unwrap();
        assert_eq!(answers, coded_answers);
        let mut cursor = PointCursor::new(coded.view());
        for (&point, &answer) in points.iter().zip(&answers) {
            assert_eq!(tree.contains(point), answer);
            assert_eq!(cursor.contains(point), answer);
            let square = (0..3).map(|i| (point[i] - [-0.7, 0.6, 20.3][i]).powi(2)).sum::<f64>();
            match answer {
                Membership::Inside if rule == Rule::Certified => assert!(square < 0.29f64.powi(2) + 1e-12),
                Membership::Outside if rule == Rule::Certified => assert!(square > 0.29f64.powi(2) - 1e-12),
                _ => {}
            }
        }
        assert!(answers.contains(&Membership::Inside) && answers.contains(&Membership::Outside));
    }
}

#[test]
fn a_universe_without_nodes() {
    for depth in [1, 2, 3, 20] {
        for tag in common::TAGS {
            let tree = Octree::uniform(lattice_frame(depth), tag, Tag::Empty).unwrap();
            tree.view().check().unwrap();
            assert_eq!(tree.contains([0.5; 3]), membership(tag));
            assert_eq!(tree.contains([-0.5; 3]), Membership::Undecided);
            let mut answers = [Membership::Inside; 2];
            tree.contains_many(&[[0.5; 3], [f64::NAN; 3]], &mut answers).unwrap();
            assert_eq!(answers, [membership(tag), Membership::Undecided]);
            let wanted = [Region::Outside, Region::Undecided, Region::Inside]
                [common::TAGS.iter().position(|&t| t == tag).unwrap()];
            assert_eq!(tree.classify_box([0.25; 3], [1.5; 3]).unwrap(), wanted);
            let mut cursor = Cursor::new(tree.view());
            assert_eq!((cursor.tag(), cursor.node()), (tag, None));
            assert!(!cursor.descend(0) && !cursor.ascend());
            let statistics = tree.statistics();
            assert_eq!((statistics.nodes(), statistics.cells(tag)), (0, 1));
        }
    }
}

#[test]
fn every_tree_of_depth_one() {
    for code in 0..3u32.pow(8) {
        let dense = Dense {
            depth: 1,
            tags: (0..8).map(|cell| common::TAGS[(code / 3u32.pow(cell) % 3) as usize]).collect(),
        };
        let tree = dense.octree();
        assert_is(&tree, &dense);
        dense.classical().assert_same(&mut Cursor::new(tree.view()));
    }
}

#[test]
fn shapes_vary() {
    // The oracles are only as good as what they are shown: the tapes must make all kinds of solids.
    let mut random = Random(5);
    let (mut binary, mut deep, mut branches, mut uniform) = (0, 0, 0, 0);
    for _ in 0..400 {
        let tape = (0..random.below(150)).map(|_| random.next() as u8).collect();
        let dense = Shape { depth: 4, tape }.dense();
        binary += dense.is_binary() as u32;
        uniform += dense.tag_of(Cell::ROOT).is_some() as u32;
        let levels = dense.classical().levels(4);
        deep += (levels[3][0] > 0) as u32;
        branches += (levels[1][1] + levels[1][2] > 0 && levels[1][3] > 0 && levels[1][0] > 0) as u32;
    }
    for (kind, count) in [("binary", binary), ("deep", deep), ("mixed", branches), ("uniform", uniform)] {
        assert!((8..392).contains(&count), "{kind}: {count}");
    }
}
