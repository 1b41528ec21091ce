//! The section table: the ranges, kinds and owners of sections.

use super::field::illegal;
use super::header::{ENTRY_LENGTH, Head};
use super::kind::{Element, KINDS, Kind, SECTION_REQUIRED};
use super::object::{MAX_OBJECTS, Object};
use super::wire::{Wire, elements, wire_struct};
use crate::error::FormatError;
use crate::octree::cuts::{self, BLOCK};
use crate::octree::metadata::MetadataLimit;
use bytemuck::Pod;
use core::ops::Range;

/// Offsets of sections are multiples of this; part of the format.
pub(super) const SECTION_ALIGNMENT: u64 = 64;

/// Maximum number of bytes of the metadata; part of the format. It bounds the work of mapping a file.
pub(super) const MAX_METADATA: u64 = 1 << 20;
const _: () = assert!(MAX_METADATA == MetadataLimit::SOLID.bytes() as u64);

/// Unencoded elements, one after another; part of the format. 1 is reserved for the archive.
const RAW: u8 = 0;

wire_struct! {
    /// One entry of the section table.
    struct Entry: 48 {
        0 kind: u32,
        /// The object that owns the section.
        4 owner: u32,
        8 element_type: u8,
        9 components: u8,
        10 encoding: u8,
        11 reserved: u8,
        12 flags: u32,
        16 offset: u64,
        24 length: u64,
        32 count: u64,
        40 crc: u32,
        /// 0, or one more than the index of the entry whose bytes this section shares.
        44 same: u32,
    }
}

const _: () = assert!(size_of::<Entry>() == ENTRY_LENGTH);

impl Entry {
    /// Returns the byte range of the section in the file. For an entry that [`read_table`] accepted, nothing
    /// overflows. For any other entry the range may lie outside of the file.
    pub(super) fn range(&self) -> Range<u64> {
        self.offset..self.offset.saturating_add(self.length)
    }

    /// Returns the kind, if it is a section of object 0, `main`, that this library knows.
    pub(super) fn known(&self, main: &Object, minor: u16) -> Option<Kind> {
        Kind::of(self.kind, main, minor).filter(|_| self.owner == 0)
    }

    /// Returns the section's name for error messages.
    pub(super) fn name(&self, main: &Object, minor: u16) -> &'static str {
        let unknown = if self.owner == 0 { "an unknown section" } else { "a section of another object" };
        self.known(main, minor).map_or(unknown, Kind::name)
    }

    /// Checks the entry by itself.
    fn check(&self, newer: bool) -> Result<(), FormatError> {
        if self.kind == 0 {
            return Err(illegal("section kind", self.kind));
        }
        // A newer minor version may use fields that are reserved today.
        if !newer {
            if self.flags & !SECTION_REQUIRED != 0 {
                return Err(illegal("section flags", self.flags));
            }
            if self.reserved != 0 {
                return Err(illegal("reserved field", self.reserved));
            }
            if self.encoding != RAW {
                return Err(illegal("section encoding", self.encoding));
            }
        }
        let size = Element::from_number(self.element_type).map(Element::size);
        if size.is_none() && !newer || self.components == 0 {
            return Err(illegal("element type", self.element_type as u64 | (self.components as u64) << 8));
        }
        let raw = size.filter(|_| self.encoding == RAW);
        let length = raw.map(|size| self.count.checked_mul(size * self.components as u64));
        if length.is_some_and(|length| length != Some(self.length)) || self.length == 0 || self.count == 0 {
            return Err(illegal("section length", self.length));
        }
        Ok(())
    }
}

/// Checks the bytes of a section table against its header. Entries ascend by owner and kind. Their bytes
/// ascend without overlap, or are those of an earlier entry. The last bytes end where the file ends. Returns
/// the ranges of the sections of object 0. O(sections).
pub(super) fn read_table(head: &Head, table: &[u8]) -> Result<Sections, FormatError> {
    let newer = head.header.is_newer();
    let main = Object::main(&head.header);
    let mut end = head.table_range().end as u64;
    // The first section determines the number of objects.
    let mut objects = 0;
    let mut last = (0, 0);
    for (index, entry) in entries(table).enumerate() {
        entry.check(newer)?;
        if index == 0 {
            objects =
                if entry.known(&main, head.header.minor) == Some(Kind::Objects) { entry.count } else { 0 };
            if !(1..=MAX_OBJECTS).contains(&objects) {
                return Err(FormatError::Section { name: Kind::Objects.name() });
            }
        }
        let place = (entry.owner, entry.kind);
        if entry.owner as u64 >= objects || place <= last {
            return Err(illegal("section owner", entry.owner));
        }
        last = place;
        if entry.same != 0 {
            let Entry { kind, owner, flags, same, .. } = entry;
            let before = &table[..index * size_of::<Entry>()];
            let shares = |of: Entry| of.same == 0 && Entry { kind, owner, flags, same, ..of } == entry;
            if !before
                .chunks_exact(size_of::<Entry>())
                .nth(same as usize - 1)
                .is_some_and(|raw| entries(raw).any(shares))
            {
                return Err(illegal("shared section", entry.same));
            }
        } else {
            if !entry.offset.is_multiple_of(SECTION_ALIGNMENT) || entry.offset < end {
                return Err(illegal("section offset", entry.offset));
            }
            end = match entry.offset.checked_add(entry.length) {
                Some(end) if end <= head.header.file_length => end,
                _ => return Err(illegal("section length", entry.length)),
            };
        }
    }
    // Only readers of the other objects can interpret their sections.
    let of_main = entries(table).take_while(|entry| entry.owner == 0);
    let sections = Sections::of(&main, head.header.minor, MAX_METADATA, of_main)?;
    if end != head.header.file_length {
        return Err(FormatError::Length { expected: end, found: head.header.file_length });
    }
    Ok(sections)
}

