//! Triangles between the vertices of sheets.
//!
//! Each crossing has a polygon through the sheets around it. The polygons are the dual of the surface that
//! the sheets form. This surface is closed, so the triangles of the polygons are closed, too. Three cases
//! would give an edge more than two triangles, and get additional vertices:
//!
//! * Where several arcs lie between the same two sheets, each of them gets a vertex.
//! * A polygon with such a vertex, and a polygon whose diagonals both are edges already, gets a vertex at its
//!   crossing.
//! * A triangle of three sheets with two crossings each also gets one, if its other side is a triangle, too.

use super::sheets::{NONE, Sheets};
use crate::error::{Error, MeshError};
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::sqrt;
use crate::memory;
use alloc::vec::Vec;
use hashbrown::HashSet;

/// A point of the surface, in unit coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) at: [f64; 3],
    /// The outward unit normal; all zero if it is not known.
    pub(super) normal: [f64; 3],
}

/// The triangles of the sheets.
#[derive(Default)]
pub(super) struct Triangles {
    pub(super) vertices: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// The crossing to which each triangle belongs.
    pub(super) crossings: Vec<u32>,
}

/// Two distances count as equal if they differ by at most this, in edges of the universe.
const ALIKE: f64 = 1e-12;

struct Maker<'s> {
    sheets: &'s Sheets,
    places: &'s [Place],
    made: Triangles,
    /// The vertex of each arc; usually [`NONE`].
    of_arcs: Vec<u32>,
    /// Edges between sheets, the lower sheet first.
    edges: HashSet<(u32, u32)>,
}

impl Triangles {
    /// `vertices` are those of the sheets, `places` those of the crossings.
    pub(super) fn of(
        sheets: &Sheets,
        vertices: Vec<[f64; 3]>,
        places: &[Place],
        wants_centre: impl Fn(u32) -> bool,
    ) -> Result<Triangles, Error> {
        let made = Triangles { vertices, ..Triangles::default() };
        let mut maker = Maker { sheets, places, made, of_arcs: Vec::new(), edges: HashSet::new() };
        maker.arcs(&wants_centre)?;
        for crossing in 0..sheets.crossings.len() as u32 {
            maker.polygon(crossing, wants_centre(crossing))?;
        }
        if maker.made.vertices.len().max(maker.made.triangles.len()) > NONE as usize - 1 {
            return Err(MeshError::TooMany.into());
        }
        Ok(maker.made)
    }
}

