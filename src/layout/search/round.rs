//! A round of the search by cells: one item after another goes to the best place that is left.

use super::super::Layout;
use super::super::orientation::STRETCH;
use super::forms::{Form, Forms};
use super::plan::{Plan, Tally, Way};
use super::space::{Layer, Space};
use super::{Budget, Direction, Objective};
use crate::error::Error;
use crate::lattice::exact::sqrt;
use crate::lattice::{Affine, axes};
use crate::memory;
use crate::parallel;
use crate::query::GapVerdict;
use alloc::vec::Vec;

/// What all rounds share.
pub(super) struct Ground<'g> {
    pub(super) forms: &'g [Forms],
    /// What is taken before anything is placed.
    pub(super) space: &'g Space,
    /// The lower corner of the first cell (model units), and the edge of all.
    pub(super) origin: [f64; 3],
    pub(super) cell: f64,
    pub(super) objective: Objective,
    pub(super) free_along: Option<Direction>,
    pub(super) parallel: bool,
}

/// A place for an item: the least rank is the best.
#[derive(Debug, Clone, Copy)]
struct Place {
    rank: [f64; 4],
    form: usize,
    at: [usize; 3],
}

/// Masses that are placed, for a centre of gravity.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Masses {
    pub(super) mass: f64,
    pub(super) moment: [f64; 3],
}

/// A place that was not proven to be free.
type Refused = (usize, usize, [usize; 3]);

