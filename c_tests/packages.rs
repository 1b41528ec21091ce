//! An installation contains all that programs elsewhere need: for CMake, for `pkg-config`, and for the
//! commands of `include/README.md`. The programs are those of `packaging/consumers`.
//!
//! The installing program takes the libraries that the kit has built, so that nothing is built twice.

use crate::kit::{self, Kit, Standard, kit, output};
use crate::{CPP17, root, text};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Returns the installing program, with the kit's libraries.
fn installer(kit: &Kit) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_leafless-install"));
    command.env_remove("DESTDIR").arg("--libraries").arg(kit.libraries());
    command
}

fn succeed(command: &mut Command) -> String {
    output(command).unwrap_or_else(|problem| panic!("{problem}")).0
}

/// True if these programs can be run; otherwise reports that the test is skipped.
fn have(test: &str, programs: &[&str]) -> bool {
    for program in programs {
        if !Command::new(program).arg("--version").output().is_ok_and(|told| told.status.success()) {
            kit::skipped(test, &format!("{program} is not installed"));
            return false;
        }
    }
    true
}

/// An empty folder.
fn fresh(kit: &Kit, name: &str) -> PathBuf {
    let _ = std::fs::remove_dir_all(kit.folder(name));
    kit.folder(name)
}

/// An empty folder with a copy of the programs.
fn consumers(kit: &Kit, name: &str) -> PathBuf {
    let folder = fresh(kit, name);
    for file in ["CMakeLists.txt", "bored.c", "bored.cpp"] {
        std::fs::copy(root().join("packaging/consumers").join(file), folder.join(file)).unwrap();
    }
    folder
}

/// Makes an installation and moves it to another place.
fn moved_prefix(kit: &Kit, folder: &Path, options: &[&str]) -> PathBuf {
    let (first, second) = (folder.join("first"), folder.join("moved/second"));
    succeed(installer(kit).arg("--prefix").arg(&first).args(options));
    std::fs::create_dir_all(folder.join("moved")).unwrap();
    std::fs::rename(first, &second).unwrap();
    second
}

/// Makes a program `cargo` that runs the installing program with the kit's libraries, and builds nothing.
fn cargo_that_installs(kit: &Kit, folder: &Path) -> PathBuf {
    let script = format!(
        "#!/bin/sh\nexport HOME='{}'\ntest \"$1\" = run || exit 0\nwhile test \"$1\" != --; do shift; done\nshift\n\
         exec '{}' --libraries '{}' \"$@\"\n",
        std::env::var("HOME").unwrap_or_default(),
        env!("CARGO_BIN_EXE_leafless-install"),
        kit.libraries().display()
    );
    let cargo = folder.join("cargo");
    std::fs::create_dir_all(folder).unwrap();
    std::fs::write(&cargo, script).unwrap();
    succeed(Command::new("chmod").arg("+x").arg(&cargo));
    cargo
}

/// Runs a consumer. It prints the volume of a bored ball.
fn tells_the_volume(kit: &Kit, program: &Path) {
    let told = kit.run(program, &[]);
    let bounds: Vec<f64> = told.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    assert!(matches!(bounds[..], [least, most] if least <= 1.481 && 1.481 <= most), "{told}");
}

/// True if a program loads the shared library when it starts.
fn loads_the_library(program: &Path) -> bool {
    String::from_utf8_lossy(&std::fs::read(program).unwrap()).contains("libleafless.so.0")
}

/// The notices name exactly the packages linked into the libraries, with licences and their texts.
fn third_party(file: &Path) {
    let all = std::fs::read_to_string(file).unwrap();
    let (list, texts) = all.split_once("\n----").expect("texts behind the list");
    let lines: Vec<&str> = list.lines().skip(2).collect();
    assert!(lines.len() > 30 && lines[0].starts_with("Rust's standard library (rustc 1."), "{list}");
    for line in &lines[1..] {
        let (package, licence) = line.split_once(": ").expect(line);
        assert!(
            !licence.is_empty() && (licence.contains("without a text") || texts.contains(package)),
            "{line}"
        );
    }
    for name in ["rayon", "num-bigint", "crc32fast", "png"] {
        assert!(lines.iter().any(|line| line.starts_with(&format!("{name} "))), "{name}");
    }
    // Packages that run only at build time or in tests are not linked.
    for name in ["proptest", "cbindgen", "syn", "criterion", "leafless"] {
        assert!(!lines.iter().any(|line| line.starts_with(&format!("{name} "))), "{name}");
    }
    // (The exception of LLVM's licence mentions the GPL.)
    assert!(!list.contains("GPL") && texts.contains("Permission is hereby granted"));
}

