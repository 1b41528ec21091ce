//! The twenty-six directions from a cell to its neighbours.

use crate::lattice::Each;

/// A step of at most one cell along each axis, and along at least one axis. One axis leads through a face of
/// a cell, two axes through an edge, three through a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Direction([i8; 3]);

impl Direction {
    /// All directions: first the 6 through faces, then the 12 through edges, then the 8 through vertices. So
    /// `ALL[..6]`, `ALL[..18]` and `ALL` are the usual neighbourhoods.
    pub const ALL: [Direction; 26] = {
        let mut all = [Direction([0; 3]); 26];
        let (mut count, mut axes) = (0, 1);
        while axes <= 3 {
            let mut code = 0;
            while code < 27 {
                let step = [code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1];
                if (step[0] * step[0] + step[1] * step[1] + step[2] * step[2]) as usize == axes {
                    all[count] = Direction(step);
                    count += 1;
                }
                code += 1;
            }
            axes += 1;
        }
        all
    };

    /// The directions through faces: −z, −y, −x, +x, +y, +z.
    pub const FACES: [Direction; 6] = {
        let [a, b, c, d, e, f, ..] = Direction::ALL;
        [a, b, c, d, e, f]
    };

    /// Returns the direction with these steps along x, y and z; `None` unless each is −1, 0 or 1, and at
    /// least one is not 0.
    pub fn new(steps: [i8; 3]) -> Option<Direction> {
        let one_at_most = steps.iter().all(|step| (-1..=1).contains(step));
        (one_at_most && steps != [0; 3]).then_some(Direction(steps))
    }

    /// Returns the steps along x, y and z: −1, 0 or 1.
    pub fn steps(self) -> [i8; 3] {
        self.0
    }

    /// Returns the opposite direction.
    #[must_use]
    pub fn opposite(self) -> Direction {
        Direction(self.0.each(|step| -step))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_then_edges_then_vertices() {
        let axes = Direction::ALL.map(|direction| direction.0.iter().filter(|&&step| step != 0).count());
        assert!(axes[..6].iter().all(|&n| n == 1) && axes[6..18].iter().all(|&n| n == 2));
        assert!(axes[18..].iter().all(|&n| n == 3));
        for (i, direction) in Direction::ALL.iter().enumerate() {
            assert_eq!(Direction::new(direction.steps()), Some(*direction));
            assert_eq!(Direction::ALL.iter().position(|other| other == direction), Some(i));
            assert_eq!(direction.opposite().steps(), direction.steps().map(|step| -step));
        }
        assert_eq!(Direction::FACES[0].steps(), [0, 0, -1]);
        assert_eq!(Direction::FACES[5].steps(), [0, 0, 1]);
        assert_eq!((Direction::new([0; 3]), Direction::new([2, 0, 0])), (None, None));
    }
}
