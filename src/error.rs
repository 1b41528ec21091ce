//! Every way in which the library can refuse.
//!
//! One enum for the whole crate. Each variant carries what was found, and its text is a sentence that a
//! user can act on. What is read from or written to a path names the path.

use alloc::boxed::Box;
use core::fmt;

use thiserror::Error;

/// Why an operation was refused. Nothing is changed, and nothing half-made is returned, when one occurs. (An
/// octree that is refined on demand keeps what was found out before.)
#[non_exhaustive]
#[derive(Debug, Error)]
pub enum Error {
    /// An argument is outside of its documented range.
    #[error("{name}: {problem}")]
    Argument {
        /// The parameter's name.
        name: &'static str,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// Two operands do not lie on one lattice. A stored octree is known on the frame that it was made on and
    /// on that frame with another depth.
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
    /// An octree that is to be refined was made from another solid than this one.
    #[error(
        "the octree was not made from this solid: its fingerprint, or what it says of a cell, is another"
    )]
    SourceMismatch,
    /// The producer cannot decide the centre of a cell, so the sampled rule cannot be used on it.
    #[error(
        "this solid cannot decide single points, which the sampled rule needs; any other rule can be used"
    )]
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
    /// A file of a volume that cannot be read.
    #[error(transparent)]
    VolumeFile(#[from] VolumeFileError),
    /// A scene that cannot be read.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The bytes are not a Leafless file, or a damaged one.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The arrays of an octree contradict each other.
    #[error("the octree is damaged: {0}")]
    Damaged(#[from] Damage),
    /// The arrays of a tri-dexel model contradict each other.
    #[error("the tri-dexel model is damaged: its rays along axis {axis}, at ray {ray} of them")]
    DamagedRays {
        /// The axis that the rays run along.
        axis: u8,
        /// The first ray that is not sound; 0 if the arrays as a whole are not.
        ray: u64,
    },
    /// More nodes or bytes than the caller allowed, or than a pipe may have that is read whole.
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
        /// What would take the memory, such as `"the triangles of the surface"`.
        what: &'static str,
        /// The bytes that the result takes at least, with what is needed to make it; `u64::MAX` if it is more
        /// than that.
        needed: u64,
        /// The limit that the caller set, in bytes.
        limit: u64,
    },
    /// An allocation failed, in the library or in the operating system.
    ///
    /// Every allocation whose size depends on an input or a result is asked for in a way that can be refused,
    /// and this is the refusal. What remains is small, at most 2 KiB a piece: counted references, the numbers
    /// per level behind statistics, exact signs, what the standard library and `tempfile` need to handle a
    /// path; what threads cost; polygons that are no fans, which another crate triangulates: about 320 bytes
    /// a corner are asked for, and given back, before it begins; and compressing, for which it is half a
    /// megabyte. If even that cannot be had, the process ends, as Rust programs do. (So it does where an
    /// allocator refuses to make a piece of memory smaller, which none is known to.)
    #[error("out of memory")]
    OutOfMemory,
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
    /// A function of the host program, which classifies its own shape, failed.
    #[error("a function of the host program stopped the work with the code {code}")]
    Callback {
        /// What the function returned.
        code: i32,
    },
    /// The operating system refused to read or write.
    #[cfg(feature = "std")]
    #[error("{}", system_text(.0))]
    Io(std::io::Error),
    /// A file at a path cannot be read or written; [`cause`](Error::cause) tells why.
    #[cfg(feature = "std")]
    #[error("{}: {error}", path.display())]
    File {
        /// The path that was asked for.
        path: Box<std::path::Path>,
        /// What is wrong with the file.
        error: Box<Error>,
    },
}

impl Error {
    /// The error without the name of a file: of [`Error::File`] what is wrong with the file, else the error.
    pub fn cause(&self) -> &Error {
        match self {
            #[cfg(feature = "std")]
            Error::File { error, .. } => error.cause(),
            other => other,
        }
    }

