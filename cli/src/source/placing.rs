//! Placements: the maps that move inputs.

use crate::failure::Failure;
use crate::source::input::Input;
use clap::error::ErrorKind;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};
use leafless::{Affine, Error, Frame, TriangleMesh};
use std::path::Path;

/// An option that moves the input.
struct Move {
    name: &'static str,
    value: &'static str,
    help: &'static str,
    map: fn(&str) -> Result<Affine, String>,
}

/// All options that move the input.
const MOVES: [Move; 4] = [
    Move {
        name: "translate",
        value: "X,Y,Z",
        help: "Move the input by this much along x, y and z, in model units. The moves --translate, --rotate, --scale and \
               --place may be given several times, and act one after another in the order of the command line",
        map: translation,
    },
    Move {
        name: "rotate",
        value: "AXIS,DEGREES",
        help: "Rotate the input about an axis through the origin, counter-clockwise as seen from the axis's tip: x, y or z, or \
               the three numbers of a direction, and an angle in degrees: z,30 or 1,1,0,30. Quarter turns about x, y and z are exact",
        map: rotation,
    },
    Move {
        name: "scale",
        value: "S|SX,SY,SZ",
        help: "Scale the input about the origin by one factor, or by one for each axis; negative factors \
               mirror it",
        map: scaling,
    },
    Move {
        name: "place",
        value: "MATRIX",
        help: "Move the input by the matrix [M | t]: its rows, 12 numbers, or 16 with a last row 0 0 0 1, with or without \
               brackets. M may rotate, stretch, shear and mirror",
        map: matrix,
    },
];

/// A placement: the options that move the input, in their order on the command line.
#[derive(Debug, Clone, Copy, Default)]
pub struct Placing {
    map: Option<Affine>,
    /// Name of the first option.
    option: &'static str,
}

/// A move, and its place on the command line.
pub struct Step {
    pub index: usize,
    pub option: &'static str,
    map: Affine,
}

impl Step {
    /// Returns all moves, in their order on the command line.
    pub fn all(matches: &ArgMatches) -> Vec<Step> {
        let mut steps = Vec::new();
        for Move { name, .. } in MOVES {
            let maps = matches.get_many::<Affine>(name).into_iter().flatten();
            let indices = matches.indices_of(name).into_iter().flatten();
            steps.extend(indices.zip(maps).map(|(index, &map)| Step { index, option: name, map }));
        }
        steps.sort_by_key(|step| step.index);
        steps
    }
}

impl Placing {
    /// Appends a move to this placement.
    pub fn then(self, step: &Step) -> Result<Placing, clap::Error> {
        let (map, option) = match &self.map {
            None => (step.map, step.option),
            Some(before) => {
                let map = after(&step.map, before).map_err(|error| {
                    let problem = format!("--{}: together with the moves before it, {error}", step.option);
                    clap::Error::raw(ErrorKind::ValueValidation, problem)
                })?;
                (map, self.option)
            }
        };
        Ok(Placing { map: Some(map), option })
    }

    /// Returns the map, if anything is to be moved.
    pub fn map(&self) -> Option<&Affine> {
        self.map.as_ref()
    }

    /// Returns the factor, if the placement consists of a positive factor only.
    pub fn factor(&self) -> Option<f64> {
        let rows = self.map?.rows().map(|row| row);
        let factor = rows[0][0];
        let same = |i: usize, j: usize| rows[i][j] == if i == j { factor } else { 0.0 };
        (factor > 0.0 && (0..12).all(|k| same(k / 4, k % 4))).then_some(factor)
    }

    /// Returns the mesh under the map.
    pub fn mesh(&self, mesh: TriangleMesh) -> Result<TriangleMesh, Error> {
        match &self.map {
            Some(map) => mesh.placed(map),
            None => Ok(mesh),
        }
    }

    /// Refuses to move a file; `why` is the reason.
    pub fn refuse(&self, input: &Input, why: &str) -> Result<(), Failure> {
        match self.map {
            Some(_) => Err(Failure::Usage(format!("--{} does not move {input}: {why}", self.option))),
            None => Ok(()),
        }
    }
}

impl Args for Placing {
    fn augment_args(command: Command) -> Command {
        command.args(MOVES.map(|Move { name, value, help, map }| {
            let argument = Arg::new(name).long(name).value_name(value).help(help);
            argument
                .help_heading("Units and placement")
                .action(ArgAction::Append)
                .allow_hyphen_values(true)
                .value_parser(map)
        }))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Placing::augment_args(command)
    }
}

