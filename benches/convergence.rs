//! Convergence of the measures of solids: the width of the interval against the number of splits.
//!
//! `cargo bench --bench convergence` prints a table and writes the picture `benches/convergence.svg`. The
//! figures do not depend on time, and are the same on every machine.

use leafless::query::surface_area;
use leafless::{Affine, Control, Csg, Error, Frame, Interval, measure};
use plotters::prelude::*;
use std::path::Path;

/// Budgets of splits, four to an octave.
const BUDGETS: std::ops::Range<u32> = 32..81;

/// Octaves at the end from which slopes are computed.
const LAST: f64 = 6.0;

struct Shape {
    name: &'static str,
    solid: Csg,
}

fn turned(solid: &Csg) -> Result<Csg, Error> {
    solid.placed(&Affine::new([[0.36, 0.48, -0.8, 0.0], [-0.8, 0.6, 0.0, 0.0], [0.48, 0.64, 0.6, 0.0]])?)
}

fn plate() -> Result<Csg, Error> {
    let mut holes = Vec::new();
    for i in 0..5 {
        for j in 0..4 {
            let to = [8.0 + 16.0 * i as f64, 7.5 + 15.0 * j as f64, 0.0];
            holes.push(Csg::cylinder(3.0, -1.0, 11.0)?.placed(&Affine::translation(to)?)?);
        }
    }
    Csg::cuboid([0.0; 3], [80.0, 60.0, 10.0])?.difference(&Csg::union_of(holes)?)
}

fn shapes() -> Result<Vec<Shape>, Error> {
    let block = Csg::cuboid([-20.0, -15.0, -10.0], [20.0, 15.0, 10.0])?;
    let pocket = turned(&Csg::cuboid([-8.0, -6.0, -4.0], [8.0, 6.0, 40.0])?)?;
    let plate = plate()?;
    Ok(vec![
        Shape { name: "ball", solid: Csg::ball([0.1, 0.2, 0.3], 30.0)? },
        Shape { name: "torus", solid: Csg::torus(25.0, 9.0)? },
        Shape { name: "plate with twenty holes", solid: plate.clone() },
        Shape { name: "the same, turned", solid: turned(&plate)? },
        Shape { name: "turned block with a turned pocket", solid: turned(&block.difference(&pocket)?)? },
    ])
}

/// Returns the splits and the relative width after each pass that a budget allows.
fn passes(
    measured: impl Fn(&Control<'_>) -> Result<(Interval, u64), Error>,
) -> Result<Vec<(f64, f64)>, Error> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    for budget in BUDGETS {
        let splits = 2f64.powf(budget as f64 / 4.0) as u64;
        let (found, spent) = measured(&Control { max_splits: Some(splits), ..Control::default() })?;
        let width = 2.0 * found.width() / (found.upper + found.lower);
        // Once only rounding remains, more splits do not help.
        let is_better =
            points.last().is_none_or(|&(last, least)| last < spent as f64 && width < 0.98 * least);
        if is_better && spent > 0 && width.is_finite() {
            points.push((spent as f64, width));
        }
    }
    Ok(points)
}

/// Returns the slope of the straight line through the logarithms, by least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let most = points.last().map_or(0.0, |&(splits, _)| splits);
    let last: Vec<(f64, f64)> = points
        .iter()
        .filter(|&&(splits, _)| splits * 2f64.powf(LAST) >= most)
        .map(|&(splits, width)| (splits.ln(), width.ln()))
        .collect();
    let mean = |of: fn(&(f64, f64)) -> f64| last.iter().map(of).sum::<f64>() / last.len() as f64;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let (mut mixed, mut square) = (0.0, 0.0);
    for p in &last {
        mixed += (p.0 - x) * (p.1 - y);
        square += (p.0 - x) * (p.0 - x);
    }
    mixed / square
}

type Curve = (&'static str, Vec<(f64, f64)>);

fn print(quantity: &str, curves: &[Curve]) {
    println!("\n| {quantity} | splits | width | slope |\n|---|---|---|---|");
    for (name, points) in curves {
        if let Some((splits, width)) = points.last() {
            println!("| {name} | {splits:.0} | {width:.1e} | {:.2} |", slope(points));
        }
    }
}

fn draw(path: &Path, panels: &[(&str, Vec<Curve>)]) -> Result<(), Box<dyn std::error::Error>> {
    let area = SVGBackend::new(path, (1200, 560)).into_drawing_area();
    area.fill(&WHITE)?;
    for ((title, curves), panel) in panels.iter().zip(area.split_evenly((1, panels.len()))) {
        let mut chart = ChartBuilder::on(&panel)
            .caption(title, ("sans-serif", 20))
            .margin(12)
            .x_label_area_size(40)
            .y_label_area_size(60)
            .build_cartesian_2d((1e2..1e7f64).log_scale(), (1e-11..1e1f64).log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .x_desc("splits")
            .y_desc("width / value")
            .x_label_formatter(&|x| format!("{x:.0e}"))
            .y_label_formatter(&|y| format!("{y:.0e}"))
            .draw()?;
        for (k, (name, points)) in curves.iter().enumerate() {
            let color = Palette99::pick(k).to_rgba();
            chart
                .draw_series(LineSeries::new(points.iter().copied(), color.stroke_width(2)))?
                .label(format!("{name}: {:.2}", slope(points)))
                .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 20, y)], color.stroke_width(2)));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerLeft)
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK.mix(0.2))
            .draw()?;
    }
    area.present()?;
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut volumes, mut areas) = (Vec::new(), Vec::new());
    for Shape { name, solid } in shapes()? {
        let frame = Frame::new([-101.3, -102.7, -103.9], 207.0, 20)?;
        let volume = passes(|control| {
            let found = measure(&solid, &frame, 0.0, control)?;
            Ok((found.volume, found.splits))
        })?;
        let area = passes(|control| {
            let found = surface_area(&solid, &frame, 0.0, control)?;
            Ok((found.area, found.splits))
        })?;
        volumes.push((name, volume));
        areas.push((name, area));
    }
    print("volume", &volumes);
    print("area", &areas);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("convergence.svg");
    draw(&path, &[("Volume", volumes), ("Area", areas)])
}
