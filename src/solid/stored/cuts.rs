//! Answers from the cuts of a stored octree: cells below its own cells, and points.

use super::StoredPart;
use crate::error::{Damage, Error};
use crate::lattice::Each;
use crate::lattice::{Cell, Frame};
use crate::memory;
use crate::octree::cuts::{CellCut, CellIds, CutsRef};
use crate::octree::{OctreeRef, Planes, Tag};
use crate::solid::half_space::Placed;
use crate::solid::half_space::bounds::{Octants, centre};
use crate::solid::half_space::function;
use crate::solid::half_space::literals::Literals;
use crate::solid::half_space::table::Table;
use crate::solid::{LayersQuestion, OCTANTS, OpenSurfaces, PlacedHalfSpace, Question, Verdict};
use alloc::boxed::Box;
use alloc::vec::Vec;
use once_cell::race::OnceBox;

/// The surfaces of a tree on its universe.
pub(super) struct PlacedCuts {
    surfaces: Vec<PlacedHalfSpace>,
    /// The surfaces in unit coordinates of the universe, for cells.
    cells: Vec<Placed>,
    /// A frame at the origin whose edge is the least power of two not below the magnitude of any coordinate
    /// of the universe: points of the model stay exact in its unit coordinates.
    around: Frame,
    /// The surfaces in unit coordinates of `around`; made for the first point.
    points: OnceBox<Vec<Placed>>,
}

impl core::fmt::Debug for PlacedCuts {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("PlacedCuts").field("surfaces", &self.surfaces.len()).finish_non_exhaustive()
    }
}

impl PlacedCuts {
    /// The approximate number of bytes of the surfaces.
    pub(super) fn bytes(&self) -> usize {
        let placed =
            |list: &Vec<Placed>| memory::bytes_of(list) + list.iter().map(Placed::heap_bytes).sum::<usize>();
        let surface =
            |surface: &PlacedHalfSpace| surface.half_space.bytes() + size_of_val(&*surface.placements);
        size_of::<PlacedCuts>()
            + memory::bytes_of(&self.surfaces)
            + self.surfaces.iter().map(surface).sum::<usize>()
            + placed(&self.cells)
            + self.points.get().map_or(0, placed)
    }

    /// Places the surfaces of a tree with cuts on a frame of its universe. O(surfaces).
    ///
    /// # Errors
    /// [`Damage::Surface`] if one of the surfaces is invalid; [`Error::Limit`] if the exact map of its
    /// placements is too long.
    pub(super) fn new(cuts: &CutsRef<'_>, frame: &Frame) -> Result<PlacedCuts, Error> {
        let mut surfaces = memory::with_capacity(cuts.surfaces.len())?;
        let mut cells = memory::with_capacity(cuts.surfaces.len())?;
        for id in 0..cuts.surfaces.len() {
            let wrong = Damage::Surface { surface: id as u64 };
            let surface = PlacedHalfSpace::read(&cuts.surfaces, id).ok_or(wrong)?;
            cells.push(surface.on(frame)?);
            surfaces.push(surface);
        }
        let far =
            frame.origin().into_iter().flat_map(|c| [c.abs(), (c + frame.edge()).abs()]).fold(0.0, f64::max);
        let (mut edge, half) = (1.0, 0.5);
        while edge < far {
            edge *= 2.0;
        }
        while edge * half >= far {
            edge *= half;
        }
        let around = Frame::new([0.0; 3], edge, 1)?;
        Ok(PlacedCuts { surfaces, cells, around, points: OnceBox::new() })
    }

    pub(super) fn surfaces(&self) -> &[PlacedHalfSpace] {
        &self.surfaces
    }

    /// The surfaces on which a table depends, with their numbers in it; `None` if a surface is missing.
    fn variables(&self, cuts: &CutsRef<'_>, record: u32, table: Table) -> Option<Variables> {
        let CellCut::Table { ids, .. } = cuts.at(record as usize) else { return None };
        ids.iter().all(|&id| (id as usize) < self.cells.len()).then_some(Variables { ids, table })
    }

