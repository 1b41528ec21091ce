//! The number of a solid's cells in regions of any shape, and the common volume, against dense arrays,
//! subdivided cells and formulas.

use leafless::query::{CellsIn, cells_in, volume_in};
use leafless::solid::{Band, Samples, Transform, VoxelGrid};
use leafless::{
    AnySolid, Control, Csg, Error, FillRule, Frame, Interval, MeshSolid, Octree, Proof, Rule, Tag,
    TriangleMesh, Volume, build, compact, complement,
};
use leafless_testkit::{Dense, DenseSolid, Random, alone, cases, lattice_frame, positions, shapes};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use std::sync::atomic::AtomicBool;

/// Allows any number of splits, one at a time.
fn one_by_one() -> Control<'static> {
    Control { max_splits: Some(u64::MAX), ..alone() }
}

/// Counts the cells in dense arrays.
fn counts(solid: &Dense, region: &Dense) -> CellsIn {
    let mut found = CellsIn::default();
    for at in positions(solid.depth) {
        let (solid, region) = (solid.at(at), region.at(at));
        if solid == Tag::Empty || region == Tag::Empty {
            continue;
        }
        found.upper_most += 1;
        found.upper_least += u64::from(region == Tag::Full);
        found.full_most += u64::from(solid == Tag::Full);
        found.full_least += u64::from(solid == Tag::Full && region == Tag::Full);
    }
    found
}

/// Returns the volume of cells of edge 1 known only by their tags.
fn plain(found: CellsIn) -> Interval {
    Interval::new(found.full_least as f64, found.upper_most as f64).unwrap()
}

fn holds(outer: CellsIn, inner: CellsIn) -> bool {
    outer.full_least <= inner.full_least
        && inner.full_most <= outer.full_most
        && outer.upper_least <= inner.upper_least
        && inner.upper_most <= outer.upper_most
}

fn encloses(outer: Interval, inner: Interval) -> bool {
    outer.lower <= inner.lower && inner.upper <= outer.upper
}

proptest! {
    #![proptest_config(cases(120))]

    #[test]
    fn cells_of_trees_in_trees(
        (a, b) in (1u8..=5).prop_flat_map(leafless_testkit::pairs_of),
        max_splits in 0u64..40,
    ) {
        let frame = lattice_frame(a.depth);
        let wanted = counts(&a, &b);
        let (tree, region) = (a.octree(), b.octree());
        let coded = compact(tree.view()).unwrap();
        let dense = |dense| DenseSolid { dense, exterior: Tag::Empty };
        for control in [alone(), one_by_one()] {
            prop_assert_eq!(tree.cells_in(&region, &control).unwrap(), wanted);
            prop_assert_eq!(coded.cells_in(&dense(&b), &control).unwrap(), wanted);
            prop_assert_eq!(cells_in(&tree, &dense(&b), &frame, &control).unwrap(), wanted);
            prop_assert_eq!(cells_in(&dense(&a), region.view(), &frame, &control).unwrap(), wanted);
            prop_assert_eq!(tree.volume_in(&region, &control).unwrap(), plain(wanted));
            prop_assert_eq!(volume_in(&dense(&a), &coded_region(&region), &frame, &control).unwrap(), plain(wanted));
        }
        // The complement's counts follow from the tree's cells.
        let rest = complement(tree.view(), &alone()).unwrap();
        let flipped = Csg::solid(AnySolid::new(tree.clone())).complement();
        let of_rest = rest.cells_in(&region, &alone()).unwrap();
        prop_assert_eq!(of_rest, counts(&a.complement(), &b));
        prop_assert_eq!(cells_in(&flipped, &region, &frame, &alone()).unwrap(), of_rest);
        // Unsplit cells are undecided.
        let control = Control { max_splits: Some(max_splits), ..alone() };
        for found in [tree.cells_in(&region, &control).unwrap(), cells_in(&a_solid(&a), &region, &frame, &control).unwrap()] {
            prop_assert!(holds(found, wanted), "{:?} {:?}", found, wanted);
        }
        prop_assert!(encloses(tree.volume_in(&region, &control).unwrap(), plain(wanted)));
    }

    #[test]
    fn boxes_of_cells(shape in shapes(1..=5), seed in any::<u64>()) {
        let tree = shape.dense().octree();
        let n = 1u64 << shape.depth;
        let mut random = Random(seed);
        for _ in 0..6 {
            let (mut min, mut max) = ([0; 3], [0; 3]);
            for axis in 0..3 {
                let first = random.below(n);
                (min[axis], max[axis]) = (first as u32, (first + 1 + random.below(n - first)) as u32);
            }
            let (full, upper) = tree.cells_in_box(min, max).unwrap();
            let region = Csg::cuboid(min.map(f64::from), max.map(f64::from)).unwrap();
            let wanted = CellsIn { full_least: full, full_most: full, upper_least: upper, upper_most: upper };
            prop_assert_eq!(tree.cells_in(&region, &alone()).unwrap(), wanted);
            prop_assert_eq!(tree.volume_in(&region, &alone()).unwrap(), plain(wanted));
        }
    }
}