    /// The error with the name of the file that it is about, if it is about a file.
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

/// What the system says, without its number.
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
        // Reading into memory and mapping can run out of it, too.
        match error.kind() {
            std::io::ErrorKind::OutOfMemory => Error::OutOfMemory,
            _ => Error::Io(error),
        }
    }
}

/// Why a triangle mesh does not bound a solid.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum MeshError {
    /// No triangle is left (after degenerate ones are dropped).
    #[error("the mesh has no triangle of non-zero area")]
    Empty,
    /// All vertices lie in one point, so that no frame can be put around them.
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
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} refers to vertex {vertex}, but there are only {vertices}")]
    Index {
        /// Index of the triangle.
        triangle: u64,
        /// The vertex that it names.
        vertex: u64,
        /// How many vertices there are.
        vertices: u64,
    },
    /// More vertices or triangles than 32-bit indices can name.
    #[error("the mesh has more than 2^32 - 1 vertices or triangles")]
    TooMany,
    /// The surface has holes.
    #[error("the mesh is not closed: {edges} edges bound a hole")]
    Open {
        /// Edges on which an odd number of triangles meet.
        edges: u64,
    },
    /// The surface is closed, but neighbouring triangles face opposite sides.
    #[error("the mesh is not consistently oriented: across {edges} edges the facing changes")]
    Unoriented {
        /// Edges on which an even number of triangles meet whose directions do not cancel.
        edges: u64,
    },
}

/// Why arrays do not describe solids of plane faces. Loops, faces and shells are counted from 0 through all
/// solids.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum PolyhedronError {
    /// An array of offsets does not begin with 0, does not rise, or does not end at the length of what it
    /// divides.
    #[error(
        "the offsets of the {array} are wrong at index {index}: they must rise from 0 to the count of {parts}"
    )]
    Offsets {
        /// `"loops"`, `"faces"`, `"shells"` or `"solids"`.
        array: &'static str,
        /// `"corners"`, `"loops"`, `"faces"` or `"shells"`.
        parts: &'static str,
        /// Index of the first offset that is wrong.
        index: u64,
    },
    /// A loop has one or two corners.
    #[error("loop {index} has {corners} corners, and three are the fewest")]
    FewCorners {
        /// Index of the loop.
        index: u64,
        /// How many it has.
        corners: u64,
    },
    /// A corner names a vertex that does not exist.
    #[error("corner {corner} refers to vertex {vertex}, but there are only {vertices}")]
    Vertex {
        /// Index into the array of corners.
        corner: u64,
        /// The vertex that it names.
        vertex: u64,
        /// How many vertices there are.
        vertices: u64,
    },
    /// Two consecutive corners of a loop are one vertex or lie at one place.
    #[error("face {face} has an edge without length from vertex {from} to vertex {to}")]
    NoLength {
        /// Index of the face.
        face: u64,
        /// The corner's vertex.
        from: u64,
        /// The vertex of the next corner.
        to: u64,
    },
    /// An edge of a face is no edge of another face of its shell.
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
        "on the edge of face {face} from vertex {from} to vertex {to}, {uses} faces of shell {shell} meet"
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
        /// How often the shell's loops run along the edge.
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
        "face {face} is not plane: its corners lie up to {deviation} beside a plane, where {tolerance} is allowed"
    )]
    NotPlane {
        /// Index of the face.
        face: u64,
        /// Half the distance between two planes, parallel to the face, that have all its corners between
        /// them, in model units.
        deviation: f64,
        /// The most that is allowed.
        tolerance: f64,
    },
    /// Two edges of a face cross, or a vertex of it lies within one of its edges.
    #[error("the edge of face {face} from vertex {from} to vertex {to} meets another edge of the face")]
    Crossing {
        /// Index of the face.
        face: u64,
        /// Vertex at which the edge begins.
        from: u64,
        /// Vertex at which it ends.
        to: u64,
    },
    /// A loop of a face lies on the wrong side of another one: a hole outside of the outer loop, within
    /// another hole, or one that turns as the outer loop does.
    #[error(
        "the loops of face {face} do not enclose one area: holes must lie within the outer loop and turn against it"
    )]
    Loops {
        /// Index of the face.
        face: u64,
    },
    /// The first shell of a solid encloses a negative volume, or none: its loops turn clockwise, seen from
    /// outside.
    #[error("shell {shell} bounds its solid from outside, but is inside out")]
    InsideOut {
        /// Index of the shell.
        shell: u64,
    },
    /// A further shell of a solid encloses a positive volume, or none: its loops turn clockwise, seen from
    /// the void.
    #[error("shell {shell} bounds a void, but is not inside out")]
    VoidOutward {
        /// Index of the shell.
        shell: u64,
    },
    /// A void reaches out of its solid's first shell.
    #[error("shell {shell} bounds a void that does not lie within its solid")]
    VoidOutside {
        /// Index of the shell.
        shell: u64,
    },
}

