//! A host program with slow functions: the number of calls, the number of calling threads, and the delay of a
//! cancel.

use leafless::lattice::Cube;
use leafless::op::{Refinement, Zone};
use leafless::solid::{Adaptive, Batch, Prepared, SplitCounter, Transform};
use leafless::{
    Affine, AnySolid, Bounds, Callback, Classifier, Control, Csg, Error, Frame, LazyOctree, Membership,
    Octree, Rule, Solid, SurfaceOptions, Verdict, Worker, bounding_box, build, build_extended, clearance,
    contains, interference, measure,
};
use leafless_testkit::csg::Model;
use leafless_testkit::exact::Exact;
use leafless_testkit::{Random, Way};
use std::collections::HashSet;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

/// The recorded calls of the host.
#[derive(Default)]
struct Calls {
    boxes: AtomicU64,
    batches: AtomicU64,
    largest: AtomicU64,
    points: AtomicU64,
    threads: Mutex<HashSet<ThreadId>>,
    /// Number of calls that began after the cancel.
    late: AtomicU64,
    cancelled: AtomicBool,
    under_way: AtomicU64,
    most_under_way: AtomicU64,
}

impl Calls {
    fn begin(&self, boxes: u64) {
        self.boxes.fetch_add(boxes, Relaxed);
        self.batches.fetch_add(1, Relaxed);
        self.largest.fetch_max(boxes, Relaxed);
        self.threads.lock().unwrap().insert(thread::current().id());
        self.late.fetch_add(self.cancelled.load(Relaxed) as u64, Relaxed);
        self.most_under_way.fetch_max(self.under_way.fetch_add(1, Relaxed) + 1, Relaxed);
    }

    fn end(&self) {
        self.under_way.fetch_sub(1, Relaxed);
    }

    fn threads(&self) -> usize {
        self.threads.lock().unwrap().len()
    }
}

const CENTRE: [f64; 3] = [0.45, 0.5, 0.55];
const RADIUS: f64 = 0.3;

/// Classifies a box against the ball by its least and greatest distance, with some room for rounding.
fn ball(min: [f64; 3], max: [f64; 3]) -> Verdict<()> {
    let (mut near, mut far) = (0.0, 0.0);
    for axis in 0..3 {
        let (low, high) = (min[axis] - CENTRE[axis], max[axis] - CENTRE[axis]);
        let most = low.abs().max(high.abs());
        let least = if low <= 0.0 && high >= 0.0 { 0.0 } else { low.abs().min(high.abs()) };
        (near, far) = (near + least * least, far + most * most);
    }
    if far <= RADIUS * RADIUS * (1.0 - 1e-12) {
        Verdict::Full
    } else if near >= RADIUS * RADIUS * (1.0 + 1e-12) {
        Verdict::Empty
    } else {
        Verdict::Partial(())
    }
}

/// Returns the signed distance from the ball's surface.
fn distance(point: [f64; 3]) -> f64 {
    let square: f64 = (0..3).map(|axis| (point[axis] - CENTRE[axis]).powi(2)).sum();
    square.sqrt() - RADIUS
}

/// The host's ball. Each call takes `pause`.
fn host(calls: &Arc<Calls>, pause: Duration, many: bool) -> AnySolid {
    let rest = move || {
        if !pause.is_zero() {
            thread::sleep(pause);
        }
    };
    let (own, points) = (calls.clone(), calls.clone());
    let callback = Callback::new(move |min, max| {
        own.begin(1);
        rest();
        own.end();
        Ok(ball(min, max))
    });
    let callback = callback
        .with_contains(move |point| {
            points.points.fetch_add(1, Relaxed);
            points.late.fetch_add(points.cancelled.load(Relaxed) as u64, Relaxed);
            rest();
            Ok(distance(point) <= 0.0)
        })
        .with_bounds(Bounds::new(CENTRE.map(|c| c - RADIUS), CENTRE.map(|c| c + RADIUS)).unwrap());
    if !many {
        return AnySolid::new(callback);
    }
    let own = calls.clone();
    AnySolid::new(callback.with_classify_many(move |boxes, verdicts| {
        own.begin(boxes.len() as u64);
        rest();
        for (verdict, [min, max]) in verdicts.iter_mut().zip(boxes) {
            *verdict = ball(*min, *max);
        }
        own.end();
        Ok(())
    }))
}

