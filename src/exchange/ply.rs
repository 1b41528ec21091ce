//! PLY files: ASCII and binary of both byte orders.
//!
//! **Header.** `ply`, one `format` (`ascii`, `binary_little_endian` or `binary_big_endian`, version 1.0),
//! elements with their properties, and `end_header`. `comment` and `obj_info` may stand on any line between.
//! Lines end with LF, CR or both. Other lines before the first element are taken for comments, with a warning:
//! Blender 2.47 and Assimp 3.0 forgot the keyword. The types are `char`, `uchar`, `short`, `ushort`, `int`, `uint`, `float`,
//! `double` and the same as `int8` to `float64`. A keyword or a type that is none of these is refused.
//!
//! **Colours.** Vertices and faces may have the properties `red`, `green` and `blue`, and `alpha`; or
//! `diffuse_red` and so on. Integers are from 0 to 255, but `ushort` from 0 to 65 535, and floating point numbers
//! from 0 to 1. The colour of an element that has another number, or no number, is left out, with a warning.
//!
//! **Elements** come in any order; those of other names, and all properties that are not needed, single ones
//! and lists, are skipped. `vertex` needs `x`, `y` and `z` of any type. `face` needs a list of integers that
//! is called `vertex_indices` or `vertex_index`, of three or more vertices each; without such a list, and with
//! a warning, there may be none. `tristrips`, as the Stanford
//! scans have it, needs a list of that name, in which -1 ends a strip; every second triangle is turned.
//!
//! **ASCII.** The values of an element are separated by white space, also by line ends; each element begins
//! on a new line. If the first element of a kind has more values on its line than the header announces, these
//! are skipped, with a warning; then every element of the kind must have as many. A decimal coordinate becomes the nearest `f64`, also if its type is `float`.
//!
//! **Binary.** Coordinates are taken over exactly.
//!
//! **The end.** Behind the last element only white space, zero bytes and Ctrl-Z may follow: if there is more,
//! the header's counts are wrong. Nothing is allocated that a header claims and a file does not hold.

use alloc::vec::Vec;

use super::bytes::{Bytes, TOO_LONG, TOO_SHORT};
use super::colours::{self, Colours};
use super::polygons::Polygons;
use super::text::Text;
use super::{MeshWarning, decimal, is_line_end, refuse_utf16};
use crate::error::{Error, MeshFileError};
use crate::memory;
use crate::mesh::{MeshAttribute, TriangleMesh};

/// Reads a PLY file, ASCII or binary.
///
/// Triangles keep the order of the faces. A face of more than three corners is cut into triangles that do not
/// leave it; only where that cannot be, because its edges cross or it has no area, into the fan around its
/// first corner. Equal vertices are welded, and triangles that two equal vertices make degenerate are dropped
/// and counted, as in [`TriangleMesh::new`]. The mesh need not be closed, and may be empty. Colours of vertices
/// become the attribute `colour` of corners; colours of faces the attribute `colour` of triangles, or, if there
/// are both, `face_colour`.
///
/// O(n), or O(n log n) for faces that are not convex. Memory is at most 128 times the length of the file, whatever
/// its header claims. What [`read_mesh`](super::read_mesh) warns of is not told.
///
/// # Errors
/// [`MeshFileError::Empty`], [`MeshFileError::Unsupported`] (UTF-16), [`MeshFileError::Syntax`] and
/// [`MeshFileError::Index`] (in the header, and in an ASCII file), [`MeshFileError::Binary`] and
/// [`MeshFileError::BinaryIndex`], [`MeshError::TooLarge`](crate::MeshError::TooLarge),
/// [`MeshError::TooMany`](crate::MeshError::TooMany) or [`Error::OutOfMemory`].
pub fn read_ply(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    read(bytes, &mut Vec::new())
}

/// The same, with warnings.
pub(super) fn read(bytes: &[u8], warnings: &mut Vec<MeshWarning>) -> Result<TriangleMesh, Error> {
    if bytes.is_empty() {
        return Err(MeshFileError::Empty.into());
    }
    refuse_utf16(bytes)?;
    let Header { encoding, elements, length } = Header::read(bytes, warnings)?;
    match encoding {
        Encoding::Ascii => {
            let mut text = Text::new(bytes);
            text.continue_with(text.rest().get(length..).unwrap_or(&[]));
            read_elements(&elements, text, warnings)
        }
        Encoding::Little => read_elements(&elements, Bytes::<false>::new(bytes, length), warnings),
        Encoding::Big => read_elements(&elements, Bytes::<true>::new(bytes, length), warnings),
    }
}

// ---- the header -----------------------------------------------------------------------------------------

#[derive(Clone, Copy)]
enum Encoding {
    Ascii,
    Little,
    Big,
}

/// The type of a number.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    fn of(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    /// A channel of a colour, from 0 to 255, that is stored as this number.
    #[inline]
    fn channel(self, value: f64) -> f64 {
        match self {
            Self::F32 | Self::F64 => value * 255.0,
            Self::U16 => value / 257.0,
            _ => value,
        }
    }

    /// Bytes of a binary number.
    #[inline]
    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

struct Property<'a> {
    name: &'a [u8],
    /// Of a list the type of its length.
    count: Option<Kind>,
    kind: Kind,
}

struct Element<'a> {
    /// Where the header names it.
    at: Text<'a>,
    name: &'a [u8],
    count: u64,
    properties: Vec<Property<'a>>,
}

struct Header<'a> {
    encoding: Encoding,
    elements: Vec<Element<'a>>,
    /// Bytes.
    length: usize,
}

