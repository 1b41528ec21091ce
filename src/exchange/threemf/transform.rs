//! Affine transforms of row vectors.

use crate::lattice::Each;

/// An affine map. It maps a point p to p · (the first three rows) + the last row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Transform {
    rows: [[f64; 3]; 4],
    /// True if the determinant is negative, so that the map turns a surface inside out.
    pub mirrors: bool,
}

impl Transform {
    pub const IDENTITY: Self = Self::scale(1.0);

    /// Returns the scaling by a positive factor about the origin.
    pub const fn scale(factor: f64) -> Self {
        let rows = [[factor, 0.0, 0.0], [0.0, factor, 0.0], [0.0, 0.0, factor], [0.0; 3]];
        Self { rows, mirrors: false }
    }

    /// Parses twelve finite numbers, row by row, separated by white space.
    pub fn parse(text: &str) -> Option<Self> {
        let mut rows = [[0.0; 3]; 4];
        let mut words = text.split_ascii_whitespace();
        for x in rows.as_flattened_mut() {
            *x = words.next()?.parse().ok().filter(|x: &f64| x.is_finite())?;
        }
        let [a, b, c, _] = rows.each(unit_row);
        let determinant = a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]);
        words.next().is_none().then_some(Self { rows, mirrors: determinant < 0.0 })
    }

    /// Returns the composition: this map, and then `next`.
    pub fn then(&self, next: &Self) -> Self {
        if *next == Self::IDENTITY {
            return *self;
        }
        if *self == Self::IDENTITY {
            return *next;
        }
        let [a, b, c, offset] = self.rows;
        let rows = [next.direction(a), next.direction(b), next.direction(c), next.apply(offset)];
        Self { rows, mirrors: self.mirrors != next.mirrors }
    }

    pub fn apply(&self, p: [f64; 3]) -> [f64; 3] {
        let moved = self.direction(p);
        core::array::from_fn(|axis| moved[axis] + self.rows[3][axis])
    }

    fn direction(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [a, b, c, _] = &self.rows;
        core::array::from_fn(|axis| x * a[axis] + y * b[axis] + z * c[axis])
    }
}

/// Scales a row to about 1, so that products neither overflow nor vanish.
fn unit_row(row: [f64; 3]) -> [f64; 3] {
    let most = row.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if most > 0.0 { row.each(|x| x / most) } else { row }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_and_order() {
        let turn = Transform::parse("0 1 0 -1 0 0 0 0 1 10 0 0").unwrap();
        assert_eq!(turn.apply([1.0, 0.0, 0.0]), [10.0, 1.0, 0.0]);
        assert_eq!(turn.apply([0.0, 2.0, 3.0]), [8.0, 0.0, 3.0]);
        assert!(!turn.mirrors);
        let double = Transform::scale(2.0);
        assert_eq!(turn.then(&double).apply([1.0, 0.0, 0.0]), [20.0, 2.0, 0.0]);
        assert_eq!(double.then(&turn).apply([1.0, 0.0, 0.0]), [10.0, 2.0, 0.0]);
        assert_eq!(turn.then(&Transform::IDENTITY), turn);
        assert_eq!(Transform::IDENTITY.then(&turn), turn);
    }

    #[test]
    fn mirrors() {
        for (text, mirrors) in [
            ("-1 0 0 0 1 0 0 0 1 0 0 0", true),
            ("-1 0 0 0 -1 0 0 0 1 0 0 0", false),
            ("0 1 0 1 0 0 0 0 1 0 0 0", true),
            ("1e-200 0 0 0 1e-200 0 0 0 -1e-200 0 0 0", true),
            ("1e200 0 0 0 1e200 0 0 0 1e200 0 0 0", false),
            ("0 0 0 0 0 0 0 0 0 0 0 0", false),
        ] {
            assert_eq!(Transform::parse(text).unwrap().mirrors, mirrors, "{text}");
        }
        let mirror = Transform::parse("1 0 0 0 1 0 0 0 -1 0 0 5").unwrap();
        assert!(mirror.mirrors && !mirror.then(&mirror).mirrors);
        assert_eq!(mirror.then(&mirror).apply([1.0, 2.0, 3.0]), [1.0, 2.0, 3.0]);
    }

    #[test]
    fn twelve_numbers() {
        for text in [
            "",
            "1 0 0 0 1 0 0 0 1 0 0",
            "1 0 0 0 1 0 0 0 1 0 0 0 1",
            "1 0 0 0 1 0 0 0 1 0 0 x",
            "1 0 0 0 1 0 0 0 1 0 0 nan",
            "1,0,0,0,1,0,0,0,1,0,0,0",
        ] {
            assert_eq!(Transform::parse(text), None, "{text}");
        }
        assert_eq!(Transform::parse("\n1 0\t0 0 1 0 0 0 1.0 0e0 -0 0 "), Some(Transform::IDENTITY));
    }
}
