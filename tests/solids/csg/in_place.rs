//! Cuts queried in place, without a worker, against exact arithmetic and against the tree as a solid.

use super::oracle::frames;
use leafless::octree::{StoredSurface, SurfaceKind};
use leafless::query::{Obstacle, PointCursor, PointTable, Region};
use leafless::{
    Cell, Control, Csg, Error, Frame, Membership, Metadata, Octree, Ray, Rule, SurfaceOptions, build,
    build_extended, cast_rays, contains, op,
};
use leafless_testkit::csg::{Maker, Model, Point};
use leafless_testkit::exact::Exact;
use leafless_testkit::{Random, alone};

fn exact(p: [f64; 3]) -> Point {
    let [x, y, z] = p.map(Exact::from);
    [x, y, z, Exact::from(1.0)]
}

/// Random models with their extended trees. At least one PARTIAL cell of each tree keeps surfaces.
fn models(count: usize, seed: u64) -> impl Iterator<Item = (Model, Csg, Octree, Random)> {
    let made = (0..).filter_map(move |k| {
        let mut random = Random(seed ^ k);
        let frame = frames(2 + random.below(6) as u8)[random.below(5) as usize];
        let aligned = random.below(2) == 0;
        let mut maker = Maker { random: &mut random, frame, aligned, others: false };
        let model = make(&mut maker);
        let csg = model.csg(&frame).ok()?;
        let tree = build_extended(&csg, &frame, &SurfaceOptions::default(), &alone()).ok()?;
        tree.view().cuts()?;
        Some((model, csg, tree, random))
    });
    made.take(count)
}

fn make(maker: &mut Maker<'_>) -> Model {
    match maker.random.below(3) {
        0 => maker.primitive(),
        _ => maker.expression(3),
    }
}

/// A point anywhere in the universe, or near the surface: bisected between an inner and an outer point.
fn point(model: &Model, frame: &Frame, random: &mut Random) -> [f64; 3] {
    let mut any = || frame.origin().map(|origin| origin + frame.edge() * random.unit());
    let (mut a, mut b) = (any(), any());
    let [at_a, at_b] = [a, b].map(|p| model.sign(&exact(p)));
    if at_a != at_b {
        for _ in 0..random.below(50) {
            let middle = [0, 1, 2].map(|axis| 0.5 * a[axis] + 0.5 * b[axis]);
            if model.sign(&exact(middle)) == at_a { a = middle } else { b = middle }
        }
    }
    a
}

#[test]
fn points_in_place_do_not_lie() {
    let (mut decided, mut undecided, mut open) = (0u64, 0u64, 0u64);
    for (model, _, tree, mut random) in models(150, 0x91AC) {
        let frame = *tree.frame();
        let points: Vec<_> = (0..120).map(|_| point(&model, &frame, &mut random)).collect();
        let mut exactly = vec![Membership::Undecided; points.len()];
        contains(&tree, &frame, &points, &mut exactly, &alone()).unwrap();
        let mut many = exactly.clone();
        tree.contains_many(&points, &mut many).unwrap();
        let mut cursor = PointCursor::new(tree.view());
        let table = PointTable::new(tree.view(), 3).unwrap();
        for (i, &p) in points.iter().enumerate() {
            let answer = tree.contains(p);
            assert_eq!([many[i], cursor.contains(p), table.contains(p)], [answer; 3], "{p:?}");
            let sign = model.sign(&exact(p));
            match answer {
                Membership::Inside => assert!(sign >= 0, "{p:?}\n{model:#?}"),
                Membership::Outside => assert!(sign <= 0, "{p:?}\n{model:#?}"),
                // Points that the tree decides as a solid may be undecided here by rounding.
                Membership::Undecided => {
                    undecided += 1;
                    open += (exactly[i] != Membership::Undecided) as u64;
                    continue;
                }
            }
            decided += 1;
            assert_eq!(answer, exactly[i], "{p:?}");
        }
    }
    println!("{decided} decided, {undecided} not, of which {open} by rounding");
    assert!(decided > 10_000 && 20 * open < decided, "{decided} {open}");
}

/// Returns the exact point of a ray at a time.
fn along(ray: ([f64; 3], [f64; 3]), t: f64) -> Point {
    let [x, y, z] =
        [0, 1, 2].map(|axis| Exact::from(ray.0[axis]).plus(&Exact::from(ray.1[axis]).times(&Exact::from(t))));
    [x, y, z, Exact::from(1.0)]
}

