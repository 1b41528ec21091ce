//! Arrays of intervals: one for the ends, and one for each kind of data.

use super::format::{DexelFormat, DexelNormals};
use super::item::{Item, Mark, NO_SURFACE};
use super::normal::{NO_NORMAL, coarse, fine, is_code, is_code_16};
use super::place::{Place, Span};
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;
use core::ops::Range;

/// Codes of normals at both ends.
#[derive(Debug, Clone, Copy)]
pub(crate) enum NormalsRef<'a> {
    None,
    Bits16(&'a [[u16; 2]]),
    Bits32(&'a [[u32; 2]]),
}

/// Borrowed arrays, all of the same length.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ColumnsRef<'a, S> {
    pub spans: &'a [S],
    pub surfaces: Option<&'a [[u32; 2]]>,
    pub normals: NormalsRef<'a>,
    pub materials: Option<&'a [u32]>,
}

impl<S: Span> ColumnsRef<'_, S> {
    /// Returns whether the normals of interval i, which must exist, are valid codes.
    pub fn has_codes(&self, i: usize) -> bool {
        match self.normals {
            NormalsRef::None => true,
            NormalsRef::Bits16(normals) => {
                normals.get(i).is_some_and(|codes| codes.iter().all(|&code| is_code_16(code)))
            }
            NormalsRef::Bits32(normals) => {
                normals.get(i).is_some_and(|codes| codes.iter().all(|&code| is_code(code)))
            }
        }
    }

    /// Interval i, which must exist.
    #[inline]
    pub fn item(&self, i: usize) -> Item<S::Place> {
        let surfaces = self.surfaces.and_then(|s| s.get(i)).copied().unwrap_or([NO_SURFACE; 2]);
        let normals = match self.normals {
            NormalsRef::None => [NO_NORMAL; 2],
            NormalsRef::Bits16(normals) => normals.get(i).map_or([NO_NORMAL; 2], |codes| codes.each(fine)),
            NormalsRef::Bits32(normals) => normals.get(i).copied().unwrap_or([NO_NORMAL; 2]),
        };
        Item {
            ends: self.spans[i].ends(),
            marks: [0, 1].each(|k| Mark { surface: surfaces[k], normal: normals[k] }),
            material: self.materials.and_then(|m| m.get(i)).copied().unwrap_or(0),
        }
    }
}

/// Owned codes of normals.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Normals {
    None,
    Bits16(Vec<[u16; 2]>),
    Bits32(Vec<[u32; 2]>),
}

/// Owned arrays.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Columns<S> {
    pub spans: Vec<S>,
    pub surfaces: Option<Vec<[u32; 2]>>,
    pub normals: Normals,
    pub materials: Option<Vec<u32>>,
}

impl<S: Span> Columns<S> {
    /// Makes empty columns.
    pub fn new(format: &DexelFormat) -> Columns<S> {
        Columns {
            spans: Vec::new(),
            surfaces: format.surfaces.then(Vec::new),
            normals: match format.normals {
                DexelNormals::None => Normals::None,
                DexelNormals::Bits16 => Normals::Bits16(Vec::new()),
                DexelNormals::Bits32 => Normals::Bits32(Vec::new()),
            },
            materials: format.materials.then(Vec::new),
        }
    }

