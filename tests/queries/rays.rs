//! Rays against dense arrays in integers, and against balls in closed form.

use leafless::query::{Obstacle, RayHit, RaySpans, Sight, line_of_sight, ray_spans};
use leafless::{Csg, Frame, Interval, OctreeRef, Proof, Ray, Rule, Tag, build, cast_rays, file};
use leafless_testkit::exact::Exact;
use leafless_testkit::{Dense, Random, Shape, alone, cases, shapes};
use proptest::prelude::*;
use std::cmp::Ordering;

/// Coordinates are multiples of 2^-UNIT.
const UNIT: u32 = 36;
const ONE: i128 = 1 << UNIT;

/// A number n / d with d > 0.
#[derive(Clone, Copy, Debug)]
struct Fraction(i128, i128);

impl Fraction {
    fn order(self, other: Fraction) -> Ordering {
        (self.0 * other.1).cmp(&(other.0 * self.1))
    }
    fn max(self, other: Fraction) -> Fraction {
        if self.order(other).is_lt() { other } else { self }
    }
    fn min(self, other: Fraction) -> Fraction {
        if self.order(other).is_gt() { other } else { self }
    }
    /// Returns the exact order of a double and this number.
    fn order_of(self, t: f64) -> Ordering {
        if t.is_infinite() {
            return t.total_cmp(&0.0);
        }
        // Both sides times 2^80: no t that a test meets has smaller bits.
        let scaled = t * 2f64.powi(60);
        let (whole, rest) = (scaled.floor(), scaled - scaled.floor());
        let product = whole as i128 * self.1;
        let other = num_shift(self.0);
        match product.cmp(&other) {
            Ordering::Greater => Ordering::Greater,
            _ if other - product >= self.1 => Ordering::Less,
            // The numbers differ by less than 2^-60.
            _ => (rest * self.1 as f64).total_cmp(&((other - product) as f64)),
        }
    }
}

fn num_shift(n: i128) -> i128 {
    n.checked_mul(1 << 60).expect("small numbers")
}

/// A ray with integer numbers: an origin in multiples of 2^-UNIT, and a direction.
#[derive(Clone, Copy, Debug)]
struct Plain {
    from: [i128; 3],
    direction: [i128; 3],
    last: Option<i128>,
}

/// Returns the time range in a closed cell between planes, if it is not empty. The end is `None` if the ray
/// never leaves.
fn passage(ray: &Plain, lower: [u32; 3], upper: [u32; 3]) -> Option<(Fraction, Option<Fraction>)> {
    let (mut entry, mut exit) = (Fraction(0, 1), ray.last.map(|last| Fraction(last, 1)));
    for axis in 0..3 {
        let (from, direction) = (ray.from[axis], ray.direction[axis]);
        let (low, high) = (lower[axis] as i128 * ONE - from, upper[axis] as i128 * ONE - from);
        if direction == 0 {
            if low > 0 || high < 0 {
                return None;
            }
            continue;
        }
        let (near, far) = if direction > 0 { (low, high) } else { (-high, -low) };
        let (near, far) = [near, far].map(|n| Fraction(n, direction.abs() * ONE)).into();
        entry = entry.max(near);
        exit = Some(exit.map_or(far, |exit| exit.min(far)));
    }
    exit.is_none_or(|exit| entry.order(exit).is_le()).then_some((entry, exit))
}

/// Returns the time ranges in all finest cells of these tags.
fn passages(dense: &Dense, ray: &Plain, tags: &[Tag]) -> Vec<(Fraction, Fraction)> {
    leafless_testkit::positions(dense.depth)
        .filter(|&at| tags.contains(&dense.at(at)))
        .filter_map(|at| passage(ray, at, at.map(|a| a + 1)))
        .map(|(entry, exit)| (entry, exit.expect("a ray leaves every cell")))
        .collect()
}

fn ray_of(plain: &Plain) -> Ray {
    let point = |at: [i128; 3]| at.map(|a| a as f64 / ONE as f64);
    let ray = match plain.last {
        None => Ray::new(point(plain.from), plain.direction.map(|d| d as f64)),
        Some(_) => {
            let to = [0, 1, 2].map(|axis| plain.from[axis] + plain.direction[axis] * ONE);
            Ray::between(point(plain.from), point(to))
        }
    };
    ray.expect("good numbers")
}

