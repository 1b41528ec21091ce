//! The cuts of an octree as sections.

use super::compose::Section;
use super::elements::Elements;
use super::kind::{Element, Kind};
use super::section::Sections;
use crate::error::FormatError;
use crate::octree::cuts::{Block, CutsRef, Ids, Placement, SurfaceRecord, SurfacesRef};
use core::mem::offset_of;

// The elements of sections are the structures in memory.
const _: () = {
    assert!(size_of::<Block>() == 8 && offset_of!(Block, ids) == 0 && offset_of!(Block, splits) == 4);
    assert!(size_of::<SurfaceRecord>() == 16 && align_of::<SurfaceRecord>() == 4);
    assert!(offset_of!(SurfaceRecord, kind) == 0 && offset_of!(SurfaceRecord, terms) == 4);
    assert!(offset_of!(SurfaceRecord, first) == 8 && offset_of!(SurfaceRecord, placement) == 12);
    assert!(size_of::<Placement>() == 104 && align_of::<Placement>() == 8);
    assert!(offset_of!(Placement, rows) == 0 && offset_of!(Placement, outer) == 96);
};

/// The cuts of an octree, whose numbers have this machine's order; `None` if it has none.
pub(super) fn view<'a>(sections: &Sections, bytes: &'a [u8]) -> Result<Option<CutsRef<'a>>, FormatError> {
    let heads = sections.bytes(bytes, Kind::CutHeads)?;
    if heads.is_empty() {
        return Ok(None);
    }
    Ok(Some(CutsRef {
        heads,
        ids: match sections.ids {
            Element::U16 => Ids::U16(sections.array(bytes, Kind::CutIds)?),
            Element::U32 => Ids::U32(sections.array(bytes, Kind::CutIds)?),
            _ => Ids::U8(sections.bytes(bytes, Kind::CutIds)?),
        },
        blocks: sections.array(bytes, Kind::CutBlocks)?,
        first: sections.array(bytes, Kind::CutFirst)?,
        surfaces: SurfacesRef {
            records: sections.array(bytes, Kind::Surfaces)?,
            doubles: sections.array(bytes, Kind::SurfaceNumbers)?,
            placements: sections.array(bytes, Kind::Placements)?,
            origins: sections.array(bytes, Kind::Origins)?,
        },
    }))
}

/// The sections of cuts.
pub(super) fn sections<'a>(owner: u32, cuts: &CutsRef<'a>) -> [Section<'a>; Kind::CUTS.len()] {
    let surfaces = &cuts.surfaces;
    let ids = match cuts.ids {
        Ids::U8(ids) => Elements::Bytes(ids),
        Ids::U16(ids) => Elements::U16(ids),
        Ids::U32(ids) => Elements::U32(ids),
    };
    [
        (owner, Kind::CutHeads, Elements::Bytes(cuts.heads)),
        (owner, Kind::CutIds, ids),
        (owner, Kind::CutBlocks, Elements::Pairs32(bytemuck::cast_slice(cuts.blocks))),
        (owner, Kind::CutFirst, Elements::U32(cuts.first)),
        (owner, Kind::Surfaces, Elements::Fours32(bytemuck::cast_slice(surfaces.records))),
        (owner, Kind::SurfaceNumbers, Elements::U64(bytemuck::cast_slice(surfaces.doubles))),
        (owner, Kind::Placements, Elements::Placements(bytemuck::cast_slice(surfaces.placements))),
        (owner, Kind::Origins, Elements::Pairs64(surfaces.origins)),
    ]
}
