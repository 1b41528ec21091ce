//! The bytes of the header and of the section table, and what they must agree on.

use crate::error::{Damage, Error, FormatError};
use crate::lattice::Frame;
use crate::octree::Tag;
use crate::octree::brick::{BrickArray, Bricks};
use crate::octree::dictionary;
use crate::octree::view::LevelCounts;
use crate::octree::view::{MAX_ELEMENT_LEVELS, OctreeRef, element_levels};
use crate::octree::word::Planes;
use bytemuck::{Pod, Zeroable};
use core::mem::offset_of;
use core::ops::Range;

/// The first eight bytes of every file; part of the format. The first byte is not ASCII, the line ends and
/// the end-of-file mark are what transfers in text mode change.
pub const MAGIC: [u8; 8] = *b"\x89LFL\r\n\x1a\n";

/// Major version that this library reads and writes; part of the format.
pub const MAJOR: u16 = 0;

/// Minor version that this library writes; part of the format. Newer ones of the same major are readable.
pub const MINOR: u16 = 0;

/// Length of the header, and offset of the section table; part of the format.
pub(super) const HEADER_LENGTH: usize = size_of::<Header>();

/// Offsets of sections are multiples of this; part of the format.
pub(super) const SECTION_ALIGNMENT: u64 = 64;

/// Most sections that a file may have; part of the format. It bounds the work of the readers that trust
/// nothing yet.
pub(super) const MAX_SECTIONS: u32 = 4096;

/// Most bytes that the metadata may take; part of the format. It bounds the work of mapping a file.
pub(super) const MAX_METADATA: u64 = 1 << 20;
const _: () = assert!(MAX_METADATA == crate::octree::metadata::MOST as u64);

/// Raw bricks, one after another; part of the format.
pub(super) const ENCODING_RAW: u8 = 0;

/// Bricks through a dictionary; part of the format.
pub(super) const ENCODING_DICTIONARY: u8 = 1;

/// Smallest base-2 logarithm of the bricks of a segment; part of the format.
pub(super) const LEAST_SEGMENT_SHIFT: u8 = 16;

/// Flag of a section that a reader must know to read the file; part of the format.
pub(super) const SECTION_REQUIRED: u32 = 1;

/// The sections that this library knows. The numbers are part of the format. 16 to 31 are reserved for
/// channels, 32 to 47 for tri-dexel models.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub(super) enum Kind {
    /// Elements: pairs of words.
    Planes = 1,
    /// First child of each element, less the base of its 1024.
    Rel = 2,
    /// First child of every 1024th element.
    Base = 3,
    /// Bricks, one after another.
    Bricks = 4,
    /// Dictionary index of each brick.
    Indices = 5,
    /// The dictionary: distinct bricks, segment by segment.
    Entries = 6,
    /// First dictionary entry of each segment.
    Segments = 7,
    /// What is counted on each octree level.
    Levels = 8,
    /// Keys and values.
    Metadata = 9,
}

/// Sections by kind: one more than the largest number in [`Kind`].
const KINDS: usize = 10;

impl Kind {
    const ALL: [Kind; 9] = [
        Kind::Planes,
        Kind::Rel,
        Kind::Base,
        Kind::Bricks,
        Kind::Indices,
        Kind::Entries,
        Kind::Segments,
        Kind::Levels,
        Kind::Metadata,
    ];

    pub(super) fn from_number(number: u32) -> Option<Kind> {
        Kind::ALL.into_iter().find(|&kind| kind as u32 == number)
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Kind::Planes => "planes",
            Kind::Rel => "rel",
            Kind::Base => "base",
            Kind::Bricks => "bricks",
            Kind::Indices => "brick indices",
            Kind::Entries => "dictionary entries",
            Kind::Segments => "dictionary segments",
            Kind::Levels => "level table",
            Kind::Metadata => "metadata",
        }
    }

    /// Only the metadata can be done without.
    pub(super) fn flags(self) -> u32 {
        if self == Kind::Metadata { 0 } else { SECTION_REQUIRED }
    }
}

