//! Installs the C interface: both headers, both libraries, the licences (those of the crates in the
//! libraries, too), and files for CMake and pkg-config.
//!
//! ```text
//! cargo run --release -p leafless-capi -- --prefix /usr/local
//! ```
//!
//! It is a program in Rust because every builder of Leafless has Rust, on every platform. What it installs
//! finds the prefix from its own place, so that the prefix can be moved.

mod notices;

use notices::{Notices, notices};
use std::env::consts::OS;
use std::path::{Component, Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs};

const USAGE: &str = "\
Usage: leafless-install --prefix FOLDER [--libdir FOLDER] [--cmakedir FOLDER]
                        [--only static|shared] [--libraries FOLDER]

  --prefix FOLDER      where to install
  --libdir FOLDER      the folder for libraries inside of the prefix [lib]
  --cmakedir FOLDER    the folder for CMake's files inside of the prefix [LIBDIR/cmake/leafless]
  --only static|shared install one of the two libraries
  --libraries FOLDER   take libraries that are built already from this folder

The environment variable DESTDIR names a folder to put in front of the prefix, as makers of packages need it.";

/// The files that are installed as they are.
const FILES: [(&str, &str); 4] = [
    ("include/leafless.h", include_str!("../include/leafless.h")),
    ("include/leafless.hpp", include_str!("../include/leafless.hpp")),
    ("share/licenses/leafless/LICENSE-APACHE", include_str!("../LICENSE-APACHE")),
    ("share/licenses/leafless/LICENSE-MIT", include_str!("../LICENSE-MIT")),
];

/// The files of which `@NAME@` is filled in: for CMake, and for pkg-config.
const CMAKE: [(&str, &str); 2] = [
    ("leafless-config.cmake", include_str!("templates/leafless-config.cmake")),
    ("leafless-config-version.cmake", include_str!("templates/leafless-config-version.cmake")),
];
const PKG_CONFIG: [(&str, &str); 2] = [
    ("leafless.pc", include_str!("templates/leafless.pc")),
    ("leafless-static.pc", include_str!("templates/leafless-static.pc")),
];

/// Where the notices of what the libraries contain are installed.
const THIRD_PARTY: &str = "share/licenses/leafless/THIRD-PARTY.txt";
const STANDARD_LIBRARY: &str = "share/licenses/leafless/RUST-STANDARD-LIBRARY.html";

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What one platform calls the libraries.
struct Names {
    archive: &'static str,
    /// The shared library as cargo builds it and as linkers look for it, and the name that programs look for.
    shared: &'static str,
    loaded: &'static str,
    /// The name of the installed file, to which the other two are links.
    versioned: String,
    /// On Windows programs are linked to another file than they load, and the latter lies beside programs.
    import: Option<&'static str>,
}

impl Names {
    /// Only the names on Linux have been tried.
    fn of_platform() -> Names {
        let (archive, shared, import) = match OS {
            "windows" if cfg!(target_env = "msvc") => {
                ("leafless.lib", "leafless.dll", Some("leafless.dll.lib"))
            }
            "windows" => ("libleafless.a", "leafless.dll", Some("libleafless.dll.a")),
            "macos" => ("libleafless.a", "libleafless.dylib", None),
            _ => ("libleafless.a", "libleafless.so", None),
        };
        // The build script gives the library the name under which it is loaded.
        let loaded = option_env!("LEAFLESS_SONAME").unwrap_or(shared);
        let versioned = match OS {
            "windows" => shared.into(),
            "macos" => format!("libleafless.{VERSION}.dylib"),
            _ => format!("libleafless.so.{VERSION}"),
        };
        Names { archive, shared, loaded, versioned, import }
    }
}

#[derive(Default)]
struct Options {
    prefix: PathBuf,
    libdir: PathBuf,
    cmakedir: PathBuf,
    libraries: Option<PathBuf>,
    without_static: bool,
    without_shared: bool,
}

