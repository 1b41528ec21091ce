//! OFF files as Geomview defines them, text and binary: reader.
//!
//! **Header.** `OFF` with any of the prefixes `ST`, `C`, `N`, `4` and `n`, then the numbers of vertices,
//! faces and edges. The keyword may be absent, and the counts may follow it immediately (`OFF8 6 12`, as in
//! some collections). The number of edges has no meaning, and may be absent if the other two are on one line.
//! `#` begins a comment anywhere.
//!
//! **Vertices** have three finite coordinates each, separated by any white space; a coordinate becomes the
//! nearest `f64`. In `4OFF` there are four, and the first three are divided by the fourth. `nOFF` states its
//! dimension, which must be 3. After its coordinates a vertex has the data that the prefixes announce, all of
//! which is skipped: a normal of three numbers (`N`), a colour of three or four numbers (`C`; the remaining
//! numbers of the line), two texture coordinates (`ST`).
//!
//! **Faces** have a number of corners, the vertices counted from 0, and up to the end of the line at most
//! four numbers of a colour, which is skipped. Faces of one or two corners, which stand for points and lines,
//! are skipped too.
//!
//! **Binary** files (`OFF BINARY`) have 32-bit integers and 32-bit floating point numbers, both big-endian,
//! and a count before each colour. A little-endian file, which some programs write, is refused as such.
//!
//! **The end.** Only white space and comments may follow the last face, in a binary file also zero bytes: if
//! there is more, the counts are wrong. Nothing is allocated beyond the content of the file.

use alloc::vec::Vec;

use super::bytes::{Bytes, TOO_LONG, TOO_SHORT};
use super::polygons::Polygons;
use super::refuse_utf16;
use super::text::Text;
use crate::error::{Error, MeshFileError};
use crate::memory;
use crate::mesh::TriangleMesh;

/// Reads an OFF file, text or binary.
///
/// Triangles keep the order of the faces. A face of more than three corners is triangulated within the face.
/// If that is impossible, because its edges cross or it has no area, it becomes the fan around its first
/// corner. Equal vertices are welded, and triangles that become degenerate by that are dropped and counted,
/// as in [`TriangleMesh::new`]. The mesh need not be closed, and may be empty.
///
/// O(n), or O(n log n) for faces that are not convex. Memory is at most 128 times the length of the file,
/// whatever the header claims.
///
/// # Errors
/// [`MeshFileError::Empty`], [`MeshFileError::Unsupported`] (UTF-16), [`MeshFileError::Syntax`] and
/// [`MeshFileError::Index`] (in the header, and in a text), [`MeshFileError::Binary`] and
/// [`MeshFileError::BinaryIndex`], [`MeshError::TooLarge`](crate::error::MeshError::TooLarge),
/// [`MeshError::TooMany`](crate::error::MeshError::TooMany) or [`Error::OutOfMemory`].
pub fn read_off(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    if bytes.is_empty() {
        return Err(MeshFileError::Empty.into());
    }
    refuse_utf16(bytes)?;
    let mut text = Text::new(bytes);
    let layout = Layout::read(&mut text)?;
    text.skip_blanks();
    let Some(rest) = text.rest().strip_prefix(b"BINARY") else {
        return read_text(&layout, text);
    };
    text.continue_with(rest);
    text.skip_blanks();
    let data = match text.rest() {
        [b'\n', ..] => text.taken() + 1,
        [b'\r', b'\n', ..] => text.taken() + 2,
        _ => return Err(text.error("a line end behind `BINARY`").into()),
    };
    read_binary(&layout, Bytes::new(bytes, data))
}

/// The layout of vertices, as the keyword announces it.
#[derive(Default)]
struct Layout {
    texture: bool,
    colour: bool,
    normal: bool,
    homogeneous: bool,
    dimension: bool,
}

