//! A mesh on a frame, and the state of its cells.

use super::crossing::Projection;
use super::layers::Layers;
use super::placed::Placed;
use super::winding::Caps;
use crate::lattice::Each;
use crate::lattice::exact::floor;
use crate::mesh::FillRule;
use crate::octree::Tag;
use crate::solid::Verdict;
use alloc::vec::Vec;
use once_cell::race::OnceBox;

/// A mesh on the lattice of a frame, with properties of the universe.
pub(super) struct MeshOnFrame {
    pub(super) placed: Placed,
    pub(super) caps: Caps,
    pub(super) fill: FillRule,
    /// The triangles that cut the universe, in ascending order, and the winding number of its lowest centre.
    pub(super) roots: Vec<u32>,
    pub(super) winding: i32,
    /// The tag of the space around the universe. Computed on first use.
    pub(super) exterior: OnceBox<Tag>,
    /// The planes of the mesh. Computed on first use.
    pub(super) layers: OnceBox<Layers>,
}

/// The state of a cell: the triangles that cut it, and the winding number of its lowest centre.
#[derive(Debug, Clone, Copy)]
pub struct MeshPart {
    /// The range of its triangles in the scratch memory.
    pub(super) first: usize,
    pub(super) count: usize,
    /// The winding number of the surface with its caps; of the surface alone if `caps` is `None`.
    pub(super) winding: i32,
    /// The branch of the caps' winding number, which is not an integer. `None` if the surface's own winding
    /// number rounds to `winding` throughout the cell, except for the changes at the triangles that cut the
    /// cell. Without caps, always `None`.
    pub(super) caps: Option<Branch>,
}

/// The value of the caps' winding number at a cell's lowest centre: one branch of a multivalued function.
#[derive(Debug, Clone, Copy)]
pub(super) struct Branch {
    /// The level of the enclosing cell whose expansion gives the value.
    pub(super) level: u8,
    /// The integer to add to that value.
    pub(super) step: i32,
}

impl Branch {
    /// No value is known.
    pub(super) const UNKNOWN: Branch = Branch { level: u8::MAX, step: 0 };

    /// The branch beyond caps that change the number by `jump`.
    pub(super) fn plus(self, jump: i32) -> Branch {
        Branch { step: self.step + jump, ..self }
    }
}

impl MeshPart {
    /// The part of a cell of which only one number is known: the winding number of its lowest centre, for the
    /// surface with its caps.
    pub(super) fn unknown(winding: i32) -> MeshPart {
        MeshPart { first: 0, count: 0, winding, caps: Some(Branch::UNKNOWN) }
    }
}

impl MeshOnFrame {
    /// Decides exactly whether no triangle lies in a plane between cells, or in a face of the universe.
    pub(super) fn has_no_triangle_in_planes(&self) -> bool {
        let frame = &self.placed.frame;
        let near = -1..=i64::from(frame.cells()) + 1;
        // Triangles in a face of the universe cross none of its cells.
        (0..self.placed.count()).all(|triangle| {
            let corners = self.placed.original(triangle);
            (0..3).all(|axis| {
                let [a, b, c] = corners.each(|corner| corner[axis]);
                let plane = floor(frame.scaled(axis, a) + 0.5);
                let is_flat = a == b && b == c;
                !is_flat || !near.contains(&plane) || frame.side(axis, a, 2 * plane) != 0
            })
        })
    }

    pub(super) fn closed_verdict(&self, part: MeshPart) -> Verdict<MeshPart> {
        if part.count > 0 {
            Verdict::Partial(part)
        } else if self.fill.encloses(part.winding) {
            Verdict::Full
        } else {
            Verdict::Empty
        }
    }

    /// Adds to `steps` the changes of the winding number by a triangle, on the ways along x, y and z to the
    /// lowest centres of a cell's children of edge `half`. `steps` is indexed by the child to which a way
    /// leads.
    #[inline]
    pub(super) fn pierce(
        &self,
        triangle: u32,
        [low, high]: [[i32; 3]; 2],
        at: [i32; 3],
        half: i32,
        steps: &mut [[i32; 8]; 2],
    ) {
        let next = at.each(|a| a + half);
        let spans = |axis: usize, k: i32| low[axis] <= k && k < high[axis];
        // The way along an axis leads from `at` to `next`: it passes the triangle between two ranks.
        let reaches = |axis: usize| low[axis] <= next[axis] && high[axis] > at[axis];
        let mut pierce = |w: usize, u: i32, v: i32, child: usize| {
            let mut seen = Projection::new(&self.placed, triangle, self.placed.corners(triangle), w);
            if let Some(span) = seen.span(v).filter(|span| span.first <= u && u < span.end) {
                let above = seen.above(u, v, span.step);
                if at[w] < above && above <= next[w] {
                    steps[0][child] += span.step;
                    if self.placed.is_cap(triangle) {
                        steps[1][child] += span.step;
                    }
                }
            }
        };
        let [x, y, z] = at;
        if reaches(0) && spans(1, y) && spans(2, z) {
            pierce(0, y, z, 1);
        }
        if reaches(1) && spans(2, z) {
            for (child, x) in [(2, x), (3, next[0])] {
                if spans(0, x) {
                    pierce(1, x, z, child);
                }
            }
        }
        if reaches(2) {
            for (child, x, y) in [(4, x, y), (5, next[0], y), (6, x, next[1]), (7, next[0], next[1])] {
                if spans(0, x) && spans(1, y) {
                    pierce(2, x, y, child);
                }
            }
        }
    }
}
