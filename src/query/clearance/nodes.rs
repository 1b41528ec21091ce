//! The cells of a solid that a search has met.

use super::piece::{Content, Piece, Place, Ring};
use super::simplex::dot;
use crate::control::{Control, Job};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::sqrt;
use crate::lattice::{Cell, Cube, Frame, MAX_DEPTH, axes};
use crate::memory;
use crate::solid::half_space::Placed;
use crate::solid::half_space::literals::Literals;
use crate::solid::half_space::possible::possible;
use crate::solid::{
    Ask, AskWhole, Classifier, Enclosure, Form, OpenSurfaces, PlacedHalfSpace, Verdict, Worker,
};
use crate::walk::Part;
use crate::walk::Subject;
use alloc::vec::Vec;
use core::ops::Range;

/// The state of a cell.
pub(super) enum Known<P> {
    /// Not split: the solid's verdict.
    Whole(Verdict<P>),
    /// Split: the range of child nodes that are not EMPTY.
    Split(Range<usize>),
}

/// Additional information from a solid about a PARTIAL cell.
#[derive(Default)]
pub(super) struct Lore {
    enclosure: Option<Enclosure>,
    /// Balls and cylinders that hold the solid's part in the cell on one side.
    rings: [Option<Ring>; 2],
    /// The surfaces that cross the cell, if all of them have forms.
    pub(super) open: Option<OpenSurfaces>,
}

/// A cell that is not EMPTY.
pub(super) struct Node<P> {
    cell: Cell,
    known: Known<P>,
    /// The index of the cell's lore, or one of the constants below.
    lore: u32,
}

/// `UNASKED`: the lore of a cell was not queried yet. `NONE`: the cell has no lore.
const UNASKED: u32 = u32::MAX;
const NONE: u32 = u32::MAX - 1;

/// A solid's cells that are not EMPTY, each split once at the most.
pub(super) struct Nodes<'s, C: Classifier> {
    pub(super) subject: Subject<'s, C>,
    nodes: Vec<Node<Part<C>>>,
    lore: Vec<Lore>,
    surfaces: Vec<PlacedHalfSpace>,
    /// The forms of the surfaces, once queried.
    forms: Vec<Option<Option<Form>>>,
    /// The surfaces on the frame, once a cell has several; `None` if exact numbers would become too long.
    placed: Option<Vec<Placed>>,
}

/// A function of fewer surfaces cannot be simplified.
const SEVERAL: usize = 3;

impl<'s, C: Classifier> Nodes<'s, C> {
    /// Builds the node of the universe, unless the universe is EMPTY.
    pub(super) fn new(classifier: &'s C, control: &'s Control<'s>) -> Result<Self, Error> {
        let surfaces = classifier.surfaces(control)?.unwrap_or_default();
        let forms = memory::filled(surfaces.len(), None)?;
        let subject = Subject::new(classifier, control)?;
        let mut nodes = Nodes { subject, nodes: Vec::new(), lore: Vec::new(), surfaces, forms, placed: None };
        let root = nodes.subject.worker.root()?;
        nodes.add(Cell::ROOT, root, NONE)?;
        Ok(nodes)
    }

    /// Adds a cell unless it is EMPTY. `of_full` is the index of the cell's lore if the cell is FULL.
    fn add(&mut self, cell: Cell, verdict: Verdict<Part<C>>, of_full: u32) -> Result<(), Error> {
        let lore = match verdict {
            Verdict::Empty => return Ok(()),
            Verdict::Partial(_) => UNASKED,
            Verdict::Full => of_full,
            Verdict::Undecided => NONE,
        };
        memory::push(&mut self.nodes, Node { cell, known: Known::Whole(verdict), lore })
    }

    pub(super) fn is_full(&self, node: usize) -> bool {
        matches!(self.nodes[node].known, Known::Whole(Verdict::Full))
    }

    fn is_finest(&self, node: usize) -> bool {
        self.nodes[node].cell.level == self.subject.classifier.frame().depth()
    }

    /// True if the cell has finer cells.
    pub(super) fn can_be_split(&self, node: usize) -> bool {
        match self.nodes[node].known {
            Known::Whole(Verdict::Partial(_)) => !self.is_finest(node),
            Known::Whole(_) => false,
            Known::Split(_) => true,
        }
    }

    /// True if the cell has finer cells that were not computed yet.
    fn is_whole(&self, node: usize) -> bool {
        matches!(self.nodes[node].known, Known::Whole(_)) && self.can_be_split(node)
    }

