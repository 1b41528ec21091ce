//! Arranges the header. cbindgen writes all types before all functions; readers want sections.
//!
//! A section is made of files of `capi/src`. Its declarations stand in the order of these files, so that a
//! type comes before the functions that take it. Comments are wrapped, short ones stand behind the line that
//! they explain, and parameters fill their lines.

use std::fmt::Write;

/// Columns of a line.
const WIDTH: usize = 110;

/// Prefixes of the types of numbers, of 32 and of 8 bits, that stand for members of an enumeration. In the
/// header they are the enumeration.
const NUMBERS: [&str; 2] = ["Number_", "Byte_"];

/// A part of the header.
pub struct Section {
    pub title: &'static str,
    /// The files of `capi/src` that make up the section, without `.rs`.
    pub files: &'static [&'static str],
}

/// A declaration of the header.
struct Item {
    name: String,
    /// The lines of its comment, without `///`.
    doc: Vec<String>,
    /// Its lines of C.
    code: Vec<String>,
}

impl Item {
    /// True if the item is an object known only by pointers.
    fn is_handle(&self) -> bool {
        self.code[0].starts_with("typedef struct ") && self.code[0].ends_with(';')
    }
}

/// Splits the output of `cbindgen` into blocks between empty lines, without items that only tests have.
fn items(raw: &str) -> Vec<Item> {
    let mut items = Vec::new();
    for block in raw.split("\n\n") {
        let lines: Vec<&str> = block.lines().filter(|line| !line.trim().is_empty()).collect();
        if lines.first().is_none_or(|first| first.starts_with("#if defined(LEAFLESS_TEST)")) {
            continue;
        }
        let is_doc = |line: &&&str| line.starts_with("///");
        let doc = lines.iter().take_while(is_doc).map(|line| comment_text(line)).collect();
        let code: Vec<String> = lines.iter().skip_while(is_doc).map(|line| line.to_string()).collect();
        assert!(!code.is_empty(), "a comment without a declaration: {block}");
        let is_number = |name| {
            ["uint32_t", "uint8_t"]
                .iter()
                .any(|integer| code[0].starts_with(&format!("typedef {integer} {name}")))
        };
        if !NUMBERS.iter().any(is_number) {
            items.push(Item { name: name_of(&code), doc, code });
        }
    }
    items
}

/// Returns a comment line's text without the comment marks.
fn comment_text(line: &str) -> String {
    let text = line.trim_start().strip_prefix("///").expect("a comment");
    text.strip_prefix(' ').unwrap_or(text).to_string()
}

/// Returns the name that a declaration declares.
fn name_of(code: &[String]) -> String {
    let first = code[0].as_str();
    let word = |text: &str| {
        let text = text.trim_start();
        text.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or_default().to_string()
    };
    if let Some(rest) = first.strip_prefix("#define ") {
        return word(rest);
    }
    if let Some(rest) = first.strip_prefix("enum ").or_else(|| first.strip_prefix("typedef struct ")) {
        return word(rest);
    }
    let (before, after) = first.split_once('(').unwrap_or_else(|| panic!("a declaration: {code:?}"));
    if let Some(function_type) = after.strip_prefix('*') {
        return word(function_type);
    }
    before.rsplit([' ', '*']).next().unwrap_or_default().to_string()
}

/// Wraps a paragraph or a list entry to the width.
fn wrapped(doc: &[String], indent: &str, out: &mut String) {
    let mut paragraphs: Vec<String> = Vec::new();
    let mut joins = false;
    for line in doc {
        let text = line.trim();
        if text.is_empty() {
            joins = false;
            paragraphs.push(String::new());
        } else if joins && !text.starts_with("- ") {
            let last = paragraphs.last_mut().expect("a paragraph to join");
            last.push(' ');
            last.push_str(text);
        } else {
            paragraphs.push(text.to_string());
            joins = true;
        }
    }
    while paragraphs.last().is_some_and(String::is_empty) {
        paragraphs.pop();
    }
    for paragraph in paragraphs {
        let hanging = if paragraph.starts_with("- ") { "  " } else { "" };
        let mut line = format!("{indent}///");
        for word in paragraph.split(' ') {
            if line.chars().count() + 1 + word.chars().count() > WIDTH {
                out.push_str(&line);
                out.push('\n');
                line = format!("{indent}///{}{hanging}", if hanging.is_empty() { "" } else { " " });
                if !hanging.is_empty() {
                    line.pop();
                }
            }
            line.push(' ');
            line.push_str(word);
        }
        out.push_str(line.trim_end());
        out.push('\n');
    }
}

