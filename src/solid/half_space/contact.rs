//! Planes and quadrics that touch: exact numbers decide where bounds over cells never can.
//!
//! Suppose two polynomials of degree two are positive together at no point. Then a positive multiple of the
//! one, added to the other, is nowhere positive ([`pencil`]). This decides balls, ellipsoids, cylinders and
//! cones beside or inside each other, and all of these on planes. An affine map of both does not matter,
//! since it keeps the signs of all values.
//!
//! A quadric of two sheets on both sides of a plane, such as the two nappes of a cone with a ruling in the
//! plane, has no such factor: one sheet is positive together with the plane. Then there may be a linear
//! function ℓ such that f + ℓ g is nowhere positive. Where ℓ is not negative, f and g are not positive
//! together. That holds in cells on one side of the cone's apex. For a cone that ends at its apex, it holds
//! wherever its base's function is positive.

use super::bounds::{centre, half_edge};
use super::linear;
use super::map::ExactMap;
use super::pencil::{self, Form};
use super::quadric::{Coefficients, place, substitute};
use super::{PlacedHalfSpace, Surface};
use crate::error::Error;
use crate::lattice::Each;
use crate::lattice::exact::Dyadic;
use crate::lattice::{Cell, Frame, axes};
use alloc::boxed::Box;
use core::array::from_fn;

/// The four coefficients of a linear function, in unit coordinates.
type Linear = [Dyadic; 4];

/// The combinations of signs that two functions exclude.
#[derive(Debug)]
pub(crate) enum Contact {
    /// Nothing is known.
    Unknown,
    /// A combination of signs that occurs at no point: whether the first and the second function are
    /// negative.
    Excluded(bool, bool),
    /// The quadric has points on both sides of a plane, but none in the plane.
    Sheets(Box<Sheets>),
}

/// A quadric with no inner point in a plane.
#[derive(Debug)]
pub(crate) struct Sheets {
    /// Whether the plane is the second of the two surfaces.
    is_plane_second: bool,
    /// Whether the quadric's function is negative on its inner side.
    is_inside_negative: bool,
    /// Twice the matrix of the quadric's function, with the sign that is positive inside.
    form: Form,
    plane: Linear,
    /// Where this function is not negative, no inner point has a positive plane function. Where it is not
    /// positive, no inner point has a negative plane function.
    factor: Linear,
}

impl Contact {
    pub(crate) fn heap_bytes(&self) -> usize {
        let Contact::Sheets(sheets) = self else { return 0 };
        let numbers = sheets.form.as_flattened().iter().chain(&sheets.plane).chain(&sheets.factor);
        size_of::<Sheets>() + numbers.map(Dyadic::heap_bytes).sum::<usize>()
    }
}

impl PlacedHalfSpace {
    /// Returns the signs that two functions exclude in the universe of a frame. Only planes and quadrics are
    /// compared.
    ///
    /// # Errors
    /// [`Error::Limit`] if exact numbers of placements become too long.
    pub(crate) fn contact(&self, other: &PlacedHalfSpace, frame: &Frame) -> Result<Contact, Error> {
        let is_known = |surface: &Surface| matches!(surface, Surface::Plane(_) | Surface::Quadric(_));
        if !is_known(&self.half_space.0) || !is_known(&other.half_space.0) {
            return Ok(Contact::Unknown);
        }
        // Common last placements do not matter.
        let both = self.placements.iter().zip(&*other.placements);
        let common = both.take_while(|(a, b)| a == b).count();
        let (Some(a), Some(b)) = (self.matrix(common)?, other.matrix(common)?) else {
            return Ok(Contact::Unknown);
        };
        if let Some((negative_a, negative_b)) = pencil::excluded(&a, &b) {
            return Ok(Contact::Excluded(negative_a, negative_b));
        }
        let sheets = match (&*self.half_space.0, &*other.half_space.0) {
            (Surface::Quadric(_), Surface::Plane(_)) => self.sheets(other, true, frame)?,
            (Surface::Plane(_), Surface::Quadric(_)) => other.sheets(self, false, frame)?,
            _ => None,
        };
        Ok(sheets.map_or(Contact::Unknown, |sheets| Contact::Sheets(Box::new(sheets))))
    }

