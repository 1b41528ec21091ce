//! Adjacency of triangles across their sides.

use crate::error::Error;
use crate::memory;
use alloc::vec::Vec;

/// Returns for each triangle the triangles across its sides; `None` if a side does not have exactly one.
pub(super) fn mates(triangles: &[[u32; 3]]) -> Result<Option<Vec<[u32; 3]>>, Error> {
    let mut sides = memory::with_capacity(3 * triangles.len())?;
    for (number, triangle) in (0u32..).zip(triangles) {
        for k in 0..3 {
            let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
            sides.push((from.min(to), from.max(to), from < to, number, k as u8));
        }
    }
    sides.sort_unstable();
    let mut mates = memory::filled(triangles.len(), [0; 3])?;
    let mut pairs = sides.chunks_exact(2);
    for pair in &mut pairs {
        let [one, other] = [pair[0], pair[1]];
        if (one.0, one.1) != (other.0, other.1) || one.2 == other.2 {
            return Ok(None);
        }
        mates[one.3 as usize][usize::from(one.4)] = other.3;
        mates[other.3 as usize][usize::from(other.4)] = one.3;
    }
    Ok(pairs.remainder().is_empty().then_some(mates))
}