/// Plain data made of numbers, which stand in a file in little-endian order.
pub(super) trait Wire: Pod {
    /// The same with the bytes of every number reversed.
    fn swap_bytes(self) -> Self;

    /// From the order of the file to that of this machine, or back.
    #[inline(always)]
    fn ordered(self) -> Self {
        if cfg!(target_endian = "big") { self.swap_bytes() } else { self }
    }
}

macro_rules! wire_number {
    ($($number:ty),*) => {$(
        impl Wire for $number {
            #[inline(always)]
            fn swap_bytes(self) -> $number {
                <$number>::swap_bytes(self)
            }
        }
    )*};
}
wire_number!(u8, u16, u32, u64);

macro_rules! wire_struct {
    ($name:ident { $($field:ident),* }) => {
        impl Wire for $name {
            #[inline(always)]
            fn swap_bytes(self) -> $name {
                $name { $($field: Wire::swap_bytes(self.$field)),* }
            }
        }
    };
}
wire_struct!(Planes { lower, upper });
wire_struct!(LevelCounts { nodes, full, partial });

impl<T: Wire, const N: usize> Wire for [T; N]
where
    [T; N]: Pod,
{
    #[inline(always)]
    fn swap_bytes(self) -> [T; N] {
        self.map(T::swap_bytes)
    }
}

/// The first 128 bytes of a file. Doubles are kept as their bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Header {
    pub magic: [u8; 8],
    pub major: u16,
    pub minor: u16,
    pub header_length: u32,
    pub flags_required: u32,
    pub flags_optional: u32,
    pub file_length: u64,
    pub origin: [u64; 3],
    pub edge: u64,
    pub depth: u8,
    pub root: u8,
    pub exterior: u8,
    pub brick_planes: u8,
    pub brick_encoding: u8,
    pub segment_shift: u8,
    pub reserved: u16,
    pub elements: u64,
    pub bricks: u64,
    pub dictionary_entries: u64,
    pub section_count: u32,
    pub table_crc: u32,
    pub reserved_tail: [u8; 20],
    pub header_crc: u32,
}

impl Header {
    /// Whether a later version wrote the file, which may have given a meaning to what is reserved today.
    fn is_newer(&self) -> bool {
        self.minor > MINOR
    }
}

wire_struct!(Header {
    magic,
    major,
    minor,
    header_length,
    flags_required,
    flags_optional,
    file_length,
    origin,
    edge,
    depth,
    root,
    exterior,
    brick_planes,
    brick_encoding,
    segment_shift,
    reserved,
    elements,
    bricks,
    dictionary_entries,
    section_count,
    table_crc,
    reserved_tail,
    header_crc
});

const _: () = {
    assert!(size_of::<Header>() == 128 && align_of::<Header>() == 8);
    assert!(offset_of!(Header, magic) == 0);
    assert!(offset_of!(Header, major) == 8);
    assert!(offset_of!(Header, minor) == 10);
    assert!(offset_of!(Header, header_length) == 12);
    assert!(offset_of!(Header, flags_required) == 16);
    assert!(offset_of!(Header, flags_optional) == 20);
    assert!(offset_of!(Header, file_length) == 24);
    assert!(offset_of!(Header, origin) == 32);
    assert!(offset_of!(Header, edge) == 56);
    assert!(offset_of!(Header, depth) == 64);
    assert!(offset_of!(Header, root) == 65);
    assert!(offset_of!(Header, exterior) == 66);
    assert!(offset_of!(Header, brick_planes) == 67);
    assert!(offset_of!(Header, brick_encoding) == 68);
    assert!(offset_of!(Header, segment_shift) == 69);
    assert!(offset_of!(Header, reserved) == 70);
    assert!(offset_of!(Header, elements) == 72);
    assert!(offset_of!(Header, bricks) == 80);
    assert!(offset_of!(Header, dictionary_entries) == 88);
    assert!(offset_of!(Header, section_count) == 96);
    assert!(offset_of!(Header, table_crc) == 100);
    assert!(offset_of!(Header, reserved_tail) == 104);
    assert!(offset_of!(Header, header_crc) == 124);
};

