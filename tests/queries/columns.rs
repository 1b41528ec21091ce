//! Columns of cells and height maps, against dense arrays.

use leafless::query::{ColumnRuns, Columns, Heights, Run, Side, columns, heights};
use leafless::{
    Control, Csg, Error, FillRule, Frame, Interval, MeshSolid, Octree, OctreeRef, Proof, Rule, Tag, build,
    exchange, file,
};
use leafless_testkit::{Aligned, Dense, DenseSolid, Random, Shape, alone, cases, lattice_frame, shapes};
use proptest::prelude::*;
use std::sync::atomic::AtomicBool;

/// The tags of a column, from the lowest cell to the highest.
fn tags(dense: &Dense, axis: usize, [u, v]: [u32; 2]) -> Vec<Tag> {
    let at = |a| match axis {
        0 => [a, u, v],
        1 => [u, a, v],
        _ => [u, v, a],
    };
    (0..1 << dense.depth).map(|a| dense.at(at(a))).collect()
}

fn runs_of(tags: &[Tag], wanted: &[Tag]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (start, tag) in (0..).zip(tags) {
        if !wanted.contains(tag) {
            continue;
        }
        match runs.last_mut() {
            Some(run) if run.start + run.length == start => run.length += 1,
            _ => runs.push(Run { start, length: 1 }),
        }
    }
    runs
}

const FULL: &[Tag] = &[Tag::Full];
const UPPER: &[Tag] = &[Tag::Full, Tag::Partial];

fn places(columns: &Columns) -> impl Iterator<Item = [u32; 2]> + '_ {
    let ([u, v], [width, height]) = (columns.first(), columns.size());
    (v..v + height).flat_map(move |v| (u..u + width).map(move |u| [u, v]))
}

fn assert_runs(dense: &Dense, columns: &Columns, wanted: &[Tag], found: &ColumnRuns) {
    let count = columns.count() as usize;
    assert_eq!((found.offsets().len(), found.offsets()[0]), (count + 1, 0));
    assert_eq!(found.offsets()[count], found.runs().len() as u64);
    for (index, at) in places(columns).enumerate() {
        assert_eq!(columns.index(at), Some(index));
        let runs = runs_of(&tags(dense, columns.axis(), at), wanted);
        assert_eq!(found.column(index), runs, "{dense:?} {columns:?} {at:?}");
        assert_eq!(found.offsets()[index + 1] - found.offsets()[index], runs.len() as u64);
    }
    assert!(found.column(count).is_empty() && found.column(usize::MAX).is_empty());
}

fn assert_heights(dense: &Dense, columns: &Columns, found: &Heights) {
    assert_eq!(found.columns(), columns);
    for (index, at) in places(columns).enumerate() {
        let tags = tags(dense, columns.axis(), at);
        let end = |wanted: &[Tag]| {
            let runs = runs_of(&tags, wanted);
            match found.side() {
                Side::Above => runs.last().map(|run| run.start + run.length),
                Side::Below => runs.first().map(|run| run.start),
            }
        };
        let (full, upper) = (end(FULL), end(UPPER));
        assert_eq!(
            (found.full_plane(index), found.upper_plane(index)),
            (full, upper),
            "{dense:?} {columns:?} {at:?}"
        );
        // Cells have edge 1, and planes are whole numbers.
        let height = upper.map(|upper| match found.side() {
            Side::Above => Interval::new(full.map_or(f64::NEG_INFINITY, f64::from), upper.into()).unwrap(),
            Side::Below => Interval::new(upper.into(), full.map_or(f64::INFINITY, f64::from)).unwrap(),
        });
        assert_eq!(found.height(index), height);
    }
    let beyond = columns.count() as usize;
    assert!(found.height(beyond).is_none() && found.full_plane(beyond).is_none());
}

fn every_way_to_ask(tree: &OctreeRef<'_>, dense: &Dense, columns: &Columns) {
    let cells = tree.columns(columns).unwrap();
    assert_runs(dense, columns, FULL, &cells.full);
    assert_runs(dense, columns, UPPER, &cells.upper);
    for side in [Side::Above, Side::Below] {
        assert_heights(dense, columns, &tree.heights(columns, side).unwrap());
    }
}

