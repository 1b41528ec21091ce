//! Compositions of affine maps, in doubles.

use super::Affine;
use super::array::Each;
use super::exact::{two_product, two_sum};

/// The rounded composition of affine maps, with an error bound for each entry of `[M | t]`.
///
/// The image of a box under the composition is as small as the composed map allows. Mapping a box by one map
/// after the other enlarges it with each map.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Composed {
    pub(super) rows: [[f64; 4]; 3],
    /// The error bounds of the entries; zero where nothing was rounded.
    pub(super) errors: [[f64; 4]; 3],
}

impl Composed {
    /// The rows of `[M | t]`.
    pub(crate) fn rows(&self) -> &[[f64; 4]; 3] {
        &self.rows
    }

    /// The error bounds of the entries.
    pub(crate) fn errors(&self) -> &[[f64; 4]; 3] {
        &self.errors
    }

    /// The composition that applies `inner` first, then this map.
    pub(crate) fn after(&self, inner: &Affine) -> Composed {
        let (mut rows, mut errors) = ([[0.0; 4]; 3], [[0.0; 4]; 3]);
        for (i, (row, error)) in self.rows.iter().zip(&self.errors).enumerate() {
            for j in 0..4 {
                let column = inner.rows().each(|inner| inner[j]);
                let constant = if j == 3 { row[3] } else { 0.0 };
                let sum = RoundedSum::of([row[0], row[1], row[2]], column, constant);
                let carried: f64 = (0..3).map(|k| error[k] * column[k].abs()).sum();
                let carried = carried + if j == 3 { error[3] } else { 0.0 };
                // The sum of the carried errors is rounded itself, and so is the term that is added to it.
                (rows[i][j], errors[i][j]) = (sum.value, carried * (1.0 + 1e-12) + sum.error);
            }
        }
        Composed { rows, errors }
    }
}

impl From<&Affine> for Composed {
    fn from(map: &Affine) -> Composed {
        Composed { rows: *map.rows(), errors: [[0.0; 4]; 3] }
    }
}

/// A sum of three products and a constant, and a bound of its error. The bound is zero where nothing was
/// rounded.
pub(super) struct RoundedSum {
    pub(super) value: f64,
    pub(super) error: f64,
}

impl RoundedSum {
    pub(super) fn of(a: [f64; 3], b: [f64; 3], constant: f64) -> RoundedSum {
        let (mut value, mut size) = (constant, constant.abs());
        // The errors of very small numbers would underflow.
        let is_tellable = |c: &f64| *c == 0.0 || c.abs() > 1e-100;
        let mut is_exact = a.iter().chain(&b).all(is_tellable);
        for axis in 0..3 {
            let product = two_product(a[axis], b[axis]);
            let sum = two_sum(value, product.0);
            is_exact &= [product.1, sum.1] == [0.0; 2];
            (value, size) = (sum.0, size + product.0.abs());
        }
        // Each summand is rounded at most six times.
        let error = if is_exact { 0.0 } else { 16.0 * f64::EPSILON * size + f64::MIN_POSITIVE };
        RoundedSum { value, error }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Bounds;
    use crate::lattice::exact::{Dyadic, dot};

    #[test]
    fn entries_are_within_their_errors_of_the_exact_composition() {
        let maps = [
            Affine::new([[0.6, -0.8, 0.0, 1.1], [0.8, 0.6, 1e-3, -7.3], [0.1, 0.0, 1.0, 0.7]]).unwrap(),
            Affine::new([[1.0, 0.3, 1e-9, 1e9], [0.0, 0.7, 0.0, 1e-15], [0.2, -0.4, 3.0, 0.0]]).unwrap(),
        ];
        let mut rows = maps[0].rows().map(|row| row.map(Dyadic::new));
        let mut composed = Composed::from(&maps[0]);
        for step in 0..30 {
            let inner = &maps[step % 2];
            let m = inner.rows().map(|row| row.map(Dyadic::new));
            rows = rows.map(|row| {
                [0, 1, 2, 3].map(|j| {
                    let sum = dot([&row[0], &row[1], &row[2]], [&m[0][j], &m[1][j], &m[2][j]]);
                    if j == 3 { &sum + &row[3] } else { sum }
                })
            });
            composed = composed.after(inner);
            for (i, row) in rows.iter().enumerate() {
                for (j, exact) in row.iter().enumerate() {
                    let [low, high] = [-1.0, 1.0].map(|sense| {
                        &Dyadic::new(composed.rows[i][j]) + &Dyadic::new(sense * composed.errors[i][j])
                    });
                    assert!(low <= *exact && *exact <= high, "step {step}, entry {i} {j}");
                }
            }
        }
        assert!(composed.errors[0][0] < 1e-11 * composed.rows[0][0].abs().max(1.0));
    }

    #[test]
    fn quarter_turns_and_whole_steps_stay_exact() {
        let step = Affine::new([[0.0, -1.0, 0.0, 3.0], [1.0, 0.0, 0.0, 5.0], [0.0, 0.0, 2.0, -1.0]]).unwrap();
        let composed = (0..20).fold(Composed::from(&step), |composed, _| composed.after(&step));
        assert_eq!(composed.errors, [[0.0; 4]; 3]);
        let unit = Bounds::new([0.0; 3], [1.0; 3]).unwrap();
        let chain = (0..21).fold(unit, |bounds, _| bounds.placed(&step).unwrap());
        assert_eq!(unit.under(&composed), Some(chain));
    }
}
