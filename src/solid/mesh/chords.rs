//! Rays through cell centres: their intervals inside the solid.
//!
//! Every triangle is scan-converted once for each direction. The two centres between which a ray pierces a
//! triangle are exact. The place between them is known to a small part of the universe's edge; steep
//! triangles take exact arithmetic. The winding numbers along a ray then say where it is inside. So a ray of
//! a closed mesh always has as many starts as ends.

use super::crossing::Projection;
use super::placed::Placed;
use crate::dexel::{Beam, BeamEnd, Mark, OTHERS, encoded, within};
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use crate::mesh::FillRule;
use alloc::vec::Vec;
use core::ops::Range;

/// The crossing of a ray and a triangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit {
    /// The place along the ray, in finest cells from the universe's lower face.
    pub(super) at: f64,
    ray: u32,
    /// Twice the triangle's number, plus 1 if the winding number grows.
    triangle: u32,
}

impl Hit {
    fn new(at: f64, ray: u32, triangle: u32, step: i32) -> Hit {
        Hit { at, ray, triangle: triangle << 1 | u32::from(step > 0) }
    }

    /// The triangle that is pierced.
    pub(super) fn triangle(&self) -> u32 {
        self.triangle >> 1
    }

    /// The change of the winding number: 1 or −1.
    #[inline(always)]
    pub(super) fn step(&self) -> i32 {
        2 * (self.triangle & 1) as i32 - 1
    }
}

/// Rows of rays in a band, as in a tile of `dexelize`. Rows that lie in several bands use all triangles.
const BAND: i32 = 32;

/// With fewer triangles than this, a cell has no bands: each triangle is tested.
const MANY: usize = 1 << 10;

/// Scratch memory that is kept from cell to cell.
#[derive(Default)]
pub(super) struct Chords {
    floor: Vec<i32>,
    rows: Vec<i32>,
    hits: Vec<Hit>,
    /// First the number of hits of each ray, stored two places behind the ray. Then the place where the hits
    /// of each ray begin.
    starts: Vec<u32>,
    sorted: Vec<Hit>,
    bands: Bands,
}

/// The triangles of a cell, sorted by the bands of rows in which rays may pierce them.
#[derive(Default)]
struct Bands {
    /// The cell's lowest finest cell, its number of triangles, and the axis of the rays. (Cells with the same
    /// lowest finest cell are nested, so that an equal number of triangles means the same triangles.)
    of: Option<([i32; 3], usize, usize)>,
    starts: Vec<u32>,
    triangles: Vec<u32>,
    /// The triangles about the layer of the lowest centres.
    floor: Vec<u32>,
}

impl Bands {
    /// Returns the triangles that may change winding numbers within the layer of the lowest centres.
    fn floor<'l>(&'l mut self, rays: &Rays<'l>, bundle: &Bundle) -> Result<&'l [u32], Error> {
        if rays.triangles.len() < MANY {
            return Ok(rays.triangles);
        }
        self.update(rays, bundle)?;
        Ok(&self.floor)
    }

    fn update(&mut self, rays: &Rays<'_>, bundle: &Bundle) -> Result<(), Error> {
        let &Rays { placed, at, triangles, .. } = rays;
        let of = Some((at, triangles.len(), bundle.w));
        if self.of != of {
            self.of = None;
            self.sort(placed, triangles, bundle.v)?;
            self.floor.clear();
            for &triangle in triangles {
                let [low, high] = placed.rank_box(triangle);
                if low[bundle.w] <= at[bundle.w] && at[bundle.w] < high[bundle.w] {
                    memory::push(&mut self.floor, triangle)?;
                }
            }
            self.of = of;
        }
        Ok(())
    }

    /// Returns the triangles that rays of these rows may pierce, ascending.
    fn list<'l>(&'l mut self, rays: &Rays<'l>, bundle: &Bundle) -> Result<&'l [u32], Error> {
        let band = bundle.rows.start / BAND;
        if rays.triangles.len() < MANY || (bundle.rows.end - 1) / BAND != band {
            return Ok(rays.triangles);
        }
        self.update(rays, bundle)?;
        let [first, end] =
            [0, 1].each(|i| self.starts.get(band as usize + i).map_or(0, |&start| start as usize));
        Ok(&self.triangles[first..end])
    }

