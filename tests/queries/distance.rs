//! Distances of points: against dense arrays in integers, and against solids whose distance is a formula.

use leafless::octree::TaggedCell;
use leafless::query::{DistanceTo, NearCell, StopReason, distances};
use leafless::{
    Affine, AnySolid, Cell, Control, Csg, Error, Frame, Interval, Octree, Proof, Rule, Solid, Tag, build,
    compact,
};
use leafless_testkit::exact::Exact;
use leafless_testkit::{
    Classical, Dense, DenseSolid, Random, alone, cases, lattice_frame, positions, shapes,
};
use proptest::prelude::*;
use std::sync::atomic::AtomicBool;

/// Coordinates are multiples of 2^-UNIT.
const UNIT: u32 = 24;
const ONE: i128 = 1 << UNIT;
const TARGETS: [DistanceTo; 3] = [DistanceTo::Solid, DistanceTo::Complement, DistanceTo::Boundary];

fn model(point: [i128; 3]) -> [f64; 3] {
    point.map(|c| c as f64 / ONE as f64)
}

/// Returns the squared distance of a point from the box between two corners, in cells.
fn square(point: [i128; 3], lower: [u32; 3], upper: [u32; 3]) -> i128 {
    let gap = |axis: usize| {
        let (low, high) = (lower[axis] as i128 * ONE, upper[axis] as i128 * ONE);
        (low - point[axis]).max(point[axis] - high).max(0).pow(2)
    };
    gap(0) + gap(1) + gap(2)
}

/// Returns the least squared distance of a point from the cells or the exterior with these tags.
fn least(dense: &Dense, exterior: Tag, point: [i128; 3], tags: &[Tag]) -> Option<i128> {
    let cells = positions(dense.depth).filter(|&at| tags.contains(&dense.at(at)));
    let inside = cells.map(|at| square(point, at, at.map(|a| a + 1))).min();
    let edge = ONE << dense.depth;
    let outside = point.map(|c| c.min(edge - c).max(0)).into_iter().min().unwrap().pow(2);
    let outside = tags.contains(&exterior).then_some(outside);
    inside.into_iter().chain(outside).min()
}

/// Compares a distance with the root of a square. ∞ is greater than all roots.
fn order(distance: f64, square: Option<i128>) -> i32 {
    match square {
        None if distance == f64::INFINITY => 0,
        None => -1,
        Some(_) if distance == f64::INFINITY => 1,
        Some(_) if distance < 0.0 => -1,
        Some(square) => {
            let (distance, unit) = (Exact::from(distance), Exact::power_of_two(-2 * i64::from(UNIT)));
            // A square has up to 70 bits.
            let (high, low) = ((square >> 40) as f64, (square & ((1 << 40) - 1)) as f64);
            let square = Exact::from(high).times(&Exact::power_of_two(40)).plus(&Exact::from(low));
            distance.times(&distance).minus(&square.times(&unit)).sign()
        }
    }
}

/// True if `lower` is at most the root, and at most three doubles below it.
fn is_just_below(lower: f64, square: Option<i128>) -> bool {
    order(lower, square) <= 0 && order((0..3).fold(lower, |x, _| x.next_up()), square) >= 0
}

fn is_just_above(upper: f64, square: Option<i128>) -> bool {
    order(upper, square) >= 0 && order((0..3).fold(upper, |x, _| x.next_down()), square) <= 0
}

/// Returns the squared distances from the points that may be solid (or hollow), and from the points that
/// surely are.
fn both(dense: &Dense, exterior: Tag, point: [i128; 3], hollow: bool) -> [Option<i128>; 2] {
    let sure = if hollow { Tag::Empty } else { Tag::Full };
    [&[sure, Tag::Partial][..], &[sure]].map(|tags| least(dense, exterior, point, tags))
}

fn assert_distance(found: Interval, dense: &Dense, exterior: Tag, point: [i128; 3], to: DistanceTo) {
    let solid = both(dense, exterior, point, false);
    let hollow = both(dense, exterior, point, true);
    let told = format!("{point:?} {to:?} {found:?} {solid:?} {hollow:?}");
    let good = match to {
        DistanceTo::Solid => is_just_below(found.lower, solid[0]) && is_just_above(found.upper, solid[1]),
        DistanceTo::Complement => {
            is_just_below(found.lower, hollow[0]) && is_just_above(found.upper, hollow[1])
        }
        DistanceTo::Boundary if solid[0] != Some(0) => {
            is_just_below(found.lower, solid[0]) && is_just_above(found.upper, solid[1])
        }
        DistanceTo::Boundary if hollow[0] != Some(0) => {
            is_just_above(-found.lower, hollow[1]) && is_just_below(-found.upper, hollow[0])
        }
        DistanceTo::Boundary => {
            is_just_above(-found.lower, hollow[1]) && is_just_above(found.upper, solid[1])
        }
    };
    assert!(good, "{told}");
}