    /// Returns twice the matrix of the function, without the first `left_out` placements.
    fn matrix(&self, left_out: usize) -> Result<Option<Form>, Error> {
        let map = || {
            let mut placements = self.placements.iter().skip(left_out);
            placements.try_fold(ExactMap::identity(), |map, placement| map.of_placed(placement))
        };
        Ok(match &*self.half_space.0 {
            Surface::Plane(plane) => {
                let [x, y, z, c] = oriented(plane, &map()?);
                let zero = Dyadic::zero;
                Some(symmetric(&[zero(), zero(), zero(), zero(), zero(), zero(), x, y, z, c]))
            }
            Surface::Quadric(quadric) => Some(symmetric(&substitute(quadric, &map()?))),
            _ => None,
        })
    }

    pub(crate) fn is_plane(&self) -> bool {
        matches!(&*self.half_space.0, Surface::Plane(_))
    }

    /// Returns the coefficients of a plane in the unit coordinates of a frame.
    pub(crate) fn linear(&self, frame: &Frame) -> Result<Option<Linear>, Error> {
        match &*self.half_space.0 {
            Surface::Plane(plane) => Ok(Some(oriented(plane, &self.map(ExactMap::from_universe(frame))?))),
            _ => Ok(None),
        }
    }

    /// Returns the sheets of a quadric beside a plane in which the quadric, or its complement, has no inner
    /// point.
    fn sheets(
        &self,
        plane: &PlacedHalfSpace,
        is_plane_second: bool,
        frame: &Frame,
    ) -> Result<Option<Sheets>, Error> {
        let (Surface::Quadric(quadric), Some(plane)) = (&*self.half_space.0, plane.linear(frame)?) else {
            return Ok(None);
        };
        let form = symmetric(&substitute(quadric, &self.map(ExactMap::from_universe(frame))?));
        let Some(pivot) = (0..3).max_by_key(|&k| plane[k].magnitude()) else { return Ok(None) };
        let moved = on_plane(&form, &plane, pivot);
        let is_inside_negative =
            match [false, true].each(|sign| pencil::is_semi_definite(&moved, pivot, sign)) {
                [true, _] => false,
                [_, true] => true,
                _ => return Ok(None),
            };
        // With this choice, f + ℓ g is the form without the pivot's row and column, which is semi-definite.
        let row = &moved[pivot];
        let factor = from_fn(|k| {
            let own = &row[pivot] * &plane[k];
            let sum = if k == pivot { own } else { &own + &row[k].shifted(1) };
            if is_inside_negative { sum } else { -&sum }
        });
        let form = if is_inside_negative { form.each(|row| row.each(|c| -&c)) } else { form };
        Ok(Some(Sheets { is_plane_second, is_inside_negative, form, plane, factor }))
    }
}

impl Sheets {
    /// Returns the signs of the first and the second function that occur together at no point of a cell.
    pub(crate) fn excluded(&self, cell: Cell) -> Option<(bool, bool)> {
        let (centre, half) = (centre(cell), half_edge(cell));
        let corners: [[Dyadic; 3]; 8] = from_fn(|corner| {
            axes(|axis| {
                Dyadic::new(if corner >> axis & 1 == 0 { centre[axis] - half } else { centre[axis] + half })
            })
        });
        let [plane, factor] = [&self.plane, &self.factor]
            .each(|of| corners.each_ref().each(|corner| linear::value(of, corner)));
        [false, true]
            .into_iter()
            .find(|&negative| is_above(&factor, &plane, negative))
            .map(|negative| self.signs(negative))
    }

