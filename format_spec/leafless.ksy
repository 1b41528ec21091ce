# The file format of Leafless, version 0.4, as a Kaitai Struct description. The specification is specification.md
# beside this file; where the two differ, that one is right.
#
# Every `valid` is a rule of §10 of the specification, except those that are marked "implied": these follow from rules
# that a description cannot state. What it does not state: checksums, links, the counts of the level table but for the
# implied ones, order and use of dictionary entries, and `planes-needless`. Of channels it states what their records say;
# which sections they have, and what lies in these, it does not. Of tri-dexel models it states header, table, record and
# windows; the arrays of their directions are read as bytes. Of cuts it states the entries of the table and single numbers
# of the sections, but not what these have to do with one another. So a file that can be read through this description
# need not be valid.
#
# Instances are read when they are asked for, and only then are their rules applied; check_ksy.py asks for all. Fields
# of no bytes, such as `end_of_header`, carry rules about several fields. Derived values are cast because Kaitai takes
# the result of an operation as 32 bits wide in some languages; where even a cast does not help (JavaScript), `lower`,
# `upper` and what is derived from them are not exact, but no rule depends on them.
meta:
  id: leafless
  title: Leafless octree file
  file-extension: lfl
  license: MIT OR Apache-2.0
  ks-version: '0.11'
  encoding: UTF-8
  endian: le
doc: |
  One octree of a solid, which can be mapped into memory and queried where it lies. Every cell of the tree is EMPTY
  (outside of the solid), FULL (inside), PARTIAL (undecided), or BRANCH: it is then cut into eight children. Only BRANCH
  cells are stored. One entry, an element, describes two levels at once: 64 cells of two bits. Elements of the deepest
  level, called bricks, have no BRANCH cells and lie in an array of their own.

  The file is a header, a table of sections, and the sections, with zero bytes between them. Each section belongs to an
  object; object 0 is the solid, the octree that is described here.
doc-ref: specification.md
seq:
  - id: header
    type: header
    doc: The first 128 bytes.
    doc-ref: specification.md §3
  - id: sections
    type: section(_index)
    repeat: expr
    repeat-expr: header.num_sections
    doc: The section table. Sections with their own bytes lie in the file in this order.
    doc-ref: specification.md §4
instances:
  find_objects:
    type: finder(section_kind::objects)
    doc: The place of the solid's section `objects` in the table.
  find_metadata:
    type: finder(section_kind::metadata)
    doc: The place of the solid's section `metadata` in the table.
  find_level_table:
    type: finder(section_kind::level_table)
    doc: The place of the solid's section `level table` in the table.
  find_planes:
    type: finder(section_kind::planes)
    doc: The place of the solid's section `planes` in the table.
  find_rel:
    type: finder(section_kind::rel)
    doc: The place of the solid's section `rel` in the table.
  find_base:
    type: finder(section_kind::base)
    doc: The place of the solid's section `base` in the table.
  find_bricks:
    type: finder(section_kind::bricks)
    doc: The place of the solid's section `bricks` in the table.
  find_brick_indices:
    type: finder(section_kind::brick_indices)
    doc: The place of the solid's section `brick indices` in the table.
  find_dictionary_entries:
    type: finder(section_kind::dictionary_entries)
    doc: The place of the solid's section `dictionary entries` in the table.
  find_dictionary_segments:
    type: finder(section_kind::dictionary_segments)
    doc: The place of the solid's section `dictionary segments` in the table.
  find_windows:
    type: finder(section_kind::windows)
    doc: The place of the section `windows` of a tri-dexel model in the table.
  find_cut_heads:
    type: finder(section_kind::cut_heads)
    doc: The place of the solid's section `cut heads` in the table.
  find_cut_ids:
    type: finder(section_kind::cut_ids)
    doc: The place of the solid's section `cut ids` in the table.
  find_cut_blocks:
    type: finder(section_kind::cut_blocks)
    doc: The place of the solid's section `cut blocks` in the table.
  find_cut_first:
    type: finder(section_kind::cut_first)
    doc: The place of the solid's section `cut first` in the table.
  find_surfaces:
    type: finder(section_kind::surfaces)
    doc: The place of the solid's section `surfaces` in the table.
  find_surface_numbers:
    type: finder(section_kind::surface_numbers)
    doc: The place of the solid's section `surface numbers` in the table.
  find_placements:
    type: finder(section_kind::placements)
    doc: The place of the solid's section `placements` in the table.
  find_origins:
    type: finder(section_kind::origins)
    doc: The place of the solid's section `origins` in the table.
  find_cell_slabs:
    type: finder(section_kind::cell_slabs)
    doc: The place of the solid's section `cell slabs` in the table.
  find_cell_slab_groups:
    type: finder(section_kind::cell_slab_groups)
    doc: The place of the solid's section `cell slab groups` in the table.
  find_moments:
    type: finder(section_kind::moments)
    doc: The place of the solid's section `moments` in the table.
  cut_heads:
    pos: find_cut_heads.section.ofs_body
    size: find_cut_heads.section.len_body
    type: cut_heads
    if: find_cut_heads.is_found
    doc: One byte for each cut; absent if there are no cuts.
    doc-ref: specification.md §5.8
  cut_blocks:
    pos: find_cut_blocks.section.ofs_body
    size: find_cut_blocks.section.len_body
    type: cut_blocks
    if: find_cut_blocks.is_found
    doc: What is counted before every 32nd cut.
    doc-ref: specification.md §5.8
  cut_first:
    pos: find_cut_first.section.ofs_body
    size: find_cut_first.section.len_body
    type: cut_first
    if: find_cut_first.is_found
    doc: Cuts before each element and brick, and those of all cells of the tree.
    doc-ref: specification.md §5.8
  surfaces:
    pos: find_surfaces.section.ofs_body
    size: find_surfaces.section.len_body
    type: surfaces
    if: find_surfaces.is_found
    doc: The surfaces of the cuts.
    doc-ref: specification.md §5.8
  surface_numbers:
    pos: find_surface_numbers.section.ofs_body
    size: find_surface_numbers.section.len_body
    type: surface_numbers
    if: find_surface_numbers.is_found
    doc: The doubles of the surfaces.
    doc-ref: specification.md §5.8
  placements:
    pos: find_placements.section.ofs_body
    size: find_placements.section.len_body
    type: placements
    if: find_placements.is_found
    doc: Maps that place surfaces.
    doc-ref: specification.md §5.8
  origins:
    pos: find_origins.section.ofs_body
    size: find_origins.section.len_body
    type: origins
    if: find_origins.is_found
    doc: What slabs were made from.
    doc-ref: specification.md §5.8
  cell_slabs:
    pos: find_cell_slabs.section.ofs_body
    size: find_cell_slabs.section.len_body
    type: cell_slabs
    if: find_cell_slabs.is_found
    doc: Slabs that were made for one cell each.
    doc-ref: specification.md §5.8
  cell_slab_groups:
    pos: find_cell_slab_groups.section.ofs_body
    size: find_cell_slab_groups.section.len_body
    type: cell_slab_groups
    if: find_cell_slab_groups.is_found
    doc: What those were made from.
    doc-ref: specification.md §5.8
  moments:
    pos: find_moments.section.ofs_body
    size: find_moments.section.len_body
    type: moments
    if: find_moments.is_found
    doc: Bounds of the volume of the solid, and of its first and second moments.
    doc-ref: specification.md §5.8
  windows:
    pos: find_windows.section.ofs_body
    size: find_windows.section.len_body
    type: windows
    if: find_windows.is_found
    doc: The rays of each direction of a tri-dexel model.
    doc-ref: specification.md §5.7
  objects:
    pos: find_objects.section.ofs_body
    size: find_objects.section.len_body
    type: objects
    doc: What the file holds. It is always there.
  metadata:
    pos: find_metadata.section.ofs_body
    size: find_metadata.section.len_body
    type: metadata
    if: find_metadata.is_found
    doc: Facts about the solid; absent if there are none.
  level_table:
    pos: find_level_table.section.ofs_body
    size: find_level_table.section.len_body
    type: level_table
    if: find_level_table.is_found
    doc: Counts of cells of every octree level. It is always there, but for tri-dexel models.
  planes:
    pos: find_planes.section.ofs_body
    size: find_planes.section.len_body
    type: planes
    if: find_planes.is_found
    doc: The elements; absent if there are none.
  rel:
    pos: find_rel.section.ofs_body
    size: find_rel.section.len_body
    type: rel
    if: find_rel.is_found
    doc: Links of single elements; absent if there are no elements.
  base:
    pos: find_base.section.ofs_body
    size: find_base.section.len_body
    type: base
    if: find_base.is_found
    doc: Links of blocks of 1024 elements; absent if there are no elements.
  bricks:
    pos: find_bricks.section.ofs_body
    size: find_bricks.section.len_body
    type: bricks
    if: find_bricks.is_found
    doc: Bricks that are stored raw; absent if there are none.
  brick_indices:
    pos: find_brick_indices.section.ofs_body
    size: find_brick_indices.section.len_body
    type: brick_indices
    if: find_brick_indices.is_found
    doc: For each brick its dictionary entry; absent if bricks are raw.
  dictionary_entries:
    pos: find_dictionary_entries.section.ofs_body
    size: find_dictionary_entries.section.len_body
    type: bricks
    if: find_dictionary_entries.is_found
    doc: The bricks that differ, segment by segment; absent if bricks are raw.
  dictionary_segments:
    pos: find_dictionary_segments.section.ofs_body
    size: find_dictionary_segments.section.len_body
    type: dictionary_segments
    if: find_dictionary_segments.is_found
    doc: Where the entries of each segment begin; absent if bricks are raw.
