//! Triangulation of a plane region with any holes, by a sweep over its vertices (Hertel and Mehlhorn 1983).
//!
//! The sweep goes from left to right, and upwards where vertices lie above each other. It meets each *span*
//! of the region between a lower and an upper edge. The part of a span to the left of the sweep is already
//! cut into triangles, up to a *chain* of vertices from the lower edge to the upper one. The chain never
//! turns so that a triangle could be cut off. At each vertex, all triangles that it can see along the chain
//! are cut off. All vertices are integers, so every decision is exact.

use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use alloc::vec::Vec;
use core::ops::Range;

/// A vertex: its place in the plane, and its number in the mesh.
pub(super) type Vertex = ([i32; 2], u32);

/// Buffers for triangulating one region after another.
#[derive(Default)]
pub(super) struct Sweep {
    points: Vec<Vertex>,
    edges: Vec<Edge>,
    spans: Vec<Span>,
    /// Spans that replace others.
    new: Vec<Span>,
    links: Vec<Link>,
}

/// An edge by the places of its ends in the list of points, from left to right.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Edge {
    left: u32,
    right: u32,
    /// Whether the region lies above the edge.
    is_lower: bool,
}

/// A vertex of a chain.
#[derive(Debug, Clone, Copy)]
struct Link {
    point: u32,
    below: u32,
    above: u32,
}

/// The region between two edges on the sweep line.
#[derive(Debug, Clone, Copy)]
struct Span {
    lower: Edge,
    upper: Edge,
    /// The lower and the upper end of the chain, and its last vertex in sweep order.
    bottom: u32,
    top: u32,
    last: u32,
}

