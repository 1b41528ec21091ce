//! Reports about meshes, and the places of their defects, against the definitions.

use leafless::TriangleMesh;
use leafless::mesh::{DefectKind, MeshDefect, MeshReport};
use leafless_testkit::Random;
use std::collections::{BTreeMap, BTreeSet};

/// A unit cube from `low`, as twelve triangles.
fn cube(low: [f64; 3]) -> Vec<[[f64; 3]; 3]> {
    let corner = |k: usize| [0, 1, 2].map(|axis| low[axis] + f64::from((k >> axis & 1) as u8));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let facets = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    facets.map(|facet| facet.map(corner)).collect()
}

fn turned(facets: &[[[f64; 3]; 3]]) -> Vec<[[f64; 3]; 3]> {
    facets.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

fn mesh(facets: &[Vec<[[f64; 3]; 3]>]) -> TriangleMesh {
    TriangleMesh::from_facets(facets.concat()).unwrap()
}

/// Returns the counts that depend on the mesh alone, and not on its construction.
fn counts(mesh: &TriangleMesh) -> [u64; 10] {
    let MeshReport {
        boundary_edges,
        boundary_loops,
        misoriented_edges,
        non_manifold_edges,
        duplicate,
        opposite,
        flat,
        bodies,
        open_bodies,
        inside_out_bodies,
        ..
    } = mesh.report().unwrap();
    [
        boundary_edges,
        boundary_loops,
        misoriented_edges,
        non_manifold_edges,
        duplicate,
        opposite,
        flat,
        bodies,
        open_bodies,
        inside_out_bodies,
    ]
}

#[test]
fn known_meshes() {
    let a = cube([0.0; 3]);
    let b = cube([5.0, 0.0, 0.0]);
    assert_eq!(counts(&mesh(std::slice::from_ref(&a))), [0, 0, 0, 0, 0, 0, 0, 1, 0, 0]);
    assert_eq!(counts(&mesh(&[a.clone(), turned(&b)])), [0, 0, 0, 0, 0, 0, 0, 2, 0, 1]);
    // Two holes: a triangle's and a square's, in different sides.
    let holed = a[1..10].to_vec();
    assert_eq!(counts(&mesh(&[holed.clone(), b.clone()])), [7, 2, 0, 0, 0, 0, 0, 2, 1, 0]);
    // The two triangles that meet only in a corner: two loops, and not one in the shape of an eight.
    let corner = [&a[1..6], &a[7..]].concat();
    assert_eq!(counts(&mesh(&[corner])), [6, 2, 0, 0, 0, 0, 0, 1, 1, 0]);
    // One facet inverted.
    let mut one = a.clone();
    one[0].swap(0, 1);
    assert_eq!(counts(&mesh(&[one])), [0, 0, 3, 0, 0, 0, 0, 1, 1, 0]);
    // One facet twice, three times, and once more with reversed orientation.
    let again = |facets: &[[[f64; 3]; 3]]| counts(&mesh(&[a.clone(), facets.to_vec()]));
    assert_eq!(again(&a[..1]), [3, 1, 0, 3, 1, 0, 0, 1, 1, 0]);
    assert_eq!(again(&[a[0], a[0]]), [0, 0, 3, 3, 2, 0, 0, 1, 1, 0]);
    assert_eq!(again(&turned(&a[..1])), [3, 1, 0, 3, 0, 1, 0, 1, 1, 0]);
    assert_eq!(again(&[a[0], turned(&a)[0]]), [0, 0, 0, 3, 1, 1, 0, 1, 0, 0]);
    // Walls without thickness enclose nothing, and are not inside out.
    for k in 0..12 {
        let [x, y, z] = a[k];
        for wall in [vec![[x, y, z], [y, x, z]], vec![[y, z, x], [x, z, y]]] {
            let wall = TriangleMesh::from_facets(wall).unwrap();
            let wall = wall.transformed(|p| p.map(|x| x * 0.1 + 0.7)).unwrap();
            assert_eq!(counts(&wall), [0, 0, 0, 0, 0, 1, 0, 1, 0, 0]);
        }
    }
    // A facet without area that closes a T.
    let [p, q, r] = a[0];
    let middle = [0, 1, 2].map(|axis| (p[axis] + q[axis]) / 2.0);
    let split = [vec![[p, middle, r], [middle, q, r], [p, q, middle]], a[1..].to_vec()].concat();
    assert_eq!(counts(&mesh(&[split])), [0, 0, 0, 0, 0, 0, 1, 1, 0, 0]);
    assert_eq!(counts(&TriangleMesh::new(vec![], vec![]).unwrap()), [0; 10]);
    // Two cubes that share an edge, and two that share a corner.
    assert_eq!(counts(&mesh(&[a.clone(), cube([1.0, 1.0, 0.0])])), [0, 0, 0, 1, 0, 0, 0, 1, 0, 0]);
    assert_eq!(counts(&mesh(&[a.clone(), cube([1.0, 1.0, 1.0])])), [0, 0, 0, 0, 0, 0, 0, 2, 0, 0]);
}

/// An axis-aligned block, as twelve triangles.
fn block(low: [f64; 3], high: [f64; 3]) -> Vec<[[f64; 3]; 3]> {
    let place = |p: [f64; 3]| [0, 1, 2].map(|axis| if p[axis] == 0.0 { low[axis] } else { high[axis] });
    cube([0.0; 3]).into_iter().map(|facet| facet.map(place)).collect()
}

/// Returns the number of bodies that overlap, and the number of bodies that may.
fn overlapping(facets: &[Vec<[[f64; 3]; 3]>]) -> [u64; 2] {
    let report = mesh(facets).report().unwrap();
    [report.overlapping_bodies, report.undecided_bodies]
}

#[test]
fn bodies_that_overlap() {
    let centred = |half: f64| block([-half; 3], [half; 3]);
    let [one, two, three, four] = [1.0, 2.0, 3.0, 4.0].map(centred);
    let moved = |offset: [f64; 3]| cube([0, 1, 2].map(|axis| offset[axis] - 1.0));
    let base = cube([-1.0; 3]);
    assert_eq!(overlapping(&[base.clone(), moved([0.5, 0.25, 0.125])]), [2, 0]);
    // With sides in common planes.
    assert_eq!(overlapping(&[base.clone(), moved([0.5, 0.0, 0.0])]), [2, 0]);
    assert_eq!(overlapping(&[base.clone(), moved([0.5, 0.5, 0.0])]), [2, 0]);
    // Edges that go through the other one's diagonals.
    assert_eq!(overlapping(&[base.clone(), moved([0.5, 0.5, 0.5])]), [2, 0]);
    // Apart, and side by side.
    assert_eq!(overlapping(&[base.clone(), moved([5.0, 0.0, 0.0])]), [0, 0]);
    assert_eq!(overlapping(&[base.clone(), moved([1.0, 0.25, 0.25])]), [0, 0]);
    assert_eq!(overlapping(&[base.clone(), moved([1.0, 1.0, 1.0])]), [0, 0]);
    // Inside, with the same and with reversed orientation.
    assert_eq!(overlapping(&[one.clone(), two.clone()]), [2, 0]);
    assert_eq!(overlapping(&[turned(&one), turned(&two)]), [2, 0]);
    assert_eq!(overlapping(&[turned(&one), two.clone()]), [0, 0]);
    assert_eq!(overlapping(&[one.clone(), turned(&two), three.clone()]), [0, 0]);
    // All but the cavity.
    assert_eq!(overlapping(&[one.clone(), turned(&two), three.clone(), four.clone()]), [3, 0]);
    assert_eq!(overlapping(&[one.clone(), two.clone(), three.clone()]), [3, 0]);
    // A cavity that leaves its body.
    assert_eq!(overlapping(&[two.clone(), turned(&cube([1.5; 3]))]), [2, 0]);
    // A sixth of a cube that counts twice: three of its faces lie in the cube's.
    let [o, x, y, z] =
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|p| p.map(|c| c / 2.0));
    let corner = vec![[o, y, x], [o, x, z], [x, y, z], [y, o, z]];
    assert_eq!(overlapping(&[cube([0.0; 3]), corner.clone()]), [2, 0]);
    assert_eq!(overlapping(&[cube([0.0; 3]), turned(&corner)]), [0, 0]);
    // A peg that fits into a cavity exactly. Signs alone do not decide this case.
    let peg = block([-1.0, -1.0, -0.5], [1.0, 1.0, 0.5]);
    assert_eq!(overlapping(&[two.clone(), turned(&one), peg]), [0, 2]);
    // Open bodies are not examined for overlaps.
    assert_eq!(overlapping(&[two[1..].to_vec(), one.clone()]), [0, 0]);
    // Far away, where coordinates are rounded.
    let far = |facets: &[[[f64; 3]; 3]]| -> Vec<[[f64; 3]; 3]> {
        facets.iter().map(|facet| facet.map(|p| p.map(|c| c * 1e-3 + 1e9))).collect()
    };
    assert_eq!(overlapping(&[far(&two), far(&one)]), [2, 0]);
    assert_eq!(overlapping(&[far(&two), far(&turned(&one))]), [0, 0]);
}