impl FromArgMatches for Placing {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Placing, clap::Error> {
        Step::all(matches).iter().try_fold(Placing::default(), Placing::then)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Placing::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Returns the map that moves by `inner`, then by `outer`.
pub fn after(outer: &Affine, inner: &Affine) -> Result<Affine, Error> {
    tidied(outer.rows().map(|[x, y, z, t]| {
        let mut sums = [0, 1, 2, 3].map(|j| {
            let [a, b, c] = inner.rows().map(|row| row[j]);
            (x * a + y * b) + z * c
        });
        sums[3] += t;
        sums
    }))
}

/// Returns the map with these computed rows. Entries that are too small for a map are rounding errors of
/// zero.
fn tidied(rows: [[f64; 4]; 3]) -> Result<Affine, Error> {
    let least = 2f64.powi(-64);
    Affine::new(rows.map(|row| row.map(|c| if c.abs() < least { 0.0 } else { c })))
}

/// Returns the image of a cube and its cells, if the image is a cube along the axes, too.
pub fn image(frame: &Frame, map: &Affine) -> Option<Frame> {
    let factor = map.rows()[0][..3].iter().map(|c| c.abs()).sum::<f64>();
    let mut origin = [0.0; 3];
    for (low, row) in origin.iter_mut().zip(map.rows()) {
        let mut entries = (0..3).filter(|&axis| row[axis] != 0.0);
        let axis = entries.next()?;
        if entries.next().is_some() || row[axis].abs() != factor {
            return None;
        }
        let end = if row[axis] < 0.0 { frame.edge() } else { 0.0 };
        *low = row[axis] * (frame.origin()[axis] + end) + row[3];
    }
    Frame::new(origin, factor * frame.edge(), frame.depth()).ok()
}

/// Parses finite numbers between commas, blanks or brackets.
fn numbers(text: &str) -> Option<Vec<f64>> {
    let words = text.split(|c: char| c.is_whitespace() || "[],;".contains(c)).filter(|word| !word.is_empty());
    words.map(|word| word.parse().ok().filter(|number: &f64| number.is_finite())).collect()
}

fn told(map: Result<Affine, Error>) -> Result<Affine, String> {
    map.map_err(|error| error.to_string())
}

fn translation(text: &str) -> Result<Affine, String> {
    match numbers(text).as_deref() {
        Some(&[x, y, z]) => told(Affine::translation([x, y, z])),
        _ => Err("expected three numbers: x,y,z".into()),
    }
}

fn scaling(text: &str) -> Result<Affine, String> {
    let factors = match numbers(text).as_deref() {
        Some(&[factor]) => [factor; 3],
        Some(&[x, y, z]) => [x, y, z],
        _ => [0.0; 3],
    };
    if factors.contains(&0.0) {
        return Err("expected a factor, or three: sx,sy,sz; none of them is 0".into());
    }
    let [x, y, z] = factors;
    told(Affine::new([[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0]]))
}

fn rotation(text: &str) -> Result<Affine, String> {
    let (name, rest) = text.trim_start().split_once(',').unwrap_or((text, ""));
    let named = ["x", "y", "z"].iter().position(|axis| name.trim().eq_ignore_ascii_case(axis));
    let (axis, degrees) = match (named, numbers(if named.is_some() { rest } else { text }).as_deref()) {
        (Some(axis), Some(&[degrees])) => ([0, 1, 2].map(|k| if k == axis { 1.0 } else { 0.0 }), degrees),
        (None, Some(&[x, y, z, degrees])) if [x, y, z] != [0.0; 3] => ([x, y, z], degrees),
        _ => {
            return Err(
                "expected an axis, x, y, z or a direction that is not 0,0,0, and degrees: z,30 or 1,1,0,30"
                    .into(),
            );
        }
    };
    let longest = axis.iter().fold(0f64, |longest, c| longest.max(c.abs()));
    let axis = axis.map(|c| c / longest);
    let length = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
    let [x, y, z] = axis.map(|c| c / length);
    let (sin, cos) = sine_and_cosine(degrees);
    let rest = 1.0 - cos;
    told(tidied([
        [cos + rest * x * x, rest * x * y - sin * z, rest * x * z + sin * y, 0.0],
        [rest * x * y + sin * z, cos + rest * y * y, rest * y * z - sin * x, 0.0],
        [rest * x * z - sin * y, rest * y * z + sin * x, cos + rest * z * z, 0.0],
    ]))
}

/// Returns sine and cosine of an angle; those of quarter turns are whole numbers.
fn sine_and_cosine(degrees: f64) -> (f64, f64) {
    // Remainders are exact.
    let turned = degrees % 360.0;
    let quarters = (turned / 90.0).round();
    let (sin, cos) = libm::sincos((turned - 90.0 * quarters).to_radians());
    match (quarters as i32).rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

pub fn matrix(text: &str) -> Result<Affine, String> {
    let numbers = numbers(text);
    let m = match numbers.as_deref() {
        Some(m @ [.., a, b, c, d]) if m.len() == 16 && [*a, *b, *c, *d] == [0.0, 0.0, 0.0, 1.0] => &m[..12],
        Some(m) if m.len() == 12 => m,
        _ => return Err("expected 12 numbers, the rows of [M | t], or 16 with a last row 0 0 0 1".into()),
    };
    let row = |i: usize| [m[4 * i], m[4 * i + 1], m[4 * i + 2], m[4 * i + 3]];
    told(Affine::new([row(0), row(1), row(2)]))
}

/// Reads the placements in a file: one line for each, as --place takes it. Empty lines and lines that begin
/// with # are skipped.
pub fn from_file(path: &Path, first: &Affine) -> Result<Vec<Affine>, Failure> {
    let input = Input::Path(path.into());
    let of_file = |problem: String| Failure::of(&input, problem);
    let text = String::from_utf8(input.read()?).map_err(|_| of_file("is no text".into()))?;
    let mut placements = Vec::new();
    for (line, text) in (1..).zip(text.lines()) {
        let text = text.trim();
        if text.is_empty() || text.starts_with('#') {
            continue;
        }
        let placement = matrix(text).map_err(|problem| of_file(format!("line {line}: {problem}")))?;
        let whole = after(&placement, first).map_err(|error| of_file(format!("line {line}: {error}")))?;
        placements.push(whole);
    }
    Ok(placements)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        for (text, image) in [
            ("z,90", [-2.0, 1.0, 3.0]),
            ("Z, -270", [-2.0, 1.0, 3.0]),
            ("0,0,2,90", [-2.0, 1.0, 3.0]),
            ("0 0 -1 270", [-2.0, 1.0, 3.0]),
            ("x,90", [1.0, -3.0, 2.0]),
            ("y,90", [3.0, 2.0, -1.0]),
            ("y,180", [-1.0, 2.0, -3.0]),
            ("x,36000000000360", [1.0, 2.0, 3.0]),
        ] {
            let map = rotation(text).unwrap();
            assert_eq!(map.apply([1.0, 2.0, 3.0]), image, "{text}");
            assert!(map.rows().iter().flatten().all(|c| [-1.0, 0.0, 1.0].contains(c)), "{map:?}");
        }
    }

    #[test]
    fn turns_keep_lengths() {
        for text in ["z,30", "1,1,0,30", "1e-200,0,1e-200,77", "-3,2,1e5,-1000", "x,0.001"] {
            let [x, y, z] = *rotation(text).unwrap().rows();
            let dot = |a: [f64; 4], b: [f64; 4]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
            let off = [dot(x, x) - 1.0, dot(y, y) - 1.0, dot(z, z) - 1.0, dot(x, y), dot(x, z), dot(y, z)];
            assert!(off.iter().all(|off| off.abs() < 1e-15), "{text}: {off:?}");
        }
        // A third of a turn about the diagonal goes round the axes.
        let [x, y, z] = rotation("1,1,1,120").unwrap().apply([1.0, 2.0, 3.0]);
        assert!((x - 3.0).abs() + (y - 1.0).abs() + (z - 2.0).abs() < 1e-14, "{x} {y} {z}");
    }

    #[test]
    fn what_is_no_move_is_refused() {
        for (map, texts) in [
            (
                translation as fn(&str) -> _,
                &["", "1,2", "1,2,3,4", "1,2,nan", "inf,0,0", "1,2,1e30", "a,b,c"][..],
            ),
            (scaling, &["", "0", "1,0,1", "1,2", "nan", "inf", "1e300", "x"]),
            (rotation, &["", "z", "30", "z,", "z,nan", "w,30", "0,0,0,30", "1,2,3", "z,1,2", "1,0,0,inf"]),
            (matrix, &["", "1 0 0 0 0 1 0 0 0 0 0 0", "1 0 0 0 0 1 0 0 0 0 1 nan", "1,0,0,0,0,1,0,0,0,0,1"]),
        ] {
            for text in texts {
                assert!(map(text).is_err(), "{text}");
            }
        }
        assert!(matrix("1 0 0 0, 0 1 0 0, 0 0 1 0, 0 0 1 1").unwrap_err().contains("0 0 0 1"));
        assert!(matrix("1 0 0 0, 0 1 0 0, 1 1 0 0").unwrap_err().contains("singular"));
    }

    #[test]
    fn cubes_have_cubes_as_images() {
        let frame = Frame::new([1.0, 2.0, 3.0], 4.0, 5).unwrap();
        let turned = after(&translation("10,0,0").unwrap(), &rotation("z,90").unwrap()).unwrap();
        assert_eq!(image(&frame, &turned), Frame::new([4.0, 1.0, 3.0], 4.0, 5).ok());
        assert_eq!(image(&frame, &scaling("-2").unwrap()), Frame::new([-10.0, -12.0, -14.0], 8.0, 5).ok());
        assert_eq!(image(&frame, &scaling("1,1,2").unwrap()), None);
        assert_eq!(image(&frame, &rotation("z,30").unwrap()), None);
    }

    #[test]
    fn matrices_as_people_write_them() {
        let expected = Affine::translation([1.0, -2.5, 3.0]).unwrap();
        for text in [
            "1,0,0,1,0,1,0,-2.5,0,0,1,3",
            "1 0 0 1  0 1 0 -2.5  0 0 1 3",
            "[[1, 0, 0, 1], [0, 1, 0, -2.5], [0, 0, 1, 3], [0, 0, 0, 1]]",
        ] {
            assert_eq!(matrix(text), Ok(expected));
        }
        for text in [
            "",
            "1 2 3",
            "1 0 0 1 0 1 0 0 0 0 1 x",
            "1 0 0 0 1 0 0 0 0 0 1 0",
            "1 0 0 1 0 1 0 1 0 0 1 1 0 0 0 2",
        ] {
            assert!(matrix(text).is_err(), "{text}");
        }
    }
}
