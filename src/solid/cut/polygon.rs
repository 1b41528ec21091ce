//! What a plane and a cube have in common, seen along an axis: a polygon in a square.

/// A square that two faces of the cube and two planes cut.
const CORNERS: usize = 8;

/// A linear function of x and y, positive on one side of a line.
#[derive(Clone, Copy)]
pub(super) struct Line {
    pub(super) slope: [f64; 2],
    pub(super) constant: f64,
    /// The line is where a plane meets a face, and the function what the face allows: so much is taken of it along z.
    pub(super) rise: f64,
}

impl Line {
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
    /// The part of the square where no line is negative; `None` if rounding makes more corners than there is place
    /// for.
    pub(super) fn new(lines: impl Iterator<Item = Line>) -> Option<Polygon> {
        let mut corners = [[0.0; 2]; CORNERS];
        (corners[0], corners[1], corners[2], corners[3]) =
            ([-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]);
        let mut polygon = Polygon { corners, count: 4 };
        for line in lines {
            polygon.clip(&line)?;
        }
        Some(polygon)
    }

    /// Counter-clockwise.
    pub(super) fn corners(&self) -> &[[f64; 2]] {
        &self.corners[..self.count]
    }

    fn clip(&mut self, line: &Line) -> Option<()> {
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

    /// The mean of the corners, and those of x², y² and x y about it; `None` if there is no polygon.
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

    /// The lower and the upper corner of the rectangle around.
    pub(super) fn bounds(&self) -> [[f64; 2]; 2] {
        self.corners().iter().fold([[1.0; 2], [-1.0; 2]], |[low, high], corner| {
            [[0, 1].map(|i| low[i].min(corner[i])), [0, 1].map(|i| high[i].max(corner[i]))]
        })
    }
}
