//! Queries of channels: summaries, regions and materials; and volumes as attributes.

use crate::values::{Values, kinds, values_of};
use leafless::attribute::{
    Attribute, ConstantAttribute, FillOptions, FunctionAttribute, Interpolation, ScalarType, ValueRange,
    ValueRegion, ValueType, VolumeAttribute, fill_channel, materials,
};
use leafless::solid::{Band, VoxelGrid};
use leafless::{
    Bounds, Control, Csg, Error, Frame, Interval, Octree, Rule, Tag, Volume, build, intersection, measure,
    union,
};
use leafless_testkit::{Dense, alone, cases, lattice_frame, shapes_of};
use proptest::prelude::*;
use std::f64::consts::PI;

fn contains(outer: Interval, inner: Interval) -> bool {
    outer.lower <= inner.lower && inner.upper <= outer.upper
}

proptest! {
    #![proptest_config(cases(96))]

    #[test]
    fn summaries_are_those_of_dense_arrays(
        (kind, values) in (kinds(), 1u8..=3).prop_flat_map(|(kind, d)| (Just(kind), values_of(d, kind))),
        shape in shapes_of(3), low in prop::array::uniform3(-20i32..80), size in prop::array::uniform3(0i32..90),
        whole in any::<bool>(), everywhere in any::<bool>(),
    ) {
        // Faces at eighths of cells: everything is exact.
        let dense = if everywhere { Dense::uniform(3, Tag::Full) } else { shape.dense() };
        let solid = dense.octree();
        let channel = values.channel(3, kind, None, 1);
        let min = low.map(|a| f64::from(a) / 8.0);
        let max = [0, 1, 2].map(|k| min[k] + f64::from(size[k]) / 8.0);
        let bounds = if whole { None } else { Some(Bounds { min, max }) };
        let asked = if everywhere { None } else { Some(solid.view()) };
        let found = channel.view().unwrap().summary(asked, bounds.as_ref(), &alone()).unwrap();

        let (mut least, mut greatest) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
        let (mut volume, mut without, mut integral) = ([0.0; 2], [0.0; 2], [[0.0; 2]; 4]);
        for at in leafless_testkit::positions(3) {
            let length = |axis: usize| match bounds {
                None => 1.0,
                Some(_) => (max[axis].min(f64::from(at[axis] + 1)) - min[axis].max(f64::from(at[axis]))).max(0.0),
            };
            let part = length(0) * length(1) * length(2);
            let tag = dense.at(at);
            if part == 0.0 || tag == Tag::Empty {
                continue;
            }
            let [sure, possible] = [if tag == Tag::Full { part } else { 0.0 }, part];
            match values.refined(3).at(at) {
                None => without = [without[0] + sure, without[1] + possible],
                Some(value) => {
                    volume = [volume[0] + sure, volume[1] + possible];
                    for k in 0..4 {
                        least[k] = least[k].min(value[k]);
                        greatest[k] = greatest[k].max(value[k]);
                        // No value is negative here.
                        integral[k] = [integral[k][0] + sure * value[k], integral[k][1] + possible * value[k]];
                    }
                }
            }
        }
        let exact = |[lower, upper]: [f64; 2]| Interval::new(lower, upper).unwrap();
        match found {
            None => prop_assert_eq!(volume[1], 0.0),
            Some(found) => {
                prop_assert_eq!((found.least, found.greatest), (least, greatest));
                prop_assert_eq!(found.volume, exact(volume));
                prop_assert_eq!(found.volume_without, exact(without));
                for k in 0..4 {
                    prop_assert_eq!(found.integral[k], exact(integral[k]));
                    if volume[0] > 0.0 {
                        let mean = integral[k][0] / volume[0];
                        prop_assert!(found.mean[k].lower <= mean + 1e-9 && mean - 1e-9 <= found.mean[k].upper);
                    }
                    prop_assert!(least[k] <= found.mean[k].lower && found.mean[k].upper <= greatest[k]);
                }
            }
        }
    }

    #[test]
    fn regions_are_the_cells_with_such_values(
        (kind, values) in (kinds(), 1u8..=3).prop_flat_map(|(kind, d)| (Just(kind), values_of(d, kind))),
        shape in shapes_of(3), low in 0..4i32, size in 0..3i32,
    ) {
        let dense = shape.dense();
        let channel = values.channel(3, kind, None, 1);
        let view = channel.view().unwrap();
        let (low, high) = ([f64::from(low); 4], [f64::from(low + size); 4]);
        let belongs = |at: [u32; 3]| values.refined(3).at(at).is_some_and(|value| {
            (0..kind.components()).all(|k| low[k] <= value[k] && value[k] <= high[k])
        });
        let region = view.region(low, high, &alone()).unwrap();
        let expected = Dense::from_fn(values.depth, |at| {
            if belongs(at.map(|a| a << (3 - values.depth))) { Tag::Full } else { Tag::Empty }
        });
        prop_assert_eq!(Dense::of(region.view()), expected);
        prop_assert!(region.view().is_binary());

        // The region of a solid, also on a deeper or shallower frame.
        let solid = dense.octree();
        let within = ValueRegion::new(solid.view(), view, low, high).unwrap();
        let built = build(&within, solid.frame(), Rule::Certified, &alone()).unwrap();
        let expected = Dense::from_fn(3, |at| if belongs(at) { dense.at(at) } else { Tag::Empty });
        prop_assert_eq!(Dense::of(built.view()), expected.clone());
        for threads in [1, 3] {
            let shallow = solid.frame().with_depth(2).unwrap();
            let built = build(&within, &shallow, Rule::Certified, &Control::threads(threads)).unwrap();
            // Cells that change below are PARTIAL, even if all of their parts belong to the region.
            for (found, expected) in Dense::of(built.view()).tags.iter().zip(expected.cut(2).tags) {
                prop_assert!(*found == expected || *found == Tag::Partial);
            }
        }
    }

    #[test]
    fn ranges_of_volumes_are_true(
        samples in prop::collection::vec(prop_oneof![4 => 0u8..4, 1 => any::<u8>()], 60),
        low in prop::array::uniform3(-0.5..5.5f64), size in prop::array::uniform3(0.0..3.0f64), steps in any::<bool>(),
        parts in prop::collection::vec(prop::array::uniform3(0.001..0.999f64), 30), nearest in any::<bool>(),
    ) {
        let grid = VoxelGrid::new([5, 4, 3], [0.25, 0.0, 0.5], [1.0, 1.25, 0.5]).unwrap();
        let volume = Volume::new(samples.into(), &grid, Band::at_least(1.0).unwrap(), &alone()).unwrap();
        let kind = if nearest { Interpolation::Nearest } else { Interpolation::Trilinear };
        let attribute = VolumeAttribute::new(volume, kind);
        let step = |x: f64| if steps { (4.0 * x).round() / 4.0 } else { x };
        let bounds = Bounds::new(low.map(step), [0, 1, 2].map(|k| step(low[k]) + step(size[k]))).unwrap();
        let range = attribute.range(&bounds).unwrap();
        for part in parts {
            let point = [0, 1, 2].map(|k| bounds.min[k] + part[k] * (bounds.max[k] - bounds.min[k]));
            if (0..3).any(|k| !(bounds.min[k] < point[k] && point[k] < bounds.max[k])) {
                continue;
            }
            let value = attribute.value(point).unwrap();
            match range {
                ValueRange::Unknown => {}
                ValueRange::Nowhere => prop_assert_eq!(value, None),
                ValueRange::Within(ranges) => prop_assert!(ranges[0].contains(value.unwrap()[0])),
            }
        }
    }
}

