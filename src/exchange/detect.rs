//! Detection of a mesh file's format from its bytes.

use super::stl::is_binary_of_exact_length;
use core::fmt;

/// The formats of mesh files that can be read.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MeshFormat {
    /// STL, binary or ASCII.
    Stl,
    /// Wavefront OBJ. Reading it needs the feature `std`.
    Obj,
    /// Stanford PLY, ASCII or binary. Reading it needs the feature `std`.
    Ply,
    /// Geomview OFF. Reading it needs the feature `std`.
    Off,
    /// 3MF, the 3D Manufacturing Format. Reading it needs the feature `threemf`.
    ThreeMf,
}

impl MeshFormat {
    /// All formats.
    pub const ALL: [MeshFormat; 5] = [Self::Stl, Self::Obj, Self::Ply, Self::Off, Self::ThreeMf];

    /// Returns the usual file name extension, in lower case and without a dot.
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Stl => "stl",
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Off => "off",
            Self::ThreeMf => "3mf",
        }
    }

    /// Returns the format with this file name extension, given without a dot, in any letter case.
    pub fn from_extension(extension: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.extension().eq_ignore_ascii_case(extension))
    }

    /// Returns the format of a file with this content and this file name extension, if there is one.
    ///
    /// The content decides where it is unmistakable: the length of a binary STL, the signatures of ZIP and
    /// PLY, the first words of an ASCII STL and of an OFF. Otherwise a known extension decides. A file
    /// without a known extension is an OBJ if its first line that is neither blank nor a comment begins with
    /// a keyword of that format, an OFF if that line begins with numbers only, and an STL if it is long
    /// enough and no text; otherwise the result is `None`.
    ///
    /// O(1), not counting comments and blank lines at the beginning.
    pub fn detect(bytes: &[u8], extension: Option<&str>) -> Option<Self> {
        by_signature(bytes).or_else(|| extension.and_then(Self::from_extension)).or_else(|| by_look(bytes))
    }
}

impl fmt::Display for MeshFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Stl => "STL",
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Off => "OFF",
            Self::ThreeMf => "3MF",
        })
    }
}

/// Returns the format whose signature the file has.
fn by_signature(bytes: &[u8]) -> Option<MeshFormat> {
    // First, because the header of a binary STL may contain anything.
    if is_binary_of_exact_length(bytes) {
        return Some(MeshFormat::Stl);
    }
    // A ZIP begins with a file, or is empty.
    if bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06") {
        return Some(MeshFormat::ThreeMf);
    }
    if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
        return Some(MeshFormat::Ply);
    }
    let word = first_line(bytes)?.next()?;
    if word.eq_ignore_ascii_case(b"solid") {
        Some(MeshFormat::Stl)
    } else if is_off_keyword(word) {
        Some(MeshFormat::Off)
    } else {
        None
    }
}

/// Returns the most likely format of a file without a signature.
fn by_look(bytes: &[u8]) -> Option<MeshFormat> {
    if let Some(mut words) = first_line(bytes)
        && let Some(word) = words.next()
    {
        const OBJ: [&[u8]; 16] = [
            b"v",
            b"vt",
            b"vn",
            b"vp",
            b"f",
            b"l",
            b"p",
            b"g",
            b"o",
            b"s",
            b"mtllib",
            b"usemtl",
            b"mg",
            b"lod",
            b"shadow_obj",
            b"trace_obj",
        ];
        if OBJ.contains(&word) {
            return Some(MeshFormat::Obj);
        }
        let is_count = |word: &[u8]| word.iter().all(u8::is_ascii_digit);
        if is_count(word) && words.next().is_some_and(is_count) && words.all(is_count) {
            return Some(MeshFormat::Off);
        }
    }
    let start = &bytes[..bytes.len().min(84)];
    (start.len() == 84 && start.contains(&0)).then_some(MeshFormat::Stl)
}

/// Returns whether a word is `OFF` with its optional prefixes for texture coordinates, colours, normals, and
/// so on.
fn is_off_keyword(word: &[u8]) -> bool {
    let mut rest = word;
    for prefix in [&b"ST"[..], b"C", b"N", b"4", b"n"] {
        rest = rest.strip_prefix(prefix).unwrap_or(rest);
    }
    // The counts may follow immediately.
    rest.strip_prefix(b"OFF").is_some_and(|counts| counts.iter().all(u8::is_ascii_digit))
}

