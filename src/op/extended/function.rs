//! Functions of up to six surfaces.

use crate::error::Error;
use crate::lattice::Cell;
use crate::lattice::Each;
use crate::octree::Tag;
use crate::octree::cuts::{Cut, Head};
use crate::solid::OCTANTS;
use crate::solid::half_space::Placed;
use crate::solid::half_space::bounds::{Octants, Sides};
use crate::solid::half_space::joined::Joined;
use crate::solid::half_space::possible::possible;
use crate::solid::half_space::table::{MOST, Table};
use core::cmp::Ordering;

/// The greatest number of surfaces that a cell keeps.
pub(super) const MOST_KEPT: usize = 3;

/// The surfaces of a tree under construction, by their preliminary numbers.
pub(super) trait Known {
    /// Returns the surface on the universe.
    fn placed(&self, id: u32) -> Result<&Placed, Error>;

    /// Compares surfaces independently of their numbers.
    fn order(&self, a: u32, b: u32) -> Ordering;

    /// Returns whether cells that share this surface may be joined.
    fn joins(&self, id: u32) -> bool;
}

/// A finished cell: its tag, and its cut if the tag is PARTIAL.
pub(super) type Done = (Tag, Cut);

/// A function of the signs of up to six surfaces.
#[derive(Clone, Copy)]
pub(super) struct Function {
    ids: [u32; MOST],
    count: usize,
    table: Table,
}

impl Function {
    pub(super) fn constant(inside: bool) -> Function {
        Function { ids: [0; MOST], count: 0, table: if inside { Table::FULL } else { Table::EMPTY } }
    }

    /// The function of a record. Its table gives the number of surfaces that count.
    pub(super) fn of_record(ids: [u32; MOST_KEPT], table: u8) -> Function {
        let (mut own, count) = (Function::constant(false), Head(table).surfaces());
        own.ids[..count].copy_from_slice(&ids[..count]);
        Function { count, table: Table::widened(table), ..own }
    }

    /// A function of surfaces with these numbers, some of which may be equal; `table` treats all six as
    /// distinct.
    pub(super) fn of_numbers(ids: &[u32], table: Table) -> Function {
        let (mut own, mut places) = (Function::constant(false), [0; MOST]);
        for (place, &id) in places.iter_mut().zip(ids) {
            *place = own.ids().iter().position(|&known| known == id).unwrap_or(own.count);
            if *place == own.count {
                (own.ids[own.count], own.count) = (id, own.count + 1);
            }
        }
        Function { table: table.spread(&places[..ids.len()]), ..own }
    }

    pub(super) fn ids(&self) -> &[u32] {
        &self.ids[..self.count]
    }

    #[must_use]
    pub(super) fn complement_if(self, flip: bool) -> Function {
        Function { table: if flip { Table(!self.table.0) } else { self.table }, ..self }
    }

    /// Combines the values of this function and another one; `None` if they have more than six surfaces.
    pub(super) fn with(&self, other: &Function, combine: impl Fn(u64, u64) -> u64) -> Option<Function> {
        let mut all = *self;
        let mut places = [0; MOST];
        for (place, &id) in places.iter_mut().zip(other.ids()) {
            *place = match all.ids().iter().position(|&known| known == id) {
                Some(known) => known,
                None => {
                    *all.ids.get_mut(all.count)? = id;
                    all.count += 1;
                    all.count - 1
                }
            };
        }
        all.table.0 = combine(self.table.0, other.table.spread(&places[..other.count]).0);
        Some(all)
    }

    /// The same function, with its surfaces in their order.
    fn ordered(&self, surfaces: &impl Known) -> Function {
        if self.ids().windows(2).all(|pair| surfaces.order(pair[0], pair[1]).is_lt()) {
            return *self;
        }
        let mut order = [0, 1, 2, 3, 4, 5];
        order[..self.count].sort_unstable_by(|&a, &b| surfaces.order(self.ids[a], self.ids[b]));
        self.chosen(&order[..self.count])
    }

    /// The function with only these surfaces, in this order. It must not depend on others.
    fn chosen(&self, order: &[usize]) -> Function {
        let mut own = Function { count: order.len(), ..Function::constant(false) };
        let mut places = [0; MOST];
        for (to, &from) in order.iter().enumerate() {
            own.ids[to] = self.ids[from];
            places[from] = to;
        }
        Function { table: self.table.spread(&places[..self.count]), ..own }
    }

