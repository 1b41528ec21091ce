//! Evaluation of the arguments of a call.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::grammar::{Call, Kind, Tree, shown};
use crate::error::Error;
use crate::lattice::valid::{IMMODERATE, is_moderate};
use crate::memory;

/// A call with its arguments in the order of its parameters.
pub(super) struct Given<'a, const N: usize> {
    tree: &'a Tree<'a>,
    /// The byte offset of the call.
    at: usize,
    names: [&'static str; N],
    fineness: [Option<f64>; 3],
    /// Indices of the values that are given and not undefined.
    values: [Option<usize>; N],
}

impl<'a, const N: usize> Given<'a, N> {
    /// Assigns arguments to parameters. Arguments without a name are assigned in order. All others must be
    /// parameters, with two exceptions that have no effect on a shape: names in `ignored`, and names that
    /// begin with `$`, except for the three that control the fineness of curves.
    pub fn new(
        tree: &'a Tree<'a>,
        call: &Call<'a>,
        names: [&'static str; N],
        ignored: &[&str],
    ) -> Result<Self, Error> {
        let mut values = [None; N];
        let mut is_given = [false; N];
        let mut unnamed = 0..N;
        let mut fineness = [None; 3];
        for argument in &tree.arguments[call.arguments.clone()] {
            let refuse = |problem: String| Err(tree.fault(argument.at, format!("`{}` {problem}", call.name)));
            let position = match argument.name {
                Some(name) if name.starts_with('$') => {
                    let known = ["$fn", "$fa", "$fs"].iter().position(|known| *known == name);
                    if let (Some(k), Kind::Number(number)) = (known, tree.values[argument.value].kind) {
                        fineness[k] = Some(number);
                    }
                    continue;
                }
                Some(name) if ignored.contains(&name) => continue,
                Some(name) => match names.iter().position(|&known| known == name) {
                    Some(position) => position,
                    None => return refuse(format!("has no parameter {}", shown(name))),
                },
                None => match unnamed.next() {
                    Some(position) => position,
                    None if ignored.is_empty() => return refuse(format!("has {N} parameters only")),
                    None => continue,
                },
            };
            if is_given[position] {
                return refuse(format!("is given `{}` twice", names[position]));
            }
            is_given[position] = true;
            if tree.values[argument.value].kind != Kind::Undefined {
                values[position] = Some(argument.value);
            }
        }
        Ok(Given { tree, at: call.at, names, fineness, values })
    }

    /// Returns `$fn`, `$fa` and `$fs`, each if it is given.
    pub fn fineness(&self) -> [Option<f64>; 3] {
        self.fineness
    }

    /// Returns the value of a parameter that has no default.
    pub fn required(&self, parameter: usize) -> Result<Item<'a>, Error> {
        self.optional(parameter)
            .ok_or_else(|| self.tree.fault(self.at, format!("`{}` is missing", self.names[parameter])))
    }

    pub fn optional(&self, parameter: usize) -> Option<Item<'a>> {
        self.values[parameter].map(|value| Item { tree: self.tree, value })
    }

    pub fn number_or(&self, parameter: usize, default: f64) -> Result<f64, Error> {
        self.optional(parameter).map_or(Ok(default), |item| item.number())
    }

    pub fn truth_or(&self, parameter: usize, default: bool) -> Result<bool, Error> {
        self.optional(parameter).map_or(Ok(default), |item| item.truth())
    }
}

/// A value in a text.
#[derive(Clone, Copy)]
pub(super) struct Item<'a> {
    tree: &'a Tree<'a>,
    value: usize,
}

impl<'a> Item<'a> {
    fn kind(&self) -> Kind<'a> {
        self.tree.values[self.value].kind
    }

    pub fn fault(&self, problem: impl Into<String>) -> Error {
        self.tree.fault(self.tree.values[self.value].at, problem)
    }

    pub fn number(&self) -> Result<f64, Error> {
        match self.kind() {
            // Negative zero becomes zero.
            Kind::Number(number) if is_moderate(number) => Ok(number + 0.0),
            Kind::Number(_) => Err(self.fault(IMMODERATE)),
            _ => Err(self.fault("expected a number")),
        }
    }

    /// Returns a whole number from 0, such as a count or an index.
    pub fn index(&self) -> Result<u32, Error> {
        match self.kind() {
            Kind::Number(number) if number >= 0.0 && number <= u32::MAX.into() && number % 1.0 == 0.0 => {
                Ok(number as u32)
            }
            _ => Err(self.fault("expected a whole number that is not negative")),
        }
    }

    pub fn truth(&self) -> Result<bool, Error> {
        match self.kind() {
            Kind::Truth(truth) => Ok(truth),
            _ => Err(self.fault("expected true or false")),
        }
    }

    pub fn is_list(&self) -> bool {
        matches!(self.kind(), Kind::List(_))
    }

    /// Returns a text with its escape sequences replaced.
    pub fn text(&self) -> Result<String, Error> {
        let Kind::Text(raw) = self.kind() else { return Err(self.fault("expected a text in quotes")) };
        let mut text = String::new();
        text.try_reserve(raw.len())?;
        let mut rest = raw.chars();
        while let Some(c) = rest.next() {
            text.push(match c {
                '\\' => match rest.next() {
                    Some('n') => '\n',
                    Some('r') => '\r',
                    Some('t') => '\t',
                    Some(same @ ('"' | '\\')) => same,
                    _ => {
                        return Err(
                            self.fault("in texts there are the escape sequences \\\" \\\\ \\n \\r \\t only")
                        );
                    }
                },
                c => c,
            });
        }
        Ok(text)
    }

    /// Returns the items of a list of any length.
    pub fn items(&self) -> Result<impl Iterator<Item = Item<'a>> + use<'a>, Error> {
        let Kind::List(end) = self.kind() else { return Err(self.fault("expected a list")) };
        let tree = self.tree;
        Ok(tree.items(self.value, end).map(move |value| Item { tree, value }))
    }

    /// Returns the items of a list of this length.
    pub fn list<const N: usize>(&self) -> Result<[Item<'a>; N], Error> {
        let mut list = [*self; N];
        let mut count = 0;
        for item in self.items()? {
            if let Some(place) = list.get_mut(count) {
                *place = item;
            }
            count += 1;
        }
        if count == N { Ok(list) } else { Err(self.fault(format!("expected {N} items, found {count}"))) }
    }

    /// Returns a list of this many numbers.
    pub fn numbers<const N: usize>(&self) -> Result<[f64; N], Error> {
        let mut numbers = [0.0; N];
        for (number, item) in numbers.iter_mut().zip(self.list::<N>()?) {
            *number = item.number()?;
        }
        Ok(numbers)
    }

    /// Returns a list of points.
    pub fn points<const N: usize>(&self) -> Result<Vec<[f64; N]>, Error> {
        let mut points = Vec::new();
        for item in self.items()? {
            memory::push(&mut points, item.numbers()?)?;
        }
        Ok(points)
    }

    /// Returns a list of indices of `count` points.
    pub fn indices(&self, count: usize) -> Result<Vec<u32>, Error> {
        let mut indices = Vec::new();
        for item in self.items()? {
            let index = item.index()?;
            if index as usize >= count {
                return Err(
                    item.fault(format!("there is no point {index}: there are {count}, counted from 0"))
                );
            }
            memory::push(&mut indices, index)?;
        }
        Ok(indices)
    }
}
