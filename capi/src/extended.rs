//! Extended octrees: building, counting, reading, and conversion to plain octrees.

use super::boundary::{Failure, Sized32, array, buffer, filled, guard, out, output, shared, sized};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame};
use super::number::Number;
use super::octree::{give, leafless_octree};
use super::op::leafless_rule;
use super::solid::leafless_solid;
use super::status::leafless_status;
use leafless::octree::SurfaceKind;
use leafless::{Cell, SurfaceOptions, build_extended, op};

/// Options of the surfaces that an extended octree keeps.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_cut_options {
    /// sizeof(leafless_cut_options).
    pub struct_size: u32,
    /// Largest distance, in model units, of the two parallel planes that replace a surface without an exact
    /// form (a mesh, a function of the host). 0: only exact surfaces are kept.
    pub tolerance_model: f64,
}

// SAFETY: numbers.
unsafe impl Sized32 for leafless_cut_options {}

/// Returns the host's options of surfaces.
///
/// # Safety
/// As [`sized`].
pub(super) unsafe fn surface_options(cuts: *const leafless_cut_options) -> Result<SurfaceOptions, Failure> {
    // SAFETY: the caller's promise.
    let tolerance = unsafe { sized(cuts, "cuts")? }.tolerance_model;
    Ok(SurfaceOptions { tolerance: (tolerance != 0.0).then_some(tolerance) })
}

/// Counts of the surfaces that the PARTIAL cells of an octree keep.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_cut_counts {
    /// sizeof(leafless_cut_counts).
    pub struct_size: u32,
    /// Number of surfaces.
    pub surfaces: u32,
    /// Cells in which the solid is a known function of surfaces. Parts of cells with functions of their own
    /// count.
    pub cells: u64,
    /// Cells that were given up: no function is known.
    pub given_up: u64,
    /// PARTIAL cells that are split without a node, because all of their parts are PARTIAL.
    pub splits: u64,
    /// Bytes of the surfaces and functions.
    pub bytes: u64,
}

output!(leafless_cut_counts);

/// The kind of function whose zero set a surface is, and the meaning of its numbers.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_stored_surface_kind {
    /// a, b, c, d of a x + b y + c z + d.
    LEAFLESS_STORED_SURFACE_KIND_PLANE = 0,
    /// The coefficients of x², y², z², xy, yz, zx, x, y, z and 1.
    LEAFLESS_STORED_SURFACE_KIND_QUADRIC = 1,
    /// A, a, n, B, b, m, C, c, k, D of A (x - a)^n + B (y - b)^m + C (z - c)^k + D.
    LEAFLESS_STORED_SURFACE_KIND_POWERS = 2,
    /// R, q, s, t of q - (sqrt((s x)² + (s y)²) - R)² - (s z + t)².
    LEAFLESS_STORED_SURFACE_KIND_TORUS = 3,
    /// a, b, c and two offsets: positive where a x + b y + c z is less than the first, negative where it is
    /// greater than the second, and unknown in between.
    LEAFLESS_STORED_SURFACE_KIND_SLAB = 4,
}
use leafless_stored_surface_kind::*;

/// A surface of an octree.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_stored_surface_info {
    /// sizeof(leafless_stored_surface_info).
    pub struct_size: u32,
    /// The kind of surface.
    pub kind: leafless_stored_surface_kind,
    /// Count of its numbers.
    pub number_count: u32,
    /// Count of the maps that place it.
    pub placement_count: u32,
    /// For each number, the count of doubles whose exact sum it is.
    pub terms: [u32; 10],
    /// Count of these doubles in all.
    pub term_count: u32,
    /// Whether a slab has an identity, by which equal slabs are recognised.
    pub has_origin: bool,
    /// If `has_origin`, the slab's number in its origin. Numbers from 2^63 on belong to slabs that were made
    /// for one cell.
    pub origin_number: u64,
    /// If `has_origin`, the fingerprint of the origin, the lower half first.
    pub origin: [u64; 2],
}

