"""Reads the test vectors with the Python code compiled from leafless.ksy. Started by check_ksy.sh.

Of each valid file everything is read, and compared with what its text states. Of each invalid file everything is read,
too, and what refuses it must be the field that `SEEN_BY` names for its rule; files of rules that a description cannot
state must be readable. Checksums are computed here: in invalid files, too, they must be wrong only where the rule says.
"""

import json
import math
import sys
import zlib
from fractions import Fraction
from pathlib import Path

import kaitaistruct
from kaitaistruct import KaitaiStruct

from leafless import Leafless

Tag = Leafless.Tag

# What refuses a file instead of a field: the bytes end before what is read, or they are no UTF-8.
END = "end of file"
TEXT = "not UTF-8"

# The field that says how long the file is. It is looked at after the header, before the table.
LENGTH = "header.end_of_header"

# The fields of an object, of which that of the solid repeats the header.
OBJECT_FIELDS = {
    "object_record." + name
    for name in (
        "type_code parent flags depth root_tag exterior proof num_brick_planes brick_encoding segment_shift "
        "value_type num_components form reserved1 displacement edge extents reserved2 num_elements num_bricks "
        "num_dictionary_entries num_values reserved3 end_of_object"
    ).split()
}

# For each rule of the specification the fields of which one must refuse its files, but for those in `SEEN_OTHERWISE`.
# None stands for rules that the description does not state: it must read their files.
SEEN_BY = {
    "header-text-mode": {"header.magic"},
    "header-magic": {"header.magic", END},
    "header-short": {END},
    "header-major": {"header.version_major", "header.version_minor"},
    "header-crc": None,
    "header-length": {"header.len_header"},
    "header-required-flags": {"header.required_flags"},
    "header-optional-flags": {"header.optional_flags"},
    "header-reserved": {"header.form", "header.reserved2"},
    "header-origin": {"coordinate.value"},
    "header-edge": {"header.edge"},
    "header-depth": {"header.depth"},
    "header-root": {"header.root_tag"},
    "header-exterior": {"header.exterior"},
    "header-proof": {"header.proof"},
    "header-displacement": {"displacement.value"},
    "header-brick-planes": {"header.num_brick_planes"},
    "header-encoding": {"header.brick_encoding"},
    "header-raw-shift": {"header.segment_shift"},
    "header-raw-entries": {"header.num_dictionary_entries"},
    "header-shift": {"header.segment_shift", "header.num_bricks"},
    "header-entries": {"header.num_dictionary_entries"},
    "header-elements": {"header.num_elements"},
    "header-bricks": {"header.num_bricks"},
    "header-section-count": {"header.num_sections"},
    "header-file-length": {"header.num_sections"},
    "table-short": {LENGTH},
    "table-crc": None,
    "section-kind": {"section.kind_code"},
    "section-flags": {"section.flags"},
    "table-reserved": {"section.reserved"},
    "table-encoding": {"section.encoding"},
    "table-element": {"section.element_code", "section.num_components"},
    "section-length": {"section.len_body", "section.num_elements"},
    "object-count": {"section.owner", "section.num_elements"},
    "table-owner": {"section.owner"},
    "table-order": {"section.owner"},
    "table-same": {"section.same", "section.end_of_same"},
    "section-alignment": {"section.end_of_own"},
    "section-overlap": {"section.end_of_own"},
    "section-beyond": {"section.end_of_own"},
    "section-unknown": {"section.end_of_entry"},
    "section-size": {"section.end_of_entry"},
    "section-count": {"section.end_of_entry"},
    "section-metadata-length": {"section.end_of_entry"},
    "section-required": {"section.end_of_entry"},
    "section-missing": {"section.end_of_table"},
    "section-cuts": {"cell_slab_group.end", "moments.end_of_moments", None},
    "section-end": {"section.end_of_table"},
    "file-length": {LENGTH},
    "object-mirror": OBJECT_FIELDS,
    "object-type": {"object_record.type_code"},
    "object-flags": {"object_record.flags"},
    "object-parent": {"object_record.parent"},
    "object-required": {"object_record.flags"},
    "level-table-root": {"level.num_nodes"},
    "level-table-starts": {"element_level.end_of_level"},
    "level-table-sum": {"element_level.end_of_level"},
    "metadata-text": {"fact.key_bytes", END, TEXT},
    "padding": {"section.padding"},
    "section-crc": None,
    "element-count": None,
    "element-link": None,
    "element-padding": {"element.lower_octants", "element.upper_octants"},
    "element-uniform": {"element.end_of_element"},
    "dictionary-range": {"dictionary_segment.first", "dictionary_segment.end_of_segments"},
    "dictionary-index": {"brick_index.value"},
    "dictionary-unused": None,
    "dictionary-order": None,
    "dictionary-duplicate": None,
    "brick-padding": {"element.lower_octants", "element.upper_octants"},
    "brick-uniform": {"element.end_of_element"},
    "brick-branch": {"element.upper_octants"},
    "planes-missing": {"header.num_brick_planes", "element.upper_octants", "level.num_partial"},
    "planes-needless": None,
    "cut-first": None,
    "cell-slab-group": {"cell_slab_group.end", None},
    "cut-block": None,
    "cut-head": None,
    "cut-group": None,
    "cut-uniform": None,
    "cut-ids": None,
    "moments": {"moment_number.value", "moment_bounds.end_of_bounds"},
    "surface-record": {"surface.kind", "surface.terms", None},
    "surface-number": None,
    "surface-origin": {"surface.origin_low", "surface.origin_high", None},
    "surface-placement": {"placement.outer", None},
    "cell-slab": {"cell_slab.home", "cell_slab.component", "cell_slab.other_component", "cell_slab.fields", None},
    "placement-map": {"placement.entries", None},
    "level-table-counts": None,
    "channel-count": None,
    "channel-record": {
        "object_record." + name
        for name in (
            "parent exterior proof num_brick_planes form reserved1 displacement edge extents reserved2 reserved3 end_of_object"
        ).split()
    },
    "channel-root": {"object_record.root_tag"},
    "channel-depth": {"object_record.depth"},
    "channel-type": {"object_record.value_type", "object_record.num_components"},
    "channel-counts": {
        "object_record." + name
        for name in "brick_encoding segment_shift num_elements num_bricks num_dictionary_entries".split()
    },
    "channel-unknown": None,
    "channel-section": None,
    "channel-name": None,
    "channel-uniform": None,
    "channel-rank": None,
    "channel-start": None,
    "channel-values": None,
    "channel-value": None,
    "dexel-field": {"header.num_brick_planes", "header.segment_shift", "header.end_of_octree_fields"},
    "dexel-form": {"header.form"},
    "dexel-intervals": {"header.num_elements", "header.num_dictionary_entries"},
    "dexel-window": {"window.end_of_window"},
    # Of a direction that has no starts the table is refused; how many there are is not stated.
    "dexel-rays": {None, "section.end_of_table"},
    "dexel-starts": None,
    "dexel-interval": None,
    "dexel-normal": None,
    "dexel-hull": None,
}

