//! Convex polygons that a surface is cut into.

use super::surface::{Facet, Near};
use crate::lattice::Each;
use crate::lattice::axes;

/// The maximal number of corners of a piece.
pub(super) const MOST: usize = 8;

/// The maximal number of successive cuts of a piece. Each cut rounds, by less than 2^-49 of the largest
/// coordinate, and a piece is cut at most three times at once.
pub(super) const GENERATIONS: u8 = 60;

/// A corner with the bounds of its distance, once computed.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub(super) at: [f64; 3],
    pub(super) near: Near,
}

/// A convex polygon.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    corners: [Corner; MOST],
    count: u8,
    pub(super) generation: u8,
    /// A facet that may be near to all of the piece.
    pub(super) hint: Facet,
    /// The maximal distance of the surface from the piece.
    pub(super) radius: f64,
    /// An upper bound of the distance of the surface's points next to the piece.
    pub(super) upper: f64,
}

pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    axes(|axis| a[axis] - b[axis])
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    axes(|axis| {
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

impl Piece {
    pub(super) fn triangle(corners: [Corner; 3], radius: f64) -> Piece {
        let mut all = [corners[0]; MOST];
        all[..3].copy_from_slice(&corners);
        Piece { corners: all, count: 3, generation: 0, hint: Facet::NONE, radius, upper: f64::INFINITY }
    }

    pub(super) fn corners(&self) -> &[Corner] {
        &self.corners[..self.count as usize]
    }

    pub(super) fn corners_mut(&mut self) -> &mut [Corner] {
        &mut self.corners[..self.count as usize]
    }

    pub(super) fn centroid(&self) -> [f64; 3] {
        let share = 1.0 / f64::from(self.count);
        axes(|axis| self.corners().iter().map(|corner| share * corner.at[axis]).sum())
    }

    /// A part of the piece, still without corners.
    fn part(&self, hint: Facet) -> Piece {
        Piece { count: 0, generation: self.generation + 1, hint, ..*self }
    }

    fn push(&mut self, corner: Corner) {
        self.corners[self.count as usize] = corner;
        self.count += 1;
    }

    /// Returns the two corners that are farthest from each other, and the square of their distance.
    pub(super) fn diameter(&self) -> (usize, usize, f64) {
        let corners = self.corners();
        let mut most = (0, 0, 0.0);
        for (i, a) in corners.iter().enumerate() {
            for (j, b) in corners.iter().enumerate().skip(i + 1) {
                let way = minus(a.at, b.at);
                let square = dot(way, way);
                if square > most.2 {
                    most = (i, j, square);
                }
            }
        }
        most
    }

    /// Returns the parts where a function is negative and where it is positive. The function has these values
    /// at the corners and is approximately linear. `None` if one of the parts would be the whole piece, or
    /// the parts would not be convex.
    pub(super) fn cut(&self, value: impl Fn(&Corner) -> f64) -> Option<[Piece; 2]> {
        let (corners, count) = (self.corners(), self.count as usize);
        let mut values = [0.0; MOST];
        let mut most: f64 = 0.0;
        for (value_at, corner) in values.iter_mut().zip(corners) {
            *value_at = value(corner);
            most = most.max(value_at.abs());
        }
        // A corner with a value of about zero lies on the cut.
        const ZERO: f64 = 1.0 / (1u64 << 36) as f64;
        let mut signs = [0i8; MOST];
        for (sign, &value) in signs.iter_mut().zip(&values[..count]) {
            *sign = i8::from(value > ZERO * most) - i8::from(value < -ZERO * most);
        }
        let signs = &signs[..count];
        let (mut last, mut changes) = (signs.iter().rev().find(|&&sign| sign != 0).copied()?, 0);
        for &sign in signs.iter().filter(|&&sign| sign != 0) {
            changes += usize::from(sign != last);
            last = sign;
        }
        let gained = |side: i8| signs.iter().filter(|&&sign| sign * side >= 0).count() + 2;
        if changes != 2 || gained(1).max(gained(-1)) > MOST {
            return None;
        }
        let mut parts = [self.part(Facet::NONE), self.part(Facet::NONE)];
        for i in 0..count {
            let j = (i + 1) % count;
            if signs[i] <= 0 {
                parts[0].push(corners[i]);
            }
            if signs[i] >= 0 {
                parts[1].push(corners[i]);
            }
            if signs[i] * signs[j] < 0 {
                let t = values[i] / (values[i] - values[j]);
                let (a, b) = (corners[i].at, corners[j].at);
                let at = axes(|axis| a[axis] + t * (b[axis] - a[axis]));
                let corner = Corner { at, near: Near::OPEN };
                parts.iter_mut().for_each(|part| part.push(corner));
            }
        }
        Some(parts)
    }

    /// Cuts the piece into halves, across its diameter.
    pub(super) fn halves(&self) -> Option<[Piece; 2]> {
        let (i, j, _) = self.diameter();
        let (a, b) = (self.corners[i].at, self.corners[j].at);
        let (way, middle) = (minus(b, a), axes(|axis| 0.5 * a[axis] + 0.5 * b[axis]));
        self.cut(|corner| dot(way, minus(corner.at, middle)))
    }

    /// Cuts the piece into two parts with fewer corners, along a diagonal. (For five corners and more.)
    pub(super) fn fans(&self) -> [Piece; 2] {
        let (corners, half) = (self.corners(), self.count as usize / 2);
        let mut parts = [self.part(self.hint), self.part(self.hint)];
        corners[..=half].iter().for_each(|&corner| parts[0].push(corner));
        corners[half..].iter().chain(&corners[..1]).for_each(|&corner| parts[1].push(corner));
        parts
    }

    /// Returns the parts that lie beyond the edges of a triangle, projected along its normal, and the part
    /// within the edges, if that is not the whole piece. `facet` is the triangle. `None` if no part lies
    /// within.
    pub(super) fn seen_through(
        &self,
        [a, b, c]: [[f64; 3]; 3],
        facet: Facet,
    ) -> Option<([Option<Piece>; 3], Piece)> {
        let normal = cross(minus(b, a), minus(c, a));
        let size = dot(normal, normal);
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        let outward = [[a, b], [b, c], [c, a]].each(|[from, to]| (from, cross(minus(to, from), normal)));
        // No part lies within the triangle if the whole piece lies beyond one edge.
        let is_beyond = |&(from, outward): &([f64; 3], [f64; 3])| {
            self.corners().iter().all(|corner| dot(outward, minus(corner.at, from)) >= 0.0)
        };
        if outward.iter().any(is_beyond) {
            return None;
        }
        let (mut rest, mut beyond, mut is_cut) = (*self, [None; 3], false);
        for ((from, outward), beyond) in outward.into_iter().zip(&mut beyond) {
            if let Some([within, part]) = rest.cut(|corner| dot(outward, minus(corner.at, from))) {
                *beyond = Some(part);
                (rest, is_cut) = (within, true);
            }
        }
        rest.hint = facet;
        rest.generation = self.generation + 1;
        beyond.iter_mut().flatten().for_each(|part| part.generation = self.generation + 1);
        is_cut.then_some((beyond, rest))
    }
}
