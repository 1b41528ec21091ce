//! Memory and thread checkers that the programs can run under: `LEAFLESS_C_CHECK`.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The checker of the programs.
#[derive(Clone, Copy, PartialEq)]
pub enum Check {
    /// No checker.
    Plain,
    /// AddressSanitizer and UndefinedBehaviorSanitizer in the programs. In the library, only allocations are
    /// checked.
    Address,
    /// AddressSanitizer in the library, too. It needs a nightly toolchain.
    AddressAll,
    /// ThreadSanitizer in programs and library. It needs a nightly toolchain.
    Thread,
    Valgrind,
}

impl Check {
    pub fn from_environment() -> Result<Check, String> {
        match std::env::var("LEAFLESS_C_CHECK").as_deref() {
            Err(_) | Ok("") => Ok(Check::Plain),
            Ok("address") => Ok(Check::Address),
            Ok("address-all") => Ok(Check::AddressAll),
            Ok("thread") => Ok(Check::Thread),
            Ok("valgrind") => Ok(Check::Valgrind),
            Ok(other) => {
                Err(format!("LEAFLESS_C_CHECK={other}: should be address, address-all, thread or valgrind"))
            }
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Check::Plain => "plain",
            Check::Address => "address",
            Check::AddressAll => "address-all",
            Check::Thread => "thread",
            Check::Valgrind => "valgrind",
        }
    }

    pub fn is_plain(self) -> bool {
        self == Check::Plain
    }

    /// True if programs can run in a small address space. Checkers reserve terabytes of it.
    pub fn limits_memory(self) -> bool {
        self.is_plain()
    }

    /// Returns the flags that build the library.
    pub fn rust_flags(self) -> Option<&'static str> {
        match self {
            Check::AddressAll => Some("-Zsanitizer=address -Cunsafe-allow-abi-mismatch=sanitizer"),
            Check::Thread => Some("-Zsanitizer=thread -Cunsafe-allow-abi-mismatch=sanitizer"),
            _ => None,
        }
    }

    /// Returns the flags that compile the programs.
    pub fn compiler_flags(self) -> &'static [&'static str] {
        match self {
            Check::Plain | Check::Valgrind => &[],
            Check::Address => {
                &["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer"]
            }
            Check::AddressAll => &["-fsanitize=address", "-fno-omit-frame-pointer"],
            Check::Thread => &["-fsanitize=thread", "-fno-omit-frame-pointer"],
        }
    }

    /// Returns a symbol that is in every checked program.
    pub fn symbol(self) -> Option<&'static str> {
        match self {
            Check::Plain | Check::Valgrind => None,
            Check::Address | Check::AddressAll => Some("__asan_init"),
            Check::Thread => Some("__tsan_init"),
        }
    }

    /// Returns the name of the toolchain's own runtime, which is newer than the compiler's and serves both.
    pub fn runtime(self) -> Option<&'static str> {
        match self {
            Check::AddressAll => Some("asan"),
            Check::Thread => Some("tsan"),
            _ => None,
        }
    }

    /// Returns the command that runs a program; `folder` has the suppressions.
    pub fn command(self, program: &Path, folder: &Path) -> Command {
        let mut command = match self {
            Check::Valgrind => {
                let mut command = Command::new("valgrind");
                command.args([
                    "-q",
                    "--error-exitcode=9",
                    "--leak-check=full",
                    "--errors-for-leak-kinds=definite,indirect,possible",
                ]);
                command
                    .arg(format!("--suppressions={}", folder.join("valgrind.supp").display()))
                    .arg(program);
                command
            }
            _ => Command::new(program),
        };
        let thread = format!(
            "halt_on_error=1:exitcode=9:allocator_may_return_null=1:suppressions={}",
            folder.join("thread.supp").display()
        );
        command
            .env("ASAN_OPTIONS", "detect_leaks=1:allocator_may_return_null=1:detect_stack_use_after_return=1")
            .env("UBSAN_OPTIONS", "print_stacktrace=1")
            .env("TSAN_OPTIONS", thread);
        command
    }

    /// Returns the factor by which programs may take longer.
    pub fn patience(self) -> u32 {
        if self.is_plain() { 1 } else { 10 }
    }
}

/// Returns the runtime of a sanitizer in the toolchain that builds the library.
pub fn runtime_archive(rustc: &mut Command, name: &str) -> Result<PathBuf, String> {
    let told =
        rustc.args(["--print", "target-libdir"]).output().map_err(|error| format!("rustc: {error}"))?;
    let folder = PathBuf::from(String::from_utf8_lossy(&told.stdout).trim());
    let end = format!("_rt.{name}.a");
    std::fs::read_dir(&folder)
        .map_err(|error| format!("{}: {error}", folder.display()))?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .find(|path| path.to_str().is_some_and(|path| path.ends_with(&end)))
        .ok_or_else(|| format!("there is no *{end} in {}", folder.display()))
}
