//! Queries of stored trees against dense arrays.

use leafless::octree::Cursor;
use leafless::query::{PointCursor, PointTable, Region, classify_box};
use leafless::solid::SplitCounter;
use leafless::{
    AnySolid, Callback, Cell, Control, Csg, Error, Frame, Membership, Octree, Rule, Solid, Tag, Verdict,
    build, compact, contains,
};
use leafless_testkit::cubes::Plain;
use leafless_testkit::exact::Exact;
use leafless_testkit::{
    Dense, DenseSolid, Random, Shape, alone, assert_is, cases, lattice_frame, positions, shapes,
};
use proptest::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

fn membership(tag: Tag) -> Membership {
    match tag {
        Tag::Empty => Membership::Outside,
        Tag::Full => Membership::Inside,
        _ => Membership::Undecided,
    }
}

/// Returns the answer for a point in lattice coordinates. A point on a plane belongs to the cell above; on
/// the upper face, to the last cell.
fn expected(dense: &Dense, point: [f64; 3]) -> Membership {
    let n = (1u32 << dense.depth) as f64;
    if !point.iter().all(|&x| (0.0..=n).contains(&x)) {
        return Membership::Undecided;
    }
    membership(dense.at(point.map(|x| x.floor().min(n - 1.0) as u32)))
}

/// Points in cells, on planes, edges, corners and faces of the universe and beside it, and invalid points.
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
    for level in 0..=dense.depth + 1 {
        let table = PointTable::new(tree.view(), level).unwrap();
        assert!(table.level() <= level.min(dense.depth).max(1 + (dense.depth + 1) % 2));
        positions(dense.depth).for_each(|at| assert_eq!(table.tag_at(at), dense.at(at)));
        assert_eq!(table.tag_at([0, 1 << dense.depth, 0]), Tag::Partial);
        let mut answers = vec![Membership::Inside; points.len()];
        table.contains_many(&points, &mut answers).unwrap();
        assert_eq!(answers, wanted);
        assert!(table.contains_many(&points, &mut answers[1..]).is_err());
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
            let (min, max) = a_box(n, &mut random);
            let wanted = region(&dense, min, max);
            assert_eq!(tree.classify_box(min, max).unwrap(), wanted, "{min:?} {max:?}");
            assert_eq!(coded.classify_box(min, max).unwrap(), wanted);
        }
    }
}

/// A box in the cube [0, n]³ or beside it: with faces on planes and between them, thin boxes, and absurd
/// ones.
fn a_box(n: f64, random: &mut Random) -> ([f64; 3], [f64; 3]) {
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
    (min, max)
}

/// Returns the answer for a box, cell by cell. A box without thickness along an axis is one cell thick there:
/// the cell above the box, or the last cell.
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
    // Cells of a frame whose planes are no doubles, and the doubles on both sides of the planes.
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
    let ball = Csg::ball([-0.7, 0.6, 20.3], 0.29).unwrap();
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

// ---- any solid, without an octree -----------------------------------------------------------------------

/// Classifies points in one call.
fn located<S: Solid>(solid: &S, frame: &Frame, points: &[[f64; 3]], threads: usize) -> Vec<Membership> {
    let mut answers = vec![Membership::Inside; points.len()];
    contains(solid, frame, points, &mut answers, &Control::threads(threads)).unwrap();
    answers
}

/// Returns points in lattice coordinates as points of a frame.
fn points_on(frame: &Frame, seed: u64, count: usize) -> Vec<[f64; 3]> {
    let mut points = points(frame.depth(), seed, count);
    for point in &mut points {
        *point = [0, 1, 2].map(|axis| frame.origin()[axis] + point[axis] * frame.cell_size());
    }
    points
}

/// Checks that a solid's answers for points and boxes are those of its octree.
fn octree_agrees<S: Solid>(solid: &S, frame: &Frame, seed: u64, count: usize) {
    let tree = build(solid, frame, Rule::Certified, &alone()).unwrap();
    points_agree(solid, &tree, seed, count);
    boxes_agree(solid, &tree, seed);
}

fn points_agree<S: Solid>(solid: &S, tree: &Octree, seed: u64, count: usize) {
    let points = points_on(tree.frame(), seed, count);
    let wanted: Vec<Membership> = points.iter().map(|&point| tree.contains(point)).collect();
    for threads in [1, 2] {
        assert_eq!(located(solid, tree.frame(), &points, threads), wanted, "{threads} threads");
        for count in [0, 1, 2, 33] {
            let few = located(solid, tree.frame(), &points[..count], threads);
            assert_eq!(few, wanted[..count], "{threads} threads");
        }
    }
    for (&point, &wanted) in points.iter().zip(&wanted).take(150) {
        assert_eq!(located(solid, tree.frame(), &[point], 1), [wanted], "{point:?}");
    }
}