fn a_solid(dense: &Dense) -> DenseSolid<'_> {
    DenseSolid { dense, exterior: Tag::Empty }
}

/// Returns a copy with a dictionary of bricks.
fn coded_region(tree: &Octree) -> Octree {
    compact(tree.view()).unwrap()
}

/// Number of subdivisions of a cell's edge.
const FINE: i64 = 16;

/// Returns the numbers of a cell's subdivided cells that lie in a ball and that meet it. Coordinates are in
/// their edges.
fn in_ball(at: [u32; 3], centre: [i64; 3], radius: i64) -> [u64; 2] {
    // Squares of the least and the greatest distance of an interval from a coordinate.
    let reach = |low: i64, high: i64, c: i64| {
        let near = (low - c).max(c - high).max(0);
        let far = (c - low).abs().max((high - c).abs());
        [near * near, far * far]
    };
    let along = |axis: usize, low: i64, edge: i64| reach(low, low + edge, centre[axis]);
    let sum = |low: [i64; 3], edge: i64| {
        let parts = [0, 1, 2].map(|axis| along(axis, low[axis], edge));
        [0, 1].map(|end| parts[0][end] + parts[1][end] + parts[2][end])
    };
    let low = at.map(|a| i64::from(a) * FINE);
    let square = radius * radius;
    match sum(low, FINE) {
        [near, _] if near >= square => return [0, 0],
        [_, far] if far <= square => return [FINE.pow(3) as u64; 2],
        _ => {}
    }
    let mut found = [0; 2];
    for k in 0..FINE.pow(3) {
        let [near, far] = sum([low[0] + k % FINE, low[1] + k / FINE % FINE, low[2] + k / FINE / FINE], 1);
        found[0] += u64::from(far <= square);
        found[1] += u64::from(near < square);
    }
    found
}

/// Balls anywhere, against integers: the cells inside, the cells that meet a ball, and the volumes.
#[test]
fn balls() {
    let mut random = Random(12);
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    for round in 0..60 {
        let depth = 1 + (round % 4) as u8;
        let strategy = leafless_testkit::shapes_of(depth);
        let dense = strategy.new_tree(&mut runner).unwrap().current().dense();
        let tree = dense.octree();
        let n = FINE << depth;
        let centre = [0; 3].map(|_| random.below(2 * n as u64) as i64 - n / 2);
        let radius = 1 + random.below(n as u64 * 3 / 4) as i64;
        let (mut inside, mut meets, mut volumes) = ([0; 2], [0; 2], [0u64; 2]);
        for at in positions(depth) {
            let [least, most] = in_ball(at, centre, radius);
            let tags = [dense.at(at) == Tag::Full, dense.at(at) != Tag::Empty];
            for k in 0..2 {
                inside[k] += u64::from(tags[k] && least == FINE.pow(3) as u64);
                meets[k] += u64::from(tags[k] && most > 0);
            }
            volumes[0] += if tags[0] { least } else { 0 };
            volumes[1] += if tags[1] { most } else { 0 };
        }
        let model = |c: i64| c as f64 / FINE as f64;
        let ball = Csg::ball(centre.map(model), model(radius)).unwrap();
        // Verdicts of a ball are exact.
        let wanted = CellsIn {
            full_least: inside[0],
            full_most: meets[0],
            upper_least: inside[1],
            upper_most: meets[1],
        };
        let found = tree.cells_in(&ball, &alone()).unwrap();
        assert_eq!(found, wanted, "{round}");
        let cubes = |volume: u64| volume as f64 / FINE.pow(3) as f64;
        let volume = tree.volume_in(&ball, &alone()).unwrap();
        // The truth lies in both intervals.
        assert!(volume.lower <= cubes(volumes[1]) && cubes(volumes[0]) <= volume.upper, "{volume:?}");
        assert!(encloses(plain(found), volume), "{volume:?} {found:?}");
        if dense.is_binary() && radius > 2 * FINE {
            let margin = 0.02 * (found.full_most - found.full_least) as f64 + 1e-9;
            assert!(volume.width() <= margin, "{volume:?} {found:?}");
            let [low, high] = volumes.map(cubes);
            assert!(low <= volume.upper && volume.lower <= high);
        }
        for control in [one_by_one(), Control { threads: 3, ..alone() }] {
            assert_eq!(tree.cells_in(&ball, &control).unwrap(), found);
            assert_eq!(tree.volume_in(&ball, &control).unwrap(), volume);
        }
    }
}

