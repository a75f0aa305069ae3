# SPDX-License-Identifier: BSD-3-Clause
"""Reads the legacy files of VTK (.vtk) that morph-mesh writes, without VTK."""
import re
import struct


def numbers(content, head, code, factor=1):
    """Those after the line that starts with `head` and has their count, times `factor`."""
    at = content.index(head)
    count = factor * int(content[at:].split()[1])
    return struct.unpack_from(f">{count}{code}", content, content.index(b"\n", at) + 1)


def points_of(path):
    """The points, three numbers each."""
    return numbers(path.read_bytes(), b"POINTS ", "d", 3)


def types_of(path):
    """VTK's types of the cells."""
    return numbers(path.read_bytes(), b"CELL_TYPES", "i")


def cells_of(path):
    """The cells: (VTK's type, nodes)."""
    content = path.read_bytes()
    head = re.search(rb"\nCELLS (\d+) (\d+)\nOFFSETS vtktypeint64\n", content)
    count, length = int(head[1]), int(head[2])
    offsets = struct.unpack_from(f">{count}q", content, head.end())
    start = content.index(b"CONNECTIVITY vtktypeint64\n", head.end()) + 26
    nodes = struct.unpack_from(f">{length}q", content, start)
    return [(t, nodes[a:b]) for t, a, b in zip(types_of(path), offsets, offsets[1:])]
