//! A million rays and a million points on each of several models, answered without cells and compared with an
//! examination of every triangle:
//!
//!     LEAFLESS_MODELS=… cargo test --release --test meshes direct_heavy:: -- --ignored --nocapture
//!     --test-threads 1
//!
//! A ray's truth comes from the triangles that the ray may meet. Doubles with generous bounds find these
//! triangles and the time range of each. Between these ranges the winding number is constant, and exact
//! arithmetic returns it for a point in the middle.

use crate::oracle::{PointOracle, over};
use crate::shapes::{self, Soup};
use leafless::query::{Obstacle, RayHit, RaySpans, ray_spans};
use leafless::solid::Prepared;
use leafless::{
    AnySolid, FillRule, Frame, Interval, Membership, MeshSolid, Ray, TriangleMesh, cast_rays, contains,
    exchange,
};
use leafless_testkit::{Random, alone, model, on_all_processors};

type Point = [f64; 3];

const INFINITY: f64 = f64::INFINITY;

fn at(k: impl Fn(usize) -> f64) -> Point {
    [k(0), k(1), k(2)]
}

fn minus(p: Point, q: Point) -> Point {
    at(|k| p[k] - q[k])
}

fn dot(p: Point, q: Point) -> f64 {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}

fn cross(p: Point, q: Point) -> Point {
    at(|k| p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3])
}

fn length(p: Point) -> f64 {
    dot(p, p).sqrt()
}

/// A bounding-volume tree of triangles, split in halves: each node has a box and either two children or
/// triangles.
struct Boxes {
    low: Point,
    high: Point,
    parts: Option<Box<[Boxes; 2]>>,
    triangles: Vec<u32>,
}

/// A mesh with a search for all triangles that a ray may meet.
struct Oracle {
    corners: Vec<[Point; 3]>,
    boxes: Boxes,
    points: PointOracle,
    size: f64,
    /// A generous bound on the distance of the surface from the mesh.
    displacement: f64,
}

/// The time range in which a ray may meet a triangle.
#[derive(Clone, Copy)]
struct Meeting {
    from: f64,
    to: f64,
    triangle: u32,
}

impl Oracle {
    fn new(mesh: &TriangleMesh) -> Oracle {
        let corners: Vec<[Point; 3]> =
            mesh.triangles().iter().map(|t| t.map(|v| mesh.vertices()[v as usize])).collect();
        let boxes = Oracle::divided(&corners, (0..corners.len() as u32).collect());
        let size = corners.iter().flatten().flatten().fold(0.0, |most: f64, c| most.max(c.abs()));
        let displacement = 4.0 * mesh.displacement();
        Oracle { boxes, points: PointOracle::new(mesh), corners, size, displacement }
    }

    fn divided(corners: &[[Point; 3]], mut triangles: Vec<u32>) -> Boxes {
        let all = || triangles.iter().flat_map(|&t| corners[t as usize]);
        let low = at(|k| all().fold(INFINITY, |least, p| least.min(p[k])));
        let high = at(|k| all().fold(-INFINITY, |most, p| most.max(p[k])));
        if triangles.len() <= 4 {
            return Boxes { low, high, parts: None, triangles };
        }
        let axis = (0..3).max_by(|&a, &b| (high[a] - low[a]).total_cmp(&(high[b] - low[b]))).unwrap();
        let middle = |t: &u32| corners[*t as usize].iter().map(|p| p[axis]).sum::<f64>();
        triangles.sort_by(|a, b| middle(a).total_cmp(&middle(b)));
        let others = triangles.split_off(triangles.len() / 2);
        let parts = [triangles, others].map(|triangles| Oracle::divided(corners, triangles));
        Boxes { low, high, parts: Some(Box::new(parts)), triangles: Vec::new() }
    }

