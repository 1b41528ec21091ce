//! The tables of simple marching cubes, made from that of marching cubes when the library is compiled.
//!
//! Each vertex on a cut edge moves to one end of the edge, either always the outer or always the inner one.
//! Triangles whose corners then coincide are dropped. All other triangles have one of 13 directions of
//! normals up to sign, with components −1, 0 and 1, because this holds for any three corners of a cube.

use super::table::{ENDS, TABLE, Triangles};

/// A table of simple marching cubes.
pub(super) struct Snapped {
    /// The triangles of each configuration, with corners of the cube as their corners; counter-clockwise as
    /// seen from outside.
    pub triangles: [Triangles; 256],
    /// The corners that the triangles use, as bits.
    pub used: [u8; 256],
}

/// Vertices at the outer ends of edges.
pub(super) static FAT: Snapped = snapped(false);
/// Vertices at the inner ends of edges.
pub(super) static THIN: Snapped = snapped(true);

const fn snapped(to_inside: bool) -> Snapped {
    let mut table = Snapped { triangles: [Triangles::NONE; 256], used: [0; 256] };
    let mut configuration = 0;
    while configuration < 256 {
        let from = &TABLE[configuration];
        let mut result = Triangles::NONE;
        let (mut i, mut used) = (0, 0);
        while i < from.count as usize {
            let mut corners = [0; 3];
            let mut k = 0;
            while k < 3 {
                let [low, high] = ENDS[from.corners[i][k] as usize];
                corners[k] = if (configuration >> low & 1 != 0) == to_inside { low } else { high };
                k += 1;
            }
            let [a, b, c] = corners;
            if a != b && b != c && c != a {
                result.corners[result.count as usize] = corners;
                result.count += 1;
                used |= 1 << a | 1 << b | 1 << c;
            }
            i += 1;
        }
        table.triangles[configuration] = result;
        table.used[configuration] = used;
        configuration += 1;
    }
    table
}

#[cfg(test)]
mod tests {
    use super::super::table::{MARCHING_CUBES, MOST};
    use super::*;

    #[test]
    fn snapped_triangles_are_those_of_marching_cubes() {
        for (table, inner) in [(&FAT, false), (&THIN, true)] {
            for configuration in 0..256usize {
                let is_inside = |corner: u8| configuration >> corner & 1 == 1;
                let moved = MARCHING_CUBES[configuration].list().iter().map(|triangle| {
                    triangle.map(|edge| {
                        ENDS[edge as usize].into_iter().find(|&end| is_inside(end) == inner).unwrap()
                    })
                });
                let expected: alloc::vec::Vec<_> =
                    moved.filter(|[a, b, c]| a != b && b != c && c != a).collect();
                let found = table.triangles[configuration].list();
                assert_eq!(found, expected);
                assert!(found.len() <= MOST);
                let used = found.iter().flatten().fold(0, |used, corner| used | 1u8 << corner);
                assert_eq!(table.used[configuration], used);
                for triangle in found {
                    let place = |corner: u8| [0, 1, 2].map(|axis| i32::from(corner >> axis & 1));
                    let [p, q, r] = triangle.map(place);
                    let (u, v) = ([0, 1, 2].map(|k| q[k] - p[k]), [0, 1, 2].map(|k| r[k] - p[k]));
                    let normal =
                        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
                    assert!(normal != [0; 3] && normal.iter().all(|n| (-1..=1).contains(n)));
                }
            }
        }
    }
}
