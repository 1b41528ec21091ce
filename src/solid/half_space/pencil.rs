//! Pairs of quadratic forms with a positive combination that is nowhere positive, in exact numbers.
//!
//! Let f and g be polynomials of degree at most two, with the symmetric 4 × 4 matrices F and G that act on
//! (x, y, z, 1). If a λ > 0 makes F + λ G negative semi-definite, then f + λ g is nowhere positive, so that f
//! and g are positive together at no point. If g is positive at some point, the converse holds, too (the
//! S-lemma: Yakubovich, 1971).
//!
//! A symmetric matrix is negative semi-definite exactly if, for k = 1 to 4, the sum of its principal minors
//! of k rows, times (−1)^k, is not negative: these sums are the coefficients of its characteristic
//! polynomial, all of whose roots are real. For F + λ G the sums are polynomials in λ. Let c be the last of
//! them that is not identically zero. Where surfaces are apart, the suitable λ form an interval with c zero
//! at both ends, so that a root of c′ lies within. Where surfaces touch, there is only one λ, and it is a
//! multiple root of c. It solves gcd(c, c′), which has degree at most three, and no root of a degree above
//! two is needed. Both cases are decided without rounding.

use crate::lattice::Each;
use crate::lattice::exact::Dyadic;
use core::array::from_fn;

/// The rows of a symmetric matrix.
pub(super) type Form = [[Dyadic; 4]; 4];

/// A polynomial of degree at most four, by its coefficients from the constant on.
#[derive(Debug, Clone)]
struct Polynomial([Dyadic; 5]);

/// The number (p + s √d) / q.
struct Number {
    p: Dyadic,
    s: Dyadic,
    d: Dyadic,
    /// The divisor, positive.
    q: Dyadic,
}

/// A multiple root is searched for if a value is at least minus this fraction of its terms' magnitudes.
const NEARLY: f64 = 1e-9;

/// Returns a combination of signs that two functions have together at no point: whether the first and the
/// second are negative. `None` if there is none.
pub(super) fn excluded(f: &Form, g: &Form) -> Option<(bool, bool)> {
    let sums = sums(&normal(f), &normal(g));
    [(false, false), (false, true), (true, false), (true, true)].into_iter().find(
        |&(negative_f, negative_g)| {
            let signed = |k: usize, j: usize| {
                let odd = k + if negative_f { k - j } else { 0 } + if negative_g { j } else { 0 };
                if odd.is_multiple_of(2) { sums[k - 1][j].clone() } else { -&sums[k - 1][j] }
            };
            let all = [1, 2, 3, 4]
                .each(|k: usize| Polynomial(from_fn(|j| if j <= k { signed(k, j) } else { Dyadic::zero() })));
            are_somewhere_not_negative(&all)
        },
    )
}

/// Returns whether the 3 × 3 matrix without row and column `left_out` is negative semi-definite; positive
/// semi-definite if `positive`.
pub(super) fn is_semi_definite(f: &Form, left_out: usize, positive: bool) -> bool {
    let rows: [usize; 3] = from_fn(|k| k + usize::from(k >= left_out));
    let constant = |c: &Dyadic| Polynomial::new(&[c]);
    let entries: [[Polynomial; 4]; 4] = from_fn(|i| from_fn(|j| constant(&f[i][j])));
    let [a, b, c] = rows;
    let diagonal = [a, b, c].iter().fold(Dyadic::zero(), |sum, &i| &sum + &f[i][i]);
    let pairs =
        [[a, b], [b, c], [a, c]].iter().fold(Dyadic::zero(), |sum, &at| &sum + &minor(&entries, at, at).0[0]);
    let all = determinant(&entries, rows).0[0].clone();
    let wanted = |value: &Dyadic, is_odd: bool| {
        let sign = value.sign();
        if is_odd && !positive { sign <= 0 } else { sign >= 0 }
    };
    wanted(&diagonal, true) && wanted(&pairs, false) && wanted(&all, true)
}

/// Scales the matrix by a power of two, so that its largest entry has a magnitude of about one.
fn normal(f: &Form) -> Form {
    let most = f.iter().flatten().filter_map(Dyadic::magnitude).max().unwrap_or(0);
    f.each_ref().each(|row| row.each_ref().each(|c| c.shifted(-most)))
}

