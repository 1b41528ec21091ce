//! XML as packages use it: elements and attributes with namespaces, and nothing that could expand.

use alloc::borrow::Cow;
use alloc::string::String;
use alloc::vec::Vec;

use quick_xml::Reader;
use quick_xml::events::Event;
use quick_xml::events::attributes::Attributes;

use crate::error::{Error, PackageError};
use crate::memory;

/// How deep elements may be nested, and how long the names of the open ones may be together. The reader keeps
/// them in memory that cannot be refused.
const MAX_DEPTH: usize = 64;
const MAX_NAMES: usize = 1024;
/// How long names and paths in attributes may be.
const MAX_NAME: usize = 1024;

/// The namespaces that have a meaning here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Namespace {
    /// 3MF's core.
    Core,
    /// 3MF's production extension.
    Production,
    /// An extension that does not concern shapes.
    Harmless,
    /// Protected content.
    Secure,
    /// Relationships of a package.
    Relationships,
    /// Content types of a package.
    ContentTypes,
    /// Any other, or none.
    Other,
}

impl Namespace {
    fn of(uri: &str) -> Self {
        match uri {
            "http://schemas.microsoft.com/3dmanufacturing/core/2015/02" => Self::Core,
            "http://schemas.microsoft.com/3dmanufacturing/production/2015/06" => Self::Production,
            "http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
            | "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07" => Self::Harmless,
            "http://schemas.microsoft.com/3dmanufacturing/securecontent/2019/04" => Self::Secure,
            "http://schemas.openxmlformats.org/package/2006/relationships" => Self::Relationships,
            "http://schemas.openxmlformats.org/package/2006/content-types" => Self::ContentTypes,
            _ => Self::Other,
        }
    }
}

/// A prefix that stands for a namespace within an element.
struct Binding<'a> {
    depth: usize,
    prefix: &'a str,
    namespace: Namespace,
}

/// The start of an element.
pub(super) struct Element<'a> {
    pub namespace: Namespace,
    /// Without the prefix.
    pub name: &'a str,
    /// Whether it ends at once; then no end follows.
    pub empty: bool,
    /// Where the tag begins in the part.
    pub offset: usize,
    /// What stands between the angle brackets, without the slash.
    tag: &'a str,
    name_length: usize,
}

impl Element<'_> {
    pub fn is(&self, namespace: Namespace, name: &str) -> bool {
        self.namespace == namespace && self.name == name
    }
}

pub(super) struct Attribute<'a> {
    /// Empty if there is none.
    pub prefix: &'a str,
    pub name: &'a str,
    /// As it stands, with references.
    pub value: &'a str,
    offset: usize,
}

pub(super) enum Markup<'a> {
    Start(Element<'a>),
    End,
}

/// Reads a part from its begin to its end.
pub(super) struct Xml<'a> {
    part: &'a str,
    text: &'a str,
    reader: Reader<&'a [u8]>,
    bindings: Vec<Binding<'a>>,
    /// Lengths of the names of the open elements.
    open: [u16; MAX_DEPTH],
    depth: usize,
    names: usize,
    rooted: bool,
}

impl<'a> Xml<'a> {
    /// Of a part of this name with this text.
    pub fn new(part: &'a str, text: &'a str) -> Self {
        let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
        let (reader, bindings) = (Reader::from_str(text), Vec::new());
        Self { part, text, reader, bindings, open: [0; MAX_DEPTH], depth: 0, names: 0, rooted: false }
    }