/// Returns several rectangles: all columns, and random ones.
fn rectangles(dense: &Dense, axis: usize, seed: u64) -> Vec<Columns> {
    let frame = lattice_frame(dense.depth);
    let n = frame.cells() as u64 + 1;
    let mut rectangles = vec![Columns::all(&frame, axis).unwrap()];
    let mut random = Random(seed);
    for _ in 0..3 {
        let ends = [0; 2].map(|_| [0; 2].map(|_| random.below(n) as u32));
        let [first, end] = [ends.map(|[a, b]| a.min(b)), ends.map(|[a, b]| a.max(b))];
        rectangles.push(Columns::within(axis, first, end).unwrap());
    }
    rectangles
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn columns_agree_with_dense_arrays(shape in shapes(1..=5), seed: u64) {
        let dense = Shape::dense(&shape);
        let tree = dense.octree();
        let bytes = Aligned::new(&file::to_bytes(&tree).unwrap());
        let frame = lattice_frame(dense.depth);
        for axis in 0..3 {
            for columns in rectangles(&dense, axis, seed) {
                every_way_to_ask(tree.view(), &dense, &columns);
                every_way_to_ask(&file::view(bytes.bytes()).unwrap(), &dense, &columns);
                // By splits of cells: of the array, and of the tree.
                let solid = DenseSolid { dense: &dense, exterior: Tag::Empty };
                let wanted = tree.columns(&columns).unwrap();
                prop_assert_eq!(&leafless::query::columns(&solid, &frame, &columns, &alone()).unwrap(), &wanted);
                prop_assert_eq!(&leafless::query::columns(&tree, &frame, &columns, &Control::threads(3)).unwrap(), &wanted);
                for side in [Side::Above, Side::Below] {
                    let wanted = tree.heights(&columns, side).unwrap();
                    prop_assert_eq!(&heights(&solid, &frame, &columns, side, &alone()).unwrap(), &wanted);
                    prop_assert_eq!(&heights(&tree, &frame, &columns, side, &Control::threads(3)).unwrap(), &wanted);
                }
            }
        }
    }
}

/// Checks that a solid's columns equal those of the octree built from the solid.
fn assert_built(solid: &impl leafless::Solid, frame: &Frame, within: &[[[u32; 2]; 2]]) -> Octree {
    let tree = build(solid, frame, Rule::Certified, &Control::default()).unwrap();
    for axis in 0..3 {
        for &[first, end] in within {
            let rectangle = Columns::within(axis, first, end).unwrap();
            let wanted = tree.columns(&rectangle).unwrap();
            for threads in [1, 3] {
                let control = Control::threads(threads);
                assert!(columns(solid, frame, &rectangle, &control).unwrap() == wanted);
                for side in [Side::Above, Side::Below] {
                    let wanted = tree.heights(&rectangle, side).unwrap();
                    assert!(heights(solid, frame, &rectangle, side, &control).unwrap() == wanted);
                }
            }
        }
    }
    tree
}

#[test]
fn solids_have_the_columns_of_their_octrees() {
    let ball = Csg::ball([0.1, -0.2, 0.3], 1.3).unwrap();
    let holed = ball.difference(&Csg::ball([0.4, 0.0, 0.5], 0.6).unwrap()).unwrap();
    for depth in [1, 6, 7] {
        let frame = Frame::new([-2.0; 3], 4.0, depth).unwrap();
        let n = frame.cells();
        let tree =
            assert_built(&holed, &frame, &[[[0; 2], [n; 2]], [[n / 3, 0], [n / 3 + 1, n]], [[n / 2; 2]; 2]]);
        if depth == 7 {
            let cells = tree.columns(&Columns::all(&frame, 0).unwrap()).unwrap();
            assert!((0..(n * n) as usize).any(|index| cells.full.column(index).len() == 2));
        }
    }
}

