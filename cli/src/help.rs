//! The help texts of the program.
//!
//! The overview lists the subcommands by what people want to do. The help of a subcommand begins with its
//! purpose, its usage, its arguments and its options under headings, the most common ones first; the details
//! and the examples follow. What each subcommand and each option means is written where it is defined.

use crate::show;
use clap::{Arg, Command};

/// The subcommands under their headings. A test compares them with the program's subcommands.
const GROUPS: [(&str, &[&str]); 9] = [
    ("Make solids", &["voxelize", "csg", "dexelize"]),
    ("Combine solids", &["union", "intersection", "difference", "xor", "complement"]),
    ("Measure", &["measure", "within"]),
    ("Compare and fit", &["interfere", "deviation", "layout"]),
    ("Ask about points, rays and cells", &["contains", "distance", "ray", "neighbours"]),
    ("Meshes, pictures and arrays", &["mesh", "render", "heights", "bitmap", "voxels"]),
    ("Attributes (values inside a solid)", &["attribute", "sample", "summary"]),
    ("Files", &["info", "verify", "convert"]),
    ("First steps", &["demo", "help"]),
];

/// The purpose of `help`, which the parser adds by itself.
const HELP: &str = "Show the help of a command";

/// Options that have the same heading in all subcommands, by the headings in their order. The options that
/// are special to a subcommand stand before them, under "Options" or under a heading of their own.
const HEADINGS: [(&str, &[&str]); 4] = [
    (
        "Accuracy",
        &[
            "absolute",
            "adaptive",
            "boundary",
            "boundary-depth",
            "by-ends",
            "cells",
            "coarse",
            "corners",
            "depth",
            "directions",
            "fine",
            "level",
            "on",
            "plain",
            "resolution",
            "resolve",
            "rule",
            "samples",
            "snap",
            "surfaces",
            "tolerance",
            "touch",
            "vertices",
        ],
    ),
    ("Limits", &["max-memory", "seconds", "splits", "tests", "threads"]),
    ("Units and placement", &["bounds", "like", "unit"]),
    ("Output format", &["gzip", "lossy", "normals", "polygons", "raw", "text", "write"]),
];

