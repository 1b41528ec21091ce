//! Octrees that are split on demand: compared with dense recursion over the same cells, counted, limited,
//! cancelled, frozen and resumed.

use leafless::lattice::Cube;
use leafless::op::{Refinement, Zone};
use leafless::solid::{Fingerprint, OneByOne, Parts, Question, SplitCounter, WholeQuestion};
use leafless::{
    AnySolid, Callback, Cell, Classifier, Control, Csg, Error, FillRule, Frame, LazyOctree, Membership,
    MeshSolid, Metadata, Octree, Proof, Rule, Solid, Tag, TriangleMesh, Verdict, Worker, build, compact,
    file,
};
use leafless_testkit::cubes::{Cubes, Plain};
use leafless_testkit::{
    Dense, Random, alone, assert_is, cases, lattice_frame, noise, positions, repeated, shapes,
};
use proptest::prelude::*;
use std::collections::HashSet;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

// ---- a solid that finds out late ------------------------------------------------------------------------

/// A dense array as a solid that sometimes recognises uniform cells only after splits. Its parts lie in
/// scratch memory.
#[derive(Clone, Copy)]
struct Late<'a> {
    dense: &'a Dense,
    seed: u8,
}

/// The solid's classifier on a frame.
#[derive(Clone, Copy)]
struct LateOnFrame<'a> {
    late: Late<'a>,
    frame: Frame,
}

/// The solid's worker, with the cells that parts stand for.
struct Cells<'a> {
    late: Late<'a>,
    frame: Frame,
    cells: Vec<Cell>,
}

impl Late<'_> {
    fn says(&self, cell: Cell) -> Verdict<()> {
        let agreed = self.dense.tag_of(cell);
        let sees = cell.level == self.dense.depth
            || !noise(self.seed, cell.at.map(|a| a + 977 * u32::from(cell.level))).is_multiple_of(3);
        match agreed.filter(|_| sees) {
            Some(Tag::Empty) => Verdict::Empty,
            Some(Tag::Full) => Verdict::Full,
            Some(_) => Verdict::Undecided,
            None => Verdict::Partial(()),
        }
    }
}

impl<'a> Solid for Late<'a> {
    type Classifier = LateOnFrame<'a>;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<LateOnFrame<'a>, Error> {
        Ok(LateOnFrame { late: *self, frame: *frame })
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let tags: Vec<u8> = self.dense.tags.iter().map(|&tag| tag as u8).chain([self.seed]).collect();
        Some(Fingerprint::of_bytes(&tags))
    }
}

impl<'a> Classifier for LateOnFrame<'a> {
    type Worker = Cells<'a>;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<Cells<'a>, Error> {
        Ok(Cells { late: self.late, frame: self.frame, cells: Vec::new() })
    }

    fn exterior(&self) -> Tag {
        Tag::Empty
    }

    fn proof(&self) -> Proof {
        Proof::CERTIFIED
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

impl Cells<'_> {
    fn verdict(&mut self, cell: Cell) -> Verdict<usize> {
        match self.late.says(cell) {
            Verdict::Empty => Verdict::Empty,
            Verdict::Full => Verdict::Full,
            Verdict::Undecided => Verdict::Undecided,
            Verdict::Partial(()) => {
                self.cells.push(cell);
                Verdict::Partial(self.cells.len() - 1)
            }
        }
    }
}

impl Parts for Cells<'_> {
    type Part = usize;

    fn mark(&self) -> usize {
        self.cells.len()
    }

    fn release(&mut self, mark: usize) {
        assert!(mark <= self.cells.len());
        self.cells.truncate(mark);
    }

    fn scratch_bytes(&self) -> usize {
        0
    }

    fn hand_over(&mut self, from: &Self, part: &usize) -> Result<usize, Error> {
        self.cells.push(from.cells[*part]);
        Ok(self.cells.len() - 1)
    }
}

impl OneByOne for Cells<'_> {}

impl Worker for Cells<'_> {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<usize>, Error> {
        Ok(self.verdict(Cell::ROOT))
    }

    fn split(&mut self, cell: Cell, part: &usize) -> Result<[Verdict<usize>; 8], Error> {
        assert_eq!(self.cells[*part], cell, "a part that is gone");
        assert!(cell.level < self.late.dense.depth);
        Ok([0, 1, 2, 3, 4, 5, 6, 7].map(|k| self.verdict(cell.child(k))))
    }

    fn answer(&mut self, _: Cell, _: &usize, _: Question<'_>) -> Result<(), Error> {
        Ok(())
    }
}

// ---- expected results -----------------------------------------------------------------------------------

/// A model of a lazy octree that remembers only which cells were split.
struct Model<'a> {
    solid: &'a Late<'a>,
    split: HashSet<Cell>,
    /// True if the octree was resumed. It no longer remembers which cells cannot be improved by splits.
    resumed: bool,
    /// Number of splits that a resumed octree does not count.
    before: usize,
}

impl Model<'_> {
    fn known(&self, at: [u32; 3]) -> Tag {
        let depth = self.solid.dense.depth;
        let mut level = 0;
        loop {
            let cell = Cell { level, at: at.map(|a| a >> (depth - level)) };
            match self.solid.says(cell) {
                Verdict::Partial(()) if self.split.contains(&cell) => level += 1,
                verdict => return verdict.tag(),
            }
        }
    }

    fn dense(&self) -> Dense {
        Dense::from_fn(self.solid.dense.depth, |at| self.known(at))
    }

    /// True if a cell can be split now.
    fn is_open(&self, cell: Cell) -> bool {
        let split = |level: u8| {
            let at = cell.at.map(|a| a >> (cell.level - level));
            self.split.contains(&Cell { level, at })
        };
        self.solid.says(cell) == Verdict::Partial(())
            && !self.split.contains(&cell)
            && (0..cell.level).all(split)
            && cell.level < self.solid.dense.depth
    }

    /// Splits the open cells of a zone above `level`, all of them or those of one level; at most `left`
    /// cells.
    fn refine(&mut self, zone: &Zone, only: Option<u8>, level: u8, left: &mut u64) -> bool {
        let mut stack = vec![Cell::ROOT];
        while let Some(cell) = stack.pop() {
            if cell.level == level || !meets(zone, self.solid.dense.depth, cell) {
                continue;
            }
            if self.is_open(cell) && only.is_none_or(|only| only == cell.level) {
                if *left == 0 {
                    return false;
                }
                *left -= 1;
                self.split.insert(cell);
            }
            if self.split.contains(&cell) {
                stack.extend((0..8).rev().map(|k| cell.child(k)));
            }
        }
        true
    }

    fn refine_all(&mut self, zone: &Zone, level: u8) {
        let mut left = u64::MAX;
        assert!(self.refine(zone, None, level, &mut left));
    }

    /// Removes the splits that freezing forgets: splits that decided nothing.
    fn forget(&mut self) {
        let dense = self.dense();
        self.split.retain(|&cell| dense.tag_of(cell) != Some(Tag::Partial));
        (self.resumed, self.before) = (true, self.split.len());
    }
}

/// A fraction with a positive denominator.
#[derive(Clone, Copy)]
struct Fraction(i128, i128);

impl Fraction {
    fn at_most(self, other: Fraction) -> bool {
        self.0 * other.1 <= other.0 * self.1
    }
}

