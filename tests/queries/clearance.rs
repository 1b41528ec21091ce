//! Clearance to second order: distances of primitives against closed forms, the nearest points, penetration
//! depths, and decided gaps.

use leafless::query::{GapVerdict, StopReason, clearance_at, gap_at_least, gap_at_least_at};
use leafless::solid::Transform;
use leafless::{
    Affine, Clearance, Control, Csg, Error, FillRule, Frame, MeshSolid, Rule, SurfaceOptions, build,
    build_extended, clearance,
};
use leafless_testkit::{Random, alone};

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

fn up_to(splits: u64) -> Control<'static> {
    Control { max_splits: Some(splits), ..alone() }
}

/// Checks the laws of every answer.
fn check(found: &Clearance, truth: f64, size: f64, between: &str) {
    let slack = 1e-11 * size;
    let distance = found.distance;
    assert!(
        distance.lower <= truth + slack && truth - slack <= distance.upper,
        "{between}: {found:?} {truth}"
    );
    assert_eq!(found.points.is_some(), distance.upper.is_finite(), "{between}: {found:?}");
    if let Some([p, q]) = found.points {
        assert!(length(minus(p, q)) <= distance.upper + slack, "{between}: {found:?}");
    }
    for normal in found.normals.into_iter().flatten() {
        assert!((length(normal) - 1.0).abs() < 1e-9, "{between}: {found:?}");
    }
    assert!(found.depth == 0.0 || distance.upper == 0.0, "{between}: {found:?}");
}

/// A rotation by unit quaternions, followed by an offset.
fn rigid(random: &mut Random, reach: f64) -> Affine {
    let q = loop {
        let q = [0; 4].map(|_| random.between(-1.0, 1.0));
        let square: f64 = q.iter().map(|c| c * c).sum();
        if (0.1..1.0).contains(&square) {
            break q.map(|c| c / square.sqrt());
        }
    };
    let [w, x, y, z] = q;
    let turn = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    Affine::new(turn.map(|[a, b, c]| [a, b, c, random.between(-reach, reach)])).unwrap()
}

/// A pin in the bore of a block, with the same play all around, so that no place is nearest.
#[test]
fn a_pin_in_a_bore() {
    let bore = Csg::cylinder(5.0, -1.0, 21.0).unwrap();
    let plate = Csg::cuboid([-20.0, -20.0, 0.0], [20.0, 20.0, 20.0]).unwrap().difference(&bore).unwrap();
    let pin = Csg::cylinder(4.9, -5.0, 25.0).unwrap();
    let turn = Affine::new([[0.36, 0.48, -0.8, 0.3], [-0.8, 0.6, 0.0, 0.5], [0.48, 0.64, 0.6, 0.1]]).unwrap();
    for depth in [7, 10, 14] {
        for placement in [Affine::IDENTITY, turn] {
            let frame = Frame::new([-48.0; 3], 96.0, depth).unwrap();
            let (a, b) = (pin.placed(&placement).unwrap(), plate.placed(&placement).unwrap());
            let start = std::time::Instant::now();
            let found = clearance(&a, &b, &frame, 1e-6, &alone()).unwrap();
            println!("{depth} {:?} {found:?}", start.elapsed());
            check(&found, 0.1, 100.0, "pin");
            assert_eq!(found.stop_reason, StopReason::Tolerance);
            assert!(found.distance.width() <= 1e-6 && found.splits.iter().sum::<u64>() < 2000, "{found:?}");
        }
    }
}

#[test]
fn parallel_faces_of_turned_blocks() {
    let turn = Affine::new([[0.36, 0.48, -0.8, 0.3], [-0.8, 0.6, 0.0, 0.5], [0.48, 0.64, 0.6, 0.1]]).unwrap();
    let block = |low: [f64; 3]| Csg::cuboid(low, low.map(|c| c + 1.0)).unwrap().placed(&turn).unwrap();
    let frame = Frame::new([-4.0; 3], 8.0, 10).unwrap();
    let found = clearance(&block([0.0; 3]), &block([1.1, 0.2, 0.3]), &frame, 1e-6, &alone()).unwrap();
    println!("{found:?}");
    check(&found, 0.1, 4.0, "blocks");
    assert!(
        found.stop_reason == StopReason::Tolerance && found.splits.iter().sum::<u64>() < 100,
        "{found:?}"
    );
}