/// A block whose sides are grids of `count` squares along each edge.
fn divided(low: [f64; 3], high: [f64; 3], count: u32) -> Vec<[[f64; 3]; 3]> {
    let mut facets = vec![];
    for [a, b, c] in block(low, high).chunks_exact(2).map(|pair| pair[0]) {
        // The corner with the right angle comes first.
        let right = |[p, q, r]: &[[f64; 3]; 3]| (0..3).all(|k| (q[k] - p[k]) * (r[k] - p[k]) == 0.0);
        let corners = [[a, b, c], [b, c, a], [c, a, b]];
        let [origin, one, two] = corners.into_iter().find(right).unwrap();
        let at = |i: u32, j: u32| {
            let share = |k: u32| f64::from(k) / f64::from(count);
            [0, 1, 2].map(|axis| {
                let way = |end: [f64; 3], k| {
                    if k == count { end[axis] - origin[axis] } else { (end[axis] - origin[axis]) * share(k) }
                };
                origin[axis] + way(one, i) + way(two, j)
            })
        };
        for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
            let [p, q, r, s] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            facets.extend([[p, q, r], [p, r, s]]);
        }
    }
    facets
}

/// Hundreds of bodies inside one body of many triangles. Each is decided without an examination of all
/// triangles of the large body.
#[test]
fn many_bodies_in_a_large_one() {
    let outer = divided([0.0; 3], [64.0; 3], 64);
    assert_eq!(outer.len(), 12 * 64 * 64);
    let place = |k: u32| [k % 10, k / 10 % 10, k / 100].map(|k| 2.0 + 6.0 * f64::from(k));
    let small = |k: u32, size: f64| block(place(k), place(k).map(|x| x + size));
    let all = |inner: &mut dyn Iterator<Item = Vec<[[f64; 3]; 3]>>| {
        let mut facets = vec![outer.clone()];
        facets.extend(inner);
        overlapping(&facets)
    };
    // Cavities, bodies, and bodies in cavities.
    assert_eq!(all(&mut (0..1000).map(|k| turned(&small(k, 2.0)))), [0, 0]);
    assert_eq!(all(&mut (0..1000).map(|k| small(k, 2.0))), [1001, 0]);
    let nested =
        |k: u32| [turned(&small(k, 2.0)), block(place(k).map(|x| x + 0.5), place(k).map(|x| x + 1.5))];
    assert_eq!(all(&mut (0..1000).flat_map(nested)), [0, 0]);
    // Ten in a row reach through the outer surface, and ten are outside of it.
    let moved = |k: u32, by: f64| {
        let [x, y, z] = place(k);
        vec![block([x + by, y, z], [x + by + 2.0, y + 2.0, z + 2.0])]
    };
    let row = |k: u32| k.is_multiple_of(10) && k < 100;
    let crossing = |k: u32| if row(k) { moved(k, -3.0) } else { vec![turned(&small(k, 2.0))] };
    assert_eq!(all(&mut (0..1000).flat_map(crossing)), [11, 0]);
    let outside = |k: u32| if row(k) { moved(k, -5.0) } else { vec![turned(&small(k, 2.0))] };
    assert_eq!(all(&mut (0..1000).flat_map(outside)), [0, 0]);
    // On its surface from inside, where corners lie on edges, and away from the others.
    let touching = |k: u32| if row(k) { vec![turned(&moved(k, -2.0)[0])] } else { vec![] };
    assert_eq!(all(&mut (0..1000).flat_map(touching)), [0, 0]);
}