/// Writes the lines between braces: fields or enumerators, each with its comment.
fn body(lines: &[String], out: &mut String) {
    let mut doc: Vec<String> = Vec::new();
    for line in lines {
        if line.trim_start().starts_with("///") {
            doc.push(comment_text(line));
            continue;
        }
        let code = plain(line.trim());
        let short = doc.join(" ");
        let on_one_line = format!("    {code}  ///< {short}");
        if !doc.is_empty() && !doc.iter().any(String::is_empty) && on_one_line.chars().count() <= WIDTH {
            writeln!(out, "{on_one_line}").expect("memory");
        } else {
            wrapped(&doc, "    ", out);
            writeln!(out, "    {code}").expect("memory");
        }
        doc.clear();
    }
}

/// Returns code that names structs by their typedefs, and numbers by their enumerations.
fn plain(code: &str) -> String {
    let code = NUMBERS.iter().fold(code.to_string(), |code, number| code.replace(number, ""));
    if code.starts_with("typedef struct ") { code } else { code.replace("struct leafless_", "leafless_") }
}

/// Writes a declaration whose parameters fill their lines.
fn filled(code: &[String], out: &mut String) {
    let text = code.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ").replace("( ", "(");
    let text = plain(&text);
    let mut line = String::new();
    for word in text.split_inclusive(", ") {
        if !line.is_empty() && line.chars().count() + word.trim_end().chars().count() > WIDTH {
            writeln!(out, "{}", line.trim_end()).expect("memory");
            line = "    ".to_string();
        }
        line.push_str(word);
    }
    writeln!(out, "{line}").expect("memory");
}

fn declare(item: &Item, out: &mut String) {
    let first = item.code[0].as_str();
    wrapped(&item.doc, "", out);
    if first.starts_with("enum ") {
        // `enum name {`, enumerators, `};`, `typedef type name;`
        let last = item.code.len() - 1;
        let kind = item.code[last].split_whitespace().nth(1).expect("the type of an enumeration");
        writeln!(out, "LEAFLESS_ENUM({}, {kind}) {{", item.name).expect("memory");
        body(&item.code[1..last - 1], out);
        out.push_str("};\n");
    } else if first.starts_with("typedef struct ") && first.ends_with('{') {
        let last = item.code.len() - 1;
        writeln!(out, "{first}").expect("memory");
        body(&item.code[1..last], out);
        writeln!(out, "{}", item.code[last]).expect("memory");
    } else if first.starts_with('#') {
        out.push_str(&item.code.join("\n"));
        out.push('\n');
    } else {
        filled(&item.code, out);
    }
}

/// Returns the place in a source file where a name is defined.
fn defined_at(source: &str, name: &str) -> Option<usize> {
    ["enum", "struct", "fn", "const", "type"].iter().find_map(|kind| {
        let definition = format!("{kind} {name}");
        source.match_indices(&definition).find_map(|(at, _)| {
            let next = source[at + definition.len()..].chars().next()?;
            let is_name = next.is_alphanumeric() || next == '_';
            (!is_name && (*kind == "fn" || source[..at].ends_with("pub "))).then_some(at)
        })
    })
}

/// Returns the declarations of `raw` in sections, and the list of the sections. `read` returns the text of a
/// file of `capi/src`.
pub fn arranged(raw: &str, sections: &[Section], read: impl Fn(&str) -> String) -> (String, String) {
    let mut items = items(raw);
    // Each item with its section, its file in the section, and its place in the file.
    let mut placed: Vec<(bool, usize, usize, usize, Item)> = Vec::new();
    for (k, section) in sections.iter().enumerate() {
        for (f, file) in section.files.iter().enumerate() {
            let source = read(file);
            let (own, rest): (Vec<_>, Vec<_>) = items
                .into_iter()
                .map(|item| (defined_at(&source, &item.name), item))
                .partition(|(at, _)| at.is_some());
            items = rest.into_iter().map(|(_, item)| item).collect();
            placed.extend(own.into_iter().map(|(at, item)| (!item.is_handle(), k, f, at.unwrap_or(0), item)));
        }
    }
    let homeless: Vec<&str> = items.iter().map(|item| item.name.as_str()).collect();
    assert!(homeless.is_empty(), "no section has {homeless:?}");
    placed.sort_by_key(|(is_other, section, file, at, _)| (*is_other, *section, *file, *at));

    let (mut text, mut contents) = (String::new(), String::new());
    let titles = std::iter::once("Objects").chain(sections.iter().map(|section| section.title));
    for (k, title) in titles.enumerate() {
        let title = format!("{}. {title}", k + 1);
        writeln!(contents, " *   {title}").expect("memory");
        write!(text, "\n/* ---- {title} {:-<1$} */\n", "", WIDTH - 13 - title.len()).expect("memory");
        // Handles stand first, because every section may mention them.
        let of_section =
            placed.iter().filter(|(is_other, section, ..)| if *is_other { section + 1 == k } else { k == 0 });
        for (.., item) in of_section {
            text.push('\n');
            declare(item, &mut text);
        }
    }
    (text, contents)
}
