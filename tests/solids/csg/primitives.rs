//! Half-spaces and primitives under random placements, against exact arithmetic.
//!
//! By default there are about 10⁵ points for each. A million points each take some minutes:
//! `cargo test --release --test solids csg::primitives -- --ignored`

use leafless::solid::{Fingerprint, HalfSpace, Touch};
use leafless::{
    Affine, Bounds, Classifier, Control, Csg, Error, Frame, Interval, Membership, Octree, Rule, Solid,
    Verdict, Worker, build,
};
use leafless_testkit::exact::Exact;
use leafless_testkit::{Random, repeated};
use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, Mutex};

/// A point in a primitive's own space: numerators, and their positive common denominator.
struct Point {
    at: [Exact; 3],
    w: Exact,
}

/// Returns the sum of exact numbers.
fn sum(terms: impl IntoIterator<Item = Exact>) -> Exact {
    terms.into_iter().fold(Exact::from(0.0), |sum, term| sum.plus(&term))
}

fn pow(base: &Exact, n: u32) -> Exact {
    match n {
        0 => Exact::from(1.0),
        1 => base.clone(),
        _ => {
            let half = pow(base, n / 2);
            let even = half.times(&half);
            if n.is_multiple_of(2) { even } else { even.times(base) }
        }
    }
}

impl Point {
    /// Returns the point with the image `p`.
    fn before(placement: &Affine, p: [f64; 3]) -> Point {
        let m = placement.rows().map(|row| row.map(Exact::from));
        let d: Vec<Exact> = (0..3).map(|i| Exact::from(p[i]).minus(&m[i][3])).collect();
        let det2 = |a: &Exact, b: &Exact, c: &Exact, d: &Exact| a.times(d).minus(&b.times(c));
        let cofactor = |i: usize, j: usize| {
            let (r, s, t, u) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            det2(&m[r][t], &m[r][u], &m[s][t], &m[s][u])
        };
        let w = sum((0..3).map(|j| m[0][j].times(&cofactor(0, j))));
        let at = [0, 1, 2].map(|j| sum((0..3).map(|i| cofactor(i, j).times(&d[i]))));
        let flip = Exact::from(w.sign() as f64);
        Point { at: at.map(|c| c.times(&flip)), w: w.times(&flip) }
    }

    /// Returns the coordinate minus a number, times w.
    fn beyond(&self, axis: usize, x: f64) -> Exact {
        self.at[axis].minus(&self.w.times(&x.into()))
    }

    fn slab(&self, axis: usize, low: f64, high: f64) -> i32 {
        self.beyond(axis, low).sign().min(-self.beyond(axis, high).sign())
    }

    /// Returns the sign of n · p + d.
    fn plane(&self, n: [f64; 3], d: f64) -> i32 {
        let products = (0..3).map(|axis| self.at[axis].times(&n[axis].into()));
        sum(products.chain([self.w.times(&d.into())])).sign()
    }
}

/// 1 in the interior, −1 in the exterior, 0 on the boundary.
type Side = Box<dyn Fn(&Point) -> i32>;

struct Shape {
    name: &'static str,
    solid: Csg,
    side: Side,
    volume: Option<f64>,
    /// A box around the shape.
    bounds: ([f64; 3], [f64; 3]),
}

const HOOK: [[f64; 2]; 8] =
    [[0.0, 0.0], [3.0, 0.25], [3.0, 2.0], [2.0, 2.0], [2.0, 1.0], [1.0, 0.75], [0.75, 2.5], [-0.5, 1.5]];

fn polygon_side(p: &Point, corners: &[[f64; 2]]) -> i32 {
    let mut inside = -1;
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (dx, dy) = (Exact::from(b[0]).minus(&a[0].into()), Exact::from(b[1]).minus(&a[1].into()));
        let left = dx.times(&p.beyond(1, a[1])).minus(&dy.times(&p.beyond(0, a[0]))).sign();
        let between = |axis: usize| p.slab(axis, a[axis].min(b[axis]), a[axis].max(b[axis])) >= 0;
        if left == 0 && between(0) && between(1) {
            return 0;
        }
        let above = |y: f64| p.beyond(1, y).sign() < 0;
        if above(a[1]) != above(b[1]) && (left > 0) == (b[1] > a[1]) {
            inside = -inside;
        }
    }
    inside
}

fn polygon_area(corners: &[[f64; 2]]) -> f64 {
    let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
    pairs.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>().abs() / 2.0
}

/// Returns the sign of 2 R ρ − (x² + y² + z² + R² − r²), without a root.
fn torus_side(p: &Point, major: f64, minor: f64) -> i32 {
    let [x, y, z] = p.at.each_ref().map(|c| pow(c, 2));
    let rho = x.plus(&y);
    let [major, minor] = [major, minor].map(|radius| p.w.times(&radius.into()));
    let rest = rho.plus(&z).plus(&pow(&major, 2)).minus(&pow(&minor, 2));
    let root = pow(&major, 2).times(&rho).times(&4.0.into());
    if rest.sign() < 0 { 1 } else { root.minus(&pow(&rest, 2)).sign() }
}

fn power_side(p: &Point, terms: [(f64, f64, u32); 3], constant: f64) -> i32 {
    let n = terms.iter().map(|term| term.2).max().unwrap();
    let parts = (0..3).map(|axis| {
        let (coefficient, centre, exponent) = terms[axis];
        let power = pow(&p.beyond(axis, centre), exponent).times(&pow(&p.w, n - exponent));
        power.times(&coefficient.into())
    });
    sum(parts.chain([pow(&p.w, n).times(&constant.into())])).sign()
}

fn quadric_side(p: &Point, c: [f64; 10]) -> i32 {
    let [x, y, z] = p.at.each_ref();
    let w = &p.w;
    let pairs = [(x, x), (y, y), (z, z), (x, y), (y, z), (z, x), (x, w), (y, w), (z, w), (w, w)];
    sum(pairs.iter().zip(c).map(|((a, b), c)| a.times(b).times(&c.into()))).sign()
}

