//! The common volume and the common cells of a stored solid and a box.

use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::{Frame, Interval, Window, morton};
use crate::octree::links::Windows;
use crate::octree::view::OctreeRef;
use crate::octree::{Octree, Planes, Tag};

impl OctreeRef<'_> {
    /// Counts the finest cells from `min` to before `max` that are surely solid (FULL), and those that are
    /// possibly solid (FULL or PARTIAL). No element is read twice, whatever the bytes.
    ///
    /// # Errors
    /// [`Error::Argument`] if min > max on an axis, or `max` lies outside of the universe.
    pub fn cells_in_box(&self, min: [u32; 3], max: [u32; 3]) -> Result<(u64, u64), Error> {
        if (0..3).any(|axis| min[axis] > max[axis] || max[axis] > self.frame.cells()) {
            return Err(Error::Argument {
                name: "max",
                problem: "must be a cell or the universe's end, and not below min",
            });
        }
        if (0..3).any(|axis| min[axis] == max[axis]) {
            return Ok((0, 0));
        }
        Ok(count(self, Window { first: min, last: max.each(|end| end - 1) }))
    }

    /// Returns the volume that the solid has in common with the box `[min, max]` (model units, min ≤ max), in
    /// cubic model units, as the octree's cells determine it: FULL cells bound it from below, FULL and
    /// PARTIAL cells from above. The faces of the box may lie anywhere. A cell that they cut counts with its
    /// part in the box, rounded outward. The outside of the universe does not count. No element is read more
    /// than 27 times, whatever the bytes.
    ///
    /// (For regions of other shapes: [`volume_in`](OctreeRef::volume_in).)
    ///
    /// # Errors
    /// [`Error::Argument`] if min > max on an axis, or a coordinate is not a number.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Rule, build};
    /// let frame = Frame::new([0.0; 3], 8.0, 4)?;
    /// let slab = build(&Csg::cuboid([0.0; 3], [8.0, 8.0, 2.0])?, &frame, Rule::Certified, &Control::default())?;
    /// let found = slab.view().volume_in_box([1.0, 1.0, 1.25], [3.0, 2.5, 100.0])?;
    /// assert_eq!((found.lower, found.upper), (2.25, 2.25));
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn volume_in_box(&self, min: [f64; 3], max: [f64; 3]) -> Result<Interval, Error> {
        let nothing = Interval::exactly(0.0);
        let Some((window, _)) = Window::new(&self.frame, min, max)? else { return Ok(nothing) };
        let rows = axes(|axis| rows(&self.frame, axis, min[axis], max[axis], &window));
        let mut volume = nothing;
        for z in rows[2].into_iter().flatten() {
            for y in rows[1].into_iter().flatten() {
                for x in rows[0].into_iter().flatten() {
                    let window =
                        Window { first: [x.first, y.first, z.first], last: [x.last, y.last, z.last] };
                    let (least, most) = count(self, window);
                    let cells = Interval::between(
                        Interval::of_integer(least.into()).lower,
                        Interval::of_integer(most.into()).upper,
                    );
                    volume = volume.plus(cells.times(x.length).times(y.length).times(z.length));
                }
            }
        }
        Ok(volume.not_negative())
    }
}

impl Octree {
    /// Counts cells in a box. See [`OctreeRef::cells_in_box`] for the full contract.
    ///
    /// # Errors
    /// As [`OctreeRef::cells_in_box`].
    pub fn cells_in_box(&self, min: [u32; 3], max: [u32; 3]) -> Result<(u64, u64), Error> {
        self.view().cells_in_box(min, max)
    }

    /// Returns the volume in a box. See [`OctreeRef::volume_in_box`] for the full contract.
    ///
    /// # Errors
    /// As [`OctreeRef::volume_in_box`].
    pub fn volume_in_box(&self, min: [f64; 3], max: [f64; 3]) -> Result<Interval, Error> {
        self.view().volume_in_box(min, max)
    }
}

/// Cells with the same length in a box along an axis.
#[derive(Clone, Copy)]
struct Rows {
    first: u32,
    last: u32,
    length: Interval,
}

