//! The oracle of the target `measures`: a scene as the bits of unit cells, with integer counts.

use leafless::{Cell, Frame};

/// The first coordinate of the world along each axis.
pub const LOW: i32 = -9;
/// Number of unit cells of the world along each axis. The outermost cells equal the space around the world.
pub const N: i32 = 34;

/// A union of unit cells of the world. The space around the world is one more cell.
#[derive(Clone, PartialEq)]
pub struct Dense {
    pub outside: bool,
    bits: Vec<bool>,
}

fn index(at: [i32; 3]) -> usize {
    ((at[2] * N + at[1]) * N + at[0]) as usize
}

/// All cells of the world, counted from its lower corner.
fn cells() -> impl Iterator<Item = [i32; 3]> {
    (0..N).flat_map(|z| (0..N).flat_map(move |y| (0..N).map(move |x| [x, y, z])))
}

/// Returns the share of a unit cell that lies in an interval along an axis.
fn share(c: i32, low: f64, high: f64) -> f64 {
    let start = f64::from(c + LOW);
    ((start + 1.0).min(high) - start.max(low)).max(0.0)
}

/// Returns the cells whose interiors meet an interval along an axis. Cells outside the world stand for the
/// space around it.
fn met(low: f64, high: f64) -> std::ops::Range<i32> {
    let first = (low.clamp(-100.0, 100.0).floor() as i32 - LOW).max(-1);
    let end = (high.clamp(-100.0, 100.0).ceil() as i32 - LOW).min(N + 1);
    first..end
}

impl Dense {
    pub fn empty() -> Dense {
        Dense { outside: false, bits: vec![false; (N * N * N) as usize] }
    }

    /// A box with integer corners in the world.
    pub fn cuboid(min: [i32; 3], max: [i32; 3]) -> Dense {
        let mut dense = Dense::empty();
        for z in min[2]..max[2] {
            for y in min[1]..max[1] {
                for x in min[0]..max[0] {
                    dense.bits[index([x - LOW, y - LOW, z - LOW])] = true;
                }
            }
        }
        dense
    }

    /// True if a cell, counted from the world's lower corner, is solid.
    pub fn has(&self, at: [i32; 3]) -> bool {
        if at.iter().all(|c| (0..N).contains(c)) { self.bits[index(at)] } else { self.outside }
    }

    /// Returns the bits, x fastest.
    pub fn bits(&self) -> &[bool] {
        &self.bits
    }

    #[must_use]
    pub fn joined(&self, other: &Dense, join: impl Fn(bool, bool) -> bool) -> Dense {
        let bits = self.bits.iter().zip(&other.bits).map(|(&a, &b)| join(a, b)).collect();
        Dense { outside: join(self.outside, other.outside), bits }
    }

    #[must_use]
    pub fn complement(&self) -> Dense {
        self.joined(self, |a, _| !a)
    }

    /// Returns the image under `x ↦ from[axis] of x, mirrored, then moved`; `None` if a part would leave the
    /// world.
    pub fn moved(&self, axes: [usize; 3], mirrored: [bool; 3], by: [i32; 3]) -> Option<Dense> {
        let mut moved = Dense { outside: self.outside, bits: vec![self.outside; self.bits.len()] };
        for at in cells().filter(|&at| self.has(at) != self.outside) {
            let to = [0, 1, 2].map(|axis| {
                let c = at[axes[axis]];
                (if mirrored[axis] { N - 1 - c } else { c }) + by[axis]
            });
            if !to.iter().all(|c| (1..N - 1).contains(c)) {
                return None;
            }
            moved.bits[index(to)] = !self.outside;
        }
        Some(moved)
    }