    /// Returns the children of a node that can be split; an empty range for any other node.
    pub(super) fn children(&mut self, node: usize) -> Result<Range<usize>, Error> {
        if let Node { cell, known: Known::Whole(Verdict::Partial(part)), .. } = &self.nodes[node]
            && !self.is_finest(node)
        {
            let cell = *cell;
            let children = self.subject.split(cell, part)?;
            // A FULL child lies on the same side of balls and cylinders as the solid's whole part in the
            // cell.
            let rings = self.lore(node).map_or([None; 2], |lore| lore.rings);
            let mut inherited = NONE;
            let has_full = children.iter().any(|child| matches!(child, Verdict::Full));
            if has_full && rings.iter().any(Option::is_some) && self.lore.len() < NONE as usize {
                inherited = self.lore.len() as u32;
                memory::push(&mut self.lore, Lore { rings, ..Lore::default() })?;
            }
            let first = self.nodes.len();
            for (octant, child) in (0..8).zip(children) {
                self.add(cell.child(octant), child, inherited)?;
            }
            self.nodes[node].known = Known::Split(first..self.nodes.len());
        }
        Ok(match &self.nodes[node].known {
            Known::Split(children) => children.clone(),
            Known::Whole(_) => 0..0,
        })
    }

    pub(super) fn cell(&self, node: usize) -> Cell {
        self.nodes[node].cell
    }

    /// Returns the children of a node that can be split, by octants; `None` for an EMPTY octant.
    pub(super) fn octants(&mut self, node: usize) -> Result<[Option<usize>; 8], Error> {
        let mut octants = [None; 8];
        for child in self.children(node)? {
            octants[usize::from(self.cell(child).octant())] = Some(child);
        }
        Ok(octants)
    }

    /// Returns the node of a cell that holds a point. The cell is as fine as the cell of `near`. Among
    /// several such cells, the result is the one next to the middle of `near`. Missing cells on the way are
    /// split as long as there are splits `left`. `None` if the cell is EMPTY.
    pub(super) fn at(
        &mut self,
        point: [f64; 3],
        near: usize,
        left: &mut u64,
    ) -> Result<Option<usize>, Error> {
        let Piece { centre: middle, .. } = self.piece(near);
        let level = self.cell(near).level;
        let cells = f64::from(self.subject.classifier.frame().cells());
        if self.is_empty() || !point.iter().all(|c| (0.0..=cells).contains(c)) {
            return Ok(None);
        }
        let point = axes(|axis| point[axis] + 1e-9 * (middle[axis] - point[axis]));
        let mut node = 0;
        while self.cell(node).level < level && self.can_be_split(node) {
            if self.is_whole(node) {
                let Some(rest) = left.checked_sub(1) else { return Ok(None) };
                *left = rest;
            }
            let Piece { centre, .. } = self.piece(node);
            let octant =
                (0..3).fold(0, |octant, axis| octant | usize::from(point[axis] >= centre[axis]) << axis);
            let Some(child) = self.octants(node)?[octant] else { return Ok(None) };
            node = child;
        }
        self.learn(node)?;
        Ok(Some(node))
    }

    /// The complement of the solid's part in a cell, as far as it was learnt.
    pub(super) fn hollow(&self, node: usize) -> Option<Enclosure> {
        Some(self.lore(node)?.enclosure.as_ref()?.complement())
    }

    /// Queries a cell's lore, once.
    pub(super) fn learn(&mut self, node: usize) -> Result<(), Error> {
        let Node { cell, known: Known::Whole(Verdict::Partial(part)), lore: UNASKED } = &self.nodes[node]
        else {
            return Ok(());
        };
        let enclosure = self.subject.worker.enclosure(*cell, part)?.filter(is_sound);
        let open = match self.surfaces.is_empty() {
            true => None,
            false => self.subject.worker.surfaces(*cell, part)?,
        };
        let (enclosure, open) = match open {
            Some(open) if open.indices().len() >= SEVERAL => {
                let (simple, slabs) = simplified(
                    &mut self.placed,
                    &self.surfaces,
                    self.subject.classifier.frame(),
                    *cell,
                    &open,
                )?;
                (slabs.filter(is_sound).or(enclosure), Some(simple))
            }
            open => (enclosure, open),
        };
        let mut lore = Lore { enclosure, rings: [None; 2], open };
        let mut count = 0;
        for (place, &index) in open.iter().flat_map(|open| open.indices()).enumerate() {
            let frame = self.subject.classifier.frame();
            match form(&mut self.forms, &self.surfaces, index, frame)? {
                None => lore.open = None,
                Some(form) => {
                    if let (Some(round), Some(sign)) =
                        (form.round, open.and_then(|open| needed(&open, place)))
                        && count < lore.rings.len()
                    {
                        lore.rings[count] = Some(Ring { round, is_near: round.is_near_positive == sign });
                        count += 1;
                    }
                }
            }
        }
        let says = lore.enclosure.is_some() || lore.open.is_some() || count > 0;
        let number = if says && self.lore.len() < NONE as usize { self.lore.len() as u32 } else { NONE };
        if number != NONE {
            memory::push(&mut self.lore, lore)?;
        }
        self.nodes[node].lore = number;
        Ok(())
    }

