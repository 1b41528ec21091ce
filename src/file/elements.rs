//! Elements of sections, and their conversion to the bytes of a file.

use super::object::Object;
use super::wire::Wire;
use crate::error::Error;
use crate::octree::view::LevelCounts;
use crate::octree::word::Planes;

/// The elements of a section as they lie in memory.
#[derive(Clone, Copy)]
pub(super) enum Elements<'a> {
    Planes(&'a [Planes]),
    U16(&'a [u16]),
    U32(&'a [u32]),
    U64(&'a [u64]),
    Pairs16(&'a [[u16; 2]]),
    Pairs32(&'a [[u32; 2]]),
    Pairs64(&'a [[u64; 2]]),
    Triples64(&'a [[u64; 3]]),
    Fours32(&'a [[u32; 4]]),
    Placements(&'a [[u64; 13]]),
    Moments(&'a [[u64; 23]]),
    Levels(&'a [LevelCounts]),
    Objects(&'a [Object]),
    Bytes(&'a [u8]),
    /// Values of `value` bytes each, made of numbers of `number` bytes each.
    Values {
        bytes: &'a [u8],
        value: usize,
        number: usize,
    },
}

/// A function that receives the bytes of a file, in order.
pub(super) type Sink<'s> = &'s mut dyn FnMut(&[u8]) -> Result<(), Error>;

impl Elements<'_> {
    pub fn size(&self) -> usize {
        match self {
            Elements::Planes(_) => size_of::<Planes>(),
            Elements::U16(_) => size_of::<u16>(),
            Elements::U32(_) => size_of::<u32>(),
            Elements::U64(_) => size_of::<u64>(),
            Elements::Pairs16(_) => size_of::<[u16; 2]>(),
            Elements::Pairs32(_) => size_of::<[u32; 2]>(),
            Elements::Pairs64(_) => size_of::<[u64; 2]>(),
            Elements::Triples64(_) => size_of::<[u64; 3]>(),
            Elements::Fours32(_) => size_of::<[u32; 4]>(),
            Elements::Placements(_) => size_of::<[u64; 13]>(),
            Elements::Moments(_) => size_of::<[u64; 23]>(),
            Elements::Levels(_) => size_of::<LevelCounts>(),
            Elements::Objects(_) => size_of::<Object>(),
            Elements::Bytes(_) => 1,
            Elements::Values { value, .. } => *value,
        }
    }

    pub fn count(&self) -> usize {
        match self {
            Elements::Planes(elements) => elements.len(),
            Elements::U16(elements) => elements.len(),
            Elements::U32(elements) => elements.len(),
            Elements::U64(elements) => elements.len(),
            Elements::Pairs16(elements) => elements.len(),
            Elements::Pairs32(elements) => elements.len(),
            Elements::Pairs64(elements) => elements.len(),
            Elements::Triples64(elements) => elements.len(),
            Elements::Fours32(elements) => elements.len(),
            Elements::Placements(elements) => elements.len(),
            Elements::Moments(elements) => elements.len(),
            Elements::Levels(elements) => elements.len(),
            Elements::Objects(elements) => elements.len(),
            Elements::Bytes(elements) => elements.len(),
            Elements::Values { bytes, value, .. } => bytes.len() / value,
        }
    }

    /// Passes the bytes to `sink` in the file's byte order.
    pub fn write(&self, sink: Sink<'_>) -> Result<(), Error> {
        match self {
            Elements::Planes(elements) => write_elements(elements, sink),
            Elements::U16(elements) => write_elements(elements, sink),
            Elements::U32(elements) => write_elements(elements, sink),
            Elements::U64(elements) => write_elements(elements, sink),
            Elements::Pairs16(elements) => write_elements(elements, sink),
            Elements::Pairs32(elements) => write_elements(elements, sink),
            Elements::Pairs64(elements) => write_elements(elements, sink),
            Elements::Triples64(elements) => write_elements(elements, sink),
            Elements::Fours32(elements) => write_elements(elements, sink),
            Elements::Placements(elements) => write_elements(elements, sink),
            Elements::Moments(elements) => write_elements(elements, sink),
            Elements::Levels(elements) => write_elements(elements, sink),
            Elements::Objects(elements) => write_elements(elements, sink),
            Elements::Bytes(elements) => sink(elements),
            Elements::Values { bytes, .. } if cfg!(target_endian = "little") => sink(bytes),
            Elements::Values { bytes, number, .. } => bytes.chunks_exact(*number).try_for_each(|raw| {
                let mut swapped = [0; size_of::<u32>()];
                swapped[..*number].copy_from_slice(raw);
                swapped[..*number].reverse();
                sink(&swapped[..*number])
            }),
        }
    }
}

fn write_elements<T: Wire>(elements: &[T], sink: Sink<'_>) -> Result<(), Error> {
    if cfg!(target_endian = "little") {
        return sink(bytemuck::cast_slice(elements));
    }
    let mut swapped = [T::zeroed(); 256];
    for piece in elements.chunks(swapped.len()) {
        for (swapped, element) in swapped.iter_mut().zip(piece) {
            *swapped = element.ordered();
        }
        sink(bytemuck::cast_slice(&swapped[..piece.len()]))?;
    }
    Ok(())
}