/// True if a zone has the cell, by its documentation. Coordinates are multiples of ½ and not large.
fn meets(zone: &Zone, depth: u8, cell: Cell) -> bool {
    let size = 1u32 << (depth - cell.level);
    let low = cell.at.map(|a| (a * size) as f64);
    let (high, end) = (low.map(|a| a + size as f64), (1u32 << depth) as f64);
    // A thin box and a point lie in the upper cell, but for the last one's.
    let holds = |axis: usize, x: f64| low[axis] <= x && (x < high[axis] || x == end && high[axis] == end);
    match *zone {
        Zone::Whole => true,
        Zone::Point(point) => (0..3).all(|axis| holds(axis, point[axis])),
        Zone::Box { min, max } => (0..3).all(|axis| match min[axis] == max[axis] {
            true => holds(axis, min[axis]),
            false => low[axis] < max[axis] && min[axis] < high[axis],
        }),
        Zone::Ray { origin, direction, from, to } => {
            let whole = |x: f64| (2.0 * x) as i128;
            let bound = |t: f64| {
                if t.is_finite() { Fraction(whole(t), 2) } else { Fraction(whole(t.signum() * 1e6), 1) }
            };
            let (mut enters, mut leaves) = (bound(from), bound(to));
            for axis in 0..3 {
                let (o, d) = (whole(origin[axis]), whole(direction[axis]));
                let (l, h) = (whole(low[axis]), whole(high[axis]));
                if d == 0 {
                    if o < l || h < o {
                        return false;
                    }
                    continue;
                }
                let at = |x: i128| Fraction((x - o) * d.signum(), d.abs());
                let (near, far) = if d > 0 { (at(l), at(h)) } else { (at(h), at(l)) };
                if enters.at_most(near) {
                    enters = near;
                }
                if far.at_most(leaves) {
                    leaves = far;
                }
            }
            enters.at_most(leaves)
        }
    }
}

/// One call of the interface.
#[derive(Debug, Clone)]
enum Call {
    Split(u8, [u32; 3]),
    Refine(Zone, u8, Option<u64>),
    Resume,
}

fn zones() -> impl Strategy<Value = Zone> {
    let point = || [0..=68i32, 0..=68, 0..=68].prop_map(|p| p.map(|c| f64::from(c - 2) * 0.5));
    let ray = (point(), [-6..=6i32, -6..=6, -6..=6], -40..40i32, 0..60i32, 0..8u8);
    prop_oneof![
        Just(Zone::Whole),
        point().prop_map(Zone::Point),
        (point(), point()).prop_map(|(a, b)| Zone::Box {
            min: [0, 1, 2].map(|axis| a[axis].min(b[axis])),
            max: [0, 1, 2].map(|axis| a[axis].max(b[axis])),
        }),
        ray.prop_map(|(origin, direction, from, length, ends)| {
            let direction = if direction == [0; 3] { [1, 0, 0] } else { direction };
            Zone::Ray {
                origin,
                direction: direction.map(f64::from),
                from: if ends & 1 != 0 { f64::NEG_INFINITY } else { f64::from(from) * 0.5 },
                to: if ends & 2 != 0 { f64::INFINITY } else { f64::from(from + length) * 0.5 },
            }
        }),
    ]
}

fn calls() -> impl Strategy<Value = Vec<Call>> {
    let split = (0..6u8, any::<[u32; 3]>()).prop_map(|(level, at)| Call::Split(level, at));
    let budget = prop_oneof![2 => Just(None), 1 => (0..40u64).prop_map(Some)];
    let refine = (zones(), 0..6u8, budget).prop_map(|(zone, level, most)| Call::Refine(zone, level, most));
    let call = prop_oneof![4 => split, 6 => refine, 1 => Just(Call::Resume)];
    proptest::collection::vec(call, 0..16)
}

/// Compares everything that an octree reports about itself.
fn compare(lazy: &LazyOctree<'_>, model: &Model<'_>) {
    let depth = lazy.frame().depth();
    let dense = model.dense();
    let octree = lazy.freeze(&alone()).unwrap();
    assert_is(&octree, &dense);
    assert_eq!(octree, dense.octree());
    assert_eq!(lazy.splits(), (model.split.len() - model.before) as u64);
    assert_eq!((0..depth).map(|level| lazy.splits_at(level)).sum::<u64>(), lazy.splits());
    if !model.resumed {
        for level in 0..depth {
            let expected = model.split.iter().filter(|cell| cell.level == level).count();
            assert_eq!(lazy.splits_at(level), expected as u64);
        }
    }
    let (ours, frozen) = (lazy.statistics(), octree.statistics());
    for (ours, frozen) in ours.levels().iter().zip(frozen.levels()) {
        assert_eq!((ours.lower_cells, ours.upper_cells), (frozen.lower_cells, frozen.upper_cells));
        assert_eq!(ours.volume, frozen.volume);
        assert!(ours.nodes >= frozen.nodes);
    }
    assert_eq!(lazy.frame(), octree.frame());
    for at in positions(depth) {
        let (cell, tag) = (Cell { level: depth, at }, dense.at(at));
        assert_eq!(lazy.tag(cell), tag);
        assert!(!lazy.can_split(cell));
        let middle = at.map(|a| f64::from(a) + 0.5);
        assert_eq!(lazy.contains(middle), Membership::from(tag));
    }
    for level in 0..depth {
        for at in positions(level) {
            let cell = Cell { level, at };
            let expected = dense.tag_of(cell).unwrap_or(Tag::Branch);
            let tag = lazy.tag(cell);
            // A cell that was split and is undecided in all its children was split.
            assert!(tag == expected || tag == Tag::Branch && expected == Tag::Partial);
            if !model.resumed {
                assert_eq!(lazy.can_split(cell), model.is_open(cell));
            }
        }
    }
}