#[test]
fn installed_files() {
    let kit = kit();
    let folder = fresh(kit, "installed_files");
    let install = |arguments: &[&str]| {
        output(installer(kit).env("DESTDIR", &folder).args(arguments)).map(|(told, _)| {
            let start = format!("{}/usr/", folder.display());
            told.lines().map(|line| line.strip_prefix(&start).expect(line).to_owned()).collect::<Vec<_>>()
        })
    };
    let version = env!("CARGO_PKG_VERSION");
    let all = install(&["--prefix", "/usr", "--libdir=/usr/lib/x86"]).unwrap();
    // Some toolchains come without the notices of the standard library.
    let notices =
        ["share/licenses/leafless/THIRD-PARTY.txt", "share/licenses/leafless/RUST-STANDARD-LIBRARY.html"];
    assert!(all.iter().any(|place| place == notices[0]), "{all:?}");
    third_party(&folder.join("usr").join(notices[0]));
    let all: Vec<_> = all.into_iter().filter(|place| !notices.contains(&place.as_str())).collect();
    let (headers, lib) = all.split_at(4);
    let licences = ["share/licenses/leafless/LICENSE-APACHE", "share/licenses/leafless/LICENSE-MIT"];
    assert_eq!(headers, [&["include/leafless.h", "include/leafless.hpp"][..], &licences].concat());
    let expected = [
        "libleafless.a",
        &format!("libleafless.so.{version}"),
        "libleafless.so.0",
        "libleafless.so",
        "cmake/leafless/leafless-config.cmake",
        "cmake/leafless/leafless-config-version.cmake",
        "pkgconfig/leafless.pc",
        "pkgconfig/leafless-static.pc",
    ];
    if cfg!(target_os = "linux") {
        assert_eq!(lib, expected.map(|name| format!("lib/x86/{name}")));
        for link in ["libleafless.so", "libleafless.so.0"] {
            let link = std::fs::read_link(folder.join("usr/lib/x86").join(link)).unwrap();
            assert_eq!(link.to_str(), Some(expected[1]));
        }
    }
    for name in &lib[lib.len() - 4..] {
        let text = text(folder.join("usr").join(name));
        // No placeholder is left, and no path is fixed.
        assert!(!text.contains('@') && !text.contains("/usr"), "{name}: {text}");
    }
    let only_static = install(&["--prefix", "/usr", "--only", "static"]).unwrap();
    assert!(!only_static.iter().any(|name| name.contains(".so")), "{only_static:?}");
    let only_shared = install(&["--prefix", "/usr", "--only", "shared"]).unwrap();
    assert!(
        !only_shared.iter().any(|name| name.contains(".a") || name.contains("static")),
        "{only_shared:?}"
    );

    for refused in [
        &["--libdir", "lib"][..],
        &["--prefix"],
        &["--prefix", "/usr", "--libdir", "/lib"],
        &["--prefix", "/usr", "--libdir", "../lib"],
        &["--prefix", "/usr", "--only", "both"],
        &["--prefix", "/usr", "--libraries", "/nowhere"],
        &["--frefix", "/usr"],
    ] {
        assert!(install(refused).is_err_and(|told| told.contains("leafless-install: ")), "{refused:?}");
    }
}

/// The number in the names of the shared library is `LEAFLESS_ABI`.
#[test]
fn soname_is_the_abi() {
    let header = text("include/leafless.h");
    let (_, rest) = header.split_once("#define LEAFLESS_ABI ").unwrap();
    let abi = rest.split_whitespace().next().unwrap();
    assert!(text("capi/build.rs").contains(&format!("libleafless.so.{abi}\"")));
}

