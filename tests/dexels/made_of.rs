//! Octrees of tri-dexel models: how ends decide cells, and how materials are carried over.

use leafless::attribute::dexel_materials;
use leafless::dexel::{Dexel, DexelEnd, DexelFormat, DexelNormals, TriDexelRef};
use leafless::op::{DexelOptions, octree_from_dexel_ends, octree_from_dexels};
use leafless::surface::dual_contouring_dexels;
use leafless::{
    Control, Csg, Error, FillRule, Frame, MeshSolid, SurfaceOptions, Tag, TriDexel, build_extended, dexelize,
    measure,
};
use leafless_testkit::Random;

const CONTROL: Control<'static> =
    Control { threads: 1, max_nodes: None, max_bytes: None, max_splits: None, cancel: None, progress: None };

fn frame(depth: u8) -> Frame {
    Frame::new([0.0; 3], 16.0, depth).unwrap()
}

/// Derives the tag of a finest cell from the rays through the cell, interval by interval.
fn told(model: &TriDexelRef<'_>, cell: [u32; 3]) -> Tag {
    let mut tags = Vec::new();
    for axis in 0..3 {
        let Some(rays) = model.rays(axis) else { continue };
        let others = [[1, 2], [0, 2], [0, 1]][axis];
        let (low, high) = (f64::from(cell[axis]), f64::from(cell[axis] + 1));
        // Intervals that touch are one.
        let mut runs: Vec<[f64; 2]> = Vec::new();
        for dexel in rays.dexels(others.map(|other| cell[other])) {
            let [start, end] = [dexel.start, dexel.end].map(|end| end.cells.unwrap());
            match runs.last_mut() {
                Some(last) if last[1] == start => last[1] = end,
                _ => runs.push([start, end]),
            }
        }
        tags.push(match () {
            () if runs.iter().any(|run| run[0] <= low && run[1] >= high) => Tag::Full,
            () if runs.iter().all(|run| run[1] <= low || run[0] >= high) => Tag::Empty,
            () => Tag::Partial,
        });
    }
    match tags.first() {
        None => Tag::Empty,
        Some(first) if tags.iter().all(|tag| tag == first) => *first,
        Some(_) => Tag::Partial,
    }
}

#[test]
fn a_cell_is_undecided_if_and_only_if_an_end_lies_in_it_or_rays_disagree() {
    for depth in [1, 2, 3, 5] {
        let ball = Csg::ball([7.3, 8.1, 8.0], 5.7).unwrap();
        // Its lower face lies in a plane of every lattice, the upper one in a cell.
        let plate = Csg::cuboid([1.0, 2.0, 8.0], [15.0, 14.5, 8.3]).unwrap();
        for solid in [&ball, &plate] {
            for directions in [[true; 3], [true, false, true], [false, true, false]] {
                let options = DexelOptions { directions, ..DexelOptions::default() };
                let model = dexelize(solid, &frame(depth), &options, &CONTROL).unwrap();
                let tree = octree_from_dexel_ends(model.view(), &CONTROL).unwrap();
                let sampled = octree_from_dexels(model.view(), &CONTROL).unwrap();
                for i in 0..1u32 << (3 * depth) {
                    let cell = [0, 1, 2].map(|axis| i >> (axis * u32::from(depth)) & ((1 << depth) - 1));
                    let (tag, centre) = (tree.view().tag_at(cell), sampled.view().tag_at(cell));
                    assert_eq!(tag, told(model.view(), cell), "{depth} {directions:?} {cell:?}");
                    assert!(tag == Tag::Partial || tag == centre, "{cell:?}");
                }
                assert!(!tree.proof().full && !tree.proof().empty);
            }
        }
    }
}

#[test]
fn what_is_thinner_than_a_cell_is_undecided_and_not_lost() {
    // No centre of a cell lies in this sheet.
    let sheet = Csg::cuboid([1.0, 1.0, 8.6], [15.0, 15.0, 8.8]).unwrap();
    let model = dexelize(&sheet, &frame(4), &DexelOptions::default(), &CONTROL).unwrap();
    let (sampled, ends) = (
        octree_from_dexels(model.view(), &CONTROL).unwrap().statistics().volume(),
        octree_from_dexel_ends(model.view(), &CONTROL).unwrap().statistics().volume(),
    );
    assert_eq!((sampled.lower, sampled.upper), (0.0, 0.0));
    assert!(ends.lower == 0.0 && ends.upper == 14.0 * 14.0, "{ends:?}");
}

