//! The laws of solids, and the builder's results, against exact arithmetic.

use leafless::lattice::Cube;
use leafless::octree::Block;
use leafless::op::{resolve, union_of};
use leafless::solid::{Ask, FreeParts, OneByOne, Parts, Question, WholeQuestion};
use leafless::{
    AnySolid, Callback, Cell, Classifier, Control, Csg, Error, Frame, Interval, Octree, Proof, Rule, Solid,
    Tag, Verdict, Worker, build, compact, complement,
};
use leafless_testkit::cubes::{Cubes, Plain};
use leafless_testkit::exact::{Definition, Exact};
use leafless_testkit::{
    Dense, Random, Shape, alone, assert_is, cases, lattice_frame, positions, repeated, shapes,
};
use proptest::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

const RULES: [Rule; 4] = [Rule::Certified, Rule::Sampled, Rule::Inner, Rule::Outer];

fn made<S: Solid>(solid: &S, frame: &Frame, rule: Rule) -> Octree {
    let tree = build(solid, frame, rule, &alone()).unwrap();
    tree.view().check().unwrap();
    tree
}

/// Builds the library's solid for a definition.
fn shape(definition: Definition) -> AnySolid {
    match definition {
        Definition::Ball { centre, radius } => AnySolid::new(Csg::ball(centre, radius).unwrap()),
        Definition::HalfSpace { normal, offset } => AnySolid::new(Csg::half_space(normal, offset).unwrap()),
        Definition::Box { min, max } => AnySolid::new(Csg::cuboid(min, max).unwrap()),
    }
}

/// Checks all laws for a solid whose verdicts should be the best possible ones.
fn assert_exact(definition: Definition, frame: &Frame) {
    let depth = frame.depth();
    let truth = Dense::from_fn(depth, |at| definition.tag(frame, at));
    let centres = Dense::from_fn(depth, |at| match truth.at(at) {
        Tag::Partial if definition.sampled(frame, at) => Tag::Full,
        Tag::Partial => Tag::Empty,
        tag => {
            // The shift never leads out of an inside cell, nor into an outside cell.
            assert_eq!(definition.sampled(frame, at), tag == Tag::Full);
            tag
        }
    });
    let solid = shape(definition);
    for rule in RULES {
        let expected = match rule {
            Rule::Certified => &truth,
            Rule::Sampled => &centres,
            Rule::Inner => &truth.resolved(Tag::Empty),
            Rule::Outer => &truth.resolved(Tag::Full),
        };
        let tree = made(&solid, frame, rule);
        assert!(Dense::of(tree.view()) == *expected, "{definition:?} {frame:?} {rule:?}");
        assert_eq!(tree.view().is_binary(), expected.is_binary());
        let exterior = if definition.ends_inside(frame) { Tag::Empty } else { Tag::Partial };
        assert_eq!(tree.view().exterior(), exterior, "{definition:?} {frame:?}");
        // The same without the indirection.
        let same = match definition {
            Definition::Ball { centre, radius } => made(&Csg::ball(centre, radius).unwrap(), frame, rule),
            Definition::HalfSpace { normal, offset } => {
                made(&Csg::half_space(normal, offset).unwrap(), frame, rule)
            }
            Definition::Box { min, max } => made(&Csg::cuboid(min, max).unwrap(), frame, rule),
        };
        assert_eq!(tree, same);
    }
    laws(&solid, frame, &truth);
}

/// Collects the verdicts into an array by splits from the root, without a builder.
fn descend(worker: &mut impl Worker) -> Dense {
    fn walk<W: Worker>(worker: &mut W, cell: Cell, part: &W::Part, out: &mut Dense) {
        let mark = worker.mark();
        let children = worker.split(cell, part).unwrap();
        for (k, child) in (0..).zip(&children) {
            let cell = cell.child(k);
            match child {
                Verdict::Partial(part) if cell.level < out.depth => walk(worker, cell, part, out),
                verdict => {
                    let edge = 1 << (out.depth - cell.level);
                    let [x, y, z] = cell.at.map(|a| a * edge);
                    for z in z..z + edge {
                        for y in y..y + edge {
                            (x..x + edge).for_each(|x| out.set([x, y, z], verdict.tag()));
                        }
                    }
                }
            }
        }
        worker.release(mark);
    }
    let root = worker.root().unwrap();
    let mut out = Dense::uniform(worker.frame().depth(), root.tag());
    if let Verdict::Partial(part) = root {
        walk(worker, Cell::ROOT, &part, &mut out);
    }
    out
}

/// Returns the verdict of one cell by replaying the splits on the way to it. The worker's memory is used as
/// it is.
fn replay(worker: &mut impl Worker, cell: Cell) -> Tag {
    let mut verdict = worker.root().unwrap();
    for level in 0..cell.level {
        let Verdict::Partial(part) = verdict else { break };
        let above = |level: u8| Cell { level, at: cell.at.map(|a| a >> (cell.level - level)) };
        let octant = above(level + 1).octant();
        let [mut a, mut b] =
            [worker.split(above(level), &part).unwrap(), worker.split(above(level), &part).unwrap()];
        assert!(a.iter().zip(&b).all(|(a, b)| a.tag() == b.tag()), "asked twice");
        if let Some(part) = worker.recall(above(level)) {
            let again = worker.split(above(level), &part).unwrap();
            assert!(a.iter().zip(&again).all(|(a, b)| a.tag() == b.tag()), "asked without the way");
        }
        // The parts of both answers must be valid, whatever was split in between.
        a.swap(octant as usize, 0);
        b.swap(octant as usize, 0);
        let [a, ..] = a;
        let [b, ..] = b;
        verdict = if level % 2 == 0 { b } else { a };
    }
    verdict.tag()
}