impl<'a> Header<'a> {
    fn read(bytes: &'a [u8], warnings: &mut Vec<MeshWarning>) -> Result<Self, Error> {
        let mut text = Text::beginning(bytes);
        if text.word() != b"ply" {
            return Err(Text::beginning(bytes).error("`ply`, with which every PLY file begins").into());
        }
        text.skip_blanks();
        // Where lines end with a CR alone, an LF behind the header is part of the data.
        let old = matches!(text.rest(), [b'\r', next, ..] if *next != b'\n');
        end_line(&mut text)?;
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut strange = (0, 0);
        loop {
            text.skip_space();
            let at = text;
            match text.word() {
                b"comment" | b"obj_info" => {
                    text.skip_line();
                    continue;
                }
                b"format" if encoding.is_none() => {
                    text.skip_blanks();
                    let name = text.word();
                    text.skip_blanks();
                    encoding = Some(match (name, text.word()) {
                        (b"ascii", b"1.0") => Encoding::Ascii,
                        (b"binary_little_endian", b"1.0") => Encoding::Little,
                        (b"binary_big_endian", b"1.0") => Encoding::Big,
                        _ => return Err(at.error(FORMAT).into()),
                    });
                }
                b"element" => {
                    text.skip_blanks();
                    let name = text.word();
                    text.skip_blanks();
                    let count = text.integer().and_then(|count| u64::try_from(count).ok());
                    let count = count.ok_or_else(|| at.error("`element`, a name and a count"))?;
                    let known = matches!(name, b"vertex" | b"face" | b"tristrips");
                    if known && elements.iter().any(|element| element.name == name) {
                        return Err(at.error("every element once").into());
                    }
                    memory::push(&mut elements, Element { at, name, count, properties: Vec::new() })?;
                }
                b"property" => {
                    let property = Property::read(&mut text).ok_or_else(|| at.error(PROPERTY))?;
                    let element =
                        elements.last_mut().ok_or_else(|| at.error("an element before its properties"))?;
                    memory::push(&mut element.properties, property)?;
                }
                b"end_header" => break,
                // No property can be lost before the first element.
                word if !word.is_empty()
                    && !is_keyword(word)
                    && elements.is_empty()
                    && encoding.is_some() =>
                {
                    if strange.1 == 0 {
                        strange.0 = at.line();
                    }
                    strange.1 += 1;
                    text.skip_line();
                    continue;
                }
                _ => return Err(at.error("a line of a PLY header, up to `end_header`").into()),
            }
            end_line(&mut text)?;
        }
        let encoding = encoding.ok_or_else(|| text.error(FORMAT))?;
        if let (line, lines @ 1..) = strange {
            memory::push(warnings, MeshWarning::HeaderLine { line, lines })?;
        }
        text.skip_blanks();
        match text.rest() {
            [b'\r', b'\n', rest @ ..] if !old => text.continue_with(rest),
            [b'\r' | b'\n', rest @ ..] => text.continue_with(rest),
            [] => {}
            _ => return Err(text.error("a line end behind `end_header`").into()),
        }
        Ok(Self { encoding, elements, length: text.taken() })
    }
}

fn is_keyword(word: &[u8]) -> bool {
    matches!(word, b"ply" | b"format" | b"comment" | b"obj_info" | b"element" | b"property" | b"end_header")
}

const FORMAT: &str = "a format: `ascii`, `binary_little_endian` or `binary_big_endian`, and `1.0`";
const PROPERTY: &str =
    "`property`, a type and a name, or `property list`, two types (first an integer) and a name";

impl<'a> Property<'a> {
    /// Reads what follows `property`.
    fn read(text: &mut Text<'a>) -> Option<Self> {
        let mut word = || {
            text.skip_blanks();
            text.word()
        };
        let mut count = None;
        let mut kind = word();
        if kind == b"list" {
            count = Some(Kind::of(word()).filter(|kind| kind.is_integer())?);
            kind = word();
        }
        let kind = Kind::of(kind)?;
        let name = word();
        (!name.is_empty()).then_some(Self { name, count, kind })
    }
}

fn end_line(text: &mut Text) -> Result<(), Error> {
    text.skip_blanks();
    if !text.is_at_line_end() {
        return Err(text.error("the end of the line").into());
    }
    text.skip_line();
    Ok(())
}

// ---- the data -------------------------------------------------------------------------------------------

/// Where the values of elements come from.
trait Source: Copy {
    /// The error that something else than what comes next was expected.
    fn error(&self, expected: &'static str) -> MeshFileError;

    /// At most how many elements may still come, each of so many `values` or more, of `bytes` together.
    fn at_most(&self, values: usize, bytes: usize) -> usize;

    /// Takes a finite number.
    fn coordinate(&mut self, kind: Kind) -> Result<f64, MeshFileError>;

    /// Takes anything that stands for a number; `None` if it is not a finite one.
    fn value(&mut self, kind: Kind) -> Result<Option<f64>, MeshFileError>;

    /// Takes the length of a list.
    fn count(&mut self, kind: Kind) -> Result<u64, MeshFileError>;

    /// Takes numbers of any values, so many or of so many bytes.
    fn skip(&mut self, values: u64, bytes: u64) -> Result<(), MeshFileError>;

    /// Takes `count` indices below `vertices`; in a strip also -1, which becomes the greatest `u32`.
    fn indices(&mut self, out: &mut Vec<u32>, count: u64, of: &Indices, vertices: u64) -> Result<(), Error>;

    /// Takes the end of an element that began at `start`, and before it so many values that the header does not
    /// announce; `None`: any number, all on the line where the element began. Tells how many there were.
    fn end_element(&mut self, start: &Self, more: Option<u64>) -> Result<u64, MeshFileError>;

    /// Where something stands.
    fn line(&self) -> u64;

    /// Takes the end of the file.
    fn end_file(&mut self) -> Result<(), MeshFileError>;
}

/// A list of indices.
#[derive(Clone, Copy)]
struct Indices {
    count: Kind,
    kind: Kind,
    strips: bool,
}

/// What ends a strip. No mesh has so many vertices.
const END_OF_STRIP: u32 = u32::MAX;

/// How the next values of an element are read.
enum Step {
    /// Values that are skipped.
    Skip {
        values: u64,
        bytes: u64,
    },
    SkipList {
        count: Kind,
        kind: Kind,
    },
    Coordinate {
        axis: usize,
        kind: Kind,
    },
    /// Red, green, blue or alpha.
    Channel {
        channel: usize,
        kind: Kind,
    },
    Indices(Indices),
}

/// What the elements of a file say of colours.
#[derive(Default)]
struct Palette {
    vertices: Option<Colours>,
    faces: Option<Colours>,
    /// The colour of each triangle, of faces that have one.
    rows: Vec<u32>,
}

impl Palette {
    fn unreadable(&self) -> u64 {
        [&self.vertices, &self.faces].into_iter().flatten().map(|colours| colours.unreadable).sum()
    }

