//! Volumes from files (NRRD, MetaImage and raw), and the options of reading them.

use crate::failure::{Failure, Of, Problem, complain};
use crate::options::{list, number, numbers};
use crate::source::histogram;
use crate::source::input::Input;
use crate::source::placing::{after, image};
use crate::words::{counted, number as told};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use leafless::attribute::{Attribute, Interpolation, MovedAttribute, VolumeAttribute};
use leafless::exchange::{
    LengthUnit, RawVolume, SampleKind, open_volume, read_raw_volume, read_volume, volume_data_file,
};
use leafless::solid::{Band, Samples, VoxelGrid};
use leafless::{Affine, AnySolid, Control, Error, Frame, Volume};

/// The options of reading a volume: its threshold, and the format of a file without a header.
#[derive(Clone, Default, Args)]
#[command(next_help_heading = "Volumes (NRRD, MetaImage, raw)")]
pub struct Sampling {
    /// Least sample of a volume (NRRD, MetaImage, raw) that is inside [default: the middle of the range of
    /// the samples' type, 0 for floating-point numbers; if all samples lie on one side of it, the number that
    /// separates their histogram best (Otsu's method), and a note says so]
    #[arg(long, value_name = "T", value_parser = threshold, allow_hyphen_values = true)]
    threshold: Option<f64>,
    /// Read the file as a raw volume, which has no header: an array with this many samples along x, y and z,
    /// x fastest
    #[arg(long, value_name = "NX,NY,NZ", value_parser = extents)]
    extents: Option<[u32; 3]>,
    /// Type of the samples of a raw volume [default: u8]
    #[arg(long = "type", value_parser = kinds(), requires = "extents")]
    kind: Option<SampleKind>,
    /// Edges of the voxels of a raw volume along x, y and z, or one number for all [default: 1]
    #[arg(long, value_name = "S|SX,SY,SZ", value_parser = spacing, requires = "extents")]
    spacing: Option<[f64; 3]>,
    /// Lower corner of the first voxel of a raw volume [default: 0,0,0]
    #[arg(long, value_name = "X,Y,Z", value_parser = corner, requires = "extents", allow_hyphen_values = true)]
    corner: Option<[f64; 3]>,
    /// Bytes of a raw volume before its first sample [default: 0]
    #[arg(long, value_name = "BYTES", requires = "extents")]
    skip: Option<u64>,
    /// The first byte of each sample of a raw volume is the most significant one
    #[arg(long, requires = "extents")]
    big_endian: bool,
}

fn threshold(text: &str) -> Result<f64, String> {
    number(text, "a number", |_| true)
}

fn extents(text: &str) -> Result<[u32; 3], String> {
    numbers(text).ok_or_else(|| "expected three whole numbers: nx,ny,nz".into())
}

fn spacing(text: &str) -> Result<[f64; 3], String> {
    match list(text).as_deref() {
        Some(&[edge]) => Ok([edge; 3]),
        Some(&[x, y, z]) => Ok([x, y, z]),
        _ => Err("expected one number, or three: sx,sy,sz".into()),
    }
}

fn corner(text: &str) -> Result<[f64; 3], String> {
    numbers(text).ok_or_else(|| "expected three numbers: x,y,z".into())
}

fn kinds() -> impl TypedValueParser<Value = SampleKind> {
    let bits = "Eight to a byte, the lowest first; each row along x begins with a byte of its own";
    let names = SampleKind::ALL.map(|kind| {
        let name = PossibleValue::new(kind.name());
        if kind == SampleKind::Bit { name.help(bits) } else { name }
    });
    let of = |name: String| SampleKind::ALL.into_iter().find(|kind| kind.name() == name);
    PossibleValuesParser::new(names).try_map(move |name| of(name).ok_or("is no type of samples"))
}

/// A volume as a solid.
pub struct Voxels {
    pub solid: AnySolid,
    /// The frame whose finest cells are the voxels, if the voxels are cubes along the axes.
    pub frame: Option<Frame>,
    pub unit: Option<LengthUnit>,
    pub volume: Volume<'static>,
    /// The map from the grid to its place, if its axes are not x, y and z.
    pub placement: Option<Affine>,
    pub format: String,
    pub kind: SampleKind,
    pub threshold: f64,
}

/// The contents of a file.
struct Found {
    samples: Samples<'static>,
    grid: VoxelGrid,
    placement: Option<Affine>,
    unit: Option<LengthUnit>,
    format: String,
    kind: SampleKind,
    rounded: u64,
}

impl Sampling {
    /// True if the user states that files are volumes without headers.
    pub fn is_raw(&self) -> bool {
        self.extents.is_some()
    }

    /// Refuses the options for volumes if something else is read; `what` names it.
    pub fn refuse(&self, input: &Input, what: &str) -> Result<(), Failure> {
        // (All others require --extents.)
        let given = [("--threshold", self.threshold.is_some()), ("--extents", self.is_raw())];
        match given.into_iter().find(|option| option.1) {
            Some((option, _)) => Err(Failure::Usage(format!("{option} is for volumes: {input} is {what}"))),
            None => Ok(()),
        }
    }