impl Options {
    fn read(mut arguments: impl Iterator<Item = String>) -> Result<Options, String> {
        let mut options = Options { libdir: "lib".into(), ..Options::default() };
        let mut cmakedir = None;
        while let Some(argument) = arguments.next() {
            let (name, value) = match argument.split_once('=') {
                Some((name, value)) => (name, Some(value.to_owned())),
                None => (argument.as_str(), arguments.next()),
            };
            let value =
                value.filter(|value| !value.is_empty()).ok_or(format!("{name} needs a value\n{USAGE}"));
            match name {
                "--prefix" => options.prefix = value?.into(),
                "--libdir" => options.libdir = value?.into(),
                "--cmakedir" => cmakedir = Some(value?.into()),
                "--libraries" => options.libraries = Some(value?.into()),
                "--only" => match value?.as_str() {
                    "static" => options.without_shared = true,
                    "shared" => options.without_static = true,
                    other => return Err(format!("--only {other}: should be static or shared")),
                },
                _ => return Err(format!("{name} is not known\n{USAGE}")),
            }
        }
        if options.prefix.as_os_str().is_empty() {
            return Err(format!("--prefix is missing\n{USAGE}"));
        }
        let problem = |error| format!("{}: {error}", options.prefix.display());
        options.prefix = std::path::absolute(&options.prefix).map_err(problem)?;
        // Makers of packages name whole paths, too.
        let inside = |folder: PathBuf| match folder.strip_prefix(&options.prefix).unwrap_or(&folder) {
            // The installed files count the folders up to the prefix.
            inner if inner.components().all(|part| matches!(part, Component::Normal(_))) => {
                Ok(inner.to_owned())
            }
            _ => Err(format!("{}: is no folder in the prefix", folder.display())),
        };
        options.libdir = inside(options.libdir.clone())?;
        options.cmakedir = match cmakedir {
            Some(folder) => inside(folder)?,
            None => options.libdir.join("cmake/leafless"),
        };
        Ok(options)
    }
}

/// The files of an installation, below `root`.
struct Target {
    root: PathBuf,
}

impl Target {
    /// Makes a file at a place in the prefix. An older one is removed, not overwritten: programs may be using
    /// it.
    fn put(&self, place: &Path, make: impl FnOnce(&Path) -> std::io::Result<()>) -> Result<(), String> {
        let path = self.root.join(place);
        let folder = path.parent().expect("a file in the prefix");
        let made = fs::create_dir_all(folder)
            .and_then(|()| match fs::remove_file(&path) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error),
                _ => make(&path),
            })
            .map_err(|error| format!("{}: {error}", path.display()));
        println!("{}", path.display());
        made
    }

    fn copy(&self, from: &Path, place: &Path) -> Result<(), String> {
        if !from.is_file() {
            return Err(format!("{}: there is no such library", from.display()));
        }
        self.put(place, |path| fs::copy(from, path).map(|_| ()))
    }

    /// A link to another name in the same folder.
    fn link(&self, name: &str, place: &Path) -> Result<(), String> {
        #[cfg(unix)]
        return self.put(place, |path| std::os::unix::fs::symlink(name, path));
        #[cfg(not(unix))]
        self.copy(&self.root.join(place.with_file_name(name)), place)
    }
}

/// Builds the libraries, by the profile of this program, which then lies beside them. Returns their folder.
fn build() -> Result<PathBuf, String> {
    let own = env::current_exe().map_err(|error| error.to_string())?;
    let folder = own.parent().unwrap_or(Path::new(""));
    let profile = match folder.file_name().and_then(|name| name.to_str()) {
        Some("debug") => "dev",
        Some(profile) => profile,
        None => return Err(format!("{}: is in no folder of cargo's", own.display())),
    };
    let mut command = Command::new(env::var_os("CARGO").unwrap_or("cargo".into()));
    command.args(["build", "--profile", profile, "--package", "leafless-capi", "--lib"]);
    command.current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."));
    let status = command.status().map_err(|error| format!("cargo: {error}"))?;
    status.success().then(|| folder.to_owned()).ok_or(format!("the libraries could not be built: {status}"))
}

