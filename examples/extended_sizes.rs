//! Sizes of extended octrees beside plain ones, and what is known of their volumes.
//!
//! ```text
//! cargo run --release --example extended_sizes
//! ```

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
    let planes = file::to_bytes(&tree.without_cuts())?.len() as u64;
    println!(
        "{name:<8} {what:<12} {:>9} {:>7} {:>8} {:>9} {:>11} {:>9.1} {:>10.1e}",
        tree.statistics().nodes(),
        cells.map_or(0, |cuts| cuts.cells),
        cells.map_or(0, |cuts| cuts.given_up),
        cells.map_or(0, |cuts| cuts.surfaces),
        planes + cells.map_or(0, |cuts| cuts.bytes),
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
