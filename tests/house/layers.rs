//! The order of the sources. In the kernel, a module uses only modules below it. In all crates, no two files
//! of a folder use each other, even through other files, and every file is a module.
//!
//! The sources are read as text. Comments and literals are taken out, and every path that begins with
//! `crate`, `super`, `self` or an imported name is resolved to a module of the crate.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The layers from the bottom up. Modules of one row may use each other.
const LAYERS: [&[&str]; 18] = [
    &["error", "memory", "lock", "parallel", "control", "dispatch"],
    &["lattice"],
    &["cut"],
    &["octree"],
    &["mesh"],
    &["dexel"],
    &["solid"],
    &["walk"],
    &["op"],
    &["query"],
    &["layout"],
    &["attribute"],
    &["voxel"],
    &["surface"],
    &["file"],
    &["exchange"],
    &["render"],
    &["scene"],
];

/// Modules of `solid` that its producers share. Every other module is a producer, and no other producer may
/// use it.
const SHARED: [&str; 10] = [
    "any",
    "contract",
    "fingerprint",
    "forward",
    "half_space",
    "motion",
    "prepared",
    "subtree",
    "surface_cell",
    "trace",
];

/// The folders of the kernel, the program, the Python package and the C interface.
const ROOTS: [&str; 4] = ["src", "cli/src", "python/src", "capi/src"];

fn layer(module: &str) -> Option<usize> {
    LAYERS.iter().position(|layer| layer.contains(&module))
}

#[derive(Debug, Clone, PartialEq)]
enum Token {
    Word(String),
    Mark(char),
}

/// Returns the words and marks of Rust source, without comments, strings and characters. `::` is the mark
/// ':'.
fn tokens(source: &str) -> Vec<Token> {
    let text: Vec<char> = source.chars().collect();
    let at = |i: usize| text.get(i).copied().unwrap_or('\0');
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let mut tokens = Vec::new();
    let mut i = 0;
    while i < text.len() {
        match text[i] {
            '/' if at(i + 1) == '/' => {
                while i < text.len() && text[i] != '\n' {
                    i += 1;
                }
            }
            '/' if at(i + 1) == '*' => {
                let mut depth = 0;
                loop {
                    match (at(i), at(i + 1)) {
                        ('/', '*') => (depth, i) = (depth + 1, i + 2),
                        ('*', '/') => (depth, i) = (depth - 1, i + 2),
                        _ => i += 1,
                    }
                    if depth == 0 || i >= text.len() {
                        break;
                    }
                }
            }
            '"' => i = after_string(&text, i),
            '\'' if at(i + 1) == '\\' => {
                i += 3;
                while i < text.len() && text[i] != '\'' {
                    i += 1;
                }
                i += 1;
            }
            '\'' if at(i + 2) == '\'' => i += 3,
            c if word(c) => {
                let start = i;
                while word(at(i)) {
                    i += 1;
                }
                let found: String = text[start..i].iter().collect();
                let prefix = matches!(found.as_str(), "r" | "b" | "br" | "c" | "cr");
                let raw = prefix && found.contains('r');
                if raw && at(i) == '#' && word(at(i + 1)) {
                    // A raw identifier: its name follows as a word.
                    i += 1;
                } else if raw && (at(i) == '"' || at(i) == '#') {
                    let mut hashes = 0;
                    while at(i) == '#' {
                        (hashes, i) = (hashes + 1, i + 1);
                    }
                    i += 1;
                    while i < text.len() && !(text[i] == '"' && (1..=hashes).all(|k| at(i + k) == '#')) {
                        i += 1;
                    }
                    i += 1 + hashes;
                } else if prefix && at(i) == '"' {
                    i = after_string(&text, i);
                } else {
                    tokens.push(Token::Word(found));
                }
            }
            ':' if at(i + 1) == ':' => {
                tokens.push(Token::Mark(':'));
                i += 2;
            }
            // A single colon is no path separator.
            ':' => {
                tokens.push(Token::Mark('.'));
                i += 1;
            }
            c => {
                if !c.is_whitespace() {
                    tokens.push(Token::Mark(c));
                }
                i += 1;
            }
        }
    }
    tokens
}

