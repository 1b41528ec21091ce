//! The slabs of meshes, against winding numbers in exact arithmetic. For open surfaces, the winding number is
//! computed by its definition.

use crate::oracle;
use crate::oracle::PointOracle;
use crate::shapes::*;
use crate::soup::check::is_inside;
use crate::soup::forms::{bowl, pipe, refined, sphere};
use crate::soup::winding::Soupy;
use leafless::solid::{Ask, Slab};
use leafless::{AnySolid, Classifier, Csg, FillRule, Frame, MeshSolid, Solid, TriangleMesh};
use leafless_testkit::slabs::{bits, told};
use leafless_testkit::{Random, Way, alone, lattice_frame};

const RULES: [FillRule; 3] = [FillRule::NonZero, FillRule::EvenOdd, FillRule::Positive];

/// The true membership of a point, if the point lies off the boundary and its position is a double.
type Truth<'a> = dyn FnMut([f64; 3]) -> Option<bool> + 'a;

#[derive(Debug, Default)]
struct Found {
    cells: u64,
    enclosed: u64,
    inside: u64,
    outside: u64,
    /// Sum, over enclosed cells, of the slab's width divided by the greatest possible width.
    widths: f64,
}

/// A point of the open cell, anywhere or near a face of the slab.
fn point(random: &mut Random, slab: &Slab) -> Option<[f64; 3]> {
    let mut x = [0; 3].map(|_| random.between(-1.0, 1.0));
    if random.below(4) != 0 {
        let offset = if random.below(2) == 0 { slab.inner } else { slab.outer };
        let axis = (0..3).max_by(|&a, &b| slab.normal[a].abs().total_cmp(&slab.normal[b].abs())).unwrap();
        let others: f64 = (0..3).filter(|&i| i != axis).map(|i| slab.normal[i] * x[i]).sum();
        let aside = [0.0, 1e-14, 1e-12, 1e-6, 1e-3][random.below(5) as usize];
        let beyond = if offset == slab.outer { aside } else { -aside };
        x[axis] = (offset + beyond - others) / slab.normal[axis];
    }
    x.iter().all(|c| c.abs() < 1.0).then_some(x)
}

/// Walks to a finest cell, and checks every cell on the way.
fn walk(solid: &MeshSolid, frame: &Frame, truth: &mut Truth<'_>, random: &mut Random, found: &mut Found) {
    let complement = Csg::solid(AnySolid::new(solid.clone())).complement().on(frame, &alone()).unwrap();
    let way = Way::new(solid.on(frame, &alone()).unwrap().worker().unwrap());
    let (Some(mut way), Some(mut opposite)) = (way, Way::new(complement.worker().unwrap())) else { return };
    loop {
        let cell = way.cell;
        let enclosure = way.worker.enclosure(cell, &way.part).unwrap();
        let complement = opposite.worker.enclosure(cell, &opposite.part).unwrap();
        let context = || format!("{cell:?} {frame:?}\n{enclosure:#?}\n{complement:#?}");
        assert_eq!(enclosure.map(|e| bits(&e.complement())), complement.as_ref().map(bits), "{}", context());
        found.cells += 1;
        if let Some(enclosure) = &enclosure {
            let slab = &enclosure.slabs[0];
            assert!(slab.inner <= slab.outer && slab.normal != [0.0; 3], "{}", context());
            assert!(enclosure.slabs[1..].iter().all(|slab| slab.normal == [0.0; 3]));
            let range: f64 = slab.normal.iter().map(|n| n.abs()).sum();
            found.enclosed += 1;
            found.widths += (slab.outer.min(range) - slab.inner.max(-range)) / (2.0 * range);
            let half = 0.5 * frame.edge() / f64::from(1u32 << cell.level);
            for _ in 0..12 {
                let Some(x) = point(random, slab) else { continue };
                let centre = [0, 1, 2].map(|k| frame.origin()[k] + f64::from(2 * cell.at[k] + 1) * half);
                let p: [f64; 3] = std::array::from_fn(|k| centre[k] + half * x[k]);
                // The double next to the point.
                let x: [f64; 3] = std::array::from_fn(|k| (p[k] - centre[k]) / half);
                let is_exact = (0..3).all(|k| centre[k] + half * x[k] == p[k] && x[k].abs() < 1.0);
                let told = if is_exact { told(enclosure, x) } else { 0 };
                if told == 0 {
                    continue;
                }
                found.inside += u64::from(told > 0);
                found.outside += u64::from(told < 0);
                if let Some(is_inside) = truth(p) {
                    assert_eq!(told > 0, is_inside, "{x:?} {p:?} {}", context());
                }
            }
        }
        if !way.descend(random) {
            return;
        }
        opposite.follow(way.cell);
    }
}

fn closed(name: &str, soup: &Soup, depth: u8, walks: u64, found: &mut Found) {
    let mesh = std::sync::Arc::new(mesh(soup));
    let oracle = PointOracle::new(&mesh);
    let frame = lattice_frame(depth);
    for rule in RULES {
        let Ok(solid) = MeshSolid::new(mesh.clone(), rule) else { panic!("{name}") };
        let mut truth = |p| oracle.winding(p).map(|w| oracle::Oracle::inside(rule, w));
        let mut random = Random(u64::from(depth) + 77);
        for _ in 0..walks {
            walk(&solid, &frame, &mut truth, &mut random, found);
        }
    }
}

