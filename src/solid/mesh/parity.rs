//! Rays that pierce an open mesh an odd number of times.

use super::crossing::Projection;
use super::mesh_solid::MeshSolid;
use super::placed::Placed;
use crate::control::{Control, Job, WHOLE};
use crate::dexel::OTHERS;
use crate::error::{Error, MeshError};
use crate::lattice::Each;
use crate::lattice::Frame;
use crate::memory;
use crate::mesh::FillRule;
use core::ops::Range;

/// Bits that are kept at a time: 16 MiB.
const BITS: u64 = 1 << 27;

/// The number of triangles that are processed between two checks for cancellation.
const TRIANGLES: usize = 1 << 12;

impl MeshSolid {
    /// Returns how many rays along x, along y and along z pierce the triangles of the mesh an odd number of
    /// times. On these rays an open mesh contradicts itself. A mesh that is closed as [`FillRule::EvenOdd`]
    /// demands has none.
    ///
    /// The rays are the 4^depth lines along each axis through the centres of the frame's finest cells. As in
    /// [`dexelize`](crate::dexelize), they are shifted symbolically by (ε, ε², ε³), so that they meet no edge
    /// of a triangle. A ray is the whole line: triangles outside the universe count, too. The caps that close
    /// holes for winding numbers do not count.
    ///
    /// O(1) for a closed mesh whose edges were analysed before. Otherwise O(rays / 64 + t + rows), where the
    /// rows of a triangle are the rows of rays that meet it. Memory: a bit a ray, at most 16 MiB. For frames
    /// of more than 8192 cells along an axis, all triangles are processed several times.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`]; [`Error::Cancelled`].
    ///
    /// ```
    /// use leafless::{Control, FillRule, Frame, MeshSolid, TriangleMesh};
    /// let vertices = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];
    /// // The face that looks down is missing.
    /// let mesh = TriangleMesh::new(vertices, vec![[0, 1, 3], [1, 2, 3], [2, 0, 3]])?;
    /// let solid = MeshSolid::new(mesh, FillRule::NonZero)?;
    /// let frame = Frame::new([0.0; 3], 4.0, 2)?;
    /// assert_eq!(solid.odd_rays(&frame, &Control::default())?, [0, 0, 6]);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn odd_rays(&self, frame: &Frame, control: &Control<'_>) -> Result<[u64; 3], Error> {
        match self.mesh().check_closed(FillRule::EvenOdd) {
            Ok(()) => return Ok([0; 3]),
            Err(Error::Mesh(MeshError::Open { .. })) => {}
            Err(error) => return Err(error),
        }
        let placed = Placed::new(self.mesh().clone(), frame)?;
        let job = Job::new(control);
        let mut odd = [0; 3];
        for axis in 0..3 {
            odd[axis] = count(&placed, axis, &job)?;
            job.advance(WHOLE / 3);
        }
        Ok(odd)
    }
}

/// Returns how many rays along an axis pierce an odd number of triangles.
fn count(placed: &Placed, axis: usize, job: &Job<'_>) -> Result<u64, Error> {
    let [u, v] = OTHERS[axis];
    let mut hull = [[i32::MAX, i32::MIN]; 3];
    for triangle in 0..placed.count() {
        let [low, high] = placed.rank_box(triangle);
        for axis in [u, v] {
            let [least, most] = &mut hull[axis];
            (*least, *most) = ((*least).min(low[axis]), (*most).max(high[axis]));
        }
    }
    let cells = placed.frame.cells() as i32;
    let [columns, rows] = [u, v].each(|axis| hull[axis][0].max(0)..hull[axis][1].min(cells));
    if columns.is_empty() || rows.is_empty() {
        return Ok(0);
    }
    // One bit more than there are columns: the end of a span is one past its last column.
    let words = columns.len() / 64 + 1;
    let most = (BITS / 64 / words as u64).max(1) as usize;
    let mut bits = memory::filled(words * most.min(rows.len()), 0u64)?;
    let mut odd = 0;
    for first in rows.clone().step_by(most) {
        let band = first..(first as i64 + most as i64).min(i64::from(rows.end)) as i32;
        bits.fill(0);
        mark(placed, axis, [&columns, &band], &mut bits, job)?;
        odd += bits.chunks_exact(words).map(odd_columns).sum::<u64>();
    }
    Ok(odd)
}

/// Flips the bits where, in each row of a band, the columns of a triangle begin and end.
fn mark(
    placed: &Placed,
    axis: usize,
    [columns, band]: [&Range<i32>; 2],
    bits: &mut [u64],
    job: &Job<'_>,
) -> Result<(), Error> {
    let [u, v] = OTHERS[axis];
    let words = columns.len() / 64 + 1;
    for triangle in 0..placed.count() {
        if (triangle as usize).is_multiple_of(TRIANGLES) {
            job.check()?;
        }
        let [low, high] = placed.rank_box(triangle);
        let meets = |axis: usize, range: &Range<i32>| low[axis].max(range.start) < high[axis].min(range.end);
        if !(meets(u, columns) && meets(v, band)) {
            continue;
        }
        let seen = Projection::new(placed, triangle, placed.corners(triangle), axis);
        for row in low[v].max(band.start)..high[v].min(band.end) {
            let Some(span) = seen.span(row) else { continue };
            let bits = &mut bits[(row - band.start) as usize * words..][..words];
            let (first, end) = (span.first.max(columns.start), span.end.min(columns.end));
            if first < end {
                for column in [first, end] {
                    let place = (column - columns.start) as usize;
                    bits[place / 64] ^= 1 << (place % 64);
                }
            }
        }
    }
    Ok(())
}

/// Returns how many columns of a row are odd. The row's bits say where the parity changes.
fn odd_columns(row: &[u64]) -> u64 {
    let (mut odd, mut before) = (0, 0);
    for &word in row {
        let mut bits = word;
        for shift in [1, 2, 4, 8, 16, 32] {
            bits ^= bits << shift;
        }
        bits ^= before;
        odd += u64::from(bits.count_ones());
        before = (bits >> 63).wrapping_neg();
    }
    odd
}
