//! `leafless heights`: the height of a solid in each column of cells.

use crate::failure::{Failure, Of};
use crate::progress::watched;
use crate::sink::Output;
use crate::source::input::Input;
use crate::source::target::{Looking, Target};
use crate::words::number;
use clap::{Args, ValueEnum};
use leafless::Error;
use leafless::lattice::MAX_DEPTH;
use leafless::query::{Columns, Heights, Side, heights};
use std::ffi::OsString;

/// Prints one height for each column of cells along an axis, in the solid's units; `nan` for an empty column.
///
/// The columns of one row are printed in one line: along a row the first of the other two axes ascends, from
/// row to row the second.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl), mesh (STL, OBJ, PLY, OFF, 3MF), scene (.csg) or volume (NRRD, MetaImage), or `-` for
    /// standard input
    file: OsString,
    /// Axis of the columns
    #[arg(long, value_enum)]
    axis: Axis,
    /// Side from which the columns are seen: `above` is the side of higher coordinates
    #[arg(long, value_enum, default_value_t = From::Above)]
    from: From,
    /// File to write, or `-` for standard output
    #[arg(short, long, default_value = "-", value_name = "OUTPUT")]
    output: OsString,
    /// Which cells count: those proven to be solid, so that the solid reaches at least that far, or also
    /// those that may be solid, so that it reaches no farther
    #[arg(long, value_enum, default_value_t = On::Upper)]
    on: On,
    /// Level of the cells, 1 to 20; there are 2^N × 2^N columns [default: the depth of the solid, or 9 for a
    /// mesh or scene]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=MAX_DEPTH as i64))]
    depth: Option<u8>,
    #[command(flatten)]
    looking: Looking,
    /// Write doubles, 8 bytes each, little-endian, instead of text with commas
    #[arg(long)]
    raw: bool,
}

/// Depth of meshes and scenes without --depth.
const DEPTH: u8 = 9;

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Axis {
    X,
    Y,
    Z,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum From {
    Above,
    Below,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum On {
    /// Cells that are proven to be solid
    Full,
    /// Cells that may be solid
    Upper,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (input, output) = (Input::from(&*arguments.file), Output::from(&*arguments.output));
    if arguments.raw || output.path().is_some() {
        output.check()?;
    }
    let target = arguments.looking.target(&input, arguments.depth, DEPTH)?;
    let side = match arguments.from {
        From::Above => Side::Above,
        From::Below => Side::Below,
    };
    let map = watched("heights", arguments.looking.threads, |control| {
        let columns = Columns::all(target.frame(), arguments.axis as usize)?;
        // Two bounds, and a number as text or eight bytes.
        let needed = columns.count().saturating_mul(16);
        if let Some(limit) = control.max_bytes.filter(|&limit| needed > limit) {
            return Err(Error::TooLarge { what: "the heights", needed, limit });
        }
        match &target {
            Target::Cells(octree) => octree.heights(&columns, side),
            Target::Solid(target) => heights(&target.0, &target.1, &columns, side, control),
        }
    });
    let map = map.of(&input)?;
    let written = if arguments.raw { raw(&map, arguments.on) } else { lines(&map, arguments.on) };
    output.write(&written)
}

/// Returns the height of a column.
fn height(map: &Heights, on: On, index: usize) -> f64 {
    let Some(between) = map.height(index) else { return f64::NAN };
    let height = match (on, map.side()) {
        (On::Full, Side::Above) | (On::Upper, Side::Below) => between.lower,
        (On::Full, Side::Below) | (On::Upper, Side::Above) => between.upper,
    };
    // Nothing is proven about this column.
    if height.is_finite() { height } else { f64::NAN }
}

/// Returns the number of columns in a row, and the number of rows.
fn size(map: &Heights) -> [usize; 2] {
    map.columns().size().map(|n| n as usize)
}

fn raw(map: &Heights, on: On) -> Vec<u8> {
    let [width, rows] = size(map);
    (0..width * rows).flat_map(|index| height(map, on, index).to_le_bytes()).collect()
}

fn lines(map: &Heights, on: On) -> Vec<u8> {
    let [width, rows] = size(map);
    let mut text = Vec::new();
    for row in 0..rows {
        for column in 0..width {
            if column > 0 {
                text.push(b',');
            }
            let height = height(map, on, row * width + column);
            text.extend_from_slice(if height.is_nan() { "nan".into() } else { number(height) }.as_bytes());
        }
        text.push(b'\n');
    }
    text
}