impl Layout {
    /// Takes the keyword, if there is one.
    fn read(text: &mut Text) -> Result<Self, Error> {
        skip(text);
        let mut layout = Self::default();
        let mut rest = text.rest();
        loop {
            let (flag, behind) = match rest {
                [b'O', b'F', b'F', rest @ ..] | [b'o', b'f', b'f', rest @ ..] => {
                    text.continue_with(rest);
                    break;
                }
                [b'S', b'T', rest @ ..] => (&mut layout.texture, rest),
                [b'C', rest @ ..] => (&mut layout.colour, rest),
                [b'N', rest @ ..] => (&mut layout.normal, rest),
                [b'4', rest @ ..] => (&mut layout.homogeneous, rest),
                [b'n', rest @ ..] => (&mut layout.dimension, rest),
                // No keyword: the file begins with the counts.
                _ => return Ok(Self::default()),
            };
            if core::mem::replace(flag, true) {
                return Ok(Self::default());
            }
            rest = behind;
        }
        if text.rest().first().is_some_and(|byte| byte.is_ascii_alphabetic()) {
            return Err(text.error("a line end or the number of vertices behind `OFF`").into());
        }
        Ok(layout)
    }

    /// Returns the number of numbers after the coordinates of a vertex, without its colour.
    fn others(&self) -> usize {
        3 * self.normal as usize + 2 * self.texture as usize
    }

    /// Returns the coordinates divided by the fourth one, if there is one.
    #[inline]
    fn position(&self, [x, y, z, w]: [f64; 4]) -> Option<[f64; 3]> {
        let position = if self.homogeneous { [x / w, y / w, z / w] } else { [x, y, z] };
        position.iter().all(|x| x.is_finite()).then_some(position)
    }
}

const DIMENSION: &str = "three dimensions: in any other number `nOFF` is no surface in space";
const FOURTH: &str = "a fourth coordinate that can divide the others";
const LITTLE_ENDIAN: &str =
    "big-endian numbers, which an OFF BINARY has; the counts make sense in little-endian order only";
const NO_CORNER: &str = "a face of at least one corner";

// ---- text -----------------------------------------------------------------------------------------------

/// Takes white space and comments.
#[inline]
fn skip(text: &mut Text) {
    loop {
        text.skip_space();
        match text.rest() {
            [b'#', ..] => text.skip_line(),
            _ => return,
        }
    }
}

/// Takes blanks; returns whether the line ends there, perhaps with a comment.
#[inline]
fn line_ends(text: &mut Text) -> bool {
    text.skip_blanks();
    matches!(text.rest(), [] | [b'\n' | b'\r' | b'#', ..])
}

#[cold]
fn error(text: &Text, expected: &'static str) -> Error {
    text.error(if text.is_at_end() { TOO_SHORT } else { expected }).into()
}

#[inline]
fn coordinate(text: &mut Text) -> Result<f64, Error> {
    skip(text);
    text.number().ok_or_else(|| error(text, "a finite number"))
}

/// Takes an integer that is not negative.
#[inline]
fn count(text: &mut Text, expected: &'static str) -> Result<u64, Error> {
    skip(text);
    let start = *text;
    text.integer().and_then(|count| u64::try_from(count).ok()).ok_or_else(|| error(&start, expected))
}

/// Takes a number that is not needed.
#[inline]
fn skip_number(text: &mut Text, expected: &'static str) -> Result<(), Error> {
    if !matches!(text.rest(), [b'0'..=b'9' | b'+' | b'-' | b'.' | b'i' | b'I' | b'n' | b'N', ..]) {
        return Err(error(text, expected));
    }
    text.word();
    Ok(())
}

