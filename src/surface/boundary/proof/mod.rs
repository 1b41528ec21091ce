//! How far a mesh and the boundary of a solid are from each other, by the surfaces that the solid is made of: a proof that does not depend
//! on how the mesh was made.
//!
//! From the bottom up: `local` (functions about a place), `clip`, `truth` (what the leaves say), `witness` (from the mesh to the
//! boundary), `sheets` (from the boundary to the mesh).

mod clip;
mod local;
mod sheets;
mod truth;
mod witness;

use super::figures::{Figures, length, minus};
use super::leaves::{Leaf, Leaves, OpenLeaf};
use super::mates::mates;
use crate::control::Job;
use crate::error::Error;
use crate::lattice::{Cell, Frame, axes};
use crate::memory;
use crate::mesh::TriangleMesh;
use alloc::vec::Vec;
use local::Local;
use sheets::{Sheet, Subject};
use truth::{Around, Truth, cube};
use witness::Witnesses;

/// Parts of a cell that are looked at where nothing but their extent is known.
const PARTS: u32 = 64;

/// Boxes beyond those that any cell may take, and 64 for each cell.
const MORE: u32 = 1 << 15;

/// What is proven.
pub(super) struct Proof {
    /// No point of either is further from the other than that (edges of the universe).
    pub(super) most: f64,
    /// The cells in which it is more than the tolerance.
    pub(super) beyond: Vec<Cell>,
}

/// Proves how far a mesh is from the boundary of the solid that the leaves know. `vertices` and `triangles` are those of the mesh, in unit
/// coordinates.
pub(super) fn prove(
    leaves: &Leaves,
    figures: &Figures,
    mesh: &TriangleMesh,
    surfaces: &[u32],
    (frame, tolerance): (&Frame, f64),
    job: &Job<'_>,
) -> Result<Proof, Error> {
    let truth = Truth { leaves, figures };
    let origin = frame.origin();
    let edge = frame.edge();
    let vertices = memory::collected(
        mesh.vertices().iter().map(|v| -> [f64; 3] { axes(|k| (v[k] - origin[k]) / edge) }),
    )?;
    let triangles = mesh.triangles();
    let mut proof = Proof { most: 0.0, beyond: Vec::new() };
    let mut witnesses = Witnesses::new(&truth, tolerance);
    // A corner of each triangle that is proven to be near, and how near.
    let mut near = Vec::new();
    let mut lost = Vec::new();
    for (triangle, &surface) in triangles.iter().zip(surfaces) {
        let corners = triangle.map(|v| vertices[v as usize]);
        let mut all: f64 = 0.0;
        witnesses.triangle(corners, surface, &mut |cell, most| {
            all = all.max(most);
            if most.is_finite() {
                proof.add(cell, most, tolerance)
            } else {
                memory::push(&mut lost, (cell, corners))
            }
        })?;
        if all.is_finite() {
            memory::push(&mut near, (corners[0], all))?;
        }
    }
    // The others are as near as the way to one of these.
    for (cell, [a, b, c]) in lost {
        let long = length(minus(b, a)).max(length(minus(c, a)));
        let ways = near.iter().map(|&(corner, most)| length(minus(corner, a)) + long + most);
        proof.add(cell, ways.fold(f64::INFINITY, f64::min), tolerance)?;
    }
    job.check()?;
    let Some(mates) = mates(triangles)? else {
        proof.most = f64::INFINITY;
        return Ok(proof);
    };
    let tree = mesh.triangle_tree(job.control())?;
    let subject = Subject { vertices: &vertices, triangles, surfaces, mates, tree, origin, edge };
    let mut more = MORE + 64 * leaves.open.len().min(1 << 20) as u32;
    for leaf in &leaves.open {
        let mut most: Option<f64> = Some(0.0);
        if let Some(open) = leaf.open {
            for place in 0..open.indices().len() {
                for is_above in [false, true] {
                    let which = (place, is_above);
                    let own =
                        Sheet::new(&subject, figures, &open, which, leaf.cell, tolerance).away(&mut more)?;
                    most = most.zip(own).map(|(a, b)| a.max(b));
                }
            }
        } else {
            most = None;
        }
        let most = match most {
            Some(most) => most,
            None => far(&subject, figures, leaf, &cube(leaf.cell), tolerance, &mut { PARTS })?,
        };
        proof.add(leaf.cell, most, tolerance)?;
    }
    contacts(&truth, &subject, (Cell::ROOT, leaves.root), &mut Vec::new(), &mut |cell, most| {
        proof.add(cell, most, tolerance)
    })?;
    Ok(proof)
}

