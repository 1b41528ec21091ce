//! Test solids that are stateless functions of cubes.

use super::exact::Definition;
use leafless::lattice::Cube;
use leafless::octree::Block;
use leafless::solid::{Batch, FreeParts, Question, WholeQuestion, sample_one_by_one, split_one_by_one};
use leafless::{Bounds, Cell, Classifier, Control, Csg, Error, Frame, Proof, Tag, Verdict, Worker};

/// A shape whose verdict on a cell depends on the cell alone. [`solid_of_cubes`] makes solids of types that
/// implement this trait.
pub trait Cubes: Clone + Send + Sync {
    /// True if the worker can recall a part without the cells above it.
    const RECALLS: bool = false;

    fn verdict(&self, cube: &Cube<'_>) -> Result<Verdict<()>, Error>;

    fn sample(&self, _: &Cube<'_>) -> Result<Option<bool>, Error> {
        Ok(None)
    }

    fn fill(&self, _: &Cube<'_>, _: &mut Block) -> Result<bool, Error> {
        Ok(false)
    }

    fn exterior(&self, _: &Frame) -> Tag {
        Tag::Partial
    }

    fn bounds(&self) -> Option<Bounds> {
        None
    }

    /// Returns whether no piece of the boundary lies in a plane of any lattice.
    fn is_off_lattice(&self) -> bool {
        false
    }
}

/// A shape on a frame, which is both the classifier and its worker.
#[derive(Clone)]
pub struct OnFrame<T> {
    shape: T,
    frame: Frame,
}

impl<T> OnFrame<T> {
    pub fn new(shape: T, frame: &Frame) -> OnFrame<T> {
        OnFrame { shape, frame: *frame }
    }
}

impl<T: Cubes> Classifier for OnFrame<T> {
    type Worker = OnFrame<T>;

    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn worker(&self) -> Result<OnFrame<T>, Error> {
        Ok(self.clone())
    }

    fn exterior(&self) -> Tag {
        self.shape.exterior(&self.frame)
    }

    fn proof(&self) -> Proof {
        Proof::CERTIFIED
    }

    fn answer_whole(&self, question: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        if let WholeQuestion::OffLattice(known) = question {
            *known = self.shape.is_off_lattice();
        }
        Ok(())
    }
}

impl<T: Cubes> FreeParts for OnFrame<T> {
    type Part = ();
}

impl<T: Cubes> Batch for OnFrame<T> {
    fn likes_many(&self) -> bool {
        false
    }

    fn split_many(
        &mut self,
        cells: &[(Cell, ())],
        control: &Control<'_>,
        verdicts: &mut Vec<[Verdict<()>; 8]>,
    ) -> Result<(), Error> {
        split_one_by_one(self, cells, control, verdicts)
    }

    fn sample_many(
        &mut self,
        cells: &[(Cell, ())],
        control: &Control<'_>,
        inside: &mut Vec<Option<bool>>,
    ) -> Result<(), Error> {
        sample_one_by_one(self, cells, control, inside)
    }

    fn inside(&mut self, _: &[[f64; 3]], _: &mut [Option<bool>]) -> Result<(), Error> {
        Ok(())
    }

    fn recall(&mut self, _: Cell) -> Option<()> {
        T::RECALLS.then_some(())
    }
}

impl<T: Cubes> Worker for OnFrame<T> {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn root(&mut self) -> Result<Verdict<()>, Error> {
        self.shape.verdict(&Cube { frame: &self.frame, cell: Cell::ROOT })
    }

    fn split(&mut self, cell: Cell, _: &()) -> Result<[Verdict<()>; 8], Error> {
        let mut verdicts = [Verdict::Undecided; 8];
        for (octant, verdict) in (0..8).zip(&mut verdicts) {
            *verdict = self.shape.verdict(&Cube { frame: &self.frame, cell: cell.child(octant) })?;
        }
        Ok(verdicts)
    }

    fn answer(&mut self, cell: Cell, _: &(), question: Question<'_>) -> Result<(), Error> {
        let cube = Cube { frame: &self.frame, cell };
        if let Question::Centre(inside) = question {
            *inside = self.shape.sample(&cube)?;
        }
        Ok(())
    }

