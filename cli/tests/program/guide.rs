//! The README and the guide in `docs`: commands are run, links lead somewhere, and the pictures are those
//! that the program makes.
//!
//! `LEAFLESS_BLESS=1 cargo test --test program guide::` writes what the program answers into the pages, and
//! its pictures into `docs/pictures`.
//!
//! A page is a folder of its own, in which its blocks act one after the other:
//!
//! - `console`: lines that begin with `$ ` are run by a shell, with the lines after them that begin with
//!   `> `. The other lines are what the shell prints.
//! - `openscad`: a line `// name.csg` begins a file of that name.
//! - `<!-- $ command -->`, a comment of one line: a command that is run and not shown.
//!
//! Blocks in Rust are run by `cargo test --doc`, in C and C++ by `--test c_api guide`, in Python by
//! `pytest python`. A block in `sh` sets something up, and is one of a short list.

use crate::pictures;
use crate::place::{Place, without_progress};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn text(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn blessing() -> bool {
    std::env::var_os("LEAFLESS_BLESS").is_some()
}

/// The names of the pages below `docs`, in the order of the book.
fn pages() -> Vec<String> {
    let summary = text("docs/SUMMARY.md");
    let targets = links(&summary).into_iter().map(|target| format!("docs/{target}"));
    targets.collect()
}

/// The targets of all links and pictures of a page, outside of its blocks of code.
fn links(page: &str) -> Vec<String> {
    let mut targets = Vec::new();
    for line in prose(page) {
        // Code between backticks has no links.
        let line: String = line.split('`').step_by(2).collect::<Vec<_>>().join("`");
        let mut rest = line.as_str();
        while let Some((_, after)) = rest.split_once("](") {
            let (target, after) =
                after.split_once(')').unwrap_or_else(|| panic!("a link without its end: {line}"));
            targets.push(target.split(' ').next().unwrap().to_owned());
            rest = after;
        }
    }
    targets
}

/// The lines outside of blocks of code.
fn prose(page: &str) -> Vec<&str> {
    let mut within = false;
    let outside = |line: &&str| {
        let fence = line.trim_start().starts_with("```");
        within ^= fence;
        !within && !fence
    };
    page.lines().filter(outside).collect()
}

/// The languages of the blocks of code, with their texts.
fn blocks(page: &str) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = Vec::new();
    let mut within = false;
    for line in page.lines() {
        if let Some(language) = line.strip_prefix("```") {
            within = !within;
            if within {
                found.push((language.to_owned(), String::new()));
            }
        } else if within {
            let (_, text) = found.last_mut().unwrap();
            *text += line;
            *text += "\n";
        }
    }
    found
}

/// A page in a folder of its own.
struct Shell {
    place: Place,
    folder: PathBuf,
    code: i32,
}

impl Shell {
    fn new() -> Shell {
        let place = Place::new();
        let folder = place.0.path().to_owned();
        Shell { place, folder, code: 0 }
    }

    /// What a command prints, in the order in which it is printed.
    fn run(&mut self, command: &str) -> String {
        if let Some(name) = command.strip_prefix("cd ") {
            self.folder.push(name);
            return String::new();
        }
        let program = Path::new(env!("CARGO_BIN_EXE_leafless")).parent().unwrap();
        let paths = std::env::var_os("PATH").unwrap_or_default();
        let paths = std::iter::once(program.to_owned()).chain(std::env::split_paths(&paths));
        // The exit code of the last command is what `$?` stands for.
        let line = format!("exec 2>&1\n(exit {})\n{command}", self.code);
        let output = Command::new("sh")
            .args(["-c", &line])
            .current_dir(&self.folder)
            .env("PATH", std::env::join_paths(paths).unwrap())
            .stdin(Stdio::null())
            .output()
            .unwrap();
        self.code = output.status.code().unwrap();
        without_progress(&String::from_utf8(output.stdout).unwrap())
    }

    /// Writes the files of a block of scenes.
    fn write_scenes(&self, block: &str) {
        let mut files = block.split("// ").skip(1).map(|file| file.split_once('\n').unwrap()).peekable();
        assert!(
            files.peek().is_some_and(|(name, _)| name.ends_with(".csg")),
            "a scene without a name:\n{block}"
        );
        for (name, scene) in files {
            std::fs::write(self.folder.join(name), scene).unwrap();
        }
    }
}

