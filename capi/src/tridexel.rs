//! Tri-dexel models: building from solids, description, comparison and metadata.

use super::boundary::{Failure, Sized32, filled, guard, handle, out, output, refer, release, shared, sized};
use super::control::{controlled, leafless_options};
use super::frame::{frame, leafless_frame};
use super::metadata::{self, Fact};
use super::number::Number;
use super::op::leafless_rule;
use super::solid::leafless_solid;
use super::status::leafless_status;
use core::ffi::c_char;
use leafless::Frame;
use leafless::TriDexel;
use leafless::dexel::{DexelEnds, DexelFormat, DexelNormals};
use leafless::dexelize;
use leafless::octree::MetadataLimit;
use leafless::op::DexelOptions;
use leafless_dexel_ends::*;
use leafless_dexel_normals::*;

/// A tri-dexel model: a solid as intervals along the rays of a lattice, in one to three directions.
///
/// Rays run through the centres of the finest cells of a frame. Each ray has the sorted, disjoint intervals
/// of its points inside the solid. An interval is half-open: it contains its start and not its end, so that
/// set algebra is exact. All directions agree about the centres of cells.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_tridexel_free releases. A leafless_tridexel_editor changes a copy in place.
pub struct leafless_tridexel {
    pub(super) model: TriDexel,
}

/// The axes that rays run along. The numbers may be added.
#[repr(u32)]
pub enum leafless_axes {
    /// Along x.
    LEAFLESS_AXES_X = 1,
    /// Along y.
    LEAFLESS_AXES_Y = 2,
    /// Along z.
    LEAFLESS_AXES_Z = 4,
    /// Along all three.
    LEAFLESS_AXES_ALL = 7,
}

/// The storage format of the ends of intervals.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_dexel_ends {
    /// Start and length in units of 2^-31 edges of the universe, 8 bytes an interval. An end is off by at
    /// most one unit.
    LEAFLESS_DEXEL_ENDS_FIXED = 0,
    /// Start and end as doubles, 16 bytes an interval.
    LEAFLESS_DEXEL_ENDS_DOUBLE = 1,
}

/// The storage format of the unit normals at the ends of intervals, an octahedral code.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_dexel_normals {
    /// Normals are not stored.
    LEAFLESS_DEXEL_NORMALS_NONE = 0,
    /// 16 bits a normal, 4 bytes an interval, within a degree.
    LEAFLESS_DEXEL_NORMALS_16 = 1,
    /// 32 bits a normal, 8 bytes an interval, within 0.005 degrees.
    LEAFLESS_DEXEL_NORMALS_32 = 2,
}

impl From<DexelEnds> for leafless_dexel_ends {
    fn from(ends: DexelEnds) -> leafless_dexel_ends {
        match ends {
            DexelEnds::Fixed => LEAFLESS_DEXEL_ENDS_FIXED,
            DexelEnds::Double => LEAFLESS_DEXEL_ENDS_DOUBLE,
        }
    }
}

impl From<DexelNormals> for leafless_dexel_normals {
    fn from(normals: DexelNormals) -> leafless_dexel_normals {
        match normals {
            DexelNormals::None => LEAFLESS_DEXEL_NORMALS_NONE,
            DexelNormals::Bits16 => LEAFLESS_DEXEL_NORMALS_16,
            DexelNormals::Bits32 => LEAFLESS_DEXEL_NORMALS_32,
        }
    }
}

/// Returns the sum of axes.
pub(super) fn axes(directions: [bool; 3]) -> u32 {
    (0..3).map(|axis| u32::from(directions[axis]) << axis).sum()
}

/// The format of a tri-dexel model: which data it stores. NULL means the defaults. Zero is the default of
/// every field but the first.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_tridexel_format {
    /// sizeof(leafless_tridexel_format).
    pub struct_size: u32,
    /// The axes that rays run along, a sum of leafless_axes; 0 means the axes of the operand if there is one,
    /// else LEAFLESS_AXES_ALL.
    pub directions: u32,
    /// A leafless_dexel_ends.
    pub ends: u32,
    /// A leafless_dexel_normals.
    pub normals: u32,
    /// 1 to store the source's surface of each end, 8 bytes an interval; else 0.
    pub has_surfaces: u32,
    /// 1 to store the material of each interval, 4 bytes an interval; else 0.
    pub has_materials: u32,
}