fn unit(depth: u8) -> Frame {
    Frame::new([0.0; 3], 1.0, depth).unwrap()
}

/// Returns the number of boxes of all split cells, and of the universe.
fn needed(tree: &Octree) -> u64 {
    8 * tree.statistics().nodes() + 1
}

#[test]
fn a_build_asks_about_each_cell_once_by_all_threads() {
    for depth in 1..=7 {
        let frame = unit(depth);
        for many in [false, true] {
            for threads in [1, 3] {
                let control = Control::threads(threads);
                let reference = build(
                    &host(&Arc::default(), Duration::ZERO, false),
                    &frame,
                    Rule::Certified,
                    &Control::threads(1),
                )
                .unwrap();
                for rule in [Rule::Certified, Rule::Inner, Rule::Outer, Rule::Sampled] {
                    let calls = Arc::new(Calls::default());
                    let tree = build(&host(&calls, Duration::ZERO, many), &frame, rule, &control).unwrap();
                    let boxes = calls.boxes.load(Relaxed);
                    // A certified tree may hold eight undecided finest cells as one.
                    assert!(boxes >= needed(&reference) && boxes % 8 == 1, "{depth} {boxes}");
                    if many {
                        // One batch a level and thread.
                        assert!(calls.batches.load(Relaxed) <= 1 + depth as u64 * threads as u64);
                    }
                    if rule == Rule::Certified {
                        assert_eq!(tree, reference);
                    }
                    if rule == Rule::Sampled {
                        assert!(calls.points.load(Relaxed) > 0 || depth == 1);
                    }
                }
            }
        }
    }
}

#[test]
fn shallow_builds_use_threads() {
    let frame = unit(4);
    for many in [false, true] {
        let calls = Arc::new(Calls::default());
        build(&host(&calls, Duration::from_millis(10), many), &frame, Rule::Certified, &Control::threads(4))
            .unwrap();
        assert!(calls.threads() >= 4, "{}", calls.threads());
        assert!(calls.most_under_way.load(Relaxed) >= 3);
    }
}

#[test]
fn deep_builds_ask_in_batches() {
    let calls = Arc::new(Calls::default());
    let frame = unit(10);
    let tree =
        build(&host(&calls, Duration::ZERO, true), &frame, Rule::Certified, &Control::threads(2)).unwrap();
    let (boxes, batches) = (calls.boxes.load(Relaxed), calls.batches.load(Relaxed));
    assert!(boxes / batches > 1000, "{boxes} in {batches}");
    assert!(calls.largest.load(Relaxed) > 100_000);
    let exact =
        build(&Csg::ball(CENTRE, RADIUS).unwrap(), &frame, Rule::Certified, &Control::default()).unwrap();
    let (host, exact) = (tree.statistics().volume(), exact.statistics().volume());
    assert!((host.lower - exact.lower).abs() < 1e-6 && (host.upper - exact.upper).abs() < 1e-6);
}

