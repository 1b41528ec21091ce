//! Checks of interval ends beside cell centres against exact rationals, on every way into and out of
//! tri-dexel models.

use leafless::dexel::{Dexel, DexelEditor, DexelEnd, DexelEnds, DexelFormat, DexelNormals, TriDexelRef};
use leafless::op::DexelOptions;
use leafless::{
    AnySolid, Control, Csg, Error, FillRule, Frame, MeshSolid, Rule, TriDexel, TriangleMesh, build, dexelize,
    file,
};
use leafless_testkit::Random;
use leafless_testkit::exact::Exact;

/// Returns a frame that is not dyadic. Its origin lies at most 2^far of its edge away from zero.
fn any_frame(random: &mut Random, depths: std::ops::RangeInclusive<u8>, far: i32) -> Frame {
    let depth = depths.start() + random.below(u64::from(depths.end() - depths.start()) + 1) as u8;
    let edge = (0.5 + random.unit()) * 10.0f64.powi(random.below(13) as i32 - 6);
    let origin = [0; 3].map(|_| {
        let power = random.below(far as u64 + 8) as i32 - 8;
        (random.unit() - 0.5) * edge * 2.0f64.powi(power)
    });
    Frame::new(origin, edge, depth).unwrap()
}

fn centre(frame: &Frame, axis: usize, k: u32) -> Exact {
    Exact::half_plane(frame, axis, 2 * k + 1)
}

/// Returns the sign of a coordinate minus the centre of cell k.
fn side(frame: &Frame, axis: usize, at: f64, k: u32) -> i32 {
    Exact::from(at).minus(&centre(frame, axis, k)).sign()
}

/// Returns the first cell whose centre does not lie below a coordinate.
fn gap(frame: &Frame, axis: usize, at: f64) -> u32 {
    (0..frame.cells()).find(|&k| side(frame, axis, at, k) <= 0).unwrap_or(frame.cells())
}

/// Moves a double by this number of steps to its neighbours.
fn stepped(x: f64, steps: i64) -> f64 {
    (0..steps.abs()).fold(x, |x, _| if steps > 0 { x.next_up() } else { x.next_down() })
}

/// Returns the centre of cell k, rounded.
fn near(frame: &Frame, axis: usize, k: u32) -> f64 {
    frame.origin()[axis] + (f64::from(k) + 0.5) * frame.cell_size()
}

/// True if a gap between centres contains a double. The first and the last gap reach to the universe's faces.
fn has_double(frame: &Frame, axis: usize, gap: u32) -> bool {
    let from = near(frame, axis, gap);
    gap == 0
        || (-4..=4).map(|steps| stepped(from, steps)).chain([near(frame, axis, gap.saturating_sub(1))]).any(
            |x| side(frame, axis, x, gap - 1) > 0 && (gap == frame.cells() || side(frame, axis, x, gap) <= 0),
        )
        || (-4..=4).map(|steps| stepped(near(frame, axis, gap - 1), steps)).any(|x| {
            side(frame, axis, x, gap - 1) > 0 && (gap == frame.cells() || side(frame, axis, x, gap) <= 0)
        })
}

/// Rebuilds a model from all its intervals, each changed by `change`.
fn again(model: &TriDexelRef<'_>, change: impl Fn(usize, Dexel) -> Dexel) -> Result<TriDexel, Error> {
    let list = |axis: usize, ray: [u32; 2], list: &mut Vec<Dexel>| {
        list.extend(model.rays(axis).unwrap().dexels(ray).map(|dexel| change(axis, dexel)));
        Ok(())
    };
    TriDexel::from_rays(model.frame(), model.format(), model.directions(), list, &Control::default())
}