fn scalar(scalar: ScalarType) -> ValueType {
    ValueType::new(scalar, 1).unwrap()
}

fn constant(frame: &Frame, value: f64, kind: ValueType) -> leafless::attribute::Channel {
    let options = FillOptions { value_type: kind, frame: *frame, solid: None, detail: None };
    fill_channel(&ConstantAttribute::new(&[value]).unwrap(), &options, &alone()).unwrap()
}

/// A ball of two metals with densities known within intervals. The mass interval contains the analytic mass,
/// and is as narrow as densities and geometry allow.
#[test]
fn the_mass_of_two_materials_holds_the_analytic_one() {
    let frame = Frame::new([-1.0; 3], 2.0, 7).unwrap();
    let ball = Csg::ball([0.0; 3], 0.75).unwrap();
    let upper = build(&Csg::cuboid([-1.0, -1.0, 0.25], [1.0; 3]).unwrap(), &frame, Rule::Certified, &alone())
        .unwrap();
    let parts = constant(&frame, 1.0, scalar(ScalarType::U8));
    let parts =
        parts.view().unwrap().with_value_in(upper.view(), Some([2.0, 0.0, 0.0, 0.0]), &alone()).unwrap();
    let found =
        materials(&ball, parts.view().unwrap(), &frame.with_depth(20).unwrap(), 1e-5, &alone()).unwrap();
    // A cap of height 0.5, and the rest.
    let all = 4.0 / 3.0 * PI * 0.75f64.powi(3);
    let cap = PI * 0.25 * (0.75 - 0.5 / 3.0);
    let volumes = [all - cap, cap];
    assert_eq!(found.iter().map(|m| m.value[0]).collect::<Vec<_>>(), [1.0, 2.0]);
    for (material, volume) in found.iter().zip(volumes) {
        let interval = material.properties.volume;
        assert!(interval.contains(volume) && interval.width() <= 1.1e-5 * volume, "{interval:?} {volume}");
        assert!(!material.properties.clipped);
    }
    // The centroid of a cap lies at 3 (2r − h)² / (4 (3r − h)).
    let centroid = 3.0 * (1.5f64 - 0.5).powi(2) / (4.0 * (2.25 - 0.5));
    assert!(found[1].properties.centroid.unwrap()[2].contains(centroid));
    let densities = [Interval::new(7.8, 7.9).unwrap(), Interval::new(2.69, 2.71).unwrap()];
    let mass = found.iter().zip(densities).fold((0.0, 0.0), |(lower, upper), (material, density)| {
        let volume = material.properties.volume;
        (lower + volume.lower * density.lower, upper + volume.upper * density.upper)
    });
    let exact = [0, 1]
        .map(|end| (0..2).map(|k| volumes[k] * [densities[k].lower, densities[k].upper][end]).sum::<f64>());
    assert!(mass.0 <= exact[0] && exact[1] <= mass.1);
    assert!(mass.1 - mass.0 <= 1.001 * (exact[1] - exact[0]) + 3e-5 * exact[1]);

    // The same from a stored part: wider, and true.
    let stored = build(&ball, &frame, Rule::Certified, &alone()).unwrap();
    let coarse = materials(stored.view(), parts.view().unwrap(), &frame, 0.0, &alone()).unwrap();
    for (coarse, fine) in coarse.iter().zip(&found) {
        assert!(contains(coarse.properties.volume, fine.properties.volume));
    }
    let densities = constant(&frame, 7.5, scalar(ScalarType::F32));
    let densities =
        densities.view().unwrap().with_value_in(upper.view(), Some([2.5, 0.0, 0.0, 0.0]), &alone()).unwrap();
    let summary = densities.view().unwrap().summary(Some(stored.view()), None, &alone()).unwrap().unwrap();
    let exact = volumes[0] * 7.5 + volumes[1] * 2.5;
    assert!(summary.integral[0].contains(exact) && summary.integral[0].width() < 0.12 * exact);
    assert!(summary.mean[0].contains(exact / all));
}

