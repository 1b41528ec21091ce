//! Records of the objects in a file: the solid, its channels and, in later versions, other objects.

use super::counts::Counts;
use super::field::illegal;
use super::header::Header;
use super::wire::{Wire, elements, wire_struct};
use crate::error::FormatError;
use bytemuck::Zeroable;

/// Maximum number of objects of a file; part of the format. It bounds the work of mapping a file.
pub(super) const MAX_OBJECTS: u64 = 4096;

/// The type of a solid that is an octree; part of the format. 4 is reserved for versions, 5 for values of
/// PARTIAL cells.
pub(super) const SOLID: u32 = 1;

/// The type of a channel; part of the format.
pub(super) const CHANNEL: u32 = 2;

/// The type of a solid that is a tri-dexel model; part of the format.
pub(super) const DEXELS: u32 = 3;

/// The oldest minor version in which objects of that type are channels.
pub(super) const CHANNEL_MINOR: u16 = 2;

/// The oldest minor version that defines the cuts of octrees.
pub(super) const CUTS_MINOR: u16 = 4;

/// The parent of an object without a parent; part of the format.
const NO_PARENT: u32 = u32::MAX;

/// The flag of an object whose type a reader must know to read the file; part of the format.
const OBJECT_REQUIRED: u32 = 1;

wire_struct! {
    /// The record of one object, the owner of sections. Doubles are stored as their bits.
    struct Object: 128 {
        0 kind: u32,
        4 parent: u32,
        8 flags: u32,
        12 depth: u8,
        13 root: u8,
        14 exterior: u8,
        15 proof: u8,
        16 brick_planes: u8,
        17 brick_encoding: u8,
        18 segment_shift: u8,
        19 value_type: u8,
        20 components: u8,
        /// The stored properties of a tri-dexel model; else 0.
        21 form: u8,
        22 reserved: [u8; 2],
        24 displacement: u64,
        32 origin: [u64; 3],
        56 edge: u64,
        64 extents: [u32; 3],
        76 reserved_middle: u32,
        80 elements: u64,
        88 bricks: u64,
        96 dictionary_entries: u64,
        104 values: u64,
        112 reserved_tail: [u8; 16],
    }
}

impl Object {
    /// Returns the record of object 0, an octree or a tri-dexel model, according to the header.
    pub(super) fn main(header: &Header) -> Object {
        Object {
            kind: if header.is_dexels() { DEXELS } else { SOLID },
            parent: NO_PARENT,
            flags: OBJECT_REQUIRED,
            depth: header.depth,
            root: header.root,
            exterior: header.exterior,
            proof: header.proof,
            brick_planes: header.brick_planes,
            brick_encoding: header.brick_encoding,
            segment_shift: header.segment_shift,
            form: if header.is_dexels() { header.form } else { 0 },
            displacement: header.displacement,
            origin: header.origin,
            edge: header.edge,
            elements: header.elements,
            bricks: header.bricks,
            dictionary_entries: header.dictionary_entries,
            ..Object::zeroed()
        }
    }
}

impl Object {
    /// Returns the sizes of the arrays of the object's tree.
    pub(super) fn counts(&self) -> Counts {
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

    /// Returns the numbers of intervals of a tri-dexel model along x, y and z. They are stored in the fields
    /// where an octree's record has the numbers of elements, bricks and dictionary entries.
    pub(super) fn intervals(&self) -> [u64; 3] {
        [self.elements, self.bricks, self.dictionary_entries]
    }
}

/// Checks the records of all objects: the first must repeat the header, and no unknown object may be
/// required. The contents of other records are not checked.
pub(super) fn check(header: &Header, records: &[u8]) -> Result<(), FormatError> {
    for (index, object) in (0u32..).zip(elements::<Object>(records)) {
        if index == 0 {
            // A newer minor version may use fields that are reserved today.
            let mut expected = Object::main(header);
            if header.is_newer() {
                let Object { form, reserved, reserved_middle, reserved_tail, flags, .. } = object;
                let form = if header.is_dexels() { expected.form } else { form };
                let flags = expected.flags | flags;
                expected = Object { form, reserved, reserved_middle, reserved_tail, flags, ..expected };
            }
            if object != expected {
                return Err(FormatError::Object);
            }
            continue;
        }
        if object.kind == 0 {
            return Err(illegal("object type", object.kind));
        }
        if object.flags & !OBJECT_REQUIRED != 0 && !header.is_newer() {
            return Err(illegal("object flags", object.flags));
        }
        if object.parent != NO_PARENT && object.parent >= index {
            return Err(illegal("object parent", object.parent));
        }
        if object.flags & OBJECT_REQUIRED != 0 {
            return Err(FormatError::Required { name: "object", value: object.kind.into() });
        }
    }
    Ok(())
}