/// Why a mesh file cannot be read.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum MeshFileError {
    /// The file has no byte at all.
    #[error("the file is empty")]
    Empty,
    /// Neither the content nor the name tells the format.
    #[error("what format this is can be told neither from the content nor from the name")]
    UnknownFormat,
    /// The file uses, or is, something that this library, or this build of it, cannot read.
    #[error("{what} cannot be read")]
    Unsupported {
        /// What the file uses or is.
        what: &'static str,
    },
    /// A conversion of units was asked for, but the file does not say in which unit its numbers are.
    #[error(
        "the file does not say in which unit its numbers are, so they cannot be converted unless it is given"
    )]
    UnknownUnit,
    /// A binary STL whose length contradicts its facet count.
    #[error(
        "this is no ASCII STL and no whole binary one: {facets} facets, as it seems to say, need {expected} bytes \
         and the file has {found}"
    )]
    Length {
        /// The count in the file's header.
        facets: u64,
        /// Length that this count asks for.
        expected: u64,
        /// Length of the file.
        found: u64,
    },
    /// A text departs from the grammar of its format.
    #[error("line {line}: expected {expected}")]
    Syntax {
        /// Line, counted from 1.
        line: u64,
        /// What should have stood there.
        expected: &'static str,
    },
    /// In a text a face names a vertex that does not exist.
    #[error("line {line}: there is no vertex {index}, because the number of vertices is {vertices}")]
    Index {
        /// Line, counted from 1.
        line: u64,
        /// The vertex as the file names it: counted as the format does.
        index: i64,
        /// How many vertices there are; for an index that counts backwards, how many come before it.
        vertices: u64,
    },
    /// A binary file departs from its format.
    #[error("byte {offset}: expected {expected}")]
    Binary {
        /// Where, in bytes from the beginning of the file.
        offset: u64,
        /// What should have stood there.
        expected: &'static str,
    },
    /// In a binary file a face names a vertex that does not exist.
    #[error("byte {offset}: there is no vertex {index}, because the number of vertices is {vertices}")]
    BinaryIndex {
        /// Where, in bytes from the beginning of the file.
        offset: u64,
        /// The vertex that is named, counted from 0.
        index: i64,
        /// How many vertices there are.
        vertices: u64,
    },
    /// A coordinate of a binary STL is infinite or not a number.
    #[error("facet {facet} has a coordinate that is infinite or not a number")]
    NotFinite {
        /// Index of the facet, counted from 0.
        facet: u64,
    },
}

/// Why a 3MF package cannot be read: what is wrong where.
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

    /// Name of the part of the package, shortened if it is very long. Empty for the package as a whole.
    pub fn part(&self) -> &str {
        &self.part
    }

    /// Line in the decompressed part, counted from 1; 0 for the part as a whole.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// Bytes of the decompressed part before the element or the place in question.
    pub fn offset(&self) -> u64 {
        self.offset
    }

    /// What is wrong, as a sentence without its subject or with one of its own.
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

