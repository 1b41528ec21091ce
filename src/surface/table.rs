//! The marching-cubes table, computed when the library is compiled.
//!
//! A *dual cell* is a cube between eight samples. Its *configuration* is a byte with one bit for each corner
//! that lies inside. The surface crosses the *cut* edges of the cube: the edges with one end inside. Each cut
//! edge has a vertex.
//!
//! **One rule for faces.** On each face of the cube, every run of inside corners is cut off by one segment.
//! So two inside corners at the ends of a face's diagonal are separated there, and the two outside corners
//! are joined. The rule depends on the face only, so that both cells at a face have the same segments.
//! (Lorensen and Cline 1987 rotated fifteen cases and their complements, and left holes between them: Dürst
//! 1988.)
//!
//! **Loops.** Each cut edge begins one segment and ends one. The segments form loops, and each loop bounds
//! one disc. So inside samples are connected by faces of voxels (6-connected), outside samples by faces and
//! edges (18-connected). This is the pair (6, 18): Lachaud and Montanvert, *Continuous analogs of digital
//! boundaries*, 2000. The face rule alone also allows the pair (6, 26): then two outside corners at the ends
//! of a body diagonal, in a cube whose other corners lie inside, are joined by a tunnel. Walls of two voxels
//! across a body diagonal would be full of tunnels, so this table has no tunnels.
//!
//! **Triangles.** A loop is cut into triangles by diagonals, none of which lies in a face of the cube. A
//! diagonal in a face could also be an edge of the neighbouring cell's triangles, and four triangles would
//! meet on it. With this restriction every edge of the mesh belongs to exactly two triangles, in opposite
//! directions, for any samples. Each loop of each configuration allows such triangles; this is checked when
//! the table is made. Among the allowed triangulations, the one with the shortest diagonals is taken.
//!
//! Corner k lies at (k & 1, k >> 1 & 1, k >> 2 & 1). Edge 4 a + p runs along axis a; the bits of p are its
//! place on the other two axes, the lower axis first.

/// The greatest number of triangles of a configuration.
pub(super) const MOST: usize = 5;

/// The triangles of a configuration, as numbers of edges or corners. Only the first `count` are valid.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Triangles {
    pub count: u8,
    pub corners: [[u8; 3]; MOST],
}

impl Triangles {
    pub const NONE: Triangles = Triangles { count: 0, corners: [[0; 3]; MOST] };

    /// The triangles.
    #[inline(always)]
    pub fn list(&self) -> &[[u8; 3]] {
        &self.corners[..(self.count as usize).min(MOST)]
    }
}

/// The triangles of each configuration, with edges of the cube as their corners; counter-clockwise as seen
/// from outside.
pub(super) static MARCHING_CUBES: [Triangles; 256] = TABLE;

/// [`MARCHING_CUBES`] as a constant, for other tables.
pub(super) const TABLE: [Triangles; 256] = marching_cubes();

/// The other two axes of each axis, in ascending order.
pub(super) const OTHERS: [[usize; 2]; 3] = [[1, 2], [0, 2], [0, 1]];

/// The corners at the lower and the upper end of each edge.
pub(super) const ENDS: [[u8; 2]; 12] = {
    let mut ends = [[0; 2]; 12];
    let mut e = 0;
    while e < 12 {
        let (axis, p) = (e / 4, e % 4);
        let [b, c] = OTHERS[axis];
        let lower = (p & 1) << b | (p >> 1) << c;
        ends[e] = [lower as u8, (lower | 1 << axis) as u8];
        e += 1;
    }
    ends
};

/// The corners of each face, counter-clockwise as seen from outside the cube: −x, +x, −y, +y, −z, +z.
const FACES: [[u8; 4]; 6] = {
    let mut faces = [[0; 4]; 6];
    let mut face = 0;
    while face < 6 {
        let (axis, side) = (face / 2, face % 2);
        // Seen from above, the two axes that follow in cyclic order turn counter-clockwise.
        let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        let base = side << axis;
        let (second, last) = if side == 1 { (u, v) } else { (v, u) };
        faces[face] = [base, base | second, base | u | v, base | last];
        face += 1;
    }
    let mut result = [[0; 4]; 6];
    let mut i = 0;
    while i < 24 {
        result[i / 4][i % 4] = faces[i / 4][i % 4] as u8;
        i += 1;
    }
    result
};

/// The edge between two corners.
const fn edge_between(a: u8, b: u8) -> usize {
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    let mut e = 0;
    while e < 12 {
        if ENDS[e][0] == low && ENDS[e][1] == high {
            return e;
        }
        e += 1;
    }
    panic!("the corners are not beside each other")
}