/// The system's libraries that a program with the static library needs. They are those of Rust's standard
/// library, because Leafless itself is linked to nothing else; so an empty library tells them at once.
fn native_libraries() -> Result<String, String> {
    let folder = env::temp_dir().join(format!("leafless-install-{}", std::process::id()));
    let told =
        fs::create_dir_all(&folder).and_then(|()| fs::write(folder.join("empty.rs"), "")).and_then(|()| {
            Command::new(env::var_os("RUSTC").unwrap_or("rustc".into()))
                .args(["--crate-type", "staticlib", "--print", "native-static-libs", "empty.rs"])
                .current_dir(&folder)
                .output()
        });
    let _ = fs::remove_dir_all(&folder);
    let told = String::from_utf8_lossy(&told.map_err(|error| format!("rustc: {error}"))?.stderr).into_owned();
    let list = told.lines().find_map(|line| line.split_once("native-static-libs: "));
    Ok(list.ok_or(format!("rustc names no native libraries: {told}"))?.1.trim().to_owned())
}

fn install(options: &Options) -> Result<(), String> {
    let libraries = options.libraries.clone().map_or_else(build, Ok)?;
    let root = match env::var_os("DESTDIR").filter(|folder| !folder.is_empty()) {
        Some(folder) => {
            let inner = options.prefix.components().filter(|part| matches!(part, Component::Normal(_)));
            Path::new(&folder).join(inner.collect::<PathBuf>())
        }
        None => options.prefix.clone(),
    };
    let (target, names, lib) = (Target { root }, Names::of_platform(), &options.libdir);
    let mut programs_load = lib.clone();
    if names.import.is_some() {
        programs_load = "bin".into();
    }
    for (place, text) in FILES {
        target.put(Path::new(place), |path| fs::write(path, text))?;
    }
    let Notices { crates, standard_library } = notices()?;
    target.put(Path::new(THIRD_PARTY), |path| fs::write(path, crates))?;
    if let Some(text) = standard_library {
        target.put(Path::new(STANDARD_LIBRARY), |path| fs::write(path, text))?;
    }
    if !options.without_static {
        target.copy(&libraries.join(names.archive), &lib.join(names.archive))?;
    }
    if !options.without_shared {
        target.copy(&libraries.join(names.shared), &programs_load.join(&names.versioned))?;
        for link in [names.loaded, names.shared] {
            if link != names.versioned {
                target.link(&names.versioned, &programs_load.join(link))?;
            }
        }
        if let Some(import) = names.import {
            target.copy(&libraries.join(import), &lib.join(import))?;
        }
    }

    let slashes = |path: &Path| path.to_string_lossy().replace('\\', "/");
    let native = native_libraries()?;
    let values = [
        ("@VERSION@", VERSION.to_owned()),
        ("@POINTER@", size_of::<usize>().to_string()),
        ("@LIBDIR@", slashes(lib)),
        ("@ARCHIVE@", names.archive.to_owned()),
        ("@SHARED@", slashes(&programs_load.join(names.loaded))),
        ("@IMPORT@", slashes(&lib.join(names.import.unwrap_or_default()))),
        ("@NATIVE@", native.clone()),
        ("@NATIVE_LIST@", native.split_whitespace().collect::<Vec<_>>().join(";")),
    ];
    for (folder, templates) in [(&options.cmakedir, CMAKE), (&lib.join("pkgconfig"), PKG_CONFIG)] {
        let up = vec![".."; folder.components().count()].join("/");
        for (name, template) in templates {
            if options.without_static && name == "leafless-static.pc" {
                continue;
            }
            let text = template.replace("@UP@", &up);
            let text = values.iter().fold(text, |text, (name, value)| text.replace(name, value));
            target.put(&folder.join(name), |path| fs::write(path, text))?;
        }
    }
    Ok(())
}

fn main() -> ExitCode {
    match Options::read(env::args().skip(1)).and_then(|options| install(&options)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("leafless-install: {problem}");
            ExitCode::FAILURE
        }
    }
}
