//! Volume, centroid and inertia, against sums in exact arithmetic and formulas.

use leafless::query::{Extent, StopReason};
use leafless::solid::{OneByOne, Parts, Question, WholeQuestion};
use leafless::{
    AnySolid, Callback, Cell, Classifier, Control, Csg, Error, FillRule, Frame, Interval, MassProperties,
    MeshSolid, Proof, Rule, Solid, Tag, TriangleMesh, Verdict, Worker, bounding_box, build, complement,
    exchange, measure,
};
use leafless_testkit::cubes::Plain;
use leafless_testkit::exact::Exact;
use leafless_testkit::{Dense, DenseSolid, Random, alone, cases, model, positions, repeated, shapes};
use proptest::prelude::*;
use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};

const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

fn zero() -> Exact {
    Exact::from(0.0)
}

/// Volume and moments about the model's origin, without rounding. All are multiplied by `factor`, which keeps
/// them sums of doubles.
#[derive(Clone)]
struct Sums {
    factor: f64,
    volume: Exact,
    first: [Exact; 3],
    second: [Exact; 6],
}

impl Sums {
    fn new(factor: f64) -> Sums {
        Sums {
            factor,
            volume: zero(),
            first: [zero(), zero(), zero()],
            second: std::array::from_fn(|_| zero()),
        }
    }

    /// Adds a finest cell.
    fn add_cell(&mut self, frame: &Frame, at: [u32; 3]) {
        assert_eq!(self.factor, 12.0);
        let edge = Exact::from(frame.cell_size());
        let cube = edge.times(&edge).times(&edge);
        let twelve = Exact::from(12.0).times(&cube);
        let centre = [0, 1, 2].map(|axis| Exact::half_plane(frame, axis, 2 * at[axis] + 1));
        self.volume = self.volume.plus(&twelve);
        for axis in 0..3 {
            self.first[axis] = self.first[axis].plus(&twelve.times(&centre[axis]));
        }
        for (sum, (i, j)) in self.second.iter_mut().zip(PAIRS) {
            *sum = sum.plus(&twelve.times(&centre[i]).times(&centre[j]));
            if i == j {
                *sum = sum.plus(&cube.times(&edge).times(&edge));
            }
        }
    }

    /// Adds the tetrahedron between the origin and a triangle; it counts as negative if the triangle is seen
    /// from behind.
    fn add_triangle(&mut self, corners: [[f64; 3]; 3]) {
        assert_eq!(self.factor, 120.0);
        let [a, b, c] = corners.map(|corner| corner.map(Exact::from));
        let minor = |i: usize, j: usize| b[i].times(&c[j]).minus(&b[j].times(&c[i]));
        let determinant =
            a[0].times(&minor(1, 2)).plus(&a[1].times(&minor(2, 0))).plus(&a[2].times(&minor(0, 1)));
        let sum = [0, 1, 2].map(|axis| a[axis].plus(&b[axis]).plus(&c[axis]));
        self.volume = self.volume.plus(&Exact::from(20.0).times(&determinant));
        for axis in 0..3 {
            let term = Exact::from(5.0).times(&determinant).times(&sum[axis]);
            self.first[axis] = self.first[axis].plus(&term);
        }
        for (second, (i, j)) in self.second.iter_mut().zip(PAIRS) {
            let squares = [&a, &b, &c].map(|p| p[i].times(&p[j]));
            let all = squares.iter().fold(sum[i].times(&sum[j]), |all, square| all.plus(square));
            *second = second.plus(&determinant.times(&all));
        }
    }

    fn is_empty(&self) -> bool {
        self.volume.sign() == 0
    }

    /// Returns the inertia tensor's entries, each as `[numerator, positive denominator]`.
    fn tensor(&self, second: &[Exact; 6], denominator: &Exact) -> Vec<(usize, usize, [Exact; 2])> {
        PAIRS
            .iter()
            .enumerate()
            .map(|(k, &(i, j))| {
                let value = if i == j {
                    second[(i + 1) % 3].plus(&second[(i + 2) % 3])
                } else {
                    zero().minus(&second[k])
                };
                (i, j, [value, denominator.clone()])
            })
            .collect()
    }

    fn inertia_about_origin(&self) -> Vec<(usize, usize, [Exact; 2])> {
        self.tensor(&self.second, &Exact::from(self.factor))
    }

    fn inertia_about_centroid(&self) -> Vec<(usize, usize, [Exact; 2])> {
        let second = std::array::from_fn(|k| {
            let (i, j) = PAIRS[k];
            self.second[k].times(&self.volume).minus(&self.first[i].times(&self.first[j]))
        });
        self.tensor(&second, &self.volume.times(&Exact::from(self.factor)))
    }
}