/// Rays from everywhere in every direction. Many run in planes, along edges and through corners.
fn random_ray(random: &mut Random, depth: u8) -> Plain {
    let n = 1i128 << depth;
    let segment = random.below(3) == 0;
    let grain = [ONE, ONE / 2, ONE / 256, 1][random.below(4) as usize];
    let from = [0; 3].map(|_| {
        let spread = 3 * n * ONE / grain;
        (random.below(spread as u64) as i128 - n * ONE / grain) * grain
    });
    let steepest = if segment { 2 * n as u64 } else { [1, 2, 5, 1000][random.below(4) as usize] };
    loop {
        let mut direction = [0; 3].map(|_| random.below(2 * steepest + 1) as i128 - steepest as i128);
        if random.below(2) == 0 {
            // Towards the middle, or nearly so.
            direction = [0, 1, 2].map(|axis| {
                let towards = (n * ONE / 2 - from[axis]).signum();
                towards * direction[axis].abs()
            });
        }
        if direction != [0; 3] {
            return Plain { from, direction, last: segment.then_some(1) };
        }
    }
}

/// True if `t` is at most a number, and at most two doubles below it.
fn is_just_below(t: f64, number: Fraction) -> bool {
    number.order_of(t).is_le() && number.order_of(t.next_up().next_up()).is_ge()
}

fn is_just_above(t: f64, number: Fraction) -> bool {
    number.order_of(t).is_ge() && number.order_of(t.next_down().next_down()).is_le()
}

fn assert_hit(dense: &Dense, plain: &Plain, on: Obstacle, hit: Option<RayHit>) {
    let first =
        |tags: &[Tag]| passages(dense, plain, tags).into_iter().map(|(entry, _)| entry).reduce(Fraction::min);
    let (outer, inner) = (first(&[Tag::Full, Tag::Partial]), first(&[Tag::Full]));
    let (wanted, tags) = match on {
        Obstacle::Full => (inner, &[Tag::Full][..]),
        Obstacle::Upper => (outer, &[Tag::Full, Tag::Partial][..]),
    };
    let told = format!("{plain:?} {on:?} {hit:?} {outer:?} {inner:?}");
    let (Some(wanted), Some(hit)) = (wanted, hit) else {
        return assert!(wanted.is_none() && hit.is_none(), "{told}");
    };
    assert!(is_just_below(hit.t.lower, outer.unwrap()), "{told}");
    match inner {
        Some(inner) => assert!(is_just_above(hit.t.upper, inner), "{told}"),
        None => assert_eq!(hit.t.upper, f64::INFINITY, "{told}"),
    }
    // The cell is one of those that the ray enters at that time, through the reported face.
    assert!(dense.tag_of(hit.cell).is_some_and(|tag| tags.contains(&tag)), "{told}");
    let edge = 1 << (dense.depth - hit.cell.level);
    let (lower, upper) = (hit.cell.at.map(|a| a * edge), hit.cell.at.map(|a| (a + 1) * edge));
    let (entry, _) = passage(plain, lower, upper).expect(&told);
    assert!(entry.order(wanted).is_eq(), "{told}");
    let faces: Vec<usize> = (0..3).filter(|&axis| hit.normal[axis] != 0.0).collect();
    match faces[..] {
        [] => assert_eq!(entry.0, 0, "{told}"),
        [axis] => {
            assert_eq!(hit.normal[axis], -(plain.direction[axis].signum() as f64), "{told}");
            let plane = if plain.direction[axis] > 0 { lower[axis] } else { upper[axis] };
            let way = (plane as i128 * ONE - plain.from[axis]) * plain.direction[axis].signum();
            let passes = Fraction(way, plain.direction[axis].abs() * ONE);
            assert!(passes.order(entry).is_eq(), "{told}");
        }
        _ => panic!("{told}"),
    }
}

