//! Measures of trees with any bytes: no panic, bounded work, and valid intervals. In a sound tree the
//! intervals contain the counts of its cells.

use super::CONTROL;
use leafless::octree::CellFilter;
use leafless::query::{Overlap, cells_in, classify_in, surface_area, volume_in};
use leafless::{
    Control, Csg, Interval, OctreeRef, Proof, Solid, Tag, bounding_box, clearance, interference, measure,
};

/// Limits the splits of each query. A tree from a file of some kilobytes has fewer cells that can be split.
const SOME: Control<'static> = Control { max_splits: Some(200), ..CONTROL };

/// Queries the measures of a tree: alone, against itself, and against a ball, a box and a half-space.
pub fn ask_measures(tree: &OctreeRef<'_>, points: &[[f64; 3]], verified: bool) {
    // As if the cells were the solid.
    let (solid, frame) = (tree.with_proof(Proof::CERTIFIED), tree.frame());
    if solid.on(frame, &CONTROL).is_err() {
        return;
    }
    let universe = frame.edge().powi(3) * (1.0 + 1e-9);
    let is_some =
        |volume: Interval| 0.0 <= volume.lower && volume.lower <= volume.upper && volume.upper <= universe;
    let found = measure(&solid, frame, 0.0, &SOME).expect("nothing is wrong with it");
    // (Stored moments need not agree with the cells.)
    let is_measured = tree.moments().is_none();
    assert!(is_some(found.volume) || !is_measured, "{:?}", found.volume);
    let area = surface_area(&solid, frame, 0.0, &SOME).expect("nothing is wrong with it").area;
    assert!(0.0 <= area.lower && area.lower <= area.upper);
    let corners = bounding_box(&solid, frame, 0.0, &SOME).expect("nothing is wrong with it").corners;
    assert!(corners.is_none_or(|[min, max]| (0..3).all(|axis| min[axis].lower <= max[axis].upper)));
    if verified {
        let count = |tags: &[Tag]| {
            let finest = |level: u8| 1u64 << (3 * (frame.depth() - level));
            tree.cells(CellFilter::tags(tags)).map(|found| finest(found.cell.level)).sum::<u64>()
        };
        let counts = [count(&[Tag::Full]), count(&[Tag::Full, Tag::Partial])];
        let cell = (frame.edge() / f64::from(frame.cells())).powi(3);
        let [least, most] = counts.map(|count| count as f64 * cell);
        let slack = 1e-9 * universe;
        let is_between = found.volume.lower <= most + slack && found.volume.upper >= least - slack;
        assert!(is_between || !is_measured, "{:?}", found.volume);
        let own = cells_in(&solid, &solid, frame, &CONTROL).expect("nothing is wrong with it");
        assert_eq!([own.full_least, own.upper_most], counts);
        assert_eq!(corners.is_none(), counts[1] == 0);
    }
    // Itself.
    together(&solid, &solid, tree, universe);
    // Numbers that make no shape are refused.
    let [Some(&at), Some(&to)] = [points.first(), points.get(1)] else { return };
    if let Ok(ball) = Csg::ball(at, 0.4 * frame.edge()) {
        together(&solid, &ball, tree, universe);
    }
    let (min, max) = ([0, 1, 2].map(|k: usize| at[k].min(to[k])), [0, 1, 2].map(|k: usize| at[k].max(to[k])));
    if let Ok(cuboid) = Csg::cuboid(min, max) {
        together(&solid, &cuboid, tree, universe);
    }
    if let Ok(half) = Csg::half_space(at, to[0]) {
        together(&solid, &half, tree, universe);
    }
}

/// Queries the common volume and the distance of two solids.
fn together<R: Solid>(solid: &OctreeRef<'_>, region: &R, tree: &OctreeRef<'_>, universe: f64) {
    let frame = tree.frame();
    let volume = volume_in(solid, region, frame, &SOME).expect("both are solids on the frame");
    assert!(0.0 <= volume.lower && volume.lower <= volume.upper && volume.upper <= universe);
    let of_cells = tree.volume_in(region, &SOME).expect("it is a solid on the frame");
    assert!(0.0 <= of_cells.lower && of_cells.lower <= of_cells.upper && of_cells.upper <= universe);
    let cells = tree.cells_in(region, &SOME).expect("it is a solid on the frame");
    assert!(cells.full_least <= cells.full_most && cells.upper_least <= cells.upper_most);
    let found = interference(solid, region, frame, 0.0, &SOME).expect("both are solids on the frame");
    assert!(0.0 <= found.volume.lower && found.volume.lower <= found.volume.upper);
    assert!(found.clipped || found.volume.upper <= universe, "{found:?}");
    assert!(found.verdict != Overlap::Disjoint || found.volume.lower == 0.0);
    let apart = clearance(solid, region, frame, 0.0, &SOME).expect("both are solids on the frame");
    assert!(apart.distance.lower <= apart.distance.upper);
    // Overlapping solids have distance 0.
    assert!(found.verdict != Overlap::Overlapping || apart.distance.lower == 0.0);
    classify_in(solid, region, frame, &SOME).expect("both are solids on the frame");
}