/// True if lower ≤ numerator / denominator ≤ upper, exactly.
fn contains(interval: Interval, [numerator, denominator]: &[Exact; 2]) -> bool {
    let below = |x: f64| Exact::from(x).times(denominator).minus(numerator).sign() <= 0;
    let above = |x: f64| Exact::from(x).times(denominator).minus(numerator).sign() >= 0;
    assert!(!interval.lower.is_nan() && !interval.upper.is_nan());
    (interval.lower == f64::NEG_INFINITY || below(interval.lower))
        && (interval.upper == f64::INFINITY || above(interval.upper))
}

fn contains_all(measures: &MassProperties, sums: &Sums) -> Result<(), String> {
    let check = |what: &str, interval: Interval, value: &[Exact; 2]| {
        if contains(interval, value) { Ok(()) } else { Err(format!("{what} is not in {interval:?}")) }
    };
    check("volume", measures.volume, &[sums.volume.clone(), Exact::from(sums.factor)])?;
    for (i, j, value) in sums.inertia_about_origin() {
        check(&format!("inertia {i}{j}"), measures.inertia_about_origin[i][j], &value)?;
    }
    if sums.is_empty() {
        for i in 0..3 {
            for j in 0..3 {
                let about = [zero(), Exact::from(1.0)];
                check("inertia of nothing", measures.inertia_about_centroid[i][j], &about)?;
            }
        }
        return Ok(());
    }
    for (i, j, value) in sums.inertia_about_centroid() {
        check(&format!("central inertia {i}{j}"), measures.inertia_about_centroid[i][j], &value)?;
    }
    for axis in 0..3 {
        if let Some(centroid) = measures.centroid {
            check("centroid", centroid[axis], &[sums.first[axis].clone(), sums.volume.clone()])?;
        }
    }
    Ok(())
}

/// Asserts that an interval is as tight as the least and the greatest possible value allow, up to `slack` of
/// the magnitude.
fn assert_tight(interval: Interval, least: &[Exact; 2], most: &[Exact; 2], slack: f64) {
    let slack = slack * interval.lower.abs().max(interval.upper.abs());
    let narrow = Interval::new(interval.lower + slack, f64::INFINITY).unwrap();
    assert!(slack == 0.0 || !contains(narrow, least), "{interval:?} begins too low");
    let narrow = Interval::new(f64::NEG_INFINITY, interval.upper - slack).unwrap();
    assert!(slack == 0.0 || !contains(narrow, most), "{interval:?} ends too high");
}

fn assert_symmetric(measures: &MassProperties) {
    for tensor in [measures.inertia_about_origin, measures.inertia_about_centroid] {
        for i in 0..3 {
            for j in 0..3 {
                assert_eq!(tensor[i][j], tensor[j][i]);
                assert!(tensor[i][j].lower <= tensor[i][j].upper);
            }
        }
    }
}

/// Checks measures against the cells of a dense array. Every tried choice of the undecided cells lies in the
/// intervals, and measures that can be exact are.
fn check_dense(dense: &Dense, frame: &Frame, random: &mut Random) {
    let measures = measure(&DenseSolid { dense, exterior: Tag::Empty }, frame, 0.0, &alone()).unwrap();
    assert_symmetric(&measures);
    let open: Vec<[u32; 3]> = positions(dense.depth).filter(|&at| dense.at(at) == Tag::Partial).collect();
    let mut full = Sums::new(12.0);
    positions(dense.depth).filter(|&at| dense.at(at) == Tag::Full).for_each(|at| full.add_cell(frame, at));
    let choose = |choice: &dyn Fn([u32; 3]) -> bool| {
        let mut sums = full.clone();
        open.iter().filter(|&&at| choice(at)).for_each(|&at| sums.add_cell(frame, at));
        sums
    };
    let all = choose(&|_| true);
    assert_eq!(measures.centroid.is_some(), !full.is_empty());
    let end = if open.is_empty() { StopReason::Tolerance } else { StopReason::Exhausted };
    assert_eq!((measures.stop_reason, measures.clipped), (end, false));
    let mut choices = vec![full.clone(), all.clone()];
    for _ in 0..3 {
        let seed = random.bits() as u8;
        choices.push(choose(&|at| leafless_testkit::noise(seed, at) & 1 == 0));
        // Extreme choices lie on one side of a plane, or of two planes.
        let normal = [0, 1, 2].map(|_| random.below(7) as i64 - 3);
        let level = (random.below(4) as i64) << dense.depth >> 1;
        let side = |at: [u32; 3]| (0..3).map(|axis| normal[axis] * at[axis] as i64).sum::<i64>() > level;
        choices.push(choose(&side));
        let middle = 1i64 << dense.depth >> 1;
        let quadrant = |at: [u32; 3]| (at[0] as i64 - middle) * (at[1] as i64 - middle) * normal[0] > 0;
        choices.push(choose(&quadrant));
    }
    for sums in &choices {
        contains_all(&measures, sums).unwrap_or_else(|what| panic!("{what}\n{dense:?}\n{frame:?}"));
    }
    let factor = Exact::from(12.0);
    assert_tight(
        measures.volume,
        &[full.volume.clone(), factor.clone()],
        &[all.volume.clone(), factor],
        1e-15,
    );
    for ((i, j, least), (_, _, most)) in full.inertia_about_origin().iter().zip(all.inertia_about_origin()) {
        if i == j {
            assert_tight(measures.inertia_about_origin[*i][*j], least, &most, 1e-13);
        }
    }
    if !full.is_empty() {
        let both = full.inertia_about_centroid().into_iter().zip(all.inertia_about_centroid());
        for ((i, j, least), (_, _, most)) in both {
            if i == j {
                assert_tight(measures.inertia_about_centroid[i][j], &least, &most, 1e-14);
            }
        }
    }
}

