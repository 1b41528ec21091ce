//! Planes and quadrics in numbers that are rounded outward, and the detection of balls and cylinders among
//! them.

use super::map::ExactMap;
use super::quadric::substitute;
use super::{PlacedHalfSpace, Surface};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::Dyadic;
use crate::lattice::{Frame, Interval, axes};

/// A surface whose points all have nearly the same distance from a point or a line: a ball or a cylinder
/// around its *core*.
///
/// # Law
/// Let x be a point of the universe. If x lies on the near side of the surface, the square of its distance
/// from the core is at most `square.upper`. If it lies on the far side, that square is at least
/// `square.lower`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Round {
    /// The centre of the ball, or a point of the axis: in finest cells from the universe's lower corner.
    pub(crate) core: [f64; 3],
    /// The direction of the axis, of any length; `None` for a ball.
    pub(crate) axis: Option<[f64; 3]>,
    /// The square of the radius, in squares of finest cells.
    pub(crate) square: Interval,
    /// Whether the function of the half-space is positive on the near side.
    pub(crate) is_near_positive: bool,
}

/// The required relative precision of the square of a radius.
const KNOWN: f64 = 1e-9;

/// The greatest relative deviation of coefficients from those of a ball or a cylinder, before anything is
/// proven.
const ALIKE: f64 = 1e-9;

/// A plane or a quadric on the universe of a frame, in numbers that are rounded outward.
#[derive(Debug, Clone)]
pub(crate) struct Form {
    /// The coefficients of x², y², z², xy, yz, zx, x, y, z and 1, in unit coordinates: the universe is [0,
    /// 1]³.
    coefficients: [Interval; 10],
    /// The ball or the cylinder, if the surface is one.
    pub(crate) round: Option<Round>,
}

impl Form {
    /// Returns the value at a point in unit coordinates: positive inside the half-space.
    pub(crate) fn value(&self, at: &[Interval; 3]) -> Interval {
        let c = &self.coefficients;
        let mut sum = c[9];
        for i in 0..3 {
            let next = (i + 1) % 3;
            sum = sum.plus(c[i].times(at[i].square()));
            sum = sum.plus(c[3 + i].times(at[i].times(at[next])));
            sum = sum.plus(c[6 + i].times(at[i]));
        }
        sum
    }

    /// Returns the value and the gradient at a point in unit coordinates, with rounding errors.
    pub(crate) fn about(&self, at: [f64; 3]) -> (f64, [f64; 3]) {
        let c = self.coefficients.each(|c| 0.5 * (c.lower + c.upper));
        let mut gradient = [c[6], c[7], c[8]];
        let mut value = c[9];
        for i in 0..3 {
            let next = (i + 1) % 3;
            gradient[i] += 2.0 * c[i] * at[i] + c[3 + i] * at[next];
            gradient[next] += c[3 + i] * at[i];
            value += (c[i] * at[i] + c[3 + i] * at[next] + c[6 + i]) * at[i];
        }
        (value, gradient)
    }
}

impl Form {
    /// Returns the matrix of second derivatives, with rounding errors.
    pub(crate) fn second(&self) -> [[f64; 3]; 3] {
        let [xx, yy, zz, xy, yz, zx, ..] = self.coefficients.each(|c| 0.5 * (c.lower + c.upper));
        [[2.0 * xx, xy, zx], [xy, 2.0 * yy, yz], [zx, yz, 2.0 * zz]]
    }
}

impl PlacedHalfSpace {
    /// Returns the plane or the quadric as a form on the universe of a frame; `None` for other surfaces.
    ///
    /// # Errors
    /// [`Error::Limit`] if exact numbers of placements become too long.
    pub(crate) fn form(&self, frame: &Frame) -> Result<Option<Form>, Error> {
        let map = || self.map(ExactMap::from_universe(frame));
        let (coefficients, round) = match &*self.half_space.0 {
            Surface::Plane(plane) => {
                let map = map()?;
                let is_turned = map.w.sign() < 0;
                let linear = map.linear(plane);
                let mut coefficients = [Interval::exactly(0.0); 10];
                for (c, exact) in coefficients[6..].iter_mut().zip(&linear) {
                    let c_of = interval(exact);
                    *c = if is_turned { c_of.negated() } else { c_of };
                }
                (coefficients, None)
            }
            Surface::Quadric(quadric) => {
                let coefficients = substitute(quadric, &map()?).each_ref().each(interval);
                let round = of_quadric(&coefficients, frame);
                (coefficients, round)
            }
            _ => return Ok(None),
        };
        let is_usable = coefficients.iter().all(|c| c.lower.abs() < 1e200 && c.upper.abs() < 1e200);
        Ok(is_usable.then_some(Form { coefficients, round }))
    }
}

fn interval(exact: &Dyadic) -> Interval {
    match exact.exactly() {
        Some(value) => Interval::exactly(value),
        None => {
            let about = exact.rounded();
            Interval::exactly(about.next_down().next_down())
                .joined(Interval::exactly(about.next_up().next_up()))
        }
    }
}