/// A cap of a ball in a slab with known volume. The interval narrows.
#[test]
fn caps_of_balls() {
    let cap = |height: f64, radius: f64| std::f64::consts::PI * height * height * (radius - height / 3.0);
    let mut widths = vec![];
    for depth in [4, 5, 6, 7, 8] {
        let frame = Frame::new([-1.0; 3], 2.0, depth).unwrap();
        let slab = Csg::cuboid([-1.0, -1.0, 0.25], [1.0, 1.0, 1.0]).unwrap();
        let tree = build(&slab, &frame, Rule::Certified, &alone()).unwrap();
        let ball = Csg::ball([0.1, -0.05, 0.0], 0.7).unwrap();
        for found in [tree.volume_in(&ball, &alone()), volume_in(&slab, &ball, &frame, &alone())] {
            let found = found.unwrap();
            assert!(found.contains(cap(0.45, 0.7)), "{found:?}");
            widths.push(found.width());
        }
    }
    assert!(widths[8] < widths[0] / 200.0 && widths[8] < 1e-5, "{widths:?}");
}

/// Meshes, volumes, moved solids and other combinations as regions.
#[test]
fn regions_of_every_kind() {
    let frame = lattice_frame(5);
    let solid = Csg::ball([16.0; 3], 12.3).unwrap();
    let tree = build(&solid, &frame, Rule::Certified, &alone()).unwrap();
    let corner = |k: u32| [k & 1, k >> 1 & 1, k >> 2 & 1].map(|bit| if bit == 0 { 5.5 } else { 20.25 });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let facets = faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).map(|f| f.map(corner));
    let mesh = TriangleMesh::from_facets(facets.collect::<Vec<_>>()).unwrap();
    let mesh = MeshSolid::new(std::sync::Arc::new(mesh), FillRule::NonZero).unwrap();
    let cuboid = Csg::cuboid([5.5; 3], [20.25; 3]).unwrap();
    let grid = VoxelGrid::new([8; 3], [4.0; 3], [2.5; 3]).unwrap();
    let samples: Vec<u8> = (0..512)
        .map(|i| if leafless_testkit::noise(3, [i, 0, 0]).is_multiple_of(3) { 3 } else { 200 })
        .collect();
    let voxels =
        Volume::new(Samples::from(&samples[..]), &grid, Band::at_least(100.0).unwrap(), &alone()).unwrap();
    let turn = leafless::Affine::new([[0.6, -0.8, 0.0, 16.0], [0.8, 0.6, 0.0, -4.0], [0.0, 0.0, 1.0, 0.25]]);
    let moved = Transform::new(&tree, &frame, &turn.unwrap());
    let of_mesh = tree.volume_in(&mesh, &alone()).unwrap();
    let of_box = tree.volume_in(&cuboid, &alone()).unwrap();
    let by_box = tree.volume_in_box([5.5; 3], [20.25; 3]).unwrap();
    let is_near = |found: Interval, margin: f64| {
        assert!(encloses(found, by_box), "{found:?} {by_box:?}");
        assert!(by_box.lower - found.lower < margin && found.upper - by_box.upper < margin, "{found:?}");
    };
    is_near(of_box, 1e-6);
    // For a mesh, little is known in the 180 cells where faces meet.
    is_near(of_mesh, 270.0);
    assert_eq!(tree.cells_in(&mesh, &alone()).unwrap(), tree.cells_in(&cuboid, &alone()).unwrap());
    // Any region equals the octree of its verdicts.
    macro_rules! same {
        ($region:expr) => {{
            let built = build($region, &frame, Rule::Certified, &alone()).unwrap();
            let found = tree.cells_in($region, &alone()).unwrap();
            assert_eq!(found, tree.cells_in(&built, &alone()).unwrap());
            assert_eq!(found, tree.cells_in($region, &one_by_one()).unwrap());
            let volume = tree.volume_in($region, &alone()).unwrap();
            assert!(encloses(plain(found), volume) && volume.lower > 0.0);
            assert!(encloses(volume, volume_in(&solid, $region, &frame, &alone()).unwrap()));
        }};
    }
    same!(&mesh);
    same!(&voxels);
    same!(&moved);
    same!(&cuboid.difference(&Csg::ball([12.0; 3], 4.0).unwrap()).unwrap());
    same!(&AnySolid::new(cuboid.clone()));
}

