//! The boundary in cells: polygons that lie on one surface each. Arcs in faces, and edges in which surfaces
//! meet, bound the polygons.

use super::curve::refine;
use super::edges::{Edges, NONE};
use super::faces::{Arc, Corner, Faces, Meeting};
use super::joint::{self, Joint};
use super::leaves::{Leaves, MOST, OpenLeaf, Refused};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, axes};
use crate::memory;
use crate::solid::OpenSurfaces;
use alloc::vec::Vec;

/// The pieces of the boundary.
#[derive(Default)]
pub(super) struct Pieces {
    /// Polygons, each on one surface, with the solid behind it: the vertices are counter-clockwise as seen
    /// from outside.
    pub(super) polygons: Vec<Polygon>,
    pub(super) corners: Vec<u32>,
    /// Triangles where the surfaces have no simple arrangement, each with its surface, or [`NONE`], and its
    /// cell.
    pub(super) triangles: Vec<([u32; 3], u32, Cell)>,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Polygon {
    pub(super) surface: u32,
    pub(super) cell: Cell,
    first: u32,
    count: u32,
}

impl Pieces {
    pub(super) fn corners(&self, polygon: &Polygon) -> &[u32] {
        &self.corners[polygon.first as usize..(polygon.first + polygon.count) as usize]
    }

    /// Refuses the cells of all pieces with a vertex for which `met` is true, except the finest cells.
    pub(super) fn refuse(
        &self,
        met: impl Fn(u32) -> bool,
        depth: u8,
        refused: &mut Refused,
    ) -> Result<(), Error> {
        let polygons = self.polygons.iter().map(|polygon| (self.corners(polygon), polygon.cell));
        let triangles = self.triangles.iter().map(|(triangle, _, cell)| (&triangle[..], *cell));
        for (corners, cell) in polygons.chain(triangles) {
            if cell.level < depth && corners.iter().any(|&corner| met(corner)) {
                refused.add(cell)?;
            }
        }
        Ok(())
    }
}

/// A path through the inside of a cell, from one vertex of a face to another.
struct Way {
    /// The surface's place in the list, and the vertex where the path begins.
    start: (usize, u32),
    between: Vec<u32>,
    end: u32,
}

/// An edge from a vertex of a face to the point in which three surfaces meet.
struct Line {
    from: u32,
    /// The least of the vertices whose lines share a vertex at that point.
    group: u32,
    top: u32,
    between: Vec<u32>,
}

/// The builder of the pieces of one cell.
struct Cutter<'c, 'f> {
    leaf: Option<OpenLeaf>,
    arcs: &'c [(u32, u32, bool)],
    meetings: &'c [(u32, Meeting)],
    faces: &'c Faces,
    edges: &'c mut Edges<'f>,
    tolerance: f64,
    depth: u8,
    refused: &'c mut Refused,
}

impl Pieces {
    pub(super) fn find(
        leaves: &Leaves,
        faces: &Faces,
        edges: &mut Edges<'_>,
        tolerance: f64,
        refused: &mut Refused,
    ) -> Result<Pieces, Error> {
        let mut pieces = Pieces::default();
        let mut meetings = &faces.meetings[..];
        for arcs in faces.of_cells.chunk_by(|a, b| a.0 == b.0) {
            let number = arcs[0].0;
            let skipped = meetings.partition_point(|(cell, _)| *cell < number);
            let own = &meetings[skipped..];
            let (own, rest) = own.split_at(own.partition_point(|(cell, _)| *cell == number));
            meetings = rest;
            let leaf = leaves.open.get(number as usize).copied();
            let mut cutter =
                Cutter { leaf, arcs, meetings: own, faces, edges, tolerance, depth: leaves.depth, refused };
            cutter.cut(&mut pieces)?;
        }
        Ok(pieces)
    }
}

impl Cutter<'_, '_> {
    fn cut(&mut self, pieces: &mut Pieces) -> Result<(), Error> {
        if let Some(OpenLeaf { cell, open: Some(open), is_simple: true, joint }) = self.leaf {
            if let Some(ways) = self.ways(&open, joint)?
                && self.polygons(cell, &open, &ways, pieces)?
            {
                return Ok(());
            }
            if cell.level < self.depth {
                self.refused.add(cell)?;
            }
        }
        self.fans(pieces)
    }

    /// The arc as the boundary of a piece runs along it in this cell.
    fn run(&self, number: u32, is_above: bool) -> (u32, u32, Arc) {
        let arc = self.faces.arcs[number as usize];
        // Seen from outside the cell below, the solid in the face lies on the left of the arc; the piece lies
        // on the other side of the arc.
        if is_above { (arc.from, arc.to, arc) } else { (arc.to, arc.from, arc) }
    }

