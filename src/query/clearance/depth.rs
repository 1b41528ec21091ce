//! A ball in the overlap of two solids.
//!
//! The ball begins around a cell that lies in both solids. Its centre then moves towards larger distances
//! from the nearest outside points of either solid. Lengths are in finest cells.

use super::nodes::Nodes;
use super::piece::{self, Bodies, Content, Piece};
use super::search::Search;
use crate::control::Job;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::product_down;
use crate::lattice::{Interval, axes};
use crate::octree::Tag;
use crate::solid::Classifier;
use crate::walk::Queue;
use core::cmp::Reverse;

/// The maximal number of visited cells in the search for a common cell, and for each centre.
const CELLS: u64 = 1 << 12;

/// The maximal number of centres.
const CENTRES: u32 = 256;

/// Returns the centre of a ball that is proven to lie in both solids, and its radius in model units; `None`
/// if no common cell is found.
pub(super) fn common_ball<A: Classifier, B: Classifier>(
    search: &mut Search<'_, A, B>,
    job: &Job<'_>,
) -> Result<Option<([f64; 3], f64)>, Error> {
    let Some(start) = common_cell(search, job)? else { return Ok(None) };
    let (mut centre, half) = start;
    let mut radius = around(search, centre, job)?.max(half);
    let mut step = radius;
    let mut left = CENTRES;
    while step > radius / 32.0 && left > 0 && !search.is_spent() {
        let mut best = None;
        // Try the 26 directions to the neighbours of a cube, until one is better.
        for way in (0..27).filter(|way| *way != 13) {
            let offset = [way % 3, way / 3 % 3, way / 9].each(|k: u32| step * (f64::from(k) - 1.0));
            let moved = axes(|axis| centre[axis] + offset[axis]);
            left = left.saturating_sub(1);
            let found = around(search, moved, job)?;
            if found > radius * 1.001 {
                best = Some((moved, found));
                break;
            }
        }
        match best {
            Some(found) => (centre, radius) = found,
            None => step *= 0.5,
        }
    }
    let size = search.a.subject.classifier.frame().cell_size();
    Ok(Some((centre, product_down(radius, size))))
}

/// Returns the centre of a cell that lies in both solids, and half its edge. Large cells are preferred.
fn common_cell<A: Classifier, B: Classifier>(
    search: &mut Search<'_, A, B>,
    job: &Job<'_>,
) -> Result<Option<([f64; 3], f64)>, Error> {
    if search.a.is_empty() || search.b.is_empty() {
        return Ok(None);
    }
    // Larger cells come first; among equals, the cells met earlier.
    let mut open: Queue<(Reverse<u8>, Reverse<u64>), (usize, usize)> = Queue::new();
    open.push((Reverse(0), Reverse(0)), (0, 0))?;
    let mut left = CELLS;
    while let Some((a, b)) = open.pop() {
        job.check()?;
        let (own, other) = (search.a.cell(a), search.b.cell(b));
        if search.a.is_full(a) && search.b.is_full(b) {
            let Piece { centre, half, .. } =
                if own.level >= other.level { search.a.piece(a) } else { search.b.piece(b) };
            return Ok(Some((centre, half)));
        }
        if left == 0 || search.is_spent() {
            break;
        }
        left -= 1;
        search.left = search.left.saturating_sub(1);
        let (splits_a, splits_b) = (search.a.can_be_split(a), search.b.can_be_split(b));
        if splits_a && (own.level <= other.level || !splits_b) {
            for child in search.a.children(a)? {
                let cell = search.a.cell(child);
                if cell.level <= other.level && other.ancestor(cell.level) != cell {
                    continue;
                }
                if cell.level > other.level && cell.ancestor(other.level) != other {
                    continue;
                }
                open.push((Reverse(cell.level.max(other.level)), Reverse(open.met() + 1)), (child, b))?;
            }
        } else if splits_b {
            for child in search.b.children(b)? {
                let cell = search.b.cell(child);
                if cell.level <= own.level && own.ancestor(cell.level) != cell {
                    continue;
                }
                if cell.level > own.level && cell.ancestor(own.level) != own {
                    continue;
                }
                open.push((Reverse(cell.level.max(own.level)), Reverse(open.met() + 1)), (a, child))?;
            }
        }
    }
    Ok(None)
}