/// Calls `told` for the cells that are full next to an empty one, where the boundary lies in no cell between, with how far it is from the
/// mesh there at most.
fn contacts(
    truth: &Truth<'_>,
    subject: &Subject<'_>,
    (cell, leaf): (Cell, Leaf),
    found: &mut Vec<(Cell, Leaf)>,
    told: &mut impl FnMut(Cell, f64) -> Result<(), Error>,
) -> Result<(), Error> {
    if let Leaf::Branch(node) = leaf {
        for (octant, &child) in (0u8..).zip(&truth.leaves.nodes[node as usize]) {
            contacts(truth, subject, (cell.child(octant), child), found, told)?;
        }
    }
    if !matches!(leaf, Leaf::Full) {
        return Ok(());
    }
    let own = cube(cell);
    for side in 0..6 {
        let (axis, is_upper) = (side / 2, side % 2 == 1);
        // What lies behind the inside of the face. (No cell is as small as `LEAST`.)
        let mut behind = own.grown(-truth::LEAST);
        let face = if is_upper { own.high[axis] } else { own.low[axis] };
        let away = if is_upper { truth::LEAST } else { -truth::LEAST };
        (behind.low[axis], behind.high[axis]) = (face + away, face + away);
        truth.meeting(&behind, found)?;
        for &(other, leaf) in &*found {
            let other = match leaf {
                Leaf::Empty => cube(other),
                Leaf::Outside => own,
                _ => continue,
            };
            let shared = Around {
                low: axes(|k| if k == axis { face } else { own.low[k].max(other.low[k]) }),
                high: axes(|k| if k == axis { face } else { own.high[k].min(other.high[k]) }),
            };
            told(cell, subject.away(&shared))?;
        }
    }
    Ok(())
}

impl Proof {
    fn add(&mut self, cell: Cell, most: f64, tolerance: f64) -> Result<(), Error> {
        self.most = self.most.max(most);
        if most.is_nan() || most > tolerance {
            memory::push(&mut self.beyond, cell)?;
        }
        Ok(())
    }
}

/// How far the boundary is from the mesh in a part of a cell, by the part's extent.
fn far(
    subject: &Subject<'_>,
    figures: &Figures,
    leaf: &OpenLeaf,
    part: &Around,
    tolerance: f64,
    parts: &mut u32,
) -> Result<f64, Error> {
    let centre = part.centre();
    if let Some(open) = leaf.open {
        let (mut signs, mut unknown) = (0u8, 0u8);
        let prism = local::Prism { centre, axes: sheets::UNITS, half: [part.half(); 3] };
        for (k, &surface) in open.indices().iter().enumerate() {
            match Local::new(figures, surface, centre, part.half()).map(|local| local.within(&prism)) {
                Some([low, _]) if low > 0.0 => signs |= 1 << k,
                Some([_, high]) if high < 0.0 => {}
                _ => unknown |= 1 << k,
            }
        }
        if truth::settled(&open, signs, unknown).is_some() {
            return Ok(0.0);
        }
    }
    let most = subject.away(part);
    if most <= tolerance || *parts < 8 || length(minus(part.high, centre)) <= 0.5 * tolerance {
        return Ok(most);
    }
    *parts -= 8;
    let mut all: f64 = 0.0;
    for octant in 0..8usize {
        let half = |k: usize| octant >> k & 1 == 0;
        let part = Around {
            low: axes(|k| if half(k) { part.low[k] } else { centre[k] }),
            high: axes(|k| if half(k) { centre[k] } else { part.high[k] }),
        };
        all = all.max(far(subject, figures, leaf, &part, tolerance, parts)?);
    }
    Ok(all)
}
