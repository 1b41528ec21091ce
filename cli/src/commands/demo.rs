//! `leafless demo`: the main workflow end to end.

use crate::failure::{Failure, Of};
use crate::making::part;
use crate::sink::{self, Output};
use crate::source::input::Input;
use crate::words::{count, counted, seconds};
use clap::Args;
use leafless::{
    Control, FillRule, Frame, Membership, MeshSolid, Octree, Rule, TriangleMesh, build, difference, exchange,
};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Makes a flanged, ribbed and drilled part and a tool to cut it with, and writes both as STL files. Then it
/// reads the files back, turns them into octrees of 1024³ cells, cuts, saves, maps and verifies the result,
/// and asks questions about it.
///
/// All files stay in the folder.
#[derive(Args)]
pub struct Arguments {
    /// Folder for the files; created if it does not exist [default: leafless-demo in the folder for temporary
    /// files]
    dir: Option<PathBuf>,
}

const DEPTH: u8 = 10;
const POINTS: usize = 1_000_000;

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let folder = folder(arguments.dir.as_deref())?;
    sink::print(format!("Files are in {}\n\n", folder.display()).as_bytes())?;
    let control = Control::default();
    let path = |name: &str| folder.join(name);

    let mut meshes = Vec::new();
    for (name, make) in [("flange", part::flange as fn() -> TriangleMesh), ("cutter", part::cutter)] {
        let stl = path(name).with_extension("stl");
        let (bytes, time) = timed(|| exchange::write_stl(&make()).of(stl.display()));
        let bytes = bytes?;
        let ((), written) = fallible(|| sink::write_file(&stl, &bytes))?;
        row(&format!("make {name}.stl"), &format!("{} bytes", count(bytes.len() as u64)), time + written)?;

        let (mesh, time) = fallible(|| {
            let bytes = Input::Path(stl.clone()).read()?;
            let mesh = exchange::read_stl(&bytes).and_then(TriangleMesh::sewn).of(stl.display())?;
            mesh.check_closed(FillRule::NonZero).of(stl.display())?;
            Ok(mesh)
        })?;
        let report = mesh.report().of(stl.display())?;
        let bodies = counted(report.bodies, "body", "bodies");
        row("  read it, weld it", &format!("{} triangles, {bodies}, closed", count(report.triangles)), time)?;
        meshes.push((name, Arc::new(mesh)));
    }

    let frame = around(&meshes)?;
    let mut solids = Vec::new();
    for (name, mesh) in &meshes {
        let (octree, time) = fallible(|| {
            let solid = MeshSolid::new(mesh.clone(), FillRule::NonZero)?;
            build(&solid, &frame, Rule::Certified, &control)
        })
        .of(name)?;
        let cells = frame.cells();
        row(&format!("voxelize {name}, {cells}³ cells"), &nodes(&octree), time)?;
        solids.push(octree);
    }

    let (result, time) =
        fallible(|| difference(solids[0].view(), solids[1].view(), &control)).of("difference")?;
    row("subtract the cutter", &nodes(&result), time)?;

    let saved = Output::Path(path("drilled.lfl"));
    let (bytes, time) = fallible(|| saved.save(&result))?;
    let each = bytes as f64 / result.statistics().nodes().max(1) as f64;
    row("save drilled.lfl", &format!("{} bytes, {each:.2} a node", count(bytes)), time)?;

    let input = Input::Path(path("drilled.lfl"));
    let centre = frame.origin().map(|x| x + frame.edge() / 2.0);
    let ((mapped, first), time) = fallible(|| {
        let mapped = input.octree(false)?.0;
        let first = mapped.contains(centre);
        Ok::<_, Failure>((mapped, first))
    })?;
    row("map it, first query", &format!("the centre is {}", word(first)), time)?;
    let (_, time) = fallible(|| input.octree(true))?;
    row("verify all of it", "good", time)?;

    let points = points(&frame);
    let (single, time) =
        timed(|| points.iter().map(|&point| mapped.contains(point)).collect::<Vec<Membership>>());
    row("a million points, one by one", &per_point(time), time)?;
    let mut answers = vec![Membership::Undecided; points.len()];
    let ((), time) = fallible(|| mapped.contains_many(&points, &mut answers)).of(&input)?;
    row("a million points, in a batch", &per_point(time), time)?;
    if answers != single {
        return Err(Failure::of(&input, "the answers for the batch differ from those for the single points"));
    }
    let share = |wanted: Membership| {
        let hits = answers.iter().filter(|&&answer| answer == wanted).count();
        format!("{:.3} % {}", hits as f64 * 100.0 / answers.len() as f64, word(wanted))
    };
    let shares = [Membership::Inside, Membership::Outside, Membership::Undecided].map(share);
    let volume = mapped.statistics().volume();
    sink::print(
        format!("\nOf the points {}.\nCertified volume: {} mm³.\n", shares.join(", "), volume).as_bytes(),
    )
}

/// Creates the folder for the files.
fn folder(asked: Option<&Path>) -> Result<PathBuf, Failure> {
    let folder = asked.map_or_else(|| std::env::temp_dir().join("leafless-demo"), Path::to_path_buf);
    std::fs::create_dir_all(&folder).of(folder.display())?;
    #[cfg(unix)]
    if asked.is_none() {
        use std::os::unix::fs::MetadataExt;
        // The name can be guessed, and other users can write beside it: an existing folder may be theirs,
        // with links in it that lead to our files.
        let owner = std::fs::symlink_metadata(&folder).of(folder.display())?;
        let own = tempfile::tempfile().and_then(|file| file.metadata()).of(folder.display())?;
        if !owner.is_dir() || owner.uid() != own.uid() {
            return Err(Failure::of(
                folder.display(),
                "is not a folder of yours; name one: leafless demo DIR",
            ));
        }
    }
    Ok(folder)
}

/// The cube around both meshes.
fn around(meshes: &[(&str, Arc<TriangleMesh>)]) -> Result<Frame, Failure> {
    let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (_, mesh) in meshes {
        let (low, high) = mesh.bounds();
        for axis in 0..3 {
            min[axis] = min[axis].min(low[axis]);
            max[axis] = max[axis].max(high[axis]);
        }
    }
    Frame::fitted(min, max, DEPTH).of("bounds")
}

/// Returns points all over the universe, the same ones every time.
fn points(frame: &Frame) -> Vec<[f64; 3]> {
    // SplitMix64.
    let mut state = 1994u64;
    let mut random = || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..POINTS).map(|_| frame.origin().map(|x| x + frame.edge() * random())).collect()
}

/// Runs `work`, and returns its result and the time in seconds.
fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed().as_secs_f64())
}

/// Runs work that can fail, as [`timed`].
fn fallible<T, E>(work: impl FnOnce() -> Result<T, E>) -> Result<(T, f64), E> {
    let (result, time) = timed(work);
    Ok((result?, time))
}

/// Prints a row of the table at once: the table serves as the progress bar.
fn row(step: &str, outcome: &str, time: f64) -> Result<(), Failure> {
    sink::print(format!("{step:<32}{outcome:<40}{:>10}\n", seconds(time)).as_bytes())
}

fn nodes(octree: &Octree) -> String {
    format!("{} nodes", count(octree.statistics().nodes()))
}

fn per_point(time: f64) -> String {
    format!("{:.1} ns a point", time * 1e9 / POINTS as f64)
}

fn word(answer: Membership) -> &'static str {
    match answer {
        Membership::Outside => "outside",
        Membership::Inside => "inside",
        Membership::Undecided => "undecided",
    }
}