fn union_of(mut stays: Vec<(Fraction, Fraction)>) -> Vec<(Fraction, Fraction)> {
    stays.sort_by(|a, b| a.0.order(b.0));
    let mut union: Vec<(Fraction, Fraction)> = Vec::new();
    for (entry, exit) in stays {
        match union.last_mut() {
            Some(last) if entry.order(last.1).is_le() => last.1 = last.1.max(exit),
            _ => union.push((entry, exit)),
        }
    }
    union
}

/// Checks spans. In the tests' numbers, different ends never differ only by rounding, so that no span is
/// lost.
fn assert_spans(dense: &Dense, plain: &Plain, spans: &RaySpans) {
    let outer = union_of(passages(dense, plain, &[Tag::Full, Tag::Partial]));
    let inner = union_of(passages(dense, plain, &[Tag::Full]));
    let told = format!("{plain:?} {spans:?} {outer:?} {inner:?}");
    let same = |spans: &[Interval], wanted: &[(Fraction, Fraction)], is_inner: bool| {
        assert_eq!(spans.len(), wanted.len(), "{told}");
        for (span, &(from, to)) in spans.iter().zip(wanted) {
            if is_inner {
                assert!(is_just_above(span.lower, from) && is_just_below(span.upper, to), "{told}");
            } else {
                assert!(is_just_below(span.lower, from) && is_just_above(span.upper, to), "{told}");
            }
        }
    };
    same(&spans.outer, &outer, false);
    // An interval of one point that is no double vanishes when rounded inward.
    let kept: Vec<_> = inner.iter().copied().filter(|&(from, to)| from.order(to).is_lt()).collect();
    let points: Vec<Interval> = spans.inner.iter().copied().filter(|span| span.width() > 0.0).collect();
    same(&points, &kept, true);
}

fn every_way_to_ask(tree: &OctreeRef<'_>, dense: &Dense, seed: u64, count: usize) {
    let mut random = Random(seed);
    let plain: Vec<Plain> = (0..count).map(|_| random_ray(&mut random, dense.depth)).collect();
    let rays: Vec<Ray> = plain.iter().map(ray_of).collect();
    for on in [Obstacle::Full, Obstacle::Upper] {
        let mut hits = vec![None; count];
        tree.cast_rays(&rays, on, &mut hits).unwrap();
        for ((plain, ray), &hit) in plain.iter().zip(&rays).zip(&hits) {
            assert_hit(dense, plain, on, hit);
            assert_eq!(tree.cast_ray(ray, on), hit);
        }
        assert_eq!(cast_rays(tree, tree.frame(), &rays, on, &alone()).unwrap(), hits);
    }
    for (plain, ray) in plain.iter().zip(&rays).take(count / 4) {
        let spans = tree.ray_spans(ray).unwrap();
        assert_spans(dense, plain, &spans);
        assert_eq!(ray_spans(tree, tree.frame(), ray, &alone()).unwrap(), spans);
    }
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn rays_agree_with_dense_arrays(shape in shapes(1..=4), seed: u64) {
        let dense = Shape::dense(&shape);
        let tree = dense.octree();
        every_way_to_ask(tree.view(), &dense, seed, 40);
        let bytes = Aligned::new(&file::to_bytes(&tree).unwrap());
        every_way_to_ask(&file::view(bytes.bytes()).unwrap(), &dense, seed, 4);
    }
}

/// Parallel rays from around or inside the universe of a tree of 2^depth cells with edge 1. Some lie on
/// lattice planes, their directions have different lengths, and some rays are ended.
fn side_by_side(random: &mut Random, depth: u8, count: usize) -> Vec<Ray> {
    let cells = f64::from(1u32 << depth);
    let from = [0; 3].map(|_| random.between(-0.7, 1.7) * cells);
    let mut direction = [0; 3].map(|_| random.between(-1.0, 1.0));
    for axis in (0..3).filter(|_| random.below(4) == 0).collect::<Vec<_>>() {
        direction[axis] = [0.0, -0.0, 1e-9][random.below(3) as usize];
    }
    if direction.iter().all(|&d| d == 0.0) {
        direction[1] = -1.0;
    }
    let (spread, bend) = (random.between(0.0, 0.15) * cells, random.between(0.0, 0.05));
    let on_planes = random.below(3) == 0;
    (0..count)
        .map(|_| {
            let mut from = from.map(|c| c + random.between(-0.5, 0.5) * spread);
            if on_planes {
                from = from.map(|c| (2.0 * c).round() / 2.0);
            }
            let length = 2f64.powi(random.below(5) as i32 - 2);
            let direction =
                direction.map(|d| if d == 0.0 { d } else { (d + random.between(-bend, bend)) * length });
            let ray = Ray::new(from, direction).unwrap();
            if random.below(5) == 0 { ray.until(random.between(0.1, 2.0) * cells).unwrap() } else { ray }
        })
        .collect()
}

