//! Measures of solids: volume, centroid, inertia, areas of surfaces and sections, bounding boxes.

use super::boundary::{array, filled, guard, output, shared};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame, leafless_interval};
use super::octree::leafless_proof;
use super::solid::leafless_solid;
use super::status::leafless_status;
use leafless::Interval;
use leafless::query::{
    Extent, SectionArea, SectionPlane, StopReason, SurfaceArea, section_area, surface_area,
};
use leafless::{MassProperties, Tolerance, bounding_box, measure};

/// The reason why a search or a measurement ended.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_stop_reason {
    /// The result has the requested precision.
    LEAFLESS_STOP_REASON_TOLERANCE = 0,
    /// `max_splits` of the options, or the function's default limit, is spent.
    LEAFLESS_STOP_REASON_BUDGET = 1,
    /// No cell is left whose split would help: undecided cells have the size of the frame's finest cells, or
    /// the solid itself has no more information about them, such as an octree about its PARTIAL cells.
    LEAFLESS_STOP_REASON_EXHAUSTED = 2,
}
use leafless_stop_reason::*;

impl From<StopReason> for leafless_stop_reason {
    fn from(reason: StopReason) -> leafless_stop_reason {
        match reason {
            StopReason::Tolerance => LEAFLESS_STOP_REASON_TOLERANCE,
            StopReason::Budget => LEAFLESS_STOP_REASON_BUDGET,
            StopReason::Exhausted => LEAFLESS_STOP_REASON_EXHAUSTED,
        }
    }
}

/// Mass properties of a solid of density 1. All intervals contain the truth. They are those of the part
/// inside the universe, which is the whole solid unless `is_clipped`.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_measures {
    /// sizeof(leafless_measures).
    pub struct_size: u32,
    /// Volume.
    pub volume_model: leafless_interval,
    /// Centroid; intervals of all numbers unless `has_centroid`.
    pub centroid_model: [leafless_interval; 3],
    /// Tensor of inertia about the model's origin, row by row: the integral of |p|²δij - pi·pj over the
    /// points p of the solid. So products of inertia are negative where the product of the coordinates is
    /// mostly positive.
    pub inertia_origin_model: [leafless_interval; 9],
    /// Tensor of inertia about the centroid, for every position of the centroid in its interval.
    pub inertia_centroid_model: [leafless_interval; 9],
    /// The proofs about the solid; unproven tags count as undecided.
    pub proof: leafless_proof,
    /// Number of cell splits.
    pub splits: u64,
    /// The finest level of the visited cells.
    pub level: u32,
    /// The reason why the computation ended.
    pub measured: leafless_stop_reason,
    /// Whether a cell is proven full. Otherwise the solid may be empty, and the centroid is not known.
    pub has_centroid: bool,
    /// Whether the solid may extend beyond the universe, or does.
    pub is_clipped: bool,
    /// Whether the solid was not split because it provides its own moments, up to rounding, as a closed mesh
    /// without intersecting triangles does.
    pub is_exact: bool,
}

output!(leafless_measures);

/// The area of a solid's boundary.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_surface_area {
    /// sizeof(leafless_surface_area).
    pub struct_size: u32,
    /// Area. The interval contains the truth; its upper end is infinite if the area has no known bound.
    pub area_model: leafless_interval,
    /// Number of cell splits.
    pub splits: u64,
    /// The finest level of the visited cells.
    pub level: u32,
    /// The reason why the computation ended.
    pub measured: leafless_stop_reason,
    /// Whether the solid may extend beyond the universe, or does; then the area is that of the boundary
    /// inside.
    pub is_clipped: bool,
}

output!(leafless_surface_area);

impl From<SurfaceArea> for leafless_surface_area {
    fn from(surface: SurfaceArea) -> leafless_surface_area {
        leafless_surface_area {
            struct_size: size_of::<leafless_surface_area>() as u32,
            area_model: surface.area.into(),
            splits: surface.splits,
            level: surface.level.into(),
            measured: surface.stop_reason.into(),
            is_clipped: surface.clipped,
        }
    }
}

/// The area of a solid's section with a plane.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_section_area {
    /// sizeof(leafless_section_area).
    pub struct_size: u32,
    /// Area. The interval contains the truth.
    pub area_model: leafless_interval,
    /// The proofs about the solid; unproven tags count as undecided.
    pub proof: leafless_proof,
    /// Number of cell splits.
    pub splits: u64,
    /// The reason why the computation ended.
    pub measured: leafless_stop_reason,
    /// Whether the solid may extend beyond the universe, or does; then the area is that of the section
    /// inside.
    pub is_clipped: bool,
}

