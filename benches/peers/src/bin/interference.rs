//! Collisions of two stored octrees under random rigid placements, compared with FCL's octrees; see
//! benches/README.md.
//!
//! ```text
//! cargo run --release --manifest-path benches/peers/Cargo.toml --bin interference -- mesh.stl PROGRAM [PLACEMENTS [DEPTHS...]]
//! ```
//!
//! PROGRAM is built from `interference.cpp`. The longest side of the mesh's bounding box has 2^depth cells,
//! decided at their centres. The solid meets itself, rotated around the centre of its box by a uniformly
//! distributed rotation, and moved by up to 1.2 of the box's sides along each axis. Both programs have the
//! same cells and placements, and end with the proof or the first contact. One thread each, in turn. The
//! ratio is the median of the rounds' ratios.

use leafless::octree::Cursor;
use leafless::query::{Interference, Overlap, interference_at};
use leafless::{Affine, Control, Frame, OctreeRef, Proof, Rule, Solid, Tag, build};
use peers::{Peer, median, random_poses, read, solid, spent};
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

const ROUNDS: usize = 9;

/// Appends the nodes below a cursor in OctoMap's `.bt` form: two bits a child, which is unknown, occupied or
/// cut. Returns the number of nodes that OctoMap makes of them.
fn add_nodes(cursor: &mut Cursor<'_>, out: &mut Vec<u8>) -> usize {
    let Some(node) = cursor.node() else { return 1 };
    let tags = node.tags();
    let code = |k: usize| match tags[k] {
        Tag::Empty => 0,
        Tag::Full => 0b10,
        _ => 0b11,
    };
    let bits = (0..8).fold(0u16, |bits, k| bits | code(k) << (2 * k));
    out.extend(bits.to_le_bytes());
    let mut count = 1 + tags.iter().filter(|&&tag| tag == Tag::Full).count();
    for k in 0..8 {
        if tags[usize::from(k)] == Tag::Branch && cursor.descend(k) {
            count += add_nodes(cursor, out);
            cursor.ascend();
        }
    }
    count
}

fn write_tree(tree: &OctreeRef<'_>, cell: f64, path: &Path) -> Result<(), Box<dyn Error>> {
    let mut nodes = Vec::new();
    let count = add_nodes(&mut Cursor::new(tree), &mut nodes);
    let mut file = format!("# Octomap OcTree binary file\nid OcTree\nsize {count}\nres {cell}\ndata\n").into_bytes();
    file.extend(nodes);
    Ok(fs::write(path, file)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (mesh, program) = (arguments.next().ok_or("no mesh")?, arguments.next().ok_or("no program")?);
    let count = arguments.next().map_or(Ok(2000), |count| count.parse())?;
    let mut depths: Vec<u8> = arguments.map(|depth| depth.parse()).collect::<Result<_, _>>()?;
    if depths.is_empty() {
        depths.extend([6, 7, 8, 9]);
    }
    let mesh = solid(&read(&mesh)?)?;
    let bounds = mesh.bounds().ok_or("no bounds")?;
    let extent = [0, 1, 2].map(|axis| bounds.max[axis] - bounds.min[axis]);
    let centre = [0, 1, 2].map(|axis| 0.5 * (bounds.min[axis] + bounds.max[axis]));
    let edge = extent.into_iter().fold(0.0, f64::max);
    let poses = random_poses(count, extent.map(|side| 1.2 * side));
    let folder = std::env::temp_dir().join(format!("interference-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    let [tree_file, pose_file, verdict_file] =
        ["tree.bt", "poses", "verdicts"].map(|name| folder.join(name));
    println!("cells  ours: a second  FCL: a second  ratio  colliding  undecided  splits");
    for depth in depths {
        let frame = Frame::new(centre.map(|c| c - 0.5 * edge), edge, depth)?;
        let control = Control { threads: 1, ..Control::default() };
        let tree = build(&mesh, &frame, Rule::Sampled, &control)?.with_proof(Proof::CERTIFIED);
        let placed = |rows: &[[f64; 4]; 3]| {
            Affine::new([0, 1, 2].map(|i| {
                let [a, b, c, t] = rows[i];
                [a, b, c, centre[i] + t - (a * centre[0] + b * centre[1] + c * centre[2])]
            }))
        };
        let placements = poses.iter().map(placed).collect::<Result<Vec<_>, _>>()?;
        write_tree(tree.view(), frame.cell_size(), &tree_file)?;
        let mut text = format!("{depth} {:e} {count}\n", frame.cell_size());
        for row in poses.iter().flatten() {
            let [a, b, c, t] = row;
            writeln!(text, "{a:e} {b:e} {c:e} {t:e}")?;
        }
        fs::write(&pose_file, text)?;
        let mut command = Command::new(&program);
        let mut peer =
            Peer::start(command.args([&tree_file, &tree_file, &pose_file, &verdict_file]))?;
        let ask = |placements: &[Affine]| {
            interference_at(&tree, &tree, &frame, placements, &frame, f64::INFINITY, &control)
        };
        let (mut ours, mut theirs, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
        let mut found: Vec<Interference> = Vec::new();
        for _ in 0..ROUNDS {
            let start = spent().0;
            found = ask(&placements)?;
            ours.push(1e6 * (spent().0 - start) / count as f64);
            theirs.push(peer.ask("round")?[0]);
            ratios.push(theirs[theirs.len() - 1] / ours[ours.len() - 1]);
        }
        peer.end()?;
        let verdicts = fs::read(&verdict_file)?;
        for (found, &collides) in found.iter().zip(&verdicts) {
            let theirs = [Overlap::Disjoint, Overlap::Overlapping][usize::from(collides)];
            if found.verdict != theirs && found.verdict != Overlap::Undecided {
                println!("FCL says {theirs:?} of {found:?}");
            }
        }
        let of = |verdict| found.iter().filter(|found| found.verdict == verdict).count();
        let splits = found.iter().flat_map(|found| found.splits).sum::<u64>() as f64 / count as f64;
        println!(
            "{:5}  {:14.0}  {:13.0}  {:5.2}  {:8.1} %  {:9}  {:6.1}",
            frame.cells(),
            1e9 / median(ours),
            1e9 / median(theirs),
            median(ratios),
            100.0 * of(Overlap::Overlapping) as f64 / count as f64,
            of(Overlap::Undecided),
            splits,
        );
    }
    Ok(fs::remove_dir_all(&folder)?)
}