/// Checks that all rays cast together give the answers of single rays.
fn assert_together(tree: &OctreeRef<'_>, rays: &[Ray]) {
    let mut hits = vec![None; rays.len()];
    for on in [Obstacle::Full, Obstacle::Upper] {
        tree.cast_rays(rays, on, &mut hits).unwrap();
        for (ray, &hit) in rays.iter().zip(&hits) {
            assert_eq!(tree.cast_ray(ray, on), hit, "{ray:?}");
        }
    }
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn rays_side_by_side_are_cast_as_each_alone(shape in shapes(4..=7), seed: u64) {
        let tree = shape.dense().octree();
        let mut random = Random(seed);
        for count in [1, 31, 32, 33, 100, 64, 64, 64] {
            assert_together(tree.view(), &side_by_side(&mut random, shape.depth, count));
        }
    }
}

/// Bytes aligned as in a mapping.
struct Aligned {
    memory: Vec<u8>,
    start: usize,
    end: usize,
}

impl Aligned {
    fn new(bytes: &[u8]) -> Aligned {
        let mut memory = vec![0; bytes.len() + 64];
        let start = memory.as_ptr().align_offset(64);
        let end = start + bytes.len();
        memory[start..end].copy_from_slice(bytes);
        Aligned { memory, start, end }
    }
    fn bytes(&self) -> &[u8] {
        &self.memory[self.start..self.end]
    }
}

/// Rays with full-precision numbers from around a ball. Every third is parallel to an axis, every third
/// nearly so, and some begin in the ball.
fn rays_with_digits(random: &mut Random, count: usize) -> Vec<([f64; 3], [f64; 3])> {
    let number = |random: &mut Random| random.between(-1.0, 1.0);
    (0..count)
        .map(|i| {
            let mut from = [0; 3].map(|_| 2.0 * number(random));
            let to = [0; 3].map(|_| 0.9 * number(random));
            let mut direction = [0, 1, 2].map(|axis| to[axis] - from[axis]);
            for slow in [1, 2].map(|other| (i / 3 + other) % 3).into_iter().filter(|_| i % 3 < 2) {
                direction[slow] *= [0.0, 1e-9][i % 3];
                from[slow] = to[slow];
            }
            if i % 7 == 0 && direction[0] != 0.0 {
                direction[1] = direction[0];
            }
            (if i % 5 == 0 { to } else { from }, direction)
        })
        .collect()
}

const CENTRE: [f64; 3] = [0.1, -0.05, 0.03];
const RADIUS: f64 = 0.77;

/// Returns |p − centre|² − radius² and half its derivative at p = from + t direction, exactly.
fn ball_at(from: [f64; 3], direction: [f64; 3], t: f64) -> (Exact, Exact) {
    let (mut value, mut slope) = (Exact::from(0.0), Exact::from(0.0));
    for axis in 0..3 {
        let way = Exact::from(direction[axis]).times(&Exact::from(t));
        let x = Exact::from(from[axis]).plus(&way).minus(&Exact::from(CENTRE[axis]));
        value = value.plus(&x.times(&x));
        slope = slope.plus(&x.times(&Exact::from(direction[axis])));
    }
    let radius = Exact::from(RADIUS);
    (value.minus(&radius.times(&radius)), slope)
}

