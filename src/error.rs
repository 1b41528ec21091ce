//! Errors: every way in which the library can refuse.
//!
//! One enum for the whole crate. Each variant carries the offending values, and its text is a sentence on
//! which a user can act. An error of reading or writing a path names the path.

use alloc::boxed::Box;
use core::fmt;

use thiserror::Error;

/// The reason why an operation was refused. An operation that fails changes nothing and returns no partial
/// result. (An octree that is refined on demand keeps its earlier refinements.)
#[non_exhaustive]
#[derive(Debug, Error)]
pub enum Error {
    /// An argument is outside of its documented range.
    #[error("{name}: {problem}")]
    Argument {
        /// The name of the parameter.
        name: &'static str,
        /// The problem with its value.
        problem: &'static str,
    },
    /// Two operands do not lie on one lattice. A stored octree can be used on the frame on which it was made,
    /// and on that frame with another depth.
    #[error(
        "different frames: origin {:?}, edge {}, depth {} and origin {:?}, edge {}, depth {}; give both the same \
         bounds and depth", origins[0], edges[0], depths[0], origins[1], edges[1], depths[1]
    )]
    FrameMismatch {
        /// Lower corners of both universes, in model units.
        origins: [[f64; 3]; 2],
        /// Edge lengths of both, in model units.
        edges: [f64; 2],
        /// Depths of both.
        depths: [u8; 2],
    },
    /// An octree that is to be refined was made from another solid than the given one.
    #[error("the octree was not made from this solid: its fingerprint, or its answer about a cell, differs")]
    SourceMismatch,
    /// The solid cannot classify the centre of a cell, so the sampled rule cannot be used on it.
    #[error("this solid cannot classify single points, which the sampled rule needs; use any other rule")]
    NotSampled,
    /// A triangle mesh that does not bound a solid.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Arrays that do not describe solids of plane faces.
    #[error(transparent)]
    Polyhedron(#[from] PolyhedronError),
    /// A mesh file that cannot be read.
    #[error(transparent)]
    MeshFile(#[from] MeshFileError),
    /// A 3MF package that cannot be read.
    #[error(transparent)]
    Package(#[from] PackageError),
    /// A volume file that cannot be read.
    #[error(transparent)]
    VolumeFile(#[from] VolumeFileError),
    /// A scene that cannot be read.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The bytes are not a Leafless file, or are a damaged one.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The arrays of an octree contradict each other.
    #[error("the octree is damaged: {0}")]
    Damaged(#[from] Damage),
    /// The arrays of a tri-dexel model contradict each other.
    #[error("the tri-dexel model is damaged along axis {axis}, at ray {ray}")]
    DamagedRays {
        /// The axis of the rays' direction: 0, 1 or 2.
        axis: u8,
        /// The first invalid ray; 0 if the arrays as a whole are invalid.
        ray: u64,
    },
    /// A result has more nodes or bytes than the caller allowed, or a pipe that is read as a whole has more
    /// bytes than the library allows.
    #[error("the limit of {limit} {what} was reached")]
    Limit {
        /// `"nodes"` or `"bytes"`.
        what: &'static str,
        /// The limit.
        limit: u64,
    },
    /// A result is known beforehand to take more memory than the caller allowed with
    /// [`Control::max_bytes`](crate::Control::max_bytes).
    #[error("{what} would take {needed} bytes or more, and the limit is {limit} bytes")]
    TooLarge {
        /// The object that would take the memory, such as `"the triangles of the surface"`.
        what: &'static str,
        /// A lower bound of the bytes that the result takes, including its scratch memory; `u64::MAX` if the
        /// bound is larger than that.
        needed: u64,
        /// The limit that the caller set, in bytes.
        limit: u64,
    },
    /// An allocation failed, in the library or in the operating system.
    ///
    /// Every allocation whose size depends on an input or a result is fallible, and a failure is this error.
    /// The remaining allocations are small, at most 2 KiB each: counted references, the numbers per level
    /// behind statistics, exact signs, and the handling of paths by the standard library and `tempfile`; and
    /// the costs of threads. Other crates do three tasks. Triangulating a polygon that is no fan takes about
    /// 320 bytes a corner; the library reserves and releases that amount first, so that a shortage is an
    /// error. The same holds for the half megabyte of compressing a NRRD. The compressors of 3MF and PNG
    /// files are not covered: they allocate some hundred kilobytes, and that of PNG also a copy of the
    /// picture. If one of the remaining allocations fails, the process ends, as is usual for Rust programs.
    /// (It also ends if an allocator refuses to shrink an allocation, which no known allocator does.)
    #[error("out of memory")]
    OutOfMemory,
    /// The caller cancelled the operation.
    #[error("cancelled")]
    Cancelled,
    /// A function of the host program, which classifies its own shape, failed.
    #[error("a function of the host program stopped the work with the code {code}")]
    Callback {
        /// The code that the function returned.
        code: i32,
    },
    /// The operating system refused to read or write.
    #[cfg(feature = "std")]
    #[error("{}", system_text(.0))]
    Io(std::io::Error),
    /// A file at a path cannot be read or written; [`cause`](Error::cause) returns the reason.
    #[cfg(feature = "std")]
    #[error("{}: {error}", path.display())]
    File {
        /// The path as the caller gave it.
        path: Box<std::path::Path>,
        /// The problem with the file.
        error: Box<Error>,
    },
}

impl Error {
    /// Returns the error without the name of a file: for [`Error::File`] the problem with the file, otherwise
    /// the error itself.
    pub fn cause(&self) -> &Error {
        match self {
            #[cfg(feature = "std")]
            Error::File { error, .. } => error.cause(),
            other => other,
        }
    }

    /// Returns the error with the path of its file, if it is an error about a file.
    #[cfg(feature = "std")]
    pub fn of_file(self, path: &std::path::Path) -> Error {
        match self {
            Error::Io(_)
            | Error::Format(_)
            | Error::Damaged(_)
            | Error::Mesh(_)
            | Error::MeshFile(_)
            | Error::Package(_)
            | Error::VolumeFile(_)
            | Error::Scene(_) => Error::File { path: path.into(), error: Box::new(self) },
            other => other,
        }
    }
}

/// Returns the system's message without the error number.
#[cfg(feature = "std")]
fn system_text(error: &std::io::Error) -> alloc::string::String {
    let mut text = alloc::string::ToString::to_string(error);
    if let Some(code) = error.raw_os_error()
        && let Some(before) = text.strip_suffix(&alloc::format!(" (os error {code})"))
    {
        text.truncate(before.len());
    }
    text
}

#[cfg(feature = "std")]
impl From<std::io::Error> for Error {
    fn from(error: std::io::Error) -> Error {
        // Reading into memory and mapping can run out of memory, too.
        match error.kind() {
            std::io::ErrorKind::OutOfMemory => Error::OutOfMemory,
            _ => Error::Io(error),
        }
    }
}

/// The reason why a triangle mesh does not bound a solid.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum MeshError {
    /// No triangle is left (after degenerate ones are dropped).
    #[error("the mesh has no triangle of non-zero area")]
    Empty,
    /// All vertices lie at one point, so that no frame can be put around them.
    #[error("the mesh has no extent")]
    NoExtent,
    /// A coordinate is infinite or not a number.
    #[error("vertex {vertex} has a coordinate that is infinite or not a number")]
    NotFinite {
        /// Index of the first such vertex.
        vertex: u64,
    },
    /// A coordinate is too large to compute with.
    #[error("vertex {vertex} has a coordinate beyond ±2^256")]
    TooLarge {
        /// Index of the first such vertex.
        vertex: u64,
    },
    /// A triangle refers to a vertex that does not exist.
    #[error("triangle {triangle} refers to vertex {vertex}, but there are only {vertices}")]
    Index {
        /// Index of the triangle.
        triangle: u64,
        /// The vertex to which it refers.
        vertex: u64,
        /// Number of vertices.
        vertices: u64,
    },
    /// More vertices or triangles than 32-bit indices can name.
    #[error("the mesh has more than 2^32 - 1 vertices or triangles")]
    TooMany,
    /// The surface has holes.
    #[error("the mesh is not closed: {edges} edges bound a hole")]
    Open {
        /// Number of edges on which an odd number of triangles meet.
        edges: u64,
    },
    /// The surface is closed, but the orientations of neighbouring triangles disagree.
    #[error("the mesh is not consistently oriented: its orientation changes across {edges} edges")]
    Unoriented {
        /// Number of edges on which an even number of triangles meet whose directions do not cancel.
        edges: u64,
    },
}

/// The reason why arrays do not describe solids of plane faces. Loops, faces and shells are numbered from 0
/// through all solids.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum PolyhedronError {
    /// An array of offsets does not begin with 0, does not rise, or does not end at the length of the array
    /// that it divides.
    #[error(
        "the offsets of the {array} are wrong at index {index}: they must rise from 0 to the count of {parts}"
    )]
    Offsets {
        /// `"loops"`, `"faces"`, `"shells"` or `"solids"`.
        array: &'static str,
        /// `"corners"`, `"loops"`, `"faces"` or `"shells"`.
        parts: &'static str,
        /// Index of the first wrong offset.
        index: u64,
    },
    /// A loop has one or two corners.
    #[error("loop {index} has {corners} corners, but needs at least three")]
    FewCorners {
        /// Index of the loop.
        index: u64,
        /// Number of corners of the loop.
        corners: u64,
    },
    /// A corner refers to a vertex that does not exist.
    #[error("corner {corner} refers to vertex {vertex}, but there are only {vertices}")]
    Vertex {
        /// Index into the array of corners.
        corner: u64,
        /// The vertex to which it refers.
        vertex: u64,
        /// Number of vertices.
        vertices: u64,
    },
    /// Two consecutive corners of a loop are one vertex or lie at one place.
    #[error("face {face} has an edge of zero length from vertex {from} to vertex {to}")]
    NoLength {
        /// Index of the face.
        face: u64,
        /// The corner's vertex.
        from: u64,
        /// The vertex of the next corner.
        to: u64,
    },
    /// An edge of a face is not an edge of another face of its shell.
    #[error(
        "shell {shell} is open: the edge of face {face} from vertex {from} to vertex {to} has no counterpart"
    )]
    Open {
        /// Index of the shell.
        shell: u64,
        /// Index of the face.
        face: u64,
        /// Vertex at which the edge begins, in the direction of the face's loop.
        from: u64,
        /// Vertex at which it ends.
        to: u64,
    },
    /// Two faces of a shell run along their common edge in the same direction.
    #[error(
        "shell {shell} is not consistently oriented: face {face} and face {other} run in the same direction from \
         vertex {from} to vertex {to}"
    )]
    Unoriented {
        /// Index of the shell.
        shell: u64,
        /// Index of the face.
        face: u64,
        /// Index of the other face.
        other: u64,
        /// Vertex at which the edge begins.
        from: u64,
        /// Vertex at which it ends.
        to: u64,
    },
    /// More than two faces of a shell meet on an edge.
    #[error(
        "{uses} faces of shell {shell} meet on the edge of face {face} from vertex {from} to vertex {to}"
    )]
    NonManifold {
        /// Index of the shell.
        shell: u64,
        /// Index of the face.
        face: u64,
        /// Vertex at which the edge begins, in the direction of the face's loop.
        from: u64,
        /// Vertex at which it ends.
        to: u64,
        /// Number of times that the shell's loops use the edge.
        uses: u64,
    },
    /// The outer loop of a face encloses no area.
    #[error("face {face} has no area")]
    Flat {
        /// Index of the face.
        face: u64,
    },
    /// The corners of a face do not lie in a plane.
    #[error(
        "face {face} is not plane: its corners lie up to {deviation} off a plane, and {tolerance} is allowed"
    )]
    NotPlane {
        /// Index of the face.
        face: u64,
        /// Half the distance between the two planes parallel to the face that enclose all its corners, in
        /// model units.
        deviation: f64,
        /// The maximum that is allowed.
        tolerance: f64,
    },
    /// Two edges of a face cross, or a vertex of the face lies within one of its edges.
    #[error("the edge of face {face} from vertex {from} to vertex {to} meets another edge of the face")]
    Crossing {
        /// Index of the face.
        face: u64,
        /// Vertex at which the edge begins.
        from: u64,
        /// Vertex at which it ends.
        to: u64,
    },
    /// A loop of a face lies on the wrong side of another one: a hole outside of the outer loop or within
    /// another hole, or a hole with the same orientation as the outer loop.
    #[error(
        "the loops of face {face} do not enclose one area: holes must lie within the outer loop and run the other way"
    )]
    Loops {
        /// Index of the face.
        face: u64,
    },
    /// The first shell of a solid encloses a negative volume, or none: its loops turn clockwise, as seen from
    /// outside.
    #[error("shell {shell} is the outer boundary of its solid, but is oriented inward")]
    InsideOut {
        /// Index of the shell.
        shell: u64,
    },
    /// A further shell of a solid encloses a positive volume, or none: its loops turn clockwise, as seen from
    /// the void.
    #[error("shell {shell} bounds a void, but is oriented like an outer boundary")]
    VoidOutward {
        /// Index of the shell.
        shell: u64,
    },
    /// A void extends beyond its solid's first shell.
    #[error("shell {shell} bounds a void that does not lie within its solid")]
    VoidOutside {
        /// Index of the shell.
        shell: u64,
    },
}

