//! The test of a mesh for self-intersections, compared with CGAL's.
//!
//! ```text
//! cargo run --release --manifest-path benches/peers/Cargo.toml --bin intersections -- mesh.stl cgal
//! ```
//!
//! `cgal` is built from `cgal.cpp`, see benches/README.md. One thread each, in turn, processor time. Each
//! search builds its own tree over the triangles.

use leafless::Control;
use peers::{Peer, median, read, spent};
use std::error::Error;
use std::process::Command;

const ROUNDS: usize = 9;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("which mesh?")?;
    let mesh = read(&path)?;
    let mut peer = Peer::start(Command::new(arguments.next().ok_or("which program?")?).arg(&path))?;
    let (mut ours, mut theirs, mut counts) = (Vec::new(), Vec::new(), [0.0, 0.0]);
    for _ in 0..ROUNDS {
        let figures = peer.ask("")?;
        theirs.push(figures[0]);
        let start = spent().0;
        let found = mesh.intersecting_pairs(0, &Control::threads(1))?;
        ours.push(spent().0 - start);
        counts = [found.count as f64, figures[1]];
    }
    peer.end()?;
    let (ours, theirs) = (median(ours), median(theirs));
    println!("milliseconds of processor time, medians of {ROUNDS}; pairs");
    println!("Leafless {ours:.1} {}; CGAL {theirs:.1} {}; ratio {:.2}", counts[0], counts[1], theirs / ours);
    Ok(())
}