fn after_string(text: &[char], quote: usize) -> usize {
    let mut i = quote + 1;
    while i < text.len() && text[i] != '"' {
        i += if text[i] == '\\' { 2 } else { 1 };
    }
    i + 1
}

/// A path in a source, and the inline modules that contain it.
#[derive(Debug, PartialEq)]
struct Mention {
    inside: Vec<String>,
    path: Vec<String>,
    /// For a path in a `use` declaration, the name that the declaration gives it.
    import: Option<String>,
}

/// Returns all paths of two or more segments, and all imported paths, with `use` trees expanded.
fn mentions(source: &str) -> Vec<Mention> {
    let tokens = tokens(source);
    let mut found = Vec::new();
    let mut inside: Vec<(String, usize)> = Vec::new();
    let mut braces = 0;
    let mut i = 0;
    while i < tokens.len() {
        let names = || inside.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
        match &tokens[i] {
            Token::Mark('{') => braces += 1,
            Token::Mark('}') => {
                braces -= 1;
                if inside.last().is_some_and(|&(_, depth)| depth == braces) {
                    inside.pop();
                }
            }
            Token::Word(word) if word == "mod" => {
                if let (Some(Token::Word(name)), Some(Token::Mark('{'))) =
                    (tokens.get(i + 1), tokens.get(i + 2))
                {
                    inside.push((name.clone(), braces));
                    braces += 1;
                    i += 2;
                }
            }
            Token::Word(word) if word == "use" => {
                let mut paths = Vec::new();
                i = use_tree(&tokens, i + 1, Vec::new(), &mut paths);
                for (path, name) in paths {
                    found.push(Mention { inside: names(), path, import: Some(name) });
                }
                continue;
            }
            Token::Word(_) => {
                let mut path = Vec::new();
                while let Some(Token::Word(word)) = tokens.get(i) {
                    path.push(word.clone());
                    i += 1;
                    if tokens.get(i) != Some(&Token::Mark(':')) {
                        break;
                    }
                    i += 1;
                }
                // A single word, as in `pub(crate)`, is no path to a module.
                if path.len() > 1 {
                    found.push(Mention { inside: names(), path, import: None });
                }
                continue;
            }
            _ => {}
        }
        i += 1;
    }
    found
}

/// Reads the use tree at `i`, all of it below `prefix`; returns the index after it.
fn use_tree(
    tokens: &[Token],
    mut i: usize,
    mut prefix: Vec<String>,
    out: &mut Vec<(Vec<String>, String)>,
) -> usize {
    let push = |path: Vec<String>, name: Option<String>, out: &mut Vec<(Vec<String>, String)>| {
        let last = path.last().cloned().unwrap_or_default();
        let own = if last == "self" { path.iter().rev().nth(1).cloned() } else { None };
        let name = name.or(own).unwrap_or(last);
        out.push((path, name));
    };
    loop {
        match tokens.get(i) {
            Some(Token::Mark('{')) => {
                i += 1;
                loop {
                    match tokens.get(i) {
                        Some(Token::Mark('}')) => return i + 1,
                        Some(Token::Mark(',')) => i += 1,
                        Some(_) => i = use_tree(tokens, i, prefix.clone(), out),
                        None => return i,
                    }
                }
            }
            Some(Token::Mark(':')) => i += 1,
            Some(Token::Mark('*')) => {
                prefix.push("*".into());
                push(prefix, None, out);
                return i + 1;
            }
            Some(Token::Word(word)) if word == "as" => {
                let name = match tokens.get(i + 1) {
                    Some(Token::Word(name)) => name.clone(),
                    _ => String::new(),
                };
                push(prefix, Some(name), out);
                return i + 2;
            }
            Some(Token::Word(word)) => {
                prefix.push(word.clone());
                i += 1;
            }
            _ => {
                if !prefix.is_empty() {
                    push(prefix, None, out);
                }
                // The comma or brace belongs to the group; the semicolon ends the declaration.
                return i + (tokens.get(i) == Some(&Token::Mark(';'))) as usize;
            }
        }
    }
}

/// The sources of a crate by module path.
type Sources = BTreeMap<Vec<String>, String>;

