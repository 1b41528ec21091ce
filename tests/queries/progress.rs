//! The progress that long operations report. It rises, reaches the whole, and has no gap with most of the
//! work in it.

use leafless::attribute::{
    FillOptions, FunctionAttribute, ScalarType, ValueType, dexel_materials, fill_channel, sample_triangles,
};
use leafless::dexel::{DexelEditor, DexelEnds, DexelFormat, DexelNormals};
use leafless::layout::{Bay, Item, Layout, Objective, SearchOptions};
use leafless::op::{
    DexelOptions, Zone, difference_of, intersection_of, octree_from_dexel_ends, octree_from_dexels, resolve,
    union_of, xor_of,
};
use leafless::query::{
    Columns, DistanceTo, Obstacle, SectionPlane, Side, cells_in, clearance_at, columns, distances,
    gap_at_least, gap_at_least_at, heights, interference_at, section_area, surface_area, volume_in,
};
use leafless::render::{Camera, Finish, Shot, SolidLayer, render};
use leafless::solid::{Band, VoxelGrid};
use leafless::surface::{
    DexelSolid, Snap, VertexPlacement, boundary, contour, coplanar_shrink, coplanar_shrink_solid,
    dual_contouring_dexels, marching_cubes_dexels, marching_cubes_solid, marching_cubes_volume,
    published_shrink, simple_marching_cubes, simplify, surface_nets,
};
use leafless::voxel::{Symmetry, Viewpoint, VoxelOptions, VoxelRecords, dexel_voxels};
use leafless::{
    Affine, AnySolid, Bounds, Control, Csg, Error, FillRule, Frame, LazyOctree, Membership, MeshSolid,
    Octree, Ray, Rule, SurfaceOptions, Tag, TriDexel, TriangleMesh, Volume, bounding_box, build,
    build_extended, cast_rays, clearance, complement, contains, deviation, dexelize, difference,
    intersection, marching_cubes, measure, union, xor,
};
use leafless_testkit::Random;
use std::sync::{Arc, Mutex};
use std::time::Instant;

const CONTROL: Control<'static> =
    Control { threads: 1, max_nodes: None, max_bytes: None, max_splits: None, cancel: None, progress: None };

/// The progress reports of one operation.
struct Told {
    name: &'static str,
    fractions: Vec<f64>,
    /// The greatest difference of two successive reports, including 0 and 1.
    widest: f64,
    /// The longest time without a report, as a fraction of the total time.
    stillest: f64,
    milliseconds: f64,
}

#[derive(Default)]
struct Heard(Vec<Told>);

impl Heard {
    fn of<R>(&mut self, name: &'static str, work: impl FnOnce(&Control<'_>) -> Result<R, Error>) -> R {
        let seen = Mutex::new(vec![]);
        let progress = |fraction: f64| seen.lock().unwrap().push((fraction, Instant::now()));
        let start = Instant::now();
        let made = work(&Control { progress: Some(&progress), ..CONTROL })
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let end = Instant::now();
        let seen = seen.into_inner().unwrap();
        let fractions: Vec<f64> = seen.iter().map(|&(fraction, _)| fraction).collect();
        let gap = |all: &[f64]| all.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        let whole = (end - start).as_secs_f64();
        let times: Vec<f64> = [start]
            .into_iter()
            .chain(seen.iter().map(|&(_, time)| time))
            .chain([end])
            .map(|time| (time - start).as_secs_f64() / whole)
            .collect();
        let widest = gap(&[&[0.0], &*fractions, &[1.0]].concat());
        let told = Told { name, fractions, widest, stillest: gap(&times), milliseconds: 1e3 * whole };
        self.0.push(told);
        made
    }
}

/// Operations that are one search up to a tolerance. The length of such a search is unknown in advance.
const SEARCHES: &[&str] = &[
    "bounding box",
    "clearance",
    "clearances",
    "clearance of meshes",
    "deviation",
    "gap",
    "gaps",
    "interference",
    "section area",
    "single precision",
];

/// Operations of a single step, which report only the end, or nothing.
const ONE_STEP: &[&str] = &[
    "build of a mesh",
    "complement of extended",
    "octree of dexels",
    "rays of a mesh",
    "records in order",
    "records turned",
    "records with triangles",
    "solid parts",
    "summary",
    "voxels of dexels",
];