/// Command lines for each subcommand. A test parses them.
const EXAMPLES: [(&str, &[&str]); 29] = [
    (
        "voxelize",
        &[
            "leafless voxelize part.stl -o part.lfl --depth 9",
            "leafless voxelize scan.stl -o scan.lfl --surfaces=1e-4",
            "leafless voxelize ct.raw -o ct.lfl --extents 512,512,300 --type u16 --threshold 300",
        ],
    ),
    (
        "csg",
        &[
            "leafless csg part.csg -o part.lfl --surfaces",
            "leafless csg part.csg -o part.lfl --depth 10 --bounds 0,0,0,100",
        ],
    ),
    (
        "dexelize",
        &[
            "leafless dexelize part.stl -o part.dex.lfl --resolution 512 --normals 32",
            "leafless dexelize part.csg -o z.dex.lfl --directions z",
        ],
    ),
    (
        "convert",
        &[
            "leafless convert part.stl -o turned.obj --rotate z,30 --translate 0,0,5",
            "leafless convert part.dex.lfl -o cells.lfl --to octree",
            "leafless convert part.lfl -o cells.lfl --to octree --resolution 1024",
        ],
    ),
    ("info", &["leafless info part.lfl", "leafless info scan.ply --json", "leafless info --check part.stl"]),
    ("verify", &["leafless verify part.lfl"]),
    (
        "union",
        &[
            "leafless union part.lfl lid.lfl -o both.lfl",
            "leafless union part.stl pin.stl --translate 0,0,5 -o both.stl",
        ],
    ),
    (
        "intersection",
        &[
            "leafless intersection part.lfl region.lfl -o inside.lfl",
            "leafless intersection a.stl b.csg -o common.lfl --depth 9",
        ],
    ),
    (
        "difference",
        &[
            "leafless difference part.lfl tool.lfl -o rest.lfl",
            "leafless difference part.stl tool.stl -o cut.stl",
            "leafless difference part.lfl pin.lfl --rotate z,30 pin.lfl --rotate z,60 -o rest.lfl",
        ],
    ),
    ("xor", &["leafless xor old.stl new.stl -o changes.lfl", "leafless xor old.lfl new.lfl -o changes.lfl"]),
    ("complement", &["leafless complement part.lfl -o air.lfl"]),
    (
        "contains",
        &["echo \"10 20 30\" | leafless contains part.lfl", "leafless contains part.lfl < points.txt"],
    ),
    (
        "distance",
        &[
            "echo \"10 20 90\" | leafless distance part.stl --signed",
            "leafless distance part.lfl --json < points.txt",
        ],
    ),
    (
        "neighbours",
        &[
            "echo \"1 0 0 0\" | leafless neighbours part.lfl",
            "echo \"5 3 0 7\" | leafless neighbours part.lfl --through vertices --smaller",
        ],
    ),
    (
        "ray",
        &[
            "echo \"10 20 90  0 0 -1\" | leafless ray part.csg",
            "leafless ray part.lfl --on full --json < rays.txt",
        ],
    ),
    (
        "render",
        &[
            "leafless render part.stl -o part.png --edges",
            "leafless render part.stl -o cut.png --view slice --plane 0,0,1,-5 --no-cells",
            "leafless render part.lfl --show",
        ],
    ),
    (
        "heights",
        &[
            "leafless heights part.stl --axis z -o heights.csv",
            "leafless heights part.lfl --axis z --from below --on full",
        ],
    ),
    (
        "mesh",
        &[
            "leafless mesh part.csg -o part.3mf",
            "leafless mesh scan.stl -o fewer.stl --tolerance 0.05",
            "leafless mesh part.lfl -o part.ply --method nets --resolve inner",
        ],
    ),
    (
        "bitmap",
        &["leafless bitmap part.lfl -o part.nrrd --gzip", "leafless bitmap part.lfl -o part.raw --level 7"],
    ),
    (
        "voxels",
        &[
            "leafless voxels part.lfl -o part.npz --channel heat",
            "leafless voxels part.stl -o part.csv --depth 6 --outside",
            "leafless voxels part.npz --import -o part.lfl",
        ],
    ),
    (
        "interfere",
        &[
            "leafless interfere shaft.csg ring.stl --translate 6,0,0",
            "leafless interfere shaft.csg ring.stl --gap-at-least 0.1",
            "leafless interfere shaft.csg ring.stl --poses poses.txt --clearance",
        ],
    ),
    (
        "layout",
        &[
            "leafless layout box:200,200,180 shaft.stl*30 lid.csg*8 --clearance 2 -o plate.json -o plate.3mf",
            "leafless layout --check plate.json",
        ],
    ),
    (
        "deviation",
        &["leafless deviation old.stl new.stl", "leafless deviation old.stl new.csg --within 0.05"],
    ),
    (
        "measure",
        &[
            "leafless measure part.stl --unit mm --density 7.85g/cm3",
            "leafless measure part.csg --tolerance 1e-5 --seconds 10",
            "leafless measure part.lfl --json",
        ],
    ),
    (
        "within",
        &[
            "leafless within part.lfl --ball 10,20,30,5",
            "leafless within part.lfl --box 0,0,0,10,10,10 --json",
            "leafless within part.stl --in region.csg",
        ],
    ),
    (
        "attribute",
        &[
            "leafless attribute part.lfl --name heat --expr \"20 + 3*z\" --unit K",
            "leafless attribute part.lfl --name paint --from part.3mf",
            "leafless attribute part.lfl --name material --value 2 --in upper.lfl",
        ],
    ),
    (
        "sample",
        &[
            "echo \"10 20 30\" | leafless sample part.lfl --name heat",
            "leafless sample part.lfl --json < points.txt",
        ],
    ),
    (
        "summary",
        &[
            "leafless summary part.lfl --name heat",
            "leafless summary part.lfl --name material --materials --density 1=0.0085 --density 2=0.00785",
        ],
    ),
    ("demo", &["leafless demo", "leafless demo parts"]),
];

/// The options that most subcommands have, for the overview.
const COMMON: [(&str, &str); 6] = [
    ("-o, --output <FILE>", "File to write; `-` is standard output"),
    ("--depth <N>", "Levels of cells, 1 to 20; each level halves the cells and the error"),
    ("--threads <N>", "Threads to use; 0, the default: one for each processor"),
    ("--json", "Print JSON"),
    ("--unit <UNIT>", "Unit of the numbers in a mesh file; --to-unit converts them"),
    ("--translate <X,Y,Z>", "Move the input; likewise --rotate, --scale and --place"),
];

/// The greatest width of help texts, also where the terminal's width is not known.
const WIDTH: usize = 100;
/// The least width, which a narrower terminal has to break further.
const LEAST_WIDTH: usize = 60;
/// Columns before the help of an option of a subcommand, which begins a line of its own.
const INDENT: usize = 10;
/// Columns before the help of an option in the overview.
const COLUMN: usize = 27;