fn read_text(layout: &Layout, mut text: Text) -> Result<TriangleMesh, Error> {
    if layout.dimension {
        skip(&mut text);
        let start = text;
        if count(&mut text, "the number of dimensions")? != 3 {
            return Err(start.error(DIMENSION).into());
        }
    }
    skip(&mut text);
    let start = text;
    let vertices = count(&mut text, "`OFF`, or the number of vertices")?;
    if vertices > u32::MAX.into() {
        return Err(start.error("at most 2^32 - 1 vertices").into());
    }
    let on_one_line = !line_ends(&mut text);
    let faces = count(&mut text, "the number of faces")?;
    if !(on_one_line && line_ends(&mut text)) {
        skip(&mut text);
        text.integer().ok_or_else(|| error(&text, "the number of edges"))?;
    }
    let mut mesh = Polygons::default();
    // The shortest text of a vertex is `0 0 0 `, of a face with three corners `3 0 0 0 `.
    let present =
        |count: u64, length: usize| count.min(text.rest().len() as u64 / length as u64 + 1) as usize;
    mesh.reserve(present(vertices, 6), present(faces, 8))?;
    for _ in 0..vertices {
        let mut vertex = [0.0; 4];
        for x in &mut vertex[..3 + layout.homogeneous as usize] {
            *x = coordinate(&mut text)?;
        }
        mesh.push_vertex(layout.position(vertex).ok_or_else(|| text.error(FOURTH))?)?;
        if layout.colour {
            let mut left = 0;
            while !line_ends(&mut text) {
                skip_number(&mut text, "the numbers of a colour")?;
                left += 1;
            }
            if left != layout.others() + 3 && left != layout.others() + 4 {
                return Err(text.error(OTHERS).into());
            }
        } else {
            for _ in 0..layout.others() {
                skip(&mut text);
                skip_number(&mut text, OTHERS)?;
            }
        }
    }
    let mut corners = Vec::new();
    for _ in 0..faces {
        skip(&mut text);
        let start = text;
        let number = count(&mut text, "the number of corners of a face")?;
        if number == 0 {
            return Err(start.error(NO_CORNER).into());
        }
        corners.clear();
        for _ in 0..number {
            skip(&mut text);
            let start = text;
            let index = text.integer().ok_or_else(|| error(&start, "the index of a vertex"))?;
            match u32::try_from(index) {
                Ok(corner) if u64::from(corner) < vertices => memory::push(&mut corners, corner)?,
                _ => return Err(MeshFileError::Index { line: start.line(), index, vertices }.into()),
            }
        }
        let mut left = 0;
        while !line_ends(&mut text) {
            left += 1;
            if left > 4 {
                return Err(text.error(COLOUR).into());
            }
            skip_number(&mut text, COLOUR)?;
        }
        mesh.push_face(&corners)?;
    }
    skip(&mut text);
    if !text.is_at_end() {
        return Err(text.error(TOO_LONG).into());
    }
    mesh.finish()
}

const OTHERS: &str =
    "the numbers of a normal, a colour or a texture behind the coordinates, as the keyword has it";
const COLOUR: &str = "the end of the line, or at most four numbers of a colour";

// ---- binary ---------------------------------------------------------------------------------------------

/// Returns whether the header's counts only make sense in little-endian order, which OFF does not allow: in
/// big-endian order the file would be too short.
fn is_little_endian(layout: &Layout, data: &[u8]) -> bool {
    let counts = data.get(4 * layout.dimension as usize..).unwrap_or(&[]);
    let number = |k: usize, order: fn([u8; 4]) -> i32| {
        let bytes = counts.get(4 * k..).and_then(|rest| rest.first_chunk::<4>())?;
        u64::try_from(order(*bytes)).ok()
    };
    // A face has at least its number of corners, one corner and the length of its colour.
    let vertex = 4 * (3 + layout.homogeneous as u64 + layout.others() as u64 + 4 * layout.colour as u64);
    let is_whole = |order| match (number(0, order), number(1, order)) {
        (Some(vertices), Some(faces)) => 12 + vertices * vertex + faces * 12 <= counts.len() as u64,
        _ => false,
    };
    is_whole(i32::from_le_bytes) && !is_whole(i32::from_be_bytes)
}

