//! The licences of what the libraries are made of: every crate that is linked into them, as cargo tells it
//! where they are built. Nothing is downloaded.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// What names of files with licences begin with.
const NAMES: [&str; 6] = ["LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE"];

/// The notices of Rust's standard library, in the folder of the toolchain.
const STANDARD: &str = "share/doc/rust/COPYRIGHT-library.html";

/// What is to be installed.
pub struct Notices {
    /// A list of all crates, and the texts of their licences.
    pub crates: String,
    /// The notices of Rust's standard library; none if the toolchain came without them, which `crates` then
    /// says.
    pub standard_library: Option<String>,
}

struct Crate {
    name: String,
    version: String,
    licence: String,
}

fn told(program: &str, variable: &str, arguments: &[&str]) -> Result<String, String> {
    let mut command = Command::new(env::var_os(variable).unwrap_or(program.into()));
    command.args(arguments).current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."));
    let output = command.output().map_err(|error| format!("{program}: {error}"))?;
    if !output.status.success() {
        return Err(format!(
            "{program} {}: {}",
            arguments.join(" "),
            String::from_utf8_lossy(&output.stderr)
        ));
    }
    String::from_utf8(output.stdout).map_err(|_| format!("{program} {}: no text", arguments.join(" ")))
}

/// All crates that are linked, but those of this workspace.
fn linked() -> Result<Vec<Crate>, String> {
    let tree = told(
        "cargo",
        "CARGO",
        &[
            "tree",
            "--package=leafless-capi",
            "--edges=normal,no-proc-macro",
            "--target",
            env!("LEAFLESS_TARGET"),
            "--prefix=none",
            "--no-dedupe",
            "--format={p}\t{l}",
            "--offline",
            "--locked",
        ],
    )?;
    let mut crates = BTreeMap::new();
    for line in tree.lines() {
        let (package, licence) = line.split_once('\t').ok_or(format!("cargo tree: {line}: no licence"))?;
        // A package is a name and a version; a folder behind them says that it lies in this workspace.
        let mut words = package.split_whitespace();
        let (Some(name), Some(version), None) = (words.next(), words.next(), words.next()) else { continue };
        crates.insert((name.to_owned(), version.trim_start_matches('v').to_owned()), licence.to_owned());
    }
    if crates.is_empty() {
        return Err("cargo tree tells of no crates".into());
    }
    Ok(crates.into_iter().map(|((name, version), licence)| Crate { name, version, licence }).collect())
}

/// The value of a key of a manifest's first section, which is `[package]` wherever cargo has written it.
fn value<'m>(manifest: &'m str, key: &str) -> Option<&'m str> {
    let package = manifest.split_once("[package]")?.1;
    let package = package.split("\n[").next()?;
    package.lines().find_map(|line| {
        let (found, value) = line.split_once('=')?;
        (found.trim() == key).then(|| value.trim().trim_matches('"'))
    })
}

/// What cargo knows of the crates in the libraries. The question is put by a package that depends on the C
/// interface alone: in the workspace cargo would first download what only tests and benchmarks need.
fn metadata(asking: &Path) -> Result<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let manifest = format!(
        "[package]\nname = \"leafless-notices\"\nedition = \"2024\"\n[lib]\npath = \"lib.rs\"\n\
         [dependencies]\nleafless-capi = {{ path = {:?} }}\n[workspace]\n",
        env!("CARGO_MANIFEST_DIR")
    );
    let made = fs::create_dir_all(asking)
        .and_then(|()| fs::write(asking.join("lib.rs"), ""))
        .and_then(|()| fs::write(asking.join("Cargo.toml"), manifest))
        .and_then(|()| fs::copy(root.join("Cargo.lock"), asking.join("Cargo.lock")));
    made.map_err(|error| format!("{}: {error}", asking.display()))?;
    let manifest = asking.join("Cargo.toml");
    let manifest = manifest.to_str().ok_or(format!("{}: no UTF-8", manifest.display()))?;
    told(
        "cargo",
        "CARGO",
        &[
            "metadata",
            "--format-version=1",
            "--filter-platform",
            env!("LEAFLESS_TARGET"),
            "--offline",
            "--manifest-path",
            manifest,
        ],
    )
}

