//! Rays through an open surface: their intervals inside its solid.
//!
//! A cell is divided into pieces. For each piece, the winding number of the caps that are far from it is
//! expanded around its middle. The expansion serves all pieces below. The near caps are few, and are summed
//! at each point. In a piece that the boundary does not come near to, one expansion covers all caps. There
//! the surface's winding number is M − c: M counts the triangles of the surface alone, and c is the caps'
//! smooth continuation from the middle of the piece.
//!
//! So a ray's intervals end where the ray pierces triangles, as for a closed surface, and between the
//! triangles where c passes one half of an integer. The sides of centres agree with sampling: expansions
//! decide most of them, and where they cannot, all caps are summed for the centre. Between two centres (or
//! triangles, or faces of the piece) on different sides, sums over the rim find the crossing. These sums have
//! rounding errors only.
//!
//! Near the rim, a ray is followed from centre to centre. Between centres on different sides, or with
//! triangles between them, it advances in steps in which the winding number changes by less than one half.

use super::chords::{Bundle, Chords, Hit, Rays, end};
use super::on_frame::{MeshOnFrame, MeshPart};
use super::open::Surroundings;
use super::rim::Fraction;
use super::winding::{Local, Range as Known};
use crate::dexel::{Beam, BeamEnd, Mark, first_above, within};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::floor;
use crate::memory;
use alloc::vec::Vec;
use core::ops::Range;

/// Rays are followed through cells of at most this edge, in finest cells.
const MOST: i32 = 64;

/// Pieces of this edge are not divided further, in finest cells.
const LEAST: i32 = 2;

/// Half the diagonal of a cube of half edge 1, rounded up.
const HALF_DIAGONAL: f64 = 1.732_051;

/// An expansion is good enough if its error is at most the change of the caps' winding number within this
/// many cells.
const BLUR: f64 = 0.5;

/// An expansion with at most this error is good enough, whatever the change is.
const GOOD: f64 = 1.0 / 16384.0;

/// Every expansion must have an error below this, so that it distinguishes integers.
const SURE: f64 = 0.2;

/// The most steps by which a ray is followed from a finest cell's centre to its face.
const MOST_STEPS: usize = 256;

/// The shortest of these steps, in finest cells: at the greatest depth, still distinguishable from zero in
/// the smallest model.
const SHORTEST: f64 = 1.0 / (1u64 << 20) as f64;

/// The most steps to a crossing; plain bisection would take fewer.
const MOST_HALVES: usize = 64;

/// A cell in which the caps' winding number is smooth.
struct Smooth {
    local: Local,
    /// A bound of the expansion's error anywhere in the cell.
    error: f64,
}

/// A ray in a piece through which no boundary passes.
struct Ray<'r> {
    search: &'r Search<'r>,
    mesh: &'r MeshOnFrame,
    smooth: &'r Smooth,
    ray: [i32; 2],
    step: i32,
    /// The axis, and a point of the ray.
    w: usize,
    from: [f64; 3],
    /// The coefficients of the caps' winding number along the ray, relative to `from`.
    along: [f64; 3],
}

/// A finest cell near the rim, and the ray through its centre.
struct Walk<'m> {
    mesh: &'m MeshOnFrame,
    w: usize,
    at: [i32; 3],
    /// The winding number at the centre, for the surface with its caps.
    winding: i32,
    marked: bool,
}

/// A point of a ray, with its side.
#[derive(Clone, Copy)]
struct Point {
    at: f64,
    /// The caps' winding number, on the branch that is followed.
    caps: f64,
    inside: bool,
}

/// Two points of a ray between which it crosses the boundary (the first may be the higher one), the ray's
/// axis, and the winding number of the surface with its caps that belongs to the points' branch.
struct Bracket {
    w: usize,
    winding: i32,
    ends: [Point; 2],
}

/// The intervals of one ray, as they are found.
struct Intervals<'b> {
    beam: &'b mut Beam,
    ray: [u32; 2],
    start: Option<BeamEnd>,
}

