//! Rays through cell centres: their intervals inside a function of half-spaces.
//!
//! The roots of all half-spaces on a ray cut it into pieces, on each of which the function has one value.

use super::Placed;
use super::lines::{Line, Root};
use crate::dexel::{Beam, BeamEnd, OTHERS};
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;

/// The half-spaces of a function, and their state on the current ray. The memory is kept from cell to cell.
#[derive(Default)]
pub(crate) struct Sweep {
    /// The half-spaces' numbers among all half-spaces, in the order of their places in the function.
    pub(crate) half_spaces: Vec<u32>,
    inside: Vec<bool>,
    roots: Vec<Root>,
}

impl Sweep {
    /// Returns whether no half-space is the host's, which has only ranges over boxes, and none is a plane
    /// with a width.
    pub(crate) fn are_known(&self, all: &[Placed]) -> bool {
        let half_space = |&index: &u32| all.get(index as usize);
        self.half_spaces.iter().filter_map(half_space).all(|half_space| half_space.degree().is_some())
    }

    /// Adds the intervals of all rays of a beam. `value` is the function; its argument says which half-spaces
    /// contain the point.
    pub(crate) fn find(
        &mut self,
        all: &[Placed],
        beam: &mut Beam,
        mut value: impl FnMut(&[bool]) -> Result<bool, Error>,
    ) -> Result<(), Error> {
        let cells = f64::from(1u32 << beam.depth());
        let [u, v] = OTHERS[beam.axis()];
        let [columns, rows] = beam.rays();
        let span = beam.span();
        let mut line = Line {
            axis: beam.axis(),
            point: [0.0; 3],
            cells,
            low: f64::from(span.start) / cells,
            high: f64::from(span.end) / cells,
        };
        for row in rows {
            line.point[v] = (f64::from(row) + 0.5) / cells;
            for column in columns.clone() {
                line.point[u] = (f64::from(column) + 0.5) / cells;
                self.ray(all, &line, [column, row], beam, &mut value)?;
            }
        }
        Ok(())
    }

    /// The intervals on one ray.
    #[inline]
    fn ray(
        &mut self,
        all: &[Placed],
        line: &Line,
        ray: [u32; 2],
        beam: &mut Beam,
        mut value: impl FnMut(&[bool]) -> Result<bool, Error>,
    ) -> Result<(), Error> {
        let Sweep { half_spaces, inside, roots } = self;
        roots.clear();
        inside.clear();
        for (i, &index) in (0u32..).zip(&*half_spaces) {
            let holds = match all.get(index as usize) {
                Some(half_space) => line.roots(half_space, i, roots)?,
                None => false,
            };
            memory::push(inside, holds)?;
        }
        let mut now = value(inside)?;
        if roots.is_empty() && !now {
            return Ok(());
        }
        if half_spaces.len() > 1 {
            roots.sort_unstable_by(|a, b| a.at.total_cmp(&b.at).then(a.which.cmp(&b.which)));
        }
        let mut start = BeamEnd::between(beam.span().start);
        for &Root { at, which } in &*roots {
            let which = which as usize;
            inside[which] ^= true;
            let next = value(inside)?;
            if next != now {
                let mut end = BeamEnd { at, ..start };
                if beam.is_marked() {
                    let index = half_spaces[which];
                    let normal = line.normal(&all[index as usize], at);
                    // If the half-space begins here, its outward normal points back along the ray.
                    let turned = inside[which] != next;
                    end = end.on(index, if turned { normal.each(|c| -c) } else { normal });
                }
                if next {
                    start = end;
                } else {
                    beam.push(ray, start, end)?;
                }
                now = next;
            }
        }
        if now {
            beam.push(ray, start, BeamEnd::between(beam.span().end))?;
        }
        Ok(())
    }
}