/// Extended trees, too, query the host level by level: a call for each level and thread, however many cells
/// there are.
#[test]
fn extended_builds_ask_level_by_level() {
    let plain =
        build(&host(&Arc::default(), Duration::ZERO, false), &unit(7), Rule::Certified, &Control::threads(1))
            .unwrap();
    // Solids of a host keep no surfaces; the other operands of an expression do.
    let block = Csg::cuboid([0.2, 0.21, 0.22], [0.95, 0.96, 0.97]).unwrap();
    let mut sizes = Vec::new();
    for threads in [1, 3] {
        let control = Control::threads(threads);
        let options = SurfaceOptions::default();
        let calls = Arc::new(Calls::default());
        let solid = host(&calls, Duration::ZERO, true);
        let tree = build_extended(&solid, &unit(7), &options, &control).unwrap();
        tree.view().check().unwrap();
        assert_eq!(tree.without_cuts(), plain);
        assert_eq!(tree.view().cuts().unwrap().cells, 0);
        let batches = |calls: &Calls| calls.batches.load(Relaxed);
        assert!(batches(&calls) <= 1 + 7 * threads as u64, "{}", batches(&calls));
        let calls = Arc::new(Calls::default());
        let part = block.difference(&Csg::solid(host(&calls, Duration::ZERO, true))).unwrap();
        let tree = build_extended(&part, &unit(7), &options, &control).unwrap();
        tree.view().check().unwrap();
        assert!(batches(&calls) <= 1 + 7 * threads as u64, "{}", batches(&calls));
        let cuts = tree.view().cuts().unwrap();
        assert!(cuts.cells > 20 && cuts.surfaces == 6, "{cuts:?}");
        sizes.push(tree);
    }
    assert_eq!(sizes[0], sizes[1]);
    // A tree deeper than a single batch of queries.
    let calls = Arc::new(Calls::default());
    let solid = host(&calls, Duration::ZERO, true);
    let tree = build_extended(&solid, &unit(9), &SurfaceOptions::default(), &Control::threads(2)).unwrap();
    let reference =
        build(&host(&Arc::default(), Duration::ZERO, false), &unit(9), Rule::Certified, &Control::default());
    assert_eq!(tree.without_cuts(), reference.unwrap());
}

#[test]
fn lazy_octrees_never_replay_and_use_threads() {
    let frame = unit(6);
    let calls = Arc::new(Calls::default());
    let mut lazy = LazyOctree::new(host(&calls, Duration::from_millis(1), false), &frame).unwrap();
    assert_eq!(lazy.refine(&Zone::Whole, 4, &Control::threads(4)).unwrap(), Refinement::Done);
    assert_eq!(calls.boxes.load(Relaxed), 8 * lazy.splits() + 1);
    assert!(calls.threads() >= 4);
    assert_eq!(lazy.replays(), 0);
    // The same split cells as with one thread, in the same octree; also under a budget. (A limit on bytes
    // makes it split cell by cell.)
    let serial = Control { max_bytes: Some(1 << 40), ..Control::threads(1) };
    let mut alone = LazyOctree::new(host(&Arc::default(), Duration::ZERO, false), &frame).unwrap();
    alone.refine(&Zone::Whole, 4, &serial).unwrap();
    assert_eq!((alone.splits(), alone.statistics().volume()), (lazy.splits(), lazy.statistics().volume()));
    let mut limited = LazyOctree::new(host(&Arc::default(), Duration::ZERO, true), &frame).unwrap();
    let control = Control { max_splits: Some(37), ..Control::threads(3) };
    let mut refined = 0;
    while limited.refine(&Zone::Whole, 4, &control).unwrap() == Refinement::Spent {
        refined += 1;
        assert_eq!(limited.splits(), 37 * refined);
    }
    assert_eq!(limited.splits(), lazy.splits());
    assert_eq!(limited.freeze(&control).unwrap(), lazy.freeze(&control).unwrap());
    // Along a ray, too.
    let zone = Zone::Ray { origin: [0.0, 0.5, 0.5], direction: [1.0, 0.1, 0.0], from: 0.0, to: 2.0 };
    lazy.refine(&zone, 6, &Control::threads(2)).unwrap();
    alone.refine(&zone, 6, &serial).unwrap();
    assert_eq!((alone.splits(), alone.statistics().volume()), (lazy.splits(), lazy.statistics().volume()));
}

#[test]
fn measures_use_threads() {
    let calls = Arc::new(Calls::default());
    let frame = unit(5);
    let found =
        measure(&host(&calls, Duration::from_millis(10), true), &frame, 0.0, &Control::threads(4)).unwrap();
    assert!(found.volume.contains(4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3)) && !found.clipped);
    assert!(calls.threads() >= 4);
    assert_eq!(calls.boxes.load(Relaxed), 8 * found.splits + 1);
}