/// An answer without the times that it tells.
fn timeless(text: &str) -> String {
    let line = |line: &str| {
        let mut words: Vec<&str> = line.split_whitespace().collect();
        for at in 1..words.len() {
            if ["s", "ms", "µs", "ns"].contains(&words[at].trim_end_matches([',', ';', ':', '.'])) {
                words[at - 1] = "…";
                words[at] = "s";
            }
        }
        words.join(" ")
    };
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

/// Runs the commands of a page, and compares what they answer, or writes it into the page.
fn run(path: &str) -> usize {
    let page = text(path);
    let mut shell = Shell::new();
    let (mut written, mut commands, mut failures) = (String::new(), 0, String::new());
    let mut lines = page.lines().peekable();
    let (mut language, mut scene) = (None, String::new());
    while let Some(line) = lines.next() {
        written += &format!("{line}\n");
        if let Some(name) = line.strip_prefix("```") {
            if language.take() == Some("openscad") {
                shell.write_scenes(&std::mem::take(&mut scene));
            } else if !name.is_empty() {
                language = Some(name);
            }
            continue;
        }
        if let Some(command) = line.strip_prefix("<!-- $ ").and_then(|rest| rest.strip_suffix(" -->")) {
            let told = shell.run(command);
            if shell.code != 0 {
                failures += &format!("{path}: {command}: exit code {}\n{told}\n", shell.code);
            }
            continue;
        }
        match language {
            Some("openscad") => scene += &format!("{line}\n"),
            Some("console") => {
                let mut command = line
                    .strip_prefix("$ ")
                    .unwrap_or_else(|| panic!("{path}: {line}: no command"))
                    .to_owned();
                while command.ends_with('\\') || lines.peek().is_some_and(|line| line.starts_with("> ")) {
                    let next = lines.next().unwrap();
                    written += &format!("{next}\n");
                    command = match next.strip_prefix("> ") {
                        Some(next) => format!("{command}\n{next}"),
                        None => format!("{}{}", command.trim_end_matches('\\'), next.trim_start()),
                    };
                }
                let mut expected = String::new();
                while let Some(answer) =
                    lines.next_if(|line| !line.starts_with("$ ") && !line.starts_with("```"))
                {
                    expected += &format!("{answer}\n");
                }
                let told = shell.run(&command);
                if !blessing() && timeless(&told) != timeless(&expected) {
                    failures += &format!("{path}: {command}\nfound:\n{told}expected:\n{expected}\n");
                }
                written += &told;
                commands += 1;
            }
            _ => {}
        }
    }
    assert!(failures.is_empty(), "{failures}");
    if blessing() && written != page {
        std::fs::write(root().join(path), written).unwrap();
    }
    for picture in
        links(&page).iter().filter_map(|target| target.split_once("pictures/")).map(|(_, name)| name)
    {
        let made = shell.folder.join(picture);
        if made.exists() {
            pictures::check(picture, &std::fs::read(made).unwrap());
        }
    }
    drop(shell.place);
    commands
}

macro_rules! pages {
    ($($test:ident: $path:literal,)*) => {
        const RUN: &[&str] = &[$($path),*];
        $(
            #[test]
            #[cfg(unix)]
            fn $test() {
                let commands = run($path);
                assert_eq!(commands > 0, text($path).contains("\n```console\n"));
            }
        )*
    };
}

pages! {
    readme: "README.md",
    introduction: "docs/introduction.md",
    printable: "docs/questions/printable.md",
    weight: "docs/questions/weight.md",
    cut: "docs/questions/cut.md",
    revisions: "docs/questions/revisions.md",
    fit: "docs/questions/fit.md",
    cad: "docs/questions/cad.md",
    section: "docs/questions/section.md",
    ct: "docs/questions/ct.md",
    slices: "docs/questions/slices.md",
    materials: "docs/questions/materials.md",
    cells: "docs/cells.md",
    meshes_in: "docs/meshes-in.md",
    half_spaces: "docs/half-spaces.md",
    extended: "docs/extended.md",
    fits: "docs/fits.md",
    meshes_out: "docs/meshes-out.md",
    attributes: "docs/attributes.md",
    tri_dexels: "docs/tri-dexels.md",
    pictures: "docs/pictures.md",
    files: "docs/files.md",
    layout: "docs/layout.md",
    command_line: "docs/command-line.md",
}

/// Every page is in the book, and is run if something in it can be.
#[test]
fn all_pages_are_run() {
    let pages = pages();
    let mut files = BTreeSet::new();
    for folder in ["docs", "docs/questions"] {
        for entry in std::fs::read_dir(root().join(folder)).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            if name.ends_with(".md") && name != "SUMMARY.md" {
                files.insert(format!("{folder}/{name}"));
            }
        }
    }
    assert_eq!(files, pages.iter().cloned().collect::<BTreeSet<_>>(), "docs/SUMMARY.md has other pages");
    for page in pages.iter().filter(|page| text(page).contains("```console\n")) {
        assert!(RUN.contains(&page.as_str()), "{page} is not run");
    }
}

/// Commands in `sh` blocks: they set something up, and are run by nobody but CI.
const SET_UP: [&str; 6] = [
    "cargo run --release -- demo",
    "cargo test",
    "cargo install --path cli",
    "pip install ./python",
    "pip install \"./python[test]\" && pytest python",
    "cargo add leafless --path path/to/leafless",
];