    /// The attributes of triangles of these vertices.
    fn attributes(mut self, triangles: &[[u32; 3]]) -> Result<Vec<MeshAttribute>, Error> {
        let mut attributes = Vec::new();
        let face = if self.vertices.is_some() { "face_colour" } else { "colour" };
        if let Some(colours) = self.vertices {
            memory::push(&mut attributes, colours.of_corners("colour", memory::copied(triangles)?)?)?;
        }
        if let Some(colours) = self.faces {
            colours::fill(&mut self.rows, triangles.len(), MeshAttribute::NO_ROW)?;
            memory::push(&mut attributes, colours.of_triangles(face, self.rows)?)?;
        }
        Ok(attributes)
    }
}

fn read_elements<S: Source>(
    elements: &[Element],
    mut source: S,
    warnings: &mut Vec<MeshWarning>,
) -> Result<TriangleMesh, Error> {
    let mut mesh = Polygons::default();
    let mut palette = Palette::default();
    let vertex = elements.iter().find(|element| element.name == b"vertex");
    let vertices = vertex.map_or(0, |element| element.count);
    if let Some(vertex) = vertex.filter(|_| vertices > u32::MAX.into()) {
        return Err(vertex.at.error("at most 2^32 - 1 vertices").into());
    }
    let mut indices = Vec::new();
    // The first line with too many values, and the number of such lines.
    let mut longer = (0, 0);
    for element in elements {
        let steps = steps(element, warnings)?;
        let least = least(element);
        // At most the count, hence no overflow.
        let present = (source.at_most(least.0, least.1) as u64).min(element.count) as usize;
        match element.name {
            b"vertex" => mesh.reserve(present, 0)?,
            b"face" => mesh.reserve(0, present)?,
            _ => {}
        }
        if steps.is_empty() {
            continue;
        }
        let has_colour = steps.iter().any(|step| matches!(step, Step::Channel { .. }));
        let mut colours = has_colour.then(Colours::default);
        if has_colour && element.name == b"face" {
            colours::fill(&mut palette.rows, mesh.triangle_count(), MeshAttribute::NO_ROW)?;
        }
        let mut more = None;
        for _ in 0..element.count {
            let start = source;
            let mut vertex = [0.0; 3];
            let mut colour = [0.0, 0.0, 0.0, 255.0];
            for step in &steps {
                match *step {
                    Step::Skip { values, bytes } => source.skip(values, bytes)?,
                    Step::SkipList { count, kind } => {
                        let before = source;
                        let count = source.count(count)?;
                        let bytes = count.checked_mul(kind.size() as u64);
                        source.skip(count, bytes.ok_or_else(|| before.error(TOO_SHORT))?)?;
                    }
                    Step::Coordinate { axis, kind } => vertex[axis] = source.coordinate(kind)?,
                    Step::Channel { channel, kind } => {
                        colour[channel] = source.value(kind)?.map_or(f64::NAN, |value| kind.channel(value));
                    }
                    Step::Indices(list) => {
                        let before = source;
                        let count = source.count(list.count)?;
                        if count < 3 && !list.strips {
                            return Err(before.error("a face of at least three vertices").into());
                        }
                        indices.clear();
                        source.indices(&mut indices, count, &list, vertices)?;
                        if list.strips {
                            push_strips(&mut mesh, &indices)
                                .map_err(|why| why.unwrap_or(before.error(STRIP).into()))?;
                        } else {
                            mesh.push_face(&indices)?;
                        }
                    }
                }
            }
            if element.name == b"vertex" {
                mesh.push_vertex(vertex)?;
            }
            if let Some(colours) = &mut colours {
                if element.name == b"face" {
                    colours::fill(&mut palette.rows, mesh.triangle_count(), colours.len() as u32)?;
                }
                colours.push(colour)?;
            }
            let found = source.end_element(&start, more)?;
            if found > 0 && longer.1 == 0 {
                longer.0 = source.line();
            }
            longer.1 += u64::from(found > 0);
            more = Some(found);
        }
        match element.name {
            b"vertex" => palette.vertices = colours,
            _ => palette.faces = palette.faces.or(colours),
        }
    }
    source.end_file()?;
    if let (line, lines @ 1..) = longer {
        memory::push(warnings, MeshWarning::MoreValues { line, lines })?;
    }
    if let colours @ 1.. = palette.unreadable() {
        memory::push(warnings, MeshWarning::Colours { colours })?;
    }
    mesh.finish_with(|triangles| palette.attributes(triangles))
}

const STRIP: &str = "strips of at least three vertices";

/// How to read an element; no step if it has no properties.
fn steps(element: &Element, warnings: &mut Vec<MeshWarning>) -> Result<Vec<Step>, Error> {
    let mut steps = Vec::new();
    let (mut axes, mut lists) = ([0; 3], 0);
    let channels = channels(element);
    for (place, property) in element.properties.iter().enumerate() {
        let channel = channels.iter().position(|&channel| channel == Some(place));
        let axis = [b"x", b"y", b"z"].iter().position(|axis| *axis == property.name);
        let is_list =
            matches!(property.name, b"vertex_indices" | b"vertex_index") && property.kind.is_integer();
        let step = match (element.name, axis, property.count) {
            (b"vertex", Some(axis), None) => {
                axes[axis] += 1;
                Step::Coordinate { axis, kind: property.kind }
            }
            (b"face" | b"tristrips", _, Some(count)) if is_list => {
                lists += 1;
                Step::Indices(Indices { count, kind: property.kind, strips: element.name == b"tristrips" })
            }
            (_, _, Some(count)) => Step::SkipList { count, kind: property.kind },
            (_, _, None) if channel.is_some() => {
                Step::Channel { channel: channel.unwrap_or_default(), kind: property.kind }
            }
            (_, _, None) => {
                let size = property.kind.size() as u64;
                if let Some(Step::Skip { values, bytes }) = steps.last_mut() {
                    (*values, *bytes) = (*values + 1, *bytes + size);
                    continue;
                }
                Step::Skip { values: 1, bytes: size }
            }
        };
        memory::push(&mut steps, step)?;
    }
    let missing = match element.name {
        b"face" | b"tristrips" if lists == 0 && element.count == 0 => {
            let is_known = warnings.iter().any(|known| matches!(known, MeshWarning::NoIndices { .. }));
            if !is_known {
                memory::push(warnings, MeshWarning::NoIndices { line: element.at.line() })?;
            }
            return Ok(steps);
        }
        b"vertex" if axes != [1; 3] => "a vertex with the properties `x`, `y` and `z`, each of them once",
        b"face" if lists != 1 => "a face with one list of integers called `vertex_indices` or `vertex_index`",
        b"tristrips" if lists != 1 => {
            "strips with one list of integers called `vertex_indices` or `vertex_index`"
        }
        _ => return Ok(steps),
    };
    Err(element.at.error(missing).into())
}

/// The properties of a vertex or face that are red, green, blue and alpha of its colour. If one of the first
/// three is missing there is no colour.
fn channels(element: &Element) -> [Option<usize>; 4] {
    let find = |name: &[u8]| {
        let is_it = |property: &Property| property.name == name && property.count.is_none();
        element.properties.iter().position(is_it)
    };
    if !matches!(element.name, b"vertex" | b"face") {
        return [None; 4];
    }
    let names: [[&[u8]; 4]; 2] = [
        [b"red", b"green", b"blue", b"alpha"],
        [b"diffuse_red", b"diffuse_green", b"diffuse_blue", b"diffuse_alpha"],
    ];
    let all = names.map(|names| names.map(find));
    match all.into_iter().find(|channels| channels[..3].iter().all(Option::is_some)) {
        Some([red, green, blue, alpha]) => [red, green, blue, alpha.or(all[0][3])],
        None => [None; 4],
    }
}

/// The least number of values of an element that can be read, and of their bytes.
fn least(element: &Element) -> (usize, usize) {
    let of = |property: &Property| match property.count {
        None => (1, property.kind.size()),
        // A face has at least three corners.
        Some(count)
            if element.name == b"face" && matches!(property.name, b"vertex_indices" | b"vertex_index") =>
        {
            (4, count.size() + 3 * property.kind.size())
        }
        Some(count) => (1, count.size()),
    };
    element.properties.iter().map(of).fold((0, 0), |sum, more| (sum.0 + more.0, sum.1 + more.1))
}

/// Adds the triangles of strips. Fails with `None` if a strip is too short.
fn push_strips(mesh: &mut Polygons, indices: &[u32]) -> Result<(), Option<Error>> {
    for strip in indices.split(|&index| index == END_OF_STRIP) {
        if matches!(strip.len(), 1 | 2) {
            return Err(None);
        }
        for (k, corners) in strip.windows(3).enumerate() {
            let [a, b, c] = [corners[0], corners[1], corners[2]];
            mesh.push_face(&if k % 2 == 0 { [a, b, c] } else { [b, a, c] }).map_err(Some)?;
        }
    }
    Ok(())
}

// ---- ASCII ----------------------------------------------------------------------------------------------

impl Source for Text<'_> {
    #[cold]
    fn error(&self, expected: &'static str) -> MeshFileError {
        let mut next = *self;
        next.skip_space();
        Text::error(&next, if next.is_at_end() { TOO_SHORT } else { expected })
    }

