//! Surfaces of any solids, by rays.

use super::facets::Facets;
use super::kept::Kept;
use super::normals::{Normals, normal_of_cells};
use super::place_cache::Places;
use super::sight::{Finish, SightLine};
use super::stage::{Colouring, Draw, Painter, Stage};
use super::surface::{Seen, Skin, paint};
use super::tile::Tile;
use super::told::{Told, ask, probe};
use crate::attribute::Attribute;
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, Cube, Frame, MAX_DEPTH, Ray};
use crate::memory;
use crate::octree::{Octree, Tag};
use crate::op::{Rule, build_on};
use crate::query::TouchedCell;
use crate::solid::{
    AnyClassifier, AnyWorker, Ask, AskWhole, Classifier, Direct, DynSolid, Enclosure, ErasedPart, OCTANTS,
    RayTrace, Segment, SlabJoin, Verdict,
};
use alloc::boxed::Box;
use glam::DVec3;

/// A layer that shows the surface of any solid within a universe.
///
/// The solid is split to cells as large as a pixel, at most 2^11 along an axis. In an undecided cell, a line
/// of sight meets the surface that the solid provides: a crossing, or the middle of its slabs, with their
/// normals. In cells of which nothing is known, the surface and its normals are those of an
/// [`OctreeLayer`](crate::render::OctreeLayer). Through a translucent surface other layers are visible, but
/// nothing more of this layer.
///
/// If a solid answers rays, its cells are not split, and lines of sight are evaluated as rays. A closed mesh
/// answers rays, and an expression does in all cells in which only the mesh is open. For a solid that
/// consists of a single closed mesh ([`sole_mesh`](crate::Solid::sole_mesh)), the triangles are drawn, each
/// of them flat, where they look like the solid.
///
/// O(cells of the surface) once; then O(samples · cells along a line of sight).
pub struct SolidLayer<'a> {
    solid: &'a dyn DynSolid,
    frame: Frame,
    skin: Skin<'a>,
    deepest: u8,
    /// The triangles of a solid that consists of a single mesh.
    facets: Option<Facets<'a>>,
}

/// The greatest number of levels to which a solid is split.
pub const DEEPEST: u8 = 11;

/// The angle in radians by which a boundary may turn in a cell whose slab gives the normal.
const CONE: f64 = 0.08 * core::f64::consts::PI / 180.0;

impl<'a> SolidLayer<'a> {
    /// Creates a layer of the part of a solid in the universe of a frame, independently of the frame's depth.
    /// (A solid has no cells that [`faces`](Finish::faces) could show.)
    pub fn new(solid: &'a dyn DynSolid, frame: &Frame, finish: Finish) -> SolidLayer<'a> {
        let facets = solid.sole_mesh().map(|mesh| Facets::new(mesh, &finish));
        SolidLayer { solid, frame: *frame, skin: Skin { finish, values: None }, deepest: DEEPEST, facets }
    }

    /// Shows the colours of an attribute's values: `colour` returns the colour of a value, and of a missing
    /// value. The value is taken half a pixel below the surface.
    #[must_use]
    pub fn values(self, attribute: &'a dyn Attribute, colour: Colouring<'a>) -> SolidLayer<'a> {
        SolidLayer { skin: Skin { values: Some((attribute, colour)), ..self.skin }, ..self }
    }

    /// Limits the depth of cells, 1 to 11, so that cells may be larger.
    #[must_use]
    pub fn at_most(self, depth: u8) -> SolidLayer<'a> {
        SolidLayer { deepest: depth.clamp(1, DEEPEST), ..self }
    }
}

/// The frame whose cells are as large as a pixel where the universe is nearest, with at most `deepest`
/// levels.
fn pixelled(frame: &Frame, deepest: u8, stage: &Stage<'_>) -> Result<Frame, Error> {
    let pixel = stage.view.pixel_at(stage.view.nearest(frame));
    let fine = (1..deepest).find(|&depth| frame.edge() / f64::from(1u32 << depth) <= pixel);
    frame.with_depth(fine.unwrap_or(deepest))
}