/// Frames whose planes are no doubles, near the origin and far from it.
fn frame(random: &mut Random, depth: u8) -> Frame {
    let edge = random.between(0.1, 100.0);
    let origin = [0, 1, 2].map(|_| match random.below(4) {
        0 => random.between(-100.0, 100.0),
        1 => random.between(-1.0, 0.0) * edge,
        2 => 0.0,
        _ => 1e6 * random.between(-1.0, 1.0),
    });
    Frame::new(origin, edge, depth).unwrap()
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn cells_of_every_kind(shape in shapes(1..=3), seed: u64) {
        let mut random = Random(seed);
        let frame = frame(&mut random, shape.depth);
        check_dense(&shape.dense(), &frame, &mut random);
    }
}

#[test]
fn uniform_universes() {
    let mut random = Random(5);
    for depth in 1..=3 {
        let frame = frame(&mut random, depth);
        for tag in leafless_testkit::TAGS {
            check_dense(&Dense::uniform(depth, tag), &frame, &mut random);
        }
    }
}

/// If all faces are plane, slabs determine everything up to rounding.
#[test]
fn boxes_are_known_at_once() {
    let frame = Frame::new([-4.0; 3], 8.0, 20).unwrap();
    let solid = Csg::cuboid([-2.0, -1.0, 0.0], [2.0, 3.0, 1.0]).unwrap();
    let measures = measure(&solid, &frame, 0.0, &Control::default()).unwrap();
    assert!(measures.volume.contains(16.0) && measures.volume.width() < 1e-8, "{measures:?}");
    for (found, value) in measures.centroid.unwrap().into_iter().zip([0.0, 1.0, 0.5]) {
        assert!(found.contains(value) && found.width() < 1e-8, "{found:?}");
    }
    let tensor = measures.inertia_about_centroid;
    // V (b² + c²) / 12
    for (i, value) in [16.0 * 17.0 / 12.0, 16.0 * 17.0 / 12.0, 16.0 * 32.0 / 12.0].into_iter().enumerate() {
        assert!(tensor[i][i].contains(value) && tensor[i][i].width() < 1e-6, "{tensor:?}");
        let mixed = tensor[i][(i + 1) % 3];
        assert!(mixed.contains(0.0) && mixed.width() < 1e-6, "{tensor:?}");
    }
    // −V y z
    let mixed = measures.inertia_about_origin[1][2];
    assert!(mixed.contains(-8.0) && mixed.width() < 1e-6, "{measures:?}");
    assert!(measures.level <= 3 && measures.splits < 40, "{measures:?}");
}

/// Asserts that an interval contains the truth near a number from formulas in doubles.
fn assert_contains(interval: Interval, value: f64, scale: f64) {
    let error = 1e-13 * scale;
    assert!(interval.lower <= value + error && value - error <= interval.upper, "{value} in {interval:?}");
}

#[test]
fn balls_and_boxes_contain_the_formulas_at_every_depth() {
    let mut random = Random(11);
    for round in 0..12 {
        let centre = [0, 1, 2].map(|_| random.between(-2.0, 2.0));
        let half = [0, 1, 2].map(|_| random.between(0.3, 1.5));
        let radius = half[0];
        let ball = Csg::ball(centre, radius).unwrap();
        let min = [0, 1, 2].map(|axis| centre[axis] - half[axis]);
        let max = [0, 1, 2].map(|axis| centre[axis] + half[axis]);
        let block = Csg::cuboid(min, max).unwrap();
        let ball_volume = 4.0 / 3.0 * PI * radius.powi(3);
        let block_volume = 8.0 * half[0] * half[1] * half[2];
        for depth in 1..=8 {
            let frame = Frame::new([-4.0, -4.5, -3.75], 8.3, depth).unwrap();
            let of_ball = measure(&ball, &frame, 0.0, &Control::default()).unwrap();
            let of_block = measure(&block, &frame, 0.0, &Control::default()).unwrap();
            for (measures, volume, squares) in [
                (of_ball, ball_volume, [radius * radius / 5.0; 3]),
                (of_block, block_volume, half.map(|h| h * h / 3.0)),
            ] {
                assert!(!measures.clipped);
                assert_contains(measures.volume, volume, volume);
                for axis in 0..3 {
                    if let Some(centroid) = measures.centroid {
                        assert_contains(centroid[axis], centre[axis], 1.0);
                    }
                }
                for i in 0..3 {
                    for j in 0..3 {
                        let about =
                            |squares: [f64; 3]| volume * (squares[(i + 1) % 3] + squares[(i + 2) % 3]);
                        let (central, shift) = if i == j {
                            (about(squares), about(centre.map(|c| c * c)))
                        } else {
                            (0.0, -volume * centre[i] * centre[j])
                        };
                        assert_contains(measures.inertia_about_centroid[i][j], central, 10.0 * volume);
                        assert_contains(measures.inertia_about_origin[i][j], central + shift, 10.0 * volume);
                    }
                }
                assert_symmetric(&measures);
                if depth == 8 {
                    // Half a cell of the surface's area, in all.
                    assert!(measures.volume.width() < 0.5 * volume, "{round} {measures:?}");
                    for axis in 0..3 {
                        let centroid = measures.centroid.unwrap()[axis];
                        let share = measures.volume.width() / volume;
                        assert!(centroid.width() < 2.0 * share + 1e-8, "{measures:?}");
                    }
                }
            }
        }
    }
}