    /// Returns all triangles that a ray may meet, in order of time.
    fn meetings(&self, from: Point, way: Point) -> Vec<Meeting> {
        let mut found = Vec::new();
        // Rounding errors of positions in doubles.
        let far = from.iter().fold(self.size, |most, c| most.max(c.abs()));
        self.collect(&self.boxes, from, way, 1e-14 * far + self.displacement, &mut found);
        found.sort_by(|a, b| a.from.total_cmp(&b.from));
        found
    }

    fn collect(&self, boxes: &Boxes, from: Point, way: Point, off: f64, found: &mut Vec<Meeting>) {
        if stay(boxes.low, boxes.high, from, way, off).is_none() {
            return;
        }
        if let Some(parts) = &boxes.parts {
            parts.iter().for_each(|part| self.collect(part, from, way, off, found));
        }
        found.extend(boxes.triangles.iter().filter_map(|&t| self.meeting(t, from, way, off)));
    }

    /// Returns the time range in which a ray may meet a triangle.
    fn meeting(&self, triangle: u32, from: Point, way: Point, off: f64) -> Option<Meeting> {
        let corners = self.corners[triangle as usize];
        let [low, high] = [f64::min, f64::max]
            .map(|of: fn(f64, f64) -> f64| at(|k| of(corners[0][k], of(corners[1][k], corners[2][k]))));
        let (begin, end) = stay(low, high, from, way, off)?;
        let ends = corners.map(|p| minus(p, from));
        let reach = ends.iter().flatten().fold(0.0, |most: f64, c| most.max(c.abs()));
        let wrong = length(way) * reach * (1e-13 * reach + 2.0 * self.displacement);
        let sides = [0, 1, 2].map(|k| dot(way, cross(ends[k], ends[(k + 1) % 3])));
        if sides.iter().any(|&s| s > wrong) && sides.iter().any(|&s| s < -wrong) {
            return None;
        }
        let (u, v) = (minus(corners[1], corners[0]), minus(corners[2], corners[0]));
        let normal = cross(u, v);
        let (slope, height) = (dot(normal, way), dot(normal, ends[0]));
        let of_normal = length(u) * length(v);
        let lost = 1e-13 * of_normal;
        let (mut from, mut to) = (begin, end);
        // Otherwise it may be anywhere in the box.
        if slope.abs() > 1e3 * lost * length(way) {
            let t = height / slope;
            let away = lost * reach + self.displacement * of_normal;
            let error = (away + t.abs() * lost * length(way)) / (slope.abs() - lost * length(way));
            (from, to) = (from.max(t - error), to.min(t + error));
        }
        (from <= to).then_some(Meeting { from, to, triangle })
    }

    /// True if a point lies exactly in the plane of a triangle, and on the triangle up to rounding.
    fn is_on_surface(&self, p: Point) -> bool {
        self.corners.iter().any(|&corners| {
            let off = 1e-12 * self.size + self.displacement;
            let is_near = (0..3).all(|k| {
                let at = corners.map(|corner| corner[k]);
                at[0].min(at[1]).min(at[2]) - off <= p[k] && p[k] <= at[0].max(at[1]).max(at[2]) + off
            });
            let normal = cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
            let height = dot(normal, minus(p, corners[0])).abs();
            is_near && (over(corners, p) == 0 || height <= self.displacement * length(normal))
        })
    }

    fn normal(&self, triangle: u32) -> Point {
        let [a, b, c] = self.corners[triangle as usize];
        cross(minus(b, a), minus(c, a))
    }
}

/// Returns the time range in which a ray may be in a box.
fn stay(low: Point, high: Point, from: Point, way: Point, off: f64) -> Option<(f64, f64)> {
    let mut stay = (0.0, INFINITY);
    for k in 0..3 {
        let (low, high) = (low[k] - off, high[k] + off);
        if way[k] == 0.0 {
            if from[k] < low || from[k] > high {
                return None;
            }
            continue;
        }
        let [a, b] = [(low - from[k]) / way[k], (high - from[k]) / way[k]];
        stay = (f64::max(stay.0, a.min(b) * (1.0 - 1e-14)), f64::min(stay.1, a.max(b) * (1.0 + 1e-14)));
    }
    (stay.0 <= stay.1).then_some(stay)
}

