//! All queries of a tree with any bytes: no panic, bounded work, and the same answer from all ways to it.

use super::{CONTROL, ask_measures, halves, walk};
use crate::{Aligned, Random};
use leafless::octree::{CellFilter, Cursor, Direction, SurfaceKind, TaggedCell};
use leafless::op::Zone;
use leafless::query::{
    Columns, DistanceTo, Obstacle, PointCursor, PointTable, RayHit, Region, Run, Side, classify_box,
    ray_spans, surface_area,
};
use leafless::render::{
    Camera, ColourMap, Finish, Layer, Lens, OctreeLayer, Outline, Shot, SliceLayer, SlicePlane, Transfer,
    VolumeLayer, render,
};
use leafless::voxel::{VoxelOptions, VoxelRecords};
use leafless::{
    Cell, Classifier, Control, Csg, Error, Frame, Interval, LazyOctree, Membership, OctreeRef, Proof, Ray,
    Rule, Solid, SurfaceOptions, Tag, Verdict, Worker, build, build_extended, cast_rays, contains, file,
    measure,
};

/// Queries the tree in the first half of `data`. The second half selects the queries.
pub fn queries(data: &[u8]) {
    let Some((bytes, questions)) = halves(data) else { return };
    let aligned = Aligned::new(bytes);
    if let Ok(tree) = file::view(aligned.bytes()) {
        ask(&tree, questions, file::verify(aligned.bytes()).is_ok());
    }
}

/// Runs all queries on `tree`.
pub fn ask(tree: &OctreeRef<'_>, questions: &[u8], verified: bool) {
    let points = points(tree.frame(), questions);
    if tree.cuts().is_some() {
        ask_cuts(tree, &points, verified);
    }
    // The checks below concern the cells.
    let tree = &tree.without_cuts();
    ask_points(tree, &points);
    ask_boxes(tree, &points);
    replay(tree, &points);
    ask_solid(tree, &points);
    on_demand(tree, &points);
    ask_cells(tree);
    ask_neighbours(tree, verified);
    ask_rays(tree, &points);
    ask_columns(tree, verified);
    ask_distances(tree, &points, verified);
    ask_contents(tree, &points, verified);
    ask_measures(tree, &points, verified);
    ask_pictures(tree, &points);
    if verified {
        tree.check().expect("it is verified");
    } else {
        let _ = tree.check();
    }
    // An element has 8 + 64 cells at the most.
    let steps = walk(Cursor::new(tree)).steps;
    assert!(steps <= 1 + 72 * (tree.element_count() + tree.brick_count()), "{steps} steps");
}

/// Limits the splits and nodes of a query to a tree with cuts, because a cut can be split down to any depth.
const SOME: Control<'static> = Control { max_splits: Some(200), max_nodes: Some(2000), ..CONTROL };