# Files that break another rule, too, and are refused for that one. None stands for files of which the sections of a
# channel break the rule, which the description states of the solid alone.
SEEN_OTHERWISE = {
    "brick-branch-channel": None,
    "dictionary-index-channel": None,
    "element-padding-channel": None,
    "level-table-root-channel": None,
    "level-table-starts-channel": None,
    "level-table-sum-channel": None,
    "metadata-text-channel": None,
    "element-uniform-partial": "element.upper_octants",
    "element-link-first-rel": "rel_value.value",
    "header-crc-field": "coordinate.value",
    "level-table-counts-finest-nodes": "level.num_nodes",
    "level-table-counts-root": "level.num_full",
    "table-crc-entry": "section.flags",
}


class Mismatch(Exception):
    """What was read is not what was to be read."""


def read_all(root):
    """Reads all fields and instances below `root`, so that all rules of the description are applied."""
    seen = {id(root)}
    stack = [root]
    while stack:
        value = stack.pop()
        if isinstance(value, list):
            below = value
        else:
            kind = type(value)
            names = [name for name in vars(value) if not name.startswith("_")]
            names += [name for name in vars(kind) if isinstance(vars(kind)[name], property)]
            below = [getattr(value, name) for name in names]
        for part in below:
            if isinstance(part, (list, KaitaiStruct)) and id(part) not in seen:
                seen.add(id(part))
                stack.append(part)


