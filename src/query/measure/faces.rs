//! A solid whose cells include the boundary pieces in their faces.
//!
//! A piece of the boundary in a plane of the lattice lies in no open cell. It lies where the solids on both
//! sides of a face differ. Each cell therefore carries its lower neighbour along each axis. It counts the
//! pieces in its three lower faces, and those in upper faces that lie in the universe's hull. Pieces of the
//! hull count if the outside is decided.
//!
//! Faces without pieces are not visited again, nor are parts of them:
//! - There is no piece between the children of a cell, if no surface of the cell holds a piece of a plane of
//!   the lattice. The cells below such a cut cell are queried without faces.
//! - There is no piece between two cut cells if the functions of their surfaces are the same. (But a surface
//!   may vanish on the face, and be positive on one side and negative on the other: then its signs there are
//!   unrelated.)
//!
//! Between a cut cell and a decided cell, the piece is the section of the cut cell with the face, or the rest
//! of the face.

use crate::control::Control;
use crate::cut::Section;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, Frame, Interval};
use crate::octree::{Proof, Tag};
use crate::solid::{
    Ask, AskWhole, Classifier, OCTANTS, OneByOne, OpenSurfaces, Parts, Question, Verdict, WholeQuestion,
    Worker,
};
use alloc::sync::Arc;
use alloc::vec::Vec;

/// A solid that provides the functions of surfaces in its cells ([`Question::Surfaces`]).
#[derive(Clone)]
pub(super) struct WithFaces<C> {
    inner: C,
    surfaces: Arc<[Holds]>,
}

/// The kinds of pieces that a surface may hold.
#[derive(Clone, Copy)]
struct Holds {
    /// Pieces of planes of the lattice.
    of_lattice: bool,
    /// Pieces of faces of cells that the surface crosses.
    of_faces: bool,
}

impl<C: Classifier> WithFaces<C> {
    /// Builds the wrapper; `None` if the solid does not consist of known surfaces.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`]; [`Error::Cancelled`] by `control`; [`Error::Limit`] if the exact map of a
    /// surface's placements is too long.
    pub(super) fn new(inner: C, control: &Control<'_>) -> Result<Option<WithFaces<C>>, Error> {
        let Some(surfaces) = inner.surfaces(control)? else { return Ok(None) };
        let mut holds = Vec::new();
        holds.try_reserve_exact(surfaces.len())?;
        for surface in &surfaces {
            let placed = surface.on(inner.frame())?;
            let of_lattice = placed.may_hold_lattice_plane(inner.frame().depth());
            holds.push(Holds { of_lattice, of_faces: placed.may_hold_face() });
        }
        Ok(Some(WithFaces { inner, surfaces: holds.into() }))
    }
}

impl<C: Classifier> Classifier for WithFaces<C> {
    type Worker = WithFacesWorker<C::Worker>;

    fn frame(&self) -> &Frame {
        self.inner.frame()
    }

    fn worker(&self) -> Result<Self::Worker, Error> {
        Ok(WithFacesWorker {
            inner: self.inner.worker()?,
            outside: match self.inner.exterior() {
                Tag::Empty => Some(Verdict::Empty),
                Tag::Full => Some(Verdict::Full),
                Tag::Partial | Tag::Branch => None,
            },
            surfaces: self.surfaces.clone(),
        })
    }

    fn exterior(&self) -> Tag {
        self.inner.exterior()
    }

    fn proof(&self) -> Proof {
        self.inner.proof()
    }

    fn answer_whole(&self, _: WholeQuestion<'_>, _: &Control<'_>) -> Result<(), Error> {
        Ok(())
    }
}

pub(super) struct WithFacesWorker<W: Worker> {
    inner: W,
    /// The verdict of the space outside of the universe, if it is decided.
    outside: Outside<W>,
    surfaces: Arc<[Holds]>,
}

type Outside<W> = Option<Verdict<<W as Parts>::Part>>;

/// A cell with its neighbours.
#[derive(Clone)]
pub(super) struct WithNeighbours<P> {
    own: Verdict<P>,
    /// The lower neighbour along each axis; `None` if the face between holds no piece, or does not count.
    below: [Option<Verdict<P>>; 3],
}

/// The lower or the upper face of a cell.
#[derive(Clone, Copy)]
enum End {
    Lower,
    Upper,
}

/// The area of a face, in squares of the cell's half edge.
const FACE: Interval = Interval::exactly(4.0);
const UNKNOWN: Interval = Interval::between(0.0, 4.0);
const ZERO: Interval = Interval::exactly(0.0);

impl<W: Worker> Parts for WithFacesWorker<W> {
    type Part = WithNeighbours<W::Part>;

    fn mark(&self) -> usize {
        self.inner.mark()
    }

    fn release(&mut self, mark: usize) {
        self.inner.release(mark);
    }