#[test]
fn a_tilted_shaft_in_a_ring() {
    let shaft = |tilt: f64| {
        let (s, c) = (f64::sin(tilt), f64::cos(tilt));
        let turn = Affine::new([[c, 0.0, s, 0.0], [0.0, 1.0, 0.0, 0.0], [-s, 0.0, c, 0.0]]).unwrap();
        Csg::cylinder(20.0, -50.0, 50.0).unwrap().placed(&turn).unwrap()
    };
    let hole = Csg::cylinder(24.0, -60.0, 60.0).unwrap();
    let ring = Csg::cylinder(40.0, -40.0, 40.0).unwrap().difference(&hole).unwrap();
    let frame = Frame::new([-64.0; 3], 128.0, 12).unwrap();
    let found = clearance(&shaft(0.0), &ring, &frame, 1e-9, &alone()).unwrap();
    check(&found, 4.0, 100.0, "coaxial");
    assert!(found.distance.width() <= 1e-9, "{found:?}");
    // The rim of the ring is nearest: in the section y = 0 a corner (24, 40) next to a strip about the axis.
    let tilt = 0.001f64;
    let truth = 24.0 * tilt.cos() - 40.0 * tilt.sin() - 20.0;
    let found = clearance(&shaft(tilt), &ring, &frame, 1e-4, &alone()).unwrap();
    println!("{found:?} {truth}");
    check(&found, truth, 100.0, "tilted");
    assert!(found.distance.width() <= 1e-4, "{found:?}");
}

/// A convex body with a distance function: the points within a radius of a box or of a segment, placed
/// somewhere.
#[derive(Debug, Clone)]
struct Body {
    half: [f64; 3],
    radius: f64,
    /// True for a cylinder, whose radius counts only across the axis z.
    is_cylinder: bool,
    placement: Affine,
}

impl Body {
    fn random(random: &mut Random, kind: u64, reach: f64) -> Body {
        let placement = rigid(random, reach);
        let mut size = || random.between(0.3, 1.2);
        match kind {
            0 => Body { half: [0.0; 3], radius: size(), is_cylinder: false, placement },
            1 => Body { half: [size(), size(), size()], radius: 0.0, is_cylinder: false, placement },
            _ => Body { half: [0.0, 0.0, size()], radius: size(), is_cylinder: true, placement },
        }
    }

    fn csg(&self) -> Csg {
        let own = match self {
            Body { is_cylinder: true, half, radius, .. } => {
                Csg::cylinder(*radius, -half[2], half[2]).unwrap()
            }
            Body { radius, .. } if *radius > 0.0 => Csg::ball([0.0; 3], *radius).unwrap(),
            Body { half, .. } => Csg::cuboid(half.map(|c| -c), *half).unwrap(),
        };
        own.placed(&self.placement).unwrap()
    }

    fn moved(&self, by: [f64; 3]) -> Body {
        let rows = self.placement.rows();
        let placement = Affine::new([0, 1, 2].map(|i| {
            let [a, b, c, t] = rows[i];
            [a, b, c, t + by[i]]
        }));
        Body { placement: placement.unwrap(), ..self.clone() }
    }

    /// Returns the furthest point along a direction.
    fn furthest(&self, direction: [f64; 3]) -> [f64; 3] {
        let m = self.placement.rows();
        let own = [0, 1, 2].map(|j| (0..3).map(|i| m[i][j] * direction[i]).sum::<f64>());
        let mut at = [0, 1, 2].map(|axis| self.half[axis].copysign(own[axis]));
        let across = if self.is_cylinder { [own[0], own[1], 0.0] } else { own };
        let size = length(across);
        if size > 0.0 {
            at = [0, 1, 2].map(|axis| at[axis] + self.radius * across[axis] / size);
        }
        self.placement.apply(at)
    }

    /// Returns the body's nearest point to another point.
    fn nearest(&self, point: [f64; 3]) -> [f64; 3] {
        let m = self.placement.rows();
        let own = [0, 1, 2].map(|j| (0..3).map(|i| m[i][j] * (point[i] - m[i][3])).sum::<f64>());
        let mut at = [0, 1, 2].map(|axis| own[axis].clamp(-self.half[axis], self.half[axis]));
        let mut across = minus(own, at);
        if self.is_cylinder {
            across[2] = 0.0;
        }
        let size = length(across);
        if size > 0.0 {
            let share = self.radius.min(size) / size;
            at = [0, 1, 2].map(|axis| at[axis] + share * across[axis]);
        }
        self.placement.apply(at)
    }
}

