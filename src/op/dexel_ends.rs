//! Octrees of tri-dexel models, by the ends of intervals.

use super::build::build_on;
use super::rule::Rule;
use crate::control::Control;
use crate::dexel::{Passage, TriDexelRef};
use crate::error::Error;
use crate::lattice::{Cell, Frame, axes};
use crate::octree::{Octree, Proof, Tag};
use crate::solid::{Classifier, FreeParts, OneByOne, Question, Verdict, WholeQuestion, Worker};

/// The octree of a tri-dexel model by the ends of its intervals: a finest cell is FULL if all rays through it
/// are inside all the way, EMPTY if all are outside all the way, and PARTIAL if an end lies in it or the
/// directions disagree. An end that lies just in a face between two cells lies in neither.
///
/// **What that proves.** A decided cell agrees with every ray through it, as far as the model stores their
/// ends: along the rays nothing is rounded to cells, and what is thinner than a cell is undecided where a ray
/// meets it, not lost. **What it does not prove.** A cell has one ray of a direction, through its middle. A
/// surface may cut off its corners, and what lies between the rays is seen by none; so the cells prove
/// nothing of the solid that the rays came from ([`Proof`]), and the volumes of FULL and of PARTIAL cells are
/// no proven bounds. Where the surface is smooth and the cells are small, the true volume lies between them
/// as a rule.
///
/// The result is canonical. Around the universe it is EMPTY. A model without rays gives an EMPTY octree.
///
/// O(depth · rays of the lattice · log intervals of a ray), with as many rays as cells on the faces of the
/// universe. The same for any number of threads.
///
/// # Errors
/// [`Error::OutOfMemory`], and what `control` asks for.
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

/// A model that says which cells hold ends.
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