#[test]
fn programs_by_cmake() {
    let kit = kit();
    if !kit.check.is_plain() || !have("programs_by_cmake", &["cmake"]) {
        return;
    }
    let folder = consumers(kit, "programs_by_cmake");
    let prefix = moved_prefix(kit, &folder, &[]);
    let mut configure = Command::new("cmake");
    configure.args(["-S", ".", "-B", "build", "-DCMAKE_BUILD_TYPE=Debug"]).current_dir(&folder);
    succeed(configure.arg(format!("-DCMAKE_PREFIX_PATH={}", prefix.display())));
    succeed(Command::new("cmake").args(["--build", "build", "--parallel", "2"]).current_dir(&folder));
    for language in ["c", "cpp"] {
        for library in ["static", "shared"] {
            let program = folder.join(format!("build/bored_{language}_{library}"));
            tells_the_volume(kit, &program);
            assert_eq!(loads_the_library(&program), library == "shared");
        }
    }
}

/// The examples in C++ are a CMake project, which includes the Open CASCADE example where Open CASCADE is
/// installed.
#[test]
fn open_cascade() {
    let kit = kit();
    if !kit.check.is_plain() || !have("open_cascade", &["cmake"]) {
        return;
    }
    let folder = fresh(kit, "open_cascade");
    let prefix = moved_prefix(kit, &folder, &[]);
    let mut configure = Command::new("cmake");
    configure.arg("-S").arg(root().join("examples/cpp")).args([
        "-B",
        "build",
        "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror",
    ]);
    configure.arg(format!("-DCMAKE_PREFIX_PATH={}", prefix.display())).current_dir(&folder);
    succeed(&mut configure);
    succeed(Command::new("cmake").args(["--build", "build", "--parallel", "2"]).current_dir(&folder));
    let program = folder.join("build/open_cascade");
    if !program.exists() {
        return kit::skipped("open_cascade", "Open CASCADE is not installed");
    }
    let told = kit.run(&program, &[]);
    let bounds = |of: &str| {
        let line = told.lines().find_map(|line| line.strip_prefix(of)).expect(of);
        let (lower, upper) = line.split_once(" to ").unwrap_or((line, line));
        [lower, upper].map(|bound| bound.trim().parse::<f64>().unwrap())
    };
    // The block minus its bore, 4345 square millimetres in all. Points within the deflection of its facets
    // are unknown.
    let truth = 40.0 * 24.0 * 16.0 - std::f64::consts::PI * 6.0 * 6.0 * 16.0;
    let [[by_them, _], triangles, distances] =
        ["volume by Open CASCADE", "volume by triangles", "volume by distances"].map(bounds);
    assert!((by_them - truth).abs() < 1e-3, "{told}");
    assert!(triangles[0] < truth && truth < triangles[1] && triangles[1] - triangles[0] < 100.0, "{told}");
    assert!(distances[0] < truth && truth < distances[1] && distances[1] - distances[0] < 4000.0, "{told}");

    let file = |name: &str, text: &str| std::fs::write(folder.join("build").join(name), text).unwrap();
    let part = text(folder.join("build/open_cascade.step"));
    let (start, shell) = part.split_once("CLOSED_SHELL('',(").unwrap();
    file("open.step", &format!("{start}CLOSED_SHELL('',({}", shell.split_once(',').unwrap().1));
    file("other.step", "solid other");
    for (arguments, problem) in [
        (&["none.step"][..], "none.step: the file cannot be opened"),
        (&["other.step"], "other.step: Open CASCADE cannot read it as STEP"),
        (&["open.step"], "open.step: no closed solid is in it"),
        (&["open_cascade.step", "-1"], "the deflection is to be a length"),
    ] {
        let told = kit.try_run(&program, arguments).unwrap_err();
        assert!(told.contains(problem), "{told}");
    }
}

