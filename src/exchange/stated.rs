//! How far the true boundary may lie beside a mesh, as files that were written here tell it.

use super::MeshFormat;
use crate::error::Error;
use crate::mesh::TriangleMesh;

/// What begins the line, behind the mark of a comment.
const NAME: &str = "leafless deviation ";

/// The line stands near the beginning of a file.
const NEAR: usize = 4096;

/// Refuses what is no deviation.
pub(super) fn check(deviation: Option<f64>) -> Result<(), Error> {
    match deviation {
        Some(deviation) => TriangleMesh::from_welded(Default::default(), Default::default(), 0, 0)
            .with_deviation(deviation)
            .map(|_| ()),
        None => Ok(()),
    }
}

/// A deviation in words of a file, if it is one.
pub(super) fn parsed(text: &str) -> Option<f64> {
    let deviation = text.trim().parse().ok()?;
    check(Some(deviation)).ok()?;
    Some(deviation)
}

/// What a file of lines says.
pub(super) fn find(bytes: &[u8], format: MeshFormat) -> Option<f64> {
    let mark: &[u8] = match format {
        MeshFormat::Obj | MeshFormat::Off => b"# ",
        MeshFormat::Ply => b"comment ",
        _ => return None,
    };
    let near = &bytes[..bytes.len().min(NEAR)];
    let lines = near.split(|&byte| matches!(byte, b'\n' | b'\r'));
    let line = lines
        .take_while(|line| *line != b"end_header")
        .find_map(|line| line.strip_prefix(mark)?.strip_prefix(NAME.as_bytes()))?;
    parsed(core::str::from_utf8(line).ok()?)
}

/// The line of a comment.
pub(super) struct Line(pub &'static str, pub f64);

impl core::fmt::Display for Line {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Line(mark, deviation) = *self;
        writeln!(f, "{mark}{NAME}{}", Shown(deviation))
    }
}

/// The number, without long rows of zeros.
pub(super) struct Shown(pub f64);

impl core::fmt::Display for Shown {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Shown(deviation) = self;
        match (1e-5..1e16).contains(deviation) {
            true => write!(f, "{deviation}"),
            false => write!(f, "{deviation:e}"),
        }
    }
}
