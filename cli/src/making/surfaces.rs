//! The surfaces that undecided cells keep, and the option that requests them.

use crate::failure::Failure;
use crate::options::number;
use crate::source::solid::Corners;
use clap::Args;
use leafless::lattice::MAX_DEPTH;
use leafless::{Frame, Rule};

/// The option to keep surfaces.
#[derive(Clone, Copy, Args)]
pub struct Surfaces {
    /// Keep the surfaces that cross undecided cells: the file is small, and as exact as the input. Cells of
    /// any size are not split further once three surfaces are left; the depth limits the splitting where more
    /// meet. A mesh needs the tolerance: its surface is kept within layers of this thickness, relative to its
    /// longest side. For a scene without it, only exact surfaces are kept
    #[arg(long, value_name = "TOLERANCE", num_args = 0..=1, require_equals = true, value_parser = tolerance)]
    surfaces: Option<Option<f64>>,
}

fn tolerance(text: &str) -> Result<f64, String> {
    number(text, "a part of the longest side, above 0 and below 1", |part| part > 0.0 && part < 1.0)
}

impl Surfaces {
    /// No surfaces.
    pub const NONE: Surfaces = Surfaces { surfaces: None };

    /// True if surfaces are kept.
    pub fn are_kept(&self) -> bool {
        self.surfaces.is_some()
    }

    /// Returns the greatest thickness of layers, relative to the longest side.
    pub fn part(&self) -> Option<f64> {
        self.surfaces.flatten()
    }

    /// Returns the greatest thickness of layers in a solid with these corners.
    pub fn tolerance(&self, (min, max): Corners) -> Option<f64> {
        let longest = (0..3).map(|axis| max[axis] - min[axis]).fold(0.0, f64::max);
        self.part().map(|part| part * longest)
    }

    /// Refuses surfaces if a rule decides the cells.
    pub fn check_rule(&self, rule: Rule) -> Result<(), Failure> {
        if self.are_kept() && rule != Rule::Certified {
            return Err(self.refusal("a --rule other than certified: undecided cells keep them"));
        }
        Ok(())
    }

    /// Refuses an option that surfaces make useless.
    pub fn refusal(&self, useless: &str) -> Failure {
        Failure::Usage(format!("--surfaces does not go with {useless}"))
    }
}

/// Returns the frame with cells that are no finer than layers of this thickness require.
pub fn deep_enough(frame: Frame, tolerance: f64) -> Frame {
    let is_fine = |frame: &Frame| frame.cell_size() <= tolerance;
    (1..MAX_DEPTH).find_map(|depth| frame.with_depth(depth).ok().filter(is_fine)).unwrap_or(frame)
}
