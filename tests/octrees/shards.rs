//! Shards of an octree. Joined, they are the whole, byte for byte; alone, each makes only true claims about
//! the whole.

use leafless::op::{build_extended_shard, join, shard};
use leafless::query::{MassSum, Obstacle, measure_in};
use leafless::solid::ShardedOctree;
use leafless::surface::{Resolve, marching_cubes_in};
use leafless::{
    Affine, AnySolid, Callback, Cell, Control, Csg, Error, FillRule, Frame, Membership, MeshSolid, Octree,
    Ray, Rule, Shard, Solid, SurfaceOptions, Tag, TriangleMesh, Verdict, build, build_extended, build_shard,
    cast_rays, contains, marching_cubes, measure, union,
};
use leafless_testkit::{Random, alone, repeated, shapes};
use proptest::prelude::*;

/// A way to make a tree of a solid.
#[derive(Debug, Clone, Copy)]
enum Way {
    Plain(Rule),
    Extended(SurfaceOptions),
}

impl Way {
    fn whole<S: Solid>(self, solid: &S, frame: &Frame) -> Octree {
        match self {
            Way::Plain(rule) => build(solid, frame, rule, &alone()),
            Way::Extended(options) => build_extended(solid, frame, &options, &alone()),
        }
        .unwrap()
    }

    fn shard<S: Solid>(self, solid: &S, frame: &Frame, shard: Shard) -> Octree {
        match self {
            Way::Plain(rule) => build_shard(solid, frame, rule, shard, &alone()),
            Way::Extended(options) => build_extended_shard(solid, frame, &options, shard, &alone()),
        }
        .unwrap()
    }
}

fn joined(trees: &[Octree]) -> Octree {
    let views: Vec<_> = trees.iter().map(|tree| *tree.view()).collect();
    let joined = join(&views, &Control::default()).unwrap();
    joined.view().check().unwrap();
    joined
}

fn bytes(tree: &Octree) -> Vec<u8> {
    leafless::file::to_bytes(tree).unwrap()
}

/// Builds a solid in shards, and cuts the whole into shards.
fn check<S: Solid>(solid: &S, frame: &Frame, way: Way, level: u8) {
    let whole = way.whole(solid, frame);
    let expected = bytes(&whole);
    let mut built = vec![way.shard(solid, frame, Shard::Top { level })];
    assert_eq!(built[0].statistics().levels()[usize::from(level)].nodes, 0, "{way:?}, level {level}");
    for cell in built[0].view().open_cells(level).unwrap() {
        built.push(way.shard(solid, frame, Shard::Below(cell)));
    }
    assert!(bytes(&joined(&built)) == expected, "built, {way:?}, level {level} of {}", frame.depth());
    check_sums(&whole, settled(&built, level));
    // In any order, and with shards that overlap.
    built.reverse();
    built.push(whole.clone());
    assert!(bytes(&joined(&built)) == expected, "{way:?}");

    let mut cut = vec![shard(whole.view(), Shard::Top { level }, &alone()).unwrap()];
    for cell in cut[0].view().open_cells(level).unwrap() {
        let one = shard(whole.view(), Shard::Below(cell), &alone()).unwrap();
        one.view().check().unwrap();
        // The same trees as the built ones, where the cell is split at all.
        if one.statistics().levels()[usize::from(cell.level)].nodes > 0 {
            let built = way.shard(solid, frame, Shard::Below(cell));
            assert!(bytes(&built) == bytes(&one), "{way:?}, {cell:?}");
        }
        cut.push(one);
    }
    assert!(bytes(&joined(&cut)) == expected, "cut, {way:?}, level {level} of {}", frame.depth());
}

