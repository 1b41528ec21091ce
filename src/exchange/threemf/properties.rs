//! Properties of a package: base materials and colour groups, and which of them triangles refer to.
//!
//! A triangle names a group and a member for each corner, or has those of its object. Nothing here is an
//! error: what cannot be read, or is not there, is counted, and the mesh is read as if there were no
//! properties.

use alloc::borrow::Cow;
use alloc::string::String;
use alloc::vec::Vec;

use hashbrown::HashMap;

use super::xml::{Attribute, Xml};
use crate::error::Error;
use crate::exchange::colours::Colours;
use crate::memory;
use crate::mesh::MeshAttribute;

/// In the place of a group or member: there is none.
const ABSENT: u32 = u32::MAX;
/// In the place of a group or member: something that is no number. No group has it, and no group so many
/// members.
const WRONG: u32 = u32::MAX - 1;

/// The groups of all parts, and the references of all triangles.
#[derive(Default)]
pub(super) struct Properties {
    groups: Vec<Group>,
    /// By part and identifier.
    known: HashMap<(u32, u32), u32>,
    /// The colours of all groups, one group behind the other; `None` cannot be read.
    colours: Vec<Option<[u8; 4]>>,
    /// The names of all base materials.
    materials: Vec<String>,
    /// Of each triangle up to the last one that refers to something.
    references: Vec<Reference>,
}

/// A group of properties.
#[derive(Clone, Copy)]
struct Group {
    /// The first of its colours, and how many it has.
    first: u32,
    count: u32,
    /// Of base materials the first one's number; of other groups nothing.
    material: Option<u32>,
    /// Whether it is read: a group of another kind has members that are not known here.
    is_read: bool,
}

/// What an object, or the corners of a triangle, refer to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Reference {
    group: u32,
    members: [u32; 3],
}

impl Reference {
    pub const NONE: Reference = Reference { group: ABSENT, members: [ABSENT; 3] };

    /// Of an object.
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

/// A number, or that it is none.
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
            // The first one of an identifier counts.
            self.known.entry((part, self::number(id))).or_insert(index);
        }
        Ok(())
    }

    /// Adds a member of the group that began last.
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

    /// Reads what a triangle refers to, which has this place among all.
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

    /// What the triangle at this place among all refers to.
    fn of_triangle(&self, place: usize) -> Reference {
        self.references.get(place).copied().unwrap_or(Reference::NONE)
    }

    fn has_colours(&self) -> bool {
        !self.colours.is_empty()
    }
}

/// `#RRGGBB` or `#RRGGBBAA`.
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

/// What the triangles of a build have.
pub(super) struct BuiltProperties<'a> {
    properties: &'a Properties,
    /// For each triangle and corner a colour of all groups.
    colours: Vec<[u32; 3]>,
    /// For each triangle a base material.
    materials: Vec<u32>,
    /// Whether the corners of a triangle differ.
    has_gradients: bool,
    /// Triangles that refer to something that is not there.
    pub missing: u64,
    /// The group that was looked up last.
    last: Option<((u32, u32), Option<Group>)>,
}

impl<'a> BuiltProperties<'a> {
    /// Of so many triangles.
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

    /// Adds the triangle at a place among all that were read, in an object of a part with a reference of its
    /// own. A mirrored one is turned round.
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
                .map(|member| group.first + member);
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

    /// The group and members that a triangle has; fails if they are not there.
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
                // If one of the others is left out the first counts for all.
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

    /// The attributes, and how many colours could not be read. What no triangle has is left out.
    pub fn finish(self) -> Result<(Vec<MeshAttribute>, u64), Error> {
        let Properties { colours, materials, .. } = self.properties;
        let mut attributes = Vec::new();
        let mut table = Colours::default();
        for colour in colours {
            table.push(colour.map_or([f64::NAN; 4], |colour| colour.map(f64::from)))?;
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