/// The command line with its help texts.
pub fn with_help(all: Command) -> Command {
    with_width(all, show::columns().unwrap_or(WIDTH).clamp(LEAST_WIDTH, WIDTH))
}

fn with_width(mut all: Command, width: usize) -> Command {
    for own in all.get_subcommands_mut() {
        let details = own.get_long_about().map(|text| text.to_string()).unwrap_or_default();
        let details = filled(&details, width - 2);
        let examples = examples(own);
        let taken = std::mem::take(own).next_line_help(true).long_about(None);
        let taken = taken.mut_args(|argument| refilled(headed(argument), width - INDENT));
        let details = section(&taken, "Details", &details);
        *own = taken.after_long_help(format!("{details}\n\n{examples}")).after_help(examples);
    }
    let notes = all.get_after_help().map(|text| filled(&text.to_string(), width)).unwrap_or_default();
    let list = overview(&all, width);
    let [usage, options, most] =
        ["Usage:", "Options:", "Options of most commands:"].map(|text| header(&all, text));
    let common: String =
        COMMON.iter().map(|(option, help)| line(&all, option, help, COLUMN, width)).collect();
    // (The parser's own list of subcommands has no headings.)
    let template = format!(
        "{{about}}\n\n{usage} {{usage}}\n\n{options}\n{{options}}\n\n{most}{common}\n\n{list}\n\n{notes}\n"
    );
    all.mut_args(|argument| refilled(headed(argument), width - COLUMN)).help_template(template)
}

/// The argument under the heading of its name.
fn headed(argument: Arg) -> Arg {
    let name = argument.get_long().filter(|_| argument.get_help_heading().is_none());
    let known = HEADINGS.iter().find(|(_, options)| name.is_some_and(|name| options.contains(&name)));
    match known {
        Some((heading, _)) => argument.help_heading(*heading),
        None => argument,
    }
}

/// The argument with its help in lines of this width. (Without the terminal's width the parser breaks none.)
fn refilled(argument: Arg, width: usize) -> Arg {
    let [help, long] = [argument.get_help(), argument.get_long_help()]
        .map(|text| text.map(|text| filled(&text.to_string(), width)));
    match (help, long) {
        (Some(help), Some(long)) => argument.help(help).long_help(long),
        (Some(help), None) => argument.help(help),
        _ => argument,
    }
}

/// Paragraphs, which empty lines separate, in lines of this width.
fn filled(text: &str, width: usize) -> String {
    let paragraph = |text: &str| {
        let (mut lines, mut length) = (String::new(), 0);
        for word in text.split_whitespace() {
            let own = word.chars().count();
            if length > 0 && length + 1 + own > width {
                lines.push('\n');
                length = 0;
            } else if length > 0 {
                lines.push(' ');
                length += 1;
            }
            lines.push_str(word);
            length += own;
        }
        lines
    };
    text.split("\n\n").map(paragraph).collect::<Vec<_>>().join("\n\n")
}

/// The examples of a subcommand.
fn examples(command: &Command) -> String {
    let known = EXAMPLES.iter().find(|(name, _)| *name == command.get_name());
    known.map(|(_, lines)| section(command, "Examples", &lines.join("\n"))).unwrap_or_default()
}

/// A heading, and indented lines below it.
fn section(command: &Command, heading: &str, text: &str) -> String {
    let indented = |line: &str| if line.is_empty() { "\n".into() } else { format!("\n  {line}") };
    let lines: String = text.lines().map(indented).collect();
    format!("{}{lines}", header(command, &format!("{heading}:")))
}

/// A heading in the style of the parser's own ones.
fn header(command: &Command, text: &str) -> String {
    let style = command.get_styles().get_header();
    format!("{style}{text}{style:#}")
}

/// The line of a name in a list, whose help begins at a column.
fn line(all: &Command, name: &str, help: &str, column: usize, width: usize) -> String {
    let style = all.get_styles().get_literal();
    // (Options without a short name stand below the long names of others.)
    let indent = if name.starts_with("--") { 6 } else { 2 };
    let gap = column.saturating_sub(indent + name.len());
    let help = filled(help, width - column).replace('\n', &format!("\n{:column$}", ""));
    format!("\n{:indent$}{style}{name}{style:#}{:gap$}{help}", "", "")
}

