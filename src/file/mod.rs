//! The file format: an octree's arrays as they lie in memory, mapped and queried in place.
//!
//! # Ways in
//!
//! | function | reads | checks | cost |
//! |---|---|---|---|
//! | [`probe`], [`probe_from`], [`probe_bytes`] | header and section table | both | O(sections) |
//! | [`map`], [`view`], [`from_static`] (bytes) | in place | header, section table, bounds, level table | O(sections + depth) |
//! | [`map_verified`], [`verify`] (bytes) | in place | everything | O(n) |
//! | [`open`], [`from_bytes`] | a copy | everything | O(n) |
//!
//! `open` is the plain way. Mapping is for files that are larger than what is asked of them, and is `unsafe`
//! because of what others may do to a mapped file. [`save`], [`write_to`] and [`to_bytes`] write: equal trees
//! with equal metadata give equal bytes.
//!
//! ```
//! use leafless::{Ball, Control, Frame, Membership, Rule, build, file};
//! let frame = Frame::new([0.0; 3], 1.0, 6)?;
//! let ball = build(&Ball::new([0.5; 3], 0.4)?, &frame, Rule::Certified, &Control::default())?;
//! let bytes = file::to_bytes(&ball)?;
//! let back = file::from_bytes(&bytes)?;
//! assert_eq!(back, ball);
//! assert_eq!(back.contains([0.5; 3]), Membership::Inside);
//! assert_eq!(file::probe_bytes(&bytes)?.bricks, ball.view().brick_count());
//! # Ok::<(), leafless::Error>(())
//! ```
//!
//! # The format
//!
//! Version 0.0. **Until major version 1 the format may change from release to release.**
//!
//! A file is a header of 128 bytes, a table of sections, and the sections: the arrays of an
//! [`OctreeRef`](crate::OctreeRef), each on a multiple of 64 bytes, all numbers little-endian. Header, table and
//! every section have a CRC32. The name of a file ends in `.lfl`.
//!
//! | kind | section | element | count |
//! |---|---|---|---|
//! | 1 | planes | u64 lower, u64 upper | elements |
//! | 2 | rel | u16 | elements |
//! | 3 | base | u64 | ⌈elements / 1024⌉ |
//! | 4 | bricks | one or two u64 | bricks, if raw |
//! | 5 | brick indices | u16 | bricks, if through a dictionary |
//! | 6 | dictionary entries | one or two u64 | dictionary entries |
//! | 7 | dictionary segments | u64 | segments of the dictionary |
//! | 8 | level table | three u64 | depth + 1 |
//! | 9 | metadata | byte | at most 2^20 |
//!
//! Other kinds are for later versions: a reader skips a section that it does not know, unless it is required.
//!
//! The specification is `format_spec/specification.md` in the source of this crate: every field, every check and
//! its reason. Beside it lie test vectors, the reasons for the design, and the list of what readers accept
//! although the writer never writes it.

mod exchange;
mod layout;
#[cfg(feature = "mmap")]
mod map;
mod read;
mod write;

pub use exchange::{read_stl, write_stl};
pub use layout::{MAGIC, MAJOR, MINOR};
#[cfg(feature = "mmap")]
pub use map::{map, map_verified};
pub use read::{Probe, Section, from_bytes, from_static, probe_bytes, verify, view};
#[cfg(feature = "std")]
pub use read::{open, probe, probe_from};
pub use write::to_bytes;
#[cfg(feature = "std")]
pub use write::{save, write_to};
