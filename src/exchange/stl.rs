//! STL files, binary and ASCII: reads triangle soups and welds them to a mesh.
//!
//! **Binary or ASCII.** Let n be the number in bytes 80 to 83, where a binary file has its facet count. A
//! file whose length is exactly 84 + 50 n is binary, even if its header begins with `solid`. (An ASCII file
//! below 7 gigabytes cannot have this length, because four text characters make n at least 0x09090909.) Any
//! other file is ASCII if its first word is `solid` and none of the bytes 80 to 83 is zero; in a binary file
//! of less than 2^24 facets the last of them always is. All remaining files are binary.
//!
//! **Binary.** Coordinates are `f32` and kept exactly. The counted facets may be followed by up to 49 bytes,
//! or by any number of zero bytes, as block-wise transfers append them. If there is more, the count must be
//! wrong, and the file is refused rather than read in part. Headers, colours and normals are ignored.
//!
//! **ASCII.** Keywords may have any letter case, and any white space and line ends between them. A file may
//! contain any number of solids, which all become one mesh; the bodies stay apart because they share no edge.
//! A name is all text after `solid` or `endsolid` on the same line, in any encoding. Normals are ignored and
//! may be garbage or absent, because programs that cannot compute one print texts like `-nan(ind)`. A loop of
//! more than three vertices is divided into a fan from its first vertex. For a planar polygon this is right
//! even if it is not convex, because the winding numbers around the surface are the same for every
//! triangulation. `endsolid` may be missing at the end of the file, but only after a complete facet.
//!
//! A decimal coordinate becomes the nearest `f64`, not the nearest `f32`, because this is nearer to the
//! written number. Two facets share a common vertex if they print it alike; with different digits they do
//! not.
//!
//! **Numerical noise.** Some CAD programs write 0 for a coordinate in one facet and 1e-16 in the next. The
//! surface in such a file is open. The reader does not round it silently; [`TriangleMesh::sewn`] closes such
//! cracks and reports how far it moved vertices.

use super::{is_line_end, is_space, refuse_utf16};
use crate::error::{Error, MeshFileError};
use crate::mesh::{FacetWelder, TriangleMesh};

/// Number of bytes of a binary file before its facets: 80 of header, 4 of count.
pub(super) const HEADER: usize = 84;
/// Number of bytes of a facet in a binary file: normal, three vertices, two bytes of attributes.
const FACET: usize = 50;

/// Reads a binary or ASCII STL file; the bytes decide which of the two it is.
///
/// Vertices at equal positions are welded, and facets that become degenerate by that are dropped and counted,
/// as in [`TriangleMesh::from_facets`]. The reader does not check that the mesh is closed.
///
/// O(n). Memory is allocated for existing facets only, not for the facets that a header claims.
///
/// # Errors
/// [`MeshFileError::Empty`], [`MeshFileError::Length`], [`MeshFileError::NotFinite`],
/// [`MeshFileError::Syntax`], [`MeshFileError::Unsupported`] (UTF-16),
/// [`MeshError::TooLarge`](crate::error::MeshError::TooLarge),
/// [`MeshError::TooMany`](crate::error::MeshError::TooMany) or [`Error::OutOfMemory`].
pub fn read_stl(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    if bytes.is_empty() {
        return Err(MeshFileError::Empty.into());
    }
    refuse_utf16(bytes)?;
    let count = bytes.get(HEADER - 4..HEADER).and_then(|b| <[u8; 4]>::try_from(b).ok());
    if let Some(count) = count
        && (is_binary_of_exact_length(bytes) || count.contains(&0) || !begins_with_solid(bytes))
    {
        return read_binary(u32::from_le_bytes(count), bytes);
    }
    // Shorter than any binary file, or text.
    read_ascii(bytes)
}

/// Returns whether the file has exactly the length of a binary STL with its facet count.
pub(super) fn is_binary_of_exact_length(bytes: &[u8]) -> bool {
    let count = bytes.get(HEADER - 4..HEADER).and_then(|b| <[u8; 4]>::try_from(b).ok());
    count.is_some_and(|count| binary_length(u32::from_le_bytes(count)) == bytes.len() as u64)
}

/// Returns the number of bytes of a binary file with this number of facets.
pub(super) fn binary_length(facets: u32) -> u64 {
    HEADER as u64 + FACET as u64 * u64::from(facets)
}

