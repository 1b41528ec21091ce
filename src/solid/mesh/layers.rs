//! The planes that bound the solid in a cell, and the Boolean function of their sides that the solid is.
//!
//! The triangles of a cell are divided into up to three groups. Each group lies in a layer: a plane with a
//! width. There are no triangles outside the layers, so that the winding number is constant in each of the up
//! to eight regions between them. It is computed on the way from a base to a point in the region.
//!
//! The table of the regions decides more than the regions: a table with the same value on both sides of a
//! layer claims this value within the layer too. So a rib that is thinner than its layer, with the same value
//! on both sides, must not have such a table. For each choice of layers, and of sides of the other layers,
//! the table must either differ, or be proven. A proof is one of two: no triangle of these layers lies on
//! those sides of the other layers; or straight lines from a point before the layers to points within, and
//! from there to a point behind them, cross all such triangles in the same sense, so that the winding number
//! within lies between the winding numbers of the two points.

use super::base::Base;
use super::local::{Point, Polygon, Seen, UNIT, View, cross, dot, minus};
use crate::cut;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::{Dyadic, sqrt};
use crate::lattice::{Cell, Cube, axes};
use crate::memory;
use crate::mesh::{FacetPlane, FacetPlanes, FillRule};
use crate::solid::half_space::table::Table;
use crate::solid::{HalfSpace, LayersQuestion, OpenSurfaces, PlacedHalfSpace, Slab};
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::array::from_fn as array;

/// The most layers of a cell.
const MOST: usize = 3;

/// Cells with more triangles than this are split.
const MOST_TRIANGLES: usize = 256;

/// The greatest distance of the surface from the mesh, in half edges.
const THICK: f64 = 0.25;

/// More than the length of any way in the cell, with a margin for rounding.
const FAR: f64 = 3.5;

/// The planes of a mesh on a frame: the list of layers.
#[derive(Debug)]
pub(super) struct Layers {
    planes: FacetPlanes,
    /// The greatest magnitude of a coordinate of the mesh or of the universe.
    reach: f64,
    /// The greatest distance of the surface from the mesh along an axis.
    displacement: f64,
}

impl Layers {
    pub(super) fn new(planes: FacetPlanes, reach: f64, displacement: f64) -> Layers {
        Layers { planes, reach, displacement }
    }

    pub(super) fn bytes(&self) -> usize {
        self.planes.bytes()
    }

    /// Returns by how much a layer is wider than its triangles: more than all roundings and the displacement
    /// of the surface.
    fn margin(&self, plane: &FacetPlane) -> f64 {
        if self.is_exact(plane) {
            return 0.0;
        }
        let range = plane.normal.iter().map(|c| c.abs()).sum::<f64>();
        1024.0 * UNIT * self.reach + range * self.displacement * (1.0 + 4.0 * UNIT)
    }

    fn is_exact(&self, plane: &FacetPlane) -> bool {
        self.displacement == 0.0 && plane.is_exact()
    }

    /// The half-space behind a plane.
    fn half_space(&self, plane: &FacetPlane) -> HalfSpace {
        if self.is_exact(plane) {
            let [x, y, z] = plane.normal;
            return HalfSpace::linear([-x, -y, -z, plane.low].each(Dyadic::new));
        }
        let margin = self.margin(plane);
        HalfSpace::slab(plane.normal, plane.low - margin, plane.high + margin, None)
    }

    /// Returns the list of all layers.
    pub(super) fn list(&self) -> Result<Vec<PlacedHalfSpace>, Error> {
        let mut list = memory::with_capacity(self.planes.planes.len())?;
        let nowhere: Arc<[_]> = Arc::new([]);
        for plane in &self.planes.planes {
            list.push(PlacedHalfSpace { half_space: self.half_space(plane), placements: nowhere.clone() });
        }
        Ok(list)
    }
}

/// A layer in a cell: points with n · x < `inner` lie behind it, points with n · x > `outer` before it.
#[derive(Debug, Clone, Copy)]
struct Layer {
    slab: Slab,
    /// The number of the mesh's plane; `None` for a layer that belongs to the cell alone.
    plane: Option<u32>,
    is_exact: bool,
}

