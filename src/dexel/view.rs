//! The borrowed view of a tri-dexel model, for all reading.

use super::columns::{ColumnsRef, NormalsRef};
use super::format::{DexelEnds, DexelFormat, DexelNormals};
use super::item::{Item, NO_SURFACE};
use super::line::{Line, is_place};
use super::normal::decoded;
use super::place::{DoubleSpan, FixedSpan, Place, Span};
use crate::lattice::Each;
use crate::lattice::Frame;
use core::ops::Range;
use yoke::Yokeable;

/// The other two axes of each axis, ascending.
pub(crate) const OTHERS: [[usize; 2]; 3] = [[1, 2], [0, 2], [0, 1]];

/// A rectangle of rays of one direction, by indices on the other two axes. Rays outside it are empty.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Window {
    pub first: [u32; 2],
    pub size: [u32; 2],
}

impl Window {
    /// The window of all rays of a universe.
    pub fn all(depth: u8) -> Window {
        Window { first: [0; 2], size: [1 << depth; 2] }
    }

    pub fn of(ranges: [Range<u32>; 2]) -> Window {
        let size = [0, 1].each(|i| ranges[i].end.saturating_sub(ranges[i].start));
        if size.contains(&0) {
            return Window::default();
        }
        Window { first: [ranges[0].start, ranges[1].start], size }
    }

    pub fn range(&self, i: usize) -> Range<u32> {
        self.first[i]..self.first[i] + self.size[i]
    }

    /// The number of rays.
    pub fn count(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }

    pub fn is_empty(&self) -> bool {
        self.count() == 0
    }

    /// The index of a ray in the window.
    #[inline(always)]
    pub fn index(&self, [u, v]: [u32; 2]) -> Option<usize> {
        let (u, v) = (u.wrapping_sub(self.first[0]), v.wrapping_sub(self.first[1]));
        (u < self.size[0] && v < self.size[1]).then(|| v as usize * self.size[0] as usize + u as usize)
    }

    /// The ray with an index in the window.
    pub fn ray(&self, index: usize) -> [u32; 2] {
        let width = (self.size[0] as usize).max(1);
        [self.first[0] + (index % width) as u32, self.first[1] + (index / width) as u32]
    }

    pub fn intersection(&self, other: &Window) -> Window {
        Window::of([0, 1].each(|i| {
            let (a, b) = (self.range(i), other.range(i));
            a.start.max(b.start)..a.end.min(b.end)
        }))
    }

    /// The least window that contains both.
    pub fn hull(&self, other: &Window) -> Window {
        if self.is_empty() || other.is_empty() {
            return if self.is_empty() { *other } else { *self };
        }
        Window::of([0, 1].each(|i| {
            let (a, b) = (self.range(i), other.range(i));
            a.start.min(b.start)..a.end.max(b.end)
        }))
    }
}

/// The rays of one direction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RowsRef<'a, S> {
    pub window: Window,
    /// For each ray of the window, the index of its first interval; then the number of all intervals.
    pub starts: &'a [u32],
    pub columns: ColumnsRef<'a, S>,
}

impl<S: Span> RowsRef<'_, S> {
    /// The intervals of the ray with this index in the window.
    #[inline(always)]
    pub fn at(&self, index: usize) -> Range<usize> {
        // Arrays from a file may contain any numbers.
        match self.starts.get(index..).and_then(|rest| rest.get(..2)) {
            Some(&[first, end]) if first <= end && end as usize <= self.columns.spans.len() => {
                first as usize..end as usize
            }
            _ => 0..0,
        }
    }

    /// The intervals of rows.
    pub fn within(&self, rows: Range<u32>) -> Range<usize> {
        let [first, end] = [rows.start, rows.end].each(|row| {
            let row = row.clamp(self.window.range(1).start, self.window.range(1).end) - self.window.first[1];
            self.starts.get(row as usize * self.window.size[0] as usize).map_or(0, |&start| start as usize)
        });
        first..end
    }

    /// The intervals of a ray.
    #[inline(always)]
    pub fn ray(&self, ray: [u32; 2]) -> Range<usize> {
        self.window.index(ray).map_or(0..0, |index| self.at(index))
    }

    pub fn items(&self, ray: [u32; 2]) -> impl Iterator<Item = Item<S::Place>> {
        self.ray(ray).map(|i| self.columns.item(i))
    }
}

