# SPDX-License-Identifier: BSD-3-Clause
"""Meshes for the tests of solvers' files, and writers of them that know each coordinate's place.

A writer returns pieces: strings, and Coordinate. Its file is their text, one after another.
"""
import math
import random
import re
import struct

NUMBER = re.compile(rb"[ ]*[-+]?(\d+\.?\d*|\.\d+)([eEdD]?[-+]?\d+)?")


class Coordinate(str):
    """The text of a coordinate, with the blanks before it that belong to its field."""
    node = axis = 0
    fixed = False  # its field has this very width

    @staticmethod
    def of(node, axis, text, fixed=False):
        coordinate = Coordinate(text)
        coordinate.node, coordinate.axis, coordinate.fixed = node, axis, fixed
        return coordinate


def text_of(pieces):
    return "".join(pieces).encode()


def coordinates_in(pieces, content):
    """The coordinates {(node, axis): text} of a file whose other bytes are those of `pieces`.
    Raises ValueError where another byte differs."""
    found, at = {}, 0
    for i, piece in enumerate(pieces):
        if not isinstance(piece, Coordinate):
            if not content.startswith(piece.encode(), at):
                raise ValueError(f"byte {at}: {content[at:at + 60]!r} where the original has "
                                 f"{piece[:60]!r}")
            at += len(piece)
            continue
        if piece.fixed:
            end = at + len(piece)
        else:
            match = NUMBER.match(content, at)
            if not match:
                raise ValueError(f"byte {at}: {content[at:at + 40]!r} is no coordinate")
            end = match.end()
        found[piece.node, piece.axis] = content[at:end]
        at = end
    if at != len(content):
        raise ValueError(f"{len(content) - at} bytes more than the original has")
    return found


def value(text):
    """Of a number as any of the formats spells it."""
    text = text.decode().strip().lower().replace("d", "e")
    return float(re.sub(r"(?<=[\d.])([-+])(?=\d)", r"e\1", text)) if text else 0.0


class Model:
    """A bent pipe's sector of hexahedra, with some columns as wedges, or of tetrahedra.

    points: [[x, y, z]]; cells: [(kind, nodes)] in VTK's order of nodes; numbers: of each node;
    elements: of each cell. wall, inlet: boundary faces, as nodes."""

    def __init__(self, rng, kind="mixed", sizes=(3, 4, 5), scale=1.0):
        self.rng = rng
        r, t, z = sizes
        grid = {}
        self.points = []
        for k in range(z + 1):
            for j in range(t + 1):
                for i in range(r + 1):
                    grid[i, j, k] = len(self.points)
                    self.points.append([scale * c for c in self.place(i / r, j / t, k / z)])
        corner = lambda i, j, k, *c: [grid[i + a, j + b, k + d] for a, b, d in c]
        box = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
               (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
        self.cells = []
        for k in range(z):
            for j in range(t):
                for i in range(r):
                    nodes = corner(i, j, k, *box)
                    if kind == "tetrahedra":
                        self.cells += [("tetra", [nodes[0], nodes[a], nodes[b], nodes[6]])
                                       for a, b in ((1, 2), (2, 3), (3, 7), (7, 4), (4, 5), (5, 1))]
                    elif kind == "mixed" and (i + j) % 3 == 0:
                        a, b, c, d, e, f, g, h = nodes
                        self.cells += [("wedge", [a, b, c, e, f, g]), ("wedge", [a, c, d, e, g, h])]
                    else:
                        self.cells.append(("hexahedron", nodes))
        on = lambda nodes, which: all(which(n) for n in nodes)
        place = {n: ijk for ijk, n in grid.items()}
        faces = {"hexahedron": ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2),
                                (2, 6, 7, 3), (3, 7, 4, 0)),
                 "wedge": ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
                 "tetra": ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))}
        self.wall, self.inlet, self.outlet = [], [], []  # (cell, number of the face, nodes)
        for c, (what, nodes) in enumerate(self.cells):
            for number, face in enumerate(faces[what]):
                corners = [nodes[n] for n in face]
                if on(corners, lambda n: place[n][0] == r):
                    self.wall.append((c, number, corners))
                if on(corners, lambda n: place[n][2] == 0):
                    self.inlet.append((c, number, corners))
                if on(corners, lambda n: place[n][2] == z):
                    self.outlet.append((c, number, corners))
        self.wall_nodes = sorted({n for _, _, nodes in self.wall for n in nodes})
        self.numbers = rng.sample(range(1, 9 * len(self.points)), len(self.points))
        self.elements = rng.sample(range(1, 9 * len(self.cells)), len(self.cells))
        self.order = rng.sample(range(len(self.points)), len(self.points))

    @staticmethod
    def place(r, t, z):
        radius, angle, bend = 0.5 + 0.7 * r, 0.3 + 1.2 * t, 0.9 * z
        x, y = radius * math.cos(angle), radius * math.sin(angle)
        turn = 3 + x
        return turn * math.cos(bend), y, turn * math.sin(bend)