fn refuse_split(lazy: &mut LazyOctree<'_>, cell: Cell) {
    assert!(matches!(lazy.split(cell), Err(Error::Argument { name: "cell", .. })), "{cell:?}");
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn any_calls_know_what_they_asked(shape in shapes(1..=4), seed in any::<u8>(), calls in calls()) {
        let dense = shape.dense();
        let depth = dense.depth;
        let frame = lattice_frame(depth);
        let solid = Late { dense: &dense, seed };
        let mut model = Model { solid: &solid, split: HashSet::new(), resumed: false, before: 0 };
        let mut lazy = LazyOctree::new(solid, &frame).unwrap();
        for call in calls {
            let before = lazy.splits();
            match call {
                Call::Split(level, at) => {
                    let cell = Cell { level, at: at.map(|a| a % (1 << level)) };
                    if level >= depth {
                        refuse_split(&mut lazy, cell);
                        continue;
                    }
                    let known = model.dense();
                    let covered = (0..level).find(|&level| {
                        let above = Cell { level, at: cell.at.map(|a| a >> (cell.level - level)) };
                        model.is_open(above)
                    });
                    if covered.is_some() {
                        refuse_split(&mut lazy, cell);
                        continue;
                    }
                    let opens = model.is_open(cell);
                    if opens {
                        model.split.insert(cell);
                    }
                    let tags = match lazy.split(cell) {
                        Err(Error::Argument { .. }) if model.resumed && !opens => continue,
                        tags => tags.unwrap(),
                    };
                    assert_eq!(lazy.splits() - before, opens as u64);
                    let known = if opens { model.dense() } else { known };
                    for octant in 0..8 {
                        let expected = known.tag_of(cell.child(octant)).unwrap_or(Tag::Branch);
                        let tag = tags[octant as usize];
                        assert!(tag == expected || tag == Tag::Branch && expected == Tag::Partial);
                    }
                    // A second split costs nothing.
                    let again = lazy.split(cell).unwrap();
                    assert_eq!(again, tags);
                    assert_eq!(lazy.splits() - before, opens as u64);
                }
                Call::Refine(zone, level, most) => {
                    let control = Control { max_splits: most, ..alone() };
                    if level > depth {
                        let refused = lazy.refine(&zone, level, &control);
                        assert!(matches!(refused, Err(Error::Argument { name: "level", .. })));
                        continue;
                    }
                    let done = lazy.refine(&zone, level, &control).unwrap();
                    let mut left = most.unwrap_or(u64::MAX);
                    let by_level = most.is_some() && !matches!(zone, Zone::Ray { .. });
                    if by_level {
                        let all = (0..level).all(|only| model.refine(&zone, Some(only), level, &mut left));
                        // A resumed octree does not know which cells splitting does not help, and may end at
                        // one.
                        let forgot = model.resumed && left == 0;
                        assert!((done == Refinement::Done) == all || all && forgot);
                    } else if most.is_none() {
                        assert!(model.refine(&zone, None, level, &mut left) && done == Refinement::Done);
                    } else {
                        // Another test checks the order along a ray.
                        assert!(lazy.splits() - before <= most.unwrap());
                        assert_eq!(lazy.refine(&zone, level, &alone()).unwrap(), Refinement::Done);
                        model.refine_all(&zone, level);
                    }
                }
                Call::Resume => {
                    let octree = lazy.freeze(&alone()).unwrap();
                    let octree = file::from_bytes(&file::to_bytes(&octree).unwrap()).unwrap();
                    lazy = LazyOctree::resume(&octree, solid, &frame, &alone()).unwrap();
                    model.forget();
                }
            }
        }
        compare(&lazy, &model);
        // Nothing more remains.
        assert_eq!(lazy.refine(&Zone::Whole, depth, &alone()).unwrap(), Refinement::Done);
        model.refine_all(&Zone::Whole, depth);
        compare(&lazy, &model);
        assert_eq!(lazy.freeze(&alone()).unwrap(), dense.octree());
        // The remaining nodes are cells that differ, at most eight to a block, and the universe's own block.
        let nodes = lazy.statistics().nodes();
        assert!(lazy.bytes() <= 64 * (nodes + 1));
    }
}

// ---- real solids ----------------------------------------------------------------------------------------

fn tetrahedron() -> TriangleMesh {
    let vertices = vec![[0.1, 0.2, 0.3], [0.9, 0.1, 0.2], [0.3, 0.8, 0.1], [0.4, 0.3, 0.9]];
    TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap()
}

/// Solids of every kind.
fn solids(frame: &Frame) -> Vec<AnySolid> {
    let stored = build(&Csg::ball([0.5; 3], 0.4).unwrap(), frame, Rule::Certified, &alone()).unwrap();
    let open = {
        let mesh = tetrahedron();
        TriangleMesh::new(mesh.vertices().to_vec(), mesh.triangles()[..3].to_vec()).unwrap()
    };
    // Half-spaces, and solids whose parts contain other data.
    let mesh = AnySolid::new(MeshSolid::new(tetrahedron(), FillRule::NonZero).unwrap());
    let ball = Csg::ball([0.4; 3], 0.3).unwrap();
    let mixed = Csg::solid(mesh).difference(&ball).unwrap();
    let mixed = Csg::xor_of([mixed, Csg::solid(AnySolid::new(stored.clone()))]).unwrap();
    vec![
        AnySolid::new(Csg::ball([0.4, 0.5, 0.6], 0.37).unwrap()),
        AnySolid::new(Csg::cuboid([0.25, 0.1, 0.3], [0.75, 0.5, 0.9]).unwrap()),
        AnySolid::new(Csg::half_space([1.0, 2.0, -0.5], -1.2).unwrap()),
        AnySolid::new(mixed),
        AnySolid::new(MeshSolid::new(tetrahedron(), FillRule::NonZero).unwrap()),
        AnySolid::new(MeshSolid::new(open, FillRule::NonZero).unwrap()),
        AnySolid::new(stored),
        AnySolid::new(slab().with_fingerprint(Fingerprint::of_bytes(b"slab"))),
        AnySolid::new(AnySolid::new(Csg::ball([0.1; 3], 0.3).unwrap())),
    ]
}

/// A function that classifies boxes.
type Classify<'a> = Box<dyn Fn([f64; 3], [f64; 3]) -> Result<Verdict<()>, Error> + Send + Sync + 'a>;

fn callback<'a>(
    classify: impl Fn([f64; 3], [f64; 3]) -> Result<Verdict<()>, Error> + Send + Sync + 'a,
) -> Callback<'a, Classify<'a>> {
    Callback::new(Box::new(classify))
}

/// The slab 0.3 ≤ z ≤ 0.7, given by verdicts on boxes.
fn slab() -> Callback<'static, Classify<'static>> {
    callback(|min, max| {
        Ok(match (min[2], max[2]) {
            (low, high) if high <= 0.3 || low >= 0.7 => Verdict::Empty,
            (low, high) if low >= 0.3 && high <= 0.7 => Verdict::Full,
            _ => Verdict::Partial(()),
        })
    })
}

fn unit_frame(depth: u8) -> Frame {
    Frame::new([0.0; 3], 1.0, depth).unwrap()
}

/// The bytes of a file without facts.
fn bytes(octree: &Octree) -> Vec<u8> {
    file::to_bytes(&octree.with_metadata(Metadata::new())).unwrap()
}

#[test]
fn a_full_refinement_is_the_build_bit_for_bit() {
    for depth in [1, 2, 3, 6, 7] {
        let frame = unit_frame(depth);
        for (i, solid) in solids(&frame).into_iter().enumerate() {
            let built = build(&solid, &frame, Rule::Certified, &alone()).unwrap();
            let mut lazy = LazyOctree::new(solid.clone(), &frame).unwrap();
            assert_eq!(lazy.refine(&Zone::Whole, depth, &alone()).unwrap(), Refinement::Done);
            let frozen = lazy.freeze(&alone()).unwrap();
            assert_eq!(bytes(&frozen), bytes(&built), "solid {i}, depth {depth}");
            assert_eq!(frozen.view().exterior(), built.view().exterior());
            assert_eq!(bytes(&lazy.freeze(&Control::threads(2)).unwrap()), bytes(&built));
            // In a single pass nothing is queried twice.
            assert_eq!(lazy.replays(), 0);

            // Step by step, in an order that goes back.
            let mut lazy = LazyOctree::new(solid.clone(), &frame).unwrap();
            for level in 0..=depth {
                for at in positions(level.min(2)).collect::<Vec<_>>().into_iter().rev() {
                    let size = 1.0 / f64::from(1u32 << level.min(2));
                    let (min, max) = (at.map(|a| f64::from(a) * size), at.map(|a| f64::from(a + 1) * size));
                    lazy.refine(&Zone::Box { min, max }, level, &alone()).unwrap();
                }
            }
            assert_eq!(bytes(&lazy.freeze(&alone()).unwrap()), bytes(&built), "solid {i}, depth {depth}");
        }
    }
}

