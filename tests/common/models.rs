//! The way to the model files.

use std::io::Write;
use std::path::PathBuf;

/// The path of a model file in the folder that `LEAFLESS_MODELS` names; a missing one is a failure. Without
/// that variable the result is `None`, and a line tells so.
pub fn model(name: &str) -> Option<PathBuf> {
    let Some(folder) = std::env::var_os("LEAFLESS_MODELS") else {
        // Past the capture of output, which would hide the line because the test passes.
        let test = std::thread::current();
        let test = test.name().unwrap_or_default();
        let _ = writeln!(std::io::stderr(), "SKIPPED {test}: LEAFLESS_MODELS is not set");
        return None;
    };
    let path = PathBuf::from(folder).join(name);
    assert!(path.is_file(), "LEAFLESS_MODELS is set, but there is no {}", path.display());
    Some(path)
}
