//! Failing allocations and writes, each of them in turn. A failure is an error, never an abort; the old file
//! stays as it was, and no other file is left behind.
//!
//! This test program's allocator refuses the n-th request of a thread. Small requests cannot be refused
//! without ending the process (see `Error::OutOfMemory`). Such requests are refused in a child process, and
//! the size of the request is read from the child's last words.

#![cfg(all(feature = "mmap", unix))]

use crate::allocator::{most_held, refusing};
use leafless::attribute::{FunctionAttribute, dexel_materials, sample_triangles};
use leafless::dexel::{DexelEditor, DexelEnds, DexelFormat, DexelNormals};
use leafless::layout::{Bay, Item, Layout, Objective, Orientations, SearchOptions};
use leafless::mesh::{MeshAttribute, Polyhedron, PolyhedronArrays};
use leafless::op::{DexelOptions, Zone, octree_from_dexel_ends, octree_from_dexels, resolve, union_of};
use leafless::query::{
    Columns, DistanceTo, Obstacle, PointTable, SectionPlane, Side, cells_in, classify_box, classify_in,
    clearance_at, columns, distances, gap_at_least, gap_at_least_at, heights, interference_at, line_of_sight,
    ray_spans, section_area, surface_area,
};
use leafless::render::{
    Camera, Clip, ColourMap, Finish, MeshEdges, MeshLayer, OctreeLayer, Shot, SliceLayer, SlicePlane,
    SolidLayer, Transfer, VolumeLayer, render,
};
use leafless::solid::{Band, HalfSpace, Transform, VoxelGrid};
use leafless::surface::{
    Resolve, Snap, VertexPlacement, boundary, contour, dual_contouring_dexels, marching_cubes_dexels,
    marching_cubes_solid, marching_cubes_volume, simple_marching_cubes, simple_marching_cubes_solid,
    simplify, surface_nets,
};
use leafless::voxel::{VoxelOptions, VoxelRecords, dexel_voxels};
use leafless::{
    Affine, AnySolid, Bounds, Callback, Control, Csg, Error, FillRule, Frame, LazyOctree, Membership,
    MeshSolid, Metadata, Octree, Ray, Rule, SurfaceOptions, Tag, TriDexel, TriangleMesh, Verdict, Volume,
    bounding_box, build, build_extended, cast_rays, clearance, compact, complement, contains, deviation,
    dexelize, difference, exchange, file, intersection, marching_cubes, measure, scene, union, xor,
};
use leafless_testkit::{Aligned, Random, fuzz, on_all_processors, repeated, zip};
use std::io::{self, Write};
use std::path::Path;
use std::process::Command;
use std::sync::Arc;

// ---- tried operations -----------------------------------------------------------------------------------

const CONTROL: Control<'static> =
    Control { threads: 1, max_nodes: None, max_bytes: None, max_splits: None, cancel: None, progress: None };

fn frame() -> Frame {
    Frame::new([0.0; 3], 32.0, 6).unwrap()
}

fn ball(x: f64, rule: Rule) -> Octree {
    build(&Csg::ball([x, 16.0, 16.0], 9.0).unwrap(), &frame(), rule, &CONTROL).unwrap()
}

fn facts() -> Metadata {
    let mut metadata = Metadata::new();
    metadata.insert("units", "mm");
    metadata.insert("name", "Flansch Ø 120");
    metadata
}

/// A closed surface: a cube whose faces are cut into squares. Facets share corners only by position.
fn facets() -> Vec<[[f64; 3]; 3]> {
    const N: i32 = 6;
    let mut facets = vec![];
    for axis in 0..3 {
        for (side, outward) in [(0, false), (N, true)] {
            for i in 0..N {
                for j in 0..N {
                    let corner = |i: i32, j: i32| {
                        let mut at = [0.0; 3];
                        at[axis] = side as f64;
                        at[(axis + 1) % 3] = i as f64;
                        at[(axis + 2) % 3] = j as f64;
                        at.map(|x| 3.3 + 2.9 * x)
                    };
                    let square = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
                    for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
                        facets.push(if outward {
                            [square[a], square[b], square[c]]
                        } else {
                            [square[a], square[c], square[b]]
                        });
                    }
                }
            }
        }
    }
    facets
}

/// An OBJ of faces with many corners, some faces not convex. The faces stand before their vertices.
fn polygons() -> String {
    const FACES: u32 = 60;
    // Few corners: the crate that triangulates faces cannot be refused memory.
    const N: u32 = 12;
    let mut text = String::from("mtllib of a name that nobody looks for\n");
    for k in 0..FACES {
        let corners: String = (1..=N).map(|i| format!(" {}", i + N * k)).collect();
        text += &format!("f{corners}\n");
    }
    for k in 0..FACES * N {
        let angle = std::f64::consts::TAU * f64::from(k % N) / f64::from(N);
        // Every other one is a star.
        let radius = if k % (2 * N) < N || k % 2 == 0 { 3.0 } else { 2.0 };
        text += &format!("v {} {} {}\n", radius * angle.cos(), radius * angle.sin(), k / N);
    }
    text
}

/// A mesh whose faces do not quite meet.
fn cracked() -> TriangleMesh {
    let mut facets = facets();
    let count = facets.len();
    for facet in &mut facets[count / 2..] {
        for corner in facet {
            corner[2] += 1e-15;
        }
    }
    TriangleMesh::from_facets(facets).unwrap()
}

/// A prism over a zigzag band of `corners` corners, an even number. The band is nowhere a fan.
fn band(corners: u32) -> (Vec<[f64; 3]>, [Vec<u32>; 5]) {
    let half = corners / 2;
    let along = |k: u32| [f64::from(k), f64::from(k % 2) * 0.75];
    let there = (0..half).map(along);
    let back = (0..half).rev().map(|k| [along(k)[0], along(k)[1] + 0.25]);
    let vertices = there.chain(back).flat_map(|[x, y]| [[x, y, 0.0], [x, y, 1.0]]).collect();
    let mut list: Vec<u32> =
        (0..corners).rev().map(|k| 2 * k).chain((0..corners).map(|k| 2 * k + 1)).collect();
    for k in 0..corners {
        let next = (k + 1) % corners;
        list.extend([2 * k, 2 * next, 2 * next + 1, 2 * k + 1]);
    }
    let loops = [0, corners].into_iter().chain((0..=corners).map(|k| 2 * corners + 4 * k)).collect();
    (vertices, [list, loops, (0..corners + 3).collect(), vec![0, corners + 2], vec![0, 1]])
}

fn polyhedron((vertices, lists): &(Vec<[f64; 3]>, [Vec<u32>; 5])) -> Result<Polyhedron, Error> {
    let [corners, loops, faces, shells, solids] = lists;
    Polyhedron::new(&PolyhedronArrays { vertices, corners, loops, faces, shells, solids })
}

/// An operation that allocates. It may fail only for lack of memory.
type Operation = Box<dyn Fn() -> Result<(), Error>>;