/// Points in cells, on planes, at corners and far away.
fn random_point(random: &mut Random, depth: u8) -> [i128; 3] {
    let n = 1i128 << depth;
    let grain = [ONE, ONE / 2, ONE / 256, 1][random.below(4) as usize];
    let spread = [1, 3, 40][random.below(3) as usize];
    let reach = (spread * n * ONE / grain) as u64;
    [0; 3].map(|_| (random.below(reach + 1) as i128) * grain - (spread - 1) * n * ONE / 2)
}

fn exterior_of(seed: u64) -> Tag {
    [Tag::Empty, Tag::Partial, Tag::Full][seed as usize % 3]
}

fn leaves(dense: &Dense) -> Vec<TaggedCell> {
    fn add(node: &Classical, cell: Cell, to: &mut Vec<TaggedCell>) {
        match node {
            Classical::Leaf(tag) => to.push(TaggedCell { cell, tag: *tag }),
            Classical::Node(children) => {
                (0..8).zip(children.iter()).for_each(|(k, child)| add(child, cell.child(k), to));
            }
        }
    }
    let mut all = vec![];
    add(&dense.classical(), Cell::ROOT, &mut all);
    all
}

/// Checks the nearest cells. The cells in Morton order are sorted by distance; a stable sort keeps equal ones
/// in order.
fn assert_nearest(tree: &Octree, all: &[TaggedCell], point: [i128; 3], tags: &[Tag], count: usize) {
    let depth = tree.frame().depth();
    let found: Vec<NearCell> = tree.nearest_cells(model(point), tags, count).unwrap();
    let square_of = |cell: Cell| {
        let shift = depth - cell.level;
        square(point, cell.at.map(|a| a << shift), cell.at.map(|a| (a + 1) << shift))
    };
    let mut wanted: Vec<TaggedCell> = all.iter().copied().filter(|leaf| tags.contains(&leaf.tag)).collect();
    wanted.sort_by_key(|leaf| square_of(leaf.cell));
    wanted.truncate(count);
    assert!(found.iter().map(|near| near.found).eq(wanted.iter().copied()), "{point:?} {found:?} {wanted:?}");
    for near in &found {
        let exact = Some(square_of(near.found.cell));
        assert!(is_just_below(near.distance.lower, exact) && is_just_above(near.distance.upper, exact));
        let shift = depth - near.found.cell.level;
        for axis in 0..3 {
            let (low, high) = (near.found.cell.at[axis] << shift, (near.found.cell.at[axis] + 1) << shift);
            assert_eq!(near.point[axis], model(point)[axis].clamp(low as f64, high as f64));
        }
    }
}

proptest! {
    #![proptest_config(cases(120))]

    #[test]
    fn stored_octrees(shape in shapes(1..=5), seed in any::<u64>()) {
        let dense = shape.dense();
        let exterior = exterior_of(seed);
        let tree = dense.octree_with(exterior, &alone()).unwrap();
        let coded = compact(tree.view()).unwrap();
        let all = leaves(&dense);
        let mut random = Random(seed);
        for k in 0..12 {
            let point = random_point(&mut random, dense.depth);
            for to in TARGETS {
                let found = tree.distance(model(point), to).unwrap();
                assert_distance(found, &dense, exterior, point, to);
                assert_eq!(coded.distance(model(point), to).unwrap(), found);
            }
            let chosen: [&[Tag]; 4] =
                [&[Tag::Full], &[Tag::Empty, Tag::Partial], &[Tag::Full, Tag::Partial], &leafless_testkit::TAGS];
            for tags in chosen {
                assert_nearest(&tree, &all, point, tags, [1, 2, 7, 40, 100_000][k % 5]);
            }
            prop_assert!(tree.nearest_cells(model(point), &leafless_testkit::TAGS, 0).unwrap().is_empty());
            prop_assert!(tree.nearest_cells(model(point), &[Tag::Branch], 3).unwrap().is_empty());
        }
    }

    /// Solids that provide only cells. The intervals contain the distances of the cells.
    #[test]
    fn solids_of_cells(shape in shapes(1..=4), seed in any::<u64>()) {
        let dense = shape.dense();
        let exterior = exterior_of(seed);
        let (solid, frame) = (DenseSolid { dense: &dense, exterior }, lattice_frame(dense.depth));
        let mut random = Random(seed);
        let points: Vec<[i128; 3]> = (0..20).map(|_| random_point(&mut random, dense.depth)).collect();
        let in_model: Vec<[f64; 3]> = points.iter().map(|&point| model(point)).collect();
        let tree = dense.octree_with(exterior, &alone()).unwrap();
        for to in TARGETS {
            for max_splits in [None, Some(0), Some(1), Some(5)] {
                let control = Control { max_splits, ..alone() };
                let found = distances(&solid, &frame, &in_model, to, 0.0, &control).unwrap();
                for (&point, found) in points.iter().zip(&found) {
                    let by_cells = tree.distance(model(point), to).unwrap();
                    let told = format!("{point:?} {to:?} {found:?} {by_cells:?}");
                    assert!(found.distance.lower <= by_cells.lower && found.distance.upper >= by_cells.upper, "{told}");
                    match max_splits {
                        None => {
                            let about = |a: f64, b: f64| a == b || (a - b).abs() <= 2.0 * 3f64.sqrt() * 2.0;
                            let tight = about(found.distance.lower, by_cells.lower)
                                && about(found.distance.upper, by_cells.upper);
                            assert!(tight && found.stop_reason != StopReason::Budget, "{told}");
                        }
                        Some(most) => assert!(found.splits <= most, "{told}"),
                    }
                }
            }
        }
    }
}

