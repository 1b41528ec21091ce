//! The point that fits planes best: the minimum of a quadratic error function in a unit cube.
//!
//! Each plane is given by a point and a unit normal. The error of a place is the sum of the squares of its
//! distances from all planes. (Ju, Losasso, Schaefer and Warren, *Dual contouring of Hermite data*, 2002.) On
//! a smooth surface the planes nearly coincide, and the minimum is well-defined only across them. So
//! eigenvectors of the normals' matrix with small eigenvalues are ignored; in their directions the result is
//! the mean of the points.

use crate::lattice::Each;
use crate::lattice::axes;
use crate::lattice::exact::sqrt;

/// Eigenvalues below this part of the greatest one are ignored. Two planes of equal weight meet at an edge if
/// their normals differ by more than 11.5 degrees.
const LEAST: f64 = 0.01;

/// The value that replaces an ignored eigenvalue, as part of the greatest one, if the minimum lies outside
/// the cube. Among places that fit the planes equally well, the one nearest to the mean is then taken.
const STAY: f64 = 1e-4;

/// Planes whose best-fitting point is wanted.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Qef {
    /// The sum of n nᵀ: xx, xy, xz, yy, yz, zz.
    matrix: [f64; 6],
    /// The sum of n (n · p).
    right: [f64; 3],
    /// The sum and the number of all points.
    sum: [f64; 3],
    points: u32,
    planes: u32,
}

/// The best-fitting point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Minimum {
    /// Its place in the unit cube.
    pub at: [f64; 3],
    /// Whether a better place lies outside the cube.
    pub clamped: bool,
    /// Whether there was no plane, so that the place is the points' mean.
    pub is_mean: bool,
}

impl Qef {
    /// Adds a point of the unit cube, and the plane through it if its unit normal is known.
    #[inline]
    pub fn add(&mut self, point: [f64; 3], normal: Option<[f64; 3]>) {
        for axis in 0..3 {
            self.sum[axis] += point[axis];
        }
        self.points += 1;
        if let Some([x, y, z]) = normal {
            let products = [x * x, x * y, x * z, y * y, y * z, z * z];
            for (sum, product) in self.matrix.iter_mut().zip(products) {
                *sum += product;
            }
            let height = x * point[0] + y * point[1] + z * point[2];
            for (sum, n) in self.right.iter_mut().zip([x, y, z]) {
                *sum += n * height;
            }
            self.planes += 1;
        }
    }

    /// Returns the best place in the unit cube. Without points it is the middle of the cube.
    pub fn solve(&self) -> Minimum {
        if self.points == 0 {
            return Minimum { at: [0.5; 3], clamped: false, is_mean: true };
        }
        let mean = self.sum.each(|sum| sum / f64::from(self.points));
        if self.planes == 0 {
            return Minimum { at: mean.each(|c| c.clamp(0.0, 1.0)), clamped: false, is_mean: true };
        }
        let (values, vectors) = eigen(self.matrix);
        let greatest = values.iter().fold(0.0, |most: f64, &value| most.max(value));
        // The negative half-gradient at the mean.
        let product = multiplied(&self.matrix, mean);
        let rest = axes(|i| self.right[i] - product[i]);
        let mut best = mean;
        let mut weights = [0.0; 3];
        for i in 0..3 {
            let vector = vectors[i];
            if values[i] >= LEAST * greatest && greatest > 0.0 {
                let along = dot(vector, rest) / values[i];
                for axis in 0..3 {
                    best[axis] += along * vector[axis];
                }
                weights[i] = values[i];
            } else {
                weights[i] = STAY * greatest;
            }
        }
        if best.iter().all(|c| (0.0..=1.0).contains(c)) {
            return Minimum { at: best, clamped: false, is_mean: false };
        }
        let mut matrix = [0.0; 6];
        for (weight, [x, y, z]) in weights.into_iter().zip(vectors) {
            let products = [x * x, x * y, x * z, y * y, y * z, z * z];
            for (sum, product) in matrix.iter_mut().zip(products) {
                *sum += weight * product;
            }
        }
        Minimum { at: in_cube(&matrix, best), clamped: true, is_mean: false }
    }
}

