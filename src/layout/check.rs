//! The check whether a placed copy fits.

use super::proof::{Known, Piece, boxes_apart};
use super::relative::Relative;
use super::{Layout, NOT_PLACED};
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Affine, Bounds, Interval};
use crate::memory;
use crate::query::GapVerdict;
use alloc::vec::Vec;

/// The other side of a conflict or a gap of a placed copy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Beside {
    /// The outside of the container.
    Wall,
    /// An obstacle, by its number.
    Obstacle(usize),
    /// Another placed copy, by its number.
    Placed(usize),
}

/// The verdict on the gap between a placed copy and one neighbour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbour {
    /// The neighbour.
    pub other: Beside,
    /// Whether the two are proven to keep the required distance, or proven not to keep it.
    pub verdict: GapVerdict,
    /// The bounds of the distance (model units): 0 if they touch or overlap.
    pub gap: Interval,
}

/// The result of a check: whether a placed copy fits, and its conflicts.
#[derive(Debug, Clone, PartialEq)]
pub struct Standing {
    /// `Yes`: the copy is proven to lie in the container, to overlap with nothing, and to keep the required
    /// distance from everything. `No`: one of these conditions is proven to be violated.
    pub verdict: GapVerdict,
    /// The proven and possible conflicts: the wall, obstacles and placed copies for which `Yes` is not
    /// proven, each kind in the order of its numbers. Only the first 256 are listed.
    pub conflicts: Vec<Neighbour>,
    /// The number of all neighbours for which `Yes` is not proven.
    pub conflict_count: usize,
    /// The nearest neighbour other than the wall; `None` if there is no other neighbour. The gap contains the
    /// least of all distances.
    pub nearest: Option<Neighbour>,
    /// Number of cell splits.
    pub splits: u64,
}

/// The maximal number of conflicts reported for a copy.
const CONFLICTS: usize = 256;

/// The precision of the distance to the nearest neighbour, as a part of the container's longest side.
const NEAREST: f64 = 1e-6;

impl Layout {
    /// Returns whether a placed copy fits, with its conflicts and its nearest neighbour. The check processes
    /// only near neighbours: neighbours that boxes separate cost nothing.
    ///
    /// A pair of closed meshes takes about ten microseconds. Other solids take splits. `control.max_splits`
    /// limits the splits for each pair (4 096 if it is `None`); if they are spent, the answer is `Undecided`.
    /// It uses one thread.
    ///
    /// # Errors
    /// [`Error::Argument`] if there is no copy with this number; the solids' own errors;
    /// [`Error::OutOfMemory`] and [`Error::Cancelled`].
    pub fn check(&self, number: usize, control: &Control<'_>) -> Result<Standing, Error> {
        let Some(own) = self.placed.get(number) else { return Err(NOT_PLACED) };
        let mut standing = self.stands(own.item, &own.placement, Some(number), control)?;
        standing.nearest = self.nearest(number, &mut standing.splits, control)?;
        Ok(standing)
    }

    /// Checks all placed copies, in their order, without their nearest neighbours.
    ///
    /// # Errors
    /// As [`check`](Self::check).
    pub fn check_all(&self, control: &Control<'_>) -> Result<Vec<Standing>, Error> {
        let job = Job::new(control);
        let own = &Control { progress: None, ..*control };
        control.run(self.placed.len() > 1, |parallel| {
            job.each(parallel, 0..self.placed.len(), |number| {
                let Some(placed) = self.placed.get(number) else { return Err(NOT_PLACED) };
                self.stands(placed.item, &placed.placement, Some(number), own)
            })
        })
    }

