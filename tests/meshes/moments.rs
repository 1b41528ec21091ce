//! The moments of meshes without splits, against sums in exact arithmetic; intersecting triangles, against a
//! slow search in exact arithmetic.

use leafless::lattice::VolumeMoments;
use leafless::mesh::MeshMoments;
use leafless::query::StopReason;
use leafless::{
    Affine, AnySolid, Control, FillRule, Frame, Interval, MassProperties, MeshSolid, TriangleMesh, exchange,
    measure,
};
use leafless_testkit::exact::Exact;
use leafless_testkit::{Random, model};

use std::slice::from_ref;

/// Bodies, and the number of times that each body counts under each rule.
type Case<'a> = (&'a [Vec<Facet>], [&'a [i32]; 3]);
type Point = [f64; 3];
type Facet = [Point; 3];

const RULES: [FillRule; 3] = [FillRule::NonZero, FillRule::EvenOdd, FillRule::Positive];
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

fn mesh(bodies: &[Vec<Facet>]) -> TriangleMesh {
    TriangleMesh::from_facets(bodies.concat()).unwrap()
}

fn moments(mesh: &TriangleMesh, rule: FillRule) -> MeshMoments {
    mesh.moments(rule, &Control::default()).unwrap()
}

#[track_caller]
fn known(mesh: &TriangleMesh, rule: FillRule) -> VolumeMoments {
    match moments(mesh, rule) {
        MeshMoments::Known(moments) => moments,
        other => panic!("{rule:?}: {other:?}"),
    }
}

fn turned(body: &[Facet]) -> Vec<Facet> {
    body.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

/// An axis-aligned block, as twelve triangles.
fn block(low: Point, high: Point) -> Vec<Facet> {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|face| face.map(corner)).collect()
}

fn cube(half: f64) -> Vec<Facet> {
    block([-half; 3], [half; 3])
}

/// The faces of a tetrahedron. Seen from outside they are counter-clockwise if `d` lies below a, b, c.
fn tetrahedron([a, b, c, d]: [Point; 4]) -> Vec<Facet> {
    vec![[a, b, c], [b, a, d], [c, b, d], [a, c, d]]
}

/// Exact sums: 20 times 6 times the volume, and the first and second moments about the origin in the same
/// unit.
struct Sums {
    volume: Exact,
    first: [Exact; 3],
    second: [Exact; 6],
}

impl Sums {
    fn of(facets: impl IntoIterator<Item = (Facet, i32)>) -> Sums {
        let zero = || Exact::from(0.0);
        let mut sums =
            Sums { volume: zero(), first: [zero(), zero(), zero()], second: std::array::from_fn(|_| zero()) };
        for (facet, times) in facets {
            let [a, b, c] = facet.map(|corner| corner.map(Exact::from));
            let minor = |i: usize, j: usize| b[i].times(&c[j]).minus(&b[j].times(&c[i]));
            let all =
                a[0].times(&minor(1, 2)).plus(&a[1].times(&minor(2, 0))).plus(&a[2].times(&minor(0, 1)));
            let six_fold = all.times(&Exact::from(f64::from(times)));
            let sum = [0, 1, 2].map(|axis| a[axis].plus(&b[axis]).plus(&c[axis]));
            sums.volume = sums.volume.plus(&Exact::from(20.0).times(&six_fold));
            for (first, sum) in sums.first.iter_mut().zip(&sum) {
                *first = first.plus(&Exact::from(5.0).times(&six_fold).times(sum));
            }
            for (second, (i, j)) in sums.second.iter_mut().zip(PAIRS) {
                let squares = [&a, &b, &c].map(|p| p[i].times(&p[j]));
                let all = squares.iter().fold(sum[i].times(&sum[j]), |all, square| all.plus(square));
                *second = second.plus(&six_fold.times(&all));
            }
        }
        sums
    }
}

/// Checks lower ≤ numerator / denominator ≤ upper, exactly, and that the interval is at most `width` wide.
#[track_caller]
fn check(what: &str, interval: Interval, numerator: &Exact, denominator: &Exact, width: f64) {
    let side = |x: f64| Exact::from(x).times(denominator).minus(numerator).sign();
    assert!(side(interval.lower) <= 0 && side(interval.upper) >= 0, "{what} is not in {interval:?}");
    assert!(interval.width() <= width, "{what} is known too badly: {interval:?}");
}

/// Checks all measures of the solid that a mesh encloses against exact sums over the signed triangles
/// `facets`. `size` is the extent of the mesh, `far` its distance from the origin.
#[track_caller]
fn check_all(measures: &MassProperties, facets: Vec<(Facet, i32)>, size: f64, far: f64) {
    let sums = Sums::of(facets);
    let unit = Exact::from(120.0);
    let volume = size.powi(3);
    check("volume", measures.volume, &sums.volume, &unit, 1e-13 * volume);
    let centroid = measures.centroid.unwrap();
    for axis in 0..3 {
        let width = 1e-11 * size + 1e-15 * far;
        check("centroid", centroid[axis], &sums.first[axis], &sums.volume, width);
    }
    for (k, (i, j)) in PAIRS.into_iter().enumerate() {
        let about = |second: &[Exact; 6]| {
            if i == j {
                second[(i + 1) % 3].plus(&second[(i + 2) % 3])
            } else {
                Exact::from(0.0).minus(&second[k])
            }
        };
        let width = 1e-12 * volume * (size + far).powi(2);
        check("inertia", measures.inertia_about_origin[i][j], &about(&sums.second), &unit, width);
        let central = std::array::from_fn(|k| {
            let (i, j) = PAIRS[k];
            sums.second[k].times(&sums.volume).minus(&sums.first[i].times(&sums.first[j]))
        });
        let width = 1e-11 * volume * size * size;
        let denominator = sums.volume.times(&unit);
        check(
            "central inertia",
            measures.inertia_about_centroid[i][j],
            &about(&central),
            &denominator,
            width,
        );
    }
}

fn measured(mesh: TriangleMesh, rule: FillRule) -> MassProperties {
    let (min, max) = mesh.bounds();
    let frame = Frame::around(min, max, 6).unwrap();
    measure(&AnySolid::new(MeshSolid::new(mesh, rule).unwrap()), &frame, 1e-12, &Control::default()).unwrap()
}

#[test]
fn random_tetrahedra_and_blocks() {
    let mut random = Random(7);
    for round in 0..200 {
        let scale = 2f64.powi(random.below(80) as i32 - 40);
        let far = if round % 3 == 0 { 1e3 * scale } else { 0.0 };
        let facets = if round % 2 == 0 {
            let mut point = || [0, 1, 2].map(|_| scale * random.between(-1.0, 1.0) + far);
            tetrahedron([point(), point(), point(), point()])
        } else {
            let low = [0, 1, 2].map(|_| scale * random.between(-1.0, 0.0) + far);
            let high = [0, 1, 2].map(|_| scale * random.between(0.1, 1.0) + far);
            block(low, high)
        };
        // With either orientation, NonZero and EvenOdd enclose it.
        let sign = if mesh(from_ref(&facets)).volume() > 0.0 { 1 } else { -1 };
        for rule in RULES {
            let measures = measured(mesh(from_ref(&facets)), rule);
            assert_eq!(measures.splits, 0);
            if rule == FillRule::Positive && sign < 0 {
                assert_eq!((measures.volume, measures.centroid), (Interval::exactly(0.0), None));
                continue;
            }
            let tiny = measures.volume.lower < 1e-3 * scale.powi(3);
            if !tiny {
                check_all(&measures, facets.iter().map(|&facet| (facet, sign)).collect(), 2.0 * scale, far);
            }
        }
    }
}

/// Nested shells, each with the number of times that it counts under each rule.
#[test]
fn nested_shells() {
    let [one, two, three] = [cube(1.0), cube(2.0), cube(3.0)];
    let tilted: Vec<Facet> =
        tetrahedron([[0.5, 0.0, 0.1], [-0.2, 0.4, 0.0], [-0.3, -0.4, 0.2], [0.0, 0.1, -0.5]]);
    // Bodies from the inside out, each with the sign of its volume, and the number of times that it counts
    // under each rule.
    let cases: [Case<'_>; 9] = [
        (from_ref(&one), [&[1], &[1], &[1]]),
        (&[turned(&one)], [&[-1], &[-1], &[0]]),
        // A cavity.
        (&[turned(&one), two.clone()], [&[1, 1], &[1, 1], &[1, 1]]),
        // With the same orientation.
        (&[one.clone(), two.clone()], [&[0, 1], &[-1, 1], &[0, 1]]),
        (&[turned(&one), turned(&two)], [&[0, -1], &[1, -1], &[0, 0]]),
        // An inside-out block with a body in it.
        (&[one.clone(), turned(&two)], [&[-1, -1], &[-1, -1], &[0, 0]]),
        // A body in a cavity of another one.
        (&[one.clone(), turned(&two), three.clone()], [&[1; 3], &[1; 3], &[1; 3]]),
        (&[one.clone(), two.clone(), three.clone()], [&[0, 0, 1], &[1, -1, 1], &[0, 0, 1]]),
        (&[tilted.clone(), turned(&one), three.clone()], [&[1; 3], &[1; 3], &[1; 3]]),
    ];
    for (number, (bodies, times)) in cases.into_iter().enumerate() {
        for (rule, times) in RULES.into_iter().zip(times) {
            let measures = measured(mesh(bodies), rule);
            assert_eq!(measures.splits, 0, "case {number}, {rule:?}");
            if times.iter().all(|&times| times == 0) {
                assert_eq!(measures.volume, Interval::exactly(0.0), "case {number}, {rule:?}");
                continue;
            }
            let facets =
                bodies.iter().zip(times).flat_map(|(body, &times)| body.iter().map(move |&f| (f, times)));
            check_all(&measures, facets.collect(), 6.0, 0.0);
        }
    }
}

/// Several bodies side by side that share vertices and edges, or have opposite orientations.
#[test]
fn bodies_that_touch() {
    let [a, edge, corner] = [[0.0; 3], [1.0, 1.0, 0.0], [1.0; 3]].map(|low| block(low, low.map(|x| x + 1.0)));
    for other in [edge, corner] {
        for rule in RULES {
            assert!(known(&mesh(&[a.clone(), other.clone()]), rule).volume.contains(2.0));
            let inside_out = known(&mesh(&[a.clone(), turned(&other)]), rule).volume;
            assert!(inside_out.contains(if rule == FillRule::Positive { 1.0 } else { 2.0 }), "{rule:?}");
        }
    }
    // With one inverted triangle, only parity is meaningful.
    let mut one_turned = a.clone();
    one_turned[3].swap(0, 1);
    let one_turned = mesh(&[one_turned]);
    assert!(known(&one_turned, FillRule::EvenOdd).volume.contains(1.0));
    assert_eq!(moments(&one_turned, FillRule::NonZero), MeshMoments::Open);
    assert_eq!(moments(&mesh(&[a[1..].to_vec()]), FillRule::EvenOdd), MeshMoments::Open);
}

#[test]
fn what_intersects_is_split() {
    let base = cube(1.0);
    let moved = |offset: Point| block(offset.map(|x| x - 1.0), offset.map(|x| x + 1.0));
    let touching = moved([2.0, 0.25, 0.25]);
    for other in [moved([0.5, 0.25, 0.125]), moved([0.5, 0.5, 0.5]), moved([0.0; 3]), touching] {
        let both = mesh(&[base.clone(), other]);
        for rule in [FillRule::NonZero, FillRule::Positive] {
            assert!(matches!(moments(&both, rule), MeshMoments::Intersecting(_)), "{rule:?}");
        }
    }
    let both = mesh(&[base.clone(), moved([0.5, 0.25, 0.125])]);
    let (min, max) = both.bounds();
    let frame = Frame::around(min, max, 7).unwrap();
    for (rule, volume) in RULES.into_iter().zip([16.0 - 1.5 * 1.75 * 1.875, 16.0 - 3.0 * 1.75 * 1.875]) {
        let solid = MeshSolid::new(both.clone(), rule).unwrap();
        let measures = measure(&solid, &frame, 0.05, &Control::default()).unwrap();
        assert!(measures.volume.contains(volume) && measures.splits > 0, "{measures:?}");
    }
}

/// Parts with round dimensions have no rounding at all.
#[test]
fn round_parts_are_exact() {
    let cavity = turned(&block([11.0, -4.0, 3.25], [12.5, -3.0, 4.0]));
    let measures = measured(mesh(&[block([10.0, -5.0, 2.0], [14.0, 3.0, 5.0]), cavity]), FillRule::NonZero);
    assert_eq!(measures.volume, Interval::exactly(96.0 - 1.5 * 0.75));
    let cube = measured(mesh(&[cube(1.0)]), FillRule::NonZero);
    assert_eq!(cube.centroid, Some([Interval::exactly(0.0); 3]));
    let inertia = cube.inertia_about_centroid[0][0];
    assert!(inertia.contains(16.0 / 3.0) && inertia.width() < 2e-15, "{inertia:?}");
}

/// The part within the universe is smaller than the enclosed set. Cells measure it, up to rounding.
#[test]
fn clipped_meshes_are_measured_in_the_universe() {
    let solid = MeshSolid::new(mesh(&[cube(1.0)]), FillRule::NonZero).unwrap();
    let control = Control::default();
    let half = Frame::new([0.0, -2.0, -2.0], 4.0, 5).unwrap();
    let measures = measure(&solid, &half, 0.0, &control).unwrap();
    assert!(measures.clipped && measures.volume.contains(4.0), "{measures:?}");
    assert!(measures.volume.width() < 1e-9 && measures.splits == 0, "{measures:?}");
    let whole = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let measures = measure(&solid, &whole, 1e-12, &control).unwrap();
    assert_eq!((measures.clipped, measures.splits, measures.stop_reason), (false, 0, StopReason::Tolerance));
    // Splits cannot reach a tolerance below rounding.
    let third = MeshSolid::new(mesh(&[cube(1.0 / 3.0)]), FillRule::NonZero).unwrap();
    let measures = measure(&third, &whole, 0.0, &control).unwrap();
    assert_eq!((measures.splits, measures.stop_reason), (0, StopReason::Exhausted));
}

/// Rounded vertices may be displaced. The intervals contain the exact image.
#[test]
fn placed_meshes_contain_the_exact_image() {
    let turn = [[0.6, -0.8, 0.0, 1e3], [0.8, 0.6, 0.0, 0.1], [0.0, 0.0, 1.0, 0.3]];
    let facets = tetrahedron([[0.1, 0.2, 0.3], [1.0, 0.1, 0.0], [0.3, 1.1, 0.2], [0.4, 0.3, -1.0]]);
    let placed = mesh(from_ref(&facets)).placed(&Affine::new(turn).unwrap()).unwrap();
    assert!(placed.displacement() > 0.0);
    let sign = if placed.volume() > 0.0 { 1 } else { -1 };
    let measures = measured(placed, FillRule::NonZero);
    assert_eq!(measures.splits, 0);
    // The linear part is not exactly a rotation: the doubles 0.6 and 0.8 give the determinant.
    let [p, q] = [0.6, 0.8].map(Exact::from);
    let determinant = p.times(&p).plus(&q.times(&q));
    let sums = Sums::of(facets.into_iter().map(|facet| (facet, sign)));
    check("volume", measures.volume, &sums.volume.times(&determinant), &Exact::from(120.0), 1e-10);
    // The added error is not zero.
    assert!(measures.volume.width() > 1e-13);
}

/// True if two triangles with small integer coordinates have no point in common, by separating axes.
fn separated(a: &Facet, b: &Facet) -> bool {
    let whole = |facet: &Facet| facet.map(|p| p.map(|x| x as i64));
    let (a, b) = (whole(a), whole(b));
    let minus = |p: [i64; 3], q: [i64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let cross = |u: [i64; 3], v: [i64; 3]| {
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    };
    let edges = |t: [[i64; 3]; 3]| [minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])];
    let (of_a, of_b) = (edges(a), edges(b));
    let normals = [cross(of_a[0], of_a[1]), cross(of_b[0], of_b[1])];
    let mut axes = normals.to_vec();
    for u in of_a {
        axes.push(cross(normals[0], u));
        for v in of_b {
            axes.push(cross(u, v));
        }
    }
    // (The second may be a segment.)
    of_b.iter().for_each(|&v| axes.extend(normals.map(|normal| cross(normal, v))));
    axes.iter().any(|axis| {
        let range = |t: [[i64; 3]; 3]| {
            let on = t.map(|p| p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2]);
            (*on.iter().min().unwrap(), *on.iter().max().unwrap())
        };
        let ((low_a, high_a), (low_b, high_b)) = (range(a), range(b));
        high_a < low_b || high_b < low_a
    })
}