/// Checks that cuts never contradict the cells. A verified tree is a solid; an unverified one may not be.
fn ask_cuts(tree: &OctreeRef<'_>, points: &[[f64; 3]], verified: bool) {
    let (plain, frame) = (tree.without_cuts(), *tree.frame());
    // As if everything were proven.
    let solid = tree.with_proof(Proof::CERTIFIED);
    let may_be =
        |found: Membership, of_cells: Membership| of_cells == Membership::Undecided || found == of_cells;
    let mut answers = vec![Membership::Inside; points.len()];
    tree.contains_many(points, &mut answers).expect("as many answers as points");
    let mut remembering = PointCursor::new(tree);
    let tables = [1, 4].map(|level| PointTable::new(tree, level).expect("a small table"));
    for (&point, &answer) in points.iter().zip(&answers) {
        assert!(may_be(answer, plain.contains(point)), "{point:?}");
        assert_eq!((tree.contains(point), remembering.contains(point)), (answer, answer), "{point:?}");
        assert_eq!(tables.each_ref().map(|table| table.contains(point)), [answer; 2], "{point:?}");
    }
    let is_solid = solid.on(&frame, &CONTROL).map(|_| ());
    ask_cut_rays(tree, points, verified && is_solid.is_ok());
    match is_solid {
        Ok(()) => {}
        // Nested placements may be too long for exact numbers.
        Err(Error::Limit { .. }) => return,
        Err(error) => return assert!(!verified && matches!(error, Error::Damaged(_)), "{error}"),
    }
    let mut exact = vec![Membership::Inside; points.len()];
    contains(&solid, &frame, points, &mut exact, &CONTROL).expect("it is a solid");
    // A solid's slabs are wider by the rounding on its universe, which may be far larger than the slabs. For
    // an unverified tree (for example one whose octants should be a single PARTIAL universe), the solid may
    // decide less.
    let surfaces = tree.cuts().map_or(0, |cuts| cuts.surfaces as u32);
    let has_slabs =
        (0..surfaces).any(|id| tree.surface(id).is_none_or(|surface| surface.kind() == SurfaceKind::Slab));
    for ((&point, &exact), &answer) in points.iter().zip(&exact).zip(&answers) {
        let is_wider = (has_slabs || !verified) && exact == Membership::Undecided;
        assert!(may_be(exact, plain.contains(point)), "{point:?}");
        assert!(may_be(exact, answer) || is_wider, "{point:?}: {exact:?}, {answer:?}");
    }
    for corners in points.chunks_exact(2).take(8) {
        let min = [0, 1, 2].map(|axis: usize| corners[0][axis].min(corners[1][axis]));
        let max = [0, 1, 2].map(|axis: usize| corners[0][axis].max(corners[1][axis]));
        let (Ok(found), Ok(region)) =
            (classify_box(&solid, &frame, min, max, &SOME), plain.classify_box(min, max))
        else {
            continue;
        };
        let decided = [Region::Inside, Region::Outside];
        assert!(!decided.contains(&region) || found == region, "{min:?} {max:?}: {found:?}, {region:?}");
        assert!(found != Region::Inside || region != Region::Outside);
        let in_place = tree.classify_box(min, max).expect("a box");
        assert!(
            !decided.contains(&region) || in_place == region,
            "{min:?} {max:?}: {in_place:?}, {region:?}"
        );
        if !verified {
            continue;
        }
        let both = [in_place, found];
        let is_open = both.contains(&Region::Undecided);
        assert!(is_open || in_place == found, "{min:?} {max:?}: {in_place:?}, {found:?}");
        for (point, &exact) in points.iter().zip(&exact) {
            let is_within = (0..3).all(|axis| min[axis] < point[axis] && point[axis] < max[axis]);
            let contradicts = match exact {
                Membership::Inside => both.contains(&Region::Outside),
                Membership::Outside => both.contains(&Region::Inside),
                Membership::Undecided => false,
            };
            assert!(!(is_within && contradicts), "{min:?} {max:?}: {both:?}, but {point:?} is {exact:?}");
        }
    }
    let measured = measure(&solid, &frame, 0.0, &SOME).expect("it is a solid").volume;
    // (Far from the origin, the universe may have no width in doubles.)
    let (least, most) = plain.cells_in_box([0; 3], [frame.cells(); 3]).expect("the universe");
    let cell = (frame.edge() / f64::from(frame.cells())).powi(3);
    let slack = 1e-9 * frame.edge().powi(3);
    assert!(measured.lower <= measured.upper, "{measured:?}");
    // Stored moments need not agree with the cells.
    if verified && tree.moments().is_none() {
        assert!(
            measured.lower <= most as f64 * cell + slack && measured.upper >= least as f64 * cell - slack,
            "{measured:?}, {least} to {most} cells"
        );
    }
    let area = surface_area(&solid, &frame, 0.0, &SOME).expect("it is a solid").area;
    assert!(0.0 <= area.lower && area.lower <= area.upper);
    let coarse = frame.with_depth(frame.depth().min(3)).expect("no deeper");
    let (built, extended) = (
        build(&solid, &coarse, Rule::Certified, &SOME),
        build_extended(&solid, &coarse, &SurfaceOptions::default(), &SOME),
    );
    if let (Ok(built), Ok(extended)) = (&built, &extended) {
        for built in [built, extended] {
            built.view().check().expect("what was built is sound");
        }
        let again = file::to_bytes(extended).and_then(|bytes| file::from_bytes(&bytes));
        assert!(&again.expect("what was built can be written and read") == extended);
        for (&point, &exact) in points.iter().zip(&exact) {
            assert!(may_be(exact, built.view().contains(point)), "{point:?}");
        }
    }
    for result in [built, extended] {
        assert!(matches!(result, Ok(_) | Err(Error::Limit { .. })), "{:?}", result.err());
    }
    if let Ok(mut lazy) = LazyOctree::new(solid, &frame) {
        for &point in points.iter().take(4) {
            let _ = lazy.refine(&Zone::Point(point), frame.depth(), &SOME);
            assert!(may_be(lazy.contains(point), plain.contains(point)), "{point:?}");
        }
    }
}