/// The reason why a mesh file cannot be read.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum MeshFileError {
    /// The file has no bytes.
    #[error("the file is empty")]
    Empty,
    /// Neither the content nor the name shows the format.
    #[error("the format can be recognised neither from the content nor from the name")]
    UnknownFormat,
    /// The file uses, or is, something that this library, or this build of it, cannot read.
    #[error("{what} cannot be read")]
    Unsupported {
        /// The unsupported feature or format.
        what: &'static str,
    },
    /// A conversion of units was requested, but the file does not state the unit of its numbers.
    #[error("the file does not state the unit of its numbers, so the unit must be given to convert them")]
    UnknownUnit,
    /// A binary STL whose length contradicts its facet count.
    #[error(
        "this is neither an ASCII STL nor a complete binary STL: if it is binary, it announces {facets} facets, \
         which need {expected} bytes, and the file has {found}"
    )]
    Length {
        /// The count in the file's header.
        facets: u64,
        /// The length for this count.
        expected: u64,
        /// Length of the file.
        found: u64,
    },
    /// A text departs from the grammar of its format.
    #[error("line {line}: expected {expected}")]
    Syntax {
        /// Line, counted from 1.
        line: u64,
        /// The syntax that was expected there.
        expected: &'static str,
    },
    /// A face in a text refers to a vertex that does not exist.
    #[error("line {line}: there is no vertex {index}, because the number of vertices is {vertices}")]
    Index {
        /// Line, counted from 1.
        line: u64,
        /// The vertex number in the file, counted as the format does.
        index: i64,
        /// Number of vertices; for an index that counts backwards, the number of vertices before it.
        vertices: u64,
    },
    /// A binary file departs from its format.
    #[error("byte {offset}: expected {expected}")]
    Binary {
        /// Offset in bytes from the beginning of the file.
        offset: u64,
        /// The content that was expected there.
        expected: &'static str,
    },
    /// A face in a binary file refers to a vertex that does not exist.
    #[error("byte {offset}: there is no vertex {index}, because the number of vertices is {vertices}")]
    BinaryIndex {
        /// Offset in bytes from the beginning of the file.
        offset: u64,
        /// The vertex number, counted from 0.
        index: i64,
        /// Number of vertices.
        vertices: u64,
    },
    /// A coordinate of a binary STL is infinite or not a number.
    #[error("facet {facet} has a coordinate that is infinite or not a number")]
    NotFinite {
        /// Index of the facet, counted from 0.
        facet: u64,
    },
}