/// Checks the laws. `truth` has the solid's verdicts for the finest cells.
fn laws<S: Solid>(solid: &S, frame: &Frame, truth: &Dense) {
    let classifier = solid.on(frame, &alone()).unwrap();
    assert_eq!(classifier.frame(), frame);
    let fresh = || classifier.worker().unwrap();
    assert_eq!(fresh().frame(), frame);
    assert_eq!(&descend(&mut fresh()), truth);
    assert_eq!(&Dense::of(made(solid, frame, Rule::Certified).view()), truth);
    let mut random = Random(frame.depth() as u64);
    let mut used = fresh();
    for _ in 0..60 {
        let at = [0; 3].map(|_| random.below(frame.cells() as u64) as u32);
        let cell = Cell { level: frame.depth(), at };
        assert_eq!(replay(&mut used, cell), truth.at(at));
        assert_eq!(replay(&mut fresh(), cell), truth.at(at));
        if random.below(8) == 0 {
            used.release(0);
        }
    }
    // Parts keep their meaning in the memory of another thread's worker, and among other parts there.
    let mut here = fresh();
    if let Verdict::Partial(part) = here.root().unwrap() {
        let children = here.split(Cell::ROOT, &part).unwrap();
        let cells = if frame.depth() > 1 { &children[..] } else { &[] };
        for (k, child) in (0..).zip(cells) {
            if let Verdict::Partial(part) = child {
                let cell = Cell::ROOT.child(k);
                let handed = used.hand_over(&here, part).unwrap();
                let there = used.split(cell, &handed).unwrap();
                let stayed = here.split(cell, part).unwrap();
                assert!(there.iter().zip(&stayed).all(|(a, b)| a.tag() == b.tag()));
            }
        }
    }
}

/// Frames whose lattice planes are integers, exact doubles, or no doubles at all; far from the origin; and
/// tiny.
fn frames(depth: u8) -> Vec<Frame> {
    let frame = |origin, edge| Frame::new(origin, edge, depth).unwrap();
    vec![
        lattice_frame(depth),
        frame([-1.0; 3], 2.0),
        frame([0.1, -7.3, 1e5 / 3.0], 10.0 / 3.0),
        frame([1e9 + 0.1, -3.3e8, 0.7], 0.044),
        frame([-1e-20 / 3.0, 1e-20, 0.0], 3e-20),
    ]
}

/// Converts a point from lattice to model coordinates, rounded.
fn model(frame: &Frame, at: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| frame.origin()[axis] + at[axis] * frame.cell_size())
}

#[test]
fn verdicts_are_exact_anywhere() {
    let mut random = Random(1);
    for depth in 1..=4 {
        for frame in frames(depth) {
            let n = frame.cells() as f64;
            for _ in 0..6 {
                let point = [0; 3].map(|_| random.between(-0.2 * n, 1.2 * n));
                let (centre, radius) =
                    (model(&frame, point), random.between(0.1, 0.9) * n * frame.cell_size());
                assert_exact(Definition::Ball { centre, radius }, &frame);
                let normal = [0; 3].map(|_| random.between(-1.0, 1.0));
                let offset = -(0..3).map(|axis| normal[axis] * centre[axis]).sum::<f64>();
                assert_exact(Definition::HalfSpace { normal, offset }, &frame);
                let other = [0, 1, 2].map(|axis| point[axis] + random.between(0.1, 0.8) * n);
                let max = model(&frame, other);
                if (0..3).all(|axis| centre[axis] < max[axis]) {
                    assert_exact(Definition::Box { min: centre, max }, &frame);
                }
            }
        }
    }
}

#[test]
fn verdicts_are_exact_on_a_finer_lattice() {
    for (i, frame) in frames(5).into_iter().enumerate() {
        let centre = model(&frame, [16.3, 15.9, 14.2]);
        match i % 3 {
            0 => assert_exact(Definition::Ball { centre, radius: 13.37 * frame.cell_size() }, &frame),
            1 => {
                let normal = [0.3, -0.9, 0.5];
                let offset = -(0..3).map(|axis| normal[axis] * centre[axis]).sum::<f64>();
                assert_exact(Definition::HalfSpace { normal, offset }, &frame);
            }
            _ => {
                assert_exact(Definition::Box { min: centre, max: model(&frame, [20.0, 31.5, 32.0]) }, &frame)
            }
        }
    }
}

/// Frames whose origin and cell size have few bits. Lattice points *and* the results computed from them are
/// doubles, but most intermediate roundings are inexact.
fn short_frames(depth: u8) -> Vec<Frame> {
    let frame = |origin: [f32; 3], edge: f32| Frame::new(origin.map(f64::from), edge as f64, depth).unwrap();
    vec![lattice_frame(depth), frame([0.1, -0.3, 0.7], 0.9), frame([-1000.1; 3], 3.3), frame([0.0; 3], 0.1)]
}

#[test]
fn balls_that_touch_the_lattice() {
    for depth in 2..=4 {
        let n = 1i32 << depth;
        for frame in short_frames(depth) {
            // Radii that pass through lattice points: (3, 4, 0), (1, 2, 2), (2, 3, 6), axes, and half cells.
            for (corner, radius) in [
                ([1, 1, 2], 3),
                ([0, 0, 0], 5),
                ([2, 1, 0], 7),
                ([n / 2; 3], n / 2),
                ([n / 2; 3], n),
                ([1; 3], 1),
            ] {
                let cell = frame.cell_size();
                let centre = model(&frame, corner.map(|c| c as f64));
                assert_exact(Definition::Ball { centre, radius: radius as f64 * cell }, &frame);
                // Slightly larger or smaller radii must be noticed.
                let radius = radius as f64 * cell;
                assert_exact(Definition::Ball { centre, radius: radius.next_up() }, &frame);
                assert_exact(Definition::Ball { centre, radius: radius.next_down() }, &frame);
                // Through cell centres, where the symbolic shift decides.
                let centre = model(&frame, corner.map(|c| c as f64 + 0.5));
                assert_exact(Definition::Ball { centre, radius }, &frame);
            }
        }
    }
}