#[test]
fn an_octree_that_is_taken_up_again_goes_on() {
    let (coarse, frame) = (unit_frame(4), unit_frame(7));
    let known = solids(&frame).into_iter().filter(|solid| solid.fingerprint().is_some());
    for (i, solid) in known.enumerate() {
        let mut direct = LazyOctree::new(solid.clone(), &frame).unwrap();
        let corner = Zone::Box { min: [0.2, 0.3, 0.1], max: [0.6, 0.45, 0.9] };
        direct.refine(&corner, 5, &alone()).unwrap();
        let frozen = direct.freeze(&alone()).unwrap();
        let source = frozen.metadata().get("source").unwrap().to_string();
        assert_eq!(source, solid.fingerprint().unwrap().to_string());
        let loaded = file::from_bytes(&file::to_bytes(&frozen).unwrap()).unwrap();
        let mut resumed = LazyOctree::resume(&loaded, solid.clone(), &frame, &alone()).unwrap();
        assert_eq!(resumed.splits(), 0);
        for (zone, level) in [(corner, 7), (Zone::Point([0.7; 3]), 7), (Zone::Whole, 6), (Zone::Whole, 7)] {
            for lazy in [&mut direct, &mut resumed] {
                assert_eq!(lazy.refine(&zone, level, &alone()).unwrap(), Refinement::Done);
            }
            let (a, b) = (direct.freeze(&alone()).unwrap(), resumed.freeze(&alone()).unwrap());
            assert_eq!(file::to_bytes(&a).unwrap(), file::to_bytes(&b).unwrap(), "solid {i}, {zone:?}");
        }
        assert!(resumed.splits() < direct.splits() || i == 5);
        // Compact arrays are the same octree.
        let coded = compact(loaded.view()).unwrap().with_metadata(loaded.metadata().clone());
        LazyOctree::resume(&coded, solid, &frame, &alone()).unwrap();
    }
    // From a shallow frame to a deep one.
    for solid in [
        AnySolid::new(Csg::ball([0.4, 0.5, 0.6], 0.37).unwrap()),
        AnySolid::new(MeshSolid::new(tetrahedron(), FillRule::NonZero).unwrap()),
    ] {
        let mut lazy = LazyOctree::new(solid.clone(), &coarse).unwrap();
        lazy.refine(&Zone::Whole, 4, &alone()).unwrap();
        let shallow = lazy.freeze(&alone()).unwrap();
        let mut lazy = LazyOctree::resume(&shallow, solid.clone(), &frame, &alone()).unwrap();
        assert_eq!(lazy.statistics().volume_cells().0, shallow.statistics().volume_cells().0 << 9);
        lazy.refine(&Zone::Whole, 7, &alone()).unwrap();
        let built = build(&solid, &frame, Rule::Certified, &alone()).unwrap();
        assert_eq!(bytes(&lazy.freeze(&alone()).unwrap()), bytes(&built));
    }
}

#[test]
fn depths_one_and_twenty() {
    let ball = Csg::ball([0.4, 0.5, 0.6], 0.37).unwrap();
    let mut lazy = LazyOctree::new(ball.clone(), &unit_frame(1)).unwrap();
    assert!(lazy.can_split(Cell::ROOT));
    assert_eq!(lazy.split(Cell::ROOT).unwrap(), [Tag::Partial; 8]);
    assert_eq!((lazy.splits(), lazy.tag(Cell::ROOT)), (1, Tag::Branch));
    assert_eq!(lazy.freeze(&alone()).unwrap().view().root_tag(), Tag::Partial);

    let frame = unit_frame(20);
    let mut lazy = LazyOctree::new(ball.clone(), &frame).unwrap();
    let surface = [0.4 + 0.37, 0.5, 0.6];
    for point in [surface, [0.4, 0.5, 0.6], [0.0; 3], [1.0; 3]] {
        let before = lazy.splits();
        assert_eq!(lazy.refine(&Zone::Point(point), 20, &alone()).unwrap(), Refinement::Done);
        assert!(lazy.splits() - before <= 20);
        let found = lazy.contains(point);
        let expected = if point == [0.4, 0.5, 0.6] { Membership::Inside } else { Membership::Outside };
        assert!(found == expected || point == surface);
    }
    let ray =
        Zone::Ray { origin: [-1.0, 0.45, 0.55], direction: [1.0, 0.01, 0.02], from: 0.0, to: f64::INFINITY };
    lazy.refine(&ray, 20, &alone()).unwrap();
    assert!(lazy.splits() < 1000, "{}", lazy.splits());
    let frozen = lazy.freeze(&alone()).unwrap();
    frozen.view().check().unwrap();
    let truth = 4.0 / 3.0 * std::f64::consts::PI * 0.37f64.powi(3);
    assert!(frozen.statistics().volume().contains(truth));
    let mut resumed = LazyOctree::resume(&frozen, &ball, &frame, &alone()).unwrap();
    let before = resumed.splits();
    resumed.refine(&ray, 20, &alone()).unwrap();
    assert_eq!(resumed.splits(), before);
}

#[test]
fn what_is_no_cell_is_refused() {
    let mut lazy = LazyOctree::new(Csg::ball([0.5; 3], 0.4).unwrap(), &unit_frame(3)).unwrap();
    let cell = |level, at| Cell { level, at };
    for (at, problem) in [
        (cell(0, [1, 0, 0]), "none of"),
        (cell(2, [0, 4, 0]), "none of"),
        (cell(4, [0; 3]), "none of"),
        (cell(255, [u32::MAX; 3]), "none of"),
        (cell(3, [7; 3]), "depth"),
        (cell(1, [1; 3]), "still to be split"),
        (cell(2, [3; 3]), "still to be split"),
    ] {
        let error = lazy.split(at).unwrap_err().to_string();
        assert!(error.contains(problem), "{at:?}: {error}");
        assert!(!lazy.can_split(at));
        assert_eq!(lazy.tag(at), Tag::Partial);
    }
    let nothing = lazy.refine(&Zone::Point([2.0; 3]), 3, &alone()).unwrap();
    assert_eq!((nothing, lazy.splits()), (Refinement::Done, 0));
    assert_eq!(lazy.contains([f64::NAN; 3]), Membership::Undecided);
    assert_eq!(lazy.contains([2.0; 3]), Membership::Undecided);
    // A cell in a decided one has its tag.
    lazy.refine(&Zone::Whole, 3, &alone()).unwrap();
    let mut inside = LazyOctree::new(Csg::cuboid([0.0; 3], [0.5; 3]).unwrap(), &unit_frame(3)).unwrap();
    let [full, others @ ..] = inside.split(Cell::ROOT).unwrap();
    assert_eq!((full, others), (Tag::Full, [Tag::Empty; 7]));
    assert_eq!(inside.split(cell(2, [1; 3])).unwrap(), [Tag::Full; 8]);
    assert_eq!(inside.split(cell(2, [2; 3])).unwrap(), [Tag::Empty; 8]);
    assert_eq!(inside.splits(), 1);
}

// ---- counted --------------------------------------------------------------------------------------------

/// The ball of radius 0.4 around the middle, given by verdicts on boxes.
fn round(min: [f64; 3], max: [f64; 3]) -> Verdict<()> {
    let (mut near, mut far) = (0.0, 0.0);
    for axis in 0..3 {
        let (low, high) = (min[axis] - 0.5, max[axis] - 0.5);
        far += f64::max(low * low, high * high);
        near += f64::max(0.0, f64::max(low, -high)).powi(2);
    }
    match (near, far) {
        (_, far) if far <= 0.16 => Verdict::Full,
        (near, _) if near >= 0.16 => Verdict::Empty,
        _ => Verdict::Partial(()),
    }
}