/// Joins the top with all shards whose cells are not split. Returns it and the other shards with their cells.
fn settled(built: &[Octree], level: u8) -> (Octree, Vec<(Cell, Octree)>) {
    let (mut top, mut shards) = (vec![built[0].clone()], Vec::new());
    let cells = built[0].view().open_cells(level).unwrap();
    for (cell, shard) in cells.into_iter().zip(&built[1..]) {
        let nodes = shard.statistics().levels()[usize::from(level)].nodes;
        if nodes == 1 { shards.push((cell, shard.clone())) } else { top.push(shard.clone()) }
    }
    (joined(&top), shards)
}

/// Checks that the statistics and measures of a top and its shards are those of the whole.
fn check_sums(whole: &Octree, (top, shards): (Octree, Vec<(Cell, Octree)>)) {
    let mut all = vec![top.clone()];
    all.extend(shards.iter().map(|(_, shard)| shard.clone()));
    assert!(bytes(&joined(&all)) == bytes(whole));
    let list: Vec<_> = shards.iter().map(|(cell, shard)| (*cell, shard.statistics())).collect();
    assert_eq!(top.statistics_with(&list).unwrap(), whole.statistics());
    let frame = *whole.frame();
    check_solid(whole, &ShardedOctree::new(top.clone(), shards.iter().rev().cloned()).unwrap());
    if whole.view().cuts().is_some() {
        return;
    }
    let mut sum = measure_in(&top, &frame, Cell::ROOT, 0.0, &alone()).unwrap();
    for (cell, shard) in shards.iter().rev() {
        sum = sum.minus(&MassSum::unknown(&frame, *cell).unwrap()).unwrap();
        sum = sum.plus(&measure_in(shard, &frame, *cell, 0.0, &alone()).unwrap()).unwrap();
        assert_eq!(MassSum::from_bytes(&sum.to_bytes()).unwrap(), sum);
    }
    let expected = measure(whole, &frame, 0.0, &alone()).unwrap();
    let found = sum.properties().unwrap();
    assert_eq!((found.volume, found.centroid), (expected.volume, expected.centroid));
    assert_eq!(found.inertia_about_origin, expected.inertia_about_origin);
    assert_eq!(found.inertia_about_centroid, expected.inertia_about_centroid);
    assert_eq!((found.clipped, found.proof), (expected.clipped, expected.proof));
}

/// Checks that the shards, as a solid, are the whole.
fn check_solid(whole: &Octree, sharded: &ShardedOctree) {
    let frame = *whole.frame();
    for frame in [frame, frame.with_depth(1).unwrap(), frame.with_depth((frame.depth() + 1).min(20)).unwrap()]
    {
        let [expected, found] = [
            build(whole, &frame, Rule::Certified, &alone()).unwrap(),
            build(sharded, &frame, Rule::Certified, &Control { threads: 2, ..alone() }).unwrap(),
        ];
        assert!(bytes(&found) == bytes(&expected));
    }
    let mut random = Random(7);
    let points: Vec<[f64; 3]> = (0..100).map(|_| [0; 3].map(|_| random.between(-0.1, 1.1))).collect();
    let [mut expected, mut found] = [vec![Membership::Undecided; 100], vec![Membership::Undecided; 100]];
    contains(whole, &frame, &points, &mut expected, &alone()).unwrap();
    contains(sharded, &frame, &points, &mut found, &alone()).unwrap();
    assert_eq!(found, expected);
    let rays: Vec<Ray> = points
        .iter()
        .map(|&point| Ray::new(point, [0; 3].map(|_| random.between(-1.0, 1.0))).unwrap())
        .collect();
    let [expected, found] = [
        cast_rays(whole, &frame, &rays, Obstacle::Upper, &alone()).unwrap(),
        cast_rays(sharded, &frame, &rays, Obstacle::Upper, &alone()).unwrap(),
    ];
    assert_eq!(found, expected);
    let [expected, found] = [
        measure(&whole.without_moments(), &frame, 0.01, &alone()).unwrap(),
        measure(sharded, &frame, 0.01, &alone()).unwrap(),
    ];
    if whole.view().cuts().is_none() {
        assert_eq!((found.volume, found.centroid), (expected.volume, expected.centroid));
    }
    assert!(found.volume.common(expected.volume).is_some());
    assert_eq!(sharded.frame(), whole.frame());
    assert_eq!(
        sharded.shards().len(),
        sharded.shards().filter(|(_, shard)| shard.frame() == whole.frame()).count()
    );
}

