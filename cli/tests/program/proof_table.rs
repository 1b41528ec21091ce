//! The proofs in files that the program writes: one table of all subcommands that make a solid of another.
//!
//! The input is a ball, built by each of the four rules. Each way states which bits its result has, and the
//! truth that they describe. Where FULL or EMPTY is claimed, the cells are compared with the truth, point by
//! point and exactly. A subcommand that is neither in the table nor in the list of those that write no solid
//! fails the test.

use crate::place::Place;
use leafless::{Octree, Tag, file};
use leafless_testkit::zip;
use std::collections::BTreeSet;

/// The rules of the inputs, in the order of the table's columns.
const RULES: [&str; 4] = ["certified", "inner", "outer", "sampled"];

/// Scenes of the ball, another ball, and a placed file, in the cube [0, 16]³ with 16 cells along an axis.
const SCENES: [(&str, &str); 6] = [
    ("ball.csg", "multmatrix([[1,0,0,7.25],[0,1,0,8],[0,0,1,6.5],[0,0,0,1]]) { sphere(r = 5.25, $fn = 0); }"),
    (
        "other.csg",
        "multmatrix([[1,0,0,9.5],[0,1,0,7.25],[0,0,1,8.25],[0,0,0,1]]) { sphere(r = 4.5, $fn = 0); }",
    ),
    ("file.csg", "octree(\"in.lfl\");"),
    ("union.csg", "union() { octree(\"in.lfl\"); octree(\"other.lfl\"); }"),
    ("difference.csg", "difference() { octree(\"in.lfl\"); octree(\"other.lfl\"); }"),
    ("moved.csg", "multmatrix([[1,0,0,0.5],[0,1,0,0],[0,0,1,0.25],[0,0,0,1]]) { octree(\"in.lfl\"); }"),
];

const FRAME: &str = "--depth 4 --bounds 0,0,0,16";

type Truth = fn([f64; 3]) -> Option<bool>;

fn is_in(centre: [f64; 3], radius: f64, point: [f64; 3]) -> Option<bool> {
    let square = (0..3).map(|axis| (point[axis] - centre[axis]).powi(2)).sum::<f64>();
    (square != radius * radius).then_some(square < radius * radius)
}

fn ball(p: [f64; 3]) -> Option<bool> {
    is_in([7.25, 8.0, 6.5], 5.25, p)
}

fn other(p: [f64; 3]) -> Option<bool> {
    is_in([9.5, 7.25, 8.25], 4.5, p)
}

fn moved([x, y, z]: [f64; 3]) -> Option<bool> {
    ball([x - 0.5, y, z - 0.25])
}

fn or(p: [f64; 3]) -> Option<bool> {
    Some(ball(p)? || other(p)?)
}

fn and(p: [f64; 3]) -> Option<bool> {
    Some(ball(p)? && other(p)?)
}

fn without(p: [f64; 3]) -> Option<bool> {
    Some(ball(p)? && !other(p)?)
}

fn odd(p: [f64; 3]) -> Option<bool> {
    Some(ball(p)? ^ other(p)?)
}

fn not(p: [f64; 3]) -> Option<bool> {
    ball(p).map(|inside| !inside)
}

/// The truth of a solid defined by its own cells, such as a mesh or a bitmap: unknown everywhere.
fn itself(_: [f64; 3]) -> Option<bool> {
    None
}

const SAME: [&str; 4] = ["11", "10", "01", "00"];
const SWAPPED: [&str; 4] = ["11", "01", "10", "00"];
const NOTHING: [&str; 4] = ["00", "00", "00", "00"];
const IF_BOTH: [&str; 4] = ["11", "00", "00", "00"];
const ITSELF: [&str; 4] = ["11", "11", "11", "11"];

