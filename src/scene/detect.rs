//! Detection of scenes among texts.

use super::grammar::first_call;

/// Calls of the language, and those that are refused by name.
const CALLS: [&str; 36] = [
    "group",
    "union",
    "color",
    "render",
    "intersection",
    "difference",
    "multmatrix",
    "translate",
    "rotate",
    "scale",
    "mirror",
    "cube",
    "sphere",
    "cylinder",
    "polyhedron",
    "square",
    "circle",
    "polygon",
    "linear_extrude",
    "rotate_extrude",
    "halfspace",
    "quadric",
    "power",
    "torus",
    "mesh",
    "import",
    "octree",
    "hull",
    "minkowski",
    "text",
    "projection",
    "offset",
    "resize",
    "surface",
    "roof",
    "fill",
];

/// Returns whether a file with these bytes looks like a scene: after blanks, comments and modifiers, it
/// begins with a call of the language. (An empty scene is not recognised.) O(blanks and comments at the
/// beginning).
pub fn is_scene(bytes: &[u8]) -> bool {
    let text = match core::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => core::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default(),
    };
    first_call(text).is_some_and(|name| CALLS.contains(&name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::format;
    use alloc::string::ToString;

    #[test]
    fn every_call_is_one_of_the_language() {
        for name in CALLS {
            assert!(is_scene(format!("{name}();").as_bytes()), "{name}");
            let refused = super::super::read_scene(format!("{name}(1);"), None).err();
            let message = refused.map_or_else(Default::default, |error| error.to_string());
            assert!(!message.contains("no such call") && !message.contains("unknown"), "{message}");
        }
    }

    #[test]
    fn scenes_are_told_from_other_texts() {
        for scene in
            ["cube();", " \n\t/* x */ // y\n %*# sphere (", "\u{FEFF}mesh(\"a\")", "group(){\u{FFFD}"]
        {
            assert!(is_scene(scene.as_bytes()), "{scene}");
        }
        for other in [
            "",
            "cube",
            "cube;",
            "solid cube(1)",
            "# cube ()\nv 1 2 3",
            "v 1 2 3",
            "cubes()",
            "(",
            "\u{FFFD}cube()",
        ] {
            assert_eq!(is_scene(other.as_bytes()), other.starts_with("# cube"), "{other}");
        }
        assert!(is_scene(b"group() { \xFF") && !is_scene(b"\xFFgroup()"));
    }
}