/// Returns the volume of the points with |x|^p + |y|^q + |z|^r ≤ 1.
fn superball_volume(exponents: [f64; 3]) -> f64 {
    let g = |x: f64| libm::tgamma(1.0 + x);
    let [p, q, r] = exponents.map(|n| 1.0 / n);
    8.0 * g(p) * g(q) * g(r) / g(p + q + r)
}

fn shapes() -> Vec<Shape> {
    let mut shapes = Vec::new();
    let mut add = |name, solid: Csg, volume: Option<f64>, bounds, side: Side| {
        if let Some(known) = solid.bounds() {
            let (min, max): ([f64; 3], [f64; 3]) = bounds;
            assert!(
                (0..3).all(|axis| known.min[axis] <= min[axis] && max[axis] <= known.max[axis]),
                "{name}"
            );
        }
        shapes.push(Shape { name, solid, side, volume, bounds });
    };
    let cube = |r: f64| ([-r; 3], [r; 3]);
    add(
        "cuboid",
        Csg::cuboid([-1.0, 0.25, -0.5], [1.5, 1.0, 0.7]).unwrap(),
        Some(2.5 * 0.75 * 1.2),
        ([-1.0, 0.25, -0.5], [1.5, 1.0, 0.7]),
        Box::new(|p| p.slab(0, -1.0, 1.5).min(p.slab(1, 0.25, 1.0)).min(p.slab(2, -0.5, 0.7))),
    );
    add(
        "ball",
        Csg::ball([0.5, -0.25, 0.1], 1.25).unwrap(),
        Some(4.0 / 3.0 * PI * 1.25f64.powi(3)),
        ([-0.75, -1.5, -1.15], [1.75, 1.0, 1.35]),
        Box::new(|p| {
            let squares = [0.5, -0.25, 0.1].iter().enumerate().map(|(i, &c)| pow(&p.beyond(i, c), 2));
            pow(&p.w.times(&1.25.into()), 2).minus(&sum(squares)).sign()
        }),
    );
    add(
        "ellipsoid",
        Csg::ellipsoid([0.0; 3], [1.0, 0.5, 2.0]).unwrap(),
        Some(4.0 / 3.0 * PI),
        ([-1.0, -0.5, -2.0], [1.0, 0.5, 2.0]),
        Box::new(|p| quadric_side(p, [-4.0, -16.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0])),
    );
    add(
        "cylinder",
        Csg::cylinder(1.1, -0.5, 2.0).unwrap(),
        Some(PI * 1.1 * 1.1 * 2.5),
        ([-1.1, -1.1, -0.5], [1.1, 1.1, 2.0]),
        Box::new(|p| {
            let radius = pow(&p.w.times(&1.1.into()), 2);
            let mantle = radius.minus(&pow(&p.at[0], 2)).minus(&pow(&p.at[1], 2)).sign();
            mantle.min(p.slab(2, -0.5, 2.0))
        }),
    );
    for (name, top) in [("frustum", 0.5), ("cone", 0.0)] {
        add(
            name,
            Csg::frustum(1.5, top, -1.0, 1.0).unwrap(),
            Some(PI * 2.0 / 3.0 * (2.25 + 1.5 * top + top * top)),
            ([-1.5, -1.5, -1.0], [1.5, 1.5, 1.0]),
            // 2 r = (top − 1.5) z + (top + 1.5).
            Box::new(move |p| {
                let r = p.at[2].times(&(top - 1.5).into()).plus(&p.w.times(&(top + 1.5).into()));
                let rho = pow(&p.at[0], 2).plus(&pow(&p.at[1], 2)).times(&4.0.into());
                pow(&r, 2).minus(&rho).sign().min(p.slab(2, -1.0, 1.0))
            }),
        );
    }
    for (name, from, to, radii) in [
        ("cylinder askew", [0.1, -0.7, 0.3], [0.9, 0.5, -1.1], [0.8, 0.8]),
        ("cylinder along x", [1.3, 0.25, -0.5], [-0.7, 0.25, -0.5], [0.6, 0.6]),
        ("frustum askew", [-0.3, 0.2, -1.0], [0.7, 1.1, 0.4], [1.25, 0.3]),
        ("cone askew", [0.6, 0.1, 0.0], [-0.4, 0.1, 0.75], [0.0, 0.7]),
        ("disc", [0.2, 0.3, 0.1], [0.3, 0.3, 0.35], [1.5, 1.0]),
    ] {
        let ([a, b], [r, s]) = ([from, to], radii);
        let d = [0, 1, 2].map(|i: usize| b[i] - a[i]);
        let square = d.iter().map(|d| d * d).sum::<f64>();
        let length = square.sqrt();
        // Ends are discs.
        let reach = |i: usize, radius: f64| radius * (square - d[i] * d[i]).max(0.0).sqrt() / length;
        let low = [0, 1, 2].map(|i| (a[i] - reach(i, r)).min(b[i] - reach(i, s)) + 1e-12);
        let high = [0, 1, 2].map(|i| (a[i] + reach(i, r)).max(b[i] + reach(i, s)) - 1e-12);
        add(
            name,
            Csg::frustum_between(from, to, radii).unwrap(),
            Some(PI * length / 3.0 * (r * r + r * s + s * s)),
            (low, high),
            // The distance from the axis is |(p − a) × d| / |d|, and the radius there is r + (s − r) (p − a)
            // · d / |d|².
            Box::new(move |p| {
                let d = [0, 1, 2].map(|i| Exact::from(b[i]).minus(&a[i].into()));
                let q = [0, 1, 2].map(|i| p.beyond(i, a[i]));
                let t = sum((0..3).map(|i| q[i].times(&d[i])));
                let square = sum(d.iter().map(|d| pow(d, 2)));
                let cross = |(i, j): (usize, usize)| q[i].times(&d[j]).minus(&q[j].times(&d[i]));
                let distance = sum([(0, 1), (1, 2), (2, 0)].map(|pair| pow(&cross(pair), 2)));
                let whole = p.w.times(&square);
                let radius = whole.times(&r.into()).plus(&Exact::from(s).minus(&r.into()).times(&t));
                let mantle = pow(&radius, 2).minus(&square.times(&distance)).sign();
                mantle.min(t.sign()).min(whole.minus(&t).sign())
            }),
        );
    }
    for (name, major, minor) in [("torus", 1.5, 0.4), ("horn torus", 0.75, 0.75), ("spindle torus", 0.5, 1.0)]
    {
        let outer = major + minor;
        add(
            name,
            Csg::torus(major, minor).unwrap(),
            (minor <= major).then_some(2.0 * PI * PI * major * minor * minor),
            ([-outer, -outer, -minor], [outer, outer, minor]),
            Box::new(move |p| torus_side(p, major, minor)),
        );
    }
    for (name, top) in [("wedge", 0.5), ("ridge", 0.0), ("spreading wedge", 2.75)] {
        let size = [2.0, 1.3, 0.9];
        add(
            name,
            Csg::wedge(size, top).unwrap(),
            Some((2.0 + top) / 2.0 * 1.3 * 0.9),
            ([0.0; 3], [top.max(2.0), 1.3, 0.9]),
            Box::new(move |p| {
                // 1.3 x ≤ 2.6 + (top − 2) y, the product of the doubles being taken exactly.
                let dy = Exact::from(size[1]);
                let slope = Exact::from(top).minus(&2.0.into());
                let slanted = p.w.times(&dy).times(&2.0.into()).plus(&slope.times(&p.at[1]));
                let slanted = slanted.minus(&dy.times(&p.at[0])).sign();
                let sides = p.slab(1, 0.0, size[1]).min(p.slab(2, 0.0, size[2]));
                sides.min(slanted).min(p.beyond(0, 0.0).sign())
            }),
        );
    }
    for (name, reversed) in [("prism", false), ("prism of a clockwise polygon", true)] {
        let mut corners = HOOK.to_vec();
        if reversed {
            corners.reverse();
        }
        add(
            name,
            Csg::prism(&corners, -0.5, 1.0).unwrap(),
            Some(polygon_area(&HOOK) * 1.5),
            ([-0.5, 0.0, -0.5], [3.0, 2.5, 1.0]),
            Box::new(|p| polygon_side(p, &HOOK).min(p.slab(2, -0.5, 1.0))),
        );
    }
    // An octahedron: |x| + |y| + |z| ≤ 1.
    let planes: Vec<([f64; 3], f64)> =
        (0..8).map(|k| ([0, 1, 2].map(|axis| if k >> axis & 1 == 0 { 1.0 } else { -1.0 }), 1.0)).collect();
    add(
        "convex polyhedron",
        Csg::convex(&planes).unwrap(),
        Some(4.0 / 3.0),
        cube(1.0),
        Box::new(move |p| planes.iter().map(|&(n, d)| p.plane(n, d)).min().unwrap()),
    );
    for (name, exponents) in [
        ("superball", [4, 4, 4]),
        ("cushion", [2, 4, 6]),
        ("almost a box", [64, 64, 64]),
        ("die", [8, 10, 2]),
    ] {
        let terms = exponents.map(|n| (-1.0, 0.0, n));
        add(
            name,
            HalfSpace::power(terms, 1.0).unwrap().into(),
            Some(superball_volume(exponents.map(f64::from))),
            cube(1.0),
            Box::new(move |p| power_side(p, terms, 1.0)),
        );
    }
    for (name, terms, constant) in [
        ("cubic", [(0.7, 0.1, 3), (-1.0, 0.3, 5), (0.4, -0.2, 2)], 0.05),
        ("wave", [(1.0, 0.0, 3), (0.0, 0.0, 1), (-1.0, 0.0, 1)], 0.0),
        ("saddle", [(1.0, 0.2, 4), (-1.0, 0.1, 4), (0.3, 0.0, 7)], -0.01),
        ("parabolic cylinder", [(1.0, 0.25, 2), (-1.0, 0.0, 1), (0.0, 0.0, 1)], 0.0),
        ("high and odd", [(-1.0, 0.0, 63), (1.0, 0.5, 2), (1.0, 0.0, 1)], 0.1),
    ] {
        let block = Csg::cuboid([-1.0; 3], [1.0; 3]).unwrap();
        let half_space = HalfSpace::power(terms, constant).unwrap();
        add(
            name,
            Csg::intersection_of([half_space.into(), block]).unwrap(),
            None,
            cube(1.0),
            Box::new(move |p| {
                let block = (0..3).map(|axis| p.slab(axis, -1.0, 1.0)).min().unwrap();
                power_side(p, terms, constant).min(block)
            }),
        );
    }
    shapes
}

