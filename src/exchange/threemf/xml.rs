//! XML of 3MF packages: elements and attributes with namespaces, without anything that could expand.

use alloc::borrow::Cow;
use alloc::string::String;
use alloc::vec::Vec;

use quick_xml::Reader;
use quick_xml::events::Event;
use quick_xml::events::attributes::Attributes;

use crate::error::{Error, PackageError};
use crate::memory;

/// Maximum nesting of elements, and maximum total length of the names of the open elements. The reader keeps
/// these names in memory whose allocation cannot fail gracefully.
const MAX_DEPTH: usize = 64;
const MAX_NAMES: usize = 1024;
/// Maximum length of names and paths in attributes.
const MAX_NAME: usize = 1024;
/// Maximum number of prefixes with a namespace at one place. A look-up takes as many steps.
const MAX_BINDINGS: usize = 256;

/// The known namespaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Namespace {
    /// 3MF's core.
    Core,
    /// 3MF's core as in the draft 0.93. The elements that are read have the same meaning.
    Draft,
    /// 3MF's production extension.
    Production,
    /// 3MF's materials extension.
    Materials,
    /// An extension that does not concern shapes.
    Harmless,
    /// Another extension of 3MF, of this name.
    Extension(&'static str),
    /// Relationships of a package.
    Relationships,
    /// Content types of a package.
    ContentTypes,
    /// Any other namespace, or none.
    Other,
}

impl Namespace {
    fn of(uri: &str) -> Self {
        match uri {
            "http://schemas.microsoft.com/3dmanufacturing/core/2015/02" => Self::Core,
            "http://schemas.microsoft.com/3dmanufacturing/2013/01" => Self::Draft,
            "http://schemas.microsoft.com/3dmanufacturing/production/2015/06" => Self::Production,
            "http://schemas.microsoft.com/3dmanufacturing/material/2015/02" => Self::Materials,
            "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07" => Self::Harmless,
            "http://schemas.openxmlformats.org/package/2006/relationships" => Self::Relationships,
            "http://schemas.openxmlformats.org/package/2006/content-types" => Self::ContentTypes,
            _ => extension(uri).map_or(Self::Other, Self::Extension),
        }
    }
}

/// Returns the name of an extension that cannot be read. Versions of an extension differ after its name in
/// the address.
fn extension(uri: &str) -> Option<&'static str> {
    const EXTENSIONS: [(&str, &str); 11] = [
        ("beamlattice/balls/", "Beam Lattice: Balls"),
        ("beamlattice/", "Beam Lattice"),
        ("booleanoperations/", "Boolean Operations"),
        ("displacement/", "Displacement"),
        ("implicit/", "Volumetric: Implicit Functions"),
        ("material/", "Materials and Properties"),
        ("production/alternatives/", "Production: Alternatives"),
        ("production/", "Production"),
        ("securecontent/", "Secure Content"),
        ("slice/", "Slice"),
        ("volumetric/", "Volumetric"),
    ];
    let path = ["http://schemas.microsoft.com/3dmanufacturing/", "http://schemas.3mf.io/3dmanufacturing/"]
        .into_iter()
        .find_map(|base| uri.strip_prefix(base))?;
    EXTENSIONS.into_iter().find(|(start, _)| path.starts_with(start)).map(|(_, name)| name)
}

/// A prefix that is bound to a namespace within an element.
struct Binding<'a> {
    depth: usize,
    prefix: &'a str,
    uri: &'a str,
    namespace: Namespace,
}

/// The start of an element.
pub(super) struct Element<'a> {
    pub namespace: Namespace,
    /// The name without the prefix.
    pub name: &'a str,
    /// True if the element ends in the same tag; then no end follows.
    pub empty: bool,
    /// The byte offset of the tag in the part.
    pub offset: usize,
}

impl Element<'_> {
    pub fn is(&self, namespace: Namespace, name: &str) -> bool {
        self.namespace == namespace && self.name == name
    }
}

#[derive(Clone, Copy)]
pub(super) struct Attribute<'a> {
    /// The prefix; empty if there is none.
    pub prefix: &'a str,
    pub name: &'a str,
    /// The raw value, with references.
    pub value: &'a str,
    offset: usize,
}

pub(super) enum Markup<'a> {
    Start(Element<'a>),
    End,
}

/// The text of a part.
pub(super) struct Text {
    pub text: String,
    /// The encoding, as a declaration in the text names it.
    encoding: &'static str,
}