/// Returns the place in the unit cube that minimises (x − best)ᵀ M (x − best). M is positive definite, so
/// there is exactly one minimum: in the interior of a face, of an edge, or at a corner. The free coordinates
/// are solved for.
fn in_cube(matrix: &[f64; 6], best: [f64; 3]) -> [f64; 3] {
    let m = full(matrix);
    let (mut least, mut at) = (f64::INFINITY, best.each(|c| if c > 0.5 { 1.0 } else { 0.0 }));
    // Each axis is at its lower end, at its upper end, or free; the last combination would be all free.
    for combination in 0..26 {
        let states = [combination % 3, combination / 3 % 3, combination / 9];
        let mut place = [0.0; 3];
        let mut free = [0; 3];
        let mut count = 0;
        for axis in 0..3 {
            match states[axis] {
                2 => {
                    free[count] = axis;
                    count += 1;
                }
                state => place[axis] = f64::from(state) - best[axis],
            }
        }
        // The influence of the fixed axes on the free ones.
        let pull = |row: usize| -> f64 {
            (0..3).filter(|&axis| states[axis] != 2).map(|axis| -m[row][axis] * place[axis]).sum()
        };
        let solved = match count {
            0 => Some([0.0; 2]),
            1 => {
                let a = free[0];
                (m[a][a] > 0.0).then(|| [pull(a) / m[a][a], 0.0])
            }
            _ => {
                let (a, b) = (free[0], free[1]);
                let determinant = m[a][a] * m[b][b] - m[a][b] * m[a][b];
                let (p, q) = (pull(a), pull(b));
                (determinant > 0.0).then(|| {
                    [(p * m[b][b] - q * m[a][b]) / determinant, (q * m[a][a] - p * m[a][b]) / determinant]
                })
            }
        };
        let Some(solved) = solved else { continue };
        for (&axis, &value) in free[..count].iter().zip(&solved) {
            place[axis] = value;
        }
        // (By rounding, a place may leave the cube by a last digit; combinations that are not the best may
        // leave it by more.)
        let candidate = axes(|axis| match states[axis] {
            2 => (best[axis] + place[axis]).clamp(0.0, 1.0),
            state => f64::from(state),
        });
        let off = axes(|axis| candidate[axis] - best[axis]);
        let error = dot(off, multiplied(matrix, off));
        if error < least {
            (least, at) = (error, candidate);
        }
    }
    at
}