/// Checks that rays in a tree with cuts end. If the tree is a solid, the cells and surfaces queried in place
/// never contradict the solid.
fn ask_cut_rays(tree: &OctreeRef<'_>, points: &[[f64; 3]], is_solid: bool) {
    let rays: Vec<Ray> =
        points.windows(2).take(12).filter_map(|pair| Ray::between(pair[0], pair[1]).ok()).collect();
    let (solid, frame) = (tree.with_proof(Proof::CERTIFIED), tree.frame());
    let [mut full, mut upper] = [vec![None; rays.len()], vec![None; rays.len()]];
    for (on, hits) in [(Obstacle::Full, &mut full), (Obstacle::Upper, &mut upper)] {
        tree.cast_rays(&rays, on, hits).expect("as many hits as rays");
        for (ray, hit) in rays.iter().zip(&*hits) {
            assert_eq!(tree.cast_ray(ray, on), *hit);
            assert!(hit.is_none_or(|hit| hit.t.lower <= hit.t.upper && hit.t.lower <= 1.0));
        }
    }
    if is_solid {
        let exact = |on| cast_rays(&solid, frame, &rays, on, &SOME).expect("it is a solid");
        let (exact_full, exact_upper) = (exact(Obstacle::Full), exact(Obstacle::Upper));
        for (i, ray) in rays.iter().enumerate() {
            // A proven hit is a possible hit, at a possible time.
            for (sure, perhaps) in [(full[i], exact_upper[i]), (exact_full[i], upper[i])] {
                let overlap = |a: RayHit, b: RayHit| a.t.lower <= b.t.upper && b.t.lower <= a.t.upper;
                let agree = sure.is_none_or(|sure| perhaps.is_some_and(|perhaps| overlap(sure, perhaps)));
                assert!(agree, "{ray:?}: {sure:?}, {perhaps:?}");
            }
        }
    }
    // Each of these may take 3 · 2^depth steps.
    for ray in rays.iter().take(if frame.depth() < 12 { 4 } else { 0 }) {
        let spans = tree.ray_spans(ray).expect("there is memory");
        let within = |inner: &[Interval], outer: &[Interval]| {
            let holds = |a: &Interval, b: &Interval| b.lower <= a.lower && a.upper <= b.upper;
            inner.iter().all(|inner| outer.iter().any(|outer| holds(inner, outer)))
        };
        assert!(within(&spans.inner, &spans.outer), "{ray:?}: {spans:?}");
        if is_solid {
            let exact = ray_spans(&solid, frame, ray, &SOME).expect("it is a solid");
            let agree = within(&exact.inner, &spans.outer) && within(&spans.inner, &exact.outer);
            assert!(agree, "{ray:?}: {spans:?}, {exact:?}");
        }
    }
}