impl Maker<'_> {
    fn vertex(&mut self, at: [f64; 3]) -> Result<u32, Error> {
        memory::push(&mut self.made.vertices, at)?;
        Ok(self.made.vertices.len() as u32 - 1)
    }

    fn triangle(&mut self, crossing: u32, triangle: [u32; 3]) -> Result<(), Error> {
        memory::push(&mut self.made.triangles, triangle)?;
        memory::push(&mut self.made.crossings, crossing)
    }

    /// Finds arcs that need a vertex, and the edges along the others.
    fn arcs(&mut self, wants_centre: &impl Fn(u32) -> bool) -> Result<(), Error> {
        let sheets = self.sheets;
        let mut pairs: Vec<(u32, u32, u32)> = memory::with_capacity(sheets.arcs.len())?;
        for (number, arc) in (0u32..).zip(&sheets.arcs) {
            let [a, b] = sheets.beside(arc);
            pairs.push((a.min(b), a.max(b), number));
        }
        pairs.sort_unstable();
        self.of_arcs = memory::filled(sheets.arcs.len(), NONE)?;
        self.edges.try_reserve(pairs.len() + pairs.len() / 2)?;
        for same in pairs.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            for &(low, high, number) in same {
                let arc = &sheets.arcs[number as usize];
                if same.len() > 1 || arc.crossings.iter().all(|&crossing| wants_centre(crossing)) {
                    let at = self.on_face(number);
                    self.of_arcs[number as usize] = self.vertex(at)?;
                } else {
                    self.edges.insert((low, high));
                }
            }
        }
        Ok(())
    }

    /// A point for the middle of an arc: where its planes meet in the face, if that point lies nearby,
    /// otherwise half-way.
    fn on_face(&self, number: u32) -> [f64; 3] {
        let arc = &self.sheets.arcs[number as usize];
        let axis = usize::from(arc.axis);
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let [p, q] = arc.crossings.each(|crossing| self.places[crossing as usize]);
        let middle = axes(|k| 0.5 * (p.at[k] + q.at[k]));
        let (a, b) = ([p.normal[u], p.normal[v]], [q.normal[u], q.normal[v]]);
        let determinant = a[0] * b[1] - a[1] * b[0];
        let sizes = sqrt((a[0] * a[0] + a[1] * a[1]) * (b[0] * b[0] + b[1] * b[1]));
        if determinant.abs() <= 0.2 * sizes {
            return middle;
        }
        let (x, y) = (
            a[0] * (p.at[u] - middle[u]) + a[1] * (p.at[v] - middle[v]),
            b[0] * (q.at[u] - middle[u]) + b[1] * (q.at[v] - middle[v]),
        );
        let mut at = middle;
        at[u] += (x * b[1] - y * a[1]) / determinant;
        at[v] += (y * a[0] - x * b[0]) / determinant;
        let apart = |k: usize| (p.at[k] - q.at[k]).abs();
        let most = apart(u).max(apart(v));
        if (at[u] - middle[u]).abs().max((at[v] - middle[v]).abs()) <= 0.5 * most { at } else { middle }
    }

    fn polygon(&mut self, number: u32, wants_centre: bool) -> Result<(), Error> {
        let sheets = self.sheets;
        let (crossing, around) = (&sheets.crossings[number as usize], &sheets.around[number as usize]);
        let (mut ring, mut count) = ([NONE; 8], 0);
        let mut has_arcs = false;
        for place in 0..4 {
            let arc = crossing.arcs[place];
            if arc == NONE {
                continue;
            }
            ring[count] = around[place];
            count += 1;
            let middle = self.of_arcs[arc as usize];
            if middle != NONE {
                ring[count] = middle;
                count += 1;
                has_arcs = true;
            }
        }
        let ring = &mut ring[..count];
        if !crossing.starts_inside {
            ring.reverse();
        }
        if !has_arcs && !wants_centre {
            match *ring {
                [a, b, c] => {
                    let is_double = ring.iter().all(|&sheet| sheets.sheets[sheet as usize].crossings == 2);
                    if !is_double {
                        return self.triangle(number, [a, b, c]);
                    }
                }
                [a, b, c, d] => {
                    if let Some(is_first) = self.diagonal(number, [a, b, c, d]) {
                        let (p, q) = if is_first { (a, c) } else { (b, d) };
                        self.edges.try_reserve(1)?;
                        self.edges.insert((p.min(q), p.max(q)));
                        let halves = if is_first { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                        self.triangle(number, halves[0])?;
                        return self.triangle(number, halves[1]);
                    }
                }
                _ => {}
            }
        }
        let centre = self.vertex(self.places[number as usize].at)?;
        for k in 0..count {
            self.triangle(number, [ring[k], ring[(k + 1) % count], centre])?;
        }
        Ok(())
    }

    /// Returns the diagonal of a quadrilateral: the one from its first corner (`true`) or the other one.
    /// `None` if neither is allowed, or both would make the quadrilateral fold.
    fn diagonal(&self, number: u32, ring: [u32; 4]) -> Option<bool> {
        let Place { at, normal } = self.places[number as usize];
        let [a, b, c, d] = ring.each(|sheet| self.made.vertices[sheet as usize]);
        let is_free = |p: u32, q: u32| !self.edges.contains(&(p.min(q), p.max(q)));
        // The number of triangles that face the wrong way, the distance of the crossing, and the length of
        // the diagonal.
        let cost = |halves: [[[f64; 3]; 3]; 2], is_free: bool, p: [f64; 3], q: [f64; 3]| {
            let folds = halves.iter().filter(|half| dot(area(half), normal) < 0.0).count();
            let away = halves.iter().map(|half| away(half, at)).fold(f64::INFINITY, f64::min);
            let way = minus(p, q);
            is_free.then_some((folds, away, dot(way, way)))
        };
        let first = cost([[a, b, c], [a, c, d]], is_free(ring[0], ring[2]), a, c);
        let second = cost([[a, b, d], [b, c, d]], is_free(ring[1], ring[3]), b, d);
        match (first, second) {
            (None, None) => None,
            (Some((folds, ..)), None) => (folds == 0).then_some(true),
            (None, Some((folds, ..))) => (folds == 0).then_some(false),
            (Some(first), Some(second)) => {
                if first.0.min(second.0) > 0 {
                    return None;
                }
                if first.0 != second.0 {
                    return Some(first.0 < second.0);
                }
                let is_alike = (first.1 - second.1).abs() <= ALIKE;
                Some(if is_alike { first.2 <= second.2 } else { first.1 < second.1 })
            }
        }
    }
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    axes(|k| a[k] - b[k])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Twice the area of a triangle along its normal.
fn area(&[a, b, c]: &[[f64; 3]; 3]) -> [f64; 3] {
    cross(minus(b, a), minus(c, a))
}

/// The distance of a point from a triangle.
pub(super) fn away(triangle: &[[f64; 3]; 3], at: [f64; 3]) -> f64 {
    let normal = area(triangle);
    let square = dot(normal, normal);
    let mut least = f64::INFINITY;
    let mut is_within = square > 0.0;
    for k in 0..3 {
        let (p, q) = (triangle[k], triangle[(k + 1) % 3]);
        let (side, way) = (minus(q, p), minus(at, p));
        is_within &= dot(cross(side, way), normal) >= 0.0;
        let length = dot(side, side);
        let t = if length > 0.0 { (dot(side, way) / length).clamp(0.0, 1.0) } else { 0.0 };
        let off = axes(|axis| way[axis] - t * side[axis]);
        least = least.min(dot(off, off));
    }
    if is_within {
        return dot(minus(at, triangle[0]), normal).abs() / sqrt(square);
    }
    sqrt(least)
}
