//! Bodies that have no triangle in a mesh.
//!
//! Vertices at one place become one vertex, and triangles without area are dropped. So a body whose surface
//! lies nearer to its centres than doubles can express loses all its triangles: its vertices lie at its
//! centres. A body of one centre has all vertices at one place.

use super::blocks::Blocks;
use super::solid::edges;
use crate::dexel::TriDexelRef;
use crate::error::Error;
use crate::lattice::Each;
use crate::walk::Edge;
use alloc::collections::VecDeque;
use hashbrown::HashMap;

/// The state of a centre that lies inside.
#[derive(Clone, Copy, PartialEq)]
enum Centre {
    /// None of its crossings has a triangle.
    Bare,
    /// One of its crossings has a triangle.
    Covered,
    /// The search with this number has visited the centre.
    Met(u32),
}

/// Returns the number of bodies without a triangle. A body is a set of inside centres that are connected
/// along edges of the lattice. It has no triangle if none of its crossings has one. `covered` says for each
/// crossing, in the order of the cut edges, whether it has a triangle.
///
/// O(crossings), plus O(log intervals of a ray) for each crossing without a triangle.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(super) fn vanished(
    model: &TriDexelRef<'_>,
    blocks: &Blocks,
    covered: impl Fn(usize) -> bool,
) -> Result<u64, Error> {
    let crossings =
        || blocks.list.iter().flat_map(|block| edges(block, blocks.bias)).map(|edge| inner(&edge));
    let mut known: HashMap<[u32; 3], Centre> = HashMap::new();
    for (_, centre) in crossings().enumerate().filter(|&(i, _)| !covered(i)) {
        known.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
        known.insert(centre, Centre::Bare);
    }
    if known.is_empty() {
        return Ok(0);
    }
    for (_, centre) in crossings().enumerate().filter(|&(i, _)| covered(i)) {
        if let Some(found) = known.get_mut(&centre) {
            *found = Centre::Covered;
        }
    }
    let (mut count, mut queue) = (0, VecDeque::new());
    for (number, (_, seed)) in (0u32..).zip(crossings().enumerate().filter(|&(i, _)| !covered(i))) {
        if known.get(&seed) == Some(&Centre::Bare)
            && !has_triangles(model, seed, number, &mut known, &mut queue)?
        {
            count += 1;
        }
    }
    Ok(count)
}

/// The inside end of a cut edge.
fn inner(edge: &Edge) -> [u32; 3] {
    // (The inside end lies in the universe.)
    let mut centre = edge.lower.each(|at| at as u32);
    if !edge.starts_inside {
        centre[edge.axis] = centre[edge.axis].wrapping_add(1);
    }
    centre
}

/// The neighbours of a centre that lie inside.
fn neighbours(model: &TriDexelRef<'_>, centre: [u32; 3]) -> impl Iterator<Item = [u32; 3]> {
    let all = (0..6).map(move |side| {
        let (mut other, axis) = (centre, side / 2);
        other[axis] = if side % 2 == 0 { other[axis].wrapping_sub(1) } else { other[axis] + 1 };
        other
    });
    all.filter(|&other| model.contains_cell(other))
}

/// Returns whether the body of a centre has a triangle.
fn has_triangles(
    model: &TriDexelRef<'_>,
    seed: [u32; 3],
    number: u32,
    known: &mut HashMap<[u32; 3], Centre>,
    queue: &mut VecDeque<[u32; 3]>,
) -> Result<bool, Error> {
    queue.clear();
    queue.try_reserve(1)?;
    queue.push_back(seed);
    known.insert(seed, Centre::Met(number));
    while let Some(centre) = queue.pop_front() {
        for other in neighbours(model, centre) {
            match known.get(&other) {
                Some(Centre::Met(of)) if *of == number => continue,
                // A search that visited only a part of its body ended at a triangle.
                Some(Centre::Covered | Centre::Met(_)) => return Ok(true),
                Some(Centre::Bare) => {}
                // It has no crossing without a triangle. So either it has a crossing with a triangle, or no
                // crossing at all.
                None if neighbours(model, other).count() < 6 => return Ok(true),
                None => {}
            }
            known.try_reserve(1).map_err(|_| Error::OutOfMemory)?;
            known.insert(other, Centre::Met(number));
            queue.try_reserve(1)?;
            queue.push_back(other);
        }
    }
    Ok(false)
}

/// Returns whether a triangle is kept: its three corners are distinct.
pub(super) fn is_kept(vertices: &[[f64; 3]], triangle: [u32; 3]) -> bool {
    let [p, q, r] = triangle.each(|vertex| vertices[vertex as usize]);
    p != q && q != r && r != p
}