/// The rays of one direction, in one of the two forms of ends.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Rows<'a> {
    Fixed(RowsRef<'a, FixedSpan>),
    Double(RowsRef<'a, DoubleSpan>),
}

/// Evaluates `$body` for the rows in either form.
macro_rules! with_rows {
    ($rows:expr, $name:ident => $body:expr) => {
        match $rows {
            $crate::dexel::Rows::Fixed($name) => $body,
            $crate::dexel::Rows::Double($name) => $body,
        }
    };
}
pub(crate) use with_rows;

/// One end of a [`Dexel`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DexelEnd {
    /// The coordinate along the ray, in model units.
    ///
    /// An end that the library returns lies on the stored side of every centre of a cell. It is the nearest
    /// double on this side, up to an ulp. Far from the origin there may be no double between two centres.
    /// Then it is the nearest double of all, and only `cells` determines the side.
    pub at: f64,
    /// The same place in finest cells from the universe's lower face, exactly as it is stored: 0 to 2^depth.
    /// The centre of cell k lies at k + ½.
    ///
    /// An end that the library returns always has this number. For an end that the host provides, `cells`
    /// counts if `at` is the coordinate that the library would return for it on that frame. Otherwise, and if
    /// `cells` is `None`, only `at` counts. So changing `at` moves an end to that coordinate.
    pub cells: Option<f64>,
    /// The number of the source's surface at the end: a triangle of a mesh, a half-space of an expression.
    /// `None` if it is unknown.
    pub surface: Option<u32>,
    /// The outward unit normal at the end, if it is known.
    pub normal: Option<[f64; 3]>,
}

impl DexelEnd {
    /// Makes an end at a coordinate (model units), without a surface or a normal.
    pub const fn new(at: f64) -> DexelEnd {
        DexelEnd { at, cells: None, surface: None, normal: None }
    }

    /// Makes an end along an axis, `cells` finest cells from the universe's lower face (0 to 2^depth),
    /// without a surface or a normal. The centre of cell k lies at k + ½. `None` for an axis greater than 2
    /// and for a place outside the universe.
    ///
    /// ```
    /// use leafless::{Frame, dexel::DexelEnd};
    /// let frame = Frame::new([0.1; 3], 0.7, 3)?;
    /// // On the centre of cell 4, and as little as possible above it.
    /// let centre = DexelEnd::in_cells(&frame, 0, 4.5).unwrap();
    /// let behind = DexelEnd::in_cells(&frame, 0, 4.5f64.next_up()).unwrap();
    /// assert!(centre.at < behind.at);
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn in_cells(frame: &Frame, axis: usize, cells: f64) -> Option<DexelEnd> {
        let is_end = axis < 3 && is_place(cells, frame.depth());
        is_end
            .then(|| DexelEnd { cells: Some(cells), ..DexelEnd::new(Line { frame, axis }.coordinate(cells)) })
    }
}

/// An interval of a ray that lies inside the solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dexel {
    /// The start.
    pub start: DexelEnd,
    /// The end, which is greater than the start (in cells; far from the origin both may have one coordinate).
    pub end: DexelEnd,
    /// The material; 0 if it is unknown.
    pub material: u32,
}

/// The rays of a tri-dexel model along one axis.
#[derive(Debug, Clone, Copy)]
pub struct DexelRays<'a> {
    pub(crate) frame: Frame,
    pub(crate) axis: usize,
    pub(crate) rows: Rows<'a>,
}

impl<'a> DexelRays<'a> {
    /// The axis along which the rays run.
    pub fn axis(&self) -> usize {
        self.axis
    }