// SAFETY: numbers.
unsafe impl Sized32 for leafless_tridexel_format {}

impl leafless_tridexel_format {
    /// Returns the directions, if they are given, and the storage format.
    pub(super) fn parts(&self) -> Result<(Option<[bool; 3]>, DexelFormat), Failure> {
        let refused = |name, problem| Err(Failure::Argument { name, problem });
        if self.directions > leafless_axes::LEAFLESS_AXES_ALL as u32 {
            return refused("format.directions", "must be a sum of leafless_axes");
        }
        let directions = [0, 1, 2].map(|axis| self.directions >> axis & 1 == 1);
        let ends = match self.ends {
            given if given == LEAFLESS_DEXEL_ENDS_FIXED as u32 => DexelEnds::Fixed,
            given if given == LEAFLESS_DEXEL_ENDS_DOUBLE as u32 => DexelEnds::Double,
            _ => return refused("format.ends", "is no leafless_dexel_ends"),
        };
        let normals = match self.normals {
            given if given == LEAFLESS_DEXEL_NORMALS_NONE as u32 => DexelNormals::None,
            given if given == LEAFLESS_DEXEL_NORMALS_16 as u32 => DexelNormals::Bits16,
            given if given == LEAFLESS_DEXEL_NORMALS_32 as u32 => DexelNormals::Bits32,
            _ => return refused("format.normals", "is no leafless_dexel_normals"),
        };
        if self.has_surfaces > 1 {
            return refused("format.has_surfaces", "must be 0 or 1");
        }
        if self.has_materials > 1 {
            return refused("format.has_materials", "must be 0 or 1");
        }
        let (surfaces, materials) = (self.has_surfaces == 1, self.has_materials == 1);
        let format = DexelFormat { ends, normals, surfaces, materials };
        Ok(((self.directions != 0).then_some(directions), format))
    }
}

/// Basic facts about a tri-dexel model.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_tridexel_info {
    /// sizeof(leafless_tridexel_info).
    pub struct_size: u32,
    /// The lattice: rays run through the centres of its finest cells.
    pub frame: leafless_frame,
    /// The axes that rays run along, a sum of leafless_axes.
    pub directions: u32,
    /// The storage format of the ends of intervals.
    pub ends: leafless_dexel_ends,
    /// The storage format of unit normals.
    pub normals: leafless_dexel_normals,
    /// 1 if the surfaces of the ends are stored, else 0.
    pub has_surfaces: u32,
    /// 1 if the materials of intervals are stored, else 0.
    pub has_materials: u32,
    /// Bytes of an interval.
    pub bytes_per_interval: u32,
    /// Number of intervals in all directions.
    pub interval_count: u64,
    /// Bytes of the arrays.
    pub bytes: u64,
}

output!(leafless_tridexel_info);

/// Returns a handle of a tri-dexel model.
pub(super) fn give(model: TriDexel) -> *mut leafless_tridexel {
    handle(leafless_tridexel { model })
}

