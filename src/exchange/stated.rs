//! The deviation of the true boundary that files written by this library state.

use super::MeshFormat;
use crate::error::Error;
use crate::mesh::TriangleMesh;

/// The beginning of the line, after the comment mark.
const NAME: &str = "leafless deviation ";

/// Number of bytes from the beginning of a file within which the line must be found.
const NEAR: usize = 4096;

/// Refuses an invalid deviation.
pub(super) fn check(deviation: Option<f64>) -> Result<(), Error> {
    match deviation {
        Some(deviation) => TriangleMesh::from_welded(Default::default(), Default::default(), 0, 0)
            .with_deviation(deviation)
            .map(|_| ()),
        None => Ok(()),
    }
}

/// Returns the deviation that a text states, if it is valid.
pub(super) fn parsed(text: &str) -> Option<f64> {
    let deviation = text.trim().parse().ok()?;
    check(Some(deviation)).ok()?;
    Some(deviation)
}

/// Returns the deviation that a text file states.
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

/// The comment line.
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
