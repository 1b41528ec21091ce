//! Sizes of extended octrees compared with plain octrees, and the bounds of their volumes.
//!
//! ```text
//! cargo bench -p leafless-benches --bench extended_sizes
//! ```
//!
//! The program also draws `extended.svg`. Bytes are those of the file. The width is that of the volume's
//! interval, for extended trees after 4096, 2^16 and 2^20 splits. `README.md` has the table.

use leafless::{
    Affine, Control, Csg, Error, Frame, Interval, Octree, Rule, Solid, SurfaceOptions, build, build_extended,
    file, measure,
};
use plotters::prelude::*;
use std::path::Path;
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

/// A block of edge 1 minus a hundred balls of 6 % around pseudo-random points.
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

/// A drawn point of a tree: bytes of the file, and relative width of the volume.
type Spot = (f64, f64);

/// The trees of a part: plain trees, and the extended tree after ever more splits.
struct Curves {
    name: &'static str,
    plain: Vec<Spot>,
    extended: Vec<Spot>,
}

fn relative(volume: Interval) -> f64 {
    volume.width() / (0.5 * (volume.lower + volume.upper))
}

/// Prints a line about a tree; returns its point in the drawing.
fn row(name: &str, what: &str, tree: &Octree, seconds: f64, volume: Interval) -> Result<Spot, Error> {
    let cuts = tree.view().cuts();
    let bytes = file::to_bytes(tree)?.len();
    println!(
        "{name:<8} {what:<12} {:>9} {:>7} {:>8} {:>9} {:>11} {:>9.1} {:>10.1e}",
        tree.statistics().nodes(),
        cuts.map_or(0, |cuts| cuts.cells),
        cuts.map_or(0, |cuts| cuts.given_up),
        cuts.map_or(0, |cuts| cuts.surfaces),
        bytes,
        seconds * 1e3,
        relative(volume),
    );
    Ok((bytes as f64, relative(volume)))
}

/// Draws the width of the volume's interval against the bytes of the file.
fn draw(path: &Path, parts: &[Curves]) -> Result<(), Box<dyn std::error::Error>> {
    let area = SVGBackend::new(path, (1000, 560)).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(60)
        .build_cartesian_2d((1e3..1e8f64).log_scale(), (1e-10..1e0f64).log_scale())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("bytes of the file")
        .y_desc("width of the volume / volume")
        .x_label_formatter(&|x| format!("{x:.0e}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .draw()?;
    for (k, Curves { name, plain, extended }) in parts.iter().enumerate() {
        let color = Palette99::pick(k).to_rgba();
        for (what, spots, is_filled) in
            [("depths 8, 10, 12", plain, false), ("surfaces kept", extended, true)]
        {
            let style = if is_filled { color.filled() } else { color.stroke_width(2) };
            chart.draw_series(LineSeries::new(spots.iter().copied(), color.stroke_width(2)))?;
            chart
                .draw_series(spots.iter().map(|&spot| Circle::new(spot, 5, style)))?
                .label(format!("{name}, {what}"))
                .legend(move |(x, y)| Circle::new((x + 10, y), 5, style));
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerRight)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.2))
        .draw()?;
    area.present()?;
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let control = Control::threads(1);
    println!(
        "{:<8} {:<12} {:>9} {:>7} {:>8} {:>9} {:>11} {:>9} {:>10}",
        "part", "tree", "nodes", "cuts", "given up", "surfaces", "bytes", "build, ms", "width"
    );
    let turn = Affine::new([[0.36, 0.48, -0.8, 0.0], [-0.8, 0.6, 0.0, 0.0], [0.48, 0.64, 0.6, 0.0]])?;
    let mut drawn = Vec::new();
    for (name, part) in [("plate", plate()?), ("turned", plate()?.placed(&turn)?), ("sponge", sponge()?)] {
        let Some(bounds) = part.bounds() else { continue };
        let mut curves = Curves { name, plain: Vec::new(), extended: Vec::new() };
        for depth in [8, 10, 12] {
            let frame = Frame::around(bounds.min, bounds.max, depth)?;
            let begun = Instant::now();
            let tree = build(&part, &frame, Rule::Certified, &control)?;
            let (seconds, volume) = (begun.elapsed().as_secs_f64(), tree.statistics().volume());
            curves.plain.push(row(name, &format!("depth {depth}"), &tree, seconds, volume)?);
        }
        let options = SurfaceOptions::default();
        let frame = options.frame(&bounds)?;
        let begun = Instant::now();
        let tree = build_extended(&part, &frame, &options, &control)?;
        let seconds = begun.elapsed().as_secs_f64();
        for splits in [1 << 12, 1 << 16, 1 << 20] {
            let few = Control { max_splits: Some(splits), ..Control::threads(1) };
            let volume = measure(&tree, &frame, 1e-10, &few)?.volume;
            curves.extended.push(row(name, &format!("2^{} splits", splits.ilog2()), &tree, seconds, volume)?);
        }
        drawn.push(curves);
    }
    draw(&Path::new(env!("CARGO_MANIFEST_DIR")).join("extended.svg"), &drawn)
}