    /// True if the solid has provided more than its verdict for some cell.
    pub(super) fn has_lore(&self) -> bool {
        !self.lore.is_empty()
    }

    pub(super) fn lore(&self, node: usize) -> Option<&Lore> {
        self.lore.get(self.nodes[node].lore as usize)
    }

    /// True if the solid lies within a ball or a cylinder in a cell.
    pub(super) fn is_round(&self, node: usize) -> bool {
        self.lore(node).is_some_and(|lore| lore.rings.iter().flatten().any(|ring| ring.is_near))
    }

    /// An estimate, up to rounding, of the distance between the solid and its known bounds in a cell, in
    /// finest cells: the possible gain from splitting the cell.
    pub(super) fn doubt(&self, node: usize) -> f64 {
        let Piece { half, content, rings, .. } = self.piece(node);
        let open = self.lore(node).and_then(|lore| lore.open);
        // (Where a plane cuts a ball, neither alone determines the nearest point. A cylinder is finite.)
        let is_ball = open.is_some_and(|open| open.indices().len() == 1)
            && rings.iter().flatten().any(|ring| ring.is_near && ring.round.axis.is_none());
        match content {
            _ if is_ball => 0.0,
            Content::Full => 0.0,
            Content::Unknown => 2.0 * half,
            Content::Slabs(known) => {
                let widths = known.slabs.iter().filter(|slab| slab.normal != [0.0; 3]);
                let widths =
                    widths.map(|slab| (slab.outer - slab.inner) / sqrt(dot(slab.normal, slab.normal)));
                // A one-sided slab has an infinite width.
                half * widths.fold(0.0, f64::max).min(2.0)
            }
        }
    }

    /// Returns a unit vector that leads out of the solid next to a point of a cell, if slabs determine it.
    pub(super) fn normal(&self, node: usize, place: &Place) -> Option<[f64; 3]> {
        let known = self.lore(node)?.enclosure.as_ref()?;
        let Piece { centre, half, .. } = self.piece(node);
        let own: [f64; 3] =
            axes(|axis| (0.5 * (place[axis].lower + place[axis].upper) - centre[axis]) / half);
        let seen =
            known.slabs.iter().filter(|slab| slab.inner.is_finite() && slab.normal != [0.0; 3]).map(|slab| {
                let size = sqrt(dot(slab.normal, slab.normal));
                ((dot(slab.normal, own) - slab.inner) / size, slab.normal.each(|c| c / size))
            });
        // In a union, the point lies behind the slabs that hold it: the nearest slab counts in either case.
        let nearest = seen.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        nearest.map(|(_, normal)| normal)
    }

    /// Returns the form of a surface, if it was queried and exists.
    pub(super) fn form(&self, index: u32) -> Option<&Form> {
        self.forms.get(index as usize)?.as_ref()?.as_ref()
    }