/// Renders small pictures of the surface, of a slice and of the voxels, from anywhere. Where a surface is
/// visible, a ray meets it.
fn ask_pictures(tree: &OctreeRef<'_>, points: &[[f64; 3]]) {
    let [Some(eye), Some(at)] = [points.first(), points.get(1)] else { return };
    let edge = tree.frame().edge();
    let middle = tree.frame().origin()[2] + 0.5 * edge;
    let outlined = Finish { edges: Some(Outline::default()), ..Finish::default() };
    let records = VoxelRecords::of(tree, &VoxelOptions::new().boundary_depth(4), None, &CONTROL);
    for lens in [Lens::Perspective(50.0), Lens::Parallel(edge)] {
        let Ok(camera) = Camera::new(*eye, *at, [0.1, 0.2, 1.0], lens) else { continue };
        let shot = Shot { samples: 1, ..Shot::new(camera, [7, 5]) };
        let take = |layer: &dyn Layer| render(&shot, &[layer], &CONTROL).expect("nothing is wrong with it");
        let surface = take(&OctreeLayer::new(tree, Finish::default()));
        assert_eq!(
            surface.depths(),
            take(&OctreeLayer::new(tree, Finish { faces: true, ..Finish::default() })).depths()
        );
        for (seen, lined) in surface.depths().iter().zip(take(&OctreeLayer::new(tree, outlined)).depths()) {
            assert!(seen == lined || (seen - lined).abs() <= 1e-6 * seen.abs());
        }
        // The middle pixel shows a part of the surface, up to rounding.
        let depth = f64::from(surface.depths()[17]);
        if depth.is_finite() {
            let (eye, along) = (camera.eye(), camera.forward());
            let slack = 1e-6 * (edge + depth + eye.iter().fold(0.0, |most, x| x.abs().max(most)));
            let [low, high] =
                [-slack, slack].map(|slack| [0, 1, 2].map(|axis| eye[axis] + depth * along[axis] + slack));
            assert_ne!(tree.classify_box(low, high).ok(), Some(Region::Outside));
        }
        if let Ok(plane) = SlicePlane::across(2, middle) {
            take(&SliceLayer::new(tree, plane));
        }
        if let (Ok(records), Ok(transfer)) =
            (&records, Transfer::new(ColourMap::Viridis, [0.0, 1.0], 0.5, edge))
        {
            take(&VolumeLayer::new(records.view(), transfer));
        }
    }
}

/// Returns all cells of a tree in a cursor's order.
fn walked(tree: &OctreeRef<'_>) -> impl Iterator<Item = TaggedCell> {
    let mut cursor = Cursor::new(tree);
    let mut next = Vec::new();
    std::iter::from_fn(move || {
        if next.is_empty() {
            next.push(0);
            return Some(TaggedCell { cell: cursor.cell(), tag: cursor.tag() });
        }
        while let Some(octant) = next.pop() {
            if cursor.tag() == Tag::Branch && octant < 8 {
                cursor.descend(octant);
                next.extend([octant + 1, 0]);
                return Some(TaggedCell { cell: cursor.cell(), tag: cursor.tag() });
            }
            cursor.ascend();
        }
        next.push(8);
        None
    })
}

/// Checks that the iterator returns the cells in a cursor's order, and that there are no more boundary faces
/// than a sound tree of this size can have.
fn ask_cells(tree: &OctreeRef<'_>) {
    let entries = (tree.element_count() + tree.brick_count()) as usize;
    let all = CellFilter::tags(&[Tag::Empty, Tag::Branch, Tag::Partial, Tag::Full]);
    assert!(tree.cells(all).eq(walked(tree)));
    let depth = tree.frame().depth();
    let finest = |found: &TaggedCell| found.tag != Tag::Branch && found.cell.level == depth;
    let leaves = tree.cells(CellFilter::leaves().levels(depth..=depth));
    assert!(leaves.eq(walked(tree).filter(finest)));
    let middle = walked(tree).nth(tree.cells(all).count() / 2).expect("a cell of the tree");
    let mut cells = tree.cells(all);
    cells.seek(middle.cell).expect("a cell of the tree");
    assert!(cells.count() <= 1 + 72 * entries);
    let faces = tree.boundary_faces(CellFilter::tags(&[Tag::Full])).count();
    assert!(faces <= 96 * (1 + 73 * entries), "{faces} faces, {entries} entries");
}

/// Checks that the neighbours of some cells are leaves beside them; in a sound tree, those that a cursor
/// finds.
fn ask_neighbours(tree: &OctreeRef<'_>, verified: bool) {
    let entries = (tree.element_count() + tree.brick_count()) as usize;
    let all = CellFilter::tags(&[Tag::Empty, Tag::Branch, Tag::Partial, Tag::Full]);
    let mut cursor = Cursor::new(tree);
    let mut other = Cursor::new(tree);
    for found in tree.cells(all).take(3000).step_by(397) {
        let reached = cursor.seek(found.cell).expect("a cell of the tree");
        assert!(!verified || (reached && cursor.tag() == found.tag));
        let cell = cursor.cell();
        for direction in Direction::ALL {
            let neighbour = cursor.neighbour(direction);
            assert!(cursor.neighbours(direction).count() <= 1 + 72 * entries);
            let Some(TaggedCell { cell: beside, tag }) = neighbour else { continue };
            assert!(beside.level == cell.level || (beside.level < cell.level && tag != Tag::Branch));
            if verified {
                other.seek(beside).expect("a cell of the tree");
                assert_eq!((other.cell(), other.tag()), (beside, tag));
            }
        }
    }
}