    /// The window of the rays: indices of cells on the other two axes, the lower axis first. Rays outside it
    /// are empty.
    pub fn window(&self) -> [Range<u32>; 2] {
        let window = with_rows!(&self.rows, rows => rows.window);
        [window.range(0), window.range(1)]
    }

    /// The number of intervals.
    pub fn interval_count(&self) -> u64 {
        with_rows!(&self.rows, rows => rows.columns.spans.len()) as u64
    }

    /// The intervals of the ray through the centres of cells with these indices on the other two axes, the
    /// lower axis first. They are in ascending order and disjoint. A ray outside the universe has none.
    pub fn dexels(&self, ray: [u32; 2]) -> impl ExactSizeIterator<Item = Dexel> + 'a {
        let &DexelRays { frame, axis, rows } = self;
        let range = with_rows!(&rows, rows => rows.ray(ray));
        range.map(move |i| with_rows!(&rows, rows => dexel(&frame, axis, rows.columns.item(i))))
    }
}

fn dexel<P: Place>(frame: &Frame, axis: usize, item: Item<P>) -> Dexel {
    let line = Line { frame, axis };
    let end = |k: usize| {
        let cells = item.ends[k].cells(frame.depth());
        DexelEnd {
            at: line.coordinate(cells),
            cells: Some(cells),
            surface: Some(item.marks[k].surface).filter(|&surface| surface != NO_SURFACE),
            normal: decoded(item.marks[k].normal),
        }
    };
    Dexel { start: end(0), end: end(1), material: item.material }
}

/// A borrowed tri-dexel model. A copy shares the intervals.
#[derive(Debug, Clone, Copy, Yokeable)]
pub struct TriDexelRef<'a> {
    pub(crate) frame: Frame,
    pub(crate) format: DexelFormat,
    pub(crate) rays: [Option<Rows<'a>>; 3],
    /// Whether the arrays are known to be sound. The arrays of an unverified file are not.
    pub(crate) checked: bool,
}

impl<'a> TriDexelRef<'a> {
    /// The lattice: rays run through the centres of its finest cells.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The data that is stored for each interval.
    pub fn format(&self) -> DexelFormat {
        self.format
    }

    /// For each axis, x, y and z, whether there are rays along it.
    pub fn directions(&self) -> [bool; 3] {
        self.rays.each(|rays| rays.is_some())
    }

    /// The rays along an axis, if the model has any.
    pub fn rays(&self, axis: usize) -> Option<DexelRays<'a>> {
        let rows = (*self.rays.get(axis)?)?;
        Some(DexelRays { frame: self.frame, axis, rows })
    }

    /// The number of intervals in all directions.
    pub fn interval_count(&self) -> u64 {
        (0..3).filter_map(|axis| self.rays(axis)).map(|rays| rays.interval_count()).sum()
    }

    /// The number of bytes of the arrays.
    pub fn bytes(&self) -> u64 {
        let starts = |rows: &Rows<'_>| with_rows!(rows, rows => size_of_val(rows.starts)) as u64;
        let starts = self.rays.iter().flatten().map(starts).sum::<u64>();
        starts + self.interval_count() * self.format.bytes_per_interval() as u64
    }

    /// The form of the ends of all intervals.
    pub(crate) fn kind(&self) -> DexelEnds {
        self.format.ends
    }
}

/// Returns whether a format agrees with the arrays.
pub(crate) fn carries<S: Span>(columns: &ColumnsRef<'_, S>, format: &DexelFormat) -> bool {
    let count = columns.spans.len();
    let normals = match (columns.normals, format.normals) {
        (NormalsRef::None, DexelNormals::None) => true,
        (NormalsRef::Bits16(codes), DexelNormals::Bits16) => codes.len() == count,
        (NormalsRef::Bits32(codes), DexelNormals::Bits32) => codes.len() == count,
        _ => false,
    };
    normals
        && columns.surfaces.map(|list| list.len()) == format.surfaces.then_some(count)
        && columns.materials.map(|list| list.len()) == format.materials.then_some(count)
}
