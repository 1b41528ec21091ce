//! Single queries of a mesh's solid without an octree: rays, distances and points, one by one and in a batch.
//! On one thread, processor time, medians of five rounds.
//!
//! ```text
//! LEAFLESS_MODELS=/path/to/models cargo bench --bench mesh_queries -- [QUESTIONS [TIMES]]
//! ```
//!
//! There are 1000 queries of each kind by default. Each triangle is divided in four TIMES times beforehand
//! (default 0). The frame has depth 20. `peers/mesh_queries.cpp`, `.py` and `peers/src/bin/mesh_queries.rs`
//! send the same queries to other programs, `peers/mesh_queries.c` sends them through the C interface; see
//! `benches/README.md`.

use leafless::query::{
    DistanceTo, Obstacle, PointDistance, RayHit, StopReason, cast_rays, contains, distances, ray_spans,
};
use leafless::solid::Prepared;
use leafless::{
    AnySolid, Control, FillRule, Frame, Membership, MeshSolid, Ray, Solid, TriangleMesh, exchange,
};
use mesh_questions::{points_within, rays_from_afar, rays_from_within, sum_of_bits};
use rustix::time::{ClockId, clock_gettime};
use std::path::Path;
use std::sync::Arc;

mod mesh_questions;

const DEPTH: u8 = 20;
const ROUNDS: usize = 5;
/// Allowed width of a distance's interval, as a fraction of the bounding box's diagonal.
const TOLERANCE: f64 = 1e-9;

/// Returns the processor time in nanoseconds.
fn now() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 * 1e9 + time.tv_nsec as f64
}

/// Sums over all answers.
#[derive(Debug, Default, Clone, Copy, PartialEq)]
struct Sums {
    /// Number of hits, or of points inside.
    count: usize,
    /// Sum of the middles of intervals with two ends.
    sum: f64,
    /// Number of undecided answers, and of answers wider than the tolerance.
    undecided: usize,
    /// Width of the widest interval with two ends.
    widest: f64,
}

impl Sums {
    fn add(&mut self, interval: leafless::Interval, middle: impl Fn(f64) -> f64) {
        self.sum += middle(0.5 * (interval.lower + interval.upper));
        self.widest = self.widest.max(interval.upper - interval.lower);
    }

    fn hit(&mut self, hit: Option<RayHit>) {
        let Some(hit) = hit else { return };
        if hit.t.upper == f64::INFINITY {
            self.undecided += 1;
        } else {
            self.count += 1;
            self.add(hit.t, |t| t);
        }
    }

    fn point(&mut self, answer: Membership) {
        self.count += (answer == Membership::Inside) as usize;
        self.undecided += (answer == Membership::Undecided) as usize;
    }

    fn distance(&mut self, answer: &PointDistance) {
        self.undecided += (answer.stop_reason != StopReason::Tolerance) as usize;
        self.add(answer.distance, f64::abs);
    }
}

/// Prints the median time of a query.
fn asked(name: &str, count: usize, mut all: impl FnMut() -> Sums) {
    let mut times = [0.0; ROUNDS];
    let mut sums = Sums::default();
    for time in &mut times {
        let start = now();
        sums = all();
        *time = now() - start;
    }
    times.sort_unstable_by(f64::total_cmp);
    println!(
        "{name:<38} {:12.1} ns  {:9}  {:.9}  {} undecided, widest {:.1e}",
        times[ROUNDS / 2] / count as f64,
        sums.count,
        sums.sum,
        sums.undecided,
        sums.widest
    );
}