#[test]
fn rays_in_place_do_not_lie() {
    let (mut hits, mut missed, mut sharp, mut judged) = (0, 0, 0, 0);
    for (model, csg, tree, mut random) in models(150, 0x7A75) {
        let frame = *tree.frame();
        for _ in 0..12 {
            let from = frame.origin().map(|origin| origin + frame.edge() * random.between(-0.5, 1.5));
            let to = frame.origin().map(|origin| origin + frame.edge() * random.unit());
            let direction = [0, 1, 2].map(|axis| to[axis] - from[axis]);
            let Ok(ray) = Ray::new(from, direction) else { continue };
            let hit = tree.cast_ray(&ray, Obstacle::Upper);
            let mut all = [None];
            tree.cast_rays(&[ray], Obstacle::Upper, &mut all).unwrap();
            assert_eq!(all, [hit]);
            let spans = tree.ray_spans(&ray).unwrap();
            // Before the first possible hit nothing is solid, and proven spans are entirely solid.
            let is_in_universe = |t: f64| {
                (0..3).all(|axis| {
                    let c = from[axis] + t * direction[axis] - frame.origin()[axis];
                    (1e-9 * frame.edge()..(1.0 - 1e-9) * frame.edge()).contains(&c)
                })
            };
            let mut times: Vec<f64> = (0..20).map(|_| 2.0 * random.unit()).collect();
            // Wrong ends would show beside the ends of spans.
            let ends = spans.inner.iter().chain(&spans.outer).flat_map(|span| [span.lower, span.upper]);
            let steps = [0, -1, 1].map(|side| f64::from(side) * 0.5f64.powi(50 - random.below(25) as i32));
            times.extend(ends.filter(|t| t.is_finite()).flat_map(|t| steps.map(|step| t + step * t)));
            for t in times {
                if !is_in_universe(t) {
                    continue;
                }
                let sign = model.sign(&along((from, direction), t));
                let is_before = hit.is_none_or(|hit| t < hit.t.lower);
                assert!(!(is_before && sign > 0), "{t} of {ray:?}: {hit:?}\n{frame:?}\n{model:#?}");
                let is_outer = spans.outer.iter().any(|span| span.contains(t));
                let is_inner = spans.inner.iter().any(|span| span.contains(t));
                assert!(is_outer || sign <= 0, "{t} of {ray:?}: {spans:?}\n{frame:?}\n{model:#?}");
                assert!(!is_inner || sign >= 0, "{t} of {ray:?}: {spans:?}\n{frame:?}\n{model:#?}");
                judged += 1;
            }
            // The expression is queried on a finer frame, within limits: a ray in a surface passes very many
            // cells.
            let finer = frame.with_depth(16).unwrap();
            let control = Control { max_splits: Some(3000), ..Control::threads(1) };
            let direct = cast_rays(&csg, &finer, &[ray], Obstacle::Upper, &control).unwrap();
            match (hit, direct[0]) {
                (Some(own), Some(direct)) => {
                    assert!(own.t.lower <= direct.t.upper && direct.t.lower <= own.t.upper);
                    hits += 1;
                    sharp += (own.t.width() < 1e-11) as u32;
                    let length: f64 = own.normal.iter().map(|c| c * c).sum();
                    assert!(own.normal == [0.0; 3] || (length - 1.0).abs() < 1e-12, "{own:?}");
                }
                (None, Some(direct)) => assert!(direct.t.upper == f64::INFINITY, "{direct:?}"),
                (Some(own), None) => assert!(own.t.upper == f64::INFINITY, "{own:?}"),
                (None, None) => missed += 1,
            }
        }
    }
    println!("{hits} hits, of which {sharp} are sharp; {missed} missed; {judged} places");
    assert!(hits > 300 && 2 * sharp > hits && judged > 10_000, "{hits} {sharp} {judged}");
}

#[test]
fn boxes_in_place_do_not_lie() {
    let mut found = [0; 4];
    for (model, _, tree, mut random) in models(200, 0xB0C5) {
        let frame = *tree.frame();
        for _ in 0..20 {
            let centre = point(&model, &frame, &mut random);
            let half = frame.edge() * 0.4 * random.unit().powi(6);
            let (min, max) = (centre.map(|c| c - half), centre.map(|c| c + half));
            let region = tree.view().classify_box(min, max).unwrap();
            found[region as usize] += 1;
            for _ in 0..10 {
                let p = centre.map(|c| c + half * random.between(-1.0, 1.0));
                let sign = model.sign(&exact(p));
                match region {
                    Region::Inside => assert!(sign >= 0, "{p:?} in {min:?} {max:?}\n{frame:?}\n{model:#?}"),
                    Region::Outside => assert!(sign <= 0, "{p:?} in {min:?} {max:?}\n{frame:?}\n{model:#?}"),
                    Region::Crossing | Region::Undecided => {}
                }
            }
        }
    }
    println!("{found:?}");
    assert!(found[..3].iter().all(|&count| count > 100), "{found:?}");
}