/// Scaled, sheared and mirrored placements. Some take axes to axes, some have short numbers.
fn any_placement(random: &mut Random) -> Affine {
    loop {
        let (kind, length) = (random.below(4), random.below(4));
        let mut number = |reach: f64| {
            let x = random.between(-reach, reach);
            match length {
                0 => x,
                1 => (x * 4096.0).round() / 4096.0,
                _ => (x * 4.0).round() / 4.0,
            }
        };
        let mut rows = [0, 1, 2].map(|_| [number(1.5), number(1.5), number(1.5), number(3.0)]);
        if kind < 2 {
            let first = random.below(3) as usize;
            for (i, row) in rows.iter_mut().enumerate() {
                for j in 0..3 {
                    row[j] = if j == (i + first) % 3 { row[j] } else { 0.0 };
                }
            }
        }
        if determinant(&rows).abs() > 0.1 {
            return Affine::new(rows).unwrap();
        }
    }
}

fn determinant(m: &[[f64; 4]; 3]) -> f64 {
    (0..3)
        .map(|j| m[0][j] * (m[1][(j + 1) % 3] * m[2][(j + 2) % 3] - m[1][(j + 2) % 3] * m[2][(j + 1) % 3]))
        .sum()
}

/// A cube slightly larger than the image of a box. If it is `neat`, its lattice planes are short numbers.
fn frame_around((min, max): ([f64; 3], [f64; 3]), placement: &Affine, neat: bool, depth: u8) -> Frame {
    let corners: Vec<[f64; 3]> = (0..8)
        .map(|k| {
            placement.apply([0, 1, 2].map(|axis| if k >> axis & 1 == 0 { min[axis] } else { max[axis] }))
        })
        .collect();
    let end = |axis: usize, pick: fn(f64, f64) -> f64| corners.iter().map(|c| c[axis]).reduce(pick).unwrap();
    let low = [0, 1, 2].map(|axis| end(axis, f64::min));
    let extent = (0..3).map(|axis| end(axis, f64::max) - low[axis]).fold(0.0, f64::max);
    if neat {
        let edge = (extent + 0.5).log2().ceil().exp2();
        Frame::new(low.map(|x| (x * 4.0).floor() / 4.0 - 0.0), edge.max(1.0), depth).unwrap()
    } else {
        Frame::new(low.map(|x| x - 0.01 * extent), 1.02 * extent, depth).unwrap()
    }
}

