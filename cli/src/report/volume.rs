//! Reports of volumes.

use crate::source::volume::Voxels;
use crate::words::number;
use leafless::exchange::LengthUnit;
use serde::Serialize;

/// The description of a volume.
#[derive(Serialize)]
pub struct Info {
    format: String,
    samples: &'static str,
    /// The least and the greatest sample; null if no sample is finite.
    range: Option<[f64; 2]>,
    /// Least sample that is inside.
    threshold: f64,
    extents: [u32; 3],
    /// Edges of a voxel, before the volume is turned if its axes are not x, y and z.
    spacing: [f64; 3],
    corner: [f64; 3],
    is_turned: bool,
    unit: Option<&'static str>,
}

impl Info {
    pub fn new(volume: &Voxels) -> Info {
        let grid = volume.volume.grid();
        Info {
            format: volume.format.clone(),
            samples: volume.kind.name(),
            range: volume.volume.value_range(),
            threshold: volume.threshold,
            extents: grid.extents(),
            spacing: grid.spacing(),
            corner: grid.corner(),
            is_turned: volume.placement.is_some(),
            unit: volume.unit.map(LengthUnit::symbol),
        }
    }

    /// Returns the report for people.
    pub fn text(&self) -> String {
        let [x, y, z] = self.extents;
        let place = |p: [f64; 3]| p.map(number).join(", ");
        let unit = self.unit.map_or_else(String::new, |unit| format!(" {unit}"));
        let range = self.range.map_or("none is finite".into(), |[least, greatest]| {
            format!(
                "from {} to {}, inside from {} on",
                number(least),
                number(greatest),
                number(self.threshold)
            )
        });
        format!(
            "{} volume, {x} x {y} x {z} samples of type {}: {range}\nvoxels {}{unit}, from {}\n",
            self.format,
            self.samples,
            place(self.spacing),
            place(self.corner),
        )
    }
}