    fn follow(&self, arc: &Arc, is_above: bool, corners: &mut Vec<u32>) -> Result<(), Error> {
        let between = &self.faces.between[arc.first as usize..(arc.first + arc.count) as usize];
        corners.try_reserve(between.len() + 1)?;
        if is_above {
            corners.push(arc.from);
            corners.extend(between);
        } else {
            corners.push(arc.to);
            corners.extend(between.iter().rev());
        }
        Ok(())
    }

    fn vertex(&mut self, at: [f64; 3]) -> Result<u32, Error> {
        memory::push(&mut self.edges.vertices, at)?;
        Ok(self.edges.vertices.len() as u32 - 1)
    }

    fn at(&self, vertex: u32) -> [f64; 3] {
        self.edges.vertices[vertex as usize]
    }

    /// Adds vertices on the curve of two surfaces between two other vertices.
    fn edge(&mut self, surfaces: [u32; 2], ends: [u32; 2]) -> Result<Vec<u32>, Error> {
        let mut points = Vec::new();
        let places = ends.each(|end| self.at(end));
        refine(self.edges.figures, &surfaces, None, places, self.tolerance, &mut points)?;
        let mut vertices = memory::with_capacity(points.len())?;
        for point in points {
            vertices.push(self.vertex(point)?);
        }
        Ok(vertices)
    }

    /// The edges in which surfaces meet, each twice: once for each surface. `None` if the surfaces have no
    /// simple arrangement.
    fn ways(&mut self, open: &OpenSurfaces, joint: Option<Joint>) -> Result<Option<Vec<Way>>, Error> {
        let count = open.indices().len();
        let mut ways = Vec::new();
        let mut tops: Vec<[Meeting; 2]> = Vec::new();
        for i in 0..count {
            for j in i + 1..count {
                let of_pair = |m: &Meeting| m.pair.contains(&(i as u8)) && m.pair.contains(&(j as u8));
                let mut own = self.meetings.iter().map(|(_, meeting)| *meeting).filter(of_pair);
                let (one, other) = match (own.next(), own.next(), own.next()) {
                    (None, ..) => continue,
                    (Some(one), Some(other), None) => (one, other),
                    _ => return Ok(None),
                };
                if one.signs != other.signs {
                    memory::push(&mut tops, [one, other])?;
                    continue;
                }
                // (Newton's method does not find the points where surfaces touch.)
                let pair = joint.map_or(one.pair.each(usize::from), |joint| [joint.plane, joint.sides[0]]);
                let surfaces = pair.each(|k| open.indices()[k]);
                for copy in 0..2 {
                    let ends = [one.vertices[copy], other.vertices[copy]];
                    if ends == [NONE; 2] || copy == 1 && one.vertices[0] == one.vertices[1] {
                        continue;
                    }
                    if ends.contains(&NONE) {
                        return Ok(None);
                    }
                    let between = self.edge(surfaces, ends)?;
                    for k in one.pair {
                        push_both(&mut ways, k.into(), ends, &between)?;
                    }
                }
            }
        }
        match tops[..] {
            [] => Ok(Some(ways)),
            [_, _, _] => Ok(self.top(open, &tops, &mut ways)?.then_some(ways)),
            _ => Ok(None),
        }
    }

