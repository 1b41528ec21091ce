//! The first 128 bytes of a file.

use super::counts::Counts;
use super::field::{demand, illegal};
use super::form::Form;
use super::wire::{Wire, wire_struct};
use crate::error::{Error, FormatError};
use crate::lattice::Each;
use crate::lattice::Frame;
use crate::octree::{Proof, Tag};
use bytemuck::Zeroable;
use core::mem::offset_of;
use core::ops::Range;

/// The first eight bytes of every file; part of the format. The first byte is not ASCII. The line ends and
/// the end-of-file mark are bytes that transfers in text mode change.
pub const MAGIC: [u8; 8] = *b"\x89LFL\r\n\x1a\n";

/// Major version that this library reads and writes; part of the format.
pub const MAJOR: u16 = 0;

/// The newest minor version that this library knows; part of the format. Files of newer minor versions of the
/// same major version are readable. A file has the oldest version that defines all of its objects and
/// sections.
pub const MINOR: u16 = 4;

/// The oldest minor version that is readable, and the version of files without channels: 0.0 had another
/// section table.
pub(super) const OLDEST_MINOR: u16 = 1;

/// The required flag of a file whose solid is a tri-dexel model; part of the format.
pub(super) const FLAG_DEXELS: u32 = 1;

/// The oldest minor version that defines tri-dexel models.
pub(super) const DEXELS_MINOR: u16 = 3;

/// Maximum number of intervals of a tri-dexel model along one axis; part of the format.
const MOST_INTERVALS: u64 = u32::MAX as u64 - 1;

/// Length of the header, and offset of the section table; part of the format.
pub(super) const HEADER_LENGTH: usize = size_of::<Header>();

/// Maximum number of sections of a file; part of the format. It bounds the work of readers before anything is
/// verified.
const MAX_SECTIONS: u32 = 4096;

/// Length of an entry of the section table in bytes; part of the format.
pub(super) const ENTRY_LENGTH: usize = 48;

wire_struct! {
    /// The first 128 bytes of a file. Doubles are stored as their bits.
    struct Header: 128 {
        0 magic: [u8; 8],
        8 major: u16,
        10 minor: u16,
        12 header_length: u32,
        16 flags_required: u32,
        20 flags_optional: u32,
        24 file_length: u64,
        32 origin: [u64; 3],
        56 edge: u64,
        64 depth: u8,
        65 root: u8,
        66 exterior: u8,
        67 brick_planes: u8,
        68 brick_encoding: u8,
        69 segment_shift: u8,
        70 proof: u8,
        /// The stored properties of a tri-dexel model; else 0.
        71 form: u8,
        72 elements: u64,
        80 bricks: u64,
        88 dictionary_entries: u64,
        96 section_count: u32,
        100 table_crc: u32,
        104 displacement: u64,
        112 reserved_tail: [u8; 12],
        124 header_crc: u32,
    }
}

/// The kinds of solids in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Model {
    Octree,
    Dexels,
}

impl Header {
    /// Returns the fields that the headers of all solids on a frame have in common.
    pub fn of(frame: &Frame) -> Header {
        Header {
            magic: MAGIC,
            major: MAJOR,
            header_length: HEADER_LENGTH as u32,
            origin: frame.origin().each(f64::to_bits),
            edge: frame.edge().to_bits(),
            depth: frame.depth(),
            ..Header::zeroed()
        }
    }

    /// Returns the sizes of the arrays of the solid's tree.
    pub fn counts(&self) -> Counts {
        Counts {
            depth: self.depth,
            root: self.root,
            brick_encoding: self.brick_encoding,
            segment_shift: self.segment_shift,
            elements: self.elements,
            bricks: self.bricks,
            dictionary_entries: self.dictionary_entries,
        }
    }

    /// Returns the kind of the solid.
    pub fn model(&self) -> Model {
        let is_dexels = self.minor >= DEXELS_MINOR && self.flags_required & FLAG_DEXELS != 0;
        if is_dexels { Model::Dexels } else { Model::Octree }
    }

    /// Returns whether the solid is a tri-dexel model.
    pub fn is_dexels(&self) -> bool {
        self.model() == Model::Dexels
    }

    /// Returns whether a later version wrote the file. It may use fields that are reserved today.
    pub fn is_newer(&self) -> bool {
        self.minor > MINOR
    }
}

/// A header that passed all checks that need no other bytes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Head {
    pub header: Header,
    pub frame: Frame,
    pub root: Tag,
    pub exterior: Tag,
    pub proof: Proof,
    /// The stored properties of a tri-dexel model; `None` for an octree.
    pub form: Option<Form>,
}

impl Head {
    /// Reads the first 128 of `bytes`.
    ///
    /// The order of the checks: first the kind of file; then its version, because a newer version may have
    /// changed everything that follows; then the checksum, so that damage is reported as damage; then each
    /// field.
    pub(super) fn read(bytes: &[u8]) -> Result<Head, FormatError> {
        let known = bytes.len().min(MAGIC.len());
        if bytes[..known] != MAGIC[..known] {
            return Err(if is_text_mode(bytes) { FormatError::TextMode } else { FormatError::Magic });
        }
        let Some(raw) = bytes.get(..HEADER_LENGTH) else {
            return Err(FormatError::Length { expected: HEADER_LENGTH as u64, found: bytes.len() as u64 });
        };
        let header = bytemuck::pod_read_unaligned::<Header>(raw).ordered();
        if header.major != MAJOR || header.minor < OLDEST_MINOR {
            return Err(FormatError::Version { major: header.major, minor: header.minor });
        }
        if crc32fast::hash(&raw[..offset_of!(Header, header_crc)]) != header.header_crc {
            return Err(FormatError::Checksum { name: "the header" });
        }
        Head::check(header)
    }