    /// Reads the volume in a file with these bytes. The samples may be in another file beside it.
    pub fn read(&self, input: &Input, bytes: &[u8]) -> Result<Voxels, Failure> {
        self.parted(input, bytes, default_threshold)
    }

    /// Reads a volume whose samples are values, so that the threshold does not matter.
    pub fn read_values(&self, input: &Input, bytes: &[u8]) -> Result<Voxels, Failure> {
        self.parted(input, bytes, |_, _, kind| kind.half_range())
    }

    fn parted(
        &self,
        input: &Input,
        bytes: &[u8],
        default: impl Fn(&Input, &Samples<'_>, SampleKind) -> f64,
    ) -> Result<Voxels, Failure> {
        let found = match self.extents {
            Some(extents) => self.without_header(input, bytes, extents)?,
            None => with_header(input, bytes)?,
        };
        if found.rounded > 0 {
            let samples = counted(found.rounded, "sample was", "samples were");
            complain(&format!("{input}: warning: {samples} rounded to single precision"));
        }
        let Found { samples, grid, placement, unit, format, kind, .. } = found;
        let threshold = self.threshold.unwrap_or_else(|| default(input, &samples, kind));
        let band = Band::at_least(threshold).of(input)?;
        let volume = Volume::new(samples, &grid, band, &Control::default()).of(input)?;
        let solid = AnySolid::new(volume.clone());
        let solid = match &placement {
            Some(placement) => solid.placed(placement).of(input)?,
            None => solid,
        };
        let frame = if placement.is_none() { grid.frame().ok() } else { None };
        Ok(Voxels { solid, frame, unit, volume, placement, format, kind, threshold })
    }

    fn without_header(&self, input: &Input, bytes: &[u8], extents: [u32; 3]) -> Result<Found, Failure> {
        let grid = VoxelGrid::new(extents, self.corner.unwrap_or([0.0; 3]), self.spacing.unwrap_or([1.0; 3]));
        let grid = grid.map_err(|error| Failure::Usage(error.to_string()))?;
        let kind = self.kind.unwrap_or(SampleKind::U8);
        let layout = RawVolume { grid, kind, big_endian: self.big_endian, skip: self.skip.unwrap_or(0) };
        let (samples, rounded) = read_raw_volume(bytes, &layout).of(input)?;
        Ok(Found { samples, grid, placement: None, unit: None, format: "raw".into(), kind, rounded })
    }
}

/// Returns the threshold if the user names none.
fn default_threshold(input: &Input, samples: &Samples<'_>, kind: SampleKind) -> f64 {
    let half = kind.half_range();
    let Some([least, greatest]) = histogram::range(samples) else { return half };
    if least < half && half <= greatest {
        return half;
    }
    // (A constant volume is all inside, or all outside.)
    let Some(best) = histogram::best_threshold(samples) else { return half };
    let range = format!(
        "its samples range from {} to {}, all on one side of {}",
        told(least),
        told(greatest),
        told(half)
    );
    complain(&format!(
        "{input}: note: {range}: they are inside from {} on, the threshold that separates them best; \
         --threshold chooses another",
        told(best)
    ));
    best
}

fn with_header(input: &Input, bytes: &[u8]) -> Result<Found, Failure> {
    let file = match (input.path(), volume_data_file(bytes).of(input)?) {
        (Some(path), Some(_)) => open_volume(path).map_err(|error| match &error {
            // The header, or the file of its samples.
            Error::File { path, .. } => Failure::of(path.display(), error.text()),
            _ => Failure::of(input, error.text()),
        })?,
        _ => read_volume(bytes, None).of(input)?,
    };
    Ok(Found {
        samples: file.samples,
        grid: file.grid,
        placement: file.placement,
        unit: file.unit,
        format: file.format.to_string(),
        kind: file.kind,
        rounded: file.rounded,
    })
}

impl Voxels {
    /// Returns the volume under a map.
    pub fn placed(self, map: &Affine) -> Result<Voxels, Error> {
        let placement = match &self.placement {
            Some(own) => after(map, own)?,
            None => *map,
        };
        let solid = AnySolid::new(self.volume.clone()).placed(&placement)?;
        let frame = self.frame.and_then(|frame| image(&frame, map));
        Ok(Voxels { solid, frame, placement: Some(placement), ..self })
    }

    /// Returns the samples as values at points.
    pub fn attribute(&self, interpolation: Interpolation) -> Result<Box<dyn Attribute>, Error> {
        let samples = VolumeAttribute::new(self.volume.clone(), interpolation);
        Ok(match &self.placement {
            Some(placement) => Box::new(MovedAttribute::new(samples, placement.inverse()?)),
            None => Box::new(samples),
        })
    }
}