/// Returns the painter of a solid within the universe of a frame, split to at most `deepest` levels.
pub fn painter<'a>(
    solid: &'a dyn DynSolid,
    frame: &Frame,
    deepest: u8,
    skin: &'a Skin<'a>,
    stage: &Stage<'a>,
) -> Result<Box<dyn Painter + 'a>, Error> {
    Ok(memory::boxed(SolidPainter::new(solid, frame, deepest, skin, stage)?)?)
}

impl Draw for SolidLayer<'_> {
    fn prepare<'a>(&'a self, stage: &Stage<'a>) -> Result<Box<dyn Painter + 'a>, Error> {
        self.skin.check()?;
        if let Some(facets) = &self.facets
            && facets.show_the_solid(&self.skin, &self.frame, stage)?
        {
            let stage = *stage;
            let make = move || SolidPainter::new(self.solid, &self.frame, self.deepest, &self.skin, &stage);
            return facets.painter(&stage, make);
        }
        painter(self.solid, &self.frame, self.deepest, &self.skin, stage)
    }
}

struct SolidPainter<'a> {
    skin: &'a Skin<'a>,
    stage: Stage<'a>,
    octree: Octree,
    /// The solid on the finest lattice.
    classifier: AnyClassifier<'a>,
    /// A ray to test whether the solid answers rays.
    probe: Ray,
}

impl<'a> SolidPainter<'a> {
    fn new(
        solid: &'a dyn DynSolid,
        frame: &Frame,
        deepest: u8,
        skin: &'a Skin<'a>,
        stage: &Stage<'a>,
    ) -> Result<Self, Error> {
        let frame = pixelled(frame, deepest, stage)?;
        let control = Control { progress: None, ..*stage.job.control() };
        let classifier = solid.on(&frame, &control)?;
        // (An answer for the universe does not imply answers for its cells.)
        classifier.is_direct(Direct::Rays, &control)?;
        let octree = build_on(&Told(classifier), Rule::Certified, &control)?;
        let classifier = solid.on(&frame.with_depth(MAX_DEPTH)?, &control)?;
        Ok(SolidPainter { skin, stage: *stage, octree, classifier, probe: probe(&frame)? })
    }
}

impl Painter for SolidPainter<'_> {
    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        let mut hand = Hand {
            kept: Kept::new(self.classifier.worker()?)?,
            normals: Normals::new(self.octree.view()),
            enclosures: Places::new(),
            trace: RayTrace::UNKNOWN,
        };
        // The cells are as large as a pixel.
        paint(tile, &self.stage, self.octree.view(), self.skin, 0.0, |sight, touch| {
            let met = self.sees(&mut hand, sight, touch)?;
            Ok(met.map(|(t, normal)| Seen { t, normal }))
        })
    }
}

/// The state of a tile.
struct Hand<'t> {
    kept: Kept<AnyWorker<'t>>,
    normals: Normals<'t>,
    enclosures: Places<Known>,
    trace: RayTrace,
}

/// The knowledge about the boundary in a cell.
enum Known {
    /// The solid answers rays.
    Told,
    Enclosed(Enclosure),
    Nothing,
}

/// The result for a line of sight in a cell.
enum Met {
    /// It meets the surface.
    At(f64, DVec3),
    /// It misses the surface, though it comes near to a face with this normal.
    Nowhere(DVec3),
    /// Nothing is known.
    Unknown,
}