/// Returns the cells of a box along an axis: the first and the last cell, if the box cuts them, and the cells
/// between.
fn rows(frame: &Frame, axis: usize, min: f64, max: f64, window: &Window) -> [Option<Rows>; 3] {
    let (first, last) = (window.first[axis], window.last[axis]);
    let whole = Interval::exactly(frame.cell_size());
    let (lower, upper) = (2 * i64::from(first), 2 * i64::from(last));
    let cuts = [frame.side(axis, min, lower) > 0, frame.side(axis, max, upper + 2) < 0];
    // The distance from a cell's lower plane to the box's face in the cell.
    let low = || frame.rounded_offset(axis, min, lower);
    let high = || frame.rounded_offset(axis, max, upper);
    let row = |first: u32, last: u32, length: Interval| {
        let length = length.not_negative();
        (first <= last).then_some(Rows { first, last, length })
    };
    if first == last {
        let end = if cuts[1] { high() } else { whole };
        return [row(first, last, if cuts[0] { end.minus(low()) } else { end }), None, None];
    }
    [
        if cuts[0] { row(first, first, whole.minus(low())) } else { None },
        // (The difference does not wrap: there are at least two cells.)
        row(first + u32::from(cuts[0]), last - u32::from(cuts[1]), whole),
        if cuts[1] { row(last, last, high()) } else { None },
    ]
}

/// Counts the surely and the possibly solid finest cells in a window.
fn count(tree: &OctreeRef<'_>, window: Window) -> (u64, u64) {
    let mut count = Count { tree, window, windows: Windows::new(tree), full: 0, partial: 0 };
    match tree.root {
        Tag::Branch => count.element(0, 0, [0; 3]),
        tag => {
            let size = axes(|axis| u64::from(window.last[axis] - window.first[axis] + 1));
            count.add(tag, size[0] * size[1] * size[2]);
        }
    }
    (count.full, count.full + count.partial)
}

/// The descent in a stored tree.
struct Count<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    window: Window,
    windows: Windows,
    full: u64,
    partial: u64,
}

impl Count<'_, '_> {
    fn add(&mut self, tag: Tag, cells: u64) {
        match tag {
            Tag::Empty => {}
            Tag::Full => self.full += cells,
            Tag::Partial | Tag::Branch => self.partial += cells,
        }
    }

    /// Counts the cells in the part of element `index` of level `e` that lies in the window; `origin` is the
    /// element's lowest finest cell. The recursion is as deep as the tree has element levels, ten at the
    /// most.
    fn element(&mut self, e: usize, index: usize, origin: [u32; 3]) {
        let levels = self.tree.levels();
        let shift = 2 * (levels - 1 - e) as u32;
        let planes = self.tree.entry(index).unwrap_or(Planes::uniform(Tag::Partial));
        // The length of each cell in the window along each axis, in finest cells.
        let lengths = axes(|axis| {
            [0, 1, 2, 3].each(|k| {
                let start = origin[axis] + (k << shift);
                let (first, last) = (
                    self.window.first[axis].max(start),
                    self.window.last[axis].min(start + (1 << shift) - 1),
                );
                u64::from((last + 1).saturating_sub(first))
            })
        });
        let mut mask = if e == 0 { self.tree.root_cells() } else { !0 };
        let mut whole = mask;
        for axis in 0..3 {
            for k in 0..4 {
                let slab = morton::SLAB[axis][k];
                if lengths[axis][k] == 0 {
                    mask &= !slab;
                }
                if lengths[axis][k] < 1 << shift {
                    whole &= !slab;
                }
            }
        }
        self.full += u64::from((planes.full() & whole).count_ones()) << (3 * shift);
        self.partial += u64::from((planes.partial() & whole).count_ones()) << (3 * shift);
        let mut rest = mask & !planes.empty() & !(whole & !planes.branch());
        while rest != 0 {
            let c = rest.trailing_zeros();
            rest &= rest - 1;
            let at = morton::position(c);
            let volume = (0..3).map(|axis| lengths[axis][at[axis] as usize]).product();
            match planes.tag(c) {
                Tag::Branch => {
                    match self.windows.child(self.tree, index, planes.branch(), c, (e + 1).min(levels - 1)) {
                        Ok(child) if e + 1 < levels => {
                            self.element(e + 1, child, axes(|axis| origin[axis] + (at[axis] << shift)));
                        }
                        _ => self.add(Tag::Partial, volume),
                    }
                }
                tag => self.add(tag, volume),
            }
        }
    }
}