impl Text {
    /// Decodes UTF-8, and UTF-16 that begins with a byte order mark.
    ///
    /// # Errors
    /// The problem, or `None` if there is not enough memory.
    pub fn decode(bytes: Vec<u8>) -> Result<Self, Option<String>> {
        let order: fn([u8; 2]) -> u16 = match *bytes {
            [0xFE, 0xFF, ..] => u16::from_be_bytes,
            [0xFF, 0xFE, ..] => u16::from_le_bytes,
            [b'<', 0, ..] | [0, b'<', ..] => {
                return Err(Some("is a text in UTF-16 without its byte order mark".into()));
            }
            _ => {
                let mut text = String::from_utf8(bytes).map_err(|error| {
                    let at = error.utf8_error().valid_up_to();
                    alloc::format!("is no UTF-8 text from byte {at} on")
                })?;
                if text.starts_with('\u{FEFF}') {
                    text.drain(..'\u{FEFF}'.len_utf8());
                }
                return Ok(Self { text, encoding: "UTF-8" });
            }
        };
        let (units, rest) = bytes.as_chunks::<2>();
        let mut text = String::new();
        // A UTF-16 unit becomes at most three bytes.
        text.try_reserve_exact(3 * units.len()).map_err(|_| None)?;
        for (k, character) in char::decode_utf16(units.iter().skip(1).map(|&unit| order(unit))).enumerate() {
            let problem = || alloc::format!("is no UTF-16 text from character {} on", k + 1);
            text.push(character.map_err(|_| Some(problem()))?);
        }
        if !rest.is_empty() {
            return Err(Some("is no UTF-16 text: its number of bytes is odd".into()));
        }
        Ok(Self { text, encoding: "UTF-16" })
    }
}

/// A reader of a part from its beginning to its end.
pub(super) struct Xml<'a> {
    part: &'a str,
    text: &'a str,
    /// The encoding of the text.
    encoding: &'static str,
    reader: Reader<&'a [u8]>,
    bindings: Vec<Binding<'a>>,
    /// The attributes of the last element.
    attributes: Vec<Attribute<'a>>,
    /// Lengths of the names of the open elements.
    open: [u16; MAX_DEPTH],
    depth: usize,
    names: usize,
    rooted: bool,
}

impl<'a> Xml<'a> {
    /// Makes a reader of a part with this name and this text.
    pub fn new(part: &'a str, text: &'a Text) -> Self {
        let Text { ref text, encoding } = *text;
        Self {
            part,
            text,
            encoding,
            reader: Reader::from_str(text),
            bindings: Vec::new(),
            attributes: Vec::new(),
            open: [0; MAX_DEPTH],
            depth: 0,
            names: 0,
            rooted: false,
        }
    }

