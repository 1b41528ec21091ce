//! Planes of the lattice, and the configurations that a plane makes.
//!
//! Every triangle of simple marching cubes lies in a plane n·x = d, x in samples, where the components of n
//! are −1, 0 and 1, and d is an integer. There are 26 such normals, 13 up to sign.

use super::simple::Snap;
use crate::lattice::Each;
use crate::lattice::axes;

/// A plane with its outer side. Planes ascend by their normals, then by their offsets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Plane {
    /// The components of the normal plus one, as a number in base 3, x first; 13 for no plane.
    normal: u8,
    offset: i32,
}

impl Plane {
    /// No plane.
    pub const NONE: Plane = Plane { normal: 13, offset: 0 };

    /// The plane through a point.
    pub const fn through(normal: [i32; 3], point: [i32; 3]) -> Plane {
        let offset = normal[0] * point[0] + normal[1] * point[1] + normal[2] * point[2];
        Plane { normal: number(normal), offset }
    }

    pub fn is_none(self) -> bool {
        self.normal == Plane::NONE.normal
    }

    pub fn normal(self) -> [i32; 3] {
        components(self.normal)
    }

    /// The plane moved by `by`.
    pub fn moved(self, by: [i32; 3]) -> Plane {
        let normal = self.normal();
        let offset = (0..3).fold(self.offset, |offset, axis| offset + normal[axis] * by[axis]);
        Plane { normal: self.normal, offset }
    }

    /// The same plane with a canonical side: equal for both sides of a plane.
    pub fn without_side(self) -> Plane {
        match self.normal {
            0..13 => Plane { normal: 26 - self.normal, offset: -self.offset },
            _ => self,
        }
    }

    /// The coordinate on `axis` of the plane's point above `point`; `None` if the plane is parallel to the
    /// axis.
    pub fn above(self, axis: usize, point: [i32; 3]) -> Option<i32> {
        let normal = self.normal();
        let rest = (0..3).filter(|&other| other != axis).map(|other| normal[other] * point[other]);
        // The component is ±1, so it is its own inverse.
        (normal[axis] != 0).then(|| (self.offset - rest.sum::<i32>()) * normal[axis])
    }

    /// The plane as one number. Greater planes have greater numbers.
    pub fn code(self) -> u64 {
        u64::from(self.normal) << 32 | u64::from((self.offset as u32) ^ 1 << 31)
    }

    /// The plane with this number.
    pub fn from_code(code: u64) -> Plane {
        Plane { normal: (code >> 32) as u8, offset: (code as u32 ^ 1 << 31) as i32 }
    }
}

const fn number(normal: [i32; 3]) -> u8 {
    (normal[0] + 1 + 3 * (normal[1] + 1) + 9 * (normal[2] + 1)) as u8
}

const fn components(number: u8) -> [i32; 3] {
    let n = number as i32;
    [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1]
}

/// The place of a corner in a cell.
pub(super) const fn corner(c: u32) -> [i32; 3] {
    [(c & 1) as i32, (c >> 1 & 1) as i32, (c >> 2 & 1) as i32]
}

/// For each configuration the plane of which it is one side: the inside corners are those with n·x < d. 54
/// configurations have such a plane.
static HALF_SPACES: [Plane; 256] = {
    let mut table = [Plane::NONE; 256];
    let mut normal = 0;
    while normal < 27 {
        let n = components(normal);
        let mut offset = -2;
        while offset <= 3 {
            let (mut inside, mut c) = (0, 0);
            while c < 8 {
                let at = corner(c);
                if n[0] * at[0] + n[1] * at[1] + n[2] * at[2] < offset {
                    inside |= 1 << c;
                }
                c += 1;
            }
            if inside != 0 && inside != 255 {
                table[inside] = Plane { normal, offset };
            }
            offset += 1;
        }
        normal += 1;
    }
    table
};

/// The plane that contains all triangles of a *coplanar configuration*; no plane for others. The inside
/// corners of a coplanar configuration are those on one side of the plane. The configuration has no triangle
/// if it meets the plane in a corner or an edge only.
pub(super) fn of_configuration(configuration: usize, snap: Snap) -> Plane {
    let plane = HALF_SPACES[configuration & 255];
    match snap {
        Snap::Thin if !plane.is_none() => Plane { offset: plane.offset - 1, ..plane },
        _ => plane,
    }
}

/// The plane of a triangle whose corners are corners of a cell.
pub(super) fn of_corners(corners: [u8; 3]) -> Plane {
    let [p, q, r] = corners.each(|c| corner(c.into()));
    let (u, v) = (axes(|k| q[k] - p[k]), axes(|k| r[k] - p[k]));
    Plane::through(axes(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]), p)
}

#[cfg(test)]
mod tests {
    use super::super::snapped::{FAT, THIN};
    use super::*;

    /// There are 54 configurations, each with its inside corners on one side, and all its triangles in its
    /// plane.
    #[test]
    fn coplanar_configurations() {
        let mut count = 0;
        for configuration in 1..255 {
            for (snap, table) in [(Snap::Fat, &FAT), (Snap::Thin, &THIN)] {
                let plane = of_configuration(configuration, snap);
                let triangles = table.triangles[configuration].list();
                if plane.is_none() {
                    continue;
                }
                count += 1;
                assert!(triangles.iter().all(|&triangle| of_corners(triangle) == plane));
                assert_eq!(plane.without_side(), plane.without_side().without_side());
                assert_eq!(Plane::from_code(plane.code()), plane);
                for c in 0..8 {
                    let at = corner(c);
                    let normal = plane.normal();
                    let value: i32 = (0..3).map(|axis| normal[axis] * at[axis]).sum();
                    let is_inside = configuration >> c & 1 == 1;
                    assert_eq!(is_inside, value < plane.offset + i32::from(snap == Snap::Thin));
                }
            }
        }
        assert_eq!(count, 2 * 54);
    }

    #[test]
    fn points_above_planes() {
        for normal in (0..27).filter(|&normal| normal != 13).map(components) {
            let (point, by) = ([5, -1, 12], [3, 7, -4]);
            let plane = Plane::through(normal, point);
            for axis in 0..3 {
                let mut beside = point;
                beside[axis] += 9;
                let expected = (normal[axis] != 0).then_some(point[axis]);
                assert_eq!(plane.above(axis, beside), expected);
            }
            assert_eq!(plane.moved(by), Plane::through(normal, axes(|k| point[k] + by[k])));
        }
    }
}