#[test]
fn planes_through_the_lattice() {
    for depth in 1..=3 {
        for frame in short_frames(depth) {
            let [o, _, _] = frame.origin();
            let level = Frame::new([o; 3], frame.edge(), depth).unwrap();
            let cell = level.cell_size();
            // Planes through the diagonals. Every cell beside the diagonal is decided, and cells on it are
            // cut.
            for normal in [[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.3, -0.3], [-2.5, 0.0, 2.5]] {
                assert_exact(Definition::HalfSpace { normal, offset: 0.0 }, &level);
            }
            let tree = made(&Csg::half_space([1.0, -1.0, 0.0], 0.0).unwrap(), &level, Rule::Certified);
            for at in positions(depth) {
                let expected = match at[0].cmp(&at[1]) {
                    std::cmp::Ordering::Less => Tag::Empty,
                    std::cmp::Ordering::Equal => Tag::Partial,
                    std::cmp::Ordering::Greater => Tag::Full,
                };
                assert_eq!(tree.view().tag_at(at), expected);
            }
            // On a lattice plane, or a plane of centres, of each axis.
            let axes = if depth < 3 { 3 } else { 0 };
            for axis in 0..axes {
                for k in 0..=2 * frame.cells() {
                    for sign in [1.0, -1.0] {
                        let mut normal = [0.0; 3];
                        normal[axis] = sign;
                        let plane = frame.origin()[axis] + k as f64 * (0.5 * frame.cell_size());
                        let definition = Definition::HalfSpace { normal, offset: -sign * plane };
                        assert_exact(definition, &frame);
                    }
                }
            }
            // Obliquely through corners, and slightly beside them.
            for normal in [[1.0, 1.0, 1.0], [1.0, -2.0, 3.0], [-0.5, -0.25, 1.0]] {
                let corner = model(&level, [1.0, 2.0, 1.0]);
                let at = -(normal[0] * corner[0] + normal[1] * corner[1] + normal[2] * corner[2]);
                for offset in [at, at.next_up(), at.next_down(), at - cell / 2.0] {
                    // The doubles beside zero are no offsets.
                    let offset = if offset.abs() < 1e-300 { 0.0 } else { offset };
                    assert_exact(Definition::HalfSpace { normal, offset }, &level);
                }
            }
        }
    }
}

#[test]
fn faces_on_the_lattice_leave_nothing_undecided() {
    let mut random = Random(3);
    for depth in 1..=4 {
        for frame in short_frames(depth) {
            let n = frame.cells() as u64;
            for _ in 0..4 {
                let ends = [0; 3].map(|_| {
                    let (a, b) = (random.below(n + 1), random.below(n + 1));
                    if a == b { (0, n) } else { (a.min(b), a.max(b)) }
                });
                let min = model(&frame, ends.map(|end| end.0 as f64));
                let max = model(&frame, ends.map(|end| end.1 as f64));
                let tree = made(&Csg::cuboid(min, max).unwrap(), &frame, Rule::Certified);
                let inside = |at: [u32; 3]| (0..3).all(|i| (ends[i].0..ends[i].1).contains(&(at[i] as u64)));
                assert_is(
                    &tree,
                    &Dense::from_fn(depth, |at| if inside(at) { Tag::Full } else { Tag::Empty }),
                );
                assert_eq!(tree.view().exterior(), Tag::Empty);
                assert_exact(Definition::Box { min, max }, &frame);
                // Faces through cell centres: the shift puts the lower one inside, the upper one outside.
                let half = ends.map(|end| (end.0 as f64 + 0.5, end.1 as f64 - 0.5));
                if half.iter().all(|end| end.0 < end.1) {
                    let (min, max) = (model(&frame, half.map(|e| e.0)), model(&frame, half.map(|e| e.1)));
                    assert_exact(Definition::Box { min, max }, &frame);
                }
            }
        }
    }
}

#[test]
fn numbers_of_extreme_size() {
    let power = |e: i32| 2f64.powi(e);
    let (tiny, huge) = (power(-256), power(256));
    for (origin, edge) in [
        ([0.0; 3], tiny),
        ([huge; 3], huge),
        ([-huge, 0.0, huge], huge),
        ([tiny; 3], tiny),
        ([1.0; 3], tiny),
        ([huge, 1.0, -tiny], 3.0),
    ] {
        let frame = Frame::new(origin, edge, 2).unwrap();
        for centre in [[0.0; 3], [tiny, -tiny, huge], [1.0, tiny, 0.0], origin] {
            for radius in [tiny, 1.0, huge, edge, edge / 2.0] {
                if radius >= tiny {
                    assert_exact(Definition::Ball { centre, radius }, &frame);
                }
            }
            for normal in [[1.0, tiny, -huge], [huge, huge, -huge], [tiny, 0.0, 1.0]] {
                assert_exact(Definition::HalfSpace { normal, offset: centre[0] }, &frame);
                assert_exact(Definition::HalfSpace { normal, offset: -centre[2] }, &frame);
            }
            assert_exact(Definition::Box { min: [-huge, 0.0, -tiny], max: [tiny, 1.0, huge] }, &frame);
        }
    }
}

#[test]
fn origins_smaller_than_anything_else_are_refused() {
    // Products of numbers below 2^-256 would underflow, and lose their sign.
    for small in [1e-300, -1e-300, f64::MIN_POSITIVE, 5e-324, 2f64.powi(-256).next_down()] {
        for axis in 0..3 {
            let mut origin = [0.0; 3];
            origin[axis] = small;
            let refused = Frame::new(origin, 1.0, 2);
            assert!(matches!(refused, Err(Error::Argument { name: "origin", .. })), "{small:e}");
        }
    }
}

#[test]
fn rules_are_nested() {
    for depth in 1..=6 {
        let frame = Frame::new([0.1, 0.2, -0.3], 0.77, depth).unwrap();
        let solid = Csg::ball([0.45, 0.55, 0.1], 0.31).unwrap();
        let [certified, sampled, inner, outer] = RULES.map(|rule| made(&solid, &frame, rule));
        for at in positions(depth) {
            let tag = |tree: &Octree| tree.view().tag_at(at);
            assert!(!tag(&inner).lower() || tag(&sampled).lower());
            assert!(!tag(&sampled).upper() || tag(&outer).upper());
            assert_eq!(tag(&inner).lower(), tag(&certified).lower());
            assert_eq!(tag(&outer).upper(), tag(&certified).upper());
        }
        assert_eq!(resolve(certified.view(), Rule::Inner, &alone()).unwrap(), inner);
        assert_eq!(resolve(certified.view(), Rule::Outer, &alone()).unwrap(), outer);
        assert_eq!(resolve(certified.view(), Rule::Certified, &alone()).unwrap(), certified);
        for rule in RULES {
            assert_eq!(resolve(sampled.view(), rule, &alone()).unwrap(), sampled);
        }
        let refused = resolve(certified.view(), Rule::Sampled, &alone());
        assert!(matches!(refused, Err(Error::NotSampled)), "{refused:?}");
    }
}

