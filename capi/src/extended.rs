//! Extended octrees: built, counted, read, made plain.

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

/// Which surfaces an extended octree keeps.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_cut_options {
    /// sizeof(leafless_cut_options).
    pub struct_size: u32,
    /// Where nothing exact is known of a surface (a mesh, a function of the host), two parallel planes may
    /// stand for it that are at most this far apart. 0: only exact surfaces are kept.
    pub tolerance_model: f64,
}

// SAFETY: numbers.
unsafe impl Sized32 for leafless_cut_options {}

/// Which surfaces the host wants.
///
/// # Safety
/// As [`sized`].
pub(super) unsafe fn surface_options(cuts: *const leafless_cut_options) -> Result<SurfaceOptions, Failure> {
    // SAFETY: the caller's promise.
    let tolerance = unsafe { sized(cuts, "cuts")? }.tolerance_model;
    Ok(SurfaceOptions { tolerance: (tolerance != 0.0).then_some(tolerance) })
}

/// What the PARTIAL cells of an octree keep of the surfaces that cross them.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_cut_counts {
    /// sizeof(leafless_cut_counts).
    pub struct_size: u32,
    /// Surfaces.
    pub surfaces: u32,
    /// Cells of which it is known which function of surfaces the solid is. Parts of cells count that have
    /// functions of their own.
    pub cells: u64,
    /// Cells of which nothing is known.
    pub given_up: u64,
    /// PARTIAL cells that are split, and have no node, because all of their parts are PARTIAL.
    pub splits: u64,
    /// Bytes of all of this.
    pub bytes: u64,
}

output!(leafless_cut_counts);

/// What kind of function a surface is the zero set of, and what its numbers are.
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
    /// greater than the second, and not known between.
    LEAFLESS_STORED_SURFACE_KIND_SLAB = 4,
}
use leafless_stored_surface_kind::*;

/// A surface of an octree.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_stored_surface_info {
    /// sizeof(leafless_stored_surface_info).
    pub struct_size: u32,
    /// What its numbers are.
    pub kind: leafless_stored_surface_kind,
    /// How many numbers there are.
    pub number_count: u32,
    /// How many maps place it.
    pub placement_count: u32,
    /// Of how many doubles each number is the exact sum.
    pub terms: [u32; 10],
    /// How many doubles that is in all.
    pub term_count: u32,
    /// Whether a slab can be told from others.
    pub has_origin: bool,
    /// If so: its number where it was made. Numbers from 2^63 on are those of slabs that were made for one
    /// cell.
    pub origin_number: u64,
    /// And the fingerprint of what it was made from, the lower half first.
    pub origin: [u64; 2],
}

output!(leafless_stored_surface_info);

/// The function that the solid is in a cell.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_cell_function {
    /// The numbers of its surfaces, ascending.
    pub surfaces: [u32; 3],
    /// How many they are; 0 if nothing is known of the cell, or if it is decided.
    pub surface_count: u32,
    /// Bit m is set if points lie in the solid that are on the positive side of those surfaces i for which
    /// bit i of m is set, and on the negative side of the others.
    pub table: u8,
}

/// Builds the extended octree of a solid: a certified octree whose PARTIAL cells keep the surfaces that cross
/// them, up to three, and the function of their sides that the solid is. A cell ends as soon as three
/// surfaces are left in it, at any size, so that the octree is small, and as exact as the solid. With exact
/// surfaces alone take a frame of depth 20. The result is the same bit for bit for any number of threads.
///
/// Points, rays and boxes of an octree (leafless_octree_contains, leafless_octree_cast_rays,
/// leafless_octree_classify_box) are decided by the surfaces where they lie; next to a surface they may stay
/// undecided. As a solid (leafless_solid_from_octree) it answers as its source would. Set operations
/// (leafless_octree_combine, leafless_octree_complement) keep the surfaces. Functions that mean cells see the
/// cells alone: leafless_octree_plain makes them.
///
/// - Buffers: `frame`, one struct; `cuts`, one struct or NULL; `options`, one struct or NULL; `octree`, one
///   pointer.
/// - Result: `*octree`.
/// - Errors: as leafless_octree_build under LEAFLESS_RULE_CERTIFIED; LEAFLESS_E_ARGUMENT if the tolerance is
///   negative or no number; LEAFLESS_E_LIMIT also if an exact number of a surface is the sum of more than
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

/// The octree without surfaces that says what one with surfaces does, to a depth: for functions that mean
/// cells. What is undecided at the depth is resolved by a rule. Of an octree without surfaces it is the same
/// octree, cut at the depth.
///
/// - Buffers: `options`, one struct or NULL; `plain`, one pointer. `rule` is a leafless_rule.
/// - Result: `*plain`, with the octree's metadata and channels.
/// - Errors: as leafless_octree_build; LEAFLESS_E_ARGUMENT if `depth` is not 1 to 20.
/// - Ownership: `octree` is unchanged; release `*plain` with leafless_octree_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any octree; set `max_bytes` where the depth is not your own choice.
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

/// What the PARTIAL cells of an octree keep of the surfaces that cross them; all 0 if they keep nothing.
/// O(cells that keep something).
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

/// A surface of an extended octree: what it is, its numbers, and the maps that place it. O(1).
///
/// - Buffers: `info`, one struct; `terms`, room for `term_capacity` doubles, or NULL: those whose sums the
///   numbers are, one number after the other; `placements`, room for `placement_capacity` doubles, or NULL:
///   the 12 of the rows of [M | t] of each map, in the order in which the maps are applied.
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

/// The function that the solid is in a cell that lies in a PARTIAL one, or is one. O(depth).
///
/// - Buffers: `cell`, 3 numbers, of which each is less than 2^level; `function`, one struct.
/// - Result: `*function`. It has no surface if nothing is known of the cell, if the cell is decided, if
///   different functions hold in parts of it, or if there is no such cell.
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
