//! Bounds of the distance of a triangle from the boundary: one step that moves the whole triangle inside, and
//! another one that moves it outside. The boundary lies between the two.

use super::super::edges::NONE;
use super::super::figures::{dot, length, minus, shortest};
use super::super::leaves::Leaf;
use super::clip::clip;
use super::local::Local;
use super::truth::{Around, Near, Truth, cube};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, axes};
use crate::memory;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// The greatest number of halvings of a piece of a triangle.
const HALVINGS: u32 = 6;

/// The greatest number of surfaces that steps take into account.
const MOST: usize = 3;

/// The factor by which steps are longer than necessary.
const LONGER: f64 = 1.0 + 1.0 / 128.0;

/// The extra length of the longest steps, as a part of the tolerance.
const ASIDE: f64 = 0.02;

/// The length added to each step (edges of the universe), because places are inexact in some last digits.
const SLACK: f64 = 1e-14;

/// The search for steps.
pub(super) struct Witnesses<'t> {
    truth: &'t Truth<'t>,
    tolerance: f64,
    /// The remaining budget where the first step proves nothing: one for each piece that is halved, and for
    /// each size of cube around a piece.
    budget: u32,
    is_spent: bool,
    near: Near,
    /// Whether a surface may be near the last piece.
    is_near: bool,
    /// The leaves that a triangle meets.
    leaves: Vec<(Cell, Leaf)>,
    shifted: Vec<[f64; 3]>,
    steps: Vec<(f64, [f64; 3])>,
    cut: Vec<[f64; 3]>,
    /// A bound of the distance of all points of a cell in which nothing is known from the boundary.
    of_cells: HashMap<u32, f64>,
}

