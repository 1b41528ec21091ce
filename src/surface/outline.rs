//! The outlines of plane regions of a surface.
//!
//! A *region* is the part of a surface that lies in one plane, with one outer side. Its outline consists of
//! the edges of all its triangles, without the edges that are used in both directions. Outlines are found
//! without triangles: a cell has the outlines of the surface in it, and so has a super-cell.
//!
//! A vertex of outlines is a *corner* unless all edges at it lie in one line. Between two corners, all
//! outlines that pass there are straight. So each outline can omit the other vertices, and the outlines still
//! fit together.

use super::bon::Cell;
use super::chunks;
use super::plane::{self, Plane};
use super::points::{self, Step};
use super::snapped::Snapped;
use super::table::{ENDS, MARCHING_CUBES, MOST, Triangles};
use crate::control::Job;
use crate::error::{Error, MeshError};
use crate::lattice::Each;
use crate::lattice::axes;
use crate::memory;
use crate::parallel;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// A step along the outline of a region, stored at the lower of its two samples. In a sorted list, steps in
/// opposite directions are neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    at: u64,
    /// The step's direction, the region's plane, and whether the step goes backwards.
    rest: u64,
}

impl Side {
    /// The step from a sample by `by`.
    fn new(from: [i32; 3], by: [i32; 3], plane: Plane) -> Side {
        let step = Step::by(by);
        let low = if step.is_back { axes(|axis| from[axis] + by[axis]) } else { from };
        let rest = u64::from(step.direction) << 40 | plane.code() << 1 | u64::from(step.is_back);
        Side { at: points::code(low), rest }
    }

    fn direction(self) -> u8 {
        (self.rest >> 40) as u8
    }

    /// The region's plane.
    fn plane(self) -> u64 {
        (self.rest >> 1) & ((1 << 39) - 1)
    }

    fn is_back(self) -> bool {
        self.rest & 1 != 0
    }

    /// The step without its sense.
    fn both(self) -> (u64, u64) {
        (self.at, self.rest >> 1)
    }

    /// The samples at the ends of the step, the lower one first.
    fn ends(self) -> [u64; 2] {
        [self.at, self.at + Step::stride(self.direction())]
    }
}

/// An edge of a region between two corners. The region lies to the left of the edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Edge {
    pub plane: u64,
    pub from: u32,
    pub to: u32,
}

/// The outlines of all regions.
pub(super) struct Outlines {
    /// The samples that are corners, ascending: the vertices of the mesh.
    pub corners: Vec<u64>,
    /// Sorted.
    pub edges: Vec<Edge>,
}

impl Outlines {
    /// Finds the outlines of the surface in cells. O(n log n), where n counts the cells that are not merged
    /// and the steps on the faces of merged cells.
    ///
    /// # Errors
    /// [`MeshError::TooMany`](crate::error::MeshError::TooMany), [`Error::OutOfMemory`] and
    /// [`Error::Cancelled`].
    pub fn of(
        cells: &[Cell],
        bias: i32,
        table: &Snapped,
        weight: usize,
        job: &Job<'_>,
        parallel: bool,
    ) -> Result<Outlines, Error> {
        let of_configuration = outlines(table);
        // Most steps cancel each other nearby.
        let found = chunks::map(cells.len(), weight / 2, job, parallel, |range| {
            let mut sides = Vec::new();
            for cell in &cells[range] {
                let corner = cell.corner(bias);
                if cell.level == 0 {
                    of_configuration[cell.configuration as usize].append(corner, &mut sides)?;
                } else {
                    append_super_cell(cell, corner, &mut sides)?;
                }
            }
            sides.sort_unstable();
            cancel(&mut sides);
            Ok(sides)
        })?;
        let mut sides = memory::with_capacity(found.iter().map(Vec::len).sum())?;
        found.iter().for_each(|part| sides.extend_from_slice(part));
        drop(found);
        parallel::sort(&mut sides, parallel);
        cancel(&mut sides);
        let corners = corners(&sides, parallel)?;
        if corners.len() > u32::MAX as usize {
            return Err(MeshError::TooMany.into());
        }
        let edges = edges(&sides, &corners, weight - weight / 2, job, parallel)?;
        Ok(Outlines { corners, edges })
    }
}

/// Removes pairs of opposite steps from a sorted list.
fn cancel(sides: &mut Vec<Side>) {
    let mut kept = 0;
    let mut i = 0;
    while i < sides.len() {
        let side = sides[i];
        let count = sides[i..].iter().take_while(|other| other.both() == side.both()).count();
        let backwards = sides[i..i + count].iter().filter(|side| side.is_back()).count();
        let forwards = count - backwards;
        let rest = sides[if forwards > backwards { i } else { i + count - 1 }];
        for _ in 0..forwards.abs_diff(backwards) {
            sides[kept] = rest;
            kept += 1;
        }
        i += count;
    }
    sides.truncate(kept);
}

/// The samples at which outlines turn or meet.
fn corners(sides: &[Side], parallel: bool) -> Result<Vec<u64>, Error> {
    let mut ends: Vec<(u64, u8)> = memory::with_capacity(2 * sides.len())?;
    let mut before = None;
    for side in sides {
        if before.replace((side.at, side.direction())) != Some((side.at, side.direction())) {
            ends.extend(side.ends().each(|end| (end, side.direction())));
        }
    }
    parallel::sort(&mut ends, parallel);
    let mut corners = Vec::new();
    for at_sample in ends.chunk_by(|a, b| a.0 == b.0) {
        if at_sample.iter().any(|end| end.1 != at_sample[0].1) {
            memory::push(&mut corners, at_sample[0].0)?;
        }
    }
    Ok(corners)
}

