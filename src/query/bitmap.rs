//! The cells of a box as bits.

use crate::control::{Control, Job, WHOLE};
use crate::error::Error;
use crate::lattice::axes;
use crate::lattice::morton;
use crate::memory;
use crate::octree::links::Windows;
use crate::octree::view::OctreeRef;
use crate::octree::{Octree, Planes, Tag};
use crate::parallel::each;

/// The number of layers along z that are read together.
const DEEP: u32 = 64;

impl OctreeRef<'_> {
    /// Writes the cells of one level in a box as bits: `inner` marks the FULL cells, `outer` marks the cells
    /// that are not EMPTY. A cell with a bit only in `outer` is PARTIAL or divided further.
    ///
    /// `min` is the first cell of the box, `max` the first cell beyond it on each axis, both in cells of
    /// `level` (0 is the universe, the frame's depth the finest). The bit of the cell min + (x, y, z) is bit
    /// x mod 64 of word x / 64 + w·(y + ny·z) with w = ⌈nx / 64⌉ and nx, ny, nz = max − min. x is fastest,
    /// each row begins with a word of its own, and bits beyond a row are 0.
    /// [`Samples::Bits`](crate::solid::Samples::Bits) reads the same layout. All words are overwritten.
    ///
    /// For large cells whole rows of words are written, for fine cells four bits at a time. Complexity:
    /// O(words + elements in the box). The result does not depend on the number of threads. If the links of
    /// an unverified tree are damaged, the affected cells read as PARTIAL.
    ///
    /// # Errors
    /// [`Error::Argument`] if `level` is greater than the frame's depth, min > max on an axis, `max` lies
    /// outside of the universe, or a slice has not w·ny·nz words. [`Error::OutOfMemory`] and
    /// [`Error::Cancelled`]: the contents of the slices are then unspecified.
    ///
    /// ```
    /// use leafless::{Control, Csg, Frame, Rule, Volume, build, solid::{Band, Samples, VoxelGrid}};
    /// let (frame, control) = (Frame::new([-2.0; 3], 4.0, 6)?, Control::default());
    /// let ball = build(&Csg::ball([0.0; 3], 1.0)?, &frame, Rule::Sampled, &control)?;
    /// let mut bits = vec![0; 64 * 64];
    /// ball.view().bitmap(6, [0; 3], [64; 3], &mut bits, None, &control)?;
    /// let inside: u32 = bits.iter().map(|word| word.count_ones()).sum();
    /// assert_eq!(inside as f64 * frame.cell_size().powi(3), ball.statistics().volume().lower);
    ///
    /// // And back.
    /// let grid = VoxelGrid::new([64; 3], frame.origin(), [frame.cell_size(); 3])?;
    /// let volume = Volume::new(Samples::Bits(bits.into()), &grid, Band::at_least(0.5)?, &control)?;
    /// let again = build(&volume, &frame, Rule::Sampled, &control)?;
    /// assert_eq!(again.statistics(), ball.statistics());
    /// # Ok::<(), leafless::Error>(())
    /// ```
    pub fn bitmap(
        &self,
        level: u8,
        min: [u32; 3],
        max: [u32; 3],
        inner: &mut [u64],
        outer: Option<&mut [u64]>,
        control: &Control<'_>,
    ) -> Result<(), Error> {
        let refuse = |name, problem| Err(Error::Argument { name, problem });
        let count = self.bitmap_words(level, min, max)?;
        let size = axes(|axis| max[axis] - min[axis]);
        let words = size[0].div_ceil(64) as usize;
        let layer = words * size[1] as usize;
        if inner.len() as u64 != count {
            return refuse("inner", "must have ⌈nx / 64⌉ words for each of the ny · nz rows");
        }
        if outer.as_ref().is_some_and(|outer| outer.len() as u64 != count) {
            return refuse("outer", "must have ⌈nx / 64⌉ words for each of the ny · nz rows");
        }
        let job = Job::new(control);
        job.check()?;
        if count == 0 {
            return Ok(());
        }
        let share = layer * DEEP as usize;
        let mut tasks = memory::with_capacity(size[2].div_ceil(DEEP) as usize)?;
        let mut outer = outer.map(|outer| outer.chunks_mut(share));
        for (k, inner) in (0..).zip(inner.chunks_mut(share)) {
            let first = min[2] + k * DEEP;
            let window = [[min[0], min[1], first], [max[0], max[1], max[2].min(first + DEEP)]];
            tasks.push((window, inner, outer.as_mut().and_then(|outer| outer.next())));
        }
        let shares = tasks.len();
        control.run(count > 1 << 12, |parallel| {
            each(parallel, tasks.into_iter(), |(window, inner, outer)| {
                let bits = Bits { low: window[0], high: window[1], words, inner, outer };
                let mut fill = Fill { tree: self, level, bits, job: &job, windows: Windows::new(self) };
                fill.all()?;
                job.advance(WHOLE / shares);
                Ok(())
            })
        })?;
        job.advance(WHOLE % shares);
        Ok(())
    }

    /// Returns the number of words in the bitmap of a box. The parameters are those of
    /// [`bitmap`](Self::bitmap).
    ///
    /// # Errors
    /// [`Error::Argument`] if `level` is greater than the frame's depth, or the box does not lie in the
    /// universe.
    pub fn bitmap_words(&self, level: u8, min: [u32; 3], max: [u32; 3]) -> Result<u64, Error> {
        let refuse = |name, problem| Err(Error::Argument { name, problem });
        if level > self.frame.depth() {
            return refuse("level", "must not be greater than the frame's depth");
        }
        if (0..3).any(|axis| min[axis] > max[axis] || max[axis] > 1 << level) {
            return refuse("max", "must be a cell or the universe's end, and not below min");
        }
        let [x, y, z] = axes(|axis| u64::from(max[axis] - min[axis]));
        Ok(x.div_ceil(64) * y * z)
    }
}

