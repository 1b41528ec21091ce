//! Reports of the surfaces that cells of an octree keep.

use crate::words::{count, counted};
use leafless::octree::SurfaceKind;
use leafless::{Control, Interval, Octree, measure};
use serde::Serialize;

/// Numbers of surfaces by their kind.
#[derive(Serialize, Default)]
struct Surfaces {
    planes: u64,
    quadrics: u64,
    powers: u64,
    tori: u64,
    slabs: u64,
}

/// The contents of the undecided cells.
#[derive(Serialize)]
pub struct Cuts {
    /// Cells whose solid is a known function of surfaces.
    cells: u64,
    /// Cells about which nothing is known.
    given_up: u64,
    splits: u64,
    surfaces: Surfaces,
    bytes: u64,
}

/// Most cells to split for the volume: a moment's work.
const MOST_SPLITS: u64 = 1 << 14;

impl Cuts {
    /// Counts the surfaces of an octree; `None` if its cells keep none. O(n).
    pub fn new(octree: &Octree) -> Option<Cuts> {
        let view = octree.view();
        let found = view.cuts()?;
        let mut surfaces = Surfaces::default();
        for id in 0..u32::try_from(found.surfaces).unwrap_or(u32::MAX) {
            let of_kind = match view.surface(id).map(|surface| surface.kind()) {
                Some(SurfaceKind::Plane) => &mut surfaces.planes,
                Some(SurfaceKind::Quadric) => &mut surfaces.quadrics,
                Some(SurfaceKind::Powers) => &mut surfaces.powers,
                Some(SurfaceKind::Torus) => &mut surfaces.tori,
                _ => &mut surfaces.slabs,
            };
            *of_kind += 1;
        }
        let (cells, given_up, splits) = (found.cells, found.given_up, found.splits);
        Some(Cuts { cells, given_up, splits, surfaces, bytes: found.bytes })
    }

    /// True if some of the surfaces are layers with a width, as those of a mesh.
    pub fn has_layers(&self) -> bool {
        self.surfaces.slabs > 0
    }

    /// Returns the volume that the surfaces bound; `None` for a damaged file.
    pub fn volume(octree: &Octree) -> Option<Interval> {
        let finest = octree.frame().with_depth(leafless::lattice::MAX_DEPTH).ok()?;
        let control = Control { max_splits: Some(MOST_SPLITS), ..Control::default() };
        Some(measure(octree, &finest, 1e-9, &control).ok()?.volume)
    }

    /// Returns a short report for people.
    pub fn short_text(&self) -> String {
        let Surfaces { planes, quadrics, powers, tori, slabs } = self.surfaces;
        let surfaces = counted(planes + quadrics + powers + tori + slabs, "surface", "surfaces");
        let cells = counted(self.cells, "cell", "cells");
        let given_up = match self.given_up {
            0 => String::new(),
            some => format!(", {} given up", count(some)),
        };
        format!("{surfaces} in {cells}{given_up}")
    }

    /// Returns the report for people.
    pub fn text(&self) -> String {
        let Surfaces { planes, quadrics, powers, tori, slabs } = self.surfaces;
        let kinds = [
            (planes, ["plane", "planes"]),
            (quadrics, ["quadric", "quadrics"]),
            (powers, ["sum of powers", "sums of powers"]),
            (tori, ["torus", "tori"]),
            (slabs, ["slab", "slabs"]),
        ];
        let kinds = kinds.into_iter().filter(|&(own, _)| own > 0);
        let kinds: Vec<_> = kinds
            .map(|(own, [one, many])| format!("{} {}", count(own), if own == 1 { one } else { many }))
            .collect();
        let kinds = if kinds.is_empty() { "no surfaces".to_owned() } else { kinds.join(", ") };
        let given_up = match self.given_up {
            0 => "none given up".to_owned(),
            some => format!("{} given up", count(some)),
        };
        format!("{kinds} in {} cells, {given_up}; {} bytes in memory", count(self.cells), count(self.bytes))
    }
}