fn ask(name: &str, solid: &Prepared, frame: &Frame, [min, max]: [[f64; 3]; 2], count: usize) {
    let control = Control::threads(1);
    let start = now();
    solid.on(frame, &control).expect("a frame");
    println!("{:<38} {:12.2} ms", "prepared", 1e-6 * (now() - start));

    let bytes = solid.kept_bytes();
    let start = now();
    let first = Ray::new(min, [0, 1, 2].map(|axis| max[axis] - min[axis])).expect("a ray");
    cast_rays(solid, frame, &[first], Obstacle::Upper, &control).expect("answers");
    let tree = 1e-6 * (now() - start);
    println!(
        "{:<38} {tree:12.2} ms, {} bytes beside {bytes}",
        "a first ray: the tree",
        solid.kept_bytes() - bytes
    );
    let (bytes, start) = (solid.kept_bytes(), now());
    distances(solid, frame, &[min], DistanceTo::Boundary, 1.0, &control).expect("answers");
    let sides = 1e-6 * (now() - start);
    println!("{:<38} {sides:12.2} ms, {} bytes more", "a first distance: sides", solid.kept_bytes() - bytes);

    let lists =
        [("from afar", rays_from_afar(min, max, count)), ("from within", rays_from_within(min, max, count))];
    let points = points_within(min, max, count);
    let [afar, within] = lists.each_ref().map(|(_, rays)| sum_of_bits(rays.iter().flatten().flatten()));
    println!("{name}: {count} questions: {afar} {within} {}", sum_of_bits(points.iter().flatten()));

    let on = Obstacle::Upper;
    for (from, rays) in lists {
        let ray = |[from, along]: [[f32; 3]; 2]| Ray::new(from.map(f64::from), along.map(f64::from));
        let rays: Vec<Ray> = rays.into_iter().map(|line| ray(line).expect("a ray")).collect();
        let cast = |rays: &[Ray], sums: &mut Sums| {
            let hits = cast_rays(solid, frame, rays, on, &control).expect("answers");
            hits.into_iter().for_each(|hit| sums.hit(hit));
        };
        asked(&format!("rays {from}, one by one"), count, || {
            let mut sums = Sums::default();
            rays.chunks(1).for_each(|ray| cast(ray, &mut sums));
            sums
        });
        asked(&format!("rays {from}, in a batch"), count, || {
            let mut sums = Sums::default();
            cast(&rays, &mut sums);
            sums
        });
        asked(&format!("all of a ray {from}, one by one"), count, || {
            let mut sums = Sums::default();
            for ray in &rays {
                let spans = ray_spans(solid, frame, ray, &control).expect("an answer");
                // A ray that begins inside crosses the surface only once.
                let ends = |span: &leafless::Interval| (span.lower > 0.0) as usize + 1;
                sums.count += spans.outer.iter().map(ends).sum::<usize>();
                sums.undecided += (spans.outer.len() != spans.inner.len()) as usize;
            }
            sums
        });
    }

    let points: Vec<[f64; 3]> = points.into_iter().map(|point| point.map(f64::from)).collect();
    let tolerance =
        TOLERANCE * [0, 1, 2].map(|axis| (max[axis] - min[axis]).powi(2)).iter().sum::<f64>().sqrt();
    let far = |points: &[[f64; 3]], sums: &mut Sums| {
        let found = distances(solid, frame, points, DistanceTo::Boundary, tolerance, &control);
        found.expect("answers").iter().for_each(|answer| sums.distance(answer));
    };
    asked("distances, one by one", count, || {
        let mut sums = Sums::default();
        points.chunks(1).for_each(|point| far(point, &mut sums));
        sums
    });
    asked("distances, in a batch", count, || {
        let mut sums = Sums::default();
        far(&points, &mut sums);
        sums
    });

    let mut answers = vec![Membership::Undecided; count];
    asked("points, one by one", count, || {
        let mut sums = Sums::default();
        for point in points.chunks(1) {
            contains(solid, frame, point, &mut answers[..1], &control).expect("an answer");
            sums.point(answers[0]);
        }
        sums
    });
    asked("points, in a batch", count, || {
        contains(solid, frame, &points, &mut answers, &control).expect("answers");
        let mut sums = Sums::default();
        answers.iter().for_each(|&answer| sums.point(answer));
        sums
    });
}

/// Returns the mesh with each triangle divided in four.
fn finer(mesh: &TriangleMesh) -> TriangleMesh {
    let facets = mesh.triangles().iter().flat_map(|triangle| {
        let [a, b, c] = triangle.map(|vertex| mesh.vertices()[vertex as usize]);
        let middle = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|axis| 0.5 * p[axis] + 0.5 * q[axis]);
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    });
    TriangleMesh::from_facets(facets).expect("a mesh")
}

fn main() {
    let mut arguments = std::env::args().skip(1).filter(|argument| !argument.starts_with('-'));
    let count = arguments.next().map_or(1000, |count| count.parse().expect("a number of questions"));
    let times: usize = arguments.next().map_or(0, |times| times.parse().expect("a number of divisions"));
    let Some(folder) = std::env::var_os("LEAFLESS_MODELS") else {
        eprintln!("SKIPPED: LEAFLESS_MODELS is not set");
        return;
    };
    for name in ["bunny-closed.stl", "featuretype.STL", "stanford-bunny.obj"] {
        let bytes = std::fs::read(Path::new(&folder).join(name)).expect(name);
        let file = exchange::read_mesh(&bytes, &exchange::MeshOptions::default()).expect("a mesh");
        let mesh = (0..times).fold(file.mesh.sewn().expect("a mesh"), |mesh, _| finer(&mesh));
        let mesh = Arc::new(mesh);
        println!("{name}: {} triangles", mesh.triangles().len());
        let (min, max) = mesh.bounds();
        let frame = Frame::around(min, max, DEPTH).expect("a mesh");
        let solid = MeshSolid::new(mesh, FillRule::NonZero).expect("a mesh");
        ask(name, &Prepared::new(AnySolid::new(solid)), &frame, [min, max], count);
    }
}