fn read_binary(layout: &Layout, mut bytes: Bytes<true>) -> Result<TriangleMesh, Error> {
    if is_little_endian(layout, bytes.rest()) {
        return Err(bytes.error(LITTLE_ENDIAN).into());
    }
    let mut number_of = |problem: &'static str| -> Result<u32, Error> {
        let start = bytes;
        let number = i32::from_le_bytes(bytes.number()?);
        u32::try_from(number).map_err(|_| start.error(problem).into())
    };
    if layout.dimension && number_of(DIMENSION)? != 3 {
        return Err(bytes.error(DIMENSION).into());
    }
    let vertices = number_of("the number of vertices")?;
    let faces = number_of("the number of faces")?;
    // Skip the number of edges.
    bytes.take(4)?;
    let coordinates = 3 + layout.homogeneous as usize;
    let others = 4 * (layout.others() + 4 * layout.colour as usize);
    let mut mesh = Polygons::default();
    // A face with three corners has at least its number of corners, the corners and the length of its colour.
    let present = |count: u32, length: usize| (count as usize).min(bytes.rest().len() / length);
    mesh.reserve(present(vertices, 4 * coordinates + others), present(faces, 20))?;
    for _ in 0..vertices {
        let mut vertex = [0.0; 4];
        for x in &mut vertex[..coordinates] {
            let start = bytes;
            *x = f64::from(f32::from_le_bytes(bytes.number()?));
            if !x.is_finite() {
                return Err(start.error("a finite number").into());
            }
        }
        mesh.push_vertex(layout.position(vertex).ok_or_else(|| bytes.error(FOURTH))?)?;
        bytes.take(others as u64)?;
    }
    let mut corners = Vec::new();
    for _ in 0..faces {
        let start = bytes;
        let number = i32::from_le_bytes(bytes.number()?);
        let number = u64::try_from(number).ok().filter(|&number| number > 0);
        let number = number.ok_or_else(|| start.error(NO_CORNER))?;
        let start = bytes;
        let indices = bytes.take(4 * number)?;
        corners.clear();
        corners.try_reserve(indices.len() / 4)?;
        for (k, index) in indices.as_chunks::<4>().0.iter().enumerate() {
            let index = i32::from_be_bytes(*index);
            match u32::try_from(index) {
                Ok(corner) if corner < vertices => corners.push(corner),
                _ => return Err(start.index_error(4 * k, index.into(), vertices.into()).into()),
            }
        }
        let start = bytes;
        let colour = i32::from_le_bytes(bytes.number()?);
        let colour = u64::try_from(colour).ok().filter(|&numbers| numbers <= 4);
        bytes.take(4 * colour.ok_or_else(|| start.error("at most four numbers of a colour"))?)?;
        mesh.push_face(&corners)?;
    }
    bytes.end()?;
    mesh.finish()
}

#[cfg(test)]
mod tests {
    use super::super::tests::{is_syntax_error, random_polygons, same, truncations_and_damages};
    use super::*;
    use crate::error::MeshError;
    use crate::mesh::FillRule;
    use alloc::string::{String, ToString};
    use alloc::{format, vec};
    use proptest::prelude::*;

    const CORNERS: [[f64; 3]; 4] = [[0., 0., 0.], [1.5, 0., 0.], [0., 2.25, 0.], [0., 0., 0.125]];
    const FACES: &str = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

    /// A tetrahedron whose vertices have more numbers after the coordinates.
    fn with(header: &str, more: &str) -> String {
        let line = |[x, y, z]: [f64; 3]| format!("{x} {y} {z}{more}\n");
        format!("{header}\n4 4 6\n{}{FACES}", CORNERS.map(line).concat())
    }

    fn plain() -> String {
        with("OFF", "")
    }

