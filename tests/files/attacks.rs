//! Attacks that are fuzz targets, too: arbitrary bytes as scenes of unit cells and as attributes, against
//! dense arrays.

use leafless::attribute::{
    Attribute, Criterion, Detail, FillOptions, MovedAttribute, ScalarType, ValueRange, ValueType,
    fill_channel,
};
use leafless::query::StopReason;
use leafless::voxel::VoxelRecords;
use leafless::{Affine, Bounds, Cell, Control, Csg, Error, Frame, Interval, clearance};
use leafless_testkit::fuzz::{
    attributes, boundaries, contacts, contours, direct, layers, layouts, measures, records,
};
use leafless_testkit::{Random, repeated};
use std::path::Path;

/// Runs a fuzz target's body on inputs that are the same every time.
fn any_bytes(body: fn(&[u8]), seeds: std::ops::Range<u64>, most: u64) {
    for seed in seeds {
        let mut random = Random(seed);
        let length = 1 + random.bits() % most;
        let data: Vec<u8> = (0..length).map(|_| random.bits() as u8).collect();
        // A failing test prints its input.
        let result = std::panic::catch_unwind(|| body(&data));
        assert!(result.is_ok(), "input {seed}: {data:?}");
    }
}

/// Runs a fuzz target's body on its corpus.
fn corpus(target: &str, body: fn(&[u8])) {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
    let mut count = 0;
    for entry in std::fs::read_dir(&corpus).unwrap() {
        let path = entry.unwrap().path();
        let data = std::fs::read(&path).unwrap();
        let result = std::panic::catch_unwind(|| body(&data));
        assert!(result.is_ok(), "{}", path.display());
        count += 1;
    }
    assert!(count > 100, "{target}: {count} inputs");
}

// ---- findings ------------------------------------------------------------------------------------------

/// An attribute of the points' coordinates. Its range over a box is the box itself.
struct Places;

impl Attribute for Places {
    fn components(&self) -> usize {
        3
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        values.iter_mut().zip(points).for_each(|(value, &[x, y, z])| *value = Some([x, y, z, 0.0]));
        Ok(())
    }

    fn range(&self, bounds: &Bounds) -> Result<ValueRange, Error> {
        let range = |axis: usize| Interval::new(bounds.min[axis], bounds.max[axis]).unwrap();
        Ok(ValueRange::Within([range(0), range(1), range(2), Interval::exactly(0.0)]))
    }
}

