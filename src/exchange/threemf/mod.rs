//! 3MF packages: the core specification 1.x and its draft 0.93, and the production extension's parts of
//! models.
//!
//! **The way in.** A package is a ZIP archive (stored or DEFLATE). `_rels/.rels` must lead to one 3D model,
//! and `[Content_Types].xml` must be there and not call it something else. Components and items of the build
//! may refer to objects in other model parts by the production extension's `path`, from the root model only.
//!
//! **What is built.** The items of the build in the root model, each an object that is a mesh or consists of
//! placed components, which are objects again. All their triangles become one mesh in the unit of the root
//! model. An object that is reached several times stands there several times. A transform that mirrors also
//! turns the triangles round, so that a volume keeps its sign. Objects of all types but `model` (`support`,
//! `solidsupport`, `surface`, and `other`, which a build should not reach, but slicers put their modifiers
//! there) are left out, and counted; the type of an object of components has no meaning. Objects that the
//! build does not reach are not built. Textures and triangle sets are ignored, all metadata but the deviation
//! that this library writes, and so are extensions that the model does not require. The fill rule of 3MF is
//! `FillRule::Positive` for each object, and the union of the objects: the mesh as a whole differs from that
//! only where an object that is inside out overlaps another one.
//!
//! **Properties.** Base materials and colour groups become attributes of the mesh: `colour` and `material`. A
//! triangle has the properties that it refers to, or else those of its object, wherever the object is placed.
//! A group is one of the part in which it is referred to. Base materials are not mixed: that of the first
//! corner counts. Groups of other kinds (textures, composites, multiproperties) are not read. Of what is not
//! there, or is no colour, a triangle has nothing, and the caller is told how many there are. If several
//! objects are built, `object` tells which one a triangle belongs to.
//!
//! **The draft 0.93** has a namespace of its own. Its relationship and content types, its objects, components
//! and items are those of 1.0; its colours, materials and textures are ignored like others. The caller is
//! told, for a warning.
//!
//! **Text** is UTF-8, or UTF-16 with a byte order mark.
//!
//! **What is refused.** Damaged archives, parts that are encrypted, packages with keys for protected content,
//! models that require an extension other than production, materials and triangle sets; document type
//! declarations, other encodings, attributes that stand twice in an element of any part; objects that are
//! referred to before they are defined (which makes circles impossible) or defined twice, meshes that only
//! stand for something finer (`lowres`, `obfuscated`), models without a build, indices of vertices that do
//! not exist, numbers that are not finite.
//!
//! **Memory.** Decompressed, the parts that are read may together be 64 times as long as the file and 16 MiB;
//! what is read of them takes at most twenty times their length (of meshes three times). Instances may come
//! to 2^25 vertices and 2^25 triangles, or to as many as the file has, and be made of 2^24 placements.
//! Nothing is recursive.

pub(super) mod model;
mod package;
mod properties;
mod transform;
mod xml;

use alloc::vec::Vec;

use model::{Component, Models, Object, Purpose, Shape, Target};
use package::{Package, broken};
use properties::BuiltProperties;
use transform::Transform;

use super::{LengthUnit, MeshWarning};
use crate::error::{Error, MeshError};
use crate::memory;
use crate::mesh::{MeshAttribute, TriangleMesh};

/// Vertices and triangles that instances may come to.
const MAX_BUILT: u64 = 1 << 25;
/// Placements that may be walked through.
const MAX_PLACED: u64 = 1 << 24;

/// What a package builds.
pub(super) struct Built {
    pub mesh: TriangleMesh,
    pub unit: LengthUnit,
    /// Instances of objects that are no solids.
    pub skipped: u64,
    /// How far the true boundary may lie from the mesh, if the root model says so.
    pub deviation: Option<f64>,
}