def number_text(rng, x, style=None):
    """A number in one of the spellings that users' files have."""
    style = style or rng.choice(("repr", "fixed", "exponent", "wide", "short"))
    if style == "repr":
        return repr(x)
    if style == "fixed":
        return f"{x:.6f}"
    if style == "exponent":
        return f"{x:.9{rng.choice('eE')}}"
    if style == "wide":
        return f"{x:18.10f}"
    return f"{x:.4g}" if "e" not in f"{x:.4g}" else f"{x:.4f}"


def abaqus(model, rng, end="\n", calculix=False):
    """Pieces of an input file, with all that users write into one; CalculiX takes no keyword that
    goes over two lines."""
    out = [f"** A model of the tests{end}*HEADING{end}Bent pipe, 1, 2, 3{end}"]
    half = len(model.order) // 2
    style = rng.choice((None, "repr", "fixed", "exponent", "wide"))
    second = "*Node, nset=NALL" if calculix else f"*Node,{end} nset = NALL"
    for part, keyword in ((model.order[:half], "*NODE, NSET=Nall"), (model.order[half:], second)):
        out.append(keyword + end)
        for node in part:
            if rng.random() < 0.05:
                out.append(f"** 1, 2.0, 3.0, 4.0{end}")
            out.append(f"{model.numbers[node]:{rng.choice(('', '8'))}d}")
            for axis in range(3):
                text = number_text(rng, model.points[node][axis], style)
                out += ["," + ("" if text.startswith(" ") else rng.choice(("", " "))),
                        Coordinate.of(node, axis, text)]
            out.append(rng.choice(("", ",", "  ")) + end)
    kinds = {"hexahedron": "C3D8", "wedge": "C3D6", "tetra": "C3D4"}
    for kind, name in kinds.items():
        lines = [(c, nodes) for c, (what, nodes) in enumerate(model.cells) if what == kind]
        if lines:
            out.append(f"*ELEMENT, TYPE={name}, ELSET=E{kind}{end}")
        for c, nodes in lines:
            fields = [str(model.elements[c])] + [str(model.numbers[n]) for n in nodes]
            cut = rng.choice((len(fields), 4))
            out.append(", ".join(fields[:cut]) +
                       ("," + end + ", ".join(fields[cut:]) if cut < len(fields) else "") + end)
    wall = [str(model.numbers[n]) for n in model.wall_nodes]
    out.append(f"*NSET, NSET=Wall{end}" + "".join(
        ", ".join(wall[i:i + 9]) + end for i in range(0, len(wall), 9)))
    out.append(f"*SURFACE, NAME=Inlet, TYPE=ELEMENT{end}" + "".join(
        f"{model.elements[c]}, S{number + 1}{end}" for c, number, _ in model.inlet))
    out.append(f"*NSET, NSET=Outlet{end}" + "".join(
        f"{model.numbers[n]}{end}" for n in sorted({n for _, _, f in model.outlet for n in f})))
    out.append(end.join(["*MATERIAL, NAME=Steel", "*ELASTIC", "210000., .3", "*DENSITY", "7.8E-9"]))
    for kind in dict.fromkeys(what for what, _ in model.cells):
        out.append(f"{end}*SOLID SECTION, ELSET=E{kind}, MATERIAL=Steel")
    out.append(end.join(["", "*BOUNDARY", "Outlet, 1, 3, 0.", "*STEP", "*STATIC", "*CLOAD",
                         f"{wall[0]}, 1, 12.5", "*NODE PRINT, NSET=Nall", "U", "*EL PRINT, "
                         "ELSET=E" + model.cells[-1][0] + ", TOTALS=ONLY", "EVOL",
                         "*NODE FILE", "U", "*END STEP", "", ""]))
    return out


