//! A file whose kind is known, before anything is made from it.

use crate::failure::{Failure, Of};
use crate::source::content::Content;
use crate::source::input::{Input, map_dexels};
use crate::source::mesh::Reading;
use crate::source::placing::Placing;
use crate::source::scene::{Drawing, scene_of};
use crate::source::volume::Voxels;
use clap::Args;
use leafless::exchange::MeshFile;
use leafless::scene::Scene;
use leafless::{FillRule, Octree, TriDexel, file};

/// How a file of any kind is to be taken.
#[derive(Clone, Default, Args)]
pub struct Taking {
    #[command(flatten)]
    pub reading: Reading,
    #[command(flatten)]
    pub drawing: Drawing,
    #[command(flatten)]
    pub placing: Placing,
}

impl Taking {
    /// Returns the same options without the placement.
    pub fn unmoved(&self) -> Taking {
        Taking { placing: Placing::default(), ..self.clone() }
    }

    /// Returns the options that apply to a file of this kind, with another placement.
    pub fn about(&self, content: Content, placing: &Placing) -> Taking {
        let drawing = if content == Content::Scene { self.drawing.clone() } else { Drawing::default() };
        Taking { reading: self.reading.about(content), drawing, placing: *placing }
    }

    /// Refuses the options of reading if a stored solid is read; `what` names it.
    pub fn refuse(&self, input: &Input, what: &str) -> Result<(), Failure> {
        self.reading.refuse(input, what)?;
        self.drawing.refuse(input, what)
    }
}

/// A stored solid (.lfl), of either kind.
pub enum Stored {
    Octree(Octree),
    Dexels(TriDexel),
}

impl Stored {
    /// Decodes the solid with these bytes.
    pub fn of_bytes(input: &Input, bytes: &[u8]) -> Result<Stored, Failure> {
        if file::probe_bytes(bytes).is_ok_and(|probe| probe.dexels.is_some()) {
            return file::dexels::from_bytes(bytes).of(input).map(Stored::Dexels);
        }
        file::from_bytes(bytes).of(input).map(Stored::Octree)
    }

    /// Reads the solid in a file, and returns it with the file's length. A regular file is mapped and, unless
    /// `verified`, hardly read.
    pub fn read(input: &Input, verified: bool) -> Result<(Stored, u64), Failure> {
        if let Some(path) = input.path().filter(|path| path.is_file()) {
            match file::probe(path) {
                Ok(probe) if probe.dexels.is_some() => {
                    let length = std::fs::metadata(path).of(input)?.len();
                    return Ok((Stored::Dexels(map_dexels(path, verified).of(input)?), length));
                }
                Err(error) if input.begins_as_solid() => return Err(error).of(input),
                _ => {}
            }
            let (octree, length) = input.octree(verified)?;
            return Ok((Stored::Octree(octree), length));
        }
        // A pipe can be read only once.
        let bytes = input.read()?;
        Ok((Stored::of_bytes(input, &bytes)?, bytes.len() as u64))
    }
}

/// A file with its bytes. The bytes of a regular file of a stored solid are not read: that file is mapped.
pub struct Found<'a> {
    input: &'a Input,
    pub content: Content,
    bytes: Option<Vec<u8>>,
}

impl Found<'_> {
    /// Opens a file and recognises its kind; `told` is the kind that the user named.
    pub fn look(input: &Input, told: Option<Content>) -> Result<Found<'_>, Failure> {
        if input.begins_as_solid() {
            return Ok(Found { input, content: Content::Solid, bytes: None });
        }
        let bytes = input.read()?;
        Ok(Found { input, content: Content::of(input, &bytes, told)?, bytes: Some(bytes) })
    }

    fn bytes(&self) -> &[u8] {
        self.bytes.as_deref().unwrap_or_default()
    }

    /// Returns the number of bytes that were read.
    pub fn length(&self) -> u64 {
        self.bytes().len() as u64
    }

    /// Returns checksum and length of the bytes that were read.
    pub fn fingerprint(&self) -> String {
        format!("crc32:{:08x} bytes:{}", crc32fast::hash(self.bytes()), self.length())
    }

    /// Returns the stored solid, and the length of its file.
    pub fn stored(&self, verified: bool) -> Result<(Stored, u64), Failure> {
        match &self.bytes {
            None => Stored::read(self.input, verified),
            Some(bytes) => Ok((Stored::of_bytes(self.input, bytes)?, self.length())),
        }
    }

    /// Returns the octree, where only an octree will do. Answers about it are proven, so the file is
    /// verified.
    pub fn octree(&self) -> Result<Octree, Failure> {
        match &self.bytes {
            None => Ok(self.input.octree(true)?.0),
            Some(bytes) => file::from_bytes(bytes).of(self.input),
        }
    }

    /// Returns the mesh, and its fill rule.
    pub fn mesh(self, reading: &Reading, placing: &Placing) -> Result<(MeshFile, FillRule), Failure> {
        reading.mesh(self.input, self.bytes.unwrap_or_default(), placing)
    }

    /// Returns the scene.
    pub fn scene(&self, drawing: &Drawing, placing: &Placing) -> Result<Scene, Failure> {
        let scene = scene_of(self.input, self.bytes(), drawing)?;
        match placing.map() {
            Some(map) => scene.placed(map).of(self.input),
            None => Ok(scene),
        }
    }

    /// Returns the volume.
    pub fn volume(&self, reading: &Reading, placing: &Placing) -> Result<Voxels, Failure> {
        let volume = reading.volume(self.input, self.bytes())?;
        match placing.map() {
            Some(map) => volume.placed(map).of(self.input),
            None => Ok(volume),
        }
    }
}