#[test]
fn meshes_have_the_columns_of_their_octrees() {
    let Some(path) = leafless_testkit::model("featuretype.STL") else { return };
    let mesh = exchange::read_stl(&std::fs::read(path).unwrap()).unwrap();
    let (min, max) = mesh.bounds();
    let frame = Frame::fitted(min, max, 7).unwrap();
    let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
    assert_built(&solid, &frame, &[[[0; 2], [128; 2]], [[17, 40], [91, 77]]]);
}

/// The height of a ball on a fine lattice lies in the intervals of its columns, hence also on the line
/// through the cells' centres.
#[test]
fn the_true_height_lies_in_the_interval() {
    let frame = Frame::new([-1.0; 3], 2.0, 20).unwrap();
    let (centre, radius) = ([0.1, -0.05, 0.03], 0.77);
    let ball = Csg::ball(centre, radius).unwrap();
    let cell = 2.0 / f64::from(frame.cells());
    let mut met = 0;
    for corner in [[524_288, 524_288], [300_000, 400_000], [180_000, 480_000], [0, 0], [1_048_572, 9]] {
        let rectangle = Columns::within(2, corner, corner.map(|a| a + 4)).unwrap();
        let above = heights(&ball, &frame, &rectangle, Side::Above, &alone()).unwrap();
        let below = heights(&ball, &frame, &rectangle, Side::Below, &alone()).unwrap();
        for at in places(&rectangle) {
            let index = rectangle.index(at).unwrap();
            let [x, y] = at.map(|a| -1.0 + (f64::from(a) + 0.5) * cell);
            let half = radius * radius - (x - centre[0]).powi(2) - (y - centre[1]).powi(2);
            let (Some(top), Some(bottom)) = (above.height(index), below.height(index)) else {
                assert!(half < 0.0 && above.height(index).is_none() && below.height(index).is_none());
                continue;
            };
            let half = half.sqrt();
            assert!(top.lower <= centre[2] + half + 1e-15 && centre[2] + half - 1e-15 <= top.upper);
            assert!(bottom.lower <= centre[2] - half + 1e-15 && centre[2] - half - 1e-15 <= bottom.upper);
            assert!(top.width() < 20.0 * cell && bottom.width() < 20.0 * cell, "{top:?} {bottom:?}");
            met += 1;
        }
    }
    assert_eq!(met, 48);
}

#[test]
fn the_deepest_tree_and_a_uniform_one() {
    let frame = Frame::new([0.0; 3], 1_048_576.0, 20).unwrap();
    let block = Csg::cuboid([4.0, 8.0, 1000.0], [7.0, 16.0, 1_048_576.0]).unwrap();
    let tree = build(&block, &frame, Rule::Certified, &alone()).unwrap();
    let rectangle = Columns::within(2, [3, 14], [8, 18]).unwrap();
    let found = tree.columns(&rectangle).unwrap();
    assert_eq!(found.full, found.upper);
    for at @ [x, y] in places(&rectangle) {
        let inside = (4..7).contains(&x) && (8..16).contains(&y);
        let wanted = Run { start: 1000, length: 1_047_576 };
        let wanted = if inside { vec![wanted] } else { vec![] };
        assert_eq!(found.full.column(rectangle.index(at).unwrap()), wanted);
    }
    for tag in [Tag::Empty, Tag::Partial, Tag::Full] {
        let dense = Dense::uniform(3, tag);
        every_way_to_ask(dense.octree().view(), &dense, &Columns::within(1, [2, 3], [8, 5]).unwrap());
    }
}

/// A query of a sampled tree's cells returns the cells. They prove nothing about the solid.
#[test]
fn what_is_proven() {
    let frame = Frame::new([-2.0; 3], 4.0, 5).unwrap();
    let ball = Csg::ball([0.0; 3], 1.0).unwrap();
    let rectangle = Columns::all(&frame, 1).unwrap();
    let index = rectangle.index([16, 16]).unwrap();
    let whole = Run { start: 0, length: 32 };
    for (rule, full, upper) in
        [(Rule::Sampled, 0, whole), (Rule::Inner, 1, whole), (Rule::Outer, 0, Run { start: 8, length: 16 })]
    {
        let tree = build(&ball, &frame, rule, &alone()).unwrap();
        let cells = tree.columns(&rectangle).unwrap();
        assert!(cells.full == cells.upper && cells.full.column(index).len() == 1);
        let proven = columns(&tree, &frame, &rectangle, &alone()).unwrap();
        assert_eq!(
            (proven.full.column(index).len(), proven.upper.column(index)),
            (full, &[upper][..]),
            "{rule:?}"
        );
        let believed = tree.view().with_proof(Proof::CERTIFIED);
        assert_eq!(columns(&believed, &frame, &rectangle, &alone()).unwrap(), cells);
    }
}