#[test]
fn the_true_hit_of_a_ball_lies_in_the_interval() {
    let frame = Frame::new([-1.0; 3], 2.0, 12).unwrap();
    let ball = Csg::ball(CENTRE, RADIUS).unwrap();
    let plain = rays_with_digits(&mut Random(7), 3000);
    let rays: Vec<Ray> = plain.iter().map(|&(from, direction)| Ray::new(from, direction).unwrap()).collect();
    let hits = cast_rays(&ball, &frame, &rays, Obstacle::Upper, &alone()).unwrap();
    let (mut met, mut missed) = (0, 0);
    for (&(from, direction), hit) in plain.iter().zip(hits) {
        let (start, speed) = ball_at(from, direction, 0.0);
        let square = direction
            .iter()
            .fold(Exact::from(0.0), |sum, &d| sum.plus(&Exact::from(d).times(&Exact::from(d))));
        let discriminant = speed.times(&speed).minus(&start.times(&square)).sign();
        let truly = start.sign() <= 0 || discriminant >= 0 && speed.sign() < 0;
        let Some(hit) = hit else {
            assert!(!truly, "{from:?} {direction:?}");
            missed += 1;
            continue;
        };
        let (before, falls) = ball_at(from, direction, hit.t.lower);
        assert!(
            hit.t.lower == 0.0 || before.sign() >= 0 && falls.sign() <= 0,
            "{from:?} {direction:?} {hit:?}"
        );
        if !hit.t.upper.is_finite() {
            continue;
        }
        assert!(
            truly && ball_at(from, direction, hit.t.upper).0.sign() <= 0,
            "{from:?} {direction:?} {hit:?}"
        );
        met += 1;
        // To second order, unless the ray grazes.
        let at = [0, 1, 2].map(|axis| (from[axis] + hit.t.upper * direction[axis] - CENTRE[axis]) / RADIUS);
        let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
        let cosine = -(0..3).map(|axis| at[axis] * direction[axis]).sum::<f64>() / length;
        if hit.t.lower > 0.0 && cosine > 0.3 {
            assert!(hit.t.width() * length < 1e-5, "{from:?} {direction:?} {hit:?}");
            let turned: f64 = (0..3).map(|axis| at[axis] * hit.normal[axis]).sum();
            assert!((turned - 1.0).abs() < 1e-5, "{at:?} {hit:?}");
        }
    }
    assert!(met > 1000 && missed > 300, "{met} {missed}");
}

/// Intervals along a ray end at slabs. The inner intervals lie in the ball, the outer gaps outside the ball,
/// close to each other.
#[test]
fn the_true_spans_of_a_ball_lie_between() {
    let frame = Frame::new([-1.0; 3], 2.0, 12).unwrap();
    let ball = Csg::ball(CENTRE, RADIUS).unwrap();
    let (mut met, mut narrow) = (0, 0);
    for (from, direction) in rays_with_digits(&mut Random(11), 2000) {
        let ray = Ray::new(from, direction).unwrap();
        let RaySpans { inner, outer } = ray_spans(&ball, &frame, &ray, &alone()).unwrap();
        let hit = cast_rays(&ball, &frame, &[ray], Obstacle::Upper, &alone()).unwrap()[0];
        assert_eq!(outer.first().map(|span| span.lower), hit.map(|hit| hit.t.lower));
        for t in inner.iter().flat_map(|span| [span.lower, span.upper]) {
            assert!(ball_at(from, direction, t).0.sign() <= 0, "{from:?} {direction:?} {inner:?}");
        }
        for t in outer.iter().flat_map(|span| [span.lower, span.upper]).filter(|&t| t > 0.0) {
            assert!(ball_at(from, direction, t).0.sign() >= 0, "{from:?} {direction:?} {outer:?}");
        }
        let within = |span: &Interval, of: &Interval| of.lower <= span.lower && span.upper <= of.upper;
        assert!(inner.iter().all(|span| outer.iter().any(|of| within(span, of))));
        if let ([first, ..], [last], [.., end]) = (&inner[..], &outer[..], &inner[..]) {
            let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
            let doubt = (first.lower - last.lower).max(last.upper - end.upper) * length;
            met += 1;
            narrow += (doubt < 1e-5) as usize;
        }
    }
    assert!(met > 800 && narrow > met * 9 / 10, "{narrow} of {met}");
}