/// Runs work in another thread, cancels it after some calls of the host, and returns its result.
fn cancelled(
    calls: &Arc<Calls>,
    work: impl FnOnce(&Control<'_>) -> Result<(), Error> + Send,
) -> Result<(), Error> {
    let flag = AtomicBool::new(false);
    thread::scope(|scope| {
        let control = Control { cancel: Some(&flag), ..Control::threads(3) };
        let done = scope.spawn(move || work(&control));
        let begun = Instant::now();
        while calls.batches.load(Relaxed) + calls.points.load(Relaxed) < 40 {
            assert!(begun.elapsed() < Duration::from_secs(60), "the host is not called");
            thread::yield_now();
        }
        flag.store(true, Relaxed);
        calls.cancelled.store(true, Relaxed);
        done.join().unwrap()
    })
}

#[test]
fn a_cancel_waits_for_the_calls_under_way() {
    let frame = unit(9);
    let pause = Duration::from_millis(20);
    type Work = fn(AnySolid, Frame, &Control<'_>) -> Result<(), Error>;
    let works: [(&str, Work); 6] = [
        ("build", |solid, frame, control| build(&solid, &frame, Rule::Certified, control).map(drop)),
        ("measure", |solid, frame, control| measure(&solid, &frame, 0.0, control).map(drop)),
        ("bounding box", |solid, frame, control| bounding_box(&solid, &frame, 0.0, control).map(drop)),
        ("interference", |solid, frame, control| {
            interference(&solid, &Csg::everything(), &frame, 0.0, control).map(drop)
        }),
        ("clearance", |solid, frame, control| {
            clearance(&solid, &Csg::ball([0.9; 3], 0.05)?, &frame, 0.0, control).map(drop)
        }),
        ("lazy", |solid, frame, control| {
            LazyOctree::new(solid, &frame)?.refine(&Zone::Whole, 9, control).map(drop)
        }),
    ];
    for (name, work) in works {
        let calls = Arc::new(Calls::default());
        let solid = host(&calls, pause, false);
        let done = cancelled(&calls, |control| work(solid, frame, control));
        assert!(matches!(done, Err(Error::Cancelled)), "{name}: {done:?}");
        // Each of three threads may have checked the flag just before, and then begins its last call.
        assert!(calls.late.load(Relaxed) <= 3, "{name}: {} calls", calls.late.load(Relaxed));
    }
}

#[test]
fn distances_decide_cells() {
    let frame = unit(6);
    let asked = Arc::new(AtomicU64::new(0));
    let classified = Arc::new(AtomicU64::new(0));
    let truth = 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3);
    for with_boxes in [false, true] {
        let (asked, classified) = (asked.clone(), classified.clone());
        let callback = Callback::new(move |min, max| {
            classified.fetch_add(1, Relaxed);
            Ok(if with_boxes { ball(min, max) } else { Verdict::Partial(()) })
        });
        let solid = callback.with_distance(move |points, distances| {
            asked.fetch_add(points.len() as u64, Relaxed);
            for (found, &point) in distances.iter_mut().zip(points) {
                // A lower bound: nine tenths, and nothing for some points.
                *found = match point[0].to_bits() % 7 {
                    0 => f64::NAN,
                    1 => 0.0,
                    _ => 0.9 * distance(point),
                };
            }
            Ok(())
        });
        let tree = build(&solid, &frame, Rule::Certified, &Control::default()).unwrap();
        assert!(tree.statistics().volume().contains(truth));
        let exact =
            build(&Csg::ball(CENTRE, RADIUS).unwrap(), &frame, Rule::Certified, &Control::default()).unwrap();
        if with_boxes {
            assert!(tree.statistics().volume().width() < 1.01 * exact.statistics().volume().width());
        }
        assert!(solid.fingerprint().is_none());
    }
    assert!(classified.load(Relaxed) < asked.load(Relaxed));
}

/// Wraps a host's solid in several solids of the same size, or of the same size plus a box in a corner.
fn wrapped(solid: AnySolid) -> Vec<(&'static str, AnySolid)> {
    let corner = || Csg::cuboid([0.0625; 3], [0.125; 3]).unwrap();
    // Rotations about the ball's centre, by the angle with cosine 0.8 and by a quarter turn.
    let about = |[x, y]: [[f64; 2]; 2]| {
        let [a, b, _] = CENTRE;
        let moved = [x, y].map(|row| row[0] * a + row[1] * b);
        let rows = [[x[0], x[1], 0.0, a - moved[0]], [y[0], y[1], 0.0, b - moved[1]], [0.0, 0.0, 1.0, 0.0]];
        Affine::new(rows).unwrap()
    };
    let (turn, quarter) = (about([[0.8, -0.6], [0.6, 0.8]]), about([[0.0, -1.0], [1.0, 0.0]]));
    let still = Affine::translation([0.0; 3]).unwrap();
    let nested = SplitCounter::new(Adaptive::new(Csg::solid(solid.clone()), 0.0).unwrap());
    let twice = AnySolid::new(Transform::of(AnySolid::new(Prepared::new(solid.clone())), &still));
    vec![
        ("alone", solid.clone()),
        ("united with a box", AnySolid::new(Csg::union_of([Csg::solid(solid.clone()), corner()]).unwrap())),
        ("less a box", AnySolid::new(Csg::solid(solid.clone()).difference(&corner()).unwrap())),
        ("turned", solid.placed(&turn).unwrap()),
        ("turned by a quarter", solid.placed(&quarter).unwrap()),
        ("under three wrappers", AnySolid::new(nested)),
        ("under a transform of another solid", twice),
        (
            "turned under an expression",
            AnySolid::new(Csg::union_of([Csg::solid(solid), corner()]).unwrap().placed(&turn).unwrap()),
        ),
    ]
}

/// The factor by which a rotated shape may receive more boxes. Cells of a rotated lattice have larger
/// bounding boxes.
const TURNED: u64 = 3;

#[test]
fn wrappers_hand_on_many_questions_at_once() {
    let frame = unit(5);
    for many in [false, true] {
        let mut alone = 0;
        for (k, (name, _)) in wrapped(host(&Arc::default(), Duration::ZERO, many)).into_iter().enumerate() {
            let solid = |calls: &Arc<Calls>| wrapped(host(calls, Duration::ZERO, many)).swap_remove(k).1;
            let (calls, control) = (Arc::new(Calls::default()), Control::threads(3));
            let tree = build(&solid(&calls), &frame, Rule::Certified, &control).unwrap();
            let (boxes, batches) = (calls.boxes.load(Relaxed), calls.batches.load(Relaxed));
            if k == 0 {
                alone = boxes;
            }
            let most =
                if name.contains("turned") && !name.contains("quarter") { TURNED * alone } else { alone + 8 };
            assert!(alone / 2 < boxes && boxes <= most, "{name}: {boxes} boxes, {alone} alone");
            // Two rounds a level (some cells are found on the way), times the number of threads.
            assert!(!many || batches <= 2 * (1 + 5 * 3), "{name}: {boxes} boxes in {batches} calls");
            // The result does not depend on the way of the queries.
            let serial =
                build(&solid(&Arc::default()), &frame, Rule::Certified, &Control::threads(1)).unwrap();
            assert_eq!(tree, serial, "{name}");
            let volume = tree.statistics().volume();
            let ball = 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3);
            let corner = 0.0625f64.powi(3);
            let truth =
                if name.contains("united") || name.contains("expression") { ball + corner } else { ball };
            assert!(volume.contains(truth), "{name}: {volume:?}");
            // Points are answered without cells if nothing is rounded.
            let calls = Arc::new(Calls::default());
            let mut answers = [Membership::Undecided; 3];
            let points = [CENTRE, [0.1; 3], [0.46875, 0.5, 0.953125]];
            contains(&solid(&calls), &frame, &points, &mut answers, &control).unwrap();
            assert_eq!(answers[0], Membership::Inside, "{name}");
            assert_eq!(answers[2], Membership::Outside, "{name}");
            if !name.contains("turned") {
                assert_eq!(calls.points.load(Relaxed), 3, "{name}");
            }
            // Sampled, too.
            let sampled = build(&solid(&Arc::default()), &frame, Rule::Sampled, &control).unwrap();
            let serial = build(&solid(&Arc::default()), &frame, Rule::Sampled, &Control::threads(1)).unwrap();
            assert_eq!(sampled, serial, "{name}");
            let cells = (sampled.statistics().volume().lower - truth).abs();
            assert!(cells < 0.003, "{name}: {cells}");
        }
    }
}

