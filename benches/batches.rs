//! Points, rays and distances of a mesh in batches, the same as `peers/python_queries.py` queries from
//! Python. The difference is the cost of a Python call.
//!
//! ```text
//! cargo bench -p leafless-benches --bench batches -- MESH
//! ```
//!
//! Prints the median time of a call, and of a point in it, on all processors.

use leafless::exchange::{MeshOptions, open_mesh};
use leafless::query::{DistanceTo, Obstacle, distances};
use leafless::solid::Prepared;
use leafless::{
    AnySolid, Control, Error, FillRule, Frame, Membership, MeshSolid, Ray, Solid, cast_rays, contains,
};
use leafless_testkit::Random;
use std::hint::black_box;
use std::time::Instant;

const SIZES: [usize; 3] = [1, 1_000, 1_000_000];

/// Returns the median time of a call in seconds.
fn median(mut call: impl FnMut() -> Result<(), Error>) -> Result<f64, Error> {
    let mut times = Vec::new();
    while times.len() < 5 || times.iter().sum::<f64>() < 0.3 && times.len() < 2000 {
        let begin = Instant::now();
        call()?;
        times.push(begin.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    Ok(times[times.len() / 2])
}

fn main() -> Result<(), Error> {
    let Some(path) = std::env::args().skip(1).find(|argument| argument != "--bench") else {
        println!("give a mesh: cargo bench -p leafless-benches --bench batches -- MESH");
        return Ok(());
    };
    let mesh = open_mesh(&path, &MeshOptions::default())?.mesh.sewn()?;
    let solid = MeshSolid::new(mesh, FillRule::NonZero)?;
    let bounds = solid.bounds().expect("a mesh has bounds");
    let frame = Frame::fitted(bounds.min, bounds.max, 20)?;
    let solid = Prepared::new(AnySolid::new(solid));
    let mut random = Random(0);
    let mut within = |margin: f64| {
        [0, 1, 2].map(|axis| {
            let extent = bounds.max[axis] - bounds.min[axis];
            let x = bounds.min[axis] + ((1.0 + 2.0 * margin) * random.unit() - margin) * extent;
            f64::from(x as f32)
        })
    };
    let points: Vec<_> = (0..SIZES[2]).map(|_| within(0.1)).collect();
    let mut rays = Vec::new();
    for &from in &points {
        let to = within(0.0);
        let along = [0, 1, 2].map(|axis| to[axis] - from[axis]);
        let length = along.iter().map(|c| c * c).sum::<f64>().sqrt();
        rays.push(Ray::new(from, along.map(|c| f64::from((c / length) as f32)))?);
    }
    let control = Control::default();
    println!("{:<10}{:>24}{:>24}{:>24}", "", SIZES[0], SIZES[1], SIZES[2]);
    for question in ["contains", "rays", "distances"] {
        print!("{question:<10}");
        for size in SIZES {
            let taken = median(|| {
                match question {
                    "contains" => {
                        let mut answers = vec![Membership::Undecided; size];
                        contains(&solid, &frame, &points[..size], &mut answers, &control)?;
                        black_box(answers);
                    }
                    "rays" => {
                        black_box(cast_rays(&solid, &frame, &rays[..size], Obstacle::Full, &control)?);
                    }
                    _ => {
                        let tolerance = 1e-6 * frame.edge();
                        let to = DistanceTo::Boundary;
                        black_box(distances(&solid, &frame, &points[..size], to, tolerance, &control)?);
                    }
                }
                Ok(())
            })?;
            print!("{:>12.1} µs {:>8.0} ns", 1e6 * taken, 1e9 * taken / size as f64);
        }
        println!();
    }
    Ok(())
}
