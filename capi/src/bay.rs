//! Bays: a container, obstacles, items and their orientations.

use super::boundary::{Failure, Sized32, discard, exclusive, guard, out, shared, sized, slice};
use super::csg::placement;
use super::number::{Number, enumeration};
use super::solid::leafless_solid;
use super::status::leafless_status;
use leafless::layout::{Bay, Item, Orientations};
use leafless::memory;

/// A container, obstacles and items, from which leafless_layout_new makes a layout. One thread at a time may
/// fill it.
pub struct leafless_bay(pub(super) Bay);

/// The orientations that an item may take.
#[derive(Clone, Copy)]
#[repr(u32)]
pub enum leafless_orientations {
    /// The 24 rotations that take axes to axes. They are exact.
    LEAFLESS_ORIENTATIONS_TURNS = 0,
    /// Only the given orientation.
    LEAFLESS_ORIENTATIONS_AS_GIVEN = 1,
    /// The given orientation, and `free_count` random rotations, distributed uniformly over all rotations.
    /// They depend on the seed of the search.
    LEAFLESS_ORIENTATIONS_FREE = 2,
    /// The linear parts M of `matrices`.
    LEAFLESS_ORIENTATIONS_LIST = 3,
}
use leafless_orientations::*;

enumeration!(leafless_orientations => leafless_orientations {
    LEAFLESS_ORIENTATIONS_TURNS => LEAFLESS_ORIENTATIONS_TURNS,
    LEAFLESS_ORIENTATIONS_AS_GIVEN => LEAFLESS_ORIENTATIONS_AS_GIVEN,
    LEAFLESS_ORIENTATIONS_FREE => LEAFLESS_ORIENTATIONS_FREE,
    LEAFLESS_ORIENTATIONS_LIST => LEAFLESS_ORIENTATIONS_LIST,
});

/// Options of an item.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct leafless_item_options {
    /// sizeof(leafless_item_options).
    pub struct_size: u32,
    /// A leafless_orientations: how a search may turn the item.
    pub orientations: Number<leafless_orientations>,
    /// Mass per cubic model unit, a positive number; 0 means 1.
    pub density: f64,
    /// For LEAFLESS_ORIENTATIONS_LIST: `matrix_count` times 12 numbers, the rows of [M | t]. M must be a
    /// rotation: it must not mirror, nor change lengths by more than 10^-9 of them.
    pub matrices: *const f64,
    /// For LEAFLESS_ORIENTATIONS_LIST: number of matrices, 1 to 4096.
    pub matrix_count: u64,
    /// For LEAFLESS_ORIENTATIONS_FREE: number of random rotations, 1 to 4096.
    pub free_count: u32,
    /// Reserved; 0.
    pub reserved: u32,
}

// SAFETY: numbers and a pointer.
unsafe impl Sized32 for leafless_item_options {}

/// Refuses a field that should be zero and is not.
fn unused(is_unused: bool, name: &'static str, problem: &'static str) -> Result<(), Failure> {
    if is_unused { Ok(()) } else { Err(Failure::Argument { name, problem }) }
}

impl leafless_item_options {
    /// # Safety
    /// `matrices` is NULL or misaligned, or points to `matrix_count` matrices.
    unsafe fn orientations(&self) -> Result<Orientations, Failure> {
        unused(self.reserved == 0, "item.reserved", "must be 0")?;
        let orientations = self.orientations.known("item.orientations")?;
        let is_list = matches!(orientations, LEAFLESS_ORIENTATIONS_LIST);
        let is_free = matches!(orientations, LEAFLESS_ORIENTATIONS_FREE);
        let problem = "is for LEAFLESS_ORIENTATIONS_LIST only";
        unused(is_list || self.matrices.is_null(), "item.matrices", problem)?;
        unused(is_list || self.matrix_count == 0, "item.matrix_count", problem)?;
        let problem = "is for LEAFLESS_ORIENTATIONS_FREE only";
        unused(is_free || self.free_count == 0, "item.free_count", problem)?;
        Ok(match orientations {
            LEAFLESS_ORIENTATIONS_TURNS => Orientations::Turns,
            LEAFLESS_ORIENTATIONS_AS_GIVEN => Orientations::AsGiven,
            LEAFLESS_ORIENTATIONS_FREE => Orientations::Free(self.free_count),
            LEAFLESS_ORIENTATIONS_LIST => {
                // SAFETY: the caller's promise.
                let matrices: &[[f64; 12]] =
                    unsafe { slice(self.matrices.cast(), self.matrix_count, "item.matrices")? };
                let mut maps = memory::with_capacity(matrices.len())?;
                for matrix in matrices {
                    // SAFETY: 12 numbers.
                    maps.push(unsafe { placement(matrix.as_ptr())? });
                }
                Orientations::List(maps)
            }
        })
    }
}