/// The moments of all undecided cells together bound the centroid of a ball at about 2/√3 of the cost: this
/// is the ratio of the root mean square to the mean of a coordinate's magnitude on a sphere.
#[test]
fn the_centroid_is_as_tight_as_it_is_said_to_be() {
    let frame = Frame::new([-1.0; 3], 2.0, 4).unwrap();
    // A ball without slabs.
    let ball = Plain::ball([0.0; 3], 0.9).unwrap();
    let tree = build(&ball, &frame, Rule::Certified, &alone()).unwrap();
    let measures = measure(&ball, &frame, 0.0, &alone()).unwrap();
    // The greatest x of a centroid: all undecided cells beyond a plane belong to the solid.
    let greatest = (0..16).map(|plane| {
        let (mut volume, mut first) = (0.0, 0.0);
        for at in positions(4) {
            let taken = match tree.view().tag_at(at) {
                Tag::Full => true,
                Tag::Partial => at[0] >= plane,
                _ => false,
            };
            if taken {
                volume += 1.0;
                first += (at[0] as f64 + 0.5) / 8.0 - 1.0;
            }
        }
        first / volume
    });
    let greatest = greatest.fold(f64::MIN, f64::max);
    let upper = measures.centroid.unwrap()[0].upper;
    assert!(upper >= greatest && upper < 1.2 * greatest, "{upper} {greatest}");
}

#[test]
fn a_walk_finds_what_a_tree_holds() {
    let mut random = Random(3);
    for (depth, tolerance) in [(5, 0.0), (8, 0.0), (repeated(6, 9), 0.0), (11, 0.03), (20, 0.02)] {
        let centre = [0, 1, 2].map(|_| random.between(-0.1, 0.1));
        let frame = Frame::new([-1.0; 3], 2.0, depth).unwrap();
        let ball = Plain::ball(centre, 0.8).unwrap();
        let measures = measure(&ball, &frame, tolerance, &alone()).unwrap();
        let tree =
            build(&ball, &frame.with_depth(measures.level).unwrap(), Rule::Certified, &Control::default());
        let tree = tree.unwrap();
        assert_eq!(measures.volume, tree.statistics().volume(), "{measures:?}");
        let end = if tolerance > 0.0 { StopReason::Tolerance } else { StopReason::Exhausted };
        assert_eq!(measures.stop_reason, end, "{measures:?}");
        assert!(tolerance > 0.0 || measures.level == depth);
        assert!(measures.splits >= tree.statistics().nodes());
        assert!(measures.splits <= tree.statistics().nodes() * 16 / 9);
        // The stored tree gives the same as a solid of its own, and has no better bounds.
        let stored = measure(&tree, tree.frame(), 0.0, &alone()).unwrap();
        assert_eq!((stored.volume, stored.stop_reason), (measures.volume, StopReason::Exhausted));
        if measures.level == depth {
            assert_eq!(stored, MassProperties { splits: stored.splits, ..measures });
        }
        // For any number of threads, and behind any type.
        for threads in [2, 5] {
            assert_eq!(measure(&ball, &frame, tolerance, &Control::threads(threads)).unwrap(), measures);
        }
        assert_eq!(measure(&AnySolid::new(ball), &frame, tolerance, &Control::default()).unwrap(), measures);
    }
}