fn part() -> Csg {
    let block = Csg::cuboid([0.1, 0.15, 0.2], [0.9, 0.7, 0.85]).unwrap();
    let bore = Csg::ball([0.6, 0.5, 0.5], 0.26).unwrap();
    Csg::union_of([block.difference(&bore).unwrap(), Csg::ball([0.2, 0.8, 0.3], 0.11).unwrap()]).unwrap()
}

fn octahedron() -> TriangleMesh {
    let at = |axis: usize, sign: f64| {
        let mut vertex = [0.52, 0.49, 0.47];
        vertex[axis] += sign * 0.37;
        vertex
    };
    let vertices = (0..3).flat_map(|axis| [at(axis, -1.0), at(axis, 1.0)]).collect();
    let mut triangles = Vec::new();
    for o in 0..8u32 {
        let [x, y, z] = [o & 1, 2 + (o >> 1 & 1), 4 + (o >> 2 & 1)];
        triangles.push(if o.count_ones() % 2 == 1 { [x, y, z] } else { [x, z, y] });
    }
    TriangleMesh::new(vertices, triangles).unwrap()
}

fn unit(depth: u8) -> Frame {
    Frame::new([0.0; 3], 1.0, depth).unwrap()
}

const RULES: [Rule; 4] = [Rule::Certified, Rule::Inner, Rule::Outer, Rule::Sampled];

#[test]
fn built_in_shards() {
    let mesh = MeshSolid::new(octahedron(), FillRule::NonZero).unwrap();
    for depth in 1..=repeated(6, 8) {
        let frame = unit(depth);
        for level in 0..=depth.min(repeated(3, 4)) {
            for rule in RULES {
                check(&part(), &frame, Way::Plain(rule), level);
                check(&mesh, &frame, Way::Plain(rule), level);
            }
            for tolerance in [None, Some(0.2), Some(0.02)] {
                let way = Way::Extended(SurfaceOptions { tolerance });
                check(&part(), &frame, way, level);
                check(&mesh, &frame, way, level);
            }
        }
    }
}

/// A ball of a host program, which is queried for many boxes at once.
fn host() -> impl Solid {
    Callback::new(|min: [f64; 3], max: [f64; 3]| {
        let (mut near, mut far) = (0.0, 0.0);
        for axis in 0..3 {
            let (low, high) = (min[axis] - 0.47, max[axis] - 0.47);
            near += low.max(-high).max(0.0).powi(2);
            far += low.abs().max(high.abs()).powi(2);
        }
        if far < 0.1 {
            Ok(Verdict::Full)
        } else if near > 0.1 {
            Ok(Verdict::Empty)
        } else {
            Ok(Verdict::Partial(()))
        }
    })
}

#[test]
fn solids_of_every_kind() {
    let stored = build(&part(), &unit(4), Rule::Certified, &alone()).unwrap();
    let extended = build_extended(&part(), &unit(6), &SurfaceOptions::default(), &alone()).unwrap();
    let turned = Affine::new([[0.8, -0.6, 0.0, 0.2], [0.6, 0.8, 0.0, -0.1], [0.0, 0.0, 1.0, 0.05]]).unwrap();
    let frame = unit(6);
    for level in [0, 1, 2, repeated(2, 3)] {
        for way in [Way::Plain(Rule::Certified), Way::Extended(SurfaceOptions { tolerance: Some(0.05) })] {
            check(&stored, &frame, way, level);
            check(&extended, &frame, way, level);
            check(&host(), &frame, way, level);
            check(&AnySolid::new(stored.clone()).placed(&turned).unwrap(), &frame, way, level);
            check(&part().placed(&turned).unwrap(), &frame, way, level);
        }
        check(&host(), &frame, Way::Plain(Rule::Outer), level);
        check(&stored, &unit(4), Way::Plain(Rule::Inner), level.min(4));
    }
}

