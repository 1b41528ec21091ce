//! Distances of a mesh from itself under random rigid placements, compared with FCL; see benches/README.md.
//!
//! ```text
//! cargo run --release --manifest-path benches/peers/Cargo.toml --bin clearance -- mesh.stl PROGRAM [PLACEMENTS]
//! ```
//!
//! PROGRAM is built from `clearance.cpp`. The mesh is rotated around the centre of its box by a uniformly
//! distributed rotation, and moved by up to two of the box's sides along each axis. Every distance of FCL is
//! compared with the interval of Leafless. FCL considers only the triangles: a placement with one solid
//! inside the other, without contact of the surfaces, is left out of the comparison. One thread each, in
//! turn. The ratio is the median of the rounds' ratios, over the placements that are apart.

use leafless::query::clearance_at;
use leafless::{Affine, Control, Frame, Solid};
use peers::{Peer, median, random_poses, read, solid, spent};
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

const ROUNDS: usize = 5;

fn write_poses(placements: &[Affine], path: &Path) -> Result<(), Box<dyn Error>> {
    let mut text = format!("{}\n", placements.len());
    for [x, y, z, t] in placements.iter().flat_map(|placement| *placement.rows()) {
        writeln!(text, "{x:e} {y:e} {z:e} {t:e}")?;
    }
    Ok(fs::write(path, text)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (path, program) = (arguments.next().ok_or("no mesh")?, arguments.next().ok_or("no program")?);
    let count = arguments.next().map_or(Ok(1000), |count| count.parse())?;
    let solid = solid(&read(&path)?)?;
    let mesh = solid.mesh().clone();
    let bounds = solid.bounds().ok_or("no bounds")?;
    let extent = [0, 1, 2].map(|axis| bounds.max[axis] - bounds.min[axis]);
    let centre = [0, 1, 2].map(|axis| 0.5 * (bounds.min[axis] + bounds.max[axis]));
    let longest = extent.into_iter().fold(0.0, f64::max);
    let frame = Frame::around(centre.map(|c| c - 4.0 * longest), centre.map(|c| c + 4.0 * longest), 9)?;
    let placed = |rows: &[[f64; 4]; 3]| {
        Affine::new([0, 1, 2].map(|i| {
            let [a, b, c, t] = rows[i];
            [a, b, c, centre[i] + t - (a * centre[0] + b * centre[1] + c * centre[2])]
        }))
    };
    let placements = random_poses(count, extent.map(|side| 2.0 * side));
    let placements = placements.iter().map(placed).collect::<Result<Vec<_>, _>>()?;
    let folder = std::env::temp_dir().join(format!("clearance-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    let [mesh_file, pose_file, distance_file] = ["mesh", "poses", "distances"].map(|name| folder.join(name));
    let mut text = format!("{} {}\n", mesh.vertices().len(), mesh.triangles().len());
    for [x, y, z] in mesh.vertices() {
        writeln!(text, "{x:e} {y:e} {z:e}")?;
    }
    for [a, b, c] in mesh.triangles() {
        writeln!(text, "{a} {b} {c}")?;
    }
    fs::write(&mesh_file, text)?;
    let control = Control { threads: 1, ..Control::default() };
    let ask = |placements: &[Affine]| {
        clearance_at(&solid, &solid, &frame, placements, &frame, 1e-9 * longest, &control)
    };
    let start = |placements: &[Affine]| -> Result<Peer, Box<dyn Error>> {
        write_poses(placements, &pose_file)?;
        Peer::start(Command::new(&program).args([&mesh_file, &pose_file, &distance_file]))
    };
    let mut peer = start(&placements)?;
    let found = ask(&placements)?;
    peer.ask("round")?;
    peer.end()?;
    let theirs: Vec<f64> =
        fs::read(&distance_file)?.as_chunks().0.iter().map(|&bytes| f64::from_le_bytes(bytes)).collect();
    let slack = 1e-9 * longest;
    let (mut apart, mut contradictions, mut within, mut widest) = (Vec::new(), 0, 0, 0.0f64);
    for ((found, &theirs), placement) in found.iter().zip(&theirs).zip(&placements) {
        let distance = found.distance;
        if distance.lower > 0.0 {
            apart.push(*placement);
            widest = widest.max(distance.width());
        }
        let is_contact = theirs < 0.0;
        // Triangles that do not meet, although the solids overlap: one solid lies within the other.
        if !is_contact && distance.upper == 0.0 && found.depth > 0.0 {
            within += 1;
        } else if is_contact && distance.lower > slack
            || !is_contact && !(distance.lower - slack..=distance.upper + slack).contains(&theirs)
        {
            contradictions += 1;
            println!("FCL says {theirs} of {found:?}");
        }
    }
    println!(
        "{} triangles, {count} placements, {} apart, {within} within; {contradictions} contradictions; at most {:.1e} of the longest \
         side wide",
        mesh.triangles().len(),
        apart.len(),
        widest / longest
    );
    let mut peer = start(&apart)?;
    let (mut ours, mut theirs, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        let start = spent().0;
        ask(&apart)?;
        ours.push(1e6 * (spent().0 - start) / apart.len() as f64);
        theirs.push(peer.ask("round")?[0]);
        ratios.push(theirs[theirs.len() - 1] / ours[ours.len() - 1]);
    }
    peer.end()?;
    println!(
        "ours {:.1} µs, FCL {:.1} µs a placement that is apart, ratio {:.2}",
        1e-3 * median(ours),
        1e-3 * median(theirs),
        median(ratios)
    );
    Ok(fs::remove_dir_all(&folder)?)
}
