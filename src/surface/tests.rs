//! Tests of the tables by their definitions, and of meshes against dense arrays.

use super::marching_cubes;
use super::table::{ENDS, MARCHING_CUBES, OTHERS};
use crate::control::{Control, Job};
use crate::lattice::Frame;
use crate::lattice::axes;
use crate::mesh::TriangleMesh;
use crate::octree::writer::Writer;
use crate::octree::{Octree, Planes, Tag};
use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec::Vec;

/// The directed edges of a configuration's triangles without an opposite edge.
fn boundary(configuration: usize) -> BTreeSet<(u8, u8)> {
    let mut edges = BTreeSet::new();
    for &[a, b, c] in MARCHING_CUBES[configuration].list() {
        assert!(a != b && b != c && c != a);
        for edge in [(a, b), (b, c), (c, a)] {
            assert!(edges.insert(edge), "{configuration}: two triangles run along {edge:?}");
        }
    }
    edges.iter().filter(|&&(a, b)| !edges.contains(&(b, a))).copied().collect()
}

/// Returns whether an edge lies in the face of a cube on a side of an axis.
fn is_in_face(edge: u8, axis: usize, side: u8) -> bool {
    ENDS[edge as usize].iter().all(|corner| corner >> axis & 1 == side)
}

#[test]
fn edges_join_corners() {
    for (e, [low, high]) in ENDS.into_iter().enumerate() {
        let axis = e / 4;
        assert_eq!(high ^ low, 1 << axis);
        let place = OTHERS[axis].map(|other| low >> other & 1);
        assert_eq!(e % 4, (place[0] | place[1] << 1) as usize);
    }
}

/// The boundary of each configuration lies in the faces of the cube, and follows the rule there.
#[test]
fn every_face_is_cut_by_the_rule() {
    for configuration in 0..256usize {
        let mut left = boundary(configuration);
        for axis in 0..3 {
            for side in 0..2 {
                let in_face: Vec<_> = left
                    .iter()
                    .filter(|(a, b)| is_in_face(*a, axis, side) && is_in_face(*b, axis, side))
                    .copied()
                    .collect();
                // Each segment has the inside corners of one run on its left, as seen from outside the cube;
                // a single inside corner has both its edges cut.
                let corners: Vec<u8> =
                    (0..8).filter(|c| c >> axis & 1 == side && configuration >> c & 1 == 1).collect();
                let diagonal = corners.len() == 2 && (corners[0] ^ corners[1]).count_ones() == 2;
                let expected = if diagonal { 2 } else { usize::from(!matches!(corners.len(), 0 | 4)) };
                assert_eq!(in_face.len(), expected, "{configuration}");
                if diagonal {
                    for (a, b) in &in_face {
                        let ends = |edge: &u8| BTreeSet::from(ENDS[*edge as usize]);
                        let shared: Vec<u8> = ends(a).intersection(&ends(b)).copied().collect();
                        assert!(shared.len() == 1 && corners.contains(&shared[0]), "{configuration}");
                    }
                }
                in_face.iter().for_each(|edge| _ = left.remove(edge));
            }
        }
        assert!(left.is_empty(), "{configuration}: {left:?}");
    }
}

/// The segments of one cell on a face are those of its neighbour there, in the opposite direction.
#[test]
fn neighbours_fit_together() {
    for axis in 0..3 {
        let mirrored = |edge: u8| {
            let [low, high] = ENDS[edge as usize].map(|corner| corner ^ 1 << axis);
            ENDS.iter().position(|&ends| ends == [low, high]).unwrap() as u8
        };
        // By the samples of the common face: the segments of the lower cell there, and those of the upper
        // one.
        let mut seen: BTreeMap<Vec<bool>, BTreeSet<(u8, u8)>> = BTreeMap::new();
        for configuration in 0..256usize {
            for side in 0..2u8 {
                let face: Vec<u8> = (0..8u8).filter(|corner| corner >> axis & 1 == side).collect();
                let samples = face.iter().map(|corner| configuration >> corner & 1 == 1).collect();
                let mut segments: BTreeSet<_> = boundary(configuration);
                segments.retain(|&(a, b)| is_in_face(a, axis, side) && is_in_face(b, axis, side));
                if side == 1 {
                    segments = segments.into_iter().map(|(a, b)| (mirrored(b), mirrored(a))).collect();
                }
                let before = seen.entry(samples).or_insert_with(|| segments.clone());
                assert_eq!(*before, segments, "{configuration}");
            }
        }
        assert_eq!(seen.len(), 16);
    }
}

