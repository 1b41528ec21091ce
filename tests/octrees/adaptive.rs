//! Solids split to a geometric tolerance.

use leafless::octree::Cursor;
use leafless::op::Zone;
use leafless::solid::{Adaptive, Ask, SplitCounter};
use leafless::{
    Affine, AnySolid, Callback, Cell, Classifier, Control, Csg, Error, FillRule, Frame, LazyOctree,
    MeshSolid, Octree, Rule, Solid, Tag, TriangleMesh, Verdict, Worker, build,
};
use leafless_testkit::alone;

fn turned_block() -> Csg {
    let block = Csg::cuboid([-0.5, -0.4, -0.3], [0.5, 0.4, 0.3]).unwrap();
    let rows = [[0.36, 0.48, -0.8, 0.01], [-0.8, 0.6, 0.0, 0.02], [0.48, 0.64, 0.6, 0.03]];
    let bore = Csg::cylinder(0.2, -1.0, 1.0).unwrap();
    block.difference(&bore).unwrap().placed(&Affine::new(rows).unwrap()).unwrap()
}

/// Returns the distance between the sides of a cell's slabs, in model units; infinite without slabs.
fn thickness<W: Worker>(worker: &mut W, cell: Cell, part: &W::Part) -> f64 {
    let half = 0.5 * worker.frame().edge() / (1u64 << cell.level) as f64;
    let Some(enclosure) = worker.enclosure(cell, part).unwrap() else { return f64::INFINITY };
    let slabs = enclosure.slabs.iter().filter(|slab| slab.normal != [0.0; 3]);
    slabs
        .map(|slab| half * (slab.outer - slab.inner) / slab.normal.iter().map(|c| c * c).sum::<f64>().sqrt())
        .fold(0.0, f64::max)
}

/// Walks through the solid and the octree of its adaptive form together. Each cell of the octree has the
/// solid's verdict, and each undecided cell above the finest level is known to the tolerance. An octree
/// merges eight equal cells into one: there the cursor stays above (`is_below`).
fn check<W: Worker>(
    worker: &mut W,
    (cell, verdict): (Cell, Verdict<W::Part>),
    cursor: &mut Cursor<'_>,
    is_below: bool,
    tolerance: f64,
    coarse: &mut u64,
) {
    let tag = cursor.tag();
    let part = match verdict {
        Verdict::Partial(part) => part,
        verdict => return assert_eq!(tag, verdict.tag(), "{cell:?}"),
    };
    if tag == Tag::Partial {
        if cell.level == worker.frame().depth() {
            return;
        }
        if thickness(worker, cell, &part) <= tolerance {
            *coarse += 1;
            return;
        }
    }
    assert!(cell.level < worker.frame().depth(), "{cell:?}: {tag:?}");
    let mark = worker.mark();
    for (octant, verdict) in (0..8).zip(worker.split(cell, &part).unwrap()) {
        let descends = tag == Tag::Branch && !is_below;
        if descends {
            assert!(cursor.descend(octant));
        }
        check(worker, (cell.child(octant), verdict), cursor, !descends, tolerance, coarse);
        if descends {
            cursor.ascend();
        }
    }
    worker.release(mark);
}

#[test]
fn cells_are_as_large_as_the_tolerance_allows() {
    let solid = turned_block();
    for (depth, tolerance) in [(7, 0.0), (7, 1e-3), (8, 1e-4), (6, 0.1)] {
        let frame = Frame::new([-1.0; 3], 2.0, depth).unwrap();
        let adaptive = Adaptive::new(solid.clone(), tolerance).unwrap();
        let tree = build(&adaptive, &frame, Rule::Certified, &alone()).unwrap();
        let whole = build(&solid, &frame, Rule::Certified, &alone()).unwrap();
        let [some, all] = [&tree, &whole].map(|tree| tree.statistics().nodes());
        assert!(if tolerance > 0.0 { 2 * some < all } else { some <= all }, "{tolerance}: {some} {all}");
        let (inner, outer) = (whole.statistics().volume(), tree.statistics().volume());
        assert!(outer.lower <= inner.lower && inner.upper <= outer.upper);
        let mut worker = solid.on(&frame, &alone()).unwrap().worker().unwrap();
        let root = worker.root().unwrap();
        let mut coarse = 0;
        let mut cursor = Cursor::new(tree.view());
        check(&mut worker, (Cell::ROOT, root), &mut cursor, false, tolerance, &mut coarse);
        assert!(coarse > 0 || tolerance == 0.0, "{tolerance}");
        // The same for any number of threads, and behind any type.
        assert!(build(&adaptive, &frame, Rule::Certified, &Control::threads(3)).unwrap() == tree);
        assert!(build(&AnySolid::new(adaptive.clone()), &frame, Rule::Certified, &alone()).unwrap() == tree);
        // On demand, too.
        let mut lazy = LazyOctree::new(adaptive, &frame).unwrap();
        lazy.refine(&Zone::Whole, depth, &alone()).unwrap();
        assert!(lazy.freeze(&alone()).unwrap() == tree);
    }
}

#[test]
fn what_knows_nothing_is_split_as_ever() {
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let ball = |min: [f64; 3], max: [f64; 3]| {
        let near = |a: f64, b: f64| if a <= 0.0 && b >= 0.0 { 0.0 } else { a.abs().min(b.abs()) };
        let [least, most] = [near, |a: f64, b: f64| a.abs().max(b.abs())]
            .map(|side: fn(f64, f64) -> f64| (0..3).map(|i| side(min[i], max[i]).powi(2)).sum::<f64>());
        Ok(match (most < 0.6, least > 0.64) {
            (true, _) => Verdict::Full,
            (_, true) => Verdict::Empty,
            _ => Verdict::Partial(()),
        })
    };
    let whole = build(&Callback::new(ball), &frame, Rule::Certified, &alone()).unwrap();
    let adaptive = Adaptive::new(Callback::new(ball), 10.0).unwrap();
    assert!(build(&adaptive, &frame, Rule::Certified, &alone()).unwrap() == whole);
    for tolerance in [-1.0, f64::NAN] {
        let refused = Adaptive::new(Callback::new(ball), tolerance);
        assert!(matches!(refused, Err(Error::Argument { name: "tolerance", .. })));
    }
}

/// Where a mesh and a ball meet, both are open in a cell. The cell combines the enclosures of both.
#[test]
fn expressions_of_meshes_and_half_spaces_end_where_both_are_known() {
    let vertices = (0..8).map(|k| [0, 1, 2].map(|axis| f64::from(k >> axis & 1))).collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = MeshSolid::new(TriangleMesh::new(vertices, triangles).unwrap(), FillRule::NonZero).unwrap();
    let ball = Csg::ball([1.0; 3], 0.75).unwrap();
    let part = Csg::solid(AnySolid::new(mesh.clone())).difference(&ball).unwrap();
    let frame = Frame::new([-0.77; 3], 2.7, 14).unwrap();
    let adaptive = Adaptive::new(part, 1e-3).unwrap();
    let tree = build(&adaptive, &frame, Rule::Certified, &alone()).unwrap();
    // Shortcuts for faster builds respect the tolerance, too.
    assert_eq!(build(&SplitCounter::new(adaptive), &frame, Rule::Certified, &alone()).unwrap(), tree);
    // The curves where the mesh meets the ball take some ten thousand cells by verdicts.
    let finest = |tree: &Octree| tree.statistics().levels()[14].partial;
    let alone = build(&Adaptive::new(mesh, 1e-3).unwrap(), &frame, Rule::Certified, &alone()).unwrap();
    assert_eq!([finest(&tree), finest(&alone)], [0, 0]);
}