/// Blocks with integer coordinates, where a cell-by-cell count decides everything.
#[test]
fn random_blocks_that_overlap() {
    let mut random = Random(3);
    let (mut sure, mut clear, mut open) = (0, 0, 0);
    for _ in 0..3000 {
        let count = 2 + random.below(4) as usize;
        let size = 3 + random.below(5);
        let mut blocks = vec![];
        while blocks.len() < count {
            let ends = [0; 3].map(|_| [0; 2].map(|_| random.below(size) as u32));
            if ends.iter().all(|[a, b]| a != b) {
                let sense = if random.below(3) == 0 { -1 } else { 1 };
                blocks.push((ends.map(|[a, b]| a.min(b)), ends.map(|[a, b]| a.max(b)), sense));
            }
        }
        let facets: Vec<_> = (blocks.iter())
            .map(|&(low, high, sense)| {
                let facets = block(low.map(f64::from), high.map(f64::from));
                if sense > 0 { facets } else { turned(&facets) }
            })
            .collect();
        let report = mesh(&facets).report().unwrap();
        // Blocks with a common edge are one body.
        if report.bodies != count as u64 || report.opposite > 0 {
            continue;
        }
        let within = |(l, h, _): ([u32; 3], [u32; 3], i32), (low, high, _): ([u32; 3], [u32; 3], i32)| {
            (0..3).all(|axis| low[axis] <= l[axis] && h[axis] <= high[axis])
        };
        let meet = |(l, h, _): ([u32; 3], [u32; 3], i32), (low, high, _): ([u32; 3], [u32; 3], i32)| {
            (0..3).all(|axis| low[axis] < h[axis] && l[axis] < high[axis])
        };
        let mut overlap = vec![false; count];
        for k in 0..count {
            let around: i32 =
                (0..count).filter(|&j| j != k && within(blocks[k], blocks[j])).map(|j| blocks[j].2).sum();
            for j in (0..count).filter(|&j| j != k && meet(blocks[k], blocks[j])) {
                let is_crossing = !within(blocks[k], blocks[j]) && !within(blocks[j], blocks[k]);
                let is_nested =
                    within(blocks[k], blocks[j]) && blocks[j].2 == blocks[k].2 && around * blocks[k].2 > 0;
                if is_crossing || is_nested {
                    (overlap[j], overlap[k]) = (true, true);
                }
            }
        }
        let expected = overlap.iter().filter(|&&overlap| overlap).count() as u64;
        let (proven, possible) = (report.overlapping_bodies, report.undecided_bodies);
        assert!(proven <= expected && expected <= proven + possible, "{blocks:?}: {expected}, {report:?}");
        sure += proven;
        clear += u64::from(possible == 0 && expected == 0);
        open += possible;
    }
    assert!(sure > 2000 && clear > 200 && open < sure / 20, "{sure} {clear} {open}");
}