output!(leafless_stored_surface_info);

/// The solid in a cell as a function of surfaces.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_cell_function {
    /// Indices of its surfaces, ascending.
    pub surfaces: [u32; 3],
    /// Number of surfaces, 0 to 3; 0 if no function is known, or if the cell is decided.
    pub surface_count: u32,
    /// Truth table. Bit m is set if a point lies in the solid that is on the positive side of each surface i
    /// whose bit i of m is set, and on the negative side of the others.
    pub table: u8,
}

/// Builds the extended octree of a solid: a certified octree whose PARTIAL cells keep the surfaces that cross
/// them, up to three, and the solid as a function of the surfaces' sides. A cell is not split further when
/// three surfaces are left in it, at any size, so that the octree is small, and as exact as the solid. If all
/// surfaces are exact, use a frame of depth 20. The result is identical, bit for bit, for any number of
/// threads.
///
/// In such an octree, the surfaces decide queries of points, rays and boxes (leafless_octree_contains,
/// leafless_octree_cast_rays, leafless_octree_classify_box); next to a surface they may stay undecided. As a
/// solid (leafless_solid_from_octree) it answers like its source. Set operations (leafless_octree_combine,
/// leafless_octree_complement) keep the surfaces. Functions for cells see only the cells:
/// leafless_octree_plain converts the octree for them.
///
/// - Buffers: `frame`, one struct; `cuts`, one struct or NULL; `options`, one struct or NULL; `octree`, one
///   pointer.
/// - Result: `*octree`.
/// - Errors: as leafless_octree_build under LEAFLESS_RULE_CERTIFIED; LEAFLESS_E_ARGUMENT if the tolerance is
///   negative or not a number; LEAFLESS_E_LIMIT also if an exact number of a surface is the sum of more than
///   seven doubles.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid; set `max_bytes` if the depth or the solid is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_build_extended(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    cuts: *const leafless_cut_options,
    options: *const leafless_options,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let surfaces = surface_options(cuts)?;
        let octree = out(octree, "octree")?;
        octree.write(give(controlled(options, |control| build_extended(solid, &frame, &surfaces, control))?))
    })
}

/// Converts an extended octree to an octree without surfaces, to a depth, for functions that work on cells.
/// Cells that are undecided at the depth are resolved by a rule. For an octree without surfaces the result is
/// the same octree, cut off at the depth.
///
/// - Buffers: `options`, one struct or NULL; `plain`, one pointer. `rule` is a leafless_rule.
/// - Result: `*plain`, with the octree's metadata and channels.
/// - Errors: as leafless_octree_build; LEAFLESS_E_ARGUMENT if `depth` is not 1 to 20.
/// - Ownership: `octree` is unchanged; release `*plain` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octree; set `max_bytes` if the depth is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_plain(
    octree: *const leafless_octree,
    depth: u32,
    rule: Number<leafless_rule>,
    options: *const leafless_options,
    plain: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let depth = depth.try_into().unwrap_or(u8::MAX);
        let rule = rule.known("rule")?;
        let plain = out(plain, "plain")?;
        plain.write(give(controlled(options, |control| op::plain(octree, depth, rule, control))?))
    })
}

/// Counts the surfaces that the PARTIAL cells of an octree keep; all 0 if they keep none. O(cells that keep
/// surfaces).
///
/// - Buffers: `counts`, one struct.
/// - Result: `*counts`.
/// - Untrusted input: any octree; of one that was mapped unverified the numbers may be wrong.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_count_cuts(
    octree: *const leafless_octree,
    counts: *mut leafless_cut_counts,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let found = octree.view().cuts().unwrap_or_default();
        filled(counts, "counts")?.write(leafless_cut_counts {
            struct_size: size_of::<leafless_cut_counts>() as u32,
            surfaces: found.surfaces.try_into().unwrap_or(u32::MAX),
            cells: found.cells,
            given_up: found.given_up,
            splits: found.splits,
            bytes: found.bytes,
        })
    })
}

