//! Voxel records: the voxels of an octree in arrays of the host; searching, ordering, moving, and triangles.

use super::attribute::leafless_attribute;
use super::boundary::{Buffer, Failure, Sized32, array, buffer, guard, handle, out, shared, sized, slice};
use super::channel_fill::leafless_criterion;
use super::control::{controlled, leafless_options};
use super::frame::{frame_of, leafless_frame};
use super::mesh::leafless_mesh;
use super::number::{Byte, Number, enumeration};
use super::octree::{leafless_octree, leafless_tag, settled_tag};
use super::status::leafless_status;
use leafless::Octree;
use leafless::attribute::{Attribute, Detail};
use leafless::voxel::{Symmetry, Viewpoint, VoxelBoundary, VoxelOptions, VoxelRecords, VoxelRecordsRef};
use leafless::{Cell, Frame, memory};

/// The kind of a voxel: a number in the array `kinds`.
#[derive(Clone, Copy)]
#[repr(u8)]
pub enum leafless_voxel_kind {
    /// The voxel lies outside the solid.
    LEAFLESS_VOXEL_KIND_OUTSIDE = 0,
    /// The voxel lies inside the solid.
    LEAFLESS_VOXEL_KIND_INSIDE = 1,
    /// The boundary of the solid passes through the voxel, or along it.
    LEAFLESS_VOXEL_KIND_BOUNDARY = 2,
    /// The voxel consists of the smaller voxels that follow it.
    LEAFLESS_VOXEL_KIND_REFINED = 3,
}

/// The rule for boundary voxels.
#[repr(u32)]
pub enum leafless_voxel_boundary {
    /// Cells of the boundary depth that are split further, and cells that are not decided.
    LEAFLESS_VOXEL_BOUNDARY_CUT = 0,
    /// The voxels of LEAFLESS_VOXEL_BOUNDARY_CUT, and inside cells of the boundary depth that share a face
    /// with an outside cell.
    LEAFLESS_VOXEL_BOUNDARY_TOUCHING = 1,
}

enumeration! {
    leafless_voxel_boundary => VoxelBoundary {
        LEAFLESS_VOXEL_BOUNDARY_CUT => VoxelBoundary::Undecided,
        LEAFLESS_VOXEL_BOUNDARY_TOUCHING => VoxelBoundary::Touching,
    }
}

/// The voxels that are listed in addition to inside and boundary voxels: 0, one of these values, or both
/// joined by `|`.
#[repr(u32)]
pub enum leafless_voxel_lists {
    /// Outside voxels.
    LEAFLESS_VOXEL_LISTS_OUTSIDE = 1,
    /// Refined voxels.
    LEAFLESS_VOXEL_LISTS_REFINED = 2,
}

/// Options of listing voxels: which voxels of an octree are listed, and their sizes. Zero is the default of
/// every field but the first.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_voxel_options {
    /// sizeof(leafless_voxel_options).
    pub struct_size: u32,
    /// The level of boundary voxels; 0, or more than the octree's depth, means the octree's depth.
    pub boundary_depth: u32,
    /// A leafless_voxel_boundary.
    pub boundary: Number<leafless_voxel_boundary>,
    /// 0, or leafless_voxel_lists.
    pub lists: u32,
    /// The longest edge of inside voxels, in model units; 0 means the size of the octree's cells.
    pub coarse_model: f64,
    /// With a criterion, inside voxels of this edge (model units) are not split; 0 means the coarse edge.
    pub fine_model: f64,
    /// With a criterion, the tolerance for changes of the attribute in an inside voxel that is longer than
    /// the fine edge.
    pub tolerance: f64,
    /// The attribute that inside voxels follow, and whose values are listed; optional.
    pub attribute: *const leafless_attribute,
    /// A leafless_criterion: decides whether an inside voxel between the fine and the coarse edge is fine
    /// enough. Without a criterion, all inside voxels have the coarse edge or less.
    pub criterion: Number<leafless_criterion>,
    /// Reserved; must be 0.
    pub reserved: u32,
}

// SAFETY: numbers and a pointer.
unsafe impl Sized32 for leafless_voxel_options {}