def su2(model, rng, end="\n"):
    """Pieces of a mesh of SU2; its points are numbered in their order."""
    rank = {node: i for i, node in enumerate(model.order)}
    kinds = {"hexahedron": 12, "wedge": 13, "tetra": 10}
    out = [f"% A mesh of the tests{end}NDIME= 3{end}"]
    style = rng.choice((None, "repr", "fixed", "exponent", "wide"))

    def points():
        out.append(f"NPOIN={rng.choice(('', ' '))}{len(model.points)}{end}")
        for node in model.order:
            for axis in range(3):
                text = number_text(rng, model.points[node][axis], style)
                out.extend([rng.choice(("\t", " ")) if axis else rng.choice(("", " ")),
                            Coordinate.of(node, axis, text)])
            out.append(rng.choice((f" {rank[node]}", f"\t{rank[node]} % a point")) + end)
            if rng.random() < 0.05:
                out.append(rng.choice(("", "% 1 2 3", "  ")) + end)

    def cells():
        out.append(f"NELEM= {len(model.cells)}{end}")
        for i, (what, nodes) in enumerate(model.cells):
            out.append(" ".join(map(str, [kinds[what]] + [rank[n] for n in nodes] + [i])) + end)

    order = [points, cells]
    rng.shuffle(order)
    for write in order:
        write()
    out.append(f"NMARK= 3{end}")
    for name, faces in (("wall", model.wall), ("inlet", model.inlet), ("outlet", model.outlet)):
        out.append(f"MARKER_TAG= {name}{end}MARKER_ELEMS= {len(faces)}{end}")
        for _, _, nodes in faces:
            out.append(" ".join(map(str, [5 if len(nodes) == 3 else 9] +
                                    [rank[n] for n in nodes])) + end)
    return out


def nastran_number(x, width):
    """A number in a field, with a point and without the exponent's letter."""
    for digits in range(width, 0, -1):
        text = f"{x:.{digits}g}"
        text = text if "." in text or "e" in text else text + "."
        text = re.sub(r"e([-+])0*", r"\1", text)
        if len(text) <= width and "." in text:
            return text
    raise ValueError(f"{x} does not fit into {width} characters")