/// The reason why a 3MF package cannot be read: the problem and its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PackageError {
    part: Box<str>,
    line: u64,
    offset: u64,
    problem: Box<str>,
}

impl PackageError {
    #[cfg(feature = "threemf")]
    pub(crate) fn new(part: impl Into<Box<str>>, place: (u64, u64), problem: impl Into<Box<str>>) -> Self {
        let (line, offset) = place;
        Self { part: part.into(), line, offset, problem: problem.into() }
    }

    /// Returns the name of the part of the package, shortened if it is very long. Empty for the package as a
    /// whole.
    pub fn part(&self) -> &str {
        &self.part
    }

    /// Returns the line in the decompressed part, counted from 1; 0 for the part as a whole.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// Returns the number of bytes of the decompressed part before the element or the place in question.
    pub fn offset(&self) -> u64 {
        self.offset
    }

    /// Returns the problem, as a sentence that has a subject of its own or takes the part as its subject.
    pub fn problem(&self) -> &str {
        &self.problem
    }
}

impl fmt::Display for PackageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { part, line, offset, problem } = self;
        match (&**part, line) {
            ("", _) => f.write_str(problem),
            (_, 0) => write!(f, "{part} {problem}"),
            _ => write!(f, "{part}, line {line}, byte {offset}: {problem}"),
        }
    }
}