#[test]
fn laws() {
    let frame = Frame::new([-2.0; 3], 4.0, 6).unwrap();
    let solid = Csg::ball([0.2, 0.1, 0.0], 1.7).unwrap();
    let tree = build(&solid, &frame, Rule::Certified, &alone()).unwrap();
    let (full, upper) = tree.statistics().volume_cells();
    // The whole universe.
    for around in [Csg::cuboid([-2.0; 3], [2.0; 3]).unwrap(), Csg::ball([0.0; 3], 9.0).unwrap()] {
        let all = CellsIn { full_least: full, full_most: full, upper_least: upper, upper_most: upper };
        assert_eq!(tree.cells_in(&around, &alone()).unwrap(), all);
        let (found, volume) = (tree.volume_in(&around, &alone()).unwrap(), tree.statistics().volume());
        assert!((found.lower - volume.lower).abs() < 1e-12 && (found.upper - volume.upper).abs() < 1e-12);
    }
    // Boxes that fill the universe add up to it.
    let mut random = Random(8);
    for _ in 0..6 {
        let corner = [0; 3].map(|_| random.between(-1.9, 1.9));
        let (mut lower, mut upper) = (0.0, 0.0);
        let mut cells = CellsIn::default();
        for k in 0..8 {
            let low = [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { -3.0 } else { corner[axis] });
            let high = [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { corner[axis] } else { 3.0 });
            let part = Csg::cuboid(low, high).unwrap();
            let found = tree.volume_in(&part, &alone()).unwrap();
            (lower, upper) = (lower + found.lower, upper + found.upper);
            let found = tree.cells_in(&part, &alone()).unwrap();
            cells.full_least += found.full_least;
            cells.upper_most += found.upper_most;
        }
        let volume = tree.statistics().volume();
        assert!((lower - volume.lower).abs() < 1e-6 && (upper - volume.upper).abs() < 1e-6);
        let of_universe = tree.statistics().volume_cells();
        assert!(cells.full_least <= of_universe.0 && of_universe.1 <= cells.upper_most);
    }
    // A greater ball has no less in it.
    let (mut before, mut volume) = (CellsIn::default(), Interval::exactly(0.0));
    for k in 1..30 {
        let ball = Csg::ball([0.9, -0.4, 0.3], 0.1 * f64::from(k)).unwrap();
        let found = tree.cells_in(&ball, &alone()).unwrap();
        assert!(found.full_least <= found.full_most && found.upper_least <= found.upper_most);
        assert!(before.full_least <= found.full_least && before.full_most <= found.full_most);
        assert!(before.upper_least <= found.upper_least && before.upper_most <= found.upper_most);
        let more = tree.volume_in(&ball, &alone()).unwrap();
        assert!(volume.lower <= more.lower + 1e-6 && volume.upper <= more.upper + 1e-6);
        (before, volume) = (found, more);
    }
}

