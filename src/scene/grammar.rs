//! The grammar of CSG dumps.
//!
//! Words, numbers, texts and the heads of calls are parsers of the crate `winnow`. Nested structures, calls
//! in blocks and lists in lists, are kept in tables, so that deep nesting cannot overflow the stack.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::ops::Range;

use winnow::Parser;
use winnow::ascii::{digit0, digit1, multispace1, till_line_ending};
use winnow::combinator::{alt, delimited, not, opt, preceded, repeat, terminated};
use winnow::error::EmptyError;
use winnow::token::{any, one_of, take_till, take_until, take_while};

use crate::error::{Error, SceneError};
use crate::memory;

/// A parsed text: its calls, each before the calls in its block.
pub(super) struct Tree<'t> {
    pub text: &'t str,
    pub calls: Vec<Call<'t>>,
    pub arguments: Vec<Argument<'t>>,
    pub values: Vec<Value<'t>>,
}

/// A call with its block.
pub(super) struct Call<'t> {
    /// Number of bytes of the text before it.
    pub at: usize,
    pub name: &'t str,
    pub arguments: Range<usize>,
    /// Index of the first call after its block.
    pub end: usize,
    /// True if a modifier removes it from the scene.
    pub is_ignored: bool,
}

/// An argument of a call.
pub(super) struct Argument<'t> {
    pub at: usize,
    pub name: Option<&'t str>,
    /// Index of its value.
    pub value: usize,
}

/// A value. The items of a list follow the list.
pub(super) struct Value<'t> {
    pub at: usize,
    pub kind: Kind<'t>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind<'t> {
    Undefined,
    Truth(bool),
    Number(f64),
    /// A text between its quotes, with its escape sequences.
    Text(&'t str),
    /// A list, which ends before the value with this index.
    List(usize),
}

/// Makes the error that something is wrong at the byte offset `at` of a text.
pub(super) fn fault(text: &str, at: usize, problem: impl Into<String>) -> Error {
    SceneError::new(place(text, at), problem.into()).into()
}

/// Returns line and column, counted from 1, of a place in a text.
fn place(text: &str, at: usize) -> (u64, u64) {
    let mut cursor = Cursor::default();
    cursor.advance(text, at);
    (cursor.line, cursor.column)
}

/// A place in a text that only moves forward.
pub(super) struct Cursor {
    at: usize,
    pub line: u64,
    pub column: u64,
}

impl Default for Cursor {
    fn default() -> Cursor {
        Cursor { at: 0, line: 1, column: 1 }
    }
}

impl Cursor {
    /// Moves to a place that is not before the current one. O(distance).
    pub fn advance(&mut self, text: &str, to: usize) {
        for c in text.get(self.at..to).unwrap_or_default().chars() {
            match c {
                '\n' => (self.line, self.column) = (self.line + 1, 1),
                BYTE_ORDER_MARK => {}
                _ => self.column += 1,
            }
        }
        self.at = self.at.max(to);
    }
}

const BYTE_ORDER_MARK: char = '\u{FEFF}';

/// Returns a name as an error shows it.
pub(super) fn shown(name: &str) -> String {
    match name.char_indices().nth(40) {
        None => format!("`{name}`"),
        Some((end, _)) => format!("`{}…`", &name[..end]),
    }
}

type Parsed<O> = Result<O, EmptyError>;

/// Parses white space and comments.
fn space(input: &mut &str) -> Parsed<()> {
    let comment = (("/*", take_until(0.., "*/")), "*/");
    repeat(0.., alt((multispace1.void(), ("//", till_line_ending).void(), comment.void()))).parse_next(input)
}

fn is_in_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

fn name<'t>(input: &mut &'t str) -> Parsed<&'t str> {
    let first = one_of(|c: char| c == '$' || is_in_name(c) && !c.is_ascii_digit());
    (first, take_while(0.., is_in_name)).take().parse_next(input)
}

