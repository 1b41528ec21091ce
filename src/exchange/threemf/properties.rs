//! Properties of a 3MF package: base materials, colour groups, and the references of triangles to them.
//!
//! A triangle names a group and a member for each corner, or uses those of its object. There are no errors
//! here: unreadable and missing properties are counted, and the mesh is read without them.

use crate::lattice::Each;
use alloc::borrow::Cow;
use alloc::string::String;
use alloc::vec::Vec;

use hashbrown::HashMap;

use super::xml::{Attribute, Xml};
use crate::error::Error;
use crate::exchange::colours::Colours;
use crate::memory;
use crate::mesh::MeshAttribute;

/// A marker in place of a group or member: there is none.
const ABSENT: u32 = u32::MAX;
/// A marker in place of a group or member: the text is no valid number. No group has this number, and no
/// group has so many members.
const WRONG: u32 = u32::MAX - 1;

/// The groups of all parts, and the references of all triangles.
#[derive(Default)]
pub(super) struct Properties {
    groups: Vec<Group>,
    /// Numbers of groups by part and identifier.
    known: HashMap<(u32, u32), u32>,
    /// The colours of all groups, one group after another; `None` for unreadable colours.
    colours: Vec<Option<[u8; 4]>>,
    /// The names of all base materials.
    materials: Vec<String>,
    /// The reference of each triangle, up to the last one that refers to something.
    references: Vec<Reference>,
}

/// A group of properties.
#[derive(Clone, Copy)]
struct Group {
    /// The index of its first colour, and the number of its colours.
    first: u32,
    count: u32,
    /// For base materials the number of the first material; `None` for other groups.
    material: Option<u32>,
    /// Whether the group is read. Members of groups of other kinds are unknown.
    is_read: bool,
}

/// The reference of an object, or of the corners of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Reference {
    group: u32,
    members: [u32; 3],
}

impl Reference {
    pub const NONE: Reference = Reference { group: ABSENT, members: [ABSENT; 3] };

    /// Reads the reference of an object.
    pub fn of_object(xml: &Xml) -> Reference {
        Self::read(xml, ["pindex", "", ""])
    }

    fn read(xml: &Xml, names: [&str; 3]) -> Reference {
        let mut reference = Reference::NONE;
        for attribute in xml.attributes().iter().filter(|attribute| attribute.prefix.is_empty()) {
            if attribute.name == "pid" {
                reference.group = number(attribute);
            } else if let Some(k) = names.iter().position(|&name| name == attribute.name) {
                reference.members[k] = number(attribute);
            }
        }
        reference
    }
}

/// Parses a number; returns a marker if it is invalid.
fn number(attribute: &Attribute) -> u32 {
    attribute.value.trim_ascii().parse().ok().filter(|&number| number < WRONG).unwrap_or(WRONG)
}

impl Properties {
    /// Begins a group of base materials, of colours, or, if `has_material` is `None`, of another kind.
    pub fn read_group(&mut self, xml: &Xml, part: u32, has_material: Option<bool>) -> Result<(), Error> {
        let id = xml.attributes().iter().find(|a| a.prefix.is_empty() && a.name == "id");
        let number = |length: usize| u32::try_from(length).map_err(|_| Error::OutOfMemory);
        let material = match has_material {
            Some(true) => Some(number(self.materials.len())?),
            _ => None,
        };
        let (first, index) = (number(self.colours.len())?, number(self.groups.len())?);
        memory::push(&mut self.groups, Group { first, count: 0, material, is_read: has_material.is_some() })?;
        self.known.try_reserve(1)?;
        if let Some(id) = id {
            // The first group with an identifier counts.
            self.known.entry((part, self::number(id))).or_insert(index);
        }
        Ok(())
    }

    /// Adds a member to the last group.
    pub fn read_member(&mut self, xml: &Xml) -> Result<(), Error> {
        let (mut colour, mut name) = (None, Cow::Borrowed(""));
        for attribute in xml.attributes().iter().filter(|attribute| attribute.prefix.is_empty()) {
            match attribute.name {
                "displaycolor" | "color" => colour = self::colour(attribute.value),
                "name" => name = xml.name(attribute).unwrap_or_default(),
                _ => {}
            }
        }
        let Some(group) = self.groups.last_mut() else { return Ok(()) };
        group.count = group.count.checked_add(1).ok_or(Error::OutOfMemory)?;
        if group.material.is_some() {
            memory::push(&mut self.materials, memory::text(&name)?)?;
        }
        memory::push(&mut self.colours, colour)
    }

    /// Reads the reference of a triangle that has the number `place` among all.
    pub fn read_triangle(&mut self, xml: &Xml, place: usize) -> Result<(), Error> {
        let reference = Reference::read(xml, ["p1", "p2", "p3"]);
        if reference == Reference::NONE {
            return Ok(());
        }
        let missing = place.saturating_sub(self.references.len());
        self.references.try_reserve(missing + 1)?;
        self.references.resize(place, Reference::NONE);
        self.references.push(reference);
        Ok(())
    }

    /// Returns the reference of the triangle with the number `place` among all.
    fn of_triangle(&self, place: usize) -> Reference {
        self.references.get(place).copied().unwrap_or(Reference::NONE)
    }

    fn has_colours(&self) -> bool {
        !self.colours.is_empty()
    }
}