impl core::error::Error for PackageError {}

/// The reason why a volume file cannot be read.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum VolumeFileError {
    /// The file has no bytes.
    #[error("the file is empty")]
    Empty,
    /// The content is neither NRRD nor MetaImage.
    #[error("this is neither NRRD nor MetaImage; a raw array needs its dimensions and its type")]
    UnknownFormat,
    /// The file uses something that this library cannot read.
    #[error("{what} cannot be read")]
    Unsupported {
        /// The unsupported feature.
        what: &'static str,
    },
    /// The header is incomplete.
    #[error("missing: {what}")]
    Missing {
        /// The missing field, or other missing data.
        what: &'static str,
    },
    /// A line of the header departs from the format.
    #[error("line {line}: expected {expected}")]
    Syntax {
        /// Line, counted from 1.
        line: u64,
        /// The syntax that was expected there.
        expected: &'static str,
    },
    /// A solid cannot have the spacing, the origin or the directions of the samples: a spacing is zero, the
    /// directions lie in one plane up to 2^-40, or a magnitude is not between 2^-256 and 2^256 (2^64 if the
    /// axes are turned).
    #[error(
        "the spacing, the origin or the directions of the samples are zero, out of range, or lie in one plane"
    )]
    Place,
    /// There are more or fewer bytes of samples than the header, or the caller, states.
    #[error("{expected} bytes of samples are expected, but {found} were found")]
    Length {
        /// Number of expected bytes, including those to be skipped. For a text the least number; for
        /// compressed samples the decompressed length.
        expected: u64,
        /// Number of bytes found, as stored.
        found: u64,
    },
    /// Compressed samples are damaged.
    #[error("the file is damaged in {what}")]
    Damaged {
        /// The damaged place.
        what: &'static str,
    },
    /// A sample in a text is no number of its type, is missing, or is one too many.
    #[error("sample {index} is missing, is one too many, or is no number of its type")]
    Sample {
        /// Index of the sample, counted from 0.
        index: u64,
    },
}