    /// The function restricted to the combinations that are possible in a cell. It has as few surfaces as
    /// possible, in their order.
    pub(super) fn simplified(&self, cell: Cell, surfaces: &impl Known) -> Result<Function, Error> {
        let own = self.ordered(surfaces);
        let possible = own.possible(cell, surfaces)?;
        Ok(own.reduced(possible))
    }

    /// The same function with as few surfaces as its table allows, in their order.
    pub(super) fn canonical(&self, surfaces: &impl Known) -> Function {
        self.ordered(surfaces).reduced(Table::FULL)
    }

    fn possible(&self, cell: Cell, surfaces: &impl Known) -> Result<Table, Error> {
        let mut placed = [None; MOST];
        for (placed, &id) in placed.iter_mut().zip(self.ids()) {
            *placed = Some(surfaces.placed(id)?);
        }
        Ok(possible(placed.into_iter().flatten(), cell))
    }

    fn reduced(&self, possible: Table) -> Function {
        let own = Function { table: self.table.simplified(possible), ..*self };
        let (needed, count) = own.table.needed();
        own.chosen(&needed[..count])
    }

    /// The finished cell of this function; `None` if the function has too many surfaces to be kept.
    pub(super) fn end(&self) -> Option<Done> {
        let mut ids = [0; MOST_KEPT];
        match self.count {
            0 => Some((if self.table == Table::FULL { Tag::Full } else { Tag::Empty }, Cut::None)),
            1..=MOST_KEPT => {
                ids[..self.count].copy_from_slice(self.ids());
                Some((Tag::Partial, Cut::Table { ids, table: self.table.0 as u8 }))
            }
            _ => None,
        }
    }

    /// The function in each child of a cell, simplified by the surfaces whose sign is known there.
    pub(super) fn below(&self, cell: Cell, surfaces: &impl Known) -> Result<[Function; 8], Error> {
        let at = Octants::of(cell);
        let mut children = [*self; 8];
        for (i, &id) in self.ids().iter().enumerate() {
            let sides = surfaces.placed(id)?.sides(&at, 0xFF, &mut 0)?;
            for (k, child) in (0..).zip(&mut children) {
                child.table = child.table.known(i, sides, k);
            }
        }
        Ok(children.each(|child| child.reduced(Table::FULL)))
    }

    /// Returns the joint function of a cell with eight finished children. It has up to three surfaces, and
    /// the value of each child for all combinations of signs that are possible there. `None` if there is no
    /// such function.
    pub(super) fn joined<'d>(
        cell: Cell,
        children: impl Iterator<Item = &'d Done> + Clone,
        surfaces: &impl Known,
    ) -> Result<Option<Function>, Error> {
        let mut all = Function::constant(false);
        for child in children.clone() {
            let own = match child {
                (Tag::Partial, Cut::Table { ids, table }) => &ids[..Head(*table).surfaces()],
                (Tag::Empty | Tag::Full, _) => &[],
                _ => return Ok(None),
            };
            for &id in own {
                if !all.ids().contains(&id) {
                    if all.count == MOST_KEPT || !surfaces.joins(id) {
                        return Ok(None);
                    }
                    (all.ids[all.count], all.count) = (id, all.count + 1);
                }
            }
        }
        if all.count == 0 {
            return Ok(None);
        }
        let all = all.ordered(surfaces);
        // The combinations that are possible in a child: bounds of pairs exclude some that signs allow, and
        // exact signs exclude some that bounds allow.
        let at = Octants::of(cell);
        let mut sides = [Sides { inside: 0, outside: 0 }; MOST_KEPT];
        for (sides, &id) in sides.iter_mut().zip(all.ids()) {
            *sides = surfaces.placed(id)?.sides(&at, 0xFF, &mut 0)?;
        }
        let mut joined = Joined::default();
        for (k, child) in OCTANTS.into_iter().zip(children) {
            let value = match child {
                (Tag::Partial, Cut::Table { ids, table }) => {
                    let mut places = [0; MOST_KEPT];
                    let own = &ids[..Head(*table).surfaces()];
                    for (place, id) in places.iter_mut().zip(own) {
                        *place = all.ids().iter().position(|known| known == id).unwrap_or(0);
                    }
                    Table::widened(*table).spread(&places[..own.len()])
                }
                (Tag::Full, _) => Table::FULL,
                _ => Table::EMPTY,
            };
            let mut possible = all.possible(cell.child(k), surfaces)?;
            for (i, sides) in sides.iter().enumerate() {
                possible = possible.on_side(i, sides.side(k.into()));
            }
            if !joined.take(value, possible) {
                return Ok(None);
            }
        }
        let (table, possible) = joined.tables();
        Ok(Some(Function { table, ..all }.reduced(possible)))
    }
}
