//! Octrees of tri-dexel models, by cell centres.

use super::build::build_on;
use super::rule::Rule;
use crate::control::Control;
use crate::dexel::{Occupied, TriDexelRef};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, Frame};
use crate::octree::block::BLOCK_LEVELS;
use crate::octree::{Block, Octree, Proof, Tag};
use crate::solid::{Classifier, FreeParts, OneByOne, Question, Verdict, WholeQuestion, Worker};

/// Builds the octree of a tri-dexel model from the centres of its cells. A finest cell is FULL if its centre
/// lies inside, and EMPTY otherwise.
///
/// Where the directions of the model disagree (arrays from elsewhere may disagree), the highest axis that has
/// rays decides, as in [`TriDexelRef::contains_cell`]. A model without rays gives an EMPTY octree.
///
/// The result is canonical and binary. The space around the universe is EMPTY. As with
/// [`Rule::Sampled`](crate::Rule::Sampled), the cells prove nothing about the solid from which the rays came
/// ([`Proof`]).
///
/// O(rays + intervals + octree). The rays are those of the windows; empty rays cost next to nothing. A block
/// of 64³ cells in which no centre lies inside costs nothing. The result is the same for any number of
/// threads.
///
/// # Errors
/// [`Error::OutOfMemory`], and cancellation or an exceeded limit of `control`.
///
/// ```
/// use leafless::{Control, Frame, TriDexel, dexel::{Dexel, DexelEnd, DexelFormat}, op::octree_from_dexels};
/// let (frame, control) = (Frame::new([0.0; 3], 8.0, 3)?, Control::default());
/// let end = DexelEnd::new;
/// let plate = |_: usize, _: [u32; 2], list: &mut Vec<Dexel>| {
///     list.push(Dexel { start: end(2.0), end: end(4.25), material: 0 });
///     Ok(())
/// };
/// let model = TriDexel::from_rays(&frame, DexelFormat::default(), [false, false, true], plate, &control)?;
/// let tree = octree_from_dexels(model.view(), &control)?;
/// assert_eq!(tree.statistics().volume().lower, 2.0 * 64.0);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn octree_from_dexels(model: &TriDexelRef<'_>, control: &Control<'_>) -> Result<Octree, Error> {
    model.sound()?;
    let occupied = if model.frame().depth() >= BLOCK_LEVELS { Some(Occupied::of(model)?) } else { None };
    build_on(&Centres { model: *model, occupied: occupied.as_ref() }, Rule::Sampled, control)
}

/// A model as a solid that decides cell centres only.
#[derive(Clone, Copy)]
struct Centres<'a> {
    model: TriDexelRef<'a>,
    /// The places where a centre lies inside, if the lattice has blocks.
    occupied: Option<&'a Occupied>,
}

impl Centres<'_> {
    /// The verdict on a cell before its centres are tested.
    fn verdict(&self, cell: Cell) -> Verdict<()> {
        match self.occupied {
            Some(occupied) if !occupied.meets(cell.level, cell.at) => Verdict::Empty,
            _ => Verdict::Partial(()),
        }
    }
}

impl Classifier for Centres<'_> {
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

impl FreeParts for Centres<'_> {
    type Part = ();
}

impl OneByOne for Centres<'_> {}

impl Worker for Centres<'_> {
    fn frame(&self) -> &Frame {
        self.model.frame()
    }

    fn root(&mut self) -> Result<Verdict<()>, Error> {
        Ok(self.verdict(Cell::ROOT))
    }

    fn split(&mut self, cell: Cell, _: &()) -> Result<[Verdict<()>; 8], Error> {
        Ok(core::array::from_fn(|octant| self.verdict(cell.child(octant as u8))))
    }

    fn answer(&mut self, cell: Cell, _: &(), question: Question<'_>) -> Result<(), Error> {
        if let Question::Centre(inside) = question {
            *inside = Some(self.model.contains_cell(cell.at));
        }
        Ok(())
    }

    fn fill(&mut self, cell: Cell, _: &(), block: &mut Block) -> Result<bool, Error> {
        let Some(words) = block.centres_mut() else { return Ok(false) };
        if !self.model.fill_centres(cell.at.each(|a| 64 * a), 2, words) {
            words.fill(0);
        }
        Ok(true)
    }
}