impl SolidPainter<'_> {
    /// Returns the place where a line of sight meets the surface, from the first touched cell on, and the
    /// outward normal there; `None` for the normal if the line begins inside.
    fn sees(
        &self,
        hand: &mut Hand<'_>,
        sight: &SightLine,
        mut hit: TouchedCell,
    ) -> Result<Option<(f64, Option<DVec3>)>, Error> {
        let (octree, frame) = (self.octree.view(), self.octree.frame());
        let far = DVec3::from(frame.origin()).abs().max_element() + frame.edge();
        let length = sight.along.length();
        let step = 1e-6 * frame.cell_size() / length;
        // Past a face, independently of rounding.
        let past = (1e-3 * step).max(4.0 * f64::EPSILON * far / length);
        let mut passed: Option<(f64, DVec3)> = None;
        // A line meets at most this number of cells, and may miss the slabs of all of them.
        for _ in 0..3u32 << frame.depth() {
            let (t, met) = (hit.t, DVec3::from(hit.normal));
            let begins = sight.begins_in(t, met);
            // If the solid continues behind a cell, it begins in the next one, past its face.
            let face = if t > 0.0 && met == DVec3::ZERO { entry(frame, hit.cell, sight) } else { met };
            let at = hit.cell.first_at(frame.depth()).at;
            if octree.tag_at(at) != Tag::Partial {
                // The face of a FULL cell is the surface, unless the line has just missed the surface by a
                // rounding.
                let near = passed.filter(|(end, normal)| t - end <= step && *normal != DVec3::ZERO);
                return Ok(Some((t, (!begins).then_some(near.map_or(face, |(_, normal)| normal)))));
            }
            let [_, leaves] = stay(frame, hit.cell, sight);
            let met = if hit.cell.level < frame.depth() {
                self.within(hand, hit.cell, sight, ([t, leaves], face))?
            } else {
                self.met(hand, hit.cell, sight, [t, leaves])?
            };
            match met {
                Met::At(s, normal) => return Ok(Some((s, (s > 0.0).then_some(normal)))),
                Met::Unknown => {
                    let point = sight.from + sight.along * t;
                    let found = normal_of_cells(&mut hand.normals, frame, point, &hit)?;
                    let normal = if found == DVec3::ZERO { face } else { found };
                    return Ok(Some((t, (!begins).then_some(normal))));
                }
                Met::Nowhere(normal) => passed = Some((leaves, normal)),
            }
            // Continue behind the cell, past its faces.
            let beyond = leaves + past;
            let Some(next) = sight.beyond(beyond).and_then(|ray| octree.touch(&ray)) else {
                return Ok(None);
            };
            hit = TouchedCell { t: next.t + beyond, ..next };
        }
        Ok(None)
    }

    /// Returns the place where a line of sight meets the surface in a cell of any size. The line crosses the
    /// cell between two times and enters through a face.
    fn within(
        &self,
        hand: &mut Hand<'_>,
        cell: Cell,
        sight: &SightLine,
        ([enters, leaves], face): ([f64; 2], DVec3),
    ) -> Result<Met, Error> {
        let frame = self.octree.frame();
        let part = match hand.kept.verdict(cell, self.stage.job.control())? {
            Verdict::Empty => return Ok(Met::Nowhere(DVec3::ZERO)),
            Verdict::Full | Verdict::Undecided => return Ok(Met::At(enters, face)),
            Verdict::Partial(part) => part,
        };
        if cell.level >= frame.depth() {
            return self.met(hand, cell, sight, [enters, leaves]);
        }
        if let Some(met) = self.told(hand, (cell, &part), sight, ([enters, leaves], face))? {
            return Ok(met);
        }
        let mut ways = OCTANTS.each(|k| {
            let [a, b] = stay(frame, cell.child(k), sight);
            (a.max(enters), b.min(leaves), cell.child(k))
        });
        ways.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut last = DVec3::ZERO;
        for (from, to, child) in ways.into_iter().filter(|(from, to, _)| from < to) {
            let entry = if from > enters { entry(frame, child, sight) } else { face };
            match self.within(hand, child, sight, ([from, to], entry))? {
                Met::Nowhere(normal) => last = normal,
                Met::Unknown => return Ok(Met::At(from, entry)),
                met => return Ok(met),
            }
        }
        Ok(Met::Nowhere(last))
    }

    /// Returns the place where a line of sight enters the solid in a cell, if the solid answers rays.
    fn told(
        &self,
        hand: &mut Hand<'_>,
        (cell, part): (Cell, &ErasedPart),
        sight: &SightLine,
        ([enters, leaves], face): ([f64; 2], DVec3),
    ) -> Result<Option<Met>, Error> {
        let near = 1e-6 * self.octree.frame().cell_size() / sight.along.length();
        let enters = enters.max(0.0);
        // Usually the line of sight begins outside the solid, and the first triangle that it meets is found
        // soonest. An entry before the cell may not count, so the second attempt begins at the cell.
        for start in [0.0, enters] {
            let Some(ray) = sight.beyond(start) else { return Ok(Some(Met::Nowhere(DVec3::ZERO))) };
            let trace = &mut hand.trace;
            hand.kept.ask(|worker| ask(worker, cell, part, &ray, trace))?;
            let until = leaves.min(sight.length());
            return Ok(Some(match WayIn::new(trace, enters - start, near) {
                WayIn::Unknown => continue,
                WayIn::At(t, None) => Met::At(start + t, face),
                WayIn::At(t, Some(normal)) if start + t <= until => Met::At(start + t, normal),
                // The next cell begins with the face.
                WayIn::At(t, Some(normal)) if start + t <= until + near => Met::Nowhere(normal),
                WayIn::At(..) | WayIn::Nowhere => Met::Nowhere(DVec3::ZERO),
            }));
        }
        Ok(None)
    }

    /// Returns the place where a line of sight meets the surface in a finest cell that it crosses between two
    /// times.
    fn met(
        &self,
        hand: &mut Hand<'_>,
        cell: Cell,
        sight: &SightLine,
        [enters, leaves]: [f64; 2],
    ) -> Result<Met, Error> {
        match self.known(hand, cell)? {
            Known::Enclosed(enclosure) => {
                let (met, cone) = (self.through(enclosure, cell, sight, [enters, leaves]), enclosure.cone);
                return match met {
                    Met::At(t, normal) if cone > CONE && t > enters => {
                        Ok(self.closer(hand, cell, cone, sight, (t, normal))?.unwrap_or(met))
                    }
                    met => Ok(met),
                };
            }
            Known::Told => {
                if let Verdict::Partial(part) = hand.kept.verdict(cell, self.stage.job.control())? {
                    let face = entry(self.octree.frame(), cell, sight);
                    if let Some(met) = self.told(hand, (cell, &part), sight, ([enters, leaves], face))? {
                        return Ok(met);
                    }
                }
            }
            Known::Nothing => {}
        }
        let Verdict::Partial(part) = hand.kept.verdict(cell, self.stage.job.control())? else {
            return Ok(Met::Unknown);
        };
        let cube = Cube { frame: self.octree.frame(), cell };
        let (min, max) = cube.bounds();
        let point =
            |t: f64| (sight.from + sight.along * t).clamp(DVec3::from(min), DVec3::from(max)).to_array();
        let segment = Segment { from: point(enters), to: point(leaves) };
        Ok(match hand.kept.ask(|worker| worker.crossing(cell, &part, &segment))? {
            Some(crossing) => {
                Met::At(enters + crossing.t.clamp(0.0, 1.0) * (leaves - enters), DVec3::from(crossing.normal))
            }
            None => Met::Unknown,
        })
    }

    /// Returns the knowledge about the boundary in a cell.
    fn known<'h>(&self, hand: &'h mut Hand<'_>, cell: Cell) -> Result<&'h Known, Error> {
        if let Some(found) = hand.enclosures.find(cell) {
            return Ok(hand.enclosures.item(found));
        }
        let mut known = Known::Nothing;
        if let Verdict::Partial(part) = hand.kept.verdict(cell, self.stage.job.control())? {
            let trace = &mut hand.trace;
            let probe = &self.probe;
            hand.kept.ask(|worker| ask(worker, cell, &part, probe, trace))?;
            if trace.is_known() {
                known = Known::Told;
            } else if let Some(enclosure) = hand.kept.ask(|worker| worker.enclosure(cell, &part))? {
                known = Known::Enclosed(enclosure);
            }
        }
        let kept = hand.enclosures.keep(cell, known)?;
        Ok(hand.enclosures.item(kept))
    }

    /// Returns the place where the line meets the surface in a smaller cell around the found place, in which
    /// the boundary turns less; `None` if nothing is known there.
    fn closer(
        &self,
        hand: &mut Hand<'_>,
        cell: Cell,
        cone: f64,
        sight: &SightLine,
        (t, normal): (f64, DVec3),
    ) -> Result<Option<Met>, Error> {
        let finest = self.octree.frame().with_depth(MAX_DEPTH)?;
        // A boundary turns half as much in a cell of half the size.
        let more = (1..8).find(|&more| cone / f64::from(1u32 << more) <= CONE).unwrap_or(8);
        let level = (cell.level + more).min(MAX_DEPTH);
        let size = finest.edge() / f64::from(1u32 << level);
        let outward = normal.normalize_or_zero() * size;
        let point = sight.from + sight.along * t;
        for offset in [DVec3::ZERO, outward, -outward] {
            let Some(at) = finest.cell_of((point + offset).to_array()) else { continue };
            let near = Cell { level, at: at.each(|a| a >> (MAX_DEPTH - level)) };
            let Known::Enclosed(found) = self.known(hand, near)? else { continue };
            let normal = DVec3::from(found.slabs[0].normal);
            let [enters, leaves] = stay(&finest, near, sight);
            return Ok(Some(match self.through(found, near, sight, [enters, leaves]) {
                Met::At(s, normal) if s > enters => Met::At(s, normal),
                // The line meets the surface beside that cell.
                _ => Met::At(t, normal),
            }));
        }
        Ok(None)
    }

    /// Returns the place where the line first is below the middles of slabs.
    fn through(
        &self,
        enclosure: &Enclosure,
        cell: Cell,
        sight: &SightLine,
        [enters, leaves]: [f64; 2],
    ) -> Met {
        let (low, edge) = corner_of(self.octree.frame(), cell);
        let half = 0.5 * edge;
        let centre = low + half;
        let from = (sight.from - centre) / half;
        let along = sight.along / half;
        let any = enclosure.join == SlabJoin::Any;
        // All: the time within all; any: the first time within one.
        let (mut first, mut last, mut normal) = (enters, leaves, None);
        let mut facing = DVec3::ZERO;
        let mut earliest: Option<(f64, Option<DVec3>)> = None;
        for slab in enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3]) {
            let outward = DVec3::from(slab.normal);
            let middle = match (slab.inner.is_finite(), slab.outer.is_finite()) {
                (true, true) => 0.5 * slab.inner + 0.5 * slab.outer,
                (true, false) => slab.inner,
                _ => slab.outer,
            };
            let (height, rise) = (outward.dot(from) - middle, outward.dot(along));
            if rise < 0.0 {
                facing = outward;
            }
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
            return earliest.and_then(|(t, by)| Some(Met::At(t, by?))).unwrap_or(Met::Nowhere(facing));
        }
        if first < last { Met::At(first, normal.unwrap_or(-sight.along)) } else { Met::Nowhere(facing) }
    }
}

