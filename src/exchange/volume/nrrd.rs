//! Headers of NRRD files, versions 1 to 5, as defined by the authors of the format (teem).

use super::super::LengthUnit;
use super::header::{Encoding, Header, Line, Lines, Place, Skip, extents, number};
use super::kind::SampleKind;
use super::place::Axes;
use crate::error::{Error, VolumeFileError};
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;

/// The first bytes of every file, before the version.
pub(super) const MAGIC: &[u8] = b"NRRD000";

/// Maximum number of axes of a file.
const MOST_AXES: u64 = 16;

/// The fields that are used.
#[derive(Default)]
struct Fields<'a> {
    dimension: Option<Line<'a>>,
    space: Option<Line<'a>>,
    space_dimension: Option<Line<'a>>,
    kinds: Option<Line<'a>>,
    thicknesses: Option<Line<'a>>,
    kind: Option<Line<'a>>,
    sizes: Option<Line<'a>>,
    encoding: Option<Line<'a>>,
    endian: Option<Line<'a>>,
    spacings: Option<Line<'a>>,
    mins: Option<Line<'a>>,
    maxs: Option<Line<'a>>,
    centers: Option<Line<'a>>,
    directions: Option<Line<'a>>,
    origin: Option<Line<'a>>,
    units: Option<Line<'a>>,
    line_skip: Option<Line<'a>>,
    byte_skip: Option<Line<'a>>,
    data_file: Option<Line<'a>>,
}

pub(super) fn header(bytes: &[u8]) -> Result<Header, Error> {
    let mut lines = Lines::new(bytes);
    let version = lines.next().and_then(|line| line.strip_prefix(MAGIC)).unwrap_or(b"");
    if !matches!(version.trim_ascii_end(), [b'1'..=b'5']) {
        return Err(VolumeFileError::Syntax { line: 1, expected: "NRRD0001 to NRRD0005" }.into());
    }
    let mut fields = Fields::default();
    while let Some(line) = lines.next() {
        if line.is_empty() {
            break;
        }
        if line.starts_with(b"#") {
            continue;
        }
        take(&mut fields, line, lines.number)?;
    }
    let needed = |field: Option<_>, what| field.ok_or(VolumeFileError::Missing { what });
    let kind_line: Line<'_> = needed(fields.kind, "type")?;
    let kind =
        kind_of(kind_line.value).ok_or_else(|| kind_line.error("a type of numbers of up to 64 bits"))?;
    let encoding: Line<'_> = needed(fields.encoding, "encoding")?;
    let encoding = encoding_of(&encoding)?;
    let has_order = encoding != Encoding::Text && !matches!(kind, SampleKind::I8 | SampleKind::U8);
    // An invalid word is refused even if the byte order does not matter.
    let big = match fields.endian {
        Some(line) if line.value.eq_ignore_ascii_case("little") => false,
        Some(line) if line.value.eq_ignore_ascii_case("big") => true,
        Some(line) => return Err(line.error("little or big").into()),
        None if !has_order => false,
        None => return Err(VolumeFileError::Missing { what: "endian" }.into()),
    };
    let dimension: Line<'_> = needed(fields.dimension, "dimension")?;
    let [count] = dimension.whole::<1>("a number of axes")?;
    if !(1..=MOST_AXES).contains(&count) {
        return Err(dimension.error("1 to 16 axes").into());
    }
    let sizes: Line<'_> = needed(fields.sizes, "sizes")?;
    let all = list(&sizes, count, "as many sizes as axes", |word| word.parse().ok())?;
    let (extents, chosen) = extents(&all, &sizes)?;
    if let Some(line) = fields.kinds {
        kinds(&line, &extents, chosen, count)?;
    }
    let axes = axes(&fields, extents, chosen, count)?;
    let lines_before = fields.line_skip.map_or(Ok([0]), |line| line.whole("a number of lines"))?[0];
    let skip = match fields.byte_skip {
        Some(line) if line.value == "-1" && encoding == Encoding::Raw => Skip::Rest,
        Some(line) => Skip::Bytes(line.whole::<1>("a number of bytes, or -1 of raw samples")?[0]),
        None => Skip::Bytes(0),
    };
    let place = match fields.data_file {
        Some(line) if line.value.starts_with("LIST") || line.value.contains('%') => {
            return Err(VolumeFileError::Unsupported { what: "samples in several files" }.into());
        }
        Some(line) if line.value.is_empty() => return Err(line.error("the name of a file").into()),
        Some(line) => Place::There(line.text()?),
        None => Place::Here(lines.taken),
    };
    let unit = fields.units.and_then(|line| unit_of(line.value));
    Ok(Header {
        extents,
        kind,
        big,
        encoding,
        lines: lines_before,
        skip,
        skips_compressed: false,
        compressed: None,
        place,
        axes,
        unit,
    })
}

