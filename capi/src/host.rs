//! Shapes and half-spaces that the host program implements.

use super::boundary::{Failure, Sized32, guard, out, sized};
use super::frame::leafless_interval;
use super::number::{Number, enumeration};
use super::octree::settled_tag;
use super::solid::{give, leafless_solid};
use super::status::leafless_status;
use core::ffi::c_void;
use leafless::Error;
use leafless::Interval;
use leafless::Tag;
use leafless::memory;
use leafless::solid::{Fingerprint, GradientRange, HalfSpace, TangentBalls};
use leafless::{Bounds, Callback, Csg, Verdict};
use std::sync::Arc;

/// A host's promise about its shape outside the universe of the frame in use.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_exterior {
    /// No promise: the shape counts as clipped by the universe.
    LEAFLESS_EXTERIOR_UNKNOWN = 0,
    /// The shape ends inside the universe.
    LEAFLESS_EXTERIOR_EMPTY = 1,
    /// Everything outside the universe belongs to the shape.
    LEAFLESS_EXTERIOR_FULL = 2,
}
enumeration! {
    leafless_exterior => Tag {
        LEAFLESS_EXTERIOR_UNKNOWN => Tag::Partial,
        LEAFLESS_EXTERIOR_EMPTY => Tag::Empty,
        LEAFLESS_EXTERIOR_FULL => Tag::Full,
    }
}

/// Classifies the box [min, max] (3 numbers each, model units) for the host's own shape: Returns
/// LEAFLESS_TAG_EMPTY or LEAFLESS_TAG_FULL if that is proven for all of the box, or LEAFLESS_TAG_PARTIAL to
/// be called for its eight parts. Any other value ends the operation with LEAFLESS_E_CALLBACK and the value
/// in the message; use negative numbers for the host's own errors.
///
/// It is called from several threads at once, which may all be the library's own, unless the operation's
/// options have `threads` = 1. It must give the same answer to the same box. It must return: no exception, no
/// longjmp. It may call this library.
pub type leafless_classify_fn =
    Option<unsafe extern "C" fn(ctx: *mut c_void, min: *const f64, max: *const f64) -> i32>;

/// Decides a point (3 numbers, model units) for the host's own shape: returns 1 inside, 0 outside; any other
/// value ends the operation with LEAFLESS_E_CALLBACK. Otherwise as leafless_classify_fn.
pub type leafless_contains_fn = Option<unsafe extern "C" fn(ctx: *mut c_void, point: *const f64) -> i32>;

/// Classifies `count` boxes (6 numbers each: min, then max) at once, for hosts that do this faster than one
/// by one: sets `tags` to the answers of leafless_classify_fn. Returns 0, or the host's own error code, which
/// ends the operation with LEAFLESS_E_CALLBACK. Otherwise as leafless_classify_fn.
pub type leafless_classify_many_fn =
    Option<unsafe extern "C" fn(ctx: *mut c_void, boxes: *const f64, count: u64, tags: *mut i32) -> i32>;

/// Decides `count` points (3 numbers each) at once: sets each of `inside` to 1 or 0. Returns 0, or the host's
/// own error code. Otherwise as leafless_contains_fn.
pub type leafless_contains_many_fn =
    Option<unsafe extern "C" fn(ctx: *mut c_void, points: *const f64, count: u64, inside: *mut i32) -> i32>;

/// Bounds the distances of `count` points (3 numbers each, model units) from the surface of the host's own
/// shape. It sets each of `distances_model` to a number whose magnitude is at most that distance, negative
/// inside and positive outside; 0 or NaN proves nothing. Returns 0, or the host's own error code. Otherwise
/// as leafless_classify_fn.
pub type leafless_distance_many_fn = Option<
    unsafe extern "C" fn(ctx: *mut c_void, points: *const f64, count: u64, distances_model: *mut f64) -> i32,
>;

/// Bounds of a function f of the host over a box. The shape is the set of the points where f is not positive,
/// as for a signed distance; the gradient points out of it. NaN, or lower > upper, proves nothing about the
/// box.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_gradient {
    /// An interval that contains the value of f at the middle of the box. One end may be infinite.
    pub value: leafless_interval,
    /// For each axis, an interval that contains the partial derivative of f everywhere in the box. f must be
    /// continuous there; where it has no derivative, the interval must contain the one-sided derivatives.
    pub gradient: [leafless_interval; 3],
}

