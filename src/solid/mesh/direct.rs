//! Rays, points and distances, answered for the whole mesh without a descent through cells.
//!
//! The winding number is zero at infinity. So the winding number of a point of a half-line follows from the
//! triangles ahead of the point. The triangles that a half-line passes through (`mesh/pierce`) give the
//! winding numbers all along it. The boundary is where the fill rule's answer changes: facets inside
//! overlapping bodies are no boundary. Between triangles that are passed within each other's rounding, the
//! order is not decided.
//!
//! Off the surface, the winding numbers of the shifted half-line are those of the half-line itself. Where the
//! half-line only touches the surface, its points belong to the solid if points on any side do; so it is
//! shifted into all octants. Where all shifted half-lines run outside, next to a sharp corner, there is no
//! answer.
//!
//! For a point of an open mesh, the triangles on the way to infinity count the winding number of the surface
//! closed by cones: cones over the rim of its holes, with their apex at the other end of that way. The cones'
//! own winding number is then subtracted (`rim`). An open mesh also bounds the solid away from its triangles,
//! where its winding number is one half. A ball or box without triangles holds none of that boundary if the
//! winding number cannot change by enough in it. (Rays of open meshes: `open_trace`.)

use super::rim::{Course, DIRECTIONS, Fraction, Rim};
use super::rim_line::RimLine;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Bounds, Interval, Ray, axes, valid};
use crate::memory;
use crate::mesh::{FillRule, Hit, Loops, NearestPoint, Shift, Sides, TriangleMesh, TriangleTree, Wanted};
use crate::solid::{BoxContent, NearestSurface, RayCrossing, RayQuestion, RayTrace};
use alloc::vec::Vec;
use glam::DVec3;

/// Directions along which no edges between points of a lattice lie: square roots of 3, 5, 7 and 11.
const WAYS: [[f64; 3]; 4] = [
    [1.0, 1.732_050_807_568_877, 2.236_067_977_499_79],
    [-2.236_067_977_499_79, 1.0, -1.732_050_807_568_877],
    [1.732_050_807_568_877, -2.645_751_311_064_591, 1.0],
    [-1.0, -3.316_624_790_355_4, 2.236_067_977_499_79],
];

/// Lists that are kept from query to query.
#[derive(Default)]
pub(super) struct Direct {
    /// The triangles that the ray passes through.
    pub(super) hits: Vec<Hit>,
    /// The triangles that the ray touches.
    pub(super) touched: Vec<Hit>,
    /// The rim of an open mesh as a ray sees it.
    pub(super) line: RimLine,
}

impl Direct {
    /// Moves the triangles that are only touched from the hits to their own list, and sorts both by time.
    pub(super) fn arrange(&mut self) -> Result<(), Error> {
        let Direct { hits, touched, .. } = self;
        touched.clear();
        for hit in hits.iter().filter(|hit| hit.step == 0) {
            memory::push(touched, *hit)?;
        }
        hits.retain(|hit| hit.step != 0);
        for list in [hits, touched] {
            list.sort_unstable_by(|a, b| {
                let by_time = a.t.lower.total_cmp(&b.t.lower).then(a.t.upper.total_cmp(&b.t.upper));
                by_time.then(a.triangle.cmp(&b.triangle))
            });
        }
        Ok(())
    }
}

/// Returns how many hits have the same time as the first one, up to rounding, and the time at which they end.
/// `hits` is sorted.
pub(super) fn together(hits: &[Hit]) -> (usize, f64) {
    let mut until = hits.first().map_or(0.0, |hit| hit.t.upper);
    let met = hits.iter().take_while(|hit| {
        let meets = hit.t.lower <= until;
        until = if meets { until.max(hit.t.upper) } else { until };
        meets
    });
    (met.count(), until)
}

/// A mesh with the tree of its triangles.
#[derive(Clone, Copy)]
pub(super) struct Tracer<'m> {
    pub(super) tree: TriangleTree<'m>,
    pub(super) fill: FillRule,
    /// The rim, if the mesh is open.
    pub(super) rim: Option<&'m Rim>,
}