    fn at_most(&self, values: usize, _: usize) -> usize {
        // Behind each value but the last one stands something.
        self.rest().len().div_ceil(2) / values.max(1)
    }

    #[inline]
    fn coordinate(&mut self, _: Kind) -> Result<f64, MeshFileError> {
        self.skip_space();
        self.number().ok_or_else(|| Source::error(self, "a finite number"))
    }

    #[inline]
    fn value(&mut self, _: Kind) -> Result<Option<f64>, MeshFileError> {
        self.skip_space();
        match self.word() {
            [] => Err(Text::error(self, TOO_SHORT)),
            word => Ok(decimal::number(word).filter(|(_, rest)| rest.is_empty()).map(|(number, _)| number)),
        }
    }

    #[inline]
    fn count(&mut self, _: Kind) -> Result<u64, MeshFileError> {
        self.skip_space();
        let start = *self;
        let count = self.integer().and_then(|count| u64::try_from(count).ok());
        count.ok_or_else(|| Source::error(&start, "the length of a list"))
    }

    #[inline]
    fn skip(&mut self, values: u64, _: u64) -> Result<(), MeshFileError> {
        for _ in 0..values {
            self.skip_space();
            if self.word().is_empty() {
                return Err(Text::error(self, TOO_SHORT));
            }
        }
        Ok(())
    }

    #[inline]
    fn indices(&mut self, out: &mut Vec<u32>, count: u64, of: &Indices, vertices: u64) -> Result<(), Error> {
        for _ in 0..count {
            self.skip_space();
            let start = *self;
            let index = self.integer().ok_or_else(|| Source::error(&start, "the index of a vertex"))?;
            let index = vertex(index, of, vertices).ok_or_else(|| MeshFileError::Index {
                line: start.line(),
                index,
                vertices,
            })?;
            memory::push(out, index)?;
        }
        Ok(())
    }

    #[inline]
    fn end_element(&mut self, start: &Self, more: Option<u64>) -> Result<u64, MeshFileError> {
        self.skip_blanks();
        match (self.is_at_line_end(), more) {
            (true, None | Some(0)) => Ok(0),
            _ => skip_more(self, start, more),
        }
    }

    fn line(&self) -> u64 {
        Text::line(self)
    }

    fn end_file(&mut self) -> Result<(), MeshFileError> {
        self.skip_space();
        if self.is_at_end() { Ok(()) } else { Err(Text::error(self, TOO_LONG)) }
    }
}

/// Takes values that the header does not announce, up to the end of the line.
#[cold]
fn skip_more(text: &mut Text, start: &Text, more: Option<u64>) -> Result<u64, MeshFileError> {
    let (behind, mut found) = (*text, 0);
    while !text.is_at_line_end() && text.number().is_some() {
        text.skip_blanks();
        found += 1;
    }
    let mut start = *start;
    start.skip_space();
    let element = &start.rest()[..start.rest().len() - behind.rest().len()];
    // An element of several lines may have taken its last value from the next element.
    let is_on_one_line = !element.iter().any(|&byte| is_line_end(byte));
    let as_many = more.is_none_or(|more| more == found);
    if text.is_at_line_end() && is_on_one_line && as_many {
        Ok(found)
    } else if found == 0 && more.is_some() && text.is_at_line_end() {
        Err(behind.error("more values on the line, as the elements before have them"))
    } else {
        Err(behind.error("the end of the line"))
    }
}

/// The index as it is stored, if it is one.
#[inline]
fn vertex(index: i64, of: &Indices, vertices: u64) -> Option<u32> {
    match u32::try_from(index) {
        Ok(index) if u64::from(index) < vertices => Some(index),
        _ if of.strips && index == -1 => Some(END_OF_STRIP),
        _ => None,
    }
}

// ---- binary ---------------------------------------------------------------------------------------------

/// Adds the indices that `items` are, which come next in `source`.
#[inline]
fn read_indices<const BIG: bool, const N: usize>(
    source: &Bytes<BIG>,
    out: &mut Vec<u32>,
    items: &[u8],
    of: &Indices,
    vertices: u64,
    value: impl Fn([u8; N]) -> i64,
) -> Result<(), Error> {
    out.try_reserve(items.len() / N)?;
    for (k, item) in items.as_chunks::<N>().0.iter().enumerate() {
        let index = value(Bytes::<BIG>::in_order(*item));
        let Some(index) = vertex(index, of, vertices) else {
            return Err(source.index_error(k * N, index, vertices).into());
        };
        out.push(index);
    }
    Ok(())
}

impl<const BIG: bool> Source for Bytes<'_, BIG> {
    fn error(&self, expected: &'static str) -> MeshFileError {
        Bytes::error(self, expected)
    }

    fn at_most(&self, _: usize, bytes: usize) -> usize {
        self.rest().len() / bytes.max(1)
    }

    #[inline]
    fn coordinate(&mut self, kind: Kind) -> Result<f64, MeshFileError> {
        let start = *self;
        self.value(kind)?.ok_or_else(|| start.error("a finite number"))
    }

    #[inline]
    fn value(&mut self, kind: Kind) -> Result<Option<f64>, MeshFileError> {
        let number = match kind {
            Kind::F32 => f64::from(f32::from_le_bytes(self.number()?)),
            Kind::F64 => f64::from_le_bytes(self.number()?),
            _ => integer(self, kind)? as f64,
        };
        Ok(Some(number).filter(|number| number.is_finite()))
    }

    #[inline]
    fn count(&mut self, kind: Kind) -> Result<u64, MeshFileError> {
        let start = *self;
        u64::try_from(integer(self, kind)?).map_err(|_| start.error("the length of a list"))
    }

    #[inline]
    fn skip(&mut self, _: u64, bytes: u64) -> Result<(), MeshFileError> {
        self.take(bytes).map(drop)
    }

    #[inline]
    fn indices(&mut self, out: &mut Vec<u32>, count: u64, of: &Indices, vertices: u64) -> Result<(), Error> {
        let start = *self;
        // No overflow: a length has at most 32 bits.
        let items = self.take(count * of.kind.size() as u64)?;
        match of.kind {
            Kind::I8 => read_indices(&start, out, items, of, vertices, |b| i8::from_le_bytes(b).into()),
            Kind::U8 => read_indices(&start, out, items, of, vertices, |b| u8::from_le_bytes(b).into()),
            Kind::I16 => read_indices(&start, out, items, of, vertices, |b| i16::from_le_bytes(b).into()),
            Kind::U16 => read_indices(&start, out, items, of, vertices, |b| u16::from_le_bytes(b).into()),
            Kind::I32 => read_indices(&start, out, items, of, vertices, |b| i32::from_le_bytes(b).into()),
            Kind::U32 => read_indices(&start, out, items, of, vertices, |b| u32::from_le_bytes(b).into()),
            Kind::F32 | Kind::F64 => Err(start.error("integers").into()),
        }
    }

    #[inline]
    fn end_element(&mut self, _: &Self, _: Option<u64>) -> Result<u64, MeshFileError> {
        Ok(0)
    }

    fn line(&self) -> u64 {
        0
    }

    fn end_file(&mut self) -> Result<(), MeshFileError> {
        self.end()
    }
}

