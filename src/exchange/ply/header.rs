//! The header of a PLY: the encoding, and the elements with their properties.

use alloc::vec::Vec;

use super::number_kind::NumberKind;
use crate::error::Error;
use crate::exchange::declared::{Declared, declare};
use crate::exchange::text::Text;
use crate::exchange::{MeshWarning, is_line_end};
use crate::memory;

#[derive(Clone, Copy)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

pub(super) struct Property<'a> {
    pub name: &'a [u8],
    /// The type of the length, for a list.
    pub count: Option<NumberKind>,
    pub kind: NumberKind,
}

pub(super) struct Element<'a> {
    /// The place in the header that names the element.
    pub at: Text<'a>,
    pub name: &'a [u8],
    pub count: u64,
    pub properties: Vec<Property<'a>>,
}

pub(super) struct Header<'a> {
    pub encoding: Encoding,
    pub elements: Vec<Element<'a>>,
    /// Attributes that comments announce.
    pub declared: Vec<Declared<'a>>,
    /// Length of the header in bytes.
    pub length: usize,
}

impl<'a> Header<'a> {
    pub fn read(bytes: &'a [u8], warnings: &mut Vec<MeshWarning>) -> Result<Self, Error> {
        let mut text = Text::beginning(bytes);
        if text.word() != b"ply" {
            return Err(Text::beginning(bytes).error("`ply` at the beginning of a PLY file").into());
        }
        text.skip_blanks();
        // If lines end with CR alone, an LF after the header is part of the data.
        let old = matches!(text.rest(), [b'\r', next, ..] if *next != b'\n');
        end_line(&mut text)?;
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut declared = Vec::new();
        let mut strange = (0, 0);
        loop {
            text.skip_space();
            let at = text;
            match text.word() {
                b"comment" | b"obj_info" => {
                    let comment = text.rest().split(|&byte| is_line_end(byte)).next().unwrap_or(&[]);
                    declare(&mut declared, comment)?;
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
                // Before the first element, no property can be lost.
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
        Ok(Self { encoding, elements, declared, length: text.taken() })
    }
}

fn is_keyword(word: &[u8]) -> bool {
    matches!(word, b"ply" | b"format" | b"comment" | b"obj_info" | b"element" | b"property" | b"end_header")
}

const FORMAT: &str = "a format: `ascii`, `binary_little_endian` or `binary_big_endian`, and `1.0`";
const PROPERTY: &str =
    "`property`, a type and a name, or `property list`, two types (first an integer) and a name";

impl<'a> Property<'a> {
    /// Reads the text after `property`.
    fn read(text: &mut Text<'a>) -> Option<Self> {
        let mut word = || {
            text.skip_blanks();
            text.word()
        };
        let mut count = None;
        let mut kind = word();
        if kind == b"list" {
            count = Some(NumberKind::of(word()).filter(|kind| kind.is_integer())?);
            kind = word();
        }
        let kind = NumberKind::of(kind)?;
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

#[cfg(test)]
mod tests {
    use super::super::read_ply;
    use super::super::samples::{
        FORMATS, LIST, XYZ, ascii, assert_syntax, assert_tetrahedron, file, header_length, plain, singles,
        warnings_of,
    };
    use super::*;
    use crate::error::MeshFileError;
    use alloc::format;

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
        // A file with no elements is valid.
        assert_eq!(read_ply(b"ply\nformat ascii 1.0\nend_header").unwrap().triangles().len(), 0);
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
        // After an element, it may be a property with a new spelling.
        assert_syntax(
            ascii().replacen(XYZ, &format!("{XYZ}propertz float a\n"), 1),
            7,
            "line of a PLY header",
        );
        assert_syntax(ascii().replacen("format", &format!("{line}format"), 1), 2, "line of a PLY header");
    }
}