/// Returns the rim of an open mesh in model units; a displacement counts as the error of its vertices.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(super) fn rim(mesh: &TriangleMesh, loops: &Loops) -> Result<Rim, Error> {
    let mut rim = Rim::default();
    rim.vertex_error = mesh.displacement();
    let at = |vertex: u32| DVec3::from(mesh.vertices()[vertex as usize]);
    for walk in loops.iter() {
        let first = rim.edges().len();
        let next = walk.iter().skip(1).chain(walk.first());
        walk.iter().zip(next).try_for_each(|(&from, &to)| rim.push([at(to), at(from)]))?;
        rim.close(first)?;
    }
    Ok(rim)
}

impl Tracer<'_> {
    /// Finds where a ray enters and leaves the solid. The trace stays unknown if the surface may deviate from
    /// the mesh and the ray comes near to an edge.
    pub(super) fn trace(&self, direct: &mut Direct, question: RayQuestion<'_>) -> Result<(), Error> {
        let RayQuestion { ray, is_first_enough, trace } = question;
        trace.clear();
        let [first, others @ ..] = Shift::ALL;
        // From outside, the first triangle leads into the solid, unless it leads to a negative winding number
        // that the fill rule does not count.
        if is_first_enough && self.fill != FillRule::Positive && self.tree.way_out(&ray.from).is_none() {
            let is_sure = self.tree.pierced(ray, Wanted::First, first, &mut direct.hits)?;
            if !is_sure || self.follow(direct, true, trace)? && !trace.has_touches() {
                return Ok(());
            }
            trace.clear();
        }
        if !self.tree.pierced(ray, Wanted::All, first, &mut direct.hits)? {
            return Ok(());
        }
        self.follow(direct, false, trace)?;
        for shift in others {
            if !trace.has_touches() {
                break;
            }
            self.tree.pierced(ray, Wanted::All, shift, &mut direct.hits)?;
            let mut other = RayTrace::UNKNOWN;
            self.follow(direct, false, &mut other)?;
            *trace = trace.united(&other)?;
        }
        Ok(())
    }

    /// Follows the winding number along the hits: along all of them, or up to the first hit of a ray from
    /// outside. Returns `false` if the trace must continue behind these hits.
    fn follow(
        &self,
        direct: &mut Direct,
        is_first_enough: bool,
        trace: &mut RayTrace,
    ) -> Result<bool, Error> {
        direct.arrange()?;
        let Direct { hits, touched, .. } = direct;
        let steps = |hits: &[Hit]| hits.iter().map(|hit| hit.step).sum::<i32>();
        let mut winding = if is_first_enough { 0 } else { -steps(hits) };
        trace.begins_inside = self.fill.encloses(winding);
        // (A ray that begins on the surface touches it at 0.)
        let (mut from, mut rest) = (-1.0, &hits[..]);
        let mut touched = Touched { hits: touched, tree: &self.tree };
        while let Some(first) = rest.first() {
            let (count, until) = together(rest);
            let (together, behind) = rest.split_at(count);
            rest = behind;
            // Whatever the order of the hits, the winding number stays in this range.
            let falls = together.iter().map(|hit| hit.step.min(0)).sum::<i32>();
            let rises = together.iter().map(|hit| hit.step.max(0)).sum::<i32>();
            let before = self.fill.encloses(winding);
            let first_winding = winding;
            let changes = (winding + falls..=winding + rises).any(|w| self.fill.encloses(w) != before);
            let first_changed = self.crossed(together, winding);
            winding += steps(together);
            if !changes {
                continue;
            }
            let t = touched.joined(Interval::between(first.t.lower, until));
            if !before {
                touched.note(from, t.lower, trace)?;
            }
            let is_inside_after = self.fill.encloses(winding);
            let normal = self.tree.normal(first_changed.triangle);
            // A ray that leaves the solid through the back of a triangle leaves along the triangle's normal.
            let is_along = first_changed.step < 0;
            let normal = if is_along == before { normal } else { normal.each(|n| -n) };
            let is_met = before || is_inside_after || self.passes_within(together, first_winding);
            let surface = Some(first_changed.triangle);
            trace.push(RayCrossing { t, is_inside_after, is_met, normal, surface })?;
            from = t.upper;
            if is_first_enough && is_inside_after {
                trace.until = from;
                return Ok(true);
            }
        }
        if is_first_enough && !hits.is_empty() {
            return Ok(false);
        }
        if !self.fill.encloses(winding) {
            touched.note(from, f64::INFINITY, trace)?;
        }
        trace.until = f64::INFINITY;
        Ok(true)
    }

    /// Returns the first triangle at which the fill rule's answer changes, if the triangles are passed in
    /// list order.
    pub(super) fn crossed(&self, together: &[Hit], mut winding: i32) -> Hit {
        let before = self.fill.encloses(winding);
        let found = together.iter().find(|hit| {
            winding += hit.step;
            self.fill.encloses(winding) != before
        });
        *found.unwrap_or(&together[0])
    }

    /// Returns whether a ray is inside somewhere between triangles, in whatever order it passes them: true if
    /// each possible first step leads inside. Triangles in one plane are one step, which cancels where facets
    /// lie back to back.
    fn passes_within(&self, together: &[Hit], winding: i32) -> bool {
        // With a displacement, it is unknown which triangles lie in one plane.
        if self.tree.displacement() > 0.0 {
            return false;
        }
        together.iter().all(|first| {
            let plane = together.iter().filter(|hit| self.tree.are_coplanar(first.triangle, hit.triangle));
            self.fill.encloses(winding + plane.map(|hit| hit.step).sum::<i32>())
        })
    }

    /// Returns whether the solid contains a point. `None` if the point lies on the surface of the mesh, or
    /// nearer to it than the surface is known.
    #[inline]
    pub(super) fn is_inside(&self, direct: &mut Direct, point: &[f64; 3]) -> Result<Option<bool>, Error> {
        match self.rim {
            None => self.is_inside_closed(direct, point),
            Some(rim) => self.is_inside_open(direct, rim, point),
        }
    }

    fn is_inside_closed(&self, direct: &mut Direct, point: &[f64; 3]) -> Result<Option<bool>, Error> {
        if !point.iter().all(|c| c.is_finite()) {
            return Ok(None);
        }
        let Some((axis, sign)) = self.tree.way_out(point) else { return Ok(Some(self.fill.encloses(0))) };
        if !point.iter().all(|&c| valid::is_moderate(c)) {
            // Replace tiny coordinates by zero, if no surface lies between.
            let at = point.each(|c| if valid::is_moderate(c) { c } else { 0.0 });
            let apart = 1e-76 + 2.0 * self.tree.displacement();
            let near = self.tree.nearest_of(&at, |_| true);
            let is_apart = near.is_some_and(|(_, distance)| distance.lower > apart);
            return if is_apart { self.is_inside_closed(direct, &at) } else { Ok(None) };
        }
        let shortest = Ray::along_axis(*point, axis, sign);
        let found = self.is_inside_by(direct, &shortest)?;
        if found.is_some() || self.tree.displacement() == 0.0 {
            return Ok(found);
        }
        // With a displacement, a ray that comes near to an edge decides nothing. Another direction may pass
        // no edge.
        for way in WAYS {
            let ray = Ray { from: *point, direction: way.each(|c| [c, 0.0]), last: f64::INFINITY };
            let found = self.is_inside_by(direct, &ray)?;
            if found.is_some() {
                return Ok(found);
            }
        }
        Ok(None)
    }

    /// Returns whether the solid contains the point at which a ray begins. `None` if the point may lie on the
    /// surface, or the ray decides nothing.
    fn is_inside_by(&self, direct: &mut Direct, ray: &Ray) -> Result<Option<bool>, Error> {
        let hits = &mut direct.hits;
        if !self.tree.pierced(ray, Wanted::All, Shift::ALL[0], hits)?
            || hits.iter().any(|hit| hit.t.lower <= 0.0)
        {
            return Ok(None);
        }
        Ok(Some(self.fill.encloses(-hits.iter().map(|hit| hit.step).sum::<i32>())))
    }

    /// Classifies a box. `None` if triangles meet the box and no points on different sides of the boundary
    /// are found in it.
    pub(super) fn content_of(
        &self,
        direct: &mut Direct,
        bounds: &Bounds,
    ) -> Result<Option<BoxContent>, Error> {
        /// The most triangles beside which points are tried.
        const MOST: usize = 8;
        let (mut met, mut count) = ([0; MOST], 0);
        self.tree.in_box(bounds, &mut |triangle| {
            if let Some(place) = met.get_mut(count) {
                *place = triangle;
            }
            count += 1;
        });
        let Bounds { min, max } = bounds;
        let centre = axes(|axis| 0.5 * min[axis] + 0.5 * max[axis]);
        if count == 0
            && let Some(rim) = self.rim
            && let Some(is_inside) = self.side_of_box(direct, rim, bounds, &mut 32)?
        {
            return Ok(Some(if is_inside { BoxContent::Full } else { BoxContent::Empty }));
        }
        let mut found = [false; 2];
        let mut look_at = |direct: &mut Direct, point: &[f64; 3]| -> Result<bool, Error> {
            if let Some(inside) = self.is_inside(direct, point)? {
                found[usize::from(inside)] = true;
            }
            Ok(found == [true; 2])
        };
        if look_at(direct, &centre)? {
            return Ok(Some(BoxContent::Both));
        }
        if count > 0 || self.rim.is_some() {
            // If a corner lies on no triangle, the box next to it is on the corner's side.
            for k in 0..8 {
                let corner = axes(|axis| if k >> axis & 1 != 0 { max[axis] } else { min[axis] });
                if look_at(direct, &corner)? {
                    return Ok(Some(BoxContent::Both));
                }
            }
            for &triangle in &met[..count.min(MOST)] {
                // Points of the box on both sides of the triangle, beside the triangle's point that is
                // nearest to the centre.
                let near = self.tree.nearest_to(triangle, &centre);
                let normal = self.tree.normal(triangle);
                let size = normal.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
                let room = (0..3)
                    .map(|axis| (near[axis] - min[axis]).min(max[axis] - near[axis]))
                    .fold(f64::INFINITY, f64::min);
                for sign in [1.0, -1.0] {
                    let beside = axes(|axis| near[axis] + sign * (room / 1024.0) * (normal[axis] / size));
                    let is_within = (0..3).all(|axis| min[axis] < beside[axis] && beside[axis] < max[axis]);
                    if is_within && look_at(direct, &beside)? {
                        return Ok(Some(BoxContent::Both));
                    }
                }
            }
            return Ok(None);
        }
        Ok(match found {
            [true, false] => Some(BoxContent::Empty),
            [false, true] => Some(BoxContent::Full),
            _ => None,
        })
    }

    /// Returns whether the solid of an open mesh contains a point. `None` where the winding number may be one
    /// half, or jumps.
    fn is_inside_open(
        &self,
        direct: &mut Direct,
        rim: &Rim,
        point: &[f64; 3],
    ) -> Result<Option<bool>, Error> {
        let (mut at, mut radius) = (*point, 0.0);
        if point.iter().any(|c| c.abs() < valid::SMALLEST && *c != 0.0) {
            // Replace tiny coordinates by zero, if no surface lies between.
            at = point.each(|c| if c.abs() < valid::SMALLEST { 0.0 } else { c });
            radius = 1e-76;
            let apart = radius + 2.0 * self.tree.displacement();
            let near = self.tree.nearest_of(&at, |_| true);
            let is_apart = near.is_some_and(|(_, distance)| distance.lower > apart);
            if !is_apart {
                return Ok(None);
            }
        }
        Ok(self.winding(direct, rim, (&at, radius))?.and_then(|winding| self.encloses_around(winding)))
    }

    /// Returns whether the fill rule encloses the points of a winding number. `None` if the number's error
    /// leaves both possible.
    fn encloses_around(&self, winding: Fraction) -> Option<bool> {
        let wide = winding.error + 1e-12;
        self.fill.encloses_all(winding.value - wide, winding.value + wide)
    }

    /// Returns the winding number of an open mesh at a point, valid all over a ball around the point in which
    /// no triangles lie. `None` where the number jumps. Near an integer, the error may be nearly one half.
    fn winding(
        &self,
        direct: &mut Direct,
        rim: &Rim,
        (point, radius): (&[f64; 3], f64),
    ) -> Result<Option<Fraction>, Error> {
        if !point.iter().all(|&c| valid::is_moderate(c)) {
            return Ok(None);
        }
        let at = DVec3::from(*point);
        for towards in DIRECTIONS {
            // The way leads away from the cones' apex: no cones lie there.
            let away = (-towards).to_array().each(|c| [c, 0.0]);
            let ray = Ray { from: *point, direction: away, last: f64::INFINITY };
            let hits = &mut direct.hits;
            let is_sure = self.tree.pierced(&ray, Wanted::All, Shift::ALL[0], hits)?;
            if !is_sure || hits.iter().any(|hit| hit.t.lower <= 0.0) {
                return Ok(None);
            }
            let whole = -f64::from(hits.iter().map(|hit| hit.step).sum::<i32>());
            let most = rim.most_along(&Course::new(at, -towards, false)).max(rim.most_within(*point, radius));
            if most < 0.49 {
                return Ok(Some(Fraction { value: whole, error: most }));
            }
            let Some(cones) = rim.of_cones(at, towards) else { continue };
            let change = if radius > 0.0 { rim.change_within(*point, radius) } else { 0.0 };
            return Ok(Some(Fraction { value: whole - cones.value, error: cones.error + change }));
        }
        Ok(None)
    }

    /// Returns on which side a box without triangles lies, from the winding numbers of its middle and of its
    /// parts.
    fn side_of_box(
        &self,
        direct: &mut Direct,
        rim: &Rim,
        bounds: &Bounds,
        parts: &mut usize,
    ) -> Result<Option<bool>, Error> {
        let Bounds { min, max } = *bounds;
        let centre = axes(|axis| 0.5 * min[axis] + 0.5 * max[axis]);
        let half = axes(|axis| (max[axis] - centre[axis]).max(centre[axis] - min[axis]));
        let radius = (1.0 + 1e-12) * sqrt(half.iter().map(|c| c * c).sum());
        let Some(winding) = self.winding(direct, rim, (&centre, radius))? else { return Ok(None) };
        let side = self.encloses_around(winding);
        if side.is_some() || *parts == 0 {
            return Ok(side);
        }
        *parts -= 1;
        let axis = (0..3).fold(0, |most, axis| if half[axis] > half[most] { axis } else { most });
        let (mut lower, mut upper) = (*bounds, *bounds);
        (lower.max[axis], upper.min[axis]) = (centre[axis], centre[axis]);
        let Some(side) = self.side_of_box(direct, rim, &lower, parts)? else { return Ok(None) };
        Ok(self.side_of_box(direct, rim, &upper, parts)?.filter(|&other| other == side))
    }

    /// Returns on which side the part of a triangle-free ball in a cube lies. The cube is given by its middle
    /// and half its edge.
    fn side_of_ball(
        &self,
        direct: &mut Direct,
        rim: &Rim,
        (centre, radius): (&[f64; 3], f64),
        (middle, half): ([f64; 3], f64),
        parts: &mut usize,
    ) -> Result<Option<bool>, Error> {
        // `place` is the ball's point that is nearest to the cube's middle. No point of the ball in the cube
        // is further from `place` than from the middle, and the segment from `place` to it lies in the ball.
        let away = DVec3::from(middle) - DVec3::from(*centre);
        let distance = sqrt(away.length_squared());
        let wide = half * sqrt(3.0) * (1.0 + 1e-9);
        let is_whole = distance == 0.0;
        let place = if distance <= radius { away } else { away * (radius / distance) };
        let place = (DVec3::from(*centre) + place * (1.0 - 1e-9)).to_array();
        let reach = if is_whole { radius } else { wide + 1e-8 * radius };
        let Some(winding) = self.winding(direct, rim, (&place, reach))? else { return Ok(None) };
        let side = self.encloses_around(winding);
        if side.is_some() || *parts == 0 {
            return Ok(side);
        }
        *parts -= 1;
        let mut all = None;
        for k in 0..8 {
            let part = axes(|axis| middle[axis] + if k >> axis & 1 != 0 { 0.5 * half } else { -0.5 * half });
            let apart = (0..3).map(|axis| ((part[axis] - centre[axis]).abs() - 0.5 * half).max(0.0));
            let is_beyond = sqrt(apart.map(|c| c * c).sum()) > radius * (1.0 + 1e-9);
            if is_beyond {
                continue;
            }
            let Some(side) = self.side_of_ball(direct, rim, (centre, radius), (part, 0.5 * half), parts)?
            else {
                return Ok(None);
            };
            if *all.get_or_insert(side) != side {
                return Ok(None);
            }
        }
        Ok(all)
    }

    /// Returns the nearest point of the boundary of an open mesh: the nearest point of its triangles, if the
    /// winding number is nowhere one half in the ball that the triangles leave free. `None` if this is not
    /// proven, or if the nearest triangle may be no boundary.
    pub(super) fn nearest_open(
        &self,
        direct: &mut Direct,
        rim: &Rim,
        point: &[f64; 3],
    ) -> Result<Option<NearestSurface>, Error> {
        let Some((near, distance)) = self.tree.nearest_of(point, |_| true) else { return Ok(None) };
        let lower = distance.lower;
        let cube = (*point, lower);
        let Some(is_inside) = self.side_of_ball(direct, rim, (point, lower), cube, &mut 32)? else {
            return Ok(None);
        };
        let (near, _) = self.bounding(direct, |_| false, point, |_| true, (near, distance))?;
        Ok(match self.across(direct, point, Some(is_inside), &near)? {
            Some(most) if most >= lower => {
                Some(self.surface_at(&near, Interval::between(lower, most), Some(is_inside)))
            }
            _ => None,
        })
    }

    /// Assembles the result from a nearest point and its distance.
    fn surface_at(
        &self,
        near: &NearestPoint,
        mut distance: Interval,
        is_inside: Option<bool>,
    ) -> NearestSurface {
        let radius = self.tree.radius();
        if radius > 0.0 {
            distance = distance.plus(Interval::between(-radius, radius)).not_negative();
        }
        let is_inside = is_inside.filter(|_| distance.lower > 0.0);
        let surface = Some(near.triangle);
        NearestSurface { distance, is_inside, point: self.tree.point_of(near), surface }
    }

    /// Returns the nearest point of the boundary. `None` if it stays open whether the nearest triangle
    /// belongs to the boundary.
    pub(super) fn nearest(
        &self,
        direct: &mut Direct,
        sides: &Sides,
        point: &[f64; 3],
    ) -> Result<Option<NearestSurface>, Error> {
        let tree = &self.tree;
        let may_bound = |triangle: u32| !sides.is_flat(triangle) && sides.of(triangle) != Some(0);
        let Some((mut near, mut distance)) = tree.nearest_of(point, may_bound) else { return Ok(None) };
        let is_inside = self.is_inside(direct, point)?;
        if sides.of(near.triangle).is_none() {
            // The triangle may lie within the solid, or outside it.
            let lower = distance.lower;
            (near, distance) = self.bounding(
                direct,
                |triangle| sides.of(triangle).is_some(),
                point,
                may_bound,
                (near, distance),
            )?;
            let most = match sides.of(near.triangle) {
                Some(_) => Some(distance.upper),
                None => self.across(direct, point, is_inside, &near)?,
            };
            match most {
                Some(most) if most >= lower => distance = Interval::between(lower, most),
                _ => return Ok(None),
            }
        }
        Ok(Some(self.surface_at(&near, distance, is_inside)))
    }

    /// Among the triangles that are as near as the first one, returns the first triangle that is known to
    /// bound the solid, or beside which points on both sides of the boundary are found. If there is none,
    /// returns the first triangle.
    fn bounding(
        &self,
        direct: &mut Direct,
        bounds: impl Fn(u32) -> bool,
        point: &[f64; 3],
        may_bound: impl Fn(u32) -> bool,
        first: (NearestPoint, Interval),
    ) -> Result<(NearestPoint, Interval), Error> {
        /// The most triangles that are tried.
        const MOST: usize = 8;
        let (mut seen, mut found) = ([u32::MAX; MOST], first);
        for count in 0..MOST {
            let (near, _) = &found;
            if bounds(near.triangle) || self.parts_the_solid(direct, near)? {
                return Ok(found);
            }
            seen[count] = near.triangle;
            let is_new = |triangle: u32| may_bound(triangle) && !seen[..=count].contains(&triangle);
            match self.tree.nearest_of(point, is_new) {
                Some(next) if next.0.square == first.0.square => found = next,
                _ => break,
            }
        }
        Ok(first)
    }

    /// Returns whether the solid surely lies on exactly one side of a triangle, at a point slightly moved
    /// from one of its points towards its middle.
    fn parts_the_solid(&self, direct: &mut Direct, near: &NearestPoint) -> Result<bool, Error> {
        let mut inner = *near;
        inner.weights = near.weights.each(|w| w + (1.0 / 3.0 - w) / 1024.0);
        let (inner, normal) = (self.tree.point_of(&inner), self.tree.normal(near.triangle));
        let size = normal.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let off = self.tree.extent() / (1 << 22) as f64;
        let mut sides = [None; 2];
        for (side, sign) in sides.iter_mut().zip([1.0, -1.0]) {
            *side = self.is_inside(direct, &axes(|axis| inner[axis] + sign * off * (normal[axis] / size)))?;
        }
        Ok(matches!(sides, [Some(one), Some(other)] if one != other))
    }

    /// Returns a distance from a point within which there surely is a point on the other side of the
    /// boundary: hardly more than the distance of the surface's point `near`. `None` if no such point is
    /// found.
    fn across(
        &self,
        direct: &mut Direct,
        point: &[f64; 3],
        is_inside: Option<bool>,
        near: &NearestPoint,
    ) -> Result<Option<f64>, Error> {
        let Some(is_inside) = is_inside else { return Ok(None) };
        let ([a, b, c], normal) = (self.tree.corners(near.triangle), self.tree.normal(near.triangle));
        let near = self.tree.point_of(near);
        let longest = |way: &[f64; 3]| way.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let unit = |way: [f64; 3]| {
            let length = longest(&way);
            way.each(|c| c / length)
        };
        let onward = unit(axes(|axis| near[axis] - point[axis]));
        // Straight on behind a sharp edge, the point beyond may be outside the solid again. There the solid
        // lies behind the triangle, or in front of it.
        let inward =
            unit(axes(|axis| (a[axis] - near[axis]) + (b[axis] - near[axis]) + (c[axis] - near[axis])));
        let normal = unit(normal);
        let aside = |sign: f64| axes(|axis| inward[axis] + sign * 0.125 * normal[axis]);
        let (extent, part) = (self.tree.extent(), |size: f64, digits: u32| size / (1u64 << digits) as f64);
        let size = extent.max(longest(&near));
        for further in [part(size, 44), part(size, 38), part(size, 38).max(part(extent, 32))] {
            for way in [onward, aside(-1.0), aside(1.0)] {
                let beyond = axes(|axis| near[axis] + further * way[axis]);
                if self.is_inside(direct, &beyond)?.is_some_and(|inside| inside != is_inside) {
                    let exactly =
                        |axis: usize| Interval::exactly(beyond[axis]).minus(Interval::exactly(point[axis]));
                    let [x, y, z] = axes(|axis| exactly(axis).square());
                    return Ok(Some(x.plus(y).plus(z).root().upper));
                }
            }
        }
        Ok(None)
    }
}

