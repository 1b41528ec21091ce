//! Sizes of extended octrees beside plain ones, and what is known of their volumes.
//!
//! ```text
//! cargo run --release --example extended_sizes
//! ```
//!
//! Bytes are those of the file; the width is that of the volume's interval, of extended trees
//! after 4096, 2^16 and 2^20 splits. (2026-11-25, one thread on a busy machine.)
//!
//! | part | tree | nodes | cuts | bytes | build | width |
//! |---|---|---|---|---|---|---|
//! | plate, 20 bores | depth 8 | 48 681 | | 34 632 | 11 ms | 1.1e-1 |
//! | | depth 10 | 806 529 | | 489 416 | 97 ms | 2.8e-2 |
//! | | depth 12 | 12 850 057 | | 7 737 544 | 1.6 s | 7.1e-3 |
//! | | extended | 49 | 120 | 4 464 | 0.9 ms | 2.5e-3, 2.3e-6, 9.1e-10 |
//! | the same, turned | depth 8 | 44 217 | | 56 328 | 20 ms | 2.0e-1 |
//! | | depth 10 | 717 153 | | 501 640 | 148 ms | 5.0e-2 |
//! | | depth 12 | 11 487 755 | | 7 034 888 | 2.3 s | 1.3e-2 |
//! | | extended | 53 | 352 | 7 232 | 3 ms | 7.4e-3, 1.1e-5, 2.6e-9 |
//! | block, 100 balls | depth 8 | 232 884 | | 344 392 | 36 ms | 4.9e-2 |
//! | | depth 10 | 3 707 027 | | 3 746 896 | 0.7 s | 1.2e-2 |
//! | | depth 12 | 59 142 409 | | 62 294 616 | 12 s | 3.1e-3 |
//! | | extended | 97 | 884 | 38 258 | 9 ms | 2.7e-2, 3.3e-4, 5.6e-8 |
//!
//! Extended trees have as many nodes and cuts at depths 8, 12 and 20, and no cell is given up; the bytes are those of depth 20.

use leafless::{
    Affine, Control, Csg, Error, Frame, Interval, Octree, Rule, Solid, SurfaceOptions, build, build_extended,
    file, measure,
};
use std::time::Instant;

/// A plate of 80 × 60 × 10 with twenty bores.
fn plate() -> Result<Csg, Error> {
    let mut bores = Vec::new();
    for k in 0..20 {
        let to = [8.0 + 16.0 * f64::from(k % 5), 7.5 + 15.0 * f64::from(k / 5), 0.0];
        bores.push(Csg::cylinder(2.5, -1.0, 11.0)?.placed(&Affine::translation(to)?)?);
    }
    Csg::cuboid([0.0; 3], [80.0, 60.0, 10.0])?.difference(&Csg::union_of(bores)?)
}

/// A block of edge 1, less a hundred balls of 6 % around points that look random.
fn sponge() -> Result<Csg, Error> {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut balls = Vec::new();
    for _ in 0..100 {
        balls.push(Csg::ball([next(), next(), next()], 0.06)?);
    }
    Csg::cuboid([0.0; 3], [1.0; 3])?.difference(&Csg::union_of(balls)?)
}

fn row(name: &str, what: &str, tree: &Octree, seconds: f64, volume: Interval) -> Result<(), Error> {
    let cells = tree.view().cuts();
    let bytes = file::to_bytes(tree)?.len();
    println!(
        "{name:<8} {what:<12} {:>9} {:>7} {:>8} {:>9} {:>11} {:>9.1} {:>10.1e}",
        tree.statistics().nodes(),
        cells.map_or(0, |cuts| cuts.cells),
        cells.map_or(0, |cuts| cuts.given_up),
        cells.map_or(0, |cuts| cuts.surfaces),
        bytes,
        seconds * 1e3,
        volume.width() / (0.5 * (volume.lower + volume.upper)),
    );
    Ok(())
}

fn main() -> Result<(), Error> {
    let control = Control::threads(1);
    println!(
        "{:<8} {:<12} {:>9} {:>7} {:>8} {:>9} {:>11} {:>9} {:>10}",
        "part", "tree", "nodes", "cuts", "given up", "surfaces", "bytes", "build, ms", "width"
    );
    let turn = Affine::new([[0.36, 0.48, -0.8, 0.0], [-0.8, 0.6, 0.0, 0.0], [0.48, 0.64, 0.6, 0.0]])?;
    for (name, part) in [("plate", plate()?), ("turned", plate()?.placed(&turn)?), ("sponge", sponge()?)] {
        let Some(bounds) = part.bounds() else { continue };
        for depth in [8, 10, 12] {
            let frame = Frame::around(bounds.min, bounds.max, depth)?;
            let begun = Instant::now();
            let tree = build(&part, &frame, Rule::Certified, &control)?;
            row(
                name,
                &format!("plain, {depth}"),
                &tree,
                begun.elapsed().as_secs_f64(),
                tree.statistics().volume(),
            )?;
        }
        for depth in [8, 12, 20] {
            let frame = Frame::around(bounds.min, bounds.max, depth)?;
            let begun = Instant::now();
            let tree = build_extended(&part, &frame, &SurfaceOptions::default(), &control)?;
            let seconds = begun.elapsed().as_secs_f64();
            let fine = SurfaceOptions::default().frame(&bounds)?;
            for (splits, what) in [(1 << 12, "4 k splits"), (1 << 16, "66 k splits"), (1 << 20, "1 M splits")]
            {
                let few = Control { max_splits: Some(splits), ..Control::threads(1) };
                let begun = Instant::now();
                let known = measure(&tree, &fine, 1e-9, &few)?;
                if splits == 1 << 12 {
                    row(name, &format!("extended, {depth}"), &tree, seconds, known.volume)?;
                } else {
                    println!(
                        "{:<8} {what:<12} {:>59.1} {:>10.1e}",
                        "",
                        begun.elapsed().as_secs_f64() * 1e3,
                        known.volume.width() / (0.5 * (known.volume.lower + known.volume.upper)),
                    );
                }
            }
        }
    }
    Ok(())
}