/// A side of layers: (layer, whether behind it).
type Sides = [Option<bool>; MOST];

/// A triangle of the cell.
struct Facet {
    triangle: u32,
    seen: Seen,
    polygon: Polygon,
    /// The normal, with the length of twice the area in the cell.
    area: Point,
}

/// A way to divide the triangles of a cell into layers.
type Attempt<'v> = fn(&Layering<'v>, &mut [u8]) -> Option<Found>;

/// The query of one cell: its triangles, and the tolerance of its layers.
pub(super) struct Layering<'v> {
    view: View<'v>,
    layers: &'v Layers,
    fill: FillRule,
    /// The tolerance in half edges.
    tolerance: f64,
    facets: Vec<Facet>,
    centre: Point,
    half: f64,
    /// More than the rounding error of offsets in the cell, and of points of polygons.
    slop: f64,
    slack: f64,
}

impl<'v> Layering<'v> {
    /// Collects the triangles of a cell. `None` if they are too many.
    pub(super) fn new(
        view: View<'v>,
        layers: &'v Layers,
        fill: FillRule,
        tolerance: f64,
    ) -> Result<Option<Layering<'v>>, Error> {
        if view.triangles.len() > MOST_TRIANGLES || view.displacement() > THICK {
            return Ok(None);
        }
        let cube = Cube { frame: &view.placed.frame, cell: view.cell() };
        let (lower, upper) = cube.bounds();
        let half = cube.half_edge();
        let mut facets = memory::with_capacity(view.triangles.len())?;
        let mut slack = 0.0;
        for &triangle in view.triangles {
            let seen = view.seen(triangle);
            let own = 4.0 * seen.slack() + 2.0 * view.displacement();
            slack = f64::max(slack, own);
            // Every point of the surface in the cell lies that near to a point of the polygon.
            let Some(polygon) = seen.clipped(1.0 + own) else { return Ok(None) };
            let area = polygon.twice_area();
            facets.push(Facet { triangle, seen, polygon, area });
        }
        let slop = 64.0 * UNIT * (layers.reach / half + 1.0);
        let centre = axes(|k| 0.5 * lower[k] + 0.5 * upper[k]);
        let tolerance = tolerance / half;
        Ok(Some(Layering { view, layers, fill, tolerance, facets, centre, half, slop, slack }))
    }

    /// Returns the function of layers that the solid is in the cell. Layers that belong to the cell alone are
    /// added to `own`.
    pub(super) fn function(&self, own: &mut Vec<PlacedHalfSpace>) -> Result<Option<OpenSurfaces>, Error> {
        let Some(base) = self.view.base() else { return Ok(None) };
        let mut groups = memory::filled(self.facets.len(), 0u8)?;
        // Planes that are about as large as the cell, or larger, are worth sharing with other cells.
        let large: Attempt<'_> = |own, groups| own.of_mesh(groups).filter(|found| own.are_large(found));
        for attempt in [large, Layering::as_one, Layering::of_mesh, Layering::fitted, Layering::as_two] {
            if let Some(found) = attempt(self, &mut groups)
                && let Some(table) = self.table(&found, &groups, &base)
            {
                return self.named(&found, table, own).map(Some);
            }
        }
        Ok(None)
    }

    /// Uses planes of the mesh as layers.
    fn of_mesh(&self, groups: &mut [u8]) -> Option<Found> {
        let mut found = Found::default();
        let planes = &self.layers.planes;
        for (facet, group) in self.facets.iter().zip(groups) {
            let plane = planes.of(facet.triangle);
            let known = found.each().iter().position(|layer| layer.plane == Some(plane));
            *group = match known {
                Some(known) => known as u8,
                None => found.push(self.of_plane(plane)?)?,
            };
        }
        Some(found)
    }

    /// Returns whether the planes of the mesh are not much smaller than a face of the cell.
    fn are_large(&self, found: &Found) -> bool {
        let face = 4.0 * self.half * self.half;
        let is_large = |plane: u32| self.layers.planes.planes[plane as usize].area >= 0.25 * face;
        found.each().iter().all(|layer| layer.plane.is_some_and(is_large))
    }

    /// A plane of the mesh as a layer of the cell; `None` if it is too wide.
    fn of_plane(&self, number: u32) -> Option<Layer> {
        let plane = &self.layers.planes.planes[number as usize];
        let (margin, along) = (self.layers.margin(plane), plane.along(self.centre));
        let slab = Slab {
            normal: plane.normal,
            inner: (plane.low - margin - along) / self.half,
            outer: (plane.high + margin - along) / self.half,
        };
        let layer = Layer { slab, plane: Some(number), is_exact: self.layers.is_exact(plane) };
        // A sliver of the cell that rounding leaves belongs to the layer.
        let range = slab.normal.iter().map(|c| c.abs()).sum::<f64>();
        let is_near = |end: f64| (range - end).abs() < 4.0 * self.slop;
        let (opens_behind, opens_before) = (is_near(-slab.inner), is_near(slab.outer));
        let layer = if opens_behind || opens_before {
            let inner = if opens_behind { f64::NEG_INFINITY } else { slab.inner - 4.0 * self.slop };
            let outer = if opens_before { f64::INFINITY } else { slab.outer + 4.0 * self.slop };
            Layer { slab: Slab { inner, outer, ..slab }, plane: None, is_exact: false }
        } else {
            layer
        };
        (self.width(&slab) <= LayersQuestion::SHARE * self.tolerance).then_some(layer)
    }

    /// The width of a slab; an open side does not count.
    fn width(&self, slab: &Slab) -> f64 {
        (slab.outer - slab.inner) / sqrt(dot(&slab.normal, &slab.normal))
    }

    /// Uses one layer for all facets.
    fn as_one(&self, groups: &mut [u8]) -> Option<Found> {
        groups.fill(0);
        let mut found = Found::default();
        found.push(self.around(|_| true, true)?)?;
        Some(found)
    }

    /// Uses one layer twice, for a cell with the same value on both sides. Within the layer either value is
    /// possible. So this is for cells that are no larger than the region that may stay undecided around the
    /// surface.
    fn as_two(&self, groups: &mut [u8]) -> Option<Found> {
        const DIAGONAL: f64 = 1.732_050_807_568_877_3;
        if self.tolerance < DIAGONAL {
            return None;
        }
        let mut found = self.as_one(groups)?;
        found.push(found.layers[0])?;
        Some(found)
    }

    /// Returns the layer around some facets. `is_lone` says whether they are all facets of the cell. `None`
    /// if the layer is too wide, or the facets have no common direction.
    fn around(&self, is_member: impl Fn(usize) -> bool, is_lone: bool) -> Option<Layer> {
        let members =
            || self.facets.iter().enumerate().filter(|(i, _)| is_member(*i)).map(|(_, facet)| facet);
        let mut normal = [0.0; 3];
        for facet in members() {
            (0..3).for_each(|k| normal[k] += facet.area[k]);
        }
        let normal = unit(normal)?;
        let range = normal.iter().map(|c| c.abs()).sum::<f64>();
        let (mut inner, mut outer) = (f64::INFINITY, f64::NEG_INFINITY);
        for p in members().flat_map(|facet| facet.polygon.points()) {
            let along = dot(&normal, p);
            (inner, outer) = (inner.min(along), outer.max(along));
        }
        let margin = 4.0 * range * self.slack + 64.0 * UNIT;
        let slab = Slab { normal, inner: inner - margin, outer: outer + margin };
        // (NaN does not compare as less.)
        let is_thin = self.width(&slab) <= LayersQuestion::SHARE * self.tolerance
            || is_lone && LayersQuestion::admits(&slab, self.tolerance);
        if !is_thin {
            return None;
        }
        // Nothing of the cell lies beyond its corners.
        const NEARLY: f64 = 1.0 - 1e-9;
        let inner = if slab.inner <= -range * NEARLY { f64::NEG_INFINITY } else { slab.inner };
        let outer = if slab.outer >= range * NEARLY { f64::INFINITY } else { slab.outer };
        let layer = Layer { slab: Slab { inner, outer, ..slab }, plane: None, is_exact: false };
        let is_open = (inner == f64::NEG_INFINITY, outer == f64::INFINITY);
        // Corners of the cell on an open side stay undecided, and so they must be near the surface.
        let is_left = |corner: &Point| {
            let along = dot(&normal, corner);
            is_open.0 && along <= slab.outer || is_open.1 && along >= slab.inner
        };
        let is_near =
            |corner: &Point| members().any(|facet| away(corner, &facet.polygon) <= 2.0 * self.tolerance);
        CORNERS.iter().filter(|corner| is_left(corner)).all(is_near).then_some(layer)
    }

    /// Makes layers around facets that lie near to the plane of a large facet and face the same side.
    fn fitted(&self, groups: &mut [u8]) -> Option<Found> {
        const FREE: u8 = u8::MAX;
        groups.fill(FREE);
        let mut found = Found::default();
        for group in 0..MOST as u8 {
            let size = |facet: &Facet| dot(&facet.area, &facet.area);
            let free = (0..self.facets.len()).filter(|&i| groups[i] == FREE);
            let Some(seed) = free.max_by(|&i, &k| size(&self.facets[i]).total_cmp(&size(&self.facets[k])))
            else {
                return Some(found);
            };
            let normal = unit(self.facets[seed].area)?;
            let offset = |p: &Point| dot(&normal, p);
            let middle = offset(&self.facets[seed].polygon.middle());
            for (facet, own) in self.facets.iter().zip(&mut *groups).filter(|(_, own)| **own == FREE) {
                let is_near = |p: &Point| (offset(p) - middle).abs() <= self.tolerance;
                // (Beyond a steep facet, the layer would continue where there is no surface.)
                let slope = dot(&facet.area, &normal);
                if 4.0 * slope * slope.abs() >= size(facet) && facet.polygon.points().iter().all(is_near) {
                    *own = group;
                }
            }
            groups[seed] = group;
            found.push(self.of_group(&found, groups, group)?)?;
        }
        groups.iter().all(|&group| group != FREE).then_some(found)
    }

    /// The layer of a group: the plane of the mesh that holds all its facets, or a layer around them.
    fn of_group(&self, found: &Found, groups: &[u8], group: u8) -> Option<Layer> {
        let planes = &self.layers.planes;
        let mut own = self.facets.iter().zip(groups).filter(|(_, own)| **own == group);
        let first = planes.of(own.next()?.0.triangle);
        let is_free = found.each().iter().all(|layer| layer.plane != Some(first));
        if is_free
            && own.all(|(facet, _)| planes.of(facet.triangle) == first)
            && let Some(layer) = self.of_plane(first)
        {
            return Some(layer);
        }
        self.around(|i| groups[i] == group, false)
    }

    /// Computes the winding number on these sides of layers; `Some(None)` if the sides have no point in
    /// common. `None` if it stays undecided.
    fn region(&self, found: &Found, sides: Sides, base: &Base) -> Option<Option<Witness>> {
        let mut halves = [([0.0; 3], 0.0); MOST];
        let mut count = 0;
        for (layer, side) in found.each().iter().zip(sides) {
            let Some(is_behind) = side else { continue };
            let Slab { normal, inner, outer } = layer.slab;
            let end = if is_behind { inner } else { -outer };
            if end == f64::NEG_INFINITY {
                return Some(None);
            }
            halves[count] = (if is_behind { normal } else { normal.each(|c| -c) }, end);
            count += 1;
        }
        let halves = &halves[..count];
        let wide: [_; MOST] =
            array(|i| halves.get(i).map_or(([0.0; 3], 0.0), |&(n, end)| (n, end + self.slop)));
        let Some(at) = cut::middle(&wide[..count])? else { return Some(None) };
        let is_inside = halves.iter().all(|(normal, end)| dot(normal, &at) < end - self.slop);
        let within = at.iter().all(|c| c.abs() < 1.0);
        if !(is_inside && within) {
            return None;
        }
        Some(Some(Witness { at, winding: self.view.winding_at(&at, base)? }))
    }

    /// Returns whether a facet may reach to these sides of layers.
    fn reaches(&self, found: &Found, facet: &Facet, sides: Sides) -> bool {
        let corners = || self.view.placed.original(facet.triangle);
        for (layer, side) in found.each().iter().zip(sides) {
            let (Some(is_behind), Some(number)) = (side, layer.plane) else { continue };
            let plane = &self.layers.planes.planes[number as usize];
            let is_beyond = |along: f64| if is_behind { along < plane.low } else { along > plane.high };
            if !corners().into_iter().any(|corner| is_beyond(plane.along(corner))) {
                return false;
            }
        }
        let mut left = facet.polygon;
        for (layer, side) in found.each().iter().zip(sides) {
            let Some(is_behind) = side else { continue };
            let Slab { normal, inner, outer } = layer.slab;
            let range = normal.iter().map(|c| c.abs()).sum::<f64>();
            let room = range * self.slack + self.slop;
            let (normal, end) = if is_behind { (normal, inner) } else { (normal.each(|c| -c), -outer) };
            // (If clipping leaves too many corners, the facet may reach there.)
            let Some(clipped) = left.behind(&normal, end + room) else { return true };
            if clipped.points().is_empty() {
                return false;
            }
            left = clipped;
        }
        true
    }

    /// Returns the truth table of layers. `None` if it stays undecided, or no table says enough.
    fn table(&self, found: &Found, groups: &[u8], base: &Base) -> Option<Table> {
        let count = found.count;
        let mut witnesses = [None; 1 << MOST];
        for (signs, witness) in witnesses.iter_mut().enumerate().take(1 << count) {
            let sides = array(|i| (i < count).then_some(signs >> i & 1 != 0));
            *witness = self.region(found, sides, base)?;
        }
        let value = |winding: i32| self.fill.encloses(winding);
        let known: [Option<bool>; 1 << MOST] = array(|signs| witnesses[signs].map(|w| value(w.winding)));
        let widest = (0..count).filter(|&i| !found.layers[i].is_exact).fold(0, |all, i| all | 1 << i);
        let mut rules = [Rule::default(); 27];
        let mut rule_count = 0;
        for of in (1..1usize << count).filter(|of| of & !widest == 0) {
            for others in (0..1usize << count).filter(|signs| signs & of == 0) {
                let allowed = self.allowed(found, groups, (of, others), &witnesses)?;
                // Where all known values agree, the whole of the layers is undecided.
                let mut here = (0..1usize << count)
                    .filter(|signs| signs & !of == others)
                    .filter_map(|signs| known[signs]);
                let first = here.next();
                let is_open = allowed.is_none() && here.all(|other| Some(other) == first);
                if is_open && !self.are_covered(found, of) {
                    return None;
                }
                rules[rule_count] = Rule { of, others, allowed };
                rule_count += 1;
            }
        }
        // Among the tables that agree with the known values, the first that decides most.
        let said = |table: usize| {
            let holds = |signs: usize| table >> signs & 1 != 0;
            let is_true = (0..1 << count).all(|signs| known[signs].is_none_or(|known| known == holds(signs)));
            let told = |said: usize, rule: &Rule| Some(said + usize::from(rule.told(holds, 1 << count)?));
            if is_true { rules[..rule_count].iter().try_fold(1, told) } else { None }
        };
        let (mut table, mut most) = (0, 0);
        for other in 0..1usize << (1 << count) {
            if let Some(said) = said(other).filter(|&said| said > most) {
                (table, most) = (other, said);
            }
        }
        if most == 0 {
            return None;
        }
        let wide = |signs: u64| (table >> (signs & ((1 << count) - 1)) & 1) as u64;
        Some(Table((0..64).fold(0, |all, signs| all | wide(signs) << signs)))
    }

    /// Returns whether each of the layers `of` that belongs to the cell alone lies wholly near one facet. The
    /// points near a convex polygon form a convex set, so that testing the corners of the layer suffices.
    fn are_covered(&self, found: &Found, of: usize) -> bool {
        let is_own = |(i, layer): &(usize, &Layer)| of >> i & 1 != 0 && layer.plane.is_none();
        found.each().iter().enumerate().filter(is_own).all(|(_, layer)| {
            let corners = cut::corners(&layer.slab);
            self.facets
                .iter()
                .any(|facet| corners.clone().all(|p| away(&p, &facet.polygon) <= 2.0 * self.tolerance))
        })
    }

    /// Returns the constant value that a table may have for all sides of the layers `of`, at these sides of
    /// the other layers.
    fn allowed(
        &self,
        found: &Found,
        groups: &[u8],
        (of, others): (usize, usize),
        witnesses: &[Option<Witness>; 1 << MOST],
    ) -> Option<Option<bool>> {
        let count = found.count;
        let sides = array(|i| (i < count && of >> i & 1 == 0).then_some(others >> i & 1 != 0));
        let is_of = |group: u8| of >> group & 1 != 0;
        let mut reaching = self
            .facets
            .iter()
            .zip(groups)
            .filter(|(facet, group)| is_of(**group) && self.reaches(found, facet, sides))
            .peekable();
        let here = (0..1usize << count).filter(|signs| signs & !of == others);
        if reaching.peek().is_none() {
            // The whole region has one winding number.
            let mut windings = here.filter_map(|signs| witnesses[signs]).map(|witness| witness.winding);
            let Some(winding) = windings.next() else { return Some(None) };
            return windings.all(|other| other == winding).then_some(Some(self.fill.encloses(winding)));
        }
        let (Some(behind), Some(before)) = (witnesses[others | of], witnesses[others]) else {
            return Some(None);
        };
        // From behind to before, each facet that is crossed subtracts one.
        let is_crossed_up = |facet: &Facet, group: u8, witness: &Witness, sign: f64| {
            let layer = &found.layers[usize::from(group)];
            let depth = match sign > 0.0 {
                true => layer.slab.inner - dot(&layer.slab.normal, &witness.at),
                false => dot(&layer.slab.normal, &witness.at) - layer.slab.outer,
            };
            let [a, b, c] = &facet.seen.corners;
            let [u, v] = [minus(b, a), minus(c, a)];
            let (area, room) = (cross(&u, &v), sqrt(dot(&u, &u) * dot(&v, &v)));
            let length = sqrt(dot(&area, &area));
            // The errors of the corners may turn the facet by this angle.
            let turned =
                16.0 * (facet.seen.error + UNIT * facet.seen.reach) * sqrt(dot(&u, &u).max(dot(&v, &v)))
                    / length
                    + 16.0 * UNIT * room / length;
            let off: Point = array(|k| area[k] / length - layer.slab.normal[k]);
            // (NaN does not compare as less.)
            (sqrt(dot(&off, &off)) + turned) * FAR < depth
        };
        let is_monotone = self.view.displacement() == 0.0
            && reaching.all(|(facet, &group)| {
                is_crossed_up(facet, group, &behind, 1.0) && is_crossed_up(facet, group, &before, -1.0)
            });
        if !is_monotone || before.winding > behind.winding || behind.winding - before.winding > 64 {
            return Some(None);
        }
        let value = self.fill.encloses(before.winding);
        let is_one = (before.winding..=behind.winding).all(|winding| self.fill.encloses(winding) == value);
        Some(is_one.then_some(value))
    }

    /// Returns the function in the numbers of the mesh's layers. Layers without a plane of the mesh are added
    /// to `own`.
    fn named(
        &self,
        found: &Found,
        table: Table,
        own: &mut Vec<PlacedHalfSpace>,
    ) -> Result<OpenSurfaces, Error> {
        let cube = Cube { frame: &self.view.placed.frame, cell: self.view.cell() };
        let mut numbers = [0; MOST];
        for (number, layer) in numbers.iter_mut().zip(found.each()) {
            *number = match layer.plane {
                Some(plane) => plane,
                None => {
                    let half_space = HalfSpace::layer(&cube, &ended(&layer.slab));
                    memory::push(own, PlacedHalfSpace { half_space, placements: Arc::new([]) })?;
                    OpenSurfaces::OWN + own.len() as u32 - 1
                }
            };
        }
        let open = OpenSurfaces::new(numbers[..found.count].iter().copied(), table);
        // (There are at most three layers.)
        Ok(open.unwrap_or(OpenSurfaces::constant(false)))
    }
}

