//! How does a box lie to the solid?

use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::axes;
use crate::lattice::{Cell, Cube, Frame, Window, morton};
use crate::octree::links::Windows;
use crate::octree::view::OctreeRef;
use crate::octree::{Octree, Planes, Tag};
use crate::solid::{Classifier, Solid, Verdict, Worker};
use crate::walk::Proven;
use crate::walk::{Step, descend};

/// The answer to a box query. Each is proven, but for the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Region {
    /// The interiors of box and solid are disjoint.
    Outside = 0,
    /// The box lies in the solid.
    Inside = 1,
    /// Part of the box lies inside, part outside.
    Crossing = 2,
    /// None of these could be proven at the tree's depth.
    Undecided = 3,
}

/// How the box `[min, max]` (model units, min ≤ max) lies to a solid, as far as cells of `frame` tell; what
/// of the box lies outside of the universe is undecided. Ends as soon as the answer is known, or once
/// `control.max_splits` cells are split. One thread.
///
/// # Errors
/// [`Error::Argument`] if min > max on an axis, or a coordinate is not a number; what the solid refuses;
/// [`Error::OutOfMemory`], and [`Error::Cancelled`].
///
/// ```
/// use leafless::{Control, Csg, Frame, query::{Region, classify_box}};
/// let (frame, control) = (Frame::new([-2.0; 3], 4.0, 12)?, Control::default());
/// let ball = Csg::ball([0.0; 3], 1.0)?;
/// let ask = |min: [f64; 3], max: [f64; 3]| classify_box(&ball, &frame, min, max, &control);
/// assert_eq!(ask([-0.5; 3], [0.5; 3])?, Region::Inside);
/// assert_eq!(ask([0.6; 3], [1.0; 3])?, Region::Outside);
/// assert_eq!(ask([0.5; 3], [1.0; 3])?, Region::Crossing);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn classify_box<S: Solid>(
    solid: &S,
    frame: &Frame,
    min: [f64; 3],
    max: [f64; 3],
    control: &Control<'_>,
) -> Result<Region, Error> {
    let region = Survey::new(frame, min, max)?;
    let classifier = Proven(solid.on(frame, control)?);
    let Some(mut survey) = region else { return Ok(Region::Undecided) };
    let job = Job::new(control);
    let mut worker = classifier.worker()?;
    let mut left = control.max_splits.unwrap_or(u64::MAX);
    let mut step = |cell: Cell, verdict| match verdict {
        _ if !survey.window.meets(&Cube { frame, cell }) => Step::Past,
        Verdict::Partial(part) if cell.level < frame.depth() && left > 0 => {
            left -= 1;
            Step::Into(part)
        }
        verdict => {
            survey.note(Planes::uniform(verdict.tag()), 1);
            if survey.empty && survey.full { Step::End } else { Step::Past }
        }
    };
    if let Step::Into(part) = step(Cell::ROOT, worker.root()?) {
        descend(&mut worker, Cell::ROOT, &part, &job, &mut step)?;
    }
    Ok(survey.region())
}

/// A box in finest cells, and what has been met in it so far.
struct Survey {
    window: Window,
    empty: bool,
    full: bool,
    partial: bool,
}

impl Survey {
    /// `None` if all of the box lies outside of the universe; what of it does is undecided.
    fn new(frame: &Frame, min: [f64; 3], max: [f64; 3]) -> Result<Option<Survey>, Error> {
        let found = Window::new(frame, min, max)?;
        Ok(found.map(|(window, partial)| Survey { window, empty: false, full: false, partial }))
    }

    /// Takes in those of 64 cells that `mask` names.
    #[inline]
    fn note(&mut self, planes: Planes, mask: u64) {
        self.empty |= planes.empty() & mask != 0;
        self.full |= planes.full() & mask != 0;
        self.partial |= planes.partial() & mask != 0;
    }

    fn region(&self) -> Region {
        match (self.empty, self.full, self.partial) {
            (true, true, _) => Region::Crossing,
            (true, false, false) => Region::Outside,
            (false, true, false) => Region::Inside,
            _ => Region::Undecided,
        }
    }
}

impl OctreeRef<'_> {
    /// How the box `[min, max]` (model units, min ≤ max) lies to the solid; what of it lies outside of the
    /// universe is undecided. Ends as soon as the answer is known; whatever the bytes, no element is read
    /// twice.
    ///
    /// # Errors
    /// [`Error::Argument`] if min > max on an axis, or a coordinate is not a number.
    pub fn classify_box(&self, min: [f64; 3], max: [f64; 3]) -> Result<Region, Error> {
        let Some(survey) = Survey::new(&self.frame, min, max)? else { return Ok(Region::Undecided) };
        let mut search = Search { tree: self, survey, windows: Windows::new(self) };
        match self.root {
            Tag::Branch => search.element(0, 0, [0; 3]),
            tag => search.survey.note(Planes::uniform(tag), 1),
        }
        Ok(search.survey.region())
    }
}

/// The descent in a stored tree.
struct Search<'t, 'a> {
    tree: &'t OctreeRef<'a>,
    survey: Survey,
    windows: Windows,
}

impl Search<'_, '_> {
    /// Looks at the part of element `index` of level `e` that lies in the box; `origin` is its lowest finest
    /// cell. The recursion is as deep as the tree has element levels, ten at the most.
    fn element(&mut self, e: usize, index: usize, origin: [u32; 3]) {
        let levels = self.tree.levels();
        let Some(planes) = self.tree.entry(index) else {
            self.survey.partial = true;
            return;
        };
        let shift = 2 * (levels - 1 - e);
        let mut mask = !0;
        for (axis, &start) in origin.iter().enumerate() {
            let end = start + (4 << shift) - 1;
            let first = self.survey.window.first[axis].max(start) - start;
            let last = self.survey.window.last[axis].min(end) - start;
            mask &= morton::slabs(axis, first >> shift, last >> shift);
        }
        self.survey.note(planes, mask);
        let mut branches = planes.branch() & mask;
        while branches != 0 && !(self.survey.empty && self.survey.full) {
            let c = branches.trailing_zeros();
            branches &= branches - 1;
            match self.windows.child(self.tree, index, planes.branch(), c, (e + 1).min(levels - 1)) {
                Ok(child) if e + 1 < levels => {
                    let at = morton::position(c);
                    self.element(e + 1, child, axes(|axis| origin[axis] + (at[axis] << shift)));
                }
                _ => self.survey.partial = true,
            }
        }
    }
}

impl Octree {
    /// As [`OctreeRef::classify_box`].
    ///
    /// # Errors
    /// As [`OctreeRef::classify_box`].
    pub fn classify_box(&self, min: [f64; 3], max: [f64; 3]) -> Result<Region, Error> {
        self.view().classify_box(min, max)
    }
}
