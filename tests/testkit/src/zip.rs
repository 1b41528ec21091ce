//! ZIP archives, valid or damaged as a test needs them.

/// A file in an archive with the fields of its headers.
#[derive(Clone)]
pub struct Entry {
    pub name: Vec<u8>,
    pub data: Vec<u8>,
    pub method: u16,
    pub flags: u16,
    pub crc: u32,
    pub length: u32,
}

impl Entry {
    pub fn stored(name: &str, content: impl AsRef<[u8]>) -> Entry {
        let content = content.as_ref();
        let (crc, length) = (crc32fast::hash(content), content.len() as u32);
        Entry { name: name.into(), data: content.to_vec(), method: 0, flags: 0, crc, length }
    }

    pub fn deflated(name: &str, content: impl AsRef<[u8]>) -> Entry {
        let stored = Entry::stored(name, content);
        let data = miniz_oxide::deflate::compress_to_vec(&stored.data, 9);
        Entry { data, method: 8, ..stored }
    }
}

/// Returns the archive of these files.
pub fn zip(entries: &[Entry]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut directory = Vec::new();
    for entry in entries {
        let offset = bytes.len() as u32;
        let mut header = Vec::new();
        header.extend(20u16.to_le_bytes());
        header.extend(entry.flags.to_le_bytes());
        header.extend(entry.method.to_le_bytes());
        header.extend([0; 4]);
        header.extend(entry.crc.to_le_bytes());
        header.extend((entry.data.len() as u32).to_le_bytes());
        header.extend(entry.length.to_le_bytes());
        header.extend((entry.name.len() as u16).to_le_bytes());
        header.extend([0; 2]);
        bytes.extend(b"PK\x03\x04");
        bytes.extend(&header);
        bytes.extend(&entry.name);
        bytes.extend(&entry.data);
        directory.extend(b"PK\x01\x02");
        directory.extend(20u16.to_le_bytes());
        directory.extend(&header);
        directory.extend([0; 10]);
        directory.extend(offset.to_le_bytes());
        directory.extend(&entry.name);
    }
    let start = bytes.len() as u32;
    bytes.extend(&directory);
    bytes.extend(b"PK\x05\x06");
    bytes.extend([0; 4]);
    bytes.extend((entries.len() as u16).to_le_bytes());
    bytes.extend((entries.len() as u16).to_le_bytes());
    bytes.extend((directory.len() as u32).to_le_bytes());
    bytes.extend(start.to_le_bytes());
    bytes.extend([0; 2]);
    bytes
}

pub const CONTENT_TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
  <Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
  <Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>"#;

pub const RELATIONSHIPS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
  <Relationship Target="/Metadata/thumbnail.png" Id="rel0" Type="http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail"/>
  <Relationship Target="/3D/3dmodel.model" Id="rel1" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>"#;

/// Returns the files of a 3MF package with this model part.
pub fn package(model: impl AsRef<[u8]>) -> Vec<Entry> {
    vec![
        Entry::deflated("[Content_Types].xml", CONTENT_TYPES),
        Entry::deflated("_rels/.rels", RELATIONSHIPS),
        Entry::deflated("3D/3dmodel.model", model),
    ]
}

/// Returns a model part with these resources and this build.
pub fn model(attributes: &str, resources: &str, build: &str) -> String {
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<model {attributes} xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
    xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06">
  <metadata name="Title">A &lt;test&gt;</metadata>
  <resources>
{resources}
  </resources>
  <build>
{build}
  </build>
</model>
"#
    )
}

/// Returns an object that is the tetrahedron with corners at the origin and at distance 1 on the axes, of
/// volume 1/6.
pub fn tetrahedron(id: u32, attributes: &str) -> String {
    format!(
        r#"    <object id="{id}" {attributes}>
      <mesh>
        <vertices>
          <vertex x="0" y="0" z="0"/>
          <vertex x="1" y="0" z="0" /> <!-- a comment -->
          <vertex x="0" y="1.0e0" z="0"></vertex>
          <vertex z="1" y="0" x="0"/>
        </vertices>
        <triangles>
          <triangle v1="0" v2="2" v3="1"/>
          <triangle v1="0" v2="1" v3="3" pid="1" p1="0"/>
          <triangle v1="1" v2="2" v3="3"/>
          <triangle v1="2" v2="0" v3="3"/>
        </triangles>
      </mesh>
    </object>
"#
    )
}
