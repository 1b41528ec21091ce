//! The function of the moved surfaces that a solid is in a cell, from the functions in the cells of its own
//! frame that the cell touches.
//!
//! Each of these cells, the *sources*, knows a function of the surfaces that cross it. The search is for one
//! function of up to six surfaces. It must have the value of each source for all combinations of signs that
//! are possible where the source meets the target. The possible combinations follow exactly from the sides on
//! which the target and the source lie. They also follow from bounds over a box around their intersection, in
//! the target's coordinates and in those of the source. Bounds of pairs of surfaces are used only where that
//! does not suffice.
//!
//! Where there are layers, the intersections are convex bodies, and their values are distinguished state by
//! state ([`regions`](super::regions)). If layers of one plane contain each other, only the widest layer
//! counts: its sides are known in fewer places. A surface that lies in a layer all over the target counts as
//! that layer. That may not suffice if facets meet in a wall between two cells, each of which knows one
//! facet. Then the wall itself becomes a surface, with one function on each side.
//!
//! Signs are those of the surfaces, so that no decision depends on rounding. The cells below depend on the
//! function alone.

use super::faces::{LatticePlane, LatticePlanes, lattice_planes, lone};
use super::image::Maps;
use super::polytope::Polytope;
use super::regions::{Flat, Found, Regions};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::{Dyadic, sqrt};
use crate::lattice::{Affine, Cell, Frame, axes};
use crate::memory;
use crate::octree::Tag;
use crate::solid::half_space::bounds::{centre, half_edge};
use crate::solid::half_space::joined::Joined;
use crate::solid::half_space::possible::possible;
use crate::solid::half_space::table::Table;
use crate::solid::half_space::{Placed, tangent::Tangent};
use crate::solid::{AskWhole, Batch, Classifier, HalfSpace, OpenSurfaces, PlacedHalfSpace};
use alloc::sync::Arc;
use alloc::vec::Vec;

/// The surfaces of a solid that is moved: their original places and their new places.
#[derive(Default)]
pub(super) struct Surfaces {
    pub(super) moved: Vec<PlacedHalfSpace>,
    /// The original surfaces, on the universe of the solid's own frame.
    before: Vec<Placed>,
    /// The moved surfaces, on the universe of the frame.
    pub(super) after: Vec<Placed>,
    /// For each surface, the next wider layer of the same plane, if there is one.
    wider: Vec<Option<u32>>,
    /// The planes of the solid's own lattice, the last surfaces of the list: faces, then seams.
    planes: LatticePlanes,
}

/// The factors by which a layer is widened, one after the other, where two source cells cannot be
/// distinguished otherwise. Their facets meet in the wall between the cells, or nearly there, and the width
/// of one facet takes up more of the wall than that of the other.
const WIDER: [f64; 4] = [3.0, 3.0, 8.0, 32.0];

/// The greatest width of a widened layer, in finest cells. A layer that would become wider is not widened.
const MOST_WIDENED: f64 = 1.0;

impl core::fmt::Debug for Surfaces {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Surfaces").field("moved", &self.moved.len()).finish_non_exhaustive()
    }
}

/// A cell of the solid's own frame that a target touches, or a piece of the space beyond the universe.
pub(super) struct Source {
    pub(super) cell: Option<Cell>,
    /// The lower and the upper corner, in finest cells.
    pub(super) low: [f64; 3],
    pub(super) high: [f64; 3],
    /// The function that the solid is there.
    pub(super) known: OpenSurfaces,
}

impl Source {
    /// The constant function of a decided cell.
    pub(super) fn constant(tag: Tag) -> OpenSurfaces {
        OpenSurfaces::constant(tag == Tag::Full)
    }
}