/// Returns the words of the first line that is neither blank nor a comment.
fn first_line(bytes: &[u8]) -> Option<impl Iterator<Item = &[u8]>> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let words = |line| <[u8]>::split(line, u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    (bytes.split(|&b| b == b'\n' || b == b'\r'))
        .find(|line| words(line).next().is_some_and(|word| !word.starts_with(b"#")))
        // The first words of a very long line are enough.
        .map(|line| words(&line[..line.len().min(256)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec::Vec;

    #[test]
    fn signatures_win_over_extensions() {
        for extension in [None, Some("stl"), Some("obj"), Some("ply"), Some("off"), Some("3mf"), Some("txt")]
        {
            for (bytes, format) in [
                (&b"PK\x03\x04rest"[..], MeshFormat::ThreeMf),
                (b"PK\x05\x06", MeshFormat::ThreeMf),
                (b"ply\nformat ascii 1.0", MeshFormat::Ply),
                (b"ply\r\nformat ascii 1.0", MeshFormat::Ply),
                (b"solid part\nfacet normal", MeshFormat::Stl),
                (b"\xEF\xBB\xBF \n Solid\n", MeshFormat::Stl),
                (b"OFF\n8 6 12\n", MeshFormat::Off),
                (b"# a comment\n\n  COFF 8 6 12", MeshFormat::Off),
                (b"STCN4OFF\n", MeshFormat::Off),
                (b"OFF8 6 12\n", MeshFormat::Off),
                (b"OFF BINARY\n\0\0\0\x08", MeshFormat::Off),
            ] {
                assert_eq!(MeshFormat::detect(bytes, extension), Some(format), "{bytes:?} {extension:?}");
            }
        }
    }

    #[test]
    fn binary_stl_by_its_length() {
        for header in [&b""[..], b"PK\x03\x04", b"ply\n", b"OFF\n", b"v 1 2 3\n", b"solid"] {
            let mut bytes = header.to_vec();
            bytes.resize(80, b' ');
            bytes.extend([2, 0, 0, 0]);
            bytes.resize(184, 7);
            assert_eq!(MeshFormat::detect(&bytes, Some("obj")), Some(MeshFormat::Stl));
        }
    }

    #[test]
    fn then_the_extension_and_then_the_look() {
        let text = b"# made by hand\nv 0 0 0\nv 1 0 0\n";
        assert_eq!(MeshFormat::detect(text, None), Some(MeshFormat::Obj));
        assert_eq!(MeshFormat::detect(text, Some("PLY")), Some(MeshFormat::Ply));
        assert_eq!(MeshFormat::detect(text, Some("txt")), Some(MeshFormat::Obj));
        for text in [&b"o cube\n"[..], b"mtllib a.mtl\r\n", b"\tg\n", b"f 1 2 3", b"usemtl"] {
            assert_eq!(MeshFormat::detect(text, None), Some(MeshFormat::Obj), "{text:?}");
        }
        assert_eq!(MeshFormat::detect(b"# no keyword\n8 6 12\n0 0 0", None), Some(MeshFormat::Off));
        assert_eq!(MeshFormat::detect(b"8 6\n", None), Some(MeshFormat::Off));
        // A binary STL that was cut off; the STL reader reports it.
        let mut cut: Vec<u8> = b"binary".to_vec();
        cut.resize(90, 0);
        assert_eq!(MeshFormat::detect(&cut, None), Some(MeshFormat::Stl));
        for text in
            [&b""[..], b"8", b"8 x\n", b"vertex 1 2 3\n", b"officer", b"plywood\n", b"#only\n#this", b"\n \n"]
        {
            assert_eq!(MeshFormat::detect(text, None), None, "{text:?}");
        }
    }

    #[test]
    fn extensions() {
        for format in MeshFormat::ALL {
            assert_eq!(MeshFormat::from_extension(format.extension()), Some(format));
        }
        assert_eq!(MeshFormat::from_extension("STL"), Some(MeshFormat::Stl));
        for extension in ["", ".stl", "step", "3m"] {
            assert_eq!(MeshFormat::from_extension(extension), None);
        }
    }
}
