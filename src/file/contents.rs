//! What all files have in common behind their tables.

use super::header::Head;
use super::kind::Kind;
use super::object::Object;
use super::section::{Sections, entries, section};
use crate::error::{Error, FormatError};
use crate::octree::Metadata;

/// The facts that the file carries along.
pub(super) fn metadata(sections: &Sections, bytes: &[u8]) -> Result<Metadata, Error> {
    Metadata::from_bytes(sections.bytes(bytes, Kind::Metadata)?)
}

/// Everything but the solid itself: checksums, padding, metadata. The bytes are still in the file's order.
pub(super) fn verify_contents(head: &Head, sections: &Sections, bytes: &[u8]) -> Result<Metadata, Error> {
    let main = Object::main(&head.header);
    let mut end = head.table_range().end as u64;
    for entry in entries(head.table(bytes)?).filter(|entry| entry.same == 0) {
        let padding = section(bytes, &(end..entry.offset))?;
        if let Some(&byte) = padding.iter().find(|&&byte| byte != 0) {
            return Err(FormatError::Field { name: "padding", value: byte.into() }.into());
        }
        if crc32fast::hash(section(bytes, &entry.range())?) != entry.crc {
            return Err(FormatError::Checksum { name: entry.name(&main) }.into());
        }
        end = entry.range().end;
    }
    metadata(sections, bytes)
}

/// Refuses bytes that cannot be read where they lie, on this machine or at this address.
pub(super) fn check_in_place(bytes: &[u8]) -> Result<(), FormatError> {
    if cfg!(target_endian = "big") {
        return Err(FormatError::Endianness);
    }
    if bytes.as_ptr().align_offset(align_of::<u64>()) != 0 {
        return Err(FormatError::Alignment);
    }
    Ok(())
}