    fn scratch_bytes(&self) -> usize {
        self.inner.scratch_bytes()
    }

    fn hand_over(&mut self, from: &Self, part: &Self::Part) -> Result<Self::Part, Error> {
        let mut over = |verdict: &Verdict<W::Part>| {
            verdict.clone().try_map(|part| self.inner.hand_over(&from.inner, &part))
        };
        let own = over(&part.own)?;
        let mut below = [const { None }; 3];
        for (to, verdict) in below.iter_mut().zip(&part.below) {
            *to = verdict.as_ref().map(&mut over).transpose()?;
        }
        Ok(WithNeighbours { own, below })
    }
}

impl<W: Worker> OneByOne for WithFacesWorker<W> {}

impl<W: Worker> WithFacesWorker<W> {
    /// Returns the verdict of a cell with its neighbours.
    fn verdict(
        &self,
        cell: Cell,
        own: Verdict<W::Part>,
        below: [Option<Verdict<W::Part>>; 3],
    ) -> Verdict<WithNeighbours<W::Part>> {
        let is = |tag: Tag| {
            let is_same = |verdict: &Verdict<W::Part>| verdict.tag() == tag;
            own.tag() == tag
                && below.iter().flatten().all(is_same)
                && self.outside.iter().all(|outside| is_same(outside) || !touches_upper_hull(cell))
        };
        let is_unknown = |verdict: &Verdict<W::Part>| matches!(verdict, Verdict::Undecided);
        // An undecided neighbour has no upper bound of the common area, and an undecided cell has none
        // either.
        if is_unknown(&own) || below.iter().flatten().any(is_unknown) {
            Verdict::Undecided
        } else if is(Tag::Empty) {
            Verdict::Empty
        } else if is(Tag::Full) {
            Verdict::Full
        } else {
            Verdict::Partial(WithNeighbours { own, below })
        }
    }

    fn children(&mut self, cell: Cell, verdict: &Verdict<W::Part>) -> Result<[Verdict<W::Part>; 8], Error> {
        match verdict {
            Verdict::Partial(part) => self.inner.split(cell, part),
            decided => Ok(OCTANTS.each(|_| decided.clone())),
        }
    }

    /// Returns the area of the boundary in the face between a cell and a neighbour, in squares of the cell's
    /// half edge.
    fn area_of_face(
        &mut self,
        axis: usize,
        end: End,
        (cell, own): (Cell, &Verdict<W::Part>),
        (neighbour, other): (Cell, &Verdict<W::Part>),
    ) -> Result<Interval, Error> {
        let (near, far) = match end {
            End::Lower => (-1.0, 1.0),
            End::Upper => (1.0, -1.0),
        };
        let a = self.section(axis, near, cell, own)?;
        let b = self.section(axis, far, neighbour, other)?;
        // Only the areas of both sets are known. The area of their difference is at least the difference of
        // the areas. It is at most the sum of the areas, and at most the sum of the missing areas.
        let (sum, apart) = (a.plus(b), a.minus(b));
        let rest = Interval::exactly(8.0).minus(sum);
        let least = apart.lower.max(-apart.upper).max(0.0);
        let most = sum.upper.min(rest.upper).min(4.0);
        Ok(Interval::new(least, most).unwrap_or(UNKNOWN))
    }

    /// Returns the area of the solid in a face of a cell, seen from within.
    fn section(
        &mut self,
        axis: usize,
        at: f64,
        cell: Cell,
        verdict: &Verdict<W::Part>,
    ) -> Result<Interval, Error> {
        Ok(match verdict {
            Verdict::Empty => ZERO,
            Verdict::Full => FACE,
            Verdict::Undecided => UNKNOWN,
            Verdict::Partial(part) => match self.inner.enclosure(cell, part)? {
                None => UNKNOWN,
                Some(enclosure) => {
                    let order = [(axis + 1) % 3, (axis + 2) % 3, axis];
                    Section::new(order, [0.0; 2], -at).of(&enclosure).common(UNKNOWN).unwrap_or(UNKNOWN)
                }
            },
        })
    }

    /// True if no surface of a cell holds a piece of a plane of the lattice.
    fn is_off_lattice(&mut self, cell: Cell, verdict: &Verdict<W::Part>) -> Result<bool, Error> {
        let Verdict::Partial(part) = verdict else { return Ok(true) };
        let Some(open) = self.inner.surfaces(cell, part)? else { return Ok(false) };
        Ok(open.indices().iter().all(|&index| self.holds(index).is_some_and(|holds| !holds.of_lattice)))
    }

    fn holds(&self, index: u32) -> Option<Holds> {
        self.surfaces.get(index as usize).copied()
    }