fn encloses(fill: FillRule, winding: i32) -> bool {
    match fill {
        FillRule::NonZero => winding != 0,
        FillRule::EvenOdd => winding % 2 != 0,
        FillRule::Positive => winding > 0,
    }
}

fn vertex(random: &mut Random, mesh: &TriangleMesh) -> Point {
    mesh.vertices()[random.below(mesh.vertices().len() as u64) as usize]
}

fn facet(random: &mut Random, mesh: &TriangleMesh) -> [Point; 3] {
    let t = mesh.triangles()[random.below(mesh.triangles().len() as u64) as usize];
    t.map(|v| mesh.vertices()[v as usize])
}

fn around(random: &mut Random, mesh: &TriangleMesh, wide: f64) -> Point {
    let (low, high) = mesh.bounds();
    at_random(random, |random, k| {
        let half = 0.5 * (high[k] - low[k]) * wide;
        low[k].midpoint(high[k]) + random.between(-half, half)
    })
}

fn at_random(random: &mut Random, mut of: impl FnMut(&mut Random, usize) -> f64) -> Point {
    [0, 1, 2].map(|k| of(random, k))
}

/// A ray of one of twelve kinds: its origin and direction.
fn ray(random: &mut Random, mesh: &TriangleMesh, kind: usize) -> (Point, Point) {
    let [a, b, c] = facet(random, mesh);
    let from = around(random, mesh, 2.5);
    let size = 2.0 * length(minus(mesh.bounds().1, mesh.bounds().0));
    let axis = random.below(3) as usize;
    let along = at(|k| if k == axis { size * [1.0, -1.0][random.0 as usize & 1] } else { 0.0 });
    let middle = |p: Point, q: Point| at(|k| p[k].midpoint(q[k]));
    let (from, way) = match kind % 12 {
        // Through a vertex, and the middle of an edge.
        0 => (from, minus(a, from)),
        1 => (from, minus(middle(a, b), from)),
        // Along an edge, and in the plane of a facet.
        2 => (at(|k| a[k] - 2.0 * (b[k] - a[k])), minus(b, a)),
        3 => {
            let inner = at(|k| 0.25 * a[k] + 0.25 * b[k] + 0.5 * c[k]);
            (at(|k| inner[k] + 3.0 * (a[k] - c[k])), minus(c, a))
        }
        // Parallel to an axis through a vertex, and the middle of an edge.
        4 => (minus(a, along), along),
        5 => (minus(middle(b, c), along), along),
        // From a vertex, an edge, a facet.
        6 => (a, minus(from, a)),
        7 => (middle(b, c), minus(from, b)),
        8 => (at(|k| (a[k] + b[k] + c[k]) / 3.0), minus(from, a)),
        // From vertex to vertex, from far away, and any.
        9 => {
            let to = vertex(random, mesh);
            (a, minus(to, a))
        }
        10 => (at(|k| a[k] - 1e4 * (a[k] - from[k])), minus(a, from)),
        _ => (from, minus(around(random, mesh, 1.0), from)),
    };
    if way == [0.0; 3] { (from, [size, 0.0, 0.0]) } else { (from, way) }
}

fn point(random: &mut Random, mesh: &TriangleMesh, kind: usize) -> Point {
    let [a, b, c] = facet(random, mesh);
    let size = length(minus(mesh.bounds().1, mesh.bounds().0));
    match kind % 8 {
        0 => a,
        1 => at(|k| a[k].midpoint(b[k])),
        2 => at(|k| (a[k] + b[k] + c[k]) / 3.0),
        // In a plane of axes through a vertex, and on a line through it.
        3 => {
            let (mut p, axis) = (around(random, mesh, 1.0), random.below(3) as usize);
            p[axis] = a[axis];
            p
        }
        4 => {
            let (mut p, axis) = (a, random.below(3) as usize);
            p[axis] = around(random, mesh, 1.0)[axis];
            p
        }
        5 => {
            let off = size * 10f64.powf(random.between(-17.0, -3.0));
            at_random(random, |random, k| a[k] + off * random.between(-1.0, 1.0))
        }
        _ => around(random, mesh, 1.2),
    }
}