/// The same ball as a solid that recomputes parts by splits. It records every queried box.
#[derive(Clone)]
struct Noted<'a>(&'a Mutex<Vec<([f64; 3], [f64; 3])>>);

impl Cubes for Noted<'_> {
    fn verdict(&self, cube: &Cube<'_>) -> Result<Verdict<()>, Error> {
        let (min, max) = cube.bounds();
        self.0.lock().unwrap().push((min, max));
        Ok(round(min, max))
    }
}

leafless_testkit::solid_of_cubes!(Noted<'a>: 'a);

#[test]
fn only_cells_that_matter_are_asked_about() {
    let asked = Mutex::new(vec![]);
    let mut lazy = LazyOctree::new(Noted(&asked), &unit_frame(10)).unwrap();
    let taken = || std::mem::take(&mut *asked.lock().unwrap());
    assert_eq!(taken().len(), 1);

    // A point: one cell at each level is split, and its children are queried.
    let point = [0.5, 0.8, 0.76];
    lazy.refine(&Zone::Point(point), 10, &alone()).unwrap();
    let boxes = taken();
    assert_eq!(boxes.len() as u64, 8 * (lazy.splits() + lazy.replays()));
    assert!(lazy.splits() <= 10 && lazy.replays() == 0);
    for siblings in boxes.chunks_exact(8) {
        let (low, high) = (siblings[0].0, siblings[7].1);
        assert!((0..3).all(|axis| low[axis] <= point[axis] && point[axis] <= high[axis]));
    }
    // A repeated call costs nothing.
    let splits = lazy.splits();
    lazy.refine(&Zone::Point(point), 10, &alone()).unwrap();
    assert!(taken().is_empty() && lazy.splits() == splits);

    // A box: every parent meets it.
    let (min, max) = ([0.1, 0.4, 0.1], [0.2, 0.6, 0.2]);
    lazy.refine(&Zone::Box { min, max }, 7, &alone()).unwrap();
    let boxes = taken();
    let (splits, replays) = (lazy.splits() - splits, lazy.replays());
    assert_eq!(boxes.len() as u64, 8 * (splits + replays));
    for siblings in boxes.chunks_exact(8) {
        let (low, high) = (siblings[0].0, siblings[7].1);
        assert!((0..3).all(|axis| low[axis] < max[axis] && min[axis] < high[axis]));
    }
    // Only the splits on the way are computed anew.
    assert!(replays <= 3, "{replays}");

    // Cell by cell along a line: neighbours share their ancestors.
    let mut lazy = LazyOctree::new(Noted(&asked), &unit_frame(6)).unwrap();
    let mut queue = std::collections::VecDeque::from([Cell::ROOT]);
    while let Some(cell) = queue.pop_front() {
        let tags = lazy.split(cell).unwrap();
        let next = (0..8).filter(|&k| tags[k as usize] == Tag::Partial).map(|k| cell.child(k));
        queue.extend(next.filter(|child| child.level < 6));
    }
    let all = lazy.freeze(&alone()).unwrap();
    assert_eq!(all.statistics().nodes(), lazy.splits());
    assert!(lazy.replays() < 2 * lazy.splits(), "{} {}", lazy.replays(), lazy.splits());
}

#[test]
fn a_cell_that_nobody_can_split_is_asked_about_once() {
    let coarse = unit_frame(5);
    let ball = build(&Csg::ball([0.5; 3], 0.4).unwrap(), &coarse, Rule::Certified, &alone()).unwrap();
    let mut lazy = LazyOctree::new(*ball.view(), &unit_frame(12)).unwrap();
    lazy.refine(&Zone::Whole, 12, &alone()).unwrap();
    assert_eq!(lazy.splits(), ball.statistics().nodes());
    assert_eq!((lazy.replays(), lazy.splits_at(5), lazy.splits_at(200)), (0, 0, 0));
    let partial = positions(5).find(|&at| ball.view().tag_at(at) == Tag::Partial).unwrap();
    let cell = Cell { level: 5, at: partial };
    assert!(!lazy.can_split(cell));
    assert_eq!(lazy.split(cell).unwrap(), [Tag::Partial; 8]);
    assert_eq!(lazy.splits(), ball.statistics().nodes());
    // A resumed octree forgot it, and queries again.
    let octree = lazy.freeze(&alone()).unwrap();
    let frame = *lazy.frame();
    let mut lazy = LazyOctree::resume(&octree, *ball.view(), &frame, &alone()).unwrap();
    let none = Control { max_splits: Some(0), ..alone() };
    assert_eq!(lazy.refine(&Zone::Whole, 12, &none).unwrap(), Refinement::Spent);
    assert_eq!(lazy.refine(&Zone::Whole, 12, &alone()).unwrap(), Refinement::Done);
    assert_eq!(lazy.refine(&Zone::Whole, 12, &none).unwrap(), Refinement::Done);
    assert_eq!(lazy.splits_at(5), 0);
}

#[test]
fn merged_cells_give_their_memory_back() {
    // The solid is empty, but only the finest cells show it.
    let nothing = || {
        Callback::new(|min: [f64; 3], max: [f64; 3]| {
            Ok(if max[0] - min[0] < 1.5 / 64.0 { Verdict::Empty } else { Verdict::Partial(()) })
        })
    };
    let mut lazy = LazyOctree::new(nothing(), &unit_frame(6)).unwrap();
    let mut most = 0;
    for at in positions(3) {
        let (min, max) = (at.map(|a| f64::from(a) / 8.0), at.map(|a| f64::from(a + 1) / 8.0));
        lazy.refine(&Zone::Box { min, max }, 6, &alone()).unwrap();
        most = most.max(lazy.bytes());
        assert_eq!(lazy.contains(min.map(|a| a + 0.01)), Membership::Outside);
    }
    assert_eq!((lazy.tag(Cell::ROOT), lazy.splits()), (Tag::Empty, (1 << 18) / 7));
    assert_eq!(lazy.statistics().nodes(), 0);
    // The universe's block, and the blocks on the way to unmerged cells: up to 64 of level 3 and 8 of
    // level 2.
    assert_eq!(lazy.bytes(), 64);
    assert!(most <= 64 * (4 + 8 + 1), "{most}");
    // In a single pass only the blocks on the way exist.
    let mut lazy = LazyOctree::new(nothing(), &unit_frame(6)).unwrap();
    let control = Control { max_bytes: Some(64 * 8), ..alone() };
    for _ in 0..3 {
        lazy.refine(&Zone::Ray { origin: [0.0; 3], direction: [1.0; 3], from: 0.0, to: 2.0 }, 6, &control)
            .unwrap();
    }
    assert!(lazy.bytes() <= 64 * 8);
}

#[test]
fn every_question_is_a_split_or_a_replay() {
    let asked = Mutex::new(vec![]);
    let mut lazy = LazyOctree::new(Noted(&asked), &unit_frame(5)).unwrap();
    lazy.refine(&Zone::Whole, 3, &alone()).unwrap();
    lazy.refine(&Zone::Point([0.11, 0.5, 0.5]), 5, &alone()).unwrap();
    assert!(lazy.replays() > 0);
    assert_eq!(asked.lock().unwrap().len() as u64, 1 + 8 * (lazy.splits() + lazy.replays()));
}