/// The versions that a program may request, and the errors for parts that are not installed.
#[test]
fn what_cmake_finds() {
    let kit = kit();
    if !kit.check.is_plain() || !have("what_cmake_finds", &["cmake"]) {
        return;
    }
    let folder = fresh(kit, "what_cmake_finds");
    let prefix = moved_prefix(kit, &folder, &["--only", "static"]);
    let finds = |arguments: &str| {
        let project = format!(
            "cmake_minimum_required(VERSION 3.15)\nproject(finds LANGUAGES NONE)\n\
             find_package(leafless {arguments})\nif(NOT leafless_FOUND OR NOT TARGET leafless::leafless)\n\
             message(FATAL_ERROR \"not found\")\nendif()\n"
        );
        std::fs::write(folder.join("CMakeLists.txt"), project).unwrap();
        let mut command = Command::new("cmake");
        command.args(["-S", ".", "-B", "build"]).env("CMAKE_PREFIX_PATH", &prefix).current_dir(&folder);
        output(&mut command).is_ok()
    };
    let version = env!("CARGO_PKG_VERSION");
    let [major, minor, patch] = [0, 1, 2].map(|k| version.split('.').nth(k).unwrap().parse::<u32>().unwrap());
    assert!(finds("") && finds(&format!("{version} EXACT")) && finds(&format!("{major}.{minor}")));
    assert!(finds("REQUIRED COMPONENTS static") && !finds("REQUIRED COMPONENTS shared"));
    for other in [
        format!("{major}.{minor}.{}", patch + 1),
        format!("{major}.{}", minor + 1),
        format!("{}.0", major + 1),
        format!("{version}.1 EXACT"),
    ] {
        assert!(!finds(&other), "{other}");
    }
    if major == 0 && minor > 0 {
        assert!(!finds("0.0"));
    }
}

#[test]
fn part_of_a_cmake_project() {
    let kit = kit();
    if !kit.check.is_plain() || !have("part_of_a_cmake_project", &["cmake"]) {
        return;
    }
    let folder = consumers(kit, "part_of_a_cmake_project");
    std::fs::create_dir(folder.join("subdirectory")).unwrap();
    let project = "packaging/consumers/subdirectory/CMakeLists.txt";
    std::fs::copy(root().join(project), folder.join("subdirectory/CMakeLists.txt")).unwrap();
    let install = [installer(kit).get_program().into(), "--libraries".into(), kit.libraries()];
    let install = install.map(|word| word.to_str().unwrap().to_owned()).join(";");
    let mut configure = Command::new("cmake");
    configure.args(["-S", "subdirectory", "-B", "build"]).arg(format!("-DLEAFLESS_INSTALL={install}"));
    configure.arg(format!("-DLEAFLESS_SOURCE={}", root().display()));
    succeed(configure.env_remove("DESTDIR").current_dir(&folder));
    succeed(Command::new("cmake").args(["--build", "build"]).current_dir(&folder));
    tells_the_volume(kit, &folder.join("build/bored"));
}

#[test]
fn programs_by_pkg_config() {
    let kit = kit();
    if !kit.check.is_plain() || !have("programs_by_pkg_config", &["pkg-config"]) {
        return;
    }
    let folder = consumers(kit, "programs_by_pkg_config");
    let both = moved_prefix(kit, &folder, &["--libdir", "lib/x86"]);
    let alone = folder.join("alone");
    succeed(installer(kit).arg("--prefix").arg(&alone).args(["--only", "static"]));
    for (name, prefix, package, standard) in [
        ("c_shared", both.join("lib/x86"), &["leafless"][..], Standard::C("c99")),
        ("cpp_shared", both.join("lib/x86"), &["leafless"], CPP17),
        ("c_static", both.join("lib/x86"), &["leafless-static"], Standard::C("c99")),
        // The conventional way. It works only if the static library is the only one.
        ("cpp_static", alone.join("lib"), &["--static", "leafless"], CPP17),
    ] {
        let mut flags = Command::new("pkg-config");
        flags.args(["--cflags", "--libs"]).args(package).env("PKG_CONFIG_PATH", prefix.join("pkgconfig"));
        let flags = succeed(&mut flags);
        let (program, Standard::C(year) | Standard::Cpp(year)) = (folder.join(name), standard);
        let mut command = kit.compiler(standard).unwrap();
        command.arg(format!("-std={year}")).arg(format!("bored.{}", standard.extension()));
        command.args(flags.split_whitespace()).arg(format!("-Wl,-rpath,{}", prefix.display()));
        succeed(command.arg("-o").arg(&program).current_dir(&folder));
        tells_the_volume(kit, &program);
        assert_eq!(loads_the_library(&program), name.ends_with("shared"), "{name}");
    }
    let version = |package| {
        let mut ask = Command::new("pkg-config");
        ask.args(["--modversion", package]).env("PKG_CONFIG_PATH", both.join("lib/x86/pkgconfig"));
        succeed(&mut ask)
    };
    assert_eq!(
        [version("leafless"), version("leafless-static")],
        [env!("CARGO_PKG_VERSION"); 2].map(|v| format!("{v}\n"))
    );
}