fn operations(directory: &Path) -> Vec<(&'static str, Operation)> {
    let (a, b) = (ball(14.0, Rule::Certified), ball(19.0, Rule::Certified));
    let binary = ball(15.0, Rule::Sampled);
    let coded = compact(a.view()).unwrap().with_metadata(facts());
    let bytes = file::to_bytes(&coded).unwrap();
    let (closed, cracked) = (Arc::new(TriangleMesh::from_facets(facets()).unwrap()), Arc::new(cracked()));
    let tetrahedron = TriangleMesh::new(
        vec![[5.0; 3], [25.0, 5.0, 5.0], [5.0, 25.0, 5.0], [5.0, 5.0, 25.0]],
        vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
    );
    let tetrahedron = Arc::new(tetrahedron.unwrap());
    let facets = facets();
    let stl = exchange::write_stl(&closed).unwrap();
    let path = directory.join("tree.lfl");
    let mut operations: Vec<(&'static str, Operation)> = vec![];
    macro_rules! operation {
        ($name:literal, [$($kept:ident),*], $result:expr) => {{
            $(let $kept = $kept.clone();)*
            #[allow(clippy::redundant_closure_call)]
            operations.push(($name, Box::new(move || (|| $result)().map(drop))));
        }};
    }
    operation!("build", [], build(&Csg::ball([15.0; 3], 9.0)?, &frame(), Rule::Certified, &CONTROL));
    operation!("build sampled", [], build(&Csg::ball([15.0; 3], 9.0)?, &frame(), Rule::Sampled, &CONTROL));
    operation!("build odd", [], {
        let frame = frame().with_depth(5)?;
        build(&Csg::cuboid([1.1; 3], [22.0; 3])?, &frame, Rule::Outer, &CONTROL)
    });
    operation!("build erased", [], {
        let solid = AnySolid::new(Csg::ball([15.0; 3], 9.0)?);
        build(&solid, &frame(), Rule::Certified, &CONTROL)
    });
    operation!("build callback", [], {
        let slab = Callback::new(|min, max| match (min[2], max[2]) {
            (low, high) if high <= 3.3 || low >= 9.1 => Ok(Verdict::Empty),
            (low, high) if low >= 3.3 && high <= 9.1 => Ok(Verdict::Full),
            _ => Ok(Verdict::Partial(())),
        });
        build(&slab, &frame(), Rule::Certified, &CONTROL)
    });
    // A comb of 400 teeth, a torus, and a rotated power.
    let tooth = |i: u32| [[i as f64 / 40.0, 1.0], [(i as f64 + 0.5) / 40.0, 1.5 + (i % 7) as f64]];
    let comb =
        [&[[0.0, 0.0]][..], (0..400).flat_map(tooth).collect::<Vec<_>>().as_slice(), &[[11.0, 0.0]]].concat();
    operation!("build CSG", [comb], {
        let turned = Affine::new([[6.0, -8.0, 0.0, 15.0], [8.0, 6.0, 0.0, 15.0], [0.0, 0.0, 9.0, 15.0]])?;
        let rounded = Csg::from(HalfSpace::power([(-1.0, 0.0, 6); 3], 1.0)?).placed(&turned)?;
        let all =
            Csg::union_of([Csg::prism(&comb, 2.0, 20.0)?, rounded])?.difference(&Csg::torus(9.0, 4.0)?)?;
        // If memory is refused, there is no fingerprint.
        let _ = leafless::Solid::fingerprint(&all);
        build(&all, &frame(), Rule::Certified, &CONTROL)
    });
    operation!("build mesh", [closed], {
        let solid = MeshSolid::new(closed.clone(), FillRule::NonZero)?;
        build(&solid, &frame(), Rule::Certified, &CONTROL)
    });
    operation!("build mesh erased", [closed], {
        let solid = AnySolid::new(MeshSolid::new(closed.clone(), FillRule::NonZero)?);
        build(&solid, &frame(), Rule::Certified, &CONTROL)
    });
    operation!("build mesh deep", [closed], {
        let frame = frame().with_depth(7)?;
        build(&MeshSolid::new(closed.clone(), FillRule::EvenOdd)?, &frame, Rule::Sampled, &CONTROL)
    });
    operation!("build extended", [], {
        let part = Csg::ball([15.0; 3], 9.0)?.difference(&Csg::cuboid([1.1; 3], [22.0, 21.0, 15.3])?)?;
        let turned =
            part.placed(&Affine::new([[0.6, -0.8, 0.0, 9.0], [0.8, 0.6, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0]])?)?;
        let tree = build_extended(&turned, &frame(), &SurfaceOptions::default(), &CONTROL)?;
        let mut answers = [Membership::Undecided; 2];
        contains(&tree, &frame(), &[[15.0; 3], [9.1, 8.2, 7.3]], &mut answers, &CONTROL)?;
        measure(&tree, &frame(), 1e-2, &CONTROL)
    });
    let extended = |x: f64| {
        let ball = Csg::ball([x, 15.0, 15.0], 8.0)?;
        build_extended(&ball, &frame(), &SurfaceOptions::default(), &CONTROL)
    };
    let tools: Result<Vec<Octree>, Error> = [9.0, 14.0, 18.5, 21.0].into_iter().map(extended).collect();
    let tools = tools.unwrap();
    operation!(
        "union of extended",
        [tools],
        union_of(&tools.iter().map(|tree| *tree.view()).collect::<Vec<_>>(), &CONTROL)
    );
    operation!("difference of extended", [tools, a], {
        let both = difference(tools[0].view(), tools[2].view(), &CONTROL)?;
        difference(a.view(), both.view(), &CONTROL)
    });
    operation!("build extended mesh", [closed], {
        let solid = MeshSolid::new(closed.clone(), FillRule::NonZero)?;
        let options = SurfaceOptions { tolerance: Some(0.75) };
        build_extended(&solid, &frame(), &options, &CONTROL)
    });
    operation!("build extended callback", [], {
        let slab = Callback::new(|min, max| match (min[2], max[2]) {
            (low, high) if high <= 3.3 || low >= 9.1 => Ok(Verdict::Empty),
            (low, high) if low >= 3.3 && high <= 9.1 => Ok(Verdict::Full),
            _ => Ok(Verdict::Partial(())),
        });
        build_extended(&slab, &frame(), &SurfaceOptions::default(), &CONTROL)
    });
    operation!("build stored", [a], build(a.view(), &frame(), Rule::Inner, &CONTROL));
    let waves: Vec<f32> =
        (0..32 * 30 * 28).map(|i| ((i % 32) as f32 * 0.3).sin() + ((i / 960) as f32 * 0.2).cos()).collect();
    let grid = VoxelGrid::new([32, 30, 28], [0.0; 3], [1.0; 3]).unwrap();
    operation!("volume", [waves], {
        let volume = Volume::new(waves[..].into(), &grid, Band::between(0.1, 0.9)?, &CONTROL)?;
        let volume = volume.with_band(Band::at_least(0.2)?, &CONTROL)?;
        let tree = build(&volume, &frame(), Rule::Certified, &CONTROL)?;
        tree.bitmap(4, [0; 3], [16; 3], &mut [0; 256], Some(&mut [0; 256]), &CONTROL)
    });
    operation!("surface of a volume", [waves], {
        let volume = Volume::new(waves[..].into(), &grid, Band::at_least(0.2)?, &CONTROL)?;
        marching_cubes_volume(&volume, &CONTROL)
    });
    operation!("surfaces of an octree", [binary, a], {
        marching_cubes(binary.view(), None, &CONTROL)?;
        surface_nets(binary.view(), None, &CONTROL)?;
        simple_marching_cubes(a.view(), Snap::Fat, Some(Resolve::Outer), &CONTROL)
    });
    operation!("surfaces of a ball", [], {
        let (ball, frame) = (Csg::ball([15.0; 3], 9.0)?, frame().with_depth(4)?);
        marching_cubes_solid(&ball, &frame, VertexPlacement::Crossing, &CONTROL)?;
        simple_marching_cubes_solid(&ball, &frame, Snap::Thin, &CONTROL)
    });
    operation!("boundary", [], {
        let (block, ball) = (Csg::cuboid([5.0; 3], [25.0; 3])?, Csg::ball([25.0; 3], 9.0)?);
        boundary(&block.difference(&ball)?, &frame().with_depth(3)?, 4.0, &CONTROL)?.faces()
    });
    operation!("boundary of a mesh", [tetrahedron], {
        boundary(&MeshSolid::new(tetrahedron.clone(), FillRule::NonZero)?, &frame(), 1.0, &CONTROL)
    });
    operation!("contour", [], {
        let block = Csg::cuboid([5.0, 6.0, 7.0], [25.0, 24.0, 23.0])?;
        contour(&block, &frame().with_depth(2)?, 8.0, &Control { max_splits: Some(30), ..CONTROL })
    });
    operation!("contour of a mesh", [tetrahedron], {
        let solid = MeshSolid::new(tetrahedron.clone(), FillRule::NonZero)?;
        contour(&solid, &frame().with_depth(2)?, 8.0, &Control { max_splits: Some(30), ..CONTROL })
    });
    operation!("simplify", [closed], simplify(&closed, 0.25, &CONTROL));
    #[cfg(feature = "volumes")]
    {
        let samples: leafless::solid::Samples<'static> = waves.into();
        // The crate that compresses cannot be refused memory.
        let nrrd = exchange::write_nrrd(&samples, &grid, exchange::NrrdEncoding::Gzip).unwrap();
        let text =
            b"NRRD0001\ntype: short\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n1 2 3 4 5 6 7 8".to_vec();
        operation!("write NRRD", [samples], {
            exchange::write_nrrd(&samples, &grid, exchange::NrrdEncoding::Raw)
        });
        operation!("read NRRD", [nrrd, text], {
            exchange::read_volume(&nrrd, None)?;
            exchange::read_volume(&text, None)
        });
    }
    operation!("refine", [closed], {
        let solid = || MeshSolid::new(closed.clone(), FillRule::NonZero);
        let mut lazy = LazyOctree::new(solid()?, &frame())?;
        let found = lazy.refine(&Zone::Whole, 5, &CONTROL).and_then(|_| lazy.freeze(&CONTROL));
        if found.is_err() {
            // The octree that remains after the refusal can be refined further.
            lazy.refine(&Zone::Point([12.0; 3]), 6, &CONTROL)?;
            lazy.freeze(&CONTROL)?.view().check()?;
        }
        LazyOctree::resume(&found?, solid()?, &frame(), &CONTROL).map(drop)
    });
    operation!("interference", [a], {
        let turn = Affine::new([[0.8, -0.6, 0.0, 9.0], [0.6, 0.8, 0.0, -6.0], [0.0, 0.0, 1.0, 0.25]])?;
        let control = Control { max_splits: Some(100), ..CONTROL };
        interference_at(&Csg::ball([15.0; 3], 9.0)?, &a, &frame(), &[turn; 2], &frame(), 0.0, &control)
    });
    operation!("interference of octrees", [a], {
        let turn = Affine::new([[0.8, -0.6, 0.0, 9.0], [0.6, 0.8, 0.0, -6.0], [0.0, 0.0, 1.0, 0.25]])?;
        interference_at(&a, &a, &frame(), &[turn; 2], &frame(), f64::INFINITY, &CONTROL)
    });
    operation!("clearance", [a], {
        let moved = Transform::new(&a, &frame(), &Affine::translation([7.0, 9.0, 0.1])?);
        clearance(&a, &moved, &frame(), 0.0, &Control { max_splits: Some(60), ..CONTROL })
    });
    operation!("clearance of meshes", [closed], {
        let solid = || MeshSolid::new(closed.clone(), FillRule::NonZero);
        let turn = Affine::translation([0.5, 0.25, 40.0])?;
        clearance_at(
            &solid()?,
            &solid()?,
            &frame(),
            &[turn],
            &Frame::new([-128.0; 3], 256.0, 5)?,
            0.0,
            &CONTROL,
        )?;
        gap_at_least(&solid()?, &solid()?.placed(&turn)?, &Frame::new([-128.0; 3], 256.0, 5)?, 0.5, &CONTROL)
    });
    operation!("deviation", [a], {
        deviation(&a, &Csg::ball([15.0; 3], 9.0)?, &frame(), 0.5, &Control { max_splits: Some(8), ..CONTROL })
    });
    operation!("clearances of expressions", [a], {
        let turn = Affine::new([[0.8, -0.6, 0.0, 9.0], [0.6, 0.8, 0.0, -6.0], [0.0, 0.0, 1.0, 0.25]])?;
        let control = Control { max_splits: Some(10), ..CONTROL };
        clearance_at(&Csg::ball([15.0; 3], 9.0)?, &a, &frame(), &[turn; 2], &frame(), 0.0, &control)
    });
    operation!("layout", [], {
        let solid = |size| Ok::<_, Error>(AnySolid::new(Csg::cuboid([0.0; 3], [size; 3])?));
        let turns = Orientations::List(vec![Affine::IDENTITY]);
        let ball = AnySolid::new(Csg::ball([0.0; 3], 1.0)?);
        let mut bay = Bay::new(solid(7.0)?)?.with_clearances(0.25, 0.0)?;
        bay.add_obstacle(solid(1.0)?)?;
        bay.add_item(Item::new(solid(3.0)?)?.with_count(2).with_orientations(turns)?)?;
        bay.add_item(Item::new(ball)?.with_orientations(Orientations::AsGiven)?)?;
        let control = Control { max_splits: Some(40), ..CONTROL };
        let mut layout = Layout::new(&bay, &control)?;
        let objective = Objective::Height;
        let options =
            SearchOptions { rounds: 1, cells: 6, objective, max_tests: Some(12), ..SearchOptions::default() };
        layout.search(&options, &control)?;
        layout.check_all(&control)?;
        layout.place(1, &Affine::translation([4.5; 3])?)?;
        layout.check(0, &control)?;
        layout.measures(0.5, &control)
    });
    operation!("gap", [a], {
        let control = Control { max_splits: Some(10), ..CONTROL };
        let turn = Affine::translation([7.0, 9.0, 0.1])?;
        gap_at_least(&Csg::ball([15.0; 3], 9.0)?, &a, &frame(), 0.5, &control)?;
        gap_at_least_at(&Csg::ball([15.0; 3], 9.0)?, &a, &frame(), &[turn], &frame(), 0.5, &control)
    });
    let marked = DexelOptions {
        format: DexelFormat {
            normals: DexelNormals::Bits16,
            surfaces: true,
            materials: true,
            ..DexelFormat::default()
        },
        ..DexelOptions::default()
    };
    operation!("dexels of a mesh", [closed], {
        dexelize(&MeshSolid::new(closed.clone(), FillRule::NonZero)?, &frame(), &marked, &CONTROL)
    });
    operation!("dexels of an open mesh", [cracked], {
        let coarse = frame().with_depth(3)?;
        dexelize(&MeshSolid::new(cracked.clone(), FillRule::NonZero)?, &coarse, &marked, &CONTROL)
    });
    operation!("dexels of half-spaces", [a], {
        let ball = Csg::ball([15.0; 3], 9.0)?;
        dexelize(&ball.complement(), &frame(), &marked, &CONTROL)?;
        dexelize(
            &Csg::solid(AnySolid::new(a.clone())).complement(),
            &frame(),
            &DexelOptions { rule: Rule::Outer, ..marked },
            &CONTROL,
        )?;
        dexelize(&Csg::from(leafless::solid::HalfSpace::torus(9.0, 3.0)?), &frame(), &marked, &CONTROL)
    });
    let balls = [13.0, 17.0]
        .map(|x| dexelize(&Csg::ball([x, 15.0, 15.0], 7.0).unwrap(), &frame(), &marked, &CONTROL).unwrap());
    operation!("dexel algebra", [balls], {
        let [a, b] = [balls[0].view(), balls[1].view()];
        a.union(b, &CONTROL)?;
        a.complement(&CONTROL)?;
        a.with_material(3, &CONTROL)?;
        let plain =
            a.to_format(DexelFormat { ends: DexelEnds::Double, ..DexelFormat::default() }, &CONTROL)?;
        TriDexel::xor_of(&[*a, *b, *plain.view()], &CONTROL)
    });
    operation!("dexel editor", [balls], {
        let mut editor = DexelEditor::new(balls[0].view())?;
        editor.subtract(balls[1].view(), &CONTROL)?;
        editor.unite(balls[1].view(), &CONTROL)?;
        editor.subtract_solid(&Csg::ball([15.0; 3], 2.0)?, &CONTROL)?;
        editor.freeze(&CONTROL)
    });
    operation!("dexel surfaces", [balls], {
        marching_cubes_dexels(balls[0].view(), &CONTROL)?;
        dual_contouring_dexels(balls[0].view(), &CONTROL)?;
        octree_from_dexel_ends(balls[0].view(), &CONTROL)?;
        let cells = octree_from_dexels(balls[0].view(), &CONTROL)?;
        let steel = balls[0].view().with_material(1, &CONTROL)?;
        dexel_materials(steel.view(), cells.view(), &CONTROL)?;
        dexel_voxels(balls[0].view(), &[], &CONTROL)
    });
    let seen = build(&Csg::ball([15.0; 3], 9.0).unwrap(), &frame(), Rule::Certified, &CONTROL).unwrap();
    let records = VoxelRecords::of(seen.view(), &VoxelOptions::new(), None, &CONTROL).unwrap();
    operation!("picture", [seen, records, closed], {
        let camera = Camera::fitted(&Bounds::of(seen.frame()).corners(), [20.0, 30.0], Some(30.0), 1.0)?;
        let shot = Shot { clip: Clip::new().plane([1.0, 0.0, 0.0, -14.0])?, ..Shot::new(camera, [40, 40]) };
        let ball = Csg::ball([12.0; 3], 5.0)?;
        let octree = OctreeLayer::new(seen.view(), Finish::default());
        let solid = SolidLayer::new(&ball, seen.frame(), Finish::default()).at_most(5);
        let mesh = MeshLayer::new(&closed).colour([200, 0, 0, 90]).edges(MeshEdges::All, 1.0, [0, 0, 0, 255]);
        let slice = SliceLayer::new(seen.view(), SlicePlane::across(2, 15.0)?);
        let transfer = Transfer::new(ColourMap::Viridis, [0.0, 1.0], 0.5, 10.0)?;
        let volume = VolumeLayer::new(records.view(), transfer);
        render(&shot, &[&octree, &solid, &mesh, &slice, &volume], &CONTROL)
    });
    operation!("dexel bytes", [balls], file::dexels::from_bytes(&file::dexels::to_bytes(&balls[0])?));
    operation!("mesh placed", [closed], {
        closed.placed(&Affine::new([[0.0, 1.1, 0.0, 9.0], [1.0, 0.0, 0.0, -6.0], [0.0, 0.0, 1.0, 0.25]])?)
    });
    operation!("mesh of facets", [facets], TriangleMesh::from_facets(&*facets));
    operation!("mesh report", [closed], closed.translated([1.0; 3])?.report());
    operation!("mesh defects", [cracked], cracked.defects(9));
    operation!("open mesh report", [cracked], cracked.transformed(|corner| corner)?.report());
    // Faces of few corners: the crate that triangulates faces cannot be refused memory.
    operation!("polyhedron", [], polyhedron(&band(12)));
    operation!("sew", [cracked], cracked.transformed(|corner| corner)?.sewn());
    operation!("read STL", [stl], exchange::read_stl(&stl));
    operation!("read mesh", [stl], {
        let (unit, target) = (Some(exchange::LengthUnit::Inch), Some(exchange::LengthUnit::Millimetre));
        exchange::read_mesh(&stl, &exchange::MeshOptions { unit, target, ..Default::default() })
    });
    #[cfg(feature = "threemf")]
    {
        // Many objects, one of them in another part, placed along a chain.
        let mut resources = zip::tetrahedron(1, "");
        for id in 2..200 {
            resources += &zip::tetrahedron(1000 + id, "");
            resources += &format!(
                "<object id=\"{id}\"><components><component objectid=\"{}\"/><component objectid=\"{}\" \
                 transform=\"1 0 0 0 1 0 0 0 1 {id} 0 0\"/></components></object>",
                id - 1,
                1000 + id
            );
        }
        let items = "<item objectid=\"199\"/><item objectid=\"1\" p:path=\"/b.model\"/>";
        let mut entries = zip::package(zip::model("", &resources, items));
        entries.push(zip::Entry::deflated("b.model", zip::model("", &zip::tetrahedron(1, ""), "")));
        let package = zip::zip(&entries);
        operation!("read 3MF", [package], exchange::read_mesh(&package, &Default::default()));
    }
    operation!("write STL", [closed], exchange::write_stl(&closed));
    operation!("write meshes", [closed], {
        for format in [exchange::MeshFormat::Stl, exchange::MeshFormat::Ply, exchange::MeshFormat::Off] {
            let options =
                exchange::WriteOptions { text: true, normals: true, deviation: Some(0.5), unit: None };
            exchange::write_mesh(&closed, format, &options)?;
        }
        exchange::write_mesh(&closed, exchange::MeshFormat::Ply, &Default::default())?;
        exchange::write_mesh(&closed, exchange::MeshFormat::Obj, &Default::default())
    });
    operation!("write polygons", [], {
        let tetrahedron = PolyhedronArrays {
            vertices: &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            corners: &[0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3],
            loops: &[0, 3, 6, 9, 12],
            faces: &[0, 1, 2, 3, 4],
            shells: &[0, 4],
            solids: &[0, 1],
        };
        exchange::write_polygons(&tetrahedron, exchange::MeshFormat::Off, &Default::default())
    });
    operation!("values on triangles", [closed], {
        let steps =
            FunctionAttribute::new(1, |point: [f64; 3]| Some([(4.0 * point[0]).floor(), 0.0, 0.0, 0.0]))?;
        sample_triangles(&closed, &steps, "steps", 0.01, &CONTROL)
    });
    let mut bearing = TriangleMesh::clone(&closed);
    let count = bearing.triangles().len();
    for attribute in [
        MeshAttribute::per_triangle("colour", 3, &vec![7.0; 3 * count]),
        MeshAttribute::labels("material", vec![1; count]),
        MeshAttribute::per_triangle("heat", 2, &vec![0.5; 2 * count]),
    ] {
        bearing.add_attribute(attribute.unwrap()).unwrap();
    }
    let bearing = Arc::new(bearing);
    operation!("write and read attributes", [bearing], {
        for format in [exchange::MeshFormat::Ply, exchange::MeshFormat::Obj] {
            let bytes = exchange::write_mesh(&bearing, format, &Default::default())?;
            exchange::read_mesh(&bytes, &Default::default())?;
        }
        Ok(())
    });
    operation!("single precision", [closed], {
        closed.translated([3e5; 3])?.in_single_precision(0.1, &CONTROL).map(|single| single.mesh)
    });
    operation!("what STL keeps", [closed], {
        let options = exchange::WriteOptions { text: true, ..Default::default() };
        exchange::written_form(&closed, exchange::MeshFormat::Stl, &options)?;
        exchange::written_form(&closed, exchange::MeshFormat::Stl, &Default::default()).map(drop)
    });
    for (k, (write, read)) in fuzz::meshes::WRITERS.into_iter().enumerate() {
        const NAMES: [&str; fuzz::meshes::WRITERS.len()] = [
            "read OBJ",
            "read OBJ again",
            "read OFF",
            "read OFF again",
            "read PLY",
            "read PLY little",
            "read PLY big",
            "read PLY strips",
        ];
        let bytes = write(&closed);
        operations.push((NAMES[k], Box::new(move || read(&bytes).map(drop))));
    }
    let polygons = polygons();
    operation!("read polygons", [polygons], exchange::read_obj(polygons.as_bytes()));
    #[cfg(feature = "scene")]
    {
        let text: String = (0..40)
            .map(|i| format!("multmatrix([[1,0,0,{i}],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) sphere(r = 0.3);\n"))
            .chain((0..3).map(|i| {
                let points: String = (0..60).map(|k| format!("[{k}, {}], ", k * k + i)).collect();
                format!("linear_extrude(height = 1) polygon(points = [{points}], paths = undef);\n")
            }))
            .chain([
                "polyhedron([[0,0,0],[4,0,0],[0,4,0],[0,0,4]], [[0,1,2],[0,3,1],[0,2,3],[1,3,2]]);".into()
            ])
            .collect();
        let scene = scene::read_scene(&text, None).unwrap();
        operation!("read a scene", [text], scene::read_scene(&text, None));
        operation!("solid of a scene", [scene], scene.solid(&Frame::new([0.0; 3], 64.0, 3)?));
        operation!("bounds of a scene", [scene], scene.bounds());
    }
    operation!("union", [a, b], union(a.view(), b.view(), &CONTROL));
    operation!("intersection", [a, b], intersection(a.view(), b.view(), &CONTROL));
    operation!("difference", [coded, binary], difference(coded.view(), binary.view(), &CONTROL));
    operation!("xor", [binary, b], xor(b.view(), binary.view(), &CONTROL));
    operation!("complement", [coded], complement(coded.view(), &CONTROL));
    operation!("union of three", [a, b, binary], {
        union_of(&[*a.view(), *b.view(), *binary.view()], &CONTROL)
    });
    operation!("resolve", [a], resolve(a.view(), Rule::Outer, &CONTROL));
    operation!("compact", [a], compact(a.view()));
    operation!("compact again", [coded], compact(coded.view()));
    operation!("check", [coded], coded.view().check());
    operation!("statistics", [a], complement(a.view(), &CONTROL).map(|tree| tree.statistics()));
    // (Down to the finest cells it needs as many requests, and takes a hundred times as long.)
    operation!("measure", [], measure(&Csg::ball([15.0; 3], 9.0)?, &frame(), 1e-3, &CONTROL));
    operation!("measure a mesh", [closed], {
        let solid = MeshSolid::new(closed.clone(), FillRule::NonZero)?;
        measure(&solid, &frame(), 0.0, &CONTROL)
    });
    operation!("bounding box", [closed], {
        let solid = MeshSolid::new(closed.clone(), FillRule::NonZero)?;
        bounding_box(&solid, &frame(), 0.0, &CONTROL)
    });
    operation!("points of a mesh", [closed], {
        let points: [[f64; 3]; 64] = std::array::from_fn(|i| [i as f64 / 4.0, 7.7, 9.1 + i as f64 / 9.0]);
        let solid = MeshSolid::new(closed.clone(), FillRule::NonZero)?;
        contains(&solid, &frame(), &points, &mut [Membership::Undecided; 64], &CONTROL)
    });
    operation!("box of a mesh", [closed], {
        let solid = MeshSolid::new(closed.clone(), FillRule::NonZero)?;
        classify_box(&solid, &frame(), [7.1; 3], [16.0; 3], &CONTROL)
    });
    operation!("rays on a mesh", [closed], {
        let solid = MeshSolid::new(closed.clone(), FillRule::NonZero)?;
        let rays = [Ray::new([-3.0, 9.0, 11.0], [1.0, 0.1, 0.0])?, Ray::new([11.0; 3], [0.0, 0.0, 1.0])?];
        ray_spans(&solid, &frame(), &rays[0], &CONTROL)?;
        cast_rays(&solid, &frame(), &rays, Obstacle::Upper, &CONTROL)
    });
    // Each run has a mesh without a tree, so that all requests for the tree recur.
    operation!("rays on a new mesh", [facets], {
        let solid = MeshSolid::new(TriangleMesh::from_facets(&facets)?, FillRule::NonZero)?;
        // The second runs along edges and touches the solid, the third passes through vertices.
        let rays = [
            Ray::new([-3.0, 9.0, 11.0], [1.0, 0.1, 0.0])?,
            Ray::new([-3.0, 3.3, 3.3], [1.0, 0.0, 0.0])?,
            Ray::new([0.0; 3], [1.0; 3])?,
        ];
        cast_rays(&solid, &frame(), &rays, Obstacle::Upper, &CONTROL)?;
        for ray in &rays {
            ray_spans(&solid, &frame(), ray, &CONTROL)?;
        }
        line_of_sight(&solid, &frame(), [1.0; 3], [9.0; 3], &CONTROL)
    });
    operation!("sight past a new mesh", [facets], {
        let solid = MeshSolid::new(TriangleMesh::from_facets(&facets)?, FillRule::Positive)?;
        line_of_sight(&solid, &frame(), [1.0; 3], [9.0; 3], &CONTROL)
    });
    operation!("points of a new mesh", [facets], {
        let solid = MeshSolid::new(TriangleMesh::from_facets(&facets)?, FillRule::NonZero)?;
        let points: [[f64; 3]; 40] = std::array::from_fn(|i| [i as f64 / 2.0, 7.7, 3.3]);
        contains(&solid, &frame(), &points, &mut [Membership::Undecided; 40], &CONTROL)
    });
    operation!("distances to a new mesh", [facets], {
        let solid = MeshSolid::new(TriangleMesh::from_facets(&facets)?, FillRule::NonZero)?;
        let points: [[f64; 3]; 20] = std::array::from_fn(|i| [3.0 * i as f64, 7.7, 9.1]);
        distances(&solid, &frame(), &points, DistanceTo::Boundary, 0.1, &CONTROL)
    });
    operation!("a moved mesh", [closed], {
        let turn = Affine::new([[0.6, -0.8, 0.0, 9.0], [0.8, 0.6, 0.0, 0.3], [0.0, 0.0, 1.0, 0.1]])?;
        let solid = MeshSolid::new(closed.clone(), FillRule::NonZero)?;
        let ray = Ray::new([-3.0, 9.0, 11.0], [1.0, 0.1, 0.0])?;
        cast_rays(&solid, &frame(), &[ray], Obstacle::Upper, &CONTROL)?;
        let moved = solid.placed(&turn)?;
        cast_rays(&moved, &frame(), &[ray], Obstacle::Upper, &CONTROL)?;
        distances(&moved, &frame(), &[[1.0; 3]], DistanceTo::Boundary, 0.1, &CONTROL)
    });
    operation!("columns", [a], {
        a.ray_spans(&Ray::new([-3.0, 9.0, 11.0], [1.0, 0.1, 0.0])?)?;
        let all = Columns::all(a.frame(), 1)?;
        a.heights(&all, Side::Above)?;
        a.columns(&all)
    });
    operation!("columns of a ball", [], {
        let ball = Csg::ball([15.0; 3], 9.0)?;
        let all = Columns::all(&frame(), 2)?;
        heights(&ball, &frame(), &all, Side::Below, &CONTROL)?;
        columns(&ball, &frame(), &all, &CONTROL)
    });
    operation!("distances of cells", [a], {
        let mut field = [[0.0f32; 2]; 24 * 24 * 4];
        a.distance_field([4, 4, 9], [28, 28, 13], &mut field, &CONTROL)?;
        PointTable::new(a.view(), 4)?;
        a.view().nearest_cells([1.0, 2.0, 3.0], &[Tag::Full, Tag::Partial], 40)
    });
    operation!("distances to a mesh", [closed], {
        let solid = MeshSolid::new(closed.clone(), FillRule::NonZero)?;
        let points: [[f64; 3]; 6] = std::array::from_fn(|i| [3.0 * i as f64, 7.7, 9.1]);
        distances(&solid, &frame(), &points, DistanceTo::Boundary, 0.1, &CONTROL)
    });
    operation!("solid in a solid", [a], classify_in(&a, &Csg::ball([15.0; 3], 3.0)?, &frame(), &CONTROL));
    operation!("content of a ball", [a], {
        let ball = Csg::ball([15.0; 3], 3.0)?.difference(&Csg::cuboid([1.0; 3], [14.0; 3])?)?;
        cells_in(&a, &ball, &frame(), &CONTROL)?;
        a.volume_in(&ball, &CONTROL)
    });
    operation!("area", [], {
        let ball = Csg::ball([15.0; 3], 9.0)?.difference(&Csg::cuboid([14.0; 3], [40.0; 3])?)?;
        surface_area(&ball, &frame(), 1e-2, &CONTROL)
    });
    operation!("section of a mesh", [closed], {
        let solid = MeshSolid::new(closed.clone(), FillRule::NonZero)?;
        let plane = SectionPlane::new([11.0; 3], [1.0, 0.2, -0.3])?;
        section_area(&solid, &frame(), &plane, 1e-2, &CONTROL)
    });
    operation!("intersecting pairs", [closed], {
        TriangleMesh::from_facets(closed.triangles().iter().flat_map(|corners| {
            let corners = corners.map(|v| closed.vertices()[v as usize]);
            [corners, corners.map(|corner| corner.map(|x| x + 1.1))]
        }))?
        .intersecting_pairs(9, &CONTROL)
    });
    operation!("to bytes", [b], file::to_bytes(&b.with_metadata(facts())));
    operation!("to bytes again", [coded], file::to_bytes(&coded));
    operation!("write", [binary], file::write_to(&binary, io::sink()));
    operation!("save", [binary, path], file::save(&binary, &path));
    operation!("probe bytes", [bytes], file::probe_bytes(&bytes));
    operation!("from bytes", [bytes], file::from_bytes(&bytes));
    operation!("probe", [path], file::probe(&path));
    operation!("open", [path], file::open(&path));
    // SAFETY: no other process uses the file, and saving replaces it.
    operation!("map", [path], unsafe { file::map(&path) });
    // SAFETY: as before.
    operation!("map verified", [path], unsafe { file::map_verified(&path) });
    operations
}

/// Bytes of the largest request that may end the process.
const SMALL: u64 = 2048;

/// The environment variable with a child's task: the operation, the first request to refuse, the size from
/// which requests count, and whether all later requests fail too.
const TASK: &str = "LEAFLESS_TEST_FAILING";

fn names(directory: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(directory).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The file that exists before an operation is tried.
fn old_file() -> Vec<u8> {
    file::to_bytes(&compact(ball(14.0, Rule::Certified).view()).unwrap().with_metadata(facts())).unwrap()
}

/// Returns the distance to the next request to refuse: each of the first twenty, and then ever fewer.
fn step(n: u64) -> u64 {
    repeated(1 + n / 20, 1)
}

/// The process that other tests start in a directory of its own. By itself it does nothing.
#[test]
fn child() {
    let Ok(task) = std::env::var(TASK) else { return };
    let [name, first, spared, for_good] = task.split(',').collect::<Vec<_>>()[..] else { panic!("{task}") };
    let (first, for_good): (u64, bool) = (first.parse().unwrap(), for_good.parse().unwrap());
    let spared = spared.parse().unwrap();
    let directory = std::env::current_dir().unwrap();
    let path = directory.join("tree.lfl");
    let old = old_file();
    std::fs::write(&path, &old).unwrap();
    let operations = operations(&directory);
    let (_, operation) = operations.iter().find(|(known, _)| *known == name).unwrap();
    let mut out = 0;
    let mut n = first;
    loop {
        eprintln!("request {n}");
        let (result, refused) = refusing(n, spared, for_good, operation);
        let found = std::fs::read(&path).unwrap();
        assert_eq!(names(&directory), ["tree.lfl"]);
        match result {
            Ok(()) if name == "save" => {
                assert!(found != old);
                std::fs::write(&path, &old).unwrap();
            }
            Ok(()) => assert!(found == old),
            Err(Error::OutOfMemory) => {
                assert!(refused > 0 && found == old);
                out += 1;
            }
            Err(other) => panic!("{other}"),
        }
        if refused == 0 {
            eprintln!("survived {out} of {n}");
            return;
        }
        n += step(n);
    }
}

/// Runs an operation until no more request of over `spared` bytes can be refused. Returns the number of
/// refusals that became errors, and the number that ended the process. After the first ended process,
/// requests are skipped.
fn try_all(name: &str, spared: u64, for_good: bool) -> (u64, u64) {
    let directory = tempfile::tempdir().unwrap();
    let (mut first, mut errors) = (1, 0);
    let mut fatal = 0;
    loop {
        let mut command = Command::new(std::env::current_exe().unwrap());
        command.args(["--exact", "failures::child", "--nocapture"]).current_dir(directory.path());
        // A backtrace would need memory before the process ends.
        command.env("RUST_BACKTRACE", "0");
        let output = command.env(TASK, format!("{name},{first},{spared},{for_good}")).output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        let number = |line: Option<&str>, prefix: &str| -> Option<u64> {
            line?.strip_prefix(prefix)?.split(' ').next()?.parse().ok()
        };
        if output.status.success() {
            let survived = number(text.lines().rfind(|line| line.starts_with("survived ")), "survived ");
            return (errors + survived.unwrap_or_else(|| panic!("{name}: {text}")), fatal);
        }
        // The first message counts. Where all requests are refused, others may follow.
        let request = text.lines().rfind(|line| line.starts_with("request "));
        let refused = text.lines().find(|line| line.starts_with("memory allocation of "));
        let (Some(n), Some(size)) = (number(request, "request "), number(refused, "memory allocation of "))
        else {
            panic!("{name}: {text}")
        };
        assert!(size <= SMALL, "{name}: request {n} is one of {size} bytes and cannot be refused");
        errors += text.lines().filter(|line| line.starts_with("request ")).count() as u64 - 1;
        fatal += 1;
        first = if fatal < 3 { n + 1 } else { 2 * n + 1 };
        // Files that an ended process left behind.
        for name in names(directory.path()) {
            assert!(name == "tree.lfl" || name.starts_with(".leafless-"));
            std::fs::remove_file(directory.path().join(name)).unwrap();
        }
    }
}

/// Runs all operations. Returns the number of refusals that became errors, and the number that ended a
/// process. Where small requests end the process, many processes are needed. There, memory returns after a
/// refusal in every other operation and stays refused in the rest.
fn try_every_operation(spared: u64) -> (u64, u64) {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("tree.lfl"), old_file()).unwrap();
    let names: Vec<&str> = operations(directory.path()).into_iter().map(|(name, _)| name).collect();
    let numbered: Vec<_> = names.iter().enumerate().collect();
    let counts = on_all_processors(&numbered, |(number, name)| {
        [false, true].map(|for_good| {
            if spared == 0 && for_good == (number % 2 == 0) {
                return (0, 0);
            }
            let (errors, fatal) = try_all(name, spared, for_good);
            println!("{name}: {errors} errors, {fatal} fatal");
            (errors, fatal)
        })
    });
    counts.into_iter().flatten().fold((0, 0), |total, (errors, fatal)| (total.0 + errors, total.1 + fatal))
}

#[test]
fn no_request_of_more_than_two_kibibytes_is_fatal() {
    let (errors, fatal) = try_every_operation(SMALL);
    assert!(errors > 200 && fatal == 0, "{errors} errors, {fatal} fatal");
}

#[test]
fn small_requests_that_are_fatal_are_small() {
    let (errors, _) = try_every_operation(0);
    assert!(errors > 500, "{errors} errors");
}

// ---- memory in proportion to the input -------------------------------------------------------------------

/// Bytes that reading (and, below, making a tree) may need, whatever the input.
const READING: usize = 4 << 10;
const MAKING: usize = 128 << 10;

/// Raises `worst` to the bytes that `work` held beyond `fixed`, divided by the size of its input.
fn weigh<R>(worst: &mut f64, fixed: usize, input: usize, work: impl FnOnce() -> R) {
    let (_, held) = most_held(work);
    *worst = worst.max(held.saturating_sub(fixed) as f64 / input as f64);
}

/// Checks the promise of `file` and `OctreeRef` for unchecked bytes.
#[test]
fn memory_is_a_small_multiple_of_the_input() {
    let mut inputs = fuzz::seeds::files();
    let (mut random, small) = (Random(11), inputs.len());
    let facts = |count: usize| {
        let mut metadata = Metadata::new();
        (0..count).for_each(|i| metadata.insert(format!("{i:x}"), ""));
        Octree::uniform(frame(), leafless::Tag::Full, leafless::Tag::Full).unwrap().with_metadata(metadata)
    };
    let tree = |rule| compact(ball(14.0, rule).view()).unwrap();
    let large = [facts(60_000), tree(Rule::Certified), tree(Rule::Outer), dictionary()];
    inputs.extend(large.map(|tree| file::to_bytes(&tree).unwrap()));
    let mut worst = [0.0; 7];
    for round in 0..4000 {
        let base = if round < inputs.len() { round } else { random.index(small) };
        let mut data = inputs[base].clone();
        if round >= inputs.len() {
            let (size, max) = (data.len(), data.len() + 4096);
            data.resize(max, 0);
            let size = fuzz::mutate_file(&mut data, size, max, round as u32, &mut |_, size, _| size);
            data.truncate(size);
        }
        let aligned = Aligned::new(&data);
        let bytes = aligned.bytes();
        let length = bytes.len();
        weigh(&mut worst[0], READING, length, || file::probe_bytes(bytes));
        let (view, held) = most_held(|| file::view(bytes));
        assert_eq!(held, 0, "a view allocates nothing");
        weigh(&mut worst[1], READING, length, || file::verify(bytes));
        weigh(&mut worst[2], READING, length, || file::from_bytes(bytes));
        let Ok(tree) = view else { continue };
        let (_, held) = most_held(|| fuzz::walk(leafless::octree::Cursor::new(&tree)).steps);
        assert!(held < READING);
        weigh(&mut worst[3], MAKING, length, || complement(&tree, &CONTROL));
        weigh(&mut worst[4], MAKING, 2 * length, || union(&tree, &tree, &CONTROL));
        weigh(&mut worst[5], MAKING, length, || resolve(&tree, Rule::Outer, &CONTROL));
        weigh(&mut worst[6], MAKING, length, || compact(&tree).map(|tree| file::to_bytes(&tree)));
    }
    println!("{worst:.2?}");
    for (worst, stated) in worst.into_iter().zip([2.0, 6.0, 6.0, 32.0, 32.0, 32.0, 32.0]) {
        assert!(worst <= stated, "{worst} times the input, not {stated}");
    }
}

/// Checks the promise of `TriangleMesh`.
#[test]
fn memory_of_reports_is_that_of_the_edges() {
    let grid: u32 = 200;
    let vertices: Vec<[f64; 3]> =
        (0..grid * grid).map(|k| [f64::from(k / grid), f64::from(k % grid), f64::from(k % 7)]).collect();
    let squares = (0..grid * (grid - 1)).filter(|k| k % grid != grid - 1);
    let triangles: Vec<[u32; 3]> =
        squares.flat_map(|k| [[k, k + grid, k + 1], [k + 1, k + grid, k + grid + 1]]).collect();
    let (many, edges) = (triangles.len(), 8 * vertices.len());
    let mesh = TriangleMesh::new(vertices, triangles).unwrap();
    let fixed = 64 << 10;
    for (work, most) in [
        (&(|| drop(mesh.clone().check_closed(FillRule::NonZero))) as &dyn Fn(), 28 * many + edges),
        (&|| drop(mesh.clone().report()), 28 * many + edges),
        (&|| drop(mesh.clone().defects(3)), 24 * many + edges),
    ] {
        let (_, held) = most_held(work);
        let (_, copied) = most_held(|| mesh.clone());
        assert!(held <= copied + most + fixed, "{held} bytes, {copied} of them a copy, not {most}");
    }
}

/// Checks the promise of `Polyhedron`. The triangulation's memory is reserved before the triangulation
/// begins.
#[test]
fn memory_of_polyhedra_is_a_small_multiple_of_their_corners() {
    for corners in [2_000, 50_000] {
        let arrays = band(corners);
        let (made, held) = most_held(|| polyhedron(&arrays));
        assert_eq!(made.unwrap().mesh().triangles().len() as u32, 4 * corners - 4);
        // The prism has six times as many corners as the band.
        let allowed = (MAKING as u32 + 320 * corners + 100 * 6 * corners) as usize;
        assert!(held <= allowed, "{held} bytes, not {allowed}");
        println!("{} bytes a corner of the face", held / corners as usize);
    }
}

/// Checks the promise of the 3MF reader for parts whose instances amount to nothing.
#[cfg(feature = "threemf")]
#[test]
fn packages_take_twenty_times_their_parts() {
    let vertices: String = (0..9999).map(|i| format!("<vertex x=\"{i}\" y=\"0\" z=\"0\"/>")).collect();
    let triangles = "<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>".repeat(9000);
    let mesh = format!(
        "<object id=\"1\"><mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh></object>"
    );
    let empty = "<object id=\"1\"><mesh/></object>";
    let components = "<component objectid=\"1\"/>".repeat(9000);
    let components = format!("{empty}<object id=\"2\"><components>{components}</components></object>");
    let objects: String = (1..9000).map(|id| format!("<object id=\"{id}\"/>")).collect();
    let items = "<item objectid=\"1\"/>";
    let mut worst = 0.0_f64;
    for (name, most, text) in [
        ("mesh", 8.0, zip::model("", &mesh, items)),
        ("components", 20.0, zip::model("", &components, "<item objectid=\"2\"/>")),
        ("objects", 20.0, zip::model("", &objects, "")),
        ("items", 20.0, zip::model("", empty, &items.repeat(9000))),
    ] {
        let package = zip::zip(&[
            zip::Entry::stored("[Content_Types].xml", zip::CONTENT_TYPES),
            zip::Entry::stored("_rels/.rels", zip::RELATIONSHIPS),
            zip::Entry::stored("3D/3dmodel.model", &text),
        ]);
        let (result, held) = most_held(|| exchange::read_mesh(&package, &Default::default()));
        result.unwrap();
        let times = held as f64 / text.len() as f64;
        println!("{name}: {times:.1} times {} bytes", text.len());
        assert!(times < most, "{name}: {times}");
        worst = worst.max(times);
    }
    assert!(worst > 1.0, "{worst}");
}

/// Checks the promise of the mesh readers.
#[test]
fn meshes_take_a_small_multiple_of_their_files() {
    let mesh = TriangleMesh::from_facets(facets()).unwrap();
    let mut files: Vec<(Vec<u8>, fuzz::meshes::Reader)> = vec![];
    for (write, read) in fuzz::meshes::WRITERS {
        files.push((write(&mesh), read));
    }
    files.push((exchange::write_stl(&mesh).unwrap(), exchange::read_stl));
    files.push((polygons().into_bytes(), exchange::read_obj));
    // A face that is not convex, of many corners.
    let comb: String = (0..9000).map(|i| format!("v {} {} 0\n", i / 2, i % 2 * (1 + i / 2 % 2))).collect();
    let face: String = (1..=9000).map(|i| format!(" {i}")).collect();
    files.push((format!("{comb}v 9 -1 0\nf{face} 9001\n").into_bytes(), exchange::read_obj));
    let winding =
        (0..100u8).flat_map(|x| (1..=100).map(move |y| [x, if x % 2 == 0 { y } else { 101 - y }, 0]));
    let corners: Vec<[u8; 3]> = winding.chain([[101, 0, 0], [0, 0, 0]]).collect();
    let face = [corners.len() as u16].into_iter().chain(0..corners.len() as u16).flat_map(u16::to_le_bytes);
    let header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty char x\nproperty char y\nproperty char z\n\
         element face 1\nproperty list ushort ushort vertex_index\nend_header\n",
        corners.len()
    );
    files.push((
        header.bytes().chain(corners.iter().flatten().copied()).chain(face).collect(),
        exchange::read_ply,
    ));
    // Files with the least text for each vertex, face and corner, and files that announce more than they
    // contain.
    files.push(("v 0 0 0\n".repeat(5000).into_bytes(), exchange::read_obj));
    let vertices: String = (0..9999).map(|i| format!("v 0 0 {i}\n")).collect();
    files.push((vertices.into_bytes(), exchange::read_obj));
    files.push((("f 1 1 1\n".repeat(5000) + "v 0 0 0").into_bytes(), exchange::read_obj));
    files.push((("f 1 1 1 1\n".repeat(5000) + "v 0 0 0").into_bytes(), exchange::read_obj));
    files.push((format!("v 0 0 0\nf{}\n", " 1".repeat(5000)).into_bytes(), exchange::read_obj));
    files.push((format!("1 5000\n0 0 0\n{}", "3 0 0 0\n".repeat(5000)).into_bytes(), exchange::read_off));
    files.push((format!("4000000000 5000\n{}", "0 0 0\n".repeat(5000)).into_bytes(), exchange::read_off));
    files.push((
        format!("1 4000000000\n0 0 0\n{}", "4 0 0 0 0\n".repeat(5000)).into_bytes(),
        exchange::read_off,
    ));
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 20000\nproperty char x\nproperty char y\n\
                  property char z\nelement face 4000000000\nproperty list uchar uchar vertex_index\nend_header\n";
    let vertices = (0..20_000u32).flat_map(|i| [i as u8, (i >> 8) as u8, (i >> 16) as u8]);
    let both = header.bytes().chain(vertices.clone()).chain([3, 0, 1, 2].repeat(5000));
    files.push((both.collect(), exchange::read_ply));
    let only_vertices = header.replace("4000000000", "0");
    files.push((only_vertices.bytes().chain(vertices).collect(), exchange::read_ply));
    let strip = "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty char x\nproperty char y\nproperty char z\n\
                 element tristrips 1\nproperty list ushort char vertex_index\nend_header\n\0\0\0\x7F\0";
    files.push((strip.bytes().chain([0; 0x7F00]).collect(), exchange::read_ply));
    let mut worst = 0f64;
    for (bytes, read) in &files {
        let mut most = 0.0;
        weigh(&mut most, READING, bytes.len(), || read(bytes));
        println!("{most:.1} times {} bytes", bytes.len());
        worst = worst.max(most);
    }
    assert!(worst <= 128.0 && worst > 64.0, "{worst} times the file");
}

