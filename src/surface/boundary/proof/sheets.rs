//! Bounds of the distance of the boundary from the mesh: surface by surface, in boxes along the surface.
//!
//! Consider a box in which the surface is a graph over a plane, and the triangles of the surface seen along
//! the plane's normal. Where they cover the plane, the graph lies above them, and the values of the surface's
//! function on them bound the distance. If the solid begins on the surface only beside other surfaces, the
//! functions of all these increase along one direction in the plane. So a line in this direction that starts
//! on the boundary stays on it. It reaches a part of the plane that is covered, so it enters the triangles
//! through a side. The length of the line up to that side then follows from the values of the others'
//! functions on that side.

use super::super::figures::{Figures, dot, length, minus};
use super::clip::clip;
use super::local::{Local, Prism, magnitude};
use super::truth::{Around, LEAST, cube};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Bounds, Cell, axes};
use crate::memory;
use crate::mesh::TriangleTree;
use crate::solid::OpenSurfaces;
use alloc::vec::Vec;

/// The greatest rounding error of places in the plane.
const ROUNDING: f64 = 1e-14;

/// A mesh that is to be proven near a solid, in the coordinates of the universe.
pub(super) struct Subject<'m> {
    pub(super) vertices: &'m [[f64; 3]],
    pub(super) triangles: &'m [[u32; 3]],
    /// The surface of each triangle.
    pub(super) surfaces: &'m [u32],
    /// The triangles across the sides of each triangle.
    pub(super) mates: Vec<[u32; 3]>,
    pub(super) tree: TriangleTree<'m>,
    pub(super) origin: [f64; 3],
    pub(super) edge: f64,
}

impl Subject<'_> {
    pub(super) fn corners(&self, triangle: u32) -> [[f64; 3]; 3] {
        self.triangles[triangle as usize].each(|v| self.vertices[v as usize])
    }

    /// The triangles of a surface that meet a box, and perhaps some beside it.
    fn meeting(&self, around: &Around, surface: u32, found: &mut Vec<u32>) -> Result<(), Error> {
        found.clear();
        let model = |p: [f64; 3]| axes(|k| self.origin[k] + p[k] * self.edge);
        let bounds = Bounds { min: model(around.low), max: model(around.high) };
        let mut failed = None;
        let is_own = |triangle: u32| self.surfaces[triangle as usize] == surface;
        self.tree.in_box_of(&bounds, is_own, &mut |triangle| {
            if let Err(error) = memory::push(found, triangle) {
                failed = Some(error);
            }
        });
        found.sort_unstable();
        failed.map_or(Ok(()), Err)
    }

    /// An upper bound of the distance of the points in a box from the mesh, with the nearest triangle;
    /// infinite without a mesh.
    pub(super) fn away(&self, around: &Around) -> (f64, Option<u32>) {
        let centre = around.centre();
        let point = axes(|k| self.origin[k] + centre[k] * self.edge);
        let Some((nearest, away)) = self.tree.nearest_of(&point, |_| true) else {
            return (f64::INFINITY, None);
        };
        let most = away.upper / self.edge * (1.0 + ROUNDING) + length(minus(around.high, centre)) + ROUNDING;
        (most, Some(nearest.triangle))
    }
}

/// The result for a box.
enum Outcome {
    /// A bound of the distance of the boundary in the box from the mesh.
    Within(f64),
    /// The box is to be cut across a direction.
    Cut([f64; 3]),
}

/// One surface in one cell.
pub(super) struct Sheet<'s> {
    pub(super) subject: &'s Subject<'s>,
    pub(super) figures: &'s Figures,
    pub(super) open: &'s OpenSurfaces,
    /// The surface's place in the list.
    place: usize,
    /// Whether the solid lies where the surface's function is positive. (The negative side is another sheet.)
    is_above: bool,
    pub(super) cell: Cell,
    pub(super) tolerance: f64,
    lists: &'s mut Lists,
    boxes: u32,
}

