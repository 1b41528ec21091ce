//! Outputs: a file, written completely or not at all, or standard output.

pub mod csv;
pub mod npz;
pub mod records;
pub mod written;

use crate::failure::{Failure, Of, Problem};
use crate::source::input::Input;
use leafless::exchange::MeshFormat;
use leafless::{Error, Octree, TriDexel, file};
use serde::Serialize;
use std::ffi::OsStr;
use std::fmt;
use std::io::{BufWriter, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// The destination of a result: a file, or standard output for the name `-`.
#[derive(Debug, Clone)]
pub enum Output {
    /// `-`
    Standard,
    /// A path.
    Path(PathBuf),
}

impl From<&OsStr> for Output {
    fn from(name: &OsStr) -> Output {
        if name == "-" { Output::Standard } else { Output::Path(name.into()) }
    }
}

impl fmt::Display for Output {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Output::Standard => f.write_str("standard output"),
            Output::Path(path) => path.display().fmt(f),
        }
    }
}

impl Output {
    /// Returns the path, unless the output is standard output.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Output::Standard => None,
            Output::Path(path) => Some(path),
        }
    }

    /// Reports failures that can be foreseen before the work is done.
    pub fn check(&self) -> Result<(), Failure> {
        let Output::Path(path) = self else {
            if std::io::stdout().is_terminal() {
                return Err(Failure::of(self, "is a terminal, where the bytes of a solid are of no use"));
            }
            return Ok(());
        };
        if path.is_dir() {
            return Err(Failure::of(self, "is a folder; name a file"));
        }
        match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
                Err(Failure::of(self, format_args!("there is no folder {}", folder.display())))
            }
            _ => Ok(()),
        }
    }

    /// Refuses an output that is the input itself and would be overwritten; `what` names the input.
    pub fn check_spares(&self, input: &Input, what: &str) -> Result<(), Failure> {
        if let (Some(from), Some(to)) = (input.path(), self.path())
            && from.canonicalize().is_ok_and(|from| to.canonicalize().is_ok_and(|to| from == to))
        {
            return Err(Failure::of(self, format_args!("is the {what} itself, which is not overwritten")));
        }
        Ok(())
    }

    /// Refuses the name of a mesh for a solid (.lfl): no program would look for a solid there.
    pub fn check_name(&self) -> Result<(), Failure> {
        let extension = self.path().and_then(|path| path.extension()?.to_str());
        if extension.is_some_and(|extension| MeshFormat::from_extension(extension).is_some()) {
            let problem = "its name is that of a mesh, and a solid is written (.lfl); `leafless mesh` and `convert` make meshes";
            return Err(Failure::Usage(format!("{self}: {problem}")));
        }
        Ok(())
    }

    /// Writes all bytes or nothing.
    pub fn write(&self, bytes: &[u8]) -> Result<(), Failure> {
        match self {
            Output::Standard => print(bytes),
            Output::Path(path) => write_file(path, bytes),
        }
    }

    /// Writes a result without holding all its bytes in memory, and returns their number.
    pub fn stream(&self, write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> Result<u64, Failure> {
        let Some(path) = self.path() else {
            let mut out = Counter { out: BufWriter::new(std::io::stdout().lock()), count: 0 };
            write(&mut out).and_then(|()| out.flush()).map_err(unwritten)?;
            return Ok(out.count);
        };
        let mut count = 0;
        let whole = file::replace(path, |file| {
            let mut out = Counter { out: BufWriter::new(file), count: 0 };
            write(&mut out)?;
            out.flush()?;
            count = out.count;
            Ok(())
        });
        whole.of(path.display())?;
        Ok(count)
    }

    /// Saves the octree completely or not at all, and returns the length of its file.
    pub fn save(&self, octree: &Octree) -> Result<u64, Failure> {
        self.put(|path| file::save(octree, path), |out| file::write_to(octree, out))
    }

    /// Saves a tri-dexel model in the same way.
    pub fn save_dexels(&self, model: &TriDexel) -> Result<u64, Failure> {
        self.put(|path| file::dexels::save(model, path), |out| file::dexels::write_to(model, out))
    }

    fn put(
        &self,
        save: impl FnOnce(&Path) -> Result<(), Error>,
        write: impl Fn(&mut dyn Write) -> Result<(), Error>,
    ) -> Result<u64, Failure> {
        let Output::Path(path) = self else {
            let mut counter = Counter { out: std::io::stdout().lock(), count: 0 };
            return match write(&mut counter) {
                Ok(()) => Ok(counter.count),
                Err(Error::Io(error)) if error.kind() == ErrorKind::BrokenPipe => Err(Failure::Undelivered),
                Err(error) => Err(Failure::of(self, error)),
            };
        };
        save(path).of(self)?;
        match std::fs::metadata(path) {
            Ok(metadata) if metadata.is_file() => Ok(metadata.len()),
            // A pipe or device does not report the length.
            _ => {
                let mut counter = Counter { out: std::io::sink(), count: 0 };
                write(&mut counter).of(self)?;
                Ok(counter.count)
            }
        }
    }

    /// Reports what was done, as JSON or for people.
    pub fn tell<T: Serialize>(
        &self,
        as_json: bool,
        report: &T,
        text: impl FnOnce(&T) -> String,
    ) -> Result<(), Failure> {
        self.report(&if as_json { json(report)? } else { text(report) })
    }

    /// Prints a report, to standard error if standard output carries the result itself.
    pub fn report(&self, text: &str) -> Result<(), Failure> {
        match self {
            Output::Path(_) => print(text.as_bytes()),
            Output::Standard => {
                // An unreadable report makes the result no worse.
                let _ = std::io::stderr().lock().write_all(text.as_bytes());
                Ok(())
            }
        }
    }
}

/// A writer that counts the bytes that pass through.
struct Counter<W> {
    out: W,
    count: u64,
}

impl<W: Write> Write for Counter<W> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let count = self.out.write(bytes)?;
        self.count += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.out.flush()
    }
}

/// Writes a file completely or not at all.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    file::replace(path, |file| Ok(file.write_all(bytes)?)).of(path.display())
}

/// Writes to standard output.
pub fn print(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    out.write_all(bytes).and_then(|()| out.flush()).map_err(unwritten)
}

/// Returns the failure for an error of standard output.
fn unwritten(error: std::io::Error) -> Failure {
    match error.kind() {
        ErrorKind::BrokenPipe => Failure::ReaderGone,
        _ => Failure::of("standard output", error.text()),
    }
}

/// Prints an answer, as JSON or for people.
pub fn print_told<T: Serialize>(
    as_json: bool,
    answer: &T,
    text: impl FnOnce(&T) -> String,
) -> Result<(), Failure> {
    print((if as_json { json(answer)? } else { text(answer) }).as_bytes())
}

/// Returns `value` as JSON, one object over several lines.
pub fn json(value: &impl Serialize) -> Result<String, Failure> {
    let mut text = serde_json::to_string_pretty(value).map_err(|error| Failure::of("JSON", error))?;
    text.push('\n');
    Ok(text)
}

/// Returns `value` as JSON on one line.
pub fn json_line(value: &impl Serialize) -> Result<String, Failure> {
    let mut text = serde_json::to_string(value).map_err(|error| Failure::of("JSON", error))?;
    text.push('\n');
    Ok(text)
}