    /// The verdicts on the children of a cell whose table is known.
    pub(super) fn split(
        &self,
        cuts: &CutsRef<'_>,
        cell: Cell,
        record: u32,
        table: u8,
    ) -> Result<[Verdict<StoredPart>; 8], Error> {
        let table = Table::widened(table);
        let Some(variables) = self.variables(cuts, record, table) else { return Ok([Verdict::Undecided; 8]) };
        let at = Octants::of(cell);
        let mut tables = [table; 8];
        for (i, id) in variables.each() {
            let sides = self.cells[id as usize].sides(&at, 0xFF, &mut 0)?;
            for (k, table) in (0..).zip(&mut tables) {
                *table = table.known(i, sides, k);
            }
        }
        Ok(tables.each(|table| match table {
            Table::EMPTY => Verdict::Empty,
            Table::FULL => Verdict::Full,
            table => Verdict::Partial(StoredPart::Cut { record, table: table.0 as u8 }),
        }))
    }

    /// Answers a question about a cell whose table is known.
    pub(super) fn answer(
        &self,
        cuts: &CutsRef<'_>,
        cell: Cell,
        (record, table): (u32, u8),
        question: Question<'_>,
    ) -> Result<(), Error> {
        let table = Table::widened(table);
        let Some(variables) = self.variables(cuts, record, table) else { return Ok(()) };
        match question {
            Question::Centre(inside) => {
                let side = |id| self.cells[id as usize].contains(centre(cell));
                *inside = function::inside(variables.each(), table, side)?
            }
            Question::Enclosure(known) => {
                let literals = Literals::of_table(variables.each(), table);
                *known = literals.and_then(|own| own.enclosure(&self.cells, cell))
            }
            Question::Moments(known) => {
                *known = function::moments(variables.each(), table, &self.cells, cell)
            }
            Question::Area(known) => *known = function::area(variables.each(), table, &self.cells, cell),
            Question::Chords(chords) => {
                *chords.found = function::chords(variables.each(), table, &self.cells, chords.beam)?
            }
            Question::Surfaces(known) | Question::Layers(LayersQuestion { known, .. }) => {
                let (mut open, mut dense) = (OpenSurfaces::constant(false), table);
                for (i, id) in variables.each() {
                    let Some(to) = open.number(id) else { return Ok(()) };
                    dense = dense.renamed(i, to, false);
                }
                *known = Some(open.with_table(dense));
            }
            Question::Crossing(..) | Question::Ray(_) | Question::Nearest(..) | Question::Box(..) => {}
        }
        Ok(())
    }

    /// Returns whether a point of the universe (model units) is inside, by exact signs; `None` if it is not
    /// known.
    pub(super) fn inside(
        &self,
        tree: &OctreeRef<'_>,
        cuts: &CutsRef<'_>,
        point: [f64; 3],
    ) -> Result<Option<bool>, Error> {
        let Some(at) = tree.frame().cell_of(point) else { return Ok(None) };
        let mut record = match tree.record_at(cuts, at) {
            Place::Settled(tag) => {
                return Ok(match tag {
                    Tag::Empty => Some(false),
                    Tag::Full => Some(true),
                    _ => None,
                });
            }
            Place::Record { record, level } => (record, level),
        };
        let finest = Cell { level: tree.frame().depth(), at };
        while let CellCut::Split(first) = cuts.at(record.0) {
            if record.1 == finest.level {
                return Ok(None);
            }
            let child = finest.ancestor(record.1 + 1);
            record = (first + usize::from(child.octant()), record.1 + 1);
        }
        let CellCut::Table { table, .. } = cuts.at(record.0) else { return Ok(None) };
        let Some(variables) = self.variables(cuts, record.0 as u32, Table::widened(table)) else {
            return Ok(None);
        };
        let exact = match self.points.get() {
            Some(exact) => exact,
            None => {
                let mut exact = memory::with_capacity(self.surfaces.len())?;
                for surface in &self.surfaces {
                    exact.push(surface.on(&self.around)?);
                }
                self.points.get_or_init(|| Box::new(exact))
            }
        };
        let t = point.each(|c| c / self.around.edge());
        function::inside(variables.each(), variables.table, |id| exact[id as usize].contains_off_lattice(t))
    }
}

