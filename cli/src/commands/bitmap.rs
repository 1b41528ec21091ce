//! `leafless bitmap`: the cells of a solid as a volume.

use crate::failure::{Failure, Of, complain};
use crate::options::{ResolveName, UNDECIDED, threads};
use crate::progress::watched;
use crate::sink::Output;
use crate::source::input::Input;
use crate::words::{count, number};
use clap::{Args, ValueEnum};
use leafless::exchange::{NrrdEncoding, read_volume, write_nrrd, write_raw_volume};
use leafless::lattice::MAX_DEPTH;
use leafless::op::plain;
use leafless::solid::{Samples, VoxelGrid};
use leafless::{Control, Error, Octree, Rule, Tag};
use serde::Serialize;
use std::ffi::OsString;
use std::path::Path;

/// Each cell of the chosen level in the whole cube of the solid becomes one byte: 255 inside, 0 outside.
/// `leafless voxelize` makes the same solid from the volume again.
///
/// A raw volume has no header. Its extents are printed: remember them to read the file again.
#[derive(Args)]
pub struct Arguments {
    /// Solid (.lfl), or `-` for standard input
    file: OsString,
    /// File to write, with the extension .nrrd or .raw, or `-` for standard output
    #[arg(short, long, value_name = "OUTPUT")]
    output: OsString,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Level of the cells, from 0 to the solid's depth [default: the finest one, or 8 if the cells keep
    /// surfaces]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=MAX_DEPTH as i64))]
    level: Option<u8>,
    /// What undecided cells count as, and cells of this level that are split further [default: what their
    /// centres are, where cells keep surfaces; otherwise outer, and a note says so]
    #[arg(long, value_enum)]
    resolve: Option<ResolveName>,
    /// Threads to use, 0 to 1024; 0: one for each processor. The result does not depend on it
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = threads)]
    threads: usize,
    /// Format to write [default: by the extension of the output; NRRD for standard output]
    #[arg(long, value_enum)]
    write: Option<WriteName>,
    /// Compress the samples of an NRRD
    #[arg(long)]
    gzip: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum WriteName {
    Nrrd,
    Raw,
}

/// Level of the cells of a solid whose cells keep surfaces, without --level.
const LEVEL: u8 = 8;

#[derive(Serialize)]
struct Report {
    input: String,
    output: String,
    format: &'static str,
    extents: [u32; 3],
    spacing: f64,
    corner: [f64; 3],
    /// Number of samples that are inside.
    inside: u64,
    bytes: u64,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (input, output) = (Input::from(&*arguments.file), Output::from(&*arguments.output));
    output.check()?;
    let format = format(arguments, output.path())?;
    if arguments.gzip && format == WriteName::Raw {
        return Err(Failure::Usage(
            "--gzip is for NRRD: a raw volume cannot say that it is compressed".into(),
        ));
    }
    let (octree, _) = input.octree(true)?;
    let keeps_surfaces = octree.view().cuts().is_some();
    let frame = *octree.frame();
    let level =
        arguments.level.unwrap_or(if keeps_surfaces { LEVEL.min(frame.depth()) } else { frame.depth() });
    if level > frame.depth() {
        let problem = format!("--level {level} is beyond the depth of {input}, which is {}", frame.depth());
        return Err(Failure::Usage(problem));
    }
    // The solid's own cells are large, and say little: its surfaces decide smaller ones.
    let rule = arguments.resolve.map_or(Rule::Sampled, Rule::from);
    let octree = match keeps_surfaces {
        true => watched("bitmap", arguments.threads, |control| plain(&octree, level.max(1), rule, control))
            .of(&input)?,
        false => octree,
    };
    if arguments.level.is_none() && level < frame.depth() {
        let warning = "warning: its cells keep surfaces, which decide cells of level";
        complain(&format!("{input}: {warning} {level}; --level chooses another"));
    }
    let is_open =
        arguments.resolve.is_none() && (level < octree.frame().depth() || !octree.view().is_binary());
    if is_open {
        complain(&format!("{input}: {UNDECIDED}"));
    }
    if octree.view().exterior() != Tag::Empty {
        let warning = "warning: the solid may extend beyond its bounds; a volume does not record that";
        complain(&format!("{input}: {warning}"));
    }
    let n = 1u32 << level;
    let spacing = frame.edge() / f64::from(n);
    let grid = VoxelGrid::new([n; 3], frame.origin(), [spacing; 3]).of(&input)?;
    let is_outer = is_open || arguments.resolve == Some(ResolveName::Outer);
    let made = watched("bitmap", arguments.threads, |control| {
        let samples = samples(&octree, level, is_outer, control)?;
        let inside = samples.iter().filter(|&&sample| sample != 0).count() as u64;
        let samples = Samples::from(&samples[..]);
        let encoding = if arguments.gzip { NrrdEncoding::Gzip } else { NrrdEncoding::Raw };
        let bytes = match format {
            WriteName::Nrrd => write_nrrd(&samples, &grid, encoding)?,
            WriteName::Raw => write_raw_volume(&samples, &grid)?,
        };
        Ok((bytes, inside))
    });
    let (bytes, inside) = made.of(&input)?;
    if format == WriteName::Nrrd {
        warn_of_rounding(&grid, &output).of(&input)?;
    }
    output.write(&bytes)?;
    let report = Report {
        input: input.to_string(),
        output: output.to_string(),
        format: if format == WriteName::Raw { "raw" } else { "NRRD" },
        extents: [n; 3],
        spacing,
        corner: frame.origin(),
        inside,
        bytes: bytes.len() as u64,
    };
    output.tell(arguments.json, &report, Report::text)
}

