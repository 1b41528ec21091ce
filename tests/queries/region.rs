//! The part of a solid in a box, and the relation of regions of any shape to solids, against dense arrays.

use leafless::query::{Region, classify_box, classify_in};
use leafless::{Control, Csg, Error, Frame, Interval, Octree, Rule, Tag, build, compact, measure};
use leafless_testkit::{Dense, DenseSolid, Random, alone, cases, lattice_frame, positions, shapes};
use proptest::prelude::*;

/// Coordinates are multiples of 1 / ONE.
const ONE: u64 = 256;

/// Returns the volumes of the FULL cells and of the cells that are not EMPTY in a box, in cubes of 1 / ONE.
fn volumes(dense: &Dense, min: [i64; 3], max: [i64; 3]) -> [u64; 2] {
    let mut volumes = [0; 2];
    for at in positions(dense.depth) {
        let common = |axis: usize| {
            let (low, high) = (i64::from(at[axis]) * ONE as i64, (i64::from(at[axis]) + 1) * ONE as i64);
            (high.min(max[axis]) - low.max(min[axis])).max(0) as u64
        };
        let volume = common(0) * common(1) * common(2);
        volumes[0] += if dense.at(at) == Tag::Full { volume } else { 0 };
        volumes[1] += if dense.at(at) == Tag::Empty { 0 } else { volume };
    }
    volumes
}

fn a_box(random: &mut Random, n: i64) -> ([i64; 3], [i64; 3]) {
    let (mut min, mut max) = ([0; 3], [0; 3]);
    for axis in 0..3 {
        let grain = [1, ONE as i64 / 4, ONE as i64][random.below(3) as usize];
        let mut end =
            || (random.below(((n + 2) * ONE as i64 / grain) as u64 + 1) as i64) * grain - ONE as i64;
        let ends = [end(), end()];
        (min[axis], max[axis]) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    }
    (min, max)
}

/// Derives the relation of a region from the finest cells.
fn relation(solid: &Dense, region: &Dense, exteriors: [Tag; 2]) -> Region {
    let cells = positions(solid.depth).map(|at| (solid.at(at), region.at(at)));
    let all: Vec<(Tag, Tag)> =
        cells.chain([(exteriors[0], exteriors[1])]).filter(|pair| pair.1 != Tag::Empty).collect();
    let surely = |tag: Tag| all.contains(&(tag, Tag::Full));
    let perhaps = |tag: Tag| all.iter().any(|pair| pair.0 == tag || pair.0 == Tag::Partial);
    if surely(Tag::Full) && surely(Tag::Empty) {
        Region::Crossing
    } else if !perhaps(Tag::Full) {
        Region::Outside
    } else if !perhaps(Tag::Empty) {
        Region::Inside
    } else {
        Region::Undecided
    }
}

proptest! {
    #![proptest_config(cases(150))]

    #[test]
    fn volumes_in_boxes(shape in shapes(1..=5), seed in any::<u64>()) {
        let dense = shape.dense();
        let tree = dense.octree();
        let coded = compact(tree.view()).unwrap();
        let n = 1i64 << dense.depth;
        let mut random = Random(seed);
        for _ in 0..25 {
            let (min, max) = a_box(&mut random, n);
            let [least, most] = volumes(&dense, min, max);
            let model = |corner: [i64; 3]| corner.map(|c| c as f64 / ONE as f64);
            let found = tree.volume_in_box(model(min), model(max)).unwrap();
            // All these numbers are doubles.
            let volume = |cubes: u64| cubes as f64 / (ONE * ONE * ONE) as f64;
            prop_assert_eq!(found, Interval::new(volume(least), volume(most)).unwrap(), "{:?} {:?}", min, max);
            prop_assert_eq!(coded.volume_in_box(model(min), model(max)).unwrap(), found);
            let cells = |corner: [i64; 3]| corner.map(|c| (c / ONE as i64).clamp(0, n) as u32);
            let (first, end) = (cells(min), cells(max));
            let scaled = |corner: [u32; 3]| corner.map(|c| i64::from(c) * ONE as i64);
            let [least, most] = volumes(&dense, scaled(first), scaled(end)).map(|volume| volume / ONE.pow(3));
            prop_assert_eq!(tree.cells_in_box(first, end).unwrap(), (least, most));
        }
    }

    #[test]
    fn regions_of_cells(solid in shapes(3..=3), region in shapes(3..=3), seed in any::<u64>()) {
        let (solid, region) = (solid.dense(), region.dense());
        let frame = lattice_frame(3);
        let exteriors = [seed, seed / 3].map(|k| [Tag::Empty, Tag::Partial, Tag::Full][k as usize % 3]);
        let [a, b] = [(&solid, exteriors[0]), (&region, exteriors[1])]
            .map(|(dense, exterior)| DenseSolid { dense, exterior });
        let wanted = relation(&solid, &region, exteriors);
        prop_assert_eq!(classify_in(&a, &b, &frame, &alone()).unwrap(), wanted);
        let of_trees = [solid.octree_with(exteriors[0], &alone()), region.octree_with(exteriors[1], &alone())];
        let [a, b] = of_trees.map(Result::unwrap);
        prop_assert_eq!(classify_in(&a, b.view(), &frame, &alone()).unwrap(), wanted);
        for max_splits in [0, 1, 3, 10] {
            let control = Control { max_splits: Some(max_splits), ..alone() };
            let found = classify_in(&a, &b, &frame, &control).unwrap();
            prop_assert!(found == wanted || found == Region::Undecided);
        }
    }
}

