//! C and C++ programs against `include/leafless.h` and both libraries.
//!
//! ```text
//! cargo test --test c_api
//! LEAFLESS_C_CHECK=valgrind cargo test --test c_api     # also: address, address-all, thread
//! ```
//!
//! The libraries are built like these tests, with the same profile and from the same compiled parts. Every
//! program is compiled, linked and run as a user would do it. `README.md` in this folder explains the purpose
//! of each.

#![cfg(unix)]

mod arrange;
mod check;
mod cpp;
mod generated;
mod header;
mod kit;
mod packages;
mod refused;
mod warnings;

use check::Check;
use header::Header;
use kit::{Kit, Link, Standard, kit};
use std::path::{Path, PathBuf};
use std::process::Command;

const C99: Standard = Standard::C("c99");
const CPP17: Standard = Standard::Cpp("c++17");

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the interface has a folder of its own")
}

fn text(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn header() -> Header {
    Header::read(&text("include/leafless.h"))
}

/// Compiles a program of this folder, runs it, and returns its output.
fn run(name: &str, standard: Standard, link: Link, arguments: &[&str]) -> String {
    let kit = kit();
    let source = root().join("c_tests").join(format!("{name}.{}", standard.extension()));
    let program = kit.compile(name, &[source], standard, link);
    kit.run(&program, arguments)
}

/// The list of programs is documented as complete. No file of the folder may be missing from it.
#[test]
fn every_file_is_used() {
    let driver = text("c_tests/main.rs") + &text("c_tests/kit.rs");
    for entry in std::fs::read_dir(root().join("c_tests")).unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_str().unwrap();
        if matches!(path.extension().and_then(|end| end.to_str()), Some("c" | "cpp")) {
            let used =
                driver.contains(&format!("\"{stem}\"")) || driver.contains(&format!("c_tests/{stem}.c"));
            assert!(used, "nobody runs {}", path.display());
        }
    }
}

// --- The header
// -------------------------------------------------------------------------------------------------

#[test]
fn header_in_all_standards() {
    for standard in ["c99", "c11", "c17"] {
        run("header_c", Standard::C(standard), Link::Static, &[]);
    }
    for standard in ["c++11", "c++14", "c++17", "c++20"] {
        run("header_cpp", Standard::Cpp(standard), Link::Static, &[]);
    }
}

/// The interface for C++, with exceptions and without.
#[test]
fn wrapper() {
    run("wrapper", CPP17, Link::Static, &[]);
    run("wrapper", Standard::Cpp("c++20"), Link::Shared, &[]);
    run("wrapper_plain", CPP17, Link::Static, &[]);
}

#[test]
fn header_in_two_files() {
    let sources = ["include_twice_a", "include_twice_b"].map(|name| root().join(format!("c_tests/{name}.c")));
    let program = kit().compile("include_twice", &sources, C99, Link::Static);
    kit().run(&program, &[]);
}

/// The header declares everything that its texts mention.
#[test]
fn header_speaks_of_nothing_else() {
    let header = header();
    for word in header::words(&text("include/leafless.h")) {
        let known = header.names().any(|name| name == word || word.strip_suffix('s') == Some(name));
        // The guard, the tests' macro, and the name of an unknown status.
        let other = ["LEAFLESS_H", "LEAFLESS_TEST", "LEAFLESS_E_UNKNOWN"].contains(&word.as_str());
        assert!(known || other, "the header speaks of {word}");
    }
}

#[test]
fn symbols() {
    let header = header();
    let mut names: Vec<&str> = header.functions.iter().map(|function| function.name.as_str()).collect();
    for link in [Link::Static, Link::Shared] {
        let printed = run("symbols", C99, link, &[]);
        let mut found: Vec<&str> = printed.lines().collect();
        found.sort_unstable();
        names.sort_unstable();
        assert_eq!(found, names);
    }
}

#[test]
fn layout() {
    let header = header();
    let c = run("layout", C99, Link::Static, &[]);
    let rust = run("layout", C99, Link::Static, &["rust"]);
    let sorted = |text: &str| {
        let mut lines: Vec<String> = text.lines().map(str::to_string).collect();
        lines.sort();
        lines
    };
    assert_eq!(sorted(&c), sorted(&rust));
    let lines =
        header.structs.iter().map(|(_, fields)| 1 + fields.len()).sum::<usize>() + header.values.len();
    assert_eq!(c.lines().count(), lines);
    // A few well-known lines, so that the comparison is meaningful.
    assert!(c.lines().any(|line| line == "leafless_frame 40"), "{c}");
    assert!(c.lines().any(|line| line == "LEAFLESS_E_PANIC 17"), "{c}");
    assert!(lines > 100, "{lines}");
}

