//! Reports of tri-dexel models.

use crate::words::{count, counted, number, put_line, short};
use leafless::TriDexel;
use leafless::dexel::{DexelEnds, DexelNormals};
use serde::Serialize;
use std::collections::BTreeMap;

/// The contents of one direction.
#[derive(Serialize)]
struct Direction {
    axis: &'static str,
    /// Number of rays that cross the solid.
    rays: u64,
    intervals: u64,
    bytes: u64,
    /// Estimated volume, in cubic model units.
    volume: f64,
    /// Number of rays that pierce an open mesh an odd number of times, if they were counted.
    #[serde(skip_serializing_if = "Option::is_none")]
    odd_rays: Option<u64>,
}

/// The description of a tri-dexel model.
#[derive(Serialize)]
pub struct Info {
    kind: &'static str,
    depth: u8,
    origin: [f64; 3],
    edge: f64,
    ends: &'static str,
    /// Bits of a normal.
    normals: u8,
    surfaces: bool,
    materials: bool,
    pub intervals: u64,
    pub bytes: u64,
    directions: Vec<Direction>,
    metadata: BTreeMap<String, String>,
}

impl Info {
    /// Describes a model whose file has `bytes` bytes. O(n).
    pub fn new(model: &TriDexel, bytes: u64) -> Info {
        let (view, frame, format) = (model.view(), model.frame(), model.view().format());
        let direction = |axis: usize| {
            let statistics = view.statistics(axis)?;
            Some(Direction {
                axis: ["x", "y", "z"][axis],
                rays: statistics.rays,
                intervals: statistics.intervals,
                bytes: statistics.bytes,
                volume: statistics.volume,
                odd_rays: None,
            })
        };
        Info {
            kind: "tri-dexel",
            depth: frame.depth(),
            origin: frame.origin(),
            edge: frame.edge(),
            ends: if format.ends == DexelEnds::Double { "double" } else { "fixed" },
            normals: match format.normals {
                DexelNormals::None => 0,
                DexelNormals::Bits16 => 16,
                DexelNormals::Bits32 => 32,
            },
            surfaces: format.surfaces,
            materials: format.materials,
            intervals: view.interval_count(),
            bytes,
            directions: (0..3).filter_map(direction).collect(),
            metadata: (model.metadata().iter())
                .map(|(key, value)| (key.to_owned(), value.to_owned()))
                .collect(),
        }
    }

    /// Adds the numbers of rays along each axis that pierce an open mesh an odd number of times.
    pub fn with_odd(mut self, odd: [u64; 3]) -> Info {
        for direction in &mut self.directions {
            direction.odd_rays =
                ["x", "y", "z"].iter().position(|&axis| axis == direction.axis).map(|i| odd[i]);
        }
        self
    }

    /// Returns the number of rays that cross the solid, in all directions.
    pub fn rays(&self) -> u64 {
        self.directions.iter().map(|direction| direction.rays).sum()
    }

    /// Returns the number of rays that pierce an open mesh an odd number of times, in all directions in which
    /// they were counted.
    pub fn odd_rays(&self) -> u64 {
        self.directions.iter().filter_map(|direction| direction.odd_rays).sum()
    }

    /// Returns the estimate of the direction with the most rays that cross the solid; the first one if
    /// several have equally many. 0 without any direction.
    ///
    /// Each direction is exact along its rays, and samples across them. Its error is largest where the
    /// surface runs along the rays: about one cell. The more rays cross the solid, the smaller that part of
    /// the surface is.
    pub fn best_volume(&self) -> f64 {
        self.best().map_or(0.0, |direction| direction.volume)
    }

    fn best(&self) -> Option<&Direction> {
        self.directions.iter().reduce(|best, other| if other.rays > best.rays { other } else { best })
    }

    /// Returns the least and the greatest estimate.
    pub fn volume_range(&self) -> [f64; 2] {
        let volumes = || self.directions.iter().map(|direction| direction.volume);
        match self.directions.len() {
            0 => [0.0; 2],
            _ => [volumes().fold(f64::INFINITY, f64::min), volumes().fold(f64::NEG_INFINITY, f64::max)],
        }
    }

    /// Returns the volume and the estimates of the other directions, for people.
    pub fn volume_text(&self) -> String {
        let about = format!("volume about {}", short(self.best_volume()));
        match (self.volume_range().map(short), self.best()) {
            ([low, high], Some(Direction { axis, .. })) if low != high => {
                format!("{about} (along {axis}, which has most rays; {low} to {high} along all)")
            }
            _ => about,
        }
    }

    /// Returns the axes that rays run along.
    pub fn axes(&self) -> String {
        self.directions.iter().map(|direction| direction.axis).collect()
    }

    /// Returns the report for people.
    pub fn text(&self) -> String {
        let mut text = String::new();
        let mut line = |name: &str, value: String| put_line(&mut text, name, &value);
        line("depth", format!("{}, {} cells per axis", self.depth, count(1 << self.depth)));
        line("origin", self.origin.map(number).join(" "));
        line("edge", number(self.edge));
        line("kind", "tri-dexel model: intervals along rays".into());
        let mut stored =
            vec![format!("{} ends", if self.ends == "fixed" { "fixed-point" } else { self.ends })];
        if self.normals != 0 {
            stored.push(format!("normals of {} bits", self.normals));
        }
        for (is, name) in [(self.surfaces, "surfaces"), (self.materials, "materials")] {
            stored.extend(is.then(|| name.to_owned()));
        }
        line("stored", stored.join(", "));
        for Direction { axis, rays, intervals, bytes, volume, .. } in &self.directions {
            let held =
                [counted(*rays, "ray", "rays"), counted(*intervals, "interval", "intervals")].join(", ");
            let volume = number(*volume);
            line(&format!("along {axis}"), format!("{held}, {} bytes, volume about {volume}", count(*bytes)));
        }
        line("bytes", count(self.bytes));
        for (key, value) in &self.metadata {
            // A file may contain any text; a terminal should not obey it.
            line(&key.escape_debug().to_string(), value.escape_debug().to_string());
        }
        text
    }
}

/// Returns a one-line summary of a model.
pub fn summary(model: &TriDexel, bytes: u64) -> String {
    let axes = Info::new(model, bytes).axes();
    let intervals = counted(model.view().interval_count(), "interval", "intervals");
    format!(
        "tri-dexel model, depth {}, along {axes}, {intervals}, {} bytes",
        model.frame().depth(),
        count(bytes)
    )
}