def refusal(data, description):
    """What refuses the file, or None; and the file if at least header and table could be read."""
    root = None
    try:
        root = Leafless.from_bytes(data)
        read_all(root)
    except kaitaistruct.ValidationFailedError as error:
        return field_name(error.src_path, description), root
    except EOFError:
        return END, root
    except UnicodeDecodeError:
        return TEXT, root
    return None, root


def field_name(path, description):
    """The name of the field at a path such as /types/header/seq/0 of the description."""
    names = []
    at = description
    steps = path.strip("/").split("/")
    for before, step in zip([""] + steps, steps):
        at = at[int(step)] if isinstance(at, list) else at[step]
        if before == "seq":
            names.append(at["id"])
        elif before in ("types", "instances"):
            names.append(step)
    return ".".join(names)


def wrong_checksums(data, root):
    """The rules of checksums that the file breaks."""
    header = root.header
    rules = []
    if zlib.crc32(data[:124]) != header.header_crc32:
        rules.append("header-crc")
    if zlib.crc32(data[128 : header.len_table_end]) != header.section_table_crc32:
        rules.append("table-crc")
    if any(zlib.crc32(data[part.ofs_body :][: part.len_body]) != part.body_crc32 for part in root.sections):
        rules.append("section-crc")
    return rules


def finest_cell(root, point):
    """The coordinates of the finest cell that contains a point; None outside of the universe."""
    header = root.header
    if not all(map(math.isfinite, point)):
        return None
    cell = []
    for v, origin in zip(point, (header.origin_x, header.origin_y, header.origin_z)):
        place = (Fraction(v) - Fraction(origin.value)) / Fraction(header.edge) * 2**header.depth
        if not 0 <= place <= 2**header.depth:
            return None
        cell.append(min(math.floor(place), 2**header.depth - 1))
    return cell


def tag_of(root, cell):
    """The tag of a finest cell, found through elements and links."""
    header = root.header
    if header.root_tag != Tag.branch:
        return header.root_tag
    levels = root.level_table.element_levels
    n = 0
    for e, level in enumerate(levels):
        if not level.first <= n < level.end:
            raise Mismatch(f"a link leads to {n}, out of element level {e}")
        shift = 2 * (len(levels) - 1 - e)
        place = tuple(v >> shift & 3 for v in cell)
        if e < len(levels) - 1:
            element = root.planes.elements[n]
        elif header.has_dictionary:
            element = root.brick_indices.indices[n - header.num_elements].brick
        else:
            element = root.bricks.bricks[n - header.num_elements]
        found = next(c for c in element.cells if (c.x, c.y, c.z) == place)
        if found.tag != Tag.branch:
            return found.tag
        n = root.rel.values[n].first_child + bin(element.branch & ((1 << found.index) - 1)).count("1")
    raise Mismatch("a brick has a BRANCH cell")


def answer(root, point):
    """The answer about a point, in the word of the texts."""
    cell = finest_cell(root, point)
    if cell is None:
        return "undecided"
    return {Tag.empty: "outside", Tag.full: "inside", Tag.partial: "undecided"}[tag_of(root, cell)]


def facts(path):
    """The lines of a text as keys and values."""
    lines = path.read_bytes().decode("utf-8").split("\n")
    if lines.pop() != "":
        raise Mismatch("the text does not end with a line end")
    return [tuple(line.split(": ", 1)) for line in lines]


def doubles(text):
    """Hexadecimal doubles."""
    return [float.fromhex(word) for word in text.split(" ")]


