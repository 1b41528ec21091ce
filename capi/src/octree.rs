//! Octrees: description, statistics, comparison and metadata.

use super::boundary::{Failure, buffer, filled, guard, handle, out, output, refer, release, shared};
use super::frame::{frame, leafless_frame, leafless_interval};
use super::metadata::{self, Fact};
use super::number::{Byte, Number, enumeration};
use super::status::leafless_status;
use core::ffi::c_char;
use leafless::octree::MetadataLimit;
use leafless::octree::{LevelStatistics, Statistics};
use leafless::{Octree, Proof, Tag};

/// A leaf-free octree, in memory or mapped from a file.
///
/// Immutable: all its functions may be called at once from any number of threads, but no other call may use
/// the reference that leafless_octree_free releases.
pub struct leafless_octree {
    pub(super) octree: Octree,
}

/// The tag of a cell: the cell's relation to the solid.
#[derive(Clone, Copy)]
#[repr(u8)]
pub enum leafless_tag {
    /// Proven outside the solid.
    LEAFLESS_TAG_EMPTY = 0,
    /// Cut and split: the cell has a node.
    LEAFLESS_TAG_BRANCH = 1,
    /// Not decided.
    LEAFLESS_TAG_PARTIAL = 2,
    /// Proven inside the solid.
    LEAFLESS_TAG_FULL = 3,
}
use leafless_tag::*;

impl From<Tag> for leafless_tag {
    fn from(tag: Tag) -> leafless_tag {
        match tag {
            Tag::Empty => LEAFLESS_TAG_EMPTY,
            Tag::Branch => LEAFLESS_TAG_BRANCH,
            Tag::Partial => LEAFLESS_TAG_PARTIAL,
            Tag::Full => LEAFLESS_TAG_FULL,
        }
    }
}

/// Returns the tag with this number, if it is EMPTY, PARTIAL or FULL.
pub(super) fn settled_tag(tag: i64, name: &'static str) -> Result<Tag, Failure> {
    match tag {
        _ if tag == LEAFLESS_TAG_EMPTY as i64 => Ok(Tag::Empty),
        _ if tag == LEAFLESS_TAG_PARTIAL as i64 => Ok(Tag::Partial),
        _ if tag == LEAFLESS_TAG_FULL as i64 => Ok(Tag::Full),
        _ => Err(Failure::Argument { name, problem: "must be EMPTY, PARTIAL or FULL" }),
    }
}

/// The proofs that the cells of an octree give about the solid that it was made from. Certified octrees prove
/// FULL and EMPTY, inner octrees FULL, outer octrees EMPTY, sampled octrees nothing. Results of set
/// operations prove what their operands prove, and files store it.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_proof {
    /// Displacement of the surfaces from the given surfaces, in model units: by sewn cracks, rounded
    /// vertices, and a stated deviation of a tessellation.
    pub displacement_model: f64,
    /// A FULL cell is proven to lie in the solid.
    pub full: bool,
    /// An EMPTY cell is proven to lie outside it.
    pub empty: bool,
}

impl From<Proof> for leafless_proof {
    fn from(proof: Proof) -> leafless_proof {
        leafless_proof { displacement_model: proof.displacement(), full: proof.full, empty: proof.empty }
    }
}

/// The tags of an octree's cells that are proven.
#[repr(u32)]
pub enum leafless_proven {
    /// Neither.
    LEAFLESS_PROVEN_NOTHING = 0,
    /// FULL.
    LEAFLESS_PROVEN_FULL = 1,
    /// EMPTY.
    LEAFLESS_PROVEN_EMPTY = 2,
    /// FULL and EMPTY.
    LEAFLESS_PROVEN_BOTH = 3,
}

enumeration! {
    leafless_proven => Proof {
        LEAFLESS_PROVEN_NOTHING => Proof::new(false, false),
        LEAFLESS_PROVEN_FULL => Proof::new(true, false),
        LEAFLESS_PROVEN_EMPTY => Proof::new(false, true),
        LEAFLESS_PROVEN_BOTH => Proof::new(true, true),
    }
}

