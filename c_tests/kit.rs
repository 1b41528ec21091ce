//! Builds the libraries, compiles programs against them, and runs the programs.

use crate::check::{Check, runtime_archive};
use crate::header::Header;
use crate::{root, text};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

#[derive(Clone, Copy)]
pub enum Standard {
    C(&'static str),
    Cpp(&'static str),
}

impl Standard {
    pub fn extension(self) -> &'static str {
        match self {
            Standard::C(_) => "c",
            Standard::Cpp(_) => "cpp",
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
pub enum Link {
    Static,
    Shared,
}

pub struct Kit {
    pub check: Check,
    /// The libraries needed to link programs with the static library, as reported by rustc.
    pub native_libraries: String,
    folder: PathBuf,
    triple: String,
    runtime: Option<PathBuf>,
}

/// Returns the kit. The libraries are built once for all tests.
pub fn kit() -> &'static Kit {
    static KIT: OnceLock<Result<Kit, String>> = OnceLock::new();
    match KIT.get_or_init(Kit::new) {
        Ok(kit) => kit,
        Err(problem) => panic!("{problem}"),
    }
}

/// Returns the lines of all `sh` blocks. Lines continued by a backslash are joined.
pub fn documented(text: &str) -> Vec<String> {
    let blocks = text.split("```sh\n").skip(1).filter_map(|block| block.split_once("```"));
    let joined: String = blocks.map(|(block, _)| block.replace("\\\n", " ")).collect();
    joined
        .lines()
        .map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "))
        .filter(|line| !line.is_empty())
        .collect()
}

/// Reports a skipped test past the test harness, which keeps the output of passing tests.
pub fn skipped(test: &str, reason: &str) {
    let _ = std::io::Write::write_fmt(&mut std::io::stderr(), format_args!("SKIPPED {test}: {reason}\n"));
}

/// Returns a command as one would type it, without its environment.
fn line(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
}

/// Runs a command. Returns its standard output and standard error if it succeeds.
pub fn output(command: &mut Command) -> Result<(String, String), String> {
    let told = command.output().map_err(|error| format!("{}: {error}", line(command)))?;
    let (out, err) = (String::from_utf8_lossy(&told.stdout), String::from_utf8_lossy(&told.stderr));
    match told.status.success() {
        true => Ok((out.into(), err.into())),
        false => Err(format!("{}: {}\n{out}{err}", line(command), told.status)),
    }
}

impl Kit {
    fn new() -> Result<Kit, String> {
        let check = Check::from_environment()?;
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("c_api").join(check.name());
        let mut kit =
            Kit { check, native_libraries: String::new(), folder, triple: String::new(), runtime: None };
        let (version, _) = output(kit.rust("rustc").arg("-vV"))?;
        kit.triple =
            version.lines().find_map(|line| line.strip_prefix("host: ")).ok_or("rustc has no host")?.into();
        for standard in [Standard::C(""), Standard::Cpp("")] {
            // This check runs before the long work: without a compiler these tests fail.
            output(kit.compiler(standard)?.arg("--version")).map_err(|problem| {
                format!("a compiler for C and one for C++ are needed, such as gcc and g++ (or set CC and CXX): {problem}")
            })?;
        }
        kit.write_lists()?;
        kit.build()?;
        if let Some(runtime) = check.runtime() {
            kit.runtime = Some(runtime_archive(&mut kit.rust("rustc"), runtime)?);
        }
        Ok(kit)
    }

    /// The toolchain that builds the library.
    pub fn rust(&self, program: &str) -> Command {
        let mut command = match (self.check.rust_flags(), program) {
            (Some(_), _) => {
                let mut command = Command::new("rustup");
                command.args(["run", "nightly", program]);
                command
            }
            (None, "cargo") => Command::new(env!("CARGO")),
            (None, _) => Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| program.into())),
        };
        if let Some(flags) = self.check.rust_flags() {
            // Cargo's settings for this test must not apply to another toolchain.
            for variable in ["RUSTC", "CARGO", "RUSTUP_TOOLCHAIN", "CARGO_ENCODED_RUSTFLAGS"] {
                command.env_remove(variable);
            }
            command.env("RUSTFLAGS", flags).env("CARGO_TARGET_DIR", self.target());
        }
        command.current_dir(root());
        command
    }

    /// Builds both libraries, with the function that panics. The build has the same features of all packages
    /// as `cargo test`, so that only the interface is left to compile.
    fn build(&mut self) -> Result<(), String> {
        let mut command = self.rust("cargo");
        command.args(["build", "--lib", "--features", "leafless-capi/test"]);
        match self.profile() {
            "debug" => command.args(["--profile", "test"]),
            profile => command.args(["--profile", profile]),
        };
        if self.check.rust_flags().is_some() {
            // Build scripts and macros run on the host, without a sanitizer.
            command.args(["--package", "leafless-capi", "--target", &self.triple]);
        } else {
            command.args(["--test", "c_api"]);
        }
        output(&mut command)?;
        // The library needs the libraries that the standard library needs.
        // (Other processes may be at it, too.)
        let native = self.folder(&format!("native/{}", std::process::id()));
        let source = native.join("empty.rs");
        std::fs::write(&source, "").map_err(|error| error.to_string())?;
        let mut rustc = self.rust("rustc");
        rustc.args(["--crate-type", "staticlib", "--print", "native-static-libs", "--out-dir"]);
        let (_, told) = output(rustc.arg(native).arg(source))?;
        let list = told.lines().find_map(|line| line.split_once("native-static-libs: "));
        self.native_libraries = list.ok_or("rustc names no native libraries")?.1.trim().into();
        let (library, name) =
            (self.libraries().join("libleafless.so"), self.libraries().join("libleafless.so.0"));
        if library.exists() && !name.exists() {
            std::os::unix::fs::symlink("libleafless.so", name).map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    /// Writes `symbols.h` and `layout.h`, which are made from the header.
    fn write_lists(&self) -> Result<(), String> {
        let header = Header::read(&text("include/leafless.h"));
        let mut symbols = String::new();
        for function in &header.functions {
            let _ = writeln!(symbols, "FUNCTION({})", function.name);
        }
        let mut layout = String::new();
        for (name, fields) in &header.structs {
            let _ = writeln!(layout, "STRUCT({name})");
            for field in fields {
                let _ = writeln!(layout, "FIELD({name}, {})", field.name);
            }
        }
        for value in &header.values {
            let _ = writeln!(layout, "VALUE({value})");
        }
        let folder = self.folder("lists");
        for (name, text) in [("symbols.h", symbols), ("layout.h", layout)] {
            std::fs::write(folder.join(name), text).map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    /// Returns the folder of this program's profile.
    fn own(&self) -> PathBuf {
        let program = std::env::current_exe().unwrap_or_default();
        // …/debug/deps/c_api-…
        program.ancestors().nth(2).map(Path::to_owned).unwrap_or_default()
    }

    /// Returns the profile's name.
    fn profile(&self) -> &'static str {
        if self.own().ends_with("release") { "release" } else { "debug" }
    }

    /// Returns the target folder of another toolchain.
    fn target(&self) -> PathBuf {
        Path::new(env!("CARGO_TARGET_TMPDIR")).join("c_api").join(self.check.name()).join("target")
    }

    /// Returns the folder of the libraries.
    pub fn libraries(&self) -> PathBuf {
        match self.check.rust_flags() {
            Some(_) => self.target().join(&self.triple).join(self.profile()),
            None => self.own(),
        }
    }

    /// Returns an existing folder for files of a test.
    pub fn folder(&self, name: &str) -> PathBuf {
        let folder = self.folder.join(name);
        std::fs::create_dir_all(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        folder
    }

    pub fn compiler(&self, standard: Standard) -> Result<Command, String> {
        let mut build = cc::Build::new();
        build.target(&self.triple).host(&self.triple).opt_level(1).debug(true).out_dir(&self.folder);
        build.cargo_metadata(false).cpp(matches!(standard, Standard::Cpp(_)));
        let tool = build.try_get_compiler().map_err(|error| format!("there is no compiler: {error}"))?;
        let mut command = Command::new(tool.path());
        command.args(tool.args());
        Ok(command)
    }

    pub fn compile(&self, name: &str, sources: &[PathBuf], standard: Standard, link: Link) -> PathBuf {
        self.try_compile(name, sources, standard, link).unwrap_or_else(|problem| panic!("{problem}"))
    }

    /// Compiles a program from these sources, in a folder of its own.
    pub fn try_compile(
        &self,
        name: &str,
        sources: &[PathBuf],
        standard: Standard,
        link: Link,
    ) -> Result<PathBuf, String> {
        // With a sanitizer's runtime, only the static library exists.
        let link = if self.runtime.is_some() { Link::Static } else { link };
        let (Standard::C(year) | Standard::Cpp(year)) = standard;
        let folder =
            self.folder(&format!("{name}-{year}-{}", if link == Link::Static { "static" } else { "shared" }));
        let program = folder.join(name);
        let mut command = self.compiler(standard)?;
        command.current_dir(&folder).arg(format!("-std={year}")).args([
            "-Wall",
            "-Wextra",
            "-pedantic",
            "-Werror",
        ]);
        if matches!(standard, Standard::C(_)) {
            command.arg("-Wstrict-prototypes");
        }
        command.args(self.check.compiler_flags()).arg("-DLEAFLESS_TEST");
        command.arg("-I").arg(root().join("include")).arg("-I").arg(root().join("c_tests"));
        command.arg("-I").arg(self.folder("lists"));
        if self.runtime.is_some() {
            // The compiler's own runtime stays out.
            let mut objects = Vec::new();
            for source in sources {
                let object = folder.join(source.file_stem().unwrap_or_default()).with_extension("o");
                let mut one = Command::new(command.get_program());
                one.args(command.get_args())
                    .current_dir(&folder)
                    .arg("-c")
                    .arg(source)
                    .arg("-o")
                    .arg(&object);
                output(&mut one)?;
                objects.push(object);
            }
            command = self.compiler(standard)?;
            command.current_dir(&folder).args(objects);
            if self.check == Check::Thread {
                let object = folder.join("futex.o");
                let mut futex = self.compiler(Standard::C(""))?;
                futex.arg("-c").arg(root().join("c_tests/futex.c")).arg("-o").arg(&object);
                output(&mut futex)?;
                command.arg(object);
            }
        } else {
            command.args(sources);
        }
        let libraries = self.libraries();
        match link {
            Link::Static => {
                command.arg(libraries.join("libleafless.a"));
                if let Some(runtime) = &self.runtime {
                    command
                        .arg("-Wl,--whole-archive")
                        .arg(runtime)
                        .args(["-Wl,--no-whole-archive", "-rdynamic"]);
                }
                command.args(self.native_libraries.split_whitespace());
            }
            Link::Shared => {
                command.arg("-L").arg(&libraries).arg("-lleafless").arg("-lm").arg("-pthread");
                command.arg(format!("-Wl,-rpath,{}", libraries.display()));
            }
        }
        output(command.arg("-o").arg(&program))?;
        Ok(program)
    }

    pub fn run(&self, program: &Path, arguments: &[&str]) -> String {
        self.try_run(program, arguments).unwrap_or_else(|problem| panic!("{problem}"))
    }

    /// Runs a program in its folder, for at most a minute, and returns its output.
    pub fn try_run(&self, program: &Path, arguments: &[&str]) -> Result<String, String> {
        let folder = program.parent().ok_or("a program without a folder")?;
        let printed = folder.join("stdout");
        let problems = folder.join("stderr");
        let file =
            |path: &Path| std::fs::File::create(path).map_err(|error| format!("{}: {error}", path.display()));
        let mut command = self.check.command(program, &root().join("c_tests"));
        // Programs must not look into the folders where cargo keeps libraries for this test.
        command.args(arguments).current_dir(folder).stdin(Stdio::null()).env_remove("LD_LIBRARY_PATH");
        command.stdout(file(&printed)?).stderr(file(&problems)?);
        let mut child = command.spawn().map_err(|error| format!("{}: {error}", line(&command)))?;
        let patience = Duration::from_secs(60) * self.check.patience();
        let start = Instant::now();
        let status = loop {
            match child.try_wait().map_err(|error| error.to_string())? {
                Some(status) => break Some(status),
                None if start.elapsed() > patience => {
                    let _ = child.kill();
                    let _ = child.wait();
                    break None;
                }
                None => std::thread::sleep(Duration::from_millis(5)),
            }
        };
        let read =
            |path: &Path| String::from_utf8_lossy(&std::fs::read(path).unwrap_or_default()).into_owned();
        match status {
            Some(status) if status.success() => Ok(read(&printed)),
            Some(status) => {
                Err(format!("{}: {status}\n{}{}", program.display(), read(&printed), read(&problems)))
            }
            None => Err(format!("{}: not done after {patience:?}\n{}", program.display(), read(&problems))),
        }
    }
}