    /// Checks whether an item fits in a place, beside all placed copies but `except`.
    pub(super) fn stands(
        &self,
        item: usize,
        placement: &Affine,
        except: Option<usize>,
        control: &Control<'_>,
    ) -> Result<Standing, Error> {
        let around = self.around(item, placement)?;
        let piece = &self.pieces[item];
        let mut standing = Standing {
            verdict: GapVerdict::Yes,
            conflicts: Vec::new(),
            conflict_count: 0,
            nearest: None,
            splits: 0,
        };
        let known = self.container.takes(piece, placement, &around, control)?;
        standing.note(Beside::Wall, &known)?;
        for (number, obstacle) in self.obstacles.iter().enumerate() {
            if self.is_far(boxes_apart(obstacle.bounds(), &around)) {
                continue;
            }
            let places = [&Affine::IDENTITY, placement];
            let known =
                obstacle.is_apart(piece, &Relative::of(placement), places, self.clearance, control)?;
            standing.note(Beside::Obstacle(number), &known)?;
        }
        for (number, (other, block)) in self.placed.iter().zip(&self.boxes).enumerate() {
            if except == Some(number) || self.is_far(boxes_apart(block, &around)) {
                continue;
            }
            let fixed = &self.pieces[other.item];
            let seen = Relative::new(&other.placement, placement, piece.bounds())?;
            let places = [&other.placement, placement];
            let known = fixed.is_apart(piece, &seen, places, self.clearance, control)?;
            standing.note(Beside::Placed(number), &known)?;
        }
        Ok(standing)
    }

    /// True if boxes at this distance separate their solids.
    fn is_far(&self, apart: f64) -> bool {
        apart >= self.clearance
    }

    /// Returns the nearest neighbour of a placed copy.
    fn nearest(
        &self,
        number: usize,
        splits: &mut u64,
        control: &Control<'_>,
    ) -> Result<Option<Neighbour>, Error> {
        control.check()?;
        let (own, around) = (&self.placed[number], &self.boxes[number]);
        let piece = &self.pieces[own.item];
        let mut others = memory::with_capacity(self.obstacles.len() + self.placed.len())?;
        let mut add = |block: &Bounds, other| others.push((boxes_apart(block, around).max(0.0), other));
        for (k, obstacle) in self.obstacles.iter().enumerate() {
            add(obstacle.bounds(), Beside::Obstacle(k));
        }
        for (k, block) in self.boxes.iter().enumerate().filter(|(k, _)| *k != number) {
            add(block, Beside::Placed(k));
        }
        others.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let bounds = self.container.bounds();
        let tolerance = NEAREST * (0..3).map(|k| bounds.max[k] - bounds.min[k]).fold(0.0, f64::max);
        let mut nearest: Option<Neighbour> = None;
        let mut least = f64::INFINITY;
        for (apart, other) in others {
            if nearest.is_some_and(|near| near.gap.upper <= apart) {
                break;
            }
            // (If two are about as far away, either is the nearest.)
            let below = nearest.map_or(f64::INFINITY, |near| near.gap.upper - tolerance);
            let ask =
                |fixed: &Piece, seen: &Relative| fixed.distance(piece, seen, (tolerance, below), control);
            let (gap, spent) = match other {
                Beside::Obstacle(k) => ask(&self.obstacles[k], &Relative::of(&own.placement))?,
                Beside::Placed(k) => {
                    let other = &self.placed[k];
                    ask(
                        &self.pieces[other.item],
                        &Relative::new(&other.placement, &own.placement, piece.bounds())?,
                    )?
                }
                Beside::Wall => continue,
            };
            *splits += spent;
            let gap = Interval::between(gap.lower.max(apart).min(gap.upper), gap.upper);
            least = least.min(gap.lower);
            if nearest.is_none_or(|near| gap.upper < near.gap.upper) {
                let verdict = match self.clearance {
                    least if gap.lower >= least && least > 0.0 => GapVerdict::Yes,
                    least if gap.upper < least => GapVerdict::No,
                    _ => GapVerdict::Undecided,
                };
                nearest = Some(Neighbour { other, verdict, gap });
            }
        }
        // (If two distances are not known well enough, either neighbour may be the nearest.)
        Ok(nearest.map(|near| Neighbour { gap: Interval::between(least, near.gap.upper), ..near }))
    }
}

impl Standing {
    fn note(&mut self, other: Beside, known: &Known) -> Result<(), Error> {
        self.splits += known.splits;
        let Known { verdict, gap, .. } = *known;
        self.verdict = match (self.verdict, verdict) {
            (GapVerdict::No, _) | (_, GapVerdict::No) => GapVerdict::No,
            (GapVerdict::Undecided, _) | (_, GapVerdict::Undecided) => GapVerdict::Undecided,
            _ => GapVerdict::Yes,
        };
        if verdict != GapVerdict::Yes {
            self.conflict_count += 1;
            if self.conflicts.len() < CONFLICTS {
                memory::push(&mut self.conflicts, Neighbour { other, verdict, gap })?;
            }
        }
        Ok(())
    }
}