/// Basic facts about an octree.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_octree_info {
    /// sizeof(leafless_octree_info).
    pub struct_size: u32,
    /// The frame: position, size and depth.
    pub frame: leafless_frame,
    /// Array elements without bricks; each holds two levels.
    pub elements: u64,
    /// Array elements of the deepest level.
    pub bricks: u64,
    /// Channels, 0 to 256: leafless_octree_channel_at returns each.
    pub channels: u64,
    /// Bytes of its arrays and its channels, in memory or in a mapped file. Memory that octrees share counts
    /// for each of them.
    pub bytes: u64,
    /// The proofs that the cells give.
    pub proof: leafless_proof,
    /// The tag of the whole universe; BRANCH if it is split.
    pub root: leafless_tag,
    /// The tag of the space outside the universe; never BRANCH.
    pub exterior: leafless_tag,
    /// Whether no cell is undecided.
    pub is_binary: bool,
    /// Whether the solid may extend beyond the universe; then volumes are those of the part inside.
    pub is_clipped: bool,
}

output!(leafless_octree_info);

/// Counts and certified volumes. The volume is that of the part inside the universe.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_statistics {
    /// Internal nodes: cells that are split.
    pub nodes: u64,
    /// EMPTY cells.
    pub empty: u64,
    /// FULL cells.
    pub full: u64,
    /// PARTIAL cells.
    pub partial: u64,
    /// Volume that is certainly solid, in finest cells.
    pub lower_cells: u64,
    /// Volume that is possibly solid, in finest cells.
    pub upper_cells: u64,
    /// Both volumes in cubic model units, rounded outward.
    pub volume_model: leafless_interval,
}

impl From<&Statistics> for leafless_statistics {
    fn from(statistics: &Statistics) -> leafless_statistics {
        let (lower_cells, upper_cells) = statistics.volume_cells();
        leafless_statistics {
            nodes: statistics.nodes(),
            empty: statistics.cells(Tag::Empty),
            full: statistics.cells(Tag::Full),
            partial: statistics.cells(Tag::Partial),
            lower_cells,
            upper_cells,
            volume_model: statistics.volume().into(),
        }
    }
}

impl From<&LevelStatistics> for leafless_statistics {
    fn from(level: &LevelStatistics) -> leafless_statistics {
        leafless_statistics {
            nodes: level.nodes,
            empty: level.empty,
            full: level.full,
            partial: level.partial,
            lower_cells: level.lower_cells,
            upper_cells: level.upper_cells,
            volume_model: level.volume.into(),
        }
    }
}

pub(super) fn give(octree: Octree) -> *mut leafless_octree {
    handle(leafless_octree { octree })
}

/// Makes the octree whose whole universe has one tag.
///
/// - Buffers: `frame`, one struct; `octree`, one pointer. `tag` and `exterior`, which must not be BRANCH, are
///   the tags of the universe and of the space around it.
/// - Result: `*octree`.
/// - Errors: LEAFLESS_E_ARGUMENT.
/// - Ownership: release `*octree` with leafless_octree_free.
/// - Untrusted input: any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_new_uniform(
    frame: *const leafless_frame,
    tag: Byte<leafless_tag>,
    exterior: Byte<leafless_tag>,
    octree: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let frame = self::frame(frame)?;
        let tag = settled_tag(tag.0.into(), "tag")?;
        let exterior = settled_tag(exterior.0.into(), "exterior")?;
        let octree = out(octree, "octree")?;
        octree.write(give(Octree::uniform(frame, tag, exterior)?))
    })
}

/// Returns one more reference to an octree.
///
/// - Buffers: `octree`, a handle; `reference`, one pointer.
/// - Result: `*reference`, equal to `octree`.
/// - Ownership: release each reference with leafless_octree_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_ref(
    octree: *const leafless_octree,
    reference: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe { refer(octree, "octree", reference) })
}

/// Releases a reference to an octree. The last release frees the octree. The mapping of its file ends too,
/// unless a cursor, a solid, or an octree with other metadata still shares it.
///
/// - Buffers: `octree`, a handle or NULL, which does nothing.
/// - Ownership: the reference is invalid afterwards.
/// - Threads: any; no other call may use this reference.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_free(octree: *mut leafless_octree) {
    // SAFETY: the caller's promise.
    unsafe { release(octree) }
}

