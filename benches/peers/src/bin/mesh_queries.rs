//! Single queries of a triangle mesh by Embree and FCL, and by parry3d in single and double precision; see
//! benches/README.md. One thread, one call for each query.
//!
//! ```text
//! cargo run --release --manifest-path benches/peers/Cargo.toml --bin mesh_queries -- mesh.stl PROGRAM FOLDER [QUESTIONS [CHECKED]]
//! ```
//!
//! PROGRAM is built from `mesh_queries.cpp`. The mesh is sewn, and written for all peers to `sewn.stl` in
//! FOLDER. There are a million queries by default. Proofs of Leafless check the answers to the first CHECKED
//! queries (default 1000) and to queries on which peers disagree; for points, all answers.

use leafless::query::{DistanceTo, distances, ray_spans};
use leafless::solid::Prepared;
use leafless::{AnySolid, Control, Frame, Interval, Membership, Ray, TriangleMesh, contains, exchange};
use peers::{median, read, solid, spent};
use questions::{Line, points_within, rays_from_afar, rays_from_within, sum_of_bits};
use std::error::Error;
use std::path::Path;
use std::process::Command;

#[path = "../../../mesh_questions.rs"]
mod questions;

const ROUNDS: usize = 5;

/// The queries: two lists of rays, and points.
struct Questions {
    rays: [Vec<Line>; 2],
    points: Vec<[f32; 3]>,
}

/// The answers, one number for each query.
#[derive(Default)]
struct Answers {
    /// The times of the first hits of both lists of rays; negative for a miss.
    first: [Vec<f64>; 2],
    /// The total numbers of hits.
    all: Option<[Vec<f64>; 2]>,
    /// Distances from the surface.
    distances: Vec<f64>,
    /// Odd numbers for points inside.
    inside: Vec<f64>,
}

/// Prints the median time of a query in nanoseconds; returns the answers.
fn asked<Q>(name: &str, questions: &[Q], mut ask: impl FnMut(&Q) -> f64) -> Vec<f64> {
    let mut answers = vec![0.0; questions.len()];
    let round = |_| {
        let start = spent().0;
        for (question, answer) in questions.iter().zip(&mut answers) {
            *answer = ask(question);
        }
        spent().0 - start
    };
    let time = 1e6 * median((0..ROUNDS).map(round).collect()) / questions.len() as f64;
    let hits = answers.iter().filter(|&&answer| answer > 0.0);
    println!("{name:38} {time:10.1} ns  {:9}  {:.9}", hits.clone().count(), hits.sum::<f64>());
    answers
}

/// Queries parry3d, the same for both precisions.
macro_rules! parry {
    ($module:ident, $parry:ident, $real:ty) => {
        mod $module {
            use super::*;
            use $parry::math::Vector;
            use $parry::query::{PointQuery, Ray, RayCast};
            use $parry::shape::{TriMesh, TriMeshFlags};

            fn vector(v: [f32; 3]) -> Vector {
                Vector::new(v[0] as $real, v[1] as $real, v[2] as $real)
            }

            pub fn ask(mesh: &TriangleMesh, questions: &Questions) -> Result<Answers, Box<dyn Error>> {
                let name = stringify!($parry);
                let start = spent().0;
                let corner = |v: &[f64; 3]| Vector::new(v[0] as $real, v[1] as $real, v[2] as $real);
                let corners = mesh.vertices().iter().map(corner).collect();
                // With the normals of edges and corners that distinguish inside from outside.
                let mesh = TriMesh::with_flags(corners, mesh.triangles().to_vec(), TriMeshFlags::ORIENTED)?;
                println!("{:38} {:10.2} ms", format!("{name}, tree"), spent().0 - start);
                let ray = |list: &str, rays: &[Line]| {
                    asked(&format!("{name}, first hit, {list}"), rays, |&[from, along]| {
                        let ray = Ray::new(vector(from), vector(along));
                        mesh.cast_local_ray(&ray, <$real>::INFINITY, false).map_or(-1.0, |t| t as f64)
                    })
                };
                let first = [ray("from afar", &questions.rays[0]), ray("from within", &questions.rays[1])];
                let distances = asked(&format!("{name}, distance"), &questions.points, |&point| {
                    (mesh.distance_to_local_point(vector(point), false) as f64).abs()
                });
                let inside = asked(&format!("{name}, inside by normals"), &questions.points, |&point| {
                    mesh.contains_local_point(vector(point)) as u8 as f64
                });
                Ok(Answers { first, all: None, distances, inside })
            }
        }
    };
}