#[test]
fn deeper_trees_only_refine() {
    // Cells of these shapes are decided as early as possible. A deeper tree cut at a level is the tree of
    // that level.
    let frame = Frame::new([0.1, 0.2, -0.3], 0.77, 8).unwrap();
    let shapes = [
        shape(Definition::Ball { centre: [0.45, 0.55, 0.1], radius: 0.31 }),
        shape(Definition::HalfSpace { normal: [1.0, 0.2, -0.7], offset: -0.3 }),
        shape(Definition::Box { min: [0.2, 0.3, -0.2], max: [0.7, 0.6, 0.3] }),
    ];
    for solid in &shapes {
        let deep = made(solid, &frame, Rule::Certified).statistics();
        let mut width = f64::INFINITY;
        for depth in 1..8 {
            let tree = made(solid, &frame.with_depth(depth).unwrap(), Rule::Certified);
            let statistics = tree.statistics();
            for (a, b) in statistics.levels().iter().zip(deep.levels()) {
                let scale = 8u64.pow(8 - depth as u32);
                assert_eq!((a.lower_cells * scale, a.upper_cells * scale), (b.lower_cells, b.upper_cells));
                assert_eq!((a.full, a.empty), (b.full, b.empty), "depth {depth} level {}", a.level);
            }
            assert!(statistics.volume().width() <= width);
            width = statistics.volume().width();
        }
    }
}

/// Checks that results and statistics are bit-identical for any number of threads.
fn threads_agree<S: Solid>(solid: &S, frame: &Frame, rule: Rule) -> Octree {
    let one = made(solid, frame, rule);
    for threads in [2, 16] {
        let many = build(solid, frame, rule, &Control::threads(threads)).unwrap();
        assert_eq!(one, many);
        assert_eq!(one.statistics(), many.statistics());
        assert_eq!(one.view().element_count(), many.view().element_count());
        assert_eq!(one.view().is_binary(), many.view().is_binary());
        many.view().check().unwrap();
    }
    one
}

#[test]
fn threads_do_not_change_results() {
    for depth in 1..=9 {
        let frame = Frame::new([0.1, 0.2, -0.3], 0.77, depth).unwrap();
        for rule in if depth < 8 { &RULES[..] } else { &RULES[..2] }.iter().copied() {
            let ball = Csg::ball([0.45, 0.55, 0.1], 0.31).unwrap();
            let tree = threads_agree(&ball, &frame, rule);
            if depth < 9 {
                assert_eq!(threads_agree(&AnySolid::new(ball.clone()), &frame, rule), tree);
            }
            if depth < 8 {
                threads_agree(&Csg::half_space([1.0, 0.2, -0.7], -0.3).unwrap(), &frame, rule);
                threads_agree(&Csg::cuboid([0.2, 0.3, -0.2], [0.7, 0.6, 0.3]).unwrap(), &frame, rule);
            }
            if rule != Rule::Sampled {
                assert_eq!(threads_agree(tree.view(), &frame, rule), tree);
            }
        }
    }
}

/// A union of balls. Each part is a list in scratch memory of the balls that still cut the cell. The tests
/// notice a part that refers to released memory, and a part that another part overwrites.
#[derive(Clone)]
struct Crowd(Vec<Plain>);

/// A ball's classifier on a frame.
type PlacedBall = <Plain as Solid>::Classifier;

/// The balls' classifiers on a frame.
#[derive(Clone)]
struct CrowdOnFrame {
    balls: Arc<[PlacedBall]>,
    frame: Frame,
}

/// The balls' workers, and the lists.
struct Lists {
    balls: Vec<<PlacedBall as Classifier>::Worker>,
    frame: Frame,
    lists: Vec<u32>,
}

impl Crowd {
    fn new(count: usize, frame: &Frame) -> Crowd {
        let mut random = Random(9);
        let ball = |_| {
            let centre = [0, 1, 2].map(|axis| frame.origin()[axis] + random.unit() * frame.edge());
            Plain::ball(centre, frame.edge() * random.between(0.02, 0.2)).unwrap()
        };
        Crowd((0..count).map(ball).collect())
    }
}

impl Solid for Crowd {
    type Classifier = CrowdOnFrame;

    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<CrowdOnFrame, Error> {
        let balls: Result<_, Error> = self.0.iter().map(|ball| ball.on(frame, control)).collect();
        Ok(CrowdOnFrame { balls: balls?, frame: *frame })
    }
}

impl Classifier for CrowdOnFrame {
    type Worker = Lists;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<Lists, Error> {
        let balls: Result<_, Error> = self.balls.iter().map(Classifier::worker).collect();
        Ok(Lists { balls: balls?, frame: self.frame, lists: Vec::new() })
    }