/// Returns the sums of the principal minors of k = 1 to 4 rows of F + λ G.
fn sums(f: &Form, g: &Form) -> [[Dyadic; 5]; 4] {
    let entries: [[Polynomial; 4]; 4] = from_fn(|i| from_fn(|j| Polynomial::new(&[&f[i][j], &g[i][j]])));
    let mut sums = [const { None }; 4];
    let mut add = |k: usize, term: Polynomial| {
        let sum: &mut Option<Polynomial> = &mut sums[k - 1];
        *sum = Some(match sum.take() {
            Some(sum) => sum.plus(&term),
            None => term,
        });
    };
    for i in 0..4 {
        add(1, entries[i][i].clone());
        for j in 0..i {
            add(2, minor(&entries, [j, i], [j, i]));
        }
        add(3, determinant(&entries, from_fn(|k| k + usize::from(k >= i))));
    }
    // Laplace's expansion along the first two rows.
    for (columns, others, is_even) in [
        ([0, 1], [2, 3], true),
        ([0, 2], [1, 3], false),
        ([0, 3], [1, 2], true),
        ([1, 2], [0, 3], true),
        ([1, 3], [0, 2], false),
        ([2, 3], [0, 1], true),
    ] {
        let term = minor(&entries, [0, 1], columns).times(&minor(&entries, [2, 3], others));
        add(4, if is_even { term } else { term.negated() });
    }
    sums.each(|sum| sum.unwrap_or_else(|| Polynomial::new(&[])).0)
}

fn minor(entries: &[[Polynomial; 4]; 4], [i, k]: [usize; 2], [j, l]: [usize; 2]) -> Polynomial {
    entries[i][j].times(&entries[k][l]).minus(&entries[i][l].times(&entries[k][j]))
}

/// Returns the principal minor of three rows.
fn determinant(entries: &[[Polynomial; 4]; 4], [i, j, k]: [usize; 3]) -> Polynomial {
    let row = &entries[i];
    (row[i].times(&minor(entries, [j, k], [j, k])))
        .minus(&row[j].times(&minor(entries, [j, k], [i, k])))
        .plus(&row[k].times(&minor(entries, [j, k], [i, j])))
}

/// Returns whether some positive number makes no polynomial negative. The polynomials must be sums of
/// principal minors.
fn are_somewhere_not_negative(all: &[Polynomial; 4]) -> bool {
    let Some(last) = all.iter().rev().find(|c| c.degree().is_some()) else { return false };
    let last = last.without_zeros();
    let derivative = last.derivative();
    let about = all.each_ref().each(Polynomial::rounded);
    let mut is_near = false;
    let serves = |at: &Number| all.iter().all(|c| c.sign_at(at) >= 0);
    for at in roots(&derivative.rounded()).into_iter().filter(|at| *at > 0.0) {
        if about.iter().all(|c| value(c, at).is_not_negative(NEARLY)) {
            let at = Number { p: Dyadic::new(at), s: Dyadic::zero(), d: Dyadic::zero(), q: Dyadic::new(1.0) };
            if serves(&at) {
                return true;
            }
            is_near = true;
        }
    }
    is_near && gcd(last, derivative).simple_roots().iter().flatten().any(|at| at.is_positive() && serves(at))
}

impl Polynomial {
    fn new(coefficients: &[&Dyadic]) -> Polynomial {
        Polynomial(from_fn(|k| coefficients.get(k).map_or_else(Dyadic::zero, |&c| c.clone())))
    }

    /// The degree; `None` for the zero polynomial.
    fn degree(&self) -> Option<usize> {
        self.0.iter().rposition(|c| !c.is_zero())
    }

    fn plus(&self, other: &Polynomial) -> Polynomial {
        Polynomial(from_fn(|k| &self.0[k] + &other.0[k]))
    }

    fn minus(&self, other: &Polynomial) -> Polynomial {
        Polynomial(from_fn(|k| &self.0[k] - &other.0[k]))
    }

    fn negated(&self) -> Polynomial {
        Polynomial(self.0.each_ref().each(|c| -c))
    }

    /// Returns the product; the degrees must sum to at most four.
    fn times(&self, other: &Polynomial) -> Polynomial {
        let mut product = Polynomial::new(&[]);
        for (i, a) in self.0.iter().enumerate().filter(|(_, c)| !c.is_zero()) {
            for (j, b) in other.0.iter().enumerate().filter(|(_, c)| !c.is_zero()) {
                product.0[i + j] = &product.0[i + j] + &(a * b);
            }
        }
        product
    }

    fn derivative(&self) -> Polynomial {
        Polynomial(from_fn(|k| match self.0.get(k + 1) {
            Some(c) => c * &Dyadic::new((k + 1) as f64),
            None => Dyadic::zero(),
        }))
    }

    /// Divides out the roots at zero.
    fn without_zeros(&self) -> Polynomial {
        let first = self.0.iter().position(|c| !c.is_zero()).unwrap_or(0);
        Polynomial(from_fn(|k| self.0.get(k + first).map_or_else(Dyadic::zero, Dyadic::clone)))
    }