/// Checks that returned ends lie on the stored side of their centres, and that they rebuild the same model.
fn check(model: &TriDexel, name: &str) {
    let (view, frame) = (model.view(), model.frame());
    view.check().unwrap();
    let mut all = true;
    for axis in (0..3).filter(|&axis| model.view().directions()[axis]) {
        let rays = view.rays(axis).unwrap();
        let extent = view.statistics(axis).unwrap().extent[axis];
        let [us, vs] = rays.window();
        let mut met = [f64::INFINITY, f64::NEG_INFINITY];
        for [u, v] in vs.clone().flat_map(|v| us.clone().map(move |u| [u, v])) {
            for dexel in rays.dexels([u, v]) {
                let ends = [dexel.start, dexel.end];
                let cells = ends.map(|end| end.cells.unwrap());
                assert!(cells[0] < cells[1] && ends[0].at <= ends[1].at, "{name}: {dexel:?}");
                met = [met[0].min(ends[0].at), met[1].max(ends[1].at)];
                for (end, cells) in ends.into_iter().zip(cells) {
                    let stored = (cells - 0.5).ceil() as u32;
                    if has_double(frame, axis, stored) {
                        assert_eq!(
                            gap(frame, axis, end.at),
                            stored,
                            "{name}: axis {axis}, {end:?}, {frame:?}"
                        );
                    } else {
                        all = false;
                    }
                    let same = DexelEnd::in_cells(frame, axis, cells).unwrap();
                    assert_eq!((same.at, same.cells), (end.at, end.cells));
                }
            }
        }
        assert_eq!(met, extent, "{name}");
    }
    // The round trip is exact. With coordinates alone, it is exact as far as coordinates can distinguish
    // ends.
    assert_eq!(&again(view, |_, dexel| dexel).unwrap(), model, "{name}: there and back, {frame:?}");
    let bare = |_: usize, Dexel { start, end, material }: Dexel| Dexel {
        start: DexelEnd { cells: None, ..start },
        end: DexelEnd { cells: None, ..end },
        material,
    };
    let ulp =
        frame.origin().iter().fold(frame.edge(), |most, o| most.max(o.abs() + frame.edge())) * f64::EPSILON;
    if all && view.format().ends == DexelEnds::Fixed && ulp < 0.2 * frame.edge() / (1u64 << 31) as f64 {
        assert_eq!(&again(view, bare).unwrap(), model, "{name}: by coordinates, {frame:?}");
    } else if let Ok(near) = again(view, bare)
        && all
    {
        for k in 0..frame.cells() {
            let cell = [k; 3];
            assert_eq!(near.view().contains_cell(cell), view.contains_cell(cell));
        }
    }
}

const FORMATS: [DexelFormat; 3] = {
    let plain = DexelFormat {
        ends: DexelEnds::Fixed,
        normals: DexelNormals::None,
        surfaces: false,
        materials: false,
    };
    [
        plain,
        DexelFormat { ends: DexelEnds::Double, ..plain },
        DexelFormat {
            ends: DexelEnds::Double,
            normals: DexelNormals::Bits32,
            surfaces: true,
            materials: true,
        },
    ]
};

/// Builds a model with rays along one axis; only one of these rays has intervals.
fn one_ray(frame: &Frame, format: DexelFormat, axis: usize, list: &[Dexel]) -> Result<TriDexel, Error> {
    let directions = [0, 1, 2].map(|a| a == axis);
    let rays = |_: usize, ray: [u32; 2], all: &mut Vec<Dexel>| {
        if ray == [0, 1] {
            all.extend_from_slice(list);
        }
        Ok(())
    };
    TriDexel::from_rays(frame, format, directions, rays, &Control::default())
}

#[test]
fn the_end_that_was_on_the_wrong_side() {
    let frame = Frame::new([-5.148202647275424; 3], 8.342378659550686, 3).unwrap();
    let (start, end) = (-2.5412093161658342, 2.0);
    let inside = side(&frame, 2, start, 2) <= 0;
    for format in FORMATS {
        let interval = Dexel { start: DexelEnd::new(start), end: DexelEnd::new(end), material: 0 };
        let model = one_ray(&frame, format, 2, &[interval]).unwrap();
        assert_eq!(model.view().contains_cell([0, 1, 2]), inside);
        check(&model, "one end");
    }
}

