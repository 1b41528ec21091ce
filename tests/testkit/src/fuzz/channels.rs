//! All queries of a file's channels, verified or not.

use super::CONTROL;
use crate::Random;
use leafless::attribute::{Attribute, CarryRule, ChannelOperand, ChannelRef, ValueRange, carry_channel};
use leafless::{Bounds, Control, Membership, Octree};

/// Number of examined cells of each channel.
const CELLS: usize = 24;

/// Queries all channels of `tree`. Whatever their bytes, answers stay within bounds and agree, and work on a
/// whole channel ends or reports damage. If `verified`, every result is well-formed and right.
pub fn channels(tree: &Octree, verified: bool) {
    let names: Vec<&str> = tree.channels().iter().map(|channel| channel.name()).collect();
    assert!(names.len() <= 256 && names.is_sorted_by(|a, b| a < b), "{names:?}");
    for channel in tree.channels() {
        let Ok(view) = channel.view() else {
            assert!(!verified, "the links were checked");
            continue;
        };
        let coarse = view.frame().with_depth(tree.frame().depth()).expect("the depth of a tree");
        assert_eq!(&coarse, tree.frame());
        let sound = view.check().is_ok();
        assert!(sound || !verified);
        let cells = cells(view);
        for &at in &cells {
            let value = view.value_of_cell(at);
            let centre = centre(view, at);
            // A channel is an attribute; in frames that doubles resolve, a centre lies in its cell.
            if view.frame().cell_of(centre) == Some(at) {
                let again = view.value_at(centre);
                assert_eq!(value.map(|v| v.map(f64::to_bits)), again.map(|v| v.map(f64::to_bits)));
                let near = view.frame().cell_size() / 4.0;
                let corners = [centre.map(|c| c - near), centre.map(|c| c + near)];
                if let Some(bounds) = Bounds::new(corners[0], corners[1])
                    && corners.iter().all(|&corner| view.frame().cell_of(corner) == Some(at))
                {
                    in_range(&channel.range(&bounds), value, view, sound);
                }
            }
        }
        let whole = channel.range(&Bounds::of(view.frame()));
        for &at in cells.iter().filter(|_| sound) {
            in_range(&whole, view.value_of_cell(at), view, sound);
        }
        changed(tree, view, &cells, verified);
    }
}

type Value = Option<[f64; 4]>;

/// Checks that the range of a sound channel contains its values.
fn in_range(range: &Result<ValueRange, leafless::Error>, value: Value, view: &ChannelRef<'_>, sound: bool) {
    match range {
        Ok(ValueRange::Nowhere) if sound => assert_eq!(value, None),
        Ok(ValueRange::Within(ranges)) if sound => {
            let value = value.expect("everything in the range has a value");
            assert!((0..view.value_type().components()).all(|k| ranges[k].contains(value[k])));
        }
        Ok(_) => {}
        Err(error) => assert!(!sound, "{error}"),
    }
}

/// Checks channels derived from this one.
fn changed(tree: &Octree, view: &ChannelRef<'_>, cells: &[[u32; 3]], verified: bool) {
    let control = Control { max_nodes: Some(1 << 14), max_bytes: Some(1 << 20), ..CONTROL };
    let operand = ChannelOperand { solid: tree.view(), channel: view };
    for rule in [CarryRule::Left, CarryRule::Mean] {
        let Ok(carried) = carry_channel(tree.view(), &[operand; 2], rule, &control) else { continue };
        if !verified {
            continue;
        }
        let carried = carried.view().expect("a channel in memory");
        carried.check().expect("a result of good operands");
        for &at in cells {
            let centre = centre(view, at);
            if view.frame().cell_of(centre) == Some(at) && tree.contains(centre) == Membership::Inside {
                assert_eq!(carried.value_at(centre), view.value_of_cell(at), "{at:?}");
            }
        }
    }
    for value in [None, Some([1.0; 4])] {
        if let Ok(edited) = view.with_value_in(tree.view(), value, &control)
            && verified
        {
            edited.view().expect("a channel in memory").check().expect("a result of good operands");
        }
    }
}

/// Returns corners of the universe and random cells.
fn cells(view: &ChannelRef<'_>) -> Vec<[u32; 3]> {
    let end = view.frame().cells();
    let mut random = Random(view.value_count() ^ view.element_count() << 32);
    let mut cells = vec![[0; 3], [end - 1; 3], [end / 2; 3]];
    cells.resize_with(CELLS, || [0; 3].map(|_: u32| (random.bits() % u64::from(end)) as u32));
    cells
}

fn centre(view: &ChannelRef<'_>, at: [u32; 3]) -> [f64; 3] {
    let (frame, size) = (view.frame(), view.frame().cell_size());
    [0, 1, 2].map(|axis| frame.origin()[axis] + (f64::from(at[axis]) + 0.5) * size)
}