impl Surfaces {
    /// Collects the surfaces of a classifier, and the planes of its lattice that contain pieces of its
    /// boundary. `None` if there are no surfaces, or if one has no exact place. O(surfaces), and some
    /// thousand cells are split.
    pub(super) fn of<C: Classifier>(
        inner: &C,
        placement: &Affine,
        frame: &Frame,
        control: &Control<'_>,
    ) -> Result<Option<Surfaces>, Error> {
        let list = inner.surfaces(control)?.unwrap_or_default();
        let mut worker = inner.worker()?;
        // (A worker that prefers batches would be slow here: the cells are split one by one.)
        if worker.likes_many() {
            return Ok(None);
        }
        let mut own = Surfaces::default();
        let place = |own: &mut Surfaces, surface: &PlacedHalfSpace| {
            control.check()?;
            let moved = surface.placed(placement);
            memory::push(&mut own.before, surface.on(inner.frame())?)?;
            memory::push(&mut own.after, moved.on(frame)?)?;
            memory::push(&mut own.moved, moved)
        };
        let mut place_all = || {
            list.iter().try_for_each(|surface| place(&mut own, surface))?;
            let (wider, widened) = wider(&list, MOST_WIDENED * inner.frame().cell_size())?;
            widened.iter().try_for_each(|surface| place(&mut own, surface))?;
            own.wider = wider;
            let mut planes = lattice_planes(&mut worker, inner.exterior(), &own.before, control)?;
            if !own.has_layers() {
                planes.seams.clear();
            }
            for &plane in planes.faces.iter().chain(&planes.seams) {
                place(&mut own, &plane_of(inner.frame(), plane))?;
            }
            own.planes = planes;
            Ok(())
        };
        match place_all() {
            Ok(()) => Ok((!own.moved.is_empty()).then_some(own)),
            // (The solid can be moved without its surfaces.)
            Err(Error::Limit { .. }) => Ok(None),
            Err(error) => Err(error),
        }
    }

    fn first_plane(&self) -> usize {
        self.first_seam() - self.planes.faces.len()
    }

    fn first_seam(&self) -> usize {
        self.moved.len() - self.planes.seams.len()
    }

    /// The plane of the lattice with a number.
    fn plane(&self, index: u32) -> Option<LatticePlane> {
        let number = (index as usize).checked_sub(self.first_plane())?;
        let LatticePlanes { faces, seams } = &self.planes;
        faces.get(number).or_else(|| seams.get(number - faces.len())).copied()
    }

    fn wider(&self, index: u32) -> Option<u32> {
        self.wider.get(index as usize).copied().flatten()
    }

    /// Returns whether there are layers, which have widths.
    fn has_layers(&self) -> bool {
        self.after.iter().any(|placed| placed.layer_slack().is_some())
    }

    pub(super) fn bytes(&self) -> usize {
        let placed =
            |list: &Vec<Placed>| memory::bytes_of(list) + list.iter().map(Placed::heap_bytes).sum::<usize>();
        memory::bytes_of(&self.moved) + placed(&self.before) + placed(&self.after)
    }
}

/// For each surface, the next wider layer of the same plane; and the layers that are added for that.
#[allow(clippy::type_complexity)]
fn wider(list: &[PlacedHalfSpace], most: f64) -> Result<(Vec<Option<u32>>, Vec<PlacedHalfSpace>), Error> {
    /// The greatest number of layers of one plane that are searched.
    const NEAR: usize = 4;
    let mut wider = memory::filled(list.len(), None)?;
    let mut layers = Vec::new();
    for (number, surface) in list.iter().enumerate() {
        if let Some((normal, ends)) = surface.half_space.layer_ends() {
            let mut key = memory::collected(normal.each(f64::to_bits).into_iter())?;
            for map in &*surface.placements {
                key.try_reserve(12)?;
                key.extend(map.rows().as_flattened().iter().map(|c| c.to_bits()));
            }
            memory::push(&mut layers, (key, ends, number))?;
        }
    }
    // Wider layers of a plane come later.
    layers.sort_by(|(a, [from, to], _), (b, [other_from, other_to], _)| {
        a.cmp(b).then(other_from.total_cmp(from)).then(to.total_cmp(other_to))
    });
    let mut added = Vec::new();
    for (place, (key, ends, number)) in layers.iter().enumerate() {
        let holds = |other: &&(Vec<u64>, [f64; 2], usize)| {
            other.0 == *key && other.1[0] < ends[0] && other.1[1] > ends[1]
        };
        if let Some((_, _, other)) = layers[place + 1..].iter().take(NEAR).find(holds) {
            wider[*number] = Some(*other as u32);
            continue;
        }
        let (mut at, mut last, unit) = (*number, list[*number].clone(), list[*number].unit());
        for times in WIDER {
            let Some(half_space) = last.half_space.widened(times, most / unit) else { break };
            last.half_space = half_space;
            wider[at] = Some(wider.len() as u32);
            at = wider.len();
            memory::push(&mut wider, None)?;
            memory::push(&mut added, last.clone())?;
        }
    }
    Ok((wider, added))
}