/// Warns if the corner is not read back exactly: the format stores the centre of the first voxel, rounded.
fn warn_of_rounding(grid: &VoxelGrid, output: &Output) -> Result<(), Error> {
    let one = VoxelGrid::new([1; 3], grid.corner(), grid.spacing())?;
    let header = write_nrrd(&vec![0u8].into(), &one, NrrdEncoding::Raw)?;
    let (corner, back) = (grid.corner(), read_volume(&header, None)?.grid.corner());
    if back != corner {
        let list = |corner: [f64; 3]| corner.map(number).join(",");
        let problem = "the centre of the first voxel is rounded, so that the corner is read back as";
        complain(&format!("{output}: warning: {problem} {}, not {}", list(back), list(corner)));
    }
    Ok(())
}

/// Returns the format to write.
fn format(arguments: &Arguments, path: Option<&Path>) -> Result<WriteName, Failure> {
    if let Some(name) = arguments.write {
        return Ok(name);
    }
    let Some(path) = path else { return Ok(WriteName::Nrrd) };
    match path.extension().and_then(|extension| extension.to_str()) {
        Some(extension) if extension.eq_ignore_ascii_case("nrrd") => Ok(WriteName::Nrrd),
        Some(extension) if extension.eq_ignore_ascii_case("raw") => Ok(WriteName::Raw),
        _ => {
            let problem = "has neither of the extensions .nrrd and .raw: name the format with --write";
            Err(Failure::Usage(format!("{}: {problem}", path.display())))
        }
    }
}

/// Returns a byte for each cell of a level, x fastest.
fn samples(octree: &Octree, level: u8, is_outer: bool, control: &Control<'_>) -> Result<Vec<u8>, Error> {
    let n = 1usize << level;
    let row = n.div_ceil(64);
    // The bytes, the file made of them, and bits.
    let needed = (n as u64).pow(3).saturating_mul(3);
    if let Some(limit) = control.max_bytes.filter(|&limit| needed > limit) {
        return Err(Error::Limit { what: "bytes", limit });
    }
    let bits = || -> Result<Vec<u64>, Error> {
        let mut bits = Vec::new();
        bits.try_reserve_exact(row * n * n)?;
        bits.resize(row * n * n, 0);
        Ok(bits)
    };
    let (mut inner, mut outer) = (bits()?, if is_outer { Some(bits()?) } else { None });
    octree.bitmap(level, [0; 3], [n as u32; 3], &mut inner, outer.as_deref_mut(), control)?;
    let bits = outer.unwrap_or(inner);
    let mut samples = Vec::new();
    samples.try_reserve_exact(n * n * n)?;
    for words in bits.chunks(row) {
        let of_row = words.iter().flat_map(|&word| (0..64).map(move |k| word >> k & 1));
        samples.extend(of_row.take(n).map(|bit| if bit == 0 { 0u8 } else { 255 }));
    }
    Ok(samples)
}

impl Report {
    fn text(&self) -> String {
        let [n, ..] = self.extents;
        format!(
            "{}: {} volume of {n} x {n} x {n} bytes, {} of them inside, voxels of edge {}\n",
            self.output,
            self.format,
            count(self.inside),
            number(self.spacing),
        )
    }
}
