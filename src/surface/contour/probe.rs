//! Queries of a solid: the sides of points, and the crossings of lines with its surface.

use super::sheets::Inside;
use super::triangles::{Place, dot};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Cell, Frame, MAX_DEPTH, Ray, axes};
use crate::memory;
use crate::octree::Tag;
use crate::solid::{AskDirect, AskWhole, Classifier, Direct, Enclosure, RayTrace, Verdict, Worker};
use crate::walk::Trail;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// The greatest number of halvings of an edge between an inside point and an outside one.
const HALVINGS: usize = 40;

/// The number of levels by which a cell whose slabs give the normal at an edge is finer than the edge.
const FINER: u8 = 10;

/// The distance beside a crossing at which other crossings are searched for, as a part of the edge, if
/// nothing else gives the normal.
const BESIDE: f64 = 1.0 / 64.0;

/// An edge that is crossed: its axis, its lower end, its length, and whether it starts inside.
type Segment = (u8, [u32; 3], u32, bool);

/// The queries of one solid.
pub(super) struct Probe<'c, W: Worker> {
    /// Queries points and rays.
    worker: W,
    /// The root part for rays, if the solid answers them.
    root: Option<W::Part>,
    /// The root part for nearest points, if the solid provides them.
    nearest: Option<W::Part>,
    trace: RayTrace,
    /// Queries cells.
    trail: Trail<W>,
    frame: Frame,
    control: &'c Control<'c>,
    /// The edge of half a finest cell of the contour, in unit coordinates.
    half: f64,
    known: HashMap<[u32; 3], bool>,
    crossings: HashMap<Segment, Place>,
    /// The number of points whose side the solid did not report.
    pub(super) undecided: u64,
}