#[test]
fn regions_that_are_none() {
    let frame = Frame::new([0.0; 3], 8.0, 5).unwrap();
    let tree = build(&Csg::ball([4.0; 3], 3.0).unwrap(), &frame, Rule::Sampled, &alone()).unwrap();
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(Csg::ball([4.0; 3], radius), Err(Error::Argument { name: "radius", .. })));
    }
    assert!(matches!(Csg::ball([f64::NAN, 0.0, 0.0], 1.0), Err(Error::Argument { name: "centre", .. })));
    // Outside of the universe, and in a void.
    for centre in [[40.0, 4.0, 4.0], [-1.0; 3]] {
        let ball = Csg::ball(centre, 0.9).unwrap();
        assert_eq!(tree.cells_in(&ball, &alone()).unwrap(), CellsIn::default());
        assert_eq!(tree.volume_in(&ball, &alone()).unwrap(), Interval::exactly(0.0));
    }
    // Far smaller than a cell.
    let found = tree.cells_in(&Csg::ball([4.1, 4.1, 4.1], 1e-6).unwrap(), &alone()).unwrap();
    assert_eq!(found, CellsIn { full_least: 0, full_most: 1, upper_least: 0, upper_most: 1 });
    // The tree's cells count, whatever they prove. For a region and for a solid, only proven cells count.
    let ball = Csg::ball([4.0, 4.0, 6.0], 2.0).unwrap();
    let found = tree.cells_in(&ball, &alone()).unwrap();
    assert!(found.full_least > 0);
    assert_eq!(found, tree.clone().with_proof(Proof::CERTIFIED).cells_in(&ball, &alone()).unwrap());
    let unproven = cells_in(&tree, &ball, &frame, &alone()).unwrap();
    assert_eq!((unproven.full_least, unproven.full_most), (0, 0));
    assert!(unproven.upper_least >= found.upper_least);
    assert_eq!(volume_in(&tree, &ball, &frame, &alone()).unwrap().lower, 0.0);
    let all = tree.statistics().volume_cells().0;
    assert_eq!(
        tree.cells_in(&tree, &alone()).unwrap(),
        CellsIn { full_least: 0, full_most: all, upper_least: 0, upper_most: all }
    );
    // Another universe, and a cancel.
    let other = Frame::new([0.0; 3], 9.0, 5).unwrap();
    let elsewhere = build(&Csg::ball([4.0; 3], 3.0).unwrap(), &other, Rule::Sampled, &alone()).unwrap();
    assert!(matches!(tree.cells_in(&elsewhere, &alone()), Err(Error::FrameMismatch { .. })));
    let flag = AtomicBool::new(true);
    let control = Control { cancel: Some(&flag), ..alone() };
    assert!(matches!(tree.cells_in(&ball, &control), Err(Error::Cancelled)));
    assert!(matches!(volume_in(&tree, &ball, &frame, &control), Err(Error::Cancelled)));
    // One tag everywhere, and the deepest frame.
    let deep = Frame::new([0.0; 3], 8.0, 20).unwrap();
    let block = build(&Csg::cuboid([0.0; 3], [8.0; 3]).unwrap(), &deep, Rule::Certified, &alone()).unwrap();
    let most = Control { max_splits: Some(20_000), ..alone() };
    let volume = block.volume_in(&Csg::ball([4.0; 3], 2.0).unwrap(), &most).unwrap();
    assert!(volume.contains(32.0 / 3.0 * std::f64::consts::PI), "{volume:?}");
    let whole = block.cells_in(&Csg::ball([4.0; 3], 20.0).unwrap(), &alone()).unwrap();
    assert_eq!(whole.full_least, 1 << 60);
    assert_eq!(block.volume_in(&block, &alone()).unwrap(), Interval::exactly(512.0));
}

/// A mapped and unverified file.
#[cfg(feature = "mmap")]
#[test]
fn mapped() {
    let frame = Frame::new([0.0; 3], 64.0, 7).unwrap();
    let tree = build(&Csg::ball([30.0; 3], 21.5).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ball.lfl");
    leafless::file::save(&tree, &path).unwrap();
    // SAFETY: no other process uses the file.
    #[allow(unsafe_code)]
    let mapped = unsafe { leafless::file::map(&path) }.unwrap();
    let mut random = Random(3);
    for _ in 0..20 {
        let ball = Csg::ball([0; 3].map(|_| random.between(0.0, 64.0)), random.between(0.1, 30.0)).unwrap();
        assert_eq!(mapped.cells_in(&ball, &alone()).unwrap(), tree.cells_in(&ball, &alone()).unwrap());
        assert_eq!(mapped.volume_in(&ball, &alone()).unwrap(), tree.volume_in(&ball, &alone()).unwrap());
    }
}

/// Measures times of balls in a ball of 1024 cells.
#[test]
#[ignore = "prints times"]
fn times() {
    for depth in [9, 10] {
        let frame = Frame::new([-1.0; 3], 2.0, depth).unwrap();
        let tree = build(&Csg::ball([0.0; 3], 0.9).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
        for (name, centre, radius) in
            [("inside", 0.0, 0.5), ("across", 0.9, 0.5), ("around", 0.0, 0.95), ("small", 0.9, 0.05)]
        {
            let ball = Csg::ball([centre, 0.0, 0.0], radius).unwrap();
            let start = std::time::Instant::now();
            let found = tree.cells_in(&ball, &alone()).unwrap();
            let cells = start.elapsed();
            let start = std::time::Instant::now();
            let volume = tree.volume_in(&ball, &alone()).unwrap();
            let cut = found.upper_most - found.upper_least;
            println!(
                "{depth} {name}: cells {cells:?}, volume {:?} {volume:?}, {cut} cells cut",
                start.elapsed()
            );
        }
    }
}