    /// Adds the paths through the point in which three surfaces meet. `false` if there is no simple
    /// arrangement.
    fn top(
        &mut self,
        open: &OpenSurfaces,
        meetings: &[[Meeting; 2]],
        ways: &mut Vec<Way>,
    ) -> Result<bool, Error> {
        // The meeting of two surfaces on one side of the third.
        let meeting = |i: usize, j: usize, signs: u8| {
            let k = 3 - i - j;
            meetings.iter().flatten().find(|m| {
                m.pair.contains(&(i as u8)) && m.pair.contains(&(j as u8)) && (m.signs ^ signs) >> k & 1 == 0
            })
        };
        let corner = |i: usize, j: usize, signs: u8| {
            let [low, high] = if open.indices()[i] < open.indices()[j] { [i, j] } else { [j, i] };
            Corner { open, low, high, signs }
        };
        // A part of surface i comes to the point along its edge with j, in the sector `signs`. Find the edge
        // along which its boundary goes on.
        let mut found: Vec<(usize, u32, u32)> = Vec::new();
        for (i, j) in [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)] {
            for sector in 0..4u8 {
                let k = 3 - i - j;
                let mut signs = (sector & 1) << j | (sector >> 1) << k;
                let own = corner(i, j, signs);
                if own.edges() == 0 || !own.is_active(i, sector & 1) {
                    continue;
                }
                let Some(start) = meeting(i, j, signs) else { return Ok(false) };
                let from = start.vertices[own.copy(i, sector & 1)];
                let (mut a, mut b) = (j, k);
                let mut end = None;
                for _ in 0..4 {
                    // The next line that bounds the sector is the line with b.
                    let next = corner(i, b, signs);
                    let sign = signs >> b & 1;
                    if next.edges() > 0 {
                        let Some(stop) = meeting(i, b, signs) else { return Ok(false) };
                        end = Some(stop.vertices[next.copy(i, sign)]);
                        break;
                    }
                    signs ^= 1 << b;
                    (a, b) = (b, a);
                }
                let Some(end) = end else { return Ok(false) };
                if from == NONE || end == NONE {
                    return Ok(false);
                }
                memory::push(&mut found, (i, from, end))?;
            }
        }
        if found.is_empty() {
            return Ok(true);
        }
        let Some(place) = self.top_place(open, meetings) else { return Ok(false) };
        // Vertices that are connected through the point share a vertex there: each line leads to the vertex
        // of its group.
        let mut lines: Vec<Line> = Vec::new();
        for vertex in found.iter().flat_map(|&(_, from, end)| [from, end]) {
            if !lines.iter().any(|line| line.from == vertex) {
                memory::push(
                    &mut lines,
                    Line { from: vertex, group: vertex, top: NONE, between: Vec::new() },
                )?;
            }
        }
        let group = |lines: &[Line], vertex: u32| {
            lines.iter().find(|line| line.from == vertex).map(|line| line.group)
        };
        for _ in 0..found.len() {
            for &(_, from, end) in &found {
                let least = group(&lines, from).min(group(&lines, end));
                for line in lines.iter_mut().filter(|line| line.from == from || line.from == end) {
                    line.group = least.unwrap_or(line.group);
                }
            }
        }
        for k in 0..lines.len() {
            let top = lines
                .iter()
                .find(|line| line.group == lines[k].group && line.top != NONE)
                .map(|line| line.top);
            let top = match top {
                Some(top) => top,
                None => self.vertex(place)?,
            };
            let of_pair = meetings.iter().flatten().find(|meeting| meeting.vertices.contains(&lines[k].from));
            let Some(of_pair) = of_pair else { return Ok(false) };
            let surfaces = of_pair.pair.each(|k| open.indices()[usize::from(k)]);
            lines[k].between = self.edge(surfaces, [lines[k].from, top])?;
            lines[k].top = top;
        }
        for (i, from, end) in found {
            let line = |vertex: u32| lines.iter().find(|line| line.from == vertex);
            let (Some(first), Some(last)) = (line(from), line(end)) else { return Ok(false) };
            let mut between = memory::with_capacity(first.between.len() + last.between.len() + 1)?;
            between.extend(&first.between);
            between.push(first.top);
            between.extend(last.between.iter().rev());
            memory::push(ways, Way { start: (i, from), between, end })?;
        }
        Ok(true)
    }

    /// Returns whether a point lies in the cell. Pieces in the cell do not meet the pieces of other cells.
    fn holds(&self, point: &[f64; 3]) -> bool {
        self.leaf.is_some_and(|OpenLeaf { cell, .. }| {
            let size = 1.0 / f64::from(1u32 << cell.level);
            (0..3).all(|k| {
                let low = f64::from(cell.at[k]) * size;
                low <= point[k] && point[k] <= low + size
            })
        })
    }

    /// The point in which three surfaces meet.
    fn top_place(&self, open: &OpenSurfaces, meetings: &[[Meeting; 2]]) -> Option<[f64; 3]> {
        let mut sum = ([0.0; 3], 0.0);
        for vertex in
            meetings.iter().flatten().map(|meeting| meeting.vertices[0]).filter(|&vertex| vertex != NONE)
        {
            let at = self.at(vertex);
            sum = (axes(|k| sum.0[k] + at[k]), sum.1 + 1.0);
        }
        let start = sum.0.each(|c| c / sum.1);
        self.edges.figures.onto(open.indices(), None, start).filter(|point| self.holds(point))
    }

