//! `include/leafless.h` is what `capi/src` says. After a change of the interface,
//!
//! ```text
//! LEAFLESS_BLESS=1 cargo test --test c_api generated
//! ```
//!
//! writes it anew.

use crate::root;

/// The files of the interface, as the header's sections follow each other.
const SECTIONS: &[&str] = &[
    "version",
    "status",
    "boundary",
    "control",
    "frame",
    "mesh",
    "mesh_arrays",
    "mesh_file",
    "mesh_write",
    "mesh_moments",
    "polyhedron",
    "metadata",
    "octree",
    "operation",
    "solid",
    "csg",
    "host",
    "volume",
    "volume_arrays",
    "volume_file",
    "attribute",
    "attribute_host",
    "mesh_attribute",
    "channel",
    "channel_fill",
    "octree_channels",
    "scene",
    "op",
    "contains",
    "cursor",
    "point_cursor",
    "rays",
    "columns",
    "content",
    "cells",
    "bitmap",
    "voxel",
    "surface",
    "camera",
    "layer",
    "layer_surface",
    "layer_section",
    "picture",
    "lazy",
    "interference",
    "measure",
    "channel_summary",
    "distance",
    "tridexel",
    "tridexel_read",
    "tridexel_op",
    "tridexel_editor",
    "tridexel_arrays",
    "tridexel_surface",
    "file",
    "tridexel_file",
    "layout",
];

fn generated() -> String {
    let mut config = cbindgen::Config::from_file(root().join("include/cbindgen.toml")).unwrap();
    config.header = Some(std::fs::read_to_string(root().join("include/preface.h")).unwrap());
    let mut builder = cbindgen::Builder::new().with_config(config);
    for section in SECTIONS {
        builder = builder.with_src(root().join("capi/src").join(section).with_extension("rs"));
    }
    let mut header = Vec::new();
    builder.generate().unwrap().write(&mut header);
    String::from_utf8(header).unwrap()
}

#[test]
fn the_header_is_current() {
    let path = root().join("include/leafless.h");
    let generated = generated();
    if std::env::var_os("LEAFLESS_BLESS").is_some() {
        std::fs::write(&path, &generated).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        committed == generated,
        "include/leafless.h is not what capi/src says: LEAFLESS_BLESS=1 cargo test --test c_api generated"
    );
}

/// The header's functions with their doc blocks.
fn functions(header: &str) -> Vec<(&str, &str)> {
    let blocks = header.split("/**").skip(1).filter_map(|block| block.split_once("*/"));
    let functions = blocks.filter_map(|(doc, code)| {
        let declaration = code.trim_start().lines().next()?;
        let name = declaration.split_once('(')?.0.rsplit([' ', '*']).next()?;
        (name.starts_with("leafless_") && !declaration.starts_with("typedef")).then_some((name, doc))
    });
    functions.collect()
}

#[test]
fn every_doc_block_has_the_fixed_order() {
    let header = generated();
    let functions = functions(&header);
    for (name, doc) in &functions {
        let lines: Vec<&str> = doc.lines().filter_map(|line| line.trim_start().strip_prefix("* ")).collect();
        assert!(lines[0].ends_with(['.', ',']) || lines.len() > 8, "{name} has no purpose: {}", lines[0]);
        let heads: Vec<&str> =
            lines.iter().filter_map(|line| Some(line.strip_prefix("- ")?.split_once(':')?.0)).collect();
        let order = ["Buffers", "Result", "Errors", "Ownership", "Threads", "Untrusted input", "Since"];
        assert_eq!(heads, order, "{name}");
    }
    // The sources export just these.
    let sources: usize = SECTIONS
        .iter()
        .map(|section| {
            let path = root().join("capi/src").join(section).with_extension("rs");
            std::fs::read_to_string(path).unwrap().matches("#[unsafe(no_mangle)]").count()
        })
        .sum();
    assert_eq!(functions.len(), sources);
    let files = std::fs::read_dir(root().join("capi/src")).unwrap().count();
    // And `lib.rs`, which exports nothing itself.
    assert_eq!(files, SECTIONS.len() + 1);
}

/// What the library's lists name, the interface names: it cannot be compiled against them to the last.
#[test]
fn every_error_has_a_status() {
    let errors = std::fs::read_to_string(root().join("src/error.rs")).unwrap();
    let (_, list) = errors.split_once("pub enum Error {").unwrap();
    let (list, _) = list.split_once("\n}\n").unwrap();
    let names: Vec<&str> = list
        .lines()
        .filter_map(|line| line.strip_prefix("    "))
        .filter(|line| line.starts_with(|first: char| first.is_ascii_uppercase()))
        .map(|line| line.split(|end: char| !end.is_alphanumeric()).next().unwrap())
        .collect();
    assert!(names.len() > 15, "{names:?}");
    let boundary = std::fs::read_to_string(root().join("capi/src/boundary.rs")).unwrap();
    for name in names {
        let named = format!("Error::{name}");
        let is_named = boundary
            .match_indices(&named)
            .any(|(at, _)| !boundary[at + named.len()..].starts_with(|next: char| next.is_alphanumeric()));
        assert!(is_named, "capi/src/boundary.rs does not say which status {named} has");
    }
}