/// One entry of the section table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Entry {
    pub kind: u32,
    pub element_size: u32,
    pub offset: u64,
    pub length: u64,
    pub count: u64,
    pub crc: u32,
    pub flags: u32,
}

wire_struct!(Entry { kind, element_size, offset, length, count, crc, flags });

const _: () = {
    assert!(size_of::<Entry>() == 40 && align_of::<Entry>() == 8);
    assert!(offset_of!(Entry, kind) == 0);
    assert!(offset_of!(Entry, element_size) == 4);
    assert!(offset_of!(Entry, offset) == 8);
    assert!(offset_of!(Entry, length) == 16);
    assert!(offset_of!(Entry, count) == 24);
    assert!(offset_of!(Entry, crc) == 32);
    assert!(offset_of!(Entry, flags) == 36);
};

// The elements of sections are the structures in memory.
const _: () = {
    assert!(size_of::<Planes>() == 16 && align_of::<Planes>() == 8);
    assert!(offset_of!(Planes, lower) == 0 && offset_of!(Planes, upper) == 8);
    assert!(size_of::<LevelCounts>() == 24 && align_of::<LevelCounts>() == 8);
    assert!(offset_of!(LevelCounts, nodes) == 0);
    assert!(offset_of!(LevelCounts, full) == 8 && offset_of!(LevelCounts, partial) == 16);
};

impl Entry {
    /// The bytes of the section in the file. Nothing overflows in an entry that [`Table::read`] let pass;
    /// any other may yield a range that is no range of the file.
    pub(super) fn range(&self) -> Range<u64> {
        self.offset..self.offset.saturating_add(self.length)
    }

    /// Its name in error messages.
    pub(super) fn name(&self) -> &'static str {
        Kind::from_number(self.kind).map_or("an unknown section", Kind::name)
    }
}

fn illegal(name: &'static str, value: impl Into<u64>) -> FormatError {
    FormatError::Field { name, value: value.into() }
}

/// Refuses `value` unless it is `expected`.
fn demand(name: &'static str, value: impl Into<u64>, expected: impl Into<u64>) -> Result<(), FormatError> {
    let value = value.into();
    if value == expected.into() { Ok(()) } else { Err(illegal(name, value)) }
}

/// A header of which everything has been checked that can be checked without other bytes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Head {
    pub header: Header,
    pub frame: Frame,
    pub root: Tag,
    pub exterior: Tag,
}

impl Head {
    /// Reads the first 128 of `bytes`.
    ///
    /// The order of the checks: what kind of file it is, then its version, because a newer one may have
    /// changed all that follows, then the checksum, so that damage is called damage, then each field.
    pub(super) fn read(bytes: &[u8]) -> Result<Head, FormatError> {
        let known = bytes.len().min(MAGIC.len());
        if bytes[..known] != MAGIC[..known] {
            return Err(if is_text_mode(bytes) { FormatError::TextMode } else { FormatError::Magic });
        }
        let Some(raw) = bytes.get(..HEADER_LENGTH) else {
            return Err(FormatError::Length { expected: HEADER_LENGTH as u64, found: bytes.len() as u64 });
        };
        let header = bytemuck::pod_read_unaligned::<Header>(raw).ordered();
        if header.major != MAJOR {
            return Err(FormatError::Version { major: header.major, minor: header.minor });
        }
        if crc32fast::hash(&raw[..offset_of!(Header, header_crc)]) != header.header_crc {
            return Err(FormatError::Checksum { name: "the header" });
        }
        Head::check(header)
    }