fn read_binary(count: u32, bytes: &[u8]) -> Result<TriangleMesh, Error> {
    let (facets, expected, found) = (u64::from(count), binary_length(count), bytes.len() as u64);
    let wrong_length = MeshFileError::Length { facets, expected, found };
    let end = usize::try_from(expected).map_err(|_| wrong_length)?;
    let body = bytes.get(HEADER..end).ok_or(wrong_length)?;
    let rest = bytes.get(end..).unwrap_or(&[]);
    if rest.len() >= FACET && rest.iter().any(|&b| b != 0) {
        return Err(wrong_length.into());
    }
    let mut welder = FacetWelder::with_capacity(body.len() / FACET)?;
    // Several at a time weld faster than one by one.
    const TOGETHER: usize = 8;
    let mut facets = [[[0.0; 3]; 3]; TOGETHER];
    for (start, bytes) in (0_u64..).step_by(TOGETHER).zip(body.chunks(TOGETHER * FACET)) {
        let facets = &mut facets[..bytes.len() / FACET];
        for ((facet, corners), index) in bytes.chunks_exact(FACET).zip(facets.iter_mut()).zip(start..) {
            // The first 12 bytes are the normal.
            for (x, b) in corners.as_flattened_mut().iter_mut().zip(facet[12..].chunks_exact(4)) {
                *x = f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
            }
            if !corners.as_flattened().iter().all(|x| x.is_finite()) {
                return Err(MeshFileError::NotFinite { facet: index }.into());
            }
        }
        welder.extend(facets)?;
    }
    Ok(welder.finish())
}

fn begins_with_solid(bytes: &[u8]) -> bool {
    Words::new(bytes).next().is_some_and(|w| w.eq_ignore_ascii_case(b"solid"))
}

fn read_ascii(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    let mut words = Words::new(bytes);
    // Most programs write more than 128 bytes per facet, so this is a low estimate.
    let mut welder = FacetWelder::with_capacity(bytes.len() / 256)?;
    words.keyword("solid", "`solid`, or a binary STL of at least 84 bytes")?;
    words.skip_name();
    let mut inside = true;
    let mut may_end = false;
    loop {
        let start = words.clone();
        match words.next() {
            Some(word) if word.eq_ignore_ascii_case(b"facet") => {
                read_facet(&mut words, &mut welder)?;
                (inside, may_end) = (true, true);
            }
            Some(word) if inside && word.eq_ignore_ascii_case(b"endsolid") => {
                words.skip_name();
                (inside, may_end) = (false, true);
            }
            Some(word) if !inside && word.eq_ignore_ascii_case(b"solid") => {
                words.skip_name();
                (inside, may_end) = (true, false);
            }
            None if may_end => return Ok(welder.finish()),
            _ if inside => return Err(start.error("`facet` or `endsolid`").into()),
            _ => return Err(start.error("`solid` or the end of the file").into()),
        }
    }
}

/// Reads a facet, starting after the word `facet`.
fn read_facet(words: &mut Words, welder: &mut FacetWelder) -> Result<(), Error> {
    // `normal` and up to three words of any kind.
    let start = words.clone();
    let mut skipped = 0;
    while !words.next().is_some_and(|w| w.eq_ignore_ascii_case(b"outer")) {
        skipped += 1;
        if skipped > 4 {
            return Err(start.error("`normal`, three numbers and `outer loop`").into());
        }
    }
    words.keyword("loop", "`loop`")?;
    let first = read_vertex(words)?;
    let mut previous = read_vertex(words)?;
    loop {
        let next = read_vertex(words)?;
        welder.push(&[first, previous, next])?;
        previous = next;
        let mut ahead = words.clone();
        if !ahead.next().is_some_and(|w| w.eq_ignore_ascii_case(b"vertex")) {
            break;
        }
    }
    words.keyword("endloop", "`vertex` or `endloop`")?;
    words.keyword("endfacet", "`endfacet`")?;
    Ok(())
}

fn read_vertex(words: &mut Words) -> Result<[f64; 3], MeshFileError> {
    words.keyword("vertex", "`vertex`, at least three times")?;
    Ok([words.number()?, words.number()?, words.number()?])
}

/// The words of a text, separated by white space.
#[derive(Clone)]
struct Words<'a> {
    text: &'a [u8],
    position: usize,
}

