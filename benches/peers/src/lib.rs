//! Shared parts of the comparisons: medians, processor time, a peer that answers line by line, and cells for
//! its grid.

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

/// Returns the processor time of this thread in milliseconds, and its page faults.
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

/// Reads the mesh of a file, sewn.
pub fn read(path: &str) -> Result<TriangleMesh, Box<dyn Error>> {
    let file = exchange::read_mesh(&std::fs::read(path)?, &exchange::MeshOptions::default())?;
    Ok(file.mesh.sewn()?)
}

/// Returns a mesh as a solid, without anything computed in advance.
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

/// Another program. It answers each line of words with a line of numbers.
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

/// splitmix64: a number in [0, 1).
fn share(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^= z >> 31;
    (z >> 11) as f64 / (1u64 << 53) as f64
}

/// Returns rows of [R | t]: uniformly distributed rotations, and offsets of up to `reach` along each axis.
pub fn random_poses(count: usize, reach: [f64; 3]) -> Vec<[[f64; 4]; 3]> {
    let mut state = 1;
    let mut pose = || {
        let (q, square) = loop {
            let q = [0; 4].map(|_| 2.0 * share(&mut state) - 1.0);
            let square: f64 = q.iter().map(|c| c * c).sum();
            if (0.01..1.0).contains(&square) {
                break (q, square);
            }
        };
        let [w, x, y, z] = q.map(|c| c / square.sqrt());
        let turn = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ];
        [0, 1, 2].map(|i| {
            let [a, b, c] = turn[i];
            [a, b, c, reach[i] * (2.0 * share(&mut state) - 1.0)]
        })
    };
    (0..count).map(|_| pose()).collect()
}
