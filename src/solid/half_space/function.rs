//! The answers in a cell in which few half-spaces are open, for any function of them: points, rays, moments
//! and area.
//!
//! A function of up to three half-spaces is a union of disjoint intersections ([`Terms`]). So its moments are
//! sums of the intersections' moments. A piece of a half-space's surface belongs to the boundary where the
//! function's value depends on that half-space; this is a function of the other half-spaces.

use super::Placed;
use super::bounds::{centre, half_edge};
use super::literals::{Literals, most_area};
use super::sweep::Sweep;
use super::table::{MOST, Table};
use super::terms::{Term, Terms};
use crate::cut::{self, Enclosure, Quadratic, Slab, SlabJoin, Taylor};
use crate::dexel::Beam;
use crate::error::Error;
use crate::lattice::{Cell, CellMoments, CubeMoments, Interval};
use crate::memory;

/// A function of up to three half-spaces, numbered from 0 on.
struct Function<'h> {
    half_spaces: [Option<&'h Placed>; 3],
    table: Table,
}

/// Returns the moments in a cell, if more is known of them than slabs give. Half-spaces are given with their
/// numbers in the table.
pub(crate) fn moments(
    variables: impl Iterator<Item = (usize, u32)> + Clone,
    table: Table,
    half_spaces: &[Placed],
    cell: Cell,
) -> Option<CellMoments> {
    let literals = Literals::of_table(variables.clone(), table);
    if let Some(own) = literals.filter(|own| !own.is_one_sided()) {
        return own.moments(half_spaces, cell);
    }
    let known = Function::new(variables, table, half_spaces)?.moments(cell)?;
    let slabs = literals.and_then(|own| own.enclosure(half_spaces, cell));
    let doubt = slabs.map_or(8.0, |enclosure| cut::doubt(&enclosure));
    (2.0 * known.error < doubt).then_some(known)
}

/// Returns bounds of the area of the boundary in a cell; `None` if too little is known.
pub(crate) fn area(
    variables: impl Iterator<Item = (usize, u32)> + Clone,
    table: Table,
    half_spaces: &[Placed],
    cell: Cell,
) -> Option<Interval> {
    if let Some(known) =
        Literals::of_table(variables.clone(), table).and_then(|own| own.area(half_spaces, cell))
    {
        return Some(known);
    }
    match Function::new(variables.clone(), table, half_spaces) {
        Some(function) => function.area(cell),
        None => most_area(variables.map(|(_, index)| &half_spaces[index as usize]), cell),
    }
}

/// Returns whether a point is inside, from the sides of half-spaces on which it lies. `None` if the function
/// depends on a half-space whose side is unknown.
pub(crate) fn inside(
    variables: impl Iterator<Item = (usize, u32)>,
    mut table: Table,
    side: impl Fn(u32) -> Result<Option<bool>, Error>,
) -> Result<Option<bool>, Error> {
    for (i, index) in variables {
        // The sides before may make this one irrelevant.
        if table.depends_on(i) {
            table = table.at(i, side(index)?);
        }
    }
    Ok(match table {
        Table::FULL => Some(true),
        Table::EMPTY => Some(false),
        _ => None,
    })
}

/// Adds the intervals of all rays of a beam. Returns `false` if a half-space has no exact place.
pub(crate) fn chords(
    variables: impl Iterator<Item = (usize, u32)>,
    table: Table,
    all: &[Placed],
    beam: &mut Beam,
) -> Result<bool, Error> {
    let mut sweep = Sweep::default();
    let mut places = [0; MOST];
    for (i, index) in variables {
        places[sweep.half_spaces.len()] = i;
        memory::push(&mut sweep.half_spaces, index)?;
    }
    if !sweep.are_known(all) {
        return Ok(false);
    }
    sweep.find(all, beam, |inside| {
        let signs = inside.iter().zip(places).fold(0, |signs, (&inside, i)| signs | u32::from(inside) << i);
        Ok(table.0 >> signs & 1 != 0)
    })?;
    Ok(true)
}