impl leafless_voxel_options {
    fn check(&self) -> Result<VoxelOptions, Failure> {
        let refused = |name, problem| Err(Failure::Argument { name, problem });
        let boundary = self.boundary.known("voxel_options.boundary")?;
        if self.lists > 3 {
            return refused("voxel_options.lists", "must be 0 or leafless_voxel_lists");
        }
        if self.reserved != 0 {
            return refused("voxel_options.reserved", "must be 0");
        }
        let criterion = self.criterion.known("voxel_options.criterion")?;
        let mut options =
            VoxelOptions::new().boundary(boundary).outside(self.lists & 1 != 0).refined(self.lists & 2 != 0);
        if self.boundary_depth != 0 {
            options = options.boundary_depth(self.boundary_depth.try_into().unwrap_or(u8::MAX));
        }
        let (coarse, fine) = (self.coarse_model, self.fine_model);
        match criterion {
            None if fine != 0.0 || self.tolerance != 0.0 => {
                return refused("voxel_options.criterion", "is needed for a fine edge and a tolerance");
            }
            None if coarse == 0.0 => {}
            None => options = options.detail(Detail::uniform(coarse)?),
            Some(_) if coarse == 0.0 => {
                return refused("voxel_options.coarse_model", "is needed with a criterion");
            }
            Some(criterion) => {
                let fine = if fine == 0.0 { coarse } else { fine };
                options = options.detail(Detail::new(coarse, fine, self.tolerance, criterion)?);
            }
        }
        Ok(options)
    }
}

/// Lists the voxels of an octree: inside and boundary voxels, and others that `voxel_options` requests. They
/// are sorted by linear octree code; of two voxels with the same code the larger comes first. The code of a
/// voxel is the Morton code of its minimum corner on the lattice `*lattice`: one octal digit for each level
/// of the lattice, from the root on; the first digits, as many as the voxel's level, are significant. Call it
/// once for the count, and then with buffers.
///
/// - Buffers: `voxel_options`, one struct or NULL; `options`, one struct or NULL (only its limit `max_bytes`
///   applies); `lattice`, one struct; `codes`, `levels`, `kinds`, `corners_model` (3 numbers a record) and
///   `values` (as many numbers a record as values have components), room for `capacity` records each; each
///   may be NULL if it is not wanted; `count`, one number.
/// - Result: `*lattice`, the octree's universe with the depth of the finest possible voxel; the arrays;
///   `*count`, the number of records. `kinds` are leafless_voxel_kind. Corners that are not doubles are
///   rounded down. Values are those at the centres of voxels, NaN where there is no value.
/// - Errors: LEAFLESS_E_ARGUMENT if an option is out of its range, or the universe would take more than 20
///   levels to the fine edge; LEAFLESS_E_BUFFER if `capacity` is too small: nothing is written then;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any octree: damage reads as boundary voxels.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_voxels(
    octree: *const leafless_octree,
    voxel_options: *const leafless_voxel_options,
    options: *const leafless_options,
    lattice: *mut leafless_frame,
    codes: *mut u64,
    levels: *mut u8,
    kinds: *mut Byte<leafless_voxel_kind>,
    corners_model: *mut f64,
    values: *mut f64,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let tree = shared(octree, "octree")?.octree.view();
        let wanted = sized(voxel_options, "voxel_options")?;
        let attribute: Option<&dyn Attribute> = match wanted.attribute.is_null() {
            true => None,
            false => Some(&shared(wanted.attribute, "voxel_options.attribute")?.attribute),
        };
        let wanted = wanted.check()?;
        let components = attribute.map_or(0, |attribute| attribute.components());
        let (lattice, count) = (out(lattice, "lattice")?, out(count, "count")?);
        let room = |each: u64| capacity.saturating_mul(each);
        let (codes, levels, kinds, corners, values) = (
            present(codes, room(1), "codes")?,
            present(levels, room(1), "levels")?,
            present(kinds.cast::<u8>(), room(1), "kinds")?,
            present(corners_model, room(3), "corners_model")?,
            present(values, room(components as u64), "values")?,
        );
        let records = controlled(options, |control| VoxelRecords::of(tree, &wanted, attribute, control))?;
        let view = records.view();
        for (is_wanted, name) in [
            (codes.wanted(), "codes"),
            (levels.wanted(), "levels"),
            (kinds.wanted(), "kinds"),
            (corners.wanted(), "corners_model"),
            (values.wanted(), "values"),
        ] {
            if is_wanted && view.len() as u64 > capacity {
                return Err(Failure::Buffer { name, needed: view.len() as u64, capacity });
            }
        }
        codes.fill(view.codes())?;
        levels.fill(view.levels())?;
        kinds.fill(view.kinds())?;
        if corners.wanted() {
            for index in 0..view.len() {
                corners_model.cast::<[f64; 3]>().add(index).write(view.corner(index).unwrap_or_default());
            }
        }
        if components > 0 {
            values.fill(view.values())?;
        }
        lattice.write(view.frame().into())?;
        count.write(view.len() as u64)
    })
}