/// Why a file of a volume cannot be read.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum VolumeFileError {
    /// The file has no byte at all.
    #[error("the file is empty")]
    Empty,
    /// The content is neither NRRD nor MetaImage.
    #[error("this is neither NRRD nor MetaImage; a raw array needs its dimensions and its type")]
    UnknownFormat,
    /// The file uses something that this library cannot read.
    #[error("{what} cannot be read")]
    Unsupported {
        /// What the file uses.
        what: &'static str,
    },
    /// The header leaves something out.
    #[error("missing: {what}")]
    Missing {
        /// The field, or what else is missing.
        what: &'static str,
    },
    /// A line of the header departs from the format.
    #[error("line {line}: expected {expected}")]
    Syntax {
        /// Line, counted from 1.
        line: u64,
        /// What should have stood there.
        expected: &'static str,
    },
    /// The spacing, the origin or the directions of the samples are not such as a solid can have: a spacing
    /// of zero, directions that lie in one plane up to 2^-40, or a magnitude that is not between 2^-256 and
    /// 2^256 (2^64 if the axes are turned).
    #[error(
        "the spacing, the origin or the directions of the samples are zero, out of range, or lie in one plane"
    )]
    Place,
    /// There are more or fewer bytes of samples than the header, or the caller, asks for.
    #[error("{expected} bytes of samples are expected, and there are {found}")]
    Length {
        /// Bytes that are asked for, with those that are to be skipped. Of a text the fewest; of compressed
        /// samples what they should become.
        expected: u64,
        /// Bytes that there are, as they are stored.
        found: u64,
    },
    /// Compressed samples are damaged.
    #[error("the file is damaged in {what}")]
    Damaged {
        /// Where.
        what: &'static str,
    },
    /// A sample in a text is no number of its type, is missing, or is one too many.
    #[error("sample {index} is missing, is one too many, or is no number of its type")]
    Sample {
        /// Index of the sample, counted from 0.
        index: u64,
    },
}

/// Why a scene cannot be read: what is wrong where.
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

    /// Line, counted from 1.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// Column in characters, counted from 1.
    pub fn column(&self) -> u64 {
        self.column
    }

    /// What is wrong there.
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

/// Why bytes are not a readable Leafless file.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum FormatError {
    /// The first eight bytes are not the format's signature.
    #[error("this is not a Leafless file (wrong signature)")]
    Magic,
    /// The signature was altered by a transfer in text mode.
    #[error("the file was damaged by a text-mode transfer (line ends were rewritten)")]
    TextMode,
    /// The format's major version is one that this reader does not know.
    #[error("format version {major}.{minor} is not readable by this version of the library")]
    Version {
        /// Major version in the file.
        major: u16,
        /// Minor version in the file.
        minor: u16,
    },
    /// The file demands a feature that this reader does not know.
    #[error("the file needs a feature that this version of the library does not have ({name} {value:#x})")]
    Required {
        /// Which field demands it.
        name: &'static str,
        /// The unknown bits or kind.
        value: u64,
    },
    /// The file ends early, or goes on after its end.
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
    /// A section that the header's fields make necessary is absent, stands twice, or has another number of
    /// elements than they demand.
    #[error("section {name} is missing, stands twice or contradicts the header")]
    Section {
        /// The section's name in the specification.
        name: &'static str,
    },
    /// The record of the solid does not repeat what the header says of it.
    #[error("the record of the solid contradicts the header")]
    Object,
    /// The file is good, but its solid is of another kind than the one that was asked for.
    #[error("the file holds {found}, where {wanted} is wanted")]
    OtherModel {
        /// What the solid is: an octree or a tri-dexel model.
        found: &'static str,
        /// What was asked for.
        wanted: &'static str,
    },
    /// A checksum does not match.
    #[error("the checksum of {name} is wrong")]
    Checksum {
        /// What the checksum covers.
        name: &'static str,
    },
    /// The metadata cannot be read.
    #[error("the metadata are not UTF-8 texts with ascending keys")]
    Metadata,
    /// The bytes are not aligned in memory as a view needs them.
    #[error("the bytes must begin on an address that is a multiple of 8; from_bytes copies any")]
    Alignment,
    /// Multi-byte numbers of this machine have the other order, so a file cannot be used in place.
    #[error("files can only be mapped on little-endian machines; open copies instead")]
    Endianness,
    /// A pipe, device or folder cannot be mapped.
    #[error("only a regular file can be mapped; open reads others, too")]
    NotRegular,
}

