//! The moments of a cell to third order, where one curved half-space is open, alone or with planes.

use super::Program;
use super::worker::{CsgPart, Scratch};
use crate::cut;
use crate::lattice::{Cell, CellMoments};
use crate::solid::half_space::Placed;
use crate::solid::half_space::bounds::{centre, half_edge};
use crate::solid::{Enclosure, Slab, SlabJoin};

impl Scratch {
    /// The moments of the solid in a cell, if more is known of them than slabs tell.
    pub(crate) fn moments(&self, program: &Program, cell: Cell, part: CsgPart) -> Option<CellMoments> {
        let (literals, one_sided, complement) = self.literals(program, part)?;
        let literals = || literals.iter().flatten().map(|&(k, not)| (&program.half_spaces[k as usize], not));
        let is_plane = |half_space: &Placed| matches!(half_space, Placed::Plane(_));
        let mut curved = literals().filter(|(half_space, _)| !is_plane(half_space));
        let ((half_space, not), None) = (curved.next()?, curved.next()) else { return None };
        if one_sided {
            return None;
        }
        let (centre, half) = (centre(cell), half_edge(cell));
        let slab = |half_space: &Placed, not: bool| {
            let slab = half_space.tangent(centre, half)?.slab();
            Some(if not { slab.complement() } else { slab })
        };
        let mut slabs = [Slab::NONE; 3];
        let mut count = 0;
        for (plane, not) in literals().filter(|(half_space, _)| is_plane(half_space)) {
            slabs[count] = slab(plane, not)?;
            count += 1;
        }
        let f = half_space.taylor(centre, half)?.f;
        let f = if not { f.complement() } else { f };
        let known = cut::curved(&f, &slabs[..count])?;
        slabs[count] = slab(half_space, not)?;
        let enclosure = Enclosure { slabs, join: SlabJoin::All, cone: f64::INFINITY };
        let is_better = 2.0 * known.error < cut::doubt(&enclosure);
        is_better.then(|| if complement { known.complement() } else { known })
    }
}
