//! Access to the model files.

use std::io::Write;
use std::path::PathBuf;

/// Returns the path of a model file in the folder that `LEAFLESS_MODELS` names, and panics if the file is
/// missing. Without that variable the function prints a line and returns `None`.
pub fn model(name: &str) -> Option<PathBuf> {
    let Some(folder) = std::env::var_os("LEAFLESS_MODELS") else {
        // Bypass the capture of output, which would hide the line because the test passes.
        let test = std::thread::current();
        let test = test.name().unwrap_or_default();
        let _ = writeln!(std::io::stderr(), "SKIPPED {test}: LEAFLESS_MODELS is not set");
        return None;
    };
    let path = PathBuf::from(folder).join(name);
    assert!(path.is_file(), "LEAFLESS_MODELS is set, but there is no {}", path.display());
    Some(path)
}