/// Command lines from `in.lfl` to `out.lfl`, the truth of the result, and the proofs of FULL and EMPTY for
/// each rule of [`RULES`] (`1` if proven). `RULE` stands for the input's rule, `FRAME` for the cube.
const WAYS: &[(&[&str], Truth, [&str; 4])] = &[
    (&["csg ball.csg -o out.lfl FRAME --rule RULE"], ball, SAME),
    (&["csg ball.csg -o out.lfl FRAME --adaptive 0.1"], ball, ITSELF),
    (&["csg ball.csg -o out.lfl FRAME --surfaces"], ball, ITSELF),
    (&["csg file.csg -o out.lfl FRAME"], ball, SAME),
    (&["csg file.csg -o out.lfl FRAME --rule inner"], ball, ["10", "10", "00", "00"]),
    (&["csg file.csg -o out.lfl FRAME --rule outer"], ball, ["01", "00", "01", "00"]),
    (&["csg union.csg -o out.lfl FRAME"], or, SAME),
    (&["csg difference.csg -o out.lfl FRAME"], without, IF_BOTH),
    (&["csg moved.csg -o out.lfl FRAME"], moved, SAME),
    (&["union in.lfl other.lfl -o out.lfl"], or, SAME),
    (&["intersection in.lfl other.lfl -o out.lfl"], and, SAME),
    (&["difference in.lfl other.lfl -o out.lfl"], without, IF_BOTH),
    (&["xor in.lfl other.lfl -o out.lfl"], odd, IF_BOTH),
    (&["complement in.lfl -o out.lfl"], not, SWAPPED),
    (&["attribute in.lfl --name heat --value 3 -o out.lfl"], ball, SAME),
    // By samples.
    (
        &[
            "convert in.lfl -o model.lfl --to dexels --resolve outer",
            "convert model.lfl -o out.lfl --to octree",
        ],
        ball,
        NOTHING,
    ),
    (
        &["dexelize in.lfl -o model.lfl --rule outer", "convert model.lfl -o out.lfl --to octree"],
        ball,
        NOTHING,
    ),
    (&["convert ball.csg -o out.lfl --to octree --bounds 0,0,0,16 --resolution 16"], ball, ITSELF),
    // Solids of their own. They do not repeat the proofs of their sources.
    (
        &["mesh ball.csg -o out.stl --method mc --depth 4", "voxelize out.stl -o out.lfl FRAME --rule RULE"],
        itself,
        SAME,
    ),
    (&["mesh in.lfl -o out.stl --resolve outer", "voxelize out.stl -o out.lfl FRAME"], itself, ITSELF),
    (&["bitmap in.lfl -o out.nrrd --resolve outer", "voxelize out.nrrd -o out.lfl FRAME"], itself, ITSELF),
    // Records, and back.
    (&["voxels in.lfl -o r.npz", "voxels r.npz --import -o out.lfl"], ball, SAME),
    // Without further information, the boundary voxels of a binary octree are inside cells that touch outside
    // cells.
    (
        &["voxels in.lfl -o r.npz", "voxels r.npz --import -o out.lfl --boundary-as full"],
        ball,
        ["01", "10", "01", "00"],
    ),
    (
        &["voxels in.lfl -o r.npz", "voxels r.npz --import -o out.lfl --boundary-as empty"],
        ball,
        ["10", "10", "00", "00"],
    ),
    (&["voxels in.lfl -o r.npz --boundary-depth 2", "voxels r.npz --import -o out.lfl"], ball, SAME),
    (
        &["voxels in.lfl -o r.npz --boundary-depth 2", "voxels r.npz --import -o out.lfl --boundary-as full"],
        ball,
        ["01", "00", "01", "00"],
    ),
    (
        &[
            "voxels in.lfl -o r.npz --boundary-depth 2",
            "voxels r.npz --import -o out.lfl --boundary-as empty",
        ],
        ball,
        ["10", "10", "00", "00"],
    ),
    (
        &[
            "voxels in.lfl -o r.npz --boundary undecided",
            "voxels r.npz --import -o out.lfl --boundary-as full",
        ],
        ball,
        ["01", "10", "01", "00"],
    ),
    (
        &["voxels in.lfl -o r.npz --outside --refined --coarse 2", "voxels r.npz --import -o out.lfl"],
        ball,
        SAME,
    ),
    (&["voxels ball.csg -o r.npz FRAME", "voxels r.npz --import -o out.lfl"], ball, ITSELF),
    // Taking cells for the solid is no proof.
    (&["voxels in.lfl --cells -o r.npz", "voxels r.npz --import -o out.lfl"], ball, SAME),
    (&["voxels in.lfl --cells --depth 3 -o r.npz", "voxels r.npz --import -o out.lfl"], ball, SAME),
    (
        &["voxels in.lfl --cells -o r.npz", "voxels r.npz --import --cells -o out.lfl --boundary-as full"],
        ball,
        ["01", "10", "01", "00"],
    ),
];