    fn sort(&mut self, placed: &Placed, triangles: &[u32], axis: usize) -> Result<(), Error> {
        let last = (placed.frame.cells() as i32 - 1) / BAND;
        let bands = |triangle: u32| {
            let [low, high] = placed.rank_box(triangle);
            (low[axis] < high[axis]).then(|| {
                (
                    (low[axis].max(0) / BAND).min(last + 1) as usize,
                    ((high[axis] - 1) / BAND).min(last) as usize,
                )
            })
        };
        refill(&mut self.starts, last as usize + 3)?;
        for &triangle in triangles {
            if let Some((first, last)) = bands(triangle) {
                for band in first..=last {
                    self.starts[band + 2] += 1;
                }
            }
        }
        for i in 2..self.starts.len() {
            self.starts[i] += self.starts[i - 1];
        }
        refill(&mut self.triangles, self.starts.last().map_or(0, |&count| count as usize))?;
        for &triangle in triangles {
            if let Some((first, last)) = bands(triangle) {
                for band in first..=last {
                    let place = &mut self.starts[band + 1];
                    self.triangles[*place as usize] = triangle;
                    *place += 1;
                }
            }
        }
        Ok(())
    }
}

/// A cell: its lowest finest cell, the triangles that cut it, and the winding number of its lowest centre.
#[derive(Clone, Copy)]
pub(super) struct Rays<'t> {
    pub(super) placed: &'t Placed,
    pub(super) at: [i32; 3],
    pub(super) triangles: &'t [u32],
    pub(super) winding: i32,
    pub(super) fill: FillRule,
}

/// The rays of a beam in the mesh's integers.
pub(super) struct Bundle {
    /// The axis along which the rays run, then the other two, ascending.
    pub(super) w: usize,
    pub(super) u: usize,
    pub(super) v: usize,
    pub(super) columns: Range<i32>,
    pub(super) rows: Range<i32>,
    pub(super) span: Range<i32>,
}

impl Bundle {
    pub(super) fn new(beam: &Beam) -> Bundle {
        let [u, v] = OTHERS[beam.axis()];
        let signed = |range: Range<u32>| range.start as i32..range.end as i32;
        let [columns, rows] = beam.rays().each(signed);
        Bundle { w: beam.axis(), u, v, columns, rows, span: signed(beam.span()) }
    }

    fn width(&self) -> usize {
        self.columns.len()
    }

    fn index(&self, column: i32, row: i32) -> usize {
        (row - self.rows.start) as usize * self.width() + (column - self.columns.start) as usize
    }
}

impl Chords {
    /// The most triangles that a hit can distinguish, with one bit left.
    pub(super) const MOST: u32 = 1 << 31;

    /// Adds the intervals of all rays of a beam in a cell.
    pub(super) fn find(&mut self, rays: Rays<'_>, beam: &mut Beam) -> Result<(), Error> {
        let bundle = Bundle::new(beam);
        self.trace(&rays, &bundle)?;
        self.walk(&rays, &bundle, beam)
    }

    /// Finds all places where rays of a beam pierce triangles in a cell.
    pub(super) fn trace(&mut self, rays: &Rays<'_>, bundle: &Bundle) -> Result<(), Error> {
        self.wind_floor(rays, bundle)?;
        self.pierce(rays, bundle)?;
        self.sort()
    }

    /// Returns the winding number of a ray's lowest centre, and the ray's hits in ascending order.
    pub(super) fn traced(&self, bundle: &Bundle, column: i32, row: i32) -> (i32, &[Hit]) {
        let index = bundle.index(column, row);
        (self.floor[index], &self.sorted[self.starts[index] as usize..self.starts[index + 1] as usize])
    }