#[test]
fn what_depends_on_the_cell_alone_is_never_replayed() {
    let frame = unit_frame(12);
    let mut random = Random(3);
    let points: Vec<[f64; 3]> = (0..200)
        .map(|_| {
            // Near the surface, and anywhere.
            let way = [0; 3].map(|_| random.between(-1.0, 1.0));
            let length = way.iter().map(|w| w * w).sum::<f64>().sqrt();
            let reach = if random.below(4) == 0 { random.between(0.0, 0.49) } else { 0.4 };
            way.map(|w| 0.5 + w / length * reach)
        })
        .collect();
    let calls = AtomicU64::new(0);
    let mut lazy = LazyOctree::new(
        callback(|min, max| {
            calls.fetch_add(1, Ordering::Relaxed);
            Ok(round(min, max))
        }),
        &frame,
    )
    .unwrap();
    let asked = Mutex::new(vec![]);
    let mut replayed = LazyOctree::new(Noted(&asked), &frame).unwrap();
    for &point in &points {
        for level in [12, 7, 12] {
            lazy.refine(&Zone::Point(point), level, &alone()).unwrap();
            replayed.refine(&Zone::Point(point), level, &alone()).unwrap();
        }
        assert_eq!(calls.load(Ordering::Relaxed), 8 * lazy.splits() + 1);
        assert_eq!(lazy.replays(), 0);
    }
    assert!(lazy.splits() > 500 && lazy.splits() == replayed.splits(), "{}", lazy.splits());
    // A solid that has to replay splits comes to the same.
    assert!(replayed.replays() > 0);
    assert_eq!(bytes(&lazy.freeze(&alone()).unwrap()), bytes(&replayed.freeze(&alone()).unwrap()));
    // The same result cell by cell, in any order.
    let mut lazy = LazyOctree::new(Plain::ball([0.5; 3], 0.4).unwrap(), &unit_frame(5)).unwrap();
    let mut open = vec![Cell::ROOT];
    while !open.is_empty() {
        let cell = open.swap_remove(random.below(open.len() as u64) as usize);
        let tags = lazy.split(cell).unwrap();
        let next = (0..8).filter(|&k| tags[k as usize] == Tag::Partial).map(|k| cell.child(k));
        open.extend(next.filter(|child| child.level < 5));
    }
    assert_eq!(lazy.replays(), 0);
    let built = build(lazy.solid(), &unit_frame(5), Rule::Certified, &alone()).unwrap();
    assert_eq!(bytes(&lazy.freeze(&alone()).unwrap()), bytes(&built));
}

#[test]
fn evaluations_are_counted_by_the_expression() {
    let ball = Csg::ball([0.5; 3], 0.4).unwrap();
    let bite = Csg::half_space([1.0, 0.5, -0.25], -0.6).unwrap();
    let solid = ball.difference(&bite).unwrap();
    let clone = solid.clone();
    let counted = SplitCounter::new(solid.clone());
    let (mut last, mut each) = (0, None);
    for _ in 0..3 {
        let splits = counted.splits().iter().sum::<u64>();
        let mut lazy = LazyOctree::new(&counted, &unit_frame(5)).unwrap();
        lazy.refine(&Zone::Whole, 3, &alone()).unwrap();
        lazy.refine(&Zone::Point([0.11, 0.5, 0.5]), 5, &alone()).unwrap();
        assert!(lazy.replays() > 0);
        let asked = lazy.splits() + lazy.replays();
        assert_eq!(counted.splits().iter().sum::<u64>() - splits, asked);
        // The counts are known once the octree and its worker are dropped.
        drop(lazy);
        // A split cell has an open half-space and eight children.
        assert!(solid.evaluations() - last >= asked, "{} {last} {asked}", solid.evaluations());
        // The work is the same each time, and the clone shares the counter.
        let more = solid.evaluations() - last;
        assert_eq!(*each.get_or_insert(more), more);
        last += more;
        assert_eq!(clone.evaluations(), last);
    }
    assert_eq!((ball.evaluations(), bite.evaluations()), (0, 0));
}

// ---- limited and cancelled ------------------------------------------------------------------------------

#[test]
fn limits_stop_the_work_and_lose_nothing() {
    let frame = unit_frame(6);
    for solid in solids(&frame) {
        let mut direct = LazyOctree::new(solid.clone(), &frame).unwrap();
        direct.refine(&Zone::Whole, 6, &alone()).unwrap();
        let expected = direct.freeze(&alone()).unwrap();
        for limit in [1, 7, 100] {
            let mut lazy = LazyOctree::new(solid.clone(), &frame).unwrap();
            let mut last = lazy.statistics().volume();
            loop {
                let before = lazy.splits();
                let control = Control { max_splits: Some(limit), ..alone() };
                let done = lazy.refine(&Zone::Whole, 6, &control).unwrap();
                assert!(lazy.splits() - before <= limit);
                let volume = lazy.statistics().volume();
                assert!(last.lower <= volume.lower && volume.upper <= last.upper);
                last = volume;
                if done == Refinement::Done {
                    break;
                }
                assert_eq!(lazy.splits() - before, limit);
                // Coarser cells come first.
                let deepest = (0..6).rev().find(|&level| lazy.splits_at(level) > 0).unwrap();
                for level in 0..deepest {
                    for at in positions(level) {
                        assert!(!lazy.can_split(Cell { level, at }), "{level} {at:?}");
                    }
                }
                if limit < 100 && before > 300 {
                    lazy.refine(&Zone::Whole, 6, &alone()).unwrap();
                }
            }
            assert_eq!(lazy.splits(), direct.splits());
            assert_eq!(lazy.freeze(&alone()).unwrap(), expected);
        }
        // The octree holds no more than the limit.
        for limit in [0, 1, 10, 50] {
            let mut lazy = LazyOctree::new(solid.clone(), &frame).unwrap();
            let control = Control { max_nodes: Some(limit), ..alone() };
            let done = lazy.refine(&Zone::Whole, 6, &control).unwrap();
            assert!(lazy.statistics().nodes() <= limit);
            assert_eq!(done == Refinement::Done, lazy.freeze(&alone()).unwrap() == expected);
            let bytes = 64 * (limit + 1);
            let mut lazy = LazyOctree::new(solid.clone(), &frame).unwrap();
            let control = Control { max_bytes: Some(bytes), ..alone() };
            let done = lazy.refine(&Zone::Whole, 6, &control).unwrap();
            assert!(lazy.bytes() <= bytes);
            assert_eq!(done == Refinement::Done, lazy.freeze(&alone()).unwrap() == expected);
        }
    }
}

