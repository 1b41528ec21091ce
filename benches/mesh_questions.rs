//! Queries of a triangle mesh, the same for Leafless and its peers: rays and points at random. All numbers
//! are rounded to single precision, so that all programs receive the same numbers. `peers/mesh_queries.h`
//! makes the same queries in C.

type Vector = [f64; 3];

/// A ray: its origin, and its direction of length 1 up to rounding.
pub type Line = [[f32; 3]; 2];

/// splitmix64.
struct Random(u64);

impl Random {
    /// Returns a number in [0, 1).
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ z >> 31) >> 11) as f64 / 9007199254740992.0
    }

    fn in_box(&mut self, min: Vector, max: Vector) -> Vector {
        [0, 1, 2].map(|axis| min[axis] + self.share() * (max[axis] - min[axis]))
    }

    /// Returns a uniformly distributed direction: that of a point of the unit ball.
    fn direction(&mut self) -> Vector {
        loop {
            let v = [0; 3].map(|_| 2.0 * self.share() - 1.0);
            let length = length(v);
            if (1e-3..=1.0).contains(&length) {
                return v.map(|c| c / length);
            }
        }
    }
}

fn length(v: Vector) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

fn line(from: Vector, along: Vector) -> Line {
    [from, along].map(|v| v.map(|c| c as f32))
}

/// Rays from the sphere of 1.5 diagonals around the box to points of the box.
pub fn rays_from_afar(min: Vector, max: Vector, count: usize) -> Vec<Line> {
    let mut random = Random(1);
    let extent = [0, 1, 2].map(|axis| max[axis] - min[axis]);
    let radius = 1.5 * length(extent);
    let ray = |_| {
        let (direction, to) = (random.direction(), random.in_box(min, max));
        let from = [0, 1, 2].map(|axis| min[axis] + 0.5 * extent[axis] + radius * direction[axis]);
        let along = [0, 1, 2].map(|axis| to[axis] - from[axis]);
        let length = length(along);
        line(from, along.map(|c| c / length))
    };
    (0..count).map(ray).collect()
}

/// Rays from points of the box, in any direction.
pub fn rays_from_within(min: Vector, max: Vector, count: usize) -> Vec<Line> {
    let mut random = Random(2);
    (0..count).map(|_| line(random.in_box(min, max), random.direction())).collect()
}

/// Points of the box.
pub fn points_within(min: Vector, max: Vector, count: usize) -> Vec<[f32; 3]> {
    let mut random = Random(3);
    (0..count).map(|_| random.in_box(min, max).map(|c| c as f32)).collect()
}

/// Returns the sum of the numbers' bits, which shows whether queries are the same.
pub fn sum_of_bits<'a>(numbers: impl IntoIterator<Item = &'a f32>) -> u64 {
    numbers.into_iter().map(|number| number.to_bits() as u64).sum()
}