/// Corners at arbitrary places, on planes and centres of the lattice, and shared.
fn soups(random: &mut Random, depth: u8) -> Soup {
    let cells = f64::from(1u32 << depth);
    let is_aligned = random.below(2) == 0;
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let count = 1 + random.below(4) as usize;
    tetrahedra(random, count, |random| {
        if !corners.is_empty() && random.below(3) == 0 {
            return corners[random.below(corners.len() as u64) as usize];
        }
        let unit = if is_aligned { cells / 8.0 } else { 0.0 };
        let corner = [0; 3].map(|_| match unit {
            0.0 => random.between(0.0, cells),
            unit => unit * random.below(9) as f64,
        });
        corners.push(corner);
        corner
    })
}

#[test]
fn slabs_of_soups_hold() {
    let mut found = Found::default();
    for seed in 0..150 {
        let mut random = Random(seed ^ 0x51AB);
        let depth = [3, 6, 12][random.below(3) as usize];
        let soup = soups(&mut random, depth);
        if TriangleMesh::from_facets(&soup).is_ok_and(|mesh| mesh.check_closed(FillRule::EvenOdd).is_ok()) {
            closed("soup", &soup, depth, 4, &mut found);
        }
    }
    println!("{found:#?}");
    assert!(found.enclosed > found.cells / 4, "{found:?}");
    assert!(found.inside > 1000 && found.outside > 1000, "{found:?}");
}

#[test]
fn slabs_of_smooth_and_of_nested_bodies_hold() {
    let mut found = Found::default();
    let size = 4096.0;
    let middle = [0.5 * size; 3];
    let ball = sphere(middle, 0.4 * size, 4);
    let shapes = [
        ("ball", ball.clone()),
        ("torus", torus(middle, 0.3 * size, 0.1 * size, 48, 24)),
        ("shells", [ball.clone(), sphere(middle, 0.397 * size, 4)].concat()),
        ("a hollow ball", [ball.clone(), inside_out(sphere(middle, 0.39 * size, 3))].concat()),
        ("balls that overlap", [ball.clone(), moved(&ball, |[x, y, z]| [x + 100.0, y + 30.0, z])].concat()),
        ("a ball twice", [ball.clone(), ball.clone()].concat()),
        ("blocks that touch", [block([0.0; 3], middle), block([0.5 * size, 0.0, 0.0], [size; 3])].concat()),
        ("a refined block", refined(&block([100.25; 3], [3000.5; 3]), 4)),
    ];
    for (name, soup) in &shapes {
        closed(name, soup, 12, 30, &mut found);
    }
    println!("{found:#?}");
    assert!(found.enclosed > found.cells / 3, "{found:?}");
    assert!(found.inside > 1000 && found.outside > 1000, "{found:?}");
}

/// Where an open surface has holes, the boundary of the enclosed set is where the winding number is one half.
#[test]
fn slabs_of_open_surfaces_hold() {
    let mut found = Found::default();
    let size = 256.0;
    let middle = [0.5 * size; 3];
    let shapes = [
        bowl(middle, 0.4 * size, 3),
        inside_out(bowl(middle, 0.4 * size, 3)),
        pipe(middle, 0.2 * size, 0.6 * size, 1),
        sphere(middle, 0.4 * size, 2).split_off(9),
        // One face of a block faces inward.
        {
            let mut soup = block([30.0; 3], [200.0, 220.0, 150.0]);
            soup[..2].iter_mut().for_each(|facet| facet.swap(0, 1));
            soup
        },
    ];
    for (k, soup) in shapes.iter().enumerate() {
        let mut soupy = Soupy::new(soup);
        for rule in [FillRule::NonZero, FillRule::Positive] {
            let solid = MeshSolid::new(mesh(soup), rule).unwrap();
            let mut truth = |p| is_inside(rule, soupy.at(p), 1e-7);
            let mut random = Random(k as u64 + 5);
            for _ in 0..60 {
                walk(&solid, &lattice_frame(8), &mut truth, &mut random, &mut found);
            }
        }
    }
    println!("{found:#?}");
    assert!(found.enclosed > found.cells / 3, "{found:?}");
    assert!(found.inside > 1000 && found.outside > 1000, "{found:?}");
}

/// Below the coarsest cells, the slabs of a finely faceted ball are thin: their width falls with the square
/// of the cell's size.
#[test]
fn slabs_are_thin_to_second_order() {
    let middle = [2048.0; 3];
    let solid = MeshSolid::new(mesh(&sphere(middle, 1500.0, 6)), FillRule::NonZero).unwrap();
    let frame = lattice_frame(12);
    let classifier = solid.on(&frame, &alone()).unwrap();
    let mut widths = [(0.0, 0.0); 12];
    let mut random = Random(3);
    for _ in 0..300 {
        let mut way = Way::new(classifier.worker().unwrap()).unwrap();
        while way.cell.level < 8 && way.descend(&mut random) {
            if let Some(enclosure) = way.worker.enclosure(way.cell, &way.part).unwrap() {
                let slab = &enclosure.slabs[0];
                let range: f64 = slab.normal.iter().map(|n| n.abs()).sum();
                if slab.inner.is_finite() && slab.outer.is_finite() {
                    let (sum, count) = &mut widths[way.cell.level as usize];
                    *sum += (slab.outer - slab.inner) / range;
                    *count += 1.0;
                }
            }
        }
    }
    let means = widths.map(|(sum, count)| sum / count);
    println!("{means:?} {widths:?}");
    // In half edges: with each level half as thick, until facets are as large as cells.
    assert!(means[5] < 0.7 * means[4] && means[6] < 0.7 * means[5], "{means:?}");
}