    /// Returns the parts of a box's cells that are solid: volume and extent of each.
    pub fn parts(&self, min: [f64; 3], max: [f64; 3]) -> impl Iterator<Item = (f64, [[f64; 2]; 3])> + '_ {
        cells_in(min, max).filter(|&at| self.has(at)).map(move |at| {
            let piece = [0, 1, 2].map(|axis| {
                let start = f64::from(at[axis] + LOW);
                [start.max(min[axis]), (start + 1.0).min(max[axis])]
            });
            (piece.iter().map(|[low, high]| high - low).product(), piece)
        })
    }

    /// Returns the volume in a box that lies in the world.
    pub fn volume(&self, [min, max]: [[f64; 3]; 2]) -> f64 {
        self.parts(min, max).map(|(volume, _)| volume).sum()
    }

    /// Returns whether the interiors of the solid and of a box have common points, and whether the box lies
    /// in the solid.
    pub fn in_box(&self, min: [f64; 3], max: [f64; 3]) -> (bool, bool) {
        let mut found = (false, true);
        for at in cells_in(min, max) {
            let has = self.has(at);
            found = (found.0 || has, found.1 && has);
        }
        found
    }

    /// The same for a cell of a frame.
    pub fn in_cell(&self, frame: &Frame, cell: Cell) -> (bool, bool) {
        let edge = frame.edge() / f64::from(1u32 << cell.level);
        let min = [0, 1, 2].map(|axis| frame.origin()[axis] + f64::from(cell.at[axis]) * edge);
        self.in_box(min, min.map(|c| c + edge))
    }

    /// True if all of the solid lies in a box.
    pub fn ends_in(&self, [min, max]: [[f64; 3]; 2]) -> bool {
        !self.outside
            && cells()
                .filter(|&at| self.has(at))
                .all(|at| (0..3).all(|axis| share(at[axis], min[axis], max[axis]) == 1.0))
    }

    /// Returns the area of the faces between different cells, in a closed box and in its interior.
    pub fn area(&self, [min, max]: [[f64; 3]; 2]) -> [f64; 2] {
        let mut area = [0.0; 2];
        for at in cells() {
            for axis in 0..3 {
                let mut next = at;
                next[axis] += 1;
                if self.has(at) == self.has(next) {
                    continue;
                }
                let across = [(axis + 1) % 3, (axis + 2) % 3];
                let face: f64 = across.map(|a| share(at[a], min[a], max[a])).iter().product();
                let plane = f64::from(next[axis] + LOW);
                area[0] += if min[axis] <= plane && plane <= max[axis] { face } else { 0.0 };
                area[1] += if min[axis] < plane && plane < max[axis] { face } else { 0.0 };
            }
        }
        area
    }

    /// Returns the bounding box of the solid's part in a box; `None` if it is empty.
    pub fn extent(&self, [min, max]: [[f64; 3]; 2]) -> Option<[[f64; 3]; 2]> {
        let mut extent: Option<[[f64; 3]; 2]> = None;
        for (_, piece) in self.parts(min, max) {
            let [low, high] = [piece.map(|p| p[0]), piece.map(|p| p[1])];
            let found = extent.get_or_insert([low, high]);
            for axis in 0..3 {
                found[0][axis] = found[0][axis].min(low[axis]);
                found[1][axis] = found[1][axis].max(high[axis]);
            }
        }
        extent
    }

    /// Returns the squared distance of two solids; infinite if one is empty.
    pub fn distance_to(&self, other: &Dense) -> f64 {
        // For each cell, axis by axis: the squared distance from the other solid. A gap is one less than the
        // steps.
        let mut squares: Vec<i32> = other.bits.iter().map(|&bit| if bit { 0 } else { FAR }).collect();
        for axis in 0..3 {
            let stride = N.pow(axis as u32) as usize;
            let mut row = [FAR; N as usize];
            for at in cells().filter(|at| at[axis] == 0) {
                let start = index(at);
                for (i, entry) in row.iter_mut().enumerate() {
                    *entry = squares[start + i * stride];
                }
                for i in 0..N {
                    let gap = |j: i32| ((i - j).abs() - 1).max(0).pow(2);
                    let least = (0..N).map(|j| row[j as usize] + gap(j)).min().unwrap_or(FAR);
                    squares[start + i as usize * stride] = least.min(FAR);
                }
            }
        }
        let found = self.bits.iter().zip(&squares).filter(|(bit, _)| **bit).map(|(_, &d)| d);
        let least = found.min().unwrap_or(FAR);
        match () {
            () if self.outside && other.outside => 0.0,
            () if least >= FAR => f64::INFINITY,
            () => f64::from(least),
        }
    }

    /// Returns the squared distance of a point from the solid; infinite if the solid is empty. The space
    /// around the world equals its outermost cells.
    pub fn distance_from(&self, point: [f64; 3]) -> f64 {
        let away = |at: [i32; 3]| -> f64 {
            let gap = |axis: usize| {
                let start = f64::from(at[axis] + LOW);
                (start - point[axis]).max(point[axis] - start - 1.0).max(0.0)
            };
            (0..3).map(|axis| gap(axis) * gap(axis)).sum()
        };
        let out = (0..3).any(|axis| !(f64::from(LOW)..=f64::from(LOW + N)).contains(&point[axis]));
        if self.outside && out {
            return 0.0;
        }
        cells().filter(|&at| self.has(at)).map(away).fold(f64::INFINITY, f64::min)
    }

    /// Returns whether a point lies in the closed solid, and whether it lies in its interior.
    pub fn at(&self, point: [f64; 3]) -> (bool, bool) {
        let near = |c: f64| if c == c.floor() { [c - 0.5, c + 0.5] } else { [c, c] };
        let mut found = (false, true);
        for corner in 0..8 {
            let at = [0, 1, 2].map(|axis| {
                (near(point[axis])[corner >> axis & 1].clamp(-100.0, 100.0).floor() as i32) - LOW
            });
            let has = self.has(at);
            found = (found.0 || has, found.1 && has);
        }
        found
    }

    /// Returns the boundary's faces as triangles, counter-clockwise from outside. The solid must be bounded.
    pub fn triangles(&self) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for at in cells().filter(|&at| self.has(at)) {
            for axis in 0..3 {
                for upper in [false, true] {
                    let mut next = at;
                    next[axis] += if upper { 1 } else { -1 };
                    if !self.has(next) {
                        let first = vertices.len() as u32;
                        vertices.extend(face(at, axis, upper));
                        triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
                    }
                }
            }
        }
        (vertices, triangles)
    }
}

/// A bound above every squared distance in the world.
const FAR: i32 = 1 << 20;

/// Returns the cells whose interiors meet a box.
fn cells_in(min: [f64; 3], max: [f64; 3]) -> impl Iterator<Item = [i32; 3]> {
    let [xs, ys, zs] = [0, 1, 2].map(|axis| met(min[axis], max[axis]));
    zs.flat_map(move |z| {
        let xs = xs.clone();
        ys.clone().flat_map(move |y| xs.clone().map(move |x| [x, y, z]))
    })
}

/// Returns a face of a cell, counter-clockwise as seen from outside the cell.
fn face(at: [i32; 3], axis: usize, upper: bool) -> [[f64; 3]; 4] {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let around = if upper { [[0, 0], [1, 0], [1, 1], [0, 1]] } else { [[0, 0], [0, 1], [1, 1], [1, 0]] };
    around.map(|[du, dv]| {
        let mut corner = at;
        corner[axis] += i32::from(upper);
        corner[u] += du;
        corner[v] += dv;
        corner.map(|c| f64::from(c + LOW))
    })
}