    fn check(header: Header) -> Result<Head, FormatError> {
        demand("header length", header.header_length, HEADER_LENGTH as u64)?;
        if header.flags_required != 0 {
            let value = header.flags_required.into();
            return Err(FormatError::Required { name: "flags", value });
        }
        // A newer minor version may have given these a meaning that can be ignored.
        if !header.is_newer() {
            demand("optional flags", header.flags_optional, 0u64)?;
            demand("reserved field", header.reserved, 0u64)?;
            for byte in header.reserved_tail {
                demand("reserved field", byte, 0u64)?;
            }
        }
        // Every value of a frame has one spelling only, so that equal trees have equal files.
        let frame = Frame::new(header.origin.map(f64::from_bits), f64::from_bits(header.edge), header.depth);
        let frame = frame.map_err(|refused| match refused {
            Error::Argument { name: "depth", .. } => illegal("depth", header.depth),
            Error::Argument { name: "edge", .. } => illegal("edge", header.edge),
            _ => {
                // The first coordinate that is refused by itself.
                let alone = |&bits: &u64| Frame::new([f64::from_bits(bits); 3], 1.0, 1).is_err();
                illegal("origin", header.origin.into_iter().find(alone).unwrap_or_default())
            }
        })?;
        for (value, normal) in header.origin.into_iter().zip(frame.origin()) {
            demand("origin", value, normal.to_bits())?;
        }
        if header.root > 3 {
            return Err(illegal("root tag", header.root));
        }
        let root = Tag::from_code(header.root);
        let exterior = Tag::from_code(header.exterior);
        if header.exterior > 3 || exterior == Tag::Branch {
            return Err(illegal("exterior", header.exterior));
        }
        if !(1..=2).contains(&header.brick_planes) {
            return Err(illegal("planes of a brick", header.brick_planes));
        }
        match header.brick_encoding {
            ENCODING_RAW => {
                demand("segment shift", header.segment_shift, 0u64)?;
                demand("dictionary entries", header.dictionary_entries, 0u64)?;
            }
            ENCODING_DICTIONARY => {
                let shift = header.segment_shift;
                // A single segment has one spelling only.
                let whole = segments(header.bricks, shift) == 1;
                if !(LEAST_SEGMENT_SHIFT..=dictionary::WHOLE).contains(&shift)
                    || whole != (shift == dictionary::WHOLE)
                {
                    return Err(illegal("segment shift", shift));
                }
                if header.dictionary_entries == 0 || header.dictionary_entries > header.bricks {
                    return Err(illegal("dictionary entries", header.dictionary_entries));
                }
            }
            unknown => return Err(illegal("brick encoding", unknown)),
        }
        if element_levels(header.depth) == 1 {
            demand("elements", header.elements, 0u64)?;
        }
        if root != Tag::Branch {
            demand("elements", header.elements, 0u64)?;
            demand("bricks", header.bricks, 0u64)?;
        }
        if !(1..=MAX_SECTIONS).contains(&header.section_count) {
            return Err(illegal("section count", header.section_count));
        }
        let head = Head { header, frame, root, exterior };
        if header.file_length <= head.table_range().end as u64 {
            return Err(illegal("file length", header.file_length));
        }
        Ok(head)
    }

    /// Where the section table lies.
    pub(super) fn table_range(&self) -> Range<usize> {
        // At most 128 + 4096 · 40.
        HEADER_LENGTH..HEADER_LENGTH + self.header.section_count as usize * size_of::<Entry>()
    }

    /// The section table in `bytes`, which begin where the file does; its checksum is checked.
    pub(super) fn table<'a>(&self, bytes: &'a [u8]) -> Result<&'a [u8], FormatError> {
        let range = self.table_range();
        let found = bytes.len() as u64;
        let table =
            bytes.get(range.clone()).ok_or(FormatError::Length { expected: range.end as u64, found })?;
        if crc32fast::hash(table) != self.header.table_crc {
            return Err(FormatError::Checksum { name: "the section table" });
        }
        Ok(table)
    }

    /// Size of an element of a known section and how many it must have; `None` where that is free.
    fn demanded(&self, kind: Kind) -> (usize, Option<u64>) {
        let header = &self.header;
        let brick = header.brick_planes as usize * size_of::<u64>();
        let coded = header.brick_encoding == ENCODING_DICTIONARY;
        let if_coded = |count: u64| Some(if coded { count } else { 0 });
        match kind {
            Kind::Planes => (size_of::<Planes>(), Some(header.elements)),
            Kind::Rel => (size_of::<u16>(), Some(header.elements)),
            Kind::Base => (size_of::<u64>(), Some(header.elements.div_ceil(1024))),
            Kind::Bricks => (brick, Some(if coded { 0 } else { header.bricks })),
            Kind::Indices => (size_of::<u16>(), if_coded(header.bricks)),
            Kind::Entries => (brick, if_coded(header.dictionary_entries)),
            Kind::Segments => (size_of::<u64>(), if_coded(segments(header.bricks, header.segment_shift))),
            Kind::Levels => (size_of::<LevelCounts>(), Some(header.depth as u64 + 1)),
            Kind::Metadata => (1, None),
        }
    }
}

