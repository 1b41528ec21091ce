//! Without its features the crate needs no standard library: a program without the standard library is built,
//! linked and run.

// The program takes its memory from the C library as Unix has it.
#![cfg(unix)]

use std::path::Path;
use std::process::Command;

#[test]
fn a_program_without_the_standard_library_builds_links_and_runs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let template = root.join("tests/no_std");
    // A copy, so that nothing is written beside the sources. It has the versions with which the crate is
    // tested.
    let copy = Path::new(env!("CARGO_TARGET_TMPDIR")).join("no_std");
    std::fs::create_dir_all(copy.join("src")).unwrap();
    let manifest = std::fs::read_to_string(template.join("Cargo.toml")).unwrap();
    let here = format!("path = {root:?}");
    assert!(manifest.contains("path = \"../..\""));
    std::fs::write(copy.join("Cargo.toml"), manifest.replace("path = \"../..\"", &here)).unwrap();
    std::fs::copy(template.join("src/main.rs"), copy.join("src/main.rs")).unwrap();
    std::fs::copy(root.join("Cargo.lock"), copy.join("Cargo.lock")).unwrap();

    let target = copy.join("target");
    let built = Command::new(env!("CARGO"))
        .args(["build", "--offline", "--quiet", "--manifest-path"])
        .arg(copy.join("Cargo.toml"))
        .arg("--target-dir")
        .arg(&target)
        // Cargo finds its configuration in the same places as for this crate.
        .current_dir(root)
        // Settings for the build of these tests must not apply to a separate program.
        .env_remove("CARGO_BUILD_TARGET")
        .output()
        .unwrap();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));

    let program = target.join("debug").join(format!("leafless-no-std{}", std::env::consts::EXE_SUFFIX));
    let run = Command::new(&program).output().unwrap();
    assert_eq!(run.status.code(), Some(42), "{run:?}");

    // The linker leaves out unused code, so that meshes need no feature of their own.
    #[cfg(target_os = "linux")]
    {
        let bytes = std::fs::read(&program).unwrap();
        // The usual beginning of mangled names.
        let has = |module: &str| {
            let name = format!("8leafless{}{module}", module.len());
            bytes.windows(name.len()).any(|window| window == name.as_bytes())
        };
        assert!(has("solid") && has("op"), "the program has no names");
        for module in ["mesh", "surface", "render", "exchange"] {
            assert!(!has(module), "{module} is in a program that does not use it");
        }
    }
}
