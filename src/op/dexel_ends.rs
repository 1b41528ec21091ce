//! Octrees of tri-dexel models, by interval ends.

use super::build::build_on;
use super::rule::Rule;
use crate::control::Control;
use crate::dexel::{Passage, TriDexelRef};
use crate::error::Error;
use crate::lattice::{Cell, Frame, axes};
use crate::octree::{Octree, Proof, Tag};
use crate::solid::{Classifier, FreeParts, OneByOne, Question, Verdict, WholeQuestion, Worker};

/// Builds the octree of a tri-dexel model from the ends of its intervals. A finest cell is FULL if all rays
/// through it are inside along the whole cell, EMPTY if all are outside along the whole cell, and PARTIAL if
/// an end lies in the cell or the directions disagree. An end that lies exactly in a face between two cells
/// lies in neither cell.
///
/// **What the cells prove.** A decided cell agrees with every ray through it, as far as the model stores the
/// ends of the ray. Along the rays nothing is rounded to cells: a feature thinner than a cell is undecided
/// where a ray meets it, not lost. **What they do not prove.** A cell has one ray of each direction, through
/// its middle. A surface may cut off the corners of a cell, and no ray sees what lies between the rays. So
/// the cells prove nothing about the solid from which the rays came ([`Proof`]), and the volumes of the FULL
/// and of the PARTIAL cells are no proven bounds. Where the surface is smooth and the cells are small, the
/// true volume usually lies between these volumes.
///
/// The result is canonical. The space around the universe is EMPTY. A model without rays gives an EMPTY
/// octree.
///
/// O(depth · rays of the lattice · log intervals of a ray). The lattice has one ray for each cell on the
/// faces of the universe. The result is the same for any number of threads.
///
/// # Errors
/// [`Error::OutOfMemory`], and cancellation or an exceeded limit of `control`.
///
/// ```
/// use leafless::op::octree_from_dexel_ends;
/// use leafless::{Control, Frame, TriDexel, dexel::{Dexel, DexelEnd, DexelFormat}};
/// let (frame, control) = (Frame::new([0.0; 3], 8.0, 3)?, Control::default());
/// let end = DexelEnd::new;
/// let plate = |_: usize, _: [u32; 2], list: &mut Vec<Dexel>| {
///     list.push(Dexel { start: end(2.0), end: end(4.25), material: 0 });
///     Ok(())
/// };
/// let model = TriDexel::from_rays(&frame, DexelFormat::default(), [false, false, true], plate, &control)?;
/// let tree = octree_from_dexel_ends(model.view(), &control)?;
/// // Two layers of cells are inside; the next one is undecided.
/// let volume = tree.statistics().volume();
/// assert_eq!((volume.lower, volume.upper), (2.0 * 64.0, 3.0 * 64.0));
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn octree_from_dexel_ends(model: &TriDexelRef<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    model.sound()?;
    build_on(&Ends { model: *model }, Rule::Certified, control)
}

/// A model as a solid that decides which cells contain ends.
#[derive(Clone, Copy)]
struct Ends<'a> {
    model: TriDexelRef<'a>,
}

impl Ends<'_> {
    fn verdict(&self, cell: Cell) -> Verdict<()> {
        let shift = self.model.frame().depth() - cell.level;
        match self.model.passages(&axes(|axis| cell.at[axis] << shift..(cell.at[axis] + 1) << shift)) {
            None | Some(Passage::Outside) => Verdict::Empty,
            Some(Passage::Inside(_) | Passage::Mixed) => Verdict::Full,
            Some(Passage::Crossed) => Verdict::Partial(()),
        }
    }
}

impl Classifier for Ends<'_> {
    type Worker = Self;

    fn frame(&self) -> &Frame {
        self.model.frame()
    }

    fn worker(&self) -> Result<Self, Error> {
        Ok(*self)
    }

    fn exterior(&self) -> Tag {
        Tag::Empty
    }

    fn proof(&self) -> Proof {
        Proof::new(false, false)
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

impl FreeParts for Ends<'_> {
    type Part = ();
}

impl OneByOne for Ends<'_> {}

impl Worker for Ends<'_> {
    fn frame(&self) -> &Frame {
        self.model.frame()
    }

    fn root(&mut self) -> Result<Verdict<()>, Error> {
        Ok(self.verdict(Cell::ROOT))
    }

    fn split(&mut self, cell: Cell, _: &()) -> Result<[Verdict<()>; 8], Error> {
        Ok(core::array::from_fn(|octant| self.verdict(cell.child(octant as u8))))
    }

    fn answer(&mut self, _: Cell, _: &(), _: Question<'_>) -> Result<(), Error> {
        Ok(())
    }
}
