//! Meshes in single precision, as in STL files, with the damage of rounding repaired.
//!
//! Steps of two kinds alternate. Steps of the first kind do not change the surface as a set of points: an
//! edge whose ends coincide is collapsed; and if a corner of a triangle without area lies on the opposite
//! side, the triangle behind that side gets the corner. Steps of the second kind move vertices to adjacent
//! places and keep the best one.

use super::links::Links;
use super::nearest::TriangleTree;
use super::report::are_on_a_line;
use super::triangle_mesh::TriangleMesh;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Bounds, axes, valid};
use crate::memory;
use alloc::vec::Vec;
use hashbrown::{HashMap, HashSet};

/// A mesh whose coordinates are 32-bit numbers, with the changes that rounding required.
#[derive(Debug)]
#[non_exhaustive]
pub struct SinglePrecision {
    /// The mesh. It has no attributes.
    pub mesh: TriangleMesh,
    /// Maximum distance along an axis by which rounding moves a vertex, in model units.
    pub rounding: f64,
    /// Proven maximum distance, in model units, of points of the given mesh from this mesh and of points of
    /// this mesh from the given one.
    pub deviation: f64,
    /// Number of triangles that rounding turned into an edge or a point, and that were removed.
    pub collapsed: u64,
    /// Number of triangles that rounding turned into a line, and that were joined to their neighbours.
    pub flipped: u64,
    /// Number of vertices that were moved to places next to their nearest ones.
    pub moved: u64,
    /// Number of remaining triangles without area, and of vertices that coincide with others.
    pub degenerate: u64,
    /// Number of remaining pairs of intersecting triangles, as [`TriangleMesh::intersecting_pairs`] counts
    /// them.
    pub intersecting_pairs: u64,
}

/// Number of rounds of both kinds of steps.
const ROUNDS: usize = 12;

/// Maximum number of intersecting pairs that are mended in one round.
const PAIRS: usize = 4096;

/// Maximum number of intersecting pairs of the given mesh; with more, no pair is mended.
const GIVEN_PAIRS: usize = 1 << 16;

/// Maximum number of places that are tried in total.
const TRIALS: usize = 1 << 14;

/// Maximum number of triangles near a vertex; with more, no place is tried for the vertex.
const CROWD: usize = 2048;

/// Distance from a vertex within which triangles are tested against the vertex's own triangles, in steps.
const REACH: f64 = 8.0;

impl TriangleMesh {
    /// Returns the mesh with 32-bit coordinates, as in an STL file, as far as possible without triangles that
    /// rounding makes degenerate and without pairs that rounding makes intersect.
    ///
    /// Vertices are rounded to nearest. Edges whose ends coincide are collapsed, and triangles that become
    /// lines are joined to their neighbours; neither changes a point of the surface. Vertices at the
    /// remaining degenerate or intersecting triangles are then moved to adjacent places, in a fixed order, if
    /// these places are within `tolerance` (model units) of the given ones. If rounding breaks nothing, the
    /// mesh is only rounded. A mesh whose coordinates are 32-bit numbers already is returned unchanged, and
    /// nothing is counted. A stated [`deviation`](Self::deviation) grows by the deviation that is added.
    ///
    /// Pairs of triangles that intersect in the given mesh are not mended: they stay, and are counted.
    ///
    /// A closed mesh stays closed, and a manifold stays a manifold. The time is a few times that of
    /// [`intersecting_pairs`](Self::intersecting_pairs). The work on scans, which may have thousands of
    /// intersecting pairs, is bounded, and the defects that remain are counted.
    ///
    /// ```
    /// use leafless::{Control, TriangleMesh};
    /// // A tetrahedron of which one corner is cut off by less than single precision tells.
    /// let [e, x] = [1e-9, 1.0];
    /// let vertices = vec![[x, x, x], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0], [1.0, 1.0, 2.0], [x + e, x, x]];
    /// let triangles = vec![[0, 2, 4], [4, 2, 1], [0, 4, 3], [4, 1, 3], [1, 2, 3], [2, 0, 3]];
    /// let mesh = TriangleMesh::new(vertices, triangles)?;
    /// let single = mesh.in_single_precision(1e-3, &Control::default())?;
    /// assert_eq!((single.mesh.triangles().len(), single.collapsed, single.degenerate), (4, 2, 0));
    /// assert!(single.mesh.report()?.is_closed() && single.deviation < 2e-9);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] beyond the range of 32-bit floating point numbers, or if `tolerance` is negative
    /// or not a number; [`Error::OutOfMemory`] or [`Error::Cancelled`].
    pub fn in_single_precision(
        &self,
        tolerance: f64,
        control: &Control<'_>,
    ) -> Result<SinglePrecision, Error> {
        valid::tolerance("tolerance", tolerance)?;
        let job = Job::new(control);
        job.check()?;
        let quiet = Control { progress: None, ..*control };
        let mut mender = Mender::new(self, tolerance)?;
        let mut found = SinglePrecision {
            mesh: TriangleMesh::new(Vec::new(), Vec::new())?,
            rounding: mender.rounding,
            deviation: mender.deviation,
            collapsed: 0,
            flipped: 0,
            moved: 0,
            degenerate: 0,
            intersecting_pairs: 0,
        };
        let rounds = if mender.deviation > 0.0 { ROUNDS } else { 0 };
        if rounds == 0 {
            found.mesh = mender.mesh()?.0;
        }
        let mut given = None;
        for round in 0..rounds {
            mender.settle(&mut found)?;
            let (mesh, numbers, welded) = mender.mesh()?;
            let pairs = mesh.intersecting_pairs(GIVEN_PAIRS + PAIRS, &quiet)?;
            found.degenerate = mender.flat.len() as u64 + welded;
            found.intersecting_pairs = pairs.count;
            // Pairs that intersect without rounding are left alone.
            if pairs.count > 0 && given.is_none() {
                given = Some(self.given_pairs(&quiet)?);
            }
            let made = match &given {
                Some(Some(given)) => {
                    let made =
                        pairs.pairs.iter().map(|pair| sorted(pair.triangles.each(|t| numbers[t as usize])));
                    memory_of(made.filter(|pair| !given.contains(pair)).take(PAIRS))?
                }
                _ => Vec::new(),
            };
            let is_done = found.degenerate == 0 && made.is_empty();
            let is_last = is_done || round + 1 == rounds || {
                let in_pairs = memory_of(made.iter().flatten().copied())?;
                let tree = mesh.triangle_tree(&quiet)?;
                !mender.part(&tree, &numbers, &in_pairs, welded > 0, &quiet)?
            };
            found.mesh = mesh;
            if is_last {
                break;
            }
        }
        found.deviation = mender.deviation * (1.0 + 1e-12);
        found.moved = mender.is_moved.iter().filter(|&&is_moved| is_moved).count() as u64;
        if self.deviation() > 0.0 {
            let stated = (self.deviation() + found.deviation).next_up();
            found.mesh = found.mesh.with_deviation(stated)?;
        }
        job.advance(WHOLE);
        Ok(found)
    }
}