#[test]
fn what_is_refused() {
    let frame = Frame::new([-2.0; 3], 4.0, 5).unwrap();
    let ball = Csg::ball([0.0; 3], 1.0).unwrap();
    let tree = build(&ball, &frame, Rule::Certified, &alone()).unwrap();
    assert!(matches!(Columns::all(&frame, 3), Err(Error::Argument { name: "axis", .. })));
    assert!(matches!(Columns::within(0, [3, 0], [2, 9]), Err(Error::Argument { name: "end", .. })));
    for end in [[33, 1], [0, 33], [u32::MAX; 2]] {
        let beyond = Columns::within(2, [0; 2], end).unwrap();
        assert_eq!(beyond.index([u32::MAX; 2]), None);
        assert!(matches!(tree.columns(&beyond), Err(Error::Argument { name: "columns", .. })));
        assert!(matches!(tree.heights(&beyond, Side::Above), Err(Error::Argument { name: "columns", .. })));
        assert!(matches!(
            columns(&ball, &frame, &beyond, &alone()),
            Err(Error::Argument { name: "columns", .. })
        ));
        assert!(heights(&ball, &frame, &beyond, Side::Below, &alone()).is_err());
    }
    let all = Columns::all(&frame, 2).unwrap();
    let cancelled = AtomicBool::new(true);
    let control = Control { cancel: Some(&cancelled), ..alone() };
    assert!(matches!(columns(&ball, &frame, &all, &control), Err(Error::Cancelled)));
    let control = Control { max_bytes: Some(1000), ..alone() };
    assert!(matches!(
        heights(&ball, &frame, &all, Side::Above, &control),
        Err(Error::Limit { what: "bytes", .. })
    ));
    // The result for 2^40 columns fits into no memory.
    let fine = frame.with_depth(20).unwrap();
    let all = Columns::all(&fine, 2).unwrap();
    let control = Control { max_bytes: Some(1 << 30), ..alone() };
    assert!(matches!(columns(&ball, &fine, &all, &control), Err(Error::Limit { .. })));
}

/// Files with arbitrary bytes below the section table. The results are ordered and within bounds.
#[test]
fn damaged_trees_are_left() {
    let frame = Frame::new([-1.0; 3], 2.0, 7).unwrap();
    let ball = Csg::ball([0.1, -0.05, 0.03], 0.77).unwrap();
    let good = file::to_bytes(&build(&ball, &frame, Rule::Certified, &alone()).unwrap()).unwrap();
    let mut random = Random(9);
    let mut viewed = 0;
    for _ in 0..60 {
        let mut bytes = good.clone();
        for _ in 0..good.len() / 20 {
            let at = 1024 + random.below(good.len() as u64 - 1024) as usize;
            bytes[at] = random.bits() as u8;
        }
        let bytes = Aligned::new(&bytes);
        let Ok(tree) = file::view(bytes.bytes()) else { continue };
        viewed += 1;
        for axis in 0..3 {
            let all = Columns::all(&frame, axis).unwrap();
            let cells = tree.columns(&all).unwrap();
            let above = tree.heights(&all, Side::Above).unwrap();
            for index in 0..all.count() as usize {
                for runs in [cells.full.column(index), cells.upper.column(index)] {
                    assert!(runs.iter().all(|run| run.length > 0 && run.start + run.length <= 128));
                    assert!(runs.windows(2).all(|pair| pair[0].start + pair[0].length < pair[1].start));
                }
                let top = cells.full.column(index).last().map(|run| run.start + run.length);
                assert_eq!(above.full_plane(index), top);
            }
        }
    }
    assert!(viewed > 30, "{viewed}");
}