/// Segments of 2^`shift` bricks.
fn segments(bricks: u64, shift: u8) -> u64 {
    match 1u64.checked_shl(shift.into()) {
        Some(length) => bricks.div_ceil(length),
        None => 0,
    }
}

/// Whether the signature is there but for what a transfer in text mode does to line ends: whatever stands
/// between the letters and the end-of-file mark, and after it, are still line ends.
fn is_text_mode(bytes: &[u8]) -> bool {
    let Some(rest) = bytes.strip_prefix(b"\x89LFL") else { return false };
    let is_end = |byte: &u8| *byte == b'\r' || *byte == b'\n';
    let ends = rest.iter().take(4).take_while(|byte| is_end(byte)).count();
    ends > 0 && rest.get(ends) == Some(&0x1A) && rest.get(ends + 1).is_some_and(is_end)
}

/// Where the known sections lie. Every one that the header makes necessary is there with its length, they
/// ascend without overlap, and the last section ends where the file does.
#[derive(Debug, Clone)]
pub(super) struct Table {
    ranges: [Range<u64>; KINDS],
}

impl Table {
    /// Checks the bytes of a section table against its header.
    pub(super) fn read(head: &Head, table: &[u8]) -> Result<Table, FormatError> {
        let mut ranges = [const { 0..0 }; KINDS];
        let mut end = head.table_range().end as u64;
        for entry in entries(table) {
            if entry.flags & !SECTION_REQUIRED != 0 && !head.header.is_newer() {
                return Err(illegal("section flags", entry.flags));
            }
            if entry.count.checked_mul(entry.element_size.into()) != Some(entry.length) || entry.length == 0 {
                return Err(illegal("section length", entry.length));
            }
            if !entry.offset.is_multiple_of(SECTION_ALIGNMENT) || entry.offset < end {
                return Err(illegal("section offset", entry.offset));
            }
            end = match entry.offset.checked_add(entry.length) {
                Some(end) if end <= head.header.file_length => end,
                _ => return Err(illegal("section length", entry.length)),
            };
            let Some(kind) = Kind::from_number(entry.kind) else {
                if entry.kind == 0 {
                    return Err(illegal("section kind", entry.kind));
                }
                if entry.flags & SECTION_REQUIRED != 0 {
                    return Err(FormatError::Required { name: "section", value: entry.kind.into() });
                }
                continue;
            };
            let (size, count) = head.demanded(kind);
            let range = &mut ranges[kind as usize];
            let count = count.unwrap_or(entry.count);
            if range.end != 0 || (entry.element_size as usize, entry.count) != (size, count) {
                return Err(FormatError::Section { name: kind.name() });
            }
            if kind == Kind::Metadata && entry.length > MAX_METADATA {
                return Err(illegal("section length", entry.length));
            }
            if entry.flags & SECTION_REQUIRED != kind.flags() {
                return Err(illegal("section flags", entry.flags));
            }
            *range = entry.range();
        }
        for kind in Kind::ALL {
            let (_, count) = head.demanded(kind);
            // None is empty that is there.
            let present = ranges[kind as usize].end != 0;
            if count.is_some_and(|count| present != (count != 0)) {
                return Err(FormatError::Section { name: kind.name() });
            }
        }
        if end != head.header.file_length {
            return Err(FormatError::Length { expected: end, found: head.header.file_length });
        }
        Ok(Table { ranges })
    }

    /// The bytes of a section; none if it is absent.
    pub(super) fn bytes<'a>(&self, bytes: &'a [u8], kind: Kind) -> Result<&'a [u8], FormatError> {
        section(bytes, &self.ranges[kind as usize])
    }
}

