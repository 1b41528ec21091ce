//! `include/leafless.h` matches `capi/src`. After a change of the interface,
//!
//! ```text
//! LEAFLESS_BLESS=1 cargo test --test c_api generated
//! ```
//!
//! writes the header anew. It begins with `include/preface.h`; its functions in C come from
//! `include/helpers.h`.

use crate::arrange::{Section, arranged};
use crate::cpp;
use crate::root;
use std::sync::OnceLock;

/// The section whose structs the functions in C fill.
const SOURCES: &str = "Sources and sinks";

/// The header's sections in the order of use, with the files of each.
const SECTIONS: &[Section] = &[
    Section { title: "Versions", files: &["version"] },
    Section { title: "Errors", files: &["status", "boundary"] },
    Section { title: "Options, cancelling, progress", files: &["control"] },
    Section { title: "Frames", files: &["frame"] },
    Section { title: SOURCES, files: &["source"] },
    Section { title: "Meshes", files: &["mesh", "mesh_arrays", "polyhedron", "mesh_moments"] },
    Section { title: "Mesh files", files: &["mesh_file", "mesh_write"] },
    Section { title: "Solids", files: &["operation", "solid", "csg"] },
    Section { title: "Solids by functions of the host", files: &["host"] },
    Section { title: "Volumes", files: &["volume", "volume_arrays", "volume_file"] },
    Section { title: "Scenes", files: &["scene"] },
    Section { title: "Octrees", files: &["metadata", "octree", "op"] },
    Section { title: "Extended octrees", files: &["extended"] },
    Section { title: "Shards: octrees in parts", files: &["shard"] },
    Section { title: "Points and boxes", files: &["contains", "point_cursor"] },
    Section { title: "Cells of octrees", files: &["cursor", "cells", "bitmap"] },
    Section { title: "Rays, columns, heights", files: &["rays", "columns"] },
    Section { title: "Volumes, areas, bounding boxes", files: &["content", "measure", "mass_sum"] },
    Section {
        title: "Distance and interference",
        files: &["distance", "interference", "clearance", "deviation"],
    },
    Section { title: "Layouts: solids in a container", files: &["bay", "placing", "layout_search"] },
    Section { title: "Octrees that are split on demand", files: &["lazy"] },
    Section { title: "Attributes", files: &["attribute", "attribute_host", "mesh_attribute"] },
    Section { title: "Channels", files: &["channel", "channel_fill", "channel_summary", "octree_channels"] },
    Section { title: "Voxel records", files: &["voxel"] },
    Section { title: "Surfaces", files: &["surface", "solid_boundary", "contour", "mesh_simplify"] },
    Section {
        title: "Tri-dexel models",
        files: &[
            "tridexel",
            "tridexel_arrays",
            "tridexel_read",
            "tridexel_op",
            "tridexel_editor",
            "tridexel_surface",
        ],
    },
    Section { title: "Files of octrees and tri-dexel models", files: &["file", "tridexel_file"] },
    Section { title: "Pictures", files: &["camera", "layer", "layer_surface", "layer_section", "picture"] },
];

fn source(file: &str) -> String {
    std::fs::read_to_string(root().join("capi/src").join(file).with_extension("rs")).unwrap()
}

/// Returns the generated header, made once because cbindgen takes seconds.
fn generated() -> &'static str {
    static HEADER: OnceLock<String> = OnceLock::new();
    HEADER.get_or_init(generate)
}

fn generate() -> String {
    let config = cbindgen::Config::from_file(root().join("include/cbindgen.toml")).unwrap();
    let mut builder = cbindgen::Builder::new().with_config(config);
    for file in SECTIONS.iter().flat_map(|section| section.files).chain(&["number"]) {
        builder = builder.with_src(root().join("capi/src").join(file).with_extension("rs"));
    }
    let mut raw = Vec::new();
    builder.generate().unwrap().write(&mut raw);
    let (mut sections, contents) = arranged(&String::from_utf8(raw).unwrap(), SECTIONS, source);
    let helpers = std::fs::read_to_string(root().join("include/helpers.h")).unwrap();
    let start = sections.find(&format!(". {SOURCES} -")).unwrap();
    let end = start + sections[start..].find("\n/* ---- ").unwrap();
    sections.insert_str(end, &format!("\n{helpers}"));
    let preface = std::fs::read_to_string(root().join("include/preface.h")).unwrap();
    let preface = preface.replace("@CONTENTS@", contents.trim_end());
    format!(
        "{preface}{sections}\n#ifdef __cplusplus\n}} /* extern \"C\" */\n#endif\n\n#endif /* LEAFLESS_H */\n"
    )
}