#[test]
fn faces_that_are_not_flat() {
    use leafless::exchange::read_obj;
    let report = |z: f64, more: &str| {
        // A square with one corner lifted, a flat square, and a triangle.
        let text = format!(
            "v 0 0 0\nv 2 0 0\nv 2 2 {z}\nv 0 2 0\nv 4 0 0\nv 4 2 0\n{more}f 1 2 3 4\nf 2 5 6 3\nf 1 2 5\nf 1 2 5 5\n"
        );
        let mesh = read_obj(text.as_bytes()).unwrap();
        let report = mesh.report().unwrap();
        assert_eq!(mesh.clone().sewn().unwrap().report().unwrap().polygons, report.polygons);
        // A moved mesh is another surface, of triangles.
        assert_eq!(mesh.transformed(|p| p).unwrap().report().unwrap().polygons, 0);
        (report.polygons, report.bent_polygons, report.polygon_deviation)
    };
    assert_eq!(report(0.0, ""), (3, 0, 0.0));
    // The plane of a square with the heights 0, 0, z, 0 lies z/4 from its corners, above and below, up to the
    // tilt.
    let (polygons, bent, deviation) = report(0.25, "");
    assert_eq!((polygons, bent), (3, 2));
    assert!((deviation - 0.0625).abs() < 0.001, "{deviation}");
    let (_, bent, deviation) = report(1e-9, "");
    assert!(bent == 2 && (deviation - 0.25e-9).abs() < 1e-15, "{bent} {deviation}");
    assert_eq!(report(1e-14, "").1, 0);
}