/// Checks that rays between points end, one by one and together, and that inner spans lie within outer spans.
fn ask_rays(tree: &OctreeRef<'_>, points: &[[f64; 3]]) {
    let mut rays: Vec<Ray> =
        points.windows(2).filter_map(|pair| Ray::between(pair[0], pair[1]).ok()).collect();
    if let [a, b, ..] = points {
        // Side by side.
        let (cell, to) = (tree.frame().cell_size(), [0, 1, 2].map(|axis| b[axis] - a[axis]));
        let from = |i: u8| [a[0] + f64::from(i) * cell, a[1], a[2] - 0.3 * f64::from(i) * cell];
        rays.extend((0..64).filter_map(|i| Ray::new(from(i), to).and_then(|ray| ray.until(1.0)).ok()));
    }
    let mut hits = vec![None; rays.len()];
    for on in [Obstacle::Full, Obstacle::Upper] {
        tree.cast_rays(&rays, on, &mut hits).expect("as many hits as rays");
        for (ray, hit) in rays.iter().zip(&hits) {
            assert_eq!(tree.cast_ray(ray, on), *hit);
            assert!(hit.is_none_or(|hit| hit.t.lower <= hit.t.upper && hit.t.lower <= 1.0));
        }
    }
    // Each of these may take 3 · 2^depth steps.
    for ray in rays.iter().take(if tree.frame().depth() < 12 { 8 } else { 0 }) {
        let spans = tree.ray_spans(ray).expect("there is memory");
        assert!(spans.inner.iter().all(|inner| {
            spans.outer.iter().any(|outer| outer.lower <= inner.lower && inner.upper <= outer.upper)
        }));
    }
}

/// Checks that runs of cells in columns ascend; in a sound tree, they are its FULL cells.
fn ask_columns(tree: &OctreeRef<'_>, verified: bool) {
    let (cells, depth) = (tree.frame().cells(), tree.frame().depth());
    for axis in 0..3 {
        let first = [cells / 3, cells / 2];
        let columns = match depth {
            0..7 => Columns::all(tree.frame(), axis),
            _ => Columns::within(axis, first, first.map(|a| a + 8)),
        };
        let columns = columns.expect("there are such columns");
        let found = tree.columns(&columns).expect("there is memory");
        let above = tree.heights(&columns, Side::Above).expect("there is memory");
        let mut volume = 0;
        for index in 0..columns.count() as usize {
            for runs in [found.full.column(index), found.upper.column(index)] {
                assert!(runs.iter().all(|run| run.length > 0 && run.start + run.length <= cells));
                assert!(runs.windows(2).all(|pair| pair[0].start + pair[0].length < pair[1].start));
            }
            let top = |runs: &[Run]| runs.last().map(|run| run.start + run.length);
            assert_eq!(above.full_plane(index), top(found.full.column(index)));
            assert_eq!(above.upper_plane(index), top(found.upper.column(index)));
            volume += found.full.column(index).iter().map(|run| u64::from(run.length)).sum::<u64>();
        }
        if verified && depth < 7 {
            let full = tree.cells(CellFilter::tags(&[Tag::Full]));
            let finest = |found: TaggedCell| 1u64 << (3 * (depth - found.cell.level));
            assert_eq!(volume, full.map(finest).sum::<u64>());
        }
    }
}