impl TriangleMesh {
    /// The pairs of triangles that intersect, if there are at most [`GIVEN_PAIRS`].
    fn given_pairs(&self, control: &Control<'_>) -> Result<Option<HashSet<[u32; 2]>>, Error> {
        let found = self.intersecting_pairs(GIVEN_PAIRS, control)?;
        if !found.is_complete || found.count > GIVEN_PAIRS as u64 {
            return Ok(None);
        }
        let mut all = HashSet::new();
        all.try_reserve(found.pairs.len()).map_err(|_| Error::OutOfMemory)?;
        all.extend(found.pairs.iter().map(|pair| sorted(pair.triangles)));
        Ok(Some(all))
    }
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Collects the items of an iterator of unknown length.
fn memory_of<T>(items: impl Iterator<Item = T>) -> Result<Vec<T>, Error> {
    let mut all = Vec::new();
    for item in items {
        memory::push(&mut all, item)?;
    }
    Ok(all)
}

struct Mender<'m> {
    given: &'m [[f64; 3]],
    /// Maximum distance of a vertex from its given place, not counting the rounding to nearest.
    tolerance: f64,
    at: Vec<[f32; 3]>,
    links: Links,
    /// Triangles without area, ascending.
    flat: Vec<u32>,
    is_moved: Vec<bool>,
    rounding: f64,
    /// Maximum distance of the surface from the given one, up to the rounding of this number.
    deviation: f64,
    trials: usize,
}

/// Returns the steps to the adjacent places: along one axis first, then along two, then along three.
fn places() -> impl Iterator<Item = [f32; 3]> {
    let all = |count: usize| {
        (0..27)
            .map(|k| [k % 3, k / 3 % 3, k / 9].each(|c: u8| f32::from(c) - 1.0))
            .filter(move |way| way.iter().filter(|&&c| c != 0.0).count() == count)
    };
    all(1).chain(all(2)).chain(all(3))
}