fn sign(input: &mut &str) -> Parsed<Option<char>> {
    opt(one_of(['+', '-'])).parse_next(input)
}

fn number(input: &mut &str) -> Parsed<f64> {
    let digits = alt(((digit1, opt(('.', digit0))).void(), ('.', digit1).void()));
    let exponent = opt((one_of(['e', 'E']), sign, digit1));
    let finite = (sign, digits, exponent).take();
    let other = (sign, alt(("inf", "nan"))).take();
    // Rust's own names of these two are the same.
    terminated(alt((finite, other)), not(one_of(|c| is_in_name(c) || c == '.')))
        .try_map(str::parse)
        .parse_next(input)
}

fn text<'t>(input: &mut &'t str) -> Parsed<&'t str> {
    let piece = alt((take_till(1.., ['"', '\\']).void(), ('\\', any).void()));
    let pieces = repeat::<_, _, (), _, _>(0.., piece);
    delimited('"', pieces.take(), '"').parse_next(input)
}

/// Parses a value that is no list.
fn scalar<'t>(input: &mut &'t str) -> Parsed<Kind<'t>> {
    let word = name.verify_map(|word| match word {
        "undef" => Some(Kind::Undefined),
        "true" => Some(Kind::Truth(true)),
        "false" => Some(Kind::Truth(false)),
        _ => None,
    });
    alt((number.map(Kind::Number), text.map(Kind::Text), word)).parse_next(input)
}

/// Parses the name of an argument.
fn label<'t>(input: &mut &'t str) -> Parsed<&'t str> {
    terminated(name, preceded(space, '=')).parse_next(input)
}

/// Parses the modifiers before a call.
fn modifiers<'t>(input: &mut &'t str) -> Parsed<&'t str> {
    take_while(0.., ['%', '#', '*', '!']).parse_next(input)
}

/// A partly consumed text.
struct Reader<'t> {
    text: &'t str,
    rest: &'t str,
}

impl<'t> Reader<'t> {
    fn at(&self) -> usize {
        self.text.len() - self.rest.len()
    }

    /// Takes the text that `parser` accepts, and the space after it.
    fn take<O>(&mut self, parser: impl Parser<&'t str, O, EmptyError>) -> Option<O> {
        let mut rest = self.rest;
        let taken = terminated(parser, space).parse_next(&mut rest).ok()?;
        self.rest = rest;
        Some(taken)
    }

    fn expected(&self, what: &str) -> Error {
        let found = match self.rest.chars().next() {
            None => "the text ends here",
            Some('"') if text.parse_peek(self.rest).is_err() => "this text does not end",
            Some('/') if self.rest.starts_with("/*") => "this comment does not end",
            Some(_) => return fault(self.text, self.at(), format!("expected {what}")),
        };
        fault(self.text, self.at(), format!("{found}; expected {what}"))
    }

    fn expect<O>(&mut self, parser: impl Parser<&'t str, O, EmptyError>, what: &str) -> Result<O, Error> {
        self.take(parser).ok_or_else(|| self.expected(what))
    }
}

/// Returns the name of the first call, if the text begins with one.
pub(super) fn first_call(text: &str) -> Option<&str> {
    let rest = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
    let mut reader = Reader { text, rest };
    reader.take("");
    reader.take(modifiers);
    let name = reader.take(name)?;
    reader.take('(').map(|_| name)
}

/// A call whose block has begun.
struct Open {
    call: usize,
    /// True if the block is in braces, false if it is a single call.
    is_braced: bool,
}