output!(leafless_section_area);

impl From<SectionArea> for leafless_section_area {
    fn from(section: SectionArea) -> leafless_section_area {
        leafless_section_area {
            struct_size: size_of::<leafless_section_area>() as u32,
            area_model: section.area.into(),
            proof: section.proof.into(),
            splits: section.splits,
            measured: section.stop_reason.into(),
            is_clipped: section.clipped,
        }
    }
}

/// Proven bounds of a solid's bounding box inside the universe.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_extent {
    /// sizeof(leafless_extent).
    pub struct_size: u32,
    /// Lower corner; intervals of all numbers if `is_empty`.
    pub min_model: [leafless_interval; 3],
    /// Upper corner; intervals of all numbers if `is_empty`.
    pub max_model: [leafless_interval; 3],
    /// The proofs about the solid; unproven tags count as undecided.
    pub proof: leafless_proof,
    /// Number of cell splits.
    pub splits: u64,
    /// The reason why the computation ended.
    pub measured: leafless_stop_reason,
    /// Whether the solid is proven to be empty.
    pub is_empty: bool,
    /// Whether the solid is proven not to be empty. If neither is proven, the corners bound the region that
    /// may be solid.
    pub is_occupied: bool,
    /// Whether the solid may extend beyond the universe, or does.
    pub is_clipped: bool,
}

output!(leafless_extent);

pub(super) fn row_by_row(tensor: [[Interval; 3]; 3]) -> [leafless_interval; 9] {
    core::array::from_fn(|k| tensor[k / 3][k % 3].into())
}

impl From<MassProperties> for leafless_measures {
    fn from(measures: MassProperties) -> leafless_measures {
        leafless_measures {
            struct_size: size_of::<leafless_measures>() as u32,
            volume_model: measures.volume.into(),
            centroid_model: measures.centroid.unwrap_or([Interval::ALL; 3]).map(Into::into),
            inertia_origin_model: row_by_row(measures.inertia_about_origin),
            inertia_centroid_model: row_by_row(measures.inertia_about_centroid),
            proof: measures.proof.into(),
            splits: measures.splits,
            level: measures.level.into(),
            measured: measures.stop_reason.into(),
            has_centroid: measures.centroid.is_some(),
            is_clipped: measures.clipped,
            is_exact: measures.exact,
        }
    }
}

impl From<Extent> for leafless_extent {
    fn from(extent: Extent) -> leafless_extent {
        let [min, max] = extent.corners.unwrap_or([[Interval::ALL; 3]; 2]);
        leafless_extent {
            struct_size: size_of::<leafless_extent>() as u32,
            min_model: min.map(Into::into),
            max_model: max.map(Into::into),
            proof: extent.proof.into(),
            splits: extent.splits,
            measured: extent.stop_reason.into(),
            is_empty: extent.corners.is_none(),
            is_occupied: extent.occupied,
            is_clipped: extent.clipped,
        }
    }
}

/// Measures a solid in the universe of a frame, without building an octree. The cells with the largest
/// uncertainty are split first, until the width of the volume's interval is at most `relative` times its
/// middle or at most `absolute_model` (cubic model units), until `max_splits` of the options is spent (2^26
/// splits if it is 0), or until no cell is left to split at the frame's depth. When the splits are spent, the
/// result is that of the last complete pass. The result is identical, bit for bit, for any number of threads.
///
/// - Buffers: `frame`, one struct; `options`, one struct or NULL (`max_nodes` and `max_bytes` are ignored);
///   `measures`, one struct.
/// - Result: `*measures`.
/// - Errors: LEAFLESS_E_ARGUMENT, also if a tolerance is negative or not a number; LEAFLESS_E_FRAME if the
///   solid belongs to another frame; LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_CANCELLED;
///   LEAFLESS_E_NO_MEMORY.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid; set `max_splits` if the depth or the solid is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_measure(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    relative: f64,
    absolute_model: f64,
    options: *const leafless_options,
    measures: *mut leafless_measures,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let measures = filled(measures, "measures")?;
        let tolerance = Tolerance { relative, absolute: absolute_model };
        measures.write(controlled(options, |control| measure(solid, &frame, tolerance, control))?.into())
    })
}