/// The reason why a scene cannot be read: the problem and its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneError {
    line: u64,
    column: u64,
    problem: Box<str>,
}

impl SceneError {
    #[cfg(feature = "scene")]
    pub(crate) fn new((line, column): (u64, u64), problem: impl Into<Box<str>>) -> Self {
        Self { line, column, problem: problem.into() }
    }

    /// Returns the line, counted from 1.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// Returns the column in characters, counted from 1.
    pub fn column(&self) -> u64 {
        self.column
    }

    /// Returns the problem.
    pub fn problem(&self) -> &str {
        &self.problem
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}: {}", self.line, self.column, self.problem)
    }
}

impl core::error::Error for SceneError {}

/// The reason why bytes are not a readable Leafless file.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum FormatError {
    /// The first eight bytes are not the format's signature.
    #[error("this is not a Leafless file (wrong signature)")]
    Magic,
    /// The signature was altered by a transfer in text mode.
    #[error("the file was damaged by a text-mode transfer (line ends were rewritten)")]
    TextMode,
    /// This reader does not know the format's major version.
    #[error("format version {major}.{minor} is not readable by this version of the library")]
    Version {
        /// Major version in the file.
        major: u16,
        /// Minor version in the file.
        minor: u16,
    },
    /// The file requires a feature that this reader does not know.
    #[error("the file needs a feature that this version of the library does not have ({name} {value:#x})")]
    Required {
        /// The field that requires it.
        name: &'static str,
        /// The unknown bits or kind.
        value: u64,
    },
    /// The file is too short or too long.
    #[error("the file should have {expected} bytes and has {found}")]
    Length {
        /// Length according to the header.
        expected: u64,
        /// Length found.
        found: u64,
    },
    /// A field has a value that the specification does not allow.
    #[error("{name} has the illegal value {value:#x}")]
    Field {
        /// The field's name in the specification.
        name: &'static str,
        /// The value found.
        value: u64,
    },
    /// A section that the header requires is absent, occurs twice, or has a number of elements that
    /// contradicts the header.
    #[error("section {name} is missing, occurs twice or contradicts the header")]
    Section {
        /// The section's name in the specification.
        name: &'static str,
    },
    /// The record of the solid does not repeat the values of the header.
    #[error("the record of the solid contradicts the header")]
    Object,
    /// The file is good, but its solid is of another kind than the requested one.
    #[error("the file holds {found}, but {wanted} is needed")]
    OtherModel {
        /// The kind of the solid: an octree or a tri-dexel model.
        found: &'static str,
        /// The requested kind.
        wanted: &'static str,
    },
    /// A checksum does not match.
    #[error("the checksum of {name} is wrong")]
    Checksum {
        /// The data that the checksum covers.
        name: &'static str,
    },
    /// The metadata cannot be read.
    #[error("the metadata are not UTF-8 texts with ascending keys")]
    Metadata,
    /// The address of the bytes does not have the alignment that a view needs.
    #[error("the bytes must begin at an address that is a multiple of 8; from_bytes accepts any address")]
    Alignment,
    /// This machine is big-endian, so a file cannot be used in place.
    #[error("files can be read in place only on little-endian machines; use open, which copies")]
    Endianness,
    /// A pipe, device or folder cannot be mapped.
    #[error("only a regular file can be mapped; use open, which reads other files, too")]
    NotRegular,
}