impl Intervals<'_> {
    /// The ray passes to the inside, or to the outside.
    fn pass(&mut self, end: BeamEnd, inside: bool) -> Result<(), Error> {
        match (self.start, inside) {
            (None, true) => self.start = Some(end),
            (Some(start), false) => {
                self.start = None;
                self.beam.push(self.ray, start, end)?;
            }
            _ => {}
        }
        Ok(())
    }
}

/// Scratch memory for a worker's rays, kept from cell to cell.
#[derive(Default)]
pub(super) struct OpenRays {
    chords: Chords,
    near: Vec<u32>,
    passes: Vec<(BeamEnd, bool)>,
}

/// A cell whose rays are computed, with their hits on the surface and its caps.
struct Search<'s> {
    mesh: &'s MeshOnFrame,
    chords: &'s Chords,
    bundle: &'s Bundle,
}

/// A piece of the cell. Caps near the piece are summed exactly, and an expansion covers the far caps. Another
/// expansion covers all caps, if the boundary is not near.
struct Piece<'p> {
    far: &'p Local,
    near: &'p [u32],
    smooth: Option<Smooth>,
    /// Whether caps may lie between centres of the piece.
    is_capped: bool,
}

/// The rays of a piece.
struct Part {
    columns: Range<i32>,
    rows: Range<i32>,
    span: Range<i32>,
}

