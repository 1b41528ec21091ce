//! A program without the standard library. It has only an allocator and a way to stop.
//!
//! It builds two solids, combines them and queries points. Its exit code says which step was wrong.

#![no_std]
#![no_main]

use core::alloc::{GlobalAlloc, Layout};
use core::ffi::{c_int, c_void};
use leafless::query::{PointCursor, Region};
use leafless::{AnySolid, Control, Csg, Error, Frame, Membership, Rule, build, compact, difference};

// The C library stands for the allocator and the start-up code that an embedded target would bring.
#[link(name = "c")]
unsafe extern "C" {
    fn aligned_alloc(align: usize, size: usize) -> *mut c_void;
    fn free(memory: *mut c_void);
    fn abort() -> !;
}

struct Heap;

// SAFETY: `aligned_alloc` returns memory of the requested size and alignment, or null, and `free` takes it
// back.
unsafe impl GlobalAlloc for Heap {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // The alignment must be at least that of a pointer, and the size a multiple of the alignment.
        let align = layout.align().max(size_of::<usize>());
        // SAFETY: a power of two, and a size rounded up to its multiple.
        unsafe { aligned_alloc(align, layout.size().next_multiple_of(align)).cast() }
    }

    unsafe fn dealloc(&self, memory: *mut u8, _: Layout) {
        // SAFETY: it came from `alloc`.
        unsafe { free(memory.cast()) }
    }
}

#[global_allocator]
static HEAP: Heap = Heap;

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: it has no preconditions.
    unsafe { abort() }
}

/// The ready-made `alloc` was compiled to unwind and names this routine of `std`. Panics abort here, so
/// nothing ever calls it.
#[unsafe(no_mangle)]
extern "C" fn rust_eh_personality() {}

fn run() -> Result<c_int, Error> {
    let control = Control::default();
    let frame = Frame::new([-1.0; 3], 2.0, 7)?;
    let block = AnySolid::new(Csg::cuboid([-0.75; 3], [0.75; 3])?);
    let block = build(&block, &frame, Rule::Certified, &control)?;
    let ball = build(&Csg::ball([0.0; 3], 0.9)?, &frame, Rule::Certified, &control)?;
    let part = compact(difference(block.view(), ball.view(), &control)?.view())?;
    if part.view().check().is_err() {
        return Ok(2);
    }
    if part.contains([0.0; 3]) != Membership::Outside || part.contains([0.74; 3]) != Membership::Inside {
        return Ok(3);
    }
    let mut cursor = PointCursor::new(part.view());
    if cursor.contains([0.74, -0.74, 0.74]) != Membership::Inside {
        return Ok(4);
    }
    if part.classify_box([-0.1; 3], [0.1; 3])? != Region::Outside {
        return Ok(5);
    }
    let volume = part.statistics().volume();
    if !(volume.lower < 0.68187 && 0.68187 < volume.upper) {
        return Ok(6);
    }
    // 42 rather than 0: a program that did nothing would return 0 as well.
    Ok(42)
}

#[unsafe(no_mangle)]
extern "C" fn main(_: c_int, _: *const *const u8) -> c_int {
    run().unwrap_or(1)
}