fn built(solid: &Csg, frame: &Frame) -> Octree {
    build(solid, frame, Rule::Certified, &Control::threads(1)).unwrap()
}

/// Compares points of random cells (corners, middles and random ones) with the cells' tags.
fn check_points(
    shape: &Shape,
    placement: &Affine,
    frame: &Frame,
    points: u64,
    random: &mut Random,
) -> [u64; 3] {
    let tree = built(&shape.solid.placed(placement).unwrap(), frame);
    // On a frame of short numbers all points are doubles; otherwise they stay away from the cells' faces.
    let neat = frame.edge().log2().fract() == 0.0;
    let mut seen = [0; 3];
    for _ in 0..points {
        // Three of four points are near the shape.
        let mut cell = [0, 1, 2].map(|_| random.below(frame.cells() as u64) as f64);
        if random.below(4) > 0 {
            let (min, max) = shape.bounds;
            let near = placement.apply([0, 1, 2].map(|axis| random.between(min[axis], max[axis])));
            cell = [0, 1, 2].map(|axis| {
                let index = ((near[axis] - frame.origin()[axis]) / frame.cell_size()).floor();
                index.clamp(0.0, frame.cells() as f64 - 1.0)
            });
        }
        let at = |offset: [f64; 3]| {
            [0, 1, 2].map(|axis| frame.origin()[axis] + (cell[axis] + offset[axis]) * frame.cell_size())
        };
        let offset = [0, 1, 2].map(|_| match random.below(4) {
            0 if neat => 0.0,
            1 if neat => 1.0,
            2 => 0.5,
            _ => (random.below(1021) + 2) as f64 / 1024.0,
        });
        let tag = tree.contains(at([0.5; 3]));
        seen[tag as usize % 3] += 1;
        if tag == Membership::Undecided {
            continue;
        }
        let side = (shape.side)(&Point::before(placement, at(offset)));
        let wrong = match tag {
            Membership::Inside => side < 0,
            Membership::Outside => side > 0,
            _ => false,
        };
        assert!(!wrong, "{} {tag:?} {side} at {:?} of {placement:?} in {frame:?}", shape.name, at(offset));
    }
    seen
}

fn check_all_points(placements: u64, points: u64, seed: u64) {
    for shape in shapes() {
        let mut random = Random(seed);
        let mut seen = [0; 3];
        for i in 0..placements {
            let placement = if i == 0 { Affine::IDENTITY } else { any_placement(&mut random) };
            let depth = 3 + (i % 4) as u8;
            let frame = frame_around(shape.bounds, &placement, i % 2 == 0, depth);
            let found = check_points(&shape, &placement, &frame, points, &mut random);
            (0..3).for_each(|k| seen[k] += found[k]);
        }
        assert!(seen.iter().all(|&count| count > points / 20), "{} {seen:?}", shape.name);
    }
}

#[test]
fn points_never_contradict_cells() {
    check_all_points(repeated(8, 20), repeated(3_000, 5_000), 1);
}

#[test]
#[ignore = "takes minutes"]
fn points_never_contradict_cells_at_length() {
    check_all_points(100, 10_000, 2);
}

/// Along the axes, two points make the same solid as a cylinder or frustum around z moved there.
#[test]
fn two_points_along_an_axis_are_as_good_as_heights() {
    let frame = Frame::new([-2.0; 3], 4.0, 6).unwrap();
    for (r, s) in [(0.75, 0.75), (1.1, 0.3), (0.0, 1.0)] {
        let upright = Csg::frustum(r, s, -0.7, 1.2).unwrap();
        for axis in 0..3 {
            let (mut from, mut to) = ([0.25; 3], [0.25; 3]);
            (from[axis], to[axis]) = (-0.7, 1.2);
            let mut rows = [[0.0; 4]; 3];
            for (i, row) in rows.iter_mut().enumerate() {
                row[(i + 5 - axis) % 3] = 1.0;
                row[3] = if i == axis { 0.0 } else { 0.25 };
            }
            let placed = upright.placed(&Affine::new(rows).unwrap()).unwrap();
            let solid = Csg::frustum_between(from, to, [r, s]).unwrap();
            assert!(built(&solid, &frame) == built(&placed, &frame), "{axis} {r} {s}");
            let Bounds { min, max } = solid.bounds().unwrap();
            let wide = r.max(s);
            for i in 0..3 {
                let expected = if i == axis { (-0.7, 1.2) } else { (0.25 - wide, 0.25 + wide) };
                assert!((min[i] - expected.0).abs() < 1e-15 && (max[i] - expected.1).abs() < 1e-15);
            }
        }
    }
    let refused = |from, to, radii| Csg::frustum_between(from, to, radii).err();
    for (from, to, radii) in [
        ([0.5; 3], [0.5; 3], [1.0, 1.0]),
        ([0.0; 3], [1.0; 3], [0.0, 0.0]),
        ([0.0; 3], [1.0; 3], [-1.0, 1.0]),
        ([0.0; 3], [f64::NAN; 3], [1.0, 1.0]),
        ([f64::INFINITY; 3], [1.0; 3], [1.0, 1.0]),
    ] {
        assert!(
            matches!(refused(from, to, radii), Some(Error::Argument { .. })),
            "{from:?} {to:?} {radii:?}"
        );
    }
    // Numbers as far apart as possible.
    let (small, large) = (2f64.powi(-256), 2f64.powi(256));
    for (from, to) in [([0.0; 3], [small, 0.0, small]), ([-large; 3], [large, large, small])] {
        for radii in [[small, large], [large, large], [0.0, small]] {
            let solid = Csg::frustum_between(from, to, radii).unwrap();
            let Bounds { min, max } = solid.bounds().unwrap();
            assert!((0..3).all(|i| min[i] <= from[i].min(to[i]) && from[i].max(to[i]) <= max[i]));
        }
    }
}

