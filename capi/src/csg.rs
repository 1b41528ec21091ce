//! Constructive solid geometry: half-spaces, primitives and set operations on solids.

use super::boundary::{Failure, array, guard, out, shared, slice};
use super::number::{Number, enumeration};
use super::operation::{leafless_operation, leafless_operation::*, operands};
use super::solid::{give, give_any, leafless_solid};
use super::status::leafless_status;
use leafless::Affine;
use leafless::Error;
use leafless::memory;
use leafless::solid::{Adaptive, HalfSpace, Motion, Touch};
use leafless::{AnySolid, Csg, Solid};

/// The rule of touching: whether a cell that meets the boundary of an expression of half-spaces, but not its
/// interior, is EMPTY.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_touch {
    /// Contact is not overlap: a cell is EMPTY if the interiors are disjoint.
    LEAFLESS_TOUCH_EXACT = 0,
    /// A vertex on the surface counts as inside, so that a cell that touches a primitive with a vertex from
    /// outside is PARTIAL. This rule reproduces published tables and has no other advantage.
    LEAFLESS_TOUCH_PAPER = 1,
}

enumeration! {
    leafless_touch => Touch {
        LEAFLESS_TOUCH_EXACT => Touch::Exact,
        LEAFLESS_TOUCH_PAPER => Touch::Paper,
    }
}

/// Returns a solid as an expression.
fn expression(solid: &leafless_solid) -> Csg {
    Csg::solid(solid.solid.solid().clone())
}

/// Returns the affine map of twelve numbers.
///
/// # Safety
/// As [`array`].
pub(super) unsafe fn placement(matrix: *const f64) -> Result<Affine, Failure> {
    // SAFETY: as the caller promises.
    let m: [f64; 12] = unsafe { array(matrix, "matrix")? };
    Ok(Affine::new([0, 4, 8].map(|row| [m[row], m[row + 1], m[row + 2], m[row + 3]]))?)
}

/// Returns a solid under the map with these rows, or unmoved if `matrix` is NULL.
///
/// # Safety
/// `matrix` is NULL, or as for [`array`].
unsafe fn moved(solid: Csg, matrix: *const f64) -> Result<Csg, Failure> {
    if matrix.is_null() {
        return Ok(solid);
    }
    // SAFETY: the caller's promise.
    let placement = unsafe { placement(matrix)? };
    Ok(solid.placed(&placement)?)
}

/// Makes the ball of all points at most `radius` from `centre`. Its verdicts are exact.
///
/// - Buffers: `centre_model`, 3 numbers; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the radius is not between 2^-256 and 2^256, or a coordinate neither 0 nor
///   of such a magnitude.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[centre_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_ball(
    centre_model: *const f64,
    radius_model: f64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let centre = array(centre_model, "centre_model")?;
        let solid = out(solid, "solid")?;
        solid.write(give(Csg::ball(centre, radius_model)?))
    })
}

/// Makes the box [min, max] with faces parallel to the lattice. Its verdicts are exact, so a face on a
/// lattice plane leaves nothing undecided.
///
/// - Buffers: `min_model` and `max_model`, 3 numbers each; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if min ≥ max on an axis, or a coordinate is neither 0 nor of a magnitude
///   between 2^-256 and 2^256.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[min_model; 3], [max_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_box(
    min_model: *const f64,
    max_model: *const f64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let (min, max) = (array(min_model, "min_model")?, array(max_model, "max_model")?);
        let solid = out(solid, "solid")?;
        solid.write(give(Csg::cuboid(min, max)?))
    })
}

/// Makes the half-space of the points p with normal · p + offset ≥ 0. Its verdicts are exact.
///
/// - Buffers: `normal`, 3 numbers, of any length and pointing into the solid; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the normal is zero, or a coefficient neither 0 nor of a magnitude between
///   2^-256 and 2^256.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[normal; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_halfspace(
    normal: *const f64,
    offset: f64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let normal = array(normal, "normal")?;
        let solid = out(solid, "solid")?;
        solid.write(give(Csg::half_space(normal, offset)?))
    })
}

/// Makes the quadric of the points p with a x² + b y² + c z² + d xy + e yz + f zx + g x + h y + i z + j ≥ 0.
/// The ten coefficients are a to j. Its signs are exact.
///
/// - Buffers: `coefficients`, 10 numbers; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if all coefficients but the last are 0, or one is neither 0 nor of a
///   magnitude between 2^-256 and 2^256.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[coefficients; 10]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_quadric(
    coefficients: *const f64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let coefficients = array(coefficients, "coefficients")?;
        let solid = out(solid, "solid")?;
        solid.write(give(Csg::from(HalfSpace::quadric(coefficients)?)))
    })
}

