//! The frame of another solid, and the option that names it.

use crate::failure::Failure;
use crate::source::file::Stored;
use crate::source::input::Input;
use clap::Args;
use leafless::Frame;
use std::ffi::OsString;

/// The option for the frame of another solid.
#[derive(Args)]
pub struct Like {
    /// Take the cube of another solid (.lfl), and its levels unless --depth is given, so that both can be
    /// combined
    #[arg(long, value_name = "FILE.lfl", conflicts_with = "bounds")]
    like: Option<OsString>,
}

impl Like {
    /// Returns the cube and the levels that the user gave, or those of the other solid.
    pub fn frame(
        &self,
        bounds: Option<Frame>,
        depth: Option<u8>,
        surfaces: bool,
    ) -> Result<(Option<Frame>, Option<u8>), Failure> {
        let Some(name) = &self.like else { return Ok((bounds, depth)) };
        let input = Input::from(&**name);
        let stored = Stored::read(&input, false)?.0;
        let (frame, keeps_surfaces) = match &stored {
            Stored::Octree(octree) => (octree.frame(), octree.view().cuts().is_some()),
            Stored::Dexels(model) => (model.frame(), false),
        };
        // A solid whose cells keep surfaces has far too many levels for an octree without surfaces.
        if keeps_surfaces && !surfaces && depth.is_none() {
            let problem = format!(
                "the cells of {input} keep surfaces, and go to level {}: --surfaces keeps some, too",
                frame.depth()
            );
            return Err(Failure::Usage(format!("--like: {problem}; or give --depth")));
        }
        Ok((Some(*frame), depth.or(Some(frame.depth()))))
    }
}