#[test]
fn the_order_of_questions_does_not_matter() {
    let facets = [cube([0.0; 3])[1..].to_vec(), turned(&cube([3.0; 3]))].concat();
    let [first, second] = [(); 2].map(|()| TriangleMesh::from_facets(&facets).unwrap());
    let report = first.report().unwrap();
    assert!(second.check_closed(leafless::FillRule::NonZero).is_err());
    assert_eq!(second.report().unwrap(), report);
    assert_eq!(second.clone().report().unwrap(), report);
    // A mesh made from another mesh is examined anew.
    let closed = second.transformed(|[x, y, z]| [x, y, 3.0 * f64::from(z >= 3.0)]).unwrap();
    assert_ne!(closed.report().unwrap(), report);
}

#[test]
fn known_places() {
    let a = cube([0.0; 3]);
    let mut far = cube([10.0, 20.0, 30.0]);
    // A hole of one triangle, one of two, and an inverted facet elsewhere.
    far.remove(0);
    let holed = [&a[..4], &a[6..]].concat();
    let mut odd = cube([50.0; 3]);
    odd[7].swap(1, 2);
    let soup = mesh(&[far, holed, odd, cube([-5.0; 3]), cube([-5.0; 3])]);
    let defects = soup.defects(100).unwrap();
    let shapes: Vec<_> = defects.iter().map(|d| (d.kind, d.count, d.bounds)).collect();
    use DefectKind::*;
    assert_eq!(
        shapes,
        [
            // Both are equally large. The one with four edges comes first.
            (Hole, 4, ([0.0, 0.0, 0.0], [1.0, 0.0, 1.0])),
            (Hole, 3, ([10.0, 20.0, 30.0], [11.0, 21.0, 30.0])),
            (Misoriented, 3, ([50.0, 51.0, 50.0], [51.0, 51.0, 51.0])),
            (Duplicate, 12, ([-5.0; 3], [-4.0; 3])),
            (NonManifold, 18, ([-5.0; 3], [-4.0; 3])),
        ]
    );
    assert_eq!(defects[0].length, 4.0);
    assert!((defects[1].length - (2.0 + 2f64.sqrt())).abs() < 1e-15);
    assert_eq!((defects[3].length, defects[3].extent()), (0.0, 1.0));
    for limit in 0..7 {
        assert_eq!(soup.defects(limit).unwrap(), defects[..limit.min(5)]);
    }
    assert_eq!(mesh(&[a]).defects(9).unwrap(), []);
}

