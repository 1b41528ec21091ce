//! How much of a solid lies in a region, and how the two lie to each other.

use super::boundary::{array, guard, out, shared};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame, leafless_interval};
use super::octree::leafless_octree;
use super::query::leafless_region;
use super::solid::leafless_solid;
use super::status::leafless_status;
use crate::query::classify_in;

/// The number of finest cells in a box that are surely solid (FULL), and of those that are possibly solid (FULL or
/// PARTIAL).
///
/// - Buffers: `min_cell` and `max_cell`, 3 numbers each: the first finest cell, and the first one beyond the box on each
///   axis; `least` and `most`, one number each.
/// - Result: `*least` and `*most`.
/// - Errors: LEAFLESS_E_ARGUMENT if the box is none, or lies outside of the universe.
/// - Ownership: nothing changes hands.
/// - Threads: any.
/// - Untrusted input: any octree, any numbers; no array element is read twice; damage reads as PARTIAL.
/// - Since: 0.1
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

/// The volume that the solid has in common with a box whose faces may lie anywhere, as an octree's cells tell it: FULL
/// ones bound it from below, FULL and PARTIAL ones from above. Cells that the box cuts count with the part in the box,
/// rounded outward. What lies outside of the universe does not count.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `volume_model`, one struct.
/// - Result: `*volume_model`, in cubic model units.
/// - Errors: LEAFLESS_E_ARGUMENT if min > max on an axis, or a coordinate is not a number.
/// - Ownership: nothing changes hands.
/// - Threads: any.
/// - Untrusted input: any octree, any numbers; no array element is read more than 27 times; damage reads as PARTIAL.
/// - Since: 0.1
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

/// How a region lies to a solid, as far as cells of the frame tell: a ball, or any other solid.
/// LEAFLESS_REGION_INSIDE means that all of the region lies in the solid; LEAFLESS_REGION_OUTSIDE that the interiors are
/// disjoint, as they also are if the region is empty; LEAFLESS_REGION_CROSSING that some of the region does and some does
/// not. The work ends as soon as the answer is known, or once `max_splits` cells of both are split. (The volume that both
/// have in common is leafless_solid_measure's of their intersection.)
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL; `relation`, one.
/// - Result: `*relation`.
/// - Errors: LEAFLESS_E_FRAME if solid or region belong to another frame; LEAFLESS_E_ARGUMENT as leafless_frame_check;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: nothing changes hands.
/// - Threads: any; works in the calling thread.
/// - Untrusted input: any solids; set `max_splits` where the depth or the solids are not your own choice.
/// - Since: 0.1
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
