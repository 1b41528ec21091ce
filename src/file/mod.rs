//! The file format: the arrays of an octree or a tri-dexel model as they lie in memory, mapped and queried in
//! place.
//!
//! The functions of this module are for octrees; those in [`dexels`] have the same names and are for
//! tri-dexel models. [`probe`], [`verify`] and [`verify_path`] know both.
//!
//! # Ways in
//!
//! | function | reads | checks | cost |
//! |---|---|---|---|
//! | [`probe`], [`probe_from`], [`probe_bytes`] | header and section table | both | O(sections) |
//! | [`map`], [`view`], [`from_static`] (bytes) | in place | header, section table, bounds, objects, level tables | O(sections + objects + depth) |
//! | [`map_verified`], [`verify`] (bytes) | in place | everything | O(n) |
//! | [`open`], [`from_bytes`], [`verify_path`] | a copy | everything | O(n) |
//!
//! `open` is the plain way. Mapping is for files that are larger than what is asked of them, and is `unsafe`
//! because of what others may do to a mapped file. [`save`], [`write_to`] and [`to_bytes`] write: equal trees
//! that prove the same, with equal metadata and equal channels, give equal bytes. All ways in but [`view`],
//! which gives the solid alone, read [channels](crate::attribute::Channel).
//!
//! ```
//! use leafless::{Control, Csg, Frame, Membership, Rule, build, file};
//! let frame = Frame::new([0.0; 3], 1.0, 6)?;
//! let ball = build(&Csg::ball([0.5; 3], 0.4)?, &frame, Rule::Certified, &Control::default())?;
//! let bytes = file::to_bytes(&ball)?;
//! let back = file::from_bytes(&bytes)?;
//! assert_eq!(back, ball);
//! assert_eq!(back.contains([0.5; 3]), Membership::Inside);
//! assert_eq!(file::probe_bytes(&bytes)?.bricks, ball.view().brick_count());
//! # Ok::<(), leafless::Error>(())
//! ```
//!
//! # Files from strangers
//!
//! Whatever the bytes, none of this panics, reads beyond them, or goes on for ever:
//!
//! * [`open`], [`from_bytes`], [`map_verified`], [`verify`] and [`verify_path`] accept nothing but a
//!   well-formed tree and well-formed channels with right checksums; everything that follows is then what it
//!   would be of a tree that was just built. They need O(n) time, and memory for at most six times the length
//!   of the file (once for the copy; the rest only for files that are all metadata, or all records of small
//!   channels). `open` asks for no more than the length that a regular file has; of a pipe or device it takes
//!   memory as the bytes arrive. The sections of channels may share their bytes, and every channel is checked
//!   by itself: n is the sum of the lengths of all sections, at most 257 times the length of the file.
//! * [`probe`] needs O(sections), at most 4096 of them, and twice the section table's memory. [`view`]
//!   allocates nothing; [`map`] and [`from_static`] only for the metadata, six times their length, which is
//!   at most 1 MiB for the solid and 64 KiB for each of at most 256 channels, and two kilobytes a channel.
//! * After [`view`] or [`map`] nothing has looked at the tree itself. Point queries read at most ten elements
//!   and allocate nothing. A box query, a walk with a [`Cursor`](crate::octree::Cursor) and a Boolean meet
//!   every element at most once; a tree is built from a stored one only once all of its links are checked.
//!   What is damaged reads as PARTIAL or makes an operation return [`Error::Damaged`](crate::Error::Damaged).
//!   The result of a Boolean never has more elements than its operands together, and the work takes at most
//!   32 times their memory (their bricks may be 16-bit indices) and 128 KiB a thread. Statistics are the
//!   level table's word. The links of a channel are checked when it is first
//!   [viewed](crate::attribute::Channel::view); its values are then read as they stand, within bounds.
//! * Answers about damaged bytes are only this: safe. A changed tag with a right checksum is another tree,
//!   and checksums are no signatures: who may have made a file must be known by other means.
//!
//! The files in `fuzz/` and the tests `hostile_bytes` and `resource_failures` of this crate try to show the
//! contrary.
//!
//! # The format
//!
//! Version 0.4. **Later versions of major version 0 only add to it**: a file of version 0.1 stays readable,
//! and a reader of version 0.1 reads any later file that holds an octree. Version 0.2 added channels, version
//! 0.3 tri-dexel models, which older readers refuse, version 0.4 cuts, without which older readers read the
//! tree. A file has the oldest version that knows all of its objects and sections, so an octree without
//! channels and cuts is in a file of version 0.1.
//!
//! A file is a header of 128 bytes, a table of sections, and the sections: the arrays of an
//! [`OctreeRef`](crate::OctreeRef), each on a multiple of 64 bytes, all numbers little-endian. Header, table
//! and every section have a CRC32. The name of a file ends in `.lfl`.
//!
//! | kind | section | element | count |
//! |---|---|---|---|
//! | 1 | objects | record of 128 bytes | objects, at most 4096 |
//! | 2 | metadata | byte | at most 2^20 |
//! | 3 | level table | three u64 | depth + 1 |
//! | 4 | planes | u64 lower, u64 upper | elements |
//! | 5 | rel | u16 | elements |
//! | 6 | base | u64 | ⌈elements / 1024⌉ |
//! | 7 | bricks | one or two u64 | bricks, if raw |
//! | 8 | brick indices | u16 | bricks, if through a dictionary |
//! | 9 | dictionary entries | one or two u64 | dictionary entries |
//! | 10 | dictionary segments | u64 | segments of the dictionary |
//! | 11 | cut heads | u8 | cuts |
//! | 12 | cut ids | byte of a stream of bits | bytes that the surfaces of all cuts take |
//! | 13 | cut blocks | two u32 | ⌈cuts / 32⌉ |
//! | 14 | cut first | u32 | elements + bricks + 1 |
//! | 15 | surfaces | four u32 | surfaces that are no cell slabs |
//! | 16 | values of a channel | one to four u8, u16, u32 or f32 | values |
//! | 18 | value rel of a channel | u16 | elements + bricks |
//! | 19 | value base of a channel | u64 | ⌈(elements + bricks) / 1024⌉ |
//! | 20 | surface numbers | f64, or a u64 in its place | numbers of all of these |
//! | 21 | placements | twelve f64, u64 | maps |
//! | 22 | origins | two u64 | what slabs were made from |
//! | 23 | cell slabs | two u64 | slabs of single cells |
//! | 24 | cell slab groups | three u64 | what these were made from |
//! | 25 | moments | 23 f64 | 1, if the moments of the solid are known |
//! | 32 | windows of a tri-dexel model | four u32 | directions |
//! | 33, 38, 43 | starts along x, y, z | u32 | rays of the window + 1 |
//! | 34, 39, 44 | spans along x, y, z | two u32 or f64 | intervals |
//! | 35, 40, 45 | normals along x, y, z | two u16 or u32 | intervals |
//! | 36, 41, 46 | surfaces along x, y, z | two u32 | intervals |
//! | 37, 42, 47 | materials along x, y, z | u32 | intervals |
//!
//! Each section belongs to an object, its owner. Object 0 is the solid: an octree with sections of the kinds
//! 1 to 10, or a tri-dexel model with the kinds 1, 2 and 32 to 47. Objects of type 2 are the channels of an
//! octree, at most 256, each with a tree of its own in sections of the kinds 3 to 10, metadata of at most
//! 2^16 bytes, and the kinds 16 to 19; see [`ChannelRef`](crate::attribute::ChannelRef). Other objects and
//! other kinds are for later versions, and kinds from 2^31 on for applications: a reader skips what it does
//! not know, unless it is required.
//!
//! The specification is `format_spec/specification.md` in the source of this crate: every field, every check
//! and its reason. Beside it lie test vectors, the reasons for the design, and the list of what readers
//! accept although the writer never writes it.

mod buffer;
mod channel;
mod compose;
mod counts;
mod cuts;
pub mod dexels;
mod elements;
mod field;
mod form;
mod header;
mod kind;
mod layout;
#[cfg(feature = "mmap")]
mod mapping;
mod object;
mod octree;
mod probe;
mod read;
#[cfg(feature = "std")]
mod replace;
mod section;
mod stored;
mod swap;
mod tree;
mod tridexel;
mod verify;
mod wire;
mod write;

pub use header::{MAGIC, MAJOR, MINOR};
pub use octree::{from_bytes, from_static, to_bytes, view};
#[cfg(feature = "mmap")]
pub use octree::{map, map_verified};
#[cfg(feature = "std")]
pub use octree::{open, save, write_to};
pub use probe::{DexelProbe, Probe, Section, probe_bytes};
#[cfg(feature = "std")]
pub use probe::{probe, probe_from};
#[cfg(feature = "std")]
pub use replace::{abandon_saves, replace};
pub use verify::verify;
#[cfg(feature = "std")]
pub use verify::verify_path;