/// Bounds the distance of two convex bodies. Support functions prove the lower bound, and a point of each
/// body gives the upper bound.
fn convex_distance(a: &Body, b: &Body) -> (f64, f64) {
    // Alternate between the nearest points, with momentum. The support functions prove the distance.
    let mut p = a.nearest(b.placement.apply([0.0; 3]));
    let (mut lower, mut upper) = (0.0f64, f64::INFINITY);
    let mut before = p;
    for turn in 0..20_000 {
        let momentum = f64::from(turn) / f64::from(turn + 3);
        let ahead = [0, 1, 2].map(|axis| p[axis] + momentum * (p[axis] - before[axis]));
        before = p;
        let q = b.nearest(ahead);
        p = a.nearest(q);
        let way = minus(q, p);
        let size = length(way);
        upper = upper.min(size);
        if size == 0.0 {
            return (0.0, 0.0);
        }
        let n = way.map(|c| c / size);
        let gap = dot(b.furthest(n.map(|c| -c)), n) - dot(a.furthest(n), n);
        lower = lower.max(gap);
        if upper - lower < 1e-10 {
            break;
        }
    }
    (lower, upper)
}

fn random_pairs(count: u64, seed: u64) {
    let mut random = Random(seed);
    let frame = Frame::new([-8.0; 3], 16.0, 12).unwrap();
    let (mut wide, mut spent, mut touching) = (0, 0, 0);
    for case in 0..count {
        let kinds = [random.below(3), random.below(3)];
        let a = Body::random(&mut random, kinds[0], 0.5);
        let mut b = Body::random(&mut random, kinds[1], 3.0);
        // Some are moved next to each other.
        let (least, most) = convex_distance(&a, &b);
        if case % 3 > 0 && least > 0.0 && most - least < 1e-9 {
            let wanted = if case % 3 == 1 { 0.0 } else { 1e-3 * random.between(0.0, 1.0) };
            let q = b.nearest(a.placement.apply([0.0; 3]));
            let (mut p, mut q) = (a.nearest(q), q);
            for _ in 0..2000 {
                q = b.nearest(p);
                p = a.nearest(q);
            }
            let way = minus(p, q);
            let share = (length(way) - wanted) / length(way);
            b = b.moved(way.map(|c| share * c));
            touching += 1;
        }
        let (least, most) = convex_distance(&a, &b);
        let text = format!("case {case}: {a:?} {b:?}");
        let found = clearance(&a.csg(), &b.csg(), &frame, 1e-5, &up_to(4000)).unwrap();
        let distance = found.distance;
        assert!(
            distance.lower <= most + 1e-12 && least - 1e-12 <= distance.upper,
            "{text}: {found:?} {least} {most}"
        );
        check(&found, distance.lower, 16.0, &text);
        wide += u64::from(distance.width() > 1e-3);
        spent += u64::from(distance.width() > 1e-5);
        // Points lie in the solids, up to rounding.
        if let Some([p, q]) = found.points {
            assert!(
                length(minus(a.nearest(p), p)) < 1e-11 && length(minus(b.nearest(q), q)) < 1e-11,
                "{text}: {found:?}"
            );
        }
        if found.depth > 0.0
            && let Some([centre, _]) = found.points
        {
            for _ in 0..20 {
                let n = loop {
                    let n = [0; 3].map(|_| random.between(-1.0, 1.0));
                    if length(n) > 0.1 {
                        break n.map(|c| c / length(n));
                    }
                };
                let rim = [0, 1, 2].map(|axis| centre[axis] + (found.depth - 1e-12) * n[axis]);
                for body in [&a, &b] {
                    assert!(length(minus(body.nearest(rim), rim)) < 1e-11, "{text}: {found:?} {rim:?}");
                }
            }
        }
    }
    println!("{touching} next to each other, {spent} wider than the tolerance, {wide} wider than 0.001");
    assert!(wide <= count / 100, "{wide}");
}

#[test]
fn random_primitives_lie_as_far_apart_as_they_do() {
    random_pairs(300, 11);
}