#[test]
fn version() {
    run("version", C99, Link::Static, &[env!("CARGO_PKG_VERSION")]);
    run("version", C99, Link::Shared, &[env!("CARGO_PKG_VERSION")]);
}

// --- The functions (by the shared library, which links in a quarter of the time)
// --------------------------------------------------------------------------------------

#[test]
fn lifecycle() {
    run("lifecycle", C99, Link::Static, &[]);
    run("lifecycle", C99, Link::Shared, &[]);
}

#[test]
fn errors() {
    let limit = if kit().check.limits_memory() { "limited" } else { "unlimited" };
    run("errors", C99, Link::Static, &[limit]);
}

#[test]
fn panic() {
    run("panic", C99, Link::Static, &[]);
    run("panic", C99, Link::Shared, &[]);
}

#[test]
fn refused() {
    refused::write();
    run("refused", C99, Link::Static, &[]);
}

#[test]
fn sources_and_sinks() {
    run("sources", C99, Link::Static, &[]);
}

#[test]
fn buffers() {
    run("buffers", C99, Link::Shared, &[]);
}

#[test]
fn arrays() {
    run("arrays", C99, Link::Shared, &[]);
}

#[test]
fn mesh_reports() {
    run("mesh_report", C99, Link::Shared, &[]);
}

#[test]
fn mesh_files() {
    run("mesh_file", C99, Link::Shared, &[]);
}

#[test]
fn written_meshes() {
    run("mesh_write", C99, Link::Shared, &[]);
}

#[test]
fn tridexels() {
    run("tridexel", C99, Link::Shared, &[]);
    run("tridexel_surface", C99, Link::Shared, &[]);
}

#[test]
fn volumes() {
    run("volume", C99, Link::Shared, &[]);
}

#[test]
fn channels() {
    run("channel", C99, Link::Shared, &[]);
    run("attribute", CPP17, Link::Shared, &[]);
    run("summary", C99, Link::Shared, &[]);
    run("mesh_attribute", C99, Link::Shared, &[]);
}

#[test]
fn surfaces() {
    run("surface", C99, Link::Shared, &[]);
    run("contour", C99, Link::Shared, &[]);
    run("simplify", C99, Link::Shared, &[]);
    run("extract", CPP17, Link::Shared, &[]);
}

#[test]
fn open_meshes() {
    run("open_mesh", C99, Link::Shared, &[]);
}

#[test]
fn polyhedra() {
    run("polyhedron", C99, Link::Shared, &[]);
}

#[test]
fn lazy() {
    run("lazy", C99, Link::Shared, &[]);
}

#[test]
fn scenes() {
    run("scene", C99, Link::Shared, &[]);
}

#[test]
fn measures() {
    run("measure", C99, Link::Shared, &[]);
}

#[test]
fn rays() {
    run("rays", C99, Link::Shared, &[]);
}

#[test]
fn columns() {
    run("columns", C99, Link::Shared, &[]);
}

#[test]
fn voxels() {
    run("voxel", C99, Link::Shared, &[]);
}

#[test]
fn pictures() {
    run("picture", C99, Link::Shared, &[]);
}

#[test]
fn regions() {
    run("region", C99, Link::Shared, &[]);
}

#[test]
fn distances() {
    run("distance", C99, Link::Shared, &[]);
}

#[test]
fn cells() {
    run("cells", C99, Link::Shared, &[]);
}

#[test]
fn probes() {
    run("probe", C99, Link::Shared, &[]);
}

#[test]
fn options() {
    run("options", C99, Link::Shared, &[]);
}

/// Older and newer programs with structs that the library fills. The program tries every function that fills
/// one.
#[test]
fn outputs() {
    let (header, program) = (text("include/leafless.h"), text("c_tests/outputs.c"));
    let sized: Vec<&str> = (header.split("typedef struct ").filter_map(|text| text.split_once(" {\n")))
        .filter(|(_, body)| body.starts_with("    uint32_t struct_size;"))
        .map(|(name, _)| name)
        .collect();
    let mut tried = 0;
    for declaration in header.split("\nleafless_status ").skip(1) {
        let (name, rest) = declaration.split_once('(').unwrap();
        let (parameters, _) = rest.split_once(");").unwrap();
        let filled = parameters.split(',').map(str::trim).filter_map(|p| p.split_once(" *"));
        for (kind, _) in filled.filter(|(kind, _)| sized.contains(kind)) {
            assert!(program.contains(&format!("FILLS({kind}, {name}(")), "{name} fills a {kind}");
            tried += 1;
        }
    }
    assert!(tried >= 20, "{tried}");
    run("outputs", C99, Link::Shared, &[]);
}