/// The command lines of `include/README.md` work word by word, with a substitute for `cargo`.
#[test]
fn documented_commands() {
    let kit = kit();
    if !kit.check.is_plain() || !have("documented_commands", &["cmake", "pkg-config"]) {
        return;
    }
    let clone = fresh(kit, "documented");
    let elsewhere = consumers(kit, "documented_elsewhere");
    // The repository as the commands see it.
    std::fs::create_dir_all(clone.join("target")).unwrap();
    for (name, place) in [
        ("include", root().join("include")),
        ("examples", root().join("examples")),
        ("target/release", kit.libraries()),
    ] {
        std::os::unix::fs::symlink(place, clone.join(name)).unwrap();
    }
    cargo_that_installs(kit, &clone.join("bin"));
    let path = format!("{}:{}", clone.join("bin").display(), std::env::var("PATH").unwrap());
    let shell = |script: &str, folder: &Path| {
        let mut shell = Command::new("sh");
        shell.arg("-c").arg(script).current_dir(folder).env_remove("LD_LIBRARY_PATH").env_remove("DESTDIR");
        let told = shell.env("PATH", &path).env("HOME", clone.join("home")).output().unwrap();
        let problems = String::from_utf8_lossy(&told.stderr).into_owned();
        assert!(told.status.success(), "{script}\n{problems}");
        assert!(problems.is_empty(), "{script}\n{problems}");
        String::from_utf8(told.stdout).unwrap()
    };
    let readme = text("include/README.md");
    let (in_clone, installed) = readme.split_once("## Installation").unwrap();
    let mut compiled = 0;
    for (section, folder) in [(in_clone, &clone), (installed, &elsewhere)] {
        let mut environment = String::new();
        for line in kit::documented(section) {
            if line.starts_with("cargo cinstall") {
                continue;
            }
            if line.starts_with("export ") {
                environment += &format!("{line}\n");
                continue;
            }
            shell(&format!("{environment}{line}"), folder);
            if line.starts_with("gcc ") || line.starts_with("g++ ") {
                let program = line.split_whitespace().last().unwrap();
                assert!(!shell(&format!("./{program}"), folder).is_empty());
                compiled += 1;
            }
        }
    }
    let programs =
        ["build/bored_c_static", "build/bored_cpp_shared", "bored_static", "bored_shared", "bored_by_path"];
    for program in programs {
        tells_the_volume(kit, &elsewhere.join(program));
        assert_eq!(loads_the_library(&elsewhere.join(program)), program.ends_with("shared"), "{program}");
    }
    // In the clone a C program with each library, and a C++ program; elsewhere a C++ program in three ways.
    assert!(compiled >= 6, "{compiled}");
    // After the first command, two are for CMake, two for each library by pkg-config, and one is for paths.
    let lines = kit::documented(installed);
    let count = |start: &str| lines.iter().filter(|line| line.starts_with(start)).count();
    assert_eq!([count("cargo run"), count("cmake"), count("export"), count("g++")], [1, 2, 1, 3]);
}

