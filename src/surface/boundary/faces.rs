//! The boundary in the faces of cells: arcs of surfaces, and the points where two surfaces meet.
//!
//! In a face of a simple cell each surface that is present is a single arc between two points of the face's
//! outline. Two arcs cross each other once if their ends alternate along the outline, and otherwise never. So
//! the signs of the surfaces at the corners of the lattice decide all connections, identically for both cells
//! beside the face. Rounding does not affect the decisions.

use super::curve::refine;
use super::edges::{Crossing, Edges, NONE, best};
use super::figures::middle;
use super::joint::Joint;
use super::leaves::{Leaf, Leaves, MOST, OpenLeaf, Refused};
use super::walk::{At, Edge, Face, Visitor};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, axes};
use crate::memory;
use crate::solid::OpenSurfaces;
use alloc::vec::Vec;
use hashbrown::HashMap;

/// A curve in a face along which the solid begins. The solid lies on its left, seen from above: from the side
/// where the coordinate across the face is greater.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    pub(super) surface: u32,
    pub(super) from: u32,
    pub(super) to: u32,
    /// The vertices between the ends, in [`Faces::between`].
    pub(super) first: u32,
    pub(super) count: u32,
}

/// A point of a face where two surfaces of a cell meet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting {
    /// The places of the two surfaces in the cell's list. The surface with the lower number comes first.
    pub(super) pair: [u8; 2],
    /// The signs of the surfaces of the cell's list at the point; the signs of the two surfaces are 0.
    pub(super) signs: u8,
    /// The vertices at the point, if an edge of the boundary passes through it. If two edges do, the solid
    /// lies between the surfaces twice: the first vertex is for the side where the second surface is
    /// negative, the second vertex for the side where it is positive. If there is one edge, both vertices are
    /// the same.
    pub(super) vertices: [u32; 2],
}

/// The arcs and meetings in faces, by cells.
pub(super) struct Faces {
    pub(super) arcs: Vec<Arc>,
    pub(super) between: Vec<u32>,
    /// Cells with their arcs, and whether the cell lies above the face. Decided cells have numbers after
    /// those of all open cells.
    pub(super) of_cells: Vec<(u32, u32, bool)>,
    pub(super) meetings: Vec<(u32, Meeting)>,
}

/// The builder of [`Faces`].
struct Finder<'e, 'f, 'l> {
    faces: Faces,
    edges: &'e mut Edges<'f>,
    leaves: &'l Leaves,
    /// The numbers of decided cells.
    decided: HashMap<Cell, u32>,
    tolerance: f64,
    refused: &'l mut Refused,
}

/// A meeting in a face, by the surfaces' numbers.
#[derive(Clone, Copy)]
struct Met {
    surfaces: [u32; 2],
    at: [f64; 3],
    vertices: [u32; 2],
}

/// A surface in a face: the places of its ends in the outline.
#[derive(Clone, Copy)]
struct Line {
    ends: [usize; 2],
}

/// The arrangement of the surfaces in a face.
struct Arrangement<'o> {
    open: &'o OpenSurfaces,
    outline: &'o [Crossing],
    lines: [Option<Line>; MOST],
    /// The signs at the first corner.
    signs: u8,
}