/// The first time at which a ray is inside.
enum WayIn {
    /// At a time, with the outward normal at the entry; no normal if the ray is inside already.
    At(f64, Option<DVec3>),
    /// Never.
    Nowhere,
    /// Unknown, because the trace ends before.
    Unknown,
}

impl WayIn {
    /// The first entry at time `from` or later. A crossing within `near` of this time counts as lying there.
    fn new(trace: &RayTrace, from: f64, near: f64) -> WayIn {
        let mut is_inside = trace.begins_inside;
        for crossing in &trace.crossings {
            let t = 0.5 * crossing.t.lower + 0.5 * crossing.t.upper;
            let is_in = crossing.is_inside_after;
            if t < from - near || !is_in && t <= from + near {
                is_inside = is_in;
            } else if is_inside {
                break;
            } else if is_in {
                return WayIn::At(t.max(from), Some(DVec3::from(crossing.normal).normalize_or_zero()));
            }
        }
        match is_inside {
            true if trace.until >= from => WayIn::At(from, None),
            false if trace.until == f64::INFINITY => WayIn::Nowhere,
            _ => WayIn::Unknown,
        }
    }
}

/// The outward normal of the face through which a line of sight enters a cell.
fn entry(frame: &Frame, cell: Cell, sight: &SightLine) -> DVec3 {
    let (low, edge) = corner_of(frame, cell);
    let axes = (0..3).filter(|&axis| sight.along[axis] != 0.0);
    let time = |axis: usize| {
        let near = if sight.along[axis] > 0.0 { low[axis] } else { low[axis] + edge };
        (near - sight.from[axis]) / sight.along[axis]
    };
    let mut normal = DVec3::ZERO;
    if let Some(axis) = axes.max_by(|&a, &b| time(a).total_cmp(&time(b))) {
        normal[axis] = -sight.along[axis].signum();
    }
    normal
}

