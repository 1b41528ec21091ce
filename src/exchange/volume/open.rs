//! Opening volumes from paths; their samples may be in another file.

use super::{VolumeFile, read_volume, volume_data_file};
use crate::error::{Error, VolumeFileError};
use crate::exchange::read_whole;
use crate::memory;
use alloc::vec::Vec;
use std::fs::{self, File};
use std::io::{ErrorKind, Read};
use std::path::{Component, Path, PathBuf};

/// Reads a volume from a path. If the samples are in another file, that file must be in the header's folder
/// or below it.
///
/// The header's folder is the folder in the path. If the header itself is a link, the folder of its target
/// counts too; the data file is looked for there if the first folder does not have it. All links are followed
/// before the check: the real path of the data file must lie in one of these folders, so that a header from a
/// stranger can name no other file. Folders above the header may be links. A link that is made during the
/// reading is noticed, unless it is removed again at once. An attacker who can do that in the header's folder
/// could also copy or hard-link the file there.
///
/// # Errors
/// The errors of [`read_volume`], and [`Error::Io`], both as the cause of an [`Error::File`] with the path;
/// [`VolumeFileError::Unsupported`] for samples outside of the header's folder, or in a data file that is not
/// a regular file.
pub fn open_volume(path: impl AsRef<Path>) -> Result<VolumeFile, Error> {
    let path = path.as_ref();
    let bytes = read_whole(path).map_err(|error| error.of_file(path))?;
    let name = volume_data_file(&bytes).map_err(|error| error.of_file(path))?;
    let Some(name) = name else { return read_volume(&bytes, None).map_err(|error| error.of_file(path)) };
    let relative = Path::new(&name);
    let is_plain = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    if !relative.components().all(is_plain) {
        return Err(unsupported("samples outside of the header's folder").of_file(path));
    }
    let folders = folders(path).map_err(|error| error.of_file(path))?;
    let (given, real) = match find(&folders, relative) {
        Ok(Some(found)) => found,
        Ok(None) => {
            let what = "samples outside of the header's folder, where a link leads,";
            return Err(unsupported(what).of_file(path));
        }
        Err((given, error)) => return Err(Error::from(error).of_file(&given)),
    };
    let data = content(&real).map_err(|error| error.of_file(&given))?;
    read_volume(&bytes, Some(&data)).map_err(|error| error.of_file(path))
}

fn unsupported(what: &'static str) -> Error {
    VolumeFileError::Unsupported { what }.into()
}

/// A folder as given, and its real path.
struct Folder {
    given: PathBuf,
    real: PathBuf,
}

/// Returns the folder in the path of a header and, if the header is a link, the folder of its target.
fn folders(header: &Path) -> Result<Vec<Folder>, Error> {
    let named = header.parent().unwrap_or(Path::new(""));
    let real = fs::canonicalize(if named.as_os_str().is_empty() { Path::new(".") } else { named })?;
    let own = fs::canonicalize(header)?.parent().filter(|&own| own != real).map(PathBuf::from);
    let mut folders = memory::with_capacity(2)?;
    folders.push(Folder { given: named.into(), real });
    folders.extend(own.map(|own| Folder { given: own.clone(), real: own }));
    Ok(folders)
}

/// Returns the data file as named and its real path, in the first folder that has it; `None` if it is outside
/// of the folders.
///
/// # Errors
/// The reason why the data file cannot be found, with the path at which it was looked for first.
fn find(
    folders: &[Folder],
    relative: &Path,
) -> Result<Option<(PathBuf, PathBuf)>, (PathBuf, std::io::Error)> {
    let mut missing = None;
    for folder in folders {
        let given = folder.given.join(relative);
        match fs::canonicalize(folder.real.join(relative)) {
            Ok(real) => {
                let is_inside = folders.iter().any(|folder| real.starts_with(&folder.real));
                return Ok(is_inside.then_some((given, real)));
            }
            Err(error) if error.kind() == ErrorKind::NotFound => missing = missing.or(Some((given, error))),
            Err(error) => return Err((given, error)),
        }
    }
    // There is at least one folder, and it does not have the file.
    match missing {
        Some(missing) => Err(missing),
        None => Ok(None),
    }
}

/// Returns the bytes of a regular file with this real path.
fn content(real: &Path) -> Result<Vec<u8>, Error> {
    // A special file may have no end, and opening a pipe may wait for ever.
    let check = |metadata: fs::Metadata| match metadata.is_file() {
        true => Ok(()),
        false => Err(unsupported("samples in a file that is not regular")),
    };
    check(fs::metadata(real)?)?;
    let mut file = File::open(real)?;
    check(file.metadata()?)?;
    // A link may have replaced a part of the path since the path was resolved.
    if fs::canonicalize(real)? != real {
        return Err(unsupported("samples whose path changes while they are read"));
    }
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}