/// Subcommands that write no solid made from another.
const OTHERS: [&str; 15] = [
    "info",
    "verify",
    "contains",
    "distance",
    "neighbours",
    "ray",
    "render",
    "heights",
    "interfere",
    "layout",
    "deviation",
    "measure",
    "within",
    "sample",
    "summary",
];

/// `demo` makes solids of its own, and `help` makes none.
const BY_THEMSELVES: [&str; 2] = ["demo", "help"];

/// Subcommands that can take cells for the solid. Only `voxels` writes data from which a solid can be made.
const WITH_CELLS: [&str; 8] =
    ["deviation", "distance", "heights", "interfere", "measure", "ray", "voxels", "within"];

/// Writes the ball and the other ball, built by a rule.
fn given(rule: &str) -> Place {
    let place = Place::new();
    for (name, text) in SCENES {
        place.write(name, text);
    }
    for (scene, name) in [("ball.csg", "in.lfl"), ("other.csg", "other.lfl")] {
        place.run(&format!("csg {scene} -o {name} {FRAME} --rule {rule}")).good();
    }
    place
}

fn bits(octree: &Octree) -> String {
    format!("{}{}", u8::from(octree.proof().full), u8::from(octree.proof().empty))
}

/// Counts the points of FULL cells that are outside, and the points of EMPTY cells that are inside.
fn lies(octree: &Octree, truth: Truth) -> [usize; 2] {
    let (view, frame) = (octree.view(), octree.frame());
    let mut lies = [0; 2];
    for n in 0..frame.cells().pow(3) {
        let cell = [n % frame.cells(), n / frame.cells() % frame.cells(), n / frame.cells().pow(2)];
        for k in 0..9u32 {
            let within = |axis: usize| if k == 8 { 0.5 } else { [0.0625, 0.9375][(k >> axis & 1) as usize] };
            let at = |axis: usize| (f64::from(cell[axis]) + within(axis)) * frame.cell_size();
            match (view.tag_at(cell), truth([0, 1, 2].map(|axis| frame.origin()[axis] + at(axis)))) {
                (Tag::Full, Some(false)) => lies[0] += 1,
                (Tag::Empty, Some(true)) => lies[1] += 1,
                _ => {}
            }
        }
    }
    lies
}

#[test]
fn what_is_written_is_what_the_table_says_and_true() {
    let mut seen = 0;
    for (rule, column) in RULES.iter().zip(0..) {
        let place = given(rule);
        for (lines, truth, expected) in WAYS {
            for line in *lines {
                let line = line.replace("RULE", rule).replace("FRAME", FRAME);
                let run = place.run(&line);
                assert_eq!(run.code, Some(0), "{rule}: {run:?}");
            }
            let what = format!("{rule}: {lines:?}");
            let octree = file::open(place.path("out.lfl")).unwrap();
            let found = lies(&octree, *truth);
            let proof = octree.proof();
            for (is_proven, lies, name) in [(proof.full, found[0], "FULL"), (proof.empty, found[1], "EMPTY")]
            {
                assert!(
                    !is_proven || lies == 0,
                    "{what}: {name} is said to be proven, and {lies} points are not so"
                );
                seen += usize::from(!is_proven && lies > 0);
            }
            assert_eq!(bits(&octree), expected[column], "{what}");
            std::fs::remove_file(place.path("out.lfl")).unwrap();
        }
    }
    // The check notices lies.
    assert!(seen > WAYS.len(), "{seen} of {}", WAYS.len());
}