parry!(single, parry3d, f32);
parry!(double, parry3d_f64, f64);

/// Reads the output of the program built from `mesh_queries.cpp`.
fn written(path: &Path, count: usize) -> Result<Answers, Box<dyn Error>> {
    let bytes = std::fs::read(path)?;
    if bytes.len() != 8 * 6 * count {
        return Err("not as many answers as questions".into());
    }
    let (numbers, _) = bytes.as_chunks::<8>();
    let mut lists =
        numbers.chunks_exact(count).map(|list| list.iter().map(|&x| f64::from_ne_bytes(x)).collect());
    let mut next = || lists.next().ok_or("six lists");
    Ok(Answers {
        first: [next()?, next()?],
        all: Some([next()?, next()?]),
        distances: next()?,
        inside: next()?,
    })
}

/// Intervals in which a ray crosses the surface; `None` if part of the ray is undecided.
type Crossings = Option<Vec<[f64; 2]>>;

/// Proofs of Leafless for some of the queries, with the queries' indices.
struct Proven {
    crossings: [Vec<(usize, Crossings)>; 2],
    distances: Vec<(usize, [f64; 2])>,
    /// Answers for all points.
    inside: Vec<Membership>,
}

/// Proves answers. For rays and distances, only the queries at `places` are proven.
fn prove(
    mesh: &TriangleMesh,
    questions: &Questions,
    places: &[Vec<usize>; 3],
) -> Result<Proven, Box<dyn Error>> {
    let (min, max) = mesh.bounds();
    let (frame, control) = (Frame::around(min, max, 20)?, Control::threads(1));
    let solid = Prepared::new(AnySolid::new(solid(mesh)?));
    let crossings = |[from, along]: Line| -> Result<Crossings, leafless::Error> {
        let ray = Ray::new(from.map(f64::from), along.map(f64::from))?;
        let spans = ray_spans(&solid, &frame, &ray, &control)?;
        if spans.inner.len() != spans.outer.len() {
            return Ok(None);
        }
        let ends =
            |(outer, inner): (&Interval, &Interval)| [[outer.lower, inner.lower], [inner.upper, outer.upper]];
        let ends = spans.outer.iter().zip(&spans.inner).flat_map(ends);
        // A ray that begins inside only leaves.
        Ok(Some(ends.filter(|&[_, upper]| upper > 0.0).collect()))
    };
    let of_list = |list: usize| {
        let all = places[list].iter().map(|&i| Ok((i, crossings(questions.rays[list][i])?)));
        all.collect::<Result<_, leafless::Error>>()
    };
    let crossings = [of_list(0)?, of_list(1)?];
    let points: Vec<[f64; 3]> = questions.points.iter().map(|point| point.map(f64::from)).collect();
    let some: Vec<[f64; 3]> = places[2].iter().map(|&i| points[i]).collect();
    let found = distances(&solid, &frame, &some, DistanceTo::Boundary, 0.0, &control)?;
    let absolute = |distance: Interval| match distance.upper < 0.0 {
        true => [-distance.upper, -distance.lower],
        false => [distance.lower.max(0.0), distance.upper.max(-distance.lower)],
    };
    let distances = places[2].iter().zip(&found).map(|(&i, found)| (i, absolute(found.distance))).collect();
    let mut inside = vec![Membership::Undecided; points.len()];
    contains(&solid, &frame, &points, &mut inside, &control)?;
    Ok(Proven { crossings, distances, inside })
}