def nastran(model, rng, end="\n", only=None):
    """Pieces of a file of Nastran: all three forms of fields of GRID in one file, or one of them:
    small, large or free."""
    out = [f"$ A model of the tests{end}SOL 101{end}CEND{end}TITLE = GRID, 1{end}BEGIN BULK{end}"]
    for node in model.order:
        x, number = model.points[node], model.numbers[node]
        form = only or rng.choice(("small", "large", "free"))
        if rng.random() < 0.05:
            out.append(f"$GRID    1       2       3.0{end}")
        if form == "small":
            out.append(f"GRID    {number:<8d}{rng.choice((' ' * 8, '       0'))}")
            out += [Coordinate.of(node, axis, rng.choice((str.ljust, str.rjust))(
                nastran_number(x[axis], 8), 8), fixed=True) for axis in range(3)]
            out.append(rng.choice(("", "       0", " $ a comment")) + end)
        elif form == "large":
            fields = [Coordinate.of(node, axis, rng.choice((str.ljust, str.rjust))(
                nastran_number(x[axis], 16), 16), fixed=True) for axis in range(3)]
            out += [f"GRID*   {number:>16d}{'':16s}", *fields[:2], end, f"*       ", fields[2], end]
        else:
            out.append(rng.choice((f"GRID,{number},,", f"grid, {number}, 0,")))
            for axis in range(3):
                out += ["," if axis else "", Coordinate.of(node, axis, nastran_number(x[axis], 8))]
            out.append(rng.choice(("", ",,")) + end)
    kinds = {"hexahedron": "CHEXA", "wedge": "CPENTA", "tetra": "CTETRA"}
    shells = [(pid, nodes) for pid, faces in ((2, model.wall), (3, model.inlet), (4, model.outlet))
              for _, _, nodes in faces]
    first = max(model.elements) + 1
    elements = [(model.elements[c], kinds[what], 1, nodes)
                for c, (what, nodes) in enumerate(model.cells)]
    elements += [(first + i, "CTRIA3" if len(nodes) == 3 else "CQUAD4", pid, nodes)
                 for i, (pid, nodes) in enumerate(shells)]
    rng.shuffle(elements)
    for number, name, pid, nodes in elements:
        fields = [str(number), str(pid)] + [str(model.numbers[n]) for n in nodes]
        if rng.random() < 0.3:
            out.append(",".join([name] + fields[:8]) + end)
            if fields[8:]:
                out.append("," + ",".join(fields[8:]) + end)
            continue
        line = f"{name:8s}" + "".join(f"{f:>8s}" for f in fields[:8])
        out.append(line.rstrip() + end)
        if fields[8:]:
            out.append(rng.choice(("+       ", " " * 8)) +
                       "".join(f"{f:>8s}" for f in fields[8:]) + end)
    out.append(f"PSOLID         1       1{end}MAT1,1,2.1+11,,0.3{end}ENDDATA{end}GRID, 1, 2{end}")
    return out


FACES = {"hexahedron": ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6),
                        (3, 0, 4, 7)),
         "wedge": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
         "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))}  # outwards


def foam_header(kind, name, form="ascii", arch=""):
    return (f"/*--- C++ ---*\\\n|  a (comment) |\n\\*---*/\nFoamFile\n{{\n    version     2.0;\n"
            f"    format      {form};\n    class       {kind};\n{arch}"
            f"    location    \"constant/polyMesh\";\n    object      {name};\n}}\n// * * //\n\n")