/// The surfaces of a record, and a remaining function of them.
struct Variables {
    ids: CellIds,
    table: Table,
}

impl Variables {
    fn each(&self) -> impl Iterator<Item = (usize, u32)> + Clone {
        self.ids.iter().copied().enumerate().filter(|&(i, _)| self.table.depends_on(i))
    }
}

/// The cell that contains a finest cell.
enum Place {
    /// A cell that is decided, or of which nothing is known.
    Settled(Tag),
    /// A PARTIAL cell of a level, with its record.
    Record { record: usize, level: u8 },
}

impl OctreeRef<'_> {
    fn record_at(&self, cuts: &CutsRef<'_>, at: [u32; 3]) -> Place {
        let finest = Cell { level: self.frame().depth(), at };
        let (mut part, mut level) = (self.root_with(Some(cuts)), 0);
        loop {
            match part {
                Verdict::Empty => return Place::Settled(Tag::Empty),
                Verdict::Full => return Place::Settled(Tag::Full),
                Verdict::Undecided => return Place::Settled(Tag::Partial),
                Verdict::Partial(StoredPart::Record(record)) => {
                    return Place::Record { record: record as usize, level };
                }
                Verdict::Partial(own) => {
                    level += 1;
                    let octant = finest.ancestor(level).octant();
                    part = self.verdicts_with(Some(cuts), &own)[usize::from(octant)];
                }
            }
        }
    }

    /// The verdict on the universe, with its cut if it is one PARTIAL cell.
    pub(super) fn root_with(&self, cuts: Option<&CutsRef<'_>>) -> Verdict<StoredPart> {
        match (self.root_tag(), cuts) {
            (Tag::Partial, Some(_)) => Verdict::Partial(StoredPart::Record(CutsRef::ROOT as u32)),
            _ => self.root_verdict(),
        }
    }

    /// The verdicts on the children of a cell that the planes describe, with records of the PARTIAL ones.
    pub(super) fn verdicts_with(
        &self,
        cuts: Option<&CutsRef<'_>>,
        part: &StoredPart,
    ) -> [Verdict<StoredPart>; 8] {
        let Some(cuts) = cuts else { return self.child_verdicts(part) };
        let known = |index: usize, planes: Planes, c: u32| {
            u32::try_from(cuts.record(index, planes, c))
                .map_or(Verdict::Undecided, |record| Verdict::Partial(StoredPart::Record(record)))
        };
        let mut verdicts = self.child_verdicts(part);
        match *part {
            StoredPart::Element { level, index } => {
                let planes = self.described(level, index);
                for k in OCTANTS {
                    if planes.octant(k.into()) == Tag::Partial {
                        verdicts[usize::from(k)] = known(index, planes, 8 * u32::from(k));
                    }
                }
            }
            StoredPart::Octant { level, index, octant } => {
                let planes = self.described(level, index);
                for k in OCTANTS {
                    let c = 8 * u32::from(octant & 7) + u32::from(k);
                    if planes.tag(c) == Tag::Partial {
                        verdicts[usize::from(k)] = known(index, planes, c);
                    }
                }
            }
            StoredPart::Record(record) => {
                if let CellCut::Split(first) = cuts.at(record as usize) {
                    verdicts =
                        OCTANTS.each(|k| Verdict::Partial(StoredPart::Record(first as u32 + u32::from(k))));
                }
            }
            StoredPart::Cut { .. } => {}
        }
        verdicts
    }
}
