//! Surfaces of any solids, by rays.

use super::normals::Normals;
use super::octree::{Cast, normal_of_cells};
use super::sight::{Finish, Sight};
use super::stage::{Draw, Painter, Stage};
use super::tile::Tile;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::{Cell, Cube, Frame};
use crate::memory;
use crate::octree::{Octree, Tag};
use crate::op::{Rule, Trail, build};
use crate::query::RayHit;
use crate::solid::{Classifier, Enclosure, Segment, SlabJoin, Solid, WorkerOf};
use alloc::boxed::Box;
use glam::DVec3;
use hashbrown::HashMap;

/// The surface of any solid within a universe.
///
/// The solid is split to cells as large as a pixel, 2^11 to an axis at the most. In an undecided cell a line of sight meets what
/// the solid knows of it: a crossing, or the middle of its slabs, with their normals. Of cells of which nothing is known the
/// surface and its normals are those of an [`OctreeLayer`](crate::OctreeLayer).
///
/// O(cells of the surface), once; then O(samples · cells along a line of sight).
pub struct SolidLayer<'a, S> {
    solid: &'a S,
    frame: Frame,
    finish: Finish,
    deepest: u8,
}

/// Levels to which a solid is split at most.
const DEEPEST: u8 = 11;

impl<'a, S: Solid> SolidLayer<'a, S> {
    /// What lies of a solid in the universe of a frame, whatever its depth.
    pub fn new(solid: &'a S, frame: &Frame, finish: Finish) -> SolidLayer<'a, S> {
        SolidLayer { solid, frame: *frame, finish, deepest: DEEPEST }
    }

    /// The same of larger cells: of the depth's, 1 to 11.
    #[must_use]
    pub fn at_most(self, depth: u8) -> SolidLayer<'a, S> {
        SolidLayer { deepest: depth.clamp(1, DEEPEST), ..self }
    }

    /// The frame whose cells are as large as a pixel where the universe is nearest.
    fn pixelled(&self, stage: &Stage<'_>) -> Result<Frame, Error> {
        let (view, frame) = (stage.view, &self.frame);
        let eye = DVec3::from(view.camera.eye());
        let low = DVec3::from(frame.origin());
        let nearest = (eye.clamp(low, low + frame.edge()) - eye).length().max(frame.edge() / 16.0);
        let pixel = view.pixel_at(nearest);
        let fine = (1..self.deepest).find(|&depth| frame.edge() / f64::from(1u32 << depth) <= pixel);
        frame.with_depth(fine.unwrap_or(self.deepest))
    }
}

impl<S: Solid> Draw for SolidLayer<'_, S> {
    fn prepare<'a>(&'a self, stage: &Stage<'a>) -> Result<Box<dyn Painter + 'a>, Error> {
        let frame = self.pixelled(stage)?;
        let control = Control { progress: None, ..*stage.job.control() };
        let octree = build(self.solid, &frame, Rule::Certified, &control)?;
        let classifier = self.solid.on(&frame, &control)?;
        Ok(memory::boxed(SolidPainter::<S> { finish: self.finish, stage: *stage, octree, classifier })?)
    }
}

struct SolidPainter<'a, S: Solid> {
    finish: Finish,
    stage: Stage<'a>,
    octree: Octree,
    classifier: S::Classifier,
}

impl<S: Solid> Painter for SolidPainter<'_, S> {
    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        let mut hand = Hand::<S> {
            trail: Trail::new(self.classifier.worker()?)?,
            normals: Normals::new(self.octree.view()),
            enclosures: HashMap::new(),
        };
        let mut cast = Cast::new(self.octree.view(), self.stage);
        while let Some((sights, hits)) = cast.next(tile)? {
            for (sight, hit) in sights.iter().zip(hits) {
                if let Some(hit) = hit {
                    self.sample(&mut hand, tile, sight, *hit)?;
                }
            }
        }
        Ok(())
    }
}

/// What a tile needs.
struct Hand<'t, S: Solid> {
    trail: Trail<WorkerOf<S>>,
    normals: Normals<'t>,
    enclosures: HashMap<[u32; 3], Option<Enclosure>>,
}

/// Most cells of one line of sight whose slabs it passes by.
const MOST_PASSED: usize = 32;

/// What is known of a line of sight in a cell.
enum Met {
    /// It meets the surface.
    At(f64, DVec3),
    /// It passes it by.
    Nowhere,
    /// Nothing.
    Unknown,
}