/// Makes the ellipsoid around `centre` with the semi-axes `radii` along x, y and z, moved by `matrix` unless
/// that is NULL. The surface has exact coefficients. Its verdicts are exact, too, unless `matrix` rotates it.
///
/// - Buffers: `centre_model` and `radii_model`, 3 numbers each; `matrix`, 12 numbers as for
///   leafless_solid_placed, or NULL; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if a radius is not between 2^-256 and 2^256, or a coordinate neither 0 nor
///   of such a magnitude; for `matrix` as leafless_solid_placed.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[centre_model; 3], [radii_model; 3], [matrix; 12]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_ellipsoid(
    centre_model: *const f64,
    radii_model: *const f64,
    matrix: *const f64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let (centre, radii) = (array(centre_model, "centre_model")?, array(radii_model, "radii_model")?);
        let solid = out(solid, "solid")?;
        solid.write(give(moved(Csg::ellipsoid(centre, radii)?, matrix)?))
    })
}

/// Makes the cylinder of `radius` around the segment between two points, with flat ends through the points.
/// The axis may have any direction. Nothing is rounded: the surface has exact coefficients. If the axis is
/// parallel to x, y or z, the verdicts are exact, too.
///
/// - Buffers: `from_model` and `to_model`, 3 numbers each; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the points are equal, the radius is not between 2^-256 and 2^256, or a
///   coordinate neither 0 nor of such a magnitude.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[from_model; 3], [to_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_cylinder(
    from_model: *const f64,
    to_model: *const f64,
    radius_model: f64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let (from, to) = (array(from_model, "from_model")?, array(to_model, "to_model")?);
        let solid = out(solid, "solid")?;
        solid.write(give(Csg::cylinder_between(from, to, radius_model)?))
    })
}

/// Makes the frustum of a cone around the segment between two points, with the radius `from_radius` at `from`
/// and `to_radius` at `to`. One of the radii may be 0, which makes a cone. It is as exact as
/// leafless_solid_new_cylinder.
///
/// - Buffers: `from_model` and `to_model`, 3 numbers each; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the points are equal, if both radii are 0 or one is not between 2^-256
///   and 2^256, or a coordinate neither 0 nor of such a magnitude.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[from_model; 3], [to_model; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_frustum(
    from_model: *const f64,
    to_model: *const f64,
    from_radius_model: f64,
    to_radius_model: f64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let (from, to) = (array(from_model, "from_model")?, array(to_model, "to_model")?);
        let solid = out(solid, "solid")?;
        solid.write(give(Csg::frustum_between(from, to, [from_radius_model, to_radius_model])?))
    })
}

/// Makes the solid of the points p with A (x − a)^n + B (y − b)^m + C (z − c)^k + `constant` ≥ 0. Its signs
/// are exact.
///
/// - Buffers: `coefficients` A, B, C, `centre_model` a, b, c, and `exponents` n, m, k, 3 numbers each;
///   `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if all coefficients are 0, an exponent is not 1 to 64, or a number neither 0
///   nor of a magnitude between 2^-256 and 2^256.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[coefficients; 3], [centre_model; 3], [exponents; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_power(
    coefficients: *const f64,
    centre_model: *const f64,
    exponents: *const u32,
    constant: f64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let coefficients: [f64; 3] = array(coefficients, "coefficients")?;
        let centre: [f64; 3] = array(centre_model, "centre_model")?;
        let exponents: [u32; 3] = array(exponents, "exponents")?;
        let terms = [0, 1, 2].map(|i| (coefficients[i], centre[i], exponents[i]));
        let solid = out(solid, "solid")?;
        solid.write(give(Csg::from(HalfSpace::power(terms, constant)?)))
    })
}

/// Makes the torus around the axis through `centre` in the direction `axis`, of any length: all points at
/// most `minor` from the circle of radius `major` around the centre. If `minor` is greater than `major`,
/// there is no hollow core. If the axis is parallel to x, y or z, nothing is rounded. Otherwise its direction
/// is rounded to double precision.
///
/// - Buffers: `centre_model` and `axis`, 3 numbers each; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the axis is zero, a radius is not between 2^-256 and 2^256, or a
///   coordinate neither 0 nor of such a magnitude; `major` may be 0, which makes a ball.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[centre_model; 3], [axis; 3]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_torus(
    centre_model: *const f64,
    axis: *const f64,
    major_model: f64,
    minor_model: f64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let (centre, axis) = (array(centre_model, "centre_model")?, array(axis, "axis")?);
        let solid = out(solid, "solid")?;
        solid.write(give(Csg::torus_around(centre, axis, major_model, minor_model)?))
    })
}

