//! The plate of 80 × 60 × 10 with a bore of radius 5, meshed by fidget, for `benches/peers/surfaces.py`.
//!
//! ```text
//! plate DEPTH OUT.stl
//! ```
//!
//! Prints the seconds that its octree and its mesh take on one thread, and the number of triangles.

use fidget::context::Tree;
use fidget::shape::BoundShape;
use std::time::Instant;

/// Half the edge of fidget's cube in the plate's units. The cube reaches from -1 to 1 around the plate's
/// centre.
const HALF: f64 = 42.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let depth = arguments.next().ok_or("no depth")?.parse()?;
    let path = arguments.next().ok_or("no output")?;
    let (x, y, z) = Tree::axes();
    let square = |t: Tree| t.clone() * t;
    let half = |length: f64| (length / 2.0 / HALF) as f32;
    let block = (x.abs() - half(80.0)).max(y.abs() - half(60.0)).max(z.abs() - half(10.0));
    let bore = (square(x) + square(y)).sqrt() - half(10.0);
    let shape = BoundShape::try_from(fidget::jit::JitShape::from(block.max(-bore)))?;
    let start = Instant::now();
    let settings = fidget::mesh::Settings { depth, threads: None, ..Default::default() };
    let mut mesh = fidget::mesh::Octree::build(&shape, &settings).ok_or("cancelled")?.walk_dual();
    let seconds = start.elapsed().as_secs_f64();
    let middle = [40.0, 30.0, 5.0];
    for vertex in &mut mesh.vertices {
        for (k, middle) in middle.into_iter().enumerate() {
            vertex[k] = (f64::from(vertex[k]) * HALF + middle) as f32;
        }
    }
    mesh.write_stl(&mut std::fs::File::create(path)?)?;
    println!("{seconds} {}", mesh.triangles.len());
    Ok(())
}