#[test]
#[ignore = "minutes"]
fn ten_thousand_random_primitives() {
    random_pairs(10_000, 12);
}

/// Gaps on both sides of the distance are decided, with evidence, also under placements.
#[test]
fn gaps_are_decided() {
    let mut random = Random(13);
    let frame = Frame::new([-8.0; 3], 16.0, 10).unwrap();
    for case in 0..40 {
        let a = Body::random(&mut random, case % 3, 0.5);
        let b = Body::random(&mut random, case / 3 % 3, 3.0);
        let (least, most) = convex_distance(&a, &b);
        if least < 0.01 {
            continue;
        }
        let text = format!("case {case}: {a:?} {b:?} {least} {most}");
        let (first, second) = (a.csg(), b.csg());
        let whole = clearance(&first, &second, &frame, 1e-4, &up_to(4000)).unwrap();
        for share in [0.5, 0.99, 1.01, 2.0] {
            let wanted = share * least;
            let found = gap_at_least(&first, &second, &frame, wanted, &up_to(4000)).unwrap();
            let truth = if share < 1.0 { GapVerdict::Yes } else { GapVerdict::No };
            assert_eq!(found.verdict, truth, "{text}: {found:?}");
            check(
                &found.evidence,
                least.clamp(found.evidence.distance.lower, found.evidence.distance.upper),
                16.0,
                &text,
            );
            if share == 0.5 {
                let splits = |found: &Clearance| found.splits.iter().sum::<u64>();
                assert!(splits(&found.evidence) <= splits(&whole), "{text}: {found:?} {whole:?}");
            }
        }
    }
    let ball = Csg::ball([0.0; 3], 1.0).unwrap();
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = gap_at_least(&ball, &ball, &frame, wrong, &alone());
        assert!(matches!(refused, Err(Error::Argument { name: "least", .. })));
    }
    // Parts outside the universe may come nearer.
    let half = Csg::cuboid([2.0, -20.0, -20.0], [20.0; 3]).unwrap();
    let found = gap_at_least(&ball, &half, &frame, 0.5, &alone()).unwrap();
    assert!(found.verdict == GapVerdict::Undecided && found.evidence.clipped, "{found:?}");
    let found = gap_at_least(&ball, &half, &frame, 1.5, &alone()).unwrap();
    assert_eq!(found.verdict, GapVerdict::No);
}

/// A query with many placements equals one query after another, for any number of threads.
#[test]
fn clearances_in_many_places() {
    let mut random = Random(14);
    let frame = Frame::new([-8.0; 3], 16.0, 8).unwrap();
    let own = Frame::new([-2.0; 3], 4.0, 8).unwrap();
    let (a, b) = (Csg::ball([0.0; 3], 1.0).unwrap(), Csg::cylinder(0.5, -1.0, 1.0).unwrap());
    let places: Vec<Affine> = (0..12).map(|_| rigid(&mut random, 4.0)).collect();
    let control = |threads| Control { max_splits: Some(500), ..Control::threads(threads) };
    let alone = clearance_at(&a, &b, &own, &places, &frame, 1e-3, &control(1)).unwrap();
    assert_eq!(alone, clearance_at(&a, &b, &own, &places, &frame, 1e-3, &control(3)).unwrap());
    let gaps = gap_at_least_at(&a, &b, &own, &places, &frame, 0.7, &control(3)).unwrap();
    let (mut yes, mut no) = (0, 0);
    for ((placement, found), gap) in places.iter().zip(&alone).zip(&gaps) {
        // Expressions are moved exactly.
        let moved = b.placed(placement).unwrap();
        assert_eq!(*found, clearance(&a, &moved, &frame, 1e-3, &control(1)).unwrap());
        let body = |half, radius, is_cylinder, placement| Body { half, radius, is_cylinder, placement };
        let ball = body([0.0; 3], 1.0, false, Affine::IDENTITY);
        let (least, most) = convex_distance(&ball, &body([0.0, 0.0, 1.0], 0.5, true, *placement));
        check(found, least.clamp(found.distance.lower, found.distance.upper), 16.0, "placed");
        assert!(
            found.distance.lower <= most + 1e-12 && least - 1e-12 <= found.distance.upper,
            "{found:?} {least}"
        );
        match gap.verdict {
            GapVerdict::Yes => yes += usize::from(most + 1e-12 >= 0.7),
            GapVerdict::No => no += usize::from(least - 1e-12 < 0.7),
            GapVerdict::Undecided => {}
        }
        assert!(gap.verdict != GapVerdict::Yes || most + 1e-12 >= 0.7, "{gap:?}");
        assert!(gap.verdict != GapVerdict::No || least - 1e-12 < 0.7, "{gap:?}");
    }
    assert!(yes > 1 && no > 1, "{yes} {no}");
}