/// The folder of each crate by its name and version.
fn folders() -> Result<BTreeMap<(String, String), PathBuf>, String> {
    let asking = env::temp_dir().join(format!("leafless-notices-{}", std::process::id()));
    let metadata = metadata(&asking);
    let _ = fs::remove_dir_all(&asking);
    let metadata = metadata?;
    let mut folders = BTreeMap::new();
    // One field is all that is needed of the JSON. In its strings a backslash stands before quotes and
    // backslashes. (The package that asked is gone.)
    for rest in metadata.split("\"manifest_path\":\"").skip(1) {
        let path = PathBuf::from(rest.split('"').next().unwrap_or_default().replace("\\\\", "\\"));
        if path.parent().and_then(Path::file_name) == asking.file_name() {
            continue;
        }
        let manifest = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        if let (Some(name), Some(version), Some(folder)) =
            (value(&manifest, "name"), value(&manifest, "version"), path.parent())
        {
            folders.insert((name.to_owned(), version.to_owned()), folder.to_owned());
        }
    }
    Ok(folders)
}

/// The files with licences in the folder of a crate, by their names.
fn texts(folder: &Path) -> Result<Vec<(String, String)>, String> {
    let problem = |error| format!("{}: {error}", folder.display());
    let mut texts = Vec::new();
    for entry in fs::read_dir(folder).map_err(problem)? {
        let path = entry.map_err(problem)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let is_licence = NAMES.iter().any(|start| name.to_uppercase().starts_with(start));
        if is_licence && path.is_file() {
            let bytes = fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
            texts.push((name, String::from_utf8_lossy(&bytes).replace("\r\n", "\n").trim_end().to_owned()));
        }
    }
    texts.sort();
    Ok(texts)
}

/// Finds out the notices.
pub fn notices() -> Result<Notices, String> {
    let (crates, folders) = (linked()?, folders()?);
    let compiler = told("rustc", "RUSTC", &["--version"])?;
    let sysroot = told("rustc", "RUSTC", &["--print=sysroot"])?;
    let standard_library = fs::read_to_string(Path::new(sysroot.trim()).join(STANDARD)).ok();

    let mut list = String::from(
        "The Leafless libraries contain the software below. Leafless itself is under the licences beside this file.\n\n",
    );
    let beside = match standard_library {
        Some(_) => "its notices lie beside this file",
        None => "the toolchain came without its notices: see https://www.rust-lang.org/policies/licenses",
    };
    // Writing to a string does not fail.
    let _ = writeln!(list, "Rust's standard library ({}): MIT OR Apache-2.0; {beside}", compiler.trim());
    // Many crates have the same text.
    let mut all: Vec<(String, Vec<String>)> = Vec::new();
    for Crate { name, version, licence } in crates {
        let folder = folders
            .get(&(name.clone(), version.clone()))
            .ok_or(format!("cargo does not tell where {name} {version} lies"))?;
        let found = texts(folder)?;
        if licence.is_empty() && found.is_empty() {
            return Err(format!("{}: neither the name of a licence nor its text", folder.display()));
        }
        let licence = if licence.is_empty() { "see its text" } else { &licence };
        let without = if found.is_empty() { " (the crate comes without a text)" } else { "" };
        let _ = writeln!(list, "{name} {version}: {licence}{without}");
        for (file, text) in found {
            let user = format!("{name} {version} ({file})");
            match all.iter_mut().find(|(known, _)| *known == text) {
                Some((_, users)) => users.push(user),
                None => all.push((text, vec![user])),
            }
        }
    }
    for (text, users) in all {
        let _ = writeln!(list, "\n{}\n{}\n\n{text}", "-".repeat(80), users.join("\n"));
    }
    Ok(Notices { crates: list, standard_library })
}