    /// Returns two excluded combinations: the signs of both functions, and the sign of a third surface, a
    /// plane. Each sign says whether the function is negative. `None` if the third surface does not decide.
    pub(crate) fn excluded_with(&self, third: &Linear) -> Option<[((bool, bool), bool); 2]> {
        // Projected on the plane along any direction w, a point has the value f + ℓ g, where ℓ g(w)² is f(w)
        // g − 2 g(w) (w F). For a cone there is a w such that w F is the function h of the plane through the
        // apex.
        let (f, g, h) = (&self.form, &self.plane, third);
        let adjugate = |i: usize, k: usize| {
            let at = |a: usize, b: usize| &f[(i + a) % 3][(k + b) % 3];
            &(at(1, 1) * at(2, 2)) - &(at(1, 2) * at(2, 1))
        };
        let of = |row: &dyn Fn(usize) -> Dyadic, v: &[Dyadic]| {
            v.iter().enumerate().fold(Dyadic::zero(), |sum, (k, c)| &sum + &(&row(k) * c))
        };
        let w: [Dyadic; 3] = from_fn(|i| of(&|k| adjugate(i, k), &h[..3]));
        let determinant = (0..3).fold(Dyadic::zero(), |sum, k| &sum + &(&f[0][k] * &adjugate(0, k)));
        let polar: Linear = from_fn(|i| of(&|k| f[i][k].clone(), &w));
        let [of_f, of_g] = [&polar, g].each(|linear| of(&|k| linear[k].clone(), &w).sign());
        let is_apex = (0..4).all(|i| polar[i] == &determinant * &h[i]);
        if !is_apex || of_f < 0 || of_g * determinant.sign() == 0 {
            return None;
        }
        // Where the sign of h gives its term in ℓ the sign of the term of g, ℓ has that sign, too.
        let is_turned = of_g * determinant.sign() > 0;
        Some([false, true].each(|is_negative| (self.signs(is_negative), is_negative != is_turned)))
    }

    fn signs(&self, is_plane_negative: bool) -> (bool, bool) {
        match self.is_plane_second {
            true => (self.is_inside_negative, is_plane_negative),
            false => (is_plane_negative, self.is_inside_negative),
        }
    }
}

/// Returns whether an a ≥ 0 exists such that each value is at least a times the corresponding other value.
/// Then no value is negative where the other is positive. With `negative`, all values are negated.
fn is_above(values: &[Dyadic; 8], others: &[Dyadic; 8], negative: bool) -> bool {
    // Bounds of a as fractions with positive denominators.
    let mut least = (Dyadic::zero(), Dyadic::new(1.0));
    let mut most: Option<(Dyadic, Dyadic)> = None;
    let is_less = |a: &(Dyadic, Dyadic), b: &(Dyadic, Dyadic)| &a.0 * &b.1 < &b.0 * &a.1;
    for (value, other) in values.iter().zip(others) {
        let (value, other) = if negative { (-value, -other) } else { (value.clone(), other.clone()) };
        match other.sign() {
            1 if most.as_ref().is_none_or(|most| is_less(&(value.clone(), other.clone()), most)) => {
                most = Some((value, other));
            }
            -1 if is_less(&least, &(-&value, -&other)) => least = (-&value, -&other),
            0 if value.sign() < 0 => return false,
            _ => {}
        }
    }
    most.is_none_or(|most| !is_less(&most, &least))
}

/// Returns the image of a plane's function under the map, with its sign.
fn oriented(plane: &Linear, map: &ExactMap) -> Linear {
    let linear = map.linear(plane);
    if map.w.sign() < 0 { linear.each(|c| -&c) } else { linear }
}

/// Twice the symmetric matrix of a polynomial of degree two.
fn symmetric(coefficients: &Coefficients) -> Form {
    from_fn(|i| {
        from_fn(|k| {
            let c = &coefficients[place(i, k)];
            if i == k { c.shifted(1) } else { c.clone() }
        })
    })
}

/// The form in other coordinates: the points divided by the plane's coefficient `pivot`, and in the pivot's
/// place the plane's function divided by it.
fn on_plane(form: &Form, plane: &Linear, pivot: usize) -> Form {
    let map: Form = from_fn(|i| {
        from_fn(|k| match (i == pivot, i == k) {
            (true, true) => Dyadic::new(1.0),
            (true, false) => -&plane[k],
            (false, true) => plane[pivot].clone(),
            (false, false) => Dyadic::zero(),
        })
    });
    let sum = |of: &dyn Fn(usize) -> Dyadic| (0..4).fold(Dyadic::zero(), |sum, j| &sum + &of(j));
    let right: Form = from_fn(|i| from_fn(|k| sum(&|j| &form[i][j] * &map[j][k])));
    from_fn(|i| from_fn(|k| sum(&|j| &map[j][i] * &right[j][k])))
}