#[test]
fn large_enough_for_threads() {
    for way in [
        Way::Plain(Rule::Certified),
        Way::Plain(Rule::Inner),
        Way::Extended(SurfaceOptions { tolerance: Some(0.002) }),
    ] {
        for depth in [repeated(8, 9), 10] {
            let mesh = MeshSolid::new(octahedron(), FillRule::NonZero).unwrap();
            let (frame, level) = (unit(depth), 2);
            let whole = way.whole(&mesh, &frame);
            let many = Control { threads: 4, ..Control::default() };
            let cut = |part| shard(whole.view(), part, &many).unwrap();
            let mut trees = vec![cut(Shard::Top { level })];
            for cell in trees[0].view().open_cells(level).unwrap() {
                trees.push(cut(Shard::Below(cell)));
            }
            let views: Vec<_> = trees.iter().map(|tree| *tree.view()).collect();
            for threads in [1, 4] {
                let joined = join(&views, &Control { threads, ..Control::default() }).unwrap();
                assert!(bytes(&joined) == bytes(&whole), "{way:?}, {threads} threads");
            }
        }
    }
}

/// Returns the triangles of a mesh by the places of their corners.
fn places(meshes: &[TriangleMesh]) -> Vec<[[u64; 3]; 3]> {
    let corner = |mesh: &TriangleMesh, vertex: u32| mesh.vertices()[vertex as usize].map(f64::to_bits);
    let all = meshes.iter().flat_map(|mesh| mesh.triangles().iter().map(move |t| t.map(|v| corner(mesh, v))));
    let mut all: Vec<_> = all.collect();
    all.sort_unstable();
    all
}

#[test]
fn surfaces_cell_by_cell() {
    for depth in [2, 3, 5, 6] {
        // The surface of the second solid lies partly in walls of the universe.
        for solid in [part(), Csg::cuboid([-1.0, 0.2, 0.0], [0.7, 2.0, 0.6]).unwrap()] {
            let tree = build(&solid, &unit(depth), Rule::Certified, &alone()).unwrap();
            for resolve in [Resolve::Inner, Resolve::Outer] {
                let whole = marching_cubes(tree.view(), Some(resolve), &alone()).unwrap();
                for level in 0..=(depth - 2).min(2) {
                    let cells = (0..1 << (3 * level)).map(|code| Cell::from_morton(level, code).unwrap());
                    let part = |cell| marching_cubes_in(tree.view(), Some(resolve), cell, &alone()).unwrap();
                    let parts: Vec<_> = cells.map(part).collect();
                    assert_eq!(places(&parts), places(std::slice::from_ref(&whole)), "{depth}, {level}");
                }
            }
            for (level, at) in [(depth - 1, [0; 3]), (1, [2, 0, 0]), (u8::MAX, [0; 3])] {
                let refused =
                    marching_cubes_in(tree.view(), Some(Resolve::Inner), Cell { level, at }, &alone());
                assert!(matches!(refused, Err(Error::Argument { name: "cell", .. })), "{level}");
            }
        }
    }
}

