//! The content of a solid in a region, and the relation of solid and region.

use super::boundary::{array, guard, out, shared};
use super::contains::leafless_region;
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame, leafless_interval};
use super::octree::leafless_octree;
use super::solid::leafless_solid;
use super::status::leafless_status;
use leafless::query::{CellsIn, cells_in, classify_in, volume_in};

/// Bounds on the number of finest cells of a solid in a region. A cell where the region is FULL lies in the
/// region, a cell where it is EMPTY does not, and a cell where it is PARTIAL may. So the bounds hold whether
/// a cell counts if all of it lies in the region, if its centre does, or if it shares any volume with the
/// region.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_cells_in {
    /// FULL cells of the solid that are proven to lie in the region.
    pub full_least: u64,
    /// FULL cells of the solid that may lie in the region.
    pub full_most: u64,
    /// FULL and PARTIAL cells of the solid that are proven to lie in the region.
    pub upper_least: u64,
    /// FULL and PARTIAL cells of the solid that may lie in the region.
    pub upper_most: u64,
}

impl From<CellsIn> for leafless_cells_in {
    fn from(found: CellsIn) -> leafless_cells_in {
        let CellsIn { full_least, full_most, upper_least, upper_most } = found;
        leafless_cells_in { full_least, full_most, upper_least, upper_most }
    }
}

/// Counts the finest cells in a box that are certainly solid (FULL), and those that are possibly solid (FULL
/// or PARTIAL).
///
/// - Buffers: `min_cell` and `max_cell`, 3 numbers each: the first finest cell of the box, and the first cell
///   beyond it on each axis; `least` and `most`, one number each.
/// - Result: `*least` and `*most`.
/// - Errors: LEAFLESS_E_ARGUMENT if min > max on an axis, or the box is not within the universe.
/// - Untrusted input: any octree, any numbers; no array element is read twice; damage reads as PARTIAL.
///
/// cbindgen:ptrs-as-arrays=[[min_cell; 3], [max_cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_cells_in_box(
    octree: *const leafless_octree,
    min_cell: *const u32,
    max_cell: *const u32,
    least: *mut u64,
    most: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let (min, max) = (array(min_cell, "min_cell")?, array(max_cell, "max_cell")?);
        let (least, most) = (out(least, "least")?, out(most, "most")?);
        let found = octree.cells_in_box(min, max)?;
        least.write(found.0)?;
        most.write(found.1)
    })
}

/// Returns the volume that the solid of an octree shares with a box at any position. FULL cells bound it from
/// below, FULL and PARTIAL cells from above. Cells that the box cuts count with their part in the box,
/// rounded outward. Space outside the universe is ignored.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `volume_model`, one struct.
/// - Result: `*volume_model`, in cubic model units.
/// - Errors: LEAFLESS_E_ARGUMENT if min > max on an axis, or a coordinate is not a number.
/// - Untrusted input: any octree, any numbers; no array element is read more than 27 times; damage reads as
///   PARTIAL.
///
/// cbindgen:ptrs-as-arrays=[[min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_volume_in_box(
    octree: *const leafless_octree,
    min_model: *const f64,
    max_model: *const f64,
    volume_model: *mut leafless_interval,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let (min, max) = (array(min_model, "min_model")?, array(max_model, "max_model")?);
        let volume = out(volume_model, "volume_model")?;
        volume.write(octree.volume_in_box(min, max)?.into())
    })
}

/// Classifies a region, which is a ball or any other solid, against a solid, as far as the cells of the frame
/// decide it. LEAFLESS_REGION_INSIDE means that all of the region lies in the solid; LEAFLESS_REGION_OUTSIDE
/// that the interiors are disjoint, also if the region is empty; LEAFLESS_REGION_CROSSING that a part of the
/// region lies in the solid and a part does not. The work ends as soon as the answer is known, or when
/// `max_splits` cells of both are split.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `relation`, one.
/// - Result: `*relation`.
/// - Errors: LEAFLESS_E_FRAME if solid or region belong to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any solids; set `max_splits` if the depth or the solids are untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_classify_in(
    solid: *const leafless_solid,
    region: *const leafless_solid,
    frame: *const leafless_frame,
    options: *const leafless_options,
    relation: *mut leafless_region,
) -> leafless_status {
    guard(|| unsafe {
        let (solid, region) = (&shared(solid, "solid")?.solid, &shared(region, "region")?.solid);
        let frame = self::frame(frame)?;
        let relation = out(relation, "relation")?;
        let found = controlled(options, |control| classify_in(solid, region, &frame, control))?;
        relation.write(found.into())
    })
}