    fn fill(&mut self, cell: Cell, _: &(), block: &mut Block) -> Result<bool, Error> {
        self.shape.fill(&Cube { frame: &self.frame, cell }, block)
    }
}

/// Implements `Solid` for types with [`Cubes`]: `solid_of_cubes!(Ball, Dense<'a>: 'a)`.
#[macro_export]
macro_rules! solid_of_cubes {
    ($($type:ty $(: $life:lifetime)?),*) => {$(
        impl $(<$life>)? leafless::Solid for $type {
            type Classifier = $crate::cubes::OnFrame<$type>;

            fn on(
                &self,
                frame: &leafless::Frame,
                _: &leafless::Control<'_>,
            ) -> Result<Self::Classifier, leafless::Error> {
                Ok($crate::cubes::OnFrame::new(self.clone(), frame))
            }

            fn bounds(&self) -> Option<leafless::Bounds> {
                $crate::cubes::Cubes::bounds(self)
            }
        }
    )*};
}

/// A ball or a box by its definition: a solid that gives the library only verdicts, samples and bounds.
#[derive(Clone, Copy, Debug)]
pub struct Plain(Definition);

impl Plain {
    /// Makes a ball, with the errors of [`Csg::ball`].
    pub fn ball(centre: [f64; 3], radius: f64) -> Result<Plain, Error> {
        Csg::ball(centre, radius)?;
        Ok(Plain(Definition::Ball { centre, radius }))
    }

    /// Makes a box, with the errors of [`Csg::cuboid`].
    pub fn cuboid(min: [f64; 3], max: [f64; 3]) -> Result<Plain, Error> {
        Csg::cuboid(min, max)?;
        Ok(Plain(Definition::Box { min, max }))
    }

    /// Returns the verdict of a ball if doubles decide it. Exact arithmetic takes a hundred times as long.
    fn roughly(&self, cube: &Cube<'_>) -> Option<Tag> {
        let Definition::Ball { centre, radius } = self.0 else { return None };
        let (min, max) = cube.bounds();
        let (mut near, mut far, mut size) = (0.0, 0.0, radius * radius);
        for axis in 0..3 {
            let (low, high) = (min[axis] - centre[axis], max[axis] - centre[axis]);
            near += low.max(-high).max(0.0).powi(2);
            far += high.max(-low).powi(2);
            size += (cube.frame.origin()[axis].abs() + cube.frame.edge() + centre[axis].abs()).powi(2);
        }
        let [less, more] = [-1.0, 1.0].map(|side| radius * radius + side * 1e-12 * size);
        if far < less {
            Some(Tag::Full)
        } else if near > more {
            Some(Tag::Empty)
        } else if near < less && far > more {
            Some(Tag::Partial)
        } else {
            None
        }
    }
}

impl Cubes for Plain {
    fn is_off_lattice(&self) -> bool {
        matches!(self.0, Definition::Ball { .. })
    }

    const RECALLS: bool = true;

    fn verdict(&self, cube: &Cube<'_>) -> Result<Verdict<()>, Error> {
        let (low, high) = cube.planes();
        let tag = self.roughly(cube).unwrap_or_else(|| self.0.tag_between(cube.frame, low, high));
        Ok(match tag {
            Tag::Empty => Verdict::Empty,
            Tag::Full => Verdict::Full,
            _ => Verdict::Partial(()),
        })
    }

    fn sample(&self, cube: &Cube<'_>) -> Result<Option<bool>, Error> {
        Ok(Some(self.0.sampled(cube.frame, cube.cell.at)))
    }

    fn exterior(&self, frame: &Frame) -> Tag {
        if self.0.ends_inside(frame) { Tag::Empty } else { Tag::Partial }
    }

    fn bounds(&self) -> Option<Bounds> {
        let ends = |axis: usize| match self.0 {
            Definition::Ball { centre, radius } => {
                ((centre[axis] - radius).next_down(), (centre[axis] + radius).next_up())
            }
            Definition::Box { min, max } => (min[axis], max[axis]),
            Definition::HalfSpace { .. } => (f64::NEG_INFINITY, f64::INFINITY),
        };
        Bounds::new([0, 1, 2].map(|axis| ends(axis).0), [0, 1, 2].map(|axis| ends(axis).1))
    }
}

solid_of_cubes!(Plain);