/// The triangles that a ray touches, by time.
pub(super) struct Touched<'t> {
    pub(super) hits: &'t [Hit],
    pub(super) tree: &'t TriangleTree<'t>,
}

impl Touched<'_> {
    /// Widens the time of a crossing by touches that may happen at the same time, such as the triangle on the
    /// other side of an edge. A touch that runs in a triangle's plane for longer stays separate.
    pub(super) fn joined(&self, crossing: Interval) -> Interval {
        let longest = 16.0 * crossing.width() + 1e-14 * crossing.upper;
        let met = self.hits.iter().take_while(|hit| hit.t.lower <= crossing.upper);
        let met = met.filter(|hit| hit.t.upper >= crossing.lower && hit.t.width() <= longest);
        met.fold(crossing, |all, hit| all.joined(hit.t))
    }

    /// Adds the touches between two times, during which the ray is outside.
    pub(super) fn note(&mut self, from: f64, to: f64, trace: &mut RayTrace) -> Result<(), Error> {
        let mut end = from;
        for hit in self.hits.iter().take_while(|hit| hit.t.lower < to) {
            let (lower, upper) = (hit.t.lower.max(end), hit.t.upper.min(to));
            if lower <= upper && hit.t.upper > from {
                let (normal, surface) = (self.tree.normal(hit.triangle), Some(hit.triangle));
                trace.push(RayCrossing {
                    t: Interval::between(lower, upper),
                    is_inside_after: false,
                    is_met: false,
                    normal,
                    surface,
                })?;
                end = upper;
            }
        }
        Ok(())
    }
}
