# SPDX-License-Identifier: BSD-3-Clause
"""morph-mesh on solvers' own files: what it writes is the original with other coordinates, and with
no other byte changed. Random models, node numbers, spellings and line ends.

Run: MORPH_MESH=<path of morph-mesh> python3 solver_files.py
MORPH_TEST_SEED sets another first seed; MORPH_TEST_CASES the number of random cases a format.
Readers and solvers of others are used where they are installed, and skipped by name elsewhere:
meshio (python3-meshio), CalculiX (calculix-ccx). OpenFOAM is in openfoam_files.py.
"""
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import gmsh_models
import solver_models as models
from legacy_files import points_of

try:
    import meshio
    import numpy as np
except ImportError:
    meshio = None

PROGRAM = os.environ["MORPH_MESH"]
SEED = int(os.environ.get("MORPH_TEST_SEED", "1"))
CASES = int(os.environ.get("MORPH_TEST_CASES", "6"))
WRITERS = {".inp": models.abaqus, ".su2": models.su2, ".bdf": models.nastran,
           ".msh": gmsh_models.gmsh}
WALL = {".inp": "Wall", ".su2": "wall", ".bdf": "PID 2", ".msh": "wall"}
# CalculiX reads 20 characters of a number, and a small field of Nastran has 8.
ROUNDING = {".inp": 1e-16, ".su2": 1e-300, ".bdf": 1e-6, ".msh": 1e-300}
needs_meshio = unittest.skipUnless(meshio, "meshio is not installed (python3-meshio)")


def run(*arguments, **options):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=120, **options)


class SolverFiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, extension, seed=SEED, name="model", end="\n", writing={}, **options):
        """A random model in a file: model, pieces of the file, path."""
        model, rng = models.random_model(f"{extension} {seed}", **options)
        pieces = WRITERS[extension](model, rng, end, **writing)
        path = self.folder / (name + extension)
        path.write_bytes(models.text_of(pieces))
        return model, pieces, path

    def morph(self, path, out, *arguments):
        arguments = arguments or ("--move", WALL[path.suffix], "--translate", "0.05,0.02,-0.03")
        result = run(*arguments, path, out)
        self.assertEqual(result.returncode, 0, result.stderr)
        for line in result.stderr.splitlines():  # of the motion, not of the file
            self.assertRegex(line, "^morph-mesh: warning: (Surfaces beside|The motion|Quality)")
        return result.stdout

    def refuse(self, message, *arguments):
        before = {p: p.read_bytes() for p in self.folder.rglob("*") if p.is_file()}
        result = run(*arguments)
        errors = [line for line in result.stderr.splitlines() if "warning: " not in line]
        self.assertEqual((result.returncode, len(errors)), (1, 1), result.stderr)
        self.assertRegex(errors[0], message)
        self.assertEqual(before,
                         {p: p.read_bytes() for p in self.folder.rglob("*") if p.is_file()})

    def test_nothing_but_coordinates_is_changed(self):
        """The coordinates are those of the .vtu of the same morph; nodes that stay keep theirs."""
        for extension in WRITERS:
            for case in range(CASES):
                seed = SEED + case
                end = ("\n", "\r\n")[case % 2]
                kind = ("mixed", "tetrahedra", "hexahedra")[case % 3]
                with self.subTest(extension=extension, seed=seed, kind=kind):
                    print(f"{extension} seed {seed}")
                    model, pieces, path = self.write(extension, seed, end=end, kind=kind)
                    out = self.folder / ("out" + extension)
                    printed = self.morph(path, out)
                    match = re.search("rounding of a coordinate: (.*)", printed)
                    self.assertLess(float(match[1]) if match else 0, ROUNDING[extension])
                    found = models.coordinates_in(pieces, out.read_bytes())
                    old = models.coordinates_in(pieces, path.read_bytes())
                    self.assertEqual(found.keys(), old.keys())
                    kept = sum(found[key].strip() == old[key].strip() for key in old)
                    self.assertGreater(kept, 0)
                    self.assertLess(kept, len(old))
                    if meshio:
                        self.compare_with_vtu(model, path, found, ROUNDING[extension])

    def points_by_number(self, path):
        """Of the same morph, written as a grid."""
        vtu = self.folder / "out.vtu"
        self.morph(path, vtu)
        # meshio knows no text in field data.
        text = vtu.read_text(encoding="ascii")
        vtu.write_text(re.sub("<FieldData>.*?</FieldData>", "", text, flags=re.S), encoding="ascii")
        grid = meshio.read(vtu)
        return dict(zip(grid.point_data["NodeNumber"], grid.points))

    def compare_with_vtu(self, model, path, found, rounding):
        points = self.points_by_number(path)
        moved = 0
        for i, node in enumerate(model.order):
            number = i if path.suffix == ".su2" else model.numbers[node]
            for axis in range(3):
                written = models.value(found[node, axis])
                exact = points[number][axis]
                self.assertLessEqual(abs(written - exact), rounding)
                moved += written != model.points[node][axis]
        self.assertGreater(moved, 0)

    @needs_meshio
    def test_another_reader_finds_the_same_cells(self):
        for extension in (".inp", ".su2"):
            with self.subTest(extension=extension):
                # SU2's reader in meshio takes no comments and no tabs.
                model, rng = models.random_model(SEED)
                style = models.number_text
                models.number_text = lambda rng, x, style=None: repr(x)
                try:
                    pieces = WRITERS[extension](model, rng)
                finally:
                    models.number_text = style
                text = models.text_of(pieces).decode()
                if extension == ".su2":
                    text = re.sub(r"%.*", "", text).replace("\t", " ")
                    text = re.sub(r"\n[ \n]+", "\n", text)
                else:  # Abaqus's takes one list of nodes, and neither comments nor commas at ends.
                    text = re.sub(r"\*Node,\n nset = NALL\n|\*\* .*\n", "", text)
                    nodes, elements = text.split("*ELEMENT", 1)
                    text = re.sub(r", *\n", "\n", nodes) + "*ELEMENT" + elements
                path, out = self.folder / ("plain" + extension), self.folder / ("o" + extension)
                path.write_text(text.lstrip())
                self.morph(path, out)
                before, after = meshio.read(path), meshio.read(out)
                self.assertEqual([b.type for b in before.cells], [b.type for b in after.cells])
                for old, new in zip(before.cells, after.cells):
                    self.assertTrue((old.data == new.data).all())
                self.assertEqual(sum(len(b.data) for b in after.cells if b.type in
                                     ("hexahedron", "wedge")), len(model.cells))
                self.assertGreater(abs(before.points - after.points).max(), 0.03)
                self.assertEqual(before.points.shape, after.points.shape)

    @needs_meshio
    def test_another_reader_of_nastran_finds_the_same_cells(self):
        """And the moved nodes, as far as each form of a field holds them."""
        for fields, rounding in (("small", 1e-3), ("large", 1e-13), ("free", 1e-6)):
            with self.subTest(fields=fields):
                model, rng = models.random_model(f"{fields} {SEED}")
                text = models.text_of(models.nastran(model, rng, only=fields)).decode()
                # meshio takes no small letters, and no continuation without its sign.
                text = text.replace("grid,", "GRID,").replace("\n,", "\n+,")
                text = re.sub(r"\n {8}(?=[ \d])", "\n+       ", text)
                path, out = self.folder / "plain.bdf", self.folder / "out.bdf"
                path.write_text(text)
                self.morph(path, out)
                before, after = meshio.read(path), meshio.read(out)
                self.assertEqual([b.type for b in before.cells], [b.type for b in after.cells])
                for old, new in zip(before.cells, after.cells):
                    self.assertTrue((old.data == new.data).all())
                self.assertEqual(
                    sum(len(b.data) for b in after.cells if b.type in ("hexahedron", "wedge")),
                    len(model.cells))
                exact = self.points_by_number(path)
                self.assertEqual(len(after.points), len(exact))
                for node, x in zip(model.order, after.points):
                    self.assertLess(abs(x - exact[model.numbers[node]]).max(), rounding)
                self.assertGreater(abs(before.points - after.points).max(), 0.03)

    @needs_meshio
    def test_files_that_meshio_writes(self):
        """Zero keeps each byte; meshio finds the moved nodes where they were asked to go."""
        corner = np.arange(64).reshape(4, 4, 4)[:3, :3, :3].reshape(-1, 1)
        cells = corner + [0, 1, 5, 4, 16, 17, 21, 20]
        tetrahedra = cells[:, [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6],
                               [0, 5, 1, 6]]].reshape(-1, 4)
        points = np.array([(i % 4, i // 4 % 4, i // 16) for i in range(64)]) / 3
        sides = [word for i in range(6) for word in ("--move", f"Surface {i}")]
        for form, extension in (("abaqus", "inp"), ("nastran", "bdf"), ("su2", "su2"),
                                ("gmsh22", "msh"), ("gmsh", "msh")):
            for kind, nodes in (("hexahedron", cells), ("tetra", tetrahedra)):
                with self.subTest(form=form, kind=kind):
                    path, out = (self.folder / f"{name}.{extension}" for name in ("in", "out"))
                    meshio.write(path, meshio.Mesh(points, [(kind, nodes)]), file_format=form)
                    self.morph(path, out, "--move", "Surface 1", "--translate", "0,0,0")
                    self.assertEqual(out.read_bytes(), path.read_bytes())
                    self.morph(path, out, *sides, "--translate", "-.1,.02,.03")
                    moved = meshio.read(out).points
                    self.assertLess(abs(moved - points - [-.1, .02, .03]).max(), 1e-6)

    def test_names_of_the_file_are_surfaces(self):
        for extension, names in ((".inp", ("Wall", "Inlet", "Outlet")),
                                 (".su2", ("wall", "inlet", "outlet")),
                                 (".msh", ("wall", "inlet", "outlet")),
                                 (".bdf", ("PID 2", "PID 3", "PID 4"))):
            with self.subTest(extension=extension):
                model, _, path = self.write(extension)
                listed = run("--list-surfaces", path)
                self.assertEqual(listed.returncode, 0, listed.stderr)
                rows = dict(re.findall(r"^(.+?)  +(\d+) ", listed.stdout, re.MULTILINE))
                for name, faces in zip(names, (model.wall, model.inlet, model.outlet)):
                    self.assertEqual(int(rows[name]), len(faces), name)
                out = self.folder / ("out" + extension)
                folded = self.folder / ("folded" + extension)
                self.morph(path, out, "--move", names[1], "--translate", "0,0,-0.1", "--fix",
                           names[2])
                self.morph(path, folded, "--move", names[1].upper(), "--translate", "0,0,-0.1",
                           "--fix", names[2].upper())
                self.assertEqual(folded.read_bytes(), out.read_bytes())
                self.refuse(f"Nothing'.*{names[1]}", "--move", "Nothing", "--translate", "1,0,0",
                            path, out)

    def test_a_set_that_names_what_is_not_there_is_left_out(self):
        """Alone, as the nodes of elements, in a set of a set, and in a surface."""
        nodes = "".join(f"{i + 1}, {i & 1}., {i >> 1 & 1}., {i >> 2}.\n" for i in range(8))
        path = self.folder / "m.inp"
        path.write_text(
            "*NODE\n" + nodes + "*ELEMENT, TYPE=C3D8, ELSET=Solid\n1, 1, 2, 4, 3, 5, 6, 8, 7\n"
            "*ELEMENT, TYPE=GK3D8, ELSET=Gasket\n2, 1, 2, 4, 3, 5, 6, 8, 7\n"
            "*NSET, NSET=Low\n1, 2, 3, 4\n*NSET, NSET=Top\n5, 6, 7, 8\n"
            "*NSET, NSET=Nodes, ELSET=Solid\n*NSET, NSET=All\nLow, Nodes\n"
            "*NSET, NSET=Both\nTop, Missing\n*NSET, NSET=More\nLow, Both\n"
            "*NSET, NSET=Gone, ELSET=Lost\n*ELSET, ELSET=Some\nSolid, Gasket\n"
            "*SURFACE, NAME=Face\nAway, S1\n*NSET, NSET=Round\nRound, Top\n")
        listed = run("--list-surfaces", path)
        found = dict(re.findall(r"^(\w+)  +(\d+) ", listed.stdout, re.MULTILINE))
        self.assertEqual(set(found), {"Low", "Top", "Nodes", "All", "Some", "Solid", "Round"})
        self.assertEqual((found["All"], found["Round"]), ("6", "1"))
        for name, missing in (("Both", "MISSING"), ("More", "MISSING"), ("Gone", "LOST"),
                              ("Face", "AWAY")):
            self.assertIn(f"The set '{name}' names the set '{missing}'", listed.stderr)
            self.refuse(f"names '{name}', which the boundary does not have", "--move", name,
                        "--translate", "0,0,0.1", path, self.folder / "out.inp")

    CUBE = "*NODE\n" + "".join(f"{i + 1}, {i & 1}., {i >> 1 & 1}., {i >> 2}.\n"
                               for i in range(8))

    BRICK = "*ELEMENT, TYPE=C3D8, ELSET=Solid\n1, 1, 2, 4, 3, 5, 6, 8, 7\n"

    def check_by_reading(self, path, out, *move, delta=1e-13):
        """What is written, read again, is the morphed mesh. Returns its points."""
        exact, again = self.folder / "exact.vtk", self.folder / "again.vtk"
        csv = self.folder / "still.csv"
        csv.write_text("id,dx,dy,dz\n0,0,0,0\n")
        for arguments in ((*move, path, out), (*move, path, exact),
                          ("--displacements", csv, out, again)):
            result = run(*arguments)
            self.assertEqual(result.returncode, 0, result.stderr)
        for a, b in zip(points_of(exact), points_of(again)):
            self.assertAlmostEqual(a, b, delta=delta)
        return points_of(exact)

    def assembly(self, second="Other"):
        """Two cubes: the second is turned by 90 degrees about a line beside the z axis, and moved
        before that. It is another part, or another instance of the first."""
        part = ("*PART, NAME=%s\n" + self.CUBE + self.BRICK +
                "*NSET, NSET=Top\n5, 6, 7, 8\n*END PART\n")
        path = self.folder / "cae.inp"
        path.write_text(
            "*HEADING\n" + part % "Block" + part % "Other" + "*ASSEMBLY, NAME=A\n"
            "*INSTANCE, NAME=One-1, PART=block\n*END INSTANCE\n"
            f"*INSTANCE, NAME=Two-1, PART={second}\n5., 0., 1.\n5., 1., 0., 5., 1., 1., 90.\n"
            "*END INSTANCE\n*NODE\n1, 9., 9., 9.\n*NSET, NSET=Reference\n1\n"
            "*NSET, NSET=Lid, INSTANCE=Two-1, GENERATE\n5, 8, 1\n"
            "*NSET, NSET=Lids\nOne-1.Top, Two-1.5, Two-1.6, two-1.7, Two-1.8\n"
            "*ELSET, ELSET=Both\nOne-1.1, Two-1.Solid\n*ELSET, ELSET=_S, INSTANCE=Two-1\n1\n"
            "*SURFACE, NAME=Wall, TYPE=ELEMENT\n_S, S2\n*END ASSEMBLY\n*STEP\n*END STEP\n")
        return path

    def test_parts_and_instances_of_an_assembly(self):
        path, out = self.assembly(), self.folder / "out.inp"
        rows = dict(re.findall(r"(?m)^(\S+) +(\d+ .*)$", run("--list-surfaces", path).stdout))
        self.assertRegex(rows["Lid"], r"^1 +1 +5.5, 1.5, 2$")
        for name, faces in (("One-1.Top", 1), ("Two-1.Top", 1), ("Lids", 2), ("Both", 12),
                            ("Two-1", 6), ("Wall", 1), ("One-1.Solid", 6)):
            self.assertRegex(rows[name], f"^{faces} ", name)
        self.check_by_reading(path, out, "--move", "Wall", "--translate", "0.25,0,0.5")
        # In the part's own system, what is written is turned back.
        old, new = path.read_text().split("*PART"), out.read_text().split("*PART")
        self.assertEqual(new[:2], old[:2])
        for i, x, y in ((5, "0.", "0."), (6, "1.", "0."), (7, "0.", "1."), (8, "1.", "1.")):
            old[2] = old[2].replace(f"{i}, {x}, {y}, 1.", f"{i}, {x}, {float(y) - 0.25}, 1.5")
        self.assertEqual(re.sub(r"\b(\d)\.0?(?=,)", r"\1.0", new[2]),
                         re.sub(r"\b(\d)\.0?(?=,)", r"\1.0", old[2]))

    def test_lines_of_an_instance_end_in_commas(self):
        """Or have nothing else: what is left out is 0."""
        path, out = self.assembly(), self.folder / "out.inp"
        text = path.read_text()
        rows = run("list", path).stdout
        path.write_text(text.replace("5., 0., 1.\n", "5., , 1.,\n").replace(" 90.\n", " 90.,\n"))
        self.assertEqual(run("list", path).stdout, rows)
        path.write_text(text.replace("5., 0., 1.\n", ",\n"))
        self.assertRegex(run("list", path).stdout, r"(?m)^Lid +1 +1 +5\.5, -3\.5, 1$")
        self.check_by_reading(path, out, "--move", "Wall", "--translate", "0.25,0,0.5")

    def test_instances_of_one_part_share_its_nodes(self):
        path, out = self.assembly("Block"), self.folder / "out.inp"
        one, both = (("--move", name, "--translate", "0,0,0.5") for name in ("Lid", "Lids"))
        result = run(*one, path, out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("'Block' has several instances, which share its nodes", result.stderr)
        moved = out.read_text()
        self.assertEqual(moved.count(", 1.5\n"), 4)
        self.check_by_reading(path, out, *both)
        self.assertEqual(out.read_text(), moved)
        self.refuse("instances of one part move differently at the nodes .*part of its own",
                    "--move", "Lids", "--translate", "0.25,0,0.5", path, out)

    def test_coordinate_systems_of_an_input_file(self):
        """*SYSTEM, and cylindrical coordinates: radius, degrees, height."""
        corners = [(1 + (i & 1), 30 * (i >> 1 & 1), i >> 2) for i in range(8)]
        nodes = "".join(f"{i + 1}, {r}., {a}., {z}.\n" for i, (r, a, z) in enumerate(corners))
        path, out = self.folder / "m.inp", self.folder / "out.inp"
        for system, expected in (("", (3 ** 0.5 / 2, 0.5, 1.5)),
                                 ("*SYSTEM\n1., 2., 3., 1., 3., 3.\n0., 2., 3.\n",
                                  (1 - 0.5, 2 + 3 ** 0.5 / 2, 4.5))):
            path.write_text(f"{system}*NODE, SYSTEM=C\n{nodes}*SYSTEM\n{self.BRICK}"
                            "*NSET, NSET=Top\n5, 6, 7, 8\n")
            points = self.check_by_reading(path, out, "--move", "Top", "--translate", "0,0,0.5")
            for a, b in zip(points[3 * 6:3 * 6 + 3], expected):
                self.assertAlmostEqual(a, b, delta=1e-13)
            # Radius and angle keep their text.
            self.assertIn("7, 1., 30., 1.5\n8, 2., 30., 1.5\n", out.read_text())
            self.check_by_reading(path, out, "--move", "Top", "--translate", "0.1,0.2,0.5")

    def test_coordinate_systems_of_nastran(self):
        """By points and by nodes, each in another one; large and free fields; GRDSET."""
        systems = ("CORD2R,1,,1.,2.,3.,1.,2.,4.\n,1.,3.,3.\n"  # its x axis is y
                   "CORD2C,2,1,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
                   "CORD2S*                3               1              0.              0.\n"
                   "*                     0.              0.              0.              1.\n"
                   "*                     1.              0.              0.\n"
                   "CORD1C,4,91,92,93\nGRID,91,0,1.,2.,3.\nGRID,92,1,0.,0.,1.\n"
                   "GRID,93,0,1.,3.,3.\n")
        path, out = self.folder / "m.bdf", self.folder / "out.bdf"
        corners = [(1 + (i & 1), 30 * (i >> 1 & 1), i >> 2) for i in range(8)]
        shape = {1: lambda r, a, z: (r, a / 30, z), 2: lambda r, a, z: (r, a, z),
                 3: lambda r, a, z: (r + 1, 60 + 30 * z, a), 4: lambda r, a, z: (r, a, z)}
        for system, local in shape.items():
            with self.subTest(system=system):
                text = f"BEGIN BULK\nGRDSET,,{system}\n" + systems
                for i, corner in enumerate(corners):
                    own = "" if i % 2 else system
                    text += "GRID*,{},{},{}.,{}.,*A\n*A,{}.\n".format(
                        i + 1, own, *(int(x) for x in local(*corner)))
                path.write_text(text + "CHEXA,1,7,1,2,4,3,5,6,+B\n+B,8,7\n")
                points = self.check_by_reading(path, out, "--move", "Surface 1", "--translate",
                                               "0.1,0.05,0.02", delta=1e-12)
                old, new = (file.read_text().splitlines() for file in (path, out))
                self.assertEqual(new[:12] + new[-2:], old[:12] + old[-2:])
        self.assertEqual(len(points), 33)
        for text, message in (("CORD2R,5,6,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
                               "CORD2R,6,5,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,5,0.,0.,0.\n",
                               "needs others that need it"),
                              ("CORD2R,5,0,0.,0.,0.,0.,0.,1.\n,0.,0.,2.\nGRID,1,5,0.,0.,0.\n",
                               "line 2: the three points of the coordinate system 5 are on a line"),
                              ("CORD1R,5,7,8,9\nGRID,1,5,0.,0.,0.\n", "needs the node 7"),
                              ("GRID,1,5,0.,0.,0.\n", "coordinate system 5, which no CORD1R")):
            path.write_text("BEGIN BULK\n" + text)
            self.refuse(message, "--list-surfaces", path)

    def test_a_system_of_nodes_goes_along_with_them(self):
        """The upper cube's top is given in the system of three nodes of the lower one."""
        grids = "".join(f"GRID,{i + 1},,{x}.,{y}.,{z}.\n" for i, (x, y, z) in enumerate(
            self.CORNERS)) + "".join(f"GRID,{i + 9},4,{i & 1}.,{i >> 1}.,2.\n" for i in range(4))
        path, out, table = (self.folder / name for name in ("m.bdf", "out.bdf", "line.csv"))
        path.write_text(f"BEGIN BULK\nCORD1R,4,1,5,2\n{grids}CHEXA,1,7,1,2,4,3,5,6,+\n+,8,7\n"
                        "CHEXA,2,7,5,6,8,7,9,10,+\n+,12,11\nENDDATA\n")
        for motion in (("--translate", "0.25,0.5,1"), ("--rotate", "0,0,90")):
            self.check_by_reading(path, out, "--move", "PID 7", *motion, delta=1e-12)
            self.assertEqual(out.read_text().splitlines()[10:], path.read_text().splitlines()[10:])
        self.check_by_reading(path, out, "--move", "Surface 0", "--rotate", "20,0,5", delta=1e-5)
        table.write_text("id,dx,dy,dz\n1,-1,0,0\n")
        self.refuse("puts the nodes of the coordinate system 4 on a line", "--displacements", table,
                    "--validity", "none", path, out)

    CORNERS = [(i & 1, i >> 1 & 1, i >> 2) for i in range(8)]

    def test_a_deck_of_ls_dyna_in_each_form_of_its_fields(self):
        """Fixed, long and free fields; sets; nodes in an included file; text that stays."""
        path, out = self.folder / "m.k", self.folder / "out.k"
        for form, (number, real, join) in {
                "fixed": ("{:8d}", "{:16.6f}", ""), "long": ("{:20d}", "{:20.9f}", ""),
                "free": ("{}", "{}.", ",")}.items():
            with self.subTest(form=form):
                def card(*numbers, width=None):
                    style = f"{{:{width}d}}" if width and form == "fixed" else number
                    return join.join(style.format(n) for n in numbers) + "\n"

                nodes = "".join(
                    join.join([number.format(i + 1), *(real.format(x) for x in corner)]) + "\n"
                    for i, corner in enumerate(self.CORNERS))
                path.write_text(
                    "$ a deck\n*KEYWORD" + (" LONG=Y" if form == "long" else "") + "\n*NODE\n" +
                    nodes + "$ comment\n*ELEMENT_SOLID\n" + card(1, 7, 1, 2, 4, 3, 5, 6, 8, 7) +
                    "*ELEMENT_SHELL\n" + card(1, 8, 5, 6, 8, 7) + "*PART\nThe lid\n" +
                    card(8, 1, 1, width=10) + "*SET_NODE_LIST\n" + card(3, width=10) +
                    card(5, 6, 7, 8, width=10) + "*SET_SEGMENT_TITLE\nFoot\n" +
                    card(4, width=10) + card(1, 2, 4, 3, width=10) + "*SET_SHELL\n" +
                    card(5, width=10) + card(1, width=10) + "*ELEMENT_MASS\n" + card(9, 1) +
                    "*MAT_ELASTIC\n" + card(1, width=10) + "*END\nno deck\n")
                rows = run("--list-surfaces", path)
                self.assertIn("What *ELEMENT_MASS defines is left out", rows.stderr)
                for name, faces in (("PID 7", 6), ("The lid", 1), ("Node set 3", 1), ("Foot", 1),
                                    ("Shell set 5", 1)):
                    self.assertRegex(rows.stdout, f"(?m)^{name} +{faces} ")
                for name, z, shift in (("Foot", 0, -0.5), ("The lid", 1, 0.25)):
                    self.check_by_reading(path, out, "--move", name, "--translate", f"0,0,{shift}")
                    old, new = (file.read_text().splitlines() for file in (path, out))
                    at = old.index("*NODE") + 1
                    moved = [i for i in range(len(old)) if old[i] != new[i]]
                    self.assertEqual(moved, [at + i for i in range(8) if i >> 2 == z])
                    if form != "free":
                        self.assertEqual([len(line) for line in new], [len(line) for line in old])

    def test_collapsed_hexahedra_of_ls_dyna(self):
        """Tetrahedra, pyramids and wedges are hexahedra with equal nodes, or have own cards."""
        nodes = "".join(f"{i + 1},{x},{y},{z}\n" for i, (x, y, z) in enumerate(self.CORNERS))
        nodes += "9,.5,0,0\n10,.5,.5,0\n11,0,.5,0\n12,0,0,.5\n13,.5,0,.5\n14,0,.5,.5\n"
        path = self.folder / "m.key"
        for text, faces in (("1,7,1,2,3,5,5,5,5,5\n", 4), ("1,7\n1,2,3,5\n", 4),
                            ("1,7\n1,2,3,5,9,10,11,12,13,14\n", 16),
                            ("1,7,1,2,4,3,5,5,5,5\n", 5), ("1,7,1,2,3,3,5,6,7,7\n", 5),
                            ("1,7,1,2,4,3,5,5,7,7\n", 5), ("1,7,1,2,4,3,5,6,8,7\n", 6)):
            path.write_text("*NODE\n" + nodes + "*ELEMENT_SOLID\n" + text)
            result = run("--move", "PID 7", "--translate", "1,0,0", path, self.folder / "out.key")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertRegex(result.stdout, r"inverted cells +0 +0\n")
            self.assertRegex(run("--list-surfaces", path).stdout, f"(?m)^PID 7 +{faces} ")

    def test_rigid_links_and_springs_take_nodes_along(self):
        """Node 20 is tied to the four on top, and 21 to it: both move with the top."""
        points = {i + 1: x for i, x in enumerate(self.CORNERS)} | {20: (.5, .5, 2), 21: (.5, .5, 3)}
        grids = "".join(f"GRID,{n},,{x}.,{y}.,{z}.\n".replace(".5.", ".5")
                        for n, (x, y, z) in points.items())
        rows = "".join(f"{n},{x},{y},{z}\n" for n, (x, y, z) in points.items())
        bulk = f"BEGIN BULK\n{grids}CHEXA,1,1,1,2,4,3,5,6,+\n+,8,7\n%sENDDATA\n"
        deck = (f"*NODE\n{rows}*ELEMENT,TYPE=C3D8\n1,1,2,4,3,5,6,8,7\n*NSET,NSET=Lid\n5,6,7,8\n"
                "*NSET,NSET=Hub\n20\n*SURFACE,NAME=Top,TYPE=NODE\nLid\n%s")
        last = "*ELEMENT,TYPE=RB3D2\n9,20,21\n"
        keywords = (f"*NODE\n{rows}*ELEMENT_SOLID\n1,7,1,2,4,3,5,6,8,7\n*SET_NODE\n3\n5,6,7,8\n"
                    "*ELEMENT_DISCRETE\n1,9,20,21\n2,9,20,0\n%s*END\n")
        decks = {
            "two.bdf": bulk % "RBE2,9,20,123,5,6,7,8\nCELAS1,9,3,20,1,21,1\nCELAS1,8,3,20,1\n",
            "three.bdf": bulk % ("RBE3,9,,20,123,1.,123,5,+\n+,6,.5,123,7,8\nSPOINT,99\n"
                                 "RBAR,4,20,21\nCELAS2,7,1.,20,1,99\n"),
            "coupling.inp": deck % f"*COUPLING,REF NODE=Hub,SURFACE=Top\n*KINEMATIC\n{last}",
            "kinematic.inp": deck % f"*KINEMATIC COUPLING,REF NODE=20\n5,1,3\nLid,1,3\n{last}",
            "rigid.inp": deck % f"*RIGID BODY,NSET=Lid,REF NODE=20,ROT NODE=21\n",
            "mpc.inp": deck % "*MPC\nBEAM,Lid,20\nPIN,21,20\n",
            "node.k": keywords % "*CONSTRAINED_NODAL_RIGID_BODY\n5,,3,20\n",
            "spc.k": keywords % "*CONSTRAINED_NODAL_RIGID_BODY_SPC_TITLE\nx\n5,,3,20\n1,2,3,4\n"}
        for name, text in decks.items():
            with self.subTest(name):
                path, out = self.folder / name, self.folder / ("out-" + name)
                path.write_text(text)
                top = re.search(r"(?m)^(Surface \d) .* 1$", run("list", path).stdout)[1]
                result = run("--move", top, "--translate", "0,0,.5", path, out)
                self.assertEqual((result.returncode, result.stderr), (0, ""))
                for node, height in ((20, 2.5), (21, 3.5)):
                    line = re.search(rf"(?m)^(?:GRID,)?{node},.*$", out.read_text())[0]
                    self.assertAlmostEqual(float(line.split(",")[-1]), height, 6)

    def test_options_of_keywords_of_ls_dyna(self):
        """Lines that options add, thick shells, ranges of sets; beams and quadratic shells move."""
        nodes = "".join(f"{i + 1},{x},{y},{z}\n" for i, (x, y, z) in enumerate(self.CORNERS))
        nodes += "11,.5,0,1\n12,1,.5,1\n13,.5,1,1\n14,0,.5,1\n20,0,0,2\n"
        path, out = self.folder / "m.k", self.folder / "out.k"
        for solid, extra in (("SOLID", ""), ("SOLID_ORTHO", "0.,0.\n0.,0.\n"), ("TSHELL", "")):
            with self.subTest(solid=solid):
                path.write_text(
                    f"*NODE\n{nodes}*ELEMENT_{solid}\n1,7,1,2,4,3,5,6,8,7\n{extra}"
                    "*ELEMENT_SHELL_THICKNESS_OFFSET\n1,8,5,6,8,7,11,12,13,14\n.1,.1,.1,.1\n.05\n"
                    "*ELEMENT_BEAM_ORIENTATION\n1,9,5,20,1,0\n0.,0.,1.\n"
                    "*SET_NODE_LIST_GENERATE_TITLE\nLid\n1\n5,6,7,15\n"
                    "*SET_SHELL_LIST_GENERATE\n2\n1,9\n*SET_NODE_GENERAL\n3\nPART,7\n*END\n")
                listed = run("list", path)
                for name, faces in (("PID 7", 6), ("PID 8", 1), ("Lid", 1), ("Shell set 2", 1)):
                    self.assertRegex(listed.stdout, f"(?m)^{name} +{faces} ")
                self.assertIn("What *SET_NODE_GENERAL defines is left out", listed.stderr)
                run("--move", "Lid", "--translate", "0,0,.5", path, out)
                beam = [float(x) for x in re.search("(?m)^20,(.*)$", out.read_text())[1].split(",")]
                self.assertEqual(beam, [0, 0, 2.5])

    def test_included_files_of_ls_dyna(self):
        folder, there = self.folder / "in", self.folder / "there"
        for parent in (folder, there):
            parent.mkdir()
        (folder / "thenodes.k").write_text("*NODE\n" + "".join(
            f"{i + 1:8d}{x:16.3f}{y:16.3f}{z:16.3f}\n" for i, (x, y, z) in enumerate(self.CORNERS)))
        text = ("*KEYWORD\n*INCLUDE\nthe +\nnodes.k\n*ELEMENT_SOLID\n" +
                "".join(f"{n:8d}" for n in (1, 7, 1, 2, 4, 3, 5, 6, 8, 7)) + "\n*END\n")
        (folder / "deck.k").write_text(text)
        self.morph(folder / "deck.k", there / "deck.k", "--move", "PID 7", "--translate", "1,0,0")
        self.assertEqual((there / "deck.k").read_text(), text)
        lines = (there / "thenodes.k").read_text().splitlines()[1:]
        for line, (x, y, z) in zip(lines, self.CORNERS):
            written = [float(line[8 + 16 * a:24 + 16 * a]) for a in range(3)]
            self.assertEqual(written, [x + 1, y, z])

    @unittest.skipUnless(shutil.which("gmsh"), "Gmsh is not installed (gmsh)")
    def test_decks_that_gmsh_writes(self):
        """Its faces are planar elements of Abaqus, and its tetrahedra hexahedra of LS-DYNA."""
        box = self.folder / "box.geo"
        box.write_text('SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 1, 1, 1};\n'
                       'Physical Volume("body") = {1}; Physical Surface("wall") = {1};\n'
                       "Mesh.MeshSizeMax = 0.5;\n")
        for extension, wall, order in ((".inp", "wall", "1"), (".key", "PID 2000001", "1"),
                                       (".key", "PID 2000001", "2"), (".bdf", "PID 1", "1"),
                                       (".su2", "wall", "1")):
            with self.subTest(extension=extension, order=order):
                path, out = self.folder / ("box" + extension), self.folder / ("out" + extension)
                subprocess.run(["gmsh", "-3", "-order", order, box, "-o", path], check=True,
                               capture_output=True, timeout=120)
                said = self.morph(path, out, "--move", wall, "--translate", "0,0,0")
                self.assertIn("\n0 coordinates of %s changed, all else kept" % out, said)
                self.assertEqual(out.read_bytes(), path.read_bytes())
                self.check_by_reading(path, out, "--move", wall, "--translate", "-0.25,0,0",
                                      delta=1e-6)
                self.assertNotEqual(out.read_bytes(), path.read_bytes())
        unv, msh = self.folder / "box.unv", self.folder / "box.msh"
        subprocess.run(["gmsh", "-3", box, "-o", unv], check=True, capture_output=True, timeout=120)
        self.refuse("Gmsh converts it: gmsh .*box.unv -save -o model.msh", "--list-surfaces", unv)
        subprocess.run(["gmsh", unv, "-save", "-o", msh], check=True, capture_output=True,
                       timeout=120)
        self.assertRegex(run("--list-surfaces", msh).stdout, "(?m)^wall +[1-9]")
        med, fluent = self.folder / "box.med", self.folder / "fluent.msh"
        med.write_bytes(b"\x89HDF")
        self.refuse("Gmsh converts it: gmsh .*box.med -save -o model.msh", "list", med)
        fluent.write_text('(0 "GAMBIT to Fluent File")\n(2 3)\n')
        self.refuse("of Fluent, .*meshio convert --input-format ansys .*fluent.msh model.vtu",
                    "list", fluent)

    def test_meshes_that_gmsh_writes(self):
        """With parameters of nodes, and of several partitions, whose interfaces are no surfaces."""
        box = self.folder / "box.geo"
        box.write_text('SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 1, 1, 1};\n'
                       'Physical Volume("body") = {1}; Physical Surface("wall") = {1};\n'
                       "Mesh.MeshSizeMax = 0.5;\n")
        path, out = self.folder / "box.msh", self.folder / "out.msh"
        parametric = ("-setnumber", "Mesh.SaveParametric", "1")
        ghosts = ("-part", "3", "-setnumber", "Mesh.PartitionCreateGhostCells", "1")
        rows = set()
        for words in (parametric, ("-part", "2"), ghosts):
            for form in ("msh22", "msh41"):
                for code in ((), ("-bin",)):
                    with self.subTest(words=words, form=form, code=code):
                        subprocess.run(["gmsh", "-3", box, "-format", form, *words, *code, "-o",
                                        path], check=True, capture_output=True, timeout=120)
                        rows.add(tuple(re.findall(r"(?m)^((?!Surface).*) +\d", run(
                            "list", path).stdout)))
                        self.assertEqual(len(rows), 1, rows)
                        self.morph(path, out, "--move", "wall", "--translate", "0,0,0")
                        self.assertEqual(out.read_bytes(), path.read_bytes())
                        self.check_by_reading(path, out, "--move", "wall", "--translate",
                                              "-0.25,0,0", delta=1e-12)

    def test_planar_elements_beside_volumes_are_faces(self):
        """Mesh generators name faces by types of planar models."""
        path, out = self.folder / "m.inp", self.folder / "out.inp"
        for kind in ("CPS4", "CPE4R", "CAX4", "CPEG4", "DC2D4", "S4R", "M3D4"):
            with self.subTest(kind=kind):
                path.write_text(self.CUBE + f"*ELEMENT, TYPE={kind}, ELSET=Lid\n1, 5, 6, 8, 7\n"
                                "*ELEMENT, TYPE=T3D2, ELSET=Edge\n3, 1, 2\n"
                                "*ELEMENT, TYPE=C3D8, ELSET=Solid\n2, 1, 2, 4, 3, 5, 6, 8, 7\n"
                                "*ELSET, ELSET=top\n1\n")
                listed = run("--list-surfaces", path)
                self.assertRegex(listed.stdout, r"top +1 +1 +0.5, 0.5, 1\n", listed.stderr)
                self.morph(path, out, "--move", "top", "--translate", "0,0,0.25")
                self.assertEqual(out.read_text(), re.sub(r"(?m)^(\d, .\., .\.), 1\.$", r"\1, 1.25",
                                                         path.read_text()))

    def test_a_free_line_of_nastran_has_any_number_of_fields(self):
        """Its tenth field is the name of the next line, unless more follow."""
        corners = "".join(f"GRID,{i + 1},,{i & 1}.,{i >> 1 & 1}.,{i >> 2}.\n" for i in range(8))
        middles = "".join(f"GRID*,{i},,.5,.5,*A\n*A,.5\n" for i in range(9, 21))
        path, rest = self.folder / "m.bdf", ",".join(map(str, range(9, 21)))
        # A face of 8 nodes counts as 5.
        for line, faces in ((f"7,3,1,2,4,3,5,6,8,7,{rest}\n", 30),
                            ("8,3,1,2,4,3,5,6,+B\n+B,8,7\n", 6)):
            path.write_text("BEGIN BULK\n" + corners + middles + "CHEXA," + line)
            listed = run("--list-surfaces", path)
            self.assertRegex(listed.stdout, f"PID 3 +{faces} ", listed.stderr)
        for more in (1, 11):  # left out between corners
            path.write_text("BEGIN BULK\n" + corners + middles +
                            f"CHEXA,7,3,1,2,4,3,5,6,8,7,{rest}"[:-3 * more] + "\n")
            self.assertRegex(run("--list-surfaces", path).stdout, "PID 3 +6 ")

    def test_nodes_are_chosen_by_the_numbers_of_the_file(self):
        for extension in (".inp", ".su2", ".msh"):
            with self.subTest(extension=extension):
                model, pieces, path = self.write(extension)
                moves = model.wall_nodes[:4]
                rows = [(model.order.index(n) if extension == ".su2" else model.numbers[n])
                        for n in moves]
                csv, out = self.folder / "moves.csv", self.folder / ("out" + extension)
                csv.write_text("id,dx,dy,dz\n" + "".join(f"{r},0.01,-0.02,0.5\n" for r in rows))
                self.morph(path, out, "--displacements", csv, "--node-numbers", "--validity",
                           "None")
                found = models.coordinates_in(pieces, out.read_bytes())
                old = models.coordinates_in(pieces, path.read_bytes())
                for node in moves:
                    for axis, shift in enumerate((0.01, -0.02, 0.5)):
                        self.assertAlmostEqual(models.value(found[node, axis]),
                                               models.value(old[node, axis]) + shift, delta=1e-14)

    def test_a_file_of_the_moved_boundary(self):
        """morph-mesh ORIGINAL moved.vtp OUT: the file of the motion itself, up to its digits."""
        for extension in WRITERS:
            with self.subTest(extension=extension):
                _, pieces, path = self.write(extension)
                wanted, out = (self.folder / (name + extension) for name in ("wanted", "out"))
                boundary = self.folder / f"{extension[1:]}.vtp"
                self.morph(path, wanted)
                self.assertEqual(run("extract", wanted, boundary).returncode, 0)
                # Its nodes are those of the original by their ids, and at their new places.
                text, count = re.subn(rb'<DataArray [^>]*Name="RestPosition".*?</DataArray>', b"",
                                      boundary.read_bytes(), flags=re.S)
                self.assertEqual(count, 1)
                boundary.write_bytes(text)
                result = run(path, boundary, out, "--method", "FEMWARP")
                self.assertEqual(result.returncode, 0, result.stderr)
                found = models.coordinates_in(pieces, out.read_bytes())
                old = models.coordinates_in(pieces, path.read_bytes())
                moved = 0
                for key, text in models.coordinates_in(pieces, wanted.read_bytes()).items():
                    value = models.value(text)
                    self.assertAlmostEqual(models.value(found[key]), value, delta=1e-5)
                    moved = max(moved, abs(value - models.value(old[key])))
                self.assertGreater(moved, 1e-2)

    def test_the_output_may_be_the_original(self):
        for extension in WRITERS:
            with self.subTest(extension=extension):
                _, pieces, path = self.write(extension)
                out = self.folder / ("out" + extension)
                self.morph(path, out)
                self.morph(path, path)
                self.assertEqual(path.read_bytes(), out.read_bytes())
                models.coordinates_in(pieces, path.read_bytes())

    def test_steps_are_files_of_the_same_kind(self):
        _, pieces, path = self.write(".inp")
        self.morph(path, self.folder / "out.inp", "--move", "Wall", "--translate", "0.1,0.05,0.02",
                   "--steps", "2")
        for i in (1, 2):
            models.coordinates_in(pieces, (self.folder / f"out-{i}.inp").read_bytes())

    def test_another_format_is_refused(self):
        _, _, path = self.write(".inp")
        for name in ("out.su2", "out.stl", "out"):
            self.refuse(f"Cannot write .*{name}: ", "--move", "Wall", "--translate", "1,0,0", path,
                        self.folder / name)

    def test_lines_of_nastran_that_end_before_the_coordinates_do(self):
        """Blank coordinates are zero; what is written fills the fields from there on."""
        corners = [(i & 1, i >> 1 & 1, i >> 2) for i in range(8)]
        lines = []
        for i, x in enumerate(corners):
            line = f"GRID    {i + 1:8d}{'':8s}"
            line += "".join(f"{c}.      " if c else " " * 8 for c in x)
            lines.append(line.rstrip())
        text = "\n".join(lines) + "\nCHEXA,1,1,1,2,4,3,5,6\n,8,7\n"
        path, out = self.folder / "short.bdf", self.folder / "out.bdf"
        path.write_text("BEGIN BULK\n" + text)
        for move in ((0.25, 0.5, 0.125), (0, 0, 0.125), (0, 0.5, 0), (0.25, 0, 0)):
            self.morph(path, out, "--move", "PID 1", "--translate", ",".join(map(str, move)))
            again = out.read_text().splitlines()[1:9]
            for line, x in zip(again, corners):
                written = [float(line[24 + 8 * a:32 + 8 * a].strip() or 0) for a in range(3)]
                self.assertEqual(written, [c + d for c, d in zip(x, move)], line)
            self.assertEqual(out.read_text().splitlines()[9:], text.splitlines()[8:])

    def test_a_file_of_avs_is_told_apart_by_its_content(self):
        cube = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1".split("\n")
        path = self.folder / "avs.inp"
        path.write_text("# AVS\n8 1 0 0 0\n" + "".join(
            f"{i + 1} {x}\n" for i, x in enumerate(cube)) + "1 1 hex 1 2 3 4 5 6 7 8\n")
        self.morph(path, self.folder / "out.vtu", "--move", "Surface 0", "--translate", "1,0,0")
        self.refuse("a grid is written as .vtu or .vtk", "--move", "Surface 0", "--translate",
                    "1,0,0", path, self.folder / "out.inp")

    def test_damaged_files_are_refused_with_their_line(self):
        """Nothing is written, and the message names file and line."""
        nodes = "*NODE\n" + "".join(f"{i + 1}, {i & 1}., {i >> 1 & 1}., {i >> 2}.\n"
                                    for i in range(8))
        brick = "*ELEMENT, TYPE=C3D8\n1, 1, 2, 4, 3, 5, 6, 8, 7\n"
        points = "NPOIN= 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
        grids = "BEGIN BULK\n" + "".join(f"GRID,{i + 1},,{x}\n" for i, x in enumerate(
            ("0.,0.,0.", "1.,0.,0.", "0.,1.,0.", "0.,0.,1.")))
        tetra = "CTETRA,1,7,1,2,3,4\n"
        dyna = ("*KEYWORD\n*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n3,0.,1.,0.\n4,0.,0.,1.\n"
                "*ELEMENT_SOLID\n1,7,1,2,3,4,4,4,4,4\n")
        su2 = "NDIME= 3\n" + points + "NELEM= 1\n10 0 1 2 3\n"
        msh = ("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 9\n3 1 0 4\n1\n2\n3\n4\n"
               "0 0 0\n1 0 0\n0 0 1\n0 1 0\n$EndNodes\n$Elements\n1 1 9 9\n3 1 4 1\n9 1 2 3 4\n"
               "$EndElements\n")
        cases = (
            ("m.inp", nodes.replace("7, 0., 1.", "7, nan, 1.") + brick, "line 8: 'nan' is no num"),
            ("m.inp", nodes.replace("7, 0., 1.", "7, 1e999, 1.") + brick, "line 8: '1e999'"),
            ("m.inp", nodes.replace("8, 1.", "7, 1.") + brick, "more than one node .* 7"),
            ("m.inp", nodes + brick.replace(" 8, 7", " 8, 99"), "element 1 has the node 99"),
            ("m.inp", nodes + brick.replace(", 8, 7", ""), "element 1 are not complete"),
            ("m.inp", "*PART, NAME=P\n" + nodes + brick, "no .INSTANCE has a .NODE"),
            ("m.inp", "*ASSEMBLY\n*INSTANCE, NAME=I, PART=P\n", "line 2: .*the part 'P', which is"),
            ("m.inp", "*NSET, NSET=N, INSTANCE=I\n", "line 1: there is no instance 'I'"),
            ("m.inp", nodes + "*NGEN\n1, 8, 1\n" + brick, "line 10: .*NGEN"),
            ("m.inp", nodes + brick + "*NSET, NSET=N, GENERATE\n-9223372036854775808, 3\n",
             "line 13: GENERATE needs a first and a last number, neither below 0"),
            ("m.inp", nodes.replace("*NODE", "*NODE, SYSTEM=S") + brick,
             "line 1: .*spherical coordinates"),
            ("m.inp", "*SYSTEM\n1,2,3,1,2,3\n" + nodes + brick, "line 3: .*on a line"),
            ("m.inp", "*NODE\n1, 0., 0.\n2, 1., 0.\n", "no cells"),
            ("m.inp", "*INCLUDE, INPUT=none.inp\n", "none.inp: there is no such file"),
            ("m.inp", "*INCLUDE, INPUT=m.inp\n", "20 levels deep"),
            ("m.inp", "*STEP\n", "has no .NODE"),
            ("m.inp", "*PART, NAME=P\n" + nodes + "*END PART\n*INSTANCE, NAME=I, PART=P\n\n"
             "0., 0., 0., 0., 0., 1., 90.\n", "line 14: .INSTANCE has up to 3 numbers on its"),
            ("m.bdf", grids.replace("GRID,2,,", "GRID,2,5,") + tetra, "coordinate system 5, which"),
            ("m.bdf", "BEGIN BULK\nGRDSET,,9\n" + grids + tetra, "coordinate system 9, which"),
            ("m.bdf", grids.replace("1.,0.,0.", "1.,x,0.") + tetra, "line 3: 'x' is no number"),
            ("m.bdf", grids + tetra.replace("3,4", "3,44"), "element 1 has the node 44"),
            ("m.bdf", grids + tetra.replace("3,4", "3"), "line 6: CTETRA 1 lacks its corner 4"),
            ("m.bdf", grids + tetra + "GRID,2,,0.,0.,0.\n", "more than one node .* 2"),
            ("m.bdf", grids + "GRID*                  5\n" + tetra, "line 6: .*continuation line"),
            ("m.bdf", "BEGIN BULK\nINCLUDE 'none.bdf'\n", "none.bdf: there is no such file"),
            ("m.k", dyna.replace("1.,0.,0.", "1.,x,0."), "line 4: 'x' is no number"),
            ("m.k", dyna.replace("4,4,4,4", "44,44,44,44"), "element 1 has the node 44"),
            ("m.k", dyna.replace("4,4,4,4", ""), "line 8: element 1 has 3 nodes"),
            ("m.k", dyna + "1,8,1,2,3,4,4,4,4,4\n", "more than one element of one kind .* 1"),
            ("m.k", "*PARAMETER\nR X, 1.\n" + dyna, "line 1: it has .PARAMETER"),
            ("m.k", "*PART_MOVE\n7,1.,0.,0.\n" + dyna, "line 1: it has .PART_MOVE: parts that are"),
            ("m.k", "*INCLUDE_TRANSFORM\na.k\n" + dyna, "line 1: it has .INCLUDE_TRANSFORM"),
            ("m.k", "*INCLUDE\nm.k\n", "20 levels deep"), ("m.k", "*KEYWORD\n", "no .NODE"),
            ("m.su2", su2.replace("3\nNPOIN", "4\nNPOIN", 1), "line 1: .*two or three dimens"),
            ("m.su2", "NZONE= 2\n" + su2, "line 1: .*several zones"),
            ("m.su2", su2.replace("1 0 0", "1 inf 0"), "line 4: 'inf' is no number"),
            ("m.su2", su2.replace("1 0 0", "1 0"), "line 4: a point needs three"),
            ("m.su2", su2.replace("NPOIN= 4", "NPOIN= 5"), "line 7: a point needs three"),
            ("m.su2", su2.replace("NPOIN= 4", "NPOIN= 999999999"), "is out of range"),
            ("m.su2", su2.replace("10 0 1 2 3", "10 0 1 2 4"), "line 8: there is no point 4"),
            ("m.su2", su2.replace("10 0 1 2 3", "10 0 1 2"), "line 8: .*needs 4 nodes"),
            ("m.su2", su2.replace("10 0 1", "99 0 1"), "element type 99 is not known"),
            ("m.su2", su2.replace("NELEM= 1", "NELEM= 2"), "ends where an element"),
            ("m.su2", points, "has no elements"),
            ("m.msh", msh.replace("4.1", "4.0", 1), "line 2: its version 4.0 is not supported"),
            ("m.msh", msh.replace("4.1 0 8", "4.1 0 4"), "line 2: .*8 bytes"),
            ("m.msh", msh.replace("0 0 1\n", "0 nan 1\n"), "line 13: 'nan' is no number"),
            ("m.msh", msh.replace("1 4 1 9\n3", "1 5 1 9\n3").replace("0 4\n", "0 5\n"),
             "line 15: the section ends"),
            ("m.msh", msh.replace("0 4\n", "0 99999\n"), "line 6: the number 99999 is out of ran"),
            ("m.msh", msh.replace("\n4\n", "\n3\n"), "more than one node .* 3"),
            ("m.msh", msh.replace("9 1 2 3 4", "9 1 2 3 44"), "element 9 has the node 44"),
            ("m.msh", msh.replace("3 1 4 1", "3 1 29 1"), "line 18: the element type 29"),
            ("m.msh", msh.replace("3 1 4 1", "1 1 1 1"), "no volume or surface elements"),
            ("m.msh", msh.replace("$EndElements\n", ""), "section .Elements has no end"),
            ("m.msh", msh + "$Nodes\n0 0 0 0\n$EndNodes\n", "the section .Nodes twice"),
            ("m.msh", msh.replace("$Nodes", "$Modes").replace("$EndNodes", "$EndModes"),
             "no section .Nodes"),
            ("m.msh", msh + "$PartitionedEntities\n2\n$EndPartitionedEntities\n",
             "line 23: the section ends where a number should follow"))
        for name, content, message in cases:
            with self.subTest(message=message):
                path = self.folder / name
                path.write_text(content)
                self.refuse(message, "--list-surfaces", path)
                self.refuse(message, "--move", "Surface 0", "--translate", "1,0,0", path, path)

    def test_too_many_included_files_are_refused(self):
        (self.folder / "empty.inc").write_text("")
        for name, line in (("m.inp", "*INCLUDE, INPUT=empty.inc\n"),
                           ("m.bdf", "INCLUDE 'empty.inc'\n")):
            path = self.folder / name
            path.write_text(("BEGIN BULK\n" if name == "m.bdf" else "") + 1001 * line)
            self.refuse(f"{name}: it includes more than 1000 files", "--list-surfaces", path)

    def test_planar_files_of_each_format(self):
        """Exodus II and CGNS need three coordinates: library_files.py. OpenFOAM has no planar mesh:
        its two-dimensional cases are one cell thick."""
        places = [f"{x}.,{y}.,0." for y in range(4) for x in range(4)]
        quads = [[4 * y + x, 4 * y + x + 1, 4 * y + x + 5, 4 * y + x + 4]
                 for y in range(3) for x in range(3)]
        rows = [" ".join(map(str, quad)) for quad in quads]
        from_one = [" ".join(str(node + 1) for node in quad) for quad in quads]
        numbered = "".join(f"{i + 1},{x}\n" for i, x in enumerate(places))
        points = "".join(x.replace(",", " ") + "\n" for x in places)
        msh = ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n16\n" +
               numbered.replace(",", " ") + "$EndNodes\n$Elements\n9\n" +
               "".join(f"{i + 1} 3 2 1 1 {row}\n" for i, row in enumerate(from_one)) +
               "$EndElements\n")
        vtk = ("# vtk DataFile Version 3.0\nplanar\nASCII\nDATASET UNSTRUCTURED_GRID\n"
               "POINTS 16 double\n" + points + "CELLS 9 45\n" +
               "".join(f"4 {row}\n" for row in rows) + "CELL_TYPES 9\n" + 9 * "9\n")
        inp = ("*NODE\n{}*ELEMENT, TYPE={}\n" +
               "".join(f"{i + 1}, {row.replace(' ', ', ')}\n" for i, row in enumerate(from_one)))
        bdf = "".join(f"GRID,{i + 1},,{x}\n" for i, x in enumerate(places))
        quad4 = "".join(f"CQUAD4,{i + 1},7,{row.replace(' ', ',')}\n"
                        for i, row in enumerate(from_one))
        su2 = ("NDIME= 2\nNELEM= 9\n" + "".join(f"9 {row} {i}\n" for i, row in enumerate(rows)) +
               "NPOIN= 16\n" + "".join(f"{x.replace(',', ' ')[:-3]} {i}\n"
                                       for i, x in enumerate(places)) +
               "NMARK= 1\nMARKER_TAG= low\nMARKER_ELEMS= 3\n3 0 1\n3 1 2\n3 2 3\n")
        for name, content, surface in (
                ("m.inp", inp.format(numbered.replace(",0.\n", "\n"), "CPS4"), "Surface 0"),
                ("m.inp", inp.format(numbered, "S4"), "Surface 0"),
                ("m.bdf", bdf + quad4, "Surface 0"), ("m.su2", su2, "low"),
                ("m.msh", msh, "Surface 0"), ("m.vtk", vtk, "Surface 0")):
            with self.subTest(name=name, content=content):
                path, out = self.folder / name, self.folder / ("out" + Path(name).suffix)
                path.write_text(content)
                # The lower side goes down by a half, and what is between it and the upper follows.
                self.morph(path, out, "--move", surface, "--translate", "0,-.5,0")
                if name != "m.vtk":
                    old, new = content.splitlines(), out.read_text().splitlines()
                    self.assertEqual(len(old), len(new))
                    changed = [line for line, was in zip(new, old) if line != was]
                    self.assertEqual(len(changed), 12)  # the upper nodes stay
                    self.assertTrue(all("-.5" in line or "-0.5" in line for line in changed[:4]))


def forget_tests_of_superclass(case):
    for name in dir(SolverFiles):
        if name.startswith("test_"):
            setattr(case, name, None)


class Includes(SolverFiles):
    """Nodes in other files than the one that is named."""

    def setUp(self):
        super().setUp()
        self.model, self.pieces, whole = self.write(".inp", name="whole")
        text = whole.read_text()
        at = text.index("*ELEMENT")
        (self.folder / "in").mkdir()
        (self.folder / "in" / "mesh").mkdir()
        self.nodes = self.folder / "in" / "mesh" / "nodes.inc"
        self.nodes.write_text(text[:at])
        self.other = self.folder / "in" / "loads.inc"
        self.other.write_text("** nothing\n")
        self.deck = self.folder / "in" / "deck.inp"
        self.deck.write_text('*INCLUDE, INPUT="mesh/nodes.inc"\n' + text[at:] +
                             "*INCLUDE, INPUT=loads.inc\n")
        self.whole = whole
        self.out = self.folder / "out.inp"
        self.morph(whole, self.out)

    def changed(self):
        """The nodes' part of the same model in one file."""
        text = self.out.read_text()
        return text[:text.index("*ELEMENT")]

    def test_another_folder_gets_all_files(self):
        folder = self.folder / "there"
        folder.mkdir()
        self.morph(self.deck, folder / "deck.inp")
        self.assertEqual((folder / "mesh" / "nodes.inc").read_text(), self.changed())
        self.assertEqual((folder / "deck.inp").read_text(), self.deck.read_text())
        self.assertEqual((folder / "loads.inc").read_text(), self.other.read_text())

    def test_in_place_the_included_file_alone_is_written(self):
        deck, loads = self.deck.stat(), self.other.stat()
        self.morph(self.deck, self.deck)
        self.assertEqual(self.nodes.read_text(), self.changed())
        self.assertEqual((deck.st_mtime_ns, deck.st_ino),
                         (self.deck.stat().st_mtime_ns, self.deck.stat().st_ino))
        self.assertEqual(loads.st_ino, self.other.stat().st_ino)

    def test_a_second_deck_beside_the_first_would_overwrite_its_nodes(self):
        self.refuse("nodes.inc, which would be overwritten", "--move", "Wall", "--translate",
                    "0.05,0.02,0.01", self.deck, self.folder / "in" / "second.inp")


forget_tests_of_superclass(Includes)


class NastranIncludes(SolverFiles):
    """INCLUDE of Nastran, with the nodes one folder down, and a second level."""

    def setUp(self):
        super().setUp()
        _, self.pieces, self.whole = self.write(".bdf", name="whole")
        lines = self.whole.read_text().splitlines(keepends=True)
        begin = lines.index("BEGIN BULK\n") + 1
        end = next(i for i, line in enumerate(lines) if i > begin and line.startswith("C"))
        folder = self.folder / "in" / "mesh"
        folder.mkdir(parents=True)
        self.nodes, self.deck = folder / "nodes.bdf", self.folder / "in" / "deck.bdf"
        self.nodes.write_text("".join(lines[begin:end]))
        (folder / "all.bdf").write_text("$ two levels\nINCLUDE 'nodes.bdf'\n")
        self.deck.write_text("".join(lines[:begin]) + "include 'mesh/all.bdf' $ the nodes\n" +
                             "".join(lines[end:]))
        self.out = self.folder / "out.bdf"
        self.morph(self.whole, self.out)
        self.changed = "".join(self.out.read_text().splitlines(keepends=True)[begin:end])

    def test_another_folder_gets_all_files(self):
        there = self.folder / "there"
        there.mkdir()
        self.morph(self.deck, there / "deck.bdf")
        self.assertNotEqual(self.changed, self.nodes.read_text())
        for name in ("deck.bdf", "mesh/all.bdf"):
            self.assertEqual((there / name).read_text(), (self.folder / "in" / name).read_text())
        self.assertEqual((there / "mesh" / "nodes.bdf").read_text(), self.changed)

    def test_in_place_the_included_file_alone_is_written(self):
        deck = self.deck.stat()
        self.morph(self.deck, self.deck)
        self.assertEqual(self.nodes.read_text(), self.changed)
        self.assertEqual(deck.st_ino, self.deck.stat().st_ino)

    def test_a_name_is_sought_beside_its_file_and_from_the_root(self):
        """A bare name beside its file first, one with a folder from the root's folder first."""
        folder = self.folder / "in"
        parts = self.nodes.read_text().splitlines(keepends=True)
        self.nodes.write_text("".join(parts[:5]))
        (folder / "lib").mkdir()
        (folder / "lib" / "more.bdf").write_text("".join(parts[5:]))
        (folder / "mesh" / "all.bdf").write_text(
            "INCLUDE 'nodes.bdf'\nINCLUDE 'lib/\n     more.bdf'\n")
        there = self.folder / "there"
        there.mkdir()
        self.morph(self.deck, there / "deck.bdf")
        moved = [there / name for name in ("mesh/nodes.bdf", "lib/more.bdf")]
        self.assertEqual("".join(path.read_text() for path in moved), self.changed)
        (folder / "mesh" / "lib").mkdir()
        (folder / "mesh" / "lib" / "more.bdf").write_text("")
        self.assertIn("is lib/more.bdf, and not mesh/lib/more.bdf, which is there, too",
                      run("--list-surfaces", self.deck).stderr)
        (folder / "lib" / "more.bdf").rename(folder / "mesh" / "lib" / "more.bdf")
        self.assertEqual(run("--list-surfaces", self.deck).stderr, "")

    def test_files_that_include_each_other(self):
        self.nodes.write_text("INCLUDE 'all.bdf'\n")
        self.refuse("20 levels deep", "--list-surfaces", self.deck)


forget_tests_of_superclass(NastranIncludes)


@unittest.skipUnless(shutil.which("ccx"), "CalculiX is not installed (calculix-ccx)")
class CalculiX(SolverFiles):
    def volume(self, path):
        """The volume of all elements, as CalculiX prints it."""
        result = subprocess.run(["ccx", "-i", path.stem], cwd=path.parent, capture_output=True,
                                text=True, timeout=120)
        self.assertNotIn("*ERROR", result.stdout, result.stdout[-2000:])
        printed = path.with_suffix(".dat").read_text()
        return float(printed[printed.index("volume"):].split("\n")[2].split()[0])

    def test_it_solves_the_morphed_deck(self):
        """A translation of the wall moves no other boundary node: the volume follows from the
        corners, by the divergence theorem."""
        model, pieces, path = self.write(".inp", kind="tetrahedra", name="deck",
                                          writing={"calculix": True})
        out = self.folder / "out.inp"
        self.morph(path, out, "--move", "Wall", "--scale", "1.1", "--center", "3,0,1", "--validity",
                   "Refuse")
        for file in (path, out):
            found = models.coordinates_in(pieces, file.read_bytes())
            x = [[models.value(found[n, a]) for a in range(3)] for n in range(len(model.points))]
            exact = sum(self.tetrahedron(*(x[n] for n in nodes)) for _, nodes in model.cells)
            self.assertAlmostEqual(self.volume(file) / exact, 1, delta=1e-5)

    @staticmethod
    def tetrahedron(a, b, c, d):
        u, v, w = ([q - p for p, q in zip(a, other)] for other in (b, c, d))
        return (u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
                u[2] * (v[0] * w[1] - v[1] * w[0])) / 6


forget_tests_of_superclass(CalculiX)


if __name__ == "__main__":
    unittest.main()