fn boxes_agree<S: Solid>(solid: &S, tree: &Octree, seed: u64) {
    let frame = tree.frame();
    let mut random = Random(seed);
    let on = |at: [f64; 3]| [0, 1, 2].map(|axis| frame.origin()[axis] + at[axis] * frame.cell_size());
    for _ in 0..100 {
        let (min, max) = a_box(frame.cells() as f64, &mut random);
        let (min, max) = (on(min), on(max));
        let ask = |control: &Control<'_>| classify_box(solid, frame, min, max, control).unwrap();
        let wanted = tree.classify_box(min, max).unwrap();
        let found = ask(&Control::default());
        assert_eq!(found, wanted, "{min:?} {max:?}");
        // A budget removes proofs and adds none. A larger budget removes fewer.
        let mut known = false;
        for most in [0, 1, 2, 5, 20, 100] {
            let found = ask(&Control { max_splits: Some(most), ..alone() });
            assert!(found == wanted || found == Region::Undecided && !known, "{most}: {found:?} {wanted:?}");
            known = found != Region::Undecided;
        }
        if tree.view().root_tag() == Tag::Branch {
            assert_eq!(ask(&Control { max_splits: Some(0), ..alone() }), Region::Undecided);
        }
    }
}

/// Returns a dense array as a function of boxes.
fn as_callback(dense: &Dense, frame: Frame) -> impl Solid {
    Callback::new(move |min, max| {
        let at = |axis: usize, x: f64| ((x - frame.origin()[axis]) / frame.cell_size()).round() as u32;
        let edge = at(0, max[0]) - at(0, min[0]);
        let level = dense.depth - edge.trailing_zeros() as u8;
        Ok(match dense.tag_of(Cell { level, at: [0, 1, 2].map(|axis| at(axis, min[axis]) / edge) }) {
            Some(Tag::Empty) => Verdict::Empty,
            Some(Tag::Full) => Verdict::Full,
            Some(_) => Verdict::Undecided,
            None => Verdict::Partial(()),
        })
    })
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn any_solid_knows_its_points_and_boxes(shape in shapes(1..=5), seed in any::<u64>()) {
        let dense = shape.dense();
        let frame = lattice_frame(dense.depth);
        let tree = dense.octree();
        let solid = DenseSolid { dense: &dense, exterior: Tag::Empty };
        // By the dense array itself.
        let points = points(dense.depth, seed, 500);
        let wanted: Vec<Membership> = points.iter().map(|&point| expected(&dense, point)).collect();
        assert_eq!(located(&solid, &frame, &points, 1), wanted);
        let mut random = Random(seed);
        for _ in 0..if dense.depth < 5 { 50 } else { 5 } {
            let (min, max) = a_box(frame.cells() as f64, &mut random);
            let found = classify_box(&solid, &frame, min, max, &alone()).unwrap();
            assert_eq!(found, region(&dense, min, max), "{min:?} {max:?}");
        }
        // By the octree.
        octree_agrees(&solid, &frame, seed, 300);
        octree_agrees(&as_callback(&dense, frame), &frame, seed, 300);
        octree_agrees(&tree, &frame, seed, 300);
        let coded = compact(tree.view()).unwrap();
        octree_agrees(&AnySolid::new(coded), &frame, seed, 300);
        // Cut at a level, and finer than the tree.
        for depth in [dense.depth.saturating_sub(1).max(1), dense.depth + 2] {
            octree_agrees(tree.view(), &frame.with_depth(depth).unwrap(), seed, 200);
        }
    }

    #[test]
    fn any_shape_knows_its_points_and_boxes(
        centre in [-0.3..0.3f64, -0.3..0.3, -0.3..0.3], radius in 0.1..0.6f64, depth in 1..=6u8, seed in any::<u64>(),
    ) {
        let ball = Plain::ball(centre, radius).unwrap();
        let csg = Csg::ball(centre, radius).unwrap();
        let corner = Csg::cuboid(centre, [0.7; 3]).unwrap();
        let bitten = csg.difference(&Csg::half_space([0.5, -1.0, 0.25], 0.1).unwrap()).unwrap();
        let mixed = Csg::xor_of([bitten.clone(), Csg::solid(AnySolid::new(corner))]).unwrap();
        // Planes that are doubles, and planes that are not.
        for frame in [Frame::new([-0.5; 3], 1.0, depth).unwrap(), Frame::new([-0.6, -0.7, -0.1], 1.3, depth).unwrap()] {
            octree_agrees(&ball, &frame, seed, 300);
            octree_agrees(&bitten, &frame, seed, 300);
            octree_agrees(&mixed, &frame, seed, 300);
            octree_agrees(&AnySolid::new(mixed.complement()), &frame, seed, 300);
        }
    }
}

