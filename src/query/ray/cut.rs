//! A ray in a PARTIAL cell that keeps surfaces.

use super::line::Line;
use crate::lattice::Each;
use crate::lattice::{Ball, axes};
use crate::octree::cuts::{CellIds, Division, Figure, FigureLine, Head, SurfacesRef};

/// The table of a cell, and its surfaces along a ray between two times.
pub(super) struct CutLine<'a> {
    surfaces: [Option<FigureLine<'a>>; 3],
    table: u8,
    low: f64,
    high: f64,
}

/// A piece of a ray, between two parameters of its stay in the cell, 0 to 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub low: f64,
    pub high: f64,
    /// Whether the piece lies inside; `None` if unknown.
    pub is_inside: Option<bool>,
    /// A surface that the piece may cross.
    pub surface: Option<u8>,
}

/// The maximal number of pieces visited in a cell. The rest is undecided.
const MOST_PIECES: u32 = 1024;

/// The length of the shortest pieces, as a part of the ray's stay in the cell.
const FINEST: f64 = 1.0 / (1u64 << 36) as f64;

/// The maximal number of waiting pieces: one for each halving, and one for each side of each crossing.
const MOST_WAITING: usize = 56;

impl<'a> CutLine<'a> {
    pub(super) fn new(
        surfaces: &SurfacesRef<'a>,
        ids: &CellIds,
        table: u8,
        line: &Line<'_>,
        [low, high]: [f64; 2],
    ) -> CutLine<'a> {
        let direction = line.ray.direction.each(|[high, low]| Ball::exactly(high).plus(Ball::exactly(low)));
        // In the cell, time runs from 0 to 1, so that distant starts cost no digits.
        let (begin, stay) = (Ball::exactly(low), Ball::exactly(high).minus(Ball::exactly(low)));
        let at = axes(|axis| Ball::exactly(line.ray.from[axis]).plus(direction[axis].times(begin)));
        let direction = direction.each(|c| c.times(stay));
        let mut own = [None; 3];
        // (A ray that does not end in a cell has no finite length there.)
        for (to, &id) in own.iter_mut().zip(ids.iter()).filter(|_| (high - low).is_finite()) {
            *to = Figure::new(surfaces, id).map(|figure| figure.line(at, direction));
        }
        CutLine { surfaces: own, table, low, high }
    }

    /// Passes the pieces of the ray to `visit`, in their order, until `visit` returns that it has seen
    /// enough.
    pub(super) fn walk(&self, mut visit: impl FnMut(Piece) -> bool) {
        let mut waiting = [(0.0, 0.0, 0u8); MOST_WAITING];
        waiting[0] = (0.0, 1.0, self.table);
        let (mut count, mut left) = (1, MOST_PIECES);
        while count > 0 {
            count -= 1;
            let (low, high, mut table) = waiting[count];
            left = left.saturating_sub(1);
            let mut surface = None;
            for (i, line) in self.surfaces.iter().enumerate() {
                if !Head::needs(table, i) {
                    continue;
                }
                match line.as_ref().and_then(|line| line.side(low, high)) {
                    Some(side) => table = Head::on_side(table, i, side),
                    None => surface = surface.or(Some(i as u8)),
                }
            }
            let may_divide = left > 0 && high - low > FINEST && count + 2 <= MOST_WAITING;
            let is_inside = match Head(table) {
                Head::NOWHERE => Some(false),
                Head::EVERYWHERE => Some(true),
                _ => match self.division(table, low, high).filter(|_| may_divide) {
                    Some(middle) => {
                        waiting[count] = (middle, high, table);
                        waiting[count + 1] = (low, middle, table);
                        count += 2;
                        continue;
                    }
                    None => None,
                },
            };
            if !visit(Piece { low, high, is_inside, surface }) {
                return;
            }
        }
    }

    /// Returns the parameter at which to divide a piece whose table is undecided; `None` if no part of the
    /// piece would be decided. Next to known crossings, the pieces between them are decided at once, whereas
    /// halving takes three dozen steps to each.
    fn division(&self, table: u8, low: f64, high: f64) -> Option<f64> {
        let (mut least, mut middle) = (high, None);
        let lines = self.surfaces.iter().enumerate().filter(|&(i, _)| Head::needs(table, i));
        for line in lines.filter_map(|(_, line)| line.as_ref()) {
            match line.division(low, high) {
                Division::At(t) => least = least.min(t),
                Division::InHalves => middle = Some(0.5 * low + 0.5 * high),
                Division::Nowhere => {}
            }
        }
        if least < high { Some(least) } else { middle }
    }

    /// The times of a piece, rounded outward. The ends of the stay are exact.
    pub(super) fn around(&self, low: f64, high: f64) -> [f64; 2] {
        [self.time(low, false), self.time(high, true)]
    }

    /// The times of a piece, rounded inward.
    pub(super) fn within(&self, low: f64, high: f64) -> [f64; 2] {
        [self.time(low, true), self.time(high, false)]
    }

    fn time(&self, part: f64, is_upper: bool) -> f64 {
        let time = self.low + part * (self.high - self.low);
        let slack = 4.0 * f64::EPSILON * (self.low.abs() + self.high.abs());
        match part {
            0.0 => self.low,
            1.0 => self.high,
            _ if is_upper => time + slack,
            _ => time - slack,
        }
    }

    /// Returns the outward normal, against the ray, of a surface at the ray's place at a time.
    pub(super) fn normal(&self, line: &Line<'_>, surface: u8, t: f64) -> Option<[f64; 3]> {
        let figure = self.surfaces[usize::from(surface)].as_ref()?.figure();
        let point = axes(|axis| line.ray.from[axis] + t * line.ray.direction[axis][0]);
        let gradient = figure.gradient(point);
        let along: f64 = (0..3).map(|axis| gradient[axis] * line.ray.direction[axis][0]).sum();
        let is_vector = gradient.iter().all(|c| c.is_finite()) && gradient != [0.0; 3];
        is_vector.then(|| gradient.each(|c| if along > 0.0 { -c } else { c }))
    }
}