/// Checks that distance queries end whatever the bytes. In a sound tree they agree with points and cells.
fn ask_distances(tree: &OctreeRef<'_>, points: &[[f64; 3]], verified: bool) {
    for &point in points.iter().step_by(5) {
        let [solid, complement, boundary] = [DistanceTo::Solid, DistanceTo::Complement, DistanceTo::Boundary]
            .map(|to| tree.distance(point, to).expect("nothing is allocated"));
        assert!(solid.lower <= solid.upper && complement.lower <= complement.upper);
        assert!(boundary.lower <= boundary.upper);
        let tags = [Tag::Full, Tag::Partial];
        let Ok(near) = tree.nearest_cells(point, &tags, 4) else {
            assert!(!point.iter().all(|c| c.is_finite()));
            continue;
        };
        assert!(near.windows(2).all(|pair| pair[0].distance.lower <= pair[1].distance.upper));
        if !verified {
            continue;
        }
        match tree.contains(point) {
            Membership::Inside => assert!(solid.lower == 0.0 && boundary.lower <= 0.0),
            Membership::Outside => assert!(complement.lower == 0.0 && boundary.upper >= 0.0),
            Membership::Undecided => {}
        }
        if let (Some(nearest), Tag::Empty) = (near.first(), tree.exterior()) {
            assert_eq!(nearest.distance.lower, solid.lower, "{point:?}");
        }
    }
    let cells = tree.frame().cells();
    let Some(at) = points.iter().find_map(|&point| tree.frame().cell_of(point)) else { return };
    let (min, max) = (at.map(|a| a.saturating_sub(2)), at.map(|a| (a + 3).min(cells)));
    let size = [0, 1, 2].map(|axis: usize| max[axis] - min[axis]);
    let mut field = vec![[f32::NAN; 2]; size.iter().product::<u32>() as usize];
    tree.distance_field(min, max, &mut field, &CONTROL).expect("enough memory");
    for (k, [lower, upper]) in (0..).zip(field) {
        assert!(lower <= upper);
        let cell = [min[0] + k % size[0], min[1] + k / size[0] % size[1], min[2] + k / size[0] / size[1]];
        match tree.tag_at(cell) {
            Tag::Empty if verified => assert!(lower > 0.0),
            Tag::Full if verified => assert!(upper < 0.0),
            _ => {}
        }
    }
}

/// Checks that the content of a box fits into the box, and that the whole universe has the content that the
/// statistics report.
fn ask_contents(tree: &OctreeRef<'_>, points: &[[f64; 3]], verified: bool) {
    let cells = tree.frame().cells();
    let (least, most) = tree.cells_in_box([0; 3], [cells; 3]).expect("the universe");
    assert!(least <= most && most <= u64::from(cells).pow(3));
    if verified {
        let volumes = [&[Tag::Full][..], &[Tag::Full, Tag::Partial]].map(|tags| {
            let volume = |found: TaggedCell| 1u64 << (3 * (tree.frame().depth() - found.cell.level));
            tree.cells(CellFilter::tags(tags)).map(volume).sum::<u64>()
        });
        assert_eq!([least, most], volumes);
    }
    for corners in points.chunks_exact(2) {
        let min = [0, 1, 2].map(|axis: usize| corners[0][axis].min(corners[1][axis]));
        let max = [0, 1, 2].map(|axis: usize| corners[0][axis].max(corners[1][axis]));
        let Ok(volume) = tree.volume_in_box(min, max) else {
            assert!(corners.iter().flatten().any(|c| c.is_nan()));
            continue;
        };
        assert!(0.0 <= volume.lower && volume.lower <= volume.upper);
    }
    // In the universe as a region of any shape, and in a ball.
    let frame = tree.frame();
    let middle = frame.origin().map(|c| c + frame.edge() / 2.0);
    for radius in [2.0, 0.3] {
        let Ok(ball) = Csg::ball(middle, radius * frame.edge()) else { continue };
        let some = Control { max_splits: Some(1000), ..CONTROL };
        let control = if radius > 1.0 { CONTROL } else { some };
        let found = tree.cells_in(&ball, &control).expect("a ball");
        assert!(found.full_least <= found.full_most && found.upper_least <= found.upper_most);
        assert!(found.upper_most <= u64::from(cells).pow(3));
        let volume = tree.volume_in(&ball, &control).expect("a ball");
        assert!(0.0 <= volume.lower && volume.lower <= volume.upper);
        if verified && radius > 1.0 {
            assert_eq!([found.full_least, found.upper_most], [least, most]);
        }
    }
}

/// The most points of a query.
const MOST_POINTS: usize = 48;

