//! Voxel records, against recursion over dense arrays and against unordered searches.

use leafless::attribute::{Attribute, Criterion, Detail, FunctionAttribute, ValueRange};
use leafless::voxel::{
    LinearCode, Symmetry, Viewpoint, VoxelBoundary, VoxelKind, VoxelOptions, VoxelRecord, VoxelRecords,
    VoxelRecordsRef, Voxels,
};
use leafless::{
    Affine, AnySolid, Bounds, Cell, Control, Csg, Error, Frame, Interval, Octree, Proof, Rule, Tag,
    TriangleMesh, build,
};
use leafless_testkit::exact::Exact;
use leafless_testkit::{Dense, Random, alone, cases, lattice_frame, repeated, shapes};
use proptest::prelude::*;
use std::sync::atomic::AtomicBool;

/// An attribute of two components that change everywhere, without a value in a corner.
fn slope() -> impl Attribute {
    let at = |p: [f64; 3]| p[0] * p[0] + 3.0 * p[1] - 0.5 * p[2];
    let function = move |p: [f64; 3]| (p[0] + p[1] > 0.5).then(|| [at(p), p[2], 0.0, 0.0]);
    FunctionAttribute::new(2, function).unwrap().with_range(|bounds: &Bounds| {
        let (low, high) = (bounds.min, bounds.max);
        if low[0] + low[1] <= 0.5 || low[0] < 0.0 {
            return ValueRange::Unknown;
        }
        let first = Interval::new(
            low[0] * low[0] + 3.0 * low[1] - 0.5 * high[2] - 1e-9,
            high[0] * high[0] + 3.0 * high[1] - 0.5 * low[2] + 1e-9,
        )
        .unwrap();
        ValueRange::Within([first, Interval::new(low[2], high[2]).unwrap(), first, first])
    })
}

/// The expected list, by its definition.
struct Oracle<'a> {
    dense: &'a Dense,
    frame: Frame,
    boundary_level: u8,
    touching: bool,
    exterior: Tag,
    detail: Option<Detail>,
    attribute: &'a dyn Attribute,
    list: Vec<(VoxelKind, Cell)>,
}

impl Oracle<'_> {
    /// True if the neighbour of a finest cell of the boundary level lies outside.
    fn is_outside(&self, at: [i64; 3]) -> bool {
        let n = 1i64 << self.boundary_level;
        if at.iter().any(|a| !(0..n).contains(a)) {
            return self.exterior == Tag::Empty;
        }
        self.dense.tag_of(Cell { level: self.boundary_level, at: at.map(|a| a as u32) }) == Some(Tag::Empty)
    }

    fn touches(&self, cell: Cell) -> bool {
        let shift = self.boundary_level - cell.level;
        let edge = 1i64 << shift;
        let low = cell.at.map(|a| (a as i64) << shift);
        (0..3).any(|axis| {
            [-1, edge].iter().any(|&side| {
                (0..edge * edge).any(|k| {
                    let mut at = low;
                    at[axis] += side;
                    at[(axis + 1) % 3] += k % edge;
                    at[(axis + 2) % 3] += k / edge;
                    self.is_outside(at)
                })
            })
        })
    }

    fn walk(&mut self, cell: Cell) {
        let tag = if cell.level <= self.dense.depth {
            self.dense.tag_of(cell)
        } else {
            let up = cell.level - self.dense.depth;
            self.dense.tag_of(Cell { level: self.dense.depth, at: cell.at.map(|a| a >> up) })
        };
        let edge = self.frame.edge() / (1u64 << cell.level) as f64;
        let low = [0, 1, 2].map(|axis| self.frame.origin()[axis] + cell.at[axis] as f64 * edge);
        let kind =
            match tag {
                Some(Tag::Empty) => VoxelKind::Outside,
                Some(Tag::Partial) => VoxelKind::Boundary,
                Some(Tag::Full)
                    if self.touching && cell.level <= self.boundary_level && self.touches(cell) =>
                {
                    if cell.level == self.boundary_level { VoxelKind::Boundary } else { VoxelKind::Refined }
                }
                Some(_) => {
                    let bounds = Bounds::new(low, low.map(|a| a + edge)).unwrap();
                    match &self.detail {
                        Some(detail) if !detail.is_fine(self.attribute, &bounds, edge).unwrap() => {
                            VoxelKind::Refined
                        }
                        _ => VoxelKind::Inside,
                    }
                }
                None if cell.level == self.boundary_level => VoxelKind::Boundary,
                None => VoxelKind::Refined,
            };
        self.list.push((kind, cell));
        if kind == VoxelKind::Refined {
            (0..8).for_each(|octant| self.walk(cell.child(octant)));
        }
    }
}

fn listed(records: &VoxelRecords) -> Vec<(VoxelKind, Cell)> {
    records.view().iter().map(|record| (record.kind, record.cell)).collect()
}

fn details() -> impl Strategy<Value = Option<Detail>> {
    let some = (0.4..6.0f64, 0.05..1.0f64, 0.0..4.0f64, any::<bool>()).prop_map(
        |(coarse, part, tolerance, range)| {
            let criterion = if range { Criterion::Range } else { Criterion::Variance };
            Some(Detail::new(coarse, (coarse * part).max(0.26), tolerance, criterion).unwrap())
        },
    );
    prop_oneof![Just(None), some]
}

