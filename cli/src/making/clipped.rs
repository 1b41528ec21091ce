//! Boxes and triangles cut by clip planes: the points that a camera is fitted to.

use leafless::Bounds;

/// Half-spaces a x + b y + c z + d ≥ 0. Points that lie in all of them are kept.
#[derive(Default)]
pub struct Planes(Vec<[f64; 4]>);

/// Returns the signed position of a point relative to a plane; points that are not negative are kept.
fn height([a, b, c, d]: [f64; 4], [x, y, z]: [f64; 3]) -> f64 {
    a * x + b * y + c * z + d
}

impl Planes {
    /// Returns the half-spaces of the planes, and of the sides of the box.
    pub fn new(planes: &[[f64; 4]], kept: Option<&Bounds>) -> Planes {
        Planes(planes.iter().copied().chain(kept.into_iter().flat_map(sides)).collect())
    }

    /// Appends the corners of the kept part of a triangle.
    pub fn of_triangle(&self, corners: [[f64; 3]; 3], points: &mut Vec<[f64; 3]>) {
        let mut polygon = corners.to_vec();
        for &plane in &self.0 {
            let heights: Vec<f64> = polygon.iter().map(|&point| height(plane, point)).collect();
            if heights.iter().all(|&height| height >= 0.0) {
                continue;
            }
            let mut kept = Vec::with_capacity(polygon.len() + 1);
            for (i, (&from, &low)) in polygon.iter().zip(&heights).enumerate() {
                let next = (i + 1) % polygon.len();
                let (to, high) = (polygon[next], heights[next]);
                if low >= 0.0 {
                    kept.push(from);
                }
                if (low >= 0.0) != (high >= 0.0) {
                    let share = low / (low - high);
                    kept.push([0, 1, 2].map(|axis| from[axis] + (to[axis] - from[axis]) * share));
                }
            }
            polygon = kept;
        }
        points.append(&mut polygon);
    }

    /// Appends the corners of the kept part of a box.
    pub fn of_box(&self, bounds: &Bounds, points: &mut Vec<[f64; 3]>) {
        let corners = bounds.corners();
        let mut cutting = Vec::new();
        for &plane in &self.0 {
            let kept = corners.iter().filter(|&&corner| height(plane, corner) >= 0.0).count();
            match kept {
                0 => return,
                8 => {}
                _ => cutting.push(plane),
            }
        }
        if cutting.is_empty() {
            return points.extend(corners);
        }
        // A corner is a common point of three planes that all others keep.
        cutting.extend(sides(bounds));
        let size = (0..3).map(|axis| bounds.max[axis] - bounds.min[axis]).fold(0.0, f64::max);
        let slack = |[a, b, c, _]: [f64; 4]| -1e-9 * size * (a.abs() + b.abs() + c.abs());
        for i in 0..cutting.len() {
            for j in 0..i {
                for k in 0..j {
                    let Some(point) = common_point([cutting[i], cutting[j], cutting[k]]) else { continue };
                    if cutting.iter().all(|&plane| height(plane, point) >= slack(plane)) {
                        points.push(point);
                    }
                }
            }
        }
    }
}

/// Returns the half-spaces whose intersection is a box.
fn sides(bounds: &Bounds) -> [[f64; 4]; 6] {
    let unit = |axis: usize, sign: f64, offset: f64| {
        let [x, y, z] = [0, 1, 2].map(|i| if i == axis { sign } else { 0.0 });
        [x, y, z, offset]
    };
    std::array::from_fn(|i| match i % 2 {
        0 => unit(i / 2, 1.0, -bounds.min[i / 2]),
        _ => unit(i / 2, -1.0, bounds.max[i / 2]),
    })
}

/// Returns the intersection point of three planes, if it is a single point.
fn common_point(planes: [[f64; 4]; 3]) -> Option<[f64; 3]> {
    let cross = |u: [f64; 4], v: [f64; 4]| {
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    };
    let [p, q, r] = planes;
    let (qr, rp, pq) = (cross(q, r), cross(r, p), cross(p, q));
    let determinant = (0..3).map(|axis| p[axis] * qr[axis]).sum::<f64>();
    let point = [0, 1, 2].map(|i| -(p[3] * qr[i] + q[3] * rp[i] + r[3] * pq[i]) / determinant);
    point.iter().all(|x| x.is_finite()).then_some(point)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(points: &[[f64; 3]]) -> [[f64; 3]; 2] {
        let end = |start: f64, choose: fn(f64, f64) -> f64| {
            [0, 1, 2].map(|axis| points.iter().map(|point| point[axis]).fold(start, choose))
        };
        [end(f64::INFINITY, f64::min), end(f64::NEG_INFINITY, f64::max)]
    }

    #[test]
    fn corners_of_what_is_left() {
        let bounds = Bounds::new([0.0; 3], [4.0, 2.0, 2.0]).unwrap();
        let of = |planes: &[[f64; 4]], kept: Option<&Bounds>| {
            let mut points = Vec::new();
            Planes::new(planes, kept).of_box(&bounds, &mut points);
            points
        };
        assert_eq!(of(&[], None).len(), 8);
        assert_eq!(around(&of(&[[1.0, 0.0, 0.0, -3.0]], None)), [[3.0, 0.0, 0.0], [4.0, 2.0, 2.0]]);
        assert!(of(&[[1.0, 0.0, 0.0, -5.0]], None).is_empty());
        // A corner that lies inside the box.
        let inner = Bounds::new([1.0; 3], [1.5; 3]).unwrap();
        assert_eq!(around(&of(&[], Some(&inner))), [[1.0; 3], [1.5; 3]]);
        // x + y ≤ 2.
        assert_eq!(around(&of(&[[-1.0, -1.0, 0.0, 2.0]], None)), [[0.0; 3], [2.0; 3]]);
        let mut points = Vec::new();
        let planes = Planes::new(&[[1.0, 0.0, 0.0, -1.0]], None);
        planes.of_triangle([[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]], &mut points);
        assert_eq!(around(&points), [[1.0, 0.0, 0.0], [4.0, 3.0, 0.0]]);
    }
}