#[test]
fn pairs_without_common_vertices() {
    let mut random = Random(3);
    let mut counts = [0; 2];
    for round in 0..60_000 {
        let extent = [2, 3, 5, 9][round % 4];
        let mut point = || [0, 1, 2].map(|_| random.below(extent) as f64);
        let [a, b] = [[point(), point(), point()], [point(), point(), point()]];
        let mesh = TriangleMesh::from_facets([a, b]).unwrap();
        let report = mesh.report().unwrap();
        if mesh.vertices().len() != 6 || report.flat > 0 || report.triangles != 2 {
            continue;
        }
        let found = mesh.intersecting_pairs(1, &Control::default()).unwrap();
        assert!(found.is_complete);
        assert_eq!(found.count == 0, separated(&a, &b), "{a:?} {b:?}");
        counts[found.count as usize] += 1;
    }
    assert!(counts[0] > 5000 && counts[1] > 5000, "{counts:?}");
}

/// Close to a common vertex, triangles are cones. They meet beyond the vertex if a segment across one of
/// them, close to the vertex, meets the other one. For a common edge, the segment lies beside the edge.
#[test]
fn pairs_with_common_vertices() {
    let mut random = Random(4);
    let mut counts = [[0; 2]; 3];
    for round in 0..120_000 {
        let extent = [3, 4, 6][round % 3];
        let mut point = || [0, 1, 2].map(|_| random.below(extent) as f64);
        let shared = 1 + round % 2;
        let a = [point(), point(), point()];
        let b = if shared == 1 { [a[0], point(), point()] } else { [a[1], a[0], point()] };
        let mesh = TriangleMesh::from_facets([a, b]).unwrap();
        let report = mesh.report().unwrap();
        if mesh.vertices().len() != 6 - shared || report.flat > 0 || report.triangles != 2 {
            continue;
        }
        // All in units of 1/64.
        let scaled = |p: Point| p.map(|x| 64.0 * x);
        let between = |p: Point, q: Point| [0, 1, 2].map(|k| 63.0 * p[k] + q[k]);
        let meets = if shared == 1 {
            let [p, q] = [b[1], b[2]].map(|far| between(b[0], far));
            !separated(&a.map(scaled), &[p, q, p])
        } else {
            let [p, q] = [b[0], b[1]].map(|near| between(near, b[2]));
            !separated(&a.map(scaled), &[p, q, p])
        };
        let found = mesh.intersecting_pairs(1, &Control::default()).unwrap();
        assert_eq!(found.count == 1, meets, "{a:?} {b:?}");
        counts[shared][found.count as usize] += 1;
    }
    assert!(counts[1..].as_flattened().iter().all(|&count| count > 100), "{counts:?}");
}