/// Returns the absolute path that a mention refers to, if the path lies in this crate.
fn resolve(module: &[String], mention: &Mention) -> Option<Vec<String>> {
    let mut at: Vec<String> = module.iter().chain(&mention.inside).cloned().collect();
    let mut rest = mention.path.iter().peekable();
    match rest.peek()?.as_str() {
        "crate" => {
            rest.next();
            at.clear();
        }
        "self" => {
            rest.next();
        }
        "super" => {
            while rest.next_if(|word| *word == "super").is_some() {
                at.pop();
            }
        }
        _ => return None,
    }
    at.extend(rest.filter(|word| *word != "self").cloned());
    Some(at)
}

/// Returns the names that a folder's `mod.rs` re-exports, with the file or folder of each name.
fn origins(sources: &Sources, folder: &[String]) -> BTreeMap<String, String> {
    let Some(source) = sources.get(folder) else { return BTreeMap::new() };
    let imports = mentions(source).into_iter().filter_map(|mention| {
        let name = mention.import.clone()?;
        let path = match resolve(folder, &mention) {
            Some(path) => path,
            // `pub use callback::Callback` is relative to the module.
            None => folder.iter().chain(&mention.path).cloned().collect(),
        };
        let from =
            path.get(folder.len()).filter(|_| path.starts_with(folder) && path.len() > folder.len() + 1)?;
        Some((name, from.clone()))
    });
    imports.collect()
}

/// Returns the uses between the files and subfolders of each folder. A definition in a `mod.rs` belongs to
/// none of them, and tests may use everything.
fn uses(sources: &Sources) -> BTreeMap<Vec<String>, BTreeMap<String, BTreeSet<String>>> {
    let folders: BTreeSet<&[String]> =
        sources.keys().filter_map(|module| Some(module.split_last()?.1)).collect();
    let origins: BTreeMap<_, _> = folders.iter().map(|&folder| (folder, origins(sources, folder))).collect();
    let mut uses: BTreeMap<Vec<String>, BTreeMap<String, BTreeSet<String>>> = BTreeMap::new();
    for (module, source) in sources.iter().filter(|(module, _)| !is_test(module)) {
        let mentions = mentions(source);
        let mentions: Vec<_> = mentions.iter().filter(|mention| !is_test(&mention.inside)).collect();
        let imports: BTreeMap<&str, Vec<String>> = mentions
            .iter()
            .filter_map(|mention| Some((mention.import.as_deref()?, resolve(module, mention)?)))
            .collect();
        for mention in mentions {
            // After `use crate::solid`, `solid::mesh::grid()` is a use of `mesh`.
            let imported = || match mention.path.split_first() {
                Some((first, rest)) => Some([imports.get(&**first)?, rest].concat()),
                None => None,
            };
            let Some(target) = resolve(module, mention).or_else(imported) else { continue };
            let shared = module.iter().zip(&target).take_while(|(mine, theirs)| mine == theirs).count();
            let (folder, Some(mine)) = (&module[..shared], module.get(shared)) else { continue };
            let Some(theirs) = target.get(shared) else { continue };
            let theirs = origins.get(folder).and_then(|origins| origins.get(theirs)).unwrap_or(theirs);
            let is_file = sources.contains_key(&[folder, std::slice::from_ref(theirs)].concat());
            if is_file && theirs != mine {
                let used = uses.entry(folder.to_vec()).or_default().entry(mine.clone()).or_default();
                used.insert(theirs.clone());
            }
        }
    }
    uses
}

fn is_test(module: &[String]) -> bool {
    module.last().is_some_and(|name| name == "tests")
}

/// Returns each folder with the uses between files that lie on a circle.
fn circles(sources: &Sources) -> Vec<(String, Vec<String>)> {
    let mut found = Vec::new();
    for (folder, uses) in uses(sources) {
        let reaches = |from: &String, to: &String| {
            let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
            while let Some(file) = open.pop() {
                open.extend(uses.get(file).into_iter().flatten().filter(|&next| seen.insert(next)));
            }
            seen.contains(to)
        };
        let pairs = uses.iter().flat_map(|(file, used)| used.iter().map(move |other| (file, other)));
        let closed = pairs.filter(|(file, other)| reaches(other, file));
        let closed: Vec<String> = closed.map(|(file, other)| format!("{file} uses {other}")).collect();
        if !closed.is_empty() {
            found.push((folder.join("/"), closed));
        }
    }
    found
}