/// A tree with many bricks of few kinds. No other tree is shorter in a file, and no other grows more when
/// copied.
fn dictionary() -> Octree {
    let frame = frame().with_depth(8).unwrap();
    let cuboid = Csg::cuboid([3.3; 3], [29.2; 3]).unwrap();
    compact(build(&cuboid, &frame, Rule::Certified, &CONTROL).unwrap().view()).unwrap()
}

// ---- writes that fail ------------------------------------------------------------------------------------

/// A writer that takes `left` calls of at most `most` bytes each, interrupts every second call, and then
/// fails.
struct Unreliable {
    left: usize,
    most: usize,
    interrupted: bool,
    taken: Vec<u8>,
    failure: fn() -> io::Result<usize>,
}

impl Write for Unreliable {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.interrupted = !self.interrupted;
        if self.interrupted {
            return Err(io::ErrorKind::Interrupted.into());
        }
        if self.left == 0 {
            return (self.failure)();
        }
        self.left -= 1;
        let count = bytes.len().min(self.most);
        self.taken.extend_from_slice(&bytes[..count]);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.left == 0 { (self.failure)().map(drop) } else { Ok(()) }
    }
}

#[test]
fn each_write_may_fail_or_be_short_or_interrupted() {
    let tree = ball(15.0, Rule::Certified);
    let bytes = file::to_bytes(&tree).unwrap();
    type Failure = (fn() -> io::Result<usize>, io::ErrorKind);
    let failures: [Failure; 3] = [
        (|| Err(io::ErrorKind::StorageFull.into()), io::ErrorKind::StorageFull),
        (|| Err(io::ErrorKind::BrokenPipe.into()), io::ErrorKind::BrokenPipe),
        (|| Ok(0), io::ErrorKind::WriteZero),
    ];
    for (failure, kind) in failures {
        for most in [1, 7, 1000, usize::MAX] {
            for left in (0..40).chain([bytes.len() / most.min(bytes.len()) + 60, usize::MAX]) {
                let out = Unreliable { left, most, interrupted: false, taken: vec![], failure };
                let mut out = out;
                match file::write_to(&tree, &mut out) {
                    Ok(()) => assert_eq!(out.taken, bytes),
                    Err(Error::Io(error)) => {
                        assert_eq!((error.kind(), out.left), (kind, 0));
                        assert!(bytes.starts_with(&out.taken));
                    }
                    Err(other) => panic!("{other}"),
                }
                assert!(left != usize::MAX || out.taken == bytes);
            }
        }
    }
    // Every piece may be the last one accepted, and flushing may fail, too.
    let failing = |left| {
        let failure: fn() -> io::Result<usize> = || Err(io::ErrorKind::StorageFull.into());
        let mut out = Unreliable { left, most: usize::MAX, interrupted: false, taken: vec![], failure };
        (file::write_to(&tree, &mut out).is_err(), out.taken.len())
    };
    let pieces = (0..).find(|&left| failing(left).1 == bytes.len()).unwrap();
    assert!(pieces > 3 && failing(pieces).0 && !failing(pieces + 1).0);
}