#[test]
fn a_ray_is_refined_from_its_beginning_on() {
    let frame = unit_frame(8);
    let ball = Csg::ball([0.5; 3], 0.4).unwrap();
    for direction in [[1.0, 0.125, 0.25], [-1.0, 0.125, -0.25], [-0.5, -1.0, -0.25], [0.125, 0.25, -1.0]] {
        let origin = direction.map(|d: f64| 0.5 - 2.0 * d);
        let zone = Zone::Ray { origin, direction, from: 0.0, to: f64::INFINITY };
        let mut lazy = LazyOctree::new(&ball, &frame).unwrap();
        // Enough splits for the ray's entry, and not for its exit.
        let control = Control { max_splits: Some(24), ..alone() };
        assert_eq!(lazy.refine(&zone, 8, &control).unwrap(), Refinement::Spent);
        let at = |t: f64| [0, 1, 2].map(|axis| origin[axis] + t * direction[axis]);
        let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
        let (enters, leaves) = (2.0 - 0.4 / length, 2.0 + 0.4 / length);
        let reach = 0.02 / length;
        assert_eq!(lazy.contains(at(enters - reach)), Membership::Outside, "{direction:?}");
        assert_eq!(lazy.contains(at(enters + reach)), Membership::Inside, "{direction:?}");
        assert_eq!(lazy.contains(at(leaves - reach)), Membership::Undecided, "{direction:?}");
        assert_eq!(lazy.refine(&zone, 8, &alone()).unwrap(), Refinement::Done);
        assert_eq!(lazy.contains(at(leaves - reach)), Membership::Inside);
        assert_eq!(lazy.contains(at(leaves + reach)), Membership::Outside);
    }
}

#[test]
fn cancelling_keeps_what_was_split() {
    let calls = AtomicU64::new(0);
    let cancelled = AtomicBool::new(false);
    let stop = AtomicU64::new(u64::MAX);
    let shape = || {
        Callback::new(|min, max| {
            if calls.fetch_add(1, Ordering::Relaxed) == stop.load(Ordering::Relaxed) {
                cancelled.store(true, Ordering::Relaxed);
            }
            Ok(round(min, max))
        })
    };
    let frame = unit_frame(5);
    let mut direct = LazyOctree::new(shape(), &frame).unwrap();
    direct.refine(&Zone::Whole, 5, &alone()).unwrap();
    let expected = direct.freeze(&alone()).unwrap();
    for limit in [None, Some(1_000_000)] {
        for after in [0, 1, 9, 100, 1000] {
            calls.store(0, Ordering::Relaxed);
            stop.store(after, Ordering::Relaxed);
            cancelled.store(false, Ordering::Relaxed);
            let control = Control { cancel: Some(&cancelled), max_splits: limit, ..alone() };
            let mut lazy = LazyOctree::new(shape(), &frame).unwrap();
            assert!(matches!(lazy.refine(&Zone::Whole, 5, &control), Err(Error::Cancelled)));
            // The call that caused the cancel was the last one.
            assert!(calls.load(Ordering::Relaxed) <= after + 9);
            let splits = lazy.splits();
            let volume = lazy.freeze(&alone()).unwrap().statistics().volume();
            assert!(volume.lower <= expected.statistics().volume().lower);
            assert_eq!(lazy.statistics().volume(), volume);
            cancelled.store(false, Ordering::Relaxed);
            stop.store(u64::MAX, Ordering::Relaxed);
            assert_eq!(lazy.refine(&Zone::Whole, 5, &control).unwrap(), Refinement::Done);
            assert_eq!(lazy.freeze(&alone()).unwrap(), expected);
            assert_eq!(lazy.splits(), direct.splits());
            assert!(splits < lazy.splits());
        }
    }
}

#[test]
fn an_error_of_the_solid_loses_nothing() {
    let left = AtomicU64::new(u64::MAX);
    let solid = Callback::new(|min: [f64; 3], max: [f64; 3]| {
        if left.fetch_sub(1, Ordering::Relaxed) == 0 {
            return Err(Error::Callback { code: -3 });
        }
        Ok(match (min[0], max[0]) {
            (_, high) if high <= 0.3 => Verdict::Full,
            (low, _) if low >= 0.3 => Verdict::Empty,
            _ => Verdict::Partial(()),
        })
    });
    let mut lazy = LazyOctree::new(solid, &unit_frame(5)).unwrap();
    let mut errors = 0;
    loop {
        left.store(100, Ordering::Relaxed);
        match lazy.refine(&Zone::Whole, 5, &alone()) {
            Err(Error::Callback { code: -3 }) if errors < 1000 => errors += 1,
            done => break assert_eq!(done.unwrap(), Refinement::Done),
        }
    }
    assert!(errors > 10);
    let whole = Csg::cuboid([-1.0; 3], [0.3, 2.0, 2.0]).unwrap();
    let expected = build(&whole, &unit_frame(5), Rule::Certified, &alone()).unwrap();
    assert_eq!(lazy.freeze(&alone()).unwrap(), expected);
}

#[test]
fn progress_ends_at_one() {
    for zone in [
        Zone::Whole,
        Zone::Point([0.3; 3]),
        Zone::Box { min: [0.2; 3], max: [0.9, 0.4, 0.3] },
        Zone::Ray { origin: [0.0; 3], direction: [1.0; 3], from: 0.0, to: 1.0 },
    ] {
        for level in [1, 2, 3, 6] {
            for max_splits in [None, Some(u64::MAX)] {
                let last = Mutex::new(0.0);
                let progress = |done: f64| {
                    let mut last = last.lock().unwrap();
                    assert!(*last <= done && done <= 1.0);
                    *last = done;
                };
                let mut lazy = LazyOctree::new(Csg::ball([0.5; 3], 0.4).unwrap(), &unit_frame(6)).unwrap();
                let control = Control { progress: Some(&progress), max_splits, ..alone() };
                lazy.refine(&zone, level, &control).unwrap();
                assert_eq!(*last.lock().unwrap(), 1.0, "{zone:?} {level}");
            }
        }
    }
}

// ---- resumed by the wrong solid -------------------------------------------------------------------------

#[test]
fn another_source_is_refused() {
    let frame = unit_frame(5);
    let ball = Csg::ball([0.5; 3], 0.4).unwrap();
    let mut lazy = LazyOctree::new(&ball, &frame).unwrap();
    lazy.refine(&Zone::Whole, 3, &alone()).unwrap();
    let octree = lazy.freeze(&alone()).unwrap();
    let resume =
        |octree: &Octree, frame: &Frame| LazyOctree::resume(octree, &ball, frame, &alone()).map(drop);
    resume(&octree, &frame).unwrap();
    let mismatch = |result: Result<(), Error>| assert!(matches!(result, Err(Error::SourceMismatch)));
    let other = Csg::ball([0.5; 3], 0.4f64.next_up()).unwrap();
    mismatch(LazyOctree::resume(&octree, other, &frame, &alone()).map(drop));
    mismatch(resume(&octree.with_metadata(Metadata::new()), &frame));
    let mut crc = Metadata::new();
    crc.insert("source", "crc32:00000000 bytes:12");
    mismatch(resume(&octree.with_metadata(crc), &frame));
    // Built and not frozen: the tree has no source until a caller states one.
    let built = build(&ball, &frame, Rule::Certified, &alone()).unwrap();
    mismatch(resume(&built, &frame));
    resume(&built.with_metadata(octree.metadata().clone()), &frame).unwrap();
    let moved = Frame::new([0.25; 3], 1.0, 5).unwrap();
    assert!(matches!(resume(&octree, &moved), Err(Error::FrameMismatch { .. })));
    let shallow = unit_frame(4);
    assert!(matches!(resume(&octree, &shallow), Err(Error::Argument { name: "frame", .. })));
    let nameless = LazyOctree::resume(&octree, slab(), &frame, &alone()).map(drop);
    assert!(matches!(nameless, Err(Error::Argument { name: "solid", .. })));
    let frozen = LazyOctree::new(slab(), &frame).unwrap().freeze(&alone()).unwrap();
    assert!(frozen.metadata().is_empty());
    for (control, what) in [
        (Control { max_nodes: Some(30), ..alone() }, "nodes"),
        (Control { max_bytes: Some(640), ..alone() }, "bytes"),
    ] {
        let limited = LazyOctree::resume(&octree, &ball, &frame, &control).map(drop);
        assert!(matches!(limited, Err(Error::Limit { what: found, .. }) if found == what));
    }
    let cancelled = AtomicBool::new(true);
    let control = Control { cancel: Some(&cancelled), ..alone() };
    assert!(matches!(LazyOctree::resume(&octree, &ball, &frame, &control), Err(Error::Cancelled)));
}

