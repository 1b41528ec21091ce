//! A march through the cells of a stored octree along a ray, two levels a step.

use super::Ray;
use super::course::{Clear, Course, Start};
use super::search::Met;
use super::way::Way;
use crate::lattice::Cell;
use crate::lattice::Each;
use crate::octree::Tag;

/// The first cells that stop a ray.
pub(super) struct March {
    /// The first cell that is not EMPTY, and the approximate time when the ray meets it.
    pub(super) outer: Option<(Met, f64)>,
    /// The first cell that is FULL.
    pub(super) inner: Option<Met>,
}

impl March {
    /// Follows a ray that nothing stops where it is `clear`, to the first FULL cell, or only to the first
    /// cell that is not EMPTY. `None` if rounding errors may change the result.
    #[inline(always)]
    pub(super) fn run(
        way: &mut Way<'_, '_>,
        ray: &Ray,
        course: &Course,
        clear: Clear,
        to_full: bool,
    ) -> Option<March> {
        let tree = way.tree;
        let frame = &tree.frame;
        let mut march = March { outer: None, inner: None };
        let start = match course.start(frame, ray.last) {
            Start::At(at, by) => course.skip(frame, ray.last, (at, by), clear),
            other => other,
        };
        let (mut at, mut by) = match start {
            Start::Beside => return Some(march),
            Start::At(at, by) => (at, by),
            Start::Unsure => return None,
        };
        loop {
            let place = [0, 1, 2, 3].each(|axis| at[axis] ^ course.mirror[axis]);
            let (tag, mut shift, c) = way.to(place);
            let planes = way.planes;
            if tag != Tag::Empty {
                let shift = shift + (tree.root == Tag::Branch && planes.octant(c >> 3) == tag) as u32;
                let cell = Cell {
                    level: frame.depth() - shift as u8,
                    at: [place[0], place[1], place[2]].each(|a| a >> shift),
                };
                let plane = |axis: usize| {
                    if course.mirror[axis] == 0 { at[axis] } else { frame.cells() - at[axis] }
                };
                let met = (cell, by.map(|axis| (axis, plane(axis))));
                if march.outer.is_none() {
                    march.outer = Some((met, by.map_or(0.0, |axis| course.time(axis, at[axis]))));
                }
                if tag == Tag::Full {
                    march.inner = Some(met);
                }
                if tag == Tag::Full || !to_full {
                    return Some(march);
                }
            }
            if tree.root == Tag::Branch {
                // Skip the octant, or all of the element, if nothing on the ray's further path through it can
                // stop the ray.
                let ahead = course.ahead(place, shift);
                let stops = if march.outer.is_none() { planes.lower | planes.upper } else { planes.lower };
                let octant = 0xFF << (c & !7);
                shift += (stops & ahead & octant == 0) as u32 + (stops & ahead == 0) as u32;
            }
            // Leave the cell by the plane that is passed first.
            let (far, times) = course.leaves(at, shift);
            let [x, y, z, _] = times.to_array();
            let least_of_two = if x < y { x } else { y };
            let t = if z < least_of_two { z } else { least_of_two };
            let passed = times.simd_eq(t);
            let axes = passed.to_bitmask();
            let axis = (axes >> 1) as usize;
            let error = course.time_error[axis & 3];
            let goes_on = t < ray.last - error;
            if !goes_on {
                return (t > ray.last + error).then_some(march);
            }
            let (cell, sure) = course.cells(t, error);
            if !axes.is_power_of_two() || !(sure | passed).all() {
                return None;
            }
            let next = Course::integers(passed.select(far, cell));
            let changed = (next[0] ^ at[0]) | (next[1] ^ at[1]) | (next[2] ^ at[2]);
            at = next;
            if changed >= frame.cells() {
                return Some(march);
            }
            by = Some(axis);
        }
    }
}