/// Makes the tri-dexel model of a solid on the lattice of a frame. O(rays + crossings). The result is
/// identical, bit for bit, for any number of threads.
///
/// Under LEAFLESS_RULE_SAMPLED the intervals are those of the solid on each ray. The centres of cells next to
/// an end lie on the same side of it as in the solid; apart from that, an end is off by at most 2^-31 of the
/// universe's edge, or 2^-36 with LEAFLESS_DEXEL_ENDS_DOUBLE. This holds for closed meshes, for half-spaces
/// and expressions of them, and for octrees. Solids of other kinds, and open meshes around their holes, are
/// sampled: an end between centres on different sides is located by cells to a depth of 20, and a wall
/// between two neighbouring centres is missed. Under LEAFLESS_RULE_INNER the intervals are those of the
/// solid's FULL cells, under LEAFLESS_RULE_OUTER those of all cells that are not EMPTY.
///
/// - Buffers: `frame`, one struct; `format`, one struct or NULL; `options`, one struct or NULL; `tridexel`,
///   one pointer. `rule` is a leafless_rule.
/// - Result: `*tridexel`.
/// - Errors: LEAFLESS_E_ARGUMENT also for LEAFLESS_RULE_CERTIFIED, because an interval cannot be undecided,
///   and if a field of `format` is wrong; LEAFLESS_E_FRAME if the solid belongs to another frame;
///   LEAFLESS_E_NOT_SAMPLED if `rule` is LEAFLESS_RULE_SAMPLED and the solid cannot decide points;
///   LEAFLESS_E_CALLBACK; LEAFLESS_E_DAMAGED; LEAFLESS_E_LIMIT, also for 2^32 rays or intervals along one
///   axis; LEAFLESS_E_CANCELLED; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the model keeps no reference to the solid; release `*tridexel` with leafless_tridexel_free.
/// - Threads: any; runs on as many threads as `options` says.
/// - Untrusted input: any solid; set `max_bytes` if the depth or the solid is untrusted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_build(
    solid: *const leafless_solid,
    frame: *const leafless_frame,
    rule: Number<leafless_rule>,
    format: *const leafless_tridexel_format,
    options: *const leafless_options,
    tridexel: *mut *mut leafless_tridexel,
) -> leafless_status {
    guard(|| unsafe {
        let solid = &shared(solid, "solid")?.solid;
        let frame = self::frame(frame)?;
        let rule = rule.known("rule")?;
        let (directions, format) = sized(format, "format")?.parts()?;
        let tridexel = out(tridexel, "tridexel")?;
        let wanted = DexelOptions { directions: directions.unwrap_or([true; 3]), format, rule };
        let made = controlled(options, |control| dexelize(solid, &frame, &wanted, control))?;
        tridexel.write(give(made))
    })
}

/// Returns one more reference to a tri-dexel model.
///
/// - Buffers: `tridexel`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `tridexel`.
/// - Ownership: release each reference with leafless_tridexel_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_ref(
    tridexel: *const leafless_tridexel,
    reference: *mut *mut leafless_tridexel,
) -> leafless_status {
    guard(|| unsafe { refer(tridexel, "tridexel", reference) })
}

/// Releases a reference to a tri-dexel model. The last release frees the model. The mapping of its file ends
/// too, unless a model with other metadata still shares its arrays.
///
/// - Buffers: `tridexel`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_free(tridexel: *mut leafless_tridexel) {
    // SAFETY: the caller's promise.
    unsafe { release(tridexel) }
}

/// Returns basic facts about a tri-dexel model. O(1).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Untrusted input: any model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_describe(
    tridexel: *const leafless_tridexel,
    info: *mut leafless_tridexel_info,
) -> leafless_status {
    guard(|| unsafe {
        let view = shared(tridexel, "tridexel")?.model.view();
        let info = filled(info, "info")?;
        let (format, count) = (view.format(), view.interval_count());
        info.write(described(view.frame(), format, view.directions(), count, view.bytes()))
    })
}

pub(super) fn described(
    frame: &Frame,
    format: DexelFormat,
    directions: [bool; 3],
    interval_count: u64,
    bytes: u64,
) -> leafless_tridexel_info {
    leafless_tridexel_info {
        struct_size: size_of::<leafless_tridexel_info>() as u32,
        frame: frame.into(),
        directions: axes(directions),
        ends: format.ends.into(),
        normals: format.normals.into(),
        has_surfaces: format.surfaces.into(),
        has_materials: format.materials.into(),
        bytes_per_interval: format.bytes_per_interval() as u32,
        interval_count,
        bytes,
    }
}

/// Checks that a tri-dexel model is well-formed: intervals are in order, disjoint and inside the universe.
/// O(n). Whether the directions agree is not checked. Models that the library makes, opens or maps verified
/// are well-formed.
///
/// - Result: LEAFLESS_OK if the check passes.
/// - Errors: LEAFLESS_E_DAMAGED, with the first damage in the message.
/// - Untrusted input: any model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_check(tridexel: *const leafless_tridexel) -> leafless_status {
    guard(|| unsafe { Ok(shared(tridexel, "tridexel")?.model.view().check()?) })
}