/// Prints the number of wrong answers, and the greatest error of numbers. A t with an error above `much`
/// belongs to another hit.
fn hold(name: &str, answers: &Answers, proven: &Proven, much: f64) {
    let off = |answer: f64, [lower, upper]: [f64; 2]| (lower - answer).max(answer - upper).max(0.0);
    for (list, from) in ["from afar", "from within"].into_iter().enumerate() {
        let (mut wrong, mut far, mut most, mut open, mut miscounted) = (0, 0, 0.0f64, 0, 0);
        for &(i, ref crossings) in &proven.crossings[list] {
            let Some(crossings) = crossings else {
                open += 1;
                continue;
            };
            let answer = answers.first[list][i];
            match crossings.first() {
                Some(&first) if off(answer, first) > much && answer >= 0.0 => far += 1,
                Some(&first) if answer >= 0.0 => most = most.max(off(answer, first)),
                first => wrong += (first.is_some() || answer >= 0.0) as usize,
            }
            miscounted +=
                answers.all.as_ref().is_some_and(|all| all[list][i] != crossings.len() as f64) as usize;
        }
        println!(
            "{name}, {} rays {from}: {wrong} hits missed or made up, {far} others than the first, t of the rest off by {most:.1e}, {miscounted} counts wrong; {open} undecided",
            proven.crossings[list].len()
        );
    }
    let most = proven.distances.iter().map(|&(i, distance)| off(answers.distances[i], distance));
    println!("{name}, {} distances: off by {:.1e}", proven.distances.len(), most.fold(0.0, f64::max));
    let pairs = || answers.inside.iter().zip(&proven.inside);
    let wrong = pairs().filter(|&(&answer, &proven)| {
        proven != Membership::Undecided && (answer % 2.0 == 1.0) != (proven == Membership::Inside)
    });
    let open = pairs().filter(|&(_, &proven)| proven == Membership::Undecided).count();
    println!("{name}, {} points: {} wrong; {open} undecided", proven.inside.len(), wrong.count());
}

/// Returns the indices of the first queries, and of queries on which the first peer and another peer differ
/// by more than `much`: for the two lists of rays, and for distances.
fn places(peers: &[(&str, Answers)], first: usize, much: f64) -> [Vec<usize>; 3] {
    let [(_, one), others @ ..] = peers else { return Default::default() };
    let list = |of: &dyn Fn(&Answers) -> &[f64], is_odd: &dyn Fn(usize) -> bool| {
        let differ = |i: usize| others.iter().any(|(_, other)| (of(one)[i] - of(other)[i]).abs() > much);
        (0..of(one).len()).filter(|&i| i < first || differ(i) || is_odd(i)).collect()
    };
    // No ray from outside crosses a closed surface an odd number of times.
    let is_odd = |i: usize| one.all.as_ref().is_some_and(|[afar, _]| afar[i] % 2.0 == 1.0);
    [
        list(&|answers| &answers.first[0], &is_odd),
        list(&|answers| &answers.first[1], &|_| false),
        list(&|answers| &answers.distances, &|_| false),
    ]
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let argument = |i: usize, what: &'static str| arguments.get(i).ok_or(what);
    let number = |i: usize, default| arguments.get(i).map_or(Ok(default), |count| count.parse());
    let mesh = read(argument(0, "which mesh?")?)?;
    let (program, folder) = (argument(1, "which program?")?, Path::new(argument(2, "which folder?")?));
    let (count, checked) = (number(3, 1_000_000)?, number(4, 1000)?);
    std::fs::create_dir_all(folder)?;
    let (sewn, written_to) = (folder.join("sewn.stl"), folder.join("answers"));
    std::fs::write(&sewn, exchange::write_stl(&mesh)?)?;
    let (min, max) = mesh.bounds();
    let questions = Questions {
        rays: [rays_from_afar(min, max, count), rays_from_within(min, max, count)],
        points: points_within(min, max, count),
    };
    let [afar, within] = questions.rays.each_ref().map(|rays| sum_of_bits(rays.iter().flatten().flatten()));
    println!("{count} questions: {afar} {within} {}", sum_of_bits(questions.points.iter().flatten()));
    if !Command::new(program).arg(&sewn).arg(count.to_string()).arg(&written_to).status()?.success() {
        return Err("the other program failed".into());
    }
    let peers = [
        ("Embree", written(&written_to, count)?),
        ("parry3d", single::ask(&mesh, &questions)?),
        ("parry3d-f64", double::ask(&mesh, &questions)?),
    ];
    let diagonal = [0, 1, 2].map(|axis| (max[axis] - min[axis]).powi(2)).iter().sum::<f64>().sqrt();
    let much = 1e-4 * diagonal;
    let proven = prove(&mesh, &questions, &places(&peers, checked, much))?;
    let widest = proven.distances.iter().map(|(_, [lower, upper])| upper - lower).fold(0.0, f64::max);
    println!("diagonal {diagonal:.2e}; distances are proven to {widest:.1e}");
    peers.iter().for_each(|(name, answers)| hold(name, answers, &proven, much));
    Ok(())
}
