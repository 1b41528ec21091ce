//! Meshes in single precision, as STL files have them: what rounding breaks is mended.
//!
//! Two kinds of steps take turns. Some leave the surface what it is as a set of points: an edge whose ends
//! lie at one place is collapsed, and where a corner of a triangle without area lies on the opposite side,
//! the triangle behind that side gets the corner. The others move vertices to places next to theirs, of which
//! the best is taken.

use super::links::Links;
use super::nearest::TriangleTree;
use super::report::are_on_a_line;
use super::triangle_mesh::TriangleMesh;
use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::exact::sqrt;
use crate::lattice::{Bounds, axes, valid};
use crate::memory;
use alloc::vec::Vec;
use hashbrown::{HashMap, HashSet};

/// A mesh whose coordinates are 32-bit numbers.
#[derive(Debug)]
#[non_exhaustive]
pub struct SinglePrecision {
    /// The mesh. It bears no attributes.
    pub mesh: TriangleMesh,
    /// The farthest that rounding moves a vertex along an axis, in model units.
    pub rounding: f64,
    /// No point of the given mesh is further from this one, and none of this one further from the given mesh,
    /// in model units: proven.
    pub deviation: f64,
    /// Triangles of which rounding made an edge or a point, and which are gone.
    pub collapsed: u64,
    /// Triangles of which rounding made a line, and which were joined to their neighbours.
    pub flipped: u64,
    /// Vertices that were moved, to places next to their nearest ones.
    pub moved: u64,
    /// Triangles without area that are left, and vertices that lie where others do.
    pub degenerate: u64,
    /// Pairs of triangles that intersect each other, as [`TriangleMesh::intersecting_pairs`] counts them.
    pub intersecting_pairs: u64,
}

/// How often steps of the two kinds take turns.
const ROUNDS: usize = 12;

/// Intersecting pairs that one round mends.
const PAIRS: usize = 4096;

/// Intersecting pairs of the given mesh beyond which no pair is mended.
const GIVEN_PAIRS: usize = 1 << 16;

/// Places that are tried in all.
const TRIALS: usize = 1 << 14;

/// Triangles next to a vertex beyond which no place is tried for it.
const CROWD: usize = 2048;

/// How far from a vertex the triangles are looked at that its own may meet, in steps.
const REACH: f64 = 8.0;

impl TriangleMesh {
    /// The mesh with coordinates that are 32-bit numbers, as an STL file has them, without triangles that
    /// rounding makes degenerate and without pairs that it makes intersect, as far as that can be had.
    ///
    /// Vertices are rounded to nearest. Edges whose ends meet are collapsed, and triangles that become lines
    /// are joined to their neighbours, which changes no point of the surface. What is degenerate or
    /// intersects after that is moved apart: vertices go to places next to theirs, in a fixed order, if these
    /// are no further than `tolerance` (model units) from where they were given. A mesh of which rounding
    /// breaks nothing is only rounded, and one whose coordinates are 32-bit numbers already is given back as
    /// it is; of that nothing is counted. What [`deviation`](Self::deviation) was stated grows by what is
    /// added.
    ///
    /// The mesh stays closed and a manifold if it is so. Time is that of
    /// [`intersecting_pairs`](Self::intersecting_pairs), a few times; the work on scans, which may have
    /// thousands of pairs, is bounded, and what is left is told.
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
                    let made = pairs.pairs.iter().map(|pair| sorted(pair.triangles.map(|t| numbers[t as usize])));
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

/// The items of an iterator of unknown length.
fn memory_of<T>(items: impl Iterator<Item = T>) -> Result<Vec<T>, Error> {
    let mut all = Vec::new();
    for item in items {
        memory::push(&mut all, item)?;
    }
    Ok(all)
}

struct Mender<'m> {
    given: &'m [[f64; 3]],
    /// How far a vertex may be from its given place, but for rounding to nearest.
    tolerance: f64,
    at: Vec<[f32; 3]>,
    links: Links,
    /// Triangles without area, ascending.
    flat: Vec<u32>,
    is_moved: Vec<bool>,
    rounding: f64,
    /// How far the surface is from the given one, but for the rounding of this number.
    deviation: f64,
    trials: usize,
}

/// The steps to the places around one: along an axis first, then along two, then along three.
fn places() -> impl Iterator<Item = [f32; 3]> {
    let all = |count: usize| {
        (0..27)
            .map(|k| [k % 3, k / 3 % 3, k / 9].map(|c: u8| f32::from(c) - 1.0))
            .filter(move |way| way.iter().filter(|&&c| c != 0.0).count() == count)
    };
    all(1).chain(all(2)).chain(all(3))
}

fn wide(at: [f32; 3]) -> [f64; 3] {
    at.map(f64::from)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    sqrt((0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum())
}

impl<'m> Mender<'m> {
    fn new(mesh: &'m TriangleMesh, tolerance: f64) -> Result<Mender<'m>, Error> {
        let (mut rounding, mut deviation): (f64, f64) = (0.0, 0.0);
        let mut at = memory::with_capacity(mesh.vertices().len())?;
        for &vertex in mesh.vertices() {
            // (Zeros have no sign.)
            let single = vertex.map(|c| c as f32 + 0.0);
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
        triangle.map(|vertex| wide(self.at[vertex as usize]))
    }

    fn is_flat(&self, triangle: &[u32; 3]) -> bool {
        are_on_a_line(self.corners(triangle))
    }

    /// Collapses and flips until there is nothing more to do. No point of the surface changes.
    fn settle(&mut self, found: &mut SinglePrecision) -> Result<(), Error> {
        loop {
            let before = self.flat.len();
            for number in core::mem::take(&mut self.flat) {
                // (One that was mended with another has an area, or is gone.)
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

    /// Mends a triangle without area. Tells whether it is mended.
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
        // The longest side is the one on which the third corner lies.
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

    /// The mesh, the number of each of its triangles, and how many vertices lie where others do.
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
            // (Others are dropped.)
            let [a, b, c] = triangle.map(|vertex| self.at[vertex as usize]);
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

    /// Moves vertices of triangles without area, of those that lie where others do, and of triangles that
    /// intersect. Tells whether some were moved.
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
            // The triangles near those of the vertex, which may have moved a little since the tree was made.
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
                // (What is no number is not less.)
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
                // (Others may be flat now.)
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

    /// How far it is to the next place: a unit in the last place of the greatest coordinate.
    fn step(&self, at: [f32; 3]) -> f32 {
        let most = at.iter().fold(f32::MIN_POSITIVE, |most, c| most.max(c.abs()));
        most.next_up() - most
    }

    /// Adds the vertices that lie where others do.
    fn add_coincident(&self, wanted: &mut Vec<u32>) -> Result<(), Error> {
        let mut all = memory::with_capacity(self.at.len())?;
        for (vertex, at) in (0u32..).zip(&self.at) {
            if !self.links.around(vertex).is_empty() {
                all.push((at.map(f32::to_bits), vertex));
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

    /// How many triangles at a vertex have no area, how many other vertices of near triangles lie at its
    /// place, and how many pairs of near triangles intersect.
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