/// Each block of code is run by somebody.
#[test]
fn all_blocks_are_run() {
    let library = text("src/lib.rs");
    for page in pages().into_iter().chain(["README.md".to_owned()]) {
        let (code, name) = (text(&page), page.as_str());
        for (language, block) in blocks(&code) {
            match language.as_str() {
                "console" | "openscad" => assert!(RUN.contains(&name), "{page} is not run"),
                // `src/lib.rs` has the pages whose blocks are examples of the documentation.
                "rust" => assert!(library.contains(&format!("include_str!(\"../{page}\")")), "{page}: Rust"),
                // These find their pages themselves.
                "c" | "cpp" | "python" => {}
                "sh" => {
                    for line in block.lines().map(|line| line.split(" # ").next().unwrap().trim()) {
                        assert!(SET_UP.contains(&line), "{page}: {line}: who runs that?");
                    }
                }
                "text" | "toml" | "cmake" => {}
                other => panic!("{page}: a block in {other:?}"),
            }
        }
    }
}

/// The anchor of a heading, as it is made for pages on the web.
fn anchor(heading: &str) -> String {
    let plain = heading.trim_start_matches('#').trim().to_lowercase();
    let kept = plain.chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// All pages of the repository, but for those of other people.
fn all_pages(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let (path, name) = (entry.path(), entry.file_name().into_string().unwrap());
        if entry.file_type().unwrap().is_dir() {
            let theirs = ["target", "book", "site-packages", "node_modules"].contains(&name.as_str());
            if !theirs && !name.starts_with('.') {
                all_pages(&path, found);
            }
        } else if name.ends_with(".md") && !path.ends_with("format_spec/vectors.md") {
            // (That one is the beginning of a page in another folder.)
            found.push(path);
        }
    }
}

#[test]
fn links_lead_somewhere() {
    let root = root().canonicalize().unwrap();
    let mut found = Vec::new();
    all_pages(&root, &mut found);
    let mut anchors: BTreeMap<PathBuf, BTreeSet<String>> = BTreeMap::new();
    let mut count = 0;
    for path in found {
        let page = std::fs::read_to_string(&path).unwrap();
        for target in links(&page) {
            let at = format!("{}: {target}", path.display());
            count += 1;
            if target.contains("://") {
                assert!(target.starts_with("https://"), "{at}");
                continue;
            }
            let (file, fragment) = target.split_once('#').unwrap_or((&target, ""));
            let file = if file.is_empty() { path.clone() } else { path.parent().unwrap().join(file) };
            let file = file.canonicalize().unwrap_or_else(|error| panic!("{at}: {error}"));
            assert!(file.starts_with(&root), "{at}: outside of the repository");
            // The book has pages of its own only; of all else it has the files.
            let docs = root.join("docs");
            if path.starts_with(&docs) && !file.starts_with(&docs) {
                assert!(
                    file.extension().is_none_or(|ending| ending != "md"),
                    "{at}: a page that is not in the book"
                );
            }
            if !fragment.is_empty() && file.extension().is_some_and(|ending| ending == "md") {
                let known = anchors.entry(file.clone()).or_insert_with(|| {
                    let page = std::fs::read_to_string(&file).unwrap();
                    prose(&page).into_iter().filter(|line| line.starts_with('#')).map(anchor).collect()
                });
                assert!(known.contains(fragment), "{at}: there is no such heading");
            }
        }
    }
    assert!(count > 200, "{count}");
}

/// Each picture is on a page, and is made by its page or by the tests of `pictures`.
#[test]
fn all_pictures_are_shown_and_made() {
    let mut shown: BTreeMap<String, String> = BTreeMap::new();
    for page in pages().into_iter().chain(["README.md".to_owned()]) {
        let text = text(&page);
        for (_, name) in links(&text).iter().filter_map(|target| target.split_once("pictures/")) {
            if !target_is_svg(name) {
                let made = text.contains(&format!("-o {name}")) || text.contains(&format!(" {name} -->"));
                let entry = shown.entry(name.to_owned()).or_default();
                if made {
                    *entry = page.clone();
                }
            }
        }
    }
    let elsewhere = include_str!("pictures.rs");
    for (picture, page) in &shown {
        let stem = picture.strip_suffix(".png").unwrap();
        let words = [format!("\"{picture}\""), format!("\"{}\"", stem.rsplit('-').next().unwrap())];
        assert!(
            !page.is_empty() || words.iter().any(|word| elsewhere.contains(word)),
            "{picture}: who makes it?"
        );
    }
    let files = std::fs::read_dir(root().join("docs/pictures")).unwrap();
    let files: BTreeSet<String> =
        files.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(files, shown.into_keys().collect::<BTreeSet<_>>());
}

fn target_is_svg(name: &str) -> bool {
    name.ends_with(".svg")
}

/// The README stays short.
#[test]
fn the_readme_is_read_in_two_minutes() {
    let lines = text("README.md").lines().count();
    assert!(lines <= 200, "{lines} lines");
}