/// Returns basic facts about an octree. O(1).
///
/// - Buffers: `info`, one struct.
/// - Result: `*info`.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_describe(
    octree: *const leafless_octree,
    info: *mut leafless_octree_info,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let view = octree.view();
        filled(info, "info")?.write(leafless_octree_info {
            struct_size: size_of::<leafless_octree_info>() as u32,
            frame: view.frame().into(),
            elements: view.element_count(),
            bricks: view.brick_count(),
            channels: octree.channels().len() as u64,
            bytes: octree.bytes(),
            proof: view.proof().into(),
            root: view.root_tag().into(),
            exterior: view.exterior().into(),
            is_binary: view.is_binary(),
            is_clipped: view.is_clipped(),
        })
    })
}

/// Returns the same octree with stated proofs; the arrays and the channels are shared. Use it for octrees
/// whose proofs another program knows. If both FULL and EMPTY are stated to be proven, the cells themselves
/// count as the solid: measures of a sampled octree are then measures of its cells, not of the sampled solid.
///
/// - Buffers: `octree`, a handle; `proven`, a leafless_proven; `displacement_model` as in leafless_proof;
///   `result`, one pointer.
/// - Result: `*result`.
/// - Errors: LEAFLESS_E_ARGUMENT if `proven` is not a leafless_proven, or the displacement is negative or not
///   finite.
/// - Ownership: release `*result` with leafless_octree_free.
/// - Untrusted input: any octree, any numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_with_proof(
    octree: *const leafless_octree,
    proven: Number<leafless_proven>,
    displacement_model: f64,
    result: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let result = out(result, "result")?;
        let Ok(proof) = proven.known("proven")?.with_displacement(displacement_model) else {
            let problem = "must be finite and not negative";
            return Err(Failure::Argument { name: "displacement_model", problem });
        };
        result.write(give(octree.with_proof(proof)))
    })
}

/// Returns counts over all levels, and the volume of the cells. O(depth) if the counts are known, as for an
/// octree from a file; for a new octree the first call takes one pass over its arrays.
///
/// - Buffers: `statistics`, one struct.
/// - Result: `*statistics`.
/// - Untrusted input: any octree; of one that was mapped unverified the numbers may be wrong.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_statistics(
    octree: *const leafless_octree,
    statistics: *mut leafless_statistics,
) -> leafless_status {
    guard(|| unsafe {
        let found = shared(octree, "octree")?.octree.statistics();
        out(statistics, "statistics")?.write((&found).into())
    })
}

/// Returns the counts of each level, and the certified volumes of the octree cut off at that level. Entry 0
/// is the universe, entry `depth` the finest cells.
///
/// - Buffers: `levels`, room for `capacity` structs, or NULL to get only the count; `count`, one number.
/// - Result: `*count`, depth + 1; the levels.
/// - Errors: LEAFLESS_E_BUFFER if the capacity is too small.
/// - Untrusted input: any octree; of one that was mapped unverified the numbers may be wrong.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_levels(
    octree: *const leafless_octree,
    levels: *mut leafless_statistics,
    capacity: u64,
    count: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let levels = buffer(levels, capacity, "levels")?;
        let count = out(count, "count")?;
        let found = octree.statistics();
        levels.fill_with(found.levels())?;
        count.write(found.levels().len() as u64)
    })
}

/// Checks that an octree is well-formed and canonical: O(n). Octrees that the library makes, opens or maps
/// verified always are. Channels are not checked; see leafless_channel_check. Checksums of files are not
/// checked; see leafless_file_verify.
///
/// - Result: LEAFLESS_OK if the octree passes.
/// - Errors: LEAFLESS_E_DAMAGED, with the first damage in the message; LEAFLESS_E_NO_MEMORY.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_check(octree: *const leafless_octree) -> leafless_status {
    guard(|| unsafe { Ok(shared(octree, "octree")?.octree.view().check()?) })
}