fn all_operations(depth: u8) -> Vec<Told> {
    let frame = Frame::new([-1.0; 3], 2.0, depth).unwrap();
    let mut heard = Heard::default();
    let ball = Csg::ball([0.05, 0.02, -0.03], 0.8).unwrap();
    let bars = [0.0, 0.35, -0.4].map(|x| Csg::cuboid([x, -0.9, -0.2], [x + 0.2, 0.9, 0.3]).unwrap());
    let part = ball.difference(&Csg::union_of(bars.clone()).unwrap()).unwrap();

    // Octrees.
    let of_part = heard.of("build", |control| build(&part, &frame, Rule::Certified, control));
    let sampled = heard.of("build sampled", |control| build(&part, &frame, Rule::Sampled, control));
    heard.of("resolve", |control| resolve(of_part.view(), Rule::Outer, control));
    let balls: Vec<Octree> = (0..6)
        .map(|i| {
            let ball = Csg::ball([0.1 * f64::from(i) - 0.3, 0.05 * f64::from(i), 0.1], 0.6).unwrap();
            build(&ball, &frame, Rule::Certified, &CONTROL).unwrap()
        })
        .collect();
    let views: Vec<_> = balls.iter().map(|tree| *tree.view()).collect();
    heard.of("union", |control| union(&views[0], &views[1], control));
    heard.of("intersection", |control| intersection(&views[0], &views[1], control));
    heard.of("difference", |control| difference(of_part.view(), &views[1], control));
    heard.of("xor", |control| xor(&views[0], &views[1], control));
    heard.of("complement", |control| complement(&views[0], control));
    heard.of("union of many", |control| union_of(&views, control));
    heard.of("intersection of many", |control| intersection_of(&views, control));
    heard.of("difference of many", |control| difference_of(&views, control));
    heard.of("xor of many", |control| xor_of(&views, control));

    // Octrees that keep surfaces.
    let extended: Vec<Octree> = (0..40)
        .map(|i| {
            let angle = 0.5 * f64::from(i);
            let ball = Csg::ball([0.5 * angle.cos(), 0.5 * angle.sin(), 0.02 * f64::from(i) - 0.4], 0.35);
            build_extended(&ball.unwrap(), &frame, &SurfaceOptions::default(), &CONTROL).unwrap()
        })
        .collect();
    let sharp: Vec<_> = extended.iter().map(|tree| *tree.view()).collect();
    let halves = [&sharp[..20], &sharp[20..]].map(|half| union_of(half, &CONTROL).unwrap());
    heard.of("union of extended", |control| union(halves[0].view(), halves[1].view(), control));
    heard.of("union of many extended", |control| union_of(&sharp, control));
    heard.of("complement of extended", |control| complement(halves[0].view(), control));

    // Meshes.
    let mesh = heard.of("marching cubes", |control| marching_cubes(sampled.view(), None, control));
    heard.of("simple marching cubes", |control| {
        simple_marching_cubes(sampled.view(), Snap::Fat, None, control)
    });
    heard.of("surface nets", |control| surface_nets(sampled.view(), None, control));
    heard.of("coplanar shrink", |control| coplanar_shrink(sampled.view(), Snap::Fat, None, control));
    heard.of("published shrink", |control| published_shrink(sampled.view(), Snap::Fat, None, control));
    heard.of("marching cubes of a solid", |control| {
        marching_cubes_solid(&part, &frame, VertexPlacement::Crossing, control)
    });
    heard.of("boundary", |control| boundary(&part, &frame, 1e-3, control));
    heard
        .of("coplanar shrink of a solid", |control| coplanar_shrink_solid(&part, &frame, Snap::Fat, control));
    let mesh = Arc::new(mesh);
    let solid = MeshSolid::new(mesh.clone(), FillRule::NonZero).unwrap();
    heard.of("build of a mesh", |control| build(&solid, &frame, Rule::Certified, control));
    heard.of("simplify", |control| simplify(&mesh, 0.01, control));
    heard.of("boundary of a mesh", |control| boundary(&solid, &frame, 0.01, control));
    heard.of("contour of a mesh", |control| contour(&solid, &frame, 0.02, control));
    heard.of("rays of a mesh", |control| solid.odd_rays(&frame, control));

    // Volumes.
    let side = 1u32 << depth;
    let waves: Vec<f32> = (0..side.pow(3))
        .map(|i| ((i % side) as f32 * 0.2).sin() + ((i / side / side) as f32 * 0.1).cos())
        .collect();
    let grid = VoxelGrid::new([side; 3], [0.0; 3], [1.0; 3]).unwrap();
    let volume = Volume::new(waves[..].into(), &grid, Band::at_least(0.3).unwrap(), &CONTROL).unwrap();
    heard.of("marching cubes of a volume", |control| marching_cubes_volume(&volume, control));

    // Tri-dexel models.
    let normals = DexelFormat { normals: DexelNormals::Bits32, ..DexelFormat::default() };
    let options = DexelOptions { format: normals, ..DexelOptions::default() };
    let model = heard.of("dexelize", |control| dexelize(&part, &frame, &options, control));
    heard.of("dexelize a mesh", |control| dexelize(&solid, &frame, &options, control));
    let models: Vec<TriDexel> = (0..6)
        .map(|i| {
            let ball = Csg::ball([0.1 * f64::from(i) - 0.3, 0.05 * f64::from(i), 0.1], 0.6).unwrap();
            dexelize(&ball, &frame, &DexelOptions::default(), &CONTROL).unwrap()
        })
        .collect();
    let dexels: Vec<_> = models.iter().map(|model| *model.view()).collect();
    let doubles = DexelFormat { ends: DexelEnds::Double, ..DexelFormat::default() };
    let double = heard.of("dexels in another format", |control| dexels[0].to_format(doubles, control));
    heard.of("dexels of a material", |control| dexels[0].with_material(3, control));
    heard.of("union of dexels", |control| dexels[0].union(&dexels[1], control));
    heard.of("difference of dexels", |control| model.view().difference(&dexels[1], control));
    heard.of("union of dexels of two kinds", |control| double.view().union(&dexels[1], control));
    heard.of("complement of dexels", |control| dexels[0].complement(control));
    heard.of("union of many dexels", |control| TriDexel::union_of(&dexels, control));
    heard.of("difference of many dexels", |control| TriDexel::difference_of(&dexels, control));
    let mut editor = DexelEditor::new(model.view()).unwrap();
    heard.of("dexels cut by a model", |control| editor.subtract(&dexels[1], control));
    heard.of("dexels cut by one of another kind", |control| editor.subtract(double.view(), control));
    heard.of("dexels cut by a solid", |control| editor.subtract_solid(&bars[0], control));
    heard.of("dexels and a solid", |control| editor.intersect_solid(&ball, control));
    heard.of("editor frozen", |control| editor.freeze(control));
    heard.of("marching cubes of dexels", |control| marching_cubes_dexels(model.view(), control));
    heard.of("dual contouring", |control| dual_contouring_dexels(model.view(), control));
    heard.of("octree of dexels", |control| octree_from_dexels(model.view(), control));
    heard.of("octree of ends of dexels", |control| octree_from_dexel_ends(model.view(), control));
    let (steel, whole) = (model.view().with_material(1, &Control::default()).unwrap(), model.view());
    let cells = octree_from_dexels(whole, &Control::default()).unwrap();
    heard.of("materials of dexels", |control| dexel_materials(steel.view(), cells.view(), control));
    heard.of("solid of dexels", |control| DexelSolid::new(model.view(), control));
    heard.of("voxels of dexels", |control| dexel_voxels(model.view(), &[], control));

    // Queries.
    let mut random = Random(7);
    let mut point = || [0; 3].map(|_| random.between(-0.9, 0.9));
    let points: Vec<[f64; 3]> = (0..40_000).map(|_| point()).collect();
    let mut answers = vec![Membership::Undecided; points.len()];
    heard.of("contains", |control| contains(&part, &frame, &points, &mut answers, control));
    let rays: Vec<Ray> = points
        .chunks(2)
        .take(4000)
        .map(|pair| Ray::new(pair[0], [0, 1, 2].map(|i| pair[1][i] - pair[0][i])).unwrap())
        .collect();
    heard.of("rays", |control| cast_rays(&part, &frame, &rays, Obstacle::Upper, control));
    heard.of("distances", |control| {
        distances(&part, &frame, &points[..500], DistanceTo::Boundary, 0.01, control)
    });
    let mut intervals = vec![leafless::Interval::exactly(0.0); 4000];
    heard.of("distances from an octree", |control| {
        of_part.distances(&points[..4000], DistanceTo::Solid, &mut intervals, control)
    });
    let region = Csg::ball([0.4, 0.0, 0.0], 0.5).unwrap();
    heard.of("cells in a region", |control| cells_in(&part, &region, &frame, control));
    heard.of("volume in a region", |control| volume_in(&part, &region, &frame, control));
    heard.of("cells of an octree in a region", |control| of_part.cells_in(&region, control));
    let all = Columns::all(&frame, 2).unwrap();
    heard.of("columns", |control| columns(&part, &frame, &all, control));
    heard.of("heights", |control| heights(&part, &frame, &all, Side::Above, control));
    heard.of("measure", |control| measure(&part, &frame, 1e-4, control));
    heard.of("surface area", |control| surface_area(&part, &frame, 1e-2, control));
    let plane = SectionPlane::new([0.0, 0.0, 0.1], [0.0, 0.0, 1.0]).unwrap();
    heard.of("section area", |control| section_area(&part, &frame, &plane, 1e-6, control));
    heard.of("bounding box", |control| bounding_box(&part, &frame, 1e-9, control));
    heard.of("interference", |control| {
        let turn = Affine::translation([0.1, 0.2, 0.3]).unwrap();
        interference_at(&ball, &part, &frame, &[turn; 4], &frame, 0.0, control)
    });
    heard.of("clearance", |control| {
        let moved = region.placed(&Affine::translation([0.0, 0.0, 0.0]).unwrap())?;
        let apart = Csg::ball([-0.6, 0.0, 0.0], 0.3)?;
        clearance(&moved, &apart, &frame, 1e-6, &Control { max_splits: Some(20_000), ..*control })
    });
    heard.of("deviation", |control| {
        deviation(&part, &ball, &frame, 1e-2, &Control { max_splits: Some(2_000), ..*control })
    });
    heard.of("clearances", |control| {
        let turn = Affine::translation([0.1, 0.2, 0.3]).unwrap();
        clearance_at(&ball, &part, &frame, &[turn; 4], &frame, 1e-3, control)
    });
    heard.of("clearance of meshes", |control| {
        let mesh = || -> Result<MeshSolid, Error> {
            let vertices = vec![[-0.2; 3], [0.4, -0.2, -0.2], [-0.2, 0.4, -0.2], [-0.2, -0.2, 0.4]];
            let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
            MeshSolid::new(TriangleMesh::new(vertices, triangles)?, FillRule::NonZero)
        };
        let turn = Affine::translation([0.45, 0.2, 0.3]).unwrap();
        clearance_at(&mesh()?, &mesh()?, &frame, &[turn; 4], &frame, 0.0, control)
    });
    heard.of("gap", |control| {
        let apart = Csg::ball([-0.6, 0.0, 0.0], 0.3)?;
        gap_at_least(&region, &apart, &frame, 1e-3, &Control { max_splits: Some(2000), ..*control })
    });
    heard.of("gaps", |control| {
        let turn = Affine::translation([0.1, 0.2, 0.3]).unwrap();
        gap_at_least_at(&ball, &part, &frame, &[turn; 4], &frame, 1e-3, control)
    });
    let container = AnySolid::new(Csg::cuboid([0.0; 3], [9.0; 3]).unwrap());
    let mut bay = Bay::new(container).unwrap().with_clearances(0.05, 0.0).unwrap();
    let item = Item::new(AnySolid::new(Csg::ball([0.0; 3], 1.0).unwrap())).unwrap();
    bay.add_item(item.with_count(60)).unwrap();
    let mut layout = Layout::new(&bay, &CONTROL).unwrap();
    let options =
        SearchOptions { cells: 40, rounds: 8, objective: Objective::Density, ..SearchOptions::default() };
    heard.of("layout searched", |control| layout.search(&options, control));
    heard.of("layout checked", |control| layout.check_all(control));
    heard.of("layout measured", |control| layout.measures(1e-2, control));
    let mut lazy = LazyOctree::new(&part, &frame).unwrap();
    heard.of("refine", |control| lazy.refine(&Zone::Whole, depth, control));
    heard.of("lazy octree frozen", |control| lazy.freeze(control));

    // Channels.
    let value_type = ValueType::new(ScalarType::F32, 1).unwrap();
    let options = FillOptions { value_type, frame, solid: Some(of_part.view()), detail: None };
    let steps = FunctionAttribute::new(1, |point: [f64; 3]| Some([(4.0 * point[0]).floor(), 0.0, 0.0, 0.0]));
    let steps = steps.unwrap();
    let channel = heard.of("channel filled", |control| fill_channel(&steps, &options, control));
    let surface =
        marching_cubes_solid(&ball, &frame, VertexPlacement::Crossing, &Control::threads(1)).unwrap();
    heard.of("triangles sampled", |control| sample_triangles(&surface, &steps, "steps", 0.01, control));
    let view = channel.view().unwrap();
    heard.of("single precision", |control| surface.in_single_precision(1e-3, control));
    heard.of("summary", |control| view.summary(Some(of_part.view()), None, control));
    heard.of("channel changed", |control| view.with_value_in(&views[0], Some([1.0, 0.0, 0.0, 0.0]), control));
    heard.of("region of values", |control| view.region([0.0; 4], [1.0; 4], control));

    // Voxel records.
    let records =
        heard.of("records", |control| VoxelRecords::of(of_part.view(), &VoxelOptions::new(), None, control));
    let records = records.view();
    heard.of("records turned", |control| {
        records.turned(Symmetry::new([1, 2, 0], [true, false, true]).unwrap(), control)
    });
    heard.of("records in order", |control| records.depth_order(&Viewpoint::Perspective([3.0; 3]), control));
    heard.of("records with triangles", |control| records.triangles(&mesh, control));
    heard.of("octree of records", |control| records.to_octree(Tag::Partial, control));
    heard.of("solid parts", |control| records.solid_parts(&part, control));

    // Pictures.
    let camera = Camera::fitted(&Bounds::of(&frame).corners(), [20.0, 30.0], Some(30.0), 1.0).unwrap();
    let layer = SolidLayer::new(&part, &frame, Finish::default());
    heard.of("picture", |control| render(&Shot::new(camera, [200, 200]), &[&layer], control));
    heard.0
}

