//! Each documented way to install, from a fresh clone and with an empty registry of cargo.
//!
//! ```text
//! cargo test --test house on_nothing:: -- --ignored --nocapture
//! ```
//!
//! The test downloads all crates, compiles everything once, and prints the time of each command. It needs
//! git, a C compiler and Python, for the whole list also cmake and Conan.

#![cfg(unix)]

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

/// The commands of the README, of include/README.md and of packaging/README.md, in this order: what is
/// compiled for the first is there for the second. A command whose first program is missing is skipped.
/// `HERE` is the clone, `NEW` a folder for results.
const COMMANDS: [(&str, &str); 7] = [
    ("the first command", "cargo run --release -- demo \"$NEW/demo\""),
    ("the program", "cargo install --path cli --root \"$NEW\" && \"$NEW/bin/leafless\" --version"),
    (
        "the C libraries",
        "cargo run --release -p leafless-capi -- --prefix \"$NEW/prefix\" && ls \"$NEW/prefix/lib\"",
    ),
    (
        "CMake",
        "cmake -S packaging/consumers/subdirectory -B \"$NEW/cmake\" -DLEAFLESS_SOURCE=\"$HERE\" \
         && cmake --build \"$NEW/cmake\" && \"$NEW/cmake/bored\"",
    ),
    (
        "Python",
        "python3 -m venv \"$NEW/python\" && \"$NEW/python/bin/pip\" install -q ./python \
         && \"$NEW/python/bin/python\" -c 'import leafless; print(leafless.__version__)'",
    ),
    ("Conan", "conan profile detect --exist-ok && conan create packaging/conan"),
    ("the tests", "cargo test --no-run"),
];

#[test]
#[ignore = "downloads all crates and compiles for many minutes"]
fn every_way_to_install() {
    let folder = tempfile::tempdir().unwrap();
    let (here, new, home) =
        (folder.path().join("leafless"), folder.path().join("new"), folder.path().join("cargo"));
    std::fs::create_dir_all(&new).unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let cloned = Command::new("git").args(["clone", "--quiet"]).arg(root).arg(&here).status().unwrap();
    assert!(cloned.success(), "the repository cannot be cloned");
    for (name, command) in COMMANDS {
        let program = command.split_whitespace().next().expect("a command has a program");
        if Command::new(program).arg("--version").stdout(Stdio::null()).status().is_err() {
            println!("SKIPPED on_nothing::{name}: there is no {program}");
            continue;
        }
        let start = Instant::now();
        let mut shell = Command::new("sh");
        shell.args(["-c", command]).current_dir(&here).env("HERE", &here).env("NEW", &new);
        shell.env("CARGO_HOME", &home).env("CONAN_HOME", folder.path().join("conan"));
        // Settings of this test's own build would change the builds.
        for (variable, _) in std::env::vars_os() {
            let text = variable.to_string_lossy();
            if text.starts_with("CARGO_") && text != "CARGO_HOME" || text == "RUSTFLAGS" {
                shell.env_remove(variable);
            }
        }
        let output = shell.output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{name}: {command}\n{told}");
        println!("{:>4} s  {name}: {command}", start.elapsed().as_secs());
    }
}