/// Parses a whole text.
pub(super) fn parse(text: &str) -> Result<Tree<'_>, Error> {
    let rest = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
    let mut reader = Reader { text, rest };
    let mut tree = Tree { text, calls: Vec::new(), arguments: Vec::new(), values: Vec::new() };
    let mut open: Vec<Open> = Vec::new();
    reader.take("");
    loop {
        let is_braced = open.last().is_none_or(|block| block.is_braced);
        if is_braced && reader.take(';').is_some() {
            continue;
        }
        if reader.rest.is_empty() && open.is_empty() {
            return Ok(tree);
        }
        let is_ended = if is_braced && !open.is_empty() && reader.take('}').is_some() {
            true
        } else {
            let expected = match (open.is_empty(), is_braced) {
                (true, _) => "a call",
                (_, true) => "a call or `}`",
                (_, false) => "a call, `;` or `{`",
            };
            let call = tree.calls.len();
            head(&mut reader, &mut tree, expected)?;
            let is_braced = reader.take('{').is_some();
            let has_block = is_braced || reader.take(';').is_none();
            memory::push(&mut open, Open { call, is_braced })?;
            !has_block
        };
        if is_ended {
            // The block of the innermost call ends, and with it all surrounding blocks that consist of a
            // single call.
            let end = tree.calls.len();
            let mut ended = open.pop();
            while let Some(block) = ended {
                tree.calls[block.call].end = end;
                ended = open.pop_if(|block| !block.is_braced);
            }
        }
    }
}

/// Parses a call up to its closing parenthesis.
fn head<'t>(reader: &mut Reader<'t>, tree: &mut Tree<'t>, expected: &str) -> Result<(), Error> {
    let start = reader.at();
    let modifiers = reader.take(modifiers).unwrap_or_default();
    if let Some(position) = modifiers.find('!') {
        return Err(fault(reader.text, start + position, "the modifier `!` is not supported"));
    }
    let at = reader.at();
    let name = reader.expect(name, expected)?;
    reader.expect('(', "`(`")?;
    let first = tree.arguments.len();
    while reader.take(')').is_none() {
        let at = reader.at();
        let label = reader.take(label);
        let value = tree.values.len();
        memory::push(&mut tree.arguments, Argument { at, name: label, value })?;
        values(reader, &mut tree.values)?;
        if reader.take(',').is_none() && !reader.rest.starts_with(')') {
            return Err(reader.expected("`,` or `)`"));
        }
    }
    let (arguments, is_ignored) = (first..tree.arguments.len(), modifiers.contains(['%', '*']));
    memory::push(&mut tree.calls, Call { at, name, arguments, end: 0, is_ignored })
}

/// Parses a value with everything in it.
fn values<'t>(reader: &mut Reader<'t>, values: &mut Vec<Value<'t>>) -> Result<(), Error> {
    let mut lists: Vec<usize> = Vec::new();
    loop {
        let at = reader.at();
        if reader.take('[').is_some() {
            memory::push(&mut lists, values.len())?;
            memory::push(values, Value { at, kind: Kind::List(0) })?;
        } else {
            let kind = reader.expect(scalar, "a number, a list, a text in quotes, true, false or undef")?;
            memory::push(values, Value { at, kind })?;
        }
        // After a value: the ends of lists, or the next item of a list.
        let mut is_after_item = !matches!(values.last(), Some(Value { kind: Kind::List(0), .. }));
        loop {
            let Some(&list) = lists.last() else { return Ok(()) };
            let has_comma = is_after_item && reader.take(',').is_some();
            if reader.take(']').is_some() {
                values[list].kind = Kind::List(values.len());
                lists.pop();
                is_after_item = true;
            } else if is_after_item && !has_comma {
                return Err(reader.expected("`,` or `]`"));
            } else {
                break;
            }
        }
    }
}

impl Tree<'_> {
    /// Makes the error that something is wrong at a place.
    pub fn fault(&self, at: usize, problem: impl Into<String>) -> Error {
        fault(self.text, at, problem)
    }

    /// Returns the indices of the items of a list that ends before the value `end`.
    pub fn items(&self, list: usize, end: usize) -> impl Iterator<Item = usize> {
        core::iter::successors(Some(list + 1), |&item| {
            Some(match self.values.get(item)?.kind {
                Kind::List(end) => end,
                _ => item + 1,
            })
        })
        .take_while(move |&item| item < end)
    }
}
