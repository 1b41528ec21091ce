//! Departures from a format that do not keep a mesh file from being read.

use core::fmt;

/// A departure of a mesh file from its format, which did not prevent reading.
///
/// A file has at most one warning of each kind.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MeshWarning {
    /// An ASCII PLY has more values on the line of every element of one kind than the header announces. The
    /// first values of each line were read, and the others were skipped.
    MoreValues {
        /// The first such line, counted from 1.
        line: u64,
        /// Number of such lines.
        lines: u64,
    },
    /// The header of a PLY has lines without a keyword before its first element. They were treated as
    /// comments.
    HeaderLine {
        /// The first such line, counted from 1.
        line: u64,
        /// Number of such lines.
        lines: u64,
    },
    /// The header of a PLY has an element of faces without a list of vertices. It announces no face, so
    /// nothing is missing.
    NoIndices {
        /// The line of the element, counted from 1.
        line: u64,
    },
    /// Some colours cannot be read: no hexadecimal number in a 3MF, or a number out of range for its type in
    /// a PLY. The elements with these colours have no colour.
    Colours {
        /// Number of such colours.
        colours: u64,
    },
    /// Triangles of a 3MF refer to a group of properties, or to a property, that the part does not have. They
    /// have no colour and no material.
    Properties {
        /// Number of such triangles in the build.
        triangles: u64,
    },
    /// A model part of a 3MF is of the draft 0.93. Its shapes have the same meaning as in 1.0.
    Draft,
}

impl fmt::Display for MeshWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let also = |lines: u64| Also(lines.saturating_sub(1));
        match *self {
            Self::MoreValues { line, lines } => write!(
                f,
                "line {line}{} has more values than the header announces; the last ones were skipped",
                also(lines)
            ),
            Self::HeaderLine { line, lines } => {
                write!(
                    f,
                    "line {line}{} of the header has no keyword and was treated as a comment",
                    also(lines)
                )
            }
            Self::NoIndices { line } => {
                write!(f, "line {line}: faces without a list of vertices; there are 0 of them")
            }
            Self::Colours { colours } => {
                write!(f, "{} cannot be read", Count(colours, "colour", "colours"))
            }
            Self::Properties { triangles } => write!(
                f,
                "{} to properties that the file does not have",
                Count(triangles, "triangle refers", "triangles refer")
            ),
            Self::Draft => f.write_str("this is 3MF of the draft 0.93; it was read as 1.0"),
        }
    }
}

/// A number with its noun in singular or plural.
struct Count(u64, &'static str, &'static str);

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.0, if self.0 == 1 { self.1 } else { self.2 })
    }
}

/// The number of further lines.
struct Also(u64);

impl fmt::Display for Also {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            0 => Ok(()),
            more => write!(f, " (like {more} more)"),
        }
    }
}