/// The two faces that contain each edge, as bits.
const FACES_AT: [u8; 12] = {
    let mut at = [0; 12];
    let mut i = 0;
    while i < 24 {
        let (face, k) = (i / 4, i % 4);
        at[edge_between(FACES[face][k], FACES[face][(k + 1) % 4])] |= 1 << face;
        i += 1;
    }
    at
};

/// No edge.
pub(super) const NONE: u8 = u8::MAX;

/// For each cut edge, the edge at which the segment that begins there ends.
pub(super) const fn successors(configuration: usize) -> [u8; 12] {
    let mut next = [NONE; 12];
    let mut face = 0;
    while face < 6 {
        let corners = FACES[face];
        let mut k = 0;
        while k < 4 {
            if !is_inside(configuration, corners[k]) && is_inside(configuration, corners[(k + 1) % 4]) {
                // A run of inside corners begins here. The segment leads to the end of the run.
                let mut end = k + 1;
                while is_inside(configuration, corners[(end + 1) % 4]) {
                    end += 1;
                }
                let from = edge_between(corners[k], corners[(k + 1) % 4]);
                next[from] = edge_between(corners[end % 4], corners[(end + 1) % 4]) as u8;
            }
            k += 1;
        }
        face += 1;
    }
    next
}

const fn is_inside(configuration: usize, corner: u8) -> bool {
    configuration >> corner & 1 != 0
}

/// The square of the distance between the middles of two edges, in quarters.
const fn distance(a: u8, b: u8) -> u32 {
    let mut sum = 0;
    let mut axis = 0;
    while axis < 3 {
        let mut difference = 0i32;
        let mut end = 0;
        while end < 2 {
            difference += (ENDS[a as usize][end] >> axis & 1) as i32;
            difference -= (ENDS[b as usize][end] >> axis & 1) as i32;
            end += 1;
        }
        sum += (difference * difference) as u32;
        axis += 1;
    }
    sum
}

/// A number greater than any sum of diagonals.
const FORBIDDEN: u32 = 1 << 20;

/// A loop of cut edges.
struct Loop {
    edges: [u8; 12],
    len: usize,
}

/// Triangulates the edges `first..=last` of a loop with the least sum of diagonals. Returns that sum, and for
/// each pair the third corner of the triangle on it. (Klincsek 1980: minimal triangulations of polygons.)
const fn best(polygon: &Loop) -> (u32, [[usize; 12]; 12]) {
    let (mut cost, mut apex) = ([[0u32; 12]; 12], [[0; 12]; 12]);
    let mut width = 2;
    while width < polygon.len {
        let mut first = 0;
        while first + width < polygon.len {
            let last = first + width;
            let (mut least, mut k) = (u32::MAX, first + 1);
            while k < last {
                let sum = cost[first][k] + cost[k][last];
                if sum < least {
                    (least, apex[first][last]) = (sum, k);
                }
                k += 1;
            }
            let closing = first == 0 && last + 1 == polygon.len;
            if !closing {
                let (a, b) = (polygon.edges[first], polygon.edges[last]);
                let in_face = FACES_AT[a as usize] & FACES_AT[b as usize] != 0;
                least += if in_face { FORBIDDEN } else { distance(a, b) };
            }
            cost[first][last] = least;
            first += 1;
        }
        width += 1;
    }
    (cost[0][polygon.len - 1], apex)
}

/// Appends the triangles between the edges `first..=last` of a loop.
const fn append(
    mut result: Triangles,
    polygon: &Loop,
    apex: &[[usize; 12]; 12],
    first: usize,
    last: usize,
) -> Triangles {
    if first + 1 < last {
        let k = apex[first][last];
        result.corners[result.count as usize] = [polygon.edges[first], polygon.edges[k], polygon.edges[last]];
        result.count += 1;
        result = append(result, polygon, apex, first, k);
        result = append(result, polygon, apex, k, last);
    }
    result
}

const fn triangles(configuration: usize) -> Triangles {
    let mut next = successors(configuration);
    let mut result = Triangles::NONE;
    let mut start = 0;
    while start < 12 {
        if next[start] != NONE {
            let mut polygon = Loop { edges: [0; 12], len: 0 };
            let mut edge = start;
            while next[edge] != NONE {
                polygon.edges[polygon.len] = edge as u8;
                polygon.len += 1;
                let after = next[edge] as usize;
                next[edge] = NONE;
                edge = after;
            }
            let (cost, apex) = best(&polygon);
            assert!(cost < FORBIDDEN, "a loop has no triangles without diagonals in a face");
            result = append(result, &polygon, &apex, 0, polygon.len - 1);
        }
        start += 1;
    }
    result
}

const fn marching_cubes() -> [Triangles; 256] {
    let mut table = [Triangles::NONE; 256];
    let mut configuration = 0;
    while configuration < 256 {
        table[configuration] = triangles(configuration);
        configuration += 1;
    }
    table
}