/// Returns a surface of an extended octree: its kind, its numbers, and the maps that place it. O(1).
///
/// - Buffers: `info`, one struct; `terms`, room for `term_capacity` doubles, or NULL: the doubles whose sums
///   are the numbers, one number after the other; `placements`, room for `placement_capacity` doubles, or
///   NULL: the 12 of the rows of [M | t] of each map, in the order in which the maps are applied.
/// - Result: `*info`, `terms` and `placements`.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no such surface, or it is damaged; LEAFLESS_E_BUFFER if a
///   capacity is too small.
/// - Untrusted input: any octree, any number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_surface_at(
    octree: *const leafless_octree,
    surface: u32,
    info: *mut leafless_stored_surface_info,
    terms: *mut f64,
    term_capacity: u64,
    placements: *mut f64,
    placement_capacity: u64,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let info = filled(info, "info")?;
        let terms = buffer(terms, term_capacity, "terms")?;
        let rows = buffer(placements, placement_capacity, "placements")?;
        let no_such = Failure::Argument { name: "surface", problem: "is no surface of the octree" };
        let found = octree.view().surface(surface).ok_or(no_such)?;
        let mut numbers = [0; 10];
        let mut all = Vec::new();
        for (i, count) in numbers.iter_mut().enumerate().take(found.numbers()) {
            *count = found.number(i).len() as u32;
            all.extend_from_slice(found.number(i));
        }
        let maps: Vec<f64> = found.placements().flatten().flatten().collect();
        terms.fill(&all)?;
        rows.fill(&maps)?;
        let origin = found.origin();
        info.write(leafless_stored_surface_info {
            struct_size: size_of::<leafless_stored_surface_info>() as u32,
            kind: match found.kind() {
                SurfaceKind::Plane => LEAFLESS_STORED_SURFACE_KIND_PLANE,
                SurfaceKind::Quadric => LEAFLESS_STORED_SURFACE_KIND_QUADRIC,
                SurfaceKind::Powers => LEAFLESS_STORED_SURFACE_KIND_POWERS,
                SurfaceKind::Torus => LEAFLESS_STORED_SURFACE_KIND_TORUS,
                _ => LEAFLESS_STORED_SURFACE_KIND_SLAB,
            },
            number_count: found.numbers() as u32,
            placement_count: (maps.len() / 12) as u32,
            terms: numbers,
            term_count: all.len() as u32,
            has_origin: origin.is_some(),
            origin_number: origin.map_or(0, |(_, number)| number),
            origin: origin.map_or([0; 2], |(origin, _)| origin),
        })
    })
}

/// Returns the function of surfaces that the solid is in a cell. The cell is PARTIAL or lies in a PARTIAL
/// cell. O(depth).
///
/// - Buffers: `cell`, 3 numbers, each less than 2^level; `function`, one struct.
/// - Result: `*function`. It has no surface if no function is known, if the cell is decided, if different
///   functions hold in parts of the cell, or if there is no such cell.
/// - Untrusted input: any octree, any numbers.
///
/// cbindgen:ptrs-as-arrays=[[cell; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_cell_function(
    octree: *const leafless_octree,
    level: u32,
    cell: *const u32,
    function: *mut leafless_cell_function,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let at = array(cell, "cell")?;
        let function = out(function, "function")?;
        let cell = Cell { level: level.try_into().unwrap_or(u8::MAX), at };
        let found = octree.view().cell_function(cell);
        let mut known = leafless_cell_function { surfaces: [0; 3], surface_count: 0, table: 0 };
        if let Some(found) = found {
            for (to, &surface) in known.surfaces.iter_mut().zip(found.surfaces()) {
                *to = surface;
                known.surface_count += 1;
            }
            known.table = found.table();
        }
        function.write(known)
    })
}