/// Returns the header for C++, made from the one for C.
fn generated_for_cpp() -> String {
    let read = |name: &str| std::fs::read_to_string(root().join(name)).unwrap();
    let classes = cpp::made_of(generated());
    format!("{}{classes}{}", read("include/preface.hpp"), read("include/epilogue.hpp"))
}

#[test]
fn the_headers_are_current() {
    is_current("include/leafless.h", generated());
    is_current("include/leafless.hpp", &generated_for_cpp());
}

fn is_current(name: &str, generated: &str) {
    let path = root().join(name);
    if std::env::var_os("LEAFLESS_BLESS").is_some() {
        std::fs::write(&path, generated).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        committed == generated,
        "{name} is not what capi/src says: LEAFLESS_BLESS=1 cargo test --test c_api generated"
    );
}

/// The header for C++ calls every function of the C interface.
#[test]
fn the_header_for_cpp_is_complete() {
    let (c, cpp) = (generated(), generated_for_cpp());
    for (name, _) in functions(c) {
        let own = ["leafless_last_status", "leafless_init"].contains(&name);
        let call = cpp.match_indices(name).any(|(at, _)| {
            let next = cpp[at + name.len()..].chars().next();
            next.is_some_and(|next| next == '(' || next == '>')
        });
        assert!(call || own, "include/leafless.hpp does not have {name}");
    }
}

/// Returns the header's functions with the lines of their comments.
fn functions(header: &str) -> Vec<(&str, Vec<&str>)> {
    let mut functions = Vec::new();
    let mut comment = Vec::new();
    for line in header.lines() {
        if let Some(text) = line.strip_prefix("///") {
            comment.push(text.trim());
            continue;
        }
        let name = line.split_once('(').and_then(|(before, _)| before.rsplit([' ', '*']).next());
        // Functions in C are not exported.
        let is_other = ["typedef", "LEAFLESS_ENUM", "#", " ", "static inline "]
            .iter()
            .any(|start| line.starts_with(start));
        if let Some(name) = name.filter(|name| name.starts_with("leafless_") && !is_other) {
            functions.push((name, std::mem::take(&mut comment)));
        }
        comment.clear();
    }
    functions
}

#[test]
fn every_comment_has_the_fixed_order() {
    let header = generated();
    let functions = functions(header);
    for (name, comment) in &functions {
        assert!(!comment.is_empty() && !comment[0].starts_with("- "), "{name} has no purpose: {comment:?}");
        let heads: Vec<&str> =
            comment.iter().filter_map(|line| Some(line.strip_prefix("- ")?.split_once(':')?.0)).collect();
        let order = ["Buffers", "Result", "Errors", "Ownership", "Threads", "Untrusted input", "Since"];
        let mut places = heads.iter().map(|head| order.iter().position(|known| known == head));
        let places: Option<Vec<usize>> = places.by_ref().collect();
        assert!(places.is_some_and(|places| places.is_sorted_by(|a, b| a < b)), "{name}: {heads:?}");
    }
    // The sources export exactly these.
    let files = || SECTIONS.iter().flat_map(|section| section.files);
    let exported = files().map(|file| source(file).matches("#[unsafe(no_mangle)]").count()).sum::<usize>();
    // `boundary` has a function for tests.
    assert_eq!(functions.len() + 1, exported);
    let sources = std::fs::read_dir(root().join("capi/src")).unwrap().count();
    // Three more: `lib.rs` and `number.rs`, which export nothing themselves, and `layout.rs`, which is for
    // tests.
    assert_eq!(sources, files().count() + 3);
}

#[test]
fn no_line_is_long() {
    for line in generated().lines() {
        assert!(line.chars().count() <= 110, "{line}");
    }
}

/// The interface names every error that the library's lists name. The compiler cannot check this completely.
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

/// The preface's rule for names: members begin with the name of their enumeration, and UNDECIDED is the same
/// number everywhere.
#[test]
fn members_of_enumerations_go_by_its_name() {
    let mut members = 0;
    for part in generated().split("\nLEAFLESS_ENUM(").skip(1) {
        let (name, rest) = part.split_once(',').unwrap();
        if name == "leafless_status" {
            continue;
        }
        let prefix = format!("{}_", name.to_uppercase());
        let (_, body) = rest.split_once("{\n").unwrap();
        for line in body.split_once("\n};").unwrap().0.lines().map(str::trim) {
            let Some((member, number)) = line.split_once(" = ") else { continue };
            if line.starts_with('/') {
                continue;
            }
            assert!(member.starts_with(&prefix), "{member} of {name}");
            if member.ends_with("_UNDECIDED") || member == "LEAFLESS_TAG_PARTIAL" {
                assert!(number.starts_with("2,"), "{line}");
            }
            members += 1;
        }
    }
    assert!(members > 150, "{members}");
}