#[test]
fn ends_from_a_host_keep_their_side_of_every_centre() {
    let mut random = Random(5);
    let mut wrong = 0;
    for round in 0..4000 {
        let frame = any_frame(&mut random, 1..=4, if round % 4 == 0 { 50 } else { 12 });
        let (axis, n) = ((random.below(3)) as usize, frame.cells());
        // Some ends, each within a few ulps of a centre.
        let mut ends: Vec<f64> = (0..2 + 2 * random.below(3))
            .map(|_| {
                let k = random.below(u64::from(n)) as u32;
                stepped(near(&frame, axis, k), random.below(7) as i64 - 3)
            })
            .collect();
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let list: Vec<Dexel> = ends
            .chunks_exact(2)
            .map(|e| Dexel { start: DexelEnd::new(e[0]), end: DexelEnd::new(e[1]), material: 3 })
            .collect();
        let others = [[1, 2], [0, 2], [0, 1]][axis];
        for format in FORMATS {
            let model = one_ray(&frame, format, axis, &list).unwrap();
            for k in 0..n {
                let expected = list.iter().any(|dexel| {
                    side(&frame, axis, dexel.start.at, k) <= 0 && side(&frame, axis, dexel.end.at, k) > 0
                });
                let mut cell = [0; 3];
                (cell[axis], cell[others[0]], cell[others[1]]) = (k, 0, 1);
                wrong += u32::from(model.view().contains_cell(cell) != expected);
            }
            check(&model, "host");
            // Between files, to the other form, and back.
            let bytes = file::dexels::to_bytes(&model).unwrap();
            let read = file::dexels::from_bytes(&bytes).unwrap();
            assert_eq!(read, model);
            check(&read, "file");
            let double = DexelFormat { ends: DexelEnds::Double, ..format };
            let other = model.view().to_format(double, &Control::default()).unwrap();
            check(&other, "other form");
            let back = other.view().to_format(format, &Control::default()).unwrap();
            assert_eq!(back, model);
        }
    }
    assert_eq!(wrong, 0);
}

/// Ends given in cells are exact, however close, also on frames that doubles cannot tell from a point.
#[test]
fn ends_in_cells_are_exact_anywhere() {
    let mut random = Random(9);
    for _ in 0..500 {
        let frame = any_frame(&mut random, 2..=4, 70);
        let (axis, n) = (random.below(3) as usize, f64::from(frame.cells()));
        let mut cells: Vec<f64> = (0..6)
            .map(|_| {
                let k = random.below(u64::from(frame.cells())) as f64 + 0.5;
                stepped(k, random.below(5) as i64 - 2)
            })
            .chain([0.0, n, 1e-300, 1e-12])
            .collect();
        cells.sort_by(f64::total_cmp);
        cells.dedup();
        let end = |cells: f64| DexelEnd::in_cells(&frame, axis, cells).unwrap();
        let list: Vec<Dexel> =
            cells.chunks_exact(2).map(|e| Dexel { start: end(e[0]), end: end(e[1]), material: 0 }).collect();
        for format in FORMATS {
            let model = one_ray(&frame, format, axis, &list).unwrap();
            check(&model, "cells");
            if format.ends == DexelEnds::Double {
                let found: Vec<_> = model.view().rays(axis).unwrap().dexels([0, 1]).collect();
                let found: Vec<_> =
                    found.iter().flat_map(|d| [d.start.cells.unwrap(), d.end.cells.unwrap()]).collect();
                assert_eq!(found, cells[..2 * list.len()]);
            }
        }
    }
    let frame = Frame::new([0.0; 3], 8.0, 3).unwrap();
    for cells in [-1e-300, 8.0f64.next_up(), f64::NAN, f64::INFINITY] {
        assert_eq!(DexelEnd::in_cells(&frame, 0, cells), None);
    }
    assert_eq!(DexelEnd::in_cells(&frame, 3, 1.0), None);
}