/// Makes the right angular wedge of STEP (ISO 10303-42): the box between the origin and `size` whose face at
/// the greatest y is narrowed, or widened, to 0 ≤ x ≤ `top`; 0 makes that face an edge. `matrix` moves it
/// without rounding.
///
/// - Buffers: `size_model`, 3 numbers; `matrix`, 12 numbers as for leafless_solid_placed, or NULL; `solid`,
///   one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if a size, or `top` unless it is 0, is not between 2^-256 and 2^256; for
///   `matrix` as leafless_solid_placed.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[size_model; 3], [matrix; 12]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_wedge(
    size_model: *const f64,
    top_model: f64,
    matrix: *const f64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let size = array(size_model, "size_model")?;
        let solid = out(solid, "solid")?;
        solid.write(give(moved(Csg::wedge(size, top_model)?, matrix)?))
    })
}

/// Makes the prism over a simple polygon in the xy plane, between z = `low` and z = `high`. The polygon's
/// corners are given in order, in either direction of rotation; the last corner is joined to the first. The
/// planes through its edges are exact. `matrix` moves it without rounding.
///
/// - Buffers: `polygon_model`, `count` points of 2 numbers each; `matrix`, 12 numbers as for
///   leafless_solid_placed, or NULL; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if the outline touches or crosses itself or encloses nothing, a coordinate
///   is neither 0 nor of a magnitude between 2^-256 and 2^256, or `low` is not less than `high`; for `matrix`
///   as leafless_solid_placed; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
///
/// cbindgen:ptrs-as-arrays=[[matrix; 12]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_prism(
    polygon_model: *const f64,
    count: u64,
    low_model: f64,
    high_model: f64,
    matrix: *const f64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let polygon = slice(polygon_model.cast::<[f64; 2]>(), count, "polygon_model")?;
        let solid = out(solid, "solid")?;
        solid.write(give(moved(Csg::prism(polygon, low_model, high_model)?, matrix)?))
    })
}

/// Makes the convex polyhedron of the points p with normal · p + offset ≥ 0 for all planes. It may be
/// unbounded or empty.
///
/// - Buffers: `planes`, `count` of 4 numbers each: the normal, of any length and pointing inward, and the
///   offset; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no plane, a normal is zero, or a number neither 0 nor of a
///   magnitude between 2^-256 and 2^256; LEAFLESS_E_NO_MEMORY.
/// - Ownership: release `*solid` with leafless_solid_free.
/// - Untrusted input: any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_convex(
    planes: *const f64,
    count: u64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let given = slice(planes.cast::<[f64; 4]>(), count, "planes")?;
        let planes = memory::collected(given.iter().map(|&[x, y, z, offset]| ([x, y, z], offset)))?;
        let solid = out(solid, "solid")?;
        solid.write(give(Csg::convex(&planes)?))
    })
}

/// Combines solids by a set operation. Without operands, the union and the xor are empty, and the
/// intersection is all of space. No octree is built: the result queries its operands for each cell, and
/// expressions of half-spaces are joined into one expression.
///
/// - Buffers: `solids`, `count` handles, or NULL if there is none; `result`, one pointer. `operation` is a
///   leafless_operation.
/// - Result: `*result`.
/// - Errors: LEAFLESS_E_NULL, also of an element; LEAFLESS_E_ARGUMENT, also if `count` is 0 for a difference;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operands are shared and may be freed; release `*result` with leafless_solid_free.
/// - Untrusted input: any solids.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_combine(
    operation: Number<leafless_operation>,
    solids: *const *const leafless_solid,
    count: u64,
    result: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let operation = operation.known("operation")?;
        let may_be_none = !matches!(operation, LEAFLESS_OPERATION_DIFFERENCE);
        let solids = operands(solids, count, may_be_none, "solids", expression)?;
        let result = out(result, "result")?;
        result.write(give(match (operation, &*solids) {
            (LEAFLESS_OPERATION_DIFFERENCE, [a, b]) => a.difference(b)?,
            (LEAFLESS_OPERATION_DIFFERENCE, [a, rest @ ..]) if !rest.is_empty() => {
                a.difference(&Csg::union_of(rest.iter().cloned())?)?
            }
            (LEAFLESS_OPERATION_UNION | LEAFLESS_OPERATION_DIFFERENCE, _) => Csg::union_of(solids)?,
            (LEAFLESS_OPERATION_INTERSECTION, _) => Csg::intersection_of(solids)?,
            (LEAFLESS_OPERATION_XOR, _) => Csg::xor_of(solids)?,
        }))
    })
}

