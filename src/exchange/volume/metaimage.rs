//! Headers of MetaImage files, according to MetaIO, the library that defines the format.

use super::super::LengthUnit;
use super::header::{Encoding, Header, Line, Lines, Place, Skip, extents};
use super::kind::SampleKind;
use super::place::Axes;
use crate::error::{Error, VolumeFileError};
use crate::memory;
use alloc::vec::Vec;

/// The last field of a header.
pub(super) const LAST: &[u8] = b"ElementDataFile";

/// Number of bytes from the start within which it must be found.
const LONGEST: usize = 1 << 16;

/// Returns whether the bytes are, or begin with, a MetaImage header.
pub(super) fn is_header(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(LONGEST)];
    let first = start.split(|&byte| byte == b'\n').next().unwrap_or(b"");
    let word = first.trim_ascii_start().first().is_some_and(u8::is_ascii_alphabetic);
    word && first.contains(&b'=') && start.windows(LAST.len()).any(|window| window == LAST)
}

#[derive(Default)]
struct Fields<'a> {
    dimensions: Option<Line<'a>>,
    sizes: Option<Line<'a>>,
    kind: Option<Line<'a>>,
    spacing: Option<Line<'a>>,
    /// The size of a voxel, which is the spacing if the spacing is missing.
    size: Option<Line<'a>>,
    offset: Option<Line<'a>>,
    matrix: Option<Line<'a>>,
    binary: Option<Line<'a>>,
    msb: Option<Line<'a>>,
    compressed: Option<Line<'a>>,
    compressed_size: Option<Line<'a>>,
    header_size: Option<Line<'a>>,
    channels: Option<Line<'a>>,
    units: Option<Line<'a>>,
    object: Option<Line<'a>>,
}

pub(super) fn header(bytes: &[u8]) -> Result<Header, Error> {
    let mut lines = Lines::new(bytes);
    let mut fields = Fields::default();
    let place = loop {
        let Some(line) = lines.next().filter(|_| lines.number <= LONGEST as u64) else {
            return Err(VolumeFileError::Missing { what: "ElementDataFile" }.into());
        };
        if let Some(file) = take(&mut fields, line, lines.number)? {
            break match file.value {
                "LOCAL" | "Local" | "local" => Place::Here(lines.taken),
                name if name.starts_with("LIST") || name.contains('%') => {
                    return Err(VolumeFileError::Unsupported { what: "samples in several files" }.into());
                }
                "" => return Err(file.error("LOCAL, or the name of a file").into()),
                _ => Place::There(file.text()?),
            };
        }
    };
    if let Some(line) = fields.object.filter(|line| !line.value.eq_ignore_ascii_case("Image")) {
        return Err(line.error("the object type Image").into());
    }
    if let Some(line) = fields.channels.filter(|line| line.value != "1") {
        return Err(line.error("one channel").into());
    }
    let flag = |line: Option<Line<'_>>, default: bool| match line {
        None => Ok(default),
        Some(line) => {
            let is_one_of = |names: [&str; 3]| names.iter().any(|name| line.value.eq_ignore_ascii_case(name));
            match (is_one_of(["true", "t", "1"]), is_one_of(["false", "f", "0"])) {
                (true, _) => Ok(true),
                (_, true) => Ok(false),
                _ => Err(line.error("True or False")),
            }
        }
    };
    let needed = |field: Option<_>, what| field.ok_or(VolumeFileError::Missing { what });
    let kind: Line<'_> = needed(fields.kind, "ElementType")?;
    let kind = kind_of(kind.value).ok_or_else(|| kind.error("a type of single numbers, as MET_SHORT"))?;
    let binary = flag(fields.binary, true)?;
    let compressed = flag(fields.compressed, false)?;
    if let (Some(line), false, true) = (fields.binary, binary, compressed) {
        return Err(line.error("True, as CompressedData is").into());
    }
    let encoding = match (binary, compressed) {
        (_, true) => Encoding::Deflated,
        (true, false) => Encoding::Raw,
        (false, false) => Encoding::Text,
    };
    let dimensions: Line<'_> = needed(fields.dimensions, "NDims")?;
    let [count] = dimensions.whole::<1>("a number of axes")?;
    if !(1..=10).contains(&count) {
        return Err(dimensions.error("1 to 10 axes").into());
    }
    let sizes: Line<'_> = needed(fields.sizes, "DimSize")?;
    let all = list(&sizes, count, |word| word.parse::<u64>().ok())?;
    let (extents, chosen) = extents(&all, &sizes)?;
    let axes = axes(&fields, chosen, count as usize)?;
    let skip = match fields.header_size {
        Some(line) if line.value == "-1" && encoding == Encoding::Raw => Skip::Rest,
        Some(line) if line.value == "-1" => return Err(line.error("-1 of raw samples only").into()),
        Some(line) => Skip::Bytes(line.whole::<1>("a number of bytes, or -1")?[0]),
        None => Skip::Bytes(0),
    };
    let size = fields.compressed_size.map(|line| line.whole::<1>("a number of bytes")).transpose()?;
    Ok(Header {
        extents,
        kind,
        big: flag(fields.msb, false)?,
        encoding,
        lines: 0,
        skip,
        skips_compressed: true,
        compressed: size.map(|[size]| size).filter(|&size| size > 0),
        place,
        axes,
        unit: fields.units.and_then(|line| line.value.parse::<LengthUnit>().ok()),
    })
}