/// Processes a line. Field names ignore letter case, and most may be written without their blank.
fn take<'a>(fields: &mut Fields<'a>, line: &'a [u8], number: u64) -> Result<(), Error> {
    let wrong = |expected| Error::from(VolumeFileError::Syntax { line: number, expected });
    // Keys and values of other programs may be any text.
    let Some(colon) = line.iter().position(|&byte| byte == b':') else {
        return Err(wrong("a field, a colon and a blank, or an empty line before the samples"));
    };
    let (name, value) = (&line[..colon], &line[colon + 1..]);
    if value.starts_with(b"=") {
        return Ok(());
    }
    let mut normal = [0; 24];
    let mut length = 0;
    for byte in name.iter().filter(|&&byte| byte != b' ') {
        let Some(place) = normal.get_mut(length) else { return Err(wrong("a field of the format")) };
        *place = byte.to_ascii_lowercase();
        length += 1;
    }
    let value = core::str::from_utf8(value).map_err(|_| wrong("a value in UTF-8"))?.trim_ascii();
    let line = Line { number, value };
    let field = match &normal[..length] {
        b"dimension" => &mut fields.dimension,
        b"type" => &mut fields.kind,
        b"sizes" => &mut fields.sizes,
        b"encoding" => &mut fields.encoding,
        b"endian" => &mut fields.endian,
        b"spacings" => &mut fields.spacings,
        b"axismins" => &mut fields.mins,
        b"axismaxs" => &mut fields.maxs,
        b"centers" | b"centerings" => &mut fields.centers,
        b"spacedirections" => &mut fields.directions,
        b"spaceorigin" => &mut fields.origin,
        b"spaceunits" | b"units" => &mut fields.units,
        b"lineskip" => &mut fields.line_skip,
        b"byteskip" => &mut fields.byte_skip,
        b"datafile" => &mut fields.data_file,
        b"space" => &mut fields.space,
        b"spacedimension" => &mut fields.space_dimension,
        b"kinds" => &mut fields.kinds,
        b"thicknesses" => &mut fields.thicknesses,
        // These fields do not concern the samples or their positions.
        b"content" | b"number" | b"min" | b"max" | b"oldmin" | b"oldmax" | b"labels" | b"sampleunits"
        | b"measurementframe" | b"blocksize" => return Ok(()),
        _ => return Err(wrong("a field of the format")),
    };
    if field.is_some() {
        return Err(wrong("each field once"));
    }
    *field = Some(line);
    Ok(())
}

/// Parses one word for each axis.
fn list<T>(
    line: &Line<'_>,
    count: u64,
    expected: &'static str,
    parse: impl Fn(&str) -> Option<T>,
) -> Result<Vec<T>, Error> {
    let mut found = Vec::new();
    for word in line.value.split_ascii_whitespace().take(count as usize + 1) {
        memory::push(&mut found, parse(word).ok_or_else(|| line.error(expected))?)?;
    }
    if found.len() as u64 == count { Ok(found) } else { Err(line.error(expected).into()) }
}

/// Refuses axes whose numbers belong together, such as colours: an axis of more than one sample must be a
/// space axis, a time axis, or of unknown kind.
fn kinds(line: &Line<'_>, extents: &[u32; 3], chosen: [usize; 3], count: u64) -> Result<(), Error> {
    let all = list(line, count, "a kind of the format for each axis", is_domain)?;
    for (&extent, &axis) in extents.iter().zip(&chosen) {
        if extent > 1 && all.get(axis) == Some(&false) {
            return Err(VolumeFileError::Unsupported { what: "samples of several numbers" }.into());
        }
    }
    Ok(())
}

/// Returns whether samples follow each other along an axis of this kind; `None` for an unknown kind.
fn is_domain(kind: &str) -> Option<bool> {
    const DOMAINS: [&str; 5] = ["domain", "space", "time", "none", "???"];
    const OTHERS: [&str; 28] = [
        "list",
        "point",
        "vector",
        "covariant-vector",
        "normal",
        "stub",
        "scalar",
        "complex",
        "2-vector",
        "3-color",
        "RGB-color",
        "HSV-color",
        "XYZ-color",
        "4-color",
        "RGBA-color",
        "3-vector",
        "3-gradient",
        "3-normal",
        "4-vector",
        "quaternion",
        "2D-symmetric-matrix",
        "2D-masked-symmetric-matrix",
        "2D-matrix",
        "2D-masked-matrix",
        "3D-symmetric-matrix",
        "3D-masked-symmetric-matrix",
        "3D-matrix",
        "3D-masked-matrix",
    ];
    let is_one_of = |names: &[&str]| names.iter().any(|&name| is_word(kind, name));
    if is_one_of(&DOMAINS) { Some(true) } else { is_one_of(&OTHERS).then_some(false) }
}

