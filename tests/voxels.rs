//! Voxel records, against recursion over dense arrays and against searches without order.

mod common;

use common::{Dense, Random, alone, cases, lattice_frame, shapes};
use leafless::{
    Attribute, Bounds, Cell, Control, Criterion, Csg, Detail, Error, Frame, FunctionAttribute, Interval,
    LinearCode, Octree, Proof, Rule, Tag, ValueRange, VoxelBoundary, VoxelKind, VoxelOptions, VoxelRecord,
    VoxelRecords, VoxelRecordsRef, Voxels, build,
};
use proptest::prelude::*;
use std::sync::atomic::AtomicBool;

/// Two numbers that change everywhere, and none in a corner.
fn slope() -> impl Attribute {
    let at = |p: [f64; 3]| p[0] * p[0] + 3.0 * p[1] - 0.5 * p[2];
    let function = move |p: [f64; 3]| (p[0] + p[1] > 0.5).then(|| [at(p), p[2], 0.0, 0.0]);
    FunctionAttribute::new(2, function).unwrap().with_range(|bounds: &Bounds| {
        let (low, high) = (bounds.min, bounds.max);
        if low[0] + low[1] <= 0.5 || low[0] < 0.0 {
            return ValueRange::Unknown;
        }
        let first = Interval {
            lower: low[0] * low[0] + 3.0 * low[1] - 0.5 * high[2] - 1e-9,
            upper: high[0] * high[0] + 3.0 * high[1] - 0.5 * low[2] + 1e-9,
        };
        ValueRange::Within([first, Interval { lower: low[2], upper: high[2] }, first, first])
    })
}

/// What the list must be, by its definition.
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
    /// Whether the neighbour of a finest cell of the boundary level lies outside.
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

/// The arrays are accepted, and nothing else like them.
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

/// What is found by code is what is found by looking at each.
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
        let range = Interval { lower: all as u8 as f64, upper: any as u8 as f64 };
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
    assert!(matches!(of(&VoxelOptions::new(), &small), Err(Error::Limit { what: "bytes", limit: 1000 })));
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
