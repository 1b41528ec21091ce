//! The program, the C libraries and Python give the same bits: see `tests/same_bits`.

use std::path::Path;
use std::process::Command;

#[test]
fn of_a_clearance() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/same_bits");
    let answers = std::fs::read_to_string(folder.join("answers.txt")).unwrap();
    let expected: Vec<f64> = answers.split_whitespace().map(|end| end.parse().unwrap()).collect();
    let output = Command::new(env!("CARGO_BIN_EXE_leafless"))
        .args(["interfere", "--json", "spindle.off", "shard.off"])
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let found = ["lower", "upper"].map(|end| found["clearance"][end].as_f64().unwrap());
    assert_eq!(found[..], expected[..]);
}