/// A region provides all that its solid provides: second order where the value does not change.
#[test]
fn a_region_of_a_solid_is_measured_as_fast() {
    let frame = Frame::new([-1.0; 3], 2.0, 20).unwrap();
    let ball = Csg::ball([0.1, 0.0, 0.0], 0.75).unwrap();
    let all = constant(&frame.with_depth(4).unwrap(), 3.0, scalar(ScalarType::U16));
    let region = ValueRegion::new(&ball, all.view().unwrap(), [3.0; 4], [3.0; 4]).unwrap();
    let alone_measured = measure(&ball, &frame, 1e-6, &alone()).unwrap();
    let within = measure(&region, &frame, 1e-6, &alone()).unwrap();
    assert_eq!((within.volume, within.splits), (alone_measured.volume, alone_measured.splits));
    let nothing = ValueRegion::new(&ball, all.view().unwrap(), [4.0; 4], [9.0; 4]).unwrap();
    assert_eq!(measure(&nothing, &frame, 1e-6, &alone()).unwrap().volume, Interval::exactly(0.0));
    let wrong = ValueRegion::new(&ball, all.view().unwrap(), [f64::NAN; 4], [9.0; 4]);
    assert!(matches!(wrong, Err(Error::Argument { name: "band", .. })));
    let elsewhere = Frame::new([0.0; 3], 1.0, 5).unwrap();
    assert!(matches!(measure(&region, &elsewhere, 0.1, &alone()), Err(Error::FrameMismatch { .. })));
}

