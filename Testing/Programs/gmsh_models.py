# SPDX-License-Identifier: BSD-3-Clause
"""Gmsh's MSH files of versions 2.2 and 4.1, text and binary, of the models of solver_models."""
import struct

from solver_models import Coordinate, number_text

TYPES = {"tetra": 4, "hexahedron": 5, "wedge": 6}
NAMES = {(3, 1): "body", (2, 2): "wall", (2, 3): "inlet", (2, 4): "outlet"}


def elements_of(model):
    """(number, type, physical group, nodes) of volumes, then of the named faces."""
    rows = [(model.elements[c], TYPES[what], (3, 1), nodes)
            for c, (what, nodes) in enumerate(model.cells)]
    first = max(model.elements) + 1
    for tag, faces in ((2, model.wall), (3, model.inlet), (4, model.outlet)):
        for _, _, nodes in faces:
            rows.append((first, 2 if len(nodes) == 3 else 3, (2, tag), nodes))
            first += 1
    return rows


def names(end):
    return (f"$PhysicalNames{end}{len(NAMES)}{end}" +
            "".join(f'{d} {tag} "{name}"{end}' for (d, tag), name in NAMES.items()) +
            f"$EndPhysicalNames{end}")


def blocks_of(rows):
    """Rows in a row of the same type and group."""
    blocks = []
    for row in rows:
        if not blocks or blocks[-1][0][1:3] != row[1:3]:
            blocks.append([])
        blocks[-1].append(row)
    return blocks


def gmsh(model, rng, end="\n", version=None):
    """Pieces of a file of text."""
    version = version or rng.choice(("2.2", "4.1"))
    out = [f"$MeshFormat{end}{version} 0 8{end}$EndMeshFormat{end}",
           f"$Comments{end}$Nodes 1 2 3{end}$EndComments{end}", names(end)]
    style = rng.choice((None, "repr", "fixed", "exponent"))

    def place(node):
        for axis in range(3):
            text = number_text(rng, model.points[node][axis], style).strip()
            out.extend([" " if axis else "", Coordinate.of(node, axis, text)])

    rows = elements_of(model)
    if version == "2.2":
        out.append(f"$Nodes{end}{len(model.order)}{end}")
        for node in model.order:
            out.append(f"{model.numbers[node]} ")
            place(node)
            out.append(end)
        out.append(f"$EndNodes{end}$Elements{end}{len(rows)}{end}")
        for number, kind, (_, tag), nodes in rows:
            out.append(" ".join(map(str, [number, kind, 2, tag, tag] +
                                    [model.numbers[n] for n in nodes])) + end)
        out.append(f"$EndElements{end}$NodeData{end}1{end}\"$Nodes\"{end}$EndNodeData{end}")
        return out
    out.append(f"$Entities{end}0 0 3 1{end}" +
               "".join(f"{tag} 0 0 0 1 1 1 1 {tag} 0{end}" for tag in (2, 3, 4)) +
               f"1 0 0 0 1 1 1 1 1 3 2 3 4{end}$EndEntities{end}")
    half = len(model.order) // 2
    parts = ((2, 2, 1, model.order[:half]), (3, 1, 0, model.order[half:]))
    out.append(f"$Nodes{end}2 {len(model.order)} 1 {max(model.numbers)}{end}")
    for dimension, tag, parametric, nodes in parts:
        out.append(f"{dimension} {tag} {parametric} {len(nodes)}{end}" +
                   "".join(f"{model.numbers[n]}{end}" for n in nodes))
        for node in nodes:
            place(node)
            out.append((" 0.25 0.5" if parametric else "") + end)
    blocks = blocks_of(rows)
    out.append(f"$EndNodes{end}$Elements{end}{len(blocks)} {len(rows)} 1 9{end}")
    for block in blocks:
        _, kind, (dimension, tag), _ = block[0]
        out.append(f"{dimension} {tag} {kind} {len(block)}{end}")
        for number, _, _, nodes in block:
            out.append(" ".join(map(str, [number] + [model.numbers[n] for n in nodes])) + end)
    out.append(f"$EndElements{end}")
    return out


def gmsh_binary(model, version):
    """(content, {(node, axis): its first byte})."""
    out = bytearray(f"$MeshFormat\n{version} 1 8\n".encode() + struct.pack("<i", 1) +
                    b"\n$EndMeshFormat\n" + names("\n").encode())
    places = {}

    def place(node):
        for axis in range(3):
            places[node, axis] = len(out)
            out.extend(struct.pack("<d", model.points[node][axis]))

    rows = elements_of(model)
    if version == "2.2":
        out += f"$Nodes\n{len(model.order)}\n".encode()
        for node in model.order:
            out += struct.pack("<i", model.numbers[node])
            place(node)
        out += f"\n$EndNodes\n$Elements\n{len(rows)}\n".encode()
        for block in blocks_of(rows):
            _, kind, (_, tag), _ = block[0]
            out += struct.pack("<3i", kind, len(block), 2)
            for number, _, _, nodes in block:
                out += struct.pack(f"<{3 + len(nodes)}i", number, tag, tag,
                                   *(model.numbers[n] for n in nodes))
        out += b"\n$EndElements\n"
        return bytes(out), places
    out += b"$Entities\n" + struct.pack("<4Q", 0, 0, 3, 1)
    for tag in (2, 3, 4):
        out += struct.pack("<i6dQiQ", tag, 0, 0, 0, 1, 1, 1, 1, tag, 0)
    out += struct.pack("<i6dQiQ3i", 1, 0, 0, 0, 1, 1, 1, 1, 1, 3, 2, 3, 4) + b"\n$EndEntities\n"
    half = len(model.order) // 2
    out += b"$Nodes\n" + struct.pack("<4Q", 2, len(model.order), 1, max(model.numbers))
    for dimension, tag, parametric, nodes in ((2, 2, 1, model.order[:half]),
                                              (3, 1, 0, model.order[half:])):
        out += struct.pack("<3iQ", dimension, tag, parametric, len(nodes))
        out += struct.pack(f"<{len(nodes)}Q", *(model.numbers[n] for n in nodes))
        for node in nodes:
            place(node)
            out += struct.pack("<2d", 0.25, 0.5) if parametric else b""
    blocks = blocks_of(rows)
    out += b"\n$EndNodes\n$Elements\n" + struct.pack("<4Q", len(blocks), len(rows), 1, 9)
    for block in blocks:
        _, kind, (dimension, tag), _ = block[0]
        out += struct.pack("<3iQ", dimension, tag, kind, len(block))
        for number, _, _, nodes in block:
            out += struct.pack(f"<{1 + len(nodes)}Q", number, *(model.numbers[n] for n in nodes))
    out += b"\n$EndElements\n"
    return bytes(out), places