/// Regions that are boxes and balls. They give the answers of the box queries, and those of a formula.
#[test]
fn boxes_and_balls() {
    let frame = Frame::new([-2.0; 3], 4.0, 7).unwrap();
    let solid = Csg::ball([0.0; 3], 1.0).unwrap();
    let mut random = Random(4);
    let mut told = [0; 4];
    for _ in 0..800 {
        let centre = [0; 3].map(|_| random.between(-1.3, 1.3));
        let size = random.between(0.05, 0.6);
        let (min, max) = (centre.map(|c| c - size), centre.map(|c| c + size));
        let by_box = classify_box(&solid, &frame, min, max, &alone()).unwrap();
        let region = Csg::cuboid(min, max).unwrap();
        let found = classify_in(&solid, &region, &frame, &alone()).unwrap();
        // A box of cells has an exact answer. A box solid has PARTIAL cells at its faces.
        assert!(
            found == by_box || found == Region::Undecided || by_box == Region::Undecided,
            "{found:?} {by_box:?}"
        );
        let ball = Csg::ball(centre, size).unwrap();
        let found = classify_in(&solid, &ball, &frame, &alone()).unwrap();
        let apart = centre.iter().map(|c| c * c).sum::<f64>().sqrt();
        let cell = frame.cell_size() * 3f64.sqrt();
        let truth = if apart + size <= 1.0 {
            Region::Inside
        } else if apart - size >= 1.0 {
            Region::Outside
        } else {
            Region::Crossing
        };
        let margin = (1.0 - apart - size).abs().min((apart - size - 1.0).abs());
        assert!(
            found == truth || found == Region::Undecided && margin < 4.0 * cell,
            "{found:?} {truth:?} {margin}"
        );
        told[found as usize] += 1;
    }
    assert!(told.iter().take(3).all(|&count| count > 20), "{told:?}");
}

/// The volume within another solid is the volume of the intersection.
#[test]
fn volumes_in_balls() {
    let frame = Frame::new([-2.0; 3], 4.0, 20).unwrap();
    let block = Csg::cuboid([-1.0, -1.5, -1.5], [0.0, 1.5, 1.5]).unwrap();
    let both = Csg::intersection_of([block, Csg::ball([0.0; 3], 0.75).unwrap()]).unwrap();
    let found = measure(&both, &frame, 1e-4, &Control::default()).unwrap();
    assert!(found.volume.contains(2.0 / 3.0 * std::f64::consts::PI * 0.75f64.powi(3)), "{:?}", found.volume);
}

#[test]
fn boxes_that_are_none() {
    let frame = Frame::new([0.1, -0.3, 7.0], 0.7, 9).unwrap();
    let tree: Octree =
        build(&Csg::ball([0.4, 0.1, 7.3], 0.3).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
    for (min, max) in
        [([1.0, 0.0, 0.0], [0.0; 3]), ([f64::NAN, 0.0, 0.0], [1.0; 3]), ([0.0; 3], [1.0, f64::NAN, 1.0])]
    {
        assert!(matches!(tree.volume_in_box(min, max), Err(Error::Argument { name: "max", .. })));
    }
    for (min, max) in [([1, 0, 0], [0, 1, 1]), ([0; 3], [513, 1, 1])] {
        assert!(matches!(tree.cells_in_box(min, max), Err(Error::Argument { name: "max", .. })));
    }
    let all = tree.statistics();
    assert_eq!(tree.cells_in_box([0; 3], [512; 3]).unwrap(), all.volume_cells());
    let infinite = tree.volume_in_box([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]).unwrap();
    let volume = all.volume();
    assert!((infinite.lower - volume.lower).abs() < 1e-15 && (infinite.upper - volume.upper).abs() < 1e-15);
    // Eight boxes that fill the universe, with a corner anywhere.
    let (mut lower, mut upper) = (0.0, 0.0);
    for k in 0..8 {
        let (mut min, mut max) = ([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]);
        for axis in 0..3 {
            let corner = [0.377_123, 0.091_7, 7.2222][axis];
            if k >> axis & 1 == 0 { max[axis] = corner } else { min[axis] = corner }
        }
        let part = tree.volume_in_box(min, max).unwrap();
        (lower, upper) = (lower + part.lower, upper + part.upper);
    }
    assert!(
        (lower - volume.lower).abs() < 1e-12 && (upper - volume.upper).abs() < 1e-12,
        "{lower} {upper} {volume:?}"
    );
    let point = [0.4, 0.1, 7.3];
    assert_eq!(tree.volume_in_box(point, point).unwrap(), Interval::exactly(0.0));
    assert_eq!(tree.volume_in_box([10.0; 3], [11.0; 3]).unwrap(), Interval::exactly(0.0));
}