    fn proof(&self) -> Proof {
        Proof::CERTIFIED
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

impl Lists {
    fn keep(&mut self, balls: &[u32]) -> (u32, u32) {
        let start = self.lists.len() as u32;
        self.lists.extend_from_slice(balls);
        (start, self.lists.len() as u32)
    }
}

impl Parts for Lists {
    type Part = (u32, u32);

    fn mark(&self) -> usize {
        self.lists.len()
    }

    fn release(&mut self, mark: usize) {
        assert!(mark <= self.lists.len(), "released to a height that was never reached");
        self.lists.truncate(mark);
    }

    fn scratch_bytes(&self) -> usize {
        0
    }

    fn hand_over(&mut self, from: &Self, part: &(u32, u32)) -> Result<(u32, u32), Error> {
        Ok(self.keep(&from.lists[part.0 as usize..part.1 as usize]))
    }
}

impl OneByOne for Lists {}

impl Worker for Lists {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<(u32, u32)>, Error> {
        // The test's balls all cut the universe.
        let all: Vec<u32> = (0..self.balls.len() as u32).collect();
        Ok(Verdict::Partial(self.keep(&all)))
    }

    fn split(&mut self, cell: Cell, &(start, end): &(u32, u32)) -> Result<[Verdict<(u32, u32)>; 8], Error> {
        let active = self.lists[start as usize..end as usize].to_vec();
        assert!(active.is_sorted() && !active.is_empty(), "not a list that was handed out");
        let mut cut: [Vec<u32>; 8] = Default::default();
        let mut full = [false; 8];
        for &ball in &active {
            let verdicts = self.balls[ball as usize].split(cell, &())?;
            for (k, verdict) in verdicts.iter().enumerate() {
                match verdict {
                    Verdict::Full => full[k] = true,
                    Verdict::Partial(()) => cut[k].push(ball),
                    _ => {}
                }
            }
        }
        Ok([0, 1, 2, 3, 4, 5, 6, 7].map(|k| match (full[k], cut[k].is_empty()) {
            (true, _) => Verdict::Full,
            (_, true) => Verdict::Empty,
            _ => Verdict::Partial(self.keep(&cut[k])),
        }))
    }

    fn answer(
        &mut self,
        cell: Cell,
        &(start, end): &(u32, u32),
        question: Question<'_>,
    ) -> Result<(), Error> {
        if let Question::Centre(inside) = question {
            let Lists { balls, lists, .. } = self;
            let holds = |&ball: &u32| matches!(balls[ball as usize].sample(cell, &()), Ok(Some(true)));
            *inside = Some(lists[start as usize..end as usize].iter().any(holds));
        }
        Ok(())
    }
}

#[test]
fn parts_in_scratch_memory_survive_what_the_builder_does() {
    for depth in 1..=repeated(6, 7) {
        let frame = Frame::new([0.1, 0.2, -0.3], 0.77, depth).unwrap();
        let crowd = Crowd::new(40, &frame);
        for rule in RULES {
            let tree = threads_agree(&crowd, &frame, rule);
            let balls: Vec<Octree> = crowd.0.iter().map(|ball| made(ball, &frame, rule)).collect();
            let views: Vec<_> = balls.iter().map(|tree| *tree.view()).collect();
            let union = union_of(&views, &alone()).unwrap();
            for at in positions(depth.min(5)) {
                let at = at.map(|a| a << (depth - depth.min(5)));
                assert_eq!(tree.view().tag_at(at), union.view().tag_at(at), "{rule:?} {at:?}");
            }
            assert_eq!(tree.statistics(), union.statistics());
            let erased = AnySolid::new(crowd.clone());
            assert_eq!(threads_agree(&erased, &frame, rule), tree);
            assert_eq!(made(&AnySolid::new(erased), &frame, rule), tree);
        }
        if depth <= 4 {
            let truth = Dense::of(made(&crowd, &frame, Rule::Certified).view());
            laws(&crowd, &frame, &truth);
            laws(&AnySolid::new(crowd.clone()), &frame, &truth);
        }
    }
}

/// A solid that fills whole blocks from trees that were built without block-wise filling.
#[derive(Clone)]
struct Bulk<'a> {
    ball: Plain,
    certified: &'a Octree,
    sampled: &'a Octree,
    /// The builder's rule, and hence the rule that it requests.
    rule: Rule,
    filled: &'a AtomicU64,
}

/// Classifier and worker on a frame.
#[derive(Clone)]
struct BulkOnFrame<'a> {
    bulk: Bulk<'a>,
    ball: PlacedBall,
}

impl<'a> Solid for Bulk<'a> {
    type Classifier = BulkOnFrame<'a>;

    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<BulkOnFrame<'a>, Error> {
        Ok(BulkOnFrame { bulk: self.clone(), ball: self.ball.on(frame, control)? })
    }
}

impl Classifier for BulkOnFrame<'_> {
    type Worker = Self;

    fn frame(&self) -> &Frame {
        Classifier::frame(&self.ball)
    }

    fn worker(&self) -> Result<Self, Error> {
        Ok(self.clone())
    }

    fn exterior(&self) -> Tag {
        self.ball.exterior()
    }

    fn proof(&self) -> Proof {
        Proof::CERTIFIED
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

impl BulkOnFrame<'_> {
    fn fill_block(&self, cell: Cell, block: &mut Block) -> bool {
        let (low, high) = Cube { frame: Worker::frame(self), cell }.planes();
        assert_eq!([0, 1, 2].map(|axis| high[axis] - low[axis]), [64; 3]);
        // Some blocks are left to descent.
        if (cell.at[0] + cell.at[1]) % 3 == 2 {
            return false;
        }
        self.bulk.filled.fetch_add(1, Ordering::Relaxed);
        let rows = || (0..64).flat_map(|y| (0..64).map(move |x| (x, y, (x + 64 * y) as usize)));
        let is_sampled = self.bulk.rule == Rule::Sampled;
        assert_eq!(block.planes_mut().is_some(), !is_sampled);
        assert_eq!(block.centres_mut().is_some(), is_sampled);
        if let Some((lower, upper)) = block.planes_mut() {
            let mut cursor = leafless::query::PointCursor::new(self.bulk.certified.view());
            for (x, y, word) in rows() {
                (lower[word], upper[word]) = (0, 0);
                for z in 0..64 {
                    let tag = cursor.tag_at([low[0] + x, low[1] + y, low[2] + z]);
                    lower[word] |= (tag.lower() as u64) << z;
                    upper[word] |= (tag.upper() as u64) << z;
                }
            }
        }
        if let Some(centres) = block.centres_mut() {
            let mut cursor = leafless::query::PointCursor::new(self.bulk.sampled.view());
            for (x, y, word) in rows() {
                centres[word] = 0;
                for z in 0..64 {
                    let tag = cursor.tag_at([low[0] + x, low[1] + y, low[2] + z]);
                    centres[word] |= ((tag == Tag::Full) as u64) << z;
                }
            }
        }
        true
    }
}

impl FreeParts for BulkOnFrame<'_> {
    type Part = ();
}

impl OneByOne for BulkOnFrame<'_> {}