impl<'t> Witnesses<'t> {
    pub(super) fn new(truth: &'t Truth<'t>, tolerance: f64) -> Witnesses<'t> {
        Witnesses {
            truth,
            tolerance,
            budget: 0,
            is_spent: false,
            near: Near::default(),
            is_near: false,
            leaves: Vec::new(),
            shifted: Vec::new(),
            steps: Vec::new(),
            cut: Vec::new(),
            of_cells: HashMap::new(),
        }
    }

    /// Takes one unit off the budget. `false` if nothing is left.
    fn spend(&mut self) -> bool {
        let is_left = self.budget > 0;
        self.is_spent |= !is_left;
        self.budget = self.budget.saturating_sub(1);
        is_left
    }

    /// Calls `told` for the parts of a triangle in all leaves, each with a bound of the distance of the part
    /// from the boundary. All parts together may spend `budget`. Returns whether the budget was too small.
    pub(super) fn triangle(
        &mut self,
        triangle: [[f64; 3]; 3],
        surface: u32,
        budget: u32,
        told: &mut impl FnMut(Cell, f64) -> Result<(), Error>,
    ) -> Result<bool, Error> {
        (self.budget, self.is_spent) = (budget, false);
        let mut leaves = core::mem::take(&mut self.leaves);
        self.truth.met_by(&triangle, &mut leaves)?;
        let mut part = Vec::new();
        for &(cell, leaf) in &leaves {
            part.clear();
            part.try_reserve(3)?;
            part.extend(triangle);
            if !matches!(leaf, Leaf::Outside) {
                let cube = cube(cell);
                clip(&mut part, &mut self.cut, cube.low, cube.high)?;
            }
            if part.len() >= 3 {
                let most = match leaf {
                    // No step leads out of such a cell.
                    Leaf::Open(number)
                        if self.truth.open(number).open.is_none()
                            && 2.0 * cube(cell).half() > self.longest() =>
                    {
                        self.around_cell(number, cell)?
                    }
                    _ => self.part(&part, surface, HALVINGS)?,
                };
                told(cell, most)?;
            }
        }
        self.leaves = leaves;
        Ok(self.is_spent)
    }

    fn part(&mut self, part: &[[f64; 3]], surface: u32, halvings: u32) -> Result<f64, Error> {
        let direct = self.direct(part, surface)?;
        if direct <= self.tolerance {
            return Ok(direct);
        }
        if halvings == 0 || !self.is_near {
            return Ok(direct.min(self.around(part)?));
        }
        // The longest line between corners is halved.
        let mut best = (0.0, 0, 1);
        for i in 0..part.len() {
            for k in i + 1..part.len() {
                let long = length(minus(part[i], part[k]));
                if long > best.0 {
                    best = (long, i, k);
                }
            }
        }
        if best.0 <= 0.25 * self.tolerance || !self.spend() {
            return Ok(direct.min(self.around(part)?));
        }
        let (from, to) = (part[best.1], part[best.2]);
        let (centre, normal) = (axes(|k| 0.5 * (from[k] + to[k])), minus(to, from));
        let mut most: f64 = 0.0;
        for sign in [1.0, -1.0] {
            let away = |p: [f64; 3]| sign * dot(minus(p, centre), normal);
            let mut half = Vec::new();
            for k in 0..part.len() {
                let (p, q) = (part[k], part[(k + 1) % part.len()]);
                let (a, b) = (away(p), away(q));
                if a >= 0.0 {
                    memory::push(&mut half, p)?;
                }
                if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
                    memory::push(&mut half, axes(|k| p[k] + a / (a - b) * (q[k] - p[k])))?;
                }
            }
            if half.len() >= 3 {
                most = most.max(self.part(&half, surface, halvings - 1)?);
            }
        }
        Ok(most)
    }

    /// The length of the longer of the two shortest steps that are found; infinite if there are none.
    fn direct(&mut self, part: &[[f64; 3]], surface: u32) -> Result<f64, Error> {
        let around = Around::of(part);
        self.near.place(self.truth, around.grown(self.longest() + 4.0 * SLACK))?;
        self.find_steps(part, surface)?;
        let mut known = [None; 2];
        for k in 0..self.steps.len() {
            let (long, step) = self.steps[k];
            self.shifted.clear();
            self.shifted.try_reserve(part.len())?;
            self.shifted.extend(part.iter().map(|p| -> [f64; 3] { axes(|k| p[k] + step[k]) }));
            if let Some(inside) = self.near.of(self.truth, &self.shifted)? {
                known[usize::from(inside)].get_or_insert(long);
                if let [Some(outer), Some(inner)] = known {
                    return Ok(f64::max(outer, inner) + SLACK);
                }
            }
        }
        Ok(f64::INFINITY)
    }

    /// The greatest length of a step.
    fn longest(&self) -> f64 {
        2.0 * self.tolerance + 4.0 * SLACK
    }

    /// Finds the steps that move a part to certain sides of the surfaces near it, the shortest first.
    fn find_steps(&mut self, part: &[[f64; 3]], surface: u32) -> Result<(), Error> {
        self.steps.clear();
        let (truth, tolerance) = (self.truth, self.tolerance);
        let around = Around::of(part).grown(tolerance);
        // The surface of the triangle, and the surfaces of the leaves around.
        let mut numbers = [surface; MOST];
        let mut found: [Option<(Local, [f64; 2])>; MOST] = [None; MOST];
        let (mut count, mut is_near) = (0, false);
        let mut take = |near: &mut Near, number: u32| -> Result<(), Error> {
            if count == MOST || number == NONE || numbers[..count].contains(&number) {
                return Ok(());
            }
            let Some(local) = near.function(truth.figures, number)? else {
                is_near = true;
                return Ok(());
            };
            let range = local.over(part);
            let size = local.steepness() * tolerance;
            if range[0] <= size && range[1] >= -size {
                (numbers[count], found[count], is_near) = (number, Some((*local, range)), true);
                count += 1;
            }
            Ok(())
        };
        take(&mut self.near, surface)?;
        for k in 0..self.near.leaves().len() {
            let (cell, leaf) = self.near.leaves()[k];
            if let Leaf::Open(number) = leaf
                && let Some(open) = truth.open(number).open
                && cube(cell).meets(&around)
            {
                for &number in open.indices() {
                    take(&mut self.near, number)?;
                }
            }
        }
        self.is_near = is_near;
        for choice in 1..3usize.pow(count as u32) {
            let (mut rows, mut shares, mut count) = ([[0.0; 3]; MOST], [0.0; MOST], 0);
            for (k, (local, [low, high])) in found.iter().flatten().enumerate() {
                let sign = [0.0, 1.0, -1.0][choice / 3usize.pow(k as u32) % 3];
                if sign != 0.0 {
                    let steep = local.steepness();
                    rows[count] = local.gradient().each(|c| sign * c / steep);
                    // The distance of the part from the wanted side.
                    let wrong = if sign > 0.0 { -low } else { *high };
                    let flattest = part.iter().fold(steep, |least, &p| least.min(local.steepness_at(p)));
                    shares[count] = wrong.max(0.0) / flattest + SLACK;
                    count += 1;
                }
            }
            let Some(step) = shortest(&rows[..count], &shares) else { continue };
            // The last length is for slivers in neighbouring cells, whose sides are hidden by rounding.
            let far = ASIDE * self.tolerance / length(step).max(SLACK);
            for longer in [LONGER, 1.25 * LONGER, LONGER + far] {
                let step = step.each(|c| c * longer);
                let long = length(step);
                if long <= self.longest() {
                    memory::push(&mut self.steps, (long, step))?;
                }
            }
        }
        self.steps.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(())
    }

    /// Bounds the distance of a part from the boundary by points around it: infinite if they are all on one
    /// side, or the budget is spent.
    fn around(&mut self, part: &[[f64; 3]]) -> Result<f64, Error> {
        let centre = Around::of(part).centre();
        let radius = part.iter().fold(0.0, |most: f64, &p| most.max(length(minus(p, centre))));
        let mut away = (0.25 * self.tolerance).max(SLACK);
        while away < 2.0 && self.spend() {
            if self.are_apart(centre, away)? {
                // The diagonal of the cube of points, and the part's own extent.
                return Ok(1.733 * away + radius);
            }
            away *= 2.0;
        }
        Ok(f64::INFINITY)
    }

    /// Bounds the distance of all points of a cell in which nothing is known from the boundary, by points
    /// around it: infinite if they are all on one side.
    fn around_cell(&mut self, number: u32, cell: Cell) -> Result<f64, Error> {
        if let Some(&known) = self.of_cells.get(&number) {
            return Ok(known);
        }
        let around = cube(cell);
        let (mut away, mut most) = (1.25 * around.half(), f64::INFINITY);
        while away < 2.0 && most == f64::INFINITY {
            if self.are_apart(around.centre(), away)? {
                most = 1.733 * (away + around.half());
            }
            away *= 2.0;
        }
        self.of_cells.try_reserve(1)?;
        self.of_cells.insert(number, most);
        Ok(most)
    }

    /// Tests the corners, the middles of edges and faces, and the centre of a cube. Returns whether some of
    /// these points lie inside and others outside.
    fn are_apart(&mut self, centre: [f64; 3], half: f64) -> Result<bool, Error> {
        let mut known = [false; 2];
        // (Points at opposite ends come one after the other.)
        for k in (0..27).map(|k| if k % 2 == 0 { k / 2 } else { 26 - k / 2 }) {
            let point: [f64; 3] =
                axes(|i| centre[i] + half * ([1, 3, 9].each(|p| k / p % 3)[i] as f64 - 1.0));
            self.near.place(self.truth, Around::of(&[point]))?;
            if let Some(inside) = self.near.of(self.truth, &[point])? {
                known[usize::from(inside)] = true;
            }
            if known == [true; 2] {
                return Ok(true);
            }
        }
        Ok(false)
    }
}