#[inline]
fn integer<const BIG: bool>(source: &mut Bytes<BIG>, kind: Kind) -> Result<i64, MeshFileError> {
    Ok(match kind {
        Kind::I8 => i8::from_le_bytes(source.number()?).into(),
        Kind::U8 => u8::from_le_bytes(source.number()?).into(),
        Kind::I16 => i16::from_le_bytes(source.number()?).into(),
        Kind::U16 => u16::from_le_bytes(source.number()?).into(),
        Kind::I32 => i32::from_le_bytes(source.number()?).into(),
        Kind::U32 => u32::from_le_bytes(source.number()?).into(),
        Kind::F32 | Kind::F64 => return Err(source.error("an integer")),
    })
}

#[cfg(test)]
mod tests {
    use super::super::tests::{is_syntax_error, model, random_polygons, same, truncations_and_damages};
    use super::*;
    use crate::error::MeshError;
    use crate::mesh::FillRule;
    use alloc::string::{String, ToString};
    use alloc::{format, vec};
    use proptest::prelude::*;

    const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";
    const LIST: &str = "property list uchar int vertex_indices\n";
    const DATA: &str = "0 0 0\n1.5 0 0\n0 2.25 0\n0 0 1e-3\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

    fn header(format: &str) -> String {
        format!("ply\nformat {format} 1.0\nelement vertex 4\n{XYZ}element face 4\n{LIST}end_header\n")
    }

    fn ascii() -> String {
        header("ascii") + DATA
    }

    /// A number as bytes of the type with that name.
    fn bytes_of(value: f64, kind: &str, big: bool) -> Vec<u8> {
        let mut bytes = match kind {
            "char" | "int8" => (value as i8).to_le_bytes().to_vec(),
            "uchar" | "uint8" => (value as u8).to_le_bytes().to_vec(),
            "short" | "int16" => (value as i16).to_le_bytes().to_vec(),
            "ushort" | "uint16" => (value as u16).to_le_bytes().to_vec(),
            "int" | "int32" => (value as i32).to_le_bytes().to_vec(),
            "uint" | "uint32" => (value as u32).to_le_bytes().to_vec(),
            "float" | "float32" => (value as f32).to_le_bytes().to_vec(),
            "double" | "float64" => value.to_le_bytes().to_vec(),
            _ => panic!("{kind}"),
        };
        if big {
            bytes.reverse();
        }
        bytes
    }

    const FORMATS: [&str; 3] = ["ascii", "binary_little_endian", "binary_big_endian"];