/// The entries of a section table.
pub(super) fn entries(table: &[u8]) -> impl Iterator<Item = Entry> {
    elements(table)
}

/// The numbers in `bytes`, in the order of this machine, wherever they lie in memory.
fn elements<T: Wire>(bytes: &[u8]) -> impl Iterator<Item = T> {
    bytes.chunks_exact(size_of::<T>()).map(|raw| bytemuck::pod_read_unaligned::<T>(raw).ordered())
}

/// The part `range` of a file.
pub(super) fn section<'a>(bytes: &'a [u8], range: &Range<u64>) -> Result<&'a [u8], FormatError> {
    let in_memory = usize::try_from(range.start).ok().zip(usize::try_from(range.end).ok());
    in_memory
        .and_then(|(start, end)| bytes.get(start..end))
        .ok_or(FormatError::Length { expected: range.end, found: bytes.len() as u64 })
}

/// All that must be known of a file to read its tree in place.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub head: Head,
    pub table: Table,
    starts: [usize; MAX_ELEMENT_LEVELS + 1],
}

impl Layout {
    /// Checks header, section table, bounds, and that the level table's elements are the ones that are
    /// stored. O(sections + depth); `bytes` are the whole file, of any alignment.
    pub(super) fn read(bytes: &[u8]) -> Result<Layout, Error> {
        let head = Head::read(bytes)?;
        let (expected, found) = (head.header.file_length, bytes.len() as u64);
        if expected != found {
            return Err(FormatError::Length { expected, found }.into());
        }
        let table = Table::read(&head, head.table(bytes)?)?;
        let starts = starts(&head, table.bytes(bytes, Kind::Levels)?)?;
        Ok(Layout { head, table, starts })
    }

    /// The tree in `bytes`, whose numbers have this machine's order.
    pub(super) fn octree<'a>(&self, bytes: &'a [u8]) -> Result<OctreeRef<'a>, FormatError> {
        fn cast<T: Pod>(bytes: &[u8]) -> Result<&[T], FormatError> {
            bytemuck::try_cast_slice(bytes).map_err(|_| FormatError::Alignment)
        }
        fn array<'a, T: Pod>(layout: &Layout, bytes: &'a [u8]) -> Result<BrickArray<'a, T>, FormatError> {
            let section = |kind| layout.table.bytes(bytes, kind);
            let header = &layout.head.header;
            Ok(if header.brick_encoding == ENCODING_RAW {
                BrickArray::Raw(cast(section(Kind::Bricks)?)?)
            } else {
                BrickArray::Dictionary {
                    indices: cast(section(Kind::Indices)?)?,
                    entries: cast(section(Kind::Entries)?)?,
                    segments: cast(section(Kind::Segments)?)?,
                    shift: header.segment_shift,
                }
            })
        }
        let section = |kind| self.table.bytes(bytes, kind);
        Ok(OctreeRef {
            frame: self.head.frame,
            root: self.head.root,
            exterior: self.head.exterior,
            planes: cast(section(Kind::Planes)?)?,
            rel: cast(section(Kind::Rel)?)?,
            base: cast(section(Kind::Base)?)?,
            bricks: match self.head.header.brick_planes {
                1 => Bricks::One(array(self, bytes)?),
                _ => Bricks::Two(array(self, bytes)?),
            },
            starts: self.starts,
            table: Some(cast(section(Kind::Levels)?)?),
        })
    }

    /// Reverses the bytes of every number in the known sections: from the file's order to that of a
    /// big-endian machine.
    pub(super) fn swap_bytes(&self, bytes: &mut [u8]) {
        fn swap<T: Wire>(section: &mut [u8]) {
            for raw in section.chunks_exact_mut(size_of::<T>()) {
                let value = bytemuck::pod_read_unaligned::<T>(raw).swap_bytes();
                raw.copy_from_slice(bytemuck::bytes_of(&value));
            }
        }
        for kind in Kind::ALL {
            let range = &self.table.ranges[kind as usize];
            // All of them lie in the file, as `read` has checked.
            let Some(section) = bytes.get_mut(range.start as usize..range.end as usize) else { continue };
            match kind {
                Kind::Rel | Kind::Indices => swap::<u16>(section),
                Kind::Metadata => {}
                _ => swap::<u64>(section),
            }
        }
    }
}

