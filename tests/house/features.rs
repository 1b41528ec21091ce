//! The program, the C interface, the Python interface and the benchmarks compile the same kernel: their
//! dependencies have the same features, so that cargo compiles the kernel once, and every user computes with
//! the same instructions.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

const MEMBERS: [&str; 4] = ["leafless-cli", "leafless-capi", "leafless-python", "leafless-benches"];

/// Returns the crates that cargo compiles for a package, and the features of each.
fn features(arguments: &[&str]) -> BTreeMap<String, String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--locked", "--edges", "normal,build", "--prefix", "none", "--format", "{p}\t{f}"])
        .args(arguments)
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let lines = text.lines().filter_map(|line| line.trim_end_matches(" (*)").split_once('\t'));
    lines.map(|(package, features)| (package.to_string(), features.to_string())).collect()
}

#[test]
fn all_members_compile_the_same_kernel() {
    let kernel: BTreeSet<String> =
        features(&["-p", "leafless", "--features", "png,scene,threemf,volumes"]).into_keys().collect();
    let members = MEMBERS.map(|member| features(&["-p", member]));
    assert!(kernel.len() > 50, "{kernel:?}");
    let mut differences = Vec::new();
    for package in &kernel {
        let all = members.each_ref().map(|member| member.get(package).map_or("absent", |found| found));
        if all.iter().any(|found| *found != all[0]) {
            differences.push(format!("{package}: {}", all.join(" | ")));
        }
    }
    assert!(
        differences.is_empty(),
        "add features to packaging/features/Cargo.toml; {} ask for\n{}",
        MEMBERS.join(" | "),
        differences.join("\n")
    );
}
