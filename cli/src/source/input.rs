//! Inputs: files and standard input.

use crate::failure::{Failure, Of};
use crate::memory;
use leafless::{Octree, TriDexel, file};
use std::ffi::OsStr;
use std::fmt;
use std::io::Read;
use std::path::{Path, PathBuf};

/// An input: a file, or standard input for the name `-`.
#[derive(Debug, Clone)]
pub enum Input {
    /// `-`
    Standard,
    /// A path.
    Path(PathBuf),
}

impl From<&OsStr> for Input {
    fn from(name: &OsStr) -> Input {
        if name == "-" { Input::Standard } else { Input::Path(name.into()) }
    }
}

impl fmt::Display for Input {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Input::Standard => f.write_str("standard input"),
            Input::Path(path) => path.display().fmt(f),
        }
    }
}

impl Input {
    /// Returns a file, as standard input carries the `questions` about it.
    pub fn file(name: &OsStr, questions: &str) -> Result<Input, Failure> {
        match Input::from(name) {
            Input::Standard => {
                let problem = format!("standard input carries the {questions}, so the solid must be a file");
                Err(Failure::Usage(problem))
            }
            input => Ok(input),
        }
    }

    /// Returns the path, unless the input is standard input.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Input::Standard => None,
            Input::Path(path) => Some(path),
        }
    }

    /// Reads all bytes, if memory allows. The length of a regular file is known beforehand; a pipe or a
    /// device may be endless.
    pub fn read(&self) -> Result<Vec<u8>, Failure> {
        let refusal = |length: String, most: u64| {
            let most = memory::told(most);
            let problem =
                format!("has {length}, and there is room for {most}: give more memory with --max-memory");
            Failure::of(self, problem)
        };
        let (source, length): (&mut dyn Read, _) = match self {
            Input::Standard => (&mut std::io::stdin().lock(), None),
            Input::Path(path) => {
                let file = std::fs::File::open(path).of(self)?;
                let metadata = file.metadata().of(self)?;
                (&mut { file }, metadata.is_file().then_some(metadata.len()))
            }
        };
        let most = if length.is_some() { memory::longest_file() } else { memory::longest_stream() };
        let length = length.unwrap_or(0);
        if length > most {
            return Err(refusal(memory::told(length), most));
        }
        let mut bytes = Vec::new();
        bytes
            .try_reserve_exact(length as usize)
            .map_err(|_| Failure::of(self, leafless::Error::OutOfMemory))?;
        source.take(most + 1).read_to_end(&mut bytes).of(self)?;
        if bytes.len() as u64 > most {
            return Err(refusal(format!("more than {}", memory::told(most)), most));
        }
        Ok(bytes)
    }

    /// True if this is a regular file with the signature of solids. Nothing is read from a pipe.
    pub fn begins_as_solid(&self) -> bool {
        let mut start = [0; file::MAGIC.len()];
        self.path().filter(|path| path.is_file()).is_some_and(|path| {
            let read = std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut start));
            read.is_ok() && start == file::MAGIC
        })
    }

    /// Returns the octree in the file, and the file's length. A regular file is mapped and, unless
    /// `verified`, hardly read. An octree from a pipe is always read and verified.
    pub fn octree(&self, verified: bool) -> Result<(Octree, u64), Failure> {
        if let Input::Path(path) = self {
            let metadata = std::fs::metadata(path).of(self)?;
            if metadata.is_file() {
                return Ok((map(path, verified).of(self)?, metadata.len()));
            }
        }
        let bytes = self.read()?;
        Ok((file::from_bytes(&bytes).of(self)?, bytes.len() as u64))
    }
}

/// Maps a file of a tri-dexel model.
#[allow(unsafe_code)]
pub fn map_dexels(path: &Path, verified: bool) -> Result<TriDexel, leafless::Error> {
    // SAFETY: as for `map`.
    unsafe { if verified { file::dexels::map_verified(path) } else { file::dexels::map(path) } }
}

/// Maps a file of an octree.
#[allow(unsafe_code)]
fn map(path: &Path, verified: bool) -> Result<Octree, leafless::Error> {
    // SAFETY: this program never changes an existing file: it replaces files by renaming new ones over them,
    // which leaves mappings intact. The user must see to it that no other program rewrites or truncates a
    // file while this one reads it; the help text says so.
    unsafe { if verified { file::map_verified(path) } else { file::map(path) } }
}
