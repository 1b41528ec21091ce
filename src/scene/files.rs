//! Calls that name files, and meshes.

use alloc::boxed::Box;
use alloc::format;
use alloc::string::String;
use std::path::Path;

use super::arguments::{Given, Item};
use super::check::Checker;
use super::grammar::{Call, Cursor, shown};
use super::{Node, SceneMesh};
use crate::error::{Error, MeshError};
use crate::exchange::{MeshFormat, MeshOptions, open_mesh};
use crate::memory;
use crate::mesh::{FillRule, TriangleMesh};
use crate::solid::MeshSolid;

impl Checker<'_> {
    /// Calls `read` with the path of the file that is named in the text.
    fn read<T>(&self, file: &Item<'_>, read: impl FnOnce(&Path) -> Result<T, Error>) -> Result<T, Error> {
        let name = file.text()?;
        let Some(folder) = self.files.folder else {
            return Err(file.fault("files cannot be read by this scene, which has no folder"));
        };
        let path = folder.join(&name);
        // A special file may have no end, and opening a pipe may wait for ever. (If the metadata cannot be
        // read, reading reports the error below.)
        if let Ok(metadata) = std::fs::metadata(&path) {
            if !metadata.is_file() {
                return Err(file.fault(format!("{name}: is no regular file")));
            }
            if let Some(limit) = self.files.max_bytes.filter(|&limit| metadata.len() > limit) {
                let problem = format!("{name}: has {} bytes, and the limit is {limit}", metadata.len());
                return Err(file.fault(problem));
            }
        }
        read(&path).map_err(|error| match error {
            Error::OutOfMemory => error,
            error => file.fault(format!("{name}: {}", error.cause())),
        })
    }

    /// Reads the mesh of a file. `deviation` is the maximum distance of the true boundary from it.
    pub(super) fn mesh(
        &mut self,
        call: &Call<'_>,
        file: Item<'_>,
        deviation: Option<Item<'_>>,
    ) -> Result<Node, Error> {
        let read = self.read(&file, |path| open_mesh(path, &MeshOptions::default()))?;
        let fill = match read.format {
            MeshFormat::ThreeMf => FillRule::Positive,
            _ => FillRule::NonZero,
        };
        if read.mesh.triangles().is_empty() {
            return Err(file.fault(format!("{}", MeshError::Empty)));
        }
        // Meshes in files have hair cracks, because their coordinates are rounded.
        let mut mesh = read.mesh.sewn()?;
        if let Some(item) = deviation {
            mesh = mesh
                .with_deviation(item.number()?)
                .map_err(|error| item.fault(format!("{}", error.cause())))?;
            if mesh.deviation() > 0.0 {
                mesh.check_closed(fill).map_err(|error| match error {
                    Error::OutOfMemory => error,
                    error => file.fault(format!(
                        "{}, and `deviation` needs a mesh that bounds a solid",
                        error.cause()
                    )),
                })?;
            }
        }
        self.solid_mesh(call, file.text()?, mesh, fill)
    }

    pub(super) fn import(&mut self, call: &Call<'_>) -> Result<Node, Error> {
        let ignored = ["origin", "scale", "convexity", "timestamp", "layer", "id", "dpi", "width", "height"];
        let given = Given::new(self.tree, call, ["file", "center", "deviation"], &ignored)?;
        if given.truth_or(1, false)? {
            return Err(self.fault(call, "is supported without `center` only"));
        }
        let name = given.required(0)?.text()?;
        let extension = name.rsplit_once('.').map_or("", |parts| parts.1);
        if MeshFormat::from_extension(extension).is_none() {
            return Err(self.fault(call, format_args!("of files {} is not supported", shown(extension))));
        }
        self.mesh(call, given.required(0)?, given.optional(2))
    }

    pub(super) fn octree(&self, call: &Call<'_>) -> Result<Node, Error> {
        let file = Given::new(self.tree, call, ["file"], &[])?.required(0)?;
        Ok(Node::Octree(Box::new(self.read(&file, |path| crate::file::open(path))?)))
    }

    /// Makes a solid of a mesh, and keeps the mesh's report.
    pub(super) fn solid_mesh(
        &mut self,
        call: &Call<'_>,
        file: String,
        mesh: TriangleMesh,
        fill: FillRule,
    ) -> Result<Node, Error> {
        // (Calls without blocks come in the order of the text.)
        self.cursor.advance(self.tree.text, call.at);
        let Cursor { line, column, .. } = self.cursor;
        let (report, turned) = (mesh.report()?, mesh.turned_triangles()?);
        let solid = MeshSolid::new(mesh, fill)?;
        memory::push(&mut self.report.meshes, SceneMesh { line, column, file, report, turned })?;
        Ok(Node::Mesh(solid))
    }
}