/// Returns the radius of a ball around a point that is proven to lie in both solids.
fn around<A: Classifier, B: Classifier>(
    search: &mut Search<'_, A, B>,
    centre: [f64; 3],
    job: &Job<'_>,
) -> Result<f64, Error> {
    let before = CELLS.min(search.left);
    let mut left = before;
    let own = free(&mut search.a, centre, f64::INFINITY, &mut left, job)?;
    let other = if own > 0.0 { free(&mut search.b, centre, own, &mut left, job)? } else { 0.0 };
    search.left -= before - left;
    Ok(own.min(other))
}

/// Returns the radius, at most `most`, of a ball around a point that is proven to lie in a solid. At most
/// `left` cells are visited.
fn free<C: Classifier>(
    nodes: &mut Nodes<'_, C>,
    centre: [f64; 3],
    most: f64,
    left: &mut u64,
    job: &Job<'_>,
) -> Result<f64, Error> {
    let cells = f64::from(nodes.subject.classifier.frame().cells());
    let mut radius = most;
    if nodes.subject.classifier.exterior() != Tag::Full {
        for c in centre {
            let [below, above] = [c, cells - c].each(|c| c.next_down());
            radius = radius.min(below).min(above);
        }
    } else if !centre.iter().all(|&c| (0.0..=cells).contains(&c)) {
        return Ok(0.0);
    }
    if nodes.is_empty() || radius.is_nan() || radius <= 0.0 {
        return Ok(0.0);
    }
    if nodes.is_full(0) {
        return Ok(radius);
    }
    let point = Piece { centre, half: 0.0, content: Content::Unknown, rings: [None; 2] };
    let of_point = Bodies::outer(&point);
    let away = |centre: [f64; 3], half: f64| -> f64 {
        let gaps = axes(|axis| {
            let gap = Interval::exactly(centre[axis]).minus(Interval::exactly(point.centre[axis]));
            let gap = Interval::exactly((-gap.upper).max(gap.lower)).minus(Interval::exactly(half));
            gap.not_negative().square()
        });
        gaps[0].plus(gaps[1]).plus(gaps[2]).root().lower
    };
    // The nearest cells first.
    let mut open: Queue<(Reverse<u64>, u64), usize> = Queue::new();
    open.push((Reverse(0), 0), 0)?;
    loop {
        let Some(first) = open.peek() else { return Ok(radius) };
        let least = f64::from_bits(first.key.0.0);
        if least >= radius {
            return Ok(radius);
        }
        let Some(node) = open.pop() else { return Ok(radius) };
        job.check()?;
        if !nodes.can_be_split(node) || *left == 0 || nodes.subject.takes(4) {
            return Ok(least);
        }
        *left -= 1;
        let Piece { centre, half, .. } = nodes.piece(node);
        for (octant, child) in nodes.octants(node)?.into_iter().enumerate() {
            let half = 0.5 * half;
            let middle = axes(|axis| centre[axis] + if octant >> axis & 1 == 0 { -half } else { half });
            let mut least = away(middle, half);
            let Some(child) = child else {
                radius = radius.min(least);
                continue;
            };
            if nodes.is_full(child) || least >= radius {
                continue;
            }
            nodes.learn(child)?;
            if let Some(hollow) = nodes.hollow(child) {
                let rest = Piece { centre: middle, half, content: Content::Slabs(&hollow), rings: [None; 2] };
                least = least.max(piece::lower((&point, &of_point), (&rest, &Bodies::outer(&rest)), least));
            }
            if least < radius {
                open.push((Reverse(least.to_bits()), open.met()), child)?;
            }
        }
    }
}