/// Returns everything in `sources` that breaks the order.
fn violations(sources: &Sources) -> Vec<String> {
    let origins = origins(sources, &path(&["solid"]));
    let mut found = Vec::new();
    for (module, source) in sources {
        let name = module.join("::");
        let Some(first) = module.first() else { continue };
        let Some(own) = layer(first) else {
            found.push(format!("{name}: has no layer"));
            continue;
        };
        for mention in mentions(source) {
            let said = mention.path.join("::");
            if said.starts_with("leafless::") {
                found.push(format!("{name}: {said} goes through the crate's public face"));
            }
            let Some(target) = resolve(module, &mention) else { continue };
            match target.first().map(|first| (first, layer(first))) {
                Some((_, Some(theirs))) if theirs > own => {
                    found.push(format!("{name}: {said} lies above"));
                }
                Some((_, Some(_))) => {}
                Some((_, None)) | None => {
                    found.push(format!("{name}: {said} goes through the crate's root"));
                }
            }
            // A producer must not use another producer, by any name.
            if first == "solid" && target.first() == Some(first) {
                let producer =
                    |name: &str| !SHARED.contains(&name) && sources.contains_key(&path(&["solid", name]));
                let Some(mine) = module.get(1).filter(|name| producer(name)) else { continue };
                let theirs = target.get(1).map(|name| origins.get(name).unwrap_or(name));
                if theirs.is_some_and(|theirs| theirs != mine && producer(theirs)) {
                    found.push(format!("{name}: {said} is another producer"));
                }
                if theirs.is_some_and(|theirs| theirs == "*") {
                    found.push(format!("{name}: {said} takes in every producer"));
                }
            }
        }
    }
    found
}

fn path(segments: &[&str]) -> Vec<String> {
    segments.iter().map(|segment| segment.to_string()).collect()
}

/// Returns the sources below a folder of the project. `lib.rs` is the module of the empty path. (A `main.rs`
/// beside it only calls the library.)
fn read(root: &str) -> Sources {
    fn read(folder: &Path, module: &[String], sources: &mut Sources) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let file = entry.unwrap().path();
            let stem = file.file_stem().unwrap().to_str().unwrap().to_string();
            let mut inner = module.to_vec();
            if file.is_dir() {
                inner.push(stem);
                read(&file, &inner, sources);
            } else if file.extension().is_some_and(|extension| extension == "rs") {
                if module.is_empty() && stem == "main" {
                    continue;
                }
                let is_root = module.is_empty() && stem == "lib";
                if stem != "mod" && !is_root {
                    inner.push(stem);
                }
                sources.insert(inner, std::fs::read_to_string(&file).unwrap());
            }
        }
    }
    let mut sources = Sources::new();
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(root), &[], &mut sources);
    assert!(sources.contains_key(&path(&[])), "{root} has no root");
    sources
}

/// Returns the files that no module declares, and that are therefore never compiled.
fn strays(sources: &Sources) -> Vec<String> {
    let declares = |module: &[String], name: &str| {
        let Some(source) = sources.get(module) else { return false };
        let tokens = tokens(source);
        tokens.windows(3).any(|three| {
            let words = [Token::Word("mod".into()), Token::Word(name.into()), Token::Mark(';')];
            three == words
        })
    };
    let modules =
        sources.keys().filter_map(|module| module.split_last().map(|(name, parent)| (parent, name)));
    let strays = modules.filter(|(parent, name)| !declares(parent, name));
    strays.map(|(parent, name)| [parent, std::slice::from_ref(name)].concat().join("/")).collect()
}

