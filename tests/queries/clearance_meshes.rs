//! Clearance of meshes by their triangles, compared with all pairs of triangles.

use leafless::query::{GapVerdict, StopReason, clearance_at, gap_at_least, gap_at_least_at};
use leafless::{
    Affine, Clearance, Control, Error, FillRule, Frame, MeshSolid, TriangleMesh, clearance, exchange,
};
use leafless_testkit::{Random, alone, model, repeated};

type Point = [f64; 3];

fn minus(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

fn dot(a: Point, b: Point) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

fn between(a: Point, b: Point, share: f64) -> Point {
    [0, 1, 2].map(|axis| a[axis] + share * (b[axis] - a[axis]))
}

/// Returns the distance of a point from a triangle with positive area.
fn point_to_triangle(p: Point, t: &[Point; 3]) -> f64 {
    let normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
    let is_above = (0..3).all(|k| {
        let edge = minus(t[(k + 1) % 3], t[k]);
        dot(cross(edge, minus(p, t[k])), normal) >= 0.0
    });
    if is_above && dot(normal, normal) > 0.0 {
        return dot(normal, minus(p, t[0])).abs() / length(normal);
    }
    let to_edge = |k: usize| {
        let (a, edge) = (t[k], minus(t[(k + 1) % 3], t[k]));
        let share = (dot(minus(p, a), edge) / dot(edge, edge)).clamp(0.0, 1.0);
        length(minus(p, between(a, t[(k + 1) % 3], if share.is_nan() { 0.0 } else { share })))
    };
    to_edge(0).min(to_edge(1)).min(to_edge(2))
}

/// Returns the distance of two segments: the minimum of a convex function, by ternary search.
fn segments(a: [Point; 2], b: [Point; 2]) -> f64 {
    let from = |share: f64| {
        let p = between(a[0], a[1], share);
        let edge = minus(b[1], b[0]);
        let other = (dot(minus(p, b[0]), edge) / dot(edge, edge)).clamp(0.0, 1.0);
        length(minus(p, between(b[0], b[1], if other.is_nan() { 0.0 } else { other })))
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..80 {
        let (one, other) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if from(one) <= from(other) {
            high = other;
        } else {
            low = one;
        }
    }
    from(low).min(from(high))
}

fn triangles_apart(a: &[Point; 3], b: &[Point; 3]) -> f64 {
    let mut least = f64::INFINITY;
    for k in 0..3 {
        least = least.min(point_to_triangle(b[k], a)).min(point_to_triangle(a[k], b));
    }
    for (t, edges) in [(a, b), (b, a)] {
        let normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
        for k in 0..3 {
            let (p, q) = (edges[k], edges[(k + 1) % 3]);
            let [of_p, of_q] = [p, q].map(|x| dot(normal, minus(x, t[0])));
            if of_p * of_q < 0.0 {
                least = least.min(point_to_triangle(between(p, q, of_p / (of_p - of_q)), t));
            }
        }
    }
    for i in 0..3 {
        for j in 0..3 {
            least = least.min(segments([a[i], a[(i + 1) % 3]], [b[j], b[(j + 1) % 3]]));
        }
    }
    least
}

fn soup(mesh: &TriangleMesh, placement: &Affine) -> Vec<[Point; 3]> {
    let corners = |t: &[u32; 3]| t.map(|v| placement.apply(mesh.vertices()[v as usize]));
    mesh.triangles().iter().map(corners).collect()
}

/// Returns the least distance between the triangles of two meshes. Pairs are skipped if the balls around
/// their first corners are further apart.
fn by_pairs(a: &TriangleMesh, b: &TriangleMesh, placement: &Affine) -> f64 {
    let round = |t: [Point; 3]| (t, length(minus(t[1], t[0])).max(length(minus(t[2], t[0]))));
    let [own, others] = [soup(a, &Affine::IDENTITY), soup(b, placement)]
        .map(|soup| soup.into_iter().map(round).collect::<Vec<_>>());
    let mut least = f64::INFINITY;
    for (t, r) in &own {
        for (u, s) in &others {
            if length(minus(t[0], u[0])) - r - s <= least {
                least = least.min(triangles_apart(t, u));
            }
        }
    }
    least
}

/// A ball of triangles between circles of latitude, possibly lumpy.
fn ball(centre: Point, radius: f64, steps: u32, mut lump: impl FnMut() -> f64) -> TriangleMesh {
    let round = 2 * steps;
    let mut vertices = vec![];
    let mut add = |latitude: f64, longitude: f64| {
        let radius = radius * (1.0 + lump());
        let at = [latitude.cos() * longitude.cos(), latitude.cos() * longitude.sin(), latitude.sin()];
        vertices.push([0, 1, 2].map(|axis| centre[axis] + radius * at[axis]));
    };
    let pi = std::f64::consts::PI;
    add(-0.5 * pi, 0.0);
    for i in 1..steps {
        for k in 0..round {
            add(pi * (f64::from(i) / f64::from(steps) - 0.5), 2.0 * pi * f64::from(k) / f64::from(round));
        }
    }
    add(0.5 * pi, 0.0);
    let last = vertices.len() as u32 - 1;
    let at = |i: u32, k: u32| 1 + (i - 1) * round + k % round;
    let mut triangles = vec![];
    for k in 0..round {
        triangles.push([0, at(1, k + 1), at(1, k)]);
        for i in 1..steps - 1 {
            triangles.push([at(i, k), at(i, k + 1), at(i + 1, k + 1)]);
            triangles.push([at(i, k), at(i + 1, k + 1), at(i + 1, k)]);
        }
        triangles.push([last, at(steps - 1, k), at(steps - 1, k + 1)]);
    }
    TriangleMesh::new(vertices, triangles).unwrap()
}

fn smooth() -> f64 {
    0.0
}

/// Joins the triangles of several meshes. Flagged meshes get reversed orientation.
fn together(meshes: &[(&TriangleMesh, bool)]) -> TriangleMesh {
    let (mut vertices, mut triangles) = (vec![], vec![]);
    for (mesh, is_turned) in meshes {
        let first = vertices.len() as u32;
        vertices.extend_from_slice(mesh.vertices());
        triangles.extend(mesh.triangles().iter().map(|&[a, b, c]| {
            if *is_turned { [first + a, first + c, first + b] } else { [first + a, first + b, first + c] }
        }));
    }
    TriangleMesh::new(vertices, triangles).unwrap()
}

fn cuboid(low: Point, high: Point) -> TriangleMesh {
    let vertices =
        (0..8).map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] }));
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    TriangleMesh::new(vertices.collect(), triangles.collect()).unwrap()
}

