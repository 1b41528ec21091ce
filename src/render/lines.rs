//! Lines in pictures.

use super::light::Light;
use super::stage::{Draw, Painter, Stage};
use super::stroke::Strokes;
use super::tile::Tile;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::valid::numbers;
use crate::lattice::{Cell, Frame};
use crate::memory;
use alloc::borrow::Cow;
use alloc::boxed::Box;
use alloc::vec::Vec;
use glam::DVec3;

/// The greatest width of lines, in pixels.
const WIDEST: f64 = 256.0;

/// A layer of lines in space, drawn some pixels wide with round ends. A surface hides the lines behind it. A
/// line on a surface is visible, because lines count as nearer than they are by their width and a pixel. Clip
/// planes cut lines.
///
/// Preparing: O(lines + tiles). Drawing: O(samples that the lines cover).
#[derive(Debug, Clone, PartialEq)]
pub struct LinesLayer<'a> {
    lines: Cow<'a, [[[f64; 3]; 2]]>,
    width: f64,
    colour: [u8; 4],
}

impl<'a> LinesLayer<'a> {
    /// Creates lines between pairs of points (model units): black, one pixel wide. A line between equal
    /// points is a dot.
    pub fn new(lines: &'a [[[f64; 3]; 2]]) -> LinesLayer<'a> {
        LinesLayer { lines: Cow::Borrowed(lines), width: 1.0, colour: [0, 0, 0, 255] }
    }

    /// Creates lines along the edges of cells. An edge that several cells share is drawn once, even if the
    /// cells differ in size. A cell that does not belong to the frame is left out. O(n log n); 24 bytes per
    /// cell and edge, then 48 per line.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn of_cells(frame: &Frame, cells: impl IntoIterator<Item = Cell>) -> Result<LinesLayer<'a>, Error> {
        let mut edges: [Vec<Edge>; 3] = Default::default();
        for cell in cells {
            let is_cell = cell.level <= frame.depth() && cell.at.iter().all(|&a| a < 1 << cell.level);
            if !is_cell {
                continue;
            }
            let shift = frame.depth() - cell.level;
            let (low, high) = (cell.at.each(|a| a << shift), cell.at.each(|a| (a + 1) << shift));
            for (axis, edges) in edges.iter_mut().enumerate() {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                for (u, v) in [(low[u], low[v]), (high[u], low[v]), (low[u], high[v]), (high[u], high[v])] {
                    memory::push(edges, Edge { beside: [u, v], from: low[axis], to: high[axis] })?;
                }
            }
        }
        let mut lines = Vec::new();
        for (axis, edges) in edges.iter_mut().enumerate() {
            edges.sort_unstable();
            let mut edges = edges.iter();
            let mut last = edges.next().copied();
            while let Some(line) = last {
                last = edges.next().copied();
                if let Some(next) = &mut last
                    && next.beside == line.beside
                    && next.from <= line.to
                {
                    (next.from, next.to) = (line.from, line.to.max(next.to));
                    continue;
                }
                memory::push(&mut lines, [line.from, line.to].each(|end| line.point(frame, axis, end)))?;
            }
        }
        Ok(LinesLayer { lines: Cow::Owned(lines), width: 1.0, colour: [0, 0, 0, 255] })
    }

    /// Sets the width of the lines, in pixels: above 0, at most 256.
    #[must_use]
    pub fn width(self, width: f64) -> LinesLayer<'a> {
        LinesLayer { width, ..self }
    }

    /// Sets the colour of the lines: red, green, blue (sRGB) and opacity.
    #[must_use]
    pub fn colour(self, colour: [u8; 4]) -> LinesLayer<'a> {
        LinesLayer { colour, ..self }
    }

    /// The lines.
    pub fn lines(&self) -> &[[[f64; 3]; 2]] {
        &self.lines
    }
}

/// The edge of a cell, or several edges that continue one another, in lattice planes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    /// The place on the two axes that follow the edge's own axis.
    beside: [u32; 2],
    from: u32,
    to: u32,
}

impl Edge {
    fn point(&self, frame: &Frame, axis: usize, end: u32) -> [f64; 3] {
        let mut planes = [end; 3];
        (planes[(axis + 1) % 3], planes[(axis + 2) % 3]) = (self.beside[0], self.beside[1]);
        axes(|axis| frame.plane(axis, planes[axis]).lower)
    }
}

/// Refuses an invalid line width.
pub(super) fn check_width(width: f64) -> Result<(), Error> {
    let is_good = width > 0.0 && width <= WIDEST;
    if is_good {
        Ok(())
    } else {
        Err(Error::Argument { name: "width", problem: "must be above 0 and at most 256" })
    }
}

impl Draw for LinesLayer<'_> {
    fn prepare<'a>(&'a self, stage: &Stage<'a>) -> Result<Box<dyn Painter + 'a>, Error> {
        check_width(self.width)?;
        self.lines.iter().flatten().try_for_each(|point| numbers("lines", point))?;
        let lines = self.lines.iter().map(|line| (line.each(DVec3::from), 1.0));
        Ok(Box::new(Lines(Strokes::new(stage, lines, self.width, Light::of(self.colour))?)))
    }
}

struct Lines(Strokes);

impl Painter for Lines {
    fn paint(&self, tile: &mut Tile<'_>) -> Result<(), Error> {
        self.0.paint(tile)
    }
}
