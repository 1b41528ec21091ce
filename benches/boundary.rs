//! Queries from Rust, as a reference for the cost of the C and C++ interfaces: `c_tests/boundary.c` and
//! `boundary.cpp` have the same ball and points. Like them, this program prints medians of processor time.
//!
//! ```text
//! cargo bench --bench boundary
//! ```

use leafless::query::{DistanceTo, Obstacle, PointCursor};
use leafless::{Control, Csg, Frame, Interval, Membership, Ray, Rule, build};
use rustix::time::{ClockId, clock_gettime};

const POINTS: usize = 1_000_000;
const RAYS: usize = POINTS / 10;
const FAR: usize = POINTS / 1000;
const ROUNDS: usize = 11;

fn now() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 * 1e9 + time.tv_nsec as f64
}

/// Prints the median time of `work` for each of `count` queries. All rounds must return the same.
fn timed<R: PartialEq>(name: &str, count: usize, mut work: impl FnMut() -> R) -> R {
    let mut times = [0.0; ROUNDS];
    let mut results = times.each_mut().map(|time| {
        let start = now();
        let found = std::hint::black_box(work());
        *time = now() - start;
        found
    });
    assert!(results.iter().all(|found| *found == results[0]), "{name}");
    times.sort_unstable_by(f64::total_cmp);
    println!("{name:<22} {:9.2} ns", times[ROUNDS / 2] / count as f64);
    results.swap(0, ROUNDS - 1);
    let [.., first] = results;
    first
}

/// Uniform random points in [-1, 1]³, the same as in `c_tests/boundary.c`.
fn points() -> Vec<[f64; 3]> {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / 9007199254740992.0 * 2.0 - 1.0
    };
    (0..POINTS).map(|_| [next(), next(), next()]).collect()
}

fn main() {
    let points = points();
    let frame = Frame::new([-1.0; 3], 2.0, 10).expect("a frame");
    let ball = Csg::ball([0.0; 3], 0.75).expect("a ball");
    let ball = build(&ball, &frame, Rule::Certified, &Control::default()).expect("an octree");
    let ball = ball.view();

    timed("points one by one", POINTS, || {
        points.iter().filter(|&&point| ball.contains(point) == Membership::Inside).count()
    });
    let mut memberships = vec![Membership::Undecided; POINTS];
    timed("points batch", POINTS, || {
        ball.contains_many(&points, &mut memberships).expect("as long as the points");
    });
    let mut cursor = PointCursor::new(ball);
    timed("points on lines", POINTS, || {
        let on_line = |i: usize| {
            let [y, z, _] = points[i / 1000 * 1000];
            [((i % 1000) as f64 + 0.5) / 500.0 - 1.0, y, z]
        };
        (0..POINTS).filter(|&i| cursor.contains(on_line(i)) == Membership::Inside).count()
    });

    // Rays from each point to the next.
    let ends = points[1..RAYS].iter().chain(&points[..1]);
    let ray = |(from, to): (&[f64; 3], &[f64; 3])| {
        Ray::new(*from, [0, 1, 2].map(|axis| to[axis] - from[axis])).expect("a ray")
    };
    let rays: Vec<Ray> = points.iter().zip(ends).map(ray).collect();
    timed("rays one by one", RAYS, || {
        rays.iter().filter(|ray| ball.cast_ray(ray, Obstacle::Upper).is_some()).count()
    });
    let mut hits = vec![None; RAYS];
    timed("rays batch", RAYS, || {
        ball.cast_rays(&rays, Obstacle::Upper, &mut hits).expect("as long as the rays");
    });

    let far = &points[..FAR];
    timed("distances one by one", FAR, || {
        let distance = |&point| ball.distance(point, DistanceTo::Boundary).expect("an answer").lower;
        far.iter().map(distance).sum::<f64>()
    });
    let (mut distances, control) = (vec![Interval::ALL; FAR], Control::threads(1));
    timed("distances batch", FAR, || {
        ball.distances(far, DistanceTo::Boundary, &mut distances, &control).expect("as long as the points");
    });
}