    /// Returns the text after the latest start, up to the next markup.
    pub fn content_ahead(&self) -> &'a str {
        let rest = self.text.get(self.position()..).unwrap_or("");
        rest.split('<').next().unwrap_or("")
    }

    /// Returns the next start or end of an element; `None` at the end of a part with one root element.
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
                    if encoding.is_some_and(|encoding| !encoding.eq_ignore_ascii_case(self.encoding)) {
                        let problem =
                            alloc::format!("the encoding is not {}, but the text is", self.encoding);
                        return Err(self.error(offset, problem));
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

    /// Returns the length of the name of the element that begins or ends at `offset`, or 0. Checked before
    /// reading.
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
            return Err(self.error(offset, "there is a second element beside the root element"));
        }
        let qualified = tag.get(..name_length).unwrap_or(tag);
        self.read_attributes(tag, name_length, offset)?;
        for attribute in &self.attributes {
            let prefix = match (attribute.prefix, attribute.name) {
                ("", "xmlns") => "",
                ("xmlns", prefix) => prefix,
                _ => continue,
            };
            if self.bindings.len() == MAX_BINDINGS {
                return Err(self.error(offset, "too many prefixes of namespaces"));
            }
            let uri = attribute.value;
            memory::push(&mut self.bindings, Binding { depth, prefix, uri, namespace: Namespace::of(uri) })?;
        }
        self.check_attributes()?;
        let (prefix, name) = qualified.split_once(':').unwrap_or(("", qualified));
        Ok(Markup::Start(Element { namespace: self.namespace(prefix), name, empty, offset }))
    }

    fn read_attributes(&mut self, tag: &'a str, name_length: usize, offset: usize) -> Result<(), Error> {
        self.attributes.clear();
        let mut found = Attributes::new(tag, name_length);
        // The reader's own check allocates memory in a way that cannot fail gracefully.
        found.with_checks(false);
        for attribute in found {
            let attribute = attribute.map_err(|error| self.error(offset, alloc::format!("{error}")))?;
            let key = attribute.key.0;
            let (prefix, name) = key.split_once(':').unwrap_or(("", key));
            // A value is a slice of the tag.
            let Cow::Borrowed(value) = attribute.value else {
                return Err(self.error(offset, "an attribute cannot be read"));
            };
            memory::push(&mut self.attributes, Attribute { prefix, name, value, offset })?;
        }
        Ok(())
    }

    /// Checks that no attribute occurs twice in the element, not even by two prefixes of one namespace.
    fn check_attributes(&self) -> Result<(), Error> {
        let key = |attribute: &Attribute<'a>| match attribute.prefix {
            "" => ("", attribute.name),
            prefix => (self.binding(prefix).map_or(prefix, |binding| binding.uri), attribute.name),
        };
        let twice = if self.attributes.len() <= 8 {
            let is_twice = |&(k, attribute): &(usize, &Attribute<'a>)| {
                let mut before = self.attributes[..k].iter().filter(|other| other.name == attribute.name);
                before.any(|other| key(other) == key(attribute))
            };
            self.attributes.iter().enumerate().find(is_twice).map(|(_, attribute)| *attribute)
        } else {
            let mut sorted = memory::with_capacity(self.attributes.len())?;
            sorted.extend(self.attributes.iter().map(|attribute| (key(attribute), attribute)));
            sorted.sort_unstable_by_key(|&(key, _)| key);
            sorted.windows(2).find(|pair| pair[0].0 == pair[1].0).map(|pair| *pair[1].1)
        };
        match twice {
            Some(attribute) => Err(self.attribute_error(&attribute, "occurs a second time")),
            None => Ok(()),
        }
    }

    /// Returns the namespace of a prefix at this place; the empty prefix gives the default namespace of
    /// elements.
    pub fn namespace(&self, prefix: &str) -> Namespace {
        self.binding(prefix).map_or(Namespace::Other, |binding| binding.namespace)
    }

    /// Returns the address of the namespace of a prefix at this place.
    pub fn uri(&self, prefix: &str) -> Option<&'a str> {
        self.binding(prefix).map(|binding| binding.uri)
    }

    fn binding(&self, prefix: &str) -> Option<&Binding<'a>> {
        self.bindings.iter().rfind(|binding| binding.prefix == prefix)
    }

    /// Returns the attributes of the last element, including those that bind prefixes. All of them are
    /// different.
    pub fn attributes(&self) -> &[Attribute<'a>] {
        &self.attributes
    }

    /// Parses an attribute's value as a finite number.
    pub fn number(&self, attribute: &Attribute) -> Result<f64, Error> {
        match attribute.value.trim_ascii().parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self.attribute_error(attribute, "is no finite number")),
        }
    }

    /// Parses an attribute's value as an index or identifier.
    pub fn index(&self, attribute: &Attribute) -> Result<u32, Error> {
        match attribute.value.trim_ascii().parse::<u32>() {
            Ok(number) if number < 1 << 31 => Ok(number),
            _ => Err(self.attribute_error(attribute, "is no whole number from 0 to 2147483647")),
        }
    }

    /// Returns an attribute's value as a name or path, with its references replaced.
    pub fn name(&self, attribute: &Attribute<'a>) -> Result<Cow<'a, str>, Error> {
        if attribute.value.len() > MAX_NAME {
            return Err(self.attribute_error(attribute, "is too long"));
        }
        quick_xml::escape::unescape(attribute.value)
            .map_err(|error| self.error(attribute.offset, alloc::format!("{error}")))
    }

    /// Makes an error about an attribute.
    pub fn attribute_error(&self, attribute: &Attribute, problem: &str) -> Error {
        let value: String = attribute.value.chars().take(40).collect();
        let name: String = attribute.name.chars().take(40).collect();
        self.error(attribute.offset, alloc::format!("{name}=\"{value}\" {problem}"))
    }

    /// Makes an error at a place.
    #[cold]
    pub fn error(&self, offset: usize, problem: impl Into<String>) -> Error {
        error_at(self.part, self.text, offset, problem)
    }
}

/// Makes an error for the line that contains `offset`.
#[cold]
pub(super) fn error_at(part: &str, text: &str, offset: usize, problem: impl Into<String>) -> Error {
    let before = text.as_bytes().get(..offset).unwrap_or(text.as_bytes());
    let line = 1 + before.iter().filter(|&&b| b == b'\n').count() as u64;
    PackageError::new(part, (line, offset as u64), problem.into()).into()
}