/// Buffers.
#[derive(Default)]
pub(super) struct Lists {
    /// The triangles of the surface near a box.
    found: Vec<u32>,
    /// The same triangles as seen along the normal.
    seen: Vec<Seen>,
    /// All triangles that were examined.
    pub(super) used: Vec<u32>,
    part: Vec<[f64; 3]>,
    cut: Vec<[f64; 3]>,
}

/// A triangle seen along the normal.
struct Seen {
    number: u32,
    places: [[f64; 3]; 3],
    /// The area; positive if the triangle faces in the same direction as the boundary.
    area: f64,
}

/// Another surface, beside which the solid begins on this one.
#[derive(Clone, Copy)]
struct Limit {
    surface: u32,
    bit: u8,
    /// Whether the solid begins where its function is positive.
    is_up: bool,
    /// Its function with that sign, minus a multiple of the surface's own function, so that it is constant
    /// along the normal.
    function: Local,
}

impl<'s> Sheet<'s> {
    pub(super) fn new(
        subject: &'s Subject<'s>,
        figures: &'s Figures,
        open: &'s OpenSurfaces,
        (place, is_above): (usize, bool),
        (cell, tolerance): (Cell, f64),
        lists: &'s mut Lists,
    ) -> Sheet<'s> {
        Sheet { subject, figures, open, place, is_above, cell, tolerance, lists, boxes: 0 }
    }

    fn surface(&self) -> u32 {
        self.open.indices()[self.place]
    }

    /// Returns whether the solid begins on the surface for these signs of the other surfaces.
    fn is_active(&self, signs: u8) -> bool {
        let bit = 1 << self.place;
        [self.open.inside(signs | bit), self.open.inside(signs & !bit)] == [self.is_above, !self.is_above]
    }

    /// Bounds the distance of the boundary on the surface from the mesh; `None` if this number of boxes is
    /// not sufficient.
    pub(super) fn away(&mut self, boxes: u32) -> Result<Option<f64>, Error> {
        let all = (1u8 << self.open.indices().len()) - 1;
        if (0..=all).all(|signs| !self.is_active(signs)) {
            return Ok(Some(0.0));
        }
        let cube = cube(self.cell);
        let (centre, half) = (cube.centre(), cube.half());
        let Some(local) = Local::new(self.figures, self.surface(), centre, half) else { return Ok(None) };
        let whole = Prism { centre, axes: UNITS, half: [half; 3] };
        let [low, high] = local.within(&whole);
        if low > 0.0 || high < 0.0 {
            return Ok(Some(0.0));
        }
        self.boxes = boxes;
        self.box_of(&whole)
    }

    /// Bounds the part of the surface in a box, by another box that is laid along the surface.
    fn box_of(&mut self, old: &Prism) -> Result<Option<f64>, Error> {
        if self.boxes == 0 {
            return Ok(None);
        }
        self.boxes -= 1;
        let start = old.centre;
        let reach = old.reach().iter().fold(LEAST, |most: f64, &c| most.max(c));
        let centre = match self.figures.onto(&[self.surface()], None, start) {
            Some(point) if length(minus(point, start)) <= 2.0 * reach => point,
            _ => start,
        };
        let (_, gradient) = self.figures.about(self.surface(), centre);
        let steep = length(gradient);
        let normal = gradient.each(|c| c / steep);
        if !normal.iter().all(|c| c.is_finite()) {
            return Ok(None);
        }
        let axes3 = frame(normal, old.axes[0]);
        let mut prism = Prism { centre: start, axes: axes3, half: [0.0; 3] };
        // The intersection of the old box and the cell.
        let cube = cube(self.cell);
        let from_cube = minus(cube.centre(), start);
        for i in 0..3 {
            let size: f64 = axes3[i].iter().map(|c| c.abs() * cube.half()).sum();
            let (old, middle) = (old.along(axes3[i]), dot(from_cube, axes3[i]));
            let low = (-old).max(middle - size) - ROUNDING;
            let high = old.min(middle + size) + ROUNDING;
            if low > high {
                return Ok(Some(0.0));
            }
            prism.half[i] = 0.5 * (high - low);
            prism.centre = axes(|k| prism.centre[k] + 0.5 * (low + high) * axes3[i][k]);
        }
        let outcome = self.look(&mut prism)?;
        let wide = prism.half[0].max(prism.half[1]);
        match outcome {
            Outcome::Within(most) if most <= self.tolerance => Ok(Some(most)),
            outcome => {
                if wide <= 0.125 * self.tolerance {
                    // Only the extent of the box is known.
                    let (most, nearest) = self.subject.away(&around(&prism));
                    if let Some(triangle) = nearest {
                        memory::push(&mut self.lists.used, triangle)?;
                    }
                    return Ok(Some(if let Outcome::Within(known) = outcome {
                        known.min(most)
                    } else {
                        most
                    }));
                }
                let reach = match outcome {
                    Outcome::Cut(direction) if direction != [0.0; 3] => axes(|k| {
                        f64::from(u8::from(k < 2)) * dot(direction, prism.axes[k]).abs() * prism.half[k]
                    }),
                    _ => prism.half,
                };
                let longest =
                    |sizes: [f64; 3]| (0..3).fold(0, |best, k| if sizes[k] > sizes[best] { k } else { best });
                let across = longest(reach);
                let across = if reach[across] < 0.01 * wide { longest(prism.half) } else { across };
                let mut most: f64 = 0.0;
                for sign in [-0.5, 0.5] {
                    let mut part = prism;
                    part.half[across] *= 0.5;
                    part.centre =
                        axes(|k| part.centre[k] + sign * prism.half[across] * prism.axes[across][k]);
                    let Some(own) = self.box_of(&part)? else { return Ok(None) };
                    most = most.max(own);
                }
                Ok(Some(most))
            }
        }
    }

    /// Examines a box, and sets its height to that of the surface in it.
    fn look(&mut self, prism: &mut Prism) -> Result<Outcome, Error> {
        let anywhere = Outcome::Cut([0.0; 3]);
        let normal = prism.axes[2];
        let Some(local) = Local::new(self.figures, self.surface(), prism.centre, farthest(prism)) else {
            return Ok(anywhere);
        };
        let [least, most] = local.within(prism);
        if least > 0.0 || most < 0.0 {
            return Ok(Outcome::Within(0.0));
        }
        // The surface must have one height above each place.
        if local.slopes(normal, prism)[0] <= 0.0 {
            return Ok(anywhere);
        }
        // The surface in the box lies about as high as above the middle.
        let mut low = *prism;
        if View::new(self.figures, self.surface(), &mut low, self.tolerance).is_none() {
            return Ok(anywhere);
        }
        let up = dot(minus(low.centre, prism.centre), normal);
        let (bottom, top) = ((up - low.half[2]).max(-prism.half[2]), (up + low.half[2]).min(prism.half[2]));
        if bottom > top {
            return Ok(Outcome::Within(0.0));
        }
        prism.centre = axes(|k| prism.centre[k] + 0.5 * (bottom + top) * normal[k]);
        prism.half[2] = 0.5 * (top - bottom) + ROUNDING;
        if self.in_cell(prism)?.is_empty() {
            return Ok(Outcome::Within(0.0));
        }
        // The signs of the other surfaces.
        let reach = farthest(prism);
        let Some(local) = Local::new(self.figures, self.surface(), prism.centre, reach) else {
            return Ok(anywhere);
        };
        let (mut signs, mut unknown) = (0u8, 0u8);
        let mut limits: Vec<Limit> = Vec::new();
        for (place, &other) in
            self.open.indices().iter().enumerate().filter(|&(place, _)| place != self.place)
        {
            let Some(function) = Local::new(self.figures, other, prism.centre, reach) else {
                return Ok(anywhere);
            };
            let along = leveled(&function, 1.0, &local, normal);
            let ([low, high], [level_low, level_high]) = (function.within(prism), along.within(prism));
            let bit = 1 << place;
            if low.max(level_low) > 0.0 {
                signs |= bit;
            } else if high.min(level_high) >= 0.0 {
                unknown |= bit;
                memory::push(&mut limits, Limit { surface: other, bit, is_up: true, function: along })?;
            }
        }
        if !subsets(unknown).any(|subset| self.is_active(signs | subset)) {
            return Ok(Outcome::Within(0.0));
        }
        // The surfaces beside which the solid begins, or ends.
        let mut count = 0;
        for k in 0..limits.len() {
            let mut limit = limits[k];
            let changes = |before: bool| {
                subsets(unknown & !limit.bit).any(|subset| {
                    let [without, with] = [0, limit.bit].each(|bit| self.is_active(signs | subset | bit));
                    without == before && with != before
                })
            };
            match (changes(false), changes(true)) {
                (true, true) => return Ok(Outcome::Cut(limit.function.gradient())),
                (false, false) => continue,
                (true, false) => {}
                (false, true) => {
                    limit.is_up = false;
                    limit.function = limit.function.combined(-1.0, 0.0, &limit.function);
                }
            }
            limits[count] = limit;
            count += 1;
        }
        limits.truncate(count);
        self.cover(prism, signs, &limits)
    }

    /// Tests whether the triangles of the surface cover it in a box, up to the parts that the limits exclude.
    fn cover(&mut self, prism: &Prism, signs: u8, limits: &[Limit]) -> Result<Outcome, Error> {
        let normal = prism.axes[2];
        let cut = Outcome::Cut(limits.first().map_or([0.0; 3], |limit| limit.function.gradient()));
        // The direction along which all limits increase, and the length to go along it.
        let mut up = [0.0; 3];
        for limit in limits {
            let flat = level(limit.function.gradient(), normal);
            let size = length(flat);
            up = axes(|k| up[k] + flat[k] / size);
        }
        let mut ahead = 0.0;
        if !limits.is_empty() {
            let size = length(up);
            if size.is_nan() || size < 0.1 {
                return Ok(cut);
            }
            up = up.each(|c| c / size);
            let wide: f64 = (0..2).map(|k| prism.half[k] * dot(prism.axes[k], up).abs()).sum();
            ahead = 2.2 * wide + 4.0 * self.tolerance;
        }
        let mut long = *prism;
        long.centre = axes(|k| prism.centre[k] + 0.5 * ahead * up[k]);
        for k in 0..2 {
            long.half[k] += 0.5 * ahead * dot(up, prism.axes[k]).abs();
        }
        let Some(mut view) = View::new(self.figures, self.surface(), &mut long, self.tolerance) else {
            return Ok(cut);
        };
        let tall = Prism { half: [long.half[0], long.half[1], view.high], ..long };
        let mut kept = memory::with_capacity(limits.len())?;
        for limit in limits {
            let Some(function) = Local::new(self.figures, limit.surface, long.centre, view.reach) else {
                return Ok(cut);
            };
            let sign = if limit.is_up { 1.0 } else { -1.0 };
            let function = leveled(&function, sign, &view.local, normal);
            let askew = magnitude(function.slopes(normal, &tall)) / view.slope;
            let slope = function.slopes(up, &tall)[0] - askew * magnitude(view.local.slopes(up, &tall));
            if slope.is_nan() || slope <= 0.0 {
                return Ok(Outcome::Cut(up));
            }
            kept.push(Kept { limit: Limit { function, ..*limit }, slope, askew });
        }
        let own = [dot(up, prism.axes[0]), dot(up, prism.axes[1])];
        // The place that the lines reach: the box, moved.
        let moved = axes(|k| prism.centre[k] + ahead * up[k]);
        let (first, last) = (view.flat(prism.centre, &long), view.flat(moved, &long));
        let half = |prism: &Prism| [prism.half[0], prism.half[1]];
        view.boxes = [[[0.0; 2], half(&long)], [first, half(prism)], [last, half(prism)]];
        if limits.is_empty() {
            // A place in the cell.
            let part = self.in_cell(&long)?;
            if part.is_empty() {
                return Ok(Outcome::Within(0.0));
            }
            let share = 1.0 / part.len() as f64;
            view.covered = view.flat(axes(|k| part.iter().map(|p| p[k] * share).sum()), &long);
        } else {
            view.covered = last;
        }
        self.see(&view, &long, own, &kept, signs)
    }

    /// Projects the triangles along the normal, and bounds the distance of the surface from them.
    fn see(
        &mut self,
        view: &View,
        long: &Prism,
        up: [f64; 2],
        kept: &[Kept],
        signs: u8,
    ) -> Result<Outcome, Error> {
        let near = around(long).grown(2.0 * self.tolerance);
        self.subject.meeting(&near, self.surface(), &mut self.lists.found)?;
        let mut seen = core::mem::take(&mut self.lists.seen);
        seen.clear();
        seen.try_reserve(self.lists.found.len())?;
        seen.extend(self.lists.found.iter().map(|&number| {
            let places = self.subject.corners(number).each(|p| long.place(p));
            Seen { number, places, area: self.area(&places) }
        }));
        let direction = axes(|k| long.axes[0][k] * up[0] + long.axes[1][k] * up[1]);
        let high = self.above(view, long, &seen)?;
        let most = match high {
            Some(_) => self.beside(view, long, up, (kept, signs), &seen)?,
            None => None,
        };
        self.lists.seen = seen;
        let (Some(high), Some(most)) = (high, most) else { return Ok(Outcome::Cut(direction)) };
        let Lists { found, used, .. } = &mut *self.lists;
        used.try_reserve(found.len())?;
        used.extend(&*found);
        Ok(Outcome::Within(high.max(most) + ROUNDING))
    }

    /// The area of a triangle seen along the normal. It is positive if the triangle faces in the same
    /// direction as the boundary there, and 0 if the triangle is so small that it covers nothing.
    fn area(&self, places: &[[f64; 3]; 3]) -> f64 {
        let flat = places.each(|[u, v, _]| [u, v]);
        let area = turn(flat[0], flat[1], flat[2]);
        let size = length(minus(places[1], places[0])).max(length(minus(places[2], places[0])));
        match area.abs() > ROUNDING * size * size {
            true if self.is_above => -area,
            true => area,
            false => 0.0,
        }
    }

    /// Bounds the distance of the surface above the box from the triangles; `None` if the triangles do not
    /// cover the place to which lines lead.
    fn above(&mut self, view: &View, long: &Prism, seen: &[Seen]) -> Result<Option<f64>, Error> {
        let [whole, first, _] = view.boxes;
        let (mut most, mut is_covered) = (0.0f64, false);
        let Lists { part, cut, .. } = &mut *self.lists;
        for Seen { places, area, .. } in seen {
            if *area < 0.0 {
                continue;
            }
            part.clear();
            part.try_reserve(3)?;
            part.extend(places);
            clip(part, cut, corner(whole, -1.0), corner(whole, 1.0))?;
            if part.len() < 3 {
                continue;
            }
            // A triangle far above does not belong to this sheet.
            if part.iter().any(|place| place[2].abs() > view.high) {
                return Ok(None);
            }
            is_covered |= *area > 0.0 && holds(places.each(|[u, v, _]| [u, v]), view.covered);
            clip(part, cut, corner(first, -1.0), corner(first, 1.0))?;
            if part.len() >= 3 {
                let Some(high) = view.height_over(long, part, cut)? else { return Ok(None) };
                most = most.max(high);
            }
        }
        Ok(is_covered.then_some(most))
    }

    /// Bounds how far the surface goes on beside the sides at which its triangles end; `None` if lines may
    /// leave the triangles there, or nothing is known. `up` is the direction of lines.
    fn beside(
        &mut self,
        view: &View,
        long: &Prism,
        up: [f64; 2],
        (kept, signs): (&[Kept], u8),
        seen: &[Seen],
    ) -> Result<Option<f64>, Error> {
        let [whole, _, last] = view.boxes;
        let (subject, surface) = (self.subject, self.surface());
        let mut most = 0.0f64;
        for Seen { number, places, area } in seen {
            if *area < 0.0 {
                continue;
            }
            for (k, &mate) in subject.mates[*number as usize].iter().enumerate() {
                let ends = [places[k], places[(k + 1) % 3]];
                let Some(side) = within(ends, whole) else { continue };
                let is_same = match seen.binary_search_by_key(&mate, |seen| seen.number) {
                    Ok(place) if seen[place].area >= 0.0 => continue,
                    Ok(_) => false,
                    Err(_) => {
                        subject.surfaces[mate as usize] == surface
                            && self.area(&subject.corners(mate).each(|p| long.place(p))) >= 0.0
                    }
                };
                // Without limits, the part outside the cell does not matter: the part inside is convex, and
                // is covered at one place.
                if kept.is_empty() && !self.is_in_cell(long, &side)? {
                    continue;
                }
                if is_same || within(ends, last).is_some() {
                    return Ok(None);
                }
                let way = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
                // A line comes from the side where the triangle is not. Triangles may face up or down.
                let enters = (way[0] * up[1] - way[1] * up[0]) * if self.is_above { -1.0 } else { 1.0 };
                if enters <= ROUNDING * way[0].hypot(way[1]) {
                    return Ok(None);
                }
                let Some(high) = view.height_over(long, &side, &mut self.lists.cut)? else { return Ok(None) };
                let ahead = self.ahead(view, long, &side, high, kept, signs);
                most = most.max(ahead.hypot(high + view.steep * ahead));
            }
        }
        Ok(Some(most))
    }

    /// The convex polygon in the plane through the middle of a box above or below which points of the box may
    /// lie in the cell.
    fn in_cell(&mut self, prism: &Prism) -> Result<&[[f64; 3]], Error> {
        let corner = |u: f64, v: f64| prism.point([u * prism.half[0], v * prism.half[1], 0.0]);
        self.clip_to_cell(
            &[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
            prism,
        )
    }

    fn clip_to_cell(&mut self, polygon: &[[f64; 3]], prism: &Prism) -> Result<&[[f64; 3]], Error> {
        let cube = cube(self.cell).grown(prism.half[2] + ROUNDING);
        let Lists { part, cut, .. } = &mut *self.lists;
        part.clear();
        part.try_reserve(polygon.len())?;
        part.extend(polygon);
        clip(part, cut, cube.low, cube.high)?;
        Ok(part)
    }

    /// Returns whether points of a box above or below a side may lie in the cell.
    fn is_in_cell(&mut self, long: &Prism, side: &[[f64; 3]; 2]) -> Result<bool, Error> {
        let side = side.each(|[u, v, _]| long.point([u, v, 0.0]));
        Ok(!self.clip_to_cell(&side, long)?.is_empty())
    }

    /// Bounds how far before a side the boundary may begin, from the values of the limits on that side.
    fn ahead(
        &self,
        view: &View,
        long: &Prism,
        side: &[[f64; 3]; 2],
        high: f64,
        kept: &[Kept],
        signs: u8,
    ) -> f64 {
        let ends = side.each(|place| long.point(place));
        let reach = |kept: &Kept| {
            let [_, most] = kept.limit.function.over(&ends);
            (most + kept.limit.function.error() + high * kept.askew * view.slope) / kept.slope
        };
        // (The function of a limit has an error in two places.)
        let mut best = f64::INFINITY;
        for ahead in kept.iter().map(reach).map(|far| far.max(0.0)).chain([0.0]) {
            let mut own = signs;
            for kept in kept {
                let is_on = reach(kept) > ahead;
                if is_on == kept.limit.is_up {
                    own |= kept.limit.bit;
                }
            }
            if !self.is_active(own) {
                best = best.min(ahead);
            }
        }
        best
    }
}