/// Contradictions between the arrays of an octree. [`OctreeRef::check`](crate::OctreeRef::check) reports
/// them, and so does a bulk operation that encounters one.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Damage {
    /// The children of an element are not where level order requires them.
    #[error("the children of element {element} are not where level order puts them")]
    Link {
        /// Index of the element.
        element: u64,
    },
    /// A level has more or fewer elements than its parents have branches.
    #[error("level {level} has {found} elements, but its parents require {expected}")]
    Count {
        /// Element level, 0 = root.
        level: u8,
        /// Number of elements that the parents' branches require.
        expected: u64,
        /// Number of elements found.
        found: u64,
    },
    /// All cells of an element agree, so the element should not exist.
    #[error("element or brick {index} is uniform and should have been merged")]
    Uniform {
        /// Index; bricks are numbered after the elements.
        index: u64,
    },
    /// A cell of a brick is marked as having children.
    #[error("brick {brick} has a cell that is marked as having children")]
    BrickBranch {
        /// Index of the brick.
        brick: u64,
    },
    /// In a tree of odd depth, octants of the root outside of the universe are not empty.
    #[error("the root of a tree of odd depth has cells outside of its universe")]
    Padding,
    /// A dictionary index or segment points outside of the dictionary.
    #[error("brick {brick} has no entry in the dictionary")]
    Dictionary {
        /// Index of the brick.
        brick: u64,
    },
    /// A dictionary is not the one that the bricks determine.
    #[error("the dictionary is not in canonical order at entry {entry}")]
    DictionaryOrder {
        /// Index of the entry.
        entry: u64,
    },
    /// The bricks have two planes although no cell is undecided.
    #[error("the bricks have two planes although no cell is undecided")]
    NeedlessPlane,
    /// The bricks have one plane although a cell is undecided.
    #[error("the bricks have one plane although a cell is undecided")]
    MissingPlane,
    /// In a channel, the number of values before an element is wrong.
    #[error("the number of values before element or brick {index} of a channel is wrong")]
    Rank {
        /// Index; bricks are numbered after the elements.
        index: u64,
    },
    /// A value of a channel is invalid, or equals the one before.
    #[error("value {index} of a channel is invalid, or equals the one before")]
    Value {
        /// Index of the value.
        index: u64,
    },
    /// The number of cuts before an element is not the number of PARTIAL cells before it.
    #[error("the number of cuts before element or brick {index} is wrong")]
    CutCount {
        /// Index; bricks are numbered after the elements.
        index: u64,
    },
    /// The counts before a block of cuts are wrong.
    #[error("the counts before block {block} of the cuts are wrong")]
    CutBlock {
        /// Index of the block.
        block: u64,
    },
    /// A cut is invalid: its table, its surfaces, or a split into cells that are too small. Or there are too
    /// few or too many cuts.
    #[error("cut {record} is invalid")]
    CutRecord {
        /// Number of the cut; the number of all cuts if it is missing.
        record: u64,
    },
    /// The numbers of a surface do not define one, or not all of the numbers are used.
    #[error("surface {surface} is invalid")]
    Surface {
        /// Number of the surface; the number of all surfaces if more numbers are stored than they use.
        surface: u64,
    },
    /// A map that places surfaces cannot be inverted, or has entries out of bounds.
    #[error("placement {placement} of surfaces is invalid")]
    Placement {
        /// Number of the map.
        placement: u64,
    },
    /// The stored moments are not intervals.
    #[error("the moments of the solid are invalid")]
    Moments,
    /// The level table does not describe the tree.
    #[error("the level table is wrong at level {level}")]
    LevelTable {
        /// Octree level.
        level: u8,
    },
}