impl Octree {
    /// Writes the cells of a box as bits. See [`OctreeRef::bitmap`] for the full contract.
    ///
    /// # Errors
    /// As [`OctreeRef::bitmap`].
    pub fn bitmap(
        &self,
        level: u8,
        min: [u32; 3],
        max: [u32; 3],
        inner: &mut [u64],
        outer: Option<&mut [u64]>,
        control: &Control<'_>,
    ) -> Result<(), Error> {
        self.view().bitmap(level, min, max, inner, outer, control)
    }
}

/// The bits of the cells from `low` up to, but not including, `high`.
struct Bits<'b> {
    low: [u32; 3],
    high: [u32; 3],
    /// Number of words in a row.
    words: usize,
    inner: &'b mut [u64],
    outer: Option<&'b mut [u64]>,
}

impl Bits<'_> {
    /// The part of the cells from `at` to before `at + edge` that lies in the box along an axis.
    fn range(&self, axis: usize, at: u32, edge: u32) -> core::ops::Range<u32> {
        let (low, high) = (at.max(self.low[axis]), (at + edge).min(self.high[axis]));
        low - self.low[axis]..high.max(low) - self.low[axis]
    }

    fn row(&self, y: u32, z: u32) -> usize {
        ((self.high[1] - self.low[1]) as usize * z as usize + y as usize) * self.words
    }

    /// Sets the bits of a cube of cells.
    fn fill(&mut self, at: [u32; 3], edge: u32, is_full: bool) {
        let [x, y, z] = axes(|axis| self.range(axis, at[axis], edge));
        if x.is_empty() {
            return;
        }
        let (first, last) = (x.start as usize / 64, (x.end as usize - 1) / 64);
        let (head, tail) = (!0 << (x.start % 64), !0 >> (63 - (x.end - 1) % 64));
        for z in z {
            for y in y.clone() {
                let row = self.row(y, z);
                let set = |words: &mut [u64]| match words.get_mut(row + first..=row + last) {
                    Some([word]) => *word |= head & tail,
                    Some([from, between @ .., to]) => {
                        *from |= head;
                        between.fill(!0);
                        *to |= tail;
                    }
                    _ => {}
                };
                if is_full {
                    set(self.inner);
                }
                if let Some(outer) = &mut self.outer {
                    set(outer);
                }
            }
        }
    }

    /// Sets the bits of 4³ cells.
    fn add(&mut self, at: [u32; 3], planes: Planes) {
        let [x, y, z] = axes(|axis| self.range(axis, at[axis], 4));
        if x.is_empty() {
            return;
        }
        // The number of a row's four cells that lie before the box, and the mask of those in it.
        let before = x.start + self.low[0] - at[0];
        let real = (1u64 << (x.end - x.start)) - 1;
        let (first, shift) = (x.start as usize / 64, x.start % 64);
        let sure = planes.full();
        let possible = planes.lower | planes.upper;
        for z in z {
            for y in y.clone() {
                let place = morton::index(0, y + self.low[1] - at[1], z + self.low[2] - at[2]);
                let row = self.row(y, z) + first;
                let set = |words: &mut [u64], cells: u64| {
                    let cells = cells >> place;
                    let nibble = (cells & 3 | cells >> 6 & 12) >> before & real;
                    if let Some(word) = words.get_mut(row) {
                        *word |= nibble << shift;
                    }
                    // Needed where the box does not begin at a multiple of four.
                    if shift > 60
                        && nibble >> (64 - shift) != 0
                        && let Some(word) = words.get_mut(row + 1)
                    {
                        *word |= nibble >> (64 - shift);
                    }
                };
                set(self.inner, sure);
                if let Some(outer) = &mut self.outer {
                    set(outer, possible);
                }
            }
        }
    }

    /// Returns a mask of the 64 cells of this edge, beginning at `at`, that the box overlaps at least in
    /// part.
    fn touched(&self, at: [u32; 3], edge: u32) -> u64 {
        let mut cells = !0;
        for axis in 0..3 {
            let range = self.range(axis, at[axis], 4 * edge);
            if range.is_empty() {
                return 0;
            }
            let from = self.low[axis] + range.start - at[axis];
            let to = self.low[axis] + range.end - 1 - at[axis];
            cells &= morton::slabs(axis, from / edge, to / edge);
        }
        cells
    }
}