#[test]
fn the_order_is_kept() {
    let sources = read("src");
    for module in [&["octree", "view"][..], &["solid", "callback"], &["op"], &["control"]] {
        assert!(sources.contains_key(&path(module)), "{module:?} was not read");
    }
    // The checker finds uses that are known to exist.
    let build = mentions(&sources[&path(&["op", "build"])]);
    assert!(build.iter().any(|mention| mention.path == path(&["crate", "solid", "Subtree"])));
    assert!(origins(&sources, &path(&["solid"])).contains_key("Callback"));
    let found = violations(&sources);
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn no_files_use_each_other() {
    let found: Vec<_> = ROOTS.iter().map(|root| (root, circles(&read(root)))).collect();
    assert!(found.iter().all(|(_, circles)| circles.is_empty()), "{found:#?}");
}

#[test]
fn every_file_is_a_module() {
    let found: Vec<_> = ROOTS.iter().map(|root| (root, strays(&read(root)))).collect();
    assert!(found.iter().all(|(_, strays)| strays.is_empty()), "no module declares {found:#?}");
}

#[cfg(test)]
mod checker {
    use super::*;

    fn with(extra: &[(&[&str], &str)]) -> Vec<String> {
        let mut sources: Sources = BTreeMap::from([
            (
                path(&["solid"]),
                "mod ball; mod slab; mod motion; pub use ball::Ball; pub trait Solid {}".into(),
            ),
            (path(&["solid", "ball"]), "use super::motion::sign; use super::Solid;".into()),
            (path(&["solid", "slab"]), "use super::{Solid, motion};".into()),
            (path(&["solid", "motion"]), "use crate::lattice::Frame;".into()),
            (path(&["octree"]), "use crate::error::Error;".into()),
        ]);
        assert_eq!(violations(&sources), Vec::<String>::new());
        for (module, source) in extra {
            sources.insert(path(module), source.to_string());
        }
        violations(&sources)
    }

    #[test]
    fn catches_what_lies_above() {
        for source in [
            "use crate::op::build;",
            "use crate::{error::Error, op::build};",
            "use crate::{error::Error, op::{self, build}};",
            "fn f() { crate::op::build() }",
            "fn f() { let x: crate::op::X = 1; }",
            "use super::super::op::build;",
            "mod tests { use super::super::super::op::build; }",
            "pub(crate) use crate::op::build as innocent;",
            "fn f() -> Vec<crate::query::Region> { }",
            "const Q: char = '\"'; use crate::op::build; const R: char = '\"';",
            "fn f<'a>(x: &'a str) { crate::op::build() }",
            "use crate::r#op::build;",
        ] {
            let found = with(&[(&["octree", "view"], source)]);
            assert_eq!(found.len(), if source.contains("self,") { 2 } else { 1 }, "{source}: {found:?}");
            assert!(found[0].contains("lies above"), "{found:?}");
        }
    }

    #[test]
    fn catches_the_way_through_the_root() {
        for source in [
            "use crate::Frame;",
            "fn f() { crate::build() }",
            "use crate::{lattice::Cell, Cube};",
            "use crate::*;",
        ] {
            let found = with(&[(&["octree", "view"], source)]);
            assert!(found.len() == 1 && found[0].contains("root"), "{source}: {found:?}");
        }
        assert!(with(&[(&["octree", "view"], "use leafless::Frame;")])[0].contains("public face"));
    }

    #[test]
    fn catches_producers_that_know_each_other() {
        for source in [
            "use super::ball::Ball;",
            "use super::Ball;",
            "use crate::solid::Ball;",
            "use crate::solid::{Solid, Ball as Round};",
            "fn f() { super::ball::helper() }",
            "use super::*;",
        ] {
            let found = with(&[(&["solid", "slab"], source)]);
            assert_eq!(found.len(), 1, "{source}: {found:?}");
            // Folders are producers as a whole: their files may use each other.
            let deeper = source.replace("super::", "super::super::");
            let found = with(&[(&["solid", "mesh"], ""), (&["solid", "mesh", "scan"], &deeper)]);
            assert_eq!(found.len(), 1, "{deeper}: {found:?}");
        }
        assert!(
            with(&[(&["solid", "mesh"], ""), (&["solid", "mesh", "scan"], "use super::grid::Grid;")])
                .is_empty()
        );
    }

    #[test]
    fn catches_modules_without_a_layer() {
        assert_eq!(with(&[(&["surprise"], "")]), ["surprise: has no layer"]);
    }

    #[test]
    fn catches_circles() {
        let circles_with = |extra: &[(&[&str], &str)]| {
            let sources = extra.iter().map(|(module, source)| (path(module), source.to_string()));
            circles(&sources.collect())
        };
        let top: (&[&str], &str) = (&["solid"], "pub use ball::Ball; pub trait Solid {}");
        for (ball, slab) in [
            ("use super::slab::Slab;", "use super::ball::Ball;"),
            ("use super::slab::Slab;", "use super::Ball;"),
            ("fn f() { crate::solid::slab::g() }", "use super::{Solid, Ball};"),
        ] {
            let found = circles_with(&[top, (&["solid", "ball"], ball), (&["solid", "slab"], slab)]);
            let expected = ["ball uses slab", "slab uses ball"].map(String::from).to_vec();
            assert_eq!(found, [("solid".to_string(), expected)], "{ball} {slab}");
        }
        // A circle over three files, one of them in its own folder.
        let found = circles_with(&[
            top,
            (&["solid", "ball"], "use super::slab::Slab;"),
            (&["solid", "slab"], "use super::mesh::scan::Scan;"),
            (&["solid", "mesh"], "mod scan;"),
            (&["solid", "mesh", "scan"], "use crate::solid::Ball;"),
        ]);
        assert_eq!(found[0].1, ["ball uses slab", "mesh uses ball", "slab uses mesh"]);
        // A circle of files beside the root, one of which is named by a re-export of the root.
        let found = circles_with(&[
            (&[], "mod ball; mod slab; use ball::Ball;"),
            (&["ball"], "use crate::slab::Slab;"),
            (&["slab"], "use crate::Ball;"),
        ]);
        assert_eq!(found[0].1, ["ball uses slab", "slab uses ball"]);
        // A use through the name of the folder.
        let found = circles_with(&[
            (&["solid"], "mod ball; mod slab;"),
            (&["solid", "ball"], "use crate::solid; fn f() { solid::slab::g() }"),
            (&["solid", "slab"], "use super::ball::Ball;"),
        ]);
        assert_eq!(found[0].1, ["ball uses slab", "slab uses ball"]);
        // Parents and children, tests, and uses in one direction.
        let found = circles_with(&[
            top,
            (&["solid", "ball"], "use super::Solid; mod tests { use super::super::slab::Slab; }"),
            (&["solid", "slab"], "use super::{Ball, Solid};"),
        ]);
        assert!(found.is_empty(), "{found:?}");
    }

    #[test]
    fn catches_files_that_are_no_modules() {
        let crates =
            [(&["ball"][..], ""), (&["solid"], "pub mod slab; // mod mesh;"), (&["solid", "slab"], "")];
        let mut sources: Sources =
            crates.into_iter().map(|(module, source)| (path(module), source.into())).collect();
        sources.insert(path(&[]), "mod ball; #[cfg(test)] mod solid;".into());
        assert_eq!(strays(&sources), Vec::<String>::new());
        sources.insert(path(&["solid", "mesh"]), String::new());
        sources.insert(path(&["ball", "deep"]), String::new());
        sources.insert(path(&["forgotten", "deep"]), String::new());
        assert_eq!(strays(&sources), ["ball/deep", "forgotten/deep", "solid/mesh"]);
    }

    #[test]
    fn is_not_misled() {
        for source in [
            "// use crate::op::build;",
            "/* a /* nested */ use crate::op::build; */",
            "/// [`crate::op::build`]\nfn f() {}",
            "const S: &str = \"use crate::op::build;\";",
            "const S: &str = \"\\\"crate::op::build\";",
            "const S: &str = r#\"\" crate::op::build\"#;",
            "pub(crate) fn f() {}",
            "use crate::lattice::{self, Cell};",
            "use super::tag::Tag; use alloc::vec::Vec; use core::ops::Range;",
            "#[cfg(test)] mod tests { use super::*; use super::super::tag::Tag; }",
            "fn op() { op::build() }",
        ] {
            assert_eq!(with(&[(&["octree", "view"], source)]), Vec::<String>::new(), "{source}");
        }
    }
}