class OpenFoam:
    """A case's constant/polyMesh: the pieces of its points, and the texts of its other files."""

    def __init__(self, model, rng, end="\n"):
        self.model = model
        rank = {node: i for i, node in enumerate(model.order)}
        sides = {}  # of each face, by its nodes: [(cell, nodes in order)]
        for c, (what, nodes) in enumerate(model.cells):
            for face in FACES[what]:
                corners = [nodes[n] for n in face]
                sides.setdefault(frozenset(corners), []).append((c, corners))
        inner = sorted((s for s in sides.values() if len(s) == 2),
                       key=lambda s: (s[0][0], s[1][0]))
        patches = {"wall": [], "inlet": [], "outlet": []}
        for name, faces in zip(patches, (model.wall, model.inlet, model.outlet)):
            patches[name] = [sides[frozenset(nodes)][0] for _, _, nodes in faces]
        named = {frozenset(side[1]) for faces in patches.values() for side in faces}
        patches["sides"] = [s[0] for key, s in sides.items() if len(s) == 1 and key not in named]
        self.faces = [[rank[n] for n in s[0][1]] for s in inner]
        self.owner = [s[0][0] for s in inner]
        self.neighbour = [s[1][0] for s in inner]
        self.boundary = [f"{len(patches)}\n(\n"]
        for name, faces in patches.items():
            self.boundary.append(f"    {name}\n    {{\n        type patch;\n        nFaces "
                                 f"{len(faces)};\n        startFace {len(self.faces)};\n    }}\n")
            self.faces += [[rank[n] for n in nodes] for _, nodes in faces]
            self.owner += [c for c, _ in faces]
        self.boundary = "".join(self.boundary + [")\n"])
        style = rng.choice((None, "repr", "fixed", "exponent"))
        self.pieces = [foam_header("vectorField", "points"), f"{len(model.order)}\n(\n"]
        for node in model.order:
            self.pieces.append("(")
            for axis in range(3):
                text = number_text(rng, model.points[node][axis], style).strip()
                self.pieces += [" " if axis else "", Coordinate.of(node, axis, text)]
            self.pieces.append(")\n")
        self.pieces.append(")\n\n\n// ** //\n")

    @staticmethod
    def labels(values):
        return f"{len(values)}\n(\n" + "\n".join(map(str, values)) + "\n)\n"

    def write(self, folder):
        """Text files, into constant/polyMesh of the case `folder`; returns the folder of points."""
        mesh = folder / "constant" / "polyMesh"
        mesh.mkdir(parents=True)
        faces = f"{len(self.faces)}\n(\n" + "".join(
            f"{len(f)}({' '.join(map(str, f))})\n" for f in self.faces) + ")\n"
        for name, kind, content in (
                ("faces", "faceList", faces), ("owner", "labelList", self.labels(self.owner)),
                ("neighbour", "labelList", self.labels(self.neighbour)),
                ("boundary", "polyBoundaryMesh", self.boundary)):
            (mesh / name).write_text(foam_header(kind, name) + content)
        (mesh / "points").write_bytes(text_of(self.pieces))
        return mesh

    def write_zones(self, mesh, cells, faces):
        """Into polyMesh: the zones `rotor` of cells and `disk` of faces, by their numbers."""
        zone = "{}\n{{\n    type {}Zone;\n{}Labels      List<label> \n{};\n{}}}\n".format
        # As binary files have an empty list.
        none = "nothing\n{{\n    type {0}Zone;\n{0}Labels      0;\n{1}}}\n".format
        flips = f"    flipMap         List<bool> {len(faces)}{{0}};\n"
        for kind, text in (("cell", zone("rotor", "cell", "cell", self.labels(cells), "")),
                           ("face", zone("disk", "face", "face", self.labels(faces), flips))):
            (mesh / f"{kind}Zones").write_text(
                foam_header("regIOobject", f"{kind}Zones") +
                f"2\n(\n{text}{none(kind, '    flipMap 0;' if kind == 'face' else '')})\n")

    def write_binary(self, folder, label=4, scalar=8):
        """As write(), but binary; returns the folder, and points before and after the numbers."""
        mesh = self.write(folder)
        form = {4: "i", 8: "q"}[label], {4: "f", 8: "d"}[scalar]
        arch = f'    arch        "LSB;label={8 * label};scalar={8 * scalar}";\n'
        head = lambda kind, name: foam_header(kind, name, "binary", arch).encode()
        pack = lambda code, values: struct.pack(f"<{len(values)}{code}", *values)
        labels = lambda v: f"{len(v)}\n(".encode() + pack(form[0], v) + b")\n"
        offsets = [0]
        for face in self.faces:
            offsets.append(offsets[-1] + len(face))
        (mesh / "faces").write_bytes(head("faceCompactList", "faces") + labels(offsets) +
                                     labels([n for f in self.faces for n in f]))
        (mesh / "owner").write_bytes(head("labelList", "owner") + labels(self.owner))
        (mesh / "neighbour").write_bytes(head("labelList", "neighbour") + labels(self.neighbour))
        before = head("vectorField", "points") + f"{len(self.model.order)}\n(".encode()
        values = pack(form[1], [x for n in self.model.order for x in self.model.points[n]])
        after = b")\n// end ( 1 2 3 )\n"
        (mesh / "points").write_bytes(before + values + after)
        return mesh, before, after


def random_model(seed, **options):
    rng = random.Random(seed)
    return Model(rng, **options), rng