impl<'c, W: Worker> Probe<'c, W> {
    /// `classifier` must have the greatest depth; `depth` is the depth of the contour.
    pub(super) fn new<C: Classifier<Worker = W>>(
        classifier: &C,
        depth: u8,
        control: &'c Control<'c>,
    ) -> Result<Probe<'c, W>, Error> {
        classifier.is_direct(Direct::Points, control)?;
        let has_rays = classifier.is_direct(Direct::Rays, control)?;
        let mut worker = classifier.worker()?;
        let has_nearest = classifier.is_direct(Direct::Distances, control)?;
        let mut part = |is_wanted: bool| match worker.root() {
            Ok(Verdict::Partial(part)) if is_wanted => Ok(Some(part)),
            Ok(_) => Ok(None),
            Err(error) => Err(error),
        };
        let (root, nearest) = (part(has_rays)?, part(has_nearest)?);
        Ok(Probe {
            worker,
            root,
            nearest,
            trace: RayTrace::UNKNOWN,
            trail: Trail::new(classifier.worker()?)?,
            frame: *classifier.frame(),
            control,
            half: 0.5 / f64::from(1u32 << depth),
            known: HashMap::new(),
            crossings: HashMap::new(),
            undecided: 0,
        })
    }

    pub(super) fn root(&self) -> Tag {
        self.trail.root().tag()
    }

    /// The tags of the children of a cell, if it can be split.
    pub(super) fn children(&mut self, cell: Cell) -> Result<Option<[Tag; 8]>, Error> {
        self.trail.follow(cell, self.control)?;
        Ok(self
            .trail
            .verdicts(cell.level)
            .map(|verdicts| [0, 1, 2, 3, 4, 5, 6, 7].each(|octant: usize| verdicts[octant].tag())))
    }

    /// The slabs of the surface in a cell that is not the universe.
    pub(super) fn enclosure(&mut self, cell: Cell) -> Result<Option<Enclosure>, Error> {
        self.trail.follow(cell.parent(), self.control)?;
        self.trail.enclosure(cell)
    }

    /// A lattice point in unit coordinates.
    pub(super) fn unit(&self, at: [u32; 3]) -> [f64; 3] {
        at.each(|c| f64::from(c) * self.half)
    }

    /// The edge of the universe, in model units.
    pub(super) fn edge(&self) -> f64 {
        self.frame.edge()
    }

    /// The nearest point of the surface, if the solid provides it.
    pub(super) fn nearest(&mut self, unit: [f64; 3]) -> Result<Option<[f64; 3]>, Error> {
        let point = self.model(unit);
        let Some(root) = &self.nearest else { return Ok(None) };
        let found = self.worker.nearest(root, point)?;
        let frame = &self.frame;
        Ok(found.map(|found| axes(|k| (found.point[k] - frame.origin()[k]) / frame.edge())))
    }

    /// Adds points of the surface in a cell: for each undecided small cell in it the nearest point, if it is
    /// known.
    pub(super) fn samples(&mut self, cell: Cell, ahead: u8, found: &mut Vec<[f64; 3]>) -> Result<(), Error> {
        if ahead > 0
            && cell.level < MAX_DEPTH
            && let Some(tags) = self.children(cell)?
        {
            for (octant, tag) in (0..8u8).zip(tags) {
                if matches!(tag, Tag::Partial | Tag::Branch) {
                    self.samples(cell.child(octant), ahead - 1, found)?;
                }
            }
            return Ok(());
        }
        let edge = 1.0 / f64::from(1u32 << cell.level);
        let centre = cell.at.each(|c| (f64::from(c) + 0.5) * edge);
        if let Some(point) = self.nearest(centre)? {
            return memory::push(found, point);
        }
        let Some(enclosure) = self.enclosure(cell)? else { return Ok(()) };
        // The foot of the centre on the middle plane of its slab.
        let mut slabs = enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3]);
        let (Some(slab), None) = (slabs.next(), slabs.next()) else { return Ok(()) };
        let way = 0.5 * (slab.inner + slab.outer) / dot(slab.normal, slab.normal);
        let point = axes(|k| centre[k] + 0.5 * edge * way * slab.normal[k]);
        let is_own = (0..3).all(|k| (point[k] - centre[k]).abs() <= 0.5 * edge);
        if is_own { memory::push(found, point) } else { Ok(()) }
    }

    pub(super) fn model(&self, unit: [f64; 3]) -> [f64; 3] {
        axes(|axis| self.frame.origin()[axis] + unit[axis] * self.frame.edge())
    }

    /// Returns whether a point lies inside. Undecided points count as outside.
    fn holds(&mut self, unit: [f64; 3]) -> Result<bool, Error> {
        let mut answer = [None];
        self.worker.inside(&[self.model(unit)], &mut answer)?;
        if let [Some(is_inside)] = answer {
            return Ok(is_inside);
        }
        let cell = self.cell(unit, MAX_DEPTH);
        self.trail.follow(cell.parent(), self.control)?;
        match self.trail.verdict(cell).tag() {
            Tag::Empty => Ok(false),
            Tag::Full => Ok(true),
            Tag::Partial | Tag::Branch => {
                let is_inside = self.trail.sample(cell)?;
                self.undecided += u64::from(is_inside.is_none());
                Ok(is_inside.unwrap_or(false))
            }
        }
    }

    /// The cell of a level that contains a point.
    fn cell(&self, unit: [f64; 3], level: u8) -> Cell {
        let cells = f64::from(1u32 << level);
        // (NaN becomes 0.)
        Cell { level, at: unit.each(|c| (c * cells).clamp(0.0, cells - 1.0) as u32) }
    }

    /// Adds the crossings of the surface on a line along an axis between two lattice points, which are given
    /// in halves of finest cells. If the solid answers no rays, at most one crossing in each half of the line
    /// is added.
    pub(super) fn line(
        &mut self,
        axis: usize,
        from: [u32; 3],
        length: u32,
        found: &mut Vec<Place>,
    ) -> Result<(), Error> {
        let start = self.unit(from);
        if self.rays(axis, start, f64::from(length) * self.half, found)? {
            return Ok(());
        }
        let pieces = if length.is_multiple_of(2) { [length / 2; 2] } else { [length, 0] };
        let mut low = from;
        for piece in pieces {
            let mut high = low;
            high[axis] += piece;
            let starts_inside = self.is_inside(low)?;
            if piece > 0 && starts_inside != self.is_inside(high)? {
                let place = self.between(axis, low, piece, starts_inside)?;
                memory::push(found, place)?;
            }
            low = high;
        }
        Ok(())
    }

    /// Adds the crossings on the three lines through the middle of a cell, if the solid answers rays.
    pub(super) fn middle(&mut self, cell: Cell, found: &mut Vec<Place>) -> Result<(), Error> {
        let edge = 1.0 / f64::from(1u32 << cell.level);
        for axis in 0..3 {
            let mut start = cell.at.each(|c| (f64::from(c) + 0.5) * edge);
            start[axis] -= 0.5 * edge;
            self.rays(axis, start, edge, found)?;
        }
        Ok(())
    }

    /// Adds all crossings on a line by a ray. `false` if they are not known.
    fn rays(
        &mut self,
        axis: usize,
        start: [f64; 3],
        length: f64,
        found: &mut Vec<Place>,
    ) -> Result<bool, Error> {
        let Some(root) = &self.root else { return Ok(false) };
        let length = length * self.frame.edge();
        let from = axes(|axis| self.frame.origin()[axis] + start[axis] * self.frame.edge());
        let Ok(ray) = Ray::along_axis(from, axis, 1.0).until(length) else { return Ok(false) };
        self.worker.trace(root, &ray, false, &mut self.trace)?;
        if self.trace.until < length {
            return Ok(false);
        }
        for crossing in &self.trace.crossings {
            let t = 0.5 * crossing.t.lower + 0.5 * crossing.t.upper;
            if t > length {
                break;
            }
            let mut at = start;
            at[axis] += t / self.frame.edge();
            memory::push(found, Place { at, normal: unit_vector(crossing.normal) })?;
        }
        Ok(true)
    }

    /// Returns the crossing of an edge with an inside end and an outside one. The result is cached.
    pub(super) fn crossing(
        &mut self,
        axis: usize,
        from: [u32; 3],
        length: u32,
        starts_inside: bool,
        spare: &mut Vec<Place>,
    ) -> Result<Place, Error> {
        let segment = (axis as u8, from, length, starts_inside);
        if let Some(&known) = self.crossings.get(&segment) {
            return Ok(known);
        }
        let place = self.found_crossing(axis, from, length, starts_inside, spare)?;
        self.crossings.try_reserve(1)?;
        self.crossings.insert(segment, place);
        Ok(place)
    }

    fn found_crossing(
        &mut self,
        axis: usize,
        from: [u32; 3],
        length: u32,
        starts_inside: bool,
        spare: &mut Vec<Place>,
    ) -> Result<Place, Error> {
        spare.clear();
        let start = self.unit(from);
        if self.rays(axis, start, f64::from(length) * self.half, spare)? {
            // If there are several crossings, take the one through which the line leaves the solid.
            let sign = if starts_inside { 1.0 } else { -1.0 };
            let out = |place: &&Place| place.normal[axis] * sign > 0.0;
            let nearest = if starts_inside { spare.iter().find(out) } else { spare.iter().rev().find(out) };
            if let Some(place) = nearest.or(spare.first()) {
                return Ok(*place);
            }
        }
        self.between(axis, from, length, starts_inside)
    }

    /// Finds the crossing by halving.
    fn between(
        &mut self,
        axis: usize,
        from: [u32; 3],
        length: u32,
        starts_inside: bool,
    ) -> Result<Place, Error> {
        let start = self.unit(from);
        let length = f64::from(length) * self.half;
        let x = self.halve(axis, start, [start[axis], start[axis] + length], starts_inside)?;
        let mut at = start;
        at[axis] = x;
        let sign = if starts_inside { 1.0 } else { -1.0 };
        let normal = match self.slab(at, length)? {
            // (The normal may be that of another surface nearby.)
            Some(normal) if normal[axis] * sign > 0.0 => normal,
            _ => self.slope(axis, at, length, starts_inside)?.unwrap_or([0.0; 3]),
        };
        Ok(Place { at, normal })
    }

    fn halve(
        &mut self,
        axis: usize,
        mut point: [f64; 3],
        [mut low, mut high]: [f64; 2],
        starts_inside: bool,
    ) -> Result<f64, Error> {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            point[axis] = middle;
            if self.holds(point)? == starts_inside {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(0.5 * (low + high))
    }

    /// The normal by slabs of a small cell.
    fn slab(&mut self, at: [f64; 3], length: f64) -> Result<Option<[f64; 3]>, Error> {
        let mut level = FINER;
        while level < MAX_DEPTH && length < 1.0 / f64::from(1u32 << (level - FINER)) {
            level += 1;
        }
        let cell = self.cell(at, level);
        self.trail.follow(cell.parent(), self.control)?;
        let Some(enclosure) = self.trail.enclosure(cell)? else { return Ok(None) };
        let cells = f64::from(1u32 << level);
        let own = axes(|k| 2.0 * (at[k] * cells - f64::from(cell.at[k])) - 1.0);
        // If there are several slabs, take the one whose middle is nearest to the point.
        let mut best: Option<(f64, [f64; 3])> = None;
        for slab in enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3]) {
            let normal = unit_vector(slab.normal);
            let off = (dot(slab.normal, own) - 0.5 * (slab.inner + slab.outer)).abs()
                / sqrt(dot(slab.normal, slab.normal));
            if off.is_finite() && normal != [0.0; 3] && best.is_none_or(|(least, _)| off < least) {
                best = Some((off, normal));
            }
        }
        Ok(best.map(|(_, normal)| normal))
    }

    /// The normal by other crossings beside the crossing.
    fn slope(
        &mut self,
        axis: usize,
        at: [f64; 3],
        length: f64,
        starts_inside: bool,
    ) -> Result<Option<[f64; 3]>, Error> {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let step = BESIDE * length;
        let mut slopes = [0.0; 2];
        for (slope, other) in slopes.iter_mut().zip([u, v]) {
            let mut ends = [0.0; 2];
            for (end, sign) in ends.iter_mut().zip([-1.0, 1.0]) {
                let mut beside = at;
                beside[other] = (at[other] + sign * step).clamp(0.0, 1.0);
                let reach = [at[axis] - 16.0 * step, at[axis] + 16.0 * step].each(|c| c.clamp(0.0, 1.0));
                let mut low = beside;
                low[axis] = reach[0];
                let mut high = beside;
                high[axis] = reach[1];
                if self.holds(low)? != starts_inside || self.holds(high)? == starts_inside {
                    return Ok(None);
                }
                *end = self.halve(axis, beside, reach, starts_inside)?;
            }
            *slope = (ends[1] - ends[0]) / (2.0 * step);
        }
        let mut normal = [0.0; 3];
        (normal[axis], normal[u], normal[v]) = (1.0, -slopes[0], -slopes[1]);
        let normal = if starts_inside { normal } else { normal.each(|c| -c) };
        Ok(Some(unit_vector(normal)).filter(|normal| *normal != [0.0; 3]))
    }
}

impl<W: Worker> Inside for Probe<'_, W> {
    fn is_inside(&mut self, at: [u32; 3]) -> Result<bool, Error> {
        if let Some(&known) = self.known.get(&at) {
            return Ok(known);
        }
        let is_inside = self.holds(self.unit(at))?;
        self.known.try_reserve(1)?;
        self.known.insert(at, is_inside);
        Ok(is_inside)
    }
}

/// The unit vector in a direction; all zero if there is no direction.
fn unit_vector(vector: [f64; 3]) -> [f64; 3] {
    // (Products of very small or very large numbers underflow or overflow.)
    let most = vector.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    let scaled = vector.each(|c| c / most);
    let unit = scaled.each(|c| c / sqrt(dot(scaled, scaled)));
    if unit.iter().all(|c| c.is_finite()) { unit } else { [0.0; 3] }
}
