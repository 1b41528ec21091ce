//! Calls that move their blocks: matrices, and the corresponding calls of OpenSCAD's own language.

use crate::lattice::Each;
use alloc::format;

use super::Node;
use super::arguments::{Given, Item};
use super::check::{Checker, Shape};
use super::grammar::Call;
use crate::error::Error;
use crate::lattice::Affine;
use crate::solid::{Csg, cos_degrees, sin_degrees};

/// The rows of [M | t].
type Rows = [[f64; 4]; 3];

impl Checker<'_> {
    pub(super) fn multmatrix(&mut self, call: &Call<'_>, first: usize) -> Result<Shape, Error> {
        let given = Given::new(self.tree, call, ["m"], &[])?;
        let matrix = given.required(0)?;
        let rows = matrix.list::<4>()?;
        let mut m = [[0.0; 4]; 4];
        for (row, item) in m.iter_mut().zip(rows) {
            *row = item.numbers()?;
        }
        if m[3] != [0.0, 0.0, 0.0, 1.0] {
            return Err(rows[3].fault("the last row must be [0, 0, 0, 1]"));
        }
        let [x, y, z, _] = m;
        self.moved(&matrix, [x, y, z], first)
    }

    pub(super) fn translate(&mut self, call: &Call<'_>, first: usize) -> Result<Shape, Error> {
        let vector = Given::new(self.tree, call, ["v"], &[])?.required(0)?;
        let [x, y, z] = components(&vector, 0.0)?;
        self.moved(&vector, [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z]], first)
    }

    pub(super) fn scale(&mut self, call: &Call<'_>, first: usize) -> Result<Shape, Error> {
        let factors = Given::new(self.tree, call, ["v"], &[])?.required(0)?;
        let scale = if factors.is_list() { components(&factors, 1.0)? } else { [factors.number()?; 3] };
        self.moved(
            &factors,
            linear([0, 1, 2].each(|i| [0, 1, 2].each(|j| if i == j { scale[i] } else { 0.0 }))),
            first,
        )
    }

    /// Returns the mirror image in the plane through the origin that is normal to a vector; the zero vector
    /// mirrors nothing.
    pub(super) fn mirror(&mut self, call: &Call<'_>, first: usize) -> Result<Shape, Error> {
        let normal = Given::new(self.tree, call, ["v"], &[])?.required(0)?;
        let n = components(&normal, 0.0)?;
        let longest = n.iter().fold(0.0, |longest: f64, c| longest.max(c.abs()));
        // The division is last in each entry, so that planes of two equal axes swap these exactly.
        let n = n.each(|c| if longest > 0.0 { c / longest } else { 0.0 });
        let square = n.iter().map(|c| c * c).sum::<f64>().max(f64::MIN_POSITIVE);
        let entry = |i: usize, j: usize| f64::from(u8::from(i == j)) - 2.0 * (n[i] * n[j]) / square;
        self.moved(&normal, linear([0, 1, 2].each(|i| [0, 1, 2].each(|j| entry(i, j)))), first)
    }

    /// Rotates by an angle about an axis, which is z by default; or about x, then y, then z, each by its own
    /// angle.
    pub(super) fn rotate(&mut self, call: &Call<'_>, first: usize) -> Result<Shape, Error> {
        let given = Given::new(self.tree, call, ["a", "v"], &[])?;
        let angle = given.required(0)?;
        let turn = if angle.is_list() {
            let [x, y, z] = components(&angle, 0.0)?;
            let about_x_and_y = product(about([0.0, 1.0, 0.0], y), about([1.0, 0.0, 0.0], x));
            product(about([0.0, 0.0, 1.0], z), about_x_and_y)
        } else {
            let axis = given.optional(1).map_or(Ok([0.0, 0.0, 1.0]), |item| item.numbers::<3>())?;
            about(axis, angle.number()?)
        };
        self.moved(&angle, linear(turn), first)
    }

    /// Returns the block moved by a map that the `argument` describes.
    fn moved(&mut self, argument: &Item<'_>, [x, y, z]: Rows, first: usize) -> Result<Shape, Error> {
        match self.union(first)? {
            Shape::Nothing => Ok(Shape::Nothing),
            Shape::Figure(figure) => {
                // For a figure only the map within its plane counts.
                let rows = [[x[0], x[1], x[3]], [y[0], y[1], y[3]]];
                figure.placed(rows).map(Shape::from).map_err(|error| argument.fault(format!("{error}")))
            }
            Shape::Solid(node) => match Affine::new([x, y, z]) {
                Ok(placement) if placement.is_identity() => Ok(Shape::Solid(node)),
                Ok(placement) => self.node(Node::Placed(node, placement)),
                // A solid that is flattened is empty.
                Err(_) if is_singular([x, y, z]) => self.node(Node::Solid(Csg::empty())),
                Err(error) => Err(argument.fault(format!("{error}"))),
            },
        }
    }
}

/// Returns whether a matrix of finite numbers maps space onto a plane, a line or a point.
fn is_singular(rows: Rows) -> bool {
    matches!(Affine::new(rows), Err(Error::Argument { problem: Affine::SINGULAR, .. }))
}

/// Returns a vector of three numbers, or of two in the plane; `rest` is then the third one.
fn components(vector: &Item<'_>, rest: f64) -> Result<[f64; 3], Error> {
    if vector.items()?.count() == 2 {
        let [x, y] = vector.numbers()?;
        return Ok([x, y, rest]);
    }
    vector.numbers()
}

/// Returns a map that keeps the origin fixed.
fn linear(matrix: [[f64; 3]; 3]) -> Rows {
    matrix.each(|[x, y, z]| [x, y, z, 0.0])
}

/// Returns the rotation about an axis through the origin; the zero vector as an axis rotates nothing.
fn about(axis: [f64; 3], degrees: f64) -> [[f64; 3]; 3] {
    let longest = axis.iter().fold(0.0, |longest: f64, c| longest.max(c.abs()));
    let [x, y, z] = axis.each(|c| if longest > 0.0 { c / longest } else { 0.0 });
    let length = libm::sqrt(x * x + y * y + z * z);
    if length == 0.0 {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    }
    let [x, y, z] = [x / length, y / length, z / length];
    let (sin, cos) = (sin_degrees(degrees), cos_degrees(degrees));
    let rest = 1.0 - cos;
    [
        [cos + rest * x * x, rest * x * y - sin * z, rest * x * z + sin * y],
        [rest * x * y + sin * z, cos + rest * y * y, rest * y * z - sin * x],
        [rest * x * z - sin * y, rest * y * z + sin * x, cos + rest * z * z],
    ]
}

fn product(a: [[f64; 3]; 3], b: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    a.each(|row| [0, 1, 2].each(|j| row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j]))
}
