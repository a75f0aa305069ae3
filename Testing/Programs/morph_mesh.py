# SPDX-License-Identifier: BSD-3-Clause
"""morph-mesh, the command-line tool, run as a program: its files, its numbers, its messages and its
exit status.

Run: MORPH_MESH=<path of morph-mesh> MESHMORPHING_MODELS=<folder of the small models>
         python3 morph_mesh.py
"""
import json
import math
import os
import re
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["MORPH_MESH"]
MODELS = Path(os.environ["MESHMORPHING_MODELS"])
BORE = str(MODELS / "bore_hex_small.vtu")
METHODS = ("femwarp", "inversion-free", "lbwarp", "radial-basis", "simplex-linear",
           "simplex-natural-neighbor", "smoothing", "weighted-residual")


COMPLETION = Path(__file__).resolve().parents[2] / "Programs/MorphMesh/morph-mesh.bash"


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=120)


def row(output, label):
    """The numbers before and after in the report's row."""
    match = re.search(rf"^{label} +(\S+) +(\S+)$", output, re.MULTILINE)
    assert match, output
    return tuple(map(float, match.groups()))


class MorphMesh(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.boundary = self.folder / "boundary.vtp"
        # The models carry the displacement to their final shape; their boundary does too.
        self.assertEqual(run("extract", BORE, self.boundary).returncode, 0)

    def morph(self, *arguments, boundary=None, output="out.vtu"):
        return run(BORE, boundary or self.boundary, self.folder / output,
                   "--displacement-array", "FinalDisplacement", *arguments)

    def fails(self, status, message, *arguments):
        result = run(*arguments)
        self.assertEqual(result.returncode, status, result.stderr)
        self.assertIn(message, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertTrue(result.stderr.startswith("morph-mesh: "))

    def test_every_method_moves_the_bore_and_writes_what_it_measured(self):
        for method in METHODS:
            with self.subTest(method=method):
                result = self.morph("--method", method)
                self.assertEqual((result.returncode, result.stderr), (0, ""))
                before, after = row(result.stdout, "minimum scaled Jacobian")
                self.assertAlmostEqual(before, 0.8619, delta=1e-4)
                self.assertLess(after, before)
                # As another run reads the file: it measures on the undeformed mesh what the first
                # run measured on its result.
                again = run("extract", self.folder / "out.vtu",
                            self.folder / "again.vtp")
                self.assertEqual(again.returncode, 0, again.stderr)
                same = run(self.folder / "out.vtu", self.folder / "again.vtp",
                           self.folder / "same.vtk")
                for label in ("minimum scaled Jacobian", "mean scaled Jacobian", "inverted cells",
                              "worst cell"):
                    self.assertEqual(row(same.stdout, label), 2 * row(result.stdout, label)[1:])

    def test_surfaces_are_listed_and_moved(self):
        listed = run("--list-surfaces", BORE)
        self.assertEqual((listed.returncode, listed.stderr), (0, ""))
        rows = [line.split() for line in listed.stdout.splitlines()[1:]]
        self.assertEqual([" ".join(r[:2]) for r in rows],
                         [f"Surface {i}" for i in range(len(rows))])
        self.assertGreater(min(float(r[3]) for r in rows), 0)
        moved = self.folder / "moved.vtu"
        result = run("--move", "Surface 1", "--translate", "0,0,0.2", "--validity", "Repair", BORE,
                     moved)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(row(result.stdout, "inverted cells"), (0, 0))
        after = run("--list-surfaces", moved).stdout.splitlines()[2].split(None, 4)
        before = listed.stdout.splitlines()[2].split(None, 4)
        shift = [float(b) - float(a) for a, b in zip(before[4].split(","), after[4].split(","))]
        for found, wanted in zip(shift, (0, 0, 0.2)):
            self.assertAlmostEqual(found, wanted, delta=1e-4)
        self.fails(1, "Surface 99", "--move", "Surface 99", "--translate", "1,0,0", BORE, moved)
        for status, message, *arguments in (
                (2, "Nothing says how it moves", "--move", "Surface 1", BORE, moved),
                (2, "--translate needs <x,y,z>", "--move", "Surface 1", "--translate", "1,2", BORE,
                 moved),
                (2, "--rotate needs <x,y,z>", "--move", "Surface 1", "--rotate", "w,3", BORE,
                 moved),
                (2, "Nothing says what moves", "--translate", "1,2,3", BORE, moved),
                (2, "either --displacements", "--move", "Surface 1", "--displacements", "x.csv",
                 BORE, moved),
                (2, "remove one of them", "--move", "Surface 1", "--scale", "2", "--target",
                 "x.stl", BORE, moved),
                (2, "Nothing says what moves", "--free-surfaces", "Surface 1", BORE, moved),
                (2, "--scale needs Displacement Translate, rotate, scale, and --align", "--move",
                 "Surface 1", "--scale", "2", "--align",
                 BORE, moved),
                (2, "and --target-reach needs Displacement Target", "--move", "Surface 1",
                 "--scale", "2", "--target-reach", "1", BORE, moved),
                (2, "--target-angle needs a number from 0 to 180, not '200'", "--target", "x.stl",
                 "--target-angle", "200", BORE, moved),
                (2, "(grid, output; or grid, boundary, output), 1 is given", "--target", "x.stl",
                 BORE),
                (2, "1 file is needed (grid), 2 are given", "--list-surfaces", BORE, moved)):
            self.fails(status, message, *arguments)

    def test_a_motion_of_zero_is_a_motion(self):
        for motion in (("--translate", "0,0,0"), ("--rotate", "z,0"), ("--scale", "1"),
                       ("--scale", "1,1,1"), ("--radius", "0")):
            result = run("--quiet", "--move", "Surface 1", *motion, BORE, self.folder / "out.vtk")
            self.assertEqual((result.returncode, result.stderr), (0, ""), motion)
            points = [re.search(b"POINTS .*CELLS ", (self.folder / name).read_bytes(), re.S)[0]
                      for name in ("out.vtk", "rest.vtk")
                      if run(BORE, self.boundary, self.folder / "rest.vtk").returncode == 0]
            self.assertEqual(points[0], points[1], motion)
        self.fails(2, "remove one of them", "--move", "Surface 1", "--radius", "0",
                   "--scale", "1", BORE, self.folder / "out.vtk")

    def test_a_surface_turns_about_a_point(self):
        """Its center, as it is listed, against Rodrigues' formula; its area stays."""
        def surface(path):
            line = run("--list-surfaces", path).stdout.splitlines()[2]
            area, center = line.split(None, 4)[3:]
            return float(area), [float(x) for x in center.split(",")]

        def cross(a, b):
            return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]

        area, center = surface(BORE)
        about = (0.3, -0.2, 1)
        for number, axis in enumerate("xyz"):
            for degrees in (7, -12):
                out = self.folder / "turned.vtu"
                result = run("--move", "Surface 1", "--rotate", f"{axis},{degrees}", "--center",
                             ",".join(map(str, about)), "--validity", "none", BORE, out)
                self.assertEqual(result.returncode, 0, result.stderr)
                k = [float(i == number) for i in range(3)]
                angle = math.radians(degrees)
                v = [x - p for x, p in zip(center, about)]
                wanted = [p + math.cos(angle) * a + math.sin(angle) * b
                          + (1 - math.cos(angle)) * v[number] * c
                          for p, a, b, c in zip(about, v, cross(k, v), k)]
                turned_area, turned = surface(out)
                for found, expected in zip(turned, wanted):
                    self.assertAlmostEqual(found, expected, delta=1e-4)
                self.assertAlmostEqual(turned_area, area, delta=1e-4 * area)
                self.assertGreater(max(abs(a - b) for a, b in zip(turned, center)), 0.01)

    def test_steps_are_written_one_by_one(self):
        result = run("--move=Surface 1", "--translate=0,0,0.2", "--steps=2", BORE,
                     self.folder / "step.vtu")
        self.assertEqual(result.returncode, 0, result.stderr)
        last, half = (run("--move=Surface 1", f"--translate=0,0,{z}", BORE,
                          self.folder / "whole.vtu").stdout for z in (0.2, 0.1))
        both = result.stdout.split("minimum scaled Jacobian")
        self.assertIn(half.split("minimum scaled Jacobian")[1].split("\n")[0], both[1])
        self.assertIn(last.split("minimum scaled Jacobian")[1].split("\n")[0], both[2])
        self.assertTrue((self.folder / "step-1.vtu").exists())
        self.assertTrue((self.folder / "step-2.vtu").exists())
        self.assertFalse((self.folder / "step.vtu").exists())

    def test_displacements_of_nodes(self):
        nodes = self.folder / "nodes.csv"
        nodes.write_text("dx,id,dy,dz\n0.01,0,0,0\n0,1,0.01,0\n\n", encoding="utf-8")
        result = run("--displacements", nodes, BORE, self.folder / "out.vtu")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertLess(row(result.stdout, "mean scaled Jacobian")[1], 1)
        for text, message in (("id,dx,dy\n", "line 1: there is no column dz"),
                              ("id,dx,dy,dz\n0,1,2,x\n",
                               "line 2: 'x' is no finite number, in '0,1,2,x'"),
                              ("id,dx,dy,dz\n0,1,2\n", "line 2: '0,1,2' has 3 columns; the first"),
                              ("id,dx,dy,dz\n0,1,5,2,0\n", "line 2: '0,1,5,2,0' has 5 columns"),
                              ("id;dx;dy;dz\n0;1.234,5;2;0\n", "'1.234.5' is no finite number"),
                              ("id dx dy dz\n0 1 2 0\n", "no column id in 'id dx dy dz'"),
                              ("id,dx,dy,dz\n\n999999,1,2,3\n", "line 3: the grid has no node"),
                              ("id,dx,dy,dz\n0.5,1,2,3\n", "line 2: the grid has no node '0.5'"),
                              ("id,dx,dy,dz\n", "has no node that moves"),
                              ("", "Cannot read")):
            nodes.write_text(text, encoding="utf-8")
            self.fails(1, message, "--displacements", nodes, BORE, self.folder / "x.vtu")
        nodes.write_text("id,dx,dy,dz\n1,0,0,0\n", encoding="utf-8")
        self.fails(1, "has no node numbers", "--displacements", nodes, "--node-numbers", BORE,
                   self.folder / "x.vtu")

    def test_tables_as_spreadsheets_write_them(self):
        """Byte order mark, separators, decimal commas, empty lines and columns, large letters."""
        nodes, moved = self.folder / "nodes.csv", self.folder / "moved.vtk"
        results = set()
        for text in ("id,dx,dy,dz\n3,0.25,0,-1.5e-3\n7,0,0.125,0\n",
                     "\ufeffid,dx,dy,dz\r\n3,0.25,0,-1.5e-3,\r\n,,,\r\n7,0,0.125,0\r\n",
                     "ID;DX;DY;DZ\n3;0,25;0;-1,5e-3\n7;0;0,125;0\n",
                     "\ufeffid\tdx\tname\tdy\tdz\n3\t0,25\t\t0\t-1.5e-3\n7\t0\tx,y\t,125\t0\n",
                     '"id","dy","dz","dx"\n"3","0","-1.5e-3","0.25"\n"7","0.125","0","0"\n'):
            nodes.write_bytes(text.encode())
            result = run("--displacements", nodes, "--validity", "none", BORE, moved)
            self.assertEqual(result.returncode, 0, result.stderr)
            results.add(moved.read_bytes())
        self.assertEqual(len(results), 1)

    CORNERS = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]

    def numbered_cube(self, name, order=range(8), first=18, lift=0.0):
        """A cube whose corners have the numbers 18, 17, ... The points come in `order`; that of
        number 12 is lifted."""
        def values(kind, name, numbers, components=1):
            return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" '
                    f'format="ascii">{" ".join(map(str, numbers))}</DataArray>')

        order = list(order)
        corners = [(x, y, z + lift * (i == 6)) for i, (x, y, z) in enumerate(self.CORNERS)]
        grid = self.folder / name
        grid.write_text(
            '<VTKFile type="UnstructuredGrid" version="1.0"><UnstructuredGrid>'
            '<Piece NumberOfPoints="8" NumberOfCells="1"><PointData GlobalIds="GlobalNodeId">'
            + values("Int64", "GlobalNodeId", (first - i for i in order)) + "</PointData><Points>"
            + values("Float64", "Points", (x for i in order for x in corners[i]), 3)
            + "</Points><Cells>" + values("Int64", "connectivity", map(order.index, range(8)))
            + values("Int64", "offsets", [8]) + values("UInt8", "types", [12])
            + "</Cells></Piece></UnstructuredGrid></VTKFile>", encoding="utf-8")
        return grid

    def check_lifted(self, moved, lift):
        content = moved.read_bytes()
        start = content.index(b"\n", content.index(b"\nPOINTS 8 double") + 1) + 1
        found = struct.unpack(">24d", content[start:start + 24 * 8])
        for i, (x, y, z) in enumerate(self.CORNERS):
            self.assertEqual(found[3 * i:3 * i + 3], (x, y, z + lift * (i == 6)))

    def test_displacements_by_the_numbers_of_the_file(self):
        grid = self.numbered_cube("cube.vtu")
        nodes = self.folder / "nodes.csv"
        nodes.write_text("id,dx,dy,dz\n12,0,0,0.25\n", encoding="utf-8")
        moved = self.folder / "moved.vtk"
        result = run("--displacements", nodes, "--node-numbers", grid, moved)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.check_lifted(moved, 0.25)
        self.fails(1, "no node '12'", "--displacements", nodes, grid, moved)  # it has 0 to 7

    def test_a_copy_in_another_order_is_matched_by_its_numbers(self):
        grid, moved = self.numbered_cube("cube.vtu"), self.folder / "moved.vtk"
        result = run(grid, self.numbered_cube("same.vtu", lift=0.25), moved)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.check_lifted(moved, 0.25)
        copy = self.numbered_cube("copy.vtu", (3, 7, 1, 0, 6, 2, 5, 4), lift=0.5)
        result = run(grid, copy, moved)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("another order than those of the grid. They are matched by the array "
                      "GlobalNodeId, the outer nodes alone.", result.stderr)
        self.check_lifted(moved, 0.5)
        self.fails(1, "other node numbers, such as 21.", grid,
                   self.numbered_cube("other.vtu", first=21), moved)

    def test_a_chosen_surface_is_fitted_to_a_target(self):
        listed = run("--list-surfaces", BORE).stdout.splitlines()[1:]
        rows = [line.split(None, 4) for line in listed]
        heights = {" ".join(r[:2]): float(r[4].split(",")[2]) for r in rows}
        top = max(heights, key=heights.get)

        def lid(height):
            file = self.folder / f"lid{height}.stl"
            corners = [f"vertex {x} {y} {height}" for x, y in ((-9, -9), (9, -9), (9, 9), (-9, 9))]
            facets = [["facet normal 0 0 1", "outer loop", *(corners[i] for i in triangle),
                       "endloop", "endfacet"] for triangle in ((0, 1, 2), (0, 2, 3))]
            file.write_text("\n".join(["solid lid", *sum(facets, []), "endsolid lid", ""]),
                            encoding="utf-8")
            return file

        moved = self.folder / "moved.vtu"
        for options, height in (((), heights[top] + 0.3), (("--align",), 40)):
            with self.subTest(options=options):
                result = run("--move", top, "--target", lid(height), *options, "--require-valid",
                             BORE, moved)
                self.assertEqual(result.returncode, 0, result.stderr)
                distances = [tuple(map(float, found)) for found in re.findall(
                    r"distance from the target (?:before|after): maximum (\S+), mean (\S+)",
                    result.stdout)]
                self.assertEqual(len(distances), 2)
                shift = 0.3 if height < 40 else 0  # an aligned one lies on the surface itself
                for found in distances[0]:
                    self.assertAlmostEqual(found, shift, delta=1e-4)
                for found in distances[1]:
                    self.assertLess(found, 1e-5)
                after = run("--list-surfaces", moved).stdout.splitlines()[1:]
                center = [line.split(None, 4)[4] for line in after if line.startswith(top)]
                self.assertAlmostEqual(float(center[0].split(",")[2]), heights[top] + shift,
                                       delta=1e-3)
        self.fails(1, "no surface", "--target", BORE, BORE, moved)

    def test_a_free_surface_is_solved_with_the_interior(self):
        options = ("--move", "Surface 1", "--translate", "0,0,0.2", BORE, self.folder / "out.vtu")
        prescribed = []
        for free in ((), ("--free-surfaces", "Surface 0")):
            result = run(*free, *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            prescribed.append(int(re.search(r"(\d+) of them prescribed", result.stdout).group(1)))
        self.assertLess(prescribed[1], prescribed[0])
        self.fails(1, "in --move and --free-surfaces", "--free-surfaces", "Surface 1", *options)
        self.fails(1, "--free-surfaces names 'Wall'", "--free-surfaces", "Wall", *options)

    def test_what_slides_is_iterated_with_the_volume(self):
        options = ("--move", "Surface 1", "--translate", "0,0,0.2", BORE, self.folder / "out.vtu")
        result = run("--slide", "Surface 0", "--slide-rounds", "2", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"sliding: (None|round 1: moved by [0-9.e-]+ of the size)")
        self.fails(2, "--slide-rounds needs --slide", "--slide-rounds", "2", *options)
        self.fails(2, "from 0 to 20", "--slide", "Surface 0", "--slide-rounds", "21", *options)

    def test_surfaces_follow_by_the_surface_method(self):
        out = self.folder / "out.vtu"
        options = ("--move", "Surface 1", "--rotate", "z,20", "--scale", "1.1,0.9,1", BORE, out)
        written = []
        for method in ("WeightedResidual", "Smoothing", "MeshSmoothing"):
            result = run("--surface-method", method, *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            written.append(out.read_bytes())
        self.assertEqual(run(*options).returncode, 0)
        self.assertEqual(out.read_bytes(), written[0])
        self.assertNotEqual(written[0], written[1])
        self.fails(2, "not 'Best'", "--surface-method", "Best", *options)
        self.fails(2, "--surface-method has no effect", "--surface-method", "Smoothing",
                   "--displacements", "moved.csv", BORE, out)

    def test_zones_and_layers_are_prescribed(self):
        options = ("--move", "Surface 1", "--translate", "0,0,0.2", BORE, self.folder / "out.vtu")
        prescribed = []
        for more in ((), ("--fixed-zones", "GeometryDimension"),
                     ("--rigid-zones", "GeometryDimension"),
                     ("--keep-layers", "1")):
            result = run(*more, *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            prescribed.append(int(re.search(r"(\d+) of them prescribed", result.stdout).group(1)))
        self.assertGreater(prescribed[1], prescribed[0])  # all but vertices, inner nodes too
        self.assertEqual(prescribed[2], prescribed[1])
        self.assertGreater(prescribed[3], prescribed[0])
        self.fails(1, "The zone 'Bolt' is neither", "--fixed-zones", "Bolt", *options)
        self.fails(2, "--fixed-zones has no effect", "--fixed-zones",
                   "Bolt", BORE, self.boundary,
                   self.folder / "out.vtu")
        self.fails(2, "--keep-layers needs a whole number", "--keep-layers", "0.5", *options)

    def test_handles_and_lattices_move_what_they_reach(self):
        moved, bounds = self.folder / "moved.vtu", lambda path: [
            tuple(map(float, line.split(None, 4)[4].split(",")))
            for line in run("--list-surfaces", path).stdout.splitlines()[1:]]
        rest = bounds(BORE)
        handles, lattice = self.folder / "handles.csv", self.folder / "lattice.csv"
        handles.write_text("dz,x,y,z,dx,dy\n0.5,1,2,3,-1,0.25\n", encoding="utf-8")
        lattice.write_text("i,j,k,dx,dy,dz\n" + "".join(
            f"{i},{j},{k},-1,0.25,0.5\n" for i in (0, 1) for j in (0, 1) for k in (0, 1)),
            encoding="utf-8")
        for options in (("--handles", handles), ("--lattice", lattice, "--lattice-size", "2,2,2"),
                        ("--lattice", lattice, "--lattice-size=2,2,2", "--lattice-basis=b-spline",
                         "--lattice-position=-99,-99,-99", "--lattice-length=198,198,198",
                         "--lattice-rotation=9,9,9")):
            with self.subTest(options=options):  # everything is translated
                result = run(*options, BORE, moved)
                self.assertEqual((result.returncode, result.stderr), (0, ""))
                for before, after in zip(rest, bounds(moved)):
                    for b, a, by in zip(before, after, (-1, 0.25, 0.5)):
                        self.assertAlmostEqual(a, b + by, delta=1e-4)
        handles.write_text("x,y,z,dx,dy,dz,radius\n1e3,0,0,1,1,1,0.5\n", encoding="utf-8")
        self.assertEqual(run("--handles", handles, BORE, moved).returncode, 0)
        self.assertEqual(bounds(moved), rest)
        self.fails(1, "no column i", "--lattice", handles, BORE, moved)
        lattice.write_text("i,j,k,dx,dy,dz\n3,0,0,1,0,0\n", encoding="utf-8")
        self.fails(1, "no control point 3", "--lattice", lattice, BORE, moved)
        self.fails(2, "remove one of them", "--lattice", lattice, "--handles", handles, BORE, moved)
        self.fails(2, "remove one of them", "--lattice-basis=b-spline", "--handles", handles, BORE,
                   moved)
        self.fails(2, "from 2 to 30", "--lattice", lattice, "--lattice-size=1,2,2", BORE, moved)

    def test_the_boundary_is_fitted_to_a_target(self):
        # Its own boundary as target: nothing moves, beyond rounding.
        result = run("--target", self.boundary, BORE, self.folder / "out.vtu")
        self.assertEqual(result.returncode, 0, result.stderr)
        before, after = row(result.stdout, "minimum scaled Jacobian")
        self.assertAlmostEqual(before, after, delta=1e-6)
        self.fails(1, "x.stl", "--target", "x.stl", BORE, self.folder / "out.vtu")

    def test_method_names_are_found_however_they_are_written(self):
        texts = {self.morph("--method", name).stdout.split("prepared in")[0]
                 for name in ("WeightedResidual", "weighted-residual", "weighted_residual",
                              "WEIGHTED RESIDUAL")}
        self.assertEqual(len(texts), 1)

    def test_options_reach_the_method(self):
        fine, coarse = (self.morph(f"--tolerance={t}").stdout for t in (1e-12, 0.1))
        iterations = [int(re.search(r"(\d+) iterations", text).group(1)) for text in (fine, coarse)]
        self.assertGreater(iterations[0], iterations[1])
        half = row(self.morph("--scale-factor", "0.5").stdout, "minimum scaled Jacobian")
        none = row(self.morph("--scale-factor", "0").stdout, "minimum scaled Jacobian")
        self.assertEqual(none[0], none[1])
        self.assertLess(half[1], none[1])
        self.assertNotEqual(self.morph("--fix-unnamed-boundary=off").returncode, 2)

    def test_smoothing_afterwards_untangles_the_canister(self):
        canister = MODELS / "canister_tet_small.vtu"
        self.assertEqual(run("extract", canister, self.boundary).returncode, 0)
        options = (canister, self.boundary, self.folder / "out.vtu",
                   "--displacement-array=FinalDisplacement")
        options += ("--validity", "none")
        self.assertGreater(row(run(*options).stdout, "inverted cells")[1], 0)
        self.assertEqual(row(run(*options, "--post-smooth").stdout, "inverted cells")[1], 0)

    def test_formats(self):
        for written in ("boundary.vtk", "boundary.vtp"):
            self.assertEqual(run("extract", BORE, self.folder / written).returncode, 0)
            for output in ("out.vtu", "out.vtk"):
                result = self.morph(boundary=self.folder / written, output=output)
                self.assertEqual((result.returncode, result.stderr), (0, ""))
                self.assertGreater((self.folder / output).stat().st_size, 10000)

    def test_arrays_are_those_of_the_grid_unless_results_are_asked_for(self):
        names = lambda name: re.findall(r'Name="(\w+)"', (self.folder / name).read_text())
        grid = re.findall(r'Name="(\w+)"', Path(BORE).read_text(encoding="latin-1"))
        self.assertEqual(self.morph().returncode, 0)
        self.assertEqual(sorted(names("out.vtu")), sorted(grid))
        self.assertEqual(self.morph("--results", output="results.vtu").returncode, 0)
        self.assertIn("ScaledJacobian", set(names("results.vtu")) - set(grid))
        # Nothing but the arrays differs.
        parts = []
        for name in ("out.vtu", "results.vtu"):
            boundary = self.folder / "b.vtk"
            self.assertEqual(run("extract", self.folder / name, boundary).returncode, 0)
            content = boundary.read_bytes()
            parts.append(content[content.index(b"POINTS "):content.index(b"POLYGONS")])
        self.assertEqual(parts[0] == parts[1], True)

    def test_normals_are_left_out(self):
        name = self.folder / "bore.vtk"
        self.assertEqual(self.morph(output="bore.vtk").returncode, 0)
        content = name.read_bytes()
        count = int(re.search(rb"POINTS (\d+)", content)[1])
        normals = b"NORMALS Outward double\n" + struct.pack(">3d", 0, 0, 1) * count + b"\n"
        at = re.search(rb"POINT_DATA \d+\n", content).end()
        name.write_bytes(content[:at] + normals + content[at:])
        move = ("--move", "Surface 1", "--translate", "0,0,0.01", name)
        self.assertEqual(run(*move, self.folder / "moved.vtk").returncode, 0)
        self.assertIn(b"NORMALS", name.read_bytes())
        self.assertNotIn(b"NORMALS", (self.folder / "moved.vtk").read_bytes())

    def test_a_grid_of_another_program(self):
        # AVS UCD: a cube of eight hexahedra; ids from 1.
        nodes = [(x / 2, y / 2, z / 2) for z in range(3) for y in range(3) for x in range(3)]
        cells = [[first + corner for corner in (1, 2, 5, 4, 10, 11, 14, 13)]
                 for first in (0, 1, 3, 4, 9, 10, 12, 13)]
        lines = [f"{len(nodes)} {len(cells)} 0 0 0"]
        lines += [f"{i + 1} {x} {y} {z}" for i, (x, y, z) in enumerate(nodes)]
        lines += [f"{i + 1} 0 hex " + " ".join(map(str, cell)) for i, cell in enumerate(cells)]
        grid = self.folder / "cube.inp"
        grid.write_text("\n".join(lines) + "\n")
        result = run("extract", grid, self.folder / "cube.vtp")
        self.assertEqual((result.returncode, result.stdout, result.stderr),
                         (0, "26 points, 24 faces\n", ""))
        result = run(grid, self.folder / "cube.vtp", self.folder / "cube.vtu")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(row(result.stdout, "minimum scaled Jacobian"), (1, 1))

    def test_threads_do_not_show_in_the_file(self):
        files = []
        for threads in (1, 2, 3):
            name = f"out{threads}.vtk"
            self.assertEqual(self.morph("--threads", threads, output=name).returncode, 0)
            content = (self.folder / name).read_bytes()
            # Field data hold the seconds it took.
            files.append(content[content.index(b"\nPOINTS "):content.index(b"\nCELLS ")])
        self.assertEqual(files[0], files[1])
        self.assertEqual(files[0], files[2])

    def test_inverted_cells_give_a_status_of_their_own(self):
        asked = ("--scale-factor", "-5", "--validity", "report")
        result = self.morph(*asked, "--require-valid")
        self.assertGreater(row(result.stdout, "inverted cells")[1], 0)
        self.assertEqual(result.returncode, 3)
        self.assertTrue((self.folder / "out.vtu").exists())
        self.assertEqual(self.morph(*asked).returncode, 0)
        self.assertEqual(self.morph("--require-valid").returncode, 0)

    def test_criteria_are_reported_before_and_after(self):
        result = self.morph("--criteria", "NonOrthogonality=20, Skewness")
        self.assertEqual(result.returncode, 0, result.stderr)
        before, after = row(result.stdout, "NonOrthogonality")
        self.assertLess(before, after)
        self.assertLess(*row(result.stdout, "  cells beyond 20"))
        self.assertEqual(row(result.stdout, "  cells beyond 0.95"), (0, 0))
        (self.folder / "out.vtu").unlink()
        wrong = self.morph("--criteria", "Orthogonality")
        self.assertEqual(wrong.returncode, 1)
        self.assertIn("'Orthogonality' is not a criterion", wrong.stderr)
        self.assertFalse((self.folder / "out.vtu").exists())

    def test_the_report_holds_what_is_printed(self):
        result = run("--move", "Surface 1", "--translate", "0,0,0.2", "--criteria", "Skewness",
                     "--report", self.folder / "report.json", BORE, self.folder / "out.vtu")
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads((self.folder / "report.json").read_text())
        self.assertEqual(report["status"], "Valid")
        self.assertEqual([f"morph-mesh: warning: {said}" for said in report["messages"]],
                         result.stderr.splitlines())
        self.assertEqual(report["part of the motion reached"], 1)
        for label in ("minimum scaled Jacobian", "mean scaled Jacobian", "inverted cells",
                      "worst cell"):
            for side, printed in zip(("before", "after"), row(result.stdout, label)):
                self.assertAlmostEqual(report[side][label], printed, delta=5e-5)
        self.assertGreater(report["after"]["Skewness"]["worst"], 0)

    def test_the_report_holds_the_gaps_of_bodies_in_contact(self):
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]  # of two cubes, one above the other
        nodes = [(x, y, z) for z in (0, 1, 1.05, 2.05) for x, y in corners]
        deck, name = self.folder / "two.inp", self.folder / "report.json"
        deck.write_text("*NODE\n" + "\n".join(
            f"{n}, {x}, {y}, {z}" for n, (x, y, z) in enumerate(nodes, 1)) + """
*ELEMENT, TYPE=C3D8
1, 1, 2, 3, 4, 5, 6, 7, 8
2, 9, 10, 11, 12, 13, 14, 15, 16
*NSET, NSET=TOP
5, 6, 7, 8
""")
        result = run("--move", "TOP", "--translate", "0,0,0.2", "--contact-distance", "0.1",
                     "--report", name, deck, self.folder / "out.inp")
        self.assertEqual(result.returncode, 0, result.stderr)
        gaps = json.loads(name.read_text())["gaps in contact"]
        for i, label in enumerate(("least gap in contact", "largest gap in contact")):
            for side, printed in zip(("before", "after"), row(result.stdout, label)):
                self.assertAlmostEqual(printed, 0.05)
                self.assertAlmostEqual(gaps[side][i], 0.05)

    def test_each_command_takes_its_own_options_alone(self):
        out = self.folder / "out.vtp"
        for command, files in (("list", [BORE]), ("check", [BORE]), ("extract", [BORE, out]),
                               ("repair", [BORE, self.folder / "out.vtu"])):
            self.fails(2, f"These have no effect with {command}: --move, --translate, --steps.",
                       command, "--move", "Surface 1", "--translate", "0,0,0.2", "--steps", "2",
                       *files)
            self.fails(2, f"with {command}: --target.", command, "--target", out, *files)
        self.fails(2, "with check: --report.", "check", "--report", "x.json", BORE)
        self.assertFalse(out.exists())

    def test_names_fold_case(self):
        """Of surfaces and zones, as of methods; the result names the file and its status."""
        folded, out = self.folder / "folded.vtu", self.folder / "out.vtu"
        options = ("--translate", "0,0,0.1", BORE)
        result = run("--move", "SURFACE 1", "--fix", "surface 2", *options, folded)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.splitlines()[-1], f"{folded}: Valid")
        exact = run("--move", "Surface 1", "--fix", "Surface 2", *options, out)
        self.assertEqual(exact.returncode, 0, exact.stderr)
        self.assertEqual(folded.read_bytes(), out.read_bytes())
        zone = run("--fixed-zones", "clamp", "--move", "Surface 1", "--distance", "0.1",
                   self.marked(), folded)
        self.assertEqual(zone.returncode, 0, zone.stderr)

    def test_contradictions_are_errors(self):
        files = (BORE, self.folder / "out.vtu")
        move = ("--move", "Surface 1", "--translate", "0,0,0.1")
        self.fails(1, "'Surface 1' is in --move and --fix", *move, "--fix", "surface 1", *files)
        self.fails(1, "is in --slide and --free-surfaces", *move, "--slide", "Surface 2",
                   "--free-surfaces", "Surface 2", *files)
        self.fails(2, "says '0,0,0.1', and --translate says", *move, "--translate", "1,0,0", *files)
        self.fails(2, "--center has no effect", *move, "--center", "1,0,0", *files)
        self.fails(2, "--move needs a value", "--move", "--radius", "0.1", *files)
        for scale in ("0", "1,0,1"):
            self.fails(2, "--scale 0 makes what moves flat", "--move", "Surface 1", "--scale",
                       scale, "--validity", "report", *files)
        self.assertFalse(files[1].exists())

    def test_files_that_are_no_mesh_are_told_apart(self):
        for name in ("part.msh", "part.bdf", "part.vtu"):
            file = self.folder / name
            self.fails(1, "there is no such file", "list", file)
            file.write_text("")
            self.fails(1, "it is empty", "list", file)
            file.write_text("hello")
            self.fails(1, f"it does not begin as a {file.suffix} file does", "list", file)
        self.fails(1, "the folder has no mesh of OpenFOAM", "list", self.folder)
        table = self.folder / "nodes.csv"
        self.fails(1, "there is no such file", "--displacements", table, BORE, "out.vtu")
        table.write_text("")
        self.fails(1, "the table is empty", "--displacements", table, BORE, "out.vtu")

    def test_no_file_of_a_run_takes_the_place_of_another(self):
        grid, out = self.folder / "part.vtu", self.folder / "out.vtu"
        original = Path(BORE).read_bytes()
        grid.write_bytes(original)
        same = f"{self.folder}/../{self.folder.name}/out.vtu"
        move = ("--move", "Surface 1", "--translate", "0,0,0.2", grid)
        self.fails(2, "--report would replace the grid", "--report", grid, *move, out)
        self.fails(2, "--report would replace the output", "--report", same, *move, out)
        self.fails(2, "The output would replace the grid", "extract", grid, grid)
        self.assertEqual(grid.read_bytes(), original)
        (self.folder / "empty").mkdir()
        self.fails(1, "Cannot write the report", "--report", self.folder / "empty", *move, out)
        self.assertTrue((self.folder / "empty").is_dir())
        self.assertFalse(out.exists())

    def test_a_motion_that_cannot_be_completed_is_written_as_far_as_it_goes(self):
        canister = MODELS / "canister_tet_small.vtu"
        self.assertEqual(run("extract", canister, self.boundary).returncode, 0)
        result = run(canister, self.boundary, self.folder / "out.vtu", "--validity", "sub-step",
                     "--displacement-array=FinalDisplacement", "--maximum-sub-steps", "2",
                     "--report", self.folder / "report.json")
        self.assertEqual(result.returncode, 3, result.stderr)
        report = json.loads((self.folder / "report.json").read_text())
        self.assertEqual(report["status"], "Partial")
        self.assertTrue(0 < report["part of the motion reached"] < 1)
        self.assertEqual(report["after"]["inverted cells"], 0)
        self.assertIn(report["messages"][-1], result.stderr)

    def test_validity(self):
        reported = self.morph("--scale-factor", "-5", "--validity=report")
        self.assertIn("warning", reported.stderr)
        silent = self.morph("--scale-factor", "-5", "--validity=none")
        self.assertEqual((silent.returncode, silent.stderr), (0, ""))
        os.remove(self.folder / "out.vtu")
        refused = self.morph("--scale-factor", "-5", "--validity=refuse")
        self.assertEqual(refused.returncode, 1, refused.stderr)
        self.assertFalse((self.folder / "out.vtu").exists())

    def test_progress_and_quiet(self):
        result = self.morph("--progress")
        self.assertIn("100%", result.stderr)
        self.assertIn("#", result.stderr)
        result = self.morph("--quiet")
        self.assertEqual((result.stdout, result.stderr), ("", ""))

    def test_help_and_version(self):
        result = run("--help")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        shown = "-".join(result.stdout.lower().split())
        for expected in METHODS + ("exit-status", "-o,---output", ".vtu"):
            self.assertIn(expected, shown)
        self.assertLess(max(map(len, result.stdout.splitlines())), 121)
        result = run("--version")
        self.assertRegex(result.stdout, r"^morph-mesh \d+\.\d+\.\d+, VTK \d+\.\d+\.\d+\n$")
        self.assertEqual(result.returncode, 0)

    def test_commands(self):
        surfaces = run("list", BORE)
        self.assertEqual(surfaces.stdout, run("--list-surfaces", BORE).stdout)
        moved = self.folder / "moved.vtu"
        options = ("--move", "Surface 1", "--translate", "z,0.1", BORE)
        first = run("move", *options, "-o", moved, "-q")
        self.assertEqual((first.returncode, first.stdout), (0, ""), first.stderr)
        flat = self.folder / "flat.vtu"
        self.assertEqual(run(*options, flat, "--quiet").returncode, 0)
        self.assertEqual(moved.read_bytes(), flat.read_bytes())
        shown = run("check", "--criteria", "Skewness", moved)
        self.assertEqual(shown.returncode, 0)
        self.assertIn("minimum scaled Jacobian", shown.stdout)
        self.assertIn("Skewness", shown.stdout)
        self.fails(2, "fit needs --target", "fit", *options, flat)
        self.fails(2, "bake needs --displacement-array", "bake", BORE, flat)
        self.fails(2, "2 files are needed (grid, output), 3 are given", "bake",
                   "--displacement-array", "U", BORE, BORE, flat)
        for command in ("move", "fit", "bake", "list", "check", "repair", "extract", "shapes"):
            page = run(command, "-h").stdout
            self.assertEqual(page.count("\n  morph-mesh " + command), 3, page)
            self.assertLess(len(page.splitlines()), 50)
            self.assertIn(f"  {command} ", run("--help").stdout)
        self.assertEqual(run("-V").stdout, run("--version").stdout)
        self.fails(2, "Did you mean --translate?", *options, flat, "--tranlsate", "1,0,0")
        self.fails(2, "no file lst. Did you mean list?", "lst", BORE)
        self.fails(2, "Did you mean FEMWARP?", *options, flat, "--method", "femwrap")
        self.fails(1, "names 'Surfce 1', which the mesh does not have; it has Surface 0, Surface 1",
                   "--move", "Surfce 1", "--translate", "0,0,1", BORE, flat)
        self.fails(1, "Did you mean Surface 1?",
                   "--move", "Surfce 1", "--translate", "0,0,1", BORE, flat)
        self.fails(1, "'Surface 99', which the boundary does not have; it has Surface 0", "--move",
                   "Surface 99", "--translate", "0,0,1", BORE, flat)
        self.fails(2, "The commands are move, fit, bake, list")
        self.fails(2, "no file convert-boundary. The commands are move", "convert-boundary", BORE,
                   flat)
        self.fails(2, "Try morph-mesh list --help.", "list")
        self.fails(2, "Try morph-mesh --help.", BORE)

    def test_repair_and_check(self):
        """A cell that was inverted before is mended; the boundary stays."""
        tangled, mended = self.folder / "tangled.vtu", self.folder / "mended.vtu"
        for way, status in (("0.9,0,0", 0), ("2.5,0,0", 1)):  # the second folds the boundary
            moved = run("--move", "Surface 1", "--translate", way, "--validity", "none", BORE,
                        tangled)
            self.assertEqual(moved.returncode, 0, moved.stderr)
            self.assertEqual(run("check", "--require-valid", tangled).returncode, 3)
            self.assertEqual(run("repair", tangled, mended).returncode, status)
            self.assertEqual(run("check", "--require-valid", mended).returncode, 0)
        self.fails(1, "The boundary itself inverts", "repair", tangled, mended)

    def marked(self):
        """A tetrahedron, two of whose nodes are the zone Clamp."""
        grid = self.folder / "marked.vtk"
        grid.write_text("# vtk DataFile Version 3.0\nmarks\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                        "POINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\n"
                        "CELL_TYPES 1\n10\nPOINT_DATA 4\nSCALARS Clamp int\n"
                        "LOOKUP_TABLE default\n1 0 1 0\n")
        return grid

    def test_bash_completes_commands_options_and_surfaces(self):
        def completed(*words):
            script = (f"source {COMPLETION}; COMP_WORDS=({PROGRAM} {' '.join(words)});"
                      f"COMP_CWORD={len(words)}; _morph_mesh;"
                      "printf '%s\\n' \"${COMPREPLY[@]}\"")
            return subprocess.run(["bash", "-c", script], capture_output=True, text=True,
                                  check=True).stdout.splitlines()

        self.assertIn("--translate", completed("--tr"))
        self.assertIn("Surface\\ 1", completed(str(BORE), "--move", "Surf"))
        self.assertEqual(["Clamp"], completed(str(self.marked()), "--fixed-zones", "C"))

    def test_output_that_cannot_be_written_fails(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            result = subprocess.run([PROGRAM, "list", BORE], stdout=full, check=False,
                                    stderr=subprocess.PIPE, text=True)
        self.assertEqual(result.returncode, 1)
        self.assertIn("Cannot write to the standard output", result.stderr)

    def test_wrong_command_lines(self):
        files = (BORE, self.boundary, self.folder / "out.vtu")
        self.fails(2, "2 or 3 files are needed", BORE)
        self.fails(2, "no option --bogus", *files, "--bogus")
        self.fails(2, "--method needs a value", *files, "--method")
        self.fails(2, "takes no value", *files, "--quiet=1")
        self.fails(2, "not 'Magic'", *files, "--method", "Magic")
        self.fails(2, "no option --color", *files, "--color", "red")
        self.fails(2, "--tolerance needs a number", *files, "--tolerance", "high")
        self.fails(2, "--kernel has no effect with FEMWARP", *files, "--kernel", "thin-plate")
        self.fails(2, "one of Error, Relax", *files, "--method=LBWARP",
                   "--outside-hull", "Maybe")
        self.fails(2, "--validity is one of", *files, "--validity", "Pray")
        for wrong in ("1x", "nan", "inf", "0x10"):
            self.fails(2, "--scale-factor needs a number", *files, "--scale-factor", wrong)
        self.fails(2, "--translate needs <x,y,z>", *files, "--translate", "1,2,3,")
        self.fails(2, "--threads needs a whole number", *files, "--threads", "-1")
        self.assertFalse((self.folder / "out.vtu").exists())

    def test_files_that_cannot_be_used(self):
        output = self.folder / "out.vtu"
        self.fails(1, "there is no such file", self.folder / "none.vtu", self.boundary, output)
        self.fails(1, "extension", __file__, self.boundary, output)
        self.fails(1, "written as .vtu or .vtk", BORE, self.boundary, self.folder / "out.stl")
        self.fails(1, "written as .vtp or .vtk", "extract", BORE,
                   self.folder / "out.stl")
        self.fails(1, "unstructured grid is needed", self.boundary, self.boundary, output)
        self.fails(1, "Cannot write", BORE, self.boundary, self.folder / "none" / "out.vtu")
        self.fails(1, "Nothing says which nodes", BORE, MODELS / "bore_tet_small.vtu", output)
        self.assertFalse(output.exists())

    def refuse(self, name, content, message):
        """`content` as the moved boundary gives one message, and no mesh."""
        file = self.folder / name
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
        result = run(BORE, file, self.folder / "out.vtu")
        self.assertEqual((result.returncode, result.stderr.count("\n")), (1, 1), result.stderr)
        self.assertRegex(result.stderr, f"^morph-mesh: Cannot read {file}: {message}")
        self.assertFalse((self.folder / "out.vtu").exists())

    def test_files_of_another_format_are_told_apart(self):
        page = "<html><body>" + "There is no such page. " * 10 + "</body></html>"
        for extension in ("vtu", "vtp", "vts", "vti", "vtr", "pvtp", "vtk", "stl", "ply", "obj",
                          "inp", "neu", "exo"):
            with self.subTest(extension=extension):
                self.refuse(f"other.{extension}", page,
                            f"it does not begin as a .{extension} file does")

    def test_damaged_files_are_told_apart(self):
        vtu = Path(BORE).read_text()
        neutral = ("        CONTROL INFO 1.3.0\n** GAMBIT NEUTRAL FILE\ncube\nPROGRAM: Gambit\n"
                   "January 2000\n"
                   "     NUMNP     NELEM     NGRPS    NBSETS     NDFCD     NDFVL\n"
                   "{} {} {} {} 3 3\nENDOFSECTION\n"
                   "   NODAL COORDINATES 1.3.0\n1 0 0 0\nENDOFSECTION\n"
                   "      ELEMENTS/CELLS 1.3.0\nENDOFSECTION\n")
        points = "# vtk DataFile Version 4.2\n\n{}\nDATASET POLYDATA\nPOINTS {} {}\n"
        ply = ("ply\nformat {} 1.0\nelement vertex {}\n"
               "property float x\nproperty float y\nproperty float z\n"
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0")
        stl = b"\0" * 80 + struct.pack("<I", 3) + b"\0" * 100
        more = "the file is damaged: its header asks for more than its"
        for name, content, message in (
                ("empty.vtu", "", "the file is damaged: it is empty"),
                ("cut.vtu", vtu[:2000], "the file is damaged: it ends before </VTKFile>"),
                ("count.vtu", re.sub('NumberOfCells="', r"\g<0>4294967296", vtu, 1), more),
                ("version.vtk", "# vtk DataFile Version 1e-320\n", ".* it has no version"),
                ("text.vtk", points.format("ASCII", 10**15, "double"), more),
                ("binary.vtk", points.format("BINARY", 30, "double"), more),
                ("negative.vtk", points.format("ASCII", -1, "float"), more),
                ("cut.stl", "solid a\nfacet normal 0 0 1\n", ".* it ends before endsolid"),
                ("binary.stl", stl, more),
                ("cut.ply", "ply\nformat ascii 1.0\n", ".* its header has no end"),
                ("text.ply", ply.format("ascii", 8), more),
                ("binary.ply", ply.format("binary_little_endian", 8), more),
                ("many.ply", ply.format("ascii", "1e39"), more),
                ("word.ply", ply.format("ascii", 8).replace("element ", "", 1),
                 ".* its header has a line that PLY does not know"),
                ("type.ply", ply.format("ascii", 8).replace("float y", "face y", 1),
                 ".* its header has a line that PLY does not know"),
                ("many.inp", "2000000000 1 0 0 0\n1 0 0 0\n", more),
                ("many.neu", neutral.format(2000000000, 0, 0, 0), more),
                ("sets.neu", neutral.format(1, 0, 0, 2000000000), more),
                ("deep.vtu", "<VTKFile>" + "<a>" * 100 + "</VTKFile>",
                 "the file is damaged, or not what its extension says: ")):
            with self.subTest(name=name):
                self.refuse(name, content, message)


if __name__ == "__main__":
    unittest.main()