/// The subcommands and their purposes, under their headings.
fn overview(all: &Command, width: usize) -> String {
    let longest = GROUPS.iter().flat_map(|(_, names)| *names).map(|name| name.len()).max().unwrap_or(0);
    let own = |name: &&str| {
        let about = all.find_subcommand(name).and_then(Command::get_about);
        let about = about.map_or_else(|| HELP.to_owned(), |about| about.to_string());
        line(all, name, &about, longest + 4, width)
    };
    let group = |(heading, names): &(&str, &[&str])| {
        let lines: String = names.iter().map(own).collect();
        format!("{}{lines}", header(all, &format!("{heading}:")))
    };
    GROUPS.iter().map(group).collect::<Vec<_>>().join("\n\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Arguments, command_line};
    use clap::CommandFactory;
    use std::collections::BTreeSet;

    fn names(command: &Command) -> BTreeSet<String> {
        command.get_subcommands().map(|own| own.get_name().to_owned()).collect()
    }

    #[test]
    fn the_overview_lists_each_subcommand_once() {
        let mut all = command_line();
        all.build();
        let listed: Vec<&str> = GROUPS.iter().flat_map(|(_, names)| *names).copied().collect();
        assert_eq!(listed.iter().map(|name| (*name).to_owned()).collect::<BTreeSet<_>>(), names(&all));
        assert_eq!(listed.len(), names(&all).len(), "{listed:?}");
    }

    #[test]
    fn help_texts_keep_to_their_width() {
        for width in [LEAST_WIDTH, 80, WIDTH] {
            let mut all = with_width(Arguments::command(), width);
            all.build();
            let overview = all.render_long_help().to_string();
            let text = overview.lines().skip_while(|line| !line.starts_with("Options:"));
            for line in text.filter(|line| line.contains(' ')) {
                assert!(line.chars().count() <= width, "{line:?}");
            }
            for own in all.get_subcommands_mut() {
                let text = own.render_long_help().to_string();
                let text = text.split("Examples:").next().unwrap().to_owned();
                let text = text
                    .lines()
                    .skip_while(|line| !line.starts_with("Arguments:") && !line.starts_with("Options:"));
                // (The parser lays out the values of options.)
                for line in text.filter(|line| !line.trim_start().starts_with("- ")) {
                    assert!(line.chars().count() <= width, "{} {line:?}", own.get_name());
                }
            }
        }
    }

    #[test]
    fn options_of_most_commands_are_so() {
        let all = command_line();
        for (option, _) in COMMON {
            let long = option.split("--").nth(1).unwrap().split(' ').next().unwrap();
            let has = |own: &&Command| own.get_arguments().any(|argument| argument.get_long() == Some(long));
            assert!(all.get_subcommands().filter(has).count() >= 12, "{option}");
        }
    }

    #[test]
    fn each_subcommand_has_examples_that_the_parser_takes() {
        let all = command_line();
        let known: BTreeSet<String> = EXAMPLES.iter().map(|(name, _)| (*name).to_owned()).collect();
        assert_eq!(known, names(&all));
        for (name, lines) in EXAMPLES {
            assert!((1..=3).contains(&lines.len()), "{name}");
            for line in lines {
                let own = line.split_once(" | ").map_or(*line, |(_, own)| own);
                let own = own.split_once(" < ").map_or(own, |(own, _)| own);
                // A text in quotation marks is one word.
                let words = own.split('"').enumerate().flat_map(|(at, part)| match at % 2 {
                    0 => part.split_whitespace().collect(),
                    _ => vec![part],
                });
                let words: Vec<&str> = words.collect();
                assert_eq!(words[..2], ["leafless", name], "{line}");
                if let Err(error) = command_line().try_get_matches_from(words) {
                    panic!("{line}: {error}");
                }
            }
        }
    }

    #[test]
    fn headings_have_one_order() {
        let order = HEADINGS.map(|(heading, _)| heading);
        let mut seen = BTreeSet::new();
        for own in command_line().get_subcommands() {
            let mut ranks = vec![];
            for argument in own.get_arguments() {
                let known = argument
                    .get_help_heading()
                    .and_then(|found| order.iter().position(|name| *name == found));
                if let Some(rank) = known.filter(|rank| !ranks.contains(rank)) {
                    ranks.push(rank);
                }
                seen.extend(argument.get_long().map(str::to_owned));
            }
            assert!(ranks.is_sorted(), "{} {ranks:?}", own.get_name());
        }
        for option in HEADINGS.iter().flat_map(|(_, options)| *options).filter(|name| **name != "max-memory")
        {
            assert!(seen.contains(*option), "{option}");
        }
    }
}
