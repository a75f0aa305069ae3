# SPDX-License-Identifier: BSD-3-Clause
"""morph-mesh on shells and plane meshes in solvers' files: the coordinates move as those of the
same shell in the other formats, and no other byte changes.

Run: MORPH_MESH=<path of morph-mesh> python3 shell_files.py
"""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from solver_models import Coordinate, coordinates_in, text_of, value

PROGRAM = os.environ["MORPH_MESH"]
N = 4  # cells along a side
ROW = N + 1
LIFT = 0.125


def saddle(x, y):
    return (x, y, 0.3 * x * x - 0.2 * x * y + 0.1 * y)


def corners(cell):
    """Of a cell of the square, counted from 1."""
    a = cell // N * ROW + cell % N + 1
    return [a, a + ROW, a + ROW + 1, a + 1]


class Shell:
    """The saddle in quadrilaterals, whose last one is cut into two triangles; or all of them with
    nodes in the middle of their edges."""

    def __init__(self, place=saddle, quadratic=False):
        self.points = [place(i / N, j / N) for i in range(ROW) for j in range(ROW)]
        self.cells = [corners(c) for c in range(N * N)]
        if quadratic:
            middles = {}
            for nodes in self.cells:
                for a, b in zip(nodes[:4], nodes[1:4] + nodes[:1]):
                    key = min(a, b), max(a, b)
                    if key not in middles:
                        (x, y, _), (u, v, _) = self.points[a - 1], self.points[b - 1]
                        self.points.append(place((x + u) / 2, (y + v) / 2))
                        middles[key] = len(self.points)
                    nodes.append(middles[key])
        else:
            a, b, c, d = self.cells.pop()
            self.cells += [[a, b, c], [a, c, d]]

    def nodes(self, form, before=lambda n: f"{n}", between="", fixed=False, axes=3):
        """Pieces of a line for each node."""
        pieces = []
        for n, x in enumerate(self.points):
            pieces.append(before(n + 1))
            for axis in range(axes):
                pieces += [between, Coordinate.of(n, axis, form(x[axis]), fixed)]
            pieces.append("\n")
        return pieces

    def of_size(self, size):
        return [(e + 1, nodes) for e, nodes in enumerate(self.cells) if len(nodes) == size]


def lines(rows, separator=" "):
    return "".join(separator.join(map(str, row)) + "\n" for row in rows)


def abaqus(shell):
    kinds = {3: "S3", 4: "S4", 8: "S8R"}
    text = "".join(
        f"*ELEMENT, TYPE={kinds[size]}, ELSET=SKIN\n" +
        lines(([e, *nodes] for e, nodes in shell.of_size(size)), ", ")
        for size in kinds if shell.of_size(size))
    return ["** a shell\n*NODE, NSET=ALL\n", *shell.nodes(repr, "{}".format, ", "), text,
            "*SHELL SECTION, ELSET=SKIN, MATERIAL=STEEL\n 0.8, 5\n"]


def nastran(shell):
    cards = {3: "CTRIA3", 4: "CQUAD4"}
    rows = ([cards[len(nodes)], e + 1, 7, *nodes] for e, nodes in enumerate(shell.cells))
    return ["$ a shell\nBEGIN BULK\n", *shell.nodes(repr, "GRID,{},".format, ","),
            lines(rows, ","), "PSHELL,7,1,0.8\nENDDATA\n"]


def ls_dyna(shell):
    rows = ([e + 1, 7, *nodes, *nodes[-1:] * (4 - len(nodes))]
            for e, nodes in enumerate(shell.cells))
    return ["*KEYWORD\n*NODE\n", *shell.nodes("{:16.9e}".format, "{:8d}".format, fixed=True),
            "*ELEMENT_SHELL\n", "".join("".join(f"{v:8d}" for v in row) + "\n" for row in rows),
            "*PART\nskin\n7,1,1\n*END\n"]


def ansys(shell):
    count, cells = len(shell.points), len(shell.cells)
    rows = [[1, 1, 1, 1, 0, 0, 0, 0, 4, 0, e + 1, *nodes, *nodes[-1:] * (4 - len(nodes))]
            for e, nodes in enumerate(shell.cells)]
    return [f"/PREP7\nET,1,181\nNBLOCK,6,SOLID,{count},{count}\n(3i9,6e21.13e3)\n",
            *shell.nodes(lambda x: "{}E{:+04d}".format(*split(x)).rjust(21),
                         lambda n: f"{n:9d}{0:9d}{0:9d}", fixed=True),
            f"N,R5.3,LOC,       -1,\nEBLOCK,19,SOLID,{cells},{cells}\n(19i9)\n",
            "".join("".join(f"{v:9d}" for v in row) + "\n" for row in rows),
            f"{-1:9d}\nMPDATA,EX,1,1, 2.1E11\nFINISH\n"]