#[test]
fn the_march_finds_what_exact_descent_does() {
    let frame = Frame::new([-1.0; 3], 2.0, 9).unwrap();
    let ball = Csg::ball(CENTRE, RADIUS).unwrap();
    let plain = rays_with_digits(&mut Random(8), 6000);
    let rays: Vec<Ray> = plain
        .iter()
        .enumerate()
        .map(|(i, &(from, direction))| match i % 4 {
            0 => Ray::between(from, [0, 1, 2].map(|axis| from[axis] + direction[axis])).unwrap(),
            _ => Ray::new(from, direction).unwrap(),
        })
        .collect();
    for rule in [Rule::Certified, Rule::Sampled] {
        let tree = build(&ball, &frame, rule, &alone()).unwrap();
        // Samples prove nothing. Here the cells are the solid.
        let tree = tree.view().with_proof(Proof::CERTIFIED);
        for on in [Obstacle::Full, Obstacle::Upper] {
            let mut hits = vec![None; rays.len()];
            tree.cast_rays(&rays, on, &mut hits).unwrap();
            assert!(hits.iter().flatten().count() > 2000);
            assert_eq!(cast_rays(&tree, &frame, &rays, on, &alone()).unwrap(), hits);
        }
        // A picture. A beam of its rays leads to the ball or past it.
        let pixel = |i: i32| f64::from(i) / 40.0;
        let picture: Vec<Ray> = (-40..40)
            .flat_map(|y| (-64..64).map(move |x| [-3.0, pixel(x), pixel(y)]))
            .map(|[x, y, z]| Ray::new([x, 0.1, -0.2], [-x, y, z]).unwrap())
            .collect();
        assert_together(&tree, &picture);
        let mut hits = vec![None; picture.len()];
        tree.cast_rays(&picture, Obstacle::Full, &mut hits).unwrap();
        let count = hits.iter().flatten().count();
        assert!((1000..8000).contains(&count), "{count}");
    }
}

#[test]
fn sight() {
    let frame = Frame::new([-1.0; 3], 2.0, 10).unwrap();
    let ball = Csg::ball([0.0; 3], 0.5).unwrap();
    let ask = |from, to| line_of_sight(&ball, &frame, from, to, &alone()).unwrap();
    assert_eq!(ask([-0.9, 0.0, 0.0], [0.9, 0.1, 0.0]), Sight::Blocked);
    assert_eq!(ask([-0.9, 0.0, 0.0], [-0.501, 0.0, 0.0]), Sight::Clear);
    assert_eq!(ask([-9.0, 0.0, 0.0], [-0.6, 0.0, 0.0]), Sight::Clear);
    // The universe cuts the complement off.
    let around = Csg::ball([0.0; 3], 0.5).unwrap().complement();
    let ask = |from, to| line_of_sight(&around, &frame, from, to, &alone()).unwrap();
    assert_eq!(ask([-0.4, 0.0, 0.0], [0.4, 0.1, 0.0]), Sight::Clear);
    assert_eq!(ask([0.0, 0.0, 0.0], [0.0, 0.0, 3.0]), Sight::Blocked);
    assert_eq!(ask([7.0, 0.0, 2.0], [0.0, 5.0, 2.0]), Sight::Undecided);
}

#[test]
fn what_is_refused() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, 1e-300] {
        for axis in 0..3 {
            let mut wrong = [1.0; 3];
            wrong[axis] = bad;
            assert!(Ray::new(wrong, [1.0; 3]).is_err() && Ray::new([0.0; 3], wrong).is_err());
            assert!(Ray::between(wrong, [0.0; 3]).is_err() && Ray::between([0.0; 3], wrong).is_err());
        }
    }
    assert!(Ray::new([1.0; 3], [0.0, -0.0, 0.0]).is_err() && Ray::between([1.0; 3], [1.0; 3]).is_err());
    let tree = Dense::uniform(2, Tag::Full).octree();
    let ray = Ray::new([-1.0, 2.0, 2.0], [1.0, -0.0, 0.0]).unwrap();
    assert!(tree.cast_rays(&[ray], Obstacle::Full, &mut []).is_err());
    let hit = tree.cast_ray(&ray, Obstacle::Full).unwrap();
    assert_eq!((hit.t, hit.normal), (Interval::exactly(1.0), [-1.0, 0.0, 0.0]));
}