/// The lower corner and the edge of a cell, up to rounding.
fn corner_of(frame: &Frame, cell: Cell) -> (DVec3, f64) {
    let edge = frame.edge() / f64::from(1u32 << cell.level);
    (DVec3::from(frame.origin()) + DVec3::from(cell.at.each(f64::from)) * edge, edge)
}

/// The times at which a line of sight enters and leaves a cell. The line misses the cell if it leaves before
/// it enters.
fn stay(frame: &Frame, cell: Cell, sight: &SightLine) -> [f64; 2] {
    let (low, edge) = corner_of(frame, cell);
    let axes = (0..3).filter(|&axis| sight.along[axis] != 0.0);
    axes.fold([f64::NEG_INFINITY, f64::INFINITY], |[enters, leaves], axis| {
        let [a, b] = [0.0, edge].each(|more| (low[axis] + more - sight.from[axis]) / sight.along[axis]);
        [enters.max(a.min(b)), leaves.min(a.max(b))]
    })
}

#[cfg(test)]
mod tests {
    use super::super::camera::{Camera, Lens, View};
    use super::super::cast::Cast;
    use super::super::clip::Clip;
    use super::*;
    use crate::control::Job;
    use crate::op::build;
    use crate::solid::{Csg, Solid};
    use std::vec::Vec;

