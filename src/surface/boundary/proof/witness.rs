//! How far a triangle is from the boundary: a step along which all of it comes to lie inside, and one to outside. Between the two lies the
//! boundary.

use super::super::edges::NONE;
use super::super::figures::{dot, length, minus, shortest};
use super::super::leaves::Leaf;
use super::clip::clip;
use super::local::Local;
use super::truth::{Around, LEAST, Truth, cube};
use crate::error::Error;
use crate::lattice::{Cell, axes};
use crate::memory;
use alloc::vec::Vec;

/// How often a piece of a triangle is halved at most.
const HALVINGS: u32 = 6;

/// Surfaces that steps take into account at most.
const MOST: usize = 3;

/// Steps are a little longer than they need be.
const LONGER: f64 = 1.0 + 1.0 / 128.0;

/// What is added to each step (edges of the universe): places are off by some last digits.
const SLACK: f64 = 1e-14;

/// What looks for steps.
pub(super) struct Witnesses<'t> {
    truth: &'t Truth<'t>,
    tolerance: f64,
    leaves: Vec<(Cell, Leaf)>,
    others: Vec<(Cell, Leaf)>,
    shifted: Vec<[f64; 3]>,
    steps: Vec<(f64, [f64; 3])>,
}

impl<'t> Witnesses<'t> {
    pub(super) fn new(truth: &'t Truth<'t>, tolerance: f64) -> Witnesses<'t> {
        Witnesses {
            truth,
            tolerance,
            leaves: Vec::new(),
            others: Vec::new(),
            shifted: Vec::new(),
            steps: Vec::new(),
        }
    }

    /// Calls `told` for the parts of a triangle in all leaves, with what no point of the part is further from the boundary than.
    pub(super) fn triangle(
        &mut self,
        triangle: [[f64; 3]; 3],
        surface: u32,
        told: &mut impl FnMut(Cell, f64) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let mut leaves = Vec::new();
        self.truth.met_by(&triangle, &mut leaves)?;
        for (cell, leaf) in leaves {
            let mut part = memory::copied(&triangle)?;
            if !matches!(leaf, Leaf::Outside) {
                let cube = cube(cell);
                clip(&mut part, cube.low, cube.high)?;
            }
            if part.len() >= 3 {
                let most = self.part(&part, surface, HALVINGS)?;
                told(cell, most)?;
            }
        }
        Ok(())
    }

    fn part(&mut self, part: &[[f64; 3]], surface: u32, halvings: u32) -> Result<f64, Error> {
        let direct = self.direct(part, surface)?;
        if direct <= self.tolerance {
            return Ok(direct);
        }
        if halvings == 0 {
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
        if best.0 <= 0.25 * self.tolerance {
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
        self.find_steps(part, surface)?;
        let mut known = [None; 2];
        for k in 0..self.steps.len() {
            let (long, step) = self.steps[k];
            self.shifted.clear();
            self.shifted.try_reserve(part.len())?;
            self.shifted.extend(part.iter().map(|p| -> [f64; 3] { axes(|k| p[k] + step[k]) }));
            if let Some(inside) = self.truth.of(&self.shifted, &mut self.others)? {
                known[usize::from(inside)].get_or_insert(long);
                if let [Some(outer), Some(inner)] = known {
                    return Ok(f64::max(outer, inner) + SLACK);
                }
            }
        }
        Ok(f64::INFINITY)
    }

    /// The steps that lead a part to certain sides of the surfaces next to it, the shortest first.
    fn find_steps(&mut self, part: &[[f64; 3]], surface: u32) -> Result<(), Error> {
        self.steps.clear();
        let around = Around::of(part);
        let (centre, reach) = (around.centre(), around.half() + self.tolerance);
        let mut near: Vec<(Local, [f64; 2])> = Vec::new();
        let mut numbers: Vec<u32> = Vec::new();
        let figures = self.truth.figures;
        let mut take = |number: u32| -> Result<(), Error> {
            if near.len() == MOST || numbers.contains(&number) {
                return Ok(());
            }
            memory::push(&mut numbers, number)?;
            if let Some(local) = Local::new(figures, number, centre, reach.max(LEAST)) {
                let [low, high] = local.over(part);
                let size = local.steepness() * self.tolerance;
                if low <= size && high >= -size {
                    memory::push(&mut near, (local, [low, high]))?;
                }
            }
            Ok(())
        };
        if surface != NONE {
            take(surface)?;
        }
        self.truth.meeting(&around.grown(self.tolerance), &mut self.leaves)?;
        for &(_, leaf) in &self.leaves {
            if let Leaf::Open(number) = leaf
                && let Some(open) = self.truth.open(number).open
            {
                for &number in open.indices() {
                    take(number)?;
                }
            }
        }
        for choice in 1..3usize.pow(near.len() as u32) {
            let (mut rows, mut shares, mut count) = ([[0.0; 3]; MOST], [0.0; MOST], 0);
            for (k, (local, [low, high])) in near.iter().enumerate() {
                let sign = [0.0, 1.0, -1.0][choice / 3usize.pow(k as u32) % 3];
                if sign != 0.0 {
                    let steep = local.steepness();
                    rows[count] = local.gradient().map(|c| sign * c / steep);
                    // How far some of it lies on the wrong side.
                    let wrong = if sign > 0.0 { -low } else { *high };
                    let flattest = part.iter().fold(steep, |least, &p| least.min(local.steepness_at(p)));
                    shares[count] = wrong.max(0.0) / flattest + SLACK;
                    count += 1;
                }
            }
            let Some(step) = shortest(&rows[..count], &shares) else { continue };
            for longer in [LONGER, 1.25 * LONGER] {
                let step = step.map(|c| c * longer);
                let long = length(step);
                if long <= 2.0 * self.tolerance + 4.0 * SLACK {
                    memory::push(&mut self.steps, (long, step))?;
                }
            }
        }
        self.steps.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(())
    }

    /// How far all of a part is from the boundary, by points around it: infinite if they are all on one side.
    fn around(&mut self, part: &[[f64; 3]]) -> Result<f64, Error> {
        let centre = Around::of(part).centre();
        let radius = part.iter().fold(0.0, |most: f64, &p| most.max(length(minus(p, centre))));
        let mut away = (0.25 * self.tolerance).max(SLACK);
        while away < 2.0 {
            let mut known = [false; 2];
            for k in 0..27 {
                let point: [f64; 3] =
                    axes(|i| centre[i] + away * ([1, 3, 9].map(|p| k / p % 3)[i] as f64 - 1.0));
                if let Some(inside) = self.truth.of(&[point], &mut self.others)? {
                    known[usize::from(inside)] = true;
                }
            }
            if known == [true; 2] {
                // The diagonal of the cube of points, and the part's own extent.
                return Ok(1.733 * away + radius);
            }
            away *= 2.0;
        }
        Ok(f64::INFINITY)
    }
}