/// Bounds the host's function f over the box [min, max] (3 numbers each, model units) with the centre
/// `middle` (3 numbers): sets `*gradient`, whose numbers are all NaN before. Returns 0, or the host's own
/// error code. Otherwise as leafless_classify_fn.
pub type leafless_gradient_fn = Option<
    unsafe extern "C" fn(
        ctx: *mut c_void,
        min: *const f64,
        max: *const f64,
        middle: *const f64,
        gradient: *mut leafless_gradient,
    ) -> i32,
>;

/// Two balls that touch the surface of the host's shape at a point, one inside and one outside.
///
/// Let d = y - `point` for a point y of the box, and n = `normal` divided by its length. Each y of the box
/// with n . d < -(inner_curvature / 2 |d|^2 + error) must lie in the shape, and no y with n . d >
/// outer_curvature / 2 |d|^2 + error may. So if `error` is 0, the balls have the radii 1 / `inner_curvature`
/// and 1 / `outer_curvature`. A curvature of 0 means a half-space, a negative curvature the outside of a
/// ball, and infinity nothing. The reciprocal of the surface's reach is valid for both: it is at least every
/// curvature, and at least 2 over the width of every wall or gap. NaN, or a negative error, proves nothing
/// about the box.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_tangent {
    /// The point where the balls touch (model units); best the surface's nearest point to the middle of the
    /// box.
    pub point: [f64; 3],
    /// The direction that points out of the shape there, of any length.
    pub normal: [f64; 3],
    /// The reciprocal of the radius of the ball inside.
    pub inner_curvature: f64,
    /// The reciprocal of the radius of the ball outside.
    pub outer_curvature: f64,
    /// Bound of the error of the surface (model units), from rounding in `point` and `normal`.
    pub error: f64,
}

/// Describes the position and the curvature of the surface of the host's own shape next to the middle of a
/// box: sets `*tangent`, whose numbers are all NaN before. Otherwise as leafless_gradient_fn.
pub type leafless_tangent_fn = Option<
    unsafe extern "C" fn(
        ctx: *mut c_void,
        min: *const f64,
        max: *const f64,
        middle: *const f64,
        tangent: *mut leafless_tangent,
    ) -> i32,
>;

/// Called once, when nothing uses `ctx` any more, in the thread that released the last reference. It must
/// return: no exception, no longjmp. It may call this library.
pub type leafless_destroy_fn = Option<unsafe extern "C" fn(ctx: *mut c_void)>;

/// The host's own shape. All fields but the first may be zero; `classify` or `distance_many` must be set.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_solid_callbacks {
    /// sizeof(leafless_solid_callbacks).
    pub struct_size: u32,
    /// A leafless_exterior: the host's promise about the space outside the universe.
    pub exterior: Number<leafless_exterior>,
    /// Classifies boxes.
    pub classify: leafless_classify_fn,
    /// Decides points: LEAFLESS_RULE_SAMPLED needs it; optional.
    pub contains: leafless_contains_fn,
    /// Called when the library no longer needs `ctx`; optional.
    pub destroy: leafless_destroy_fn,
    /// The context that the functions are called with.
    pub ctx: *mut c_void,
    /// A number of 128 bits that identifies the shape, such as a hash of its parameters; 0 means none.
    /// Octrees from leafless_lazy_freeze store it, and only the same shape can continue them.
    pub fingerprint: [u64; 2],
    /// Classifies many boxes at once, as many as the operation has ready; optional. `classify` must be set as
    /// well.
    pub classify_many: leafless_classify_many_fn,
    /// Decides many points at once; optional, with or without `contains`.
    pub contains_many: leafless_contains_many_fn,
    /// Bounds the distances of points from the surface; optional. It is called for the middles of cells
    /// before boxes are classified. A cell whose middle is further from the surface than from its own corners
    /// is decided. If it is set, `classify` is optional.
    pub distance_many: leafless_distance_many_fn,
    /// Bounds a function of the host over boxes; optional. It is called for undecided cells. Measures,
    /// bounding boxes and adaptive octrees need far fewer splits with it. No verdict depends on it.
    pub gradient: leafless_gradient_fn,
    /// Describes the surface next to the middle of a box; optional. It serves the same purposes as
    /// `gradient`. If both are set, it is called where `gradient` proves nothing.
    pub tangent: leafless_tangent_fn,
    /// A box that contains the shape: its lower and its upper corner (model units). All zero means that no
    /// box is known. In a universe that holds the box the shape ends inside, whatever `exterior` is. The box
    /// moves with the shape; for a moved shape `exterior` is ignored.
    pub bounds: [f64; 6],
}