#[test]
fn progress_rises_to_all_without_a_wide_gap() {
    let told = all_operations(6);
    let mut wrong = vec![];
    for told in &told {
        let Told { name, fractions, widest, .. } = told;
        let mut say = |what: String| wrong.push(format!("{name}: {what}"));
        if !fractions.is_sorted() {
            say("falls".into());
        }
        let ends = |last: f64| (1.0 - 1e-3..=1.0 + 1e-12).contains(&last);
        if fractions.last().map_or(!ONE_STEP.contains(name), |&last| !ends(last)) {
            say(format!("ends with {:?}", fractions.last()));
        }
        if *widest > 0.6 && !SEARCHES.contains(name) && !ONE_STEP.contains(name) {
            say(format!("a gap of {widest:.2}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A difference with many operands is the first without all others. Operands on another frame are refused
/// before any progress, whatever their position.
#[test]
fn differences_of_many() {
    let frame = Frame::new([-1.0; 3], 2.0, 5).unwrap();
    let ball = |x: f64| Csg::ball([x, 0.1, -0.2], 0.6).unwrap();
    let solids = [0.0, 0.3, -0.4, 0.45].map(ball);
    let trees = solids.each_ref().map(|solid| build(solid, &frame, Rule::Certified, &CONTROL).unwrap());
    let models =
        solids.each_ref().map(|solid| dexelize(solid, &frame, &DexelOptions::default(), &CONTROL).unwrap());
    let views = trees.each_ref().map(|tree| *tree.view());
    let dexels = models.each_ref().map(|model| *model.view());
    for count in 1..=4 {
        let (mut tree, mut model) = (trees[0].clone(), models[0].clone());
        for i in 1..count {
            tree = difference(tree.view(), &views[i], &CONTROL).unwrap();
            model = model.view().difference(&dexels[i], &CONTROL).unwrap();
        }
        assert!(difference_of(&views[..count], &CONTROL).unwrap() == tree, "{count}");
        let of_many = TriDexel::difference_of(&dexels[..count], &CONTROL).unwrap();
        assert!(of_many == model, "{count}");
    }
    let other = Frame::new([-1.0; 3], 2.0, 4).unwrap();
    let tree = build(&solids[0], &other, Rule::Certified, &CONTROL).unwrap();
    let model = dexelize(&solids[0], &other, &DexelOptions::default(), &CONTROL).unwrap();
    let told = |_| panic!("work was done");
    let control = Control { progress: Some(&told), ..CONTROL };
    for place in 0..4 {
        let (mut views, mut dexels) = (views, dexels);
        (views[place], dexels[place]) = (*tree.view(), *model.view());
        for found in [
            union_of(&views, &control).map(drop),
            difference_of(&views, &control).map(drop),
            TriDexel::union_of(&dexels, &control).map(drop),
            TriDexel::difference_of(&dexels, &control).map(drop),
        ] {
            assert!(matches!(found, Err(Error::FrameMismatch { .. })), "{place}: {found:?}");
        }
    }
    assert!(difference_of(&[], &CONTROL).is_err() && TriDexel::difference_of(&[], &CONTROL).is_err());
}

#[test]
#[ignore = "a table: for how much of its time each operation says nothing"]
fn how_long_progress_stands_still() {
    for told in all_operations(9) {
        let Told { name, fractions, widest, stillest, milliseconds } = told;
        println!(
            "{name:36} {milliseconds:8.1} ms {:6} times, gap {widest:.2}, still {stillest:.2}",
            fractions.len()
        );
    }
}