fn solid(mesh: &TriangleMesh) -> MeshSolid {
    MeshSolid::new(mesh.clone(), FillRule::NonZero).unwrap()
}

fn turn(random: &mut Random) -> [[f64; 3]; 3] {
    let q = loop {
        let q = [0; 4].map(|_| random.between(-1.0, 1.0));
        let square: f64 = q.iter().map(|c| c * c).sum();
        if (0.1..1.0).contains(&square) {
            break q.map(|c| c / square.sqrt());
        }
    };
    let [w, x, y, z] = q;
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

fn check(found: &Clearance, truth: f64, slack: f64, case: &str) {
    let distance = found.distance;
    assert!(distance.lower <= truth + slack && truth <= distance.upper + slack, "{case}: {found:?} {truth}");
    let [p, q] = found.points.unwrap();
    assert!(length(minus(p, q)) <= distance.upper + slack, "{case}: {found:?}");
    for normal in found.normals.into_iter().flatten() {
        assert!((length(normal) - 1.0).abs() < 1e-9, "{case}: {found:?}");
    }
}

/// Lumpy balls beside each other: rotated, stretched, sheared, mirrored, and far from the origin.
#[test]
fn random_meshes_beside_all_pairs() {
    let mut random = Random(21);
    let (mut apart, mut crossing) = (0, 0);
    for case in 0..repeated(48, 120) {
        let far = [0.0, 1e3, 1e7][case % 3];
        let middle = [far, -0.5 * far, 0.25 * far];
        let mut lump = || random.between(-0.3, 0.3);
        let a = ball(middle, 1.0, 3 + case as u32 % 4, &mut lump);
        // Before the placement, the second mesh is near or far away.
        let home = if case % 2 == 0 { [0.0; 3] } else { [far, far, 0.0] };
        let b = ball(home, 0.8, 3 + case as u32 % 3, &mut lump);
        let mut linear = turn(&mut random);
        if case % 4 == 1 {
            let stretch = [random.between(0.3, 2.0), random.between(0.3, 2.0), random.between(-2.0, -0.3)];
            linear = linear.map(|row| [row[0] * stretch[0], row[1] * stretch[1], row[2] * stretch[2]]);
            linear[0][1] += 0.7;
        }
        let reach = [1.5, 2.5, 5.0][case / 3 % 3];
        let rows = [0, 1, 2].map(|axis| {
            let [x, y, z] = linear[axis];
            let offset = middle[axis] - dot(linear[axis], home) + random.between(-reach, reach);
            [x, y, z, offset]
        });
        let placement = Affine::new(rows).unwrap();
        let truth = by_pairs(&a, &b, &placement);
        let (own, other) = (solid(&a), solid(&b));
        let frame = Frame::around(middle.map(|c| c - 16.0), middle.map(|c| c + 16.0), 8).unwrap();
        let home = Frame::around(home.map(|c| c - 2.0), home.map(|c| c + 2.0), 8).unwrap();
        let slack = 1e-12 * (10.0 + far);
        let found =
            clearance_at(&own, &other, &home, &[placement], &frame, 0.0, &alone()).unwrap().pop().unwrap();
        let overlap = found.depth > 0.0 || found.distance.upper == 0.0;
        let name = format!("case {case}");
        if truth < slack {
            crossing += 1;
            assert!(found.distance.lower == 0.0 && found.distance.upper <= slack, "{name}: {found:?}");
            continue;
        }
        if overlap {
            // One inside of the other: seen by a vertex.
            assert_eq!(found.distance.upper, 0.0);
            continue;
        }
        apart += 1;
        check(&found, truth, slack, &name);
        assert!(
            found.distance.width() <= slack && found.stop_reason != StopReason::Budget,
            "{name}: {found:?}"
        );
        // The same mesh moved before.
        let moved = solid(&b.placed(&placement).unwrap());
        let found = clearance(&own, &moved, &frame, 0.0, &alone()).unwrap();
        check(&found, truth, slack, &name);
        assert!(found.distance.width() <= 10.0 * slack, "{name}: {found:?}");
        for (least, verdict) in [(0.999 * truth, GapVerdict::Yes), (1.001 * truth, GapVerdict::No)] {
            if far == 1e7 && truth < 1e-3 {
                continue;
            }
            let gap = gap_at_least(&own, &moved, &frame, least, &alone()).unwrap();
            assert_eq!(gap.verdict, verdict, "{name}: {gap:?}");
            let gaps = gap_at_least_at(&own, &other, &home, &[placement], &frame, least, &alone()).unwrap();
            assert_eq!(gaps[0].verdict, verdict, "{name}: {gaps:?}");
        }
    }
    assert!(apart > repeated(16, 40) && crossing > repeated(4, 10), "{apart} {crossing}");
}

/// A ball inside a hollow ball is as far from it as the triangles are. A ball inside a solid ball overlaps
/// it.
#[test]
fn nested_meshes() {
    let frame = Frame::new([-8.0; 3], 16.0, 8).unwrap();
    let (large, hollow) = (ball([0.0; 3], 5.0, 12, smooth), ball([0.0; 3], 3.0, 10, smooth));
    let shell = together(&[(&large, false), (&hollow, true)]);
    let small = ball([0.5, 0.0, 0.0], 1.0, 9, smooth);
    let truth = by_pairs(&hollow, &small, &Affine::IDENTITY);
    let found = clearance(&solid(&shell), &solid(&small), &frame, 1e-9, &alone()).unwrap();
    check(&found, truth, 1e-12, "in a shell");
    assert!(found.distance.lower > 1.0 && found.splits == [0; 2], "{found:?}");
    assert!(found.distance.width() <= 1e-9, "{found:?}");
    assert_eq!(found.stop_reason, StopReason::Tolerance);
    let gap = gap_at_least(&solid(&shell), &solid(&small), &frame, 1.2, &alone()).unwrap();
    assert_eq!(gap.verdict, GapVerdict::Yes);
    // Within the massive ball, though its triangles are far away.
    for (a, b) in [(&large, &small), (&small, &large)] {
        let found = clearance(&solid(a), &solid(b), &frame, 1e-3, &alone()).unwrap();
        assert!(found.distance.upper == 0.0 && found.depth > 0.5, "{found:?}");
        let gap = gap_at_least(&solid(a), &solid(b), &frame, 1.2, &alone()).unwrap();
        assert_eq!(gap.verdict, GapVerdict::No);
        let place = [Affine::translation([0.25, 0.0, 0.0]).unwrap()];
        let found = clearance_at(&solid(a), &solid(b), &frame, &place, &frame, 1e-3, &alone()).unwrap();
        assert!(found[0].distance.upper == 0.0 && found[0].depth > 0.5, "{found:?}");
    }
    // A part of the second solid lies within the first one, the other part does not.
    let two = together(&[(&small, false), (&ball([7.0, 0.0, 0.0], 0.5, 5, smooth), false)]);
    let found = clearance(&solid(&two), &solid(&large), &frame, 1e-3, &alone()).unwrap();
    assert_eq!(found.distance.upper, 0.0);
    let found = clearance(&solid(&two), &solid(&shell), &frame, 1e-3, &alone()).unwrap();
    assert!(found.distance.lower > 1.0, "{found:?}");
}

/// Overlapping bodies are one solid. Fins of two triangles, and parts that a fill rule excludes, do not
/// belong to it.
#[test]
fn meshes_that_intersect_themselves() {
    let frame = Frame::new([-8.0; 3], 16.0, 7).unwrap();
    let round = |x: f64| ball([x, 0.1 + 0.03 * x, 0.2 - 0.02 * x], 1.0, 7, smooth);
    let two = together(&[(&round(-1.0), false), (&round(0.25), false), (&round(-0.9), false)]);
    let other = cuboid([2.0, -3.0, -3.0], [3.0, 3.0, 3.0]);
    for fill in [FillRule::NonZero, FillRule::EvenOdd] {
        let two = MeshSolid::new(two.clone(), fill).unwrap();
        let found = clearance(&two, &solid(&other), &frame, 1e-9, &alone()).unwrap();
        check(&found, by_pairs(two.mesh(), &other, &Affine::IDENTITY), 1e-12, "two balls");
        assert!(found.distance.width() <= 1e-9 && found.splits == [0; 2], "{found:?}");
        let inner = ball([-0.95, 0.1, 0.2], 0.1, 5, smooth);
        let found = clearance(&two, &solid(&inner), &frame, 1e-9, &alone()).unwrap();
        // A point in two balls is outside by the even-odd rule.
        if fill == FillRule::NonZero {
            assert_eq!(found.distance.upper, 0.0, "{found:?}");
        } else {
            check(&found, by_pairs(two.mesh(), &inner, &Affine::IDENTITY), 1e-12, "an even number of balls");
            assert!(found.distance.lower > 0.1, "{found:?}");
        }
    }
    let is_right = |mesh: &TriangleMesh, fill: FillRule, truth: f64| {
        let mesh = MeshSolid::new(mesh.clone(), fill).unwrap();
        let found = clearance(&mesh, &solid(&other), &frame, 0.25, &alone()).unwrap();
        assert!(found.distance.lower <= truth && truth <= found.distance.upper, "{found:?} {truth}");
    };
    // A fin towards the other solid, which encloses nothing.
    let unit = cuboid([-1.0; 3], [0.0; 3]);
    let (mut vertices, mut triangles) = (unit.vertices().to_vec(), unit.triangles().to_vec());
    vertices.extend([[-0.5, -0.5, -0.5], [1.75, -0.5, -0.5], [-0.5, -0.2, -0.5]]);
    triangles.extend([[8, 9, 10], [8, 10, 9]]);
    let fin = TriangleMesh::new(vertices, triangles).unwrap();
    is_right(&fin, FillRule::NonZero, 2.0);
    is_right(&fin, FillRule::EvenOdd, 2.0);
    // An inside-out body is empty by the positive rule.
    let turned = together(&[(&cuboid([-1.0; 3], [0.0; 3]), false), (&cuboid([-0.5; 3], [1.0; 3]), true)]);
    is_right(&turned, FillRule::Positive, 2.0);
    is_right(&turned, FillRule::NonZero, 1.0);
}

/// Boxes that touch on faces, edges and corners have distance 0 and no penetration depth. Equal meshes
/// overlap.
#[test]
fn meshes_in_contact() {
    let frame = Frame::new([-8.0; 3], 16.0, 8).unwrap();
    let a = cuboid([0.0; 3], [1.0; 3]);
    for offset in [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [1.0, 0.3, 0.4], [0.0, 0.25, -1.0]] {
        let b = cuboid(offset, offset.map(|c| c + 1.0));
        let found = clearance(&solid(&a), &solid(&b), &frame, 1e-9, &alone()).unwrap();
        assert!(found.distance.upper == 0.0 && found.depth == 0.0, "{offset:?}: {found:?}");
        let gap = gap_at_least(&solid(&a), &solid(&b), &frame, 1e-6, &alone()).unwrap();
        assert_eq!(gap.verdict, GapVerdict::No);
        let moved = Affine::translation(offset).unwrap();
        let found = clearance_at(&solid(&a), &solid(&a), &frame, &[moved], &frame, 1e-9, &alone()).unwrap();
        assert!(found[0].distance.upper <= 1e-12 && found[0].depth == 0.0, "{offset:?}: {found:?}");
    }
    let mut random = Random(4);
    for _ in 0..20 {
        let turn = turn(&mut random);
        let rows = [0, 1, 2].map(|axis| [turn[axis][0], turn[axis][1], turn[axis][2], 0.3]);
        let (placed, both) = (Affine::new(rows).unwrap(), [[1.0, 0.0, 0.0], [1.0, 0.5, 0.5]]);
        for offset in both {
            let b = cuboid(offset, offset.map(|c| c + 1.0));
            let found = clearance(
                &solid(&a.placed(&placed).unwrap()),
                &solid(&b.placed(&placed).unwrap()),
                &frame,
                1e-9,
                &alone(),
            )
            .unwrap();
            assert!(found.distance.lower == 0.0 && found.distance.upper <= 1e-12, "{found:?}");
        }
        let (one, other) = (solid(&a.placed(&placed).unwrap()), solid(&a));
        let found =
            clearance_at(&one, &other, &frame, &[placed], &frame, 1e-3, &alone()).unwrap().pop().unwrap();
        assert!(found.distance.upper == 0.0 && found.depth > 0.3, "{found:?}");
    }
    let found = clearance(&solid(&a), &solid(&a), &frame, 0.0, &alone()).unwrap();
    assert!(found.distance.upper == 0.0 && found.depth > 0.3, "{found:?}");
}

/// Parallel faces at a constant distance, very flat triangles, and small limits of steps.
#[test]
fn parallel_faces_and_slivers() {
    let frame = Frame::new([-8.0; 3], 16.0, 8).unwrap();
    let fan = |z: f64, count: u32| {
        // A disc of slivers around one vertex, and a tip.
        let mut vertices = vec![[0.0, 0.0, z], [0.0, 0.0, z - 1.0]];
        let around = 2.0 * std::f64::consts::PI / f64::from(count);
        vertices
            .extend((0..count).map(|k| [(f64::from(k) * around).cos(), (f64::from(k) * around).sin(), z]));
        let rim = |k: u32| 2 + k % count;
        let triangles = (0..count).flat_map(|k| [[0, rim(k), rim(k + 1)], [1, rim(k + 1), rim(k)]]);
        TriangleMesh::new(vertices, triangles.collect()).unwrap()
    };
    let (a, b) = (fan(0.0, 2000), fan(1.5, 1999));
    let found = clearance(&solid(&a), &solid(&b), &frame, 0.0, &alone()).unwrap();
    check(&found, 0.5, 1e-12, "fans");
    assert!(found.distance.width() <= 1e-11, "{found:?}");
    // A part of the budget proves a part.
    let few = Control { max_splits: Some(1), ..alone() };
    let found = clearance(&solid(&a), &solid(&b), &frame, 0.0, &few).unwrap();
    assert!(found.distance.lower <= 0.5 && found.distance.upper >= 0.5, "{found:?}");
    assert_eq!(found.stop_reason, StopReason::Budget);
    // A triangle without area, and a vertex without triangles.
    let mut vertices = cuboid([0.0; 3], [1.0; 3]).vertices().to_vec();
    let mut triangles = cuboid([0.0; 3], [1.0; 3]).triangles().to_vec();
    vertices.push([0.5, 0.0, 0.0]);
    vertices.push([3.0, 3.0, 3.0]);
    triangles.extend([[0, 1, 8], [0, 8, 1]]);
    let flat = TriangleMesh::new(vertices, triangles).unwrap();
    let found =
        clearance(&solid(&flat), &solid(&cuboid([2.0; 3], [4.0; 3])), &frame, 1e-9, &alone()).unwrap();
    check(&found, 3f64.sqrt(), 1e-12, "flat");
}

/// The answers do not depend on threads, and searches can be cancelled.
#[test]
fn threads_and_cancelling() {
    let frame = Frame::new([-16.0; 3], 32.0, 8).unwrap();
    let mut random = Random(8);
    let a = solid(&ball([0.0; 3], 2.0, 20, || random.between(-0.05, 0.05)));
    let b = solid(&ball([0.0; 3], 2.0, 17, || random.between(-0.05, 0.05)));
    let places: Vec<Affine> = (0..60)
        .map(|_| {
            let turn = turn(&mut random);
            let rows = turn.map(|[x, y, z]| [x, y, z, random.between(-5.0, 5.0)]);
            Affine::new(rows).unwrap()
        })
        .collect();
    let with = |threads: usize| {
        let control = Control::threads(threads);
        clearance_at(&a, &b, &frame, &places, &frame, 1e-3, &control).unwrap()
    };
    assert_eq!(with(1), with(2));
    assert_eq!(with(1), with(5));
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let control = Control { cancel: Some(&cancel), ..alone() };
    let refused = clearance(&a, &b, &frame, 0.0, &control);
    assert!(matches!(refused, Err(Error::Cancelled)));
}

/// A mesh at many places beside itself: no vertices are nearer than the lower bound, and the two bounds are
/// equal up to rounding.
#[test]
#[ignore = "minutes"]
fn a_mesh_beside_itself() {
    let Some(path) = model("featuretype.STL") else { return };
    let mesh =
        exchange::read_mesh(&std::fs::read(path).unwrap(), &exchange::MeshOptions::default()).unwrap().mesh;
    let (min, max) = mesh.bounds();
    let extent = [0, 1, 2].map(|axis| max[axis] - min[axis]);
    let longest = extent.iter().copied().fold(0.0, f64::max);
    let middle = [0, 1, 2].map(|axis| 0.5 * (min[axis] + max[axis]));
    let frame = Frame::around(
        [0, 1, 2].map(|k| middle[k] - 3.0 * longest),
        [0, 1, 2].map(|k| middle[k] + 3.0 * longest),
        9,
    )
    .unwrap();
    let solid = solid(&mesh);
    let mut random = Random(16);
    let places: Vec<Affine> = (0..1000)
        .map(|_| {
            let turn = turn(&mut random);
            let rows = [0, 1, 2].map(|axis| {
                let [x, y, z] = turn[axis];
                let offset = middle[axis] - dot(turn[axis], middle) + random.between(-1.2, 1.2) * longest;
                [x, y, z, offset]
            });
            Affine::new(rows).unwrap()
        })
        .collect();
    let start = std::time::Instant::now();
    let all = clearance_at(&solid, &solid, &frame, &places, &frame, 1e-9 * longest, &alone()).unwrap();
    let time = start.elapsed();
    let (mut widest, mut apart) = (0.0f64, 0);
    for (case, (found, place)) in all.iter().zip(&places).enumerate() {
        // The nearest of some points of both surfaces, by brute force.
        let thin = |place: &Affine| -> Vec<Point> {
            mesh.vertices().iter().step_by(7).map(|&p| place.apply(p)).collect()
        };
        let (own, others) = (thin(&Affine::IDENTITY), thin(place));
        let nearest = own.iter().flat_map(|&p| others.iter().map(move |&q| dot(minus(p, q), minus(p, q))));
        let nearest = nearest.fold(f64::INFINITY, f64::min).sqrt();
        assert!(found.distance.lower <= nearest, "case {case}: {found:?} {nearest}");
        assert!(found.distance.width() <= 1e-9 * longest, "case {case}: {found:?}");
        if found.distance.lower > 0.0 {
            apart += 1;
            widest = widest.max(found.distance.width());
        }
    }
    println!("{apart} of 1000 apart, at most {widest} wide, of {longest}; {time:?}");
    assert!(apart > 100);
}
