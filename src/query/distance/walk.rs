//! A walk over the cells of a stored octree in which near cells come first.

use super::place::{Place, Square};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::{Cell, morton};
use crate::octree::links::Step;
use crate::octree::view::OctreeRef;
use crate::octree::{Planes, Tag};

/// A receiver of the cells that a walk meets.
pub(super) trait Visitor {
    /// Returns the cells to visit among an element's `real` cells, none of which is a branch. For each axis,
    /// `sides` says on which side of the element the point lies, if on one: above it or below. `None` if the
    /// cells are to be passed on as the octree stores them, octants of one tag as one cell.
    fn chosen(&self, planes: Planes, real: u64, sides: [Option<bool>; 3]) -> Option<u64>;

    /// Returns whether a cell at this distance matters. The cell is a leaf of `tag`, or a BRANCH with leaves
    /// of any tags.
    fn wants(&self, square: Square, cell: Cell, tag: Tag) -> bool;

    /// Takes in a leaf that matters.
    fn meet(&mut self, square: Square, cell: Cell, tag: Tag) -> Result<(), Error>;
}

/// Passes the leaves of a tree to a visitor, usually the near ones first.
///
/// In a sound tree no element is met twice. With damaged bytes, the walk meets at most as many elements as
/// the tree has. The cells of all further elements read as PARTIAL.
pub(super) fn walk(tree: &OctreeRef<'_>, place: &Place<'_>, visitor: &mut impl Visitor) -> Result<(), Error> {
    let left = tree.planes.len() + tree.bricks.len();
    let mut walk = Walk { tree, place, visitor, left };
    match tree.root {
        Tag::Branch => walk.element(0, 0, [0; 3]),
        tag => walk.leaf(place.square_from(Cell::ROOT), Cell::ROOT, tag),
    }
}

struct Walk<'w, 't, V> {
    tree: &'w OctreeRef<'t>,
    place: &'w Place<'w>,
    visitor: &'w mut V,
    /// The number of elements that may still be entered.
    left: usize,
}

impl<V: Visitor> Walk<'_, '_, V> {
    fn leaf(&mut self, square: Square, cell: Cell, tag: Tag) -> Result<(), Error> {
        if self.visitor.wants(square, cell, tag) { self.visitor.meet(square, cell, tag) } else { Ok(()) }
    }

    /// Passes on the leaves in element `index` of level `e`, whose own cell is at `at` on its level. The
    /// recursion is as deep as the tree has element levels, ten at the most.
    fn element(&mut self, e: usize, index: usize, at: [u32; 3]) -> Result<(), Error> {
        let level = self.tree.cell_level(e);
        let first = at.each(|a| 4 * a);
        let planes = self.tree.entry(index).unwrap_or(Planes::uniform(Tag::Partial));
        let squares = self.place.squares(level, first);
        let square = |c: u32| {
            let [x, y, z] = morton::position(c).each(|k| k as usize);
            squares[0][x] + squares[1][y] + squares[2][z]
        };
        let cell = |c: u32| {
            let place = morton::position(c);
            Cell { level, at: axes(|axis| first[axis] + place[axis]) }
        };
        let mut singles = if e == 0 { self.tree.root_cells() } else { !0 };
        let branches = singles & planes.branch();
        let sides = squares.each(|[a, b, c, d]| match (a < b && b < c && c < d, a > b && b > c && c > d) {
            (true, _) => Some(false),
            (_, true) => Some(true),
            _ => None,
        });
        let chosen = self.visitor.chosen(planes, singles, sides);
        if let Some(chosen) = chosen {
            singles &= chosen;
        } else if level > 1 {
            // Octants of one tag are cells. (The universe counts as cut, whatever damaged bytes contain for
            // its children.)
            for (octants, tag) in planes.octants().into_iter().zip([Tag::Empty, Tag::Full, Tag::Partial]) {
                let mut octants = octants & singles;
                while octants != 0 {
                    let c = octants.trailing_zeros();
                    octants &= octants - 1;
                    singles &= !(0xFF << c);
                    let octant = cell(c).parent();
                    self.leaf(self.place.square_from(octant), octant, tag)?;
                }
            }
        }
        let mut leaves = singles & !planes.branch();
        while leaves != 0 {
            let c = leaves.trailing_zeros();
            leaves &= leaves - 1;
            self.leaf(square(c), cell(c), planes.tag(c))?;
        }
        if branches == 0 {
            return Ok(());
        }
        let mut rest = branches;
        let mut branches = [(0, 0); 64];
        let mut count = 0;
        while rest != 0 {
            let c = rest.trailing_zeros();
            rest &= rest - 1;
            branches[count] = (square(c), c);
            count += 1;
        }
        let branches = &mut branches[..count];
        branches.sort_unstable();
        for &mut (square, c) in branches {
            let cell = cell(c);
            if !self.visitor.wants(square, cell, Tag::Branch) {
                continue;
            }
            match self.tree.step(e, index, planes, c) {
                Step::Into(child) if self.left > 0 => {
                    self.left -= 1;
                    self.element(e + 1, child, cell.at)?;
                }
                _ => self.leaf(square, cell, Tag::Partial)?,
            }
        }
        Ok(())
    }
}