#[test]
fn the_range_of_a_moved_attribute_holds_values_whose_summands_cancel() {
    // 2^20 x + (1 + 2^-40) y - 2^20. The sum of the first two terms loses the small bit.
    let (large, bit) = (2f64.powi(20), 2f64.powi(-40));
    let rows = [[large, 1.0 + bit, 0.0, -large], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    let moved = MovedAttribute::new(Places, Affine::new(rows).unwrap());
    let bounds = Bounds::new([1.0; 3], [1.0 + 2f64.powi(-22), 1.25, 1.25]).unwrap();
    let value = moved.value(bounds.min).unwrap().unwrap();
    let ValueRange::Within(ranges) = moved.range(&bounds).unwrap() else { panic!("it is known") };
    assert_eq!(value[0], 1.0);
    assert!(ranges[0].contains(value[0]), "{ranges:?}");
}

#[test]
fn a_clearance_of_what_goes_on_outside_does_not_claim_its_tolerance() {
    let frame = Frame::new([0.0; 3], 16.0, 4).unwrap();
    let a = Csg::cuboid([0.0; 3], [1.0; 3]).unwrap();
    let b = Csg::half_space([0.0, 1.0, 0.0], -2.0).unwrap();
    let ask = |tolerance: f64| clearance(&a, &b, &frame, tolerance, &Control::threads(1)).unwrap();
    let found = ask(0.0);
    assert!(found.clipped && found.distance == Interval::new(0.0, 1.0).unwrap(), "{found:?}");
    assert_eq!(found.stop_reason, StopReason::Exhausted);
    assert_eq!(ask(2.0).stop_reason, StopReason::Tolerance);
}

/// An attribute with the value 1 where x is at least 0, and no value elsewhere. It provides no ranges.
struct HalfSpace;

impl Attribute for HalfSpace {
    fn components(&self) -> usize {
        1
    }

    fn values(&self, points: &[[f64; 3]], values: &mut [Option<[f64; 4]>]) -> Result<(), Error> {
        let of = |point: &[f64; 3]| (point[0] >= 0.0).then_some([1.0, 0.0, 0.0, 0.0]);
        values.iter_mut().zip(points).for_each(|(value, point)| *value = of(point));
        Ok(())
    }
}

#[test]
fn cells_of_unknown_range_are_split_whatever_the_tolerance() {
    let frame = Frame::new([-3.0, 0.0, 0.0], 4.0, 2).unwrap();
    let detail = Detail::new(f64::INFINITY, 1.0, f64::INFINITY, Criterion::Range).unwrap();
    let value_type = ValueType::new(ScalarType::U8, 1).unwrap();
    let options = FillOptions { value_type, frame, solid: None, detail: Some(detail) };
    let channel = fill_channel(&HalfSpace, &options, &Control::threads(1)).unwrap();
    let value = |x: u32| channel.view().unwrap().value_of_cell([x, 0, 0]).map(|value| value[0]);
    assert_eq!([0, 1, 2, 3].map(value), [None, None, None, Some(1.0)]);
}

#[test]
fn what_is_no_cell_has_no_children_among_records() {
    let frame = Frame::new([0.0; 3], 1.0, 20).unwrap();
    let records = VoxelRecords::from_arrays(&frame, vec![0], vec![1], vec![0], 0, vec![]).unwrap();
    for at in [[u32::MAX; 3], [1, 0, 0], [1 << 31, 0, 0]] {
        assert!(
            records.view().children(Cell { level: 0, at }).iter().all(|range| range.is_empty()),
            "{at:?}"
        );
    }
}

// ---- fuzz targets --------------------------------------------------------------------------------------

#[test]
fn what_the_fuzzer_found_interesting() {
    corpus("attributes", attributes);
    corpus("records", records);
    corpus("direct", direct);
}

#[test]
fn measures_that_the_fuzzer_found_interesting() {
    corpus("measures", measures);
}

#[test]
fn contacts_that_the_fuzzer_found_interesting() {
    corpus("contacts", contacts);
}

#[test]
fn layers_that_the_fuzzer_found_interesting() {
    corpus("layers", layers);
}

#[test]
fn boundaries_that_the_fuzzer_found_interesting() {
    corpus("boundaries", boundaries);
}

#[test]
fn contours_that_the_fuzzer_found_interesting() {
    corpus("contours", contours);
}

#[test]
fn layouts_are_proven() {
    corpus("layouts", layouts);
}

#[test]
fn solids_in_contact() {
    any_bytes(contacts, 0..repeated(70, 200), 40);
}

#[test]
fn surfaces_of_expressions_are_closed_and_as_near_as_is_said() {
    any_bytes(boundaries, 0..repeated(10, 30), 40);
}

#[test]
fn contours_of_anything_are_closed_and_as_near_as_is_said() {
    any_bytes(contours, 0..repeated(10, 30), 40);
}

#[test]
#[ignore = "minutes"]
fn more_surfaces_are_closed_and_as_near_as_is_said() {
    any_bytes(boundaries, 30..4000, 40);
    any_bytes(contours, 30..4000, 40);
}

#[test]
fn scenes_of_unit_cells_are_measured() {
    any_bytes(measures, 0..repeated(700, 2000), 160);
}

#[test]
#[ignore = "minutes"]
fn more_scenes_of_unit_cells_are_measured() {
    any_bytes(measures, 2000..100_000, 160);
}

#[test]
fn attributes_are_filled_in_and_carried() {
    any_bytes(attributes, 0..repeated(1000, 3000), 120);
}

#[test]
#[ignore = "minutes"]
fn more_attributes_are_filled_in_and_carried() {
    any_bytes(attributes, 3000..300_000, 120);
}

#[test]
fn any_arrays_are_records_or_refused() {
    any_bytes(records, 0..repeated(1300, 4000), 200);
}

#[test]
#[ignore = "minutes"]
fn more_arrays_are_records_or_refused() {
    any_bytes(records, 4000..400_000, 200);
}

#[test]
fn meshes_answer_rays_points_and_distances() {
    any_bytes(direct, 0..repeated(700, 2000), 160);
}

#[test]
#[ignore = "minutes"]
fn more_meshes_answer_rays_points_and_distances() {
    any_bytes(direct, 2000..200_000, 160);
}
