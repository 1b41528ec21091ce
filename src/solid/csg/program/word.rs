//! The words, in postfix order, of a cell's share of an expression.

use crate::solid::csg::Join;

/// One word: an operand, or an operator that joins the operands before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Word(u32);

/// A decoded word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Op {
    /// Half-space `index`, or its complement.
    HalfSpace { index: u32, complement: bool },
    /// Another solid, or its complement. `index` counts the parts that a worker keeps; the first of these are
    /// the universe's parts of the program's solids.
    Solid { index: u32, complement: bool },
    /// An undecided operand that splitting does not decide.
    Unknown,
    /// The operation on the `count` operands before it; or the operation's complement.
    Join { join: Join, complement: bool, count: u32 },
    /// A group of operands that are not evaluated one by one: number `index` of the program's groups.
    Group { index: u32 },
    /// The intersection of the `count` half-spaces before it, which are classified together by
    /// [`Touch::Paper`].
    Primitive { count: u32 },
}

impl Word {
    /// The greatest index or count that a word can hold.
    pub(crate) const MOST: u32 = (1 << 28) - 1;

    pub(crate) fn new(op: Op) -> Word {
        let word = |tag: u32, complement: bool, value: u32| tag | (complement as u32) << 3 | value << 4;
        Word(match op {
            Op::HalfSpace { index, complement } => word(0, complement, index),
            Op::Solid { index, complement } => word(1, complement, index),
            Op::Unknown => word(2, false, 0),
            Op::Join { join: Join::Intersection, complement, count } => word(3, complement, count),
            Op::Join { join: Join::Union, complement, count } => word(4, complement, count),
            Op::Join { join: Join::Parity, complement, count } => word(5, complement, count),
            Op::Primitive { count } => word(6, false, count),
            Op::Group { index } => word(7, false, index),
        })
    }

    /// Stores half of a number as a word.
    pub(crate) fn raw(bits: u32) -> Word {
        Word(bits)
    }

    /// Returns the bits of such a half.
    pub(crate) fn bits(self) -> u32 {
        self.0
    }

    #[inline(always)]
    pub(crate) fn op(self) -> Op {
        let (complement, value) = (self.0 & 8 != 0, self.0 >> 4);
        let join = |join| Op::Join { join, complement, count: value };
        match self.0 & 7 {
            0 => Op::HalfSpace { index: value, complement },
            1 => Op::Solid { index: value, complement },
            3 => join(Join::Intersection),
            4 => join(Join::Union),
            5 => join(Join::Parity),
            6 => Op::Primitive { count: value },
            7 => Op::Group { index: value },
            _ => Op::Unknown,
        }
    }
}

impl Word {
    /// The bits of a half-space's index; there are at most [`MOST`](crate::solid::csg::MOST) half-spaces.
    const VARIABLE: u32 = 25;

    /// Makes the word of a half-space with its number in a truth table.
    pub(crate) fn of_variable(i: usize, index: u32) -> Word {
        Word(index | (i as u32) << Word::VARIABLE)
    }

    /// Returns the number of a half-space in a truth table, and its index.
    #[inline(always)]
    pub(crate) fn variable(self) -> (usize, u32) {
        ((self.0 >> Word::VARIABLE) as usize, self.0 & ((1 << Word::VARIABLE) - 1))
    }
}

impl Op {
    /// The value of an operand that decides the operation, if there is such a value.
    pub(crate) fn absorbs(self) -> Option<bool> {
        match self {
            Op::Join { join: Join::Union, .. } => Some(true),
            Op::Join { join: Join::Intersection, .. } | Op::Primitive { .. } => Some(false),
            _ => None,
        }
    }

    /// Returns the value of an operation with `open` undecided operands, if it has one. It has a value if an
    /// operand that decides the operation was `absorbed`, or if no operand is open.
    pub(crate) fn decided(self, open: u32, parity: bool, absorbed: bool) -> Option<bool> {
        let (none, complement) = match self {
            Op::Join { join: Join::Union, complement, .. } => (false, complement),
            Op::Join { join: Join::Intersection, complement, .. } => (true, complement),
            Op::Join { join: Join::Parity, complement, .. } => (parity, complement),
            _ => (true, false),
        };
        match (absorbed, open) {
            (true, _) => Some(!none ^ complement),
            (false, 0) => Some(none ^ complement),
            _ => None,
        }
    }

    /// Returns the remainder of an operation with `open` undecided operands; `None` if it is a single
    /// operand. Decided operands of unions and intersections do not matter, decided operands of a parity
    /// contribute their `parity`.
    pub(crate) fn of_open(self, open: u32, parity: bool) -> Option<Op> {
        match self {
            Op::Join { join: Join::Parity, complement, .. } => {
                let complement = complement ^ parity;
                (open > 1 || complement).then_some(Op::Join { join: Join::Parity, complement, count: open })
            }
            Op::Join { join, complement, .. } => {
                (open > 1).then_some(Op::Join { join, complement, count: open })
            }
            Op::Primitive { .. } => Some(Op::Primitive { count: open }),
            _ => Some(self),
        }
    }
}