/// Returns whether a word is this name of the format, ignoring hyphens and letter case.
fn is_word(word: &str, name: &str) -> bool {
    let plain = |text| str::bytes(text).filter(|&byte| byte != b'-').map(|byte| byte.to_ascii_lowercase());
    plain(word).eq(plain(name))
}

/// Refuses a space that is not three-dimensional, or that the format does not define.
fn check_space(fields: &Fields<'_>) -> Result<(), Error> {
    const SPACES: [&str; 9] = [
        "right-anterior-superior",
        "RAS",
        "left-anterior-superior",
        "LAS",
        "left-posterior-superior",
        "LPS",
        "scanner-xyz",
        "3D-right-handed",
        "3D-left-handed",
    ];
    const EXPECTED: &str = "a space of three dimensions";
    if let Some(line) = fields.space
        && !SPACES.iter().any(|&space| is_word(line.value, space))
    {
        return Err(line.error(EXPECTED).into());
    }
    match fields.space_dimension {
        Some(line) if line.whole("a number")? != [3] => Err(line.error(EXPECTED).into()),
        _ => Ok(()),
    }
}

/// Parses a number for each axis of the file; NaN stands for an axis without one.
fn numbers(line: Option<Line<'_>>, count: u64, expected: &'static str) -> Result<Option<Vec<f64>>, Error> {
    let number = |word: &str| word.parse::<f64>().ok().filter(|x| !x.is_infinite());
    line.map(|line| list(&line, count, expected, number)).transpose()
}

/// Returns the positions of the samples: from directions in space; else from spacings and the ends of axes;
/// else one unit apart, starting at 0.
fn axes(fields: &Fields<'_>, extents: [u32; 3], chosen: [usize; 3], count: u64) -> Result<Axes, Error> {
    check_space(fields)?;
    let of = |line| numbers(line, count, "a finite number, or nan, for each axis");
    let (all_spacings, all_mins, all_maxs) = (of(fields.spacings)?, of(fields.mins)?, of(fields.maxs)?);
    of(fields.thicknesses)?;
    if let (Some(line), Some(spacings)) = (fields.spacings, &all_spacings)
        && spacings.iter().any(|&spacing| spacing < 0.0)
    {
        return Err(line.error("spacings above zero, or nan").into());
    }
    let centres = match fields.centers {
        Some(line) => {
            let all = list(&line, count, "cell, node or none for each axis", |word| match word {
                "cell" => Some(true),
                "node" | "none" | "???" => Some(false),
                _ => None,
            })?;
            chosen.each(|axis| all.get(axis).copied())
        }
        None => [None; 3],
    };
    if let Some(line) = fields.directions {
        let given = [(fields.spacings, all_spacings), (fields.mins, all_mins), (fields.maxs, all_maxs)];
        return in_space(fields, &line, chosen, count, &given);
    }
    if let Some(line) = fields.origin {
        return Err(line.error("space directions as well, because an origin in space needs them").into());
    }
    let chosen_ones = |line: Option<Line<'_>>, all: Option<Vec<f64>>, default: f64| {
        let (Some(line), Some(all)) = (line, all) else { return Ok([None; 3]) };
        let mut found = [Some(default); 3];
        for (place, &axis) in found.iter_mut().zip(&chosen) {
            if let Some(&given) = all.get(axis) {
                if given.is_nan() {
                    return Err(Error::from(
                        line.error("finite numbers for all axes of more than one sample"),
                    ));
                }
                *place = Some(given);
            }
        }
        Ok(found)
    };
    let spacings = chosen_ones(fields.spacings, all_spacings, 1.0)?;
    let mins = chosen_ones(fields.mins, all_mins, 0.0)?;
    let maxs = chosen_ones(fields.maxs, all_maxs, 1.0)?;
    let is_cell = |axis: usize| centres[axis].unwrap_or(false);
    let mut found = Axes::along([1.0; 3], [0.0; 3]);
    for axis in 0..3 {
        let samples = f64::from(extents[axis]);
        let steps = if is_cell(axis) { samples } else { (samples - 1.0).max(1.0) };
        let spacing = match (spacings[axis], mins[axis], maxs[axis]) {
            (Some(spacing), ..) => spacing,
            (None, Some(min), Some(max)) if chosen[axis] != usize::MAX => (max - min) / steps,
            _ => 1.0,
        };
        found.steps[axis][axis] = spacing;
        let min = mins[axis].unwrap_or(0.0);
        // The end of a cell-centred axis is half a spacing before the first sample.
        found.origin[axis] = if is_cell(axis) && mins[axis].is_some() { min + 0.5 * spacing } else { min };
    }
    Ok(found)
}

