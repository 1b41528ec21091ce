//! A ray in a PARTIAL cell that keeps surfaces.

use super::line::Line;
use crate::lattice::{Ball, axes};
use crate::octree::cuts::{CellIds, Figure, FigureLine, Head, SurfacesRef};

/// The table of a cell, and its surfaces along a ray.
pub(super) struct CutLine<'a> {
    surfaces: [Option<(Figure<'a>, FigureLine)>; 3],
    table: u8,
}

/// A piece of a ray.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub low: f64,
    pub high: f64,
    /// Whether it lies inside; `None` if that is not known.
    pub is_inside: Option<bool>,
    /// A surface that it may cross.
    pub surface: Option<u8>,
}

/// Most pieces that are looked at in a cell. What is left is not known.
const MOST_PIECES: u32 = 1024;

/// Pieces are halved down to this part of the ray's stay in the cell.
const FINEST: f64 = 1.0 / (1u64 << 36) as f64;

/// Pieces that wait: one for each halving.
const MOST_WAITING: usize = 48;

impl<'a> CutLine<'a> {
    pub(super) fn new(surfaces: &SurfacesRef<'a>, ids: &CellIds, table: u8, line: &Line<'_>) -> CutLine<'a> {
        let from = line.ray.from.map(Ball::exactly);
        let direction = line.ray.direction.map(|[high, low]| Ball::exactly(high).plus(Ball::exactly(low)));
        let mut own = [None; 3];
        for (to, &id) in own.iter_mut().zip(ids.iter()) {
            *to = Figure::new(surfaces, id).map(|figure| (figure, figure.line(from, direction)));
        }
        CutLine { surfaces: own, table }
    }

    /// Shows the pieces of the ray between two times in their order, until `visit` has seen enough.
    pub(super) fn walk(&self, low: f64, high: f64, mut visit: impl FnMut(Piece) -> bool) {
        let finest = (high - low) * FINEST;
        let mut waiting = [(0.0, 0.0, 0u8); MOST_WAITING];
        waiting[0] = (low, high, self.table);
        let (mut count, mut left) = (1, MOST_PIECES);
        while count > 0 {
            count -= 1;
            let (low, high, mut table) = waiting[count];
            left = left.saturating_sub(1);
            let mut surface = None;
            for (i, own) in self.surfaces.iter().enumerate() {
                if !Head::needs(table, i) {
                    continue;
                }
                match own.as_ref().and_then(|(figure, line)| figure.side_along(line, low, high)) {
                    Some(side) => table = Head::on_side(table, i, side),
                    None => surface = surface.or(Some(i as u8)),
                }
            }
            let middle = 0.5 * low + 0.5 * high;
            let is_inside = match Head(table) {
                Head::NOWHERE => Some(false),
                Head::EVERYWHERE => Some(true),
                _ if left > 0
                    && high - low > finest
                    && low < middle
                    && middle < high
                    && count + 2 <= MOST_WAITING =>
                {
                    waiting[count] = (middle, high, table);
                    waiting[count + 1] = (low, middle, table);
                    count += 2;
                    continue;
                }
                _ => None,
            };
            if !visit(Piece { low, high, is_inside, surface }) {
                return;
            }
        }
    }

    /// The outward normal, against the ray, of a surface where the ray is at a time.
    pub(super) fn normal(&self, line: &Line<'_>, surface: u8, t: f64) -> Option<[f64; 3]> {
        let (figure, _) = self.surfaces[usize::from(surface)].as_ref()?;
        let point = axes(|axis| line.ray.from[axis] + t * line.ray.direction[axis][0]);
        let gradient = figure.gradient(point);
        let along: f64 = (0..3).map(|axis| gradient[axis] * line.ray.direction[axis][0]).sum();
        let is_vector = gradient.iter().all(|c| c.is_finite()) && gradient != [0.0; 3];
        is_vector.then(|| gradient.map(|c| if along > 0.0 { -c } else { c }))
    }
}