#[test]
fn many_points_of_any_solid_are_those_of_its_octree() {
    // Enough for several threads.
    let frame = Frame::new([-1.0, 0.3, 20.0], 2.0 / 3.0, 8).unwrap();
    let centre = [-0.7, 0.6, 20.3];
    let ball = Plain::ball(centre, 0.29).unwrap();
    let tree = build(&ball, &frame, Rule::Certified, &alone()).unwrap();
    let csg = Csg::ball(centre, 0.29).unwrap();
    points_agree(&ball, &tree, 1, 20_000);
    points_agree(&csg, &build(&csg, &frame, Rule::Certified, &alone()).unwrap(), 2, 20_000);
    points_agree(&tree, &tree, 3, 20_000);
    points_agree(
        &AnySolid::new(csg.clone()),
        &build(&csg, &frame, Rule::Certified, &alone()).unwrap(),
        4,
        20_000,
    );
}

#[test]
fn what_a_solid_knows_of_points_comes_first() {
    let frame = lattice_frame(3);
    let asked = AtomicU64::new(0);
    let inside = |point: [f64; 3]| point[0] + 2.0 * point[1] > 9.3;
    let solid = Callback::new(|_, _| Ok(Verdict::Partial(()))).with_contains(|point| {
        asked.fetch_add(1, Ordering::Relaxed);
        Ok(inside(point))
    });
    for count in [1, 100, 20_000] {
        let points = points(3, count as u64, count);
        for threads in [1, 2] {
            asked.store(0, Ordering::Relaxed);
            let answers = located(&solid, &frame, &points, threads);
            let mut known = 0;
            for (&point, answer) in points.iter().zip(answers) {
                let wanted = match (frame.cell_of(point), inside(point)) {
                    (None, _) => Membership::Undecided,
                    (_, true) => Membership::Inside,
                    (_, false) => Membership::Outside,
                };
                assert_eq!(answer, wanted, "{point:?}");
                known += (answer != Membership::Undecided) as u64;
            }
            // Points outside the universe are not queried.
            assert_eq!(asked.load(Ordering::Relaxed), known);
        }
    }
}

#[test]
fn points_cost_no_more_splits_than_their_way() {
    let frame = Frame::new([-2.0; 3], 4.0, 20).unwrap();
    let ball = SplitCounter::new(Csg::ball([0.0; 3], 1.0).unwrap());
    let splits = || ball.splits().iter().sum::<u64>();
    assert_eq!(located(&ball, &frame, &[[0.3, 0.4, 0.8]; 200], 1), [Membership::Inside; 200]);
    let one = splits();
    assert!((1..=20).contains(&one), "{one}");
    // Neighbours share the way, in any order.
    let points: Vec<[f64; 3]> = (0..1000u32)
        .map(|i| [1.0, f64::from(i * 577 % 1000) * 1e-6, f64::from(i * 311 % 1000) * 1e-6])
        .collect();
    located(&ball, &frame, &points, 1);
    let all = splits() - one;
    assert!(all < 10_000, "{all}");
    // A box is done as soon as the answer is known.
    let before = splits();
    let crossing = classify_box(&ball, &frame, [-1.5; 3], [1.5; 3], &alone()).unwrap();
    assert!(crossing == Region::Crossing && splits() - before < 60, "{crossing:?} {}", splits() - before);
    for most in [0, 1, 7, 1000] {
        let before = splits();
        let control = Control { max_splits: Some(most), ..alone() };
        // A box with a face on the surface.
        classify_box(&ball, &frame, [1.0, -0.5, -0.5], [1.5, 0.5, 0.5], &control).unwrap();
        assert!(splits() - before <= most);
    }
}