types:
  header:
    doc: What the file is, and how much there is of everything. All else is checked against it.
    doc-ref: specification.md §3
    seq:
      - id: magic
        contents: [0x89, LFL, 0x0d, 0x0a, 0x1a, 0x0a]
        doc: |
          A byte that is not ASCII, three letters, CR LF, the end-of-file mark of DOS, LF: a transfer that changes bytes
          of text changes it. (Rule `header-magic`, and with it `header-text-mode`.)
      - id: version_major
        type: u2
        valid: 0
        doc: Files of another major version need another reader. (`header-major`)
      - id: version_minor
        type: u2
        valid:
          min: 1
        doc: |
          Files of newer minor versions are read; in these, optional flags and reserved fields are not looked at. The
          oldest version is 0.1. (`header-major`)
      - id: len_header
        type: u4
        valid: 128
        doc: Bytes of the header. (`header-length`)
      - id: required_flags
        type: u4
        valid:
          expr: _ == 0 or (_ == 1 and version_minor >= 3)
        doc: |
          What a reader must understand. Bit 0: the solid is a tri-dexel model, and the fields of octrees below are 0 or
          have another meaning. (`header-required-flags`)
      - id: optional_flags
        type: u4
        valid:
          expr: _ == 0 or is_newer
        doc: What a reader may ignore; nothing is defined. (`header-optional-flags`)
      - id: len_file
        type: u8
        doc: Bytes of the file, which ends with the last section that has its own bytes.
      - id: origin_x
        size: 8
        type: coordinate
        doc: Lower corner of the universe along x, in model units.
      - id: origin_y
        size: 8
        type: coordinate
        doc: The same along y.
      - id: origin_z
        size: 8
        type: coordinate
        doc: The same along z.
      - id: edge
        type: f8
        valid:
          min: 8.636168555094445e-78
          max: 1.157920892373162e+77
        doc: Edge of the universe, a cube, in model units; 2^-256 to 2^256. (`header-edge`)
      - id: depth
        type: u1
        valid:
          min: 1
          max: 20
        doc: The level of the finest cells, of which there are 2^depth along each axis. (`header-depth`)
      - id: root_tag
        type: u1
        enum: tag
        valid:
          in-enum: true
        doc: The tag of the universe. If it is not BRANCH, it says all, and nothing else is stored. (`header-root`)
      - id: exterior
        type: u1
        enum: tag
        valid:
          any-of:
            - tag::empty
            - tag::partial
            - tag::full
        doc: The tag of the space outside of the universe. (`header-exterior`)
      - id: num_brick_planes
        type: u1
        valid:
          expr: 'is_dexels ? _ == 0 : _ == 2 or (_ == 1 and root_tag != tag::partial)'
        doc: |
          Words of a brick: 1 in a binary tree, 2 in a tree with any PARTIAL cell, even if it has no bricks.
          (`header-brick-planes`; `planes-missing` as far as it is about the root tag; `dexel-field`)
      - id: brick_encoding
        type: u1
        enum: brick_encoding
        valid:
          in-enum: true
        doc: How bricks are stored. (`header-encoding`)
      - id: segment_shift
        type: u1
        valid:
          expr: 'has_dictionary ? _ >= 16 and _ <= 63 : _ == 0'
        doc: |
          With a dictionary: a segment is 2^shift bricks, and 63 stands for a single segment of all bricks. Else 0.
          (`header-raw-shift`, `header-shift`)
      - id: proof
        type: u1
        valid:
          max: 3
        doc: |
          What the tags prove. Bit 0: FULL cells are proven to lie in the solid; bit 1: EMPTY cells are proven to lie
          outside of it. (`header-proof`)
      - id: form
        type: u1
        valid:
          expr: 'is_dexels ? _ >= 32 and ((_ >> 1) & 3) != 3 : _ == 0 or is_newer'
        doc: |
          What a tri-dexel model stores; zero for an octree. Bit 0: ends are doubles. Bits 1 and 2: normals of 16 bits (1)
          or 32 bits (2). Bit 3: surfaces. Bit 4: materials. Bits 5 to 7: rays along x, y, z. (`dexel-form`,
          `header-reserved`)
      - id: num_elements
        type: u8
        valid:
          expr: >-
            is_dexels ? _ <= ((form & 0x20) != 0 ? 4294967294 : 0)
            : _ == 0 or (depth > 2 and root_tag == tag::branch)
        doc: |
          Number of elements without bricks; of a tri-dexel model intervals along x. (`header-elements`,
          `dexel-intervals`)
      - id: num_bricks
        type: u8
        valid:
          expr: >-
            is_dexels ? _ <= ((form & 0x40) != 0 ? 4294967294 : 0)
            : (_ == 0 or root_tag == tag::branch)
            and (not has_dictionary or (_ > 0 and (segment_shift == 63 or ((_ - 1) >> segment_shift) > 0)))
        doc: |
          Number of bricks. With a dictionary there is at least one, and with a shift below 63 they fill more than one
          segment. Of a tri-dexel model intervals along y. (`header-bricks`, `header-shift`, `dexel-intervals`)
      - id: num_dictionary_entries
        type: u8
        valid:
          expr: >-
            is_dexels ? _ <= ((form & 0x80) != 0 ? 4294967294 : 0)
            : has_dictionary ? _ >= 1 and _ <= num_bricks : _ == 0
        doc: |
          Number of dictionary entries in all segments; of a tri-dexel model intervals along z. (`header-raw-entries`,
          `header-entries`, `dexel-intervals`)
      - id: num_sections
        type: u4
        valid:
          expr: _ >= 1 and _ <= 4096 and len_file > 128 + 48 * _
        doc: Number of entries of the section table. (`header-section-count`, `header-file-length`)
      - id: section_table_crc32
        type: u4
        doc: CRC32 of the section table, 48 · `num_sections` bytes. (`table-crc`, which is not checked here)
      - id: displacement
        size: 8
        type: displacement
        doc: How far surfaces were moved from those of the model that was handed in, in model units.
      - id: reserved2
        type: u1
        repeat: expr
        repeat-expr: 12
        valid:
          expr: _ == 0 or is_newer
        doc: Zero. (`header-reserved`)
      - id: header_crc32
        type: u4
        doc: CRC32 of the 124 bytes before. (`header-crc`, which is not checked here)
      - id: end_of_octree_fields
        size: 0
        if: is_dexels
        valid:
          expr: >-
            root_tag == tag::empty and exterior == tag::empty and brick_encoding == brick_encoding::raw
            and proof == 0 and displacement.value == 0.0
        doc: No bytes. What only octrees have is 0 in the header of a tri-dexel model. (`dexel-field`)
      - id: end_of_header
        size: 0
        valid:
          expr: len_file == _root._io.size
        doc: No bytes. The file is as long as it says. (`file-length`)
    instances:
      is_newer:
        value: version_minor > 4
        doc: Whether a later version wrote the file, which may have given a meaning to what is reserved in 0.4.
      is_dexels:
        value: version_minor >= 3 and (required_flags & 1) != 0
        doc: Whether the solid is a tri-dexel model, and not an octree.
      num_directions:
        value: '(((form >> 5) & 1) + ((form >> 6) & 1) + ((form >> 7) & 1)).as<u8>'
        doc: Directions of a tri-dexel model.
      columns_stored:
        value: >-
          3 | (((form >> 1) & 3) != 0 ? 4 : 0) | ((form & 8) != 0 ? 8 : 0) | ((form & 16) != 0 ? 16 : 0)
        doc: Bit k is set if a direction with intervals has the k-th of its five sections.
      is_full_proven:
        value: (proof & 1) != 0
        doc: Whether FULL cells are proven to lie in the solid.
      is_empty_proven:
        value: (proof & 2) != 0
        doc: Whether EMPTY cells are proven to lie outside of the solid.
      is_binary:
        value: num_brick_planes == 1
        doc: Whether no cell is PARTIAL.
      has_dictionary:
        value: brick_encoding == brick_encoding::dictionary
        doc: Whether bricks are stored through a dictionary.
      parity:
        value: depth % 2
        doc: 1 if the depth is odd. The root element then begins half-way, and only its octant 0 is in the universe.
      num_element_levels:
        value: (depth + 1) / 2
        doc: Element levels, with that of the bricks, which is the last.
      num_raw_bricks:
        value: '(has_dictionary ? 0 : num_bricks).as<u8>'
        doc: Entries of the section `bricks`.
      num_indexed_bricks:
        value: '(has_dictionary ? num_bricks : 0).as<u8>'
        doc: Entries of the section `brick indices`.
      num_segments:
        value: '(not has_dictionary ? 0 : segment_shift == 63 ? 1 : ((num_bricks - 1) >> segment_shift) + 1).as<u8>'
        doc: Segments of the dictionary.
      num_blocks:
        value: '(num_elements == 0 ? 0 : (num_elements - 1) / 1024 + 1).as<u8>'
        doc: Entries of the section `base`, one for every 1024 elements.
      len_brick:
        value: 8 * num_brick_planes
        doc: Bytes of a brick.
      len_table_end:
        value: 128 + 48 * num_sections
        doc: Where the section table ends.
      kinds_demanded:
        value: |
          is_dexels ? 0b1000_0000_0010
          | ((form & 0x20) == 0 ? 0 : (num_elements > 0 ? columns_stored : 1) << 12)
          | ((form & 0x40) == 0 ? 0 : (num_bricks > 0 ? columns_stored : 1) << 17)
          | ((form & 0x80) == 0 ? 0 : (num_dictionary_entries > 0 ? columns_stored : 1) << 22)
          : 0b1010 | (num_elements > 0 ? 0b111_0000 : 0)
          | (num_bricks == 0 ? 0 : has_dictionary ? 0b111_0000_0000 : 0b1000_0000)
        doc: |
          Bit k is set if the section of kind k must be there: objects and the level table always, planes, rel and base
          if there are elements, and for bricks either those or indices, entries and segments. Of a tri-dexel model the kinds
          from 32 on have the bits from 11 on.
  coordinate:
    doc: |
      A coordinate of the origin: zero, or of a magnitude of 2^-256 to 2^256. Negative zero is illegal.
      (`header-origin`)
    seq:
      - id: value
        type: f8
        valid:
          expr: >-
            (_ >= 8.636168555094445e-78 and _ <= 1.157920892373162e+77)
            or (_ <= -8.636168555094445e-78 and _ >= -1.157920892373162e+77)
            or (_ == 0.0 and sign_byte == 0)
        doc: The coordinate, in model units.
    instances:
      sign_byte:
        pos: 7
        type: u1
        doc: The byte whose highest bit is the sign. It tells the two zeros apart, which compare as equal.
  displacement:
    doc: |
      A length in model units, 0 or greater and finite. Negative zero is illegal. (`header-displacement`)
    seq:
      - id: value
        type: f8
        valid:
          expr: _ >= 0.0 and _ <= 1.7976931348623157e+308 and sign_byte < 0x80
        doc: The length.
    instances:
      sign_byte:
        pos: 7
        type: u1
        doc: The byte whose highest bit is the sign. It tells the two zeros apart, which compare as equal.
  section:
    doc: One entry of the section table.
    doc-ref: specification.md §4
    params:
      - id: index
        type: s4
        doc: The place in the table.
    seq:
      - id: kind_code
        type: u4
        valid:
          min: 1
        doc: What the section holds. (`section-kind`)
      - id: owner
        type: u4
        valid:
          expr: >-
            index == 0 ? _ == 0
            : _ < _root.sections[0].num_elements
            and (_ > previous.owner or (_ == previous.owner and kind_code > previous.kind_code))
        doc: |
          The object that the section belongs to; 0 is the solid. Entries ascend by owner and kind. (`table-owner`,
          `table-order`; of the first entry `object-count`)
      - id: element_code
        type: u1
        valid:
          expr: _ <= 6 or _root.header.is_newer
        doc: What the numbers of an element are. (`table-element`)
      - id: num_components
        type: u1
        valid:
          min: 1
        doc: Numbers of an element; of records units of 8 bytes. (`table-element`)
      - id: encoding
        type: u1
        valid:
          expr: _ == 0 or (_root.header.is_newer and not is_known)
        doc: How the elements are stored. 0 is raw, one after another as they are. (`table-encoding`)
      - id: reserved
        type: u1
        valid:
          expr: _ == 0 or _root.header.is_newer
        doc: Zero. (`table-reserved`)
      - id: flags
        type: u4
        valid:
          expr: _ < 2 or _root.header.is_newer
        doc: |
          Bit 0: a reader must know the kind to read the owner. The others are zero. (`section-flags`)
      - id: ofs_body
        type: u8
        doc: Where the section begins in the file.
      - id: len_body
        type: u8
        valid:
          min: 1
        doc: Bytes of the section. (`section-length`)
      - id: num_elements
        type: u8
        valid:
          expr: >-
            _ != 0
            and (encoding != 0 or element_code > 6 or (len_body % len_element == 0 and _ == len_body / len_element))
            and (index != 0 or (kind_code == 1 and _ <= 4096))
        doc: |
          Number of the section's elements. A section that would have none is absent. The first section is `objects`.
          (`section-length`, `object-count`)
      - id: body_crc32
        type: u4
        doc: CRC32 of the section's bytes. (`section-crc`, which is not checked here)
      - id: same
        type: u4
        valid:
          expr: _ <= index
        doc: |
          0 if the section has its own bytes. Otherwise it has those of the section before the one that this number
          would count from 0. (`table-same`)
      - id: end_of_same
        size: 0
        if: same != 0
        valid:
          expr: >-
            source.same == 0 and source.element_code == element_code and source.num_components == num_components
            and source.encoding == encoding and source.reserved == reserved and source.ofs_body == ofs_body
            and source.len_body == len_body and source.num_elements == num_elements and source.body_crc32 == body_crc32
        doc: |
          No bytes. The entry whose bytes these are has its own, and says the same of them. (`table-same`)
      - id: end_of_own
        size: 0
        if: same == 0
        valid:
          expr: >-
            ofs_body % 64 == 0 and ofs_body >= previous_end
            and ofs_body <= _root.header.len_file and len_body <= _root.header.len_file - ofs_body
        doc: |
          No bytes. Where a section with its own bytes lies. (`section-alignment`, `section-overlap`, `section-beyond`)
      - id: end_of_entry
        size: 0
        valid:
          expr: >-
            is_known ? element_code == element_demanded
            and num_components == num_components_demanded
            and (kind == section_kind::objects or is_starts or is_of_cuts
            or (kind == section_kind::metadata ? len_body <= 1048576 : num_elements == num_elements_demanded))
            and is_required == (kind != section_kind::metadata and not is_of_cuts)
            : owner != 0 or not is_required
        doc: |
          No bytes. A known section has the elements of its kind, and as many as the header demands; an unknown one of
          the solid is not required. (`section-unknown`, `section-size`, `section-count`, `section-metadata-length`,
          `section-required`)
      - id: end_of_table
        size: 0
        if: is_last
        valid:
          expr: >-
            (kinds_before_next & _root.header.kinds_demanded) == _root.header.kinds_demanded
            and own_end == _root.header.len_file
        doc: |
          No bytes. What is known after the last entry: all sections that must be there are, and the file ends with
          the last one that has its own bytes. (`section-missing`, `section-end`)
    instances:
      is_known:
        value: >-
          owner == 0 and kind_code >= 1 and (kind_code <= 2
          or (_root.header.is_dexels ? kind_code >= 32 and kind_code <= 47
          : kind_code <= 10 or (is_of_cuts and _root.header.version_minor >= 4)))
        doc: Whether this description knows the section. It knows those of the solid.
      is_of_cuts:
        value: (kind_code >= 11 and kind_code <= 15) or (kind_code >= 20 and kind_code <= 25)
        doc: Whether it is one of the sections of cuts, if it is known.
      is_starts:
        value: kind_code >= 33 and (kind_code - 33) % 5 == 0
        doc: Whether a known section has the starts of a direction, of which the window says how many there are.
      column:
        value: '(kind_code < 33 ? 5 : (kind_code - 33) % 5).as<u1>'
        doc: Which of the five sections of a direction it is, if it is known.
      num_intervals:
        value: >-
          (kind_code < 38 ? _root.header.num_elements
          : kind_code < 43 ? _root.header.num_bricks
          : _root.header.num_dictionary_entries).as<u8>
        doc: Intervals of the direction that it belongs to, if it is one of a direction.
      kind:
        value: kind_code
        enum: section_kind
        doc: The kind by name, if it is known. (What else it is depends on the language.)
      element:
        value: element_code
        enum: element_type
        doc: The element type by name, if it is known.
      is_required:
        value: (flags & 1) != 0
        doc: Whether a reader must know the kind to read the owner.
      is_last:
        value: index == _root.header.num_sections.as<s4> - 1
        doc: Whether this is the last entry of the table.
      previous:
        value: _root.sections[index - 1]
        if: index != 0
        doc: The entry before.
      source:
        value: _root.sections[same - 1]
        if: same != 0
        doc: The entry whose bytes the section has, if it has not its own.
      previous_end:
        value: '(index == 0 ? _root.header.len_table_end : _root.sections[index - 1].own_end).as<u8>'
        doc: Where the table or the previous section with its own bytes ends, and the padding begins.
      own_end:
        value: '(same == 0 ? ofs_body + len_body : previous_end).as<u8>'
        doc: Where the last section with its own bytes ends, of this one and those before.
      kinds_before:
        value: '(index == 0 ? 0 : _root.sections[index - 1].kinds_before_next).as<u4>'
        doc: Bits of the known kinds that sections of the solid before this one have, as in `kinds_demanded`.
      kinds_before_next:
        value: '(kinds_before | (is_known and not is_of_cuts ? 1 << (kind_code > 10 ? kind_code - 21 : kind_code) : 0)).as<u4>'
        doc: The same with this section. Those of cuts are not among them.
      len_number:
        value: |
          element_code == 1 ? 1
          : element_code == 2 ? 2
          : element_code == 3 or element_code == 5 ? 4
          : 8
        doc: Bytes of one number of a known element type.
        doc-ref: specification.md §4
      len_element:
        value: len_number * num_components
        doc: Bytes of one element of a known element type.
      element_demanded:
        value: |
          kind == section_kind::objects ? 0
          : kind == section_kind::metadata ? 1
          : kind == section_kind::rel or kind == section_kind::brick_indices ? 2
          : kind == section_kind::cut_heads or kind == section_kind::cut_ids ? 1
          : kind_code >= 13 and kind_code <= 15 ? 3
          : kind == section_kind::surface_numbers or kind == section_kind::moments ? 6
          : kind == section_kind::placements ? 0
          : kind_code < 32 ? 4
          : column == 1 and (_root.header.form & 1) != 0 ? 6
          : column == 2 and ((_root.header.form >> 1) & 3) == 1 ? 2
          : 3
        doc: The element type of a known section.
        doc-ref: specification.md §5
      num_components_demanded:
        value: |
          (kind == section_kind::objects ? 16
          : kind == section_kind::level_table or kind == section_kind::cell_slab_groups ? 3
          : kind == section_kind::planes ? 2
          : kind == section_kind::bricks or kind == section_kind::dictionary_entries ? _root.header.num_brick_planes
          : kind == section_kind::windows or kind == section_kind::surfaces ? 4
          : kind == section_kind::cut_blocks or kind == section_kind::origins or kind == section_kind::cell_slabs ? 2
          : kind == section_kind::placements ? 13
          : kind == section_kind::moments ? 23
          : column >= 1 and column <= 3 ? 2
          : 1).as<u1>
        doc: The components of a known section.
        doc-ref: specification.md §5
      num_elements_demanded:
        value: |
          (kind == section_kind::planes ? _root.header.num_elements
          : kind == section_kind::rel ? _root.header.num_elements
          : kind == section_kind::base ? _root.header.num_blocks
          : kind == section_kind::bricks ? _root.header.num_raw_bricks
          : kind == section_kind::brick_indices ? _root.header.num_indexed_bricks
          : kind == section_kind::dictionary_entries ? _root.header.num_dictionary_entries
          : kind == section_kind::dictionary_segments ? _root.header.num_segments
          : kind == section_kind::windows ? _root.header.num_directions
          : kind_code >= 33 ? ((_root.header.columns_stored >> column) & 1) * num_intervals
          : _root.header.depth + 1).as<u8>
        doc: The number of elements that a known section must have; objects, metadata and cuts may have any.
        doc-ref: specification.md §5
      padding:
        io: _root._io
        pos: previous_end
        type: u1
        repeat: expr
        repeat-expr: ofs_body - previous_end
        if: same == 0
        valid: 0
        doc: The bytes before a section that has its own bytes. (`padding`)
      body:
        io: _root._io
        pos: ofs_body
        size: len_body
        doc: The bytes of the section. For those of known sections see the instances of the file.
        doc-ref: specification.md §5
  finder:
    doc: A search for the solid's section of one kind. It reads nothing of the file.
    params:
      - id: kind
        type: u4
        enum: section_kind
        doc: The kind.
    seq:
      - id: steps
        type: finder_step(_index, kind)
        repeat: until
        repeat-until: _.is_found or _.section.is_last
        doc: Entries of the section table up to the one that is searched for.
    instances:
      is_found:
        value: steps.last.is_found
        doc: Whether there is such a section.
      section:
        value: steps.last.section
        if: is_found
        doc: The entry of the section table.
  finder_step:
    doc: One entry of the section table in a search.
    params:
      - id: index
        type: s4
        doc: The place in the table.
      - id: kind
        type: u4
        enum: section_kind
        doc: The kind that is searched for.
    instances:
      section:
        value: _root.sections[index]
        doc: The entry.
      is_found:
        value: section.is_known and section.kind == kind
        doc: Whether it is the solid's of that kind.
  windows:
    doc: The windows of the directions that a tri-dexel model has, in the order x, y, z.
    doc-ref: specification.md §5.7
    seq:
      - id: windows
        size: 16
        type: window
        repeat: eos
        doc: One for each direction.
  window:
    doc: The rays of a direction that may have intervals, as indices on the other two axes, the lower axis first.
    seq:
      - id: first_u
        type: u4
        doc: The first on the lower axis.
      - id: first_v
        type: u4
        doc: The first on the higher axis.
      - id: width
        type: u4
        doc: How many on the lower axis.
      - id: height
        type: u4
        doc: How many on the higher axis.
      - id: end_of_window
        size: 0
        valid:
          expr: >-
            width <= num_cells and first_u <= num_cells - width and height <= num_cells and first_v <= num_cells - height
            and ((width != 0 and height != 0) or (width == 0 and height == 0 and first_u == 0 and first_v == 0))
        doc: No bytes. The window lies in the universe, and there is one window of nothing. (`dexel-window`)
    instances:
      num_cells:
        value: 1 << _root.header.depth
        doc: Finest cells along each axis.
  cut_heads:
    doc: One byte for each cut.
    doc-ref: specification.md §5.8
    seq:
      - id: heads
        type: u1
        repeat: eos
        doc: 0 says that nothing is known, 255 that the cell is split; any other number is a table of up to three surfaces.
  cut_blocks:
    doc: What is counted before every 32nd cut.
    doc-ref: specification.md §5.8
    seq:
      - id: blocks
        type: cut_block
        repeat: eos
        doc: One for each 32 cuts.
  cut_block:
    doc: What is counted before a cut.
    seq:
      - id: num_ids
        type: u4
        doc: Ids of surfaces.
      - id: num_splits
        type: u4
        doc: Splits.
  cut_first:
    doc: Cuts before each element and brick.
    doc-ref: specification.md §5.8
    seq:
      - id: values
        type: u4
        repeat: eos
        doc: One for each element and brick, and at last the number of cuts that cells of the tree have.
  surfaces:
    doc: The surfaces of the cuts.
    doc-ref: specification.md §5.8
    seq:
      - id: surfaces
        size: 16
        type: surface
        repeat: eos
        doc: In the order of their first use.
  surface:
    doc: What kind of function a surface has, and where its numbers are.
    doc-ref: specification.md §5.8
    seq:
      - id: kind
        type: u1
        valid:
          max: 4
        doc: 0 is a plane, 1 a quadric, 2 a sum of powers, 3 a torus, 4 a slab. (`surface-record`)
      - id: origin_low
        type: u2
        valid:
          expr: _ == 0 or kind == 4
        doc: The lower 16 bits of `origin`. (`surface-origin`, in part)
      - id: origin_high
        type: u1
        valid:
          expr: _ == 0 or kind == 4
        doc: The upper 8 bits of `origin`. (`surface-origin`, in part)
      - id: terms
        type: u4
        valid:
          expr: _ >> (3 * num_numbers) == 0 or (kind == 4 and _ >> 15 == 1)
        doc: |
          Of how many doubles each number is the sum, three bits for each. 1 in the bits behind those of a slab says that
          one more entry of `surface_numbers` is the slab's number, of 64 bits. (`surface-record`)
      - id: first
        type: u4
        doc: Its first double.
      - id: placement
        type: u4
        doc: 0, or one more than the index of the first map that it is placed by.
    instances:
      num_numbers:
        value: '(kind == 1 or kind == 2 ? 10 : kind == 4 ? 5 : 4).as<u1>'
        doc: The numbers that a surface of this kind has.
      origin:
        value: '(origin_low + 65536 * origin_high).as<u4>'
        doc: 0, or one more than the index of the origin of a slab.
      has_number:
        value: kind == 4 and terms >> 15 == 1
        doc: Whether the number of a slab is stored. If it is not, and the slab has an origin, it is the index of the record.
  surface_numbers:
    doc: The doubles of the surfaces.
    doc-ref: specification.md §5.8
    seq:
      - id: values
        type: f8
        repeat: eos
        doc: |
          Surface by surface, and number by number. The numbers of slabs among them are no doubles, but integers of 64 bits
          (see `has_number` of a surface).
  placements:
    doc: Maps that place surfaces.
    doc-ref: specification.md §5.8
    seq:
      - id: placements
        size: 104
        type: placement(_index)
        repeat: eos
        doc: In the order of their first use.
  placement:
    doc: An affine map.
    doc-ref: specification.md §5.8
    params:
      - id: index
        type: s4
        doc: The number of the map.
    seq:
      - id: entries
        type: f8
        repeat: expr
        repeat-expr: 12
        valid:
          expr: >-
            _ == 0.0 or (_ >= 5.421010862427522e-20 and _ <= 1.8446744073709552e+19)
            or (_ <= -5.421010862427522e-20 and _ >= -1.8446744073709552e+19)
        doc: Row by row, the shift last in each. (`placement-map`, in part)
      - id: outer
        type: u8
        valid:
          expr: _ <= index.as<u8>
        doc: 0, or one more than the index of the map that follows. (`surface-placement`, in part)
  origins:
    doc: What slabs were made from.
    doc-ref: specification.md §5.8
    seq:
      - id: origins
        type: origin
        repeat: eos
        doc: In the order of their first use.
  origin:
    doc: A fingerprint of 128 bits.
    seq:
      - id: low
        type: u8
        doc: The lower half.
      - id: high
        type: u8
        doc: The higher half.
  cell_slabs:
    doc: Slabs that were made for one cell each.
    doc-ref: specification.md §5.8
    seq:
      - id: slabs
        size: 16
        type: cell_slab
        repeat: eos
        doc: Group by group, and in each in the order of their first use.
  cell_slab:
    doc: |
      Two parallel planes in whole numbers. In units of the universe the component of their normal along `axis` is 1, or -1 if
      `is_negative`; along the next axis it is `component` / 2^15, and along the one after `other_component` / 2^15. Where c is
      the centre of the home, the faces have the offsets n·c + `offset` / 2^`step` and, from there, `width` / 2^`step`.
    doc-ref: specification.md §5.8
    seq:
      - id: home
        type: u8
        valid:
          expr: (_ >> 61) <= 2
        doc: |
          The cell, a one followed by three bits for each level, in bits 0 to 60, and in bits 61 and 62 which of the cell's slabs
          it is. (`cell-slab`, in part)
      - id: component
        type: s2
        valid:
          min: -32767
        doc: Along the axis behind `axis`. (`cell-slab`)
      - id: other_component
        type: s2
        valid:
          min: -32767
        doc: Along the axis behind that. (`cell-slab`)
      - id: fields
        type: u4
        valid:
          expr: ((_ >> 29) & 3) <= 2 and ((_ >> 23) & 63) >= 2 and ((_ >> 23) & 63) <= 50
        doc: |
          From the lowest bit on: 19 bits of the offset, four of the width, six of the step, two of the axis, and the sign.
          (`cell-slab`)
    instances:
      offset:
        value: '((fields & 262143).as<s4> - (fields & 262144).as<s4>).as<s4>'
        doc: How far the inner face lies from the centre, in steps.
      width:
        value: '((fields >> 19) & 15).as<u1>'
        doc: How far the outer face lies from the inner one, in steps.
      step:
        value: '((fields >> 23) & 63).as<u1>'
        doc: A step is the universe's edge divided by 2 to this power.
      axis:
        value: '((fields >> 29) & 3).as<u1>'
        doc: The axis of the greatest component of the normal.
      is_negative:
        value: (fields >> 31) != 0
        doc: Whether that component is -1.
      index:
        value: '(home >> 61).as<u1>'
        doc: Which of the slabs of its home it is.
  cell_slab_groups:
    doc: What cell slabs were made from.
    doc-ref: specification.md §5.8
    seq:
      - id: groups
        type: cell_slab_group
        repeat: eos
        doc: In the order of their first use.
  cell_slab_group:
    doc: Cell slabs of one origin, which follow each other.
    seq:
      - id: origin
        type: origin
        doc: Two zeros if they have none.
      - id: end
        type: u8
        valid:
          min: 1
        doc: How many cell slabs there are up to the last of the group. (`cell-slab-group`, in part)
  moments:
    doc: |
      Bounds of the volume of the solid, and of its first and second moments about a point, in model units. (`moments`)
    doc-ref: specification.md §5.8
    seq:
      - id: point
        size: 8
        type: moment_number
        repeat: expr
        repeat-expr: 3
        doc: The point that the moments are about.
      - id: volume
        size: 16
        type: moment_bounds(true)
        doc: The volume, which is not negative.
      - id: first_moments
        size: 16
        type: moment_bounds(false)
        repeat: expr
        repeat-expr: 3
        doc: The integral of x - p along x, y and z, where p is the point.
      - id: second_moments
        size: 16
        type: moment_bounds(false)
        repeat: expr
        repeat-expr: 6
        doc: The integral of the products of two coordinates of x - p, in the order xx, yy, zz, xy, xz, yz.
      - id: end_of_moments
        size: 0
        valid:
          expr: _io.eof
        doc: No bytes. There is one set of moments. (`section-cuts`, in part)
  moment_number:
    doc: |
      A finite number. Negative zero is illegal. (`moments`)
    seq:
      - id: value
        type: f8
        valid:
          expr: >-
            (_ > 0.0 and _ <= 1.7976931348623157e+308) or (_ < 0.0 and _ >= -1.7976931348623157e+308)
            or (_ == 0.0 and sign_byte == 0)
        doc: The number.
    instances:
      sign_byte:
        pos: 7
        type: u1
        doc: The byte whose highest bit is the sign. It tells the two zeros apart, which compare as equal.
  moment_bounds:
    doc: An interval that contains a moment.
    params:
      - id: is_volume
        type: bool
        doc: Whether it is that of the volume.
    seq:
      - id: lower
        size: 8
        type: moment_number
        doc: The lower end.
      - id: upper
        size: 8
        type: moment_number
        doc: The upper end.
      - id: end_of_bounds
        size: 0
        valid:
          expr: lower.value <= upper.value and (lower.value >= 0.0 or not is_volume)
        doc: No bytes. The ends are in order, and a volume is not negative. (`moments`)
  objects:
    doc: What the file holds. Each section belongs to one of these objects.
    doc-ref: specification.md §2.6, §5.1
    seq:
      - id: objects
        size: 128
        type: object_record(_index)
        repeat: eos
        doc: Object 0 is the solid.
  object_record:
    doc: |
      One object. That of the solid repeats the header. (`object-mirror`, wherever a field of object 0 is compared. The
      fields of other objects have a meaning in later versions.)
    doc-ref: specification.md §5.1
    params:
      - id: index
        type: s4
        doc: The number of the object.
    seq:
      - id: type_code
        type: u4
        valid:
          expr: 'is_solid ? _ == (_root.header.is_dexels ? 3 : 1) : _ != 0'
        doc: What the object is; 1 is an octree, 3 a tri-dexel model. (`object-type`)
      - id: parent
        type: u4
        valid:
          expr: '(_ == 0xffff_ffff or _ < index) and (not is_channel or _ == 0)'
        doc: The number of an earlier object, or 0xFFFFFFFF. (`object-parent`; for object 0 there is none)
      - id: flags
        type: u4
        valid:
          expr: >-
            (_ < 2 or _root.header.is_newer) and is_required == is_solid
        doc: |
          Bit 0: a reader must know the type to read the file. Only the type of object 0 is known. (`object-flags`,
          `object-required`)
      - id: depth
        type: u1
        valid:
          expr: 'is_solid ? _ == _root.header.depth : not is_channel or (_ >= 1 and _ <= 20)'
        doc: The header's, for object 0.
      - id: root_tag
        type: u1
        valid:
          expr: 'is_solid ? _ == _root.header.root_tag.to_i : not is_channel or _ == 0 or _ == 1 or _ == 3'
        doc: The header's, for object 0.
      - id: exterior
        type: u1
        valid:
          expr: 'is_solid ? _ == _root.header.exterior.to_i : not is_channel or _ == 0'
        doc: The header's, for object 0.
      - id: proof
        type: u1
        valid:
          expr: 'is_solid ? _ == _root.header.proof : not is_channel or _ == 0'
        doc: The header's, for object 0.
      - id: num_brick_planes
        type: u1
        valid:
          expr: 'is_solid ? _ == _root.header.num_brick_planes : not is_channel or _ == 2'
        doc: The header's, for object 0.
      - id: brick_encoding
        type: u1
        valid:
          expr: 'is_solid ? _ == _root.header.brick_encoding.to_i : not is_channel or _ <= 1'
        doc: The header's, for object 0.
      - id: segment_shift
        type: u1
        valid:
          expr: >-
            is_solid ? _ == _root.header.segment_shift
            : not is_channel or (brick_encoding == 1 ? _ >= 16 and _ <= 63 : _ == 0)
        doc: The header's, for object 0.
      - id: value_type
        type: u1
        valid:
          expr: 'is_solid ? _ == 0 : not is_channel or _ == 1 or _ == 2 or _ == 3 or _ == 5'
        doc: The element type of the object's values; 0 for object 0.
      - id: num_components
        type: u1
        valid:
          expr: 'is_solid ? _ == 0 : not is_channel or (_ >= 1 and _ <= 4)'
        doc: Components of the object's values; 0 for object 0.
      - id: form
        type: u1
        valid:
          expr: >-
            (not is_solid and not is_channel) or _ == (is_solid and _root.header.is_dexels ? _root.header.form : 0)
            or (_root.header.is_newer and not _root.header.is_dexels)
        doc: The header's, for object 0.
      - id: reserved1
        type: u1
        repeat: expr
        repeat-expr: 2
        valid:
          expr: (not is_solid and not is_channel) or _ == 0 or _root.header.is_newer
        doc: Zero, for object 0.
      - id: displacement
        type: f8
        valid:
          expr: >-
            (not is_solid and not is_channel)
            or (_ == (is_solid ? _root.header.displacement.value : 0.0) and sign_byte < 0x80)
        doc: The header's, for object 0.
      - id: origin
        size: 8
        type: object_coordinate
        repeat: expr
        repeat-expr: 3
        doc: The header's along x, y and z, for object 0.
      - id: edge
        type: f8
        valid:
          expr: (not is_solid and not is_channel) or _ == _root.header.edge
        doc: The header's, for object 0.
      - id: extents
        type: u4
        repeat: expr
        repeat-expr: 3
        valid:
          expr: (not is_solid and not is_channel) or _ == 0
        doc: Cells along x, y and z of an object on a lattice; 0 for object 0.
      - id: reserved2
        type: u4
        valid:
          expr: (not is_solid and not is_channel) or _ == 0 or _root.header.is_newer
        doc: Zero, for object 0.
      - id: num_elements
        type: u8
        valid:
          expr: >-
            is_solid ? _ == _root.header.num_elements : not is_channel or _ == 0 or (depth > 2 and root_tag == 1)
        doc: The header's, for object 0.
      - id: num_bricks
        type: u8
        valid:
          expr: >-
            is_solid ? _ == _root.header.num_bricks
            : not is_channel or ((_ == 0 or root_tag == 1) and (brick_encoding == 0
            or (_ > 0 and (segment_shift == 63 or ((_ - 1) >> segment_shift) > 0))))
        doc: The header's, for object 0.
      - id: num_dictionary_entries
        type: u8
        valid:
          expr: >-
            is_solid ? _ == _root.header.num_dictionary_entries
            : not is_channel or (brick_encoding == 1 ? _ >= 1 and _ <= num_bricks : _ == 0)
        doc: The header's, for object 0.
      - id: num_values
        type: u8
        valid:
          expr: not is_solid or _ == 0
        doc: Number of the object's values; 0 for object 0.
      - id: reserved3
        type: u1
        repeat: expr
        repeat-expr: 16
        valid:
          expr: (not is_solid and not is_channel) or _ == 0 or _root.header.is_newer
        doc: Zero, for object 0.
      - id: end_of_object
        size: 0
        if: is_solid or is_channel
        valid:
          expr: >-
            origin[0].value == _root.header.origin_x.value and origin[1].value == _root.header.origin_y.value
            and origin[2].value == _root.header.origin_z.value
            and (origin[0].value != 0.0 or origin[0].sign_byte == 0)
            and (origin[1].value != 0.0 or origin[1].sign_byte == 0)
            and (origin[2].value != 0.0 or origin[2].sign_byte == 0)
        doc: No bytes. The origin of object 0 is the header's.
    instances:
      is_channel:
        value: type_code == 2 and _root.header.version_minor >= 2 and not _root.header.is_dexels
        doc: Whether the object is a channel; before version 0.2 its type is unknown.
      is_solid:
        value: index == 0
        doc: Whether this is object 0, which repeats the header.
      type_name:
        value: type_code
        enum: object_type
        doc: The type by name, if it is one that this version names.
      is_required:
        value: (flags & 1) != 0
        doc: Whether a reader must know the type to read the file.
      sign_byte:
        pos: 31
        type: u1
        doc: The byte of the displacement whose highest bit is the sign.
  object_coordinate:
    doc: A coordinate of the origin of an object, which is the header's for object 0.
    seq:
      - id: value
        type: f8
        doc: The coordinate, in model units.
    instances:
      sign_byte:
        pos: 7
        type: u1
        doc: The byte whose highest bit is the sign.
  planes:
    doc: The elements, level by level; within a level in the order of their parents and of the cells of each parent.
    doc-ref: specification.md §2.3, §2.4, §5.4
    seq:
      - id: elements
        size: 16
        type: element(2, _index == 0 and _root.header.parity == 1, false)
        repeat: eos
        doc: Element n has the index n.
  element:
    doc: |
      An element or a brick: the tags of 64 cells, two levels below the cell to which it belongs. They are numbered in
      Morton order, so that the cells 8k to 8k + 7 are the children of octant k. Of an element, each BRANCH cell has an
      element or brick of its own; a brick has no BRANCH cells, and its cells are finest cells.
    doc-ref: specification.md §2.3, §5.5
    params:
      - id: num_planes
        type: u1
        doc: With one plane the upper bits are the lower bits, so that a cell is FULL or EMPTY.
      - id: is_half
        type: bool
        doc: Whether only the cells 0 to 7 exist, the octants of the universe, as in the root of an odd depth.
      - id: is_brick
        type: bool
        doc: Whether this is a brick.
    seq:
      - id: lower_octants
        type: u1
        repeat: expr
        repeat-expr: 8
        valid:
          expr: _index == 0 or not is_half or _ == 0
        doc: |
          The lower bits of the tags, "surely solid": of cell 8k + i bit i of byte k. Cells that do not exist are EMPTY.
          (`element-padding`, `brick-padding`)
      - id: upper_octants
        type: u1
        repeat: expr
        repeat-expr: 8
        if: num_planes == 2
        valid:
          expr: >-
            (_index == 0 or not is_half or _ == 0)
            and (not is_brick or (lower_octants[_index] & _) == lower_octants[_index])
            and (not _root.header.is_binary or (lower_octants[_index] & _) == _)
        doc: |
          The upper bits of the tags, "possibly solid". Cells that do not exist are EMPTY (`element-padding`,
          `brick-padding`), no cell of a brick is BRANCH (`brick-branch`), and none of a binary tree is PARTIAL
          (`planes-missing`).
      - id: end_of_element
        size: 0
        valid:
          expr: >-
            not (lower_bytes == none and upper_bytes == none) and not (lower_bytes == none and upper_bytes == all)
            and not (lower_bytes == all and upper_bytes == all)
        doc: |
          No bytes. The cells that exist do not all have one tag other than BRANCH. (`element-uniform`,
          `brick-uniform`)
    instances:
      ofs_upper:
        value: 'num_planes == 2 ? 8 : 0'
        doc: Where the upper bits begin.
      lower:
        pos: 0
        type: u8
        doc: The lower bits as one word. Bit c is that of cell c.
      upper:
        pos: ofs_upper
        type: u8
        doc: The upper bits as one word.
      lower_bytes:
        pos: 0
        size: 8
        doc: The lower bits as bytes.
      upper_bytes:
        pos: ofs_upper
        size: 8
        doc: The upper bits as bytes.
      none:
        value: '[0, 0, 0, 0, 0, 0, 0, 0].as<bytes>'
        doc: The bits of no cell.
      all:
        value: >-
          (is_half ? [0xff, 0, 0, 0, 0, 0, 0, 0].as<bytes>
          : [0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff].as<bytes>).as<bytes>
        doc: The bits of all cells that exist.
      branch:
        value: (lower & ~upper).as<u8>
        doc: The BRANCH cells. Bit c is set if cell c is one.
      partial:
        value: (upper & ~lower).as<u8>
        doc: The PARTIAL cells.
      full:
        value: (lower & upper).as<u8>
        doc: The FULL cells.
      octants:
        type: >-
          octant(_index, lower_octants[_index],
          num_planes == 2 ? upper_octants[_index] : lower_octants[_index])
        repeat: expr
        repeat-expr: 8
        doc: The eight octants, which the element does not store as such.
      cells:
        type: >-
          cell(_index, lower_octants[_index / 8] >> _index % 8 & 1,
          (num_planes == 2 ? upper_octants[_index / 8] : lower_octants[_index / 8]) >> _index % 8 & 1)
        repeat: expr
        repeat-expr: 64
        doc: The 64 cells.
  octant:
    doc: |
      An octant of the cell to which an element belongs. It reads nothing of the file. In the root of an odd depth only
      octant 0 exists, and is the universe.
    doc-ref: specification.md §2.3
    params:
      - id: index
        type: u1
        doc: Bit 0 is set in the upper half along x, bit 1 along y, bit 2 along z.
      - id: lower
        type: u1
        doc: The lower bits of its eight children.
      - id: upper
        type: u1
        doc: The upper bits of its eight children.
    instances:
      tag:
        value: |
          lower == 0 and upper == 0 ? tag::empty
          : lower == 0 and upper == 0xff ? tag::partial
          : lower == 0xff and upper == 0xff ? tag::full
          : tag::branch
        doc: The tag that all children have, if it is not BRANCH; else BRANCH, and the octant is a node of the octree.
  cell:
    doc: One cell of an element or brick. It reads nothing of the file.
    doc-ref: specification.md §2.2, §2.3
    params:
      - id: index
        type: u1
        doc: The number of the cell, whose bits are z1 y1 x1 z0 y0 x0 (Morton order).
      - id: lower
        type: u1
        doc: The lower bit of its tag.
      - id: upper
        type: u1
        doc: The upper bit of its tag.
    instances:
      x:
        value: (index & 1) + (index >> 2 & 2)
        doc: Place along x in the block of 4 · 4 · 4 cells.
      y:
        value: (index >> 1 & 1) + (index >> 3 & 2)
        doc: Place along y.
      z:
        value: (index >> 2 & 1) + (index >> 4 & 2)
        doc: Place along z.
      tag:
        value: lower + 2 * upper
        enum: tag
        doc: The tag of the cell.
  rel:
    doc: |
      First children of elements, as differences. The first child of element n, that is the element or brick of its
      first BRANCH cell, has the index base[n / 1024] + rel[n]; its other children follow in the order of their cells.
      Bricks are numbered on from the number of elements.
    doc-ref: specification.md §2.4, §5.4
    seq:
      - id: values
        type: rel_value(_index)
        repeat: eos
        doc: One for each element.
  rel_value:
    doc: The difference of one element.
    doc-ref: specification.md §2.4
    params:
      - id: index
        type: s4
        doc: The index of the element.
    seq:
      - id: value
        type: u2
        valid:
          expr: _ == 0 or index % 1024 != 0
        doc: What is added to the value of the block. The first element of each block has 0. (`element-link`, in part)
    instances:
      first_child:
        value: (_root.base.values[index / 1024] + value).as<u8>
        doc: The index of the element's first child, or of what would be it.
  base:
    doc: First children of the elements 0, 1024, 2048 and so on.
    doc-ref: specification.md §2.4, §5.4
    seq:
      - id: values
        type: u8
        repeat: eos
        doc: One for each block of 1024 elements.
  bricks:
    doc: Bricks, or dictionary entries, which are bricks as well.
    doc-ref: specification.md §5.5
    seq:
      - id: bricks
        size: _root.header.len_brick
        type: element(_root.header.num_brick_planes, _root.header.depth == 1, true)
        repeat: eos
        doc: The bricks in the order of their cells, or the entries.
  brick_indices:
    doc: For each brick its entry among those of its segment.
    doc-ref: specification.md §5.5
    seq:
      - id: indices
        type: brick_index(_index)
        repeat: eos
        doc: One for each brick.
  brick_index:
    doc: The dictionary entry of one brick.
    doc-ref: specification.md §5.5
    params:
      - id: index
        type: s4
        doc: The number of the brick.
    seq:
      - id: value
        type: u2
        valid:
          expr: _ < segment.num_entries
        doc: The entry, counted from the segment's first one. (`dictionary-index`)
    instances:
      segment:
        value: >-
          _root.dictionary_segments.segments[_root.header.segment_shift == 63 ? 0
          : index >> _root.header.segment_shift]
        doc: The segment of the brick.
      brick:
        value: _root.dictionary_entries.bricks[segment.first + value]
        doc: The brick.
  dictionary_segments:
    doc: Where the dictionary entries of each segment begin.
    doc-ref: specification.md §5.5
    seq:
      - id: segments
        type: dictionary_segment(_index)
        repeat: eos
        doc: Segment s is that of the bricks s · 2^shift to (s + 1) · 2^shift − 1.
  dictionary_segment:
    doc: The dictionary entries of one segment.
    doc-ref: specification.md §5.5
    params:
      - id: index
        type: s4
        doc: The number of the segment.
    seq:
      - id: first
        type: u8
        valid:
          expr: >-
            index == 0 ? _ == 0
            : _ >= _parent.segments[index - 1].first and _ - _parent.segments[index - 1].first <= 65536
        doc: The segment's first entry; the last one lies before that of the next segment. (`dictionary-range`)
      - id: end_of_segments
        size: 0
        if: is_last
        valid:
          expr: first <= _root.header.num_dictionary_entries and _root.header.num_dictionary_entries - first <= 65536
        doc: No bytes. The entries of the last segment end with the last entry. (`dictionary-range`)
    instances:
      is_last:
        value: index == _root.header.num_segments.as<s4> - 1
        doc: Whether this is the last segment.
      end:
        value: '(is_last ? _root.header.num_dictionary_entries : _parent.segments[index + 1].first).as<u8>'
        doc: Where the segment's entries end.
      num_entries:
        value: (end - first).as<u8>
        doc: Number of the segment's entries.
  level_table:
    doc: |
      Counts of cells of every octree level, from 0, the universe, to the depth, the finest cells. A cell counts on its
      level if its parent is BRANCH; so eight cells of one octant with the same tag count as the octant.
    doc-ref: specification.md §5.3
    seq:
      - id: levels
        type: level(_index)
        repeat: eos
        doc: Entry l is that of octree level l.
      - id: element_levels
        type: element_level(_index)
        repeat: expr
        repeat-expr: _root.header.num_element_levels
        doc: Where each element level begins. These are derived from the levels, and read nothing.
    instances:
      num_full_cells:
        value: levels.last.full_cells
        doc: Volume that is FULL, in finest cells.
        doc-ref: specification.md §7.2
      num_possible_cells:
        value: levels.last.possible_cells
        doc: Volume that is FULL or PARTIAL, in finest cells.
        doc-ref: specification.md §7.2
  level:
    doc: The cells of one octree level.
    doc-ref: specification.md §5.3
    params:
      - id: index
        type: s4
        doc: The octree level.
    seq:
      - id: num_nodes
        type: u8
        valid:
          expr: >-
            index == 0 ? _ == (_root.header.root_tag == tag::branch ? 1 : 0)
            : index < _root.header.depth or _ == 0
        doc: |
          BRANCH cells. (`level-table-root`; implied: finest cells are never BRANCH.)
      - id: num_full
        type: u8
        valid:
          expr: 'index != 0 or _ == (_root.header.root_tag == tag::full ? 1 : 0)'
        doc: FULL cells. (Implied for level 0.)
      - id: num_partial
        type: u8
        valid:
          expr: >-
            (index != 0 or _ == (_root.header.root_tag == tag::partial ? 1 : 0))
            and (_ == 0 or not _root.header.is_binary)
        doc: PARTIAL cells. (Implied for level 0 and for binary trees.)
    instances:
      num_empty:
        value: >-
          ((index == 0 ? 1 : 8 * _parent.levels[index - 1].num_nodes) - num_nodes - num_full - num_partial).as<u8>
        doc: EMPTY cells.
      full_cells:
        value: '(num_full + (index == 0 ? 0 : 8 * _parent.levels[index - 1].full_cells.as<u8>)).as<u8>'
        doc: Volume that is FULL on this level and above, in cells of this level.
      possible_cells:
        value: |
          (num_full + num_partial + (index == 0 ? 0 : 8 * _parent.levels[index - 1].possible_cells.as<u8>)).as<u8>
        doc: Volume that is FULL or PARTIAL on this level and above, in cells of this level.
  element_level:
    doc: |
      One level of elements; the last one is that of the bricks. Its elements belong to the BRANCH cells of one octree
      level.
    doc-ref: specification.md §2.3, §5.3
    params:
      - id: index
        type: s4
        doc: The element level.
    seq:
      - id: end_of_level
        size: 0
        valid:
          expr: >-
            num_elements <= num_all - first
            and (index != num_levels - 1 or (first == _root.header.num_elements and end - num_all == 0))
        doc: |
          No bytes. Elements end where bricks begin, and these end with the last one. (`level-table-starts`,
          `level-table-sum`)
    instances:
      num_levels:
        value: _root.header.num_element_levels
        doc: The number of element levels.
      num_all:
        value: (_root.header.num_elements + _root.header.num_bricks).as<u8>
        doc: The number of elements and bricks.
      octree_level:
        value: 'index == 0 ? 0 : 2 * index - _root.header.parity'
        doc: The octree level of the cells to which the elements belong; for the root of odd depth, the universe's.
      num_elements:
        value: _parent.levels[octree_level].num_nodes
        doc: The number of elements of this level.
      first:
        value: '(index == 0 ? 0 : _parent.element_levels[index - 1].end).as<u8>'
        doc: The index of the first element of this level.
      end:
        value: (first + num_elements).as<u8>
        doc: The index behind the last one.
  metadata:
    doc: |
      Facts about the solid. They change nothing about what the rest of the file means. In use are the keys `name`,
      `units` (the unit of length of the model), `source` (a fingerprint of what the tree was made from) and `rule` (how
      undecided cells were resolved).
    doc-ref: specification.md §5.2
    seq:
      - id: facts
        type: fact(_index)
        repeat: eos
        doc: The facts, which fill the section.
  fact:
    doc: A key and a value.
    doc-ref: specification.md §5.2
    params:
      - id: index
        type: s4
        doc: The place among the facts.
    seq:
      - id: len_key
        type: u4
        doc: Bytes of the key.
      - id: len_value
        type: u4
        doc: Bytes of the value.
      - id: key_bytes
        size: len_key
        valid:
          expr: index == 0 or _ > _parent.facts[index - 1].key_bytes
        doc: The key as it is stored. Keys ascend byte by byte. (`metadata-text`)
      - id: value_bytes
        size: len_value
        doc: The value as it is stored.
    instances:
      key:
        value: key_bytes.to_s("UTF-8")
        doc: The key. (`metadata-text` refuses what is no UTF-8; whether this does depends on the language.)
      value:
        value: value_bytes.to_s("UTF-8")
        doc: The value.