/// A file-size limit makes the system end the process. No cleanup is possible then, but the old file stays.
/// Where files need no names, no other file stays.
#[test]
fn a_process_that_is_ended_while_it_saves_leaves_the_old_file() {
    use std::os::unix::process::ExitStatusExt;
    let directory = tempfile::tempdir().unwrap();
    let mut shell = Command::new("sh");
    shell.args(["-c", "ulimit -c 0; ulimit -f 4; exec \"$0\" \"$@\""]).arg(std::env::current_exe().unwrap());
    shell.args(["--exact", "failures::limited_child", "--nocapture"]).current_dir(directory.path());
    let path = directory.path().join("tree.lfl");
    std::fs::write(&path, old_file()).unwrap();
    let status = shell.env(TASK, "limited").output().unwrap().status;
    assert!(status.signal().is_some(), "{status}");
    assert_eq!(std::fs::read(&path).unwrap(), old_file());
    #[cfg(target_os = "linux")]
    {
        use rustix::fs::{Mode, OFlags, open};
        let flags = OFlags::TMPFILE | OFlags::RDWR;
        if open(directory.path(), flags, Mode::from_raw_mode(0o600)).is_ok() {
            assert_eq!(names(directory.path()), ["tree.lfl"]);
        }
    }
    for name in names(directory.path()) {
        assert!(name == "tree.lfl" || name.starts_with(".leafless-"), "{name}");
    }
}

/// The process that the test above starts. By itself it does nothing.
#[test]
fn limited_child() {
    if std::env::var(TASK).is_ok_and(|task| task == "limited") {
        let tree = dictionary();
        assert!(file::to_bytes(&tree).unwrap().len() > 4096);
        let _ = file::save(&tree, "tree.lfl");
        unreachable!("the limit is smaller than the file");
    }
}