#[test]
fn a_contradiction_is_found_where_it_matters() {
    let frame = unit_frame(5);
    // Solids that replay splits, and so compare.
    let (ball, other) = (Csg::ball([0.3; 3], 0.2).unwrap(), Csg::ball([0.7; 3], 0.25).unwrap());
    let mut lazy = LazyOctree::new(ball, &frame).unwrap();
    lazy.refine(&Zone::Whole, 3, &alone()).unwrap();
    let truth = lazy.freeze(&alone()).unwrap();
    // The octree of one, with the fingerprint of the other.
    let mut lie = Metadata::new();
    lie.insert("source", other.fingerprint().unwrap().to_string());
    let octree = truth.with_metadata(lie);
    let mut lazy = LazyOctree::resume(&octree, other.clone(), &frame, &alone()).unwrap();
    for _ in 0..2 {
        let refused = lazy.refine(&Zone::Whole, 5, &alone());
        assert!(matches!(refused, Err(Error::SourceMismatch)), "{refused:?}");
        assert_eq!(lazy.freeze(&alone()).unwrap(), truth);
        assert_eq!(lazy.splits(), 0);
        let cell = positions(3).map(|at| Cell { level: 3, at }).find(|&cell| lazy.can_split(cell)).unwrap();
        assert!(matches!(lazy.split(cell), Err(Error::SourceMismatch)));
    }
    // The universe is compared at once.
    let everything =
        Octree::uniform(frame, Tag::Full, Tag::Full).unwrap().with_metadata(octree.metadata().clone());
    let resumed = LazyOctree::resume(&everything, other, &frame, &alone());
    assert!(resumed.is_ok(), "in what can be split anything may have come out");
    let whole = Csg::cuboid([-1.0; 3], [2.0; 3]).unwrap();
    let mut lie = Metadata::new();
    lie.insert("source", whole.fingerprint().unwrap().to_string());
    let resumed = LazyOctree::resume(&truth.with_metadata(lie), whole, &frame, &alone());
    assert!(matches!(resumed, Err(Error::SourceMismatch)));
}

#[test]
fn fingerprints_tell_solids_apart() {
    let frame = unit_frame(5);
    let ball = |c: [f64; 3], r: f64| AnySolid::new(Csg::ball(c, r).unwrap()).fingerprint().unwrap();
    let mesh = |fill| AnySolid::new(MeshSolid::new(tetrahedron(), fill).unwrap()).fingerprint().unwrap();
    let stored = |radius: f64, depth: u8| {
        let frame = unit_frame(depth);
        AnySolid::new(
            build(&Csg::ball([0.5; 3], radius).unwrap(), &frame, Rule::Certified, &alone()).unwrap(),
        )
    };
    let mut turned = tetrahedron().triangles().to_vec();
    turned[0].rotate_left(1);
    let turned = TriangleMesh::new(tetrahedron().vertices().to_vec(), turned).unwrap();
    let all = [
        ball([0.5; 3], 0.4),
        ball([0.5, 0.5, 0.25], 0.4),
        ball([0.5; 3], 0.3),
        Csg::cuboid([0.0; 3], [1.0; 3]).unwrap().fingerprint().unwrap(),
        Csg::cuboid([0.0; 3], [1.0, 1.0, 2.0]).unwrap().fingerprint().unwrap(),
        Csg::half_space([1.0, 0.0, 0.0], 0.5).unwrap().fingerprint().unwrap(),
        Csg::half_space([0.0, 1.0, 0.0], 0.5).unwrap().fingerprint().unwrap(),
        mesh(FillRule::NonZero),
        mesh(FillRule::EvenOdd),
        MeshSolid::new(turned, FillRule::NonZero).unwrap().fingerprint().unwrap(),
        stored(0.4, 4).fingerprint().unwrap(),
        stored(0.4, 5).fingerprint().unwrap(),
        stored(0.3, 5).fingerprint().unwrap(),
        Fingerprint::of_bytes(b""),
        Fingerprint::of_bytes(b"slab"),
    ];
    for (i, a) in all.iter().enumerate() {
        assert!(all.iter().enumerate().all(|(j, b)| (a == b) == (i == j)), "{i}");
    }
    assert_eq!(ball([0.0; 3], 0.4), ball([-0.0; 3], 0.4));
    assert_eq!(slab().fingerprint(), None);
    let octree = build(&Csg::ball([0.5; 3], 0.4).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
    let coded = compact(octree.view()).unwrap();
    assert_eq!(octree.view().fingerprint(), coded.fingerprint());
    assert_eq!(octree.fingerprint(), Some(all[11]));
}

#[test]
fn threads_may_have_it_one_after_another() {
    fn is_send_and_sync<T: Send + Sync>() {}
    is_send_and_sync::<LazyOctree<'static>>();
}

/// Any octree from a file is resumed without a crash, and refined as long as it does not contradict the
/// solid.
#[test]
#[cfg(all(feature = "mmap", target_endian = "little"))]
fn damaged_files_are_taken_up_without_a_crash() {
    // One that replays splits, and one that does not.
    damaged_files(&Csg::ball([0.5; 3], 0.4).unwrap());
    damaged_files(&Csg::ball([0.5; 3], 0.4).unwrap());
}

#[cfg(all(feature = "mmap", target_endian = "little"))]
fn damaged_files<S: Solid>(ball: &S) {
    let frame = unit_frame(6);
    let mut lazy = LazyOctree::new(ball, &frame).unwrap();
    lazy.refine(&Zone::Box { min: [0.0; 3], max: [1.0, 0.5, 1.0] }, 5, &alone()).unwrap();
    let good = file::to_bytes(&lazy.freeze(&alone()).unwrap()).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("damaged.lfl");
    let mut random = Random(5);
    let (mut taken, mut refined) = (0, 0);
    for _ in 0..repeated(600, 2000) {
        let mut bytes = good.clone();
        for _ in 0..1 + random.below(4) {
            let at = random.below(good.len() as u64) as usize;
            bytes[at] ^= 1 << random.below(8);
        }
        std::fs::write(&path, &bytes).unwrap();
        // SAFETY: no other process uses the file.
        let Ok(octree) = (unsafe { file::map(&path) }) else { continue };
        let Ok(mut lazy) = LazyOctree::resume(&octree, ball, &frame, &alone()) else { continue };
        taken += 1;
        for level in [4, 5, 6] {
            match lazy.refine(&Zone::Whole, level, &alone()) {
                Ok(done) => {
                    assert_eq!(done, Refinement::Done);
                    refined += 1;
                }
                Err(Error::SourceMismatch) => {}
                Err(other) => panic!("{other}"),
            }
        }
        lazy.freeze(&alone()).unwrap().view().check().unwrap();
    }
    let most = repeated(30, 100);
    assert!(taken > most && refined > most, "{taken} {refined}");
}