proptest! {
    #![proptest_config(cases(160))]

    #[test]
    fn lists_are_what_recursion_finds(
        shape in shapes(1..=4),
        boundary in 0..6u8,
        touching in any::<bool>(),
        lists in any::<[bool; 2]>(),
        open in any::<bool>(),
        detail in details(),
    ) {
        let dense = shape.dense();
        let exterior = if open { Tag::Partial } else { Tag::Empty };
        let tree = dense.octree_with(exterior, &alone()).unwrap();
        let attribute = slope();
        let rule = if touching { VoxelBoundary::Touching } else { VoxelBoundary::Undecided };
        let mut options =
            VoxelOptions::new().boundary_depth(boundary).boundary(rule).outside(lists[0]).refined(lists[1]);
        if let Some(detail) = detail {
            options = options.detail(detail);
        }
        let records = VoxelRecords::of(tree.view(), &options, Some(&attribute), &alone()).unwrap();
        let mut oracle = Oracle {
            dense: &dense,
            frame: *tree.frame(),
            boundary_level: boundary.min(dense.depth),
            touching,
            exterior,
            detail,
            attribute: &attribute,
            list: vec![],
        };
        oracle.walk(Cell::ROOT);
        let mut expected = oracle.list;
        expected.retain(|(kind, _)| match kind {
            VoxelKind::Outside => lists[0],
            VoxelKind::Refined => lists[1],
            _ => true,
        });
        prop_assert_eq!(&listed(&records), &expected);
        // Each with the value at its centre.
        for record in records.view().iter() {
            let edge = tree.frame().edge() / (1u64 << record.cell.level) as f64;
            let centre = record.cell.at.map(|a| (a as f64 + 0.5) * edge);
            prop_assert_eq!(record.value, attribute.value(centre).unwrap());
        }
        check_arrays(&records);
        check_search(&records);
        let voxels = Voxels::new(tree.view(), &options, Some(&attribute)).unwrap();
        prop_assert_eq!(voxels.count_records().unwrap(), records.view().len() as u64);
        let single: Vec<VoxelRecord> = voxels.map(|record| record.unwrap()).collect();
        prop_assert_eq!(single, records.view().iter().collect::<Vec<_>>());
    }
}

/// Checks that the arrays are accepted, and that changed arrays are refused.
fn check_arrays(records: &VoxelRecords) {
    let view = records.view();
    let frame = view.frame();
    let mut arrays = (view.codes().to_vec(), view.levels().to_vec(), view.kinds().to_vec());
    let values = view.values();
    let again =
        VoxelRecordsRef::new(frame, &arrays.0, &arrays.1, &arrays.2, view.components(), values).unwrap();
    let same = |a: Vec<VoxelRecord>, b: Vec<VoxelRecord>| a == b;
    assert!(same(again.iter().collect(), view.iter().collect()));
    assert_eq!((again.exterior(), again.proof()), (Tag::Partial, Proof::new(false, false)));
    if arrays.0.len() > 1 {
        arrays.0.swap(0, 1);
        arrays.1.swap(0, 1);
        assert!(
            VoxelRecordsRef::new(frame, &arrays.0, &arrays.1, &arrays.2, view.components(), values).is_err()
        );
    }
}

/// Checks the search by code against an examination of every record.
fn check_search(records: &VoxelRecords) {
    let view = records.view();
    let depth = view.frame().depth();
    let all: Vec<VoxelRecord> = view.iter().collect();
    let holds = |outer: Cell, inner: Cell| {
        outer.level <= inner.level && inner.at.map(|a| a >> (inner.level - outer.level)) == outer.at
    };
    let mut random = Random(7);
    let mut probes: Vec<Cell> = all.iter().map(|record| record.cell).take(40).collect();
    probes.extend((0..40).map(|_| {
        let level = random.below(depth as u64 + 1) as u8;
        Cell { level, at: [(); 3].map(|()| random.below(1 << level) as u32) }
    }));
    for cell in probes {
        assert_eq!(view.find(cell), all.iter().position(|record| record.cell == cell));
        let inside: Vec<usize> = (0..all.len()).filter(|&i| holds(cell, all[i].cell)).collect();
        assert_eq!(view.within(cell).collect::<Vec<_>>(), inside);
        let leaf = |record: &VoxelRecord| record.kind != VoxelKind::Refined && holds(record.cell, cell);
        assert_eq!(view.containing(cell), all.iter().position(leaf));
        if cell.level < depth {
            for (octant, range) in (0..8).zip(view.children(cell)) {
                let child = cell.child(octant);
                let inside: Vec<usize> = (0..all.len()).filter(|&i| holds(child, all[i].cell)).collect();
                assert_eq!(range.collect::<Vec<_>>(), inside);
            }
        }
        let edge = view.frame().edge() / (1u64 << cell.level) as f64;
        let corner = cell.at.map(|a| a as f64 * edge);
        let finest = Cell { level: depth, at: cell.at.map(|a| a << (depth - cell.level)) };
        assert_eq!(view.at(corner), view.containing(finest));
        assert_eq!(view.at(corner.map(|x| x - 1e9)), None);
        if let Some(index) = view.find(cell) {
            assert_eq!((view.corner(index), view.edge(index)), (Some(corner), Some(edge)));
            let code = view.code(index).unwrap();
            assert_eq!((code.cell(), code), (cell, LinearCode::new(cell, depth).unwrap()));
        }
    }
    assert_eq!(view.find(Cell { level: 30, at: [0; 3] }), None);
    assert_eq!(view.within(Cell { level: 2, at: [4; 3] }), 0..0);
    assert_eq!(view.get(all.len()), None);
}

fn ball(depth: u8) -> Octree {
    let frame = Frame::new([-1.0; 3], 2.0, depth).unwrap();
    build(&Csg::ball([0.0; 3], 0.9).unwrap(), &frame, Rule::Certified, &Control::default()).unwrap()
}