/// Parses `#RRGGBB` or `#RRGGBBAA`.
fn colour(text: &str) -> Option<[u8; 4]> {
    let digits = text.trim_ascii().strip_prefix('#')?;
    if !matches!(digits.len(), 6 | 8) || !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    let mut colour = [255; 4];
    for (k, channel) in colour.iter_mut().enumerate().take(digits.len() / 2) {
        *channel = u8::from_str_radix(digits.get(2 * k..2 * k + 2)?, 16).ok()?;
    }
    Some(colour)
}

/// The properties of built triangles.
pub(super) struct BuiltProperties<'a> {
    properties: &'a Properties,
    /// A colour, numbered through all groups, for each triangle and corner.
    colours: Vec<[u32; 3]>,
    /// A base material for each triangle.
    materials: Vec<u32>,
    /// True if the corners of a triangle differ.
    has_gradients: bool,
    /// Number of triangles with a reference to something that does not exist.
    pub missing: u64,
    /// The last group that was looked up.
    last: Option<((u32, u32), Option<Group>)>,
}

impl<'a> BuiltProperties<'a> {
    /// Makes room for the given number of triangles.
    pub fn new(properties: &'a Properties, triangles: usize) -> Result<BuiltProperties<'a>, Error> {
        let with_room = |needed: bool| if needed { triangles } else { 0 };
        Ok(BuiltProperties {
            colours: memory::with_capacity(with_room(properties.has_colours()))?,
            materials: memory::with_capacity(with_room(!properties.materials.is_empty()))?,
            properties,
            has_gradients: false,
            missing: 0,
            last: None,
        })
    }

    /// Adds the triangle with the number `place` among all that were read, in an object of a part with a
    /// reference of its own. A mirrored triangle is reversed.
    pub fn push(&mut self, place: usize, part: u32, object: Reference, mirrors: bool) -> Result<(), Error> {
        let mut colours = [MeshAttribute::NO_ROW; 3];
        let mut material = MeshAttribute::NO_ROW;
        match self.members(place, part, object) {
            Ok(Some((group, members))) => {
                // Base materials are not mixed.
                colours = match group.material {
                    Some(_) => [members[0]; 3],
                    None => members,
                }
                .each(|member| group.first + member);
                material = group.material.map_or(material, |first| first + members[0]);
            }
            Ok(None) => {}
            Err(()) => self.missing += 1,
        }
        if self.properties.has_colours() {
            if mirrors {
                colours.swap(1, 2);
            }
            self.has_gradients |= colours[0] != colours[1] || colours[0] != colours[2];
            memory::push(&mut self.colours, colours)?;
        }
        if !self.properties.materials.is_empty() {
            memory::push(&mut self.materials, material)?;
        }
        Ok(())
    }

    /// Returns the group and members of a triangle; fails if they do not exist.
    fn members(
        &mut self,
        place: usize,
        part: u32,
        object: Reference,
    ) -> Result<Option<(Group, [u32; 3])>, ()> {
        let own = self.properties.of_triangle(place);
        let (id, members) = match own.members {
            [ABSENT, ..] => (object.group, [object.members[0]; 3]),
            [first, second, third] => {
                let id = if own.group == ABSENT { object.group } else { own.group };
                // If the second or third is missing, the first counts for all.
                let all = second != ABSENT && third != ABSENT;
                (id, if all { [first, second, third] } else { [first; 3] })
            }
        };
        if id == ABSENT && members[0] == ABSENT && own == Reference::NONE {
            return Ok(None);
        }
        let group = match self.last {
            Some((key, group)) if key == (part, id) => group,
            _ => {
                let index = self.properties.known.get(&(part, id));
                let group = index.and_then(|&index| self.properties.groups.get(index as usize)).copied();
                self.last = Some(((part, id), group));
                group
            }
        };
        let group = group.ok_or(())?;
        if !group.is_read {
            return Ok(None);
        }
        if members.iter().any(|&member| member >= group.count) {
            return Err(());
        }
        Ok(Some((group, members)))
    }

    /// Returns the attributes, and the number of unreadable colours. Attributes that no triangle has are left
    /// out.
    pub fn finish(self) -> Result<(Vec<MeshAttribute>, u64), Error> {
        let Properties { colours, materials, .. } = self.properties;
        let mut attributes = Vec::new();
        let mut table = Colours::default();
        for colour in colours {
            table.push(colour.map_or([f64::NAN; 4], |colour| colour.each(f64::from)))?;
        }
        let unreadable = table.unreadable;
        if self.colours.as_flattened().iter().any(|&row| row != MeshAttribute::NO_ROW) {
            let colours = if self.has_gradients {
                table.of_corners("colour", self.colours)?
            } else {
                table.of_triangles("colour", memory::collected(self.colours.iter().map(|&[row, ..]| row))?)?
            };
            memory::push(&mut attributes, colours)?;
        }
        if self.materials.iter().any(|&material| material != MeshAttribute::NO_ROW) {
            let mut names = memory::with_capacity(materials.len())?;
            for name in materials {
                names.push(memory::text(name)?);
            }
            memory::push(&mut attributes, MeshAttribute::labels("material", self.materials)?.named(names))?;
        }
        Ok((attributes, unreadable))
    }
}