fn model_mesh(name: &str) -> Option<TriangleMesh> {
    let bytes = std::fs::read(model(name)?).unwrap();
    Some(exchange::read_mesh(&bytes, &Default::default()).unwrap().mesh.sewn().unwrap())
}

#[test]
fn models() {
    let closed = [
        "rocker-arm.obj",
        "fandisk.obj",
        "featuretype.STL",
        "angle_block.STL",
        "plate_holes.STL",
        "spot.obj",
    ];
    for name in closed {
        let Some(mesh) = model_mesh(name) else { return };
        let pairs = mesh.intersecting_pairs(1, &Control::default()).unwrap();
        assert_eq!((pairs.count, pairs.is_complete), (0, true), "{name}");
        for rule in RULES {
            let volume = known(&mesh, rule).volume;
            assert!(volume.width() < 1e-12 * volume.upper, "{name}: {volume:?}");
            assert!((volume.lower - mesh.volume()).abs() < 1e-12 * volume.upper, "{name}: {volume:?}");
        }
    }
    let bunny = model_mesh("bunny-closed.stl").unwrap();
    let pairs = bunny.intersecting_pairs(100, &Control::default()).unwrap();
    assert_eq!((pairs.count, pairs.pairs.len(), pairs.is_complete), (11, 11, true));
    assert!(matches!(moments(&bunny, FillRule::NonZero), MeshMoments::Intersecting(_)));
    // An inside-out body that shares no edges. Parity defines the enclosed set.
    let multibody = model_mesh("multibody.stl").unwrap();
    assert_eq!(moments(&multibody, FillRule::NonZero), MeshMoments::Open);
    let volume = known(&multibody, FillRule::EvenOdd).volume;
    let frame = Frame::around(multibody.bounds().0, multibody.bounds().1, 6).unwrap();
    let tree = leafless::build(
        &MeshSolid::new(multibody, FillRule::EvenOdd).unwrap(),
        &frame,
        leafless::Rule::Certified,
        &Control::default(),
    );
    let bounds = tree.unwrap().statistics().volume();
    assert!(bounds.lower <= volume.lower && volume.upper <= bounds.upper, "{volume:?} {bounds:?}");
}