/// Returns the ball or the cylinder that a polynomial of degree two in unit coordinates bounds.
fn of_quadric(c: &[Interval; 10], frame: &Frame) -> Option<Round> {
    let about = c.each(|c| 0.5 * (c.lower + c.upper));
    let [xx, yy, zz, xy, yz, zx, ..] = about;
    let matrix = [[xx, 0.5 * xy, 0.5 * zx], [0.5 * xy, yy, 0.5 * yz], [0.5 * zx, 0.5 * yz, zz]];
    let trace = xx + yy + zz;
    // (NaN does not compare as greater.)
    let is_usable = trace.abs() > 1e-200 && trace.abs() < 1e200 && about.iter().all(|c| c.abs() < 1e200);
    if !is_usable {
        return None;
    }
    let is_near = |scale: f64, wanted: [[f64; 3]; 3]| {
        (0..3).all(|i| (0..3).all(|j| (matrix[i][j] / scale - wanted[i][j]).abs() <= ALIKE))
    };
    let unit = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
    let (scale, axis) = if is_near(trace / 3.0, axes(|i| axes(|j| unit(i, j)))) {
        (trace / 3.0, None)
    } else {
        let scale = 0.5 * trace;
        let along = axes(|i| axes(|j| unit(i, j) - matrix[i][j] / scale));
        let longest = (0..3).max_by(|&i, &j| along[i][i].total_cmp(&along[j][j]))?;
        let axis = along[longest];
        let square: f64 = axis.iter().map(|c| c * c).sum();
        if !(0.1..10.0).contains(&square)
            || !is_near(scale, axes(|i| axes(|j| unit(i, j) - axis[i] * axis[j] / square)))
        {
            return None;
        }
        (scale, Some(axis))
    };
    // The projection onto the plane across the axis: the gradient there vanishes at the core.
    let exactly = Interval::exactly;
    let across: [[Interval; 3]; 3] = axes(|i| {
        axes(|j| match axis {
            None => exactly(unit(i, j)),
            Some(axis) => {
                let square = axis.iter().fold(exactly(0.0), |sum, &c| sum.plus(exactly(c).square()));
                exactly(unit(i, j)).minus(exactly(axis[i]).times(exactly(axis[j])).over(square))
            }
        })
    });
    let linear = [about[6], about[7], about[8]];
    let core =
        axes(|i| (0..3).map(|j| 0.5 * (across[i][j].lower + across[i][j].upper) * linear[j]).sum::<f64>())
            .each(|c| -c / (2.0 * scale));
    if !core.iter().all(|c| c.abs() < 1e100) {
        return None;
    }
    // f / scale − |x − core|² across the axis, over the universe: a constant up to rounding.
    let over = |c: Interval| {
        if scale > 0.0 { c.over(exactly(scale)) } else { c.negated().over(exactly(-scale)) }
    };
    let places = Interval::exactly(0.0).joined(Interval::exactly(1.0));
    let moved: [Interval; 3] =
        axes(|i| (0..3).fold(exactly(0.0), |sum, j| sum.plus(across[i][j].times(exactly(core[j])))));
    let mut rest = over(c[9]);
    for i in 0..3 {
        rest = rest.minus(moved[i].times(exactly(core[i])));
        rest = rest.plus(over(c[i]).minus(across[i][i]).times(places));
        rest = rest.plus(over(c[6 + i]).plus(moved[i].times(exactly(2.0))).times(places));
        let next = (i + 1) % 3;
        rest = rest.plus(over(c[3 + i]).minus(across[i][next].times(exactly(2.0))).times(places));
    }
    let square = rest.negated();
    let is_known = square.lower > 0.0 && square.width() <= KNOWN * square.lower;
    if !is_known {
        return None;
    }
    let cells = f64::from(frame.cells());
    Some(Round {
        core: core.each(|c| c * cells),
        axis,
        square: square.times(exactly(cells * cells)),
        is_near_positive: scale < 0.0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Affine;
    use crate::solid::HalfSpace;
    use alloc::sync::Arc;

    fn of(coefficients: [f64; 10], placements: &[Affine]) -> Option<Round> {
        let half_space = HalfSpace::quadric(coefficients).unwrap();
        let placed = PlacedHalfSpace { half_space, placements: Arc::from(placements) };
        placed.form(&Frame::new([-8.0; 3], 16.0, 4).unwrap()).unwrap().and_then(|form| form.round)
    }

    #[test]
    fn balls_and_cylinders_are_known_in_any_place() {
        let turn =
            Affine::new([[0.36, 0.48, -0.8, 1.0], [-0.8, 0.6, 0.0, 0.5], [0.48, 0.64, 0.6, 0.0]]).unwrap();
        let ball = [-1.0, -1.0, -1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 3.0];
        let rod = [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0];
        for placements in [&[][..], &[turn], &[turn, turn]] {
            let found = of(ball, placements).unwrap();
            assert!(found.is_near_positive && found.axis.is_none());
            assert!((found.square.lower - 4.0).abs() < 1e-8 && found.square.width() < 1e-8, "{found:?}");
            let found = of(rod, placements).unwrap();
            assert!(!found.is_near_positive && found.axis.is_some());
            assert!((found.square.lower - 4.0).abs() < 1e-8 && found.square.width() < 1e-8, "{found:?}");
        }
        assert_eq!(of(ball, &[]).unwrap().core, [9.0, 8.0, 8.0]);
        assert!(of([-1.0, -1.1, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0], &[]).is_none());
        assert!(of([-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0], &[]).is_none());
    }
}
