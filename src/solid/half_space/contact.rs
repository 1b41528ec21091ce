//! Spheres and planes that touch: closed forms in exact numbers, where bounds over cells never tell.

use super::PlacedHalfSpace;
use super::Surface;
use super::map::ExactMap;
use super::quadric::{Coefficients, substitute};
use crate::error::Error;
use crate::lattice::exact::{Dyadic, dot};

/// A sphere or a plane, by its exact function.
enum Figure {
    /// a |x|² + g · x + j, which has a centre and a radius.
    Sphere { a: Dyadic, g: [Dyadic; 3], square: Dyadic },
    /// n · x + c.
    Plane { n: [Dyadic; 3], c: Dyadic },
}

impl PlacedHalfSpace {
    /// The signs that two functions have together at no point, if one is that of a sphere and the other that of a sphere or a plane: whether
    /// the first and the second are negative. `None` of other surfaces, and if there is none. What is done to both alike does not count, so that a ball on a
    /// table may be turned with the table.
    pub(crate) fn excluded(&self, other: &PlacedHalfSpace) -> Result<Option<(bool, bool)>, Error> {
        let is_due = |half_space: &PlacedHalfSpace| {
            matches!(&*half_space.half_space.0, Surface::Plane(_) | Surface::Quadric(_))
        };
        if !(is_due(self) && is_due(other)) {
            return Ok(None);
        }
        let pairs = self.placements.iter().zip(&*other.placements);
        let shared = pairs.take_while(|(a, b)| a == b).count();
        let (Some(a), Some(b)) = (self.figure(shared)?, other.figure(shared)?) else { return Ok(None) };
        Ok(match (&a, &b) {
            (Figure::Sphere { .. }, Figure::Sphere { .. }) => of_spheres(&a, &b),
            (Figure::Sphere { .. }, Figure::Plane { .. }) => of_sphere_and_plane(&a, &b),
            (Figure::Plane { .. }, Figure::Sphere { .. }) => {
                of_sphere_and_plane(&b, &a).map(|(sphere, plane)| (plane, sphere))
            }
            _ => None,
        })
    }

    /// The figure without its first placements.
    fn figure(&self, without: usize) -> Result<Option<Figure>, Error> {
        let map = self.placements[without..]
            .iter()
            .try_fold(ExactMap::identity(), |map, placement| map.of_placed(placement))?;
        Ok(match &*self.half_space.0 {
            Surface::Plane(plane) => {
                let [x, y, z, c] = map.linear(plane);
                let [x, y, z, c] = if map.w.sign() < 0 { [-&x, -&y, -&z, -&c] } else { [x, y, z, c] };
                Some(Figure::Plane { n: [x, y, z], c })
            }
            Surface::Quadric(quadric) => Figure::of(substitute(quadric, &map)),
            _ => None,
        })
    }
}

impl Figure {
    fn of([a, b, c, d, e, f, x, y, z, j]: Coefficients) -> Option<Figure> {
        let is_sphere = a == b && b == c && !a.is_zero() && [d, e, f].iter().all(Dyadic::is_zero);
        // Of 4 a² times the square of the radius.
        let square = &dot([&x, &y, &z], [&x, &y, &z]) - &(&a * &j).shifted(2);
        (is_sphere && square.sign() > 0).then_some(Figure::Sphere { a, g: [x, y, z], square })
    }
}

/// Squares of distances and radii, times the same: 4 a² b².
fn of_spheres(first: &Figure, second: &Figure) -> Option<(bool, bool)> {
    let (Figure::Sphere { a, g, square: p }, Figure::Sphere { a: b, g: h, square: q }) = (first, second)
    else {
        return None;
    };
    let (p, q) = (&(b * b) * p, &(a * a) * q);
    let off = [0, 1, 2].map(|k| &(&g[k] * b) - &(&h[k] * a));
    let apart = dot(off.each_ref(), off.each_ref());
    // Of x ≥ 0 and y ≥ 0 whether √whole ≥ √x + √y.
    let is_sum = |whole: &Dyadic, x: &Dyadic, y: &Dyadic| {
        let rest = &(whole - x) - y;
        rest.sign() >= 0 && (&(&rest * &rest) - &(x * y).shifted(2)).sign() >= 0
    };
    // Inside, the function has the other sign than its factor of second order.
    let (in_a, in_b) = (a.sign() > 0, b.sign() > 0);
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

fn of_sphere_and_plane(sphere: &Figure, plane: &Figure) -> Option<(bool, bool)> {
    let (Figure::Sphere { a, g, square }, Figure::Plane { n, c }) = (sphere, plane) else { return None };
    // The plane's function at the centre, times 2 a.
    let value = &(a * c).shifted(1) - &dot(n.each_ref(), g.each_ref());
    let is_apart = (&(&value * &value) - &(square * &dot(n.each_ref(), n.each_ref()))).sign() >= 0;
    let is_positive = value.sign() == a.sign();
    // All of the ball has that sign.
    (is_apart && !value.is_zero()).then_some((a.sign() > 0, is_positive))
}
