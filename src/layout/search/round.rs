//! A round of the search by cells: one item after another goes to the best remaining place.

use super::super::Layout;
use super::budget::Budget;
use super::forms::{Form, Forms};
use super::ground::Lattice;
use super::plan::Plan;
use super::space::{Layer, Space};
use super::tally::{Figure, Masses};
use super::{Direction, Objective, SearchOptions};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Affine, axes};
use crate::memory;
use crate::parallel;
use alloc::vec::Vec;

/// The input of a round.
pub(super) struct Round<'g> {
    pub(super) lattice: Lattice,
    pub(super) forms: &'g [Forms],
    pub(super) figures: &'g [Figure],
    pub(super) options: &'g SearchOptions,
    pub(super) parallel: bool,
}

/// A place for an item; the least rank is best.
#[derive(Debug, Clone, Copy)]
struct Place {
    rank: [f64; 4],
    form: usize,
    at: [usize; 3],
}

/// A place that was not proven to be free: the item, its form, and the cell.
type Refused = (usize, usize, [usize; 3]);

impl Round<'_> {
    /// Places items beside the placed copies of a layout, each with its proof, and leaves them there. `space`
    /// holds the taken cells.
    pub(super) fn run(
        &self,
        layout: &mut Layout,
        mut space: Space,
        plan: &Plan,
        budget: &mut Budget<'_>,
    ) -> Result<(), Error> {
        let mut masses = Masses::of(layout, self.figures);
        let mut is_full = memory::filled(self.forms.len(), false)?;
        let mut refused: Vec<Refused> = Vec::new();
        // Lower bounds of the layers with a place, for each form.
        let mut lowest = memory::with_capacity(self.forms.len())?;
        for forms in self.forms {
            lowest.push(memory::filled(forms.all.len(), 0usize)?);
        }
        for &item in &plan.order {
            while !is_full[item] && !budget.is_spent() {
                let wanted = match self.options.objective {
                    Objective::Balance(target) if plan.is_for_balance => {
                        let mass = self.figures[item].volume * layout.items[item].density;
                        Some(masses.wanted(mass, &target))
                    }
                    _ => None,
                };
                let found = self.best(item, &space, &mut lowest[item], &refused, plan, wanted)?;
                let Some(place) = found else {
                    is_full[item] = true;
                    break;
                };
                let form = &self.forms[item].all[place.form];
                let placement = self.placement(form, place.at)?;
                if !budget.tested(|control| layout.stands(item, &placement, None, control))? {
                    memory::push(&mut refused, (item, place.form, place.at))?;
                    continue;
                }
                let number = layout.place(item, &placement)?;
                let offset = place.at.each(|at| at as isize - form.below as isize);
                // Later items must get out, too: no item may go where this one would be in its way.
                space.take(&form.taken, form.scale, offset, self.options.free_along.map(Direction::back))?;
                masses.add(layout, self.figures, &layout.placed[number]);
                break;
            }
        }
        Ok(())
    }

    /// Returns the lower corner of a form at a cell.
    fn corner(&self, at: [usize; 3]) -> [f64; 3] {
        axes(|k| self.lattice.origin[k] + self.lattice.cell * at[k] as f64)
    }

    fn centre(&self, form: &Form, at: [usize; 3]) -> [f64; 3] {
        let corner = self.corner(at);
        axes(|k| corner[k] + form.centre[k])
    }

    fn placement(&self, form: &Form, at: [usize; 3]) -> Result<Affine, Error> {
        let (rows, corner) = (form.map.rows(), self.corner(at));
        Affine::new(axes(|k| {
            let to = corner[k] - form.origin[k];
            let is_noise = to.abs() < 1.0 / (1u64 << 60) as f64;
            [rows[k][0], rows[k][1], rows[k][2], if is_noise { 0.0 } else { to }]
        }))
    }

    /// Returns the best place of an item in any of its forms.
    fn best(
        &self,
        item: usize,
        space: &Space,
        lowest: &mut [usize],
        refused: &[Refused],
        plan: &Plan,
        wanted: Option<[f64; 3]>,
    ) -> Result<Option<Place>, Error> {
        let tasks = self.forms[item].all.iter().zip(lowest).enumerate();
        let found =
            parallel::each_with(self.parallel, tasks, Layer::default, |layer, (k, (form, lowest))| {
                let size = form.shape.size;
                if (0..3).any(|axis| size[axis] > space.size()[axis]) {
                    return Ok(None);
                }
                let is_free = |at: [usize; 3]| !refused.contains(&(item, k, at));
                match wanted {
                    Some(wanted) => self.nearest(form, k, space, wanted, layer, is_free),
                    None => self.lowest(form, k, space, lowest, plan, layer, is_free),
                }
            })?;
        let best = found.into_iter().flatten().reduce(|a, b| if b.rank < a.rank { b } else { a });
        Ok(best)
    }

    /// Returns the best place in the lowest layer that has one.
    #[expect(clippy::too_many_arguments, reason = "what the caller shares among forms")]
    fn lowest(
        &self,
        form: &Form,
        number: usize,
        space: &Space,
        lowest: &mut usize,
        plan: &Plan,
        layer: &mut Layer,
        is_free: impl Fn([usize; 3]) -> bool,
    ) -> Result<Option<Place>, Error> {
        let size = form.shape.size;
        let mut is_lowest = true;
        let mut best: Option<Place> = None;
        let mean = size.iter().sum::<usize>() as f64 / 3.0;
        for z in *lowest..=space.size()[2] - size[2] {
            if space.layer(&form.shape, z, layer)? {
                is_lowest = false;
                for [x, y] in layer.corners() {
                    let at = [x, y, z];
                    let contact = space.contact(&form.halo, at);
                    let mut rank = plan.rank(at.each(|c| c as f64), size.each(|c| c as f64), 0.0);
                    rank[0] -= plan.grip * contact * mean;
                    if best.is_none_or(|best| rank < best.rank) && is_free(at) {
                        best = Some(Place { rank, form: number, at });
                    }
                }
            }
            if is_lowest {
                *lowest = z + 1;
            }
            if best.is_some() {
                break;
            }
        }
        Ok(best)
    }

    /// Returns the place whose centre is nearest to a point.
    fn nearest(
        &self,
        form: &Form,
        number: usize,
        space: &Space,
        wanted: [f64; 3],
        layer: &mut Layer,
        is_free: impl Fn([usize; 3]) -> bool,
    ) -> Result<Option<Place>, Error> {
        let first = self.centre(form, [0; 3]);
        let along = |k: usize, at: usize| first[k] + self.lattice.cell * at as f64 - wanted[k];
        let square = |k: usize, at: usize| along(k, at) * along(k, at);
        let mut layers = memory::collected(0..space.size()[2] - form.shape.size[2] + 1)?;
        layers.sort_unstable_by(|&a, &b| along(2, a).abs().total_cmp(&along(2, b).abs()).then(a.cmp(&b)));
        let mut best: Option<Place> = None;
        for z in layers {
            let away = square(2, z);
            if best.is_some_and(|best| best.rank[0] <= away) {
                break;
            }
            if !space.layer(&form.shape, z, layer)? {
                continue;
            }
            for [x, y] in layer.places() {
                let sum = away + square(0, x) + square(1, y);
                if best.is_none_or(|best| sum < best.rank[0]) && is_free([x, y, z]) {
                    best = Some(Place { rank: [sum, 0.0, 0.0, 0.0], form: number, at: [x, y, z] });
                }
            }
        }
        Ok(best)
    }
}
