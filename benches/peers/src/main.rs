//! The scene of `benches/csg.rs`, built by fidget and by Leafless, in turn, on one thread.
//!
//! ```text
//! cargo run --release --manifest-path benches/peers/Cargo.toml
//! ```
//!
//! fidget's octree also places the vertices of a mesh, so it does more than occupancy.

mod scene;

use fidget::context::Tree;
use fidget::shape::BoundShape;
use leafless::{Control, Frame, Rule, build};
use std::time::Instant;

/// The scene as a function that is negative inside.
fn function() -> Tree {
    let (x, y, z) = Tree::axes();
    let square = |t: Tree| t.clone() * t;
    let within = |t: &Tree| t.abs() - 0.2;
    let mut shape = (square(x.clone()) + square(y.clone()) + square(z.clone())).sqrt() - 0.9;
    let cut = |shape: Tree, tool: Tree| shape.max(-tool);
    for (a, b) in [(&x, &y), (&y, &z), (&x, &z)] {
        shape = cut(shape, within(a).max(within(b)));
    }
    for (cx, cy) in scene::along_z() {
        let (cx, cy) = (cx as f32, cy as f32);
        let distance = (square(x.clone() - cx) + square(y.clone() - cy)).sqrt();
        shape = cut(shape, distance - 0.1);
    }
    for (cz, cy) in scene::along_x() {
        let (cz, cy) = (cz as f32, cy as f32);
        let distance = (square(z.clone() - cz) + square(y.clone() - cy)).sqrt();
        shape = cut(shape, distance - 0.08);
    }
    shape
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let solid = scene::solid()?;
    let peer = BoundShape::try_from(fidget::jit::JitShape::from(function()))?;
    let control = Control::threads(1);
    println!("depth  fidget ms  sampled ms  ratio  certified ms  ratio");
    for depth in [7u8, 8, 9] {
        let frame = Frame::new([-1.0; 3], 2.0, depth)?;
        let mut times = [Vec::new(), Vec::new(), Vec::new()];
        for _ in 0..if depth < 9 { 5 } else { 3 } {
            let start = Instant::now();
            let settings = fidget::mesh::Settings { depth, threads: None, ..Default::default() };
            let tree = fidget::mesh::Octree::build(&peer, &settings);
            times[0].push(start.elapsed().as_secs_f64());
            drop(tree);
            for (rule, times) in [Rule::Sampled, Rule::Certified].into_iter().zip(&mut times[1..]) {
                let start = Instant::now();
                let tree = build(&solid, &frame, rule, &control)?;
                times.push(start.elapsed().as_secs_f64());
                drop(tree);
            }
        }
        let [fidget, sampled, certified] = times.map(|times| 1e3 * median(times));
        println!(
            "{depth:5}  {fidget:9.1}  {sampled:10.2}  {:5.1}  {certified:12.2}  {:5.1}",
            fidget / sampled,
            fidget / certified
        );
    }
    Ok(())
}
