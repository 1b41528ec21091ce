//! Model parts of a 3MF: objects of meshes or of components, and the build.

use alloc::string::String;
use alloc::vec::Vec;
use core::ops::Range;

use hashbrown::HashMap;

use super::package::Package;
use super::properties::{Properties, Reference};
use super::transform::Transform;
use super::xml::{Attribute, Element, Markup, Namespace, Text, Xml};
use crate::error::Error;
use crate::exchange::{LengthUnit, stated};
use crate::memory;

/// The name of the metadata that states the maximum distance of the true boundary from the mesh.
pub(in crate::exchange) const DEVIATION: &str = "leafless:deviation";

/// The contents of all model parts of a package.
#[derive(Default)]
pub(super) struct Models {
    pub vertices: Vec<[f64; 3]>,
    /// Indices are relative to the object's first vertex.
    pub triangles: Vec<[u32; 3]>,
    pub components: Vec<Component>,
    pub objects: Vec<Object>,
    /// The build items.
    pub items: Vec<Component>,
    /// Objects by part and identifier.
    pub known: HashMap<(u32, u32), u32>,
    /// The properties, and the references of triangles to them.
    pub properties: Properties,
    /// True if a part is of the draft 0.93.
    pub draft: bool,
    /// Maximum distance of the true boundary from the mesh, as the root model states it.
    pub deviation: Option<f64>,
}

pub(super) struct Object {
    pub purpose: Purpose,
    pub shape: Shape,
    /// The part that contains the object.
    pub part: u32,
    /// The property of triangles that refer to nothing.
    pub property: Reference,
    /// The name; empty if there is none.
    pub name: String,
}

/// The purpose of an object. It has no meaning for objects of components.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    /// A solid.
    Model,
    /// A support, a mere surface, or something else.
    Other,
}

pub(super) enum Shape {
    /// Unknown content.
    Unknown,
    /// Ranges of vertices and triangles.
    Mesh(Range<usize>, Range<usize>),
    /// A range of components.
    Components(Range<usize>),
}

/// An object that is placed in another object, or in the build.
#[derive(Clone, Copy)]
pub(super) struct Component {
    pub target: Target,
    pub transform: Transform,
    /// Its byte offset in its part.
    pub offset: usize,
}

#[derive(Clone, Copy)]
pub(super) enum Target {
    /// An object, by its number among all.
    Object(u32),
    /// An object in another part, by the part and the identifier there.
    Elsewhere(u32, u32),
}

/// A known element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Node {
    Model,
    Resources,
    /// A group of properties.
    Group,
    Object,
    Mesh,
    Vertices,
    Triangles,
    Components,
    Build,
    /// Any other element. Its content is skipped.
    Skipped,
}

impl Models {
    /// Returns the number of an object among all.
    pub fn find(&self, part: u32, id: u32) -> Option<u32> {
        self.known.get(&(part, id)).copied()
    }