impl Worker for BulkOnFrame<'_> {
    fn frame(&self) -> &Frame {
        Classifier::frame(&self.ball)
    }

    fn root(&mut self) -> Result<Verdict<()>, Error> {
        self.ball.root()
    }

    fn split(&mut self, cell: Cell, part: &()) -> Result<[Verdict<()>; 8], Error> {
        self.ball.split(cell, part)
    }

    fn answer(&mut self, cell: Cell, part: &(), question: Question<'_>) -> Result<(), Error> {
        Worker::answer(&mut self.ball, cell, part, question)
    }

    fn fill(&mut self, cell: Cell, _: &(), block: &mut Block) -> Result<bool, Error> {
        Ok(self.fill_block(cell, block))
    }
}

#[test]
fn blocks_give_what_descent_gives() {
    for depth in 6..=8 {
        let frame = Frame::new([0.1, 0.2, -0.3], 0.77, depth).unwrap();
        let ball = Plain::ball([0.45, 0.55, 0.1], 0.31).unwrap();
        let [certified, sampled] = [Rule::Certified, Rule::Sampled].map(|rule| made(&ball, &frame, rule));
        for rule in RULES {
            let answer = made(&ball, &frame, rule);
            let filled = AtomicU64::new(0);
            let bulk = Bulk { ball, certified: &certified, sampled: &sampled, rule, filled: &filled };
            assert_eq!(threads_agree(&bulk, &frame, rule), answer);
            assert!(filled.load(Ordering::Relaxed) > 0);
        }
    }
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn stored_trees_are_solids(shape in shapes(1..=5), deeper in 1..3u8) {
        let dense = shape.dense();
        let original = dense.octree_with(Tag::Full, &alone()).unwrap();
        for tree in [original.clone(), compact(original.view()).unwrap()] {
            let stored = *tree.view();
            let again = made(&stored, tree.frame(), Rule::Certified);
            assert_eq!(again, tree);
            assert_eq!(again.view().exterior(), Tag::Full);
            laws(&stored, tree.frame(), &dense);
            for depth in 1..dense.depth {
                let frame = tree.frame().with_depth(depth).unwrap();
                assert_is(&made(&stored, &frame, Rule::Certified), &dense.cut(depth));
                let inner = made(&stored, &frame, Rule::Inner);
                assert_is(&inner, &dense.cut(depth).resolved(Tag::Empty));
            }
            let depth = dense.depth + deeper;
            let fine = made(&stored, &tree.frame().with_depth(depth).unwrap(), Rule::Certified);
            if depth <= 6 {
                assert_is(&fine, &dense.refined(depth));
            } else {
                assert_eq!(fine.statistics().nodes(), tree.statistics().nodes());
            }
            let outer = made(&stored, tree.frame(), Rule::Outer);
            assert_is(&outer, &dense.resolved(Tag::Full));
            match build(&stored, tree.frame(), Rule::Sampled, &alone()) {
                Ok(sampled) => assert!(dense.is_binary() && sampled == tree),
                Err(refused) => assert!(matches!(refused, Error::NotSampled) && !dense.is_binary()),
            }
        }
    }

    #[test]
    fn callbacks_give_what_they_say(shape in shapes(1..=4), origin in -3..3i32) {
        // A callback that provides only verdicts on boxes in model units, for a random solid.
        let dense = shape.dense();
        let n = dense.depth;
        let frame = Frame::new([origin as f64 * 0.5; 3], 2.0, n).unwrap();
        let classify = |min: [f64; 3], max: [f64; 3]| {
            let at = |x: f64| ((x - frame.origin()[0]) / frame.cell_size()) as u32;
            let edge = at(max[0]) - at(min[0]);
            let level = n - edge.trailing_zeros() as u8;
            assert_eq!(edge, 1 << (n - level));
            Ok(match dense.tag_of(Cell { level, at: min.map(|x| at(x) / edge) }) {
                Some(Tag::Empty) => Verdict::Empty,
                Some(Tag::Full) => Verdict::Full,
                Some(_) => Verdict::Undecided,
                None => Verdict::Partial(()),
            })
        };
        let callback = Callback::new(classify);
        assert_eq!(callback.on(&frame, &alone()).unwrap().exterior(), Tag::Partial);
        assert_is(&threads_agree(&callback, &frame, Rule::Certified), &dense);
        laws(&callback, &frame, &dense);
        for tag in [Tag::Empty, Tag::Full, Tag::Branch] {
            let tree = made(&Callback::new(classify).with_exterior(tag), &frame, Rule::Inner);
            assert_eq!(tree.view().exterior(), if tag == Tag::Branch { Tag::Partial } else { tag });
        }
    }
}

#[test]
fn callbacks_see_boxes_that_contain_their_cells() {
    for frame in frames(4) {
        let boxes = Mutex::new(Vec::new());
        let callback = Callback::new(|min, max| {
            boxes.lock().unwrap().push((min, max));
            Ok(Verdict::Partial(()))
        });
        build(&callback, &frame, Rule::Certified, &alone()).unwrap();
        let boxes = boxes.into_inner().unwrap();
        assert_eq!(boxes.len(), 1 + 8 + 64 + 512 + 4096);
        // The boxes of the finest cells contain the cells' exact planes, and nothing more.
        let (min, max) = boxes[0];
        for axis in 0..3 {
            let below = |x: f64, k: u32| Exact::from(x).minus(&Exact::plane(&frame, axis, k)).sign();
            assert!(below(min[axis], 0) <= 0 && below(min[axis].next_up(), 0) > 0);
            assert!(below(max[axis], 16) >= 0 && below(max[axis].next_down(), 16) < 0);
        }
    }
}

#[test]
fn callbacks_are_sampled_at_centres() {
    let frame = Frame::new([-1.0, 0.0, 4.0], 8.0, 4).unwrap();
    let centres = Mutex::new(Vec::new());
    let contains = |p: [f64; 3]| {
        centres.lock().unwrap().push(p);
        Ok(p[0] + p[1] > 3.0)
    };
    let cut = |_: [f64; 3], _: [f64; 3]| Ok(Verdict::Partial(()));
    let tree = made(&Callback::new(cut).with_contains(contains), &frame, Rule::Sampled);
    for at in positions(4) {
        let centre = [0, 1, 2].map(|axis| frame.origin()[axis] + (at[axis] as f64 + 0.5) * 0.5);
        assert_eq!(tree.view().tag_at(at), if centre[0] + centre[1] > 3.0 { Tag::Full } else { Tag::Empty });
        assert!(centres.lock().unwrap().contains(&centre));
    }
    for rule in [Rule::Certified, Rule::Inner, Rule::Outer] {
        made(&Callback::new(cut), &frame, rule);
    }
    for undecided in [Verdict::Partial(()), Verdict::Undecided] {
        for at in [0.0, 3.0, 7.5] {
            // Undecided everywhere, in half of the universe, and in single cells.
            let classify =
                |min: [f64; 3], _: [f64; 3]| Ok(if min[0] >= at - 1.0 { undecided } else { Verdict::Full });
            let refused = build(&Callback::new(classify), &frame, Rule::Sampled, &alone());
            assert!(matches!(refused, Err(Error::NotSampled)) || at > 0.0, "{refused:?}");
        }
    }
}