def split(x):
    mantissa, power = f"{x:.13E}".split("E")
    return mantissa, int(power)


def gmsh(shell):
    kinds = {3: 2, 4: 3}
    rows = [[e + 1, kinds[len(nodes)], 2, 5, 1, *nodes] for e, nodes in enumerate(shell.cells)]
    return ['$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 5 "skin"\n'
            f"$EndPhysicalNames\n$Nodes\n{len(shell.points)}\n",
            *shell.nodes(repr, "{}".format, " "),
            f"$EndNodes\n$Elements\n{len(rows)}\n{lines(rows)}$EndElements\n"]


def su2(shell):
    kinds = {3: 5, 4: 9}
    rows = [[kinds[len(nodes)], *(n - 1 for n in nodes), e] for e, nodes in enumerate(shell.cells)]
    return [f"NDIME= 2\nNELEM= {len(rows)}\n{lines(rows)}NPOIN= {len(shell.points)}\n",
            *shell.nodes(repr, lambda n: "", " ", axes=2),
            f"NMARK= 1\nMARKER_TAG= foil\nMARKER_ELEMS= {N}\n",
            lines([3, k, k + 1] for k in range(N))]


class ShellFiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def morphed(self, shell, writer, extension, move, by):
        """The moved points. All other bytes are those of the file."""
        pieces = writer(shell)
        path, out = self.folder / f"m{extension}", self.folder / f"out{extension}"
        path.write_bytes(text_of(pieces))
        result = subprocess.run([PROGRAM, "--move", move, "--translate", by, path, out],
                                capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, 0, result.stderr)
        found = coordinates_in(pieces, out.read_bytes())
        points = [list(x) for x in shell.points]
        for (node, axis), text in found.items():
            points[node][axis] = value(text)
        return points

    def check(self, shell, points, digits):
        """The edge x = 0 rises, the opposite one stays, and the rest is between."""
        rises = [q[2] - p[2] for p, q in zip(shell.points, points)]
        for (x, _, _), rise in zip(shell.points, rises):
            self.assertGreater(rise, -0.02)
            self.assertLess(rise, LIFT + 0.02)
            if x in (0, 1):
                self.assertAlmostEqual(rise, LIFT * (x == 0), digits)
        self.assertGreater(sum(0.02 < rise < LIFT - 0.02 for rise in rises), 4)
        return rises

    def test_shells_move_alike_in_all_formats(self):
        shell, expected = Shell(), None
        for writer, extension, digits in ((abaqus, ".inp", 12), (nastran, ".bdf", 5),
                                          (ls_dyna, ".k", 8), (ansys, ".cdb", 11),
                                          (gmsh, ".msh", 12)):
            with self.subTest(extension=extension):
                points = self.morphed(shell, writer, extension, "Surface 0", f"0,0,{LIFT}")
                rises = self.check(shell, points, digits)
                expected = expected or rises
                for rise, other in zip(rises, expected):
                    self.assertAlmostEqual(rise, other, digits - 1)

    def test_quadratic_shells_of_abaqus(self):
        shell = Shell(quadratic=True)
        points = self.morphed(shell, abaqus, ".inp", "Surface 0", f"0,0,{LIFT}")
        self.check(shell, points, 12)

    def test_plane_meshes_of_su2_have_two_coordinates(self):
        shell = Shell(lambda x, y: (x, y, 0.0))
        points = self.morphed(shell, su2, ".su2", "foil", "-0.125,0.0625,0")
        for k in range(ROW):  # the marker is the edge x = 0
            self.assertAlmostEqual(points[k][0], -0.125, 14)
            self.assertAlmostEqual(points[k][1], k / N + 0.0625, 14)
        self.assertEqual(points[-ROW:], [list(x) for x in shell.points[-ROW:]])
        self.assertTrue(all(-0.125 < q[0] - p[0] < 0 for p, q in
                            zip(shell.points[ROW:-ROW], points[ROW:-ROW])))


if __name__ == "__main__":
    unittest.main()