#[test]
fn nothing_is_missed_by_the_certified_criterion() {
    // A thin shell that no corner of a coarse cell meets.
    let radius = |p: [f64; 3]| (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
    let function = |p: [f64; 3]| {
        let r = radius(p);
        Some([if (0.401..0.405).contains(&r) { 1.0 } else { 0.0 }, 0.0, 0.0, 0.0])
    };
    let thin = FunctionAttribute::new(1, function).unwrap().with_range(|bounds: &Bounds| {
        let least: f64 = (0..3)
            .map(|axis| {
                let near = 0.0f64.clamp(bounds.min[axis], bounds.max[axis]);
                near * near
            })
            .sum();
        let most: f64 = (0..3).map(|axis| bounds.min[axis].abs().max(bounds.max[axis].abs()).powi(2)).sum();
        let (least, most) = (least.sqrt() - 1e-12, most.sqrt() + 1e-12);
        let any = least < 0.405 && most >= 0.401;
        let all = least >= 0.401 && most < 0.405;
        let range = Interval::new(all as u8 as f64, any as u8 as f64).unwrap();
        ValueRange::Within([range; 4])
    });
    let tree = ball(5);
    let count = |criterion| {
        let detail = Detail::new(0.5, 1.0 / 64.0, 0.0, criterion).unwrap();
        let options = VoxelOptions::new().detail(detail);
        let records = VoxelRecords::of(tree.view(), &options, Some(&thin), &alone()).unwrap();
        let finest = records.view().levels().iter().filter(|&&level| level == 7).count();
        // Cells that were left coarse have one value all over.
        let mut random = Random(11);
        let mut wrong = 0;
        for record in records.view().iter().filter(|r| r.kind == VoxelKind::Inside && r.cell.level < 7) {
            let edge = 2.0 / (1u64 << record.cell.level) as f64;
            for _ in 0..20 {
                let p = record.cell.at.map(|a| -1.0 + (a as f64 + random.unit()) * edge);
                wrong += (thin.value(p).unwrap() != record.value) as u32;
            }
        }
        (finest, wrong)
    };
    let (few, missed) = count(Criterion::Variance);
    let (many, none) = count(Criterion::Range);
    assert!(missed > 0 && none == 0 && many > 4 * few, "{few} {missed} {many} {none}");
}

#[test]
fn limits_and_refusals() {
    let tree = ball(5);
    let of = |options: &VoxelOptions, control: &Control<'_>| {
        VoxelRecords::of(tree.view(), options, None, control).map(|records| records.view().len())
    };
    let fine = Detail::uniform(1e-9).unwrap();
    assert!(matches!(
        of(&VoxelOptions::new().detail(fine), &alone()),
        Err(Error::Argument { name: "fine", .. })
    ));
    let small = Control { max_bytes: Some(1000), ..Control::default() };
    assert!(matches!(
        of(&VoxelOptions::new(), &small),
        Err(Error::TooLarge { limit: 1000, needed: 1001.., .. })
    ));
    // Not all voxels that touch outside cells are known in advance.
    let touching = VoxelOptions::new().boundary(VoxelBoundary::Touching);
    let shape = Csg::ball([0.1, 0.0, 0.0], 0.8).unwrap();
    let tree = build(&shape, &Frame::new([-1.0; 3], 2.0, 6).unwrap(), Rule::Sampled, &alone()).unwrap();
    let of = |options: &VoxelOptions, control: &Control<'_>| {
        VoxelRecords::of(tree.view(), options, None, control).map(|records| records.view().len())
    };
    let bytes = 10 * of(&touching, &alone()).unwrap() as u64;
    let scant = Control { max_bytes: Some(bytes - 1), ..Control::default() };
    match of(&touching, &scant) {
        Err(Error::Limit { what: "bytes", limit }) => assert_eq!(limit, bytes - 1),
        other => panic!("{other:?}"),
    }
    let enough = Control { max_bytes: Some(bytes), ..Control::default() };
    assert_eq!(of(&touching, &enough).unwrap() as u64 * 10, bytes);
    let flag = AtomicBool::new(true);
    let stopped = Control { cancel: Some(&flag), ..Control::default() };
    assert!(matches!(of(&VoxelOptions::new(), &stopped), Err(Error::Cancelled)));
    // A whole universe.
    for (tag, kind) in [(Tag::Full, VoxelKind::Inside), (Tag::Partial, VoxelKind::Boundary)] {
        let tree = Dense::uniform(3, tag).octree();
        for depth in [0, 2, 9] {
            let options = VoxelOptions::new().boundary_depth(depth);
            let records = VoxelRecords::of(tree.view(), &options, None, &alone()).unwrap();
            assert_eq!(listed(&records), [(kind, Cell::ROOT)]);
        }
    }
    let frame = lattice_frame(3);
    let new = |codes: &[u64], levels: &[u8], kinds: &[u8], components, values: &[f64]| {
        VoxelRecords::from_arrays(
            &frame,
            codes.to_vec(),
            levels.to_vec(),
            kinds.to_vec(),
            components,
            values.to_vec(),
        )
        .map(|records| records.view().len())
    };
    assert_eq!(new(&[0, 0, 0o10, 0o70], &[1, 2, 2, 3], &[3, 1, 0, 2], 0, &[]).unwrap(), 4);
    assert_eq!(new(&[0], &[0], &[1], 2, &[1.0, f64::NAN]).unwrap(), 1);
    for (codes, levels, kinds, components, values) in [
        (&[0o1][..], &[2][..], &[1][..], 0, &[][..]),
        (&[0o1000], &[3], &[1], 0, &[]),
        (&[0], &[4], &[1], 0, &[]),
        (&[0], &[3], &[4], 0, &[]),
        (&[0], &[3], &[1], 5, &[0.0; 5]),
        (&[0], &[3], &[1], 2, &[0.0]),
        (&[0], &[3, 3], &[1], 0, &[]),
        (&[0, 0], &[3, 3], &[1, 1], 0, &[]),
        (&[0, 0o1], &[2, 3], &[1, 1], 0, &[]),
        (&[0, 0], &[3, 2], &[1, 3], 0, &[]),
        (&[0, 0], &[2, 3], &[1, 1], 0, &[]),
    ] {
        let refused = new(codes, levels, kinds, components, values);
        assert!(matches!(refused, Err(Error::Argument { .. })), "{codes:?} {levels:?} {kinds:?}");
    }
}

#[test]
fn an_attribute_that_fails_ends_the_list() {
    struct Broken;
    impl Attribute for Broken {
        fn components(&self) -> usize {
            1
        }

        fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
            values.fill(Some([1.0; 4]));
            if points[0][0] > 0.0 { Err(Error::Callback { code: 7 }) } else { Ok(()) }
        }
    }
    let tree = ball(4);
    let records = VoxelRecords::of(tree.view(), &VoxelOptions::new(), Some(&Broken), &alone());
    assert!(matches!(records, Err(Error::Callback { code: 7 })));
    let mut voxels = Voxels::new(tree.view(), &VoxelOptions::new(), Some(&Broken)).unwrap();
    assert!(voxels.by_ref().any(|record| record.is_err()));
    assert!(voxels.next().is_none());
}