#[test]
fn nothing_is_known_of_an_undecided_universe() {
    for depth in 1..=3 {
        let frame = lattice_frame(depth);
        let callback = Callback::new(|_, _| Ok(Verdict::Undecided));
        let tree = made(&callback, &frame, Rule::Certified);
        assert_is(&tree, &Dense::uniform(depth, Tag::Partial));
        assert!(!tree.view().is_binary());
        assert_eq!(tree.statistics().volume(), Interval::new(0.0, 8f64.powi(depth as i32)).unwrap());
        assert_is(&made(&callback, &frame, Rule::Inner), &Dense::uniform(depth, Tag::Empty));
        assert_is(&made(&callback, &frame, Rule::Outer), &Dense::uniform(depth, Tag::Full));
        assert!(matches!(build(&callback, &frame, Rule::Sampled, &alone()), Err(Error::NotSampled)));
        // Cells that would split for ever end as undecided, and merge.
        let endless = Callback::new(|_, _| Ok(Verdict::Partial(())));
        assert_eq!(made(&endless, &frame, Rule::Certified), tree);
        let all = complement(tree.view(), &alone()).unwrap();
        all.view().check().unwrap();
        assert!(Dense::of(all.view()) == Dense::uniform(depth, Tag::Partial));
    }
}

#[test]
fn the_deepest_trees() {
    let n = 1u32 << 20;
    for (depth, first, size) in [
        (20u8, [0, 0, 0], 3),
        (20, [n - 3, 5, n / 2 - 1], 2),
        (20, [n / 2 - 2; 3], 4),
        (19, [1, n / 2 - 2, 77], 2),
    ] {
        let frame = lattice_frame(depth);
        let last = first.map(|a| a + size);
        let solid = Csg::cuboid(first.map(f64::from), last.map(f64::from)).unwrap();
        for rule in RULES {
            let tree = threads_agree(&solid, &frame, rule);
            let cells = (size as u64).pow(3);
            assert_eq!(tree.statistics().volume_cells(), (cells, cells));
            assert_eq!(tree.statistics().volume(), Interval::exactly(cells as f64));
            for x in first[0].saturating_sub(1)..=last[0] {
                for y in first[1].saturating_sub(1)..=last[1] {
                    for z in first[2].saturating_sub(1)..=last[2] {
                        let at = [x, y, z];
                        let inside = (0..3).all(|i| (first[i]..last[i]).contains(&at[i]));
                        let beyond = at.iter().any(|&a| a >= frame.cells());
                        let expected = match (beyond, inside) {
                            (true, _) => Tag::Partial,
                            (_, true) => Tag::Full,
                            _ => Tag::Empty,
                        };
                        assert_eq!(tree.view().tag_at(at), expected, "{at:?}");
                    }
                }
            }
            let not = complement(tree.view(), &alone()).unwrap();
            not.view().check().unwrap();
            assert_eq!(not.statistics().volume_cells().0, 8u64.pow(depth as u32) - cells);
            assert_eq!(complement(not.view(), &alone()).unwrap(), tree);
            let mut again = leafless::octree::Cursor::new(tree.view());
            while again.tag() == Tag::Branch {
                let tags = again.node().unwrap().tags();
                again.descend(tags.iter().position(|&tag| tag != Tag::Empty).unwrap() as u8);
            }
            assert_eq!(again.tag(), Tag::Full);
        }
    }
    let frame = lattice_frame(20);
    let ball = Csg::ball([700_000.25, 3.5, 1_048_570.0], 2.5).unwrap();
    let tree = threads_agree(&ball, &frame, Rule::Certified);
    assert!(tree.statistics().volume().contains(4.0 / 3.0 * std::f64::consts::PI * 2.5f64.powi(3)));
    let definition = Definition::Ball { centre: [700_000.25, 3.5, 1_048_570.0], radius: 2.5 };
    for x in 699_996..700_004 {
        for y in 0..8 {
            for z in 1_048_566..1_048_576 {
                assert_eq!(tree.view().tag_at([x, y, z]), definition.tag(&frame, [x, y, z]));
            }
        }
    }
}

#[test]
fn frames_of_other_universes_are_refused() {
    let tree = Shape { depth: 3, tape: vec![9, 6, 0, 1, 3, 5, 0, 9, 2] }.dense().octree();
    let stored = *tree.view();
    for frame in [
        Frame::new([0.0; 3], 8.5, 3).unwrap(),
        Frame::new([0.0, 1e-9, 0.0], 8.0, 3).unwrap(),
        Frame::new([1.0; 3], 8.0, 4).unwrap(),
    ] {
        for rule in RULES {
            assert!(matches!(build(&stored, &frame, rule, &alone()), Err(Error::FrameMismatch { .. })));
        }
    }
}

#[test]
fn shapes_refuse_what_is_no_shape() {
    let bad = [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e-100, 1e100, 5e-324];
    for x in bad {
        assert!(matches!(Csg::ball([0.0, x, 0.0], 1.0), Err(Error::Argument { name: "centre", .. })));
        assert!(matches!(Csg::ball([0.0; 3], x), Err(Error::Argument { name: "radius", .. })));
        assert!(matches!(Csg::cuboid([-x.abs(), 0.0, 0.0], [1.0; 3]), Err(Error::Argument { .. })));
        assert!(matches!(Csg::half_space([x, 1.0, 0.0], 0.0), Err(Error::Argument { name: "normal", .. })));
        assert!(matches!(Csg::half_space([0.0, 1.0, 0.0], x), Err(Error::Argument { name: "offset", .. })));
    }
    assert!(Csg::ball([0.0; 3], 0.0).is_err() && Csg::ball([0.0; 3], -1.0).is_err());
    assert!(Csg::half_space([0.0, -0.0, 0.0], 1.0).is_err());
    for max in [[1.0, 0.0, 1.0], [1.0, -1.0, 1.0]] {
        assert!(matches!(Csg::cuboid([0.0; 3], max), Err(Error::Argument { name: "max", .. })));
    }
}