/// A ray with an end is a segment. It meets the same first cells as the whole ray, within its length.
#[test]
fn rays_end() {
    let frame = Frame::new([-1.0; 3], 2.0, 8).unwrap();
    let ball = Csg::ball(CENTRE, RADIUS).unwrap();
    let tree = build(&ball, &frame, Rule::Certified, &alone()).unwrap();
    let mut random = Random(10);
    let (mut ended, mut met) = (0, 0);
    for (from, direction) in rays_with_digits(&mut random, 2000) {
        let whole = Ray::new(from, direction).unwrap();
        assert_eq!(whole.until(f64::INFINITY).unwrap(), whole);
        let last = random.between(0.01, 2.0);
        let ray = whole.until(last).unwrap();
        for on in [Obstacle::Full, Obstacle::Upper] {
            let (hit, wanted) = (tree.cast_ray(&ray, on), tree.cast_ray(&whole, on));
            assert_eq!(cast_rays(&tree, &frame, &[ray], on, &alone()).unwrap(), [hit]);
            match (hit, wanted) {
                (Some(hit), Some(wanted)) => {
                    assert!(hit.cell == wanted.cell && hit.t.lower == wanted.t.lower && hit.t.lower <= last);
                    assert!(
                        hit.t.upper == wanted.t.upper
                            || hit.t.upper == f64::INFINITY && wanted.t.upper >= last
                    );
                    met += 1;
                }
                (None, Some(wanted)) => {
                    assert!(
                        wanted.t.upper >= last
                            && (on == Obstacle::Full || wanted.t.lower >= last.next_down())
                    );
                    ended += 1;
                }
                (hit, wanted) => assert_eq!(hit, wanted),
            }
        }
        let RaySpans { outer, .. } = tree.ray_spans(&ray).unwrap();
        assert!(outer.iter().all(|span| span.upper <= last));
    }
    assert!(ended > 100 && met > 500, "{ended} {met}");
    let segment = Ray::between([0.0; 3], [1.0; 3]).unwrap();
    assert_eq!(segment.until(2.0).unwrap(), segment);
    for bad in [0.0, -1.0, f64::NAN, f64::NEG_INFINITY, 1e300, 1e-300] {
        assert!(segment.until(bad).is_err(), "{bad}");
    }
}

/// Files with arbitrary bytes below the section table.
#[test]
fn damaged_trees_are_left() {
    let frame = Frame::new([-1.0; 3], 2.0, 9).unwrap();
    let ball = build(&Csg::ball(CENTRE, RADIUS).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
    let good = file::to_bytes(&ball).unwrap();
    let mut random = Random(9);
    let rays: Vec<Ray> = rays_with_digits(&mut random, 60)
        .into_iter()
        .map(|(from, direction)| Ray::new(from, direction).unwrap())
        .collect();
    let mut hits = vec![None; rays.len()];
    let beam: Vec<Ray> = (0..200)
        .map(|i| Ray::new([-1.0, i as f64 / 128.0 - 0.8, 0.07], [1.0, 0.01 * (i % 3) as f64, 0.003]).unwrap())
        .collect();
    let mut viewed = 0;
    for _ in 0..40 {
        let mut bytes = good.clone();
        for _ in 0..good.len() / 20 {
            let at = 1024 + random.below(good.len() as u64 - 1024) as usize;
            bytes[at] = random.bits() as u8;
        }
        let bytes = Aligned::new(&bytes);
        let Ok(tree) = file::view(bytes.bytes()) else { continue };
        viewed += 1;
        for on in [Obstacle::Full, Obstacle::Upper] {
            tree.cast_rays(&rays, on, &mut hits).unwrap();
            assert!(hits.iter().flatten().all(|hit| hit.t.lower <= hit.t.upper));
        }
        assert_together(&tree, &beam);
        for ray in &rays {
            let RaySpans { inner, outer } = tree.ray_spans(ray).unwrap();
            assert!(inner.iter().chain(&outer).all(|span| span.lower <= span.upper));
        }
    }
    assert!(viewed > 20, "{viewed}");
}