/// The layers of a cell.
#[derive(Default)]
struct Found {
    layers: [Layer; MOST],
    count: usize,
}

impl Default for Layer {
    fn default() -> Layer {
        Layer { slab: Slab::NONE, plane: None, is_exact: false }
    }
}

impl Found {
    fn each(&self) -> &[Layer] {
        &self.layers[..self.count]
    }

    /// Adds a layer, if there is room, and returns its place.
    fn push(&mut self, layer: Layer) -> Option<u8> {
        *self.layers.get_mut(self.count)? = layer;
        self.count += 1;
        Some(self.count as u8 - 1)
    }
}

/// A point between layers, and its winding number.
#[derive(Debug, Clone, Copy)]
struct Witness {
    at: Point,
    winding: i32,
}

/// A condition on a table, for all sides of the layers `of` at the sides `others` of the other layers: if the
/// table is constant there, its value must be the allowed one. Without an allowed value, the table must not
/// be constant.
#[derive(Debug, Clone, Copy, Default)]
struct Rule {
    of: usize,
    others: usize,
    allowed: Option<bool>,
}

impl Rule {
    /// Returns whether a table is constant there; `None` if it violates the rule.
    fn told(&self, holds: impl Fn(usize) -> bool, all: usize) -> Option<bool> {
        let value = holds(self.others);
        let is_one =
            (0..all).filter(|signs| signs & !self.of == self.others).all(|signs| holds(signs) == value);
        (!is_one || self.allowed == Some(value)).then_some(is_one)
    }
}