    pub fn view(&self) -> ColumnsRef<'_, S> {
        ColumnsRef {
            spans: &self.spans,
            surfaces: self.surfaces.as_deref(),
            normals: match &self.normals {
                Normals::None => NormalsRef::None,
                Normals::Bits16(normals) => NormalsRef::Bits16(normals),
                Normals::Bits32(normals) => NormalsRef::Bits32(normals),
            },
            materials: self.materials.as_deref(),
        }
    }

    pub fn reserve(&mut self, more: usize, exactly: bool) -> Result<(), Error> {
        fn grow<T>(list: &mut Vec<T>, more: usize, exactly: bool) -> Result<(), Error> {
            Ok(if exactly { list.try_reserve_exact(more) } else { list.try_reserve(more) }?)
        }
        grow(&mut self.spans, more, exactly)?;
        if let Some(surfaces) = &mut self.surfaces {
            grow(surfaces, more, exactly)?;
        }
        match &mut self.normals {
            Normals::None => {}
            Normals::Bits16(normals) => grow(normals, more, exactly)?,
            Normals::Bits32(normals) => grow(normals, more, exactly)?,
        }
        if let Some(materials) = &mut self.materials {
            grow(materials, more, exactly)?;
        }
        Ok(())
    }

    /// Appends an interval.
    #[inline]
    pub fn push(&mut self, item: &Item<S::Place>) -> Result<(), Error> {
        memory::push(&mut self.spans, S::new(item.ends))?;
        if let Some(surfaces) = &mut self.surfaces {
            memory::push(surfaces, item.marks.each(|mark| mark.surface))?;
        }
        match &mut self.normals {
            Normals::None => {}
            Normals::Bits16(normals) => memory::push(normals, item.marks.each(|mark| coarse(mark.normal)))?,
            Normals::Bits32(normals) => memory::push(normals, item.marks.each(|mark| mark.normal))?,
        }
        if let Some(materials) = &mut self.materials {
            memory::push(materials, item.material)?;
        }
        Ok(())
    }

    /// Replaces an interval.
    #[inline]
    pub fn set(&mut self, i: usize, item: &Item<S::Place>) {
        self.spans[i] = S::new(item.ends);
        if let Some(surfaces) = &mut self.surfaces {
            surfaces[i] = item.marks.each(|mark| mark.surface);
        }
        match &mut self.normals {
            Normals::None => {}
            Normals::Bits16(normals) => normals[i] = item.marks.each(|mark| coarse(mark.normal)),
            Normals::Bits32(normals) => normals[i] = item.marks.each(|mark| mark.normal),
        }
        if let Some(materials) = &mut self.materials {
            materials[i] = item.material;
        }
    }

    /// Appends empty intervals, to be set.
    pub fn lengthen(&mut self, count: usize) -> Result<(), Error> {
        let empty = Item::plain([S::Place::LOW; 2]);
        self.reserve(count, false)?;
        for _ in 0..count {
            self.push(&empty)?;
        }
        Ok(())
    }

    /// Appends intervals unchanged. Data that `from` does not have is unknown.
    #[inline]
    pub fn copy(&mut self, from: &ColumnsRef<'_, S>, range: Range<usize>) -> Result<(), Error> {
        self.reserve(range.len(), false)?;
        self.spans.extend_from_slice(&from.spans[range.clone()]);
        if let Some(surfaces) = &mut self.surfaces {
            match from.surfaces {
                Some(from) => surfaces.extend_from_slice(&from[range.clone()]),
                None => surfaces.resize(surfaces.len() + range.len(), [NO_SURFACE; 2]),
            }
        }
        match (&mut self.normals, from.normals) {
            (Normals::None, _) => {}
            (Normals::Bits16(to), NormalsRef::Bits16(from)) => to.extend_from_slice(&from[range.clone()]),
            (Normals::Bits32(to), NormalsRef::Bits32(from)) => to.extend_from_slice(&from[range.clone()]),
            (Normals::Bits16(to), _) => {
                to.extend(range.clone().map(|i| from.item(i).marks.each(|mark| coarse(mark.normal))))
            }
            (Normals::Bits32(to), _) => {
                to.extend(range.clone().map(|i| from.item(i).marks.each(|mark| mark.normal)))
            }
        }
        if let Some(materials) = &mut self.materials {
            match from.materials {
                Some(from) => materials.extend_from_slice(&from[range]),
                None => materials.resize(materials.len() + range.len(), 0),
            }
        }
        Ok(())
    }

    pub fn clear(&mut self) {
        self.spans.clear();
        if let Some(surfaces) = &mut self.surfaces {
            surfaces.clear();
        }
        match &mut self.normals {
            Normals::None => {}
            Normals::Bits16(normals) => normals.clear(),
            Normals::Bits32(normals) => normals.clear(),
        }
        if let Some(materials) = &mut self.materials {
            materials.clear();
        }
    }

    /// Empty columns with the same kinds of data.
    pub fn empty_copy(&self) -> Columns<S> {
        Columns {
            spans: Vec::new(),
            surfaces: self.surfaces.as_ref().map(|_| Vec::new()),
            normals: match &self.normals {
                Normals::None => Normals::None,
                Normals::Bits16(_) => Normals::Bits16(Vec::new()),
                Normals::Bits32(_) => Normals::Bits32(Vec::new()),
            },
            materials: self.materials.as_ref().map(|_| Vec::new()),
        }
    }

    /// Overwrites the intervals from index `first` on by those of `from`, which has the same kinds of data.
    #[inline]
    pub fn overwrite(&mut self, first: usize, from: &Columns<S>) {
        let range = first..first + from.spans.len();
        self.spans[range.clone()].copy_from_slice(&from.spans);
        if let (Some(to), Some(from)) = (&mut self.surfaces, &from.surfaces) {
            to[range.clone()].copy_from_slice(from);
        }
        match (&mut self.normals, &from.normals) {
            (Normals::Bits16(to), Normals::Bits16(from)) => to[range.clone()].copy_from_slice(from),
            (Normals::Bits32(to), Normals::Bits32(from)) => to[range.clone()].copy_from_slice(from),
            _ => {}
        }
        if let (Some(to), Some(from)) = (&mut self.materials, &from.materials) {
            to[range].copy_from_slice(from);
        }
    }
}
