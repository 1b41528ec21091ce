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
//! Version 0.0. **Until major version 1 the format may change from release to release.** All numbers are
//! little-endian, doubles are IEEE 754 binary64, and a CRC32 is that of zlib and PNG (polynomial
//! 0xEDB88320). The name of a file ends in `.lfl`.
//!
//! A file is a header, a section table, and sections. Every section begins on a multiple of 64 bytes; the
//! bytes between are zero; the file ends with its last section.
//!
//! ## Header
//!
//! | offset | type | field | value |
//! |---|---|---|---|
//! | 0 | 8 bytes | magic | `89 4C 46 4C 0D 0A 1A 0A` |
//! | 8 | u16 | major version | 0; any other is refused |
//! | 10 | u16 | minor version | 0; newer ones are readable |
//! | 12 | u32 | header length | 128 |
//! | 16 | u32 | required flags | 0; a reader refuses what it does not know |
//! | 20 | u32 | optional flags | 0 |
//! | 24 | u64 | file length | in bytes |
//! | 32 | 3 × f64 | origin | lower corner of the universe; each 0 (not −0) or of a magnitude of 2^-256 to 2^256 |
//! | 56 | f64 | edge | of the universe; 2^-256 to 2^256 |
//! | 64 | u8 | depth | 1 to 20 |
//! | 65 | u8 | root tag | 0 EMPTY, 1 BRANCH, 2 PARTIAL, 3 FULL |
//! | 66 | u8 | exterior | the same codes, not BRANCH |
//! | 67 | u8 | planes of a brick | 2 if any cell of the tree is PARTIAL, else 1 |
//! | 68 | u8 | brick encoding | 0 raw, 1 dictionary |
//! | 69 | u8 | segment shift | 0 if raw; 16 to 62, or 63 if there is one segment |
//! | 70 | u16 | reserved | 0 |
//! | 72 | u64 | elements | without bricks; 0 up to depth 2, and unless the root is BRANCH |
//! | 80 | u64 | bricks | 0 unless the root is BRANCH |
//! | 88 | u64 | dictionary entries | 0 if raw |
//! | 96 | u32 | sections | 1 to 4096 |
//! | 100 | u32 | section table CRC32 | of all its bytes |
//! | 104 | 20 bytes | reserved | 0 |
//! | 124 | u32 | header CRC32 | of the bytes before it |
//!
//! A reader that meets a newer minor version does not look at reserved fields and optional flags.
//!
//! ## Section table
//!
//! It follows the header: 40 bytes a section, in the order in which they lie in the file.
//!
//! | offset | type | field |
//! |---|---|---|
//! | 0 | u32 | kind; 0 is illegal |
//! | 4 | u32 | bytes of an element |
//! | 8 | u64 | offset in the file, a multiple of 64 |
//! | 16 | u64 | length in bytes: count × bytes of an element; never 0 |
//! | 24 | u64 | count of elements |
//! | 32 | u32 | CRC32 of the section |
//! | 36 | u32 | flags; bit 0: required |
//!
//! A reader skips sections of unknown kinds, unless they are required: then it refuses the file.
//!
//! ## Sections
//!
//! A section that would have no elements is absent. All but the metadata have the required flag; no known
//! kind may stand twice. Kinds 16 to 31 are reserved for channels, 32 to 47 for tri-dexel models.
//!
//! | kind | name | element | count |
//! |---|---|---|---|
//! | 1 | planes | u64 lower, u64 upper | elements |
//! | 2 | rel | u16 | elements |
//! | 3 | base | u64 | ⌈elements / 1024⌉ |
//! | 4 | bricks | u64 lower (1 plane), or u64 lower, u64 upper (2 planes) | bricks, if raw |
//! | 5 | brick indices | u16 | bricks, if dictionary |
//! | 6 | dictionary entries | as kind 4 | dictionary entries |
//! | 7 | dictionary segments | u64 | ⌈bricks / 2^shift⌉, if dictionary; 1 if the shift is 63 |
//! | 8 | level table | u64 nodes, u64 full, u64 partial | depth + 1 |
//! | 9 | metadata | byte | at most 2^20 |
//!
//! [`OctreeRef`](crate::OctreeRef) explains elements, bricks, and how a child is found through `base` and
//! `rel`; [`Planes`](crate::Planes) and [`Tag`](crate::Tag) what the bits mean. In short:
//!
//! * Bit c of `lower` and `upper` is the tag of cell c of an element, in Morton order (bits x, y, z, x, y, z
//!   of c from the lowest): EMPTY 00, FULL 11, PARTIAL lower 0 upper 1, BRANCH lower 1 upper 0.
//! * An element describes two octree levels. It is stored only if its cells do not all have one tag that is
//!   not BRANCH. Of an odd depth the root's element uses cells 0 to 7 only, the others are EMPTY.
//! * Elements lie level by level, within a level in Morton order. The children of element n, one for each of
//!   its BRANCH cells in ascending order, have the indices from base\[⌊n / 1024⌋\] + rel\[n\] on; rel is 0
//!   for every 1024th element. For elements without children both are counted through.
//! * The deepest elements are bricks, which have no BRANCH. Their indices go on after those of the elements.
//! * Brick b through a dictionary is entry segments\[b >> shift\] + indices\[b\]. The entries of a segment
//!   end where those of the next begin; within a segment they differ, stand by descending frequency in the
//!   segment, then by ascending value (lower, then upper), and all are used; at most 65 536.
//! * A writer takes the encoding that needs the fewest bytes of kinds 4 to 7: raw, one segment, segments of
//!   2^k bricks by descending k from the largest that makes two segments down to 16; the first in this order
//!   where sizes tie. Readers take any.
//! * The level table counts, for each octree level from 0, the universe, to the depth: internal nodes, FULL
//!   cells, PARTIAL cells of the canonical octree. The elements of element level e are the nodes of octree
//!   level 2e (even depth) or 2e − 1 (odd depth; for e = 0, level 0): that is how readers know where a level
//!   begins. These sums must give the header's elements and bricks.
//! * Metadata are facts one after another: u32 length of the key, u32 length of the value, key, value, both
//!   UTF-8, the keys ascending by bytes.

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
