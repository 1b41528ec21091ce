//! What the comparisons share: medians, processor time, a peer that answers line by line, cells for its grid.

use leafless::octree::Cursor;
use leafless::{FillRule, MeshSolid, TriangleMesh, exchange};
use std::error::Error;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::Arc;

pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Processor time of this thread in milliseconds, and its page faults.
pub fn spent() -> (f64, f64) {
    // SAFETY: plain structs, filled in by the system.
    unsafe {
        let (mut time, mut usage) =
            (std::mem::zeroed::<libc::timespec>(), std::mem::zeroed::<libc::rusage>());
        libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time);
        libc::getrusage(libc::RUSAGE_THREAD, &mut usage);
        (1e3 * time.tv_sec as f64 + 1e-6 * time.tv_nsec as f64, usage.ru_minflt as f64)
    }
}

/// The mesh of a file, sewn.
pub fn read(path: &str) -> Result<TriangleMesh, Box<dyn Error>> {
    let file = exchange::read_mesh(&std::fs::read(path)?, &exchange::MeshOptions::default())?;
    Ok(file.mesh.sewn()?)
}

/// A mesh of which nothing is known yet, as a solid.
pub fn solid(mesh: &TriangleMesh) -> Result<MeshSolid, leafless::Error> {
    let mesh = TriangleMesh::new(mesh.vertices().into(), mesh.triangles().into())?;
    MeshSolid::new(Arc::new(mesh), FillRule::NonZero)
}

/// Writes the FULL cells below a cursor: x, y, z and edge of each, in cells.
pub fn write_full(cursor: &mut Cursor<'_>, depth: u8, out: &mut impl Write) -> std::io::Result<()> {
    let (cell, edge) = (cursor.cell(), 1i32 << (depth - cursor.cell().level));
    if cursor.tag() == leafless::Tag::Full {
        let [x, y, z] = cell.at.map(|i| i as i32 * edge);
        [x, y, z, edge].iter().try_for_each(|i| out.write_all(&i.to_ne_bytes()))?;
    }
    for octant in 0..8 {
        if cursor.descend(octant) {
            write_full(cursor, depth, out)?;
            cursor.ascend();
        }
    }
    Ok(())
}

/// Another program that answers a line of words with a line of numbers.
pub struct Peer {
    child: Child,
    ask: Option<ChildStdin>,
    answers: BufReader<ChildStdout>,
}

impl Peer {
    pub fn start(command: &mut Command) -> Result<Peer, Box<dyn Error>> {
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
        let ask = child.stdin.take();
        let answers = BufReader::new(child.stdout.take().ok_or("no output")?);
        Ok(Peer { child, ask, answers })
    }

    pub fn ask(&mut self, question: &str) -> Result<Vec<f64>, Box<dyn Error>> {
        writeln!(self.ask.as_mut().ok_or("no input")?, "{question}")?;
        let mut answer = String::new();
        self.answers.read_line(&mut answer)?;
        Ok(answer.split_whitespace().map(str::parse).collect::<Result<_, _>>()?)
    }

    pub fn end(mut self) -> std::io::Result<()> {
        self.ask = None;
        self.child.wait().map(drop)
    }
}