/// A plane of a lattice as a half-space above the plane.
fn plane_of(frame: &Frame, (axis, at): LatticePlane) -> PlacedHalfSpace {
    let step = &Dyadic::new(f64::from(at)) * &Dyadic::new(frame.cell_size());
    let place = &Dyadic::new(frame.origin()[axis]) + &step;
    let [x, y, z] = axes(|i| Dyadic::new(if i == axis { 1.0 } else { 0.0 }));
    PlacedHalfSpace { half_space: HalfSpace::linear([x, y, z, -&place]), placements: Arc::new([]) }
}

/// Renames a surface in all functions.
fn rename(values: &mut [OpenSurfaces], from: u32, to: u32) {
    for value in values.iter_mut().filter(|value| value.indices().contains(&from)) {
        *value = value.renamed(|index| if index == from { to } else { index });
    }
}

/// A cell for which a function is searched.
pub(super) struct Target<'s> {
    surfaces: &'s Surfaces,
    maps: &'s Maps,
    cell: Cell,
    /// The centre and half the edge of the target, and the rounded image of the centre, all in finest cells.
    centre: [f64; 3],
    half: f64,
    image: [f64; 3],
    /// A box around the inverse image of the target.
    low: [f64; 3],
    high: [f64; 3],
    /// The edge of a finest cell of the solid's own frame, in half edges of the target.
    finest: f64,
    /// The surfaces that were examined so far.
    met: Vec<Met>,
}

/// A surface in a target.
#[derive(Clone, Copy)]
struct Met {
    index: u32,
    /// The side on which the whole target lies, if it is known.
    side: Option<bool>,
    bounds: Option<Bounds>,
    flat: Flat,
}

/// Bounds of a function over a target, from its centre in half edges.
#[derive(Clone, Copy)]
struct Bounds {
    gradient: [f64; 3],
    /// The coefficients of xx, yy, zz, xy, xz, yz.
    squares: [f64; 6],
    low: f64,
    high: f64,
}

/// The intersection of a source with a target, as boxes around it.
struct Piece<'p> {
    source: &'p Source,
    /// The box from the target's centre, in its half edges.
    low: [f64; 3],
    high: [f64; 3],
    /// The box from the centre's image, in finest cells of the solid's own frame.
    own_low: [f64; 3],
    own_high: [f64; 3],
}

/// A bound of the roundings of a sum of two dozen products, relative to the sum of their magnitudes.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

