//! One function of few surfaces that has the values of all pieces of a target, with layers taken into
//! account.
//!
//! At a point, a surface is known to be on one side, or the point lies within the width of a layer. These
//! facts are the *state* of the point. A table's value at the point holds for all sides of the layers in
//! whose widths the point lies. So a function may represent a piece if, for each state that occurs in the
//! piece, it has the value of the piece or no value. It must not have a value where the piece has none. A
//! missing value is a loss, which is allowed along lines. An example is two facets that meet in a wall
//! between two cells of the source, where one cell knows both planes and the other cell knows one. The other
//! plane counts in the second cell, too, but only within the widths around their edge.

use super::polytope::Polytope;
use crate::error::Error;
use crate::lattice::Each;
use crate::memory;
use crate::solid::half_space::table::Table;
use alloc::vec::Vec;

/// The greatest number of states in a target.
const MOST_STATES: usize = 2048;

/// Linear bounds of a surface's function over a target, from the centre in half edges.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flat {
    pub(super) gradient: [f64; 3],
    pub(super) low: f64,
    pub(super) high: f64,
    /// For a layer, a number greater than the error of `low` and `high`; `None` for an exact surface.
    pub(super) layer: Option<f64>,
}

/// The possible places of a point: where the function is positive, in the width of a layer, and where the
/// function is negative.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Places {
    pub(super) inside: bool,
    pub(super) within: bool,
    pub(super) outside: bool,
}

impl Places {
    /// The places on one side.
    pub(super) fn side(inside: bool) -> Places {
        Places { inside, within: false, outside: !inside }
    }

    /// The side, if it is the only possible place.
    pub(super) fn known(self) -> Option<bool> {
        (!self.within && self.inside != self.outside).then_some(self.inside)
    }
}

impl Flat {
    /// Bounds of a surface of which nothing is known.
    pub(super) const ANY: Flat =
        Flat { gradient: [0.0; 3], low: f64::NEG_INFINITY, high: f64::INFINITY, layer: None };

    /// The places of the points of a body. (A NaN may be anywhere.)
    #[allow(clippy::neg_cmp_op_on_partial_ord)]
    pub(super) fn places(&self, body: &Polytope) -> Places {
        let (least, most) = body.extremes(self.gradient);
        match self.layer {
            Some(margin) => Places {
                inside: !(most + self.low + margin < 0.0),
                within: !(least + self.low > 0.0 || most + self.high < 0.0),
                outside: !(least + self.high - margin > 0.0),
            },
            None => Places {
                inside: !(most + self.high < 0.0),
                within: false,
                outside: !(least + self.low > 0.0),
            },
        }
    }

    /// Returns whether this is a layer, and wherever in the cube its side is known, the other surface is
    /// known to be on the same side.
    pub(super) fn holds(&self, other: &Flat) -> bool {
        let Some(margin) = self.layer else { return false };
        let length = |flat: &Flat| {
            let [x, y, z] = flat.gradient;
            libm::sqrt(x * x + y * y + z * z)
        };
        let share = length(other) / length(self);
        let (mut reach, mut size) = (0.0, 0.0);
        for axis in 0..3 {
            let (own, others) = (share * self.gradient[axis], other.gradient[axis]);
            reach += (others - own).abs();
            size += own.abs() + others.abs();
        }
        let ends = [self.low, self.high].each(|end| share * end);
        size += ends[0].abs() + ends[1].abs() + other.low.abs() + other.high.abs();
        let room = reach + share * margin + 16.0 * f64::EPSILON * size;
        // (A comparison with NaN is false.)
        ends[0] + room <= other.low && other.high <= ends[1] - room
    }

    /// The part of a body that lies in one of the places.
    fn part(&self, body: &Polytope, place: Place) -> Option<Polytope> {
        let (up, down) = (self.gradient, self.gradient.each(|c| -c));
        match (place, self.layer) {
            (Place::Inside, Some(margin)) => body.clipped(up, self.low + margin),
            (Place::Inside, None) => body.clipped(up, self.high),
            (Place::Outside, Some(margin)) => body.clipped(down, margin - self.high),
            (Place::Outside, None) => body.clipped(down, -self.low),
            (Place::Within, _) => body.clipped(up, self.high)?.clipped(down, -self.low),
        }
    }

    /// The width of the layer, in half edges.
    fn width(&self) -> f64 {
        let [x, y, z] = self.gradient;
        (self.high - self.low) / libm::sqrt(x * x + y * y + z * z)
    }
}

#[derive(Debug, Clone, Copy)]
enum Place {
    Inside,
    Within,
    Outside,
}