/// No diagonal lies in a face of the cube, each vertex is on a cut edge, and the outside is on the correct
/// side.
#[test]
fn diagonals_lie_within() {
    let middle = |edge: u8| {
        let [a, b] = ENDS[edge as usize];
        axes(|axis| i32::from((a >> axis & 1) + (b >> axis & 1)))
    };
    for configuration in 0..256usize {
        let outline = boundary(configuration);
        let cut: BTreeSet<u8> = (0..12u8)
            .filter(|&e| ENDS[e as usize].map(|corner| configuration >> corner & 1)[..] != [0, 0][..])
            .filter(|&e| ENDS[e as usize].map(|corner| configuration >> corner & 1)[..] != [1, 1][..])
            .collect();
        let mut used = BTreeSet::new();
        for triangle in MARCHING_CUBES[configuration].list() {
            used.extend(*triangle);
            let [a, b, c] = *triangle;
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let inner = !outline.contains(&(from, to));
                let shared = (0..6u8).any(|face| {
                    is_in_face(from, face as usize / 2, face % 2)
                        && is_in_face(to, face as usize / 2, face % 2)
                });
                assert!(!(inner && shared), "{configuration}: a diagonal lies in a face");
            }
            let [p, q, r] = triangle.map(middle);
            let minus = |a: [i32; 3], b: [i32; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
            let (u, v) = (minus(q, p), minus(r, p));
            let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            assert_ne!(normal, [0; 3], "{configuration}: a triangle has no area");
        }
        assert_eq!(used, cut, "{configuration}");
        // Vertices, edges and faces of discs: one disc for each loop.
        let triangles = MARCHING_CUBES[configuration].list().len();
        assert_eq!(triangles, cut.len() - 2 * loops(&outline), "{configuration}");
    }
}

fn loops(outline: &BTreeSet<(u8, u8)>) -> usize {
    let mut next: BTreeMap<u8, u8> = outline.iter().copied().collect();
    assert_eq!(next.len(), outline.len());
    let mut count = 0;
    while let Some((&start, _)) = next.iter().next() {
        let mut at = start;
        while let Some(after) = next.remove(&at) {
            at = after;
        }
        assert_eq!(at, start);
        count += 1;
    }
    count
}

/// One corner inside, one outside: the triangle faces away from the inside.
#[test]
fn triangles_face_outward() {
    assert_eq!(MARCHING_CUBES[1].list(), [[0, 4, 8]]);
    let [a, b, c] = MARCHING_CUBES[254].list()[0];
    assert!([[0, 8, 4], [8, 4, 0], [4, 0, 8]].contains(&[a, b, c]));
}

/// A random bitmap of `edge` samples per axis, somewhere in an octree of this depth; each bit is set with a
/// chance of `chance` in 256.
fn bitmap(depth: u8, edge: u32, chance: u64, state: &mut u64) -> Vec<bool> {
    let n = 1u32 << depth;
    let mut random = || {
        *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        *state >> 33
    };
    let from = [0; 3].map(|_: u32| (random() % u64::from(n - edge + 1)) as u32);
    (0..n * n * n)
        .map(|i| {
            let at = [i % n, i / n % n, i / n / n];
            (0..3).all(|axis| (from[axis]..from[axis] + edge).contains(&at[axis])) && random() % 256 < chance
        })
        .collect()
}

/// The octree of a bitmap, on the frame whose cells are units.
fn octree(depth: u8, bits: &[bool]) -> Octree {
    let n = 1usize << depth;
    let frame = Frame::new([0.0; 3], n as f64, depth).unwrap();
    let control = Control::threads(1);
    let job = Job::new(&control);
    let mut writer = Writer::new(&job, depth, true);
    let full = |at: [u32; 3]| {
        at.iter().all(|&a| a < n as u32) && bits[at[0] as usize + n * (at[1] as usize + n * at[2] as usize)]
    };
    fn write(
        e: usize,
        at: [u32; 3],
        levels: usize,
        full: &dyn Fn([u32; 3]) -> bool,
        writer: &mut Writer<'_>,
    ) -> Tag {
        let mut planes = Planes::uniform(Tag::Empty);
        for c in 0..64 {
            let place = crate::lattice::morton::position(c);
            let child = axes(|axis| 4 * at[axis] + place[axis]);
            let tag = match (e + 1 == levels, full(child)) {
                (true, false) => Tag::Empty,
                (true, true) => Tag::Full,
                _ => write(e + 1, child, levels, full, writer),
            };
            planes.set(c, tag);
        }
        writer.put(e, planes).unwrap()
    }
    let root = write(0, [0; 3], usize::from(depth).div_ceil(2), &full, &mut writer);
    writer.finish(frame, root, Tag::Empty).unwrap()
}

