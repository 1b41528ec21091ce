//! The search for the point of one surface that is farthest from another one.
//!
//! The distance from a convex set is a convex function. Over a convex piece it is therefore greatest at a
//! corner. Hence no point of a piece is further from a surface than the farthest of the piece's corners is
//! from a single facet of that surface. The best such facet gives the upper bound. The distances of corners
//! that lie on the first surface are lower bounds. Pieces whose upper bound is too great are cut: along the
//! edges of a facet, projected along its normal, if the facet is near; where two facets are about equally far
//! away; and from time to time in the middle, so that pieces become small in any case.
//!
//! Pieces with the greatest upper bounds come first, in batches. Each piece of a batch is processed by itself
//! for a while. The result does not depend on the number of threads.

use super::piece::{Corner, GENERATIONS, MOST, Piece};
use super::surface::{Facet, Near, Seen};
use super::{OneWay, Witness};
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::Interval;
use crate::lattice::exact::sqrt;
use crate::memory;
use crate::parallel::each;
use crate::query::StopReason;
use crate::walk::Queue;
use alloc::vec::Vec;
use core::cmp::Reverse;

/// The number of vertices or triangles in one task.
const CHUNK: usize = 1 << 10;

/// The number of pieces in a batch, and the number of cuts of each of them and its parts before the rest is
/// put back.
const BATCH: usize = 128;
const CUTS: u64 = 64;

/// The number of facets tried for the upper bound of a piece.
const TRIED: usize = 5;

/// The point with the greatest distance proven so far.
#[derive(Clone, Copy)]
struct Best {
    lower: f64,
    /// The point, the maximal distance of the surface from it, and its nearest facet.
    at: Option<([f64; 3], f64, Facet)>,
}

/// A piece that is still to be processed.
enum Item {
    /// A whole triangle of a layer.
    Triangle(usize, u32),
    /// An index into the list of pieces.
    Piece(usize),
}

/// The greatest upper bound first (the bits of a non-negative double), then the piece met earlier.
type Rank = (u64, Reverse<u64>);

/// The result of cutting a piece.
struct Refined {
    best: Best,
    settled: f64,
    rest: Vec<Piece>,
    cuts: u64,
}

/// A triangle that is not proven to be within a limit.
#[cfg(feature = "std")]
pub(super) struct Beyond {
    pub(super) triangle: u32,
    /// The triangle of the other surface that is nearest to this triangle's farthest point, if known.
    pub(super) nearest: Option<u32>,
    /// Whether a point of the triangle is proven to be further away.
    pub(super) is_proven: bool,
}

/// A predicate that selects triangles by layer and index.
pub(super) type Wanted<'w> = dyn Fn(usize, u32) -> bool + Sync + 'w;

/// Two surfaces.
pub(super) struct Search<'s> {
    pub(super) from: &'s Seen<'s>,
    pub(super) to: &'s Seen<'s>,
    pub(super) tolerance: f64,
    pub(super) budget: u64,
}

