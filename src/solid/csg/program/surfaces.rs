//! The surfaces that are open in a cell, and the function of them that the cell's words are.

use super::Program;
use super::word::Op;
use super::worker::{CsgPart, Scratch};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Affine, Cell};
use crate::memory;
use crate::solid::csg::Join;
use crate::solid::half_space::table::Table;
use crate::solid::{Ask, AskLayers, AskWhole, OpenSurfaces, PlacedHalfSpace};
use alloc::boxed::Box;
use alloc::sync::Arc;
use alloc::vec::Vec;

impl Program {
    /// Lists all half-spaces, and behind them the surfaces of the other solids; `with_layers` adds their
    /// layers.
    pub(crate) fn surfaces(
        &self,
        with_layers: bool,
        control: &Control<'_>,
    ) -> Result<Vec<PlacedHalfSpace>, Error> {
        let mut placements: Vec<Arc<[Affine]>> = memory::with_capacity(self.chains.len() + 1)?;
        placements.push(Arc::new([]));
        for (before, placement) in &self.chains {
            let outer: &[Affine] = &placements[*before as usize];
            placements.push(outer.iter().chain([placement]).copied().collect());
        }
        let mut all: Vec<PlacedHalfSpace> =
            memory::collected(self.sources.iter().map(|(half_space, chain)| PlacedHalfSpace {
                half_space: half_space.clone(),
                placements: placements[*chain as usize].clone(),
            }))?;
        let mut starts = memory::with_capacity(self.solids.len())?;
        for solid in &self.solids {
            let layers = if with_layers { solid.layers(control)? } else { None };
            starts.push(Start { first: all.len() as u32, has_layers: layers.is_some() });
            let own = match layers {
                Some(layers) => layers,
                None => solid.surfaces(control)?.unwrap_or_default(),
            };
            all.try_reserve(own.len())?;
            all.extend(own);
        }
        // (Every list has the same starts.)
        _ = self.surfaces[usize::from(with_layers)].set(Box::new(starts));
        Ok(all)
    }
}

/// The place where the surfaces of a solid begin in the program's list, and whether layers are among them.
pub(super) struct Start {
    first: u32,
    has_layers: bool,
}

/// The greatest thickness of layers, and the list for layers of the cell.
pub(crate) type Layers<'l> = (f64, &'l mut Vec<PlacedHalfSpace>);

impl Scratch {
    /// Returns the surfaces that are open in a cell, and the function of them that the part is. `None` if the
    /// surfaces are too many, if an open operand is not made of surfaces, or if the list of the surfaces does
    /// not exist yet. With `layers`, the list with layers is meant.
    pub(crate) fn open_surfaces(
        &mut self,
        program: &Program,
        cell: Cell,
        part: CsgPart,
        mut layers: Option<Layers<'_>>,
    ) -> Result<Option<OpenSurfaces>, Error> {
        if program.paper || part.len == 0 || part.words() > MOST_WORDS {
            return Ok(None);
        }
        if part.is_table() {
            let (half_spaces, table) = Scratch::table_of(Scratch::list(program, &self.words, part));
            let mut open = OpenSurfaces::constant(false);
            // Variables have gaps between their numbers.
            let mut dense = table;
            for word in half_spaces {
                let (i, index) = word.variable();
                let Some(to) = open.number(index) else { return Ok(None) };
                dense = dense.renamed(i, to, false);
            }
            return Ok(Some(open.with_table(dense)));
        }
        let mut open = OpenSurfaces::constant(false);
        let mut stack = [Table::EMPTY; MOST_WORDS];
        let mut top = 0;
        for i in 0..part.words() {
            let value = match Scratch::list(program, &self.words, part)[i].op() {
                Op::HalfSpace { index, complement } => {
                    let Some(i) = open.number(index) else { return Ok(None) };
                    Table::of(i, complement)
                }
                Op::Solid { index, complement } => {
                    let layers = layers.as_mut().map(|(tolerance, own)| (*tolerance, &mut **own));
                    let Some(own) = self.surfaces_of_solid(program, cell, index, layers)? else {
                        return Ok(None);
                    };
                    let Some(table) = joined(&mut open, &own) else { return Ok(None) };
                    if complement { Table(!table.0) } else { table }
                }
                Op::Join { join, complement, count } => {
                    let first = top - count as usize;
                    let operands = stack[first..top].iter().map(|table| table.0);
                    let value = match join {
                        Join::Intersection => operands.fold(!0, |all, one| all & one),
                        Join::Union => operands.fold(0, |all, one| all | one),
                        Join::Parity => operands.fold(0, |all, one| all ^ one),
                    };
                    top = first;
                    Table(if complement { !value } else { value })
                }
                Op::Unknown | Op::Group { .. } | Op::Primitive { .. } => return Ok(None),
            };
            stack[top] = value;
            top += 1;
        }
        Ok(Some(open.with_table(stack[0])))
    }

    /// Returns the surfaces of another solid that is open in a cell, in the numbers of the program's list.
    fn surfaces_of_solid(
        &mut self,
        program: &Program,
        cell: Cell,
        index: u32,
        layers: Option<Layers<'_>>,
    ) -> Result<Option<OpenSurfaces>, Error> {
        let Some(starts) = program.surfaces[usize::from(layers.is_some())].get() else { return Ok(None) };
        let Some((solid, part)) = self.slot(program, index)? else { return Ok(None) };
        let worker = &mut Scratch::other(&mut self.workers, program, solid)?.worker;
        let Start { first, has_layers } = starts[solid as usize];
        let own = match layers.filter(|_| has_layers) {
            Some((tolerance, own)) => worker.layers(cell, &part, tolerance, own)?,
            None => worker.surfaces(cell, &part)?,
        };
        let numbered = |&i: &u32| if i < OpenSurfaces::OWN { first + i } else { i };
        Ok(own.and_then(|own| OpenSurfaces::new(own.indices().iter().map(numbered), own.table())))
    }
}

/// The most words of a part that are evaluated.
const MOST_WORDS: usize = 64;

/// Returns the function of surfaces in the numbering of `open`, and adds new surfaces to `open`. `None` if
/// they are too many.
fn joined(open: &mut OpenSurfaces, own: &OpenSurfaces) -> Option<Table> {
    let mut numbers = [0; OpenSurfaces::MOST];
    for (number, &index) in numbers.iter_mut().zip(own.indices()) {
        *number = open.number(index)?;
    }
    let value = |signs: u64| {
        let own_signs = (0..own.indices().len()).map(|i| ((signs >> numbers[i] & 1) as u8) << i);
        own.inside(own_signs.fold(0, |all, one| all | one))
    };
    Some(Table((0..64).fold(0, |table, signs| table | u64::from(value(signs)) << signs)))
}