// SAFETY: numbers, a pointer, and optional functions.
unsafe impl Sized32 for leafless_solid_callbacks {}

/// The host's functions with their context.
struct Host(leafless_solid_callbacks);

// SAFETY: the library only passes `ctx` back to the host. By their documented contract, the functions may be
// called from any thread.
unsafe impl Send for Host {}
// SAFETY: as above.
unsafe impl Sync for Host {}

impl Drop for Host {
    fn drop(&mut self) {
        if let Some(destroy) = self.0.destroy {
            // SAFETY: as the host gave it, with its own context; this is the only place that calls it.
            unsafe { destroy(self.0.ctx) }
        }
    }
}

/// Returns the verdict of a host's tag.
fn verdict(code: i32) -> Result<Verdict<()>, Error> {
    match settled_tag(code.into(), "verdict") {
        Ok(Tag::Empty) => Ok(Verdict::Empty),
        Ok(Tag::Full) => Ok(Verdict::Full),
        Ok(_) => Ok(Verdict::Partial(())),
        Err(_) => Err(Error::Callback { code }),
    }
}

/// Returns the membership of a host's answer about a point.
fn membership(code: i32) -> Result<bool, Error> {
    match code {
        0 => Ok(false),
        1 => Ok(true),
        code => Err(Error::Callback { code }),
    }
}

/// Returns success, or the host's own error.
pub(super) fn done(code: i32) -> Result<(), Error> {
    if code == 0 { Ok(()) } else { Err(Error::Callback { code }) }
}

// SAFETY, of all calls here: the functions are as the host gave them, called with their own context and with
// the documented counts of numbers.
impl Host {
    fn classify(&self, min: [f64; 3], max: [f64; 3]) -> Result<Verdict<()>, Error> {
        let Some(classify) = self.0.classify else { return Ok(Verdict::Partial(())) };
        // SAFETY: as above.
        verdict(unsafe { classify(self.0.ctx, min.as_ptr(), max.as_ptr()) })
    }

    fn classify_many(&self, boxes: &[[[f64; 3]; 2]], verdicts: &mut [Verdict<()>]) -> Result<(), Error> {
        let Some(classify) = self.0.classify_many else { return Ok(()) };
        // A tag that the host does not set is invalid.
        let mut tags = memory::filled(boxes.len(), i32::MIN)?;
        // SAFETY: as above.
        done(unsafe { classify(self.0.ctx, boxes.as_ptr().cast(), boxes.len() as u64, tags.as_mut_ptr()) })?;
        for (to, &tag) in verdicts.iter_mut().zip(&tags) {
            *to = verdict(tag)?;
        }
        Ok(())
    }

    fn distances(&self, points: &[[f64; 3]], distances: &mut [f64]) -> Result<(), Error> {
        let Some(distance) = self.0.distance_many else { return Ok(()) };
        // SAFETY: as above.
        done(unsafe {
            distance(self.0.ctx, points.as_ptr().cast(), points.len() as u64, distances.as_mut_ptr())
        })
    }

    fn gradient(
        &self,
        min: [f64; 3],
        max: [f64; 3],
        middle: [f64; 3],
    ) -> Result<Option<GradientRange>, Error> {
        let Some(function) = self.0.gradient else { return Ok(None) };
        let unset = leafless_interval { lower: f64::NAN, upper: f64::NAN };
        let mut found = leafless_gradient { value: unset, gradient: [unset; 3] };
        // SAFETY: as above.
        done(unsafe { function(self.0.ctx, min.as_ptr(), max.as_ptr(), middle.as_ptr(), &mut found) })?;
        let gradient = found.gradient.map(leafless_interval::known);
        Ok(Some(GradientRange { value: found.value.known(), gradient }))
    }

    fn tangent(&self, min: [f64; 3], max: [f64; 3], middle: [f64; 3]) -> Result<Option<TangentBalls>, Error> {
        let Some(function) = self.0.tangent else { return Ok(None) };
        let mut found = leafless_tangent {
            point: [f64::NAN; 3],
            normal: [f64::NAN; 3],
            inner_curvature: f64::NAN,
            outer_curvature: f64::NAN,
            error: f64::NAN,
        };
        // SAFETY: as above.
        done(unsafe { function(self.0.ctx, min.as_ptr(), max.as_ptr(), middle.as_ptr(), &mut found) })?;
        let leafless_tangent { point, normal, inner_curvature, outer_curvature, error } = found;
        Ok(Some(TangentBalls { point, normal, inner_curvature, outer_curvature, error }))
    }