/// Points in and around the universe, on lattice planes and next to them, and absurd points.
pub fn points(frame: &Frame, questions: &[u8]) -> Vec<[f64; 3]> {
    let mut random = Random(crc32fast::hash(questions).into());
    let mut coordinate = |axis: usize, code: u8, value: u16| {
        let plane = frame.plane(axis, value as u32 % (frame.cells() + 1));
        match code % 16 {
            0 => f64::from_bits(random.bits()),
            1 => [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, -0.0][value as usize % 5],
            2 => plane.lower,
            3 => plane.upper.next_up(),
            4 => plane.lower.next_down(),
            5 => frame.origin()[axis] + frame.edge(),
            _ => frame.origin()[axis] + frame.edge() * (value as f64 / 60_000.0 - 0.05),
        }
    };
    let mut points = vec![];
    for raw in questions.chunks_exact(9).take(MOST_POINTS) {
        points.push(
            [0, 1, 2]
                .map(|k| coordinate(k, raw[3 * k], u16::from_le_bytes([raw[3 * k + 1], raw[3 * k + 2]]))),
        );
    }
    for value in 0..16u16 {
        points.push([0, 1, 2].map(|axis| coordinate(axis, 6, value.wrapping_mul(4000 + 777 * axis as u16))));
    }
    points
}

fn ask_points(tree: &OctreeRef<'_>, points: &[[f64; 3]]) {
    let mut answers = vec![Membership::Inside; points.len()];
    tree.contains_many(points, &mut answers).expect("as many answers as points");
    let mut remembering = PointCursor::new(tree);
    let tables = [1, 4].map(|level| PointTable::new(tree, level).expect("a small table"));
    for (&point, &answer) in points.iter().zip(&answers) {
        assert_eq!((tree.contains(point), remembering.contains(point)), (answer, answer), "{point:?}");
        assert_eq!(tables.each_ref().map(|table| table.contains(point)), [answer; 2], "{point:?}");
        let Some(at) = tree.frame().cell_of(point) else {
            assert_eq!(answer, Membership::Undecided);
            continue;
        };
        let tag = tree.tag_at(at);
        assert_eq!((Membership::from(tag), remembering.tag_at(at)), (answer, tag));
        // The same cell, level by level.
        let mut cursor = Cursor::new(tree);
        while cursor.tag() == Tag::Branch {
            let below = tree.frame().depth() - cursor.cell().level - 1;
            let octant = (0..3).fold(0, |octant, axis| octant | (at[axis] >> below & 1) << axis);
            assert!(cursor.descend(octant as u8));
        }
        assert_eq!(cursor.tag(), tag, "{at:?}");
    }
    for at in [[u32::MAX; 3], [0, 0, tree.frame().cells()]] {
        assert_eq!((tree.tag_at(at), remembering.tag_at(at)), (Tag::Partial, Tag::Partial));
    }
}

fn ask_boxes(tree: &OctreeRef<'_>, points: &[[f64; 3]]) {
    for corners in points.chunks_exact(2) {
        let min = [0, 1, 2].map(|axis: usize| corners[0][axis].min(corners[1][axis]));
        let max = [0, 1, 2].map(|axis: usize| corners[0][axis].max(corners[1][axis]));
        let Ok(region) = tree.classify_box(min, max) else {
            assert!(corners.iter().flatten().any(|c| c.is_nan()));
            continue;
        };
        for &point in points {
            // The cell of a point strictly inside the box shares more than a face with the box.
            if (0..3).all(|axis| min[axis] < point[axis] && point[axis] < max[axis]) {
                match tree.contains(point) {
                    Membership::Inside => assert_ne!(region, Region::Outside),
                    Membership::Outside => assert_ne!(region, Region::Inside),
                    Membership::Undecided => {
                        assert!(region == Region::Undecided || region == Region::Crossing)
                    }
                }
            }
        }
    }
}

