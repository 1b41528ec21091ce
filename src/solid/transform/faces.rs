//! Finds lattice planes that contain pieces of a solid's boundary that belong to no known surface.
//!
//! A surface in a plane of the solid's own lattice crosses no cell, so that no cell stores it: the cells on
//! its two sides just have different verdicts. Once the solid is moved, the surface crosses cells as any
//! other does.
//!
//! Where facets meet in such a plane, each of the two cells beside it may know only one of the facets. That
//! plane is a *seam*. A seam is no part of the boundary, but the side of the seam tells which facet counts.

use crate::control::Control;
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::octree::Tag;
use crate::solid::half_space::Placed;
use crate::solid::half_space::bounds::{Octants, Sides, half_edge};
use crate::solid::half_space::joined::Joined;
use crate::solid::half_space::table::Table;
use crate::solid::{OCTANTS, OpenSurfaces, Question, Verdict, Worker};
use alloc::vec::Vec;

/// A plane of a lattice: its axis, and its position in finest cells.
pub(super) type LatticePlane = (usize, u32);

/// The greatest number of planes that are kept, and of cells that are split to find them. A solid beyond
/// these limits is moved cell by cell.
const MOST_PLANES: usize = 32;
const MOST_SPLITS: usize = 1 << 20;

/// The greatest number of seams that are kept: those of the largest cells.
const MOST_SEAMS: usize = 1 << 13;

/// How often a face is divided to find out whether the cells on both sides are decided, and the greatest
/// number of cells that are split for all faces.
const MOST_DIVISIONS: u8 = 4;
const MOST_DIVIDED: usize = 1 << 14;

/// A cell, or everything beyond the universe, with its verdict and its function, if these are known.
struct Node<P> {
    cell: Option<Cell>,
    verdict: Verdict<P>,
    known: Option<OpenSurfaces>,
}

struct Walk<'w, 'c, W> {
    inner: &'w mut W,
    own: &'w Frame,
    placed: &'w [Placed],
    control: &'w Control<'c>,
    left: usize,
    left_of_faces: usize,
    faces: Vec<LatticePlane>,
    seams: Vec<LatticePlane>,
}

/// Planes of a solid's own lattice; each list is sorted.
#[derive(Debug, Default)]
pub(super) struct LatticePlanes {
    /// The planes that contain faces.
    pub(super) faces: Vec<LatticePlane>,
    /// The planes between cells that are not certainly one function of surfaces.
    pub(super) seams: Vec<LatticePlane>,
}

/// Returns the planes; none if the faces lie in too many planes, or if there are too many cells. `placed`
/// holds the surfaces on the universe of the solid's own frame.
pub(super) fn lattice_planes<W: Worker>(
    inner: &mut W,
    exterior: Tag,
    placed: &[Placed],
    control: &Control<'_>,
) -> Result<LatticePlanes, Error> {
    let (own, mark) = (*inner.frame(), inner.mark());
    let root = inner.root()?;
    let mut walk = Walk {
        inner,
        own: &own,
        placed,
        control,
        left: MOST_SPLITS,
        left_of_faces: MOST_DIVIDED,
        faces: Vec::new(),
        seams: Vec::new(),
    };
    let root = walk.node(Cell::ROOT, root)?;
    walk.within(&root)?;
    if exterior != Tag::Partial {
        let inside = exterior == Tag::Full;
        let verdict = if inside { Verdict::Full } else { Verdict::Empty };
        let beyond = Node { cell: None, verdict, known: Some(OpenSurfaces::constant(inside)) };
        for axis in 0..3 {
            walk.between(&beyond, &root, axis)?;
            walk.between(&root, &beyond, axis)?;
        }
    }
    let Walk { mut faces, mut seams, left, .. } = walk;
    inner.release(mark);
    if left == 0 || faces.len() > MOST_PLANES {
        return Ok(LatticePlanes::default());
    }
    faces.sort_unstable();
    seams.sort_unstable();
    seams.dedup();
    seams.retain(|plane| faces.binary_search(plane).is_err());
    if seams.len() > MOST_SEAMS {
        seams.sort_by_key(|&(_, at)| core::cmp::Reverse(at.trailing_zeros()));
        seams.truncate(MOST_SEAMS);
        seams.sort_unstable();
    }
    Ok(LatticePlanes { faces, seams })
}