/// The result for all pieces.
pub(super) enum Found {
    /// A function, and the combinations of signs for which it is known.
    Function(Table, Table),
    /// No function, because of this piece.
    Conflict(usize),
    /// No function.
    Nothing,
}

/// A state that occurs in a piece.
struct State {
    piece: usize,
    /// The combinations of signs of the state.
    signs: u64,
    /// Whether the state lies within the width of a layer.
    is_wide: bool,
    /// Whether the loss of its value is allowed.
    may_be_lost: bool,
}

/// The states of all pieces, to be joined.
#[derive(Default)]
pub(super) struct Regions {
    states: Vec<State>,
    /// The table of each piece.
    values: Vec<Table>,
}

/// For each surface, its bounds, and the side on which the piece lies, if that is known otherwise.
pub(super) type Seen<'f> = [(Flat, Option<bool>)];

impl Regions {
    /// Adds a piece, whose function of these surfaces is `value`; returns `false` if there are too many
    /// states. Losses must lie within `finest` of a line.
    pub(super) fn take(
        &mut self,
        body: &Polytope,
        seen: &Seen<'_>,
        value: Table,
        finest: f64,
    ) -> Result<bool, Error> {
        memory::push(&mut self.values, value)?;
        self.divide(body, seen, 0, (u64::MAX, 0.0), finest)
    }

    /// Adds the states of the part of a body in given places of the first surfaces. `signs` are the
    /// combinations of signs there; the width is the greatest of the layers that contain the part.
    fn divide(
        &mut self,
        body: &Polytope,
        seen: &Seen<'_>,
        number: usize,
        (signs, width): (u64, f64),
        finest: f64,
    ) -> Result<bool, Error> {
        /// The greatest thickness of a loss, in widths of the layers: planes may meet at a small angle.
        const SLENDER: f64 = 256.0;
        let Some(&(flat, side)) = seen.get(number) else {
            let piece = self.values.len() - 1;
            let (value, is_wide) = (self.values[piece].0 & signs, width > 0.0);
            let is_one = value == 0 || value == signs;
            let may_be_lost = is_wide && is_one && body.is_needle(finest.min(SLENDER * width));
            if self.states.iter().rev().take_while(|state| state.piece == piece).any(|state| {
                state.signs == signs && state.is_wide == is_wide && state.may_be_lost == may_be_lost
            }) {
                return Ok(true);
            }
            memory::push(&mut self.states, State { piece, signs, is_wide, may_be_lost })?;
            return Ok(self.states.len() <= MOST_STATES);
        };
        let places = side.map_or_else(|| flat.places(body), Places::side);
        let all = [
            (Place::Inside, places.inside, Table::of(number, false).0),
            (Place::Within, places.within, u64::MAX),
            (Place::Outside, places.outside, Table::of(number, true).0),
        ];
        let is_cut = all.iter().filter(|(_, may_be, _)| *may_be).count() > 1;
        for (place, _, own) in all.into_iter().filter(|(_, may_be, _)| *may_be) {
            let width = if matches!(place, Place::Within) { width.max(flat.width()) } else { width };
            let known = (signs & own, width);
            let is_done = match is_cut {
                false => self.divide(body, seen, number + 1, known, finest)?,
                true => match flat.part(body, place) {
                    Some(part) => self.divide(&part, seen, number + 1, known, finest)?,
                    None => true,
                },
            };
            if !is_done {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Returns one function that has the values of all pieces.
    pub(super) fn joined(&self) -> Found {
        let (mut holds, mut fails) = (0, 0);
        // The values at points outside all widths come first.
        for is_wide in [false, true] {
            for state in self.states.iter().filter(|state| state.is_wide == is_wide) {
                let value = self.values[state.piece].0;
                let open = if is_wide { state.signs & !(holds | fails) } else { state.signs };
                (holds, fails) = (holds | value & open, fails | !value & open);
                if holds & fails != 0 {
                    return Found::Conflict(state.piece);
                }
            }
        }
        for state in &self.states {
            let one = |table: u64| match table & state.signs {
                0 => Some(false),
                all if all == state.signs => Some(true),
                _ => None,
            };
            let is_right = match (one(holds), one(self.values[state.piece].0)) {
                (Some(own), value) => value == Some(own),
                (None, Some(_)) => state.may_be_lost,
                (None, None) => true,
            };
            if !is_right {
                return Found::Conflict(state.piece);
            }
        }
        if holds | fails == 0 {
            return Found::Nothing;
        }
        Found::Function(Table(holds), Table(holds | fails))
    }
}