/// A plugin exports only its own functions, as `include/README.md` says, and works.
#[test]
#[cfg(target_os = "linux")]
fn plugin() {
    let kit = kit();
    if !kit.check.is_plain() {
        return;
    }
    let folder = fresh(kit, "plugin");
    let mut command = kit.compiler(Standard::C("c99")).unwrap();
    command.args(["-std=c99", "-fPIC", "-shared", "-o", "libplugin.so", "-I"]).arg(root().join("include"));
    command.arg(root().join("packaging/consumers/plugin.c")).arg(kit.libraries().join("libleafless.a"));
    command.arg("-Wl,--exclude-libs,ALL").args(kit.native_libraries.split_whitespace());
    succeed(command.current_dir(&folder));
    let exports =
        succeed(Command::new("nm").args(["-D", "--defined-only", "libplugin.so"]).current_dir(&folder));
    let exports: Vec<&str> = exports.lines().filter_map(|line| line.split_whitespace().last()).collect();
    assert_eq!(exports, ["plugin_volume"]);
    let host = "double plugin_volume(double radius);\n\
                int main(void) { double v = plugin_volume(0.75); return !(1.5 < v && v < 2.0); }\n";
    std::fs::write(folder.join("host.c"), host).unwrap();
    let mut command = kit.compiler(Standard::C("c99")).unwrap();
    command.args(["host.c", "-o", "host", "-L.", "-lplugin"]).arg(format!("-Wl,-rpath,{}", folder.display()));
    succeed(command.current_dir(&folder));
    kit.run(&folder.join("host"), &[]);
}

/// A program may contain another static library made by the same rustc. With the shared library, it may
/// contain any other.
#[test]
#[cfg(target_os = "linux")]
fn beside_another_library_of_rust() {
    let kit = kit();
    if !kit.check.is_plain() {
        return;
    }
    let folder = fresh(kit, "two_of_rust");
    // The other library starts a thread and catches a panic, so that both libraries need the same parts of
    // Rust's.
    let other = "#[unsafe(no_mangle)]
pub extern \"C\" fn other_caught() -> bool { std::thread::spawn(|| panic!(\"caught\")).join().is_err() }";
    let program = "#include <leafless.h>
#include <stdbool.h>
bool other_caught(void);
int main(void) { return other_caught() && leafless_test_panic() == LEAFLESS_E_PANIC ? 0 : 1; }";
    std::fs::write(folder.join("other.rs"), other).unwrap();
    std::fs::write(folder.join("program.c"), program).unwrap();
    let libraries = kit.libraries();
    let make = |options: &[&str], library: &str| {
        let mut rustc = kit.rust("rustc");
        rustc.args(["--edition", "2024", "--crate-type", "staticlib", "other.rs"]).args(options);
        succeed(rustc.current_dir(&folder));
        let mut command = kit.compiler(Standard::C("c99")).unwrap();
        command.arg("-I").arg(root().join("include")).args(["-DLEAFLESS_TEST", "-o", "program", "program.c"]);
        command.arg("-L.").arg(format!("-L{}", libraries.display()));
        command.args(["-lother", library]).args(kit.native_libraries.split_whitespace());
        command.arg(format!("-Wl,-rpath,{}", libraries.display())).current_dir(&folder);
        output(&mut command).map(|_| kit.run(&folder.join("program"), &[])).map(|_| ())
    };
    assert_eq!(make(&[], "-l:libleafless.a"), Ok(()));
    // Optimised as a whole, the other library contains a part of Rust's standard library that cannot be left
    // out.
    let whole = ["-Clto=fat", "-Copt-level=1"];
    assert!(make(&whole, "-l:libleafless.a").is_err_and(|told| told.contains("rust_eh_personality")));
    assert_eq!(make(&whole, "-lleafless"), Ok(()));
}