/// Returns all sets of items that are connected by common vertices.
fn clusters(items: &[Vec<u32>]) -> Vec<Vec<usize>> {
    let mut label: Vec<usize> = (0..items.len()).collect();
    loop {
        let mut changed = false;
        for i in 0..items.len() {
            for j in 0..items.len() {
                if label[j] < label[i] && items[i].iter().any(|v| items[j].contains(v)) {
                    label[i] = label[j];
                    changed = true;
                }
            }
        }
        if !changed {
            break;
        }
    }
    let sets = (0..items.len()).map(|set| (0..items.len()).filter(|&i| label[i] == set).collect());
    sets.filter(|set: &Vec<usize>| !set.is_empty()).collect()
}

/// The triangles that use an edge, each with whether it runs from the edge's lower vertex to the higher one.
type Uses = Vec<(usize, bool)>;

/// Returns the report's counts, and the defects except holes, by their definitions.
fn slow(mesh: &TriangleMesh) -> ([u64; 10], Vec<MeshDefect>) {
    let (vertices, triangles) = (mesh.vertices(), mesh.triangles());
    let mut edges: BTreeMap<(u32, u32), Uses> = BTreeMap::new();
    let mut sets: BTreeMap<Vec<u32>, [Vec<usize>; 2]> = BTreeMap::new();
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        for (x, y) in [(a, b), (b, c), (c, a)] {
            edges.entry((x.min(y), x.max(y))).or_default().push((t, x < y));
        }
        let mut sorted = vec![a, b, c];
        sorted.sort();
        let even = [[a, b, c], [b, c, a], [c, a, b]].contains(&[sorted[0], sorted[1], sorted[2]]);
        sets.entry(sorted).or_default()[usize::from(even)].push(t);
    }
    let excess = |uses: &Uses| 2 * uses.iter().filter(|u| u.1).count() as i64 - uses.len() as i64;
    let pick = |test: &dyn Fn(&Uses) -> bool| -> Vec<Vec<u32>> {
        edges.iter().filter(|(_, uses)| test(uses)).map(|(&(a, b), _)| vec![a, b]).collect()
    };
    let open = pick(&|uses| uses.len() % 2 == 1);
    let misoriented = pick(&|uses| uses.len() % 2 == 0 && excess(uses) != 0);
    let non_manifold = pick(&|uses| uses.len() > 2);
    let (mut duplicate, mut opposite, mut repeated) = (0, 0, vec![]);
    for (corners, [back, forth]) in &sets {
        duplicate += back.len().max(1) + forth.len().max(1) - 2;
        opposite += back.len().min(forth.len());
        repeated.extend(std::iter::repeat_n(corners.clone(), back.len() + forth.len() - 1));
    }
    // Coordinates are small integers.
    let cross = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| vertices[v as usize]);
        let [u, v]: [[f64; 3]; 2] = [b, c].map(|p| std::array::from_fn(|k| p[k] - a[k]));
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    };
    let flat: Vec<Vec<u32>> = triangles.iter().filter(|t| cross(t) == [0.0; 3]).map(|t| t.to_vec()).collect();
    // Bodies are connected over edges.
    let of_edges = |t: &[u32; 3]| -> Vec<u32> {
        let number = |a: u32, b: u32| edges.keys().position(|&k| k == (a.min(b), a.max(b))).unwrap() as u32;
        vec![number(t[0], t[1]), number(t[1], t[2]), number(t[2], t[0])]
    };
    let bodies = clusters(&triangles.iter().map(of_edges).collect::<Vec<_>>());
    let (mut open_bodies, mut inside_out) = (0, 0);
    for body in &bodies {
        let torn = |uses: &Uses| excess(uses) != 0 && uses.iter().any(|u| body.contains(&u.0));
        if edges.values().any(torn) {
            open_bodies += 1;
        } else {
            let volume = |&t: &usize| {
                let a = vertices[triangles[t][0] as usize];
                cross(&triangles[t]).iter().zip(a).map(|(n, a)| n * a).sum::<f64>()
            };
            inside_out += u64::from(body.iter().map(volume).sum::<f64>() < 0.0);
        }
    }
    let mut defects = vec![];
    for (kind, items) in [
        (DefectKind::Misoriented, &misoriented),
        (DefectKind::Duplicate, &repeated),
        (DefectKind::NonManifold, &non_manifold),
        (DefectKind::Flat, &flat),
    ] {
        for set in clusters(items) {
            defects.push(defect(vertices, kind, &set.iter().map(|&i| items[i].clone()).collect::<Vec<_>>()));
        }
    }
    let counts = [
        open.len(),
        0,
        misoriented.len(),
        non_manifold.len(),
        duplicate,
        opposite,
        flat.len(),
        bodies.len(),
        open_bodies,
        inside_out as usize,
    ];
    (counts.map(|count| count as u64), defects)
}