    /// The next start or end of an element; `None` at the end of a part with one element around all others.
    pub fn next(&mut self) -> Result<Option<Markup<'a>>, Error> {
        let depth = self.depth;
        while self.bindings.last().is_some_and(|binding| binding.depth > depth) {
            self.bindings.pop();
        }
        loop {
            let offset = self.position();
            let name_length = self.name_ahead(offset)?;
            let event = match self.reader.read_event() {
                Ok(event) => event,
                Err(error) => {
                    let at = usize::try_from(self.reader.error_position()).unwrap_or(offset);
                    return Err(self.error(at, alloc::format!("{error}")));
                }
            };
            match event {
                Event::Start(_) => {
                    let tag = self.text.get(offset + 1..self.position() - 1).unwrap_or("");
                    self.open[self.depth] = name_length as u16;
                    self.names += name_length;
                    self.depth += 1;
                    return self.start(tag, name_length, offset, self.depth, false).map(Some);
                }
                Event::Empty(_) => {
                    let tag = self.text.get(offset + 1..self.position() - 2).unwrap_or("");
                    return self.start(tag, name_length, offset, self.depth + 1, true).map(Some);
                }
                Event::End(_) => {
                    // The reader refuses ends without starts.
                    self.depth = self.depth.saturating_sub(1);
                    self.names -= usize::from(self.open[self.depth]);
                    return Ok(Some(Markup::End));
                }
                Event::DocType(_) => {
                    return Err(self.error(offset, "document type declarations are not allowed"));
                }
                Event::Decl(declaration) => {
                    let encoding = declaration.encoding().transpose().ok().flatten();
                    if encoding.is_some_and(|encoding| !encoding.eq_ignore_ascii_case("UTF-8")) {
                        return Err(self.error(offset, "the encoding is not UTF-8"));
                    }
                }
                Event::Eof if self.depth > 0 => {
                    return Err(self.error(offset, "the text ends within an element"));
                }
                Event::Eof if !self.rooted => return Err(self.error(offset, "there is no element at all")),
                Event::Eof => return Ok(None),
                Event::Text(text) if self.depth == 0 && !text.trim_ascii().is_empty() => {
                    return Err(self.error(offset, "text outside of any element"));
                }
                _ => {}
            }
        }
    }

    fn position(&self) -> usize {
        usize::try_from(self.reader.buffer_position()).unwrap_or(usize::MAX)
    }

    /// The length of the name of the element that begins or ends at `offset`, or 0. Checked before reading.
    fn name_ahead(&self, offset: usize) -> Result<usize, Error> {
        let rest = self.text.as_bytes().get(offset..).unwrap_or(b"");
        let Some(rest) = rest.strip_prefix(b"<") else { return Ok(0) };
        if matches!(rest.first(), Some(b'!' | b'?')) {
            return Ok(0);
        }
        let (is_end, rest) = rest.strip_prefix(b"/").map_or((false, rest), |rest| (true, rest));
        let is_outside = |b: &u8| matches!(b, b' ' | b'\t' | b'\r' | b'\n' | b'>' | b'/');
        let room = MAX_NAMES - if is_end { 0 } else { self.names };
        match rest.iter().take(room).position(is_outside) {
            Some(length) if is_end || self.depth < MAX_DEPTH => Ok(length),
            None if rest.len() < room => Ok(rest.len()),
            _ => Err(self.error(offset, "elements are nested too deeply, or have too long names")),
        }
    }

    fn start(
        &mut self,
        tag: &'a str,
        name_length: usize,
        offset: usize,
        depth: usize,
        empty: bool,
    ) -> Result<Markup<'a>, Error> {
        if depth == 1 && core::mem::replace(&mut self.rooted, true) {
            return Err(self.error(offset, "a second element stands beside the one around all others"));
        }
        let qualified = tag.get(..name_length).unwrap_or(tag);
        let mut element =
            Element { namespace: Namespace::Other, name: qualified, empty, offset, tag, name_length };
        if tag.contains("xmlns") {
            for attribute in self.attributes(&element) {
                let attribute = attribute?;
                let prefix = match (attribute.prefix, attribute.name) {
                    ("", "xmlns") => "",
                    ("xmlns", prefix) => prefix,
                    _ => continue,
                };
                let namespace = Namespace::of(attribute.value);
                memory::push(&mut self.bindings, Binding { depth, prefix, namespace })?;
            }
        }
        let (prefix, name) = qualified.split_once(':').unwrap_or(("", qualified));
        element.name = name;
        element.namespace = self.namespace(prefix);
        Ok(Markup::Start(element))
    }

    /// What a prefix stands for at this place; the empty one for the default of elements.
    pub fn namespace(&self, prefix: &str) -> Namespace {
        let bound = self.bindings.iter().rfind(|binding| binding.prefix == prefix);
        bound.map_or(Namespace::Other, |binding| binding.namespace)
    }

    /// The attributes of an element, those that bind prefixes among them.
    pub fn attributes(
        &self,
        element: &Element<'a>,
    ) -> impl Iterator<Item = Result<Attribute<'a>, Error>> + use<'a> {
        let (part, text, offset) = (self.part, self.text, element.offset);
        let mut attributes = Attributes::new(element.tag, element.name_length);
        // Whether one stands twice is checked where it matters.
        attributes.with_checks(false);
        attributes.map(move |attribute| {
            let attribute =
                attribute.map_err(|error| error_at(part, text, offset, alloc::format!("{error}")))?;
            let key = attribute.key.0;
            let (prefix, name) = key.split_once(':').unwrap_or(("", key));
            // A value is a piece of the tag.
            let Cow::Borrowed(value) = attribute.value else {
                return Err(error_at(part, text, offset, "an attribute cannot be read"));
            };
            Ok(Attribute { prefix, name, value, offset })
        })
    }

    /// An attribute's value as a finite number.
    pub fn number(&self, attribute: &Attribute) -> Result<f64, Error> {
        match attribute.value.trim_ascii().parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self.attribute_error(attribute, "is no finite number")),
        }
    }

    /// An attribute's value as an index or identifier.
    pub fn index(&self, attribute: &Attribute) -> Result<u32, Error> {
        match attribute.value.trim_ascii().parse::<u32>() {
            Ok(number) if number < 1 << 31 => Ok(number),
            _ => Err(self.attribute_error(attribute, "is no whole number from 0 to 2147483647")),
        }
    }

    /// An attribute's value as a name or path, its references replaced.
    pub fn name(&self, attribute: &Attribute<'a>) -> Result<Cow<'a, str>, Error> {
        if attribute.value.len() > MAX_NAME {
            return Err(self.attribute_error(attribute, "is too long"));
        }
        quick_xml::escape::unescape(attribute.value)
            .map_err(|error| self.error(attribute.offset, alloc::format!("{error}")))
    }

    /// An error about an attribute.
    pub fn attribute_error(&self, attribute: &Attribute, problem: &str) -> Error {
        let value: String = attribute.value.chars().take(40).collect();
        let name: String = attribute.name.chars().take(40).collect();
        self.error(attribute.offset, alloc::format!("{name}=\"{value}\" {problem}"))
    }

    /// An error at a place.
    #[cold]
    pub fn error(&self, offset: usize, problem: impl Into<String>) -> Error {
        error_at(self.part, self.text, offset, problem)
    }
}

/// An error in the line where `offset` is.
#[cold]
pub(super) fn error_at(part: &str, text: &str, offset: usize, problem: impl Into<String>) -> Error {
    let before = text.as_bytes().get(..offset).unwrap_or(text.as_bytes());
    let line = 1 + before.iter().filter(|&&b| b == b'\n').count() as u64;
    PackageError::new(part, (line, offset as u64), problem.into()).into()
}
