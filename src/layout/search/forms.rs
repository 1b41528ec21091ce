//! Items as cells, in all their orientations.

use super::super::item::Item;
use super::bits::{Bits, REACH};
use super::space::{Halo, Shape};
use super::tally::Figure;
use super::voxels::Voxels;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Affine, axes};
use crate::memory;
use alloc::vec::Vec;

/// Number of lattice cells along each axis of a cell of the search.
pub(super) const FINER: usize = 4;

/// An item in one orientation.
pub(super) struct Form {
    pub(super) map: Affine,
    pub(super) shape: Shape,
    pub(super) halo: Halo,
    /// The cells taken from other items: all cells that are too near to this one; their edge, in cells of the
    /// search; and the number of the search's cells, along each axis, by which they begin below the item's
    /// own cells.
    pub(super) taken: Bits,
    pub(super) scale: usize,
    pub(super) below: usize,
    /// The lower corner of the turned item's cells, and the cells' centre relative to it (model units).
    pub(super) origin: [f64; 3],
    pub(super) centre: [f64; 3],
}

/// The forms of an item, no two of which have the same cells.
pub(super) struct Forms {
    pub(super) all: Vec<Form>,
    pub(super) figure: Figure,
}

impl Forms {
    /// Builds the forms with cells of the edge `cell`; other items must be `clearance` away. Without maps
    /// there are no forms.
    pub(super) fn of(
        item: &Item,
        maps: &[Affine],
        [cell, clearance]: [f64; 2],
        control: &Control<'_>,
    ) -> Result<Forms, Error> {
        if maps.is_empty() {
            return Ok(Forms { all: Vec::new(), figure: Figure::of_box(&item.bounds) });
        }
        let fine = cell / FINER as f64;
        let given = Voxels::of(&item.solid, &item.bounds, fine, None, control)?;
        let mut all: Vec<Form> = Vec::new();
        let mut bytes = 0;
        for map in maps {
            control.check()?;
            if let Some(limit) = control.max_bytes
                && bytes > limit
            {
                return Err(Error::Limit { what: "bytes", limit });
            }
            let voxels = if map.is_monomial() {
                turned(&given, map, fine)?
            } else {
                of_turned(item, map, fine, control)?
            };
            let shape = voxels.bits.coarser(FINER, [0; 3])?;
            let (own, halo) = (Shape::new(&shape)?, Halo::of(&shape)?);
            if all.iter().any(|form| form.shape.size == own.size && form.shape.runs == own.runs) {
                continue;
            }
            let reach = clearance / fine;
            let (taken, scale, below) = if clearance == 0.0 {
                (shape, 1, 0)
            } else if reach <= REACH {
                let pad = (libm::ceil(reach) as usize).next_multiple_of(FINER);
                (voxels.bits.grown(reach, pad)?.coarser(FINER, [0; 3])?, 1, pad / FINER)
            } else {
                shape.grown_far(clearance / cell)?
            };
            let centre = centre(&voxels.bits)?.each(|c| fine * c);
            memory::push(
                &mut all,
                Form { map: *map, shape: own, halo, taken, scale, below, origin: voxels.origin, centre },
            )?;
            bytes += all.last().map_or(0, Form::bytes);
        }
        let middle = centre(&given.bits)?;
        let volume = given.bits.count() as f64 * fine * fine * fine;
        let centre = axes(|k| given.origin[k] + fine * middle[k]);
        let figure = Figure { volume, centre, ..Figure::of_box(&item.bounds) };
        Ok(Forms { all, figure })
    }
}

impl Forms {
    /// The memory of the forms, in bytes.
    pub(super) fn bytes(&self) -> u64 {
        self.all.iter().map(Form::bytes).sum()
    }
}

impl Form {
    fn bytes(&self) -> u64 {
        let runs = memory::bytes_of(&self.shape.runs) + self.halo.bytes();
        (size_of::<Form>() + runs + memory::bytes_of(&self.taken.bits)) as u64
    }
}

/// Returns the cells of a solid under one of the 24 rotations, by turning the cells of the solid.
fn turned(given: &Voxels, map: &Affine, cell: f64) -> Result<Voxels, Error> {
    let rows = map.rows();
    let order: [usize; 3] = axes(|i| (0..3).find(|&j| rows[i][j] != 0.0).unwrap_or(i));
    let flip: [bool; 3] = axes(|i| rows[i][order[i]] < 0.0);
    let origin = axes(|i| {
        let j = order[i];
        let end = given.origin[j] + cell * given.bits.size[j] as f64;
        if flip[i] { -end } else { given.origin[j] }
    });
    Ok(Voxels { bits: given.bits.turned(order, flip)?, origin })
}

/// Returns the cells of a solid under any other rotation.
fn of_turned(item: &Item, map: &Affine, cell: f64, control: &Control<'_>) -> Result<Voxels, Error> {
    let solid = item.solid.placed(map)?;
    let around = item.bounds.placed(map);
    // (A turned solid often provides tighter bounds.)
    let own = crate::solid::Solid::bounds(&solid);
    let bounds = match (around, own) {
        (Some(around), Some(own)) => own.common(&around).unwrap_or(around),
        (around, own) => own.or(around).unwrap_or(item.bounds),
    };
    Voxels::of(&solid, &bounds, cell, None, control)
}

/// The centre of all cells, in cells.
fn centre(bits: &Bits) -> Result<[f64; 3], Error> {
    let (mut sums, mut count) = ([0.0; 3], 0.0);
    for run in bits.runs()? {
        let length = f64::from(run.length);
        let at = [f64::from(run.x) + 0.5 * length, f64::from(run.y) + 0.5, f64::from(run.z) + 0.5];
        (0..3).for_each(|k| sums[k] += length * at[k]);
        count += length;
    }
    Ok(sums.each(|sum| if count > 0.0 { sum / count } else { 0.0 }))
}
