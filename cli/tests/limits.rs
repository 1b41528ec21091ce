//! Small inputs do not take everything: every command ends soon, within the memory that it is given, or refuses at once
//! and says what it would take.

mod place;

use leafless::{
    Cell, Classifier, Control, Error, Frame, Octree, Rule, Solid, Tag, Verdict, Worker, build, file,
};
use place::{Place, Run};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// What every command is allowed, and what some are that take longer for it.
const ALLOWED: &str = "1G";
const LITTLE: &str = "160M";
/// What ends a command that hangs. (They take ten seconds at most on a machine with nothing else to do.)
const PATIENCE: Duration = Duration::from_secs(100);

/// The commands that take a solid, `F`, with what they read behind `<`; those that write, to `out`.
const COMMANDS: [&str; 49] = [
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
    "mesh F -o out.off --resolve outer --method smc",
    "mesh F -o out.ply --resolve outer --method shrink",
    "mesh F -o out.ply --resolve outer --method shrink-published",
    "mesh F -o out.ply --method dual",
    "bitmap F -o out.nrrd --resolve outer",
    "bitmap F -o out.raw --resolve outer --level 1",
    "voxels F -o out.npz",
    "voxels F -o out.csv --outside",
    "voxels F -o out.npz --boundary touching --cells",
    "voxels F -o out.npz --boundary-depth 1",
    "voxels F -o out.npz --coarse 1e-6 --cells",
    "interfere F F",
    "measure F",
    "measure F --cells --tolerance 1e-9",
    "within F --ball 0.3,0.3,0.3,0.2",
    "within F --in F",
    "attribute F -o out.lfl --name heat --expr x+2*y",
    "attribute F -o out.lfl --name one --constant 3",
    "sample F < 0.3 0.3 0.3",
    "summary F",
    "voxelize F -o out.lfl --depth 3",
];

/// A universe that is one cell, or that has one finest cell, of a tag.
#[derive(Clone)]
struct One {
    frame: Frame,
    tag: Tag,
    is_finest: bool,
}

impl Solid for One {
    type Classifier = One;

    fn on(&self, frame: &Frame, _: &Control<'_>) -> Result<One, Error> {
        Ok(One { frame: *frame, ..*self })
    }
}

impl Classifier for One {
    type Worker = One;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<One, Error> {
        Ok(self.clone())
    }

    fn exterior(&self) -> Tag {
        Tag::Empty
    }

    fn proof(&self) -> leafless::Proof {
        leafless::Proof::CERTIFIED
    }
}

impl One {
    /// The finest cell lies beside the middle of the universe.
    fn verdict(&self, cell: Cell) -> Verdict<()> {
        let depth = self.frame.depth();
        let at = [(1u32 << (depth - 1)) - 1; 3];
        let holds = cell.at.iter().zip(at).all(|(&own, at)| own == at >> (depth - cell.level));
        match self.tag {
            _ if self.is_finest && holds && cell.level < depth => Verdict::Partial(()),
            _ if self.is_finest && !holds => Verdict::Empty,
            Tag::Full => Verdict::Full,
            Tag::Empty => Verdict::Empty,
            _ => Verdict::Undecided,
        }
    }
}

impl Worker for One {
    type Part = ();

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<()>, Error> {
        Ok(self.verdict(Cell::ROOT))
    }

    fn split(&mut self, cell: Cell, _: &()) -> Result<[Verdict<()>; 8], Error> {
        Ok([0, 1, 2, 3, 4, 5, 6, 7].map(|octant| self.verdict(cell.child(octant))))
    }
}

/// Trees of one cell at depths 1, 10 and 20, and the same with all around it turned inside out.
fn trees(place: &Place) -> Vec<PathBuf> {
    let mut paths = vec![];
    let mut save = |name: String, tree: &Octree| {
        let path = place.path(&name);
        file::save(tree, &path).unwrap();
        paths.push(path);
    };
    let control = Control::default();
    for depth in [1, 10, 20] {
        let frame = Frame::new([0.0; 3], 1.0, depth).unwrap();
        for (tag, name) in [(Tag::Empty, "empty"), (Tag::Full, "full"), (Tag::Partial, "partial")] {
            for is_finest in [false, true] {
                let tree = build(&One { frame, tag, is_finest }, &frame, Rule::Certified, &control).unwrap();
                let place = if is_finest { "cell" } else { "universe" };
                save(format!("{place}-{name}-{depth}.lfl"), &tree);
                if is_finest && tag == Tag::Full {
                    save(format!("hole-{depth}.lfl"), &leafless::complement(tree.view(), &control).unwrap());
                }
            }
        }
    }
    paths
}