#[test]
fn a_budget_of_nothing_proves_nothing_of_a_cut_universe() {
    let frame = lattice_frame(5);
    let ball = Csg::ball([16.0; 3], 12.0).unwrap();
    let none = Control { max_splits: Some(0), ..alone() };
    for (min, max, wanted) in [
        ([2.0, 12.0, 12.0], [9.0, 20.0, 20.0], Region::Crossing),
        ([14.0; 3], [18.0; 3], Region::Inside),
        ([0.0; 3], [3.0; 3], Region::Outside),
    ] {
        assert_eq!(classify_box(&ball, &frame, min, max, &alone()).unwrap(), wanted);
        assert_eq!(classify_box(&ball, &frame, min, max, &none).unwrap(), Region::Undecided);
    }
    // Decisions without splits need no budget.
    let far = Csg::ball([99.0; 3], 12.0).unwrap();
    assert_eq!(classify_box(&far, &frame, [0.0; 3], [32.0; 3], &none).unwrap(), Region::Outside);
    assert_eq!(classify_box(&far.complement(), &frame, [0.0; 3], [32.0; 3], &none).unwrap(), Region::Inside);
}

#[test]
fn what_is_refused_of_any_solid() {
    let frame = lattice_frame(4);
    let ball = Csg::ball([8.0; 3], 5.0).unwrap();
    for (min, max) in [
        ([0.0, 1.0, 0.0], [1.0, 0.5, 1.0]),
        ([f64::NAN, 0.0, 0.0], [1.0; 3]),
        ([0.0; 3], [1.0, 1.0, f64::NAN]),
        ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]),
    ] {
        let refused = classify_box(&ball, &frame, min, max, &alone());
        assert!(matches!(refused, Err(Error::Argument { name: "max", .. })));
    }
    let points = [[0.5; 3]; 17];
    for count in [0, 16, 18] {
        let mut answers = vec![Membership::Inside; count];
        let refused = contains(&ball, &frame, &points, &mut answers, &alone());
        assert!(matches!(refused, Err(Error::Argument { name: "answers", .. })));
        assert!(answers.iter().all(|&answer| answer == Membership::Inside), "nothing is half-done");
    }
    let mut answers = [Membership::Inside; 17];
    // Queries that the solid refuses.
    let tree = Dense::uniform(3, Tag::Full).octree();
    let refused = contains(&tree, &frame, &points, &mut answers, &alone());
    assert!(matches!(refused, Err(Error::FrameMismatch { .. })));
    let refused = classify_box(&tree, &frame, [0.0; 3], [1.0; 3], &alone());
    assert!(matches!(refused, Err(Error::FrameMismatch { .. })));
    // A host that stops the work.
    let failing = Callback::new(|_, _| Err(Error::Callback { code: 3 }));
    let refused = contains(&failing, &frame, &points, &mut answers, &alone());
    assert!(matches!(refused, Err(Error::Callback { code: 3 })));
    let refused = classify_box(&failing, &frame, [0.0; 3], [1.0; 3], &alone());
    assert!(matches!(refused, Err(Error::Callback { code: 3 })));
    // A flag that is set.
    let flag = AtomicBool::new(true);
    let control = Control { cancel: Some(&flag), ..alone() };
    assert!(matches!(contains(&ball, &frame, &points, &mut answers, &control), Err(Error::Cancelled)));
    let refused = classify_box(&ball, &frame, [3.0; 3], [9.0; 3], &control);
    assert!(matches!(refused, Err(Error::Cancelled)));
}

#[test]
fn a_universe_without_nodes() {
    for depth in [1, 2, 3, 20] {
        for tag in leafless_testkit::TAGS {
            let tree = Octree::uniform(lattice_frame(depth), tag, Tag::Empty).unwrap();
            tree.view().check().unwrap();
            assert_eq!(tree.contains([0.5; 3]), membership(tag));
            assert_eq!(tree.contains([-0.5; 3]), Membership::Undecided);
            let mut answers = [Membership::Inside; 2];
            tree.contains_many(&[[0.5; 3], [f64::NAN; 3]], &mut answers).unwrap();
            assert_eq!(answers, [membership(tag), Membership::Undecided]);
            let wanted = [Region::Outside, Region::Undecided, Region::Inside]
                [leafless_testkit::TAGS.iter().position(|&t| t == tag).unwrap()];
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
            tags: (0..8).map(|cell| leafless_testkit::TAGS[(code / 3u32.pow(cell) % 3) as usize]).collect(),
        };
        let tree = dense.octree();
        assert_is(&tree, &dense);
        dense.classical().assert_same(&mut Cursor::new(tree.view()));
    }
}

#[test]
fn shapes_vary() {
    // The oracles test only the solids that they receive. The tapes must make all kinds of solids.
    let mut random = Random(5);
    let (mut binary, mut deep, mut branches, mut uniform) = (0, 0, 0, 0);
    for _ in 0..400 {
        let tape = (0..random.below(150)).map(|_| random.bits() as u8).collect();
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