/// The port for vcpkg, with substitutes for vcpkg's functions.
#[test]
fn vcpkg_port() {
    let kit = kit();
    if !kit.check.is_plain() || !have("vcpkg_port", &["cmake"]) {
        return;
    }
    let folder = fresh(kit, "vcpkg_port");
    let cargo = cargo_that_installs(kit, &folder);
    for (linkage, library) in [("static", "libleafless.a"), ("dynamic", "libleafless.so")] {
        let packages = folder.join(linkage);
        let script = format!(
            "cmake_minimum_required(VERSION 3.21)
function(vcpkg_execute_required_process)
  cmake_parse_arguments(PARSE_ARGV 0 it \"\" \"WORKING_DIRECTORY;LOGNAME\" \"COMMAND\")
  execute_process(COMMAND ${{it_COMMAND}} WORKING_DIRECTORY ${{it_WORKING_DIRECTORY}} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
function(vcpkg_fixup_pkgconfig)
endfunction()
function(vcpkg_install_copyright)
  cmake_parse_arguments(PARSE_ARGV 0 it \"\" \"\" \"FILE_LIST\")
  file(COPY ${{it_FILE_LIST}} DESTINATION \"${{CURRENT_PACKAGES_DIR}}/share/leafless\")
endfunction()
set(port \"{}\")
file(READ \"${{port}}/vcpkg.json\" manifest)
string(JSON PORT GET \"${{manifest}}\" name)
string(JSON version GET \"${{manifest}}\" version)
if(NOT \"${{PORT}} ${{version}}\" STREQUAL \"leafless {}\")
  message(FATAL_ERROR \"${{manifest}}\")
endif()
set(VCPKG_LIBRARY_LINKAGE {linkage})
set(CURRENT_PACKAGES_DIR \"{}\")
set(CARGO \"{}\")
include(\"${{port}}/portfile.cmake\")\n",
            root().join("packaging/vcpkg").display(),
            env!("CARGO_PKG_VERSION"),
            packages.display(),
            cargo.display(),
        );
        std::fs::write(folder.join("port.cmake"), script).unwrap();
        succeed(Command::new("cmake").arg("-P").arg(folder.join("port.cmake")).env_remove("DESTDIR"));
        for file in
            ["share/leafless/leafless-config.cmake", "share/leafless/usage", "share/leafless/LICENSE-MIT"]
        {
            assert!(packages.join(file).is_file(), "{file}");
        }
        let libraries: Vec<bool> = ["libleafless.a", "libleafless.so"]
            .iter()
            .map(|name| packages.join("lib").join(name).exists())
            .collect();
        assert_eq!(libraries, [library.ends_with(".a"), library.ends_with(".so")]);
        assert!(!packages.join("share/licenses").exists() && !packages.join("lib/cmake").exists());
    }
}

/// The prefix that `cargo cinstall` fills has all that programs in C and C++ need.
#[test]
#[cfg(target_os = "linux")]
fn installed_by_cargo_c() {
    let kit = kit();
    if !kit.check.is_plain() || !have("installed_by_cargo_c", &["cargo-cinstall", "pkg-config"]) {
        return;
    }
    let folder = consumers(kit, "installed_by_cargo_c");
    let prefix = folder.join("prefix");
    let documented = kit::documented(&text("include/README.md"));
    let line = documented.iter().find(|line| line.starts_with("cargo cinstall")).expect("a documented line");
    let words = line.split_whitespace().skip(1);
    let words = words.map(|word| if word.starts_with('/') { prefix.as_os_str() } else { word.as_ref() });
    succeed(kit.rust("cargo").args(words).arg("--libdir").arg("lib"));
    // The same files as from this repository's program, except those of CMake and of the static library
    // alone.
    let files = |prefix: &Path| {
        let told = succeed(Command::new("find").args([".", "!", "-type", "d"]).current_dir(prefix));
        let mut files: Vec<String> = told.lines().map(str::to_owned).collect();
        files.retain(|file| !["cmake", "licenses", "-static.pc"].iter().any(|word| file.contains(word)));
        files.sort();
        files
    };
    let ours = moved_prefix(kit, &folder, &[]);
    assert_eq!(files(&prefix), files(&ours));
    for name in ["include/leafless.h", "include/leafless.hpp"] {
        assert_eq!(text(prefix.join(name)), text(name));
    }
    let mut flags = Command::new("pkg-config");
    flags.args(["--cflags", "--libs", "leafless"]).env("PKG_CONFIG_PATH", prefix.join("lib/pkgconfig"));
    let (flags, program) = (succeed(&mut flags), folder.join("bored"));
    let mut command = kit.compiler(CPP17).unwrap();
    command.args(["-std=c++17", "bored.cpp"]).args(flags.split_whitespace()).current_dir(&folder);
    command.arg(format!("-Wl,-rpath,{}", prefix.join("lib").display()));
    succeed(command.arg("-o").arg(&program));
    tells_the_volume(kit, &program);
}
