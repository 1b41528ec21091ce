//! Questions to a solid beyond the verdicts on its cells.

use super::super::{
    BoundaryFacets, BoundaryPieces, BoxContent, Crossing, Enclosure, NearestSurface, OpenSurfaces,
    PlacedHalfSpace, RayQuestion, RayTrace, Segment, Slab,
};
use super::{Classifier, Worker};
use crate::control::Control;
use crate::cut;
use crate::dexel::Beam;
use crate::error::Error;
use crate::lattice::{Bounds, Cell, CellMoments, Interval, Ray, VolumeMoments};
use alloc::vec::Vec;

/// A question about one PARTIAL cell, with the place for the answer. The place must be empty before the
/// question. It stays empty if the answer is not known.
///
/// The answers are proven as verdicts are, and depend on the cell and the shape alone. Later versions may add
/// questions: a worker answers the questions that it knows and ignores the others. A wrapper forwards the
/// question.
#[non_exhaustive]
pub enum Question<'q> {
    /// Whether the centre of the cell lies in the solid. The cell has the frame's depth. A centre on the
    /// boundary is decided as if all centres were shifted by (ε, ε², ε³), to first order: on a curved surface
    /// too, the first axis that leads across the surface decides.
    Centre(&'q mut Option<bool>),

    /// Slabs that contain the boundary in the cell, by the law that [`Enclosure`] states.
    Enclosure(&'q mut Option<Enclosure>),

    /// Volume and moments of the solid in the cell, if they are known more precisely than by an enclosure.
    Moments(&'q mut Option<CellMoments>),

    /// Bounds of the area of the boundary in the cell, in squares of the cell's half edge, if bounds are
    /// known other than those of an enclosure with a cone.
    Area(&'q mut Option<Interval>),

    /// The first crossing of the boundary by a segment with both ends in the closed cell, by the law that
    /// [`Crossing`] states. Not answered if there is no crossing, or if the solid cannot find it.
    Crossing(&'q Segment, &'q mut Option<Crossing>),

    /// The intervals in which rays through the centres of finest cells lie inside the solid in the cell.
    /// Answered only if they are known for all rays that the beam requests.
    Chords(Chords<'q>),

    /// The surfaces of the classifier's list ([`WholeQuestion::Surfaces`]) that cross the cell, and the
    /// function of their signs that the solid is there, by the law that [`OpenSurfaces`] states. Not answered
    /// if there are too many surfaces, if the solid is not made of surfaces, or if nobody has requested the
    /// list yet.
    Surfaces(&'q mut Option<OpenSurfaces>),

    /// As [`Surfaces`](Self::Surfaces), for the list with layers ([`WholeQuestion::Layers`]): planes with a
    /// width may stand for a surface that is not known exactly.
    Layers(LayersQuestion<'q>),

    /// The crossings of a ray with the boundary of the solid in the cell; for the root cell, in the universe.
    /// Beyond the cell the trace need not be correct. Answered only after [`WholeQuestion::Direct`] has been
    /// asked.
    Ray(RayQuestion<'q>),

    /// The point of the whole boundary that is nearest to a point (model units). Only for the root cell.
    /// Answered only after [`WholeQuestion::Direct`] has been asked.
    Nearest([f64; 3], &'q mut Option<NearestSurface>),

    /// The position of a box in the universe: in the solid, outside, or both. Only for the root cell.
    /// Answered only after [`WholeQuestion::Direct`] has been asked.
    Box(&'q Bounds, &'q mut Option<BoxContent>),
}

/// The greatest thickness of layers, with the places for the answer.
pub struct LayersQuestion<'q> {
    /// Half the greatest distance that a layer's points may have from the surface (model units).
    pub tolerance: f64,
    /// Layers for this cell alone are appended here: a surface with the number [`OpenSurfaces::OWN`] + i is
    /// number i of this list.
    pub own: &'q mut Vec<PlacedHalfSpace>,
    /// The function of surfaces of the list and of own layers.
    pub known: &'q mut Option<OpenSurfaces>,
}

impl LayersQuestion<'_> {
    /// The greatest width of any layer, as a share of the tolerance. Next to a wall of the cell a point in a
    /// layer is up to 1 + √3 widths away from the surface. That distance must be less than twice the
    /// tolerance.
    pub(crate) const SHARE: f64 = 0.7;

    /// Returns whether a layer that alone bounds the solid in a cell is thin enough for a tolerance, in half
    /// edges of the cell. (Storing the layer may make it a little thicker.)
    pub(crate) fn admits(slab: &Slab, tolerance: f64) -> bool {
        let width = (slab.outer - slab.inner) / libm::sqrt(slab.normal.iter().map(|c| c * c).sum::<f64>());
        // (A comparison with NaN is false.)
        width <= Self::SHARE * tolerance || width <= tolerance && cut::stray(slab) <= 1.9 * tolerance
    }
}

/// The place for the intervals of rays.
pub struct Chords<'q> {
    /// The rays. Their intervals in the cell are appended. Each interval holds exactly those centres that
    /// [`Question::Centre`] would find inside.
    pub beam: &'q mut Beam,
    /// Set once the intervals of all rays have been added.
    pub found: &'q mut bool,
    /// The number of intervals that the beam held before the question.
    first: usize,
}

impl<'q> Question<'q> {
    /// Returns the question for the intervals of a beam's rays.
    pub fn chords(beam: &'q mut Beam, found: &'q mut bool) -> Question<'q> {
        let first = beam.len();
        Question::Chords(Chords { beam, found, first })
    }

    /// Turns the answer to a question about a solid into the answer about its complement.
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

    /// The same question again: another borrow of the same places.
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

/// The questions as functions. Every worker has these functions, and no worker can change them: they call
/// [`Worker::answer`].
pub trait Ask: Worker {
    /// Returns whether the centre of a PARTIAL cell of the frame's depth lies in the solid:
    /// [`Question::Centre`].
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
    #[inline(always)]
    fn sample(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<bool>, Error> {
        let mut inside = None;
        self.answer(cell, part, Question::Centre(&mut inside))?;
        Ok(inside)
    }

    /// Returns slabs that contain the boundary in a PARTIAL cell: [`Question::Enclosure`].
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
    #[inline(always)]
    fn enclosure(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<Enclosure>, Error> {
        let mut known = None;
        self.answer(cell, part, Question::Enclosure(&mut known))?;
        Ok(known)
    }

    /// Returns volume and moments of the solid in a PARTIAL cell: [`Question::Moments`].
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
    #[inline(always)]
    fn moments(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<CellMoments>, Error> {
        let mut known = None;
        self.answer(cell, part, Question::Moments(&mut known))?;
        Ok(known)
    }

    /// Returns bounds of the area of the boundary in a PARTIAL cell: [`Question::Area`].
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
    #[inline(always)]
    fn area(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<Interval>, Error> {
        let mut known = None;
        self.answer(cell, part, Question::Area(&mut known))?;
        Ok(known)
    }

    /// Returns the first crossing of a segment in a PARTIAL cell with the boundary: [`Question::Crossing`].
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
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

    /// Appends the intervals of rays in a PARTIAL cell, if they are known: [`Question::Chords`].
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
    #[inline(always)]
    fn chords(&mut self, cell: Cell, part: &Self::Part, beam: &mut Beam) -> Result<bool, Error> {
        let mut found = false;
        self.answer(cell, part, Question::chords(beam, &mut found))?;
        Ok(found)
    }

    /// Returns the surfaces that cross a PARTIAL cell, and the function of them that the solid is there:
    /// [`Question::Surfaces`].
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
    #[inline(always)]
    fn surfaces(&mut self, cell: Cell, part: &Self::Part) -> Result<Option<OpenSurfaces>, Error> {
        let mut known = None;
        self.answer(cell, part, Question::Surfaces(&mut known))?;
        Ok(known)
    }
}

impl<W: Worker + ?Sized> Ask for W {}

/// The question for layers as a function, for wrappers and builders.
pub(crate) trait AskLayers: Worker {
    /// Returns the surfaces and layers that cross a PARTIAL cell, and the function of them that the solid is
    /// there: [`Question::Layers`].
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
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

/// The questions about the universe that are answered without a descent, as functions.
pub(crate) trait AskDirect: Worker {
    /// Finds the crossings of a ray with the boundary of the solid: [`Question::Ray`]. `trace` is
    /// overwritten.
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
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

    /// Returns the point of the boundary that is nearest to a point: [`Question::Nearest`].
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
    #[inline]
    fn nearest(&mut self, root: &Self::Part, point: [f64; 3]) -> Result<Option<NearestSurface>, Error> {
        let mut known = None;
        self.answer(Cell::ROOT, root, Question::Nearest(point, &mut known))?;
        Ok(known)
    }

    /// Returns the content of a box in the universe: [`Question::Box`].
    ///
    /// # Errors
    /// [Those of every question](Worker#errors).
    fn content_of(&mut self, root: &Self::Part, bounds: &Bounds) -> Result<Option<BoxContent>, Error> {
        let mut known = None;
        self.answer(Cell::ROOT, root, Question::Box(bounds, &mut known))?;
        Ok(known)
    }
}

impl<W: Worker + ?Sized> AskDirect for W {}

/// A question about a whole shape on a frame, inside and outside the universe, with the place for the answer.
/// The place must be empty before the question. It stays empty if the answer is not known. The answers are
/// proven as verdicts are.
#[non_exhaustive]
pub enum WholeQuestion<'q> {
    /// The volume and the moments, if they are known without splitting cells.
    Moments(&'q mut Option<VolumeMoments>),

    /// The area of the boundary (square model units), if it is known without splitting cells.
    Area(&'q mut Option<Interval>),

    /// Whether no piece of the boundary lies in a plane of the lattice, so that the whole area of the
    /// boundary lies in open PARTIAL cells. The flag is set if that is known.
    OffLattice(&'q mut bool),

    /// The list of surfaces that cross cells. [`Question::Surfaces`] refers to a surface by its place in this
    /// list. Surfaces may be equal.
    Surfaces(&'q mut Option<Vec<PlacedHalfSpace>>),

    /// The list of [`Question::Layers`]: the surfaces that cross cells, and planes with a width for surfaces
    /// that are not known exactly. For a solid that does not answer, the list is that of
    /// [`Surfaces`](Self::Surfaces).
    Layers(&'q mut Option<Vec<PlacedHalfSpace>>),

    /// Whether questions of this kind about the universe are usually answered without a descent. The data
    /// that this needs is made now, once, and kept for all handles that share the shape. The flag is set if
    /// such data exists.
    Direct(Direct, &'q mut bool),

    /// The triangles that make up the whole boundary, if such triangles are known and the whole boundary lies
    /// in the universe. No triangle lies in the interior of the solid or outside the solid. The answer is the
    /// same for the solid and its complement.
    Facets(&'q mut Option<BoundaryFacets>),

    /// As [`Facets`](Self::Facets), for meshes whose triangles intersect: intersecting triangles are cut into
    /// pieces. Pieces that meet other pieces have sides no longer than the given size (model units).
    Pieces(f64, &'q mut Option<BoundaryPieces>),

    /// The triangles of [`Facets`](Self::Facets), and further triangles beside those of the boundary. All of
    /// them lie in the closed solid; for the complement, all of them lie outside the complement.
    Walls(&'q mut Option<BoundaryFacets>),
}

/// A kind of question about the universe that some solids answer without a descent.
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

/// The questions about whole shapes as functions. Every classifier has these functions, and no classifier can
/// change them: they call [`Classifier::answer_whole`].
pub trait AskWhole: Classifier {
    /// Returns the volume and the moments of the shape: [`WholeQuestion::Moments`].
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], and [`Error::Cancelled`] by `control`.
    fn moments(&self, control: &Control<'_>) -> Result<Option<VolumeMoments>, Error> {
        let mut known = None;
        self.answer_whole(WholeQuestion::Moments(&mut known), control)?;
        Ok(known)
    }

    /// Returns the area of the shape's boundary: [`WholeQuestion::Area`].
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn area(&self, control: &Control<'_>) -> Result<Option<Interval>, Error> {
        let mut known = None;
        self.answer_whole(WholeQuestion::Area(&mut known), control)?;
        Ok(known)
    }

    /// Returns the surfaces that cross cells, if the shape is made of surfaces: [`WholeQuestion::Surfaces`].
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn surfaces(&self, control: &Control<'_>) -> Result<Option<Vec<PlacedHalfSpace>>, Error> {
        let mut known = None;
        self.answer_whole(WholeQuestion::Surfaces(&mut known), control)?;
        Ok(known)
    }

    /// Returns the surfaces and layers that cross cells: [`WholeQuestion::Layers`].
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn layers(&self, control: &Control<'_>) -> Result<Option<Vec<PlacedHalfSpace>>, Error> {
        let mut known = None;
        self.answer_whole(WholeQuestion::Layers(&mut known), control)?;
        Ok(known)
    }

    /// Returns whether questions of a kind are answered without a descent, and prepares the data for them:
    /// [`WholeQuestion::Direct`].
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn is_direct(&self, kind: Direct, control: &Control<'_>) -> Result<bool, Error> {
        let mut is_direct = false;
        self.answer_whole(WholeQuestion::Direct(kind, &mut is_direct), control)?;
        Ok(is_direct)
    }

    /// Returns the triangles that make up the whole boundary: [`WholeQuestion::Facets`].
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn facets(&self, control: &Control<'_>) -> Result<Option<BoundaryFacets>, Error> {
        let mut known = None;
        self.answer_whole(WholeQuestion::Facets(&mut known), control)?;
        Ok(known)
    }

    /// Returns the triangles and pieces of triangles that make up the whole boundary:
    /// [`WholeQuestion::Pieces`].
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn pieces(&self, size: f64, control: &Control<'_>) -> Result<Option<BoundaryPieces>, Error> {
        let mut known = None;
        self.answer_whole(WholeQuestion::Pieces(size, &mut known), control)?;
        Ok(known)
    }

    /// Returns triangles in the closed solid that include its whole boundary: [`WholeQuestion::Walls`].
    ///
    /// # Errors
    /// As [`moments`](Self::moments).
    fn walls(&self, control: &Control<'_>) -> Result<Option<BoundaryFacets>, Error> {
        let mut known = None;
        self.answer_whole(WholeQuestion::Walls(&mut known), control)?;
        Ok(known)
    }

    /// Returns whether it is known that no piece of the boundary lies in a plane of the lattice:
    /// [`WholeQuestion::OffLattice`].
    fn is_off_lattice(&self) -> bool {
        let mut known = false;
        // (On an error the answer is not known.)
        self.answer_whole(WholeQuestion::OffLattice(&mut known), &Control::default()).is_ok() && known
    }
}

impl<C: Classifier> AskWhole for C {}