/// Records with all options: four kinds, two components.
fn some_records(dense: &Dense, boundary: u8, refined: bool, detail: Option<Detail>) -> VoxelRecords {
    let mut options = VoxelOptions::new().boundary_depth(boundary).outside(true).refined(refined);
    if let Some(detail) = detail {
        options = options.detail(detail);
    }
    VoxelRecords::of(dense.octree().view(), &options, Some(&slope()), &alone()).unwrap()
}

/// Returns the records as bits, because NaN is not equal to itself.
fn bits(records: &VoxelRecords) -> (Vec<u64>, Vec<u8>, Vec<u8>, Vec<u64>) {
    let view = records.view();
    let values = view.values().iter().map(|value| value.to_bits()).collect();
    (view.codes().to_vec(), view.levels().to_vec(), view.kinds().to_vec(), values)
}

proptest! {
    #![proptest_config(cases(160))]

    #[test]
    fn octrees_come_back(
        shape in shapes(1..=4),
        boundary in 0..5u8,
        lists in any::<[bool; 2]>(),
        open in any::<bool>(),
        binary in any::<bool>(),
        detail in details(),
    ) {
        let mut dense = shape.dense();
        if binary {
            dense = dense.resolved(Tag::Full);
        }
        let exterior = if open { Tag::Partial } else { Tag::Empty };
        let proof = Proof::new(true, open);
        let tree = dense.octree_with(exterior, &alone()).unwrap().with_proof(proof);
        let rule = if binary { VoxelBoundary::Touching } else { VoxelBoundary::Undecided };
        let mut options = VoxelOptions::new().boundary(rule).outside(lists[0]).refined(lists[1]);
        if !binary {
            options = options.boundary_depth(boundary);
        }
        if let Some(detail) = detail {
            options = options.detail(detail);
        }
        let records = VoxelRecords::of(tree.view(), &options, None, &alone()).unwrap();
        let tag = if binary { Tag::Full } else { Tag::Partial };
        let again = records.view().to_octree(tag, &alone()).unwrap();
        // The same tree, as deep as the tests search records, on a lattice as deep as records allow.
        let level = if binary { dense.depth } else { boundary.min(dense.depth).max(1) };
        let depth = records.view().frame().depth();
        let mut expected = dense.cut(level);
        if !binary && boundary == 0 && dense.tag_of(Cell::ROOT).is_none() {
            expected = Dense::uniform(1, Tag::Partial);
        }
        prop_assert_eq!(Dense::of(again.view()), expected.refined(depth));
        prop_assert_eq!((again.view().exterior(), again.view().proof()), (exterior, proof));
        if depth == dense.depth && level == depth && (binary || boundary > 0) {
            let bytes = |tree: &Octree| leafless::file::to_bytes(tree).unwrap();
            prop_assert_eq!(bytes(&again), bytes(&tree));
        }
        prop_assert!(records.view().to_octree(Tag::Branch, &alone()).is_err());
    }

    #[test]
    fn symmetries_move_every_cell(shape in shapes(1..=3), refined in any::<bool>(), detail in details()) {
        let records = some_records(&shape.dense(), 9, refined, detail);
        let view = records.view();
        let mut turned_all = vec![];
        for symmetry in Symmetry::all() {
            let turned = view.turned(symmetry, &alone()).unwrap();
            // Each cell by its coordinates, then sorted.
            let mut expected: Vec<_> = (0..view.len()).map(|index| {
                let record = view.get(index).unwrap();
                let last = (1u32 << record.cell.level) - 1;
                let at = [0, 1, 2].map(|axis| {
                    let from = record.cell.at[symmetry.axes()[axis] as usize];
                    if symmetry.flipped()[axis] { last - from } else { from }
                });
                let cell = Cell { level: record.cell.level, at };
                let code = LinearCode::new(cell, view.frame().depth()).unwrap();
                let value: Vec<u64> = view.values()[2 * index..][..2].iter().map(|x| x.to_bits()).collect();
                (code.number(), cell.level, record.kind as u8, value)
            }).collect();
            expected.sort();
            let (codes, levels, kinds, values) = bits(&turned);
            let found: Vec<_> = (0..codes.len())
                .map(|i| (codes[i], levels[i], kinds[i], values[2 * i..][..2].to_vec()))
                .collect();
            prop_assert_eq!(found, expected);
            check_arrays(&turned);
            turned_all.push(turned);
        }
        // The inverse undoes it.
        for (symmetry, turned) in Symmetry::all().zip(turned_all) {
            let (mut axes, mut flipped) = ([0; 3], [false; 3]);
            for axis in 0..3 {
                let from = symmetry.axes()[axis] as usize;
                (axes[from], flipped[from]) = (axis as u8, symmetry.flipped()[axis]);
            }
            let inverse = Symmetry::new(axes, flipped).unwrap();
            prop_assert_eq!(bits(&turned.view().turned(inverse, &alone()).unwrap()), bits(&records));
        }
    }

    /// Moved cells, against dense arrays and against the octree as a solid under the same map.
    #[test]
    fn whole_cells_move_as_octrees_do(
        shape in shapes(1..=3),
        refined in any::<bool>(),
        detail in details(),
        offset in [-9..=9i32, -9..=9i32, -9..=9i32],
        which in 0..48usize,
        near in any::<bool>(),
    ) {
        let dense = shape.dense();
        let (depth, edge) = (dense.depth, 1i32 << dense.depth);
        let offset = if near { offset.map(|a| a % 3) } else { offset };
        let symmetry = Symmetry::all().nth(which).unwrap();
        let tree = dense.octree_with(Tag::Empty, &alone()).unwrap();
        let mut options = VoxelOptions::new().outside(true).refined(refined);
        if let Some(detail) = detail {
            options = options.detail(detail);
        }
        let records = VoxelRecords::of(tree.view(), &options, Some(&slope()), &alone()).unwrap();
        let view = records.view();
        // The lattice of the records may be finer than the octree's.
        let fine = view.frame().depth();
        let scale = 1i32 << (fine - depth);
        let moved = view.moved(symmetry, offset.map(|a| a * scale), &alone()).unwrap();
        check_arrays(&moved);
        // The source of a cell, on a lattice of this many cells.
        let from = |at: [i32; 3], scale: i32| -> Option<[u32; 3]> {
            let mut old = [0; 3];
            for axis in 0..3 {
                let back = at[axis] - offset[axis] * scale;
                let back = if symmetry.flipped()[axis] { edge * scale - 1 - back } else { back };
                old[symmetry.axes()[axis] as usize] = u32::try_from(back).ok()?;
            }
            old.iter().all(|&a| a < (edge * scale) as u32).then_some(old)
        };
        let tag = |at: [u32; 3]| from(at.map(|a| a as i32), 1).map_or(Tag::Empty, |old| dense.at(old));
        let expected = Dense::from_fn(depth, tag);
        let octree = moved.view().to_octree(Tag::Partial, &alone()).unwrap();
        prop_assert_eq!(Dense::of(octree.view()), expected.refined(fine));
        prop_assert_eq!(octree.proof().empty, tree.proof().empty);
        let mut rows = [[0.0; 4]; 3];
        for axis in 0..3 {
            let flipped = symmetry.flipped()[axis];
            rows[axis][symmetry.axes()[axis] as usize] = if flipped { -1.0 } else { 1.0 };
            rows[axis][3] = f64::from(offset[axis] + if flipped { edge } else { 0 });
        }
        let placed = AnySolid::new(tree.clone()).placed(&Affine::new(rows).unwrap()).unwrap();
        let built = build(&placed, tree.frame(), Rule::Certified, &alone()).unwrap();
        prop_assert_eq!(Dense::of(built.view()), expected);
        // Kinds and values are those of the record from which a cell comes.
        for record in moved.view().iter().filter(|record| record.kind != VoxelKind::Refined) {
            let at = record.cell.at.map(|a| (a << (fine - record.cell.level)) as i32);
            let old = from(at, scale).unwrap();
            let known = view.get(view.containing(Cell { level: fine, at: old }).unwrap()).unwrap();
            let told = |record: &VoxelRecord| format!("{:?} {:?}", record.kind, record.value);
            prop_assert_eq!(told(&record), told(&known));
        }
        if offset == [0; 3] {
            prop_assert_eq!(bits(&moved), bits(&view.turned(symmetry, &alone()).unwrap()));
        }
        // The exterior.
        let around = dense.octree_with(Tag::Full, &alone()).unwrap();
        let records = VoxelRecords::of(around.view(), &VoxelOptions::new(), None, &alone()).unwrap();
        let moved = records.view().moved(symmetry, [1, 0, 0], &alone()).unwrap();
        prop_assert_eq!((moved.view().exterior(), moved.view().proof().empty), (Tag::Partial, false));
    }

    #[test]
    fn centres_decide_where_maps_are_no_symmetries(
        shape in shapes(1..=3),
        detail in details(),
        entries in proptest::collection::vec(-1.5..1.5f64, 9),
        shift in proptest::collection::vec(-4.0..8.0f64, 3),
        depth in 1..=4u8,
        plain in any::<bool>(),
    ) {
        let records = some_records(&shape.dense(), 9, true, detail);
        let mut rows: [[f64; 4]; 3] =
            std::array::from_fn(|i| [entries[3 * i], entries[3 * i + 1], entries[3 * i + 2], shift[i]]);
        if plain {
            rows = [[1.0, 0.0, 0.0, 0.25], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -0.5]];
        }
        let Ok(map) = Affine::new(rows) else { return Ok(()) };
        let frame = lattice_frame(depth);
        let placed = records.view().placed_by_centres(&map, &frame, &alone()).unwrap();
        check_arrays(&placed);
        let det = |m: [[f64; 3]; 3]| {
            m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
                + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
        };
        let linear = rows.map(|row| [row[0], row[1], row[2]]);
        let whole = det(linear);
        prop_assume!(whole.abs() > 0.01);
        for at in leafless_testkit::positions(depth) {
            // By Cramer's rule.
            let right = [0, 1, 2].map(|axis| at[axis] as f64 + 0.5 - rows[axis][3]);
            let point: [f64; 3] = std::array::from_fn(|k| {
                let mut m = linear;
                (0..3).for_each(|i| m[i][k] = right[i]);
                det(m) / whole
            });
            let finest = records.view().frame().cell_size();
            let near_plane = |x: f64| (x / finest - (x / finest).round()).abs() < 1e-9;
            if point.iter().any(|&x| near_plane(x)) {
                continue;
            }
            let expected = records.view().at(point).and_then(|index| records.view().get(index));
            let found = placed.view().at(at.map(|a| a as f64 + 0.5)).and_then(|index| placed.view().get(index));
            let told = |record: Option<VoxelRecord>| record.map(|record| (record.kind, record.value));
            prop_assert_eq!(told(found), told(expected));
        }
        // All cells that can merge have merged.
        let all: Vec<VoxelRecord> = placed.view().iter().collect();
        for eight in all.windows(8) {
            let parent = eight[0].cell.parent();
            let same = |record: &VoxelRecord| {
                record.cell.parent() == parent && (record.kind, record.value) == (eight[0].kind, eight[0].value)
            };
            prop_assert!(
                eight[0].cell.level == 0 || eight[0].kind == VoxelKind::Boundary || !eight.iter().all(same)
            );
        }
    }
}

