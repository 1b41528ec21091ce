//! Small inputs take limited resources. Every command ends soon and within its memory limit, or refuses at
//! once and says what it would need.

use crate::commands::{COMMANDS, attempt, run, vectors};
use crate::place;
use crate::place::Place;
use leafless::solid::{FreeParts, OneByOne, Question, WholeQuestion};
use leafless::{
    Cell, Classifier, Control, Error, Frame, Octree, Rule, Solid, Tag, Verdict, Worker, build, file,
};
use std::path::PathBuf;

/// The memory limit of every command, and a smaller limit for commands that then take longer.
const ALLOWED: &str = "1G";
const LITTLE: &str = "160M";
/// A universe of one tag, or an EMPTY universe with one finest cell of a tag.
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

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
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

impl FreeParts for One {
    type Part = ();
}

impl OneByOne for One {}

impl Worker for One {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<()>, Error> {
        Ok(self.verdict(Cell::ROOT))
    }

    fn split(&mut self, cell: Cell, _: &()) -> Result<[Verdict<()>; 8], Error> {
        Ok([0, 1, 2, 3, 4, 5, 6, 7].map(|octant| self.verdict(cell.child(octant))))
    }

    fn answer(&mut self, _: Cell, _: &(), _: Question<'_>) -> Result<(), Error> {
        Ok(())
    }
}

/// Trees of one cell at depths 1, 10 and 20, and complements of some.
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

/// Runs commands on files, on as many threads as there are processors. Each file gets every `every`-th
/// command, starting from a different one.
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

#[test]
fn trees_of_one_cell_take_little() {
    let place = Place::new();
    in_turn(&trees(&place), LITTLE, 4);
}

#[test]
fn test_vectors_take_little() {
    in_turn(&vectors(), LITTLE, 41);
}

/// Takes minutes: `--test program limits:: -- --ignored`.
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
    // These commands do not read a solid, or make one of their own.
    let others = ["csg", "demo", "help"];
    for name in place.commands() {
        let is_listed = COMMANDS.iter().any(|command| command.split(' ').next() == Some(&*name));
        assert!(is_listed || others.contains(&&*name), "{name}");
    }
}

#[test]
fn what_is_too_large_is_said_with_its_size_and_the_option() {
    let place = Place::new();
    let trees = trees(&place);
    let full = trees.iter().find(|path| path.ends_with("universe-full-20.lfl")).unwrap().display();
    for (line, what) in [
        (format!("mesh {full} -o out.ply"), "the surface would take 193.8 TB"),
        (format!("dexelize {full} -o out.lfl"), "the rays would take 12 TB"),
        (format!("voxels {full} -o out.npz"), "the records would take 10 TB"),
    ] {
        run(&place, ALLOWED, &line, b"").bad(1, &[what, "--max-memory"]);
    }
    assert!(!place.files().iter().any(|name| name.starts_with("out")));
    // A sufficient limit changes nothing.
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
    // Endless files that a scene names are refused, too.
    std::os::unix::fs::symlink("/dev/zero", place.path("zero.stl")).unwrap();
    std::fs::write(place.path("zero.csg"), "import(file = \"zero.stl\");").unwrap();
    run(&place, ALLOWED, "csg zero.csg -o out.lfl --depth 3", b"")
        .bad(1, &["line 1", "zero.stl: is no regular file"]);
    std::fs::write(place.path("long.csg"), "import(file = \"long.stl\");").unwrap();
    // A regular file states its length, and none of it is read.
    std::fs::File::create(place.path("long.stl")).unwrap().set_len(1 << 40).unwrap();
    run(&place, ALLOWED, "info long.stl", b"").bad(1, &["long.stl: has 1 TB", "--max-memory"]);
    run(&place, ALLOWED, "csg long.csg -o out.lfl --depth 3", b"")
        .bad(1, &["long.stl: has 1099511627776 bytes"]);
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