#[test]
fn callback() {
    run("callback", C99, Link::Shared, &[]);
}

#[test]
fn solid_geometry() {
    run("csg", C99, Link::Shared, &[]);
}

#[test]
fn extended() {
    run("extended", C99, Link::Shared, &[]);
}

#[test]
fn shards() {
    run("shards", C99, Link::Shared, &[]);
}

#[test]
fn interferences() {
    run("interference", C99, Link::Shared, &[]);
}

#[test]
fn layouts() {
    run("bay", C99, Link::Shared, &[]);
    run("layouts", CPP17, Link::Shared, &[]);
}

#[test]
fn cancel() {
    run("cancel", CPP17, Link::Shared, &[]);
}

#[test]
fn threads() {
    let many: &[&str] = if kit().check.is_plain() { &["many"] } else { &[] };
    run("threads", CPP17, Link::Static, many);
    run("threads", CPP17, Link::Shared, &[]);
}

/// The program, the C libraries and Python give the same bits: see `tests/same_bits`.
#[test]
fn same_bits() {
    let folder = root().join("tests/same_bits");
    let files = ["spindle.off", "shard.off"].map(|name| folder.join(name).to_str().unwrap().to_string());
    let ends = |text: &str| text.split_whitespace().map(|end| end.parse().unwrap()).collect::<Vec<f64>>();
    let expected = ends(&text("tests/same_bits/answers.txt"));
    for link in [Link::Static, Link::Shared] {
        let told = run("same_bits", C99, link, &[&files[0], &files[1]]);
        assert_eq!(ends(&told), expected, "{told}");
    }
}

/// The mistakes of a careless host.
#[test]
fn attacks() {
    run("attack", CPP17, Link::Shared, &[]);
}

#[test]
fn map() {
    run("map", C99, Link::Shared, &[]);
}

#[test]
fn golden() {
    let folder = root().join("format_spec/vectors");
    let mut files: Vec<PathBuf> = ["valid", "invalid"]
        .iter()
        .flat_map(|kind| std::fs::read_dir(folder.join(kind)).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "lfl"))
        .collect();
    files.sort();
    let arguments: Vec<&str> = files.iter().map(|path| path.to_str().unwrap()).collect();
    let told = run("golden", C99, Link::Shared, &arguments);
    let numbers: Vec<usize> = told.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let [valid, points, invalid] = numbers[..] else { panic!("{told}") };
    assert_eq!(valid + invalid, files.len());
    assert!(valid > 20 && points > 500 && invalid > 50, "{told}");
}

/// A smoke test. Real figures need more points, see the file.
#[test]
fn boundary() {
    for language in [C99, CPP17] {
        let told = run("boundary", language, Link::Shared, &["10000"]);
        assert_eq!(told.lines().filter(|line| line.contains(" ns")).count(), 7, "{told}");
    }
}

// --- The documentation
// --------------------------------------------------------------------------------------------

/// Returns the blocks of code in C and C++ of a text, with the standard of each.
fn blocks(text: &str) -> Vec<(Standard, &str)> {
    let pieces = text.split("\n```");
    let standard = |piece: &'_ str| match piece.split('\n').next() {
        Some("c") => Some(C99),
        Some("cpp") => Some(CPP17),
        _ => None,
    };
    pieces.filter_map(|piece| Some((standard(piece)?, piece.split_once('\n')?.1))).collect()
}

/// The programs of the README and of the guide.
#[test]
fn guide() {
    let mut pages = vec!["README.md".to_string()];
    for entry in std::fs::read_dir(root().join("docs")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if name.ends_with(".md") {
            pages.push(format!("docs/{name}"));
        }
    }
    let mut count = 0;
    for page in pages {
        for (standard, program) in blocks(&text(&page)) {
            count += 1;
            let name = format!("guide_{count}");
            let source = kit().folder("guide").join(&name).with_extension(standard.extension());
            std::fs::write(&source, program).unwrap();
            for link in [Link::Static, Link::Shared] {
                let program = kit().compile(&name, std::slice::from_ref(&source), standard, link);
                let told = kit().run(&program, &[]);
                assert!(told.contains("volume 0.6"), "{page}: {told}");
            }
        }
    }
    assert!(count >= 3, "{count}");
}

