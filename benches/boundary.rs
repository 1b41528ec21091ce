//! What the C interface costs: point queries through its functions against the same from Rust.
//!
//! ```text
//! cargo bench --bench boundary --features capi
//! ```
//!
//! The functions are called through pointers that the compiler cannot see through, as a C program would call
//! them. `c_tests/boundary.c` measures the same ball and points from C.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use leafless::capi::*;
use leafless::{Control, Csg, Frame, Membership, PointCursor, Rule, build};
use std::hint::black_box;
use std::ptr::{null, null_mut};

const POINTS: usize = 1_000_000;

type Contains =
    unsafe extern "C" fn(*const leafless_octree, *const f64, *mut leafless_membership) -> leafless_status;
type ContainsMany = unsafe extern "C" fn(
    *const leafless_octree,
    *const f64,
    u64,
    *mut leafless_membership,
) -> leafless_status;
type CursorContains =
    unsafe extern "C" fn(*mut leafless_point_cursor, *const f64, *mut leafless_membership) -> leafless_status;

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

fn ok(status: leafless_status) {
    assert_eq!(status, leafless_status::LEAFLESS_OK);
}

/// The ball of radius 3/4 in 1024 cells per axis, certified, made through the interface.
fn ball_of_c() -> *mut leafless_octree {
    let frame = leafless_frame { origin: [-1.0; 3], edge: 2.0, depth: 10 };
    let (mut solid, mut octree) = (null_mut(), null_mut());
    // SAFETY: all pointers point to what the functions ask for.
    unsafe {
        ok(leafless_solid_new_ball([0.0; 3].as_ptr(), 0.75, &mut solid));
        let rule = leafless_rule::LEAFLESS_RULE_CERTIFIED as u32;
        ok(leafless_octree_build(solid, &frame, rule, null(), &mut octree));
        leafless_solid_free(solid);
    }
    octree
}

fn boundary(criterion: &mut Criterion) {
    let points = points();
    let lines = lines(&points);
    let frame = Frame::new([-1.0; 3], 2.0, 10).expect("a frame");
    let ball = Csg::ball([0.0; 3], 0.75).expect("a ball");
    let rust = build(&ball, &frame, Rule::Certified, &Control::default()).expect("an octree");
    let c = ball_of_c();
    let mut cursor_of_c = null_mut();
    // SAFETY: `c` is an octree.
    ok(unsafe { leafless_point_cursor_new(c, &mut cursor_of_c) });

    let contains: Contains = black_box(leafless_octree_contains);
    let contains_many: ContainsMany = black_box(leafless_octree_contains_many);
    let cursor_contains: CursorContains = black_box(leafless_point_cursor_contains);
    // SAFETY of all calls below: living handles, arrays as long as is said.
    let one_of_c = |point: &[f64; 3]| {
        let mut answer = leafless_membership::LEAFLESS_MEMBERSHIP_UNDECIDED;
        unsafe { contains(c, point.as_ptr(), &mut answer) };
        answer as u8
    };
    let near_of_c = |point: &[f64; 3]| {
        let mut answer = leafless_membership::LEAFLESS_MEMBERSHIP_UNDECIDED;
        unsafe { cursor_contains(cursor_of_c, point.as_ptr(), &mut answer) };
        answer as u8
    };
    let mut answers = vec![leafless_membership::LEAFLESS_MEMBERSHIP_UNDECIDED; POINTS];
    let mut memberships = vec![Membership::Undecided; POINTS];
    for point in points.iter().step_by(97) {
        assert_eq!(one_of_c(point), rust.contains(*point) as u8);
    }

    let mut group = criterion.benchmark_group("boundary");
    group.throughput(Throughput::Elements(POINTS as u64)).sample_size(20);
    let inside = Membership::Inside as u8;
    group.bench_function("one by one, Rust", |bencher| {
        bencher.iter(|| points.iter().filter(|&&point| rust.contains(point) as u8 == inside).count());
    });
    group.bench_function("one by one, C", |bencher| {
        bencher.iter(|| points.iter().filter(|point| one_of_c(point) == inside).count());
    });
    group.bench_function("batch, Rust", |bencher| {
        bencher.iter(|| rust.contains_many(&points, &mut memberships).expect("as long as the points"));
    });
    group.bench_function("batch, C", |bencher| {
        bencher.iter(|| unsafe {
            ok(contains_many(c, points.as_ptr().cast(), POINTS as u64, answers.as_mut_ptr()));
        });
    });
    group.bench_function("lines, Rust", |bencher| {
        let mut cursor = PointCursor::new(rust.view());
        bencher.iter(|| lines.iter().filter(|&&point| cursor.contains(point) as u8 == inside).count());
    });
    group.bench_function("lines, C", |bencher| {
        bencher.iter(|| lines.iter().filter(|point| near_of_c(point) == inside).count());
    });
    group.finish();
    // SAFETY: made above, and not used any more.
    unsafe {
        leafless_point_cursor_free(cursor_of_c);
        leafless_octree_free(c);
    }
}

criterion_group!(benches, boundary);
criterion_main!(benches);