/// Makes the complement of a solid: the points that `operand` does not contain. A solid and its complement
/// share their boundary.
///
/// - Buffers: `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_NULL.
/// - Ownership: the operand is shared and may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any solids.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_complement(
    operand: *const leafless_solid,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let operand = expression(shared(operand, "operand")?);
        let solid = out(solid, "solid")?;
        solid.write(give(operand.complement()))
    })
}

/// The effect of an affine map on the precision of a solid.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_motion {
    /// Nothing is rounded: half-spaces and expressions of them.
    LEAFLESS_MOTION_EXACT = 0,
    /// The vertices of a mesh are moved and rounded, by some 10^-16 of their coordinates; all proofs allow
    /// for that.
    LEAFLESS_MOTION_VERTICES = 1,
    /// A surface that is not parallel to the lattice blurs by about a cell, as with
    /// leafless_solid_transformed on a frame that is chosen for the solid. A host's shape is queried for
    /// boxes around the inverse images of cells. If the map takes cells to cells, nothing blurs.
    LEAFLESS_MOTION_CONSERVATIVE = 2,
}
use leafless_motion::*;

impl From<Motion> for leafless_motion {
    fn from(motion: Motion) -> leafless_motion {
        match motion {
            Motion::Exact => LEAFLESS_MOTION_EXACT,
            Motion::Vertices => LEAFLESS_MOTION_VERTICES,
            Motion::Conservative => LEAFLESS_MOTION_CONSERVATIVE,
        }
    }
}

/// Makes a solid moved by an affine map, in the best way for its kind: half-spaces exactly, meshes by their
/// vertices, others as by leafless_solid_transformed. Each part of an expression is moved in its own way.
///
/// - Buffers: `matrix`, 12 numbers, the rows of [M | t], where a point p goes to M p + t; `motion`, one
///   leafless_motion or NULL; `solid`, one pointer.
/// - Result: `*solid`; `*motion`, the worst effect of the map on any part (the identity has no effect).
/// - Errors: LEAFLESS_E_ARGUMENT if an entry is neither 0 nor of a magnitude between 2^-64 and 2^64, or M is
///   singular; LEAFLESS_E_MESH if a vertex leaves the range of coordinates of meshes, ±2^256;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operand is shared and may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any solids and numbers.
///
/// cbindgen:ptrs-as-arrays=[[matrix; 12]]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_placed(
    operand: *const leafless_solid,
    matrix: *const f64,
    motion: *mut leafless_motion,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let operand = shared(operand, "operand")?.solid.solid();
        let placement = self::placement(matrix)?;
        let motion = if motion.is_null() { None } else { Some(out(motion, "motion")?) };
        let solid = out(solid, "solid")?;
        let placed = operand.placed(&placement)?;
        if let Some(motion) = motion {
            motion.write(operand.motion().into())?;
        }
        solid.write(give_any(placed))
    })
}

/// Makes a solid whose cells are not split where its surface is known to lie within a layer no thicker than a
/// tolerance: an octree of it stays coarse where the surface is flat. Such cells stay PARTIAL. Half-spaces
/// provide such layers; a solid that provides none is split as usual.
///
/// - Result: `*solid`, a new solid.
/// - Errors: LEAFLESS_E_ARGUMENT if `tolerance_model` is negative or not a number; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the operand is shared and may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any solid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_adaptive(
    operand: *const leafless_solid,
    tolerance_model: f64,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let operand = shared(operand, "operand")?.solid.solid();
        if operand.nesting() >= AnySolid::MOST_NESTED {
            let what = "solids of other kinds within each other";
            return Err(Error::Limit { what, limit: AnySolid::MOST_NESTED.into() }.into());
        }
        let solid = out(solid, "solid")?;
        solid.write(give(Adaptive::new(operand.clone(), tolerance_model)?))
    })
}

/// Makes the same solid with another rule of touching, which holds for the whole expression. An expression
/// that joins it to other solids follows its own rule.
///
/// - Buffers: `solid`, one pointer. `touch` is a leafless_touch.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_NULL; LEAFLESS_E_ARGUMENT if `touch` is not a leafless_touch.
/// - Ownership: the operand is shared and may be freed; release `*solid` with leafless_solid_free.
/// - Untrusted input: any solids.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_with_touch(
    operand: *const leafless_solid,
    touch: Number<leafless_touch>,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        let operand = expression(shared(operand, "operand")?);
        let touch = touch.known("touch")?;
        let solid = out(solid, "solid")?;
        solid.write(give(operand.with_touch(touch)))
    })
}