/// Returns a buffer that may be absent, for any capacity that it shares with other buffers.
///
/// # Safety
/// As [`buffer`].
unsafe fn present<T>(start: *mut T, capacity: u64, name: &'static str) -> Result<Buffer<T>, Failure> {
    // SAFETY: the caller's promise.
    unsafe { buffer(start, if start.is_null() { 0 } else { capacity }, name) }
}

/// Returns the host's records, checked.
///
/// # Safety
/// As [`slice`].
pub(super) unsafe fn records<'a>(
    lattice: &Frame,
    codes: *const u64,
    levels: *const u8,
    kinds: *const Byte<leafless_voxel_kind>,
    count: u64,
) -> Result<VoxelRecordsRef<'a>, Failure> {
    // SAFETY: the caller's promise.
    let (codes, levels, kinds) = unsafe {
        (slice(codes, count, "codes")?, slice(levels, count, "levels")?, slice(kinds.cast(), count, "kinds")?)
    };
    Ok(VoxelRecordsRef::new(lattice, codes, levels, kinds, 0, &[])?)
}

/// Finds the record of an unrefined voxel that contains a cell. O(log count).
///
/// - Buffers: `lattice`, one struct; `codes`, `levels` and `kinds`, `count` elements each, as written by
///   leafless_octree_voxels; `cell`, 3 numbers: the cell's index on each axis; `index`, one number.
/// - Result: `*index`, the index of the record, or UINT64_MAX if there is none.
/// - Errors: LEAFLESS_E_ARGUMENT as leafless_frame_check.
/// - Untrusted input: any numbers; the answer is meaningful only if the records are sorted.
///
/// cbindgen:ptrs-as-arrays=[[cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_voxels_find(
    lattice: *const leafless_frame,
    codes: *const u64,
    levels: *const u8,
    kinds: *const Byte<leafless_voxel_kind>,
    count: u64,
    cell: *const u32,
    level: u32,
    index: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let lattice = frame_of(lattice, "lattice")?;
        let (codes, levels, kinds) = (
            slice(codes, count, "codes")?,
            slice(levels, count, "levels")?,
            slice(kinds.cast(), count, "kinds")?,
        );
        let cell = Cell { level: level.try_into().unwrap_or(u8::MAX), at: array(cell, "cell")? };
        let index = out(index, "index")?;
        let found = VoxelRecordsRef::unchecked(&lattice, codes, levels, kinds).containing(cell);
        index.write(found.map_or(u64::MAX, |found| found as u64))
    })
}