#[test]
fn wrapped_hosts_are_asked_by_several_threads() {
    let frame = unit(4);
    for k in 0..wrapped(host(&Arc::default(), Duration::ZERO, true)).len() {
        for many in [false, true] {
            let calls = Arc::new(Calls::default());
            let (name, solid) = wrapped(host(&calls, Duration::from_millis(1), many)).swap_remove(k);
            let found = measure(&solid, &frame, 0.0, &Control::threads(4)).unwrap();
            assert!(calls.threads() >= 2, "{name}: {} threads", calls.threads());
            assert!(found.volume.width() < 0.2, "{name}");
            let calls = Arc::new(Calls::default());
            let (_, solid) = wrapped(host(&calls, Duration::from_millis(1), many)).swap_remove(k);
            let mut lazy = LazyOctree::new(solid, &frame).unwrap();
            lazy.refine(&Zone::Whole, 3, &Control::threads(4)).unwrap();
            // (One thread finds the cells on the way to a cell.)
            assert!(name.contains("transform") || calls.threads() >= 2, "{name}: {}", calls.threads());
        }
    }
}

/// A moved ball by its definition, against exact arithmetic.
#[test]
fn what_is_proven_of_a_moved_host_is_true() {
    let mut random = Random(77);
    let (mut decided, mut exact) = (0, 0);
    for round in 0..600 {
        let model = Model::Ellipsoid(CENTRE, [RADIUS; 3]);
        let small = |random: &mut Random| random.between(-1.5, 1.5);
        let rows = if round % 3 == 0 {
            // Nothing is rounded.
            [[0.0, -2.0, 0.0, 1.25], [0.5, 0.0, 0.0, 0.25], [0.0, 0.0, -1.0, 1.0]]
        } else {
            [0; 3].map(|_| [0; 4].map(|_| small(&mut random)))
        };
        let Ok(placement) = Affine::new(rows) else { continue };
        let again = Affine::translation([0.125, -0.25, 0.0]).unwrap();
        let moved = host(&Arc::default(), Duration::ZERO, round % 2 == 0).placed(&placement).unwrap();
        let moved = moved.placed(&again).unwrap();
        let model = Model::Placed(Box::new(Model::Placed(Box::new(model), placement)), again);
        let frame = Frame::new([-1.0 + 0.1 * f64::from(round % 2); 3], 3.0, 7).unwrap();
        let Some(mut way) = Way::new(moved.on(&frame, &Control::default()).unwrap().worker().unwrap()) else {
            continue;
        };
        while way.cell.level < frame.depth() {
            let (min, max) = Cube { frame: &frame, cell: way.cell }.bounds();
            let verdicts = way.worker.split(way.cell, &way.part).unwrap();
            for (octant, verdict) in (0..8).zip(verdicts) {
                let wanted = match verdict {
                    Verdict::Full => 1,
                    Verdict::Empty => -1,
                    _ => continue,
                };
                decided += 1;
                // Points of the inner part of the child, however its corners are rounded.
                let half = |axis: usize| 0.5 * (max[axis] - min[axis]);
                for _ in 0..3 {
                    let point = [0, 1, 2].map(|axis| {
                        let low = min[axis] + f64::from(octant >> axis & 1) * half(axis);
                        Exact::from(low + random.between(1e-9, 1.0 - 1e-9) * half(axis))
                    });
                    let [x, y, z] = point;
                    let sign = model.sign(&[x, y, z, Exact::from(1.0)]);
                    assert!(sign * wanted >= 0, "{verdict:?} of {octant} in {:?}: {model:?}", way.cell);
                }
            }
            // Points without cells.
            let point = [0, 1, 2].map(|axis| (64.0 * random.between(min[axis], max[axis])).round() / 64.0);
            let mut answer = [None];
            way.worker.inside(&[point], &mut answer).unwrap();
            if let Some(inside) = answer[0] {
                exact += 1;
                let [x, y, z] = point.map(Exact::from);
                let sign = model.sign(&[x, y, z, Exact::from(1.0)]);
                assert!(sign * if inside { 1 } else { -1 } >= 0, "{point:?} {inside}: {model:?}");
            }
            if !way.descend(&mut random) {
                break;
            }
        }
    }
    assert!(decided > 5_000 && exact > 200, "{decided} {exact}");
}