impl Ground<'_> {
    /// Places items on top of what is placed in a layout, each with its proof, and leaves them there.
    pub(super) fn round(
        &self,
        layout: &mut Layout,
        plan: &Plan,
        budget: &mut Budget<'_>,
    ) -> Result<Tally, Error> {
        let mut space = self.space.try_clone()?;
        let mut tally = Tally::default();
        let mut masses = Masses::default();
        let mut is_full = memory::filled(self.forms.len(), false)?;
        let mut refused: Vec<Refused> = Vec::new();
        // Below that layer there is no place for a form.
        let mut lowest = memory::with_capacity(self.forms.len())?;
        for forms in self.forms {
            lowest.push(memory::filled(forms.all.len(), 0usize)?);
        }
        for &item in &plan.order {
            while !is_full[item] && !budget.is_spent() {
                let found = self.best(item, &space, &mut lowest[item], &refused, plan, &masses)?;
                let Some(place) = found else {
                    is_full[item] = true;
                    break;
                };
                let form = &self.forms[item].all[place.form];
                let placement = self.placement(form, place.at)?;
                let standing = budget.tested(|control| layout.stands(item, &placement, None, control))?;
                let Some(standing) = standing else { break };
                if standing.verdict != GapVerdict::Yes {
                    memory::push(&mut refused, (item, place.form, place.at))?;
                    continue;
                }
                layout.place(item, &placement)?;
                let offset = place.at.map(|at| at as isize - form.below as isize);
                // What comes later must get out, too: nothing goes below what is there.
                space.take(&form.taken, offset, self.free_along.map(|way| way.back()))?;
                tally.count += 1;
                tally.volume += self.forms[item].volume;
                self.weigh(layout, item, form, place.at, &mut masses);
                break;
            }
        }
        self.finish(layout, &masses, &mut tally);
        Ok(tally)
    }

    fn finish(&self, layout: &Layout, masses: &Masses, tally: &mut Tally) {
        tally.height = layout.boxes.iter().map(|block| block.max[2]).fold(f64::NEG_INFINITY, f64::max);
        if let Objective::Balance(target) = self.objective {
            tally.off = masses.off(&target);
        }
    }

    fn weigh(&self, layout: &Layout, item: usize, form: &Form, at: [usize; 3], masses: &mut Masses) {
        let mass = self.forms[item].volume * layout.items[item].density;
        let centre = self.centre(form, at);
        masses.mass += mass;
        (0..3).for_each(|k| masses.moment[k] += mass * centre[k]);
    }

    /// Where the lower corner of a form at some cell is.
    fn corner(&self, at: [usize; 3]) -> [f64; 3] {
        axes(|k| self.origin[k] + self.cell * at[k] as f64)
    }

    fn centre(&self, form: &Form, at: [usize; 3]) -> [f64; 3] {
        let corner = self.corner(at);
        axes(|k| corner[k] + form.centre[k])
    }

    fn placement(&self, form: &Form, at: [usize; 3]) -> Result<Affine, Error> {
        let (rows, corner) = (form.map.rows(), self.corner(at));
        Affine::new(axes(|k| {
            let to = corner[k] - form.origin[k];
            let is_noise = to.abs() < STRETCH * STRETCH;
            [rows[k][0], rows[k][1], rows[k][2], if is_noise { 0.0 } else { to }]
        }))
    }

    /// The best place of an item in any of its forms.
    fn best(
        &self,
        item: usize,
        space: &Space,
        lowest: &mut [usize],
        refused: &[Refused],
        plan: &Plan,
        masses: &Masses,
    ) -> Result<Option<Place>, Error> {
        let mass = self.forms[item].volume;
        let tasks = self.forms[item].all.iter().zip(lowest).enumerate();
        let found =
            parallel::each_with(self.parallel, tasks, Layer::default, |layer, (k, (form, lowest))| {
                let size = form.shape.size;
                if (0..3).any(|axis| size[axis] > space.size()[axis]) {
                    return Ok(None);
                }
                let is_free = |at: [usize; 3]| !refused.contains(&(item, k, at));
                match self.objective {
                    Objective::Balance(target) => {
                        let wanted = masses.wanted(mass, &target);
                        self.nearest(form, k, space, wanted, layer, is_free)
                    }
                    _ => self.lowest(form, k, space, lowest, plan, layer, is_free),
                }
            })?;
        let best = found.into_iter().flatten().reduce(|a, b| if b.rank < a.rank { b } else { a });
        Ok(best)
    }

    /// The best place in the lowest layer that has one.
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
        for z in *lowest..=space.size()[2] - size[2] {
            if space.layer(&form.shape, z, layer)? {
                is_lowest = false;
                let mut best: Option<Place> = None;
                for [x, y] in layer.places() {
                    let at = [x, y, z];
                    let rank = plan.rank(at.map(|c| c as f64), size.map(|c| c as f64), 0.0);
                    if best.is_none_or(|best| rank < best.rank) && is_free(at) {
                        best = Some(Place { rank, form: number, at });
                    }
                    if best.is_some() && plan.way == Way::Rows {
                        break;
                    }
                }
                if best.is_some() {
                    return Ok(best);
                }
            }
            if is_lowest {
                *lowest = z + 1;
            }
        }
        Ok(None)
    }

    /// The place whose centre is nearest to a point.
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
        let along = |k: usize, at: usize| first[k] + self.cell * at as f64 - wanted[k];
        let square = |k: usize, at: usize| along(k, at) * along(k, at);
        let mut layers = memory::collected(0..space.size()[2] - form.shape.size[2] + 1)?;
        layers.sort_by(|&a, &b| along(2, a).abs().total_cmp(&along(2, b).abs()).then(a.cmp(&b)));
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

impl Masses {
    /// Where the centre of a mass should be for that of the whole to be at a point.
    fn wanted(&self, mass: f64, target: &[f64; 3]) -> [f64; 3] {
        if mass <= 0.0 {
            return *target;
        }
        axes(|k| ((self.mass + mass) * target[k] - self.moment[k]) / mass)
    }

    fn off(&self, target: &[f64; 3]) -> f64 {
        if self.mass == 0.0 {
            return f64::INFINITY;
        }
        let off: [f64; 3] = axes(|k| self.moment[k] / self.mass - target[k]);
        sqrt(off.iter().map(|off| off * off).sum::<f64>())
    }
}