#[test]
fn many_points_on_any_number_of_threads() {
    let frame = Frame::new([-1.3; 3], 2.6, 7).unwrap();
    let solid = Csg::ball([0.1, 0.0, 0.0], 0.8).unwrap();
    let tree = build(&solid, &frame, Rule::Certified, &alone()).unwrap();
    let mut random = Random(3);
    let points: Vec<[f64; 3]> = (0..3000).map(|_| [0; 3].map(|_| random.between(-3.0, 3.0))).collect();
    for to in TARGETS {
        let single: Vec<Interval> = points.iter().map(|&point| tree.distance(point, to).unwrap()).collect();
        for threads in [1, 3] {
            let mut answers = vec![Interval::exactly(7.0); points.len()];
            tree.distances(&points, to, &mut answers, &Control::threads(threads)).unwrap();
            assert_eq!(answers, single);
        }
        let ask = |threads| {
            distances(&solid, &frame, &points[..300], to, 1e-3, &Control::threads(threads)).unwrap()
        };
        assert_eq!(ask(1), ask(3));
    }
    let mut answers = [Interval::exactly(0.0); 2];
    let refused = tree.distances(&points, DistanceTo::Solid, &mut answers, &alone());
    assert!(matches!(refused, Err(Error::Argument { name: "answers", .. })));
    let flag = AtomicBool::new(true);
    let cancelled = Control { cancel: Some(&flag), ..Control::default() };
    let mut answers = vec![Interval::exactly(0.0); points.len()];
    assert!(matches!(
        tree.distances(&points, DistanceTo::Solid, &mut answers, &cancelled),
        Err(Error::Cancelled)
    ));
    let refused = distances(&solid, &frame, &points, DistanceTo::Solid, 0.0, &cancelled);
    assert!(matches!(refused, Err(Error::Cancelled)));
}

#[test]
fn points_that_are_none_and_points_far_away() {
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let solid = Csg::ball([0.0; 3], 0.5).unwrap();
    let tree = build(&solid, &frame, Rule::Certified, &alone()).unwrap();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let point = [0.0, bad, 0.0];
        for to in TARGETS {
            let lower = if to == DistanceTo::Boundary { f64::NEG_INFINITY } else { 0.0 };
            let nothing = Interval::new(lower, f64::INFINITY).unwrap();
            assert_eq!(tree.distance(point, to).unwrap(), nothing);
            let found = distances(&solid, &frame, &[point], to, 0.0, &alone()).unwrap();
            assert_eq!((found[0].distance, found[0].splits), (nothing, 0));
        }
        let refused = tree.nearest_cells(point, &[Tag::Full], 1);
        assert!(matches!(refused, Err(Error::Argument { name: "point", .. })));
    }
    for far in [1e3, 1e9, 1e20, 1e100, 1e300] {
        for to in [DistanceTo::Solid, DistanceTo::Boundary] {
            for found in [
                tree.distance([0.0, -far, 0.0], to).unwrap(),
                distances(&solid, &frame, &[[0.0, -far, 0.0]], to, 0.0, &alone()).unwrap()[0].distance,
            ] {
                assert!(found.contains(far - 0.5), "{far} {found:?}");
                assert!(far > 1e12 || found.width() < 0.3, "{far} {found:?}");
            }
        }
    }
    for tolerance in [-1.0, f64::NAN] {
        let refused = distances(&solid, &frame, &[[0.0; 3]], DistanceTo::Solid, tolerance, &alone());
        assert!(matches!(refused, Err(Error::Argument { name: "tolerance", .. })));
    }
}

