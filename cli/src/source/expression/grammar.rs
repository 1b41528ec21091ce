//! The grammar of expressions, with the parsers of the crate `winnow`.
//!
//! A parser appends the steps that it has read to the program. No parser goes back behind a step: what
//! follows a sign, an operator or an opening parenthesis is an operand, or the expression is refused.

use super::SYNTAX;
use super::program::{Binary, Program, Step, Unary};
use winnow::ascii::{digit0, digit1, multispace0};
use winnow::combinator::{Infix, alt, dispatch, expression, fail, opt, preceded, terminated};
use winnow::error::{ErrMode, ParserError};
use winnow::stream::{Stateful, Stream};
use winnow::token::{any, one_of, take_while};
use winnow::{ModalResult, Parser};

/// Most parentheses around a number. Each takes a part of the machine's stack while it is parsed.
const NESTING: usize = 50;

/// The rest of a text, with what was read before it.
type Input<'t> = Stateful<&'t str, State>;

#[derive(Debug, Default)]
struct State {
    program: Program,
    /// Number of open parentheses.
    nesting: usize,
}

type Parsed<O> = ModalResult<O, Problem>;

#[derive(Debug)]
struct Problem {
    /// Length of the text from the place of the problem on.
    rest: usize,
    what: String,
}

impl ParserError<Input<'_>> for Problem {
    type Inner = Problem;

    fn from_input(input: &Input<'_>) -> Problem {
        Problem { rest: input.eof_offset(), what: String::new() }
    }

    fn into_inner(self) -> Result<Problem, Problem> {
        Ok(self)
    }
}

/// Makes the error that something is wrong where the last `rest` bytes begin.
fn wrong(rest: usize, what: impl Into<String>) -> ErrMode<Problem> {
    ErrMode::Cut(Problem { rest, what: what.into() })
}

const COMMA: &str = "a comma stands only between the two numbers of min and max: min(a,min(b,c))";

/// Parses a whole text.
pub fn parse(text: &str) -> Result<Program, String> {
    let mut input = Input { input: text, state: State::default() };
    let parsed = preceded(multispace0, sum).parse_next(&mut input).and_then(|()| match next(&input) {
        None => Ok(()),
        Some(')') => Err(wrong(input.eof_offset(), "no parenthesis is open here")),
        Some(',') => Err(wrong(input.eof_offset(), COMMA)),
        Some(_) => Err(wrong(input.eof_offset(), "expected an operator")),
    });
    match parsed {
        Ok(()) => Ok(input.state.program),
        Err(ErrMode::Cut(problem) | ErrMode::Backtrack(problem)) => {
            Err(told(text, text.len() - problem.rest, &problem.what))
        }
        Err(ErrMode::Incomplete(_)) => unreachable!("the text is complete"),
    }
}

/// Returns a message about the byte offset `at` of a text.
fn told(text: &str, at: usize, what: &str) -> String {
    /// Most characters that are shown.
    const SHOWN: usize = 60;
    let (before, length) = (text[..at].chars().count(), text.chars().count());
    let end = if at == text.len() { "the expression ends here: " } else { "" };
    let first = if length <= SHOWN { 0 } else { before.saturating_sub(SHOWN / 2) };
    let shown: String = text.chars().skip(first).take(SHOWN).collect();
    let [left, right] = [first > 0, first + SHOWN < length].map(|is_cut| if is_cut { "…" } else { "" });
    format!("\"{left}{shown}{right}\": at character {}: {end}{what}", before + 1)
}

fn next(input: &Input<'_>) -> Option<char> {
    input.input.chars().next()
}

fn push(input: &mut Input<'_>, step: Step) -> Parsed<()> {
    input.state.program.push(step);
    Ok(())
}

/// Parses operands with operators between them, and the space after them.
fn sum(input: &mut Input<'_>) -> Parsed<()> {
    expression(operand).infix(operator).parse_next(input)
}

fn operator<'t>(input: &mut Input<'t>) -> Parsed<Infix<Input<'t>, (), ErrMode<Problem>>> {
    use Infix::Left;
    let operator = dispatch! { any;
        '+' => Left(1, |input, (), ()| push(input, Step::Binary(Binary::Add))),
        '-' => Left(1, |input, (), ()| push(input, Step::Binary(Binary::Subtract))),
        '*' => Left(3, |input, (), ()| push(input, Step::Binary(Binary::Multiply))),
        '/' => Left(3, |input, (), ()| push(input, Step::Binary(Binary::Divide))),
        '^' => Left(5, |input, (), ()| push(input, Step::Binary(Binary::Power))),
        _ => fail,
    };
    terminated(operator, multispace0).parse_next(input)
}