impl<'h> Function<'h> {
    /// `None` if the function depends on more than three half-spaces.
    fn new(
        variables: impl Iterator<Item = (usize, u32)>,
        mut table: Table,
        all: &'h [Placed],
    ) -> Option<Function<'h>> {
        let mut half_spaces = [None; 3];
        let mut count = 0;
        for (i, index) in variables {
            if !table.depends_on(i) {
                continue;
            }
            // Numbers ascend, so that no number of a later half-space is taken.
            table = table.renamed(i, count, false);
            *half_spaces.get_mut(count)? = Some(&all[index as usize]);
            count += 1;
        }
        Some(Function { half_spaces, table })
    }

    /// The sum of the terms' moments; `None` if nothing is known of a half-space.
    fn moments(&self, cell: Cell) -> Option<CellMoments> {
        let (centre, half) = (centre(cell), half_edge(cell));
        let (mut slabs, mut curves, mut curved) = ([Slab::NONE; 3], [None; 3], [false; 3]);
        for (i, half_space) in self.half_spaces.iter().enumerate() {
            let Some(half_space) = half_space else { continue };
            let tangent = half_space.tangent(centre, half)?;
            // Where the gradient vanishes there is no slab.
            if tangent.gradient == [0.0; 3] {
                return None;
            }
            slabs[i] = tangent.slab();
            curved[i] = !matches!(half_space, Placed::Plane(_) | Placed::Slab(_));
            if curved[i] {
                curves[i] = half_space.taylor(centre, half).map(|taylor| taylor.f);
            }
        }
        let (terms, complement) = Terms::cheapest(self.table, curved);
        let mut sum = CellMoments { moments: CubeMoments::EMPTY, error: 0.0 };
        for term in terms.each() {
            sum = sum.plus(&moments_of_term(term, &slabs, &curves));
        }
        Some(if complement { sum.complement() } else { sum })
    }

    /// The sum of the faces' areas; `None` if nothing is known of a surface.
    fn area(&self, cell: Cell) -> Option<Interval> {
        let mut surfaces = [None; 3];
        for (surface, half_space) in surfaces.iter_mut().zip(&self.half_spaces) {
            let Some(half_space) = half_space else { continue };
            *surface = Some(half_space.taylor(centre(cell), half_edge(cell))?);
        }
        let mut sum = Interval::exactly(0.0);
        for (i, surface) in surfaces.iter().enumerate() {
            let Some(surface) = surface else { continue };
            let bounds = Table(self.table.with(i, true).0 ^ self.table.with(i, false).0);
            let terms = Terms::exactly(bounds);
            sum = sum.plus(cut::area_within(surface, terms.each().map(|term| sides(term, &surfaces))));
        }
        Some(sum)
    }
}

/// Returns the functions that are positive in a term.
fn sides(term: &Term, surfaces: &[Option<Taylor>; 3]) -> [Option<Taylor>; 3] {
    let mut sides = [None; 3];
    for ((side, not), surface) in sides.iter_mut().zip(term).zip(surfaces) {
        let (Some(not), Some(surface)) = (not, surface) else { continue };
        *side = Some(if *not { surface.complement() } else { *surface });
    }
    sides
}

/// Returns the moments of an intersection: to third order if one curved half-space is open, alone or with
/// planes, otherwise from slabs.
fn moments_of_term(term: &Term, slabs: &[Slab; 3], curves: &[Option<Quadratic>; 3]) -> CellMoments {
    let literals = || term.iter().enumerate().filter_map(|(i, not)| Some((i, (*not)?)));
    let slab = |(i, not): (usize, bool)| if not { slabs[i].complement() } else { slabs[i] };
    let mut own = [Slab::NONE; 3];
    for (to, literal) in own.iter_mut().zip(literals()) {
        *to = slab(literal);
    }
    let enclosure = Enclosure { slabs: own, join: SlabJoin::All, cone: f64::INFINITY };
    let mut bent = literals().filter_map(|(i, not)| Some((i, not, curves[i]?)));
    if let (Some((curve, not, f)), None) = (bent.next(), bent.next()) {
        let (mut planes, mut count) = ([Slab::NONE; 3], 0);
        for literal in literals().filter(|&(i, _)| i != curve) {
            planes[count] = slab(literal);
            count += 1;
        }
        let f = if not { f.complement() } else { f };
        if let Some(known) = cut::curved(&f, &planes[..count])
            && 2.0 * known.error < cut::doubt(&enclosure)
        {
            return known;
        }
    }
    cut::between(&enclosure)
}