fn in_space(
    fields: &Fields<'_>,
    line: &Line<'_>,
    chosen: [usize; 3],
    count: u64,
    given: &[(Option<Line<'_>>, Option<Vec<f64>>)],
) -> Result<Axes, Error> {
    const EXPECTED: &str = "a vector (x,y,z) or none for each axis";
    let mut all: Vec<Option<[f64; 3]>> = Vec::new();
    let mut rest = line.value;
    while !rest.is_empty() {
        let (found, behind) = match rest.strip_prefix("none") {
            Some(behind) => (None, behind),
            None => {
                let (inner, behind) = rest.split_once(')').ok_or_else(|| line.error(EXPECTED))?;
                (Some(vector(inner).ok_or_else(|| line.error(EXPECTED))?), behind)
            }
        };
        if all.len() as u64 == count {
            return Err(line.error(EXPECTED).into());
        }
        memory::push(&mut all, found)?;
        rest = behind.trim_ascii_start();
    }
    if all.len() as u64 != count {
        return Err(line.error(EXPECTED).into());
    }
    // According to the format, an axis with a direction has no other position data.
    for (line, numbers) in given {
        let (Some(line), Some(numbers)) = (line, numbers) else { continue };
        if numbers.iter().zip(&all).any(|(number, direction)| !number.is_nan() && direction.is_some()) {
            return Err(line.error("nan for each axis that has a space direction").into());
        }
    }
    let mut axes = Axes::along([1.0; 3], [0.0; 3]);
    let mut taken = 0;
    for (place, &axis) in axes.steps.iter_mut().zip(&chosen) {
        if axis != usize::MAX {
            *place = all.get(axis).copied().flatten().ok_or_else(|| line.error(EXPECTED))?;
            taken += 1;
        }
    }
    if taken < 3 {
        return Err(line.error("directions of three axes").into());
    }
    if let Some(line) = fields.origin {
        let inner = line.value.strip_suffix(')').and_then(vector);
        axes.origin = inner.ok_or_else(|| line.error("a point (x,y,z)"))?;
    }
    Ok(axes)
}

/// Parses `(x,y,z`.
fn vector(text: &str) -> Option<[f64; 3]> {
    let mut parts = text.trim_ascii().strip_prefix('(')?.split(',').map(|part| number(part.trim_ascii()));
    let found = [parts.next()??, parts.next()??, parts.next()??];
    parts.next().is_none().then_some(found)
}

fn encoding_of(line: &Line<'_>) -> Result<Encoding, Error> {
    let unsupported = |what| Err(VolumeFileError::Unsupported { what }.into());
    let is = |names: &[&str]| names.iter().any(|name| line.value.eq_ignore_ascii_case(name));
    if is(&["raw"]) {
        Ok(Encoding::Raw)
    } else if is(&["gz", "gzip"]) {
        Ok(Encoding::Deflated)
    } else if is(&["txt", "text", "ascii"]) {
        Ok(Encoding::Text)
    } else if is(&["bz2", "bzip2"]) {
        unsupported("NRRD compressed by bzip2")
    } else if is(&["hex"]) {
        unsupported("NRRD in hexadecimal digits")
    } else if is(&["zrl"]) {
        unsupported("NRRD compressed by run lengths of zeros")
    } else {
        Err(line.error("raw, gzip, bzip2, ascii or hex").into())
    }
}

fn kind_of(name: &str) -> Option<SampleKind> {
    Some(match name {
        "signed char" | "int8" | "int8_t" => SampleKind::I8,
        "uchar" | "unsigned char" | "uint8" | "uint8_t" => SampleKind::U8,
        "short" | "short int" | "signed short" | "signed short int" | "int16" | "int16_t" => SampleKind::I16,
        "ushort" | "unsigned short" | "unsigned short int" | "uint16" | "uint16_t" => SampleKind::U16,
        "int" | "signed int" | "int32" | "int32_t" => SampleKind::I32,
        "uint" | "unsigned int" | "uint32" | "uint32_t" => SampleKind::U32,
        "longlong"
        | "long long"
        | "long long int"
        | "signed long long"
        | "signed long long int"
        | "int64"
        | "int64_t" => SampleKind::I64,
        "ulonglong" | "unsigned long long" | "unsigned long long int" | "uint64" | "uint64_t" => {
            SampleKind::U64
        }
        "float" => SampleKind::F32,
        "double" => SampleKind::F64,
        _ => return None,
    })
}

/// Returns the common unit of all axes in space, as in `"mm" "mm" "mm"`.
fn unit_of(value: &str) -> Option<LengthUnit> {
    let mut named = value.split('"').skip(1).step_by(2).filter(|name| !name.is_empty());
    let first = named.next()?;
    named.all(|name| name == first).then(|| first.parse().ok()).flatten()
}
