//! Prose: lines of comments and pages stay within their width, and habits that make sentences hard to read do
//! not come back.

use std::path::{Path, PathBuf};

/// Columns of a line in a source, and of a line on a page.
const WIDTHS: [usize; 2] = [110, 120];

/// All files of the project with these endings, but for those that programs make.
fn files(endings: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap().map(Result::unwrap) {
            let (path, name) = (entry.path(), entry.file_name().into_string().unwrap());
            if entry.file_type().unwrap().is_dir() {
                let made = ["target", "book", "corpus", "vectors", "node_modules"].contains(&name.as_str());
                if !made && !name.starts_with('.') {
                    folders.push(path);
                }
            } else if endings.iter().any(|ending| name.ends_with(ending)) {
                found.push(path);
            }
        }
    }
    found
}

/// The lines of comments of a source, with their numbers; doc examples are left out.
fn comments(text: &str) -> Vec<(usize, &str)> {
    let mut is_code = false;
    let lines = text.lines().enumerate().filter_map(|(at, line)| {
        let comment = line.trim_start().strip_prefix("//")?;
        let text = comment.trim_start_matches(['/', '!']);
        is_code ^= text.trim_start().starts_with("```");
        (!is_code).then_some((at + 1, text))
    });
    lines.collect()
}

/// The lines of a page outside of its blocks of code, with their numbers.
fn page_lines(text: &str) -> Vec<(usize, &str)> {
    let mut is_code = false;
    let lines = text.lines().enumerate().filter_map(|(at, line)| {
        is_code ^= line.trim_start().starts_with("```");
        (!is_code).then_some((at + 1, line))
    });
    lines.collect()
}

/// Whether a line is a row of a table, a picture or a link that has no other place.
fn has_no_breaks(line: &str) -> bool {
    let line = line.trim_start();
    line.starts_with('|') || line.starts_with("<!--") || !line.trim().contains(' ') || line.contains("](http")
}

#[test]
fn lines_stay_within_the_width() {
    let mut wide = String::new();
    for path in files(&[".rs", ".md"]) {
        let text = std::fs::read_to_string(&path).unwrap();
        let is_page = path.extension().is_some_and(|ending| ending == "md");
        let (lines, width) =
            if is_page { (page_lines(&text), WIDTHS[1]) } else { (comments(&text), WIDTHS[0]) };
        for (at, line) in lines {
            let whole = text.lines().nth(at - 1).unwrap();
            if whole.chars().count() > width && !has_no_breaks(line) {
                wide += &format!("{}:{at}: {whole}\n", path.display());
            }
        }
    }
    assert!(wide.is_empty(), "lines that are too wide:\n{wide}");
}

/// The habits: a sentence that begins with *Of*, and *whoever*.
fn habit(line: &str) -> Option<&'static str> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let fronted = words.iter().enumerate().any(|(at, word)| {
        let begins = at == 0 || words[at - 1].ends_with(['.', ':', '!', '?']);
        *word == "Of" && begins
    });
    if fronted {
        return Some("a sentence begins with \"Of\"");
    }
    line.to_lowercase().contains("whoever").then_some("\"whoever\"")
}

#[test]
fn sentences_begin_with_their_subject() {
    let mut found = String::new();
    for path in files(&[".rs", ".md"]) {
        let text = std::fs::read_to_string(&path).unwrap();
        let is_page = path.extension().is_some_and(|ending| ending == "md");
        let lines = if is_page { page_lines(&text) } else { comments(&text) };
        for (at, line) in lines {
            if path.ends_with("house/prose.rs") {
                continue;
            }
            if let Some(habit) = habit(line) {
                found += &format!("{}:{at}: {habit}: {line}\n", path.display());
            }
        }
    }
    assert!(found.is_empty(), "{found}");
}

#[test]
fn habits_are_found() {
    for line in ["Of a mesh, all.", " It is. Of those, one.", "told to whoever asks"] {
        assert!(habit(line).is_some(), "{line}");
    }
    for line in ["One of them.", "Out Of Memory", "the union of all"] {
        assert!(habit(line).is_none(), "{line}");
    }
}