/// Returns the indices of the records from front to back: a voxel comes before every other voxel that it
/// hides in part. Refined voxels are left out. The order is exact, and computed without comparing records.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `from`, 3 numbers: the
///   direction of sight, or, if `is_eye`, the eye point (model units); `options`, one struct or NULL;
///   `order`, room for `capacity` numbers, or NULL to get only their count; `order_count`, one number.
/// - Result: `order`; `*order_count`, the number of records that are not refined.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are not valid records, the direction is zero, or a number is
///   not finite (for an eye also if a nonzero coordinate has a magnitude beyond 2^256 or below 2^-256);
///   LEAFLESS_E_BUFFER if `capacity` is too small: nothing is written then; LEAFLESS_E_NO_MEMORY;
///   LEAFLESS_E_CANCELLED.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[from; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_voxels_order(
    lattice: *const leafless_frame,
    codes: *const u64,
    levels: *const u8,
    kinds: *const Byte<leafless_voxel_kind>,
    count: u64,
    from: *const f64,
    is_eye: bool,
    options: *const leafless_options,
    order: *mut u64,
    capacity: u64,
    order_count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let records = records(&frame_of(lattice, "lattice")?, codes, levels, kinds, count)?;
        let from = array(from, "from")?;
        let from = if is_eye { Viewpoint::Perspective(from) } else { Viewpoint::Parallel(from) };
        let (order, order_count) = (buffer(order, capacity, "order")?, out(order_count, "order_count")?);
        let found = controlled(options, |control| records.depth_order(&from, control))?;
        order.fill(&found)?;
        order_count.write(found.len() as u64)
    })
}

/// Returns the records under one of the 48 symmetries of the universe about its centre, followed by an offset
/// of whole finest cells of the lattice. The map is exact: the octree of the result is the octree of the
/// records under the same map. Call it once for the count, and then with buffers.
///
/// A record whose image is not a cell becomes the largest cells that compose its image. Parts that leave the
/// universe are cut off; the space that enters has no records. A refined voxel is left out if its image is
/// not a cell of the universe.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `axes` and `offset_cells`, 3
///   numbers each; `options`, one struct or NULL (only its limit `max_bytes` applies); `moved_codes`,
///   `moved_levels`, `moved_kinds` and `sources`, room for `capacity` elements each; each may be NULL if it
///   is not wanted; `moved_count`, one number. `axes[i]` is the old axis that becomes the new axis i: 1 for
///   x, 2 for y, 3 for z, negative if its direction is reversed; 1, 2, 3 is the identity.
/// - Result: the arrays, sorted as by leafless_octree_voxels; `sources`, the index of the record that each
///   comes from; `*moved_count`, their number.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are not valid records, or `axes` are not three different axes;
///   LEAFLESS_E_BUFFER if `capacity` is too small: nothing is written then; LEAFLESS_E_LIMIT;
///   LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[axes; 3], [offset_cells; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_voxels_moved(
    lattice: *const leafless_frame,
    codes: *const u64,
    levels: *const u8,
    kinds: *const Byte<leafless_voxel_kind>,
    count: u64,
    axes: *const i32,
    offset_cells: *const i32,
    options: *const leafless_options,
    moved_codes: *mut u64,
    moved_levels: *mut u8,
    moved_kinds: *mut Byte<leafless_voxel_kind>,
    sources: *mut u64,
    capacity: u64,
    moved_count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let lattice = frame_of(lattice, "lattice")?;
        let given = records(&lattice, codes, levels, kinds, count)?;
        let axes: [i32; 3] = array(axes, "axes")?;
        let offset = array(offset_cells, "offset_cells")?;
        let old = |axis: i32| (axis.unsigned_abs() as u8).wrapping_sub(1);
        let problem = "must be 1, 2 and 3 in any order, each of them negative or not";
        let symmetry = match axes.iter().all(|axis| (1..=3).contains(&axis.unsigned_abs())) {
            true => Symmetry::new(axes.map(old), axes.map(|axis| axis < 0)).ok(),
            false => None,
        }
        .ok_or(Failure::Argument { name: "axes", problem })?;
        let (codes, levels, kinds, sources) = (
            present(moved_codes, capacity, "moved_codes")?,
            present(moved_levels, capacity, "moved_levels")?,
            present(moved_kinds.cast::<u8>(), capacity, "moved_kinds")?,
            present(sources, capacity, "sources")?,
        );
        let moved_count = out(moved_count, "moved_count")?;
        // Values carry the index of the source record. (Doubles can hold more indices than there can be
        // records.)
        let indices = memory::collected((0..given.len()).map(|index| index as f64))?;
        let given =
            VoxelRecordsRef::new(&lattice, given.codes(), given.levels(), given.kinds(), 1, &indices)?;
        let moved = controlled(options, |control| given.moved(symmetry, offset, control))?;
        let view = moved.view();
        for (is_wanted, name) in [
            (codes.wanted(), "moved_codes"),
            (levels.wanted(), "moved_levels"),
            (kinds.wanted(), "moved_kinds"),
            (sources.wanted(), "sources"),
        ] {
            if is_wanted && view.len() as u64 > capacity {
                return Err(Failure::Buffer { name, needed: view.len() as u64, capacity });
            }
        }
        codes.fill(view.codes())?;
        levels.fill(view.levels())?;
        kinds.fill(view.kinds())?;
        if sources.wanted() {
            sources.fill(&memory::collected(view.values().iter().map(|&index| index as u64))?)?;
        }
        moved_count.write(view.len() as u64)
    })
}

