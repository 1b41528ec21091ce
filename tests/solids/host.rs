//! A host program whose functions take their time: how often it is called, by how many threads, and how soon
//! a cancel is answered.

use leafless::op::{Refinement, Zone};
use leafless::{
    AnySolid, Bounds, Callback, Control, Csg, Error, Frame, LazyOctree, Octree, Rule, Solid, Verdict,
    bounding_box, build, clearance, interference, measure,
};
use std::collections::HashSet;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

/// What was asked of the host.
#[derive(Default)]
struct Calls {
    boxes: AtomicU64,
    batches: AtomicU64,
    largest: AtomicU64,
    points: AtomicU64,
    threads: Mutex<HashSet<ThreadId>>,
    /// Calls that began after the cancel.
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

/// The ball, by the least and the greatest distance of a box, with some room for rounding.
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

/// The signed distance from the ball's surface.
fn distance(point: [f64; 3]) -> f64 {
    let square: f64 = (0..3).map(|axis| (point[axis] - CENTRE[axis]).powi(2)).sum();
    square.sqrt() - RADIUS
}

/// The host's ball; each call takes `pause`.
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

/// Boxes of all cells that are split, and the universe.
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

#[test]
fn lazy_octrees_never_replay_and_use_threads() {
    let frame = unit(6);
    let calls = Arc::new(Calls::default());
    let mut lazy = LazyOctree::new(host(&calls, Duration::from_millis(1), false), &frame).unwrap();
    assert_eq!(lazy.refine(&Zone::Whole, 4, &Control::threads(4)).unwrap(), Refinement::Done);
    assert_eq!(calls.boxes.load(Relaxed), 8 * lazy.splits() + 1);
    assert!(calls.threads() >= 4);
    assert_eq!(lazy.replays(), 0);
    // The same cells as one thread splits, in the same octree; also under a budget.
    // (A limit on bytes has it split cell by cell.)
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

/// Runs work in another thread, cancels it once the host has been called some times, and returns what it came
/// to.
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
        // Each of three threads may have looked at the flag just before, and then begins its last call.
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

/// With a host of 50 ms a call, as `cargo test --release --test solids host:: -- --ignored --nocapture` prints it.
#[test]
#[ignore = "takes a minute: prints calls, threads and times"]
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
            run("lazy, to level 3", &|solid| {
                LazyOctree::new(solid.clone(), &frame).unwrap().refine(&Zone::Whole, 3, &control).unwrap();
            });
        }
    }
}
