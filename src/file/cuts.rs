//! The cuts of an octree as sections.

use super::compose::Section;
use super::elements::Elements;
use super::kind::Kind;
use super::section::Sections;
use crate::error::FormatError;
use crate::lattice::Frame;
use crate::octree::cuts::{
    Block, CellSlab, CellSlabGroup, CutsRef, Ids, Placement, StoredMoments, SurfaceRecord, SurfacesRef,
    Universe, width,
};
use core::mem::offset_of;

// The elements of sections have the layout of the structures in memory.
const _: () = {
    assert!(size_of::<Block>() == 8 && offset_of!(Block, ids) == 0 && offset_of!(Block, splits) == 4);
    assert!(size_of::<SurfaceRecord>() == 16 && align_of::<SurfaceRecord>() == 4);
    assert!(offset_of!(SurfaceRecord, kind) == 0 && offset_of!(SurfaceRecord, terms) == 4);
    assert!(offset_of!(SurfaceRecord, first) == 8 && offset_of!(SurfaceRecord, placement) == 12);
    assert!(size_of::<Placement>() == 104 && align_of::<Placement>() == 8);
    assert!(offset_of!(Placement, rows) == 0 && offset_of!(Placement, outer) == 96);
    assert!(
        size_of::<CellSlab>() == 16 && offset_of!(CellSlab, home) == 0 && offset_of!(CellSlab, planes) == 8
    );
    assert!(size_of::<CellSlabGroup>() == 24 && offset_of!(CellSlabGroup, origin) == 0);
    assert!(offset_of!(CellSlabGroup, end) == 16);
    assert!(size_of::<StoredMoments>() == 184 && offset_of!(StoredMoments, point) == 0);
    assert!(offset_of!(StoredMoments, volume) == 24 && offset_of!(StoredMoments, first) == 40);
    assert!(offset_of!(StoredMoments, second) == 88);
};

/// Returns the cuts of an octree on a frame, whose numbers have this machine's byte order; `None` if there
/// are none.
pub(super) fn view<'a>(
    sections: &Sections,
    bytes: &'a [u8],
    frame: &Frame,
) -> Result<Option<CutsRef<'a>>, FormatError> {
    let heads = sections.bytes(bytes, Kind::CutHeads)?;
    if heads.is_empty() {
        return Ok(None);
    }
    let surfaces = SurfacesRef {
        records: sections.array(bytes, Kind::Surfaces)?,
        doubles: sections.array(bytes, Kind::SurfaceNumbers)?,
        placements: sections.array(bytes, Kind::Placements)?,
        origins: sections.array(bytes, Kind::Origins)?,
        slabs: sections.array(bytes, Kind::CellSlabs)?,
        groups: sections.array(bytes, Kind::CellSlabGroups)?,
        universe: Universe::of(frame),
    };
    Ok(Some(CutsRef {
        heads,
        ids: Ids { bytes: sections.bytes(bytes, Kind::CutIds)?, width: width(surfaces.len() as u64) },
        blocks: sections.array(bytes, Kind::CutBlocks)?,
        first: sections.array(bytes, Kind::CutFirst)?,
        surfaces,
        moments: sections.array(bytes, Kind::Moments)?.first(),
    }))
}

/// Returns the sections of cuts.
pub(super) fn sections<'a>(owner: u32, cuts: &CutsRef<'a>) -> [Section<'a>; Kind::CUTS.len()] {
    let surfaces = &cuts.surfaces;
    [
        (owner, Kind::CutHeads, Elements::Bytes(cuts.heads)),
        (owner, Kind::CutIds, Elements::Bytes(cuts.ids.bytes)),
        (owner, Kind::CutBlocks, Elements::Pairs32(bytemuck::cast_slice(cuts.blocks))),
        (owner, Kind::CutFirst, Elements::U32(cuts.first)),
        (owner, Kind::Surfaces, Elements::Fours32(bytemuck::cast_slice(surfaces.records))),
        (owner, Kind::SurfaceNumbers, Elements::U64(bytemuck::cast_slice(surfaces.doubles))),
        (owner, Kind::Placements, Elements::Placements(bytemuck::cast_slice(surfaces.placements))),
        (owner, Kind::Origins, Elements::Pairs64(surfaces.origins)),
        (owner, Kind::CellSlabs, Elements::Pairs64(bytemuck::cast_slice(surfaces.slabs))),
        (owner, Kind::CellSlabGroups, Elements::Triples64(bytemuck::cast_slice(surfaces.groups))),
        (
            owner,
            Kind::Moments,
            Elements::Moments(bytemuck::cast_slice(cuts.moments.map_or(&[], core::slice::from_ref))),
        ),
    ]
}