/// The directions x, y and z.
pub(super) const UNITS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A limit along the direction of lines.
struct Kept {
    limit: Limit,
    /// Its least increase along the surface.
    slope: f64,
    /// Its greatest change along the normal, relative to the change of the surface's own function.
    askew: f64,
}

/// A box as seen along the normal of the surface.
struct View {
    local: Local,
    /// The least slope of the surface's function along the normal.
    slope: f64,
    /// The greatest slope of the surface over the plane.
    steep: f64,
    /// Rectangles in the plane, as centres and half edges: the whole, the box itself, and the place to which
    /// lines lead from the box.
    boxes: [[[f64; 2]; 2]; 3],
    /// A place that triangles must cover.
    covered: [f64; 2],
    /// The distance from the plane up to which the slopes hold.
    high: f64,
    reach: f64,
}

impl View {
    /// Moves the box to the surface, and sets its height to that of the surface there.
    fn new(figures: &Figures, surface: u32, prism: &mut Prism, tolerance: f64) -> Option<View> {
        let normal = prism.axes[2];
        prism.half[2] = prism.half[2].min(prism.half[0].max(prism.half[1]));
        let reach = 1.25 * farthest(prism) + 2.0 * tolerance;
        let (value, gradient) = figures.about(surface, prism.centre);
        let up = value / dot(gradient, normal);
        if !up.is_finite() || up.abs() > reach {
            return None;
        }
        prism.centre = axes(|k| prism.centre[k] - up * normal[k]);
        let local = Local::new(figures, surface, prism.centre, reach)?;
        prism.half[2] = height(&local, prism)?;
        // Triangles may lie above or below the range of the surface.
        let mut tall = *prism;
        tall.half[2] = tall.half[2].max(2.0 * tolerance);
        let slope = local.slopes(normal, &tall)[0];
        let sideways = [0, 1].each(|k| magnitude(local.slopes(prism.axes[k], &tall)));
        let steep = sideways[0].hypot(sideways[1]) / slope;
        (slope > 0.0 && prism.half[2] <= reach).then_some(View {
            local,
            slope,
            steep,
            boxes: [[[0.0; 2]; 2]; 3],
            covered: [0.0; 2],
            high: tall.half[2],
            reach,
        })
    }