    /// Adds the objects of a part, and its build if it is the root. Returns the part's unit.
    pub fn read(
        &mut self,
        package: &Package,
        part: u32,
        text: &Text,
        is_root: bool,
    ) -> Result<LengthUnit, Error> {
        let name = package.name(part);
        let mut xml = Xml::new(&name, text);
        let mut unit = LengthUnit::Millimetre;
        let mut has_build = false;
        // The reader limits the depth.
        let mut nodes = memory::with_capacity(64)?;
        while let Some(markup) = xml.next()? {
            let Markup::Start(element) = markup else {
                nodes.pop();
                continue;
            };
            let core = matches!(element.namespace, Namespace::Core | Namespace::Draft);
            let node = match (nodes.last(), element.name) {
                (None, "model") if core => {
                    self.draft |= element.namespace == Namespace::Draft;
                    unit = read_model(&xml)?;
                    Node::Model
                }
                (None, _) => return Err(xml.error(element.offset, "this is no 3MF model")),
                (Some(Node::Vertices), "vertex") if core => {
                    self.read_vertex(&xml, &element)?;
                    Node::Skipped
                }
                (Some(Node::Triangles), "triangle") if core => {
                    self.read_triangle(&xml, &element)?;
                    Node::Skipped
                }
                (Some(Node::Model), "resources") if core => Node::Resources,
                (Some(Node::Model), "metadata") if core && is_root => {
                    let is_it =
                        |a: &Attribute| a.prefix.is_empty() && a.name == "name" && a.value == DEVIATION;
                    if !element.empty && xml.attributes().iter().any(is_it) {
                        self.deviation = self.deviation.or(stated::parsed(xml.content_ahead()));
                    }
                    Node::Skipped
                }
                (Some(Node::Model), "build") if core && is_root => {
                    has_build = true;
                    Node::Build
                }
                (Some(Node::Resources), "basematerials") if element.namespace == Namespace::Core => {
                    self.properties.read_group(&xml, part, Some(true))?;
                    Node::Group
                }
                (Some(Node::Resources), "colorgroup") if element.namespace == Namespace::Materials => {
                    self.properties.read_group(&xml, part, Some(false))?;
                    Node::Group
                }
                (Some(Node::Resources), _) if element.namespace == Namespace::Materials => {
                    self.properties.read_group(&xml, part, None)?;
                    Node::Skipped
                }
                (Some(Node::Group), "base") if element.namespace == Namespace::Core => {
                    self.properties.read_member(&xml)?;
                    Node::Skipped
                }
                (Some(Node::Group), "color") if element.namespace == Namespace::Materials => {
                    self.properties.read_member(&xml)?;
                    Node::Skipped
                }
                (Some(Node::Resources), "object") if core => {
                    self.read_object(&xml, &element, part)?;
                    Node::Object
                }
                (Some(Node::Object), "mesh") if core => {
                    let (v, t) = (self.vertices.len(), self.triangles.len());
                    self.give_shape(&xml, &element, Shape::Mesh(v..v, t..t))?;
                    Node::Mesh
                }
                (Some(Node::Mesh), "vertices") if core => Node::Vertices,
                (Some(Node::Mesh), "triangles") if core => Node::Triangles,
                (Some(Node::Object), "components") if core => {
                    let c = self.components.len();
                    self.give_shape(&xml, &element, Shape::Components(c..c))?;
                    Node::Components
                }
                (Some(Node::Components), "component") if core => {
                    let component =
                        self.read_component(&xml, &element, package, part, is_root, self.objects.len() - 1)?;
                    memory::push(&mut self.components, component)?;
                    if let Some(Object { shape: Shape::Components(range), .. }) = self.objects.last_mut() {
                        range.end = self.components.len();
                    }
                    Node::Skipped
                }
                (Some(Node::Build), "item") if core => {
                    let item =
                        self.read_component(&xml, &element, package, part, is_root, self.objects.len())?;
                    memory::push(&mut self.items, item)?;
                    Node::Skipped
                }
                _ => Node::Skipped,
            };
            if !element.empty {
                memory::push(&mut nodes, node)?;
            }
        }
        if is_root && !has_build {
            return Err(xml.error(text.text.len(), "the model has no build"));
        }
        Ok(unit)
    }

    fn read_object(&mut self, xml: &Xml, element: &Element, part: u32) -> Result<(), Error> {
        let (mut id, mut purpose, mut name) = (None, Purpose::Model, String::new());
        for attribute in xml.attributes() {
            match (attribute.prefix, attribute.name) {
                ("", "id") => id = Some(xml.index(attribute)?),
                ("", "type") => {
                    purpose = match attribute.value.trim_ascii() {
                        "model" => Purpose::Model,
                        "solidsupport" | "support" | "surface" | "other" => Purpose::Other,
                        _ => return Err(xml.attribute_error(attribute, "is no type of objects")),
                    };
                }
                ("", "name") => name = memory::text(&xml.name(attribute).unwrap_or_default())?,
                // An attribute of the slice or the production extension, which the model need not even
                // require.
                (_, "meshresolution" | "modelresolution") if attribute.value.trim_ascii() != "fullres" => {
                    return Err(xml.attribute_error(attribute, "says that the mesh is not the true shape"));
                }
                _ => {}
            }
        }
        let id = id.ok_or_else(|| xml.error(element.offset, "the object has no id"))?;
        let index = u32::try_from(self.objects.len()).map_err(|_| Error::OutOfMemory)?;
        self.known.try_reserve(1)?;
        if self.known.insert((part, id), index).is_some() {
            return Err(xml.error(element.offset, alloc::format!("object {id} is defined a second time")));
        }
        let is_draft = element.namespace == Namespace::Draft;
        let property = if is_draft { Reference::NONE } else { Reference::of_object(xml) };
        memory::push(&mut self.objects, Object { purpose, shape: Shape::Unknown, part, property, name })
    }

    fn give_shape(&mut self, xml: &Xml, element: &Element, shape: Shape) -> Result<(), Error> {
        match self.objects.last_mut() {
            Some(object) if matches!(object.shape, Shape::Unknown) => {
                object.shape = shape;
                Ok(())
            }
            _ => Err(xml.error(element.offset, "the object has a second shape")),
        }
    }

    fn read_vertex(&mut self, xml: &Xml, element: &Element) -> Result<(), Error> {
        let mut found = [None; 3];
        for attribute in xml.attributes() {
            let axis = match (attribute.prefix, attribute.name) {
                ("", "x") => 0,
                ("", "y") => 1,
                ("", "z") => 2,
                _ => continue,
            };
            found[axis] = Some(xml.number(attribute)?);
        }
        let [Some(x), Some(y), Some(z)] = found else {
            return Err(xml.error(element.offset, "the vertex lacks x, y or z"));
        };
        memory::push(&mut self.vertices, [x, y, z])?;
        if let Some(Object { shape: Shape::Mesh(vertices, _), .. }) = self.objects.last_mut() {
            vertices.end = self.vertices.len();
        }
        Ok(())
    }