#[test]
fn a_host_on_the_lattice_does_not_blur_when_it_is_turned_on_the_lattice() {
    let slab = |min: [f64; 3], max: [f64; 3]| {
        Ok(match (min[2], max[2]) {
            (low, high) if high <= 0.25 || low >= 0.5 => Verdict::Empty,
            (low, high) if low >= 0.25 && high <= 0.5 => Verdict::Full,
            _ => Verdict::Partial(()),
        })
    };
    let quarter = Affine::new([[0.0, 0.0, 1.0, 0.125], [0.0, 1.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 1.0]]).unwrap();
    let turned = AnySolid::new(Callback::new(slab)).placed(&quarter).unwrap();
    let tree = build(&turned, &unit(5), Rule::Certified, &Control::default()).unwrap();
    assert_eq!(tree.statistics().volume(), leafless::Interval::exactly(0.25));
    assert_eq!(tree.view().contains([0.5, 0.1, 0.9]), Membership::Inside);
    assert_eq!(tree.view().contains([0.7, 0.1, 0.9]), Membership::Outside);
}

#[test]
fn errors_and_cancels_pass_through_wrappers() {
    let frame = unit(6);
    for k in 0..wrapped(host(&Arc::default(), Duration::ZERO, true)).len() {
        let asked = Arc::new(AtomicU64::new(0));
        let own = asked.clone();
        let failing = AnySolid::new(
            Callback::new(move |min, max| match own.fetch_add(1, Relaxed) {
                100.. => Err(Error::Callback { code: 7 }),
                _ => Ok(ball(min, max)),
            })
            .with_bounds(Bounds::new(CENTRE.map(|c| c - RADIUS), CENTRE.map(|c| c + RADIUS)).unwrap()),
        );
        let (name, solid) = wrapped(failing).swap_remove(k);
        for threads in [1, 3] {
            let failed = build(&solid, &frame, Rule::Certified, &Control::threads(threads)).map(|_| ());
            assert!(matches!(failed, Err(Error::Callback { code: 7 })), "{name}: {failed:?}");
        }
    }
}