#[test]
fn volumes_contain_the_truth_at_every_depth() {
    let mut random = Random(3);
    for shape in shapes() {
        let Some(volume) = shape.volume else { continue };
        for i in 0..6 {
            let placement = any_placement(&mut random);
            let truth = volume * determinant(placement.rows()).abs();
            let placed = shape.solid.placed(&placement).unwrap();
            let mut width = f64::INFINITY;
            for depth in 1..=6 {
                let frame = frame_around(shape.bounds, &placement, i % 2 == 0, depth);
                let found = built(&placed, &frame).statistics().volume();
                let slack = 1e-12 * truth;
                assert!(
                    found.lower <= truth + slack && truth - slack <= found.upper,
                    "{} {found:?} {truth} {placement:?} {frame:?}",
                    shape.name
                );
                assert!(found.width() <= width, "{} {found:?} {depth}", shape.name);
                width = found.width();
            }
            let extent = frame_around(shape.bounds, &placement, i % 2 == 0, 1).edge();
            assert!(width < 0.35 * extent.powi(3), "{} {width} {extent}", shape.name);
        }
    }
}

/// Returns the volume from cells at depth `depth` of [−2, 2]³.
fn volume_on_lattice(solid: impl Into<Csg>, depth: u8) -> Interval {
    built(&solid.into(), &Frame::new([-2.0; 3], 4.0, depth).unwrap()).statistics().volume()
}

#[test]
fn contact_decides() {
    let power = |terms, constant| HalfSpace::power(terms, constant).unwrap();
    let absent = (0.0, 0.0, 1);
    for n in 1..=64 {
        // x ≤ 1, or |x| ≤ 1: faces on the lattice.
        let exact = if n % 2 == 1 { 48.0 } else { 32.0 };
        for depth in 2..=4 {
            let slab = power([(-1.0, 0.0, n), absent, absent], 1.0);
            assert_eq!(volume_on_lattice(slab, depth), Interval::exactly(exact), "{n}");
            let doubled = power([absent, absent, (3.0, -1.0, n)], 0.0);
            let above = if n % 2 == 1 { 48.0 } else { 64.0 };
            assert_eq!(volume_on_lattice(doubled, depth), Interval::exactly(above), "{n}");
        }
        // A superball in [−1, 1]³ touches the cells around from inside.
        if n % 2 == 0 {
            let ball = power([(-1.0, 0.0, n); 3], 1.0);
            assert_eq!(volume_on_lattice(ball.clone(), 2).upper, 8.0, "{n}");
            let moved =
                Affine::new([[0.0, -1.0, 0.0, 1.0], [0.0, 0.0, 0.5, 0.5], [1.0, 0.0, 0.0, 1.0]]).unwrap();
            assert_eq!(volume_on_lattice(Csg::from(ball).placed(&moved).unwrap(), 3).upper, 4.0, "{n}");
        }
    }
    // A torus of radii 3/2 and 1/2 touches the planes z = ±1/2 and the cube's faces. A torus rotated by a
    // right angle does, too.
    let torus = Csg::torus(1.5, 0.5).unwrap();
    let turned = Affine::new([[0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 0.0]]).unwrap();
    let cells = [torus.clone(), torus.placed(&turned).unwrap()].map(|torus| volume_on_lattice(torus, 3));
    assert_eq!(cells[0], cells[1]);
    // The hole touches the circle of radius 1. Its 16 cells, out of 8 × 8 × 2, stay outside only where the
    // hole leaves out a whole cell.
    let truth = 2.0 * std::f64::consts::PI.powi(2) * 1.5 * 0.25;
    assert!(cells[0].upper <= 16.0 && cells[0].contains(truth), "{cells:?}");
    // Moved by less than doubles resolve, it reaches into the cells above.
    for (up, expected) in [(0.0, Membership::Outside), (2f64.powi(-60), Membership::Undecided)] {
        let moved = torus.placed(&Affine::translation([0.0, 0.0, up]).unwrap()).unwrap();
        let tree = built(&moved, &Frame::new([-2.0; 3], 4.0, 3).unwrap());
        assert_eq!(tree.contains([1.25, 0.75, 0.75]), expected, "{up}");
    }
    // The tip of a spindle, in the middle of a cell's face.
    for (down, expected) in [(0.0, Membership::Inside), (-2f64.powi(-60), Membership::Undecided)] {
        let moved = Affine::translation([0.5, 0.5, down]).unwrap();
        let spindle = Csg::torus(1.5, 2.5).unwrap().placed(&moved).unwrap();
        let tree = built(&spindle, &Frame::new([-4.0; 3], 8.0, 3).unwrap());
        assert_eq!(tree.contains([0.5, 0.5, 1.5]), expected, "{down}");
    }
    let spindle = volume_on_lattice(Csg::torus(0.5, 1.0).unwrap(), 3);
    assert!(spindle.lower > 0.0, "no hollow core: {spindle:?}");
    // The inner circle passes through (3, 4) and (5, 0) exactly.
    let wide = Csg::torus(10.0, 5.0).unwrap();
    let frame = Frame::new([-16.0; 3], 32.0, 5).unwrap();
    let tree = built(&wide, &frame);
    assert_eq!(tree.contains([3.5, 2.5, 0.5]), Membership::Outside, "a corner on the inner circle");
    assert_eq!(tree.contains([3.5, 4.5, 0.5]), Membership::Undecided);
}