def channel(number, record):
    """What the record of a channel says, as the line of a text."""
    root = Tag(record.root_tag).name.upper()
    scalar = {1: "u8", 2: "u16", 3: "u32", 5: "f32"}[record.value_type]
    encoding = ("raw", "dictionary")[record.brick_encoding]
    return (
        f"{number} {record.depth} {root} {scalar} {record.num_components} {record.num_values} {encoding} "
        f"{record.segment_shift} {record.num_elements} {record.num_bricks} {record.num_dictionary_entries}"
    )


def cuts(data, root):
    """What the file says of cuts, as the lines of a text, with doubles as numbers."""
    keys = ("cuts", "surface", "placement", "slab-origin", "cell-slab", "cell-slab-group", "moments")
    told = {key: [] for key in keys}
    if root.cut_heads is None:
        return told
    heads = root.cut_heads.heads
    surfaces = root.surfaces.surfaces if root.surfaces else []
    placements = root.placements.placements if root.placements else []
    origins = root.origins.origins if root.origins else []
    nothing, splits = heads.count(0), heads.count(255)
    slabs = root.cell_slabs.slabs if root.cell_slabs else []
    groups = root.cell_slab_groups.groups if root.cell_slab_groups else []
    counts = [len(heads) - nothing - splits, nothing, splits, len(surfaces) + len(slabs)]
    counts += [len(placements), len(origins), len(slabs), len(groups)]
    told["cuts"].append(" ".join(map(str, counts)))
    for i, surface in enumerate(surfaces):
        kind = ("plane", "quadric", "powers", "torus", "slab")[surface.kind]
        at = surface.first
        numbers = []
        for k in range(surface.num_numbers):
            end = at + (surface.terms >> (3 * k) & 7)
            numbers.append(root.surface_numbers.values[at:end])
            at = end
        if kind == "slab":
            # A number of 64 bits in the place of a double.
            start = root.find_surface_numbers.section.ofs_body + 8 * at
            number = int.from_bytes(data[start : start + 8], "little") if surface.has_number else i
            numbers += [surface.origin, number if surface.origin else 0]
        told["surface"].append([str(i), kind, str(surface.placement), *numbers])
    for i, map_ in enumerate(placements):
        told["placement"].append([str(i), str(map_.outer), *map_.entries])
    for i, origin in enumerate(origins):
        told["slab-origin"].append(f"{i} {origin.low:016x} {origin.high:016x}")
    for i, slab in enumerate(slabs):
        path = slab.home & (1 << 61) - 1
        level = (path.bit_length() - 1) // 3
        at = [sum((path >> 3 * k + axis & 1) << k for k in range(level)) for axis in range(3)]
        normal = [Fraction(-1 if slab.is_negative else 1)] * 3
        for k, component in enumerate((slab.component, slab.other_component)):
            normal[(slab.axis + 1 + k) % 3] = Fraction(component, 1 << 15)
        inner = sum(n * Fraction(2 * a + 1, 2 << level) for n, a in zip(normal, at)) + Fraction(slab.offset, 1 << slab.step)
        outer = inner + Fraction(slab.width, 1 << slab.step)
        told["cell-slab"].append([f"{len(surfaces) + i} {level} {at[0]} {at[1]} {at[2]} {slab.index}", *normal, inner, outer])
    for i, group in enumerate(groups):
        told["cell-slab-group"].append(f"{i} {group.origin.low:016x} {group.origin.high:016x} {group.end}")
    if root.moments:
        bounds = [root.moments.volume, *root.moments.first_moments, *root.moments.second_moments]
        ends = [end.value for own in bounds for end in (own.lower, own.upper)]
        told["moments"].append([number.value for number in root.moments.point] + ends)
    return told


