//! The Leafless file format: the arrays of an octree or a tri-dexel model as they lie in memory, mapped and
//! queried in place.
//!
//! The functions of this module are for octrees. Those in [`dexels`] have the same names and are for
//! tri-dexel models. [`probe`], [`verify`] and [`verify_path`] accept both.
//!
//! # Reading and writing
//!
//! | function | reads | checks | cost |
//! |---|---|---|---|
//! | [`probe`], [`probe_from`], [`probe_bytes`] | header and section table | both | O(sections) |
//! | [`map`], [`view`], [`from_static`] (bytes) | in place | header, section table, bounds, objects, level tables | O(sections + objects + depth) |
//! | [`map_verified`], [`verify`] (bytes) | in place | everything | O(n) |
//! | [`open`], [`from_bytes`], [`verify_path`] | a copy | everything | O(n) |
//!
//! `open` is the usual way. Mapping is for files of which a program needs only small parts. It is `unsafe`
//! because other processes may change a mapped file. [`save`], [`write_to`] and [`to_bytes`] write: equal
//! trees with equal proofs, equal metadata and equal channels give equal bytes. All functions that read a
//! solid also read its [channels](crate::attribute::Channel), except [`view`], which returns the solid alone.
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
//! For any bytes, the functions of this module do not panic, do not read beyond the bytes, and terminate:
//!
//! * [`open`], [`from_bytes`], [`map_verified`], [`verify`] and [`verify_path`] accept only a well-formed
//!   tree and well-formed channels with right checksums. All later answers are then those of a tree that was
//!   just built. These functions need O(n) time, and memory for at most six times the length of the file
//!   (once for the copy; the rest only for files that are all metadata, or all records of small channels).
//!   `open` allocates no more than the length of a regular file; for a pipe or device it allocates memory as
//!   the bytes arrive. The sections of channels may share their bytes, and every channel is checked by
//!   itself: n is the sum of the lengths of all sections, at most 257 times the length of the file.
//! * [`probe`] needs O(sections), at most 4096 of them, and twice the section table's memory. [`view`]
//!   allocates nothing. [`map`] and [`from_static`] allocate only for the metadata and the channels: six
//!   times the length of the metadata, which is at most 1 MiB for the solid and 64 KiB for each of at most
//!   256 channels, and two kilobytes a channel.
//! * After [`view`] or [`map`] the tree itself is unchecked. Point queries read at most ten elements and
//!   allocate nothing. A box query, a walk with a [`Cursor`](crate::octree::Cursor) and a Boolean visit every
//!   element at most once. A tree is built from a stored one only after all of its links are checked. A
//!   damaged part reads as PARTIAL, or makes an operation return [`Error::Damaged`](crate::Error::Damaged).
//!   The result of a Boolean never has more elements than its operands together, and the work takes at most
//!   32 times their memory (their bricks may be 16-bit indices) and 128 KiB a thread. Statistics come from
//!   the level table. The links of a channel are checked when it is first
//!   [viewed](crate::attribute::Channel::view); its values are then returned as stored, within bounds.
//! * Answers about damaged bytes are safe, but nothing more. A changed tag with a right checksum is another
//!   tree, and checksums are no signatures: the origin of a file must be established by other means.
//!
//! The files in `fuzz/` and the tests `hostile_bytes` and `resource_failures` of this crate try to refute
//! these statements.
//!
//! # The format
//!
//! Version 0.4. **Later versions of major version 0 only add to it**: a file of version 0.1 stays readable,
//! and a reader of version 0.1 reads any later file that holds an octree. Version 0.2 added channels. Version
//! 0.3 added tri-dexel models, which older readers refuse. Version 0.4 added cuts; older readers ignore them
//! and read the tree. A file has the oldest version that defines all of its objects and sections, so an
//! octree without channels and cuts is in a file of version 0.1.
//!
//! A file is a header of 128 bytes, a table of sections, and the sections: the arrays of an
//! [`OctreeRef`](crate::OctreeRef), each at a multiple of 64 bytes, all numbers little-endian. Header, table
//! and every section have a CRC32. The file name ends in `.lfl`.
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
//! | 12 | cut ids | byte of a bit stream | bytes of the surfaces of all cuts |
//! | 13 | cut blocks | two u32 | ⌈cuts / 32⌉ |
//! | 14 | cut first | u32 | elements + bricks + 1 |
//! | 15 | surfaces | four u32 | surfaces that are no cell slabs |
//! | 16 | values of a channel | one to four u8, u16, u32 or f32 | values |
//! | 18 | value rel of a channel | u16 | elements + bricks |
//! | 19 | value base of a channel | u64 | ⌈(elements + bricks) / 1024⌉ |
//! | 20 | surface numbers | f64, or a u64 in its place | numbers of all these surfaces |
//! | 21 | placements | twelve f64, u64 | maps |
//! | 22 | origins | two u64 | sources of slabs |
//! | 23 | cell slabs | two u64 | slabs of single cells |
//! | 24 | cell slab groups | three u64 | sources of cell slabs |
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
//! octree, at most 256. Each channel has a tree of its own in sections of the kinds 3 to 10, metadata of at
//! most 2^16 bytes, and the kinds 16 to 19; see [`ChannelRef`](crate::attribute::ChannelRef). Other objects
//! and other kinds are for later versions, and kinds from 2^31 on for applications. A reader skips unknown
//! objects and kinds, unless they are required.
//!
//! The specification is `format_spec/specification.md` in the source of this crate: every field, every check
//! and its reason. The same folder has test vectors, the reasons for the design, and a list of inputs that
//! readers accept although the writer never writes them.

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