    /// Of elements of one kind the name, the properties as the header has them, and the values of each.
    type Elements<'a> = (&'a str, &'a [&'a str], Vec<Vec<Vec<f64>>>);

    fn file(format: &str, elements: &[Elements]) -> Vec<u8> {
        let mut bytes = format!("ply\nformat {format} 1.0\n").into_bytes();
        for (name, properties, values) in elements {
            bytes.extend(format!("element {name} {}\n", values.len()).bytes());
            properties.iter().for_each(|property| bytes.extend(format!("property {property}\n").bytes()));
        }
        bytes.extend(b"end_header\n");
        for (_, properties, values) in elements {
            for element in values {
                for (property, values) in properties.iter().zip(element) {
                    let words: Vec<&str> = property.split(' ').collect();
                    let list = words[0] == "list";
                    let all = list.then_some((values.len() as f64, words[1])).into_iter();
                    for (value, kind) in all.chain(values.iter().map(|&v| (v, words[2 * list as usize]))) {
                        if format == "ascii" {
                            bytes.extend(format!("{value} ").bytes());
                        } else {
                            bytes.extend(bytes_of(value, kind, format == "binary_big_endian"));
                        }
                    }
                }
                if format == "ascii" {
                    bytes.push(b'\n');
                }
            }
        }
        bytes
    }

    /// Values of elements that have single ones.
    fn singles(rows: &[&[f64]]) -> Vec<Vec<Vec<f64>>> {
        rows.iter().map(|row| row.iter().map(|&value| vec![value]).collect()).collect()
    }

    fn faces() -> Vec<Vec<Vec<f64>>> {
        [[0., 2., 1.], [0., 1., 3.], [1., 2., 3.], [2., 0., 3.]].map(|face| vec![face.to_vec()]).to_vec()
    }

    const CORNERS: [&[f64]; 4] = [&[0., 0., 0.], &[1.5, 0., 0.], &[0., 2.25, 0.], &[0., 0., 0.125]];

    /// A tetrahedron with a height as it is given.
    #[track_caller]
    fn assert_tetrahedron(bytes: impl AsRef<[u8]>, height: f64) {
        let mesh = read_ply(bytes.as_ref()).unwrap();
        assert_eq!(mesh.vertices(), [[0., 0., 0.], [1.5, 0., 0.], [0., 2.25, 0.], [0., 0., height]]);
        assert_eq!(mesh.triangles(), [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
        mesh.check_closed(FillRule::NonZero).unwrap();
    }

    #[track_caller]
    fn assert_syntax(text: impl AsRef<[u8]>, at: u64, what: &str) {
        is_syntax_error(read_ply(text.as_ref()), at, what);
    }

    #[track_caller]
    fn assert_binary(bytes: &[u8], at: usize, what: &str) {
        match read_ply(bytes) {
            Err(Error::MeshFile(MeshFileError::Binary { offset, expected })) => {
                assert_eq!(offset, at as u64, "{expected}");
                assert!(expected.contains(what), "{expected}");
            }
            other => panic!("{other:?}"),
        }
    }

    const FLOATS: [&str; 3] = ["float x", "float y", "float z"];
    const INTS: [&str; 1] = ["list uchar int vertex_indices"];

    fn plain(format: &str) -> Vec<u8> {
        file(format, &[("vertex", &FLOATS, singles(&CORNERS)), ("face", &INTS, faces())])
    }

    /// Bytes of the header of [`plain`].
    fn header_length(bytes: &[u8]) -> usize {
        bytes.windows(11).position(|window| window == b"end_header\n").unwrap() + 11
    }

    #[test]
    fn all_three_formats() {
        assert_tetrahedron(ascii(), 1e-3);
        for format in FORMATS {
            assert_tetrahedron(plain(format), 0.125);
        }
    }

    #[test]
    fn coordinates_and_indices_of_all_types() {
        let types = [
            "char", "int8", "uchar", "uint8", "short", "int16", "ushort", "uint16", "int", "int32", "uint",
            "uint32", "float", "float32", "double", "float64",
        ];
        for format in FORMATS {
            for kind in types {
                let properties = [&format!("{kind} x")[..], "double y", "float64 z"];
                let corners: [&[f64]; 4] = [&[0., 0., 0.], &[100., 0., 0.], &[0., 0.1, 0.], &[0., 0., 0.125]];
                let bytes =
                    file(format, &[("vertex", &properties, singles(&corners)), ("face", &INTS, faces())]);
                let mesh = read_ply(&bytes).unwrap();
                assert_eq!(
                    mesh.vertices(),
                    [[0.0; 3], [100., 0., 0.], [0., 0.1, 0.], [0., 0., 0.125]],
                    "{kind}"
                );
            }
            for kind in &types[..12] {
                for count in &types[..12] {
                    for name in ["vertex_indices", "vertex_index"] {
                        let list = format!("list {count} {kind} {name}");
                        let faces = ("face", &[&list[..]][..], faces());
                        let bytes = file(format, &[("vertex", &FLOATS, singles(&CORNERS)), faces]);
                        assert_tetrahedron(bytes, 0.125);
                    }
                }
            }
            for kind in &types[12..] {
                for list in
                    [format!("list uchar {kind} vertex_indices"), format!("list {kind} int vertex_indices")]
                {
                    let faces = ("face", &[&list[..]][..], faces());
                    let bytes = file(format, &[("vertex", &FLOATS, singles(&CORNERS)), faces]);
                    let line = 7 + list.starts_with(&format!("list {kind}")) as u64;
                    assert_syntax(bytes, line, "integer");
                }
            }
        }
    }

    #[test]
    fn other_elements_and_properties_are_skipped() {
        let vertex =
            ["uchar red", "list uint8 float64 more", "float y", "int8 a", "double b", "float x", "float z"];
        let vertices = CORNERS.map(|c| {
            vec![
                vec![7.],
                vec![0.5; 1 + c[0] as usize],
                vec![c[1]],
                vec![3.],
                vec![0.1],
                vec![c[0]],
                vec![c[2]],
            ]
        });
        let face = [
            "list uchar float texcoord",
            "float quality",
            "list char short vertex_index",
            "uchar a",
            "uchar b",
        ];
        let faces =
            faces().into_iter().map(|face| vec![vec![0.5; 6], vec![1.], face[0].clone(), vec![1.], vec![2.]]);
        let other = vec![vec![vec![1., 2., 3.], vec![4.]], vec![vec![], vec![5.]]];
        let other = ("vertex_indices", &["list int uint x", "double y"][..], other);
        let nothing = ("nothing", &[][..], vec![vec![]; 5]);
        let vertices = ("vertex", &vertex[..], vertices.to_vec());
        let faces = ("face", &face[..], faces.collect());
        for format in FORMATS {
            let orders = [[&other, &vertices, &faces, &nothing], [&faces, &nothing, &other, &vertices]];
            for order in orders {
                assert_tetrahedron(file(format, &order.map(Clone::clone)), 0.125);
            }
        }
    }

    #[test]
    fn headers() {
        let ascii = ascii();
        assert_tetrahedron(ascii.replace('\n', "\r\n"), 1e-3);
        assert_tetrahedron(ascii.replace('\n', "\r"), 1e-3);
        assert_tetrahedron(ascii.replace('\n', " \n"), 1e-3);
        assert_tetrahedron(
            ascii.replacen("format", "comment\ncomment property x\nobj_info \u{fc}\nformat", 1),
            1e-3,
        );
        for line in ["element", "property", "end_header"] {
            assert_tetrahedron(
                ascii.replace(line, &format!("comment end_header\nobj_info num 3\n\n{line}")),
                1e-3,
            );
        }
        for bytes in [plain(FORMATS[1]), plain(FORMATS[2])] {
            let (header, data) = bytes.split_at(header_length(&bytes));
            let header = core::str::from_utf8(header).unwrap();
            for end in ["\r\n", "\r", " \n"] {
                assert_tetrahedron([header.replace('\n', end).as_bytes(), data].concat(), 0.125);
            }
        }
        // The first byte of the data is a line feed: an x of 10, and half a line end.
        let bytes = |end: &str| {
            let file = file(
                FORMATS[1],
                &[("vertex", &["uchar x", "float y", "float z"], singles(&[&[10., 0., 0.]]))],
            );
            let (header, data) = file.split_at(header_length(&file));
            [core::str::from_utf8(header).unwrap().replace('\n', end).as_bytes(), data].concat()
        };
        for end in ["\n", "\r\n", "\r"] {
            assert_eq!(read_ply(&bytes(end)).unwrap().vertices(), [[10., 0., 0.]]);
        }
    }

    #[test]
    fn bad_headers() {
        assert!(matches!(read_ply(b""), Err(Error::MeshFile(MeshFileError::Empty))));
        let ascii = ascii();
        let change = |from: &str, to: &str| ascii.replacen(from, to, 1);
        assert_syntax(change("ply", "plx"), 1, "`ply`");
        assert_syntax(change("ply", "ply 2"), 1, "end of the line");
        assert_syntax("OFF\n", 1, "`ply`");
        assert_syntax(change("format ascii 1.0\n", ""), 8, "a format");
        assert_syntax(change("1.0", "1.1"), 2, "a format");
        assert_syntax(change("ascii", "ASCII"), 2, "a format");
        assert_syntax(change("1.0", "1.0 x"), 2, "end of the line");
        assert_syntax(change("1.0\n", "1.0\nformat ascii 1.0\n"), 3, "a line of a PLY header");
        assert_syntax(change("vertex 4", "vertex"), 3, "a count");
        assert_syntax(change("vertex 4", "vertex -4"), 3, "a count");
        assert_syntax(change("vertex 4", "vertex 4.0"), 3, "a count");
        assert_syntax(change("vertex 4", "vertex 4294967296"), 3, "2^32 - 1");
        assert_syntax(change("vertex 4", "vertex 9999999999999999999"), 3, "a count");
        assert_syntax(change("element vertex 4\n", ""), 3, "before its properties");
        assert_syntax(change("element face", "element vertex"), 7, "every element once");
        assert_syntax(change("float x", "quad x"), 4, "`property`");
        assert_syntax(change("float x", "float"), 4, "`property`");
        assert_syntax(change("float x", "float x x"), 4, "end of the line");
        assert_syntax(change("float x", "float a"), 3, "`x`, `y` and `z`");
        assert_syntax(change("float x", "list uchar float x"), 3, "`x`, `y` and `z`");
        assert_syntax(change("float y", "float x"), 3, "`x`, `y` and `z`");
        assert_syntax(change("float z", "float z\nproperty float z"), 3, "`x`, `y` and `z`");
        assert_syntax(change("vertex_indices", "indices"), 7, "`vertex_indices`");
        assert_syntax(change("list uchar int vertex", "int vertex"), 7, "`vertex_indices`");
        assert_syntax(change(LIST, &LIST.repeat(2)), 7, "`vertex_indices`");
        assert_syntax(change("list uchar", "list"), 8, "`property`");
        assert_syntax(change("end_header", "end"), 9, "`end_header`");
        assert_syntax(change("end_header", "end_header 1"), 9, "line end");
        assert_syntax(&ascii[..ascii.find("at x").unwrap()], 4, "`property`");
        assert_syntax(&ascii[..ascii.find(" 1.0").unwrap()], 2, "a format");
        assert_syntax("ply\nformat ascii 1.0\n", 2, "`end_header`");
        // Nothing to read is not wrong.
        assert_eq!(read_ply(b"ply\nformat ascii 1.0\nend_header").unwrap().triangles().len(), 0);
    }

    #[test]
    fn ascii_data() {
        let text = ascii();
        let (header, data) = text.split_at(header_length(text.as_bytes()));
        for gap in ["  ", "\t", "\n", "\r\n\r\n"] {
            assert_tetrahedron(format!("{header}{}", data.replace(' ', gap)), 1e-3);
        }
        for end in ["\n\n", " \r\n", "\r", "\n   "] {
            assert_tetrahedron(format!("{header}{}", data.replace('\n', end)), 1e-3);
        }
        assert_tetrahedron(text.trim_end(), 1e-3);
        assert_tetrahedron(format!("{text}\n \r\n\x1A\0\0"), 1e-3);
        let change = |from: &str, to: &str| format!("{header}{}", data.replacen(from, to, 1));
        assert_syntax(change("1.5", "nan"), 11, "finite number");
        assert_syntax(change("1.5", "inf"), 11, "finite number");
        assert_syntax(change("1.5", "1.5x"), 11, "finite number");
        assert_syntax(change("1.5", "1d5"), 11, "finite number");
        assert_syntax(change("0 0 0", "0 0 0 0"), 11, "more values on the line");
        assert_syntax(change("0 0 0\n", "0 0\n"), 11, "end of the line");
        assert_syntax(change("3 0 2", "2 0 2"), 14, "three vertices");
        assert_syntax(change("3 0 2 1", "0"), 14, "three vertices");
        assert_syntax(change("3 0 2", "-3 0 2"), 14, "length of a list");
        assert_syntax(change("3 0 2", "3.0 0 2"), 14, "length of a list");
        assert_syntax(change("3 0 2 1", "4 0 2 1"), 15, "end of the line");
        assert_syntax(change("3 0 2 1", "3 0 x 1"), 14, "index");
        assert_syntax(change("3 0 2 1", "3 0 1.5 1"), 14, "index");
        assert_syntax(format!("{text}3 0 1 2\n"), 18, "longer than");
        for index in [-1, 4, 4_294_967_295, 4_294_967_296] {
            match read_ply(change("3 0 2 1", &format!("3 0 {index} 1")).as_bytes()) {
                Err(Error::MeshFile(MeshFileError::Index { line: 14, index: found, vertices: 4 })) => {
                    assert_eq!(found, index);
                }
                other => panic!("{other:?}"),
            }
        }
        for count in ["5", "4000000000"] {
            assert_syntax(text.replace("vertex 4", &format!("vertex {count}")), 14, "end of the line");
            assert_syntax(text.replace("face 4", &format!("face {count}")), 17, "shorter");
        }
        assert_syntax(
            text.replace("element face", "element other 0\nelement face").replace("face 4", "face 3"),
            18,
            "longer",
        );
        assert_syntax(
            text.replace("element face", "element other 9\nproperty int a\nelement face"),
            19,
            "shorter",
        );
        assert_syntax(
            text.replace("vertex 4", "vertex 4000000000").replace("face 4", "face 0"),
            14,
            "end of the line",
        );
        assert!(matches!(
            read_ply(change("1.5", "1e78").as_bytes()),
            Err(Error::Mesh(MeshError::TooLarge { vertex: 1 }))
        ));
    }

    /// What is warned of; the mesh is the tetrahedron.
    #[track_caller]
    fn warnings_of(bytes: impl AsRef<[u8]>, height: f64) -> Vec<MeshWarning> {
        let mut warnings = vec![];
        read(bytes.as_ref(), &mut warnings).unwrap();
        assert_tetrahedron(bytes, height);
        warnings
    }

    #[test]
    fn more_values_than_the_header_announces() {
        let (vertices, faces) = DATA.split_at(DATA.find("3 0 2 1").unwrap());
        let head = header("ascii");
        let longer = |data: &str, more: &str| data.replace('\n', &format!("{more}\n"));
        let with = |v: &str, f: &str| head.clone() + &longer(vertices, v) + &longer(faces, f);
        assert_eq!(warnings_of(with("", ""), 1e-3), []);
        assert_eq!(warnings_of(with("  ", "\t"), 1e-3), []);
        let more = |line, lines| [MeshWarning::MoreValues { line, lines }];
        assert_eq!(warnings_of(with(" 255", ""), 1e-3), more(10, 4));
        assert_eq!(warnings_of(with("", " 255 0 0 "), 1e-3), more(14, 4));
        assert_eq!(warnings_of(with(" .5 -1e3 7", " 0"), 1e-3), more(10, 8));
        assert_eq!(warnings_of(with(" 1", "").replace('\n', "\r\n"), 1e-3), more(10, 4));
        // Not as many on every line, or no numbers: then nobody knows what is what.
        assert_syntax(with(" 255", "").replacen("255", "255 0", 1), 11, "end of the line");
        assert_syntax(with(" 255", "").replacen("0 255", "0", 1), 11, "end of the line");
        assert_syntax(with(" red", ""), 10, "end of the line");
        // A value of the line before that went missing.
        assert_syntax(with("", "").replacen("0 0 0\n", "0 0\n", 1), 11, "end of the line");
        let text = MeshWarning::MoreValues { line: 10, lines: 4 }.to_string();
        assert_eq!(
            text,
            "line 10 (like 3 more) has more values than the header announces; the last ones were skipped"
        );
    }

    #[test]
    fn header_lines_without_a_keyword() {
        let line = "Created by Blender3D 2.47 - www.blender.org, source file: part.blend\n";
        for format in FORMATS {
            let plain = plain(format);
            let at = plain.windows(7).position(|window| window == b"element").unwrap();
            let with = |lines: &str| [&plain[..at], lines.as_bytes(), &plain[at..]].concat();
            assert_eq!(warnings_of(with(line), 0.125), [MeshWarning::HeaderLine { line: 3, lines: 1 }]);
            let two = format!("{line}comment a\n{line}");
            assert_eq!(warnings_of(with(&two), 0.125), [MeshWarning::HeaderLine { line: 3, lines: 2 }]);
        }
        // Behind an element it may be a property that is spelt in a new way.
        assert_syntax(
            ascii().replacen(XYZ, &format!("{XYZ}propertz float a\n"), 1),
            7,
            "line of a PLY header",
        );
        assert_syntax(ascii().replacen("format", &format!("{line}format"), 1), 2, "line of a PLY header");
    }

    #[test]
    fn no_faces_need_no_list() {
        for format in FORMATS {
            let head =
                format!("ply\nformat {format} 1.0\nelement vertex 0\n{XYZ}element face 0\nend_header\n");
            let mut warnings = vec![];
            let mesh = read(head.as_bytes(), &mut warnings).unwrap();
            assert_eq!(
                (mesh.triangles().len(), &warnings[..]),
                (0, &[MeshWarning::NoIndices { line: 7 }][..])
            );
            assert_syntax(head.replace("face 0", "face 1"), 7, "one list of integers");
        }
    }

    #[test]
    fn binary_data() {
        for (big, format) in [(false, FORMATS[1]), (true, FORMATS[2])] {
            let bytes = plain(format);
            let start = header_length(&bytes);
            for tail in [&b"\n"[..], b"\r\n\0\0\0", b"\x1A"] {
                assert_tetrahedron([&bytes[..], tail].concat(), 0.125);
            }
            assert_binary(&[&bytes[..], b"\0x"].concat(), bytes.len(), "longer");
            for length in start..bytes.len() {
                assert_binary(&bytes[..length], length, "shorter");
            }
            let change = |at: usize, new: &[u8]| {
                let mut changed = bytes.clone();
                changed[at..at + new.len()].copy_from_slice(new);
                changed
            };
            for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                assert_binary(&change(start + 8, &bytes_of(value, "float", big)), start + 8, "finite");
            }
            let faces = start + 48;
            assert_binary(&change(faces, &[2]), faces, "three vertices");
            assert_binary(&change(faces, &[255]), bytes.len(), "shorter");
            for index in [-1, 4, i32::MAX, i32::MIN] {
                let changed = change(faces + 5, &bytes_of(index.into(), "int", big));
                match read_ply(&changed) {
                    Err(Error::MeshFile(MeshFileError::BinaryIndex {
                        offset,
                        index: found,
                        vertices: 4,
                    })) => {
                        assert_eq!((offset, found), (faces as u64 + 5, index.into()));
                    }
                    other => panic!("{other:?}"),
                }
            }
            // Counts that the file does not hold.
            for name in ["vertex", "face"] {
                let (header, data) = bytes.split_at(start);
                let header = core::str::from_utf8(header).unwrap();
                let header = header.replace(&format!("{name} 4"), &format!("{name} 4000000000"));
                let changed = [header.as_bytes(), data].concat();
                assert!(read_ply(&changed).is_err());
            }
            // Lists of negative and of huge lengths.
            let list = |count: f64| {
                let mut bytes = file(
                    format,
                    &[
                        ("vertex", &FLOATS, singles(&CORNERS)),
                        ("face", &["list int double a", INTS[0]], vec![]),
                    ],
                );
                let text =
                    String::from_utf8_lossy(&bytes[..header_length(&bytes)]).replace("face 0", "face 1");
                let rest = bytes.split_off(header_length(&bytes));
                [text.as_bytes(), &rest, &bytes_of(count, "int", big)].concat()
            };
            let length = list(0.).len();
            assert_binary(&list(-1.), length - 4, "length of a list");
            assert_binary(&list(f64::from(i32::MAX)), length, "shorter");
            assert_binary(&list(0.), length, "shorter");
        }
    }

    #[test]
    fn strips() {
        // A tetrahedron of two strips, and the same one of a strip with a turn.
        for (strips, expected) in [
            (vec![vec![vec![0., 2., 1., 3., -1., 2., 0., 3.]]], vec![[0, 2, 1], [1, 2, 3], [2, 0, 3]]),
            (
                vec![vec![vec![0., 2., 1., 3., -1.]], vec![vec![2., 0., 3., -1., -1.]], vec![vec![]]],
                vec![[0, 2, 1], [1, 2, 3], [2, 0, 3]],
            ),
            (vec![vec![vec![2., 0., 1., 3.]]], vec![[2, 0, 1], [1, 0, 3]]),
        ] {
            for format in FORMATS {
                for kind in ["int", "short", "char"] {
                    let list = [&format!("list int {kind} vertex_indices")[..]];
                    let bytes = file(
                        format,
                        &[("vertex", &FLOATS, singles(&CORNERS)), ("tristrips", &list, strips.clone())],
                    );
                    assert_eq!(read_ply(&bytes).unwrap().triangles(), expected, "{format}");
                }
            }
        }
        for strip in [vec![0., 1.], vec![0., 1., 2., -1., 3.]] {
            let elements = [
                ("vertex", &FLOATS[..], singles(&CORNERS)),
                ("tristrips", &["list uchar int vertex_index"][..], vec![vec![strip]]),
            ];
            assert_syntax(file("ascii", &elements), 14, "strips of at least three");
            let bytes = file(FORMATS[1], &elements);
            assert_binary(&bytes, header_length(&bytes) + 48, "strips of at least three");
        }
        let elements = [
            ("vertex", &FLOATS[..], singles(&CORNERS)),
            ("tristrips", &["list uchar int vertex_index"][..], vec![vec![vec![0., 1., -2.]]]),
        ];
        let result = read_ply(&file("ascii", &elements));
        assert!(matches!(
            result,
            Err(Error::MeshFile(MeshFileError::Index { line: 14, index: -2, vertices: 4 }))
        ));
    }

    #[test]
    fn truncated_and_damaged() {
        for format in FORMATS {
            truncations_and_damages(read_ply, &plain(format));
        }
    }

    proptest! {
        /// Any mesh, in any format, with vertices before or after the faces.
        #[test]
        fn written_meshes_come_back(
            (vertices, faces) in random_polygons(),
            format in proptest::sample::select(&FORMATS[..]),
            before in any::<bool>(),
            more in any::<bool>(),
        ) {
            let xyz = ["double x", "double y", "double z", "list uchar uchar more"];
            let rows = vertices.iter().map(|v| {
                let row = v.iter().map(|&x| vec![x]).chain([vec![1.; v[0] as usize]]);
                row.take(3 + more as usize).collect()
            });
            let list = ["list uchar int vertex_indices", "float more"];
            let lists = faces.iter().map(|face| {
                let row = [face.iter().map(|&v| v.into()).collect(), vec![0.5]];
                row.into_iter().take(1 + more as usize).collect()
            });
            let mut elements = [
                ("vertex", &xyz[..3 + more as usize], rows.collect::<Vec<_>>()),
                ("face", &list[..1 + more as usize], lists.collect()),
            ];
            if before {
                elements.reverse();
            }
            same(read_ply(&file(format, &elements)).unwrap(), vertices, &faces);
        }

        #[test]
        fn any_data(text in "[0-9.e \n-]{0,100}", bytes in proptest::collection::vec(any::<u8>(), 0..100)) {
            let _ = read_ply((header("ascii") + &text).as_bytes());
            for format in &FORMATS[1..] {
                let _ = read_ply(&[header(format).as_bytes(), &bytes].concat());
            }
        }
    }

    #[test]
    fn a_real_file() {
        let Some(bytes) = model("cycloidal.ply") else { return };
        let mesh = read_ply(&bytes).unwrap();
        let report = mesh.report().unwrap();
        assert_eq!((report.facets_read, report.vertices + report.welded), (43_368, 21_384));
    }
}
