//! Runs the tests of the Python package, with the extension module that was built beside this program.
//!
//! ```text
//! LEAFLESS_PYTHON=/path/to/python cargo test --test python
//! ```
//!
//! They need a Python with NumPy and pytest, and are skipped without it. What else is missing (trimesh, mypy, nbclient …) skips the tests
//! that need it.

#![cfg(unix)]

use std::path::{Path, PathBuf};
use std::process::Command;

fn package() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The extension module: cargo puts it beside the folder of this program.
fn extension() -> PathBuf {
    let program = std::env::current_exe().expect("a program has a path");
    let ending = if cfg!(target_os = "macos") { "dylib" } else { "so" };
    let found =
        program.ancestors().skip(1).take(2).map(|folder| folder.join(format!("lib_leafless.{ending}")));
    found.into_iter().find(|path| path.exists()).expect("cargo builds the library before its tests")
}

#[test]
fn package_tests() {
    let python = std::env::var_os("LEAFLESS_PYTHON").unwrap_or_else(|| "python3".into());
    let has_tools = Command::new(&python).args(["-c", "import numpy, pytest"]).output();
    if !has_tools.is_ok_and(|output| output.status.success()) {
        assert!(std::env::var_os("LEAFLESS_PYTHON").is_none(), "LEAFLESS_PYTHON has no NumPy or no pytest");
        println!("SKIPPED python::package_tests: there is no Python with NumPy and pytest");
        return;
    }
    // The package as it is when it is installed.
    let folder = tempfile::tempdir().unwrap();
    let installed = folder.path().join("leafless");
    std::fs::create_dir(&installed).unwrap();
    for entry in std::fs::read_dir(package().join("package/leafless")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "py" || ending == "pyi" || ending == "typed") {
            std::fs::copy(&path, installed.join(path.file_name().unwrap())).unwrap();
        }
    }
    std::fs::copy(extension(), installed.join("_leafless.abi3.so")).unwrap();
    let status = Command::new(&python)
        .args(["-m", "pytest", "-p", "no:cacheprovider", "-rs", "--durations=5"])
        .arg(package().join("tests"))
        .current_dir(folder.path())
        .env("PYTHONPATH", folder.path())
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .status();
    assert!(status.unwrap().success(), "tests of the Python package failed");
}