    fn contains(&self, points: &[[f64; 3]], inside: &mut [bool]) -> Result<(), Error> {
        let mut answers = memory::filled(points.len(), i32::MIN)?;
        if let Some(contains) = self.0.contains_many {
            let count = points.len() as u64;
            // SAFETY: as above.
            done(unsafe { contains(self.0.ctx, points.as_ptr().cast(), count, answers.as_mut_ptr()) })?;
        } else if let Some(contains) = self.0.contains {
            for (answer, point) in answers.iter_mut().zip(points) {
                // SAFETY: as above.
                *answer = unsafe { contains(self.0.ctx, point.as_ptr()) };
                membership(*answer)?;
            }
        }
        for (to, &answer) in inside.iter_mut().zip(&answers) {
            *to = membership(answer)?;
        }
        Ok(())
    }
}

/// Returns the host's fingerprint, unless it is 0.
fn fingerprint(given: [u64; 2]) -> Option<Fingerprint> {
    (given != [0; 2]).then(|| Fingerprint::of_bytes(bytemuck::bytes_of(&given.map(u64::to_le))))
}

/// Makes a solid from the host's own shape.
///
/// - Buffers: `callbacks`, one struct, which is copied; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_NULL if `classify` is NULL, unless `distance_many` is set and `classify_many` is not;
///   LEAFLESS_E_ARGUMENT if `exterior` is not a leafless_exterior, or `bounds` is not a box. After an error
///   `destroy` is not called.
/// - Ownership: `ctx` must live until `destroy` is called with it; release `*solid` with leafless_solid_free.
/// - Threads: any; leafless_classify_fn describes the threads that call the functions.
/// - Untrusted input: any answers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_callbacks(
    callbacks: *const leafless_solid_callbacks,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        if callbacks.is_null() {
            return Err(Failure::Null { name: "callbacks" });
        }
        let callbacks = sized(callbacks, "callbacks")?;
        if callbacks.classify.is_none()
            && (callbacks.distance_many.is_none() || callbacks.classify_many.is_some())
        {
            return Err(Failure::Null { name: "callbacks.classify" });
        }
        let exterior = callbacks.exterior.known("callbacks.exterior")?;
        let [a, b, c, d, e, f] = callbacks.bounds;
        let bounds = match callbacks.bounds == [0.0; 6] {
            true => None,
            false => match Bounds::new([a, b, c], [d, e, f]) {
                None => {
                    let problem = "must be a lower and an upper corner, all numbers finite";
                    return Err(Failure::Argument { name: "callbacks.bounds", problem });
                }
                known => known,
            },
        };
        let solid = out(solid, "solid")?;
        let has_many = callbacks.classify_many.is_some();
        let has_distance = callbacks.distance_many.is_some();
        let fingerprint = fingerprint(callbacks.fingerprint);
        // From here on the library owns the host's context.
        let host = Arc::new(Host(callbacks));
        let classify = {
            let host = host.clone();
            move |min, max| host.classify(min, max)
        };
        let mut callback = Callback::new(classify).with_exterior(exterior);
        if let Some(fingerprint) = fingerprint {
            callback = callback.with_fingerprint(fingerprint);
        }
        if let Some(bounds) = bounds {
            callback = callback.with_bounds(bounds);
        }
        if has_many {
            let host = host.clone();
            callback =
                callback.with_classify_many(move |boxes, verdicts| host.classify_many(boxes, verdicts));
        }
        if has_distance {
            let host = host.clone();
            callback = callback.with_distance(move |points, distances| host.distances(points, distances));
        }
        if callbacks.gradient.is_some() {
            let host = host.clone();
            callback = callback.with_gradient(move |min, max, middle| host.gradient(min, max, middle));
        }
        if callbacks.tangent.is_some() {
            let host = host.clone();
            callback = callback.with_tangent(move |min, max, middle| host.tangent(min, max, middle));
        }
        if callbacks.contains_many.is_some() {
            callback = callback.with_contains_many(move |points, inside| host.contains(points, inside));
        } else if callbacks.contains.is_some() {
            callback = callback.with_contains(move |point| {
                let mut inside = [false];
                host.contains(&[point], &mut inside)?;
                Ok(inside[0])
            });
        }
        solid.write(give(callback))
    })
}