#[test]
fn centres_on_the_surface() {
    // The cells' centres are whole numbers and a half.
    let frame = Frame::new([-4.0; 3], 8.0, 3).unwrap();
    let sampled = |solid: Csg| build(&solid, &frame, Rule::Sampled, &Control::threads(1)).unwrap();
    let power = |terms, constant| Csg::from(HalfSpace::power(terms, constant).unwrap());
    let absent = (0.0, 0.0, 1);
    // x³ ≥ ⅛ and its complement: the shift leads inside, out of the complement.
    let above = power([(1.0, 0.0, 3), absent, absent], -0.125);
    assert_eq!(sampled(above.clone()).contains([0.5, 0.5, 0.5]), Membership::Inside);
    assert_eq!(sampled(above.complement()).contains([0.5, 0.5, 0.5]), Membership::Outside);
    // x³ + y³ = 0 along x = −y: the first axis decides.
    let both = power([(1.0, 0.0, 3), (1.0, 0.0, 3), absent], 0.0);
    assert_eq!(sampled(both).contains([0.5, -0.5, 0.5]), Membership::Inside);
    // A torus whose outer and inner circles pass through centres in the plane z = ½.
    let up = Affine::translation([0.5; 3]).unwrap();
    let torus = sampled(Csg::torus(2.0, 1.0).unwrap().placed(&up).unwrap());
    for (x, expected) in [
        (1.5, Membership::Inside),
        (3.5, Membership::Outside),
        (-0.5, Membership::Outside),
        (-2.5, Membership::Inside),
    ] {
        assert_eq!(torus.contains([x, 0.5, 0.5]), expected, "{x}");
    }
    // The tip of a spindle: (ε, ε², ε³) leads out along x.
    let spindle = sampled(Csg::torus(1.5, 2.5).unwrap().placed(&up).unwrap());
    assert_eq!(spindle.contains([0.5, 0.5, 2.5]), Membership::Inside);
}

#[test]
fn a_quadratic_power_is_a_quadric() {
    let terms = [(-2.0, 0.5, 2), (1.5, -0.25, 2), (3.0, 0.75, 1)];
    let power = HalfSpace::power(terms, 0.125).unwrap();
    // −2 (x − ½)² + 1.5 (y + ¼)² + 3 (z − ¾) + ⅛.
    let quadric = [-2.0, 1.5, 0.0, 0.0, 0.0, 0.0, 2.0, 0.75, 3.0, -0.5 + 1.5 / 16.0 - 2.25 + 0.125];
    let quadric = HalfSpace::quadric(quadric).unwrap();
    for depth in [3, 5] {
        let (a, b) = (volume_on_lattice(power.clone(), depth), volume_on_lattice(quadric.clone(), depth));
        assert_eq!(a, b);
    }
    assert_eq!(Csg::from(power).fingerprint(), Csg::from(quadric).fingerprint());
}

#[test]
fn far_away_and_out_of_range() {
    let huge = 2f64.powi(250);
    // |x − c| ≤ 1 in a universe of edge 2^250 or 2^-250, or at a distance. Nothing is decided wrongly.
    for (origin, edge) in [
        ([-huge / 2.0; 3], huge),
        ([0.0; 3], 1.0 / huge),
        ([1e9; 3], 1.0),
        ([1.0 - 1.0 / 1024.0; 3], 1.0 / 512.0),
    ] {
        let frame = Frame::new(origin, edge, 6).unwrap();
        for shape in shapes() {
            let mut random = Random(5);
            check_points(&shape, &Affine::IDENTITY, &frame, 50, &mut random);
        }
    }
    let tiny =
        HalfSpace::power([(1.0 / huge, huge, 64), (huge, 0.0, 63), (1.0, 1.0 / huge, 3)], -huge).unwrap();
    let tree = built(&tiny.into(), &Frame::new([-1.0; 3], 2.0, 3).unwrap());
    assert_eq!(tree.statistics().volume(), Interval::exactly(8.0));
}

#[test]
fn bounds_of_convex_polyhedra() {
    let mut random = Random(11);
    let sum = |a: [f64; 3], b: [f64; 3]| (0..3).map(|axis| a[axis] * b[axis]).sum::<f64>();
    for i in 0..300 {
        // Planes that touch a ball, or pass it, around a centre; and their corners, found by trying all
        // triples.
        let centre = [0, 1, 2].map(|_| random.between(-10.0, 10.0));
        let planes: Vec<([f64; 3], f64)> = (0..4 + i % 10)
            .map(|_| {
                let normal = [0, 1, 2].map(|_| random.between(-1.0, 1.0));
                let length = sum(normal, normal).sqrt();
                (normal, random.between(0.5, 1.0) * length - sum(normal, centre))
            })
            .collect();
        let mut corners = Vec::new();
        for a in 0..planes.len() {
            for b in 0..a {
                for c in 0..b {
                    let n = [a, b, c].map(|k| planes[k].0);
                    let cross = |u: [f64; 3], v: [f64; 3]| {
                        [0, 1, 2].map(|i| u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3])
                    };
                    let volume = sum(n[0], cross(n[1], n[2]));
                    let parts = [cross(n[1], n[2]), cross(n[2], n[0]), cross(n[0], n[1])];
                    let offsets = [a, b, c].map(|k| planes[k].1);
                    let corner = [0, 1, 2]
                        .map(|axis| -(0..3).map(|k| parts[k][axis] * offsets[k]).sum::<f64>() / volume);
                    if planes.iter().all(|&(normal, offset)| sum(normal, corner) + offset > -1e-9) {
                        corners.push(corner);
                    }
                }
            }
        }
        // It is bounded if its cone of directions is empty.
        let bounds = Csg::convex(&planes).unwrap().bounds();
        let far = (0..2000).any(|_| {
            let direction = [0, 1, 2].map(|_| random.between(-1.0, 1.0));
            planes.iter().all(|&(normal, _)| sum(normal, direction) > 0.0)
        });
        assert!(!(far && bounds.is_some()), "{planes:?}");
        let Some(Bounds { min, max }) = bounds else { continue };
        for axis in 0..3 {
            let of = |pick: fn(f64, f64) -> f64| corners.iter().map(|c| c[axis]).reduce(pick).unwrap();
            let (low, high) = (of(f64::min), of(f64::max));
            let near = |a: f64, b: f64| (a - b).abs() < 1e-6 * (1.0 + b.abs());
            assert!(near(min[axis], low) && near(max[axis], high), "{min:?} {max:?} {low} {high} {planes:?}");
        }
    }
    // Exactly the box, for any length of the normals; and no cell beyond it.
    let unit = |axis: usize, c: f64| [0, 1, 2].map(|k| if k == axis { c } else { 0.0 });
    let planes: Vec<_> = (0..3).flat_map(|k| [(unit(k, 3.0), 0.75), (unit(k, -1e-9), 1e-9)]).collect();
    let cube = Csg::convex(&planes).unwrap();
    let Bounds { min, max } = cube.bounds().unwrap();
    assert!(min.iter().all(|&c| (-0.2500001..=-0.25).contains(&c)), "{min:?}");
    assert!(max.iter().all(|&c| (1.0..=1.0000001).contains(&c)), "{max:?}");
    let around = Frame::new([-2.0; 3], 4.0, 3).unwrap();
    assert_eq!(cube.on(&around, &Control::default()).unwrap().exterior(), leafless::Tag::Empty);
    // Unbounded, or empty.
    assert!(Csg::convex(&planes[..5]).unwrap().bounds().is_none());
    assert!(Csg::convex(&[(unit(0, 1.0), -1.0), (unit(0, -1.0), -1.0)]).unwrap().bounds().is_none());
}