    /// Adds the polygons of the surfaces. `false` if the polygons do not close.
    fn polygons(
        &mut self,
        cell: Cell,
        open: &OpenSurfaces,
        ways: &[Way],
        pieces: &mut Pieces,
    ) -> Result<bool, Error> {
        let (polygons, corners) = (pieces.polygons.len(), pieces.corners.len());
        let mut used = memory::filled(self.arcs.len(), false)?;
        for start in 0..self.arcs.len() {
            if used[start] {
                continue;
            }
            let first = pieces.corners.len() as u32;
            let surface = self.run(self.arcs[start].1, self.arcs[start].2).2.surface;
            let place = open.indices().iter().position(|&known| known == surface);
            let mut next = Some(start);
            while let Some(number) = next.filter(|&number| !used[number]) {
                used[number] = true;
                let (_, arc_number, is_above) = self.arcs[number];
                let (_, mut end, arc) = self.run(arc_number, is_above);
                self.follow(&arc, is_above, &mut pieces.corners)?;
                let way = ways.iter().find(|way| Some(way.start.0) == place && way.start.1 == end);
                if let Some(way) = way {
                    memory::push(&mut pieces.corners, end)?;
                    pieces.corners.try_reserve(way.between.len())?;
                    pieces.corners.extend(&way.between);
                    end = way.end;
                }
                next = (0..self.arcs.len()).find(|&other| {
                    let (from, _, arc) = self.run(self.arcs[other].1, self.arcs[other].2);
                    from == end && arc.surface == surface
                });
            }
            if next != Some(start) || surface == NONE || place.is_none() {
                pieces.polygons.truncate(polygons);
                pieces.corners.truncate(corners);
                return Ok(false);
            }
            let count = pieces.corners.len() as u32 - first;
            memory::push(&mut pieces.polygons, Polygon { surface, cell, first, count })?;
        }
        Ok(true)
    }

    /// Closes loops of arcs on any surfaces by triangles around a point.
    fn fans(&mut self, pieces: &mut Pieces) -> Result<(), Error> {
        let mut used = memory::filled(self.arcs.len(), false)?;
        // (A decided cell cannot be split.)
        let cell = self.leaf.map_or(Cell { level: self.depth, at: [0; 3] }, |leaf| leaf.cell);
        for start in 0..self.arcs.len() {
            if used[start] {
                continue;
            }
            let mut corners = Vec::new();
            let mut surfaces: Vec<u32> = Vec::new();
            let mut next = Some(start);
            while let Some(number) = next.filter(|&number| !used[number]) {
                used[number] = true;
                let (_, arc_number, is_above) = self.arcs[number];
                let (_, end, arc) = self.run(arc_number, is_above);
                let before = corners.len();
                self.follow(&arc, is_above, &mut corners)?;
                for _ in before..corners.len() {
                    memory::push(&mut surfaces, arc.surface)?;
                }
                next = (0..self.arcs.len())
                    .find(|&other| self.run(self.arcs[other].1, self.arcs[other].2).0 == end);
            }
            if let [a, b, c] = corners[..] {
                memory::push(&mut pieces.triangles, ([a, b, c], surfaces[0], cell))?;
                continue;
            }
            let centre = self.centre(&corners, &surfaces);
            let centre = self.vertex(centre)?;
            for k in 0..corners.len() {
                let triangle = [corners[k], corners[(k + 1) % corners.len()], centre];
                memory::push(&mut pieces.triangles, (triangle, surfaces[k], cell))?;
            }
        }
        Ok(())
    }

    /// A point for the middle of a loop. It lies on the loop's surfaces, if these are few.
    fn centre(&self, corners: &[u32], surfaces: &[u32]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for &corner in corners {
            sum = axes(|k| sum[k] + self.at(corner)[k]);
        }
        let mean = sum.each(|c| c / corners.len() as f64);
        let open = self
            .leaf
            .and_then(|leaf| Some((leaf.cell, leaf.open.filter(|open| open.indices().len() > MOST)?)));
        let end = open.and_then(|(cell, open)| joint::end(self.edges.figures, cell, &open));
        let end = end.and_then(|end| self.edges.figures.onto(&end, None, mean));
        if let Some(end) = end.filter(|point| self.holds(point)) {
            return end;
        }
        let mut known: Vec<u32> = Vec::new();
        for &surface in surfaces {
            if surface != NONE && !known.contains(&surface) && known.len() < 3 {
                known.push(surface);
            }
        }
        if known.is_empty() {
            mean
        } else {
            self.edges.figures.onto(&known, None, mean).filter(|point| self.holds(point)).unwrap_or(mean)
        }
    }
}

fn push_both(ways: &mut Vec<Way>, surface: usize, ends: [u32; 2], between: &[u32]) -> Result<(), Error> {
    let forward = memory::copied(between)?;
    let mut back = memory::copied(between)?;
    back.reverse();
    memory::push(ways, Way { start: (surface, ends[0]), between: forward, end: ends[1] })?;
    memory::push(ways, Way { start: (surface, ends[1]), between: back, end: ends[0] })
}