    /// Returns the solid's part in a cell, as far as it was learnt.
    pub(super) fn piece(&self, node: usize) -> Piece<'_> {
        let (low, high) = self.extent(node);
        let lore = self.lore(node);
        let content = match lore.and_then(|lore| lore.enclosure.as_ref()) {
            Some(known) => Content::Slabs(known),
            None if self.is_full(node) => Content::Full,
            None => Content::Unknown,
        };
        Piece {
            centre: axes(|axis| 0.5 * (f64::from(low[axis]) + f64::from(high[axis]))),
            half: 0.5 * f64::from(high[0] - low[0]),
            content,
            rings: lore.map_or([None; 2], |lore| lore.rings.each_ref().each(Option::as_ref)),
        }
    }

    /// True if no cell of the solid is left. The solid is proven to be empty if all cells were visited.
    pub(super) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Finds the first FULL cell, with at most `budget` splits; earlier splits cost nothing.
    ///
    /// The search splits the largest open cell and one of the smallest by turns. Large FULL cells are found
    /// by going through the coarse levels, where a thin wall has none. Thin walls are found by going down,
    /// where a solid's sharp edge would delay the search.
    pub(super) fn find_full(&mut self, budget: &mut u64, job: &Job<'_>) -> Result<Option<usize>, Error> {
        let mut open: Vec<Vec<usize>> = memory::filled(MAX_DEPTH as usize + 1, Vec::new())?;
        if !self.is_empty() {
            memory::push(&mut open[0], 0)?;
        }
        for turn in 0u64.. {
            job.check()?;
            let mut levels = open.iter_mut().filter(|level| !level.is_empty());
            let level = if turn % 2 == 0 { levels.next() } else { levels.next_back() };
            let Some(node) = level.and_then(Vec::pop) else { break };
            if self.is_full(node) {
                return Ok(Some(node));
            }
            if self.is_whole(node) {
                let Some(left) = budget.checked_sub(1).filter(|_| !self.subject.takes(4)) else { break };
                *budget = left;
            }
            for child in self.children(node)? {
                if self.is_full(child) {
                    return Ok(Some(child));
                }
                if self.can_be_split(child) {
                    memory::push(&mut open[self.cell(child).level as usize], child)?;
                }
            }
        }
        Ok(None)
    }

    /// Returns the least and the greatest coordinates, in finest cells.
    pub(super) fn extent(&self, node: usize) -> ([u32; 3], [u32; 3]) {
        Cube { frame: self.subject.classifier.frame(), cell: self.cell(node) }.planes()
    }
}

/// Returns the form of a surface; `None` for a surface that is neither a plane nor a quadric.
fn form<'f>(
    forms: &'f mut [Option<Option<Form>>],
    surfaces: &[PlacedHalfSpace],
    index: u32,
    frame: &Frame,
) -> Result<Option<&'f Form>, Error> {
    let (Some(place), Some(surface)) = (forms.get_mut(index as usize), surfaces.get(index as usize)) else {
        return Ok(None);
    };
    if place.is_none() {
        *place = Some(match surface.form(frame) {
            Err(Error::Limit { .. }) => None,
            known => known?,
        });
    }
    Ok(place.as_ref().and_then(Option::as_ref))
}

/// Restricts the function of a cell to the sign combinations that its surfaces can have in the cell, and
/// returns also the slabs of that function if it has fewer surfaces. (If a bore extends beyond a block, the
/// end of the bore and the end of the block lie in the same cell, and the solid has no points there.)
fn simplified(
    placed: &mut Option<Vec<Placed>>,
    surfaces: &[PlacedHalfSpace],
    frame: &Frame,
    cell: Cell,
    open: &OpenSurfaces,
) -> Result<(OpenSurfaces, Option<Enclosure>), Error> {
    let all = match placed {
        Some(all) => all,
        None => {
            let mut all = memory::with_capacity(surfaces.len())?;
            for surface in surfaces {
                match surface.on(frame) {
                    Err(Error::Limit { .. }) => break,
                    surface => all.push(surface?),
                }
            }
            placed.insert(if all.len() == surfaces.len() { all } else { Vec::new() })
        }
    };
    let mut own = memory::with_capacity(OpenSurfaces::MOST)?;
    own.extend(open.indices().iter().filter_map(|&index| all.get(index as usize)));
    if own.len() < open.indices().len() {
        return Ok((*open, None));
    }
    let simple = open.with_table(open.table().simplified(possible(own.into_iter(), cell))).shortened();
    let is_simpler = simple.settled().is_none() && simple.indices().len() < open.indices().len();
    if !is_simpler {
        return Ok((*open, None));
    }
    let literals = Literals::of_table(simple.variables(), simple.table());
    Ok((simple, literals.and_then(|literals| literals.enclosure(all, cell))))
}

/// Returns the sign of a surface's function wherever the solid is; `None` if the solid has points on both
/// sides.
fn needed(open: &OpenSurfaces, place: usize) -> Option<bool> {
    let lies_where = |sign: bool| {
        (0..1u8 << open.indices().len()).any(|signs| (signs >> place & 1 != 0) == sign && open.inside(signs))
    };
    match [false, true].each(lies_where) {
        [false, true] => Some(true),
        [true, false] => Some(false),
        _ => None,
    }
}

/// True if the slabs of a host are not contradictory.
fn is_sound(known: &Enclosure) -> bool {
    let slabs = known.slabs.iter().filter(|slab| slab.normal != [0.0; 3]);
    slabs.clone().all(|slab| {
        let range = slab.normal.iter().map(|c| c.abs()).sum::<f64>();
        // (A comparison with NaN is false.)
        range > 1e-200 && range < 1e200 && slab.inner <= slab.outer
    })
}