def check_dexels(data, root, stated):
    """Compares a valid file of a tri-dexel model with its text, but for what lies in the arrays of its directions."""
    header = root.header
    intervals = [header.num_elements, header.num_bricks, header.num_dictionary_entries]
    axes = [axis for axis in range(3) if header.form >> (5 + axis) & 1]
    windows = zip(axes, root.windows.windows)
    known = {
        "length": [str(len(data))],
        "version": [f"{header.version_major}.{header.version_minor}"],
        "depth": [str(header.depth)],
        "ends": ["double" if header.form & 1 else "fixed"],
        "normals": [str(16 * (header.form >> 1 & 3))],
        "surfaces": ["yes" if header.form & 8 else "no"],
        "materials": ["yes" if header.form & 16 else "no"],
        "objects": [str(len(root.objects.objects))],
        "sections": [" ".join(str(part.kind_code) for part in root.sections)],
        "owners": [" ".join(str(part.owner) for part in root.sections)],
        "direction": [f"{k} {w.first_u} {w.first_v} {w.width} {w.height} {intervals[k]}" for k, w in windows],
        "metadata": [f"{fact.key}\t{fact.value}" for fact in root.metadata.facts] if root.metadata else [],
    }
    for key, value in known.items():
        told = [line for name, line in stated if name == key]
        if told != value:
            raise Mismatch(f"{key}: the text says {told}, the file {value}")
    return sum(map(len, known.values()))


def check_valid(data, stated, description):
    """Compares a valid file with its text. Returns how many lines were compared."""
    by, root = refusal(data, description)
    if by is not None:
        raise Mismatch(f"refused by {by}")
    if wrong_checksums(data, root):
        raise Mismatch(f"checksums: {wrong_checksums(data, root)}")
    if root.header.is_dexels:
        return check_dexels(data, root, stated)
    header = root.header
    depth = header.depth
    frame = [header.origin_x.value, header.origin_y.value, header.origin_z.value]
    levels = root.level_table.levels

    # Computed once more, in another way than the description does.
    surely = sum(level.num_full * 8 ** (depth - l) for l, level in enumerate(levels))
    possibly = surely + sum(level.num_partial * 8 ** (depth - l) for l, level in enumerate(levels))
    if (surely, possibly) != (root.level_table.num_full_cells, root.level_table.num_possible_cells):
        raise Mismatch("the volume of the description is not that of the level table")
    if sum(level.num_empty * 8 ** (depth - l) for l, level in enumerate(levels)) + possibly != 8**depth:
        raise Mismatch("the cells of the level table do not fill the universe")

    known = {
        "length": [str(len(data))],
        "version": [f"{header.version_major}.{header.version_minor}"],
        "origin": [frame],
        "origin-decimal": [frame],
        "edge": [[header.edge]],
        "edge-decimal": [[header.edge]],
        "depth": [str(depth)],
        "proof": [str(header.proof)],
        "displacement": [[header.displacement.value]],
        "planes": [str(header.num_brick_planes)],
        "encoding": [header.brick_encoding.name],
        "shift": [str(header.segment_shift)],
        "elements": [str(header.num_elements)],
        "bricks": [str(header.num_bricks)],
        "entries": [str(header.num_dictionary_entries)],
        "root": [header.root_tag.name.upper()],
        "exterior": [header.exterior.name.upper()],
        "objects": [str(len(root.objects.objects))],
        "sections": [" ".join(str(part.kind_code) for part in root.sections)],
        "owners": [" ".join(str(part.owner) for part in root.sections)],
        "level": [f"{l} {v.num_nodes} {v.num_full} {v.num_partial}" for l, v in enumerate(levels)],
        "cells": [f"{surely} {possibly}"],
        "channel": [channel(number, record) for number, record in enumerate(root.objects.objects) if record.is_channel],
        "metadata": [f"{fact.key}\t{fact.value}" for fact in root.metadata.facts] if root.metadata else [],
        **cuts(data, root),
    }
    told = {key: [] for key in known}
    compared = 0
    for key, value in stated:
        # The description does not state the sections of channels.
        # Nor does it say what cuts say of points.
        if key in ("about", "canonical", "channel-level", "channel-metadata", "value", "cut-point"):
            continue
        compared += 1
        if key == "point":
            *point, expected = value.split(" ")
            given = answer(root, [float.fromhex(word) for word in point])
            if given != expected:
                raise Mismatch(f"point {value}: {given}")
        elif key in ("origin", "edge", "displacement", "moments"):
            told[key].append(doubles(value))
        elif key in ("origin-decimal", "edge-decimal"):
            told[key].append([float(word) for word in value.split(" ")])
        elif key == "surface":
            i, kind, placement, *numbers = value.split(" ")
            identity = [int(numbers.pop()) for _ in range(2 if kind == "slab" else 0)]
            split = [[float.fromhex(word) for word in number.split(",") if number != "0"] for number in numbers]
            told[key].append([i, kind, placement, *split, *reversed(identity)])
        elif key == "cell-slab":
            *cell, x, y, z, inner, outer = value.split(" ")
            told[key].append([" ".join(cell), *map(float.fromhex, (x, y, z, inner, outer))])
        elif key == "placement":
            i, outer, *entries = value.split(" ")
            told[key].append([i, outer, *map(float.fromhex, entries)])
        elif key in told:
            told[key].append(value)
        else:
            raise Mismatch(f"the text has an unknown key: {key}")
    for key, value in known.items():
        if told[key] != value:
            raise Mismatch(f"{key}: the text says {told[key]}, the file {value}")
    return compared