impl<'a> Words<'a> {
    fn new(text: &'a [u8]) -> Self {
        let position = if text.starts_with(b"\xEF\xBB\xBF") { 3 } else { 0 };
        // Block-wise transfers and DOS programs append zero bytes and Ctrl-Z.
        let end = text.iter().rposition(|b| !matches!(b, 0 | 0x1A)).map_or(0, |last| last + 1);
        Self { text: &text[..end], position: position.min(end) }
    }

    /// Returns the next word, or `None` at the end of the text.
    #[inline]
    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = &self.text[self.position..];
        let blank = rest.iter().position(|&b| !is_space(b)).unwrap_or(rest.len());
        let rest = &rest[blank..];
        let length = rest.iter().position(|&b| is_space(b)).unwrap_or(rest.len());
        self.position += blank + length;
        (length > 0).then_some(&rest[..length])
    }

    /// Takes a word that must be `keyword` in any letter case.
    #[inline]
    fn keyword(&mut self, keyword: &str, expected: &'static str) -> Result<(), MeshFileError> {
        let start = self.position;
        match self.next() {
            Some(word) if word.eq_ignore_ascii_case(keyword.as_bytes()) => Ok(()),
            _ => Err(Self { position: start, ..*self }.error(expected)),
        }
    }

    /// Takes a word that must be a finite decimal number.
    #[inline]
    fn number(&mut self) -> Result<f64, MeshFileError> {
        let start = self.position;
        let number =
            self.next().and_then(|w| core::str::from_utf8(w).ok()).and_then(|w| w.parse::<f64>().ok());
        match number {
            Some(x) if x.is_finite() => Ok(x),
            _ => Err(Self { position: start, ..*self }.error("a finite number")),
        }
    }

    /// Skips a name, which extends to the end of the line. In a file without line ends it extends to the
    /// words `facet normal`, so that no facet can be lost in a name.
    fn skip_name(&mut self) {
        let mut facet = None;
        loop {
            let rest = &self.text[self.position..];
            let blank = rest.iter().position(|&b| !is_space(b) || is_line_end(b)).unwrap_or(rest.len());
            self.position += blank;
            if rest.get(blank).is_none_or(|&b| is_line_end(b)) {
                return;
            }
            let start = self.position;
            match (self.next(), facet) {
                (Some(word), Some(facet)) if word.eq_ignore_ascii_case(b"normal") => {
                    self.position = facet;
                    return;
                }
                (Some(word), _) if word.eq_ignore_ascii_case(b"facet") => facet = Some(start),
                _ => facet = None,
            }
        }
    }

    /// Returns the error that something else was expected in place of the next word. Its line is that of the
    /// next word, or of the last word if none follows. Lines are counted only here.
    #[cold]
    fn error(&self, expected: &'static str) -> MeshFileError {
        let rest = &self.text[self.position..];
        let blank = rest.iter().position(|&b| !is_space(b)).unwrap_or(0);
        let before = &self.text[..self.position + blank];
        let line_feeds = before.iter().filter(|&&b| b == b'\n').count();
        // A carriage return is a line end unless a line feed follows.
        let returns = before.iter().zip(before.iter().skip(1).chain(&[0]));
        let lone_returns = returns.filter(|&(&b, &next)| b == b'\r' && next != b'\n').count();
        MeshFileError::Syntax { line: 1 + (line_feeds + lone_returns) as u64, expected }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    #[cfg(feature = "std")]
    use super::super::tests::model;
    use super::*;
    use crate::error::MeshError;
    use crate::exchange::write_stl;
    use crate::mesh::FillRule;
    use alloc::string::String;
    use alloc::vec::Vec;
    use alloc::{format, vec};

    const TETRAHEDRON: [[[f32; 3]; 3]; 4] = {
        let [o, x, y, z] = [[0., 0., 0.], [1.5, 0., 0.], [0., 2.25, 0.], [0., 0., 1e-3]];
        [[o, y, x], [o, x, z], [x, y, z], [y, o, z]]
    };

    fn binary(header: &[u8], count: u32, facets: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(80, 0);
        bytes.extend(count.to_le_bytes());
        for facet in facets {
            bytes.extend([0xFF; 12]);
            facet.as_flattened().iter().for_each(|x| bytes.extend(x.to_le_bytes()));
            bytes.extend([0xAB, 0xCD]);
        }
        bytes
    }

    fn body(facets: &[[[f32; 3]; 3]]) -> String {
        let mut text = String::new();
        for facet in facets {
            text += "  facet normal 0 0 1\n    outer loop\n";
            for [x, y, z] in facet {
                text += &format!("      vertex {x:e} {y} {z:E}\n");
            }
            text += "    endloop\n  endfacet\n";
        }
        text
    }

    fn ascii(name: &str) -> String {
        format!("solid {name}\n{}endsolid {name}\n", body(&TETRAHEDRON))
    }

    #[track_caller]
    fn assert_tetrahedra(bytes: impl AsRef<[u8]>, n: usize) {
        let mesh = read_stl(bytes.as_ref()).unwrap();
        assert_eq!(mesh.triangles().len(), 4 * n);
        assert_eq!(mesh.vertices().len(), 4);
        assert_eq!(mesh.check_closed(FillRule::NonZero).is_ok(), n > 0);
        let expected: Vec<[f64; 3]> =
            [[0., 0., 0.], [0., 2.25, 0.], [1.5, 0., 0.], [0., 0., mesh.vertices()[3][2]]].into();
        assert_eq!(mesh.vertices(), expected);
        assert_eq!(mesh.vertices()[3][2] as f32, 1e-3);
    }

    #[track_caller]
    fn assert_syntax(text: impl AsRef<[u8]>, at: u64, what: &str) {
        match read_stl(text.as_ref()) {
            Err(Error::MeshFile(MeshFileError::Syntax { line, expected })) => {
                assert_eq!(line, at, "{expected}");
                assert!(expected.contains(what), "{expected}");
            }
            other => panic!("{other:?}"),
        }
    }

    #[track_caller]
    fn assert_length(bytes: impl AsRef<[u8]>) {
        let result = read_stl(bytes.as_ref());
        assert!(matches!(result, Err(Error::MeshFile(MeshFileError::Length { .. }))), "{result:?}");
    }

    #[test]
    fn binary_files() {
        assert_tetrahedra(binary(b"", 4, &TETRAHEDRON), 1);
        assert_eq!(read_stl(&binary(b"x", 0, &[])).unwrap().triangles().len(), 0);
        let exact = read_stl(&binary(b"", 4, &TETRAHEDRON)).unwrap();
        assert_eq!(exact.vertices()[3][2], f64::from(1e-3_f32));
    }

    #[test]
    fn binary_files_that_begin_with_solid() {
        for header in
            [&b"solid"[..], b"solid part\n", b"SOLID \xFF\xFE", &[&b"solid"[..], &[b' '; 75]].concat()]
        {
            assert_tetrahedra(binary(header, 4, &TETRAHEDRON), 1);
            assert_tetrahedra([binary(header, 4, &TETRAHEDRON), vec![7; 49]].concat(), 1);
            assert_length(&binary(header, 4, &TETRAHEDRON)[..283]);
        }
    }

    #[test]
    fn binary_files_of_wrong_length() {
        let good = binary(b"", 4, &TETRAHEDRON);
        for tail in [vec![1; 1], vec![1; 49], vec![0; 50], vec![0; 512]] {
            assert_tetrahedra([good.clone(), tail].concat(), 1);
        }
        assert_length([good.clone(), vec![1; 50]].concat());
        assert_length(binary(b"", 3, &TETRAHEDRON));
        assert_length(binary(b"", 0, &TETRAHEDRON));
        assert_length(binary(b"", 5, &TETRAHEDRON));
        // This many facets would need 215 GB: refused before anything is allocated.
        let result = read_stl(&binary(b"", u32::MAX, &TETRAHEDRON));
        let (facets, expected, found) = (u64::from(u32::MAX), 84 + 50 * u64::from(u32::MAX), 284);
        assert!(matches!(result,
            Err(Error::MeshFile(MeshFileError::Length { facets: f, expected: e, found: l }))
            if (f, e, l) == (facets, expected, found)));
    }

    #[test]
    fn binary_files_with_bad_coordinates() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut facets = TETRAHEDRON;
            facets[2][1][2] = bad;
            let result = read_stl(&binary(b"", 4, &facets));
            assert!(
                matches!(result, Err(Error::MeshFile(MeshFileError::NotFinite { facet: 2 }))),
                "{result:?}"
            );
        }
        // Every finite number is accepted.
        let mut facets = TETRAHEDRON;
        facets[2][1][2] = f32::MAX;
        assert_eq!(read_stl(&binary(b"", 4, &facets)).unwrap().bounds().1[2], f64::from(f32::MAX));
    }

    #[test]
    fn ascii_files() {
        let plain = ascii("a");
        assert_tetrahedra(&plain, 1);
        assert_eq!(read_stl(plain.as_bytes()).unwrap().vertices()[3][2], 1e-3);
        assert_tetrahedra(ascii(""), 1);
        assert_tetrahedra(ascii("").replace("solid ", "solid"), 1);
        assert_tetrahedra(ascii("a name of facet and vertex, facet\t normality endsolid"), 1);
        assert_tetrahedra(plain.to_uppercase(), 1);
        assert_tetrahedra(plain.replace("facet", "Facet").replace("loop", "lOOp"), 1);
        assert_tetrahedra(plain.replace('\n', "\r\n"), 1);
        assert_tetrahedra(plain.replace('\n', "\r"), 1);
        assert_tetrahedra(plain.replace('\n', "\n\n\t \x0B\x0C"), 1);
        assert_tetrahedra(plain.replace("\n ", " "), 1);
        assert_tetrahedra(
            plain.replace(' ', "\n").replacen("solid\n", "solid ", 1).replace("endsolid\n", "endsolid "),
            1,
        );
        assert_tetrahedra(format!("\u{FEFF}{plain}"), 1);
        assert_tetrahedra(format!("\r\n \n{plain}"), 1);
        assert_tetrahedra(format!("{plain}\x1A\0\0\0"), 1);
        let mut latin = b"solid M\xFCller \xC3".to_vec();
        latin.extend_from_slice(&plain.as_bytes()[7..]);
        assert_tetrahedra(latin, 1);
        assert_eq!(read_stl(b"solid\nendsolid").unwrap().triangles().len(), 0);
    }

    #[test]
    fn ascii_files_of_several_solids() {
        let two = ascii("a") + &ascii("b b");
        assert_tetrahedra(&two, 2);
        assert_tetrahedra(format!("{two}\nsolid\nendsolid\n{}", ascii("")), 3);
        // All on one line: names end at the next facet, and no facet is lost.
        assert_tetrahedra(two.replace('\n', " "), 2);
        assert_tetrahedra(two.replace('\n', " ").replace("endsolid a", "endsolid"), 2);
        let apart = ascii("a") + &ascii("b").replace("vertex 0e0", "vertex 7");
        assert_eq!(read_stl(apart.as_bytes()).unwrap().report().unwrap().bodies, 2);
    }

    #[test]
    fn ascii_normals_are_ignored() {
        for normal in
            ["normal nan nan NaN", "normal -nan(ind) 1.#QNAN x", "normal 0,0,1", "normal", "", "0 0 1"]
        {
            assert_tetrahedra(ascii("a").replace("normal 0 0 1", normal), 1);
        }
        assert_syntax(ascii("a").replacen("normal 0 0 1", "normal 0 0 1 0", 1), 2, "`normal`");
    }

    #[test]
    fn ascii_numbers() {
        let read = |number: &str| {
            let text = ascii("a").replace("1.5e0", number);
            read_stl(text.as_bytes()).map(|mesh| mesh.vertices()[2][0])
        };
        let numbers = [("1.", 1.0), (".5", 0.5), ("+2E+0", 2.0), ("-3e-1", -0.3), ("5.7e-046", 5.7e-46)];
        for (text, value) in numbers {
            assert_eq!(read(text).unwrap(), value);
        }
        assert_eq!(read("0.1").unwrap(), 0.1);
        assert_eq!(read("1e-999").unwrap(), 0.0);
        assert_eq!(read(&"1".repeat(60)).unwrap(), 1.1111111111111111e59);
        for text in ["nan", "inf", "1e999", "1,5", "0x10", "1.5f", "--1", "\u{661}", "1 2"] {
            assert!(matches!(read(text), Err(Error::MeshFile(MeshFileError::Syntax { .. }))), "{text}");
        }
        assert!(matches!(read("1e78"), Err(Error::Mesh(MeshError::TooLarge { vertex: 2 }))));
    }

    #[test]
    fn ascii_polygons_become_fans() {
        // A cube of six quadrilaterals.
        let corner = |i: usize| format!("vertex {} {} {}\n", i & 1, i >> 1 & 1, i >> 2);
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let facet = |f: [usize; 4]| format!("facet outer loop {} endloop endfacet ", f.map(corner).concat());
        let mesh = read_stl(format!("solid\n{}", faces.map(facet).concat()).as_bytes()).unwrap();
        assert_eq!(mesh.triangles().len(), 12);
        assert_eq!(mesh.volume(), 1.0);
        mesh.check_closed(FillRule::NonZero).unwrap();
    }

    #[test]
    fn ascii_errors_name_the_line() {
        let text = ascii("a");
        assert_syntax(text.replacen("endloop", "vertices", 1), 7, "`endloop`");
        assert_syntax(text.replacen("outer loop", "outer\r\n\r\nlop", 1), 5, "`loop`");
        assert_syntax(text.replacen("outer loop", "outer\r\rlop", 1), 5, "`loop`");
        assert_syntax(text.replacen("1.5e0", "1.5e", 1), 6, "number");
        assert_syntax(text.replacen("endfacet", "facet", 1), 8, "`endfacet`");
        assert_syntax(text.replacen("      vertex 0e0 2.25 0E0\n", "", 1), 6, "`vertex`");
        assert_syntax(text.replace("endsolid a", "ensolid a"), 30, "`endsolid`");
        assert_syntax(text.clone() + "more", 31, "`solid`");
        assert_syntax("hello world", 1, "`solid`");
        assert_syntax("solid a", 1, "`facet`");
        assert_syntax(ascii("a") + "solid b\n", 31, "`facet`");
        assert_syntax([0; 83], 1, "84 bytes");
    }

    #[test]
    fn nothing_at_all() {
        assert!(matches!(read_stl(b""), Err(Error::MeshFile(MeshFileError::Empty))));
        assert_length(b"v 1.0 2.0 3.0\n".repeat(10));
    }

    #[test]
    fn truncation_at_every_length() {
        for header in [&b""[..], b"solid"] {
            let bytes = binary(header, 4, &TETRAHEDRON);
            for length in 0..bytes.len() {
                assert!(read_stl(&bytes[..length]).is_err(), "{length}");
            }
        }
        let text = ascii("a") + &ascii("b");
        let mut accepted = Vec::new();
        for length in 0..text.len() {
            if let Ok(mesh) = read_stl(&text.as_bytes()[..length]) {
                accepted.push(mesh.triangles().len());
                // Only between facets and after `endsolid`.
                let words = text[..length].trim_end();
                assert!(
                    words.ends_with("endfacet")
                        || words.ends_with("endsolid")
                        || words.ends_with("endsolid a")
                        || words.ends_with("endsolid b"),
                    "{words}"
                );
            }
        }
        accepted.dedup();
        assert_eq!(accepted, [1, 2, 3, 4, 5, 6, 7, 8]);
    }

    #[test]
    fn damaged_bytes() {
        // Any byte at any place gives an answer or an error, no panic.
        for bytes in [binary(b"solid", 4, &TETRAHEDRON), (ascii("a") + &ascii("b")).into_bytes()] {
            for i in 0..bytes.len() {
                for value in [0, b'\n', b' ', b'9', b'e', 0x7F, 0xFF] {
                    let mut damaged = bytes.clone();
                    damaged[i] = value;
                    let _ = read_stl(&damaged);
                }
            }
        }
    }

    #[test]
    fn one_long_line_takes_linear_time() {
        let text =
            format!("solid{}", " facet x".repeat(200_000)) + &ascii("a").replace('\n', " ").repeat(5000);
        assert_eq!(read_stl(text.as_bytes()).unwrap().triangles().len(), 20_000);
    }

    #[test]
    fn written_files_read_the_same() {
        let mesh = read_stl(&binary(b"", 4, &TETRAHEDRON)).unwrap();
        let bytes = write_stl(&mesh).unwrap();
        assert_eq!(bytes.len(), 84 + 4 * 50);
        assert!(!bytes.starts_with(b"solid"));
        let again = read_stl(&bytes).unwrap();
        assert_eq!((again.vertices(), again.triangles()), (mesh.vertices(), mesh.triangles()));
        let normals: Vec<[f32; 3]> = bytes[84..]
            .chunks(50)
            .map(|f| [0, 4, 8].map(|i| f32::from_le_bytes([f[i], f[i + 1], f[i + 2], f[i + 3]])))
            .collect();
        assert_eq!((normals[0], normals[1], normals[3]), ([0., 0., -1.], [0., -1., 0.], [-1., 0., 0.]));
        assert!((normals[2].iter().map(|x| x * x).sum::<f32>() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn writing_extremes() {
        let mesh = |scale: f64| {
            let corners = [[0., 0., 0.], [scale, 0., 0.], [0., scale, 0.], [2. * scale, 0., 0.]];
            TriangleMesh::new(corners.to_vec(), vec![[0, 1, 2], [0, 1, 3]]).unwrap()
        };
        for scale in [1e-70, 1e-30, 1.0, 1e38] {
            let bytes = write_stl(&mesh(scale)).unwrap();
            assert_eq!(bytes[84..96], [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0x3F]);
            assert_eq!(bytes[134..146], [0; 12], "no area, no normal");
        }
        assert!(matches!(write_stl(&mesh(1e39)), Err(Error::Argument { .. })));
        let empty = TriangleMesh::new(vec![], vec![]).unwrap();
        assert_eq!(read_stl(&write_stl(&empty).unwrap()).unwrap().triangles().len(), 0);
    }

    #[cfg(feature = "std")]
    #[test]
    fn real_files() {
        // Number of triangles, number of edges on which the file is open, volume.
        let facts = [
            ("featuretype.STL", 3476, 576, 11.627733),
            ("plate_holes.STL", 1252, 0, 767362.11259),
            ("angle_block.STL", 704, 166, 1.145523),
            ("busted.STL", 3878, 0, 526.44891),
            ("bunny-closed.stl", 69674, 0, 7.5519846e-4),
        ];
        for (name, triangles, open, volume) in facts {
            let Some(bytes) = model(name) else { return };
            let mesh = read_stl(&bytes).unwrap();
            let report = mesh.report().unwrap();
            assert_eq!((report.facets_read, report.triangles), (triangles, triangles), "{name}");
            assert_eq!((report.boundary_edges, report.misoriented_edges), (open, 0), "{name}");
            assert!((mesh.volume() / volume - 1.0).abs() < 1e-6, "{name}: {}", mesh.volume());
            let again = read_stl(&write_stl(&mesh).unwrap()).unwrap();
            assert_eq!(again.triangles(), mesh.triangles(), "{name}");
            assert_eq!(again.vertices(), mesh.vertices(), "{name}");

            // Two of the files have 0 for a coordinate at one place and about 1e-16 at another. Rounding to
            // 2^-40, which is far finer than the parts' dimensions, closes them.
            let grid = f64::from(1 << 20) * f64::from(1 << 20);
            let rounded = mesh.transformed(|p| p.map(|x| (x * grid).round() / grid)).unwrap();
            rounded.check_closed(FillRule::NonZero).unwrap();
            rounded.check_closed(FillRule::EvenOdd).unwrap();
            assert_eq!(rounded.report().unwrap().degenerate, 0, "{name}");
            assert!((rounded.volume() / volume - 1.0).abs() < 1e-6, "{name}: {}", rounded.volume());
        }
    }

    #[cfg(feature = "std")]
    #[test]
    fn a_real_file_of_several_bodies() {
        let Some(bytes) = model("multibody.stl") else { return };
        let mesh = read_stl(&bytes).unwrap();
        let report = mesh.report().unwrap();
        assert_eq!((report.facets_read, report.triangles, report.bodies), (32, 32, 2));
        // In each body some faces are inverted.
        assert_eq!((report.boundary_edges, report.misoriented_edges), (0, 12));
        mesh.check_closed(FillRule::EvenOdd).unwrap();
        let result = mesh.check_closed(FillRule::NonZero);
        assert!(matches!(result, Err(Error::Mesh(MeshError::Unoriented { edges: 12 }))), "{result:?}");
        // Each solid by itself.
        let text = String::from_utf8(bytes).unwrap();
        let (first, second) = text.split_at(text.find("solid bodyA").unwrap());
        for (solid, triangles, turned) in [(first, 12, 4), (second, 20, 8)] {
            let report = read_stl(solid.as_bytes()).unwrap().report().unwrap();
            assert_eq!((report.triangles, report.misoriented_edges, report.bodies), (triangles, turned, 1));
        }
    }
}