/// Finds the triangles of a mesh that meet each boundary voxel, in compressed rows: the triangles of record i
/// are `triangles[offsets[i]]` up to, but not including, `triangles[offsets[i + 1]]`, ascending. A triangle
/// that only touches a voxel meets it. The test is exact.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `options`, one struct or NULL
///   (only its limit `max_bytes` applies); `offsets`, room for `offset_capacity` numbers, and `triangles`,
///   room for `triangle_capacity`, each NULL to get only its count; `offset_count` and `triangle_count`, one
///   number each.
/// - Result: `offsets`, one more than there are records; `triangles`, indices into the mesh; their counts.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are not valid records; LEAFLESS_E_BUFFER if a capacity is too
///   small: nothing is written then; LEAFLESS_E_LIMIT; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Untrusted input: any numbers, any mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_voxels_triangles(
    lattice: *const leafless_frame,
    codes: *const u64,
    levels: *const u8,
    kinds: *const Byte<leafless_voxel_kind>,
    count: u64,
    mesh: *const leafless_mesh,
    options: *const leafless_options,
    offsets: *mut u64,
    offset_capacity: u64,
    offset_count: *mut u64,
    triangles: *mut u32,
    triangle_capacity: u64,
    triangle_count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let records = records(&frame_of(lattice, "lattice")?, codes, levels, kinds, count)?;
        let mesh = &shared(mesh, "mesh")?.mesh;
        let (offsets, triangles) = (
            buffer(offsets, offset_capacity, "offsets")?,
            buffer(triangles, triangle_capacity, "triangles")?,
        );
        let (offset_count, triangle_count) =
            (out(offset_count, "offset_count")?, out(triangle_count, "triangle_count")?);
        let found = controlled(options, |control| records.triangles(mesh, control))?;
        offsets.check(found.offsets().len())?;
        triangles.check(found.triangles().len())?;
        offsets.fill(found.offsets())?;
        triangles.fill(found.triangles())?;
        offset_count.write(found.offsets().len() as u64)?;
        triangle_count.write(found.triangles().len() as u64)
    })
}

/// Makes the octree of records, to the depth of their lattice: inside voxels are FULL; outside voxels and
/// space without records are EMPTY. The space outside the universe is undecided, and nothing is proven.
///
/// - Buffers: `lattice`, `codes`, `levels` and `kinds` as leafless_voxels_find; `options`, one struct or
///   NULL; `octree`, one pointer. `boundary` is the tag of boundary voxels: LEAFLESS_TAG_EMPTY,
///   LEAFLESS_TAG_PARTIAL or LEAFLESS_TAG_FULL.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_ARGUMENT if the arrays are not valid records, or `boundary` is another tag;
///   LEAFLESS_E_LIMIT; LEAFLESS_E_NO_MEMORY; LEAFLESS_E_CANCELLED.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_from_voxels(
    lattice: *const leafless_frame,
    codes: *const u64,
    levels: *const u8,
    kinds: *const Byte<leafless_voxel_kind>,
    count: u64,
    boundary: Byte<leafless_tag>,
    options: *const leafless_options,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let records = records(&frame_of(lattice, "lattice")?, codes, levels, kinds, count)?;
        let boundary = settled_tag(boundary.0.into(), "boundary")?;
        let to = out(octree, "octree")?;
        let octree: Octree = controlled(options, |control| records.to_octree(boundary, control))?;
        to.write(handle(leafless_octree { octree }))
    })
}
