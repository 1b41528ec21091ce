//! 3MF packages: reader of the core specification 1.x, of its draft 0.93, and of the model parts of the
//! production extension.
//!
//! **Finding the model.** A package is a ZIP archive (stored or DEFLATE). `_rels/.rels` must lead to one 3D
//! model, and `[Content_Types].xml` must exist and not declare another type for the model. Components and
//! build items may refer to objects in other model parts by the production extension's `path`, from the root
//! model only.
//!
//! **Built objects.** The build items of the root model are objects. An object is a mesh, or consists of
//! placed components, which are objects again. All their triangles become one mesh in the unit of the root
//! model. An object that is reached several times is built several times. A transform that mirrors also
//! reverses the triangles, so that a volume keeps its sign. Objects of all types but `model` are left out and
//! counted: `support`, `solidsupport`, `surface`, and `other`, which a build should not reach, but slicers
//! use it for their modifiers. The type of an object of components has no meaning. Objects that the build
//! does not reach are not built. Textures, triangle sets, all metadata but the deviation that this library
//! writes, and extensions that the model does not require are ignored. The fill rule of 3MF is
//! `FillRule::Positive` for each object, and the union of the objects: the mesh as a whole differs from that
//! only where an inverted object overlaps another one.
//!
//! **Properties.** Base materials and colour groups become attributes of the mesh: `colour` and `material`. A
//! triangle has the properties to which it refers, or else the properties of its object, wherever the object
//! is placed. A reference means a group of the same part. Base materials are not mixed: the material of the
//! first corner counts. Groups of other kinds (textures, composites, multiproperties) are not read. If a
//! property does not exist, or is no colour, the triangle has none. Warnings count the triangles without an
//! existing property, and the unreadable colours. If several objects are built, `object` is the number of
//! each triangle's object.
//!
//! **The draft 0.93** has a namespace of its own. Its relationship and content types, its objects, components
//! and items are those of 1.0; its colours, materials and textures are ignored like other unknown elements. A
//! warning reports the draft.
//!
//! **Text** is UTF-8, or UTF-16 with a byte order mark.
//!
//! **Refused packages and models.** Damaged archives, encrypted parts, packages with keys for protected
//! content, models that require an extension other than production, materials and triangle sets; document
//! type declarations, other encodings, duplicate attributes in an element of any part; objects that are used
//! before they are defined (which makes cycles impossible) or defined twice, meshes that only stand for
//! something finer (`lowres`, `obfuscated`), models without a build, indices of vertices that do not exist,
//! numbers that are not finite.
//!
//! **Memory.** The decompressed parts may together be 64 times as long as the file plus 16 MiB. The data that
//! is read from them takes at most twenty times their length (for meshes three times). Instances may have up
//! to 2^25 vertices and 2^25 triangles altogether, or as many as the file has, and may be made of 2^24
//! placements. Nothing is recursive.

pub(super) mod model;
mod package;
mod properties;
mod transform;
mod xml;

use crate::lattice::Each;
use alloc::vec::Vec;

use model::{Component, Models, Object, Purpose, Shape, Target};
use package::{Package, broken};
use properties::BuiltProperties;
use transform::Transform;

use super::{LengthUnit, MeshWarning};
use crate::error::{Error, MeshError};
use crate::memory;
use crate::mesh::{MeshAttribute, TriangleMesh};

/// Maximum number of vertices, and of triangles, of all instances.
const MAX_BUILT: u64 = 1 << 25;
/// Maximum number of placements that are visited.
const MAX_PLACED: u64 = 1 << 24;

/// The result of building a package.
pub(super) struct Built {
    pub mesh: TriangleMesh,
    pub unit: LengthUnit,
    /// Number of instances of objects that are no solids.
    pub skipped: u64,
    /// Maximum distance of the true boundary from the mesh, if the root model states it.
    pub deviation: Option<f64>,
}

/// Reads a package.
pub(super) fn read(bytes: &[u8], warnings: &mut Vec<MeshWarning>) -> Result<Built, Error> {
    let mut package = Package::open(bytes)?;
    let root = package.model()?;
    let text = package.text(root)?;
    let mut models = Models::default();
    let unit = models.read(&package, root, &text, true)?;
    // An error in the root model that is found after it was read.
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

/// Reads the parts to which the root model refers, and replaces references to them by numbers of objects.
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

/// The size of one instance of an object.
#[derive(Debug, Clone, Copy, Default)]
struct Total {
    vertices: u64,
    triangles: u64,
    /// Number of placements in a walk through it.
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

/// Returns the sizes of all objects. The objects of the root model come first in the list, but refer to the
/// others.
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
        // A walk does not enter objects without triangles.
        total.placed = if total.triangles > 0 { total.placed.saturating_add(1) } else { 0 };
        totals[index] = total;
    }
    Ok(totals)
}

/// Returns the size of the target of a component, once it is resolved.
fn target(totals: &[Total], component: &Component) -> Total {
    match component.target {
        Target::Object(object) => totals.get(object as usize).copied().unwrap_or_default(),
        Target::Elsewhere(..) => Total::default(),
    }
}

/// The objects of triangles, numbered in the order in which they are first placed.
struct Places {
    /// The number of each object, or a mark that it has none yet.
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

    /// Returns the attribute, if there are several objects.
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

/// Builds all triangles.
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
    // A stack of components to place, with their placements; nested as the objects are.
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
                    let [a, b, c] = triangle.each(|vertex| base + vertex);
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
