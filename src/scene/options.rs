//! How scenes are read.

use std::path::Path;

use super::facets::Facets;
use super::{Scene, check, grammar};
use crate::error::Error;
use crate::exchange::read_whole;

/// How a scene is to be read.
///
/// ```
/// use leafless::scene::{Facets, SceneOptions, read_scene};
/// let nut = "cylinder($fn = 6, h = 4, r1 = 10, r2 = 10);";
/// assert_eq!(read_scene(nut, None)?.report().polygons, 1);
/// let round = SceneOptions::with_facets(Facets::Exact);
/// assert_eq!(round.read(nut, None)?.report().exact, 1);
/// # Ok::<(), leafless::Error>(())
/// ```
#[non_exhaustive]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SceneOptions {
    /// Which curved calls are drawn as polygons.
    pub facets: Facets,
    /// Refuse files that the scene names and that are longer than this many bytes; `None` means no limit.
    pub max_bytes: Option<u64>,
}

impl SceneOptions {
    /// The defaults, but for which curved calls are drawn as polygons.
    pub fn with_facets(facets: Facets) -> SceneOptions {
        SceneOptions { facets, ..SceneOptions::default() }
    }

    /// Reads a scene from its text, in UTF-8. Files that it names are looked for in `folder`; without one
    /// they are refused, and so are pipes and devices, which may have no end.
    ///
    /// O(text) for what is exact, times the sides of polygons, and the files.
    ///
    /// # Errors
    /// [`SceneError`](crate::error::SceneError) with line and column for whatever is wrong with the text or a
    /// file that it names; [`Error::OutOfMemory`].
    pub fn read(&self, text: impl AsRef<[u8]>, folder: Option<&Path>) -> Result<Scene, Error> {
        let bytes = text.as_ref();
        let text = core::str::from_utf8(bytes).map_err(|error| {
            let valid = core::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default();
            grammar::fault(valid, valid.len(), "the text is not UTF-8")
        })?;
        let files = check::Files { folder, max_bytes: self.max_bytes };
        check::check(&grammar::parse(text)?, files, self.facets)
    }

    /// Reads a scene from a file. Files that it names are looked for beside it.
    ///
    /// # Errors
    /// [`Error::File`] with the path and one of these causes: as [`read`](Self::read), or [`Error::Io`] if
    /// the file itself cannot be read, [`Error::Limit`] if it is a pipe that goes on after 1 GiB;
    /// [`Error::OutOfMemory`].
    pub fn open(&self, path: impl AsRef<Path>) -> Result<Scene, Error> {
        let path = path.as_ref();
        let folder = path.parent().unwrap_or(Path::new(""));
        let text = read_whole(path);
        text.and_then(|text| self.read(text, Some(folder))).map_err(|error| error.of_file(path))
    }
}

/// [`SceneOptions::read`] with the default options.
///
/// # Errors
/// As [`SceneOptions::read`].
pub fn read_scene(text: impl AsRef<[u8]>, folder: Option<&Path>) -> Result<Scene, Error> {
    SceneOptions::default().read(text, folder)
}

/// [`SceneOptions::open`] with the default options.
///
/// # Errors
/// As [`SceneOptions::open`].
pub fn open_scene(path: impl AsRef<Path>) -> Result<Scene, Error> {
    SceneOptions::default().open(path)
}