fn defect(vertices: &[[f64; 3]], kind: DefectKind, items: &[Vec<u32>]) -> MeshDefect {
    let places: Vec<[f64; 3]> = items.iter().flatten().map(|&v| vertices[v as usize]).collect();
    let extreme = |pick: fn(f64, f64) -> f64| {
        [0, 1, 2].map(|axis| places.iter().map(|p| p[axis]).reduce(pick).unwrap())
    };
    let length = |item: &Vec<u32>| match item[..] {
        [a, b] => {
            let [a, b] = [a, b].map(|v| vertices[v as usize]);
            (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
        }
        _ => 0.0,
    };
    let length = items.iter().map(length).sum();
    MeshDefect { kind, bounds: (extreme(f64::min), extreme(f64::max)), count: items.len() as u64, length }
}

#[test]
fn random_soups_agree_with_the_definitions() {
    let mut random = Random(5);
    let (mut seen, mut holes) = (BTreeSet::new(), 0);
    for round in 0..600 {
        let size = 2 + round % 3;
        let corner = |random: &mut Random| [0; 3].map(|_: i32| random.below(size) as f64);
        let mut facets: Vec<[[f64; 3]; 3]> = (0..1 + random.below(30))
            .map(|_| [corner(&mut random), corner(&mut random), corner(&mut random)])
            .collect();
        if round % 2 == 0 {
            // Closed bodies with little damage.
            facets.truncate(random.below(3) as usize);
            for _ in 0..1 + random.below(4) {
                let at = [0; 3].map(|_: i32| random.below(4) as f64);
                facets.extend(if random.below(2) == 0 { cube(at) } else { turned(&cube(at)) });
            }
            if random.below(2) == 0 {
                facets.remove(random.index(facets.len()));
            }
        }
        let mesh = TriangleMesh::from_facets(&facets).unwrap();
        let (mut expected, mut others) = slow(&mesh);
        let defects = mesh.defects(usize::MAX).unwrap();
        // Each hole is a closed walk, and together the holes contain all open edges.
        let loops: Vec<_> = defects.iter().filter(|d| d.kind == DefectKind::Hole).collect();
        assert!(loops.iter().all(|hole| hole.count >= 3));
        assert_eq!(loops.iter().map(|hole| hole.count).sum::<u64>(), expected[0]);
        expected[1] = loops.len() as u64;
        assert_eq!(counts(&mesh), expected, "{facets:?}");
        holes += loops.len();
        // The others one by one, but for the rounding of lengths.
        let mut found: Vec<_> = defects.iter().filter(|d| d.kind != DefectKind::Hole).copied().collect();
        for list in [&mut found, &mut others] {
            list.iter_mut().for_each(|d| d.length = (d.length * 1e6).round());
            let key = |d: &MeshDefect| format!("{:?}", (d.kind, d.bounds, d.count, d.length));
            list.sort_by_key(key);
        }
        assert_eq!(found, others, "{facets:?}");
        seen.extend(defects.iter().map(|d| d.kind));
        // The order, and that it does not depend on the order of facets.
        for pair in defects.windows(2) {
            let order = pair[0].kind.cmp(&pair[1].kind);
            let order = order.then(pair[1].extent().total_cmp(&pair[0].extent()));
            let order = order.then(pair[1].count.cmp(&pair[0].count));
            let place = |d: &MeshDefect| format!("{:?}", d.bounds);
            assert!(order.then(place(&pair[0]).cmp(&place(&pair[1]))).is_le(), "{pair:?}");
        }
    }
    assert!(seen.len() == 5 && holes > 500, "{seen:?} {holes}");
}

#[test]
fn a_real_file_of_several_bodies() {
    let Some(path) = leafless_testkit::model("multibody.stl") else { return };
    let mesh = leafless::exchange::read_stl(&std::fs::read(path).unwrap()).unwrap();
    assert_eq!(counts(&mesh), [0, 0, 12, 0, 0, 0, 0, 2, 2, 0]);
    let defects = mesh.defects(10).unwrap();
    assert!(defects.iter().all(|d| d.kind == DefectKind::Misoriented));
    assert_eq!(defects.iter().map(|d| d.count).sum::<u64>(), 12);
}

#[test]
fn a_real_file_with_holes() {
    let Some(path) = leafless_testkit::model("stanford-bunny.obj") else { return };
    let mesh = leafless::exchange::read_obj(&std::fs::read(path).unwrap()).unwrap();
    let report = mesh.report().unwrap();
    assert_eq!((report.triangles, report.boundary_edges, report.boundary_loops), (69451, 223, 5));
    assert_eq!((report.misoriented_edges, report.bodies, report.open_bodies), (0, 1, 1));
    let holes = mesh.defects(5).unwrap();
    assert!(holes.iter().all(|hole| hole.kind == DefectKind::Hole));
    assert_eq!(holes.iter().map(|hole| hole.count).sum::<u64>(), 223);
    // The four large holes lie in the base.
    let high: Vec<bool> = holes.iter().map(|hole| hole.bounds.1[1] > 0.04).collect();
    assert_eq!(high, [false, false, false, false, true]);
}

#[test]
fn real_files() {
    let known = [
        ("angle_block.STL", [166, 37, 0, 0, 0, 0, 0, 1, 1, 0]),
        ("bunny-closed.stl", [0, 0, 0, 0, 0, 0, 0, 1, 0, 0]),
        ("busted.STL", [0, 0, 0, 0, 0, 0, 0, 1, 0, 0]),
        ("featuretype.STL", [576, 16, 0, 0, 0, 0, 0, 1, 1, 0]),
        ("plate_holes.STL", [0, 0, 0, 0, 0, 0, 0, 1, 0, 0]),
        ("fandisk.obj", [0, 0, 0, 0, 0, 0, 0, 1, 0, 0]),
        ("rocker-arm.obj", [0, 0, 0, 0, 0, 0, 0, 1, 0, 0]),
        ("spot.obj", [0, 0, 0, 0, 0, 0, 0, 1, 0, 0]),
        // Bodies that touch each other in edges, all closed.
        ("cycloidal.ply", [0, 0, 0, 242, 0, 0, 0, 112, 0, 0]),
    ];
    for (name, expected) in known {
        let Some(path) = leafless_testkit::model(name) else { return };
        let bytes = std::fs::read(path).unwrap();
        let mesh = match name.split_once('.').unwrap().1 {
            "obj" => leafless::exchange::read_obj(&bytes),
            "ply" => leafless::exchange::read_ply(&bytes),
            _ => leafless::exchange::read_stl(&bytes),
        };
        let mesh = mesh.unwrap();
        assert_eq!(counts(&mesh), expected, "{name}");
        let defects = mesh.defects(usize::MAX).unwrap();
        let of = |kind| defects.iter().filter(move |d: &&MeshDefect| d.kind == kind);
        assert_eq!(of(DefectKind::Hole).count() as u64, expected[1], "{name}");
        assert_eq!(of(DefectKind::NonManifold).map(|d| d.count).sum::<u64>(), expected[3], "{name}");
    }
}