impl Arrangement<'_> {
    /// Returns `None` if a surface crosses the outline more than twice.
    fn new<'o>(open: &'o OpenSurfaces, outline: &'o [Crossing], signs: u8) -> Option<Arrangement<'o>> {
        let mut lines = [None; MOST];
        for (line, &surface) in lines.iter_mut().zip(open.indices()) {
            let mut places = outline.iter().enumerate().filter(|(_, crossing)| crossing.surface == surface);
            *line = match (places.next(), places.next(), places.next()) {
                (None, ..) => None,
                (Some((a, _)), Some((b, _)), None) => Some(Line { ends: [a, b] }),
                _ => return None,
            };
        }
        Some(Arrangement { open, outline, lines, signs })
    }

    fn count(&self) -> usize {
        self.open.indices().len()
    }

    /// Returns whether a surface is positive at a place of the outline, just before a crossing.
    fn sign(&self, surface: usize, place: usize) -> bool {
        let flips =
            self.lines[surface].map_or(0, |line| line.ends.iter().filter(|&&end| end < place).count());
        (self.signs >> surface & 1 != 0) ^ (flips & 1 != 0)
    }

    /// Returns whether a surface is positive where the arc of another surface begins.
    fn sign_at_start(&self, surface: usize, of: usize) -> bool {
        self.lines[of].is_some_and(|line| self.sign(surface, line.ends[0]))
    }

    fn cross(&self, i: usize, j: usize) -> bool {
        let (Some(a), Some(b)) = (self.lines[i], self.lines[j]) else { return false };
        let within = |x: usize| a.ends[0] < x && x < a.ends[1];
        i != j && within(b.ends[0]) != within(b.ends[1])
    }

    /// Returns whether surface k is positive where i and j meet; `first` is the sign of the third surface
    /// where the first two meet.
    fn sign_at_meeting(&self, k: usize, i: usize, j: usize, first: bool) -> bool {
        if !self.cross(j, k) {
            return self.sign_at_start(k, j);
        }
        if !self.cross(i, k) {
            return self.sign_at_start(k, i);
        }
        // All three cross each other: (a, b, c) = (0, 1, 2).
        if k == 2 {
            return first;
        }
        // The meeting with 2 comes before the meeting of 0 and 1, along 0 or along 1, if the sign of 2 at
        // that meeting differs from its sign at the beginning of the line.
        let other = 1 - k;
        let two_comes_first = first != self.sign_at_start(2, other);
        self.sign_at_start(k, other) ^ !two_comes_first
    }
}

impl Faces {
    pub(super) fn find(
        leaves: &Leaves,
        edges: &mut Edges<'_>,
        tolerance: f64,
        refused: &mut Refused,
    ) -> Result<Faces, Error> {
        let faces =
            Faces { arcs: Vec::new(), between: Vec::new(), of_cells: Vec::new(), meetings: Vec::new() };
        let mut finder = Finder { faces, edges, leaves, decided: HashMap::new(), tolerance, refused };
        leaves.walk(&mut finder)?;
        let mut faces = finder.faces;
        faces.of_cells.sort_unstable();
        faces.meetings.sort_by_key(|(cell, _)| *cell);
        Ok(faces)
    }
}

impl Visitor for Finder<'_, '_, '_> {
    fn edge(&mut self, _: &Edge) -> Result<(), Error> {
        Ok(())
    }

    fn face(&mut self, face: &Face) -> Result<(), Error> {
        let outline = self.outline(face)?;
        if outline.is_empty() {
            return Ok(());
        }
        let leaves = self.leaves;
        let chosen = best(leaves, face.sides.iter().map(|at| at.leaf)).filter(|leaf| leaf.is_simple);
        let first = self.faces.arcs.len();
        let mut met: Vec<Met> = Vec::new();
        let mut is_simple = false;
        if let Some(OpenLeaf { open: Some(open), joint, .. }) = chosen {
            is_simple = match joint {
                Some(joint) => self.arrange_joint(face, &outline, open, joint, &mut met)?,
                None => self.arrange(face, &outline, open, &mut met)?,
            };
            if !is_simple {
                self.faces.arcs.truncate(first);
            }
        }
        if is_simple {
            for at in &face.sides {
                is_simple &= self.meet(face, &outline, at, &met)?;
            }
        }
        if !is_simple {
            for at in &face.sides {
                self.refuse(at)?;
            }
            if self.faces.arcs.len() == first {
                let own =
                    best(leaves, face.sides.iter().map(|at| at.leaf)).and_then(|leaf| leaf.open.as_ref());
                self.pair(face, &outline, own)?;
            }
        }
        for side in 0..2 {
            let number = self.number(&face.sides[side])?;
            for arc in first..self.faces.arcs.len() {
                memory::push(&mut self.faces.of_cells, (number, arc as u32, side == 1))?;
            }
        }
        Ok(())
    }
}

