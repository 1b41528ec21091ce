//! The layout of a file: the checked header and section table.

use super::header::{Head, Model};
use super::kind::Kind;
use super::object::{self, Object};
use super::section::{Sections, entries, read_table, section};
use crate::error::{Error, FormatError};
use crate::octree::Metadata;

/// The header of a file and the ranges of its solid's sections. Both have been checked.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub head: Head,
    pub sections: Sections,
}

impl Layout {
    /// Checks header, section table, bounds and the records of objects. O(sections + objects). `bytes` are
    /// the whole file, of any alignment; its solid must be of the kind `wanted`.
    pub fn read(bytes: &[u8], wanted: Model) -> Result<Layout, Error> {
        let head = Head::read(bytes)?;
        head.demand_model(wanted)?;
        let (expected, found) = (head.header.file_length, bytes.len() as u64);
        if expected != found {
            return Err(FormatError::Length { expected, found }.into());
        }
        let sections = read_table(&head, head.table(bytes)?)?;
        object::check(&head.header, sections.bytes(bytes, Kind::Objects)?)?;
        Ok(Layout { head, sections })
    }

    /// Returns the metadata of the file.
    pub fn metadata(&self, bytes: &[u8]) -> Result<Metadata, Error> {
        Metadata::from_bytes(self.sections.bytes(bytes, Kind::Metadata)?)
    }

    /// Checks everything but the solid itself: checksums, padding, metadata. The bytes are still in the
    /// file's byte order.
    pub fn verify(&self, bytes: &[u8]) -> Result<Metadata, Error> {
        let main = Object::main(&self.head.header);
        let mut end = self.head.table_range().end as u64;
        for entry in entries(self.head.table(bytes)?).filter(|entry| entry.same == 0) {
            let padding = section(bytes, &(end..entry.offset))?;
            if let Some(&byte) = padding.iter().find(|&&byte| byte != 0) {
                return Err(FormatError::Field { name: "padding", value: byte.into() }.into());
            }
            if crc32fast::hash(section(bytes, &entry.range())?) != entry.crc {
                return Err(FormatError::Checksum { name: entry.name(&main, self.head.header.minor) }.into());
            }
            end = entry.range().end;
        }
        self.metadata(bytes)
    }
}