impl Search<'_> {
    /// Returns the greatest distance of a point of the first surface from the second, and the number of cuts.
    pub(super) fn run(&self, parallel: bool, job: &Job<'_>) -> Result<(OneWay, u64, StopReason), Error> {
        let mut best = Best { lower: 0.0, at: None };
        if self.from.is_empty() {
            return Ok((OneWay { distance: Interval::exactly(0.0), at: None }, 0, StopReason::Tolerance));
        }
        let nears = self.vertices(parallel, &mut best, &|_, _| true, job)?;
        let mut open = Open { queue: Queue::new(), pieces: Vec::new(), free: Vec::new() };
        let mut settled = self.triangles(parallel, &nears, &mut best, &mut open, job)?;
        let mut cuts = 0;
        let mut is_spent = false;
        while open.greatest() > best.lower + self.tolerance && open.greatest() < f64::INFINITY {
            job.check()?;
            is_spent = cuts >= self.budget || open.takes_too_much(job.control());
            if is_spent {
                break;
            }
            let mut batch = memory::with_capacity(BATCH)?;
            while batch.len() < BATCH && open.greatest() > best.lower + self.tolerance {
                match open.queue.pop() {
                    Some(Item::Piece(place)) => batch.push(open.take(place)?),
                    Some(Item::Triangle(layer, triangle)) => {
                        let mut piece = self.triangle(&nears, layer, triangle);
                        self.bound(&mut piece, best.lower, &mut Best { ..best });
                        batch.push(piece);
                    }
                    None => break,
                }
            }
            let most = ((self.budget - cuts) / batch.len().max(1) as u64).clamp(1, CUTS);
            let done = each(parallel, batch.into_iter(), |piece| self.refine(piece, best, most, job))?;
            for refined in done {
                cuts += refined.cuts;
                settled = settled.max(refined.settled);
                if refined.best.lower > best.lower {
                    best = refined.best;
                }
                for piece in refined.rest {
                    open.push(piece)?;
                }
            }
        }
        let greatest = open.greatest().max(settled);
        let distance = Interval::between(best.lower, greatest.max(best.lower));
        let stop_reason =
            match (distance.width() <= self.tolerance || distance.lower == f64::INFINITY, is_spent) {
                (true, _) => StopReason::Tolerance,
                (false, true) => StopReason::Budget,
                (false, false) => StopReason::Exhausted,
            };
        Ok((OneWay { distance, at: self.witness(&best) }, cuts, stop_reason))
    }

    /// Returns an upper bound of the distance of the wanted triangles of the first surface from the second
    /// one, only as exactly as `limit` and the tolerance require, and the triangles that are not proven to be
    /// within `limit` plus the tolerance after `cuts` cuts each.
    #[cfg(feature = "std")]
    pub(super) fn beyond(
        &self,
        limit: f64,
        wanted: &Wanted<'_>,
        cuts: u64,
        parallel: bool,
        job: &Job<'_>,
    ) -> Result<(f64, Vec<Beyond>), Error> {
        let none = Best { lower: limit, at: None };
        let allowed = limit + self.tolerance;
        let nears = self.vertices(parallel, &mut Best { lower: f64::INFINITY, ..none }, wanted, job)?;
        let (mut most, mut beyond) = (0.0, Vec::new());
        for (number, layer) in self.from.covers.iter().enumerate() {
            let count = layer.mesh.triangles().len();
            let found = each(parallel, 0..count.div_ceil(CHUNK), |task| {
                let (mut most, mut beyond): (f64, _) = (0.0, Vec::new());
                for triangle in task * CHUNK..count.min((task + 1) * CHUNK) {
                    let triangle = triangle as u32;
                    if !layer.is_chosen(triangle) || !wanted(number, triangle) {
                        continue;
                    }
                    let (mut piece, mut best) = (self.triangle(&nears, number, triangle), none);
                    self.bound(&mut piece, limit, &mut best);
                    let mut upper = piece.upper;
                    if upper > limit {
                        for corner in piece.corners() {
                            self.consider(&mut best, corner.at, corner.near, piece.radius);
                        }
                        let refined = self.refine(piece, best, cuts, job)?;
                        let rest = refined.rest.iter().map(|piece| piece.upper);
                        let is_proven = refined.best.lower > limit;
                        upper = rest.fold(refined.settled, f64::max);
                        if is_proven {
                            upper = upper.max(refined.best.lower);
                        }
                        if upper > allowed {
                            let facet = refined.best.at.map_or(piece.hint, |(_, _, facet)| facet);
                            let nearest = facet.triangle();
                            memory::push(&mut beyond, Beyond { triangle, nearest, is_proven })?;
                        }
                    }
                    most = most.max(upper);
                }
                Ok((most, beyond))
            })?;
            for (own, list) in found {
                most = f64::max(most, own);
                beyond.try_reserve(list.len())?;
                beyond.extend(list);
            }
        }
        Ok((most, beyond))
    }

    fn witness(&self, best: &Best) -> Option<Witness> {
        let (point, apart, facet) = best.at?;
        Some(Witness { point, apart, nearest: self.to.nearest_on(facet, point)? })
    }

    /// Returns the bounds of the distance for all vertices of the wanted triangles of the first surface.
    fn vertices(
        &self,
        parallel: bool,
        best: &mut Best,
        wanted: &Wanted<'_>,
        job: &Job<'_>,
    ) -> Result<Vec<Vec<Near>>, Error> {
        let mut nears = memory::with_capacity(self.from.covers.len())?;
        for (number, layer) in self.from.covers.iter().enumerate() {
            let (vertices, triangles) = (layer.mesh.vertices(), layer.mesh.triangles());
            let mut is_used = memory::filled(vertices.len(), false)?;
            for (triangle, corners) in (0..).zip(triangles) {
                if layer.is_chosen(triangle) && wanted(number, triangle) {
                    corners.iter().for_each(|&vertex| is_used[vertex as usize] = true);
                }
            }
            let tasks = vertices.chunks(CHUNK).zip(is_used.chunks(CHUNK));
            let found = each(parallel, tasks, |(vertices, is_used)| {
                job.check()?;
                let mut hint = Facet::NONE;
                memory::collected(vertices.iter().zip(is_used).map(|(&vertex, &is_used)| {
                    let near = if is_used { self.to.near(vertex, hint) } else { Near::OPEN };
                    hint = if is_used { near.facet } else { hint };
                    near
                }))
            })?;
            let mut all = memory::with_capacity(vertices.len())?;
            all.extend(found.into_iter().flatten());
            for ((&vertex, &is_used), &near) in vertices.iter().zip(&is_used).zip(&all) {
                if is_used {
                    self.consider(best, vertex, near, layer.radius);
                }
            }
            nears.push(all);
        }
        Ok(nears)
    }

    fn triangle(&self, nears: &[Vec<Near>], layer: usize, triangle: u32) -> Piece {
        let from = &self.from.covers[layer];
        let corners = from.mesh.triangles()[triangle as usize].each(|vertex| Corner {
            at: from.mesh.vertices()[vertex as usize],
            near: nears[layer][vertex as usize],
        });
        Piece::triangle(corners, from.radius)
    }

    /// Processes all triangles and queues the relevant ones. Returns the greatest upper bound of the others.
    fn triangles(
        &self,
        parallel: bool,
        nears: &[Vec<Near>],
        best: &mut Best,
        open: &mut Open,
        job: &Job<'_>,
    ) -> Result<f64, Error> {
        let mut settled: f64 = 0.0;
        for (number, layer) in self.from.covers.iter().enumerate() {
            let count = layer.mesh.triangles().len();
            let known = *best;
            let tasks = 0..count.div_ceil(CHUNK);
            let found = each(parallel, tasks, |task| {
                job.check()?;
                let (mut own, first) = (known, task * CHUNK);
                let mut uppers = memory::with_capacity(CHUNK)?;
                for triangle in first..count.min(first + CHUNK) {
                    let triangle = triangle as u32;
                    if !layer.is_chosen(triangle) {
                        uppers.push(0.0);
                        continue;
                    }
                    let mut piece = self.triangle(nears, number, triangle);
                    self.bound(&mut piece, known.lower + self.tolerance, &mut own);
                    uppers.push(piece.upper);
                }
                Ok((uppers, own))
            })?;
            for (uppers, own) in &found {
                debug_assert!(uppers.len() <= CHUNK);
                if own.lower > best.lower {
                    *best = *own;
                }
            }
            for (triangle, upper) in (0..).zip(found.into_iter().flat_map(|(uppers, _)| uppers)) {
                if upper > best.lower + self.tolerance {
                    let rank = (upper.to_bits(), Reverse(open.queue.met()));
                    open.queue.push(rank, Item::Triangle(number, triangle))?;
                } else {
                    settled = settled.max(upper);
                }
            }
        }
        Ok(settled)
    }

    /// Considers a point of the pieces as the best one. The surface is within `radius` of the point if the
    /// surface is known exactly.
    fn consider(&self, best: &mut Best, at: [f64; 3], near: Near, radius: f64) {
        if near.lower <= best.lower {
            return;
        }
        let apart = if self.from.is_exact() { radius } else { self.from.near_core(at, Facet::NONE).upper };
        let is_exact = apart == 0.0 || near.lower == f64::INFINITY;
        let lower = if is_exact { near.lower } else { (near.lower - apart).next_down() };
        // (NaN is not greater.)
        if apart < f64::INFINITY && lower > best.lower {
            *best = Best { lower, at: Some((at, apart, near.facet)) };
        }
    }

    /// The maximal difference between the distances of a piece and those of the surface.
    fn slack(&self, piece: &Piece) -> f64 {
        piece.radius + if piece.generation > 0 { self.from.rounding } else { 0.0 }
    }

    /// Returns the upper bound of a piece by a facet, if it is less than `less_than`.
    fn upper_by(&self, piece: &Piece, facet: Facet, less_than: f64) -> Option<f64> {
        let slack = self.slack(piece);
        let mut most: f64 = 0.0;
        for corner in piece.corners() {
            let is_own = corner.near.facet == facet;
            let upper = if is_own { corner.near.upper } else { self.to.most_from(facet, corner.at) };
            most = most.max(upper);
            if most + slack >= less_than {
                return None;
            }
        }
        Some(if slack > 0.0 { (most + slack).next_up() } else { most })
    }

    /// Finds the upper bound of a piece. A bound of at most `enough` is sufficient.
    fn bound(&self, piece: &mut Piece, enough: f64, best: &mut Best) {
        let mut tried = [Facet::NONE; TRIED];
        let mut count = 0;
        for facet in [piece.hint].into_iter().chain(piece.corners().iter().map(|corner| corner.near.facet)) {
            if facet != Facet::NONE && count < TRIED && !tried[..count].contains(&facet) {
                tried[count] = facet;
                count += 1;
            }
        }
        let mut found = (piece.upper, piece.hint);
        for &facet in &tried[..count] {
            if found.0 > enough
                && let Some(upper) = self.upper_by(piece, facet, found.0)
            {
                found = (upper, facet);
            }
        }
        if found.0 > enough {
            let middle = piece.centroid();
            let near = self.to.near(middle, found.1);
            self.consider(best, middle, near, piece.radius + self.from.rounding);
            if !tried.contains(&near.facet)
                && let Some(upper) = self.upper_by(piece, near.facet, found.0)
            {
                found = (upper, near.facet);
            }
        }
        (piece.upper, piece.hint) = found;
    }

    /// Cuts a piece and its parts up to `most` times, the parts with the greatest upper bounds first.
    fn refine(&self, piece: Piece, best: Best, most: u64, job: &Job<'_>) -> Result<Refined, Error> {
        job.check()?;
        let mut refined = Refined { best, settled: 0.0, rest: Vec::new(), cuts: 0 };
        let mut open: Queue<Rank, Piece> = Queue::new();
        open.push((piece.upper.to_bits(), Reverse(0)), piece)?;
        while refined.cuts < most
            && let Some(mut piece) = open.pop()
        {
            self.complete(&mut piece, &mut refined.best);
            let enough = refined.best.lower + self.tolerance;
            // (No other piece has a greater bound.)
            if piece.upper <= enough || self.is_settled(&piece) {
                refined.settled = refined.settled.max(piece.upper);
                continue;
            }
            refined.cuts += 1;
            let mut parts = [None; 4];
            let Refined { best, settled, .. } = &mut refined;
            if !self.cut(&piece, &mut parts) {
                *settled = settled.max(piece.upper);
                continue;
            }
            for mut part in parts.into_iter().flatten() {
                self.bound(&mut part, best.lower + self.tolerance, best);
                if part.upper <= best.lower + self.tolerance {
                    *settled = settled.max(part.upper);
                } else {
                    open.push((part.upper.to_bits(), Reverse(open.met())), part)?;
                }
            }
        }
        while let Some(piece) = open.pop() {
            memory::push(&mut refined.rest, piece)?;
        }
        Ok(refined)
    }

    /// Computes the distances of all corners of a piece.
    fn complete(&self, piece: &mut Piece, best: &mut Best) {
        let (radius, hint) = (piece.radius + self.from.rounding, piece.hint);
        for corner in piece.corners_mut().iter_mut().filter(|corner| corner.near.facet == Facet::NONE) {
            corner.near = self.to.near(corner.at, hint);
            self.consider(best, corner.at, corner.near, radius);
        }
    }

    /// True if cutting a piece cannot improve the result.
    fn is_settled(&self, piece: &Piece) -> bool {
        let slack = self.slack(piece);
        let fine = 4.0 * self.from.rounding;
        if piece.generation >= GENERATIONS || sqrt(piece.diameter().2) <= fine {
            return true;
        }
        // A part with a corner has an upper bound no less than the corner's.
        let corners = piece.corners().iter().map(|corner| corner.near.upper);
        let least = corners.fold(0.0, f64::max) + slack;
        piece.upper - least <= (0.25 * self.tolerance).max(0.125 * slack).max(fine)
    }

    /// Cuts a piece. Returns `false` if the piece cannot be cut.
    fn cut(&self, piece: &Piece, parts: &mut [Option<Piece>; 4]) -> bool {
        let corners = piece.corners();
        let mut two = |cut: Option<[Piece; 2]>| {
            let is_cut = cut.is_some();
            if let Some([one, other]) = cut {
                (parts[0], parts[1]) = (Some(one), Some(other));
            }
            is_cut
        };
        // (First of all: any number of cuts along facets may leave long pieces long.)
        if piece.generation % 3 == 2 && two(piece.halves()) {
            return true;
        }
        if corners.len() > MOST - 3 {
            return two(Some(piece.fans()));
        }
        let least = corners.iter().map(|corner| corner.near.upper).fold(f64::INFINITY, f64::min);
        if least * least < piece.diameter().2
            && let Some(triangle) = self.to.corners(piece.hint)
            && let Some((beyond, within)) = piece.seen_through(triangle, piece.hint)
        {
            let [a, b, c] = beyond;
            *parts = [Some(within), a, b, c];
            return true;
        }
        let from_hint = |corner: &Corner| self.to.most_from(piece.hint, corner.at);
        let farthest = corners.iter().map(|corner| (from_hint(corner), corner.near.facet));
        let (_, other) =
            farthest.fold((-1.0, Facet::NONE), |most, next| if next.0 > most.0 { next } else { most });
        if other != piece.hint && other != Facet::NONE && piece.hint != Facet::NONE {
            let between = |corner: &Corner| from_hint(corner) - self.to.most_from(other, corner.at);
            if two(piece.cut(between)) {
                return true;
            }
        }
        two(piece.halves())
    }
}