impl Finder<'_, '_, '_> {
    /// The number of a cell. A decided cell gets a number here.
    fn number(&mut self, at: &At) -> Result<u32, Error> {
        if let Leaf::Open(number) = at.leaf {
            return Ok(number);
        }
        self.decided.try_reserve(1)?;
        let next = (self.leaves.open.len() + self.decided.len()) as u32;
        Ok(*self.decided.entry(at.cell).or_insert(next))
    }

    fn refuse(&mut self, at: &At) -> Result<(), Error> {
        if matches!(at.leaf, Leaf::Open(_)) && at.cell.level < self.leaves.depth {
            self.refused.add(at.cell)?;
        }
        Ok(())
    }

    /// The crossings around a face, counter-clockwise as seen from above.
    fn outline(&self, face: &Face) -> Result<Vec<Crossing>, Error> {
        let (u, v) = ((face.axis + 1) % 3, (face.axis + 2) % 3);
        let moved = |du: u32, dv: u32| {
            let mut at = face.at;
            at[u] += du;
            at[v] += dv;
            at
        };
        let (edges, edge) = (&*self.edges, face.edge);
        let mut outline = Vec::new();
        let sides = edges.along(u, face.at, edge).chain(edges.along(v, moved(edge, 0), edge));
        let back = edges.along(u, moved(0, edge), edge).rev().chain(edges.along(v, face.at, edge).rev());
        for crossing in sides.chain(back) {
            memory::push(&mut outline, *crossing)?;
        }
        Ok(outline)
    }

    fn signs(&self, open: &OpenSurfaces, at: [u32; 3]) -> Result<u8, Error> {
        let unit = self.edges.unit(at);
        let mut signs = 0;
        for (k, &surface) in open.indices().iter().enumerate() {
            signs |= u8::from(self.edges.figures.is_positive(surface, unit)?) << k;
        }
        Ok(signs)
    }

    /// The point where two arcs cross.
    fn meeting_point(&self, face: &Face, arrangement: &Arrangement<'_>, i: usize, j: usize) -> [f64; 3] {
        let ends =
            |k: usize| arrangement.lines[k].map(|line| line.ends.each(|end| arrangement.outline[end].at));
        let (Some([a, b]), Some([c, d])) = (ends(i), ends(j)) else { return [0.0; 3] };
        let (u, v) = ((face.axis + 1) % 3, (face.axis + 2) % 3);
        let cross = |p: [f64; 3], q: [f64; 3]| p[u] * q[v] - p[v] * q[u];
        let (along, other) = (axes(|k| b[k] - a[k]), axes(|k| d[k] - c[k]));
        let share = cross(axes(|k| c[k] - a[k]), other) / cross(along, other);
        let share = if (0.0..=1.0).contains(&share) { share } else { 0.5 };
        let open = arrangement.open.indices();
        self.onto(face, [open[i], open[j]], axes(|k| a[k] + share * along[k]))
    }

    /// The point of a face near another point in which two surfaces meet.
    fn meeting_in(&self, face: &Face, surfaces: [u32; 2], start: [f64; 3]) -> Option<[f64; 3]> {
        let (u, v) = ((face.axis + 1) % 3, (face.axis + 2) % 3);
        let (low, size) =
            (self.edges.unit(face.at), f64::from(face.edge) / f64::from(1u32 << self.leaves.depth));
        let is_in = |p: &[f64; 3]| [u, v].iter().all(|&k| low[k] <= p[k] && p[k] <= low[k] + size);
        self.edges.figures.onto(&surfaces, Some(face.axis), start).filter(is_in)
    }

    /// As [`meeting_in`](Self::meeting_in), but returns the start if there is no such point.
    fn onto(&self, face: &Face, surfaces: [u32; 2], start: [f64; 3]) -> [f64; 3] {
        self.meeting_in(face, surfaces, start).unwrap_or(start)
    }

    /// The meetings of an arrangement. Known meetings keep their vertices; if `makes` is set, new vertices
    /// are made for the others. `None` if a vertex is missing.
    fn meetings(
        &mut self,
        face: &Face,
        arrangement: &Arrangement<'_>,
        met: &mut Vec<Met>,
        makes: bool,
    ) -> Result<Option<Vec<Meeting>>, Error> {
        let (open, count) = (arrangement.open, arrangement.count());
        let mut meetings: Vec<Meeting> = Vec::new();
        let known = |met: &[Met], i: usize, j: usize| {
            let pair = [open.indices()[i], open.indices()[j]];
            let sorted = [pair[0].min(pair[1]), pair[0].max(pair[1])];
            met.iter().position(|met| met.surfaces == sorted)
        };
        let mut third_is_positive = false;
        for i in 0..count {
            for j in i + 1..count {
                if !arrangement.cross(i, j) {
                    continue;
                }
                let index = match known(met, i, j) {
                    Some(index) => index,
                    None => {
                        let at = self.meeting_point(face, arrangement, i, j);
                        let pair = [open.indices()[i], open.indices()[j]];
                        let surfaces = [pair[0].min(pair[1]), pair[0].max(pair[1])];
                        memory::push(met, Met { surfaces, at, vertices: [NONE; 2] })?;
                        met.len() - 1
                    }
                };
                if (i, j) == (0, 1) && count == 3 {
                    third_is_positive = self.edges.figures.is_positive(open.indices()[2], met[index].at)?;
                }
                let mut signs = 0;
                for k in (0..count).filter(|&k| k != i && k != j) {
                    signs |= u8::from(arrangement.sign_at_meeting(k, i, j, third_is_positive)) << k;
                }
                let [low, high] = if open.indices()[i] < open.indices()[j] { [i, j] } else { [j, i] };
                let corner = Corner { open, low, high, signs };
                match (corner.edges(), makes) {
                    (0, _) => {}
                    (_, false) if met[index].vertices == [NONE; 2] => return Ok(None),
                    (_, false) => {}
                    (edges, true) => {
                        let at = met[index].at;
                        let mut vertices = [self.vertex(at)?; 2];
                        if edges == 2 {
                            vertices[1] = self.vertex(at)?;
                        }
                        met[index].vertices = vertices;
                    }
                }
                let vertices = if corner.edges() > 0 { met[index].vertices } else { [NONE; 2] };
                memory::push(&mut meetings, Meeting { pair: [low as u8, high as u8], signs, vertices })?;
            }
        }
        Ok(Some(meetings))
    }

    fn vertex(&mut self, at: [f64; 3]) -> Result<u32, Error> {
        memory::push(&mut self.edges.vertices, at)?;
        Ok(self.edges.vertices.len() as u32 - 1)
    }

    /// Adds the arcs of a face according to a cell with a simple arrangement. `false` if the face is not as
    /// simple as it looks.
    fn arrange(
        &mut self,
        face: &Face,
        outline: &[Crossing],
        open: &OpenSurfaces,
        met: &mut Vec<Met>,
    ) -> Result<bool, Error> {
        let signs = self.signs(open, face.at)?;
        let Some(arrangement) = Arrangement::new(open, outline, signs) else { return Ok(false) };
        let Some(meetings) = self.meetings(face, &arrangement, met, true)? else { return Ok(false) };
        let before_all = self.faces.arcs.len();
        for i in 0..arrangement.count() {
            let Some(line) = arrangement.lines[i] else { continue };
            let [first, last] = line.ends.each(|end| outline[end]);
            let mut signs = 0;
            for j in (0..arrangement.count()).filter(|&j| j != i) {
                signs |= u8::from(arrangement.sign_at_start(j, i)) << j;
            }
            // The first corner is on the left.
            let left = arrangement.signs & 1 << i;
            let state = |signs: u8| (open.inside(signs | left), open.inside(signs | left ^ 1 << i));
            let mut on_way: Vec<&Meeting> = Vec::new();
            for meeting in meetings.iter().filter(|meeting| meeting.pair.contains(&(i as u8))) {
                memory::push(&mut on_way, meeting)?;
            }
            if let [one, two] = on_way[..] {
                // The order of the two meetings follows from the other surface of the second meeting: its
                // sign at the first meeting either equals its sign at the beginning, or differs from it.
                let other = other(two, i);
                if (one.signs ^ signs) >> other & 1 != 0 {
                    on_way.swap(0, 1);
                }
            }
            let (mut from, mut at) = (first.vertex, first.at);
            for meeting in on_way {
                let other = other(meeting, i);
                let (before, after) = (state(signs), state(signs ^ 1 << other));
                let place = met_at(met, open, meeting);
                let is_active = before.0 != before.1;
                if meeting.vertices == [NONE; 2] && before == after {
                    // The boundary does not change at this meeting.
                    signs ^= 1 << other;
                    continue;
                }
                let corner = Corner {
                    open,
                    low: meeting.pair[0].into(),
                    high: meeting.pair[1].into(),
                    signs: meeting.signs,
                };
                let end = meeting.vertices[corner.copy(i, signs >> other & 1)];
                if is_active && !self.add(face, open.indices()[i], [from, end], [at, place], before.0)? {
                    return Ok(false);
                }
                signs ^= 1 << other;
                (from, at) = (meeting.vertices[corner.copy(i, signs >> other & 1)], place);
            }
            let before = state(signs);
            if before.0 != before.1
                && !self.add(face, open.indices()[i], [from, last.vertex], [at, last.at], before.0)?
            {
                return Ok(false);
            }
        }
        // Each vertex of the outline must be an end of exactly one arc.
        let own = &self.faces.arcs[before_all..];
        let ends = |vertex: u32| own.iter().filter(|arc| arc.from == vertex || arc.to == vertex).count();
        Ok(outline.iter().all(|crossing| crossing.vertex == NONE || ends(crossing.vertex) == 1))
    }

    /// Adds an arc. The solid lies on the left of the arc as given, or on its right. `false` if an end has no
    /// vertex.
    fn add(
        &mut self,
        face: &Face,
        surface: u32,
        ends: [u32; 2],
        places: [[f64; 3]; 2],
        is_left: bool,
    ) -> Result<bool, Error> {
        if ends.contains(&NONE) {
            return Ok(false);
        }
        let ([from, to], places) =
            if is_left { (ends, places) } else { ([ends[1], ends[0]], [places[1], places[0]]) };
        let first = self.faces.between.len() as u32;
        if surface != NONE {
            let mut points = Vec::new();
            refine(self.edges.figures, &[surface], Some(face.axis), places, self.tolerance, &mut points)?;
            for point in points {
                let vertex = self.vertex(point)?;
                memory::push(&mut self.faces.between, vertex)?;
            }
        }
        let count = self.faces.between.len() as u32 - first;
        memory::push(&mut self.faces.arcs, Arc { surface, from, to, first, count })?;
        Ok(true)
    }

    /// Adds to a simple cell beside a face the meetings of its surfaces there. `false` if the meetings in the
    /// face contradict the cell.
    fn meet(&mut self, face: &Face, outline: &[Crossing], at: &At, met: &[Met]) -> Result<bool, Error> {
        let Leaf::Open(number) = at.leaf else { return Ok(true) };
        let OpenLeaf { open: Some(open), is_simple: true, joint, .. } = self.leaves.open[number as usize]
        else {
            return Ok(true);
        };
        if let Some(joint) = joint {
            return self.meet_joint(number, outline, &open, &joint, met);
        }
        let signs = self.signs(&open, face.at)?;
        let Some(arrangement) = Arrangement::new(&open, outline, signs) else { return Ok(false) };
        let mut met = memory::copied(met)?;
        let Some(meetings) = self.meetings(face, &arrangement, &mut met, false)? else { return Ok(false) };
        for meeting in meetings {
            memory::push(&mut self.faces.meetings, (number, meeting))?;
        }
        Ok(true)
    }

    /// Adds the arcs of a face according to a cell with a joint: one arc on each of the joint's surfaces if
    /// the plane crosses the face, otherwise one arc on either. `false` if the face is not as simple as it
    /// looks.
    fn arrange_joint(
        &mut self,
        face: &Face,
        outline: &[Crossing],
        open: &OpenSurfaces,
        joint: &Joint,
        met: &mut Vec<Met>,
    ) -> Result<bool, Error> {
        let mut ends = outline.iter().filter(|crossing| crossing.vertex != NONE);
        let (first, last) = match (ends.next(), ends.next(), ends.next()) {
            (None, ..) => return Ok(true),
            (Some(first), Some(last), None) => (*first, *last),
            _ => return Ok(false),
        };
        let surfaces = joint.sides.each(|k| open.indices()[k]);
        if ![first, last].iter().all(|end| surfaces.contains(&end.surface)) {
            return Ok(false);
        }
        // The first corner is on the left.
        let is_left = open.inside(self.signs(open, face.at)?);
        let (ends, places) = ([first.vertex, last.vertex], [first.at, last.at]);
        if first.surface == last.surface {
            return self.add(face, first.surface, ends, places, is_left);
        }
        let plane = open.indices()[joint.plane];
        let [from, to] = places.each(|at| self.edges.figures.about(plane, at).0);
        let share = from / (from - to);
        let share = if (0.0..=1.0).contains(&share) { share } else { 0.5 };
        let start = axes(|k| first.at[k] + share * (last.at[k] - first.at[k]));
        let at = self.onto(face, [plane, surfaces[0]], start);
        let vertex = self.vertex(at)?;
        let surfaces = [surfaces[0].min(surfaces[1]), surfaces[0].max(surfaces[1])];
        memory::push(met, Met { surfaces, at, vertices: [vertex; 2] })?;
        Ok(self.add(face, first.surface, [first.vertex, vertex], [first.at, at], is_left)?
            && self.add(face, last.surface, [vertex, last.vertex], [at, last.at], is_left)?)
    }

    /// Adds to a cell with a joint the point where the joint crosses a face. `false` if the face contradicts
    /// the cell.
    fn meet_joint(
        &mut self,
        number: u32,
        outline: &[Crossing],
        open: &OpenSurfaces,
        joint: &Joint,
        met: &[Met],
    ) -> Result<bool, Error> {
        let mut surfaces = outline.iter().filter(|end| end.vertex != NONE).map(|end| end.surface);
        let first = surfaces.next();
        if surfaces.all(|surface| Some(surface) == first) {
            return Ok(met.iter().all(|met| met.vertices == [NONE; 2]));
        }
        let [a, b] = joint.sides;
        let [low, high] = if open.indices()[a] < open.indices()[b] { [a, b] } else { [b, a] };
        let pair = [open.indices()[low], open.indices()[high]];
        let Some(met) = met.iter().find(|met| met.surfaces == pair) else { return Ok(false) };
        let meeting = Meeting { pair: [low as u8, high as u8], signs: 0, vertices: met.vertices };
        memory::push(&mut self.faces.meetings, (number, meeting))?;
        Ok(true)
    }

    /// Connects the vertices of an outline so that each piece of the solid in it is cut off separately. Two
    /// pieces are joined if the solid is known to lie between them. Where two surfaces meet in the face, each
    /// has its own arc.
    fn pair(&mut self, face: &Face, outline: &[Crossing], own: Option<&OpenSurfaces>) -> Result<(), Error> {
        let mut ends = Vec::new();
        for crossing in outline.iter().filter(|crossing| crossing.vertex != NONE) {
            memory::push(&mut ends, *crossing)?;
        }
        if ends.is_empty() || ends.len() % 2 != 0 {
            return Ok(());
        }
        let begins = usize::from(self.edges.is_inside(face.at));
        let mut next = 0;
        if let ([a, b, c, d], Some(open)) = (&ends[..], own) {
            let between = axes(|k| 0.25 * (a.at[k] + b.at[k] + c.at[k] + d.at[k]));
            let mut signs = 0;
            for (k, &surface) in open.indices().iter().enumerate() {
                signs |= u8::from(self.edges.figures.is_positive(surface, between)?) << k;
            }
            next = 2 * usize::from(open.inside(signs));
        }
        for k in (begins..ends.len() + begins).step_by(2) {
            let (enters, leaves) = (ends[(k + next) % ends.len()], ends[(k + 1) % ends.len()]);
            let (surfaces, start) = ([leaves.surface, enters.surface], middle(leaves.at, enters.at));
            let is_known = surfaces[0] != surfaces[1] && !surfaces.contains(&NONE);
            if let Some(at) = is_known.then(|| self.meeting_in(face, surfaces, start)).flatten() {
                let vertex = self.vertex(at)?;
                self.add(face, surfaces[0], [leaves.vertex, vertex], [leaves.at, at], true)?;
                self.add(face, surfaces[1], [vertex, enters.vertex], [at, enters.at], true)?;
                continue;
            }
            let surface = if surfaces[0] == surfaces[1] { surfaces[0] } else { NONE };
            let before = self.faces.between.len();
            self.add(face, surface, [leaves.vertex, enters.vertex], [leaves.at, enters.at], true)?;
            // Another face beside the same edge may have an arc between the same two places. So each of these
            // arcs gets a vertex of its own.
            let is_on_side = (0..3).filter(|&k| leaves.at[k] == enters.at[k]).count() >= 2;
            if is_on_side && self.faces.between.len() == before {
                let vertex = self.vertex(start)?;
                memory::push(&mut self.faces.between, vertex)?;
                self.faces.arcs.last_mut().into_iter().for_each(|arc| arc.count = 1);
            }
        }
        Ok(())
    }
}