fn wide(at: [f32; 3]) -> [f64; 3] {
    at.each(f64::from)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    sqrt((0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum())
}

impl<'m> Mender<'m> {
    fn new(mesh: &'m TriangleMesh, tolerance: f64) -> Result<Mender<'m>, Error> {
        let (mut rounding, mut deviation): (f64, f64) = (0.0, 0.0);
        let mut at = memory::with_capacity(mesh.vertices().len())?;
        for &vertex in mesh.vertices() {
            // (Makes -0.0 equal to 0.0.)
            let single = vertex.each(|c| c as f32 + 0.0);
            if !single.iter().all(|c| c.is_finite()) {
                let problem = "has a coordinate beyond the range of 32-bit floating point numbers";
                return Err(Error::Argument { name: "mesh", problem });
            }
            let off: [f64; 3] = axes(|k| (vertex[k] - f64::from(single[k])).abs());
            rounding = off.iter().fold(rounding, |most, off| most.max(*off));
            deviation = deviation.max(distance(off, [0.0; 3]));
            at.push(single);
        }
        let links = Links::new(mesh.triangles(), at.len())?;
        let is_moved = memory::filled(at.len(), false)?;
        let (given, flat) = (mesh.vertices(), Vec::new());
        let mut mender =
            Mender { given, tolerance, at, links, flat, is_moved, rounding, deviation, trials: TRIALS };
        let flat =
            mender.links.all().filter(|(_, triangle)| mender.is_flat(triangle)).map(|(number, _)| number);
        mender.flat = memory_of(flat)?;
        Ok(mender)
    }

    fn corners(&self, triangle: &[u32; 3]) -> [[f64; 3]; 3] {
        triangle.each(|vertex| wide(self.at[vertex as usize]))
    }

    fn is_flat(&self, triangle: &[u32; 3]) -> bool {
        are_on_a_line(self.corners(triangle))
    }

    /// Collapses and flips until nothing changes. No point of the surface changes.
    fn settle(&mut self, found: &mut SinglePrecision) -> Result<(), Error> {
        loop {
            let before = self.flat.len();
            for number in core::mem::take(&mut self.flat) {
                // (A triangle that was repaired together with another one has an area, or was removed.)
                let Some(triangle) = self.links.triangle(number) else { continue };
                if self.is_flat(&triangle) && !self.mend(number, &triangle, found)? {
                    memory::push(&mut self.flat, number)?;
                }
            }
            if self.flat.is_empty() || self.flat.len() == before {
                return Ok(());
            }
        }
    }

    /// Repairs a triangle without area. Returns whether it was repaired.
    fn mend(&mut self, number: u32, triangle: &[u32; 3], found: &mut SinglePrecision) -> Result<bool, Error> {
        let ends = |side: usize| [triangle[side], triangle[(side + 1) % 3]];
        for [from, to] in (0..3).map(ends) {
            if self.at[from as usize] == self.at[to as usize]
                && (self.links.collapse(to, from)? || self.links.collapse(from, to)?)
            {
                found.collapsed += 2;
                return Ok(true);
            }
        }
        // The third corner lies on the longest side.
        let corners = self.corners(triangle);
        let long = |side: usize| distance(corners[side], corners[(side + 1) % 3]);
        let side = (1..3).fold(0, |best, side| if long(side) > long(best) { side } else { best });
        let apex = self.at[triangle[(side + 2) % 3] as usize];
        if ends(side).iter().any(|&end| self.at[end as usize] == apex) {
            return Ok(false);
        }
        let Some((other, far)) = self.links.across(number, side) else { return Ok(false) };
        let is_other_flat = self.links.triangle(other).is_none_or(|other| self.is_flat(&other));
        if is_other_flat || self.at[far as usize] == apex || !self.links.flip(number, side)? {
            return Ok(false);
        }
        found.flipped += 1;
        Ok(true)
    }

    /// Returns the mesh, the number of each of its triangles, and the number of vertices that coincide with
    /// others.
    fn mesh(&self) -> Result<(TriangleMesh, Vec<u32>, u64), Error> {
        let mut places = memory::filled(self.at.len(), u32::MAX)?;
        let (mut vertices, mut triangles, mut numbers) = (Vec::new(), Vec::new(), Vec::new());
        for (number, triangle) in self.links.all() {
            let mut corners = [0; 3];
            for (corner, vertex) in corners.iter_mut().zip(triangle) {
                let place = &mut places[vertex as usize];
                if *place == u32::MAX {
                    *place = vertices.len() as u32;
                    memory::push(&mut vertices, wide(self.at[vertex as usize]))?;
                }
                *corner = *place;
            }
            // (Other triangles are dropped.)
            let [a, b, c] = triangle.each(|vertex| self.at[vertex as usize]);
            if a != b && b != c && c != a {
                memory::push(&mut numbers, number)?;
            }
            memory::push(&mut triangles, corners)?;
        }
        let count = vertices.len();
        let mesh = TriangleMesh::new(vertices, triangles)?;
        let welded = (count - mesh.vertices().len()) as u64;
        Ok((mesh, numbers, welded))
    }

    /// Moves vertices of triangles without area, vertices that coincide with others, and vertices of
    /// intersecting triangles. Returns whether any were moved.
    fn part(
        &mut self,
        tree: &TriangleTree<'_>,
        numbers: &[u32],
        in_pairs: &[u32],
        is_welded: bool,
        control: &Control<'_>,
    ) -> Result<bool, Error> {
        let mut wanted = Vec::new();
        let triangles = self.flat.iter().chain(in_pairs).filter_map(|&number| self.links.triangle(number));
        for vertex in triangles.flatten() {
            memory::push(&mut wanted, vertex)?;
        }
        if is_welded {
            self.add_coincident(&mut wanted)?;
        }
        let mut farthest: f64 = 0.0;
        let mut starts: HashMap<u32, [f32; 3]> = HashMap::new();
        for vertex in wanted {
            let start = self.at[vertex as usize];
            let step = self.step(start);
            // The triangles near those of the vertex. They may have moved a little since the tree was made.
            let own = self.links.around(vertex);
            let reach = REACH * f64::from(step);
            let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
            for corner in own.iter().filter_map(|&number| self.links.triangle(number)).flatten() {
                let at = wide(self.at[corner as usize]);
                (min, max) = (axes(|k| min[k].min(at[k] - reach)), axes(|k| max[k].max(at[k] + reach)));
            }
            let Some(around) = Bounds::new(min, max) else { continue };
            let mut near = memory::copied(own)?;
            let mut failed = None;
            tree.in_box(&around, &mut |triangle| {
                failed = failed.take().or(memory::push(&mut near, numbers[triangle as usize]).err());
            });
            if let Some(error) = failed {
                return Err(error);
            }
            near.sort_unstable();
            near.dedup();
            if near.len() > CROWD {
                continue;
            }
            let mut least = self.conflicts(vertex, &near, control)?;
            if least == 0 {
                continue;
            }
            let mut best = start;
            for way in places() {
                let to: [f32; 3] = axes(|k| start[k] + step * way[k]);
                // (False for NaN.)
                let is_near = distance(wide(to), self.given[vertex as usize]) <= self.tolerance;
                if !is_near {
                    continue;
                }
                let Some(left) = self.trials.checked_sub(1) else { break };
                self.trials = left;
                self.at[vertex as usize] = to;
                let conflicts = self.conflicts(vertex, &near, control)?;
                if conflicts < least {
                    (least, best) = (conflicts, to);
                }
                if least == 0 {
                    break;
                }
            }
            self.at[vertex as usize] = best;
            if best != start {
                starts.try_reserve(1)?;
                let first = *starts.entry(vertex).or_insert(start);
                farthest = farthest.max(distance(wide(first), wide(best)));
                self.is_moved[vertex as usize] = true;
                // (Other triangles may be flat now.)
                for &number in self.links.around(vertex) {
                    memory::push(&mut self.flat, number)?;
                }
            }
        }
        self.flat.sort_unstable();
        self.flat.dedup();
        self.deviation += farthest;
        Ok(!starts.is_empty())
    }

    /// Returns the distance to the adjacent place: a unit in the last place of the greatest coordinate.
    fn step(&self, at: [f32; 3]) -> f32 {
        let most = at.iter().fold(f32::MIN_POSITIVE, |most, c| most.max(c.abs()));
        most.next_up() - most
    }

    /// Adds the vertices that coincide with others.
    fn add_coincident(&self, wanted: &mut Vec<u32>) -> Result<(), Error> {
        let mut all = memory::with_capacity(self.at.len())?;
        for (vertex, at) in (0u32..).zip(&self.at) {
            if !self.links.around(vertex).is_empty() {
                all.push((at.each(f32::to_bits), vertex));
            }
        }
        all.sort_unstable();
        for same in all.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1) {
            for &(_, vertex) in same {
                memory::push(wanted, vertex)?;
            }
        }
        Ok(())
    }

    /// Returns the number of triangles at a vertex without area, plus the number of other vertices of near
    /// triangles at the same place, plus the number of intersecting pairs of near triangles.
    fn conflicts(&self, vertex: u32, near: &[u32], control: &Control<'_>) -> Result<u64, Error> {
        let own = self.links.around(vertex).iter().filter_map(|&number| self.links.triangle(number));
        let flat = own.filter(|triangle| self.is_flat(triangle)).count() as u64;
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        let mut same = false;
        for triangle in near.iter().filter_map(|&number| self.links.triangle(number)) {
            let first = vertices.len() as u32;
            for corner in triangle {
                same |= corner != vertex && self.at[corner as usize] == self.at[vertex as usize];
                memory::push(&mut vertices, wide(self.at[corner as usize]))?;
            }
            memory::push(&mut triangles, [first, first + 1, first + 2])?;
        }
        let mesh = TriangleMesh::new(vertices, triangles)?;
        Ok(flat + u64::from(same) + mesh.intersecting_pairs(0, control)?.count)
    }
}
