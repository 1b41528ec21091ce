//! Options for reading scenes.

use std::path::Path;

use super::facets::Facets;
use super::{Scene, check, grammar};
use crate::error::Error;
use crate::exchange::read_whole;

/// Options for reading a scene.
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
    /// The curved calls that are drawn as polygons.
    pub facets: Facets,
    /// Maximum number of bytes of a file that the scene names; longer files are refused. `None` means no
    /// limit.
    pub max_bytes: Option<u64>,
}

impl SceneOptions {
    /// Returns the defaults with this choice of curved calls that are drawn as polygons.
    pub fn with_facets(facets: Facets) -> SceneOptions {
        SceneOptions { facets, ..SceneOptions::default() }
    }

    /// Reads a scene from its text, in UTF-8. Files that it names are looked for in `folder`. Without a
    /// folder they are refused; pipes and devices, which may have no end, are always refused.
    ///
    /// O(text) for exact shapes, times the number of sides for polygons, plus the files.
    ///
    /// # Errors
    /// [`SceneError`](crate::error::SceneError) with line and column for any problem in the text or in a file
    /// that it names; [`Error::OutOfMemory`].
    pub fn read(&self, text: impl AsRef<[u8]>, folder: Option<&Path>) -> Result<Scene, Error> {
        let bytes = text.as_ref();
        let text = core::str::from_utf8(bytes).map_err(|error| {
            let valid = core::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default();
            grammar::fault(valid, valid.len(), "the text is not UTF-8")
        })?;
        let files = check::Files { folder, max_bytes: self.max_bytes };
        check::check(&grammar::parse(text)?, files, self.facets)
    }

    /// Reads a scene from a file. Files that it names are looked for in the same folder.
    ///
    /// # Errors
    /// [`Error::File`] with the path and one of these causes: the errors of [`read`](Self::read);
    /// [`Error::Io`] if the file itself cannot be read; [`Error::Limit`] if it is a pipe with more than 1
    /// GiB; [`Error::OutOfMemory`].
    pub fn open(&self, path: impl AsRef<Path>) -> Result<Scene, Error> {
        let path = path.as_ref();
        let folder = path.parent().unwrap_or(Path::new(""));
        let text = read_whole(path);
        text.and_then(|text| self.read(text, Some(folder))).map_err(|error| error.of_file(path))
    }
}

/// Reads a scene from its text with the default options ([`SceneOptions::read`]).
///
/// # Errors
/// The errors of [`SceneOptions::read`].
pub fn read_scene(text: impl AsRef<[u8]>, folder: Option<&Path>) -> Result<Scene, Error> {
    SceneOptions::default().read(text, folder)
}

/// Reads a scene from a file with the default options ([`SceneOptions::open`]).
///
/// # Errors
/// The errors of [`SceneOptions::open`].
pub fn open_scene(path: impl AsRef<Path>) -> Result<Scene, Error> {
    SceneOptions::default().open(path)
}