/// The edges between corners.
fn edges(
    sides: &[Side],
    corners: &[u64],
    weight: usize,
    job: &Job<'_>,
    parallel: bool,
) -> Result<Vec<Edge>, Error> {
    let mut numbers = HashMap::new();
    numbers.try_reserve(corners.len())?;
    numbers.extend(corners.iter().copied().zip(0u32..));
    let found = chunks::map(sides.len(), weight, job, parallel, |range| {
        let mut edges = Vec::new();
        for side in &sides[range] {
            let stride = Step::stride(side.direction());
            let (from, stride) =
                if side.is_back() { (side.at + stride, stride.wrapping_neg()) } else { (side.at, stride) };
            let Some(&from_number) = numbers.get(&from) else { continue };
            let mut at = from.wrapping_add(stride);
            // An outline that goes straight on from a corner ends at another corner.
            let to = loop {
                match numbers.get(&at) {
                    Some(&number) => break number,
                    None => at = at.wrapping_add(stride),
                }
            };
            memory::push(&mut edges, Edge { plane: side.plane(), from: from_number, to })?;
        }
        Ok(edges)
    })?;
    let mut edges = memory::with_capacity(found.iter().map(Vec::len).sum())?;
    found.iter().for_each(|part| edges.extend_from_slice(part));
    parallel::sort(&mut edges, parallel);
    Ok(edges)
}

/// The outlines of a configuration's triangles in a dual cell at the origin.
#[derive(Clone, Copy)]
struct OfCell {
    count: usize,
    /// Sides from one corner of the cell to another, in the plane of a region.
    sides: [([i32; 3], [i32; 3], Plane); 3 * MOST],
}

impl OfCell {
    const NONE: OfCell = OfCell { count: 0, sides: [([0; 3], [0; 3], Plane::NONE); 3 * MOST] };

    /// The outlines of the given triangles. Edges that are used in both directions in one plane are removed.
    fn of(triangles: impl Iterator<Item = (Plane, [[i32; 3]; 3])>) -> OfCell {
        let mut sum = OfCell::NONE;
        for (plane, [p, q, r]) in triangles {
            for (from, to) in [(p, q), (q, r), (r, p)] {
                let sides = &sum.sides[..sum.count];
                if let Some(back) = sides.iter().position(|side| *side == (to, from, plane)) {
                    sum.count -= 1;
                    sum.sides[back] = sum.sides[sum.count];
                } else {
                    sum.sides[sum.count] = (from, to, plane);
                    sum.count += 1;
                }
            }
        }
        sum
    }

    /// Appends all sides, step by step, for a cell with this lowest corner.
    fn append(&self, corner: [i32; 3], sides: &mut Vec<Side>) -> Result<(), Error> {
        for (from, to, plane) in &self.sides[..self.count] {
            let way = axes(|axis| to[axis] - from[axis]);
            let steps = way.iter().map(|w| w.abs()).max().unwrap_or(0);
            let by = way.each(i32::signum);
            sides.try_reserve(steps as usize)?;
            for k in 0..steps {
                let from = axes(|axis| corner[axis] + from[axis] + k * by[axis]);
                sides.push(Side::new(from, by, plane.moved(corner)));
            }
        }
        Ok(())
    }
}

/// The outlines of all configurations.
fn outlines(table: &Snapped) -> [OfCell; 256] {
    let mut outlines = [OfCell::NONE; 256];
    for (of_cell, triangles) in outlines.iter_mut().zip(&table.triangles) {
        let placed = triangles.list().iter().map(|&corners| {
            (plane::of_corners(corners), corners.each(|corner| plane::corner(corner.into())))
        });
        *of_cell = OfCell::of(placed);
    }
    outlines
}

/// Appends the outline of a super-cell: the polygon in which its plane cuts the cell.
fn append_super_cell(cell: &Cell, corner: [i32; 3], sides: &mut Vec<Side>) -> Result<(), Error> {
    let triangles = super_triangles(cell, corner).map(|triangle| (cell.plane, triangle));
    OfCell::of(triangles).append([0; 3], sides)
}

/// The triangles of a super-cell: those of marching cubes, with vertices where the plane cuts the cell's
/// edges. Triangles without area are left out.
pub(super) fn super_triangles(cell: &Cell, corner: [i32; 3]) -> impl Iterator<Item = [[i32; 3]; 3]> + use<> {
    let triangles: &'static Triangles = &MARCHING_CUBES[cell.configuration as usize];
    let (plane, size) = (cell.plane, 1 << cell.level);
    let placed = triangles.list().iter().map(move |triangle| {
        triangle.each(|edge| {
            let (axis, lower) = (edge as usize / 4, plane::corner(ENDS[edge as usize][0].into()));
            let mut point = axes(|axis| corner[axis] + size * lower[axis]);
            // A cut edge crosses the plane.
            point[axis] = plane.above(axis, point).unwrap_or(point[axis]);
            point
        })
    });
    placed.filter(|[p, q, r]| p != q && q != r && r != p)
}