    /// Computes the winding numbers of the lowest centres on all rays: from the cell's lowest centre along v,
    /// then along u.
    fn wind_floor(&mut self, rays: &Rays<'_>, bundle: &Bundle) -> Result<(), Error> {
        let &Rays { placed, at, winding, .. } = rays;
        let &Bundle { w, u, v, ref columns, ref rows, .. } = bundle;
        refill(&mut self.floor, columns.len() * rows.len())?;
        refill(&mut self.rows, rows.len())?;
        let floor = at[w];
        for &triangle in self.bands.floor(rays, bundle)? {
            let [low, high] = placed.rank_box(triangle);
            if !(low[w] <= floor && floor < high[w]) {
                continue;
            }
            let corners = placed.corners(triangle);
            if low[u] <= at[u] && at[u] < high[u] && high[v] > at[v] && low[v] < rows.end {
                let seen = &mut Projection::new(placed, triangle, corners, v);
                let (column, row) = ordered((u, at[u]), (w, floor));
                if let Some((above, step)) = pierced(seen, column, row)
                    && at[v] < above
                    && above < rows.end
                {
                    self.rows[(above - rows.start).max(0) as usize] += step;
                }
            }
            if high[u] <= at[u] || low[u] >= columns.end || high[v] <= rows.start || low[v] >= rows.end {
                continue;
            }
            let seen = &mut Projection::new(placed, triangle, corners, u);
            for row in low[v].max(rows.start)..high[v].min(rows.end) {
                let (p, q) = ordered((v, row), (w, floor));
                if let Some((above, step)) = pierced(seen, p, q)
                    && at[u] < above
                    && above < columns.end
                {
                    self.floor[bundle.index(above.max(columns.start), row)] += step;
                }
            }
        }
        let mut base = winding;
        for (row, step) in self.floor.chunks_exact_mut(columns.len().max(1)).zip(&self.rows) {
            base += step;
            let mut winding = base;
            for place in row {
                winding += *place;
                *place = winding;
            }
        }
        Ok(())
    }

    /// Finds all places where rays pierce triangles inside the cell.
    fn pierce(&mut self, rays: &Rays<'_>, bundle: &Bundle) -> Result<(), Error> {
        let &Rays { placed, .. } = rays;
        let &Bundle { w, u, v, ref columns, ref rows, ref span } = bundle;
        let Chords { hits, starts, bands, .. } = self;
        hits.clear();
        refill(starts, columns.len() * rows.len() + 2)?;
        let cells = f64::from(placed.frame.cells());
        let (bottom, top) = (f64::from(span.start), f64::from(span.end));
        for &triangle in bands.list(rays, bundle)? {
            let [low, high] = placed.rank_box(triangle);
            let meets = |axis: usize, range: &Range<i32>| {
                low[axis] < high[axis] && low[axis] < range.end && high[axis] > range.start
            };
            // A triangle below the first centre may pierce a ray above the lower face.
            if !(meets(u, columns) && meets(v, rows)) || low[w] > span.end || high[w] < span.start {
                continue;
            }
            let mut seen = Projection::new(placed, triangle, placed.corners(triangle), w);
            let (first, end) = seen.rows();
            for row in first.max(rows.start)..end.min(rows.end) {
                let Some(found) = seen.span(row) else { continue };
                let (first, end) = (found.first.max(columns.start), found.end.min(columns.end));
                if first >= end {
                    continue;
                }
                hits.try_reserve((end - first) as usize)?;
                let index = bundle.index(first, row) as u32;
                for (ray, column) in (index..).zip(first..end) {
                    let (above, at) = seen.crossing(column, row, found.step);
                    if above < span.start || above > span.end {
                        continue;
                    }
                    let at = within(at, above, cells);
                    if bottom < at && at < top {
                        hits.push(Hit::new(at, ray, triangle, found.step));
                        starts[ray as usize + 2] += 1;
                    }
                }
            }
        }
        Ok(())
    }

