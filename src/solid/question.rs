//! What may be asked of a solid beside its cells.

use super::{
    BoundaryFacets, BoundaryPieces, BoxContent, Classifier, Crossing, Enclosure, NearestSurface,
    OpenSurfaces, PlacedHalfSpace, RayQuestion, RayTrace, Segment, Slab, Worker,
};
use crate::control::Control;
use crate::cut;
use crate::dexel::Beam;
use crate::error::Error;
use crate::lattice::{Bounds, Cell, CellMoments, Interval, Ray, VolumeMoments};
use alloc::vec::Vec;

/// A question about one PARTIAL cell, with the place for the answer, in which nothing is to be before.
/// Nothing is put there where nothing is known.
///
/// The answers are proven as verdicts are, and depend on the cell and the shape alone. Questions may be
/// added: a worker answers those that it knows, and passes over the others. A wrapper hands the question on.
#[non_exhaustive]
pub enum Question<'q> {
    /// Whether the centre of the cell, which has the frame's depth, lies in the solid. A centre on the
    /// boundary is decided as if all centres were shifted by (ε, ε², ε³), to first order: on a curved surface
    /// too, the first axis that leads across it decides.
    Centre(&'q mut Option<bool>),

    /// Slabs between which the boundary lies in the cell, by the law that [`Enclosure`] states.
    Enclosure(&'q mut Option<Enclosure>),

    /// Volume and moments of the solid in the cell, if they are known better than by an enclosure.
    Moments(&'q mut Option<CellMoments>),

    /// Bounds of the area that the boundary has in the cell, in squares of the cell's half edge, if any are
    /// known beside those by an enclosure with a cone.
    Area(&'q mut Option<Interval>),

    /// Where a segment with both ends in the closed cell first crosses the boundary, by the law that
    /// [`Crossing`] states. Nothing if it does not, or the solid cannot tell.
    Crossing(&'q Segment, &'q mut Option<Crossing>),

    /// Where rays through the centres of finest cells enter and leave the solid in the cell, if that is known
    /// for all rays that the beam asks for.
    Chords(Chords<'q>),

    /// Which surfaces of the classifier's list ([`WholeQuestion::Surfaces`]) cross the cell, and which
    /// function of their signs the solid is, by the law that [`OpenSurfaces`] states. Nothing if there are
    /// too many, the solid is made otherwise, or nobody has asked for the list yet.
    Surfaces(&'q mut Option<OpenSurfaces>),

    /// The same of the list with layers ([`WholeQuestion::Layers`]): where nothing exact is known of a
    /// surface, planes with a width may stand for it.
    Layers(LayersQuestion<'q>),

    /// Where a ray goes in and out of the solid in the cell: of the root, in the universe. Beyond the cell
    /// the trace need not be right. Nothing is told unless [`WholeQuestion::Direct`] was asked before.
    Ray(RayQuestion<'q>),

    /// Which point of the whole boundary is nearest to a point (model units): asked of the root alone.
    /// Nothing is told unless [`WholeQuestion::Direct`] was asked before.
    Nearest([f64; 3], &'q mut Option<NearestSurface>),

    /// How a box in the universe lies to the solid: asked of the root alone. Nothing is told unless
    /// [`WholeQuestion::Direct`] was asked before.
    Box(&'q Bounds, &'q mut Option<BoxContent>),
}

/// How thick layers may be, with the places for the answer.
pub struct LayersQuestion<'q> {
    /// No point of a layer is to be further than twice this from the surface (model units).
    pub tolerance: f64,
    /// Layers for this cell alone are added: a surface with the number [`OpenSurfaces::OWN`] + i is number i
    /// of these.
    pub own: &'q mut Vec<PlacedHalfSpace>,
    /// The function, of surfaces of the list and own ones.
    pub known: &'q mut Option<OpenSurfaces>,
}

impl LayersQuestion<'_> {
    /// How wide any layer may be, as a share of the tolerance. Next to a wall of the cell a point in it is up
    /// to 1 + √3 of its widths away from the surface, which is to be less than twice the tolerance.
    pub(crate) const SHARE: f64 = 0.7;

    /// Whether a layer that alone bounds the solid in a cell is thin enough for a tolerance, in half edges of
    /// the cell. (It may get a little thicker when it is stored.)
    pub(crate) fn admits(slab: &Slab, tolerance: f64) -> bool {
        let width = (slab.outer - slab.inner) / libm::sqrt(slab.normal.iter().map(|c| c * c).sum::<f64>());
        // (What is no number is not less.)
        width <= Self::SHARE * tolerance || width <= tolerance && cut::stray(slab) <= 1.9 * tolerance
    }
}

/// The place for intervals of rays.
pub struct Chords<'q> {
    /// The rays. Their intervals in the cell are added; each holds just those centres that
    /// [`Question::Centre`] would find inside.
    pub beam: &'q mut Beam,
    /// Set once the intervals of all rays have been added.
    pub found: &'q mut bool,
    /// Intervals that the beam held before the question.
    first: usize,
}

impl<'q> Question<'q> {
    /// The question for the intervals of a beam's rays.
    pub fn chords(beam: &'q mut Beam, found: &'q mut bool) -> Question<'q> {
        let first = beam.len();
        Question::Chords(Chords { beam, found, first })
    }

    /// Makes the answer to a question about a solid that of its complement.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn complement(self) -> Result<(), Error> {
        match self {
            Question::Centre(inside) => *inside = inside.map(|inside| !inside),
            Question::Enclosure(known) => *known = known.map(|known| known.complement()),
            Question::Moments(known) => *known = known.map(|known| known.complement()),
            Question::Area(_) => {}
            Question::Surfaces(known) | Question::Layers(LayersQuestion { known, .. }) => {
                *known = known.map(|known| known.complement());
            }
            Question::Crossing(_, known) => *known = known.map(|known| known.complement()),
            Question::Ray(RayQuestion { trace, .. }) => trace.complement(),
            Question::Nearest(_, known) => *known = known.map(NearestSurface::complement),
            Question::Box(_, known) => *known = known.map(BoxContent::complement),
            Question::Chords(Chords { beam, found, first }) => {
                if *found {
                    beam.complement(first)?;
                }
            }
        }
        Ok(())
    }

    /// The same question once more: another borrow of the same places.
    pub fn again(&mut self) -> Question<'_> {
        match self {
            Question::Centre(inside) => Question::Centre(inside),
            Question::Enclosure(known) => Question::Enclosure(known),
            Question::Moments(known) => Question::Moments(known),
            Question::Area(known) => Question::Area(known),
            Question::Crossing(segment, known) => Question::Crossing(segment, known),
            Question::Chords(Chords { beam, found, first }) => {
                Question::Chords(Chords { beam, found, first: *first })
            }
            Question::Surfaces(known) => Question::Surfaces(known),
            Question::Layers(LayersQuestion { tolerance, own, known }) => {
                Question::Layers(LayersQuestion { tolerance: *tolerance, own, known })
            }
            Question::Ray(RayQuestion { ray, is_first_enough, trace }) => {
                Question::Ray(RayQuestion { ray, is_first_enough: *is_first_enough, trace })
            }
            Question::Nearest(point, known) => Question::Nearest(*point, known),
            Question::Box(bounds, known) => Question::Box(bounds, known),
        }
    }
}

/// The questions as functions. Every worker has them, and none can change them: they ask [`Worker::answer`].
pub trait Ask: Worker {
    /// Whether the centre of a PARTIAL cell of the frame's depth lies in the solid: [`Question::Centre`].
    ///
    /// # Errors
    /// As all questions.
    #[inline(always)]
    fn sample(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<bool>, Error> {
        let mut inside = None;
        self.answer(cell, part, Question::Centre(&mut inside))?;
        Ok(inside)
    }

    /// Slabs between which the boundary lies in a PARTIAL cell: [`Question::Enclosure`].
    ///
    /// # Errors
    /// As all questions.
    #[inline(always)]
    fn enclosure(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<Enclosure>, Error> {
        let mut known = None;
        self.answer(cell, part, Question::Enclosure(&mut known))?;
        Ok(known)
    }

    /// Volume and moments of the solid in a PARTIAL cell: [`Question::Moments`].
    ///
    /// # Errors
    /// As all questions.
    #[inline(always)]
    fn moments(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<CellMoments>, Error> {
        let mut known = None;
        self.answer(cell, part, Question::Moments(&mut known))?;
        Ok(known)
    }

    /// Bounds of the area that the boundary has in a PARTIAL cell: [`Question::Area`].
    ///
    /// # Errors
    /// As all questions.
    #[inline(always)]
    fn area(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<Interval>, Error> {
        let mut known = None;
        self.answer(cell, part, Question::Area(&mut known))?;
        Ok(known)
    }

    /// Where a segment in a PARTIAL cell first crosses the boundary: [`Question::Crossing`].
    ///
    /// # Errors
    /// As all questions.
    #[inline(always)]
    fn crossing(
        &mut self,
        cell: Cell,
        part: &Self::Part,
        segment: &Segment,
    ) -> Result<Option<Crossing>, Error> {
        let mut known = None;
        self.answer(cell, part, Question::Crossing(segment, &mut known))?;
        Ok(known)
    }

    /// Adds the intervals of rays in a PARTIAL cell, if they are known: [`Question::Chords`].
    ///
    /// # Errors
    /// As all questions.
    #[inline(always)]
    fn chords(&mut self, cell: Cell, part: &Self::Part, beam: &mut Beam) -> Result<bool, Error> {
        let mut found = false;
        self.answer(cell, part, Question::chords(beam, &mut found))?;
        Ok(found)
    }

    /// Which surfaces cross a PARTIAL cell, and which function of them the solid is: [`Question::Surfaces`].
    ///
    /// # Errors
    /// As all questions.
    #[inline(always)]
    fn surfaces(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<OpenSurfaces>, Error> {
        let mut known = None;
        self.answer(cell, part, Question::Surfaces(&mut known))?;
        Ok(known)
    }
}

impl<W: Worker + ?Sized> Ask for W {}

/// The same, for wrappers and builders.
pub(crate) trait AskLayers: Worker {
    /// Which surfaces and layers cross a PARTIAL cell, and which function of them the solid is:
    /// [`Question::Layers`].
    ///
    /// # Errors
    /// As all questions.
    fn layers(
        &mut self,
        cell: Cell,
        part: &Self::Part,
        tolerance: f64,
        own: &mut Vec<PlacedHalfSpace>,
    ) -> Result<Option<OpenSurfaces>, Error> {
        let mut known = None;
        let question = LayersQuestion { tolerance, own, known: &mut known };
        self.answer(cell, part, Question::Layers(question))?;
        Ok(known)
    }
}

impl<W: Worker + ?Sized> AskLayers for W {}

/// The questions about the universe that are answered without a descent.
pub(crate) trait AskDirect: Worker {
    /// Where a ray goes in and out of the solid: [`Question::Ray`]. `trace` is overwritten.
    ///
    /// # Errors
    /// As all questions.
    #[inline]
    fn trace(
        &mut self,
        root: &Self::Part,
        ray: &Ray,
        is_first_enough: bool,
        trace: &mut RayTrace,
    ) -> Result<(), Error> {
        trace.clear();
        self.answer(Cell::ROOT, root, Question::Ray(RayQuestion { ray, is_first_enough, trace }))
    }

    /// Which point of the boundary is nearest to a point: [`Question::Nearest`].
    ///
    /// # Errors
    /// As all questions.
    #[inline]
    fn nearest(&mut self, root: &Self::Part, point: [f64; 3]) -> Result<Option<NearestSurface>, Error> {
        let mut known = None;
        self.answer(Cell::ROOT, root, Question::Nearest(point, &mut known))?;
        Ok(known)
    }

    /// How a box in the universe lies to the solid: [`Question::Box`].
    ///
    /// # Errors
    /// As all questions.
    fn content_of(&mut self, root: &Self::Part, bounds: &Bounds) -> Result<Option<BoxContent>, Error> {
        let mut known = None;
        self.answer(Cell::ROOT, root, Question::Box(bounds, &mut known))?;
        Ok(known)
    }
}

impl<W: Worker + ?Sized> AskDirect for W {}

/// A question about a whole shape on a frame, inside and outside of the universe, with the place for the
/// answer, in which nothing is to be before. Nothing is put there where nothing is known. The answers are
/// proven as verdicts are.
#[non_exhaustive]
pub enum WholeQuestion<'q> {
    /// The volume and the moments, if they are known without splitting cells.
    Moments(&'q mut Option<VolumeMoments>),

    /// The area of the boundary (square model units), if it is known without splitting cells.
    Area(&'q mut Option<Interval>),

    /// Whether no piece of the boundary lies in a plane of the lattice, so that all area of the boundary lies
    /// in open PARTIAL cells. The flag is set if that is known.
    OffLattice(&'q mut bool),

    /// The surfaces that cells are crossed by, which [`Question::Surfaces`] tells by their places in this
    /// list. Surfaces may be equal.
    Surfaces(&'q mut Option<Vec<PlacedHalfSpace>>),

    /// The surfaces that cells are crossed by, and planes with a width that stand for such of which nothing
    /// exact is known: the list of [`Question::Layers`]. A solid that tells nothing has none but its
    /// [`Surfaces`](Self::Surfaces).
    Layers(&'q mut Option<Vec<PlacedHalfSpace>>),

    /// Whether questions of this kind about the universe are answered without a descent as a rule. What that
    /// takes is made now, once, and kept for all that share the shape; the flag is set if there is such a
    /// thing.
    Direct(Direct, &'q mut bool),

    /// The triangles that the whole boundary consists of, none of which lies inside of the solid or outside
    /// of it, if there are such and all of the boundary lies in the universe. Whether the solid or its
    /// complement is meant does not matter.
    Facets(&'q mut Option<BoundaryFacets>),

    /// The same where triangles intersect: those are cut into pieces, and where pieces meet others they have
    /// sides no longer than the given size (model units).
    Pieces(f64, &'q mut Option<BoundaryPieces>),

    /// The triangles of [`Facets`](Self::Facets) with triangles beside those of the boundary, all of which
    /// lie in the closed solid, or, if its complement is meant, outside of that.
    Walls(&'q mut Option<BoundaryFacets>),
}

/// A kind of questions about the universe that some solids answer without a descent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Direct {
    /// [`Question::Ray`].
    Rays,
    /// [`Batch::inside`](super::Batch::inside).
    Points,
    /// [`Question::Nearest`].
    Distances,
    /// [`Question::Box`].
    Boxes,
}

/// The questions about whole shapes as functions. Every classifier has them, and none can change them: they
/// ask [`Classifier::answer_whole`].
pub trait AskWhole: Classifier {
    /// The volume and the moments of the shape: [`WholeQuestion::Moments`].
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`] by `control`.
    fn moments(&self, control: &Control<'_>) -> Result<Option<VolumeMoments>, Error> {
        let mut known = None;
        self.answer_whole(WholeQuestion::Moments(&mut known), control)?;
        Ok(known)
    }

    /// The area of the shape's boundary: [`WholeQuestion::Area`].
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn area(&self, control: &Control<'_>) -> Result<Option<Interval>, Error> {
        let mut known = None;
        self.answer_whole(WholeQuestion::Area(&mut known), control)?;
        Ok(known)
    }

    /// The surfaces that cells are crossed by, if the shape is made of such: [`WholeQuestion::Surfaces`].
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn surfaces(&self, control: &Control<'_>) -> Result<Option<Vec<PlacedHalfSpace>>, Error> {
        let mut known = None;
        self.answer_whole(WholeQuestion::Surfaces(&mut known), control)?;
        Ok(known)
    }

    /// The surfaces and layers that cells are crossed by: [`WholeQuestion::Layers`].
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn layers(&self, control: &Control<'_>) -> Result<Option<Vec<PlacedHalfSpace>>, Error> {
        let mut known = None;
        self.answer_whole(WholeQuestion::Layers(&mut known), control)?;
        Ok(known)
    }

    /// Whether questions of a kind are answered without a descent, and gets ready for them:
    /// [`WholeQuestion::Direct`].
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn is_direct(&self, kind: Direct, control: &Control<'_>) -> Result<bool, Error> {
        let mut is_direct = false;
        self.answer_whole(WholeQuestion::Direct(kind, &mut is_direct), control)?;
        Ok(is_direct)
    }

    /// The triangles that the whole boundary consists of: [`WholeQuestion::Facets`].
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn facets(&self, control: &Control<'_>) -> Result<Option<BoundaryFacets>, Error> {
        let mut known = None;
        self.answer_whole(WholeQuestion::Facets(&mut known), control)?;
        Ok(known)
    }

    /// The triangles and pieces of triangles that the whole boundary consists of: [`WholeQuestion::Pieces`].
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn pieces(&self, size: f64, control: &Control<'_>) -> Result<Option<BoundaryPieces>, Error> {
        let mut known = None;
        self.answer_whole(WholeQuestion::Pieces(size, &mut known), control)?;
        Ok(known)
    }

    /// Triangles in the closed solid among which its whole boundary is: [`WholeQuestion::Walls`].
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn walls(&self, control: &Control<'_>) -> Result<Option<BoundaryFacets>, Error> {
        let mut known = None;
        self.answer_whole(WholeQuestion::Walls(&mut known), control)?;
        Ok(known)
    }

    /// Whether no piece of the boundary is known to lie in a plane of the lattice:
    /// [`WholeQuestion::OffLattice`].
    fn is_off_lattice(&self) -> bool {
        let mut known = false;
        // (What cannot be found out is not known.)
        self.answer_whole(WholeQuestion::OffLattice(&mut known), &Control::default()).is_ok() && known
    }
}

impl<C: Classifier> AskWhole for C {}