    #[track_caller]
    fn assert_tetrahedron(bytes: impl AsRef<[u8]>) {
        let mesh = read_off(bytes.as_ref()).unwrap();
        assert_eq!(mesh.vertices(), CORNERS);
        assert_eq!(mesh.triangles(), [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
        mesh.check_closed(FillRule::NonZero).unwrap();
    }

    #[track_caller]
    fn assert_syntax(text: impl AsRef<[u8]>, at: u64, what: &str) {
        is_syntax_error(read_off(text.as_ref()), at, what);
    }

    #[test]
    fn headers() {
        let plain = plain();
        assert_tetrahedron(&plain);
        assert_tetrahedron(plain.replace("OFF\n", "OFF "));
        assert_tetrahedron(plain.replace("OFF\n", "OFF"));
        assert_tetrahedron(plain.replace("OFF\n", "off\n"));
        assert_tetrahedron(plain.replace("OFF\n", ""));
        assert_tetrahedron(plain.replace("OFF\n", "\r\n# OFF\n\n  OFF # OFF\n# 1 2 3\n"));
        assert_tetrahedron(format!("\u{FEFF}{plain}"));
        // The number of edges.
        for edges in ["4 4", "4 4 # 6", "4 4 -1", "4 4 999", "4\n4\n6", "4\n4 6", "4 # a\n\n 4 # b\n6"] {
            assert_tetrahedron(plain.replace("4 4 6", edges));
            assert_tetrahedron(plain.replace("OFF\n4 4 6", edges));
            assert_tetrahedron(plain.replace("OFF\n4 4 6", &format!("OFF {edges}")));
        }
        assert_eq!(read_off(b"OFF 0 0 0").unwrap().triangles().len(), 0);
        assert_eq!(read_off(b"0 0").unwrap().triangles().len(), 0);
    }

    #[test]
    fn headers_with_prefixes() {
        for end in ["", " ", " # more\n"] {
            let with = |header: &str, more: &str| with(header, &(more.to_string() + end));
            for colour in [" 255 0 0 255", " 0.5 0 1", " 1 0 0 1.0", " 0 0 0"] {
                assert_tetrahedron(with("COFF", colour));
                assert_tetrahedron(with("CNOFF", &format!(" 0 0 1{colour}")));
                assert_tetrahedron(with("NCOFF", &format!("{colour} nan nan nan")));
                assert_tetrahedron(with("STCN4nOFF\n3", &format!(" 1 0 0 1{colour} 0.5 0.5")));
            }
            assert_tetrahedron(with("NOFF", " 0 -1 1e-3"));
            assert_tetrahedron(with("STOFF", " .5 .5"));
            assert_tetrahedron(with("STNOFF", " 0 0 1 .5 .5"));
            assert_tetrahedron(with("4OFF", " 1"));
            assert_tetrahedron(with("nOFF\n3", ""));
            assert_tetrahedron(with("nOFF 3", ""));
            assert_tetrahedron(with("4nOFF 3", " 1"));
        }
        // Line ends do not matter unless there are colours.
        assert_tetrahedron(with("NOFF", "\n0 0\n1"));
        assert_tetrahedron(plain().replace(' ', "\n"));
        let mesh = read_off(b"4OFF 1 0 0 1 2 3 4").unwrap();
        assert_eq!(mesh.vertices(), [[0.25, 0.5, 0.75]]);
    }

    #[test]
    fn bad_headers() {
        assert!(matches!(read_off(b""), Err(Error::MeshFile(MeshFileError::Empty))));
        for text in [
            "OF\n",
            "OFFX 4 4 6",
            "XOFF\n4 4 6",
            "COFFEE 4 4",
            "NNOFF 0 0 0",
            "solid a",
            "ply\n",
            "v 1 2 3\n",
            "OFF x",
        ] {
            assert_syntax(text, 1, "`OFF`");
        }
        assert_syntax("\n# a\nOFF_BINARY\n", 3, "`OFF`");
        assert_syntax("OFF BINARY 1\n", 1, "line end");
        assert_syntax("# nothing", 1, "shorter");
        assert_syntax("OFF", 1, "shorter");
        assert_syntax("OFF\n4\n", 2, "shorter");
        assert_syntax("OFF -4 4 6", 1, "number of vertices");
        assert_syntax("OFF\n4 4.0 6", 2, "number of faces");
        assert_syntax("OFF\n4 4 x", 2, "number of edges");
        assert_syntax("OFF\n4\n4\n0.5 1 2", 4, "number of edges");
        assert_syntax("nOFF\n4\n1 0 0\n0 0 0 0\n", 2, "three dimensions");
        assert_syntax("nOFF\nx", 2, "number of dimensions");
        assert_syntax("OFF 4294967296 0 0", 1, "2^32 - 1");
    }

    #[test]
    fn text_data() {
        let plain = plain();
        for end in ["\r\n", "\r", "\n\n", " # c\n", "\n#\n \t"] {
            assert_tetrahedron(plain.replace('\n', end));
        }
        assert_tetrahedron(plain.replace(' ', "\t  "));
        assert_tetrahedron(plain.trim_end());
        assert_tetrahedron(format!("{plain}# end\n\x1A\0"));
        for colour in ["7", "255 0 0", "255 0 0 255", "0.1 0.2 0.3", ".1 .2 .3 1 # red", "-1"] {
            assert_tetrahedron(plain.replace("0 3\n", &format!("0 3 {colour}\n")));
        }
        let change = |from: &str, to: &str| plain.replacen(from, to, 1);
        assert_syntax(change("0 3\n", "0 3 1 2 3 4 5\n"), 10, "four numbers");
        assert_syntax(change("0 3\n", "0 3 red\n"), 10, "four numbers");
        assert_syntax(change("0 3\n", "0 3 1 x\n"), 10, "four numbers");
        for number in ["nan", "inf", "1e999", "1d5", "x", "1,5"] {
            assert_syntax(change("1.5", number), 4, "finite");
        }
        assert_syntax(change("3 0 2 1", "0 0 2 1"), 7, "at least one");
        assert_syntax(change("3 0 2 1", "-3 0 2 1"), 7, "number of corners");
        assert_syntax(change("3 0 2 1", "3.0 0 2 1"), 7, "number of corners");
        assert_syntax(change("3 0 2 1", "3 0 2 x"), 7, "index");
        assert_syntax(change("3 0 2 1", "3 0 2 1.0"), 7, "index");
        assert_syntax(change("4 4 6", "4 5 6"), 10, "shorter");
        assert_syntax(change("4 4 6", "4 3 6"), 10, "longer");
        assert_syntax(change("4 4 6", "5 4 6"), 10, "shorter");
        assert_syntax(change("4 4 6", "3 4 6"), 6, "at least one");
        assert_syntax(change("4 4 6", "4000000000 4 6"), 10, "shorter");
        assert_syntax(change("4 4 6", "4 4000000000 6"), 10, "shorter");
        for index in [-1, 4, 4_294_967_295, 4_294_967_296] {
            match read_off(change("3 0 2 1", &format!("3 0\n {index} 1")).as_bytes()) {
                Err(Error::MeshFile(MeshFileError::Index { line: 8, index: found, vertices: 4 })) => {
                    assert_eq!(found, index);
                }
                other => panic!("{other:?}"),
            }
        }
        // Colours that the keyword does not announce.
        assert_syntax(with("OFF", " 255 0 0"), 5, "at least one");
        assert_syntax(with("COFF", ""), 3, "as the keyword has it");
        assert_syntax(with("COFF", " 1 2"), 3, "as the keyword has it");
        assert_syntax(with("COFF", " 1 2 3 4 5"), 3, "as the keyword has it");
        assert_syntax(with("COFF", " red 2 3"), 3, "colour");
        assert_syntax(with("NOFF", " x 2 3"), 3, "as the keyword has it");
        for (fourth, line) in [(" 0", 3), (" -0", 3), (" 1e-320", 4)] {
            assert_syntax(with("4OFF", fourth), line, "fourth");
        }
        assert!(matches!(
            read_off(change("1.5", "1e78").as_bytes()),
            Err(Error::Mesh(MeshError::TooLarge { vertex: 1 }))
        ));
    }

    #[test]
    fn points_and_lines_are_skipped() {
        let text = plain().replace("4 4 6", "4 6 6") + "2 0 1 255 0 0\n1 3\n";
        assert_tetrahedron(&text);
        assert_syntax(&text[..text.len() - 4], 11, "shorter");
    }

    /// A binary file whose vertices have the given numbers, the coordinates first.
    fn binary(
        header: &str,
        start: &[i32],
        numbers: usize,
        vertices: &[[f64; 3]],
        faces: &[Vec<u32>],
        colour: usize,
    ) -> Vec<u8> {
        let mut bytes = format!("{header} BINARY\n").into_bytes();
        let counts = [vertices.len() as i32, faces.len() as i32, 0];
        start.iter().chain(&counts).for_each(|count| bytes.extend(count.to_be_bytes()));
        for vertex in vertices {
            (0..numbers).for_each(|k| bytes.extend(vertex.get(k).map_or(1.0, |&x| x as f32).to_be_bytes()));
        }
        for face in faces {
            [&[face.len() as u32], &face[..], &[colour as u32]]
                .concat()
                .iter()
                .for_each(|i| bytes.extend(i.to_be_bytes()));
            (0..colour).for_each(|_| bytes.extend(0.5f32.to_be_bytes()));
        }
        bytes
    }

    fn faces() -> Vec<Vec<u32>> {
        vec![vec![0, 2, 1], vec![0, 1, 3], vec![1, 2, 3], vec![2, 0, 3]]
    }

    #[test]
    fn binary_files() {
        for (header, start, numbers) in [
            ("OFF", &[][..], 3),
            ("COFF", &[], 7),
            ("NOFF", &[], 6),
            ("STCNOFF", &[], 12),
            ("4OFF", &[], 4),
            ("nOFF", &[3], 3),
            ("#\n4nOFF", &[3], 4),
        ] {
            for colour in [0, 1, 3, 4] {
                let bytes = binary(header, start, numbers, &CORNERS, &faces(), colour);
                assert_tetrahedron(&bytes);
                let text = bytes.windows(2).position(|pair| pair == b"Y\n").unwrap() + 1;
                assert_tetrahedron([&bytes[..text], b" \r\n", &bytes[text + 1..]].concat());
                assert_tetrahedron([&bytes[..], &b"\n\0\0\x1A"[..]].concat());
                for length in bytes.len() - 100..bytes.len() {
                    assert_binary(&bytes[..length], length, "shorter");
                }
                assert_binary(&[&bytes[..], &b"\n1"[..]].concat(), bytes.len(), "longer");
            }
        }
    }

    #[track_caller]
    fn assert_binary(bytes: &[u8], at: usize, what: &str) {
        match read_off(bytes) {
            Err(Error::MeshFile(MeshFileError::Binary { offset, expected })) => {
                assert_eq!(offset, at as u64, "{expected}");
                assert!(expected.contains(what), "{expected}");
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn binary_data() {
        let bytes = binary("OFF", &[], 3, &CORNERS, &faces(), 1);
        let start = "OFF BINARY\n".len();
        let change = |at: usize, new: [u8; 4]| {
            let mut changed = bytes.clone();
            changed[start + at..start + at + 4].copy_from_slice(&new);
            changed
        };
        assert_binary(&change(0, (-1i32).to_be_bytes()), start, "number of vertices");
        assert_binary(&change(4, (-1i32).to_be_bytes()), start + 4, "number of faces");
        assert_binary(&change(0, i32::MAX.to_be_bytes()), bytes.len(), "shorter");
        assert_binary(&change(4, i32::MAX.to_be_bytes()), bytes.len(), "shorter");
        assert_binary(&change(20, f32::NAN.to_be_bytes()), start + 20, "finite");
        assert_binary(&change(24, f32::INFINITY.to_be_bytes()), start + 24, "finite");
        assert_binary(&change(60, 0i32.to_be_bytes()), start + 60, "at least one");
        assert_binary(&change(60, (-3i32).to_be_bytes()), start + 60, "at least one");
        assert_binary(&change(60, i32::MAX.to_be_bytes()), bytes.len(), "shorter");
        assert_binary(&change(76, 5i32.to_be_bytes()), start + 76, "colour");
        assert_binary(&change(76, (-1i32).to_be_bytes()), start + 76, "colour");
        assert_binary(&binary("4OFF", &[], 4, &CORNERS, &faces(), 0)[..40], 40, "shorter");
        assert_binary(&binary("nOFF", &[4], 4, &CORNERS, &faces(), 0), 16, "three dimensions");
        for index in [-1, 4, i32::MAX, i32::MIN] {
            match read_off(&change(68, index.to_be_bytes())) {
                Err(Error::MeshFile(MeshFileError::BinaryIndex { offset, index: found, vertices: 4 })) => {
                    assert_eq!((offset, found), (start as u64 + 68, index.into()));
                }
                other => panic!("{other:?}"),
            }
        }
    }

    #[test]
    fn little_endian_files_are_called_so() {
        for (header, start, numbers) in [("OFF", &[][..], 3), ("CNOFF", &[], 10), ("nOFF", &[3], 3)] {
            let mut bytes = binary(header, start, numbers, &CORNERS, &faces(), 0);
            let data = bytes.iter().position(|&b| b == b'\n').unwrap() + 1;
            bytes[data..].as_chunks_mut::<4>().0.iter_mut().for_each(|number| number.reverse());
            assert_binary(&bytes, data, "little-endian");
            assert!(read_off(&bytes[..data + 12]).is_err());
        }
    }

    #[test]
    fn truncated_and_damaged() {
        truncations_and_damages(read_off, plain().as_bytes());
        truncations_and_damages(read_off, with("CNOFF", " 0 0 1 255 0 0").as_bytes());
        truncations_and_damages(read_off, &binary("4OFF", &[], 4, &CORNERS, &faces(), 3));
        let text = plain();
        for length in 0..text.len() - 2 {
            assert!(read_off(&text.as_bytes()[..length]).is_err(), "{length}");
        }
    }

    proptest! {
        #![proptest_config(leafless_testkit::cases(1000))]

        /// Any mesh, in any dialect.
        #[test]
        fn written_meshes_come_back(
            (vertices, faces) in random_polygons(),
            keyword in proptest::sample::select(&["", "OFF ", "OFF\n", "COFF\n", "NOFF\n", "STOFF\n", "4OFF\n", "nOFF 3\n"][..]),
            style in any::<[u8; 3]>(),
        ) {
            let gap = [" ", "\t", "  "][style[0] as usize % 3];
            let end = ["\n", "\r\n", " # c\n", "\n\n"][style[1] as usize % 4];
            let more = match keyword.as_bytes().first() {
                Some(b'C') => " 1 0 0 1",
                Some(b'N') => " 0 0 1",
                Some(b'S') => " 0.5 1",
                Some(b'4') => " 1",
                _ => "",
            };
            let mut text = format!("{keyword}{} {}{end}", vertices.len(), faces.len());
            for [x, y, z] in &vertices {
                text += &format!("{x}{gap}{y:e}{gap}{z}{more}{end}");
            }
            for face in &faces {
                let corners: Vec<String> = face.iter().map(u32::to_string).collect();
                let colour = ["", " 1 2 3", " 0.5 0.5 0.5 1"][style[2] as usize % 3];
                text += &format!("{}{gap}{}{colour}{end}", face.len(), corners.join(gap));
            }
            same(read_off(text.as_bytes()).unwrap(), vertices.clone(), &faces);

            let narrow: Vec<[f64; 3]> = vertices.iter().map(|v| v.map(|x| f64::from(x as f32))).collect();
            same(read_off(&binary("OFF", &[], 3, &vertices, &faces, 0)).unwrap(), narrow, &faces);
        }

        #[test]
        fn any_data(text in "[0-9.e #\n-]{0,100}", bytes in proptest::collection::vec(any::<u8>(), 0..100)) {
            let _ = read_off(text.as_bytes());
            let _ = read_off(format!("COFF 4 4\n{text}").as_bytes());
            let _ = read_off(&[&b"OFF BINARY\n\0\0\0\x01\0\0\0\x01"[..], &bytes].concat());
        }
    }
}