/// Checks the tree as a solid: the splits from the root to a cell lead to the cell's tag.
fn replay(tree: &OctreeRef<'_>, points: &[[f64; 3]]) {
    let solid = *tree;
    let frame = tree.frame();
    let Ok(classifier) = solid.on(frame, &CONTROL) else { return };
    let mut worker = classifier.worker().expect("nothing is allocated");
    let root = worker.root().expect("nothing is allocated");
    for &point in points {
        let Some(at) = frame.cell_of(point) else { continue };
        let mut verdict = root;
        let mut cell = Cell::ROOT;
        let mut parts = vec![];
        while let Verdict::Partial(part) = verdict {
            let below = frame.depth() - cell.level - 1;
            let octant = (0..3).fold(0, |octant, axis| octant | (at[axis] >> below & 1) << axis) as u8;
            let children = worker.split(cell, &part).expect("nothing is allocated");
            if below > 0 {
                parts.clear();
                let planes = worker.split64(cell, &part, &mut parts).expect("enough memory");
                assert_eq!(planes.branch(), 0);
                assert!(parts.iter().all(|&(c, _)| planes.partial() >> c & 1 != 0));
            }
            verdict = children[octant as usize];
            cell = cell.child(octant);
        }
        assert_eq!(verdict.tag(), tree.tag_at(at), "{at:?}");
    }
}

/// Queries the tree as a solid without an octree. The answers are the tree's own, if its cells are taken for
/// the solid.
fn ask_solid(tree: &OctreeRef<'_>, points: &[[f64; 3]]) {
    let (solid, frame) = (tree.with_proof(Proof::CERTIFIED), tree.frame());
    let mut answers = vec![Membership::Inside; points.len()];
    if contains(&solid, frame, points, &mut answers, &CONTROL).is_err() {
        assert!(solid.on(frame, &CONTROL).is_err());
        return;
    }
    for (&point, &answer) in points.iter().zip(&answers) {
        assert_eq!(answer, tree.contains(point), "{point:?}");
    }
    for corners in points.chunks_exact(2) {
        let min = [0, 1, 2].map(|axis: usize| corners[0][axis].min(corners[1][axis]));
        let max = [0, 1, 2].map(|axis: usize| corners[0][axis].max(corners[1][axis]));
        let found = classify_box(&solid, frame, min, max, &CONTROL).ok();
        assert_eq!(found, tree.classify_box(min, max).ok(), "{min:?} {max:?}");
    }
}

/// Splits the tree on demand as a solid. The result lies between no knowledge and the tree, and is
/// well-formed.
fn on_demand(tree: &OctreeRef<'_>, points: &[[f64; 3]]) {
    let frame = tree.frame();
    let Ok(mut lazy) = LazyOctree::new(*tree, frame) else { return };
    for (k, pair) in points.chunks_exact(2).enumerate() {
        let level = (k * 5) as u8 % (frame.depth() + 1);
        let (from, to) = ([0.0, 0.5, f64::NEG_INFINITY][k % 3], [1.0, f64::INFINITY][k % 2]);
        let zone = match k % 4 {
            0 => Zone::Point(pair[0]),
            1 => Zone::Ray { origin: pair[0], direction: pair[1], from, to },
            2 => Zone::Box {
                min: [0, 1, 2].map(|axis: usize| pair[0][axis].min(pair[1][axis])),
                max: [0, 1, 2].map(|axis: usize| pair[0][axis].max(pair[1][axis])),
            },
            _ => Zone::Box { min: pair[0], max: pair[1] },
        };
        let max_splits = if k % 3 == 0 { Some(20) } else { None };
        // Invalid numbers are refused.
        let _ = lazy.refine(&zone, level, &Control { max_splits, ..CONTROL });
        let at = pair[0].map(|c| c.to_bits() as u32 >> (32 - level.clamp(1, 20)));
        let cell = Cell { level, at };
        if lazy.can_split(cell) {
            lazy.split(cell).expect("it can be split");
            assert!(!lazy.can_split(cell));
        }
    }
    for &point in points {
        let found = lazy.contains(point);
        assert!(found == Membership::Undecided || found == tree.contains(point));
    }
    let nodes = lazy.statistics().nodes();
    assert!(nodes <= lazy.splits() && nodes <= 9 * (tree.element_count() + tree.brick_count()));
    let frozen = lazy.freeze(&CONTROL).expect("enough memory");
    frozen.view().check().expect("it is well-formed");
    assert_eq!(lazy.statistics().volume(), frozen.statistics().volume());
    lazy.refine(&Zone::Whole, frame.depth(), &CONTROL).expect("enough memory");
    let whole = lazy.freeze(&CONTROL).expect("enough memory");
    // Subtrees are copied unchanged. Only a check shows whether they are sound.
    let built = build(tree, frame, Rule::Certified, &CONTROL);
    assert!(tree.check().is_err() || whole == built.expect("it is sound"));
}