/// Where each element level begins, from the level table: the elements of level e are the nodes of the
/// octree level at which their own cells lie. All reading code relies on what is checked here: the starts
/// ascend, bricks begin where elements end, and all elements and bricks belong to a level.
fn starts(head: &Head, levels: &[u8]) -> Result<[usize; MAX_ELEMENT_LEVELS + 1], Error> {
    let (elements_total, bricks) = (head.header.elements, head.header.bricks);
    let depth = head.header.depth;
    let count = element_levels(depth);
    let wrong = |level: usize| Error::Damaged(Damage::LevelTable { level: level as u8 });
    let total = elements_total.checked_add(bricks).and_then(|total| usize::try_from(total).ok());
    let total = total.ok_or(illegal("elements", elements_total))?;
    let mut nodes = [0u64; MAX_ELEMENT_LEVELS];
    for (level, counts) in elements::<LevelCounts>(levels).enumerate() {
        if level == 0 && counts.nodes != (head.root == Tag::Branch) as u64 {
            return Err(wrong(0));
        }
        // Of an odd depth, the root element's own cell would lie one level above the universe.
        let padded = level + depth as usize % 2;
        let own = level == 0 || padded.is_multiple_of(2);
        if let Some(nodes) = nodes.get_mut(padded / 2).filter(|_| own && padded / 2 < count) {
            *nodes = counts.nodes;
        }
    }
    let mut starts = [total; MAX_ELEMENT_LEVELS + 1];
    starts[0] = 0;
    for e in 0..count {
        let level = (2 * e).saturating_sub(depth as usize % 2);
        let end = usize::try_from(nodes[e]).ok().and_then(|nodes| starts[e].checked_add(nodes));
        starts[e + 1] = end.filter(|&end| end <= total).ok_or(wrong(level))?;
    }
    // `elements` fits, because the total does.
    if starts[count] != total || starts[count - 1] != elements_total as usize {
        return Err(wrong(depth as usize));
    }
    Ok(starts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Control;
    use crate::octree::{Metadata, Rule};
    use crate::solid::Ball;
    use alloc::vec::Vec;

    /// What a big-endian machine does when it reads a file, seen from a little-endian one.
    #[test]
    fn every_number_of_a_file_is_swapped_once() {
        let frame = Frame::new([0.0; 3], 1.0, 7).unwrap();
        let ball = Ball::new([0.5; 3], 0.45).unwrap();
        let ball = crate::op::build(&ball, &frame, Rule::Certified, &Control::threads(1)).unwrap();
        let mut metadata = Metadata::new();
        metadata.insert("units", "mm");
        let bytes = super::super::to_bytes(&ball.with_metadata(metadata)).unwrap();
        let layout = Layout::read(&bytes).unwrap();
        assert_eq!(layout.head.header.brick_encoding, ENCODING_DICTIONARY);
        let mut swapped = bytes.clone();
        layout.swap_bytes(&mut swapped);
        let head = layout.head.table_range().end;
        assert_eq!(swapped[..head], bytes[..head]);
        for kind in Kind::ALL {
            let size = match kind {
                Kind::Rel | Kind::Indices => 2,
                Kind::Metadata => 1,
                _ => 8,
            };
            let section = layout.table.bytes(&bytes, kind).unwrap();
            let reversed: Vec<u8> =
                section.chunks(size).flat_map(|number| number.iter().rev().copied()).collect();
            assert_eq!(layout.table.bytes(&swapped, kind).unwrap(), reversed, "{kind:?}");
        }
        layout.swap_bytes(&mut swapped);
        assert_eq!(swapped, bytes);
        // And the structures themselves.
        let header = layout.head.header;
        assert_eq!(header.swap_bytes().file_length.to_be_bytes(), header.file_length.to_le_bytes());
        assert_eq!((header.swap_bytes().depth, header.swap_bytes().magic), (7, MAGIC));
        assert_eq!(header.swap_bytes().swap_bytes(), header);
    }
}