/// The pieces that are still relevant.
struct Open {
    queue: Queue<Rank, Item>,
    pieces: Vec<Piece>,
    /// Indices of the list that are not in use.
    free: Vec<usize>,
}

impl Open {
    /// The greatest upper bound; 0 if there is no piece.
    fn greatest(&self) -> f64 {
        self.queue.peek().map_or(0.0, |entry| f64::from_bits(entry.key.0))
    }

    fn push(&mut self, piece: Piece) -> Result<(), Error> {
        let place = match self.free.pop() {
            Some(place) => {
                self.pieces[place] = piece;
                place
            }
            None => {
                memory::push(&mut self.pieces, piece)?;
                self.pieces.len() - 1
            }
        };
        self.queue.push((piece.upper.to_bits(), Reverse(self.queue.met())), Item::Piece(place))
    }

    /// Takes a piece out of the list.
    fn take(&mut self, place: usize) -> Result<Piece, Error> {
        memory::push(&mut self.free, place)?;
        Ok(self.pieces[place])
    }

    /// True if the pieces in memory take much of the bytes that the caller allows.
    fn takes_too_much(&self, control: &Control<'_>) -> bool {
        control.max_bytes.is_some_and(|limit| memory::bytes_of(&self.pieces) as u64 > limit / 4)
    }
}