fn full(&[xx, xy, xz, yy, yz, zz]: &[f64; 6]) -> [[f64; 3]; 3] {
    [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
}

fn multiplied(matrix: &[f64; 6], v: [f64; 3]) -> [f64; 3] {
    full(matrix).each(|row| dot(row, v))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The eigenvalues of a symmetric matrix and their unit eigenvectors, by cyclic Jacobi rotations.
pub(super) fn eigen(matrix: [f64; 6]) -> ([f64; 3], [[f64; 3]; 3]) {
    let mut m = full(&matrix);
    // Rows are the vectors.
    let mut vectors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // The iteration converges quadratically: five sweeps leave no remainder.
    for _ in 0..8 {
        if m[0][1] == 0.0 && m[0][2] == 0.0 && m[1][2] == 0.0 {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = m[p][q];
            let scale = m[p][p].abs() + m[q][q].abs();
            if off.abs() <= f64::EPSILON * f64::EPSILON * scale {
                (m[p][q], m[q][p]) = (0.0, 0.0);
                continue;
            }
            let theta = (m[q][q] - m[p][p]) / (2.0 * off);
            let t = theta.signum() / (theta.abs() + sqrt(theta * theta + 1.0));
            let c = 1.0 / sqrt(t * t + 1.0);
            let s = t * c;
            m[p][p] -= t * off;
            m[q][q] += t * off;
            (m[p][q], m[q][p]) = (0.0, 0.0);
            let r = 3 - p - q;
            let (rp, rq) = (m[r][p], m[r][q]);
            m[r][p] = c * rp - s * rq;
            m[r][q] = s * rp + c * rq;
            (m[p][r], m[q][r]) = (m[r][p], m[r][q]);
            for axis in 0..3 {
                let (vp, vq) = (vectors[p][axis], vectors[q][axis]);
                vectors[p][axis] = c * vp - s * vq;
                vectors[q][axis] = s * vp + c * vq;
            }
        }
    }
    ([m[0][0], m[1][1], m[2][2]], vectors)
}

#[cfg(test)]
mod tests {
    use super::*;
    use leafless_testkit::Random;

    fn any_normal(random: &mut Random) -> [f64; 3] {
        loop {
            let v = [0.0; 3].map(|_: f64| random.between(-1.0, 1.0));
            let length = sqrt(dot(v, v));
            if length > 0.1 && length < 1.0 {
                return v.map(|c| c / length);
            }
        }
    }

    #[test]
    fn eigenvectors_make_the_matrix() {
        let mut random = Random(1);
        for _ in 0..2000 {
            let matrix: [f64; 6] = core::array::from_fn(|_| random.between(-1.0, 1.0));
            let (values, vectors) = eigen(matrix);
            for i in 0..3 {
                let image = multiplied(&matrix, vectors[i]);
                for axis in 0..3 {
                    assert!((image[axis] - values[i] * vectors[i][axis]).abs() < 1e-12, "{matrix:?}");
                }
                for j in 0..3 {
                    let expected = if i == j { 1.0 } else { 0.0 };
                    assert!((dot(vectors[i], vectors[j]) - expected).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn three_planes_meet_at_their_corner() {
        let mut random = Random(2);
        let mut tried = 0;
        while tried < 500 {
            let corner = [0.0; 3].map(|_: f64| random.unit());
            let normals = [0; 3].map(|_| any_normal(&mut random));
            let mut qef = Qef::default();
            for normal in normals {
                for _ in 0..2 {
                    // A point in the plane.
                    let other = [0.0; 3].map(|_: f64| random.unit());
                    let off = dot(normal, axes(|i| other[i] - corner[i]));
                    qef.add(axes(|i| other[i] - off * normal[i]), Some(normal));
                }
            }
            let (values, _) = eigen(qef.matrix);
            let most = values.iter().fold(0.0, |a: f64, &b| a.max(b));
            if values.iter().any(|&value| value < 2.0 * LEAST * most) {
                continue;
            }
            tried += 1;
            let found = qef.solve();
            assert!(!found.clamped && !found.is_mean);
            for axis in 0..3 {
                assert!((found.at[axis] - corner[axis]).abs() < 1e-11, "{found:?} {corner:?}");
            }
        }
    }

    #[test]
    fn along_planes_and_edges_the_mean_decides() {
        let mut qef = Qef::default();
        qef.add([0.25, 0.5, 0.0], Some([1.0, 0.0, 0.0]));
        qef.add([0.25, 0.25, 1.0], Some([1.0, 0.0, 0.0]));
        assert_eq!(qef.solve(), Minimum { at: [0.25, 0.375, 0.5], clamped: false, is_mean: false });
        qef.add([1.0, 0.75, 0.5], Some([0.0, 1.0, 0.0]));
        let found = qef.solve().at;
        assert!((found[0] - 0.25).abs() + (found[1] - 0.75).abs() + (found[2] - 0.5).abs() < 1e-14);
        // Points without planes contribute to the mean only.
        let mut qef = Qef::default();
        qef.add([1.0, 0.0, 0.0], None);
        qef.add([0.0, 0.5, 0.0], None);
        assert_eq!(qef.solve(), Minimum { at: [0.5, 0.25, 0.0], clamped: false, is_mean: true });
        qef.add([0.5, 0.0, 0.75], Some([0.0, 0.0, 1.0]));
        assert!((qef.solve().at[2] - 0.75).abs() < 1e-14);
    }

    /// The result in the cube is at least as good as many other places, by the same function.
    #[test]
    fn outside_minima_come_to_the_best_place_of_the_cube() {
        let mut random = Random(3);
        let mut tried = 0;
        while tried < 300 {
            let mut qef = Qef::default();
            for _ in 0..4 {
                let point = [0.0; 3].map(|_: f64| random.unit());
                qef.add(point, Some(any_normal(&mut random)));
            }
            let found = qef.solve();
            assert!(found.at.iter().all(|c| (0.0..=1.0).contains(c)), "{found:?}");
            let (values, _) = eigen(qef.matrix);
            let most = values.iter().fold(0.0, |a: f64, &b| a.max(b));
            if !found.clamped || values.iter().any(|&value| value < LEAST * most) {
                continue;
            }
            tried += 1;
            let error = |x: [f64; 3]| dot(x, multiplied(&qef.matrix, x)) - 2.0 * dot(qef.right, x);
            let best = error(found.at);
            for i in 0..12 * 12 * 12 {
                let place = [i % 12, i / 12 % 12, i / 144].map(|k| f64::from(k) / 11.0);
                assert!(error(place) >= best - 1e-12, "{found:?} {place:?}");
            }
        }
    }
}