impl Sweep {
    /// Appends the triangles of a region to a list: counter-clockwise, without new vertices, none without
    /// area. The region is given by its directed edges, and lies to the left of each edge. Edges meet in
    /// common ends only, and no two edges join the same vertices. A vertex may have any even number of edges.
    ///
    /// O(n log n + n w) for n edges, of which the sweep meets at most w at one place; the second part is the
    /// cost of moving some bytes.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn triangulate(
        &mut self,
        edges: impl ExactSizeIterator<Item = [Vertex; 2]> + Clone,
        triangles: &mut Vec<[u32; 3]>,
    ) -> Result<(), Error> {
        self.read(edges)?;
        self.spans.clear();
        self.links.clear();
        let mut rest = 0;
        for v in 0..self.points.len() as u32 {
            let first = rest;
            while self.edges.get(rest).is_some_and(|edge| edge.left == v) {
                rest += 1;
            }
            self.event(v, first..rest, triangles)?;
        }
        Ok(())
    }

    /// Sorts points and edges.
    fn read(&mut self, edges: impl ExactSizeIterator<Item = [Vertex; 2]> + Clone) -> Result<(), Error> {
        self.points.clear();
        self.points.try_reserve(2 * edges.len())?;
        self.points.extend(edges.clone().flatten());
        self.points.sort_unstable();
        self.points.dedup();
        self.edges.clear();
        self.edges.try_reserve(edges.len())?;
        let points = &self.points;
        let place = |vertex: &Vertex| points.partition_point(|point| point < vertex) as u32;
        self.edges.extend(edges.map(|[from, to]| {
            let (from, to) = (place(&from), place(&to));
            Edge { left: from.min(to), right: from.max(to), is_lower: from < to }
        }));
        self.edges.sort_unstable_by(|a, b| {
            let by_slope = || 0.cmp(&area(points, [a.left, a.right, b.right]));
            a.left.cmp(&b.left).then_with(by_slope)
        });
        Ok(())
    }

    /// Moves the sweep past a vertex. The given edges begin at it, sorted from the lowest to the highest.
    fn event(&mut self, v: u32, mut begin: Range<usize>, triangles: &mut Vec<[u32; 3]>) -> Result<(), Error> {
        // The spans that contain the vertex, or end at it.
        let is_above = |edge: &Edge| edge.right != v && area(&self.points, [edge.left, edge.right, v]) > 0;
        let first = self.spans.partition_point(|span| is_above(&span.upper));
        let meets = |span: &&Span| span.lower.right == v || is_above(&span.lower);
        let last = first + self.spans[first..].iter().take_while(meets).count();
        // The spans directly below and above the vertex go on.
        let (mut below, mut above) = (None, None);
        for i in first..last {
            let span = self.spans[i];
            match (span.lower.right == v, span.upper.right == v) {
                (true, true) => self.close(span, v, triangles)?,
                (false, true) => below = Some(self.rise(span, v, triangles)?),
                (true, false) => above = Some(self.sink(span, v, triangles)?),
                (false, false) => {
                    let [lower, upper] = self.split(span)?;
                    below = Some(self.rise(lower, v, triangles)?);
                    above = Some(self.sink(upper, v, triangles)?);
                }
            }
        }
        let mut new = core::mem::take(&mut self.new);
        new.clear();
        new.try_reserve(begin.len() / 2 + 2)?;
        match (below, begin.len()) {
            (None, _) => {}
            (Some(span), 0) => new.extend(above.take().map(|above| self.join(span, above))),
            (Some(span), _) => new.extend(begin.next().map(|i| Span { upper: self.edges[i], ..span })),
        }
        while let Some(lower) = begin.next().map(|i| self.edges[i]) {
            match begin.next().map(|i| self.edges[i]) {
                Some(upper) => {
                    let link = push(&mut self.links, v)?;
                    new.push(Span { lower, upper, bottom: link, top: link, last: link });
                }
                None => new.extend(above.take().map(|span| Span { lower, ..span })),
            }
        }
        self.spans.try_reserve(new.len())?;
        self.spans.splice(first..last, new.drain(..));
        self.new = new;
        Ok(())
    }

    /// Appends a vertex at the upper end of a span's chain, and cuts off the triangles that it sees.
    fn rise(&mut self, span: Span, v: u32, triangles: &mut Vec<[u32; 3]>) -> Result<Span, Error> {
        let mut top = span.top;
        while top != span.bottom {
            let below = self.links[top as usize].below;
            if !self.cut_off(below, v, top, triangles)? {
                break;
            }
            top = below;
        }
        let link = push(&mut self.links, v)?;
        self.connect(top, link);
        Ok(Span { top: link, last: link, ..span })
    }

    /// Appends a vertex at the lower end of a span's chain, and cuts off the triangles that it sees.
    fn sink(&mut self, span: Span, v: u32, triangles: &mut Vec<[u32; 3]>) -> Result<Span, Error> {
        let mut bottom = span.bottom;
        while bottom != span.top {
            let above = self.links[bottom as usize].above;
            if !self.cut_off(bottom, v, above, triangles)? {
                break;
            }
            bottom = above;
        }
        let link = push(&mut self.links, v)?;
        self.connect(link, bottom);
        Ok(Span { bottom: link, last: link, ..span })
    }

    /// Ends a span at a vertex, which sees the whole chain.
    fn close(&mut self, span: Span, v: u32, triangles: &mut Vec<[u32; 3]>) -> Result<(), Error> {
        let mut link = span.bottom;
        while link != span.top {
            let above = self.links[link as usize].above;
            self.cut_off(link, v, above, triangles)?;
            link = above;
        }
        Ok(())
    }

    /// Cuts a chain in two at its last vertex, which is visible from everywhere between the edges.
    fn split(&mut self, span: Span) -> Result<[Span; 2], Error> {
        let Link { point, above, .. } = self.links[span.last as usize];
        let copy = push(&mut self.links, point)?;
        let top = if span.top == span.last {
            copy
        } else {
            self.connect(copy, above);
            span.top
        };
        Ok([Span { top: span.last, ..span }, Span { bottom: copy, top, ..span }])
    }

    /// Joins two spans. The chain of the lower span ends with the vertex that begins the chain of the upper
    /// span.
    fn join(&mut self, lower: Span, upper: Span) -> Span {
        let top = if upper.top == upper.bottom {
            lower.top
        } else {
            self.connect(lower.top, self.links[upper.bottom as usize].above);
            upper.top
        };
        Span { lower: lower.lower, upper: upper.upper, bottom: lower.bottom, top, last: lower.top }
    }

    fn connect(&mut self, below: u32, above: u32) {
        self.links[below as usize].above = above;
        self.links[above as usize].below = below;
    }

    /// Appends the triangle between two links of a chain and a vertex, if it has an area.
    fn cut_off(&self, lower: u32, v: u32, upper: u32, triangles: &mut Vec<[u32; 3]>) -> Result<bool, Error> {
        let corners = [self.links[lower as usize].point, v, self.links[upper as usize].point];
        let has_area = area(&self.points, corners) > 0;
        if has_area {
            memory::push(triangles, corners.each(|corner| self.points[corner as usize].1))?;
        }
        Ok(has_area)
    }
}

/// Appends a link without neighbours.
fn push(links: &mut Vec<Link>, point: u32) -> Result<u32, Error> {
    memory::push(links, Link { point, below: 0, above: 0 })?;
    Ok(links.len() as u32 - 1)
}

/// Twice the area of a triangle; positive if it turns counter-clockwise.
fn area(points: &[Vertex], corners: [u32; 3]) -> i64 {
    let [p, q, r] = corners.each(|corner| points[corner as usize].0.each(i64::from));
    (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
}