/// Returns whether two octrees have the same cells with the same tags and the same surfaces, on the same
/// frame. Metadata and channels are not compared. O(n).
///
/// - Buffers: `equal`, one truth value.
/// - Result: `*equal`.
/// - Untrusted input: any octrees.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_equal(
    a: *const leafless_octree,
    b: *const leafless_octree,
    equal: *mut bool,
) -> leafless_status {
    guard(|| unsafe {
        let (a, b) = (shared(a, "a")?, shared(b, "b")?);
        out(equal, "equal")?.write(a.octree == b.octree)
    })
}

/// Returns the octree with one more fact in its metadata, or with a new value of a fact; the arrays and the
/// channels are shared. Names in use: "name", "units", "source", "rule".
///
/// - Buffers: `key` and `value`, `key_length` and `value_length` bytes of UTF-8; `named`, one pointer.
/// - Result: `*named`.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_ARGUMENT if all facts would take more than 1 MiB in a file (each
///   takes 8 bytes and its two texts); LEAFLESS_E_NO_MEMORY.
/// - Ownership: the texts are copied. `*named` shares the arrays of `octree`, which may be freed. Bytes that
///   `octree` views must outlive `*named` too, and a file that it maps must stay unchanged as long. Release
///   `*named` with leafless_octree_free.
/// - Untrusted input: any texts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_with_metadata(
    octree: *const leafless_octree,
    key: *const c_char,
    key_length: usize,
    value: *const c_char,
    value_length: usize,
    named: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let named = out(named, "named")?;
        let (key, value) = ((key, key_length), (value, value_length));
        let facts = metadata::with(octree.metadata(), key, value, MetadataLimit::SOLID)?;
        named.write(give(octree.with_metadata(facts)))
    })
}

/// Returns the octree with one fact less in its metadata, or without metadata; the arrays and the channels
/// are shared.
///
/// - Buffers: `key`, `key_length` bytes of UTF-8, or NULL for all facts; `unnamed`, one pointer.
/// - Result: `*unnamed`; it is not an error if there is no such fact.
/// - Errors: LEAFLESS_E_UTF8; LEAFLESS_E_NO_MEMORY.
/// - Ownership: as leafless_octree_with_metadata.
/// - Untrusted input: any texts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_without_metadata(
    octree: *const leafless_octree,
    key: *const c_char,
    key_length: usize,
    unnamed: *mut *mut leafless_octree,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let unnamed = out(unnamed, "unnamed")?;
        unnamed.write(give(octree.with_metadata(metadata::without(octree.metadata(), key, key_length)?)))
    })
}

/// Returns the value of a fact in an octree's metadata.
///
/// - Buffers: `key`, `key_length` bytes of UTF-8; `value` and `value_length`, one each.
/// - Result: `*value`, not NUL-terminated; NULL if there is no such fact. `*value_length`, in bytes.
/// - Errors: LEAFLESS_E_UTF8.
/// - Ownership: the text belongs to the octree and lives as long as the reference `octree`.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_peek_metadata(
    octree: *const leafless_octree,
    key: *const c_char,
    key_length: usize,
    value: *mut *const c_char,
    value_length: *mut usize,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        metadata::peek(octree.metadata(), key, key_length, value, value_length)
    })
}

/// Returns a fact of an octree's metadata by its index. Facts are sorted by key.
///
/// - Buffers: `count`, one number; `key`, `key_length`, `value`, `value_length`, one each, all four NULL to
///   get only the count.
/// - Result: `*count`, the number of all facts; key and value, not NUL-terminated, with their lengths in
///   bytes.
/// - Errors: LEAFLESS_E_ARGUMENT if there is no fact `index`, unless only the count is requested.
/// - Ownership: the texts belong to the octree and live as long as the reference `octree`.
/// - Untrusted input: any octree.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_octree_peek_metadata_at(
    octree: *const leafless_octree,
    index: u64,
    count: *mut u64,
    key: *mut *const c_char,
    key_length: *mut usize,
    value: *mut *const c_char,
    value_length: *mut usize,
) -> leafless_status {
    guard(|| unsafe {
        let octree = &shared(octree, "octree")?.octree;
        let fact = Fact { key, key_length, value, value_length };
        metadata::peek_at(octree.metadata(), index, count, fact)
    })
}
