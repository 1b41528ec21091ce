//! The loops of each configuration, computed when the library is compiled.
//!
//! In a dual cell the segments on its faces form loops, each of which bounds one disc
//! ([`table`](super::table)). The dual surface has one vertex for each loop, so that sheets that pass through
//! one cell stay separate. (Nielson 2004; Schaefer, Ju and Warren 2007.)

use super::table::{ENDS, NONE, successors};

/// The loops of a configuration.
#[derive(Clone, Copy)]
pub(super) struct Loops {
    /// The number of loops.
    pub count: u8,
    /// The loop through each edge of the cube; [`u8::MAX`] for edges that are not cut.
    pub of_edge: [u8; 12],
    /// The faces in which one loop has two segments: −x, +x, −y, +y, −z, +z as bits.
    pub twice: u8,
}

/// The loops of each configuration, numbered in the order of their lowest edges.
pub(super) static LOOPS: [Loops; 256] = {
    let mut table = [Loops { count: 0, of_edge: [NONE; 12], twice: 0 }; 256];
    let mut configuration = 0;
    while configuration < 256 {
        table[configuration] = loops(configuration);
        configuration += 1;
    }
    table
};

const fn loops(configuration: usize) -> Loops {
    let next = successors(configuration);
    let mut loops = Loops { count: 0, of_edge: [NONE; 12], twice: 0 };
    let mut start = 0;
    while start < 12 {
        if next[start] != NONE && loops.of_edge[start] == NONE {
            let mut edge = start;
            while loops.of_edge[edge] == NONE {
                loops.of_edge[edge] = loops.count;
                edge = next[edge] as usize;
            }
            loops.count += 1;
        }
        start += 1;
    }
    let mut face = 0;
    while face < 6 {
        // A face has two segments if all its four edges are cut.
        let (first, mut is_twice, mut edge) = (edges_of(face)[0], true, 0);
        while edge < 4 {
            let of = loops.of_edge[edges_of(face)[edge]];
            is_twice &= of != NONE && of == loops.of_edge[first];
            edge += 1;
        }
        loops.twice |= (is_twice as u8) << face;
        face += 1;
    }
    loops
}

/// The edges of a face: −x, +x, −y, +y, −z, +z.
const fn edges_of(face: usize) -> [usize; 4] {
    let (axis, side) = (face / 2, face % 2);
    let (mut edges, mut count, mut edge) = ([0; 4], 0, 0);
    while edge < 12 {
        let [low, high] = ENDS[edge];
        if (low >> axis & 1) as usize == side && (high >> axis & 1) as usize == side {
            edges[count] = edge;
            count += 1;
        }
        edge += 1;
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::super::table::MARCHING_CUBES;
    use super::*;

    /// The triangles of marching cubes are connected by edges exactly within loops.
    #[test]
    fn loops_bound_the_discs_of_the_table() {
        for (configuration, loops) in LOOPS.iter().enumerate() {
            let mut edges = 0;
            for (edge, [low, high]) in ENDS.into_iter().enumerate() {
                let is_cut = (configuration >> low ^ configuration >> high) & 1 == 1;
                assert_eq!(loops.of_edge[edge] != NONE, is_cut, "{configuration}");
                edges += usize::from(is_cut);
            }
            let list = MARCHING_CUBES[configuration].list();
            for triangle in list {
                let [a, b, c] = triangle.map(|edge| loops.of_edge[edge as usize]);
                assert!(a == b && b == c && a < loops.count, "{configuration}");
            }
            // A disc of n vertices has n − 2 triangles.
            assert_eq!(list.len(), edges - 2 * usize::from(loops.count), "{configuration}");
        }
        assert_eq!(LOOPS.iter().map(|loops| loops.count).max(), Some(4));
        // The only such configurations: two inside corners of the lower face that are joined through the
        // upper face; and all corners except two opposite ones.
        assert_eq!((LOOPS[0b1011_1001].count, LOOPS[0b1011_1001].twice), (1, 1 << 4));
        assert!(LOOPS.iter().all(|loops| loops.twice == 0 || loops.count < 3));
    }
}