    /// The coefficients, rounded, times a common power of two.
    fn rounded(&self) -> [f64; 5] {
        let most = self.0.iter().filter_map(Dyadic::magnitude).max().unwrap_or(0);
        self.0.each_ref().each(|c| c.shifted(-most).rounded())
    }

    /// Returns the sign at a number.
    fn sign_at(&self, at: &Number) -> i32 {
        // The value is (u + v √d) / q^n, by Horner's rule.
        let (mut u, mut v, mut power) = (Dyadic::zero(), Dyadic::zero(), Dyadic::new(1.0));
        for c in self.0.iter().rev() {
            let times = |u: &Dyadic, v: &Dyadic| {
                (&(u * &at.p) + &(&(v * &at.s) * &at.d), &(u * &at.s) + &(v * &at.p))
            };
            (u, v) = times(&u, &v);
            u = &u + &(c * &power);
            power = &power * &at.q;
        }
        sign_of(&u, &v, &at.d)
    }

    /// Returns the roots, each once, of a polynomial of degree at most three. If the degree is three, its
    /// roots must be equal.
    fn simple_roots(&self) -> [Option<Number>; 2] {
        let [c, b, a, third, _] = &self.0;
        let zero = Dyadic::zero;
        let number = |p: &Dyadic, s: &Dyadic, d: &Dyadic, q: &Dyadic| {
            let (p, s, d) = (p.clone(), s.clone(), d.clone());
            Some(match q.sign() {
                1 => Number { p, s, d, q: q.clone() },
                _ => Number { p: -&p, s: -&s, d, q: -q },
            })
        };
        match self.degree() {
            Some(1) => [number(&-c, &zero(), &zero(), b), None],
            Some(2) => {
                let square = &(b * b) - &(a * c).shifted(2);
                let one = Dyadic::new(1.0);
                match square.sign() {
                    0 => [number(&-b, &zero(), &zero(), &a.shifted(1)), None],
                    1 => [one.clone(), -&one].each(|s| number(&-b, &s, &square, &a.shifted(1))),
                    _ => [None, None],
                }
            }
            Some(3) => [number(&-a, &zero(), &zero(), &(third * &Dyadic::new(3.0))), None],
            _ => [None, None],
        }
    }
}

impl Number {
    fn is_positive(&self) -> bool {
        sign_of(&self.p, &self.s, &self.d) > 0
    }
}

/// Returns the sign of u + v √d.
fn sign_of(u: &Dyadic, v: &Dyadic, d: &Dyadic) -> i32 {
    let (of_u, of_v) = (u.sign(), if d.is_zero() { 0 } else { v.sign() });
    if of_u * of_v >= 0 {
        return (of_u + of_v).signum();
    }
    of_u * (&(u * u) - &(&(v * v) * d)).sign()
}

/// Returns the greatest common divisor of two polynomials, up to a factor.
fn gcd(mut a: Polynomial, mut b: Polynomial) -> Polynomial {
    while let Some(degree) = b.degree() {
        while let Some(own) = a.degree().filter(|own| *own >= degree) {
            let (first, other) = (a.0[own].clone(), b.0[degree].clone());
            let shifted = Polynomial(from_fn(|k| match k.checked_sub(own - degree) {
                Some(k) => &b.0[k] * &first,
                None => Dyadic::zero(),
            }));
            a = Polynomial(a.0.each_ref().each(|c| c * &other)).minus(&shifted);
        }
        Dyadic::make_primitive(&mut a.0);
        (a, b) = (b, a);
    }
    a
}

/// A value, and the sum of its terms' magnitudes.
struct Value {
    sum: f64,
    size: f64,
}

impl Value {
    fn is_not_negative(&self, but_for: f64) -> bool {
        // (NaN does not compare as less.)
        self.sum >= -but_for * self.size
    }
}

fn value(c: &[f64; 5], at: f64) -> Value {
    c.iter().rev().fold(Value { sum: 0.0, size: 0.0 }, |value, c| Value {
        sum: value.sum * at + c,
        size: value.size * at + c.abs(),
    })
}

/// Returns the positive roots of a polynomial and of its derivatives, with rounding errors; zeros fill the
/// rest.
fn roots(c: &[f64; 5]) -> [f64; 10] {
    let mut found = [0.0; 10];
    let mut count = 0;
    // The derivative's roots divide the line into pieces in which the polynomial has at most one root.
    let mut last = 0..0;
    for times in (0..4).rev() {
        let mut own = *c;
        for _ in 0..times {
            own = from_fn(|k| if k < 4 { own[k + 1] * (k + 1) as f64 } else { 0.0 });
        }
        let of = |at: f64| value(&own, at).sum;
        let first = count;
        let mut low = LEAST;
        for place in last.clone().map(Some).chain([None]) {
            let high = place.map_or(MOST, |place: usize| found[place]);
            if low < high && (of(low) < 0.0) != (of(high) < 0.0) && count < found.len() {
                found[count] = halved(low, high, of);
                count += 1;
            }
            low = high;
        }
        last = first..count;
    }
    found
}