#[test]
fn maps_that_take_cells_to_cells() {
    let frame = Frame::new([-1.0, 0.5, 3.0], 4.0, 4).unwrap();
    let shape = Csg::ball([0.7, 2.3, 4.9], 1.4).unwrap();
    let tree = build(&shape, &frame, Rule::Certified, &alone()).unwrap();
    let records = VoxelRecords::of(tree.view(), &VoxelOptions::new(), Some(&slope()), &alone()).unwrap();
    let view = records.view();
    for (k, symmetry) in Symmetry::all().enumerate() {
        let scale = [0.25, 1.0, 8.0][k % 3];
        let mut rows = [[0.0; 4]; 3];
        for axis in 0..3 {
            rows[axis][symmetry.axes()[axis] as usize] =
                if symmetry.flipped()[axis] { -scale } else { scale };
            rows[axis][3] = [0.5, -7.0, 1024.0][axis];
        }
        let map = Affine::new(rows).unwrap();
        let placed = records.view().placed_exactly(&map, &alone()).unwrap();
        assert_eq!(placed.view().frame().edge(), scale * 4.0);
        assert_eq!((placed.view().len(), placed.view().proof()), (view.len(), view.proof()));
        for index in 0..view.len() {
            let centre = |view: &VoxelRecordsRef<'_>, index: usize| {
                let half = 0.5 * view.edge(index).unwrap();
                view.corner(index).unwrap().map(|x| x + half)
            };
            let image = placed.view().at(map.apply(centre(&view, index))).unwrap();
            let told = |view: &VoxelRecordsRef<'_>, index: usize| {
                view.get(index).map(|record| (record.kind, record.cell.level, record.value))
            };
            assert_eq!(told(&placed.view(), image), told(&view, index));
            assert_eq!(centre(&placed.view(), image), map.apply(centre(&view, index)));
        }
    }
    let refused = |rows: [[f64; 4]; 3]| {
        let placed = records.view().placed_exactly(&Affine::new(rows).unwrap(), &alone());
        assert!(matches!(placed, Err(Error::Argument { name: "placement", .. })), "{rows:?}");
    };
    refused([[3.0, 0.0, 0.0, 0.0], [0.0, 3.0, 0.0, 0.0], [0.0, 0.0, 3.0, 0.0]]);
    refused([[1.0, 0.0, 0.0, 0.0], [0.0, 2.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);
    refused([[1.0, 1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);
    refused([[1.0, 0.0, 0.0, 1e-17], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);
}

/// True if a cube may hide part of another cube, seen from an eye or along a direction.
fn hides(front: [[f64; 3]; 2], back: [[f64; 3]; 2], from: &Viewpoint) -> bool {
    match *from {
        // The front cube, moved along the direction for some t > 0, meets the back one.
        Viewpoint::Parallel(direction) => {
            let (mut first, mut last) = (0.0f64, f64::INFINITY);
            for axis in 0..3 {
                let (low, high) = (back[0][axis] - front[1][axis], back[1][axis] - front[0][axis]);
                let d = direction[axis];
                if d == 0.0 {
                    if !(low < 0.0 && high > 0.0) {
                        return false;
                    }
                } else {
                    let (a, b) = if d > 0.0 { (low / d, high / d) } else { (high / d, low / d) };
                    (first, last) = (first.max(a), last.min(b));
                }
            }
            first < last
        }
        // The front cube, scaled about the eye by some s > 1, meets the back one.
        Viewpoint::Perspective(eye) => {
            let (mut first, mut last) = (1.0f64, f64::INFINITY);
            for axis in 0..3 {
                let [a, b] = [front[0][axis] - eye[axis], front[1][axis] - eye[axis]];
                let [low, high] = [back[0][axis] - eye[axis], back[1][axis] - eye[axis]];
                // s·b > low and s·a < high.
                for (factor, bound) in [(b, low), (-a, -high)] {
                    if factor > 0.0 {
                        first = first.max(bound / factor);
                    } else if factor < 0.0 {
                        last = last.min(bound / factor);
                    } else if bound >= 0.0 {
                        return false;
                    }
                }
            }
            first < last
        }
    }
}

#[test]
fn depth_orders_hold_for_a_thousand_views() {
    let mut random = Random(3);
    let frame = Frame::new([0.0; 3], 16.0, 4).unwrap();
    let shape = Csg::ball([7.0, 8.5, 6.0], 6.3).unwrap();
    let tree = build(&shape, &frame, Rule::Certified, &alone()).unwrap();
    let detail = Detail::new(4.0, 1.0, 9.0, Criterion::Variance).unwrap();
    let options = VoxelOptions::new().boundary_depth(3).detail(detail).outside(true).refined(true);
    let records = VoxelRecords::of(tree.view(), &options, Some(&slope()), &alone()).unwrap();
    let view = records.view();
    let cubes: Vec<[[f64; 3]; 2]> = (0..view.len())
        .map(|index| {
            let (corner, edge) = (view.corner(index).unwrap(), view.edge(index).unwrap());
            [corner, corner.map(|x| x + edge)]
        })
        .collect();
    let leaves = view.len() as u64 - view.count(VoxelKind::Refined);
    assert!(leaves > 300 && view.count(VoxelKind::Refined) > 10, "{leaves}");
    for k in 0..repeated(300, 1000) {
        let mut at = [(); 3].map(|()| random.between(-1.0, 1.0));
        if k % 5 == 0 {
            at[random.below(3) as usize] = 0.0;
        }
        let from = match k % 3 {
            0 => Viewpoint::Perspective(at.map(|x| 8.0 + 8.0 * x)),
            // On planes between cells.
            1 if k % 4 == 0 => Viewpoint::Perspective(at.map(|x| (8.0 + 14.0 * x).round())),
            _ if at == [0.0; 3] => continue,
            _ => Viewpoint::Parallel(at),
        };
        let order = view.depth_order(&from, &alone()).unwrap();
        let mut sorted = order.clone();
        sorted.sort();
        sorted.dedup();
        assert_eq!(sorted.len() as u64, leaves);
        assert!(sorted.iter().all(|&index| view.get(index as usize).unwrap().kind != VoxelKind::Refined));
        for (place, &back) in order.iter().enumerate() {
            // No later record hides an earlier one.
            for &front in &order[place + 1..] {
                let [back, front] = [back, front].map(|index| cubes[index as usize]);
                assert!(!hides(front, back, &from), "{from:?}: {front:?} hides {back:?}");
            }
        }
    }
    for bad in [
        Viewpoint::Parallel([0.0; 3]),
        Viewpoint::Parallel([f64::NAN, 1.0, 1.0]),
        Viewpoint::Perspective([f64::INFINITY, 1.0, 1.0]),
        Viewpoint::Perspective([1e300, 1.0, 1.0]),
    ] {
        assert!(matches!(view.depth_order(&bad, &alone()), Err(Error::Argument { .. })));
    }
}

mod triangles {
    use super::*;

    /// True if a triangle and a closed box have a point in common. The triangle is clipped with exact
    /// fractions: a polygon whose corners are integers over one denominator each.
    fn meets(corners: [[i128; 3]; 3], low: [i128; 3], high: [i128; 3]) -> bool {
        // Homogeneous: (x, y, z, w), w > 0.
        let mut polygon: Vec<[i128; 4]> = corners.iter().map(|c| [c[0], c[1], c[2], 1]).collect();
        for axis in 0..3 {
            for (sign, bound) in [(1, -low[axis]), (-1, high[axis])] {
                let height = |p: &[i128; 4]| sign * p[axis] + bound * p[3];
                let mut kept = vec![];
                for k in 0..polygon.len() {
                    let (p, q) = (polygon[k], polygon[(k + 1) % polygon.len()]);
                    let (a, b) = (height(&p), height(&q));
                    if a >= 0 {
                        kept.push(p);
                    }
                    if (a > 0 && b < 0) || (a < 0 && b > 0) {
                        let (a, b) = (a.abs(), b.abs());
                        let cut: [i128; 4] = std::array::from_fn(|i| p[i] * b + q[i] * a);
                        let divisor = cut.iter().fold(0, |g: i128, &x| gcd(g, x.abs()));
                        kept.push(cut.map(|x| x / divisor));
                    }
                }
                polygon = kept;
            }
        }
        !polygon.is_empty()
    }

    fn gcd(a: i128, b: i128) -> i128 {
        if b == 0 { a } else { gcd(b, a % b) }
    }

    fn check(
        mesh: &TriangleMesh,
        records: &VoxelRecords,
        unit: f64,
        to_integer: impl Fn([f64; 3]) -> [i128; 3],
    ) {
        let view = records.view();
        let found = view.triangles(mesh, &alone()).unwrap();
        assert_eq!(found.offsets().len(), view.len() + 1);
        assert_eq!(*found.offsets().last().unwrap() as usize, found.triangles().len());
        let shift = |level: u8| view.frame().depth() - level;
        for index in 0..view.len() {
            let record = view.get(index).unwrap();
            let cell = record.cell;
            let edge = 1i128 << shift(cell.level);
            let scale = (1.0 / unit) as i128;
            let low = cell.at.map(|a| (a as i128 * edge) * scale);
            let high = cell.at.map(|a| (a as i128 + 1) * edge * scale);
            let expected: Vec<u32> = (0u32..)
                .zip(mesh.triangles())
                .filter(|(_, corners)| {
                    let corners = corners.map(|v| to_integer(mesh.vertices()[v as usize]));
                    record.kind == VoxelKind::Boundary && meets(corners, low, high)
                })
                .map(|(index, _)| index)
                .collect();
            assert_eq!(found.of(index), expected, "{cell:?}");
        }
        assert!(found.of(view.len()).is_empty() && found.of(usize::MAX).is_empty());
    }

    proptest! {
        #![proptest_config(cases(60))]

        #[test]
        fn each_boundary_voxel_has_those_that_meet_it(
            shape in shapes(1..=4),
            boundary in 1..5u8,
            coordinates in proptest::collection::vec(-8..40i32, 9..80),
            fine in any::<bool>(),
        ) {
            let dense = shape.dense();
            let records = some_records(&dense, boundary, true, None);
            // On half-integers, where many pairs only touch, or on a grid of 1/64 of cells.
            let step = if fine { 1.0 / 64.0 } else { 0.5 };
            let number = |k: i32| f64::from(k) * step * if fine { 29.0 } else { 1.0 };
            let vertices: Vec<[f64; 3]> =
                coordinates.chunks_exact(3).map(|c| [number(c[0]), number(c[1]), number(c[2])]).collect();
            let count = vertices.len() as u32;
            let triangles: Vec<[u32; 3]> = (0..count).map(|k| [k, (k + 1) % count, (k + 2) % count]).collect();
            let Ok(mesh) = TriangleMesh::new(vertices, triangles) else { return Ok(()) };
            let unit = records.view().frame().cell_size();
            // Cells of the records' lattice have the edge `unit`.
            prop_assert!(unit >= 1.0);
            let to_integer = |p: [f64; 3]| p.map(|x| (x * 64.0) as i128);
            check(&mesh, &records, 1.0 / (64.0 * unit), to_integer);
        }
    }

    #[test]
    fn planes_that_are_no_doubles_are_met_exactly() {
        // Lattice planes at multiples of 0.1/16. A vertex next to such a plane lies on its own side.
        let frame = Frame::new([0.1; 3], 0.1, 4).unwrap();
        let codes: Vec<u64> = (0..4096).collect();
        let records =
            VoxelRecords::from_arrays(&frame, codes, vec![4; 4096], vec![2; 4096], 0, vec![]).unwrap();
        for i in 1..16 {
            let plane = frame.plane(0, i);
            for x in [plane.lower.next_down(), plane.lower, plane.upper, plane.upper.next_up()] {
                let vertices = vec![[x, 0.12, 0.13], [x, 0.121, 0.13], [x, 0.12, 0.131]];
                let mesh = TriangleMesh::new(vertices, vec![[0, 1, 2]]).unwrap();
                let found = records.view().triangles(&mesh, &alone()).unwrap();
                let columns: Vec<u32> = (0..4096)
                    .filter(|&index| !found.of(index).is_empty())
                    .map(|index| records.view().get(index).unwrap().cell.at[0])
                    .collect();
                let to_plane = Exact::from(x).minus(&Exact::plane(&frame, 0, i)).sign();
                let expected: &[u32] = match to_plane {
                    1 => &[i],
                    0 => &[i - 1, i],
                    _ => &[i - 1],
                };
                let mut sorted = columns.clone();
                sorted.sort();
                sorted.dedup();
                assert_eq!(sorted, expected, "{i} {x}");
            }
        }
    }
}

#[path = "../../examples/gear_records.rs"]
#[allow(dead_code)]
mod gear_records;

/// On the published gear, voxels that follow the colour are 2.33 times fewer.
#[test]
fn adaptive_voxels_are_fewer_and_no_value_is_off() {
    for part in gear_records::parts(&alone()).unwrap() {
        let lists = part.lists(&alone()).unwrap();
        let [coarse, adaptive, fine] =
            [&lists.coarse, &lists.adaptive, &lists.fine].map(gear_records::inside);
        println!("{}: {coarse}, {adaptive}, {fine}", part.name);
        assert!(coarse < adaptive && fine as f64 >= 2.33 * adaptive as f64, "{}", part.name);
        let (adaptive, fine) = (lists.adaptive.view(), lists.fine.view());
        let mut voxels = 0;
        for record in fine.iter() {
            let around = adaptive.get(adaptive.containing(record.cell).unwrap()).unwrap();
            assert_eq!(around.kind, record.kind);
            voxels += 1u64 << (3 * (fine.frame().depth() - record.cell.level));
            let (a, b) = (around.value.unwrap(), record.value.unwrap());
            for k in 0..part.attribute.components() {
                assert!((a[k] - b[k]).abs() <= part.tolerance, "{}: {around:?} {record:?}", part.name);
            }
        }
        let space = |records: &VoxelRecordsRef<'_>| -> u64 {
            records.levels().iter().map(|&level| 1u64 << (3 * (fine.frame().depth() - level))).sum()
        };
        assert_eq!((space(&adaptive), space(&fine)), (voxels, voxels));
        // The coarse picture is poor: its values are wrong in places.
        let coarse = lists.coarse.view();
        let off = fine.iter().any(|record| {
            let around = coarse.get(coarse.containing(record.cell).unwrap()).unwrap();
            (around.value.unwrap()[0] - record.value.unwrap()[0]).abs() > part.tolerance
        });
        assert!(off, "{}", part.name);
    }
}

/// The solid parts of voxels add up to the volume.
#[test]
fn solid_parts_add_up() {
    let control = alone();
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let volume_of = |solid: &Csg| {
        let tree = build(solid, &frame, Rule::Certified, &control).unwrap();
        let records =
            VoxelRecords::of(tree.view(), &VoxelOptions::new().outside(true), None, &control).unwrap();
        let parts = records.view().solid_parts(solid, &control).unwrap();
        let mut volume = 0.0;
        for (record, part) in records.view().iter().zip(parts) {
            let expected = match record.kind {
                VoxelKind::Inside => 1.0..=1.0,
                VoxelKind::Outside => 0.0..=0.0,
                _ => 0.0..=1.0,
            };
            assert!(expected.contains(&part));
            volume += part * (2.0 / f64::from(1u32 << record.cell.level)).powi(3);
        }
        volume
    };
    // Faces off the lattice are cut exactly.
    let block = Csg::cuboid([-0.71, -0.52, -0.33], [0.64, 0.81, 0.27]).unwrap();
    assert!((volume_of(&block) - 1.35 * 1.33 * 0.6).abs() < 1e-12);
    let ball = Csg::ball([0.01, 0.02, 0.03], 0.8).unwrap();
    let volume = 4.0 / 3.0 * std::f64::consts::PI * 0.512;
    assert!((volume_of(&ball) - volume).abs() < 1e-4);
    // The universe as one voxel.
    let one = VoxelRecords::from_arrays(&frame, vec![0], vec![0], vec![VoxelKind::Boundary as u8], 0, vec![])
        .unwrap();
    let parts = one.view().solid_parts(&ball, &control).unwrap();
    assert!((parts[0] - volume / 8.0).abs() < 0.1, "{parts:?}");
    let parts = one.view().solid_parts(&block, &control).unwrap();
    assert!((parts[0] - 1.35 * 1.33 * 0.6 / 8.0).abs() < 1e-12, "{parts:?}");
}

#[test]
fn equal_records_beside_each_other_cost_nothing_where_they_meet() {
    // Four octants inside and four outside, on a lattice of 2^20 cells along an axis, moved by a fraction of
    // a cell. Where equal octants meet, nothing is split; where different octants meet, the result exceeds
    // the limit.
    let frame = Frame::new([0.0; 3], 1.0, 20).unwrap();
    let codes: Vec<u64> = (0..8).map(|octant| octant << 57).collect();
    let records = |kinds: Vec<u8>| {
        VoxelRecords::from_arrays(&frame, codes.clone(), vec![1; 8], kinds, 0, vec![]).unwrap()
    };
    let inside = VoxelKind::Inside as u8;
    let moved = Affine::translation([0.1, 0.2, 0.3]).unwrap();
    let into = Frame::new([0.25, 0.25, 0.375], 0.75, 20).unwrap();
    let limited = Control { max_bytes: Some(1 << 16), ..alone() };
    let same = records(vec![inside; 8]).view().placed_by_centres(&moved, &into, &limited).unwrap();
    assert_eq!((same.view().len(), same.view().get(0).unwrap().cell), (1, Cell::ROOT));
    let half = records([vec![inside; 4], vec![VoxelKind::Outside as u8; 4]].concat());
    assert!(matches!(half.view().placed_by_centres(&moved, &into, &limited), Err(Error::Limit { .. })));
}

#[test]
fn faces_that_run_along_the_lattice_cost_nothing() {
    // Two of eight octants without neighbours, on a lattice of 2^20 cells along an axis. 2^40 finest cells
    // lie along each face.
    let frame = Frame::new([-1.0, 0.5, 3.0], 4.0, 20).unwrap();
    let (codes, kinds) = (vec![0, 3 << 57], vec![VoxelKind::Inside as u8, VoxelKind::Boundary as u8]);
    let records = VoxelRecords::from_arrays(&frame, codes, vec![1; 2], kinds, 0, vec![]).unwrap();
    let limited = Control { max_bytes: Some(1 << 16), ..alone() };
    let step = frame.edge() / (1 << 20) as f64;
    // Centres that lie in faces belong to the upper voxel, wherever rounding puts them.
    let turned =
        Affine::new([[0.0, -1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 1.5], [0.0, 0.0, 1.0, 0.5 * step]]).unwrap();
    for placement in [Affine::IDENTITY, turned] {
        let there = records.view().placed_by_centres(&placement, &frame, &limited).unwrap();
        let most = if placement == Affine::IDENTITY { 2 } else { 200 };
        assert!((1..=most).contains(&there.view().len()), "{}", there.view().len());
    }
    // The determinant is -2^-60, which is zero in doubles.
    let small = 2f64.powi(-30);
    let flat = [[1.0 + small, 1.0, 0.0, 0.0], [1.0, 1.0 - small, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    let found = records.view().placed_by_centres(&Affine::new(flat).unwrap(), &frame, &limited);
    assert!(matches!(found, Err(Error::Argument { name: "placement", .. })), "{found:?}");
}