/// The descent in a stored tree.
struct Fill<'t, 'a, 'b> {
    tree: &'t OctreeRef<'a>,
    level: u8,
    bits: Bits<'b>,
    job: &'t Job<'t>,
    windows: Windows,
}

impl Fill<'_, '_, '_> {
    fn all(&mut self) -> Result<(), Error> {
        self.bits.inner.fill(0);
        if let Some(outer) = &mut self.bits.outer {
            outer.fill(0);
        }
        match self.tree.root {
            Tag::Branch if self.level > 0 => self.element(0, 0, [0; 3]),
            Tag::Empty => Ok(()),
            tag => {
                self.bits.fill([0; 3], 1 << self.level, tag == Tag::Full);
                Ok(())
            }
        }
    }

    /// Adds the part of element `index` of level `e` that lies in the box; `at` is the element's first cell.
    /// The recursion is as deep as the tree has element levels, ten at the most.
    fn element(&mut self, e: usize, index: usize, at: [u32; 3]) -> Result<(), Error> {
        self.job.check()?;
        let planes = self.tree.entry(index).unwrap_or(Planes::uniform(Tag::Partial));
        let real = if e == 0 { self.tree.root_cells() } else { !0 };
        let level = self.tree.cell_level(e);
        if level > self.level {
            // Octants have the requested level.
            for k in (0..8).filter(|k| real >> (8 * k) & 1 != 0) {
                let octant = [at[0] + (k & 1), at[1] + (k >> 1 & 1), at[2] + (k >> 2 & 1)];
                match planes.octant(k) {
                    Tag::Empty => {}
                    tag => self.bits.fill(octant, 1, tag == Tag::Full),
                }
            }
            return Ok(());
        }
        if level == self.level {
            self.bits.add(at, planes.masked(real));
            return Ok(());
        }
        let edge = 1 << (self.level - level);
        let mut left = real & self.bits.touched(at, edge) & !planes.empty();
        while left != 0 {
            let c = left.trailing_zeros();
            left &= left - 1;
            let place = morton::position(c);
            let corner = axes(|axis| at[axis] + place[axis] * edge);
            match planes.tag(c) {
                Tag::Branch => match self.windows.child(self.tree, index, planes.branch(), c, e + 1) {
                    Ok(child) => self.element(e + 1, child, corner)?,
                    // The tree is damaged.
                    Err(_) => self.bits.fill(corner, edge, false),
                },
                tag => self.bits.fill(corner, edge, tag == Tag::Full),
            }
        }
        Ok(())
    }
}
