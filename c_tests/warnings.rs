//! Both headers compile without warnings under the strictest flags, so that a host program can be as strict
//! as it likes.

use crate::kit::{Kit, Standard, kit, output, skipped};
use crate::{CPP17, root};
use std::process::Command;

const GCC: [&str; 6] = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wsign-conversion", "-Wshadow"];

/// All warnings except those that are no defect here.
const CLANG: [&str; 7] = [
    "-Weverything",
    // Structs have the layout of the interface.
    "-Wno-padded",
    // C++11 is the oldest standard.
    "-Wno-c++98-compat",
    "-Wno-c++98-compat-pedantic",
    // A class in a header has no file of its own for its table of functions.
    "-Wno-weak-vtables",
    // Arrays of C are pointers. Only newer compilers know that warning.
    "-Wno-unsafe-buffer-usage",
    "-Wno-unknown-warning-option",
];

/// Every standard that the headers support, with a program that uses the headers' macros, functions and
/// templates.
const PROGRAMS: [(Standard, &str); 7] = [
    (Standard::C("c99"), "header_c.c"),
    (Standard::C("c11"), "header_c.c"),
    (Standard::Cpp("c++11"), "header_cpp.cpp"),
    (CPP17, "header_cpp.cpp"),
    (CPP17, "wrapper.cpp"),
    (Standard::Cpp("c++20"), "wrapper.cpp"),
    (CPP17, "wrapper_plain.cpp"),
];

/// Uses of these macros, because compilers report a macro's warnings at the place of use.
const MACROS: &str = "
leafless_options warned_options(void);
leafless_options warned_options(void) { return LEAFLESS_INIT(leafless_options); }
int warned_fits(void);
int warned_fits(void) { return LEAFLESS_COMPATIBLE(); }
";

/// Returns a compiler's warnings about the headers while it compiles a program. The program may have warnings
/// of its own.
fn warnings(kit: &Kit, compiler: &str, (standard, program): (Standard, &str), flags: &[&str]) -> Vec<String> {
    let (Standard::C(year) | Standard::Cpp(year)) = standard;
    let name = if program.starts_with("wrapper") { "leafless.hpp" } else { "leafless.h" };
    let define = if program == "wrapper_plain.cpp" { "#define LEAFLESS_NO_EXCEPTIONS\n" } else { "" };
    let source = kit.folder("warnings").join(format!("{compiler}_{program}"));
    let text = format!("{define}#include <{name}>\n#include <{name}>\n{MACROS}#include \"{program}\"\n");
    std::fs::write(&source, text).unwrap();
    let (include, own) = (root().join("include"), root().join("c_tests"));
    let mut command = Command::new(compiler);
    command.arg(format!("-std={year}")).args(flags).args(["-fsyntax-only", "-DLEAFLESS_TEST", "-I"]);
    command.arg(&include).arg("-I").arg(own).arg(&source);
    let (_, told) = output(&mut command).unwrap_or_else(|problem| panic!("{problem}"));
    let places = [include.display().to_string(), source.display().to_string()];
    let of_headers = |line: &&str| {
        line.contains(": warning: ") && places.iter().any(|place| line.starts_with(place.as_str()))
    };
    told.lines().filter(of_headers).map(str::to_owned).collect()
}

#[test]
fn headers_are_silent() {
    let kit = kit();
    if !kit.check.is_plain() {
        return;
    }
    for (c, cpp, flags) in [("gcc", "g++", &GCC[..]), ("clang", "clang++", &CLANG)] {
        if [c, cpp].iter().any(|name| Command::new(name).arg("--version").output().is_err()) {
            skipped("headers_are_silent", &format!("{c} or {cpp} is not installed"));
            continue;
        }
        for (standard, program) in PROGRAMS {
            let told = match standard {
                Standard::C(_) => warnings(kit, c, (standard, program), flags),
                Standard::Cpp(_) => {
                    warnings(kit, cpp, (standard, program), &[flags, &["-Wold-style-cast"]].concat())
                }
            };
            assert!(told.is_empty(), "{}", told.join("\n"));
        }
    }
    // The check detects warnings.
    let strict = [&CLANG[..], &["-Wpadded"]].concat();
    if Command::new("clang").arg("--version").output().is_ok() {
        assert!(!warnings(kit, "clang", PROGRAMS[0], &strict).is_empty());
    }
}