impl<'s> Target<'s> {
    pub(super) fn new(surfaces: &'s Surfaces, maps: &'s Maps, frame: &Frame, cell: Cell) -> Target<'s> {
        let (corner, edge) = super::extent(frame, cell);
        let half = 0.5 * edge;
        let centre = corner.each(|c| c + half);
        let (image, _) = maps.inward.image(centre, 0.0);
        let (low, high) = maps.inward.around(corner, edge);
        let lengths = axes(|j| maps.outward.linear.iter().map(|row| row[j] * row[j]).sum::<f64>());
        let finest = sqrt(lengths.into_iter().fold(f64::INFINITY, f64::min)) / half;
        Target { surfaces, maps, cell, centre, half, image, low, high, finest, met: Vec::new() }
    }

    /// The space beyond the universe of `cells` finest cells, as pieces that may overlap.
    pub(super) fn beyond(&self, cells: f64, exterior: Tag) -> impl Iterator<Item = Source> {
        let (low, high) = (self.low, self.high);
        let known = Source::constant(exterior);
        (0..6).filter_map(move |side: usize| {
            let (axis, mut ends) = (side / 2, (low, high));
            if side.is_multiple_of(2) {
                ends.1[axis] = high[axis].min(0.0);
            } else {
                ends.0[axis] = low[axis].max(cells);
            }
            // (A NaN may be anywhere.)
            let is_within = ends.0[axis] >= ends.1[axis];
            (!is_within).then_some(Source { cell: None, low: ends.0, high: ends.1, known })
        })
    }

    /// Returns one function of up to six surfaces that agrees with each source where the source meets the
    /// target; `None` if there is none.
    pub(super) fn function(&mut self, sources: &[Source]) -> Result<Option<OpenSurfaces>, Error> {
        let mut pieces = memory::with_capacity(sources.len())?;
        pieces.extend(sources.iter().filter_map(|source| self.piece(source)));
        if self.surfaces.has_layers() {
            return self.by_regions(&pieces);
        }
        // The function in each piece, by the sides of its own surfaces alone.
        let mut all = OpenSurfaces::constant(false);
        let mut values = memory::with_capacity(pieces.len())?;
        for piece in &pieces {
            let mut value = piece.source.known;
            for (i, index) in piece.source.known.variables() {
                if let Some(inside) = self.side(piece, index)? {
                    value = value.with_table(value.table().with(i, inside));
                }
            }
            let value = value.shortened();
            for &index in value.indices() {
                if all.number(index).is_none() {
                    return Ok(None);
                }
            }
            values.push(value);
        }
        for with_planes in [false, true] {
            if with_planes && !self.add_planes(&mut all) {
                break;
            }
            for closely in [false, true] {
                if let Some((table, known)) = self.joined(&all, &pieces, &values, closely)? {
                    // (If no combination is possible, rounding is the reason.)
                    let found = (known != Table::EMPTY).then(|| table.simplified(known));
                    return Ok(found.map(|table| all.with_table(table).shortened()));
                }
            }
        }
        Ok(None)
    }

    /// As `function`, where there are layers.
    fn by_regions(&mut self, pieces: &[Piece<'_>]) -> Result<Option<OpenSurfaces>, Error> {
        /// How often layers are widened.
        const MOST_TRIES: usize = 2;
        let mut bodies = memory::with_capacity(pieces.len())?;
        let mut values = memory::with_capacity(pieces.len())?;
        for piece in pieces {
            let Some(body) = self.body(piece.source) else { continue };
            let mut value = piece.source.known;
            for (i, index) in piece.source.known.variables() {
                if let Some(inside) = self.place(piece, &body, index)? {
                    value = value.with_table(value.table().with(i, inside));
                }
            }
            memory::push(&mut bodies, (piece, body))?;
            memory::push(&mut values, value.shortened())?;
        }
        self.unite(&mut values);
        let (mut with_planes, mut with_seams) = (false, false);
        for tries in 0.. {
            let mut all = OpenSurfaces::constant(false);
            if with_planes {
                self.add_planes(&mut all);
            }
            if with_seams {
                self.add_seams(&mut all, &bodies);
            }
            if !values.iter().all(|value| value.indices().iter().all(|&index| all.number(index).is_some())) {
                return Ok(None);
            }
            let conflict = match self.regions(&all, &bodies, &values)? {
                Found::Function(table, known) => {
                    return Ok(Some(all.with_table(table.simplified(known)).shortened()));
                }
                Found::Nothing => return Ok(None),
                Found::Conflict(piece, ..) => piece,
            };
            let is_open = tries < MOST_TRIES;
            if is_open && (self.absorb(&all, &mut values)? || self.widen(&all, &mut values, conflict)) {
                continue;
            }
            let mut other = all;
            if !with_planes && self.add_planes(&mut other) {
                with_planes = true;
            } else if !with_seams && self.add_seams(&mut other, &bodies) {
                with_seams = true;
            } else {
                return Ok(None);
            }
        }
        Ok(None)
    }

    /// Replaces several layers of one plane by the widest of them.
    fn unite(&self, values: &mut [OpenSurfaces]) {
        let is_used =
            |values: &[OpenSurfaces], index: u32| values.iter().any(|value| value.indices().contains(&index));
        for k in 0..values.len() {
            for i in 0..values[k].indices().len() {
                let Some(&index) = values[k].indices().get(i) else { break };
                let (mut at, mut widest) = (index, index);
                while let Some(next) = self.surfaces.wider(at) {
                    at = next;
                    if is_used(values, at) {
                        widest = at;
                    }
                }
                if widest != index {
                    rename(values, index, widest);
                }
            }
        }
    }

    /// Replaces surfaces by layers that contain them all over the target; returns `false` if there are none.
    fn absorb(&mut self, all: &OpenSurfaces, values: &mut [OpenSurfaces]) -> Result<bool, Error> {
        let mut left = *all;
        let mut is_any = false;
        for &wide in all.indices() {
            for &thin in all.indices() {
                let are_left = [wide, thin].iter().all(|index| left.indices().contains(index));
                if wide != thin && are_left && self.met(wide)?.flat.holds(&self.met(thin)?.flat) {
                    rename(values, thin, wide);
                    left = left.renamed(|index| if index == thin { wide } else { index });
                    is_any = true;
                }
            }
        }
        Ok(is_any)
    }

    /// Widens the layers on which the values depend and which a piece does not know; if there are none, the
    /// layers that the piece does know. Returns `false` if no layer can be widened.
    fn widen(&self, all: &OpenSurfaces, values: &mut [OpenSurfaces], piece: usize) -> bool {
        let own = values[piece];
        for is_known in [false, true] {
            let mut is_wider = false;
            for &index in all.indices().iter().filter(|index| own.indices().contains(index) == is_known) {
                if let Some(wider) = self.surfaces.wider(index) {
                    rename(values, index, wider);
                    is_wider = true;
                }
            }
            if is_wider {
                return true;
            }
        }
        false
    }

    fn regions(
        &mut self,
        all: &OpenSurfaces,
        bodies: &[(&Piece<'_>, Polytope)],
        values: &[OpenSurfaces],
    ) -> Result<Found, Error> {
        let mut regions = Regions::default();
        for ((piece, body), value) in bodies.iter().zip(values) {
            let mut places = [0; OpenSurfaces::MOST];
            for (place, index) in places.iter_mut().zip(value.indices()) {
                *place = all.indices().iter().position(|known| known == index).unwrap_or(0);
            }
            let mut seen = [(Flat::ANY, None); OpenSurfaces::MOST];
            for (seen, &index) in seen.iter_mut().zip(all.indices()) {
                *seen = (self.met(index)?.flat, self.place(piece, body, index)?);
            }
            let value = value.table().spread(&places[..value.indices().len()]);
            if !regions.take(body, &seen[..all.indices().len()], value, self.finest)? {
                return Ok(Found::Nothing);
            }
        }
        Ok(regions.joined())
    }

    /// The side of a surface on which the whole piece lies, if it is known.
    fn place(&mut self, piece: &Piece<'_>, body: &Polytope, index: u32) -> Result<Option<bool>, Error> {
        if (index as usize) < self.surfaces.first_plane() {
            let met = self.met(index)?;
            if let Some(side) = met.side.or_else(|| met.flat.places(body).known()) {
                return Ok(Some(side));
            }
            // An exact surface may touch the piece.
            if met.flat.layer.is_some() {
                return Ok(None);
            }
        }
        self.side(piece, index)
    }

    /// The intersection of a source with the target, in half edges from its centre; `None` if it is empty.
    fn body(&self, source: &Source) -> Option<Polytope> {
        let inward = &self.maps.inward;
        let mut body = Polytope::cube();
        for axis in 0..3 {
            let row = inward.linear[axis].each(|c| c * self.half);
            if inward.is_exact_along(axis) {
                // A mere contact does not count.
                let reach = row.iter().map(|c| c.abs()).sum::<f64>();
                let (low, high) = (self.image[axis] - reach, self.image[axis] + reach);
                if source.high[axis] <= low || source.low[axis] >= high {
                    return None;
                }
            }
            let slack = 2.0 * inward.error[axis] + ROUNDING * row.iter().map(|c| c.abs()).sum::<f64>();
            for (end, sign) in [(source.low[axis], 1.0), (source.high[axis], -1.0)] {
                body = body.clipped(row.each(|c| sign * c), sign * (self.image[axis] - end) + slack)?;
            }
        }
        Some(body)
    }

    /// Adds the planes of the solid's own lattice that the target's image crosses; returns `false` if there
    /// are none, or too many.
    fn add_planes(&self, all: &mut OpenSurfaces) -> bool {
        let before = all.indices().len();
        let first = self.surfaces.first_plane();
        for (index, &(axis, at)) in (first as u32..).zip(&self.surfaces.planes.faces) {
            let at = f64::from(at);
            if self.low[axis] < at && at < self.high[axis] && all.number(index).is_none() {
                return false;
            }
        }
        all.indices().len() > before
    }

    /// Adds the seams between these pieces; returns `false` if there are none, or too many.
    fn add_seams(&self, all: &mut OpenSurfaces, bodies: &[(&Piece<'_>, Polytope)]) -> bool {
        let before = all.indices().len();
        let first = self.surfaces.first_seam();
        let sources = || bodies.iter().map(|(piece, _)| piece.source);
        for low in sources() {
            for axis in 0..3 {
                let at = low.low[axis];
                if !sources().any(|high| high.high[axis] == at) {
                    continue;
                }
                let Ok(number) = self.surfaces.planes.seams.binary_search(&(axis, at as u32)) else {
                    continue;
                };
                if all.number((first + number) as u32).is_none() {
                    return false;
                }
            }
        }
        all.indices().len() > before
    }

    /// Returns a function that has the values of all pieces, and the combinations of signs for which it has a
    /// value; `None` if two pieces differ. Bounds of pairs of surfaces are used if `closely` is set.
    fn joined(
        &mut self,
        all: &OpenSurfaces,
        pieces: &[Piece<'_>],
        values: &[OpenSurfaces],
        closely: bool,
    ) -> Result<Option<(Table, Table)>, Error> {
        let possible = |placed: &[Placed], cell: Cell| {
            possible(all.indices().iter().map(|&index| &placed[index as usize]), cell)
        };
        let around = if closely { possible(&self.surfaces.after, self.cell) } else { Table::FULL };
        let mut joined = Joined::default();
        for (piece, value) in pieces.iter().zip(values) {
            let mut places = [0; OpenSurfaces::MOST];
            for (place, index) in places.iter_mut().zip(value.indices()) {
                *place = all.indices().iter().position(|known| known == index).unwrap_or(0);
            }
            let mut here = around;
            for (i, &index) in all.indices().iter().enumerate() {
                here = here.on_side(i, self.side(piece, index)?);
            }
            if let (true, Some(cell)) = (closely, piece.source.cell) {
                here.0 &= possible(&self.surfaces.before, cell).0;
            }
            if !joined.take(value.table().spread(&places[..value.indices().len()]), here) {
                return Ok(None);
            }
        }
        Ok(Some(joined.tables()))
    }

    /// The intersection of a source with the target; `None` if they only touch.
    fn piece<'p>(&self, source: &'p Source) -> Option<Piece<'p>> {
        let own_low = axes(|axis| source.low[axis].max(self.low[axis]) - self.image[axis]);
        let own_high = axes(|axis| source.high[axis].min(self.high[axis]) - self.image[axis]);
        let (mut low, mut high) = ([-1.0; 3], [1.0; 3]);
        if source.cell.is_some() {
            let (from, to) = self.maps.outward.around(source.low, source.high[0] - source.low[0]);
            for axis in 0..3 {
                let slack = ROUNDING * (1.0 + self.centre[axis].abs() / self.half);
                low[axis] = ((from[axis] - self.centre[axis]) / self.half - slack).max(-1.0);
                high[axis] = ((to[axis] - self.centre[axis]) / self.half + slack).min(1.0);
            }
        }
        // (A NaN separates nothing.)
        let apart = |low: &[f64; 3], high: &[f64; 3]| (0..3).any(|axis| low[axis] >= high[axis]);
        let are_apart = apart(&low, &high) || apart(&own_low, &own_high);
        (!are_apart).then_some(Piece { source, low, high, own_low, own_high })
    }

    /// The side of a surface on which the whole piece lies, if it is known.
    fn side(&mut self, piece: &Piece<'_>, index: u32) -> Result<Option<bool>, Error> {
        if let Some((axis, at)) = self.surfaces.plane(index) {
            let (above, below) =
                (piece.source.low[axis] >= f64::from(at), piece.source.high[axis] <= f64::from(at));
            return Ok((above || below).then_some(above));
        }
        let met = self.met(index)?;
        if met.side.is_some() {
            return Ok(met.side);
        }
        if let Some(side) = met.bounds.and_then(|bounds| self.side_by(&bounds, piece)) {
            return Ok(Some(side));
        }
        Ok(match piece.source.cell {
            Some(cell) => lone(&self.surfaces.before[index as usize], cell)?.side(0),
            None => None,
        })
    }

    /// The data about a surface in the target, computed once.
    fn met(&mut self, index: u32) -> Result<Met, Error> {
        if let Some(met) = self.met.iter().find(|met| met.index == index) {
            return Ok(*met);
        }
        let placed = &self.surfaces.after[index as usize];
        let side = lone(placed, self.cell)?.side(0);
        let bounds = if side.is_none() { Bounds::of(placed, self.cell) } else { None };
        let tangent = placed.tangent(centre(self.cell), half_edge(self.cell));
        let flat = tangent.map_or(Flat::ANY, |Tangent { gradient, low, high }| {
            // (The ends are moved outward, and so are the bounds.)
            let layer = placed.layer_slack().map(|slack| 3.0 * slack);
            Flat { gradient, low, high, layer }
        });
        let met = Met { index, side, bounds, flat };
        memory::push(&mut self.met, met)?;
        Ok(met)
    }

    /// The side of a surface, by bounds over the boxes around a piece.
    fn side_by(&self, bounds: &Bounds, piece: &Piece<'_>) -> Option<bool> {
        let Bounds { gradient, squares, low, high } = *bounds;
        let size =
            gradient.iter().chain(&squares).map(|c| 2.0 * c.abs()).sum::<f64>() + low.abs() + high.abs();
        let (mut here, mut bent) = ((0.0, 0.0), (0.0, 0.0));
        for axis in 0..3 {
            let ends = (piece.low[axis], piece.high[axis]);
            here = sum(here, parabola(gradient[axis], squares[axis], ends));
            bent = sum(bent, parabola(0.0, squares[axis], ends));
        }
        for (i, (a, b)) in [(0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
            let factor = 2.0 * squares[3 + i];
            let corners = [piece.low[a], piece.high[a]]
                .each(|x| [piece.low[b], piece.high[b]].each(|y| factor * x * y));
            let corners = corners.as_flattened();
            let ends = (
                corners.iter().copied().fold(f64::INFINITY, f64::min),
                corners.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            );
            (here, bent) = (sum(here, ends), sum(bent, ends));
        }
        // The same along the axes of the solid's own frame.
        let rows = &self.maps.outward.linear;
        let mut slack = ROUNDING * size;
        let (mut there, mut far) = (bent, 0.0);
        for axis in 0..3 {
            let parts = axes(|i| gradient[i] * rows[i][axis] / self.half);
            let (slope, steep) = ((parts[0] + parts[1]) + parts[2], parts.each(f64::abs).iter().sum::<f64>());
            let ends = (piece.own_low[axis], piece.own_high[axis]);
            there = sum(there, parabola(slope, 0.0, ends));
            let reach = ends.0.abs().max(ends.1.abs()) + self.image[axis].abs();
            far += steep * (ROUNDING * reach + 4.0 * self.maps.inward.error[axis]);
        }
        slack += far;
        let (least, most) = (here.0.max(there.0 - far), here.1.min(there.1 + far));
        // (A NaN proves nothing.)
        if least + low - slack >= 0.0 {
            Some(true)
        } else if most + high + slack <= 0.0 {
            Some(false)
        } else {
            None
        }
    }
}

fn sum(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0 + b.0, a.1 + b.1)
}

/// The least and the greatest value of slope · x + bend · x² between two ends.
fn parabola(slope: f64, bend: f64, ends: (f64, f64)) -> (f64, f64) {
    let at = |x: f64| x * (slope + bend * x);
    let (a, b) = (at(ends.0), at(ends.1));
    let (mut least, mut most) = (a.min(b), a.max(b));
    let top = -0.5 * slope / bend;
    if ends.0 < top && top < ends.1 {
        (least, most) = (least.min(at(top)), most.max(at(top)));
    }
    (least, most)
}

impl Bounds {
    /// `None` for functions of the host.
    fn of(placed: &Placed, cell: Cell) -> Option<Bounds> {
        let (centre, half) = (centre(cell), half_edge(cell));
        Some(match placed.taylor(centre, half) {
            Some(taylor) => {
                let (low, high) = (taylor.f.value - taylor.f.error, taylor.f.value + taylor.f.error);
                Bounds { gradient: taylor.f.gradient, squares: taylor.f.squares, low, high }
            }
            None => {
                let Tangent { gradient, low, high } = placed.tangent(centre, half)?;
                Bounds { gradient, squares: [0.0; 6], low, high }
            }
        })
    }
}