    /// Angles in degrees between the visible normals of a ball and its own, and the greatest distance of the
    /// points.
    fn angles(depth: u8, use_slabs: bool, lens: Lens) -> (Vec<f64>, f64) {
        let centre = DVec3::new(0.013, -0.021, 0.017);
        let ball = Csg::ball(centre.to_array(), 0.8).unwrap();
        let frame = Frame::new([-1.0; 3], 2.0, depth).unwrap();
        let camera = Camera::new([3.0, -4.0, 2.5], [0.0; 3], [0.0, 0.0, 1.0], lens).unwrap();
        let view = View::new(&camera, [256, 256]);
        let (control, clip) = (Control::threads(1), Clip::new());
        let job = Job::new(&control);
        let stage = Stage { view: &view, clip: &clip, job: &job };
        let painter = SolidPainter {
            skin: &Skin { finish: Finish::default(), values: None },
            stage,
            octree: build(&ball, &frame, Rule::Certified, &control).unwrap(),
            classifier: ball.on(&frame.with_depth(MAX_DEPTH).unwrap(), &control).unwrap().erased(),
            probe: probe(&frame).unwrap(),
        };
        let octree = painter.octree.view();
        let mut hand = Hand {
            kept: Kept::new(painter.classifier.worker().unwrap()).unwrap(),
            normals: Normals::new(octree),
            enclosures: Places::new(),
            trace: RayTrace::UNKNOWN,
        };
        let tile = Tile::new(&view, [0, 0], [256, 256], 1).unwrap();
        let mut cast = Cast::new(octree, stage);
        let (mut angles, mut off) = (Vec::new(), 0.0f64);
        while let Some(met) = cast.next(&tile).unwrap() {
            for (sight, hit) in met {
                let seen = if use_slabs {
                    painter.sees(&mut hand, sight, hit).unwrap()
                } else {
                    let point = sight.from + sight.along * hit.t;
                    let found = normal_of_cells(&mut hand.normals, &frame, point, &hit).unwrap();
                    Some((hit.t, Some(found)))
                };
                let Some((t, normal)) = seen else { continue };
                let from = sight.from + sight.along * t - centre;
                let (normal, exact) = (normal.unwrap().normalize(), from.normalize());
                angles.push(normal.cross(exact).length().atan2(normal.dot(exact)).to_degrees());
                off = off.max((from.length() - 0.8).abs());
            }
        }
        (angles, off)
    }

    fn worst(angles: &[f64]) -> f64 {
        angles.iter().fold(0.0, |worst, angle| angle.max(worst))
    }

    #[test]
    fn normals_of_slabs_are_exact() {
        for lens in [Lens::Perspective(25.0), Lens::Parallel(2.0)] {
            let (angles, off) = angles(7, true, lens);
            assert!(angles.len() > 20_000);
            assert!(worst(&angles) < 0.1);
            assert!(off < 1e-4);
        }
    }

    #[test]
    fn normals_of_cells_are_near() {
        for lens in [Lens::Perspective(25.0), Lens::Parallel(2.0)] {
            let (angles, _) = angles(9, false, lens);
            let mean = angles.iter().sum::<f64>() / angles.len() as f64;
            assert!(angles.len() > 20_000);
            assert!(worst(&angles) < 5.0 && mean < 0.5);
        }
    }
}