/// Returns the distance of `point` from a box, negative inside.
fn from_box(point: [f64; 3], min: [f64; 3], max: [f64; 3]) -> f64 {
    let past = [0, 1, 2].map(|axis: usize| (min[axis] - point[axis]).max(point[axis] - max[axis]));
    let outside = past.iter().map(|c| c.max(0.0).powi(2)).sum::<f64>().sqrt();
    if outside > 0.0 { outside } else { past.into_iter().fold(f64::NEG_INFINITY, f64::max) }
}

fn norm(v: [f64; 3]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// Queries the distance from the boundary, and compares it with a formula up to a few roundings.
#[track_caller]
fn assert_formula<S: Solid>(
    solid: &S,
    points: &[[f64; 3]],
    tolerance: f64,
    formula: impl Fn([f64; 3]) -> f64,
) -> f64 {
    let frame = Frame::new([-4.0, -4.0, -4.0], 8.0, 20).unwrap();
    let found =
        distances(solid, &frame, points, DistanceTo::Boundary, tolerance, &Control::default()).unwrap();
    let mut splits = 0;
    for (&point, found) in points.iter().zip(&found) {
        let truth = formula(point);
        let told = format!("{point:?}: {truth} {found:?}");
        assert!(found.distance.lower <= truth + 1e-14 && truth - 1e-14 <= found.distance.upper, "{told}");
        assert!(found.distance.width() <= tolerance && found.stop_reason == StopReason::Tolerance, "{told}");
        splits += found.splits;
    }
    splits as f64 / points.len() as f64
}

#[test]
fn solids_with_slabs_to_second_order() {
    let mut random = Random(11);
    let points: Vec<[f64; 3]> = (0..200).map(|_| [0; 3].map(|_| random.between(-5.0, 5.0))).collect();
    let ball = Csg::ball([0.3, -0.2, 0.1], 1.7).unwrap();
    let about = |p: [f64; 3]| [p[0] - 0.3, p[1] + 0.2, p[2] - 0.1];
    let splits = assert_formula(&ball, &points, 1e-9, |p| norm(about(p)) - 1.7);
    assert!(splits < 400.0, "{splits}");
    let (min, max) = ([-1.1, -0.7, -2.3], [1.3, 0.9, 1.7]);
    let block = Csg::cuboid(min, max).unwrap();
    let splits = assert_formula(&block, &points, 1e-9, |p| from_box(p, min, max));
    assert!(splits < 400.0, "{splits}");
    // A shell: the ball without a smaller one.
    let shell = ball.difference(&Csg::ball([0.3, -0.2, 0.1], 1.1).unwrap()).unwrap();
    assert_formula(&shell, &points, 1e-7, |p| (norm(about(p)) - 1.7).max(1.1 - norm(about(p))));
    // The same under a rotation, by slabs of the second kind.
    let turn = Affine::new([[0.8, -0.6, 0.0, 0.2], [0.6, 0.8, 0.0, -0.1], [0.0, 0.0, 1.0, 0.3]]).unwrap();
    let turned = AnySolid::new(block).placed(&turn).unwrap();
    assert_formula(&turned, &points, 1e-7, |p| {
        let (x, y, z) = (p[0] - 0.2, p[1] + 0.1, p[2] - 0.3);
        from_box([0.8 * x + 0.6 * y, -0.6 * x + 0.8 * y, z], min, max)
    });
}

/// Cells without proofs yield no distances.
#[test]
fn what_is_not_proven_is_not_told() {
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let tree = build(&Csg::ball([0.0; 3], 0.5).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
    let point = [0.9, 0.8, 0.7];
    let by_cells = tree.distance(point, DistanceTo::Solid).unwrap();
    let ask = |proof: Proof| {
        let solid = tree.clone().with_proof(proof);
        assert_eq!(solid.distance(point, DistanceTo::Solid).unwrap(), by_cells);
        distances(&solid, &frame, &[point], DistanceTo::Solid, 0.0, &alone()).unwrap()[0].distance
    };
    assert!(ask(Proof::CERTIFIED).lower > 0.8);
    let full_only = ask(Proof::new(true, false));
    assert!(full_only.lower == 0.0 && full_only.upper < 1.1, "{full_only:?}");
    let empty_only = ask(Proof::new(false, true));
    assert!(empty_only.lower > 0.8 && empty_only.upper == f64::INFINITY, "{empty_only:?}");
}

#[test]
fn universes_of_one_tag() {
    for depth in [1, 2, 20] {
        for tag in leafless_testkit::TAGS {
            let frame = lattice_frame(depth);
            let small = Dense::uniform(1, tag);
            let tree =
                build(&DenseSolid { dense: &small, exterior: Tag::Empty }, &frame, Rule::Certified, &alone());
            let tree = tree.unwrap();
            let edge = f64::from(1u32 << depth);
            let found = tree.distance([edge + 3.0, 0.5, edge + 4.0], DistanceTo::Solid).unwrap();
            let wanted = [[f64::INFINITY; 2], [0.0; 2], [5.0, f64::INFINITY], [5.0; 2]][tag as usize];
            assert_eq!([found.lower, found.upper], wanted);
            let found = tree.distance([0.25, 0.5, 0.5], DistanceTo::Complement).unwrap();
            let wanted = [[0.0; 2], [0.0; 2], [0.0, 0.25], [0.25; 2]][tag as usize];
            assert_eq!([found.lower, found.upper], wanted);
            let near = tree.nearest_cells([0.5; 3], &[tag], 3).unwrap();
            assert_eq!(near.len(), 1);
            assert_eq!(near[0].found, TaggedCell { cell: Cell::ROOT, tag });
        }
    }
}

/// A mapped file gives the same answers as the tree in memory.
#[cfg(feature = "mmap")]
#[test]
fn mapped_files() {
    let frame = Frame::new([-1.0; 3], 2.0, 7).unwrap();
    let tree = build(&Csg::ball([0.1, 0.0, 0.2], 0.6).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ball.lfl");
    leafless::file::save(&tree, &path).unwrap();
    // SAFETY: no other process uses the file.
    #[allow(unsafe_code)]
    let mapped = unsafe { leafless::file::map(&path) }.unwrap();
    let mut random = Random(6);
    for _ in 0..200 {
        let point = [0; 3].map(|_| random.between(-2.0, 2.0));
        for to in TARGETS {
            assert_eq!(mapped.distance(point, to).unwrap(), tree.distance(point, to).unwrap());
        }
        let tags = [Tag::Full, Tag::Partial];
        assert_eq!(
            mapped.nearest_cells(point, &tags, 5).unwrap(),
            tree.nearest_cells(point, &tags, 5).unwrap()
        );
        let high = point.map(|c| c + 0.7);
        assert_eq!(mapped.volume_in_box(point, high).unwrap(), tree.volume_in_box(point, high).unwrap());
    }
    let mut fields = [vec![[0.0f32; 2]; 40 * 50 * 60], vec![[1.0f32; 2]; 40 * 50 * 60]];
    for (tree, field) in [&tree, &mapped].into_iter().zip(&mut fields) {
        tree.distance_field([10, 20, 30], [50, 70, 90], field, &alone()).unwrap();
    }
    assert_eq!(fields[0], fields[1]);
}

/// The nearest points that come with distances are as near as stated, and on the boundary to second order.
#[test]
fn nearest_points_of_balls_and_octrees() {
    let frame = Frame::new([-2.0; 3], 4.0, 20).unwrap();
    let ball = Csg::ball([0.0; 3], 1.0).unwrap();
    let stored = leafless::build_extended(
        &ball,
        &frame.with_depth(8).unwrap(),
        &leafless::SurfaceOptions::default(),
        &alone(),
    )
    .unwrap();
    let mut random = Random(3);
    let points: Vec<[f64; 3]> =
        (0..50).map(|_| [0; 3].map(|_| random.between(-1.9, 1.9))).filter(|p| length(*p) > 0.3).collect();
    for solid in [AnySolid::new(ball), AnySolid::new(stored)] {
        let found = distances(&solid, &frame, &points, DistanceTo::Boundary, 1e-9, &alone()).unwrap();
        for (point, found) in points.iter().zip(&found) {
            let near = found.nearest.unwrap().point;
            let apart = length([0, 1, 2].map(|k| near[k] - point[k]));
            let truth = (length(*point) - 1.0).abs();
            assert!((apart - truth).abs() < 2e-9 && (length(near) - 1.0).abs() < 2e-9, "{point:?} {found:?}");
        }
        // A point inside has distance 0 from the solid, and the query does not examine the boundary.
        let inside = distances(&solid, &frame, &[[0.1; 3]], DistanceTo::Solid, 1e-9, &alone()).unwrap();
        assert!(inside[0].distance.lower == 0.0 && inside[0].distance.upper <= 1e-9, "{inside:?}");
        assert_eq!(inside[0].nearest, None);
    }
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}