/// Bounds a slab on both sides: an open side ends beyond the cell, where its place does not matter.
fn ended(slab: &Slab) -> Slab {
    let far = 2.0 * slab.normal.iter().map(|c| c.abs()).sum::<f64>();
    Slab { inner: slab.inner.max(-far), outer: slab.outer.min(far), ..*slab }
}

/// The corners of a cell.
const CORNERS: [Point; 8] = {
    let mut corners = [[0.0; 3]; 8];
    let mut k = 0;
    while k < 8 {
        let mut axis = 0;
        while axis < 3 {
            corners[k][axis] = if k >> axis & 1 != 0 { 1.0 } else { -1.0 };
            axis += 1;
        }
        k += 1;
    }
    corners
};

/// The approximate distance of a point from a polygon.
fn away(p: &Point, polygon: &Polygon) -> f64 {
    let points = polygon.points();
    let normal = unit(polygon.twice_area()).unwrap_or([0.0; 3]);
    let (mut is_over, mut nearest) = (normal != [0.0; 3], f64::INFINITY);
    for (k, a) in points.iter().enumerate() {
        let b = &points[if k + 1 == points.len() { 0 } else { k + 1 }];
        let (edge, from) = (minus(b, a), minus(p, a));
        is_over &= dot(&cross(&normal, &edge), &from) >= 0.0;
        let length = dot(&edge, &edge);
        let share = if length > 0.0 { (dot(&edge, &from) / length).clamp(0.0, 1.0) } else { 0.0 };
        let off: Point = array(|k| from[k] - share * edge[k]);
        nearest = nearest.min(sqrt(dot(&off, &off)));
    }
    match points.first() {
        Some(a) if is_over => dot(&normal, &minus(p, a)).abs(),
        _ => nearest,
    }
}

/// The direction as a unit vector.
fn unit(area: Point) -> Option<Point> {
    let most = area.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    // (NaN is in no range.)
    if !(1e-30..1e30).contains(&most) {
        return None;
    }
    let scaled = area.each(|c| c / most);
    let length = sqrt(dot(&scaled, &scaled));
    Some(scaled.each(|c| c / length))
}

impl View<'_> {
    /// The cell.
    fn cell(&self) -> Cell {
        let depth = self.placed.frame.depth();
        let height = self.size.trailing_zeros();
        Cell { level: depth - height as u8, at: self.at.each(|a| (a >> height) as u32) }
    }
}