#[test]
fn what_cannot_be_summed_up_is_refused() {
    let frame = lattice_frame(3);
    let channel = constant(&frame, 2.0, scalar(ScalarType::U8));
    let view = channel.view().unwrap();
    let summary = |min: [f64; 3], max: [f64; 3]| view.summary(None, Some(&Bounds { min, max }), &alone());
    assert!(summary([f64::NAN; 3], [1.0; 3]).is_err());
    assert!(summary([1.0; 3], [0.0; 3]).is_err());
    assert_eq!(summary([-5.0; 3], [-1.0; 3]).unwrap(), None);
    assert_eq!(summary([2.0; 3], [2.0; 3]).unwrap(), None);
    let all = summary([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]).unwrap().unwrap();
    assert_eq!((all.volume, all.integral[0]), (Interval::exactly(512.0), Interval::exactly(1024.0)));
    let other = Octree::uniform(Frame::new([1.0; 3], 8.0, 3).unwrap(), Tag::Full, Tag::Empty).unwrap();
    assert!(matches!(view.summary(Some(other.view()), None, &alone()), Err(Error::FrameMismatch { .. })));
    // More materials than anybody needs.
    let count =
        FunctionAttribute::new(1, |p| Some([p[0] + 16.0 * (p[1] + 16.0 * p[2]), 0.0, 0.0, 0.0])).unwrap();
    let frame = lattice_frame(5);
    let options = FillOptions { value_type: scalar(ScalarType::F32), frame, solid: None, detail: None };
    let channel = fill_channel(&count, &options, &alone()).unwrap();
    let all = Octree::uniform(frame, Tag::Full, Tag::Empty).unwrap();
    let refused = materials(all.view(), channel.view().unwrap(), &frame, 0.1, &alone());
    assert!(matches!(refused, Err(Error::Limit { what: "materials", .. })));
}

/// On the grid's own frame, the nearest samples are the grid's samples.
#[test]
fn a_volume_becomes_a_channel() {
    let grid = VoxelGrid::new([8, 5, 7], [0.0; 3], [0.5; 3]).unwrap();
    let samples: Vec<u16> = (0..8 * 5 * 7).map(|i| (i * i % 91) as u16).collect();
    let volume = Volume::new((&samples[..]).into(), &grid, Band::at_least(50.0).unwrap(), &alone()).unwrap();
    let frame = grid.frame().unwrap();
    let options = FillOptions { value_type: scalar(ScalarType::U16), frame, solid: None, detail: None };
    let nearest = VolumeAttribute::new(volume.clone(), Interpolation::Nearest);
    let channel = fill_channel(&nearest, &options, &alone()).unwrap();
    let expected = Values::from_fn(3, |at| volume.sample(at).map(|sample| [sample, 0.0, 0.0, 0.0]));
    assert_eq!(Values::of(&channel), expected);
    // Where the volume's solid is, values matter; its threshold is a band of the channel.
    let solid = build(&volume, &frame, Rule::Sampled, &alone()).unwrap();
    let region = channel.view().unwrap().region([50.0; 4], [f64::INFINITY; 4], &alone()).unwrap();
    assert_eq!(region, solid);
    let both = intersection(region.view(), solid.view(), &alone()).unwrap();
    assert_eq!(both, union(region.view(), solid.view(), &alone()).unwrap());
    let smooth = VolumeAttribute::new(volume.clone(), Interpolation::Trilinear);
    let deeper =
        FillOptions { value_type: scalar(ScalarType::F32), frame: frame.with_depth(5).unwrap(), ..options };
    let channel = fill_channel(&smooth, &deeper, &Control::threads(2)).unwrap();
    let point = [1.3, 0.9, 2.1];
    let cell = channel.frame().cell_of(point).unwrap();
    let centre = cell.map(|a| (f64::from(a) + 0.5) * channel.frame().cell_size());
    assert_eq!(
        channel.view().unwrap().value_at(point).unwrap()[0],
        f64::from(volume.value_at(centre).unwrap() as f32)
    );
}