    fn check(header: Header) -> Result<Head, FormatError> {
        demand("header length", header.header_length, HEADER_LENGTH as u64)?;
        let unknown = header.flags_required & !if header.is_dexels() { FLAG_DEXELS } else { 0 };
        if unknown != 0 {
            return Err(FormatError::Required { name: "flags", value: unknown.into() });
        }
        // A newer minor version may use these fields for data that can be ignored.
        if !header.is_newer() {
            demand("optional flags", header.flags_optional, 0u64)?;
            demand("reserved field", if header.is_dexels() { 0 } else { header.form }, 0u64)?;
            for byte in header.reserved_tail {
                demand("reserved field", byte, 0u64)?;
            }
        }
        // Every value of a frame has only one representation, so that equal trees have equal files.
        let frame = Frame::new(header.origin.each(f64::from_bits), f64::from_bits(header.edge), header.depth);
        let frame = frame.map_err(|refused| match refused {
            Error::Argument { name: "depth", .. } => illegal("depth", header.depth),
            Error::Argument { name: "edge", .. } => illegal("edge", header.edge),
            _ => {
                // The first coordinate that is invalid by itself.
                let alone = |&bits: &u64| Frame::new([f64::from_bits(bits); 3], 1.0, 1).is_err();
                illegal("origin", header.origin.into_iter().find(alone).unwrap_or_default())
            }
        })?;
        for (value, normal) in header.origin.into_iter().zip(frame.origin()) {
            demand("origin", value, normal.to_bits())?;
        }
        let head = if header.is_dexels() {
            Head::of_dexels(header, frame)?
        } else {
            Head::of_octree(header, frame)?
        };
        if !(1..=MAX_SECTIONS).contains(&header.section_count) {
            return Err(illegal("section count", header.section_count));
        }
        if header.file_length <= head.table_range().end as u64 {
            return Err(illegal("file length", header.file_length));
        }
        Ok(head)
    }

    fn of_octree(header: Header, frame: Frame) -> Result<Head, FormatError> {
        if header.root > 3 {
            return Err(illegal("root tag", header.root));
        }
        let root = Tag::from_code(header.root);
        let exterior = Tag::from_code(header.exterior);
        if header.exterior > 3 || exterior == Tag::Branch {
            return Err(illegal("exterior", header.exterior));
        }
        if header.proof > 3 {
            return Err(illegal("proof", header.proof));
        }
        let displacement = f64::from_bits(header.displacement);
        let proof = Proof::from_bits(header.proof)
            .with_displacement(displacement)
            .ok()
            .filter(|proof| proof.displacement().to_bits() == header.displacement)
            .ok_or(illegal("displacement", header.displacement))?;
        if !(1..=2).contains(&header.brick_planes) {
            return Err(illegal("planes of a brick", header.brick_planes));
        }
        header.counts().check()?;
        Ok(Head { header, frame, root, exterior, proof, form: None })
    }

    fn of_dexels(header: Header, frame: Frame) -> Result<Head, FormatError> {
        let Header {
            root, exterior, brick_planes, brick_encoding, segment_shift, proof, displacement, ..
        } = header;
        for byte in [root, exterior, brick_planes, brick_encoding, segment_shift, proof] {
            demand("field of octrees", byte, 0u64)?;
        }
        demand("field of octrees", displacement, 0u64)?;
        let form = Form::from_bits(header.form).ok_or(illegal("form", header.form))?;
        for (count, has) in
            [header.elements, header.bricks, header.dictionary_entries].into_iter().zip(form.directions)
        {
            if count > if has { MOST_INTERVALS } else { 0 } {
                return Err(illegal("intervals", count));
            }
        }
        Ok(Head {
            header,
            frame,
            root: Tag::Empty,
            exterior: Tag::Empty,
            proof: Proof::new(false, false),
            form: Some(form),
        })
    }

    /// Refuses a file whose solid is of another kind.
    pub(super) fn demand_model(&self, wanted: Model) -> Result<(), FormatError> {
        let name = |model| match model {
            Model::Octree => "an octree",
            Model::Dexels => "a tri-dexel model",
        };
        let [found, wanted] = [self.header.model(), wanted].each(name);
        if found == wanted { Ok(()) } else { Err(FormatError::OtherModel { found, wanted }) }
    }

    /// Returns the range of the section table.
    pub(super) fn table_range(&self) -> Range<usize> {
        // At most 128 + 4096 · 48.
        HEADER_LENGTH..HEADER_LENGTH + self.header.section_count as usize * ENTRY_LENGTH
    }

    /// Returns the section table in `bytes`, which begin at the start of the file, after checking its
    /// checksum.
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
}

/// Returns whether the signature was altered by a text-mode transfer, which rewrites line ends: there are
/// still line ends between the letters and the end-of-file mark, and one after the mark.
fn is_text_mode(bytes: &[u8]) -> bool {
    let Some(rest) = bytes.strip_prefix(b"\x89LFL") else { return false };
    let is_end = |byte: &u8| *byte == b'\r' || *byte == b'\n';
    let ends = rest.iter().take(4).take_while(|byte| is_end(byte)).count();
    ends > 0 && rest.get(ends) == Some(&0x1A) && rest.get(ends + 1).is_some_and(is_end)
}
