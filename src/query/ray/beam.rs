//! Rays that run side by side: one search finds the common part of their paths on which nothing stops them.

use super::course::{Clear, Course};
use crate::lattice::Each;
use crate::lattice::Frame;
use crate::lattice::axes;
use crate::lattice::morton::{self, SLABS};
use crate::octree::links::Step;
use crate::octree::view::{OctreeRef, root_cells};
use crate::octree::{Planes, Tag};

/// The number of rays in a beam.
pub(super) const RAYS: usize = 32;

/// The maximal number of elements that a beam visits. More elements do not pay for a beam that grazes a
/// surface.
const MOST_ELEMENTS: u32 = 48;

/// Rays that run side by side, in lattice coordinates that are mirrored so that no coordinate decreases.
pub(super) struct Beam {
    /// The axis along which the rays run fastest.
    axis: usize,
    /// The other axes.
    across: [usize; 2],
    falls: [bool; 3],
    cells: f64,
    /// The plane of the axis before which no ray begins.
    start: f64,
    /// The lower bound of the place where the plane u of the axis is passed: `low[0] + u low[1]` on each axis
    /// across.
    low: [[f64; 2]; 2],
    /// The upper bound, in the same form.
    high: [[f64; 2]; 2],
    /// The edge of cells that are too small to visit.
    edge: f64,
}

/// The greatest width of a beam, as a share of the universe.
const WIDEST: f64 = 0.125;

/// The greatest coordinate of a beam. It is far enough, and half a cell is far more than its rounding errors.
const FARTHEST: f64 = (1u64 << 40) as f64;

impl Beam {
    /// Returns the beam of some rays, or `None` if they do not run side by side.
    #[inline(always)]
    pub(super) fn of(courses: &[Course; RAYS], frame: &Frame) -> Option<Beam> {
        let first = &courses[0];
        if courses.iter().any(|course| course.mirror != first.mirror) {
            return None;
        }
        let [x, y, z, _] = first.speed;
        let axis = if x >= y && x >= z {
            0
        } else if y >= z {
            1
        } else {
            2
        };
        let across = [[1, 2], [0, 2], [0, 1]][axis];
        let mut start = f64::INFINITY;
        let mut ranges = [[[f64::INFINITY, f64::NEG_INFINITY]; 2]; 2];
        let mut reach = 0.0f64;
        for course in courses {
            start = start.min(course.from[axis]);
            for (range, other) in ranges.iter_mut().zip(across) {
                let slope = course.speed[other] * course.slowness[axis];
                let place = course.from[other] - course.from[axis] * slope;
                reach = reach.max(course.from[other].abs()).max((course.from[axis] * slope).abs());
                for (range, value) in range.iter_mut().zip([place, slope]) {
                    *range = [range[0].min(value), range[1].max(value)];
                }
            }
        }
        let cells = f64::from(frame.cells());
        let width = |range: &[[f64; 2]; 2]| range[0][1] - range[0][0] + cells * (range[1][1] - range[1][0]);
        let width = width(&ranges[0]).max(width(&ranges[1]));
        // The half cell that is added on each side exceeds the rounding errors, which are relative to the
        // greatest of the numbers.
        let [low, high] = [0, 1].each(|end| {
            let pad = if end == 0 { -0.5 } else { 0.5 };
            ranges.each(|[place, slope]| [place[end] + pad, slope[end]])
        });
        (width < WIDEST * cells && reach < FARTHEST).then_some(Beam {
            axis,
            across,
            falls: axes(|axis| first.falls(axis)),
            cells,
            start: (start - 1.0).max(0.0),
            low,
            high,
            edge: 0.5 * width,
        })
    }

    /// Returns the region where nothing stops any of the rays.
    pub(super) fn clear(&self, tree: &OctreeRef<'_>) -> Clear {
        match tree.root {
            Tag::Empty => Clear { axis: self.axis, until: f64::INFINITY },
            Tag::Full | Tag::Partial => Clear::UNKNOWN,
            Tag::Branch => {
                let mut search = Search { beam: self, tree, until: f64::INFINITY, left: MOST_ELEMENTS };
                search.visit(0, 0, [0; 3]);
                Clear { axis: self.axis, until: search.until }
            }
        }
    }

    /// Returns the cells of an element that the beam may meet between two planes of its axis: the first and
    /// the last of them along each axis across. The element begins at `corner`, and its cells have the edge
    /// `edge`.
    #[inline(always)]
    fn across(&self, near: f64, far: f64, corner: [u32; 3], edge: f64) -> Option<[[usize; 2]; 2]> {
        let mut range = [[0; 2]; 2];
        for (k, axis) in self.across.into_iter().enumerate() {
            let low = self.low[k][0] + near * self.low[k][1];
            let high = self.high[k][0] + far * self.high[k][1];
            let [low, high] =
                if self.falls[axis] { [self.cells - high, self.cells - low] } else { [low, high] };
            let corner = f64::from(corner[axis]);
            if high < corner || low > corner + 4.0 * edge {
                return None;
            }
            // The conversion turns negative numbers into 0.
            range[k] = [low, high].each(|place| (((place - corner) / edge) as usize).min(3));
        }
        Some(range)
    }
}

/// The search for the first cells that a beam meets.
struct Search<'s, 'a> {
    beam: &'s Beam,
    tree: &'s OctreeRef<'a>,
    until: f64,
    /// The number of elements that may still be visited.
    left: u32,
}

impl Search<'_, '_> {
    /// Visits an element of a level that begins at `corner`. The recursion is as deep as there are levels.
    fn visit(&mut self, level: usize, index: usize, corner: [u32; 3]) {
        let (beam, tree) = (self.beam, self.tree);
        let mut planes = tree.entry(index).unwrap_or(Planes::uniform(Tag::Partial));
        if level == 0 {
            planes = planes.masked(root_cells(tree.frame.depth()));
        }
        let shift = 2 * (tree.levels() - 1 - level) as u32;
        let edge = f64::from(1u32 << shift);
        let axis = beam.axis;
        for step in 0..4 {
            let k = if beam.falls[axis] { 3 - step } else { step };
            let low = f64::from(corner[axis]) + k as f64 * edge;
            let near = if beam.falls[axis] { beam.cells - (low + edge) } else { low };
            let far = near + edge;
            if far <= beam.start {
                continue;
            }
            let near = near.max(beam.start);
            if near >= self.until {
                return;
            }
            let Some([[a, b], [c, d]]) = beam.across(near, far, corner, edge) else { continue };
            let met = SLABS[axis][k][k] & SLABS[beam.across[0]][a][b] & SLABS[beam.across[1]][c][d];
            let stops = (planes.lower | planes.upper) & met;
            let branches = planes.branch() & met;
            if stops == 0 {
                continue;
            } else if stops != branches || edge <= beam.edge {
                self.until = near;
                return;
            }
            let mut rest = branches;
            while rest != 0 && self.until > near {
                let c = rest.trailing_zeros();
                rest &= rest - 1;
                match tree.step(level, index, planes, c) {
                    Step::Into(child) if self.left > 0 => {
                        self.left -= 1;
                        let [x, y, z] = morton::position(c);
                        let at = [x, y, z].each(|k| k << shift);
                        self.visit(level + 1, child, axes(|axis| corner[axis] + at[axis]));
                    }
                    _ => self.until = near,
                }
            }
        }
    }
}