/// Computes the value of the host's function at a point (3 numbers, model units): sets `*value`. Returns 0,
/// or the host's own error code, which ends the operation with LEAFLESS_E_CALLBACK. Otherwise as
/// leafless_classify_fn.
pub type leafless_value_fn =
    Option<unsafe extern "C" fn(ctx: *mut c_void, point: *const f64, value: *mut f64) -> i32>;

/// Computes an interval that contains all values of the host's function over the box [min, max] (3 numbers
/// each, model units): sets `*range`. Otherwise as leafless_value_fn.
pub type leafless_range_fn = Option<
    unsafe extern "C" fn(
        ctx: *mut c_void,
        min: *const f64,
        max: *const f64,
        range: *mut leafless_interval,
    ) -> i32,
>;

/// A half-space of the host: the points where its function is not negative. `value` and `range` must be set.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_solid_function {
    /// sizeof(leafless_solid_function).
    pub struct_size: u32,
    /// Reserved; must be 0.
    pub reserved: u32,
    /// Computes the function's value at a point; NaN where the function is undefined. Only the sign matters.
    pub value: leafless_value_fn,
    /// Bounds the function over a box. Only this range proves that a cell lies inside or outside. A NaN, or
    /// lower > upper, proves nothing.
    pub range: leafless_range_fn,
    /// Called when the library no longer needs `ctx`; optional.
    pub destroy: leafless_destroy_fn,
    /// The context that the functions are called with.
    pub ctx: *mut c_void,
    /// As in leafless_solid_callbacks.
    pub fingerprint: [u64; 2],
}

// SAFETY: numbers, a pointer, and optional functions.
unsafe impl Sized32 for leafless_solid_function {}

/// The host's function with its context.
struct HostFunction(leafless_solid_function);

// SAFETY: as for `Host`.
unsafe impl Send for HostFunction {}
// SAFETY: as for `Host`.
unsafe impl Sync for HostFunction {}

impl Drop for HostFunction {
    fn drop(&mut self) {
        if let Some(destroy) = self.0.destroy {
            // SAFETY: as the host gave it, with its own context; this is the only place that calls it.
            unsafe { destroy(self.0.ctx) }
        }
    }
}

impl HostFunction {
    fn value(&self, point: [f64; 3]) -> Result<f64, Error> {
        let mut value = f64::NAN;
        let Some(function) = self.0.value else { return Ok(value) };
        // SAFETY: as for `Host`.
        done(unsafe { function(self.0.ctx, point.as_ptr(), &mut value) })?;
        Ok(value)
    }

    fn range(&self, min: [f64; 3], max: [f64; 3]) -> Result<Interval, Error> {
        let mut range = leafless_interval { lower: f64::NAN, upper: f64::NAN };
        if let Some(function) = self.0.range {
            // SAFETY: as for `Host`.
            done(unsafe { function(self.0.ctx, min.as_ptr(), max.as_ptr(), &mut range) })?;
        }
        Ok(range.known())
    }
}

/// Makes a half-space of the host. It can be combined with other half-spaces and placed. The functions of a
/// placed half-space are called in its own space, for the box around a cell's inverse image and for the
/// rounded inverse image of a point.
///
/// - Buffers: `function`, one struct, which is copied; `solid`, one pointer.
/// - Result: `*solid`.
/// - Errors: LEAFLESS_E_NULL if `value` or `range` is NULL; LEAFLESS_E_ARGUMENT. After an error `destroy` is
///   not called.
/// - Ownership: `ctx` must live until `destroy` is called with it; release `*solid` with leafless_solid_free.
/// - Threads: any; leafless_classify_fn describes the threads that call the functions.
/// - Untrusted input: any answers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_solid_new_function(
    function: *const leafless_solid_function,
    solid: *mut *mut leafless_solid,
) -> leafless_status {
    guard(|| unsafe {
        if function.is_null() {
            return Err(Failure::Null { name: "function" });
        }
        let function = sized(function, "function")?;
        if function.value.is_none() {
            return Err(Failure::Null { name: "function.value" });
        }
        if function.range.is_none() {
            return Err(Failure::Null { name: "function.range" });
        }
        if function.reserved != 0 {
            return Err(Failure::Argument { name: "function.reserved", problem: "must be zero" });
        }
        let solid = out(solid, "solid")?;
        let fingerprint = fingerprint(function.fingerprint);
        // From here on the library owns the host's context.
        let host = Arc::new(HostFunction(function));
        let values = host.clone();
        let half_space = HalfSpace::host(
            move |point| values.value(point),
            move |min, max| host.range(min, max),
            fingerprint,
        );
        solid.write(give(Csg::from(half_space)))
    })
}