/// How the arrays of an octree contradict each other: what [`OctreeRef::check`](crate::OctreeRef::check)
/// reports, and what a bulk operation reports when it runs into it.
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Damage {
    /// The children of an element do not lie where level order demands.
    #[error("the children of element {element} are not where level order puts them")]
    Link {
        /// Index of the element.
        element: u64,
    },
    /// A level has more or fewer elements than its parents have branches.
    #[error("level {level} holds {found} elements where its parents demand {expected}")]
    Count {
        /// Element level, 0 = root.
        level: u8,
        /// Elements that the parents' branches demand.
        expected: u64,
        /// Elements found.
        found: u64,
    },
    /// All cells of an element agree, so it should not exist.
    #[error("element or brick {index} is uniform and should have been merged")]
    Uniform {
        /// Index; bricks are counted on after the elements.
        index: u64,
    },
    /// A brick's cell claims to have children.
    #[error("brick {brick} has a cell that claims to have children")]
    BrickBranch {
        /// Index of the brick.
        brick: u64,
    },
    /// Of an odd depth the root has only one octant, but others are not empty.
    #[error("the root of a tree of odd depth has cells outside of its universe")]
    Padding,
    /// A dictionary index or segment leads outside of the dictionary.
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
    /// Two-plane bricks although nothing is undecided.
    #[error("the bricks have two planes although no cell is undecided")]
    NeedlessPlane,
    /// One-plane bricks although something is undecided.
    #[error("the bricks have one plane although a cell is undecided")]
    MissingPlane,
    /// Of a channel, the number of values before an element is wrong.
    #[error("the values before element or brick {index} of a channel are counted wrongly")]
    Rank {
        /// Index; bricks are counted on after the elements.
        index: u64,
    },
    /// A value of a channel is not legal, or equals the one before.
    #[error("value {index} of a channel is not legal, or equals the one before")]
    Value {
        /// Index of the value.
        index: u64,
    },
    /// The number of cuts before an element is not the number of PARTIAL cells before it.
    #[error("the cuts before element or brick {index} are counted wrongly")]
    CutCount {
        /// Index; bricks are counted on after the elements.
        index: u64,
    },
    /// What is counted before a block of cuts is wrong.
    #[error("the surfaces before block {block} of the cuts are counted wrongly")]
    CutBlock {
        /// Index of the block.
        block: u64,
    },
    /// A cut is not legal: its table, its surfaces, or a split into cells that are too small. Or there are
    /// too few or too many.
    #[error("cut {record} is not legal")]
    CutRecord {
        /// Number of the cut, the number of all cuts if it is missing.
        record: u64,
    },
    /// The numbers of a surface make none, or not all of them are used.
    #[error("surface {surface} is not legal")]
    Surface {
        /// Number of the surface, the number of all surfaces if more is stored than they use.
        surface: u64,
    },
    /// A map that places surfaces cannot be inverted, or has entries beyond all bounds.
    #[error("the placement {placement} of surfaces is not legal")]
    Placement {
        /// Number of the map.
        placement: u64,
    },
    /// The moments that are stored are no intervals.
    #[error("the moments of the solid are not legal")]
    Moments,
    /// The level table does not describe the tree.
    #[error("the level table is wrong at level {level}")]
    LevelTable {
        /// Octree level.
        level: u8,
    },
}