#[test]
fn what_is_refused() {
    let refused = |result: Result<Csg, Error>, parameter: &str| match result {
        Err(Error::Argument { name, .. }) => assert_eq!(name, parameter),
        Err(other) => panic!("{parameter}: {other}"),
        Ok(_) => panic!("{parameter} is accepted"),
    };
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e-100] {
        refused(Csg::torus(1.0, bad), "minor");
        refused(Csg::wedge([1.0, bad, 1.0], 0.5), "size");
        refused(Csg::ball([0.0; 3], bad), "radius");
        if bad != 0.0 {
            refused(Csg::torus(bad, 1.0), "major");
            refused(Csg::wedge([1.0; 3], bad), "top");
        }
        if bad.abs() != 1.0 && bad != 0.0 {
            refused(Csg::prism(&square, bad, 1.0), "height");
            refused(Csg::convex(&[([0.0, bad, 0.0], 1.0)]), "normal");
            let power = |terms, constant| HalfSpace::power(terms, constant).map(Csg::from);
            refused(power([(bad, 0.0, 3); 3], 1.0), "terms");
            refused(power([(1.0, bad, 3); 3], 1.0), "terms");
            refused(power([(1.0, 0.0, 3); 3], bad), "constant");
        }
    }
    refused(Csg::prism(&square, 1.0, 1.0), "high");
    refused(Csg::prism(&square[..2], 0.0, 1.0), "polygon");
    refused(Csg::prism(&[square[0], square[2], square[1], square[3]], 0.0, 1.0), "polygon");
    refused(Csg::convex(&[]), "planes");
    refused(Csg::convex(&[([0.0; 3], 1.0)]), "normal");
    let power = |terms| HalfSpace::power(terms, 1.0).map(Csg::from);
    refused(power([(0.0, 0.0, 3); 3]), "terms");
    refused(power([(1.0, 0.0, 0); 3]), "terms");
    refused(power([(1.0, 0.0, 65); 3]), "terms");
    assert!(Csg::torus(0.0, 1.0).is_ok() && Csg::wedge([1.0; 3], 0.0).is_ok());
}

/// A ball of radius 1 as a host's functions, which count their calls.
fn host_ball(asked: &Arc<[AtomicUsize; 2]>) -> HalfSpace {
    let [values, ranges] = [asked.clone(), asked.clone()];
    HalfSpace::host(
        move |p| {
            values[0].fetch_add(1, Relaxed);
            Ok(1.0 - p.iter().map(|c| c * c).sum::<f64>())
        },
        move |min, max| {
            ranges[1].fetch_add(1, Relaxed);
            let (mut near, mut far) = (0.0, 0.0);
            for axis in 0..3 {
                let (a, b) = (min[axis].abs(), max[axis].abs());
                far += a.max(b).powi(2);
                near += if min[axis] <= 0.0 && max[axis] >= 0.0 { 0.0 } else { a.min(b).powi(2) };
            }
            // Dyadic boxes lose nothing; other boxes lose some last places.
            let error = if min.iter().chain(&max).all(|c| (c * 1024.0).fract() == 0.0) { 0.0 } else { 1e-12 };
            Ok(Interval::new(1.0 - far - error, 1.0 - near + error).unwrap())
        },
        Some(Fingerprint::of_bytes(b"ball of radius 1")),
    )
}

#[test]
fn a_host_half_space_is_as_good_as_its_functions() {
    let asked = Arc::new([AtomicUsize::new(0), AtomicUsize::new(0)]);
    let host = Csg::from(host_ball(&asked));
    let ball = Csg::ball([0.0; 3], 1.0).unwrap();
    let mut random = Random(7);
    for i in 0..20 {
        let placement = if i == 0 { Affine::IDENTITY } else { any_placement(&mut random) };
        let (placed, exact) = (host.placed(&placement).unwrap(), ball.placed(&placement).unwrap());
        let frame = frame_around(([-1.0; 3], [1.0; 3]), &placement, i % 2 == 0, 5);
        let (a, b) =
            (built(&placed, &frame).statistics().volume(), built(&exact, &frame).statistics().volume());
        let truth = 4.0 / 3.0 * PI * determinant(placement.rows()).abs();
        assert!(a.lower <= truth && truth <= a.upper, "{a:?} {truth}");
        if i == 0 {
            // Where the functions are exact, nothing is lost.
            assert_eq!(a, b);
            for rule in [Touch::Paper, Touch::Exact] {
                let (a, b) =
                    (built(&placed.with_touch(rule), &frame), built(&exact.with_touch(rule), &frame));
                assert_eq!(a.statistics().volume(), b.statistics().volume(), "{rule:?}");
            }
        }
        let sampled = |solid: &Csg| build(solid, &frame, Rule::Sampled, &Control::threads(1)).unwrap();
        let volume = sampled(&placed).statistics().volume();
        assert!((volume.lower - sampled(&exact).statistics().volume().lower).abs() < 0.01 * truth);
    }
    assert!(host.fingerprint().is_some());
    assert_ne!(host.fingerprint(), ball.fingerprint());
}

