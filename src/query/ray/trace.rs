//! The cells of a tree with cuts along a ray, found in doubles with bounded errors.
//!
//! A [`March`](super::march::March) ends at the first FULL cell and does not examine PARTIAL cells. A trace
//! examines the PARTIAL cells on its path. A visitor gets the cells with exact times, and in the order of the
//! exact search.

use super::course::{Clear, Course, Start};
use super::cut::CutLine;
use super::line::{Line, Moment, Passage};
use super::search::{Known, Visitor};
use super::way::Way;
use crate::error::Error;
use crate::lattice::Cell;
use crate::lattice::Each;
use crate::octree::Tag;
use crate::octree::cuts::{CellCut, CutsRef};

/// A ray through a tree with cuts.
pub(super) struct Trace<'l, 'f, 'a> {
    pub(super) cuts: &'l CutsRef<'a>,
    pub(super) line: &'l Line<'f>,
    pub(super) course: &'l Course,
    /// The region where nothing stops the ray.
    pub(super) clear: Clear,
}

/// The kind of a cell on the ray.
enum Found {
    Empty,
    Full,
    Partial(CellCut),
}

impl Trace<'_, '_, '_> {
    /// Passes the cells along the ray that are not EMPTY to a visitor, front to back. Returns `false` if
    /// rounding errors may change the cells that the ray meets. The visitor has then seen some cells, and its
    /// answer is invalid.
    #[inline(always)]
    pub(super) fn show(&self, way: &mut Way<'_, '_>, visitor: &mut impl Visitor) -> Result<bool, Error> {
        let Trace { line, course, .. } = *self;
        let (tree, last) = (way.tree, line.ray.last);
        let frame = &tree.frame;
        let start = match course.start(frame, last) {
            Start::At(at, by) => course.skip(frame, last, (at, by), self.clear),
            other => other,
        };
        let (mut at, mut by) = match start {
            Start::Beside => return Ok(true),
            Start::At(at, by) => (at, by),
            Start::Unsure => return Ok(false),
        };
        // The moment at which the ray leaves the previous cell, if known.
        let mut left = None;
        loop {
            let place = [0, 1, 2, 3].each(|axis| at[axis] ^ course.mirror[axis]);
            let (found, shift) = self.cell(way, place);
            // Leave the cell by the plane that is passed first.
            let (far, times) = course.leaves(at, shift);
            let [x, y, z, _] = times.to_array();
            let least_of_two = if x < y { x } else { y };
            let t = if z < least_of_two { z } else { least_of_two };
            let passed = times.simd_eq(t);
            let axes = passed.to_bitmask();
            let axis = (axes >> 1) as usize;
            let error = course.time_error[axis & 3];
            let goes_on = t < last - error;
            if !goes_on && t <= last + error {
                return Ok(false);
            }
            let (cell, sure) = course.cells(t, error);
            if goes_on && (!axes.is_power_of_two() || !(sure | passed).all()) {
                return Ok(false);
            }
            let next = Course::integers(passed.select(far, cell));
            let exit = match found {
                Found::Empty => None,
                Found::Full | Found::Partial(_) => {
                    let enters = || by.map_or(Moment::START, |axis| self.passes(axis, at[axis]));
                    let entry = left.unwrap_or_else(enters);
                    let exit = if goes_on { self.passes(axis, next[axis]) } else { Moment::exactly(last) };
                    let passage = Passage { entry, exit };
                    if visitor.skips(&passage) {
                        return Ok(true);
                    }
                    let cell = Cell {
                        level: frame.depth() - shift as u8,
                        at: [place[0], place[1], place[2]].each(|a| a >> shift),
                    };
                    self.meet(&found, cell, &passage, visitor)?;
                    if visitor.ends(&passage) {
                        return Ok(true);
                    }
                    Some(exit)
                }
            };
            let changed = (next[0] ^ at[0]) | (next[1] ^ at[1]) | (next[2] ^ at[2]);
            if !goes_on || changed >= frame.cells() {
                return Ok(true);
            }
            (at, by, left) = (next, Some(axis), exit);
        }
    }

    /// Returns the kind of the cell that contains a finest cell, and the binary logarithm of the cell's edge.
    /// For an EMPTY cell, it is the largest cube in which nothing further may stop the ray.
    #[inline(always)]
    fn cell(&self, way: &mut Way<'_, '_>, place: [u32; 4]) -> (Found, u32) {
        let (tag, shift, c) = way.to(place);
        let (tree, planes) = (way.tree, way.planes);
        let is_cut = tree.root == Tag::Branch;
        if tag == Tag::Empty {
            if !is_cut {
                return (Found::Empty, shift);
            }
            let stops = (planes.lower | planes.upper) & self.course.ahead(place, shift);
            let octant = 0xFF << (c & !7);
            return (Found::Empty, shift + (stops & octant == 0) as u32 + (stops == 0) as u32);
        }
        let shift = shift + (is_cut && planes.octant(c >> 3) == tag) as u32;
        if tag == Tag::Full {
            return (Found::Full, shift);
        }
        let record = if is_cut { self.cuts.record(way.element(), planes, c) } else { CutsRef::ROOT };
        self.recorded(record, shift, place)
    }

    /// Returns the part of a PARTIAL cell, whose edge is 2^shift, that contains a finest cell.
    #[inline(always)]
    fn recorded(&self, mut record: usize, mut shift: u32, place: [u32; 4]) -> (Found, u32) {
        loop {
            let cut = self.cuts.at(record);
            let CellCut::Split(first) = cut else { return (Found::Partial(cut), shift) };
            if shift == 0 {
                return (Found::Partial(CellCut::None), 0);
            }
            shift -= 1;
            let bit = |axis: usize| (place[axis] >> shift & 1) as usize;
            record = first + (bit(0) | bit(1) << 1 | bit(2) << 2);
        }
    }

    /// Returns the moment at which the ray passes a plane of an axis. The plane is given in the course's
    /// coordinates.
    #[inline(always)]
    fn passes(&self, axis: usize, plane: u32) -> Moment {
        let plane = if self.course.falls(axis) { self.line.frame.cells() - plane } else { plane };
        self.line.passes(axis, plane)
    }

    #[inline(never)]
    fn meet(
        &self,
        found: &Found,
        cell: Cell,
        passage: &Passage,
        visitor: &mut impl Visitor,
    ) -> Result<(), Error> {
        match found {
            Found::Empty => Ok(()),
            Found::Full => visitor.meet(self.line, cell, passage, Known::Full),
            Found::Partial(CellCut::Table { ids, table }) => {
                let times = [passage.entry.t.lower, passage.exit.t.upper];
                let table = CutLine::new(&self.cuts.surfaces, ids, *table, self.line, times);
                visitor.meet(self.line, cell, passage, Known::Table(&table))
            }
            Found::Partial(_) => visitor.meet(self.line, cell, passage, Known::Partial(None)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::octree::{exact_spans, exactly};
    use super::super::{Obstacle, Ray};
    use super::*;
    use crate::control::Control;
    use crate::lattice::{Affine, Frame};
    use crate::octree::Octree;
    use crate::op::{SurfaceOptions, build_extended};
    use crate::solid::Csg;
    use leafless_testkit::Random;
    use std::vec::Vec;

    /// A number from -1 to 1, usually one of few numbers, so that surfaces and planes of the lattice
    /// coincide.
    fn number(random: &mut Random) -> f64 {
        if random.below(3) == 0 { random.between(-1.0, 1.0) } else { random.below(17) as f64 / 8.0 - 1.0 }
    }

    fn vector(random: &mut Random) -> [f64; 3] {
        [0; 3].map(|_| number(random))
    }

    fn primitive(random: &mut Random) -> Option<Csg> {
        // Most sizes are eighths, as most coordinates are, so that some rays are tangents.
        let size = (0.125 + number(random).abs()).min(1.0);
        let csg = match random.below(5) {
            0 => {
                let [a, b] = [vector(random), vector(random)];
                let ends = |pick: fn(f64, f64) -> f64| [0, 1, 2].map(|axis| pick(a[axis], b[axis]));
                return Csg::cuboid(ends(f64::min), ends(f64::max)).ok();
            }
            1 => Csg::cylinder(0.5 * size, -size, size),
            2 => Csg::frustum(size, 0.25 * size, -0.5, 0.5),
            3 => Csg::torus(0.75 * size, 0.25 * size),
            _ => Csg::ball([0.0; 3], size),
        };
        let [x, y, z] = vector(random);
        // Two rotations by the triangle 3-4-5, around z and around x.
        let turned = [[0.6, -0.64, 0.48, x], [0.8, 0.48, -0.36, y], [0.0, 0.6, 0.8, z]];
        let moved = [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z]];
        let map = if random.below(2) == 0 { moved } else { turned };
        csg.ok()?.placed(&Affine::new(map).ok()?).ok()
    }

    fn tree(random: &mut Random) -> Option<Octree> {
        let mut csg = primitive(random)?;
        for _ in 0..random.below(8) {
            let other = primitive(random)?;
            csg = match random.below(3) {
                0 => Csg::union_of([csg, other]),
                1 => Csg::intersection_of([csg, other]),
                _ => csg.difference(&other),
            }
            .ok()?;
        }
        let depth = [1, 2, 3, 4, 5, 8, 11, 20][random.below(8) as usize];
        // The universe cuts some of the solids.
        let frame = match random.below(3) {
            0 => Frame::new([-1.0; 3], 2.0, depth),
            1 => Frame::new([-2.0, -1.5, -1.0], 4.0, depth),
            _ => Frame::new([-1.1, -1.3, -1.7], 3.1, depth),
        };
        let options = SurfaceOptions::default();
        build_extended(&csg, &frame.ok()?, &options, &Control::threads(1))
            .ok()
            .filter(|tree| tree.view().cuts().is_some())
    }

    /// Rays through lattice planes, edges and corners, along axes and in faces, with any start.
    fn ray(frame: &Frame, random: &mut Random) -> Option<Ray> {
        let from = match random.below(4) {
            // A corner of a cell.
            0 => {
                let level = random.below(4.min(u64::from(frame.depth()) + 1)) as i32;
                let step = frame.edge() * 0.5f64.powi(level);
                frame.origin().map(|origin| origin + step * random.below((1 << level) + 1) as f64)
            }
            1 => vector(random).map(|c| 4.0 * c),
            _ => vector(random),
        };
        let ray = match random.below(4) {
            0 => Ray::between(from, vector(random)),
            1 => {
                let mut direction = [0.0; 3];
                direction[random.below(3) as usize] = if random.below(2) == 0 { 1.0 } else { -0.75 };
                Ray::new(from, direction)
            }
            2 => Ray::new(from, [0; 3].map(|_| random.below(3) as f64 - 1.0)),
            _ => Ray::new(from, vector(random)),
        };
        let last = if random.below(3) == 0 { 0.25 + 2.0 * random.unit() } else { f64::INFINITY };
        ray.ok()?.until(last).ok()
    }

    /// The statistics of a trace.
    #[derive(Default)]
    struct Shown {
        tables: u32,
        pieces: u32,
        /// The number of tables with an undecided piece that is longer than a crossing.
        open: u32,
    }

    impl Visitor for Shown {
        fn skips(&self, _: &Passage) -> bool {
            false
        }

        fn ends(&self, _: &Passage) -> bool {
            false
        }

        fn meet(&mut self, _: &Line<'_>, _: Cell, _: &Passage, known: Known<'_>) -> Result<(), Error> {
            let Known::Table(table) = known else { return Ok(()) };
            let (mut end, mut is_open) = (0.0, false);
            table.walk(|piece| {
                assert!(piece.low == end && piece.low < piece.high, "{piece:?}");
                end = piece.high;
                is_open |= piece.is_inside.is_none() && piece.high - piece.low > 1e-9;
                self.pieces += 1;
                true
            });
            assert_eq!(end, 1.0);
            self.tables += 1;
            self.open += u32::from(is_open);
            Ok(())
        }
    }

    /// Traces a ray. Returns whether the cells are certain in spite of rounding errors.
    fn trace(tree: &Octree, ray: &Ray, shown: &mut Shown) -> bool {
        let view = tree.view();
        let (line, course) = (Line::new(view.frame(), *ray), Course::new(view.frame(), ray));
        let cuts = view.cuts.as_ref().unwrap();
        let trace = Trace { cuts, line: &line, course: &course, clear: Clear::UNKNOWN };
        trace.show(&mut Way::new(view), shown).unwrap()
    }

    #[test]
    fn traces_are_the_exact_search() {
        let (mut random, mut counts) = (Random(0x7ACE), [0u32; 4]);
        let (mut trees, mut splits, mut shown) = (0, 0, Shown::default());
        while trees < 300 {
            let Some(tree) = tree(&mut random) else { continue };
            trees += 1;
            splits += tree.view().cuts().unwrap().splits;
            let rays: Vec<Ray> =
                core::iter::repeat_with(|| ray(tree.frame(), &mut random)).flatten().take(60).collect();
            for on in [Obstacle::Full, Obstacle::Upper] {
                let mut hits = [None; 60];
                tree.cast_rays(&rays, on, &mut hits).unwrap();
                for (ray, hit) in rays.iter().zip(hits) {
                    assert_eq!(hit, exactly(on, tree.view(), ray), "{ray:?} {:?}", tree.frame());
                    assert_eq!(tree.cast_ray(ray, on), hit);
                }
                counts[on as usize] += hits.iter().flatten().count() as u32;
            }
            for ray in &rays {
                let spans = tree.ray_spans(ray).unwrap();
                assert_eq!(
                    spans,
                    exact_spans(tree.view(), &Line::new(tree.frame(), *ray)).unwrap(),
                    "{ray:?} {:?}",
                    tree.frame()
                );
                counts[2] += spans.inner.len() as u32;
                counts[3] += u32::from(trace(&tree, ray, &mut shown));
            }
        }
        let [full, upper, spans, traced] = counts;
        std::println!(
            "{full} and {upper} hits, {spans} spans, {traced} of 18000 rays traced; {splits} splits"
        );
        let Shown { tables, pieces, open } = shown;
        std::println!("{tables} tables, {pieces} pieces, {open} tables with long pieces that are not known");
        // A crossing makes two more pieces, and three surfaces have up to six crossings.
        assert!(pieces < 5 * tables && 50 * open < tables);
        assert!(full > 500 && upper > 1000 && spans > 500 && traced > 5000 && splits > 60);
    }
}