/// The ranges of an object's sections. Every section that the object's record requires is present with the
/// right length.
#[derive(Debug, Clone)]
pub(super) struct Sections {
    ranges: [Range<u64>; KINDS],
}

impl Sections {
    /// Checks the entries of an object's sections. Each entry by itself has been checked.
    pub(super) fn of(
        object: &Object,
        minor: u16,
        most_metadata: u64,
        entries: impl Iterator<Item = Entry>,
    ) -> Result<Sections, FormatError> {
        let mut ranges = [const { 0..0 }; KINDS];
        for entry in entries {
            let Some(kind) = Kind::of(entry.kind, object, minor) else {
                if entry.flags & SECTION_REQUIRED != 0 {
                    return Err(FormatError::Required { name: "section", value: entry.kind.into() });
                }
                continue;
            };
            if entry.encoding != RAW {
                return Err(FormatError::Required { name: "section encoding", value: entry.encoding.into() });
            }
            let (element, components) = kind.element(object);
            let count = kind.demanded(object).unwrap_or(entry.count);
            if (entry.element_type, entry.components, entry.count) != (element as u8, components, count) {
                return Err(FormatError::Section { name: kind.name() });
            }
            if kind == Kind::Metadata && entry.length > most_metadata {
                return Err(illegal("section length", entry.length));
            }
            if entry.flags & SECTION_REQUIRED != kind.flags() {
                return Err(illegal("section flags", entry.flags));
            }
            ranges[kind.slot()] = entry.range();
        }
        for kind in Kind::ALL.into_iter().filter(|&kind| Kind::of(kind as u32, object, minor).is_some()) {
            // A section that is present is not empty.
            let present = ranges[kind.slot()].end != 0;
            if kind.demanded(object).is_some_and(|count| present != (count != 0)) {
                return Err(FormatError::Section { name: kind.name() });
            }
        }
        let sections = Sections { ranges };
        sections.check_cuts(object)?;
        Ok(sections)
    }

    /// Checks that the sections of cuts are present together, and that their sizes agree.
    fn check_cuts(&self, object: &Object) -> Result<(), FormatError> {
        let count = |kind: Kind| {
            let (element, components) = kind.element(object);
            let range = self.range(kind);
            (range.end - range.start) / (element.size() * u64::from(components))
        };
        let (heads, records, slabs) = (count(Kind::CutHeads), count(Kind::Surfaces), count(Kind::CellSlabs));
        let surfaces = records.saturating_add(slabs);
        let most_ids = cuts::bytes(u32::MAX.into(), cuts::width(surfaces.min(u32::MAX.into())));
        let elements = object.elements.saturating_add(object.bricks);
        for kind in Kind::CUTS {
            let own = count(kind);
            let fits = match kind {
                Kind::CutHeads => own < 1 << 32,
                Kind::CutIds => own <= most_ids && (own != 0) == (surfaces != 0),
                Kind::CutBlocks => own == heads.div_ceil(BLOCK as u64),
                Kind::CutFirst => own == elements.saturating_add(1),
                Kind::Surfaces | Kind::CellSlabs => surfaces < 1 << 32,
                Kind::SurfaceNumbers => own < 1 << 32 && (own != 0) == (records != 0),
                Kind::Moments => own <= 1,
                Kind::CellSlabGroups => own <= slabs && (own != 0) == (slabs != 0),
                _ => own < 1 << 32 && (own == 0 || records != 0),
            };
            if !(fits && heads != 0 || own == 0 && heads == 0) {
                return Err(FormatError::Section { name: kind.name() });
            }
        }
        Ok(())
    }

    /// Returns the range of a section; empty if it is absent.
    pub(super) fn range(&self, kind: Kind) -> &Range<u64> {
        &self.ranges[kind.slot()]
    }

    /// Returns the ranges of the sections of `object` that are present, and the types of their numbers.
    pub(super) fn numbers(&self, object: &Object) -> impl Iterator<Item = (Range<u64>, Element)> {
        let element = move |kind: Kind| match kind {
            // All of its numbers have eight bytes.
            Kind::Placements => Element::U64,
            _ => kind.element(object).0,
        };
        let numbers = move |kind: Kind| (self.range(kind).clone(), element(kind));
        Kind::ALL.into_iter().map(numbers).filter(|(range, _)| !range.is_empty())
    }

    /// Returns the bytes of a section; none if it is absent.
    pub(super) fn bytes<'a>(&self, bytes: &'a [u8], kind: Kind) -> Result<&'a [u8], FormatError> {
        section(bytes, self.range(kind))
    }

    /// Returns the numbers of a section in place; none if it is absent.
    pub(super) fn array<'a, T: Pod>(&self, bytes: &'a [u8], kind: Kind) -> Result<&'a [T], FormatError> {
        bytemuck::try_cast_slice(self.bytes(bytes, kind)?).map_err(|_| FormatError::Alignment)
    }
}

/// Iterates over the entries of a section table.
pub(super) fn entries(table: &[u8]) -> impl Iterator<Item = Entry> {
    elements(table)
}

/// Returns the part `range` of a file.
pub(super) fn section<'a>(bytes: &'a [u8], range: &Range<u64>) -> Result<&'a [u8], FormatError> {
    let in_memory = usize::try_from(range.start).ok().zip(usize::try_from(range.end).ok());
    in_memory
        .and_then(|(start, end)| bytes.get(start..end))
        .ok_or(FormatError::Length { expected: range.end, found: bytes.len() as u64 })
}
