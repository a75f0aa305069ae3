# SPDX-License-Identifier: BSD-3-Clause
"""Ways to break a file. Each takes a random generator and the file's bytes, and returns other
bytes."""
import re

NUMBERS = (b"0", b"-1", b"1", b"7", b"255", b"2147483647", b"2147483648", b"4294967296",
           b"1000000000000000", b"9223372036854775807", b"18446744073709551616",
           b"-9223372036854775808", b"nan", b"inf", b"-inf",
           b"1e39", b"1e60", b"1e400", b"1e-320", b"x", b"")
INTEGERS = (0, 1, 0x7F, 0x80, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 10**9, 10**15,
            2**63 - 1, 2**64 - 1)
# Each word is exchanged for another of its group.
WORDS = ((b"Int8", b"UInt8", b"Int16", b"Int32", b"UInt32", b"Int64", b"UInt64", b"Float32",
          b"Float64", b"String", b"Bit", b"IdType"),
         (b"ascii", b"binary", b"appended"), (b"LittleEndian", b"BigEndian"),
         (b"vtkZLibDataCompressor", b"vtkLZ4DataCompressor", b"vtkLZMADataCompressor",
          b"vtkNoDataCompressor"),
         (b"UnstructuredGrid", b"PolyData", b"ImageData", b"PUnstructuredGrid"),
         (b"connectivity", b"offsets", b"types", b"faces", b"faceoffsets"),
         (b"Points", b"Cells", b"PointData", b"CellData", b"Polys", b"Verts", b"DataArray",
          b"Piece", b"FieldData"),
         (b"POINTS", b"CELLS", b"CELL_TYPES", b"POLYGONS", b"OFFSETS", b"CONNECTIVITY",
          b"POINT_DATA", b"CELL_DATA", b"FIELD", b"METADATA", b"SCALARS", b"LINES"),
         (b"ASCII", b"BINARY"),
         (b"double", b"float", b"int", b"long", b"char", b"vtktypeint64", b"bit", b"string"),
         (b"UNSTRUCTURED_GRID", b"POLYDATA", b"STRUCTURED_POINTS"), (b"5.1", b"4.2", b"2.0"),
         (b"facet", b"vertex", b"endloop", b"endsolid", b"solid"),
         (b"element", b"property", b"vertex", b"face", b"end_header"),
         (b"hex", b"tet", b"pyr", b"quad", b"line"))


def truncated(random, data):
    return data[:random.randrange(len(data))]


def bits_flipped(random, data):
    result = bytearray(data)
    for _ in range(random.choice((1, 1, 1, 2, 4, 16))):
        result[random.randrange(len(result))] ^= 1 << random.randrange(8)
    return bytes(result)


def number_replaced(random, data):
    """One number of the text; mostly one near the start, where the counts are."""
    reach = random.choice((300, 1000, len(data)))
    found = list(re.finditer(rb"(?<![\w.])[-+]?\d+(\.\d+)?([eE][-+]?\d+)?(?![\w.])", data[:reach]))
    if not found:
        return integer_replaced(random, data)
    one = random.choice(found)
    return data[:one.start()] + random.choice(NUMBERS) + data[one.end():]


def integer_replaced(random, data):
    """Four or eight bytes of a binary file."""
    size = random.choice((4, 8))
    at = random.randrange(max(1, len(data) - size))
    value = random.choice(INTEGERS) % 256**size
    return data[:at] + value.to_bytes(size, random.choice(("little", "big"))) + data[at + size:]


def part_removed(random, data):
    at, count = random.randrange(len(data)), random.choice((1, 2, 8, 64, 512))
    return data[:at] + data[at + count:]


def part_doubled(random, data):
    at, count = random.randrange(len(data)), random.choice((1, 8, 64, 512))
    return data[:at + count] + data[at:]


def line_removed(random, data):
    lines = data.splitlines(keepends=True)
    del lines[random.randrange(len(lines))]
    return b"".join(lines)


def lines_swapped(random, data):
    lines = data.splitlines(keepends=True)
    a, b = random.randrange(len(lines)), random.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]
    return b"".join(lines)


def word_replaced(random, data):
    found = [(match, group) for group in WORDS for word in group
             for match in re.finditer(re.escape(word), data)]
    if not found:
        return bits_flipped(random, data)
    match, group = random.choice(found)
    return data[:match.start()] + random.choice(group) + data[match.end():]


def tag_broken(random, data):
    """XML that is not well formed, or lacks an attribute or an element's end."""
    found = list(re.finditer(rb'</?\w+|/?>| \w+="[^"]*"|"', data))
    if not found:
        return part_removed(random, data)
    one = random.choice(found)
    broken = random.choice((b"", b"<", b"</Piece>", b">", b'"'))
    return data[:one.start()] + broken + data[one.end():]


def noise(random, data):
    return random.choice((b"", b"\0" * 1000,
                          bytes(random.randrange(256) for _ in range(random.randrange(3000))),
                          b"<?xml version='1.0'?>\n<VTKFile/>\n",
                          b"# vtk DataFile Version 5.1\n\nASCII\n", b"solid\nfacet\n",
                          b"ply\nformat ascii 1.0\nend_header\n", b"<a>" * 100000,
                          data[:random.randrange(len(data))] + b"\xff" * 500))


MUTATIONS = (truncated, truncated, bits_flipped, bits_flipped, bits_flipped, number_replaced,
             number_replaced, integer_replaced, part_removed, part_doubled, line_removed,
             lines_swapped, word_replaced, word_replaced, tag_broken, noise)


def broken(random, data):
    """`data` after one way to break it, seldom after several, and the names of these ways."""
    ways = random.choices(MUTATIONS, k=random.choice((1, 1, 1, 1, 1, 2, 3)))
    for way in ways:
        data = way(random, data) if data else data
    return data, "+".join(way.__name__ for way in ways)