/// Twelve times the volume of each configuration in a cube of edge 2 around the origin, by the divergence
/// theorem: its triangles, and its part of the faces.
fn volumes() -> Vec<i32> {
    let middle = |edge: u8| {
        let [a, b] = ENDS[edge as usize];
        axes(|axis| i32::from((a >> axis & 1) + (b >> axis & 1)) - 1)
    };
    (0..256usize)
        .map(|configuration| {
            let mut sum = 0;
            for triangle in MARCHING_CUBES[configuration].list() {
                let [p, q, r] = triangle.map(middle);
                let cross = [q[1] * r[2] - q[2] * r[1], q[2] * r[0] - q[0] * r[2], q[0] * r[1] - q[1] * r[0]];
                sum += 2 * (p[0] * cross[0] + p[1] * cross[1] + p[2] * cross[2]);
            }
            for axis in 0..3 {
                for side in 0..2u8 {
                    let face = (0..8u8).filter(|c| c >> axis & 1 == side);
                    let inside: Vec<u8> = face.filter(|c| configuration >> c & 1 == 1).collect();
                    let diagonal = inside.len() == 2 && (inside[0] ^ inside[1]).count_ones() == 2;
                    // Eighths of the face.
                    let area = if diagonal { 2 } else { [0, 1, 4, 7, 8][inside.len()] };
                    sum += 4 * area / 2;
                }
            }
            sum
        })
        .collect()
}

type Facet = [[i64; 3]; 3];

/// The triangles of marching cubes in half cells, cell by cell of a dense array, and twelve times their
/// volume in eighths of cells.
fn dense(depth: u8, bits: &[bool], volumes: &[i32]) -> (Vec<Facet>, i64) {
    let n = 1i64 << depth;
    let inside = |at: [i64; 3]| {
        at.iter().all(|a| (0..n).contains(a)) && bits[(at[0] + n * (at[1] + n * at[2])) as usize]
    };
    let (mut facets, mut volume) = (Vec::new(), 0);
    for i in 0..(n + 1).pow(3) {
        let at = [i % (n + 1) - 1, i / (n + 1) % (n + 1) - 1, i / (n + 1) / (n + 1) - 1];
        let corner = |k: u8| axes(|axis| at[axis] + i64::from(k >> axis & 1));
        let configuration = (0..8u8).fold(0, |sum, k| sum | usize::from(inside(corner(k))) << k);
        volume += i64::from(volumes[configuration]);
        facets.extend(MARCHING_CUBES[configuration].list().iter().map(|triangle| {
            triangle.map(|edge| {
                let [a, b] = ENDS[edge as usize].map(corner);
                axes(|axis| a[axis] + b[axis] + 1)
            })
        }));
    }
    (facets, volume)
}

/// The facets, rotated so that each begins with its least corner, sorted.
fn sorted(mut facets: Vec<Facet>) -> Vec<Facet> {
    for facet in &mut facets {
        let least = (0..3).min_by_key(|&k| facet[k]).unwrap();
        facet.rotate_left(least);
    }
    facets.sort_unstable();
    facets
}

fn facets_of(mesh: &TriangleMesh) -> Vec<Facet> {
    let in_halves = |v: u32| mesh.vertices()[v as usize].map(|x| (2.0 * x) as i64);
    mesh.triangles().iter().map(|triangle| triangle.map(in_halves)).collect()
}

#[test]
fn marching_cubes_agrees_with_a_dense_array() {
    let volumes = volumes();
    assert_eq!((volumes[0], volumes[1], volumes[255]), (0, 2, 96));
    let mut state = 3;
    for (depth, edge, rounds) in
        [(1, 2, 200), (2, 4, 200), (3, 5, 200), (3, 8, 100), (4, 16, 20), (5, 32, 4), (5, 9, 8)]
    {
        for round in 0..rounds {
            let bits = bitmap(depth, edge, [128, 20, 235, 60][round % 4], &mut state);
            let tree = octree(depth, &bits);
            let mesh = marching_cubes(tree.view(), None, &Control::threads(1)).unwrap();
            let (expected, volume) = dense(depth, &bits, &volumes);
            assert_eq!(sorted(facets_of(&mesh)), sorted(expected));
            assert!((mesh.volume() - volume as f64 / 96.0).abs() < 1e-9 * (1.0 + volume as f64));
            let places: BTreeSet<_> = mesh.vertices().iter().map(|v| v.map(f64::to_bits)).collect();
            let used: BTreeSet<_> = mesh.triangles().iter().flatten().collect();
            assert_eq!((places.len(), used.len()), (mesh.vertices().len(), mesh.vertices().len()));
        }
    }
}
