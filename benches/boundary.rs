//! Point queries from Rust: what `c_tests/boundary.c`, with the same ball and points, is held against for what the C
//! interface costs.
//!
//! ```text
//! cargo bench --bench boundary
//! ```

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use leafless::query::PointCursor;
use leafless::{Control, Csg, Frame, Membership, Rule, build};

const POINTS: usize = 1_000_000;

/// Uniform random points in [-1, 1]³, the same as in `c_tests/boundary.c`.
fn points() -> Vec<[f64; 3]> {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / 9007199254740992.0 * 2.0 - 1.0
    };
    (0..POINTS).map(|_| [next(), next(), next()]).collect()
}

/// Lines of 1000 points through the universe.
fn lines(points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let on_line = |(i, _)| {
        let [y, z, _] = points[i / 1000 * 1000];
        [((i % 1000) as f64 + 0.5) / 500.0 - 1.0, y, z]
    };
    points.iter().enumerate().map(on_line).collect()
}

fn boundary(criterion: &mut Criterion) {
    let points = points();
    let lines = lines(&points);
    let frame = Frame::new([-1.0; 3], 2.0, 10).expect("a frame");
    let ball = Csg::ball([0.0; 3], 0.75).expect("a ball");
    let rust = build(&ball, &frame, Rule::Certified, &Control::default()).expect("an octree");
    let mut memberships = vec![Membership::Undecided; POINTS];

    let mut group = criterion.benchmark_group("boundary");
    group.throughput(Throughput::Elements(POINTS as u64)).sample_size(20);
    let inside = Membership::Inside as u8;
    group.bench_function("one by one", |bencher| {
        bencher.iter(|| points.iter().filter(|&&point| rust.contains(point) as u8 == inside).count());
    });
    group.bench_function("batch", |bencher| {
        bencher.iter(|| rust.contains_many(&points, &mut memberships).expect("as long as the points"));
    });
    group.bench_function("lines", |bencher| {
        let mut cursor = PointCursor::new(rust.view());
        bencher.iter(|| lines.iter().filter(|&&point| cursor.contains(point) as u8 == inside).count());
    });
    group.finish();
}

criterion_group!(benches, boundary);
criterion_main!(benches);
