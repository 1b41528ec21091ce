//! The layout of the header's structs and constants as the library sees it, for tests.

use super::*;
use core::ffi::c_char;
use core::fmt::{self, Write};
use core::mem::{offset_of, size_of};

/// Returns the size of a field.
const fn size_at<S, F>(_: fn(&S) -> &F) -> usize {
    size_of::<F>()
}

macro_rules! structs {
    ($to:ident; $($name:ident { $($field:ident),* })*) => {
        $(
            writeln!($to, "{} {}", stringify!($name), size_of::<$name>())?;
            $(writeln!(
                $to,
                "{}.{} {} {}",
                stringify!($name),
                stringify!($field),
                offset_of!($name, $field),
                size_at(|all: &$name| &all.$field)
            )?;)*
        )*
    };
}

macro_rules! values {
    ($to:ident; $($name:ident { $($value:ident),* })*) => {
        $($(writeln!($to, "{} {}", stringify!($value), $name::$value as i64)?;)*)*
    };
}

fn write_all(to: &mut dyn Write) -> fmt::Result {
    structs! { to;
        leafless_options { struct_size, threads, max_nodes, max_bytes, max_splits, progress, progress_ctx, control }
        leafless_frame { origin, edge, depth }
        leafless_interval { lower, upper }
        leafless_source { struct_size, access, path, path_length, bytes, length }
        leafless_sink {
            struct_size, reserved, path, path_length, write, write_ctx, bytes, capacity, length
        }
        leafless_cells_in { full_least, full_most, upper_least, upper_most }
        leafless_mesh_info { struct_size, attributes, vertices, triangles, bytes, deviation_model, displacement_model }
        leafless_mesh_report { struct_size,
            facets_read, triangles, vertices, welded, degenerate, boundary_edges, boundary_loops, misoriented_edges,
            non_manifold_edges, duplicate, opposite, flat, bodies, open_bodies, inside_out_bodies, sewn,
            displacement_model, overlapping_bodies, undecided_bodies, polygons, bent_polygons, polygon_deviation_model,
            edges, euler_characteristic, is_closed, is_manifold
        }
        leafless_mesh_defect { min_model, max_model, length_model, count, kind }
        leafless_mesh_arrays {
            struct_size, vertex_type, vertices, vertex_count, vertex_stride, indices, triangle_count,
            triangle_stride, index_type, scale
        }
        leafless_polyhedron_arrays {
            struct_size, vertex_type, vertices, vertex_count, vertex_stride, corners, corner_count, loops, loop_count,
            faces, face_count, shells, shell_count, solids, solid_count, index_type, scale, tolerance_model
        }
        leafless_mesh_moments { struct_size,
            volume_model, centroid_model, inertia_origin_model, inertia_centroid_model, triangles, known, has_centroid
        }
        leafless_intersecting_pair { min_model, max_model, triangles }
        leafless_mesh_options { struct_size, format, unit, target, scale }
        leafless_mesh_file_info { struct_size, format, unit, skipped, deviation_model }
        leafless_mesh_write_options { struct_size, format, is_text, unit, has_normals, deviation_model }
        leafless_volume_layout {
            struct_size, sample_type, extents, byte_order, skip, corner_model, spacing_model
        }
        leafless_volume_info { struct_size,
            extents, sample_type, file_type, format, unit, is_placed, sample_count, rounded, default_threshold,
            corner_model, spacing_model, placement, bytes
        }
        leafless_voxel_options {
            struct_size, boundary_depth, boundary, lists, coarse_model, fine_model, tolerance, attribute,
            criterion, reserved
        }
        leafless_surface_options { struct_size, method, snap, resolve, placement, reserved, source }
        leafless_camera { eye_model, at_model, up, field_of_view_degrees, height_model }
        leafless_transfer { struct_size, map, range_lower, range_upper, alpha_lower, alpha_upper, length_model }
        leafless_look {
            struct_size, faces, colour, inside, edges, edge_colour, edge_width, crease_degrees, triangle_colours,
            triangle_count, attribute, transfer
        }
        leafless_slice_look {
            struct_size, is_plain, empty_colour, full_colour, partial_colour, outline_colour, attribute, transfer
        }
        leafless_voxel_arrays { struct_size, components, lattice, count, codes, levels, kinds, values, weights }
        leafless_shot {
            struct_size, width, height, samples, camera, clip_planes, clip_plane_count, clip_box_model, background, reserved
        }
        leafless_legend_box { left, top, width, height }
        leafless_legend_name { name, name_length, colour, reserved }
        leafless_solid_callbacks {
            struct_size, exterior, classify, contains, destroy, ctx, fingerprint, classify_many, contains_many, distance_many,
            gradient, tangent, bounds
        }
        leafless_gradient { value, gradient }
        leafless_tangent { point, normal, inner_curvature, outer_curvature, error }
        leafless_solid_function { struct_size, reserved, value, range, destroy, ctx, fingerprint }
        leafless_value_range { values, kind }
        leafless_attribute_callbacks { struct_size, components, value, values, range, destroy, ctx }
        leafless_solid_info { struct_size, evaluations, bytes }
        leafless_attribute_info { struct_size, components, bytes }
        leafless_channel_info { struct_size, frame, scalar, components, value_count, elements, bytes }
        leafless_channel_fill_options {
            struct_size, scalar, components, depth, solid, criterion, reserved, coarse_model, fine_model, tolerance, name,
            name_length
        }
        leafless_channel_summary { struct_size,
            least, greatest, integral, mean, volume_model, volume_without_model, has_values
        }
        leafless_material { value, measures }
        leafless_carry_rule { name, name_length, carry }
        leafless_proof { displacement_model, full, empty }
        leafless_cut_options { struct_size, tolerance_model }
        leafless_cut_counts { struct_size, surfaces, cells, given_up, splits, bytes }
        leafless_stored_surface_info { struct_size,
            kind, number_count, placement_count, terms, term_count, has_origin, origin_number, origin
        }
        leafless_cell_function { surfaces, surface_count, table }
        leafless_shard { code, level, kind }
        leafless_octree_info { struct_size,
            frame, elements, bricks, channels, bytes, proof, root, exterior, is_binary, is_clipped
        }
        leafless_statistics { nodes, empty, full, partial, lower_cells, upper_cells, volume_model }
        leafless_zone { struct_size, kind, min_model, max_model, point_model, direction_model, from, to }
        leafless_lazy_info { struct_size, frame, statistics, splits, replays, bytes }
        leafless_interference {
            volume_model, proof_a, proof_b, splits_a, splits_b, verdict, level,
            ball_centre_model, ball_radius_model, witness, witness_level, is_clipped
        }
        leafless_gap { struct_size,
            verdict, distance_model, point_a_model, point_b_model, splits_a, splits_b, measured, has_points, is_clipped
        }
        leafless_placed_gap {
            distance_model, point_a_model, point_b_model, splits_a, splits_b, verdict, measured, has_points, is_clipped
        }
        leafless_placed_clearance {
            distance_model, point_a_model, point_b_model, depth_model, splits_a, splits_b, measured, has_points, is_clipped
        }
        leafless_clearance { struct_size,
            distance_model, point_a_model, point_b_model, normal_a, normal_b, depth_model, proof_a, proof_b, splits_a, splits_b, nearest_a, nearest_a_level, nearest_b, nearest_b_level,
            measured, has_nearest, is_clipped
        }
        leafless_one_way { distance_model, point_model, apart_model, nearest_model, has_witness }
        leafless_deviation { struct_size,
            distance_model, a_to_b, b_to_a, proof_a, proof_b, splits_a, splits_b, cuts_a, cuts_b, verdict, measured,
            is_clipped_a, is_clipped_b
        }
        leafless_item_options { struct_size, orientations, density, matrices, matrix_count, free_count, reserved }
        leafless_placement { item, matrix }
        leafless_neighbour { gap_model, number, beside, verdict }
        leafless_standing { struct_size, verdict, conflict_count, splits, nearest, has_nearest }
        leafless_placed_standing { conflict_count, splits, verdict }
        leafless_search_options {
            struct_size, objective, target_model, seed, max_tests, rounds, cells, free_along, reserved
        }
        leafless_search_report { struct_size, end, placed, left, rounds, tests, splits }
        leafless_layout_measures { struct_size,
            volume_model, filled_part, height_model, mass, centroid_model, inertia_origin_model, inertia_centroid_model,
            has_centroid
        }
        leafless_measures { struct_size,
            volume_model, centroid_model, inertia_origin_model, inertia_centroid_model, proof, splits, level,
            measured, has_centroid, is_clipped, is_exact
        }
        leafless_mass_sum { struct_size, bytes }
        leafless_surface_area { struct_size, area_model, splits, level, measured, is_clipped }
        leafless_boundary_report {
            struct_size, deviation_model, intersecting_pairs, cells, splits, surfaces, regions, faces
        }
        leafless_single_precision { struct_size, reserved,
            rounding_model, deviation_model, collapsed, flipped, moved, degenerate, intersecting_pairs
        }
        leafless_simplified { struct_size, deviation_model, removed, intersecting_pairs }
        leafless_boundary_surface {
            kind, reserved, point_model, direction, offset_model, radius_model, minor_model, half_angle_radians,
            coefficients
        }
        leafless_boundary_region { surface, first_face, face_count, triangle_count, area_model, is_turned }
        leafless_contour_report { struct_size, deviation_model, intersecting_pairs, cells, splits, undecided }
        leafless_section_area { struct_size, area_model, proof, splits, measured, is_clipped }
        leafless_extent { struct_size,
            min_model, max_model, proof, splits, measured, is_empty, is_occupied, is_clipped
        }
        leafless_point_distance { distance_model, splits, nearest_model, surface, measured, has_nearest }
        leafless_near_cell { point_model, distance_model, found }
        leafless_cursor_info { struct_size, cell, level, tag, children }
        leafless_ray { origin_model, direction_model, t_last }
        leafless_ray_hit { t, normal, cell, level, surface, is_hit }
        leafless_run { start, length }
        leafless_cell { cell, level, tag }
        leafless_boundary_face { inner, outer, axis, is_upper, has_outer }
        leafless_file_info { struct_size,
            major, minor, frame, elements, bricks, file_length, sections, proof, root, exterior, is_binary, tridexel
        }
        leafless_tridexel_format { struct_size, directions, ends, normals, has_surfaces, has_materials }
        leafless_tridexel_info { struct_size,
            frame, directions, ends, normals, has_surfaces, has_materials, bytes_per_interval, interval_count, bytes
        }
        leafless_dexel_end { at_model, at_cells, normal, surface }
        leafless_dexel { start, end, material }
        leafless_dexel_change { struct_size, rays, removed_model, added_model, min_cell, max_cell }
        leafless_tridexel_arrays {
            axis, reserved, first, end, offsets, interval_count, ends_model, normals, surfaces, materials, ends_cells
        }
        leafless_dexel_surface_report { struct_size,
            crossings, several, without_rays, disagreeing, without_normals, means, clamped, vanished, without_centres
        }
        leafless_long_voxel { first, length, material, colour, kind }
        leafless_file_tridexel_info { directions, ends, normals, has_surfaces, has_materials, reserved, rays, intervals }
        leafless_dexel_statistics { struct_size, rays, intervals, bytes, volume_model, min_model, max_model }
        leafless_scene_options { struct_size, facets, folder, folder_length }
        leafless_scene_info { struct_size, polygons, exact, ignored_slices, meshes, is_empty }
        leafless_scene_mesh_info { struct_size, line, column, turned }
        leafless_file_section { kind, owner, is_required, name, offset, length, count }
    }
    values! { to;
        leafless_access { LEAFLESS_ACCESS_COPY, LEAFLESS_ACCESS_MAP, LEAFLESS_ACCESS_MAP_VERIFIED }
        leafless_status {
            LEAFLESS_OK, LEAFLESS_E_NULL, LEAFLESS_E_ARGUMENT, LEAFLESS_E_UTF8, LEAFLESS_E_BUFFER,
            LEAFLESS_E_FRAME, LEAFLESS_E_NOT_SAMPLED, LEAFLESS_E_MESH, LEAFLESS_E_MESH_FILE,
            LEAFLESS_E_FORMAT, LEAFLESS_E_VERSION, LEAFLESS_E_DAMAGED, LEAFLESS_E_LIMIT,
            LEAFLESS_E_NO_MEMORY, LEAFLESS_E_CANCELLED, LEAFLESS_E_CALLBACK, LEAFLESS_E_IO, LEAFLESS_E_PANIC,
            LEAFLESS_E_SOURCE, LEAFLESS_E_SCENE, LEAFLESS_E_BUSY, LEAFLESS_E_VOLUME_FILE
        }
        leafless_tag { LEAFLESS_TAG_EMPTY, LEAFLESS_TAG_BRANCH, LEAFLESS_TAG_PARTIAL, LEAFLESS_TAG_FULL }
        leafless_tags {
            LEAFLESS_TAGS_EMPTY, LEAFLESS_TAGS_BRANCH, LEAFLESS_TAGS_PARTIAL, LEAFLESS_TAGS_FULL,
            LEAFLESS_TAGS_LEAVES
        }
        leafless_membership { LEAFLESS_MEMBERSHIP_OUTSIDE, LEAFLESS_MEMBERSHIP_INSIDE, LEAFLESS_MEMBERSHIP_UNDECIDED }
        leafless_region {
            LEAFLESS_REGION_OUTSIDE, LEAFLESS_REGION_INSIDE, LEAFLESS_REGION_CROSSING,
            LEAFLESS_REGION_UNDECIDED
        }
        leafless_obstacle { LEAFLESS_OBSTACLE_FULL, LEAFLESS_OBSTACLE_UPPER }
        leafless_side { LEAFLESS_SIDE_ABOVE, LEAFLESS_SIDE_BELOW }
        leafless_sight { LEAFLESS_SIGHT_CLEAR, LEAFLESS_SIGHT_BLOCKED, LEAFLESS_SIGHT_UNDECIDED }
        leafless_stored_surface_kind {
            LEAFLESS_STORED_SURFACE_KIND_PLANE, LEAFLESS_STORED_SURFACE_KIND_QUADRIC, LEAFLESS_STORED_SURFACE_KIND_POWERS,
            LEAFLESS_STORED_SURFACE_KIND_TORUS, LEAFLESS_STORED_SURFACE_KIND_SLAB
        }
        leafless_shard_kind { LEAFLESS_SHARD_KIND_TOP, LEAFLESS_SHARD_KIND_BELOW }
        leafless_proven {
            LEAFLESS_PROVEN_NOTHING, LEAFLESS_PROVEN_FULL, LEAFLESS_PROVEN_EMPTY, LEAFLESS_PROVEN_BOTH
        }
        leafless_touch { LEAFLESS_TOUCH_EXACT, LEAFLESS_TOUCH_PAPER }
        leafless_motion { LEAFLESS_MOTION_EXACT, LEAFLESS_MOTION_VERTICES, LEAFLESS_MOTION_CONSERVATIVE }
        leafless_zone_kind {
            LEAFLESS_ZONE_KIND_EVERYTHING, LEAFLESS_ZONE_KIND_BOX, LEAFLESS_ZONE_KIND_POINT, LEAFLESS_ZONE_KIND_RAY
        }
        leafless_within { LEAFLESS_WITHIN_YES, LEAFLESS_WITHIN_NO, LEAFLESS_WITHIN_UNDECIDED }
        leafless_overlap { LEAFLESS_OVERLAP_DISJOINT, LEAFLESS_OVERLAP_OVERLAPPING, LEAFLESS_OVERLAP_UNDECIDED }
        leafless_gap_verdict { LEAFLESS_GAP_VERDICT_YES, LEAFLESS_GAP_VERDICT_NO, LEAFLESS_GAP_VERDICT_UNDECIDED }
        leafless_orientations {
            LEAFLESS_ORIENTATIONS_TURNS, LEAFLESS_ORIENTATIONS_AS_GIVEN, LEAFLESS_ORIENTATIONS_FREE,
            LEAFLESS_ORIENTATIONS_LIST
        }
        leafless_beside { LEAFLESS_BESIDE_WALL, LEAFLESS_BESIDE_OBSTACLE, LEAFLESS_BESIDE_PLACED }
        leafless_objective {
            LEAFLESS_OBJECTIVE_COUNT, LEAFLESS_OBJECTIVE_HEIGHT, LEAFLESS_OBJECTIVE_DENSITY, LEAFLESS_OBJECTIVE_BALANCE
        }
        leafless_free_along {
            LEAFLESS_FREE_ALONG_NONE, LEAFLESS_FREE_ALONG_X_UP, LEAFLESS_FREE_ALONG_X_DOWN, LEAFLESS_FREE_ALONG_Y_UP,
            LEAFLESS_FREE_ALONG_Y_DOWN, LEAFLESS_FREE_ALONG_Z_UP, LEAFLESS_FREE_ALONG_Z_DOWN
        }
        leafless_search_end {
            LEAFLESS_SEARCH_END_COMPLETE, LEAFLESS_SEARCH_END_ROUNDS, LEAFLESS_SEARCH_END_BUDGET,
            LEAFLESS_SEARCH_END_CANCELLED
        }
        leafless_stop_reason {
            LEAFLESS_STOP_REASON_TOLERANCE, LEAFLESS_STOP_REASON_BUDGET, LEAFLESS_STOP_REASON_EXHAUSTED
        }
        leafless_distance_to {
            LEAFLESS_DISTANCE_TO_SOLID, LEAFLESS_DISTANCE_TO_COMPLEMENT, LEAFLESS_DISTANCE_TO_BOUNDARY
        }
        leafless_moments_verdict {
            LEAFLESS_MOMENTS_VERDICT_KNOWN, LEAFLESS_MOMENTS_VERDICT_OPEN, LEAFLESS_MOMENTS_VERDICT_INTERSECTING, LEAFLESS_MOMENTS_VERDICT_UNDECIDED
        }
        leafless_fill { LEAFLESS_FILL_NON_ZERO, LEAFLESS_FILL_EVEN_ODD, LEAFLESS_FILL_POSITIVE }
        leafless_vertex_type { LEAFLESS_VERTEX_TYPE_F64, LEAFLESS_VERTEX_TYPE_F32 }
        leafless_index_type { LEAFLESS_INDEX_TYPE_U32, LEAFLESS_INDEX_TYPE_U64, LEAFLESS_INDEX_TYPE_U16 }
        leafless_mesh_format {
            LEAFLESS_MESH_FORMAT_ANY, LEAFLESS_MESH_FORMAT_STL, LEAFLESS_MESH_FORMAT_OBJ,
            LEAFLESS_MESH_FORMAT_PLY, LEAFLESS_MESH_FORMAT_OFF, LEAFLESS_MESH_FORMAT_3MF
        }
        leafless_unit {
            LEAFLESS_UNIT_UNKNOWN, LEAFLESS_UNIT_MICROMETRE, LEAFLESS_UNIT_MILLIMETRE,
            LEAFLESS_UNIT_CENTIMETRE, LEAFLESS_UNIT_METRE, LEAFLESS_UNIT_INCH, LEAFLESS_UNIT_FOOT
        }
        leafless_sample_type {
            LEAFLESS_SAMPLE_TYPE_U8, LEAFLESS_SAMPLE_TYPE_U16, LEAFLESS_SAMPLE_TYPE_I16, LEAFLESS_SAMPLE_TYPE_F32, LEAFLESS_SAMPLE_TYPE_BITS,
            LEAFLESS_SAMPLE_TYPE_BITS_IN_BYTES, LEAFLESS_SAMPLE_TYPE_I8, LEAFLESS_SAMPLE_TYPE_I32, LEAFLESS_SAMPLE_TYPE_U32,
            LEAFLESS_SAMPLE_TYPE_I64, LEAFLESS_SAMPLE_TYPE_U64, LEAFLESS_SAMPLE_TYPE_F64
        }
        leafless_byte_order { LEAFLESS_BYTE_ORDER_NATIVE, LEAFLESS_BYTE_ORDER_LITTLE, LEAFLESS_BYTE_ORDER_BIG }
        leafless_volume_format {
            LEAFLESS_VOLUME_FORMAT_RAW, LEAFLESS_VOLUME_FORMAT_NRRD, LEAFLESS_VOLUME_FORMAT_METAIMAGE,
            LEAFLESS_VOLUME_FORMAT_NRRD_GZIP
        }
        leafless_surface_method {
            LEAFLESS_SURFACE_METHOD_MARCHING_CUBES, LEAFLESS_SURFACE_METHOD_SIMPLE_MARCHING_CUBES, LEAFLESS_SURFACE_METHOD_SHRINK,
            LEAFLESS_SURFACE_METHOD_SHRINK_PUBLISHED, LEAFLESS_SURFACE_METHOD_DUAL_CONTOURING,
            LEAFLESS_SURFACE_METHOD_SURFACE_NETS
        }
        leafless_snap { LEAFLESS_SNAP_FAT, LEAFLESS_SNAP_THIN }
        leafless_resolve {
            LEAFLESS_RESOLVE_NONE, LEAFLESS_RESOLVE_INNER, LEAFLESS_RESOLVE_OUTER, LEAFLESS_RESOLVE_SOURCE
        }
        leafless_colour_map {
            LEAFLESS_COLOUR_MAP_VIRIDIS, LEAFLESS_COLOUR_MAP_CIVIDIS, LEAFLESS_COLOUR_MAP_INFERNO, LEAFLESS_COLOUR_MAP_MAGMA,
            LEAFLESS_COLOUR_MAP_PLASMA, LEAFLESS_COLOUR_MAP_GREY
        }
        leafless_edges { LEAFLESS_EDGES_NONE, LEAFLESS_EDGES_FEATURES, LEAFLESS_EDGES_ALL }
        leafless_legend_side { LEAFLESS_LEGEND_SIDE_RIGHT, LEAFLESS_LEGEND_SIDE_BOTTOM }
        leafless_vertex_placement { LEAFLESS_VERTEX_PLACEMENT_MIDPOINT, LEAFLESS_VERTEX_PLACEMENT_CROSSING }
        leafless_voxel_kind {
            LEAFLESS_VOXEL_KIND_OUTSIDE, LEAFLESS_VOXEL_KIND_INSIDE, LEAFLESS_VOXEL_KIND_BOUNDARY, LEAFLESS_VOXEL_KIND_REFINED
        }
        leafless_voxel_boundary { LEAFLESS_VOXEL_BOUNDARY_CUT, LEAFLESS_VOXEL_BOUNDARY_TOUCHING }
        leafless_voxel_lists { LEAFLESS_VOXEL_LISTS_OUTSIDE, LEAFLESS_VOXEL_LISTS_REFINED }
        leafless_defect {
            LEAFLESS_DEFECT_HOLE, LEAFLESS_DEFECT_MISORIENTED, LEAFLESS_DEFECT_DUPLICATE,
            LEAFLESS_DEFECT_NON_MANIFOLD, LEAFLESS_DEFECT_FLAT
        }
        leafless_rule {
            LEAFLESS_RULE_CERTIFIED, LEAFLESS_RULE_SAMPLED, LEAFLESS_RULE_INNER, LEAFLESS_RULE_OUTER
        }
        leafless_operation {
            LEAFLESS_OPERATION_UNION, LEAFLESS_OPERATION_INTERSECTION, LEAFLESS_OPERATION_DIFFERENCE, LEAFLESS_OPERATION_XOR
        }
        leafless_surface_kind {
            LEAFLESS_SURFACE_KIND_OTHER, LEAFLESS_SURFACE_KIND_PLANE, LEAFLESS_SURFACE_KIND_BALL,
            LEAFLESS_SURFACE_KIND_CYLINDER, LEAFLESS_SURFACE_KIND_CONE, LEAFLESS_SURFACE_KIND_TORUS,
            LEAFLESS_SURFACE_KIND_QUADRIC
        }
        leafless_facets { LEAFLESS_FACETS_AUTO, LEAFLESS_FACETS_EXACT, LEAFLESS_FACETS_POLYGON }
        leafless_range_kind { LEAFLESS_RANGE_KIND_UNKNOWN, LEAFLESS_RANGE_KIND_NOWHERE, LEAFLESS_RANGE_KIND_WITHIN }
        leafless_scalar_type {
            LEAFLESS_SCALAR_TYPE_F32, LEAFLESS_SCALAR_TYPE_U8, LEAFLESS_SCALAR_TYPE_U16, LEAFLESS_SCALAR_TYPE_U32
        }
        leafless_criterion {
            LEAFLESS_CRITERION_NONE, LEAFLESS_CRITERION_VARIANCE, LEAFLESS_CRITERION_RANGE
        }
        leafless_interpolation { LEAFLESS_INTERPOLATION_TRILINEAR, LEAFLESS_INTERPOLATION_NEAREST }
        leafless_carry { LEAFLESS_CARRY_LEFT, LEAFLESS_CARRY_RIGHT, LEAFLESS_CARRY_MAX, LEAFLESS_CARRY_MEAN }
        leafless_axes { LEAFLESS_AXES_X, LEAFLESS_AXES_Y, LEAFLESS_AXES_Z, LEAFLESS_AXES_ALL }
        leafless_dexel_ends { LEAFLESS_DEXEL_ENDS_FIXED, LEAFLESS_DEXEL_ENDS_DOUBLE }
        leafless_dexel_normals { LEAFLESS_DEXEL_NORMALS_NONE, LEAFLESS_DEXEL_NORMALS_16, LEAFLESS_DEXEL_NORMALS_32 }
        leafless_dexel_surface_method {
            LEAFLESS_DEXEL_SURFACE_METHOD_MARCHING_CUBES, LEAFLESS_DEXEL_SURFACE_METHOD_DUAL_CONTOURING
        }
        leafless_exterior { LEAFLESS_EXTERIOR_UNKNOWN, LEAFLESS_EXTERIOR_EMPTY, LEAFLESS_EXTERIOR_FULL }
    }
    writeln!(to, "LEAFLESS_VERSION_MAJOR {LEAFLESS_VERSION_MAJOR}")?;
    writeln!(to, "LEAFLESS_VERSION_MINOR {LEAFLESS_VERSION_MINOR}")?;
    writeln!(to, "LEAFLESS_VERSION_PATCH {LEAFLESS_VERSION_PATCH}")?;
    writeln!(to, "LEAFLESS_FORMAT_MAJOR {LEAFLESS_FORMAT_MAJOR}")?;
    writeln!(to, "LEAFLESS_FORMAT_MINOR {LEAFLESS_FORMAT_MINOR}")?;
    writeln!(to, "LEAFLESS_ABI {LEAFLESS_ABI}")
}

/// Returns the library's layout of structs and constants, to be compared with that of a C compiler. It exists
/// only in libraries that are built for tests. One line for each struct with its size, for each field with
/// its offset and size, and for each constant with its value.
///
/// - Buffers: `text`, `capacity` bytes; may be NULL if `capacity` is 0.
/// - Result: the text's length in bytes, without the terminating NUL, also if the buffer is too small. The
///   text in the buffer is NUL-terminated.
/// - Ownership: the text is copied.
#[cfg(feature = "test")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_test_layout(text: *mut c_char, capacity: usize) -> usize {
    let mut all = std::string::String::new();
    // Writing to a string cannot fail.
    let _ = write_all(&mut all);
    if !text.is_null() && capacity > 0 {
        let length = all.len().min(capacity - 1);
        // SAFETY: the caller has `capacity` bytes there; all of the text is ASCII.
        unsafe {
            core::ptr::copy_nonoverlapping(all.as_ptr(), text.cast(), length);
            text.add(length).write(0);
        }
    }
    all.len()
}
