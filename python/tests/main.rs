//! Runs the tests of the Python package, with the extension module that was built beside this program.
//!
//! ```text
//! LEAFLESS_PYTHON=/path/to/python cargo test --test python
//! ```
//!
//! They need a Python with NumPy and pytest, and are skipped without it. What else is missing (trimesh, mypy,
//! nbclient …) skips the tests that need it.

#![cfg(unix)]

use std::path::{Path, PathBuf};
use std::process::Command;

fn package() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Builds the extension module, which nothing links, so that cargo does not build it for this program. The
/// arguments are those of the tests in C, so that all that both need is compiled once.
fn extension() -> PathBuf {
    let program = std::env::current_exe().expect("a program has a path");
    // …/debug/deps/python-…
    let folder = program.ancestors().nth(2).expect("cargo has folders for programs");
    let profile = if folder.ends_with("release") { "release" } else { "test" };
    let status = Command::new(env!("CARGO"))
        .args([
            "build",
            "--quiet",
            "--lib",
            "--features",
            "leafless-capi/test",
            "--test",
            "c_api",
            "--profile",
            profile,
        ])
        .current_dir(package().parent().expect("the package lies in the repository"))
        .status();
    assert!(status.unwrap().success(), "the extension module was not built");
    let ending = if cfg!(target_os = "macos") { "dylib" } else { "so" };
    folder.join(format!("lib_leafless.{ending}"))
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