    fn flat(&self, point: [f64; 3], prism: &Prism) -> [f64; 2] {
        let [u, v, _] = prism.place(point);
        [u, v]
    }

    /// Bounds the distance of the surface from a polygon along the normal; `None` if it is not known.
    /// `points` is a buffer.
    fn height_over(
        &self,
        prism: &Prism,
        places: &[[f64; 3]],
        points: &mut Vec<[f64; 3]>,
    ) -> Result<Option<f64>, Error> {
        points.clear();
        points.try_reserve(places.len())?;
        points.extend(places.iter().map(|&place| prism.point(place)));
        if !points.iter().all(|&p| length(minus(p, prism.centre)) <= self.reach) {
            return Ok(None);
        }
        let high = magnitude(self.local.over(points)) / self.slope;
        // (The line from the polygon to the surface must lie where the slope is known.)
        let reaches = |place: &[f64; 3]| place[2].abs() <= self.high;
        Ok(places.iter().all(reaches).then_some(high))
    }
}

/// The greatest height of a surface above and below the plane through the centre of a box; `None` if it is
/// not known.
fn height(local: &Local, prism: &Prism) -> Option<f64> {
    let normal = prism.axes[2];
    let corner = |u: f64, v: f64| prism.point([u * prism.half[0], v * prism.half[1], 0.0]);
    let plane = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let most = magnitude(local.over(&plane));
    // Twice the apparent height must suffice.
    let mut tall = *prism;
    tall.half[2] = 2.0 * most / dot(local.gradient(), normal).abs();
    let high = most / local.slopes(normal, &tall)[0];
    (0.0 <= high && high <= tall.half[2]).then_some(high)
}