enums:
  tag:
    0:
      id: empty
      doc: Outside, the cell's interior and the solid's have no point in common.
    1:
      id: branch
      doc: Cut, its eight children have tags of their own.
    2:
      id: partial
      doc: Not decided, the cell may be outside, inside, or cut.
    3:
      id: full
      doc: Inside, the whole cell belongs to the solid.
  brick_encoding:
    0:
      id: raw
      doc: Bricks lie one after another.
    1:
      id: dictionary
      doc: Each brick is an index into the bricks that differ.
  element_type:
    0:
      id: record
      doc: A record that the kind of the section lays out, in units of 8 bytes.
    1:
      id: u1
      doc: Bytes.
    2:
      id: u2
      doc: Unsigned integers of 2 bytes.
    3:
      id: u4
      doc: Unsigned integers of 4 bytes.
    4:
      id: u8
      doc: Unsigned integers of 8 bytes.
    5:
      id: f4
      doc: Floating-point numbers of 4 bytes.
    6:
      id: f8
      doc: Floating-point numbers of 8 bytes.
  object_type:
    1:
      id: solid
      doc: A solid.
    2:
      id: channel
      doc: A channel of values, from version 0.2 on.
    3:
      id: tri_dexels
      doc: Reserved for tri-dexel models.
    4:
      id: version
      doc: Reserved for versions.
    5:
      id: partial_values
      doc: Reserved for values of PARTIAL cells.
  section_kind:
    1:
      id: objects
      doc: What the file holds, 128 bytes each.
    2:
      id: metadata
      doc: Keys and values.
    3:
      id: level_table
      doc: Counts of cells of each octree level, 24 bytes each.
    4:
      id: planes
      doc: Elements, 16 bytes each.
    5:
      id: rel
      doc: Links of single elements, 2 bytes each.
    6:
      id: base
      doc: Links of blocks of 1024 elements, 8 bytes each.
    7:
      id: bricks
      doc: Raw bricks, 8 or 16 bytes each.
    8:
      id: brick_indices
      doc: Dictionary entries of bricks, 2 bytes each.
    9:
      id: dictionary_entries
      doc: Bricks that differ, 8 or 16 bytes each.
    10:
      id: dictionary_segments
      doc: First entries of segments, 8 bytes each.
    11:
      id: cut_heads
      doc: One byte for each cut.
    12:
      id: cut_ids
      doc: Surfaces of each cut, a stream of bits.
    13:
      id: cut_blocks
      doc: What is counted before every 32nd cut, 8 bytes each.
    14:
      id: cut_first
      doc: Cuts before each element and brick, 4 bytes each.
    15:
      id: surfaces
      doc: Surfaces, 16 bytes each.
    20:
      id: surface_numbers
      doc: Doubles of the surfaces.
    21:
      id: placements
      doc: Maps that place surfaces, 104 bytes each.
    22:
      id: origins
      doc: What slabs were made from, 16 bytes each.
    23:
      id: cell_slabs
      doc: Slabs that were made for one cell, 16 bytes each.
    24:
      id: cell_slab_groups
      doc: What those were made from, 24 bytes each.
    25:
      id: moments
      doc: Bounds of the moments of the solid, 184 bytes.
    32:
      id: windows
      doc: Rays of each direction, 16 bytes each.
    33:
      id: starts_x
      doc: First interval of each ray along x.
    34:
      id: spans_x
      doc: Ends of each interval along x.
    35:
      id: normals_x
      doc: Normals at both ends of each interval along x.
    36:
      id: surfaces_x
      doc: Surfaces of both ends of each interval along x.
    37:
      id: materials_x
      doc: Material of each interval along x.
    38:
      id: starts_y
      doc: First interval of each ray along y.
    39:
      id: spans_y
      doc: Ends of each interval along y.
    40:
      id: normals_y
      doc: Normals at both ends of each interval along y.
    41:
      id: surfaces_y
      doc: Surfaces of both ends of each interval along y.
    42:
      id: materials_y
      doc: Material of each interval along y.
    43:
      id: starts_z
      doc: First interval of each ray along z.
    44:
      id: spans_z
      doc: Ends of each interval along z.
    45:
      id: normals_z
      doc: Normals at both ends of each interval along z.
    46:
      id: surfaces_z
      doc: Surfaces of both ends of each interval along z.
    47:
      id: materials_z
      doc: Material of each interval along z.