    fn read_triangle(&mut self, xml: &Xml, element: &Element) -> Result<(), Error> {
        let Some(Object { shape: Shape::Mesh(vertices, triangles), .. }) = self.objects.last_mut() else {
            return Ok(());
        };
        let mut found = [None; 3];
        for attribute in xml.attributes() {
            let corner = match (attribute.prefix, attribute.name) {
                ("", "v1") => 0,
                ("", "v2") => 1,
                ("", "v3") => 2,
                _ => continue,
            };
            let index = xml.index(attribute)?;
            if index as usize >= vertices.len() {
                let problem = alloc::format!("is no vertex, of which there are {}", vertices.len());
                return Err(xml.attribute_error(attribute, &problem));
            }
            found[corner] = Some(index);
        }
        let [Some(a), Some(b), Some(c)] = found else {
            return Err(xml.error(element.offset, "the triangle lacks v1, v2 or v3"));
        };
        if element.namespace == Namespace::Core {
            self.properties.read_triangle(xml, self.triangles.len())?;
        }
        memory::push(&mut self.triangles, [a, b, c])?;
        triangles.end = self.triangles.len();
        Ok(())
    }

    /// Reads a component. In the same part it may only refer to the first `finished` objects, so there are no
    /// cycles.
    fn read_component(
        &self,
        xml: &Xml,
        element: &Element,
        package: &Package,
        part: u32,
        is_root: bool,
        finished: usize,
    ) -> Result<Component, Error> {
        let (mut id, mut place, mut transform) = (None, part, Transform::IDENTITY);
        for attribute in xml.attributes() {
            match (attribute.prefix, attribute.name) {
                ("", "objectid") => id = Some(xml.index(attribute)?),
                ("", "transform") => {
                    transform = Transform::parse(attribute.value)
                        .ok_or_else(|| xml.attribute_error(attribute, "is not twelve finite numbers"))?;
                }
                (prefix, "path") if !prefix.is_empty() && xml.namespace(prefix) == Namespace::Production => {
                    if !is_root {
                        return Err(xml.attribute_error(attribute, "is only allowed in the root model"));
                    }
                    let path = xml.name(attribute)?;
                    place = package
                        .find(&path)?
                        .ok_or_else(|| xml.attribute_error(attribute, "is missing in the package"))?;
                }
                _ => {}
            }
        }
        let id = id.ok_or_else(|| xml.error(element.offset, "there is no objectid"))?;
        let offset = element.offset;
        let target = if place == part {
            let object = self.find(part, id).filter(|&object| (object as usize) < finished);
            let problem = || alloc::format!("object {id} is not defined before this place");
            Target::Object(object.ok_or_else(|| xml.error(offset, problem()))?)
        } else {
            Target::Elsewhere(place, id)
        };
        Ok(Component { target, transform, offset })
    }
}

/// Reads the root element: the unit, and whether it requires an unknown extension.
fn read_model(xml: &Xml) -> Result<LengthUnit, Error> {
    let mut unit = LengthUnit::Millimetre;
    for attribute in xml.attributes() {
        match (attribute.prefix, attribute.name) {
            ("", "unit") => {
                unit = match attribute.value.trim_ascii() {
                    "micron" => LengthUnit::Micrometre,
                    "millimeter" => LengthUnit::Millimetre,
                    "centimeter" => LengthUnit::Centimetre,
                    "inch" => LengthUnit::Inch,
                    "foot" => LengthUnit::Foot,
                    "meter" => LengthUnit::Metre,
                    _ => return Err(xml.attribute_error(attribute, "is no unit of 3MF")),
                };
            }
            ("", "requiredextensions") => {
                for prefix in attribute.value.split_ascii_whitespace() {
                    let what = match xml.namespace(prefix) {
                        Namespace::Core
                        | Namespace::Draft
                        | Namespace::Production
                        | Namespace::Materials
                        | Namespace::Harmless => continue,
                        Namespace::Extension(name) => alloc::format!("the 3MF extension \"{name}\""),
                        _ => match xml.uri(prefix) {
                            Some(uri) => {
                                let uri: String = uri.chars().take(120).collect();
                                alloc::format!("the unknown extension {uri}")
                            }
                            None => "an extension by a prefix that stands for nothing".into(),
                        },
                    };
                    let problem = alloc::format!("requires {what}, which cannot be read");
                    return Err(xml.attribute_error(attribute, &problem));
                }
            }
            _ => {}
        }
    }
    Ok(unit)
}