/// A function times a sign, minus a multiple of another one, so that the result is constant along a
/// direction.
fn leveled(function: &Local, sign: f64, other: &Local, normal: [f64; 3]) -> Local {
    let factor = sign * dot(function.gradient(), normal) / dot(other.gradient(), normal);
    function.combined(sign, factor, other)
}

/// The part of a vector across a unit direction.
fn level(vector: [f64; 3], normal: [f64; 3]) -> [f64; 3] {
    let along = dot(vector, normal);
    axes(|k| vector[k] - along * normal[k])
}

/// All subsets of the bits of a mask.
fn subsets(mask: u8) -> impl Iterator<Item = u8> {
    let mut next = Some(mask);
    core::iter::from_fn(move || {
        let own = next?;
        next = (own != 0).then(|| (own - 1) & mask);
        Some(own)
    })
}

/// Half the edge of the axis-aligned cube around a box.
fn farthest(prism: &Prism) -> f64 {
    prism.reach().iter().fold(LEAST, |most: f64, &c| most.max(c))
}

/// The axis-aligned box around a box.
fn around(prism: &Prism) -> Around {
    let reach = prism.reach();
    Around { low: axes(|k| prism.centre[k] - reach[k]), high: axes(|k| prism.centre[k] + reach[k]) }
}

