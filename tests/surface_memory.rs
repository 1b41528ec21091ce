//! How much memory the extraction of a surface takes beside the mesh. The only test of its program: others
//! would allocate at the same time.

mod common;

use common::alone;
use leafless::{Csg, Frame, Rule, Snap, TriangleMesh, build, marching_cubes, smc};
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// The system's allocator with a count of bytes.
struct Counting;

static NOW: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

fn add(bytes: usize) {
    MOST.fetch_max(NOW.fetch_add(bytes, Relaxed) + bytes, Relaxed);
}

unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        add(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Both at once, as if it were copied.
        add(size);
        NOW.fetch_sub(layout.size(), Relaxed);
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

#[test]
fn a_fifth_of_the_mesh_at_the_most() {
    let frame = Frame::new([-1.0; 3], 2.0, 8).unwrap();
    let tree = build(&Csg::ball([0.01, 0.02, 0.03], 0.9).unwrap(), &frame, Rule::Sampled, &alone()).unwrap();
    let measured = |extract: &dyn Fn() -> TriangleMesh| {
        let before = NOW.load(Relaxed);
        MOST.store(before, Relaxed);
        let mesh = extract();
        let bytes = 24 * mesh.vertices().len() + 12 * mesh.triangles().len();
        let part = (MOST.load(Relaxed) - before) as f64 / bytes as f64;
        println!("{} triangles: {part:.3} of the mesh", mesh.triangles().len());
        part
    };
    assert!(measured(&|| marching_cubes(tree.view(), None, &alone()).unwrap()) < 1.2);
    assert!(measured(&|| smc(tree.view(), Snap::Fat, None, &alone()).unwrap()) < 1.5);
}