    /// True if the face between two cells holds no piece because the solid is the same on both sides.
    fn are_alike(
        &mut self,
        (cell, own): (Cell, &Verdict<W::Part>),
        (neighbour, other): (Cell, &Verdict<W::Part>),
    ) -> Result<bool, Error> {
        Ok(match (own, other) {
            (Verdict::Partial(a), Verdict::Partial(b)) => {
                match (self.inner.surfaces(cell, a)?, self.inner.surfaces(neighbour, b)?) {
                    (Some(a), Some(b)) => self.are_equal(&a, &b),
                    _ => false,
                }
            }
            (Verdict::Empty, Verdict::Empty) | (Verdict::Full, Verdict::Full) => true,
            _ => false,
        })
    }

    /// True if two functions are the same, and no surface separates the two sides of the face between them.
    fn are_equal(&self, a: &OpenSurfaces, b: &OpenSurfaces) -> bool {
        let mut all = a.indices().iter().chain(b.indices());
        if !all.all(|&index| self.holds(index).is_some_and(|holds| !holds.of_faces)) {
            return false;
        }
        let mut joined = OpenSurfaces::constant(false);
        let mut places = [[0; OpenSurfaces::MOST]; 2];
        for (places, open) in places.iter_mut().zip([a, b]) {
            for (place, &index) in places.iter_mut().zip(open.indices()) {
                let Some(number) = joined.number(index) else { return false };
                *place = number;
            }
        }
        (0..1u8 << joined.indices().len()).all(|signs| {
            let [a, b] = [(a, &places[0]), (b, &places[1])].each(|(open, places)| {
                let of_own = (0..).zip(&places[..open.indices().len()]);
                open.inside(of_own.fold(0, |own, (i, place)| own | (signs >> place & 1) << i))
            });
            a == b
        })
    }
}

fn lies_at_upper_hull(cell: Cell, axis: usize) -> bool {
    cell.at[axis] + 1 == 1 << cell.level
}

fn touches_upper_hull(cell: Cell) -> bool {
    (0..3).any(|axis| lies_at_upper_hull(cell, axis))
}

/// Returns the lower neighbour of a cell along an axis. (At the universe's hull the result is not used.)
fn below(mut cell: Cell, axis: usize) -> Cell {
    cell.at[axis] = cell.at[axis].wrapping_sub(1);
    cell
}

impl<W: Worker> Worker for WithFacesWorker<W> {
    fn frame(&self) -> &Frame {
        self.inner.frame()
    }

    fn root(&mut self) -> Result<Verdict<Self::Part>, Error> {
        let own = self.inner.root()?;
        let outside = [0; 3].each(|_| self.outside.clone());
        Ok(self.verdict(Cell::ROOT, own, outside))
    }

    fn split(&mut self, cell: Cell, part: &Self::Part) -> Result<[Verdict<Self::Part>; 8], Error> {
        let own = self.children(cell, &part.own)?;
        let mut beyond: [Option<[Verdict<W::Part>; 8]>; 3] = [const { None }; 3];
        for axis in 0..3 {
            if let Some(verdict) = &part.below[axis] {
                beyond[axis] = Some(self.children(below(cell, axis), verdict)?);
            }
        }
        let is_off_lattice = self.is_off_lattice(cell, &part.own)?;
        let mut verdicts = OCTANTS.each(|_| Verdict::Undecided);
        for k in OCTANTS {
            let (child, verdict) = (cell.child(k), &own[usize::from(k)]);
            let mut neighbours = [const { None }; 3];
            for (axis, neighbour) in neighbours.iter_mut().enumerate() {
                let across = usize::from(k ^ 1 << axis);
                let other = match k >> axis & 1 {
                    0 => beyond[axis].as_ref().map(|children| &children[across]),
                    _ => (!is_off_lattice).then_some(&own[across]),
                };
                if let Some(other) = other
                    && !self.are_alike((child, verdict), (below(child, axis), other))?
                {
                    *neighbour = Some(other.clone());
                }
            }
            verdicts[usize::from(k)] = self.verdict(child, verdict.clone(), neighbours);
        }
        Ok(verdicts)
    }

    fn answer(&mut self, cell: Cell, part: &Self::Part, question: Question<'_>) -> Result<(), Error> {
        let Question::Area(known) = question else { return Ok(()) };
        let mut sum = match &part.own {
            Verdict::Partial(own) => match self.inner.area(cell, own)? {
                Some(area) => area,
                None => return Ok(()),
            },
            _ => ZERO,
        };
        for axis in 0..3 {
            if let Some(verdict) = &part.below[axis] {
                let neighbour = (below(cell, axis), verdict);
                sum = sum.plus(self.area_of_face(axis, End::Lower, (cell, &part.own), neighbour)?);
            }
            if let Some(outside) = self.outside.clone()
                && lies_at_upper_hull(cell, axis)
            {
                sum = sum.plus(self.area_of_face(axis, End::Upper, (cell, &part.own), (cell, &outside))?);
            }
        }
        *known = Some(sum);
        Ok(())
    }
}