/// Returns the i-th number of a surface.
fn number(surface: &StoredSurface<'_>, i: usize) -> Exact {
    surface.number(i).iter().fold(Exact::from(0.0), |sum, &term| sum.plus(&Exact::from(term)))
}

/// Returns the sign of a surface's function if it is a polynomial without placement.
fn side(surface: &StoredSurface<'_>, p: [f64; 3]) -> Option<i32> {
    if surface.placements().next().is_some() {
        return None;
    }
    let [x, y, z] = p.map(Exact::from);
    let one = Exact::from(1.0);
    let terms: Vec<[&Exact; 2]> = match surface.kind() {
        SurfaceKind::Plane => vec![[&x, &one], [&y, &one], [&z, &one], [&one, &one]],
        SurfaceKind::Quadric => vec![
            [&x, &x],
            [&y, &y],
            [&z, &z],
            [&x, &y],
            [&y, &z],
            [&z, &x],
            [&x, &one],
            [&y, &one],
            [&z, &one],
            [&one, &one],
        ],
        _ => return None,
    };
    assert_eq!(terms.len(), surface.numbers());
    let value = terms
        .iter()
        .enumerate()
        .fold(Exact::from(0.0), |sum, (i, [a, b])| sum.plus(&number(surface, i).times(a).times(b)));
    Some(value.sign())
}

/// The function of a cell describes the solid in the cell. Descendants of the cell have the same function.
#[test]
fn functions_of_cells_are_the_solid() {
    let (mut judged, mut functions) = (0, 0);
    for (model, _, tree, mut random) in models(200, 0xF00C) {
        let (frame, view) = (*tree.frame(), tree.view());
        for _ in 0..100 {
            let level = random.below(u64::from(frame.depth()) + 1) as u8;
            let cell = Cell { level, at: [0; 3].map(|_| random.below(1 << level) as u32) };
            let Some(function) = view.cell_function(cell) else { continue };
            functions += 1;
            if level < frame.depth() {
                assert_eq!(view.cell_function(cell.child(random.below(8) as u8)), Some(function));
            }
            let surfaces: Vec<_> =
                function.surfaces().iter().map(|&id| view.surface(id).expect("a surface")).collect();
            let size = frame.edge() / f64::from(1u32 << level);
            let p = [0, 1, 2].map(|axis| {
                frame.origin()[axis] + size * (f64::from(cell.at[axis]) + random.between(0.01, 0.99))
            });
            let sides: Option<Vec<i32>> = surfaces.iter().map(|surface| side(surface, p)).collect();
            let Some(sides) = sides.filter(|sides| !sides.contains(&0)) else { continue };
            let m = sides.iter().enumerate().fold(0, |m, (i, &side)| m | u8::from(side > 0) << i);
            let inside = function.table() >> m & 1 != 0;
            let sign = model.sign(&exact(p));
            assert!(if inside { sign >= 0 } else { sign <= 0 }, "{p:?} {cell:?} {function:?}\n{model:#?}");
            judged += 1;
        }
        let surfaces = view.cuts().expect("cuts").surfaces as u32;
        assert!(view.surface(surfaces).is_none());
    }
    assert!(functions > 1000 && judged > 300, "{functions} {judged}");
}

/// The plain tree of a tree with cuts equals the tree of its expression, except where operand groups of the
/// expression decide a cell by boxes.
#[test]
fn plain_trees_are_those_of_the_expression() {
    let (mut same, mut all) = (0, 0);
    for (_, csg, tree, _) in models(60, 0x71A1) {
        let depth = (tree.frame().depth() + 1).min(7);
        let tree = tree.with_metadata(Metadata::new());
        let plain = op::plain(&tree, depth, Rule::Certified, &alone()).unwrap();
        assert!(plain.view().cuts().is_none() && plain.frame().depth() == depth);
        let direct = build(&csg, plain.frame(), Rule::Certified, &alone()).unwrap();
        all += 1;
        same += (plain == direct) as u32;
        // Both are certified, so that they do not contradict each other.
        let beyond =
            op::intersection(plain.view(), op::complement(direct.view(), &alone()).unwrap().view(), &alone());
        assert_eq!(beyond.unwrap().statistics().volume().lower, 0.0);
    }
    assert!(2 * same > all, "{same} of {all}");
    let (_, _, tree, _) = models(1, 3).next().unwrap();
    for depth in [0, 21] {
        assert!(matches!(
            op::plain(&tree, depth, Rule::Outer, &alone()),
            Err(Error::Argument { name: "depth", .. })
        ));
    }
    let sampled = op::plain(&tree, tree.frame().depth(), Rule::Sampled, &alone());
    assert!(matches!(sampled, Ok(_) | Err(Error::NotSampled)));
}