impl Search<'_> {
    /// Returns the part of the rays that lies in a cube.
    fn part(&self, at: [i32; 3], size: i32) -> Part {
        let Bundle { w, u, v, .. } = *self.bundle;
        let cut = |range: &Range<i32>, axis: usize| range.start.max(at[axis])..range.end.min(at[axis] + size);
        Part {
            columns: cut(&self.bundle.columns, u),
            rows: cut(&self.bundle.rows, v),
            span: cut(&self.bundle.span, w),
        }
    }

    /// Visits the cell's pieces, each as large as an expansion is good for. Pieces on a ray come in ascending
    /// order. `known` is the expansion of all caps except those in a list.
    fn pieces(
        &self,
        (at, size): ([i32; 3], i32),
        known: &Local,
        list: Range<usize>,
        near: &mut Vec<u32>,
        visit: &mut impl FnMut(Piece<'_>, Part) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let part = self.part(at, size);
        if part.columns.is_empty() || part.rows.is_empty() || part.span.is_empty() {
            return Ok(());
        }
        let MeshOnFrame { placed, caps, .. } = self.mesh;
        let half = f64::from(size) / 2.0;
        let middle = at.each(|a| f64::from(a) + half);
        let radius = half * HALF_DIAGONAL;
        let first = near.len();
        let far = caps.far(placed, known, list, near, (middle, radius))?;
        let range = first..near.len();
        let smooth = caps.whole(placed, &far, &near[range.clone()], radius).and_then(|local| {
            let error = local.within(radius).error;
            let is_good = error <= GOOD || error <= BLUR * local.steepness();
            let is_good = error < SURE && (is_good || local.over(at, size).nearest().is_some());
            is_good.then_some(Smooth { local, error })
        });
        if smooth.is_some() || size <= LEAST {
            let meets = |&cap: &u32| {
                let [low, high] = placed.rank_box(placed.cap(cap));
                (0..3).all(|axis| low[axis] <= at[axis] + size && high[axis] >= at[axis])
            };
            let near = &near[range];
            visit(Piece { far: &far, near, smooth, is_capped: near.iter().any(meets) }, part)?;
        } else {
            for k in 0..8 {
                let child = axes(|axis| at[axis] + if k >> axis & 1 != 0 { size / 2 } else { 0 });
                self.pieces((child, size / 2), &far, range.clone(), near, visit)?;
            }
        }
        near.truncate(first);
        Ok(())
    }

    /// A cell of a ray.
    fn cell(&self, column: i32, row: i32, k: i32) -> [i32; 3] {
        let mut cell = [0; 3];
        (cell[self.bundle.u], cell[self.bundle.v], cell[self.bundle.w]) = (column, row, k);
        cell
    }

    /// Returns the winding number at the centre of cell k of a ray, for the surface with its caps, and the
    /// ray's hits above it.
    fn above(&self, [column, row]: [i32; 2], k: i32) -> (i32, &[Hit]) {
        let (floor, hits) = self.chords.traced(self.bundle, column, row);
        let start = hits.partition_point(|hit| hit.at <= f64::from(self.bundle.span.start) + 0.5);
        let below = hits.partition_point(|hit| hit.at <= f64::from(k) + 0.5);
        (floor + hits[start..below].iter().map(Hit::step).sum::<i32>(), &hits[below..])
    }

    /// The hits of a ray on the surface itself.
    fn surface(&self, [column, row]: [i32; 2]) -> impl DoubleEndedIterator<Item = &Hit> + Clone {
        let (_, hits) = self.chords.traced(self.bundle, column, row);
        hits.iter().filter(|hit| !self.mesh.placed.is_cap(hit.triangle()))
    }

    /// The caps' winding number at a centre.
    fn caps_at(&self, piece: &Piece<'_>, cell: [i32; 3]) -> Known {
        let MeshOnFrame { placed, caps, .. } = self.mesh;
        caps.at(placed, (piece.far, piece.near), cell.each(|a| f64::from(a) + 0.5), Some(cell))
    }

    /// Returns by how much the caps' winding number at the lowest centre of a ray exceeds the smooth
    /// continuation. `None` if the sum at the centre is not precise enough.
    fn step(&self, piece: &Piece<'_>, ray: [i32; 2], span: &Range<i32>) -> Option<i32> {
        let cell = self.cell(ray[0], ray[1], span.start);
        let (here, there) = (piece.smooth.as_ref()?.local.at_centre(cell), self.caps_at(piece, cell));
        let is_told = there.error < SURE;
        is_told.then(|| floor(there.value - here.value + 0.5) as i32)
    }

    /// Calls `visit` for all rays of a piece, each with its [`step`](Self::step).
    fn rays(
        &self,
        piece: &Piece<'_>,
        part: &Part,
        mut visit: impl FnMut([i32; 2], Option<Ray<'_>>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let Part { columns, rows, span } = part;
        // Without caps the step is the same everywhere.
        let common = if piece.is_capped { None } else { self.step(piece, [columns.start, rows.start], span) };
        for row in rows.clone() {
            for column in columns.clone() {
                let ray = [column, row];
                let step = if piece.is_capped { self.step(piece, ray, span) } else { common };
                let smooth = piece.smooth.as_ref().zip(step);
                visit(ray, smooth.map(|(smooth, step)| Ray::new(self, smooth, ray, step, span.start)))?;
            }
        }
        Ok(())
    }

    /// Returns the caps' number at a centre, and whether the centre is inside. `winding` is the number of the
    /// surface with its caps.
    fn centre(&self, piece: &Piece<'_>, cell: [i32; 3], winding: i32) -> (Known, bool) {
        let caps = self.caps_at(piece, cell);
        let excess = self.mesh.excess(f64::from(winding) - caps.value);
        // (False for NaN.)
        if excess.abs() > caps.error {
            return (caps, excess > 0.0);
        }
        let is_sure = caps.error < SURE;
        let told = if is_sure { self.mesh.told_centre(cell, winding, caps.value) } else { None };
        (caps, told.unwrap_or_else(|| self.mesh.summed_sample(cell, winding)))
    }
}

impl MeshOnFrame {
    /// Adds the intervals of a beam's rays in a cell. Returns `false` if the cell must be divided first.
    pub(super) fn open_chords(
        &self,
        own: &mut OpenRays,
        (triangles, at, size): (&[u32], [i32; 3], i32),
        part: MeshPart,
        beam: &mut Beam,
    ) -> Result<bool, Error> {
        if size > MOST {
            return Ok(false);
        }
        let bundle = Bundle::new(beam);
        self.trace(own, (triangles, at), part, &bundle)?;
        let OpenRays { chords, near, passes } = own;
        let search = Search { mesh: self, chords, bundle: &bundle };
        let middle = at.each(|a| f64::from(a) + f64::from(size) / 2.0);
        let all = 0..near.len();
        search.pieces((at, size), &Local::nothing(middle), all, near, &mut |piece, part| {
            search.rays(&piece, &part, |number, ray| match ray {
                Some(ray) => ray.walk(&part.span, beam),
                None => search.follow(&piece, number, &part.span, passes, beam),
            })
        })?;
        Ok(true)
    }

    /// Finds the hits of the rays.
    fn trace(
        &self,
        own: &mut OpenRays,
        (triangles, at): (&[u32], [i32; 3]),
        part: MeshPart,
        bundle: &Bundle,
    ) -> Result<(), Error> {
        let rays = Rays { placed: &self.placed, at, triangles, winding: part.winding, fill: self.fill };
        own.chords.trace(&rays, bundle)?;
        own.near.clear();
        self.caps.list(&mut own.near)
    }

    /// Finds the centres of a block of 64³ cells that are inside: bit k of word x + 64·y.
    pub(super) fn open_centres(
        &self,
        own: &mut OpenRays,
        (triangles, at): (&[u32], [i32; 3]),
        part: MeshPart,
        inside: &mut [u64; 4096],
    ) -> Result<(), Error> {
        let range = |axis: usize| at[axis]..at[axis] + MOST;
        let bundle = Bundle { w: 2, u: 0, v: 1, columns: range(0), rows: range(1), span: range(2) };
        self.trace(own, (triangles, at), part, &bundle)?;
        let OpenRays { chords, near, .. } = own;
        let search = Search { mesh: self, chords, bundle: &bundle };
        let middle = at.each(|a| f64::from(a) + f64::from(MOST) / 2.0);
        let all = 0..near.len();
        inside.fill(0);
        search.pieces((at, MOST), &Local::nothing(middle), all, near, &mut |piece, part| {
            search.rays(&piece, &part, |number, ray| {
                let bits = match ray {
                    Some(ray) => ray.centres(&part.span),
                    None => search.centres(&piece, number, &part.span),
                };
                let word = (number[1] - at[1]) * MOST + (number[0] - at[0]);
                inside[word as usize] |= bits << (part.span.start - at[2]);
                Ok(())
            })
        })
    }

    /// Returns whether a centre is inside that an expansion cannot decide: the final answer of
    /// [`open_sample`](Self::open_sample). `winding` is the number of the surface with its caps.
    fn summed_sample(&self, at: [i32; 3], winding: i32) -> bool {
        self.open_sample(&mut Surroundings::default(), at, MeshPart::unknown(winding))
    }

    /// Returns whether points with this winding number are inside.
    fn is_inside(&self, winding: f64) -> bool {
        self.excess(winding) >= 0.0
    }

    /// Returns the caps' winding number at a point, on the branch nearest to `guess`. On the rim, returns
    /// `guess`.
    fn caps_near(&self, point: [f64; 3], guess: f64) -> f64 {
        self.caps_told(point, guess).map_or(guess, |caps| caps.value)
    }

    /// Returns the caps' number on the branch of `guess` with a bound of its error. The guess must be less
    /// than one half off. `None` on the rim.
    fn caps_told(&self, point: [f64; 3], guess: f64) -> Option<Fraction> {
        let Fraction { value, error } = self.caps.rim.fraction(point)?;
        let off = value - guess;
        let off = off - floor(off + 0.5) as f64;
        Some(Fraction { value: guess + off, error: error + f64::EPSILON * (1.0 + guess.abs()) })
    }

    /// Returns whether a centre is inside, if a sum over the rim decides. `winding` is the number that
    /// belongs to the branch of `guess`. The guess must be less than one half off.
    fn told_centre(&self, cell: [i32; 3], winding: i32, guess: f64) -> Option<bool> {
        let caps = self.caps_told(cell.each(|a| f64::from(a) + 0.5), guess)?;
        let excess = self.excess(f64::from(winding) - caps.value);
        let is_told = excess.abs() > caps.error;
        is_told.then_some(excess > 0.0)
    }

    /// Returns where a ray through `from` crosses the boundary: where the winding number, on the branch that
    /// `guess` gives, passes one half or minus one half. Uses false position in the Illinois form, which
    /// halves the weight of an end that stays.
    fn crossing(&self, from: [f64; 3], bracket: &Bracket, guess: impl Fn(f64) -> f64) -> BeamEnd {
        let &Bracket { w, winding, ends: [first, last] } = bracket;
        let excess = |caps: f64| self.excess(f64::from(winding) - caps);
        let ([mut a, mut b], [mut fa, mut fb]) =
            ([first.at, last.at], [excess(first.caps), excess(last.caps)]);
        let cells = self.placed.frame.cells();
        let fine = f64::from(cells) / (1u64 << 40) as f64;
        let mut found = if fa.abs() < fb.abs() { a } else { b };
        let mut kept = 0;
        // (Ends whose values contradict their sides, by rounding, lie next to the crossing.)
        if (fa < 0.0) != (fb < 0.0) {
            for step in 0..MOST_HALVES {
                let width = b - a;
                let middle = a + 0.5 * width;
                let linear = a + width * (fa / (fa - fb));
                let is_between = (linear - a) * (linear - b) < 0.0;
                found = if step % 8 == 7 || !is_between { middle } else { linear };
                if width.abs() <= fine {
                    break;
                }
                let mut point = from;
                point[w] = found;
                let value = excess(self.caps_near(point, guess(found)));
                if value == 0.0 {
                    break;
                }
                if (value < 0.0) == (fa < 0.0) {
                    let step = (found - a).abs();
                    (a, fa) = (found, value);
                    if kept == 1 {
                        fb *= 0.5;
                    }
                    kept = 1;
                    if step <= fine && value.abs() < fine {
                        break;
                    }
                } else {
                    let step = (found - b).abs();
                    (b, fb) = (found, value);
                    if kept == -1 {
                        fa *= 0.5;
                    }
                    kept = -1;
                    if step <= fine && value.abs() < fine {
                        break;
                    }
                }
            }
        }
        // The result lies below the centre if that is the higher end, above the centre if that is the lower
        // end.
        let gap = first_above(first.at.max(last.at)) as i32;
        BeamEnd { at: within(found, gap, f64::from(cells)), mark: Mark::NONE }
    }
}

impl<'r> Ray<'r> {
    fn new(search: &'r Search<'r>, smooth: &'r Smooth, ray: [i32; 2], step: i32, start: i32) -> Ray<'r> {
        let Bundle { w, .. } = *search.bundle;
        let mut from = search.cell(ray[0], ray[1], start).each(|a| f64::from(a) + 0.5);
        from[w] = f64::from(start);
        let along = smooth.local.along(w, from);
        Ray { search, mesh: search.mesh, smooth, ray, step, w, from, along }
    }

    /// The caps' winding number from the expansion.
    fn caps(&self, at: f64) -> f64 {
        let x = at - self.from[self.w];
        self.along[0] + (self.along[1] + self.along[2] * x) * x
    }

    /// Returns the side of all points whose winding number is in a range, widened by the expansion's error.
    /// `None` if the points may lie on both sides.
    fn side(&self, low: f64, high: f64) -> Option<bool> {
        let (low, high) = (low - self.smooth.error, high + self.smooth.error);
        let (first, last) = (self.mesh.excess(low), self.mesh.excess(high));
        // For a range around zero, the ends are the farthest from zero.
        let is_through = low < 0.0 && high > 0.0;
        match (first > 0.0, last > 0.0) {
            (true, true) if !is_through => Some(true),
            (false, false) if first < 0.0 && last < 0.0 => Some(false),
            _ => None,
        }
    }

    /// A point whose side the expansion decides, or else a sum over the rim.
    fn point(&self, at: f64, winding: i32) -> Point {
        let guess = self.caps(at);
        let number = f64::from(winding) - guess;
        if let Some(inside) = self.side(number, number) {
            return Point { at, caps: guess, inside };
        }
        let mut point = self.from;
        point[self.w] = at;
        let caps = self.mesh.caps_near(point, guess);
        Point { at, caps, inside: self.mesh.is_inside(f64::from(winding) - caps) }
    }

    /// Returns the side of the whole way between two points, if the expansion decides it without a test of
    /// each centre.
    fn whole(&self, from: f64, to: f64, winding: i32) -> Option<bool> {
        let (first, last) = (self.caps(from), self.caps(to));
        let (mut low, mut high) = (first.min(last), first.max(last));
        // The height of a parabola over its chord.
        let bend = 0.25 * self.along[2].abs() * (to - from) * (to - from);
        (low, high) = (low - bend, high + bend);
        self.side(f64::from(winding) - high, f64::from(winding) - low)
    }

    /// Decides by sums whether centre k is inside, where the expansion is too coarse.
    fn sample(&self, k: i32, number: i32, caps: f64) -> bool {
        let cell = self.search.cell(self.ray[0], self.ray[1], k);
        self.mesh.told_centre(cell, number, caps).unwrap_or_else(|| {
            let (winding, _) = self.search.above(self.ray, k);
            self.mesh.summed_sample(cell, winding)
        })
    }

    /// The surface's number at the lowest centre of a span, and the ray's hits on the surface in the span.
    fn hits(&self, span: &Range<i32>) -> (i32, impl Iterator<Item = &'r Hit> + Clone) {
        let (winding, _) = self.search.above(self.ray, span.start);
        let (bottom, top) = (f64::from(span.start), f64::from(span.end));
        let hits = self.search.surface(self.ray).skip_while(move |hit| hit.at <= bottom);
        (winding - self.step, hits.take_while(move |hit| hit.at < top))
    }

    /// Returns which centres of a span are inside.
    fn centres(&self, span: &Range<i32>) -> u64 {
        let (mut winding, hits) = self.hits(span);
        let (mut from, mut bits) = (span.start, 0);
        let mut add = |winding: i32, centres: Range<i32>| {
            if centres.is_empty() {
                return;
            }
            let [first, last] = [centres.start, centres.end - 1].each(|k| f64::from(k) + 0.5);
            let whole = self.whole(first, last, winding);
            for k in centres {
                let inside = whole.unwrap_or_else(|| self.centre(k, winding).inside);
                bits |= u64::from(inside) << (k - span.start);
            }
        };
        let lowest = f64::from(span.start) + 0.5;
        for hit in hits.skip_while(|hit| hit.at <= lowest) {
            let above = (first_above(hit.at) as i32).min(span.end);
            add(winding, from..above);
            from = above;
            winding += hit.step();
        }
        add(winding, from..span.end);
        bits
    }

    /// The point at a centre.
    fn centre(&self, k: i32, winding: i32) -> Point {
        let at = f64::from(k) + 0.5;
        let caps = self.caps(at);
        let number = f64::from(winding) - caps;
        Point { at, caps, inside: self.side(number, number).unwrap_or_else(|| self.sample(k, winding, caps)) }
    }

    /// Adds the ray's intervals in a span.
    fn walk(&self, span: &Range<i32>, beam: &mut Beam) -> Result<(), Error> {
        let (number, hits) = self.hits(span);
        let marked = beam.is_marked();
        let mut intervals = Intervals { beam, ray: self.ray.each(|a| a as u32), start: None };
        // Go back from the lowest centre to the face.
        let lowest = f64::from(span.start) + 0.5;
        let mut winding =
            number - hits.clone().take_while(|hit| hit.at <= lowest).map(Hit::step).sum::<i32>();
        let mut from = f64::from(span.start);
        let mut before: Option<&Hit> = None;
        for next in hits.map(Some).chain([None]) {
            let to = next.map_or(f64::from(span.end), |hit| hit.at);
            let whole = self.whole(from, to, winding);
            let first = match whole {
                Some(inside) => Point { at: from, caps: 0.0, inside },
                None => self.point(from, winding),
            };
            match before {
                Some(hit) if first.inside != intervals.start.is_some() => {
                    intervals.pass(end(&self.mesh.placed, hit, first.inside, marked), first.inside)?;
                }
                Some(_) => {}
                None if first.inside => intervals.start = Some(BeamEnd::between(span.start as u32)),
                None => {}
            }
            if whole.is_none() {
                self.pieces([first, self.point(to, winding)], winding, &mut intervals)?;
            }
            if let Some(hit) = next {
                winding += hit.step();
            }
            (from, before) = (to, next);
        }
        intervals.pass(BeamEnd::between(span.end as u32), false)
    }

    /// Goes from centre to centre between two points of the ray with no triangle between them.
    fn pieces(
        &self,
        [first, last]: [Point; 2],
        winding: i32,
        intervals: &mut Intervals<'_>,
    ) -> Result<(), Error> {
        let mut point = first;
        // A centre that lies on a triangle counts as above it.
        let centres = first_above(first.at)..first_above(last.at);
        for next in centres.map(Some).chain([None]) {
            let next = match next {
                Some(k) => self.centre(k as i32, winding),
                None => last,
            };
            if next.inside != point.inside {
                let ends = [point, next].each(|point| self.sharp(point));
                let bracket = Bracket { w: self.w, winding, ends };
                let end = self.mesh.crossing(self.from, &bracket, |at| self.caps(at));
                intervals.pass(end, next.inside)?;
            }
            point = next;
        }
        Ok(())
    }

    /// The point with the caps' number from a sum over the rim.
    fn sharp(&self, point: Point) -> Point {
        let mut place = self.from;
        place[self.w] = point.at;
        Point { caps: self.mesh.caps_near(place, self.caps(point.at)), ..point }
    }
}

impl Search<'_> {
    /// Returns which centres of a span are inside.
    fn centres(&self, piece: &Piece<'_>, ray: [i32; 2], span: &Range<i32>) -> u64 {
        let (mut winding, hits) = self.above(ray, span.start);
        let (mut hits, mut bits) = (hits.iter().peekable(), 0);
        for k in span.clone() {
            while let Some(hit) = hits.next_if(|hit| hit.at <= f64::from(k) + 0.5) {
                winding += hit.step();
            }
            let (_, inside) = self.centre(piece, self.cell(ray[0], ray[1], k), winding);
            bits |= u64::from(inside) << (k - span.start);
        }
        bits
    }

    /// Adds the intervals of a ray near the rim, from centre to centre.
    fn follow(
        &self,
        piece: &Piece<'_>,
        ray: [i32; 2],
        span: &Range<i32>,
        passes: &mut Vec<(BeamEnd, bool)>,
        beam: &mut Beam,
    ) -> Result<(), Error> {
        let marked = beam.is_marked();
        let mut intervals = Intervals { beam, ray: ray.each(|a| a as u32), start: None };
        let mut before: Option<(Walk<'_>, Point)> = None;
        // (The upper face follows the last centre.)
        for k in span.start..=span.end {
            let next = (k < span.end).then(|| {
                let cell = self.cell(ray[0], ray[1], k);
                let (winding, _) = self.above(ray, k);
                let (caps, inside) = self.centre(piece, cell, winding);
                let walk = Walk { mesh: self.mesh, w: self.bundle.w, at: cell, winding, marked };
                (walk, Point { at: f64::from(k) + 0.5, caps: caps.value, inside })
            });
            let low = before.as_ref().map_or(f64::from(span.start), |(_, point)| point.at);
            let high = next.as_ref().map_or(f64::from(span.end), |(_, point)| point.at);
            // A centre that lies on a triangle counts as above it; no triangle counts as on a face.
            let is_between = |hit: &&Hit| hit.at > low && hit.at <= high && hit.at < f64::from(span.end);
            let hits = self.surface(ray).filter(is_between);
            let is_pierced = hits.clone().next().is_some();
            passes.clear();
            match (&before, &next) {
                (None, Some((walk, point))) => {
                    let face = self.side_of_face(piece, walk, point, low).filter(|_| !is_pierced);
                    let inside = if face == Some(point.inside) {
                        point.inside
                    } else {
                        walk.lead(walk.sharp(*point), hits.rev(), low, passes)?.inside
                    };
                    if inside {
                        intervals.start = Some(BeamEnd::between(span.start as u32));
                    }
                    passes.reverse();
                }
                (Some((_, point)), Some((_, next))) if !is_pierced && point.inside == next.inside => {}
                (Some((walk, point)), Some((_, next))) => {
                    let last = walk.lead(walk.sharp(*point), hits, high, passes)?;
                    if last.inside != next.inside {
                        // Rounding has put the crossing on the other side of the centre.
                        memory::push(passes, (BeamEnd { at: next.at, mark: Mark::NONE }, next.inside))?;
                    }
                }
                (Some((walk, point)), None) => {
                    let face = self.side_of_face(piece, walk, point, high).filter(|_| !is_pierced);
                    if face != Some(point.inside) {
                        walk.lead(walk.sharp(*point), hits, high, passes)?;
                    }
                }
                (None, None) => {}
            }
            for &(end, inside) in passes.iter() {
                intervals.pass(end, inside)?;
            }
            before = next;
        }
        intervals.pass(BeamEnd::between(span.end as u32), false)
    }

    /// Returns on which side a face half a cell from a centre lies, with no triangle of the surface between
    /// them. `None` if the sum does not decide.
    fn side_of_face(&self, piece: &Piece<'_>, walk: &Walk<'_>, centre: &Point, at: f64) -> Option<bool> {
        let ray = [walk.at[self.bundle.u], walk.at[self.bundle.v]];
        let (_, hits) = self.chords.traced(self.bundle, ray[0], ray[1]);
        let (low, high) = (at.min(centre.at), at.max(centre.at));
        let first = hits.partition_point(|hit| hit.at <= low);
        let steps = hits[first..].iter().take_while(|hit| hit.at <= high).map(Hit::step).sum::<i32>();
        let winding = walk.winding + if at > centre.at { steps } else { -steps };
        let MeshOnFrame { placed, caps, .. } = self.mesh;
        let caps = caps.at(placed, (piece.far, piece.near), walk.place(at), None);
        let excess = self.mesh.excess(f64::from(winding) - caps.value);
        let is_told = excess.abs() > caps.error;
        is_told.then_some(excess > 0.0)
    }
}

impl Walk<'_> {
    /// The point with the caps' number from a sum over the rim, with rounding errors only.
    fn sharp(&self, point: Point) -> Point {
        Point { caps: self.mesh.caps_near(self.place(point.at), point.caps), ..point }
    }

    fn place(&self, at: f64) -> [f64; 3] {
        let mut place = self.at.each(|a| f64::from(a) + 0.5);
        place[self.w] = at;
        place
    }

    /// Goes from the centre to a face through triangles. Notes where the ray passes the boundary, and whether
    /// it is inside above that place. Returns the point on the face.
    fn lead<'h>(
        &self,
        mut point: Point,
        hits: impl Iterator<Item = &'h Hit>,
        face: f64,
        passes: &mut Vec<(BeamEnd, bool)>,
    ) -> Result<Point, Error> {
        let is_upward = face > point.at;
        let mut winding = self.winding;
        for hit in hits {
            point = self.advance(point, hit.at, winding, passes)?;
            winding += if is_upward { hit.step() } else { -hit.step() };
            let inside = self.mesh.is_inside(f64::from(winding) - point.caps);
            if inside != point.inside {
                let above = if is_upward { inside } else { point.inside };
                memory::push(passes, (end(&self.mesh.placed, hit, above, self.marked), above))?;
                point.inside = inside;
            }
        }
        self.advance(point, face, winding, passes)
    }

    /// Goes from a point to another one without a triangle between them, by steps in which the winding number
    /// changes by less than one half.
    fn advance(
        &self,
        mut point: Point,
        to: f64,
        winding: i32,
        passes: &mut Vec<(BeamEnd, bool)>,
    ) -> Result<Point, Error> {
        let mut steps = 0;
        while point.at != to {
            let slope = self.mesh.caps.rim.slope(self.place(point.at));
            let step = (0.5 * slope.distance).min(0.25 / slope.most);
            // (This step is last, too, where nothing is known, on the rim.)
            let is_last = steps == MOST_STEPS || (to - point.at).abs() <= step;
            let at = if is_last { to } else { point.at + step.max(SHORTEST) * (to - point.at).signum() };
            let at = if to > point.at { at.min(to) } else { at.max(to) };
            steps += 1;
            let caps = self.mesh.caps_near(self.place(at), point.caps);
            let next = Point { at, caps, inside: self.mesh.is_inside(f64::from(winding) - caps) };
            if next.inside != point.inside {
                let bracket = Bracket { w: self.w, winding, ends: [point, next] };
                let middle = 0.5 * (point.caps + next.caps);
                let end = self.mesh.crossing(self.place(at), &bracket, |_| middle);
                memory::push(passes, (end, if to > point.at { next.inside } else { point.inside }))?;
            }
            point = next;
        }
        Ok(point)
    }
}