#[test]
fn every_subcommand_is_in_the_table() {
    let place = Place::new();
    let commands = place.commands();
    assert!(commands.len() > 25, "{commands:?}");
    let first = |line: &&str| line.split(' ').next().unwrap().to_owned();
    let in_table: BTreeSet<String> = WAYS.iter().flat_map(|(lines, ..)| lines.iter().map(first)).collect();
    for command in &commands {
        let is_known = OTHERS.contains(&&**command) || BY_THEMSELVES.contains(&&**command);
        assert!(in_table.contains(command) || is_known, "what does {command} write? Add a row");
        assert!(!(in_table.contains(command) && is_known), "{command} is in the table and in a list");
    }
    let with_cells = |command: &&String| {
        let help = place.run(&format!("{command} --help"));
        help.text().lines().any(|line| line.trim() == "--cells")
    };
    let found: Vec<&str> =
        commands.iter().filter(|command| *command != "help").filter(with_cells).map(String::as_str).collect();
    assert_eq!(found, WITH_CELLS, "what is written with --cells must prove what the cells did before");
}

/// Returns an NPZ with changed arrays.
fn changed(bytes: &[u8], change: impl Fn(&str, Vec<u8>) -> Option<Vec<u8>>) -> Vec<u8> {
    let archive = rawzip::ZipArchive::from_slice(bytes).unwrap();
    let mut out = vec![];
    for entry in archive.entries() {
        let entry = entry.unwrap();
        let name = std::str::from_utf8(entry.file_path().as_bytes()).unwrap().to_owned();
        let content = archive.get_entry(entry.wayfinder()).unwrap().data();
        out.extend(change(&name, content.to_vec()).map(|content| zip::Entry::stored(&name, content)));
    }
    zip::zip(&out)
}

/// Any program with NumPy can change arrays. A proof of the original arrays is no proof of changed ones.
#[test]
fn changed_records_prove_nothing() {
    let place = given("certified");
    place.run("voxels in.lfl -o r.npz --outside").good();
    let bytes = place.bytes("r.npz");
    let imported = |bytes: Vec<u8>| {
        place.write("c.npz", bytes);
        place.run("voxels c.npz --import -o out.lfl").good();
        bits(&file::open(place.path("out.lfl")).unwrap())
    };
    assert_eq!(imported(changed(&bytes, |_, array| Some(array))), "11");
    // Change a boundary voxel to an inside voxel.
    let kinds = |name: &str, mut array: Vec<u8>| {
        if name == "kinds.npy" {
            *array.iter_mut().rev().find(|kind| **kind == 2).unwrap() = 1;
        }
        Some(array)
    };
    assert_eq!(imported(changed(&bytes, kinds)), "00");
    // Change the universe: the last byte of its edge.
    let edge = |name: &str, mut array: Vec<u8>| {
        if name == "edge.npy" {
            let last = array.len() - 2;
            array[last] ^= 0x10;
        }
        Some(array)
    };
    assert_eq!(imported(changed(&bytes, edge)), "00");
    // A file without a seal, without the proof, or without the meaning of boundary voxels.
    for missing in ["seal.npy", "proof.npy", "boundary.npy", "exterior.npy"] {
        let without = |name: &str, array: Vec<u8>| (name != missing).then_some(array);
        let expected = if missing == "boundary.npy" { "11" } else { "00" };
        assert_eq!(imported(changed(&bytes, without)), expected, "{missing}");
    }
}