/// Runs the program under a limit of addresses, with twice what it is allowed: what it takes for threads counts, too.
fn run(place: &Place, allowed: &str, line: &str, input: &[u8]) -> Run {
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
    // (The program may not care for its input.)
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

/// Commands on a file end by themselves: with success, or with one sentence.
fn attempt(place: &Place, allowed: &str, path: &Path, commands: impl Iterator<Item = &'static str>) {
    for command in commands {
        let (line, input) = command.split_once('<').unwrap_or((command, ""));
        let line = line.replace(" F", &format!(" {}", path.display()));
        let done = run(place, allowed, &line, format!("{}\n", input.trim()).as_bytes());
        assert!(matches!(done.code, Some(0..=2)), "{done:?}");
        let errors = done.errors.lines().filter(|line| !line.contains("warning")).count();
        assert_eq!(errors, usize::from(done.code != Some(0)), "{done:?}");
        // The limit was kept by the program itself.
        let is_kept =
            !done.errors.contains("the system has no memory left") && !done.errors.contains("panicked");
        assert!(is_kept, "{done:?}");
    }
}

/// Files in turn, on as many threads as there are processors: of each one command in so many, another one for each file.
fn in_turn(paths: &[PathBuf], allowed: &str, every: usize) {
    let next = std::sync::atomic::AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, |n| n.get()) {
            scope.spawn(|| {
                let place = Place::new();
                loop {
                    let i = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    let Some(path) = paths.get(i) else { break };
                    attempt(&place, allowed, path, COMMANDS.into_iter().skip(i % every).step_by(every));
                }
            });
        }
    });
}

fn vectors() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../format_spec/vectors/valid");
    let entries = std::fs::read_dir(folder.canonicalize().unwrap()).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "lfl"));
    paths.sort();
    assert!(paths.len() > 50);
    paths
}

#[test]
fn trees_of_one_cell_take_little() {
    let place = Place::new();
    in_turn(&trees(&place), LITTLE, 1);
}

#[test]
fn test_vectors_take_little() {
    in_turn(&vectors(), LITTLE, 7);
}

/// Minutes: `--test limits -- --ignored`.
#[test]
#[ignore = "minutes"]
fn every_command_on_every_file_takes_little() {
    let place = Place::new();
    in_turn(&trees(&place), ALLOWED, 1);
    in_turn(&vectors(), ALLOWED, 1);
}

#[test]
fn every_command_is_among_them() {
    let place = Place::new();
    let help = place.run("--help").good();
    let commands = help.text().split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    // These do not read a solid, or make one of their own.
    let others = ["csg", "demo", "help"];
    for name in commands.lines().filter_map(|line| line.split_whitespace().next()) {
        let is_listed = COMMANDS.iter().any(|command| command.split(' ').next() == Some(name));
        assert!(is_listed || others.contains(&name), "{name}");
    }
}

#[test]
fn what_is_too_large_is_said_with_its_size_and_the_option() {
    let place = Place::new();
    let trees = trees(&place);
    let full = trees.iter().find(|path| path.ends_with("universe-full-20.lfl")).unwrap().display();
    for (line, what) in [
        (format!("mesh {full} -o out.ply"), "the surface would take 241.8 TB"),
        (format!("dexelize {full} -o out.lfl"), "the rays would take 12 TB"),
        (format!("voxels {full} -o out.npz"), "the records would take 10 TB"),
    ] {
        run(&place, ALLOWED, &line, b"").bad(1, &[what, "--max-memory"]);
    }
    assert!(!place.files().iter().any(|name| name.starts_with("out")));
    // A limit that is generous enough changes nothing.
    let small = trees.iter().find(|path| path.ends_with("cell-full-20.lfl")).unwrap().display();
    let model = run(&place, ALLOWED, &format!("dexelize {small} -o out.lfl"), b"").good();
    assert!(model.text().contains("3 intervals"), "{model:?}");
}

#[test]
#[cfg(unix)]
fn endless_inputs_are_refused() {
    let place = Place::new();
    for command in ["info", "verify", "measure", "voxelize -o out.lfl --depth 3", "csg -o out.lfl --depth 3"]
    {
        let (name, rest) = command.split_once(' ').unwrap_or((command, ""));
        run(&place, ALLOWED, &format!("{name} /dev/zero {rest}"), b"").bad(1, &["/dev/zero", "--max-memory"]);
    }
    // A regular file says how long it is, and nothing of it is read.
    std::fs::File::create(place.path("long.stl")).unwrap().set_len(1 << 40).unwrap();
    run(&place, ALLOWED, "info long.stl", b"").bad(1, &["long.stl: has 1 TB", "--max-memory"]);
}

#[test]
fn sizes_are_checked() {
    let place = place::solids();
    for size in ["0", "1X", "nan", "G"] {
        place.run(&format!("info cube.lfl --max-memory {size}")).bad(2, &["--max-memory", "512M"]);
    }
    place.run("info cube.lfl --max-memory 1.5G").good();
    place.run("--max-memory 100M info cube.lfl").good();
}