fn other(meeting: &Meeting, i: usize) -> usize {
    usize::from(if usize::from(meeting.pair[0]) == i { meeting.pair[1] } else { meeting.pair[0] })
}

fn met_at(met: &[Met], open: &OpenSurfaces, meeting: &Meeting) -> [f64; 3] {
    let pair = meeting.pair.each(|k| open.indices()[usize::from(k)]);
    met.iter().find(|met| met.surfaces == pair).map_or([0.0; 3], |met| met.at)
}

/// A point where two surfaces meet, and the other surfaces have signs.
#[derive(Clone, Copy)]
pub(super) struct Corner<'o> {
    pub(super) open: &'o OpenSurfaces,
    /// The places of the two surfaces in the list. The surface with the lower number comes first.
    pub(super) low: usize,
    pub(super) high: usize,
    pub(super) signs: u8,
}

impl Corner<'_> {
    fn inside(&self, low: u8, high: u8) -> bool {
        let others = self.signs & !(1 << self.low | 1 << self.high);
        self.open.inside(others | low << self.low | high << self.high)
    }

    /// Returns whether the solid begins on surface i where the other surface has a sign.
    pub(super) fn is_active(&self, i: usize, sign: u8) -> bool {
        if i == self.low {
            self.inside(0, sign) != self.inside(1, sign)
        } else {
            self.inside(sign, 0) != self.inside(sign, 1)
        }
    }

    /// The number of boundary edges at the point.
    pub(super) fn edges(&self) -> usize {
        let halves = |i: usize| usize::from(self.is_active(i, 0)) + usize::from(self.is_active(i, 1));
        match (halves(self.low), halves(self.high)) {
            (2, 2) => 2,
            (1, 1) => 1,
            _ => 0,
        }
    }

    /// Returns the edge (0 or 1) to which a half of surface i belongs, the half on which the other surface
    /// has a sign. The result is the sign of the second surface in the solid there.
    pub(super) fn copy(&self, i: usize, sign: u8) -> usize {
        if i == self.low { usize::from(sign) } else { usize::from(self.inside(sign, 1)) }
    }
}
