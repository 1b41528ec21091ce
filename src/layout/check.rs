//! Whether something that is placed may stand where it does.

use super::proof::{Known, Piece, boxes_apart};
use super::relative::Relative;
use super::{Layout, NOT_PLACED};
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::{Affine, Bounds, Interval};
use crate::memory;
use crate::query::GapVerdict;
use alloc::vec::Vec;

/// What something that is placed may be too near to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Beside {
    /// What lies outside of the container.
    Wall,
    /// An obstacle, by its number.
    Obstacle(usize),
    /// Something else that is placed, by its number.
    Placed(usize),
}

/// What is known of something placed and something else.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbour {
    /// The other one.
    pub other: Beside,
    /// Whether the two are proven to be as far apart as they should be, or not to be.
    pub verdict: GapVerdict,
    /// What is known of the distance (model units): 0 if they touch or overlap.
    pub gap: Interval,
}

/// How something stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Standing {
    /// `Yes`: it is proven to lie in the container, to overlap with nothing, and to be as far from everything
    /// as it should be. `No`: one of these is proven to be wrong.
    pub verdict: GapVerdict,
    /// What is in the way, or may be: those of which `Yes` is not proven. These are the first 256 of them:
    /// the wall, obstacles, and what is placed, each in the order of their numbers.
    pub conflicts: Vec<Neighbour>,
    /// How many there are of which `Yes` is not proven, all counted.
    pub conflict_count: usize,
    /// What is next to it, but for the wall; nothing if there is nothing else. The gap holds the least of all
    /// distances.
    pub nearest: Option<Neighbour>,
    /// Cells that were split.
    pub splits: u64,
}

/// Most conflicts that are told of one.
const CONFLICTS: usize = 256;

/// How well the distance of what is nearest is to be known, as a part of the longest side of the container.
const NEAREST: f64 = 1e-6;

impl Layout {
    /// Says how something that is placed stands. Only what is near is looked at: what boxes tell apart costs
    /// nothing.
    ///
    /// A pair of closed meshes takes some ten microseconds. Others take splits, of which `control.max_splits`
    /// limits the number a pair (4 096 if there is none); if it is spent, the answer is `Undecided`. One
    /// thread.
    ///
    /// # Errors
    /// [`Error::Argument`] if there is nothing of this number; what the solids refuse;
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`].
    pub fn check(&self, number: usize, control: &Control<'_>) -> Result<Standing, Error> {
        let Some(own) = self.placed.get(number) else { return Err(NOT_PLACED) };
        let mut standing = self.stands(own.item, &own.placement, Some(number), control)?;
        standing.nearest = self.nearest(number, &mut standing.splits, control)?;
        Ok(standing)
    }

    /// Says of everything that is placed how it stands, in its order, without what is nearest.
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

    /// Whether an item may stand in a place, beside everything that is placed but `except`.
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

    /// Whether boxes that are no nearer than that tell their solids apart.
    fn is_far(&self, apart: f64) -> bool {
        apart >= self.clearance
    }

    /// What is next to something placed.
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
            // (Of two that are about as far away, either is the nearest.)
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
        // (Of two whose distances are not known well enough, either may be the nearest.)
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