/// Processes a line. Returns the last line, which names the location of the samples.
fn take<'a>(fields: &mut Fields<'a>, line: &'a [u8], number: u64) -> Result<Option<Line<'a>>, Error> {
    let wrong = |expected| Error::from(VolumeFileError::Syntax { line: number, expected });
    if line.trim_ascii().is_empty() {
        return Ok(None);
    }
    let equals =
        line.iter().position(|&byte| byte == b'=').ok_or_else(|| wrong("a field, = and its value"))?;
    let (name, value) = (line[..equals].trim_ascii(), line[equals + 1..].trim_ascii());
    let field = match name {
        b"NDims" => &mut fields.dimensions,
        b"DimSize" => &mut fields.sizes,
        b"ElementType" => &mut fields.kind,
        b"ElementSpacing" => &mut fields.spacing,
        b"ElementSize" => &mut fields.size,
        b"Offset" | b"Position" | b"Origin" => &mut fields.offset,
        b"TransformMatrix" | b"Rotation" | b"Orientation" => &mut fields.matrix,
        b"BinaryData" => &mut fields.binary,
        b"BinaryDataByteOrderMSB" | b"ElementByteOrderMSB" => &mut fields.msb,
        b"CompressedData" => &mut fields.compressed,
        b"CompressedDataSize" => &mut fields.compressed_size,
        b"HeaderSize" => &mut fields.header_size,
        b"ElementNumberOfChannels" => &mut fields.channels,
        b"DistanceUnits" => &mut fields.units,
        b"ObjectType" => &mut fields.object,
        _ if name == LAST => {
            let value = core::str::from_utf8(value).map_err(|_| wrong("a name in UTF-8"))?;
            return Ok(Some(Line { number, value }));
        }
        // Other fields do not concern the samples or their positions; names and comments may contain any
        // bytes.
        _ => return Ok(None),
    };
    let value = core::str::from_utf8(value).map_err(|_| wrong("a value in UTF-8"))?;
    // MetaIO uses the last occurrence.
    *field = Some(Line { number, value });
    Ok(None)
}

fn list<T>(line: &Line<'_>, count: u64, parse: impl Fn(&str) -> Option<T>) -> Result<Vec<T>, Error> {
    const EXPECTED: &str = "as many finite numbers as axes, or axes squared";
    let mut found = Vec::new();
    for word in line.value.split_ascii_whitespace().take(count as usize + 1) {
        memory::push(&mut found, parse(word).ok_or_else(|| line.error(EXPECTED))?)?;
    }
    if found.len() as u64 == count { Ok(found) } else { Err(line.error(EXPECTED).into()) }
}

fn axes(fields: &Fields<'_>, chosen: [usize; 3], count: usize) -> Result<Axes, Error> {
    let numbers = |line: Option<Line<'_>>, count: usize| {
        line.map(|line| list(&line, count as u64, super::header::number)).transpose()
    };
    let (spacing, size) = (numbers(fields.spacing, count)?, numbers(fields.size, count)?);
    for (line, all) in [(fields.spacing, &spacing), (fields.size, &size)] {
        if let (Some(line), Some(all)) = (line, all)
            && all.iter().any(|&number| number < 0.0)
        {
            return Err(line.error("numbers above zero").into());
        }
    }
    let spacing = spacing.or(size);
    let offset = numbers(fields.offset, count)?;
    let matrix = numbers(fields.matrix, count * count)?;
    let of = |list: &Option<Vec<f64>>, axis: usize, default: f64| {
        list.as_ref().and_then(|list| list.get(axis)).copied().unwrap_or(default)
    };
    let mut axes = Axes::along([1.0; 3], [0.0; 3]);
    // The directions are vectors in the space of the axes that are read.
    for (axis, &own) in chosen.iter().enumerate() {
        if own == usize::MAX {
            continue;
        }
        axes.origin[axis] = of(&offset, own, 0.0);
        for (i, &other) in chosen.iter().enumerate() {
            let identity = if axis == i { 1.0 } else { 0.0 };
            let direction =
                if other == usize::MAX { identity } else { of(&matrix, own * count + other, identity) };
            axes.steps[axis][i] = direction * of(&spacing, own, 1.0);
        }
    }
    Ok(axes)
}

fn kind_of(name: &str) -> Option<SampleKind> {
    Some(match name {
        "MET_CHAR" => SampleKind::I8,
        "MET_UCHAR" => SampleKind::U8,
        "MET_SHORT" => SampleKind::I16,
        "MET_USHORT" => SampleKind::U16,
        // MetaIO's `long` has four bytes.
        "MET_INT" | "MET_LONG" => SampleKind::I32,
        "MET_UINT" | "MET_ULONG" => SampleKind::U32,
        "MET_LONG_LONG" => SampleKind::I64,
        "MET_ULONG_LONG" => SampleKind::U64,
        "MET_FLOAT" => SampleKind::F32,
        "MET_DOUBLE" => SampleKind::F64,
        _ => return None,
    })
}