/// Counts the finest cells of an octree in a region, which is a ball or any other solid. The octree's cells
/// count as they are, regardless of their proofs; unproven tags of the region count as PARTIAL. Space outside
/// the universe is ignored.
///
/// Where the region is FULL, whole subtrees are counted, 64 cells at a time; where it is EMPTY, nothing is
/// read; where it is undecided and the octree is not EMPTY, it is split, down to the octree's depth. When
/// `max_splits` cells of both are split, the others count as undecided.
///
/// - Buffers: `options`, one struct or NULL; `cells`, one struct.
/// - Result: `*cells`.
/// - Errors: LEAFLESS_E_FRAME if the region belongs to another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED
///   if the region is damaged; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree, any region; no array element is read twice; damage reads as PARTIAL; set
///   `max_splits` if the depth or the region is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_cells_in(
    octree: *const leafless_octree,
    region: *const leafless_solid,
    options: *const leafless_options,
    cells: *mut leafless_cells_in,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let region = &shared(region, "region")?.solid;
        let cells = out(cells, "cells")?;
        cells.write(controlled(options, |control| octree.cells_in(region, control))?.into())
    })
}

/// Returns the volume that the solid of an octree shares with a region. FULL cells bound it from below, FULL
/// and PARTIAL cells from above. In a finest cell that the region cuts, the precision is that of the region's
/// own bounds: third order for a ball. Space outside the universe is ignored. The work is that of
/// leafless_octree_cells_in, with a microsecond or two more for each cell that is cut.
///
/// - Buffers: `options`, one struct or NULL; `volume_model`, one struct.
/// - Result: `*volume_model`, in cubic model units.
/// - Errors: as leafless_octree_cells_in.
/// - Untrusted input: as leafless_octree_cells_in.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_volume_in(
    octree: *const leafless_octree,
    region: *const leafless_solid,
    options: *const leafless_options,
    volume_model: *mut leafless_interval,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let region = &shared(region, "region")?.solid;
        let volume = out(volume_model, "volume_model")?;
        volume.write(controlled(options, |control| octree.volume_in(region, control))?.into())
    })
}

/// Counts the finest cells of a frame that lie in a solid and in a region, which is a ball or any other
/// solid. Unproven tags of either count as PARTIAL. Space outside the universe is ignored. No octree is made:
/// the time is about that of splitting the region's boundary inside the solid and the solid's boundary inside
/// the region, and the memory is proportional to the depth. When `max_splits` cells of both are split, the
/// others count as undecided.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `cells`, one struct.
/// - Result: `*cells`.
/// - Errors: LEAFLESS_E_FRAME if solid or region belong to another frame; LEAFLESS_E_ARGUMENT as
///   leafless_frame_check; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any solids; set `max_splits` if the depth or the solids are untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_cells_in(
    solid: *const leafless_solid,
    region: *const leafless_solid,
    frame: *const leafless_frame,
    options: *const leafless_options,
    cells: *mut leafless_cells_in,
) -> leafless_status {
    guard(|| unsafe {
        let (solid, region) = (&shared(solid, "solid")?.solid, &shared(region, "region")?.solid);
        let frame = self::frame(frame)?;
        let cells = out(cells, "cells")?;
        cells.write(controlled(options, |control| cells_in(solid, region, &frame, control))?.into())
    })
}

/// Returns the volume that a solid and a region share inside a frame's universe: an interval that contains
/// the truth. In a finest cell, the precision is that of the own bounds of solid and region. The work is that
/// of leafless_solid_cells_in, with a microsecond or two more for each cell that is cut. (To split until a
/// volume is known to a tolerance, use leafless_solid_measure on the intersection.)
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `volume_model`, one struct.
/// - Result: `*volume_model`, in cubic model units.
/// - Errors: as leafless_solid_cells_in.
/// - Untrusted input: as leafless_solid_cells_in.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_volume_in(
    solid: *const leafless_solid,
    region: *const leafless_solid,
    frame: *const leafless_frame,
    options: *const leafless_options,
    volume_model: *mut leafless_interval,
) -> leafless_status {
    guard(|| unsafe {
        let (solid, region) = (&shared(solid, "solid")?.solid, &shared(region, "region")?.solid);
        let frame = self::frame(frame)?;
        let volume = out(volume_model, "volume_model")?;
        volume.write(controlled(options, |control| volume_in(solid, region, &frame, control))?.into())
    })
}