/// The example at the top of the header.
#[test]
fn header_example() {
    let header = text("include/leafless.h");
    let (_, example) = header.split_once(" * EXAMPLE").unwrap();
    let (example, _) = example.split_once(" * CONTENTS").unwrap();
    let lines: Vec<&str> = example.lines().filter_map(|line| line.strip_prefix(" *   ")).collect();
    assert!((10..=16).contains(&lines.len()), "{lines:?}");
    let source = kit().folder("header_example").join("header_example.c");
    let includes = "#include <leafless.h>\n#include <stdio.h>\n#include <string.h>\n";
    let end = "leafless_octree_free(octree), leafless_solid_free(bored);\n\
               leafless_solid_free(parts[0]), leafless_solid_free(parts[1]);\nreturn 0;\n}\n";
    std::fs::write(&source, format!("{includes}int main(void) {{\n{}\n{end}", lines.join("\n"))).unwrap();
    let program = kit().compile("header_example", &[source], C99, Link::Static);
    let told = kit().run(&program, &[]);
    // A ball of radius 0.75 with a bore of radius 0.25. The rest has 4π/3 times the third power of half the
    // bore's length.
    let bounds: Vec<f64> = told.split(" to ").map(|bound| bound.trim().parse().unwrap()).collect();
    let truth = 4.0 / 3.0 * std::f64::consts::PI * (0.75f64.powi(2) - 0.25f64.powi(2)).powf(1.5);
    assert!(bounds[0] <= truth && truth <= bounds[1] && bounds[1] - bounds[0] < 0.2, "{told} {truth}");
}

#[test]
fn examples() {
    let examples = [
        ("c/voxelise.c", C99),
        ("c/scan.c", C99),
        ("c/fit.c", C99),
        ("c/isosurface.c", C99),
        ("c/attributes.c", C99),
        ("c/dexel_cuts.c", C99),
        ("c/pictures.c", C99),
        ("c/drilled_plate.c", C99),
        ("cpp/cut_stock.cpp", CPP17),
        ("cpp/part.cpp", CPP17),
        ("cpp/faces.cpp", CPP17),
        ("cpp/move_part.cpp", CPP17),
        ("cpp/shards.cpp", CPP17),
    ];
    for (name, standard) in examples {
        let source = root().join("examples").join(name);
        let stem = source.file_stem().unwrap().to_str().unwrap().to_string();
        let program = kit().compile(&stem, &[source], standard, Link::Shared);
        let told = kit().run(&program, &[]);
        assert!(told.lines().count() >= 5, "{told}");
    }
}

// --- The libraries
// ----------------------------------------------------------------------------------------------

#[test]
fn native_libraries_are_documented() {
    let kit = kit();
    let documented = kit::documented(&text("include/README.md"));
    let line = documented
        .iter()
        .find(|line| line.contains("libleafless.a "))
        .expect("a line for the static library");
    let list = line.split_once("libleafless.a ").unwrap().1.split(" -o ").next().unwrap();
    assert_eq!(list.trim(), kit.native_libraries, "include/README.md and rustc name different libraries");
}

/// Returns the lines of a tool's output, split into words.
fn table(program: &str, arguments: &[&str], file: &Path) -> Vec<Vec<String>> {
    let told = Command::new(program).args(arguments).arg(file).output();
    let told = told.unwrap_or_else(|error| panic!("{program} (of binutils) cannot be run: {error}"));
    assert!(told.status.success(), "{program}: {}", String::from_utf8_lossy(&told.stderr));
    String::from_utf8_lossy(&told.stdout)
        .lines()
        .map(|line| line.split_whitespace().map(str::to_string).collect())
        .collect()
}

fn sorted_functions() -> Vec<String> {
    let mut names: Vec<String> = header().functions.into_iter().map(|function| function.name).collect();
    names.extend(["leafless_test_layout", "leafless_test_panic"].map(str::to_string));
    names.sort();
    names
}

/// The shared library exports the header's functions, and nothing else.
#[test]
#[cfg(target_os = "linux")]
fn shared_library_exports_the_header() {
    if !kit().check.is_plain() {
        return;
    }
    let library = kit().libraries().join("libleafless.so");
    let mut names: Vec<String> = table("nm", &["-D", "--defined-only"], &library)
        .into_iter()
        .filter_map(|mut line| line.pop())
        .collect();
    names.sort();
    assert_eq!(names, sorted_functions());
    let soname =
        table("readelf", &["-dW"], &library).into_iter().find(|line| line.iter().any(|w| w == "(SONAME)"));
    assert_eq!(soname.expect("a SONAME").last().unwrap(), "[libleafless.so.0]");
}

