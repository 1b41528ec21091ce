//! The one place where channels are made.
//!
//! As for octrees, elements are written depth first, each after its children, and every level has its own
//! output array. Inside an element, the cells that start a value are known at once. Between elements, they
//! are known only when the levels are joined: until then the first cell with a value in every element starts
//! one.

use super::owned::{Channel, ChannelArrays};
use super::value::{Bits, ValueType};
use crate::control::Job;
use crate::error::Error;
use crate::lattice::Frame;
use crate::memory;
use crate::octree::arrays::Arrays;
use crate::octree::brick::{OwnedArray, OwnedBricks};
use crate::octree::view::{MAX_ELEMENT_LEVELS, element_levels, root_cells};
use crate::octree::word::Planes;
use crate::octree::{Metadata, Tag};
use alloc::vec::Vec;

/// The content of a cell once everything below it is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Filled {
    /// The cell may take any value, or none.
    Free,
    /// The cell has one value, or none.
    Settled(Option<Bits>),
    /// The cell has a node, which was written.
    Branch,
}

/// The 64 cells of an element, in Morton order.
pub(crate) type Cells = [Filled; 64];

/// Elements written between two reports to the job.
const REPORT: u32 = 256;

/// The working form of a channel that is being made.
pub(crate) struct ChannelWriter<'j> {
    job: &'j Job<'j>,
    depth: u8,
    value_type: ValueType,
    levels: Vec<Level>,
    untold: (u32, usize),
}

#[derive(Default)]
struct Level {
    planes: Vec<Planes>,
    /// The values that start in each element, in the order of the elements.
    values: Vec<u8>,
}

impl<'j> ChannelWriter<'j> {
    pub(crate) fn new(job: &'j Job<'j>, depth: u8, value_type: ValueType) -> Result<Self, Error> {
        let mut levels = memory::with_capacity(element_levels(depth))?;
        levels.resize_with(element_levels(depth), Level::default);
        Ok(ChannelWriter { job, depth, value_type, levels, untold: (0, 0) })
    }

    /// Returns an empty writer for a part of the same channel, to be [appended](Self::append) later.
    pub(crate) fn sibling(&self) -> Result<ChannelWriter<'j>, Error> {
        ChannelWriter::new(self.job, self.depth, self.value_type)
    }

    pub(crate) fn job(&self) -> &'j Job<'j> {
        self.job
    }

    /// Stores an element or brick of level `e` whose children have been stored. Returns the content of its
    /// cell, which is BRANCH if it had to be stored. Free cells take the value before them.
    pub(crate) fn put(&mut self, e: usize, cells: &Cells) -> Result<Filled, Error> {
        let real = if e == 0 { root_cells(self.depth).count_ones() as usize } else { 64 };
        let cells = &cells[..real];
        let mut bound = cells.iter().filter(|&&cell| cell != Filled::Free);
        let Some(&first) = bound.next() else { return Ok(Filled::Free) };
        if first != Filled::Branch && bound.all(|&cell| cell == first) {
            return Ok(first);
        }
        let settled = cells.iter().find_map(|&cell| match cell {
            Filled::Settled(value) => Some(value),
            _ => None,
        });
        let mut taken = settled.unwrap_or(None);
        let (mut planes, mut before) = (Planes::uniform(Tag::Empty), None);
        let level = &mut self.levels[e];
        for (c, &cell) in cells.iter().enumerate() {
            match cell {
                Filled::Branch => {
                    planes.set(c as u32, Tag::Branch);
                    continue;
                }
                Filled::Settled(value) => taken = value,
                Filled::Free => {}
            }
            if taken.is_some() {
                let starts = taken != before;
                planes.set(c as u32, if starts { Tag::Full } else { Tag::Partial });
                if let (true, Some(value)) = (starts, taken) {
                    self.value_type.write(value, &mut level.values)?;
                }
                before = taken;
            }
        }
        memory::push(&mut level.planes, planes)?;
        let bytes = size_of::<Planes>() + planes.full().count_ones() as usize * self.value_type.size();
        self.untold = (self.untold.0 + 1, self.untold.1 + bytes);
        if self.untold.0 >= REPORT {
            self.report()?;
        }
        Ok(Filled::Branch)
    }

    fn report(&mut self) -> Result<(), Error> {
        let (elements, bytes) = core::mem::take(&mut self.untold);
        self.job.spend(elements as usize, bytes)
    }

    /// Takes over the output of a sibling, which comes after all output of this writer so far.
    pub(crate) fn append(&mut self, mut other: ChannelWriter<'j>) -> Result<(), Error> {
        other.report()?;
        for (level, theirs) in self.levels.iter_mut().zip(other.levels) {
            level.planes.try_reserve(theirs.planes.len())?;
            level.planes.extend_from_slice(&theirs.planes);
            level.values.try_reserve(theirs.values.len())?;
            level.values.extend_from_slice(&theirs.values);
        }
        Ok(())
    }

    /// Makes the channel: joins the levels. Only cells whose value differs from the one before start a value.
    /// `root` is the content that the last [`put`](Self::put) of level 0 returned.
    pub(crate) fn finish(mut self, frame: Frame, root: Filled, metadata: Metadata) -> Result<Channel, Error> {
        self.report()?;
        let size = self.value_type.size();
        let elements: usize = self.levels.iter().map(|level| level.planes.len()).sum();
        let bricks = self.levels.last().map_or(0, |level| level.planes.len());
        let mut all: Vec<Planes> = memory::with_capacity(elements - bricks)?;
        let mut last: Vec<Planes> = memory::with_capacity(bricks)?;
        let mut value_rel: Vec<u16> = memory::with_capacity(elements)?;
        let mut value_base: Vec<u64> = memory::with_capacity(elements.div_ceil(1024))?;
        let mut values: Vec<u8> = memory::with_capacity(self.levels.iter().map(|l| l.values.len()).sum())?;
        let mut starts = [0; MAX_ELEMENT_LEVELS + 1];
        let root = match root {
            Filled::Free | Filled::Settled(None) => Tag::Empty,
            Filled::Settled(Some(value)) => {
                values.try_reserve(size)?;
                self.value_type.write(value, &mut values)?;
                Tag::Full
            }
            Filled::Branch => Tag::Branch,
        };
        let (count, mut index) = (self.levels.len(), 0);
        for (e, level) in self.levels.iter().enumerate() {
            starts[e] = index;
            let mut fresh = level.values.chunks_exact(size);
            for &(mut planes) in &level.planes {
                let before = values.len() / size;
                if index % 1024 == 0 {
                    value_base.push(before as u64);
                }
                value_rel.push((before as u64 - value_base[index >> 10]) as u16);
                let starting = planes.full();
                for k in 0..starting.count_ones() {
                    let value = fresh.next().unwrap_or_default();
                    if k == 0 && values.len() >= size && values[values.len() - size..] == *value {
                        planes.set(starting.trailing_zeros(), Tag::Partial);
                    } else {
                        values.extend_from_slice(value);
                    }
                }
                if e + 1 < count {
                    all.push(planes)
                } else {
                    last.push(planes)
                }
                index += 1;
            }
        }
        starts[count..].fill(index);
        let bricks = OwnedBricks::Two(OwnedArray::Raw(last));
        let arrays = Arrays::link(frame, root, Tag::Empty, all, bricks, starts)?;
        values.shrink_to_fit();
        let value_type = self.value_type;
        Ok(Channel::new(ChannelArrays { arrays, value_type, value_rel, value_base, values }, metadata))
    }
}