#[test]
fn budgets_are_kept_and_not_wasted() {
    let frame = Frame::new([-1.0; 3], 2.0, 20).unwrap();
    let ball = Plain::ball([0.01, 0.02, 0.03], 0.9).unwrap();
    let volume = 4.0 / 3.0 * PI * 0.9f64.powi(3);
    let mut last = f64::INFINITY;
    let budgets = [0, 1, 2, 9, 10, 65, 337, 1000, 5000, 100_000, 300_000, 600_000];
    for budget in budgets {
        let control = Control { max_splits: Some(budget), ..Control::default() };
        let measures = measure(&ball, &frame, 0.0, &control).unwrap();
        // The last whole pass counts.
        assert!(measures.splits <= budget && measures.stop_reason == StopReason::Budget, "{measures:?}");
        assert!(measures.volume.contains(volume));
        assert!(measures.volume.width() <= last, "{measures:?}");
        last = measures.volume.width();
        let single = Control { threads: 1, ..control };
        assert_eq!(measure(&ball, &frame, 0.0, &single).unwrap(), measures);
        // The largest are split first: no level is begun before the one above is done.
        if budget <= 100_000 {
            let whole = |level: u8| {
                let frame = frame.with_depth(level).unwrap();
                measure(&ball, &frame, 0.0, &alone()).unwrap().splits
            };
            let level = measures.level;
            assert!(level == 0 || whole(level) <= budget);
            assert!(level >= 6 || whole(level + 1) > budget, "{budget} {level}");
        }
    }
    assert!(last < 0.1 * volume, "{last}");
    let control = Control { max_splits: Some(u64::MAX), ..Control::default() };
    let measures = measure(&ball, &frame, 0.05, &control).unwrap();
    assert_eq!(measures.stop_reason, StopReason::Tolerance);
    assert!(measures.volume.width() <= 0.05 * volume * 1.1);
}

/// A solid that counts its calls. Its parts lie in scratch memory, and a wrong part is detected.
struct Counting {
    ball: Plain,
    calls: Arc<AtomicU64>,
}

impl Counting {
    fn new(ball: Plain) -> Counting {
        Counting { ball, calls: Arc::default() }
    }
}

type BallOnFrame = <Plain as Solid>::Classifier;

#[derive(Clone)]
struct CountingOnFrame {
    ball: BallOnFrame,
    calls: Arc<AtomicU64>,
}

struct Stack {
    ball: <BallOnFrame as Classifier>::Worker,
    calls: Arc<AtomicU64>,
    values: Vec<[u32; 4]>,
}

fn key(cell: Cell) -> [u32; 4] {
    let [x, y, z] = cell.at;
    [x, y, z, cell.level as u32]
}

impl Solid for Counting {
    type Classifier = CountingOnFrame;

    fn on(&self, frame: &Frame, control: &Control<'_>) -> Result<CountingOnFrame, Error> {
        Ok(CountingOnFrame { ball: self.ball.on(frame, control)?, calls: self.calls.clone() })
    }
}

impl Classifier for CountingOnFrame {
    type Worker = Stack;

    fn frame(&self) -> &Frame {
        Classifier::frame(&self.ball)
    }

    fn worker(&self) -> Result<Stack, Error> {
        Ok(Stack { ball: self.ball.worker()?, calls: self.calls.clone(), values: Vec::new() })
    }

