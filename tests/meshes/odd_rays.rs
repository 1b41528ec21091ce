//! Rays that pierce an open mesh an odd number of times, against a ray-by-ray count in integers.

use leafless::{Control, Error, FillRule, Frame, MeshSolid, TriangleMesh};
use leafless_testkit::Random;

/// Cells along an axis. Their centres are (2 k + 1) / 2.
const CELLS: i32 = 16;

fn frame() -> Frame {
    Frame::new([0.0; 3], f64::from(CELLS), 4).unwrap()
}

fn odd_rays(mesh: TriangleMesh) -> [u64; 3] {
    let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
    solid.odd_rays(&frame(), &Control::default()).unwrap()
}

/// The count by its definition: each ray against each triangle. Vertices are multiples of 1/2, at most 64
/// from the origin.
///
/// In units of 2^-51, differences are multiples of 2^50 below 2^59, and determinants multiples of 2^100. The
/// shift along x adds less than 2^99 to a determinant, so that it decides only zero determinants. A nonzero
/// contribution is at least 2^88, and the shift along y adds less than 2^85; and so on.
fn one_by_one(mesh: &TriangleMesh) -> [u64; 3] {
    let scaled = |x: f64| {
        let doubled = 2.0 * x;
        assert!(doubled == doubled.round() && doubled.abs() < 128.0);
        (doubled as i128) << 50
    };
    let shift = [1i128 << 38, 1 << 25, 1 << 12];
    let centre = |axis: usize, k: i32| (i128::from(2 * k + 1) << 50) + shift[axis];
    [0, 1, 2].map(|axis| {
        let [u, v] = [[1, 2], [0, 2], [0, 1]][axis];
        let mut odd = 0;
        for row in 0..CELLS {
            for column in 0..CELLS {
                let at = [centre(u, column), centre(v, row)];
                let pierces = |triangle: &&[u32; 3]| {
                    let corners = triangle.map(|vertex| {
                        let vertex = mesh.vertices()[vertex as usize];
                        [scaled(vertex[u]) - at[0], scaled(vertex[v]) - at[1]]
                    });
                    let sides = [0, 1, 2].map(|i| {
                        let ([a, b], [c, d]) = (corners[i], corners[(i + 1) % 3]);
                        (a * d - b * c).signum()
                    });
                    sides == [1; 3] || sides == [-1; 3]
                };
                odd += u64::from(mesh.triangles().iter().filter(pierces).count() % 2 == 1);
            }
        }
        odd
    })
}

/// The octahedron |x − 8| + |y − 8| + |z − 8| = 8 without its first triangles. Its edges run through centres.
fn octahedron(without: usize) -> TriangleMesh {
    let vertices = (0..6).map(|i| {
        [0, 1, 2].map(|axis| 8.0 + if axis == i / 2 { if i % 2 == 0 { 8.0 } else { -8.0 } } else { 0.0 })
    });
    let triangles = (0..8u32).map(|octant| {
        let [x, y, z] = [0, 1, 2].map(|axis| 2 * axis + (octant >> axis & 1));
        if octant.count_ones() % 2 == 0 { [x, y, z] } else { [x, z, y] }
    });
    TriangleMesh::new(vertices.collect(), triangles.skip(without).collect()).unwrap()
}

#[test]
fn a_closed_mesh_has_none() {
    assert_eq!(odd_rays(octahedron(0)), [0; 3]);
    assert_eq!(one_by_one(&octahedron(0)), [0; 3]);
}

/// Each projection of the missing face is the triangle of the centres with i + j + 1 ≤ 8. The shift moves the
/// centres on the hypotenuse out of the triangle.
#[test]
fn a_missing_face_makes_the_rays_through_it_odd() {
    let found = odd_rays(octahedron(1));
    assert_eq!(found, [28; 3]);
    assert_eq!(found, one_by_one(&octahedron(1)));
    for without in 2..7 {
        assert_eq!(odd_rays(octahedron(without)), one_by_one(&octahedron(without)), "without {without}");
    }
}

/// Triangles anywhere, also outside the universe. Many corners lie on rays, and many edges on rows.
#[test]
fn any_triangles() {
    let mut random = Random(7);
    let mut odd = 0;
    for case in 0..200 {
        let vertices = (0..12).map(|_| [(); 3].map(|()| random.below(65) as f64 / 2.0 - 8.0)).collect();
        let triangles = (0..1 + case % 20).map(|_| [(); 3].map(|()| random.below(12) as u32)).collect();
        let mesh = TriangleMesh::new(vertices, triangles).unwrap();
        if mesh.triangles().is_empty() {
            continue;
        }
        let expected = one_by_one(&mesh);
        assert_eq!(odd_rays(mesh), expected, "case {case}");
        odd += u64::from(expected != [0; 3]);
    }
    assert!(odd > 150);
}

/// A plate covers more rows than the bits of one pass hold.
#[test]
fn a_wide_frame_is_counted_in_several_passes() {
    let mut vertices = vec![];
    for corner in 0..4 {
        vertices.push([f64::from(corner % 2) * 3.0 - 1.0, f64::from(corner / 2) * 3.0 - 1.0, 0.25]);
    }
    let plate = TriangleMesh::new(vertices, vec![[0, 1, 3], [0, 3, 2]]).unwrap();
    let solid = MeshSolid::new(plate, FillRule::NonZero).unwrap();
    for depth in [6, 14] {
        let frame = Frame::new([0.0; 3], 1.0, depth).unwrap();
        let odd = solid.odd_rays(&frame, &Control::default()).unwrap();
        // Rays along x and y at the plate's height would lie in the plate.
        assert_eq!(odd, [0, 0, 1 << (2 * depth)], "depth {depth}");
    }
}

#[test]
fn it_can_be_cancelled() {
    let solid = MeshSolid::new(octahedron(1), FillRule::NonZero).unwrap();
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let control = Control { cancel: Some(&cancel), ..Control::default() };
    assert!(matches!(solid.odd_rays(&frame(), &control), Err(Error::Cancelled)));
}
