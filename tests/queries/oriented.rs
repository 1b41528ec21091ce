//! Stored octrees under placements. Every answer is compared with all pairs of their cells, and with the
//! search by cells.

use leafless::lattice::Cube;
use leafless::octree::CellFilter;
use leafless::query::{Overlap, interference_at};
use leafless::solid::Transform;
use leafless::{
    Affine, AnySolid, Control, Csg, Error, Frame, Interference, Membership, Octree, Proof, Rule, Tag, build,
    interference,
};
use leafless_testkit::{Random, alone, cases, pairs_of};
use proptest::prelude::*;

const PROOF: f64 = f64::INFINITY;

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn cross(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

/// A parallelepiped, by its centre and its half edges.
struct Block {
    centre: Vector,
    edges: [Vector; 3],
}

/// Returns the gap of two parallelepipeds along the best of all axes; negative if they overlap.
fn gap(a: &Block, b: &Block) -> f64 {
    let normals =
        |block: &Block| [0, 1, 2].map(|i| cross(block.edges[(i + 1) % 3], block.edges[(i + 2) % 3]));
    let products = a.edges.iter().flat_map(|&u| b.edges.map(|v| (cross(u, v), u, v)));
    // Parallel edges have no product.
    let products = products.filter(|(axis, u, v)| dot(*axis, *axis) > 1e-20 * dot(*u, *u) * dot(*v, *v));
    let axes = normals(a).into_iter().chain(normals(b)).chain(products.map(|(axis, ..)| axis));
    let along = |axis: Vector| {
        let shadow = |block: &Block| block.edges.iter().map(|&edge| dot(edge, axis).abs()).sum::<f64>();
        let apart = dot([0, 1, 2].map(|i| a.centre[i] - b.centre[i]), axis).abs();
        (apart - shadow(a) - shadow(b)) / dot(axis, axis).sqrt()
    };
    axes.map(along).fold(f64::NEG_INFINITY, f64::max)
}

fn linear(placement: &Affine, v: Vector) -> Vector {
    let rows = placement.rows();
    [0, 1, 2].map(|i| rows[i][0] * v[0] + rows[i][1] * v[1] + rows[i][2] * v[2])
}

/// Returns the placed cells of a tree that are not EMPTY, each with whether it is FULL.
fn blocks(tree: &Octree, placement: &Affine) -> Vec<(Block, bool)> {
    let filter = CellFilter::tags(&[Tag::Full, Tag::Partial]);
    let cells = tree.view().cells(filter);
    cells
        .map(|cell| {
            let (min, max) = Cube { frame: tree.frame(), cell: cell.cell }.bounds();
            let centre = placement.apply([0, 1, 2].map(|i| 0.5 * (min[i] + max[i])));
            let half = 0.5 * (max[0] - min[0]);
            let edge = |i: usize| linear(placement, [0, 1, 2].map(|k| if k == i { half } else { 0.0 }));
            (Block { centre, edges: [edge(0), edge(1), edge(2)] }, cell.tag == Tag::Full)
        })
        .collect()
}

/// A margin larger than rounding, and smaller than any cell.
const MARGIN: f64 = 1e-9;

/// Checks an answer against all pairs of cells.
fn check(a: &Octree, b: &Octree, placement: &Affine, found: &Interference, text: &str) {
    let (first, second) = (blocks(a, &Affine::IDENTITY), blocks(b, placement));
    // The deepest overlap of FULL cells, and of cells that are not EMPTY.
    let (mut full, mut some) = (f64::INFINITY, f64::INFINITY);
    for (p, p_is_full) in &first {
        for (q, q_is_full) in &second {
            let gap = gap(p, q);
            some = some.min(gap);
            if *p_is_full && *q_is_full {
                full = full.min(gap);
            }
        }
    }
    match found.verdict {
        Overlap::Disjoint => assert!(some > -MARGIN, "{text}: {some} {found:?}"),
        Overlap::Overlapping => assert!(full < 0.0, "{text}: {full} {found:?}"),
        // Every clear case must be decided.
        Overlap::Undecided => assert!(full > -1e-5 && some < MARGIN, "{text}: {full} {some} {found:?}"),
    }
    check_proof(a, b, placement, found, text);
}

/// Checks the proof of an answer against the cells that contain it.
fn check_proof(a: &Octree, b: &Octree, placement: &Affine, found: &Interference, text: &str) {
    assert_eq!(found.verdict == Overlap::Overlapping, found.ball.is_some(), "{text}: {found:?}");
    assert!(found.ball.is_some() || found.witness.is_none(), "{text}: {found:?}");
    assert_eq!(found.verdict == Overlap::Overlapping, found.volume.lower > 0.0, "{text}: {found:?}");
    let back = placement.inverse().unwrap();
    let is_in_both =
        |p: Vector| a.contains(p) != Membership::Outside && b.contains(back.apply(p)) != Membership::Outside;
    let mut random = Random(11);
    if let Some(ball) = found.ball {
        assert!(ball.radius > 0.0);
        assert_eq!(a.contains(ball.centre), Membership::Inside, "{text}: {ball:?}");
        assert_eq!(b.contains(back.apply(ball.centre)), Membership::Inside, "{text}: {ball:?}");
        for _ in 0..50 {
            let v = [0; 3].map(|_| random.between(-1.0, 1.0));
            let length = dot(v, v).sqrt();
            let share = 0.999_999 * ball.radius / length;
            assert!(is_in_both([0, 1, 2].map(|i| ball.centre[i] + share * v[i])), "{text}: {ball:?}");
        }
    }
    if let (Some(cell), Some(ball)) = (found.witness, found.ball) {
        let (min, max) = Cube { frame: a.frame(), cell }.bounds();
        let slack = 1e-12 * a.frame().edge();
        for i in 0..3 {
            let (low, high) = (ball.centre[i] - ball.radius, ball.centre[i] + ball.radius);
            assert!(min[i] - slack <= low && high <= max[i] + slack, "{text}: {cell:?} {ball:?}");
        }
    }
}

fn at(a: &Octree, b: &Octree, placements: &[Affine]) -> Vec<Interference> {
    interference_at(a, b, b.frame(), placements, a.frame(), PROOF, &alone()).unwrap()
}

/// A rotation, or another map unless `is_rigid`, followed by an offset.
fn placement(random: &mut Random, is_rigid: bool, reach: f64) -> Affine {
    let q = loop {
        let q = [0; 4].map(|_| random.between(-1.0, 1.0));
        let square: f64 = q.iter().map(|c| c * c).sum();
        if (0.1..1.0).contains(&square) {
            break q.map(|c| c / square.sqrt());
        }
    };
    let [w, x, y, z] = q;
    let mut rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    if !is_rigid {
        let shear = rows;
        let factors = [0; 3].map(|_| random.between(-0.8, 0.8));
        let scale = random.between(0.3, 2.0);
        rows =
            [0, 1, 2].map(|i| [0, 1, 2].map(|j| scale * (shear[i][j] + factors[i] * shear[(i + 1) % 3][j])));
    }
    let offset = [0; 3].map(|_| random.between(-reach, reach));
    Affine::new([0, 1, 2].map(|i| [rows[i][0], rows[i][1], rows[i][2], offset[i]])).unwrap()
}

/// A random union of balls and boxes within 1.5 of the origin, with parts cut off.
fn shape(random: &mut Random) -> Csg {
    let mut shape: Option<Csg> = None;
    for _ in 0..1 + random.below(4) {
        let centre = [0; 3].map(|_| random.between(-0.8, 0.8));
        let size = random.between(0.2, 0.7);
        let part = match random.below(2) {
            0 => Csg::ball(centre, size).unwrap(),
            _ => Csg::cuboid(centre.map(|c| c - size), centre.map(|c| c + 0.7 * size)).unwrap(),
        };
        shape = Some(match shape {
            Some(shape) if random.below(3) == 0 => shape.difference(&part).unwrap(),
            Some(shape) => Csg::union_of([shape, part]).unwrap(),
            None => part,
        });
    }
    shape.unwrap()
}

#[test]
fn answers_agree_with_all_pairs_of_cells() {
    let mut random = Random(1);
    let mut counts = [0; 3];
    for case in 0..150 {
        let frames = [3 + random.below(2) as u8, 3 + random.below(2) as u8].map(|depth| {
            let edge = random.between(3.2, 4.0);
            Frame::new([0; 3].map(|_| -0.5 * edge + random.between(-0.05, 0.05)), edge, depth).unwrap()
        });
        let rules = [Rule::Certified, Rule::Certified, Rule::Sampled, Rule::Outer];
        let [a, b] = frames.map(|frame| {
            let rule = rules[random.below(4) as usize];
            build(&shape(&mut random), &frame, rule, &alone()).unwrap().with_proof(Proof::CERTIFIED)
        });
        let placements: Vec<Affine> = (0..6).map(|_| placement(&mut random, case % 3 > 0, 1.7)).collect();
        for (placement, found) in placements.iter().zip(at(&a, &b, &placements)) {
            check(&a, &b, placement, &found, &format!("case {case}, {placement:?}"));
            counts[found.verdict as usize] += 1;
        }
    }
    println!("{counts:?}");
    assert!(counts.iter().all(|&count| count > 30), "{counts:?}");
}

proptest! {
    #![proptest_config(cases(150))]

    #[test]
    fn answers_about_any_cells((a, b) in (1u8..=3).prop_flat_map(pairs_of), seed in any::<u64>()) {
        let mut random = Random(seed | 1);
        let (a, b) = (a.octree(), b.octree());
        let edge = a.frame().edge();
        for is_rigid in [true, false] {
            // (Rotated around a corner of the universe.)
            let placement = placement(&mut random, is_rigid, 1.2 * edge);
            let found = at(&a, &b, &[placement]);
            let whole = [&a, &b].map(|tree| tree.proof().is_certified() && tree.view().exterior() == Tag::Empty);
            // Another search, which blurs cells, may prove less.
            // A tree whose universe, or each octant of it, is decided has no elements to descend.
            let is_cut = |tree: &&Octree| tree.view().cells(CellFilter::leaves()).any(|cell| cell.cell.level > 1);
            if whole == [true; 2] && [&a, &b].iter().all(is_cut) {
                check(&a, &b, &placement, &found[0], "any cells");
            } else {
                check_proof(&a, &b, &placement, &found[0], "any cells");
            }
        }
    }
}

#[test]
fn answers_never_contradict_the_search_by_cells() {
    let mut random = Random(2);
    let mut counts = [0; 3];
    for depth in [5, 6] {
        for case in 0..15 {
            let frame = Frame::new([-2.0; 3], 4.0, depth).unwrap();
            let [a, b] =
                [0; 2].map(|_| build(&shape(&mut random), &frame, Rule::Certified, &alone()).unwrap());
            let placements: Vec<Affine> = (0..8).map(|_| placement(&mut random, true, 1.5)).collect();
            let fine = Frame::new([-2.0; 3], 4.0, depth + 2).unwrap();
            for (placement, found) in placements.iter().zip(at(&a, &b, &placements)) {
                let moved = Transform::new(&b, &fine, placement);
                let control = Control { max_splits: Some(100_000), ..alone() };
                let other = interference(&a, &moved, &fine, PROOF, &control).unwrap();
                let verdicts = [found.verdict, other.verdict];
                assert!(
                    !verdicts.contains(&Overlap::Disjoint) || !verdicts.contains(&Overlap::Overlapping),
                    "case {case}: {found:?} {other:?}"
                );
                // Cells at twice the resolution blur some answers. The search by boxes loses none.
                assert!(found.verdict != Overlap::Undecided || other.verdict != Overlap::Disjoint);
                check_proof(&a, &b, placement, &found, &format!("case {case}"));
                counts[found.verdict as usize] += 1;
            }
        }
    }
    println!("{counts:?}");
    assert!(counts[0] > 20 && counts[1] > 20, "{counts:?}");
}

/// Touching faces, edges and corners are no overlap. Slightly deeper contacts are.
#[test]
fn boxes_that_touch() {
    let frame = Frame::new([-8.0; 3], 16.0, 6).unwrap();
    let cuboid = Csg::cuboid([-1.0, -2.0, -1.0], [1.0, 2.0, 3.0]).unwrap();
    let tree = build(&cuboid, &frame, Rule::Certified, &alone()).unwrap();
    assert!(tree.view().is_binary());
    let moved = |rows: [[f64; 3]; 3], offset: Vector| {
        Affine::new([0, 1, 2].map(|i| [rows[i][0], rows[i][1], rows[i][2], offset[i]])).unwrap()
    };
    let still = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // A quarter turn about z: half sides of 2 and 1.
    let quarter = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    let eighth = [[0.5f64.sqrt(), -0.5f64.sqrt(), 0.0], [0.5f64.sqrt(), 0.5f64.sqrt(), 0.0], [0.0, 0.0, 1.0]];
    let tilted = [[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]];
    // In lattice planes contact is proven to be no overlap, also beside cells.
    for (rows, offset) in [
        (still, [2.0, 0.0, 0.0]),
        (still, [0.0, -4.0, 0.0]),
        (still, [2.0, 4.0, 4.0]),
        (still, [2.0, 0.25, -0.5]),
        (quarter, [3.0, 0.0, 0.0]),
        (quarter, [0.0, 3.0, -4.0]),
    ] {
        let found = at(&tree, &tree, &[moved(rows, offset)]);
        assert_eq!(found[0].verdict, Overlap::Disjoint, "{offset:?}");
    }
    // The face z = 3 on the rotated face z = −1, and an edge on a face.
    for (rows, offset) in [
        (tilted, [0.0, 0.0, 4.0]),
        (tilted, [0.3, 0.1, -4.0]),
        (eighth, [0.1, 0.2, 4.0]),
        (still, [2.0, 0.1, 0.3]),
        (tilted, [3.2, 0.0, 0.0]),
        (eighth, [1.0 + 3.0 * 0.5f64.sqrt(), 0.0, 0.0]),
    ] {
        let away = [0, 1, 2].map(|i| if offset[i].abs() > 1.0 { 1e-9 * offset[i].signum() } else { 0.0 });
        let shifted = |share: f64| moved(rows, [0, 1, 2].map(|i| offset[i] + share * away[i]));
        let found = at(&tree, &tree, &[shifted(0.0), shifted(1.0), shifted(-1e3)]);
        assert!(rows == eighth || found[0].verdict != Overlap::Overlapping, "{offset:?}: {:?}", found[0]);
        assert_eq!(found[1].verdict, Overlap::Disjoint, "{offset:?}");
        assert_eq!(found[2].verdict, Overlap::Overlapping, "{offset:?}: {:?}", found[2]);
        assert!(found[2].ball.is_some_and(|ball| ball.radius > 1e-8), "{:?}", found[2]);
    }
}

#[test]
fn a_tree_meets_itself() {
    for depth in [4, 5, 9] {
        let frame = Frame::new([-1.5; 3], 3.0, depth).unwrap();
        let tree = build(&Csg::ball([0.1; 3], 1.0).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
        let found = at(&tree, &tree, &[Affine::IDENTITY])[0];
        assert_eq!(found.verdict, Overlap::Overlapping);
        assert!(depth < 9 || found.witness.is_some(), "{found:?}");
        assert!(found.ball.is_some() && found.splits.iter().sum::<u64>() < 100, "{found:?}");
        check_proof(&tree, &tree, &Affine::IDENTITY, &found, "itself");
        // At a millionth of its size it is nearly a point, and at a million times it is nearly everywhere.
        for scale in [1e-6, 1e6] {
            let row = |i: usize| {
                [0, 1, 2, 3].map(|j| if j == i { scale } else { 0.05 * f64::from(u8::from(j == 3)) })
            };
            let placement = Affine::new([row(0), row(1), row(2)]).unwrap();
            let found = at(&tree, &tree, &[placement])[0];
            assert_eq!(found.verdict, Overlap::Overlapping, "{found:?}");
            check_proof(&tree, &tree, &placement, &found, "scaled");
        }
    }
}

/// Where solids are clearly apart or clearly overlap, the work does not grow with the depth.
#[test]
fn clear_answers_take_as_long_at_any_depth() {
    let turn =
        |x: f64| Affine::new([[0.36, 0.48, -0.8, x], [-0.8, 0.6, 0.0, 0.0], [0.48, 0.64, 0.6, 0.0]]).unwrap();
    let splits = |depth: u8| {
        let frame = Frame::new([-2.0; 3], 4.0, depth).unwrap();
        let tree = build(&Csg::ball([0.0; 3], 1.0).unwrap(), &frame, Rule::Sampled, &alone()).unwrap();
        let tree = tree.with_proof(Proof::CERTIFIED);
        let found = at(&tree, &tree, &[turn(2.2), turn(1.7)]);
        assert_eq!(found[0].verdict, Overlap::Disjoint);
        assert_eq!(found[1].verdict, Overlap::Overlapping);
        found.iter().map(|found| found.splits.iter().sum::<u64>()).collect::<Vec<_>>()
    };
    let [coarse, fine] = [6, 9].map(splits);
    println!("{coarse:?} {fine:?}");
    assert!(
        coarse.iter().zip(&fine).all(|(coarse, fine)| *fine <= coarse + coarse / 4 + 16),
        "{coarse:?} {fine:?}"
    );
}

#[test]
fn what_is_no_whole_octree_is_searched_by_cells() {
    let mut random = Random(3);
    let frame = Frame::new([-2.0; 3], 4.0, 5).unwrap();
    let ball = build(&Csg::ball([0.0; 3], 1.0).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
    let half = Csg::cuboid([-9.0, -9.0, -9.0], [9.0, 9.0, 0.3]).unwrap();
    let clipped = build(&half, &frame, Rule::Certified, &alone()).unwrap();
    assert!(clipped.view().is_clipped());
    let inner = build(&Csg::ball([0.0; 3], 1.0).unwrap(), &frame, Rule::Inner, &alone()).unwrap();
    let sampled = build(&Csg::ball([0.0; 3], 1.0).unwrap(), &frame, Rule::Sampled, &alone()).unwrap();
    let uniform = |tag| Octree::uniform(frame, tag, Tag::Empty).unwrap();
    let others = [clipped, inner, sampled, uniform(Tag::Empty), uniform(Tag::Full), uniform(Tag::Partial)];
    for other in &others {
        for (a, b) in [(&ball, other), (other, &ball), (other, other)] {
            let placement = placement(&mut random, true, 1.0);
            let found = at(a, b, &[placement])[0];
            let by_cells =
                interference(a, &Transform::new(b, &frame, &placement), &frame, PROOF, &alone()).unwrap();
            // (Bounds known for only one of the two may lead to another ball.)
            let all = |found: &Interference| (found.verdict, found.splits, found.level, found.clipped);
            assert_eq!(all(&found), all(&by_cells));
        }
    }
    // On a finer or a coarser frame cells are cut at another depth.
    for depth in [4, 6] {
        let other = Frame::new([-2.0; 3], 4.0, depth).unwrap();
        let placement = placement(&mut random, true, 1.0);
        let found = interference_at(&ball, &ball, &frame, &[placement], &other, PROOF, &alone()).unwrap();
        let moved = Transform::new(&ball, &frame, &placement);
        assert_eq!(found[0], interference(&ball, &moved, &other, PROOF, &alone()).unwrap());
    }
}

/// A wrapped octree is the same octree. Expressions of octrees are other solids; their answers are equal or
/// undecided.
#[test]
fn wrapped_octrees_are_octrees() {
    let mut random = Random(4);
    for depth in [5, 6] {
        let frame = Frame::new([-2.0; 3], 4.0, depth).unwrap();
        let tree = build(&shape(&mut random), &frame, Rule::Certified, &alone()).unwrap();
        let outside = leafless::complement(tree.view(), &alone()).unwrap();
        let placements: Vec<Affine> = (0..30).map(|_| placement(&mut random, true, 1.5)).collect();
        let direct = at(&tree, &tree, &placements);
        let any = AnySolid::new(tree.clone());
        let twice = Csg::solid(AnySolid::new(outside)).complement();
        let found = interference_at(&any, tree.view(), &frame, &placements, &frame, PROOF, &alone()).unwrap();
        assert_eq!(found, direct);
        let found = interference_at(&twice, &any, &frame, &placements, &frame, PROOF, &alone()).unwrap();
        for (found, direct) in found.iter().zip(&direct) {
            assert!(
                found.verdict == direct.verdict || found.verdict == Overlap::Undecided,
                "{found:?} {direct:?}"
            );
        }
        // With two octrees in one expression, each child of the root may belong to either.
        let parts = [
            Csg::cuboid([-1.5, -1.5, -1.5], [-0.5, 1.0, 1.0]),
            Csg::cuboid([0.5, -1.0, -1.0], [1.5, 1.0, 1.0]),
        ]
        .map(|part| AnySolid::new(build(&part.unwrap(), &frame, Rule::Certified, &alone()).unwrap()));
        let both = Csg::union_of(parts.map(Csg::solid)).unwrap();
        let whole = build(&both, &frame, Rule::Certified, &alone()).unwrap();
        let found = interference_at(&both, &tree, &frame, &placements, &frame, PROOF, &alone()).unwrap();
        for (found, stored) in found.iter().zip(at(&whole, &tree, &placements)) {
            assert!(
                found.verdict == stored.verdict || found.verdict == Overlap::Undecided,
                "{found:?} {stored:?}"
            );
        }
    }
}

#[test]
fn limits_threads_and_tolerances() {
    let mut random = Random(5);
    let frame = Frame::new([-2.0; 3], 4.0, 7).unwrap();
    let [a, b] = [0; 2].map(|_| build(&shape(&mut random), &frame, Rule::Certified, &alone()).unwrap());
    let placements: Vec<Affine> = (0..50).map(|_| placement(&mut random, true, 1.5)).collect();
    for tolerance in [PROOF, 0.3] {
        let with =
            |control: Control<'_>| interference_at(&a, &b, &frame, &placements, &frame, tolerance, &control);
        let limited = |threads, most| Control { threads, max_splits: Some(most), ..Control::default() };
        let one = with(limited(1, 100_000)).unwrap();
        assert_eq!(one, with(limited(4, 100_000)).unwrap());
        let few = with(limited(1, 10)).unwrap();
        for (all, few) in one.iter().zip(&few) {
            assert!(few.splits.iter().sum::<u64>() <= 10);
            assert!(few.verdict == Overlap::Undecided || few.verdict == all.verdict);
            assert!(few.volume.upper >= all.volume.lower && all.volume.upper >= few.volume.lower);
            assert!(tolerance == PROOF || all.volume.width() <= 0.5, "{all:?}");
        }
        let little = Control { max_bytes: Some(64), ..alone() };
        assert!(with(little).unwrap().iter().any(|found| found.verdict == Overlap::Undecided));
        let flag = std::sync::atomic::AtomicBool::new(true);
        assert!(matches!(with(Control { cancel: Some(&flag), ..alone() }), Err(Error::Cancelled)));
    }
    // The volume is that of the cells.
    let identity = [Affine::IDENTITY];
    let found = interference_at(&a, &a, &frame, &identity, &frame, 0.0, &alone()).unwrap();
    assert_eq!(found[0].volume, a.statistics().volume());
}