/// Reads a package.
pub(super) fn read(bytes: &[u8], warnings: &mut Vec<MeshWarning>) -> Result<Built, Error> {
    let mut package = Package::open(bytes)?;
    let root = package.model()?;
    let text = package.text(root)?;
    let mut models = Models::default();
    let unit = models.read(&package, root, &text, true)?;
    // What was found to be wrong in the root model when it had been read.
    let error = |package: &Package, component: &Component, problem: &str| {
        xml::error_at(&package.name(root), &text.text, component.offset, problem)
    };
    let own = models.objects.len();
    resolve(&mut models, &mut package, unit, &error)?;
    let totals = totals_of_objects(&models, own)?;
    let mut sum = Total::default();
    for item in &models.items {
        let total = target(&totals, item);
        if total.reaches_unknown {
            let problem = "the build reaches an object that is neither a mesh nor made of components";
            return Err(error(&package, item, problem));
        }
        sum.add(&total);
    }
    drop(text);
    let placements = models.components.len() + models.items.len();
    let has_room = |count: u64, limit: u64, own: usize| count <= limit.max(own as u64);
    if !has_room(sum.vertices, MAX_BUILT, models.vertices.len())
        || !has_room(sum.triangles, MAX_BUILT, models.triangles.len())
        || !has_room(sum.placed, MAX_PLACED, placements)
    {
        let problem = "builds more than 2^25 vertices or triangles by placing objects several times";
        return Err(broken(&package.name(root), problem));
    }
    drop(package);
    let mesh = build(&models, &totals, &sum, warnings)?;
    if models.draft {
        memory::push(warnings, MeshWarning::Draft)?;
    }
    Ok(Built { mesh, unit, skipped: sum.skipped, deviation: models.deviation })
}

/// Reads the parts that the root model refers to, and replaces references to them by places of objects.
fn resolve(
    models: &mut Models,
    package: &mut Package,
    unit: LengthUnit,
    error: &impl Fn(&Package, &Component, &str) -> Error,
) -> Result<(), Error> {
    let mut parts = Vec::new();
    for component in models.components.iter().chain(&models.items) {
        if let Target::Elsewhere(part, _) = component.target
            && parts.last() != Some(&part)
        {
            memory::push(&mut parts, part)?;
        }
    }
    parts.sort_unstable();
    parts.dedup();
    let mut scales = memory::with_capacity(parts.len())?;
    for &part in &parts {
        let text = package.text(part)?;
        let own_unit = models.read(package, part, &text, false)?;
        scales.push(match own_unit {
            same if same == unit => Transform::IDENTITY,
            other => Transform::scale(f64::from(other.micrometres()) / f64::from(unit.micrometres())),
        });
    }
    let Models { components, items, known, .. } = models;
    for component in components.iter_mut().chain(items) {
        if let Target::Elsewhere(part, id) = component.target {
            let Some(&object) = known.get(&(part, id)) else {
                let problem = alloc::format!("there is no object {id} in {}", package.name(part));
                return Err(error(package, component, &problem));
            };
            let scale = parts.binary_search(&part).ok().and_then(|at| scales.get(at));
            component.transform = scale.unwrap_or(&Transform::IDENTITY).then(&component.transform);
            component.target = Target::Object(object);
        }
    }
    Ok(())
}

/// What one instance of an object comes to.
#[derive(Debug, Clone, Copy, Default)]
struct Total {
    vertices: u64,
    triangles: u64,
    /// Placements that a walk through it meets.
    placed: u64,
    skipped: u64,
    reaches_unknown: bool,
}

impl Total {
    fn add(&mut self, other: &Total) {
        self.vertices = self.vertices.saturating_add(other.vertices);
        self.triangles = self.triangles.saturating_add(other.triangles);
        self.placed = self.placed.saturating_add(other.placed);
        self.skipped = self.skipped.saturating_add(other.skipped);
        self.reaches_unknown |= other.reaches_unknown;
    }
}

/// The totals of all objects. Those of the root model come first in the list, but refer to the others.
fn totals_of_objects(models: &Models, own: usize) -> Result<Vec<Total>, Error> {
    let count = models.objects.len();
    let mut totals = memory::filled(count, Total::default())?;
    for index in (own..count).chain(0..own) {
        let mut total = Total::default();
        match (&models.objects[index].shape, models.objects[index].purpose) {
            (Shape::Components(range), _) => {
                for component in models.components.get(range.clone()).unwrap_or(&[]) {
                    total.add(&target(&totals, component));
                }
            }
            (_, Purpose::Other) => total.skipped = 1,
            (Shape::Unknown, Purpose::Model) => total.reaches_unknown = true,
            (Shape::Mesh(_, triangles), Purpose::Model) if triangles.is_empty() => {}
            (Shape::Mesh(vertices, triangles), Purpose::Model) => {
                (total.vertices, total.triangles) = (vertices.len() as u64, triangles.len() as u64);
            }
        }
        // Nobody walks where nothing is.
        total.placed = if total.triangles > 0 { total.placed.saturating_add(1) } else { 0 };
        totals[index] = total;
    }
    Ok(totals)
}

/// The total of what a component places, once its target is resolved.
fn target(totals: &[Total], component: &Component) -> Total {
    match component.target {
        Target::Object(object) => totals.get(object as usize).copied().unwrap_or_default(),
        Target::Elsewhere(..) => Total::default(),
    }
}