proptest! {
    #![proptest_config(leafless_testkit::cases(60))]

    #[test]
    fn any_tree(shape in shapes(1..=6), seed in any::<u64>()) {
        let whole = shape.dense().octree();
        let mut random = Random(seed | 1);
        let depth = whole.frame().depth();
        let level = random.below(u64::from(depth) + 1) as u8;
        let cut = |part| shard(whole.view(), part, &alone()).unwrap();
        let mut trees = vec![cut(Shard::Top { level })];
        let cells = trees[0].view().open_cells(level).unwrap();
        trees.extend(cells.iter().map(|&cell| cut(Shard::Below(cell))));
        prop_assert!(bytes(&joined(&trees)) == bytes(&whole));
        // Without one of the shards, its cell is unknown, and nothing else changes.
        if let Some(&cell) = cells.get(random.below(cells.len().max(1) as u64) as usize) {
            let place = cells.iter().position(|&other| other == cell).unwrap();
            trees.remove(1 + place);
            let less = joined(&trees);
            let of = |tree: &Octree, at| tree.view().tag_at(at);
            for at in leafless_testkit::positions(depth) {
                let here = at.map(|a| a >> (depth - level)) == cell.at;
                let expected = if here { Tag::Partial } else { of(&whole, at) };
                prop_assert_eq!(of(&less, at), expected);
            }
            prop_assert!(less.view().open_cells(level).unwrap().contains(&cell));
        }
    }

    #[test]
    fn booleans_of_shards(pair in leafless_testkit::pairs(1..=5), seed in any::<u64>()) {
        let [a, b] = [pair.0.octree(), pair.1.octree()];
        let level = Random(seed | 1).below(u64::from(a.frame().depth()) + 1) as u8;
        let whole = union(a.view(), b.view(), &alone()).unwrap();
        let all = |level| (0..1u32 << (3 * level)).map(move |code| {
            let at = |axis: u32| (0..u32::from(level)).fold(0, |sum, bit| sum | (code >> (3 * bit + axis) & 1) << bit);
            Shard::Below(Cell { level, at: [at(0), at(1), at(2)] })
        });
        let level = level.min(2);
        let parts = all(level).map(|part| {
            let [a, b] = [&a, &b].map(|tree| shard(tree.view(), part, &alone()).unwrap());
            union(a.view(), b.view(), &alone()).unwrap()
        });
        prop_assert!(bytes(&joined(&parts.collect::<Vec<_>>())) == bytes(&whole));
    }
}

