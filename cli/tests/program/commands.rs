//! All commands on a file, and checks of how a run ends.

// Each test program uses its own part of this.
#![allow(dead_code)]

use crate::place::{Place, Run};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Time after which a hanging command is ended. (Commands take at most ten seconds on an idle machine.)
const PATIENCE: Duration = Duration::from_secs(100);

/// The commands that take a solid, `F`. Their input follows `<`. Commands that write a file write to `out`.
pub const COMMANDS: [&str; 53] = [
    "info F",
    "verify F",
    "dexelize F -o out.lfl --rule outer",
    "dexelize F -o out.lfl --rule inner --normals 32 --ends double",
    "convert F -o out.lfl --to dexels --resolve outer",
    "convert F -o out.lfl --to octree",
    "convert F -o out.lfl --to octree --resolve inner",
    "convert F -o out.stl --resolve outer",
    "union F F -o out.lfl",
    "intersection F F -o out.lfl",
    "difference F F -o out.lfl",
    "xor F F -o out.lfl",
    "complement F -o out.lfl",
    "contains F < 0.3 0.3 0.3",
    "distance F < 0.3 0.3 0.3",
    "distance F --signed --target boundary < 3 0.3 0.3",
    "neighbours F < 1 0 0 0",
    "neighbours F --smaller --through vertices < 1 0 0 0",
    "ray F < -1 0.3 0.3 1 0 0",
    "ray F < 0.3 0.4 0.3 0.1 0.2 1",
    "render F -o out.png --size 32x32 --edges",
    "render F -o out.png --size 32x32 --view slice",
    "render F -o out.png --size 32x32 --view volume",
    "render F -o out.png --size 32x32 --view hybrid",
    "heights F --axis z",
    "heights F --axis x --from below",
    "mesh F -o out.ply --resolve outer",
    "mesh F -o out.ply --resolve inner",
    "mesh F -o out.ply --resolve outer --method mc",
    "mesh F -o out.off --resolve outer --method smc",
    "mesh F -o out.ply --resolve outer --method shrink",
    "mesh F -o out.ply --resolve outer --method shrink-published",
    "mesh F -o out.ply --method dual",
    "mesh F -o out.ply --method faces --depth 8",
    "bitmap F -o out.nrrd --resolve outer",
    "bitmap F -o out.raw --resolve outer --level 1",
    "voxels F -o out.npz",
    "voxels F -o out.csv --outside",
    "voxels F -o out.npz --boundary touching --cells",
    "voxels F -o out.npz --boundary-depth 1",
    "voxels F -o out.npz --coarse 1e-6 --cells",
    "interfere F F",
    "deviation F F",
    "measure F",
    "measure F --cells --tolerance 1e-9",
    "within F --ball 0.3,0.3,0.3,0.2",
    "within F --in F",
    "attribute F -o out.lfl --name heat --expr x+2*y",
    "attribute F -o out.lfl --name one --constant 3",
    "sample F < 0.3 0.3 0.3",
    "summary F",
    "voxelize F -o out.lfl --depth 3",
    "layout F F*2 -o out.json --rounds 1 --cells 8 --tests 20 --splits 2000",
];

/// Runs the program with an address-space limit of twice what it is allowed, because the memory of threads
/// counts, too.
pub fn run(place: &Place, allowed: &str, line: &str, input: &[u8]) -> Run {
    let words: Vec<&str> = line.split_whitespace().collect();
    let mut command = if cfg!(target_os = "linux") {
        let mut shell = Command::new("sh");
        shell.args(["-c", "ulimit -v 2097152 && exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_leafless")]);
        shell
    } else {
        Command::new(env!("CARGO_BIN_EXE_leafless"))
    };
    command.args(words).args(["--max-memory", allowed]).current_dir(place.0.path());
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let start = Instant::now();
    let mut child = command.spawn().unwrap();
    // (The program may not read its input.)
    let _ = child.stdin.take().unwrap().write_all(input);
    let (sender, receiver) = std::sync::mpsc::channel();
    let id = child.id();
    let waiting = std::thread::spawn(move || {
        let output = child.wait_with_output();
        let _ = sender.send(());
        output
    });
    if receiver.recv_timeout(PATIENCE).is_err() {
        let _ = Command::new("kill").args(["-9", &id.to_string()]).status();
        panic!("{line}: no end after {:?}", start.elapsed());
    }
    if start.elapsed() > Duration::from_secs(10) {
        eprintln!("SLOW {line}: {:?}", start.elapsed());
    }
    Run::new(line, waiting.join().unwrap().unwrap())
}

/// Runs commands on a file. Each must end by itself, with success or with one sentence.
pub fn attempt(place: &Place, allowed: &str, path: &Path, commands: impl Iterator<Item = &'static str>) {
    for command in commands {
        let (line, input) = command.split_once('<').unwrap_or((command, ""));
        let line = line.replace(" F", &format!(" {}", path.display()));
        let done = run(place, allowed, &line, format!("{}\n", input.trim()).as_bytes());
        assert!(matches!(done.code, Some(0..=2)), "{done:?}");
        let is_error = |line: &&str| !line.contains("warning") && !line.contains(": note: ");
        let errors = done.errors.lines().filter(is_error).count();
        assert_eq!(errors, usize::from(done.code != Some(0)), "{done:?}");
        // The program itself kept the limit.
        let is_kept =
            !done.errors.contains("the system has no memory left") && !done.errors.contains("panicked");
        assert!(is_kept, "{done:?}");
    }
}

pub fn vectors() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../format_spec/vectors/valid");
    let entries = std::fs::read_dir(folder.canonicalize().unwrap()).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "lfl"));
    paths.sort();
    assert!(paths.len() > 50);
    paths
}