/// Checks a distance to keep. Errors use the name of the host's parameter.
fn distance(value: f64, name: &'static str) -> Result<f64, Failure> {
    match (0.0..=Bay::FURTHEST).contains(&value) {
        true => Ok(value),
        false => Err(Failure::Argument { name, problem: "must be a number between 0 and 2^64" }),
    }
}

/// Makes a bay with a container, without obstacles and items. The container is any bounded solid.
///
/// - Buffers: `bay`, one pointer. `clearance_model` is the least distance between two items, and between an
///   item and an obstacle; `wall_clearance_model` is the least distance between an item and the outside of
///   the container. Both are in model units.
/// - Result: `*bay`.
/// - Errors: LEAFLESS_E_ARGUMENT if a distance is not between 0 and 2^64; if the container has no bounds, or
///   no extent along an axis.
/// - Ownership: the bay shares the container, which may be freed; release `*bay` with leafless_bay_free.
/// - Untrusted input: any solid and numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_bay_new(
    container: *const leafless_solid,
    clearance_model: f64,
    wall_clearance_model: f64,
    bay: *mut *mut leafless_bay,
) -> leafless_status {
    guard(|| unsafe {
        let container = shared(container, "container")?.solid.solid().clone();
        let clearance = distance(clearance_model, "clearance_model")?;
        let wall_clearance = distance(wall_clearance_model, "wall_clearance_model")?;
        let made = Bay::new(container)?.with_clearances(clearance, wall_clearance)?;
        let bay = out(bay, "bay")?;
        bay.write(Box::into_raw(Box::new(leafless_bay(made))))
    })
}

/// Releases a bay. Layouts that were made from it stay.
///
/// - Buffers: `bay`, a handle or NULL, which does nothing.
/// - Ownership: the handle is invalid afterwards.
/// - Threads: no other call may use the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_bay_free(bay: *mut leafless_bay) {
    // SAFETY: the caller's promise.
    unsafe { discard(bay) }
}

/// Adds an obstacle: a solid with a fixed position that items must keep away from.
///
/// - Buffers: `number`, one number.
/// - Result: `*number`, the number of the obstacle in leafless_neighbour, counted from 0.
/// - Errors: LEAFLESS_E_ARGUMENT if the solid has no bounds, or no extent along an axis;
///   LEAFLESS_E_NO_MEMORY.
/// - Ownership: the bay shares the solid, which may be freed.
/// - Threads: any, but no other call may use the bay.
/// - Untrusted input: any solid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_bay_add_obstacle(
    bay: *mut leafless_bay,
    solid: *const leafless_solid,
    number: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let solid = shared(solid, "solid")?.solid.solid().clone();
        let number = out(number, "number")?;
        number.write(exclusive(bay, "bay")?.0.add_obstacle(solid)? as u64)
    })
}

/// Adds an item: a solid of which leafless_layout_search places `count` copies. leafless_layout_place places
/// any number of copies.
///
/// - Buffers: `item`, one struct or NULL, which means 24 rotations and a density of 1; `number`, one number.
/// - Result: `*number`, the number of the item for leafless_layout_place, counted from 0.
/// - Errors: LEAFLESS_E_ARGUMENT if the solid has no bounds, or no extent along an axis; if a field of `item`
///   is not a member of its enumeration, or is set though it is not used; if the density is neither 0 nor a
///   positive number; if a matrix is not a rotation, or a required matrix is missing; LEAFLESS_E_NO_MEMORY.
/// - Ownership: the bay shares the solid, which may be freed. It copies the matrices.
/// - Threads: any, but no other call may use the bay.
/// - Untrusted input: any solid and numbers. A search takes memory for the cells of each orientation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn leafless_bay_add_item(
    bay: *mut leafless_bay,
    solid: *const leafless_solid,
    count: u32,
    item: *const leafless_item_options,
    number: *mut u64,
) -> leafless_status {
    guard(|| unsafe {
        let solid = shared(solid, "solid")?.solid.solid().clone();
        let options = sized(item, "item")?;
        let number = out(number, "number")?;
        let mut item = Item::new(solid)?.with_count(count).with_orientations(options.orientations()?)?;
        if options.density != 0.0 {
            item = item.with_density(options.density)?;
        }
        number.write(exclusive(bay, "bay")?.0.add_item(item)? as u64)
    })
}
