//! Ellipsoids and planes that touch: closed forms in exact numbers, where bounds over cells never tell.
//!
//! What an affine map does to both alike does not count: balls under one map are ellipsoids whose terms of second order are
//! proportional, and two such ellipsoids lie to each other as the balls do.

use super::PlacedHalfSpace;
use super::Surface;
use super::map::ExactMap;
use super::quadric::{Coefficients, substitute};
use crate::error::Error;
use crate::lattice::exact::{Dyadic, dot};
use alloc::boxed::Box;

/// An ellipsoid or a plane, by its exact function.
enum Figure {
    Ellipsoid(Box<Ellipsoid>),
    /// n · x + c.
    Plane {
        n: [Dyadic; 3],
        c: Dyadic,
    },
}

/// ½ xᵀ H x + g · x + j with a positive definite matrix H, which is negative inside.
struct Ellipsoid {
    /// Rows.
    h: [[Dyadic; 3]; 3],
    g: [Dyadic; 3],
    j: Dyadic,
    /// Whether the half-space's function is the negative of this, so that the inside is its inside.
    negated: bool,
}

impl PlacedHalfSpace {
    /// The signs that two functions have together at no point: whether the first and the second are negative. `None` if there are none,
    /// and of surfaces other than planes and ellipsoids of one kind: such as an affine map makes of balls.
    pub(crate) fn excluded(&self, other: &PlacedHalfSpace) -> Result<Option<(bool, bool)>, Error> {
        let (Some(a), Some(b)) = (self.figure()?, other.figure()?) else { return Ok(None) };
        Ok(match (&a, &b) {
            (Figure::Ellipsoid(a), Figure::Ellipsoid(b)) => of_ellipsoids(a, b),
            (Figure::Ellipsoid(a), Figure::Plane { n, c }) => a.beside(n, c),
            (Figure::Plane { n, c }, Figure::Ellipsoid(b)) => {
                b.beside(n, c).map(|(inside, plane)| (plane, inside))
            }
            (Figure::Plane { .. }, Figure::Plane { .. }) => None,
        })
    }

    fn figure(&self) -> Result<Option<Figure>, Error> {
        Ok(match &*self.half_space.0 {
            Surface::Plane(plane) => {
                let map = self.map(ExactMap::identity())?;
                let [x, y, z, c] = map.linear(plane);
                let [x, y, z, c] = if map.w.sign() < 0 { [-&x, -&y, -&z, -&c] } else { [x, y, z, c] };
                Some(Figure::Plane { n: [x, y, z], c })
            }
            Surface::Quadric(quadric) => Ellipsoid::of(substitute(quadric, &self.map(ExactMap::identity())?))
                .map(|own| Figure::Ellipsoid(Box::new(own))),
            _ => None,
        })
    }
}

impl Ellipsoid {
    fn of(coefficients: Coefficients) -> Option<Ellipsoid> {
        let negated = coefficients[0].sign() < 0;
        let [a, b, c, d, e, f, x, y, z, j] = coefficients.map(|c| if negated { -&c } else { c });
        let [a, b, c] = [a, b, c].map(|square| square.shifted(1));
        let h = [[a, d.clone(), f.clone()], [d, b, e.clone()], [f, e, c]];
        let minor = &(&h[0][0] * &h[1][1]) - &(&h[0][1] * &h[1][0]);
        let own = Ellipsoid { h, g: [x, y, z], j, negated };
        // (Without a point inside it is no surface.)
        let is_definite = own.h[0][0].sign() > 0 && minor.sign() > 0 && own.determinant().sign() > 0;
        (is_definite && own.square().sign() > 0).then_some(own)
    }

    /// The same function times a positive number.
    fn times(&self, factor: &Dyadic) -> Ellipsoid {
        let times = |x: &Dyadic| x * factor;
        Ellipsoid {
            h: self.h.each_ref().map(|row| row.each_ref().map(times)),
            g: self.g.each_ref().map(times),
            j: times(&self.j),
            negated: self.negated,
        }
    }

    fn determinant(&self) -> Dyadic {
        dot(self.h[0].each_ref(), self.adjugate()[0].each_ref())
    }

    /// det H times the inverse of H.
    fn adjugate(&self) -> [[Dyadic; 3]; 3] {
        [0, 1, 2].map(|i| {
            [0, 1, 2].map(|k| {
                let at = |a: usize, b: usize| &self.h[(i + a) % 3][(k + b) % 3];
                &(at(1, 1) * at(2, 2)) - &(at(1, 2) * at(2, 1))
            })
        })
    }

    /// vᵀ adj(H) w.
    fn product(&self, v: &[Dyadic; 3], w: &[Dyadic; 3]) -> Dyadic {
        let rows = self.adjugate();
        let image = rows.each_ref().map(|row| dot(row.each_ref(), w.each_ref()));
        dot(v.each_ref(), image.each_ref())
    }

    /// The square of the radius in the metric of the ellipsoid: minus the least value of the function, times 2 det H.
    fn square(&self) -> Dyadic {
        &self.product(&self.g, &self.g) - &(&self.j * &self.determinant()).shifted(1)
    }

    /// The signs that are nowhere together if a plane does not cut the ellipsoid.
    fn beside(&self, n: &[Dyadic; 3], c: &Dyadic) -> Option<(bool, bool)> {
        // The plane's function at the centre, times det H.
        let value = &(c * &self.determinant()) - &self.product(n, &self.g);
        let is_apart = (&(&value * &value) - &(&self.square() * &self.product(n, n))).sign() >= 0;
        // All of the inside has the sign that the centre has.
        (is_apart && !value.is_zero()).then_some((self.inside_is_negative(), value.sign() > 0))
    }

    fn inside_is_negative(&self) -> bool {
        !self.negated
    }
}

fn of_ellipsoids(first: &Ellipsoid, second: &Ellipsoid) -> Option<(bool, bool)> {
    // With the same matrix.
    let (a, b) = (first.times(&second.h[0][0]), second.times(&first.h[0][0]));
    if a.h != b.h {
        return None;
    }
    // Squares of radii and of the distance of the centres in the metric of both, times the same.
    let off = [0, 1, 2].map(|k| &a.g[k] - &b.g[k]);
    let (p, q, apart) = (a.square(), b.square(), a.product(&off, &off));
    // Of x ≥ 0 and y ≥ 0 whether √whole ≥ √x + √y.
    let is_sum = |whole: &Dyadic, x: &Dyadic, y: &Dyadic| {
        let rest = &(whole - x) - y;
        rest.sign() >= 0 && (&(&rest * &rest) - &(x * y).shifted(2)).sign() >= 0
    };
    let (in_a, in_b) = (first.inside_is_negative(), second.inside_is_negative());
    if is_sum(&apart, &p, &q) {
        Some((in_a, in_b))
    } else if is_sum(&q, &p, &apart) {
        // The first in the second.
        Some((in_a, !in_b))
    } else if is_sum(&p, &q, &apart) {
        Some((!in_a, in_b))
    } else {
        None
    }
}