#[derive(Debug, Default, Clone, Copy)]
struct Counts {
    hits: u64,
    misses: u64,
    /// Number of rays that may or may not be stopped.
    undecided_hits: u64,
    stretches: u64,
    undecided_stretches: u64,
    /// Number of stretches too narrow to query a point in them.
    narrow: u64,
    points: u64,
    inside: u64,
    undecided_points: u64,
    on_surface: u64,
}

impl Counts {
    fn add(&mut self, other: &Counts) {
        self.hits += other.hits;
        self.misses += other.misses;
        self.undecided_hits += other.undecided_hits;
        self.stretches += other.stretches;
        self.undecided_stretches += other.undecided_stretches;
        self.narrow += other.narrow;
        self.points += other.points;
        self.inside += other.inside;
        self.undecided_points += other.undecided_points;
        self.on_surface += other.on_surface;
    }
}

struct Trial<'t> {
    name: &'t str,
    mesh: &'t TriangleMesh,
    oracle: Oracle,
    fill: FillRule,
    solid: Prepared,
    frame: Frame,
}

impl Trial<'_> {
    fn check_rays(&self, seed: u64, count: usize, counts: &mut Counts) {
        let mut random = Random(seed);
        let plain: Vec<(Point, Point)> = (0..count).map(|kind| ray(&mut random, self.mesh, kind)).collect();
        let (plain, rays): (Vec<_>, Vec<_>) = (plain.into_iter())
            .filter_map(|(from, way)| Some(((from, way), Ray::new(from, way).ok()?)))
            .unzip();
        let cast = |on| cast_rays(&self.solid, &self.frame, &rays, on, &alone()).unwrap();
        let (full, upper) = (cast(Obstacle::Full), cast(Obstacle::Upper));
        for (i, (plain, ray)) in plain.iter().zip(&rays).enumerate() {
            let spans = ray_spans(&self.solid, &self.frame, ray, &alone()).unwrap();
            self.check_ray(*plain, (&full[i], &upper[i]), &spans, counts);
        }
    }

    fn check_ray(
        &self,
        (from, way): (Point, Point),
        (full, upper): (&Option<RayHit>, &Option<RayHit>),
        spans: &RaySpans,
        counts: &mut Counts,
    ) {
        let told = || format!("{} {:?} {from:?} {way:?} {full:?} {upper:?} {spans:?}", self.name, self.fill);
        let meetings = self.oracle.meetings(from, way);
        let mut end = 0.0;
        let reach = from.iter().fold(self.oracle.size, |most, c| most.max(c.abs()));
        let fine = (1e-11 * reach + self.oracle.displacement) / length(way);
        let mut gaps: Vec<(f64, f64)> = Vec::new();
        for meeting in &meetings {
            if meeting.from > end {
                gaps.push((end, meeting.from));
            }
            end = f64::max(end, meeting.to);
        }
        gaps.push((end, end + 1.0 + reach / length(way)));
        let mut first = None;
        for &(a, b) in &gaps {
            let t = a.midpoint(b);
            if b - a < 4.0 * fine {
                counts.narrow += 1;
                continue;
            }
            let at = at(|k| from[k] + t * way[k]);
            if self.frame.cell_of(at).is_none() {
                continue;
            }
            let inside =
                encloses(self.fill, self.oracle.points.winding(at).expect("away from all triangles"));
            let has = |spans: &[Interval]| spans.iter().any(|span| span.contains(t));
            let (inner, outer) = (has(&spans.inner), has(&spans.outer));
            assert!(!inner || inside, "not inside: {t} {}", told());
            assert!(outer || !inside, "not outside: {t} {}", told());
            counts.stretches += 1;
            counts.undecided_stretches += u64::from(inner != outer);
            if inside && first.is_none() {
                first = Some((a, b));
            }
        }
        counts.undecided_hits += u64::from(upper.is_some() && full.is_none());
        counts.hits += u64::from(full.is_some());
        counts.misses += u64::from(upper.is_none());
        if let Some((a, b)) = first {
            let upper = upper.unwrap_or_else(|| panic!("missed: {a} {b} {}", told()));
            assert!(upper.t.lower <= a + fine, "late: {a} {b} {}", told());
            // Where the surface may lie beside the mesh, cells answer next to edges.
            assert!(full.is_some() || self.oracle.displacement > 0.0, "not met: {a} {b} {}", told());
            let is_late = |full: &RayHit| full.t.lower > a + fine || full.t.upper > b;
            let is_exact = self.oracle.displacement == 0.0;
            assert!(!is_exact || !full.as_ref().is_some_and(is_late), "late: {a} {b} {}", told());
        }
        let Some(hit) = full else { return };
        assert!(hit.t.upper.is_finite(), "{}", told());
        // A part of the solid begins there: a stretch inside, or a triangle that the ray may meet.
        let is_there =
            |&Meeting { from, to, .. }: &Meeting| from - fine <= hit.t.upper && hit.t.lower <= to + fine;
        let met: Vec<&Meeting> = meetings.iter().filter(|meeting| is_there(meeting)).collect();
        let begins_inside = first.is_some_and(|(a, b)| a <= hit.t.upper + fine && hit.t.lower <= b);
        assert!(begins_inside || !met.is_empty(), "nothing there: {}", told());
        if let Some(surface) = hit.surface {
            assert!(met.iter().any(|meeting| meeting.triangle == surface), "another triangle: {}", told());
            let normal = self.oracle.normal(surface);
            let turn = dot(normal, hit.normal) / length(normal);
            assert!(turn.abs() > 1.0 - 1e-6 || length(normal) < 1e-12 * reach * reach, "{turn} {}", told());
            if first.is_some_and(|(a, _)| a <= hit.t.upper + fine) {
                assert!(dot(hit.normal, way) < 1e-6 * length(way), "not outward: {}", told());
            }
        }
    }

    fn check_points(&self, seed: u64, count: usize, counts: &mut Counts) {
        let mut random = Random(seed);
        let points: Vec<Point> = (0..count).map(|kind| point(&mut random, self.mesh, kind)).collect();
        let mut answers = vec![Membership::Undecided; count];
        contains(&self.solid, &self.frame, &points, &mut answers, &alone()).unwrap();
        for (p, answer) in points.iter().zip(&answers) {
            let truth = self.oracle.points.winding(*p).map(|winding| encloses(self.fill, winding));
            counts.points += 1;
            counts.on_surface += u64::from(truth.is_none());
            counts.inside += u64::from(*answer == Membership::Inside);
            let wrong = match answer {
                Membership::Inside => truth == Some(false),
                Membership::Outside => truth == Some(true),
                Membership::Undecided => {
                    let is_off = truth.is_some() && !self.oracle.is_on_surface(*p);
                    counts.undecided_points += u64::from(is_off);
                    counts.on_surface += u64::from(!is_off && truth.is_some());
                    false
                }
            };
            // (The oracle does not see the surface in planes that its rays run in.)
            let is_right = !wrong || self.oracle.is_on_surface(*p);
            counts.on_surface += u64::from(wrong && is_right);
            assert!(is_right, "{} {:?} {p:?} {answer:?} {truth:?}", self.name, self.fill);
        }
    }
}