/// Three directions at right angles: the last one is given, and the first is near another given one.
fn frame(normal: [f64; 3], about: [f64; 3]) -> [[f64; 3]; 3] {
    let least = (0..3).fold(0, |best, k| if normal[k].abs() < normal[best].abs() { k } else { best });
    let mut first = level(about, normal);
    if length(first) < 0.5 {
        first = level(UNITS[least], normal);
    }
    let size = length(first);
    let first = first.each(|c| c / size);
    let second =
        axes(|k| normal[(k + 1) % 3] * first[(k + 2) % 3] - normal[(k + 2) % 3] * first[(k + 1) % 3]);
    [first, second, normal]
}

fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Returns whether a triangle of either orientation contains a point.
fn holds([a, b, c]: [[f64; 2]; 3], point: [f64; 2]) -> bool {
    let turns = [turn(a, b, point), turn(b, c, point), turn(c, a, point)];
    turns.iter().all(|&turn| turn >= 0.0) || turns.iter().all(|&turn| turn <= 0.0)
}

/// A corner of a rectangle, with an unbounded height.
fn corner([centre, half]: [[f64; 2]; 2], sign: f64) -> [f64; 3] {
    let [u, v] = [0, 1].each(|k| centre[k] + sign * (half[k] + ROUNDING));
    [u, v, sign * f64::MAX]
}

/// The part of a side above a rectangle; `None` if there is none.
fn within(ends: [[f64; 3]; 2], [centre, half]: [[f64; 2]; 2]) -> Option<[[f64; 3]; 2]> {
    let way: [f64; 3] = axes(|k| ends[1][k] - ends[0][k]);
    let (mut first, mut last) = (0.0f64, 1.0f64);
    for k in 0..2 {
        let wide = half[k] + ROUNDING;
        let away = ends[0][k] - centre[k];
        if way[k] == 0.0 {
            if away.abs() > wide {
                return None;
            }
            continue;
        }
        let (a, b) = ((-wide - away) / way[k], (wide - away) / way[k]);
        first = first.max(a.min(b));
        last = last.min(a.max(b));
    }
    (first <= last).then(|| [first, last].each(|t| axes(|k| ends[0][k] + t * way[k])))
}