/// A ball in two overlapping balls, and solids within each other.
#[test]
fn how_deep_solids_overlap() {
    let frame = Frame::new([0.0; 3], 128.0, 10).unwrap();
    let ball = |at: f64, radius: f64| Csg::ball([at; 3], radius).unwrap();
    for (a, b, truth) in [
        (ball(50.0, 30.0), ball(80.0, 30.0), 30.0 - 15.0 * 3f64.sqrt()),
        (ball(50.0, 30.0), ball(52.0, 10.0), 10.0),
        (ball(50.0, 30.0), Csg::cuboid([40.0, 40.0, 45.0], [60.0, 60.0, 55.0]).unwrap(), 5.0),
    ] {
        let found = clearance(&a, &b, &frame, 1e-3, &alone()).unwrap();
        check(&found, 0.0, 128.0, "overlap");
        assert!(found.depth <= truth && found.depth > 0.8 * truth, "{found:?} {truth}");
    }
    // Contact has no depth.
    let block = |x: f64| Csg::cuboid([x, 32.0, 32.0], [x + 32.0, 64.0, 64.0]).unwrap();
    let found = clearance(&block(32.0), &block(64.0), &frame, 1e-9, &alone()).unwrap();
    assert_eq!((found.distance.upper, found.depth), (0.0, 0.0));
}

/// Solids of other kinds agree with expressions: meshes, stored octrees with and without surfaces, and moved
/// solids.
#[test]
fn solids_of_all_kinds_agree() {
    let mut random = Random(15);
    let frame = Frame::new([-8.0; 3], 16.0, 8).unwrap();
    let own = Frame::new([-3.0; 3], 6.0, 7).unwrap();
    let cube: Vec<[f64; 3]> =
        (0..8).map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { -1.0 } else { 1.0 })).collect();
    let sides: [[u32; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = leafless::TriangleMesh::new(cube, triangles).unwrap();
    let own_csg = Csg::cuboid([-1.0; 3], [1.0; 3]).unwrap();
    let stored = build(&own_csg, &own, Rule::Certified, &alone()).unwrap();
    let extended = build_extended(&own_csg, &own, &SurfaceOptions::default(), &alone()).unwrap();
    for case in 0..6 {
        let placement = rigid(&mut random, 3.5);
        let other = Body::random(&mut random, case % 3, 0.5);
        let body = Body { half: [1.0; 3], radius: 0.0, is_cylinder: false, placement };
        let (least, most) = convex_distance(&other, &body);
        let first = other.csg();
        let mut widths = Vec::new();
        let mut look = |found: Clearance| {
            let text = format!("case {case}: {found:?} {least} {most}");
            assert!(found.distance.lower <= most + 1e-11 && least - 1e-11 <= found.distance.upper, "{text}");
            check(&found, least.clamp(found.distance.lower, found.distance.upper), 16.0, &text);
            widths.push(found.distance.width());
        };
        let moved = MeshSolid::new(mesh.placed(&placement).unwrap(), FillRule::NonZero).unwrap();
        look(clearance(&first, &moved, &frame, 1e-4, &up_to(3000)).unwrap());
        look(
            clearance(&first, &Transform::new(&own_csg, &own, &placement), &frame, 1e-4, &up_to(3000))
                .unwrap(),
        );
        look(
            clearance(&first, &Transform::new(&extended, &own, &placement), &frame, 1e-4, &up_to(3000))
                .unwrap(),
        );
        look(
            clearance(&first, &Transform::new(&stored, &own, &placement), &frame, 1e-4, &up_to(3000))
                .unwrap(),
        );
        println!("case {case}: {least} {widths:?}");
        // (For a solid moved by its cells, up to four cells.)
        assert!(widths[0] <= 0.0625 && widths[1] <= 0.25 && widths[2] <= 1e-2, "{widths:?}");
    }
}