def check_invalid(name, data, stated, description):
    """Reads an invalid file. Returns its rule and what refused it."""
    stated = dict(stated)
    rule = stated["rule"]
    if rule not in SEEN_BY:
        raise Mismatch(f"the rule {rule} is unknown")
    fields = {SEEN_OTHERWISE[name]} if name in SEEN_OTHERWISE else SEEN_BY[rule] or {None}
    by, root = refusal(data, description)
    if "error-of-length" in stated:
        # The length is wrong, too, and refuses the file first. A rule of the section table's entries is looked at in
        # the file made as long as it says.
        if by != LENGTH:
            raise Mismatch(f"the length is wrong; refused by {by}")
        if rule == "section-crc" or any(str(field).startswith("section.") for field in fields):
            size = int.from_bytes(data[24:32], "little")
            by, root = refusal(data[:size].ljust(size, b"\0"), description)
        else:
            fields = {LENGTH}
    if by not in fields:
        expected = " or ".join(sorted(map(str, fields)))
        raise Mismatch(f"{rule} must be refused by {expected}; refused by {by}")
    if root is not None:
        wrong = wrong_checksums(data, root)
        if wrong != [rule] * rule.endswith("-crc"):
            raise Mismatch(f"rule {rule}, wrong checksums: {wrong}")
    return rule, by


def main():
    # The instances of a section lead to those of the section before it: some calls for each.
    sys.setrecursionlimit(40_000)
    description = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    vectors = Path(sys.argv[2])
    valid = sorted((vectors / "valid").glob("*.lfl"))
    invalid = sorted((vectors / "invalid").glob("*.lfl"))
    failures = 0

    compared = 0
    for path in valid:
        try:
            compared += check_valid(path.read_bytes(), facts(path.with_suffix(".txt")), description)
        except Mismatch as error:
            failures += 1
            print(f"FAILED valid/{path.name}: {error}")

    refused = 0
    unseen = {}
    rules = set()
    for path in invalid:
        try:
            rule, by = check_invalid(path.stem, path.read_bytes(), facts(path.with_suffix(".txt")), description)
        except Mismatch as error:
            failures += 1
            print(f"FAILED invalid/{path.name}: {error}")
            continue
        rules.add(rule)
        if by is None:
            unseen.setdefault(rule, []).append(path.stem)
        else:
            refused += 1

    print(f"valid:   {len(valid)} files, {compared} lines of their texts compared")
    print(f"invalid: {len(invalid)} files, {refused} refused; not seen by the description:")
    for rule in SEEN_BY:
        if rule in unseen:
            print(f"    {rule}: {', '.join(unseen[rule])}")
    for rule in sorted(SEEN_BY.keys() - rules):
        failures += 1
        print(f"FAILED no file that breaks the rule {rule} was checked")
    if not valid:
        failures += 1
        print("FAILED there is no valid file")
    print("ok" if failures == 0 else f"{failures} failed")
    return failures != 0


if __name__ == "__main__":
    sys.exit(main())