impl<W: Worker> Walk<'_, '_, W> {
    fn node(&mut self, cell: Cell, verdict: Verdict<W::Part>) -> Result<Node<W::Part>, Error> {
        let known = known(self.inner, cell, &verdict)?;
        Ok(Node { cell: Some(cell), verdict, known })
    }

    /// The children of a PARTIAL cell; `None` for other cells, and for cells of the frame's depth.
    fn divided(&mut self, node: &Node<W::Part>) -> Result<Option<Vec<Node<W::Part>>>, Error> {
        let (Some(cell), Verdict::Partial(part)) = (node.cell, &node.verdict) else { return Ok(None) };
        if cell.level == self.own.depth() {
            return Ok(None);
        }
        let mut children = memory::with_capacity(8)?;
        for (k, verdict) in OCTANTS.into_iter().zip(self.inner.split(cell, part)?) {
            children.push(self.node(cell.child(k), verdict)?);
        }
        Ok(Some(children))
    }

    /// As `divided`, but `None` for a cell that is a function of surfaces, and once a limit is reached.
    fn children(&mut self, node: &Node<W::Part>) -> Result<Option<Vec<Node<W::Part>>>, Error> {
        if node.known.is_some() || self.left == 0 || self.faces.len() > MOST_PLANES {
            return Ok(None);
        }
        self.left -= 1;
        self.control.check()?;
        self.divided(node)
    }

    /// As `divided`, for a cell beside a face.
    fn divided_at_face(&mut self, node: &Node<W::Part>) -> Result<Option<Vec<Node<W::Part>>>, Error> {
        let Some(left) = self.left_of_faces.checked_sub(1) else { return Ok(None) };
        self.left_of_faces = left;
        self.divided(node)
    }

    fn within(&mut self, node: &Node<W::Part>) -> Result<(), Error> {
        let Some(children) = self.children(node)? else { return Ok(()) };
        for child in &children {
            self.within(child)?;
        }
        for axis in 0..3 {
            for (lower, upper) in pairs(axis) {
                self.between(&children[lower], &children[upper], axis)?;
            }
        }
        Ok(())
    }

    /// Collects the planes between two cells beside each other.
    fn between(&mut self, a: &Node<W::Part>, b: &Node<W::Part>, axis: usize) -> Result<(), Error> {
        let (lower, upper) = (self.children(a)?, self.children(b)?);
        if lower.is_none() && upper.is_none() {
            let shift = |cell: Cell| cell.at[axis] << (self.own.depth() - cell.level);
            let plane = (axis, b.cell.map_or(self.own.cells(), shift));
            if self.faces.contains(&plane) || self.agree(a, b)? {
                return Ok(());
            }
            let is_face = self.is_boundary(a, b, axis, MOST_DIVISIONS)?;
            let planes = if is_face { &mut self.faces } else { &mut self.seams };
            memory::push(planes, plane)?;
            return Ok(());
        }
        for (k, l) in pairs(axis) {
            let low = lower.as_ref().map_or(a, |children| &children[l]);
            let high = upper.as_ref().map_or(b, |children| &children[k]);
            self.between(low, high, axis)?;
        }
        Ok(())
    }