/// Computes the area of a solid's boundary in the universe of a frame, as leafless_solid_measure computes the
/// volume: `relative` and `absolute_model` (square model units) bound the width of the interval, and if
/// `max_splits` of the options is 0, the search ends after 2^23 splits. With N splits the width decreases as
/// 1/N on curved surfaces; plane faces are exact. If faces lie in planes of the frame's lattice, and the
/// solid ends inside the universe, another lattice is used. For an octree that keeps surfaces, an octree
/// without undecided cells, and an expression that is clipped, the faces between cells are added up. The area
/// of other octrees, of a host program's functions, and of a clipped mesh with such faces is not known.
///
/// - Buffers: as leafless_solid_measure; `surface`, one struct.
/// - Result: `*surface`.
/// - Errors: as leafless_solid_measure.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid; the default of `max_splits` bounds the work.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_surface_area(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    relative: f64,
    absolute_model: f64,
    options: *const leafless_options,
    surface: *mut leafless_surface_area,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let surface = filled(surface, "surface")?;
        let tolerance = Tolerance { relative, absolute: absolute_model };
        surface.write(controlled(options, |control| surface_area(solid, &frame, tolerance, control))?.into())
    })
}

/// Computes the area of a solid's section with a plane, in the universe of a frame. The plane goes through a
/// point, perpendicular to a normal of any length and either direction. The search splits only cells that the
/// plane crosses. It ends with LEAFLESS_STOP_REASON_TOLERANCE if the interval is no wider than `relative`
/// times its middle, or than `absolute_model` (square model units); with LEAFLESS_STOP_REASON_EXHAUSTED if no
/// cell is left whose split would help; with LEAFLESS_STOP_REASON_BUDGET after `max_splits` of the options,
/// or 2^20 splits if that is 0. With N splits the width decreases as 1/N² on curved surfaces of half-spaces
/// and expressions of them, and as 1/N for other solids; plane faces of expressions are exact up to rounding.
///
/// If faces of the solid lie in the plane, the sections on both sides of it differ. The section with a plane
/// perpendicular to an axis is the limit from above, or, in the universe's upper face, the limit from below.
/// If it is a plane of the lattice, the cells above it count, and faces in the plane cause no uncertainty.
/// For any other plane the interval contains the limits from both sides, and faces in the plane widen it.
///
/// - Buffers: as leafless_solid_measure; `point_model` and `normal`, 3 numbers each; `section`, one struct.
/// - Result: `*section`.
/// - Errors: as leafless_solid_measure, and LEAFLESS_E_ARGUMENT also if the normal is zero, or a number of
///   point or normal is neither 0 nor of a magnitude between 2^-256 and 2^256.
/// - Threads: any; works in the calling thread.
/// - Untrusted input: any solid, any numbers; the default of `max_splits` bounds the work.
///
/// cbindgen:ptrs-as-arrays=[[point_model; 3], [normal; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_section_area(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    point_model: *const f64,
    normal: *const f64,
    relative: f64,
    absolute_model: f64,
    options: *const leafless_options,
    section: *mut leafless_section_area,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let plane = SectionPlane::new(array(point_model, "point_model")?, array(normal, "normal")?)?;
        let section = filled(section, "section")?;
        let tolerance = Tolerance { relative, absolute: absolute_model };
        let found = controlled(options, |control| section_area(solid, &frame, &plane, tolerance, control))?;
        section.write(found.into())
    })
}

/// Computes the bounding box of a solid in the universe of a frame: six intervals, one for each side. The
/// search splits only cells that may reach beyond the proven part of the solid. It ends with
/// LEAFLESS_STOP_REASON_TOLERANCE if no interval is wider than `tolerance_model`, or than 2^-44 of the
/// universe's edge; with LEAFLESS_STOP_REASON_EXHAUSTED if the outermost undecided cells cannot be split, and
/// either the interval is no wider than one of the frame's finest cells, or nothing else is left to split;
/// with LEAFLESS_STOP_REASON_BUDGET after `max_splits` of the options, or 2^20 splits if that is 0.
///
/// For half-spaces and expressions of them, a corner of three plane faces is exact up to rounding, and a
/// curved side is known to some 10^-12 of the universe's edge at depth 20, after some hundred splits; a side
/// that a cylinder touches along a line takes more. For other solids, with n the universe's edge divided by
/// the tolerance, a curved side takes some n splits; a flat side takes n² splits, unless it lies on a plane
/// of the lattice.
///
/// - Buffers: as leafless_solid_measure; `extent`, one struct.
/// - Result: `*extent`.
/// - Errors: as leafless_solid_measure, with `tolerance_model` for its tolerances.
/// - Untrusted input: any solid; the default of `max_splits` bounds the work.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_bounding_box(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    tolerance_model: f64,
    options: *const leafless_options,
    extent: *mut leafless_extent,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let extent = filled(extent, "extent")?;
        let found = controlled(options, |control| bounding_box(solid, &frame, tolerance_model, control))?;
        extent.write(found.into())
    })
}