impl<S: Solid> SolidPainter<'_, S> {
    fn sample(
        &self,
        hand: &mut Hand<'_, S>,
        tile: &mut Tile<'_>,
        sight: &Sight,
        mut hit: RayHit,
    ) -> Result<(), Error> {
        for _ in 0..MOST_PASSED {
            let (t, face) = (hit.t.lower.max(0.0), DVec3::from(hit.normal));
            let frame = self.octree.frame();
            let at = hit.cell.first_at(frame.depth()).at;
            if hit.cell.level < frame.depth() || self.octree.view().tag_at(at) != Tag::Partial {
                // The face of a FULL cell is the surface.
                let normal = (!sight.begins_in(t, face)).then_some(face);
                return sight.draw(&self.finish, tile, t, normal);
            }
            let leaves = leaves(frame, hit.cell, sight);
            match self.met(hand, hit.cell, sight, [t, leaves])? {
                Met::At(s, _) if s <= 0.0 => return sight.draw(&self.finish, tile, 0.0, None),
                Met::At(s, normal) => return sight.draw(&self.finish, tile, s, Some(normal)),
                Met::Unknown => {
                    let point = sight.from + sight.along * t;
                    let found = normal_of_cells(&mut hand.normals, frame, point, &hit)?;
                    let normal = if found == DVec3::ZERO { face } else { found };
                    let begins = sight.begins_in(t, face);
                    return sight.draw(&self.finish, tile, t, (!begins).then_some(normal));
                }
                Met::Nowhere => {}
            }
            // On behind the cell, past its faces.
            let beyond = leaves + 1e-9 * frame.cell_size() / sight.along.length();
            let Some(next) = sight
                .beyond(beyond)
                .and_then(|ray| self.octree.cast_ray(&ray, crate::query::Obstacle::Upper))
            else {
                return Ok(());
            };
            hit = RayHit { t: next.t.plus(crate::lattice::Interval::exactly(beyond)), ..next };
        }
        Ok(())
    }

    /// Where a line of sight meets the surface in a cell that it crosses between two times.
    fn met(
        &self,
        hand: &mut Hand<'_, S>,
        cell: Cell,
        sight: &Sight,
        [enters, leaves]: [f64; 2],
    ) -> Result<Met, Error> {
        let found = match hand.enclosures.get(&cell.at) {
            Some(found) => *found,
            None => {
                hand.trail.follow(cell.parent(), self.stage.job.control())?;
                let found = hand.trail.enclosure(cell)?;
                hand.enclosures.try_reserve(1)?;
                hand.enclosures.insert(cell.at, found);
                found
            }
        };
        if let Some(enclosure) = found {
            return Ok(self.through(&enclosure, cell, sight, [enters, leaves]));
        }
        hand.trail.follow(cell.parent(), self.stage.job.control())?;
        let cube = Cube { frame: self.octree.frame(), cell };
        let (min, max) = cube.bounds();
        let point =
            |t: f64| (sight.from + sight.along * t).clamp(DVec3::from(min), DVec3::from(max)).to_array();
        let segment = Segment { from: point(enters), to: point(leaves) };
        Ok(match hand.trail.crossing(cell, &segment)? {
            Some(crossing) => {
                Met::At(enters + crossing.t.clamp(0.0, 1.0) * (leaves - enters), DVec3::from(crossing.normal))
            }
            None => Met::Unknown,
        })
    }

    /// Where it first is below the middles of slabs.
    fn through(&self, enclosure: &Enclosure, cell: Cell, sight: &Sight, [enters, leaves]: [f64; 2]) -> Met {
        let cube = Cube { frame: self.octree.frame(), cell };
        let half = cube.half_edge();
        let (min, max) = cube.bounds();
        let centre = 0.5 * DVec3::from(min) + 0.5 * DVec3::from(max);
        let from = (sight.from - centre) / half;
        let along = sight.along / half;
        let any = enclosure.join == SlabJoin::Any;
        // All: the time within all; any: the first time within one.
        let (mut first, mut last, mut normal) = (enters, leaves, None);
        let mut earliest: Option<(f64, Option<DVec3>)> = None;
        for slab in enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3]) {
            let outward = DVec3::from(slab.normal);
            let middle = match (slab.inner.is_finite(), slab.outer.is_finite()) {
                (true, true) => 0.5 * slab.inner + 0.5 * slab.outer,
                (true, false) => slab.inner,
                _ => slab.outer,
            };
            let (height, rise) = (outward.dot(from) - middle, outward.dot(along));
            let crosses = -height / rise;
            let (begins, ends, by) = if rise < 0.0 {
                if crosses > enters { (crosses, leaves, Some(outward)) } else { (enters, leaves, None) }
            } else if rise > 0.0 {
                (enters, crosses.min(leaves), None)
            } else if height <= 0.0 {
                (enters, leaves, None)
            } else {
                (leaves, enters, None)
            };
            if any {
                if begins < ends && earliest.is_none_or(|(t, _)| begins < t) {
                    earliest = Some((begins, by.or(Some(outward))));
                }
                continue;
            }
            if begins > first || normal.is_none() && rise < 0.0 {
                (first, normal) = (begins.max(first), Some(outward));
            }
            last = last.min(ends);
        }
        if any {
            return earliest.and_then(|(t, by)| Some(Met::At(t, by?))).unwrap_or(Met::Nowhere);
        }
        if first < last { Met::At(first, normal.unwrap_or(-sight.along)) } else { Met::Nowhere }
    }
}

/// When a line of sight leaves a cell.
fn leaves(frame: &Frame, cell: Cell, sight: &Sight) -> f64 {
    let (min, max) = Cube { frame, cell }.bounds();
    (0..3).fold(f64::INFINITY, |leaves, axis| {
        let plane = if sight.along[axis] > 0.0 { max[axis] } else { min[axis] };
        let t = (plane - sight.from[axis]) / sight.along[axis];
        // (What is not a number is never.)
        if t < leaves { t } else { leaves }
    })
}