#[test]
fn a_host_is_asked_no_more_than_needed() {
    let points = Arc::new(Mutex::new(Vec::new()));
    let boxes = Arc::new(Mutex::new(Vec::new()));
    let (seen_points, seen_boxes) = (points.clone(), boxes.clone());
    let slope = HalfSpace::host(
        move |p| {
            seen_points.lock().unwrap().push(p);
            Ok(p[2] - 0.3)
        },
        move |min, max| {
            seen_boxes.lock().unwrap().push((min, max));
            Ok(Interval::new(min[2] - 0.3, max[2] - 0.3).unwrap())
        },
        None,
    );
    let solid = Csg::from(slope);
    let frame = Frame::new([0.0; 3], 1.0, 3).unwrap();
    let mut worker = solid.on(&frame, &Control::default()).unwrap().worker().unwrap();
    let Verdict::Partial(part) = worker.root().unwrap() else { panic!() };
    assert!(points.lock().unwrap().iter().flatten().all(|c| (0.0..=1.0).contains(c)), "beyond the universe");
    assert!(boxes.lock().unwrap().is_empty(), "the vertices have decided");
    let before = (points.lock().unwrap().len(), solid.evaluations());
    assert_eq!(before.1, before.0 as u64);
    worker.split(leafless::Cell::ROOT, &part).unwrap();
    drop(worker);
    let mut split: Vec<[u64; 3]> =
        points.lock().unwrap()[before.0..].iter().map(|p| p.map(f64::to_bits)).collect();
    let asked = split.len();
    assert_eq!(split[0], [0.5f64.to_bits(); 3], "the centre first");
    split.sort_unstable();
    split.dedup();
    assert_eq!(split.len(), asked, "a vertex twice");
    assert!(asked <= 27);
    let boxes = boxes.lock().unwrap();
    // Only the upper four: the lower four have vertices on both sides.
    assert_eq!(boxes.len(), 4);
    assert!(boxes.iter().all(|(min, _)| min[2] == 0.5));
    assert_eq!(solid.evaluations() - before.1, (asked + boxes.len()) as u64);
}

#[test]
fn a_host_that_fails_or_talks_nonsense() {
    let frame = Frame::new([-1.0; 3], 2.0, 3).unwrap();
    let control = Control::threads(1);
    let code = |solid: HalfSpace, rule| match build(&Csg::from(solid), &frame, rule, &control) {
        Err(Error::Callback { code }) => code,
        other => panic!("{:?}", other.map(|tree| tree.statistics().volume())),
    };
    let fail = |code| Err(Error::Callback { code });
    let wide = Interval::new(-1.0, 1.0).unwrap();
    for rule in [Rule::Certified, Rule::Sampled] {
        assert_eq!(code(HalfSpace::host(move |_| fail(3), move |_, _| Ok(wide), None), rule), 3);
        assert_eq!(
            code(HalfSpace::host(|_| Ok(1.0), |_, _| Err(Error::Callback { code: 4 }), None), rule),
            4
        );
    }
    // NaN, reversed bounds, and zero everywhere: nothing is decided.
    let nan = f64::NAN;
    for (value, lower, upper) in [
        (nan, -1.0, 1.0),
        (1.0, nan, nan),
        (1.0, 2.0, 1.0),
        (-1.0, nan, -1.0),
        (nan, 0.0, 0.0),
        (1.0, nan, 1.0),
    ] {
        // An invalid interval cannot be expressed. Then nothing is known.
        let range = Interval::new(lower, upper).unwrap_or(Interval::ALL);
        let solid = HalfSpace::host(move |_| Ok(value), move |_, _| Ok(range), None);
        let volume = build(&Csg::from(solid.clone()), &frame, Rule::Certified, &control)
            .unwrap()
            .statistics()
            .volume();
        assert_eq!(volume, Interval::new(0.0, 8.0).unwrap(), "{value} {lower} {upper}");
        let complement = Csg::from(solid.clone()).complement();
        let volume = build(&complement, &frame, Rule::Certified, &control).unwrap().statistics().volume();
        assert_eq!(volume, Interval::new(0.0, 8.0).unwrap());
        if value.is_nan() {
            let sampled = build(&Csg::from(solid), &frame, Rule::Sampled, &control);
            assert!(matches!(sampled, Err(Error::NotSampled)), "{value}");
        }
    }
}

#[test]
fn fingerprints_tell_expressions_apart() {
    let host = |fingerprint| Csg::from(HalfSpace::host(|_| Ok(0.0), |_, _| fail_never(), fingerprint));
    let torus = Csg::torus(2.0, 0.5).unwrap();
    let ball = Csg::ball([0.0; 3], 1.0).unwrap();
    let power = |n| Csg::from(HalfSpace::power([(-1.0, 0.0, n); 3], 1.0).unwrap());
    let both = |a: &Csg, b: &Csg| [a.clone(), b.clone()];
    let all = [
        torus.clone(),
        Csg::torus(2.0, 0.25).unwrap(),
        ball.clone(),
        power(4),
        power(6),
        Csg::empty(),
        Csg::everything(),
        torus.complement(),
        torus.with_touch(Touch::Paper),
        torus.placed(&Affine::translation([1.0, 0.0, 0.0]).unwrap()).unwrap(),
        torus.placed(&Affine::translation([0.0, 1.0, 0.0]).unwrap()).unwrap(),
        Csg::union_of(both(&torus, &ball)).unwrap(),
        Csg::union_of(both(&ball, &torus)).unwrap(),
        Csg::intersection_of(both(&torus, &ball)).unwrap(),
        Csg::xor_of(both(&torus, &ball)).unwrap(),
        torus.difference(&ball).unwrap(),
        host(Some(Fingerprint::of_bytes(b"a"))),
        host(Some(Fingerprint::of_bytes(b"b"))),
    ];
    for (i, a) in all.iter().enumerate() {
        let fingerprint = a.fingerprint().unwrap();
        assert!(all[..i].iter().all(|b| b.fingerprint() != Some(fingerprint)), "{i}");
    }
    assert_eq!(Csg::torus(2.0, 0.5).unwrap().fingerprint(), torus.fingerprint());
    assert!(host(None).fingerprint().is_none());
    assert!(Csg::union_of([host(None), ball]).unwrap().fingerprint().is_none());
    // A million deep.
    let deep = (0..1_000_000).fold(torus, |deep, _| deep.complement());
    assert!(deep.fingerprint().is_some());
}

fn fail_never() -> Result<Interval, Error> {
    Ok(Interval::new(-1.0, 1.0).unwrap())
}