    /// Returns whether the face between two cells, or a part of it, certainly belongs to the boundary.
    fn is_boundary(
        &mut self,
        a: &Node<W::Part>,
        b: &Node<W::Part>,
        axis: usize,
        divisions: u8,
    ) -> Result<bool, Error> {
        let is_open = |node: &Node<W::Part>| matches!(node.verdict, Verdict::Partial(_));
        if self.agree(a, b)? {
            return Ok(false);
        }
        if !is_open(a) && !is_open(b) {
            return Ok(true);
        }
        if let Some((is_lower, octant)) = beside(a, b, axis) {
            // In the larger cell only the child beside the other cell counts.
            let Some(children) = self.divided_at_face(if is_lower { a } else { b })? else {
                return Ok(false);
            };
            let child = &children[usize::from(octant)];
            let (a, b) = if is_lower { (child, b) } else { (a, child) };
            return self.is_boundary(a, b, axis, divisions);
        }
        let (lower, upper) = (self.divided_at_face(a)?, self.divided_at_face(b)?);
        if divisions == 0 || lower.is_none() && upper.is_none() {
            return Ok(false);
        }
        for (k, l) in pairs(axis) {
            let low = lower.as_ref().map_or(a, |children| &children[l]);
            let high = upper.as_ref().map_or(b, |children| &children[k]);
            if self.is_boundary(low, high, axis, divisions - 1)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Returns whether one function of the surfaces fits both cells. Also true if one function is unknown.
    fn agree(&mut self, a: &Node<W::Part>, b: &Node<W::Part>) -> Result<bool, Error> {
        let (Some(of_a), Some(of_b)) = (a.known, b.known) else { return Ok(true) };
        let (mut all, mut joined, mut agree) = (of_a, Joined::default(), true);
        let mut places = [0; OpenSurfaces::MOST];
        for (place, &index) in places.iter_mut().zip(of_b.indices()) {
            let Some(number) = all.number(index) else { return Ok(true) };
            *place = number;
        }
        let values = [of_a.table(), of_b.table().spread(&places[..of_b.indices().len()])];
        // (Beyond the universe the same signs are possible as in the cell inside.)
        for (value, cell) in values.into_iter().zip([a.cell.or(b.cell), b.cell.or(a.cell)]) {
            let possible = cell.map_or(Ok(Table::FULL), |cell| self.possible(&all, cell))?;
            agree &= joined.take(value, possible);
        }
        Ok(agree)
    }

    /// The combinations of signs that the sides of the surfaces leave possible in a cell.
    fn possible(&self, all: &OpenSurfaces, cell: Cell) -> Result<Table, Error> {
        let mut possible = Table::FULL;
        for (i, &index) in all.indices().iter().enumerate() {
            possible = possible.on_side(i, lone(&self.placed[index as usize], cell)?.side(0));
        }
        Ok(possible)
    }
}

/// For the larger of two cells, if it is PARTIAL: whether it is the lower one, and its octant beside the
/// other cell.
fn beside<P>(a: &Node<P>, b: &Node<P>, axis: usize) -> Option<(bool, u8)> {
    let (lower, upper) = (a.cell?, b.cell?);
    let is_open = |node: &Node<P>| matches!(node.verdict, Verdict::Partial(_));
    if lower.level < upper.level && is_open(a) {
        return Some((true, upper.ancestor(lower.level + 1).octant() | 1 << axis));
    }
    let is_larger = upper.level < lower.level && is_open(b);
    is_larger.then(|| (false, lower.ancestor(upper.level + 1).octant() & !(1 << axis)))
}

/// The pairs of children on both sides of the middle of an axis.
fn pairs(axis: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..8usize).filter(move |k| k >> axis & 1 == 0).map(move |k| (k, k | 1 << axis))
}

/// The function that the solid is in a cell of its own frame; `None` if it is no function of surfaces there.
pub(super) fn known<W: Worker>(
    inner: &mut W,
    cell: Cell,
    verdict: &Verdict<W::Part>,
) -> Result<Option<OpenSurfaces>, Error> {
    let mut open = None;
    match verdict {
        Verdict::Partial(part) => inner.answer(cell, part, Question::Surfaces(&mut open))?,
        Verdict::Undecided => {}
        decided => open = Some(OpenSurfaces::constant(decided.tag() == Tag::Full)),
    }
    Ok(open)
}

/// The sides of a single cell, as those of its first octant.
pub(super) fn lone(placed: &Placed, cell: Cell) -> Result<Sides, Error> {
    let half = 2.0 * half_edge(cell);
    let low = cell.at.each(|at| f64::from(at) * half);
    placed.sides(&Octants { low, half }, 1, &mut 0)
}