/// A host with 50 ms a call. Printed by `cargo test --release --test solids host:: -- --ignored --nocapture`.
#[test]
#[ignore = "takes three minutes: prints calls, threads and times"]
fn fifty_milliseconds_a_call() {
    let frame = unit(4);
    let pause = Duration::from_millis(50);
    for threads in [1, 2, 8] {
        let control = Control::threads(threads);
        for many in [false, true] {
            let run = |name: &str, work: &dyn Fn(&AnySolid)| {
                let calls = Arc::new(Calls::default());
                let solid = host(&calls, pause, many);
                let begun = Instant::now();
                work(&solid);
                println!(
                    "{name}, {threads} threads, {}: {} boxes in {} calls by {} threads, {:.2} s",
                    if many { "batches" } else { "single boxes" },
                    calls.boxes.load(Relaxed),
                    calls.batches.load(Relaxed),
                    calls.threads(),
                    begun.elapsed().as_secs_f64()
                );
            };
            run("build to depth 3", &|solid| {
                build(solid, &frame.with_depth(3).unwrap(), Rule::Certified, &control).unwrap();
            });
            run("measure to 50 %", &|solid| {
                measure(solid, &frame, 0.5, &control).unwrap();
            });
            run("interference", &|solid| {
                interference(solid, &Csg::ball([0.9; 3], 0.1).unwrap(), &frame, f64::INFINITY, &control)
                    .unwrap();
            });
            let others =
                if threads == 2 { wrapped(host(&Arc::default(), Duration::ZERO, many)).len() } else { 0 };
            for k in 1..others {
                let name = wrapped(host(&Arc::default(), Duration::ZERO, many))[k].0;
                run(&format!("build to depth 3 {name}"), &|solid| {
                    let solid = wrapped(solid.clone()).swap_remove(k).1;
                    build(&solid, &frame.with_depth(3).unwrap(), Rule::Certified, &control).unwrap();
                });
            }
            run("lazy, to level 3", &|solid| {
                LazyOctree::new(solid.clone(), &frame).unwrap().refine(&Zone::Whole, 3, &control).unwrap();
            });
        }
    }
}