#[test]
fn random_rays_that_disagree_leave_cells_open() {
    let mut random = Random(5);
    let format = DexelFormat { materials: true, ..DexelFormat::default() };
    let rays = |_: usize, _: [u32; 2], list: &mut Vec<Dexel>| {
        let mut at = random.between(0.0, 5.0);
        while at < 15.0 {
            let to = (at + random.between(0.1, 6.0)).min(16.0);
            let material = random.below(3) as u32;
            list.push(Dexel { start: DexelEnd::new(at), end: DexelEnd::new(to), material });
            // Some bodies touch the next one, which then has another material.
            at = if random.below(3) == 0 { to } else { to + random.between(0.2, 4.0) };
        }
        list.dedup_by(|b, a| {
            let touch = a.end.at == b.start.at && a.material == b.material;
            if touch {
                a.end = b.end;
            }
            touch
        });
        Ok::<(), Error>(())
    };
    let model = TriDexel::from_rays(&frame(3), format, [true, false, true], rays, &CONTROL).unwrap();
    let tree = octree_from_dexel_ends(model.view(), &CONTROL).unwrap();
    let cells = (0..512u32).map(|i| [i & 7, i >> 3 & 7, i >> 6]);
    for cell in cells {
        assert_eq!(tree.view().tag_at(cell), told(model.view(), cell), "{cell:?}");
    }
}

#[test]
fn materials_become_a_channel() {
    let of = |low: f64, high: f64, material: u32| {
        let block = Csg::cuboid([1.0, 1.0, low], [15.0, 13.0, high]).unwrap();
        let model = dexelize(&block, &frame(6), &DexelOptions::default(), &CONTROL).unwrap();
        model.view().with_material(material, &CONTROL).unwrap()
    };
    let (steel, brass) = (of(1.0, 6.1, 7), of(6.1, 15.0, u32::MAX));
    let model = steel.view().union(brass.view(), &CONTROL).unwrap();
    let tree = octree_from_dexels(model.view(), &CONTROL).unwrap();
    let channel = dexel_materials(model.view(), tree.view(), &CONTROL).unwrap().unwrap();
    assert_eq!(channel.name(), "material");
    let (view, depth) = (channel.view().unwrap(), tree.frame().depth());
    let mut seen = [0, 0];
    for i in 0..1u32 << (3 * depth) {
        let cell = [0, 1, 2].map(|axis| i >> (axis * u32::from(depth)) & ((1 << depth) - 1));
        if tree.view().tag_at(cell) == Tag::Full {
            let centre = cell.map(|a| 0.25 * (f64::from(a) + 0.5));
            let expected = if centre[2] < 6.1 { 7 } else { u32::MAX };
            assert_eq!(view.value_at(centre).map(|value| value[0]), Some(f64::from(expected)), "{cell:?}");
            seen[usize::from(expected != 7)] += 1;
        }
    }
    assert!(seen.iter().all(|&seen| seen > 40_000), "{seen:?}");
    // A region of one material is one cell.
    let one = octree_from_dexels(steel.view(), &CONTROL).unwrap();
    let channel = dexel_materials(steel.view(), one.view(), &CONTROL).unwrap().unwrap();
    assert!(channel.bytes() < 200, "{}", channel.bytes());
    // Models without materials have no channel, and models of other cubes are refused.
    let plain = dexelize(&Csg::ball([8.0; 3], 3.0).unwrap(), &frame(4), &DexelOptions::default(), &CONTROL);
    let plain = plain.unwrap();
    assert!(dexel_materials(plain.view(), tree.view(), &CONTROL).unwrap().is_none());
    let other = Frame::new([1.0; 3], 16.0, 4).unwrap();
    let other = leafless::Octree::uniform(other, Tag::Full, Tag::Empty).unwrap();
    assert!(matches!(
        dexel_materials(steel.view(), other.view(), &CONTROL),
        Err(Error::FrameMismatch { .. })
    ));
}

/// The library's way to an octree with surfaces: ends and normals make a surface, the surface is a mesh, and
/// the mesh makes a solid.
#[test]
fn a_model_with_normals_becomes_an_octree_with_surfaces() {
    let (centre, radius) = ([8.1, 7.9, 8.2], 5.3);
    let ball = Csg::ball(centre, radius).unwrap();
    let format = DexelFormat { normals: DexelNormals::Bits32, ..DexelFormat::default() };
    let options = DexelOptions { format, ..DexelOptions::default() };
    let model = dexelize(&ball, &frame(5), &options, &CONTROL).unwrap();
    let (mesh, _) = dual_contouring_dexels(model.view(), &CONTROL).unwrap();
    let solid = MeshSolid::new(mesh, FillRule::NonZero).unwrap();
    let options = SurfaceOptions { tolerance: Some(16.0 * 1e-3) };
    let tree = build_extended(&solid, &frame(10), &options, &CONTROL).unwrap();
    assert!(tree.view().cuts().is_some() && tree.proof().full && tree.proof().empty);
    let exact = 4.0 / 3.0 * std::f64::consts::PI * f64::powi(radius, 3);
    let found = measure(&tree, tree.frame(), 1e-3 * exact, &CONTROL).unwrap().volume;
    // The volume is that of the reconstructed surface, which is near the ball's surface and not on it.
    let middle = 0.5 * found.lower + 0.5 * found.upper;
    assert!((middle / exact - 1.0).abs() < 5e-3, "{found:?} {exact}");
}