/// An end with a changed coordinate, or an end taken to another frame, lies where its coordinate says.
#[test]
fn a_place_counts_with_its_own_coordinate_alone() {
    let frame = Frame::new([0.1; 3], 0.7, 3).unwrap();
    let other = Frame::new([0.0; 3], 0.7, 3).unwrap();
    let end = |cells: f64| DexelEnd::in_cells(&frame, 0, cells).unwrap();
    let moved = DexelEnd { at: 0.55, ..end(1.5) };
    let interval = Dexel { start: moved, end: end(7.0), material: 0 };
    let model = one_ray(&frame, FORMATS[1], 0, &[interval]).unwrap();
    assert!(!model.view().contains_cell([4, 0, 1]) && model.view().contains_cell([5, 0, 1]));
    let interval = Dexel { start: end(1.5), end: end(6.0), material: 0 };
    let model = one_ray(&other, FORMATS[1], 0, &[interval]).unwrap();
    assert!(!model.view().contains_cell([2, 0, 1]) && model.view().contains_cell([3, 0, 1]));
    for (start, stop) in [(end(3.0), end(3.0)), (end(3.0), end(2.0)), (DexelEnd::new(f64::NAN), end(3.0))] {
        let interval = Dexel { start, end: stop, material: 0 };
        assert!(matches!(one_ray(&frame, FORMATS[1], 0, &[interval]), Err(Error::Argument { .. })));
    }
}

fn cube_mesh(low: [f64; 3], high: [f64; 3]) -> TriangleMesh {
    let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { low[axis] } else { high[axis] });
    let triangles = [
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    TriangleMesh::new((0..8).map(corner).collect(), triangles.to_vec()).unwrap()
}

/// Solids with faces within a few ulps of centres contain exactly the centres that exact arithmetic says. All
/// operations keep this.
#[test]
fn solids_operations_and_edits_keep_sides() {
    let (mut random, control) = (Random(77), Control::default());
    for round in 0..150 {
        let frame = any_frame(&mut random, 2..=3, 10);
        let n = u64::from(frame.cells());
        let mut corner = |frame: &Frame, from: u64, to: u64| {
            [0, 1, 2].map(|axis| {
                let k = from + random.below(to - from);
                stepped(near(frame, axis, k as u32), random.below(5) as i64 - 2)
            })
        };
        let (low, high) = (corner(&frame, 0, n / 2), corner(&frame, n / 2, n));
        let mesh = AnySolid::new(MeshSolid::new(cube_mesh(low, high), FillRule::NonZero).unwrap());
        let csg = AnySolid::new(Csg::cuboid(low, high).unwrap());
        let planes = |axis: usize| {
            let mut normal = [0.0; 3];
            normal[axis] = 1.0;
            Csg::half_space(normal, -low[axis]).unwrap()
        };
        let planes = AnySolid::new(Csg::intersection_of([planes(0), planes(1), planes(2)]).unwrap());
        let all = frame.cells();
        // A stored octree, by its cells.
        let tree = AnySolid::new(build(&csg, &frame, Rule::Sampled, &control).unwrap());
        for (name, solid, upper) in
            [("mesh", &mesh, true), ("csg", &csg, true), ("planes", &planes, false), ("octree", &tree, true)]
        {
            for format in FORMATS {
                let options = DexelOptions { format, ..DexelOptions::default() };
                let model = dexelize(solid, &frame, &options, &control).unwrap();
                check(&model, name);
                for cell in (0..all.pow(3)).map(|i| [i % all, i / all % all, i / all / all]) {
                    // (For a centre on a face, the shifted rays choose the side.)
                    let sides = [0, 1, 2].map(|axis| {
                        [
                            side(&frame, axis, low[axis], cell[axis]),
                            side(&frame, axis, high[axis], cell[axis]),
                        ]
                    });
                    let on = sides.iter().flatten().any(|&s| s == 0);
                    let expected = sides.iter().all(|&[a, b]| a < 0 && (b > 0 || !upper));
                    if !on {
                        assert_eq!(model.view().contains_cell(cell), expected, "{name} {round} {cell:?}");
                    }
                }
                if round % 10 == 0 {
                    let other = dexelize(&planes, &frame, &options, &control).unwrap();
                    check(&model.view().difference(other.view(), &control).unwrap(), "difference");
                    check(&model.view().xor(other.view(), &control).unwrap(), "xor");
                    check(&model.view().complement(&control).unwrap(), "complement");
                    let mut editor = DexelEditor::new(model.view()).unwrap();
                    editor.subtract_solid(&planes, &control).unwrap();
                    editor.unite_solid(&mesh, &control).unwrap();
                    check(&editor.freeze(&control).unwrap(), "editor");
                }
            }
        }
    }
}