/// Every name of the static library that could clash with another library belongs to Rust or has the prefix.
#[test]
#[cfg(target_os = "linux")]
fn static_library_has_no_other_names() {
    if !kit().check.is_plain() {
        return;
    }
    let library = kit().libraries().join("libleafless.a");
    // Strong and global names. Hidden and weak names give way.
    let mut ours = Vec::new();
    for object in elf_symbols(&library) {
        let name = object.as_str();
        let mangled = name.starts_with("_R") || name.starts_with("_ZN");
        let runtime =
            name.starts_with("__rust") || name == "rust_eh_personality" || name == "rust_begin_unwind";
        if name.starts_with("leafless_") {
            ours.push(object);
        } else {
            assert!(mangled || runtime, "libleafless.a defines {name}");
        }
    }
    ours.sort();
    assert_eq!(ours, sorted_functions());
}

/// Returns an archive's symbols that are global, defined, and neither weak nor hidden.
#[cfg(target_os = "linux")]
fn elf_symbols(archive: &Path) -> Vec<String> {
    // Num: Value Size Type Bind Vis Ndx Name
    table("readelf", &["-sW"], archive)
        .into_iter()
        .filter(|words| {
            words.len() == 8 && words[4] == "GLOBAL" && words[5] == "DEFAULT" && words[6] != "UND"
        })
        .filter_map(|mut words| words.pop())
        .collect()
}

/// With a sanitizer, the program really contains it.
#[test]
fn sanitizer_is_in() {
    let kit = kit();
    if let Some(symbol) = kit.check.symbol() {
        let source = root().join("c_tests/header_c.c");
        let program = kit.compile("sanitizer", &[source], C99, Link::Static);
        let names = table("nm", &["-a"], &program);
        assert!(names.iter().any(|line| line.last().is_some_and(|name| name == symbol)), "no {symbol}");
    }
}

/// This kit and the checker detect failing programs.
#[test]
fn failing_programs_fail() {
    let kit: &Kit = kit();
    let folder = kit.folder("failing");
    let source = |name: &str, body: &str| {
        let path = folder.join(format!("{name}.cpp"));
        let text = format!("#include \"check.h\"\n#include <thread>\nint main() {{\n{body}\nreturn 0;\n}}\n");
        std::fs::write(&path, text).unwrap();
        [path]
    };
    let fails = |name: &str, body: &str| {
        let program = kit.compile(name, &source(name, body), CPP17, Link::Static);
        kit.try_run(&program, &[]).is_err()
    };
    assert!(fails("fails", "CHECK(1 == 2);"));
    assert!(kit.try_compile("warns", &source("warns", "int unused;"), CPP17, Link::Static).is_err());

    let watched = |checks: &[Check]| checks.contains(&kit.check);
    let octree = "leafless_octree *octree = check_ball(4, LEAFLESS_RULE_CERTIFIED);";
    // An octree that is never freed.
    assert_eq!(
        fails("leaks", &format!("{{ {octree} CHECK(octree != nullptr); }} (void)check_cube();")),
        watched(&[Check::Address, Check::AddressAll, Check::Valgrind])
    );
    // Two answers, and room for one: the library writes beyond it.
    let overflows = format!(
        "{octree} double points[6] = {{}}; void *one = malloc(1); CHECK(one != nullptr);
         OK(leafless_octree_contains_many(octree, points, 2, (leafless_membership *)one));
         free(one); leafless_octree_free(octree);"
    );
    assert_eq!(
        fails("overflows", &overflows),
        watched(&[Check::Address, Check::AddressAll, Check::Valgrind])
    );
    // A cursor moved by two threads: the race is in the library.
    let races = format!(
        "{octree} leafless_cursor *cursor = nullptr; OK(leafless_cursor_new(octree, &cursor));
         auto move = [&] {{ for (int i = 0; i < 1000; i++) {{
             leafless_cursor_descend(cursor, 3, nullptr); leafless_cursor_ascend(cursor, nullptr); }} }};
         std::thread other(move); move(); other.join();
         leafless_cursor_free(cursor); leafless_octree_free(octree);"
    );
    if kit.check == Check::Thread {
        assert!(fails("races", &races));
    }
}