/// Returns whether two tri-dexel models store the same data, bit for bit, on the same frame. Metadata is not
/// compared. O(n).
///
/// - Buffers: `equal`, one truth value.
/// - Result: `*equal`.
/// - Untrusted input: any models.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_equal(
    a: *const leafless_tridexel,
    b: *const leafless_tridexel,
    equal: *mut bool,
) -> leafless_status {
    guard(|| unsafe {
        let (a, b) = (shared(a, "a")?, shared(b, "b")?);
        out(equal, "equal")?.write(a.model == b.model)
    })
}

/// Returns the tri-dexel model with one more fact in its metadata, or with a new value of a fact; the arrays
/// are shared. Names in use: "name", "units".
///
/// - Buffers: `key` and `value`, `key_length` and `value_length` bytes of UTF-8; `named`, one pointer.
/// - Result: `*named`.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_ARGUMENT if all facts would take more than 1 MiB in a file (each
///   takes 8 bytes and its two texts); LEAFLESS_E_NO_MEMORY.
/// - Ownership: the texts are copied. `*named` shares the arrays of `tridexel`, which may be freed. Bytes
///   that `tridexel` views must outlive `*named` too, and a file that it maps must stay unchanged as long.
///   Release `*named` with leafless_tridexel_free.
/// - Untrusted input: any texts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_with_metadata(
    tridexel: *const leafless_tridexel,
    key: *const c_char,
    key_length: usize,
    value: *const c_char,
    value_length: usize,
    named: *mut *mut leafless_tridexel,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        let named = out(named, "named")?;
        let (key, value) = ((key, key_length), (value, value_length));
        let facts = metadata::with(model.metadata(), key, value, MetadataLimit::SOLID)?;
        named.write(give(model.with_metadata(facts)))
    })
}

/// Returns the tri-dexel model with one fact less in its metadata, or without metadata; the arrays are
/// shared.
///
/// - Buffers: `key`, `key_length` bytes of UTF-8, or NULL for all facts; `unnamed`, one pointer.
/// - Result: `*unnamed`; it is not an error if there is no such fact.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_tridexel_with_metadata.
/// - Untrusted input: any texts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_without_metadata(
    tridexel: *const leafless_tridexel,
    key: *const c_char,
    key_length: usize,
    unnamed: *mut *mut leafless_tridexel,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        let unnamed = out(unnamed, "unnamed")?;
        unnamed.write(give(model.with_metadata(metadata::without(model.metadata(), key, key_length)?)))
    })
}

/// Returns the value of a fact in a tri-dexel model's metadata, such as "name".
///
/// - Buffers: `key`, `key_length` bytes of UTF-8; `value` and `value_length`, one each.
/// - Result: `*value`, not NUL-terminated; NULL if there is no such fact. `*value_length`, in bytes.
/// - Errors: LEAFLESS_E_UTF8.
/// - Ownership: the text belongs to the model and lives as long as the reference `tridexel`.
/// - Untrusted input: any model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_peek_metadata(
    tridexel: *const leafless_tridexel,
    key: *const c_char,
    key_length: usize,
    value: *mut *const c_char,
    value_length: *mut usize,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        metadata::peek(model.metadata(), key, key_length, value, value_length)
    })
}

/// Returns a fact of a tri-dexel model's metadata by its index. Facts are sorted by key.
///
/// - Buffers: `count`, one number; `key`, `key_length`, `value`, `value_length`, one each, all four NULL to
///   get only the count.
/// - Result: `*count`, the number of all facts; key and value, not NUL-terminated, with their lengths in
///   bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no fact `index`, unless only the count is requested.
/// - Ownership: the texts belong to the model and live as long as the reference `tridexel`.
/// - Untrusted input: any model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_tridexel_peek_metadata_at(
    tridexel: *const leafless_tridexel,
    index: u64,
    count: *mut u64,
    key: *mut *const c_char,
    key_length: *mut usize,
    value: *mut *const c_char,
    value_length: *mut usize,
) -> leafless_status {
    guard(|| unsafe {
        let model = &shared(tridexel, "tridexel")?.model;
        let fact = Fact { key, key_length, value, value_length };
        metadata::peek_at(model.metadata(), index, count, fact)
    })
}