    fn proof(&self) -> Proof {
        Proof::CERTIFIED
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

impl Parts for Stack {
    type Part = usize;

    fn mark(&self) -> usize {
        self.values.len()
    }

    fn release(&mut self, mark: usize) {
        assert!(mark <= self.values.len());
        self.values.truncate(mark);
    }

    fn scratch_bytes(&self) -> usize {
        0
    }

    fn hand_over(&mut self, from: &Stack, part: &usize) -> Result<usize, Error> {
        self.values.push(from.values[*part]);
        Ok(self.values.len() - 1)
    }
}

impl OneByOne for Stack {}

impl Worker for Stack {
    fn frame(&self) -> &Frame {
        Worker::frame(&self.ball)
    }

    fn root(&mut self) -> Result<Verdict<usize>, Error> {
        self.values.push([0; 4]);
        Ok(match self.ball.root()? {
            Verdict::Partial(_) => Verdict::Partial(self.values.len() - 1),
            _ => Verdict::Undecided,
        })
    }

    fn split(&mut self, cell: Cell, part: &usize) -> Result<[Verdict<usize>; 8], Error> {
        assert_eq!(self.values[*part], key(cell));
        self.calls.fetch_add(1, Relaxed);
        let mut octant = 0;
        Ok(self.ball.split(cell, &())?.map(|verdict| {
            octant += 1;
            match verdict {
                Verdict::Empty => Verdict::Empty,
                Verdict::Full => Verdict::Full,
                Verdict::Undecided => Verdict::Undecided,
                Verdict::Partial(()) => {
                    self.values.push(key(cell.child(octant - 1)));
                    Verdict::Partial(self.values.len() - 1)
                }
            }
        }))
    }

    fn answer(&mut self, _: Cell, _: &usize, _: Question<'_>) -> Result<(), Error> {
        Ok(())
    }
}

#[test]
fn splits_are_counted_as_they_happen() {
    let ball = Plain::ball([0.01, 0.02, 0.03], 0.9).unwrap();
    for (depth, max_splits) in [(4, None), (9, None), (10, Some(77)), (20, Some(repeated(60_000, 300_000)))] {
        let frame = Frame::new([-1.0; 3], 2.0, depth).unwrap();
        for threads in [1, 4] {
            let control = Control { max_splits, threads, ..Control::default() };
            let plain = measure(&ball, &frame, 0.0, &control).unwrap();
            let solid = Counting::new(ball);
            let counted = measure(&solid, &frame, 0.0, &control).unwrap();
            assert_eq!((counted.volume, counted.splits), (plain.volume, plain.splits));
            // A pass that the budget interrupts is wasted, and is not counted.
            let calls = solid.calls.load(Relaxed);
            let spare = max_splits.filter(|&most| most > 1000).map_or(0, |most| most + 10_000);
            assert!(counted.splits <= calls && calls <= counted.splits + spare, "{calls} {counted:?}");
            assert!(counted.clipped && !plain.clipped);
            let any = AnySolid::new(Counting::new(ball));
            assert_eq!(measure(&any, &frame, 0.0, &control).unwrap(), counted);
        }
    }
}

#[test]
fn what_the_universe_clips_is_said() {
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let control = Control::default();
    let clipped = |ball: Csg| measure(&ball, &frame, 0.0, &control).unwrap().clipped;
    assert!(!clipped(Csg::ball([0.0; 3], 1.0).unwrap()));
    assert!(clipped(Csg::ball([0.0; 3], 1.1).unwrap()));
    let ball = build(&Csg::ball([0.0; 3], 1.0).unwrap(), &frame, Rule::Certified, &control).unwrap();
    let outside = complement(ball.view(), &control).unwrap();
    assert!(!measure(&ball, &frame, 0.0, &control).unwrap().clipped);
    let measures = measure(&outside, &frame, 0.0, &control).unwrap();
    assert!(measures.clipped && measures.volume.contains(8.0 - 4.0 / 3.0 * PI));
    let other = Frame::new([-1.0; 3], 2.5, 5).unwrap();
    assert!(matches!(measure(&ball, &other, 0.0, &control), Err(Error::FrameMismatch { .. })));
}

#[test]
fn a_host_s_shape_that_knows_little() {
    let frame = Frame::new([0.0; 3], 1.0, 6).unwrap();
    // Never decided: every cell would be split without any gain.
    let doubtful = Callback::new(|_, _| Ok(Verdict::Partial(()))).with_exterior(Tag::Empty);
    let measures = measure(&doubtful, &frame, 0.1, &Control::default()).unwrap();
    assert_eq!((measures.volume, measures.centroid), (Interval::new(0.0, 1.0).unwrap(), None));
    assert_eq!(measures.stop_reason, StopReason::Exhausted);
    let hopeless = Callback::new(|_, _| Ok(Verdict::Undecided));
    let measures = measure(&hopeless, &frame, 0.1, &Control::default()).unwrap();
    assert_eq!((measures.splits, measures.stop_reason), (0, StopReason::Exhausted));
    // Only the upper half is decided, and no finer than eighths.
    let eighths = Callback::new(|min: [f64; 3], max: [f64; 3]| {
        Ok(match (min[2], max[2]) {
            (low, _) if low >= 0.5 => Verdict::Full,
            _ if max[0] - min[0] <= 0.125 => Verdict::Undecided,
            _ => Verdict::Partial(()),
        })
    });
    let frame = Frame::new([0.0; 3], 1.0, 20).unwrap();
    let measures = measure(&eighths, &frame, 0.1, &Control::default()).unwrap();
    assert_eq!(measures.volume, Interval::new(0.5, 1.0).unwrap());
    assert_eq!((measures.stop_reason, measures.splits, measures.level), (StopReason::Exhausted, 37, 3));
    let z = measures.centroid.unwrap()[2];
    assert!(z.contains(0.5) && z.contains(0.75) && z.lower > 0.4 && z.upper < 0.82, "{z:?}");
    let failing = Callback::new(|_, _| Err(Error::Callback { code: 7 }));
    assert!(matches!(measure(&failing, &frame, 0.1, &Control::default()), Err(Error::Callback { code: 7 })));
}

/// Intervals that overflow or underflow are wide, and true.
#[test]
fn frames_at_the_ends_of_the_range() {
    let large = 2f64.powi(256);
    for edge in [1.0 / large, 2f64.powi(-60), 1.0, 2f64.powi(60), large] {
        for origin in [0.0, 1.0 / large, -1.0, 1.0, large, -large] {
            for depth in [1, 3, 20] {
                let frame = Frame::new([origin, 0.0, -origin], edge, depth).unwrap();
                let half = Callback::new(|_, _| Ok(Verdict::Partial(())));
                let control = Control { max_splits: Some(20), ..alone() };
                for solid in [Tag::Full, Tag::Partial] {
                    let measures = match solid {
                        Tag::Full => {
                            let full = Callback::new(|_, _| Ok(Verdict::Full));
                            measure(&full, &frame, 0.0, &control)
                        }
                        _ => measure(&half, &frame, 0.0, &control),
                    };
                    let measures = measures.unwrap();
                    assert_symmetric(&measures);
                    let one = frame.with_depth(1).unwrap();
                    let mut sums = Sums::new(12.0);
                    positions(1).for_each(|at| sums.add_cell(&one, at));
                    contains_all(&measures, &sums)
                        .unwrap_or_else(|what| panic!("{what}: {frame:?} {measures:?}"));
                    let mut sums = Sums::new(12.0);
                    if solid == Tag::Partial {
                        sums.add_cell(&one, [1, 0, 1]);
                        contains_all(&measures, &sums).unwrap();
                    } else {
                        let x = measures.centroid.unwrap()[0];
                        assert!(x.width() <= 4e-16 * (origin.abs() + edge), "{frame:?} {x:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn it_can_be_watched_and_stopped() {
    let frame = Frame::new([-1.0; 3], 2.0, 10).unwrap();
    let ball = Plain::ball([0.0; 3], 0.9).unwrap();
    let cancel = AtomicBool::new(false);
    let seen = std::sync::Mutex::new(Vec::new());
    let progress = |fraction: f64| seen.lock().unwrap().push(fraction);
    let control = Control { threads: 1, progress: Some(&progress), ..Control::default() };
    measure(&ball, &frame, 0.0, &control).unwrap();
    {
        let seen = seen.lock().unwrap();
        assert!(seen.len() > 100 && seen.is_sorted() && *seen.last().unwrap() == 1.0, "{seen:?}");
    }
    let stop = |fraction: f64| cancel.store(fraction > 0.9, Relaxed);
    for threads in [1, 2] {
        cancel.store(false, Relaxed);
        let control = Control { threads, cancel: Some(&cancel), progress: Some(&stop), ..Control::default() };
        assert!(matches!(measure(&ball, &frame, 0.001, &control), Err(Error::Cancelled)));
    }
    for tolerance in [-1.0, f64::NAN] {
        let refused = measure(&ball, &frame, tolerance, &Control::default());
        assert!(matches!(refused, Err(Error::Argument { name: "tolerance", .. })));
    }
}

fn sums_of(mesh: &TriangleMesh) -> Sums {
    let mut sums = Sums::new(120.0);
    for triangle in mesh.triangles() {
        sums.add_triangle(triangle.map(|vertex| mesh.vertices()[vertex as usize]));
    }
    sums
}

#[test]
fn a_mesh_against_the_divergence_theorem() {
    let Some(path) = model("featuretype.STL") else { return };
    let mesh = exchange::read_mesh(&std::fs::read(path).unwrap(), &Default::default()).unwrap().mesh;
    let (min, max) = mesh.bounds();
    let sums = sums_of(&mesh);
    for depth in [3, 6, 9] {
        let frame = Frame::around(min, max, depth).unwrap();
        let solid = MeshSolid::new(mesh.clone(), FillRule::NonZero).unwrap();
        let measures = measure(&solid, &frame, 0.0, &Control::default()).unwrap();
        contains_all(&measures, &sums).unwrap();
        assert!(!measures.clipped);
        let width = measures.volume.width() / measures.volume.upper;
        assert!(depth < 9 || width < 0.1, "{width}");
        println!("depth {depth}: {:?} in {} splits", measures.volume, measures.splits);
    }
}

// --- Bounding boxes
// ----------------------------------------------------------------------------------------------

/// Returns the bounding box of all finest cells for which `tag` holds, in planes.
fn hull(dense: &Dense, tag: impl Fn(Tag) -> bool) -> Option<[[u32; 3]; 2]> {
    let cells: Vec<[u32; 3]> = positions(dense.depth).filter(|&at| tag(dense.at(at))).collect();
    let of = |axis: usize| cells.iter().map(move |at| at[axis]);
    (!cells.is_empty()).then(|| {
        [[0, 1, 2].map(|axis| of(axis).min().unwrap()), [0, 1, 2].map(|axis| of(axis).max().unwrap() + 1)]
    })
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn boxes_of_cells(shape in shapes(1..=4), seed: u64, budget in 0..60u64) {
        let dense = shape.dense();
        let mut random = Random(seed);
        let frame = frame(&mut random, shape.depth);
        let solid = DenseSolid { dense: &dense, exterior: Tag::Empty };
        let outer = hull(&dense, |tag| tag != Tag::Empty);
        let inner = hull(&dense, |tag| tag == Tag::Full);
        for max_splits in [None, Some(budget)] {
            let control = Control { max_splits, ..alone() };
            let extent = bounding_box(&solid, &frame, 0.0, &control).unwrap();
            prop_assert!(max_splits.is_none_or(|most| extent.splits <= most));
            prop_assert!(inner.is_some() || !extent.occupied);
            prop_assert!(outer.is_none() || extent.corners.is_some());
            if max_splits.is_none() {
                prop_assert_eq!((extent.corners.is_some(), extent.occupied), (outer.is_some(), inner.is_some()));
            }
            let (Some(corners), Some(outer)) = (extent.corners, outer) else { continue };
            // The possible range over every choice of the undecided cells.
            let latest = inner.unwrap_or([outer[1], outer[0]]);
            for axis in 0..3 {
                let plane = |i: u32| frame.plane(axis, i);
                let [min, max] = [corners[0][axis], corners[1][axis]];
                let [first, last] = [plane(outer[0][axis]), plane(outer[1][axis])];
                let [near, far] = [plane(latest[0][axis]), plane(latest[1][axis])];
                prop_assert!(min.lower <= first.lower && min.upper >= near.upper);
                prop_assert!(max.upper >= last.upper && max.lower <= far.lower);
                if max_splits.is_none() {
                    // As narrow as can be, or no wider than a cell.
                    let cell = frame.cell_size() + 1e-9;
                    prop_assert!((min.lower, min.upper) == (first.lower, near.upper) || min.width() <= cell);
                    prop_assert!((max.lower, max.upper) == (far.lower, last.upper) || max.width() <= cell);
                }
            }
        }
    }
}

#[test]
fn boxes_of_balls_and_blocks() {
    let mut random = Random(23);
    for (depth, tolerance) in [(1, 0.0), (2, 0.0), (5, 0.0), (10, 0.0), (20, 0.02), (20, 0.001)] {
        let frame = Frame::new([-2.0, -2.1, -2.2], 4.3, depth).unwrap();
        for _ in 0..10 {
            let centre = [0, 1, 2].map(|_| random.between(-0.5, 0.5));
            let radius = random.between(0.8, 1.2);
            let [min, max] = [-1.0, 1.0].map(|sign| centre.map(|c| c + sign * radius));
            let ball = AnySolid::new(Csg::ball(centre, radius).unwrap());
            let block = AnySolid::new(Csg::cuboid(min, max).unwrap());
            // Planes are known up to rounding, at any depth.
            for (solid, ended) in [(ball, StopReason::Exhausted), (block, StopReason::Tolerance)] {
                let ended = if tolerance > 0.0 { StopReason::Tolerance } else { ended };
                let extent = bounding_box(&solid, &frame, tolerance, &Control::default()).unwrap();
                let corners = extent.corners.unwrap();
                let wide = tolerance.max(frame.cell_size()) + 1e-15;
                for axis in 0..3 {
                    assert_contains(corners[0][axis], min[axis], 1.0);
                    assert_contains(corners[1][axis], max[axis], 1.0);
                    for corner in corners {
                        assert!(depth < 10 || corner[axis].width() <= wide, "{depth} {extent:?}");
                    }
                }
                assert!(
                    depth < 10 || extent.occupied && extent.stop_reason == ended,
                    "{depth} {tolerance} {extent:?}"
                );
                assert!(!extent.clipped);
                assert!(extent.splits < 1000, "{depth} {tolerance} {extent:?}");
                let same: Extent = bounding_box(&solid, &frame, tolerance, &Control::threads(3)).unwrap();
                assert_eq!(same, extent);
            }
        }
    }
    // On the lattice, no cell is open.
    let frame = Frame::new([-4.0; 3], 8.0, 20).unwrap();
    let solid = Csg::cuboid([-2.0, -1.0, 0.0], [2.0, 3.0, 1.0]).unwrap();
    let extent = bounding_box(&solid, &frame, 0.0, &Control::default()).unwrap();
    let corners = [[-2.0, -1.0, 0.0], [2.0, 3.0, 1.0]].map(|corner| corner.map(Interval::exactly));
    assert_eq!(extent.corners, Some(corners));
    assert!(extent.splits < 200, "{extent:?}");
}

#[test]
fn boxes_of_what_is_empty_or_unknown() {
    let frame = Frame::new([0.0; 3], 1.0, 4).unwrap();
    let control = Control::default();
    let far = Csg::ball([9.0; 3], 1.0).unwrap();
    let extent = bounding_box(&far, &frame, 0.0, &control).unwrap();
    assert_eq!((extent.corners, extent.occupied, extent.splits), (None, false, 0));
    let doubtful = Callback::new(|_, _| Ok(Verdict::Partial(()))).with_exterior(Tag::Empty);
    let extent = bounding_box(&doubtful, &frame, 0.0, &control).unwrap();
    let all = Interval::new(0.0, 1.0).unwrap();
    assert_eq!((extent.corners, extent.stop_reason), (Some([[all; 3]; 2]), StopReason::Exhausted));
    assert!(!extent.occupied && !extent.clipped);
    let limited = Control { max_splits: Some(100), ..control };
    let extent = bounding_box(&doubtful, &frame, 0.0, &limited).unwrap();
    assert_eq!((extent.corners, extent.stop_reason), (Some([[all; 3]; 2]), StopReason::Budget));
    assert!(extent.splits <= 100);
    let cancel = AtomicBool::new(true);
    let cancelled = Control { cancel: Some(&cancel), ..control };
    assert!(bounding_box(&far, &frame, -1.0, &control).is_err());
    assert!(bounding_box(&far, &frame, f64::NAN, &control).is_err());
    assert!(matches!(bounding_box(&far, &frame, 0.0, &cancelled), Err(Error::Cancelled)));
}