/// The range in which roots are searched for.
const LEAST: f64 = 1.0 / MOST;
const MOST: f64 = (1u128 << 100) as f64;

/// Returns the place where a function changes its sign between two positive numbers.
fn halved(low: f64, high: f64, of: impl Fn(f64) -> f64) -> f64 {
    // Positive doubles are ordered as their bits.
    let (mut low, mut high) = (low.to_bits(), high.to_bits());
    let is_negative = of(f64::from_bits(low)) < 0.0;
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if (of(f64::from_bits(middle)) < 0.0) == is_negative { low = middle } else { high = middle }
    }
    // The simpler of the two is more likely to be the root itself.
    let [low, high] = [low, high].each(f64::from_bits);
    if of(high) == 0.0 || low.to_bits().trailing_zeros() < high.to_bits().trailing_zeros() {
        high
    } else {
        low
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn form(rows: [[f64; 4]; 4]) -> Form {
        rows.map(|row| row.map(Dyadic::new))
    }

    /// Returns the value at a point with whole coordinates.
    fn value(rows: &[[f64; 4]; 4], at: [f64; 3]) -> f64 {
        let [x, y, z] = at;
        let at = [x, y, z, 1.0];
        (0..4).map(|i| (0..4).map(|k| rows[i][k] * at[i] * at[k]).sum::<f64>()).sum()
    }

    #[test]
    fn balls_that_touch_and_hardly_do_not() {
        // r² − |x − c|², for c on the axis x.
        let ball = |c: f64, r: f64| {
            form([
                [-1.0, 0.0, 0.0, c],
                [0.0, -1.0, 0.0, 0.0],
                [0.0, 0.0, -1.0, 0.0],
                [c, 0.0, 0.0, r * r - c * c],
            ])
        };
        let a_little = 1.0 / (1u64 << 40) as f64;
        for scale in [1.0, 0.3, 7.0] {
            let beside = |off: f64| excluded(&ball(0.0, scale), &ball(scale * 3.0 + off, scale * 2.0));
            // (The sum of the radii is rounded.)
            if scale != 0.3 {
                assert_eq!(beside(0.0), Some((false, false)));
            }
            assert_eq!(beside(a_little), Some((false, false)));
            assert_eq!(beside(-a_little), None);
        }
        assert_eq!(excluded(&ball(1.0, 1.0), &ball(0.0, 2.0)), Some((false, true)));
        assert_eq!(excluded(&ball(0.0, 2.0), &ball(1.0, 1.0)), Some((true, false)));
        assert_eq!(excluded(&ball(0.0, 2.0), &ball(1.0 + a_little, 1.0)), None);
    }

    /// −x² − y² / 2 + 2 z and 2 x y − z² − 2: only λ = √½ works.
    #[test]
    fn a_root_that_is_no_fraction() {
        let f = [[-1.0, 0.0, 0.0, 0.0], [0.0, -0.5, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0]];
        let g = [[0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, -2.0]];
        assert_eq!(excluded(&form(f), &form(g)), Some((false, false)));
        // If one of them grows a little, a point lies inside both.
        let mut more = g;
        more[3][3] += 1.0 / (1u64 << 20) as f64;
        assert_eq!(excluded(&form(f), &form(more)), None);
    }

    /// Excluded combinations occur at no point, and combinations that occur at a point are not excluded.
    #[test]
    fn forms_of_small_whole_numbers() {
        let mut state = 1u64;
        let mut below = |end: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % end
        };
        let mut found = 0;
        for _ in 0..300 {
            let mut rows = || {
                let mut rows = [[0.0; 4]; 4];
                for i in 0..4 {
                    for k in 0..=i {
                        let is_there = i == k || below(3) == 0;
                        let c = if is_there { below(7) as f64 - 3.0 } else { 0.0 };
                        (rows[i][k], rows[k][i]) = (c, c);
                    }
                }
                rows
            };
            let (f, g) = (rows(), rows());
            let Some((negative_f, negative_g)) = excluded(&form(f), &form(g)) else { continue };
            found += 1;
            for k in 0..1000u32 {
                let at = [k % 10, k / 10 % 10, k / 100].map(|k| f64::from(k) * 0.5 - 2.25);
                let [of_f, of_g] = [(value(&f, at), negative_f), (value(&g, at), negative_g)]
                    .map(|(v, not)| if not { -v } else { v });
                assert!(!(of_f > 0.0 && of_g > 0.0), "{f:?} {g:?} {at:?}");
            }
        }
        assert!(found > 20, "{found}");
    }
}
