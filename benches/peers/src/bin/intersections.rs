//! The test of a mesh for self-intersections beside CGAL's.
//!
//! ```text
//! cargo run --release --manifest-path benches/peers/Cargo.toml --bin intersections -- mesh.stl cgal
//! ```
//!
//! `cgal` is the program made of `cgal.cpp`, see benches/README.md. One thread each, in turn, processor time. Each
//! search builds its own tree over the triangles.

use leafless::{Control, exchange};
use std::error::Error;
use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Stdio};

const ROUNDS: usize = 9;

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Processor time of this thread in milliseconds.
fn spent() -> f64 {
    // SAFETY: a plain struct, filled in by the system.
    unsafe {
        let mut time = std::mem::zeroed::<libc::timespec>();
        libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time);
        1e3 * time.tv_sec as f64 + 1e-6 * time.tv_nsec as f64
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("which mesh?")?;
    let peer = arguments.next().ok_or("which program?")?;
    let file = exchange::read_mesh(&std::fs::read(&path)?, &exchange::MeshOptions::default())?;
    let mesh = file.mesh.sewn()?;
    let mut child =
        Command::new(peer).arg(&path).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
    let mut ask = child.stdin.take().ok_or("no input")?;
    let mut answers = BufReader::new(child.stdout.take().ok_or("no output")?).lines();
    let (mut ours, mut theirs, mut counts) = (Vec::new(), Vec::new(), [0.0, 0.0]);
    for _ in 0..ROUNDS {
        writeln!(ask)?;
        let answer = answers.next().ok_or("no answer")??;
        let figures: Vec<f64> = answer.split(' ').map(str::parse).collect::<Result<_, _>>()?;
        theirs.push(figures[0]);
        let start = spent();
        let found = mesh.intersecting_pairs(0, &Control::threads(1))?;
        ours.push(spent() - start);
        counts = [found.count as f64, figures[1]];
    }
    drop(ask);
    child.wait()?;
    let (ours, theirs) = (median(ours), median(theirs));
    println!("milliseconds of processor time, medians of {ROUNDS}; pairs");
    println!("Leafless {ours:.1} {}; CGAL {theirs:.1} {}; ratio {:.2}", counts[0], counts[1], theirs / ours);
    Ok(())
}