/// The objects that triangles belong to, numbered in the order in which they are first placed.
struct Places {
    /// Of each object its number, or that it has none yet.
    numbers: Vec<u32>,
    /// The objects that have numbers.
    placed: Vec<u32>,
    of_triangles: Vec<u32>,
}

impl Places {
    fn new(objects: usize, triangles: usize) -> Result<Places, Error> {
        let numbers = memory::filled(objects, MeshAttribute::NO_ROW)?;
        Ok(Places { numbers, placed: Vec::new(), of_triangles: memory::with_capacity(triangles)? })
    }

    fn push(&mut self, object: u32, triangles: usize) -> Result<(), Error> {
        let number = &mut self.numbers[object as usize];
        if *number == MeshAttribute::NO_ROW {
            *number = self.placed.len() as u32;
            memory::push(&mut self.placed, object)?;
        }
        self.of_triangles.try_reserve(triangles)?;
        self.of_triangles.extend(core::iter::repeat_n(*number, triangles));
        Ok(())
    }

    /// The attribute, if there are several objects.
    fn attribute(self, models: &Models) -> Result<Option<MeshAttribute>, Error> {
        if self.placed.len() < 2 {
            return Ok(None);
        }
        let mut names = memory::with_capacity(self.placed.len())?;
        for &object in &self.placed {
            names.push(memory::text(&models.objects[object as usize].name)?);
        }
        Ok(Some(MeshAttribute::labels("object", self.of_triangles)?.named(names)))
    }
}

/// All triangles of the build.
fn build(
    models: &Models,
    totals: &[Total],
    sum: &Total,
    warnings: &mut Vec<MeshWarning>,
) -> Result<TriangleMesh, Error> {
    let (Ok(vertex_count), Ok(triangle_count)) =
        (usize::try_from(sum.vertices), usize::try_from(sum.triangles))
    else {
        return Err(Error::OutOfMemory);
    };
    if u32::try_from(vertex_count).is_err() || u32::try_from(triangle_count).is_err() {
        return Err(MeshError::TooMany.into());
    }
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    vertices.try_reserve_exact(vertex_count)?;
    triangles.try_reserve_exact(triangle_count)?;
    let mut properties = BuiltProperties::new(&models.properties, triangle_count)?;
    let several = models.objects.iter().filter(|object| matches!(object.shape, Shape::Mesh(..))).count() > 1;
    let mut places = Places::new(models.objects.len(), if several { triangle_count } else { 0 })?;
    // Components that are yet to be placed, and what they are placed by; nested as the objects are.
    let mut open = Vec::new();
    memory::push(&mut open, (models.items.iter(), Transform::IDENTITY))?;
    while let Some((components, placement)) = open.last_mut() {
        let Some(component) = components.next() else {
            open.pop();
            continue;
        };
        if target(totals, component).triangles == 0 {
            continue;
        }
        let placement = component.transform.then(placement);
        let Target::Object(object) = component.target else { continue };
        let Object { shape, part, property, .. } = &models.objects[object as usize];
        match shape {
            Shape::Unknown => {}
            Shape::Components(range) => {
                let components = models.components.get(range.clone()).unwrap_or(&[]);
                memory::push(&mut open, (components.iter(), placement))?;
            }
            Shape::Mesh(own_vertices, own_triangles) => {
                let base = vertices.len() as u32;
                let own_vertices = models.vertices.get(own_vertices.clone()).unwrap_or(&[]);
                if placement == Transform::IDENTITY {
                    vertices.extend_from_slice(own_vertices);
                } else {
                    vertices.extend(own_vertices.iter().map(|&vertex| placement.apply(vertex)));
                }
                for place in own_triangles.clone() {
                    properties.push(place, *part, *property, placement.mirrors)?;
                }
                if several {
                    places.push(object, own_triangles.len())?;
                }
                let own_triangles = models.triangles.get(own_triangles.clone()).unwrap_or(&[]);
                triangles.extend(own_triangles.iter().map(|&triangle| {
                    let [a, b, c] = triangle.map(|vertex| base + vertex);
                    if placement.mirrors { [a, c, b] } else { [a, b, c] }
                }));
            }
        }
    }
    if let triangles @ 1.. = properties.missing {
        memory::push(warnings, MeshWarning::Properties { triangles })?;
    }
    let (mut attributes, unreadable) = properties.finish()?;
    if let colours @ 1.. = unreadable {
        memory::push(warnings, MeshWarning::Colours { colours })?;
    }
    if let Some(objects) = places.attribute(models)? {
        memory::push(&mut attributes, objects)?;
    }
    TriangleMesh::with_attributes(vertices, triangles, attributes)
}