    /// Sorts the hits by ray, and the hits of a ray by place.
    fn sort(&mut self) -> Result<(), Error> {
        let Chords { hits, starts, sorted, .. } = self;
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        // (Hits of earlier cells that are left there are overwritten.)
        if let Some(more) = hits.len().checked_sub(sorted.len()) {
            sorted.try_reserve(more)?;
            sorted.extend_from_slice(&hits[sorted.len()..]);
        }
        for hit in hits.iter() {
            let place = &mut starts[hit.ray as usize + 1];
            sorted[*place as usize] = *hit;
            *place += 1;
        }
        for range in starts.windows(2) {
            if range[0] + 1 < range[1] {
                // (Ties are broken by triangle, so that the order of triangles in a cell's list does not
                // matter.)
                sorted[range[0] as usize..range[1] as usize]
                    .sort_unstable_by(|a, b| a.at.total_cmp(&b.at).then(a.triangle.cmp(&b.triangle)));
            }
        }
        Ok(())
    }

    /// Follows the winding number along each ray, and adds its intervals to the beam.
    fn walk(&self, rays: &Rays<'_>, bundle: &Bundle, beam: &mut Beam) -> Result<(), Error> {
        let Bundle { columns, rows, span, .. } = bundle;
        let lowest = f64::from(span.start) + 0.5;
        let mut index = 0;
        for row in rows.clone() {
            for column in columns.clone() {
                let hits = &self.sorted[self.starts[index] as usize..self.starts[index + 1] as usize];
                let mut winding = self.floor[index];
                index += 1;
                // Back from the lowest centre to the face.
                winding -= hits.iter().take_while(|hit| hit.at <= lowest).map(Hit::step).sum::<i32>();
                let mut inside = rays.fill.encloses(winding);
                if hits.is_empty() && !inside {
                    continue;
                }
                let mut start = BeamEnd::between(span.start as u32);
                let ray = [column as u32, row as u32];
                for hit in hits {
                    winding += hit.step();
                    let now = rays.fill.encloses(winding);
                    if now != inside {
                        let end = end(rays.placed, hit, now, beam.is_marked());
                        if now {
                            start = end;
                        } else {
                            beam.push(ray, start, end)?;
                        }
                        inside = now;
                    }
                }
                if inside {
                    beam.push(ray, start, BeamEnd::between(span.end as u32))?;
                }
            }
        }
        Ok(())
    }
}

/// Returns the end of an interval at a hit. `starts` says whether the interval starts there.
pub(super) fn end(placed: &Placed, hit: &Hit, starts: bool, marked: bool) -> BeamEnd {
    if !marked {
        return BeamEnd { at: hit.at, mark: Mark::NONE };
    }
    let triangle = hit.triangle();
    let mark = Mark { surface: triangle, normal: encoded(normal_of(placed, triangle)) };
    // With step −1, the ray passes the triangle upward along its normal: the normal points up.
    let leads_up = hit.step() < 0;
    BeamEnd { at: hit.at, mark: if starts == leads_up { mark.flipped() } else { mark } }
}

/// A projection's column and row, from two axes and the places on them.
fn ordered((a, at_a): (usize, i32), (b, at_b): (usize, i32)) -> (i32, i32) {
    if a < b { (at_a, at_b) } else { (at_b, at_a) }
}

/// The first centre above the triangle on a line, and the change of the winding number when the line passes
/// it.
fn pierced(seen: &mut Projection<'_>, column: i32, row: i32) -> Option<(i32, i32)> {
    let span = seen.span(row).filter(|span| span.first <= column && column < span.end)?;
    Some((seen.above(column, row, span.step), span.step))
}

fn normal_of(placed: &Placed, triangle: u32) -> [f64; 3] {
    let [a, b, c] = placed.original(triangle).each(glam::DVec3::from_array);
    (b - a).cross(c - a).to_array()
}

fn refill<T: Copy + Default>(list: &mut Vec<T>, count: usize) -> Result<(), Error> {
    list.clear();
    list.try_reserve(count)?;
    list.resize(count, T::default());
    Ok(())
}
