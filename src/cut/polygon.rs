//! The intersection of a plane with a cube, seen along an axis: a polygon in a square.

use crate::lattice::Each;

/// The greatest number of corners of a square that two faces of the cube and two planes cut.
const CORNERS: usize = 8;

/// A linear function of x and y, positive on one side of a line.
#[derive(Clone, Copy)]
pub(super) struct Line {
    pub(super) slope: [f64; 2],
    pub(super) constant: f64,
    /// The decrease of the function per unit of z. The line is the intersection of a plane with a face, and
    /// the function is the slack of the face's inequality.
    pub(super) rise: f64,
}

impl Line {
    /// The line that bounds the points of the plane z = −(a x + b y + c) on the inner side of n · x ≤ offset;
    /// `axes` are the axes of the cube that are called x, y and z.
    pub(super) fn new(axes: &[usize; 3], [a, b, c]: &[f64; 3], normal: &[f64; 3], offset: f64) -> Line {
        let n = axes.each(|axis| normal[axis]);
        Line { slope: [n[2] * a - n[0], n[2] * b - n[1]], constant: offset + n[2] * c, rise: n[2] }
    }

    #[inline(always)]
    fn at(&self, [x, y]: [f64; 2]) -> f64 {
        (self.slope[0] * x + self.slope[1] * y) + self.constant
    }
}

/// A convex polygon in the square [-1, 1]².
pub(super) struct Polygon {
    corners: [[f64; 2]; CORNERS],
    count: usize,
}

impl Polygon {
    /// The whole square.
    pub(super) const SQUARE: Polygon = {
        let mut corners = [[0.0; 2]; CORNERS];
        (corners[0], corners[1], corners[2], corners[3]) =
            ([-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]);
        Polygon { corners, count: 4 }
    };

    /// The part of the square where no line is negative; `None` if rounding makes more corners than there is
    /// space for.
    pub(super) fn new(lines: impl Iterator<Item = Line>) -> Option<Polygon> {
        let mut polygon = Polygon::SQUARE;
        for line in lines {
            polygon.clip(&line)?;
        }
        Some(polygon)
    }

    /// The corners, counter-clockwise.
    pub(super) fn corners(&self) -> &[[f64; 2]] {
        &self.corners[..self.count]
    }

    /// Keeps the part where the line is not negative; `None` if rounding makes more corners than there is
    /// space for.
    pub(super) fn clip(&mut self, line: &Line) -> Option<()> {
        let mut values = [0.0; CORNERS];
        let mut outside = 0;
        for (value, corner) in values.iter_mut().zip(self.corners()) {
            *value = line.at(*corner);
            outside += (*value < 0.0) as usize;
        }
        if outside == 0 {
            return Some(());
        }
        let mut clipped = Polygon { corners: [[0.0; 2]; CORNERS], count: 0 };
        let mut push = |corner| {
            *clipped.corners.get_mut(clipped.count)? = corner;
            clipped.count += 1;
            Some(())
        };
        let mut previous = self.count.wrapping_sub(1);
        for (k, &to) in self.corners().iter().enumerate() {
            let (a, b) = (values[previous], values[k]);
            if (a < 0.0) != (b < 0.0) {
                let (from, t) = (self.corners[previous], a / (a - b));
                push([from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])])?;
            }
            if b >= 0.0 {
                push(to)?;
            }
            previous = k;
        }
        *self = clipped;
        Some(())
    }

    pub(super) fn area(&self) -> f64 {
        let Some((&[x, y], others)) = self.corners().split_first() else { return 0.0 };
        let cross = |([a, b], [c, d]): (&[f64; 2], &[f64; 2])| (a - x) * (d - y) - (c - x) * (b - y);
        0.5 * others.iter().zip(others.iter().skip(1)).map(cross).sum::<f64>()
    }

    /// The mean of the corners, and the means of x², y² and x y about it; `None` if there is no polygon.
    pub(super) fn spread(&self) -> Option<([f64; 2], [f64; 3])> {
        if self.count < 3 {
            return None;
        }
        let share = 1.0 / self.count as f64;
        let (mut x, mut y) = (0.0, 0.0);
        for corner in self.corners() {
            (x, y) = (x + share * corner[0], y + share * corner[1]);
        }
        let mut squares = [0.0; 3];
        for corner in self.corners() {
            let (dx, dy) = (corner[0] - x, corner[1] - y);
            let terms = [dx * dx, dy * dy, dx * dy];
            squares.iter_mut().zip(terms).for_each(|(sum, term)| *sum += share * term);
        }
        Some(([x, y], squares))
    }

    /// The lower and the upper corner of the bounding rectangle.
    pub(super) fn bounds(&self) -> [[f64; 2]; 2] {
        self.corners().iter().fold([[1.0; 2], [-1.0; 2]], |[low, high], corner| {
            [[0, 1].each(|i| low[i].min(corner[i])), [0, 1].each(|i| high[i].max(corner[i]))]
        })
    }
}