/// Bodies that overlap, nest and are inside out, with many triangles and with few.
fn soup(random: &mut Random) -> Soup {
    let mut soup = shapes::torus([0.1, 0.2, 0.3], 3.0, 1.0, 40, 24);
    soup.extend(shapes::torus([0.1, 0.2, 0.3], 3.0, 0.5, 40, 24));
    soup.extend(shapes::inside_out(shapes::torus([0.1, 0.2, 0.3], 3.0, 0.25, 20, 12)));
    soup.extend(shapes::inside_out(shapes::octahedron([3.0, 0.0, 0.0], 2.0)));
    soup.extend(shapes::block([-4.0, -1.0, -1.0], [4.0, 1.0, 1.0]));
    soup.extend(shapes::tetrahedra(random, 30, |random| [0; 3].map(|_| random.between(-4.0, 4.0))));
    soup.extend(shapes::tetrahedra(random, 30, |random| [0; 3].map(|_| random.below(5) as f64 * 2.0 - 4.0)));
    soup.extend(shapes::block([-4.0, -1.0, -1.0], [4.0, 1.0, 1.0]));
    soup
}

fn check(name: &str, mesh: &TriangleMesh, fill: FillRule, count: usize) {
    let (low, high) = mesh.bounds();
    let edge = 3.0 * (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    let frame = Frame::new(at(|k| low[k].midpoint(high[k]) - 0.5 * edge), edge, 8).unwrap();
    let solid = MeshSolid::new(mesh.try_clone().unwrap(), fill).unwrap();
    let solid = Prepared::new(AnySolid::new(solid));
    let trial = Trial { name, mesh, oracle: Oracle::new(mesh), fill, solid, frame };
    let share = count.min(10_000);
    let seeds: Vec<u64> = (0..count as u64 / share as u64).collect();
    let found = on_all_processors(&seeds, |&seed| {
        let mut counts = Counts::default();
        trial.check_rays(2 * seed, share, &mut counts);
        trial.check_points(2 * seed + 1, share, &mut counts);
        counts
    });
    let mut counts = Counts::default();
    found.iter().for_each(|found| counts.add(found));
    println!("{name}, {} triangles, {fill:?}: {counts:?}", mesh.triangles().len());
    assert!(counts.hits > count as u64 / 10 && counts.inside > count as u64 / 50);
    assert!(counts.undecided_hits * 20 < count as u64 && counts.undecided_points * 1000 < count as u64);
}

fn million(name: &str) {
    let Some(path) = model(name) else { return };
    let options = exchange::MeshOptions::default();
    let mesh = exchange::open_mesh(path, &options).unwrap().mesh.sewn().unwrap();
    mesh.check_closed(FillRule::NonZero).unwrap();
    check(name, &mesh, FillRule::NonZero, 1_000_000);
}

#[test]
#[ignore = "minutes"]
fn bunny() {
    million("bunny-closed.stl");
}

#[test]
#[ignore = "minutes"]
fn featuretype() {
    million("featuretype.STL");
}

#[test]
#[ignore = "minutes"]
fn rocker_arm() {
    million("rocker-arm.obj");
}

#[test]
#[ignore = "minutes"]
fn fandisk() {
    million("fandisk.obj");
}

#[test]
#[ignore = "minutes"]
fn spot() {
    million("spot.obj");
}

#[test]
#[ignore = "minutes"]
fn soups() {
    let mut random = Random(1);
    for fill in [FillRule::NonZero, FillRule::EvenOdd, FillRule::Positive] {
        let mesh = TriangleMesh::from_facets(soup(&mut random)).unwrap();
        check("soup", &mesh, fill, 300_000);
    }
}

/// The same with few rays and points, on generated meshes.
#[test]
fn few_rays_and_points_beside_each_triangle_by_itself() {
    let mut random = Random(2);
    for fill in [FillRule::NonZero, FillRule::EvenOdd, FillRule::Positive] {
        let mesh = TriangleMesh::from_facets(soup(&mut random)).unwrap();
        check("soup", &mesh, fill, 600);
    }
}
