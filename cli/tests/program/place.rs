//! A folder in which the program runs, the result of a run, and small meshes.

// Each test program uses its own part of this.
#![allow(dead_code)]

use leafless::{TriangleMesh, exchange};
use serde_json::Value;
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fmt;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// A folder for one test, in which the program runs.
pub struct Place(pub tempfile::TempDir);

impl Place {
    pub fn new() -> Place {
        Place(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).unwrap();
    }

    /// Returns the names of all files, sorted. Temporary files would show.
    pub fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    pub fn command<S: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = S>) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_leafless"));
        command.args(arguments).current_dir(self.0.path()).stdin(Stdio::null());
        command
    }

    /// Returns the subcommands that the program's help lists.
    pub fn commands(&self) -> BTreeSet<String> {
        let help = self.run("--help").good();
        // A line of the lists is a name, two blanks or more, and a text.
        let names = help.text().lines().filter_map(|line| line.strip_prefix("  ")?.split_once("  "));
        let names = names.filter(|(name, _)| !name.is_empty() && !name.starts_with('-'));
        names.map(|(name, _)| name.to_owned()).collect()
    }

    /// Runs a command line. Blanks separate its words.
    pub fn run(&self, line: &str) -> Run {
        Run::new(line, self.command(line.split_whitespace()).output().unwrap())
    }

    pub fn run_with(&self, line: &str, input: &[u8]) -> Run {
        let mut command = self.command(line.split_whitespace());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut stdin = child.stdin.take().unwrap();
        let input = input.to_vec();
        // The program may stop reading before everything is written.
        let writer = std::thread::spawn(move || drop(stdin.write_all(&input)));
        let output = child.wait_with_output().unwrap();
        writer.join().unwrap();
        Run::new(line, output)
    }
}

/// Returns the messages without the progress lines that the program prints on a slow machine.
pub fn without_progress(errors: &str) -> String {
    errors.split_inclusive('\n').filter(|line| !line.contains(": at work for ")).collect()
}

/// The result of a run of the program.
pub struct Run {
    line: String,
    pub code: Option<i32>,
    pub bytes: Vec<u8>,
    pub errors: String,
}

impl fmt::Debug for Run {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let output = String::from_utf8_lossy(&self.bytes);
        write!(f, "{}: code {:?}\n{}{}", self.line, self.code, output, self.errors)
    }
}

impl Run {
    pub fn new(line: &str, output: Output) -> Run {
        Run {
            line: line.to_owned(),
            code: output.status.code(),
            bytes: output.stdout,
            errors: without_progress(&String::from_utf8(output.stderr).unwrap()),
        }
    }

    pub fn text(&self) -> &str {
        std::str::from_utf8(&self.bytes).unwrap()
    }

    /// Asserts success without output on standard error.
    #[track_caller]
    pub fn good(self) -> Run {
        assert!(self.code == Some(0) && self.errors.is_empty(), "{self:?}");
        self
    }

    /// Asserts success with one line on standard error, a note or a warning, which contains these words.
    #[track_caller]
    pub fn noted(self, words: &[&str]) -> Run {
        assert_eq!((self.code, self.errors.lines().count()), (Some(0), 1), "{self:?}");
        assert!(self.errors.contains(": note: ") || self.errors.contains(": warning: "), "{self:?}");
        for word in words {
            assert!(self.errors.contains(word), "{word:?} is not in {self:?}");
        }
        self
    }

    /// Asserts one line on standard error, which contains these words, and nothing on standard output.
    #[track_caller]
    pub fn bad(self, code: i32, words: &[&str]) {
        assert_eq!(self.code, Some(code), "{self:?}");
        assert!(self.errors.starts_with("leafless: ") && self.errors.ends_with('\n'), "{self:?}");
        assert_eq!(self.errors.lines().count(), 1, "{self:?}");
        for word in words {
            assert!(self.errors.contains(word), "{word:?} is not in {self:?}");
        }
        assert!(self.bytes.is_empty(), "{self:?}");
    }

    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_str(self.text()).unwrap_or_else(|error| panic!("{error}: {self:?}"))
    }
}

/// A box as a closed mesh of twelve triangles.
pub fn block(min: [f64; 3], max: [f64; 3]) -> TriangleMesh {
    let corners =
        (0..8).map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { min[axis] } else { max[axis] }));
    let sides: [[u32; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh::new(corners.collect(), triangles).unwrap()
}

pub fn stl(mesh: &TriangleMesh) -> Vec<u8> {
    exchange::write_stl(mesh).unwrap()
}

/// `cube.stl`, the cube [1, 3]³, and `slab.stl`, the box [2, 6] × [2, 6] × [0, 2].
pub fn meshes() -> Place {
    let place = Place::new();
    place.write("cube.stl", stl(&block([1.0; 3], [3.0; 3])));
    place.write("slab.stl", stl(&block([2.0, 2.0, 0.0], [6.0, 6.0, 2.0])));
    place
}

/// The same as solids in [0, 8]³ at depth 5. Their faces lie on planes of the lattice.
pub fn solids() -> Place {
    let place = meshes();
    for name in ["cube", "slab"] {
        place.run(&format!("voxelize {name}.stl -o {name}.lfl --depth 5 --bounds 0,0,0,8")).good();
    }
    place
}
