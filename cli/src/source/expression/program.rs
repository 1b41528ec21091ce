//! Expressions as they are evaluated: a list of steps on a stack of numbers.

use super::number::Number;

/// An operation on the last numbers of the stack.
#[derive(Debug, Clone, Copy)]
pub enum Step {
    /// Pushes a number.
    Number(f64),
    /// Pushes x, y or z: 0, 1 or 2.
    Variable(usize),
    /// Replaces the last number.
    Unary(Unary),
    /// Replaces the last two numbers by one.
    Binary(Binary),
}

#[derive(Debug, Clone, Copy)]
pub enum Unary {
    Negate,
    Abs,
    Sqrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Floor,
    Ceil,
    Round,
}

#[derive(Debug, Clone, Copy)]
pub enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Least,
    Greatest,
}

/// The steps of one expression. They leave one number on the stack.
#[derive(Debug, Default)]
pub struct Program {
    steps: Vec<Step>,
    /// Length of the stack after all steps.
    height: usize,
    /// Greatest length of the stack.
    depth: usize,
}

/// Most numbers that are kept without an allocation.
const FEW: usize = 16;

impl Program {
    /// Appends a step. The numbers that it replaces must be on the stack.
    pub fn push(&mut self, step: Step) {
        match step {
            Step::Number(_) | Step::Variable(_) => self.height += 1,
            Step::Unary(_) => {}
            Step::Binary(_) => self.height -= 1,
        }
        self.depth = self.depth.max(self.height);
        self.steps.push(step);
    }

    /// Returns the value for these x, y and z. Allocates only for stacks of more than [`FEW`] numbers.
    pub fn run<T: Number>(&self, variables: [T; 3]) -> T {
        if self.depth <= FEW {
            self.run_on(&mut [T::default(); FEW], variables)
        } else {
            self.run_on(&mut vec![T::default(); self.depth], variables)
        }
    }

    fn run_on<T: Number>(&self, stack: &mut [T], variables: [T; 3]) -> T {
        let mut height = 0;
        for step in &self.steps {
            let number = match *step {
                Step::Number(value) => T::constant(value),
                Step::Variable(axis) => variables[axis],
                Step::Unary(operation) => {
                    height -= 1;
                    unary(operation, stack[height])
                }
                Step::Binary(operation) => {
                    height -= 2;
                    binary(operation, stack[height], stack[height + 1])
                }
            };
            stack[height] = number;
            height += 1;
        }
        stack[0]
    }
}

fn unary<T: Number>(operation: Unary, a: T) -> T {
    match operation {
        Unary::Negate => T::negate(a),
        Unary::Abs => T::abs(a),
        Unary::Sqrt => T::sqrt(a),
        Unary::Exp => T::exp(a),
        Unary::Ln => T::ln(a),
        Unary::Sin => T::sin(a),
        Unary::Cos => T::cos(a),
        Unary::Floor => T::floor(a),
        Unary::Ceil => T::ceil(a),
        Unary::Round => T::round(a),
    }
}

fn binary<T: Number>(operation: Binary, a: T, b: T) -> T {
    match operation {
        Binary::Add => T::add(a, b),
        Binary::Subtract => T::subtract(a, b),
        Binary::Multiply => T::multiply(a, b),
        Binary::Divide => T::divide(a, b),
        Binary::Power => T::power(a, b),
        Binary::Least => T::least(a, b),
        Binary::Greatest => T::greatest(a, b),
    }
}