/// Parses a number, a name, a call or an expression in parentheses, with the signs before it.
fn operand(input: &mut Input<'_>) -> Parsed<()> {
    let mut is_negative = false;
    while let Some(sign) = opt(one_of(['+', '-'])).parse_next(input)? {
        is_negative ^= sign == '-';
        multispace0.parse_next(input)?;
    }
    let place = input.eof_offset();
    if let Some(value) = opt(number).parse_next(input)? {
        push(input, Step::Number(value))?;
    } else if let Some(name) = opt(name).parse_next(input)? {
        match meaning(name) {
            None => return Err(wrong(place, format!("{name} is unknown. Known are {SYNTAX}"))),
            Some(step @ (Step::Number(_) | Step::Variable(_))) => push(input, step)?,
            Some(step) => {
                let count = if let Step::Binary(_) = step { 2 } else { 1 };
                multispace0.parse_next(input)?;
                arguments(input, name, count)?;
                push(input, step)?;
            }
        }
    } else if next(input) == Some('(') {
        arguments(input, "", 1)?;
    } else {
        return Err(wrong(place, "expected a number, a name or ("));
    }
    multispace0.parse_next(input)?;
    if is_negative { push(input, Step::Unary(Unary::Negate)) } else { Ok(()) }
}

fn number(input: &mut Input<'_>) -> Parsed<f64> {
    let digits = alt(((digit1, opt(('.', digit0))).void(), ('.', digit1).void()));
    let exponent = opt((one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1));
    (digits, exponent).take().verify_map(|text: &str| text.parse().ok()).parse_next(input)
}

fn name<'t>(input: &mut Input<'t>) -> Parsed<&'t str> {
    take_while(1.., |c: char| c.is_alphanumeric() || c == '_').parse_next(input)
}

fn meaning(name: &str) -> Option<Step> {
    Some(match name {
        "x" => Step::Variable(0),
        "y" => Step::Variable(1),
        "z" => Step::Variable(2),
        "pi" => Step::Number(std::f64::consts::PI),
        "e" => Step::Number(std::f64::consts::E),
        "abs" => Step::Unary(Unary::Abs),
        "sqrt" => Step::Unary(Unary::Sqrt),
        "exp" => Step::Unary(Unary::Exp),
        "ln" => Step::Unary(Unary::Ln),
        "sin" => Step::Unary(Unary::Sin),
        "cos" => Step::Unary(Unary::Cos),
        "floor" => Step::Unary(Unary::Floor),
        "ceil" => Step::Unary(Unary::Ceil),
        "round" => Step::Unary(Unary::Round),
        "min" => Step::Binary(Binary::Least),
        "max" => Step::Binary(Binary::Greatest),
        _ => return None,
    })
}

/// Parses parentheses with `count` expressions between them: the arguments of a function, or the one
/// expression of parentheses that belong to no function.
fn arguments(input: &mut Input<'_>, function: &str, count: usize) -> Parsed<()> {
    let usage = || match count {
        1 => format!("{function} takes one number: {function}(a)"),
        _ => format!("{function} takes two numbers: {function}(a,b)"),
    };
    let open = input.eof_offset();
    if opt('(').parse_next(input)?.is_none() {
        return Err(wrong(open, format!("expected (, as {}", usage())));
    }
    input.state.nesting += 1;
    if input.state.nesting > NESTING {
        return Err(wrong(open, format!("more than {NESTING} parentheses are open")));
    }
    multispace0.parse_next(input)?;
    for k in 1..=count {
        sum(input)?;
        let place = input.eof_offset();
        let end = if k == count { ')' } else { ',' };
        match next(input) {
            Some(c) if c == end => {}
            None => return Err(wrong(open, "this parenthesis is not closed")),
            Some(',') if function.is_empty() => return Err(wrong(place, COMMA)),
            Some(',' | ')') => return Err(wrong(place, usage())),
            Some(_) => return Err(wrong(place, "expected an operator")),
        }
        (any, multispace0).parse_next(input)?;
    }
    input.state.nesting -= 1;
    Ok(())
}
