//! The answers in a cell in which few half-spaces are open: slabs, moments to third order, and area.

use super::Placed;
use super::bounds::{centre, half_edge};
use super::table::{MOST, Table};
use crate::cut;
use crate::cut::{Enclosure, Slab, SlabJoin};
use crate::lattice::{Cell, CellMoments, Interval};

/// Up to three half-spaces, each with whether its complement is meant.
type Chosen = [Option<(u32, bool)>; 3];

/// The intersection of up to three half-spaces or complements that a solid is in a cell, or is contained in;
/// or the same for the solid's complement. (A union is the complement of an intersection, so that complements
/// give the same bits.)
#[derive(Clone, Copy)]
pub(crate) struct Literals {
    /// The half-spaces, and whether their complements are meant.
    literals: Chosen,
    /// Whether the solid, or its complement, may be smaller than the intersection.
    one_sided: bool,
    /// Whether the intersection stands for the solid's complement.
    complement: bool,
}

impl Literals {
    /// Returns one half-space, or its complement.
    pub(crate) fn one(index: u32, complement: bool) -> Literals {
        Literals { literals: [Some((index, false)), None, None], one_sided: false, complement }
    }

    /// Returns the literals of a function of half-spaces, which are given with their numbers in the table.
    /// `None` if neither the solid nor its complement lies in any of them.
    pub(crate) fn of_table(
        variables: impl Iterator<Item = (usize, u32)> + Clone,
        table: Table,
    ) -> Option<Literals> {
        let around = |table: Table, complement| {
            let (literals, one_sided) = around(variables.clone(), table)?;
            Some(Literals { literals, one_sided, complement })
        };
        around(table, false).or_else(|| around(Table(!table.0), true))
    }

    /// Returns whether the solid, or its complement, may be smaller than the intersection.
    pub(crate) fn is_one_sided(&self) -> bool {
        self.one_sided
    }

    fn each<'h>(&self, half_spaces: &'h [Placed]) -> impl Iterator<Item = (&'h Placed, bool)> {
        self.literals.into_iter().flatten().map(|(index, not)| (&half_spaces[index as usize], not))
    }

    /// Returns a slab for each half-space, and one-sided bounds if the solid may be smaller than their
    /// intersection.
    pub(crate) fn enclosure(&self, half_spaces: &[Placed], cell: Cell) -> Option<Enclosure> {
        let (centre, half) = (centre(cell), half_edge(cell));
        let mut slabs = [Slab::NONE; 3];
        let (mut count, mut one_sided) = (0, self.one_sided);
        for (half_space, complement) in self.each(half_spaces) {
            let tangent = half_space.tangent(centre, half);
            // Where the gradient vanishes, there is no slab.
            match tangent.filter(|tangent| tangent.gradient != [0.0; 3]) {
                Some(tangent) => {
                    let slab = tangent.slab();
                    slabs[count] = if complement { slab.complement() } else { slab };
                    count += 1;
                }
                None => one_sided = true,
            }
        }
        if one_sided {
            slabs.iter_mut().for_each(|slab| slab.inner = f64::NEG_INFINITY);
        }
        // Several surfaces have different normals.
        let cone = match self.literals {
            [Some((index, _)), None, None] if !one_sided => {
                half_spaces[index as usize].taylor(centre, half).map_or(f64::INFINITY, |f| f.cone())
            }
            _ => f64::INFINITY,
        };
        let enclosure = Enclosure { slabs, join: SlabJoin::All, cone };
        (count > 0).then(|| if self.complement { enclosure.complement() } else { enclosure })
    }

    /// Returns the moments to third order if one curved half-space is open, alone or with planes, and if this
    /// is better than slabs.
    pub(crate) fn moments(&self, half_spaces: &[Placed], cell: Cell) -> Option<CellMoments> {
        let is_plane = |half_space: &Placed| matches!(half_space, Placed::Plane(_));
        let mut curved = self.each(half_spaces).filter(|(half_space, _)| !is_plane(half_space));
        let ((half_space, not), None) = (curved.next()?, curved.next()) else { return None };
        if self.one_sided {
            return None;
        }
        let (centre, half) = (centre(cell), half_edge(cell));
        let slab = |half_space: &Placed, not: bool| {
            let slab = half_space.tangent(centre, half)?.slab();
            Some(if not { slab.complement() } else { slab })
        };
        let mut slabs = [Slab::NONE; 3];
        let mut count = 0;
        for (plane, not) in self.each(half_spaces).filter(|(half_space, _)| is_plane(half_space)) {
            slabs[count] = slab(plane, not)?;
            count += 1;
        }
        let f = half_space.taylor(centre, half)?.f;
        let f = if not { f.complement() } else { f };
        let known = cut::curved(&f, &slabs[..count])?;
        slabs[count] = slab(half_space, not)?;
        let enclosure = Enclosure { slabs, join: SlabJoin::All, cone: f64::INFINITY };
        let is_better = 2.0 * known.error < cut::doubt(&enclosure);
        is_better.then(|| if self.complement { known.complement() } else { known })
    }

    /// Returns bounds of the area of the boundary in the cell; `None` if too little is known.
    pub(crate) fn area(&self, half_spaces: &[Placed], cell: Cell) -> Option<Interval> {
        if self.one_sided {
            return None;
        }
        let mut surfaces = [None; 3];
        for (surface, (half_space, complement)) in surfaces.iter_mut().zip(self.each(half_spaces)) {
            let own = half_space.taylor(centre(cell), half_edge(cell))?;
            *surface = Some(if complement { own.complement() } else { own });
        }
        Some(match &surfaces {
            [Some(surface), None, None] => cut::area_of_surface(surface),
            _ => cut::area_of_faces(&surfaces),
        })
    }
}

/// Returns more than the area of surfaces in a cell, for any function of them; `None` if too little is known.
pub(crate) fn most_area<'h>(half_spaces: impl Iterator<Item = &'h Placed>, cell: Cell) -> Option<Interval> {
    let taylor = |half_space: &Placed| half_space.taylor(centre(cell), half_edge(cell));
    let areas = half_spaces.map(|half_space| Some(cut::area_of_surface(&taylor(half_space)?).upper));
    Some(Interval::between(0.0, areas.sum::<Option<f64>>()?))
}

/// Returns half-spaces, or complements, that all contain the points of a table; the flag is `false` if the
/// table is their intersection. `None` if there is no such half-space.
fn around(variables: impl Iterator<Item = (usize, u32)>, table: Table) -> Option<(Chosen, bool)> {
    let mut literals = [None; MOST];
    let (mut all, mut count) = (Table::FULL, 0);
    for (i, index) in variables {
        for complement in [false, true] {
            let literal = Table::of(i, complement);
            if table.0 & !literal.0 == 0 {
                literals[count] = Some((index, complement));
                all.0 &= literal.0;
                count += 1;
            }
        }
    }
    let first = [literals[0], literals[1], literals[2]];
    (count > 0).then_some((first, count > 3 || all != table))
}