#[test]
fn progress_rises_to_one() {
    for depth in 1..=7 {
        let frame = Frame::new([0.1, 0.2, -0.3], 0.77, depth).unwrap();
        let solids = [
            shape(Definition::Ball { centre: [0.45, 0.55, 0.1], radius: 0.31 }),
            // All of the universe, nothing, and one corner.
            shape(Definition::Ball { centre: [0.45, 0.55, 0.1], radius: 31.0 }),
            shape(Definition::Ball { centre: [9.0, 0.55, 0.1], radius: 1.0 }),
            shape(Definition::HalfSpace { normal: [-1.0, -1.0, -1.0], offset: 0.1 }),
            AnySolid::new(Callback::new(|_, _| Ok(Verdict::Undecided))),
            AnySolid::new(Callback::new(|min: [f64; 3], _| {
                Ok(if min[0] < 0.3 { Verdict::Partial(()) } else { Verdict::Undecided })
            })),
        ];
        for (i, solid) in solids.iter().enumerate() {
            for threads in [1, 4] {
                let seen = Mutex::new(Vec::new());
                let note = |done: f64| seen.lock().unwrap().push(done);
                let control = Control { progress: Some(&note), ..Control::threads(threads) };
                build(solid, &frame, Rule::Certified, &control).unwrap();
                let mut seen = seen.into_inner().unwrap();
                if threads == 1 {
                    assert!(seen.is_sorted());
                }
                seen.sort_by(f64::total_cmp);
                let range = (seen.first().copied(), seen.last().copied());
                assert!(range.0.is_some_and(|first| first >= 0.0), "depth {depth} solid {i} {range:?}");
                assert_eq!(range.1, Some(1.0), "depth {depth} solid {i} threads {threads}");
            }
        }
    }
}

#[test]
fn a_build_stops_when_it_is_told_to() {
    let frame = lattice_frame(8);
    let ball = Csg::ball([128.5; 3], 100.0).unwrap();
    let flag = AtomicBool::new(true);
    let refused = build(&ball, &frame, Rule::Inner, &Control { cancel: Some(&flag), ..alone() });
    assert!(matches!(refused, Err(Error::Cancelled)));
    for threads in [1, 2, 16] {
        // From the progress, half-way.
        let flag = AtomicBool::new(false);
        let last = Mutex::new(0.0f64);
        let note = |done: f64| {
            let mut last = last.lock().unwrap();
            *last = last.max(done);
            if done > 0.5 {
                flag.store(true, Ordering::Relaxed);
            }
        };
        let control = Control { cancel: Some(&flag), progress: Some(&note), ..Control::threads(threads) };
        let refused = build(&ball, &frame, Rule::Certified, &control);
        assert!(matches!(refused, Err(Error::Cancelled)), "{refused:?}");
        assert!(*last.lock().unwrap() < 1.0, "it went on to the end");
    }
}

#[test]
fn errors_of_a_solid_end_the_build() {
    #[derive(Clone)]
    struct Failing<'a>(&'a AtomicU64);
    impl Cubes for Failing<'_> {
        fn verdict(&self, _: &Cube<'_>) -> Result<Verdict<()>, Error> {
            // The universe, and a thousand split cells.
            match self.0.fetch_add(1, Ordering::Relaxed) {
                8001 => Err(Error::OutOfMemory),
                _ => Ok(Verdict::Partial(())),
            }
        }
    }
    leafless_testkit::solid_of_cubes!(Failing<'a>: 'a);
    for threads in [1, 2, 16] {
        let refused = build(
            &Failing(&AtomicU64::new(0)),
            &lattice_frame(6),
            Rule::Certified,
            &Control::threads(threads),
        );
        assert!(matches!(refused, Err(Error::OutOfMemory)), "{refused:?}");
    }
}

#[test]
fn a_failing_callback_ends_the_operation() {
    let frame = lattice_frame(6);
    let control = Control::threads(4);
    fn stop() -> Error {
        Error::Callback { code: -7 }
    }
    let cut = |_: [f64; 3], _: [f64; 3]| Ok(Verdict::Partial(()));
    let classify =
        |min: [f64; 3], _: [f64; 3]| if min[0] > 40.0 { Err(stop()) } else { Ok(Verdict::Partial(())) };
    let contains = |p: [f64; 3]| if p[2] > 33.0 { Err(stop()) } else { Ok(true) };
    for refused in [
        build(&Callback::new(|_, _| Err(stop())), &frame, Rule::Certified, &control),
        build(&Callback::new(classify), &frame, Rule::Certified, &control),
        build(&Callback::new(cut).with_contains(contains), &frame, Rule::Sampled, &control),
        build(&AnySolid::new(Callback::new(classify)), &frame, Rule::Outer, &control),
    ] {
        assert!(matches!(refused, Err(Error::Callback { code: -7 })), "{refused:?}");
    }
}

#[test]
fn an_octree_is_a_solid_that_owns_itself() {
    for depth in [3, 6, 7] {
        let frame = lattice_frame(depth);
        let edge = frame.edge();
        let ball = Csg::ball([edge * 0.4; 3], edge * 0.37).unwrap();
        for rule in [Rule::Certified, Rule::Sampled] {
            let tree = made(&ball, &frame, rule);
            assert_eq!(made(&tree, &frame, Rule::Certified), tree);
            assert_eq!(made(&AnySolid::new(tree.clone()), &frame, Rule::Certified), tree);
            let coarse = frame.with_depth(depth - 1).unwrap();
            let stored = made(tree.view(), &coarse, Rule::Outer);
            assert_eq!(made(&tree, &coarse, Rule::Outer), stored);
        }
    }
}