#[test]
fn what_is_refused() {
    let frame = unit(4);
    let tree = build(&part(), &frame, Rule::Certified, &alone()).unwrap();
    let other = build(&Csg::ball([0.3; 3], 0.2).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
    let views = [*tree.view(), *other.view()];
    assert!(matches!(join(&views, &alone()), Err(Error::Argument { name: "trees", .. })));
    assert!(matches!(join(&[], &alone()), Err(Error::Argument { name: "trees", .. })));
    // One tree decides a cell as a whole, and the other decides parts of the cell differently.
    let octant = build(&Csg::cuboid([0.0; 3], [0.5; 3]).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
    let parts = build(&Csg::ball([0.25; 3], 0.2).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
    let beside = build(&Csg::ball([0.75; 3], 0.2).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
    for (one, other) in [(&octant, &parts), (&parts, &octant), (&parts, &beside)] {
        let result = join(&[*one.view(), *other.view()], &alone());
        assert!(matches!(result, Err(Error::Argument { name: "trees", .. })));
    }
    let coarse = build(&part(), &unit(3), Rule::Certified, &alone()).unwrap();
    assert!(matches!(join(&[*tree.view(), *coarse.view()], &alone()), Err(Error::FrameMismatch { .. })));
    // Two rules of one solid: together they know more than each of them alone, or they contradict each other.
    let [inner, outer] =
        [Rule::Inner, Rule::Outer].map(|rule| build(&part(), &frame, rule, &alone()).unwrap());
    assert!(join(&[*inner.view(), *outer.view()], &alone()).is_err());
    assert_eq!(bytes(&joined(&[tree.clone(), inner.clone()])).len(), bytes(&inner).len());
    let outside = Uniform(Tag::Full);
    assert!(matches!(
        join(&[outside.tree(Tag::Empty), outside.tree(Tag::Full)].each_ref().map(|t| *t.view()), &alone()),
        Err(Error::Argument { name: "trees", .. })
    ));
    for wrong in [
        Shard::Top { level: 5 },
        Shard::Top { level: u8::MAX },
        Shard::Below(Cell { level: 5, at: [0; 3] }),
        Shard::Below(Cell { level: 2, at: [0, 4, 0] }),
        Shard::Below(Cell { level: 0, at: [1, 0, 0] }),
        Shard::Below(Cell { level: 40, at: [0, 4, 0] }),
    ] {
        let is_refused = |result| matches!(result, Err(Error::Argument { name: "shard", .. }));
        assert!(is_refused(shard(tree.view(), wrong, &alone())));
        assert!(is_refused(build_shard(&part(), &frame, Rule::Certified, wrong, &alone())));
        assert!(is_refused(build_extended_shard(
            &part(),
            &frame,
            &SurfaceOptions::default(),
            wrong,
            &alone()
        )));
    }
    assert!(matches!(tree.view().open_cells(5), Err(Error::Argument { name: "level", .. })));
    let other_cell = (Cell { level: 2, at: [0; 3] }, tree.clone());
    for (shards, what) in [
        (vec![(Cell::ROOT, tree.clone()), other_cell.clone()], "levels"),
        (vec![other_cell.clone(), other_cell.clone()], "twice"),
        (vec![(Cell { level: 2, at: [4, 0, 0] }, tree.clone())], "outside"),
        (vec![(Cell { level: 5, at: [0; 3] }, tree.clone())], "level"),
    ] {
        let result = ShardedOctree::new(tree.clone(), shards);
        assert!(matches!(result.err(), Some(Error::Argument { name: "shards", .. })), "{what}");
    }
    let result = ShardedOctree::new(tree.clone(), [(Cell::ROOT, coarse.clone())]);
    assert!(matches!(result.err(), Some(Error::FrameMismatch { .. })));
    // Sums.
    assert!(measure_in(&tree, &frame, Cell { level: 2, at: [4, 0, 0] }, 0.0, &alone()).is_err());
    let sum = measure_in(&tree, &frame, Cell::ROOT, 0.0, &alone()).unwrap();
    assert!(matches!(
        sum.plus(&MassSum::unknown(&unit(3), Cell::ROOT).unwrap()),
        Err(Error::FrameMismatch { .. })
    ));
    assert!(matches!(
        sum.minus(&MassSum::unknown(&frame, Cell::ROOT).unwrap()),
        Err(Error::Argument { name: "other", .. })
    ));
    let all = MassSum::unknown(&frame, Cell::ROOT).unwrap();
    assert!(matches!(all.plus(&all), Err(Error::Argument { name: "other", .. })));
    let good = sum.to_bytes();
    for length in 0..good.len() {
        assert!(MassSum::from_bytes(&good[..length]).is_err());
    }
    for at in 0..good.len() {
        let mut bad = good;
        bad[at] ^= 0x80;
        // Any accepted sum can be evaluated.
        if let Ok(sum) = MassSum::from_bytes(&bad) {
            let _ = sum.properties();
        }
    }
    // Statistics of shards in a wrong order, or of cells that the top decides.
    let top = shard(tree.view(), Shard::Top { level: 1 }, &alone()).unwrap();
    let of = |cell: Cell| (cell, shard(tree.view(), Shard::Below(cell), &alone()).unwrap().statistics());
    let cells = top.view().open_cells(1).unwrap();
    let two = [of(cells[1]), of(cells[0])];
    assert!(top.statistics_with(&two).is_err() && top.statistics_with(&two[..1]).is_ok());
    assert!(tree.statistics_with(&two[..1]).is_err());
    let unknown = Octree::uniform(unit(20), Tag::Partial, Tag::Partial).unwrap();
    assert_eq!(unknown.view().open_cells(2).unwrap().len(), 64);
    assert!(matches!(unknown.view().open_cells(20), Err(Error::Limit { .. })));
    // A limit is heeded.
    let few = Control { max_nodes: Some(3), ..alone() };
    assert!(matches!(join(&[*tree.view()], &few), Err(Error::Limit { .. })));
}

/// A universe of one tag.
struct Uniform(Tag);

impl Uniform {
    fn tree(&self, exterior: Tag) -> Octree {
        Octree::uniform(unit(3), self.0, exterior).unwrap()
    }
}
